"""Which tool axes a set-up allows, and how far an axis is from the nearest allowed one."""

from dataclasses import dataclass
from math import degrees, isfinite, pi, radians
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import angle_between, as_rows, unit

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Angle by which an axis may miss a limit before it counts as outside, rad: rounding, no tolerance.
ROUNDING = 1e-9


class AxisLimits(Protocol):
    """What any limit answers: a cone, rotary ranges, a machine."""

    def excess(self, axes: ArrayLike) -> Array:
        """Angle from each axis to the nearest allowed one, (n,) rad; 0 where it is allowed itself."""

    def allowed(self, axes: ArrayLike) -> Bools:
        """Whether each axis is allowed, (n,) bool."""


@dataclass(frozen=True, eq=False)
class Cone:
    """All axes within an angle of a direction.

    Attributes
    ----------
    direction : (3,) array
        Middle of the cone; made a unit vector.
    tilt : float
        Greatest angle to it, rad, from 0 to pi.

    Raises
    ------
    InvalidInput
        When the direction is none or the angle is out of range.
    """

    direction: Array
    tilt: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "direction", unit(as_rows(self.direction, 3, "direction of the cone")[0]))
        if not 0 <= self.tilt <= pi:
            raise InvalidInput(f"tilt of the cone is {self.tilt} rad: it must lie between 0 and pi")

    def excess(self, axes: ArrayLike) -> Array:
        """Angle from each axis to the cone, (n,) rad; 0 inside.

        Parameters
        ----------
        axes : (n, 3) array_like
        """
        return np.maximum(angle_between(unit(as_rows(axes, 3, "axis")), self.direction) - self.tilt, 0.0)

    def allowed(self, axes: ArrayLike) -> Bools:
        """Whether each axis lies in the cone, (n,) bool.

        Parameters
        ----------
        axes : (n, 3) array_like
        """
        return np.asarray(self.excess(axes) <= ROUNDING)


