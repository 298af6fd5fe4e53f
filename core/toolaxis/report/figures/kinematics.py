"""Pictures of what a machine can do: its jerk along a feed, the best over all feeds, and the speed along a pass."""

from collections.abc import Mapping
from itertools import combinations

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from toolaxis.feed.time_optimal import CurveSchedule
from toolaxis.machine.feed_polytopes import Level, best_along, box, pole_zone
from toolaxis.machine.kinematics import part_from_machine
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.polytopes import box_vertices
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.report.figures.plots import BLUE, GREY, ORANGE, VERMILION, figure

Array = NDArray[np.float64]

_UNITS = {Level.VELOCITY: "m/s", Level.ACCELERATION: "m/s²", Level.JERK: "m/s³"}
#: Times at which a speed is drawn.
_TIMES = 800
_COLOURS = (GREY, VERMILION, BLUE, ORANGE)


def polytope_figure(mounting: Mounting, level: Level, feed: ArrayLike, setups: Mapping[str, ArrayLike]) -> Figure:
    """What the linear axes can do, turned to the part by rotary angles, and how far they go along a feed direction.

    Parameters
    ----------
    mounting : Mounting
        Of a machine that states its limits.
    level : Level
    feed : (3,) array_like
        Part's frame.
    setups : mapping of str to (m,) array_like
        Names and rotary angles, rad; a panel for each.
    """
    way, limits = unit(as_rows(feed, 3, "feed direction")[0]), box(mounting.machine, level) / 1000
    corners = box_vertices(limits)
    reach = 1.05 * float(np.linalg.norm(limits))
    made = figure(4.4 * len(setups), 4.6)
    for k, (name, rotary) in enumerate(setups.items()):
        ax = made.add_subplot(1, len(setups), k + 1, projection="3d")
        turn = part_from_machine(mounting.machine, rotary, mounting.table_from_part)[0]
        for a, b in combinations(range(len(corners)), 2):
            if int((np.sign(corners[a]) != np.sign(corners[b])).sum()) == 1:
                ax.plot(*(turn @ corners[[a, b]].T), color=BLUE, linewidth=1.2)
        tip = way * float(np.min(limits / np.maximum(np.abs(np.linalg.solve(turn, way)), 1e-12)))
        ax.plot(*np.stack([np.zeros(3), tip]).T, color=VERMILION, linewidth=2.5)
        ax.scatter(*tip, color=VERMILION, s=25)
        angles = ", ".join(f"{axis.name} = {value:.1f}°" for axis, value in
                           zip(mounting.machine.rotary, np.degrees(np.atleast_1d(rotary)) + 0.0, strict=True))
        ax.set_title(f"{name}: {angles}\n{np.linalg.norm(tip):.2f} {_UNITS[level]} along the feed", fontsize=9)
        ax.set(xlim=(-reach, reach), ylim=(-reach, reach), zlim=(-reach, reach), xlabel="x", ylabel="y", zlabel="z")
        ax.set_box_aspect((1, 1, 1), zoom=0.85)
        ax.tick_params(labelsize=7)
    return made


def reach_figure(mounting: Mounting, level: Level) -> Figure:
    """The most that any rotary angles allow along each feed direction, over the upper half of all directions.

    Parameters
    ----------
    mounting : Mounting
        Of a machine with a table of two axes at right angles.
    level : Level

    Notes
    -----
    **Source** [grandguillaume2021] Figs. 10 and 12.
    """
    machine = mounting.machine
    tilt, turn = np.meshgrid(np.linspace(0, np.pi / 2, 181), np.linspace(0, 2 * np.pi, 361), indexing="ij")
    feeds = np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], axis=-1).reshape(-1, 3)
    values = best_along(machine, level, feeds).reshape(tilt.shape) / 1000
    made = figure(5.6, 4.6)
    ax = made.subplots()
    shown = ax.pcolormesh(2 * np.sin(tilt / 2) * np.cos(turn), 2 * np.sin(tilt / 2) * np.sin(turn), values,
                          shading="gouraud", cmap="viridis")
    edge = 2 * np.sin(pole_zone(machine, level) / 2)
    ax.plot(edge * np.cos(turn[0]), edge * np.sin(turn[0]), color="white", linewidth=1.2, linestyle="--")
    ax.annotate("no corner is met inside", (0, 0), xytext=(0, -3), textcoords="offset points", color="white",
                fontsize=8, horizontalalignment="center")
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.set_title(f"{machine.name}: best {level.name.lower()} along a feed direction, seen from +z", fontsize=10)
    made.colorbar(shown, ax=ax, label=_UNITS[level], shrink=0.85)
    return made


def feed_figure(passes: Mapping[str, CurveSchedule], feed: float) -> Figure:
    """The speed along one pass with several set-ups.

    Parameters
    ----------
    passes : mapping of str to CurveSchedule
        By the names of the set-ups.
    feed : float
        Programmed, mm/s.
    """
    made = figure(8.0, 3.6)
    ax = made.subplots()
    for (name, found), colour in zip(passes.items(), _COLOURS, strict=False):
        places, speeds = speeds_along(found)
        ax.plot(places, 0.06 * speeds, color=colour, linewidth=1.6, label=f"{name}: {found.duration:.3f} s")
    if np.isfinite(feed):
        ax.axhline(0.06 * feed, color="black", linewidth=0.8, linestyle=":", label="programmed")
    ax.set(xlabel="way along the pass, mm", ylabel="feed, m/min", ylim=(0, None))
    ax.margins(x=0.01)
    ax.grid(alpha=0.25)
    ax.legend(fontsize=8, frameon=False, loc="lower center")
    ax.set_title("feed along the pass", fontsize=10)
    return made


def speeds_along(found: CurveSchedule) -> tuple[Array, Array]:
    """Ways, mm, and speeds, mm/s, all along.

    Parameters
    ----------
    found : CurveSchedule
    """
    state = found.path_at(np.linspace(0.0, found.duration, _TIMES))
    return state[:, 0], state[:, 1]
