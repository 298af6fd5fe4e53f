"""The oracle of the strip width kernels: Newton's method on whole arrays of contacts, in plain numpy.

It shares no formula with the kernels but the second-order start; contacts on which Newton fails, or whose exit is not
confirmed, come back as not found.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.curves import OrientedSurface
from toolaxis.contact.strip.cutter_parameters import CutterParameters
from toolaxis.contact.strip.half_widths import StripContacts, StripOptions
from toolaxis.contact.strip.second_order import SHARPEST
from toolaxis.numeric.bspline import SurfaceData, surface_derivatives_many_numpy
from toolaxis.numeric.vectors import dot
from toolaxis.shape.differential import curvature_form, normals
from toolaxis.shape.surface import Derivatives

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

WINDOW, NODES = 2.5, 20


class StripScene(NamedTuple):
    """Surface, whether it is flipped, and the cutter."""

    surface: SurfaceData
    flip: bool
    cutter: CutterParameters

    def derivatives(self, uv: Array) -> Derivatives:
        """Position and derivatives at (n, 2) parameters."""
        table = surface_derivatives_many_numpy(self.surface, uv)
        return Derivatives(*(table[:, k] for k in range(6)))


class CurveFamily(NamedTuple):
    """n curves through n contacts: iso-curves (code 0 or 1) or plane sections (code 2), x = 0 at the contact."""

    code: int
    start: Array
    tangent: Array
    plane: Array


class Moving(NamedTuple):
    """n points with their rates, (n, 3) each."""

    point: Array
    rate: Array


class Sweep(NamedTuple):
    """Passes and cross curves of n contacts, and axes (n, 3)."""

    passes: CurveFamily
    cross: CurveFamily
    axis: Array


def along(scene: StripScene, line: CurveFamily, x: Array) -> tuple[Moving, Moving]:
    """Points and normals, with their rates, at x of each curve."""
    rate = np.zeros_like(line.start)
    if line.code < 2:
        rate[:, line.code] = 1.0
        uv = line.start + x[:, None] * rate
    else:
        uv, rate = _on_section(scene, line, x)
    d = scene.derivatives(uv)
    n = normals(d, scene.flip)
    move = rate[:, :1] * d.su + rate[:, 1:] * d.sv
    raw = np.cross(d.su, d.sv)
    turn = (np.cross(rate[:, :1] * d.suu + rate[:, 1:] * d.suv, d.sv)
            + np.cross(d.su, rate[:, :1] * d.suv + rate[:, 1:] * d.svv))
    turn = (-1.0 if scene.flip else 1.0) * turn / np.linalg.norm(raw, axis=1, keepdims=True)
    return Moving(d.point, move), Moving(n, turn - dot(turn, n)[:, None] * n)


def _on_section(scene: StripScene, line: CurveFamily, x: Array) -> tuple[Array, Array]:
    """Parameters and their rates where a section has made progress x along its tangent, by Newton's method."""
    uv, origin = line.start, scene.derivatives(line.start).point
    rest = np.stack([-x, np.zeros_like(x)], -1)
    rate = np.zeros_like(uv)
    for _ in range(30):
        d = scene.derivatives(uv)
        off = d.point - origin
        rest = np.stack([dot(off, line.tangent) - x, dot(off, line.plane)], -1)
        a, b = dot(d.su, line.tangent), dot(d.sv, line.tangent)
        p, q = dot(d.su, line.plane), dot(d.sv, line.plane)
        det = a * q - b * p
        rate = np.stack([q / det, -p / det], -1)
        if np.abs(rest).max(initial=0.0) < 1e-12:
            break
        uv = uv - np.stack([q * rest[:, 0] - b * rest[:, 1], a * rest[:, 1] - p * rest[:, 0]], -1) / det[:, None]
        uv = np.clip(np.nan_to_num(uv), -1e6, 1e6)
    lost = np.abs(rest).max(axis=1, initial=0.0) > 1e-9
    return uv, np.where(lost[:, None], np.nan, rate)


def place_tips(scene: StripScene, line: CurveFamily, x: Array, axis: Array) -> Moving:
    """Tips and their rates for contacts at x of each curve."""
    a, r, offset = scene.cutter[0], scene.cutter[1], scene.cutter[5]
    point, normal = along(scene, line, x)
    across = normal.point - dot(normal.point, axis)[:, None] * axis
    change = normal.rate - dot(normal.rate, axis)[:, None] * axis
    size = np.linalg.norm(across, axis=1, keepdims=True)
    e = np.where(size > 1e-12, across / np.where(size > 0, size, 1.0), 0.0)
    turn = np.where(size > 1e-12, (change - dot(change, e)[:, None] * e) / np.where(size > 0, size, 1.0), 0.0)
    return Moving(point.point + offset * normal.point + a * e - r * axis, point.rate + offset * normal.rate + a * turn)


