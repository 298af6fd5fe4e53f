"""Found: ramps ran into a neighbour that continues the face smoothly and rises: every axis was refused."""

import numpy as np

import toolaxis as ta
from toolaxis.search.fixed_axis import evaluate_axis


def test_a_floor_with_a_quarter_round_that_continues_it_has_a_vertical_axis() -> None:
    floor = ta.Face.from_bspline(np.array([[[0, y, 0], [12, y, 0]] for y in (8.0, 0.0)]).transpose(1, 0, 2)[:, ::-1],
                                 degree=(1, 1))
    r, s = 3.0, np.sqrt(0.5)
    rounds = []
    for side in (-1, 1):
        edge = 6 + 6 * side
        rows = np.array([[[edge, y, 0], [edge + side * r, y, 0], [edge + side * r, y, r]] for y in (0.0, 8.0)])
        rounds.append(ta.Face.from_bspline(rows, degree=(1, 2), weights=np.array([[1, s, 1]] * 2), flip=side > 0))
    for y, side in ((0.0, -1), (8.0, 1)):
        rows = np.array([[[x, y, 0], [x, y + side * r, 0], [x, y + side * r, r]] for x in (0.0, 12.0)])
        rounds.append(ta.Face.from_bspline(rows, degree=(1, 2), weights=np.array([[1, s, 1]] * 2), flip=side < 0))
    assert all(face.normal(face.grid(3, 3))[:, 2].min() > 0 for face in (floor, *rounds))
    found = evaluate_axis(floor, ta.Tool.ball(diameter=5), [0, 0, 1], 0.2, skin=rounds, tolerance=0.002)
    assert found.outcome == "feasible", found.reasons
    assert found.gouge <= 0.002
