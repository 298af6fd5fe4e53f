"""Programs for operations whose axis moves: tool centre point control, in the dialects that have it.

Points are those of the tip in the work coordinate system, which turns with the table; the control moves the linear axes
so that the tip is there while the rotary axes turn.  All motions are G1: links go at the rapid rate.
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from math import degrees
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.feed.continuous_ik import AxisTrajectory, following
from toolaxis.machine.kinematics import placement
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import Plan
from toolaxis.post.context import Options, ProgramContext
from toolaxis.post.program import Dialect, Lines, number, origin_comments, setting_of

Array = NDArray[np.float64]

#: What every setup sheet says of the way to the work.
FIRST_MOTION = ("The first motion of each operation leads straight from the retracted place to its first point, with "
                "the axis turned before. Whether that is free of fixtures is not checked.")
#: Numbers in words.
_WORDS = ("none", "one", "two")


@dataclass(frozen=True, eq=False)
class TcpPath:
    """One path as tool centre point control carries it out.

    Attributes
    ----------
    name : str
    path : ToolPath
    rates : (n,) array
        Feed rate on the way to each point of the path, mm/min; infinite where rapid.
    along : AxisTrajectory
        Rotary axes at all points, those put between the path's own included.
    tips, axes : (n, 3) array
        In the work coordinate system, tips from the datum, mm.
    """

    name: str
    path: ToolPath
    rates: Array
    along: AxisTrajectory
    tips: Array
    axes: Array


class TipControl(ABC):
    """What one control calls the things that every program with a moving axis says.

    Attributes
    ----------
    dialect : Dialect
        Says modes, comments and the end.
    title : str
    axis_digits : int
        Digits of rotary angles, degrees, or of components of the axis.
    notes : tuple of str
        Sentences for the setup sheet.
    least_axes : int
        Rotary axes that it needs.
    """

    dialect: ClassVar[Dialect]
    title: ClassVar[str]
    axis_digits: ClassVar[int]
    notes: ClassVar[tuple[str, ...]] = ()
    least_axes: ClassVar[int] = 2

    @abstractmethod
    def begin(self, program: ProgramContext, course: TcpPath) -> Lines:
        """Blocks from a retracted tool to tool centre point control with the first axis."""

    @abstractmethod
    def leave(self, program: ProgramContext, course: TcpPath) -> Lines:
        """Blocks that end it and retract."""

    @abstractmethod
    def orientation(self, program: ProgramContext, course: TcpPath, k: int) -> str:
        """The words that turn the axis to that of a point."""

    def start(self, program: ProgramContext) -> Lines:
        """Blocks of the safe start."""
        return self.dialect.start(program)

    def end(self, program: ProgramContext) -> Lines:
        """Blocks of the end."""
        return self.dialect.end(program)

    def block(self, program: ProgramContext, course: TcpPath, k: int, rate: float | None) -> str:
        """The motion to a point, at a feed rate where it does not hold any more."""
        word, *rate_word = self.dialect.feed(course.tips[k], rate).rsplit(" F", 1)
        return " ".join([word, self.orientation(program, course, k), *(f"F{text}" for text in rate_word)])

    def check(self, program: ProgramContext) -> None:
        """Refuse what the control cannot do.

        Raises
        ------
        InvalidInput
        """
        driven = sum(not axis.by_hand for axis in program.machine.rotary)
        if driven < self.least_axes:
            raise InvalidInput(f"the tool axis of the plan moves and {program.machine.name} drives {driven} rotary "
                               f"axes: {self.title} needs {_WORDS[self.least_axes]}")


def moves(plan: Plan) -> bool:
    """Whether the axis of an operation moves.

    Parameters
    ----------
    plan : Plan
    """
    return any(op.orientation.lead is not None for op in plan.operations if op.path is not None)


def courses(plan: Plan, mounting: Mounting) -> tuple[TcpPath, ...]:
    """All operations of a plan that have a path, the rotary axes going on from one to the next.

    Parameters
    ----------
    plan : Plan
    mounting : Mounting

    Raises
    ------
    InvalidInput
        When the machine cannot follow a path, or there is none.
    """
    found, stand = list[TcpPath](), np.zeros(len(mounting.machine.rotary))
    for op in plan.operations:
        if op.path is not None:
            rates = np.where(op.path.kind == Motion.LINK, np.inf, plan.inputs.feedrate)
            found.append(course_of(op.name, op.path, rates, mounting, plan.datum, stand))
            stand = found[-1].along.rotary[-1]
    if not found:
        raise InvalidInput("the plan has no operation with an axis: there is nothing to post")
    return tuple(found)


def course_of(name: str, path: ToolPath, rates: Array, mounting: Mounting, datum: ArrayLike = (0.0, 0.0, 0.0),
              near: ArrayLike = ()) -> TcpPath:
    """A path followed by a machine.

    Parameters
    ----------
    name : str
    path : ToolPath
    rates : (n,) array
        mm/min; infinite where rapid.
    mounting : Mounting
    datum : (3,) array_like
        Origin of the work coordinate system in the part's frame, mm.
    near : (m,) array_like
        Where the rotary axes stand before, rad; zero unless given.

    Raises
    ------
    InvalidInput
        When the machine cannot follow it.
    """
    turn = placement(mounting.table_from_part)[:3, :3]
    try:
        along = following(mounting.machine, path, mounting.table_from_part, float(mounting.tool_length or 0.0),
                          near=near, travel=mounting.judges_travel)
    except InvalidInput as reason:
        raise InvalidInput(f"{name}: {reason}") from None
    return TcpPath(name, path, rates, along, (along.tips - np.asarray(datum)) @ turn.T, along.axes @ turn.T)


def moving_text(plan: Plan, mounting: Mounting, control: TipControl, options: Options | None = None,
                name: str = "toolaxis") -> str:
    """The text of a program with tool centre point control.

    Parameters
    ----------
    plan : Plan
    mounting : Mounting
        The machine, and where the part stands on its table.
    control : TipControl
    options : Options, optional
    name : str
        Of the program.

    Returns
    -------
    str
        ASCII, a line for each block.

    Raises
    ------
    InvalidInput
        When the machine cannot follow a path, or the control cannot move its axes.
    """
    program = setting_of(plan.inputs, mounting, control.dialect, options, name)
    control.check(program)
    return courses_text(program, control, courses(plan, mounting))


def courses_text(program: ProgramContext, control: TipControl, found: Sequence[TcpPath]) -> str:
    """The text of a program that carries out courses one after the other.

    Parameters
    ----------
    program : ProgramContext
        That the control was asked about.
    control : TipControl
    found : sequence of TcpPath
    """
    lines = [*control.start(program), *origin_comments(program, control.dialect)]
    for course in found:
        lines += [control.dialect.comment(course.name.upper()), *control.begin(program, course)]
        lines += _motions(program, course, control)
        lines += control.leave(program, course)
    return "\n".join([*control.dialect.framed([*lines, *control.end(program)]), ""])


def _motions(program: ProgramContext, course: TcpPath, control: TipControl) -> Lines:
    path, lines = course.path, list[str]()
    starts, begun, passes, held = set(path.breaks[1:-1].tolist()), 0, 1, -1.0
    rates = np.where(np.isfinite(course.rates), course.rates, program.inputs.rapid).tolist()
    for k, point in enumerate(course.along.arrival.tolist()):
        if point in starts and point != begun:
            passes += 1
            lines.append(control.dialect.comment(f"PASS {passes}"))
        begun = point
        rate = program.inputs.rapid if k == 0 else rates[point]
        lines.append(control.block(program, course, k, None if rate == held else rate))
        held = rate
    return lines


def rotary_words(program: ProgramContext, course: TcpPath, k: int, digits: int, rolls_over: bool) -> Lines:
    """Rotary angles of a point as words; from 0 to below 360 degrees for axes without end that roll over.

    Parameters
    ----------
    program : ProgramContext
    course : TcpPath
    k : int
    digits : int
    rolls_over : bool
    """
    words = []
    for axis, angle in zip(program.machine.rotary, course.along.rotary[k], strict=True):
        value = degrees(angle)
        if rolls_over and not (np.isfinite(axis.low) or np.isfinite(axis.high)):
            value = round(value % 360.0, digits) % 360.0
        words.append(f"{axis.name}{number(value, digits)}")
    return words
