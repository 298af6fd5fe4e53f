"""Several faces as one surface: the parameters are the place in a plane across a direction from which all are seen."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import make_interp_spline
from scipy.spatial import cKDTree

from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.polygons import polygon_area, stations, walk
from toolaxis.numeric.shares import work_on_rows
from toolaxis.shape.face import Face
from toolaxis.shape.folds import TurningCells, find_turning_cells
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.shape.surface import Derivatives
from toolaxis.skin.continuation import Continuation, heights_of
from toolaxis.skin.covered_parts import Loops, places_in
from toolaxis.skin.faces_in_view import FacesInView
from toolaxis.skin.seen_face import SeenFace
from toolaxis.skin.tangent_planes import TangentPlanes, heights_beyond
from toolaxis.skin.view_kernel import evaluate_view

Array = NDArray[np.float64]

#: Points of the grid along the longer side at first and at most, and how exact the spline through them is to be on the
#: mean of the worst tenth, mm.
_COARSE, _FINE, _EXACT = 49, 193, 1e-3
#: Points along the size of the outline, and in all, from which heights beyond it are told.
_ALONG, _BORDER = 200, 800
#: How far tangent planes rise or fall beyond the outline at most, as a share of the size: steep ones level off.
_RISE = 0.04
#: Width of the band along the outline in which the faces themselves go on, in steps of the spline's grid.
_BAND = 2.0
#: Parts of the range at whose ends nothing about the surface is smooth.
_PARTS = 12
#: Places of a share.
_AT_ONCE = 512


class HiddenPart(NamedTuple):
    """A part of a member that lies under another one as they are seen together: no passes over the skin machine it.

    face : int, the member's number;  beneath : int, the other one's;  area : float, mm^2;  point : (3,) array, mm, in
    the middle of it.
    """

    face: int
    beneath: int
    area: float
    point: Array


@dataclass(frozen=True, eq=False)
class ViewSurface(NurbsSurface):
    """Faces seen along a direction: S(x, y) is the point of them that lies there in the plane across it.

    Within the outline of the faces every point, normal and second derivative is that of the face which lies there,
    exact to rounding.  The control points are those of a smooth spline through such points; it stands for the faces
    where kernels take a surface's numbers to tell strip widths.  Beyond their outline and over holes the faces go on
    along their tangent planes, and from there on as the spline does.

    Attributes
    ----------
    members : tuple of Face
    frame : (3, 3) array
        Coordinates x, y and height along the direction are frame @ (p - origin).
    origin : (3,) array
        mm
    outline : tuple of (m, 2) arrays
        Loops around the members in x and y, the outer one first.
    """

    members: tuple[Face, ...]
    frame: Array
    origin: Array
    outline: tuple[Array, ...]

    @cached_property
    def seen(self) -> tuple[SeenFace, ...]:
        """The members in the plane."""
        return tuple(SeenFace(face, self.frame[:2], self.origin) for face in self.members)

    @cached_property
    def _view(self) -> FacesInView:
        return FacesInView(self.seen, self.outline)

    @property
    def covered(self) -> tuple[tuple[Loops, ...], ...]:
        """For each member the parts of it, loops in the plane, above which another one lies."""
        return self._view.covered

    @cached_property
    def hidden(self) -> tuple[HiddenPart, ...]:
        """What of the members lies under others, the largest first."""
        found = [self._hidden_part(one, part) for one, parts in zip(self.seen, self.covered, strict=True)
                 for part in parts]
        return tuple(sorted(found, key=lambda one: -one.area))

    def _hidden_part(self, one: SeenFace, part: Loops) -> HiddenPart:
        places = places_in(part)
        d = one.evaluate(places)
        area = float(polygon_area(part) * np.linalg.norm(np.cross(d.su, d.sv), axis=1).mean())
        middle = int(np.argmin(np.linalg.norm(d.point - d.point.mean(axis=0), axis=1)))
        above = int(self.owners(places[middle][None])[0])
        return HiddenPart(one.face.number, self.members[above].number, area, d.point[middle])

    @cached_property
    def hidden_area(self) -> float:
        """Area of the members that lies under others, mm^2."""
        return sum(one.area for one in self.hidden)

    def owners(self, places: Array) -> NDArray[np.intp]:
        """Which of the members lies at places of the plane, (n,); -1 beyond the outline.

        Parameters
        ----------
        places : (n, 2) array
        """
        return self._view.owners(places)

    @cached_property
    def breaks(self) -> tuple[Array, Array]:
        """Inner values of u and of v between which to look for what is not smooth: edges of members run anywhere."""
        return tuple(np.linspace(*ends, _PARTS + 1)[1:-1] for ends in self.domain)  # type: ignore[return-value]

    @cached_property
    def stand_in(self) -> NurbsSurface:  # type: ignore[override]
        """The smooth spline that stands for the faces where strips are measured."""
        spline = NurbsSurface(self.knots_u, self.knots_v, self.control, self.degree)
        spline.__dict__["turning_cells"] = self._no_turning_cells  # it is a height over the plane
        return spline

    @property
    def _no_turning_cells(self) -> TurningCells:
        lines_u, lines_v = (np.array(ends) for ends in self.domain)
        return TurningCells(lines_u, lines_v, np.zeros((1, 1), dtype=bool))

    @cached_property
    def turning_cells(self) -> TurningCells:  # type: ignore[override]
        """Where Su x Sv may turn over: a height over the plane does not, unless one of the faces does."""
        if any(face.surface.turning_cells.turning.any() for face in self.members):
            return find_turning_cells(self.data)
        return self._no_turning_cells

    @cached_property
    def joins(self) -> tuple[Array, ...]:
        """Stretches of the members' borders along which they meet, (m, 2) each."""
        step = float(np.ptp(self.outline[0], axis=0).max()) / _ALONG
        around = cKDTree(np.concatenate([walk(loop, stations(loop, (step, step))) for loop in self.outline]))
        found: list[Array] = []
        for loop in (loop for one in self.seen for loop in one.outline):
            line = walk(loop, stations(loop, (step, step)))
            inner = around.query(line)[0] > step
            cuts = np.flatnonzero(np.diff(inner.astype(int))) + 1
            found += [piece for piece, kept in zip(np.split(line, cuts), np.split(inner, cuts), strict=True)
                      if kept[0] and len(piece) > 1]
        return tuple(found)

    def evaluate(self, uv: Array) -> Derivatives:
        """Position and derivatives up to the second order.

        Parameters
        ----------
        uv : (n, 2) array
            Places x, y in the plane, beyond the outline too.
        """
        places = np.ascontiguousarray(uv, dtype=float).reshape(-1, 2)
        if self._view.table is None:
            return self._evaluate_plainly(places)
        out, view, band = np.empty((len(places), 6, 3)), self._view.table, self._continuation.table

        def _evaluate(some: slice) -> None:
            evaluate_view(view, band, self.data, places[some], out[some])

        work_on_rows(_evaluate, len(places), _AT_ONCE)
        return Derivatives(*(out[:, k] for k in range(6)))

    def _evaluate_plainly(self, places: Array) -> Derivatives:
        """The plain twin of `toolaxis.skin.view_kernel.evaluate_view`."""
        owner = self._view.owners(places)
        within = owner >= 0
        if within.all():
            return self._view.evaluate(places, owner)
        found = super().evaluate(places)
        for mine, exact in zip(found, self._view.evaluate(places[within], owner[within]), strict=True):
            mine[within] = exact
        self._carry_on(places, found, ~within)
        return found

    def _carry_on(self, places: Array, spline: Derivatives, beyond: NDArray[np.bool_]) -> None:
        """Put the faces' tangent planes in the place of the spline next to the outline."""
        told = heights_of(Derivatives(*(every[beyond] for every in spline)), self.frame, self.origin)
        made = self._continuation.blend_heights(places[beyond], told)
        value, slope, bend = (new - old for new, old in zip(made, told, strict=True))
        along = np.linalg.inv(self.frame)[:, 2]
        moves = value, slope[:, 0], slope[:, 1], bend[:, 0, 0], bend[:, 0, 1], bend[:, 1, 1]
        for every, move in zip(spline, moves, strict=True):
            every[beyond] += move[:, None] * along

    @cached_property
    def _continuation(self) -> Continuation:
        size = float(np.ptp(self.outline[0], axis=0).max())
        step = max((end - start) / (len(knots) - 2 * degree - 1) for (start, end), knots, degree
                   in zip(self.domain, (self.knots_u, self.knots_v), self.degree, strict=True))
        return Continuation(self._view, self.frame, self.origin, _BAND * step, _RISE * size)

    def transformed(self, matrix: ArrayLike) -> "ViewSurface":
        """The surface moved by an affine map, its members with it.

        Parameters
        ----------
        matrix : (4, 4) array_like
            Maps column vectors (x, y, z, 1).
        """
        spline = super().transformed(matrix)
        m = np.asarray(matrix, dtype=float)
        return ViewSurface(spline.knots_u, spline.knots_v, spline.control, spline.degree,
                           tuple(face.transformed(m) for face in self.members), self.frame @ np.linalg.inv(m[:3, :3]),
                           m[:3, :3] @ self.origin + m[:3, 3], self.outline)


