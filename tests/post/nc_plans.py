"""Plans made up for posts: random planes that a machine can hold, and paths with every kind of motion on them."""

from math import degrees, pi, radians

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.machine.machine import Machine
from toolaxis.machine.work_coordinates import work_coordinates
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan, PlanInputs
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tools.tool import Tool

DATUM = np.array([3.0, -7.0, 11.0])
TOOL = Tool.torus(diameter=12, corner_radius=1, stickout=60, holder=[(10, 0), (10, 40), (25, 40), (25, 80)])
#: Kinds of the motions of a made-up path.
KINDS = (*[Motion.LINK] * 2, Motion.ENTRY, Motion.CUT, Motion.CUT, Motion.EXIT, *[Motion.LINK] * 4, Motion.ENTRY,
         Motion.CUT, Motion.EXIT, *[Motion.LINK] * 2, Motion.ENTRY, Motion.CUT, Motion.EXIT, Motion.LINK)


def each_once(machines: list[str], dialects: list[str]) -> list:
    """Pairs of both for parametrize: each machine and each dialect at least once, the other pairs with --long."""
    often = max(len(machines), len(dialects))
    first = {(machines[k % len(machines)], dialects[k % len(dialects)]) for k in range(often)}
    return [pytest.param(machine, dialect, marks=() if (machine, dialect) in first else pytest.mark.long)
            for machine in machines for dialect in dialects]


def spin(axis: np.ndarray, angle: float) -> np.ndarray:
    """Rodrigues' formula, written again so that no test leans on the library's own."""
    x, y, z = axis / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


def chain(machine: Machine, angles: dict[str, float], head: bool = True) -> np.ndarray:
    """Turns of the table and, if asked for, the head, for angles by name, degrees."""
    matrix = np.eye(3)
    for axis in machine.rotary if head else machine.table:
        matrix = matrix @ spin(axis.direction, radians(angles[axis.name]))
    return matrix


def held_angles(machine: Machine, rng: np.random.Generator, count: int, *, level: bool = True) -> np.ndarray:
    """Random rotary angles in the machine's steps, and the singular ones among them: zero, square, ends of ranges.

    With `level` no head points the spindle up.
    """
    columns = []
    for axis in machine.rotary:
        low, high = max(axis.low, -pi), min(axis.high, pi)
        if level and axis in machine.head and axis.name != "C" and not machine.nutating:
            low, high = max(low, -pi / 2), min(high, pi / 2)
        values = rng.uniform(low, high, count)
        special = [0.0, *(v for v in (pi / 2, -pi / 2, low, high) if low <= v <= high)]
        values[::4] = rng.choice(special, len(values[::4]))
        step = axis.increment or 1e-6
        ends = np.ceil(low / step - 1e-6) * step, np.floor(high / step + 1e-6) * step
        columns.append(np.clip(np.round(values / step) * step, *ends))
    return np.stack(columns, axis=1) if columns else np.zeros((count, 0))


def a_path(axis: np.ndarray, rng: np.random.Generator) -> ToolPath:
    """Two passes in three strokes, with links along the axis, across at the top, and on slants down and up."""
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    u = np.cross(axis, helper) / np.linalg.norm(np.cross(axis, helper))
    v, top = np.cross(axis, u), 80.0
    flat = rng.uniform(-60, 60, (len(KINDS), 2))
    high = rng.uniform(-20, 20, len(KINDS))
    for k, beside in ((1, 0), (6, 5), (7, 6), (13, 12), (17, 18)):
        flat[k] = flat[beside]
    for k, height in ((0, top), (1, 30.0), (6, 42.0), (7, top), (8, top), (9, 40.0), (13, 45.0), (14, top), (18, top)):
        high[k] = height
    cl = DATUM + flat[:, :1] * u + flat[:, 1:] * v + high[:, None] * axis
    axes = np.tile(axis, (len(KINDS), 1))
    return ToolPath(cl, cl, axes, axes, np.array(KINDS, dtype=np.int8), np.array([0, 14, len(KINDS)]))


def a_plan(axes: np.ndarray, rng: np.random.Generator, **inputs: float) -> Plan:
    """A plan with one operation for each axis."""
    x, y = np.meshgrid(np.linspace(0, 30, 4), np.linspace(0, 20, 4), indexing="ij")
    face = Face.from_bspline(np.stack([x, y, 0.02 * x * y], axis=2))
    operations = []
    for number, axis in enumerate(np.atleast_2d(axes), 1):
        path = a_path(axis, rng)
        frame = work_coordinates(axis, rng.normal(size=(5, 3)), DATUM, DATUM)
        operations.append(Operation(number, face, TOOL, Orientation(axis, outcome="optimal"), path, frame))
    asked = PlanInputs(0.02, **{"feedrate": 1234.5, "rapid": 8000.0, **inputs})
    return Plan(Part((face,)), (TOOL,), asked, tuple(operations), (), DATUM, "complete")


def axes_at(machine: Machine, angles: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Tool axes in the part's frame at rotary angles, rad, with the part turned on the table."""
    names = [axis.name for axis in machine.rotary]
    rows = [chain(machine, dict(zip(names, (degrees(v) for v in row), strict=True))) @ np.asarray(machine.spindle)
            for row in angles]
    return np.array(rows) @ turn
