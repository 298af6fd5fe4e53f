"""LinuxCNC: a work offset for each orientation, and the tilted work plane of its remap.

**Source** linuxcnc.org, G-code reference (G53, G54 to G59.3, G64); the remap that comes with LinuxCNC as
configs/sim/axis/vismach/5axis/table-rotary_spindle-rotary-nutating: G68.2 P0 Q313 takes turns about Z, X, Z, is defined
in G54 and for spindles that turn about C and then A or B, G53.1 turns them, G69 cancels.
"""

from typing import ClassVar

from toolaxis.errors import InvalidInput
from toolaxis.post.context import Program, ProgramContext
from toolaxis.post.dialects.fanuc import Iso
from toolaxis.post.indexed_positions import IndexedPosition
from toolaxis.post.program import Dialect, Lines


class LinuxCnc(Iso):
    """Coordinates of the machine's own axes, a work offset G54 to G59.3 for each orientation."""

    name = "linuxcnc"
    title = "LinuxCNC"
    suffix = ".ngc"
    digits, angle_digits = 5, 5
    offsets: ClassVar[tuple[str, ...]] = (*Iso.offsets, "G59.1", "G59.2", "G59.3")
    straight = True
    rolls_over = False
    told_retract = True

    def start(self, program: ProgramContext) -> Lines:
        """Modes with the passes' chord tolerance as that of the path, retract, tool, spindle."""
        return ["%", self.comment(program.name), "G21 G17 G40 G49 G80 G90 G94", f"G64 P{program.inputs.chord:.4f}",
                *self.cancelled(), "G54", *self.retracted(program), *self.call_tool(program)]

    def call_tool(self, program: ProgramContext) -> Lines:
        """Tool, spindle."""
        return [f"T{program.tool_number} M6", f"S{program.inputs.spindle:.0f} M3"]

    def sheet_notes(self, program: ProgramContext) -> list[str]:
        """Which way a table must turn: LinuxCNC's own modules of kinematics disagree with ISO 841."""
        turning = [axis.name for axis in program.machine.table if not axis.by_hand]
        if not turning:
            return super().sheet_notes(program)
        return [*super().sheet_notes(program),
                f"Growing angles of {' and '.join(turning)} must turn the tool right-handed as seen from the part "
                "(ISO 841). LinuxCNC's xyzac-trt-kins and xyzbc-trt-kins (release 2.9) count them the other way round. "
                "Turn each axis to 10 deg before the start; where one goes the wrong way, reverse its direction in the "
                "machine's file and post the program again."]

    def retracted(self, program: ProgramContext) -> Lines:
        """Z to the machine coordinate at which rotary axes may turn."""
        return [f"G53 G0 Z{program.retract:.3f}"]


class LinuxCncPlane(LinuxCnc):
    """The tilted work plane of the remap: G68.2 P0 Q313, G53.1, G69."""

    name = "linuxcnc-twp"
    title = "LinuxCNC tilted work plane"
    turns = "ZXZ"
    offsets: ClassVar[tuple[str, ...]] = ("G54",)
    least_rotary = 2
    kinds: ClassVar[tuple[str, ...]] = ("head-head",)
    notes: ClassVar[tuple[str, ...]] = (
        "G54 has its origin at the datum with all rotary axes at zero; G59 to G59.3 are overwritten by the remap.",)
    by_hand = False

    def cancelled(self) -> Lines:
        """The block that cancels the plane."""
        return ["G69"]

    def orient(self, program: Program, station: IndexedPosition) -> Lines:
        """Index, then the plane, which must be defined in G54."""
        i, j, k = self.euler(station)
        return ["G54", *self.index(program, station), f"G68.2 P0 Q313 X0 Y0 Z0 I{i} J{j} K{k}", "G53.1"]

    def check(self, program: Program) -> None:
        """Refuse heads that the remap does not know.

        Raises
        ------
        InvalidInput
        """
        Dialect.check(self, program)
        names = [axis.name for axis in program.machine.rotary]
        if names not in (["C", "A"], ["C", "B"]):
            raise InvalidInput(f"{self.title} turns C and then A or B in the head and {program.machine.name} has "
                               f"{', '.join(names)}: use another --dialect")


DIALECTS = (LinuxCncPlane(), LinuxCnc())
