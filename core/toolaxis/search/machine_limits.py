"""What a machine adds to the search: its reach from the face's own points, its steps, and the travel of passes made."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.collision.machine_collision import MachineSurroundings, free_solutions
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import CheckSurfaces
from toolaxis.feasibility.violations import FREE, LIMITS, Violation
from toolaxis.machine.limits import ROUNDING, AllOf, AxisLimits, Cone
from toolaxis.machine.setup import MachineLike, Mounting, machine_limits
from toolaxis.plan.orientation import Orientation
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.local_search import CountedAxis, count_row
from toolaxis.shape.face import Face
from toolaxis.shape.half_space import HalfSpace
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: How a reason begins that tells why the proof refused an axis.
REFUSED = "refused "
#: Places of a face, along u and v, that an axis must bring inside the machine's travel.
_PLACES = 8


def intersect_limits(machine: MachineLike | None, limits: AxisLimits | str | None) -> AxisLimits | None:
    """Limits from a machine and from further limits.

    Parameters
    ----------
    machine : Machine, AxisLimits, str or None
        Whatever `toolaxis.machine.setup.machine_limits` takes.
    limits : AxisLimits, str or None

    Raises
    ------
    InvalidInput
        When one of them is no limit.
    """
    found = [machine_limits(one) for one in (machine, limits) if one is not None]
    return AllOf(tuple(found)) if len(found) > 1 else found[0] if found else None


def limit_axes(limits: AxisLimits | None, held: HalfSpace | None) -> AxisLimits | None:
    """Limits of the axis with those of a held side: no tool comes from there, as what holds it would stand in it.

    Parameters
    ----------
    limits : AxisLimits or None
    held : HalfSpace or None
    """
    if held is None:
        return limits
    return intersect_limits(limits, Cone(-held.normal, np.pi / 2))


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


def while_moving(limits: AxisLimits | None) -> AxisLimits | None:
    """Limits of an axis that moves while it cuts: each need not bring the whole face inside the machine's travel, only
    its own place, which is asked of the path.

    Parameters
    ----------
    limits : AxisLimits or None
    """
    if isinstance(limits, AllOf):
        return AllOf(tuple(part for part in map(while_moving, limits.parts) if part is not None))
    return replace(limits, reached=np.empty((0, 3))) if isinstance(limits, Mounting) else limits


def nearest_held_axis(limits: AxisLimits | None, axis: Array) -> Array:
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


def snap_to_increments(ledger: AxisTable, found: list[CountedAxis]) -> list[CountedAxis]:
    """Candidates at axes that the machine can hold in its steps, best first; as they are where there is no machine.

    Parameters
    ----------
    ledger : AxisTable
    found : list of CountedAxis
        Best first.
    """
    mounting = mounting_of(ledger.feasibility.limits)
    if mounting is None:
        return found
    kept: list[CountedAxis] = []
    for one in found:
        axes = mounting.on_steps(one.axis)
        if len(axes) == 1:
            kept.append(replace(one, axis=axes[0]))
        elif len(axes):
            rows = ledger.look(axes)
            kept += [count_row(ledger, row) for row in range(rows.start, rows.stop) if ledger.reason[row] == FREE]
    return sorted(kept, key=lambda candidate: candidate.value)


def machine_violation(feasibility: Feasibility, path: ToolPath, groups: tuple[CheckSurfaces, ...]) -> Violation | None:
    """Why the machine cannot carry out passes, links included, as the place that decides against the axis.

    Parameters
    ----------
    feasibility : Feasibility
    path : ToolPath
        With one axis.
    groups : tuple of CheckSurfaces
        What stands around.
    """
    return out_of_travel(feasibility.limits, path) or meets_itself(feasibility, path, groups)


def meets_itself(feasibility: Feasibility, path: ToolPath, groups: tuple[CheckSurfaces, ...]) -> Violation | None:
    """What of the machine meets part, tool or itself in every solution, as the place that decides against the axis.

    Parameters
    ----------
    feasibility : Feasibility
    path : ToolPath
        With one axis, inside the travel.
    groups : tuple of CheckSurfaces
        What stands around.
    """
    mounting = mounting_of(feasibility.limits)
    around = MachineSurroundings(feasibility.tool, tuple(group.cells for group in groups),
                                 body_clearance(feasibility, groups))
    if mounting is None or not len(path.cl) or not mounting.judges_bodies:
        return None
    rows, why, distance = free_solutions(mounting, path.cl, path.axis[0], around)
    return None if len(rows) else Violation(LIMITS, ROUNDING, distance=distance, words=why)


def body_clearance(feasibility: Feasibility, groups: tuple[CheckSurfaces, ...]) -> float:
    """What bodies of the machine keep from all else, mm: the holder's clearance, and the stock on the part besides.

    Parameters
    ----------
    feasibility : Feasibility
    groups : tuple of CheckSurfaces
        What stands around.
    """
    return feasibility.tolerance.holder_clearance + max(group.stock for group in groups)


def make_room(ledger: AxisTable, axis: Array, found: Violation) -> None:
    """Forbid axes with too little room for the machine, where that is why passes were refused; see `with_room`.

    Parameters
    ----------
    ledger : AxisTable
    axis : (3,) array
    found : Violation
    """
    feasibility = ledger.feasibility
    narrower = with_room(feasibility.limits, axis, found, body_clearance(feasibility, feasibility.groups))
    if narrower is not None:
        ledger.tighten(narrower)


def better_of(one: tuple[Orientation, ToolPath | None],
              other: tuple[Orientation, ToolPath | None]) -> tuple[Orientation, ToolPath | None]:
    """The better one of a result and of another search: one that left the machine the room that passes turned out to
    need, or one for passes of another pattern.

    Parameters
    ----------
    one, other : Orientation, and the passes of its axis
        In this order; why axes were refused in the first one is told with both.
    """
    (result, path), (again, other_path) = one, other
    count = result.evaluations + again.evaluations
    if again.axis is None or (result.axis is not None and again.length * (1 + again.unreached)
                              >= result.length * (1 + result.unreached)):
        return replace(result, evaluations=count), path
    refused = tuple(why for why in result.reasons if why.startswith(REFUSED))
    return replace(again, reasons=(*again.reasons, *refused), evaluations=count), other_path


def with_room(limits: AxisLimits | None, axis: Array, found: Violation, required: float) -> AxisLimits | None:
    """Limits after passes with an axis brought bodies of the machine too close: as much more room at the points of the
    face as the passes have less of it than those; None where that is not why they were refused.

    Parameters
    ----------
    limits : AxisLimits or None
    axis : (3,) array
    found : Violation
    required : float
        mm
    """
    if isinstance(limits, AllOf):
        parts = [with_room(one, axis, found, required) for one in limits.parts]
        if all(part is None for part in parts):
            return None
        return AllOf(tuple(new or old for new, old in zip(parts, limits.parts, strict=True)))
    if not isinstance(limits, Mounting) or not found.words or not limits.judges_bodies or not len(limits.reached) \
            or not np.isfinite(found.distance):
        return None
    rows = limits.solutions(axis)
    if not len(rows) or limits.out_of_travel(limits.reached, axis):
        return None
    there = float(limits.apart(rows)[0].min(axis=1).max())
    return replace(limits, room=max(limits.room, required + min(there - found.distance, 2 * abs(limits.slack))))


def out_of_travel(limits: AxisLimits | None, path: ToolPath) -> Violation | None:
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
    return Violation(LIMITS, ROUNDING, words=f"{words} on the passes and their links") if words else None
