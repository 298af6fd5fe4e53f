"""What passes in every direction cost at places of a face: how wide their strip is, and how far the tip goes."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import DIVIDE
from toolaxis.contact.placement import place
from toolaxis.contact.strip.width import strip_width
from toolaxis.errors import UnsupportedGeometry
from toolaxis.numeric.vectors import dot
from toolaxis.path.parametrization import Cut
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Directions in half a turn at which widths are taken, and the highest harmonic of twice the angle that is kept of what
#: the form of second degree does not tell; the same of ball ends, whose form hardly misses anything.
_DIRECTIONS, _HARMONICS = 12, 4
_OF_BALL = 6, 2
#: The least value of a form, as a share of the square of the least width that was found.
_POSITIVE = 0.5
#: Strips narrower than this share of the widest at a place, or of the scallop height, count as so wide: series of
#: logarithms go no deeper.
_NARROW, _NARROWEST = 0.05, 1e-3
#: Rates with a parameter below this share of the face's diagonal over its range are those of a pole; ends of a face
#: nearer than this share of its diagonal meet.
_POLE, _MEET = 1e-6, 1e-6
#: Step of the differences of tips, as a share of the parameter range.
_STEP = 1e-5
#: Directions in half a turn among which the best one is looked for.
_TRIED = 64


class DirectionFunction(NamedTuple):
    """The logarithm of a positive number that depends on a direction, at n places.

    To the second order the square of the number is a form of second degree in the direction: how narrow strips are in
    the worst direction and how wide in the best. The logarithm of what is left is a series in twice the angle.

    form : (n, 3) array, the form's constant, cosine and sine of twice the angle
    cosine, sine : (n, m + 1) array, of the series; the first column of the sine is zero
    """

    form: Array
    cosine: Array
    sine: Array

    def at(self, double: tuple[Array, Array]) -> tuple[Array, Array]:
        """Values (n,), and their rates with the angle (n,), at one direction for each place.

        Parameters
        ----------
        double : (cosine, sine)
            Of twice the angle, (n,) each.
        """
        c, s = double
        constant, of_cosine, of_sine = self.form.T
        square = constant + of_cosine * c + of_sine * s
        value = 0.5 * np.log(square) + self.cosine[:, 0]
        rate = (of_sine * c - of_cosine * s) / square
        x = np.ones(len(c))
        y = np.zeros(len(c))
        for m in range(1, self.cosine.shape[1]):
            x, y = x * c - y * s, y * c + x * s
            a = self.cosine[:, m]
            b = self.sine[:, m]
            value += a * x + b * y
            rate += 2 * m * (b * x - a * y)
        return value, rate

    def over(self, angles: Array) -> Array:
        """Values (n, k) at k directions for every place.

        Parameters
        ----------
        angles : (k,) array
        """
        m = np.arange(self.cosine.shape[1])
        turns = 2 * m[:, None] * angles
        square = self.form @ _degree_two(angles)
        cosines = self.cosine @ np.cos(turns)
        sines = self.sine @ np.sin(turns)
        return np.asarray(0.5 * np.log(square) + cosines + sines)


@dataclass(frozen=True, eq=False)
class DirectionTable:
    """A face with a cut, made ready for fields of passes; make it with `tabulate_directions`.

    The angle of a direction is that of the way from pass to pass: from Su towards the other side of the face in which v
    grows.

    Attributes
    ----------
    face : Face
    uv : (n, 2) array
        Even places over the parameter range, u slowest, its borders among them: there passes are often narrowest.  Of
        all of it, or those on the face alone.
    count : int
        Places each way.
    area : (n,) array
        mm^2 of the face that a place stands for; 0 off the face.
    metric : (n, 3) array
        |Su|, and the components of Sv along Su and across it.
    width : DirectionFunction
        Of the strip width, mm, across passes that lie one after the other in the direction.
    tip : DirectionFunction
        Of the way of the tip per way of the contact along these passes.
    cut_everywhere : bool
        Whether every place has a strip in some direction.
    """

    face: Face
    uv: Array
    count: int
    area: Array
    metric: Array
    width: DirectionFunction
    tip: DirectionFunction
    cut_everywhere: bool

    @cached_property
    def ideal_length(self) -> float:
        """What passes tend to as the scallop height goes to zero, mm of the tip's motion.

        The integral over the face of the tip's way over the strip width, each place cut in its best direction. It is
        no bound: strips of finite height vary across, and contacts beside the face help.
        """
        angles = np.arange(_TRIED) * np.pi / _TRIED
        price = self.tip.over(angles) - self.width.over(angles)
        best = price.min(axis=1)
        return float(self.area @ np.exp(best))


def tabulate_directions(face: Face, cut: Cut, count: int, *, only_inside: bool = False) -> DirectionTable:
    """Widths of strips in all directions over a face.

    Parameters
    ----------
    face : Face
    cut : Cut
        With a fixed axis.
    count : int
        Places each way.
    only_inside : bool
        Leave out the places off the face: a field of passes needs them, the ideal length does not, and beside a small
        piece of a strongly curved face a strip takes long to measure.

    Raises
    ------
    UnsupportedGeometry
        Where the face closes on itself or has a pole inside.

    Notes
    -----
    Widths are exact: where the second order knows none, since a hollow is as tight as the cutter, strips of finite
    height still have one.

    **Properties**: 1. moving the face and the axis together changes nothing; 2. to the second order the width is
    sqrt(8 h k . D^-1 k) with D the difference of the second forms of cutter and surface, k the way from pass to pass.
    """
    _check_open(face)
    uv = even_places(face, count)
    area = areas_of_places(face, uv, count)
    if only_inside:
        inside = area > 0
        uv = uv[inside]
        area = area[inside]
    directions, harmonics = (_DIRECTIONS, _HARMONICS) if cut.tool.flat_radius > 0 else _OF_BALL
    angles = np.arange(directions) * np.pi / directions
    frame = feed_frame(face, uv)
    _, _, metric = frame
    every_uv = np.repeat(uv, directions, axis=0)
    feeds = feeds_in(frame, angles)
    halves = strip_width(face, cut.tool, every_uv, cut.axis, cut.scallop, feeds, cut.allowance)
    is_cut = (halves > 0).all(axis=1)
    width = np.where(is_cut, halves.sum(axis=1), 0.0).reshape(len(uv), directions)
    width = np.minimum(width, cut.greatest_step_over)
    widest = width.max(axis=1)
    narrowest = _NARROWEST * cut.scallop
    least = np.maximum(_NARROW * widest, narrowest)[:, None]
    widths = _fit(np.maximum(width, least), angles, harmonics)
    ways = _fit(_tip_ways(face, cut, uv, angles), angles, harmonics)
    has_strip = widest[area > 0] > narrowest
    return DirectionTable(face, uv, count, area, metric, widths, ways, bool(has_strip.all()))


def areas_of_places(face: Face, uv: Array, count: int) -> Array:
    """What of a face each of its even places stands for, (n,) mm^2; 0 off the face.

    Parameters
    ----------
    face : Face
    uv : (count^2, 2) array
        From `even_places`.
    count : int
    """
    inside = face.contains(uv)
    if not inside.any():  # a sliver between the places
        inside[:] = True
    u0, u1, v0, v1 = face.bounds
    d = face.evaluate(uv)
    share = np.ones(count)
    share[[0, -1]] = 0.5
    cell = np.outer(share, share).ravel() * (u1 - u0) * (v1 - v0) / (count - 1) ** 2
    stretch = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    area = np.where(inside, stretch * cell, 0.0)
    return np.asarray(area * (face.area / area.sum()))


def _check_open(face: Face) -> None:
    u0, u1, v0, v1 = face.bounds
    share = np.linspace(0.0, 1.0, 5)
    u = u0 + (u1 - u0) * share
    v = v0 + (v1 - v0) * share
    at_u0 = np.column_stack([np.full(5, u0), v])
    at_u1 = np.column_stack([np.full(5, u1), v])
    at_v0 = np.column_stack([u, np.full(5, v0)])
    at_v1 = np.column_stack([u, np.full(5, v1)])
    for name, low, high in (("u", at_u0, at_u1), ("v", at_v0, at_v1)):
        way = face.evaluate(low).point - face.evaluate(high).point
        apart = np.linalg.norm(way, axis=1)
        if (apart <= _MEET * face.diagonal).all():
            raise UnsupportedGeometry(f"face {face.label} is closed in {name}: passes in a field need a face that is "
                                      f"open both ways; use iso-parametric passes, or {DIVIDE}")


def even_places(face: Face, count: int) -> Array:
    """Even places over the parameter range, its borders among them, (count^2, 2), u slowest.

    Parameters
    ----------
    face : Face
    count : int
        Each way.
    """
    u0, u1, v0, v1 = face.bounds
    u = np.linspace(u0, u1, count)
    v = np.linspace(v0, v1, count)
    grid = np.meshgrid(u, v, indexing="ij")
    return np.stack(grid, axis=-1).reshape(-1, 2)


def feed_frame(face: Face, uv: Array) -> tuple[Array, Array, Array]:
    """Unit vectors along Su and across it towards growing v, (n, 3) each, and the metric in them, (n, 3).

    Parameters
    ----------
    face : Face
    uv : (n, 2) array

    Raises
    ------
    UnsupportedGeometry
        Where a place has no two directions, as a pole.
    """
    d = face.evaluate(uv)
    normal = face.normal(uv)
    size = np.linalg.norm(d.su, axis=1)
    first = d.su / np.maximum(size, np.finfo(float).tiny)[:, None]
    second = np.cross(normal, first)
    sense = np.where(dot(second, d.sv) < 0, -1.0, 1.0)
    second *= sense[:, None]
    along = dot(first, d.sv)
    across = dot(second, d.sv)
    u0, u1, v0, v1 = face.bounds
    slower = np.minimum(size, across)
    poor = np.flatnonzero(slower * max(u1 - u0, v1 - v0) <= _POLE * face.diagonal)
    if len(poor):
        u, v = uv[poor[0]]
        raise UnsupportedGeometry(f"face {face.label} has no two directions at u {u:.4g}, v {v:.4g}, as in a pole: "
                                  "passes in a field do not go there; use iso-parametric passes")
    return first, second, np.column_stack([size, along, across])


def feeds_in(frame: tuple[Array, Array, Array], angles: Array) -> Array:
    """Feeds of passes that lie one after the other in the directions, (n k, 3), a place's one after the other.

    Parameters
    ----------
    frame
        As `feed_frame` returns it.
    angles : (k,) array
        From the first direction of the frame towards the second.
    """
    first, second, _ = frame
    cosine = np.cos(angles)[:, None]
    sine = np.sin(angles)[:, None]
    feed = cosine * second[:, None] - sine * first[:, None]
    return np.asarray(feed.reshape(-1, 3))


def _tip_ways(face: Face, cut: Cut, uv: Array, angles: Array) -> Array:
    """Way of the tip per way of the contact along passes, (n, k)."""
    _, _, metric = feed_frame(face, uv)
    u0, u1, v0, v1 = face.bounds
    rates = []
    for shift in np.diag([_STEP * (u1 - u0), _STEP * (v1 - v0)]):
        ahead = place(face, cut.tool, uv + shift, cut.axis, cut.allowance)
        behind = place(face, cut.tool, uv - shift, cut.axis, cut.allowance)
        rates.append((ahead - behind) / (2 * shift.sum()))
    by_u, by_v = rates
    along = by_u / metric[:, :1]
    across = (by_v - metric[:, 1:2] * along) / metric[:, 2:]
    cosine = np.cos(angles)[:, None]
    sine = np.sin(angles)[:, None]
    way = cosine * across[:, None] - sine * along[:, None]
    long = np.linalg.norm(way, axis=2)
    # On a ripple much smaller than the cutter its tip goes a thousand times as far in one direction as in another.
    longest = np.maximum(long.max(axis=1, keepdims=True), 1.0)
    return np.asarray(np.maximum(long, _NARROWEST * longest))


def _degree_two(angles: Array) -> Array:
    """What a form of second degree is made of in directions, (3, k)."""
    return np.stack([np.ones(len(angles)), np.cos(2 * angles), np.sin(2 * angles)])


def _fit(values: Array, angles: Array, harmonics: int) -> DirectionFunction:
    """Positive values (n, k) at even directions over half a turn, as a function of the direction."""
    square = values**2
    terms = _degree_two(angles)
    weight = 1 / square**2  # errors count by their share of the value
    normal = np.einsum("ak,bk,nk->nab", terms, terms, weight)
    right = np.einsum("ak,nk->na", terms, 1 / square)
    form = np.linalg.solve(normal, right[..., None])[..., 0]
    swing = np.hypot(form[:, 1], form[:, 2])
    least = _POSITIVE * square.min(axis=1)
    form[:, 0] = np.maximum(form[:, 0], 2 * least)
    # Where the form would fall below the least value, its swing is made smaller.
    room = form[:, 0] - least
    share = room / np.maximum(swing, np.finfo(float).tiny)
    form[:, 1:] *= np.minimum(1.0, share)[:, None]
    left = np.log(values) - 0.5 * np.log(form @ terms)
    turns = np.fft.rfft(left, axis=1)[:, :harmonics + 1] / values.shape[1]
    turns[:, 1:] *= 2
    return DirectionFunction(form, np.ascontiguousarray(turns.real), np.ascontiguousarray(-turns.imag))
