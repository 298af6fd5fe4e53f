"""Kernel surfaces as exact rational B-splines over the range that a face uses."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.cad.curves import Spline, arc, extrude_profile, line, revolve_profile
from toolaxis.cad.kernel_protocol import (
    Box,
    ExtrusionForm,
    KernelSurface,
    MeridianForm,
    PlaneForm,
    RevolutionForm,
    SplineForm,
)
from toolaxis.cad.rational_arcs import ParameterMap, angle_breaks, arc_knots
from toolaxis.errors import UnsupportedGeometry
from toolaxis.numeric.bspline import surface_derivatives_many_numpy
from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.knots import restrict_spline, unroll_periodic

Array = NDArray[np.float64]

APPROXIMATION, FLAT = 1e-6, 1e-9


@dataclass(frozen=True, eq=False)
class PlainSurface:
    """A converted surface as plain arrays.

    Attributes
    ----------
    knots_u, knots_v : (m,) array
    control : (nu, nv, 4) array
        Homogeneous control points, mm.
    degree : (int, int)
    kind : str
        The kernel's kind of surface.
    map : ParameterMap
        From the kernel's parameters to ours.
    tolerance : float
        Bound of the distance to the kernel's surface at the same parameters, mm; 0 where it is exact.
    """

    knots_u: Array
    knots_v: Array
    control: Array
    degree: tuple[int, int]
    kind: str
    map: ParameterMap = field(default_factory=ParameterMap)
    tolerance: float = 0.0


def convert(surface: KernelSurface, box: Box) -> PlainSurface:
    """A kernel surface as a rational B-spline that covers a parameter box; a flat one of whatever kind is a plane.

    Parameters
    ----------
    surface : KernelSurface
    box : (u0, u1, v0, v1)
        In the kernel's parameters.  Elementary and swept surfaces come cut to it, B-splines whole; periodic
        B-splines are unrolled over it.

    Raises
    ------
    UnsupportedGeometry
        When the kernel cannot approximate a surface that has no exact form here.
    """
    found = _convert_surface(surface, box)
    return replace(found, kind="plane") if found.kind != "plane" and _is_flat(found.control) else found


def _is_flat(control: Array) -> bool:
    """Whether all control points lie in one plane, to 1e-9 of their size."""
    points = (control[..., :3] / control[..., 3:]).reshape(-1, 3)
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return bool(spread[-1] <= FLAT * spread[0])


def _convert_surface(surface: KernelSurface, box: Box) -> PlainSurface:
    form = surface.form
    if isinstance(form, PlaneForm):
        return _plane(form, box)
    if isinstance(form, MeridianForm):
        return _elementary(form, box, surface.kind)
    if isinstance(form, RevolutionForm):
        return _revolution(form, box)
    if isinstance(form, ExtrusionForm):
        return _extrusion(form, box)
    if isinstance(form, SplineForm):
        return _bspline(form, box, surface.kind)
    return _approximation(surface, box)


def map_of(surface: KernelSurface, box: Box) -> ParameterMap:
    """The parameter map that `convert` will find, without converting.

    Parameters
    ----------
    surface : KernelSurface
    box : (u0, u1, v0, v1)
        In the kernel's parameters.
    """
    form = surface.form
    turned = isinstance(form, MeridianForm | RevolutionForm)
    swept = isinstance(form, RevolutionForm | ExtrusionForm) and form.curve.round
    round_u = turned or swept
    round_v = (isinstance(form, MeridianForm) and isinstance(form.course, float)) or (turned and swept)
    return ParameterMap(angle_breaks(box[0], box[1]) if round_u else None,
                        angle_breaks(box[2], box[3]) if round_v else None)


def _plane(form: PlaneForm, box: Box) -> PlainSurface:
    u0, u1, v0, v1 = box
    corners = np.array([[[u, v, 0.0, 1.0] for v in (v0, v1)] for u in (u0, u1)])
    net = corners @ form.placed.T
    return PlainSurface(np.array([u0, u0, u1, u1]), np.array([v0, v0, v1, v1]), net, (1, 1), "plane")


def _elementary(form: MeridianForm, box: Box, kind: str) -> PlainSurface:
    if not isinstance(form.course, float):
        profile = line(form.start, form.course, box[2], box[3])
    else:
        upright = np.eye(4)[:, [0, 2, 1, 3]]
        upright[:3, 3] = form.start
        profile = arc(upright, (form.course, form.course), box[2], box[3])
    return _revolve_profile(profile, form.placed, box, kind)


def _revolve_profile(profile: Spline, placed: Array, box: Box, kind: str) -> PlainSurface:
    breaks = angle_breaks(box[0], box[1])
    net = revolve_profile(profile.control, breaks) @ placed.T
    return PlainSurface(arc_knots(breaks), profile.knots, net, (2, profile.degree), kind,
                        ParameterMap(breaks, profile.breaks))


def _revolution(form: RevolutionForm, box: Box) -> PlainSurface:
    profile = form.curve.spline(box[2], box[3])
    z = form.direction
    x = np.zeros(3)
    x[int(np.argmin(np.abs(z)))] = 1.0
    x -= (x @ z) * z
    x /= np.linalg.norm(x)
    placed = np.eye(4)
    placed[:3] = np.column_stack([x, np.cross(z, x), z, form.origin])
    local = profile.control @ np.linalg.inv(placed).T
    return _revolve_profile(profile._replace(control=local), placed, box, "revolution")


def _extrusion(form: ExtrusionForm, box: Box) -> PlainSurface:
    profile = form.curve.spline(box[0], box[1])
    net = extrude_profile(profile.control, form.direction, box[2], box[3])
    knots_v = np.array([box[2], box[2], box[3], box[3]])
    return PlainSurface(profile.knots, knots_v, net, (profile.degree, 1), "extrusion",
                        ParameterMap(profile.breaks, None))


def _bspline(form: SplineForm, box: Box, kind: str) -> PlainSurface:
    knots_u, net = _clamp_direction(form.knots_u, form.net, form.degree[0], form.periodic[0], box[:2])
    knots_v, turned = _clamp_direction(form.knots_v, net.swapaxes(0, 1), form.degree[1], form.periodic[1], box[2:])
    return PlainSurface(knots_u, knots_v, np.ascontiguousarray(turned.swapaxes(0, 1)), form.degree, kind)


def _clamp_direction(knots: Array, net: Array, degree: int, periodic: bool, need: tuple[float, ...]) -> tuple[Array,
                                                                                                              Array]:
    """One direction of a net with clamped ends; a periodic one over its own period or what is needed beyond."""
    low, high = float(knots[degree]), float(knots[-degree - 1])
    if not periodic:
        return restrict_spline(knots, net, degree, low, high)
    if need[0] < low or need[1] > high:
        low, high = need[0], need[1]
    return unroll_periodic(knots, net, degree, low, high)


def grid(box: Box, count: int) -> Array:
    """Evenly spread parameters of a box, borders included, (count^2, 2)."""
    u, v = np.linspace(*box[:2], count), np.linspace(*box[2:], count)
    return grid_rows(u, v)


def _approximation(surface: KernelSurface, box: Box) -> PlainSurface:
    """What has no exact form: the kernel's approximation, which keeps the parameters, and its measured error."""
    size = float(np.linalg.norm(np.ptp(surface.points(grid(box, 5)), axis=0)))
    fit = surface.approximation(box, max(APPROXIMATION * size, 1e-7))
    if fit is None:
        raise UnsupportedGeometry(f"a surface of kind {surface.kind} could not be approximated by a B-spline: "
                                  "convert it to B-splines in the CAD system")
    plain = _bspline(fit[0], box, surface.kind)
    return PlainSurface(plain.knots_u, plain.knots_v, plain.control, plain.degree, surface.kind, ParameterMap(),
                        _error_bound(surface, plain, box, fit[1]))


def _error_bound(surface: KernelSurface, plain: PlainSurface, box: Box, claimed: float) -> float:
    """A bound of the approximation's error: twice the largest of what the kernel claims and 41 x 41 checks show."""
    uv = grid(box, 41)
    data = plain.knots_u, plain.knots_v, plain.control, plain.degree[0], plain.degree[1], True
    ours = surface_derivatives_many_numpy(data, uv)[:, 0]
    return 2 * max(claimed, float(np.linalg.norm(ours - surface.points(uv), axis=1).max()))
