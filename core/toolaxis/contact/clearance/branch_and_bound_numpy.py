"""The plain twin of `branch_and_bound`: the same bounds on whole arrays of open cells, breadth first."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.ball_bound_numpy import CurvedCells, enclosing_gap_numpy
from toolaxis.contact.clearance.branch_and_bound import BUDGET, DECIDED, ToolData
from toolaxis.contact.clearance.cell_bounds import BETTER
from toolaxis.contact.clearance.relief import relief_over_numpy
from toolaxis.numeric.bspline import surface_derivatives_many_numpy
from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.vectors import dot
from toolaxis.shape.bounding.bounding_tree import BoundingTree
from toolaxis.shape.bounding.build import clip_edges, is_near_face, margin_of, remainder, second_remainder
from toolaxis.shape.face import Face
from toolaxis.tools.solid import piece_distance_numpy

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]

_AT_ONCE = 200_000


class _Front(NamedTuple):
    """Open triples: query, piece, node, whether the cell lies below a leaf, its rectangle, the part of the motion."""

    query: Indices
    piece: Indices
    node: Indices
    below: Flags
    rect: Array
    part: Array

    def take(self, rows: Indices | Flags) -> "_Front":
        """Some of the triples."""
        return _Front(self.query[rows], self.piece[rows], self.node[rows], self.below[rows], self.rect[rows],
                      self.part[rows])


class _Corners(NamedTuple):
    """What trims leave of cells: which of them are cut, and the corners as (cell, share of a, share of b)."""

    cut: Flags
    owner: Indices
    share: Array


class _Cells(NamedTuple):
    """Enclosures: shape (n, 12) with q, a, b, e, radius, extra; bend (n, 10); how much counts as samples; corners."""

    shape: Array
    bend: Array
    real: Indices
    corners: _Corners


def _trim_triples(cells: BoundingTree, front: _Front) -> tuple[_Front, NDArray[np.intp], _Corners]:
    """Triples below leaves less what trims cut away, where they stood, and the corners that are left."""
    leaf = cells.link[front.node, 3]
    count = np.where(front.below, np.diff(cells.edge_start)[leaf], 0)
    owner, number = number_parts(count)
    index = cells.edge_start[leaf][owner] + number
    u, v, du, dv = front.rect.T
    rect = np.stack([u - du, u + du, v - dv, v + dv], axis=1)
    margin = 1e-9 * front.rect[:, 2:]
    through, ends = clip_edges(rect[owner], cells.edges[index], margin[owner])
    cut = np.zeros(len(leaf), dtype=bool)
    cut[owner[through]] = True
    owners = [np.repeat(owner[through], 2)]
    points = [ends[through].reshape(-1, 2)]
    rows = np.flatnonzero(cut)
    for corner in ((0, 2), (0, 3), (1, 2), (1, 3)):
        within = _ask_nodes(cells, front.node[rows], rect[rows][:, corner], _reached)
        owners.append(rows[within])
        points.append(rect[rows[within]][:, corner])
    kept = ~front.below | cut
    rest = np.flatnonzero(~kept)
    kept[rest] = _ask_nodes(cells, front.node[rest], front.rect[rest, :2], Face.contains)
    return _shrunk(front, (cut, kept), np.concatenate(owners), np.concatenate(points))


def _reached(face: Face, uv: Array) -> Flags:
    return is_near_face(face, uv, margin_of(face))


def _ask_nodes(cells: BoundingTree, node: Indices, uv: Array, question: Callable[[Face, Array], Flags]) -> Flags:
    """The answers of the nodes' faces for one parameter each."""
    number = cells.link[node, 2]
    found = np.zeros(len(uv), dtype=bool)
    for k in np.unique(number):
        found[number == k] = question(cells.faces[k], uv[number == k])
    return found


