"""Nearest points of a face to one target after the other, compiled; what cannot be the nearest is passed over."""

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.bspline import SurfaceData, surface_derivatives, surface_point
from toolaxis.numeric.golden_section import GOLDEN
from toolaxis.numeric.jit import jit, jit_inline
from toolaxis.numeric.polygons import lies_inside
from toolaxis.shape.nearest_numpy import LEAST_SHARE, NOTHING, STEPS

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Vector: TypeAlias = tuple[float, float, float]

#: Share of a parameter's range within which a search has come to what another one found, and the share of the squared
#: distance that its rounding hides.
_SAME, _NO_FALL = 1e-7, 1e-16
#: Steps of a golden section, as `least_between` takes them; by how much distances may be rounded, mm.
_SECTIONS, ROUNDING = 40, 1e-9


class FaceRange(NamedTuple):
    """Where a face lies in its parameters.

    bounds : (u0, u1, v0, v1);
    trimmed : bool, whether loops bound it; the range alone does otherwise;
    edges, start, member, grid : of the loops' `EdgeIndex`: its edges, its table, and low, height and border.
    """

    bounds: tuple[float, float, float, float]
    trimmed: bool
    edges: Array
    start: Index
    member: Index
    grid: tuple[float, float, float, float]


class FaceLoop(NamedTuple):
    """A loop of a face in pieces along its edges.

    corner (m, 2): parameters of its corners;  position (k + 1,): where the pieces begin and the last one ends, for
    `walk`;  reach (k,): bounds of their lengths, mm.
    """

    corner: Array
    position: Array
    reach: Array


@jit_inline
def _contains(face: FaceRange, u: float, v: float) -> bool:
    if face.trimmed:
        return lies_inside(face.edges, (face.start, face.member), face.grid, u, v)
    u0, u1, v0, v1 = face.bounds
    return bool(u0 <= u <= u1 and v0 <= v <= v1)


class _NearestStep(NamedTuple):
    """A step towards the nearest point: in u and v, and the half of what the squared distance falls by on it, mm^2."""

    u: float
    v: float
    fall: float


@jit_inline
def _newton(at: Array, target: Vector) -> _NearestStep:
    """A step of Newton's method down the squared distance, of Gauss and Newton's where the former would climb.

    at (6, 3): position and derivatives.
    """
    fu = fv = e = f = g = uu = uv = vv = 0.0
    for k in range(3):
        gap, su, sv = at[0, k] - target[k], at[1, k], at[2, k]
        fu, fv = fu + gap * su, fv + gap * sv
        e, f, g = e + su * su, f + su * sv, g + sv * sv
        uu, uv, vv = uu + gap * at[3, k], uv + gap * at[4, k], vv + gap * at[5, k]
    a, b, c = e + uu, f + uv, g + vv
    if not (a > 0.0 and a * c - b * b > 1e-12 * e * g):
        a, b, c = e * (1.0 + 1e-9), f, g * (1.0 + 1e-9)
    determinant = a * c - b * b
    if determinant <= 0.0:
        return _NearestStep(0.0, 0.0, 0.0)
    u, v = (b * fv - c * fu) / determinant, (b * fu - a * fv) / determinant
    return _NearestStep(u, v, -0.5 * (u * fu + v * fv))


@jit_inline
def _distance(x: float, y: float, z: float, target: Vector) -> float:
    a, b, c = x - target[0], y - target[1], z - target[2]
    return float(np.sqrt(a * a + b * b + c * c))


class _End(NamedTuple):
    """Where a search ends: parameters, the distance, mm, and whether nothing nearer lies around."""

    u: float
    v: float
    distance: float
    settled: bool


@jit
def _descend(data: SurfaceData, face: FaceRange, target: Vector, start: _End, known: _End,
             room: tuple[Array, Array, Array]) -> _End:
    """Where Newton's steps down the squared distance end; they are halved until they descend, as long as they stay on
    the face.

    The search ends where it comes to what another one has found, and where shorter steps would gain less than distances
    are rounded by.
    """
    here, there, work = room
    u0, u1, v0, v1 = face.bounds
    wide, tall = u1 - u0, v1 - v0
    u, v, share, settled = start.u, start.v, 1.0, False
    surface_derivatives(data, u, v, here, work)
    best = _distance(here[0, 0], here[0, 1], here[0, 2], target)
    step = _newton(here, target)
    for _ in range(STEPS):
        if known.settled and abs(u - known.u) < _SAME * wide and abs(v - known.v) < _SAME * tall:
            return known
        trial_u, trial_v = min(max(u + share * step.u, u0), u1), min(max(v + share * step.v, v0), v1)
        if abs(trial_u - u) <= NOTHING * wide and abs(trial_v - v) <= NOTHING * tall:
            settled = True
            break
        surface_derivatives(data, trial_u, trial_v, there, work)
        found = _distance(there[0, 0], there[0, 1], there[0, 2], target)
        if found < best and _contains(face, trial_u, trial_v):
            u, v, best, share = trial_u, trial_v, found, 1.0
            step = _newton(there, target)
            continue
        share *= 0.5
        settled = step.fall <= _NO_FALL * best * best
        if settled or share < LEAST_SHARE:
            break
    return _End(u, v, best, settled)


