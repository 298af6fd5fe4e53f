"""What of the faces that were asked for no operation of a plan machines, in sentences."""

from collections.abc import Sequence

from toolaxis.plan.face_share import FaceShare
from toolaxis.plan.plan import Plan
from toolaxis.plan.unplanned_area import HIDDEN, UnplannedArea

#: Faces that are named; the others are counted.
_NAMED = 20
#: Area below which nothing is said of what stays open, mm^2.
_TOLD = 0.05
#: The same of a hidden part of a face, mm^2: it would read 0.00.
_SHOWN = 0.005


def has_clamped_area(plan: Plan) -> bool:
    """Whether something of the faces lies in the clamped side, for another setup.

    Parameters
    ----------
    plan : Plan
    """
    return sum(one.area for one in plan.held) >= _TOLD


def describe_held(plan: Plan) -> str:
    """What of the faces is held in the clamping, and so is not asked for; empty where no side is held.

    Parameters
    ----------
    plan : Plan
    """
    if not plan.inputs.held:
        return ""
    if not has_clamped_area(plan):
        return f"clamped in this setup ({plan.inputs.held}): nothing of the faces that are asked for"
    area = sum(one.area for one in plan.held)
    return (f"clamped in this setup ({plan.inputs.held}) and not asked for: {area:.1f} mm2, of faces "
            f"{_name_areas(plan.held)}")


def describe_machined_before(plan: Plan) -> str:
    """What of the faces plans of earlier setups machine; empty where there are none.

    Parameters
    ----------
    plan : Plan
    """
    if not plan.machined_before:
        return ""
    area = sum(one.area for one in plan.machined_before)
    return (f"machined in earlier setups and not asked for: {area:.1f} mm2, of faces "
            f"{_name_areas(plan.machined_before)}")


def describe_not_begun(plan: Plan) -> str:
    """What of the faces was not begun when the plan was stopped; empty where that is nothing.

    Parameters
    ----------
    plan : Plan
    """
    found = [one for one in plan.unplanned if one.why != HIDDEN]
    if not found:
        return ""
    return f"not begun when the plan was stopped: {plan.account.not_begun:.1f} mm2, of faces {_name_areas(found)}"


def describe_hidden(plan: Plan) -> str:
    """What of the faces lies under others of their skin; empty where that is nothing.

    Parameters
    ----------
    plan : Plan
    """
    found = [one for one in plan.unplanned if one.why == HIDDEN and one.area >= _SHOWN]
    if not found:
        return ""
    shown = [f"{one.area:.2f} mm2 of face {one.label} under face {one.beneath} at "
             f"{' '.join(f'{x:.1f}' for x in one.point)}" for one in found[:_NAMED]]
    more = f", and {len(found) - _NAMED} more" if len(found) > _NAMED else ""
    return f"hidden in a skin, in no operation: {', '.join(shown)}{more}"


def describe_open(plan: Plan) -> str:
    """What of the faces stays open, for whatever reason; empty where that is next to nothing.

    Parameters
    ----------
    plan : Plan
    """
    found = plan.account
    left = found.area - found.machined
    if left < _TOLD:
        return ""
    parts = ((found.unreachable, "proven out of reach"), (found.not_begun, "not begun"))
    told = "".join(f", {area:.1f} mm2 of it {words}" for area, words in parts if area >= _TOLD)
    return f"stays open: {left:.1f} of {found.area:.1f} mm2 ({100 * left / found.area:.1f} %){told}"


def _name_areas(some: Sequence[FaceShare | UnplannedArea]) -> str:
    """Faces by their labels, with the area where it is not all of one."""
    named = [one.label if one.whole else f"{one.label} ({one.area:.1f} mm2 of it)" for one in some]
    more = f" and {len(named) - _NAMED} more" if len(named) > _NAMED else ""
    return f"{', '.join(named[:_NAMED])}{more}"
