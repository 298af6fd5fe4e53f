"""Strip width of the standing cutter in the plane across the feed, by distances along the surface's normals.

This is the strip width of a cutter in one position.  What passes leave is that of the swept cutter, in
`toolaxis.contact.strip.width`; the two agree to the second order where the axis leans along the feed.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.frame import Feed, contact_frame
from toolaxis.contact.placement import tips
from toolaxis.contact.strip.cutter_parameters import cutter_parameters
from toolaxis.contact.strip.scallop import effective_radius
from toolaxis.contact.strip.swept_volume_moving_axis import cutter_distances
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import axis_rows, dot
from toolaxis.shape.face import Face
from toolaxis.strategies.roughness.feasible_area import check_bull_nose
from toolaxis.tools.tool import Tool
from toolaxis.work import spend

Array = NDArray[np.float64]

#: Places on each side of a contact, how far they reach in radii of the tool, and how much closer they lie near it.
_PLACES, _REACH, _CLOSER, _FEWEST = 56, 2.0, 1.3, 16
#: Newton steps to a place in the section, and to the end of a strip.
_SECTION_STEPS, _END_STEPS = 8, 6
#: By how much a place may still miss the section before the last step, mm: steps converge like squares.
_CLOSE = 1e-5
#: As many bounds of distances as take as long as no widths; each place takes as long as one.
_QUESTION = 4000


@dataclass(frozen=True, eq=False)
class Sections:
    """Lifted points of a surface in the planes across the feed at contacts; the same for all axes.

    Attributes
    ----------
    point, normal : (n, 3) array
        Of the contacts.
    places : (k,) array
        Distances from the contact in the tangent plane, growing, the contact left out, mm.
    lifted : (n, 2, k, 3) array
        Points as high above the surface as the scallop and the allowance, left and right of the contact, mm.
    tool : Tool
    scallop, allowance : float
        mm
    """

    point: Array
    normal: Array
    places: Array
    lifted: Array
    tool: Tool
    scallop: float
    allowance: float

    def widths(self, axis: Array) -> Array:
        """Widths left and right, (n, 2) mm, of the cutter with unit axes (n, 3); see `section_width`."""
        cutter = cutter_parameters(self.tool, self.scallop, self.allowance)
        tip = tips(self.point, self.normal, axis, self.tool, self.allowance)
        spend(_QUESTION + self.lifted[..., 0].size)
        from_tip = self.lifted - tip[:, None, None]
        away = cutter_distances(cutter, from_tip, axis[:, None, None])
        depth = min(self.scallop, self.tool.radius)
        at_contact = np.full((*away.shape[:2], 1), -depth)
        distance = np.concatenate([at_contact, away], axis=2)
        places = np.concatenate([[0.0], self.places])
        outside = away > 0
        ends = outside.any(axis=2)
        first_outside = np.argmax(outside, axis=2) + 1
        k = np.where(ends, first_outside, len(places) - 1)
        crossing = _crossing(places, distance, k)
        return np.where(ends, crossing, places[-1])


def _crossing(places: Array, values: Array, k: NDArray[np.intp]) -> Array:
    """Where the cubic through four values around the gap before each k vanishes."""
    first = np.clip(k - 2, 1, len(places) - 4)
    begin = first[..., None] + np.arange(4)
    at = places[begin]
    some = np.take_along_axis(values, begin, axis=2)
    low = places[k - 1]
    high = places[k]
    before = np.take_along_axis(values, (k - 1)[..., None], axis=2)[..., 0]
    after = np.take_along_axis(values, k[..., None], axis=2)[..., 0]
    rises = after > before
    slope = np.where(rises, after - before, 1.0)
    x = low - before * (high - low) / slope
    for _ in range(_END_STEPS):
        f, df = _cubic_through(at, some, x)
        step = f / np.where(df > 0, df, np.inf)
        x = np.clip(x - step, low, high)
    return np.asarray(x)


def _cubic_through(at: Array, values: Array, x: Array) -> tuple[Array, Array]:
    """The cubic through four values (..., 4) at places, and its slope, at x (...): Lagrange's form."""
    f = np.zeros_like(x)
    df = np.zeros_like(x)
    for i in range(4):
        others = [j for j in range(4) if j != i]
        a, b, c = (x - at[..., j] for j in others)
        apart = np.prod([at[..., i] - at[..., j] for j in others], axis=0)
        scale = values[..., i] / apart
        f += scale * a * b * c
        df += scale * (a * b + a * c + b * c)
    return f, df


def sections(face: Face, tool: Tool, uv: ArrayLike, scallop: float, feed: Feed = "u", allowance: float = 0.0,
             reach: float | None = None) -> Sections:
    """Lifted points in the planes across the feed at contacts.

    Parameters
    ----------
    face, tool, uv, scallop, feed, allowance
        As for `section_width`.
    reach : float, optional
        How far to look on each side, mm; 2 R unless given, and no farther than that.
    """
    check_bull_nose(tool)
    cutter_parameters(tool, scallop, allowance)
    rows = np.atleast_2d(np.asarray(uv, dtype=float))
    far = _REACH * tool.radius
    near = far if reach is None else min(reach, far)
    wanted = np.ceil(_PLACES * (near / far) ** (1 / _CLOSER))
    number = max(int(wanted), _FEWEST)
    share = np.arange(1, number + 1) / number
    places = near * share ** _CLOSER
    to_both_sides = np.concatenate([places, -places])
    parameters = section_parameters(face, rows, to_both_sides, feed)
    at, up = section_points(face, parameters)
    lifted = at + (scallop + allowance) * up
    lifted = lifted.reshape(len(rows), 2, number, 3)
    point = face.evaluate(rows).point
    normal = contact_frame(face, rows, feed).normal
    return Sections(point, normal, places, lifted, tool, scallop, allowance)


