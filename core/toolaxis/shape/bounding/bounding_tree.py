"""Faces as trees of cells that enclose them: each cell is a parallelogram with a proven distance around it.

Every point of the face inside a cell is q + s a + t b + d with s and t in [-1, 1] and d no longer than e, and lies
within a radius R of q.  It is as well q + s a + t b + (s^2 A + 2 s t B + t^2 C) / 2 + d' with d' no longer than e'.
Leaves take e and e' from bounds of the second and third derivatives, parents from their children.  What a trim cuts
away is left out: cells outside the loops are dropped, cells across a loop shrink to what is inside.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import TypeAlias
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.shape.bounding.build import build_tree
from toolaxis.shape.face import Face
from toolaxis.shape.seams import Mismatch

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

#: How fine trees are unless said otherwise, mm: what they leave open is worked out where it is asked.
FINENESS = 0.02

ForestData: TypeAlias = tuple[Array, Indices, Array, Indices, Array, Array, Array, Indices]


@dataclass(frozen=True, eq=False)
class BoundingTree:
    """The tree of one face, or the trees of several under one root; node 0 is the root.

    Attributes
    ----------
    faces : tuple of Face
    nodes : (n, 22) array
        Of every node, mm: q, a, b (three numbers each), e and R (`shape`); what is added to e; A, B, C (three numbers
        each) and e' (`bend`).
    link : (n, 5) array of int
        Left and right child (-1 for none), face (index in `faces`, -1 above them), leaf (-1 above leaves), and
        whether q is a point of the face (1 or 0), or the whole cell is (2).
    leaf : (m, 15) array
        Centre u, v and half widths of the leaf's rectangle; bounds of |Suu|, |Suv|, |Svv| over it; what is added to
        Taylor's remainder, mm; a reference point u, v and whether that is inside the loops (1 or 0); bounds of |Suuu|,
        |Suuv|, |Suvv| and |Svvv|.
    edge_start : (m + 1,) array of int
        Trim edges that run through leaf k are ``edges[edge_start[k]:edge_start[k + 1]]``.
    edges : (k, 4) array
        u, v of both ends.
    mismatch : Mismatch or None
        By how much the faces stand out over their neighbours, which is taken off the depth of a cutter in them.
    """

    faces: tuple[Face, ...]
    nodes: Array
    link: Indices
    leaf: Array
    edge_start: Indices
    edges: Array
    mismatch: Mismatch | None = None

    @property
    def shape(self) -> Array:
        """q, a, b, e and R of every node, (n, 11)."""
        return self.nodes[:, :11]

    @property
    def bend(self) -> Array:
        """A, B, C and e' of every node, (n, 10)."""
        return self.nodes[:, 12:]

    @cached_property
    def data(self) -> ForestData:
        """The tuple that kernels take: the trees, then the surfaces, all in a row."""
        knots: list[Array] = []
        control: list[Array] = []
        layout = []
        at_knot = at_number = 0
        for face in self.faces:
            ku, kv, net, pu, pv, rational = face.surface.data
            layout.append([at_knot, len(ku), len(kv), at_number, net.shape[0], net.shape[1], pu, pv, int(rational)])
            knots += [ku, kv]
            control.append(net.reshape(-1))
            at_knot, at_number = at_knot + len(ku) + len(kv), at_number + net.size
        extra = np.where(self.link[:, 3] >= 0, self.leaf[self.link[:, 3], 7], 0.0)
        return (np.column_stack([self.shape, extra, self.bend]), self.link, self.leaf, self.edge_start, self.edges,
                np.concatenate(knots), np.concatenate(control), np.array(layout, dtype=np.int64))

    @cached_property
    def most_edges(self) -> int:
        """Number of trim edges through the leaf that has most of them."""
        return int(np.diff(self.edge_start).max(initial=0))


    def missing(self, mismatch: Mismatch | None) -> "BoundingTree":
        """The same cells with a mismatch of their faces; the arrays are shared.

        Parameters
        ----------
        mismatch : Mismatch or None
        """
        if mismatch is None:
            return self
        return replace(self, mismatch=mismatch)


_known: "WeakKeyDictionary[Face, dict[float, BoundingTree]]" = WeakKeyDictionary()


def cells(face: Face, fineness: float = FINENESS) -> BoundingTree:
    """The tree of one face; made once for each face and kept while the face lives.

    Parameters
    ----------
    face : Face
    fineness : float
        As for `toolaxis.shape.bounding.build.build_tree`, mm.

    Raises
    ------
    InvalidInput
        When the loops enclose nothing of the surface.
    """
    assert len(face.own_faces) == 1, "a skin has no cells of its own: those of its faces stand for it"
    found = _known.setdefault(face, {})
    if fineness not in found:
        tree = build_tree(face, fineness)
        added = np.where(tree.link[:, 3] >= 0, tree.leaf[tree.link[:, 3], 7], 0.0)
        found[fineness] = BoundingTree((), np.column_stack([tree.shape, added, tree.bend]), *tree[2:])
    return replace(found[fineness], faces=(face,))


