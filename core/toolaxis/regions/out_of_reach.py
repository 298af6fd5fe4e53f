"""What of a face no tool of a rack reaches under any axis that is allowed: proven cell by cell, cone by cone.

A cell is a rectangle of the parameters, a cone a set of axes around its middle.  A tool that touches the cell anywhere,
with any axis of the cone, differs in place and direction from the tool in the middle of both by no more than a known
distance at each height.  Where the tool in the middle gouges, or meets something, by more than that, so does each of
them.  What is not decided is halved: the cone or the cell, whichever leaves more room.
"""

from collections import deque
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.placement import tips
from toolaxis.numeric.vectors import angle_between
from toolaxis.progress import breathe
from toolaxis.regions.axis_cones import CellCones, first_cones, shift_of_axis
from toolaxis.regions.axis_lines import AxisLines
from toolaxis.regions.corner_gouges import CornerBall, CornerGouges, smallest_ball
from toolaxis.regions.rectangles import FaceRectangles, halve_rectangles, is_as_measured
from toolaxis.regions.scene import ReachScene
from toolaxis.regions.tool_slices import ToolSearch, ToolSlices, cut_into_slices, take_off
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

#: How often undecided cells are halved each way, and how many there may be at once.
_HALVINGS, _MOST_CELLS = 4, 6000
#: Radius of cones that are not halved any more, rad, and pairs of a cell and a cone that are tried for a face in all.
_NARROW, MOST_PAIRS = np.radians(1.5), 600_000
#: Pairs that are looked at together at most, as many more take gigabytes, and where fewer are left to try.
_AT_ONCE, _LEAST_BLOCK = 200_000, 1000
#: Pairs in place of which one more cone of lines may be looked along, and how many may be in any case.
_PAIRS_FOR_CONE, _FEWEST_CONES = 150, 500
#: Pairs in place of which one cell may be looked at for corners alone, and how many may be in any case; largest ones of
#: what is left then that are paired with cones.
_PAIRS_FOR_CELL, _FEWEST_CELLS, _MOST_FIRST = 15, 5000, 400


class OutOfReach(NamedTuple):
    """What of a face is proven to be out of reach of all tools.

    area : float, mm^2;  by_corner : float, mm^2 of it where the corner of each tool is too large for the face;
    reached : float, mm^2 of the cells in whose middle a tool may stand.  The rest is not decided.
    rectangles : (m, 4) array, least and greatest u, least and greatest v of the cells in which that is proven.
    """

    area: float
    by_corner: float
    reached: float
    rectangles: Array


