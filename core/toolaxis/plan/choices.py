"""Words of which a plan takes one: what is least, and how passes go."""

OBJECTIVES = ("length", "passes", "time")
DIRECTIONS = ("zigzag", "climb", "conventional")
#: How passes lie: along a parameter of the face, or along parallel planes that contain the tool axis.
ISO, PLANES = "iso", "planes"
PASSES = (ISO, PLANES)
