"""Whether a tool at a tip comes nearer to faces than it may: the kernel that walks their trees.

Every piece of a tool is convex, so its signed distance is a convex function of space: over a cell it is nowhere less
than the tangent at the cell's centre says.  That leaves out a cell along a contact although the cell is as near to the
cutter as can be.  In what is left a few steps lead to the place that is nearest to the piece, where the tangent says
most; that it is the nearest one of a leaf that bends more than the cutter is not proven.

Around a contact many cells are as near to the cutter as can be.  Where the lower half of a ball that touches the face
there is known to keep off all, so does what of the tool is inside the ball, and the cells beside it are left out.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.jit import jit_uncounted, jit_uncounted_inline
from toolaxis.numeric.shares import work_on_rows
from toolaxis.numeric.triples import Triple, dot
from toolaxis.tools.solid import piece_distance

Array = NDArray[np.float64]
Singles = NDArray[np.float32]
Indices = NDArray[np.int64]
Bools = NDArray[np.bool_]

MOST_PIECES = 60
"""Pieces of a tool that are looked at together: one bit of a number each."""
TOGETHER, NEAR = 16, 256
"""Tips that share a look at what is near, and nodes that are kept of it, at most."""
DEEP = 128
"""Nodes, and parts of a leaf, that may wait."""
_STEPS, _CLOSE = 5, 0.1
"""Steps towards the nearest place of a part of a leaf, and length of a step that ends them, mm."""
_SMALL, _ENOUGH = 0.05, 200
"""Half length of parts that are not halved any more, mm, and how many of a leaf are looked at: along a trim edge that
nearly touches there are many."""
_CLEAR, _TOO_NEAR, _OPEN = 0, 1, 2
"""What is known of a part of a leaf."""
_NO_AXIS = 1e-9
"""Distance from the tool's axis below which there is no direction away from it, mm."""
_ROUNDING = 1e-6
#: Tips of a share.
_AT_ONCE = 512
"""What is added to distances between tips, mm."""


class ReachTree(NamedTuple):
    """The trees of many faces under one root, as the kernel reads them.

    See `toolaxis.shape.bounding.bounding_tree.BoundingTree`, whose numbers these are.
    """

    shape: Singles
    """q, a, b, e and R of every node, (n, 11)."""
    link: NDArray[np.int32]
    """Left and right child, face, leaf, and whether q is a point of the face, (n, 5)."""
    bend: Singles
    """A, B, C and e' of every leaf, (m, 10)."""
    rect: Array
    """Centre and half widths of every leaf in u and v, a reference point, and whether that is on the face, (m, 7)."""
    edge_start: Indices
    """Trim edges of leaf k are edges[edge_start[k]:edge_start[k + 1]], (m + 1,)."""
    edges: Array
    """u, v of both ends, (k, 4)."""


class ReachTool(NamedTuple):
    """The pieces of a tool, and how near to each face they may come."""

    pieces: Array
    """Rows of `toolaxis.tools.solid.solid_pieces`, (k, 8); the component is a column of `limits`."""
    limits: Array
    """Least signed distance of each component from each face, and in the last row the greatest of them, mm."""
    further: Array
    """By how much more than the cutter each component has to keep off any face, at most, mm; inf where the cutter need
    not keep off all of them, or balls at contacts are of no use."""
    margin: float
    """The greatest size of a limit of the cutter, mm."""

    @staticmethod
    def of(pieces: Array, limits: Array) -> "ReachTool":
        """A tool for which balls at contacts are of no use.

        Parameters
        ----------
        pieces, limits : arrays
        """
        return ReachTool(pieces, limits, np.full(limits.shape[1], np.inf), 0.0)


class ReachTips(NamedTuple):
    """Where a tool stands, and what is known of its cutter there."""

    place: Array
    """Tips, (n, 3) mm."""
    axis: Array
    """Unit vectors, tip to spindle, (n, 3)."""
    normal: Array
    """Unit normals at the contacts, (n, 3)."""
    centre: Array
    """Centres of balls that touch the face, or its allowance, at the contacts, (n, 3) mm."""
    radius: Array
    """Of these balls, whose lower halves keep off all as the cutter has to, (n,) mm; -inf where none is known."""

    @staticmethod
    def of(places: Array, axes: Array) -> "ReachTips":
        """Tips without balls.

        Parameters
        ----------
        places, axes : (n, 3) arrays
        """
        return ReachTips(places, axes, axes, places, np.full(len(places), -np.inf))

    def pick(self, rows: Bools | Indices | slice) -> "ReachTips":
        """Some of the tips.

        Parameters
        ----------
        rows : array of bool or int, or slice
        """
        return ReachTips(self.place[rows], self.axis[rows], self.normal[rows], self.centre[rows], self.radius[rows])


