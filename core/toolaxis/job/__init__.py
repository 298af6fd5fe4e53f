"""The pipeline: from a part and a tool to a plan, its files and its verdict."""
