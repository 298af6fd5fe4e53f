"""Siemens 840D sl, 828D and ONE: swivelling by CYCLE800.

**Source** SINUMERIK operating manual 6FC5398-8CP40, "Swivel": axis-by-axis mode turns the coordinate system about each
axis as the turns before have left it; Direction minus or plus takes the solution with the lower or the higher value of
the rotary axis that is the direction reference.  The order of the arguments, CYCLE800(_FR, _TC, _ST, _MODE, X0, Y0, Z0,
A, B, C, X1, Y1, Z1, _DIR, _FR_I, _DMODE), with _FR 1 for a retract of Z before swivelling, _MODE 57 for axis by axis in
the order X, Y, Z, and the empty call that deletes the swivel frames, is that of published programs; no manual for it
was at hand.  SINUMERIK programming manual job planning 6FC5398-2BP20, 6.2: with TRAORI A3, B3, C3 are components of
the axis, ORIWKS refers them to the workpiece, and ORIVECT turns it in the plane of both; SUPA G0 Z D0 as a retract is
common practice.
"""

from math import degrees

import numpy as np

from toolaxis.errors import InvalidInput
from toolaxis.post.context import Program, ProgramContext
from toolaxis.post.indexed_positions import IndexedPosition
from toolaxis.post.program import Dialect, Lines, number
from toolaxis.post.tcp_program import FIRST_MOTION, TcpPath, TipControl, rotary_words


def require_retract(program: ProgramContext) -> None:
    """Refuse a program without a place to retract to.

    Parameters
    ----------
    program : ProgramContext

    Raises
    ------
    InvalidInput
    """
    if program.retract is None:
        raise InvalidInput(f"Z of {program.machine.name} has no upper limit to retract to: give --retract, the "
                           "machine coordinate at which the rotary axes may turn")


def retract_block(program: ProgramContext) -> str:
    """The block that retracts Z in machine coordinates, tool length off.

    Parameters
    ----------
    program : ProgramContext
        With a retract.
    """
    assert program.retract is not None
    return f"SUPA G0 Z{number(program.retract, 3)} D0"


class Siemens(Dialect):
    """CYCLE800 with mode 57, turns about X, Y, Z; it retracts Z and turns the axes itself."""

    name = "siemens"
    title = "Siemens CYCLE800"
    suffix = ".mpf"
    digits, angle_digits = 5, 5
    turns = "XYZ"
    straight = True
    notes = ("G54 has its origin at the datum, rotary axes at zero there.",
             "CYCLE800 takes the swivel data record without a name: one record is set up. Of the two solutions it "
             "takes the one by _DIR, whose reference axis the machine's maker has set; the program supposes the axis "
             "that tilts. Compare with the angles of this sheet when the axes have turned.")

    def start(self, program: ProgramContext) -> Lines:
        """Modes, swivel frames deleted, straight rapids, tool, spindle."""
        return [self.comment(program.name), "G710 G17 G40 G90 G94 RTLION", "CYCLE800()", *self.call_tool(program)]

    def call_tool(self, program: ProgramContext) -> Lines:
        """Tool, work offset, spindle."""
        return [f"T{program.tool_number} D1", "M6", "G54", f"S{program.inputs.spindle:.0f} M3"]

    def change_tool(self, program: ProgramContext) -> Lines:
        """Retract, swivel frames deleted, then the tool."""
        return [retract_block(program), "CYCLE800()", *self.call_tool(program)]

    def check(self, program: Program) -> None:
        """Refuse tool changes where nobody told a retract.

        Raises
        ------
        InvalidInput
        """
        super().check(program)
        if len({station.operation.tool for station in program.stations}) > 1:
            require_retract(program)

    def orient(self, program: Program, station: IndexedPosition) -> Lines:
        """Retract and swivel, the axes that CYCLE800 should reach in a comment."""
        return [self.comment(f"AXES {self.rotary(program, station)}"), *program.unclamp,
                _swivel(*self.euler(station), _direction(program, station)), *program.clamp]

    def leave(self, program: Program, station: IndexedPosition) -> Lines:
        """Nothing: the next CYCLE800 retracts Z before it swivels, in one call that a swivel data record stands for."""
        return []

    def end(self, program: ProgramContext) -> Lines:
        """Retract, axes to zero, frames deleted, spindle off, end."""
        zero = number(0.0, self.angle_digits)
        home = [f"{axis.name}{zero}" for axis in program.machine.rotary]
        return [self.comment(f"AXES {' '.join(home)}"), *program.unclamp, _swivel(zero, zero, zero, 1), *program.clamp,
                "CYCLE800()", "M5", "M30"]

    def comment(self, text: str) -> str:
        """A block that is a comment."""
        return "; " + super().comment(text)[1:-1]

    def tool_length(self, program: ProgramContext) -> str:
        """Nothing: D1 holds."""
        return ""

    def feed(self, point: np.ndarray[tuple[int, ...], np.dtype[np.float64]], rate: float | None) -> str:
        """A motion at feed rate."""
        return f"G1 {self.point(point)}" + ("" if rate is None else f" F{number(rate, 3)}")


