"""What the axes of a machine do along a path at a constant speed, whatever their limits: velocities, accelerations."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.feed.continuous_ik import following
from toolaxis.machine.machine import Machine

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class AxisMotion:
    """Motion of the linear axes, mm, and of the rotary ones, rad, after them.

    Attributes
    ----------
    names : tuple of str
    places : (n,) array
        Way of the points whose speed is constant, mm.
    position, velocity, acceleration : (n, 3 + m) array
        Per s and s^2.
    """

    names: tuple[str, ...]
    places: Array
    position: Array
    velocity: Array
    acceleration: Array

    @property
    def peaks(self) -> tuple[Array, Array]:
        """Greatest velocity and acceleration of each axis, (3 + m,) each."""
        return np.abs(self.velocity).max(axis=0), np.abs(self.acceleration).max(axis=0)


def axis_motion(machine: Machine, path: ToolPath, places: ArrayLike, speed: float,
                table_from_part: ArrayLike | None = None, tool_length: float = 0.0) -> AxisMotion:
    """Motion of all axes along a finely divided smooth path at a constant speed.

    Parameters
    ----------
    machine : Machine
    path : ToolPath
    places : (n,) array_like
        Way of each of its points, mm, ascending evenly: that of its tips, or of cutter centres.
    speed : float
        mm/s
    table_from_part : (4, 4) array_like, optional
    tool_length : float
        mm

    Raises
    ------
    InvalidInput
        When places do not ascend, the speed is not above zero, or the machine cannot follow.

    Notes
    -----
    Derivatives are central differences: of the second order in the distance between points.
    """
    s = np.asarray(places, dtype=float)
    if len(s) != len(path.cl) or not (np.diff(s) > 0).all():
        raise InvalidInput(f"{len(s)} places for {len(path.cl)} points: one for each is needed, ascending")
    if not speed > 0:
        raise InvalidInput(f"speed is {speed} mm/s: it must be above zero")
    found = following(machine, path, table_from_part, tool_length)
    kept = np.concatenate([found.arrival[1:] != found.arrival[:-1], [True]])
    rows = np.hstack([found.linear, found.rotary])[kept]
    velocity = np.gradient(rows, s / speed, axis=0, edge_order=2)
    names = (*(axis.name for axis in machine.linear), *(axis.name for axis in machine.rotary))
    return AxisMotion(names, s, rows, velocity, np.gradient(velocity, s / speed, axis=0, edge_order=2))
