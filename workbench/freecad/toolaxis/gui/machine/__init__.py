"""The machine's panel: choice, motion from operation to operation, and what meets."""