class _Clear(NamedTuple):
    """What the ball at a contact tells, or the balls of a group of tips together."""

    normal: Triple
    turn: float
    """Greatest length of the difference of a normal of the group from this one."""
    above: float
    """Height above the tip along the normal below which the balls' lower halves are, mm."""
    heights: Array
    """By piece, the height above the tip up to which it keeps off what is below that, mm; -inf where it need not."""


class ReachRoom(NamedTuple):
    """What waits to be looked at, made once for many tips."""

    nodes: Indices
    masks: Indices
    parts: Array
    near: Indices
    heights: Array
    above: Array

    @staticmethod
    def make() -> "ReachRoom":
        """An empty one."""
        return ReachRoom(np.empty(NEAR + DEEP + 2, np.int64), np.empty(NEAR + DEEP + 2, np.int64), np.empty((DEEP, 4)),
                         np.empty((NEAR, 2), np.int64), np.empty((TOGETHER + 1, MOST_PIECES)),
                         np.empty(TOGETHER))


@jit_uncounted_inline
def _turn(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> float:
    """Twice the area of a triangle in the plane, positive where it turns to the left."""
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


@jit_uncounted
def is_on_leaf(tree: ReachTree, leaf: int, u: float, v: float) -> bool:
    """Whether a place of a leaf that trim edges cross is on the face: as its reference point, or an odd count away."""
    ru, rv = tree.rect[leaf, 4], tree.rect[leaf, 5]
    inside = tree.rect[leaf, 6] > 0.0
    for k in range(tree.edge_start[leaf], tree.edge_start[leaf + 1]):
        au, av, bu, bv = tree.edges[k, 0], tree.edges[k, 1], tree.edges[k, 2], tree.edges[k, 3]
        first = _turn(ru, rv, u, v, au, av) > 0.0
        second = _turn(ru, rv, u, v, bu, bv) > 0.0
        if first != second and (_turn(au, av, bu, bv, ru, rv) > 0.0) != (_turn(au, av, bu, bv, u, v) > 0.0):
            inside = not inside
    return bool(inside)


@jit_uncounted
def _near_edge(tree: ReachTree, leaf: int, place: tuple[float, float], half: tuple[float, float]) -> bool:
    """Whether a trim edge may run through a rectangle of u and v."""
    for k in range(tree.edge_start[leaf], tree.edge_start[leaf + 1]):
        au, av, bu, bv = tree.edges[k, 0], tree.edges[k, 1], tree.edges[k, 2], tree.edges[k, 3]
        if (min(au, bu) <= place[0] + half[0] and max(au, bu) >= place[0] - half[0]
                and min(av, bv) <= place[1] + half[1] and max(av, bv) >= place[1] - half[1]):
            return True
    return False


@jit_uncounted_inline
def _row(table: Singles, row: int, first: int) -> Triple:
    """Three numbers of a table."""
    return float(table[row, first]), float(table[row, first + 1]), float(table[row, first + 2])


class LeafForm(NamedTuple):
    """A leaf as a tool sees it: w + s a + t b + (s^2 aa + 2 s t ab + t^2 bb) / 2 from the tip, s and t from -1 to 1."""

    w: Triple
    a: Triple
    b: Triple
    aa: Triple
    ab: Triple
    bb: Triple


class LeafPlace(NamedTuple):
    """The distance of a place of a leaf from a piece, and how it changes along s and t."""

    value: float
    slope_s: float
    slope_t: float
    bends: Triple
    """Second derivatives of the face along the gradient: ss, st, tt."""
    form: Triple
    """The same with the curvature of the piece."""
    long_s: float
    """Length of the change of the place with s, mm, and with t."""
    long_t: float


@jit_uncounted_inline
def _along_arc(v: Triple, x: Triple, axis: Triple, at: tuple[float, float, float, float]) -> float:
    """Component of a vector across the gradient in the plane through the tool's axis.

    at : distance from the axis and height of the place, and the slopes of the distance along them.
    """
    rho, z, along_rho, along_z = at
    up = dot(v, axis)
    return along_rho * up - along_z * (dot(v, x) - z * up) / rho


@jit_uncounted
def _look_at(leaf: LeafForm, piece: Array, axis: Triple, s: float, t: float) -> LeafPlace:
    """The distance of a place of a leaf from a piece."""
    w, a, b, aa, ab, bb = leaf
    ps = (a[0] + s * aa[0] + t * ab[0], a[1] + s * aa[1] + t * ab[1], a[2] + s * aa[2] + t * ab[2])
    pt = (b[0] + s * ab[0] + t * bb[0], b[1] + s * ab[1] + t * bb[1], b[2] + s * ab[2] + t * bb[2])
    x = (w[0] + 0.5 * (s * (a[0] + ps[0]) + t * (b[0] + pt[0])),
         w[1] + 0.5 * (s * (a[1] + ps[1]) + t * (b[1] + pt[1])),
         w[2] + 0.5 * (s * (a[2] + ps[2]) + t * (b[2] + pt[2])))
    z = dot(x, axis)
    rho = np.sqrt(max(dot(x, x) - z * z, _NO_AXIS * _NO_AXIS))
    value, along_rho, along_z, bent = piece_distance(piece, rho, z)
    out = along_rho / rho
    up = along_z - out * z
    g = (out * x[0] + up * axis[0], out * x[1] + up * axis[1], out * x[2] + up * axis[2])
    bends = (dot(aa, g), dot(ab, g), dot(bb, g))
    # Half the square of the distance from the piece's centre of curvature, over its radius: its form is one from afar
    # too.  The piece bends along its arc, and around the axis.
    around = bent if piece[0] == 0.0 and bent > 0.0 else out
    place = (rho, z, along_rho, along_z)
    cs, ct = _along_arc(ps, x, axis, place), _along_arc(pt, x, axis, place)
    form = (bends[0] + around * dot(ps, ps) + (bent - around) * cs * cs,
            bends[1] + around * dot(ps, pt) + (bent - around) * cs * ct,
            bends[2] + around * dot(pt, pt) + (bent - around) * ct * ct)
    return LeafPlace(value, dot(ps, g), dot(pt, g), bends, form, np.sqrt(dot(ps, ps)), np.sqrt(dot(pt, pt)))


@jit_uncounted_inline
def _lower(at: LeafPlace, most: tuple[float, float, float, float]) -> float:
    """What the tangent of a convex distance says of a part of a leaf: no place in it is nearer than this.

    most : how far the part goes on down and up in s, and in t
    """
    wide_s, wide_t = max(most[0], most[1]), max(most[2], most[3])
    fall = min(-at.slope_s * most[0], at.slope_s * most[1]) + min(-at.slope_t * most[2], at.slope_t * most[3])
    sink = (0.5 * (min(at.bends[0], 0.0) * wide_s * wide_s + min(at.bends[2], 0.0) * wide_t * wide_t)
            - abs(at.bends[1]) * wide_s * wide_t)
    return float(at.value + fall + sink)


@jit_uncounted_inline
def _step(at: LeafPlace, most: tuple[float, float, float, float]) -> tuple[float, float]:
    """The step within a part towards the nearest place: Newton's, or to the ends where the form has no lowest place."""
    ss, st, tt = at.form
    det = ss * tt - st * st
    if ss > 0.0 and det > 1e-9 * ss * tt:
        ds = (st * at.slope_t - tt * at.slope_s) / det
        dt = (st * at.slope_s - ss * at.slope_t) / det
    else:
        ds = -np.inf if at.slope_s > 0.0 else np.inf
        dt = -np.inf if at.slope_t > 0.0 else np.inf
    return min(max(ds, -most[0]), most[1]), min(max(dt, -most[2]), most[3])


@jit_uncounted
def _part_state(leaf: LeafForm, piece: Array, limits: tuple[float, float], axis: Triple,
                part: tuple[float, float, float, float]) -> tuple[int, float, float]:
    """Whether a part of a leaf is clear of a piece, too near at a place s, t, or open after a few steps.

    limits : least distance, mm, and Taylor's remainder of the leaf
    part : centre and half widths in s and t
    """
    limit, remainder = limits
    ms, mt, hs, ht = part
    s, t = ms, mt
    for _ in range(_STEPS):
        at = _look_at(leaf, piece, axis, s, t)
        most = (s - ms + hs, ms + hs - s, t - mt + ht, mt + ht - t)
        if _lower(at, most) >= limit:
            return _CLEAR, s, t
        # The place is known to Taylor's remainder, which grows with the cube: in contact it must not count as a gouge.
        reach = max(abs(s), abs(t))
        if at.value < limit - remainder * reach * reach * reach:
            return _TOO_NEAR, s, t
        ds, dt = _step(at, most)
        if abs(ds) * at.long_s + abs(dt) * at.long_t < _CLOSE:  # there is nothing nearer around
            return _CLEAR, s, t
        s, t = s + ds, t + dt
    return _OPEN, s, t


@jit_uncounted
def _leaf_hit(tree: ReachTree, node: int, tool: tuple[Array, float], w: Triple, axis: Triple, parts: Array) -> bool:
    """Whether a place of a leaf's face is nearer to a piece than the limit.

    Parameters
    ----------
    tool : array, float
        The piece, and the limit, mm.
    w : Triple
        The leaf's centre from the tip.
    parts : array
        Room for parts of the leaf: centre and half widths, in halves of the leaf.
    """
    leaf = tree.link[node, 3]
    form = LeafForm(w, _row(tree.shape, node, 3), _row(tree.shape, node, 6), _row(tree.bend, leaf, 0),
                    _row(tree.bend, leaf, 3), _row(tree.bend, leaf, 6))
    size_s, size_t = np.sqrt(dot(form.a, form.a)), np.sqrt(dot(form.b, form.b))
    u, v, du, dv = tree.rect[leaf, 0], tree.rect[leaf, 1], tree.rect[leaf, 2], tree.rect[leaf, 3]
    trimmed = tree.edge_start[leaf + 1] > tree.edge_start[leaf]
    limits = tool[1], float(tree.bend[leaf, 9])
    parts[0, 0], parts[0, 1], parts[0, 2], parts[0, 3] = 0.0, 0.0, 1.0, 1.0
    waiting, looked = 1, 0
    while waiting > 0 and looked < _ENOUGH:
        waiting -= 1
        looked += 1
        ms, mt, hs, ht = parts[waiting, 0], parts[waiting, 1], parts[waiting, 2], parts[waiting, 3]
        state, s, t = _part_state(form, tool[0], limits, axis, (ms, mt, hs, ht))
        if state == _CLEAR:
            continue
        if state == _TOO_NEAR and (not trimmed or is_on_leaf(tree, leaf, u + s * du, v + t * dv)):
            return True
        if trimmed and not _near_edge(tree, leaf, (u + ms * du, v + mt * dv), (hs * du, ht * dv)):
            if not is_on_leaf(tree, leaf, u + ms * du, v + mt * dv):
                continue
        if max(hs * size_s, ht * size_t) <= _SMALL or waiting + 2 > DEEP:
            continue
        along = hs * size_s >= ht * size_t
        hs, ht = (0.5 * hs, ht) if along else (hs, 0.5 * ht)
        for k in range(2):
            way = 2.0 * k - 1.0
            parts[waiting, 0], parts[waiting, 1] = (ms + way * hs, mt) if along else (ms, mt + way * ht)
            parts[waiting, 2], parts[waiting, 3] = hs, ht
            waiting += 1
    return False


@jit_uncounted
def _pieces_near(tree: ReachTree, tool: ReachTool, node: int, mask: int, w: Triple, axis: Triple,
                 slack: float, clear: _Clear) -> int:
    """Which of the pieces of a mask may be too near to a node: a mask of them; -1 where one surely is.

    slack : how far the tip may be from where it is said to be, mm
    """
    face = tree.link[node, 2]
    row = face if face >= 0 else tool.limits.shape[0] - 1
    around, sure = float(tree.shape[node, 10]) + slack, tree.link[node, 4] > 0
    z, far = dot(w, axis), dot(w, w)
    rho = np.sqrt(max(far - z * z, 0.0))
    below = dot(w, clear.normal) + clear.turn * np.sqrt(far) + around <= clear.above
    kept, first = 0, True
    za, zb, ra, rb, rest = 0.0, 0.0, 0.0, 0.0, 0.0
    for p in range(tool.pieces.shape[0]):
        if mask >> p & 1 == 0 or (below and z + around <= clear.heights[p]):
            continue
        piece = tool.pieces[p]
        limit = tool.limits[row, int(piece[7])]
        wide = max(piece[0] + piece[1], piece[6])
        if max(piece[4] - z, z - piece[5], rho - wide) - around >= limit:  # most pieces are far away
            continue
        value, along_rho, along_z, _ = piece_distance(piece, rho, z)
        if value - around >= limit:
            continue
        if sure and value + slack < limit:
            return -1
        if first and rho > _NO_AXIS:
            a, b = _row(tree.shape, node, 3), _row(tree.shape, node, 6)
            za, zb = dot(a, axis), dot(b, axis)
            ra, rb = (dot(w, a) - z * za) / rho, (dot(w, b) - z * zb) / rho
            first, rest = False, float(tree.shape[node, 9]) + slack
        less = abs(along_rho * ra + along_z * za) + abs(along_rho * rb + along_z * zb) + rest
        if value - less < limit or rho <= _NO_AXIS:
            kept |= 1 << p
    return kept


@jit_uncounted
def _gather_near(tree: ReachTree, tool: ReachTool, tip: Triple, axis: Triple, slack: float, clear: _Clear,
                 room: ReachRoom) -> int:
    """Nodes that any tip within a distance may be too near to, into the room; how many, or -1 where all surely are.

    clear : what is known of the cutter at all of these tips
    """
    nodes, masks = room.nodes, room.masks
    nodes[0], masks[0] = 0, (1 << tool.pieces.shape[0]) - 1
    waiting, found = 1, 0
    while waiting > 0:
        waiting -= 1
        node, mask = nodes[waiting], masks[waiting]
        q = _row(tree.shape, node, 0)
        w = (q[0] - tip[0], q[1] - tip[1], q[2] - tip[2])
        mask = _pieces_near(tree, tool, node, mask, w, axis, slack, clear)
        if mask == 0:
            continue
        if mask < 0:
            return -1
        if tree.link[node, 3] >= 0 or float(tree.shape[node, 10]) <= slack:
            if found == NEAR:  # too many to be of use
                room.near[0, 0], room.near[0, 1] = 0, (1 << tool.pieces.shape[0]) - 1
                return 1
            room.near[found, 0], room.near[found, 1] = node, mask
            found += 1
            continue
        for child in (tree.link[node, 0], tree.link[node, 1]):
            if child >= 0 and waiting < DEEP:
                nodes[waiting], masks[waiting] = child, mask
                waiting += 1
    return found


@jit_uncounted
def _blocker(tree: ReachTree, tool: ReachTool, tip: Triple, axis: Triple, clear: _Clear, room: ReachRoom,
             begin: tuple[int, int]) -> int:
    """A node with a place that is too near to the tool at a tip, -1 without one.

    begin : how many nodes were gathered, and the one that is tried first, -1 for none
    """
    nodes, masks, parts = room.nodes, room.masks, room.parts
    waiting = begin[0]
    for k in range(waiting):
        nodes[k], masks[k] = room.near[k, 0], room.near[k, 1]
    if begin[1] > 0:
        nodes[waiting], masks[waiting] = begin[1], (1 << tool.pieces.shape[0]) - 1
        waiting += 1
    while waiting > 0:
        waiting -= 1
        node = nodes[waiting]
        q = _row(tree.shape, node, 0)
        w = (q[0] - tip[0], q[1] - tip[1], q[2] - tip[2])
        mask = _pieces_near(tree, tool, node, masks[waiting], w, axis, 0.0, clear)
        if mask == 0:
            continue
        if mask < 0:
            return int(node)
        leaf = tree.link[node, 3]
        if leaf < 0:
            for child in (tree.link[node, 0], tree.link[node, 1]):
                if child >= 0 and waiting < NEAR + DEEP:
                    nodes[waiting], masks[waiting] = child, mask
                    waiting += 1
            continue
        row = tree.link[node, 2]
        for p in range(tool.pieces.shape[0]):
            if mask >> p & 1:
                piece = tool.pieces[p]
                if _leaf_hit(tree, node, (piece, tool.limits[row, int(piece[7])]), w, axis, parts):
                    return int(node)
    return -1


@jit_uncounted
def _group_end(axes: Array, first: int) -> int:
    """Behind the last of the tips from one on that have its axis, so many at most that they go together."""
    end = first + 1
    while end < min(axes.shape[0], first + TOGETHER):
        if axes[end, 0] != axes[first, 0] or axes[end, 1] != axes[first, 1] or axes[end, 2] != axes[first, 2]:
            break
        end += 1
    return end


@jit_uncounted
def _middle(rows: Array, first: int, end: int) -> tuple[Triple, float]:
    """The mean of some rows (n, 3), and how far they are from it at most."""
    x, y, z = 0.0, 0.0, 0.0
    for i in range(first, end):
        x, y, z = x + rows[i, 0] / (end - first), y + rows[i, 1] / (end - first), z + rows[i, 2] / (end - first)
    far = 0.0
    for i in range(first, end):
        far = max(far, (rows[i, 0] - x) ** 2 + (rows[i, 1] - y) ** 2 + (rows[i, 2] - z) ** 2)
    return (x, y, z), np.sqrt(far)


@jit_uncounted_inline
def _row_of(rows: Array, k: int) -> Triple:
    """A row of (n, 3) numbers."""
    return rows[k, 0], rows[k, 1], rows[k, 2]


@jit_uncounted
def _find_clear(tool: ReachTool, tips: ReachTips, k: int, heights: Array) -> float:
    """How high above the tip each piece of a tool is inside the ball at a contact, into (pieces,), mm; how high above
    the tip along the normal the middle of the ball is, less the margin, mm.

    What lies below both heights is no nearer to the piece than it may be.  A piece is inside from its lower end up to
    a disc where the farthest places of that end and of the disc's rim are.
    """
    centre, radius = _row_of(tips.centre, k), tips.radius[k]
    tip, axis = _row_of(tips.place, k), _row_of(tips.axis, k)
    w = (centre[0] - tip[0], centre[1] - tip[1], centre[2] - tip[2])
    z = dot(w, axis)
    aside = np.sqrt(max(dot(w, w) - z * z, 0.0))
    heights[:] = -np.inf
    if radius <= 0.0:
        return -np.inf
    for p in range(tool.pieces.shape[0]):
        piece = tool.pieces[p]
        component = int(piece[7])
        inner = radius - tool.further[component]
        corner, low = piece[1], piece[4]
        if np.sqrt((aside + piece[0]) ** 2 + (low + corner - z) ** 2) + corner > inner + _ROUNDING:
            continue
        heights[p] = low + corner * (1.0 - piece[3])
        rim = aside + piece[6]
        if rim <= inner:
            heights[p] = max(heights[p], z + np.sqrt(inner * inner - rim * rim))
        heights[p] -= max(tool.limits[tool.limits.shape[0] - 1, component], 0.0)
    return dot(w, _row_of(tips.normal, k)) - tool.margin


@jit_uncounted
def _gather_for(tree: ReachTree, tool: ReachTool, tips: ReachTips, group: tuple[int, int], room: ReachRoom) -> int:
    """What `_gather_near` says for a group of tips with one axis, from one on and before another."""
    first, end = group
    tip, slack = _middle(tips.place, first, end)
    normal, turn = _middle(tips.normal, first, end)
    least, heights = np.inf, room.heights[TOGETHER]
    heights[:] = np.inf
    for i in range(end - first):
        least = min(least, room.above[i])
        for p in range(tool.pieces.shape[0]):
            heights[p] = min(heights[p], room.heights[i, p])
    clear = _Clear(normal, turn, least, heights)
    return int(_gather_near(tree, tool, tip, _row_of(tips.axis, first), slack + _ROUNDING, clear, room))


@jit_uncounted
def find_blocked(tree: ReachTree, tool: ReachTool, tips: ReachTips, room: ReachRoom, blocked: Bools) -> None:
    """Whether the tool comes nearer to a face than it may at n tips, into blocked (n,).

    Tips beside each other with one axis share a look at what is near to any of them.
    """
    last, first = -1, 0
    while first < tips.place.shape[0]:
        end = _group_end(tips.axis, first)
        for i in range(first, end):
            room.above[i - first] = _find_clear(tool, tips, i, room.heights[i - first])
        if end == first + 1:
            found = 1
            room.near[0, 0], room.near[0, 1] = 0, (1 << tool.pieces.shape[0]) - 1
        else:
            found = _gather_for(tree, tool, tips, (first, end), room)
        for i in range(first, end):
            if found > 0:
                clear = _Clear(_row_of(tips.normal, i), 0.0, room.above[i - first], room.heights[i - first])
                last = _blocker(tree, tool, _row_of(tips.place, i), _row_of(tips.axis, i), clear, room, (found, last))
            blocked[i] = found < 0 or (found > 0 and last >= 0)
        first = end


def find_blocked_tips(tree: ReachTree, tool: ReachTool, tips: ReachTips) -> Bools:
    """Whether the tool comes nearer to a face than it may at n tips, (n,).

    Parameters
    ----------
    tree : ReachTree
    tool : ReachTool
    tips : ReachTips
    """
    blocked = np.zeros(len(tips.place), dtype=bool)

    def _find(some: slice) -> None:
        find_blocked(tree, tool, tips.pick(some), ReachRoom.make(), blocked[some])

    work_on_rows(_find, len(blocked), _AT_ONCE)
    return blocked