def section_parameters(face: Face, uv: ArrayLike, offsets: ArrayLike, feed: Feed = "u") -> Array:
    """Parameters of the points of a surface in the planes across the feed at contacts, (n, k, 2).

    Parameters
    ----------
    face : Face
    uv : (n, 2) array_like
    offsets : (k,) array_like
        Distances from the contact to the left in the tangent plane, mm.
    feed : "u", "v" or (3,) or (n, 3) array_like
    """
    frame = contact_frame(face, uv, feed)
    rows = np.atleast_2d(np.asarray(uv, dtype=float))
    away = np.asarray(offsets, dtype=float)
    number = len(away)
    feeds = np.repeat(frame.feed, number, axis=0)
    lefts = np.repeat(frame.left, number, axis=0)
    origin = np.repeat(face.evaluate(rows).point, number, axis=0)
    at = np.repeat(rows, number, axis=0)
    across = np.tile(away, len(rows))
    for _ in range(_SECTION_STEPS):
        d = face.evaluate(at)
        way = d.point - origin
        miss_f = dot(way, feeds)
        miss_k = dot(way, lefts) - across
        uf = dot(d.su, feeds)
        vf = dot(d.sv, feeds)
        uk = dot(d.su, lefts)
        vk = dot(d.sv, lefts)
        det = uf * vk - vf * uk
        det = np.where(np.abs(det) > 1e-12, det, 1e-12)
        step_u = vk * miss_f - vf * miss_k
        step_v = uf * miss_k - uk * miss_f
        at = at - np.stack([step_u, step_v], axis=1) / det[:, None]
        worst_f = np.abs(miss_f).max(initial=0.0)
        worst_k = np.abs(miss_k).max(initial=0.0)
        if max(worst_f, worst_k) < _CLOSE:
            break
    return np.asarray(at.reshape(len(rows), number, 2))


def section_points(face: Face, parameters: Array) -> tuple[Array, Array]:
    """Points and normals at (n, k, 2) parameters, (n, k, 3) each; beyond its domain the surface goes straight ahead.

    Parameters
    ----------
    face : Face
    parameters : (n, k, 2) array
        As `section_parameters` gives.
    """
    at = parameters.reshape(-1, 2)
    d = face.evaluate(at)
    normal = face.normal(at, d)
    shape = (*parameters.shape[:2], 3)
    return d.point.reshape(shape), normal.reshape(shape)


def section_width(face: Face, tool: Tool, uv: ArrayLike, axis: ArrayLike, scallop: float, feed: Feed = "u",
                  allowance: float = 0.0) -> Array:
    """Widths left and right of the feed in which the standing cutter leaves less than the scallop height.

    Parameters
    ----------
    face : Face
    tool : Tool
        A torus or a flat end.
    uv : (n, 2) array_like
        Parameters of the contacts.
    axis : (3,) or (n, 3) array_like
        Tool axis, tip to spindle.
    scallop : float
        Scallop height h, mm.
    feed : "u", "v" or (3,) or (n, 3) array_like
    allowance : float
        Stock left on the surface, mm.

    Returns
    -------
    (n, 2) array
        W_L and W_R, mm: distances along the tangent across the feed from the contact to the first point of the surface,
        in the plane across the feed, at which the distance to the cutter along the normal is h; 2 R at most.

    Raises
    ------
    InvalidInput
        When the corner radius is the cutter's radius, or a number is out of range.

    Notes
    -----
    **Source**: [dong2023] Sec. 3.1, Eqs. (12) and (13).

    **Properties**: 1. never above the swept width by more than the surface's own bend; 2. the sum is least across
    changes of the direction where the axis leans along the feed on a plane.
    """
    bench = sections(face, tool, uv, scallop, feed, allowance)
    return bench.widths(axis_rows(axis, len(bench.point)))


def expect_widths(tool: Tool, lean: float, scallop: float) -> tuple[float, float]:
    """Range of the expected strip width, mm: that of a lean on a plane, more or less a tenth of the radius.

    Parameters
    ----------
    tool : Tool
    lean : float
        rad, along the feed.
    scallop : float
        mm

    Raises
    ------
    InvalidInput
        When the corner radius is the cutter's radius, or the lean or the height is out of range.

    Notes
    -----
    **Source**: [dong2023] Eq. (14).

    Examples
    --------
    >>> [round(x, 4) for x in expect_widths(Tool.torus(10, 3), np.radians(20.0), 0.1)]
    [2.1529, 3.1529]
    """
    check_bull_nose(tool)
    if not (0 < lean < np.pi / 2):
        raise InvalidInput(f"lean is {np.degrees(lean)} deg: it must lie between 0 and 90")
    radius = float(effective_radius(tool, lean))
    if not 0 < scallop < radius:
        raise InvalidInput(f"scallop height is {scallop} mm: it must lie above zero and below {radius:.4g} mm")
    middle = 2 * float(np.sqrt(radius**2 - (radius - scallop) ** 2))
    return middle - tool.radius / 10, middle + tool.radius / 10
