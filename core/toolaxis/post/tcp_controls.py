"""Tool centre point control: Fanuc G43.4, Siemens TRAORI, Heidenhain M128.

**Source** HEIDENHAIN TNC 620 user's manual for ISO programming, 5/2013, "Maintaining the position of the tool tip when
positioning with tilted axes (TCPM): M128": the tip keeps its place on the workpiece, M129 resets it.  SINUMERIK
programming manual job planning 6FC5398-2BP20, 6.2: with TRAORI A3, B3, C3 are components of the axis, ORIWKS refers
them to the workpiece, and ORIVECT turns it in the plane of both.  That G43.4 H stands in a block of its own, takes the
positions of rotary axes in its motion blocks and is cancelled by G49, is common practice and not from a manual that was
at hand; the same holds for SUPA G0 Z D0 as a retract.
"""

from toolaxis.errors import InvalidInput
from toolaxis.post.context import Setting
from toolaxis.post.dialects.fanuc import Fanuc
from toolaxis.post.dialects.heidenhain import Heidenhain, signed
from toolaxis.post.dialects.siemens import Siemens
from toolaxis.post.program import Dialect, Lines, number
from toolaxis.post.tcp_program import Course, TipControl, rotary_words

_NOTE = ("The first motion of each operation leads straight from the retracted place to its first point, with the axis "
         "turned before. Whether that is free of fixtures is not checked.")


class FanucTip(TipControl):
    """G43.4, type 1: tips in the work coordinate system that turns with the table, and positions of the rotary axes."""

    dialect = Fanuc()
    title = "Fanuc G43.4"
    axis_digits = 3
    notes = (_NOTE, "G43.4 is programmed in the coordinate system that is fixed to the table with the rotary axes at "
             "zero; check the parameter that says so.")

    def begin(self, program: Setting, course: Course) -> Lines:
        """Rotary axes to the first axis, then control of the tip."""
        return [*program.unclamp, f"G0 {self.orientation(program, course, 0)}", "G43.4 H1"]

    def leave(self, program: Setting, course: Course) -> Lines:
        """Control of the tip off, retract."""
        return ["G49", "G91 G28 Z0.", "G90"]

    def orientation(self, program: Setting, course: Course, k: int) -> str:
        """Positions of the rotary axes."""
        return " ".join(rotary_words(program, course, k, self.axis_digits, True))


class SiemensTip(TipControl):
    """TRAORI with the axis as a vector in the work coordinate system, turned on the shortest way between two."""

    dialect = Siemens()
    title = "Siemens TRAORI"
    axis_digits = 7
    least_axes = 1
    notes = (_NOTE, "The rotary axes are turned to the first axis before TRAORI; the control goes on from there in the "
             "same solution. The program is for those angles, in the comments.")

    def start(self, program: Setting) -> Lines:
        """Modes, transformations and frames off, tool, spindle, retract."""
        return [self.dialect.comment(program.name), "G710 G17 G40 G90 G94", "TRAFOOF", "T1 D1", "M6", "G54",
                f"S{program.inputs.spindle:.0f} M3", self._retract(program)]

    def begin(self, program: Setting, course: Course) -> Lines:
        """Rotary axes to the first axis, then the transformation and its work offset."""
        words = [f"{word[0]}=DC({word[1:]})" if endless else word for word, endless in
                 zip(rotary_words(program, course, 0, self.dialect.angle_digits, True),
                     (axis.high == float("inf") for axis in program.machine.rotary), strict=True)]
        return [*program.unclamp, f"G0 {' '.join(words)}", "D1", "TRAORI", "G54", "ORIWKS ORIVECT"]

    def leave(self, program: Setting, course: Course) -> Lines:
        """Transformation off, retract."""
        return ["TRAFOOF", self._retract(program)]

    def end(self, program: Setting) -> Lines:
        """Spindle off, end."""
        return ["M5", "M30"]

    def orientation(self, program: Setting, course: Course, k: int) -> str:
        """The axis as a vector."""
        return " ".join(f"{name}={number(value, self.axis_digits)}" for name, value in
                        zip(("A3", "B3", "C3"), course.axes[k], strict=True))

    def check(self, program: Setting) -> None:
        """Refuse a retract that nobody told.

        Raises
        ------
        InvalidInput
        """
        super().check(program)
        if program.retract is None:
            raise InvalidInput(f"Z of {program.machine.name} has no upper limit to retract to: give --retract, the "
                               "machine coordinate at which the rotary axes may turn")

    @staticmethod
    def _retract(program: Setting) -> str:
        assert program.retract is not None
        return f"SUPA G0 Z{number(program.retract, 3)} D0"


class HeidenhainTip(TipControl):
    """M128: the tip keeps its place while the rotary axes turn to the positions in each block."""

    dialect = Heidenhain()
    title = "Heidenhain M128"
    axis_digits = 4
    least_axes = 1
    notes = (_NOTE, "The tool retracts along its axis by M140 MB MAX before the axes turn.",
             "M128 keeps the tip in its place: the tool length in the table is that to the tip.")

    def begin(self, program: Setting, course: Course) -> Lines:
        """Rotary axes to the first axis, then control of the tip."""
        free = [f"L {word}" for word in program.unclamp]
        return [*free, f"L {self.orientation(program, course, 0)} R0 FMAX", "L M128"]

    def leave(self, program: Setting, course: Course) -> Lines:
        """Control of the tip off, retract along the tool axis."""
        return ["L M129", "L M140 MB MAX"]

    def orientation(self, program: Setting, course: Course, k: int) -> str:
        """Positions of the rotary axes with their signs."""
        return " ".join(word[0] + signed(word[1:]) for word in
                        rotary_words(program, course, k, self.axis_digits, True))


TIP_CONTROLS: dict[str, TipControl] = {one.dialect.name: one for one in (FanucTip(), SiemensTip(), HeidenhainTip())}


def tip_control_of(dialect: Dialect) -> TipControl:
    """The tool centre point control of a dialect.

    Parameters
    ----------
    dialect : Dialect

    Raises
    ------
    InvalidInput
        When it has none, or none that is known for sure.
    """
    if dialect.name not in TIP_CONTROLS:
        raise InvalidInput(f"the tool axis of the plan moves and dialect {dialect.name} has no tool centre point "
                           f"control here: use {', '.join(TIP_CONTROLS)} or apt")
    return TIP_CONTROLS[dialect.name]
