"""Small parts for the tests of objects, and plans for them with a given axis, without a search."""

from math import cos, sin

import FreeCAD
import Part as FreecadPart
from FreeCAD import Vector
from freecad.toolaxis.document.inputs import JobInputs
from freecad.toolaxis.document.read_shapes import ShapesRead
from freecad.toolaxis.services.write_results import apply

from toolaxis.job.planning.edit_axis import try_axis
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan
from toolaxis.progress import NO_PROGRESS

TOOL, SCALLOP = "torus:6x1", 0.3
HOLDER = ((10.0, 0.0), (10.0, 30.0))
LEANING = Vector(0.2, 0.1, 1.0).normalize()
#: Plans by all that they were asked for with.
_PLANS = {}


def wavy(height=10.0):
    """A block of 20 x 16 mm with a wavy top, as a shape."""
    points = [[Vector(x, y, height + 0.8 * sin(x / 9) * cos(y / 8)) for y in range(0, 17, 4)]
              for x in range(0, 21, 5)]
    surface = FreecadPart.BSplineSurface()
    surface.interpolate(points)
    below = surface.toShape().extrude(Vector(0, 0, -30))
    return below.common(FreecadPart.makeBox(60, 60, 40, Vector(-20, -20, 0)))


def block(document, name="Block", height=10.0):
    """The wavy block as an object."""
    thing = document.addObject("Part::Feature", name)
    thing.Shape = wavy(height)
    document.recompute()
    return thing


def sculptured_name(thing):
    """The name of the wavy face of an object."""
    kinds = [type(face.Surface).__name__ for face in thing.Shape.Faces]
    return f"Face{kinds.index('BSplineSurface') + 1}"


def inputs_for(*faces, **given):
    """Inputs for faces, quickly computed."""
    return JobInputs(tuple(faces), TOOL, holder=HOLDER, stickout=25.0, **{"scallop": SCALLOP, **given})


def quick_plan(inputs, axis=LEANING):
    """A plan with one axis for every face; axis in the document's space."""
    source = ShapesRead.of(inputs)
    part, bodies = source.read(NO_PROGRESS)
    tool = inputs.assembled()
    bare = Plan(part, (tool,), inputs.job(), (), bodies, FreeCAD.Vector(*source.datum), "complete")
    made = [try_axis(bare, Operation(k, part.face(number), tool, Orientation(None)), tuple(axis))
            for k, number in enumerate(source.numbers, 1)]
    return Plan(part, bare.tools, bare.inputs, tuple(made), bodies, bare.datum, "complete")


def known_plan(inputs, axis=LEANING):
    """The same; what was asked of the same shapes before, in whatever document, is not planned again."""
    things = [*inputs.things, *inputs.obstacles]
    if any(thing.getParentGeoFeatureGroup() is not None for thing in things):  # it may stand elsewhere than it says
        return quick_plan(inputs, axis)
    asked = repr((inputs.job(), inputs.assembled(), [(things.index(thing), name) for thing, name in inputs.faces],
                  tuple(axis), [thing.Shape.exportBrepToString() for thing in things]))
    if asked not in _PLANS:
        _PLANS[asked] = quick_plan(inputs, axis)
    return _PLANS[asked]


def planned(document, *faces, axis=LEANING, **given):
    """The operations for faces, in the tree."""
    inputs = inputs_for(*faces, **given)
    return apply(document, inputs, known_plan(inputs, axis))
