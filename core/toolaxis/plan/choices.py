"""Words of which a plan takes one: what is least, and how passes go."""

#: Parameters of a face that may vary along passes.
FEEDS = ("u", "v")
OBJECTIVES = ("length", "passes", "time")
DIRECTIONS = ("zigzag", "climb", "conventional")
#: How passes lie: along a parameter of the face, along parallel planes that contain the tool axis, or along the levels
#: of a field that keeps them as far apart as their strips are wide; or each face whichever of the first and the last is
#: shorter.
ISO, PLANES, FIELD, AUTO = "iso", "planes", "scallop", "auto"
PATTERNS = (ISO, PLANES, FIELD)
PASSES = (*PATTERNS, AUTO)
#: Methods under which a face that no axis reaches whole is divided; several tools are planned with one of them.
DIVIDED = ("sphere", "sectors")
#: What is planned with unless given: scallop height, mm, feed rate, mm/min, and spindle speed, rev/min.
SCALLOP, FEEDRATE, SPINDLE = 0.02, 1000.0, 10000.0
