"""CadQuery objects as a part."""

from typing import Any

import cadquery as cq

from toolaxis.cad.shapes import part_from_shapes
from toolaxis.errors import InvalidInput
from toolaxis.shape.part import Part


def part_from_cadquery(source: Any) -> Part:
    """A part from a Workplane, a Shape, an Assembly or a Sketch.

    Faces picked on a Workplane become the part's selection; the solid they belong to comes as a whole, because the
    rest of it must be kept clear of.

    Parameters
    ----------
    source : cadquery.Workplane, cadquery.Shape or cadquery.Assembly

    Raises
    ------
    InvalidInput
        When the object holds no faces.
    """
    name = f"CadQuery {type(source).__name__}"
    if isinstance(source, cq.Workplane):
        return _from_workplane(source, name)
    if isinstance(source, cq.Assembly):
        return part_from_shapes([source.toCompound().wrapped], name)
    if isinstance(source, cq.Shape):
        return part_from_shapes([source.wrapped], name)
    raise InvalidInput(f"cannot make a part of a {name}: give a Workplane, a Shape or an Assembly")


def _from_workplane(source: cq.Workplane, name: str) -> Part:
    shapes = [item for item in source.vals() if isinstance(item, cq.Shape)]
    shapes = [shape for shape in shapes if shape.Faces()]
    if not shapes:
        raise InvalidInput(f"the {name} holds no faces: the selection is empty, or only points, edges or wires")
    picked = [shape.wrapped for shape in shapes if isinstance(shape, cq.Face)]
    if not picked:
        return part_from_shapes([shape.wrapped for shape in shapes], name)
    owner = _owner(source, picked)
    if owner is None:
        return part_from_shapes([shape.wrapped for shape in shapes], name)
    return part_from_shapes([owner], name, picked)


def _owner(source: cq.Workplane, picked: list[Any]) -> Any:
    """The nearest solid or compound up the chain that has all picked faces; None without one."""
    step: Any = source.parent
    while step is not None:
        for item in step.vals():
            if isinstance(item, cq.Solid | cq.Compound | cq.Shell):
                own = [face.wrapped for face in item.Faces()]
                if all(any(face.IsSame(other) for other in own) for face in picked):
                    return item.wrapped
        step = step.parent
    return None
