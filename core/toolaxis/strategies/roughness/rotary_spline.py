"""Cubic B-splines of a machine's rotary axes along a pass with the least sum of squared angular velocities.

Velocities are differences of the angles between points of the pass over the times between them.  Equations and
inequalities on the angles are met exactly, not weighed against the velocities.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.constrained_least_squares import constrained_least_squares

Array = NDArray[np.float64]

DEGREE = 3


@dataclass(frozen=True, eq=False)
class RotarySpline:
    """Rotary angles along a pass.

    Attributes
    ----------
    knots : (c + 4,) array
        Clamped.
    control : (c, m) array
        Of m rotary axes, rad.
    """

    knots: Array
    control: Array

    def angles(self, places: ArrayLike) -> Array:
        """Angles at places of the pass, (n, m) rad; outside of the knots those at the ends.

        Parameters
        ----------
        places : (n,) array_like
        """
        return np.asarray(basis(self.knots, places) @ self.control)

    def velocities(self, places: ArrayLike, durations: ArrayLike) -> Array:
        """Angular velocities between points, (n - 1, m) rad/s.

        Parameters
        ----------
        places : (n,) array_like
        durations : (n - 1,) array_like
            s

        Notes
        -----
        **Source**: [dong2023] Eq. (18).
        """
        return np.asarray(np.diff(self.angles(places), axis=0) / np.asarray(durations, dtype=float)[:, None])

    def cost(self, places: ArrayLike, durations: ArrayLike) -> float:
        """Sum of the squares of all axes' angular velocities, (rad/s)^2.

        Parameters
        ----------
        places, durations
            As for `velocities`.

        Notes
        -----
        **Source**: [dong2023] Eq. (19).
        """
        return float((self.velocities(places, durations) ** 2).sum())


def even_knots(low: float, high: float, controls: int) -> Array:
    """Clamped knots with even gaps, (controls + 4,).

    Parameters
    ----------
    low, high : float
    controls : int
        4 at least.

    Raises
    ------
    InvalidInput
        When there are fewer, or the range is empty.
    """
    if controls < DEGREE + 1 or not low < high:
        raise InvalidInput(f"{controls} control coefficients between {low} and {high}: a cubic needs {DEGREE + 1} and "
                           "a range")
    return np.concatenate([np.full(DEGREE, low), np.linspace(low, high, controls - DEGREE + 1), np.full(DEGREE, high)])


def basis(knots: Array, places: ArrayLike) -> Array:
    """Values of the basis functions, (n, c).

    Parameters
    ----------
    knots : (c + 4,) array
    places : (n,) array_like
    """
    from scipy.interpolate import BSpline

    at = np.clip(np.asarray(places, dtype=float), knots[0], knots[-1])
    return np.asarray(BSpline.design_matrix(at, knots, DEGREE).toarray())


def rates(knots: Array, places: ArrayLike, durations: ArrayLike) -> Array:
    """What turns control coefficients into velocities, (n - 1, c) 1/s.

    Parameters
    ----------
    knots : (c + 4,) array
    places : (n,) array_like
        In growing order.
    durations : (n - 1,) array_like
        s

    Raises
    ------
    InvalidInput
        When a time is not above zero, or there is not one between each two points.

    Notes
    -----
    **Source**: [dong2023] Eq. (20).
    """
    times = np.asarray(durations, dtype=float)
    values = basis(knots, places)
    if times.shape != (len(values) - 1,) or not (np.isfinite(times) & (times > 0)).all():
        raise InvalidInput(f"{len(values)} points with times of shape {times.shape}: {len(values) - 1} finite times "
                           "above zero are needed")
    return np.asarray(np.diff(values, axis=0) / times[:, None])


def smoothest(knots: Array, places: ArrayLike, durations: ArrayLike, fixed: tuple[ArrayLike, ArrayLike],
              at_least: tuple[ArrayLike, ArrayLike] | None = None) -> RotarySpline:
    """The spline with the least sum of squared velocities through fixed angles.

    Parameters
    ----------
    knots : (c + 4,) array
    places, durations
        As for `rates`.
    fixed : (p,), (p, m) array_like
        Places, and angles there, rad: the ends of a pass among them, say.
    at_least : (k, m, c), (k,) array_like, optional
        Linear forms of the control coefficients, and what each must come to at least.

    Returns
    -------
    RotarySpline

    Raises
    ------
    InvalidInput
        When no angle is fixed, or the spline has too few coefficients to meet all.

    Notes
    -----
    **Source**: [dong2023] Eqs. (21) to (26).  The paper stacks the conditions of the least sum and the fixed angles and
    solves both in the mean, which misses the angles; here they are equations.

    **Properties**: 1. fixed angles are met to 1e-9 rad; 2. no spline with these knots that meets them has a smaller
    sum.
    """
    at, angles = np.atleast_1d(np.asarray(fixed[0], dtype=float)), np.atleast_2d(np.asarray(fixed[1], dtype=float))
    if not len(at) or len(at) != len(angles):
        raise InvalidInput(f"{len(at)} places with {len(angles)} angles are fixed: one at least, and angles for each")
    rows, held = rates(knots, places, durations), basis(knots, at)
    if at_least is None:
        columns = [constrained_least_squares(rows, np.zeros(len(rows)), (held, column)) for column in angles.T]
        return RotarySpline(knots, np.column_stack(columns))
    m = angles.shape[1]
    forms, least = (np.asarray(part, dtype=float) for part in at_least)
    every = constrained_least_squares(np.kron(np.eye(m), rows), np.zeros(m * len(rows)),
                                      (np.kron(np.eye(m), held), angles.T.ravel()),
                                      (forms.reshape(len(least), -1), least))
    return RotarySpline(knots, every.reshape(m, -1).T)
