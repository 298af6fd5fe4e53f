"""From strokes with a moving axis to one tool path: each is left along its own last axis, and the axis turns above.

To a stroke that begins beside the end of the last one the tip goes straight over at feed rate.  Elsewhere it is lifted
along the axis at the end of a stroke, goes straight across while the axis turns to that of the next begin, and comes
down along it.  As high as `Swivelling.height` asks, the whole tool is above everything.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import angle_between, unit
from toolaxis.path.links import (
    BESIDE,
    LIFTS,
    ROOFS,
    CuttingMove,
    Linking,
    entry_points,
    exit_points,
    kinds_of,
    lay_lead_arcs,
    near_end,
    raise_link_ends,
)
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Cosine of the angle to the direction upwards below which lifting along an axis does not lead above everything.
_UPWARDS = 0.1


@dataclass(frozen=True, eq=False)
class MovingCuttingMove(CuttingMove):
    """One cutting motion without interruption with a moving axis.

    Attributes
    ----------
    contact, tip, normal
        As of `CuttingMove`.
    axis : (n, 3) array
    """

    axis: Array


class _LinkedStroke(NamedTuple):
    """Points of a stroke with the motions that lead onto it and away, as a `ToolPath` has them."""

    contact: Array
    tip: Array
    axis: Array
    normal: Array
    kind: NDArray[np.int8]


class LinkMotion(Enum):
    """What a motion of a link does, and so what it has to keep clear of."""

    #: Straight over to a stroke beside, at feed rate: it may cut stock.
    AT_FEED = "feed"
    #: Up from a stroke, or down to one, at rapid traverse: clear of stock.
    LIFT = "lift"
    #: Across at rapid traverse: clear of what passes leave on the skin too.
    CROSSING = "crossing"


@dataclass(frozen=True, eq=False)
class MovingLinks:
    """How strokes with moving axes are joined.

    Attributes
    ----------
    linking : Linking
        Ramps; its height is the one above which nothing stands, measured along `up`.
    up : (3,) array
        Unit vector: about the mean of the axes.
    tool : Tool
        What has to be above that height.
    clear : callable, optional
        Takes the tips at both ends of links and the axes there, (k, 3) each, and which motions they are, and answers
        which are free on the whole way, (k,) bool; all cross above everything without it.
    """

    linking: Linking
    up: Array
    tool: Tool
    clear: Callable[[Array, Array, Array, Array, LinkMotion], Bools] | None = None

    def height(self, axes: Array) -> float:
        """Height along `up` of the tip at which all of the tool is above everything with any of the axes, mm.

        Parameters
        ----------
        axes : (k, 3) array
            Their directions between two of them, on the shortest way, count too.
        """
        profile = self.tool.profile
        cutter = np.array([[self.tool.radius, 0.0], [profile.top_radius, profile.top]])
        rho, z = np.concatenate([cutter, *self.tool.outlines.values()]).T
        most = float(np.max(angle_between(axes, self.up)))
        lean = np.linspace(0.0, most, 64)[:, None]
        depth = rho * np.sin(lean) - z * np.cos(lean)
        below = float(depth.max())
        step = float(lean[-1, 0]) / 63
        spread = step * float(np.hypot(rho, z).max())  # between the angles looked at
        return self.linking.height + max(below, 0.0) + spread


def join_moves(passes: list[list[MovingCuttingMove]], how: MovingLinks) -> ToolPath:
    """Join strokes with moving axes.

    Parameters
    ----------
    passes : list of lists of MovingStroke
        Each pass with its strokes in the order of cutting.
    how : MovingLinks

    Returns
    -------
    ToolPath

    Raises
    ------
    InvalidInput
        When an axis at an end of a stroke lies so low that lifting along it leads nowhere.

    Notes
    -----
    **Properties**: (1) the CUT points are those of the strokes in their order; (2) the axis turns only on cuts and on
    the motions across, or over to a stroke beside; (3) each of these is free by `clear`, or above everything.
    """
    strokes = [stroke for some in passes for stroke in some]
    if not strokes:
        empty = np.empty((0, 3))
        return ToolPath(empty, empty, empty, empty, np.empty(0, dtype=np.int8), np.zeros(1, dtype=np.int64))
    begins = [entry_points(one, one.axis[0], how.linking) for one in strokes]
    ends = [exit_points(one, one.axis[-1], how.linking) for one in strokes]
    first = np.array([one.axis[0] for one in strokes])
    last = np.array([one.axis[-1] for one in strokes])
    top = how.height(np.concatenate([first, last]))
    over = _over(ends, begins, last, first, how)
    stays = np.isfinite(over[:, 0])
    lay_lead_arcs((begins, ends), strokes, (~stays, first, last), how.linking)

    def lifts(tips: Array, along: Array) -> Array:
        return _lifts(tips, along, how.up, top)

    raise_link_ends(begins, 0, first, how.linking, lifts)
    raise_link_ends(ends, -1, last, how.linking, lifts)
    down = _above(np.array([one[0] for one in begins]), first, how.up, top)
    up = _above(np.array([one[-1] for one in ends]), last, how.up, top)
    _lower(up, down, ends, begins, last, first, how)
    pieces = []
    for k, stroke in enumerate(strokes):
        entry = np.concatenate([down[k][None], begins[k]])
        leaving = np.concatenate([ends[k], up[k][None]])
        kind = kinds_of(len(entry), len(stroke.tip), len(leaving))
        leaving_axes = np.tile(last[k], (len(leaving), 1))
        if stays[k]:  # the tool comes from the stroke before, low over the part, and not from above
            entry = entry[2:]
            kind = kind[2:]
        if stays[k + 1]:
            leaving = np.concatenate([ends[k][:-1], over[k + 1:k + 2]])
            halfway = unit(last[k] + first[k + 1])
            leaving_axes = np.concatenate([leaving_axes[2:], halfway[None]])
            kind = kind[:-1]
        entry_axes = np.tile(first[k], (len(entry), 1))
        pieces.append(_LinkedStroke(
            contact=np.concatenate([entry, stroke.contact, leaving]),
            tip=np.concatenate([entry, stroke.tip, leaving]),
            axis=np.concatenate([entry_axes, stroke.axis, leaving_axes]),
            normal=np.concatenate([entry_axes, stroke.normal, leaving_axes]),
            kind=kind))
    whole = _LinkedStroke(*(np.concatenate(rows) for rows in zip(*pieces, strict=True)))
    size = np.cumsum([len(piece.kind) for piece in pieces])
    last_of_pass = np.cumsum([len(some) for some in passes]) - 1
    breaks = np.concatenate([[0], size[last_of_pass]]).astype(np.int64)
    return ToolPath(whole.contact, whole.tip, whole.axis, whole.normal, whole.kind.astype(np.int8), breaks)


def _above(tips: Array, axes: Array, up: Array, height: float) -> Array:
    """Tips lifted along their axes to a height along `up`."""
    slope = axes @ up
    if (slope < _UPWARDS).any():
        k = int(np.argmin(slope))
        raise InvalidInput(f"the axis {np.round(axes[k], 4).tolist()} at an end of a pass lies more than 84 deg from "
                           "the mean one: a retract along it does not leave the part")
    lifts = _lifts(tips, axes, up, height)
    return np.asarray(tips + lifts[:, None] * axes)


def _lifts(tips: Array, axes: Array, up: Array, height: float) -> Array:
    """How far tips are lifted along their axes to a height along `up`, (k,) mm; those that lead nowhere are refused
    where they are lifted."""
    below = np.maximum(height - tips @ up, 0.0)
    slope = np.maximum(axes @ up, _UPWARDS)
    return np.asarray(below / slope)


def _over(ends: list[Array], begins: list[Array], last: Array, first: Array, how: MovingLinks) -> Array:
    """Tips over which it goes straight to each stroke, and after the last one, (strokes + 1, 3); nan where it lifts."""
    over = np.full((len(ends) + 1, 3), np.nan)
    if how.clear is None or len(ends) < 2:
        return over
    starts = np.array([near_end(one[::-1], axis, how.linking) for one, axis in zip(ends, last, strict=True)])[:-1]
    stops = np.array([near_end(one, axis, how.linking) for one, axis in zip(begins, first, strict=True)])[1:]
    before = last[:-1]
    after = first[1:]
    far = np.linalg.norm(stops - starts, axis=1)
    is_beside = (far <= BESIDE) & (far > 0)
    left = np.flatnonzero(is_beside & ((before * after).sum(axis=1) > 0))
    middle = np.asarray(unit(before + after)) if len(left) else before
    for share in ROOFS:
        start = starts[left]
        stop = stops[left]
        axis = middle[left]
        height = share * far[left]
        roof = (start + stop) / 2 + height[:, None] * axis
        free = how.clear(start, roof, before[left], axis, LinkMotion.AT_FEED)
        free &= how.clear(roof, stop, axis, after[left], LinkMotion.AT_FEED)
        over[left[free] + 1] = roof[free]
        left = left[~free]
    return over


def _lower(up: Array, down: Array, ends: list[Array], begins: list[Array], last: Array, first: Array,
           how: MovingLinks) -> None:
    """Replace the ends of links by lower ones where a crossing there is free."""
    if how.clear is None or len(up) < 2:
        return
    starts = np.array([one[-1] for one in ends[:-1]])
    stops = np.array([one[0] for one in begins[1:]])
    before = last[:-1]
    after = first[1:]
    left = np.arange(len(starts))
    for lift in LIFTS:
        high_start = starts[left] + lift * before[left]
        high_stop = stops[left] + lift * after[left]
        rise_at_start = ((high_start - up[:-1][left]) * before[left]).sum(axis=1)
        rise_at_stop = ((high_stop - down[1:][left]) * after[left]).sum(axis=1)
        lower = (rise_at_start < 0) & (rise_at_stop < 0)
        left = left[lower]
        if not len(left):
            return
        high_start = high_start[lower]
        high_stop = high_stop[lower]
        axis_before = before[left]
        axis_after = after[left]
        free = how.clear(high_start, high_stop, axis_before, axis_after, LinkMotion.CROSSING)
        free &= how.clear(starts[left], high_start, axis_before, axis_before, LinkMotion.LIFT)
        free &= how.clear(stops[left], high_stop, axis_after, axis_after, LinkMotion.LIFT)
        up[left[free]] = high_start[free]
        down[left[free] + 1] = high_stop[free]
        left = left[~free]
