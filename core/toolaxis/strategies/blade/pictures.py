"""Pictures of tool angles around a blade: the S-theta plane with its channel, and what the machine's axes do."""

from collections.abc import Mapping
from math import degrees
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.feed.axis_motion import AxisMotion, axis_motion
from toolaxis.machine.setup import Mounting
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.report.figures.plots import BLUE, GREEN, GREY, ORANGE, SKY, VERMILION, figure
from toolaxis.search.face_problem import FaceProblem
from toolaxis.strategies.blade.baselines import SmoothSection, by_quaternions, constant_angles
from toolaxis.strategies.blade.plan import CLEARANCES, BladeSearch
from toolaxis.strategies.blade.schedule import CLEARANCE, ScheduledLayer, SwivelAxis, schedule_layers
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

_COLOURS = {"unscheduled": GREY, "quaternions": ORANGE, "key points": BLUE, "least acceleration": VERMILION}
_TITLES = {"least": "least acceleration", "keys": "key points"}
#: Points along a layer of the curves, and of the motions of the axes.
_FINE, _ALONG = 2000, 4000
#: What curves are compared with.
_BEFORE = ("unscheduled", "quaternions")
#: Velocity below which an axis stands still, mm/s or rad/s.
_STILL = 1e-6


def draw_blade(plan: Plan, op: Operation, job: FaceProblem, folder: Path, curve: str) -> None:
    """Draw the S-theta plane of the layer with the narrowest channel, and what the machine's axes do along it.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    job : FaceProblem
    folder : Path
    curve : str
        Of `toolaxis.strategies.blade.schedule.CURVES`: the one that the path follows; the others are drawn beside it.
    """
    search = BladeSearch(job)
    planes, _, _ = search.planes()
    clearance = _clearance(op)
    k = int(np.argmin([one.wide.width for one in planes]))
    some = planes[k:k + 1]
    order = sorted(_TITLES, key=lambda kind: kind != curve)
    curves = {_TITLES[kind]: schedule_layers(some, search.swing, curve=kind, clearance=clearance)[0] for kind in order}
    first = next(iter(curves.values()))
    smooth, s = SmoothSection(first.section), np.linspace(0.0, first.section.length, _ALONG)
    others = {"unscheduled": constant_angles(smooth, s), "quaternions": by_quaternions(smooth, s)}
    name = f"{op.name}, layer {k + 1} of {len(planes)}"
    angles_picture(curves, {title: (s, theta) for title, theta in others.items()},
                   name).savefig(folder / f"{op.name}-angles.png")
    if plan.machine is None:
        return
    angles = {**others, **{title: one.curve.at(s)[0] for title, one in curves.items()}}
    speed = plan.inputs.feedrate / 60
    setting = plan.machine, op.tool
    motions = {title: _motion(setting, first, (search.swing, theta), s, speed) for title, theta in angles.items()}
    axes_picture(motions, speed, name).savefig(folder / f"{op.name}-motion.png")


def _clearance(op: Operation) -> float:
    """The clearance that the proof accepted: the one after those it refused."""
    refused = [one for one in CLEARANCES if any(f"refused with {degrees(one):.0f} deg" in why
                                                for why in op.orientation.reasons)]
    return CLEARANCES[min(len(refused), len(CLEARANCES) - 1)] if refused else CLEARANCE


def _motion(setting: tuple[Mounting, Tool], one: ScheduledLayer, turned: tuple[SwivelAxis, Array], s: Array,
            speed: float) -> AxisMotion:
    """What the machine's axes do with tool angles along a section."""
    mounting, tool = setting
    swing, theta = turned
    x, y = swing.plane
    flat = SmoothSection(one.section).points(s)
    axis = swing.axes(theta)
    tips = flat[:, :1] * x + flat[:, 1:] * y - tool.corner_radius * axis
    path = ToolPath(tips, tips, axis, axis, np.zeros(len(s), dtype=np.int8), np.array([0, len(s)]))
    return axis_motion(mounting.machine, path, s, speed, mounting.table_from_part)


