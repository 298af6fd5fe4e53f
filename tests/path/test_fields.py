"""Passes in a field: widths in all directions, ideal lengths, the cost and its slope, the chart, and plans judged."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import toolaxis as ta
from toolaxis.contact.strip.width import strip_width
from toolaxis.errors import UnsupportedGeometry
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.path.cl_points import trace
from toolaxis.path.estimate import Estimator
from toolaxis.path.field.between_places import hidden_passes
from toolaxis.path.field.direction_table import feed_frame, feeds_in, tabulate_directions
from toolaxis.path.field.ideal_lengths import DirectionForms
from toolaxis.path.field.level_chart import LevelChart
from toolaxis.path.field.pass_field import FieldProblem, PassField, find_field
from toolaxis.path.parametrization import Cut, IsoChart
from toolaxis.path.pass_layout import lay_out, pass_length
from toolaxis.path.pass_pattern import FieldPasses, pattern_name
from toolaxis.path.rest_material import RestFinder
from toolaxis.plan.choices import AUTO, FIELD, ISO
from toolaxis.search.cost import MachiningCost
from toolaxis.shape.face import Face
from toolaxis.shape.nurbs import NurbsSurface

from .conftest import flat, holed, wavy  # type: ignore[import-not-found]

Array = NDArray[np.float64]
H = 0.02
BALL, TORUS = ta.Tool.ball(diameter=12), ta.Tool.torus(diameter=12, corner_radius=1)
LEAN = np.array([0.25, -0.1, 0.96])


def field_of(face: Face, across: int, bend: float = 0.0, number: float = 20.0) -> PassField:
    """A field that grows with a parameter, its levels bent."""
    own = np.array([-0.2] * 4 + [0.2, 0.8] + [1.2] * 4)
    middles = np.convolve(own[1:-1], np.full(3, 1 / 3), mode="valid")  # coefficients of the straight line
    u, v = np.meshgrid(middles, middles, indexing="ij")
    net = np.zeros((6, 6, 3))
    net[..., 2] = number * ((v, u)[1 - across] + bend * (u, v)[1 - across] ** 2)
    u0, u1, v0, v1 = face.bounds
    knots = [low + (high - low) * own for low, high in ((u0, u1), (v0, v1))]
    return PassField(NurbsSurface.from_points(net, (3, 3), knots), 0.0, number)


def test_on_a_plane_a_ball_cuts_alike_in_all_directions_and_the_ideal_length_is_area_over_width() -> None:
    face = flat(60.0, 40.0)
    width = 2 * np.sqrt(2 * BALL.radius * H - H**2)
    table = tabulate_directions(face, Cut(BALL, LEAN, H), 10)
    assert np.exp(table.width.over(np.linspace(0, 3, 7))) == pytest.approx(width, rel=1e-6)
    assert table.ideal_length == pytest.approx(2400 / width, rel=1e-6)
    assert DirectionForms.of(face, BALL, H).estimate(LEAN[None]).length == pytest.approx(2400 / width, rel=1e-3)


@pytest.mark.parametrize("seed", range(4))
def test_widths_in_all_directions_are_the_exact_ones(seed: int) -> None:
    face, axis = wavy(seed), np.array([0.3, 0.1 * seed, 0.9])
    cut = Cut(TORUS, axis, H)
    table = tabulate_directions(face, cut, 18)
    rng = np.random.default_rng(seed)
    rows, angles = rng.integers(0, len(table.uv), 12), rng.uniform(0, np.pi, 5)
    feeds = feeds_in(feed_frame(face, table.uv[rows]), angles)
    exact = strip_width(face, TORUS, np.repeat(table.uv[rows], 5, axis=0), cut.axis, H, feeds).sum(axis=1)
    assert np.exp(table.width.over(angles)[rows]).ravel() == pytest.approx(exact, rel=0.05)


@pytest.mark.parametrize("seed", range(3))
def test_the_ideal_length_is_the_least_over_directions_by_brute_force(seed: int) -> None:
    """By exact widths in 45 directions and ways of tips from differences along each feed."""
    face, cut = wavy(seed), Cut(TORUS, np.array([0.2, 0.3, 0.9]), H)
    table = tabulate_directions(face, cut, 12)
    angles = np.arange(45) * np.pi / 45
    frame = feed_frame(face, table.uv)
    feeds = feeds_in(frame, angles)
    places = np.repeat(table.uv, 45, axis=0)
    width = strip_width(face, TORUS, places, cut.axis, H, feeds).sum(axis=1)
    d = face.evaluate(places)
    matrix = np.stack([d.su, d.sv], axis=2)
    rates = np.array([np.linalg.lstsq(m, f, rcond=None)[0] for m, f in zip(matrix, feeds, strict=True)])
    small = 1e-4
    ends = [ta.place(face, TORUS, places + sign * small * rates, cut.axis) for sign in (1, -1)]
    way = np.linalg.norm(ends[0] - ends[1], axis=1) / (2 * small)
    best = (way / width).reshape(-1, 45).min(axis=1)
    assert table.ideal_length == pytest.approx(float(table.area @ best), rel=0.01)
    assert DirectionForms.of(face, TORUS, H).estimate(cut.axis[None]).length[0, 0] == pytest.approx(
        table.ideal_length, rel=0.1)


def test_the_slope_of_the_cost_is_that_of_differences() -> None:
    table = tabulate_directions(wavy(2), Cut(TORUS, LEAN, H), 10)
    for across in (0, 1):
        problem = FieldProblem(table, 8, across)
        at = (problem.straight(0.8) + np.random.default_rng(across).normal(size=(8, 8))).ravel()
        slope = problem.cost(at, 12.0)[1]
        small = 1e-6 * np.eye(64)
        differences = [(problem.cost(at + one, 12.0)[0] - problem.cost(at - one, 12.0)[0]) / 2e-6 for one in small]
        assert slope == pytest.approx(differences, abs=1e-6 * np.abs(slope).max() + 1e-8)


def test_on_a_plane_passes_are_straight_and_as_long_as_the_ideal() -> None:
    table = tabulate_directions(flat(60.0, 40.0), Cut(BALL, LEAN, H), 16)
    for across in (0, 1):
        found = find_field(table, across)
        width = 2 * np.sqrt(2 * BALL.radius * H - H**2)
        # Both ends of each pass run out, by half a width at least.
        assert table.ideal_length + 0.9 * width * found.passes < found.length < 1.1 * table.ideal_length
        gradient = FieldProblem(table, 14, across).gradient(found.surface.control[..., 2])
        assert np.ptp(np.arctan2(*gradient)) < 0.1


@pytest.mark.parametrize("seed", range(4))
def test_a_field_is_never_shorter_than_the_ideal_and_no_longer_than_iso_parametric_passes(seed: int) -> None:
    face, cut = wavy(seed), Cut(TORUS, np.array([0.3, 0.2, 0.9]), H)
    table = tabulate_directions(face, cut, 20)
    for across, feed in ((1, "u"), (0, "v")):
        found = find_field(table, across)
        iso = pass_length(lay_out(IsoChart(face, feed), cut))
        assert 0.99 * table.ideal_length < found.length < 1.02 * iso


@pytest.mark.parametrize("feed", ["u", "v"])
@pytest.mark.parametrize("cut_out", [False, True])
def test_the_chart_finds_places_again_and_feeds_along_levels(feed: str, cut_out: bool) -> None:
    face = holed(wavy(3)) if cut_out else wavy(3)
    chart = LevelChart(face, feed, field_of(face, 1 if feed == "u" else 0, bend=0.3))
    rng = np.random.default_rng(1)
    uv = rng.uniform(-0.15, 1.15, (200, 2))
    assert chart.uv(*chart.places(uv).T) == pytest.approx(uv, abs=1e-9)
    along, step = chart.places(uv).T
    near = chart.uv(along + 1e-5, step)
    way = face.evaluate(near).point - face.evaluate(uv).point
    cosine = (way * chart.feed_at(uv)).sum(axis=1) / np.linalg.norm(way, axis=1)
    assert cosine == pytest.approx(np.ones(200), abs=1e-6)
    a0, a1, s0, s1 = chart.bounds
    inside = chart.places(face.grid(30, 30))
    assert a0 <= inside[:, 0].min() and inside[:, 0].max() <= a1
    assert s0 <= inside[:, 1].min() and inside[:, 1].max() <= s1


@pytest.mark.parametrize("feed", ["u", "v"])
def test_in_a_field_that_is_a_parameter_half_widths_are_those_along_it(feed: str) -> None:
    """The normal section and the line across differ to the second order."""
    face, cut = wavy(1, height=1.0), Cut(TORUS, LEAN, 0.005)
    chart = LevelChart(face, feed, field_of(face, 1 if feed == "u" else 0, number=1.0))
    along, step = (part.ravel() for part in np.meshgrid(np.linspace(0.1, 0.9, 5), np.linspace(0.1, 0.9, 5)))
    exact = IsoChart(face, feed).half_widths(cut, along, step)
    assert chart.half_widths(cut, along, step) == pytest.approx(exact, rel=0.02)
    assert chart.screen(cut, along, step) == pytest.approx(exact.sum(axis=1), rel=0.05)
    reach = IsoChart(face, feed).run_outs(cut, along, step)
    assert chart.run_outs(cut, along, step) == pytest.approx(reach, rel=0.05)


@pytest.mark.parametrize(("seed", "tool", "cut_out"), [
    pytest.param(0, BALL, False, marks=pytest.mark.long), (1, TORUS, False),
    pytest.param(2, TORUS, True, marks=pytest.mark.long), (3, BALL, True)])
def test_passes_in_a_field_leave_nothing_and_come_to_what_the_field_says(seed: int, tool: ta.Tool,
                                                                         cut_out: bool) -> None:
    face = holed(wavy(seed)) if cut_out else wavy(seed)
    cut = Cut(tool, np.array([0.3, 0.2, 0.9]), H)
    chart = FieldPasses(Estimator.of(face, tool, H)).chart(cut, "u")
    placed = lay_out(chart, cut)
    path = trace(placed, 0.1 * H)
    assert pattern_name(placed.chart) == FIELD
    assert sum(zone.area for zone in RestFinder(face, tool, H).find(path)) <= 1e-3 * face.area
    if not cut_out:
        assert placed.used == pytest.approx(chart.field.passes, rel=0.1)


def _near_its_normals() -> tuple[Face, Array]:
    """A random patch and an axis less than a degree from its normals along a valley, where strips change at once."""
    rng = np.random.default_rng(0)
    x, y = np.meshgrid(np.linspace(0, 60, 6), np.linspace(0, 45, 5), indexing="ij")
    lean, height = rng.uniform(-0.3, 0.3, 2), rng.uniform(1, 6)
    z = lean[0] * x + lean[1] * y + height * rng.uniform(-1, 1, x.shape)
    axis = np.array([-0.15490737, 0.09127503, 0.9837035])
    return Face.from_bspline(np.stack([x, y, z], axis=-1)), axis / np.linalg.norm(axis)


def test_narrow_places_between_those_of_the_table_are_found_and_cost_fewer_passes() -> None:
    face, axis = _near_its_normals()
    cut = Cut(TORUS, axis, H)
    coarse = LevelChart(face, "u", find_field(tabulate_directions(face, cut, 26), 1))
    assert hidden_passes(coarse, cut, 26) > 0.1
    made = FieldPasses(Estimator.of(face, TORUS, H)).chart(cut, "u")
    assert hidden_passes(made, cut, 52) < 0.02
    few, many = (lay_out(chart, cut) for chart in (made, coarse))
    assert len(few.steps) < 0.85 * len(many.steps) and pass_length(few) < 0.85 * pass_length(many)


def test_where_strips_change_slowly_no_narrow_place_is_hidden() -> None:
    face, cut = flat(60.0, 40.0), Cut(BALL, LEAN, H)
    chart = LevelChart(face, "u", find_field(tabulate_directions(face, cut, 10), 1))
    assert abs(hidden_passes(chart, cut, 10)) < 1e-3


def test_plans_in_a_field_pass_the_judge_and_the_shorter_is_taken(tmp_path: Path) -> None:
    part = ta.Part.from_faces([wavy(5, height=4.0)])
    made = {passes: ta.plan(part, TORUS, 0.05, passes=passes, limits="cone:0.2,0.3,0.9,10")
            for passes in (ISO, FIELD, AUTO)}
    found = {passes: plan.operations[0].orientation for passes, plan in made.items()}
    assert all(plan.outcome == "complete" and ta.verify(plan).passed for plan in made.values())
    assert found[ISO].pattern == ISO and found[FIELD].pattern == FIELD
    assert found[AUTO].length <= 1.01 * min(found[ISO].length, found[FIELD].length)
    assert 0 < found[FIELD].ideal < found[FIELD].length
    write_plan(made[FIELD], tmp_path)
    record = json.loads((tmp_path / "plan.json").read_text())["operations"][0]["orientation"]
    assert record["pattern"] == FIELD and record["ideal"] == found[FIELD].ideal
    again = read_plan(tmp_path).operations[0].orientation
    assert again.pattern == FIELD and again.ideal == found[FIELD].ideal


def test_faces_that_close_or_have_a_pole_are_refused_with_the_remedy() -> None:
    angle = np.linspace(0, 2 * np.pi, 9)
    ring = np.column_stack([20 * np.cos(angle), 20 * np.sin(angle)])
    circles = [np.column_stack([ring, np.full(9, z)]) for z in (0.0, 10.0, 20.0, 30.0)]
    tube = Face.from_bspline(np.stack(circles, axis=1))
    with pytest.raises(UnsupportedGeometry, match="face 1 is closed in u: passes in a field need a face that is open"):
        tabulate_directions(tube, Cut(TORUS, (1, 0, 0), H), 8)
    tip = np.array([[[x, y, 0] for y in (0, 5, 10)] for x in (0, 5, 10)], dtype=float)
    tip[0] = tip[0, 0]
    tip[1] = tip[0, 0]
    with pytest.raises(UnsupportedGeometry, match="has no two directions at u"):
        feed_frame(Face.from_bspline(tip, (2, 2)), np.array([[0.0, 0.5]]))
    face = wavy(0)
    with pytest.raises(UnsupportedGeometry, match="passes in a field along u turn back on face 1"):
        LevelChart(face, "u", field_of(face, 0))


def test_the_ideal_length_needs_no_places_off_the_face() -> None:
    whole_face = wavy(4)
    u0, u1, v0, v1 = whole_face.bounds
    loop = np.array([[0.3, 0.3], [0.7, 0.35], [0.6, 0.8], [0.25, 0.6]])
    trimmed = whole_face.trimmed((np.array([u0, v0]) + loop * np.array([u1 - u0, v1 - v0]),))
    cut = Cut(BALL, LEAN, H)
    whole, inside = (tabulate_directions(trimmed, cut, 16, only_inside=only) for only in (False, True))
    assert len(inside.uv) == trimmed.contains(whole.uv).sum() < len(whole.uv)
    assert inside.ideal_length == pytest.approx(whole.ideal_length, rel=1e-12)


def test_the_ideal_length_is_unknown_where_an_axis_leaves_no_strip() -> None:
    """Found: a place that the axis does not see made the ideal length of 69 mm2 660 m."""
    u = np.linspace(-15.0, 15.0, 7)
    x, y = np.meshgrid(u, u, indexing="ij")
    roof = Face.from_bspline(np.stack([x, y, -0.1 * x**2], axis=-1))
    cost = MachiningCost(roof, BALL, H)
    assert 900 / (2 * np.sqrt(2 * 6 * H)) < cost.ideal_length(np.array([0.0, 0.0, 1.0])) < 9000
    assert cost.ideal_length(np.array([-np.sin(0.9), 0.0, np.cos(0.9)])) == 0.0
