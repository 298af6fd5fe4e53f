"""The page of a plan, and that of a batch."""
