"""Tools as a machinist gives them: sizes, flutes, shank and holder, and a sentence for each that makes no tool."""

from math import degrees, inf, nan
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from toolaxis.errors import InvalidInput
from toolaxis.tools.tool import Tool


def test_the_tool_of_the_first_page() -> None:
    tool = Tool.torus(diameter=12, corner_radius=1, stickout=60, shank=[(6, 0), (6, 60)],
                      holder=[(10, 0), (10, 40), (25, 40), (25, 80)])
    assert (tool.kind, tool.radius, tool.corner_radius, tool.flat_radius, tool.half_angle) == ("torus", 6, 1, 5, 0)
    assert (tool.stickout, tool.flute_length, tool.name) == (60.0, 24.0, "torus:12x1")
    assert tool.outlines["shank"].tolist() == [[6, 24], [6, 60]]
    assert tool.outlines["holder"].tolist() == [[10, 60], [10, 100], [25, 100], [25, 140]]


def test_kinds() -> None:
    ball, flat, tapered = Tool.ball(diameter=8), Tool.flat(diameter=20), Tool.tapered(6, 3, half_angle_deg=4)
    assert (ball.radius, ball.corner_radius, ball.flat_radius) == (4, 4, 0)
    assert (flat.radius, flat.corner_radius, flat.flat_radius) == (10, 0, 10)
    assert (tapered.radius, tapered.flat_radius, degrees(tapered.half_angle)) == pytest.approx((3, 0, 4))


def test_flutes_are_two_diameters_and_never_in_the_holder() -> None:
    assert Tool.ball(8).flute_length == 16.0
    assert Tool.ball(8, stickout=10).flute_length == 10.0
    assert Tool.ball(8, flute_length=30, stickout=40).flute_length == 30.0


@pytest.mark.parametrize("body, shank", [
    ({}, None),
    ({"stickout": 40}, [[4, 16], [4, 40]]),
    ({"stickout": 16}, None),
    ({"shank": [(3, 0), (3, 50)]}, [[3, 16], [3, 50]]),
    ({"shank": [(3, 0), (3, 10)]}, None),
    ({"shank": [(3, 0), (3, 10)], "stickout": 40}, [[3, 16], [3, 40]]),
    ({"shank": [(3, 0), (3, 30)], "stickout": 40}, [[3, 16], [3, 30], [3, 40]]),
    ({"shank": [(3, 20), (3, 40)], "stickout": 40}, [[4, 16], [4, 20], [3, 20], [3, 40]]),
    ({"shank": [(5, 20), (5, 40)], "stickout": 40}, [[5, 16], [5, 20], [5, 20], [5, 40]]),
    ({"shank": [(3, 0), (3, 16), (5, 16), (5, 40)], "stickout": 40}, [[5, 16], [5, 40]]),
    ({"shank": [(2, 0), (6, 32), (6, 60)], "stickout": 40}, [[4, 16], [6, 32], [6, 60]]),
])
def test_no_air_between_flutes_and_holder(body: dict[str, Any], shank: Any) -> None:
    found = Tool.ball(8, **body).outlines
    assert set(found) == ({"shank"} if shank else set())
    if shank:
        assert found["shank"].tolist() == shank


def test_a_plain_shank_of_a_tapered_tool_is_as_thick_as_its_upper_end() -> None:
    tool = Tool.tapered(6, 3, 4, stickout=50)
    assert tool.outlines["shank"][:, 0] == pytest.approx([tool.profile.top_radius] * 2)


def test_a_holder_stands_at_the_stick_out_wherever_it_is_drawn() -> None:
    first = Tool.ball(8, stickout=40, holder=[(10, 0), (20, 30)]).outlines["holder"]
    second = Tool.ball(8, stickout=40, holder=[(10, 7), (20, 37)]).outlines["holder"]
    assert first.tolist() == second.tolist() == [[10, 40], [20, 70]]


