"""The window: commands, what objects look like, and task panels."""
