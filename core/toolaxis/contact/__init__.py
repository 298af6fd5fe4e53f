"""Tool meets surface: where it stands, how wide it cuts, and what it touches."""
