"""Polygons divided by polygons, and contours: areas add up, and another library's boolean operations agree."""

import numpy as np
import pytest
import shapely

from toolaxis.errors import InvalidInput
from toolaxis.numeric.contours import contours
from toolaxis.numeric.polygon_boolean import (
    _crossings,
    _find_crossings,
    _find_crossings_plainly,
    cut_spikes,
    divide_nearly,
    divide_polygon,
    join_touching,
    unite_polygons,
    without,
)
from toolaxis.numeric.polygons import inside, signed_area, slabs
from toolaxis.numeric.sparse_grid import SparseGrid

SQUARE = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])


def circle(x: float, y: float, radius: float, count: int = 101) -> np.ndarray:
    t = np.linspace(0, 2 * np.pi, count, endpoint=False) + 0.1234
    return np.column_stack([x + radius * np.cos(t), y + radius * np.sin(t)])


def area(loops: tuple[np.ndarray, ...]) -> float:
    """Even-odd area of loops that do not cross, each counted by how many others hold it."""
    total = 0.0
    for k, loop in enumerate(loops):
        others = [other for i, other in enumerate(loops) if i != k]
        depth = sum(int(inside(slabs((other,)), (loop[:1] + loop[1:2]) / 2)[0]) for other in others)
        total += (-1) ** depth * abs(signed_area(loop))
    return total


@pytest.mark.parametrize("other", [circle(0, 0, 2), circle(2, 2, 1), circle(2, 2, 5), circle(9, 9, 1),
                                   circle(2, 2, 2.4), circle(4, 2, 0.5)])
def test_two_sides_are_the_whole(other: np.ndarray) -> None:
    hole = circle(2.7, 1.9, 0.8)
    within, beyond = divide_polygon((SQUARE, hole), (other,))
    assert area(within) + area(beyond) == pytest.approx(16 - abs(signed_area(hole)), rel=1e-12)
    uv = np.random.default_rng(1).uniform(-1, 5, (2000, 2))
    whole, cut = inside(slabs((SQUARE, hole)), uv), inside(slabs((other,)), uv)
    for loops, wanted in ((within, whole & cut), (beyond, whole & ~cut)):
        assert (inside(slabs(loops), uv) == wanted).all() if loops else not wanted.any()


def test_random_polygons_agree_with_shapely() -> None:
    shapely = pytest.importorskip("shapely")
    rng = np.random.default_rng(5)
    for _ in range(60):
        loops = []
        for centre in rng.uniform(-0.6, 0.6, (2, 2)):
            t = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(5, 40)))
            if np.diff(np.append(t, t[0] + 2 * np.pi)).max() > np.pi:
                continue
            loops.append(centre + rng.uniform(0.3, 1.2, len(t))[:, None] * np.column_stack([np.cos(t), np.sin(t)]))
        if len(loops) < 2:
            continue
        one, other = map(shapely.Polygon, loops)
        within, beyond = divide_polygon((loops[0],), (loops[1],))
        assert area(within) == pytest.approx(one.intersection(other).area, rel=1e-9)
        assert area(beyond) == pytest.approx(one.difference(other).area, rel=1e-9)


def test_nothing_divides_into_nothing() -> None:
    assert divide_polygon((), (SQUARE,)) == ((), ())
    assert divide_polygon((SQUARE,), ()) == ((), (SQUARE,))


def test_a_corner_on_a_border_is_refused_or_right() -> None:
    wedge = np.array([[2.0, 4.0], [1.0, 6.0], [3.0, 6.0]])
    try:
        within, beyond = divide_polygon((SQUARE,), (wedge,))
    except InvalidInput:
        return
    assert area(within) == pytest.approx(0, abs=1e-9)
    assert area(beyond) == pytest.approx(16)


def test_contours_of_a_ring_lie_on_both_circles() -> None:
    def ring(uv: np.ndarray) -> np.ndarray:
        return 0.6 - np.abs(np.hypot(*uv.T) - 1.5)

    line = np.linspace(-3, 3, 40)
    values = ring(np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)).reshape(40, 40)
    loops = contours(SparseGrid.of_all((line, line), values), ring)
    assert sorted(float(np.hypot(*loop.T).mean()) for loop in loops) == pytest.approx([0.9, 2.1], abs=1e-3)
    assert max(float(np.abs(ring(loop)).max()) for loop in loops) < 1e-6
    assert area(loops) == pytest.approx(np.pi * (2.1**2 - 0.9**2), rel=0.01)


