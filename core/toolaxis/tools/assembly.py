"""The whole rotating solid: cutter, shank, holder and how far the cutter sticks out."""

from dataclasses import dataclass
from math import isfinite, pi, radians

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.tools.profile import Profile

Array = NDArray[np.float64]


def _positive(name: str, value: float) -> float:
    if not (isfinite(value) and value > 0):
        raise InvalidInput(f"{name} is {value} mm: it must be a finite number above zero")
    return float(value)


def _outline(name: str, rows: ArrayLike | None) -> Array | None:
    """Check a polyline of (radius, z) rows."""
    if rows is None:
        return None
    line = np.asarray(rows, dtype=float)
    if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2 or not np.isfinite(line).all():
        raise InvalidInput(f"{name} has shape {line.shape}: at least two finite (radius, z) rows are needed")
    if (line[:, 0] < 0).any() or not (line[:, 0] > 0).any():
        i = int(np.argmin(line[:, 0]))
        raise InvalidInput(f"{name} radius {i} is {line[i, 0]} mm: a {name} cannot be thinner than nothing")
    if (np.diff(line[:, 1]) < 0).any():
        i = int(np.argmax(np.diff(line[:, 1]) < 0)) + 1
        raise InvalidInput(f"{name} z {i} is {line[i, 1]} mm, below the one before: z must not decrease")
    if not line[-1, 1] > line[0, 1]:
        raise InvalidInput(f"{name} has no length: its last z must lie above its first")
    return line


