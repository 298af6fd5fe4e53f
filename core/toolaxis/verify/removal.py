"""What the cutter leaves: height of the material above each point of a face, and depth of the cut below it."""

from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput
from toolaxis.numeric import compiled as _compiled
from toolaxis.numeric.compiled import compiled
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.tools.profile import Profile
from toolaxis.verify.blocks import balls, curve_order, in_chunks
from toolaxis.verify.motions import GROUP, Motions, grouped, motions_from_cl
from toolaxis.verify.removal_numpy import remove_numpy
from toolaxis.verify.solids import cutter_solid, meridian, reach_of
from toolaxis.verify.sweep import LOOK, first_entry, moment, sway

Array = NDArray[np.float64]
Counts: TypeAlias = NDArray[np.int64]
Pieces: TypeAlias = tuple[Array, Array, Array, Array]
Body: TypeAlias = tuple[Array, Pieces]
Found: TypeAlias = tuple[Array, Array, Counts, Counts]
Tables: TypeAlias = tuple[Array, Counts, Array, NDArray[np.bool_], Counts]

#: Bound of the rounding and root-finding errors of a height, mm.
NUMERICAL = 1e-6


@dataclass(frozen=True, eq=False)
class Remains:
    """What is left on each ray.

    Attributes
    ----------
    remaining : (m,) array
        Least height t >= 0 above the ray's foot that a cutting motion removed, mm; inf where none came within reach.
    gouge : (m,) array
        Greatest depth below the foot that any motion reached, mm; at most the ray's depth, 0 where none went below.
    cut_by, gouged_by : (m,) array of int
        Index of the cutter location at which the motion that did it arrives; -1 where none did.
    uncertainty : float
        Bound of the error of a height or a depth, measured along the cutter's normal, mm.
    """

    remaining: Array
    gouge: Array
    cut_by: Counts
    gouged_by: Counts
    uncertainty: float


@compiled
def _meet(body: Body, which: tuple[int, bool, int], ray: Array, out: Found, place: tuple[int, float]) -> None:
    """Let motion which[0] (cutting or not, arriving at which[2]) act on ray place[0], outside until t = place[1]."""
    solid, motion = body
    k, cutting, arrival = which
    i, start = place
    remaining, gouge, cut_by, gouged_by = out
    level = _level(ray, out, i, cutting)
    line = (ray[i, 0], ray[i, 1], ray[i, 2], ray[i, 3], ray[i, 4], ray[i, 5])
    entry = first_entry(solid, motion, k, line, (start, level))
    if -entry > gouge[i]:
        gouge[i] = -entry
        gouged_by[i] = arrival
    if cutting and remaining[i] > 0.0:
        if entry < 0.0:
            entry = first_entry(solid, motion, k, line, (0.0, level))
        if entry < remaining[i]:
            remaining[i] = entry
            cut_by[i] = arrival


@compiled
def _level(ray: Array, out: Found, i: int, cutting: bool) -> float:
    """Height below which a motion would change ray i."""
    if cutting and out[0][i] > 0.0:
        return float(min(out[0][i], ray[i, 7]))
    return float(-out[1][i])


@compiled
def _meet_group(body: Body, tables: Tables, ray: Array, out: Found, near: tuple[Counts, int, Array, int]) -> None:
    """Let the motions near[0][:near[1]] act on ray near[3]: the closest first, then those it does not rule out.

    One look at the middle of each motion, at height t, tells that the solid's function over the whole motion and ray
    is at least rest + along (t' - t); that rules most of them out, and bounds the root of the others from below.
    """
    solid, motion = body
    which, count, look, i = near
    cutting, arrival = tables[3], tables[4]
    line = (ray[i, 0], ray[i, 1], ray[i, 2], ray[i, 3], ray[i, 4], ray[i, 5])
    best, first = np.inf, -1
    for n in range(count):
        level = _level(ray, out, i, cutting[which[n]])
        value, slope, along = moment(solid, motion, (which[n], 0.5), line, level)
        look[n, 0], look[n, 1], look[n, 2] = value - 0.5 * abs(slope) - LOOK, along, level
        if value < best:
            best, first = value, n
    for turn in range(-1, count):
        n = first if turn < 0 else turn
        if turn == first:
            continue
        level = _level(ray, out, i, cutting[which[n]])
        change, along, start = sway(motion, which[n]), look[n, 1], -ray[i, 6]
        rest = look[n, 0] + along * (level - look[n, 2]) - change * (look[n, 2] - level)
        if rest > max(along + change, 0.0) * (level - start):
            continue
        if along < -change:
            start = max(start, level - rest / (along + change))
        _meet(body, (which[n], cutting[which[n]], arrival[which[n]]), ray, out, (i, start))


