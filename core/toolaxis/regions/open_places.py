"""What a plan with several tools leaves open, place by place, and what would close it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import LONGER_TOOL
from toolaxis.feasibility.surroundings import group_surroundings
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.plan.unplanned_area import HIDDEN, UnplannedArea
from toolaxis.plan.zone import AVOIDED
from toolaxis.regions.inside_corner import InsideCorner, find_inside_corner
from toolaxis.shape.face import Face
from toolaxis.shape.half_space import HELD_SIDE
from toolaxis.work import is_out_of_work

Array = NDArray[np.float64]

#: Area below which a place is not listed, mm^2.
LEAST = 0.01
#: Cells each way at whose centres the curvature of a place is asked for.
_CELLS = 12
#: Cells each way from which a ball end is tried: their number is that of questions to each face beside it.
_CELLS_FOR_BALLS = 6
#: Share of a place from which on it counts as out of reach where that is proven.
_MOSTLY = 0.5
#: Diameter below which there are no ball ends, mm.
_THINNEST = 0.1
#: Curvature below which a place counts as not hollow, 1/mm.
_FLAT = 1e-4


class OpenPlace(NamedTuple):
    """A place that no operation machines.

    label : str, of the sub-surface;  area : float, mm^2;  unreachable : float, mm^2 of it that are proven to be out of
    reach of every tool of the plan;  point : (3,) array, mm, in the middle of it;  radius : float, least radius of its
    hollows, mm, infinite where it is nowhere hollow;  limited : bool, whether the limit of work ended the search there;
    avoided : tuple of str, labels of faces to be avoided that keep the cutter from it;  beneath : str, label of the
    face under which it lies as their skin is seen;  corner : InsideCorner or None, in which it lies.
    """

    label: str
    area: float
    unreachable: float
    point: Array
    radius: float
    limited: bool
    avoided: tuple[str, ...] = ()
    beneath: str = ""
    corner: InsideCorner | None = None


class OpenFace(NamedTuple):
    """A piece of a face that no operation machines.

    operation : int, number of the one that leaves it;  zone : int or None, which of its zones it is, None for the whole
    sub-surface;  face : Face;  area : float, mm^2 of it that no other operation machines.
    """

    operation: int
    zone: int | None
    face: Face
    area: float


def list_open_faces(plan: Plan) -> tuple[OpenFace, ...]:
    """What no operation machines, in the order of the operations; on blades that of the planned one.

    Parameters
    ----------
    plan : Plan
    """
    copies = {} if plan.blades is None else plan.blades.copies
    found: list[OpenFace] = []
    for op in plan.operations:
        if op.number in copies:
            continue
        if not op.done:
            found.append(OpenFace(op.number, None, op.face, op.face.area))
        elif op.number not in plan.taken_over:  # what it left to others is told of those
            found += [OpenFace(op.number, k, op.face.trimmed(zone.loops), zone.area - zone.elsewhere)
                      for k, zone in enumerate(op.zones) if zone.at_wall]
    return tuple(found)


def list_open_places(plan: Plan) -> tuple[OpenPlace, ...]:
    """The places that no operation machines, the largest first; on blades those of the planned one.

    Parameters
    ----------
    plan : Plan
        Places of less than 0.01 mm^2 are left out.
    """
    operations = {op.number: op for op in plan.operations}
    left = [piece for piece in list_open_faces(plan) if piece.area >= LEAST]
    hidden = [area for area in plan.unplanned if area.why == HIDDEN and area.area >= LEAST]
    found = [_place(plan, operations[piece.operation], piece) for piece in left]
    found += [_place_beneath(area) for area in hidden]
    return tuple(sorted(found, key=lambda place: (-place.area, place.label)))


def _place_beneath(area: UnplannedArea) -> OpenPlace:
    """A place under another face of its skin: no tool was ever asked for it."""
    return OpenPlace(
        label=area.label,
        area=area.area,
        unreachable=0.0,
        point=np.array(area.point),
        radius=np.inf,
        limited=False,
        beneath=area.beneath)


def _place(plan: Plan, op: Operation, piece: OpenFace) -> OpenPlace:
    face = piece.face
    uv = face.places_on(_CELLS)
    points = face.evaluate(uv).point
    from_mean = np.linalg.norm(points - points.mean(axis=0), axis=1)
    middle = points[np.argmin(from_mean)]
    hollow = float(face.curvature(uv).k1.max(initial=0.0))
    proven = op.unreachable if piece.zone is None else op.zones[piece.zone].unreachable
    limited = is_out_of_work(op.orientation.reasons)
    avoided = () if piece.zone is None else op.zones[piece.zone].avoided
    radius = 1 / hollow if hollow > _FLAT else np.inf
    return OpenPlace(op.face.label, piece.area, proven, middle, radius, limited, avoided, corner=_corner_of(plan, face))


def _corner_of(plan: Plan, face: Face) -> InsideCorner | None:
    """The inside corner in which a piece of a face lies."""
    inputs = plan.inputs
    allowance = inputs.allowance_of(face)
    groups = group_surroundings(face, inputs.tolerance, allowance, part=plan.part_around(face.number),
                                obstacles=[own for body in plan.obstacles for own in body.faces])
    smallest = min(tool.corner_radius for tool in plan.tools)
    return find_inside_corner(face, face.places_on(_CELLS_FOR_BALLS), groups, smallest, allowance)


def what_closes(place: OpenPlace, smallest: float) -> str:
    """What would machine an open place, in words.

    Parameters
    ----------
    place : OpenPlace
    smallest : float
        Radius of the smallest ball, or corner, of the tools, mm.
    """
    if place.beneath:
        return f"face {place.label} without face {place.beneath}: it lies under that as their skin is seen"
    if HELD_SIDE in place.avoided:
        return "another setup: it lies beside the clamped side"
    if place.avoided:
        return f"nothing: it lies beside face {', '.join(place.avoided)}, {AVOIDED}"
    if place.radius < smallest:
        return f"a ball end of {2 * place.radius:.2g} mm or less"
    if place.corner is not None:
        return _what_closes_corner(place.corner)
    if place.unreachable >= _MOSTLY * place.area:
        return f"{LONGER_TOOL}, or another setup: no tool here reaches it with any axis"
    if place.limited:
        return "more work: raise --limit"
    return f"{LONGER_TOOL}, or another setup: no axis that was tried reaches enough of it"


def _what_closes_corner(corner: InsideCorner) -> str:
    if corner.beside == HELD_SIDE:
        return "another setup: it lies beside the clamped side"
    diameter = 2 * corner.radius
    if diameter < _THINNEST:
        return (f"a smaller clearance of the cutter (--clearances): half of it lies within {corner.clearance:g} mm of "
                f"face {corner.beside}")
    return f"a ball end of {diameter:.2g} mm or less for half of it: it lies in the corner to face {corner.beside}"
