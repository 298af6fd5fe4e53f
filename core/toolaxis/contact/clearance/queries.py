"""Distances and verdicts for many tool positions or motions at once, by the kernel or by its plain twin."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.clearance.branch_and_bound import ToolData, descend_many, scratch
from toolaxis.contact.clearance.branch_and_bound_numpy import descend_many_numpy
from toolaxis.contact.clearance.relief import no_relief
from toolaxis.errors import InvalidInput
from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.shares import share_out
from toolaxis.numeric.vectors import as_rows
from toolaxis.progress import breathe
from toolaxis.shape.bounding.bounding_tree import BoundingTree
from toolaxis.tools.tool import Tool
from toolaxis.work import spend

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_PIECES_AT_ONCE = 60
#: Motions of a share.
_MOTIONS_AT_ONCE = 256
#: As many bounds as take as long as a question without any motion, and a motion without any bound.
_QUESTION, _MOTION = 2000, 20


class DistanceBounds(NamedTuple):
    """Answers for n positions or motions.

    lower : (n, 3) lower bounds of the signed distance of cutter, shank and holder, mm;
    face : (n, 3) index of the nearest face, -1 where nothing is nearer than the cutoff;
    point : (n, 3, 3) a point of a cell near the nearest place, by component;
    blocked : (n,) component that was not proven to keep its limits, -1 where all do (only when deciding);
    looked : (n,) number of cells looked at.
    """

    lower: Array
    face: Indices
    point: Array
    blocked: Indices
    looked: Indices


def motions(tips: ArrayLike, axis: ArrayLike) -> Array:
    """Standing tools as motions of no length, (n, 3, 3): tip, zero, axis.

    Parameters
    ----------
    tips : (n, 3) array_like
        mm
    axis : (3,) or (n, 3) array_like
        Unit vectors, tip to spindle.

    Raises
    ------
    InvalidInput
        When shapes do not fit, numbers are not finite, or an axis is not a unit vector.
    """
    rows = as_rows(tips, 3, "tool tips")
    return np.stack([rows, np.zeros_like(rows), _axes(axis, len(rows))], axis=1)


def segment_motions(tips: ArrayLike, axis: ArrayLike) -> Array:
    """Straight motions from each tip to the next, (n - 1, 3, 3): middle, half of the way, axis.

    Parameters
    ----------
    tips : (n, 3) array_like
        mm
    axis : (3,) or (n - 1, 3) array_like
        Unit vectors; the axis does not turn within a motion.

    Raises
    ------
    InvalidInput
        When shapes do not fit, numbers are not finite, or an axis is not a unit vector.
    """
    rows = as_rows(tips, 3, "tool tips")
    middle = (rows[1:] + rows[:-1]) / 2
    half_way = (rows[1:] - rows[:-1]) / 2
    return np.stack([middle, half_way, _axes(axis, len(middle))], axis=1)


def _axes(axis: ArrayLike, count: int) -> Array:
    rows = as_rows(axis, 3, "axis")
    if len(rows) not in (1, count):
        raise InvalidInput(f"{len(rows)} axes are given for {count} positions: give one, or one for each")
    off = np.abs(np.einsum("ij,ij->i", rows, rows) - 1)
    if off.size and off.max() > 1e-9:
        i = int(np.argmax(off))
        raise InvalidInput(f"axis {i} is {rows[i].tolist()}: it must have length 1")
    return np.broadcast_to(rows, (count, 3))


def lower_bounds(cells: BoundingTree, tool: Tool, moves: Array, cutoff: ArrayLike, resolution: float,
                 required: Array | None = None) -> DistanceBounds:
    """Lower bounds of the distances, at most ``resolution`` (and the faces' tolerance) below the true ones.

    Depths beyond 0.1 mm are only told to a twentieth.

    Parameters
    ----------
    cells : BoundingTree
    tool : Tool
    moves : (n, 3, 3) array
        From `motions` or `segment_motions`.
    cutoff : float or (3,) array_like
        Greater distances are answered with this, mm.
    resolution : float
        mm
    required : (faces, 3) array, optional
        Only which pairs are left out (-inf) counts here.
    """
    if required is None:
        limits = np.zeros((len(cells.faces), 3))
    else:
        limits = np.where(np.isneginf(required), -np.inf, 0.0)
    cutoffs = np.broadcast_to(np.asarray(cutoff, dtype=float), 3)
    return _run(cells, tool, moves, limits, cutoffs, resolution)


def keeps_limits(cells: BoundingTree, tool: Tool, moves: Array, required: Array) -> DistanceBounds:
    """Whether every component is proven to keep its limits: ``blocked`` is -1 there.

    Parameters
    ----------
    cells : BoundingTree
    tool : Tool
    moves : (n, 3, 3) array
        From `motions` or `segment_motions`.
    required : (faces, 3) array
        Least signed distances, mm; -inf leaves a pair out.
    """
    limits = np.ascontiguousarray(required)
    everywhere = np.full(3, np.inf)
    return _run(cells, tool, moves, limits, everywhere, -1.0)


def _run(cells: BoundingTree, tool: Tool, moves: Array, limits: Array, cutoff: Array,
         resolution: float) -> DistanceBounds:
    """Answers for all pieces of a tool that are asked for, some pieces at a time."""
    asked = np.asarray((limits > -np.inf).any(axis=0))
    component = tool.pieces[:, 7].astype(int)
    pieces = tool.pieces[asked[component]]
    relief = no_relief(len(cells.faces)) if cells.mismatch is None else cells.mismatch.plain
    total = _nothing_near(len(moves), cutoff)
    for first in range(0, len(pieces), _PIECES_AT_ONCE):
        some = np.ascontiguousarray(pieces[first:first + _PIECES_AT_ONCE])
        lowest = float(some[:, 4].min())
        widest = np.maximum(some[:, 0] + some[:, 1], some[:, 6])
        shape = (lowest, float(widest.max()), resolution)
        with_highest = np.vstack([limits, limits.max(axis=0)])
        values, tags = _descend_cells(cells, (some, with_highest, shape, relief), moves, cutoff)
        points = values[:, 1:].transpose(0, 2, 1)
        blocked, looked = tags[:, 3:].T
        found = DistanceBounds(values[:, 0], tags[:, :3], points, blocked, looked)
        total = _merge_bounds(total, found)
    return total


def _nothing_near(n: int, cutoff: Array) -> DistanceBounds:
    """Answers for n motions that nothing comes near to."""
    lower = np.tile(cutoff, (n, 1))
    face = np.full((n, 3), -1)
    blocked = np.full(n, -1)
    looked = np.zeros(n, int)
    return DistanceBounds(lower, face, np.zeros((n, 3, 3)), blocked, looked)


def _descend_cells(cells: BoundingTree, tool: ToolData, moves: Array, cutoff: Array) -> tuple[Array, Indices]:
    moves = np.ascontiguousarray(moves)
    cutoff = np.ascontiguousarray(cutoff)
    values = np.empty((len(moves), 4, 3))
    tags = np.empty((len(moves), 5), dtype=np.int64)
    spend(_QUESTION)

    def _descend(some: slice) -> None:
        if _compiled.available:
            room = scratch(cells.most_edges)
            descend_many(cells.data, tool, (moves[some], cutoff), room, (values[some], tags[some]))
        else:
            values[some], tags[some] = descend_many_numpy(cells, tool, moves[some], cutoff)

    for some in share_out(_descend, len(moves), _MOTIONS_AT_ONCE):
        breathe()
        looked = float(tags[some, 4].sum())
        spend(_MOTION * len(moves[some]) + looked)
    return values, tags


def _merge_bounds(one: DistanceBounds, other: DistanceBounds) -> DistanceBounds:
    nearer = (other.lower < one.lower) | (one.face < 0)
    lower = np.minimum(one.lower, other.lower)
    face = np.where(nearer, other.face, one.face)
    point = np.where(nearer[..., None], other.point, one.point)
    blocked = np.where(one.blocked < 0, other.blocked, one.blocked)
    return DistanceBounds(lower, face, point, blocked, one.looked + other.looked)
