"""What a machine adds to the search: its reach from the face's own points, its steps, and the travel of passes made."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.machine.limits import ROUNDING, AllOf, AxisLimits
from toolaxis.machine.mounting import Mounting
from toolaxis.orient.ledger import Ledger
from toolaxis.orient.polish import Candidate, counted
from toolaxis.orient.verdicts import FREE, LIMITS, Witness
from toolaxis.shape.face import Face
from toolaxis.tools.assembly import Tool

Array = NDArray[np.float64]

#: Places of a face, along u and v, that an axis must bring inside the machine's travel.
_PLACES = 8


def mounting_of(limits: AxisLimits | None) -> Mounting | None:
    """The machine among limits, if there is one.

    Parameters
    ----------
    limits : AxisLimits or None
    """
    if isinstance(limits, AllOf):
        return next(filter(None, map(mounting_of, limits.parts)), None)
    return limits if isinstance(limits, Mounting) else None


def at_face(limits: AxisLimits | None, face: Face, tool: Tool) -> AxisLimits | None:
    """Limits with the machine made to reach a face with a tool.

    Parameters
    ----------
    limits : AxisLimits or None
    face : Face
    tool : Tool
        Its length to the gauge point is that of cutter, stick-out and holder; not known without a holder.
    """
    if isinstance(limits, AllOf):
        return AllOf(tuple(part for part in (at_face(one, face, tool) for one in limits.parts) if part is not None))
    if not isinstance(limits, Mounting):
        return limits
    if limits.tool_length is None and tool.gauge_length is not None:
        limits = replace(limits, tool_length=tool.gauge_length)
    points = np.concatenate([face.evaluate(uv).point for uv in (face.grid(_PLACES, _PLACES), *face.outline) if len(uv)])
    return limits.reaching(points, 2 * tool.radius)  # a tip is no farther than that from its contact


def held_axis(limits: AxisLimits | None, axis: Array) -> Array:
    """The axis nearest to one that the machine among limits holds in its steps; itself where there is none.

    Parameters
    ----------
    limits : AxisLimits or None
    axis : (3,) array
        Unit vector.
    """
    mounting = mounting_of(limits)
    near = np.empty((0, 3)) if mounting is None else mounting.on_steps(axis)
    return near[0] if len(near) else axis


def held(ledger: Ledger, found: list[Candidate]) -> list[Candidate]:
    """Candidates at axes that the machine can hold in its steps, best first; as they are where there is no machine.

    Parameters
    ----------
    ledger : Ledger
    found : list of Candidate
        Best first.
    """
    mounting = mounting_of(ledger.feasibility.limits)
    if mounting is None:
        return found
    kept: list[Candidate] = []
    for one in found:
        axes = mounting.on_steps(one.axis)
        if len(axes) == 1:
            kept.append(replace(one, axis=axes[0]))
        elif len(axes):
            rows = ledger.look(axes)
            kept += [counted(ledger, row) for row in range(rows.start, rows.stop) if ledger.reason[row] == FREE]
    return sorted(kept, key=lambda candidate: candidate.value)


def out_of_travel(limits: AxisLimits | None, path: ToolPath) -> Witness | None:
    """Which linear axis leaves its travel on passes, links included, as the place that decides against the axis.

    Parameters
    ----------
    limits : AxisLimits or None
    path : ToolPath
        With one axis.
    """
    mounting = mounting_of(limits)
    if mounting is None or not len(path.cl):
        return None
    words = mounting.out_of_travel(path.cl, path.axis[0])
    return Witness(LIMITS, ROUNDING, words=f"{words} on the passes and their links") if words else None
