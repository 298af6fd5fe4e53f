"""Found: a face was refused because its neighbour stands out over it at their edge, and nothing said so.

Steps up to 0.02 mm are no reason any more: they are taken off the depth.
"""

import numpy as np
import pytest

from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import SKIN, TOUCHING, CheckSurfaces
from toolaxis.feasibility.violations import CUTTER, Violation
from toolaxis.search.messages import sentence
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool


def plane(corner, one, two, number):
    s, t = np.meshgrid(np.linspace(0, 1, 4), np.linspace(0, 1, 4), indexing="ij")
    face = Face.from_bspline(np.asarray(corner) + s[..., None] * np.asarray(one) + t[..., None] * np.asarray(two))
    return face.trimmed((), str(number))


@pytest.mark.parametrize("step", [0.0, 0.003, 0.03])
def test_the_step_is_named(step):
    top, side = plane([0, 0, 0], [20, 0, 0], [0, 10, 0], 1), plane([20, 0, -9], [0, 10, 0], [0, 0, 9 + step], 2)
    far = [-1.0, 0.5, 1.0]
    groups = (CheckSurfaces(SKIN, (top,), np.array([-0.001, *far[1:]])),
              CheckSurfaces(TOUCHING, (side,), np.array([-0.001, *far[1:]])))
    found = Violation(CUTTER, 0.002, "2", np.array([20.0, 4.0, -0.1]), np.array([1.0, 0.4]), -0.003)
    said = sentence(found, Feasibility(top, Tool.ball(6), groups, Tolerance(gouge=0.002)))
    assert said.startswith("the cutter gouges face 2 behind an edge by 0.003 mm at (20, 4, -0.1); 0.002 mm is allowed")
    assert ("Face 2 stands 0.03 mm out over face 1" in said) == (step == 0.03)
    assert ("repair the edge" in said) == (step == 0.03)
