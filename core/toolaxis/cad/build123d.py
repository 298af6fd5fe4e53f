"""build123d objects as a part."""

from collections.abc import Iterable
from typing import Any

import build123d as bd

from toolaxis.cad.shapes import part_from_shapes
from toolaxis.errors import InvalidInput
from toolaxis.shape.part import Part


def part_from_build123d(source: Any) -> Part:
    """A part from a Part, Solid, Face, Compound, a builder or a list of them.

    Faces picked from a solid become the part's selection; where build123d knows the solid they were picked from, it
    comes as a whole, because the rest of it must be kept clear of.

    Parameters
    ----------
    source : build123d.Shape, build123d.BuildPart, build123d.BuildSketch or list of build123d.Shape

    Raises
    ------
    InvalidInput
        When the object holds no faces.
    """
    name = f"build123d {type(source).__name__}"
    for attribute in ("part", "sketch"):
        if isinstance(source, bd.Builder) and getattr(source, attribute, None) is not None:
            source = getattr(source, attribute)
    items = [source] if isinstance(source, bd.Shape) else list(source) if isinstance(source, Iterable) else []
    shapes = [item for item in items if isinstance(item, bd.Shape)]
    with_faces = [item for item in shapes if item.wrapped is not None and item.faces()]
    if not with_faces:
        raise InvalidInput(f"the {name} holds no faces: the selection is empty, or only points, edges or wires")
    if all(isinstance(item, bd.Face) for item in with_faces):
        return _from_faces(with_faces, name)
    return part_from_shapes([item.wrapped for item in with_faces], name)


def _from_faces(faces: list[Any], name: str) -> Part:
    picked = [face.wrapped for face in faces]
    owner = getattr(faces[0], "topo_parent", None)
    if owner is not None and owner.wrapped is not None:
        own = [face.wrapped for face in owner.faces()]
        if all(any(face.IsSame(other) for other in own) for face in picked):
            return part_from_shapes([owner.wrapped], name, picked)
    return part_from_shapes(picked, name)
