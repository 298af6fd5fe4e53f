"""CL data around a blade that were made elsewhere, with new tool angles, held against the part where it is given."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.advice import LONGER_TOOL
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.surroundings import OTHER, SKIN, CheckSurfaces
from toolaxis.feasibility.violations import CUTTER, GOUGE, Violation
from toolaxis.feed.continuous_ik import following
from toolaxis.machine.setup import Mounting
from toolaxis.post.cl_points import CutterLocations
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.messages import place
from toolaxis.search.path_check import COMPONENTS
from toolaxis.shape.face import Face
from toolaxis.strategies.blade.reschedule import RescheduledPath, reschedule_path
from toolaxis.strategies.blade.schedule import CLEARANCE, SwivelAxis
from toolaxis.strategies.common.path_check import keeps_distance, prove_moving, spans_of
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: By how much cuts of the file may lie below the part, mm: what chords and digits of other systems come to.
DEPTH = 0.01
#: Turns smaller than this are none, rad.
_STILL = 1e-6


@dataclass(frozen=True)
class RotaryMotion:
    """How the rotary axis turns along the cuts.

    Attributes
    ----------
    steepest : float
        Greatest turn over the way of the cutter's centre, rad/mm.
    backwards : int
        How often it turns back.
    total : float
        All that it turns, rad.
    """

    steepest: float
    backwards: int
    total: float


@dataclass(frozen=True, eq=False)
class NewAngles:
    """Cutter locations with new tool angles.

    Attributes
    ----------
    locations : CutterLocations
    made : RescheduledPath
    before, after : RotaryMotion
    clear : bool
        Whether they were held against a part.
    """

    locations: CutterLocations
    made: RescheduledPath
    before: RotaryMotion
    after: RotaryMotion
    clear: bool


def reschedule(found: CutterLocations, tool: Tool, *, curve: str = "least", direction: ArrayLike | None = None,
               clearance: float = CLEARANCE, faces: tuple[Face, ...] = (), depth: float = DEPTH,
               mounting: Mounting | None = None, progress: Progress = NO_PROGRESS) -> NewAngles:
    """Give cutter locations around a blade new tool angles; the ball's centres, feed rates and kinds of motion stay.

    Parameters
    ----------
    found : CutterLocations
        From `toolaxis.read_cl`: cuts around a blade, with the axes of four-axis milling.
    tool : Tool
        With a ball end.
    curve : str
        "least": least peak acceleration; "keys": key points and rounded corners.
    direction : (3,) array_like, optional
        The rotary axis; that of the file's own tool axes unless given.
    clearance : float
        Of tool angles from their limits, rad.
    faces : tuple of Face
        Of the part, in the file's coordinates: the new path is proven against them.
    depth : float
        By how much the cutter may lie below them, mm.
    mounting : Mounting, optional
        A machine that must be able to follow.
    progress : Progress

    Raises
    ------
    InvalidInput
        When the file is no path around a blade, the machine cannot follow, or tool and part meet; the message gives
        the place and the amount.

    Notes
    -----
    **Source**: [stheta2023] Sec. 2.2, 2.3 for the angles; the proof is that of all moving axes.
    """
    made = reschedule_path(found.path, tool, curve=curve, clearance=clearance, direction=direction, progress=progress)
    if mounting is not None:
        following(mounting.machine, made.path, mounting.table_from_part, float(mounting.tool_length or 0.0),
                  travel=mounting.judges_travel)
    if faces:
        _prove(made.path, tool, faces, depth, progress)
    before, after = (_turning(path, tool, made.swing) for path in (found.path, made.path))
    return NewAngles(replace(found, tip=made.path.cl, axis=made.path.axis), made, before, after, bool(faces))


def _turning(path: ToolPath, tool: Tool, swing: SwivelAxis) -> RotaryMotion:
    cut = np.flatnonzero(path.kind == Motion.CUT)
    before = cut[cut > 0] - 1
    centre = path.cl + tool.corner_radius * path.axis
    turn = np.diff(swing.angles(path.axis))[before]
    way = np.linalg.norm(np.diff(centre, axis=0), axis=1)[before]
    moves = way > 0
    slope = np.abs(turn[moves]) / way[moves]
    sense = np.sign(turn[np.abs(turn) > _STILL])
    backwards = np.diff(sense) != 0
    return RotaryMotion(
        steepest=float(slope.max(initial=0.0)),
        backwards=int(backwards.sum()),
        total=float(np.abs(turn).sum()))


def _prove(path: ToolPath, tool: Tool, faces: tuple[Face, ...], depth: float, progress: Progress) -> None:
    """Refuse a path that meets the part: cutter below it, shank or holder too near, or links too near."""
    tolerance = Tolerance().for_cutter(tool.radius)
    far = [tolerance.shank_clearance, tolerance.holder_clearance]
    proof = prove_moving(path, tool, (CheckSurfaces(SKIN, faces, np.array([-depth, *far])),), progress=progress)
    if proof.witness is not None:
        raise InvalidInput(f"the new tool angles are refused: {_said(proof.witness)}; take {LONGER_TOOL}, "
                           "another --curve, or a rotary axis that leans away")
    # links between cuts: those that leave a cut or lead to one begin or end on the part and were judged above
    free = CheckSurfaces(OTHER, faces, np.array([tolerance.cutter_clearance, *far]))
    cut = path.kind == Motion.CUT
    on = np.flatnonzero((path.kind[1:] == Motion.LINK) & ~cut[:-1] & ~np.append(cut[2:], False))
    if len(on):
        spans = spans_of(path).rows(on)
        bad = on[~keeps_distance(tool, free, spans, free.required)]
        if len(bad):
            at = np.round(path.cl[bad[0] + 1], 2).tolist()
            raise InvalidInput(f"the new tool angles are refused: on the rapid motion to point {bad[0] + 1}, at {at}, "
                               "the tool comes too near to the part; retract farther between the cuts")


def _said(witness: Violation) -> str:
    where = f"face {witness.label} at {place(witness.point)}" if witness.label else "the part"
    name = "cutter" if witness.reason == GOUGE else COMPONENTS[max(witness.reason - CUTTER, 0)]
    if witness.distance < 0:
        return f"the {name} goes {-witness.distance:.3f} mm into {where}"
    if not np.isfinite(witness.distance):
        return f"the {name} comes too near to {where}"
    return f"the {name} comes within {witness.distance:.3f} mm of {where}"
