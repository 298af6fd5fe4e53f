"""The `toolaxis` command: parse, call `job`, exit code."""
