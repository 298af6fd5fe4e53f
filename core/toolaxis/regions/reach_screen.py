"""Which cells of a face which tool can cut under which axis: fast, and wrong now and then to either side.

What it says is for choosing; the search and the proof of the passes decide.
"""

from collections.abc import Sequence
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.placement import tips
from toolaxis.numeric.vectors import angle_between, as_rows, unit
from toolaxis.regions.cells import FaceCells
from toolaxis.regions.reach_kernel import MOST_PIECES, ReachTips, ReachTool, find_blocked_tips
from toolaxis.regions.scene import ReachScene
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

#: Cells along the sides of the blocks that are looked at together.
_BLOCK = 4
#: Axes under which a tool reaches less than this share of what it reaches under the best one are passed over where
#: other axes reach a cell; how many cells have to tell which axes those are.
_PROMISING, _FEWEST = 0.7, 12
#: Height of the ball that stands for a cutter's corner, in its radius: a little more than its lower half.
_HALF = 1.0001
#: Radii of the balls that are tried at every contact, mm: each half as large again as the one before it.
_BALLS = 0.3 * 1.5 ** np.arange(14)


class ReachScreen:
    """The screening of cells; what all tools and axes share is found once.

    Parameters
    ----------
    cells : FaceCells
        Of a face of the scene's part, or of a piece of one.
    scene : ReachScene
    required : (faces + 1, 4) array, optional
        What tools have to keep, mm, of `ReachScene.required` where it is known.
    """

    def __init__(self, cells: FaceCells, scene: ReachScene, required: Array | None = None) -> None:
        self.cells, self.scene = cells, scene
        self._required = scene.required(cells.face) if required is None else required
        #: By corner radius, where the ball of a corner fits, (n,).
        self._corners: dict[float, Bools] = {}
        #: Radius of the largest ball of those tried that fits, mm, 0 for none, (n,).
        self._fitting: Array | None = None

    def pick(self, rows: Indices) -> "ReachScreen":
        """The screening of some of the cells.

        Parameters
        ----------
        rows : (m,) array of int
        """
        made = ReachScreen(self.cells.pick(rows), self.scene, self._required)
        made._corners = {radius: fits[rows] for radius, fits in self._corners.items()}
        made._fitting = self.largest_balls[rows]
        return made

    def screen(self, tools: Sequence[Tool], axes: ArrayLike, among: Bools | None = None) -> Bools:
        """Whether tools may stand at the contacts of the cells, as `screen_reach`.

        Parameters
        ----------
        tools : sequence of Tool
        axes : (k, 3) array_like
            Tool axes, tip to spindle.
        among : (tools, k, n) array of bool, optional
            What is asked for; all else is answered with False, and not looked at.

        Returns
        -------
        (tools, k, n) array of bool
        """
        cells, scene = self.cells, self.scene
        rows = np.asarray(unit(as_rows(axes, 3, "axes")))
        found = np.zeros((len(tools), len(rows), len(cells)), dtype=bool)
        if not len(cells):
            return found
        allowed = np.ones(len(rows), dtype=bool) if scene.limits is None else np.asarray(scene.limits.allowed(rows))
        for number, tool in enumerate(tools):
            seen = seen_cells(cells, tool, rows, scene.tolerance) & self._corner_fits(tool) & allowed[:, None]
            if among is not None:
                seen &= among[number]
            axis, cell = _side_by_side(cells, seen)
            found[number, axis, cell] = ~self._blocked(tool, rows[axis], cell)
        return found

    def _blocked(self, tool: Tool, axes: Array, cell: Indices) -> Bools:
        """Whether a tool comes too near to something at the contacts of cells (k,) under axes (k, 3)."""
        cells, scene = self.cells, self.scene
        point, normal = cells.point[cell], cells.normal[cell]
        places = tips(point, normal, axes, tool, scene.allowance)
        ball = np.maximum(self.largest_balls[cell], self._corner_of(tool))  # only asked where the corner's own fits
        ball = np.where(ball > 0, ball, -np.inf)
        centre = point + np.where(ball > 0, ball + scene.allowance, 0.0)[:, None] * normal
        asked = ReachTips(places, axes, normal, centre, ball)
        whole = scene.tool(tool, self._required)
        blocked = np.zeros(len(places), dtype=bool)
        for first in range(0, len(whole.pieces), MOST_PIECES):
            rest = np.flatnonzero(~blocked)
            some = whole._replace(pieces=np.ascontiguousarray(whole.pieces[first:first + MOST_PIECES]))
            blocked[rest] = find_blocked_tips(scene.tree, some, asked.pick(rest))
        return blocked

    @property
    def largest_balls(self) -> Array:
        """Radius of the largest ball of those tried that fits at each contact, mm, 0 where none does, (n,)."""
        if self._fitting is None:
            # Halved between the largest known to fit and the smallest known not to: what is inside one that fits does.
            fits = np.zeros(len(self.cells), dtype=int)
            misses = np.full(len(self.cells), len(_BALLS) + 1)
            while (open_ := misses - fits > 1).any():
                middle = (fits + misses) // 2
                for number in np.unique(middle[open_]):
                    rows = np.flatnonzero(open_ & (middle == number))
                    free = _ball_fits(self.cells.pick(rows), _BALLS[number - 1], self.scene, self._required)
                    fits[rows[free]], misses[rows[~free]] = number, number
            self._fitting = np.concatenate([[0.0], _BALLS])[fits]
        return self._fitting

    def screen_promising(self, tools: Sequence[Tool], axes: ArrayLike, among: Bools) -> Bools:
        """What `screen` says, of all cells for the axes under which a tool reaches most, and under others only of cells
        that the tool reaches under none of those.

        Parameters
        ----------
        tools : sequence of Tool
        axes : (k, 3) array_like
        among : (tools, k, n) array of bool
            As for `screen`.

        Returns
        -------
        (tools, k, n) array of bool

        Notes
        -----
        A quarter of the cells tells which axes those are: all that reach nearly as much of it as the best one.

        **Properties**: 1. never true where `screen` is not; 2. each tool reaches the same cells under any axis.
        """
        rows = np.asarray(unit(as_rows(axes, 3, "axes")))
        quarter = (self.cells.index % 2 == 0).all(axis=1)
        if quarter.sum() < _FEWEST:
            return self.screen(tools, rows, among)
        for tool in tools:  # found for all cells, it serves every part of them
            self._corner_fits(tool)
        some, others = np.flatnonzero(quarter), np.flatnonzero(~quarter)
        found = np.zeros((len(tools), len(rows), len(self.cells)), dtype=bool)
        found[:, :, some] = self.pick(some).screen(tools, rows, among[:, :, some])
        area = found @ self.cells.area
        for number, tool in enumerate(tools):
            promising = area[number] >= _PROMISING * area[number].max(initial=0.0)
            self._add(found[number], tool, rows, among[number] & promising[:, None], others)
            missed = others[~found[number].any(axis=0)[others]]
            self._add(found[number], tool, rows, among[number] & ~promising[:, None], missed)
        return found

    def _add(self, found: Bools, tool: Tool, axes: Array, among: Bools, some: Indices) -> None:
        """Enter what a tool reaches of some cells into (k, n)."""
        if len(some):
            found[:, some] |= self.pick(some).screen([tool], axes, among[None, :, some])[0]

    @staticmethod
    def _corner_of(tool: Tool) -> float:
        """Radius of the ball that a tool holds at its contact under any axis, mm; 0 for none."""
        return tool.corner_radius if tool.flute_length >= 2 * tool.corner_radius else 0.0

    def _corner_fits(self, tool: Tool) -> Bools:
        """Whether the ball of a tool's corner, held at its contact under any axis, keeps off everything, (n,)."""
        radius = self._corner_of(tool)
        if radius not in self._corners:
            self._corners[radius] = _ball_fits(self.cells, radius, self.scene, self._required)
        return self._corners[radius]


