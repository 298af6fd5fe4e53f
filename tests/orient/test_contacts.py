"""Places at which axes are judged: which walls are near, and places that are watched later."""

import numpy as np

from toolaxis.feasibility.check_points import contacts_at
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import OTHER, SKIN, CheckSurfaces
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool


def plane(corner, one, two, number):
    s, t = np.meshgrid(np.linspace(0, 1, 4), np.linspace(0, 1, 4), indexing="ij")
    face = Face.from_bspline(np.asarray(corner) + s[..., None] * np.asarray(one) + t[..., None] * np.asarray(two))
    return face.trimmed((), str(number))


FLOOR = plane([0, 0, 0], [40, 0, 0], [0, 30, 0], 1)
WALLS = (plane([40, 0, 0], [0, 0, 20], [0, 30, 0], 2), plane([0, 30, 3], [0, 0, 20], [40, 0, 0], 3))


def test_walls_are_near_within_their_exact_distance():
    uv = np.random.default_rng(5).uniform(size=(4000, 2))
    near = contacts_at(FLOOR, uv, 0, WALLS, 7.0).near
    x, y = 40 * uv[:, 0], 30 * uv[:, 1]
    np.testing.assert_array_equal(near[:, 0], 40 - x <= 7.0)
    np.testing.assert_array_equal(near[:, 1], np.hypot(30 - y, 3.0) <= 7.0)


def test_watching_later_is_watching_from_the_start():
    groups = (CheckSurfaces(SKIN, (FLOOR,), np.array([-0.002, 0.5, 1.0])),
              CheckSurfaces(OTHER, WALLS, np.array([0.1, 0.5, 1.0])))
    one = Feasibility(FLOOR, Tool.ball(6), groups, Tolerance())
    more = np.random.default_rng(6).uniform(size=(2, 7, 2))
    assert len(one.sparse.uv) == len(one.watching(more[0]).sparse.uv) - 7
    late = one.watching(more[0]).watching(more[1]).sparse
    early = Feasibility(FLOOR, Tool.ball(6), groups, Tolerance(), watched=more.reshape(-1, 2)).sparse
    for a, b in zip(late, early, strict=True):
        np.testing.assert_array_equal(a, b)
