"""What of a face is out of reach as the axis of every tool runs through material: a line in place of many tools.

Each tool that touches a place holds a line along its axis that begins near a point above the place, a little inside it
all the way up.  Where every such line, from all places of a cell and along all axes, meets the material of the part, no
tool reaches the cell.  One line stands for a whole rack, and one sweep of the part's grid tells of all cells of a face
whether all lines along a cone of axes are met.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import angle_between
from toolaxis.progress import breathe
from toolaxis.regions.axis_cones import AxisCones, first_cones, shift_of_axis
from toolaxis.regions.cell_levels import CellLevels
from toolaxis.regions.rectangles import FaceRectangles, first_rectangles
from toolaxis.regions.scene import ReachScene
from toolaxis.regions.solid_grid import SolidGrid
from toolaxis.regions.solid_kernel import ConeLines, sweep_lines
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

#: How far inside each tool its line runs, mm: deeper than a cutter may be in a face.
_INSIDE = 0.1
#: Up to which share of a tool its own line runs, and how far lines of tools may begin from the common one, mm.
_UP_TO, _FARTHEST = 0.9, 1.0
#: Highest beginning of a thick line above the contact, and steps in which tools are looked at along it, mm.
_HIGHEST, _FINE = 2.0, 0.1
#: How far cells lie one behind the other for which thick lines are looked along together, mm.
_SLAB = 5.0
#: How far most cells may reach whose middles are looked at first, mm, and how many cells there may be.
_WIDE, _MOST_CELLS = 1.3, 20_000
#: How often those cells are halved each way of which all is looked at; smaller ones are tried where so much of the
#: area of the last ones was proven.
_HALVINGS, _WORTH = 2, 0.03
#: How often cones are halved each way, and length of what has no direction.
_HALVED, _NO_WAY = 2, 1e-12
#: Coordinates turned so that one of them comes first.
_TURNED = ([0, 1, 2], [1, 2, 0], [2, 0, 1])


class AxisLine(NamedTuple):
    """A line along the axis that a tool holds, or each of several.

    above : float, mm along the normal from the contact, and  aside : float, mm towards the axis of the tool and square
    to it, to where it begins;  off : float, mm, how far from there the line of a tool may begin;  thick : float, mm
    along it from where on balls around it lie in the tool that are as thick as was asked for;  length : float, mm.
    """

    above: float
    aside: float
    off: float
    thick: float
    length: float


class RackLines(NamedTuple):
    """The lines of some tools: one that all of them hold, which is nowhere thick, and thick ones, each of which some of
    them hold and all of them one; and the greatest angle of an axis and a normal that any of them touches with, rad."""

    common: AxisLine
    thick: tuple[AxisLine, ...]
    steepest: float


def lines_of_rack(tools: Sequence[Tool], required: Array, enough: float) -> RackLines | None:
    """The lines of some tools, or None where they have none in common, or where a face may lie as deep in a tool.

    Parameters
    ----------
    tools : sequence of Tool
    required : (faces + 1, 4) array
        Of `toolaxis.regions.scene.ReachScene.required`.
    enough : float
        Radius around a line that is thick, mm.
    """
    if not tools or not (required[:-1, :3] > -_INSIDE).all():
        return None
    above = min(tool.corner_radius for tool in tools)
    off = max(_off(tool, above) for tool in tools)
    length = min(_UP_TO * (tool.height - tool.corner_radius) for tool in tools)
    if off > _FARTHEST or length <= 0:
        return None
    thick: dict[tuple[float, float], AxisLine] = {}
    for line in (_thick_line(tool, enough) for tool in sorted(tools, key=lambda one: (one.radius, one.corner_radius))):
        known = thick.get((line.above, line.aside), line)
        thick[line.above, line.aside] = known._replace(thick=max(line.thick, known.thick),
                                                       length=min(line.length, known.length))
    steepest = np.pi / 2 - min(tool.half_angle for tool in tools)
    return RackLines(AxisLine(above, 0.0, off, np.inf, length), tuple(thick.values()), steepest)


def _thick_line(tool: Tool, enough: float) -> AxisLine:
    """A line of a tool around which it is thick from some place on."""
    corner, flat, wall = tool.corner_radius, tool.flat_radius, enough + _INSIDE + _FINE
    above = min(corner, _HIGHEST)
    aside = min(flat, max(wall - above, 0.0))
    # The line runs nowhere farther from the axis, and a ball around it lies in a tool that is as wide all along.
    high = np.arange(0.0, _UP_TO * tool.height, _FINE)
    wide = flat - aside + corner - above + wall
    narrow = tool.distance(np.column_stack([np.full(len(high), wide), np.zeros(len(high)), high])).value > 0
    lowest = float(high[narrow].max(initial=0.0)) + _FINE + wall
    # It begins no lower than this, and no higher than the corner's middle.
    return AxisLine(above, aside, 0.0, max(lowest - above, 0.0), float(high[-1]) - wall - corner)


def _off(tool: Tool, above: float) -> float:
    """How far from the common beginning the line of a tool has to begin to stay inside it all the way up, mm."""
    own, flat = min(tool.corner_radius, above), tool.flat_radius
    sides = np.concatenate([tool.pieces[1:, [0, 6]].ravel(), [flat + tool.corner_radius * np.cos(tool.half_angle)]])
    # The line lies as far from the axis as the corner's middle does, and farther by what it begins below that.
    aside = flat + tool.corner_radius - own
    inwards = max(aside + _INSIDE - float(sides.min()), 0.0)
    return above - own + inwards + max(_INSIDE - own, 0.0)


class AxisLines(NamedTuple):
    """What lines alone tell of a face.

    proven : list of FaceRectangles, cells that no tool reaches;  left : FaceRectangles, the largest cells in which
    nothing is proven.
    """

    proven: list[FaceRectangles]
    left: FaceRectangles

    @staticmethod
    def look(face: Face, tools: Sequence[Tool], required: Array, scene: ReachScene, most: int) -> "AxisLines":
        """Look along the axes of tools at a face.

        Parameters
        ----------
        face : Face
        tools : sequence of Tool
        required : (faces + 1, 4) array
            What they have to keep, of `toolaxis.regions.scene.ReachScene.required`.
        scene : ReachScene
        most : int
            Cones of axes that are looked along for cells of one size.
        """
        levels, grid = CellLevels(face, first_rectangles(face)), scene.solid.grid
        rack = None if grid is None else lines_of_rack(tools, required, grid.away)
        if grid is None or rack is None:
            return AxisLines(*levels.gather())
        shadow = _Shadow(rack, scene, grid, most)
        while levels.reach > _WIDE and levels.halve(_MOST_CELLS):
            pass
        # Most faces are open to the sky: the middles of their cells tell that at once.
        levels.keep_beside(shadow.covers(levels.cells.shrink()))
        for _ in range(_HALVINGS):
            if not levels.halve(_MOST_CELLS):
                break
            if levels.claim(shadow.covers(levels.cells)) < _WORTH * float(levels.cells.area.sum()):
                break
        return AxisLines(*levels.gather())


class _Cone(NamedTuple):
    """A cone of axes: (1, p, q), or against that, with p and q of some range, the first along one of the coordinates.

    axis : (3,) array, its middle;  radius : float, rad;  main : int, that coordinate;  forth : int, 1 or -1;  slope,
    spread : (float, float), the middles of p and q, and by how much they differ from these at most.
    """

    axis: Array
    radius: float
    main: int
    forth: int
    slope: tuple[float, float]
    spread: tuple[float, float]

    @staticmethod
    def each_of(cones: AxisCones) -> list["_Cone"]:
        """Some cones, one by one."""
        low = np.tan(cones.place - cones.half[:, None])
        high = np.tan(cones.place + cones.half[:, None])
        slopes = ((low + high) / 2).tolist()
        spreads = ((high - low) / 2).tolist()
        axis, radius = cones.middle, cones.radius
        found = []
        for k, side in enumerate(cones.side.tolist()):
            forth = 1 if side < 3 else -1
            p, q = slopes[k]
            spread_p, spread_q = spreads[k]
            found.append(_Cone(axis[k], float(radius[k]), side % 3, forth, (p, q), (spread_p, spread_q)))
        return found


class _Shadow:
    """What the material of a part covers: places from which no line of a rack's tools gets out."""

    def __init__(self, rack: RackLines, scene: ReachScene, grid: SolidGrid, most: int) -> None:
        self._rack, self._scene, self._grid, self._most = rack, scene, grid, most
        self._looks = 0

    def covers(self, cells: FaceRectangles) -> Bools:
        """Which cells all lines of all tools meet material from, along all axes they may have, (n,).

        Parameters
        ----------
        cells : FaceRectangles
        """
        self._looks = 0
        covered = np.ones(len(cells), dtype=bool)
        cones = first_cones()
        # From where a face looks most lines get out, if any do: most cells are done with soon.
        order = np.argsort(-cones.middle @ cells.normal.sum(axis=0), kind="stable")
        for k in range(len(order)):
            self._look_along(cones.pick(order[k:k + 1]), 0, cells, np.arange(len(cells)), covered)
        return covered

    def _look_along(self, cones: AxisCones, halved: int, cells: FaceRectangles, rows: Indices, covered: Bools) -> None:
        """Strike out of covered (n,) those of some cells from which a line along an axis of some cones may get out.

        Parameters
        ----------
        cones : AxisCones
        halved : int
            How often they are halved already.
        cells : FaceRectangles
        rows : (k,) array of int
        covered : (n,) array of bool
        """
        for k, cone in enumerate(_Cone.each_of(cones)):
            some = rows[covered[rows]]
            some = some[self._may_touch(cells, some, cone)]
            if not len(some):
                continue
            if self._looks >= self._most:
                covered[some] = False
                return
            breathe()
            self._looks += 1
            some = some[~self._stops(self._rack.common, cells, some, cone)]
            if halved > 0 and len(some):
                some = some[~self._stops_thick(cells, some, cone)]
            if halved == _HALVED:
                covered[some] = False
            elif len(some):
                self._look_along(cones.pick(np.array([k])).halve(), halved + 1, cells, some, covered)

    def _may_touch(self, cells: FaceRectangles, rows: Indices, cone: _Cone) -> Bools:
        """Whether any tool may touch any place of some cells with any axis of a cone."""
        limits = self._scene.limits
        if limits is not None and limits.excess(cone.axis[None])[0] > cone.radius:
            return np.zeros(len(rows), dtype=bool)
        angle = np.asarray(angle_between(cone.axis, cells.normal[rows]))
        return np.asarray(angle - cells.turn[rows] - cone.radius <= self._rack.steepest)

    def _stops_thick(self, cells: FaceRectangles, rows: Indices, cone: _Cone) -> Bools:
        """Whether every thick line along the axes of a cone from some cells is met."""
        found = np.ones(len(rows), dtype=bool)
        # A line is thick only some way from where it begins: cells that lie one behind the other go apart.
        behind = np.floor(cells.point[rows, cone.main] / _SLAB)
        for slab in np.unique(behind):
            some = np.flatnonzero(behind == slab)
            for line in self._rack.thick:
                stopped = self._stops(line, cells, rows[some], cone)
                found[some[~stopped]] = False
                some = some[stopped]
                if not len(some):
                    break
        return found

    def _stops(self, line: AxisLine, cells: FaceRectangles, rows: Indices, cone: _Cone) -> Bools:
        """Whether every line along the axes of a cone from some cells is met, of which there is one at least."""
        grid, main = self._grid, cone.main
        start, off = self._beginnings(line, cells, rows, cone)
        lines = ConeLines(cone.forth, cone.slope, cone.spread, line.thick / grid.size, line.length / grid.size)
        stopped = np.zeros(len(rows), dtype=bool)
        sweep_lines(grid.open[main], grid.clear[main], lines, start[:, _TURNED[main]], off, stopped)
        return stopped

    def _beginnings(self, line: AxisLine, cells: FaceRectangles, rows: Indices, cone: _Cone) -> tuple[Array, Array]:
        """Where lines of some cells begin in the middle, and how far from there they may, in grid cells from its
        corner, (k, 3) and (k,)."""
        above, normal, turn = line.above + self._scene.allowance, cells.normal[rows], cells.turn[rows]
        start = cells.point[rows] + above * normal
        off = cells.off[rows] + 2 * above * np.sin(turn / 2) + line.off
        if line.aside > 0:
            across = normal - (normal @ cone.axis)[:, None] * cone.axis
            start += line.aside * across / np.maximum(np.linalg.norm(across, axis=1), _NO_WAY)[:, None]
            angle = np.asarray(angle_between(cone.axis, normal))
            off = off + shift_of_axis(line.aside, angle, turn + cone.radius, np.full(len(rows), cone.radius))
        return (start - self._grid.origin) / self._grid.size, off / self._grid.size
