"""Surfaces in closed form, each with the rational B-spline that is exactly the same surface.

They stand at the origin with their axis along z, and Su x Sv points away from the axis (up for the graphs).  Principal
curvatures are positive where the surface bends towards that normal.
"""

from dataclasses import dataclass
from math import ceil, cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.grids import grid_nodes
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.shape.surface import Derivatives, Domain

Array = NDArray[np.float64]
Range = tuple[float, float]

TURN: Range = (0.0, 2 * pi)


def _check(**sizes: float) -> None:
    for name, value in sizes.items():
        if not (np.isfinite(value) and value > 0):
            raise InvalidInput(f"{name.replace('_', ' ')} is {value}: it must be a finite number above zero")


def _check_range(name: str, limits: Range, widest: float = np.inf) -> None:
    if not (np.isfinite(limits).all() and 0 < limits[1] - limits[0] <= widest * (1 + 1e-15)):
        raise InvalidInput(f"range of {name} is {limits}: it must rise, and by no more than {widest:g}")


def _spans(limits: Range) -> int:
    """Number of arcs of at most a right angle."""
    return max(1, ceil((limits[1] - limits[0]) / (pi / 2) - 1e-9))


def _arc(limits: Range) -> tuple[Array, Array]:
    """Knots at the angles, and rows (w cos, w sin, w), of the unit circle between two angles."""
    count = _spans(limits)
    knots = np.linspace(*limits, count + 1)
    angles = np.linspace(*limits, 2 * count + 1)
    weight = np.where(np.arange(2 * count + 1) % 2, cos((limits[1] - limits[0]) / (2 * count)), 1.0)
    rows = np.column_stack([np.cos(angles), np.sin(angles), weight])
    return np.concatenate([limits[:1], np.repeat(knots, 2), limits[1:]]), rows


def _line(limits: Range) -> tuple[Array, Array]:
    """Knots and rows (value, 1) of a straight parameter."""
    return np.repeat(np.array(limits), 2), np.column_stack([limits, np.ones(2)])


def arc_parameter(angle: Array, limits: Range) -> Array:
    """Parameter of the rational arc at an angle; both agree at the knots.

    Parameters
    ----------
    angle : (n,) array
        rad
    limits : (float, float)
        Ends of the arc, which is made of equal spans of at most a right angle.

    Notes
    -----
    In a span of half angle d, at phi from its start: t = tan(phi/2) / (sin d + tan(phi/2) (1 - cos d)).
    """
    width = (limits[1] - limits[0]) / _spans(limits)
    index = np.clip(np.floor((angle - limits[0]) / width), 0, _spans(limits) - 1)
    tangent = np.tan(0.5 * (angle - limits[0] - index * width))
    share = tangent / (sin(width / 2) + tangent * (1 - cos(width / 2)))
    return np.asarray(limits[0] + width * (index + share))


def _revolve_rows(turn: Range, knots: Array, degree: int, generatrix: Array) -> NurbsSurface:
    """Rows (w rho, w z, w) of a generatrix turned about z."""
    knots_u, circle = _arc(turn)
    rho, z, w = generatrix.T
    control = np.stack([np.outer(circle[:, 0], rho), np.outer(circle[:, 1], rho),
                        np.outer(circle[:, 2], z), np.outer(circle[:, 2], w)], axis=-1)
    return NurbsSurface(knots_u, knots, control, (2, degree))


def _revolve_derivatives(u: Array, rho: Array, z: Array) -> Derivatives:
    """Derivatives of a surface of revolution from rows (value, first, second derivative) of rho(v) and z(v)."""
    c = np.cos(u)
    s = np.sin(u)
    zero = np.zeros_like(u)
    radial = _rows_of(c, s, zero)
    around = _rows_of(-s, c, zero)
    up = np.array([0.0, 0.0, 1.0])
    r0, r1, r2 = rho[..., None]
    z0, z1, z2 = z[..., None]
    return Derivatives(
        point=r0 * radial + z0 * up,
        su=r0 * around,
        sv=r1 * radial + z1 * up,
        suu=-r0 * radial,
        suv=r1 * around,
        svv=r2 * radial + z2 * up)


def _rows_of(x: Array, y: Array, z: Array) -> Array:
    """Vectors, (n, 3), from their coordinates, (n,) each."""
    return np.stack([x, y, z], axis=-1)


