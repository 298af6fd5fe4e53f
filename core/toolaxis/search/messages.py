"""Why an axis is refused, in sentences: which face, where, which constraint, and by how much."""

from collections import Counter
from collections.abc import Sequence
from math import degrees
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import DIVIDE, LARGER_TOLERANCE, SMALLER_CUTTER, STANDS_OUT
from toolaxis.contact.clearance.gouge import depth_from_distance
from toolaxis.feasibility.check_points import around
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import MARGIN, TOUCHING
from toolaxis.feasibility.violations import BACK, CUTTER, GOUGE, LIMITS, WANDERS, Violation
from toolaxis.numeric.rounding import round_significant
from toolaxis.numeric.vectors import angle_between, dot
from toolaxis.plan.orientation import REASONS
from toolaxis.plan.tally import tally_sentence
from toolaxis.plan.zone import AVOIDED, Zone
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.shape.face import Face
from toolaxis.shape.half_space import HELD_SIDE
from toolaxis.shape.nearest import nearest
from toolaxis.shape.seams import GREATEST
from toolaxis.tolerances import Tolerance

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]

_COMPONENTS = ("cutter", "shank", "holder")
#: What axes are refused for, in the order of `REASONS`.
_FOR = ("", "by the limits", "as too far from a normal", "as too near to a normal", "for a gouge",
        "for a collision of the cutter", "for a collision of the shank", "for a collision of the holder")
#: What axes have passed that get so far, by the first reason that is found out afterwards.
_PASSED = {LIMITS: "", BACK: " inside the limits", WANDERS: " that see all of the face",
           GOUGE: " that limits and normals allow"}
#: How sentences end, or begin, that tell what an operation leaves.
LEFT_OVER, UNDERCUT = "is left as rest material", "undercut"

#: What is said of passes over a skin between which too much stays, as closely as they may be laid.
STAYS_BETWEEN = "more stays higher than the scallop limit between its passes than may, as closely as they may be laid"

#: What is said of an axis that was known, and beside which no better one was looked for.
KNOWN_AXIS = "no better axis is looked for: the cut takes less time than an index move"
AS_GOOD = "no better axis is looked for: a ball end cuts as much under all that reach the whole face"

#: Points of a border, and how many of them next to a place are looked at for a step at an edge.
_BORDER, _NEAREST = 400, 20


def place(point: Array) -> str:
    """A point as messages write it, mm."""
    return "(" + ", ".join(f"{round(float(x), 2) + 0.0:g}" for x in point) + ")"


def left_reasons(zones: Sequence[Zone], face: Face) -> tuple[str, ...]:
    """What is to be said of the zones that an operation leaves: how much lies at walls, and what else stays where.

    Parameters
    ----------
    zones : sequence of Zone
        The largest first.
    face : Face
        The sub-surface.
    """
    at_walls = sum(zone.area for zone in zones if zone.at_wall)
    words = []
    if at_walls > 0:
        share = f"{100 * min(at_walls / face.area, 1.0):.1f}"
        words.append(f"{share} % of the area lies at walls or in corners and {LEFT_OVER}")
    for label in dict.fromkeys(label for zone in zones for label in zone.avoided):
        area = sum(zone.area for zone in zones if label in zone.avoided)
        if label == HELD_SIDE:
            words.append(f"{area:.2f} mm2 beside the clamped side {LEFT_OVER}")
        else:
            words.append(f"{area:.2f} mm2 beside face {label}, {AVOIDED}, {LEFT_OVER}")
    if any(not zone.at_wall for zone in zones):
        words.append(f"{UNDERCUT}: {stays_high(zones, face)}")
    return tuple(words)


def stays_high(zones: Sequence[Zone], face: Face) -> str:
    """What to say of zones that passes leave though the cutter may stand on them.

    Parameters
    ----------
    zones, face
        As for `left_reasons`; one of the zones at least does not lie at a wall.
    """
    under = [zone for zone in zones if not zone.at_wall]
    area = sum(zone.area for zone in under)
    at = face.evaluate(under[0].loops[0].mean(axis=0)).point[0]
    return (f"{area:.2f} mm2, {100 * area / face.area:.2f} % of the area, stay higher than the scallop limit, the "
            f"largest zone, {under[0].area:.2f} mm2, around {place(at)}: machine that place again with a neighbour's "
            "axis, or give the sub-surface a smoother border")


def tells_of_left(why: str) -> bool:
    """Whether a sentence is one of `left_reasons`."""
    return why.endswith(LEFT_OVER) or why.startswith(UNDERCUT)


def direction(axis: Array) -> str:
    """An axis as messages write it."""
    return "(" + ", ".join(f"{round(float(x), 4) + 0.0:g}" for x in axis) + ")"


def amount(value: float) -> str:
    """A length that is not negative as messages write it, mm: two decimals, more where there would be nothing left."""
    return f"{value:.2f}" if value >= 0.095 or value == 0 else f"{value:.2g}" if value >= 1e-4 else "0.0001"


