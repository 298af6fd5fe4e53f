"""Patches of one smooth surface joined to one face: the same points, one pair of parameters."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import radians

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
    surfaces = alike(grid, {cell: surface_over(patches[cell], _box(ranges, cell)) for cell in patches})
    surfaces = _match_weights(grid, surfaces, tolerance)
    lines = tuple(_lines(grid, surfaces, ranges[axis], axis) for axis in (0, 1))
    surface, moved = _assemble_patches(grid, surfaces, lines)
    places = tuple([*pairwise(line)] for line in lines)
    members = {cell: _member(patch, _box(ranges, cell), _box(places, cell)) for cell, patch in patches.items()}
    kinds = {face.kind for face in faces}
    kind = kinds.pop() if len(kinds) == 1 else "bspline"
    made = Face(surface, (), faces[0].flip, faces[0].number, name_of(faces), kind,
                max(face.tolerance for face in faces) + (moved if moved > _ROUNDING else 0.0), _kinks(members, lines),
                tuple(members[cell] for face in faces for cell in members if members[cell].face is face))
    _check_turns(made, corner)
    return replace(made, trims=_outline(made, lines))


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
    for cell in sorted(surfaces, key=lambda c: (c[0] + c[1], c)):
        beside = [(before, axis) for axis, before in ((0, (cell[0] - 1, cell[1])), (1, (cell[0], cell[1] - 1)))
                  if before in surfaces]
        for before, axis in beside[:1]:
            share = _border(surfaces[before], axis, 1)[:, 3] / _border(surfaces[cell], axis, 0)[:, 3]
            surfaces[cell] = replace(surfaces[cell], control=surfaces[cell].control * float(np.median(share)))
        for before, axis in beside:
            off = _apart(surfaces[before], surfaces[cell], axis)
            if off > tolerance:
                a, b = grid.faces[before].label, grid.faces[cell].label
                raise UnsupportedGeometry(f"faces {a} and {b} cannot be joined: their borders are the same curve only "
                                          f"within {off:.3g} mm, {tolerance:g} mm are needed: machine them face by "
                                          "face")
    return surfaces


def _apart(one: NurbsSurface, other: NurbsSurface, axis: int) -> float:
    """Greatest way between the last side of a surface and the first of another at equal parameters, at most, mm."""
    knots, degree = knots_along(one, 1 - axis), one.degree[1 - axis]
    own, now = _border(other, axis, 0), _border(one, axis, 1)
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
    points = own[..., :3] / own[..., 3:]
    middle = points.mean(axis=-2, keepdims=True)
    reach = np.linalg.norm(points - middle, axis=-1).max(axis=-1)
    shift = np.linalg.norm(change[..., :3] - middle * change[..., 3:], axis=-1).max(axis=-1)
    return float(((shift + reach * np.abs(change[..., 3]).max(axis=-1)) / now[..., 3].min(axis=-1)).max())


def _surface_moved(surface: NurbsSurface, control: Array) -> float:
    """How far a surface moves with other control points at most, mm."""
    rough = _greatest_move(surface.control.reshape(-1, 4), control.reshape(-1, 4))
    if rough <= _ROUNDING:
        return rough
    lines = _breaks(surface.knots_u), _breaks(surface.knots_v)
    own, now = (bezier_nets((surface.knots_u, surface.knots_v, net, *surface.degree, True), *lines)
                for net in (surface.control, control))
    return _greatest_move(own.reshape(*own.shape[:2], -1, 4), now.reshape(*now.shape[:2], -1, 4))


def _lines(grid: Grid, surfaces: dict[Cell, NurbsSurface], ranges: list[Pair], axis: int) -> Array:
    """Where columns or rows begin and end in the joined parameters: the mean speed is the same on both sides."""
    lines, rate = [ranges[0][0], ranges[0][1]], 1.0
    for k in range(1, grid.shape[axis]):
        speeds = [float(np.mean([_end_speed(surfaces[cell], axis, end) for cell in surfaces if cell[axis] == k - end]))
                  for end in (1, 0)]
        rate *= speeds[1] / speeds[0] if speeds[0] > 0 and speeds[1] > 0 else 1.0
        lines.append(lines[-1] + rate * (ranges[k][1] - ranges[k][0]))
    return np.array(lines, dtype=float)


def _end_speed(surface: NurbsSurface, axis: int, end: int) -> float:
    """Mean length of the derivative across a side, mm."""
    low, high = surface.domain[1 - axis]
    uv = np.empty((17, 2))
    uv[:, 1 - axis] = low + (high - low) * (np.arange(17) + 0.5) / 17
    uv[:, axis] = surface.domain[axis][end]
    d = surface.evaluate(uv)
    return float(np.linalg.norm((d.su, d.sv)[axis], axis=1).mean())


def _assemble_patches(grid: Grid, surfaces: dict[Cell, NurbsSurface],
                      lines: tuple[Array, ...]) -> tuple[NurbsSurface, float]:
    """All patches as one surface, and how far it lies beside them at most, mm."""
    knots, firsts = [], []
    degree = surfaces[0, 0].degree
    for axis in (0, 1):
        column = [knots_along(surfaces[(k, 0) if axis == 0 else (0, k)], axis) for k in range(grid.shape[axis])]
        p, line = degree[axis], lines[axis]
        inner = [line[k] + (own[p + 1:-p - 1] - own[0]) * (line[k + 1] - line[k]) / (own[-1] - own[0])
                 for k, own in enumerate(column)]
        pieces = [np.full(p + 1, line[0])]
        for k, own in enumerate(inner):
            pieces += [own, np.full(p if k < len(inner) - 1 else p + 1, line[k + 1])]
        knots.append(np.concatenate(pieces))
        firsts.append(np.concatenate([[0], np.cumsum([len(own) - p - 2 for own in column])]))
    total = np.zeros((firsts[0][-1] + 1, firsts[1][-1] + 1, 4))
    share = np.zeros(total.shape[:2])
    places = {(i, j): (slice(firsts[0][i], firsts[0][i + 1] + 1), slice(firsts[1][j], firsts[1][j + 1] + 1))
              for i, j in surfaces}
    for cell, place in places.items():
        total[place] += surfaces[cell].control
        share[place] += 1
    total /= share[..., None]
    moved = max(_surface_moved(surfaces[cell], total[place]) for cell, place in places.items())
    return NurbsSurface(knots[0], knots[1], total, degree), moved


def _member(patch: JoinedPatch, box: tuple[Pair, Pair], place: tuple[Pair, Pair]) -> Member:
    """A face with the way from the joined parameters to its own."""
    matrix = np.zeros((2, 3))
    for axis in (0, 1):
        (low, high), (first, last) = box[axis], place[axis]
        start, end = patch.own(axis, low), patch.own(axis, high)
        slope = (end - start) / (last - first)
        matrix[patch.axes[axis], axis], matrix[patch.axes[axis], 2] = slope, start - slope * first
    return Member(patch.face, matrix, np.array(place, dtype=float).T)


def _into(member: Member, uv: Array) -> Array:
    """Joined parameters from a member's own, (n, 2)."""
    assert member.matrix is not None
    return np.asarray(np.linalg.solve(member.matrix[:, :2], (uv - member.matrix[:, 2]).T).T)


