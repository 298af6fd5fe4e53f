"""What is left of faces outside the other bodies of a part: blades that are drawn down into their disc."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.numeric.clipping import outer_with_holes
from toolaxis.numeric.contours import contours
from toolaxis.numeric.grids import grid_nodes
from toolaxis.numeric.polygon_boolean import divide_polygon
from toolaxis.numeric.sparse_grid import SparseGrid
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.face import Face
from toolaxis.shape.measure import mean_width
from toolaxis.shape.nearest import nearest
from toolaxis.shape.part import Part

Array = NDArray[np.float64]

#: Least and most nodes along the sides of the grid on which borders are traced; nodes across a body's mean thickness.
_LEAST, _MOST, _ACROSS = 120, 1200, 3.0
#: Samples along the sides of a body's faces.
_SAMPLES = 100
#: Nearer than this to a body's border counts as inside, mm: borders that two bodies share leave no slivers.
ON = 0.005
#: Pieces with less than this share of their face's area are left out.
SLIVER = 1e-3
#: Distances to two faces that differ by less than this are those of an edge between them, mm.
_EDGE = 1e-5
#: Places of which the farthest from a body tells on which side of its border they all lie.
_TRIED = 50
#: Nodes along the sides of the blocks of which one is asked whether any may be near to a body.
_BLOCK = 8
_TRIES = 6


@dataclass(frozen=True, eq=False)
class Solid:
    """A closed body that points may lie in.

    Attributes
    ----------
    faces : tuple of Face
        That bound it.
    """

    faces: tuple[Face, ...]

    @cached_property
    def _samples(self) -> list[tuple[Array, Array]]:
        """Points inside each face, (n, 3), and their normals as long as the area that each stands for."""
        found = []
        for face in self.faces:
            uv = face.grid(_SAMPLES, _SAMPLES)
            uv = uv if len(uv) else np.concatenate(face.outline)
            found.append((face.evaluate(uv).point, face.normal(uv) * (face.area / len(uv))))
        return found

    @cached_property
    def box(self) -> Array:
        """Corners of the box around it, (2, 3) mm."""
        boxes = np.array([face.box for face in self.faces])
        return np.stack([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])

    def away(self, points: Array, most: float = np.inf) -> Array:
        """Distance of points from each of its faces, too great by half the distance of samples at most, (k, n) mm.

        Parameters
        ----------
        points : (n, 3) array
        most : float
            Greater distances are inf, mm.
        """
        return np.array([tree.query(points, distance_upper_bound=most)[0] for tree in self._trees])

    @cached_property
    def _trees(self) -> list[Any]:
        from scipy.spatial import cKDTree

        return [cKDTree(there) for there, _ in self._samples]

    @cached_property
    def thickness(self) -> float:
        """Mean thickness, mm: twice its volume over its area."""
        volume = sum(float((there * area).sum()) for there, area in self._samples) / 3
        return 2 * abs(volume) / sum(face.area for face in self.faces)

    @cached_property
    def spacing(self) -> float:
        """Greatest distance of neighbouring samples, mm."""
        return max(face.diagonal for face in self.faces) / _SAMPLES

    def holds(self, point: Array) -> bool:
        """Whether a point well off its border lies inside: the border fills more than half of all directions.

        Parameters
        ----------
        point : (3,) array
        """
        turns = 0.0
        for there, area in self._samples:
            way = there - point
            turns += float(((way * area).sum(axis=1) / np.linalg.norm(way, axis=1)**3).sum())
        return turns > 2 * np.pi

    def outside(self, points: Array, away: Array) -> Array:
        """Signed distance of points next to its border, positive outside, (n,) mm.

        Parameters
        ----------
        points : (n, 3) array
        away : (k, n) array
            From `away`.
        """
        length, height = np.full((2, *away.shape), np.inf)
        for k, face in enumerate(self.faces):
            close = np.flatnonzero(away[k] <= away.min(axis=0) + self.spacing)
            if len(close):
                foot = nearest(face, points[close], 24)
                length[k, close] = foot.distance
                height[k, close] = ((points[close] - foot.point) * face.normal(foot.uv)).sum(axis=1)
        least = length.min(axis=0)
        # at an edge several faces are equally near: the one whose plane the point is farthest from tells the side
        pick = np.where(length <= least + _EDGE, np.abs(height), -1.0).argmax(axis=0)
        return np.where(np.take_along_axis(height, pick[None], 0)[0] < 0, -least, least)


def solids_of(part: Part) -> tuple[Solid, ...]:
    """The closed bodies of a part.

    Parameters
    ----------
    part : Part
    """
    return tuple(Solid(tuple(part.face(n) for n in body.faces)) for body in part.bodies if body.closed)


def cut_exposed(face: Face, solids: tuple[Solid, ...]) -> tuple[Face, ...]:
    """What of a face no body covers: pieces of it, the largest first.

    Parameters
    ----------
    face : Face
    solids : tuple of Solid
        Those that the face bounds itself do not count.

    Returns
    -------
    tuple of Face
        The face itself where none covers any of it; nothing where all of it is covered.

    Raises
    ------
    UnsupportedGeometry
        When the border of what is covered cannot be told apart from the face's own.

    Notes
    -----
    A place is covered where the point 0.01 mm above it lies in a body, or within 0.005 mm of one.  Borders are traced
    on a grid, straight between its nodes: where faces cross they lie within h^2 k / 8 of the true ones, h the distance
    of nodes and k the curvature of the faces, where faces touch flatly within a cell; corners are cut off within a
    cell.  Pieces narrower than half a cell are left out, and what is thinner than a third of a body's mean thickness
    may be missed.

    **Properties**: 1. pieces and what is covered are the face, but for `SLIVER`; 2. moves with the part.
    """
    pieces = [face]
    for solid in solids:
        if all(own.number != face.number for own in solid.faces):
            pieces = [left for piece in pieces for left in _less(piece, solid)]
    kept = [piece for piece in pieces if piece is face or piece.area > SLIVER * face.area]
    return tuple(sorted(kept, key=lambda piece: -piece.area))


def _less(face: Face, solid: Solid) -> list[Face]:
    """Pieces of a face that lie outside a body."""
    if (face.box[1] < solid.box[0]).any() or (face.box[0] > solid.box[1]).any():
        return [face]
    (u0, u1, v0, v1), sides = face.bounds, _sides(face)
    counts = np.clip(np.ceil(sides * _ACROSS / solid.thickness), _LEAST, _MOST).astype(int)
    cell = float((sides / counts).max())
    for attempt in range(_TRIES):
        beyond = 0.0317 + 0.0041 * attempt
        lines = tuple(np.linspace(a - beyond * (b - a), b + beyond * (b - a), count)
                      for a, b, count in ((u0, u1, counts[0]), (v0, v1, counts[1])))
        depth = _depth(face, solid, (lines[0], lines[1]))
        if not (depth > 0).any():
            return [face]
        try:
            _, left = divide_polygon(face.outline, contours(SparseGrid.of_all((lines[0], lines[1]), depth)))
        except InvalidInput:
            continue
        found = [face.trimmed(loops) for loops in outer_with_holes(left)]
        return [piece for piece in found if mean_width(piece) > cell / 2]
    raise UnsupportedGeometry(f"what of face {face.label} lies inside another body cannot be told, borders coincide: "
                              "unite the bodies in CAD")


def _sides(face: Face) -> Array:
    """Greatest lengths of a face's bounds along u and v, (2,) mm."""
    u0, u1, v0, v1 = face.bounds
    nodes = grid_nodes(np.linspace(u0, u1, 40), np.linspace(v0, v1, 40))
    points = face.evaluate(nodes.reshape(-1, 2)).point.reshape(40, 40, 3)
    return np.array([np.linalg.norm(np.diff(points, axis=k), axis=2).sum(axis=k).max() for k in (0, 1)])


