"""Polygons with holes cut along axis-parallel lines."""

import numpy as np
import pytest

from toolaxis.numeric.clipping import clipped, grouped
from toolaxis.numeric.polygons import inside, slabs

shapely = pytest.importorskip("shapely")

SQUARE = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4]])
HOLE = np.array([[1.0, 1], [1, 3], [3, 3], [3, 1]])
COMB = np.array([[0.0, 0], [6, 0], [6, 3], [5, 3], [5, 1], [4, 1], [4, 3], [3, 3], [3, 1], [2, 1], [2, 3], [0, 3]])


def star(seed):
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.uniform(0, 2 * np.pi, 40))
    return (rng.uniform(0.3, 1, 40) * [np.cos(angle), np.sin(angle)]).T


def region(loops):
    shape = shapely.Polygon()
    for loop in loops:
        shape = shape.symmetric_difference(shapely.Polygon(loop).buffer(0))
    return shape


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("limit", [-0.5, 0.0, 0.3, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0])
@pytest.mark.parametrize("loops", [(SQUARE,), (SQUARE, HOLE), (COMB,), (star(1),), (star(2), 0.2 * star(3))])
def test_both_sides_are_what_shapely_cuts(loops, axis, limit):
    whole = region(loops)
    for above in (True, False):
        low, high = (limit, 100.0) if above else (-100.0, limit)
        box = shapely.box(low, -100, high, 100) if axis == 0 else shapely.box(-100, low, 100, high)
        expected = whole.intersection(box)
        ours = clipped(loops, axis, limit, above)
        assert region(ours).symmetric_difference(expected).area < 1e-9


def test_points_stay_inside_or_outside():
    loops = (star(5), 0.2 * star(6))
    uv = np.random.default_rng(0).uniform(-1, 1, (2000, 2))
    before = inside(slabs(loops), uv)
    right, left = clipped(loops, 0, 0.1, True), clipped(loops, 0, 0.1, False)
    after = np.where(uv[:, 0] > 0.1, inside(slabs(right), uv), inside(slabs(left), uv))
    assert (before == after).all()


def test_nothing_remains_beyond_the_end():
    assert clipped((SQUARE,), 0, 4.0, True) == ()
    assert clipped((), 0, 1.0, True) == ()


def test_separate_polygons_keep_their_own_holes():
    far = SQUARE + np.array([10, 0])
    groups = grouped((SQUARE, far, HOLE + np.array([10, 0]), HOLE, 0.2 * SQUARE + np.array([1.6, 1.6])))
    assert sorted(len(group) for group in groups) == [1, 2, 2]
    for group in groups:
        if len(group) == 2:
            assert (group[1].min(axis=0) > group[0].min(axis=0)).all()
            assert (group[1].max(axis=0) < group[0].max(axis=0)).all()