def keep_cells(face: Face, tree: BoundingTree, fineness: float = FINENESS) -> None:
    """Keep the tree of a face that another process has made, as `cells` keeps its own.

    Parameters
    ----------
    face : Face
    tree : BoundingTree
        Its cells.
    fineness : float
        With which they were made, mm.
    """
    _known.setdefault(face, {}).setdefault(fineness, replace(tree, faces=()))


def merge_trees(parts: Sequence[BoundingTree]) -> BoundingTree:
    """Several trees under one root.

    Parameters
    ----------
    parts : sequence of BoundingTree

    Raises
    ------
    InvalidInput
        When there is none.
    """
    if not parts:
        raise InvalidInput("no faces are given: at least one is needed")
    if len(parts) == 1:
        return parts[0]
    faces = np.cumsum([0, *(len(p.faces) for p in parts)])
    leaves = np.cumsum([0, *(len(p.leaf) for p in parts)])
    edges = np.cumsum([0, *(len(p.edges) for p in parts)])
    nodes = np.cumsum([len(parts) - 1, *(len(p.shape) for p in parts)])
    roots = np.stack([p.shape[0] for p in parts])
    top_shape, top_link = branch_roots(roots, nodes[:-1])
    # What is above the faces bends beyond all bounds.
    no_bend = np.zeros((len(top_shape), 10))
    unbounded = np.full(len(top_shape), np.inf)
    top = np.column_stack([top_shape, no_bend, unbounded])
    links = [_shift_link(p.link, nodes[k], faces[k], leaves[k]) for k, p in enumerate(parts)]
    starts = [p.edge_start[:-1] + edges[k] for k, p in enumerate(parts)]
    return BoundingTree(
        faces=tuple(face for p in parts for face in p.faces),
        nodes=np.vstack([top, *(p.nodes for p in parts)]),
        link=np.vstack([top_link, *links]),
        leaf=np.vstack([p.leaf for p in parts]),
        edge_start=np.concatenate([*starts, edges[-1:]]).astype(np.int64),
        edges=np.vstack([p.edges for p in parts]))


def forest(faces: Sequence[Face], fineness: float = FINENESS) -> BoundingTree:
    """The trees of several faces under one root.

    Parameters
    ----------
    faces : sequence of Face
    fineness : float
        As for `toolaxis.shape.bounding.build.build_tree`, mm.

    Raises
    ------
    InvalidInput
        When there is no face, or the loops of one enclose nothing of its surface.
    """
    return _grown(tuple(own for face in faces for own in face.own_faces), fineness)


@lru_cache(maxsize=3)
def _grown(faces: tuple[Face, ...], fineness: float) -> BoundingTree:
    return merge_trees([cells(face, fineness) for face in faces])


def _shift_link(link: Indices, node: int, face: int, leaf: int) -> Indices:
    moved = link.copy()
    for column, by in ((0, node), (1, node), (2, face), (3, leaf)):
        moved[:, column] = np.where(link[:, column] >= 0, link[:, column] + by, -1)
    return moved


def branch_roots(roots: Array, number: Indices) -> tuple[Array, Indices]:
    """Nodes above the roots of several trees: balls halved at the median of their longest direction, the root first.

    Parameters
    ----------
    roots : (k, 11) array
        Rows of `BoundingTree.shape`.
    number : (k,) array of int
        What the links call them.

    Returns
    -------
    (k - 1, 11) and (k - 1, 5) arrays
        Rows of `BoundingTree.shape` and `BoundingTree.link`.
    """
    shape, link = np.zeros((len(roots) - 1, 11)), np.full((len(roots) - 1, 5), -1, dtype=np.int64)
    link[:, 4] = 0
    free = iter(range(len(shape)))

    def grow(rows: Indices) -> int:
        if len(rows) == 1:
            return int(number[rows[0]])
        own, centres = next(free), roots[rows, :3]
        middle = (centres.min(axis=0) + centres.max(axis=0)) / 2
        order = rows[np.argsort(centres[:, int(np.argmax(np.ptp(centres, axis=0)))], kind="stable")]
        shape[own, :3] = middle
        shape[own, 9:] = (np.linalg.norm(centres - middle, axis=1) + roots[rows, 10]).max()
        link[own, 0], link[own, 1] = grow(order[:len(order) // 2]), grow(order[len(order) // 2:])
        return own

    grow(np.arange(len(roots)))
    return shape, link
