"""Nothing is claimed of cells that look alike at all places where they are measured, and different in between."""

import numpy as np

from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import group_surroundings
from toolaxis.regions.out_of_reach import prove_out_of_reach
from toolaxis.regions.scene import ReachScene
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tools.tool import Tool

#: As many waves as there are halves of cells once and twice halved: each place of a cell lies in a valley.
WAVES, DEEP, LONG, WIDE = 72, 3.0, 40.0, 62.5
BALL = Tool.ball(10, stickout=40)


def ribs() -> Part:
    """A face with upright ribs 0.56 mm apart, whose parameter runs evenly along it."""
    count = 12 * WAVES + 1
    knots = np.concatenate([np.zeros(3), np.linspace(0, 1, count - 2), np.ones(3)])
    x = LONG * np.array([knots[k + 1:k + 4].mean() for k in range(count)])
    x, y = np.meshgrid(x, np.linspace(0, WIDE, 4), indexing="ij")
    z = -DEEP * np.cos(2 * np.pi * WAVES * x / LONG)
    return Part.from_faces([Face.from_bspline(np.stack([x, y, z], axis=-1))])


def test_the_backs_of_ribs_are_not_claimed() -> None:
    part = ribs()
    (face,) = part.faces
    scene = ReachScene.of(part)
    backs = np.column_stack([(np.arange(8, 64, 8) + 0.5) / WAVES, np.full(7, 0.45)])
    assert np.abs(face.normal(backs)[:, 2]).min() > 0.999, "they lie level"
    judge = Feasibility(face, BALL, group_surroundings(face, scene.tolerance, part=part), scene.tolerance)
    up = np.array([0.0, 0.0, 1.0])
    reached = judge.reach(backs, up, itself=True)
    assert reached.all(), "the ball stands on them"
    rows = prove_out_of_reach(face, [BALL], scene, 30_000).rectangles
    u, v = backs.T[..., None]
    claimed = (u >= rows[:, 0]) & (u <= rows[:, 1]) & (v >= rows[:, 2]) & (v <= rows[:, 3])
    assert not claimed.any()
