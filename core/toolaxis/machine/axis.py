"""One axis of a machine: where it moves, how far, and how fast.

The sign of every axis is that of the tool's motion relative to the part (ISO 841), whoever of the two moves.
"""

from dataclasses import dataclass
from math import inf, isfinite, isnan

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.rotations import ROUNDING
from toolaxis.numeric.vectors import as_rows, unit

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

LINEAR_NAMES = ("X", "Y", "Z", "U", "V", "W")
ROTARY_NAMES = ("A", "B", "C")


@dataclass(frozen=True)
class Drive:
    """What one axis can do: greatest velocity, acceleration and jerk, in mm or rad and s.

    Attributes
    ----------
    velocity : float
    acceleration, jerk : float or None
        None where a machine file does not say it; feed planning needs both.
    """

    velocity: float
    acceleration: float | None = None
    jerk: float | None = None

    def check(self, axis: str) -> None:
        """Refuse what no drive can be.

        Parameters
        ----------
        axis : str
            Its name, for the message.

        Raises
        ------
        InvalidInput
        """
        for name, value in (("velocity", self.velocity), ("acceleration", self.acceleration), ("jerk", self.jerk)):
            if value is not None and not (isfinite(value) and value > 0):
                raise InvalidInput(f"{name} of axis {axis} is {value}: it must be a finite number above zero")

    def levels(self, axis: str) -> tuple[float, float, float]:
        """Velocity, acceleration and jerk, all known.

        Parameters
        ----------
        axis : str
            Its name, for the message.

        Raises
        ------
        InvalidInput
            When one of them is not known.
        """
        if self.acceleration is None or self.jerk is None:
            missing = "acceleration" if self.acceleration is None else "jerk"
            raise InvalidInput(f"axis {axis} has no {missing}: state its limit in the machine's file to plan feeds")
        return self.velocity, self.acceleration, self.jerk


@dataclass(frozen=True, eq=False)
class LinearAxis:
    """A straight motion of the tool relative to the part.

    Attributes
    ----------
    name : str
        X, Y, Z, U, V or W.
    direction : (3,) array
        Where the tool goes relative to the part for growing coordinates; made a unit vector.
    drive : Drive
    low, high : float
        Travel, mm; infinite where it does not matter.
    """

    name: str
    direction: Array
    drive: Drive
    low: float = -inf
    high: float = inf

    def __post_init__(self) -> None:
        _check_name(self.name, LINEAR_NAMES, "linear")
        object.__setattr__(self, "direction", _direction(self.direction, self.name))
        _check_range(self.name, self.low, self.high, "mm")
        self.drive.check(self.name)

    def excess(self, values: ArrayLike) -> Array:
        """How far coordinates are out of travel, mm; 0 inside.

        Parameters
        ----------
        values : array_like
            mm.
        """
        q = np.asarray(values, dtype=float)
        return np.asarray(np.maximum(np.maximum(self.low - q, q - self.high), 0.0))


@dataclass(frozen=True, eq=False)
class RotaryAxis:
    """A turn of the tool relative to the part.

    Attributes
    ----------
    name : str
        A, B or C.
    direction : (3,) array
        Axis about which the tool turns right-handed relative to the part for growing angles, all axes at zero; made a
        unit vector.  A table that carries the part turns the part the other way round.
    point : (3,) array
        A point of the axis in machine coordinates, all axes at zero, mm.
    drive : Drive or None
        None for an axis that is set by hand.
    low, high : float
        Range, rad; infinite where it turns without end.
    increment : float
        Step in which an indexed angle can be held, rad; 0 for any.
    """

    name: str
    direction: Array
    point: Array
    drive: Drive | None
    low: float = -inf
    high: float = inf
    increment: float = 0.0

    def __post_init__(self) -> None:
        _check_name(self.name, ROTARY_NAMES, "rotary")
        object.__setattr__(self, "direction", _direction(self.direction, self.name))
        object.__setattr__(self, "point", as_rows(self.point, 3, f"point of axis {self.name}")[0])
        _check_range(self.name, self.low, self.high, "rad")
        if not (isfinite(self.increment) and 0 <= self.increment < np.pi):
            raise InvalidInput(f"increment of axis {self.name} is {self.increment} rad: it must lie from 0 to below pi")
        if self.drive is not None:
            self.drive.check(self.name)

    @property
    def by_hand(self) -> bool:
        """Whether it is set by hand and stands still while the machine moves."""
        return self.drive is None

    def within(self, angles: ArrayLike, near: ArrayLike = 0.0) -> tuple[Array, Bools]:
        """The same positions by whole turns: inside the range where that can be, and there nearest to a given angle.

        Parameters
        ----------
        angles : array_like
            rad.
        near : array_like
            Where the axis stands, rad.

        Returns
        -------
        angles : array
            rad; where no whole number of turns leads into the range, the one that misses it least.
        inside : array of bool
            Whether they are inside.
        """
        values, turn = np.asarray(angles, dtype=float), 2 * np.pi
        least = np.ceil((self.low - values - ROUNDING) / turn)
        most = np.floor((self.high - values + ROUNDING) / turn)
        inside = least <= most
        wanted = np.round((np.asarray(near, dtype=float) - values) / turn)
        above, below = values + turn * least - self.high, self.low - values - turn * most
        outside = np.where(above <= below, least, most)
        turns = np.where(inside, np.clip(wanted, np.minimum(least, most), most), outside)
        return np.asarray(values + turn * turns), np.asarray(inside)

    def turns(self, angle: float) -> Array:
        """All angles inside the range that are the same position, ascending, rad.

        Parameters
        ----------
        angle : float
            rad.

        Raises
        ------
        InvalidInput
            When the range has no end: there are infinitely many.
        """
        if not (isfinite(self.low) and isfinite(self.high)):
            raise InvalidInput(f"axis {self.name} turns without end: every whole turn is one more position")
        turn = 2 * np.pi
        least = np.ceil((self.low - angle - ROUNDING) / turn)
        most = np.floor((self.high - angle + ROUNDING) / turn)
        return np.asarray(angle + turn * np.arange(least, most + 1))

    def rounded(self, angles: ArrayLike) -> Array:
        """Angles rounded to the steps in which the axis can be held, rad.

        Parameters
        ----------
        angles : array_like
            rad.
        """
        values = np.asarray(angles, dtype=float)
        return values if self.increment == 0 else np.asarray(np.round(values / self.increment) * self.increment)


def _check_name(name: str, known: tuple[str, ...], kind: str) -> None:
    if name not in known:
        raise InvalidInput(f"{name!r} is no name of a {kind} axis: use one of {', '.join(known)}")


def _direction(direction: Array, name: str) -> Array:
    rows = as_rows(direction, 3, f"direction of axis {name}")
    if len(rows) != 1 or not np.linalg.norm(rows[0]) > 0:
        raise InvalidInput(f"direction of axis {name} is {np.asarray(direction).tolist()}: three numbers, not all "
                           "zero, are needed")
    return unit(rows[0])


def _check_range(name: str, low: float, high: float, unit_name: str) -> None:
    if isnan(low) or isnan(high) or not low <= high:
        raise InvalidInput(f"limits of axis {name} are {low} to {high} {unit_name}: the lower one comes first")
