"""Faces outside solids: shells, sets, assemblies of shells and files of references, wherever a file may hang them."""

import re
from pathlib import Path

import numpy as np
import pytest

from toolaxis.cad import load
from toolaxis.cad.shape_data import ShapeRecord
from toolaxis.cad.step.faces import FaceOrder, number_faces, warn_of_lost_faces
from toolaxis.cad.step.links import plain
from toolaxis.errors import InvalidInput

pytest.importorskip("OCP")
pytestmark = pytest.mark.usefixtures("quick_kernel")
EXAMPLES = Path(__file__).parents[2] / "examples"
SHEET = (EXAMPLES / "hyperbolic_paraboloid.step").read_text()
BLOCK = (EXAMPLES / "saddle.step").read_text()
SHEET_BOX = np.array([[-50, -50, -5], [50, 50, 5]])


def swapped(text, pattern, new):
    changed, count = re.subn(pattern, new, text, count=1, flags=re.S)
    assert count == 1, pattern
    return changed


def number(text, keyword):
    return re.search(rf"#(\d+) = {keyword}\(", text).group(1)


SOLID, SHELL = number(BLOCK, "MANIFOLD_SOLID_BREP"), number(BLOCK, "CLOSED_SHELL")
FACES = re.search(r"CLOSED_SHELL\('',\(([^)]*)\)", BLOCK).group(1)
SOLID_LINE, SHELL_LINE = rf"#{SOLID} = MANIFOLD_SOLID_BREP[^;]*;", rf"#{SHELL} = CLOSED_SHELL[^;]*;"
MODEL = f"#{SOLID} = SHELL_BASED_SURFACE_MODEL('',(#{SHELL}));"
TURNED = f"#900=ORIENTED_CLOSED_SHELL('',*,#{SHELL},.T.);"
PRODUCT = r"#[3-9] = [^;]*;|#\d+ = PRODUCT_RELATED_PRODUCT_CATEGORY[^;]*;"


def instead(new):
    """The block with something else than its solid in the representation."""
    return swapped(BLOCK, SOLID_LINE, new).replace("ADVANCED_BREP_SHAPE_REPRESENTATION", "SHAPE_REPRESENTATION")


def listed(items, *gone):
    """The block with items in its representation and some lines gone."""
    text = swapped(BLOCK, r"ADVANCED_BREP_SHAPE_REPRESENTATION\('',\(#11,#15\)",
                   f"SHAPE_REPRESENTATION('',(#11,{items})")
    for line in gone:
        text = swapped(text, line, "")
    return text


def of_sheet(new):
    """The sheet with something else than a surface model, its shell and its face."""
    return swapped(SHEET.replace("MANIFOLD_SURFACE", "GEOMETRICALLY_BOUNDED_SURFACE"),
                   r"#15 = SHELL_BASED[^;]*;\s*#16 = [^;]*;\s*#17 = [^;]*;", new)


#: Text, kinds of bodies, whether the body is closed, and what is said.
PLACES = {
    "surface model": (instead(MODEL), "shell", True, ""),
    "turned shell": (instead(MODEL.replace(f"(#{SHELL})", "(#900)") + TURNED), "shell", True, ""),
    "set of connected faces": (instead(MODEL.replace("SHELL_", "FACE_")).replace("CLOSED_SHELL", "CONNECTED_FACE_SET"),
                               "shell", True, ""),
    "closed shell in a representation": (listed(f"#{SHELL}", SOLID_LINE), "shell", True, f"1 shell (#{SHELL}) stands"),
    "open shell in a representation": (listed(f"#{SHELL}", SOLID_LINE).replace("CLOSED_SHELL", "OPEN_SHELL"),
                                       "shell", True, f"1 shell (#{SHELL}) stands in no solid"),
    "shell beside its forgotten solid": (listed(f"#{SHELL}"), "shell", True, f"1 shell (#{SHELL}) stands in no solid"),
    "shell beside its solid": (listed(f"#{SOLID},#{SHELL}"), "solid", True, ""),
    "faces in a representation": (listed(FACES, SOLID_LINE, SHELL_LINE), "faces", False, ""),
    "faces in a set": (instead(f"#{SOLID} = GEOMETRIC_SET('',({FACES}));"), "faces", False, "6 faces (#17"),
    "shell in a set": (instead(f"#{SOLID} = GEOMETRIC_SET('',(#{SHELL}));"), "shell", True, f"1 shell (#{SHELL}) st"),
    "solid without a product": (re.sub(PRODUCT, "", BLOCK), "solid", True, "6 faces (#17, "),
    "shell without a product": (re.sub(PRODUCT, "", instead(MODEL)), "shell", True, "stand in no product"),
    "shell in nothing": (re.sub(PRODUCT + rf"|#10 = [^;]*;|{SOLID_LINE}", "", BLOCK), "shell", True, "in no product"),
    "faces in nothing": (re.sub(PRODUCT + rf"|#10 = [^;]*;|{SOLID_LINE}|{SHELL_LINE}", "", BLOCK), "faces", False,
                         "in no product"),
    "other shell beside": (swapped(BLOCK, "ENDSEC;\\s*END-ISO", f"#900=OPEN_SHELL('',({FACES}));\nENDSEC;\nEND-ISO"),
                           "solid", True, ""),
}


