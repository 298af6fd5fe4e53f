"""Task panels and their widgets; nothing here is imported before a command runs."""
