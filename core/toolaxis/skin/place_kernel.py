"""The point of a surface that lies at a place of a plane, by Newton's method: the kernel."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.bspline import SurfaceData, surface_derivatives
from toolaxis.numeric.jit import jit, jit_unfused, jit_unfused_inline

Array = NDArray[np.float64]

ITERATIONS, LAST, FAR = 30, 1e-8, 0.25
"""Newton steps, the step after which the next one is below rounding, and the longest step, as shares of the range."""
BESIDE = (0.01, 0.03, 0.1)
"""How far beside the first parameters the search begins again where it does not end, to either side in u and in v, as
shares of the range: next to a fold of the surface, however small, the method goes to and fro."""
PARALLEL = 1e-14
"""Share of their lengths' product below which the cross product of two directions tells that they are one."""


class PlaceFrame(NamedTuple):
    """A plane, and the range of a surface's parameters.

    rows : (2, 3) array, coordinates in the plane are rows @ (p - origin);  origin : (3,) array, mm
    ends : (2, 3) array, least value of u and of v, its range, and the range in which it is closed, infinite if open
    """

    rows: Array
    origin: Array
    ends: Array


@jit_unfused_inline
def _part(rows: Array, k: int, vector: Array) -> float:
    """Coordinate k of a vector in the plane."""
    return float(rows[k, 0] * vector[0] + rows[k, 1] * vector[1] + rows[k, 2] * vector[2])


@jit_unfused_inline
def _search_place(data: SurfaceData, frame: PlaceFrame, place: Array, uv: Array, d: Array, work: Array) -> float:
    """Newton's method from the parameters in ``uv``; the square of how far from the place it gave up, mm^2, 0 where it
    ended, and then ``d`` holds the vectors there."""
    rows, origin, ends = frame
    away = np.inf
    for _ in range(ITERATIONS):
        surface_derivatives(data, uv[0], uv[1], d, work)
        x = place[0] - (_part(rows, 0, d[0]) - _part(rows, 0, origin))
        y = place[1] - (_part(rows, 1, d[0]) - _part(rows, 1, origin))
        ax = _part(rows, 0, d[1])
        ay = _part(rows, 1, d[1])
        bx = _part(rows, 0, d[2])
        by = _part(rows, 1, d[2])
        det = ax * by - ay * bx
        along_u = 0.0
        along_v = 0.0
        if abs(det) > PARALLEL * np.sqrt(ax * ax + ay * ay) * np.sqrt(bx * bx + by * by):
            along_u = (x * by - y * bx) / det
            along_v = (ax * y - ay * x) / det
        size = max(abs(along_u) / ends[0, 1], abs(along_v) / ends[1, 1])
        shorter = FAR / size if size > FAR else 1.0
        uv[0] += shorter * along_u
        uv[1] += shorter * along_v
        for k in range(2):
            if np.isfinite(ends[k, 2]):
                uv[k] = ends[k, 0] + (uv[k] - ends[k, 0]) % ends[k, 2]
        away = x * x + y * y
        if size <= LAST:
            _carry_vectors(along_u, along_v, d)
            return 0.0
    return away


@jit_unfused_inline
def _carry_vectors(along_u: float, along_v: float, d: Array) -> None:
    """S, Su and Sv carried on by a last step, which is so short that the bend does not change."""
    for c in range(3):
        d[0, c] += along_u * d[1, c] + along_v * d[2, c]
        d[1, c] += along_u * d[3, c] + along_v * d[4, c]
        d[2, c] += along_u * d[4, c] + along_v * d[5, c]


