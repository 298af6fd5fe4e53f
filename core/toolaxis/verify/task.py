"""What the judge is asked: one operation, as data."""

from dataclasses import dataclass, field
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput
from toolaxis.machine.machine import Machine
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.profile import Profile
from toolaxis.verify.held_side import HeldSide

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class VerificationTask:
    """What is to be judged: one operation, as data.

    Attributes
    ----------
    name : str
    tips, axes : (n, 3) array
        Cutter locations, mm, and unit tool axes.
    kind : (n,) array of int
        `Motion` that arrives at each point.
    profile : Profile
        Generatrix of the cutter.
    targets : tuple of Face
        What the operation machines: judged for scallop and gouge.
    scallop : float
        Limit of the scallop height, mm.
    allowance : float
        Stock to be left on the targets and the skin, mm.
    skin : tuple of Face
        Faces that continue the targets and that the cutter may touch but not cut: judged for gouge.
    touching : tuple of Face
        Faces behind a convex edge of targets or skin: the cutter may touch them where it runs out over the edge, and
        must not enter them by more than the allowed gouge.  Their own normals leave the part at the edge, so they are
        judged by distance; shank and holder keep their clearance from them.
    surroundings : tuple of Face
        Everything else, further bodies included: judged for the clearance of all components.
    outlines : dict of str to (k, 2) array
        Shank and holder as polylines (radius, z from the tip); one that is absent is reported as not checked.
    tolerance : Tolerance
    left : tuple of Face
        Zones that the plan leaves to a clean-up tool, as pieces of the targets: what stays there is not asked for.
    named : (3,) array, optional
        The fixed axis that the plan names for the operation: cutter locations must stand at it.
    depth : float
        How far below a face a gouge is followed, mm; less where a wall of targets and skin is thinner.
    machine : Machine, optional
        Judged for the reach of its rotary axes and, with place and tool length, for the travel of its linear ones.
    place : (4, 4) array, optional
        Where the part stands on the machine's table, all axes at zero.
    tool_length : float, optional
        From the spindle's gauge point to the tip, mm.
    rotary : tuple of float
        Where the machine's rotary axes stand at the first location, rad: with them, place and tool length its bodies
        are judged.
    held : HeldSide, optional
        The side that is held in the clamping: every component keeps its clearance from it on all motions.
    before : tuple of tip, axis and rotary angles, optional
        Where the operation before ends: the index move from there is judged for bodies too; without one the way down
        from above.
    stock : float
        What roughing left, mm above the finished surface: shank and holder keep their clearance with it, and the
        cutter on links.  Nothing of it counts as removed by operations before or by this one.
    proud : tuple of Face
        The part's own faces that carry it.
    greatest_step_over : float
        Greatest distance of neighbouring passes on the targets, mm; 0 where none is asked for.
    left_on : tuple of (Face, float)
        The part's own faces that keep an allowance, with that, mm, without the targets: no motion goes deeper.
    lead : float
        Radius of the arcs of lead-in and lead-out, mm; 0 where none are asked for.
    """

    name: str
    tips: Array
    axes: Array
    kind: NDArray[np.int8]
    profile: Profile
    targets: tuple[Face, ...]
    scallop: float
    allowance: float = 0.0
    skin: tuple[Face, ...] = ()
    touching: tuple[Face, ...] = ()
    surroundings: tuple[Face, ...] = ()
    outlines: dict[str, Array] = field(default_factory=dict)
    tolerance: Tolerance = field(default_factory=Tolerance)
    left: tuple[Face, ...] = ()
    named: Array | None = None
    depth: float = 1.0
    machine: Machine | None = None
    place: Array | None = None
    tool_length: float | None = None
    rotary: tuple[float, ...] = ()
    before: tuple[Array, Array, tuple[float, ...]] | None = None
    held: HeldSide | None = None
    stock: float = 0.0
    proud: tuple[Face, ...] = ()
    greatest_step_over: float = 0.0
    left_on: tuple[tuple[Face, float], ...] = ()
    lead: float = 0.0

    def __post_init__(self) -> None:
        if not (isfinite(self.scallop) and self.scallop > 0):
            raise InvalidInput(f"scallop limit of operation {self.name} is {self.scallop} mm: it must be above zero")
        if not isfinite(self.allowance):
            raise InvalidInput(f"allowance of operation {self.name} is {self.allowance} mm: it must be finite")
        if not (isfinite(self.stock) and self.stock >= 0):
            raise InvalidInput(f"stock of operation {self.name} is {self.stock} mm: it must be finite and zero or more")
        strange = [zone for zone in self.left if all(zone.surface is not face.surface for face in self.targets)]
        if strange:
            raise InvalidInput(f"operation {self.name} leaves rest material on face {strange[0].label}, which it "
                               "does not machine: give pieces of its targets")
        if not self.targets:
            raise InvalidInput(f"operation {self.name} machines no face: give at least one target")


def spot(point: tuple[float, float, float]) -> str:
    """A place, for a sentence.

    Parameters
    ----------
    point : (float, float, float)
        mm
    """
    return f"({point[0]:.3f}, {point[1]:.3f}, {point[2]:.3f})"


def motion_of(task: VerificationTask, index: int) -> str:
    """What the motion that arrives at a point is, for a sentence.

    Parameters
    ----------
    task : VerificationTask
    index : int
        Of the point; below zero for none.
    """
    return f"{Motion(int(task.kind[index])).name.lower()} motion to point {index + 1}" if index >= 0 else "no motion"
