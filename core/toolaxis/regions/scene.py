"""All that stands around a part, as trees of cells shared by every face, tool and axis."""

from collections.abc import Sequence
from dataclasses import dataclass

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
        faces = tuple(own for face in (*part.faces, *part.faces_of_held_side, *beside) for own in face.own_faces)
        tree = merge_reach_trees([cells(face) for face in faces])
        return ReachScene(part, beside, Tolerance() if tolerance is None else tolerance, limits, allowance, faces, tree,
                          PartSolid(_closed_bodies(part), tree))

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
        number = {id(own): row for row, own in enumerate(self.faces)}
        table = np.full((len(self.faces) + 1, 4), -np.inf)
        for group in groups:
            rows = [number[id(own)] for own in group.faces]
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
        outlines = list(tool.outlines.items())
        name, top = outlines[-1] if outlines else ("cutter" if tool.half_angle == 0 else "shank", None)
        limits = required.copy()
        own = self.tolerance.for_cutter(tool.radius)  # `required` is asked of all tools, before one is known
        limits[:, COMPONENTS.index("shank")] -= self.tolerance.shank_clearance - own.shank_clearance
        held = np.isfinite(limits[:, _ABOVE])
        limits[held, _ABOVE] = limits[held, COMPONENTS.index(name)]
        radius = tool.profile.top_radius if top is None else float(top[top[:, 1] == top[-1, 1], 0].max())
        above = [radius, 0.0, 1.0, 0.0, tool.height, tool.height + self._extent, radius, _ABOVE]
        cutter = limits[:-1, :1]
        # Where the cutter need not keep off a face, what is known of it there says nothing of the others.
        further = np.where(np.isfinite(limits[:-1]), limits[:-1] - cutter, 0.0).max(axis=0, initial=0.0)
        margin = float(np.abs(cutter[np.isfinite(cutter)]).max(initial=0.0))
        return ReachTool(np.vstack([tool.pieces, above]), limits, further, margin)

    @property
    def _extent(self) -> float:
        """No two places are farther apart, mm."""
        return 2.0 * float(self.tree.shape[0, 10])


def _closed_bodies(part: Part) -> tuple[tuple[Face, ...], ...]:
    """The faces of the bodies of a part, where all of them bound volumes and no face is missing; else none."""
    if part.left_out or not all(body.closed for body in part.bodies):
        return ()
    return tuple(tuple(own for number in sorted(set(body.faces)) for own in part.face(number).own_faces)
                 for body in part.bodies if body.faces)


def _highest_steps(mismatch: Mismatch) -> Array:
    """The highest step of each face, (faces,) mm."""
    spans = mismatch.span[:-1]
    return np.array([mismatch.segment[first:end, 6].max(initial=0.0) for first, end in spans])


def merge_reach_trees(trees: Sequence[BoundingTree]) -> ReachTree:
    """The trees of several faces under one root, in half the room that they have.

    Parameters
    ----------
    trees : sequence of BoundingTree
        One for each face.
    """
    above = len(trees) - 1
    nodes = above + np.cumsum([0, *(len(tree.nodes) for tree in trees)])
    leaves = np.cumsum([0, *(len(tree.leaf) for tree in trees)])
    edges = np.cumsum([0, *(len(tree.edges) for tree in trees)])
    shape = np.empty((nodes[-1], 11), dtype=np.float32)
    link = np.empty((nodes[-1], 5), dtype=np.int32)
    bend = np.empty((leaves[-1], 10), dtype=np.float32)
    rect = np.empty((leaves[-1], 7))
    if above:
        shape[:above], link[:above] = branch_roots(np.stack([tree.shape[0] for tree in trees]), nodes[:-1])
    for k, tree in enumerate(trees):
        own = slice(nodes[k], nodes[k + 1])
        shape[own] = tree.shape
        shifts = np.array([nodes[k], nodes[k], k, leaves[k]])
        link[own, :4] = np.where(tree.link[:, :4] >= 0, tree.link[:, :4] + shifts, -1)
        link[own, 4] = tree.link[:, 4]
        at = np.flatnonzero(tree.link[:, 3] >= 0)
        place = leaves[k] + tree.link[at, 3]
        bend[place] = tree.bend[at]
        rect[leaves[k]:leaves[k + 1]] = tree.leaf[:, [0, 1, 2, 3, 8, 9, 10]]
    start = np.concatenate([*(tree.edge_start[:-1] + edges[k] for k, tree in enumerate(trees)), edges[-1:]])
    return ReachTree(shape, link, bend, rect, start.astype(np.int64), np.vstack([tree.edges for tree in trees]))
