"""Splitting a trimmed face into cells from the top down, and enclosing them from the leaves up."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.bezier import bezier_nets, derivative_bounds
from toolaxis.progress import breathe
from toolaxis.shape.bounding.base_cells import grade_lines, grid_lines
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]

#: The diagonal of the face divided by these is the length above which cells are always split, and the one below which
#: they are not split for being curved.
_COARSEST, _FINEST = 4, 32
#: Multiples of the fineness that a cell's parallelogram, and its second-order form, may miss the face by.
_FLAT, _CURVED = 10.0, 0.1
#: A leaf with more trim edges than the first number is split, because each look at a part of it clips all of them; the
#: diagonal divided by the second number is the length below which it stays.
_EDGES, _CROWDED = 8, 4096
_DEEPEST = 48
_ROUNDING = 1e-12
_MARGIN = 1e-9
_CORNERS = ((0, 2), (0, 3), (1, 2), (1, 3))
_REFERENCE = np.array([0.4876237, 0.5312345])


class TreeArrays(NamedTuple):
    """The arrays of `toolaxis.shape.bounding.bounding_tree.BoundingTree`, for one face."""

    shape: Array
    bend: Array
    link: Indices
    leaf: Array
    edge_start: Indices
    edges: Array


class _Level(NamedTuple):
    """Nodes of one depth: base cells i0, i1, j0, j1; rectangle u0, u1, v0, v1; parent; trim edges with their node."""

    base: Indices
    rect: Array
    parent: Indices
    owner: Indices
    edge: Indices

    @property
    def single(self) -> Flags:
        """Whether a node lies in one base cell."""
        return np.asarray((self.base[:, 1::2] - self.base[:, 0::2] == 1).all(axis=1))

    @property
    def middle(self) -> Array:
        """Centres of the rectangles."""
        return np.asarray((self.rect[:, 0::2] + self.rect[:, 1::2]) / 2)

    @property
    def half(self) -> Array:
        """Half widths of the rectangles."""
        return np.asarray((self.rect[:, 1::2] - self.rect[:, 0::2]) / 2)

    def chosen(self, kept: Flags, rect: Array) -> "_Level":
        """Some of the nodes, with other rectangles."""
        place = np.where(kept, np.cumsum(kept) - 1, -1)[self.owner]
        return _Level(self.base[kept], rect[kept], self.parent[kept], place[place >= 0], self.edge[place >= 0])


def margin_of(face: Face) -> Array:
    """Width in u and v of the border zone of rectangles in which an edge counts as one that stays outside, (2,).

    Parameters
    ----------
    face : Face
    """
    u0, u1, v0, v1 = face.bounds
    rounding = 1e-14 * np.array([abs(u0) + abs(u1), abs(v0) + abs(v1)])
    return np.asarray(_MARGIN * np.array([u1 - u0, v1 - v0]) + rounding)


def clip_edges(rect: Array, edges: Array, margin: Array) -> tuple[Flags, Array]:
    """Whether edges run through the inner part of rectangles, and what is left of them.

    Parameters
    ----------
    rect : (k, 4) array
        u0, u1, v0, v1.
    edges : (k, 4) array
        u, v of both ends.
    margin : (2,) or (k, 2) array
        Width of the border zone that does not count as inner part; never more than half of it.

    Returns
    -------
    through : (k,) array of bool
    ends : (k, 2, 2) array
        Meaningless where the edge stays outside.
    """
    start, along = edges[:, :2], edges[:, 2:] - edges[:, :2]
    middle, half = (rect[:, 0::2] + rect[:, 1::2]) / 2, (rect[:, 1::2] - rect[:, 0::2]) / 2
    half = np.maximum(half - margin, half / 2)
    still = np.asarray(along == 0)
    step = np.where(still, 1.0, along)
    first, second = (middle - half - start) / step, (middle + half - start) / step
    outside = np.asarray((still & (np.abs(start - middle) >= half)).any(axis=1))
    enter = np.where(still, -np.inf, np.minimum(first, second)).max(axis=1).clip(0.0)
    leave = np.where(still, np.inf, np.maximum(first, second)).min(axis=1).clip(None, 1.0)
    ends = start[:, None] + np.stack([enter, leave], axis=1)[:, :, None] * along[:, None]
    return ~outside & (enter < leave), ends


def is_near_face(face: Face, uv: Array, margin: Array) -> Flags:
    """Whether parameters lie on the face or so near to it that rounding and left-out edges could decide, (n,).

    Parameters
    ----------
    face : Face
    uv : (n, 2) array
    margin : (2,) array
        From `margin_of`.
    """
    found = face.contains(uv)
    for side in ((-3.0, -3.0), (-3.0, 3.0), (3.0, -3.0), (3.0, 3.0)):
        rest = np.flatnonzero(~found)
        found[rest] = face.contains(uv[rest] + side * margin)
    return found


def _halve_nodes(level: _Level, rows: Indices, size: Array, lines: tuple[Array, Array]) -> _Level:
    """Both halves of some nodes, cut across their longer side at a base line or, in one base cell, in the middle."""
    count = level.base[rows, 1::2] - level.base[rows, 0::2]
    several = np.asarray((count > 1).any(axis=1))
    across = np.argmax(np.where(several[:, None] & (count == 1), -1.0, size[rows]), axis=1)
    k = np.arange(len(rows))
    at = (level.base[rows, 2 * across] + level.base[rows, 2 * across + 1]) // 2
    line = np.where(across == 0, lines[0][np.minimum(at, len(lines[0]) - 1)],
                    lines[1][np.minimum(at, len(lines[1]) - 1)])
    base = np.stack([level.base[rows], level.base[rows]])
    base[0, k[several], 2 * across[several] + 1] = at[several]
    base[1, k[several], 2 * across[several]] = at[several]
    rect = np.stack([level.rect[rows], level.rect[rows]])
    cut = np.where(several, np.clip(line, rect[0, k, 2 * across], rect[0, k, 2 * across + 1]),
                   level.middle[rows, across])
    rect[0, k, 2 * across + 1] = cut
    rect[1, k, 2 * across] = cut
    place = np.full(len(level.rect), -1)
    place[rows] = k
    owner, edge = place[level.owner], level.edge
    owner, edge = owner[owner >= 0], edge[owner >= 0]
    both = _Level(base.reshape(-1, 4), rect.reshape(-1, 4), np.concatenate([rows, rows]),
                  np.concatenate([owner, owner + len(rows)]), np.concatenate([edge, edge]))
    return both.chosen(np.asarray((both.half > 0).all(axis=1)), both.rect)


class _Builder:
    """One face, its base cells with their bounds, and the levels made so far."""

    def __init__(self, face: Face, fineness: float) -> None:
        self.face, self.fineness = face, fineness
        (d0, d1), (e0, e1) = face.surface.domain
        u0, u1, v0, v1 = face.bounds
        self.rect = np.array([[max(u0, d0), min(u1, d1), max(v0, e0), min(v1, e1)]])
        if not (self.rect[:, 0::2] < self.rect[:, 1::2]).all():
            raise InvalidInput(f"face {face.label} has loops around u {u0:g} to {u1:g}, v {v0:g} to {v1:g}, outside "
                               f"its surface's domain {d0:g} to {d1:g}, {e0:g} to {e1:g}: trim it inside")
        ku, kv, _, pu, pv, _ = face.surface.data
        lines = (grid_lines(ku, pu, *self.rect[0, :2]), grid_lines(kv, pv, *self.rect[0, 2:]))
        self.lines = (grade_lines(face, lines, 0, fineness), grade_lines(face, lines, 1, fineness))
        self.bounds = self._derivatives()
        self.edges = np.concatenate([np.hstack([loop, np.roll(loop, -1, axis=0)]) for loop in face.trims]
                                    or [np.empty((0, 4))])
        self.margin = margin_of(face)
        self.extra = face.tolerance + _ROUNDING * (1 + float(np.abs(face.surface.control[..., :3]).max()))
        self.levels: list[_Level] = []
        self.centres: list[Array] = []
        self.ready: list[Flags] = []

    def _derivatives(self) -> Array:
        """Bounds of the three second and the four third derivatives over the base cells."""
        bu, bv = self.lines
        step = max(1, 400_000 // (len(bv) * 4 * (self.face.surface.degree[0] + 1) * (self.face.surface.degree[1] + 1)))
        rows = [derivative_bounds(bezier_nets(self.face.surface.data, bu[i:i + step + 1], bv),
                                  np.diff(bu[i:i + step + 1]), np.diff(bv), 2, 3)
                for i in range(0, len(bu) - 1, step)]
        return np.concatenate(rows)

    def trimmed(self, level: _Level) -> _Level:
        """Nodes that have something inside the loops, shrunk to the box around it.

        What is left of a crossed node has its corners at the ends of clipped edges and at corners of the node; those
        count where an edge in the border zone, which was not clipped, might hide that they are inside.
        """
        if not len(self.edges):
            return level
        through, ends = clip_edges(level.rect[level.owner], self.edges[level.edge], self.margin)
        owner, edge, ends = level.owner[through], level.edge[through], ends[through]
        crossed = np.zeros(len(level.rect), dtype=bool)
        crossed[owner] = True
        thin = np.asarray((level.half <= 4 * self.margin).any(axis=1))
        kept = crossed | thin
        kept[~kept] = self.face.contains(level.middle[~kept])
        low, high = np.full((len(kept), 2), np.inf), np.full((len(kept), 2), -np.inf)
        np.minimum.at(low, owner, ends.min(axis=1))
        np.maximum.at(high, owner, ends.max(axis=1))
        for corner in _CORNERS:
            point = level.rect[:, corner]
            within = crossed.copy()
            within[crossed] = is_near_face(self.face, point[crossed], self.margin)
            low[within], high[within] = np.minimum(low, point)[within], np.maximum(high, point)[within]
        box = np.stack([np.maximum(low - self.margin / 2, level.rect[:, 0::2]),
                        np.minimum(high + self.margin / 2, level.rect[:, 1::2])], axis=2).reshape(-1, 4)
        shrunk = crossed & ~thin
        return level._replace(owner=owner, edge=edge).chosen(kept, np.where(shrunk[:, None], box, level.rect))

    def centred(self, level: _Level) -> tuple[Array, Flags]:
        """q, a, b, e and the second-order form of every node, and which of them need no splitting.

        What is left (e, and the last column) only counts in single base cells.
        """
        half = level.half
        d = self.face.evaluate(level.middle)
        a, b = d.su * half[:, :1], d.sv * half[:, 1:]
        bend = np.hstack([d.suu * half[:, :1]**2, d.suv * half[:, :1] * half[:, 1:], d.svv * half[:, 1:]**2])
        bounds = self.bounds[level.base[:, 0], level.base[:, 2]]
        e, rest = remainder(bounds, half) + self.extra, second_remainder(bounds[:, 3:], half) + self.extra
        longest = 2 * np.maximum(np.linalg.norm(a, axis=1), np.linalg.norm(b, axis=1)) + 2 * e
        fine = (e <= _FLAT * self.fineness + self.extra) & (rest <= _CURVED * self.fineness + self.extra)
        fine &= longest <= self.face.diagonal / _COARSEST
        least = max(self.face.diagonal / _FINEST, self.fineness + 2 * self.extra)  # a face without area has no diagonal
        crowded = np.bincount(level.owner, minlength=len(half)) > _EDGES
        crowded &= longest > max(self.face.diagonal / _CROWDED, self.fineness + 2 * self.extra)
        done = ((fine | (longest <= least)) & ~crowded) | (len(self.levels) >= _DEEPEST)
        return np.column_stack([d.point, a, b, e, bend, rest]), level.single & done

    def split(self) -> None:
        """All levels, the root first."""
        base = np.array([[0, len(self.lines[0]) - 1, 0, len(self.lines[1]) - 1]])
        none = np.zeros(len(self.edges), dtype=np.int64)
        level = self.trimmed(_Level(base, self.rect, np.array([-1]), none, np.arange(len(self.edges))))
        if not len(level.rect):
            raise InvalidInput(f"face {self.face.label} has nothing inside its loops: give loops that enclose a part "
                               "of the surface")
        while len(level.rect):
            breathe()
            centre, ready = self.centred(level)
            self.levels.append(level)
            self.centres.append(centre)
            self.ready.append(ready)
            size = np.stack([np.linalg.norm(centre[:, 3:6], axis=1), np.linalg.norm(centre[:, 6:9], axis=1)], axis=1)
            level = self.trimmed(_halve_nodes(level, np.flatnonzero(~ready), size, self.lines))

    def tree(self) -> TreeArrays:
        """Enclosures from the leaves up, numbered from the root down."""
        alive, radius = enclose_parents(self.levels, self.centres, self.ready)
        counts = np.array([a.sum() for a in alive])
        offset = np.concatenate([[0], np.cumsum(counts)])
        number = [np.where(a, np.cumsum(a) - 1 + o, -1) for a, o in zip(alive, offset[:-1], strict=True)]
        rows = np.vstack([np.column_stack([c, r])[a] for c, r, a in zip(self.centres, radius, alive, strict=True)])
        shape, bend = np.column_stack([rows[:, :10], rows[:, -1]]), rows[:, 10:-1]
        link = np.full((len(shape), 5), -1, dtype=np.int64)
        for depth in range(1, len(self.levels)):
            rows = number[depth][alive[depth]]
            above = number[depth - 1][self.levels[depth].parent[alive[depth]]]
            order = np.argsort(above, kind="stable")
            first = np.concatenate([[True], np.diff(above[order]) > 0])
            link[above[order][first], 0] = rows[order][first]
            link[above[order][~first], 1] = rows[order][~first]
        link[:, 2] = 0
        ready = np.concatenate([r[a] for r, a in zip(self.ready, alive, strict=True)])
        link[ready, 3] = np.arange(ready.sum())
        middle = np.vstack([level.middle[a] for level, a in zip(self.levels, alive, strict=True)])
        crossed = [np.bincount(level.owner, minlength=len(a))[a] > 0
                   for level, a in zip(self.levels, alive, strict=True)]
        link[:, 4] = self.face.contains(middle) * np.where(np.concatenate(crossed), 1, 2)
        return TreeArrays(shape, bend, link, *self._leaves())

    def _leaves(self) -> tuple[Array, Indices, Array]:
        rows, edges, counts = [], [], []
        for level, ready in zip(self.levels, self.ready, strict=True):
            reference = level.rect[:, 0::2] + 2 * level.half * _REFERENCE
            m = self.bounds[level.base[:, 0], level.base[:, 2]]
            rows.append(np.column_stack([level.middle, level.half, m[:, :3], np.full(len(m), self.extra), reference,
                                         self.face.contains(reference), m[:, 3:]])[ready])
            kept = ready[level.owner]
            order = np.argsort(level.owner[kept], kind="stable")
            edges.append(self.edges[level.edge[kept][order]])
            counts.append(np.bincount(level.owner[kept], minlength=len(ready))[ready])
        start = np.concatenate([[0], np.cumsum(np.concatenate(counts))]).astype(np.int64)
        return np.vstack(rows), start, np.vstack(edges)


def remainder(bounds: Array, half: Array) -> Array:
    """Greatest distance of a surface from its tangent parallelogram, by Taylor's formula.

    Parameters
    ----------
    bounds : (n, 3) array
        Bounds of |Suu|, |Suv| and |Svv|.
    half : (n, 2) array
        Half widths of the cells.
    """
    du, dv = half[:, 0], half[:, 1]
    return np.asarray(bounds[:, 0] * du**2 / 2 + bounds[:, 1] * du * dv + bounds[:, 2] * dv**2 / 2)


def second_remainder(bounds: Array, half: Array) -> Array:
    """Greatest distance of a surface from its second-order form, by Taylor's formula.

    Parameters
    ----------
    bounds : (n, 4) array
        Bounds of |Suuu|, |Suuv|, |Suvv| and |Svvv|.
    half : (n, 2) array
        Half widths of the cells.
    """
    du, dv = half[:, 0], half[:, 1]
    return np.asarray((bounds[:, 0] * du**3 + 3 * bounds[:, 1] * du**2 * dv + 3 * bounds[:, 2] * du * dv**2
                       + bounds[:, 3] * dv**3) / 6)


def enclose_parents(levels: list[_Level], centres: list[Array], ready: list[Flags]) -> tuple[list[Flags], list[Array]]:
    """Write what is left of the parents into ``centres``; which nodes hold something, the radius of each around its q.

    Parameters
    ----------
    levels : list of levels, the root first
    centres : list of (n, 20) arrays
        q, a, b, e, the second-order form's three vectors, and what that leaves.
    ready : list of (n,) bool arrays
        Which nodes are leaves.

    Notes
    -----
    A child's point is q' + s a' + t b' + d', the parent's own is q + S a + T b at the same parameters; what differs
    is q' - q - S0 a - T0 b, and a' and b' less their shares of a and b.  With the second-order forms it is the
    difference of two quadratic forms, coefficient by coefficient.
    """
    alive = [np.zeros(len(c), dtype=bool) for c in centres]
    radius = [np.zeros(len(c)) for c in centres]
    for depth in range(len(levels) - 1, -1, -1):
        c, leaf = centres[depth], ready[depth]
        alive[depth] |= leaf
        tall = ~leaf
        c[tall, 9] = c[tall, 19] = 0.0
        around = np.full(len(c), 0.0)
        if depth + 1 < len(levels):
            _add_children(levels, centres, depth, (alive[depth + 1], radius[depth + 1], around))
        corner = np.maximum(np.linalg.norm(c[:, 3:6] + c[:, 6:9], axis=1),
                            np.linalg.norm(c[:, 3:6] - c[:, 6:9], axis=1)) + c[:, 9]
        radius[depth] = np.where(tall, np.minimum(around, corner), corner)
        if depth:
            alive[depth - 1][levels[depth].parent[alive[depth]]] = True
    return alive, radius


def _add_children(levels: list[_Level], centres: list[Array], depth: int,
                  below: tuple[Flags, Array, Array]) -> None:
    alive, radius, around = below
    up, down = levels[depth], levels[depth + 1]
    k = np.flatnonzero(alive)
    p = down.parent[k]
    half = np.where(up.half[p] > 0, up.half[p], 1.0)
    place, share = (down.middle[k] - up.middle[p]) / half, down.half[k] / half
    child, own = centres[depth + 1][k], centres[depth][p]
    gap = child[:, :3] - own[:, :3]
    (s, t), (ks, kt) = place.T[:, :, None], share.T[:, :, None]
    a, b, suu, suv, svv = (own[:, i:i + 3] for i in (3, 6, 10, 13, 16))
    straight = gap - s * a - t * b
    first = (straight, child[:, 3:6] - ks * a, child[:, 6:9] - kt * b)
    second = (straight - (s * s * suu + 2 * s * t * suv + t * t * svv) / 2,
              child[:, 3:6] - ks * (a + s * suu + t * suv), child[:, 6:9] - kt * (b + s * suv + t * svv),
              (child[:, 10:13] - ks * ks * suu) / 2, child[:, 13:16] - ks * kt * suv,
              (child[:, 16:19] - kt * kt * svv) / 2)
    for column, differences in ((9, first), (19, second)):
        off = child[:, column] + sum(np.linalg.norm(d, axis=1) for d in differences)
        np.maximum.at(centres[depth][:, column], p, off)
    np.maximum.at(around, p, np.linalg.norm(gap, axis=1) + radius[k])


def build_tree(face: Face, fineness: float) -> TreeArrays:
    """The tree of cells that encloses a face.

    Parameters
    ----------
    face : Face
    fineness : float
        mm: cells of at most a quarter of the face's diagonal are left as they are where e is at most ten times that and
        e' a tenth; cells below 1/32 of the diagonal are split only where many trim edges run.

    Raises
    ------
    InvalidInput
        When the loops enclose nothing of the surface.
    """
    builder = _Builder(face, fineness)
    builder.split()
    return builder.tree()