def angles_picture(curves: Mapping[str, ScheduledLayer], others: Mapping[str, tuple[Array, Array]],
                   name: str) -> Figure:
    """The S-theta plane of a layer with its channel, keys and curves, and their slopes and bends with the bound.

    Parameters
    ----------
    curves : mapping of str to Scheduled
        The same layer by several kinds of curves; the first one's channel and bound are drawn.
    others : mapping of str to pair of (n,) arrays
        S and theta of what is compared.
    name : str
        What the title calls the layer.
    """
    first = next(iter(curves.values()))
    s = np.linspace(0.0, first.section.length, _FINE)
    made = figure(12.0, 7.0)
    grid = made.add_gridspec(3, 2, width_ratios=(1.0, 2.2))
    plan = made.add_subplot(grid[:, 0])
    _section(plan, first)
    panels = [made.add_subplot(grid[k, 1]) for k in range(3)]
    panels[0].fill_between(first.wide.lengths, np.degrees(first.wide.low), np.degrees(first.wide.high), color=SKY,
                           alpha=0.25, linewidth=0, label="channel")
    for side in (first.free.low, first.free.high):
        panels[0].plot(first.free.lengths, np.degrees(side), color=SKY, linewidth=0.8)
    for title, (at, theta) in others.items():
        middle = np.degrees(first.free.low.mean() + first.free.high.mean()) / 2
        turn = 360 * np.round((np.degrees(theta.mean()) - middle) / 360)
        panels[0].plot(at, np.degrees(theta) - turn, color=_COLOURS[title], linewidth=1.0, label=title)
        panels[1].plot(at, np.degrees(np.gradient(theta, at)), color=_COLOURS[title], linewidth=1.0)
    for title, one in curves.items():
        rows = np.degrees(one.curve.at(s))
        for ax, row in zip(panels, rows, strict=True):
            ax.plot(s, row, color=_COLOURS[title], linewidth=1.8, label=title)
        if len(one.keys):
            panels[0].plot(one.keys[:, 0], np.degrees(one.keys[:, 1]), "o", color="black", markersize=4, label="keys")
    bound = np.degrees(first.bound)
    for sign in (1, -1):
        panels[2].axhline(sign * bound, color=GREEN, linewidth=1.2, linestyle="--",
                          label="no rising curve stays inside these" if sign > 0 else None)
    top = max(float(np.degrees(np.abs(one.curve.at(s)[1])).max()) for one in curves.values())
    panels[1].set_ylim(-0.6 * top, 1.6 * top)
    for ax, label in zip(panels, ("θ, deg", "dθ/dS, deg/mm", "d²θ/dS², deg/mm²"), strict=True):
        ax.set_ylabel(label)
        ax.margins(x=0.01)
        ax.grid(alpha=0.25)
    panels[0].legend(fontsize=8, frameon=False, loc="upper left")
    panels[2].legend(fontsize=8, frameon=False, loc="best")
    panels[2].set_xlabel("S along the layer, mm")
    panels[0].set_title(f"{name}: tool angle along the layer", fontsize=10)
    return made


def _section(ax: Axes, one: ScheduledLayer) -> None:
    """Cutter centres of a layer with the tool's directions, and the base point."""
    points = one.section.points
    ax.plot(*points.T, color=BLUE, linewidth=1.4)
    size = 0.16 * float(np.ptp(points, axis=0).max())
    some = np.linspace(0.0, one.section.length, 41)[:-1]
    at = np.column_stack([np.interp(some, one.section.lengths, column) for column in points.T])
    theta = one.curve.at(some)[0]
    ends = at + size * np.column_stack([np.cos(theta), np.sin(theta)])
    for a, b in zip(at, ends, strict=True):
        ax.plot(*np.stack([a, b]).T, color=VERMILION, linewidth=0.8)
    ax.plot(*points[0], "o", color="black", markersize=5)
    ax.annotate("base", points[0], xytext=(5, 5), textcoords="offset points", fontsize=8)
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.set_title("cutter centres and tool axes", fontsize=10)


def axes_picture(motions: Mapping[str, AxisMotion], speed: float, name: str) -> Figure:
    """Velocity and acceleration of the machine's axes along a layer at one speed.

    Parameters
    ----------
    motions : mapping of str to AxisMotion
    speed : float
        Of cutter centres, mm/s.
    name : str
    """
    first = next(iter(motions.values()))
    peaks = [one.peaks for one in motions.values()]
    shown = [k for k in range(len(first.names)) if max(peak[0][k] for peak in peaks) > _STILL]
    count = len(shown)
    made = figure(11.0, 1.9 * count)
    panels = np.atleast_2d(made.subplots(count, 2, sharex=True))
    for row, k in enumerate(shown):
        title = first.names[k]
        rotary, scale = k >= 3, 180 / np.pi if k >= 3 else 1.0
        for j, unit in enumerate(("deg/s" if rotary else "mm/s", "deg/s²" if rotary else "mm/s²")):
            ax = panels[row, j]
            for label, one in motions.items():
                rows = (one.velocity, one.acceleration)[j][:, k] * scale
                ax.plot(one.places, rows, color=_COLOURS[label], linewidth=1.2 if label in _BEFORE else 1.8,
                        label=f"{label}: {np.abs(rows).max():.0f}")
            most = sorted(float(peak[j][k]) * scale for peak in peaks)
            top = 1.15 * min(most[-1], 4 * most[0] + 1e-9)
            ax.set_ylim(-top, top)
            ax.set_ylabel(f"{title}, {unit}")
            ax.grid(alpha=0.25)
            ax.margins(x=0.01)
            ax.legend(fontsize=7, frameon=False, loc="upper center", ncols=2, title="greatest", title_fontsize=7)
    for ax in panels[-1]:
        ax.set_xlabel("S along the layer, mm")
    made.suptitle(f"{name}: axes at {60 * speed:.0f} mm/min, axes of the plots cut off", fontsize=10)
    return made
