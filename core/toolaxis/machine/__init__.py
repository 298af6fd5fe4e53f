"""What moves: limits of the axes and work coordinate systems."""
