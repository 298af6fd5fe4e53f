"""An operation's panel: its result, and what its tool meets."""
