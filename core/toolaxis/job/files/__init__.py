"""Plan folders and cutter location files, read and written."""
