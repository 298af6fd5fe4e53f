"""What may make a refused face possible: a longer stick-out, another cutter, several axes, a tolerance, no limits.

Found from what forbids most axes of the maps of operations without an axis, and from what the sentences advise that say
why there is none (`toolaxis.advice`).  A remedy is an offer, not a proof: only planning again tells what comes of it.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from toolaxis import advice
from toolaxis.numeric.grids import grid_rows
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan, outcome_of
from toolaxis.plan.tally import counts_of
from toolaxis.tolerances import GREATEST
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Codes of `toolaxis.plan.orientation.REASONS`.
_LIMITS, _BACK, _UPRIGHT, _GOUGE, _CUTTER, _SHANK, _HOLDER = range(1, 8)
#: Diameters that cutters come in, mm; a stick-out is offered in steps of 5 mm, and no longer than so many diameters.
_DIAMETERS = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0, 32.0)
_STEP, _LONGEST = 5.0, 12.0
#: Share of the forbidden axes below which a reason is not worth a remedy; points along a side of a face.
_WORTH, _SIDE = 0.1, 9
#: Values that are offered for scallop height and tolerance, mm.
_HEIGHTS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
#: What sentences advise, and the input that it is.
_ADVICE = {advice.LARGER_TOLERANCE: "tolerance", advice.SMALLER_CORNER: "corner", advice.SMALLER_CUTTER: "slimmer",
           advice.SMALLER_ONE: "slimmer", advice.SMALLER_TOOL: "slimmer", advice.SLIMMER_TOOL: "slimmer",
           advice.LONGER_STICKOUT: "longer", advice.LONGER_TOOL: "longer", advice.LARGER_SCALLOP: "coarser",
           advice.GREATER_SCALLOP: "coarser", advice.COARSER_SCALLOP: "coarser", advice.SMALLER_SCALLOP: "finer",
           advice.DIVIDE: "divide"}
_OUT = re.compile(f"([0-9.]+) {advice.STANDS_OUT}")


@dataclass(frozen=True)
class Remedy:
    """An input that may help.

    Attributes
    ----------
    name : str
        "stickout", "tool", "regions", "limits", "tolerance" or "scallop".
    value : float or str
        Stick-out, tolerance or scallop height, mm; short form of a cutter; "auto"; or "" for no limits.
    share : float
        Of the axes that are forbidden, those that are for what this remedies, 0 to 1; 1 for what a sentence advises.
    """

    name: str
    value: float | str
    share: float


def remedies_of(plan: Plan, divided: bool = False) -> tuple[Remedy, ...]:
    """Remedies for operations without an axis, the most promising first, and those that a sentence advises before all.

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
    advised = remedies_advised((why for op in lost for why in op.orientation.reasons), plan.tools[0],
                               (plan.inputs.scallop, plan.inputs.tolerance.gouge), divided)
    found = _by_maps(plan, lost, divided)
    known = {one.name for one in found}
    found += [one for one in advised if one.name not in known]
    return tuple(sorted(found, key=lambda one: -one.share))


def _by_maps(plan: Plan, lost: Sequence[Operation], divided: bool) -> list[Remedy]:
    """Remedies for what forbids most axes."""
    counts = np.zeros(_HOLDER + 1)
    for op in lost:
        counts += _counts_of(op)
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
    return [one for one in found if one.share >= _WORTH]


def _counts_of(op: Operation) -> Array:
    """How many axes are forbidden for each reason: by the map, else by the sentences."""
    found = op.orientation.map
    if found is not None:
        return np.bincount(found.reason, minlength=_HOLDER + 1)[:_HOLDER + 1].astype(float)
    return counts_of(op.orientation.reasons)


def remedies_advised(sentences: Iterable[str], tool: Tool, heights: tuple[float, float],
                     divided: bool = False) -> tuple[Remedy, ...]:
    """What sentences advise, as inputs: those of a plan, or the message of an error.

    Parameters
    ----------
    sentences : iterable of str
        English.
    tool : Tool
        The tool that was planned with.
    heights : (float, float)
        Scallop height and machining tolerance, mm.
    divided : bool
        Whether faces are divided already.

    Returns
    -------
    tuple of Remedy
        Each kind once, in the order of the sentences.
    """
    scallop, tolerance = heights
    found: dict[str, Remedy] = {}
    for text in sentences:
        out = max([tolerance, *(float(value) for value in _OUT.findall(text))])
        known = {"tolerance": _larger("tolerance", out, GREATEST), "corner": _sharper(tool),
                 "slimmer": _slimmer(tool, 1.0), "longer": _half_longer(tool),
                 "coarser": _larger("scallop", scallop, tool.radius / 2), "finer": _finer(scallop, tool),
                 "divide": [] if divided else [Remedy("regions", "auto", 1.0)]}
        for words, kind in _ADVICE.items():
            if words in text:
                for one in known[kind]:
                    found.setdefault(one.name, one)
    return tuple(found.values())


def _larger(name: str, value: float, most: float) -> list[Remedy]:
    """The next usual height above a value, as far as one may go."""
    higher = min((one for one in _HEIGHTS if one > value + 1e-9), default=None)
    return [] if higher is None or higher > most + 1e-9 else [Remedy(name, higher, 1.0)]


def _finer(scallop: float, tool: Tool) -> list[Remedy]:
    """The next usual scallop height below, far below the radius of the cutter."""
    lower = max((one for one in _HEIGHTS if one < scallop - 1e-9 and one <= tool.radius / 10), default=None)
    return [] if lower is None else [Remedy("scallop", lower, 1.0)]


def _sharper(tool: Tool) -> list[Remedy]:
    """A bull nose of the same diameter with half the corner radius."""
    if tool.kind != "torus" or tool.flat_radius == 0:
        return []
    return [Remedy("tool", f"torus:{2 * tool.radius:g}x{tool.corner_radius / 2:g}", 1.0)]


def _half_longer(tool: Tool) -> list[Remedy]:
    """Half as much stick-out again, in steps."""
    if tool.stickout is None or "holder" not in tool.outlines:
        return []
    longer = _STEP * ceil(1.5 * tool.stickout / _STEP)
    return [Remedy("stickout", longer, 1.0)] if longer <= _LONGEST * 2 * tool.radius else []


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
    uv = grid_rows(side, side)
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