def _shrunk(front: _Front, which: tuple[Flags, Flags], owner: NDArray[np.intp],
            points: Array) -> tuple[_Front, NDArray[np.intp], _Corners]:
    """Triples that are cut shrunk to the corners left of them, and those that are gone taken out."""
    cut, kept = which
    low = np.full((len(cut), 2), np.inf)
    high = np.full((len(cut), 2), -np.inf)
    np.minimum.at(low, owner, points)
    np.maximum.at(high, owner, points)
    middle = (low[cut] + high[cut]) / 2
    half = (high[cut] - low[cut]) / 2 + 1e-9 * front.rect[cut, 2:]
    rect = front.rect.copy()
    rect[cut] = np.hstack([middle, half])
    number = np.cumsum(kept) - 1
    share = (points - rect[owner, :2]) / rect[owner, 2:]
    corners = _Corners(cut[kept], number[owner].astype(np.int64), share)
    return front._replace(rect=rect).take(kept), np.flatnonzero(kept), corners


def _enclose_cells(cells: BoundingTree, front: _Front) -> tuple[_Front, _Cells]:
    """Cells of the triples; those wholly outside the loops are gone."""
    front, _, corners = _trim_triples(cells, front)
    link = cells.link[front.node]
    leaf = cells.leaf[link[:, 3]]
    shape = np.column_stack([cells.shape[front.node], np.where(link[:, 3] >= 0, leaf[:, 7], 0.0)])
    bend = cells.bend[front.node]
    for k in np.unique(link[front.below, 2]):
        rows = np.flatnonzero(front.below & (link[:, 2] == k))
        half = front.rect[rows, 2:]
        du = half[:, :1]
        dv = half[:, 1:]
        extra = leaf[rows, 7]
        d = surface_derivatives_many_numpy(cells.faces[k].surface.data, front.rect[rows, :2])
        q, su, sv, suu, suv, svv = d.swapaxes(0, 1)
        a = su * du
        b = sv * dv
        e = remainder(leaf[rows, 4:7], half) + extra
        rest = second_remainder(leaf[rows, 11:], half) + extra
        radius = np.maximum(np.linalg.norm(a + b, axis=1), np.linalg.norm(a - b, axis=1)) + e
        shape[rows] = np.column_stack([q, a, b, e, radius, extra])
        bend[rows] = np.column_stack([suu * du**2, suv * du * dv, svv * dv**2, rest])
    real = np.where(front.below, np.where(corners.cut, 0, 2), link[:, 4])
    return front, _Cells(shape, bend, real, corners)


