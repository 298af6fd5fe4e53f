"""Folds: places where a surface runs back on itself by next to nothing, as splines of CAD systems now and then do.

There Su x Sv turns over, and points into the material for a few thousandths of a millimetre.  The surface itself goes
straight on: seen from as far away as a machining tolerance it has one normal, that of the surface beside the fold.
"""

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.bezier import bezier_nets
from toolaxis.numeric.bspline import SurfaceData
from toolaxis.numeric.vectors import dot
from toolaxis.shape.differential import degenerate, normals
from toolaxis.shape.surface import Derivatives
from toolaxis.tolerances import LEAST

if TYPE_CHECKING:
    from toolaxis.shape.nurbs import NurbsSurface

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Index = NDArray[np.intp]

#: How far beside a place it is looked for what surrounds it, mm: folds of real parts run back by up to 0.004 mm.
REACH = 0.01
#: How far a fold may leave the planes of its surroundings, mm: no tolerance of a cut is less.
FLAT = LEAST
#: Cosines of the angle within which the normals beside a fold agree, and from which on one between contradicts them.
_AGREE, _AGAINST = float(np.cos(np.radians(20.0))), float(np.cos(np.radians(30.0)))
#: Greatest distance of the place beside, and of all places on the way, in `REACH`; where the border of the surface is
#: nearer than that on one side, a second place is looked for on the other side, so many times as far away.
_MOST, _AWAY, _SECOND = 1.5, 4.0, 2.5
#: Share of the greatest area per parameter below which the least one tells of places that may be next to a fold.
_EVEN = 0.9
#: Steps of the search for a place beside, and places on the way at which it is looked whether the surface is flat.
_STEPS, _ON_THE_WAY = 60, 17
#: Greatest distance, mm, of control points that are one point, a pole.
_ONE_POINT = 1e-9
#: Share of the longest leg of a net up to which another one has no length, and so no direction.
_VANISHES = 1e-9
#: Greatest share of a weight by which it differs from another that is meant to be the same.
_ROUNDING = 1e-12
#: Cells that a knot span is cut into, and cells along a parameter, at least; control points of nets at once.
_PARTS, _CELLS, _AT_ONCE = 2, 8, 500_000
#: How many times finer cells are tried where some of those may turn over.
_FINER = (2, 4, 8)
#: Cells that are tried at most, so that it takes less than a second.
_MOST_CELLS = 20_000


class TurningCells(NamedTuple):
    """Cells of a surface's parameters, and in which of them Su x Sv may turn over.

    lines_u (nu + 1,), lines_v (nv + 1,): borders of the cells;  turning (nu, nv): False where it surely does not, and
    the cell is no piece of a fold and not next to one.
    """

    lines_u: Array
    lines_v: Array
    turning: Bools

    def rows_in(self, uv: Array) -> Index:
        """Numbers of the parameters (n, 2) that lie in cells that may turn over."""
        if not self.turning.any():
            return np.empty(0, dtype=np.intp)
        i, in_u = _cells_along(self.lines_u, uv[:, 0])
        j, in_v = _cells_along(self.lines_v, uv[:, 1])
        return np.flatnonzero(in_u & in_v & self.turning[i, j])


def _cells_along(lines: Array, places: Array) -> tuple[Index, Bools]:
    """Numbers of the cells between lines in which places lie, and whether they lie in any."""
    within = (places >= lines[0]) & (places <= lines[-1])
    cell = np.searchsorted(lines, places, side="right") - 1
    return np.clip(cell, 0, len(lines) - 2), np.asarray(within)


class Folds(NamedTuple):
    """Places that lie in or next to folds.

    rows (k,): their numbers;  normal (k, 3): unit normals of the surface around each fold, in the sense of Su x Sv;
    beside (k, 2): parameters of a place beside each fold.
    """

    rows: Index
    normal: Array
    beside: Array


NO_FOLDS = Folds(np.empty(0, dtype=np.intp), np.empty((0, 3)), np.empty((0, 2)))