def _kinks(members: dict[Cell, Member], lines: tuple[Array, ...]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Kinks of the members in the joined parameters."""
    found: tuple[list[float], list[float]] = ([], [])
    for member in members.values():
        assert member.matrix is not None
        for own, values in enumerate(member.face.kinks):
            axis = int(np.abs(member.matrix[own, :2]).argmax())
            for t in values:
                at = float((t - member.matrix[own, 2]) / member.matrix[own, axis])
                if all(abs(at - other) > SAME * np.ptp(lines[axis]) for other in [*found[axis], *lines[axis]]):
                    found[axis].append(at)
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
    ways = [(d.su, d.sv)[axis] for d in map(face.evaluate, beside(face, axis, t))]
    return float(np.max(angle_between(*ways)))


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
            uv = _into(member, loop)
            for axis, line in enumerate(lines):
                near = np.abs(uv[:, axis, None] - line).argmin(axis=1)
                close = np.abs(uv[:, axis] - line[near]) <= 1e3 * size[axis]
                uv[close, axis] = line[near[close]]
            own.append(_meet_neighbours(uv, corners, lines, size))
        corners = np.concatenate([corners, *own])
        loops = unite_polygons(loops, tuple(own)) if loops else tuple(own)
    order = sorted(loops, key=lambda loop: -float(np.prod(np.ptp(loop, axis=0))))
    return tuple(order)


def _whole(member: Member) -> bool:
    """Whether a member's place holds all of its surface."""
    assert member.box is not None and member.matrix is not None
    domain = np.array(member.face.surface.domain)
    corners = np.sort(member.box @ member.matrix[:, :2].T + member.matrix[:, 2], axis=0).T
    return bool((np.abs(corners - domain) <= SAME * np.ptp(domain, axis=1)[:, None]).all())


def _meet_neighbours(loop: Array, corners: Array, lines: tuple[Array, ...], size: list[float]) -> Array:
    """A loop whose corners on joins are the very ones of the neighbours where they are as good as these."""
    for i, point in enumerate(loop):
        if any((point[axis] == lines[axis]).any() for axis in (0, 1)) and len(corners):
            gap = np.abs((corners - point) / size).max(axis=1)
            if gap.min() <= 1e3:
                loop[i] = corners[gap.argmin()]
    return loop
