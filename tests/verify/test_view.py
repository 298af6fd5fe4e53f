"""Views of the judge's maps: the greatest value of each cell, nothing lost where cells grow."""

from types import SimpleNamespace

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.verify.axis_view import coarser, view_along

X, Y = np.array([0.6, 0.8, 0.0]), np.array([-0.8, 0.6, 0.0])


def scattered(seed, count=4000, hole=3.0):
    """Rays on a sheet of 30 x 20 mm around (5, 7, 2) with a hole, one of them never reached and one gouged."""
    rng = np.random.default_rng(seed)
    flat = rng.uniform((-15, -10), (15, 10), (count, 2))
    flat = flat[np.hypot(*flat.T) > hole]
    point = np.array([5.0, 7.0, 2.0]) + flat[:, :1] * X + flat[:, 1:] * Y
    point[:, 2] += rng.normal(size=len(flat))
    remaining, gouge = rng.uniform(0, 0.02, len(flat)), rng.uniform(0, 1e-4, len(flat))
    remaining[17], gouge[23] = np.inf, 0.004
    return SimpleNamespace(point=point, remaining=remaining, gouge=gouge, spacing=0.5), flat


@pytest.mark.parametrize("most", [90_000, 500])
def test_each_cell_has_the_greatest_of_its_rays(most):
    rays, flat = scattered(1)
    view = view_along([rays], X, Y, (5.0, 7.0, 2.0), most)
    assert view.cell == pytest.approx(0.5) if most > 500 else view.scallop.size <= 1.3 * most
    for value, cells in ((rays.remaining, view.scallop), (rays.gouge, view.gouge)):
        wanted = {}
        for (x, y), one in zip((flat - view.corner) // view.cell, value, strict=True):
            place = (min(int(y), cells.shape[0] - 1), min(int(x), cells.shape[1] - 1))
            wanted[place] = max(wanted.get(place, 0.0), np.float32(one))
        assert all(cells[place] == one for place, one in wanted.items())
    assert np.isinf(view.scallop).sum() >= 1 and view.gouge[np.isfinite(view.gouge)].max() == np.float32(0.004)


def test_where_there_is_no_face_there_is_no_value():
    rays, _ = scattered(2, hole=4.0)
    view = view_along([rays], X, Y, (5.0, 7.0, 2.0))
    centre = tuple((-view.corner[::-1] // view.cell).astype(int))
    assert np.isnan(view.scallop[centre]) and np.isnan(view.gouge[centre])
    rows, columns = np.indices(view.scallop.shape) + 0.5
    away = np.hypot(rows * view.cell + view.corner[1], columns * view.cell + view.corner[0])
    beside = (away > 4.6) & (rows > 3) & (rows < view.scallop.shape[0] - 3)
    assert np.isfinite(view.gouge[beside]).mean() > 0.99


def test_larger_cells_lose_nothing():
    rays, _ = scattered(3)
    view = view_along([rays], X, Y, (5.0, 7.0, 2.0))
    less = coarser(view, 200)
    step = round(less.cell / view.cell)
    assert less.scallop.size <= 260 and step > 1
    for fine, coarse in ((view.scallop, less.scallop), (view.gouge, less.gouge)):
        assert np.nanmax(fine) == np.nanmax(coarse)
        for row, column in ((0, 0), (2, 3), tuple(size - 1 for size in coarse.shape)):
            block = fine[row * step:(row + 1) * step, column * step:(column + 1) * step]
            wanted = np.nan if np.isnan(block).all() else np.nanmax(block)
            assert np.array_equal(coarse[row, column], wanted, equal_nan=True)
    assert coarser(view, 10**9) is view


def test_no_maps_are_refused():
    with pytest.raises(InvalidInput, match="no maps"):
        view_along([], X, Y, (0.0, 0.0, 0.0))
