"""Haas next generation control: feature coordinates by G268, and dynamic work offset by G254.

**Source** Haas Mill Operator's Manual, next generation control: G254 is invoked after the work offset and after the
index move, X and Y come before Z then, and G53 retracts before rotary motion (haascnc.com, "G254 - Dynamic Work
Offset").  G268 takes the origin X Y Z, the angles I J K about X, Y, Z of the work coordinate system and their order Q;
it was not possible to read that page again, so that the meaning of Q321 (Z first, then Y, then X, all about the axes of
the work coordinate system) is not verified: `notes` says so on every setup sheet.
"""

from toolaxis.post.context import Program, ProgramContext
from toolaxis.post.dialects.fanuc import Fanuc
from toolaxis.post.indexed_positions import IndexedPosition
from toolaxis.post.program import Lines


class HaasPlane(Fanuc):
    """G268 X Y Z I J K Q321 with the axes indexed before; G269 cancels."""

    name = "haas-g268"
    title = "Haas G268"
    turns = "XYZ"
    hold, release = ("M10", "M12"), ("M11", "M13")
    notes = ("G54 has its origin at the datum, rotary axes at zero there.",
             "NOT VERIFIED: the order of turns in G268 ... Q321 is taken as Z, then Y, then X about the axes of the "
             "work coordinate system; before the first use check on the control, with a plane turned about two axes "
             "and the tool in the air, or use --dialect haas-g254.")

    def cancelled(self) -> Lines:
        """The block that cancels the plane."""
        return ["G269"]

    def retracted(self, program: ProgramContext) -> Lines:
        """Z to the top in machine coordinates, which G53 is for."""
        return ["G53 G0 Z0.", "G49"]

    def orient(self, program: Program, station: IndexedPosition) -> Lines:
        """Index, then the plane."""
        i, j, k = self.euler(station)
        return [*self.index(program, station), f"G268 X0. Y0. Z0. I{i} J{j} K{k} Q321"]


class HaasOffset(HaasPlane):
    """G254: the control turns the work offset with the table; coordinates are those of the machine's axes."""

    name = "haas-g254"
    title = "Haas G254"
    turns = ""
    least_rotary = 1
    kinds = ("table", "table-table")
    notes = ("G54 has its origin at the datum with the rotary axes at zero; its rotary values must be zero.",
             "The control knows the centre of rotation (MRZP).")

    def cancelled(self) -> Lines:
        """The block that cancels the dynamic work offset."""
        return ["G255"]

    def orient(self, program: Program, station: IndexedPosition) -> Lines:
        """Index, then the dynamic work offset."""
        return [*self.index(program, station), "G254"]


DIALECTS = (HaasPlane(), HaasOffset())
