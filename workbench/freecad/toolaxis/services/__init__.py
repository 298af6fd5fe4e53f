"""What is done with documents: planning, verifying, editing and exporting, for scripts and panels alike."""
