"""One way in for everything that can be a part."""

import sys
from os import PathLike, fspath
from typing import Any

from toolaxis.errors import InvalidInput
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part

MESHES = ("trimesh", "meshio", "pyvista", "open3d", "stl", "Mesh")


def load(source: Any, time_limit: float | None = None, accept_lost_faces: bool = False) -> Part:
    """A part from a STEP file, from an object of a CAD library, or from a FreeCAD document.

    Parameters
    ----------
    source : path, cadquery Workplane, Shape or Assembly, build123d object or list of them, TopoDS_Shape,
        FreeCAD document object or Part.Shape or list of them, Face, list of Face, or Part
    time_limit : float, optional
        s that the CAD kernel may take over a file.
    accept_lost_faces : bool
        Go on when faces of a file did not survive the transfer.

    Raises
    ------
    InvalidInput
        When nothing was given, or something that is no exact geometry.
    """
    if isinstance(source, Part):
        return source
    if isinstance(source, Face):
        return Part.from_faces([source])
    if isinstance(source, str | PathLike):
        from toolaxis.cad.step.read import read_step

        if not fspath(source):
            raise InvalidInput("the path of the part is empty: name a STEP file")
        return read_step(source, time_limit, accept_lost_faces)
    family = type(source).__module__.split(".")[0]
    if _is_freecad(source) or (isinstance(source, list | tuple) and source and all(map(_is_freecad, source))):
        from toolaxis.cad.freecad.documents import part_from

        return part_from(source)
    if family in ("cadquery", "build123d", "OCP"):
        return _from_library(source, family)
    if isinstance(source, list | tuple):
        return _from_several(list(source))
    if family in MESHES or hasattr(source, "triangles"):
        raise InvalidInput(f"a mesh ({type(source).__name__}) has no exact surfaces: give the STEP file or the CAD "
                           "object that it was made from")
    kind = type(source)
    raise InvalidInput(f"cannot make a part of {kind.__module__}.{kind.__name__}: give a STEP path, a CadQuery or "
                       "build123d object, or a list of faces")


def _is_freecad(source: Any) -> bool:
    """Whether it is an object of a FreeCAD document or a shape of its Part module; loads nothing of it."""
    freecad, shapes = sys.modules.get("FreeCAD"), sys.modules.get("Part")
    kinds = (getattr(freecad, "DocumentObject", None), getattr(shapes, "Shape", None))
    return any(kind is not None and isinstance(source, kind) for kind in kinds)


def _from_library(source: Any, family: str) -> Part:
    if family == "cadquery":
        from toolaxis.cad.cadquery import part_from_cadquery

        return part_from_cadquery(source)
    if family == "build123d":
        from toolaxis.cad.build123d import part_from_build123d

        return part_from_build123d(source)
    from toolaxis.cad.shapes import part_from_shapes

    return part_from_shapes([source], f"OCP {type(source).__name__}")


def _from_several(items: list[Any]) -> Part:
    if not items:
        raise InvalidInput("the selection is empty: pick at least one face or solid")
    if all(isinstance(item, Face) for item in items):
        return Part.from_faces(items)
    families = {type(item).__module__.split(".")[0] for item in items}
    if families == {"build123d"}:  # its faces know the solid that they were picked from
        return _from_library(items, "build123d")
    if families <= {"cadquery", "build123d", "OCP"}:
        from toolaxis.cad.shapes import part_from_shapes

        return part_from_shapes([getattr(item, "wrapped", item) for item in items], f"{len(items)} objects")
    raise InvalidInput(f"item 0 of the list is {type(items[0]).__name__}: give faces of one library")