def _depth(face: Face, solid: Solid, lines: tuple[Array, Array]) -> Array:
    """How deep the nodes of a grid lie in a body, (m, n) mm: exact at its border; below zero off the face."""
    from scipy.ndimage import binary_dilation, label

    nodes = grid_nodes(*lines)
    shape, rows = nodes.shape[:2], nodes.reshape(-1, 2)
    on = face.evaluate(rows).point
    cell = max(float(np.linalg.norm(np.diff(on.reshape(*shape, 3), axis=k), axis=2).max()) for k in (0, 1))
    reach = cell + solid.spacing
    wanted = binary_dilation(face.contains(rows).reshape(shape), np.ones((3, 3)), 2).ravel()
    wanted &= ((on > solid.box[0] - 2 * reach) & (on < solid.box[1] + 2 * reach)).all(axis=1)
    depth = np.full(len(rows), -1.0)
    if not wanted.any():
        return depth.reshape(shape)
    kept = np.flatnonzero(wanted)
    points = on[kept] + 2 * ON * face.normal(rows[kept])
    blocks = np.ravel_multi_index([place // _BLOCK for place in np.unravel_index(kept, shape)], shape)
    asked = np.flatnonzero(_may_be_near(solid, points, blocks, reach))
    away = solid.away(points[asked], reach + solid.spacing)
    found = away.min(axis=0, initial=np.inf) <= reach
    near = np.zeros(len(points), dtype=bool)
    near[asked[found]] = True
    if near.any():
        depth[kept[near]] = ON - solid.outside(points[near], away[:, found])
    far = np.zeros(len(rows), dtype=bool)
    far[kept[~near]] = True
    alike, count = label(far.reshape(shape))
    for k in range(1, count + 1):
        there = np.flatnonzero(alike.ravel()[kept] == k)
        some = there[::max(1, len(there) // _TRIED)]
        farthest = some[solid.away(points[some]).min(axis=0).argmax()]
        depth[kept[there]] = 1.0 if solid.holds(points[farthest]) else -1.0
    return depth.reshape(shape)


def _may_be_near(solid: Solid, points: Array, blocks: NDArray[np.int64], reach: float) -> NDArray[np.bool_]:
    """Which points may be within reach of a body, (n,): those of blocks whose first point is not too far away.

    Parameters
    ----------
    solid : Solid
    points : (n, 3) array
    blocks : (n,) array of int
        Numbers of the blocks that they are in.
    reach : float
        mm
    """
    _, first, own = np.unique(blocks, return_index=True, return_inverse=True)
    size = np.zeros(len(first))
    np.maximum.at(size, own, np.linalg.norm(points - points[first[own]], axis=1))
    away = solid.away(points[first], reach + float(size.max())).min(axis=0, initial=np.inf)
    return np.asarray((away <= reach + size)[own])


def cut_back_covered(part: Part, numbers: Collection[int],
                     progress: Progress = NO_PROGRESS) -> tuple[Part, dict[int, tuple[Face, ...]]]:
    """A part with faces cut back to what no other of its bodies covers.

    Parameters
    ----------
    part : Part
    numbers : collection of int
        Of the faces to look at.
    progress : Progress

    Returns
    -------
    part : Part
        Its faces without what is covered; where several pieces of a face are left, the largest; a face that is covered
        whole stays as it is.  With a warning where something is covered.
    pieces : dict of int to tuple of Face
        By number, all pieces of the faces that are covered in part or whole.

    Raises
    ------
    UnsupportedGeometry
        When borders of bodies coincide so that they cannot be told apart.
    """
    solids = solids_of(part)
    if len(solids) < 2:
        return part, {}
    pieces = {}
    for k, face in enumerate(map(part.face, sorted(numbers))):
        progress.report("looking for what other bodies cover", k, len(numbers))
        left = cut_exposed(face, solids)
        if left != (face,):
            pieces[face.number] = left
    if not pieces:
        return part, {}
    area = sum(part.face(n).area - sum(one.area for one in left) for n, left in pieces.items())
    made = replace(part, faces=tuple(pieces[face.number][0] if pieces.get(face.number) else face
                                     for face in part.faces))
    told = (f"bodies overlap: {area:.1f} mm2 of {len(pieces)} faces ({min(pieces)} the first) lie inside other bodies "
            "and are not machined")
    return made.with_warnings(told), pieces
