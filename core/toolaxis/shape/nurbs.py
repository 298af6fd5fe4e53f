"""Rational B-spline surfaces: the one kind of surface that the core computes with."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.bspline import MAX_DEGREE, SurfaceData, surface_derivatives_many
from toolaxis.progress import breathe
from toolaxis.shape.folds import TurningCells, find_turning_cells
from toolaxis.shape.surface import Derivatives, Domain

Array = NDArray[np.float64]


def uniform_knots(count: int, degree: int) -> Array:
    """Clamped uniform knots on [0, 1].

    Parameters
    ----------
    count : int
        Number of control points.
    degree : int
    """
    return np.concatenate([np.zeros(degree), np.linspace(0.0, 1.0, count - degree + 1), np.ones(degree)])


def _pair(given: Any, name: str) -> Any:
    if not isinstance(given, Iterable) or len(found := tuple(given)) != 2:
        raise InvalidInput(f"{name} are {given!r}: a pair is needed, one for u and one for v")
    return found


def _net(points: ArrayLike) -> Array:
    try:
        net = np.asarray(points, dtype=float)
    except (TypeError, ValueError):
        raise InvalidInput("control points are no array of numbers: (nu, nv, 3) is needed") from None
    if net.ndim != 3 or net.shape[2] != 3:
        raise InvalidInput(f"control points have shape {net.shape}: (nu, nv, 3) is needed")
    bad = np.argwhere(~np.isfinite(net).all(axis=2))
    if len(bad):
        raise InvalidInput(f"control point {bad[0].tolist()} is {net[tuple(bad[0])].tolist()}: every number must be "
                           "finite")
    return net


@dataclass(frozen=True, eq=False)
class NurbsSurface:
    """A tensor-product rational B-spline surface.

    Attributes
    ----------
    knots_u, knots_v : (m,) array
        Non-decreasing knots, clamped at both ends or not.
    control : (nu, nv, 4) array
        Homogeneous control points (w x, w y, w z, w), mm; weights above zero.
    degree : (int, int)

    Raises
    ------
    InvalidInput
        When counts do not fit, knots decrease, or a number is not finite or a weight not positive.
    """

    knots_u: Array
    knots_v: Array
    control: Array
    degree: tuple[int, int]

    def __post_init__(self) -> None:
        control = np.ascontiguousarray(self.control, dtype=float)
        object.__setattr__(self, "control", control)
        if control.ndim != 3 or control.shape[2] != 4 or not np.isfinite(control).all():
            raise InvalidInput(f"control points have shape {control.shape}: finite (nu, nv, 4) is needed")
        if not (control[..., 3] > 0).all():
            i, j = np.argwhere(control[..., 3] <= 0)[0]
            raise InvalidInput(f"weight [{i}, {j}] is {control[i, j, 3]}: weights must be above zero")
        for axis, name in enumerate(("u", "v")):
            self._check_knots(axis, name)

    def _check_knots(self, axis: int, name: str) -> None:
        knots = np.ascontiguousarray(getattr(self, f"knots_{name}"), dtype=float)
        object.__setattr__(self, f"knots_{name}", knots)
        degree, count = self.degree[axis], self.control.shape[axis]
        if not 1 <= degree <= MAX_DEGREE:
            raise InvalidInput(f"degree in {name} is {degree}: 1 to {MAX_DEGREE} can be handled")
        if count <= degree or knots.shape != (count + degree + 1,):
            raise InvalidInput(f"{len(knots)} knots in {name} for {count} points of degree {degree}: "
                               f"points must be more than the degree and knots = points + degree + 1")
        if not np.isfinite(knots).all() or (np.diff(knots) < 0).any():
            raise InvalidInput(f"knots in {name} must be finite and not decrease")
        if not knots[degree] < knots[count]:
            raise InvalidInput(f"knots in {name} span no parameter range")
        inner = knots[1:-1]
        if len(inner) > degree and (inner[degree:] - inner[:-degree] <= 0).any():
            raise InvalidInput(f"a knot in {name} repeats more than {degree} times: split the surface there")

    @classmethod
    def from_points(cls, points: ArrayLike, degree: tuple[int, int] = (3, 3),
                    knots: tuple[ArrayLike, ArrayLike] | None = None,
                    weights: ArrayLike | None = None) -> "NurbsSurface":
        """A surface from control points in space.

        Parameters
        ----------
        points : (nu, nv, 3) array_like
            Control points, mm.
        degree : (int, int)
        knots : pair of array_like, optional
            Full knot vectors in u and v; clamped uniform on [0, 1] unless given.
        weights : (nu, nv) array_like, optional

        Raises
        ------
        InvalidInput
            When shapes or values do not fit.
        """
        degree = _pair(degree, "degrees")
        net = _net(points)
        for axis, name in enumerate(("u", "v")):
            if net.shape[axis] <= degree[axis]:
                raise InvalidInput(f"{net.shape[axis]} control points in {name} for degree {degree[axis]}: "
                                   f"at least {degree[axis] + 1} are needed")
        w = np.ones(net.shape[:2]) if weights is None else np.asarray(weights, dtype=float)
        if w.shape != net.shape[:2]:
            raise InvalidInput(f"weights have shape {w.shape}: {net.shape[:2]} is needed")
        ku, kv = _pair(knots, "knots") if knots is not None else (uniform_knots(net.shape[0], degree[0]),
                                                                  uniform_knots(net.shape[1], degree[1]))
        control = np.concatenate([net * w[..., None], w[..., None]], axis=2)
        return cls(np.asarray(ku, dtype=float), np.asarray(kv, dtype=float), control, (degree[0], degree[1]))

    @property
    def stand_in(self) -> "NurbsSurface | None":
        """What stands for the surface where kernels take its numbers; None where these are its own."""
        return None

    @property
    def domain(self) -> Domain:
        """Ranges of u and v."""
        (pu, pv), ku, kv = self.degree, self.knots_u, self.knots_v
        return (float(ku[pu]), float(ku[-pu - 1])), (float(kv[pv]), float(kv[-pv - 1]))

    @property
    def spline(self) -> "NurbsSurface":
        """The surface whose numbers kernels take: it stands for this one where strips are measured."""
        return self

    @property
    def breaks(self) -> tuple[Array, Array]:
        """Inner values of u and of v at which a higher derivative may jump."""
        (u0, u1), (v0, v1) = self.domain
        u, v = np.unique(self.knots_u), np.unique(self.knots_v)
        return u[(u > u0) & (u < u1)], v[(v > v0) & (v < v1)]

    @cached_property
    def data(self) -> SurfaceData:
        """The tuple that kernels take."""
        rational = bool(np.ptp(self.control[..., 3]) > 0 or self.control[0, 0, 3] != 1.0)
        return self.knots_u, self.knots_v, self.control, self.degree[0], self.degree[1], rational

    @cached_property
    def turning_cells(self) -> TurningCells:
        """Where Su x Sv may turn over."""
        return find_turning_cells(self.data)

    def inward(self, uv: Array) -> Array:
        """Direction in (u, v) from parameters to the middle of the domain.

        Parameters
        ----------
        uv : (n, 2) array
        """
        (u0, u1), (v0, v1) = self.domain
        return np.asarray(np.array([0.5 * (u0 + u1), 0.5 * (v0 + v1)]) - uv)

    def evaluate(self, uv: Array) -> Derivatives:
        """Position and derivatives up to the second order.

        Parameters
        ----------
        uv : (n, 2) array
            Parameters; outside the domain the surface goes on linearly in the parameter that was crossed.
        """
        breathe()  # nearly every long loop comes by here
        table = surface_derivatives_many(self.data, np.asarray(uv, dtype=float).reshape(-1, 2))
        return Derivatives(*(table[:, k] for k in range(6)))

    def transformed(self, matrix: ArrayLike) -> "NurbsSurface":
        """The surface moved by an affine map.

        Parameters
        ----------
        matrix : (4, 4) array_like
            Maps column vectors (x, y, z, 1).
        """
        m = np.asarray(matrix, dtype=float)
        if m.shape != (4, 4) or not np.isfinite(m).all() or np.abs(m[3] - [0, 0, 0, 1]).max() > 0:
            raise InvalidInput("the transformation must be a finite (4, 4) affine matrix with last row 0 0 0 1")
        return NurbsSurface(self.knots_u, self.knots_v, self.control @ m.T, self.degree)

    def swapped(self) -> "NurbsSurface":
        """The same surface with u and v exchanged."""
        return NurbsSurface(self.knots_v, self.knots_u, self.control.transpose(1, 0, 2), self.degree[::-1])
