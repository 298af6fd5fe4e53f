"""Faces outside solids in FreeCAD: shells and compounds of documents, and of files that FreeCAD reads."""

import re
from pathlib import Path

import FreeCAD
import Import
import numpy as np
import Part as FreecadPart
import pytest
from FreeCAD import Placement, Rotation, Vector

import toolaxis as ta
from toolaxis.errors import InvalidInput

EXAMPLES = Path(__file__).parents[2] / "examples"
BLOCK = (EXAMPLES / "saddle.step").read_text()
TURNED = Placement(Vector(100, 0, 0), Rotation(Vector(0, 0, 1), 90))
LIFTED = Placement(Vector(0, 0, 50), Rotation())


@pytest.fixture
def shell():
    """Two faces, 20 x 10 and 20 x 30 mm, that meet along x."""
    def face(*corners):
        return FreecadPart.Face(FreecadPart.makePolygon([Vector(*corner) for corner in (*corners, corners[0])]))

    return FreecadPart.makeShell([face((0, 0, 0), (20, 0, 0), (20, 10, 0), (0, 10, 0)),
                                  face((0, 0, 0), (0, 0, 30), (20, 0, 30), (20, 0, 0))])


def feature(document, shape, name="Thing"):
    made = document.addObject("Part::Feature", name)
    made.Shape = shape
    return made


def box_of(part):
    return part.box.round(6).tolist()


def test_an_open_shell_is_a_part(document, shell):
    part = ta.load(feature(document, shell))
    assert [(body.kind, body.faces, body.closed) for body in part.bodies] == [("shell", (1, 2), False)]
    assert box_of(part) == [[0, 0, 0], [20, 10, 30]] and [edge.faces for edge in part.edges] == [(1, 2)]
    assert any("faces 1 to 2 form an open shell" in warning for warning in part.warnings)


def test_compounds_of_shells_in_compounds_stand_where_they_are_placed(document, shell):
    """The same shell twice in a compound that itself stands twice in another: eight faces in four places."""
    far = shell.copy()
    far.Placement = TURNED
    pair = FreecadPart.Compound([shell, far])
    lifted = pair.copy()
    lifted.Placement = LIFTED
    thing = feature(document, FreecadPart.Compound([pair, lifted]))
    thing.Placement.Base = Vector(0, 7, 0)
    document.recompute()
    part = ta.load(thing)
    assert [body.kind for body in part.bodies] == ["shell"] * 4 and len(part.faces) == 8
    for face, named in zip(part.faces, thing.Shape.Faces, strict=True):
        assert face.box.mean(axis=0) == pytest.approx(np.array(named.BoundBox.Center), abs=1e-6)
    assert box_of(part) == [[0, 7, 0], [100, 27, 80]]
    assert any("4 shells are open" in warning for warning in part.warnings)


def test_shells_in_containers_and_links_stand_where_they_are_seen(document, shell):
    inner, outer = (document.addObject("App::Part", name) for name in ("Inner", "Outer"))
    inner.Placement, outer.Placement = TURNED, LIFTED
    thing = feature(document, shell)
    inner.addObject(thing)
    outer.addObject(inner)
    link = document.addObject("App::Link", "Link")
    link.LinkedObject, link.ElementCount = thing, 2
    document.recompute()
    for one in (thing, inner, outer):
        assert box_of(ta.load(one)) == [[90, 0, 50], [100, 20, 80]]
    link.ElementList[1].Placement.Base = Vector(0, 200, 0)
    document.recompute()
    part = ta.load(link)
    assert [body.faces for body in part.bodies] == [(1, 2), (3, 4)] and box_of(part) == [[0, 0, 0], [20, 210, 30]]


def test_loose_faces_beside_a_shell_and_a_solid(document, shell):
    box = FreecadPart.makeBox(5, 5, 5, Vector(50, 0, 0))
    part = ta.load(feature(document, FreecadPart.Compound([box, shell, shell.Faces[0].translated(Vector(0, 0, 90))])))
    assert [(body.kind, len(body.faces)) for body in part.bodies] == [("solid", 6), ("shell", 2), ("faces", 1)]


def test_an_absurd_face_of_a_document_is_left_out_by_its_name(document):
    surface = FreecadPart.BSplineSurface()
    surface.setPole(1, 1, Vector(0, 0, 1e30))
    box = FreecadPart.makeBox(5, 5, 5, Vector(50, 0, 0))
    part = ta.load(feature(document, FreecadPart.Compound([*box.Faces[:2], surface.toShape(), *box.Faces[2:4]])))
    assert [face.number for face in part.faces] == [1, 2, 4, 5]
    (told,) = [warning for warning in part.warnings if warning.startswith("face 3 was left out: ")]
    assert "neither machined nor kept clear of" in told


