"""Points in polygons against shapely, borders, chords and walks around a loop."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from toolaxis.numeric.polygons import chords, inside, inside_numpy, signed_area, slabs, stations, walk

SQUARE = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
HOLE = np.array([[1.0, 1.0], [1.0, 3.0], [3.0, 3.0], [3.0, 1.0]])


def star(count: int, seed: int, radius: float = 1.0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    reach = radius * rng.uniform(0.4, 1.0, count)
    return np.column_stack([reach * np.cos(angle), reach * np.sin(angle)])


@pytest.mark.parametrize("count", [3, 4, 17, 500, 3000])
def test_agrees_with_shapely(count: int) -> None:
    outer, hole = star(count, count), star(7, 5, 0.35)
    points = np.random.default_rng(2).uniform(-1.1, 1.1, (20000, 2))
    wanted = shapely.contains_xy(shapely.Polygon(outer), points) ^ shapely.contains_xy(shapely.Polygon(hole), points)
    table = slabs((outer, hole))
    assert np.array_equal(inside(table, points), wanted)
    assert np.array_equal(inside_numpy(table, points[:3000]), wanted[:3000])


def test_borders_and_corners_count_as_inside() -> None:
    table = slabs((SQUARE, HOLE))
    t = np.linspace(0, 4, 41)
    border = np.concatenate([walk(loop, t) for loop in (SQUARE, HOLE)])
    for answer in (inside, inside_numpy):
        assert answer(table, border).all()
        assert not answer(table, np.array([[2.0, 2.0], [-1e-9, 2.0], [4 + 1e-9, 0.0], [1 + 1e-9, 2.0]])).any()


def test_slanted_borders_count_as_inside() -> None:
    loop = star(29, 3) * [7.3, 11.7] + [100.0, -40.0]
    at = np.random.default_rng(0).uniform(0, 29, 2000)
    assert inside(slabs((loop,)), walk(loop, at)).mean() > 0.99
    outwards = 1e-9 * (walk(loop, at) - [100.0, -40.0])
    assert not inside(slabs((loop,)), walk(loop, at) + outwards).any()


@pytest.mark.parametrize("swap", [False, True])
@pytest.mark.parametrize("low", [0.0, 1000.0])
def test_borders_along_the_axes_count_as_inside_whatever_rounding_did(low: float, swap: bool) -> None:
    """A point counts as on an edge at the same distance above and below it as beside it."""
    rng, t = np.random.default_rng(4), np.linspace(0, 8, 81)
    for size in np.repeat([1e-18, 1e-17, 1e-16, 1e-15], 10) * (low + 1):
        loops = tuple((low + loop)[:, ::-1 if swap else 1] for loop in (SQUARE, HOLE))
        moved = tuple(loop + size * rng.uniform(-1, 1, loop.shape) for loop in loops)
        border = np.concatenate([walk(loop, t) for loop in loops])
        for answer in (inside, inside_numpy):
            assert answer(slabs(moved), border).all()


@given(st.floats(0.1, 50), st.floats(-300, 300), st.floats(-300, 300), st.booleans(), st.integers(0, 99))
@settings(max_examples=40, deadline=None)
def test_follows_scale_shift_swap_and_reversal(scale: float, x: float, y: float, swap: bool, seed: int) -> None:
    loop = star(23, seed)
    points = np.random.default_rng(seed).uniform(-1, 1, (300, 2))
    moved, there = loop * scale + [x, y], points * scale + [x, y]
    if swap:
        moved, there = moved[::-1, ::-1], there[:, ::-1]
    changed = inside(slabs((loop,)), points) != inside(slabs((moved,)), there)
    assert changed.sum() <= 1


def test_nan_and_infinite_points_are_outside() -> None:
    points = np.array([[np.nan, 2.0], [2.0, np.nan], [np.inf, 2.0], [2.0, -np.inf], [0.5, 0.5]])
    for answer in (inside, inside_numpy):
        assert answer(slabs((SQUARE,)), points).tolist() == [False, False, False, False, True]
    assert inside(slabs((SQUARE,)), np.empty((0, 2))).shape == (0,)


def test_a_closing_vertex_may_repeat_the_first() -> None:
    points = np.random.default_rng(2).uniform(-1, 5, (500, 2))
    closed = np.vstack([SQUARE, SQUARE[:1]])
    assert np.array_equal(inside(slabs((closed,)), points), inside(slabs((SQUARE,)), points))
    assert signed_area(closed) == signed_area(SQUARE) == 16.0
    assert signed_area(HOLE) == -4.0


def test_chords_of_a_square_with_a_hole() -> None:
    assert chords((SQUARE, HOLE), 2.0).tolist() == [[0.0, 1.0], [3.0, 4.0]]
    assert chords((SQUARE, HOLE), 0.5).tolist() == [[0.0, 4.0]]
    assert chords((SQUARE, HOLE), 5.0).shape == (0, 2)
    assert chords((SQUARE,), 0.0).tolist() == [[0.0, 4.0]]


def test_chords_add_up_to_the_area() -> None:
    loop = star(101, 4)
    lines = np.linspace(-1, 1, 4001)
    lengths = [np.diff(chords((loop,), y), axis=1).sum() for y in lines]
    assert np.trapezoid(lengths, lines) == pytest.approx(signed_area(loop), rel=1e-5)


def test_stations_hold_every_vertex_and_the_step() -> None:
    loop = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 1.0], [10.0, 1.0]])
    at = stations(loop, (3.0, 0.5))
    points = walk(loop, np.append(at, len(loop)))
    assert set(range(4)) <= set(at.tolist())
    step = np.abs(np.diff(points, axis=0))
    assert step[:, 0].max() <= 3.0 + 1e-12 and step[:, 1].max() <= 0.5 + 1e-12
    assert walk(loop, np.array([-0.5])).tolist() == walk(loop, np.array([3.5])).tolist()
