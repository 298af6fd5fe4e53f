"""What the limits of the axes leave of velocity, acceleration and jerk along a path."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.machine.machine import Machine
from toolaxis.numeric.vectors import as_rows

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class AxisBounds:
    """Greatest velocity, acceleration and jerk of each axis.

    Attributes
    ----------
    velocity, acceleration, jerk : (m,) array
        mm or rad, and s.

    Raises
    ------
    InvalidInput
        When one is not above zero.
    """

    velocity: Array
    acceleration: Array
    jerk: Array

    def __post_init__(self) -> None:
        count = len(np.atleast_1d(self.velocity))
        for name in ("velocity", "acceleration", "jerk"):
            values = np.atleast_1d(np.asarray(getattr(self, name), dtype=float))
            if values.shape != (count,) or not (np.isfinite(values).all() and (values > 0).all()):
                raise InvalidInput(f"{name} limits are {values.tolist()}: {count} finite numbers above zero are needed")
            object.__setattr__(self, name, values)

    def along(self, directions: ArrayLike, feeds: ArrayLike) -> tuple[Array, Array, Array]:
        """Path limits where each axis moves by a constant share of the path's length.

        Parameters
        ----------
        directions : (n, m) array_like
            Axis motion per mm of path.
        feeds : (n,) array_like
            Programmed velocity of the tool's tip, mm/s; infinite for rapid motion.

        Returns
        -------
        velocity, acceleration, jerk : (n,) arrays

        Raises
        ------
        InvalidInput
            When a feed is not above zero, or no axis moves.
        """
        rows = np.abs(as_rows(directions, len(self.velocity), "axis direction"))
        wanted = np.broadcast_to(np.asarray(feeds, dtype=float), (len(rows),))
        if not (wanted > 0).all():
            slow = int(np.flatnonzero(~(wanted > 0))[0])
            raise InvalidInput(f"feed {slow} is {wanted[slow]} mm/s: it must be above zero")
        if not rows.any(axis=1).all():
            raise InvalidInput(f"segment {int(np.flatnonzero(~rows.any(axis=1))[0])} moves no axis: leave it out")
        with np.errstate(divide="ignore"):
            velocity, acceleration, jerk = ((limit / rows).min(axis=1)
                                            for limit in (self.velocity, self.acceleration, self.jerk))
        return np.minimum(velocity, wanted), acceleration, jerk


def linear_bounds(machine: Machine) -> AxisBounds:
    """Bounds of the three linear axes.

    Parameters
    ----------
    machine : Machine

    Raises
    ------
    InvalidInput
        When the machine does not know its accelerations or jerks.
    """
    levels = np.array([axis.drive.levels(axis.name) for axis in machine.linear])
    return AxisBounds(levels[:, 0], levels[:, 1], levels[:, 2])


def check_path(points: ArrayLike, tips: ArrayLike, feed: float, width: int) -> tuple[Array, Array, Array]:
    """Axis positions and tips of a curved path, checked, and the way of the tip to each.

    Parameters
    ----------
    points : (n, width) array_like
        mm or rad
    tips : (n, 3) array_like
        mm
    feed : float
        mm/s
    width : int
        Number of axes.

    Returns
    -------
    (n, width), (n, 3) and (n,) arrays

    Raises
    ------
    InvalidInput
        When there are fewer than six points, shapes do not fit, points coincide, or the feed is not above zero.
    """
    joints, rows = as_rows(points, width, "joint coordinates"), as_rows(tips, 3, "tips")
    if len(joints) != len(rows) or len(rows) < 6:
        raise InvalidInput(f"{len(joints)} joint positions for {len(rows)} tips: six or more of each are needed")
    if not feed > 0:
        raise InvalidInput(f"feed is {feed} mm/s: it must be above zero")
    steps = np.linalg.norm(np.diff(rows, axis=0), axis=1)
    if not (steps > 0).all():
        raise InvalidInput(f"points {int(np.argmin(steps))} and the next coincide: leave one out")
    return joints, rows, np.concatenate([[0.0], np.cumsum(steps)])
