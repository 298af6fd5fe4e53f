"""The independent judge: material removal from the cutter location data alone."""
