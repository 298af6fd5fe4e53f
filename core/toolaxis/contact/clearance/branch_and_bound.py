"""Branch and bound over trees of cells: how near a tool comes to faces, or whether it stays far enough away."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.cell_bounds import bound_over_cell, bound_over_region
from toolaxis.contact.clearance.local_frame import Bend, look, row
from toolaxis.contact.clearance.relief import Relief, relieve_bounds
from toolaxis.contact.clearance.trimmed_cells import trim_cell
from toolaxis.numeric.bspline import surface_derivatives
from toolaxis.numeric.jit import borrowed, jit, jit_fma_inline
from toolaxis.numeric.triples import Triple, dot
from toolaxis.shape.bounding.bounding_tree import ForestData
from toolaxis.tools.solid import piece_distance

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

BUDGET = 100_000
DECIDED = 1e-6
DEPTH = 2048
TREE, WHOLE, CUT = 0, 1, 2
#: Motions that follow each other are looked at together first: how many at least and at most, how far the ball around
#: them may reach, as a share of the tool's greatest radius, and nodes of the tree that may stay open for them.
_FEWEST, _MOST, _REACH, _OPEN = 3, 32, 0.2, 128
HALVE_U, HALVE_V, HALVE_MOTION, BRANCH, START = 0, 1, 2, 3, 4

# pieces (k, 8); limits (faces + 1, 3): what each component must keep, -inf where it is not asked, the last row for
# nodes above faces; height of the tool's lower end, its greatest radius, resolution (negative: only decide); what is
# taken off the cutter's depth near edges
ToolData: TypeAlias = tuple[Array, Array, tuple[float, float, float], Relief]
# region (k, 2), derivatives (6, 3), spline scratch (6, 26)
Work: TypeAlias = tuple[Array, Array, Array]
# items (DEPTH, 7): u, v, du, dv, middle and half of the motion, lowest bound; tags (DEPTH, 4): node, kind, pieces, what
# is to be halved
Stack: TypeAlias = tuple[Array, Indices]
# found (5, 3): least phi seen and least bound given up, by component, and the nearest points; tags (5,): faces, then
# the component found too near (-1: none), and cells looked at
State: TypeAlias = tuple[Array, Indices]
# nodes and open pieces (n, 2) that count for motions close together, and the lowest of their bounds (n,)
Bunch: TypeAlias = tuple[Indices, Array]
# region, derivatives, spline scratch; items, tags; found, tags of the answer; nodes, bounds of a bunch
Room: TypeAlias = tuple[Array, Array, Array, Array, Indices, Array, Indices, Indices, Array]
# tip half-way, half of its way (zero for a standing tool), axis
Motion: TypeAlias = tuple[Triple, Triple, Triple]
# q, a, b; e, radius, and what of e no splitting removes; the second-order form
Cell: TypeAlias = tuple[Triple, Triple, Triple, Triple, Bend]
# u, v, du, dv, middle and half of the motion
Item: TypeAlias = tuple[float, float, float, float, float, float]


@jit_fma_inline
def close_enough(least: float, resolution: float) -> float:
    """The bound that need not be improved: beyond a depth of 0.1 mm a twentieth of what is deeper may be lost.

    Parameters
    ----------
    least, resolution : float
        mm
    """
    return least - max(resolution, -0.05 * (least + 0.1))


@jit_fma_inline
def examine(tool: ToolData, cell: Cell, motion: Motion, region: Array,
            tag: tuple[int, int, int, int, float, float], state: State) -> tuple[int, float]:
    """Which pieces are still open over one cell, and the lowest of their bounds.

    Parameters
    ----------
    tool, cell, motion, state
        See the aliases.
    region : (k, 2) array
        Corners of what trims leave.
    tag : (int, int, int, int, float, float)
        Face, open pieces as bits, whether the centre (1) or all of the cell (2) is known to be of the face, corners
        that trims leave, and the part of the motion.
    """
    pieces, limits, (low, wide, resolution), relief = tool
    (q, a, b, (e, radius, extra), bend), (tip, way, axis) = cell, motion
    face, mask, real, count, middle, half = tag
    found, tags = state
    c = (-half * way[0], -half * way[1], -half * way[2])
    w = (q[0] - tip[0] - middle * way[0], q[1] - tip[1] - middle * way[1], q[2] - tip[2] - middle * way[2])
    frame, view = (w, axis, a, b, c), look(w, axis)
    ball = radius
    radius += np.sqrt(dot(c, c))
    outside = max(low - view[1], view[0] - wide) - radius
    left, key = 0, np.inf
    tags[4] += 1
    for p in range(pieces.shape[0]):
        if not mask & (1 << p):
            continue
        k = int(pieces[p, 7])
        wanted = limits[face, k]
        if wanted == -np.inf:
            continue
        if resolution >= 0.0:
            wanted = close_enough(found[0, k], resolution) - extra
        if outside >= wanted:
            found[1, k] = min(found[1, k], outside)
            continue
        piece = (pieces[p, 0], pieces[p, 1], pieces[p, 2], pieces[p, 3], pieces[p, 4], pieces[p, 5], pieces[p, 6])
        if count == 0:
            lower, upper = bound_over_cell(frame, piece, view, bend, (e, radius, wanted))
            if real == 1:
                upper = piece_distance(piece, view[0], view[1])[0]
            elif real == 0:
                upper = np.inf
        else:
            lower, upper = bound_over_region(frame, piece, (e, radius, wanted), region, count)
        if k == 0 and relief[0].shape[0] > 0 and (lower < wanted or upper < found[0, k]):
            lower, upper = relieve_bounds(relief, (face, q, ball), (lower, upper, wanted))
        if upper < found[0, k]:
            found[0, k], found[2, k], found[3, k], found[4, k] = upper, q[0], q[1], q[2]
            tags[k] = face
        if lower >= wanted:
            found[1, k] = min(found[1, k], lower)
        elif resolution < 0.0 and (upper - extra < wanted or upper - lower - extra < DECIDED):
            tags[3], tags[k] = k, face
            return 0, lower
        else:
            left |= 1 << p
            key = min(key, lower)
    return left, key


@jit_fma_inline
def tree_cell(shape: Array, node: int) -> Cell:
    """Enclosure of a node of the tree.

    Parameters
    ----------
    shape : (n, 22) array
    node : int
    """
    bend = row(shape, node, 12), row(shape, node, 15), row(shape, node, 18), shape[node, 21]
    return row(shape, node, 0), row(shape, node, 3), row(shape, node, 6), row(shape, node, 9), bend


@jit_fma_inline
def part_cell(data: ForestData, node: int, rect: tuple[float, float, float, float], work: Work) -> Cell:
    """Enclosure of a part of a leaf.

    Parameters
    ----------
    data : tuple
        The forest.
    node : int
        The leaf's node.
    rect : (float, float, float, float)
        Centre and half widths of the part.
    work : tuple
    """
    _, link, leaf, _, _, knots, control, layout = data
    u, v, du, dv = rect
    face, number = link[node, 2], link[node, 3]
    k0, nu, nv, c0 = layout[face, 0], layout[face, 1], layout[face, 2], layout[face, 3]
    mu, mv, pu, pv = layout[face, 4], layout[face, 5], layout[face, 6], layout[face, 7]
    surface_derivatives((knots[k0:k0 + nu], knots[k0 + nu:k0 + nu + nv],
                         control[c0:c0 + mu * mv * 4].reshape((mu, mv, 4)), pu, pv, layout[face, 8] != 0),
                        u, v, work[1], work[2])
    d = work[1]
    a, b = (d[1, 0] * du, d[1, 1] * du, d[1, 2] * du), (d[2, 0] * dv, d[2, 1] * dv, d[2, 2] * dv)
    extra = leaf[number, 7]
    e = leaf[number, 4] * du * du / 2.0 + leaf[number, 5] * du * dv + leaf[number, 6] * dv * dv / 2.0 + extra
    radius = np.sqrt(dot(a, a) + dot(b, b) + 2.0 * abs(dot(a, b))) + e
    rest = (leaf[number, 11] * du * du * du + 3.0 * (leaf[number, 12] * du + leaf[number, 13] * dv) * du * dv
            + leaf[number, 14] * dv * dv * dv) / 6.0 + extra
    bend = ((d[3, 0] * du * du, d[3, 1] * du * du, d[3, 2] * du * du),
            (d[4, 0] * du * dv, d[4, 1] * du * dv, d[4, 2] * du * dv),
            (d[5, 0] * dv * dv, d[5, 1] * dv * dv, d[5, 2] * dv * dv), rest)
    return row(d, 0, 0), a, b, (e, radius, extra), bend


@jit_fma_inline
def choose_split(cell: Cell, motion: Motion, half: float, branch: bool) -> int:
    """What is to be halved of an open cell: u, v, the motion, or the branch of the tree.

    Parameters
    ----------
    cell, motion : tuples
    half : float
        Half of the part of the motion.
    branch : bool
        Whether the cell is an inner node of the tree.
    """
    if half * half * dot(motion[1], motion[1]) > cell[3][1] ** 2:
        return HALVE_MOTION
    if branch:
        return BRANCH
    return HALVE_U if dot(cell[1], cell[1]) >= dot(cell[2], cell[2]) else HALVE_V


@jit_fma_inline
def part(data: ForestData, entry: tuple[int, int, int], item: Item, side: int) -> tuple[int, int, Item]:
    """One of the two parts of a cell or of its motion.

    Parameters
    ----------
    data : tuple
        The forest.
    entry : (int, int, int)
        Node, kind, and what is halved.
    item : tuple
    side : int
        0 or 1.

    Returns
    -------
    node, kind : int
        Node -1 where there is no such part.
    item : tuple
    """
    _, link, leaf, start, _, _, _, _ = data
    node, kind, across = entry
    u, v, du, dv, middle, half = item
    sign = 2.0 * side - 1.0
    if across == START:
        return node, kind, item
    if across == BRANCH:
        return link[node, side], kind, item
    if across == HALVE_MOTION:
        return node, kind, (u, v, du, dv, middle + sign * half / 2.0, half / 2.0)
    if kind == TREE:
        number = link[node, 3]
        kind = CUT if start[number + 1] > start[number] else WHOLE
        u, v, du, dv = leaf[number, 0], leaf[number, 1], leaf[number, 2], leaf[number, 3]
    if across == HALVE_U:
        return node, kind, (u + sign * du / 2.0, v, du / 2.0, dv, middle, half)
    return node, kind, (u, v + sign * dv / 2.0, du, dv / 2.0, middle, half)


@jit_fma_inline
def admit(data: ForestData, tool: ToolData, motion: Motion, tag: tuple[int, int, int, Item], stack: Stack, depth: int,
          work: Work, state: State) -> int:
    """Look at one cell and put it on the stack if it is still open; the new depth of the stack.

    Parameters
    ----------
    data, tool, motion, stack, work, state
        See the aliases.
    tag : (int, int, int, tuple)
        Node, kind, open pieces, and the item.
    depth : int
    """
    shape, link, leaf, start, edges, _, _, _ = data
    items, tags = stack
    node, kind, mask, (u, v, du, dv, middle, half) = tag
    face, number, real, count = link[node, 2], link[node, 3], link[node, 4], 0
    if kind == TREE:
        cell = tree_cell(shape, node)
    else:
        if kind == CUT:
            count, u, v, du, dv = trim_cell(edges[start[number]:start[number + 1]], leaf[number, 8:11],
                                            (u, v, du, dv), work[0])
            if count < 0:
                return depth
            if count == 0:
                kind = WHOLE
        cell = part_cell(data, node, (u, v, du, dv), work)
        real = 2 if kind == WHOLE else 0
    left, key = examine(tool, cell, motion, work[0], (face, mask, real, count, middle, half), state)
    if left != 0:
        items[depth, 0], items[depth, 1], items[depth, 2], items[depth, 3] = u, v, du, dv
        items[depth, 4], items[depth, 5], items[depth, 6] = middle, half, key
        tags[depth, 0], tags[depth, 1], tags[depth, 2] = node, kind, left
        tags[depth, 3] = choose_split(cell, motion, half, kind == TREE and number < 0)
        depth += 1
    return depth


@jit_fma_inline
def is_decided(tool: ToolData, state: State, mask: int, key: float) -> bool:
    """Whether what was found since makes a waiting cell needless; its bound is then taken into account.

    Parameters
    ----------
    tool, state : tuples
    mask : int
        Open pieces of the cell.
    key : float
        The lowest of their bounds.
    """
    pieces, found, resolution = tool[0], state[0], tool[2][2]
    if resolution < 0.0:
        return False
    for p in range(pieces.shape[0]):
        if mask & (1 << p) and key < close_enough(found[0, int(pieces[p, 7])], resolution):
            return False
    give_up(tool, state, mask, key)
    return True


@jit_fma_inline
def give_up(tool: ToolData, state: State, mask: int, key: float) -> None:
    """Take the bound of a cell into account without looking further into it.

    Parameters
    ----------
    tool, state : tuples
    mask : int
        Open pieces of the cell.
    key : float
        The lowest of their bounds.
    """
    pieces, found = tool[0], state[0]
    for p in range(pieces.shape[0]):
        if mask & (1 << p):
            k = int(pieces[p, 7])
            found[1, k] = min(found[1, k], key)
            if tool[2][2] < 0.0:
                state[1][3] = k


@jit_fma_inline
def exchange(stack: Stack, low: int) -> None:
    """Exchange two neighbouring entries of the stack.

    Parameters
    ----------
    stack : tuple
    low : int
        The lower of the two.
    """
    items, tags = stack
    for k in range(7):
        items[low, k], items[low + 1, k] = items[low + 1, k], items[low, k]
    for k in range(4):
        tags[low, k], tags[low + 1, k] = tags[low + 1, k], tags[low, k]


@jit_fma_inline
def find_bunch(motions: Array, first: int, most: float) -> tuple[int, Triple, float]:
    """Motions from one on that stay together: where the next begin, and the ball around their tips.

    Parameters
    ----------
    motions : (n, 3, 3) array
    first : int
    most : float
        How far the ball may reach, mm.
    """
    low = high = row(motions[first], 0, 0)
    axis = row(motions[first], 2, 0)
    last, reach = first, 0.0
    while last < motions.shape[0] and last - first < _MOST:
        (x, y, z), (a, b, c) = row(motions[last], 0, 0), row(motions[last], 1, 0)
        a, b, c = abs(a), abs(b), abs(c)
        lower = (min(low[0], x - a), min(low[1], y - b), min(low[2], z - c))
        upper = (max(high[0], x + a), max(high[1], y + b), max(high[2], z + c))
        across = (upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2])
        wider = np.sqrt(dot(across, across)) / 2.0
        if wider > most or row(motions[last], 2, 0) != axis:
            break
        low, high, reach, last = lower, upper, wider, last + 1
    return max(last, first + 1), ((low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, (low[2] + high[2]) / 2.0), reach


@jit_fma_inline
def pieces_in_reach(tool: ToolData, cell: Cell, ball: tuple[Triple, float, Triple], tag: tuple[int, int],
                    cutoff: Array) -> tuple[int, float]:
    """Which pieces a cell counts for at any tip in a ball, and the lowest of their bounds there.

    A distance changes by no more than the tip moves: what is as far from the tool in the middle of the ball as is asked
    for, and its radius farther, counts for none.

    Parameters
    ----------
    tool, cell
        See the aliases.
    ball : tuple
        Middle, radius in mm, and the axis of all motions.
    tag : (int, int)
        Face, and the pieces that are asked for as bits.
    cutoff : (3,) array
        By component the value from which distances are not told apart, mm.
    """
    pieces, limits, (low, wide, resolution), _ = tool
    (q, a, b, (e, radius, _), bend), (tip, reach, axis), (face, mask) = cell, ball, tag
    w = (q[0] - tip[0], q[1] - tip[1], q[2] - tip[2])
    frame, view = (w, axis, a, b, (0.0, 0.0, 0.0)), look(w, axis)
    outside = max(low - view[1], view[0] - wide) - radius
    left, key = 0, np.inf
    for p in range(pieces.shape[0]):
        k = int(pieces[p, 7])
        wanted = limits[face, k]
        if not mask & (1 << p) or wanted == -np.inf:
            continue
        if resolution >= 0.0:
            wanted = cutoff[k]
        wanted += reach
        if outside >= wanted:
            continue
        piece = (pieces[p, 0], pieces[p, 1], pieces[p, 2], pieces[p, 3], pieces[p, 4], pieces[p, 5], pieces[p, 6])
        lower = bound_over_cell(frame, piece, view, bend, (e, radius, wanted))[0]
        if lower < wanted:
            left |= 1 << p
            key = min(key, lower - reach)
    return left, key


@jit_fma_inline
def keep_in_order(bunch: Bunch, count: int, node: int, left: int, key: float) -> None:
    """Add a node to those of a bunch, the nearest last.

    Parameters
    ----------
    bunch : tuple
        See the aliases.
    count : int
        How many nodes it has.
    node, left : int
        The node and its open pieces.
    key : float
        The lowest of their bounds, mm.
    """
    nodes, keys = bunch
    place = count
    while place > 0 and keys[place - 1] < key:
        nodes[place, 0], nodes[place, 1] = nodes[place - 1, 0], nodes[place - 1, 1]
        keys[place] = keys[place - 1]
        place -= 1
    nodes[place, 0], nodes[place, 1], keys[place] = node, left, key


@jit_fma_inline
def gather_open(data: ForestData, tool: ToolData, ball: tuple[Triple, float, Triple], cutoff: Array, stack: Stack,
                bunch: Bunch) -> tuple[int, int]:
    """The nodes of the tree that count for any motion in a ball, as many as there are, and how many were looked at.

    Parameters
    ----------
    data, tool, stack
        See the aliases.
    ball, cutoff
        As for `pieces_in_reach`.
    bunch : tuple
        Receives the nodes, the nearest last; where there are more than it holds, their number is -1.
    """
    shape, link, tags = data[0], data[1], stack[1]
    tags[0, 0], tags[0, 2] = 0, (1 << tool[0].shape[0]) - 1
    depth, count, looked = 1, 0, 0
    while depth > 0:
        depth -= 1
        node, mask = tags[depth, 0], tags[depth, 2]
        cell = tree_cell(shape, node)
        left, key = pieces_in_reach(tool, cell, ball, (link[node, 2], mask), cutoff)
        looked += 1
        if left == 0:
            continue
        if link[node, 3] < 0 and cell[3][1] > ball[1]:  # a branch that is larger than the ball
            for side in range(2):
                if link[node, side] >= 0:
                    tags[depth, 0], tags[depth, 2] = link[node, side], left
                    depth += 1
        elif count == bunch[1].shape[0]:
            return -1, looked
        else:
            keep_in_order(bunch, count, node, left, key)
            count += 1
    return count, looked


@jit_fma_inline
def begin(pieces: int, bunch: Bunch, count: int, stack: Stack) -> int:
    """Put on the stack what there is to look at, the nearest on top; its depth.

    Parameters
    ----------
    pieces : int
        How many the tool has.
    bunch, stack
        See the aliases.
    count : int
        Of the nodes in the bunch; where it is -1, all of the tree is looked at.
    """
    (items, tags), (nodes, keys) = stack, bunch
    for k in range(max(count, 1)):
        items[k, 4], items[k, 5], items[k, 6] = 0.0, 1.0, -np.inf
        tags[k, 0], tags[k, 1], tags[k, 2], tags[k, 3] = 0, TREE, (1 << pieces) - 1, START
        if count >= 0:
            tags[k, 0], tags[k, 2], items[k, 6] = nodes[k, 0], nodes[k, 1], keys[k]
    return count if count >= 0 else 1


@jit_fma_inline
def descend(data: ForestData, tool: ToolData, motion: Motion, stack: Stack, depth: int, work: Work,
            state: State) -> None:
    """Bound the least distance of the tool's components on one motion, or decide whether they keep their limits.

    Parameters
    ----------
    data, tool, motion, stack, work
        See the aliases.
    depth : int
        Of the stack, from `begin`.
    state : tuple
        Starting values; receives the answer.
    """
    items, tags = stack
    while depth > 0 and state[1][3] < 0:
        depth -= 1
        bottom, mask, across, key = depth, tags[depth, 2], tags[depth, 3], items[depth, 6]
        if state[1][4] > BUDGET:
            give_up(tool, state, mask, key)
            continue
        if is_decided(tool, state, mask, key):
            continue
        entry = (tags[bottom, 0], tags[bottom, 1], across)
        whole = (items[bottom, 0], items[bottom, 1], items[bottom, 2], items[bottom, 3], items[bottom, 4],
                 items[bottom, 5])
        for side in range(1 if across == START else 2):
            node, kind, item = part(data, entry, whole, side)
            if node >= 0:
                depth = admit(data, tool, motion, (node, kind, mask, item), stack, depth, work, state)
        if depth == bottom + 2 and items[bottom, 6] < items[bottom + 1, 6]:
            exchange(stack, bottom)


def scratch(most_edges: int) -> Room:
    """Arrays in which `descend_many` works.

    Parameters
    ----------
    most_edges : int
        Trim edges through a leaf at most, `Cells.most_edges`.
    """
    return (np.empty((2 * most_edges + 4, 2)), np.empty((6, 3)), np.empty((6, 26)), np.empty((DEPTH, 7)),
            np.empty((DEPTH, 4), dtype=np.int64), np.empty((5, 3)), np.empty(5, dtype=np.int64),
            np.empty((_OPEN, 2), dtype=np.int64), np.empty(_OPEN))


@jit
def descend_many(data: ForestData, tool: ToolData, asked: tuple[Array, Array], room: Room,
                 answer: tuple[Array, Indices]) -> None:
    """`descend` for many motions.

    Parameters
    ----------
    data, tool : tuples
    asked : tuple of arrays
        Motions (n, 3, 3), and by component the value from which distances are not told apart, mm.
    room : tuple of arrays
        From `scratch`.
    answer : tuple of arrays
        Receives lower bounds and nearest points by component (n, 4, 3), and faces, the component that is too near and
        the number of cells looked at (n, 5).
    """
    values, tags = answer
    motions, cutoff = asked
    forest = (borrowed(data[0]), borrowed(data[1]), borrowed(data[2]), borrowed(data[3]), borrowed(data[4]),
              borrowed(data[5]), borrowed(data[6]), borrowed(data[7]))
    relief = (borrowed(tool[3][0]), borrowed(tool[3][1]), tool[3][2])
    cutter = (borrowed(tool[0]), borrowed(tool[1]), tool[2], relief)
    work, stack = (borrowed(room[0]), borrowed(room[1]), borrowed(room[2])), (borrowed(room[3]), borrowed(room[4]))
    found, seen, bunch = room[5], room[6], (borrowed(room[7]), borrowed(room[8]))
    state = (borrowed(found), borrowed(seen))
    first, last, count, looked = 0, 0, -1, 0
    for i in range(motions.shape[0]):
        if i == last:
            first = i
            last, middle, reach = find_bunch(motions, first, _REACH * tool[2][1])
            count, looked = -1, 0
            if last - first >= _FEWEST:
                count, looked = gather_open(forest, cutter, (middle, reach, row(motions[first], 2, 0)), cutoff, stack,
                                            bunch)
        found[:] = 0.0
        found[0, :] = cutoff
        found[1, :] = np.inf
        seen[:4] = -1
        seen[4] = looked if i == first else 0
        motion = row(motions[i], 0, 0), row(motions[i], 1, 0), row(motions[i], 2, 0)
        descend(forest, cutter, motion, stack, begin(cutter[0].shape[0], bunch, count, stack), work, state)
        for c in range(3):
            values[i, 0, c] = min(found[0, c], found[1, c])
        values[i, 1:] = found[2:]
        tags[i] = seen
