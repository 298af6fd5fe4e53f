"""Nodes of grids."""

from itertools import product

import numpy as np
import pytest

from toolaxis.numeric.grids import grid_nodes, grid_rows

LINES = [([0.0, 1.0],), ([0.0, 1.0, 3.0], [5.0, 6.0]), ([0.0], [1.0, 2.0], [3.0, 4.0]), ([], [1.0])]


@pytest.mark.parametrize("lines", LINES)
def test_rows_are_all_pairs_and_the_last_coordinate_changes_fastest(lines: tuple[list[float], ...]) -> None:
    assert [tuple(row) for row in grid_rows(*lines)] == list(product(*lines))


@pytest.mark.parametrize("lines", LINES)
def test_nodes_are_found_by_the_numbers_of_their_lines(lines: tuple[list[float], ...]) -> None:
    nodes = grid_nodes(*lines)
    assert nodes.shape == (*map(len, lines), len(lines))
    for where in np.ndindex(*nodes.shape[:-1]):
        assert nodes[where].tolist() == [line[k] for line, k in zip(lines, where, strict=True)]