def find_turning_cells(data: SurfaceData) -> TurningCells:
    """Where Su x Sv of a surface may turn over, by the control points of its pieces.

    Parameters
    ----------
    data : tuple
        The surface.

    Notes
    -----
    Su of a piece lies in the cone of the legs of its control net along u, Sv in that of the legs along v.  Where the
    two cones share no line, Su and Sv are nowhere parallel.  Where that is so of all cells, however small, none is
    turned over.  Otherwise cells next to those that may turn over may lie within a fold, or beside it.  At a pole,
    where a whole side of a piece is one point, the derivative along that side is the distance from it times a factor:
    the cone is that of the factor.
    """
    found = _NetCells.of(data, 1)
    coarse = found.turning.size
    for finer in _FINER:
        if not found.turning.any() or coarse * finer**2 > _MOST_CELLS:
            break
        found = _NetCells.of(data, finer)
    return TurningCells(*found.lines, found.turning_or_near)


class _NetCells(NamedTuple):
    """Cells of a surface.

    lines : their borders along u and v
    turning : (nu, nv), which of them may turn over
    lengths : (2, nu, nv), their least lengths along u and v, mm
    """

    lines: tuple[Array, Array]
    turning: Bools
    lengths: Array

    @staticmethod
    def of(data: SurfaceData, finer: int) -> "_NetCells":
        """Cells so many times finer than usual."""
        knots_u, knots_v, _, pu, pv, _ = data
        lines_u = _cell_lines(knots_u, pu, finer)
        lines_v = _cell_lines(knots_v, pv, finer)
        step = max(1, _AT_ONCE // ((len(lines_v) - 1) * (pu + 1) * (pv + 1)))
        nets = [bezier_nets(data, lines_u[first:first + step + 1], lines_v)
                for first in range(0, len(lines_u) - 1, step)]
        turning = np.concatenate([_turning(one) for one in nets])
        lengths = np.concatenate([_lengths(one[..., :3] / one[..., 3:]) for one in nets], axis=1)
        return _NetCells((lines_u, lines_v), turning, lengths)

    @property
    def turning_or_near(self) -> Bools:
        """Which cells may turn over, or begin so near one that may that a fold can reach into them, (nu, nv)."""
        found = self.turning
        if not found.any():
            return found
        for axis in (0, 1):
            cells, lengths = np.moveaxis(found, axis, 0), np.moveaxis(self.lengths[axis], axis, 0)
            after = _within_reach_after(cells, lengths)
            before = _within_reach_after(cells[::-1], lengths[::-1])[::-1]
            found = np.moveaxis(cells | after | before, 0, axis)
        return found


def _within_reach_after(cells: Bools, lengths: Array) -> Bools:
    """Cells (n, m) that begin no farther behind marked ones than a fold is long, by the cells' lengths along n, mm."""
    found = np.zeros_like(cells)
    behind = np.full(cells.shape[1], np.inf)
    for k in range(len(cells)):
        found[k] = behind <= 2 * REACH
        behind = np.where(cells[k], 0.0, behind + lengths[k])
    return found


def _cell_lines(knots: Array, degree: int, finer: int) -> Array:
    """The knots of the domain and lines that cut the spans between them evenly."""
    ends = np.unique(knots[degree:len(knots) - degree])
    parts = finer * max(_PARTS, math.ceil(_CELLS / (len(ends) - 1)))
    shares = np.arange(parts) / parts
    between = ends[:-1, None] + np.diff(ends)[:, None] * shares
    return np.append(between.ravel(), ends[-1])


def _turning(nets: Array) -> Bools:
    """Which homogeneous Bezier nets (nu, nv, pu + 1, pv + 1, 4) do not prove that Su x Sv keeps its side."""
    nets = _drop_separable_weights(nets)
    weight = nets[..., 3:]
    points = nets[..., :3] / weight
    centre = points.mean(axis=(2, 3), keepdims=True)
    # w Su is the derivative of w (S - centre), less (S - centre) times that of w.
    moments = weight * (points - centre)
    radius = np.linalg.norm(points - centre, axis=-1).max(axis=(2, 3))[:, :, None, None]
    axes = []
    widths = []
    for along in (2, 3):
        slack = radius * np.abs(np.diff(weight[..., 0], axis=along))
        axis, width = _cone(np.diff(moments, axis=along), slack)
        axes.append(axis)
        widths.append(width)
    apart = np.arccos(np.clip(np.abs(dot(*axes)), 0.0, 1.0))
    turning = np.asarray(sum(widths) >= apart)
    for along in (2, 3):
        for end in (0, -1):
            side = points.take([end], axis=along)
            one_point = (np.ptp(side, axis=(2, 3)) < _ONE_POINT).all(axis=-1)
            pole = turning & one_point
            if pole.any():
                at_the_pole = nets[pole] if end == -1 else np.flip(nets[pole], along - 1)
                turning[pole] = _turning_beside_pole(at_the_pole if along == 3 else at_the_pole.swapaxes(1, 2))
    return turning


def _drop_separable_weights(nets: Array) -> Array:
    """Homogeneous nets with weights of 1 where each weight is one of its row times one of its column.

    There Su is a sum, with positive factors, of steps along u between points of one column, and so lies in the cone of
    the legs whatever the weights are: arcs that are drawn or turned, as fillets of CAD systems, have such weights.
    """
    weight = nets[..., 3]
    product = weight[..., :, :1] * weight[..., :1, :] / weight[..., :1, :1]
    differs: Array = (np.abs(product - weight) / weight).max(axis=(2, 3), keepdims=True)[..., None]
    return np.asarray(np.where(differs <= _ROUNDING, nets / nets[..., 3:], nets))


def _turning_beside_pole(nets: Array) -> Bools:
    """Which homogeneous Bezier nets (n, pu + 1, pv + 1, 4) that end along v in one point do not prove that Su x Sv
    keeps its side.

    The places S - pole, and with them Su, are (1 - v) times another net.
    """
    weight = nets[..., 3:]
    points = nets[..., :3] / weight
    moments = weight * (points - points[:, :1, -1:])
    degree = moments.shape[2] - 1
    factor = moments[:, :, :-1] * (degree / (degree - np.arange(degree)))[:, None]
    radius = np.linalg.norm(factor, axis=-1).max(axis=(1, 2)) / weight.min(axis=(1, 2, 3))
    # w Su is the derivative of w (S - pole), less (S - pole) times that of w; both have the factor 1 - v.
    slack = radius[:, None, None] * np.abs(np.diff(weight[..., 0], axis=1)).max(axis=2, keepdims=True)
    legs = np.diff(factor, axis=1)
    around, around_width = _cone(legs[None], np.broadcast_to(slack, legs.shape[:-1])[None])
    distance = np.linalg.norm(moments / weight, axis=-1).max(axis=(1, 2))
    slack = distance[:, None, None] * np.abs(np.diff(weight[..., 0], axis=2))
    towards, towards_width = _cone(np.diff(moments, axis=2)[None], slack[None])
    apart = np.arccos(np.clip(np.abs(dot(around, towards)), 0.0, 1.0))
    return np.asarray((around_width + towards_width >= apart)[0])


def _cone(legs: Array, slack: Array) -> tuple[Array, Array]:
    """Axis (nu, nv, 3) and half angle (nu, nv), rad, of a cone around legs (nu, nv, a, b, 3), each off by its slack."""
    size = np.linalg.norm(legs, axis=-1)
    vanishes = size <= _VANISHES * size.max(axis=(2, 3), keepdims=True)
    ways = legs / np.where(size > 0, size, 1.0)[..., None]
    total = ways.sum(axis=(2, 3))
    length = np.linalg.norm(total, axis=-1, keepdims=True)
    axis = total / np.where(length > 0, length, 1.0)
    angle = np.arccos(np.clip(dot(ways, axis[:, :, None, None]), -1.0, 1.0))
    angle += np.arcsin(np.minimum(slack / np.where(size > 0, size, np.finfo(float).tiny), 1.0))
    return axis, np.where(vanishes, np.pi, angle).max(axis=(2, 3))


def _lengths(points: Array) -> Array:
    """Least lengths of the sides of Bezier nets (nu, nv, pu + 1, pv + 1, 3) along u and along v, (2, nu, nv) mm."""
    along_u = points[:, :, -1, [0, -1]] - points[:, :, 0, [0, -1]]
    along_v = points[:, :, [0, -1], -1] - points[:, :, [0, -1], 0]
    return np.asarray(np.linalg.norm([along_u, along_v], axis=-1).min(axis=-1))


def find_folds(surface: "NurbsSurface", uv: Array, normal: Array) -> Folds:
    """Which places lie in or next to folds, and what surrounds them.

    A place does where the normals on both sides of it along a parameter agree, one in between contradicts them, and
    the surface in between leaves their planes by next to nothing.  An edge, a wall or a groove, however thin, is no
    fold: its sides do not agree, or are not flat.

    Parameters
    ----------
    surface : NurbsSurface
    uv : (n, 2) array
    normal : (n, 3) array
        Unit normals there as the derivatives give them, in the sense of Su x Sv.

    Notes
    -----
    **Properties**: 1. places farther than 0.015 mm from every place where Su x Sv turns over keep their normals;
    2. a surface that leaves its own plane by more than 0.0005 mm there keeps its normals.
    """
    rest = surface.turning_cells.rows_in(uv)
    found = [NO_FOLDS]
    for axis in (0, 1):
        if len(rest):
            one = _folds_along(surface, axis, uv[rest], normal[rest])
            found.append(Folds(rest[one.rows], one.normal, one.beside))
            rest = np.delete(rest, one.rows)
    return Folds(*(np.concatenate(parts) for parts in zip(*found, strict=True)))


def _folds_along(surface: "NurbsSurface", axis: int, uv: Array, normal: Array) -> Folds:
    """Places whose surroundings along one parameter agree, and contradict what is between them."""
    d = surface.evaluate(uv)
    first, second, sound = _places_beside(surface, axis, uv)
    far = []
    inner = []
    areas = [_area(d)]
    for place in (first, second):
        beside = surface.evaluate(place)
        far.append(np.linalg.norm(beside.point - d.point, axis=1)[:, None])
        inner.append(normals(beside, inward=surface.inward(place)))
        areas.append(_area(beside))
        sound &= ~degenerate(beside)
    # On one side of a place the nearer normal stands for all; between two places the normal turns evenly.
    own = uv[:, axis]
    between = (first[:, axis] < own) != (second[:, axis] < own)
    around = np.where(between[:, None], far[1] * inner[0] + far[0] * inner[1], inner[0])
    size = np.linalg.norm(around, axis=1)
    around /= np.where(size > 0, size, 1.0)[:, None]
    against = dot(normal, around) < _AGAINST
    agree = dot(*inner) > _AGREE
    uneven = np.min(areas, axis=0) < _EVEN * np.max(areas, axis=0)
    rows = np.flatnonzero(sound & agree & (against | uneven))
    against = against[rows]
    flat = np.ones(len(rows), dtype=bool)
    opposite = _end_opposite(surface, axis, uv, first)
    for place, plane, asked in ((first, inner[0], sound), (second, inner[1], sound), (opposite, inner[0], ~between)):
        # What has left a plane is no fold, whatever lies on the other ways.
        left = np.flatnonzero(flat & asked[rows])
        here = rows[left]
        contradicts, level = _look_on_the_way(surface, (uv[here], place[here]), (around[here], plane[here]))
        against[left] |= contradicts
        flat[left] = level
    rows = rows[against & flat]
    return Folds(rows, around[rows], first[rows])


def _area(d: Derivatives) -> Array:
    return np.asarray(np.linalg.norm(np.cross(d.su, d.sv), axis=1))


def _look_on_the_way(surface: "NurbsSurface", ways: tuple[Array, Array], planes: tuple[Array, Array],
                     ) -> tuple[Bools, Bools]:
    """Whether a normal on the way from places to others contradicts that of the surroundings, and whether the surface
    stays near the planes through the places.

    Parameters
    ----------
    surface : NurbsSurface
    ways : (k, 2), (k, 2) array
        Parameters of the places, and of those to which the ways lead.
    planes : (k, 3), (k, 3) array
        Normals of the surroundings, and of the planes.
    """
    begin, end = ways
    around, plane = planes
    share = np.linspace(0.0, 1.0, _ON_THE_WAY)[:, None, None]
    uv = (begin + share * (end - begin)).reshape(-1, 2)
    d = surface.evaluate(uv)
    shape = (_ON_THE_WAY, len(begin), 3)
    turn = dot(normals(d, inward=surface.inward(uv)).reshape(shape), around)
    point = d.point.reshape(shape)
    off = point - point[0]
    level = np.abs(dot(off, plane)).max(axis=0) <= FLAT
    level &= np.linalg.norm(off, axis=-1).max(axis=0) <= _AWAY * REACH
    contradicts = ((turn < _AGAINST) & ~degenerate(d).reshape(shape[:2])).any(axis=0)
    return np.asarray(contradicts), np.asarray(level)


def _end_opposite(surface: "NurbsSurface", axis: int, uv: Array, place: Array) -> Array:
    """Parameters of the borders of the surface opposite to places beside, along a parameter."""
    low, high = surface.domain[axis]
    ends = uv.copy()
    ends[:, axis] = np.where(place[:, axis] > uv[:, axis], low, high)
    return ends


def _places_beside(surface: "NurbsSurface", axis: int, uv: Array) -> tuple[Array, Array, Bools]:
    """Two places beside each one along a parameter, on both sides where the surface goes on, and whether found."""
    before, has_before = _place_at(surface, axis, uv, -1.0, REACH)
    after, has_after = _place_at(surface, axis, uv, 1.0, REACH)
    first = np.where(has_before[:, None], before, after)
    second = after
    sound = has_before & has_after
    for side, alone in ((-1.0, has_before & ~has_after), (1.0, has_after & ~has_before)):
        rows = np.flatnonzero(alone)
        if len(rows):
            second[rows], sound[rows] = _place_at(surface, axis, uv[rows], side, _SECOND * REACH)
    return first, second, sound


def _place_at(surface: "NurbsSurface", axis: int, uv: Array, side: float, distance: float) -> tuple[Array, Bools]:
    """Parameters of places at a distance or a little more from others, on one side along a parameter, and whether the
    surface reaches that far."""
    d = surface.evaluate(uv)
    low, high = surface.domain[axis]
    own = uv[:, axis]
    room = np.maximum(high - own if side > 0 else own - low, 0.0)
    speed = np.linalg.norm((d.su, d.sv)[axis], axis=1)
    step = np.minimum(1.2 * distance / np.maximum(speed, np.finfo(float).tiny), room)
    # The longest step known to be too short, and the shortest one known to be too long.
    near = np.zeros(len(uv))
    beyond = np.full(len(uv), np.inf)
    place = uv.copy()
    found = np.zeros(len(uv), dtype=bool)
    rest = np.arange(len(uv))
    for _ in range(_STEPS):
        place[rest, axis] = own[rest] + side * step[rest]
        away = np.linalg.norm(surface.evaluate(place[rest]).point - d.point[rest], axis=1)
        short = away < distance
        far = away > _MOST * distance
        near[rest[short]] = step[rest[short]]
        beyond[rest[far]] = step[rest[far]]
        found[rest[~short & ~far]] = True
        rest = rest[far | (short & (step[rest] < room[rest]))]
        if not len(rest):
            break
        longer = np.minimum(2.0 * step[rest], room[rest])
        step[rest] = np.where(np.isfinite(beyond[rest]), 0.5 * (near[rest] + beyond[rest]), longer)
    return place, found
