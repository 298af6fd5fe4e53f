"""Pictures of what a machine can do: its jerk along a feed, the best over all feeds, and the speed along a pass."""

from collections.abc import Iterator, Mapping
from itertools import combinations
from typing import Any

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
    way = unit(as_rows(feed, 3, "feed direction")[0])
    limits = box(mounting.machine, level) / 1000
    reach = 1.05 * float(np.linalg.norm(limits))
    made = figure(4.4 * len(setups), 4.6)
    for k, (name, rotary) in enumerate(setups.items()):
        ax = made.add_subplot(1, len(setups), k + 1, projection="3d")
        turn = part_from_machine(mounting.machine, rotary, mounting.table_from_part)[0]
        for begin, end in _box_edges(limits):
            _draw_line(ax, turn @ begin, turn @ end, color=BLUE, linewidth=1.2)
        tip = way * _reach_along(way, turn, limits)
        _draw_line(ax, np.zeros(3), tip, color=VERMILION, linewidth=2.5)
        ax.scatter(*tip, color=VERMILION, s=25)
        angles = _angle_words(mounting, rotary)
        ax.set_title(f"{name}: {angles}\n{np.linalg.norm(tip):.2f} {_UNITS[level]} along the feed", fontsize=9)
        ax.set(xlim=(-reach, reach), ylim=(-reach, reach), zlim=(-reach, reach))
        ax.set(xlabel="x", ylabel="y", zlabel="z")
        ax.set_box_aspect((1, 1, 1), zoom=0.85)
        ax.tick_params(labelsize=7)
    return made


def _box_edges(limits: Array) -> Iterator[tuple[Array, Array]]:
    """Ends of the edges of a box around zero: corners of which one coordinate has another sign."""
    for one, other in combinations(box_vertices(limits), 2):
        differs = np.sign(one) != np.sign(other)
        if int(differs.sum()) == 1:
            yield one, other


def _draw_line(ax: Any, begin: Array, end: Array, **style: Any) -> None:
    """Draw a straight line between two points in space."""
    x, y, z = np.stack([begin, end]).T
    ax.plot(x, y, z, **style)


def _reach_along(way: Array, turn: Array, limits: Array) -> float:
    """How far a box that is turned reaches along a direction."""
    shares = np.abs(np.linalg.solve(turn, way))
    return float(np.min(limits / np.maximum(shares, 1e-12)))


def _angle_words(mounting: Mounting, rotary: ArrayLike) -> str:
    """The angles of rotary axes, each with the axis's name."""
    angles = np.degrees(np.atleast_1d(rotary)) + 0.0
    words = [f"{axis.name} = {value:.1f}°" for axis, value in zip(mounting.machine.rotary, angles, strict=True)]
    return ", ".join(words)


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
    tilts = np.linspace(0, np.pi / 2, 181)
    turns = np.linspace(0, 2 * np.pi, 361)
    tilt, turn = np.meshgrid(tilts, turns, indexing="ij")
    cosine = np.cos(turn)
    sine = np.sin(turn)
    level_part = np.sin(tilt)
    feeds = np.stack([level_part * cosine, level_part * sine, np.cos(tilt)], axis=-1)
    values = best_along(machine, level, feeds.reshape(-1, 3)).reshape(tilt.shape) / 1000
    made = figure(5.6, 4.6)
    ax = made.subplots()
    # Equal areas of the picture are equal parts of the hemisphere.
    radius = 2 * np.sin(tilt / 2)
    shown = ax.pcolormesh(radius * cosine, radius * sine, values, shading="gouraud", cmap="viridis")
    edge = 2 * np.sin(pole_zone(machine, level) / 2)
    ax.plot(edge * cosine[0], edge * sine[0], color="white", linewidth=1.2, linestyle="--")
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
        label = f"{name}: {found.duration:.3f} s"
        ax.plot(places, 0.06 * speeds, color=colour, linewidth=1.6, label=label)
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
    times = np.linspace(0.0, found.duration, _TIMES)
    state = found.path_at(times)
    return state[:, 0], state[:, 1]
