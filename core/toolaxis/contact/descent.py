"""Branch and bound over trees of cells: how near a tool comes to faces, or whether it stays far enough away."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.bounds import piece_bound
from toolaxis.numeric.bspline import surface_derivatives
from toolaxis.numeric.compiled import compiled
from toolaxis.shape.cells import ForestData

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

BUDGET = 100_000
DECIDED = 1e-6
DEPTH = 2048
TREE, WHOLE, CUT = 0, 1, 2

# pieces (k, 8); limits (faces, 3): what each component must keep, -inf where it is not asked; limits above faces (3,);
# height of the tool's lower end, its greatest radius, resolution (negative: only decide against the limits)
ToolData: TypeAlias = tuple[Array, Array, Array, tuple[float, float, float]]
# cell (11,), frame (5, 3), region (k, 2), at (3,), out (12,), derivatives (6, 3), spline scratch (6, 26), item (6,)
Work: TypeAlias = tuple[Array, Array, Array, Array, Array, Array, Array, Array]
# items (DEPTH, 9): u, v, du, dv, middle and half of the motion, lowest bound, radius, longer side; tags (DEPTH, 3):
# node, kind, pieces
Stack: TypeAlias = tuple[Array, Indices]
# values (2, 3): least phi seen, least bound given up; nearest point (3, 3); tags (5,): face by component, then the
# component found too near (-1: none), and cells looked at
State: TypeAlias = tuple[Array, Array, Indices]


@compiled
def examine(tool: ToolData, work: Work, state: State, tag: tuple[int, int, bool, int, float]) -> tuple[int, float]:
    """Which pieces are still open over one cell, and the lowest of their bounds.

    Parameters
    ----------
    tool, work, state
        See the aliases; the cell and its frame stand in ``work``.
    tag : (int, int, bool, int, float)
        Face, open pieces as bits, whether the centre is a point of the face, corners that trims leave, and what of e
        no splitting removes.
    """
    pieces, limits, top, (_, _, resolution) = tool
    cell, frame, region, at, out, _, _, _ = work
    values, points, tags = state
    face, mask, real, count, extra = tag
    sweep = np.sqrt(frame[4, 0] ** 2 + frame[4, 1] ** 2 + frame[4, 2] ** 2)
    left, key = 0, np.inf
    tags[4] += 1
    for p in range(pieces.shape[0]):
        if not mask & (1 << p):
            continue
        c = int(pieces[p, 7])
        wanted = limits[face, c] if face >= 0 else top[c]
        if wanted == -np.inf:
            continue
        if resolution >= 0.0:
            wanted = values[0, c] - resolution
        lower, upper = piece_bound(frame, pieces[p], (cell[9], cell[10] + sweep, wanted + extra), (region, count),
                                   (at, out))
        if (real or count > 0) and upper < values[0, c]:
            values[0, c] = upper
            tags[c] = face
            for k in range(3):
                points[c, k] = cell[k]
        if lower + extra >= wanted:
            values[1, c] = min(values[1, c], lower)
            continue
        seen = (real or count > 0) and upper - extra < wanted
        if resolution < 0.0 and (seen or upper - lower - extra < DECIDED):
            tags[3] = c
            tags[c] = face
            return 0, lower
        left |= 1 << p
        key = min(key, lower)
    return left, key


@compiled
def clip_edges(edges: Array, rect: Array, corners: Array) -> int:
    """Ends of the parts of trim edges that run through the inner part of a rectangle.

    Parameters
    ----------
    edges : (k, 4) array
        u, v of both ends.
    rect : (4,) array
        Centre and half widths.
    corners : (2 k + 4, 2) array
        Receives the ends.

    Returns
    -------
    int
        How many ends were written.
    """
    count = 0
    for k in range(edges.shape[0]):
        enter, leave = 0.0, 1.0
        for axis in range(2):
            start, along = edges[k, axis] - rect[axis], edges[k, 2 + axis] - edges[k, axis]
            half = rect[2 + axis] * (1.0 - 1e-9)
            if along == 0.0:
                if abs(start) >= half:
                    leave = -1.0
            else:
                first, second = (-half - start) / along, (half - start) / along
                enter, leave = max(enter, min(first, second)), min(leave, max(first, second))
        if enter < leave:
            for share in (enter, leave):
                for axis in range(2):
                    corners[count, axis] = edges[k, axis] + share * (edges[k, 2 + axis] - edges[k, axis])
                count += 1
    return count


@compiled
def inside_leaf(edges: Array, reference: Array, u: float, v: float) -> bool:
    """Whether a point of a leaf's rectangle lies inside the loops: crossings of the way from the reference point.

    Parameters
    ----------
    edges : (k, 4) array
        Trim edges through the leaf.
    reference : (3,) array
        u, v and whether that point is inside (1 or 0).
    u, v : float
    """
    within = reference[2] > 0.5
    x0, y0 = reference[0], reference[1]
    dx, dy = u - x0, v - y0
    for k in range(edges.shape[0]):
        first = dx * (edges[k, 1] - y0) - dy * (edges[k, 0] - x0) > 0.0
        second = dx * (edges[k, 3] - y0) - dy * (edges[k, 2] - x0) > 0.0
        if first != second:
            ex, ey = edges[k, 2] - edges[k, 0], edges[k, 3] - edges[k, 1]
            here = ex * (y0 - edges[k, 1]) - ey * (x0 - edges[k, 0]) > 0.0
            there = ex * (v - edges[k, 1]) - ey * (u - edges[k, 0]) > 0.0
            if here != there:
                within = not within
    return within


@compiled
def trim_cell(edges: Array, reference: Array, rect: Array, region: Array) -> int:
    """Corners of what trims leave of a rectangle, which shrinks to the box around them.

    Parameters
    ----------
    edges, reference
        Those of the leaf.
    rect : (4,) array
        Centre and half widths, changed.
    region : (k, 2) array
        Receives the corners, as shares of the new half widths.

    Returns
    -------
    int
        Number of corners, 0 where no edge runs through and the rectangle is inside, -1 where nothing is left.
    """
    count = clip_edges(edges, rect, region)
    if count == 0:
        return 0 if inside_leaf(edges, reference, rect[0], rect[1]) else -1
    for i in (-1.0, 1.0):
        for j in (-1.0, 1.0):
            u, v = rect[0] + i * rect[2], rect[1] + j * rect[3]
            if inside_leaf(edges, reference, u, v):
                region[count, 0], region[count, 1] = u, v
                count += 1
    for axis in range(2):
        low, high = np.inf, -np.inf
        for k in range(count):
            low, high = min(low, region[k, axis]), max(high, region[k, axis])
        middle, half = (low + high) / 2.0, (high - low) / 2.0 + 1e-9 * rect[2 + axis]
        rect[axis], rect[2 + axis] = middle, half
        for k in range(count):
            region[k, axis] = (region[k, axis] - middle) / half
    return count


@compiled
def enclose_cell(data: ForestData, node: int, rect: Array, work: Work) -> float:
    """Enclosure of a part of a leaf, into the cell of ``work``; what of its e no splitting removes.

    Parameters
    ----------
    data : tuple
        The forest.
    node : int
        The leaf's node.
    rect : (4,) array
        Centre and half widths of the part.
    work : tuple
    """
    _, link, leaf, _, _, knots, control, layout = data
    cell, derivatives, spline = work[0], work[5], work[6]
    k0, nu, nv, c0, mu, mv, pu, pv, rational = layout[link[node, 2]]
    surface = (knots[k0:k0 + nu], knots[k0 + nu:k0 + nu + nv],
               control[c0:c0 + mu * mv * 4].reshape((mu, mv, 4)), pu, pv, rational != 0)
    surface_derivatives(surface, rect[0], rect[1], derivatives, spline)
    du, dv = rect[2], rect[3]
    plus = minus = 0.0
    for k in range(3):
        a, b = derivatives[1, k] * du, derivatives[2, k] * dv
        cell[k], cell[3 + k], cell[6 + k] = derivatives[0, k], a, b
        plus += (a + b) ** 2
        minus += (a - b) ** 2
    row = leaf[link[node, 3]]
    cell[9] = row[4] * du * du / 2.0 + row[5] * du * dv + row[6] * dv * dv / 2.0 + row[7]
    cell[10] = np.sqrt(max(plus, minus)) + cell[9]
    return float(row[7])


@compiled
def aim(work: Work, motion: Array, middle: float, half: float) -> None:
    """Frame of the cell in ``work`` seen from the tip on a part of its motion.

    Parameters
    ----------
    work : tuple
    motion : (3, 3) array
        Tip half-way, half of its way, axis.
    middle, half : float
        Part of the motion, -1 at its start and 1 at its end.
    """
    cell, frame = work[0], work[1]
    for k in range(3):
        frame[0, k] = cell[k] - motion[0, k] - middle * motion[1, k]
        frame[1, k] = motion[2, k]
        frame[2, k] = cell[3 + k]
        frame[3, k] = cell[6 + k]
        frame[4, k] = -half * motion[1, k]


@compiled
def admit(data: ForestData, tool: ToolData, motion: Array, item: Array, tag: tuple[int, int, int], stack: Stack,
          depth: int, work: Work, state: State) -> int:
    """Look at one cell and put it on the stack if it is still open; the new depth of the stack.

    Parameters
    ----------
    data, tool, motion, stack, work, state
        See `descend`.
    item : (6,) array
        Rectangle (below leaves) and part of the motion.
    tag : (int, int, int)
        Node, kind and open pieces.
    depth : int
    """
    shape, link, leaf, start, edges, _, _, _ = data
    items, tags = stack
    node, kind, mask = tag
    face, number = link[node, 2], link[node, 3]
    real, count, extra = link[node, 4] == 1, 0, 0.0
    if kind == TREE:
        for k in range(11):
            work[0][k] = shape[node, k]
        if number >= 0:
            extra = leaf[number, 7]
    else:
        if kind == CUT:
            count = trim_cell(edges[start[number]:start[number + 1]], leaf[number, 8:11], item[0:4], work[2])
            if count < 0:
                return depth
            if count == 0:
                kind = WHOLE
        extra = enclose_cell(data, node, item, work)
        real = kind == WHOLE
    aim(work, motion, item[4], item[5])
    left, key = examine(tool, work, state, (face, mask, real, count, extra))
    if left == 0:
        return depth
    for k in range(6):
        items[depth, k] = item[k]
    items[depth, 6], items[depth, 7] = key, work[0][10]
    items[depth, 8] = 0.0 if longer_first(work[0]) else 1.0
    tags[depth, 0], tags[depth, 1], tags[depth, 2] = node, kind, left
    return depth + 1


@compiled
def longer_first(cell: Array) -> bool:
    """Whether a cell is longer along a than along b.

    Parameters
    ----------
    cell : (11,) array
    """
    return (cell[3] ** 2 + cell[4] ** 2 + cell[5] ** 2 >= cell[6] ** 2 + cell[7] ** 2 + cell[8] ** 2)  # type: ignore[no-any-return]


@compiled
def decided(tool: ToolData, state: State, mask: int, key: float) -> bool:
    """Whether what was found since makes a waiting cell needless; its bound is then taken into account.

    Parameters
    ----------
    tool, state
        See `descend`.
    mask : int
        Open pieces of the cell.
    key : float
        The lowest of their bounds.
    """
    pieces, resolution = tool[0], tool[3][2]
    values = state[0]
    if resolution < 0.0:
        return False
    for p in range(pieces.shape[0]):
        if mask & (1 << p) and key < values[0, int(pieces[p, 7])] - resolution:
            return False
    give_up(tool, state, mask, key)
    return True


@compiled
def give_up(tool: ToolData, state: State, mask: int, key: float) -> None:
    """Take the bound of a cell into account without looking further into it.

    Parameters
    ----------
    tool, state
        See `descend`.
    mask : int
        Open pieces of the cell.
    key : float
        The lowest of their bounds.
    """
    pieces, values = tool[0], state[0]
    for p in range(pieces.shape[0]):
        if mask & (1 << p):
            c = int(pieces[p, 7])
            values[1, c] = min(values[1, c], key)
            if tool[3][2] < 0.0:
                state[2][3] = c


@compiled
def expand(data: ForestData, tool: ToolData, motion: Array, stack: Stack, depth: int, work: Work,
           state: State) -> int:
    """Replace the cell above the top of the stack by its parts; the new depth of the stack.

    Parameters
    ----------
    data, tool, motion, stack, work, state
        See `descend`.
    depth : int
        Where the cell stands.
    """
    _, link, leaf, start, _, _, _, _ = data
    items, tags = stack
    item = work[7]
    for k in range(6):
        item[k] = items[depth, k]
    node, kind, mask, bottom = tags[depth, 0], tags[depth, 1], tags[depth, 2], depth
    sweep = item[5] * np.sqrt(motion[1, 0] ** 2 + motion[1, 1] ** 2 + motion[1, 2] ** 2)
    in_time = sweep > items[depth, 7]
    in_tree = kind == TREE and link[node, 3] < 0 and not in_time
    across, number = int(items[depth, 8]), link[node, 3]
    if not in_tree and not in_time and kind == TREE:
        kind = CUT if start[number + 1] > start[number] else WHOLE
        for k in range(4):
            item[k] = leaf[number, k]
    u, v, du, dv, middle, half = item[0], item[1], item[2], item[3], item[4], item[5]
    for side in range(2):
        sign = 2.0 * side - 1.0
        item[0], item[1], item[2], item[3], item[4], item[5] = u, v, du, dv, middle, half
        child = node
        if in_tree:
            child = link[node, side]
            if child < 0:
                continue
        elif in_time:
            item[4], item[5] = middle + sign * half / 2.0, half / 2.0
        elif across == 0:
            item[0], item[2] = u + sign * du / 2.0, du / 2.0
        else:
            item[1], item[3] = v + sign * dv / 2.0, dv / 2.0
        depth = admit(data, tool, motion, item, (child, kind, mask), stack, depth, work, state)
    if depth == bottom + 2 and items[bottom, 6] < items[bottom + 1, 6]:
        exchange(stack, bottom)
    return depth


@compiled
def exchange(stack: Stack, low: int) -> None:
    """Exchange two neighbouring entries of the stack.

    Parameters
    ----------
    stack : tuple
    low : int
        The lower of the two.
    """
    items, tags = stack
    for k in range(9):
        items[low, k], items[low + 1, k] = items[low + 1, k], items[low, k]
    for k in range(3):
        tags[low, k], tags[low + 1, k] = tags[low + 1, k], tags[low, k]


@compiled
def descend(data: ForestData, tool: ToolData, motion: Array, stack: Stack, work: Work, state: State) -> None:
    """Bound the least distance of the tool's components on one motion, or decide whether they keep their limits.

    Parameters
    ----------
    data : tuple
        The forest.
    tool : tuple
        Pieces, limits, and what belongs to them.
    motion : (3, 3) array
        Tip half-way, half of its way (zero for a standing tool), axis.
    stack, work : tuples
        Scratch.
    state : tuple
        Starting values; receives the answer.
    """
    tags = state[2]
    item = work[7]
    for k in range(5):
        item[k] = 0.0
    item[5] = 1.0
    depth = admit(data, tool, motion, item, (0, TREE, (1 << tool[0].shape[0]) - 1), stack, 0, work, state)
    while depth > 0 and tags[3] < 0:
        depth -= 1
        mask, key = stack[1][depth, 2], stack[0][depth, 6]
        if tags[4] > BUDGET:
            give_up(tool, state, mask, key)
        elif not decided(tool, state, mask, key):
            depth = expand(data, tool, motion, stack, depth, work, state)


@compiled
def descend_many(data: ForestData, tool: ToolData, motions: Array, cutoff: Array,
                 answer: tuple[Array, Indices, Array, Indices]) -> None:
    """`descend` for many motions.

    Parameters
    ----------
    data, tool : tuples
    motions : (n, 3, 3) array
    cutoff : (3,) array
        Values from which distances are not told apart, mm.
    answer : tuple of arrays
        Receives lower bounds (n, 3), faces (n, 3), nearest points (n, 3, 3), and the component that is too near with
        the number of cells looked at (n, 2).
    """
    lower, faces, points, verdict = answer
    start = data[3]
    longest = 0
    for k in range(start.shape[0] - 1):
        longest = max(longest, start[k + 1] - start[k])
    work = (np.empty(11), np.empty((5, 3)), np.empty((2 * longest + 4, 2)), np.empty(3), np.empty(12),
            np.empty((6, 3)), np.empty((6, 26)), np.empty(6))
    stack = (np.empty((DEPTH, 9)), np.empty((DEPTH, 3), dtype=np.int64))
    state = (np.empty((2, 3)), np.empty((3, 3)), np.empty(5, dtype=np.int64))
    for i in range(motions.shape[0]):
        state[0][0, :] = cutoff
        state[0][1, :] = np.inf
        state[1][:, :] = 0.0
        state[2][:4] = -1
        state[2][4] = 0
        descend(data, tool, motions[i], stack, work, state)
        for c in range(3):
            lower[i, c] = min(state[0][0, c], state[0][1, c])
            faces[i, c] = state[2][c]
            for k in range(3):
                points[i, c, k] = state[1][c, k]
        verdict[i, 0], verdict[i, 1] = state[2][3], state[2][4]
