"""What cuts: cutter profiles, holders and the assembly of both."""