def box_of(part):
    return np.array([[face.box for face in part.faces]]).reshape(-1, 2, 3)


@pytest.mark.parametrize("place", PLACES)
def test_faces_are_found_wherever_they_hang(place, tmp_path):
    text, kind, closed, said = PLACES[place]
    whole = load(EXAMPLES / "saddle.step")
    path = tmp_path / "part.step"
    path.write_text(text)
    part = load(path)
    assert [(body.kind, body.faces, body.closed) for body in part.bodies] == [(kind, (1, 2, 3, 4, 5, 6), closed)]
    assert box_of(part) == pytest.approx(box_of(whole), abs=1e-6)
    assert [face.flip for face in part.faces] == [face.flip for face in whole.faces]
    assert {edge.faces for edge in part.edges} == {edge.faces for edge in whole.edges}
    told = [warning for warning in part.warnings if "of the file" in warning]
    assert len(told) == bool(said) and all(said in warning for warning in told)


@pytest.mark.parametrize("text, box", [
    (of_sheet("#15 = GEOMETRIC_SET('',(#32));"), SHEET_BOX),
    (of_sheet("").replace("(#11,#15)", "(#11,#32)"), SHEET_BOX),
    (of_sheet("#15 = GEOMETRIC_SET('',(#900));#900=RECTANGULAR_TRIMMED_SURFACE('',#32,0.25,0.75,0.5,1.,.T.,.T.);"),
     np.array([[-25, 0, -5], [25, 50, 3.75]])),
], ids=["surface in a set", "surface in a representation", "trimmed surface"])
def test_bare_surfaces_are_faces(text, box, tmp_path):
    path = tmp_path / "part.step"
    path.write_text(text)
    part = load(path)
    assert [(body.kind, body.faces) for body in part.bodies] == [("faces", (1,))]
    assert box_of(part)[0, :, :2] == pytest.approx(box[:, :2], abs=1e-6)
    assert part.face(1).kind == "bspline"


def placed(x, y, z, turn):
    from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
    from OCP.TopLoc import TopLoc_Location

    turned, moved = gp_Trsf(), gp_Trsf()
    turned.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), np.radians(turn))
    moved.SetTranslation(gp_Vec(x, y, z))
    return TopLoc_Location(moved.Multiplied(turned))


def write_assembly(path, prefix=None):
    """An assembly that holds another one twice, which holds the sheet twice; with a prefix in several files."""
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPCAFControl import STEPCAFControl_Writer
    from OCP.STEPControl import STEPControl_StepModelType
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDataStd import TDataStd_Name
    from OCP.TDocStd import TDocStd_Document
    from OCP.XCAFApp import XCAFApp_Application
    from OCP.XCAFDoc import XCAFDoc_DocumentTool

    from toolaxis.cad.step.worker import read_shape

    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    sheet = shapes.AddShape(read_shape(str(EXAMPLES / "hyperbolic_paraboloid.step"))[0], False)
    pair, whole = shapes.NewShape(), shapes.NewShape()
    for label, name in ((sheet, "sheet"), (pair, "pair"), (whole, "whole")):
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))
    shapes.AddComponent(pair, sheet, placed(0, 0, 0, 0))
    shapes.AddComponent(pair, sheet, placed(200, 0, 0, 90))
    shapes.AddComponent(whole, pair, placed(0, 0, 50, 0))
    shapes.AddComponent(whole, pair, placed(0, 300, 0, 90))
    shapes.UpdateAssemblies()
    writer = STEPCAFControl_Writer()
    writer.SetNameMode(True)
    writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs, *([prefix] if prefix else []))
    assert writer.Write(str(path)) == IFSelect_ReturnStatus.IFSelect_RetDone
    return path.read_text()


