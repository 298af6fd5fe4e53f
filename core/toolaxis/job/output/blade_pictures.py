"""What the pictures of a blade operation show: its tool angles again, beside what they compete with."""

from math import degrees
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.feed.axis_motion import AxisMotion, axis_motion
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.search.fixed_axis import Task
from toolaxis.strategies.blade.baselines import SmoothSection, by_quaternions, unscheduled
from toolaxis.strategies.blade.pictures import angles_picture, axes_picture
from toolaxis.strategies.blade.plan import CLEARANCES, BladeSearch
from toolaxis.strategies.blade.schedule import CLEARANCE, Scheduled, Swing, scheduled

Array = NDArray[np.float64]

_FINE, _DPI = 4000, 110
_TITLES = {"least": "least acceleration", "keys": "key points"}


def draw_blade(plan: Plan, op: Operation, job: Task, folder: Path) -> None:
    """Draw the S-theta plane of the layer with the narrowest channel, and what the machine's axes do along it.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    job : Task
    folder : Path
    """
    search = BladeSearch(job)
    planes, _, _ = search.planes()
    clearance = _clearance(op)
    k = int(np.argmin([one.wide.width for one in planes]))
    some = planes[k:k + 1]
    order = ("least", "keys") if plan.inputs.method == "blade" else ("keys", "least")
    curves = {_TITLES[kind]: scheduled(some, search.swing, curve=kind, clearance=clearance)[0] for kind in order}
    first = next(iter(curves.values()))
    smooth, s = SmoothSection(first.section), np.linspace(0.0, first.section.length, _FINE)
    others = {"unscheduled": unscheduled(smooth, s), "quaternions": by_quaternions(smooth, s)}
    name = f"{op.name}, layer {k + 1} of {len(planes)}"
    angles_picture(curves, {title: (s, theta) for title, theta in others.items()},
                   name).savefig(folder / f"{op.name}-angles.png", dpi=_DPI)
    if plan.machine is None:
        return
    angles = {**others, **{title: one.curve.at(s)[0] for title, one in curves.items()}}
    speed = plan.inputs.feedrate / 60
    motions = {title: _motion(plan, first, (search.swing, theta), s, speed) for title, theta in angles.items()}
    axes_picture(motions, speed, name).savefig(folder / f"{op.name}-motion.png", dpi=_DPI)


def _clearance(op: Operation) -> float:
    """The clearance that the proof accepted: the one after those it refused."""
    refused = [one for one in CLEARANCES if any(f"refused with {degrees(one):.0f} deg" in why
                                                for why in op.orientation.reasons)]
    return CLEARANCES[min(len(refused), len(CLEARANCES) - 1)] if refused else CLEARANCE


def _motion(plan: Plan, one: Scheduled, turned: tuple[Swing, Array], s: Array, speed: float) -> AxisMotion:
    """What the machine's axes do with tool angles along a section."""
    swing, theta = turned
    assert plan.machine is not None
    x, y = swing.plane
    flat = SmoothSection(one.section).points(s)
    axis = swing.axes(theta)
    tips = flat[:, :1] * x + flat[:, 1:] * y - plan.tool.corner_radius * axis
    path = ToolPath(tips, tips, axis, axis, np.zeros(len(s), dtype=np.int8), np.array([0, len(s)]))
    return axis_motion(plan.machine.machine, path, s, speed, plan.machine.table_from_part)
