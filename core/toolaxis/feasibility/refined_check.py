"""A closer look at one axis, from which screening learns."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.feasibility.check_points import CheckPoints
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.violations import FREE, GOUGE
from toolaxis.numeric.rounding import round_significant
from toolaxis.shape.nearest import nearest

Array = NDArray[np.float64]

_MOST = 6


class RefinedCheck(NamedTuple):
    """What a closer look at one axis found: reason, amount (rad or mm), parameters (m, 2) of the contacts that forbid
    it, worst first, and points (k, 3) of the skin that it gouges there."""

    reason: int
    amount: float
    uv: Array
    points: Array


def closer(feasibility: Feasibility, axis: Array, contacts: CheckPoints) -> RefinedCheck:
    """One axis judged by bounds: against all normals, and at contacts.

    Parameters
    ----------
    feasibility : Feasibility
    axis : (3,) array
        Unit vector.
    contacts : CheckPoints
    """
    away = feasibility.turned_away(axis)
    if away is not None:
        return RefinedCheck(away.reason, away.amount, away.uv[None], np.empty((0, 3)))
    trouble = feasibility.trouble(axis, contacts)
    reason, amount, _ = feasibility.verdict(trouble, contacts)
    hit = (trouble.reason != FREE) & (reason != FREE)
    bad = np.flatnonzero(hit & ~trouble.wall if (hit & ~trouble.wall).any() else hit)
    bad = bad[np.argsort(-round_significant(trouble.amount[bad]), kind="stable")][:_MOST]
    gouged = [i for i in bad if trouble.reason[i] == GOUGE and trouble.face[i] >= 0]
    skin = feasibility.groups[0].faces
    points = [nearest(skin[int(trouble.face[i])], trouble.point[i][None]).point for i in gouged]
    return RefinedCheck(reason, amount, contacts.uv[bad], np.concatenate([np.empty((0, 3)), *points]))
