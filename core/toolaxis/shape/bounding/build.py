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
#: Columns of the links of a tree, as `toolaxis.shape.bounding.bounding_tree.BoundingTree` tells.
_LEFT, _RIGHT, _FACE, _LEAF, _ON_FACE = range(5)
#: Numbers of Bezier nets that are held at a time.
_NET_NUMBERS = 400_000


class TreeArrays(NamedTuple):
    """The arrays of `toolaxis.shape.bounding.bounding_tree.BoundingTree`, for one face."""

    shape: Array
    bend: Array
    link: Indices
    leaf: Array
    edge_start: Indices
    edges: Array


class _Enclosures(NamedTuple):
    """What holds the surface over each of n cells: a parallelogram q, a, b with e around it, and a second-order form.

    q, a, b : (n, 3) arrays, mm;  e : (n,) array, mm
    suu, suv, svv : (n, 3) arrays, second derivatives times half widths, mm;  rest : (n,) array, what is left, mm
    """

    q: Array
    a: Array
    b: Array
    e: Array
    suu: Array
    suv: Array
    svv: Array
    rest: Array

    def rows(self, which: Indices | Flags) -> "_Enclosures":
        """Some of them."""
        return _Enclosures(*(each[which] for each in self))


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
        number = np.where(kept, np.cumsum(kept) - 1, -1)
        owner = number[self.owner]
        stays = owner >= 0
        return _Level(self.base[kept], rect[kept], self.parent[kept], owner[stays], self.edge[stays])


def margin_of(face: Face) -> Array:
    """Width in u and v of the border zone of rectangles in which an edge counts as one that stays outside, (2,).

    Parameters
    ----------
    face : Face
    """
    u0, u1, v0, v1 = face.bounds
    size = np.array([u1 - u0, v1 - v0])
    rounding = 1e-14 * np.array([abs(u0) + abs(u1), abs(v0) + abs(v1)])
    return np.asarray(_MARGIN * size + rounding)


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
    start = edges[:, :2]
    along = edges[:, 2:] - start
    low = rect[:, 0::2]
    high = rect[:, 1::2]
    middle = (low + high) / 2
    half = (high - low) / 2
    half = np.maximum(half - margin, half / 2)
    # Shares of the edge at which it crosses the lines of u, and of v; it never does where it runs along them.
    still = np.asarray(along == 0)
    step = np.where(still, 1.0, along)
    first = (middle - half - start) / step
    second = (middle + half - start) / step
    outside = np.asarray((still & (np.abs(start - middle) >= half)).any(axis=1))
    enter = np.where(still, -np.inf, np.minimum(first, second)).max(axis=1).clip(0.0)
    leave = np.where(still, np.inf, np.maximum(first, second)).min(axis=1).clip(None, 1.0)
    shares = np.stack([enter, leave], axis=1)
    ends = start[:, None] + shares[:, :, None] * along[:, None]
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
    own_base = level.base[rows]
    own_rect = level.rect[rows]
    k = np.arange(len(rows))
    cells = own_base[:, 1::2] - own_base[:, 0::2]
    several = np.asarray((cells > 1).any(axis=1))
    one_cell_wide = several[:, None] & (cells == 1)
    across = np.argmax(np.where(one_cell_wide, -1.0, size[rows]), axis=1)
    low = 2 * across  # columns of the lower and upper end of what is cut
    high = low + 1
    at = (own_base[k, low] + own_base[k, high]) // 2
    line_u = lines[0][np.minimum(at, len(lines[0]) - 1)]
    line_v = lines[1][np.minimum(at, len(lines[1]) - 1)]
    line = np.clip(np.where(across == 0, line_u, line_v), own_rect[k, low], own_rect[k, high])
    cut = np.where(several, line, level.middle[rows, across])
    base = np.stack([own_base, own_base])
    base[0, k[several], high[several]] = at[several]
    base[1, k[several], low[several]] = at[several]
    rect = np.stack([own_rect, own_rect])
    rect[0, k, high] = cut
    rect[1, k, low] = cut
    # Both halves take the trim edges of their node for the time being.
    number = np.full(len(level.rect), -1)
    number[rows] = k
    owner = number[level.owner]
    edge = level.edge[owner >= 0]
    owner = owner[owner >= 0]
    halves = _Level(base.reshape(-1, 4), rect.reshape(-1, 4), np.concatenate([rows, rows]),
                    np.concatenate([owner, owner + len(rows)]), np.concatenate([edge, edge]))
    return halves.chosen(np.asarray((halves.half > 0).all(axis=1)), halves.rect)


