"""The whole rotating solid: cutter, shank, holder and how far the cutter sticks out."""

from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import degrees
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.plugins import one_of
from toolaxis.tools.profile import Profile
from toolaxis.tools.registry import cutter_named, cutters, short_forms
from toolaxis.tools.sizes import positive
from toolaxis.tools.solid import COMPONENTS, Distance, signed_distance, solid_pieces

Array = NDArray[np.float64]

#: What a tool may have besides its sizes.
PROPERTIES = ("flute_length", "stickout", "shank", "holder", "title", "number", "feedrate", "spindle")


def _outline(name: str, rows: ArrayLike | None) -> Array | None:
    """Check a polyline of (radius, z) rows."""
    if rows is None:
        return None
    try:
        line = np.array(rows, dtype=float)
    except (TypeError, ValueError) as reason:
        raise InvalidInput(f"{name} is {rows!r}: rows of (radius, z) in mm are needed") from reason
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
        One of `toolaxis.tools.registry.cutters`: "torus", "ball", "flat", "tapered" and what was added to them.
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
        (radius, z) from the tip; counted from the end of the cutting edge up to the holder, see `outlines`.
    holder : (k, 2) array or None
        (radius, z) from the holder's own lower face, which stands at the stick-out.
    title : str
        What the shop calls it, "Bull nose D12 R1, ER20, 60 out"; empty where nobody said.
    number : int
        Its place in the machine's magazine; 0 where nobody said.
    feedrate : float or None
        mm/min, where it is the tool's own.
    spindle : float or None
        rev/min, where it is the tool's own.
    """

    kind: str
    radius: float
    corner_radius: float
    half_angle: float
    flute_length: float
    stickout: float | None = None
    shank: Array | None = None
    holder: Array | None = None
    title: str = ""
    number: int = 0
    feedrate: float | None = None
    spindle: float | None = None

    @cached_property
    def _key(self) -> tuple[Any, ...]:
        return tuple(value.tobytes() if isinstance(value, np.ndarray) else value
                     for value in (getattr(self, one.name) for one in fields(self)))

    def __eq__(self, other: object) -> bool:
        """Whether all of both is the same: plans tell their tools apart so, in other processes too."""
        return isinstance(other, Tool) and self._key == other._key

    def __hash__(self) -> int:
        """The same for tools that are equal."""
        return hash(self._key)

    @staticmethod
    def torus(diameter: float, corner_radius: float, **body: Any) -> "Tool":
        """A bull-nose end mill: flat bottom, corner arc, cylindrical side.

        Parameters
        ----------
        diameter, corner_radius : float
            mm, with 0 < corner_radius <= diameter / 2.
        **body
            flute_length, stickout, shank, holder, title, number, feedrate, spindle: see `Tool.build`.
        """
        return Tool.of("torus", diameter, corner_radius, **body)

    @staticmethod
    def ball(diameter: float, **body: Any) -> "Tool":
        """A ball end mill.

        Parameters
        ----------
        diameter : float
            mm
        **body
            flute_length, stickout, shank, holder, title, number, feedrate, spindle: see `Tool.build`.
        """
        return Tool.of("ball", diameter, **body)

    @staticmethod
    def flat(diameter: float, **body: Any) -> "Tool":
        """A flat end mill with a sharp corner.

        Parameters
        ----------
        diameter : float
            mm
        **body
            flute_length, stickout, shank, holder, title, number, feedrate, spindle: see `Tool.build`.
        """
        return Tool.of("flat", diameter, **body)

    @staticmethod
    def tapered(diameter: float, corner_radius: float, half_angle_deg: float, **body: Any) -> "Tool":
        """A cutter with a conical side.

        Parameters
        ----------
        diameter : float
            mm, at the tip: twice the sum of the flat bottom's radius and the corner radius.  A tapered ball of
            diameter 6 has a ball of diameter 6 at its end; its side leaves the ball a little below the widest circle
            and is wider than 6 above.
        corner_radius : float
            mm; diameter / 2 makes a tapered ball.
        half_angle_deg : float
            Inclination of the side from the axis, degrees, above 0 and below 80.
        **body
            flute_length, stickout, shank, holder, title, number, feedrate, spindle: see `Tool.build`.
        """
        return Tool.of("tapered", diameter, corner_radius, half_angle_deg, **body)

    @staticmethod
    def of(kind: str, *sizes: Any, **body: Any) -> "Tool":
        """A tool of any kind from its sizes.

        Parameters
        ----------
        kind : str
            One of `toolaxis.tools.registry.cutters`.
        *sizes
            In the order of the kind's short form, mm and degrees.
        **body
            flute_length, stickout, shank, holder, title, number, feedrate, spindle: see `Tool.build`.

        Raises
        ------
        InvalidInput
            When there is no such kind, or the sizes make none.
        """
        cutter = cutter_named(kind)
        if len(sizes) != len(cutter.sizes):
            raise InvalidInput(f"{len(sizes)} sizes are given: a {kind} needs {', '.join(cutter.sizes)}")
        return Tool.build(kind, *cutter.radii(*sizes), **body)

    @staticmethod
    def build(kind: str, radius: float, corner_radius: float, half_angle: float, **body: Any) -> "Tool":
        """A tool from radii; `of` calls it.

        Parameters
        ----------
        kind : str
            One of `toolaxis.tools.registry.cutters`.
        radius, corner_radius : float
            mm
        half_angle : float
            rad
        **body
            flute_length : float, optional
                Length of the cutting edge from the tip, mm; two diameters unless given, and never beyond the stick-out.
            stickout : float, optional
                Tip to the holder's lower face, mm.
            shank : rows of (radius, z), optional
                From the tip, z not decreasing; what lies below the end of the cutting edge is the cutter's and not
                counted.  Unless given, the shank is as thick as the cutter's upper end.
            holder : rows of (radius, z), optional
                From the holder's own lower face, z not decreasing; needs a stick-out.
            title : str, optional
                What the shop calls it.
            number : int, optional
                Its place in the magazine, 1 or more.
            feedrate : float, optional
                mm/min; that of the plan unless given.
            spindle : float, optional
                rev/min; that of the plan unless given.

        Raises
        ------
        InvalidInput
            When there is no such kind, or a size makes no tool.
        """
        cutter_named(kind)
        unknown = set(body) - set(PROPERTIES)
        if unknown:
            raise InvalidInput(f"tool has no property {sorted(unknown)[0]!r}: use {one_of(PROPERTIES)}")
        if corner_radius > radius:
            raise InvalidInput(f"corner radius is {corner_radius} mm, above the radius {radius} mm: "
                               "it can be at most half the diameter")
        stick = None if body.get("stickout") is None else positive("stick-out", body["stickout"])
        flute = _flute(4 * radius, body.get("flute_length"), corner_radius, stick)
        shank, holder = _outline("shank", body.get("shank")), _outline("holder", body.get("holder"))
        if holder is not None and stick is None:
            raise InvalidInput("a holder is given without a stick-out: give the length from tip to holder")
        rates = [None if body.get(name) is None else positive(name, body[name], unit)
                 for name, unit in (("feedrate", "mm/min"), ("spindle", "rev/min"))]
        return Tool(kind, radius, corner_radius, half_angle, flute, stick, shank, holder, str(body.get("title") or ""),
                    _number(body.get("number")), *rates)

    @staticmethod
    def parse(text: str, **body: Any) -> "Tool":
        """A tool from its short form, such as torus:12x1, ball:8 or tapered:6x3x4 (diameter x corner x degrees).

        Parameters
        ----------
        text : str
        **body
            flute_length, stickout, shank, holder, title, number, feedrate, spindle: see `Tool.build`.

        Raises
        ------
        InvalidInput
            When the text is not of that form.
        """
        kind, _, sizes = text.strip().lower().partition(":")
        known = cutters()
        try:
            numbers = [float(part) for part in sizes.split("x")]
        except ValueError:
            numbers = []
        if kind not in known or len(numbers) != len(known[kind].sizes):
            raise InvalidInput(f"tool {text!r} is not understood: write {short_forms()}")
        return Tool.of(kind, *numbers, **body)

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
        known = {"diameter": repr(2 * self.radius), "corner_radius": repr(self.corner_radius),
                 "half_angle_deg": f"{degrees(self.half_angle):.12g}"}
        sizes = [known[name] for name in cutter_named(self.kind).sizes]
        return f"{self.kind}:" + "x".join(size.removesuffix(".0") for size in sizes)

    @property
    def shop_name(self) -> str:
        """Its title; "Bull nose D12 R1, 60 out", from sizes and stick-out, where it has none."""
        if self.title:
            return self.title
        cutter = cutter_named(self.kind).shop_name(2 * self.radius, self.corner_radius, degrees(self.half_angle))
        return cutter if self.stickout is None else f"{cutter}, {self.stickout:.6g} out"

    @property
    def outlines(self) -> dict[str, Array]:
        """Polylines (radius, z from the tip) of the components that are known: shank above the flutes, and holder.

        No height between the end of the flutes and the holder is left empty: a shank that begins higher goes down
        with the larger of its own and the cutter's radius, one that ends below the holder goes on up to it, and a tool
        with a stick-out and no shank has a plain one of the radius at the end of its flutes.
        """
        found: dict[str, Array] = {}
        line = self._shank_line()
        if line is not None:
            found["shank"] = line
        if self.holder is not None and self.stickout is not None:
            found["holder"] = self.holder + np.array([0.0, self.stickout - self.holder[0, 1]])
        return found

    @cached_property
    def pieces(self) -> Array:
        """All convex pieces, the cutter first, (k, 8); see `toolaxis.tools.solid`."""
        return solid_pieces(self.profile, self.outlines)

    @property
    def gauge_length(self) -> float | None:
        """From the tip to the holder's upper end, where the spindle's gauge point is, mm; None without a holder."""
        outline = self.outlines.get("holder")
        return None if outline is None else float(outline[-1, 1])

    @property
    def height(self) -> float:
        """Height above the tip up to which the tool is known, mm."""
        return max(self.flute_length, *(float(line[:, 1].max()) for line in self.outlines.values()), 0.0)

    def carried_on(self, height: float) -> "Tool":
        """The tool with its uppermost known component carried on upwards as a cylinder, for whatever holds it.

        Parameters
        ----------
        height : float
            Height above the tip that the tool shall reach at least, mm.
        """
        if height <= self.height:
            return self
        if self.holder is not None and self.stickout is not None:
            return replace(self, holder=_carry_on(self.holder, height - self.height))
        if not self.outlines and self.half_angle == 0:
            return replace(self, flute_length=height)
        end = self.outlines.get("shank", np.array([[self.profile.top_radius, self.flute_length]]))
        return replace(self, shank=_carry_on(end, height - self.height))

    def with_ball_end(self) -> "Tool":
        """A ball end mill of the same radius in the same holder: what 3-axis machining takes.

        Raises
        ------
        InvalidInput
            When a ball of that radius does not fit below the stick-out.
        """
        flute = self.flute_length if self.flute_length > self.radius else None
        return Tool.ball(2 * self.radius, flute_length=flute, stickout=self.stickout, shank=self.shank,
                         holder=self.holder, feedrate=self.feedrate, spindle=self.spindle)

    def distance(self, points: ArrayLike, component: str | None = None) -> Distance:
        """Exact signed distance of points from the whole rotating solid, or from one component.

        Parameters
        ----------
        points : (n, 3) array_like
            In the tool's frame: tip at the origin, axis along +z, mm.
        component : str, optional
            "cutter", "shank" or "holder"; their union unless given.

        Raises
        ------
        InvalidInput
            When the tool has no such component, or the points are not rows of three finite numbers.
        """
        pieces = self.pieces
        if component is None:
            return signed_distance(pieces, points)
        known = [name for name in COMPONENTS if name == "cutter" or name in self.outlines]
        if component not in known:
            raise InvalidInput(f"tool {self.name} has no {component!r}: it has {', '.join(known)}")
        return signed_distance(pieces[pieces[:, 7] == COMPONENTS.index(component)], points)

    def _shank_line(self) -> Array | None:
        top, end = self.profile.top_radius, self.flute_length
        line = np.empty((0, 2)) if self.shank is None else _above(self.shank, end)
        if self.stickout is not None and self.stickout > (line[-1, 1] if len(line) else end):
            last = top if self.shank is None else self.shank[-1, 0]
            line = np.vstack([line if len(line) else [[last, end]], [[last, self.stickout]]])
        if not len(line):
            return None
        if line[0, 1] > end:
            wide = max(top, line[0, 0])
            line = np.vstack([[[wide, end], [wide, line[0, 1]]], line])
        return line


def _number(given: Any) -> int:
    """A place in the magazine; 0 for none."""
    if given is None:
        return 0
    if isinstance(given, bool) or not isinstance(given, int) or given < 1:
        raise InvalidInput(f"tool number is {given!r}: it must be a whole number from 1")
    return given


def _flute(usual: float, given: Any, corner_radius: float, stickout: float | None) -> float:
    """Length of the cutting edge: the one given, or the usual one as far as the stick-out allows."""
    length = usual if given is None else positive("flute length", given)
    if stickout is not None and given is None:
        length = min(length, stickout)
        if length <= corner_radius:
            raise InvalidInput(f"stick-out is {stickout} mm, not above the corner radius {corner_radius} mm: "
                               "the holder would stand in the cutting edge")
    if length <= corner_radius:
        raise InvalidInput(f"flute length is {length} mm: it must exceed the corner radius {corner_radius} mm")
    if stickout is not None and length > stickout:
        raise InvalidInput(f"flute length is {length} mm, above the stick-out {stickout} mm: "
                           "lengthen the stick-out or shorten the cutting edge")
    return length


def _carry_on(line: Array, further: float) -> Array:
    """A polyline (radius, z) that goes on upwards from its upper end, as wide as it is there."""
    top = line[-1, 1]
    wide = line[line[:, 1] == top, 0].max()
    return np.vstack([line, [[wide, top], [wide, top + further]]])


def _above(line: Array, z: float) -> Array:
    """The part of a polyline (radius, z) that lies above a height; from the upper side of a step at that height."""
    if line[-1, 1] <= z:
        return np.empty((0, 2))
    below = int(np.searchsorted(line[:, 1], z, side="right")) - 1
    if below < 0 or line[below, 1] == z:
        return line[max(below, 0):]
    (r0, z0), (r1, z1) = line[below], line[below + 1]
    return np.vstack([[r0 + (r1 - r0) * (z - z0) / (z1 - z0), z], line[below + 1:]])