def _quadratic_controls(limits: Range) -> tuple[Array, Array]:
    """Control values, (3,) each, of x and of x^2 over a range as polynomials of degree 2."""
    low, high = limits
    linear = np.array([low, 0.5 * (low + high), high])
    # The polar form of x^2, which is x y, at the ends: its values are the control points.
    squares = np.array([low * low, low * high, high * high])
    return linear, squares


@dataclass(frozen=True)
class PlanarSurface:
    """(u, v, 0)."""

    u_range: Range = (0.0, 100.0)
    v_range: Range = (0.0, 100.0)

    def __post_init__(self) -> None:
        _check_range("u", self.u_range)
        _check_range("v", self.v_range)

    @property
    def domain(self) -> Domain:
        """Ranges of u and v."""
        return self.u_range, self.v_range

    def evaluate(self, uv: Array) -> Derivatives:
        """Position and derivatives at (n, 2) parameters, mm."""
        u, v = np.asarray(uv, dtype=float).T
        zero, x, y = (np.tile(row, (len(u), 1)) for row in (np.zeros(3), [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]))
        return Derivatives(np.column_stack([u, v, 0 * u]), x, y, zero, zero.copy(), zero.copy())

    def principal(self, uv: Array) -> tuple[Array, Array]:
        """Principal curvatures k1 >= k2, each (n,), 1/mm."""
        return np.zeros(len(uv)), np.zeros(len(uv))

    def nurbs(self) -> NurbsSurface:
        """The same surface as a B-spline of degree (1, 1)."""
        corners = grid_nodes(self.u_range, self.v_range)
        control = np.concatenate([corners, np.zeros((2, 2, 1)), np.ones((2, 2, 1))], axis=2)
        return NurbsSurface(_line(self.u_range)[0], _line(self.v_range)[0], control, (1, 1))

    def parameters(self, uv: Array) -> Array:
        """Parameters of `nurbs` at (n, 2) parameters of this surface."""
        return np.array(uv, dtype=float)


@dataclass(frozen=True)
class CylindricalSurface:
    """(R cos u, R sin u, v), normal outwards."""

    radius: float
    u_range: Range = TURN
    v_range: Range = (0.0, 100.0)

    def __post_init__(self) -> None:
        _check(radius=self.radius)
        _check_range("u", self.u_range, 2 * pi)
        _check_range("v", self.v_range)

    @property
    def domain(self) -> Domain:
        """Ranges of the angle u and the height v."""
        return self.u_range, self.v_range

    def evaluate(self, uv: Array) -> Derivatives:
        """Position and derivatives at (n, 2) parameters, mm."""
        u, v = np.asarray(uv, dtype=float).T
        zero = np.zeros_like(v)
        return _revolve_derivatives(u, np.stack([zero + self.radius, zero, zero]), np.stack([v, zero + 1.0, zero]))

    def principal(self, uv: Array) -> tuple[Array, Array]:
        """Principal curvatures k1 >= k2, each (n,), 1/mm."""
        return np.zeros(len(uv)), np.full(len(uv), -1.0 / self.radius)

    def nurbs(self) -> NurbsSurface:
        """The same surface as a rational B-spline of degree (2, 1)."""
        knots, height = _line(self.v_range)
        return _revolve_rows(self.u_range, knots, 1, np.column_stack([np.full(2, self.radius), height]))

    def parameters(self, uv: Array) -> Array:
        """Parameters of `nurbs` at (n, 2) parameters of this surface."""
        return np.column_stack([arc_parameter(np.asarray(uv)[:, 0], self.u_range), np.asarray(uv)[:, 1]])


