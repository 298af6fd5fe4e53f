"""Pieces of a B-spline surface as Bezier nets, and what their control points prove about its derivatives.

A Bezier patch lies in the hull of its control points; so do its derivatives in the hull of the difference nets.  The
greatest norm of a difference net is therefore a bound that holds between all parameters.
"""

from math import comb

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.bspline import SurfaceData

Array = NDArray[np.float64]


def bezier_rows(knots: Array, degree: int, low: Array, high: Array) -> tuple[Array, NDArray[np.intp]]:
    """Weights that turn B-spline control points into Bezier points on intervals inside single knot spans.

    Parameters
    ----------
    knots : (m,) array
    degree : int
    low, high : (n,) array
        Ends of the intervals; no knot may lie strictly between them.

    Returns
    -------
    rows : (n, degree + 1, degree + 1) array
        Bezier point j = rows[:, j] @ the active control points.
    first : (n,) array of int
        Index of the first active control point.

    Notes
    -----
    **Source**: Ramshaw's blossom: Bezier point j is the polar form at (degree - j) times low and j times high.
    """
    last = np.flatnonzero(knots < knots[len(knots) - degree - 1])[-1]
    span = np.clip(np.searchsorted(knots, (low + high) / 2, side="right") - 1, degree, last)
    rows = np.empty((len(low), degree + 1, degree + 1))
    for j in range(degree + 1):
        table = np.broadcast_to(np.eye(degree + 1), (len(low), degree + 1, degree + 1))
        for d in range(1, degree + 1):
            t = low if d <= degree - j else high
            after = span[:, None] + 1 + np.arange(degree + 1 - d)
            upper = knots[after]
            lower = knots[after - 1 - degree + d]
            share = ((t[:, None] - lower) / (upper - lower))[:, :, None]
            table = (1 - share) * table[:, :-1] + share * table[:, 1:]
        rows[:, j] = table[:, 0]
    return rows, span - degree


def bezier_nets(data: SurfaceData, breaks_u: Array, breaks_v: Array) -> Array:
    """Homogeneous Bezier nets of a surface over a grid of cells.

    Parameters
    ----------
    data : tuple
        The surface.
    breaks_u, breaks_v : (nu + 1,), (nv + 1,) array
        Grid lines; every knot between the first and the last must be one of them.

    Returns
    -------
    (nu, nv, pu + 1, pv + 1, 4) array
    """
    knots_u, knots_v, control, pu, pv, _ = data
    rows_u, first_u = bezier_rows(knots_u, pu, breaks_u[:-1], breaks_u[1:])
    rows_v, first_v = bezier_rows(knots_v, pv, breaks_v[:-1], breaks_v[1:])
    active_u = first_u[:, None] + np.arange(pu + 1)
    active_v = first_v[:, None] + np.arange(pv + 1)
    along_u = np.einsum("iab,ibjc->iajc", rows_u, control[active_u])
    net = along_u[:, :, active_v]
    return np.asarray(np.einsum("jab,icjbd->ijcad", rows_v, net))


def _peak(net: Array) -> Array:
    """Greatest norm of the control vectors of each net."""
    if 0 in net.shape[2:4]:
        return np.zeros(net.shape[:2])
    size = np.sqrt(np.einsum("ijabc,ijabc->ijab", net, net))
    return np.asarray(size.max(axis=(2, 3)))


#: How far weights may be from a product of one factor for each direction, as a share of them: rounding, which moves a
#: patch and its tangents by less than the rounding that its cells allow for.
_PRODUCT = 1e-13


class _Bounds:
    """Bounds of a surface's derivatives over Bezier patches, each from those of lower order.

    With S = c + A / w, w Suu = Auu - 2 wu Su - wuu (S - c), and so on after Leibniz; each factor is bounded by its net.
    """

    def __init__(self, nets: Array, centre: Array, width_u: Array, width_v: Array) -> None:
        """centre : (nu, nv, pu + 1, pv + 1, 3) array, the net of w c."""
        self.degree = (nets.shape[2] - 1, nets.shape[3] - 1)
        self.width = (width_u[:, None], width_v[None, :])
        self.w = nets[..., 3:]
        self.a = nets[..., :3] - centre
        self.least = self.w.min(axis=(2, 3, 4))
        self.known: dict[tuple[int, int], Array] = {(0, 0): _peak(self.a / self.w)}

    def slope(self, net: Array, order: tuple[int, int]) -> Array:
        """Bound of a derivative of a net of control points."""
        for axis in (0, 1):
            for k in range(order[axis]):
                width = self.width[axis][..., None, None, None]
                net = np.diff(net, axis=axis + 2) * ((self.degree[axis] - k) / width)
        return _peak(net)

    def of(self, u: int, v: int) -> Array:
        """Bound of the derivative of orders u and v of the surface, (nu, nv)."""
        if (u, v) not in self.known:
            total = self.slope(self.a, (u, v))
            for i in range(u + 1):
                for j in range(v + 1):
                    if i + j:
                        times = comb(u, i) * comb(v, j)
                        total = total + times * self.slope(self.w, (i, j)) * self.of(u - i, v - j)
            self.known[u, v] = total / self.least
        return self.known[u, v]


def derivative_bounds(nets: Array, width_u: Array, width_v: Array, *orders: int) -> Array:
    """Bounds of all derivatives of some orders over Bezier patches.

    Parameters
    ----------
    nets : (nu, nv, pu + 1, pv + 1, 4) array
        Homogeneous nets.
    width_u, width_v : (nu,), (nv,) array
        Parameter widths of the patches.
    *orders : int
        2 for |Suu|, |Suv| and |Svv|, 3 for |Suuu|, |Suuv|, |Suvv| and |Svvv|.

    Returns
    -------
    (nu, nv, k) array
        One order after the other.
    """
    w = nets[..., 3:]
    places = nets[..., :3] / w
    middle = _Bounds(nets, w * places.mean(axis=(2, 3), keepdims=True), width_u, width_v)
    # Derivatives along u are those of S less any function of v, and the other way round.  That matters where a patch is
    # much longer than its bends are wide, as on fillets: far from c its own length would count as a bend.
    separable = _vary_as_products(w)
    along_u = along_v = middle
    if separable.any():
        along_u = _Bounds(nets, w * places.mean(axis=2, keepdims=True), width_u, width_v)
        along_v = _Bounds(nets, w * places.mean(axis=3, keepdims=True), width_u, width_v)
    found = []
    for order in orders:
        for k in range(order + 1):
            bound = middle.of(order - k, k)
            if k < order:
                bound = np.where(separable, np.minimum(bound, along_u.of(order - k, k)), bound)
            if k > 0:
                bound = np.where(separable, np.minimum(bound, along_v.of(order - k, k)), bound)
            found.append(bound)
    return np.stack(found, axis=-1)


def _vary_as_products(w: Array) -> NDArray[np.bool_]:
    """Patches whose weights (nu, nv, pu + 1, pv + 1, 1) differ and are products of one factor for each direction."""
    first = w[..., :1, :1, :]
    product = w[..., :1, :, :] * w[..., :, :1, :] / first
    differ = (w != first).any(axis=(2, 3, 4))
    return np.asarray(differ & (np.abs(product - w) <= _PRODUCT * w).all(axis=(2, 3, 4)))