def without_models(text):
    """Shells in their representation instead of in a surface model."""
    model = re.search(r"#(\d+) = SHELL_BASED_SURFACE_MODEL\('',\(#(\d+)\)\);", text)
    return text.replace(model.group(), "").replace(f",#{model.group(1)})", f",#{model.group(2)})")


def as_set(text):
    model = re.search(r"#(\d+) = SHELL_BASED_SURFACE_MODEL\('',\(#(\d+)\)\);", text)
    face = number(text, "ADVANCED_FACE")
    shell = rf"#{model.group(2)} = OPEN_SHELL[^;]*;"
    return swapped(text.replace(model.group(), f"#{model.group(1)} = GEOMETRIC_SET('',(#{face}));"), shell, "")


@pytest.mark.parametrize("change", [lambda text: text, without_models, as_set],
                         ids=["surface models", "bare shells", "sets of faces"])
def test_shells_in_nested_assemblies_stand_where_they_are_placed(change, tmp_path):
    path = tmp_path / "assembly.step"
    path.write_text(change(write_assembly(path)))
    part = load(path)
    assert [face.number for face in part.faces] == [1, 2, 3, 4] and len({body.faces for body in part.bodies}) in (1, 4)
    middles = box_of(part).mean(axis=1)
    assert middles == pytest.approx(np.array([[0, 0, 50], [200, 0, 50], [0, 300, 0], [0, 500, 0]]), abs=1e-6)
    # The saddle is high at its ends in y and low at those in x; a quarter of a turn changes them over.
    along = [face.evaluate(np.array([[0.5, 0.999], [0.5, 0.5]])).point for face in part.faces]
    for points, (x, y) in zip(along, [(0, 1), (-1, 0), (-1, 0), (0, -1)], strict=True):
        away = points[0] - points[1]
        assert away[:2] / np.linalg.norm(away[:2]) == pytest.approx([x, y], abs=1e-6)


