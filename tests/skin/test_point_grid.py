"""The nearest of points in cells are those of a tree."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from toolaxis.skin.point_grid import find_nearest, sort_into_cells

RANDOM = np.random.default_rng(11)


@pytest.mark.parametrize(("count", "shape", "size"), [(400, (3.0, 1.0), None), (400, (3.0, 1.0), 0.5),
                                                      (2, (1.0, 1.0), None), (60, (5.0, 0.0), None),
                                                      (1, (0.0, 0.0), 1.0)])
def test_the_nearest_points_are_those_of_a_tree(count: int, shape: tuple[float, float], size: float | None) -> None:
    points = RANDOM.random((count, 2)) * shape
    places = 3 * RANDOM.random((300, 2)) * np.add(shape, 0.3) - shape
    grid, most = sort_into_cells(points, size), min(count, 3)
    nearest, square = np.empty(3, dtype=np.int64), np.empty(3)
    away, number = (found.reshape(300, most) for found in cKDTree(points).query(places, k=most))
    for k, (x, y) in enumerate(places):
        find_nearest(grid, x, y, np.inf, nearest, square)
        assert np.array_equal(nearest[:most], number[k]) and (nearest[most:] == -1).all()
        assert np.abs(np.sqrt(square[:most]) - away[k]).max() < 1e-14


def test_a_search_with_a_limit_finds_what_is_nearer() -> None:
    points, places = RANDOM.random((300, 2)), 2 * RANDOM.random((300, 2)) - 0.5
    grid = sort_into_cells(points, 0.05)
    nearest, square = np.empty(3, dtype=np.int64), np.empty(3)
    away, number = cKDTree(points).query(places, k=3)
    for k, (x, y) in enumerate(places):
        find_nearest(grid, x, y, 0.1, nearest, square)
        assert (square[0] < 0.01) == (away[k, 0] < 0.1)
        if away[k, 0] < 0.1:
            assert np.array_equal(nearest, number[k])