class _LocalFrames(NamedTuple):
    """Cells seen from the tip: q, axis, the three directions (n, 3, 3), and the piece of each triple."""

    w: Array
    axis: Array
    span: Array
    piece: Array

    def look(self, at: Array) -> tuple[Array, Array, Array]:
        """phi at shares (n, 3), its slopes along the directions, and its second-order form over them."""
        w = self.w + np.einsum("nk,nkc->nc", at, self.span)
        z = dot(w, self.axis)
        p = w - z[:, None] * self.axis
        rho = np.linalg.norm(p, axis=1)
        scale = np.where(rho > 1e-12, 1 / np.maximum(rho, 1e-12), 0.0)
        p = p * scale[:, None]
        value, rise, climb, bend = piece_distance_numpy(self.piece, rho, z)
        # The directions' parts away from the axis, along it and around it; and across the gradient in the meridian.
        out = np.einsum("nkc,nc->nk", self.span, p)
        up = np.einsum("nkc,nc->nk", self.span, self.axis)
        around = np.einsum("nkc,nc->nk", self.span, np.cross(self.axis, p))
        across = rise[:, None] * up - climb[:, None] * out
        in_meridian = bend[:, None, None] * across[:, :, None] * across[:, None]
        about_axis = (rise * scale)[:, None, None] * around[:, :, None] * around[:, None]
        slopes = rise[:, None] * out + climb[:, None] * up
        return value, slopes, in_meridian + about_axis

    def plane_gap(self, slope_of: Array) -> Array:
        """Gap between the piece's supporting plane and the cell's own plane; -inf where the cell has none."""
        n = np.cross(self.span[:, 0], self.span[:, 1])
        size = np.linalg.norm(n, axis=1)
        n = n / np.where(size > 1e-100, size, 1.0)[:, None]
        n = n * np.where(dot(n, slope_of) > 0, 1.0, -1.0)[:, None]
        climb = dot(n, self.axis)
        rise = np.sqrt(np.maximum(1 - climb**2, 0))
        a, r, cb, sb, low, top, rim, _ = self.piece.T
        by_arc = a * rise + (low + r) * climb + r
        by_rim = rim * rise + top * climb
        support = np.where(cb * climb + sb * rise <= 0, by_arc, by_rim)
        gap = dot(n, self.w) - np.abs(dot(n, self.span[:, 2])) - support
        return np.where(size > 1e-100, gap, -np.inf)

    def inside(self) -> Array:
        """Bound from bottom and side together, and from the axis, for cells whose centre is inside; -inf elsewhere."""
        z = dot(self.w, self.axis)
        p = self.w - z[:, None] * self.axis
        rho = np.linalg.norm(p, axis=1)
        a, r, cb, sb, bottom, _, _, _ = self.piece.T
        up = np.einsum("nkc,nc->nk", self.span, self.axis)
        out = np.einsum("nkc,nc->nk", self.span, p) / np.maximum(rho, 1e-12)[:, None]
        # Distances from bottom and side, and how that from the side changes; that from the bottom changes by -up.
        low = bottom - z
        side = cb * (rho - a) - sb * (z - bottom - r) - r
        slant = cb[:, None] * out - sb[:, None] * up
        climbs = np.abs(up).sum(axis=1)
        least = low - climbs
        for k in range(3):
            # The mean of both, weighted so that it does not change along this direction.
            own_up = up[:, k]
            own_slant = slant[:, k]
            opposite = -own_up * own_slant < 0
            t = np.where(opposite, own_slant / np.where(opposite, own_slant + own_up, 1.0), 1.0)
            fall = np.abs(-t[:, None] * up + (1 - t)[:, None] * slant).sum(axis=1)
            least = np.maximum(least, t * low + (1 - t) * side - fall)
        on_axis, _, climb, _ = piece_distance_numpy(self.piece, np.zeros_like(z), z)
        least = np.maximum(least, on_axis - np.abs(climb) * climbs)
        value, _, _, _ = piece_distance_numpy(self.piece, rho, z)
        return np.where(value < 0, least, -np.inf)

    def outwards(self) -> Array:
        """Gradient of phi at the centres."""
        z = dot(self.w, self.axis)
        p = self.w - z[:, None] * self.axis
        rho = np.linalg.norm(p, axis=1)
        _, rise, climb, _ = piece_distance_numpy(self.piece, rho, z)
        return np.asarray(p * (rise / np.maximum(rho, 1e-12))[:, None] + climb[:, None] * self.axis)


def _nearest(slopes: Array, form: Array) -> Array:
    """Shares in [-1, 1] where the second-order form is about least, by two sweeps."""
    at = np.zeros_like(slopes)
    for _ in range(2):
        for k in range(3):
            stiff = form[:, k, k]
            slope = slopes[:, k] + np.einsum("nj,nj->n", form[:, k], at) - stiff * at[:, k]
            vertex = -slope / np.where(stiff > 0, stiff, 1.0)
            at[:, k] = np.where(stiff > np.abs(slope), vertex, -np.sign(slope))
    return at


def _lowest(slopes: Array, at: Array, corners: _Corners) -> tuple[Array, Array]:
    """Fall of the linear continuation from ``at`` over the cells, and the shares of the lowest corner of cut ones."""
    fall = -(np.abs(slopes) + slopes * at).sum(axis=1)
    share = np.where(slopes > 0, -1.0, 1.0)
    if corners.cut.any():
        owner = corners.owner
        value = np.einsum("nk,nk->n", slopes[owner, :2], corners.share - at[owner, :2])
        order = np.lexsort((value, owner))
        first = order[np.concatenate([[True], np.diff(owner[order]) > 0])]
        cell = owner[first]
        share[cell, :2] = corners.share[first]
        fall[cell] = value[first] - np.abs(slopes[cell, 2]) - (slopes * at)[cell, 2]
    return fall, share


