"""Key points, straight lines and rounded corners: the tool angles of a layer after the paper, level at both ends.

A straight line would need no acceleration.  Where it leaves the channel, the place at which it does so farthest becomes
a key point, moved inside by a clearance, which is also the room for rounding the corner there.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.corner_rounding import RoundedLine, greatest_height
from toolaxis.strategies.blade.angle_channel import AngleChannel

Array = NDArray[np.float64]

#: Shares of the channel's least width by which key points are moved inside, and of the greatest level ends, that are
#: tried.
MOVED, LEVEL = (0.02, 0.05, 0.1, 0.17, 0.26, 0.38), (0.2, 0.4, 0.55, 0.7, 0.85, 1.0)
#: Share of the clearance of keys that lines between them may use up.
_USED = 0.5
#: Longest level end, as a share of a layer.
_LONGEST = 0.3
_MOST_KEYS = 60


@dataclass(frozen=True)
class KeyRule:
    """How key points are set.

    Attributes
    ----------
    moved : float
        Share of the channel's least width by which they are moved inside.
    level : (float, float)
        Lengths of the level ends as shares of the longest that are possible.
    """

    moved: float
    level: tuple[float, float]


@dataclass(frozen=True, eq=False)
class KeyCurve:
    """The tool angles of a layer by key points.

    Attributes
    ----------
    line : RoundedLine
        Over S, mm; theta in rad.
    keys : (k, 2) array
        S and theta of the key points between the two level ends.
    """

    line: RoundedLine
    keys: Array

    def at(self, lengths: Array) -> Array:
        """Angle, slope and second derivative at places, (3, n).

        Parameters
        ----------
        lengths : (n,) array
        """
        return self.line.at(lengths)

    @property
    def peak(self) -> float:
        """Greatest second derivative by small slopes, rad/mm^2."""
        slope = np.diff(self.line.points[:, 1]) / np.diff(self.line.points[:, 0])
        turn = np.diff(slope)
        bent = np.abs(self.line.heights) > 0
        return float((turn[bent]**2 / (3 * np.abs(self.line.heights[bent]))).max(initial=0.0))


def key_curve(free: AngleChannel, start: float, end: float, rule: KeyRule) -> KeyCurve:
    """Key points, lines and corners by a rule.

    Parameters
    ----------
    free : AngleChannel
    start, end : float
        rad
    rule : KeyRule

    Raises
    ------
    InvalidInput
        When lines or corners do not fit into the channel.

    Notes
    -----
    Lines are divided where they leave the channel farthest until none does, then keys that a direct line makes
    redundant are dropped.  Both sides of the channel rise, so keys and lines do.

    **Source**: [stheta2023] Secs. 2.3, 3.2 and Eqs. (12), (13); keys on the channel's edge would leave no room for
    their corners.

    **Properties**: 1. theta never falls; 2. G2, level at both ends; 3. inside the channel at its points.
    """
    clearance = rule.moved * free.width
    ends = _level_ends(free, start, end, rule.level)
    s = free.lengths
    inner = AngleChannel(s, np.where(free.low <= start, np.minimum(free.low + clearance, start), free.low + clearance),
                         np.where(free.high >= end, np.maximum(free.high - clearance, end), free.high - clearance))
    used = _USED * clearance
    keys = [(ends[0], start), *_between(inner, (ends[0], start), (ends[1], end), used), (ends[1], end)]
    keys = _drop_redundant(inner, keys, used)
    points = np.array([(s[0], start), *keys, (s[-1], end)])
    if (np.diff(points[:, 0]) <= 0).any() or (np.diff(points[:, 1]) < 0).any():
        raise InvalidInput("key points do not rise: the channel is too narrow for this clearance of key points")
    most = greatest_height(points, (1.0, 1.0))
    room = _room(free, points)
    heights = np.where(most > 0, np.minimum(most, room[0]), np.maximum(most, -room[1]))
    bad = (np.abs(np.diff(np.diff(points[:, 1]) / np.diff(points[:, 0]))) > 1e-12) & (heights * np.sign(most) <= 0)
    if bad.any():
        k = int(np.flatnonzero(bad)[0]) + 1
        raise InvalidInput(f"the corner at S = {points[k, 0]:.2f} mm has no room in the channel: key points need more "
                           "clearance")
    return KeyCurve(RoundedLine(points, heights), np.array(keys[1:-1]).reshape(-1, 2))


def best_rule(free: AngleChannel, start: float, end: float) -> KeyRule:
    """The rule with the least peak acceleration on a layer.

    Parameters
    ----------
    free : AngleChannel
    start, end : float
        rad

    Raises
    ------
    InvalidInput
        When none leads through the channel.
    """
    best: tuple[float, KeyRule] | None = None
    why = ""
    for moved, first, last in product(MOVED, LEVEL, LEVEL):
        rule = KeyRule(moved, (first, last))
        try:
            peak = key_curve(free, start, end, rule).peak
        except InvalidInput as reason:
            why = str(reason)
            continue
        if best is None or peak < best[0]:
            best = peak, rule
    if best is None:
        raise InvalidInput(f"no key points lead through the channel: {why}")
    return best[1]


def _level_ends(free: AngleChannel, start: float, end: float, share: tuple[float, float]) -> tuple[float, float]:
    """Where the level ends of a layer meet the first and the last line."""
    s = free.lengths
    longest = _LONGEST * float(s[-1] - s[0])
    first = int(np.searchsorted(free.low, start, side="right")) - 1
    last = int(np.searchsorted(free.high, end))
    room_at_start = float(s[max(first, 0)] - s[0])
    room_at_end = float(s[-1] - s[min(last, len(s) - 1)])
    leaves_first_line = s[0] + share[0] * min(room_at_start, longest)
    meets_last_line = s[-1] - share[1] * min(room_at_end, longest)
    return float(leaves_first_line), float(meets_last_line)


def _out(free: AngleChannel, one: tuple[float, float], other: tuple[float, float]) -> tuple[float, int]:
    """How far a line leaves a channel at most, rad, and at which of its points."""
    some = slice(*np.searchsorted(free.lengths, (one[0], other[0]), side="right"))
    s = free.lengths[some]
    if not len(s):
        return -np.inf, 0
    theta = one[1] + (other[1] - one[1]) / (other[0] - one[0]) * (s - one[0])
    out = np.maximum(free.low[some] - theta, theta - free.high[some])
    k = int(np.argmax(out))
    return float(out[k]), k + (some.start or 0)


def _between(free: AngleChannel, one: tuple[float, float], other: tuple[float, float],
             used: float) -> list[tuple[float, float]]:
    """Key points between two points, in their order."""
    points = [one, other]
    k = 0
    while k + 1 < len(points):
        out, place = _out(free, points[k], points[k + 1])
        if out <= used:
            k += 1
            continue
        s = float(free.lengths[place])
        (a, low), (b, high) = points[k], points[k + 1]
        theta = low + (high - low) / (b - a) * (s - a)
        inside = float(np.clip(np.clip(theta, free.low[place], free.high[place]), low, high))
        if not a < s < b or abs(inside - theta) < used / 2 or len(points) > _MOST_KEYS:
            raise InvalidInput(f"lines between key points leave the channel near S = {s:.2f} mm: the channel is too "
                               "narrow, or turns too fast, for this clearance of key points")
        points.insert(k + 1, (s, inside))
    return points[1:-1]


def _drop_redundant(free: AngleChannel, keys: list[tuple[float, float]], used: float) -> list[tuple[float, float]]:
    """Keys without those that a direct line makes redundant."""
    kept, k = list(keys), 1
    while k < len(kept) - 1:
        if _out(free, kept[k - 1], kept[k + 1])[0] <= used:
            del kept[k]
            k = max(k - 1, 1)
        else:
            k += 1
    return kept


def _room(free: AngleChannel, points: Array) -> tuple[Array, Array]:
    """How high corners above, and how deep ones below, the inner points may be for what the channel leaves beside.

    A corner lies between its lines and the chords from its ends to its top: at a place x beside the point it leaves
    the lines by no more than height - x / reach, the reach being that of a corner of height one.
    """
    slope = np.arctan(np.diff(points[:, 1]) / np.diff(points[:, 0]))
    beta = (slope[1:] + slope[:-1]) / 2
    turn = np.maximum(np.abs(np.sin(beta - slope[:-1])), 1e-15)
    reach = [np.cos(one) * (np.cos(one) + np.cos(beta)) / turn for one in (slope[:-1], slope[1:])]
    s = free.lengths
    theta = np.interp(s, *points.T)
    up, down = np.empty(len(beta)), np.empty(len(beta))
    for k in range(len(beta)):
        first, last = np.searchsorted(s, (points[k, 0], points[k + 2, 0]))
        span = slice(first, last + 1)
        beside = s[span] - points[k + 1, 0]
        taper = np.where(beside < 0, -beside / reach[0][k], beside / reach[1][k])
        up[k] = (free.high[span] - theta[span] + taper).min()
        down[k] = (theta[span] - free.low[span] + taper).min()
    return up, down
