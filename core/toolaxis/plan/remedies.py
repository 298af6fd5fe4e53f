"""What may make a refused face possible: a longer stick-out, another cutter, several axes, no limits.

Found from what forbids most axes of the maps of operations without an axis.  A remedy is an offer, not a proof: only
planning again tells what comes of it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan, outcome_of
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Codes of `toolaxis.plan.orientation.REASONS`.
_LIMITS, _BACK, _UPRIGHT, _GOUGE, _CUTTER, _SHANK, _HOLDER = range(1, 8)
#: Diameters that cutters come in, mm; a stick-out is offered in steps of 5 mm, and no longer than so many diameters.
_DIAMETERS = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0, 32.0)
_STEP, _LONGEST = 5.0, 12.0
#: Share of the forbidden axes below which a reason is not worth a remedy; points along a side of a face.
_WORTH, _SIDE = 0.1, 9


@dataclass(frozen=True)
class Remedy:
    """An input that may help.

    Attributes
    ----------
    name : str
        "stickout", "tool", "regions" or "limits".
    value : float or str
        Stick-out, mm; short form of a cutter; "auto"; or "" for no limits.
    share : float
        Of the axes that are forbidden, those that are for what this remedies, 0 to 1.
    """

    name: str
    value: float | str
    share: float


def remedies_of(plan: Plan, divided: bool = False) -> tuple[Remedy, ...]:
    """Remedies for operations without an axis, the most promising first.

    Parameters
    ----------
    plan : Plan
        None are known for one with several tools: it has chosen among them already.
    divided : bool
        Whether faces are divided into sub-surfaces already, or axes found in another way than face by face.
    """
    lost = [op for op in plan.operations if _is_lost(op, plan)]
    if not lost or len(plan.tools) > 1:
        return ()
    counts = np.zeros(_HOLDER + 1)
    for op in lost:
        if op.orientation.map is not None:
            counts += np.bincount(op.orientation.map.reason, minlength=len(counts))[:len(counts)]
    bare = [op for op in lost if op.orientation.map is None]
    whole = float(counts[1:].sum())
    shares = counts / whole if whole else counts
    if bare and not whole:
        shares[_BACK] = 1.0  # no axis was worth looking at: the normals spread too far
    found = [*_longer(plan, lost, float(shares[_SHANK] + shares[_HOLDER])),
             *_slimmer(plan.tools[0], float(shares[_GOUGE] + shares[_CUTTER])),
             *_ball(plan.tools[0], float(shares[_UPRIGHT]))]
    if not divided:
        found.append(Remedy("regions", "auto", float(shares[_BACK])))
    if plan.inputs.limits:  # those of a machine are no choice
        found.append(Remedy("limits", "", float(shares[_LIMITS])))
    return tuple(sorted((one for one in found if one.share >= _WORTH), key=lambda one: -one.share))


def _is_lost(op: Operation, plan: Plan) -> bool:
    """Whether an operation has no axis, needs one, and was looked at to the end."""
    return (not op.done and op.orientation.outcome in ("infeasible", "not_found")
            and outcome_of([op], plan.blades) != "complete")


def _longer(plan: Plan, lost: Sequence[Operation], share: float) -> list[Remedy]:
    """A stick-out with which the holder stays above everything where the tool stands along the mean normal."""
    tool = plan.tools[0]
    if tool.stickout is None or "holder" not in tool.outlines:
        return []
    boxes = [face.box for body in (plan.part, *plan.obstacles) for face in body.faces]
    corners = np.array([[box[i, 0], box[j, 1], box[k, 2]] for box in boxes for i in (0, 1) for j in (0, 1)
                        for k in (0, 1)])
    needed = 0.0
    for op in lost:
        points, normal = _points_of(op)
        needed = max(needed, float((corners @ normal).max() - (points @ normal).min()))
    needed = _STEP * ceil((needed + plan.inputs.tolerance.holder_clearance) / _STEP)
    if not tool.stickout < needed <= _LONGEST * 2 * tool.radius:
        return []
    return [Remedy("stickout", needed, share)]


def _points_of(op: Operation) -> tuple[Array, Array]:
    """Points of a face, (n, 3) mm, and its mean normal."""
    side = np.linspace(0.0, 1.0, _SIDE)
    uv = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    inside = uv[op.face.contains(uv)]
    uv = inside if len(inside) else uv
    mean = op.face.normal(uv).mean(axis=0)
    size = float(np.linalg.norm(mean))
    return op.face.evaluate(uv).point, mean / size if size > 1e-9 else np.array([0.0, 0.0, 1.0])


def _slimmer(tool: Tool, share: float) -> list[Remedy]:
    """A ball end of at most two thirds of the diameter."""
    size = max((one for one in _DIAMETERS if one <= 4 / 3 * tool.radius + 1e-9), default=None)
    return [] if size is None else [Remedy("tool", f"ball:{size:g}", share)]


def _ball(tool: Tool, share: float) -> list[Remedy]:
    """A ball end of the same diameter, which may stand upright, for a cutter with a flat bottom."""
    return [Remedy("tool", f"ball:{2 * tool.radius:g}", share)] if tool.flat_radius > 0 else []
