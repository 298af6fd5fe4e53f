"""FreeCAD documents as parts: objects, links, arrays, shapes and faces, by FreeCAD's own Part module."""

from collections.abc import Sequence
from typing import Any

import FreeCAD
import Part as FreecadPart

from toolaxis.cad.build_part import part_from_record
from toolaxis.cad.freecad.shapes import shape_record
from toolaxis.errors import InvalidInput
from toolaxis.shape.part import Part


def part_from(thing: Any, selected: Sequence[Any] = ()) -> Part:
    """A part from something in a FreeCAD document, as it stands in the document's space.

    Faces have the numbers of FreeCAD's own names: Face7 has number 7.

    Parameters
    ----------
    thing : FreeCAD.DocumentObject, Part.Shape, or list of them
        An object comes with the placements of everything that it lies in: Part containers, bodies, links, arrays.
        The faces of a list are numbered through, in its order.
    selected : sequence of str or Part.Face
        Faces that the user picked, by name ("Face7", or "Box.Face7" in a container) or as faces of the same shape.

    Raises
    ------
    InvalidInput
        When it is no exact geometry (a mesh, a sketch, edges only), is empty or broken, or a name is not a face's.
    UnsupportedGeometry
        When none of its faces can be used.
    """
    shape, name = shape_of(thing), name_of(thing)
    faces = [_pick_face(thing, shape, item) for item in selected]
    return part_from_record(shape_record(shape, faces), name)


def shape_of(thing: Any) -> Any:
    """The Part.Shape of an object in the document's space, or the shape itself; a compound of several.

    Parameters
    ----------
    thing : FreeCAD.DocumentObject, Part.Shape, or list of them

    Raises
    ------
    InvalidInput
        When there is none with faces.
    """
    if isinstance(thing, list | tuple):
        if not thing:
            raise InvalidInput("the selection is empty: pick a solid, a shell or faces")
        return FreecadPart.Compound([shape_of(item) for item in thing])
    if isinstance(thing, FreecadPart.Shape):
        return _with_faces(thing, name_of(thing))
    if not isinstance(thing, FreeCAD.DocumentObject):
        raise InvalidInput(f"cannot make a part of {type(thing).__name__}: give an object of a FreeCAD document")
    name = name_of(thing)
    _check_object(thing, name)
    shape = FreecadPart.getShape(thing)
    if shape.isNull():
        raise InvalidInput(f"{name} has no shape: recompute it, or pick a solid, a shell or faces")
    return _move_shape(_with_faces(shape, name), container_placement(thing))


def name_of(thing: Any) -> str:
    """What a thing is called in messages.

    Parameters
    ----------
    thing : FreeCAD.DocumentObject, Part.Shape, or list of them

    Raises
    ------
    InvalidInput
        When the object was deleted.
    """
    if isinstance(thing, list | tuple):
        return ", ".join(dict.fromkeys(name_of(item) for item in thing))
    if not isinstance(thing, FreeCAD.DocumentObject):
        return f"the {type(thing).__name__.lower()}"
    try:
        return str(thing.Label)
    except ReferenceError as reason:
        raise InvalidInput("the object was deleted from its document: pick another one") from reason


def container_placement(thing: Any) -> Any:
    """The placement of what an object lies in: Part containers, bodies and assemblies, one in another.

    Parameters
    ----------
    thing : FreeCAD.DocumentObject

    Returns
    -------
    FreeCAD.Placement
    """
    placement, parent = FreeCAD.Placement(), _parent(thing)
    while parent is not None:
        placement = parent.Placement.multiply(placement)
        parent = _parent(parent)
    return placement


def _parent(thing: Any) -> Any:
    """What moves an object along: the array of an array's element, else the container; None without one."""
    if thing.isDerivedFrom("App::LinkElement"):
        arrays = [other for other in thing.InList if thing in (getattr(other, "ElementList", None) or ())]
        return arrays[0] if arrays else None
    return thing.getParentGeoFeatureGroup()


def _check_object(thing: Any, name: str) -> None:
    if thing.isDerivedFrom("Mesh::Feature"):
        raise InvalidInput(f"{name} is a mesh and has no exact surfaces: pick the solid that it was made from")
    if thing.isDerivedFrom("Sketcher::SketchObject"):
        raise InvalidInput(f"{name} is a sketch and has no surfaces: pick a solid, a shell or faces")
    if "Invalid" in thing.State:
        raise InvalidInput(f"{name} could not be computed ({thing.getStatusString()}): repair it first")


def _move_shape(shape: Any, placement: Any) -> Any:
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


def _nearest(shape: Any, face: Any) -> Any:
    """The face of a shape that is another one's copy in the same place."""
    copies = [other for other in shape.Faces if other.isPartner(face)]
    return min(copies, key=lambda other: other.CenterOfMass.distanceToPoint(face.CenterOfMass), default=face)


def _pick_face(thing: Any, shape: Any, item: Any) -> Any:
    """A face by its name, also below the objects of a container; faces come as they are."""
    if not isinstance(item, str):
        return item
    name = name_of(thing)
    digits = item.removeprefix("Face")
    if item.startswith("Face") and digits.isdigit() and 1 <= int(digits) <= len(shape.Faces):
        return shape.Faces[int(digits) - 1]
    if "." in item and isinstance(thing, FreeCAD.DocumentObject):
        found = FreecadPart.getShape(thing, item, needSubElement=True)
        if not found.isNull() and found.ShapeType == "Face":
            return _nearest(shape, _move_shape(found, container_placement(thing)).Faces[0])
    raise InvalidInput(f"{item} is no face of {name}: it has Face1 to Face{len(shape.Faces)}")
