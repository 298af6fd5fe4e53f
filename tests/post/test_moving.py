"""Programs with a moving axis: read back as a control with tool centre point control would, they are the plan."""

import re
from dataclasses import dataclass, field, replace
from math import radians

import numpy as np
import pytest
from nc_plans import DATUM, a_plan, chain, each_once
from nc_readers import WORD
from scipy.spatial.transform import Rotation

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.job.output.post import post_plan
from toolaxis.machine.library import load_machine
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import Plan

DIGITS = {"fanuc": (3, 3), "siemens": (5, 7), "heidenhain": (4, 4)}
VECTOR = re.compile(r"([ABC])3=(-?\d+\.\d+)")


@dataclass
class Read:
    """What a control does: tips, axes on the table, feed rates."""

    machine: Machine
    spindle: bool = False
    retracted: bool = False
    control: bool = False
    ended: bool = False
    rate: float = np.nan
    angles: dict[str, float] = field(default_factory=dict)
    axis: np.ndarray | None = None
    tips: list[list[float]] = field(default_factory=list)
    axes: list[np.ndarray] = field(default_factory=list)
    rates: list[float] = field(default_factory=list)
    turned: list[list[dict[str, float]]] = field(default_factory=list)

    def index(self, block: str) -> None:
        assert self.retracted and not self.control and not re.search(r"[XYZ][-+\d]", block), block
        self.angles = {name: float(value) for name, value in re.findall(r"([ABC])=?(?:DC\()?([-+]?\d+\.?\d*)", block)}
        self.axis = chain(self.machine, self.angles) @ np.asarray(self.machine.spindle)
        self.turned.append([self.angles])

    def motion(self, block: str) -> None:
        assert self.control and self.spindle and not self.ended, block
        vector = dict(VECTOR.findall(block))
        words = {name: float(value) for name, value in WORD.findall(VECTOR.sub("", block).replace("FMAX", ""))}
        assert set("XYZ") <= set(words) and words.get("G", 1) == 1
        if vector:
            self.axis = np.array([float(vector[name]) for name in "ABC"])
        else:
            self.angles = {name: words[name] for name in "ABC" if name in words}
            self.turned[-1].append(self.angles)
            self.axis = chain(self.machine, self.angles) @ np.asarray(self.machine.spindle)
        self.rate = words.get("F", self.rate)
        self.retracted = False
        self.tips.append([words[name] for name in "XYZ"])
        self.axes.append(self.axis)
        self.rates.append(self.rate)


#: Blocks by what they do: retract, control of the tip on and off, spindle on and off, end.
SAYS = {"fanuc": ("G91 G28 Z0.", "G43.4 H1", "G49", r".* M3", "M5", "M30"),
        "siemens": (r"SUPA G0 Z.* D0", "TRAORI", "TRAFOOF", r".* M3", "M5", "M30"),
        "heidenhain": ("L M140 MB MAX", "L M128", "L M129", "L M3", "L M5", "L M30")}


def read(text: str, dialect: str, machine: Machine) -> Read:
    found = Read(machine)
    retract, on, off, start, stop, end = SAYS[dialect]
    for line in text.splitlines():
        block = re.sub(r"\(.*?\)$|;.*", "", line).strip() if "DC(" not in line else line
        block = block.partition(" ")[2] if dialect == "heidenhain" else block
        if re.fullmatch(retract, block):
            assert not found.control
            found.retracted = True
        elif block == on:
            assert found.angles and found.retracted
            found.control = True
        elif block == off:
            found.control = False
        elif re.fullmatch(start, block):
            found.spindle = True
        elif block == stop:
            found.spindle = False
        elif block == end:
            assert found.retracted and not found.control and not found.spindle
            found.ended = True
        elif re.match(r"(G1|L) [XYZ]", block):
            found.motion(block)
        elif re.match(r"(G0|L) [ABC]", block):
            found.index(block)
    assert found.ended
    return found