def _curved_bounds(sight: _LocalFrames, found: _Cells, value: Array) -> tuple[Array, Array]:
    """The bounds of `enclosing_gap_numpy` where they are worth a look."""
    lower = np.full(len(value), -np.inf)
    upper = np.full(len(value), np.inf)
    e = found.shape[:, 9]
    radius = found.shape[:, 10]
    rest = found.bend[:, 9]
    worth = ~found.corners.cut & (rest < BETTER * e) & (rest < np.maximum(np.abs(value), radius))
    chosen = CurvedCells(sight.w[worth], sight.axis[worth], sight.span[worth], found.bend[worth], sight.piece[worth])
    lower[worth], upper[worth] = enclosing_gap_numpy(chosen)
    return lower, upper


def _bounds(sight: _LocalFrames, found: _Cells) -> tuple[Array, Array]:
    """Lower bounds of phi over the cells, and values that some of their points do not exceed."""
    e = found.shape[:, 9]
    radius = found.shape[:, 10] + np.linalg.norm(sight.span[:, 2], axis=1)
    cut = found.corners.cut
    zero = np.zeros_like(sight.w)
    value, slopes, form = sight.look(zero)
    fall, share = _lowest(slopes, zero, found.corners)
    lower = np.maximum(value - radius, value + fall - e)
    whole = np.maximum(sight.plane_gap(sight.outwards()), sight.inside()) - e
    lower = np.maximum(lower, np.where(cut, -np.inf, whole))
    at = np.where(cut[:, None], share, _nearest(slopes, form))
    seen, slopes, _ = sight.look(at)
    fall, _ = _lowest(slopes, at, found.corners)
    ball, over = _curved_bounds(sight, found, value)
    # The centre counts where it is a point of the face, and points beside it where all of the cell is.
    at_centre = np.where(found.real > 0, value, np.inf)
    upper = np.where(found.real > 1, np.minimum(value, over), at_centre)
    lower = np.maximum(lower, seen + fall - e)
    return np.maximum(lower, ball), np.where(cut, seen + e, upper)


def _parts(cells: BoundingTree, front: _Front, found: _Cells, sweep: Array) -> _Front:
    """Both halves of every open triple."""
    motion = sweep > found.shape[:, 10]
    branch = ~motion & ~front.below & (cells.link[front.node, 3] < 0)
    a = found.shape[:, 3:6]
    b = found.shape[:, 6:9]
    size = np.stack([np.linalg.norm(a, axis=1), np.linalg.norm(b, axis=1)], axis=1)
    across = np.argmax(size, axis=1)
    leaf = ~motion & ~branch
    halves = []
    for side in (0, 1):
        rect = front.rect.copy()
        part = front.part.copy()
        node = front.node.copy()
        sign = 2 * side - 1
        middle, half = part[motion].T
        part[motion] = np.stack([middle + sign * half / 2, half / 2], axis=1)
        node[branch] = cells.link[front.node[branch], side]
        new = leaf & ~front.below
        rect[new] = cells.leaf[cells.link[front.node[new], 3], :4]
        k = np.flatnonzero(leaf)
        rect[k, 2 + across[k]] /= 2
        rect[k, across[k]] += sign * rect[k, 2 + across[k]]
        halves.append(_Front(front.query, front.piece, node, front.below | leaf, rect, part).take(node >= 0))
    return _Front(*(np.concatenate(pair) for pair in zip(*halves, strict=True)))


