"""FreeCAD documents as parts: objects, links, arrays, shapes and faces, by FreeCAD's own Part module."""

from collections.abc import Sequence
from typing import Any

import FreeCAD
import Part as FreecadPart

from toolaxis.cad.assembling import part_from_record
from toolaxis.cad.freecad_shapes import shape_record
from toolaxis.errors import InvalidInput
from toolaxis.shape.part import Part


def part_from(thing: Any, selected: Sequence[Any] = ()) -> Part:
    """A part from something in a FreeCAD document, as it stands in the document's space.

    Faces have the numbers of FreeCAD's own names: Face7 has number 7.

    Parameters
    ----------
    thing : FreeCAD.DocumentObject or Part.Shape
        An object comes with the placements of everything that it lies in: Part containers, bodies, links, arrays.
    selected : sequence of str or Part.Face
        Faces that the user picked, by name ("Face7") or as faces of the same shape.

    Raises
    ------
    InvalidInput
        When it is no exact geometry (a mesh, a sketch, edges only), is empty or broken, or a name is not a face's.
    UnsupportedGeometry
        When none of its faces can be used.
    """
    shape, name = shape_of(thing), name_of(thing)
    faces = [_picked(shape, item, name) for item in selected]
    return part_from_record(shape_record(shape, faces), name)


def shape_of(thing: Any) -> Any:
    """The Part.Shape of an object in the document's space, or the shape itself.

    Parameters
    ----------
    thing : FreeCAD.DocumentObject or Part.Shape

    Raises
    ------
    InvalidInput
        When there is none with faces.
    """
    if isinstance(thing, FreecadPart.Shape):
        return _with_faces(thing, name_of(thing))
    if not isinstance(thing, FreeCAD.DocumentObject):
        raise InvalidInput(f"cannot make a part of {type(thing).__name__}: give an object of a FreeCAD document")
    name = name_of(thing)
    if thing.isDerivedFrom("Mesh::Feature"):
        raise InvalidInput(f"{name} is a mesh and has no exact surfaces: pick the solid that it was made from")
    if thing.isDerivedFrom("Sketcher::SketchObject"):
        raise InvalidInput(f"{name} is a sketch and has no surfaces: pick a solid, a shell or faces")
    shape = FreecadPart.getShape(thing)
    if shape.isNull():
        raise InvalidInput(f"{name} has no shape: recompute it, or pick a solid, a shell or faces")
    return _moved(_with_faces(shape, name), container_placement(thing))


def name_of(thing: Any) -> str:
    """What a thing is called in messages."""
    if isinstance(thing, FreeCAD.DocumentObject):
        return str(thing.Label)
    return f"the {type(thing).__name__.lower()}"


def container_placement(thing: Any) -> Any:
    """The placement of what an object lies in: Part containers, bodies and assemblies, one in another.

    Parameters
    ----------
    thing : FreeCAD.DocumentObject

    Returns
    -------
    FreeCAD.Placement
    """
    placement, parent = FreeCAD.Placement(), thing.getParentGeoFeatureGroup()
    while parent is not None:
        placement = parent.Placement.multiply(placement)
        parent = parent.getParentGeoFeatureGroup()
    return placement


def _moved(shape: Any, placement: Any) -> Any:
    if placement.isIdentity():
        return shape
    moved = FreecadPart.Shape(shape)
    moved.Placement = placement.multiply(shape.Placement)
    return moved


def _with_faces(shape: Any, name: str) -> Any:
    if shape.isNull():
        raise InvalidInput(f"{name} is empty: recompute it, or pick a solid, a shell or faces")
    if not shape.Faces:
        raise InvalidInput(f"{name} has no faces, only edges or points: pick a solid, a shell or faces")
    return shape


def _picked(shape: Any, item: Any, name: str) -> Any:
    """A face by its name; faces come as they are."""
    if not isinstance(item, str):
        return item
    digits = item.removeprefix("Face")
    number = int(digits) if item.startswith("Face") and digits.isdigit() else 0
    if not 1 <= number <= len(shape.Faces):
        raise InvalidInput(f"{item} is no face of {name}: it has Face1 to Face{len(shape.Faces)}")
    return shape.Faces[number - 1]