def test_a_tool_does_not_share_its_outline_with_the_caller() -> None:
    rows = np.array([[6.0, 0.0], [6.0, 60.0]])
    tool = Tool.ball(8, shank=rows)
    rows[:] = 0
    assert tool.outlines["shank"].tolist() == [[6, 16], [6, 60]]


@pytest.mark.parametrize("text, kind, sizes", [
    ("torus:12x1", "torus", (6, 1, 0)), ("ball:8", "ball", (4, 4, 0)), (" flat:20 ", "flat", (10, 0, 0)),
    ("Torus:12X0.5", "torus", (6, 0.5, 0)), ("tapered:6x3x4", "tapered", (3, 3, 4)), ("flat:1e1", "flat", (5, 0, 0))])
def test_short_forms(text: str, kind: str, sizes: tuple[float, float, float]) -> None:
    tool = Tool.parse(text, stickout=50)
    assert (tool.kind, tool.radius, tool.corner_radius, degrees(tool.half_angle)) == pytest.approx((kind, *sizes))
    assert tool.stickout == 50


@given(st.floats(0.01, 500), st.floats(0.001, 1), st.floats(0.1, 79))
def test_names_are_read_back(diameter: float, share: float, angle: float) -> None:
    for tool in (Tool.torus(diameter, share * diameter / 2), Tool.ball(diameter), Tool.flat(diameter),
                 Tool.tapered(diameter, share * diameter / 2 * 0.999, angle)):
        again = Tool.parse(tool.name)
        assert (again.radius, again.corner_radius, again.half_angle) == pytest.approx(
            (tool.radius, tool.corner_radius, tool.half_angle), rel=1e-8)


