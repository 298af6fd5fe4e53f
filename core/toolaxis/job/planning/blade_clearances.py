"""How near the tool comes to what stands around: to neighbouring blades, to the hub, and where it is tightest."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.queries import lower_bounds, motions, segment_motions
from toolaxis.feasibility.surroundings import OTHER, CheckSurfaces, group_surroundings
from toolaxis.plan.blades import BladeClearance, Blades
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.path_check import COMPONENTS
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Distances beyond this are not told apart, mm; and how exactly the others are told.
MOST, ROUGH = 20.0, 0.005
#: Motions that are looked at together, and positions of the tool along one.
_BATCH, _STEPS = 400, 400
_CUTTER = 0
_HUB = "hub"


@dataclass(frozen=True, eq=False)
class ClosestMotion:
    """The motion in which a component of the tool comes nearest to what it must keep clear of.

    Attributes
    ----------
    operation : Operation
    component : str
        "cutter", "shank" or "holder".
    distance : float
        Lower bound, mm.
    face : int
        Number of the face that it is nearest to.
    place : (3,) array
        A point near the nearest place of that face, mm.
    tip : (3,) array
        Where the tool's tip is then, mm.
    """

    operation: Operation
    component: str
    distance: float
    face: int
    place: Array
    tip: Array


def with_rooms(plan: Plan, progress: Progress = NO_PROGRESS) -> Plan:
    """A plan with blades, with the least distances to the neighbouring blades and to the hub.

    Parameters
    ----------
    plan : Plan
        With blades.
    progress : Progress
    """
    blades = plan.blades
    assert blades is not None
    beside = sorted({1, len(blades.blades) - 1})
    neighbours = tuple(plan.part.face(number) for k in beside for number in blades.blades[k].numbers)
    hub = tuple(plan.part.face(number) for number in blades.hub)
    clearances: list[BladeClearance] = []
    for name, faces in (("neighbouring blade", neighbours), (_HUB, hub)):
        progress.report(f"clearance to the {name}", 0, 1)
        clearances += _clearances_to(name, faces, plan, blades)
    return replace(plan, blades=replace(blades, room=tuple(clearances)))


def _clearances_to(name: str, faces: tuple[Face, ...], plan: Plan, blades: Blades) -> list[BladeClearance]:
    """The least distance of each component to some faces, in all operations on the first blade."""
    outlines = {component for op in plan.operations for component in op.tool.outlines}
    known = [c for c, component in enumerate(COMPONENTS) if component in {"cutter", *outlines}]
    best = {c: BladeClearance(name, COMPONENTS[c], MOST) for c in known}
    operations = [op for op in plan.operations if op.done and blades.blade_of(op.face.number) == 1]
    if not faces or not operations:
        return []
    group = CheckSurfaces(OTHER, faces, np.zeros(3))
    for op in operations:
        is_joined = name == _HUB and _is_joined_to_hub(op, plan, blades)
        is_grazed = name == _HUB and _is_grazed_by_skin(op, plan, blades)
        has_cutter = not is_joined
        asked = [c for c in known if COMPONENTS[c] in op.tool.outlines or (c == _CUTTER and has_cutter)]
        below = {c: best[c].distance for c in asked}
        for c, nearest in _nearest(op, group, below).items():
            if c == _CUTTER and is_grazed:
                proven = -op.orientation.gouge
            else:
                proven = op.orientation.clearance[COMPONENTS[c]]
            best[c] = BladeClearance(name, COMPONENTS[c], max(nearest.distance, proven), op.number, nearest.face)
    return list(best.values())


def _is_joined_to_hub(op: Operation, plan: Plan, blades: Blades) -> bool:
    """Whether what an operation machines is of the hub, or goes over into it."""
    number = op.face.number
    machined = {number, *plan.part.neighbours(number, "tangent")}
    return bool(machined & set(blades.hub))


def _is_grazed_by_skin(op: Operation, plan: Plan, blades: Blades) -> bool:
    """Whether the skin that an operation may touch has faces of the hub."""
    number = op.face.number
    skin = blades.apart(plan.part, number).skin(number)
    return any(face.number in blades.hub for face in skin)


class _Nearest(NamedTuple):
    """Where a component comes nearest to a group: how near, mm, to which face, in which motion, (3, 3)."""

    distance: float
    face: int
    motion: Array


def _nearest(op: Operation, group: CheckSurfaces, below: dict[int, float]) -> dict[int, _Nearest]:
    """Where components come nearer to a group than a distance each."""
    assert op.path is not None
    moves = segment_motions(op.path.cl, op.path.axis[0])
    limits = _ask_for(group, list(below))
    best = np.array([below.get(c, 0.0) for c in range(3)])
    found: dict[int, _Nearest] = {}
    for first in range(0, len(moves), _BATCH):
        batch = moves[first:first + _BATCH]
        bounds = lower_bounds(group.cells, op.tool, batch, best, ROUGH, limits)
        for c in below:
            i = int(bounds.lower[:, c].argmin())
            k = int(bounds.face[i, c])
            if k >= 0 and bounds.lower[i, c] < best[c] - ROUGH:
                best[c] = float(bounds.lower[i, c])
                found[c] = _Nearest(best[c] - ROUGH, group.faces[k].number, batch[i])
    return found


def _ask_for(group: CheckSurfaces, components: list[int]) -> Array:
    """Limits with which bounds of distances are found for some components only, (faces, 3) mm."""
    limits = np.full((len(group.faces), 3), -np.inf)
    limits[:, components] = 0.0
    return limits


class _Position(NamedTuple):
    """A point that the tool is near to, and where its tip is then, (3,) mm each."""

    place: Array
    tip: Array


def _nearest_position(tool: Tool, group: CheckSurfaces, move: Array, component: int) -> _Position:
    """Where on a motion a component is nearest to a group."""
    middle, half_way, axis = move
    shares = np.linspace(-1.0, 1.0, _STEPS)[:, None]
    tips = middle + shares * half_way
    bounds = lower_bounds(group.cells, tool, motions(tips, axis), 2 * MOST, ROUGH / 10, _ask_for(group, [component]))
    k = int(bounds.lower[:, component].argmin())
    return _Position(bounds.point[k, component], tips[k])


def tightest(plan: Plan, progress: Progress = NO_PROGRESS) -> ClosestMotion | None:
    """Where a component comes nearest to what it must keep clear of; None where nothing is nearer than `MOST`.

    The cutter's distance to the machined skin and to what meets it harmlessly does not count.  Of turned copies only
    the originals are looked at.

    Parameters
    ----------
    plan : Plan
    progress : Progress
    """
    least = _least_proven(plan)
    if least is None:
        return None
    progress.report("the tightest place", 0, 1)
    op, component = least.operation, least.component
    obstacles = [face for body in plan.obstacles for face in body.faces]
    tolerance = plan.inputs.tolerance.for_cutter(op.tool.radius)
    allowance = plan.inputs.allowance_of(op.face)
    around = plan.part_around(op.face.number)
    best: ClosestMotion | None = None
    for group in group_surroundings(op.face, tolerance, allowance, part=around, obstacles=obstacles):
        if component == _CUTTER and group.role != OTHER:
            continue
        limit = least.distance + 10 * ROUGH if best is None else best.distance
        nearest = _nearest(op, group, {component: limit}).get(component)
        if nearest is not None:
            distance = max(nearest.distance, least.distance)  # what is proven is finer
            position = _nearest_position(op.tool, group, nearest.motion, component)
            best = ClosestMotion(op, COMPONENTS[component], distance, nearest.face, *position)
    return best


class _ProvenClearance(NamedTuple):
    """What the proof of an operation's passes found of a component, mm."""

    distance: float
    component: int
    operation: Operation


def _least_proven(plan: Plan) -> _ProvenClearance | None:
    """The least clearance of all components and operations; None where all are so great that they are not told apart.
    """
    copies = {} if plan.blades is None else plan.blades.copies
    found = []
    for op in plan.operations:
        if not op.done or op.number in copies:
            continue
        for c, component in enumerate(COMPONENTS):
            distance = op.orientation.clearance.get(component, np.inf)
            if distance < MOST - 2 * ROUGH:
                found.append(_ProvenClearance(distance, c, op))
    return min(found, key=lambda one: (one.distance, one.component, one.operation.number), default=None)
