"""The map of all axes on the hemisphere, and what an axis comes to."""
