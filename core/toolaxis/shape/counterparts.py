"""Faces that a turn brings onto each other, matched through points: parameters, seam and sense may differ."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.clipping import clip_half_plane, outer_with_holes
from toolaxis.numeric.polygons import signed_area
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest

Array = NDArray[np.float64]

#: Passes on a face serve another one as they are where the moved face is so close to it, mm.
SAME = 1e-4
#: Greatest distance between a turned face and its counterpart, as a share of the face's diagonal.
NEAR = 0.02
#: The same for each side of the box around samples of the turned face.
_CLOSE = 0.1
#: Two charts agree where points of equal parameters are this much closer than that, as a share of the diagonal.
_AGREE = 1e-5
#: Bounds of a piece and of its face closer than this share of the range are one.
_AT_END = 1e-9
_GRID, _DENSE = 5, 16


class ParameterRule(NamedTuple):
    """Parameters of a counterpart from those of a face: uv' = uv @ linear + offset."""

    linear: Array
    offset: Array

    def __call__(self, uv: Array) -> Array:
        """Parameters on the counterpart, (n, 2)."""
        return np.asarray(uv @ self.linear + self.offset)

    @property
    def swapped(self) -> bool:
        """Whether u runs along the other's v."""
        return bool(abs(self.linear[0, 1]) > abs(self.linear[0, 0]))


class Counterpart(NamedTuple):
    """A face of another blade, and how its parameters follow; chart is None where they do by no straight rule."""

    face: Face
    chart: ParameterRule | None
    away: float


def apply_motion(matrix: Array, points: Array) -> Array:
    """Points under a rigid motion.

    Parameters
    ----------
    matrix : (4, 4) array
    points : (n, 3) array
    """
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])


def turn_about(point: Array, axis: Array, angle: float) -> Array:
    """The right-handed turn about a line, (4, 4).

    Parameters
    ----------
    point, axis : (3,) array
        A point of the line, mm, and its unit direction.
    angle : float
        rad
    """
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    found = np.eye(4)
    found[:3, :3] = turn
    found[:3, 3] = point - turn @ point
    return found


def counterpart(face: Face, matrix: Array, others: Sequence[Face]) -> Counterpart | None:
    """The face that a motion brings a face onto.

    Parameters
    ----------
    face : Face
    matrix : (4, 4) array
        Rigid motion.
    others : sequence of Face
        To choose from.

    Returns
    -------
    Counterpart, the nearest of those within `NEAR` of the moved face; None where there is none.

    Notes
    -----
    **Properties**: 1. reparametrising the other face (u and v exchanged, reversed, rescaled) changes the chart only;
    2. a face is its own counterpart under the identity.
    """
    uv = places_of(face, _GRID)
    points = apply_motion(matrix, face.evaluate(uv).point)
    corners = np.array([points.min(axis=0), points.max(axis=0)])
    room = _CLOSE * face.diagonal
    close = [other for other in others if np.abs(other.box - corners).max() <= room]
    for match in (_counterpart_by_parameters, _counterpart_by_nearest_points):
        tried = [match(face, uv, points, other) for other in close]
        found = [one for one in tried if one is not None]
        if found:
            return min(found, key=lambda one: one.away)
    return None


