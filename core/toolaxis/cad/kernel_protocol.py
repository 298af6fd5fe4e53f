"""What toolaxis asks of a CAD kernel: protocols that every kernel's reader fills, and the forms of exact geometry."""

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.cad.curves import Spline

Array = NDArray[np.float64]
Box: TypeAlias = tuple[float, float, float, float]


class CurveForm(NamedTuple):
    """A curve that has an exact spline: whether its parameter is an angle, and the spline over a range of it."""

    round: bool
    spline: Callable[[float, float], Spline]


class PlaneForm(NamedTuple):
    """A plane: world from local, (4, 4)."""

    placed: Array


class MeridianForm(NamedTuple):
    """Cylinder, cone, sphere or torus: a meridian in the local x-z plane, turned about z.

    The meridian is start + v course for a course (3,), and start + course (cos v, 0, sin v) for a radius.
    """

    placed: Array
    start: Array
    course: Array | float


class RevolutionForm(NamedTuple):
    """A curve turned about an axis."""

    origin: Array
    direction: Array
    curve: CurveForm


class ExtrusionForm(NamedTuple):
    """A curve moved along a unit direction."""

    direction: Array
    curve: CurveForm


class SplineForm(NamedTuple):
    """A B-spline: knots, homogeneous control net (nu, nv, 4), degree, and whether it is periodic in u and v."""

    knots_u: Array
    knots_v: Array
    net: Array
    degree: tuple[int, int]
    periodic: tuple[bool, bool] = (False, False)


Form: TypeAlias = PlaneForm | MeridianForm | RevolutionForm | ExtrusionForm | SplineForm


class KernelSurface(Protocol):
    """A surface in its kernel's parameters.

    Attributes
    ----------
    kind : str
        In our words.
    domain : (u0, u1, v0, v1)
        Natural borders; beyond 1e50 where there is none.
    periods : (float, float)
        0 where it is not periodic.
    form : Form or None
        None where it has no exact form here.
    """

    @property
    def kind(self) -> str: ...
    @property
    def domain(self) -> Box: ...
    @property
    def periods(self) -> tuple[float, float]: ...
    @property
    def form(self) -> Form | None: ...

    def points(self, uv: Array) -> Array:
        """Points, (n, 3)."""

    def tangents(self, uv: Array) -> Array:
        """Su and Sv, (n, 2, 3)."""

    def approximation(self, box: Box, tolerance: float) -> tuple[SplineForm, float] | None:
        """The kernel's B-spline in the same parameters over a box, and the error it claims; None where it fails."""


class KernelEdge(Protocol):
    """An edge as a wire of a face runs along it.

    Attributes
    ----------
    key : int
        The same for the same edge in every face.
    forward : bool
        The wire runs along it in its own direction.
    degenerate : bool
        It is a point in space.
    straight : bool
        A line in the kernel's parameters of the face.
    spans : int
        Pieces of its curve in the parameters that are smooth (C2).
    space_spans : int
        Pieces of its curve in space that are smooth (C2).
    """

    @property
    def key(self) -> int: ...
    @property
    def forward(self) -> bool: ...
    @property
    def degenerate(self) -> bool: ...
    @property
    def straight(self) -> bool: ...
    @property
    def spans(self) -> int: ...
    @property
    def space_spans(self) -> int: ...

    def parameters(self, share: Array) -> Array:
        """(u, v) at shares of the way that the wire runs, (n, 2)."""

    def points(self, share: Array) -> Array:
        """Points at shares of the edge's own range, in its own direction, (n, 3)."""


class KernelFace(Protocol):
    """A face, its wires as they run when the face's sense is that of its surface.

    Attributes
    ----------
    flip : bool
        Su x Sv points into the material.
    surface : KernelSurface or None
        None where it has only a mesh.
    wires : list of list of KernelEdge
    """

    @property
    def flip(self) -> bool: ...
    @property
    def surface(self) -> KernelSurface | None: ...
    @property
    def wires(self) -> Sequence[Sequence[KernelEdge]]: ...


class KernelBody(NamedTuple):
    """Faces that belong together: "solid", "shell" or "faces", their numbers, closed or not, inside out or not."""

    kind: str
    faces: tuple[int, ...]
    closed: bool
    inside_out: bool = False
