"""Kernel shapes of the running process as a part."""

from collections.abc import Sequence
from typing import Any

from OCP.BRep import BRep_Builder
from OCP.TopoDS import TopoDS_Compound, TopoDS_Shape

from toolaxis.cad.build_part import part_from_record
from toolaxis.cad.ocp.reader import shape_record
from toolaxis.errors import InvalidInput
from toolaxis.shape.part import Part


def part_from_shapes(shapes: Sequence[Any], source: str, selected: Sequence[Any] = ()) -> Part:
    """A part from one or several kernel shapes.

    Parameters
    ----------
    shapes : sequence of TopoDS_Shape
    source : str
        What the part is called in messages.
    selected : sequence of TopoDS_Face
        Faces that the caller picked among them.

    Raises
    ------
    InvalidInput
        When there are no shapes, or something else is among them.
    UnsupportedGeometry
        When none of the faces can be used.
    """
    if not shapes:
        raise InvalidInput(f"{source} is empty: pick at least one face or solid")
    for index, shape in enumerate(shapes):
        if not isinstance(shape, TopoDS_Shape):
            raise InvalidInput(f"item {index} of {source} is {type(shape).__name__}: solids or faces are needed")
    return part_from_record(shape_record(shapes[0] if len(shapes) == 1 else _together(shapes), selected), source)


def _together(shapes: Sequence[Any]) -> TopoDS_Compound:
    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    for shape in shapes:
        builder.Add(compound, shape)
    return compound
