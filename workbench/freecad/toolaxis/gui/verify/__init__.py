"""The panel that verifies, and maps of its verdict on the faces."""