def view_surface(seen: Sequence[SeenFace], frame: Array, origin: Array, outline: tuple[Array, ...]) -> ViewSurface:
    """Faces as one surface, with a spline through as many of its points as it takes.

    Parameters
    ----------
    seen : sequence of SeenFace
        The members, with the first two rows of the frame and its origin.
    frame, origin, outline
        As the attributes of `ViewSurface`.
    """
    view = FacesInView(tuple(seen), outline)
    low, high = np.concatenate(outline).min(axis=0), np.concatenate(outline).max(axis=0)
    size, count = high - low, _COARSE
    while True:
        step = size.max() / (count - 1)
        counts = np.maximum(np.ceil(size / step).astype(int) + 1, 5)
        lines = [np.linspace(low[k], high[k], counts[k]) for k in (0, 1)]
        heights = _heights(view, frame, origin, lines)
        spline = _spline_through(lines, heights, frame, origin)
        if count >= _FINE or _worst(spline, view, frame, origin, lines) <= _EXACT:
            break
        count = 2 * count - 1
    made = ViewSurface(spline.knots_u, spline.knots_v, spline.control, spline.degree,
                       tuple(one.face for one in seen), frame, origin, outline)
    made.__dict__.update(seen=view.seen, _view=view)  # their tables are not made twice
    return made


