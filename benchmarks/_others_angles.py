"""Tilted planes of our programs, calculated again by scipy's Rotation from what the makers of the controls publish.

No post of FreeCAD 1.0 or 1.1 writes a tilted plane, so there is none to compare with; scipy's Euler angles stand in
for the controls.  G68.2 I J K turns about Z, the new X and the new Z (Fanuc); G268 I J K Q321 is read as Z, then Y,
then X about fixed axes (Haas; the page that says so could not be read again, and the setup sheet asks for a trial);
PLANE SPATIAL turns A, B, C about fixed axes (Heidenhain); CYCLE800 axis by axis turns about X, the new Y and the new Z
(Siemens).
"""

import re
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from benchmarks._others import SHIFT, TURN, Array, Check
from scipy.spatial.transform import Rotation

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.machine.library import load_machine
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.machine.work_coordinates import work_coordinates
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan, PlanInputs
from toolaxis.post.dialects.registry import dialect_named
from toolaxis.post.program import program_of, program_text
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tools.tool import Tool

DATUM = np.array([3.0, -7.0, 11.0])
MACHINES = ("mikron-ucp-710", "bc-table-table", "head-head-portal")
#: What half of the last digits comes to on the way from the datum to points 100 mm away, mm, and of the axis, deg.
ALLOWED_MM, ALLOWED_DEG = 0.003, 0.0012
_KINDS = (Motion.LINK, Motion.ENTRY, Motion.CUT, Motion.CUT, Motion.EXIT, Motion.LINK)
_PLANE = Face.from_bspline(np.array([[[x, y, 0.0] for y in (0.0, 10, 20, 30)] for x in (0.0, 10, 20, 30)]))
_TOOL = Tool.torus(diameter=12, corner_radius=1)


class Control(NamedTuple):
    """How a control takes planes.

    dialect : str
    plane : str, pattern of the block that defines a plane; its groups are three angles, deg.
    turns : str, scipy's letters for the turns: capital ones about turned axes, small ones about fixed axes.
    order : tuple of int, which of the groups the turns take.
    """

    dialect: str
    plane: str
    turns: str
    order: tuple[int, int, int] = (0, 1, 2)


_NUMBER = r"([-+]?[\d.]+)"
CONTROLS = (Control("fanuc", rf"G68\.2 .*I{_NUMBER} J{_NUMBER} K{_NUMBER}", "ZXZ"),
            Control("haas-g268", rf"G268 .*I{_NUMBER} J{_NUMBER} K{_NUMBER} Q321", "zyx", (2, 1, 0)),
            Control("heidenhain", rf"PLANE SPATIAL SPA{_NUMBER} SPB{_NUMBER} SPC{_NUMBER}", "xyz"),
            Control("siemens", rf"CYCLE800\((?:[^,\n]*,){{7}}\s*{_NUMBER},\s*{_NUMBER},\s*{_NUMBER}", "XYZ"))


class Planes(NamedTuple):
    """How far planes as a control takes them are from the plan's: count, mm, deg."""

    count: int
    away: float
    turned: float


def axes_held(machine: Machine, count: int, rng: np.random.Generator) -> Array:
    """Tool axes that a machine holds, singular ones among them, (count, 3), all axes of the part being the machine's.

    Every sixth lies along Z or within 0.01 degrees of it, every sixth square to it; the others are anywhere in reach.

    Parameters
    ----------
    machine : Machine
    count : int
    rng : numpy.random.Generator
    """
    mounting, rows = Mounting(machine), list[Array]()
    while len(rows) < count:
        upright = 1.0 - rng.choice([0.0, 1e-12, 1e-9, 1e-8])
        z = (upright, 0.0)[len(rows) % 2] if len(rows) % 3 == 0 else rng.uniform(0, 1)
        turn = rng.choice([0.0, 0.5, 1.0, 1.5]) * np.pi if len(rows) % 4 == 0 else rng.uniform(0, 2 * np.pi)
        flat = np.sqrt(1 - z * z)
        axis = np.array([flat * np.cos(turn), flat * np.sin(turn), z])
        found = mounting.solutions(axis)
        if len(found):
            rows.append(mounting.axis_at(found[0]))
        elif z == 0.0:  # out of reach; one that leans less stands in for it
            leaning = mounting.solutions(np.array([0.6 * np.cos(turn), 0.6 * np.sin(turn), 0.8]))
            rows += [mounting.axis_at(leaning[0])] if len(leaning) else []
    return np.array(rows)


