"""What the cutter leaves: height of the material above each point of a face, and depth of the cut below it."""

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput
from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit, jit_inline
from toolaxis.numeric.shares import share_out
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.tools.profile import Profile
from toolaxis.verify.linear_motions import GROUP, Hierarchy, Tile, Tiles, floors, near_groups
from toolaxis.verify.material_removal_numpy import remove_numpy
from toolaxis.verify.revolved_solids import cutter_solid, reach_of
from toolaxis.verify.spatial_blocks import CHUNK, balls, blocks_of
from toolaxis.verify.swept_solid import LOOK, ROOT, first_entry, gradient, least_over_motion, moment, sway

Array = NDArray[np.float64]
Index: TypeAlias = NDArray[np.int64]
Pieces: TypeAlias = tuple[Array, Array, Array, Array]
Body: TypeAlias = tuple[Array, Pieces]
Found: TypeAlias = tuple[Array, Array, Index, Index]
Vector: TypeAlias = tuple[float, float, float]

#: Bound of the rounding and root-finding errors of a height, mm.
NUMERICAL = 1e-6

#: Blocks of rays in a tile, which are held in memory together; rays that are passed over together where none is near.
TILE, _RUN = 4_000, 256


class RemovalTables(NamedTuple):
    """The cutter, and of its motions: groups, which of them cut, where each arrives, and how far its axis turns."""

    solids: Array
    groups: Hierarchy
    cutting: NDArray[np.bool_]
    arrival: Index
    sway: Array


@dataclass(frozen=True, eq=False)
class RestMaterial:
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
    cut_by: Index
    gouged_by: Index
    uncertainty: float


@jit_inline
def _meet(body: Body, which: tuple[int, bool, int], ray: Array, out: Found, place: tuple[int, float]) -> None:
    """Let motion which[0] (cutting or not, arriving at which[2]) act on ray place[0], outside until t = place[1].

    A look at the top of the span comes first: most rays are told to stay outside by the solid's function and its slope
    there.
    """
    solid, motion = body
    k, cutting, arrival = which
    i, start = place
    remaining, gouge, cut_by, gouged_by = out
    level = _level((remaining[i], gouge[i]), ray[i, 7], cutting)
    line = (ray[i, 0], ray[i, 1], ray[i, 2], ray[i, 3], ray[i, 4], ray[i, 5])
    change = sway(motion, k)
    _, low, along, _ = least_over_motion(solid, motion, k, line, level)
    low -= LOOK if change > 0.0 else ROOT
    if low > max(along + change, 0.0) * (level - start):
        return
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


@jit_inline
def _level(found: tuple[float, float], height: float, cutting: bool) -> float:
    """Height below which a motion would change a ray: what remains on it, or minus its gouge where that is deeper."""
    remaining, gouge = found
    return min(remaining, height) if cutting and remaining > 0.0 else -gouge


class Block(NamedTuple):
    """A block of rays: rows of the table of rays, and what bounds them.

    Attributes
    ----------
    low, high : int
        Rows from and to.
    centre : (float, float, float)
        Middle of the feet, mm.
    radius : float
        Greatest distance of a foot from it, mm.
    normal : (float, float, float)
        Mean of the normals.
    thick, wide : float
        Greatest distance of a foot from the centre along the normal and across it, mm.
    spread : float
        Greatest distance of a normal from the mean one.
    """

    low: int
    high: int
    centre: Vector
    radius: float
    normal: Vector
    thick: float
    wide: float
    spread: float


@jit
def _block(ray: Array, ball: Array, low: int, high: int) -> Block:
    """What bounds the rays of a block."""
    n0, n1, n2 = 0.0, 0.0, 0.0
    for i in range(low, high):
        n0, n1, n2 = n0 + ray[i, 3], n1 + ray[i, 4], n2 + ray[i, 5]
    size = np.sqrt(n0 * n0 + n1 * n1 + n2 * n2)
    if size < 1e-6:  # normals that cancel out: any direction will do
        n0, n1, n2, size = 0.0, 0.0, 1.0, 1.0
    n0, n1, n2 = n0 / size, n1 / size, n2 / size
    thick, wide, spread = 0.0, 0.0, 0.0
    for i in range(low, high):
        d0, d1, d2 = ray[i, 0] - ball[0], ray[i, 1] - ball[1], ray[i, 2] - ball[2]
        up = d0 * n0 + d1 * n1 + d2 * n2
        thick = max(thick, abs(up))
        wide = max(wide, d0 * d0 + d1 * d1 + d2 * d2 - up * up)
        e0, e1, e2 = ray[i, 3] - n0, ray[i, 4] - n1, ray[i, 5] - n2
        spread = max(spread, e0 * e0 + e1 * e1 + e2 * e2)
    return Block(low, high, (ball[0], ball[1], ball[2]), ball[3], (n0, n1, n2), thick, np.sqrt(wide), np.sqrt(spread))