def format_apart(value: float, limit: float, digits: int) -> tuple[str, str]:
    """A value and the limit that it misses, with as many decimals as it takes to tell them apart.

    Parameters
    ----------
    value, limit : float
    digits : int
        The fewest decimals.
    """
    for more in range(digits, 10):
        pair = f"{abs(value):.{more}f}", f"{abs(limit):.{more}f}"
        if pair[0] != pair[1]:
            break
    return pair


def sentence(found: Violation, feasibility: Feasibility) -> str:
    """What one witness says.

    Parameters
    ----------
    found : Violation
    feasibility : Feasibility
    """
    if found.words:
        return found.words
    if found.reason == LIMITS:
        return f"the axis is {degrees(abs(found.amount)):.2f} deg outside the limits"
    if found.reason in (BACK, WANDERS):
        return _angle(found, feasibility)
    if found.reason == GOUGE:
        return _gouge(found, feasibility)
    return _collision(found, feasibility)


def _at(found: Violation) -> str:
    """Where it happens; nothing where that is not known."""
    return f" at {place(found.point)}" if np.isfinite(found.point).all() else ""


def _angle(found: Violation, feasibility: Feasibility) -> str:
    """An axis that leans too far from a normal, or too little."""
    of = f"a normal of face {feasibility.face.label}{_at(found)}"
    if found.reason == BACK:
        most = degrees(feasibility.greatest_angle)
        angle, limit = format_apart(most + degrees(abs(found.amount)), most, 2)
        return f"the axis is {angle} deg from {of}, and the cutter reaches {limit} deg at most"
    least = degrees(feasibility.least_angle)
    angle, limit = format_apart(max(least - degrees(abs(found.amount)), 0.0), least, 2)
    if feasibility.tool.flat_radius == 0:
        return f"the axis is only {angle} deg from {of}: the least lean of a ball end is {limit} deg"
    return f"the axis is only {angle} deg from {of}: a flat bottom needs a lead of {limit} deg"


def _gouge(found: Violation, feasibility: Feasibility) -> str:
    """A cutter that goes too deep into the skin."""
    which, allowed = found.label or feasibility.face.label, feasibility.tolerance.gouge
    tool, stock = feasibility.tool, feasibility.allowance
    below = f" below the allowance of {stock:g} mm" if stock > 0 else ""
    depth = float(depth_from_distance(tool, np.asarray(found.distance), stock))
    if not np.isfinite(depth):
        return f"the cutter gouges face {which} by more than the allowed {allowed:g} mm{_at(found)}"
    deep, limit = format_apart(depth, allowed, 3)
    if depth > allowed:
        return f"the cutter gouges face {which} by {deep} mm{below}{_at(found)}; {limit} mm is allowed"
    return (f"the cutter comes too close to the allowed gouge of {allowed:g} mm on face {which}{_at(found)}: it goes "
            f"{deep} mm deep{below}, and the rest is needed between the points of a pass")


def _collision(found: Violation, feasibility: Feasibility) -> str:
    """A component that is too near to a face."""
    name, needed = _COMPONENTS[found.reason - CUTTER], _clearances(feasibility.tolerance)[found.reason - CUTTER]
    which = f"face {found.label}" if found.label else "what stands around"
    if found.label == HELD_SIDE:
        which = "the clamped side"
    left = _left_on(found, feasibility)
    if left > 0:
        needed += left
        which = f"face {found.label} ({left:g} mm are left on it)"
    stock = 0.0 if found.reason == CUTTER else _stock_on(found, feasibility) - left
    if stock > 0:
        needed += stock
        which = f"face {found.label} (finished; {stock:g} mm of stock on it)"
    behind = found.reason == CUTTER and _behind_edges(found, feasibility)
    if not np.isfinite(found.distance):
        return f"the {name} comes too near to {which}{_at(found)}: {needed:g} mm is required"
    if behind:
        allowed = feasibility.tolerance.gouge
        deep, limit = format_apart(max(-found.distance, 0.0), allowed, 3)
        if -found.distance > allowed:
            return (f"the cutter gouges {which} behind an edge by {deep} mm{_at(found)}; {limit} mm is allowed"
                    f"{_proud(found, behind[0], feasibility)}")
        return (f"the cutter comes too close to the allowed gouge of {allowed:g} mm on {which} behind an edge"
                f"{_at(found)}: it goes {deep} mm deep{_proud(found, behind[0], feasibility)}")
    if found.distance < 0:
        return f"the {name} collides with {which} by {amount(-found.distance)} mm{_at(found)}"
    if found.distance <= needed + MARGIN:
        near, _ = format_apart(found.distance, needed + MARGIN, 2)
        return (f"the {name} comes within {near} mm of {which}{_at(found)}; {needed:g} mm is required, and {MARGIN:g} "
                "mm more to be sure")
    return f"the {name} is not proven to stay {needed:g} mm clear of {which}{_at(found)}"