@compiled
def _bounds(solid: Array, groups: Array, ball: Array, reach: float, bound: Array) -> None:
    """Lower bound of the distance between a block of points and all motions of each group."""
    for g in range(groups.shape[0]):
        w0, w1, w2 = ball[0] - groups[g, 0], ball[1] - groups[g, 1], ball[2] - groups[g, 2]
        z = w0 * groups[g, 4] + w1 * groups[g, 5] + w2 * groups[g, 6]
        rho = np.sqrt(max(w0 * w0 + w1 * w1 + w2 * w2 - z * z, 0.0))
        value, _, _ = meridian(solid, rho, z)
        bound[g] = value - groups[g, 3] - groups[g, 7] * reach - ball[3]


@compiled
def _remove_block(body: Body, tables: Tables, ray: Array, out: Found, block: tuple[Array, int, int]) -> None:
    """Let all motions act on one block of rays, nearest groups first."""
    solid, motion = body
    ball, low, high = block
    groups, first, slack, _, _ = tables
    bound = np.empty(groups.shape[0])
    _bounds(solid, groups, ball, np.sqrt(solid[5] ** 2 + max(solid[0] + solid[1], solid[6]) ** 2), bound)
    centre = (ball[0], ball[1], ball[2], 0.0, 0.0, 0.0)
    which, look = np.empty(GROUP, dtype=np.int64), np.empty((GROUP, 3))
    for g in np.argsort(bound):
        lever = 0.0
        for i in range(low, high):
            lever = max(lever, ray[i, 6], min(out[0][i], ray[i, 7]))
        if bound[g] > lever:
            break
        count = 0
        for k in range(first[g], first[g + 1]):
            value, _, _ = moment(solid, motion, (k, 0.5), centre, 0.0)
            if value - slack[k] <= ball[3] + lever:
                which[count] = k
                count += 1
        if count:
            for i in range(low, high):
                _meet_group(body, tables, ray, out, (which, count, look, i))


@compiled
def _remove(body: Body, tables: Tables, rays: tuple[Array, Array, Counts], out: Found, part: tuple[int, int]) -> None:
    ray, ball, first = rays
    for b in range(part[0], part[1]):
        _remove_block(body, tables, ray, out, (ball[b], first[b], first[b + 1]))


def _checked_rays(points: ArrayLike, normals: ArrayLike, depth: ArrayLike, height: ArrayLike) -> Array:
    foot, direction = as_rows(points, 3, "ray point"), as_rows(normals, 3, "ray normal")
    if len(direction) != len(foot):
        raise InvalidInput(f"{len(foot)} ray points come with {len(direction)} normals: one of each is needed")
    span = np.empty((len(foot), 2))
    for column, (name, value) in enumerate((("depth", depth), ("height", height))):
        span[:, column] = value
        if not (np.isfinite(span[:, column]).all() and (span[:, column] > 0).all()):
            raise InvalidInput(f"ray {name} must be finite and above zero, mm")
    return np.ascontiguousarray(np.hstack([foot, unit(direction), span]))


