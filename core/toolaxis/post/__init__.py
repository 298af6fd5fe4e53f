"""Text out: cutter location files and, later, NC code."""