def _path(turn: np.ndarray, beside_deg: float, points: int = 60) -> ToolPath:
    """Two passes with ramps and links, whose axis swings beside Z of the table."""
    s, y = np.linspace(0, 1, points), np.tan(radians(beside_deg))
    cut = np.column_stack([40 * s, 3 * np.sin(5 * s), 4 * np.cos(7 * s)])
    lean = np.radians(25) * np.cos(np.pi * s)
    axes = np.column_stack([np.tan(lean), np.full(points, y), np.ones(points)])
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    tips, axis, kind = [], [], []
    for k in range(2):
        rows, own = cut[:: 1 - 2 * k] + np.array([0.0, 3.0 * k, 0.0]), axes[:: 1 - 2 * k]
        tips += [rows[:1] + 25 * own[:1], rows[:1] + 2 * own[:1], rows, rows[-1:] + 25 * own[-1:]]
        axis += [own[:1], own[:1], own, own[-1:]]
        kind += [3, 3, 1] + [0] * (points - 1) + [3]
    cl, whole = np.concatenate(tips) @ turn + DATUM, np.concatenate(axis) @ turn
    return ToolPath(cl, cl, whole, whole, np.array(kind, dtype=np.int8), np.array([0, len(cl) // 2, len(cl)]))


def _plan(turn: np.ndarray, beside_deg: float) -> Plan:
    plan = a_plan(np.array([0.0, 0.0, 1.0]), np.random.default_rng(0))
    op = plan.operations[0]
    moved = replace(op, path=_path(turn, beside_deg), orientation=replace(op.orientation, lead=0.1))
    return replace(plan, operations=(moved, replace(moved, number=2)))


def _judge(plan: Plan, found: Read, turn: np.ndarray, dialect: str) -> None:
    digits, axis_digits = DIGITS[dialect]
    half = 0.5 * 10.0**-digits
    lost = 1.2 * 10.0**-axis_digits if dialect == "siemens" else 1.2 * radians(10.0**-axis_digits)
    tips, axes, rates = np.array(found.tips), np.array(found.axes), found.rates
    j = -1
    for op in plan.operations:
        path = op.path
        wanted, wanted_axes = (path.cl - DATUM) @ turn.T, path.axis @ turn.T
        for k in range(len(wanted)):
            between = []
            while True:
                j += 1
                if np.abs(tips[j] - wanted[k]).max() <= half + 1e-9 and np.abs(axes[j] - wanted_axes[k]).max() <= lost:
                    break
                between.append(j)
            way = wanted[k] - wanted[k - 1]
            for i in between:
                share = ((tips[i] - wanted[k - 1]) @ way) / (way @ way)
                assert 0 < share < 1 and np.abs(tips[i] - wanted[k - 1] - share * way).max() <= 2 * half
                axis = (1 - share) * wanted_axes[k - 1] + share * wanted_axes[k]
                assert np.linalg.norm(axes[i] - axis / np.linalg.norm(axis)) <= lost + 2e-4
            rate = plan.inputs.rapid if path.kind[k] == Motion.LINK else plan.inputs.feedrate
            assert rates[j] == pytest.approx(rate, abs=0.06)
    assert j == len(tips) - 1


@pytest.mark.parametrize(("name", "dialect"), each_once(
    ["mikron-ucp-710", "dmg-dmu-60t", "bc-table-table", "head-head-portal"], list(DIGITS)))
def test_the_program_is_the_plan(name: str, dialect: str) -> None:
    machine, where = load_machine(name), np.eye(4)
    where[:3, :3] = Rotation.from_euler("z", 37, degrees=True).as_matrix()
    for beside_deg in (9.0, 0.4):
        plan = _plan(where[:3, :3], beside_deg)
        files = post_plan(plan, dialect, Mounting(machine, where))
        text = next(text for file, text in files.items() if file.startswith("program"))
        found = read(text, dialect, machine)
        _judge(plan, found, where[:3, :3], dialect)
        for rows in found.turned:
            for axis in machine.rotary:
                angles = np.unwrap([radians(row[axis.name]) for row in rows])
                assert np.abs(np.diff(angles)).max(initial=0.0) < radians(60)


def test_singular_directions_get_points_between_only_where_rotary_axes_are_written() -> None:
    plan, mounting = _plan(np.eye(3), 0.4), Mounting(load_machine("mikron-ucp-710"))
    fanuc = post_plan(plan, "fanuc", mounting)["program-fanuc.nc"].count("G1 ")
    assert fanuc > 2 * len(plan.operations[0].path.cl) + 20


@pytest.mark.parametrize(("dialect", "machine", "said"), [
    ("haas-g268", "mikron-ucp-710", "dialect haas-g268 has no tool centre point control here"),
    ("linuxcnc", "mikron-ucp-710", "use fanuc, heidenhain, siemens or apt"),
    ("iso", "bc-table-table", "use fanuc, heidenhain, siemens or apt"),
    ("fanuc", "three-axes-fixture", "drives 0 rotary axes: Fanuc G43.4 needs two")])
def test_what_a_dialect_cannot_move_is_refused(dialect: str, machine: str, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        post_plan(_plan(np.eye(3), 9.0), dialect, Mounting(load_machine(machine)))


def test_the_sheet_tells_ranges_and_what_to_mind() -> None:
    files = post_plan(_plan(np.eye(3), 9.0), "heidenhain", Mounting(load_machine("mikron-ucp-710")))
    sheet = files["setup-heidenhain.md"]
    assert "Heidenhain M128" in sheet and re.search(r"C -?[\d.]+ to -?[\d.]+; A -?[\d.]+ to", sheet)
    assert "Whether that is free of fixtures is not checked" in sheet