class Span(NamedTuple):
    """Where a motion may change something on the rays of a block: greatest depth and height, mm."""

    depth: float
    level: float


@jit
def _span(ray: Array, out: Found, low: int, high: int) -> Span:
    depth, level = 0.0, 0.0
    for i in range(low, high):
        depth = max(depth, ray[i, 6])
        level = max(level, min(out[0][i], ray[i, 7]))
    return Span(depth, level)


class Plane(NamedTuple):
    """A plane below the solid's function over a whole motion: see `_plane_below`.

    Attributes
    ----------
    value : float
        At its foot, mm.
    foot : (float, float, float)
        mm
    slope : (float, float, float)
    """

    value: float
    foot: Vector
    slope: Vector


@jit_inline
def _plane_below(body: Body, k: int, block: Block, level: float) -> Plane:
    """A tangent plane of the solid's function on motion k, taken where the mean ray of a block is at a level.

    The function is convex: it lies above the plane over the whole motion, but for what the turn of the axis on it takes
    off with the distance from the foot.
    """
    solid, motion = body
    start, c, n = motion[0], block.centre, block.normal
    foot = (c[0] + level * n[0], c[1] + level * n[1], c[2] + level * n[2])
    w = (foot[0] - start[k, 0], foot[1] - start[k, 1], foot[2] - start[k, 2])
    value, slope, g0, g1, g2 = gradient(solid, motion, (k, 0.5), w)
    return Plane(value - 0.5 * abs(slope) - LOOK, foot, (g0, g1, g2))


@jit_inline
def _misses(plane: Plane, turned: float, block: Block, span: Span) -> bool:
    """Whether a motion, for whose turning so much is taken off, surely stays off all rays of a block in a span.

    The foot of the plane below it is where the mean ray leaves the span.
    """
    n, (g0, g1, g2) = block.normal, plane.slope
    along = g0 * n[0] + g1 * n[1] + g2 * n[2]
    across = np.sqrt(max(g0 * g0 + g1 * g1 + g2 * g2 - along * along, 0.0))
    length = span.depth + span.level
    least = plane.value - abs(along) * block.thick - across * block.wide
    least -= max(along, 0.0) * length + max(span.depth, span.level) * block.spread
    return bool(least - turned > 0.0)


@jit_inline
def _misses_ray(plane: Array, m: int, ray: Array, i: int, level: float) -> bool:
    """Whether candidate m surely stays off ray i up to a level: its plane is lowest at one of the ray's ends there."""
    at_foot = plane[m, 0] + plane[m, 1] * ray[i, 0] + plane[m, 2] * ray[i, 1] + plane[m, 3] * ray[i, 2]
    along = plane[m, 1] * ray[i, 3] + plane[m, 2] * ray[i, 4] + plane[m, 3] * ray[i, 5]
    return bool(at_foot + min(along * level, -along * ray[i, 6]) > 0.0)


class Candidates(NamedTuple):
    """Motions of a group that may come to a block of rays.

    Attributes
    ----------
    motion : (GROUP,) array of int
        The first `count` of them.
    plane : (GROUP, 4) array
        Value at the part's origin, mm, and slope of a plane below the solid's function on each, all turning taken off.
    left : (GROUP,) array of int
        Room for those that may come to one ray.
    look : (GROUP, 3) array
        Room for what is seen of them: value, slope along the ray, and height.
    """

    motion: Index
    plane: Array
    left: Index
    look: Array


@jit_inline
def _collect(body: Body, tables: RemovalTables, block: Block, span: Span, group: int, near: Candidates) -> int:
    """Put the motions of a group that may come to a block of rays among the candidates; how many they are."""
    count, length, lever = 0, span.depth + span.level, max(span.depth, span.level)
    for k in range(tables.groups.first[group], tables.groups.first[group + 1]):
        plane = _plane_below(body, k, block, span.level)
        # No point of a ray is farther from the plane's foot than this.
        turned = tables.sway[k] * (block.radius + length + lever * block.spread)
        if not _misses(plane, turned, block, span):
            foot, slope = plane.foot, plane.slope
            near.motion[count] = k
            near.plane[count, 0] = plane.value - turned - (slope[0] * foot[0] + slope[1] * foot[1] + slope[2] * foot[2])
            near.plane[count, 1], near.plane[count, 2], near.plane[count, 3] = slope
            count += 1
    return count


