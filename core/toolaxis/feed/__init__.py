"""How fast: jerk-limited profiles, axis limits along a path, and the time that a path takes."""
