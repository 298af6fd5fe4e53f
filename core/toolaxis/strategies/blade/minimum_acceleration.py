"""The rising curve of least peak acceleration in a channel of tool angles, and a bound that no curve in it beats.

Both are linear programmes over the same places.  The curve is a cubic spline whose second derivative runs straight
between its nodes, so it is C2; the bound asks only for what second differences of any curve keep.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.advice import SLIMMER_TOOL
from toolaxis.errors import InvalidInput
from toolaxis.strategies.blade.angle_channel import AngleChannel

Array = NDArray[np.float64]

#: Nodes of a curve in a turn around the blade, and the share of them that follows the length rather than the channel.
NODES, EVEN = 60, 0.5
#: Places of the channel that count in the bound.
_BOUND = 150
#: Share of a layer's length in which the greatest acceleration may be built up at the soonest.
RISE = 1 / 40
#: What the peak velocity counts beside the peak acceleration, both of a layer of length and turn one.
_VELOCITY = 0.5
#: How often places between the nodes at which a curve leaves the channel are added, and by how much it may, as a share
#: of its turn.
_ROUNDS, _LEFT = 6, 1e-4


@dataclass(frozen=True, eq=False)
class LeastCurve:
    """A cubic spline theta(S) by its nodes.

    Attributes
    ----------
    lengths : (n,) array
        S of the nodes, mm.
    theta, slope, bend : (n,) array
        Angle, rad, and its derivatives by S, rad/mm and rad/mm^2.
    """

    lengths: Array
    theta: Array
    slope: Array
    bend: Array

    def at(self, lengths: ArrayLike) -> Array:
        """Angle, slope and second derivative at places, (3, n).

        Parameters
        ----------
        lengths : (n,) array_like
        """
        s = np.asarray(lengths, dtype=float)
        k = np.searchsorted(self.lengths, s, side="right") - 1
        k = np.clip(k, 0, len(self.lengths) - 2)
        t = s - self.lengths[k]
        bend = self.bend[k]
        slope = self.slope[k]
        jerk = np.diff(self.bend)[k] / np.diff(self.lengths)[k]
        angle = self.theta[k] + t * (slope + t * (bend / 2 + t * jerk / 6))
        return np.stack([angle, slope + t * (bend + t * jerk / 2), bend + t * jerk])


def nodes_of(free: AngleChannel, count: int = NODES) -> NDArray[np.intp]:
    """Points of a channel at which curves are governed: denser where it rises.

    Parameters
    ----------
    free : AngleChannel
    count : int
    """
    middle = (free.low + free.high) / 2
    along, risen = ((rows - rows[0]) / max(float(rows[-1] - rows[0]), 1e-12) for rows in (free.lengths, middle))
    measure = EVEN * along + (1 - EVEN) * risen
    last = len(measure) - 1
    chosen = np.searchsorted(measure, np.linspace(0, measure[-1], count))
    return np.unique(np.concatenate([[0], np.minimum(chosen, last), [last]]))


class LeastProgramme:
    """The linear programme of layers that are alike: its rows are the same for all, their channels differ.

    Parameters
    ----------
    free : AngleChannel
        Of one of them; its shape decides where nodes lie.
    count : int
        Nodes at most.
    rise : float
        Share of the length in which the acceleration changes from nothing to its peak at the soonest.

    Notes
    -----
    Unknown are the control values of a cubic spline over the layer, both scaled to one, and the peaks of acceleration
    and velocity; the latter counts so little that it costs about a hundredth of the former.  Every row joins
    four neighbours at most, so the work grows with the number of nodes.
    """

    def __init__(self, free: AngleChannel, count: int = NODES, rise: float = RISE) -> None:
        from scipy.sparse import csr_array, hstack, vstack

        span = free.lengths - free.lengths[0]
        x = span[nodes_of(free, count)] / span[-1]
        self.places = x[1:-1]
        self.knots = np.concatenate([np.zeros(3), x, np.ones(3)])
        t = self.knots
        control = np.eye(len(x) + 2)
        self.first = 3 * np.diff(control, axis=0) / (t[4:-1] - t[1:-4])[:, None]
        self.second = 2 * np.diff(self.first, axis=0) / (t[4:-2] - t[2:-4])[:, None]
        jumps = np.diff(self.second, axis=0)
        widths = np.diff(x) / rise

        def below(part: Array, acceleration: ArrayLike, velocity: ArrayLike) -> Any:
            """Rows that keep forms of the control values below so much of both peaks."""
            peaks = [-np.broadcast_to(peak, len(part))[:, None] for peak in (acceleration, velocity)]
            return hstack([csr_array(columns) for columns in (part, *peaks)])

        self.rows = vstack([
            below(self.second, 1.0, 0.0),
            below(-self.second, 1.0, 0.0),
            below(jumps, widths, 0.0),
            below(-jumps, widths, 0.0),
            below(-self.first, 0.0, 0.0),
            below(self.first, 0.0, 1.0),
        ]).tocsr()

    def solve(self, free: AngleChannel, start: float, end: float) -> LeastCurve:
        """The curve of one layer.

        Parameters
        ----------
        free : AngleChannel
        start, end : float
            rad

        Raises
        ------
        InvalidInput
            When no rising curve leads from one to the other.
        """
        from scipy.interpolate import BSpline
        from scipy.sparse import csr_array, hstack, vstack

        scale = _Scale(free.lengths, start, end)
        x = (free.lengths - free.lengths[0]) / scale.length
        bound = [(0.0, 0.0)] * 3 + [(None, None)] * (len(self.knots) - 10) + [(1.0, 1.0)] * 3 + [(0.0, None)] * 2
        cost = np.zeros(len(bound))
        cost[-2:] = 1.0, _VELOCITY
        for _ in range(_ROUNDS):
            low, high = (scale.angles(np.interp(self.places, x, side)) for side in (free.low, free.high))
            angles = csr_array(BSpline.design_matrix(self.places, self.knots, 3))
            at = hstack([angles, csr_array((len(self.places), 2))])
            most = np.concatenate([np.zeros(self.rows.shape[0]), high, -low])
            found = _solve(cost, vstack([self.rows, at, -at]).tocsr(), bound, most)[:-2]
            theta = BSpline(self.knots, found, 3)(x)
            out = np.maximum(scale.angles(free.low) - theta, theta - scale.angles(free.high))
            inner = out[1:-1]
            worst = np.flatnonzero((inner > _LEFT) & (inner >= out[:-2]) & (inner >= out[2:])) + 1
            if not len(worst):
                break
            self.places = np.union1d(self.places, x[worst])
        nodes = self.knots[3:-3]
        slope = BSpline(self.knots[1:-1], self.first @ found, 2)(nodes)
        lengths = free.lengths[0] + scale.length * nodes
        theta = start + scale.turn * BSpline(self.knots, found, 3)(nodes)
        slope = scale.turn / scale.length * slope
        bend = scale.turn / scale.length**2 * (self.second @ found)
        return LeastCurve(lengths, theta, slope, bend)


def least_curve(free: AngleChannel, start: float, end: float, count: int = NODES, rise: float = RISE) -> LeastCurve:
    """The curve of least peak acceleration from an angle to another, level and unbent at both ends.

    Parameters
    ----------
    free : AngleChannel
    start, end : float
        rad
    count : int
        Nodes at most.
    rise : float
        Share of the length in which the acceleration changes from nothing to its peak at the soonest.

    Raises
    ------
    InvalidInput
        When no rising curve leads from one to the other.

    Notes
    -----
    **Properties**: 1. theta never falls; 2. theta keeps to the channel; 3. the peak is at least `least_peak`.
    """
    return LeastProgramme(free, count, rise).solve(free, start, end)


def least_peak(free: AngleChannel, start: float, end: float, count: int = _BOUND) -> float:
    """A bound, rad/mm^2: every rising C1 curve in the channel from an angle to another, level at both ends, has
    somewhere a second derivative of at least this.

    Parameters
    ----------
    free : AngleChannel
    start, end : float
        rad
    count : int
        Places at which the channel counts.

    Raises
    ------
    InvalidInput
        When no rising curve leads from one to the other.

    Notes
    -----
    A second difference is a mean of second derivatives, so none exceeds their peak; the same holds of the first step
    from level.
    """
    from scipy.sparse import coo_array, csr_array, diags_array, eye_array, hstack, vstack

    rows = nodes_of(free, count)
    s = free.lengths[rows]
    scale = _Scale(s, start, end)
    h = np.diff(s) / scale.length
    n = len(s)
    steps = diags_array(1 / h) @ (eye_array(n - 1, n, k=1) - eye_array(n - 1, n))
    bends = (eye_array(n - 2, n - 1, k=1) - eye_array(n - 2, n - 1)) @ steps
    arms = (h[1:] + h[:-1]) / 2
    by_peak = csr_array(-arms[:, None])
    end_steps = h[[0, -1]]
    ends = coo_array((np.array([1.0, 1.0]) / end_steps, ([0, 1], [1, n - 2])), shape=(2, n))
    above = vstack([
        hstack([bends, by_peak]),
        hstack([-bends, by_peak]),
        hstack([diags_array([1.0, -1.0]) @ ends, csr_array(-end_steps[:, None] / 2)]),
        hstack([-steps, csr_array((n - 1, 1))]),
    ]).tocsr()
    most = np.concatenate([np.zeros(2 * (n - 2)), [0.0, -1 / h[-1]], np.zeros(n - 1)])
    low = scale.angles(free.low[rows])
    high = scale.angles(free.high[rows])
    low[[0, -1]] = high[[0, -1]] = 0.0, 1.0
    cost = np.concatenate([np.zeros(n), [1.0]])
    x = _solve(cost, above, [*zip(low, high, strict=True), (0.0, None)], most)
    return float(x[-1] * scale.turn / scale.length**2)


class _Scale:
    """Lengths and angles as shares of a layer, in which programmes are solved."""

    def __init__(self, s: Array, start: float, end: float) -> None:
        self.length = float(s[-1] - s[0])
        self.start = start
        self.turn = end - start
        if not self.turn > 0:
            raise InvalidInput(f"a layer would turn from {start:.4f} to {end:.4f} rad: tool angles must grow on the "
                               "way around the blade")

    def angles(self, theta: Array) -> Array:
        return (theta - self.start) / self.turn


def _solve(cost: Array, above: Any, bound: Sequence[tuple[float | None, float | None]], most: Array) -> Array:
    from scipy.optimize import linprog

    found = linprog(cost, above, most, bounds=bound, method="highs-ds")
    if found.status != 0:
        raise InvalidInput(f"no rising curve of tool angles leads through the channel between the ends of a layer "
                           f"({found.message.split('.')[0]}): take {SLIMMER_TOOL}, less clearance, or another base")
    return np.asarray(found.x)
