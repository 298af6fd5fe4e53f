"""How near the tool comes to what stands around: to neighbouring blades, to the hub, and where it is tightest."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.queries import DistanceBounds, lower_bounds, motions, segment_motions
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
_BATCH, _STEPS = 400, 400


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
    neighbours = [plan.part.face(n) for k in sorted({1, len(blades.blades) - 1}) for n in blades.blades[k].numbers]
    hub = [plan.part.face(n) for n in blades.hub]
    rooms = []
    for name, faces in (("neighbouring blade", neighbours), ("hub", hub)):
        progress.report(f"clearance to the {name}", 0, 1)
        rooms += list(_rooms(plan, blades, name, tuple(faces)))
    return replace(plan, blades=replace(blades, room=tuple(rooms)))


def _rooms(plan: Plan, blades: Blades, to: str, faces: tuple[Face, ...]) -> Iterator[BladeClearance]:
    outlines = {name for op in plan.operations for name in op.tool.outlines}
    known = [c for c, name in enumerate(COMPONENTS) if name in {"cutter", *outlines}]
    best = {c: BladeClearance(to, COMPONENTS[c], MOST) for c in known}
    own = [op for op in plan.operations if op.done and blades.blade_of(op.face.number) == 1]
    if not faces or not own:
        return
    group = CheckSurfaces(OTHER, faces, np.zeros(3))
    for op in own:
        machined = {op.face.number, *plan.part.neighbours(op.face.number, "tangent")}
        joined = to == "hub" and bool(machined & set(blades.hub))
        asked = [c for c in known if COMPONENTS[c] in op.tool.outlines or (c == 0 and not joined)]
        grazed = to == "hub" and any(face.number in blades.hub for face in
                                     blades.apart(plan.part, op.face.number).skin(op.face.number))
        for c, (value, face, _, _) in _nearest(op, group, {c: best[c].distance for c in asked}).items():
            proven = -op.orientation.gouge if c == 0 and grazed else op.orientation.clearance[COMPONENTS[c]]
            best[c] = BladeClearance(to, COMPONENTS[c], max(value, proven), op.number, face)
    yield from (best[c] for c in known)


def _nearest(op: Operation, group: CheckSurfaces,
             below: dict[int, float]) -> dict[int, tuple[float, int, Array, Array]]:
    """Where components come nearer to a group than a distance each: how near, to which face, its place, the motion."""
    assert op.path is not None
    moves = segment_motions(op.path.cl, op.path.axis[0])
    asked = np.full((len(group.faces), 3), -np.inf)
    asked[:, list(below)] = 0.0
    best = np.array([below.get(c, 0.0) for c in range(3)])
    found: dict[int, tuple[float, int, Array, Array]] = {}
    for first in range(0, len(moves), _BATCH):
        some: DistanceBounds = lower_bounds(group.cells, op.tool, moves[first:first + _BATCH], best, ROUGH, asked)
        for c in below:
            i = int(some.lower[:, c].argmin())
            k = int(some.face[i, c])
            if k >= 0 and some.lower[i, c] < best[c] - ROUGH:
                best[c] = float(some.lower[i, c])
                found[c] = (best[c] - ROUGH, group.faces[k].number, some.point[i, c], moves[first + i])
    return found


def _standing(tool: Tool, group: CheckSurfaces, move: Array, component: int) -> tuple[Array, Array]:
    """Where on a motion a component is nearest to a group: the place that it is near to, and the tip."""
    share = np.linspace(-1.0, 1.0, _STEPS)[:, None]
    asked = np.full((len(group.faces), 3), -np.inf)
    asked[:, component] = 0.0
    tips = move[0] + share * move[1]
    found = lower_bounds(group.cells, tool, motions(tips, move[2]), 2 * MOST, ROUGH / 10, asked)
    k = int(found.lower[:, component].argmin())
    return found.point[k, component], tips[k]


def tightest(plan: Plan, progress: Progress = NO_PROGRESS) -> ClosestMotion | None:
    """Where a component comes nearest to what it must keep clear of; None where nothing is nearer than `MOST`.

    The cutter's distance to the machined skin and to what meets it harmlessly does not count.  Of turned copies only
    the originals are looked at.

    Parameters
    ----------
    plan : Plan
    progress : Progress
    """
    copies = {} if plan.blades is None else plan.blades.copies
    table = sorted((value, c, op.number) for op in plan.operations if op.done and op.number not in copies
                   for c, name in enumerate(COMPONENTS) for value in [op.orientation.clearance.get(name, np.inf)]
                   if value < MOST - 2 * ROUGH)
    if not table:
        return None
    progress.report("the tightest place", 0, 1)
    value, c, number = table[0]
    op = next(op for op in plan.operations if op.number == number)
    obstacles = [face for body in plan.obstacles for face in body.faces]
    best: ClosestMotion | None = None
    tolerance = plan.inputs.tolerance.for_cutter(op.tool.radius)
    for group in group_surroundings(op.face, tolerance, plan.inputs.allowance_of(op.face),
                                    part=plan.part_around(op.face.number), obstacles=obstacles):
        if c == 0 and group.role != OTHER:
            continue
        limit = value + 10 * ROUGH if best is None else best.distance
        for distance, face, _, move in _nearest(op, group, {c: limit}).values():  # rougher than what is proven
            place, tip = _standing(op.tool, group, move, c)
            best = ClosestMotion(op, COMPONENTS[c], max(distance, value), face, place, tip)
    return best
