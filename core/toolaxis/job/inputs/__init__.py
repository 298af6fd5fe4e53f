"""What a job is given: a specification, and tools from files."""