def test_a_file_of_references_says_so(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_assembly(tmp_path / "whole.step", "piece_")
    assert (tmp_path / "piece_sheet.stp").exists()
    said = (r"holds no geometry itself: it refers to other files, piece_sheet\.stp; open it in the CAD system and "
            "export everything as one STEP file")
    with pytest.raises(InvalidInput, match=said):
        load(tmp_path / "whole.step")
    assert len(load(tmp_path / "piece_sheet.stp").faces) == 1


def test_geometry_and_references_together_are_told(tmp_path):
    path = tmp_path / "part.step"
    more = ("#900=DOCUMENT_FILE('arm.stp','',$,#901,'',$);#901=DOCUMENT_TYPE('');"
            "#902=DOCUMENT_FILE('note.pdf','',$,#901,'',$);"
            "#903=(CHARACTERIZED_OBJECT('','')DOCUMENT('F\\X2\\00FC\\X0\\hrung.prt','',$,#901)DOCUMENT_FILE());")
    path.write_text(swapped(SHEET, "ENDSEC;\\s*END-ISO", f"{more.replace(chr(92), chr(92) * 2)}\nENDSEC;\nEND-ISO"))
    (told,) = [warning for warning in load(path).warnings if "refers to" in warning]
    assert "also refers to arm.stp, Führung.prt; what stands there is not read" in told


@pytest.mark.parametrize("text, name", [
    (b"plain", "plain"), (b"it''s", "it's"), (b"F\\X2\\00E400DF\\X0\\e", "Fäße"), (b"F\\X\\E4che", "Fäche"),
    (b"F\\S\\dche", "Fäche"), ("Fläche".encode(), "Fläche"), ("Fläche".encode("latin-1"), "Fläche"),
    (b"a\\\\b", "a\\b"),
])
def test_names_are_read_in_every_writing(text, name):
    assert plain(text) == name


def test_references_of_the_third_edition_are_told(tmp_path):
    path = tmp_path / "part.step"
    section = "REFERENCE;\n#901=<arm.stp#a1>;\n#902=<arm.stp#a2>;\n#903=<leg.stp#x>;\nENDSEC;\n"
    text = swapped(SHEET, "DATA;", f"{section}DATA;")
    path.write_text(re.sub(r"#1[5-7] = [^;]*;", "", text).replace("(#11,#15)", "(#11)"))
    with pytest.raises(InvalidInput, match=r"refers to other files, arm\.stp, leg\.stp; open it"):
        load(path)


def test_faces_in_no_product_of_an_assembly_are_refused(tmp_path):
    """Nobody knows where they stand."""
    path = tmp_path / "part.step"
    text = write_assembly(path)
    face = number(text, "ADVANCED_FACE")
    twin = re.search(rf"#{face} = ([^;]*;)", text).group(1)
    path.write_text(swapped(text, "ENDSEC;\\s*END-ISO", f"#900={twin}\nENDSEC;\nEND-ISO"))
    said = r"lost 1 of its 2 faces in transfer \(#900 stands in no product of the file\)"
    with pytest.raises(InvalidInput, match=said):
        load(path)


def test_helping_geometry_is_not_missed(tmp_path):
    """What only helped to construct the part is no face of it."""
    path = tmp_path / "part.step"
    face = re.search(r"#17 = ([^;]*;)", SHEET).group(1)
    more = f"#900={face}#901=CONSTRUCTIVE_GEOMETRY_REPRESENTATION('',(#900),#94);"
    path.write_text(swapped(SHEET, "ENDSEC;\\s*END-ISO", f"{more}\nENDSEC;\nEND-ISO"))
    assert len(load(path).faces) == 1


@pytest.mark.parametrize("lists, origins, made, missing", [
    (((5, 6, 7),), [5, 6, 7], [1, 2, 3], {}),
    (((5, 6, 7),), [5, 7], [1, 3], {6: 2}),
    (((5, 6, 7),), [7, 5], [3, 1], {6: 2}),
    (((5, 6), (7, 8)), [8, 5, 6], [2, 3, 4], {7: 1}),
    (((5, 6), (7, 8)), [6, 7, 8], [2, 3, 4], {5: 1}),
    (((5, 6), (7, 8)), [5, 6], [1, 2], {7: 3, 8: 4}),
    (((5, 6, 7),), [5, 7, 5, 7], [1, 3, 4, 6], {6: 2}),
    (((5, 6, 7),), [0, 7], [1, 2], {}),
    (((5, 6),), [5, 9], [1, 3], {6: 2}),
])
def test_faces_have_the_numbers_of_the_whole_file(lists, origins, made, missing):
    found = number_faces(FaceOrder((), lists), origins)
    assert (found.made, found.missing) == (made, missing)


@pytest.mark.parametrize("copies, origins, split", [
    ([1, 2, 3], [5, 6, 7], {}), ([1, 2, 1, 2], [5, 6, 5, 6], {}), ([1, 2, 3], [5, 6, 6], {6: 2}), ([1, 2], [0, 0], {}),
])
def test_faces_that_the_kernel_has_split_are_found(copies, origins, split):
    order = FaceOrder((), ((5, 6, 7),))
    found = warn_of_lost_faces(ShapeRecord(), copies, order, number_faces(order, origins), origins)
    assert found.split == split and found.distinct == len(set(copies))


def test_surfaces_that_nothing_uses_are_told(tmp_path):
    path = tmp_path / "part.step"
    path.write_text(of_sheet("").replace("(#11,#15)", "(#11)"))
    said = "holds no faces with exact geometry but curves and surfaces that no face uses"
    with pytest.raises(InvalidInput, match=said):
        load(path)


def test_a_mended_file_can_be_exported_with_its_part(tmp_path):
    from types import SimpleNamespace

    from toolaxis.cad.ocp.reader import face_map
    from toolaxis.job.output.export import _part_shape

    path = tmp_path / "part.step"
    path.write_bytes(listed(f"#{SHELL}", SOLID_LINE).encode("utf-16"))
    shape = _part_shape(SimpleNamespace(part=load(path)))
    assert face_map(shape).Extent() == 6