@pytest.mark.parametrize("make, said", [
    (lambda: Tool.torus(0, 1), r"^diameter is 0\.0 mm: it must be a finite number above zero$"),
    (lambda: Tool.torus(-12, 1), r"^diameter is -12\.0 mm"),
    (lambda: Tool.torus(nan, 1), "^diameter is nan mm: it must be a finite number$"),
    (lambda: Tool.ball(inf), "^diameter is inf mm"),
    (lambda: Tool.flat("wide"), "^diameter is 'wide': it must be a number of mm$"),  # type: ignore[arg-type]
    (lambda: Tool.flat(None), "^diameter is None"),  # type: ignore[arg-type]
    (lambda: Tool.torus(12, 0), r"^corner radius is 0\.0 mm: a torus needs one above zero; use a flat tool"),
    (lambda: Tool.torus(12, -1), r"^corner radius is -1\.0 mm"),
    (lambda: Tool.torus(12, nan), "^corner radius is nan mm"),
    (lambda: Tool.torus(12, 7), r"^corner radius is 7\.0 mm, above the radius 6\.0 mm: it can be at most half the"),
    (lambda: Tool.tapered(6, 4, 4), r"^corner radius is 4\.0 mm, above the radius 3\.0 mm"),
    (lambda: Tool.tapered(6, -1, 4), r"^corner radius is -1\.0 mm: it must be zero or more$"),
    (lambda: Tool.tapered(6, 1, 0), r"^half angle is 0\.0 deg: it must lie between 0 and 80$"),
    (lambda: Tool.tapered(6, 1, 80), r"^half angle is 80\.0 deg"),
    (lambda: Tool.tapered(6, 1, nan), "^half angle is nan deg"),
    (lambda: Tool.ball(8, flute_length=0), r"^flute length is 0\.0 mm"),
    (lambda: Tool.ball(8, flute_length=4), r"^flute length is 4\.0 mm: it must exceed the corner radius 4\.0 mm$"),
    (lambda: Tool.ball(8, flute_length=30, stickout=20), r"^flute length is 30\.0 mm, above the stick-out 20\.0 mm"),
    (lambda: Tool.ball(8, stickout=0), r"^stick-out is 0\.0 mm"),
    (lambda: Tool.ball(8, stickout=3), r"^stick-out is 3\.0 mm, not above the corner radius 4\.0 mm: the holder would"),
    (lambda: Tool.ball(8, stickout=nan), "^stick-out is nan mm"),
    (lambda: Tool.ball(8, holder=[(10, 0), (10, 40)]), "^a holder is given without a stick-out: give the length"),
    (lambda: Tool.ball(8, stickout=40, holder=[(-10, 0), (10, 40)]), r"^holder radius 0 is -10\.0 mm: a holder cannot"),
    (lambda: Tool.ball(8, stickout=40, holder=[(0, 0), (0, 40)]), "a holder cannot be thinner than nothing$"),
    (lambda: Tool.ball(8, stickout=40, holder=[(10, 0)]), r"^holder has shape \(1, 2\): at least two finite"),
    (lambda: Tool.ball(8, stickout=40, holder=[(10, 0), (10, nan)]), "^holder has shape .*: at least two finite"),
    (lambda: Tool.ball(8, stickout=40, holder=[(10, 0), (10, 0)]), "^holder has no length: its last z must lie above"),
    (lambda: Tool.ball(8, stickout=40, holder="hsk"), "^holder is 'hsk': rows of"),
    (lambda: Tool.ball(8, shank=[(4, 0), (4, 30), (4, 20)]), r"^shank z 2 is 20\.0 mm, below the one before: z must"),
    (lambda: Tool.ball(8, shank=[(4, 0), (4,)]), "^shank is .*: rows of"),
    (lambda: Tool.ball(8, length=70), "^tool has no property 'length': use flute_length, "
     "stickout, shank, holder, title, number, feedrate or spindle$"),
    (lambda: Tool.parse("drill:8"), "^tool 'drill:8' is not understood: write torus:12x1, ball:8, flat:20 or tapered"),
    (lambda: Tool.parse("torus:12"), "is not understood"), (lambda: Tool.parse("ball:"), "is not understood"),
    (lambda: Tool.parse("ball:8x"), "is not understood"), (lambda: Tool.parse(""), "is not understood"),
    (lambda: Tool.parse("torus:-12x1"), "^diameter is -12"), (lambda: Tool.parse("ball:nan"), "^diameter is nan"),
])
def test_sizes_that_make_no_tool(make: Any, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        make()


@pytest.mark.parametrize("tool, wide, component", [
    (Tool.torus(12, 1), 6.0, "cutter"), (Tool.ball(8, stickout=40), 4.0, "shank"),
    (Tool.tapered(6, 1, 5), None, "shank"),
    (Tool.ball(8, stickout=40, holder=[(10, 0), (20, 30), (0, 30)]), 20.0, "holder")])
def test_a_tool_carried_on_is_as_wide_as_its_upper_end(tool, wide, component):
    longer = tool.carried_on(tool.height + 25)
    wide = tool.profile.top_radius if wide is None else wide
    heights = tool.height + np.linspace(1, 24, 5)
    beside = np.column_stack([np.full(5, wide + 3.0), np.zeros(5), heights])
    assert longer.distance(beside, component).value == pytest.approx(3.0)
    below = np.random.default_rng(1).uniform([-9, -9, -2], [9, 9, 0.8 * tool.height], (200, 3))
    assert (longer.distance(below).value <= tool.distance(below).value + 1e-12).all()
    assert longer.carried_on(5.0) is longer and longer.height == pytest.approx(tool.height + 25)


def test_a_ball_end_of_the_same_radius_stays_in_the_same_holder() -> None:
    body = {"stickout": 50, "holder": [(10, 0), (10, 40)]}
    tool = Tool.torus(12, 1, flute_length=20, **body)
    ball = tool.with_ball_end()
    assert (ball.name, ball.flute_length, ball.stickout) == ("ball:12", 20, 50)
    assert ball.holder is not None and np.array_equal(ball.holder, tool.holder)
    assert Tool.torus(12, 1, flute_length=4).with_ball_end().flute_length > 6
    assert Tool.ball(8).with_ball_end().name == "ball:8"
