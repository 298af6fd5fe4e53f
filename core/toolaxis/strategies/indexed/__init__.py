"""Fixed axes: every sub-surface is machined with one that stands still."""
