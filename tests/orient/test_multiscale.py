"""Rotary axes along a pass: conditions as they are defined, kept, and the least sum beside a general solver's."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize

from toolaxis.contact.strip.scallop import RA_SHARE
from toolaxis.contact.strip.second_order import second_order_width
from toolaxis.errors import InvalidInput
from toolaxis.machine.axis import RotaryAxis
from toolaxis.machine.kinematics import rotary_angles
from toolaxis.machine.library import load_machine
from toolaxis.shape.face import Face
from toolaxis.strategies.roughness.paper_iteration import iterate_as_published
from toolaxis.strategies.roughness.pass_constraints import (
    GOUGE,
    NARROW,
    ROUGH,
    WIDE,
    OrientationRequirements,
    PassConstraints,
    beginnings,
    best_roughness,
    knots_of,
    leaning,
    spline_along_axes,
    windows,
)
from toolaxis.strategies.roughness.plan import racing
from toolaxis.strategies.roughness.rotary_velocity import velocity_left
from toolaxis.strategies.roughness.section_width import expect_widths, section_width
from toolaxis.strategies.roughness.smoothing import smooth_axes
from toolaxis.tools.tool import Tool

from .conftest import patch  # type: ignore[import-not-found]

TOOL, H = Tool.torus(10, 3), 0.1
WIDTHS = expect_widths(TOOL, np.radians(20.0), H)
FACE = patch(0.5 * np.random.default_rng(11).normal(size=(5, 5)), size=25.0)


def lane(face: Face = FACE, machine: str = "bc-table-table", step: float = 0.4, count: int = 40, apart: float = 0.6,
         roughness: float = 1.6e-3, widths: tuple[float, float] = WIDTHS,
         controls: int | None = None) -> PassConstraints:
    places = np.linspace(0, 1, count)
    uv = np.column_stack([places, np.full(count, step)])
    return PassConstraints(face, TOOL, load_machine(machine), np.eye(3), OrientationRequirements(H, widths, roughness),
                           "u", places, uv,
                           np.ones(count, dtype=bool), np.full(count, apart), np.full(count, 0.01), 800 / 60,
                           knots_of(places, controls))


def test_margins_are_those_of_the_definitions() -> None:
    one = lane()
    axes = leaning(one, np.radians(17.0), 0.3)
    margins, middle = one.margins(axes), (WIDTHS[1] - WIDTHS[0]) / 2
    wide = section_width(FACE, TOOL, one.uv, axes, H).sum(axis=1)
    assert np.allclose(margins[:, NARROW], (wide - WIDTHS[0]) / middle, atol=1e-12)
    assert np.allclose(margins[:, WIDE], (WIDTHS[1] - wide) / middle, atol=1e-12)
    swept = second_order_width(FACE, TOOL, one.uv, axes, 1e-3)  # 2 sqrt(2 h / k), k the relative curvature
    ra = RA_SHARE * 0.6**2 * (8e-3 / swept**2) / 8
    assert np.allclose(one.roughness(axes), ra, rtol=1e-9)
    assert np.allclose(margins[:, ROUGH], 1 - ra / 1.6e-3, atol=1e-9)
    assert np.allclose(one.leans(axes), np.radians(17.0), atol=1e-12) and (margins[:, GOUGE] > 0).all()


@pytest.mark.parametrize("step", [0.15, 0.4, 0.7])
def test_all_conditions_are_kept_and_no_neighbour_that_keeps_them_turns_less(step: float) -> None:
    one = lane(step=step, roughness=0.85e-3)
    found = smooth_axes(one, beginnings(one)[0])
    assert found.kept and found.margins.min() >= 0
    assert np.allclose(one.margins(found.axes), found.margins)
    sturz = spline_along_axes(one, leaning(one, np.radians(20.0)))
    assert found.cost < sturz.cost(one.places, one.durations)
    rng, less = np.random.default_rng(0), 0
    for size in 10.0 ** rng.uniform(-5, -1, 300):
        step_ = size * rng.normal(size=found.spline.control.shape)
        other = replace(found.spline, control=found.spline.control + step_)
        if one.margins(one.axes(other.control)).min() >= 0:
            less += other.cost(one.places, one.durations) < found.cost * (1 - 1e-4) - 1e-6
    assert less == 0


def test_a_general_solver_finds_no_smaller_sum() -> None:
    one = lane(count=24, controls=7, roughness=0.8e-3)
    start = beginnings(one)[0]
    found = smooth_axes(one, start)
    scale = found.cost

    def _spline(x):
        return replace(start, control=x.reshape(start.control.shape))

    general = minimize(lambda x: _spline(x).cost(one.places, one.durations) / scale, start.control.ravel(),
                       method="SLSQP", options={"ftol": 1e-8, "maxiter": 300},
                       bounds=[(x - 0.4, x + 0.4) for x in start.control.ravel()],
                       constraints={"type": "ineq", "fun": lambda x: one.margins(one.axes(_spline(x).control)).ravel()})
    assert one.margins(one.axes(_spline(general.x).control)).min() > -1e-5
    assert found.kept and general.fun > 1 - 5e-3
    again = smooth_axes(one, _spline(general.x))
    assert again.cost == pytest.approx(found.cost, rel=1e-2)


def test_ends_that_are_fixed_are_met() -> None:
    one = lane(roughness=0.9e-3)
    start = spline_along_axes(one, leaning(one, np.radians(20.0)))
    ends = start.angles([0.0, 1.0])
    free = lane(roughness=0.9e-3)
    free = replace(free, inside=np.arange(40) % 39 > 0)  # both ends count for nothing but gouging
    found = smooth_axes(free, start, ends)
    assert np.abs(found.spline.angles([0.0, 1.0]) - ends).max() < 1e-9
    assert found.kept and found.cost >= smooth_axes(free, start).cost * (1 - 1e-6)


def test_the_loop_of_the_paper_ends_and_turns_no_less() -> None:
    one = lane(roughness=1.0e-3, apart=0.52)
    lean, kept = windows(one)
    loop = iterate_as_published(one, float(lean[kept[:, 0] & kept[:, -1]].max()))
    assert loop.kept
    ends = loop.spline.angles([0.0, 1.0])
    ours = smooth_axes(replace(one, knots=loop.lane.knots), loop.spline, ends)
    assert ours.kept and ours.cost <= loop.cost * (1 + 1e-9)


@pytest.mark.parametrize("machine", ["ab-trunnion", "bc-table-table", "dmg-dmu-60t", "head-head-portal",
                                     "mikron-ucp-710", "nutating-head"])
def test_every_machine_keeps_its_ranges(machine: str) -> None:
    one = lane(machine=machine, roughness=0.9e-3)
    found = smooth_axes(one, beginnings(one)[0])
    angles = found.spline.angles(np.linspace(0, 1, 400))
    for i, axis in enumerate(one.machine.rotary):
        assert (angles[:, i] >= axis.low - 1e-9).all() and (angles[:, i] <= axis.high + 1e-9).all()
    assert found.kept
    back = rotary_angles(one.machine, found.axes)
    assert back.reached.all()


def test_a_range_that_ends_on_the_way_binds() -> None:
    one = lane(roughness=0.9e-3)
    free = smooth_axes(one, beginnings(one)[0])
    table = one.machine.table
    reach = free.spline.angles(one.places)
    edge = float(np.quantile(reach[:, 1], 0.6)) - 0.01
    tilt = RotaryAxis("B", table[1].direction, table[1].point, table[1].drive, table[1].low, edge)
    tight = replace(one, machine=replace(one.machine, table=(table[0], tilt), bodies=()))
    found = smooth_axes(tight, free.spline)
    assert found.spline.angles(np.linspace(0, 1, 300))[:, 1].max() <= edge + 1e-9
    assert found.cost >= free.cost - 1e-9


def test_across_the_singular_direction_the_first_axis_does_not_race() -> None:
    # Normals swing through the vertical, about which C turns, and with a constant lead the axis goes right through it.
    arch = patch(np.array([[0.0, 3, 4, 3, 0]] * 5).T - 2, size=25.0)
    one = lane(arch, roughness=2.0e-3, step=0.5, count=50)
    straight = spline_along_axes(one, leaning(one, np.full(50, np.radians(14.0)), 0.2))
    velocities = np.abs(straight.velocities(one.places, one.durations)).max()
    found = smooth_axes(one, straight)
    assert found.kept and found.cost < 0.5 * straight.cost(one.places, one.durations)
    assert np.abs(found.spline.velocities(one.places, one.durations)).max() < 0.8 * velocities


def test_a_roughness_that_no_orientation_gives_is_told_with_the_best() -> None:
    one = lane(apart=1.5, roughness=0.5e-3)
    best = best_roughness(one)
    assert (best > 0.5e-3).all()
    with pytest.raises(InvalidInput, match=r"Ra 0.5 um is asked for, and near .* passes 1.5 mm apart leave") as told:
        beginnings(one)
    leave = float(str(told.value).split("leave ")[1].split(" um")[0])
    assert leave == pytest.approx(1000 * best[0], rel=1e-2)
    wide = replace(one, wish=OrientationRequirements(H, WIDTHS, 1.02 * float(best.max())))
    assert not wide.sharpest.max() == one.sharpest.max()
    assert beginnings(wide)


def test_a_face_too_hollow_for_the_cutter_is_told() -> None:
    with pytest.raises(InvalidInput, match=r"no orientation near .* free of gouging"):
        beginnings(lane(patch(np.array([[6.0, 0, -2, 0, 6]] * 5), size=6.0), apart=0.1))


def test_where_axes_race_the_feed_that_is_left_is_told() -> None:
    rates, points = np.array([[0.5, 1.0], [8.0, 1.0], [3.0, 0.0], [0.0, 2.0]]), np.arange(12.0).reshape(4, 3)
    said, = racing(rates, np.array([2.0, np.inf]), 800 / 60, points)
    assert "on 50.0 % of the passes" in said and "down to 200 mm/min at [3.0, 4.0, 5.0]" in said
    assert racing(rates, np.array([8.0, 2.0]), 800 / 60, points) == ()


def test_wishes_that_make_no_sense() -> None:
    with pytest.raises(InvalidInput, match="range of the strip width"):
        OrientationRequirements(H, (3.0, 2.0), 1e-3)
    with pytest.raises(InvalidInput, match="roughness is 0 um"):
        OrientationRequirements(H, WIDTHS, 0.0)
    with pytest.raises(InvalidInput, match="the radius of the cutter"):
        _ = replace(lane(), tool=Tool.ball(10)).bench


def _no_faster(one: PassConstraints, most: tuple[float, float]) -> PassConstraints:
    """The same on a machine whose axes turn no faster, which binds."""
    table = tuple(replace(axis, drive=replace(axis.drive, velocity=velocity))
                  for axis, velocity in zip(one.machine.table, most, strict=True))
    return replace(one, machine=replace(one.machine, table=table, bodies=()), paced=True)


@pytest.mark.parametrize("seed, size, widths", [(5, 6.0, (2.3, 3.1)), (5, 2.0, (2.6, 3.0)), (6, 6.0, (2.3, 3.1))])
def test_velocities_bind_and_no_neighbour_that_keeps_them_too_turns_less(seed: int, size: float, widths) -> None:
    one = lane(patch(size * np.random.default_rng(seed).normal(size=(5, 5)), size=25.0), roughness=2e-3, step=0.5,
               count=50, widths=widths)
    free = smooth_axes(one, beginnings(one)[0])
    most = np.abs(free.spline.velocities(one.places, one.durations)).max(axis=0)
    slow = _no_faster(one, (0.8 * most[0], 0.9 * most[1]))
    assert free.kept and not smooth_axes(replace(slow, paced=False), free.spline).follows
    found = smooth_axes(slow, free.spline)
    assert found.kept and found.follows and found.cost >= free.cost * (1 - 1e-4)
    fine = np.linspace(0, 1, 49 * 3 + 1)  # gaps in thirds, as long as each other in time
    speeds = np.abs(found.spline.velocities(fine, np.repeat(one.durations / 3, 3))).max(axis=0)
    assert (speeds <= np.array([0.8, 0.9]) * most * (1 + 1e-9)).all() and (speeds > 0.85 * 0.8 * most).any()
    rng, less = np.random.default_rng(0), 0
    for size_ in 10.0 ** rng.uniform(-5, -1, 200):
        other = replace(found.spline, control=found.spline.control + size_ * rng.normal(size=(len(one.knots) - 4, 2)))
        if slow.margins(slow.axes(other.control)).min() >= 0 and velocity_left(slow, other.control).min() >= 0:
            less += other.cost(one.places, one.durations) < found.cost * (1 - 1e-4) - 1e-6
    assert less == 0


def test_velocities_that_no_spline_keeps_are_told_with_place_and_amount() -> None:
    one = lane(patch(6.0 * np.random.default_rng(5).normal(size=(5, 5)), size=25.0), roughness=2e-3, step=0.5, count=50,
               widths=(2.3, 3.1))
    start = beginnings(one)[0]
    most = np.abs(smooth_axes(one, start).spline.velocities(one.places, one.durations)).max(axis=0)
    found = smooth_axes(_no_faster(one, (0.05 * most[0], 0.05 * most[1])), start)
    assert not found.kept and not found.follows
    assert found.sentence.startswith("near [") and float(found.sentence.split("turns ")[1].split(" times")[0]) > 1.2
