"""Objects of FreeCAD documents as parts: where they stand, what they are called, what is refused."""

import FreeCAD
import Mesh
import numpy as np
import Part as FreecadPart
import pytest
from FreeCAD import Placement, Rotation, Vector

import toolaxis as ta
from toolaxis.cad.freecad.documents import part_from

TURNED = Placement(Vector(100, 0, 0), Rotation(Vector(0, 0, 1), 90))


@pytest.fixture
def document():
    made = FreeCAD.newDocument("Parts")
    yield made
    FreeCAD.closeDocument(made.Name)


@pytest.fixture
def nested(document):
    """A box 10 x 20 x 30 in a turned container in a raised one."""
    box = document.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 10, 20, 30
    inner, outer = (document.addObject("App::Part", name) for name in ("Inner", "Outer"))
    inner.Placement, outer.Placement.Base = TURNED, Vector(0, 0, 50)
    inner.addObject(box)
    outer.addObject(inner)
    document.recompute()
    return box


def box_of(part):
    return part.box.round(9).tolist()


def test_a_box_comes_with_its_own_placement(document):
    box = document.addObject("Part::Box", "Box")
    box.Placement.Base = Vector(1, 2, 3)
    document.recompute()
    part = ta.load(box)
    assert box_of(part) == [[1, 2, 3], [11, 12, 13]]
    assert part.source == "Box"
    assert [body.kind for body in part.bodies] == ["solid"]


@pytest.mark.parametrize("name", ["Box", "Inner", "Outer"])
def test_containers_move_what_they_hold(document, nested, name):
    assert box_of(ta.load(document.getObject(name))) == [[80, 0, 50], [100, 10, 80]]


def test_a_feature_in_a_body_in_a_container_stands_where_it_is_seen(document, nested):
    body = document.addObject("PartDesign::Body", "Body")
    feature = document.addObject("PartDesign::AdditiveBox", "Block")
    body.addObject(feature)
    body.Placement.Base = Vector(5, 0, 0)
    document.Inner.addObject(body)
    document.recompute()
    for thing in (body, feature):
        assert box_of(ta.load(thing)) == [[90, 5, 50], [100, 15, 60]]


def test_a_group_in_a_container_and_what_is_in_it(document, nested):
    group, box = document.addObject("App::DocumentObjectGroup", "Group"), document.addObject("Part::Box", "Other")
    group.addObject(box)
    document.Inner.addObject(group)
    document.recompute()
    for thing in (group, box):
        assert box_of(ta.load(thing)) == [[90, 0, 50], [100, 10, 60]]


def test_links_stand_where_they_were_put(document, nested):
    link = document.addObject("App::Link", "Link")
    link.LinkedObject = nested
    link.Placement.Base = Vector(0, 200, 0)
    document.recompute()
    assert box_of(ta.load(link)) == [[0, 200, 0], [10, 220, 30]]
    link.Scale = 2.0
    document.recompute()
    assert box_of(ta.load(link)) == [[0, 200, 0], [20, 240, 60]]
    document.Inner.addObject(link)
    link.Scale = 1.0
    document.recompute()
    assert box_of(ta.load(link)) == [[-120, 0, 50], [-100, 10, 80]]


def test_an_array_of_links_and_one_of_its_elements(document, nested):
    array = document.addObject("App::Link", "Array")
    array.LinkedObject, array.ElementCount = nested, 3
    document.recompute()
    for k, element in enumerate(array.ElementList):
        element.Placement.Base = Vector(20 * k, 0, 0)
    array.Placement.Base = Vector(0, 0, 70)
    document.recompute()
    part = part_from(array, [f"{array.ElementList[1].Name}.Face3"])
    assert box_of(part) == [[0, 0, 70], [50, 20, 100]]
    assert len(part.bodies) == 3
    assert part.selected == (9,)
    assert box_of(ta.load(array.ElementList[2])) == [[40, 0, 70], [50, 20, 100]]


def test_faces_keep_their_names_wherever_the_object_stands(document, nested):
    part = part_from(nested, ["Face6", "Face2"])
    assert part.selected == (2, 6)
    for number, face in enumerate(nested.Shape.Faces, 1):
        middle = document.Outer.Placement.multiply(TURNED).multVec(face.CenterOfMass)
        assert part.face(number).box.mean(axis=0) == pytest.approx(np.array(middle), abs=1e-9)
    assert part_from(document.Outer, ["Inner.Box.Face4"]).selected == (4,)


def test_several_objects_are_one_part(document, nested):
    other = document.addObject("Part::Sphere", "Sphere")
    document.recompute()
    part = ta.load([nested, other])
    assert [face.number for face in part.faces] == list(range(1, 8))
    assert part.face(7).kind == "sphere"
    assert part.source == "Box, Sphere"
    assert len(ta.load([nested.Shape.Faces[0], nested.Shape.Faces[2]]).edges) == 1


