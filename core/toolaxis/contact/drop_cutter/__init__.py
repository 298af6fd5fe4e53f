"""How low a tool with an upright axis comes to rest on a surface."""
