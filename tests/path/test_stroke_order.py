"""The order of strokes: side by side where passes are interrupted, and never before what lies beside them."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.path.links import CuttingMove
from toolaxis.path.stroke_order import OrderedStroke, order_strokes

Array = NDArray[np.float64]
Index = NDArray[np.intp]

STEP_OVER = 0.5


def strokes_on(lines: list[list[tuple[float, float]]]) -> tuple[list[CuttingMove], Array, Index]:
    """Strokes from x to x on a plane, a list for each pass; passes lie half a millimetre apart."""
    rows = [(low, high, STEP_OVER * k, k) for k, line in enumerate(lines) for low, high in line]
    pieces = np.array([row[:3] for row in rows])
    moves = []
    for low, high, step, _ in rows:
        tip = np.array([[low, step, 0.0], [high, step, 0.0]])
        moves.append(CuttingMove(tip, tip, np.tile([0.0, 0.0, 1.0], (2, 1))))
    return moves, pieces, np.array([row[3] for row in rows], dtype=np.intp)


def ordered(lines: list[list[tuple[float, float]]], sense: int | None = None) -> list[OrderedStroke]:
    moves, pieces, owner = strokes_on(lines)
    return [one for some in order_strokes([move.tip for move in moves], pieces, owner, sense) for one in some]


def way_between(lines: list[list[tuple[float, float]]], order: list[OrderedStroke]) -> float:
    """What the ways between strokes come to, mm."""
    moves, _, _ = strokes_on(lines)
    ends = [moves[one.number].tip[::one.sense] for one in order]
    return sum(float(np.linalg.norm(after[0] - before[-1])) for before, after in pairwise(ends))


def test_passes_of_one_stroke_go_to_and_fro() -> None:
    order = ordered([[(0, 10)]] * 5)
    assert order == [OrderedStroke(k, (-1) ** k) for k in range(5)]
    assert ordered([[(0, 10)]] * 3, sense=-1) == [OrderedStroke(k, -1) for k in range(3)]


def test_one_side_of_a_gap_is_cut_before_the_other() -> None:
    lines: list[list[tuple[float, float]]] = [[(0, 10), (50, 60)]] * 8
    order = ordered(lines)
    assert [one.number for one in order] == [*range(0, 16, 2), *range(15, 0, -2)] or \
        [one.number for one in order] == [*range(0, 16, 2), *range(1, 16, 2)]
    assert way_between(lines, order) < 60, "the gap is crossed once, not eight times"
    senses = [one.sense for one in order[:8]]
    assert senses == [(-1) ** k for k in range(8)]


def test_it_goes_round_a_hole_and_on_behind_it() -> None:
    lines: list[list[tuple[float, float]]] = [[(0, 60)], *[[(0, 10), (50, 60)]] * 6, [(0, 60)], [(0, 60)]]
    order = ordered(lines)
    numbers = [one.number for one in order]
    assert numbers[0] == 0 and numbers[-2:] == [13, 14]
    sides = [number % 2 for number in numbers[1:13]]
    assert sum(before != after for before, after in pairwise(sides)) == 1, "one side, then the other"


def test_all_go_one_way_where_that_is_asked_for() -> None:
    order = ordered([[(0, 10), (50, 60)]] * 4, sense=1)
    assert {one.sense for one in order} == {1} and sorted(one.number for one in order) == list(range(8))


def overlap(pieces: Array, one: int, other: int) -> bool:
    return bool(pieces[one, 0] < pieces[other, 1] and pieces[one, 1] > pieces[other, 0])


@pytest.mark.parametrize("sense", [None, 1, -1])
@pytest.mark.parametrize("seed", range(8))
def test_each_stroke_once_and_after_those_that_it_lies_beside(seed: int, sense: int | None) -> None:
    rng = np.random.default_rng(seed)
    lines = []
    for _ in range(12):
        ends = np.sort(rng.uniform(0, 80, 2 * int(rng.integers(1, 5))))
        lines.append([(float(low), float(high)) for low, high in ends.reshape(-1, 2)])
    moves, pieces, owner = strokes_on(lines)
    passes = order_strokes([move.tip for move in moves], pieces, owner, sense)
    order = [one for some in passes for one in some]
    assert sorted(one.number for one in order) == list(range(len(moves)))
    assert all(len({owner[one.number] for one in some}) == 1 for some in passes)
    place = {one.number: k for k, one in enumerate(order)}
    for one in range(len(moves)):
        for earlier in np.flatnonzero(owner < owner[one]):
            if overlap(pieces, one, int(earlier)):
                assert place[int(earlier)] < place[one]
    by_pass = [OrderedStroke(int(j), (-1) ** k if sense is None else sense) for k, number in enumerate(np.unique(owner))
               for j in np.flatnonzero(owner == number)[::(-1) ** k if sense is None else sense]]
    assert way_between(lines, order) <= way_between(lines, by_pass) + 20 * len(moves)


def test_a_face_with_a_slot_is_cut_with_less_travel() -> None:
    """The slot lies across the passes: pass by pass it would be crossed by each of them."""
    x, y = np.meshgrid(np.linspace(0, 60, 8), np.linspace(0, 30, 6), indexing="ij")
    sheet = ta.Face.from_bspline(np.stack([x, y, 0.3 * np.sin(x / 9)], axis=-1))
    outline, slot = sheet.outline[0], np.array([[0.3, 0.2], [0.3, 0.8], [0.7, 0.8], [0.7, 0.2]])
    low, high = outline.min(axis=0), outline.max(axis=0)
    face = sheet.trimmed((outline, low + slot * (high - low)))
    path = ta.passes(face, ta.Tool.ball(6), [0, 0, 1], 0.05, "u")
    across = np.abs(np.diff(path.cl[:, 0]))[path.kind[1:] == Motion.LINK]
    assert path.passes > 30 and (across > 15).sum() == 2, "there and back"
