"""Blades in four axes after [stheta2023]: tool angles of families of blades against what they compete with.

For each family 25 layers are re-scheduled by key points and with least peak acceleration.  Peaks of the rotary axis and
of all linear axes are those at one speed of the cutter's centre along the middle layer, on a machine with a table axis
A; times are those of the jerk-limited planner over three layers, whatever the speed asked for; the bound is what no
rising curve between the same ends can beat.  The paper prints -38.1 % and -72.9 % of rotary velocity and acceleration
against quaternions, and -24.5 % of the time of the program without re-scheduling; its blade is unpublished.
"""

import time
from pathlib import Path

import numpy as np
from benchmarks._blades import FAMILIES, sections
from benchmarks._papers import GOUGE
from numpy.typing import NDArray

from toolaxis.cad.load import load
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.feed.axis_motion import AxisMotion, axis_motion
from toolaxis.feed.fixed_axis_time import Feeds
from toolaxis.feed.moving_axis_time import five_axis_time
from toolaxis.machine.library import load_machine
from toolaxis.numeric.corner_rounding import corner
from toolaxis.search.face_problem import task
from toolaxis.skin.join import join
from toolaxis.strategies.blade.baselines import SmoothSection, by_quaternions, constant_angles
from toolaxis.strategies.blade.layers import along_blade
from toolaxis.strategies.blade.plan import blade
from toolaxis.strategies.blade.reschedule import swing_of_path
from toolaxis.strategies.blade.schedule import Layer, ScheduledLayer, SwivelAxis, reschedule
from toolaxis.strategies.blade.section import base_of, section
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

