"""The same spline written anew: more knots, a higher degree, a part of its range, or no period."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.bspline import basis_derivatives_numpy

Array = NDArray[np.float64]

#: Knots closer than this share of their range are one knot.
SAME = 1e-12


def multiplicity(knots: Array, t: float) -> int:
    """How often a knot occurs.

    Parameters
    ----------
    knots : (m,) array
    t : float
    """
    return int(np.count_nonzero(knots == t))


def distinct_inner(knots: Array, degree: int) -> tuple[Array, NDArray[np.int64]]:
    """Distinct knots strictly inside the range, and how often each occurs.

    Parameters
    ----------
    knots : (m,) array
    degree : int
    """
    values, counts = np.unique(knots, return_counts=True)
    inner = (values > knots[degree]) & (values < knots[-degree - 1])
    return values[inner], counts[inner].astype(np.int64)


def insert_knot(knots: Array, control: Array, degree: int, t: float) -> tuple[Array, Array]:
    """Insert one knot; the spline stays the same.

    Parameters
    ----------
    knots : (m,) array
    control : (n, ...) array
        Control points along the first axis, homogeneous where the spline is rational.
    degree : int
    t : float
        Inside the range, its ends included.

    Returns
    -------
    knots : (m + 1,) array
    control : (n + 1, ...) array

    **Source**: Boehm's algorithm.
    """
    place = int(np.searchsorted(knots, t, side="right"))
    k = min(max(place - 1, degree), len(control) - 1)  # the span that holds t
    i = np.arange(k - degree + 1, k + 1)
    span = knots[i + degree] - knots[i]
    is_span = span > 0
    share = np.where(is_span, (t - knots[i]) / np.where(is_span, span, 1.0), 0.0)
    share = share.reshape(-1, *([1] * (control.ndim - 1)))
    mixed = share * control[i] + (1 - share) * control[i - 1]
    before = control[:k - degree + 1]
    after = control[k:]
    return np.insert(knots, place, t), np.concatenate([before, mixed, after])


def restrict_spline(knots: Array, control: Array, degree: int, low: float, high: float) -> tuple[Array, Array]:
    """The piece of a spline over [low, high], with clamped ends.

    Parameters
    ----------
    knots : (m,) array
    control : (n, ...) array
    degree : int
    low, high : float
        Inside the range; low < high.

    Raises
    ------
    InvalidInput
        When the interval is empty or leaves the range.

    **Properties**: 1. every point of the piece lies where it lay on the whole spline, at the same parameter.
    """
    begin, end = knots[degree], knots[-degree - 1]
    if not begin <= low < high <= end:
        raise InvalidInput(f"interval [{low}, {high}] must be a part of the spline's range [{begin}, {end}]")
    knots = np.array(knots)
    for t in (low, high):
        knots[np.abs(knots - t) <= SAME * (high - low)] = t
        for _ in range(degree - multiplicity(knots, t)):
            knots, control = insert_knot(knots, control, degree, t)
    first = int(np.searchsorted(knots, low, side="right")) - 1 - degree
    inner = knots[(knots > low) & (knots < high)]
    clamped = np.concatenate([np.full(degree + 1, low), inner, np.full(degree + 1, high)])
    count = len(clamped) - degree - 1
    return clamped, np.ascontiguousarray(control[first:first + count])


def unroll_periodic(knots: Array, control: Array, degree: int, low: float, high: float) -> tuple[Array, Array]:
    """A periodic spline written without period over [low, high], with clamped ends.

    Parameters
    ----------
    knots : (n + 2 degree + 2 - wrapped,) array
        One period of the flat knot sequence with its continuation on both sides: the range runs from
        ``knots[degree]`` to ``knots[-degree - 1]``.
    control : (n, ...) array
        The distinct control points of one period; the i-th basis function takes control point i modulo n.
    degree : int
    low, high : float
        Any interval, also longer than the period or beyond the range.
    """
    begin = knots[degree]
    period = float(knots[-degree - 1] - begin)
    first = int(np.floor((low - begin) / period)) - 1
    last = int(np.ceil((high - begin) / period)) + 1
    turns = np.arange(first, last + 1)
    of_one_period = knots[:len(control)]
    repeated = (of_one_period + period * turns[:, None]).ravel()
    # Knots that are one but for rounding become the first of them.
    is_new = np.diff(repeated, prepend=repeated[0] - period) > SAME * period
    which = np.cumsum(is_new) - 1
    unrolled = repeated[is_new][which]
    net = np.concatenate([control] * len(turns))
    return restrict_spline(unrolled, net[:len(unrolled) - degree - 1], degree, low, high)


def insert_knots(knots: Array, control: Array, degree: int, target: Array) -> Array:
    """Control points of a spline on more knots.

    Parameters
    ----------
    knots : (m,) array
    control : (n, ...) array
    degree : int
    target : (k,) array
        The knots and others between them; equal numbers are one knot.

    Returns
    -------
    (k - degree - 1, ...) array

    **Properties**: 1. the spline stays the same; 2. without other knots the control points stay as they are.
    """
    for t in np.unique(target):
        for _ in range(multiplicity(target, t) - multiplicity(knots, t)):
            knots, control = insert_knot(knots, control, degree, t)
    return control


def elevate_degree(knots: Array, control: Array, degree: int, target: int) -> tuple[Array, Array]:
    """A continuous spline with clamped ends written with a higher degree.

    Parameters
    ----------
    knots : (m,) array
        Inner ones repeat no more than the degree says.
    control : (n, ...) array
    degree, target : int
        The degree that it has and the one that it gets.

    Notes
    -----
    Every knot repeats as much oftener as the degree rises. The control points are found from the values at the Greville
    places of the new knots.

    **Properties**: 1. the spline stays the same, to rounding; 2. with its own degree it stays as it is.
    """
    if target == degree:
        return knots, control
    values, counts = np.unique(knots, return_counts=True)
    more = np.repeat(values, counts + target - degree)
    greville = np.lib.stride_tricks.sliding_window_view(more[1:-1], target).mean(axis=1)
    points = _collocation(knots, degree, greville) @ control.reshape(len(control), -1)
    found = np.linalg.solve(_collocation(more, target, greville), points)
    found[[0, -1]] = points[[0, -1]]
    return np.asarray(more), np.asarray(found).reshape(-1, *control.shape[1:])


def _collocation(knots: Array, degree: int, places: Array) -> Array:
    """Basis functions (columns) at places (rows)."""
    derivatives, first = basis_derivatives_numpy(knots, degree, places)
    values = derivatives[:, 0]
    columns = first[:, None] + np.arange(degree + 1)
    table = np.zeros((len(places), len(knots) - degree - 1))
    np.put_along_axis(table, columns, values, axis=1)
    return table