@jit_inline
def _meet_group(body: Body, tables: RemovalTables, ray: Array, out: Found, near: tuple[Candidates, int],
                place: tuple[int, float]) -> None:
    """Let the first near[1] candidates act on ray place[0]: the closest first, then those it does not rule out.

    Their planes rule most of them out.  One look at the middle of each other motion, at height t, tells that the
    solid's function over the whole motion and ray is at least rest + along (t' - t); that rules out more of them, and
    bounds the root of the others from below.  It tells most near the height at which the ray will be cut in the end:
    place[1] is a guess.
    """
    solid, motion = body
    left, look = near[0].left, near[0].look
    i, guess = place
    cutting, arrival = tables.cutting, tables.arrival
    line = (ray[i, 0], ray[i, 1], ray[i, 2], ray[i, 3], ray[i, 4], ray[i, 5])
    found, bottom = (out[0][i], out[1][i]), -ray[i, 6]
    best, first, count = np.inf, -1, 0
    for m in range(near[1]):
        k = near[0].motion[m]
        level = _level(found, ray[i, 7], cutting[k])
        if _misses_ray(near[0].plane, m, ray, i, level):
            continue
        height = min(level, guess)
        value, slope, along = moment(solid, motion, (k, 0.5), line, height)
        left[count] = k
        look[count, 0], look[count, 1], look[count, 2] = value - 0.5 * abs(slope) - LOOK, along, height
        if value < best:
            best, first = value, count
        count += 1
    for turn in range(-1, count):
        n = first if turn < 0 else turn
        if turn == first:
            continue
        k, along = left[n], look[n, 1]
        level, change = _level(found, ray[i, 7], cutting[k]), tables.sway[k]
        rest = look[n, 0] + along * (level - look[n, 2]) - change * abs(level - look[n, 2])
        if rest > max(along + change, 0.0) * (level - bottom):
            continue
        start = max(bottom, level - rest / (along + change)) if along < -change else bottom
        _meet(body, (k, cutting[k], arrival[k]), ray, out, (i, start))
        found = (out[0][i], out[1][i])


@jit
def _remove_block(body: Body, tables: RemovalTables, ray: Array, out: Found, place: tuple[Array, int, int]) -> None:
    """Let all motions act on one block of rays, nearest groups first."""
    ball, low, high = place
    span = _span(ray, out, low, high)
    groups = tables.groups
    near, least = np.empty(groups.narrow.shape[0] + 1, dtype=np.int64), np.empty(groups.narrow.shape[0] + 1)
    found = near_groups(tables.solids, groups, ball, max(span.depth, span.level), (near, least))
    if found == 0:
        return
    block = _block(ray, ball, low, high)
    candidates = Candidates(np.empty(GROUP, dtype=np.int64), np.empty((GROUP, 4)), np.empty(GROUP, dtype=np.int64),
                            np.empty((GROUP, 3)))
    for b in np.argsort(least[:found]):
        span = _span(ray, out, low, high)
        if least[b] > max(span.depth, span.level):
            break
        count = _collect(body, tables, block, span, near[b], candidates)
        if count:
            guess = np.inf
            for i in range(low, high):
                _meet_group(body, tables, ray, out, (candidates, count), (i, guess))
                guess = out[0][i]


@jit
def _remove(body: Body, tables: RemovalTables, rays: tuple[Array, Array, Index], out: Found,
            part: tuple[int, int]) -> None:
    ray, ball, first = rays
    for b in range(part[0], part[1]):
        _remove_block(body, tables, ray, out, (ball[b], first[b], first[b + 1]))


def _check_rays(points: ArrayLike, normals: ArrayLike, spans: tuple[ArrayLike, ArrayLike],
                ) -> tuple[Array, Array, Array, Array]:
    """Feet, directions, depths and heights of rays, one of each for every ray."""
    foot, direction = as_rows(points, 3, "ray point"), as_rows(normals, 3, "ray normal")
    if len(direction) != len(foot):
        raise InvalidInput(f"{len(foot)} ray points come with {len(direction)} normals: one of each is needed")
    depth, height = (np.broadcast_to(np.asarray(value, dtype=float), len(foot)) for value in spans)
    for name, value in (("depth", depth), ("height", height)):
        if not (np.isfinite(value).all() and (value > 0).all()):
            raise InvalidInput(f"ray {name} must be finite and above zero, mm")
    if not len(foot):
        raise InvalidInput("there is no ray: give at least one point of the face")
    return foot, direction, depth, height


