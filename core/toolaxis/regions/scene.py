"""All that stands around a part, as trees of cells shared by every face, tool and axis."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.feasibility.surroundings import OTHER, Obstacles, faces_of, group_surroundings
from toolaxis.machine.limits import AxisLimits
from toolaxis.regions.reach_kernel import ReachTool, ReachTree
from toolaxis.regions.solid_grid import PartSolid
from toolaxis.shape.bounding.bounding_tree import BoundingTree, branch_roots, cells
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.shape.seams import Mismatch
from toolaxis.tolerances import Tolerance
from toolaxis.tools.solid import COMPONENTS
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Columns of limits: cutter, shank, holder, and what holds the tool above all that is known of it.
_ABOVE = 3
#: Columns of `BoundingTree.leaf` that `ReachTree.rect` has: centre, half widths, reference point and its side.
_RECTANGLE = [0, 1, 2, 3, 8, 9, 10]


@dataclass(frozen=True, eq=False)
class ReachScene:
    """A part with its obstacles, and what tools have to keep from them; make it with `ReachScene.of`.

    Attributes
    ----------
    part : Part
    obstacles : tuple of Face
    tolerance : Tolerance
    limits : AxisLimits or None
    allowance : float
        Stock left on the faces, mm.
    faces : tuple of Face
        All faces of the part, the plane of its held side, and the obstacles, skins as the faces that they consist of.
    tree : ReachTree
        Of these faces.
    solid : PartSolid
        What the part is made of.
    """

    part: Part
    obstacles: tuple[Face, ...]
    tolerance: Tolerance
    limits: AxisLimits | None
    allowance: float
    faces: tuple[Face, ...]
    tree: ReachTree
    solid: PartSolid

    @staticmethod
    def of(part: Part, obstacles: Obstacles = None, tolerance: Tolerance | None = None,
           limits: AxisLimits | None = None, allowance: float = 0.0) -> "ReachScene":
        """Prepare a part.

        Parameters
        ----------
        part : Part
        obstacles : Part, Face or sequence of Face, optional
        tolerance : Tolerance, optional
        limits : AxisLimits, optional
        allowance : float
            mm

        Raises
        ------
        InvalidInput
            When obstacles are not faces.
        """
        beside = faces_of(obstacles)
        every = (*part.faces, *part.faces_of_held_side, *beside)
        faces = tuple(own for face in every for own in face.own_faces)
        tree = merge_reach_trees([cells(face) for face in faces])
        solid = PartSolid(_closed_bodies(part), tree)
        kept = Tolerance() if tolerance is None else tolerance
        return ReachScene(part, beside, kept, limits, allowance, faces, tree, solid)

    def required(self, face: Face, steps_count: bool = True) -> Array:
        """What tools that machine a face have to keep, (faces + 1, 4) mm.

        Parameters
        ----------
        face : Face
            Of the part.
        steps_count : bool
            Whether steps in the file count as gouges.  Where not, the cutter may be deeper all over a face by its
            highest step: no less than what `toolaxis.shape.seams` takes off anywhere.

        Returns
        -------
        (faces + 1, 4) array
            Least signed distance of cutter, shank, holder, and of what holds the tool: 0 for faces that it must not
            meet at all, -inf for those that are not held against it.  The last row is the greatest of each column.
        """
        groups = group_surroundings(face, self.tolerance, self.allowance, part=self.part, obstacles=self.obstacles)
        row_of = {id(own): row for row, own in enumerate(self.faces)}
        table = np.full((len(self.faces) + 1, 4), -np.inf)
        for group in groups:
            rows = [row_of[id(own)] for own in group.faces]
            table[rows, :_ABOVE] = group.required
            if not steps_count and group.mismatch is not None:
                table[rows, 0] -= _highest_steps(group.mismatch)
            table[rows, _ABOVE] = 0.0 if group.role == OTHER else -np.inf
        table[-1] = table[:-1].max(axis=0)
        return table

    def tool(self, tool: Tool, required: Array) -> ReachTool:
        """A tool with what holds it, as far up as anything stands.

        Parameters
        ----------
        tool : Tool
        required : (faces + 1, 4) array
            Of `required`.
        """
        top = _top_of(tool)
        limits = required.copy()
        own = self.tolerance.for_cutter(tool.radius)  # `required` is asked of all tools, before one is known
        limits[:, COMPONENTS.index("shank")] -= self.tolerance.shank_clearance - own.shank_clearance
        is_checked = np.isfinite(limits[:, _ABOVE])
        limits[is_checked, _ABOVE] = limits[is_checked, COMPONENTS.index(top.component)]
        above = [top.radius, 0.0, 1.0, 0.0, tool.height, tool.height + self._extent, top.radius, _ABOVE]
        of_faces = limits[:-1]
        of_cutter = of_faces[:, :1]
        # Where the cutter need not keep off a face, what is known of it there says nothing of the others.
        further = np.where(np.isfinite(of_faces), of_faces - of_cutter, 0.0)
        finite = of_cutter[np.isfinite(of_cutter)]
        margin = float(np.abs(finite).max(initial=0.0))
        return ReachTool(np.vstack([tool.pieces, above]), limits, further.max(axis=0, initial=0.0), margin)

    @property
    def _extent(self) -> float:
        """No two points are farther apart, mm."""
        radius_of_all = float(self.tree.shape[0, 10])
        return 2.0 * radius_of_all


class _ToolTop(NamedTuple):
    """The uppermost component that is known of a tool, and its radius at the top, mm."""

    component: str
    radius: float


def _top_of(tool: Tool) -> _ToolTop:
    outlines = list(tool.outlines.items())
    if not outlines:
        component = "cutter" if tool.half_angle == 0 else "shank"
        return _ToolTop(component, tool.profile.top_radius)
    component, line = outlines[-1]
    radius, height = line.T
    is_at_top = height == height[-1]
    return _ToolTop(component, float(radius[is_at_top].max()))


def _closed_bodies(part: Part) -> tuple[tuple[Face, ...], ...]:
    """The faces of the bodies of a part, where all of them bound volumes and no face is missing; else none."""
    if part.left_out or not all(body.closed for body in part.bodies):
        return ()
    bodies = []
    for body in part.bodies:
        faces = [part.face(number) for number in sorted(set(body.faces))]
        if faces:
            bodies.append(tuple(own for face in faces for own in face.own_faces))
    return tuple(bodies)


def _highest_steps(mismatch: Mismatch) -> Array:
    """The highest step of each face, (faces,) mm."""
    spans = mismatch.span[:-1]
    return np.array([mismatch.segment[first:end, 6].max(initial=0.0) for first, end in spans])


def merge_reach_trees(trees: Sequence[BoundingTree]) -> ReachTree:
    """The trees of several faces under one root, in half the memory that they have.

    Parameters
    ----------
    trees : sequence of BoundingTree
        One for each face.
    """
    above = len(trees) - 1
    # Where the nodes, leaves and edges of each tree begin among those of all, and where the last ones end.
    nodes = above + _starts([len(tree.nodes) for tree in trees])
    leaves = _starts([len(tree.leaf) for tree in trees])
    edges = _starts([len(tree.edges) for tree in trees])
    shape = np.empty((nodes[-1], 11), dtype=np.float32)
    link = np.empty((nodes[-1], 5), dtype=np.int32)
    bend = np.empty((leaves[-1], 10), dtype=np.float32)
    rect = np.empty((leaves[-1], 7))
    if above:
        roots = np.stack([tree.shape[0] for tree in trees])
        shape[:above], link[:above] = branch_roots(roots, nodes[:-1])
    for k, tree in enumerate(trees):
        own_nodes = slice(nodes[k], nodes[k + 1])
        own_leaves = slice(leaves[k], leaves[k + 1])
        shape[own_nodes] = tree.shape
        shifts = np.array([nodes[k], nodes[k], k, leaves[k]])
        link[own_nodes, :4] = np.where(tree.link[:, :4] >= 0, tree.link[:, :4] + shifts, -1)
        link[own_nodes, 4] = tree.link[:, 4]
        leaf_of_node = tree.link[:, 3]
        at_leaves = leaf_of_node >= 0
        bend[leaves[k] + leaf_of_node[at_leaves]] = tree.bend[at_leaves]
        rect[own_leaves] = tree.leaf[:, _RECTANGLE]
    starts = [tree.edge_start[:-1] + edges[k] for k, tree in enumerate(trees)]
    edge_start = np.concatenate([*starts, edges[-1:]]).astype(np.int64)
    return ReachTree(shape, link, bend, rect, edge_start, np.vstack([tree.edges for tree in trees]))


def _starts(counts: list[int]) -> NDArray[np.int64]:
    """Where each of some blocks begins that stand one after the other, and where the last one ends."""
    return np.cumsum([0, *counts])