@jit_unfused
def find_place(data: SurfaceData, frame: PlaceFrame, place: Array, uv: Array, d: Array, work: Array) -> None:
    """Parameters of a surface at one place of the plane, with the six vectors there.

    Parameters
    ----------
    data : SurfaceData
    frame : PlaceFrame
    place : (2,) array
    uv : (2,) array
        Where to begin; receives the parameters, of the nearest point that was found where no search ends.
    d : (6, 3) array
        Receives S, Su, Sv, Suu, Suv, Svv.
    work : (6, 26) array
        What is in it does not count.
    """
    u = uv[0]
    v = uv[1]
    ends = frame.ends
    away = _search_place(data, frame, place, uv, d, work)
    if away > 0.0:
        best_u = uv[0]
        best_v = uv[1]
        for share in BESIDE:
            for in_u, in_v in ((-share, 0.0), (share, 0.0), (0.0, -share), (0.0, share)):
                if away == 0.0:
                    break
                beside_u = u + in_u * ends[0, 1]
                beside_v = v + in_v * ends[1, 1]
                uv[0] = beside_u
                uv[1] = beside_v
                left = _search_place(data, frame, place, uv, d, work)
                if left < away:
                    away = left
                    best_u = uv[0]
                    best_v = uv[1]
        uv[0] = best_u
        uv[1] = best_v
        surface_derivatives(data, uv[0], uv[1], d, work)


@jit
def find_places(data: SurfaceData, frame: PlaceFrame, places: Array, uv: Array, out: Array) -> None:
    """Parameters of a surface at places of a plane, with the six vectors there.

    Parameters
    ----------
    data : SurfaceData
    frame : PlaceFrame
    places : (n, 2) array
    uv : (n, 2) array
        Where to begin; receives the parameters.
    out : (n, 6, 3) array
        Receives S, Su, Sv, Suu, Suv, Svv.
    """
    work = np.empty((6, 26))
    for i in range(places.shape[0]):
        find_place(data, frame, places[i], uv[i], out[i], work)


@jit_unfused
def turn_place_into_plane(rows: Array, d: Array, memory: Array) -> None:
    """Vectors S, Su, Sv, Suu, Suv, Svv of one place turned into derivatives with the place in the plane, in place.

    Places in the plane move evenly: what the second derivatives would move aside, u and v take back.

    Parameters
    ----------
    rows : (2, 3) array
    d : (6, 3) array
    memory : (7, 3) array
        What is in it does not count.
    """
    rate = memory[0:2]  # of u and v with x, and with y
    first = memory[2:4]
    bend = memory[4:7]
    ax = _part(rows, 0, d[1])
    ay = _part(rows, 1, d[1])
    bx = _part(rows, 0, d[2])
    by = _part(rows, 1, d[2])
    det = ax * by - ay * bx
    if not abs(det) > 0.0:
        det = np.finfo(np.float64).tiny
    u_with_x = by / det
    u_with_y = -ay / det
    v_with_x = -bx / det
    v_with_y = ax / det
    rate[0, 0] = u_with_x
    rate[0, 1] = u_with_y
    rate[1, 0] = v_with_x
    rate[1, 1] = v_with_y
    for k in range(2):
        for c in range(3):
            first[k, c] = d[1, c] * rate[k, 0] + d[2, c] * rate[k, 1]
    for n in range(3):
        p = 0 if n < 2 else 1  # the second derivatives xx, xy and yy, as pairs of rates
        q = 0 if n < 1 else 1
        for c in range(3):
            bend[n, c] = (d[3, c] * rate[p, 0] * rate[q, 0] + d[5, c] * rate[p, 1] * rate[q, 1]
                          + d[4, c] * (rate[p, 0] * rate[q, 1] + rate[p, 1] * rate[q, 0]))
    for n in range(3):
        x = _part(rows, 0, bend[n])
        y = _part(rows, 1, bend[n])
        for c in range(3):
            d[3 + n, c] = bend[n, c] - first[0, c] * x - first[1, c] * y
    for k in range(2):
        for c in range(3):
            d[1 + k, c] = first[k, c]


@jit
def turn_into_plane(rows: Array, table: Array) -> None:
    """The same for many places.

    Parameters
    ----------
    rows : (2, 3) array
    table : (n, 6, 3) array
    """
    memory = np.empty((7, 3))
    for i in range(table.shape[0]):
        turn_place_into_plane(rows, table[i], memory)