def _left_on(found: Violation, feasibility: Feasibility) -> float:
    """What is left on purpose on the face that a witness names, mm."""
    return max((group.allowance for group in feasibility.groups for face in group.faces if face.label == found.label),
               default=0.0)


def _stock_on(found: Violation, feasibility: Feasibility) -> float:
    """How far stock stands above the face that a witness names, mm."""
    return max((group.stock for group in feasibility.groups for face in group.faces if face.label == found.label),
               default=0.0)


def _clearances(tolerance: Tolerance) -> tuple[float, float, float]:
    """Clearances of cutter, shank and holder, mm."""
    return tolerance.cutter_clearance, tolerance.shank_clearance, tolerance.holder_clearance


def _behind_edges(found: Violation, feasibility: Feasibility) -> list[Face]:
    """The face that a witness names where it meets the machined skin at a convex edge; none where it does not."""
    return [face for group in feasibility.groups if group.role == TOUCHING for face in group.faces
            if face.label == found.label]


def nothing_to_cut(face: Face) -> str:
    """What to say of an axis that leaves no pass on a face: each would stand too near to a wall all along.

    Parameters
    ----------
    face : Face
    """
    return (f"no pass is left on face {face.label}: walls or faces beside it keep the tool off everywhere along the "
            f"passes; {DIVIDE} (--regions), or use {SMALLER_CUTTER}")


def _proud(found: Violation, behind: Face, feasibility: Feasibility) -> str:
    """Where the cutter meets a face behind a convex edge because that face stands out over the machined one."""
    own = feasibility.face
    border = behind.evaluate(around(behind, _BORDER)).point
    near = border[np.argsort(np.linalg.norm(border - found.point, axis=1), kind="stable")[:_NEAREST]]
    foot = nearest(own, near)
    out = float(dot(near - foot.point, own.normal(foot.uv)).max())
    if out <= GREATEST:
        return ""  # what faces miss each other by was taken off already
    return (f". Face {found.label} stands {amount(out)} {STANDS_OUT} {own.label} there, more than the "
            f"{GREATEST:g} mm that are taken as inaccuracy of the file: repair the edge, or plan with "
            f"{LARGER_TOLERANCE}")


def tally(ledger: AxisTable) -> str:
    """How many axes were tested, and for what they were refused.

    Parameters
    ----------
    ledger : AxisTable
    """
    counts = np.bincount(ledger.reason, minlength=len(REASONS))
    return tally_sentence(counts, ledger.feasibility.tool.flat_radius > 0)


class Refusal(NamedTuple):
    """An axis that a closer look or its passes' proof refused: of what kind (index into `REASONS`), by how much, and
    what is said of it."""

    reason: int
    amount: float
    words: str


def main_first(refused: Sequence[Refusal]) -> list[str]:
    """What is said of refused axes: the most frequent kind first, of each kind the nearest miss first.

    Parameters
    ----------
    refused : sequence of Refusal
    """
    count = Counter(one.reason for one in refused)
    return [one.words for one in sorted(refused, key=lambda one: (-count[one.reason], one.reason, one.amount))]


def decisive(ledger: AxisTable) -> IntArray:
    """Rows of the forbidden axes with what stops most of those that get farthest, the nearest miss first.

    Limits and normals exclude most of the sphere for any face: what they leave decides, if they leave anything; then
    what the flat bottom leaves.

    Parameters
    ----------
    ledger : AxisTable
    """
    for early in (GOUGE, WANDERS, BACK, LIMITS):
        rows = np.flatnonzero(ledger.reason >= early)
        if len(rows):
            kind = np.bincount(ledger.reason[rows]).argmax()
            rows = rows[ledger.reason[rows] == kind]
            return np.asarray(rows[np.argsort(round_significant(ledger.amount[rows]), kind="stable")])
    return np.empty(0, dtype=np.intp)


def why_none(ledger: AxisTable) -> str:
    """What stops most axes, with the one that comes closest.

    Parameters
    ----------
    ledger : AxisTable
    """
    rows = decisive(ledger)
    if not len(rows):
        return "no axis was tested"
    code, axis = int(ledger.reason[rows[0]]), ledger.axes[rows[0]]
    found = _stopping(ledger, axis, code)
    if found is None:
        found = Violation(code, float(ledger.amount[rows[0]]))
    stage = min(code, GOUGE)
    passed = int((ledger.reason >= stage).sum())
    count = f"all {passed}" if passed == len(rows) else f"{len(rows)} of the {passed}"
    return (f"{count} axes{_PASSED[stage]} are refused {_FOR[code]}; with the closest of them, {direction(axis)}, "
            f"{sentence(found, ledger.feasibility)}")


def _stopping(ledger: AxisTable, axis: Array, code: int) -> Violation | None:
    """What stops an axis, of the kind that the ledger knows; None where it can no more be told."""
    feasibility = ledger.feasibility
    known = [found for middle, angle, found in ledger.closed if angle_between(axis, middle) <= angle]
    for found in (feasibility.witness(axis), *known, feasibility.screened(axis)):
        if found is not None and found.reason == code:
            return found
    return None
