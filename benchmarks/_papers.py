"""What numbers that stand beside printed ones are made with."""

#: Machining tolerance, mm: papers allow no gouge, and these are all but free of it.
GOUGE = 0.002