class Removal:
    """A cutter along cutter location data, ready to be met with rays.

    Parameters
    ----------
    cl : tips (n, 3), axes (n, 3), kind (n,)
        Tool tips, mm, tool axes, and the `Motion` that arrives at each point.  Between two points the tip moves
        straight and the axis is interpolated linearly and normalised.
    profile : Profile
        Generatrix of the cutter.
    among : tuple of int, optional
        Kinds of motion that are looked at; all of them unless given.
    threads : int
        Threads of the compiled kernel; the result does not depend on it.
    progress : Progress

    Raises
    ------
    InvalidInput
        When there is no cutter location, a number is not finite, or shapes do not fit.
    """

    def __init__(self, cl: tuple[ArrayLike, ArrayLike, ArrayLike], profile: Profile, *,
                 among: tuple[int, ...] | None = None, threads: int = 1, progress: Progress = NO_PROGRESS) -> None:
        self._solid = cutter_solid(profile)
        self._tiles = Tiles(cl, reach_of(self._solid), among)
        self._threads, self._report = threads, partial(progress.report, "material removal")

    @property
    def uncertainty(self) -> float:
        """Bound of the error of a height or a depth, mm."""
        return NUMERICAL + self._tiles.uncertainty

    def along(self, rays: tuple[ArrayLike, ArrayLike], *, depth: ArrayLike = 1.0, height: ArrayLike = 10.0,
              cutting: tuple[int, ...] = (Motion.CUT,)) -> RestMaterial:
        """Remove material and measure what is left along rays.

        Parameters
        ----------
        rays : points (m, 3), normals (m, 3)
            Feet of the rays, mm, and directions out of the material.
        depth, height : float or (m,) array_like
            How far to look inwards and outwards, mm.
        cutting : tuple of int
            Kinds of motion that count for what remains; all kinds count for gouges.

        Raises
        ------
        InvalidInput
            When there is no ray, a number is not finite, or shapes do not fit.
        """
        foot, direction, low, high = _check_rays(*rays, (depth, height))
        found = _nothing(len(foot))
        near = self._within(foot, max(float(low.max()), float(high.max())))
        if len(near):
            order, ball, first = blocks_of(foot[near])
            order = near[order]
            for start in range(0, len(ball), TILE):
                some = slice(start, start + TILE)
                rows = order[first[start]:first[min(start + TILE, len(ball))]]
                table = np.column_stack([foot[rows], unit(direction[rows]), low[rows], high[rows]])
                blocks = (np.ascontiguousarray(table), ball[some], first[start:start + TILE + 1] - first[start])
                self._act(cutting, blocks, rows, found)
        return RestMaterial(*found, self.uncertainty)

    def _within(self, foot: Array, lever: float) -> Index:
        """Rows of the rays whose feet may lie within a distance of the cutter on any motion, mm."""
        if not _compiled.available:
            return np.arange(len(foot))
        ball, first = balls(foot, _RUN)
        least = np.full(len(ball), np.inf)
        for tile in self._tiles:
            floors(self._solid, tile.groups, ball, least)
        return np.flatnonzero(np.repeat(least <= lever, np.diff(first)))

    def _act(self, cutting: tuple[int, ...], rays: tuple[Array, Array, Index], rows: Index, out: Found) -> None:
        """Let all motions act on blocks of rays, which stand in some rows of what is found."""
        found = _nothing(len(rows))
        for tile in self._tiles:
            self._meet(tile, cutting, rays, found)
        for values, some in zip(out, found, strict=True):
            values[rows] = some

    def _meet(self, tile: Tile, cutting: tuple[int, ...], rays: tuple[Array, Array, Index], out: Found) -> None:
        """Hand blocks of rays to the kernel, or to its twin."""
        motions = tile.motions
        body = (self._solid[0], (motions.start, motions.step, motions.axis, motions.turn))
        tables = RemovalTables(self._solid, tile.groups, np.isin(motions.kind, cutting), motions.arrival, tile.sway)

        def _work(part: slice) -> None:
            if _compiled.available:
                _remove(body, tables, rays, out, (part.start, part.stop))
            else:
                some = (rays[0], rays[1][part], rays[2][part.start:part.stop + 1])
                remove_numpy(body, (tile.slack, tables.cutting, tables.arrival), some, out)

        for done in share_out(_work, len(rays[1]), CHUNK, self._threads):
            self._report(done.stop, len(rays[1]))


def _nothing(count: int) -> Found:
    """What is found on rays that nothing has met."""
    return (np.full(count, np.inf), np.zeros(count), np.full(count, -1, dtype=np.int64),
            np.full(count, -1, dtype=np.int64))


def removal(cl: tuple[ArrayLike, ArrayLike, ArrayLike], profile: Profile, rays: tuple[ArrayLike, ArrayLike], *,
            depth: ArrayLike = 1.0, height: ArrayLike = 10.0, cutting: tuple[int, ...] = (Motion.CUT,),
            among: tuple[int, ...] | None = None, threads: int = 1,
            progress: Progress = NO_PROGRESS) -> RestMaterial:
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
    RestMaterial

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
    made = Removal(cl, profile, among=among, threads=threads, progress=progress)
    return made.along(rays, depth=depth, height=height, cutting=cutting)
