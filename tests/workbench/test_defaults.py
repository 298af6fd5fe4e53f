"""What a job is given unless the user says otherwise: cutter, stick-out and scallop height by the part."""

from math import sin
from pathlib import Path

import FreeCAD
import Part
import pytest
from FreeCAD import Vector
from freecad.toolaxis.services.defaults import defaults

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@pytest.fixture
def document():
    document = FreeCAD.newDocument("Defaults")
    yield document
    FreeCAD.closeDocument(document.Name)


def waved(size, height):
    surface = Part.BSplineSurface()
    surface.interpolate([[Vector(size * i / 6, size * j / 6, height + 0.3 * sin(i + j)) for j in range(7)]
                         for i in range(7)])
    return surface.toShape()


def pocket(document, depth, size=30.0):
    """A block with a pocket whose floor is waved, and the name of the floor."""
    block = Part.makeBox(size + 60, size + 60, depth + 20, Vector(-30, -30, -20))
    above = waved(size, 0.0).extrude(Vector(0, 0, depth + 10))
    thing = document.addObject("Part::Feature", "Pocket")
    thing.Shape = block.cut(above)
    kinds = [type(face.Surface).__name__ for face in thing.Shape.Faces]
    return thing, f"Face{kinds.index('BSplineSurface') + 1}"


def test_the_stick_out_follows_the_depth_of_the_part(document):
    flat, shallow, deep = (defaults(document, (pocket(document, depth),)) for depth in (1.0, 20.0, 45.0))
    assert flat.tool == deep.tool
    diameter = 2 * deep.assembled().radius
    assert flat.stickout == 5 * diameter, "the holder is above it anyway"
    assert shallow.stickout <= deep.stickout and 45.0 < deep.stickout <= 60.0
    assert deep.stickout % 5 == 0


def test_no_tool_sticks_out_more_than_twelve_diameters(document):
    found = defaults(document, (pocket(document, 200.0, size=12.0),))
    assert found.stickout == 12 * 2 * found.assembled().radius


def test_a_narrow_gap_before_a_face_takes_a_thin_tool(document):
    wall = waved(60.0, 0.0)
    one, other = (document.addObject("Part::Feature", name) for name in ("Wall", "Other"))
    one.Shape = wall.extrude(Vector(0, 0, -5))
    kinds = [type(face.Surface).__name__ for face in one.Shape.Faces]
    faces = [f"Face{k + 1}" for k, kind in enumerate(kinds) if kind == "BSplineSurface"]
    name = max(faces, key=lambda name: one.Shape.getElement(name).CenterOfMass.z)
    alone = defaults(document, ((one, name),))
    assert alone.assembled().radius > 4
    block = Part.makeBox(60, 60, 20, Vector(0, 0, 8))
    other.Shape = Part.makeCompound([one.Shape, block])
    assert other.Shape.getElement(name).isSame(one.Shape.getElement(name))
    found = defaults(document, ((other, name),))
    assert 2 * found.assembled().radius <= 5 < 2 * alone.assembled().radius


def test_fillets_and_corners_do_not_choose_the_tool_for_all(document):
    """Found: whole parts got D2, 10 mm out and a scallop height of 5 um from their smallest face."""
    big, small = pocket(document, 1.0, size=60.0), pocket(document, 1.0, size=6.0)
    alone, both = defaults(document, (big,)), defaults(document, (big, small))
    assert both.tool == alone.tool and both.scallop == alone.scallop and both.stickout == alone.stickout
    assert defaults(document, (small,)).scallop == 0.01


def test_our_own_blisk_gets_a_tool_that_reaches(document):
    import Import

    Import.insert(str(EXAMPLES / "blisk.step"), document.Name)
    wheel = next(thing for thing in document.Objects if getattr(thing, "Shape", None) and thing.Shape.Faces)
    from freecad.toolaxis.document.read_shapes import sculptured

    found = defaults(document, tuple((wheel, name) for name in sculptured(wheel)))
    assert found.assembled().radius > 2 and found.stickout >= 30 and found.scallop >= 0.01
