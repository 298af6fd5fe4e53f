"""A shape as plain arrays: what leaves the CAD kernel, also across processes."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.cad.rational_arcs import ParameterMap
from toolaxis.shape.adjacency import Border
from toolaxis.shape.joining.edge_matching import OpenEdge
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.shape.part import LEFT_OUT, Body

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FaceRecord:
    """One face.

    Attributes
    ----------
    number : int
        From 1, in the file's order.
    knots_u, knots_v, control, degree
        The surface, as `toolaxis.shape.nurbs.NurbsSurface` takes it.
    loops : tuple of (m, 2) arrays
        In our parameters, outer one first and anticlockwise; empty for the whole domain.
    flip : bool
        Su x Sv points into the material.
    turned : bool
        Its wires ran clockwise in the file.
    kind : str
    tolerance : float
    map : ParameterMap
        From the kernel's parameters to ours.
    """

    number: int
    knots_u: Array
    knots_v: Array
    control: Array
    degree: tuple[int, int]
    loops: tuple[Array, ...]
    flip: bool
    turned: bool
    kind: str
    tolerance: float
    map: ParameterMap

    @cached_property
    def surface(self) -> NurbsSurface:
        """The surface."""
        return NurbsSurface(self.knots_u, self.knots_v, self.control, self.degree)


@dataclass
class ShapeRecord:
    """A whole shape.

    Attributes
    ----------
    faces : list of FaceRecord
    borders : list of Border
        Edges that faces share.
    free : list of OpenEdge
        Edges that only one face has.
    bodies : list of Body
    warnings : list of str
    unit : str
        The length unit that the file declares.
    selected : tuple of int
        Numbers of the faces that the caller picked.
    endless : int
        How many faces were left out because they have no border and no end.
    """

    faces: list[FaceRecord] = field(default_factory=list)
    borders: list[Border] = field(default_factory=list)
    free: list[OpenEdge] = field(default_factory=list)
    bodies: list[Body] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    unit: str = "mm"
    selected: tuple[int, ...] = ()
    endless: int = 0


@dataclass(frozen=True)
class Transfer:
    """What a kernel has made of a STEP file.

    Attributes
    ----------
    record : ShapeRecord
    distinct : int
        How many different faces with an end, copies in several places counted once.
    lost : dict of int to int
        Faces that were not made: entity number to the face's number.  Empty too where the kernel does not tell.
    split : dict of int to int
        Entities of which several faces were made, and how many.
    """

    record: ShapeRecord
    distinct: int
    lost: dict[int, int] = field(default_factory=dict)
    split: dict[int, int] = field(default_factory=dict)


def left_out(face: str, why: str) -> str:
    """The warning about a face that cannot be used.

    Parameters
    ----------
    face : str
        What it is called.
    why : str
        With the remedy.
    """
    return f"{face} {LEFT_OUT}: {why}; until then it is neither machined nor kept clear of"