def _run(solid: Array, motions: Motions, tables: tuple[Array, NDArray[np.bool_]], rays: tuple[Array, Array, Counts],
         workers: tuple[int, Progress]) -> Found:
    """Hand blocks of rays to the kernel, or to its twin."""
    slack, cutting = tables
    count, (threads, progress) = len(rays[0]), workers
    out = (np.full(count, np.inf), np.zeros(count), np.full(count, -1, dtype=np.int64),
           np.full(count, -1, dtype=np.int64))
    body = (solid, (motions.start, motions.step, motions.axis, motions.turn))
    full = (*grouped(motions), slack, cutting, motions.arrival)

    def work(part: tuple[int, int]) -> None:
        if _compiled.available:
            _remove(body, full, rays, out, part)
        else:
            some = (rays[0], rays[1][slice(*part)], rays[2][part[0]:part[1] + 1])
            remove_numpy(body, (slack, cutting, motions.arrival), some, out)

    in_chunks(work, len(rays[1]), threads, partial(progress.report, "material removal"))
    return out


def removal(cl: tuple[ArrayLike, ArrayLike, ArrayLike], profile: Profile, rays: tuple[ArrayLike, ArrayLike], *,
            depth: ArrayLike = 1.0, height: ArrayLike = 10.0, cutting: tuple[int, ...] = (Motion.CUT,),
            among: tuple[int, ...] | None = None, threads: int = 1, progress: Progress = NO_PROGRESS) -> Remains:
    """Remove material with a cutter along cutter location data and measure what is left along rays.

    Parameters
    ----------
    cl : tips (n, 3), axes (n, 3), kind (n,)
        Tool tips, mm, tool axes, and the `Motion` that arrives at each point.  Between two points the tip moves
        straight and the axis is interpolated linearly and normalised.
    profile : Profile
        Generatrix of the cutter.
    rays : points (m, 3), normals (m, 3)
        Feet of the rays, mm, and directions out of the material.
    depth, height : float or (m,) array_like
        How far to look inwards and outwards, mm.
    cutting : tuple of int
        Kinds of motion that count for what remains; all kinds count for gouges.
    among : tuple of int, optional
        Kinds of motion that are looked at; all of them unless given.
    threads : int
        Threads of the compiled kernel; the result does not depend on it.
    progress : Progress

    Returns
    -------
    Remains

    Raises
    ------
    InvalidInput
        When there is no cutter location, a number is not finite, or shapes do not fit.

    Properties
    ----------
    1. On two straight passes over a plane the greatest height left is the scallop of their distance.
    2. Rigid motions and mirrors change nothing; nor does the number of threads.
    3. A ball's heights do not depend on its axes.
    """
    solid = cutter_solid(profile)
    reach = reach_of(solid)
    motions = motions_from_cl(*cl, reach)
    if among is not None:
        motions = motions.rows(np.isin(motions.kind, among))
    ray = _checked_rays(*rays, depth, height)
    if not len(ray):
        raise InvalidInput("there is no ray: give at least one point of the face")
    order = curve_order(ray[:, :3])
    sorted_ray = np.ascontiguousarray(ray[order])
    lean = np.linalg.norm(motions.axis + 0.5 * motions.turn, axis=1)
    slack = 0.5 * np.linalg.norm(motions.step, axis=1) + 0.5 * np.linalg.norm(motions.turn, axis=1) / lean * reach
    if not len(motions):
        nothing = np.full(len(ray), -1, dtype=np.int64)
        return Remains(np.full(len(ray), np.inf), np.zeros(len(ray)), nothing, nothing.copy(), NUMERICAL)
    cuts = np.isin(motions.kind, cutting)
    out = _run(solid[0], motions, (slack, cuts), (sorted_ray, *balls(sorted_ray[:, :3])), (threads, progress))
    back = np.empty_like(order)
    back[order] = np.arange(len(order))
    remaining, gouge, cut_by, gouged_by = out
    return Remains(remaining[back], gouge[back], cut_by[back], gouged_by[back], NUMERICAL + motions.uncertainty)
