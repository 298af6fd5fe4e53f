"""Divisions for the least time: what lines of a lattice take a machine, and what is divided by it."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.feed.fixed_axis_time import Feeds
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import unit
from toolaxis.partition.face_division import Divider
from toolaxis.partition.partition import regions
from toolaxis.partition.shared_axes import divide_with_shared_axes, trade
from toolaxis.plan.plan import Plan
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.search.time_estimate import TimeEstimate
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

MIKRON = Mounting(load_machine("mikron-ucp-710"))
TOOL, H = Tool.torus(diameter=12, corner_radius=1), 0.05
FAST = Feeds(100.0, tolerance=0.005, smooth=True)
LEAN = unit(np.array([[0.3, 0.1, 1.0], [0.0, -0.4, 1.0]]))


def _face(wave: float, long: float = 60.0) -> Face:
    x, y = np.meshgrid(np.linspace(0, long, 9), np.linspace(0, 40, 7), indexing="ij")
    return Face.from_bspline(np.stack([x, y, wave * np.sin(np.pi * x / 30) * np.cos(np.pi * y / 30)], axis=-1))


@pytest.fixture(scope="module")
def job() -> FaceProblem:
    return task(_face(7.0), TOOL, H, MIKRON, objective="time", feeds=FAST)


@pytest.fixture(scope="module")
def divider(job: FaceProblem) -> Divider:
    return Divider(job, cells=(10, 10), most=4)


def _line(face: Face, count: int = 129) -> np.ndarray:
    u0, u1, v0, v1 = face.bounds
    return np.stack([np.linspace(u0, u1, count), np.full(count, 0.4 * v0 + 0.6 * v1)], axis=1)


def test_a_straight_line_takes_its_length_at_the_feed() -> None:
    face = _face(0.0)
    found = TimeEstimate(face, TOOL, MIKRON, FAST).line_seconds(_line(face), LEAN)
    assert found.shape == (2, 128)
    assert found.sum(axis=1) == pytest.approx([60 / 100] * 2, rel=1e-9)


def test_a_bent_line_takes_longer_at_a_high_feed() -> None:
    face, feeds = _face(7.0), replace(FAST, cut=300.0)
    pace = TimeEstimate(face, TOOL, MIKRON, feeds)
    tips = [ta.place(face, TOOL, _line(face), axis) for axis in LEAN]
    length = np.array([np.linalg.norm(np.diff(one, axis=0), axis=1).sum() for one in tips])
    found = pace.line_seconds(_line(face), LEAN).sum(axis=1)
    slow = TimeEstimate(face, TOOL, MIKRON, replace(FAST, cut=5.0)).line_seconds(_line(face), LEAN).sum(axis=1)
    assert (found > 1.2 * length / 300).all(), "bends slow the machine down at this feed"
    assert slow == pytest.approx(length / 5, rel=0.01), "at a walk they do not"


def test_a_line_that_shrinks_to_a_pole_takes_no_time() -> None:
    theta, phi = np.meshgrid(np.linspace(0, 1, 7), np.linspace(0, 1, 7), indexing="ij")
    fan = Face.from_bspline(np.stack([30 * theta * np.cos(phi), 30 * theta * np.sin(phi), 0 * theta], axis=-1))
    u0, _, v0, v1 = fan.bounds
    uv = np.stack([np.full(129, u0), np.linspace(v0, v1, 129)], axis=1)
    found = TimeEstimate(fan, TOOL, MIKRON, FAST).line_seconds(uv, LEAN)
    assert found.shape == (2, 128) and np.abs(found).max() < 1e-9


def test_starting_and_stopping_is_what_the_law_of_motion_says() -> None:
    pace = TimeEstimate(_face(0.0), TOOL, MIKRON, FAST)
    bounds = [axis.drive.levels(axis.name) for axis in MIKRON.machine.linear]
    a, j = min(one[1] for one in bounds), min(one[2] for one in bounds)
    ramp = 2 * np.sqrt(100 / j) if np.sqrt(100 * j) <= a else 100 / a + a / j
    assert pace.start_and_stop == pytest.approx(ramp, rel=1e-9)  # half of each ramp is lost


def test_a_whole_face_costs_what_the_search_reckons() -> None:
    job = task(_face(1.0), TOOL, H, MIKRON, objective="time", feeds=FAST)
    divider = Divider(job, cells=(10, 10), most=2)
    nu, nv = divider.lattice.cells
    prices = divider.priced(LEAN)
    costs = divider._each(prices, divider._on_the_face(prices.lines), (0, nu, 0, nv), divider._ends, prices.extra)
    for axis, row in zip(LEAN, costs, strict=True):
        for k, feed in enumerate("uv"):
            passes, length = job.worth.counted(axis, feed)
            assert row[k] == pytest.approx(job.worth.value(axis, k, passes, length), rel=0.15)


@pytest.mark.long
def test_no_division_by_length_takes_less_time(job: FaceProblem, divider: Divider) -> None:
    by_length = Divider(replace(job, worth=replace(job.worth, objective="length")), cells=(10, 10), most=4)
    timed = divider.best.prices.joined(divider.priced(by_length.best.prices.axes))
    best = divider.solved(timed)
    for count in by_length.best.known:
        boxes = by_length.best.pieces(int(count))
        total = sum(divider.costs(timed, box).min() for box in boxes)
        assert best.division.curve[count] <= total * (1 + 1e-9)
    assert (divider.best.division.curve[1:] >= best.division.curve[1:] - 1e-9).all()


def test_sub_surfaces_tell_length_and_time(job: FaceProblem) -> None:
    found = regions(job, 3)
    assert len(found) == 3 and len(found.seconds) == 3 and found.costs == found.seconds
    for length, seconds in zip(found.lengths, found.seconds, strict=True):
        assert 0.8 * length / 100 < seconds < 4 * length / 100
    assert sum(found.seconds) == pytest.approx(found.curve[found.curve[:, 0] == 3, 1][0], rel=1e-9)


def test_axes_are_shared_by_time(divider: Divider) -> None:
    found = trade([divider], 3)
    costs = [one.cost for one in found.options]
    assert all(one.seconds == one.cost for one in found.options) and costs == sorted(costs, reverse=True)
    dear = divide_with_shared_axes([divider], 4, index_cost=1e4)
    assert dear.orientations == min(one.orientations for one in found.options), "hours for an axis are not worth it"


def test_a_turn_of_the_machine_is_dearer_than_a_piece(divider: Divider) -> None:
    pace = divider.job.worth.timed
    assert pace is not None and 0.1 < pace.turning(np.array([0.0, 0.0, 1.0])) < 20
    assert divider.index_cost > divider.piece_cost > pace.ends


def test_a_plan_for_least_time_tells_it_for_each_number_of_axes() -> None:
    def planned(**words: object) -> Plan:
        return ta.plan([_face(7.0)], TOOL, H, machine=MIKRON, feedrate=6000, objective="time", workers=1, **words)

    made = planned(orientations="auto")
    assert made.outcome == "complete" and made.timed
    assert all(option.seconds is not None and option.length > 0 for option in made.options)
    chosen = next(option for option in made.options if option.chosen)
    assert chosen.seconds is not None and made.seconds == pytest.approx(chosen.seconds, rel=0.3)
    assert chosen.orientations == made.orientations
    whole, few = planned(), planned(orientations=3)
    assert made.seconds <= whole.seconds * (1 + 1e-9), "what divides by itself never loses to whole faces"
    assert few.seconds <= whole.seconds * (1 + 1e-9) and few.orientations <= 3, "nor does what may have so many axes"