def test_nodes_below_zero_need_not_be_known_for_the_same_contours() -> None:
    def waves(uv: np.ndarray) -> np.ndarray:
        return np.sin(3 * uv[:, 0]) * np.cos(2.3 * uv[:, 1]) - 0.2

    line = np.linspace(-3, 3, 61)
    values = waves(np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2))
    every = SparseGrid.of_all((line, line), values.reshape(61, 61))
    some = np.flatnonzero(values > 0)
    few = SparseGrid.join((line, line), [some[::2], some], [np.full(len(some[::2]), -9.0), values[some]])
    assert few.above.tolist() == every.above.tolist()
    assert (few.values_at(np.arange(61 * 61)) == np.where(values > 0, values, -1)).all()
    for one, other in zip(contours(every, waves), contours(few, waves), strict=True):
        assert (one == other).all()


def test_contours_are_closed_along_the_border_of_the_grid() -> None:
    line = np.linspace(0, 1, 5)
    (loop,) = contours(SparseGrid.of_all((line, line), np.ones((5, 5))))
    assert abs(signed_area(loop)) == pytest.approx(1)
    assert contours(SparseGrid.of_all((line, line), -np.ones((5, 5)))) == ()


def test_a_saddle_gives_lines_that_do_not_cross() -> None:
    line = np.arange(4.0)
    values = np.where((np.indices((4, 4)).sum(axis=0) % 2) == 0, 1.0, -0.5)
    loops = contours(SparseGrid.of_all((line, line), values))
    centre = np.array([[1.5, 1.5]])
    assert sum(int(inside(slabs((loop,)), centre)[0]) for loop in loops) % 2 == 1


def test_a_polygon_without_a_piece_of_it_is_the_rest() -> None:
    hole = circle(2.7, 1.9, 0.8)
    within, beyond = divide_polygon((SQUARE, hole), (circle(4, 2, 1.7),))
    rest = without((SQUARE, hole), within)
    assert area(rest) == pytest.approx(area(beyond), rel=1e-12)
    uv = np.random.default_rng(7).uniform(-1, 5, (2000, 2))
    assert (inside(slabs(rest), uv) == inside(slabs(beyond), uv)).all()
    assert without((SQUARE,), (SQUARE[::-1],)) == ()


def test_polygons_beside_each_other_become_one():
    right = np.array([[4.0, 1.0], [7.0, 0.0], [7.0, 6.0], [4.0, 6.0]])
    whole = unite_polygons((SQUARE, circle(1, 1, 0.5)), (right, circle(6, 3, 0.5)))
    parts = area((SQUARE, circle(1, 1, 0.5))) + area((right, circle(6, 3, 0.5)))
    assert len(whole) == 3 and area(whole) == pytest.approx(parts)
    assert inside(slabs(whole), np.array([[4.0, 3.0], [3.9, 0.5], [4.1, 0.5], [4.1, 5.0]])).tolist() == [True, True,
                                                                                                     False, True]


def test_the_kernel_finds_the_crossings_of_its_plain_twin() -> None:
    random = np.random.default_rng(5)
    one, other = (random.random((60, 2)) for _ in range(2))
    edges = [np.roll(loop, -1, axis=0) - loop for loop in (one, other)]
    plain = _find_crossings_plainly(one, edges[0], other, edges[1])
    found = np.empty((len(plain), 4))
    assert len(plain) > 120 and _find_crossings(one, edges[0], other, edges[1], found) == len(plain)
    assert np.abs(found - plain).max() < 1e-12
    few, shares, points = _crossings((one,), (other,))
    assert np.array_equal(few[:, 0], plain[:, 0]) and len(shares) == len(points) == len(plain)


