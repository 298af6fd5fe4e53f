"""The greatest squared path speeds within velocity, acceleration and jerk of all axes, by a logarithmic barrier.

With b the square of the path speed at stations s, an axis q(s) has the acceleration q_s b'/2 + q_ss b and the jerk
sqrt(b) (q_s b''/2 + 3/2 q_ss b' + q_sss b).  The first is held between neighbouring stations, the second at each, both
by differences.  Next to both ends b is that of a constant jerk from rest, b ~ s^(4/3), so one unknown stands for all
stations there.  Every Newton step solves a system of five diagonals; `barrier_compiled` sets it up where it can.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, solveh_banded

from toolaxis.feed.interior_point_compiled import barrier_system, barrier_value, solve_pentadiagonal
from toolaxis.numeric import jit as compiled

Array = NDArray[np.float64]

#: The barrier is followed until it costs at most this share of the time.
GAP = 1e-3

_GROWTH = 6.0
_NEWTON = 15


@dataclass(frozen=True, eq=False)
class SpeedProblem:
    """Stations and the linear forms of three neighbouring b that the axes bound.

    Attributes
    ----------
    stations : (n,) array
        Path parameter where b is sought; the first and the last are where the constant jerks from rest end.
    most : (n,) array
        Greatest b by velocity.
    acceleration : (n - 1, m, 2) array
        Accelerations between stations over their limits, on the two neighbours.
    jerk : (n, m, 3) array
        Jerks at stations over their limits and over sqrt(b), on station before, station, and station after.
    """

    stations: Array
    most: Array
    acceleration: Array
    jerk: Array

    def forms(self, b: Array) -> tuple[Array, Array]:
        """Acceleration (n - 1, m) and jerk without its root (n, m) over their limits.

        Parameters
        ----------
        b : (n,) array
        """
        first = self.acceleration[..., 0] * b[:-1, None] + self.acceleration[..., 1] * b[1:, None]
        second = self.jerk[..., 1] * b[:, None]
        second[1:] += self.jerk[1:, :, 0] * b[:-1, None]
        second[:-1] += self.jerk[:-1, :, 2] * b[1:, None]
        return first, second

    def feasible(self, b: Array) -> bool:
        """Whether all limits are kept, strictly.

        Parameters
        ----------
        b : (n,) array
        """
        if not ((b > 0).all() and (b < self.most).all()):
            return False
        first, second = self.forms(b)
        return bool((np.abs(first) < 1).all() and (np.abs(second) * np.sqrt(b)[:, None] < 1).all())


def greatest_speeds(problem: SpeedProblem, start: Array) -> Array:
    """Squared speeds of least time, (n,), from a start that is slow but follows a smooth motion.

    Parameters
    ----------
    problem : SpeedProblem
    start : (n,) array
        Any positive ones; halved until they are feasible.
    """
    b = np.asarray(start, dtype=float)
    while not problem.feasible(b):
        b = b / 2
    count = problem.acceleration.size * 2 + problem.jerk.size * 2 // 3 + len(b)
    weight = count / _time(problem, b)[0]
    for _ in range(40):
        for _ in range(_NEWTON):
            b, moved = _newton(problem, b, weight)
            if moved < 1e-3:
                break
        time = _time(problem, b)[0]
        if count / weight < GAP * time:
            break
        weight *= _GROWTH
    return b


def _time(problem: SpeedProblem, b: Array) -> tuple[float, Array, Array]:
    """Time of the stations, its gradient, and its Hessian's diagonals (3, n); the ends add what they take from rest."""
    v, step = np.sqrt(b), np.diff(problem.stations)
    total = v[:-1] + v[1:]
    gradient, bands = np.zeros(len(b)), np.zeros((3, len(b)))
    slope = 1 / (2 * v)
    gradient[:-1] -= 2 * step / total**2 * slope[:-1]
    gradient[1:] -= 2 * step / total**2 * slope[1:]
    bend = 1 / (4 * v**3)
    bands[2, :-1] += 4 * step / total**3 * slope[:-1] ** 2 + 2 * step / total**2 * bend[:-1]
    bands[2, 1:] += 4 * step / total**3 * slope[1:] ** 2 + 2 * step / total**2 * bend[1:]
    bands[1, 1:] += 4 * step / total**3 * slope[:-1] * slope[1:]
    return float((2 * step / total).sum()), gradient, bands


def _value(problem: SpeedProblem, b: Array, weight: float) -> float:
    """Weighted time less the logarithms of all that is left of the limits; infinite where one is not kept."""
    if compiled.available:
        return barrier_value(problem.stations, problem.most, problem.acceleration, problem.jerk, b, weight)
    return value_numpy(problem, b, weight)


