"""The first run on a machine compiles on two cores: another process compiles what a plan and its verdict need later.

Whichever of the two comes to a kernel first compiles it; the other one waits and takes it from disk.  What is within a
kernel is not on disk, so kernels that share much, as those of the search do, are left to one process.
"""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.half_widths import half_widths
from toolaxis.numeric.jit import is_kept
from toolaxis.numeric.shares import count_cores

#: Control points along either edge of the small face that is planned, the length of the edge, and the scallop, mm.
_POINTS, _EDGE, _SCALLOP = 5, 20.0, 0.1
#: What it is trimmed by, in its parameters.
_SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


@contextmanager
def compiling_ahead() -> Iterator[None]:
    """While it is entered, a second process compiles what is not on disk yet; it ends with it at the latest."""
    if count_cores() < 2 or is_kept(half_widths):
        yield
        return
    other = subprocess.Popen([sys.executable, "-m", __name__], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                             stderr=subprocess.DEVNULL)
    try:
        yield
    finally:
        other.terminate()
        other.wait()


def compile_ahead() -> None:
    """Lay passes on a small face and judge them: all but what the search of a plan begins with."""
    from toolaxis.job.output.verify import verify_plan
    from toolaxis.machine.work_coordinates import work_coordinates
    from toolaxis.path.iso_parametric import passes
    from toolaxis.path.pass_count import count
    from toolaxis.plan.operation import Operation
    from toolaxis.plan.orientation import Orientation
    from toolaxis.plan.plan import Plan, PlanInputs
    from toolaxis.shape.face import Face
    from toolaxis.shape.nearest import nearest
    from toolaxis.shape.nurbs import NurbsSurface
    from toolaxis.shape.part import Part
    from toolaxis.tools.tool import Tool

    u, v = np.meshgrid(np.linspace(0, 1, _POINTS), np.linspace(0, 1, _POINTS), indexing="ij")
    knots = np.repeat([0.0, 0.5, 1.0], [4, 1, 4])

    def face(number: int, height: NDArray[np.float64]) -> Face:
        control = np.stack([_EDGE * u, _EDGE * v, height, np.ones_like(u)], axis=2)
        return Face(NurbsSurface(knots, knots, control, (3, 3)), (_SQUARE,), number=number)

    waved, below = face(1, 2 * np.sin(3 * u) * v), face(2, np.full_like(u, -_EDGE))
    tool, axis, start = Tool.of("torus", 6.0, 1.0), np.array([0.0, 0.0, 1.0]), np.zeros(3)
    counted = count(waved, tool, axis, _SCALLOP)
    path = passes(waved, tool, axis, _SCALLOP)
    orientation = Orientation(axis, "u", path.passes, counted, path.length(), outcome="feasible")
    frame = work_coordinates(axis, np.array([1.0, 0.0, 0.0]), start, start)
    operation = Operation(1, waved, tool, orientation, path, frame)
    nearest(waved, np.array([[-1.0, 5.0, 0.0], [5.0, 5.0, 1.0]]))  # beside the face, and over it
    verify_plan(Plan(Part((waved, below)), (tool,), PlanInputs(_SCALLOP), (operation,), (), start, "complete"))


if __name__ == "__main__":
    compile_ahead()
