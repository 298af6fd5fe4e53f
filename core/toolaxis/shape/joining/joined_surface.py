"""Patches of one smooth surface joined to one face: the same points, one pair of parameters."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import radians
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import UnsupportedGeometry
from toolaxis.numeric.bezier import bezier_nets, bezier_rows
from toolaxis.numeric.polygon_boolean import unite_polygons
from toolaxis.numeric.vectors import angle_between
from toolaxis.shape.face import Face, Member
from toolaxis.shape.joining.patch_grid import Cell, Grid, arrange_patches
from toolaxis.shape.joining.patches import (
    SAME,
    JoinedPatch,
    Pair,
    align_parameters,
    alike,
    knots_along,
    range_of,
    surface_over,
)
from toolaxis.shape.joining.shared_boundary import GAP, SharedBoundary
from toolaxis.shape.kinks import beside, turn_at
from toolaxis.shape.nurbs import NurbsSurface

Array = NDArray[np.float64]

#: Greatest angle between normals across a join, rad: a cutter of 10 mm radius dips by 0.4 micrometres there.
GREATEST_TURN = radians(0.5)
#: Most members that are all named in a label.
_NAMED = 8
#: Pieces into which spans are cut to tell how far splines are apart.
_FINE = 4
#: Way by which rounding moves points, mm.
_ROUNDING = 1e-9
#: Places along a side at which the speed across it is taken.
_SPEEDS = 17
#: Greatest angle by which iso-parametric lines may turn across a join, rad.
GREATEST_CORNER = radians(30.0)


def join_patches(faces: Sequence[Face], meetings: Sequence[SharedBoundary], tolerance: float = GAP,
                 corner: float = GREATEST_CORNER) -> Face:
    """One face from patches that continue each other smoothly.

    Parameters
    ----------
    faces : sequence of Face
        The first one's directions of u and v, sense and number are those of the result.
    meetings : sequence of SharedBoundary
        From `toolaxis.shape.joining.shared_boundary.meetings`.
    tolerance : float
        By how much the surface may leave the faces at the joins, mm.
    corner : float
        Greatest angle by which iso-parametric lines may turn across a join, rad.

    Returns
    -------
    Face
        Named by `name_of`, with `members`.  Its surface is that of the faces, point by point: u and v of each are
        mapped linearly, and control points of common borders are replaced by their mean.  Its tolerance is the greatest
        of the faces', plus how far that moves the surface at most.  Across a join the surface is C0 in its parameters,
        and its normals turn by no more than half a degree; joins are no kinks.

    Raises
    ------
    UnsupportedGeometry
        When the faces do not lie in rows and columns, common borders differ by more than the tolerance, or normals or
        iso-parametric lines turn too much across a join.

    Notes
    -----
    Degrees are raised and knots put in until neighbours agree along their border; columns and rows are as wide in the
    parameters as makes the mean speed the same on both sides of each join.

    **Properties**: 1. a surface cut at iso-parametric lines and joined again is that surface; 2. every point of a
    member lies within the tolerance at its mapped parameters; 3. areas add up; 4. moving the faces moves the result.
    """
    grid = arrange_patches(faces, meetings)
    patches = align_parameters(grid)
    ranges = tuple([range_of(grid, patches, axis, k) for k in range(grid.shape[axis])] for axis in (0, 1))
    over_boxes = {cell: surface_over(patch, _box(ranges, cell)) for cell, patch in patches.items()}
    surfaces = _match_weights(grid, alike(grid, over_boxes), tolerance)
    lines = tuple(_lines(grid, surfaces, ranges[axis], axis) for axis in (0, 1))
    surface, moved = _assemble_patches(grid, surfaces, lines)
    places = tuple([*pairwise(line)] for line in lines)
    members = [_member(patch, _box(ranges, cell), _box(places, cell)) for cell, patch in patches.items()]
    in_order = tuple(member for face in faces for member in members if member.face is face)
    kinds = {face.kind for face in faces}
    kind = kinds.pop() if len(kinds) == 1 else "bspline"
    own_tolerance = max(face.tolerance for face in faces) + (moved if moved > _ROUNDING else 0.0)
    first = faces[0]
    whole = Face(surface, (), first.flip, first.number, name_of(faces), kind, own_tolerance, _kinks(members, lines),
                 in_order)
    _check_turns(whole, corner)
    return replace(whole, trims=_outline(whole, lines))


def name_of(faces: Sequence[Face]) -> str:
    """What a joined face is called: "3+4"; files have its name too, so that of many faces is cut: "3+4+5+12more".

    Parameters
    ----------
    faces : sequence of Face
        Its members.
    """
    labels = [face.label for face in faces]
    return "+".join(labels if len(labels) <= _NAMED else [*labels[:3], f"{len(labels) - 3}more"])


def _box(ranges: tuple[list[Pair], ...], cell: Cell) -> tuple[Pair, Pair]:
    return ranges[0][cell[0]], ranges[1][cell[1]]


def _border(surface: NurbsSurface, axis: int, end: int) -> Array:
    """Control points of a side: the first ones along an axis, or the last."""
    return np.asarray(np.take(surface.control, -end, axis=axis))


def _match_weights(grid: Grid, surfaces: dict[Cell, NurbsSurface], tolerance: float) -> dict[Cell, NurbsSurface]:
    """The same surfaces with weights that agree on common borders, where these are the same within the tolerance."""
    # Along the diagonals: what is before a cell then has its weights already.
    for cell in sorted(surfaces, key=lambda c: (c[0] + c[1], c)):
        neighbours = [neighbour for neighbour in _neighbours_before(cell) if neighbour.cell in surfaces]
        if neighbours:
            before, axis = neighbours[0]
            weights_before = _border(surfaces[before], axis, 1)[:, 3]
            weights = _border(surfaces[cell], axis, 0)[:, 3]
            factor = float(np.median(weights_before / weights))
            surfaces[cell] = replace(surfaces[cell], control=surfaces[cell].control * factor)
        for before, axis in neighbours:
            off = _border_distance(surfaces[before], surfaces[cell], axis)
            if off > tolerance:
                a, b = grid.faces[before].label, grid.faces[cell].label
                raise UnsupportedGeometry(f"faces {a} and {b} cannot be joined: their borders are the same curve only "
                                          f"within {off:.3g} mm, {tolerance:g} mm are needed: machine them face by "
                                          "face")
    return surfaces


class _Neighbour(NamedTuple):
    """A cell beside another one, and the axis that leads from the one to the other."""

    cell: Cell
    axis: int


def _neighbours_before(cell: Cell) -> tuple[_Neighbour, _Neighbour]:
    column, row = cell
    return _Neighbour((column - 1, row), 0), _Neighbour((column, row - 1), 1)


def _border_distance(one: NurbsSurface, other: NurbsSurface, axis: int) -> float:
    """Greatest way between the last side of a surface and the first of another at equal parameters, at most, mm."""
    knots = knots_along(one, 1 - axis)
    degree = one.degree[1 - axis]
    own = _border(other, axis, 0)
    now = _border(one, axis, 1)
    rough = _greatest_move(own, now)
    if rough <= _ROUNDING:
        return rough
    breaks = _breaks(knots)
    rows, first = bezier_rows(knots, degree, breaks[:-1], breaks[1:])
    active = first[:, None] + np.arange(degree + 1)
    return _greatest_move(rows @ own[active], rows @ now[active])


def _breaks(knots: Array) -> Array:
    """Lines that cut every span into pieces so short that control points tell how far splines are apart."""
    spans = np.unique(knots)
    inner = [np.linspace(a, b, _FINE + 1)[:-1] for a, b in pairwise(spans)]
    return np.concatenate([*inner, spans[-1:]])


def _greatest_move(own: Array, now: Array) -> float:
    """Greatest way between points of equal parameters of two splines, an upper bound, mm.

    S' - S = (H' - H - (w' - w) S) / w' with H = w S, and every term lies in the hull of its control points.

    Parameters
    ----------
    own, now : (..., k, 4) array
        Homogeneous control points of the one and the other, on the same knots; of pieces where there are more axes.
    """
    change = now - own
    weight_change = change[..., 3]
    points = own[..., :3] / own[..., 3:]
    # With S taken from a middle of the points the terms stay small.
    middle = points.mean(axis=-2, keepdims=True)
    reach = np.linalg.norm(points - middle, axis=-1).max(axis=-1)
    shift = np.linalg.norm(change[..., :3] - middle * weight_change[..., None], axis=-1).max(axis=-1)
    numerator = shift + reach * np.abs(weight_change).max(axis=-1)
    least_weight = now[..., 3].min(axis=-1)
    return float((numerator / least_weight).max())


def _surface_moved(surface: NurbsSurface, control: Array) -> float:
    """How far a surface moves with other control points at most, mm."""
    rough = _greatest_move(surface.control.reshape(-1, 4), control.reshape(-1, 4))
    if rough <= _ROUNDING:
        return rough
    own = _points_of_pieces(surface, surface.control)
    now = _points_of_pieces(surface, control)
    return _greatest_move(own, now)


def _points_of_pieces(surface: NurbsSurface, control: Array) -> Array:
    """Bezier points of short pieces of a surface with some control points, (n, m, k, 4)."""
    spline = surface.knots_u, surface.knots_v, control, *surface.degree, True
    nets = bezier_nets(spline, _breaks(surface.knots_u), _breaks(surface.knots_v))
    return nets.reshape(*nets.shape[:2], -1, 4)


def _lines(grid: Grid, surfaces: dict[Cell, NurbsSurface], ranges: list[Pair], axis: int) -> Array:
    """Where columns or rows begin and end in the joined parameters: the mean speed is the same on both sides."""
    lines = [*ranges[0]]
    rate = 1.0
    for k in range(1, grid.shape[axis]):
        before = [surface for cell, surface in surfaces.items() if cell[axis] == k - 1]
        behind = [surface for cell, surface in surfaces.items() if cell[axis] == k]
        speed_before = float(np.mean([_end_speed(surface, axis, 1) for surface in before]))
        speed_behind = float(np.mean([_end_speed(surface, axis, 0) for surface in behind]))
        if speed_before > 0 and speed_behind > 0:
            rate *= speed_behind / speed_before
        low, high = ranges[k]
        lines.append(lines[-1] + rate * (high - low))
    return np.array(lines, dtype=float)


def _end_speed(surface: NurbsSurface, axis: int, end: int) -> float:
    """Mean length of the derivative across a side, mm."""
    low, high = surface.domain[1 - axis]
    uv = np.empty((_SPEEDS, 2))
    uv[:, 1 - axis] = low + (high - low) * (np.arange(_SPEEDS) + 0.5) / _SPEEDS
    uv[:, axis] = surface.domain[axis][end]
    d = surface.evaluate(uv)
    derivative = (d.su, d.sv)[axis]
    return float(np.linalg.norm(derivative, axis=1).mean())


def _assemble_patches(grid: Grid, surfaces: dict[Cell, NurbsSurface],
                      lines: tuple[Array, ...]) -> tuple[NurbsSurface, float]:
    """All patches as one surface, and how far it lies beside them at most, mm."""
    degree = surfaces[0, 0].degree
    columns = [knots_along(surfaces[k, 0], 0) for k in range(grid.shape[0])]
    rows = [knots_along(surfaces[0, k], 1) for k in range(grid.shape[1])]
    knots_u = _join_knots(columns, degree[0], lines[0])
    knots_v = _join_knots(rows, degree[1], lines[1])
    places_u = _control_places(columns, degree[0])
    places_v = _control_places(rows, degree[1])
    # Control points on a join are those of both sides: their mean is taken.
    total = np.zeros((places_u[-1].stop, places_v[-1].stop, 4))
    count = np.zeros(total.shape[:2])
    for (i, j), own in surfaces.items():
        total[places_u[i], places_v[j]] += own.control
        count[places_u[i], places_v[j]] += 1
    total /= count[..., None]
    moved = max(_surface_moved(own, total[places_u[i], places_v[j]]) for (i, j), own in surfaces.items())
    return NurbsSurface(knots_u, knots_v, total, degree), moved


def _join_knots(columns: list[Array], degree: int, line: Array) -> Array:
    """The knots of columns, or rows, one after the other: each mapped to between two lines, C0 at the joins."""
    pieces = [np.full(degree + 1, line[0])]
    for k, own in enumerate(columns):
        inner = own[degree + 1:-degree - 1]
        mapped = line[k] + (inner - own[0]) * (line[k + 1] - line[k]) / (own[-1] - own[0])
        is_last = k == len(columns) - 1
        pieces += [mapped, np.full(degree + 1 if is_last else degree, line[k + 1])]
    return np.concatenate(pieces)


def _control_places(columns: list[Array], degree: int) -> list[slice]:
    """Which control points of all are those of each column, or row: neighbours have those on their join in common."""
    places = []
    first = 0
    for knots in columns:
        end = first + len(knots) - degree - 1
        places.append(slice(first, end))
        first = end - 1
    return places


def _member(patch: JoinedPatch, box: tuple[Pair, Pair], place: tuple[Pair, Pair]) -> Member:
    """A face with the way from the joined parameters to its own."""
    matrix = np.zeros((2, 3))
    for axis in (0, 1):
        low, high = box[axis]
        first, last = place[axis]
        start = patch.own(axis, low)
        end = patch.own(axis, high)
        slope = (end - start) / (last - first)
        own_axis = patch.axes[axis]
        matrix[own_axis, axis] = slope
        matrix[own_axis, 2] = start - slope * first
    return Member(patch.face, matrix, np.array(place, dtype=float).T)


def _into(member: Member, uv: Array) -> Array:
    """Joined parameters from a member's own, (n, 2)."""
    assert member.matrix is not None
    slopes, start = member.matrix[:, :2], member.matrix[:, 2]
    return np.asarray(np.linalg.solve(slopes, (uv - start).T).T)


def _kinks(members: Sequence[Member], lines: tuple[Array, ...]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Kinks of the members in the joined parameters."""
    found: tuple[list[float], list[float]] = ([], [])
    for member in members:
        assert member.matrix is not None
        for own_axis, values in enumerate(member.face.kinks):
            row = member.matrix[own_axis]
            axis = int(np.abs(row[:2]).argmax())
            same = SAME * np.ptp(lines[axis])
            for own in values:
                t = float((own - row[2]) / row[axis])
                if all(abs(t - known) > same for known in [*found[axis], *lines[axis]]):
                    found[axis].append(t)
    return tuple(sorted(found[0])), tuple(sorted(found[1]))


def _check_turns(face: Face, most: float) -> None:
    """That normals, and iso-parametric lines, turn little across every join."""
    for axis, t in joins(face):
        turn = turn_at(face, axis, t)
        if turn > GREATEST_TURN:
            raise UnsupportedGeometry(f"faces {face.label} cannot be joined: normals turn by {np.degrees(turn):.2g} "
                                      f"degrees across a join, {np.degrees(GREATEST_TURN):g} are allowed: machine them "
                                      "face by face")
        corner = corner_at(face, axis, t)
        if corner > most:
            raise UnsupportedGeometry(f"faces {face.label} cannot be joined: iso-parametric lines, and passes with "
                                      f"them, would turn by {np.degrees(corner):.0f} degrees across a join, "
                                      f"{np.degrees(most):.0f} are allowed: machine them face by face")


def joins(face: Face) -> list[tuple[int, float]]:
    """Lines along which members of a joined face meet: 0 for constant u or 1 for constant v, and the parameter.

    Parameters
    ----------
    face : Face
    """
    boxes = [member.box for member in face.members if member.box is not None]
    return [(axis, t) for axis in (0, 1) for t in sorted({float(box[0, axis]) for box in boxes})[1:]]


def corner_at(face: Face, axis: int, t: float) -> float:
    """Greatest angle by which iso-parametric lines turn where they cross a knot line, rad.

    Parameters
    ----------
    face : Face
    axis : int
        0 for a line of constant u, 1 for one of constant v.
    t : float
        The knot.
    """
    before, on = (face.evaluate(uv) for uv in beside(face, axis, t))
    if axis == 0:
        turns = angle_between(before.su, on.su)
    else:
        turns = angle_between(before.sv, on.sv)
    return float(np.max(turns))


def _outline(face: Face, lines: tuple[Array, ...]) -> tuple[Array, ...]:
    """Loops of the members as loops of the joined face; none where they fill it."""
    if all(not member.face.trims and _whole(member) for member in face.members):
        return ()
    size = [SAME * float(np.ptp(line)) for line in lines]
    loops: tuple[Array, ...] = ()
    corners = np.empty((0, 2))
    for member in face.members:
        own = []
        for loop in member.face.outline:
            on_lines = _put_on_lines(_into(member, loop), lines, size)
            own.append(_meet_neighbours(on_lines, corners, lines, size))
        corners = np.concatenate([corners, *own])
        loops = unite_polygons(loops, tuple(own)) if loops else tuple(own)
    return tuple(sorted(loops, key=_box_area, reverse=True))


def _box_area(loop: Array) -> float:
    return float(np.prod(np.ptp(loop, axis=0)))


def _put_on_lines(uv: Array, lines: tuple[Array, ...], size: list[float]) -> Array:
    """A loop of which what lies on a join, but for rounding, lies on it exactly."""
    for axis, line in enumerate(lines):
        parameter = uv[:, axis]
        nearest = line[np.abs(parameter[:, None] - line).argmin(axis=1)]
        is_close = np.abs(parameter - nearest) <= 1e3 * size[axis]
        uv[is_close, axis] = nearest[is_close]
    return uv


def _whole(member: Member) -> bool:
    """Whether a member's place holds all of its surface."""
    assert member.box is not None and member.matrix is not None
    domain = np.array(member.face.surface.domain)
    own_corners = member.box @ member.matrix[:, :2].T + member.matrix[:, 2]
    own_domain = np.sort(own_corners, axis=0).T
    same = SAME * np.ptp(domain, axis=1)
    return bool((np.abs(own_domain - domain) <= same[:, None]).all())


def _meet_neighbours(loop: Array, corners: Array, lines: tuple[Array, ...], size: list[float]) -> Array:
    """A loop whose corners on joins are the very ones of the neighbours where they are as good as these."""
    if not len(corners):
        return loop
    for i, point in enumerate(loop):
        is_on_join = (point[0] == lines[0]).any() or (point[1] == lines[1]).any()
        if is_on_join:
            gap = np.abs((corners - point) / size).max(axis=1)
            if gap.min() <= 1e3:
                loop[i] = corners[gap.argmin()]
    return loop
