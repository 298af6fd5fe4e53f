"""Places one after the other on a surface: the numbers of `surface_derivatives` to the last bit, wherever they lie."""

from typing import Any

import numpy as np
import pytest

from toolaxis.numeric.bspline import WORK_SHAPE, surface_derivatives
from toolaxis.numeric.jit import jit
from toolaxis.numeric.lanes import Lanes, add_scaled, lane, load_lanes, no_lanes, scale, shrink
from toolaxis.numeric.surface_walk import new_walk, walk_derivatives, walk_slopes


def surface(degree: tuple[int, int], rational: bool) -> Any:
    """On about [-1, 4] in u and v, with a knot that stands twice."""
    rng = np.random.default_rng(7)
    counts = degree[0] + 5, degree[1] + 4
    weights = rng.uniform(0.5, 2, counts) if rational else np.ones(counts)
    control = np.concatenate([rng.normal(0, 30, (*counts, 3)) * weights[..., None], weights[..., None]], axis=2)
    inner = [np.sort(rng.uniform(-1, 4, n - p - 1)) for n, p in zip(counts, degree, strict=True)]
    inner[0][1] = inner[0][0]
    ends = [(np.full(p + 1, -1.3), np.full(p + 1, 4.2)) for p in degree]
    knots = [np.concatenate([low, middle, high]) for (low, high), middle in zip(ends, inner, strict=True)]
    return knots[0], knots[1], control, degree[0], degree[1], rational


def places(data: Any) -> dict[str, np.ndarray]:
    """Inside, close to each other, beyond every border, and on knots."""
    rng = np.random.default_rng(8)
    return {"inside": rng.uniform(-1.3, 4.2, (300, 2)),
            "near": np.clip(1.5 + np.cumsum(rng.normal(0, 0.05, (600, 2)), axis=0), -1.3, 4.2),
            "beyond": rng.uniform(-3.0, 6.0, (300, 2)),
            "knots": np.column_stack([rng.choice(data[0], 100), rng.choice(data[1], 100)])}


@pytest.mark.parametrize("where", ["inside", "near", "beyond", "knots"])
@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize("degree", [(3, 3), (2, 3), (2, 2), (1, 3), (2, 1), (3, 5), (1, 1)])
def test_a_walk_gives_the_same_numbers(degree: tuple[int, int], rational: bool, where: str) -> None:
    data = surface(degree, rational)
    walk, walk_of_slopes, work = new_walk(), new_walk(), np.empty(WORK_SHAPE)
    wanted, found, slopes = np.empty((6, 3)), np.empty((6, 3)), np.empty((6, 3))
    for u, v in places(data)[where]:
        surface_derivatives(data, u, v, wanted, work)
        walk_derivatives(data, u, v, found, walk)
        walk_slopes(data, u, v, slopes, walk_of_slopes)
        np.testing.assert_array_equal(found, wanted)
        np.testing.assert_array_equal(slopes[:3], wanted[:3])


def test_one_walk_serves_both() -> None:
    data = surface((3, 3), False)
    walk, work = new_walk(), np.empty(WORK_SHAPE)
    wanted, found = np.empty((6, 3)), np.empty((6, 3))
    for k, (u, v) in enumerate(places(data)["near"]):
        surface_derivatives(data, u, v, wanted, work)
        if k % 2:
            walk_slopes(data, u, v, found, walk)
        else:
            walk_derivatives(data, u, v, found, walk)
        np.testing.assert_array_equal(found[:3], wanted[:3])


def test_where_nothing_is_a_number_there_is_none() -> None:
    data, found = surface((3, 3), False), np.zeros((6, 3))
    walk_derivatives(data, np.nan, 1.0, found, new_walk())
    assert np.isnan(found[:3]).all()


@jit
def _four(table: np.ndarray, share: float, out: np.ndarray) -> None:
    lanes: Lanes = add_scaled(no_lanes(), share, load_lanes(table, 1, 0))
    lanes = add_scaled(scale(share, lanes), share, load_lanes(table, 0, 1))
    out[0], out[1], out[2], out[3] = lane(lanes, 0), lane(lanes, 1), lane(lanes, 2), lane(lanes, 3)
    lanes = shrink(share, lanes)
    out[4], out[5], out[6], out[7] = lane(lanes, 0), lane(lanes, 1), lane(lanes, 2), lane(lanes, 3)


def test_lanes_are_four_numbers() -> None:
    table, out = np.arange(16.0).reshape(2, 2, 4), np.empty(8)
    _four(table, 0.5, out)
    wanted = 0.25 * table[1, 0] + 0.5 * table[0, 1]
    np.testing.assert_array_equal(out, [*wanted, *(2.0 * wanted)])


def test_lanes_are_read_from_any_table() -> None:
    table, out = np.arange(16.0).reshape(2, 2, 4), np.empty(8)
    _four(table, 0.5, out)
    turned = np.empty(8)
    _four(np.asfortranarray(table), 0.5, turned)
    np.testing.assert_array_equal(turned, out)