@dataclass(frozen=True, eq=False)
class Tool:
    """A rotating cutter with its shank and holder; all lengths in mm.

    Attributes
    ----------
    kind : str
        "torus", "ball", "flat" or "tapered".
    radius : float
        Radius R where the corner arc ends (flat bottom plus corner radius).
    corner_radius : float
        r.
    half_angle : float
        Inclination of the side from the axis, rad.
    flute_length : float
        Length of the cutting edge from the tip.
    stickout : float or None
        Length from the tip to the holder's lower face.
    shank : (k, 2) array or None
        (radius, z) from the tip; counted above the cutting edge.
    holder : (k, 2) array or None
        (radius, z) from the holder's own lower face, which stands at the stick-out.
    """

    kind: str
    radius: float
    corner_radius: float
    half_angle: float
    flute_length: float
    stickout: float | None = None
    shank: Array | None = None
    holder: Array | None = None

    @staticmethod
    def torus(diameter: float, corner_radius: float, **body: object) -> "Tool":
        """A bull-nose end mill: flat bottom, corner arc, cylindrical side.

        Parameters
        ----------
        diameter, corner_radius : float
            mm, with 0 < corner_radius <= diameter / 2.
        **body
            flute_length, stickout, shank, holder: see `Tool.build`.
        """
        corner = _positive("corner radius", corner_radius)
        return Tool.build("torus", _positive("diameter", diameter) / 2, corner, 0.0, **body)

    @staticmethod
    def ball(diameter: float, **body: object) -> "Tool":
        """A ball end mill.

        Parameters
        ----------
        diameter : float
            mm
        **body
            flute_length, stickout, shank, holder: see `Tool.build`.
        """
        radius = _positive("diameter", diameter) / 2
        return Tool.build("ball", radius, radius, 0.0, **body)

    @staticmethod
    def flat(diameter: float, **body: object) -> "Tool":
        """A flat end mill with a sharp corner.

        Parameters
        ----------
        diameter : float
            mm
        **body
            flute_length, stickout, shank, holder: see `Tool.build`.
        """
        return Tool.build("flat", _positive("diameter", diameter) / 2, 0.0, 0.0, **body)

    @staticmethod
    def tapered(diameter: float, corner_radius: float, half_angle_deg: float, **body: object) -> "Tool":
        """A cutter with a conical side.

        Parameters
        ----------
        diameter : float
            mm, of the circle in which the bottom plane and the side line would meet were the corner a torus of
            the same size: flat bottom radius is diameter / 2 - corner_radius.
        corner_radius : float
            mm; diameter / 2 makes a tapered ball.
        half_angle_deg : float
            Inclination of the side from the axis, degrees, above 0 and below 80.
        **body
            flute_length, stickout, shank, holder: see `Tool.build`.
        """
        if not (isfinite(half_angle_deg) and 0 < half_angle_deg < 80):
            raise InvalidInput(f"half angle is {half_angle_deg} deg: it must lie between 0 and 80")
        if not (isfinite(corner_radius) and corner_radius >= 0):
            raise InvalidInput(f"corner radius is {corner_radius} mm: it must be zero or more")
        return Tool.build("tapered", _positive("diameter", diameter) / 2, corner_radius, radians(half_angle_deg), **body)

    @staticmethod
    def build(kind: str, radius: float, corner_radius: float, half_angle: float, **body: object) -> "Tool":
        """A tool from radii; `torus`, `ball`, `flat` and `tapered` call it.

        Parameters
        ----------
        kind : str
        radius, corner_radius : float
            mm
        half_angle : float
            rad
        **body
            flute_length : float, optional
                Length of the cutting edge, mm; four radii unless given, and never beyond the stick-out.
            stickout : float, optional
                Tip to the holder's lower face, mm.
            shank : rows of (radius, z), optional
                From the tip; what lies below the cutting edge's end is the cutter's and not counted.
            holder : rows of (radius, z), optional
                From the holder's own lower face; needs a stick-out.

        Raises
        ------
        InvalidInput
            When a size makes no tool.
        """
        unknown = set(body) - {"flute_length", "stickout", "shank", "holder"}
        if unknown:
            raise InvalidInput(f"tool has no property {sorted(unknown)[0]!r}: "
                               "use flute_length, stickout, shank or holder")
        if corner_radius > radius:
            raise InvalidInput(f"corner radius is {corner_radius} mm, above the radius {radius} mm: "
                               "it can be at most half the diameter")
        stickout = body.get("stickout")
        stick = None if stickout is None else _positive("stick-out", float(stickout))  # type: ignore[arg-type]
        given = body.get("flute_length")
        flute = 4 * radius if given is None else _positive("flute length", float(given))  # type: ignore[arg-type]
        if stick is not None and given is None:
            flute = min(flute, stick)
        if flute <= corner_radius or (stick is not None and flute > stick):
            raise InvalidInput(f"flute length is {flute} mm: it must exceed the corner radius {corner_radius} mm and "
                               f"not the stick-out {stick} mm")
        shank, holder = _outline("shank", body.get("shank")), _outline("holder", body.get("holder"))  # type: ignore[arg-type]
        if holder is not None and stick is None:
            raise InvalidInput("a holder is given without a stick-out: give the length from tip to holder")
        return Tool(kind, radius, corner_radius, half_angle, flute, stick, shank, holder)

    @staticmethod
    def parse(text: str, **body: object) -> "Tool":
        """A tool from its short form: torus:12x1, ball:8, flat:20, tapered:6x3x4 (diameter x corner x degrees).

        Parameters
        ----------
        text : str
        **body
            flute_length, stickout, shank, holder: see `Tool.build`.

        Raises
        ------
        InvalidInput
            When the text is not of that form.
        """
        kind, _, sizes = text.strip().partition(":")
        counts = {"torus": 2, "ball": 1, "flat": 1, "tapered": 3}
        try:
            numbers = [float(part) for part in sizes.lower().split("x")]
        except ValueError:
            numbers = []
        if kind not in counts or len(numbers) != counts[kind]:
            raise InvalidInput(f"tool {text!r} is not understood: write torus:12x1, ball:8, flat:20 or tapered:6x3x4")
        maker = {"torus": Tool.torus, "ball": Tool.ball, "flat": Tool.flat, "tapered": Tool.tapered}[kind]
        return maker(*numbers, **body)  # type: ignore[operator, no-any-return]

    @property
    def flat_radius(self) -> float:
        """Radius a = R - r of the flat bottom, mm."""
        return self.radius - self.corner_radius

    @property
    def profile(self) -> Profile:
        """Generatrix of the cutter."""
        return Profile(self.flat_radius, self.corner_radius, self.half_angle, self.flute_length)

    @property
    def name(self) -> str:
        """The short form, as `parse` reads it."""
        sizes = {"torus": f"{2 * self.radius:g}x{self.corner_radius:g}", "ball": f"{2 * self.radius:g}",
                 "flat": f"{2 * self.radius:g}"}
        return f"{self.kind}:" + sizes.get(
            self.kind, f"{2 * self.radius:g}x{self.corner_radius:g}x{self.half_angle * 180 / pi:g}")

    @property
    def outlines(self) -> dict[str, Array]:
        """Polylines (radius, z from the tip) of the components that are known: shank above the flutes, and holder.

        A tool with a stick-out and no shank has a plain shank of the radius at the end of its flutes.
        """
        found: dict[str, Array] = {}
        if self.shank is not None:
            found["shank"] = _above(self.shank, self.flute_length)
        elif self.stickout is not None and self.stickout > self.flute_length:
            top = self.profile.top_radius
            found["shank"] = np.array([[top, self.flute_length], [top, self.stickout]])
        if self.holder is not None and self.stickout is not None:
            found["holder"] = self.holder - [0.0, self.holder[0, 1]] + [0.0, self.stickout]
        return {name: line for name, line in found.items() if len(line) > 1}


def _above(line: Array, z: float) -> Array:
    """The part of a polyline (radius, z) that lies above a height."""
    if line[-1, 1] <= z:
        return np.empty((0, 2))
    if line[0, 1] >= z:
        return line
    radius = np.interp(z, line[:, 1], line[:, 0])
    return np.vstack([[radius, z], line[line[:, 1] > z]])
