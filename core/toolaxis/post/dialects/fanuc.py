"""Fanuc 30i, 31i and 32i: the tilted working plane by G68.2 with G53.1, and work offsets alone for any ISO control.

**Source** FANUC Series 30i/31i-A additional manual A-79976E for the feature coordinate system and its G69.  That G68.2
takes the origin X Y Z and the angles I J K of turns about Z, the new X, the new Z, and that length compensation is
cancelled after G69 and G28, is common practice and not from a manual that was at hand.  The same holds for tool centre
point control: G43.4 H stands in a block of its own, takes the positions of rotary axes in its motion blocks and is
cancelled by G49.
"""

from typing import ClassVar

from toolaxis.post.context import Program, ProgramContext
from toolaxis.post.indexed_positions import IndexedPosition
from toolaxis.post.program import Dialect, Lines
from toolaxis.post.tcp_program import FIRST_MOTION, TcpPath, TipControl, rotary_words


class Fanuc(Dialect):
    """G68.2 X Y Z I J K, then G53.1; rotary axes are turned before, so that G53.1 finds them where they belong."""

    name = "fanuc"
    title = "Fanuc G68.2"
    turns = "ZXZ"
    least_rotary = 2
    notes: ClassVar[tuple[str, ...]] = (
        "G54 has its origin at the datum, rotary axes at zero there.",
        "G0 may bend rapid motion: where the spindle is tilted, links are G1 at the rapid rate.")

    def start(self, program: ProgramContext) -> Lines:
        """Number, modes, plane off, Z to its reference point, tool, spindle."""
        return ["%", "O0001", self.comment(program.name), "G21 G17 G40 G49 G80 G90 G94", *self.cancelled(),
                *self.retracted(program), *self.call_tool(program)]

    def call_tool(self, program: ProgramContext) -> Lines:
        """Tool, work offset, spindle."""
        return [f"T{program.tool_number} M6", "G54", f"S{program.inputs.spindle:.0f} M3"]

    def cancelled(self) -> Lines:
        """The block that cancels the plane."""
        return ["G69"]

    def retracted(self, program: ProgramContext) -> Lines:
        """Z to its reference point, length compensation off."""
        return ["G91 G28 Z0.", "G90 G49"]

    def orient(self, program: Program, station: IndexedPosition) -> Lines:
        """Index, then the plane."""
        i, j, k = self.euler(station)
        return [*self.index(program, station), f"G68.2 X0. Y0. Z0. I{i} J{j} K{k}", "G53.1"]

    def leave(self, program: Program, station: IndexedPosition) -> Lines:
        """Plane off, retract."""
        return [*self.cancelled(), *self.retracted(program)]

    def end(self, program: ProgramContext) -> Lines:
        """Spindle off, rotary axes to zero, end."""
        zero = " ".join(f"{axis.name}0." for axis in program.machine.rotary if not axis.by_hand)
        return ["M5", *([*program.unclamp, f"G0 {zero}", *program.clamp] if zero else []), "M30", "%"]


class Iso(Fanuc):
    """No plane at all: coordinates of the machine's own axes, a work offset G54 to G59 for each orientation."""

    name = "iso"
    title = "ISO with a work offset for each orientation"
    turns = ""
    offsets: ClassVar[tuple[str, ...]] = ("G54", "G55", "G56", "G57", "G58", "G59")
    least_rotary = 0
    by_hand = True
    kinds: ClassVar[tuple[str, ...]] = ("three axes", "table", "table-table")
    notes: ClassVar[tuple[str, ...]] = (
        "Each work offset has its origin where the datum is with the rotary axes at that orientation's angles: "
        "touch off the datum there.", "Offsets of the rotary axes are zero in all of them.")

    def cancelled(self) -> Lines:
        """Nothing to cancel."""
        return []

    def orient(self, program: Program, station: IndexedPosition) -> Lines:
        """Index, by hand where the axes are, and the work offset."""
        return [*self.index(program, station), self.offsets[station.orientation]]

    def index(self, program: Program, station: IndexedPosition) -> Lines:
        """Turn the axes, or stop for them to be set by hand."""
        if any(axis.by_hand for axis in program.machine.rotary):
            return ["M5", self.comment(f"SET {self.rotary(program, station)}"), "M0",
                    f"S{program.inputs.spindle:.0f} M3"]
        return super().index(program, station)


class FanucTip(TipControl):
    """G43.4, type 1: tips in the work coordinate system that turns with the table, and positions of the rotary axes."""

    dialect = Fanuc()
    title = "Fanuc G43.4"
    axis_digits = 3
    notes: ClassVar[tuple[str, ...]] = (
        FIRST_MOTION, "G43.4 is programmed in the coordinate system that is fixed to the table with the rotary axes at "
        "zero; check the parameter that says so.")

    def begin(self, program: ProgramContext, course: TcpPath) -> Lines:
        """Rotary axes to the first axis, then control of the tip."""
        return [*program.unclamp, f"G0 {self.orientation(program, course, 0)}", f"G43.4 H{program.tool_number}"]

    def leave(self, program: ProgramContext, course: TcpPath) -> Lines:
        """Control of the tip off, retract."""
        return ["G49", "G91 G28 Z0.", "G90"]

    def orientation(self, program: ProgramContext, course: TcpPath, k: int) -> str:
        """Positions of the rotary axes."""
        return " ".join(rotary_words(program, course, k, self.axis_digits, True))


DIALECTS = (Fanuc(), Iso())
TIP_CONTROLS = (FanucTip(),)
