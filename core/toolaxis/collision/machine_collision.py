"""Table, trunnion and head of a machine against each other, against the part and against the tool, along passes.

With the rotary axes at rest everything on the spindle's side is carried along straight lines, so that a piece of a path
moves a convex body through a convex one.  Path and faces are trees: the pair of branches with the least bound is split
until it cannot be, and no distance is less than what is then found.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.machine.bodies import BED
from toolaxis.machine.body_poses import BodyPose, beside_part, part_from_bed, standing
from toolaxis.machine.kinematics import forward, linear_coordinates
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting, in_tenths
from toolaxis.numeric.support_functions import ConvexBodies, boxes, places, segments, separation
from toolaxis.numeric.vectors import as_rows, perpendicular
from toolaxis.progress import breathe
from toolaxis.shape.bounding.bounding_tree import BoundingTree
from toolaxis.tools.solid import COMPONENTS, convex_pieces, solid_pieces
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

#: Cells of faces that are flat to this are not split, mm.
FLAT = 0.02
_BATCH, _ROUNDS = 256, 400
#: Rounds in which a deeper place is looked for once bodies are known to meet.
_DEEPER = 6


class BodyTree(NamedTuple):
    """Convex bodies that enclose each other: nodes, (n, 2) children (-1 for none), (n,) radius, mm."""

    nodes: ConvexBodies
    children: Indices
    size: Array


class CollisionPoint(NamedTuple):
    """Where two things come nearest: their names, a lower bound of their distance, mm (negative where they meet), and
    the number of the motion."""

    one: str
    other: str
    distance: float
    motion: int


@dataclass(frozen=True, eq=False)
class MachineSurroundings:
    """What a machine with its bodies has to keep clear of, and by how much.

    Attributes
    ----------
    tool : Tool
    faces : tuple of BoundingTree
        Of the part and of what stands on the table beside it, part's frame.
    required : float
        Least distance, mm.
    """

    tool: Tool
    faces: tuple[BoundingTree, ...]
    required: float


class _Mover(NamedTuple):
    """Something on the spindle's side: its name, what carries it, its shape at the origin of its trail, the trail."""

    name: str
    carried: str
    shape: ConvexBodies
    trail: BodyTree


def free_solutions(mounting: Mounting, tips: ArrayLike, axis: ArrayLike,
                   around: MachineSurroundings) -> tuple[Array, str, float]:
    """Rotary angles at which a machine can follow a path without meeting itself, part or tool, and why not at others.

    Parameters
    ----------
    mounting : Mounting
    tips : (n, 3) array_like
        Tool tips in their order, part's frame, mm.
    axis : (3,) array_like
    around : MachineSurroundings

    Returns
    -------
    rotary : (s, m) array
        rad; those of `Mounting.holding` where bodies are not judged.
    why : str
        What stops the other solution that comes closest; empty where none does.
    distance : float
        The least distance there, mm; infinite where none is stopped.
    """
    rows = mounting.hold_side(tips, axis)
    if not mounting.judges_bodies:
        return rows, "", np.inf
    found = [nearest_meeting(mounting, row, tips, around) for row in rows]
    free = np.array([one is None or one.distance >= around.required for one in found], dtype=bool)
    worst = [(one.distance, words(mounting, row, one, around.required))
             for one, row, good in zip(found, rows, free, strict=True) if one is not None and not good]
    distance, why = max(worst, default=(np.inf, ""))
    return rows[free], why, distance


def words(mounting: Mounting, rotary: ArrayLike, found: CollisionPoint, required: float) -> str:
    """What a meeting says.

    Parameters
    ----------
    mounting : Mounting
    rotary : (m,) array_like
        rad
    found : CollisionPoint
    required : float
        mm
    """
    at = mounting.at(rotary)
    if found.distance < 0:
        return f"the {found.one} collides with the {found.other} by {in_tenths(-found.distance)} mm{at}"
    return (f"the {found.one} comes within {found.distance:.2f} mm of the {found.other}, less than the required "
            f"{required:g} mm,{at}")