def distance_numpy(cutter: Array, axis: Array, apart: Array) -> Array:
    """Signed distance of points, relative to the tip, to the cutter: the greatest over its supporting planes."""
    a, r, cos_side, sin_side, top = cutter[:5]
    z = dot(apart, axis)
    rho = np.linalg.norm(apart - z[..., None] * axis, axis=-1)
    x, y = rho - a, z - r
    planes = np.maximum(-z, x * cos_side - y * sin_side - r)
    arc = (x >= 0) & (y * cos_side + x * sin_side <= 0)
    return np.asarray(np.maximum(np.where(arc, np.hypot(x, y) - r, planes), z - top))


def _residual(scene: StripScene, sweep: Sweep, place: Array, lift: float) -> Array:
    """What vanishes at an exit, (n, 2) mm: the point's two coordinates relative to the arc's touching point.

    On a ball: distance from its surface, and progress of the centre past the point.
    """
    a, r = scene.cutter[0], scene.cutter[1]
    point, normal = along(scene, sweep.cross, place[:, 0])
    tip = place_tips(scene, sweep.passes, place[:, 1], sweep.axis)
    apart = point.point + lift * normal.point - tip.point
    if a == 0:
        out = apart - r * sweep.axis
        pace = np.linalg.norm(tip.rate, axis=1)
        return np.stack([np.linalg.norm(out, axis=1) - r, dot(out, tip.rate) / pace], -1)
    z = dot(apart, sweep.axis)
    flat = apart - z[:, None] * sweep.axis
    rho = np.linalg.norm(flat, axis=1)
    theta = np.arctan2(dot(sweep.axis, tip.rate), dot(flat, tip.rate) / rho)
    theta = np.where(np.cos(theta) < 0, theta + np.pi, theta)
    return np.stack([rho - a - r * np.sin(theta), z - r + r * np.cos(theta)], -1)


def _solve(scene: StripScene, sweep: Sweep, place: Array, heights: tuple[float, float]) -> tuple[Array, Flags]:
    """Newton's method with differences for the matrix; places (n, 2) of (s, w), and whether it converged."""
    lift, radius = heights
    pace = np.stack([np.linalg.norm(along(scene, line, np.zeros(len(place)))[0].rate, axis=1)
                     for line in (sweep.cross, sweep.passes)], -1)
    limit = 0.6 * np.abs(place[:, :1]) * pace[:, :1]
    small = np.full(len(place), np.inf)
    for _ in range(40):
        rest = _residual(scene, sweep, place, lift)
        columns = []
        for k in range(2):
            step = 1e-6 * radius / pace[:, k]
            shift = np.zeros_like(place)
            shift[:, k] = step
            change = _residual(scene, sweep, place + shift, lift) - _residual(scene, sweep, place - shift, lift)
            columns.append(change / (2 * step)[:, None])
        matrix = np.nan_to_num(np.stack(columns, -1), posinf=0.0, neginf=0.0)
        move = np.einsum("nij,nj->ni", np.linalg.pinv(matrix), np.nan_to_num(rest))
        size = np.abs(move * pace).max(axis=1)
        share = np.minimum(1.0, np.maximum(limit[:, 0], 1e-3 * radius) / np.maximum(size, 1e-300))
        place = place - share[:, None] * move
        small = size
        if (size <= 1e-10 * radius).all():
            break
    return place, small <= 1e-9 * radius


def _first(scene: StripScene, sweep: Sweep, place: Array, heights: tuple[float, float]) -> Flags:
    """Whether exits are the first ones: the way there covered, and the point free of all other contacts."""
    lift, radius = heights
    good = np.ones(len(place), dtype=bool)

    def gaps(x: Array, w: Array) -> Array:
        """Distances (n, m) of points at x (n,) to cutters at w (n, m)."""
        count, n = w.shape[1], len(x)
        point, normal = along(scene, sweep.cross, x)
        line = CurveFamily(sweep.passes.code, *(np.repeat(rows, count, axis=0) for rows in sweep.passes[1:]))
        axis = np.repeat(sweep.axis, count, axis=0)
        tip = place_tips(scene, line, w.ravel(), axis).point
        lifted = np.repeat(point.point + lift * normal.point, count, axis=0)
        return distance_numpy(scene.cutter, axis, lifted - tip).reshape(n, count)

    for share in (0.25, 0.5, 0.75):
        good &= gaps(share * place[:, 0], share * place[:, 1:])[:, 0] < 0
    pace = np.linalg.norm(along(scene, sweep.passes, np.zeros(len(place)))[0].rate, axis=1)
    far = np.linspace(-WINDOW, WINDOW, 2 * NODES + 1) * radius
    gap = gaps(place[:, 0], place[:, 1:] + far / pace[:, None])
    good &= np.abs(gap[:, NODES]) < 1e-6 * radius
    gap[:, NODES] = 0.0
    for side in (gap[:, NODES:], gap[:, NODES::-1]):
        good &= ((np.diff(side, axis=1) >= 0) | (side[:, 1:] > 0.5 * radius)).all(axis=1)
    return good


