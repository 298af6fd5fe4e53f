"""From stations to the text of one program: safe start; for each station index, approach, path, retract; the end.

What all controls have in common stands here; what each says differently stands in `toolaxis.post.dialects`.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import replace
from math import cos, degrees, isfinite, radians
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import angle_between
from toolaxis.plan.plan import Plan, PlanInputs
from toolaxis.post.context import Options, Program, ProgramContext
from toolaxis.post.indexed_positions import IndexedPosition, axes_on_turned_table, in_plane, stations
from toolaxis.post.plane_angles import matrix_from_turns, turns_from_matrix
from toolaxis.shape.work_origin import describe_origin

Array = NDArray[np.float64]
Lines = list[str]

_AXES = ("X", "Y", "Z")
#: Cosine of the spindle's tilt at which a retract along Z still leads away from the work: a level spindle.
_LEVEL = -1e-9


class Dialect(ABC):
    """What one control calls the things that every program says.

    Attributes
    ----------
    name, title, suffix : str
        Name for the command, name for people, ending of the file.
    digits, angle_digits : int
        Digits after the point of coordinates, mm, and of angles, degrees.
    turns : str
        Order of the turns that tell a tilted plane, of `turns.ORDERS`; empty where the control is told none and
        coordinates are those of the machine's axes at the indexed angles.
    offsets : tuple of str
        Words of the work offsets; one serves all orientations where the control turns them along.
    least_rotary : int
        Rotary axes that the machine must have.
    by_hand : bool
        Whether rotary axes may be ones that are set by hand, at a stop of the program.
    kinds : tuple of str
        Kinds of machine, as `Machine.kind` says them, that the dialect serves.
    straight : bool
        Whether rapid motion is along a straight line also where several axes move.
    rolls_over : bool
        Whether rotary axes without end are told angles from 0 to below 360 degrees.
    told_retract : bool
        Whether the program says to which machine coordinate Z retracts.
    along_axis : bool
        Whether it retracts along the tool axis rather than along Z.
    hold, release : tuple of str
        Words that clamp and unclamp the rotary axes, where the control's maker sets them.
    notes : tuple of str
        Sentences for the setup sheet.
    """

    name: ClassVar[str]
    title: ClassVar[str]
    suffix: ClassVar[str] = ".nc"
    digits: ClassVar[int] = 3
    angle_digits: ClassVar[int] = 3
    turns: ClassVar[str] = ""
    offsets: ClassVar[tuple[str, ...]] = ("G54",)
    least_rotary: ClassVar[int] = 1
    by_hand: ClassVar[bool] = False
    kinds: ClassVar[tuple[str, ...]] = ("table", "head", "table-table", "head-table", "head-head")
    straight: ClassVar[bool] = False
    rolls_over: ClassVar[bool] = True
    told_retract: ClassVar[bool] = False
    along_axis: ClassVar[bool] = False
    hold: ClassVar[tuple[str, ...]] = ()
    release: ClassVar[tuple[str, ...]] = ()
    notes: ClassVar[tuple[str, ...]] = ()

    @abstractmethod
    def start(self, program: ProgramContext) -> Lines:
        """Blocks of the safe start: modes, plane off, retract, tool, spindle."""

    @abstractmethod
    def call_tool(self, program: ProgramContext) -> Lines:
        """Blocks that bring the program's tool into the retracted spindle and turn it on."""

    def change_tool(self, program: ProgramContext) -> Lines:
        """The same behind a station: they retract first where leaving a station does not."""
        return self.call_tool(program)

    @abstractmethod
    def orient(self, program: Program, station: IndexedPosition) -> Lines:
        """Blocks from a retracted tool to the plane of a station."""

    @abstractmethod
    def leave(self, program: Program, station: IndexedPosition) -> Lines:
        """Blocks that cancel the plane and retract."""

    @abstractmethod
    def end(self, program: ProgramContext) -> Lines:
        """Blocks of the end."""

    def sheet_notes(self, program: ProgramContext) -> list[str]:
        """What the operator must mind with this dialect on the program's machine."""
        return list(self.notes)

    def comment(self, text: str) -> str:
        """A block that is a comment."""
        return f"({_plain(text)})"

    def approach(self, program: Program, station: IndexedPosition) -> Lines:
        """Blocks to the first tip: across, then down; in one straight block where the spindle is tilted."""
        point, length = station.tips[0], self.tool_length(program)
        if not station.tilt:
            first, down = self.point(point).rsplit(" ", 1)
            return [f"G0 {first}", " ".join(filter(None, ["G0", length, down]))]
        code, words = self.straight_rapid(program, point).split(" ", 1)
        return [" ".join(filter(None, [code, length, words]))]

    def tool_length(self, program: ProgramContext) -> str:
        """The word that turns tool length compensation on in the approach."""
        return f"G43 H{program.tool_number}"

    def straight_rapid(self, program: ProgramContext, point: Array) -> str:
        """A rapid motion along a straight line, at rapid rate by G1 where G0 may bend it."""
        if self.straight:
            return f"G0 {self.point(point)}"
        return f"G1 {self.point(point)} F{program.inputs.rapid:.0f}."

    def rapid(self, program: Program, station: IndexedPosition, point: Array) -> str:
        """A rapid motion in the plane."""
        return self.straight_rapid(program, point) if station.tilt else f"G0 {self.point(point)}"

    def feed(self, point: Array, rate: float | None) -> str:
        """A motion at feed rate, mm/min; None where the rate still holds."""
        return f"G1 {self.point(point)}" + ("" if rate is None else f" F{number(rate, 1)}")

    def point(self, point: Array) -> str:
        """The coordinates of a tip."""
        return " ".join(f"{name}{number(value, self.digits)}" for name, value in zip(_AXES, point, strict=True))

    def rotary(self, program: Program, station: IndexedPosition) -> str:
        """The rotary words of a station."""
        return " ".join(self.words(program.machine, station.angles))

    def words(self, machine: Machine, angles: Array) -> Lines:
        """Rotary angles, rad, as words; from 0 to below 360 degrees for axes without end that roll over."""
        made = []
        for axis, angle in zip(machine.rotary, angles, strict=True):
            value = round(degrees(angle), self.angle_digits)
            endless = not (isfinite(axis.low) or isfinite(axis.high))
            turned = round(value % 360.0, self.angle_digits) % 360.0 if endless and self.rolls_over else value
            made.append(f"{axis.name}{number(turned, self.angle_digits)}")
        return made

    def index(self, program: Program, station: IndexedPosition) -> Lines:
        """Blocks that turn the rotary axes, let go before and held after."""
        if not len(station.angles):
            return []
        return [*program.unclamp, f"G0 {self.rotary(program, station)}", *program.clamp]

    def euler(self, station: IndexedPosition) -> tuple[str, str, str]:
        """The plane's three angles as they are written."""
        a, b, c = (number(value, self.angle_digits) for value in station.written)
        return a, b, c

    def framed(self, lines: Lines) -> Lines:
        """All blocks with what the control wants around them."""
        return lines

    def placed(self, station: IndexedPosition, mounting: Mounting, datum: Array) -> IndexedPosition:
        """The station in the plane that this dialect's own words give, so that rounding them moves no tip.

        Parameters
        ----------
        station : IndexedPosition
        mounting : Mounting
        datum : (3,) array
            mm, part's frame.
        """
        if not self.turns:
            return in_plane(station, mounting, axes_on_turned_table(mounting.machine, station.angles), datum)
        angles = np.round(np.degrees(turns_from_matrix(self.turns, station.matrix)), self.angle_digits) + 0.0
        made = in_plane(station, mounting, matrix_from_turns(self.turns, np.radians(angles).tolist()), datum)
        return replace(made, written=tuple(angles.tolist()))

    def check(self, program: Program) -> None:
        """Refuse what this dialect cannot express, in one sentence.

        Raises
        ------
        InvalidInput
        """
        machine, kinds = program.machine, self.kinds
        if len(machine.rotary) < self.least_rotary:
            raise InvalidInput(f"{self.title} needs {self.least_rotary} rotary axes and {machine.name} has "
                               f"{len(machine.rotary)}: use --dialect linuxcnc or iso, with a work offset for each "
                               "orientation")
        if machine.kind not in kinds and machine.rotary:
            raise InvalidInput(f"{self.title} serves machines of the kind {' or '.join(kinds)} and {machine.name} is "
                               f"{machine.kind}: use another --dialect")
        if not self.by_hand and any(axis.by_hand for axis in machine.rotary):
            raise InvalidInput(f"{self.title} turns rotary axes itself and those of {machine.name} are set by hand: "
                               "use --dialect linuxcnc or iso")
        used = 1 + max(station.orientation for station in program.stations)
        if len(self.offsets) > 1 and used > len(self.offsets):
            raise InvalidInput(f"{used} orientations need as many work offsets and {self.title} has "
                               f"{len(self.offsets)}: plan with --orientations {len(self.offsets)}, or post in parts")
        if self.told_retract and program.retract is None:
            raise InvalidInput(f"Z of {machine.name} has no upper limit to retract to: give --retract, the machine "
                               "coordinate at which the rotary axes may turn")
        for station in program.stations:
            if cos(station.tilt) < _LEVEL and not self.along_axis:
                raise InvalidInput(f"{station.operation.name}: the spindle points up by "
                                   f"{degrees(station.tilt) - 90:.1f} deg: a retract along Z would lead into the work")


