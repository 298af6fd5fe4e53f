"""The value and the Newton step of the speeds' barrier, each in one run along the stations: compiled, for long paths.

The plain numpy twins stand in `barrier`, which says what is computed.
"""

from math import inf, log, sqrt

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.jit import jit

Array = NDArray[np.float64]


@jit
def barrier_value(stations: Array, most: Array, acceleration: Array, jerk: Array, b: Array, weight: float) -> float:
    """Weighted time less the logarithms of all that is left of the limits; infinite where one is not kept.

    Parameters
    ----------
    stations, most, acceleration, jerk
        As in `barrier.SpeedProblem`.
    b : (n,) array
        Squared speeds.
    weight : float
    """
    total, last = 0.0, len(b) - 1
    for i in range(len(b)):
        if not 0 < b[i] < most[i]:
            return inf
        left = most[i] - b[i]  # the rooms of a station are multiplied: one logarithm for all
        for axis in range(jerk.shape[1]):
            form = jerk[i, axis, 1] * b[i]
            if i > 0:
                form += jerk[i, axis, 0] * b[i - 1]
            if i < last:
                form += jerk[i, axis, 2] * b[i + 1]
                straight = acceleration[i, axis, 0] * b[i] + acceleration[i, axis, 1] * b[i + 1]
                if not abs(straight) < 1:
                    return inf
                left *= 1 - straight * straight
            share = form * form * b[i]
            if not share < 1:
                return inf
            left *= 1 - share
        if not left > 0:
            return inf
        total -= log(left)
        if i < last:
            total += weight * 2 * (stations[i + 1] - stations[i]) / (sqrt(b[i]) + sqrt(b[i + 1]))
    return total


@jit
def barrier_system(stations: Array, most: Array, acceleration: Array, jerk: Array, b: Array, weight: float,
                   gradient: Array, bands: Array) -> None:
    """Gradient of the barrier, and the three upper diagonals of its Hessian's convex part, added to zeros.

    Parameters
    ----------
    stations, most, acceleration, jerk, b, weight
        As for `barrier_value`; b keeps all limits.
    gradient : (n,) array
    bands : (3, n) array
        As `scipy.linalg.solveh_banded` takes them.
    """
    last = len(b) - 1
    for i in range(len(b)):
        room, root = most[i] - b[i], sqrt(b[i])
        gradient[i] += 1 / room
        bands[2, i] += 1 / (room * room)
        if i < last:
            _add_time(weight * (stations[i + 1] - stations[i]), root, sqrt(b[i + 1]), i, gradient, bands)
        for axis in range(jerk.shape[1]):
            if i < last:
                one, two = acceleration[i, axis, 0], acceleration[i, axis, 1]
                form = one * b[i] + two * b[i + 1]
                pull, curve = _barrier_derivatives(form)
                gradient[i] += pull * one
                gradient[i + 1] += pull * two
                bands[2, i] += curve * one * one
                bands[2, i + 1] += curve * two * two
                bands[1, i + 1] += curve * one * two
            form = jerk[i, axis, 1] * b[i]
            if i > 0:
                form += jerk[i, axis, 0] * b[i - 1]
            if i < last:
                form += jerk[i, axis, 2] * b[i + 1]
            pull, curve = _barrier_derivatives(form * root)
            before, after = jerk[i, axis, 0] * root, jerk[i, axis, 2] * root
            here = jerk[i, axis, 1] * root + form / (2 * root)
            gradient[i] += pull * here
            bands[2, i] += curve * here * here
            if i > 0:
                gradient[i - 1] += pull * before
                bands[2, i - 1] += curve * before * before
                bands[1, i] += curve * before * here
            if i < last:
                gradient[i + 1] += pull * after
                bands[2, i + 1] += curve * after * after
                bands[1, i + 1] += curve * here * after
            if 0 < i < last:
                bands[0, i + 1] += curve * before * after


@jit
def solve_pentadiagonal(bands: Array, right: Array) -> bool:
    """Solve a symmetric positive definite system of five diagonals in place; False where it is not definite.

    Parameters
    ----------
    bands : (3, n) array
        Upper diagonals, as `scipy.linalg.solveh_banded` takes them; overwritten with the factors L D L^T.
    right : (n,) array
        Right side; overwritten with the solution.
    """
    n = len(right)
    for i in range(n):
        far = bands[0, i] / bands[2, i - 2] if i > 1 else 0.0
        mixed = bands[1, i] - far * bands[1, i - 1] if i > 1 else bands[1, i]
        near = mixed / bands[2, i - 1] if i > 0 else 0.0
        if i > 0:
            bands[2, i] -= near * mixed
            right[i] -= near * right[i - 1]
        if i > 1:
            bands[2, i] -= far * bands[0, i]
            right[i] -= far * right[i - 2]
        if not bands[2, i] > 0:
            return False
        bands[1, i] = mixed
    for i in range(n - 1, -1, -1):
        rest = right[i]
        if i + 1 < n:
            rest -= bands[1, i + 1] * right[i + 1]
        if i + 2 < n:
            rest -= bands[0, i + 2] * right[i + 2]
        right[i] = rest / bands[2, i]
    return True


@jit
def _barrier_derivatives(form: float) -> tuple[float, float]:
    """First and second derivative of -log(1 - form^2)."""
    low, high = 1 / (1 - form), 1 / (1 + form)
    return low - high, low * low + high * high


@jit
def _add_time(way: float, here: float, there: float, i: int, gradient: Array, bands: Array) -> None:
    """What the time 2 way / (here + there) between stations i and i + 1 adds, by their speeds."""
    total = here + there
    first, second = 2 * way / total**2, 4 * way / total**3
    slope, slope_there = 1 / (2 * here), 1 / (2 * there)
    gradient[i] -= first * slope
    gradient[i + 1] -= first * slope_there
    bands[2, i] += second * slope**2 + first / (4 * here**3)
    bands[2, i + 1] += second * slope_there**2 + first / (4 * there**3)
    bands[1, i + 1] += second * slope * slope_there