def nearest_meeting(mounting: Mounting, rotary: ArrayLike, tips: ArrayLike, around: MachineSurroundings,
                    *, with_tool: bool = False, most: float | None = None) -> CollisionPoint | None:
    """Where anything on the spindle's side comes nearest to anything on the table's, or the part to what turns it.

    Parameters
    ----------
    mounting : Mounting
        With a place of the part and a tool length.
    rotary : (m,) array_like
        Where the rotary axes stand still, rad.
    tips : (n, 3) array_like
        Tool tips in their order, part's frame, mm.
    around : MachineSurroundings
    with_tool : bool
        Whether the tool is held against the part too; passes have been already.
    most : float, optional
        Distances beyond this are not told apart, mm; the required one unless given.

    Returns
    -------
    CollisionPoint or None
        None where nothing comes nearer than `most`.
    """
    at = linear_coordinates(mounting.machine, as_rows(tips, 3, "tool tips"), rotary, float(mounting.tool_length or 0.0),
                            mounting.table_from_part)
    return meeting_on(mounting, rotary, segments(at), around, with_tool=with_tool, most=most)


def meeting_on(mounting: Mounting, rotary: ArrayLike, ways: ConvexBodies, around: MachineSurroundings, *,
               with_tool: bool = True, most: float | None = None, over_table: bool = True) -> CollisionPoint | None:
    """The same where linear axes move inside some bodies, such as the rectangle that two of them may take any way in.

    Parameters
    ----------
    mounting, rotary, around, with_tool, most
        As for `nearest_meeting`.
    ways : ConvexBodies
        In linear coordinates, one after the other, mm.
    over_table : bool
        Whether the tool is held against bodies that go along with the part too.
    """
    machine, enough = mounting.machine, around.required if most is None else most
    stand = standing(machine, rotary, mounting.table_from_part)
    still = [(one.body.name, one.body.carried, single(one.shape)) for one in stand if beside_part(machine, one.body)]
    faces = [tree_of(cells) for cells in around.faces]
    best: CollisionPoint | None = None
    besides = "" if over_table else carrier_of(machine)
    movers = list(_movers(mounting, rotary, ways, stand, around.tool))
    pairs = [*_between(machine, movers, still, faces, with_tool, besides),
             *_with_part(machine, stand, faces)]
    for mover, name, tree in pairs:
        least = enough if best is None else min(best.distance, enough)
        distance, motion, node = approach(mover.shape, mover.trail, tree, least)
        if distance < least:
            label = name or f"face {_label(around.faces, faces, tree, node)}"
            best = CollisionPoint(mover.name, label, distance, motion)
        if best is not None and best.distance < 0 and most is None:
            return best
    if best is not None and best.distance < enough:
        return best
    return _body_inside_part(machine, stand, around, ways.centre[0, 0])


def carrier_of(machine: Machine) -> str:
    """What carries the part: the name of an axis, or "bed".

    Parameters
    ----------
    machine : Machine
    """
    return machine.table[0].name if machine.table else BED


_PairRow = tuple[_Mover, str, BodyTree]


def _movers(mounting: Mounting, rotary: ArrayLike, ways: ConvexBodies, stand: list[BodyPose],
            tool: Tool) -> Iterator[_Mover]:
    """The tool's pieces and the bodies on the spindle's side with their ways."""
    frame, machine = np.eye(4), mounting.machine
    axis = mounting.axis_at(rotary)
    frame[:3, :3] = np.stack([*perpendicular(axis), axis], axis=1)
    tip, _ = forward(machine, np.concatenate([np.zeros(3), np.atleast_1d(rotary)])[None],
                     float(mounting.tool_length or 0.0), mounting.table_from_part)
    frame[:3, 3] = tip[0]
    rows = solid_pieces(tool.profile, tool.outlines)
    pieces = convex_pieces(rows).moved(frame)
    carrier = part_from_bed(machine, rotary, mounting.table_from_part)[:3, :3] @ machine.directions
    trails = {carrier.tobytes(): tree_over(_motions_in_part(ways, carrier))}
    for k, row in enumerate(rows):
        yield _Mover(COMPONENTS[int(row[7])], "", pieces.rows(np.array([k])), trails[carrier.tobytes()])
    for one in stand:
        if not beside_part(machine, one.body):
            key = one.carrier.tobytes()
            if key not in trails:
                trails[key] = tree_over(_motions_in_part(ways, one.carrier))
            yield _Mover(one.body.name, one.body.carried, one.shape, trails[key])