@dataclass(frozen=True)
class SphericalSurface:
    """R (cos v cos u, cos v sin u, sin v), normal outwards; v = -pi/2 and v = pi/2 are poles."""

    radius: float
    u_range: Range = TURN
    v_range: Range = (-pi / 2, pi / 2)

    def __post_init__(self) -> None:
        _check(radius=self.radius)
        _check_range("u", self.u_range, 2 * pi)
        _check_range("v", self.v_range, pi)
        if max(abs(v) for v in self.v_range) > pi / 2:
            raise InvalidInput(f"range of v is {self.v_range}: latitudes lie between -pi/2 and pi/2")

    @property
    def domain(self) -> Domain:
        """Ranges of longitude u and latitude v."""
        return self.u_range, self.v_range

    def evaluate(self, uv: Array) -> Derivatives:
        """Position and derivatives at (n, 2) parameters, mm."""
        u, v = np.asarray(uv, dtype=float).T
        c, s = self.radius * np.cos(v), self.radius * np.sin(v)
        return _revolve_derivatives(u, np.stack([c, -s, -c]), np.stack([s, c, -s]))

    def principal(self, uv: Array) -> tuple[Array, Array]:
        """Principal curvatures k1 >= k2, each (n,), 1/mm."""
        return np.full(len(uv), -1.0 / self.radius), np.full(len(uv), -1.0 / self.radius)

    def nurbs(self) -> NurbsSurface:
        """The same surface as a rational B-spline of degree (2, 2)."""
        knots, rows = _arc(self.v_range)
        return _revolve_rows(self.u_range, knots, 2, rows * [self.radius, self.radius, 1.0])

    def parameters(self, uv: Array) -> Array:
        """Parameters of `nurbs` at (n, 2) parameters of this surface."""
        u, v = np.asarray(uv, dtype=float).T
        return np.column_stack([arc_parameter(u, self.u_range), arc_parameter(v, self.v_range)])


@dataclass(frozen=True)
class ConicalSurface:
    """((R + v sin a) cos u, (R + v sin a) sin u, v cos a), normal outwards.

    v runs along the generator, from the apex at -R / sin a.
    """

    radius: float
    half_angle: float
    u_range: Range = TURN
    v_range: Range = (0.0, 50.0)

    def __post_init__(self) -> None:
        _check_range("u", self.u_range, 2 * pi)
        _check_range("v", self.v_range)
        if not (np.isfinite(self.half_angle) and 0 < abs(self.half_angle) < pi / 2):
            raise InvalidInput(f"half angle is {self.half_angle}: it must be less than pi/2 and not zero")
        ends = self.radius + np.array(self.v_range) * sin(self.half_angle)
        if not (np.isfinite(ends).all() and ends.min() >= -1e-12 * np.abs(ends).max()):
            raise InvalidInput(f"cone radii at the ends are {ends.tolist()} mm: the range of v must end at the apex")

    @property
    def domain(self) -> Domain:
        """Ranges of the angle u and the length v along the generator."""
        return self.u_range, self.v_range

    def evaluate(self, uv: Array) -> Derivatives:
        """Position and derivatives at (n, 2) parameters, mm."""
        u, v = np.asarray(uv, dtype=float).T
        zero, a = np.zeros_like(v), self.half_angle
        return _revolve_derivatives(u, np.stack([self.radius + v * sin(a), zero + sin(a), zero]),
                                    np.stack([v * cos(a), zero + cos(a), zero]))

    def principal(self, uv: Array) -> tuple[Array, Array]:
        """Principal curvatures k1 >= k2, each (n,), 1/mm; minus infinity at the apex."""
        rho = self.radius + np.asarray(uv, dtype=float)[:, 1] * sin(self.half_angle)
        with np.errstate(divide="ignore"):
            return np.zeros(len(rho)), -cos(self.half_angle) / rho

    def nurbs(self) -> NurbsSurface:
        """The same surface as a rational B-spline of degree (2, 1)."""
        knots, rows = _line(self.v_range)
        v = rows[:, 0]
        rho = np.maximum(self.radius + v * sin(self.half_angle), 0.0)
        return _revolve_rows(self.u_range, knots, 1, np.column_stack([rho, v * cos(self.half_angle), rows[:, 1]]))

    def parameters(self, uv: Array) -> Array:
        """Parameters of `nurbs` at (n, 2) parameters of this surface."""
        return np.column_stack([arc_parameter(np.asarray(uv)[:, 0], self.u_range), np.asarray(uv)[:, 1]])