def swapped(text, pattern, new):
    changed, count = re.subn(pattern, new, text, count=1, flags=re.S)
    assert count == 1, pattern
    return changed


def test_a_shell_outside_any_model_is_read_from_a_file(tmp_path):
    shell = re.search(r"#(\d+) = CLOSED_SHELL", BLOCK).group(1)
    text = swapped(BLOCK, r"#\d+ = MANIFOLD_SOLID_BREP[^;]*;", "")
    text = swapped(text, r"ADVANCED_BREP_SHAPE_REPRESENTATION\('',\(#11,#15\)",
                   f"SHAPE_REPRESENTATION('',(#11,#{shell})")
    path = tmp_path / "part.step"
    path.write_text(text)
    part = ta.load(path)
    assert [(body.kind, body.faces, body.closed) for body in part.bodies] == [("shell", (1, 2, 3, 4, 5, 6), True)]
    assert box_of(part) == box_of(ta.load(EXAMPLES / "saddle.step"))
    assert sum("stands in no solid and no surface model of the file" in warning for warning in part.warnings) == 1


def test_a_face_with_an_absurd_length_is_left_out_of_a_file(tmp_path):
    plane = re.findall(r"#\d+ = PLANE\('',#(\d+)\)", BLOCK)[3]
    point = re.search(rf"#{plane} = AXIS2_PLACEMENT_3D\('',#(\d+)", BLOCK).group(1)
    path = tmp_path / "part.step"
    path.write_text(swapped(BLOCK, rf"(#{point} = CARTESIAN_POINT\('',\()[^,]*", r"\g<1>1.E+30"))
    part, whole = ta.load(path), ta.load(EXAMPLES / "saddle.step")
    (lost,) = {1, 2, 3, 4, 5, 6} - {face.number for face in part.faces}
    assert any(warning.startswith(f"face {lost} (#") and "was left out" in warning for warning in part.warnings)
    for face in part.faces:
        assert face.box == pytest.approx(whole.face(face.number).box, abs=1e-6)


@pytest.mark.parametrize("pattern, new, said", [
    (r"(#17 = [^;]*;)", r"\1\1", "defines entity #17 more than once"),
    (r"SI_UNIT\(\.MILLI\.,\.METRE\.\)", "SI_UNIT(.MILLI.,.FURLONG.)", "declares the length unit MILLI FURLONG in #"),
    (r"(EDGE_LOOP\('',\()#\d+", r"\1#16", "EDGE_LOOP #\\d+ refers to #16, a CLOSED_SHELL and not an ORIENTED_EDGE"),
])
def test_damaged_files_are_refused_before_freecad_reads_them(pattern, new, said, tmp_path):
    path = tmp_path / "part.step"
    path.write_text(swapped(BLOCK, pattern, new))
    with pytest.raises(InvalidInput, match=said):
        ta.load(path)


def test_an_assembly_of_shells_is_read_from_a_file_and_from_a_document(document, shell, tmp_path):
    """What FreeCAD exports of two placed containers, as the library reads it and as FreeCAD imports it again."""
    outer = document.addObject("App::Part", "Outer")
    for name, placement in (("One", TURNED), ("Two", LIFTED)):
        inner = document.addObject("App::Part", name)
        inner.Placement = placement
        inner.addObject(feature(document, shell, f"Shell{name}"))
        outer.addObject(inner)
    document.recompute()
    path = tmp_path / "assembly.step"
    Import.export([outer], str(path))
    places = [[[0, 0, 50], [20, 10, 80]], [[90, 0, 0], [100, 20, 30]]]
    part = ta.load(path)
    assert len(part.faces) == 4 and {body.kind for body in part.bodies} == {"shell"}
    boxes = [np.array([part.face(number).box for number in body.faces]) for body in part.bodies]
    found = [[box[:, 0].min(axis=0).round(6).tolist(), box[:, 1].max(axis=0).round(6).tolist()] for box in boxes]
    assert sorted(found) == places
    again = FreeCAD.newDocument("Again")
    try:
        Import.insert(str(path), again.Name)
        roots = [thing for thing in again.Objects if not thing.InList and hasattr(thing, "Placement")]
        read = ta.load(roots)
        assert len(read.faces) == 4 and box_of(read) == [[0, 0, 0], [100, 20, 80]]
    finally:
        FreeCAD.closeDocument(again.Name)
