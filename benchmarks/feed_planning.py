"""Planning of feeds against the time that the path takes: 10^3 to 10^5 points, with a fixed and with a moving axis.

Passes of 100 mm, a point every 0.1 mm, to and fro over a waved surface on the Mikron UCP 710 with its limits of
velocity, acceleration and jerk; the moving axis leads by 10 degrees and sways with the normal.
"""

import time

import numpy as np

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.feed.fixed_axis_time import Feeds, machining_time
from toolaxis.feed.moving_axis_time import five_axis_time
from toolaxis.machine.machine import Machine
from toolaxis.numeric.vectors import unit

LENGTH, STEP, LEAD = 100.0, 0.1, np.radians(10)
FEEDS = (3000.0, 5000.0)
COUNTS = (1_000, 10_000, 100_000)


def path(count: int, moving: bool) -> ToolPath:
    """Passes to and fro with a number of points, each pass linked to the next one in the surface."""
    each = int(LENGTH / STEP)
    x = np.arange(each) * STEP - LENGTH / 2
    passes = max(1, count // each)
    rows = np.concatenate([np.column_stack([x[::(-1) ** k], np.full(each, float(k) - passes / 2)])
                           for k in range(passes)])
    height = 6 * np.sin(rows[:, 0] / 14) * np.cos(rows[:, 1] / 20)
    slope = np.column_stack([6 / 14 * np.cos(rows[:, 0] / 14) * np.cos(rows[:, 1] / 20),
                             -6 / 20 * np.sin(rows[:, 0] / 14) * np.sin(rows[:, 1] / 20)])
    normal = unit(np.column_stack([-slope, np.ones(len(rows))]))
    axis = np.broadcast_to([0.0, 0.0, 1.0], normal.shape)
    if moving:
        axis = unit(normal + np.tan(LEAD) * np.array([1.0, 0.0, 0.0]))
    points = np.column_stack([rows, height])
    kind = np.full(len(rows), Motion.CUT, dtype=np.int8)
    kind[each::each] = Motion.LINK
    return ToolPath(points, points, axis, normal, kind, np.append(np.arange(passes) * each, len(rows)))


def line(machine: Machine, feed: float, count: int, moving: bool) -> str:
    """What planning took at best, beside what the path takes."""
    feeds, tried = Feeds(cut=feed / 60, tolerance=0.01, smooth=True, crossing=feed / 60), path(count, moving)
    best, seconds = float("inf"), 0.0
    for _ in range(2):
        start = time.perf_counter()
        found = five_axis_time(machine, tried, feeds)[0] if moving else machining_time(machine, tried, feeds)
        best, seconds = min(best, time.perf_counter() - start), found.total
    return (f"  {'moving' if moving else 'fixed'} axis {feed:5.0f} mm/min {count:7d} points: {seconds:8.1f} s to "
            f"machine, planned in {best:7.3f} s ({best / count * 1e6:6.1f} us a point), "
            f"{100 * best / seconds:5.2f} % of it")


def main() -> None:
    """Print a line for each path."""
    machine = ta.load_machine("mikron-ucp-710")
    print(f"{machine.name}, a point every {STEP} mm")
    for moving in (False, True):
        for feed in FEEDS:
            for count in COUNTS:
                print(line(machine, feed, count, moving), flush=True)


if __name__ == "__main__":
    main()
