"""How far cutter, shank and holder stay from faces, and how deep a cutter reaches into them: bounds that hold."""