def _motions_in_part(ways: ConvexBodies, carrier: Array) -> ConvexBodies:
    """Ways in linear coordinates as motions in the part's frame."""
    return ways._replace(centre=ways.centre @ carrier.T, spread=ways.spread @ carrier.T)


def _between(machine: Machine, movers: list[_Mover], still: list[tuple[str, str, BodyTree]], faces: list[BodyTree],
             with_tool: bool, besides: str) -> Iterator[_PairRow]:
    """The spindle's side against the table's; what the first linear axis carries slides on the bed.  The tool is not
    held against what an axis carries that is named."""
    for mover in movers:
        for name, carried, tree in still:
            sliding = carried == BED and mover.carried == machine.linear[0].name
            if not sliding and (mover.carried or carried != besides):
                yield mover, name, tree
        for tree in faces:
            if mover.carried or with_tool:
                yield mover, "", tree


def _with_part(machine: Machine, stand: list[BodyPose], faces: list[BodyTree]) -> Iterator[_PairRow]:
    """Bodies on the table's side that the part turns against."""
    carrier = carrier_of(machine)
    for one in stand:
        if beside_part(machine, one.body) and one.body.carried != carrier:
            for tree in faces:
                yield _Mover(one.body.name, one.body.carried, one.shape, tree_over(places(np.zeros((1, 3))))), "", tree


def _label(cells: Sequence[BoundingTree], trees: list[BodyTree], tree: BodyTree, node: int) -> str:
    some = next(one for one, other in zip(cells, trees, strict=True) if other is tree)
    number = int(some.link[node, 2])
    return some.faces[max(number, 0)].label


def _body_inside_part(machine: Machine, stand: list[BodyPose], around: MachineSurroundings,
                      at: Array) -> CollisionPoint | None:
    """A body that lies wholly inside the box around the part, where the distance from its faces would not tell."""
    carrier = carrier_of(machine)
    for cells in around.faces:
        box = np.array([face.box for face in cells.faces])
        low, high = box[:, 0].min(axis=0), box[:, 1].max(axis=0)
        for one in stand:
            if one.body.carried == carrier:
                continue
            ways = np.concatenate([np.eye(3), -np.eye(3)])
            far = np.einsum("nc,nc->n", one.shape.support(ways), ways) + ways @ one.carrier @ at
            if (far[:3] <= high).all() and (far[3:] <= -low).all():
                return CollisionPoint(one.body.name, "part", -float(far.sum()) / 6, 0)
    return None


def single(shape: ConvexBodies) -> BodyTree:
    """One body as a tree.

    Parameters
    ----------
    shape : ConvexBodies
    """
    return BodyTree(shape, np.full((1, 2), -1), np.zeros(1))


def tree_over(nodes: ConvexBodies) -> BodyTree:
    """Motions as a tree: two by two in boxes, the root last.

    Parameters
    ----------
    nodes : ConvexBodies
    """
    count = len(nodes.centre)
    ends = np.abs(nodes.spread).sum(axis=1)
    low, high = [nodes.centre[:, 0] - ends], [nodes.centre[:, 0] + ends]
    children = [np.full((count, 2), -1)]
    start = 0
    while len(low[-1]) > 1:
        size = len(low[-1])
        left = np.arange(0, size, 2)
        right = np.minimum(left + 1, size - 1)
        low.append(np.minimum(low[-1][left], low[-1][right]))
        high.append(np.maximum(high[-1][left], high[-1][right]))
        pair = np.stack([left, np.where(left + 1 < size, right, -1)], axis=1)
        children.append(np.where(pair >= 0, pair + start, -1))
        start += size
    above = boxes(np.concatenate([np.empty((0, 3)), *low[1:]]), np.concatenate([np.empty((0, 3)), *high[1:]]))
    whole = ConvexBodies(*(np.concatenate(both) for both in zip(nodes, above, strict=True)))
    return BodyTree(whole, np.concatenate(children), np.linalg.norm(whole.spread, axis=(1, 2)))


