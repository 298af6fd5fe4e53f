"""LinuxCNC's interpreter and its five-axis kinematics take our programs back to poses of the tool on the part."""

import re
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from benchmarks._others import EXAMPLES, SCALLOP, SHIFT, TURN, Array, Check
from benchmarks._others_linuxcnc import Kinematics, LinuxCnc, find_linuxcnc, interpret, joints_after_length

import toolaxis as ta
from toolaxis.machine.library import load_machine
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import Plan
from toolaxis.post.dialects.registry import dialect_named
from toolaxis.post.program import program_of, program_text
from toolaxis.post.setup_sheet import sheet_text
from toolaxis.tools.tool import Tool

#: Digits: coordinates of the program 5, of the interpreter's printout and the setup sheet 4; angles 5 and 4.
ALLOWED_MM, ALLOWED_DEG = 0.0005, 0.0005
#: Where the part's origin stands on the table, and the length of the tool, mm.
PLACE, LENGTH = (40.0, -25.0, 60.0), 120.0
TOOL = Tool.torus(diameter=12, corner_radius=2, stickout=45, holder=[(20, 0), (20, LENGTH - 45)])


class Trunnion(NamedTuple):
    """A machine with two rotary axes in the table, and LinuxCNC's module for its kind.

    machine : str, one of the machines that come with the program.
    module : str
    rotary : str, letters of the rotary axes in the order of the module's joints.
    parameters : dict, its dimensions, mm.
    """

    machine: str
    module: str
    rotary: str
    parameters: dict[str, float]


#: The tilting axis of the second one lies 50 mm above the table.
TRUNNIONS = (Trunnion("mikron-ucp-710", "xyzac-trt-kins", "AC", {}),
             Trunnion("bc-table-table", "xyzbc-trt-kins", "BC", {"z_offset": 50.0}))


class Posted(NamedTuple):
    """A plan and its program for LinuxCNC.

    plan : Plan
    text : str, the program.
    offsets : tuple of (3,) array, work offsets as the setup sheet tells them, mm.
    """

    plan: Plan
    text: str
    offsets: tuple[Array, ...]


def turned_around(machine: Machine) -> Machine:
    """A machine with its rotary axes counted as LinuxCNC's modules for tables do: growing angles turn the part
    right-handed, not the tool.  Bodies are left out.

    Parameters
    ----------
    machine : Machine
    """
    return replace(machine, table=tuple(replace(axis, direction=-axis.direction) for axis in machine.table), bodies=())


def post_example(trunnion: Trunnion, example: str = "dish", orientations: int = 2) -> Posted:
    """Plan an example for a machine, and write its program.

    Parameters
    ----------
    trunnion : Trunnion
    example : str
    orientations : int
        Sub-surfaces, each with an axis of its own.
    """
    mounting = Mounting(turned_around(load_machine(trunnion.machine)), table_from_part=PLACE, tool_length=LENGTH)
    plan = ta.plan(ta.load(EXAMPLES / f"{example}.step"), TOOL, SCALLOP, machine=mounting, orientations=orientations,
                   workers=1)
    dialect = dialect_named("linuxcnc")
    program = program_of(plan, mounting, dialect)
    sheet = sheet_text(program, dialect, "program.ngc")
    rows = re.findall(r"^\| \d+ \| G5\d[.\d]* .*\| ([^|]+) \|$", sheet, re.M)
    offsets = tuple(np.array([float(word) for word in row.split(",")]) for row in rows)
    return Posted(plan, program_text(program, dialect), offsets)


def farthest(linuxcnc: LinuxCnc, trunnion: Trunnion, posted: Posted, text: str = "") -> tuple[int, float, float]:
    """How many poses there are, and how far those of the control are from the plan's at most, mm and degrees.

    Parameters
    ----------
    linuxcnc : LinuxCnc
    trunnion : Trunnion
    posted : Posted
    text : str
        A program in place of the posted one.
    """
    kinematics = Kinematics(linuxcnc, trunnion.module, trunnion.rotary, tool_offset=LENGTH, **trunnion.parameters)
    with tempfile.TemporaryDirectory() as folder:
        canon = interpret(linuxcnc, text or posted.text, Path(folder), LENGTH, posted.offsets)
    stretches = joints_after_length(canon)
    assert len(stretches) == len(posted.plan.operations)
    count, away, turned = 0, 0.0, 0.0
    for joints, operation in zip(stretches, posted.plan.operations, strict=True):
        path = operation.path
        assert path is not None
        tips, axes = kinematics.poses(joints[:len(path.cl)])
        away = max(away, float(np.linalg.norm(tips - PLACE - path.cl, axis=1).max()))
        across = np.linalg.norm(np.cross(axes, path.axis), axis=1)
        turned = max(turned, float(np.degrees(np.arctan2(across, (axes * path.axis).sum(axis=1))).max()))
        count += len(path.cl)
    return count, away, turned


def deeper_pass(text: str, by: float = SHIFT) -> str:
    """The program with the second pass lowered.

    Parameters
    ----------
    text : str
    by : float
        mm
    """
    before, rest = text.split("(PASS 2)", 1)
    cut, after = rest.split("(PASS 3)", 1)
    lowered = re.sub(r"(?<=Z)-?[\d.]+", lambda word: f"{float(word[0]) - by:.5f}", cut)
    return f"{before}(PASS 2){lowered}(PASS 3){after}"


def wrong_angle(text: str, letter: str, by: float = TURN) -> str:
    """The program with the first angle of an axis wrong.

    Parameters
    ----------
    text : str
    letter : str
    by : float
        deg
    """
    return re.sub(rf"(?<= {letter})-?[\d.]+", lambda word: f"{float(word[0]) + by:.5f}", text, count=1)


def compare_control(trunnions: tuple[Trunnion, ...] = TRUNNIONS, example: str = "freeform",
                    fetch: bool = True) -> Check:
    """The row of the table.

    Parameters
    ----------
    trunnions : tuple of Trunnion
    example : str
    fetch : bool
        Whether LinuxCNC is fetched where it is not.
    """
    linuxcnc = find_linuxcnc(fetch)
    count, away, turned, seen = 0, 0.0, 0.0, dict[str, list[bool]]()
    for trunnion in trunnions:
        posted = post_example(trunnion, example)
        poses, far, angle = farthest(linuxcnc, trunnion, posted)
        count, away, turned = count + poses, max(away, far), max(turned, angle)
        spoilt = {"pass 0.1 mm deeper": deeper_pass(posted.text),
                  "tilting axis wrong by 0.2 deg": wrong_angle(posted.text, trunnion.rotary[0]),
                  "C wrong by 0.2 deg": wrong_angle(posted.text, "C")}
        for name, text in spoilt.items():
            _, far, angle = farthest(linuxcnc, trunnion, posted, text)
            seen.setdefault(name, []).append(far > ALLOWED_MM or angle > ALLOWED_DEG)
    names = " and ".join(trunnion.module for trunnion in trunnions)
    return Check("LinuxCNC: rs274, " + names, "programs: tips and axes on the part", f"{count} poses",
                 f"{away:.5f} mm, {turned:.5f} deg", away <= ALLOWED_MM and turned <= ALLOWED_DEG,
                 f"{ALLOWED_MM} mm, {ALLOWED_DEG} deg", {name: all(found) for name, found in seen.items()})
