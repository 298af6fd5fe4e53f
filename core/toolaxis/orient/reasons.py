"""Why an axis is refused, in sentences: which face, where, which constraint, and by how much."""

from math import degrees

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot
from toolaxis.orient.contacts import around
from toolaxis.orient.feasible import Feasibility
from toolaxis.orient.ledger import Ledger
from toolaxis.orient.setting import MARGIN, TOUCHING
from toolaxis.orient.verdicts import BACK, CUTTER, GOUGE, LIMITS, WANDERS, Witness
from toolaxis.plan.orientation import REASONS
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.shape.seams import GREATEST

Array = NDArray[np.float64]

COUNTED = ("free", "outside the limits", "on the back of the surface",
           "with a contact that wanders over the flat bottom", "with a gouge", "with a collision of the cutter",
           "with a collision of the shank", "with a collision of the holder")


#: Points of a border, and how many of them next to a place are looked at for a step at an edge.
_BORDER, _NEAREST = 400, 20


def place(point: Array) -> str:
    """A point as messages write it, mm."""
    return "(" + ", ".join(f"{round(float(x), 2) + 0.0:g}" for x in point) + ")"


def direction(axis: Array) -> str:
    """An axis as messages write it."""
    return "(" + ", ".join(f"{round(float(x), 4) + 0.0:g}" for x in axis) + ")"


def sentence(found: Witness, feasibility: Feasibility) -> str:
    """What one witness says.

    Parameters
    ----------
    found : Witness
    feasibility : Feasibility
    """
    own, tolerance = feasibility.face.label, feasibility.tolerance
    at = f"at {place(found.point)}"
    if found.words:
        return found.words
    if found.reason == LIMITS:
        return f"the axis is {degrees(found.amount):.2f} deg outside the limits"
    if found.reason == BACK:
        return (f"the axis leans {degrees(found.amount):.2f} deg farther than "
                f"{degrees(feasibility.greatest_angle):.1f} deg from the normal of face {own} {at}: the cutter's "
                "bottom does not reach there")
    if found.reason == WANDERS:
        least = degrees(feasibility.least_angle)
        angle = max(least - degrees(found.amount), 0.0)
        return (f"the axis comes within {angle:.2f} deg of a normal of face {own} {at}, less than {least:.2f} "
                "deg: the contact wanders over the flat bottom")
    if found.reason == GOUGE:
        return f"the cutter gouges face {found.label or own} by {-found.distance:.3f} mm {at}"
    name = ("cutter", "shank", "holder")[found.reason - CUTTER]
    needed = (tolerance.cutter_clearance, tolerance.shank_clearance, tolerance.holder_clearance)[found.reason - CUTTER]
    how = f"meets face {found.label} by {-found.distance:.2g} mm" if found.distance <= 0 else (
        f"comes within {found.distance:.3g} mm of face {found.label}, less than the required {needed:g} mm and "
        f"{MARGIN:g} mm to be sure,")
    return f"the {name} {how} {at}{_proud(found, feasibility)}"


def nothing_to_cut(face: Face) -> str:
    """What to say of an axis that leaves no pass on a face: each would stand too near to a wall all along.

    Parameters
    ----------
    face : Face
    """
    return (f"no pass is left on face {face.label}: walls or faces beside it keep the tool off everywhere along the "
            "passes; divide the face (--regions), or use a smaller cutter")


def _proud(found: Witness, feasibility: Feasibility) -> str:
    """Where the cutter meets a face behind a convex edge because that face stands out over the machined one."""
    behind = [face for group in feasibility.groups if group.role == TOUCHING for face in group.faces
              if face.label == found.label]
    if found.reason != CUTTER or not behind:
        return ""
    own = feasibility.face
    border = behind[0].evaluate(around(behind[0], _BORDER)).point
    near = border[np.argsort(np.linalg.norm(border - found.point, axis=1), kind="stable")[:_NEAREST]]
    foot = nearest(own, near)
    out = float(dot(near - foot.point, own.normal(foot.uv)).max())
    if out <= GREATEST:
        return ""  # what faces miss each other by was taken off already
    return (f", where face {found.label} stands {out:.2g} mm out over face {own.label}: steps up to {GREATEST:g} mm "
            "are taken as inaccuracy of the file and not counted as gouge, this one is higher; repair the edge, or "
            "plan with a larger machining tolerance")


def tally(ledger: Ledger) -> str:
    """How many axes were refused, and for what.

    Parameters
    ----------
    ledger : Ledger
    """
    counts = np.bincount(ledger.reason, minlength=len(REASONS))
    parts = [f"{counts[k]} {COUNTED[k]}" for k in range(1, len(REASONS)) if counts[k]]
    return f"of {len(ledger.axes)} axes " + (", ".join(parts) if parts else "none was refused")


def closest(ledger: Ledger) -> int | None:
    """Row of the forbidden axis that comes closest to being free: past the normals if any is, then by the amount."""
    for early in (GOUGE, WANDERS, BACK, LIMITS):
        rows = np.flatnonzero(ledger.reason >= early)
        if len(rows):
            return int(rows[np.argmin(ledger.amount[rows])])
    return None


def why_none(ledger: Ledger) -> str:
    """The constraint that stops the axis which comes closest.

    Parameters
    ----------
    ledger : Ledger
    """
    row = closest(ledger)
    if row is None:
        return "no axis was looked at"
    axis = ledger.axes[row]
    feasibility = ledger.feasibility
    found = feasibility.witness(axis)
    if found is None:
        found = Witness(int(ledger.reason[row]), float(ledger.amount[row]))
    return f"{sentence(found, feasibility)}, for the axis {direction(axis)} that comes closest"
