"""What of the faces that were asked for is in no operation of a plan, in sentences."""

from collections.abc import Sequence

from toolaxis.plan.held_face import HeldFace
from toolaxis.plan.plan import Plan
from toolaxis.plan.unplanned_area import UnplannedArea

#: Faces that are named; the others are counted.
_NAMED = 20


def describe_held(plan: Plan) -> str:
    """What of the faces is held in the clamping, and so is not asked for; empty where no side is held.

    Parameters
    ----------
    plan : Plan
    """
    if not plan.inputs.held:
        return ""
    if not plan.held:
        return f"held in this clamping ({plan.inputs.held}): nothing of the faces that are asked for"
    area = sum(one.area for one in plan.held)
    return (f"held in this clamping ({plan.inputs.held}) and not asked for: {area:.1f} mm2, of faces "
            f"{_name_areas(plan.held)}")


def describe_not_begun(plan: Plan) -> str:
    """What of the faces was not begun when the plan was stopped; empty where that is nothing.

    Parameters
    ----------
    plan : Plan
    """
    if not plan.unplanned:
        return ""
    return (f"not begun when the plan was stopped: {plan.account.not_begun:.1f} mm2, of faces "
            f"{_name_areas(plan.unplanned)}")


def _name_areas(some: Sequence[HeldFace | UnplannedArea]) -> str:
    """Faces by their labels, with the area where it is not all of one."""
    named = [one.label if one.whole else f"{one.label} ({one.area:.1f} mm2 of it)" for one in some]
    more = f" and {len(named) - _NAMED} more" if len(named) > _NAMED else ""
    return f"{', '.join(named[:_NAMED])}{more}"