@jit
def nearest_inside(data: SurfaceData, face: FaceRange, targets: Array, grid: Array, starts: Index,
                   out: tuple[Array, Array]) -> None:
    """Nearest points inside a face: parameters into out[0] (n, 2) and distances into out[1] (n,).

    Each search sets out from those points of a grid (m, 2) that the rows of starts (n, k) name.
    """
    room = np.empty((6, 3)), np.empty((6, 3)), np.empty((6, 26))
    for i in range(targets.shape[0]):
        target = targets[i, 0], targets[i, 1], targets[i, 2]
        nearest = _End(0.0, 0.0, np.inf, False)
        for k in range(starts.shape[1]):
            at = starts[i, k]
            found = _descend(data, face, target, _End(grid[at, 0], grid[at, 1], np.inf, False), nearest, room)
            if found.distance < nearest.distance:
                nearest = found
        out[0][i, 0], out[0][i, 1], out[1][i] = nearest.u, nearest.v, nearest.distance


@jit_inline
def _place(corner: Array, position: float) -> tuple[float, float]:
    """A point on a loop, as `walk` tells it."""
    edge = np.floor(position)
    share = position - edge
    start = int(edge) % corner.shape[0]
    end = (start + 1) % corner.shape[0]
    return ((1.0 - share) * corner[start, 0] + share * corner[end, 0],
            (1.0 - share) * corner[start, 1] + share * corner[end, 1])


@jit_inline
def _gap(data: SurfaceData, corner: Array, target: Vector, position: float, work: Array) -> float:
    """Distance of a target from a point on a loop."""
    u, v = _place(corner, position)
    x, y, z = surface_point(data, u, v, work)
    return _distance(x, y, z, target)


@jit
def _least_on_piece(data: SurfaceData, loop: FaceLoop, piece: int, target: Vector, cutoff: float,
                    work: Array) -> tuple[float, float]:
    """Position of the nearest point of a piece of a loop, and its distance, by golden section as in `least_between`.

    It is given up where the piece surely is farther away than a cutoff: on the way from one end of a bracket to the
    other, no longer than its reach, the distance falls below the mean of both by half of that at most.
    """
    corner, low, high = loop.corner, loop.position[piece], loop.position[piece + 1]
    reach = loop.reach[piece] / (high - low)
    a, b = low, high
    fa, fb = _gap(data, corner, target, a, work), _gap(data, corner, target, b, work)
    best, value = (b, fb) if fb < fa else (a, fa)
    if 0.5 * (fa + fb - reach * (b - a)) > cutoff:
        return best, value
    c, d = b - GOLDEN * (b - a), a + GOLDEN * (b - a)
    fc, fd = _gap(data, corner, target, c, work), _gap(data, corner, target, d, work)
    for _ in range(_SECTIONS):
        if fc < fd:
            b, fb = d, fd
            d, fd = c, fc
            c = b - GOLDEN * (b - a)
            fc = _gap(data, corner, target, c, work)
        else:
            a, fa = c, fc
            c, fc = d, fd
            d = a + GOLDEN * (b - a)
            fd = _gap(data, corner, target, d, work)
        if 0.5 * (fa + fb - reach * (b - a)) > cutoff:
            return best, value
    if fc < value:
        best, value = c, fc
    if fd < value:
        best, value = d, fd
    return best, value


@jit
def nearest_along(data: SurfaceData, loop: FaceLoop, targets: Array, starts: Index, out: tuple[Array, Array],
                  enough: Array) -> None:
    """Nearest points of a loop where they are nearer than what is known: parameters into out[0] (n, 2), distances into
    out[1] (n,).

    It is looked for them on the pieces on both sides of those points along it that the rows of starts (n, j) name; what
    is farther than enough (n,) need not be found.
    """
    work = np.empty((6, 26))
    pieces = loop.reach.shape[0]
    for i in range(targets.shape[0]):
        target = targets[i, 0], targets[i, 1], targets[i, 2]
        for j in range(starts.shape[1]):
            for side in range(2):
                piece = (starts[i, j] - 1 + side) % pieces
                cutoff = min(out[1][i], enough[i]) + ROUNDING
                at, found = _least_on_piece(data, loop, piece, target, cutoff, work)
                if found < out[1][i]:
                    out[1][i] = found
                    out[0][i, 0], out[0][i, 1] = _place(loop.corner, at)
