"""A face: a surface, the loops that trim it, and the side on which the material lies."""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.polygons import EdgeIndex, inside, signed_area, slabs
from toolaxis.shape import measure
from toolaxis.shape.differential import Curvature, curvatures, degenerate, normals
from toolaxis.shape.folds import NO_FOLDS, Folds, find_folds
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.shape.surface import Derivatives

Array = NDArray[np.float64]

#: How far curvatures step into the surface from a pole, as a share of the way to the middle of the domain.
POLE_STEP = 1e-4


@dataclass(frozen=True, eq=False)
class Member:
    """A face that was joined with others into one.

    Attributes
    ----------
    face : Face
        As it was.
    matrix : (2, 3) array or None
        Its own parameters from those of the joined face: own = matrix @ (u, v, 1); None where that is no such map.
    box : (2, 2) array or None
        Lower and upper corner of its place in the joined face's parameters, where there is a matrix.
    """

    face: "Face"
    matrix: Array | None = None
    box: Array | None = None


@dataclass(frozen=True, eq=False)
class Face:
    """A trimmed piece of a surface with its sense.

    Attributes
    ----------
    surface : NurbsSurface
    trims : tuple of (m, 2) arrays
        Closed loops in (u, v), the outer one first, then the holes, and the same of further parts where the face falls
        apart; empty for the whole domain.
    flip : bool
        The normal out of the material is Su x Sv, or its opposite with flip.
    number : int
        Number of the face in its file, from 1.
    label : str
        What messages call it; its number unless it is a piece of a face ("7a").
    kind : str
        The CAD kernel's kind of surface: plane, cylinder, cone, sphere, torus, bspline, revolution, extrusion, ...
    tolerance : float
        Bound of the distance between this surface and the CAD face, mm; 0 where the conversion is exact.
    kinks : pair of tuples of float
        Parameters u and v along which the surface is only C0.
    members : tuple of Member
        The faces that were joined into this one, see `toolaxis.skin.join`; empty for a face of a file.

    Raises
    ------
    InvalidInput
        When a loop has fewer than three points, is not finite, or spans no area.
    """

    surface: NurbsSurface
    trims: tuple[Array, ...] = ()
    flip: bool = False
    number: int = 1
    label: str = ""
    kind: str = "bspline"
    tolerance: float = 0.0
    kinks: tuple[tuple[float, ...], tuple[float, ...]] = field(default=((), ()))
    members: tuple[Member, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "trims", tuple(np.ascontiguousarray(loop, dtype=float) for loop in self.trims))
        if not self.label:
            object.__setattr__(self, "label", str(self.number))
        for index, loop in enumerate(self.trims):
            if loop.ndim != 2 or loop.shape[1] != 2 or len(loop) < 3 or not np.isfinite(loop).all():
                raise InvalidInput(f"trim loop {index} of face {self.label} has shape {loop.shape}: at least three "
                                   "finite (u, v) points are needed")
            if signed_area(loop) == 0.0:
                raise InvalidInput(f"trim loop {index} of face {self.label} encloses no area: give a closed loop")

    def __repr__(self) -> str:
        """One line: all arrays written out are thousands."""
        return f"<Face {self.label}, {self.kind}>"

    @property
    def numbers(self) -> tuple[int, ...]:
        """Numbers of the faces that it was joined from; its own where it is one face."""
        return tuple(member.face.number for member in self.members) or (self.number,)

    @property
    def own_faces(self) -> tuple["Face", ...]:
        """Faces that have the surfaces on which every point of this one lies: itself, unless it is seen in a plane."""
        if self.members and self.members[0].matrix is None:
            return tuple(member.face for member in self.members)
        return (self,)

    @classmethod
    def from_bspline(cls, points: ArrayLike, degree: tuple[int, int] = (3, 3),
                     knots: tuple[ArrayLike, ArrayLike] | None = None, weights: ArrayLike | None = None,
                     trims: tuple[ArrayLike, ...] = (), flip: bool = False) -> "Face":
        """A face from the control points of a B-spline surface.

        Parameters
        ----------
        points : (nu, nv, 3) array_like
            Control points, mm.
        degree : (int, int)
        knots : pair of array_like, optional
            Clamped uniform on [0, 1] unless given.
        weights : (nu, nv) array_like, optional
        trims : tuple of (m, 2) array_like
            Closed loops in (u, v), the outer one first.
        flip : bool
            The normal out of the material is Su x Sv, or its opposite with flip.

        Raises
        ------
        InvalidInput
            When shapes or values do not fit.
        """
        surface = NurbsSurface.from_points(points, degree, knots, weights)
        face = cls(surface, tuple(np.asarray(loop, dtype=float) for loop in trims), flip)
        face._check_loops()
        return face

    def _check_loops(self) -> None:
        """That loops lie on the surface, and holes in the outer loop."""
        domain = np.array(self.surface.domain)
        slack = 1e-9 * np.ptp(domain, axis=1)
        for index, loop in enumerate(self.trims):
            off = ((loop < domain[:, 0] - slack) | (loop > domain[:, 1] + slack)).any(axis=1)
            where = f"trim loop {index} of face {self.label}"
            if off.any():
                raise InvalidInput(f"{where} leaves the surface at {loop[off][0].tolist()}: u and v go from "
                                   f"{domain[:, 0].tolist()} to {domain[:, 1].tolist()}")
            if index and not inside(slabs(self.trims[:1]), loop).all():
                raise InvalidInput(f"{where} is no hole: it leaves the outer loop, which comes first")

    def evaluate(self, uv: ArrayLike) -> Derivatives:
        """Position and derivatives at (n, 2) parameters."""
        return self.surface.evaluate(np.asarray(uv, dtype=float))

    def normal(self, uv: ArrayLike, at: Derivatives | None = None) -> Array:
        """Unit normals out of the material, (n, 3); at poles the limit from inside, in folds the normal around them.

        Parameters
        ----------
        uv : (n, 2) array_like
        at : Derivatives, optional
            Position and derivatives at the same parameters, where they are known.
        """
        rows = np.asarray(uv, dtype=float).reshape(-1, 2)
        found = normals(self.evaluate(rows) if at is None else at, inward=self.surface.inward(rows))
        folds = find_folds(self.surface, rows, found)
        found[folds.rows] = folds.normal
        return -found if self.flip else found

    def folds(self, uv: ArrayLike) -> Folds:
        """Which of (n, 2) parameters lie in folds, and what surrounds them.

        Parameters
        ----------
        uv : (n, 2) array_like
        """
        rows = np.asarray(uv, dtype=float).reshape(-1, 2)
        if not self.surface.turning_cells.turning.any():
            return NO_FOLDS
        return find_folds(self.surface, rows, normals(self.evaluate(rows), inward=self.surface.inward(rows)))

    def outside_folds(self, uv: ArrayLike) -> Array:
        """Parameters (n, 2), where they lie in folds those of a place beside, up to 0.015 mm away.

        Parameters
        ----------
        uv : (n, 2) array_like
        """
        rows = np.array(uv, dtype=float).reshape(-1, 2)
        folds = self.folds(rows)
        rows[folds.rows] = folds.beside
        return rows

    def curvature(self, uv: ArrayLike) -> Curvature:
        """Principal curvatures (positive where the face bends towards its normal) at (n, 2) parameters.

        In folds they are those of the surface beside.  At poles they are those of a point beside, `POLE_STEP` of the
        way to the middle of the domain: within that share of their change over the face, and without bound at the apex
        of a cone.
        """
        rows = self.outside_folds(uv)
        d = self.evaluate(rows)
        poor = degenerate(d)
        if poor.any():
            rows[poor] += POLE_STEP * self.surface.inward(rows[poor])
            d = self.evaluate(rows)
        return curvatures(d, normals(d, self.flip, self.surface.inward(rows)))

    @cached_property
    def _slabs(self) -> EdgeIndex:
        return slabs(self.trims)

    def contains(self, uv: ArrayLike) -> NDArray[np.bool_]:
        """Whether (n, 2) parameters lie on the face or on its border: in the outer loop and in no hole, (n,) bool."""
        points = np.asarray(uv, dtype=float).reshape(-1, 2)
        if self.trims:
            return inside(self._slabs, points)
        (u0, u1), (v0, v1) = self.surface.domain
        u, v = points.T
        return np.asarray((u >= u0) & (u <= u1) & (v >= v0) & (v <= v1))

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Range of the face in its parameters: u0, u1, v0, v1."""
        if not self.trims:
            (u0, u1), (v0, v1) = self.surface.domain
            return u0, u1, v0, v1
        ends = [(loop.min(axis=0), loop.max(axis=0)) for loop in self.trims]
        low, high = np.min([end[0] for end in ends], axis=0), np.max([end[1] for end in ends], axis=0)
        return float(low[0]), float(high[0]), float(low[1]), float(high[1])

    def grid(self, nu: int, nv: int) -> Array:
        """Centres of nu x nv equal cells of the parameter range that lie on the face, (n, 2)."""
        u0, u1, v0, v1 = self.bounds
        u = u0 + (u1 - u0) * (np.arange(nu) + 0.5) / nu
        v = v0 + (v1 - v0) * (np.arange(nv) + 0.5) / nv
        uv = grid_rows(u, v)
        return uv[self.contains(uv)]

    def places_on(self, count: int) -> Array:
        """Centres of count x count cells of the parameter range that lie on the face, or its outline where none does.

        Parameters
        ----------
        count : int
        """
        within = self.grid(count, count)
        return within if len(within) else np.concatenate(self.outline)

    @cached_property
    def outline(self) -> tuple[Array, ...]:
        """The loops that bound the face in (u, v); the domain's rectangle where it is not trimmed."""
        if self.trims:
            return self.trims
        u0, u1, v0, v1 = self.bounds
        return (np.array([[u0, v0], [u1, v0], [u1, v1], [u0, v1]]),)

    @cached_property
    def area(self) -> float:
        """Area of the face, mm^2, to 1e-5 of itself; that of a skin without what of its faces lies under others."""
        own = self.own_faces
        if len(own) > 1 and self.fills_outline:
            hidden: float = getattr(self.surface, "hidden_area", 0.0)
            return sum(face.area for face in own) - hidden
        return measure.area(self)

    @cached_property
    def box(self) -> Array:
        """Lower and upper corner of the box around the face, (2, 3) mm, to 1e-6 of its diagonal."""
        return measure.box(self)

    @cached_property
    def diagonal(self) -> float:
        """Length of the diagonal of `box`, mm."""
        return float(np.linalg.norm(self.box[1] - self.box[0]))

    @property
    def fills_outline(self) -> bool:
        """Whether the loops are those around all the faces that it was joined from, where it is seen in a plane."""
        outline = getattr(self.surface, "outline", ())
        return len(outline) == len(self.trims) and all(map(np.array_equal, outline, self.trims))

    def trimmed(self, trims: tuple[ArrayLike, ...], label: str | None = None) -> "Face":
        """The same surface with other loops.

        Parameters
        ----------
        trims : tuple of (m, 2) array_like
        label : str, optional
            What messages call the piece.
        """
        loops = tuple(np.asarray(loop, dtype=float) for loop in trims)
        return replace(self, trims=loops, label=self.label if label is None else label)

    def transformed(self, matrix: ArrayLike) -> "Face":
        """The face moved by an affine map; a mirror also turns `flip` over, so that n stays out of the material.

        Parameters
        ----------
        matrix : (4, 4) array_like
        """
        mirrored = float(np.linalg.det(np.asarray(matrix, dtype=float)[:3, :3])) < 0
        members = tuple(replace(member, face=member.face.transformed(matrix)) for member in self.members)
        return replace(self, surface=self.surface.transformed(matrix), flip=self.flip ^ mirrored, members=members)