def screen_reach(cells: FaceCells, tools: Sequence[Tool], axes: ArrayLike, scene: ReachScene) -> Bools:
    """Whether tools may stand at the contacts of cells; where the same cells are asked again, see `ReachScreen`.

    Parameters
    ----------
    cells : FaceCells
        Of a face of the scene's part, or of a piece of one.
    tools : sequence of Tool
    axes : (k, 3) array_like
        Tool axes, tip to spindle; none outside the limits of the scene reaches anything.
    scene : ReachScene

    Returns
    -------
    (tools, k, n) array of bool
        True where the axis may touch all of the cell by the angle to its normals, and cutter, shank and holder at the
        cell's contact keep their distances from everything.

    Notes
    -----
    As `toolaxis.feasibility.feasibility.Feasibility.reach` at the same contacts, from the same cells around the faces
    but without their bounds: a place less than 0.05 mm across may be missed.

    **Properties**: 1. moving part and axes together changes nothing; 2. a tool inside a larger one
    reaches all that the larger one does.
    """
    return ReachScreen(cells, scene).screen(tools, axes)


def seen_cells(cells: FaceCells, tool: Tool, axes: Array, tolerance: Tolerance) -> Bools:
    """Which cells each axis may touch with a cutter, by the angles to their normals alone, (k, n).

    Parameters
    ----------
    cells : FaceCells
    tool : Tool
    axes : (k, 3) array
        Unit vectors.
    tolerance : Tolerance
        With the least angles between axis and normals.
    """
    angle = np.asarray(angle_between(axes[:, None], cells.normal[None]))
    seen = angle <= pi / 2 - tool.half_angle - cells.spread
    least = tolerance.least_angle(tool.flat_radius)
    if tool.flat_radius > 0 or least > 0:
        seen &= angle >= least + cells.spread
    return np.asarray(seen)


def _ball_fits(cells: FaceCells, radius: float, scene: ReachScene, required: Array) -> Bools:
    """Whether the ball that any cutter of a corner radius holds at its contact keeps off everything, (n,)."""
    if radius <= 0:
        return np.ones(len(cells), dtype=bool)
    ball = np.array([[0.0, radius, 1.0, 0.0, 0.0, _HALF * radius, radius, 0.0]])
    places = cells.point + scene.allowance * cells.normal
    return ~find_blocked_tips(scene.tree, ReachTool.of(ball, required), ReachTips.of(places, cells.normal))


def _side_by_side(cells: FaceCells, seen: Bools) -> tuple[Indices, Indices]:
    """Axes and cells of what is seen, an axis after the other, blocks of four by four cells together."""
    row, column = cells.index.T
    order = np.lexsort((column, row, column // _BLOCK, row // _BLOCK))
    axis, place = np.nonzero(seen[:, order])
    return axis, order[place]
