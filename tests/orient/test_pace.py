"""Least time: the estimate against the planner, the search against brute force, and what it needs."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.feed.fixed_axis_time import Feeds, machining_time
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import unit
from toolaxis.plan.choices import FEEDS
from toolaxis.search.cost import MachiningCost
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import task
from toolaxis.search.fixed_axis import best_axis
from toolaxis.search.local_search import CountedAxis
from toolaxis.search.rank_by_passes import least_made
from toolaxis.search.time_estimate import TimeEstimate
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

MIKRON = Mounting(load_machine("mikron-ucp-710"))
TOOL, H = Tool.torus(diameter=12, corner_radius=2), 0.1
FAST = Feeds(150.0, tolerance=0.005, smooth=True)
#: Axes that lean by 15 to 45 degrees, all around.
LEANS = np.array([(np.sin(t) * np.cos(c), np.sin(t) * np.sin(c), np.cos(t))
                  for t in np.radians((15, 25, 35, 45)) for c in np.radians(np.arange(0, 360, 20))])


@pytest.fixture(scope="module")
def face() -> Face:
    x, y = np.meshgrid(np.linspace(0, 60, 5), np.linspace(0, 45, 5), indexing="ij")
    return Face.from_bspline(np.stack([x, y, 4 * np.sin(x / 20) + 3 * np.cos(y / 15)], axis=-1))


def _planned(job, axis: np.ndarray, feed: str) -> float:
    return machining_time(MIKRON.machine, job.made(axis, feed), FAST).path


def test_the_estimate_orders_axes_as_the_planner_does(face: Face) -> None:
    job = task(face, TOOL, H, MIKRON, objective="time", feeds=FAST)
    guessed, planned = [], []
    for axis in LEANS[20:72:13]:
        for k, feed in enumerate(FEEDS):
            passes, length = job.worth.counted(axis, feed)
            guessed.append(job.worth.value(axis, k, passes, length))
            planned.append(_planned(job, axis, feed))
    ratio = np.array(guessed) / np.array(planned)
    assert 0.84 < ratio.min() and ratio.max() < 1.12, "passes are whole numbers, here 18 for 16.99"
    assert np.corrcoef(guessed, planned)[0, 1] > 0.95, "several take nearly the same time, so ranks tell little"


def test_screening_and_counting_price_alike(face: Face) -> None:
    worth = MachiningCost(face, TOOL, H, objective="time", pace=TimeEstimate(face, TOOL, MIKRON, FAST))
    found = worth.screen(LEANS[20:24])
    table = worth.values(LEANS[20:24], found)
    for row, axis in enumerate(LEANS[20:24]):
        for k in range(2):
            alone = worth.value(axis, k, float(found.passes[row, k]), float(found.length[row, k]))
            assert alone == pytest.approx(table[row, k], rel=1e-9)


def test_least_time_is_not_least_length(face: Face) -> None:
    by_length, by_time = (best_axis(face, TOOL, H, MIKRON, objective=name, feeds=FAST, limits="cone:0,0,1,35")
                          for name in ("length", "time"))
    job = task(face, TOOL, H, MIKRON)
    slow, fast = (_planned(job, one.axis, one.feed) for one in (by_length, by_time))
    assert fast <= slow * 1.01
    assert by_time.length >= by_length.length * 0.999


@pytest.mark.long
def test_within_a_percent_of_brute_force(face: Face) -> None:
    """Of the free axes of a grid over the half sphere, the dozen that count best, by the planner."""
    found = best_axis(face, TOOL, H, MIKRON, objective="time", feeds=FAST)
    job = task(face, TOOL, H, MIKRON, objective="time", feeds=FAST)
    ledger = AxisTable(job.feasibility, job.worth)
    rows = ledger.look(LEANS)
    free = [k for k in range(rows.start, rows.stop) if ledger.reason[k] == 0]
    priced = sorted((ledger.count(ledger.axes[k], feed, 0.0)[0], k, feed) for k in free for feed in range(2))
    least = min(_planned(job, ledger.axes[k], FEEDS[feed]) for _, k, feed in priced[:12])
    assert len(free) > 20 and _planned(job, found.axis, found.feed) <= 1.01 * least


def test_a_ball_end_takes_the_axis_that_its_machine_likes(face: Face) -> None:
    ball = Tool.ball(diameter=8)
    plain, timed = (best_axis(face, ball, 0.5, MIKRON, objective=name, feeds=FAST, limits="cone:0,0,1,20")
                    for name in ("length", "time"))
    job = task(face, ball, 0.5, MIKRON)
    assert _planned(job, timed.axis, timed.feed) <= _planned(job, plain.axis, plain.feed) * 1.001
    assert timed.length == pytest.approx(plain.length, rel=0.02)


def test_the_planner_decides_between_lobes_of_nearly_the_same_time(face: Face) -> None:
    job = task(face, TOOL, H, MIKRON, objective="time", feeds=FAST)
    some = []
    for axis in (LEANS[20], LEANS[29]):
        passes, length = job.worth.counted(axis, "u")
        some.append(CountedAxis(axis, 0, job.worth.value(axis, 0, passes, length), passes, length, 0.0))
    some.sort(key=lambda one: -_planned(job, one.axis, "u"))  # the worse one first, as if the estimate liked it
    some[1] = replace(some[1], value=1.05 * some[0].value)
    ordered = least_made(job.worth, some, job.made)
    times = [_planned(job, one.axis, "u") for one in ordered]
    assert times == sorted(times)
    far = [some[0], replace(some[1], value=2 * some[0].value)]
    assert least_made(job.worth, far, job.made) == far
    assert least_made(task(face, TOOL, H, MIKRON).worth, some, job.made) is some


def test_what_time_needs(face: Face) -> None:
    machine = MIKRON.machine
    unknown = replace(machine, linear=(replace(machine.linear[0], drive=replace(machine.linear[0].drive, jerk=None)),
                                       *machine.linear[1:]))
    for given, feeds, said in ((None, FAST, "needs a machine"), ("cone:0,0,1,40", FAST, "needs a machine"),
                               (unknown, FAST, "does not state jerk of axis X"), (MIKRON, None, "needs feeds")):
        with pytest.raises(InvalidInput, match=said):
            best_axis(face, TOOL, H, given, objective="time", feeds=feeds)
    with pytest.raises(InvalidInput, match="needs a machine with known limits"):
        MachiningCost(face, TOOL, H, objective="time")


def test_the_ends_of_a_pass(face: Face) -> None:
    """As the planner finds them on passes over a plane."""
    x, y = np.meshgrid(np.linspace(0, 40, 4), np.linspace(0, 30, 4), indexing="ij")
    flat = Face.from_bspline(np.stack([x, y, 0 * x], axis=-1))
    job = task(flat, TOOL, H, MIKRON, objective="time", feeds=FAST)
    axis = unit(np.array([0.3, 0.0, 1.0]))
    path = job.made(axis, "v")
    time = machining_time(MIKRON.machine, path, FAST)
    assert (time.path - time.cut) / path.passes == pytest.approx(job.worth.pace.ends, rel=0.35)
