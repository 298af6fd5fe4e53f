"""From a part and a tool to a plan."""
