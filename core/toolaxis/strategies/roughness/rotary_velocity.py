"""Velocities of rotary axes as conditions on a spline: at the feed of a pass, what is left of them, and as linear rows.

They are linear in the coefficients, so that a step that keeps them keeps them exactly.
"""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from toolaxis.machine.machine import Machine
from toolaxis.strategies.roughness.pass_constraints import PassConstraints
from toolaxis.strategies.roughness.rotary_spline import rates

Array = NDArray[np.float64]

#: Parts of the gaps between places in which velocities are looked at, and what is kept of them for rounding.
PARTS, _AIM = 3, 1e-7


def fastest(machine: Machine) -> Array:
    """What rotary axes can do, (m,) rad/s; infinite where their drive is not known.

    Parameters
    ----------
    machine : Machine
    """
    return np.array([axis.drive.velocity if axis.drive else np.inf for axis in machine.rotary])


@lru_cache(maxsize=4)
def turning(lane: PassConstraints) -> Array:
    """What turns control coefficients into velocities in parts of the gaps between places, (k, c) 1/s.

    Parameters
    ----------
    lane : PassConstraints
    """
    count = len(lane.places)
    fine = np.interp(np.linspace(0, count - 1, PARTS * (count - 1) + 1), np.arange(count), lane.places)
    return rates(lane.knots, fine, np.repeat(lane.durations / PARTS, PARTS))


def velocity_left(lane: PassConstraints, control: Array) -> Array:
    """What is left of the velocities, as a share of them, (k, m); negative where an axis would be too fast.

    Parameters
    ----------
    lane : PassConstraints
    control : (c, m) array
    """
    return np.asarray(1 - np.abs(turning(lane) @ control) / fastest(lane.machine))


def limits(lane: PassConstraints, control: Array, radius: float) -> tuple[Array, Array]:
    """Linear forms of a step of the coefficients within a radius, (r, m c), and what each must come to, (r,).

    Parameters
    ----------
    lane : PassConstraints
    control : (c, m) array
    radius : float
        rad
    """
    rows, most, (c, m) = turning(lane), fastest(lane.machine), control.shape
    speed = rows @ control / most
    forms, least = [np.empty((0, m * c))], [np.empty(0)]
    for axis in range(m):
        for sign in (1.0, -1.0):
            free = 1 - sign * speed[:, axis]
            near = free < 1.5 * radius * np.abs(rows).sum(axis=1) / most[axis] + 2 * _AIM
            some = np.zeros((int(near.sum()), m * c))
            some[:, axis * c:(axis + 1) * c] = -sign * rows[near] / most[axis]
            forms.append(some)
            least.append(_AIM - free[near])
    return np.concatenate(forms), np.concatenate(least)
