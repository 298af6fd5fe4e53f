"""Machining time of axes chosen by strip width, by jerk and by time itself, on five faces of the examples.

One torus cutter, 6 m/min, on the Mikron UCP 710; every axis with the same proofs, every time by the planner of feeds.
"Jerk" takes the axis among all that the search found free in which the linear axes do most along the mean feed.
"""

from pathlib import Path

import numpy as np

from toolaxis.job.planning.edit_axis import try_axis
from toolaxis.job.planning.pipeline import plan
from toolaxis.job.planning.timing import add_times, feeds_of
from toolaxis.machine.feed_polytopes import Level
from toolaxis.plan.choices import FEEDS
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.search.kinematic_setup import PassSegment, common_feed, reach_along_feed
from toolaxis.search.machine_limits import mounting_of
from toolaxis.search.time_estimate import TimeEstimate, require_machine_limits

EXAMPLES = Path(__file__).parents[1] / "examples"
FACES = ("freeform", "saddle", "waves", "biquintic", "hyperbolic_paraboloid")
TOOL, SCALLOP, FEED = "torus:12x1", 0.02, 6000.0


def by_jerk(made: Plan) -> Operation:
    """The first operation with the free axis of most jerk along the mean feed; the next one where that is refused."""
    op = made.operations[0]
    mounting, found = require_machine_limits(mounting_of(made.machine)), op.orientation.map
    assert found is not None
    axes = found.axis[found.reason == 0]
    rotary = np.array([mounting.solutions(axis)[0] for axis in axes])
    rows = []
    for k, feed in enumerate(FEEDS):
        lines = TimeEstimate(op.face, made.tools[0], mounting, feeds_of(made.inputs)).lines[k]
        along = common_feed([PassSegment(line.middles, line.normals) for line in lines])
        rows += [(value, i, feed) for i, value in enumerate(reach_along_feed(mounting, Level.JERK, along, rotary))]
    for _, i, feed in sorted(rows, key=lambda row: -row[0])[:12]:
        tried = try_axis(made, op, axes[i], feed)
        if tried.done:
            return tried
    return op


def main() -> None:
    """A row for each face."""
    print(f"{TOOL}, scallop {SCALLOP} mm, {FEED:g} mm/min, Mikron UCP 710")
    print(f"{'face':22} {'strip width':>22} {'jerk':>22} {'time':>22}   saved against width, jerk")
    for name in FACES:
        wide, fast = (plan(EXAMPLES / f"{name}.step", TOOL, SCALLOP, machine="mikron-ucp-710", feedrate=FEED,
                           objective=objective) for objective in ("length", "time"))
        strong = by_jerk(wide)
        jerky = add_times(Plan(wide.part, wide.tools, wide.inputs, (strong,), wide.obstacles, wide.datum, wide.outcome,
                               machine=wide.machine))
        told = [f"{made.length:7.0f} mm {made.seconds:7.1f} s" for made in (wide, jerky, fast)]
        saved = [100 * (1 - fast.seconds / made.seconds) for made in (wide, jerky)]
        print(f"{name:22} {told[0]:>22} {told[1]:>22} {told[2]:>22}   {saved[0]:6.1f} % {saved[1]:6.1f} %", flush=True)


if __name__ == "__main__":
    main()