def number(value: float, digits: int) -> str:
    """A number with fixed digits after the point, never minus zero.

    Parameters
    ----------
    value : float
    digits : int
    """
    return f"{round(float(value), digits) + 0.0:.{digits}f}"


def _plain(text: str) -> str:
    """Text that may stand in a comment of any control."""
    return "".join(c if c.isascii() and c.isprintable() and c not in "();%~\"" else "_" for c in text)[:100]


def program_of(plan: Plan, mounting: Mounting, dialect: Dialect, options: Options | None = None,
               name: str = "toolaxis") -> Program:
    """A plan with its stations in the planes that a dialect writes.

    Parameters
    ----------
    plan : Plan
    mounting : Mounting
    dialect : Dialect
    options : Options, optional
    name : str
        Of the program.

    Raises
    ------
    InvalidInput
        When the machine's axes are not X, Y, Z with the spindle along Z, an axis cannot be held, or the dialect cannot
        express it.
    """
    empty = bare_program(plan, mounting, dialect, options, name)
    found = stations(plan, mounting, dialect.angle_digits, {} if options is None else options.angles)
    made = replace(empty, stations=tuple(dialect.placed(station, mounting, plan.datum) for station in found))
    dialect.check(made)
    return made


def bare_program(plan: Plan, mounting: Mounting, dialect: Dialect, options: Options | None = None,
                 name: str = "toolaxis") -> Program:
    """What a program says besides its stations.

    Parameters
    ----------
    plan, mounting, dialect, options, name
        As for `program_of`.

    Raises
    ------
    InvalidInput
        When the machine's axes are not X, Y, Z with the spindle along Z.
    """
    return Program(plan=plan, tool_number=plan.tools[0].number or 1,
                   **_setting(plan.inputs, mounting, dialect, options, name))


