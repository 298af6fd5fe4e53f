"""The panel that exports."""
