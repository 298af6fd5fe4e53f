"""The points that judge drawn parts find what is planted into a plan that is safe."""

from collections.abc import Callable
from dataclasses import replace

import pytest

pytest.importorskip("cadquery", reason="parts are drawn with CadQuery")

from benchmarks._random_parts import draw_part
from benchmarks.safety import Draw, PartPoints, Planned, draw_case, points_of, wrong_of

#: A groove in a plate, a torus, and 1 mm of stock.
SEED = 2


@pytest.fixture(scope="module")
def planned(tmp_path_factory: pytest.TempPathFactory) -> tuple[Draw, Planned, PartPoints]:
    draw = draw_case(SEED)
    made = Planned.of(draw, tmp_path_factory.mktemp("drawn"))
    return draw, made, points_of(draw, made.plan)


def _lowered(one: Planned) -> Planned:
    return one.with_path(replace(one.path, cl=one.path.cl - 0.05 * one.path.axis))


def _held_shorter(one: Planned) -> Planned:
    tool = one.operation.tool
    return one.with_tool(replace(tool, flute_length=3.0, stickout=4.0, shank=None))


def _leaning(one: Planned) -> Planned:
    return one.with_path(replace(one.path, axis=one.path.axis[:, [2, 1, 0]]))


def test_a_safe_plan_has_nothing_wrong(planned: tuple[Draw, Planned, PartPoints]) -> None:
    draw, made, points = planned
    count, found = wrong_of(made, points, draw.limits, 60)
    assert count >= 50 and not found


@pytest.mark.parametrize(("plant", "what"), [(_lowered, "cutter"), (_held_shorter, "holder"), (_leaning, "cutter")])
def test_what_is_planted_is_found(planned: tuple[Draw, Planned, PartPoints], plant: Callable[[Planned], Planned],
                                  what: str) -> None:
    draw, made, points = planned
    _, found = wrong_of(plant(made), points, draw.limits, 30)
    assert what in {one.what for one in found}


def test_stock_counts_for_shank_holder_and_rapid_moves(planned: tuple[Draw, Planned, PartPoints]) -> None:
    draw, made, points = planned
    _, found = wrong_of(made, points._replace(stock=points.stock + 15.0), draw.limits, 20)
    assert {("shank", "cut"), ("cutter", "link")} <= {(one.what, one.kind) for one in found}


def test_an_axis_outside_its_limits_is_found(planned: tuple[Draw, Planned, PartPoints]) -> None:
    _, made, points = planned
    _, found = wrong_of(_leaning(made), points, "cone:0,0,1,35", 3)
    assert any(one.what.startswith("limits") for one in found)


def test_the_same_seed_draws_the_same() -> None:
    one, other = draw_part(SEED), draw_part(SEED)
    assert one.kind == other.kind and one.solid.val().Volume() == pytest.approx(other.solid.val().Volume(), rel=1e-12)
    assert draw_case(SEED).tools == draw_case(SEED).tools
