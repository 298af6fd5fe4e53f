"""Contacts of plans that were read from their folders: their CL files hold only tips and axes."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.contact_from_cl import contacts_of
from toolaxis.contact.strip.width import strip_width
from toolaxis.plan.choices import ISO
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan

Array = NDArray[np.float64]

#: mm: a contact counts where the tip that follows from it is no farther from the one in the file, besides what tips are
#: set deeper on hollow stretches.
_NEAR = 1e-4
#: Widths are looked at so far apart at most, as a share of the sub-surface's diagonal.
_APART = 0.015


def with_contacts(plan: Plan, numbers: frozenset[int] | None = None) -> Plan:
    """A plan whose paths know their contacts; those of a plan that was made and not read stay as they are.

    Parameters
    ----------
    plan : Plan
    numbers : frozenset of int, optional
        Operations that matter; all unless given.
    """
    operations = []
    for op in plan.operations:
        matters = numbers is None or op.number in numbers
        operations.append(_add_contacts(plan, op) if matters else op)
    return replace(plan, operations=tuple(operations))


def _add_contacts(plan: Plan, op: Operation) -> Operation:
    path = op.path
    if path is None or not np.array_equal(path.cc, path.cl):
        return op
    touching = _find_contacts(plan, op, path)
    cc = path.cc.copy()
    normal = path.normal.copy()
    cc[touching.rows] = op.face.evaluate(touching.uv).point
    normal[touching.rows] = op.face.normal(touching.uv)
    return replace(op, path=replace(path, cc=cc, normal=normal))


class _ContactRows(NamedTuple):
    """Rows of a path at which the tool touches the face or its continuation, (n,), and parameters there, (n, 2)."""

    rows: NDArray[np.int64]
    uv: Array


def _find_contacts(plan: Plan, op: Operation, path: ToolPath) -> _ContactRows:
    is_cut = path.kind == Motion.CUT
    begins_cut = np.append(is_cut[1:], False)
    rows = np.flatnonzero(is_cut | begins_cut)
    found = contacts_of(op.face, op.tool, path.cl[rows], path.axis[rows], plan.inputs.allowance_of(op.face))
    is_near = found.off <= _NEAR + plan.inputs.tolerance.chord_for(plan.inputs.scallop)
    return _ContactRows(rows[is_near], found.uv[is_near])


def widths_along(plan: Plan, op: Operation) -> list[tuple[Array, Array]]:
    """Strip widths along the passes of an operation with a fixed axis, on the face.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.

    Returns
    -------
    list of ((n, 3) array, (n,) array)
        Contact points of each pass, mm, and the strip width there, mm.
    """
    axis, path = op.orientation.axis, op.path
    assert axis is not None and path is not None
    rows, uv = _find_contacts(plan, op, path)
    points = op.face.evaluate(uv).point
    # A contact goes on the one before where the tool cuts from there to it.
    goes_on = (np.diff(rows) == 1) & (path.kind[rows[1:]] == Motion.CUT)
    firsts = np.flatnonzero(~np.append(False, goes_on))
    ends = np.flatnonzero(~np.append(goes_on, False)) + 1
    lines = []
    for first, end in zip(firsts, ends, strict=True):
        dense = _fill_gaps(uv[first:end], points[first:end], _APART * op.face.diagonal)
        on_face = dense[op.face.contains(dense)]
        if len(on_face) > 1:
            along = op.face.evaluate(on_face).point
            feed = op.orientation.feed if op.orientation.pattern == ISO else np.gradient(along, axis=0)
            sides = strip_width(op.face, op.tool, on_face, axis, plan.inputs.scallop, feed)
            lines.append((along, sides.sum(axis=1)))
    return lines


def _fill_gaps(uv: Array, points: Array, most: float) -> Array:
    """Parameters with others between them where points are farther apart than a bound."""
    gaps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    counts = np.maximum(np.ceil(gaps / most), 1).astype(np.int64)
    pieces = []
    for start, end, count in zip(uv[:-1], uv[1:], counts, strict=True):
        shares = np.arange(count)[:, None] / count
        pieces.append(start + shares * (end - start))
    return np.concatenate([*pieces, uv[-1:]])
