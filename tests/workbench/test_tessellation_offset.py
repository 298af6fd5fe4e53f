"""What is shown over a face lies above the triangles that FreeCAD draws of it."""

import FreeCAD
import numpy as np
import Part
import pytest
from freecad.toolaxis.document.inputs import JobInputs
from freecad.toolaxis.document.placement import chain_of
from freecad.toolaxis.document.read_shapes import ShapesRead
from freecad.toolaxis.document.sub_surface_shape import SURFACE, show_surface
from freecad.toolaxis.document.tessellation_offset import bulge

from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.progress import NO_PROGRESS
from toolaxis.shape.nearest import nearest

RADIUS = 60.0


@pytest.fixture(params=["hollow", "hump"])
def shown(document, request):
    """A block with a round hollow or hump, and its round face as the library reads it."""
    block = Part.makeBox(80, 80, 20)
    ball = Part.makeSphere(RADIUS, FreeCAD.Vector(40, 40, 70 if request.param == "hollow" else -50))
    thing = document.addObject("Part::Feature", "Block")
    thing.Shape = block.cut(ball) if request.param == "hollow" else block.common(ball)
    kinds = [type(face.Surface).__name__ for face in thing.Shape.Faces]
    number = kinds.index("Sphere") + 1
    part, _ = ShapesRead.of(JobInputs(((thing, f"Face{number}"),))).read(NO_PROGRESS)
    return thing, number, part.face(number), request.param


def drawn_by_freecad(thing, number):
    """Middles of the triangles that FreeCAD shows of a face."""
    box = thing.Shape.BoundBox
    share = (box.XLength + box.YLength + box.ZLength) / 300 * 0.2
    points, corners = thing.Shape.Faces[number - 1].tessellate(share)
    return np.array([tuple(point) for point in points])[np.array(corners)].mean(axis=1)


def test_chords_over_a_hollow_stay_below_what_is_shown(shown):
    thing, number, face, kind = shown
    middles = drawn_by_freecad(thing, number)
    found = nearest(face, middles)
    above = ((middles - found.point) * face.normal(found.uv)).sum(axis=1)
    bound = bulge(face, thing)
    assert above.max() <= bound + 1e-6
    if kind == "hollow":
        assert above.max() > 0.3 * bound
    else:
        assert bound == 0.0


def test_the_mesh_of_a_sub_surface_is_above_them(document, shown):
    thing, _, face, _ = shown
    group = document.addObject("App::DocumentObjectGroupPython", "Group")
    show_surface(group, Operation(1, face, None, Orientation(None)), chain_of(thing), (0.5, 0.5, 1.0))
    mesh, = (one for one in group.Group if one.Shows == SURFACE)
    points = np.array([tuple(point) for point in mesh.Mesh.Topology[0]])
    corners = points[np.array(mesh.Mesh.Topology[1])].mean(axis=1)
    found = nearest(face, corners)
    height = ((corners - found.point) * face.normal(found.uv)).sum(axis=1)
    assert height.min() > bulge(face, thing) and height.max() < bulge(face, thing) + 3e-3 * face.diagonal
