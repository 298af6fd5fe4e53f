"""The classical iso-scallop passes: each offset from the one before by the strip width, beginning at a border.

A pass is a graph over even lines that run from the border to the one opposite.  The next one is where its points come
to by going across by half a strip of theirs and half a strip of those to come.  Where several meet over a line, the
nearest counts, and a spline of few knots that goes nowhere farther is the pass, so that nothing is left between and no
kink is offset again.  It is no plan: nothing is proven, and ends do not run out.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_lsq_spline

from toolaxis.contact.placement import place
from toolaxis.contact.strip.width import strip_width
from toolaxis.numeric.vectors import dot, unit
from toolaxis.path.parametrization import Cut
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: Lines on which a pass is known, steps by which points go across, passes at most, and the least advance of a pass as a
#: share of the range.
LINES, STEPS, MOST, LEAST = 161, 4, 4000, 1e-5
#: Gaps between the knots of a pass.
GAPS = 16
#: How far points may go beyond the range before they are left out, as a share of it.
BEYOND = 0.2


class Border(NamedTuple):
    """Where passes begin: 0 or 1 for u or v, the parameter that grows from pass to pass, and whether from its end."""

    across: int
    back: bool


BORDERS = tuple(Border(across, back) for across in (0, 1) for back in (False, True))


def shortest_from_borders(face: Face, cuts: Sequence[Cut]) -> float:
    """Least length inside the face, mm of the tip's motion, over all borders and cuts; inf where none gets across.

    Parameters
    ----------
    face : Face
    cuts : sequence of Cut
    """
    return min(length_from_border(face, cut, border) for cut in cuts for border in BORDERS)


def length_from_border(face: Face, cut: Cut, border: Border) -> float:
    """Length inside the face of passes from one border, mm of the tip's motion; inf where they do not get across.

    Parameters
    ----------
    face : Face
    cut : Cut
    border : Border
    """
    lines = iso_scallop_passes(face, cut, border)
    return np.inf if lines is None else sum(_length_inside(face, cut, uv) for uv in lines)


def iso_scallop_passes(face: Face, cut: Cut, border: Border, most: int = MOST) -> list[Array] | None:
    """Contacts of the passes from one border, (n, 2) parameters each; None where they do not get across.

    Parameters
    ----------
    face : Face
    cut : Cut
    border : Border
    most : int
        Passes at most.
    """
    ends = np.array(face.bounds).reshape(2, 2)
    low, high = ends[border.across]
    along = np.linspace(*ends[1 - border.across], LINES)
    sense = -1.0 if border.back else 1.0
    front = np.full(LINES, high if border.back else low)
    front = _advance(face, cut, border, along, front, 1)
    found: list[Array] = []
    for _ in range(most):
        if not np.isfinite(front).all():
            return None
        found.append(_join(border, along, front))
        if (sense * (front - (low if border.back else high)) >= 0).all():
            return found
        after = _advance(face, cut, border, along, front, 2)
        least = LEAST * (high - low)
        front = sense * np.maximum(sense * after, sense * front + least)
    return None


def _join(border: Border, along: Array, front: Array) -> Array:
    return np.column_stack([front, along] if border.across == 0 else [along, front])


def _advance(face: Face, cut: Cut, border: Border, along: Array, front: Array, halves: int) -> Array:
    """The next pass: half a strip across from the border, or from a pass by its half strip and that of the next."""
    start = _join(border, along, front)
    feed = _feed(face, start)
    ahead, behind = _halves(face, cut, start, feed, border)
    way = behind if halves == 1 else ahead + behind
    for _ in range(2):  # once more with what the place there is worth
        reached = _go(face, border, start, feed, way)
        there = _halves(face, cut, reached, _feed(face, reached), border)[1]
        way = there if halves == 1 else ahead + there
    return _nearest_over_lines(face, border, along, _go(face, border, start, feed, way))


def _feed(face: Face, uv: Array) -> Array:
    """Unit directions along a pass, (n, 3)."""
    points = face.evaluate(uv).point
    return np.asarray(unit(np.gradient(points, axis=0)))


def _onward(face: Face, border: Border, uv: Array, feed: Array) -> Array:
    """Unit directions across a pass, towards the next one, (n, 3)."""
    d = face.evaluate(uv)
    left = np.cross(face.normal(uv), feed)
    growing = np.sign(dot(left, d.su if border.across == 0 else d.sv))
    return np.asarray(left * (-growing if border.back else growing)[:, None])


def _halves(face: Face, cut: Cut, uv: Array, feed: Array, border: Border) -> tuple[Array, Array]:
    """Half widths towards the next pass and towards the one before, (n,) each, mm."""
    u0, u1, v0, v1 = face.bounds
    inside = np.clip(uv, [u0, v0], [u1, v1])
    halves = strip_width(face, cut.tool, inside, cut.axis, cut.scallop, feed, cut.allowance)
    to_left = dot(np.cross(face.normal(inside), feed), _onward(face, border, inside, feed)) > 0
    return np.where(to_left, halves[:, 0], halves[:, 1]), np.where(to_left, halves[:, 1], halves[:, 0])


def _go(face: Face, border: Border, start: Array, feed: Array, way: Array) -> Array:
    """Parameters at ways across a pass on the face, in some steps of its tangent plane."""
    uv = start.copy()
    direction = _onward(face, border, start, feed)
    for _ in range(STEPS):
        d, normal = face.evaluate(uv), face.normal(uv)
        step = unit(direction - dot(direction, normal)[:, None] * normal) * (way / STEPS)[:, None]
        e, f, g = dot(d.su, d.su), dot(d.su, d.sv), dot(d.sv, d.sv)
        a, b = dot(step, d.su), dot(step, d.sv)
        det = np.maximum(e * g - f * f, 1e-300)
        uv = uv + np.column_stack([a * g - b * f, b * e - a * f]) / det[:, None]
    return uv


def _nearest_over_lines(face: Face, border: Border, along: Array, reached: Array) -> Array:
    """Where the pass through places meets each line: the nearest to the border where it does so more than once."""
    ends = np.array(face.bounds).reshape(2, 2)
    span = ends[border.across, 1] - ends[border.across, 0]
    reached[:, border.across] = np.clip(reached[:, border.across], ends[border.across, 0] - BEYOND * span,
                                        ends[border.across, 1] + BEYOND * span)
    own, value = reached[:, 1 - border.across], reached[:, border.across]
    sense = -1.0 if border.back else 1.0
    front = np.full(len(along), np.inf)
    for k in range(len(own) - 1):
        first, last = (k, k + 1) if own[k] <= own[k + 1] else (k + 1, k)
        here = (along >= own[first]) & (along <= own[last])
        share = (along[here] - own[first]) / max(own[last] - own[first], 1e-300)
        front[here] = np.minimum(front[here], sense * (value[first] + share * (value[last] - value[first])))
    known = np.flatnonzero(np.isfinite(front))
    if not len(known):
        return front
    whole = np.interp(along, along[known], front[known])  # level beyond the last known lines
    smooth = make_lsq_spline(along, whole, _knots(along), 3)(along)
    return np.asarray(sense * (smooth - max(float((smooth - whole).max()), 0.0)))


def _knots(along: Array) -> Array:
    return np.concatenate([np.full(3, along[0]), np.linspace(along[0], along[-1], GAPS + 1), np.full(3, along[-1])])


def _length_inside(face: Face, cut: Cut, uv: Array) -> float:
    middle = (uv[1:] + uv[:-1]) / 2
    tips = place(face, cut.tool, uv, cut.axis, cut.allowance)
    return float(np.linalg.norm(np.diff(tips, axis=0), axis=1)[face.contains(middle)].sum())
