"""How far apart neighbouring passes touch the faces they machine: from CL data and faces alone.

The contact of a cutter location is where the tip that stands on the face with that axis is the given one.  Between two
passes each place of the face is near to one of them: where it is farther than half the greatest distance, it is looked
for the pass on its other side.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.vectors import dot, unit
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
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
#: Contacts along a pass lie no farther apart than the first share of the greatest distance, what is tried for the pass
#: on the other side than the second.
_DENSE, _TRIAL = 0.06, 0.125
#: Places nearer to a pass than this share of half the greatest distance are not looked at.
_NEAR = 0.9
#: The other pass is looked for this many radii of the cutter away; how far it may lie off the straight way, as a share
#: of it, and how far the next ray on the face.
_FAR, _OFF = 2.0, 0.4
#: A place lies beside a pass where its way from the nearest contact goes along the pass by no more than this share.
_ACROSS = 0.35
#: Places on the way to it at which the face has to be there, gaps that are looked at together, and how far aside of the
#: foot of its normal a place may lie, mm.
_BETWEEN, _TOGETHER, _ASIDE = 12, 400, 0.02
#: Gaps for which it is asked whether the tool may stand there; those near one where it may not are not asked again.
_TRIED = 60


class PassDistance(NamedTuple):
    """The greatest distance of two neighbouring passes.

    distance : float, mm;  face : label;  point : a place between them, mm.
    """

    distance: float
    face: str
    point: tuple[float, float, float]


class MeasuredFace(NamedTuple):
    """A face that is machined.

    face : Face;  point : (m, 3) array, mm, places on it at which passes are asked for;  spacing : float, mm, distance
    of neighbouring places;  left : callable, takes parameters (n, 2) and places (n, 3) on the face and answers where
    nothing is asked for, (n,) bool.
    """

    face: Face
    point: Array
    spacing: float
    left: Callable[[Array, Array], Bools]


def greatest_distance(cl: tuple[Array, Array, NDArray[np.int8]], profile: Profile, faces: Sequence[MeasuredFace],
                      heights: tuple[float, float], most: float,
                      may_stand: Callable[[Array, Array], bool] | None = None) -> PassDistance | None:
    """The greatest distance of neighbouring passes on faces, across the one, where it comes near to what is allowed.

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
    may_stand : callable, optional
        Takes tips (n, 3), mm, and axes (n, 3) on the way from a pass to the next, and answers whether the tool could
        cut there: where it could not, no pass is missed.

    Returns
    -------
    PassDistance, or None where passes lie nowhere between two others as far apart as nine tenths of that.

    Notes
    -----
    Beside walls and borders, where there is a pass on one side only, nothing is measured.

    **Properties**: 1. on a plane it is the distance of straight parallel passes to 1 %.
    """
    from scipy.spatial import cKDTree

    touched, feeds = _contact_lines(cl, profile, [one.face for one in faces], heights, _DENSE * most)
    if not len(touched):
        return None
    passes = cKDTree(touched)
    asked = np.concatenate([one.point for one in faces])
    if not len(asked):
        return None
    on_face, spacing = cKDTree(asked), max(one.spacing for one in faces)
    stands = _Standing(faces, cl, profile, heights[0], may_stand)
    best: PassDistance | None = None
    for one in faces:
        near, number = passes.query(one.point)
        rows = np.flatnonzero(near > _NEAR * most / 2)
        along = np.abs(dot(one.point[rows] - touched[number[rows]], feeds[number[rows]]))
        rows = rows[along <= _ACROSS * near[rows]]  # elsewhere it lies before or behind the end of a pass
        other = _other_side(one.point[rows], touched[number[rows]], (passes, touched), (on_face, spacing),
                            (_TRIAL * most, _FAR * (profile.flat_radius + profile.corner_radius)))
        way, feed = other - touched[number[rows]], feeds[number[rows]]
        gap = np.linalg.norm(way - dot(way, feed)[:, None] * feed, axis=1)
        i = _find_worst(stands, one.point[rows], other, gap)
        if i >= 0 and (best is None or gap[i] > best.distance):
            x, y, z = (float(value) for value in one.point[rows[i]])
            best = PassDistance(float(gap[i]), one.face.label, (x, y, z))
    return best


def _find_worst(stands: "_Standing", point: Array, other: Array, gap: Array) -> int:
    """Row of the largest gap on all of whose way to the other pass something is asked for and the tool may stand; below
    zero for none."""
    order = np.argsort(-np.where(np.isfinite(gap), gap, -np.inf), kind="stable")
    order = order[np.isfinite(gap[order])]
    tried = 0
    while len(order):
        some, order = order[:_TOGETHER], order[_TOGETHER:]
        share = (np.arange(_BETWEEN) + 0.5)[:, None, None] / _BETWEEN
        ways = (point[some] + share * (other[some] - point[some])).transpose(1, 0, 2)
        asked, tips = stands.find_feet(ways.reshape(-1, 3))
        whole = asked.reshape(len(some), _BETWEEN).all(axis=1)
        rows, tips = some[whole], tips.reshape(len(some), _BETWEEN, 3)[whole]
        while len(rows):
            tried += 1
            if tried > _TRIED or stands.stands_at(tips[0]):
                return int(rows[0])
            far = np.linalg.norm(point[rows] - point[rows[0]], axis=1) > gap[rows[0]]
            order = order[np.linalg.norm(point[order] - point[rows[0]], axis=1) > gap[rows[0]]]
            rows, tips = rows[far], tips[far]
    return -1


class _Standing:
    """Where something is asked for, and where a tool may stand.

    Parameters
    ----------
    faces : sequence of MeasuredFace
    cl : tips (n, 3), axes (n, 3), kind (n,)
    profile : Profile
    allowance : float
        mm
    may_stand : callable, optional
        As for `greatest_distance`.
    """

    def __init__(self, faces: Sequence[MeasuredFace], cl: tuple[Array, Array, NDArray[np.int8]], profile: Profile,
                 allowance: float, may_stand: Callable[[Array, Array], bool] | None) -> None:
        self._faces, self._cl, self._profile, self._allowance = faces, cl, profile, allowance
        self._may_stand = may_stand

    def find_feet(self, places: Array) -> tuple[Bools, Array]:
        """Whether places over or under faces have something asked for at their foot, (n,), and the tips of a tool that
        touches the face there, (n, 3) mm."""
        asked, tips = np.zeros(len(places), dtype=bool), places.copy()
        axes = self._axes_at(places)
        for one in self._faces:
            foot = nearest(one.face, places)
            normal = one.face.normal(foot.uv)
            way = places - foot.point
            aside = np.linalg.norm(way - dot(way, normal)[:, None] * normal, axis=1)
            here = (aside <= _ASIDE) & ~one.left(foot.uv, foot.point)
            asked |= here
            tips[here] = _tips_at(one.face, self._profile, foot.uv[here], axes[here], self._allowance)
        return asked, tips

    def stands_at(self, tips: Array) -> bool:
        """Whether the tool may stand at tips (n, 3), mm."""
        return self._may_stand is None or self._may_stand(tips, self._axes_at(tips))

    def _axes_at(self, places: Array) -> Array:
        """Axes of the nearest cutter locations, (n, 3)."""
        from scipy.spatial import cKDTree

        tips, axes, kind = self._cl
        cut = np.flatnonzero(kind == Motion.CUT)
        return np.asarray(axes[cut[cKDTree(tips[cut]).query(places)[1]]])


def _other_side(point: Array, near: Array, passes: tuple[object, Array], face: tuple[object, float],
                lengths: tuple[float, float]) -> Array:
    """A contact of the pass on the side of each point away from its nearest one, (n, 3) mm; nan where the face ends
    before there is one."""
    (tree, touched), (on_face, spacing), (step, far) = passes, face, lengths
    found = np.full((len(point), 3), np.nan)
    size = np.linalg.norm(point - near, axis=1)
    away = (point - near) / np.maximum(size, 1e-12)[:, None]
    left, length = np.arange(len(point)), step
    while len(left) and length <= far:
        tried = point[left] + length * away[left]
        off, number = tree.query(tried)  # type: ignore[attr-defined]
        way = touched[number] - point[left]
        along = dot(way, away[left])
        there = (off <= max(_OFF * length, step)) & (along > 0.5 * np.linalg.norm(way, axis=1))
        found[left[there]] = touched[number[there]]
        gone = on_face.query(tried)[0] > 1.5 * spacing + _OFF * length  # type: ignore[attr-defined]
        left = left[~there & ~gone]
        length += step
    return found


def _contact_lines(cl: tuple[Array, Array, NDArray[np.int8]], profile: Profile, faces: Sequence[Face],
                   heights: tuple[float, float], dense: float) -> tuple[Array, Array]:
    """Places along the lines that the cutter touches on faces and where these go on beyond their borders, (k, 3) mm,
    and unit directions of these lines there, (k, 3)."""
    tips, axes, kind = cl
    used = np.zeros(len(tips), dtype=bool)
    end = np.flatnonzero(kind[1:] == Motion.CUT) + 1
    used[end], used[end - 1] = True, True
    rows = np.flatnonzero(used)
    point, least = np.full((len(tips), 3), np.nan), np.full(len(tips), np.inf)
    for face in faces:
        uv, off = find_contacts(face, profile, (tips[rows], axes[rows]), heights[0])
        off = np.where(off <= heights[1], off, np.inf)
        off = np.where(face.contains(uv), off, off + heights[1])  # on the face itself before what continues another
        better = off < least[rows]
        point[rows[better]], least[rows[better]] = face.evaluate(uv[better]).point, off[better]
    good = np.isfinite(least)
    end = end[good[end] & good[end - 1]]
    way = np.linalg.norm(point[end] - point[end - 1], axis=1)
    parts = np.maximum(np.ceil(way / dense), 1).astype(np.int64)
    owner, number = number_parts(parts)
    share = ((number + 1) / parts[owner])[:, None]
    before = point[end - 1]
    steps = point[end] - before
    between = before[owner] + share * steps[owner]
    ways = steps / np.maximum(way, 1e-12)[:, None]
    return np.concatenate([before, between]), np.concatenate([ways, ways[owner]])


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