def short_plan(axes: Array, rng: np.random.Generator) -> Plan:
    """A plan with an operation of six points for each axis.

    Parameters
    ----------
    axes : (n, 3) array
    rng : numpy.random.Generator
    """
    operations = []
    for number, axis in enumerate(axes, 1):
        flat = rng.uniform(-60, 60, (len(_KINDS), 3))
        heights = np.array([80.0, *rng.uniform(-20, 20, 4), 80.0])
        flat[0], flat[-1] = flat[1], flat[-2]
        places = DATUM + flat - (flat @ axis)[:, None] * axis + heights[:, None] * axis
        rows = np.tile(axis, (len(_KINDS), 1))
        path = ToolPath(places, places, rows, rows, np.array(_KINDS, dtype=np.int8), np.array([0, len(_KINDS)]))
        frame = work_coordinates(axis, rng.normal(size=(5, 3)), DATUM, DATUM)
        operations.append(Operation(number, _PLANE, _TOOL, Orientation(axis, outcome="optimal"), path, frame))
    return Plan(Part((_PLANE,)), (_TOOL,), PlanInputs(0.02), tuple(operations), (), DATUM, "complete")


def stretches(control: Control, text: str) -> Iterator[tuple[Array, Array]]:
    """What a program does plane by plane: the three angles, deg, and the points in the plane, (n, 3) mm.

    Parameters
    ----------
    control : Control
    text : str
    """
    pieces = re.split(control.plane, text)
    for k in range(1, len(pieces), 4):
        at, points = dict[str, float](), list[list[float]]()
        for line in pieces[k + 3].splitlines()[1:]:
            words = dict(re.findall(rf"(?:(?<= )|^)([XYZ]){_NUMBER}", line.split("(")[0]))
            if "G28" in line or "G53 " in line or re.search(r"M140|CYCLE800|SUPA|PLANE", line):
                break
            at.update({name: float(value) for name, value in words.items()})
            if words and len(at) == 3:
                points.append([at["X"], at["Y"], at["Z"]])
        if points:  # at the end the plane is only turned back
            yield np.array([float(piece) for piece in pieces[k:k + 3]]), np.array(points)


def compare_planes(control: Control, plan: Plan, text: str) -> Planes:
    """Hold the planes of a program against the plan.

    Parameters
    ----------
    control : Control
    plan : Plan
    text : str
    """
    away, turned, count = 0.0, 0.0, 0
    for operation, (angles, points) in zip(plan.operations, stretches(control, text), strict=True):
        path = operation.path
        assert path is not None
        plane = Rotation.from_euler(control.turns, angles[list(control.order)], degrees=True).as_matrix()
        wanted = (path.cl - DATUM) @ plane
        cut = points[-len(wanted):]
        away = max(away, float(np.linalg.norm(cut - wanted, axis=1).max()))
        across = np.linalg.norm(np.cross(plane[:, 2], path.axis[0]))
        turned = max(turned, float(np.degrees(np.arctan2(across, plane[:, 2] @ path.axis[0]))))
        count += 1
    return Planes(count, away, turned)


def spoilt(control: Control, text: str) -> dict[str, str]:
    """The program with each of the planted faults in one of its planes.

    Parameters
    ----------
    control : Control
    text : str
    """
    place = [*re.finditer(control.plane, text)][len(re.findall(control.plane, text)) // 2]
    made = {}
    for group, name in ((1, "first angle wrong by 0.2 deg"), (2, "second angle wrong by 0.2 deg")):
        value = float(place[group]) + TURN
        made[name] = text[:place.start(group)] + f"{value:+.4f}" + text[place.end(group):]
    rest = text[place.end():]
    cut = [*re.finditer(r"(?<=Z)[-+]?[\d.]+", rest)][3]
    made["point 0.1 mm deeper"] = text[:place.end()] + rest[:cut.start()] + f"{float(cut[0]) - SHIFT:+.4f}" + \
        rest[cut.end():]
    return made


def compare_angles(count: int = 300) -> Check:
    """The row of the table.

    Parameters
    ----------
    count : int
        Orientations of each control on each machine.
    """
    rng = np.random.default_rng(5)
    found, seen = list[Planes](), dict[str, list[bool]]()
    for name in MACHINES:
        machine = load_machine(name)
        plan = short_plan(axes_held(machine, count, rng), rng)
        for control in CONTROLS:
            dialect = dialect_named(control.dialect)
            text = program_text(program_of(plan, Mounting(machine), dialect), dialect)
            found.append(compare_planes(control, plan, text))
            for fault, wrong in spoilt(control, text).items():
                planes = compare_planes(control, plan, wrong)
                seen.setdefault(fault, []).append(planes.away > ALLOWED_MM or planes.turned > ALLOWED_DEG)
    away, turned = max(one.away for one in found), max(one.turned for one in found)
    names = ", ".join(control.dialect for control in CONTROLS)
    return Check("scipy Rotation", f"tilted planes: {names}", f"{sum(one.count for one in found)} orientations",
                 f"{away:.5f} mm, {turned:.5f} deg", away <= ALLOWED_MM and turned <= ALLOWED_DEG,
                 f"{ALLOWED_MM} mm, {ALLOWED_DEG} deg", {fault: all(rows) for fault, rows in seen.items()})
