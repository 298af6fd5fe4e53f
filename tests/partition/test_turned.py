"""Turned faces are found again through points, whatever their parameters; pieces of them add up."""

import numpy as np
import pytest

from toolaxis.shape.counterparts import best_motion, counterpart, off, turn_about, turn_piece
from toolaxis.shape.face import Face
from toolaxis.shape.nurbs import NurbsSurface

POINT, AXIS, ANGLE = np.array([1.0, -2.0, 3.0]), np.array([0.6, 0.0, 0.8]), 0.9


def net():
    """Control points of a bent bicubic patch without symmetry."""
    x, y = np.meshgrid(np.linspace(0, 30, 6), np.linspace(0, 20, 5), indexing="ij")
    return np.dstack([x + 0.05 * y**1.2, y, 4 * np.sin(x / 9) + 0.01 * x * y])


def plain(points=None, trims=()):
    return Face.from_bspline(net() if points is None else points, trims=trims)


def rewritten(how):
    """The patch with other parameters."""
    points = net()
    if "swap" in how:
        points = points.swapaxes(0, 1)
    if "u" in how.split():
        points = points[::-1]
    if "v" in how.split():
        points = points[:, ::-1]
    face = plain(points)
    if "scaled" in how:
        s = face.surface
        face = Face(NurbsSurface(7 + 3 * s.knots_u, -2 + 0.5 * s.knots_v, s.control, s.degree))
    return face


def elsewhere(face):
    return face.transformed(turn_about(POINT, AXIS, ANGLE))


@pytest.mark.parametrize("how", ["", "u", "v", "u v", "swap", "swap u", "swap v scaled", "scaled u"])
def test_a_turned_face_is_matched_whatever_its_parameters(how):
    face, matrix = plain(), turn_about(POINT, AXIS, ANGLE)
    stranger = elsewhere(face).transformed(turn_about(POINT, AXIS, 0.8))
    other = counterpart(face, matrix, [stranger, elsewhere(rewritten(how))])
    assert other is not None and other.chart is not None
    assert other.away < 1e-9
    assert other.chart.swapped == ("swap" in how)
    uv = face.grid(7, 7)
    assert other.face.evaluate(other.chart(uv)).point == pytest.approx(
        face.evaluate(uv).point @ matrix[:3, :3].T + matrix[:3, 3], abs=1e-9)


@pytest.mark.parametrize("how", ["", "u", "swap v", "swap scaled"])
def test_parameters_that_do_not_begin_at_zero_are_carried_over(how):
    face, matrix = rewritten("scaled"), turn_about(POINT, AXIS, ANGLE)
    other = counterpart(face, matrix, [elsewhere(rewritten(how))])
    assert other is not None and other.chart is not None
    uv = face.grid(7, 7)
    assert other.face.evaluate(other.chart(uv)).point == pytest.approx(
        face.evaluate(uv).point @ matrix[:3, :3].T + matrix[:3, 3], abs=1e-9)


def test_a_face_whose_parameters_crowd_at_one_end_is_matched():
    """The mean of its samples lies far from the middle of the box around it."""
    points = net()
    points[..., 0] = 30.0 * (points[..., 0] / 30.0) ** 3
    face, matrix = plain(points), turn_about(POINT, AXIS, ANGLE)
    other = counterpart(face, matrix, [elsewhere(plain()), elsewhere(face)])
    assert other is not None and other.away < 1e-9


@pytest.mark.parametrize("away", [0.0, 0.02, -0.3])
def test_how_far_a_counterpart_lies_off_counts_along_its_normal(away):
    face, matrix = plain(), turn_about(POINT, AXIS, ANGLE)
    flat = net() * [1, 1, 0]
    lifted = counterpart(plain(flat), matrix, [plain(flat + np.array([0, 0, away])).transformed(matrix)])
    assert lifted is not None and off(plain(flat), lifted, matrix) == pytest.approx(abs(away), abs=1e-9)
    same = counterpart(face, matrix, [elsewhere(rewritten("swap"))])
    assert same is not None and off(face, same, matrix) < 1e-9


@pytest.mark.parametrize("how", ["", "swap u", "scaled v"])
def test_pieces_of_the_counterpart_add_up_and_lie_where_the_turn_puts_them(how):
    face, matrix = plain(), turn_about(POINT, AXIS, ANGLE)
    other = counterpart(face, matrix, [elsewhere(rewritten(how))])
    pieces = [face.trimmed((np.array([[a, c], [b, c], [b, d], [a, d]]),), f"1{k}")
              for k, (a, b, c, d) in enumerate([(0, 0.3, 0, 1), (0.3, 1, 0, 0.55), (0.3, 1, 0.55, 1)])]
    made = [turn_piece(piece, face, other, matrix, "x") for piece in pieces]
    assert all(away < 1e-9 for _, away in made)
    assert sum(piece.area for piece, _ in made) == pytest.approx(face.area, rel=1e-6)
    for (found, _), piece in zip(made, pieces, strict=True):
        assert found.area == pytest.approx(piece.area, rel=1e-5)
        middle = found.evaluate(found.grid(9, 9)).point.mean(axis=0)
        there = piece.transformed(matrix)
        assert middle == pytest.approx(there.evaluate(there.grid(9, 9)).point.mean(axis=0), abs=1e-6)


def test_other_parameters_without_a_straight_rule_carry_loops_over():
    """The same rectangle, once more with x growing as the square of the parameter."""
    straight = np.stack(np.meshgrid([0.0, 10.0], [0.0, 6.0], indexing="ij"), axis=-1)
    flat = Face.from_bspline(np.dstack([straight, np.zeros((2, 2))]), degree=(1, 1))
    rows = np.array([0.0, 0.0, 10.0])  # x = 10 t^2
    bent = Face.from_bspline(np.stack([np.column_stack([np.full(2, x), [0.0, 6.0], [0.0, 0.0]]) for x in rows]),
                             degree=(2, 1))
    matrix = turn_about(POINT, AXIS, ANGLE)
    other = counterpart(flat, matrix, [elsewhere(bent)])
    assert other is not None and other.chart is None
    piece = flat.trimmed((np.array([[0.25, 0.0], [1.0, 0.0], [1.0, 1.0], [0.25, 1.0]]),), "1b")
    found, away = turn_piece(piece, flat, other, matrix, "2b")
    assert away < 1e-6
    assert found.area == pytest.approx(45.0, rel=1e-4)
    assert found.bounds[0] == pytest.approx(0.5, abs=1e-4)


def test_a_face_without_like_has_no_counterpart():
    face = plain()
    assert counterpart(face, turn_about(POINT, AXIS, ANGLE), [face.transformed(turn_about(POINT, AXIS, 0.2))]) is None


def test_the_motion_is_found_from_the_faces_though_the_axis_is_a_little_off():
    face, exact = plain(), turn_about(POINT, AXIS, ANGLE)
    off = np.array([0.601, 0.001, 0.799])
    rough = turn_about(POINT + np.array([0.05, 0, 0]), off / np.linalg.norm(off), ANGLE)
    other = counterpart(face, rough, [elsewhere(rewritten("u"))])
    assert other is not None and other.away > 1e-3
    assert best_motion(rough, [(face, other)]) == pytest.approx(exact, abs=1e-9)
