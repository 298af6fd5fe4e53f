"""Seven-segment jerk-limited motion along a straight line, in closed form.

Between two velocities of the same sense, with no acceleration at the ends: jerk up, hold, jerk down; cruise; and the
same again.  Each of the seven may have no length.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput

Array = NDArray[np.float64]

_SIGNS = np.array([1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0])
_BISECTIONS = 60


@dataclass(frozen=True, eq=False)
class JerkProfile:
    """One motion of seven segments of constant jerk.

    Attributes
    ----------
    durations : (7,) array
        s; up, hold, down, cruise, down, hold, up.
    jerks : (7,) array
        mm/s^3.
    start : float
        Velocity at the start, mm/s.
    """

    durations: Array
    jerks: Array
    start: float

    @property
    def duration(self) -> float:
        """s."""
        return float(self.durations.sum())

    def at(self, times: ArrayLike) -> Array:
        """Position, velocity, acceleration and jerk at times from 0 to the duration, (n, 4).

        Parameters
        ----------
        times : (n,) array_like
            s.
        """
        t = np.atleast_1d(np.asarray(times, dtype=float))
        ends = np.cumsum(self.durations)
        begins = np.concatenate([[0.0], ends])
        states = np.zeros((8, 3))
        states[0, 1] = self.start
        for i in range(7):
            states[i + 1] = _after(states[i], self.jerks[i], self.durations[i])
        which = np.searchsorted(begins, t, side="right") - 1
        which = np.clip(which, 0, 6)
        jerk = self.jerks[which]
        moved = _after(states[which], jerk, t - begins[which])
        return np.column_stack([moved, jerk])


def _after(state: Array, jerk: Array, time: Array) -> Array:
    """Position, velocity and acceleration after a time of constant jerk, (..., 3)."""
    position = state[..., 0]
    velocity = state[..., 1]
    acceleration = state[..., 2]
    mean_velocity = velocity + time * (acceleration / 2 + time * jerk / 6)
    mean_acceleration = acceleration + time * jerk / 2
    position = position + time * mean_velocity
    velocity = velocity + time * mean_acceleration
    acceleration = acceleration + time * jerk
    return np.stack([position, velocity, acceleration], axis=-1)


def check_limits(velocity: ArrayLike, acceleration: ArrayLike, jerk: ArrayLike) -> None:
    """Refuse limits that no motion can keep.

    Parameters
    ----------
    velocity, acceleration, jerk : array_like

    Raises
    ------
    InvalidInput
        When one is not a finite number above zero.
    """
    limits = {"velocity": velocity, "acceleration": acceleration, "jerk": jerk}
    for name, values in limits.items():
        rows = np.atleast_1d(np.asarray(values, dtype=float))
        good = np.isfinite(rows) & (rows > 0)
        bad = np.flatnonzero(~good)
        if bad.size:
            raise InvalidInput(f"{name} limit {bad[0]} is {rows[bad[0]]}: it must be a finite number above zero")


def ramp_time(change: ArrayLike, acceleration: ArrayLike, jerk: ArrayLike) -> tuple[Array, Array]:
    """Times to change velocity with no acceleration at either end: of each jerk, and of the hold between, s.

    Parameters
    ----------
    change : array_like
        Change of velocity, of either sign.
    acceleration, jerk : array_like
    """
    size = np.abs(np.asarray(change, dtype=float))
    a = np.asarray(acceleration, dtype=float)
    j = np.asarray(jerk, dtype=float)
    is_short = size <= a * a / j  # the acceleration does not come to its limit
    longest_rise = a / j
    rise = np.where(is_short, np.sqrt(size / j), longest_rise)
    whole = size / a
    hold = np.maximum(whole - longest_rise, 0.0)
    return rise, np.where(is_short, 0.0, hold)


def ramp_length(start: ArrayLike, end: ArrayLike, acceleration: ArrayLike, jerk: ArrayLike) -> Array:
    """Way that a change of velocity takes, mm.

    Parameters
    ----------
    start, end, acceleration, jerk : array_like
    """
    v0 = np.asarray(start, dtype=float)
    v1 = np.asarray(end, dtype=float)
    rise, hold = ramp_time(v1 - v0, acceleration, jerk)
    mean = (v0 + v1) / 2
    return np.asarray(mean * (2 * rise + hold))


def reachable(start: ArrayLike, length: ArrayLike, acceleration: ArrayLike, jerk: ArrayLike) -> Array:
    """Greatest velocity that can be reached from another one within a length, no acceleration at either end.

    Read backwards it is the greatest velocity from which one can still slow down to another one.

    Parameters
    ----------
    start : array_like
        mm/s.
    length : array_like
        mm.
    acceleration, jerk : array_like
    """
    v0 = np.asarray(start, dtype=float)
    way = np.asarray(length, dtype=float)
    a = np.asarray(acceleration, dtype=float)
    j = np.asarray(jerk, dtype=float)
    rise = _cubic_root(2 * v0 / j, way / j)
    without_hold = v0 + j * rise * rise
    # Beyond this change of velocity the acceleration is held at its limit.
    shift = a * a / j
    square = (v0 - shift / 2) ** 2 + 2 * a * way
    root = np.sqrt(np.maximum(square, 0.0))
    with_hold = -shift / 2 + root
    is_short = without_hold - v0 <= shift
    return np.asarray(np.where(is_short, without_hold, with_hold))


def _cubic_root(p: Array, q: Array) -> Array:
    """The root x >= 0 of x^3 + p x = q with p, q >= 0, without cancellation."""
    # Cardano's formula, of whose two cube roots the smaller one follows from the larger.
    half = q / 2
    third = p / 3
    discriminant = half * half + third**3
    big = np.cbrt(half + np.sqrt(discriminant))
    small = np.where(big > 0, third / np.where(big > 0, big, 1.0), 0.0)
    root = big - small
    linear = q / np.where(p > 0, p, 1.0)
    is_linear = (p > 0) & (linear**2 < 1e-6 * p)
    root = np.where(is_linear, linear, root)
    # Newton's method takes away what is left of cancellation.
    for _ in range(3):
        slope = 3 * root * root + p
        rises = slope > 0
        rest = root**3 + p * root - q
        step = rest / np.where(rises, slope, 1.0)
        root = np.where(rises, root - step, root)
    return np.asarray(np.maximum(root, 0.0))


def peak_velocity(length: ArrayLike, velocity: ArrayLike, acceleration: ArrayLike, jerk: ArrayLike,
                  ends: tuple[ArrayLike, ArrayLike] = (0.0, 0.0)) -> Array:
    """Greatest velocity on the way between two velocities, mm/s; closed form where the two are equal.

    Parameters
    ----------
    length, velocity, acceleration, jerk : array_like
        Length, mm, long enough to change from one velocity to the other, and limits.
    ends : two array_like
        Velocities at the start and at the end.
    """
    way = np.asarray(length, dtype=float)
    top = np.asarray(velocity, dtype=float)
    a = np.asarray(acceleration, dtype=float)
    j = np.asarray(jerk, dtype=float)
    v0 = np.asarray(ends[0], dtype=float)
    v1 = np.asarray(ends[1], dtype=float)
    low = np.maximum(v0, v1)
    from_start = reachable(v0, way, a, j)
    from_end = reachable(v1, way, a, j)
    reachable_from_both = np.minimum(from_start, from_end)
    high = np.minimum(top, reachable_from_both)
    high = np.maximum(high, low)
    is_symmetric = np.asarray(v0 == v1)
    symmetric_peak = np.minimum(top, reachable(v0, way / 2, a, j))
    peak = np.array(np.where(is_symmetric, symmetric_peak, high))
    is_beyond = ~is_symmetric & (_needed(v0, v1, high, a, j) > way)
    if is_beyond.any():
        every = [np.broadcast_to(values, peak.shape)[is_beyond] for values in (low, high, v0, v1, way, a, j)]
        peak[is_beyond] = _bisect_velocity(*every)
    return peak


def _bisect_velocity(low: Array, high: Array, v0: Array, v1: Array, way: Array, a: Array, j: Array) -> Array:
    """Greatest velocity between two that leaves way to change to it and from it."""
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        good = _needed(v0, v1, middle, a, j) <= way
        low = np.where(good, middle, low)
        high = np.where(good, high, middle)
    return low


def _needed(v0: Array, v1: Array, peak: Array, a: Array, j: Array) -> Array:
    way_up = ramp_length(v0, peak, a, j)
    way_down = ramp_length(peak, v1, a, j)
    return np.asarray(way_up + way_down)


def travel_time(length: ArrayLike, velocity: ArrayLike, acceleration: ArrayLike, jerk: ArrayLike,
                ends: tuple[ArrayLike, ArrayLike] = (0.0, 0.0)) -> Array:
    """Least time for lengths between two velocities, s.

    Parameters
    ----------
    length, velocity, acceleration, jerk : array_like
    ends : two array_like
        Velocities at the start and at the end.

    Notes
    -----
    **Source** [grandguillaume2021] Eq. (8), whose law of seven segments this integrates.
    Properties: (1) from rest to rest under jerk alone it is 4 (L/(2 J))^(1/3); (2) it is the time of `profile`.
    """
    durations = segment_durations(length, velocity, acceleration, jerk, ends)
    return np.asarray(durations.sum(axis=-1))


def profile(length: float, velocity: float, acceleration: float, jerk: float,
            ends: tuple[float, float] = (0.0, 0.0)) -> JerkProfile:
    """The fastest motion over a length between two velocities, no acceleration at the ends.

    Parameters
    ----------
    length : float
        mm.
    velocity, acceleration, jerk : float
        Limits.
    ends : (float, float)
        Velocities at the start and at the end, mm/s, within the limit.

    Raises
    ------
    InvalidInput
        When a limit is not above zero, an end is too fast, or the length too short to change from one to the other.
    """
    check_limits(velocity, acceleration, jerk)
    if not (np.isfinite(length) and length >= 0):
        raise InvalidInput(f"length is {length} mm: it must be a finite number, not below zero")
    start, end = ends
    if min(ends) < 0 or max(ends) > velocity * (1 + 1e-12):
        raise InvalidInput(f"velocities at the ends are {start} and {end}: they must lie between 0 and "
                           f"{velocity}")
    needed = float(ramp_length(start, end, acceleration, jerk))
    if needed > length * (1 + 1e-9) + 1e-12:
        raise InvalidInput(f"length is {length} mm: changing from {start} to {end} mm/s takes {needed} mm")
    durations = segment_durations(length, velocity, acceleration, jerk, ends)
    jerks = _SIGNS * np.asarray(jerk, dtype=float)[..., None] * np.ones_like(durations)
    return JerkProfile(durations, np.asarray(jerks), float(start))


def segment_durations(length: ArrayLike, velocity: ArrayLike, acceleration: ArrayLike, jerk: ArrayLike,
                      ends: tuple[ArrayLike, ArrayLike]) -> Array:
    """Durations of the seven segments of the fastest motions, (..., 7) s.

    Parameters
    ----------
    length, velocity, acceleration, jerk : array_like
    ends : two array_like
        Velocities at the start and at the end.
    """
    peak = peak_velocity(length, velocity, acceleration, jerk, ends)
    v0 = np.asarray(ends[0], dtype=float)
    v1 = np.asarray(ends[1], dtype=float)
    way = np.asarray(length, dtype=float)
    up, hold_up = ramp_time(peak - v0, acceleration, jerk)
    down, hold_down = ramp_time(peak - v1, acceleration, jerk)
    way_up = (v0 + peak) / 2 * (2 * up + hold_up)
    way_down = (v1 + peak) / 2 * (2 * down + hold_down)
    left = np.maximum(way - way_up - way_down, 0.0)
    moves = peak > 0
    speed = np.where(moves, peak, 1.0)
    cruise = np.where(moves, left / speed, 0.0)
    segments = np.broadcast_arrays(up, hold_up, up, cruise, down, hold_down, down)
    return np.stack(segments, axis=-1)

