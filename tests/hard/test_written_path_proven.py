"""Found: the passes that were written ran in and out on ramps that the proven ones did not have, into a wall."""

from itertools import pairwise

import numpy as np
import pytest

import toolaxis as ta


def _flat(corner: list[float], along: list[float], across: list[float]) -> ta.Face:
    """A parallelogram from a corner and two sides, mm; its normal is along x across."""
    p, a, b = (np.array(row, dtype=float) for row in (corner, along, across))
    return ta.Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


@pytest.mark.parametrize("direction", [
    "zigzag", *(pytest.param(way, marks=pytest.mark.long) for way in ("climb", "conventional"))])
def test_no_motion_of_a_plan_comes_nearer_to_a_wall_than_allowed(direction: str) -> None:
    floor = _flat([0, 0, 0], [14, 0, 0], [0, 8, 0])
    walls = [_flat([14.4, -5, -5], [0, 0, 18], [0, 18, 0]), _flat([-0.4, -5, -5], [0, 18, 0], [0, 0, 18]),
             _flat([-0.4, -0.4, -5], [0, 0, 18], [15, 0, 0]), _flat([-0.4, 8.4, -5], [15, 0, 0], [0, 0, 18])]
    result = ta.plan([floor, *walls], ta.Tool.ball(diameter=4, stickout=30), 0.2, faces=[1],
                     machine="cone:0,0,1,3", direction=direction)
    operation = result.operations[0]
    assert operation.path is not None
    t = operation.orientation.axis
    points = np.concatenate([wall.evaluate(wall.grid(90, 90)).point for wall in walls])
    assert min(_least(operation.path.cl, t, points), 1.0) >= 0.1 - 1e-6
    assert operation.orientation.clearance["cutter"] <= _least(operation.path.cl, t, points) + 1e-6


def _least(tips: np.ndarray, t: np.ndarray, points: np.ndarray) -> float:
    """Distance of points to a ball end 2 mm in radius with its side, 8 mm long, over all motions."""
    best = np.inf
    for a, b in pairwise(tips):
        count = int(np.linalg.norm(b - a) / 0.1) + 2
        for tip in a + np.linspace(0, 1, count)[:, None] * (b - a):
            rest = points - (tip + 2 * t)
            along = np.clip(rest @ t, 0, 6)
            best = min(best, float(np.linalg.norm(rest - along[:, None] * t, axis=1).min()) - 2)
    return best
