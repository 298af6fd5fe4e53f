"""Heidenhain TNC 320, 530, 620, 640 and TNC7: the PLANE SPATIAL function in Klartext.

**Source** HEIDENHAIN TNC 620 user's manual for conversational programming, 10/2017, "Defining the working plane with
the spatial angle": turns about the fixed axes in the order A, B, C, which is C, B, A about the turned ones.  That
without SEQ the nearest solution inside the ranges is taken, which is the one where the axes stand, and that M140 MB MAX
retracts along the tool axis, is common practice and not from a manual that was at hand.  TNC 620 user's manual for ISO
programming, 5/2013, "Maintaining the position of the tool tip when positioning with tilted axes (TCPM): M128": the tip
keeps its place on the workpiece, M129 resets it.
"""

import numpy as np
from numpy.typing import NDArray

from toolaxis.post.context import Program, ProgramContext
from toolaxis.post.indexed_positions import IndexedPosition
from toolaxis.post.program import Dialect, Lines, number
from toolaxis.post.tcp_program import FIRST_MOTION, TcpPath, TipControl, rotary_words


class Heidenhain(Dialect):
    """PLANE SPATIAL SPA SPB SPC TURN, the axes turned before so that the nearest solution is the chosen one."""

    name = "heidenhain"
    title = "Heidenhain PLANE SPATIAL"
    suffix = ".h"
    digits, angle_digits = 4, 4
    turns = "ZYX"
    straight = True
    along_axis = True
    notes = ("The preset that is active has its origin at the datum, without a basic rotation.",
             "The tool retracts along its axis by M140 MB MAX before the axes turn.")

    def start(self, program: ProgramContext) -> Lines:
        """Plane off, tool, spindle, retract."""
        return ["PLANE RESET STAY", *self.call_tool(program)]

    def call_tool(self, program: ProgramContext) -> Lines:
        """Tool, spindle, retract."""
        return [f"TOOL CALL {program.tool_number} Z S{program.inputs.spindle:.0f}", "L M3", "L M140 MB MAX"]

    def orient(self, program: Program, station: IndexedPosition) -> Lines:
        """Index, then the plane."""
        c, b, a = (format_signed(text) for text in self.euler(station))
        return [*self.index(program, station), f"PLANE SPATIAL SPA{a} SPB{b} SPC{c} TURN FMAX COORD ROT"]

    def index(self, program: Program, station: IndexedPosition) -> Lines:
        """Turn the axes."""
        held = [f"L {word}" for word in program.clamp]
        return [*(f"L {word}" for word in program.unclamp), f"L {self.rotary(program, station)} R0 FMAX", *held]

    def rotary(self, program: Program, station: IndexedPosition) -> str:
        """The rotary words of a station, with their signs."""
        words = super().rotary(program, station).split()
        return " ".join(word[0] + format_signed(word[1:]) for word in words)

    def approach(self, program: Program, station: IndexedPosition) -> Lines:
        """Across, then down; in one block where the spindle is tilted."""
        first, down = self.point(station.tips[0]).rsplit(" ", 1)
        if station.tilt:
            return [f"L {first} {down} R0 FMAX"]
        return [f"L {first} R0 FMAX", f"L {down} R0 FMAX"]

    def rapid(self, program: Program, station: IndexedPosition, point: NDArray[np.float64]) -> str:
        """A rapid motion, always straight."""
        return f"L {self.point(point)} FMAX"

    def feed(self, point: NDArray[np.float64], rate: float | None) -> str:
        """A motion at feed rate."""
        return f"L {self.point(point)}" + ("" if rate is None else f" F{number(rate, 1)}")

    def point(self, point: NDArray[np.float64]) -> str:
        """The coordinates of a tip, with their signs."""
        return " ".join(word[0] + format_signed(word[1:]) for word in super().point(point).split())

    def leave(self, program: Program, station: IndexedPosition) -> Lines:
        """Retract along the tool axis, plane off."""
        return ["L M140 MB MAX", "PLANE RESET STAY"]

    def end(self, program: ProgramContext) -> Lines:
        """Spindle off, end."""
        return ["L M5", "L M30"]

    def comment(self, text: str) -> str:
        """A block that is a comment."""
        return "; " + super().comment(text)[1:-1]

    def framed(self, lines: Lines) -> Lines:
        """Numbered blocks between BEGIN PGM and END PGM."""
        whole = ["BEGIN PGM TOOLAXIS MM", *lines, "END PGM TOOLAXIS MM"]
        return [f"{k} {line}" for k, line in enumerate(whole)]


def format_signed(text: str) -> str:
    """A number with its sign, as Klartext wants it.

    Parameters
    ----------
    text : str
    """
    return text if text.startswith("-") else f"+{text}"


class HeidenhainTip(TipControl):
    """M128: the tip keeps its place while the rotary axes turn to the positions in each block."""

    dialect = Heidenhain()
    title = "Heidenhain M128"
    axis_digits = 4
    least_axes = 1
    notes = (FIRST_MOTION, "The tool retracts along its axis by M140 MB MAX before the axes turn.",
             "M128 keeps the tip in its place: the tool length in the table is that to the tip.")

    def begin(self, program: ProgramContext, course: TcpPath) -> Lines:
        """Rotary axes to the first axis, then control of the tip."""
        free = [f"L {word}" for word in program.unclamp]
        return [*free, f"L {self.orientation(program, course, 0)} R0 FMAX", "L M128"]

    def leave(self, program: ProgramContext, course: TcpPath) -> Lines:
        """Control of the tip off, retract along the tool axis."""
        return ["L M129", "L M140 MB MAX"]

    def orientation(self, program: ProgramContext, course: TcpPath, k: int) -> str:
        """Positions of the rotary axes with their signs."""
        return " ".join(word[0] + format_signed(word[1:]) for word in
                        rotary_words(program, course, k, self.axis_digits, True))


DIALECTS = (Heidenhain(),)
TIP_CONTROLS = (HeidenhainTip(),)
