"""What moves: axes, machines, their kinematics, limits, and work coordinate systems."""