@dataclass(frozen=True)
class ToroidalSurface:
    """((R + r cos v) cos u, (R + r cos v) sin u, r sin v), normal out of the tube."""

    major: float
    minor: float
    u_range: Range = TURN
    v_range: Range = TURN

    def __post_init__(self) -> None:
        _check(major_radius=self.major, minor_radius=self.minor)
        _check_range("u", self.u_range, 2 * pi)
        _check_range("v", self.v_range, 2 * pi)
        if self.minor >= self.major:
            raise InvalidInput(f"minor radius is {self.minor} mm, not below the major radius {self.major} mm: "
                               "the tube would meet itself")

    @property
    def domain(self) -> Domain:
        """Ranges of the angle u about the axis and v about the tube."""
        return self.u_range, self.v_range

    def evaluate(self, uv: Array) -> Derivatives:
        """Position and derivatives at (n, 2) parameters, mm."""
        u, v = np.asarray(uv, dtype=float).T
        c, s = self.minor * np.cos(v), self.minor * np.sin(v)
        return _revolve_derivatives(u, np.stack([self.major + c, -s, -c]), np.stack([s, c, -s]))

    def principal(self, uv: Array) -> tuple[Array, Array]:
        """Principal curvatures k1 >= k2, each (n,), 1/mm."""
        c = np.cos(np.asarray(uv, dtype=float)[:, 1])
        return -c / (self.major + self.minor * c), np.full(len(c), -1.0 / self.minor)

    def nurbs(self) -> NurbsSurface:
        """The same surface as a rational B-spline of degree (2, 2)."""
        knots, rows = _arc(self.v_range)
        rho = self.major * rows[:, 2] + self.minor * rows[:, 0]
        return _revolve_rows(self.u_range, knots, 2, np.column_stack([rho, self.minor * rows[:, 1], rows[:, 2]]))

    def parameters(self, uv: Array) -> Array:
        """Parameters of `nurbs` at (n, 2) parameters of this surface."""
        u, v = np.asarray(uv, dtype=float).T
        return np.column_stack([arc_parameter(u, self.u_range), arc_parameter(v, self.v_range)])


@dataclass(frozen=True)
class HyperbolicParaboloid:
    """(u, v, (v^2 - u^2) / c), normal upwards.

    **Source**: the defaults are the test surface of [grandguillaume2021].
    """

    divisor: float = 500.0
    u_range: Range = (-50.0, 50.0)
    v_range: Range = (-50.0, 50.0)

    def __post_init__(self) -> None:
        _check(divisor=self.divisor)
        _check_range("u", self.u_range)
        _check_range("v", self.v_range)

    @property
    def domain(self) -> Domain:
        """Ranges of u = x and v = y, mm."""
        return self.u_range, self.v_range

    def evaluate(self, uv: Array) -> Derivatives:
        """Position and derivatives at (n, 2) parameters, mm."""
        u, v = np.asarray(uv, dtype=float).T
        zero = np.zeros_like(u)
        one = np.ones_like(u)
        c = self.divisor
        return Derivatives(
            point=_rows_of(u, v, (v**2 - u**2) / c),
            su=_rows_of(one, zero, -2 * u / c),
            sv=_rows_of(zero, one, 2 * v / c),
            suu=_rows_of(zero, zero, -2 * one / c),
            suv=_rows_of(zero, zero, zero),
            svv=_rows_of(zero, zero, 2 * one / c))

    def principal(self, uv: Array) -> tuple[Array, Array]:
        """Principal curvatures k1 >= k2, each (n,), 1/mm, from mean and Gaussian curvature of a graph."""
        fx, fy = 2 * np.asarray(uv, dtype=float).T / self.divisor
        size = 1 + fx**2 + fy**2
        mean = (fx**2 - fy**2) / (self.divisor * size**1.5)
        root = np.sqrt(mean**2 + 4 / (self.divisor * size) ** 2)
        return mean + root, mean - root

    def nurbs(self) -> NurbsSurface:
        """The same surface as a polynomial B-spline of degree (2, 2)."""
        x, xx = _quadratic_controls(self.u_range)
        y, yy = _quadratic_controls(self.v_range)
        z = (yy[None, :] - xx[:, None]) / self.divisor
        columns, rows = np.meshgrid(x, y, indexing="ij")
        weights = np.ones((3, 3))
        control = np.stack([columns, rows, z, weights], axis=-1)
        knots_u = np.repeat(self.u_range, 3)
        knots_v = np.repeat(self.v_range, 3)
        return NurbsSurface(knots_u, knots_v, control, (2, 2))

    def parameters(self, uv: Array) -> Array:
        """Parameters of `nurbs` at (n, 2) parameters of this surface."""
        return np.array(uv, dtype=float)
