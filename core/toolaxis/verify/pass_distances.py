"""How far apart neighbouring passes touch the faces they machine: from CL data and faces alone.

The contact of a cutter location is where the tip that stands on the face with that axis is the given one.  Between two
passes each place of the face is near to one of them: where it is farther than half the greatest distance, it is looked
for the pass on its other side.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

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
    asked = np.concatenate([one.point for one in faces])
    if not len(asked):
        return None
    spacing = max(one.spacing for one in faces)
    far = _FAR * (profile.flat_radius + profile.corner_radius)
    search = _PassSearch(cKDTree(touched), touched, cKDTree(asked), spacing, _TRIAL * most, far)
    stands = _Standing(faces, cl, profile, heights[0], may_stand)
    best: PassDistance | None = None
    for one in faces:
        near, number = search.passes.query(one.point)
        rows = np.flatnonzero(near > _NEAR * most / 2)
        away = one.point[rows] - touched[number[rows]]
        along = np.abs(dot(away, feeds[number[rows]]))
        rows = rows[along <= _ACROSS * near[rows]]  # elsewhere it lies before or behind the end of a pass
        point = one.point[rows]
        this_side = touched[number[rows]]
        feed = feeds[number[rows]]
        other = search.other_side(point, this_side)
        way = other - this_side
        across = way - dot(way, feed)[:, None] * feed
        gap = np.linalg.norm(across, axis=1)
        i = _find_worst(stands, point, other, gap)
        if i >= 0 and (best is None or gap[i] > best.distance):
            x, y, z = (float(value) for value in point[i])
            best = PassDistance(float(gap[i]), one.face.label, (x, y, z))
    return best


def _find_worst(stands: "_Standing", point: Array, other: Array, gap: Array) -> int:
    """Row of the largest gap on all of whose way to the other pass something is asked for and the tool may stand; below
    zero for none."""
    is_known = np.isfinite(gap)
    order = np.argsort(-np.where(is_known, gap, -np.inf), kind="stable")
    order = order[is_known[order]]
    share = (np.arange(_BETWEEN) + 0.5)[:, None, None] / _BETWEEN
    tried = 0
    while len(order):
        some = order[:_TOGETHER]
        order = order[_TOGETHER:]
        ways = point[some] + share * (other[some] - point[some])
        asked, tips = stands.find_feet(ways.transpose(1, 0, 2).reshape(-1, 3))
        whole = asked.reshape(len(some), _BETWEEN).all(axis=1)
        rows = some[whole]
        tips = tips.reshape(len(some), _BETWEEN, 3)[whole]
        while len(rows):
            row = rows[0]
            tried += 1
            if tried > _TRIED or stands.stands_at(tips[0]):
                return int(row)
            # Near a gap where the tool may not stand it is not asked again.
            far = np.linalg.norm(point[rows] - point[row], axis=1) > gap[row]
            still_far = np.linalg.norm(point[order] - point[row], axis=1) > gap[row]
            order = order[still_far]
            rows = rows[far]
            tips = tips[far]
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
        self._faces = faces
        self._cl = cl
        self._profile = profile
        self._allowance = allowance
        self._may_stand = may_stand

    def find_feet(self, places: Array) -> tuple[Bools, Array]:
        """Whether places over or under faces have something asked for at their foot, (n,), and the tips of a tool that
        touches the face there, (n, 3) mm."""
        asked = np.zeros(len(places), dtype=bool)
        tips = places.copy()
        axes = self._axes_at(places)
        for one in self._faces:
            foot = nearest(one.face, places)
            normal = one.face.normal(foot.uv)
            way = places - foot.point
            across = way - dot(way, normal)[:, None] * normal
            aside = np.linalg.norm(across, axis=1)
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
        _, number = cKDTree(tips[cut]).query(places)
        return np.asarray(axes[cut[number]])


class _PassSearch(NamedTuple):
    """Where passes are looked for: trees of contacts along passes and of places on faces, (k, 3) mm, with the distance
    of neighbouring places; and in what steps it is looked, and how far, mm."""

    passes: Any
    touched: Array
    on_face: Any
    spacing: float
    step: float
    far: float

    def other_side(self, point: Array, near: Array) -> Array:
        """A contact of the pass on the side of each point away from its nearest one, (n, 3) mm; nan where the face
        ends before there is one."""
        found = np.full((len(point), 3), np.nan)
        way = point - near
        size = np.linalg.norm(way, axis=1)
        away = way / np.maximum(size, 1e-12)[:, None]
        left = np.arange(len(point))
        length = self.step
        while len(left) and length <= self.far:
            tried = point[left] + length * away[left]
            off, number = self.passes.query(tried)
            contact = self.touched[number]
            way = contact - point[left]
            along = dot(way, away[left])
            is_ahead = along > 0.5 * np.linalg.norm(way, axis=1)
            there = (off <= max(_OFF * length, self.step)) & is_ahead
            found[left[there]] = contact[there]
            off_face, _ = self.on_face.query(tried)
            gone = off_face > 1.5 * self.spacing + _OFF * length
            left = left[~there & ~gone]
            length += self.step
        return found


def _contact_lines(cl: tuple[Array, Array, NDArray[np.int8]], profile: Profile, faces: Sequence[Face],
                   heights: tuple[float, float], dense: float) -> tuple[Array, Array]:
    """Places along the lines that the cutter touches on faces and where these go on beyond their borders, (k, 3) mm,
    and unit directions of these lines there, (k, 3)."""
    tips, axes, kind = cl
    allowance, farthest_off = heights
    used = np.zeros(len(tips), dtype=bool)
    end = np.flatnonzero(kind[1:] == Motion.CUT) + 1
    used[end] = True
    used[end - 1] = True
    rows = np.flatnonzero(used)
    point = np.full((len(tips), 3), np.nan)
    least = np.full(len(tips), np.inf)
    for face in faces:
        uv, off = find_contacts(face, profile, (tips[rows], axes[rows]), allowance)
        off = np.where(off <= farthest_off, off, np.inf)
        off = np.where(face.contains(uv), off, off + farthest_off)  # on the face itself before what continues another
        better = off < least[rows]
        point[rows[better]] = face.evaluate(uv[better]).point
        least[rows[better]] = off[better]
    good = np.isfinite(least)
    end = end[good[end] & good[end - 1]]
    before = point[end - 1]
    steps = point[end] - before
    way = np.linalg.norm(steps, axis=1)
    parts = np.maximum(np.ceil(way / dense), 1).astype(np.int64)
    owner, number = number_parts(parts)
    share = ((number + 1) / parts[owner])[:, None]
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
    cutter = profile.flat_radius + profile.corner_radius
    reach = 2 * cutter + face.diagonal / _SAMPLES
    off = np.full(len(tips), np.inf)
    left = np.flatnonzero(near <= reach)
    uv[left], off[left] = _descend(face, profile, tips[left], axes[left], uv[left], allowance)
    for shift in (1, -1) * _AGAIN:  # axes that move stand elsewhere otherwise than the mean one: from the next contact
        is_poor = off > _SOLVED
        poor = np.flatnonzero(is_poor & (np.roll(off, shift) <= _SOLVED))
        if not len(poor):
            continue
        start = np.roll(uv, shift, axis=0)[poor]
        again, size = _descend(face, profile, tips[poor], axes[poor], start, allowance)
        better = size < off[poor]
        improved = poor[better]
        uv[improved] = again[better]
        off[improved] = size[better]
    return uv, off


def _descend(face: Face, profile: Profile, tips: Array, axes: Array, start: Array,
             allowance: float) -> tuple[Array, Array]:
    """Contacts from parameters to start with, and how far off their tips are, mm: steps of Gauss and Newton, damped
    where they do not bring a tip nearer."""
    u0, u1, v0, v1 = face.bounds
    span = np.array([u1 - u0, v1 - v0])
    uv = start.copy()
    damping = np.full(len(uv), 1e-8)
    gap = _tips_at(face, profile, uv, axes, allowance) - tips
    off = np.linalg.norm(gap, axis=1)
    left = np.arange(len(uv))
    for _ in range(_ROUNDS):
        left = left[(off[left] > 1e-8) & (damping[left] < 1e8)]
        if not len(left):
            break
        here = uv[left]
        slopes = []
        for side in np.eye(2):
            beside = _tips_at(face, profile, here + _STEP * span * side, axes[left], allowance)
            slopes.append((beside - tips[left] - gap[left]) / _STEP)
        step = _damped_step(slopes[0], slopes[1], gap[left], damping[left])
        trial = here + span * np.clip(step, -_LONGEST, _LONGEST)
        found = _tips_at(face, profile, trial, axes[left], allowance) - tips[left]
        size = np.linalg.norm(found, axis=1)
        better = size < off[left]
        taken = left[better]
        uv[taken] = trial[better]
        gap[taken] = found[better]
        off[taken] = size[better]
        more = np.maximum(10 * damping[left], 1e-5)
        damping[left] = np.where(better, 0.1 * damping[left], more)
    return uv, off


def _damped_step(slope_u: Array, slope_v: Array, gap: Array, damping: Array) -> Array:
    """The step of Levenberg and Marquardt that closes gaps (n, 3), (n, 2)."""
    a = dot(slope_u, slope_u)
    b = dot(slope_u, slope_v)
    c = dot(slope_v, slope_v)
    p = dot(slope_u, gap)
    q = dot(slope_v, gap)
    a = a * (1 + damping) + 1e-30
    c = c * (1 + damping) + 1e-30
    area = np.maximum(a * c - b * b, 1e-14 * a * c)
    step = np.stack([b * q - c * p, b * p - a * q], axis=1)
    return np.asarray(step / area[:, None])


def _tips_at(face: Face, profile: Profile, uv: Array, axes: Array, allowance: float) -> Array:
    """Tips of a cutter that touches a face at parameters, (n, 3) mm."""
    normal = face.normal(uv)
    radius = profile.corner_radius
    touched = face.evaluate(uv).point
    point = touched + (radius + allowance) * normal - radius * axes
    if profile.flat_radius == 0:
        return np.asarray(point)
    across = normal - dot(normal, axes)[:, None] * axes
    size = np.linalg.norm(across, axis=1)[:, None]
    return np.asarray(point + profile.flat_radius * across / np.maximum(size, 1e-9))