def _system(problem: SpeedProblem, b: Array, weight: float) -> tuple[Array, Array]:
    """Gradient (n,) and upper diagonals (3, n) of the barrier at b."""
    if compiled.available:
        gradient, bands = np.zeros(len(b)), np.zeros((3, len(b)))
        barrier_system(problem.stations, problem.most, problem.acceleration, problem.jerk, b, weight, gradient, bands)
        return gradient, bands
    return system_numpy(problem, b, weight)


def _step(bands: Array, gradient: Array) -> Array:
    """Newton's step, (n,): the solution of the system, whose bands are spent."""
    if compiled.available:
        spent, step = bands.copy(), -gradient
        if solve_pentadiagonal(spent, step):
            return step
    try:
        return np.asarray(solveh_banded(bands, -gradient, check_finite=False))
    except LinAlgError:
        bands[2] *= 1 + 1e-9
        return np.asarray(solveh_banded(bands, -gradient, check_finite=False))


def _newton(problem: SpeedProblem, b: Array, weight: float) -> tuple[Array, float]:
    """One damped step, and the decrease that it promised."""
    gradient, bands = _system(problem, b, weight)
    step = _step(bands, gradient)
    promise = -float((gradient * step).sum())
    begin, size = _value(problem, b, weight), 1.0
    while size > 1e-6 and not _value(problem, b + size * step, weight) <= begin - 1e-4 * size * promise:
        size /= 2
    return (b + size * step, promise) if size > 1e-6 else (b, 0.0)


def value_numpy(problem: SpeedProblem, b: Array, weight: float) -> float:
    """What `barrier_value` gives.

    Parameters
    ----------
    problem : SpeedProblem
    b : (n,) array
    weight : float
    """
    if not problem.feasible(b):
        return float("inf")
    first, second = problem.forms(b)
    logs = np.log(problem.most - b).sum() + np.log1p(-(first * first)).sum()
    return weight * _time(problem, b)[0] - float(logs + np.log1p(-second * second * b[:, None]).sum())


def system_numpy(problem: SpeedProblem, b: Array, weight: float) -> tuple[Array, Array]:
    """What `barrier_system` adds to zeros.

    Parameters
    ----------
    problem, b, weight
        As for `value_numpy`.
    """
    _, gradient, bands = _time(problem, b)
    gradient, bands = weight * gradient, weight * bands
    room = problem.most - b
    gradient += 1 / room
    bands[2] += 1 / room**2
    first, second = problem.forms(b)
    _add_acceleration(problem, first, gradient, bands)
    _add_jerk(problem, b, second, gradient, bands)
    return gradient, bands


def _add_acceleration(problem: SpeedProblem, form: Array, gradient: Array, bands: Array) -> None:
    """Barrier of |form| < 1 between stations."""
    c = problem.acceleration
    pull = 2 * form / (1 - form * form)
    curve = 1 / (1 - form) ** 2 + 1 / (1 + form) ** 2
    gradient[:-1] += (pull * c[..., 0]).sum(axis=1)
    gradient[1:] += (pull * c[..., 1]).sum(axis=1)
    bands[2, :-1] += (curve * c[..., 0] ** 2).sum(axis=1)
    bands[2, 1:] += (curve * c[..., 1] ** 2).sum(axis=1)
    bands[1, 1:] += (curve * c[..., 0] * c[..., 1]).sum(axis=1)


def _add_jerk(problem: SpeedProblem, b: Array, form: Array, gradient: Array, bands: Array) -> None:
    """Barrier of |form| sqrt(b) < 1 at stations; of its Hessian the part that is always convex."""
    root = np.sqrt(b)[:, None]
    share = form * root
    pull = 2 * share / (1 - share * share)
    curve = 1 / (1 - share) ** 2 + 1 / (1 + share) ** 2
    before, here, after = (problem.jerk[..., k] * root for k in range(3))
    here = here + form / (2 * root)
    gradient += (pull * here).sum(axis=1)
    gradient[:-1] += (pull * before)[1:].sum(axis=1)
    gradient[1:] += (pull * after)[:-1].sum(axis=1)
    bands[2] += (curve * here * here).sum(axis=1)
    bands[2, :-1] += (curve * before * before)[1:].sum(axis=1)
    bands[2, 1:] += (curve * after * after)[:-1].sum(axis=1)
    bands[1, 1:] += (curve * before * here)[1:].sum(axis=1) + (curve * here * after)[:-1].sum(axis=1)
    bands[0, 2:] += (curve * before * after)[1:-1].sum(axis=1)