@pytest.mark.parametrize("seed", range(8))
def test_a_polygon_with_a_spike_divides_as_without_it(seed: int) -> None:
    """Found: a piece of a skin ran along a border and back; nothing was divided by it, and a whole face counted as its.
    """
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, 2 * np.pi)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    base, tip = np.array([8.0, rng.uniform(0, 4)]), rng.uniform(2.5, 3.5, 2)
    # A slit from the border of the piece across that of the square.
    piece = np.array([[2.0, -1.0], [8.0, -1.0], base, tip, base, base, [8.0, 5.0], [2.0, 5.0]]) @ turn
    whole = SQUARE @ turn
    with pytest.raises(InvalidInput):
        divide_polygon((whole,), (piece,))
    inside, outside = divide_nearly((whole,), (piece,))
    wanted = shapely.Polygon(np.delete(piece, [3, 4, 5], axis=0)).intersection(shapely.Polygon(whole)).area
    assert area(inside) == pytest.approx(wanted, rel=1e-5)
    assert area(inside) + area(outside) == pytest.approx(16.0, rel=1e-9)
    assert len(cut_spikes(piece)) == 5 and len(cut_spikes(whole)) == 4


@pytest.mark.parametrize("seed", range(8))
def test_rests_side_by_side_divide_as_one(seed: int) -> None:
    """Found: rests that larger tools had left shared borders; no smaller tool took a piece across these from them."""
    rng = np.random.default_rng(seed)
    inner, outer = divide_polygon((SQUARE,), (circle(*rng.uniform(1, 3, 2), rng.uniform(0.8, 2.5), 37),))
    rests = (*inner, *outer)
    piece = circle(*rng.uniform(1, 3, 2), rng.uniform(1.0, 2.5))
    with pytest.raises(InvalidInput):
        divide_polygon(rests, (piece,))
    inside, outside = divide_nearly(rests, (piece,))
    wanted = shapely.Polygon(piece).intersection(shapely.Polygon(SQUARE)).area
    assert area(inside) == pytest.approx(wanted, rel=1e-5)
    assert area(inside) + area(outside) == pytest.approx(16.0, rel=1e-9)


@pytest.mark.parametrize("seed", range(60))
def test_a_piece_along_the_longest_side_is_not_taken_for_the_rest(seed: int) -> None:
    """Found: on a side that both share rounding decided, and the judge was told the rest in place of the piece."""
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, 2 * np.pi)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    whole = np.array([[-2.0, 0.0], [2.0, 0.0], [2.5, 1.0], [2.0, 2.0], [0.0, 2.5], [-2.0, 2.0], [-2.5, 1.0]]) @ turn
    left, right = np.sort(rng.uniform(-1.9, 1.9, 2))
    piece = np.array([[left, 0.0], [right, 0.0], [right, 0.8], [(left + right) / 2, 1.2], [left, 0.8]]) @ turn
    inside, outside = divide_nearly((whole,), (piece,))
    wanted = abs(float(signed_area(piece)))
    assert area(inside) == pytest.approx(wanted, rel=1e-4)
    assert area(inside) + area(outside) == pytest.approx(abs(float(signed_area(whole))), rel=1e-9)


def test_nothing_is_left_of_a_loop_that_only_goes_there_and_back() -> None:
    assert len(cut_spikes(np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [1.0, 1.0]]))) < 3


def test_borders_that_loops_share_cancel_out() -> None:
    """Two squares side by side, the second with a corner more, and a hole that runs along the border of the first."""
    beside = np.array([[4.0, 0.0], [8.0, 0.0], [8.0, 4.0], [4.0, 4.0], [4.0, 1.5]])
    notch = np.array([[0.0, 1.0], [1.0, 2.0], [0.0, 3.0]])
    (joined,) = join_touching((SQUARE, beside, notch))
    assert abs(signed_area(joined)) == pytest.approx(31.0, abs=1e-12)
    places = np.random.default_rng(5).uniform(-1, 9, (2000, 2))
    odd = sum(inside(slabs((loop,)), places).astype(int) for loop in (SQUARE, beside, notch)) % 2 == 1
    assert (inside(slabs((joined,)), places) == odd).all()
    assert divide_polygon((joined,), (circle(4, 2, 1),))[0]
    assert join_touching(()) == ()