@lru_cache(maxsize=8)
def tree_of(cells: BoundingTree) -> BodyTree:
    """The cells of faces as convex bodies that hold them, the faces' own tolerance included.

    Parameters
    ----------
    cells : BoundingTree
    """
    shape = cells.shape
    count = len(shape)
    # A node is a parallelogram q + s a + t b, s and t from -1 to 1, with a ball of radius e carried around it.
    spread = np.zeros((count, 3, 3))
    spread[:, 0] = shape[:, 3:6]
    spread[:, 1] = shape[:, 6:9]
    off_plane = shape[:, 9]
    nodes = ConvexBodies(
        centre=shape[:, None, :3],
        axis=np.tile([0.0, 0.0, 1.0], (count, 1, 1)),
        radius=np.zeros((count, 1)),
        ball=off_plane[:, None] + max(face.tolerance for face in cells.faces),
        spread=spread)
    fine = (off_plane <= FLAT) & (cells.link[:, 2] >= 0)
    children = np.where(fine[:, None], -1, cells.link[:, :2])
    return BodyTree(nodes, children, shape[:, 10])


def approach(moving: ConvexBodies, trail: BodyTree, fixed: BodyTree, enough: float) -> tuple[float, int, int]:
    """A lower bound of the least distance of a body that is carried along a path, mm, at most `enough`; the motion and
    the node of the other body where that is.

    Where they meet, the depth is that of the deepest place that a short search finds.

    Parameters
    ----------
    moving : ConvexBodies
        One body.
    trail, fixed : BodyTree
        Where it goes, and what it comes near.
    enough : float
        mm
    """
    roots = (len(trail.size) - 1, 0)
    pairs, gaps = np.array([roots]), np.full(1, -np.inf)
    deeper = 0
    for _ in range(_ROUNDS):
        leaf = (trail.children[pairs[:, 0], 0] < 0) & (fixed.children[pairs[:, 1], 0] < 0)
        leaf &= np.isfinite(gaps)
        first = int(np.argmin(gaps))
        met = np.flatnonzero(leaf & (gaps < 0))
        deeper += len(met) > 0
        if gaps[first] >= enough or leaf[first] or deeper > _DEEPER:
            break
        order = np.argsort(np.where(leaf, np.inf, gaps), kind="stable")[:_BATCH]
        order = order[(gaps[order] < enough) & ~leaf[order]]
        new = _split(trail, fixed, pairs[order])
        breathe()
        ends = (trail.children[new[:, 0], 0] < 0) & (fixed.children[new[:, 1], 0] < 0)
        found = separation([moving, trail.nodes.rows(new[:, 0])], [fixed.nodes.rows(new[:, 1])], enough, inner=~ends)
        kept = np.ones(len(gaps), dtype=bool)
        kept[order] = False
        near = found < enough
        pairs = np.concatenate([pairs[kept], new[near]])
        gaps = np.concatenate([gaps[kept], found[near]])
        if not len(gaps):
            return enough, 0, 0
    if deeper > _DEEPER:
        first = int(met[np.argmin(gaps[met])])
    return min(float(gaps[first]), enough), _first_leaf(trail, int(pairs[first, 0])), int(pairs[first, 1])


def _split(trail: BodyTree, fixed: BodyTree, pairs: Indices) -> Indices:
    """Pairs with the larger one of the two that can be split replaced by its children."""
    t, f = pairs.T
    can_t, can_f = trail.children[t, 0] >= 0, fixed.children[f, 0] >= 0
    by_trail = can_t & (~can_f | (trail.size[t] >= fixed.size[f]))
    by_fixed = can_f & ~by_trail
    rows = [np.stack([trail.children[t[by_trail], k], f[by_trail]], axis=1) for k in (0, 1)]
    rows += [np.stack([t[by_fixed], fixed.children[f[by_fixed], k]], axis=1) for k in (0, 1)]
    rows.append(pairs[~(can_t | can_f)])
    whole = np.concatenate(rows)
    return np.asarray(whole[(whole >= 0).all(axis=1)])


def _first_leaf(trail: BodyTree, node: int) -> int:
    while trail.children[node, 0] >= 0:
        node = int(trail.children[node, 0])
    return node
