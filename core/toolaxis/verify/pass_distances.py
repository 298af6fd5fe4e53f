"""How far apart neighbouring passes touch the faces they machine: from CL data and faces alone.

The contact of a cutter location is where the tip that stands on the face with that axis is the given one.  Between two
passes each place of the face is near to one of them: where it is farther than half the greatest distance, it is looked
for the pass on its other side.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.numeric.vectors import dot, unit
from toolaxis.shape.face import Face
from toolaxis.tools.profile import Profile

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: A measured distance beyond this multiple of the greatest one fails.
FACTOR = 1.02
#: Samples each way from which contacts are looked for, rounds of Gauss and Newton, and the step of its differences and
#: the longest step as shares of the range of a parameter.
_SAMPLES, _ROUNDS, _STEP, _LONGEST = 48, 25, 1e-6, 0.15
#: A tip that is farther off than this, mm, is looked for again from the contact before or behind it, so many times.
_SOLVED, _AGAIN = 1e-3, 6
#: Contacts along a pass lie no farther apart than this share of the greatest distance; so does what is tried for the
#: pass on the other side.
_DENSE = 0.125
#: Places nearer to a pass than this share of half the greatest distance are not looked at.
_NEAR = 0.9
#: The other pass is looked for this many radii of the cutter away; how far it may lie off the straight way, as a share
#: of it, and how far the next ray on the face.
_FAR, _OFF = 2.0, 0.4


class PassDistance(NamedTuple):
    """The greatest distance of two neighbouring passes.

    distance : float, mm;  face : label;  point : a place between them, mm.
    """

    distance: float
    face: str
    point: tuple[float, float, float]


class MeasuredFace(NamedTuple):
    """A face that is machined: face : Face;  point : (m, 3) array, mm, places on it at which passes are asked for;
    spacing : float, mm, distance of neighbouring places."""

    face: Face
    point: Array
    spacing: float


def greatest_distance(cl: tuple[Array, Array, NDArray[np.int8]], profile: Profile, faces: Sequence[MeasuredFace],
                      heights: tuple[float, float], most: float) -> PassDistance | None:
    """The greatest distance of neighbouring passes on faces, where it comes near to what is allowed.

    Parameters
    ----------
    cl : tips (n, 3), axes (n, 3), kind (n,)
        Cutter locations, mm, and unit axes.
    profile : Profile
    faces : sequence of MeasuredFace
    heights : (float, float)
        Stock that is left on the faces, and how far off a tip may stand from where it touches, mm.
    most : float
        Greatest distance that is allowed, mm.

    Returns
    -------
    PassDistance, or None where passes lie nowhere between two others as far apart as nine tenths of that.

    Notes
    -----
    Beside walls and borders, where there is a pass on one side only, nothing is measured.

    **Properties**: 1. on a plane it is the distance of straight parallel passes to 1 %.
    """
    from scipy.spatial import cKDTree

    touched = np.concatenate([_contact_lines(cl, profile, one.face, heights, _DENSE * most) for one in faces]
                             or [np.empty((0, 3))])
    if not len(touched):
        return None
    passes = cKDTree(touched)
    asked = np.concatenate([one.point for one in faces])
    if not len(asked):
        return None
    on_face, spacing = cKDTree(asked), max(one.spacing for one in faces)
    best: PassDistance | None = None
    for one in faces:
        near, number = passes.query(one.point)
        rows = np.flatnonzero(near > _NEAR * most / 2)
        other = _other_side(one.point[rows], touched[number[rows]], (passes, touched), (on_face, spacing),
                            (_DENSE * most, _FAR * (profile.flat_radius + profile.corner_radius)))
        gap = near[rows] + other
        if len(rows) and np.isfinite(gap).any():
            i = int(np.argmax(np.where(np.isfinite(gap), gap, -np.inf)))
            if best is None or gap[i] > best.distance:
                x, y, z = (float(value) for value in one.point[rows[i]])
                best = PassDistance(float(gap[i]), one.face.label, (x, y, z))
    return best


def _other_side(point: Array, near: Array, passes: tuple[object, Array], face: tuple[object, float],
                lengths: tuple[float, float]) -> Array:
    """Distance of the pass on the side of each point away from its nearest one, (n,) mm; inf where the face ends before
    there is one."""
    (tree, touched), (on_face, spacing), (step, far) = passes, face, lengths
    found = np.full(len(point), np.inf)
    size = np.linalg.norm(point - near, axis=1)
    away = (point - near) / np.maximum(size, 1e-12)[:, None]
    left, length = np.arange(len(point)), step
    while len(left) and length <= far:
        tried = point[left] + length * away[left]
        off, number = tree.query(tried)  # type: ignore[attr-defined]
        way = touched[number] - point[left]
        along = dot(way, away[left])
        there = (off <= max(_OFF * length, step)) & (along > 0.5 * np.linalg.norm(way, axis=1))
        found[left[there]] = np.linalg.norm(way[there], axis=1)
        gone = on_face.query(tried)[0] > 1.5 * spacing + _OFF * length  # type: ignore[attr-defined]
        left = left[~there & ~gone]
        length += step
    return found


def _contact_lines(cl: tuple[Array, Array, NDArray[np.int8]], profile: Profile, face: Face,
                   heights: tuple[float, float], dense: float) -> Array:
    """Places along the lines that the cutter touches on a face and where that goes on beyond its border, (k, 3) mm."""
    tips, axes, kind = cl
    used = np.zeros(len(tips), dtype=bool)
    end = np.flatnonzero(kind[1:] == Motion.CUT) + 1
    used[end], used[end - 1] = True, True
    rows = np.flatnonzero(used)
    uv, off = find_contacts(face, profile, (tips[rows], axes[rows]), heights[0])
    point, good = np.full((len(tips), 3), np.nan), np.zeros(len(tips), dtype=bool)
    point[rows], good[rows] = face.evaluate(uv).point, off <= heights[1]
    end = end[good[end] & good[end - 1]]
    way = np.linalg.norm(point[end] - point[end - 1], axis=1)
    parts = np.maximum(np.ceil(way / dense), 1).astype(np.int64)
    owner = np.repeat(np.arange(len(end)), parts)
    share = (np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts) + 1) / parts[owner]
    before, after = point[end[owner] - 1], point[end[owner]]
    return np.concatenate([point[end - 1], before + share[:, None] * (after - before)])


def find_contacts(face: Face, profile: Profile, standing: tuple[Array, Array], allowance: float) -> tuple[Array, Array]:
    """Parameters of the contacts of tips with axes, (n, 2), and how far off the tips are that stand there, (n,) mm.

    Parameters
    ----------
    face : Face
        Where contacts lie beyond it, its surface is continued.
    profile : Profile
    standing : (n, 3) array, (n, 3) array
        Tips, mm, and unit axes, in the order in which they are visited.
    allowance : float
        Stock left on the face, mm.
    """
    from scipy.spatial import cKDTree

    tips, axes = standing
    grid = np.concatenate([face.grid(_SAMPLES, _SAMPLES), *face.outline])
    mean = unit(axes.mean(axis=0)[None])[0]
    tree = cKDTree(_tips_at(face, profile, grid, mean, allowance))
    near, number = tree.query(tips)
    uv = grid[number].astype(float)
    reach = 2 * (profile.flat_radius + profile.corner_radius) + face.diagonal / _SAMPLES
    off = np.full(len(tips), np.inf)
    left = np.flatnonzero(near <= reach)
    uv[left], off[left] = _descend(face, profile, (tips[left], axes[left]), (uv[left], allowance))
    for shift in (1, -1) * _AGAIN:  # axes that move stand elsewhere otherwise than the mean one: from the next contact
        poor = np.flatnonzero((off > _SOLVED) & (np.roll(off, shift) <= _SOLVED))
        if not len(poor):
            continue
        start = np.roll(uv, shift, axis=0)[poor]
        again, size = _descend(face, profile, (tips[poor], axes[poor]), (start, allowance))
        better = size < off[poor]
        uv[poor[better]], off[poor[better]] = again[better], size[better]
    return uv, off


def _descend(face: Face, profile: Profile, standing: tuple[Array, Array], start: tuple[Array, float]) -> tuple[Array,
                                                                                                              Array]:
    """Contacts from parameters to start with, and how far off their tips are, mm: steps of Gauss and Newton, damped
    where they do not bring a tip nearer."""
    (tips, axes), (uv, allowance) = standing, start
    u0, u1, v0, v1 = face.bounds
    span = np.array([u1 - u0, v1 - v0])
    uv, damping = uv.copy(), np.full(len(uv), 1e-8)
    gap = _tips_at(face, profile, uv, axes, allowance) - tips
    off = np.linalg.norm(gap, axis=1)
    left = np.arange(len(uv))
    for _ in range(_ROUNDS):
        left = left[(off[left] > 1e-8) & (damping[left] < 1e8)]
        if not len(left):
            break
        slopes = [(_tips_at(face, profile, uv[left] + _STEP * span * side, axes[left], allowance) - tips[left]
                   - gap[left]) / _STEP for side in np.eye(2)]
        a, b, c = (dot(slopes[i], slopes[k]) for i, k in ((0, 0), (0, 1), (1, 1)))
        p, q = dot(slopes[0], gap[left]), dot(slopes[1], gap[left])
        a, c = a * (1 + damping[left]) + 1e-30, c * (1 + damping[left]) + 1e-30
        area = np.maximum(a * c - b * b, 1e-14 * a * c)
        step = np.stack([b * q - c * p, b * p - a * q], axis=1) / area[:, None]
        trial = uv[left] + span * np.clip(step, -_LONGEST, _LONGEST)
        found = _tips_at(face, profile, trial, axes[left], allowance) - tips[left]
        size = np.linalg.norm(found, axis=1)
        better = size < off[left]
        taken = left[better]
        uv[taken], gap[taken], off[taken] = trial[better], found[better], size[better]
        damping[left] = np.where(better, 0.1 * damping[left], np.maximum(10 * damping[left], 1e-5))
    return uv, off


def _tips_at(face: Face, profile: Profile, uv: Array, axes: Array, allowance: float) -> Array:
    """Tips of a cutter that touches a face at parameters, (n, 3) mm."""
    normal, radius = face.normal(uv), profile.corner_radius
    point = face.evaluate(uv).point + (radius + allowance) * normal - radius * axes
    if profile.flat_radius == 0:
        return np.asarray(point)
    across = normal - dot(normal, axes)[:, None] * axes
    size = np.linalg.norm(across, axis=1)[:, None]
    return np.asarray(point + profile.flat_radius * across / np.maximum(size, 1e-9))