def _heights(view: FacesInView, frame: Array, origin: Array, lines: list[Array]) -> Array:
    """Heights on a grid; beyond the outline those of the tangent planes of the nearest points of the faces."""
    places = grid_rows(*lines)
    owner = view.owners(places)
    within = owner >= 0
    found = np.empty(len(places))
    found[within] = (view.evaluate(places[within], owner[within]).point - origin) @ frame[2]
    if not within.all():
        found[~within] = _heights_beyond(view, frame, origin, places[~within])
    return np.asarray(found.reshape(len(lines[0]), len(lines[1])))


def _heights_beyond(view: FacesInView, frame: Array, origin: Array, places: Array) -> Array:
    """Heights beyond the outline and over holes: the mean of the tangent planes along it, near ones counting most."""
    size = float(np.ptp(view.outline[0], axis=0).max())
    step = size / _ALONG
    border = np.concatenate([walk(loop, stations(loop, (step, step))) for loop in view.outline])
    border = border[:: max(1, len(border) // _BORDER)]
    d = view.evaluate(border, view.nearest(border))
    height = (d.point - origin) @ frame[2]
    slope = np.column_stack([d.su @ frame[2], d.sv @ frame[2]])
    planes = TangentPlanes(np.ascontiguousarray(border), np.ascontiguousarray(height), np.ascontiguousarray(slope),
                           1e-3 * step, _RISE * size)
    return heights_beyond(planes, places)


def _spline_through(lines: list[Array], heights: Array, frame: Array, origin: Array) -> NurbsSurface:
    """A bicubic spline over the plane through heights on a grid."""
    along = make_interp_spline(lines[0], heights, k=3)
    across = make_interp_spline(lines[1], along.c.T, k=3)
    knots = along.t, across.t
    greville = [(t[1:-3] + t[2:-2] + t[3:-1]) / 3 for t in knots]
    local = np.empty((*across.c.T.shape, 3))
    local[..., 0], local[..., 1] = np.meshgrid(*greville, indexing="ij")
    local[..., 2] = across.c.T
    return NurbsSurface.from_points(local @ np.linalg.inv(frame).T + origin, (3, 3), knots)


def _worst(spline: NurbsSurface, view: FacesInView, frame: Array, origin: Array, lines: list[Array]) -> float:
    """How far a spline lies beside the faces between the points of its grid: the mean of the worst tenth, mm."""
    middle = [(line[1:] + line[:-1]) / 2 for line in lines]
    places = grid_rows(*middle)
    owner = view.owners(places)
    within = owner >= 0
    if not within.any():
        return 0.0
    point = view.evaluate(places[within], owner[within]).point
    off = np.sort(np.abs((spline.evaluate(places[within]).point - point) @ frame[2]))
    return float(off[-max(len(off) // 10, 1):].mean())
