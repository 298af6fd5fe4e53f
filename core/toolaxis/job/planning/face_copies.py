"""What is done on a face, moved to another one that is alike, and proven again there."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import Cancelled, ToolAxisError
from toolaxis.job.planning.blade_copies import turn_path
from toolaxis.job.planning.edit_axis import evaluate_given_axis, frame_of
from toolaxis.plan.choices import FEEDS
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.machine_limits import machine_violation
from toolaxis.search.path_check import prove
from toolaxis.shape.face import Face
from toolaxis.skin.alike import AlikeFace
from toolaxis.skin.view_surface import ViewSurface
from toolaxis.work import OutOfWork

Array = NDArray[np.float64]

#: By how much a piece may differ in area from that of which it is a copy, as a share.
_AREA = 1e-3
#: Cosine from which on the parameters of two skins run in one direction.
_ALONG = 0.999


def carry_piece(op: Operation, alike: AlikeFace) -> Face | None:
    """The sub-surface of an operation on a face that is alike; None where its loops do not go over.

    Parameters
    ----------
    op : Operation
        On the original, or a piece of it.
    alike : AlikeFace
    """
    piece = alike.carry_piece(op.face)
    return piece if piece is not None and abs(piece.area - op.face.area) <= _AREA * op.face.area else None


def copy_operation(op: Operation, alike: AlikeFace, piece: Face, task: FaceProblem, datum: Array) -> Operation | None:
    """An operation moved to a face that is alike; None where it is refused there.

    Parameters
    ----------
    op : Operation
        With a path.
    alike : AlikeFace
    piece : Face
        From `carry_piece`.
    task : FaceProblem
        Of that piece.
    datum : (3,) array
        The origin of work coordinate systems, mm.

    Notes
    -----
    Where the two faces are the same but for rounding, the passes are moved as they are; else they are laid anew with
    the moved axis.  Either way all motions are proven among what stands there.

    Raises
    ------
    Cancelled, OutOfWork
    """
    assert op.path is not None and op.orientation.axis is not None
    axis = alike.matrix[:3, :3] @ op.orientation.axis
    axis /= np.linalg.norm(axis)
    limits = task.feasibility.limits
    if limits is not None and not limits.allowed(axis[None])[0]:
        return None
    if not alike.same:
        return _lay_anew(op, alike, piece, task, axis, datum)
    path = turn_path(op.path, alike.matrix, axis)
    if machine_violation(task.feasibility, path, task.groups) is not None:
        return None
    proof = prove(path, task.worth.tool, task.groups, task.worth.allowance, progress=task.progress)
    if proof.witness is not None:
        return None
    zones = tuple(replace(zone, loops=alike.carry_loops(zone.loops), avoided=()) for zone in op.zones)
    if any(here.loops and not there.loops for here, there in zip(op.zones, zones, strict=True)):
        return None  # what it leaves there could not be told
    found = replace(op.orientation, axis=axis, feed=_feed_there(op.orientation, alike) or op.orientation.feed,
                    gouge=proof.gouge, clearance=proof.clearance, zones=zones, map=None, lobes=(), evaluations=1,
                    reasons=(f"passes of face {op.face.label}, moved: the faces are alike",))
    return Operation(op.number, piece, op.tool, found, path, frame_of(piece, found, datum), zones)


def refuse_copy(op: Operation, piece: Face) -> Operation:
    """The operation of a face whose like in a part that is alike all around has no axis.

    Parameters
    ----------
    op : Operation
        Without a path.
    piece : Face
    """
    words = f"face {op.face.label} is alike, as is all around it, and no axis was found for it"
    none = Orientation(None, outcome="not_found", reasons=(words, *op.orientation.reasons))
    return Operation(op.number, piece, op.tool, none)


def _lay_anew(op: Operation, alike: AlikeFace, piece: Face, task: FaceProblem, axis: Array,
              datum: Array) -> Operation | None:
    """The moved axis with passes of its own."""
    try:
        found, path = evaluate_given_axis(task, axis, _feed_there(op.orientation, alike))
    except (Cancelled, OutOfWork):
        raise
    except ToolAxisError:
        return None
    if path is None:
        return None
    words = f"axis of face {op.face.label}, moved: the faces are alike"
    made = replace(found, evaluations=2, reasons=(words, *found.reasons))
    return Operation(op.number, piece, op.tool, made, path, frame_of(piece, made, datum), made.zones)


def _feed_there(found: Orientation, alike: AlikeFace) -> str | None:
    """The feed along which the moved passes run; None where that is neither."""
    linear = None if alike.rule is None else alike.rule.linear.T
    here, there = alike.original.surface, alike.face.surface
    if isinstance(here, ViewSurface) and isinstance(there, ViewSurface):
        linear = there.frame[:2] @ alike.matrix[:3, :3] @ np.linalg.inv(here.frame)[:, :2]
    if linear is None or found.feed not in FEEDS:
        return None
    along = np.abs(linear[:, FEEDS.index(found.feed)]) / np.linalg.norm(linear[:, FEEDS.index(found.feed)])
    return FEEDS[int(np.argmax(along))] if along.max() >= _ALONG else None
