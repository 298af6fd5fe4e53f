"""Pictures of the axis that turns while the other one is clamped: its angle over the face and along the passes."""

from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.feed.continuous_ik import following
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.report.figures.plots import bare, figure, scale_bar
from toolaxis.report.figures.splat_renderer import camera_onto

Array = NDArray[np.float64]


#: Colours of angles and of passes in their order.
_MAP, _ORDER = "twilight_shifted", "viridis"
#: Turn below which an axis stands still, rad.
_STILL = 1e-3


@dataclass(frozen=True, eq=False)
class FreeAxisMotion:
    """How the free axis turns on the cuts of an operation.

    Attributes
    ----------
    clamped, free : str
        Names of the axes.
    angle : float
        Of the clamped one, deg.
    passes : tuple of ((n, 3) array, (n,) array)
        Contacts of each stroke, mm, and angles of the free axis there, deg.
    """

    clamped: str
    free: str
    angle: float
    passes: tuple[tuple[Array, Array], ...]


def turning_of(plan: Plan, op: Operation) -> FreeAxisMotion | None:
    """How the free axis turns; None where there is no machine, or none of its axes stands still.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    """
    mounting, path = plan.machine, op.path
    if mounting is None or path is None or len(mounting.machine.rotary) != 2:
        return None
    along = following(mounting.machine, path, mounting.table_from_part, float(op.tool.gauge_length or 0.0))
    rotary = along.rotary[np.searchsorted(along.arrival, np.arange(len(path.cl)), side="right") - 1]
    which = int(np.argmin(np.ptp(rotary, axis=0)))
    if np.ptp(rotary[:, which]) > _STILL:
        return None
    cuts = np.flatnonzero(path.kind == Motion.CUT)
    strokes = np.split(cuts, np.flatnonzero(np.diff(cuts) > 1) + 1)
    rows = tuple((path.cc[one], np.degrees(rotary[one, 1 - which])) for one in strokes if len(one) > 1)
    names = [axis.name for axis in mounting.machine.rotary]
    return FreeAxisMotion(names[which], names[1 - which], float(np.degrees(rotary[0, which])), rows)


def draw_free_angle(plan: Plan, op: Operation, folder: Path) -> None:
    """Draw how the free axis turns, where the other one stands still.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    folder : Path
    """
    turning = turning_of(plan, op)
    if turning is not None:
        free_angle_picture(turning, op).savefig(folder / f"{op.name}-angle.png")


def free_angle_picture(turning: FreeAxisMotion, op: Operation) -> Figure:
    """The angle of the free axis over the face, and its angle and its rate along every pass.

    Parameters
    ----------
    turning : FreeAxisMotion
    op : Operation
    """
    made = figure(12.5, 5.6)
    grid = made.add_gridspec(2, 2, width_ratios=(1.15, 1.0))
    plan, graph, rate = made.add_subplot(grid[:, 0]), made.add_subplot(grid[0, 1]), made.add_subplot(grid[1, 1])
    seen = camera_onto(op.face.normal(op.face.places_on(16)),
                       np.concatenate([contact for contact, _ in turning.passes]))
    every = np.concatenate([angle for _, angle in turning.passes])
    norm = Normalize(float(every.min()), float(every.max()))
    colours = mpl.colormaps[_ORDER](np.linspace(0.0, 0.92, len(turning.passes)))
    image = None
    for (contact, angle), colour in zip(turning.passes, colours, strict=True):
        flat = seen.project(contact)[:, :2]
        pieces = np.stack([flat[:-1], flat[1:]], axis=1)
        image = plan.add_collection(LineCollection(list(pieces), array=(angle[:-1] + angle[1:]) / 2, cmap=_MAP,
                                                   norm=norm, linewidths=2.2))
        way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(contact, axis=0), axis=1))])
        if _backwards(turning, contact):
            way, angle = way[-1] - way[::-1], angle[::-1]
        graph.plot(way, angle, color=colour, linewidth=0.9)
        gaps = np.diff(way) > 1e-3
        rate.plot(((way[1:] + way[:-1]) / 2)[gaps], (np.diff(angle)[gaps] / np.diff(way)[gaps]), color=colour,
                  linewidth=0.7)
    plan.autoscale_view()
    if image is not None:
        made.colorbar(image, ax=plan, shrink=0.85).set_label(f"{turning.free}, deg")
    scale_bar(plan, seen)
    bare(plan)
    plan.set_title(f"{op.name}: {turning.clamped} clamped at {turning.angle:.3f} deg, {turning.free} along the passes",
                   fontsize=10)
    graph.set_ylabel(f"{turning.free}, deg")
    rate.set_ylabel(f"{turning.free}, deg/mm")
    rate.set_xlabel("way along the pass, mm")
    graph.set_title("from the first pass, dark, to the last; passes back are turned round", fontsize=9)
    for ax in (graph, rate):
        ax.grid(alpha=0.25)
    return made


def _backwards(turning: FreeAxisMotion, contact: Array) -> bool:
    """Whether a pass runs against the first one."""
    first = turning.passes[0][0]
    return bool((contact[-1] - contact[0]) @ (first[-1] - first[0]) < 0)
