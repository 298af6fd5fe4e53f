"""Where to cut: sample points, the number of passes, and the passes themselves."""