RADIUS, LAYERS, SPEED = 3.0, 25, 50.0
FINE, COARSE, TIMED = 6000, 400, 3
MACHINE = load_machine("four-axis-a")
EXAMPLE = Path(__file__).parents[1] / "examples" / "blisk.step"
#: The part stands with its z along X.
TURN = np.array([[0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
UP = SwivelAxis(np.array([0.0, 0.0, 1.0]))
EXACT = ((5.80323, 1.160646), (7.976613, 1.595323), (11.650766, 3.238075), (13.09737, 4.323028))


def layers(name: str, count: int = LAYERS) -> list[Layer]:
    """Layers of a family, a millimetre apart, each from its base point on, beside that of the one before."""
    made, before = [], None
    for k, rows in enumerate(sections(name, count, RADIUS)):
        one = section(rows)
        base = base_of(one)
        if before is not None and np.hypot(*(one.points[base] - before)) > 0.05 * one.length:
            base = int(np.argmin(np.hypot(*(one.points[:-1] - before).T)))  # the base must not jump between layers
        before = one.points[base]
        points = one.begun_at(base).points
        made.append(Layer(np.column_stack([points, np.full(len(points), float(k))])))
    return made


def path(found: list[ScheduledLayer], theta: list[Array], count: int) -> tuple[ToolPath, Array]:
    """A path over layers with tool angles, and the way of its cutter centres."""
    tips, axes, ways = [], [], []
    for k, (one, angle) in enumerate(zip(found, theta, strict=True)):
        s = np.linspace(0, one.section.length, count)
        flat = SmoothSection(one.section).points(s)
        x, y = UP.plane
        centre = flat[:, :1] * x + flat[:, 1:] * y + (k + s[:, None] / one.section.length) * UP.direction
        axis = UP.axes(angle)
        tips.append(centre - RADIUS * axis)
        axes.append(axis)
        ways.append(s + (ways[-1][-1] + 1e-3 if ways else 0.0))
    cl, axis = np.concatenate(tips), np.concatenate(axes)
    return ToolPath(cl, cl, axis, axis, np.zeros(len(cl), dtype=np.int8), np.array([0, len(cl)])), np.concatenate(ways)


def angles(kind: str, found: list[ScheduledLayer], count: int) -> list[Array]:
    """Tool angles of layers at even places."""
    rows = []
    for one in found:
        s = np.linspace(0, one.section.length, count)
        smooth = SmoothSection(one.section)
        rows.append(one.curve.at(s)[0] if kind == "curve" else constant_angles(smooth, s) if kind == "unscheduled" else
                    by_quaternions(smooth, s))
    return rows


def hits(one: ScheduledLayer, theta: Array) -> int:
    """Points of a layer at which the tool meets the section, by brute force over all its edges."""
    a, b = one.section.points[:-1], one.section.points[1:]
    way = np.column_stack([np.cos(theta), np.sin(theta)])[:, None]
    edge, off = (b - a)[None], a[None] - a[:, None]
    across = way[..., 0] * edge[..., 1] - way[..., 1] * edge[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (off[..., 0] * edge[..., 1] - off[..., 1] * edge[..., 0]) / across
        u = (off[..., 0] * way[..., 1] - off[..., 1] * way[..., 0]) / across
    return int(((t > 1e-6) & (u > 0) & (u < 1)).any(axis=1).sum())


def motion(found: list[ScheduledLayer], kind: str) -> AxisMotion:
    """What the axes do on the middle layer."""
    middle = found[len(found) // 2:len(found) // 2 + 1]
    made, way = path(middle, angles(kind, middle, FINE), FINE)
    return axis_motion(MACHINE, made, way, SPEED, TURN)


def seconds(found: list[ScheduledLayer], kind: str) -> float:
    """Jerk-limited time of some layers in the middle."""
    first = (len(found) - TIMED) // 2
    some = found[first:first + TIMED]
    made, _ = path(some, angles(kind, some, COARSE), COARSE)
    return float(five_axis_time(MACHINE, made, Feeds(SPEED * 4, smooth=True), TURN)[0].cut)


def row(title: str, made: AxisMotion, taken: float, against: tuple[AxisMotion, float] | None) -> None:
    """One line: peaks of the rotary axis, those of Y and Z, and time; in percent of what is compared with."""
    v, a = made.peaks
    rows = [f"{np.degrees(v[3]):8.1f} {np.degrees(a[3]):9.0f}"] + [f"{v[k]:7.1f} {a[k]:8.0f}" for k in (1, 2)]
    text = f"  {title:24} {'  '.join(rows)}  {taken:7.3f}"
    if against is not None:
        other = against[0].peaks
        text += f"   A {100 * (v[3] / other[0][3] - 1):+6.1f} % {100 * (a[3] / other[1][3] - 1):+6.1f} %  Y, Z " + \
            ", ".join(f"{100 * (a[k] / other[1][k] - 1):+.1f} %" for k in (1, 2)) + \
            f"  time {100 * (taken / against[1] - 1):+6.1f} %"
    print(text, flush=True)


def family(name: str) -> None:
    """The table of one family."""
    rows = layers(name)
    kinds = {curve: list(reschedule(rows, UP, curve=curve)) for curve in ("keys", "least")}
    any_ = kinds["keys"]
    middle = len(any_) // 2
    bound = any_[middle].bound
    print(f"{name}: {any_[middle].section.length:.1f} mm around, channel {np.degrees(any_[middle].wide.width):.1f} deg "
          f"wide, {sum(len(one.keys) > 0 for one in any_)} of {LAYERS} layers with key points")
    base = {kind: (motion(any_, kind), seconds(any_, kind)) for kind in ("unscheduled", "quaternions")}
    row("unscheduled", *base["unscheduled"], None)
    row("quaternions", *base["quaternions"], base["unscheduled"])
    for curve, found in kinds.items():
        made, taken = motion(found, "curve"), seconds(found, "curve")
        row(f"{curve}, against quaternions", made, taken, base["quaternions"])
        row(f"{curve}, against unscheduled", made, taken, base["unscheduled"])
        back = sum(int((np.diff(one.theta) < -1e-9).sum()) for one in found)
        seen = sum(hits(one, one.theta[:-1]) for one in found)
        peak = found[middle].peak
        print(f"    reversals {back}, points out of sight {seen} of {sum(len(one.theta) for one in found)}; peak "
              f"theta'' {peak:.3e} rad/mm^2, {peak / bound:.2f} times the bound {bound:.3e}")
    turned = [int((np.diff(angles(kind, any_[middle:middle + 1], FINE)[0]) < -1e-9).any())
              for kind in ("unscheduled", "quaternions")]
    print(f"    unscheduled turns back: {bool(turned[0])}, quaternions: {bool(turned[1])}")


def growth() -> None:
    """Time by the number of layers."""
    print("layers of 300 points, s of processor time:")
    reschedule(layers("steam", 3), UP, curve="least")
    for name in ("steam", "turbine"):
        for curve in ("keys", "least"):
            text = []
            for count in (25, 50, 100, 200):
                rows = layers(name, count)
                begun = time.process_time()
                reschedule(rows, UP, curve=curve)
                text.append(f"{count}: {time.process_time() - begun:.2f}")
            print(f"  {name:10} {curve:6} {', '.join(text)}", flush=True)


def exact() -> None:
    """The exact corner."""
    one, other = corner((0, 0), (10, 2), (18, 8), 0.5)[0]
    off = max(float(np.abs(point - known).max()) for point, known in zip((one[0], one[1], other[1], other[3]), EXACT,
                                                                         strict=True))
    print(f"exact corner: off by {off:.1e}")


def blisk() -> None:
    """A blade of the blisk of [zhu2016] Fig. 25, its four faces as one: alone on its hub, and between others."""
    part = join(load(EXAMPLE), (1, 163, 3, 161), corner=np.pi)
    tool = Tool.ball(6, stickout=110, holder=[(12.5, 0), (12.5, 60)])
    alone = {"skin": [part.face(n) for n in (4, 159, 160, 162)], "surroundings": [part.face(5)]}
    for title, around in (("alone on its hub", alone), ("between its neighbours", {"part": part})):
        begun = time.perf_counter()
        found, made = blade(task(part.face(1), tool, 0.1, direction="climb", tolerance=GOUGE, **around))
        taken = time.perf_counter() - begun
        print(f"blisk blade, {tool.name}, scallop 0.1 mm, {title}: {found.outcome}, {taken:.1f} s", flush=True)
        if made is not None:
            swing = swing_of_path(made, along_blade(part.face(1), "u"))
            angle = swing.angles(made.axis[made.kind == Motion.CUT])
            back = int((np.diff(angle) * np.sign(angle[-1] - angle[0]) < -1e-9).sum())
            print(f"  {found.passes} layers, {found.length:.0f} mm, gouge {found.gouge:.4f} mm, reversals {back}")
        print("  " + "; ".join(found.reasons))


def main() -> None:
    """All families."""
    exact()
    growth()
    print(f"\n{'':26} {'A deg/s':>8} {'deg/s^2':>9} {'Y mm/s':>8} {'mm/s^2':>8} {'Z mm/s':>8} {'mm/s^2':>8} "
          f"{'time s':>8}   at {SPEED:g} mm/s; times asked for {4 * SPEED:g} mm/s, {TIMED} layers")
    for name in FAMILIES:
        family(name)
    blisk()


def short() -> None:
    """The exact corner, growth and one family."""
    exact()
    growth()
    family("steam")
