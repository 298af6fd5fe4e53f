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
    lines = AxisLines.look(face, tools, required, scene, max(_FEWEST_CONES, most_pairs // _PAIRS_FOR_CONE))
    proofs = _proofs(tools, scene, required)
    corners = CornerGouges.look(face, [proof.ball for proof in proofs], lines.left,
                                max(_FEWEST_CELLS, most_pairs // _PAIRS_FOR_CELL))
    cells = corners.left.pick(np.sort(np.argsort(-corners.left.area, kind="stable")[:_MOST_FIRST]))
    for proof in proofs:
        proof.begin(len(cells))
    proven = float(sum(some.area.sum() for some in (*lines.proven, *corners.proven)))
    by_corner, reached = float(sum(some.area.sum() for some in corners.proven)), 0.0
    found = [some.rectangles for some in (*lines.proven, *corners.proven)]
    tried = 0
    for halving in range(_HALVINGS + 1):
        surely, narrow = _smallest_gouges(proofs, cells)
        met = np.zeros(len(cells), dtype=bool)
        open_ = narrow & ~surely
        for proof in proofs:
            tried += proof.close(cells, ~narrow & ~met, met, most_pairs - tried)
            open_[proof.pairs.cell] |= ~narrow[proof.pairs.cell]
        closed = ~surely & ~met & ~open_
        claimed = np.flatnonzero(surely | closed)
        unlike = claimed[~is_as_measured(face, cells.pick(claimed))]
        surely[unlike], closed[unlike] = False, False  # it stays undecided
        by_corner += float(cells.area[surely].sum())
        proven += float(cells.area[surely | closed].sum())
        reached += float(cells.area[met].sum())
        found.append(cells.rectangles[surely | closed])
        is_left = open_ & ~met
        left = np.flatnonzero(is_left)
        # A cell is halved only where each of its pairs may be looked at once more at least.
        waiting = sum(int(is_left[proof.pairs.cell].sum()) for proof in proofs)
        if not len(left) or halving == _HALVINGS or 4 * len(left) > _MOST_CELLS or tried + waiting > most_pairs:
            break
        cells, parent = halve_rectangles(face, cells.pick(left))
        for proof in proofs:
            proof.hand_down(left, parent)
    whole = face.area
    proven = min(proven, whole)
    return OutOfReach(proven, min(by_corner, proven), min(reached, whole - proven), np.concatenate(found))


def _smallest_gouges(proofs: Sequence["_Proof"], cells: FaceRectangles) -> tuple[Bools, Bools]:
    """Where the smallest ball of all tools gouges, as `CornerBall.gouges`."""
    ball = smallest_ball([proof.ball for proof in proofs])
    if ball is None:
        return np.zeros(len(cells), dtype=bool), np.zeros(len(cells), dtype=bool)
    return ball.gouges(cells)


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
        self._scene, self._tool, self._search = scene, tool, search
        self.ball = CornerBall(tool, search, required, scene.allowance)
        whole = scene.tool(tool, required)
        self._plain = ToolSlices(whole.pieces, whole.limits[:, whole.pieces[:, 7].astype(int)],
                                 np.zeros(len(whole.pieces)))
        self._slices = cut_into_slices(whole, tool.corner_radius)
        self._core = cut_into_slices(take_off(whole, tool.flat_radius), tool.corner_radius)

    def begin(self, cells: int) -> None:
        """Pair so many cells with cones over the whole sphere."""
        cones = first_cones()
        cell, cone = (side.ravel() for side in np.indices((cells, len(cones))))
        self.pairs = CellCones(cell, cones.pick(cone))

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
        waiting = self.pairs.pick(~surely[self.pairs.cell])
        now = asked & ~narrow
        kept, waiting = waiting.pick(~now[waiting.cell]), waiting.pick(now[waiting.cell])
        size = min(_AT_ONCE, max(most, _LEAST_BLOCK))
        undecided, blocks, tried = [kept], deque(waiting.blocks(size)), 0
        while blocks and tried <= most:
            breathe()
            block = blocks.popleft()
            block = block.pick(self._may_touch(cells, block) & ~met[block.cell])
            tried += len(block.cell)
            open_, wide = self._try(cells, block, met)
            undecided.append(open_.pick(~wide))
            blocks.extend(open_.pick(wide).halve().blocks(size))
        kept = CellCones.join_all([*undecided, *blocks])
        self.pairs = kept.pick(~met[kept.cell])
        return tried

    def _try(self, cells: FaceRectangles, pairs: CellCones, met: Bools) -> tuple[CellCones, Bools]:
        """The pairs that are not decided, and which of them had better be halved in their cones than in their cells."""
        cones = pairs.cones
        pairs = pairs.pick(np.lexsort((pairs.cell, cones.place[:, 1], cones.place[:, 0], cones.side, cones.half)))
        axes, radius = pairs.cones.middle, pairs.cones.radius
        places = tips(cells.point[pairs.cell], cells.normal[pairs.cell], axes, self._tool, self._scene.allowance)
        off = self._off(cells, pairs, axes, radius)
        blocked = self._search.blocked(self._slices, radius, off, places, axes)
        if self._tool.flat_radius > 0:
            rest = np.flatnonzero(~blocked)
            blocked[rest] = self._core_blocked(cells, pairs.pick(rest), axes[rest], radius[rest])
        open_ = np.flatnonzero(~blocked)
        pairs, places, axes, radius = pairs.pick(open_), places[open_], axes[open_], radius[open_]
        none = np.zeros(len(axes))
        free = ~self._search.blocked(self._plain, none, none, places, axes)
        met[pairs.cell[free & self._is_seen(cells, pairs, axes)]] = True
        own = self.ball.off(cells)[pairs.cell]
        return pairs, (radius * (self._tool.stickout or self._tool.height) >= own) & (radius > _NARROW)

    def _core_blocked(self, cells: FaceRectangles, pairs: CellCones, axes: Array, radius: Array) -> Bools:
        """Whether what the tool has around the ball at its contact is blocked, to whichever side its axis lies."""
        corner = self._tool.corner_radius
        normal = cells.normal[pairs.cell]
        places = cells.point[pairs.cell] + (corner + self._scene.allowance) * normal - corner * axes
        return self._search.blocked(self._core, radius, self.ball.off(cells)[pairs.cell], places, axes)

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
        axes, radius, tool = pairs.cones.middle, pairs.cones.radius, self._tool
        angle = np.asarray(angle_between(axes, cells.normal[pairs.cell]))
        slack = cells.turn[pairs.cell] + radius
        found = angle - slack <= np.pi / 2 - tool.half_angle
        found &= angle + slack >= self._scene.tolerance.least_angle(tool.flat_radius)
        limits = self._scene.limits
        return np.asarray(found if limits is None or not len(axes) else found & (limits.excess(axes) <= radius))

    def _is_seen(self, cells: FaceRectangles, pairs: CellCones, axes: Array) -> Bools:
        """Whether the axes themselves touch the contacts."""
        angle = np.asarray(angle_between(axes, cells.normal[pairs.cell]))
        found = angle <= np.pi / 2 - self._tool.half_angle
        found &= angle >= self._scene.tolerance.least_angle(self._tool.flat_radius)
        limits = self._scene.limits
        return np.asarray(found if limits is None or not len(axes) else found & limits.allowed(axes))

    def _off(self, cells: FaceRectangles, pairs: CellCones, axes: Array, radius: Array) -> Array:
        """How far the middle of the corner circle is from where it is in the middle of cell and cone, mm."""
        off, flat = self.ball.off(cells)[pairs.cell], self._tool.flat_radius
        if flat <= 0:
            return off
        angle = np.asarray(angle_between(axes, cells.normal[pairs.cell]))
        return np.asarray(off + shift_of_axis(flat, angle, cells.turn[pairs.cell] + radius, radius))
