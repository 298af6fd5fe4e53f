"""Plan the curved face on top of every STEP file of a folder, picked with CadQuery, and judge each plan.

    python examples/folder.py FOLDER OUT
"""

import sys
from pathlib import Path

import cadquery as cq

import toolaxis as ta

TOOL = ta.Tool.torus(diameter=12, corner_radius=2, stickout=50, holder=[(10, 0), (10, 40), (25, 40), (25, 80)])


def jobs(folder):
    """A job for each STEP file."""
    for path in sorted(Path(folder).glob("*.step")):
        top = cq.importers.importStep(str(path)).faces("not %PLANE").faces(">Z")
        yield {"name": path.stem, "part": top, "tool": TOOL, "scallop": 0.1, "verify": True}


if __name__ == "__main__":
    made = ta.batch(jobs(sys.argv[1]), sys.argv[2], told=print)
    sys.exit(not made.complete)
