"""Strip width and roughness together: rotary axes along a pass that keep both in their limits and turn least.

The rotary axes of the machine are splines; their coefficients with the least sum of squared angular velocities are
found by solving for it under the linearised conditions of the pass again and again.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.constrained import constrained_least_squares
from toolaxis.orient.lane import CONDITIONS, Lane
from toolaxis.orient.rotary_spline import RotarySpline, rates

Array = NDArray[np.float64]

#: Most rounds, first and least radius of a step, rad.
_ROUNDS, _RADIUS, _LEAST = 60, 0.1, 1e-7
#: By how much linearised conditions are kept, so that their bend does not break them: so many times the square of the
#: last step, but within these.
_BEND, _AIM = 30.0, (1e-7, 5e-4)
#: Share of the sum below which a round gains nothing, and the sum, (rad/s)^2, at which the axes stand still.
_GAIN, _STILL = 1e-5, 1e-9
#: Weights of what conditions are missed by, and of a step's own size, beside the sum of squared velocities.
_MISSED, _NEAR = 1e4, 1e-6


@dataclass(frozen=True, eq=False)
class Smoothed:
    """Rotary axes along a pass.

    Attributes
    ----------
    lane : Lane
    spline : RotarySpline
    cost : float
        Sum of squared angular velocities, (rad/s)^2.
    margins : (n, 6) array
        What is left of each condition.
    rounds : int
        How often it was solved.
    """

    lane: Lane
    spline: RotarySpline
    cost: float
    margins: Array
    rounds: int

    @property
    def kept(self) -> bool:
        """Whether all conditions are kept."""
        return bool(self.margins.min() >= 0)

    @property
    def axes(self) -> Array:
        """Unit axes at the places, (n, 3)."""
        return self.lane.axes(self.spline.control)

    @property
    def sentence(self) -> str:
        """What is kept least, and where."""
        k, c = np.unravel_index(int(self.margins.argmin()), self.margins.shape)
        where = np.round(self.lane.bench.point[k], 2).tolist()
        return f"near {where} {CONDITIONS[c]}"


def smoothed(lane: Lane, start: RotarySpline, ends: Array | None = None) -> Smoothed:
    """Rotary axes with the least sum of squared velocities that keep all conditions, from a start that need not.

    Parameters
    ----------
    lane : Lane
    start : RotarySpline
    ends : (2, m) array, optional
        Rotary angles at the first and the last place, rad; free unless given.

    Notes
    -----
    Conditions are linearised at the last spline and solved for exactly within a radius around it, with one more unknown
    for what they are missed by; steps that help neither the sum nor that are taken back with a smaller radius.

    **Source**: [dong2023] Sec. 5, whose loop fixes whole orientations where a condition fails; here the conditions
    themselves bind, so nothing is fixed that need not be.

    **Properties**: 1. ends are met to 1e-9 rad; 2. no other spline near by that keeps the conditions turns less.
    """
    spline, radius, aim = start, _RADIUS, _AIM[1]
    if ends is not None:
        spline = replace(start, control=_through(lane, start.control, ends))
    margins, rounds = lane.margins(lane.axes(spline.control)), 0
    cost = spline.cost(lane.places, lane.durations)
    while rounds < _ROUNDS and radius >= _LEAST:
        rounds += 1
        step = _step(lane, spline.control, margins, (radius, aim), ends)
        new = replace(spline, control=spline.control + step)
        after, price = lane.margins(lane.axes(new.control)), new.cost(lane.places, lane.durations)
        gain = cost - price + _MISSED * max(cost, 1.0) * (_missing(margins) - _missing(after))
        size = float(np.abs(step).max())
        aim = float(np.clip(_BEND * size**2, *_AIM))
        if gain > 0:
            done = (gain < _GAIN * cost or price < _STILL) and _missing(after) <= 0
            spline, margins, cost = new, after, price
            radius = min(2 * radius, 0.5) if size > 0.9 * radius else radius
            if done:
                break
        else:
            radius = min(radius, size) / 3
    return Smoothed(lane, spline, cost, margins, rounds)


def _missing(margins: Array) -> float:
    """By how much conditions are missed: the most, and the rest in the mean."""
    short = np.maximum(-margins, 0.0)
    return float(short.max() + short.sum() / len(short))


def _through(lane: Lane, control: Array, ends: Array) -> Array:
    held = lane.values[[0, -1]]
    unit = np.eye(control.shape[0])
    return np.column_stack([constrained_least_squares(unit, column, (held, end))
                            for column, end in zip(control.T, np.asarray(ends).T, strict=True)])


def _step(lane: Lane, control: Array, margins: Array, sizes: tuple[float, float], ends: Array | None) -> Array:
    """The step that makes the sum least under the linearised conditions, (c, m), within a radius and with an aim."""
    (c, m), (radius, aim) = control.shape, sizes
    rows = rates(lane.knots, lane.places, lane.durations)
    slopes = lane.slopes(control)
    near = margins < 1.5 * radius * np.abs(slopes).sum(axis=2) + 2 * aim
    place, which = np.nonzero(near)
    forms = (slopes[place, which][:, :, None] * lane.values[place][:, None, :]).reshape(len(place), m * c)
    size = np.maximum(np.linalg.norm(forms, axis=1), 1e-12)
    ones = np.ones((len(place), 1))
    unit, flat = np.hstack([np.eye(m * c), np.zeros((m * c, 1))]), control.T.ravel()
    low, high = (np.repeat([getattr(axis, name) for axis in lane.machine.rotary], c) for name in ("low", "high"))
    slack = np.append(np.zeros(m * c), 1.0)[None]
    limits = np.vstack([np.hstack([forms / size[:, None], ones]), unit, -unit, slack])
    least = np.concatenate([(aim - margins[place, which]) / size, np.clip(low - flat, -radius, radius),
                            -np.clip(high - flat, -radius, radius), np.zeros(1)])
    scale = float(np.abs(rows).max())
    root = np.linalg.cholesky(rows.T @ rows + _NEAR * scale**2 * np.eye(c)).T
    objective = np.zeros((m * c + 1, m * c + 1))
    objective[:-1, :-1] = np.kron(np.eye(m), root)
    objective[-1, -1] = np.sqrt(_MISSED) * scale
    right = np.append(-np.linalg.solve(root.T, rows.T @ rows @ control).T.ravel(), 0.0)
    equal = None
    if ends is not None:
        held = np.kron(np.eye(m), lane.values[[0, -1]])
        equal = (np.hstack([held, np.zeros((2 * m, 1))]), np.asarray(ends).T.ravel() - held @ flat)
    found = constrained_least_squares(objective, right, equal, (limits, least))
    return np.asarray(found[:-1].reshape(m, c).T)