def places_of(face: Face, count: int) -> Array:
    """Parameters inside a face and on its border, (n, 2).

    Parameters
    ----------
    face : Face
    count : int
        Places each way; about four times as many lie on the border.
    """
    border = np.concatenate(face.outline)
    stride = max(1, len(border) // (4 * count))
    return np.concatenate([face.grid(count, count), border[::stride]])


def _counterpart_by_parameters(face: Face, uv: Array, points: Array, other: Face) -> Counterpart | None:
    """Another face as the counterpart, where one of the eight ways to lay their parameters onto each other fits."""
    charts = eight_rules(face.surface.domain, other.surface.domain)
    away = [_greatest_distance(other, chart(uv), points) for chart in charts]
    k = int(np.argmin(away))
    if away[k] > NEAR * face.diagonal:
        return None
    inner = face.grid(_GRID, _GRID)
    on_other = other.contains(charts[k](inner))
    if on_other.sum() < 0.9 * len(inner):
        return None
    return Counterpart(other, charts[k], away[k])


def _greatest_distance(face: Face, uv: Array, points: Array) -> float:
    """How far places of a face lie from points at most, mm."""
    gap = face.evaluate(uv).point - points
    return float(np.linalg.norm(gap, axis=1).max())


def _counterpart_by_nearest_points(face: Face, uv: Array, points: Array, other: Face) -> Counterpart | None:
    """Another face as the counterpart by its nearest points, with the straight rule of parameters that fits them."""
    found = nearest(other, points, 24)
    distance = float(found.distance.max())
    if distance > NEAR * face.diagonal:
        return None
    table = np.column_stack([uv, np.ones(len(uv))])
    solution, *_ = np.linalg.lstsq(table, found.uv, rcond=None)
    fit: Array = np.asarray(solution, dtype=float)
    chart = ParameterRule(fit[:2], fit[2])
    away = _greatest_distance(other, chart(uv), points)
    is_straight = away <= distance + _AGREE * face.diagonal
    return Counterpart(other, chart if is_straight else None, distance)


def eight_rules(here: tuple[tuple[float, float], ...], there: tuple[tuple[float, float], ...]) -> list[ParameterRule]:
    """The eight ways to lay one rectangle of parameters onto another.

    Parameters
    ----------
    here, there : pair of (float, float)
        Ranges of u and v.
    """
    found = []
    for swap in (False, True):
        for senses in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
            linear = np.zeros((2, 2))
            offset = np.zeros(2)
            for i, (low, high) in enumerate(here):
                j = 1 - i if swap else i
                start, stop = there[j]
                if senses[i] < 0:
                    start, stop = stop, start
                rate = (stop - start) / (high - low)
                linear[i, j] = rate
                offset[j] = start - low * rate
            found.append(ParameterRule(linear, offset))
    return found


def best_motion(matrix: Array, pairs: Sequence[tuple[Face, Counterpart]]) -> Array:
    """The rigid motion that brings points of faces closest to those of their counterparts, (4, 4).

    Parameters
    ----------
    matrix : (4, 4) array
        Nearly that motion; the answer where no counterpart has a chart.
    pairs : sequence of (Face, Counterpart)
    """
    here = []
    there = []
    for face, other in pairs:
        if other.chart is not None:
            uv = face.grid(_GRID, _GRID)
            here.append(face.evaluate(uv).point)
            there.append(other.face.evaluate(other.chart(uv)).point)
    if sum(map(len, here)) < 3:
        return matrix
    return fit_motion(np.concatenate(here), np.concatenate(there))


def fit_motion(here: Array, there: Array, mirrored: bool = False) -> Array:
    """The rigid motion that brings points closest to others, (4, 4).

    Parameters
    ----------
    here, there : (n, 3) array
        mm
    mirrored : bool
        Whether it is one with a mirror.
    """
    own = here.mean(axis=0)
    others = there.mean(axis=0)
    u, _, vt = np.linalg.svd((here - own).T @ (there - others))
    side = np.sign(np.linalg.det(vt.T @ u.T))
    if mirrored:
        side = -side
    turn = (vt.T * [1, 1, side]) @ u.T
    found = np.eye(4)
    found[:3, :3] = turn
    found[:3, 3] = others - turn @ own
    return found


def off(face: Face, other: Counterpart, matrix: Array) -> float:
    """How far the surface of a counterpart lies from the moved face at most, along its normal, mm.

    Parameters
    ----------
    face : Face
    other : Counterpart
        With a chart.
    matrix : (4, 4) array
    """
    assert other.chart is not None
    uv = places_of(face, _DENSE)
    there = other.chart(uv)
    moved = apply_motion(matrix, face.evaluate(uv).point)
    gap = other.face.evaluate(there).point - moved
    along_normal = (gap * other.face.normal(there)).sum(axis=1)
    return float(np.abs(along_normal).max())


def turn_piece(piece: Face, whole: Face, other: Counterpart, matrix: Array, label: str) -> tuple[Face, float]:
    """The piece of a counterpart that a motion brings a piece of a face onto, and how far the two are apart, mm.

    Parameters
    ----------
    piece, whole : Face
        A piece of a face, and the face.
    other : Counterpart
        Of the whole face.
    matrix : (4, 4) array
    label : str

    Notes
    -----
    A piece between iso-parametric lines is cut from the counterpart along its lines, so that pieces add up to it
    whatever its loops are made of; any other piece takes its loops along.
    """
    target = other.face
    uv = places_of(piece, _DENSE)
    moved = apply_motion(matrix, piece.evaluate(uv).point)
    if other.chart is None:
        made = target.trimmed(_carry_loops(piece, target, matrix), label)
        return made, float(nearest(target, moved).distance.max())
    found = target
    if piece is not whole:
        found = target.trimmed(_loops(piece, whole, target, other.chart), label)
    distance = _greatest_distance(target, other.chart(uv), moved)
    return found.trimmed(found.trims, label), distance


def _carry_loops(piece: Face, target: Face, matrix: Array) -> tuple[Array, ...]:
    """Loops of a piece, carried by a motion onto another face."""
    loops = []
    for loop in piece.outline:
        points = piece.evaluate(refine_loop(loop)).point
        moved = apply_motion(matrix, points)
        loops.append(nearest(target, moved).uv)
    return tuple(loops)


def refine_loop(loop: Array) -> Array:
    """A loop with more places along its sides where it has few corners: at least 33.

    Parameters
    ----------
    loop : (m, 2) array
    """
    parts = max(1, 64 // len(loop))
    share = np.linspace(0, 1, parts, endpoint=False)[:, None, None]
    following = np.roll(loop, -1, axis=0)
    places = loop + share * (following - loop)
    return np.asarray(places.swapaxes(0, 1).reshape(-1, 2))


def _loops(piece: Face, whole: Face, target: Face, chart: ParameterRule) -> tuple[Array, ...]:
    """Loops of the counterpart of a piece."""
    source: tuple[Array, ...] = whole.outline
    loops: tuple[Array, ...] = target.outline
    for i, value, above in _cuts(piece, whole):
        source = clip_half_plane(source, i, value, above)
        j = 1 - i if chart.swapped else i
        there = chart(np.full((1, 2), value))
        is_growing = chart.linear[i, j] > 0
        loops = clip_half_plane(loops, j, float(there[0, j]), above == is_growing)
    pieces = outer_with_holes(loops)
    if len(pieces) == len(outer_with_holes(source)) == 1:
        ratio = _area(source) / _area(piece.outline)
        if abs(ratio - 1) < 1e-4:
            return pieces[0]
    return tuple(chart(loop) for loop in piece.outline)


def _cuts(piece: Face, whole: Face) -> list[tuple[int, float, bool]]:
    """Iso-parametric lines that a piece was cut along: parameter, its value, and whether the piece lies above it."""
    bounds = np.reshape(piece.bounds, (2, 2))
    ends = np.reshape(whole.bounds, (2, 2))
    corners = np.concatenate(piece.outline)
    found = []
    for i in range(2):
        near = _AT_END * np.ptp(ends[i])
        for side in range(2):
            value = bounds[i, side]
            on = np.abs(corners[:, i] - value) <= near
            is_inside = abs(value - ends[i, side]) > near
            if is_inside and on.sum() > 1:
                found.append((i, float(value), side == 0))
    return found


def _area(loops: Sequence[Array]) -> float:
    """Area inside an outer loop, which comes first, and outside its holes."""
    sizes = [abs(float(signed_area(loop))) for loop in loops]
    return 2 * sizes[0] - sum(sizes)
