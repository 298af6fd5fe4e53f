"""Thinned polylines stay within their bound of every point that was left out."""

from itertools import pairwise

import numpy as np
import pytest

from toolaxis.numeric.simplify_polyline import simplify_loop, simplify_polyline


def farthest(points: np.ndarray, kept: np.ndarray) -> float:
    """Greatest distance of a point from the segment that takes its place, by brute force."""
    worst = 0.0
    for first, last in pairwise(kept):
        a, b = points[first], points[last]
        share = np.linspace(0, 1, 2001)[:, None]
        line = a + share * (b - a)
        for point in points[first:last + 1]:
            worst = max(worst, float(np.linalg.norm(line - point, axis=1).min()))
    return worst


@pytest.mark.parametrize("bound", [0.3, 0.03])
def test_no_point_is_farther_than_the_bound(bound: float) -> None:
    t = np.linspace(0, 7, 400)
    points = np.stack([5 * np.cos(t), 5 * np.sin(t), t + np.random.default_rng(1).normal(0, 0.01, 400)], axis=1)
    kept = simplify_polyline(points, bound)
    assert farthest(points, kept) <= bound + 1e-3
    assert kept[0] == 0 and kept[-1] == 399 and (np.diff(kept) > 0).all()
    if bound == 0.3:  # an arc of r = 5 needs a chord for every 2 acos(1 - 0.3 / 5)
        assert 7 / (2 * np.arccos(1 - 0.31 / 5)) <= len(kept) <= 30


def test_straight_lines_keep_their_ends_and_a_negative_bound_keeps_all() -> None:
    line = np.linspace([0.0, 1, 2], [3.0, 4, 9], 50)
    assert simplify_polyline(line, 1e-9).tolist() == [0, 49]
    assert simplify_polyline(line, -1.0).tolist() == list(range(50))
    assert simplify_polyline(line[:1], 1.0).tolist() == [0] and simplify_polyline(line[:0], 1.0).tolist() == []


def test_loops_keep_three_vertices_and_their_shape() -> None:
    t = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    ring = np.stack([np.cos(t), np.sin(t)], axis=1)
    kept = simplify_loop(ring, 0.01)
    closed = np.concatenate([kept, [300]])
    assert farthest(np.vstack([ring, ring[:1]]), closed) <= 0.0101 and len(kept) < 60
    assert len(simplify_loop(ring, 10.0)) == 3
    square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    assert simplify_loop(square, 0.1).tolist() == [0, 1, 2, 3]