@dataclass(frozen=True, eq=False)
class RotaryRanges:
    """Two rotary ranges as spherical coordinates about a machine's z: tilt from z, turn about z.

    T = sin(tilt) (cos(turn) x + sin(turn) y) + cos(tilt) z.  The same axis has a second pair, (-tilt, turn + pi); it is
    allowed when either pair is.

    Attributes
    ----------
    tilt : (float, float)
        Least and greatest tilt (A or B), rad, within -pi to pi.
    turn : (float, float)
        Least and greatest turn (C), rad; a span of two pi or more is free.
    z : (3,) array
        Direction at tilt 0.
    x : (3,) array
        Direction of turn 0, projected on the plane normal to z.

    Raises
    ------
    InvalidInput
        When a range is reversed or not finite, or x has no direction across z.
    """

    tilt: tuple[float, float]
    turn: tuple[float, float] = (-pi, pi)
    z: ArrayLike = (0.0, 0.0, 1.0)
    x: ArrayLike = (1.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        for name in ("tilt", "turn"):
            low, high = getattr(self, name)
            if not (isfinite(low) and isfinite(high) and low <= high):
                raise InvalidInput(f"{name} range is {low} to {high} rad: it must be finite and not reversed")
        if self.tilt[0] < -pi or self.tilt[1] > pi:
            raise InvalidInput(f"tilt range is {self.tilt[0]} to {self.tilt[1]} rad: it must lie within -pi to pi")
        z = unit(as_rows(self.z, 3, "z of the rotary ranges")[0])
        x = as_rows(self.x, 3, "x of the rotary ranges")[0]
        x = x - (x @ z) * z
        if not np.linalg.norm(x) > 1e-9:
            raise InvalidInput("x of the rotary ranges is along z: give a direction across it")
        object.__setattr__(self, "z", z)
        object.__setattr__(self, "x", unit(x))

    def excess(self, axes: ArrayLike) -> Array:
        """Angle from each axis to the nearest one within both ranges, (n,) rad; 0 inside.

        Parameters
        ----------
        axes : (n, 3) array_like
        """
        rows = unit(as_rows(axes, 3, "axis"))
        low, high = self.tilt
        best = np.full(len(rows), np.inf)
        for first, last, shift in ((max(low, 0.0), high, 0.0), (max(-high, 0.0), -low, pi)):
            if last >= first:
                best = np.minimum(best, self._distance(rows, (first, last), shift))
        return best

    def _distance(self, rows: Array, tilts: tuple[float, float], shift: float) -> Array:
        """Angle to the patch of the sphere with tilts in a range and turns in the range moved by a shift."""
        x, z = np.asarray(self.x), np.asarray(self.z)
        y = np.cross(z, x)
        across = np.hypot(rows @ x, rows @ y)
        tilt = np.arctan2(across, rows @ z)
        off: Array = np.maximum(np.maximum(tilts[0] - tilt, tilt - tilts[1]), 0.0)
        low, high = self.turn[0] + shift, self.turn[1] + shift
        if high - low >= 2 * pi - ROUNDING:
            return off
        turn = low + np.mod(np.arctan2(rows @ y, rows @ x) - low + ROUNDING, 2 * pi) - ROUNDING
        inside = (turn <= high + ROUNDING) | (across <= ROUNDING)
        edges = [self._to_meridian(rows, tilts, np.cos(t) * x + np.sin(t) * y) for t in (low, high)]
        return np.where(inside, off, np.minimum(*edges))

    def _to_meridian(self, rows: Array, tilts: tuple[float, float], across: Array) -> Array:
        """Angle to the arc from tilt to tilt on the half great circle through z and a direction across it."""
        z = np.asarray(self.z)
        nearest = np.clip(np.arctan2(rows @ across, rows @ z), *tilts)
        ends = [np.full(len(rows), tilt) for tilt in tilts]
        places = [np.sin(tilt)[:, None] * across + np.cos(tilt)[:, None] * z for tilt in (nearest, *ends)]
        angles = [angle_between(rows, place) for place in places]
        return np.asarray(np.min(angles, axis=0))

    def allowed(self, axes: ArrayLike) -> Bools:
        """Whether each axis lies within both ranges, (n,) bool.

        Parameters
        ----------
        axes : (n, 3) array_like
        """
        return np.asarray(self.excess(axes) <= 3 * ROUNDING)


@dataclass(frozen=True, eq=False)
class AllOf:
    """Several limits at once.

    Attributes
    ----------
    parts : tuple of AxisLimits
    """

    parts: tuple[AxisLimits, ...]

    def excess(self, axes: ArrayLike) -> Array:
        """Angle to the limit that is missed most, (n,) rad: a lower bound of the way to an axis that all allow.

        Parameters
        ----------
        axes : (n, 3) array_like
        """
        rows = as_rows(axes, 3, "axis")
        return np.asarray(np.max([np.zeros(len(rows)), *(part.excess(rows) for part in self.parts)], axis=0))

    def allowed(self, axes: ArrayLike) -> Bools:
        """Whether all parts allow each axis, (n,) bool.

        Parameters
        ----------
        axes : (n, 3) array_like
        """
        rows = as_rows(axes, 3, "axis")
        return np.asarray(np.all([np.ones(len(rows), bool), *(part.allowed(rows) for part in self.parts)], axis=0))


def refusal(limits: AxisLimits, axis: ArrayLike) -> str:
    """Why limits forbid an axis, in words; empty where they allow it.

    Parameters
    ----------
    limits : AxisLimits
        A limit with a method `why` says it itself, as a machine does.
    axis : (3,) array_like
    """
    one = as_rows(axis, 3, "axis")[:1]
    if bool(limits.allowed(one)[0]):
        return ""
    if isinstance(limits, AllOf):
        return "; ".join(filter(None, (refusal(part, one) for part in limits.parts)))
    if hasattr(limits, "why"):
        return str(limits.why(one))
    return f"the axis is {degrees(float(limits.excess(one)[0])):.2f} deg outside the limits"


#: How the short forms of limits begin.
SHORT_FORMS = ("cone:", "rotary:")
_FORMS = "write cone:X,Y,Z,DEG or rotary:tilt=A..B,turn=C..D,z=X/Y/Z,x=X/Y/Z (degrees), several joined by +"


def parse_limits(text: str) -> AxisLimits:
    """Limits from their short form, angles in degrees.

    ``cone:0,0,1,45`` is all axes within 45 degrees of +z.  ``rotary:tilt=-5..110,turn=-360..360`` is a tilt range about
    +z with a turn range counted from +x; ``z=0/0/1`` and ``x=1/0/0`` state other directions.  ``+`` joins limits that
    hold together.

    Parameters
    ----------
    text : str

    Raises
    ------
    InvalidInput
        When the text is not of that form or a value is out of range.
    """
    parts = [_parse_one(piece.strip(), text) for piece in text.split("+")]
    return parts[0] if len(parts) == 1 else AllOf(tuple(parts))


def format_limits(limits: AxisLimits | None) -> str:
    """The short form of limits, which `parse_limits` reads back; empty for none.

    Parameters
    ----------
    limits : AxisLimits or None

    Returns
    -------
    str
        "a Mill" for limits of a class that has no short form.
    """
    if limits is None:
        return ""
    if isinstance(limits, AllOf):
        return "+".join(format_limits(part) for part in limits.parts)
    if isinstance(limits, Cone):
        return "cone:" + ",".join(repr(float(x)) for x in (*limits.direction, degrees(limits.tilt)))
    if isinstance(limits, RotaryRanges):
        ranges = [f"{name}={degrees(pair[0])!r}..{degrees(pair[1])!r}"
                  for name, pair in (("tilt", limits.tilt), ("turn", limits.turn))]
        ways = [f"{name}={'/'.join(repr(float(x)) for x in np.asarray(way))}"
                for name, way in (("z", limits.z), ("x", limits.x))]
        return "rotary:" + ",".join(ranges + ways)
    return f"a {type(limits).__name__}"


def _parse_one(piece: str, text: str) -> AxisLimits:
    kind, _, rest = piece.partition(":")
    try:
        if kind == "cone":
            x, y, z, tilt = (float(number) for number in rest.split(","))
            return Cone(np.array([x, y, z]), radians(tilt))
        if kind == "rotary":
            return _parse_rotary(dict(item.split("=") for item in rest.split(",")))
    except InvalidInput:
        raise
    except ValueError:
        pass
    raise InvalidInput(f"limits {text!r} are not understood: {_FORMS}")


def _parse_rotary(items: dict[str, str]) -> RotaryRanges:
    ranges = {name: tuple(radians(float(number)) for number in items.pop(name, "-180..180").split(".."))
              for name in ("tilt", "turn")}
    ways = {name: np.array([float(number) for number in items.pop(name).split("/")])
            for name in ("z", "x") if name in items}
    if items or any(len(pair) != 2 for pair in ranges.values()):
        raise ValueError
    return RotaryRanges(ranges["tilt"], ranges["turn"], **ways)  # type: ignore[arg-type]
