"""Whether bodies of the machine, the part and the tool meet: at a position, on a path, and between two positions."""
