"""Few axes for many sub-surfaces: the integer programme against enumeration, and the joint division."""

from importlib import import_module
from itertools import combinations, pairwise

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.partition.face_division import Divider
from toolaxis.partition.shared_axes import cover, divide_with_shared_axes, knee, trade
from toolaxis.search.face_problem import task


@pytest.mark.parametrize("seed", range(8))
def test_cover_is_the_cheapest(seed: int) -> None:
    rng = np.random.default_rng(seed)
    costs = rng.uniform(100, 900, (5, 9))
    costs[rng.random(costs.shape) < 0.3] = np.inf
    costs[:, 0] = 2000
    for most, index in ((1, 0.0), (2, 50.0), (3, 10.0), (9, 300.0)):
        best = min(costs[:, list(axes)].min(axis=1).sum() + index * len(axes)
                   for n in range(1, most + 1) for axes in combinations(range(9), n))
        found = cover(costs, most, index)
        assert found.cost == pytest.approx(best, rel=1e-9)
        assert found.bound == pytest.approx(best, rel=1e-6)
        assert len(np.unique(found.axis)) <= most


def test_twelve_sub_surfaces_and_400_axes_are_solved_exactly() -> None:
    rng = np.random.default_rng(1)
    costs = rng.uniform(100, 900, (12, 400))
    found = cover(costs, 4, 100.0)
    assert found.bound == pytest.approx(found.cost, rel=1e-6)
    greedy: list[int] = []
    for _ in range(4):
        greedy.append(int(np.argmin([costs[:, [*greedy, k]].min(axis=1).sum() for k in range(400)])))
    assert found.cost <= costs[:, greedy].min(axis=1).sum() + 400.0 + 1e-6


def test_out_of_time_a_choice_is_still_made_and_its_bound_holds(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(4)
    costs = rng.uniform(100, 900, (20, 120))
    costs[rng.random(costs.shape) < 0.5] = np.inf
    best = cover(costs, 5, 50.0)
    assert best.bound == pytest.approx(best.cost, rel=1e-6)
    monkeypatch.setattr(import_module("toolaxis.partition.shared_axes"), "_SECONDS", 1e-6)
    found = cover(costs, 5, 50.0)
    assert np.isfinite(found.cost) and len(np.unique(found.axis)) <= 5
    assert found.bound <= best.cost * (1 + 1e-9) <= found.cost * (1 + 1e-9)
    assert found.cost == pytest.approx(costs[np.arange(20), found.axis].sum() + 50.0 * len(np.unique(found.axis)))


def test_what_no_axis_serves_is_said() -> None:
    with pytest.raises(ta.InvalidInput, match="no axis that may be used"):
        cover([[1.0, 2.0], [np.inf, np.inf]])
    with pytest.raises(ta.InvalidInput, match="allow more orientations"):
        cover([[1.0, np.inf], [np.inf, 1.0]], 1)


@pytest.fixture(scope="module")
def dividers() -> list[Divider]:
    """Two strongly waved faces beside each other."""
    x, y = np.meshgrid(np.linspace(0, 60, 7), np.linspace(0, 60, 7), indexing="ij")
    faces = [ta.Face.from_bspline(np.stack([x + 70 * k, y, 10 * np.sin(np.pi * x / 30) * np.cos(np.pi * y / 30)], -1))
             for k in (0, 1)]
    return [Divider(task(face, ta.Tool.torus(12, 1), 0.05), cells=(12, 12), most=4) for face in faces]


def test_two_faces_share_axes(dividers: list[Divider]) -> None:
    faces = [divider.job.worth.face for divider in dividers]
    lengths = []
    for most in (1, 4):
        found = divide_with_shared_axes(dividers, most)
        assert found.orientations <= most
        axes = np.unique(np.concatenate([one.axes for one in found.regions]), axis=0)
        assert len(axes) == found.orientations
        for face, one in zip(faces, found.regions, strict=True):
            assert sum(piece.area for piece in one) == pytest.approx(face.area, rel=1e-6)
        lengths.append(found.length)
    assert lengths[1] < 0.97 * lengths[0]


def test_more_axes_cut_less_and_the_knee_is_where_little_is_gained_beyond(dividers: list[Divider]) -> None:
    options, chosen = trade(dividers, 4)
    counts, lengths = [one.orientations for one in options], [one.length for one in options]
    assert len(options) >= 3 and counts[0] == 1 and counts == sorted(set(counts)) and counts[-1] <= 4
    assert all(after < before for before, after in pairwise(lengths))
    assert lengths[0] == pytest.approx(divide_with_shared_axes(dividers, 1, 0.0).length, rel=0.02)
    assert chosen == knee(counts, lengths)
    for one in options:
        assert one.pieces == sum(len(regions) for regions in one.regions)
        assert len(np.unique(np.concatenate([r.axes for r in one.regions]), axis=0)) == one.orientations


def test_the_knee_lies_farthest_below_the_line_between_the_ends() -> None:
    assert knee([1, 2, 3, 4, 5], [100.0, 50, 40, 35, 30]) == 1
    assert knee([1, 4, 8], [10.0, 9, 1]) == 0 and knee([1, 2], [9.0, 8]) == 1 and knee([3], [5.0]) == 0