def test_a_moved_part_is_the_same_part_moved(document):
    """Metamorphic: points, normals and edges follow the placement."""
    torus = document.addObject("Part::Torus", "Torus")
    document.recompute()
    still = ta.load(torus)
    torus.Placement = Placement(Vector(7, -3, 2), Rotation(Vector(1, 2, 3), 77))
    document.recompute()
    moved, matrix = ta.load(torus), np.array(torus.Placement.Matrix.A).reshape(4, 4)
    uv = still.face(1).grid(9, 9)
    assert moved.face(1).evaluate(uv).point == pytest.approx(
        still.face(1).evaluate(uv).point @ matrix[:3, :3].T + matrix[:3, 3], abs=1e-12)
    assert moved.face(1).normal(uv) == pytest.approx(still.face(1).normal(uv) @ matrix[:3, :3].T, abs=1e-12)


def mesh(document):
    made = document.addObject("Mesh::Feature", "Scan")
    made.Mesh = Mesh.createBox(1, 1, 1)
    return made


def sketch(document):
    made = document.addObject("Sketcher::SketchObject", "Drawing")
    made.addGeometry(FreecadPart.LineSegment(Vector(0, 0, 0), Vector(1, 0, 0)))
    document.recompute()
    return made


def edge(document):
    made = document.addObject("Part::Feature", "Wire")
    made.Shape = FreecadPart.makeLine(Vector(0, 0, 0), Vector(1, 1, 1))
    return made


def failed(document):
    made = document.addObject("Part::Fillet", "Fillet")
    made.Base = document.addObject("Part::Box", "Box")
    made.Edges = [(1, 50.0, 50.0)]
    document.recompute()
    return made


def deleted(document):
    made = document.addObject("Part::Box", "Gone")
    document.removeObject("Gone")
    return made


@pytest.mark.parametrize("make, sentence", [
    (mesh, "Scan is a mesh and has no exact surfaces"),
    (lambda document: mesh(document).Mesh, "mesh .* has no exact surfaces"),
    (sketch, "Drawing is a sketch and has no surfaces"),
    (edge, "Wire has no faces, only edges or points"),
    (lambda document: edge(document).Shape, "edge has no faces"),
    (failed, "Fillet could not be computed .*: repair it"),
    (deleted, "was deleted"),
    (lambda document: document.addObject("Part::Feature", "Empty"), "Empty has no shape"),
    (lambda document: FreecadPart.Shape(), "is empty"),
    (lambda document: document.addObject("App::Part", "Hollow"), "Hollow has no shape"),
    (lambda document: document.addObject("App::Link", "Loose"), "Loose has no shape"),
    (lambda document: document.addObject("App::FeaturePython", "Text"), "Text has no shape"),
    (lambda document: document.addObject("App::Placement", "Frame"), "no borders and no end|has no shape"),
    (lambda document: document, "cannot make a part of App.Document"),
    (lambda document: [], "selection is empty"),
])
def test_what_is_no_part_is_refused_in_one_sentence(document, make, sentence):
    with pytest.raises(ta.ToolAxisError, match=sentence) as caught:
        ta.load(make(document))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["Face7", "Edge1", "Face", "Face0", "", "Nowhere.Face1"])
def test_a_name_that_is_no_face_is_refused(nested, name):
    with pytest.raises(ta.InvalidInput, match="is no face of Box: it has Face1 to Face6"):
        part_from(nested, [name])


def test_a_solid_that_is_inside_out_is_turned_over():
    part = ta.load(FreecadPart.makeBox(1, 2, 3).reversed())
    assert any("inside out" in warning for warning in part.warnings)
    face = part.face(1)
    assert face.normal(face.grid(1, 1))[0] @ (face.box.mean(axis=0) - [0.5, 1, 1.5]) > 0


def test_an_open_shell_says_so():
    part = ta.load(FreecadPart.Shell(FreecadPart.makeBox(1, 1, 1).Faces[:4]))
    assert [(body.kind, body.closed) for body in part.bodies] == [("shell", False)]
    assert any("open shell" in warning for warning in part.warnings)


@pytest.mark.parametrize("make, kinds", [
    (lambda: FreecadPart.makeSphere(4), ["sphere"]),
    (lambda: FreecadPart.makeTorus(10, 2), ["torus"]),
    (lambda: FreecadPart.makeCone(3, 0, 6), ["cone", "plane"]),
    (lambda: FreecadPart.makeCylinder(3, 5), ["cylinder", "plane", "plane"]),
])
def test_seams_and_poles_are_no_edges_and_lose_no_area(make, kinds):
    shape = make()
    part = ta.load(shape)
    assert [face.kind for face in part.faces] == kinds
    assert sum(face.area for face in part.faces) == pytest.approx(shape.Area, rel=1e-4)
    assert len(part.edges) == len(kinds) - 1
