"""What of the faces that were asked for is in no operation: not begun when a plan was stopped, or hidden in a skin."""

from collections.abc import Sequence
from dataclasses import replace

from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import LEFT_OPEN, Plan
from toolaxis.plan.unplanned_area import HIDDEN, NOT_BEGUN, UnplannedArea
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.skin.view_surface import ViewSurface

#: Hidden area that is told, mm^2.
_TOLD = 1e-3
#: Share of a face, and area in mm^2, up to which its sub-surfaces may miss it by rounding.
_SHARE, _LEAST = 1e-3, 0.01


def add_not_begun(plan: Plan, faces: Sequence[Face]) -> Plan:
    """A stopped plan with what of some faces is in none of its operations; another one as it is.

    Parameters
    ----------
    plan : Plan
    faces : sequence of Face
        That were asked for, without what is held.

    Notes
    -----
    **Properties**: 1. sub-surfaces and what was not begun add up to the faces.
    """
    if plan.outcome != "cancelled":
        return plan
    return replace(plan, unplanned=(*plan.unplanned, *_list_not_begun(plan, faces)))


def add_hidden(plan: Plan, faces: Sequence[Face]) -> Plan:
    """A plan with what of the faces of its skins lies under others of them.

    Parameters
    ----------
    plan : Plan
        Incomplete where that is more than may stay open of a complete one.
    faces : sequence of Face
        That were asked for.
    """
    asked = {number for face in faces for number in face.numbers}
    found = [one for skin in plan.part.faces if asked.issuperset(skin.numbers) for one in _list_hidden(skin, plan.part)]
    made = replace(plan, unplanned=(*plan.unplanned, *found))
    lost = sum(one.area for one in found) > LEFT_OPEN * made.account.area
    return replace(made, outcome="incomplete") if lost and plan.outcome == "complete" else made


def _list_hidden(skin: Face, part: Part) -> list[UnplannedArea]:
    """What of a skin's faces lies under others of them, outside of what is held; nothing where it is no skin."""
    if not isinstance(skin.surface, ViewSurface):
        return []
    free = [one for one in skin.surface.hidden
            if one.area >= _TOLD and (part.held is None or part.held.depth(one.point[None])[0] <= 0)]
    names = {face.number: face.label for face in skin.own_faces}
    return [UnplannedArea(one.face, names[one.face], one.area, False, HIDDEN, tuple(one.point.tolist()),
                          names[one.beneath]) for one in free]


def _list_not_begun(plan: Plan, faces: Sequence[Face]) -> list[UnplannedArea]:
    """What of some faces is in no operation of a plan."""
    owners = {number: face for face in faces for number in face.numbers}
    begun: dict[int, list[Operation]] = {face.number: [] for face in faces}
    for op in plan.operations:
        if not op.rest_of and op.face.number in owners:
            begun[owners[op.face.number].number].append(op)
    return [one for face in faces if (one := _not_begun(face, begun[face.number])) is not None]


def _not_begun(face: Face, begun: Sequence[Operation]) -> UnplannedArea | None:
    """What of a face is in none of its operations; None where that is next to nothing."""
    area = face.area - sum(op.face.area for op in begun)
    if begun and area <= max(_SHARE * face.area, _LEAST):
        return None
    return UnplannedArea(face.number, face.label, area, not begun, NOT_BEGUN)