def _starts(scene: StripScene, sweep: Sweep, frame: Array, height: float) -> tuple[Array, Flags]:
    """Second-order exits (n, 2) on the upper side, and whether the cutter is free there."""
    a, r = scene.cutter[0], max(scene.cutter[1], SHARPEST * (scene.cutter[0] + scene.cutter[1]))
    t = np.einsum("nij,nj->ni", frame, sweep.axis)
    lean = np.hypot(t[:, 0], t[:, 1])
    size = np.where(lean > 0, lean, 1.0)
    direction = np.stack([np.where(lean > 0, t[:, 0] / size, 1.0), t[:, 1] / size], -1)
    side = np.stack([-direction[:, 1], direction[:, 0]], -1)
    bend = np.where((lean <= 1e-12) & (a > 0), 0.0, 1 / r)
    ring = lean / (a + r * lean) if a > 0 else np.full(len(lean), 1 / r)
    form = (bend[:, None, None] * direction[:, :, None] * direction[:, None]
            + ring[:, None, None] * side[:, :, None] * side[:, None])
    d = scene.derivatives(sweep.passes.start)
    form = form - curvature_form(d, frame[:, 2], frame[:, 0])
    free = (form[:, 0, 0] > 0) & (np.linalg.det(form) > 0)
    rates = [along(scene, line, np.zeros(len(lean)))[0].rate for line in (sweep.cross, sweep.passes)]
    c_f, c_k = dot(rates[0], frame[:, 0]), dot(rates[0], frame[:, 1])
    free &= c_k != 0
    safe = np.where(free[:, None, None], form, np.eye(2))
    width = np.sqrt(2 * height * np.linalg.inv(safe)[:, 1, 1])
    width = width / np.sqrt(1 + (0.5 * width / (scene.cutter[0] + scene.cutter[1])) ** 2)
    s = width / np.abs(np.where(free, c_k, 1.0))
    w = s * (c_f + safe[:, 0, 1] / safe[:, 0, 0] * c_k) / dot(rates[1], frame[:, 0])
    return np.stack([s, w], -1), free


def _arc(scene: StripScene, line: CurveFamily, x: Array) -> Array:
    """Arc length of sections from the contact to x, by Gauss quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    total = np.zeros(len(x))
    for node, weight in zip(nodes, weights, strict=True):
        total += 0.5 * weight * np.linalg.norm(along(scene, line, 0.5 * (node + 1) * x)[0].rate, axis=1)
    return total * np.abs(x)


def _sweep(scene: StripScene, contacts: StripContacts, axes: Array,
           options: StripOptions) -> tuple[Sweep, Array, Flags]:
    """Passes and cross curves of contacts, frames (n, 3, 3), and whether there is a feed."""
    d = scene.derivatives(contacts.uv)
    n = normals(d, scene.flip)
    code = options.feed
    feed = contacts.direction if code == 2 else (d.su, d.sv)[code]
    x = feed - dot(feed, n)[:, None] * n
    size = np.linalg.norm(x, axis=1, keepdims=True)
    sound = size[:, 0] > 1e-9 * np.linalg.norm(feed, axis=1)
    x = x / np.where(size > 0, size, 1.0)
    left = np.cross(n, x)
    passes = CurveFamily(code, contacts.uv, x, left)
    cross = CurveFamily(2 if options.normal_section else 1 - code, contacts.uv, left, x)
    return Sweep(passes, cross, axes), np.stack([x, left, n], 1), sound


def half_widths_numpy(surface: OrientedSurface, cutter: CutterParameters, contacts: StripContacts, axes: Array,
                      options: StripOptions) -> tuple[Array, Flags]:
    """Half widths towards lower and upper parameter of the cross curves; arc length on sections.

    Parameters
    ----------
    surface, cutter, contacts, options
        As kernels take them, with one scallop height for all contacts.
    axes : (n, 3) array

    Returns
    -------
    widths : (n, 2) array
    found : (n,) array of bool
        False where the answer must be looked for with more care.
    """
    h, radius = contacts.scallop[0], cutter.flat + cutter.corner
    lift = h + cutter.offset - cutter.corner
    scene = StripScene(surface.data, surface.sign < 0, cutter)
    widths = np.zeros((len(contacts.uv), 2))
    with np.errstate(all="ignore"):
        sweep, frame, found = _sweep(scene, contacts, axes, options)
        start, free = _starts(scene, sweep, frame, h)
        found &= free & (dot(frame[:, 2], axes) >= scene.cutter[3] - 1e-9)
        for side, turn in enumerate((-1.0, 1.0)):
            place, solved = _solve(scene, sweep, turn * start, (lift, radius))
            solved &= turn * place[:, 0] > 0
            place = np.where(solved[:, None], place, turn * start)
            found &= solved & _first(scene, sweep, place, (lift, radius))
            widths[:, side] = np.abs(place[:, 0]) if sweep.cross.code < 2 else _arc(scene, sweep.cross, place[:, 0])
    return widths, found
