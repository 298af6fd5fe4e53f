"""Strips of a narrow round face: they add up, share the turn of the normals, and follow the face."""

import numpy as np
import pytest

from toolaxis.bladed.strips import strips
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.normal_cone import smallest_cap
from toolaxis.shape.analytic import CylindricalSurface
from toolaxis.shape.face import Face


def nose():
    """Half a cylinder of radius 1, 30 long."""
    return Face(CylindricalSurface(1.0, (0.0, np.pi), (0.0, 30.0)).nurbs())


def spread(face):
    return smallest_cap(face.normal(np.concatenate([face.grid(16, 16), *face.outline]))).radius


@pytest.mark.parametrize("most, count", [(200, 1), (95, 2), (61, 3), (46, 4)])
def test_half_a_cylinder_is_cut_into_equal_turns(most, count):
    face = nose()
    found = strips(face, np.radians(most))
    assert len(found) == count
    assert [one.label for one in found] == ([face.label] if count == 1 else [f"1{c}" for c in "abcd"[:count]])
    assert sum(one.area for one in found) == pytest.approx(face.area, rel=1e-6)
    for one in found:
        assert spread(one) == pytest.approx(np.pi / 2 / count, rel=0.03)


def test_strips_move_with_the_face():
    face = nose()
    c, s = np.cos(0.7), np.sin(0.7)
    move = np.array([[c, -s, 0, 4], [s, c, 0, 5], [0, 0, 1, 6], [0, 0, 0, 1.0]])
    for one, other in zip(strips(face, 1.0), strips(face.transformed(move), 1.0), strict=True):
        assert one.trims[0] == pytest.approx(other.trims[0], abs=1e-9)


def test_a_turn_of_nothing_is_refused():
    with pytest.raises(InvalidInput, match="above zero"):
        strips(nose(), 0.0)
