"""Strip width and roughness together: rotary axes along a pass that keep both in their limits and turn least.

The rotary axes of the machine are splines; their coefficients with the least sum of squared angular velocities are
found by solving for it under the linearised conditions of the pass again and again.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.constrained_least_squares import constrained_least_squares
from toolaxis.strategies.roughness import rotary_velocity as pace
from toolaxis.strategies.roughness.pass_constraints import CONDITIONS, PassConstraints
from toolaxis.strategies.roughness.rotary_spline import RotarySpline, rates

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
class SmoothedAxes:
    """Rotary axes along a pass.

    Attributes
    ----------
    lane : PassConstraints
    spline : RotarySpline
    cost : float
        Sum of squared angular velocities, (rad/s)^2.
    margins : (n, 6) array
        What is left of each condition.
    paces : (k, m) array
        What is left of the velocities of the rotary axes, in parts of the gaps between places, as a share of them.
    rounds : int
        How often it was solved.
    """

    lane: PassConstraints
    spline: RotarySpline
    cost: float
    margins: Array
    paces: Array
    rounds: int

    @property
    def kept(self) -> bool:
        """Whether all conditions are kept, velocities where they are one."""
        return bool(self.margins.min() >= 0) and (self.follows or not self.lane.paced)

    @property
    def follows(self) -> bool:
        """Whether rotary axes keep their velocities at the feed rate."""
        return bool(self.paces.min() >= 0)

    @property
    def axes(self) -> Array:
        """Unit axes at the places, (n, 3)."""
        return self.lane.axes(self.spline.control)

    @property
    def sentence(self) -> str:
        """What is kept least, and where."""
        if self.lane.paced and self.paces.min() < self.margins.min():
            k, c = np.unravel_index(int(self.paces.argmin()), self.paces.shape)
            k = k * (len(self.lane.places) - 1) // len(self.paces)
            where = np.round(self.lane.bench.point[k], 2).tolist()
            return (f"near {where} {self.lane.machine.rotary[c].name} turns {1 - self.paces.min():.2f} times as fast "
                    "as it can")
        k, c = np.unravel_index(int(self.margins.argmin()), self.margins.shape)
        where = np.round(self.lane.bench.point[k], 2).tolist()
        return f"near {where} {CONDITIONS[c]}"


def smooth_axes(lane: PassConstraints, start: RotarySpline, ends: Array | None = None) -> SmoothedAxes:
    """Rotary axes with the least sum of squared velocities that keep all conditions, from a start that need not.

    Parameters
    ----------
    lane : PassConstraints
    start : RotarySpline
    ends : (2, m) array, optional
        Rotary angles at the first and the last place, rad; free unless given.

    Notes
    -----
    Conditions are linearised at the last spline and solved for exactly within a radius around it, with one more unknown
    for what they are missed by; steps that help neither the sum nor that are taken back with a smaller radius.

    **Source**: [dong2023] Sec. 5, whose loop fixes whole orientations where a condition fails; here the conditions
    themselves bind, so nothing is fixed that need not be.  Velocities of the axes bind too where the lane is paced.

    **Properties**: 1. ends are met to 1e-9 rad; 2. no other spline near by that keeps the conditions turns less.
    """
    spline, radius, aim = start, _RADIUS, _AIM[1]
    if ends is not None:
        spline = replace(start, control=_through(lane, start.control, ends))
    (margins, paces), rounds = _rest_of_limits(lane, spline.control), 0
    cost = spline.cost(lane.places, lane.durations)
    slopes = lane.slopes(spline.control)
    while rounds < _ROUNDS and radius >= _LEAST:
        rounds += 1
        here = (spline.control, slopes, margins)
        step = _step(lane, here, (radius, aim), ends)
        new = _Tried.of(lane, spline, step)
        if new.short > 0:
            new = max(new, _Tried.of(lane, spline, _correct_step(lane, here, (step, new), (radius, aim), ends)),
                      key=lambda one: one.worth(cost))
        gain = new.worth(cost) - _Tried.worth_of(cost, cost, _missing(lane, margins, paces))
        size = float(np.abs(new.spline.control - spline.control).max())
        aim = float(np.clip(_BEND * size**2, *_AIM))
        if gain > 0:
            done = (gain < _GAIN * cost or new.cost < _STILL) and new.short <= 0
            spline, margins, paces, cost = new.spline, new.margins, new.paces, new.cost
            radius = min(2 * radius, 0.5) if size > 0.9 * radius else radius
            if done:
                break
            slopes = lane.slopes(spline.control)
        else:
            radius = min(radius, size) / 3
    return SmoothedAxes(lane, spline, cost, margins, paces, rounds)


class _Tried(NamedTuple):
    """A spline after a step: what is left of conditions and velocities, what is missed, and the sum."""

    spline: RotarySpline
    margins: Array
    paces: Array
    short: float
    cost: float

    @classmethod
    def of(cls, lane: PassConstraints, spline: RotarySpline, step: Array) -> "_Tried":
        new = replace(spline, control=spline.control + step)
        margins, paces = _rest_of_limits(lane, new.control)
        return cls(new, margins, paces, _missing(lane, margins, paces), new.cost(lane.places, lane.durations))

    @staticmethod
    def worth_of(cost: float, last: float, short: float) -> float:
        return -cost - _MISSED * max(last, 1.0) * short

    def worth(self, last: float) -> float:
        return self.worth_of(self.cost, last, self.short)


def _rest_of_limits(lane: PassConstraints, control: Array) -> tuple[Array, Array]:
    """What is left of conditions and of velocities."""
    return lane.margins(lane.axes(control)), pace.velocity_left(lane, control)


def _missing(lane: PassConstraints, *left: Array) -> float:
    """By how much conditions, and velocities where they count, are missed: the most, and the rest in the mean."""
    short = [np.maximum(-one, 0.0) for one in left[:1 + lane.paced]]
    return max(float(one.max()) for one in short) + sum(float(one.sum()) / len(one) for one in short)


def _through(lane: PassConstraints, control: Array, ends: Array) -> Array:
    held = lane.values[[0, -1]]
    unit = np.eye(control.shape[0])
    return np.column_stack([constrained_least_squares(unit, column, (held, end))
                            for column, end in zip(control.T, np.asarray(ends).T, strict=True)])


def _correct_step(lane: PassConstraints, here: tuple[Array, Array, Array], tried: tuple[Array, _Tried],
                  sizes: tuple[float, float], ends: Array | None) -> Array:
    """The step with conditions as they came out at its end in the place of what their slopes had promised there."""
    control, slopes, _ = here
    step, new = tried
    promised = np.einsum("ncm,nm->nc", slopes, lane.values @ step)
    return _step(lane, (control, slopes, new.margins - promised), sizes, ends)


def _step(lane: PassConstraints, here: tuple[Array, Array, Array], sizes: tuple[float, float],
          ends: Array | None) -> Array:
    """The step that makes the sum least under the linearised conditions, (c, m), within a radius and with an aim."""
    control, slopes, margins = here
    (c, m), (radius, aim) = control.shape, sizes
    rows = rates(lane.knots, lane.places, lane.durations)
    near = margins < 1.5 * radius * np.abs(slopes).sum(axis=2) + 2 * aim
    place, which = np.nonzero(near)
    forms = (slopes[place, which][:, :, None] * lane.values[place][:, None, :]).reshape(len(place), m * c)
    wanted = aim - margins[place, which]
    if lane.paced:
        more, reach = pace.limits(lane, control, radius)
        forms, wanted = np.concatenate([forms, more]), np.concatenate([wanted, reach])
    size = np.maximum(np.linalg.norm(forms, axis=1), 1e-12)
    ones = np.ones((len(forms), 1))
    unit, flat = np.hstack([np.eye(m * c), np.zeros((m * c, 1))]), control.T.ravel()
    low, high = (np.repeat([getattr(axis, name) for axis in lane.machine.rotary], c) for name in ("low", "high"))
    slack = np.append(np.zeros(m * c), 1.0)[None]
    limits = np.vstack([np.hstack([forms / size[:, None], ones]), unit, -unit, slack])
    least = np.concatenate([wanted / size, np.clip(low - flat, -radius, radius),
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
    try:  # nothing is missed where nothing need be: the weight of what is missed is finite
        hard = None if equal is None else (equal[0][:, :-1], equal[1])
        found = constrained_least_squares(objective[:-1, :-1], right[:-1], hard, (limits[:-1, :-1], least[:-1]))
    except InvalidInput:
        found = constrained_least_squares(objective, right, equal, (limits, least))[:-1]
    return np.asarray(found.reshape(m, c).T)
