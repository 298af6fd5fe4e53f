"""What trims leave of rectangles, against polygons cut by another library."""

import numpy as np
import pytest
import shapely

from toolaxis.contact.clearance.trimmed_cells import trim_cell

EDGES = [0.0, 0.25, 0.5, 0.75, 1.0]


def _loop(rng):
    """A staircase along the grid lines, some vertices off them by little."""
    steps = np.sort(rng.choice(5, 3, replace=False))
    (a, b, c), (f, e, d) = np.array(EDGES)[steps], np.array(EDGES)[np.sort(rng.choice(5, 3, replace=False))]
    loop = np.array([[0, 0], [c, 0], [c, d], [b, d], [b, e], [a, e], [a, f], [0, f]])
    off = 10.0**rng.uniform(-17, -8) * rng.standard_normal(loop.shape)
    return loop + off * rng.integers(0, 2, loop.shape)


@pytest.mark.parametrize("seed", range(8))
def test_the_box_holds_all_that_is_left(seed):
    rng = np.random.default_rng(seed)
    checked = 0
    while checked < 300:
        loop = _loop(rng)
        polygon = shapely.Polygon(loop).buffer(0)
        if polygon.area < 0.01:
            continue
        edges = np.hstack([loop, np.roll(loop, -1, axis=0)])
        reference = np.append(rng.uniform(-0.1, 1.1, 2), 0.0)
        reference[2] = polygon.contains(shapely.Point(reference[:2]))
        (u0, u1), (v0, v1) = np.sort(rng.choice(5, 2, replace=False)) / 4, np.sort(rng.choice(5, 2, replace=False)) / 4
        rect = ((u0 + u1) / 2, (v0 + v1) / 2, (u1 - u0) / 2, (v1 - v0) / 2)
        count, u, v, du, dv = trim_cell(edges, reference, rect, np.empty((len(edges) * 2 + 4, 2)))
        left = polygon.intersection(shapely.box(u0, v0, u1, v1).buffer(-1e-6))
        checked += 1
        if left.area < 1e-6:
            continue
        assert count >= 0
        low, high = np.array(left.bounds).reshape(2, 2)
        assert (np.array([u - du, v - dv]) <= low + 1e-8).all() and (np.array([u + du, v + dv]) >= high - 1e-8).all()
