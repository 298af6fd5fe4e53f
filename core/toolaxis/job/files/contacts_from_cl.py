"""Contacts of plans that were read from their folders: their CL files hold only tips and axes."""

from dataclasses import replace

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
    return replace(plan, operations=tuple(_known(plan, op) if numbers is None or op.number in numbers else op
                                          for op in plan.operations))


def _known(plan: Plan, op: Operation) -> Operation:
    path = op.path
    if path is None or not np.array_equal(path.cc, path.cl):
        return op
    rows, uv = _touching(plan, op, path)
    cc, normal = path.cc.copy(), path.normal.copy()
    cc[rows], normal[rows] = op.face.evaluate(uv).point, op.face.normal(uv)
    return replace(op, path=replace(path, cc=cc, normal=normal))


def _touching(plan: Plan, op: Operation, path: ToolPath) -> tuple[NDArray[np.int64], Array]:
    """Rows of a path at which the tool touches the face or its continuation, and the parameters there."""
    cutting = path.kind == Motion.CUT
    rows = np.flatnonzero(cutting | np.append(cutting[1:], False))
    found = contacts_of(op.face, op.tool, path.cl[rows], path.axis[rows], plan.inputs.allowance_of(op.face))
    near = found.off <= _NEAR + plan.inputs.tolerance.chord_for(plan.inputs.scallop)
    return rows[near], found.uv[near]


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
    rows, uv = _touching(plan, op, path)
    points = op.face.evaluate(uv).point
    follows = (np.diff(rows) == 1) & (path.kind[rows[1:]] == Motion.CUT)
    lines = []
    for first, last in zip(np.flatnonzero(~np.append(False, follows)), np.flatnonzero(~np.append(follows, False)),
                           strict=True):
        dense = _dense(uv[first:last + 1], points[first:last + 1], _APART * op.face.diagonal)
        dense = dense[op.face.contains(dense)]
        if len(dense) > 1:
            along = op.face.evaluate(dense).point
            feed = op.orientation.feed if op.orientation.pattern == ISO else np.gradient(along, axis=0)
            width = strip_width(op.face, op.tool, dense, axis, plan.inputs.scallop, feed).sum(axis=1)
            lines.append((along, width))
    return lines


def _dense(uv: Array, points: Array, most: float) -> Array:
    """Parameters with others between them where points are farther apart than a bound."""
    counts = np.maximum(np.ceil(np.linalg.norm(np.diff(points, axis=0), axis=1) / most), 1).astype(np.int64)
    pieces = [a + np.arange(count)[:, None] / count * (b - a) for a, b, count in
              zip(uv[:-1], uv[1:], counts, strict=True)]
    return np.concatenate([*pieces, uv[-1:]])
