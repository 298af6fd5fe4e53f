"""4+1 axes [zhu2016, Sec. 5.4] against the best fixed axis: `python -m benchmarks.four_plus_one [FACES] [--brute]`.

On three example faces, with the paper's cutter: passes and cutting length of the best 3+2 axis and of 4+1 axes on one
machine, the clamped angle, how the free axis turns at the programmed feed (its greatest speed and acceleration by the
planner of feeds, beside what its drive allows), times of both by the same planner, and the judge's verdict.  With
`--brute` every angle at which either axis can be clamped is counted in steps of half a degree, and what the search
found is set beside the best of them.
"""

import sys
import time
from collections.abc import Sequence

import numpy as np
from benchmarks._papers import GOUGE

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.feed.fixed_axis_time import Feeds
from toolaxis.feed.moving_axis_time import FiveAxisSchedule
from toolaxis.job.planning.timing import feeds_of
from toolaxis.machine.setup import Mounting
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan
from toolaxis.search.face_problem import task
from toolaxis.strategies.four_plus_one.clamp_angle import ClampSearch
from toolaxis.strategies.four_plus_one.search import FourPlusOneSearch, clampable_angles
from toolaxis.tools.tool import Tool

FACES = ("freeform", "saddle", "hyperbolic_paraboloid")
MACHINE, TOOL, SCALLOP = "mikron-ucp-710", "torus:12x1", 0.02
STEP = np.radians(0.5)
#: Clamped angles whose reckoned length is within this factor of what the search found are counted exactly, and those
#: within this factor of the shortest of them with a moving axis too.
_NEAR, _NEARER = 1.15, 1.03


def turning(plan: Plan) -> list[tuple[str, float, float, float, float]]:
    """Name, greatest speed and acceleration of each rotary axis on cuts, and what its drive allows, deg and s."""
    op, mounting = plan.operations[0], plan.machine
    assert op.path is not None and mounting is not None
    feeds: Feeds = feeds_of(plan.inputs)
    made = FiveAxisSchedule(mounting.machine, op.path, feeds, mounting.table_from_part)
    most = np.zeros((2, 2))
    for one in made.stretches():
        found = made.curve(one) if one.turning and one.kind == Motion.CUT else None
        if found is not None:
            _, *state, _ = found.at(np.linspace(0.0, found.duration, 4000))
            for level, rows in enumerate(state):
                most[level] = np.maximum(most[level], np.abs(rows[:, 3:] / made.levers).max(axis=0))
    told = []
    for k, axis in enumerate(mounting.machine.rotary):
        assert axis.drive is not None
        limits = axis.drive.levels(axis.name)
        speed, rate, top, steep = (float(np.degrees(x)) for x in (most[0, k], most[1, k], limits[0], limits[1]))
        told.append((axis.name, speed, rate, top, steep))
    return told


def brute(name: str) -> None:
    """Every clamped angle in steps of half a degree, counted as the search counts, beside what the search finds."""
    face = ta.load(f"examples/{name}.step").sculptured[0]
    mounting = Mounting(ta.load_machine(MACHINE))
    job = task(face, Tool.torus(12, 1), SCALLOP, mounting, tolerance=GOUGE)
    began = time.perf_counter()
    finder = FourPlusOneSearch(ClampSearch(job, mounting))
    found = finder.found(Orientation(None))[0]  # no fixed axis: the search stands on its own
    spent = time.perf_counter() - began
    every = FourPlusOneSearch(ClampSearch(job, mounting))
    rows = []
    for which, axis in enumerate(mounting.machine.rotary):
        for angle in clampable_angles(axis, STEP):
            for feed in ("u", "v"):
                rough = every.search.reckoned(every.search.clamp(which, float(angle)), feed)
                rows += [] if rough is None else [(rough.length, rough.clamp, feed)]
    near = [row for row in rows if row[0] <= _NEAR * found.count.length]
    whole = [one for one in (every.choice(clamp, feed) for _, clamp, feed in near) if one is not None]
    whole.sort(key=lambda one: one.count.length)
    some = [one for one in whole if one.count.length <= _NEARER * whole[0].count.length]
    top = min((every.moving(one) for one in some), key=lambda one: one.count.length)
    said = [f"{one.count.length:.1f} mm with {mounting.machine.rotary[one.candidate.clamp.which].name} at "
            f"{np.degrees(one.candidate.clamp.angle):.2f} deg, feed {one.candidate.feed}" for one in (top, found)]
    print(f"{name}: brute force, {len(rows)} clamped angles and feeds reckoned, {len(near)} counted, {len(some)} of "
          f"them with a moving axis: best {said[0]}; the search, {len(finder.known)} counted in {spent:.0f} s: "
          f"{said[1]}, {100 * (found.count.length / top.count.length - 1):+.2f} %", flush=True)


def measured(name: str) -> None:
    """One face: both plans and what they come to."""
    rows = []
    for strategy in ("indexed", "four-plus-one"):
        began = time.perf_counter()
        plan = ta.plan(f"examples/{name}.step", TOOL, SCALLOP, machine=MACHINE, strategy=strategy, workers=1,
                       tolerance=GOUGE)
        spent, op = time.perf_counter() - began, plan.operations[0]
        verdict = ta.verify(plan)
        one = verdict.operations[0]
        rows.append(plan)
        print(f"{name}, {strategy}: {op.orientation.passes} passes, cutting length {op.orientation.length:.1f} mm, "
              f"time {plan.seconds:.1f} s, judge {'passed' if verdict.passed else 'FAILED'}: scallop "
              f"{one.scallop_max:.5f} mm, gouge {one.gouge_max:.5f} mm; planned in {spent:.0f} s", flush=True)
    fixed, moving = (plan.operations[0] for plan in rows)
    print(f"  {moving.orientation.reasons[0]}; {moving.orientation.reasons[1]}; length "
          f"{100 * (moving.orientation.length / fixed.orientation.length - 1):+.1f} %, time "
          f"{100 * (rows[1].seconds / rows[0].seconds - 1):+.1f} %")
    if moving.orientation.lead is not None:
        for axis, speed, rate, top, most in turning(rows[1]):
            print(f"  {axis} on cuts: at most {speed:.2f} of {top:.1f} deg/s and {rate:.1f} of {most:.1f} deg/s2")


def main(asked: Sequence[str] = ()) -> None:
    """Measure the faces that are named, all of them without any."""
    faces = [word for word in asked if not word.startswith("-")]
    for name in faces or FACES:
        (brute if "--brute" in asked else measured)(name)


if __name__ == "__main__":
    main(sys.argv[1:])
