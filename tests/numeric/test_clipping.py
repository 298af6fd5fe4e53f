"""Polygons with holes cut along axis-parallel lines."""

import numpy as np
import pytest

from toolaxis.numeric.clipping import clip_half_plane, outer_with_holes
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
        ours = clip_half_plane(loops, axis, limit, above)
        assert region(ours).symmetric_difference(expected).area < 1e-9


def test_points_stay_inside_or_outside():
    loops = (star(5), 0.2 * star(6))
    uv = np.random.default_rng(0).uniform(-1, 1, (2000, 2))
    before = inside(slabs(loops), uv)
    right, left = clip_half_plane(loops, 0, 0.1, True), clip_half_plane(loops, 0, 0.1, False)
    after = np.where(uv[:, 0] > 0.1, inside(slabs(right), uv), inside(slabs(left), uv))
    assert (before == after).all()


def test_nothing_remains_beyond_the_end():
    assert clip_half_plane((SQUARE,), 0, 4.0, True) == ()
    assert clip_half_plane((), 0, 1.0, True) == ()


def test_separate_polygons_keep_their_own_holes():
    far = SQUARE + np.array([10, 0])
    groups = outer_with_holes((SQUARE, far, HOLE + np.array([10, 0]), HOLE, 0.2 * SQUARE + np.array([1.6, 1.6])))
    assert sorted(len(group) for group in groups) == [1, 2, 2]
    for group in groups:
        if len(group) == 2:
            assert (group[1].min(axis=0) > group[0].min(axis=0)).all()
            assert (group[1].max(axis=0) < group[0].max(axis=0)).all()


ALONG_THE_LINE = {
    "rectangle": [[0, 0], [1, 0], [1, 1], [0, 1]],
    "notch": [[0, 0], [1, 0], [1, .375], [.75, .375], [.75, .625], [1, .625], [1, 1], [0, 1]],
    "angle": [[0, 0], [1, 0], [1, .5], [.5, .5], [.5, 1], [0, 1]],
    "stairs": [[0, 0], [1, 0], [1, .25], [.75, .25], [.75, .5], [.5, .5], [.5, .75], [0, .75]],
    "trough": [[0, 0], [1, 0], [1, 1], [.75, 1], [.75, .5], [.25, .5], [.25, 1], [0, 1]],
}
WINDOW = [[.125, .125], [.125, .25], [.25, .25], [.25, .125]]


@pytest.mark.parametrize("name", ALONG_THE_LINE)
@pytest.mark.parametrize("low, size", [(0.0, 1.0), (1000.0, 3.0), (-7.3, 1e-3)])
def test_edges_along_the_line_leave_sound_pieces_and_no_slivers(name, low, size):
    """Rounding decides neither how many pieces there are nor what they are."""
    rng = np.random.default_rng(7)
    for off in [0.0, *10.0**np.repeat(np.arange(-17, -9), 6)]:
        loops = [np.array(loop) for loop in (ALONG_THE_LINE[name], WINDOW)[:rng.integers(1, 3)]]
        axis, limit = rng.integers(2), rng.integers(0, 9) / 8
        whole = shapely.Polygon(loops[0], loops[1:])
        moved = tuple(low + size * (loop + off * rng.standard_normal(loop.shape) * rng.integers(0, 2, loop.shape))
                      for loop in loops)
        for above in (True, False):
            a, b = (limit, 9) if above else (-9, limit)
            left = whole.intersection(shapely.box(a, -9, b, 9) if axis == 0 else shapely.box(-9, a, 9, b))
            wanted = [one for one in getattr(left, "geoms", [left]) if one.area > 1e-6]
            found = [[(loop - low) / size for loop in group]
                     for group in outer_with_holes(clip_half_plane(moved, axis, low + size * limit, above))]
            ours = [shapely.Polygon(group[0], group[1:]) for group in found]
            assert len(ours) == len(wanted), (off, axis, limit)
            assert all(one.is_valid for one in ours)
            assert shapely.union_all(ours).symmetric_difference(left).area < 1e-7


def test_a_loop_that_touches_another_is_no_hole_of_it():
    beside = np.array([[4.0, 1], [4, 3], [5, 2]])
    inner = np.array([[4.0, 1], [4, 3], [3, 2]])
    assert [len(group) for group in outer_with_holes((SQUARE, beside))] == [1, 1]
    assert [len(group) for group in outer_with_holes((SQUARE, inner))] == [2]
