"""A step in the file is not charged to the cutter where it plans, so nothing is claimed out of reach for its sake."""

import numpy as np
import pytest

from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import group_surroundings
from toolaxis.regions.out_of_reach import prove_out_of_reach
from toolaxis.regions.scene import ReachScene
from toolaxis.shape.adjacency import Border, edges_from_borders
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.shape.seams import GREATEST
from toolaxis.tools.tool import Tool

BALL = Tool.ball(40, flute_length=60)
WIDE = 0.1


def plate(left: float, right: float, height: float) -> Face:
    """A level piece of a strip, as wide as it is short."""
    x, y = np.meshgrid(np.linspace(left, right, 4), np.linspace(0, WIDE, 4), indexing="ij")
    return Face.from_bspline(np.stack([x, y, np.full_like(x, height)], axis=-1))


def stair(step: float) -> Part:
    """A sliver at z = 0, and a face that goes on from it higher by a step."""
    faces = [plate(-WIDE, 0.0, 0.0), plate(0.0, 20.0, step)]
    at = np.linspace(0, 1, 9)
    border = Border((1, 2), np.column_stack([0 * at, WIDE * at, 0 * at]), np.column_stack([0 * at + 1, at]),
                    np.column_stack([0 * at, at]), True, False)
    return Part.from_faces(faces, edges_from_borders(Part.from_faces(faces).faces, [border]))


@pytest.mark.parametrize(("step", "claimed"), [(0.9 * GREATEST, False), (1.5 * GREATEST, True)])
def test_only_steps_that_count_put_a_sliver_out_of_reach(step: float, claimed: bool) -> None:
    part = stair(step)
    sliver = part.face(1)
    groups = group_surroundings(sliver, ReachScene.of(part).tolerance, part=part)
    judge = Feasibility(sliver, BALL, groups, ReachScene.of(part).tolerance)
    reached = judge.reach(sliver.grid(5, 5), np.array([0.0, 0.0, 1.0]), itself=True)
    assert reached.all() != claimed and reached.any() != claimed, "what the exact check says"
    found = prove_out_of_reach(sliver, [BALL], ReachScene.of(part))
    assert (found.area > 0.5 * sliver.area) == claimed and (found.area == 0.0) != claimed