class _Builder:
    """One face, its base cells with their bounds, and the levels made so far."""

    def __init__(self, face: Face, fineness: float) -> None:
        self.face = face
        self.fineness = fineness
        self.rect = _own_rectangle(face)
        u0, u1, v0, v1 = self.rect[0]
        knots_u, knots_v, _, degree_u, degree_v, _ = face.surface.data
        lines = (grid_lines(knots_u, degree_u, u0, u1), grid_lines(knots_v, degree_v, v0, v1))
        self.lines = (grade_lines(face, lines, 0, fineness), grade_lines(face, lines, 1, fineness))
        self.bounds = self._derivatives()
        edges = [np.hstack([loop, np.roll(loop, -1, axis=0)]) for loop in face.trims]
        self.edges = np.concatenate(edges) if edges else np.empty((0, 4))
        self.margin = margin_of(face)
        largest = float(np.abs(face.surface.control[..., :3]).max())
        self.extra = face.tolerance + _ROUNDING * (1 + largest)
        self.levels: list[_Level] = []
        self.enclosures: list[_Enclosures] = []
        self.ready: list[Flags] = []

    def _derivatives(self) -> Array:
        """Bounds of the three second and the four third derivatives over the base cells."""
        lines_u, lines_v = self.lines
        degree_u, degree_v = self.face.surface.degree
        row_size = len(lines_v) * 4 * (degree_u + 1) * (degree_v + 1)
        step = max(1, _NET_NUMBERS // row_size)
        rows = []
        for first in range(0, len(lines_u) - 1, step):
            some = lines_u[first:first + step + 1]
            nets = bezier_nets(self.face.surface.data, some, lines_v)
            rows.append(derivative_bounds(nets, np.diff(some), np.diff(lines_v), 2, 3))
        return np.concatenate(rows)

    def trimmed(self, level: _Level) -> _Level:
        """Nodes that have something inside the loops, shrunk to the box around it.

        What is left of a crossed node has its corners at the ends of clipped edges and at corners of the node; those
        count where an edge in the border zone, which was not clipped, might hide that they are inside.
        """
        if not len(self.edges):
            return level
        through, ends = clip_edges(level.rect[level.owner], self.edges[level.edge], self.margin)
        owner = level.owner[through]
        edge = level.edge[through]
        ends = ends[through]
        crossed = np.zeros(len(level.rect), dtype=bool)
        crossed[owner] = True
        thin = np.asarray((level.half <= 4 * self.margin).any(axis=1))
        kept = crossed | thin
        kept[~kept] = self.face.contains(level.middle[~kept])
        low = np.full((len(kept), 2), np.inf)
        high = np.full((len(kept), 2), -np.inf)
        np.minimum.at(low, owner, ends.min(axis=1))
        np.maximum.at(high, owner, ends.max(axis=1))
        for corner in _CORNERS:
            point = level.rect[:, corner]
            within = crossed.copy()
            within[crossed] = is_near_face(self.face, point[crossed], self.margin)
            low[within] = np.minimum(low, point)[within]
            high[within] = np.maximum(high, point)[within]
        box_low = np.maximum(low - self.margin / 2, level.rect[:, 0::2])
        box_high = np.minimum(high + self.margin / 2, level.rect[:, 1::2])
        box = np.stack([box_low, box_high], axis=2).reshape(-1, 4)
        shrunk = crossed & ~thin
        inner = level._replace(owner=owner, edge=edge)
        return inner.chosen(kept, np.where(shrunk[:, None], box, level.rect))

    def enclose(self, level: _Level) -> tuple[_Enclosures, Flags]:
        """What encloses every node, and which of them need no splitting.

        What is left (e and rest) only counts in single base cells.
        """
        half = level.half
        du = half[:, :1]
        dv = half[:, 1:]
        d = self.face.evaluate(level.middle)
        bounds = self.bounds[level.base[:, 0], level.base[:, 2]]
        e = remainder(bounds, half) + self.extra
        rest = second_remainder(bounds[:, 3:], half) + self.extra
        found = _Enclosures(d.point, d.su * du, d.sv * dv, e, d.suu * du**2, d.suv * du * dv, d.svv * dv**2, rest)
        sides = np.maximum(np.linalg.norm(found.a, axis=1), np.linalg.norm(found.b, axis=1))
        longest = 2 * sides + 2 * e
        flat = e <= _FLAT * self.fineness + self.extra
        followed = rest <= _CURVED * self.fineness + self.extra
        short = longest <= self.face.diagonal / _COARSEST
        shortest = self.fineness + 2 * self.extra  # a face without area has no diagonal
        tiny = longest <= max(self.face.diagonal / _FINEST, shortest)
        crowded = np.bincount(level.owner, minlength=len(half)) > _EDGES
        crowded &= longest > max(self.face.diagonal / _CROWDED, shortest)
        fine = (flat & followed & short) | tiny
        done = (fine & ~crowded) | (len(self.levels) >= _DEEPEST)
        return found, level.single & done

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
            found, ready = self.enclose(level)
            self.levels.append(level)
            self.enclosures.append(found)
            self.ready.append(ready)
            size = np.stack([np.linalg.norm(found.a, axis=1), np.linalg.norm(found.b, axis=1)], axis=1)
            level = self.trimmed(_halve_nodes(level, np.flatnonzero(~ready), size, self.lines))

    def tree(self) -> TreeArrays:
        """Enclosures from the leaves up, numbered from the root down."""
        alive, radius = enclose_parents(self.levels, self.enclosures, self.ready)
        shapes = []
        bends = []
        for every, around, kept in zip(self.enclosures, radius, alive, strict=True):
            found = every.rows(kept)
            shapes.append(np.column_stack([found.q, found.a, found.b, found.e, around[kept]]))
            bends.append(np.column_stack([found.suu, found.suv, found.svv, found.rest]))
        return TreeArrays(np.vstack(shapes), np.vstack(bends), self._links(alive), *self._leaves())

    def _links(self, alive: list[Flags]) -> Indices:
        """Children, face, leaf and whether it is on the face, of each node that holds something."""
        counts = [int(kept.sum()) for kept in alive]
        link = np.full((sum(counts), 5), -1, dtype=np.int64)
        link[:, _FACE] = 0
        offsets = np.cumsum([0, *counts])[:-1]
        numbers = [np.where(kept, np.cumsum(kept) - 1 + offset, -1)
                   for kept, offset in zip(alive, offsets, strict=True)]
        for depth in range(1, len(self.levels)):
            kept = alive[depth]
            child = numbers[depth][kept]
            parent = numbers[depth - 1][self.levels[depth].parent[kept]]
            order = np.argsort(parent, kind="stable")
            child = child[order]
            parent = parent[order]
            first = np.concatenate([[True], np.diff(parent) > 0])
            link[parent[first], _LEFT] = child[first]
            link[parent[~first], _RIGHT] = child[~first]
        ready = np.concatenate([leaf[kept] for leaf, kept in zip(self.ready, alive, strict=True)])
        link[ready, _LEAF] = np.arange(ready.sum())
        middles = []
        crossed = []
        for level, kept in zip(self.levels, alive, strict=True):
            middles.append(level.middle[kept])
            crossed.append(np.bincount(level.owner, minlength=len(kept))[kept] > 0)
        on_face = self.face.contains(np.vstack(middles))
        link[:, _ON_FACE] = on_face * np.where(np.concatenate(crossed), 1, 2)
        return link

    def _leaves(self) -> tuple[Array, Indices, Array]:
        """Rows of the leaves, and their trim edges, leaf by leaf with where each one's begin."""
        rows = []
        edges = []
        counts = []
        for level, ready in zip(self.levels, self.ready, strict=True):
            reference = level.rect[:, 0::2] + 2 * level.half * _REFERENCE
            inside = self.face.contains(reference)
            bounds = self.bounds[level.base[:, 0], level.base[:, 2]]
            extra = np.full(len(bounds), self.extra)
            leaf = np.column_stack([level.middle, level.half, bounds[:, :3], extra, reference, inside, bounds[:, 3:]])
            rows.append(leaf[ready])
            in_leaf = ready[level.owner]
            owner = level.owner[in_leaf]
            edge = level.edge[in_leaf]
            edges.append(self.edges[edge[np.argsort(owner, kind="stable")]])
            counts.append(np.bincount(owner, minlength=len(ready))[ready])
        start = np.concatenate([[0], np.cumsum(np.concatenate(counts))]).astype(np.int64)
        return np.vstack(rows), start, np.vstack(edges)


def _own_rectangle(face: Face) -> Array:
    """u0, u1, v0, v1 around the loops of a face, inside the domain of its surface, (1, 4)."""
    (d0, d1), (e0, e1) = face.surface.domain
    u0, u1, v0, v1 = face.bounds
    rect = np.array([[max(u0, d0), min(u1, d1), max(v0, e0), min(v1, e1)]])
    if not (rect[:, 0::2] < rect[:, 1::2]).all():
        raise InvalidInput(f"face {face.label} has loops around u {u0:g} to {u1:g}, v {v0:g} to {v1:g}, outside "
                           f"its surface's domain {d0:g} to {d1:g}, {e0:g} to {e1:g}: trim it inside")
    return rect


def remainder(bounds: Array, half: Array) -> Array:
    """Greatest distance of a surface from its tangent parallelogram, by Taylor's formula.

    Parameters
    ----------
    bounds : (n, 3) array
        Bounds of |Suu|, |Suv| and |Svv|.
    half : (n, 2) array
        Half widths of the cells.
    """
    du, dv = half.T
    suu, suv, svv = bounds[:, :3].T
    return np.asarray(suu * du**2 / 2 + suv * du * dv + svv * dv**2 / 2)


def second_remainder(bounds: Array, half: Array) -> Array:
    """Greatest distance of a surface from its second-order form, by Taylor's formula.

    Parameters
    ----------
    bounds : (n, 4) array
        Bounds of |Suuu|, |Suuv|, |Suvv| and |Svvv|.
    half : (n, 2) array
        Half widths of the cells.
    """
    du, dv = half.T
    suuu, suuv, suvv, svvv = bounds.T
    return np.asarray((suuu * du**3 + 3 * suuv * du**2 * dv + 3 * suvv * du * dv**2 + svvv * dv**3) / 6)


def enclose_parents(levels: list[_Level], enclosures: list[_Enclosures],
                    ready: list[Flags]) -> tuple[list[Flags], list[Array]]:
    """Write e and rest of the parents; which nodes hold something, and the radius of each around its q.

    Parameters
    ----------
    levels : list of levels, the root first
    enclosures : list of enclosures
        Of the nodes of each level.
    ready : list of (n,) bool arrays
        Which nodes are leaves.

    Notes
    -----
    A child's point is q' + s a' + t b' + d', the parent's own is q + S a + T b at the same parameters; what differs
    is q' - q - S0 a - T0 b, and a' and b' less their shares of a and b.  With the second-order forms it is the
    difference of two quadratic forms, coefficient by coefficient.
    """
    alive = [leaf.copy() for leaf in ready]
    radius = [np.zeros(len(leaf)) for leaf in ready]
    for depth in range(len(levels) - 1, -1, -1):
        own = enclosures[depth]
        tall = ~ready[depth]
        own.e[tall] = 0.0
        own.rest[tall] = 0.0
        around = np.full(len(tall), 0.0)
        if depth + 1 < len(levels):
            kept = np.flatnonzero(alive[depth + 1])
            parent = levels[depth + 1].parent[kept]
            distance = _add_children(levels, enclosures, depth, kept)
            np.maximum.at(around, parent, distance + radius[depth + 1][kept])
        diagonals = np.maximum(np.linalg.norm(own.a + own.b, axis=1), np.linalg.norm(own.a - own.b, axis=1))
        corner = diagonals + own.e
        radius[depth] = np.where(tall, np.minimum(around, corner), corner)
        if depth:
            alive[depth - 1][levels[depth].parent[alive[depth]]] = True
    return alive, radius


def _add_children(levels: list[_Level], enclosures: list[_Enclosures], depth: int, kept: Indices) -> Array:
    """Let e and rest of nodes take in those of their children that are kept; how far q is from the children's, (k,)."""
    up = levels[depth]
    down = levels[depth + 1]
    parent = down.parent[kept]
    child = enclosures[depth + 1].rows(kept)
    own = enclosures[depth].rows(parent)
    half = np.where(up.half[parent] > 0, up.half[parent], 1.0)
    # The child's middle and half widths as shares of its parent's half widths.
    s, t = ((down.middle[kept] - up.middle[parent]) / half).T[:, :, None]
    ks, kt = (down.half[kept] / half).T[:, :, None]
    gap = child.q - own.q
    straight = gap - s * own.a - t * own.b
    off_plane = child.e + _sum_lengths(straight, child.a - ks * own.a, child.b - kt * own.b)
    bent = (s * s * own.suu + 2 * s * t * own.suv + t * t * own.svv) / 2
    slope_a = own.a + s * own.suu + t * own.suv
    slope_b = own.b + s * own.suv + t * own.svv
    off_form = child.rest + _sum_lengths(
        straight - bent, child.a - ks * slope_a, child.b - kt * slope_b,
        (child.suu - ks * ks * own.suu) / 2, child.suv - ks * kt * own.suv, (child.svv - kt * kt * own.svv) / 2)
    np.maximum.at(enclosures[depth].e, parent, off_plane)
    np.maximum.at(enclosures[depth].rest, parent, off_form)
    return np.asarray(np.linalg.norm(gap, axis=1))


def _sum_lengths(*vectors: Array) -> Array:
    return np.asarray(sum(np.linalg.norm(each, axis=1) for each in vectors))


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