class VectorisedBranchAndBound:
    """One question about many motions: what was found so far, and the open triples."""

    def __init__(self, cells: BoundingTree, tool: ToolData, motions: Array, cutoff: Array) -> None:
        self.cells = cells
        self.motions = motions
        self.pieces, self.limits, (_, _, self.resolution), self.relief = tool
        n = len(motions)
        k = len(self.pieces)
        self.least = np.tile(cutoff, (n, 1))
        self.given_up = np.full((n, 3), np.inf)
        self.face = np.full((n, 3), -1)
        self.point = np.zeros((n, 3, 3))
        self.blocked = np.full(n, -1)
        self.looked = np.zeros(n, dtype=np.int64)
        root = np.zeros(n * k, dtype=np.int64)
        whole_motion = np.tile([0.0, 1.0], (n * k, 1))
        self.front = _Front(np.repeat(np.arange(n), k), np.tile(np.arange(k), n), root,
                            np.zeros(n * k, dtype=bool), np.zeros((n * k, 4)), whole_motion)

    def run(self) -> None:
        """Look at all triples until none is open, the last ones first so that few stand at a time."""
        waiting = [self.front]
        while waiting:
            front = waiting.pop()
            if len(front.query) > _AT_ONCE:
                half = len(front.query) // 2
                waiting += [front.take(np.arange(half)), front.take(np.arange(half, len(front.query)))]
                continue
            front = self.step(front)
            if len(front.query):
                waiting.append(front)

    def step(self, front: _Front) -> _Front:
        """Bound every triple; the halves of those that are still open."""
        front = front.take(self.blocked[front.query] < 0)
        front, found = _enclose_cells(self.cells, front)
        if not len(front.query):
            return front
        np.add.at(self.looked, front.query, 1)
        moves = self.motions[front.query]
        tip, way, axis = moves.swapaxes(0, 1)
        middle = front.part[:, :1]
        half = front.part[:, 1:]
        q = found.shape[:, :3]
        span = np.stack([found.shape[:, 3:6], found.shape[:, 6:9], -half * way], axis=1)
        sight = _LocalFrames(q - tip - middle * way, axis, span, self.pieces[front.piece])
        lower, upper = _bounds(sight, found)
        still = self.weigh(front, found, (lower, upper))
        cut = np.isin(np.arange(len(still)), np.flatnonzero(still))
        found = found._replace(shape=found.shape[cut], bend=found.bend[cut])
        return _parts(self.cells, front.take(still), found, np.linalg.norm(span[still, 2], axis=1))

    def weigh(self, front: _Front, found: _Cells, bound: tuple[Array, Array]) -> Flags:
        """Take the bounds of triples into account; which of them stay open."""
        (lower, upper), extra = bound, found.shape[:, 11]
        k = self.pieces[front.piece, 7].astype(int)
        face = self.cells.link[front.node, 2]
        limit = self.limits[face, k]
        asked = limit > -np.inf
        taken_off = relief_over_numpy(self.relief, face, found.shape[:, :3], found.shape[:, 10])
        lower, upper = (np.where(k == 0, np.maximum(bound, np.minimum(bound + off, self.relief[2])), bound)
                        for bound, off in zip((lower, upper), taken_off, strict=True))
        best = np.lexsort((-np.where(asked, upper, np.inf), front.query))
        for row in best[np.flatnonzero(upper[best] < self.least[front.query[best], k[best]])]:
            i, c = front.query[row], k[row]
            if asked[row] and upper[row] < self.least[i, c]:
                self.least[i, c] = upper[row]
                self.face[i, c] = face[row]
                self.point[i, c] = found.shape[row, :3]
        least = self.least[front.query, k]
        wanted = limit
        if self.resolution >= 0:  # as `toolaxis.contact.clearance.branch_and_bound.close_enough` says it
            wanted = least - np.maximum(self.resolution, -0.05 * (least + 0.1)) - extra
        done = lower >= wanted
        over = self.looked[front.query] > BUDGET
        give = asked & (done | over)
        np.minimum.at(self.given_up, (front.query[give], k[give]), lower[give])
        if self.resolution < 0:
            too_near = upper - extra < wanted
            decided = upper - lower - extra < DECIDED
            bad = asked & ~done & (too_near | decided | over)
            self.blocked[front.query[bad]] = k[bad]
            self.face[front.query[bad], k[bad]] = face[bad]
        return np.asarray(asked & ~done & ~over)


def descend_many_numpy(cells: BoundingTree, tool: ToolData, motions: Array, cutoff: Array) -> tuple[Array, Indices]:
    """The plain twin of `toolaxis.contact.clearance.branch_and_bound.descend_many`.

    Parameters
    ----------
    cells : BoundingTree
    tool : tuple
    motions : (n, 3, 3) array
    cutoff : (3,) array

    Returns
    -------
    values : (n, 4, 3) array
    tags : (n, 5) array of int
        As there.
    """
    question = VectorisedBranchAndBound(cells, tool, motions, cutoff)
    question.run()
    lower = np.minimum(question.least, question.given_up)
    values = np.concatenate([lower[:, None], question.point.transpose(0, 2, 1)], axis=1)
    return values, np.column_stack([question.face, question.blocked, question.looked])
