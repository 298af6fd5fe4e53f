"""What a plan with several tools leaves open, place by place, and what would close it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.shape.face import Face
from toolaxis.work import is_out_of_work

Array = NDArray[np.float64]

#: Area below which a place is not listed, mm^2.
LEAST = 0.01
#: Cells each way at whose centres the curvature of a place is asked for.
_CELLS = 12
#: Curvature below which a place counts as not hollow, 1/mm.
_FLAT = 1e-4


class OpenPlace(NamedTuple):
    """A place that no operation machines.

    label : str, of the sub-surface;  area : float, mm^2;  point : (3,) array, mm, in the middle of it;  radius : float,
    least radius of its hollows, mm, infinite where it is nowhere hollow;  limited : bool, whether the limit of work
    ended the search there.
    """

    label: str
    area: float
    point: Array
    radius: float
    limited: bool


def list_open_places(plan: Plan) -> tuple[OpenPlace, ...]:
    """The places that no operation machines, the largest first; on blades those of the planned one.

    Parameters
    ----------
    plan : Plan
        Places of less than 0.01 mm^2 are left out.
    """
    copies = {} if plan.blades is None else plan.blades.copies
    found: list[OpenPlace] = []
    for op in plan.operations:
        if op.number in copies:
            continue
        for face, area in _open_faces(op, op.number in plan.taken_over):
            if area >= LEAST:
                found.append(_place(op, face, area))
    return tuple(sorted(found, key=lambda one: (-one.area, one.label)))


def _open_faces(op: Operation, taken_over: bool) -> list[tuple[Face, float]]:
    """What an operation leaves, with its area; what it left to others is told of those."""
    if not op.done:
        return [(op.face, op.face.area)]
    if taken_over:
        return []
    return [(op.face.trimmed(zone.loops), zone.area - zone.elsewhere) for zone in op.zones if zone.at_wall]


def _place(op: Operation, face: Face, area: float) -> OpenPlace:
    uv = face.grid(_CELLS, _CELLS)
    if not len(uv):
        uv = face.outline[0]
    points = face.evaluate(uv).point
    middle = points[np.argmin(np.linalg.norm(points - points.mean(axis=0), axis=1))]
    hollow = float(face.curvature(uv).k1.max(initial=0.0))
    limited = is_out_of_work(op.orientation.reasons)
    return OpenPlace(op.face.label, area, middle, 1 / hollow if hollow > _FLAT else np.inf, limited)


def what_closes(place: OpenPlace, smallest: float) -> str:
    """What would machine an open place, in words.

    Parameters
    ----------
    place : OpenPlace
    smallest : float
        Radius of the smallest ball, or corner, of the tools, mm.
    """
    if place.radius < smallest:
        return f"a ball end of {2 * place.radius:.2g} mm or less"
    if place.limited:
        return "more work: raise --limit"
    return "a slimmer or longer tool, or another clamping: no axis that was tried reaches it"
