"""Whether a tool at a tip comes nearer to faces than it may: the kernel that walks their trees.

Every piece of a tool is convex, so its signed distance is a convex function of space: over a cell it is nowhere less
than the tangent at the cell's centre says.  That leaves out a cell along a contact although the cell is as near to the
cutter as can be.  What is left of a leaf is halved until a place of the face is too near, or until it is small.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.jit import jit_uncounted, jit_uncounted_inline
from toolaxis.numeric.triples import Triple, dot
from toolaxis.tools.solid import piece_distance

Array = NDArray[np.float64]
Singles = NDArray[np.float32]
Indices = NDArray[np.int64]
Bools = NDArray[np.bool_]

MOST_PIECES = 60
"""Pieces of a tool that are looked at together: one bit of a number each."""
DEEP = 128
"""Nodes, and parts of a leaf, that may wait."""
_SMALL = 0.05
"""Half length of the parts of a leaf that are not halved any more, mm."""
_ENOUGH = 400
"""Parts of a leaf that are looked at, at most: a leaf along a trim edge that nearly touches has many."""
_NO_AXIS = 1e-9
"""Distance from the tool's axis below which there is no direction away from it, mm."""


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


class ReachRoom(NamedTuple):
    """What waits to be looked at, made once for many tips."""

    nodes: Indices
    masks: Indices
    parts: Array

    @staticmethod
    def make() -> "ReachRoom":
        """An empty one."""
        return ReachRoom(np.empty(DEEP, np.int64), np.empty(DEEP, np.int64), np.empty((DEEP, 4)))