def prove_out_of_reach(face: Face, tools: Sequence[Tool], scene: ReachScene,
                       most_pairs: int = MOST_PAIRS) -> OutOfReach:
    """How much of a face no tool can touch under any axis without gouging or meeting something.

    Parameters
    ----------
    face : Face
        Of the scene's part, or a piece of one.
    tools : sequence of Tool
    scene : ReachScene
        With the limits of the axes.
    most_pairs : int
        Pairs of a cell and a cone that are tried, about.

    Returns
    -------
    OutOfReach

    Notes
    -----
    A tool touches a place where its surface has the place's normal.  What is claimed holds for every place of a cell
    and every axis, but for how far cells reach and their normals turn, which is told from nine places of each with a
    tenth added and looked at once more at many places before it is claimed, and for faces that are known to the
    remainder of their cells.

    **Properties**: 1. no tool at any contact in what is proven, with any axis within the limits, passes the exact check
    of `toolaxis.feasibility.feasibility.Feasibility.reach`; 2. areas add up to no more than that of the face.
    """
    required = scene.required(face, steps_count=False)  # the exact check does not charge steps to the cutter
    most_cones = max(_FEWEST_CONES, most_pairs // _PAIRS_FOR_CONE)
    lines = AxisLines.look(face, tools, required, scene, most_cones)
    proofs = _proofs(tools, scene, required)
    balls = [proof.ball for proof in proofs]
    most_cells = max(_FEWEST_CELLS, most_pairs // _PAIRS_FOR_CELL)
    corners = CornerGouges.look(face, balls, lines.left, most_cells)
    cells = _largest(corners.left, _MOST_FIRST)
    for proof in proofs:
        proof.begin(len(cells))
    before = (*lines.proven, *corners.proven)
    proven = float(sum(some.area.sum() for some in before))
    by_corner = float(sum(some.area.sum() for some in corners.proven))
    reached = 0.0
    found = [some.rectangles for some in before]
    tried = 0
    for halving in range(_HALVINGS + 1):
        surely, narrow = _smallest_gouges(proofs, cells)
        met = np.zeros(len(cells), dtype=bool)
        open_ = narrow & ~surely
        for proof in proofs:
            tried += proof.close(cells, ~narrow & ~met, met, most_pairs - tried)
            waits = proof.pairs.cell
            open_[waits] |= ~narrow[waits]
        closed = ~surely & ~met & ~open_
        claimed = np.flatnonzero(surely | closed)
        unlike = claimed[~is_as_measured(face, cells.pick(claimed))]
        surely[unlike] = False  # it stays undecided
        closed[unlike] = False
        is_proven = surely | closed
        by_corner += float(cells.area[surely].sum())
        proven += float(cells.area[is_proven].sum())
        reached += float(cells.area[met].sum())
        found.append(cells.rectangles[is_proven])
        is_left = open_ & ~met
        left = np.flatnonzero(is_left)
        if not len(left) or halving == _HALVINGS or 4 * len(left) > _MOST_CELLS:
            break
        # A cell is halved only where each of its pairs may be looked at once more at least.
        waiting = sum(int(is_left[proof.pairs.cell].sum()) for proof in proofs)
        if tried + waiting > most_pairs:
            break
        cells, parent = halve_rectangles(face, cells.pick(left))
        for proof in proofs:
            proof.hand_down(left, parent)
    whole = face.area
    proven = min(proven, whole)
    return OutOfReach(proven, min(by_corner, proven), min(reached, whole - proven), np.concatenate(found))


def _largest(cells: FaceRectangles, most: int) -> FaceRectangles:
    """The largest of some cells, in their order."""
    largest_first = np.argsort(-cells.area, kind="stable")
    return cells.pick(np.sort(largest_first[:most]))


def _smallest_gouges(proofs: Sequence["_Proof"], cells: FaceRectangles) -> tuple[Bools, Bools]:
    """Where the smallest ball of all tools gouges, as `CornerBall.gouges`."""
    ball = smallest_ball([proof.ball for proof in proofs])
    if ball is not None:
        return ball.gouges(cells)
    number = len(cells)
    return np.zeros(number, dtype=bool), np.zeros(number, dtype=bool)


def _proofs(tools: Sequence[Tool], scene: ReachScene, required: Array) -> list["_Proof"]:
    """A proof for each tool, the slim ones first: what they reach need not be asked of the others."""
    search = ToolSearch(scene)
    slim = sorted(tools, key=lambda tool: (tool.radius, tool.corner_radius))
    return [_Proof(scene, tool, required, search) for tool in slim]


class _Proof:
    """One tool held against what stands around a face.

    Attributes
    ----------
    ball : CornerBall
    pairs : CellCones
        The cells and cones of which it is not known whether the tool may touch the one with the other; none before
        `begin`.
    """

    def __init__(self, scene: ReachScene, tool: Tool, required: Array, search: ToolSearch) -> None:
        self._scene = scene
        self._tool = tool
        self._search = search
        self.ball = CornerBall(tool, search, required, scene.allowance)
        whole = scene.tool(tool, required)
        component = whole.pieces[:, 7].astype(int)
        nothing = np.zeros(len(whole.pieces))
        self._plain = ToolSlices(whole.pieces, whole.limits[:, component], nothing)
        self._slices = cut_into_slices(whole, tool.corner_radius)
        self._core = cut_into_slices(take_off(whole, tool.flat_radius), tool.corner_radius)

    def begin(self, cells: int) -> None:
        """Pair so many cells with cones over the whole sphere."""
        cones = first_cones()
        cell, cone = np.indices((cells, len(cones)))
        self.pairs = CellCones(cell.ravel(), cones.pick(cone.ravel()))

    def close(self, cells: FaceRectangles, asked: Bools, met: Bools, most: int) -> int:
        """Leave those pairs of which nothing is known; note in met (n,) the cells that the tool reaches in the middle.

        Parameters
        ----------
        cells : FaceRectangles
        asked : (n,) array of bool
            Of which cells pairs are to be looked at.
        met : (n,) array of bool
        most : int
            Pairs that may be looked at; a block more is begun where some are left.

        Returns
        -------
        int
            How many pairs were looked at.
        """
        surely, narrow = self.ball.gouges(cells)
        pairs = self.pairs.pick(~surely[self.pairs.cell])
        now = (asked & ~narrow)[pairs.cell]
        kept = pairs.pick(~now)
        waiting = pairs.pick(now)
        size = min(_AT_ONCE, max(most, _LEAST_BLOCK))
        undecided = [kept]
        blocks = deque(waiting.blocks(size))
        tried = 0
        while blocks and tried <= most:
            breathe()
            block = blocks.popleft()
            block = block.pick(self._may_touch(cells, block) & ~met[block.cell])
            tried += len(block.cell)
            open_, wide = self._try(cells, block, met)
            undecided.append(open_.pick(~wide))
            halves = open_.pick(wide).halve()
            blocks.extend(halves.blocks(size))
        kept = CellCones.join_all([*undecided, *blocks])
        self.pairs = kept.pick(~met[kept.cell])
        return tried

    def _try(self, cells: FaceRectangles, pairs: CellCones, met: Bools) -> tuple[CellCones, Bools]:
        """The pairs that are not decided, and which of them had better be halved in their cones than in their cells."""
        cones = pairs.cones
        order = np.lexsort((pairs.cell, cones.place[:, 1], cones.place[:, 0], cones.side, cones.half))
        pairs = pairs.pick(order)
        axes = pairs.cones.middle
        radius = pairs.cones.radius
        point = cells.point[pairs.cell]
        normal = cells.normal[pairs.cell]
        places = tips(point, normal, axes, self._tool, self._scene.allowance)
        off = self._off(cells, pairs, axes, radius)
        blocked = self._search.blocked(self._slices, radius, off, places, axes)
        if self._tool.flat_radius > 0:
            rest = np.flatnonzero(~blocked)
            blocked[rest] = self._core_blocked(cells, pairs.pick(rest), axes[rest], radius[rest])
        open_ = np.flatnonzero(~blocked)
        pairs = pairs.pick(open_)
        axes = axes[open_]
        radius = radius[open_]
        none = np.zeros(len(axes))
        free = ~self._search.blocked(self._plain, none, none, places[open_], axes)
        stands = free & self._is_seen(cells, pairs, axes)
        met[pairs.cell[stands]] = True
        of_cell = self.ball.off(cells)[pairs.cell]
        of_cone = radius * (self._tool.stickout or self._tool.height)
        return pairs, (of_cone >= of_cell) & (radius > _NARROW)

    def _core_blocked(self, cells: FaceRectangles, pairs: CellCones, axes: Array, radius: Array) -> Bools:
        """Whether what the tool has around the ball at its contact is blocked, to whichever side its axis lies."""
        corner = self._tool.corner_radius
        normal = cells.normal[pairs.cell]
        places = cells.point[pairs.cell] + (corner + self._scene.allowance) * normal - corner * axes
        off = self.ball.off(cells)[pairs.cell]
        return self._search.blocked(self._core, radius, off, places, axes)

    def hand_down(self, left: Indices, parent: Indices) -> None:
        """Give the pairs of cells to their quarters.

        Parameters
        ----------
        left, parent : arrays of int
            As `toolaxis.regions.axis_cones.CellCones.hand_down`.
        """
        self.pairs = self.pairs.hand_down(left, parent)

    def _may_touch(self, cells: FaceRectangles, pairs: CellCones) -> Bools:
        """Whether any axis of a cone may touch any place of a cell, by its angle to the normals and by the limits."""
        axes = pairs.cones.middle
        radius = pairs.cones.radius
        tool = self._tool
        angle = np.asarray(angle_between(axes, cells.normal[pairs.cell]))
        slack = cells.turn[pairs.cell] + radius
        found = angle - slack <= np.pi / 2 - tool.half_angle
        found &= angle + slack >= self._scene.tolerance.least_angle(tool.flat_radius)
        limits = self._scene.limits
        if limits is not None and len(axes):
            found = found & (limits.excess(axes) <= radius)
        return np.asarray(found)

    def _is_seen(self, cells: FaceRectangles, pairs: CellCones, axes: Array) -> Bools:
        """Whether the axes themselves touch the contacts."""
        tool = self._tool
        angle = np.asarray(angle_between(axes, cells.normal[pairs.cell]))
        found = angle <= np.pi / 2 - tool.half_angle
        found &= angle >= self._scene.tolerance.least_angle(tool.flat_radius)
        limits = self._scene.limits
        if limits is not None and len(axes):
            found = found & limits.allowed(axes)
        return np.asarray(found)

    def _off(self, cells: FaceRectangles, pairs: CellCones, axes: Array, radius: Array) -> Array:
        """How far the middle of the corner circle is from where it is in the middle of cell and cone, mm."""
        off = self.ball.off(cells)[pairs.cell]
        flat = self._tool.flat_radius
        if flat <= 0:
            return off
        angle = np.asarray(angle_between(axes, cells.normal[pairs.cell]))
        turn = cells.turn[pairs.cell] + radius
        return np.asarray(off + shift_of_axis(flat, angle, turn, radius))
