"""The window with the pictures of a plan."""