@jit_uncounted_inline
def _turn(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> float:
    """Twice the area of a triangle in the plane, positive where it turns to the left."""
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


@jit_uncounted
def _on_face(tree: ReachTree, leaf: int, u: float, v: float) -> bool:
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


@jit_uncounted
def _leaf_hit(tree: ReachTree, node: int, piece: Array, limit: float, w: Triple, axis: Triple, parts: Array) -> bool:
    """Whether a place of a leaf's face is nearer to a piece than the limit.

    Parameters
    ----------
    w : Triple
        The leaf's centre from the tip.
    parts : array
        Room for parts of the leaf: centre and half widths, in halves of the leaf.
    """
    leaf = tree.link[node, 3]
    a, b = _row(tree.shape, node, 3), _row(tree.shape, node, 6)
    saa, sab, sbb = _row(tree.bend, leaf, 0), _row(tree.bend, leaf, 3), _row(tree.bend, leaf, 6)
    trimmed = tree.edge_start[leaf + 1] > tree.edge_start[leaf]
    parts[0, 0], parts[0, 1], parts[0, 2], parts[0, 3] = 0.0, 0.0, 1.0, 1.0
    waiting, looked = 1, 0
    while waiting > 0 and looked < _ENOUGH:
        waiting -= 1
        looked += 1
        s, t, hs, ht = parts[waiting, 0], parts[waiting, 1], parts[waiting, 2], parts[waiting, 3]
        # The place, and its change along s and t.
        ps = (a[0] + s * saa[0] + t * sab[0], a[1] + s * saa[1] + t * sab[1], a[2] + s * saa[2] + t * sab[2])
        pt = (b[0] + s * sab[0] + t * sbb[0], b[1] + s * sab[1] + t * sbb[1], b[2] + s * sab[2] + t * sbb[2])
        x = (w[0] + 0.5 * (s * (a[0] + ps[0]) + t * (b[0] + pt[0])),
             w[1] + 0.5 * (s * (a[1] + ps[1]) + t * (b[1] + pt[1])),
             w[2] + 0.5 * (s * (a[2] + ps[2]) + t * (b[2] + pt[2])))
        z = dot(x, axis)
        rho = np.sqrt(max(dot(x, x) - z * z, 0.0))
        value, along_rho, along_z, _ = piece_distance(piece, rho, z)
        out = along_rho / rho if rho > _NO_AXIS else 0.0
        up = along_z - out * z
        g = (out * x[0] + up * axis[0], out * x[1] + up * axis[1], out * x[2] + up * axis[2])
        less = (hs * abs(dot(ps, g)) + ht * abs(dot(pt, g))
                + 0.5 * (hs * hs * abs(dot(saa, g)) + ht * ht * abs(dot(sbb, g))) + hs * ht * abs(dot(sab, g)))
        if value - less >= limit and rho > _NO_AXIS:
            continue
        # The place is known to Taylor's remainder, which grows with the cube: in contact it must not count as a gouge.
        reach = max(abs(s), abs(t))
        surely = limit - float(tree.bend[leaf, 9]) * reach * reach * reach
        if trimmed:
            u = tree.rect[leaf, 0] + s * tree.rect[leaf, 2]
            v = tree.rect[leaf, 1] + t * tree.rect[leaf, 3]
            inside = _on_face(tree, leaf, u, v)
            half = (hs * tree.rect[leaf, 2], ht * tree.rect[leaf, 3])
            if not inside and not _near_edge(tree, leaf, (u, v), half):
                continue
            if inside and value < surely:
                return True
        elif value < surely:
            return True
        long_s, long_t = hs * hs * dot(ps, ps), ht * ht * dot(pt, pt)
        if max(long_s, long_t) <= _SMALL * _SMALL or waiting + 2 > DEEP:
            continue
        if long_s >= long_t:
            hs *= 0.5
            parts[waiting, 0], parts[waiting, 1] = s - hs, t
            parts[waiting + 1, 0], parts[waiting + 1, 1] = s + hs, t
        else:
            ht *= 0.5
            parts[waiting, 0], parts[waiting, 1] = s, t - ht
            parts[waiting + 1, 0], parts[waiting + 1, 1] = s, t + ht
        parts[waiting, 2], parts[waiting, 3] = hs, ht
        parts[waiting + 1, 2], parts[waiting + 1, 3] = hs, ht
        waiting += 2
    return False


@jit_uncounted
def _pieces_near(tree: ReachTree, tool: ReachTool, node: int, mask: int, w: Triple, axis: Triple) -> int:
    """Which of the pieces of a mask may be too near to a node: a mask of them; -1 where one surely is."""
    face = tree.link[node, 2]
    row = face if face >= 0 else tool.limits.shape[0] - 1
    around, sure = float(tree.shape[node, 10]), tree.link[node, 4] > 0
    z = dot(w, axis)
    rho = np.sqrt(max(dot(w, w) - z * z, 0.0))
    kept = 0
    a, b = _row(tree.shape, node, 3), _row(tree.shape, node, 6)
    za, zb = dot(a, axis), dot(b, axis)
    inverse = 1.0 / rho if rho > _NO_AXIS else 0.0
    ra, rb = (dot(w, a) - z * za) * inverse, (dot(w, b) - z * zb) * inverse
    for p in range(tool.pieces.shape[0]):
        if mask >> p & 1 == 0:
            continue
        piece = tool.pieces[p]
        limit = tool.limits[row, int(piece[7])]
        value, along_rho, along_z, _ = piece_distance(piece, rho, z)
        if value - around >= limit:
            continue
        if sure and value < limit:
            return -1
        less = abs(along_rho * ra + along_z * za) + abs(along_rho * rb + along_z * zb) + float(tree.shape[node, 9])
        if value - less < limit or rho <= _NO_AXIS:
            kept |= 1 << p
    return kept


@jit_uncounted
def _blocker(tree: ReachTree, tool: ReachTool, tip: Triple, axis: Triple, room: ReachRoom, last: int) -> int:
    """A node with a place that is too near to the tool at a tip, -1 without one; the last one is tried first."""
    nodes, masks, parts = room
    every = (1 << tool.pieces.shape[0]) - 1
    nodes[0], masks[0] = 0, every
    waiting = 1
    if last > 0:
        nodes[1], masks[1] = last, every
        waiting = 2
    while waiting > 0:
        waiting -= 1
        node = nodes[waiting]
        q = _row(tree.shape, node, 0)
        w = (q[0] - tip[0], q[1] - tip[1], q[2] - tip[2])
        mask = _pieces_near(tree, tool, node, masks[waiting], w, axis)
        if mask == 0:
            continue
        if mask < 0:
            return int(node)
        leaf = tree.link[node, 3]
        if leaf < 0:
            for child in (tree.link[node, 0], tree.link[node, 1]):
                if child >= 0 and waiting < DEEP:
                    nodes[waiting], masks[waiting] = child, mask
                    waiting += 1
            continue
        row = tree.link[node, 2]
        for p in range(tool.pieces.shape[0]):
            if mask >> p & 1:
                piece = tool.pieces[p]
                if _leaf_hit(tree, node, piece, tool.limits[row, int(piece[7])], w, axis, parts):
                    return int(node)
    return -1


@jit_uncounted
def find_blocked(tree: ReachTree, tool: ReachTool, tips: Array, axes: Array, room: ReachRoom, blocked: Bools) -> None:
    """Whether the tool comes nearer to a face than it may, into blocked (n,), at tips (n, 3) with axes (n, 3)."""
    last = -1
    for i in range(tips.shape[0]):
        tip, axis = (tips[i, 0], tips[i, 1], tips[i, 2]), (axes[i, 0], axes[i, 1], axes[i, 2])
        last = _blocker(tree, tool, tip, axis, room, last)
        blocked[i] = last >= 0
