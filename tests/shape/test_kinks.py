"""Kinks: found where the normal jumps, and split there."""

import numpy as np
import pytest

from toolaxis.numeric.knots import insert_knot
from toolaxis.shape.face import Face
from toolaxis.shape.kinks import kinks_of, letters, split_at_kinks, with_kinks
from toolaxis.shape.nurbs import NurbsSurface


def roof(height, trims=()):
    """Two planes 10 x 20 mm that meet over x = 10 with a ridge of a height."""
    net = np.array([[[x, y, z] for y in (0.0, 20.0)] for x, z in ((0.0, 0.0), (10.0, height), (20.0, 0.0))])
    return Face.from_bspline(net, (1, 1), ([0, 0, 0.5, 1, 1], [0, 0, 1, 1]), trims=trims)


def test_a_ridge_is_a_kink_and_a_flat_joint_is_none():
    assert kinks_of(roof(3.0)) == ((0.5,), ())
    assert kinks_of(roof(0.0)) == ((), ())


@pytest.mark.parametrize("jump, found", [(0.5e-4, False), (2e-4, True)])
def test_the_limit_is_a_ten_thousandth_of_a_radian(jump, found):
    face = roof(10 * np.tan(jump / 2))
    assert (kinks_of(face) == ((0.5,), ())) == found


def test_a_repeated_knot_in_a_smooth_surface_is_no_kink():
    rng = np.random.default_rng(0)
    points = np.dstack([*np.meshgrid(np.arange(6.0), np.arange(6.0), indexing="ij"), rng.normal(size=(6, 6))])
    smooth = NurbsSurface.from_points(points)
    knots, control = smooth.knots_u, smooth.control
    for _ in range(3):
        knots, control = insert_knot(knots, control, 3, 0.4)
    assert kinks_of(Face(NurbsSurface(knots, smooth.knots_v, control, (3, 3)))) == ((), ())


def test_a_kink_outside_the_trims_does_not_count():
    loop = np.array([[0.6, 0.1], [0.9, 0.1], [0.9, 0.9], [0.6, 0.9]])
    assert kinks_of(roof(3.0, (loop,))) == ((), ())


def test_pieces_lie_on_the_face_and_add_up():
    hole = np.array([[0.4, 0.4], [0.4, 0.6], [0.6, 0.6], [0.6, 0.4]])
    outer = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.7], [0.5, 1.0], [0.0, 0.7]])
    face = with_kinks(roof(3.0, (outer, hole)))
    pieces = split_at_kinks(face)
    assert [piece.label for piece in pieces] == ["1a", "1b"]
    assert [piece.number for piece in pieces] == [1, 1]
    assert all(kinks_of(piece) == ((), ()) and piece.kinks == ((), ()) for piece in pieces)
    assert sum(piece.area for piece in pieces) == pytest.approx(face.area, rel=1e-3)
    uv = np.random.default_rng(3).uniform(size=(500, 2))
    where = np.sum([piece.contains(uv) for piece in pieces], axis=0)
    assert (where == face.contains(uv)).all()
    for piece in pieces:
        own = uv[piece.contains(uv)]
        assert np.abs(piece.evaluate(own).point - face.evaluate(own).point).max() < 1e-13
        assert np.ptp(piece.normal(own), axis=0).max() < 1e-12


def test_whole_pieces_need_no_loops():
    assert [piece.trims for piece in split_at_kinks(with_kinks(roof(3.0)))] == [(), ()]


def test_a_face_cut_into_separate_islands_gives_a_piece_for_each():
    """A U whose two arms lie beyond the kink."""
    loop = np.array([[0.1, 0.1], [0.9, 0.1], [0.9, 0.3], [0.3, 0.3], [0.3, 0.7], [0.9, 0.7], [0.9, 0.9], [0.1, 0.9]])
    pieces = split_at_kinks(with_kinks(roof(3.0, (loop,))))
    assert len(pieces) == 3
    assert sorted(len(piece.trims) for piece in pieces) == [1, 1, 1]


def test_a_smooth_face_stays_itself():
    face = roof(0.0)
    assert split_at_kinks(face) == (face,)
    assert with_kinks(face) is face


def test_letters_go_on_after_z():
    assert [letters(k) for k in (0, 25, 26, 27, 701, 702)] == ["a", "z", "aa", "ab", "zz", "aaa"]