def _swivel(a: str, b: str, c: str, direction: int) -> str:
    """A new plane by turns about X, Y, Z after a retract along Z."""
    return f'CYCLE800(1,"",0,57,0,0,0,{a},{b},{c},0,0,0,{direction},0,0)'


def _direction(program: Program, station: IndexedPosition) -> int:
    """+1 where the axis that tilts stands at the higher of its two values, -1 where at the lower."""
    rotary = program.machine.rotary
    # The axis that tilts is the one that lies flattest, of two that lie alike the first.
    flatness = [round(float(np.linalg.norm(axis.direction[:2])), 6) for axis in rotary]
    tilting = flatness.index(max(flatness))
    own = degrees(float(station.angles[tilting]))
    others = [degrees(float(row[tilting])) for row in station.others]
    is_lower = any(other > own + 1e-6 for other in others) if others else own < 0
    return -1 if is_lower else 1


class SiemensTip(TipControl):
    """TRAORI with the axis as a vector in the work coordinate system, turned on the shortest way between two."""

    dialect = Siemens()
    title = "Siemens TRAORI"
    axis_digits = 7
    least_axes = 1
    notes = (FIRST_MOTION, "The rotary axes are turned to the first axis before TRAORI; the control goes on from there "
             "in the same solution. The program is for those angles, in the comments.")

    def start(self, program: ProgramContext) -> Lines:
        """Modes, transformations and frames off, tool, spindle, retract."""
        return [self.dialect.comment(program.name), "G710 G17 G40 G90 G94", "TRAFOOF",
                *self.dialect.call_tool(program), retract_block(program)]

    def begin(self, program: ProgramContext, course: TcpPath) -> Lines:
        """Rotary axes to the first axis, then the transformation and its work offset."""
        words = [f"{word[0]}=DC({word[1:]})" if endless else word for word, endless in
                 zip(rotary_words(program, course, 0, self.dialect.angle_digits, True),
                     (axis.high == float("inf") for axis in program.machine.rotary), strict=True)]
        return [*program.unclamp, f"G0 {' '.join(words)}", "D1", "TRAORI", "G54", "ORIWKS ORIVECT"]

    def leave(self, program: ProgramContext, course: TcpPath) -> Lines:
        """Transformation off, retract."""
        return ["TRAFOOF", retract_block(program)]

    def end(self, program: ProgramContext) -> Lines:
        """Spindle off, end."""
        return ["M5", "M30"]

    def orientation(self, program: ProgramContext, course: TcpPath, k: int) -> str:
        """The axis as a vector."""
        return " ".join(f"{name}={number(value, self.axis_digits)}" for name, value in
                        zip(("A3", "B3", "C3"), course.axes[k], strict=True))

    def check(self, program: ProgramContext) -> None:
        """Refuse a retract that nobody told.

        Raises
        ------
        InvalidInput
        """
        super().check(program)
        require_retract(program)


DIALECTS = (Siemens(),)
TIP_CONTROLS = (SiemensTip(),)
