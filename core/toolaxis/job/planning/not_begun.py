"""What of the faces that were asked for a stopped plan has not begun: told apart from what was tried in vain."""

from collections.abc import Sequence
from dataclasses import replace

from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.plan.unplanned_area import NOT_BEGUN, UnplannedArea
from toolaxis.progress import NO_PROGRESS, activate_progress
from toolaxis.shape.face import Face

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
    with activate_progress(NO_PROGRESS):  # areas are evaluated for it, whoever wants to stop
        return replace(plan, unplanned=(*plan.unplanned, *_list_not_begun(plan, faces)))


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