def setting_of(inputs: PlanInputs, mounting: Mounting, dialect: Dialect, options: Options | None = None,
               name: str = "toolaxis") -> ProgramContext:
    """What a program says besides its motions, without a plan.

    Parameters
    ----------
    inputs : PlanInputs
    mounting, dialect, options, name
        As for `program_of`.

    Raises
    ------
    InvalidInput
        When the machine's axes are not X, Y, Z with the spindle along Z.
    """
    return ProgramContext(**_setting(inputs, mounting, dialect, options, name))


def _setting(inputs: PlanInputs, mounting: Mounting, dialect: Dialect, options: Options | None,
             name: str) -> dict[str, Any]:
    _check_frame(mounting.machine)
    chosen = Options() if options is None else options
    top = mounting.machine.linear[2].high
    retract = chosen.retract if chosen.retract is not None else (top if isfinite(top) else None)
    return {"mounting": mounting, "inputs": inputs, "name": _plain(name).replace(" ", "_") or "toolaxis",
            "retract": retract, "clamp": chosen.clamp or dialect.hold, "unclamp": chosen.unclamp or dialect.release}


def _check_frame(machine: Machine) -> None:
    names = tuple(axis.name for axis in machine.linear)
    if names != _AXES or np.abs(machine.directions - np.eye(3)).max() > 1e-9:
        raise InvalidInput(f"linear axes of {machine.name} are {', '.join(names)}: programs are written for X, Y, Z at "
                           "right angles, in this order")
    away = float(angle_between(np.asarray(machine.spindle), np.array([0.0, 0.0, 1.0])))
    if away > radians(1e-6):
        raise InvalidInput(f"spindle of {machine.name} is {degrees(away):.1f} deg from Z with all axes at zero: "
                           "programs are written for a spindle along Z")


def program_text(program: Program, dialect: Dialect) -> str:
    """The text of a program.

    Parameters
    ----------
    program : Program
        From `program_of` with the same dialect.
    dialect : Dialect

    Returns
    -------
    str
        ASCII, a line for each block.
    """
    lines, tool = list[str](), None
    where = origin_comments(program, dialect)
    for station in program.stations:
        own = program.with_tool(station.operation.tool)
        if station.operation.tool != tool:
            lines += [*dialect.start(own), *where] if tool is None else dialect.change_tool(own)
            tool = station.operation.tool
        lines += [dialect.comment(station.operation.name.upper())]
        lines += dialect.orient(own, station)
        lines += [*dialect.approach(own, station), *_path(own, station, dialect)]
        lines += dialect.leave(own, station)
    return "\n".join([*dialect.framed([*lines, *dialect.end(program)]), ""])


def origin_comments(program: ProgramContext, dialect: Dialect) -> Lines:
    """The block that says where the work coordinate system has its origin; none where the plan only gives a datum.

    Parameters
    ----------
    program : ProgramContext
    dialect : Dialect
    """
    words = describe_origin(program.inputs.origin)
    return [dialect.comment(f"ORIGIN: {words}".upper())] if words else []


def _path(program: Program, station: IndexedPosition, dialect: Dialect) -> Iterator[str]:
    """Blocks from the second tip on, with a feed rate where it does not hold any more.

    Links that are not rapid go straight at the rapid rate: what they keep clear of was checked along the line.
    """
    held: float | None = None
    inputs, path = program.inputs, station.operation.path
    assert path is not None
    starts, passes = set(path.breaks[1:-1].tolist()), 1
    for k, tip in enumerate(station.tips[1:], 1):
        if k in starts:
            passes += 1
            yield dialect.comment(f"PASS {passes}")
        if station.rapid[k]:
            block = dialect.rapid(program, station, tip)
            held = None if "F" in block else held
            yield block
            continue
        rate = inputs.rapid if path.kind[k] == Motion.LINK else inputs.feedrate
        yield dialect.feed(tip, None if rate == held else rate)
        held = rate
