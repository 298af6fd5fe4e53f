"""The choice of tools for faces, against plain enumeration and by hand."""

import itertools

import numpy as np
import pytest

from toolaxis.regions.tool_choice import FacePrices, ToolChain, chains_of, choose_tools


def prices(rng: np.random.Generator, tools: int, axes: int = 3, cells: int = 8) -> FacePrices:
    """Large tools are quick and reach little, small ones are slow and reach more."""
    pace = np.linspace(1.0, 4.0, tools)[:, None, None]
    seconds = pace * rng.uniform(0.5, 1.5, (tools, axes, cells))
    hidden = rng.random((tools, axes, cells)) > np.linspace(0.5, 0.95, tools)[:, None, None]
    return FacePrices(np.where(hidden, np.inf, seconds), rng.uniform(1.0, 2.0, cells))


def enumerated(chains: list[tuple[ToolChain, ...]], change: float) -> float:
    """The least cost of all ways to take a chain for each face."""
    return min(sum(one.cost for one in some) + change * len({tool for one in some for tool in one.tools})
               for some in itertools.product(*chains))


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("change", [0.0, 3.0, 40.0])
def test_no_other_choice_is_cheaper(seed: int, change: float) -> None:
    rng = np.random.default_rng(seed)
    chains = [chains_of(prices(rng, 4), 2.0, most=2) for _ in range(4)]
    found = choose_tools(chains, change)
    cost = sum(one.cost for one in found.chains) + change * len(found.tools)
    assert cost == pytest.approx(enumerated(chains, change), rel=1e-9)
    assert found.gap <= 1e-6
    assert found.tools == tuple(sorted({tool for one in found.chains for tool in one.tools}))
    assert found.seconds == pytest.approx(cost - sum(one.charge for one in found.chains), rel=1e-9)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("most", [1, 2, 3])
def test_no_other_choice_of_so_many_tools_is_cheaper(seed: int, most: int) -> None:
    chains = [chains_of(prices(np.random.default_rng([seed, k]), 4), 2.0, most=2) for k in range(3)]
    found = choose_tools(chains, 3.0, most)
    assert len(found.tools) <= most
    cost = sum(one.cost for one in found.chains) + 3.0 * len(found.tools)
    ways = [some for some in itertools.product(*chains) if len({tool for one in some for tool in one.tools}) <= most]
    least = min((sum(one.cost for one in some) + 3.0 * len({tool for one in some for tool in one.tools})
                 for some in ways), default=np.inf)
    if all(one.tools for one in found.chains):
        assert cost == pytest.approx(least, rel=1e-9)
    else:
        assert cost <= least


def test_a_face_that_no_allowed_tool_reaches_is_left_alone() -> None:
    seconds = np.array([[[1.0, 1.0]], [[np.inf, np.inf]]]), np.array([[[np.inf, np.inf]], [[5.0, 5.0]]])
    chains = [chains_of(FacePrices(one, np.ones(2)), 0.0) for one in seconds]
    found = choose_tools(chains, 1.0, 1)
    assert found.tools == (1,) and [one.tools for one in found.chains] == [(), (1,)], "the dearer face is served"


def test_one_tool_serves_all_where_changes_cost_more_than_they_save() -> None:
    quick_on_first = FacePrices(np.array([[[1.0, 1.0]], [[2.0, 2.0]]]), np.ones(2))
    only_small = FacePrices(np.array([[[np.inf, np.inf]], [[2.0, 2.0]]]), np.ones(2))
    chains = [chains_of(one, 0.0) for one in (quick_on_first, only_small)]
    assert choose_tools(chains, 1.0).tools == (0, 1)
    dear = choose_tools(chains, 3.0)
    assert dear.tools == (1,) and dear.seconds == pytest.approx(4 + 4 + 3)


def test_a_smaller_tool_finishes_what_the_larger_one_left() -> None:
    """The large tool reaches three of four cells, the small one all at three times the time."""
    seconds = np.array([[[1.0, 1.0, 1.0, np.inf]], [[3.0, 3.0, 3.0, 3.0]]])
    chains = chains_of(FacePrices(seconds, np.ones(4)), 0.5)
    assert chains[0].tools == (0, 1) and chains[0].charge == 0.0
    assert chains[0].seconds == pytest.approx(3 * 1.0 + 3.0 + 2 * 0.5)
    assert {one.tools for one in chains} == {(0, 1), (1,), (0,)}
    assert next(one for one in chains if one.tools == (0,)).charge == pytest.approx(2 * 3.0 + 3 * 0.5)


def test_a_tool_follows_itself_under_another_axis() -> None:
    seconds = np.array([[[1.0, 1.0, np.inf, np.inf], [np.inf, np.inf, 1.0, 1.0]]])
    best = chains_of(FacePrices(seconds, np.ones(4)), 0.25)[0]
    assert best.tools == (0, 0) and best.charge == 0.0 and best.seconds == pytest.approx(4.5)


def test_what_no_tool_reaches_costs_nothing_and_is_no_reason_for_a_tool() -> None:
    """A face that nothing reaches has the empty chain; cells that nothing reaches are not charged."""
    hidden = FacePrices(np.full((2, 1, 3), np.inf), np.ones(3))
    assert chains_of(hidden, 1.0) == (ToolChain((), 0.0, 0.0),)
    half = FacePrices(np.array([[[1.0, np.inf, np.inf]]]), np.ones(3))
    assert chains_of(half, 1.0)[0].charge == 0.0
    found = choose_tools([chains_of(hidden, 1.0), chains_of(half, 1.0)], 5.0)
    assert found.tools == (0,) and [one.tools for one in found.chains] == [(), (0,)]
    assert choose_tools([chains_of(hidden, 1.0)], 5.0).tools == ()


@pytest.mark.parametrize("seed", range(6))
def test_the_axis_of_the_first_tool_is_the_one_under_which_it_reaches_so_much(seed: int) -> None:
    """It is the axis from which the search begins that the chain was priced for."""
    given = prices(np.random.default_rng(seed), 4)
    reached = np.isfinite(given.seconds)
    for chain in chains_of(given, 2.0):
        own = reached[chain.tools[0]]
        share = own[chain.axes[0].axis] @ given.area / given.area.sum()
        assert share == pytest.approx(chain.share)
        assert share >= 0.97 * (own @ given.area).max() / given.area.sum()
    assert ToolChain((), 0.0, 0.0).axes == ()


def test_the_other_axes_of_the_first_tool_reach_as_much_in_nearly_the_same_time() -> None:
    move, several = 2.0, 0
    for seed in range(8):
        given = prices(np.random.default_rng(seed), 3, axes=12, cells=4)
        reached = np.isfinite(given.seconds)
        for chain in chains_of(given, move):
            tool, first = chain.tools[0], chain.axes[0]
            areas = reached[tool] @ given.area
            seconds = np.where(reached[tool], given.seconds[tool], 0.0).sum(axis=1)
            as_good = (areas >= 0.98 * areas.max()) & (seconds <= first.seconds + move)
            assert {one.axis for one in chain.axes} == set(np.flatnonzero(as_good))
            assert [one.seconds for one in chain.axes] == sorted(seconds[[one.axis for one in chain.axes]])
            several += len(chain.axes) > 1
    assert several > 8
