"""Plans for other programs: STEP with names, colours and placements, and glTF that trimesh opens."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from toolaxis.cli.main import main
from toolaxis.errors import InvalidInput, MissingBackend
from toolaxis.job.files.plan_folder import read_plan, write_json
from toolaxis.job.files.verdict_maps import read_views, write_views
from toolaxis.job.output.export import export, to_trimesh
from toolaxis.job.output.verify import verdict_document, verify_plan
from toolaxis.plan.plan import Plan
from toolaxis.report.figures.map_colouring import colours_of
from toolaxis.verify.verdict import Verdict

trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed")


@pytest.fixture(scope="module")
def verdict(small_plan: Plan) -> Verdict:
    return verify_plan(small_plan)


@pytest.fixture
def judged(folder: Path, verdict: Verdict) -> Path:
    plan = read_plan(folder)
    write_json(verdict_document(plan, verdict), folder / "verdict.json")
    write_views(plan, verdict, folder)
    return folder


def shapes_of(path: Path) -> dict[str, tuple[Any, np.ndarray, tuple[float, ...] | None]]:
    """Named components of a STEP file: kernel shape in place, its placement, its colour or that of its first part."""
    from OCP.Quantity import Quantity_Color
    from OCP.STEPCAFControl import STEPCAFControl_Reader
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDataStd import TDataStd_Name
    from OCP.TDF import TDF_Label
    from OCP.TDocStd import TDocStd_Document
    from OCP.TopLoc import TopLoc_Location
    from OCP.XCAFApp import XCAFApp_Application
    from OCP.XCAFDoc import XCAFDoc_ColorTool, XCAFDoc_ColorType, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

    from toolaxis.cad.ocp.kernel_names import LabelSequence

    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    reader.ReadFile(str(path))
    reader.Transfer(document)
    found: dict[str, Any] = {}

    def listed(fill: Any) -> list[Any]:
        labels = LabelSequence()
        fill(labels)
        return [labels.Value(k + 1) for k in range(labels.Length())]

    def coloured(label: Any) -> tuple[float, ...] | None:
        one = Quantity_Color()
        for kind in (XCAFDoc_ColorType.XCAFDoc_ColorGen, XCAFDoc_ColorType.XCAFDoc_ColorSurf,
                     XCAFDoc_ColorType.XCAFDoc_ColorCurv):
            if XCAFDoc_ColorTool.GetColor_s(label, kind, one):
                return tuple(float(v) ** (1 / 2.2) for v in (one.Red(), one.Green(), one.Blue()))
        return None

    def walked(label: Any, above: Any) -> None:
        own = TDF_Label()
        referred = own if XCAFDoc_ShapeTool.GetReferredShape_s(label, own) else label
        place = above.Multiplied(XCAFDoc_ShapeTool.GetLocation_s(label))
        text = TDataStd_Name()
        assert label.FindAttribute(TDataStd_Name.GetID_s(), text)
        turn = place.Transformation()
        matrix = np.array([[turn.Value(i, j) for j in range(1, 5)] for i in range(1, 4)])
        parts = [] if XCAFDoc_ShapeTool.IsAssembly_s(referred) else listed(
            lambda seq: XCAFDoc_ShapeTool.GetSubShapes_s(referred, seq))
        colour = next((one for one in map(coloured, [label, referred, *parts[:1]]) if one), None)
        found[text.Get().ToExtString()] = (XCAFDoc_ShapeTool.GetShape_s(referred).Moved(place), matrix, colour)
        if XCAFDoc_ShapeTool.IsAssembly_s(referred):
            for below in listed(lambda seq: XCAFDoc_ShapeTool.GetComponents_s(referred, seq, False)):
                walked(below, place)

    for top in listed(lambda seq: XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(seq)):
        walked(top, TopLoc_Location())
    return found


def lengths(shape: Any) -> float:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    made = GProp_GProps()
    BRepGProp.LinearProperties_s(shape, made)
    return float(made.Mass())


def test_a_step_file_has_sub_surfaces_as_faces_and_work_coordinate_systems_as_named_placements(
        folder: Path, small_plan: Plan, capfd: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("OCP")
    assert main(["export", str(folder), "--json"]) == 0
    said = capfd.readouterr()
    assert json.loads(said.out)["file"] == str(folder / "plan.step")  # nothing of the kernel's on standard output
    plan = read_plan(folder)
    found = shapes_of(folder / "plan.step")
    (op,) = plan.operations
    path = small_plan.operations[0].path  # it knows its contacts, which the folder's CL file does not hold
    assert op.frame is not None and path is not None
    assert list(found) == ["plan", "part", op.name, f"{op.name}-surface", f"{op.name}-passes"]
    assert found[op.name][1] == pytest.approx(op.frame.part_from_work[:3], abs=1e-9)
    from toolaxis.cad.load import load

    (face,) = load(found[f"{op.name}-surface"][0]).faces
    assert face.area == pytest.approx(op.face.area, rel=1e-5)
    assert face.box == pytest.approx(op.face.box, abs=1e-5)
    colour = found[f"{op.name}-surface"][2]
    assert colour is not None and colour == pytest.approx(colours_of(plan)[op.number], abs=0.03)
    cut = np.linalg.norm(np.diff(path.cc, axis=0), axis=1)[path.kind[1:] == 0].sum()
    assert lengths(found[f"{op.name}-passes"][0]) == pytest.approx(cut, rel=1e-3)  # the kernel's rule at corners


def test_gltf_opens_in_trimesh_with_names_placements_and_colours(small_plan: Plan, tmp_path: Path) -> None:
    path = export(small_plan, tmp_path / "plan.glb")
    scene = trimesh.load(path, process=False)
    (op,) = small_plan.operations
    assert op.frame is not None and op.path is not None
    assert set(scene.graph.nodes_geometry) == {op.name, f"{op.name}-surface"}
    surface = scene.geometry[f"{op.name}-surface"]
    assert surface.area == pytest.approx(op.face.area, rel=1e-3)
    assert surface.visual.vertex_colors[:, :3] == pytest.approx(
        np.tile(255 * np.array(colours_of(small_plan)[op.number]), (len(surface.vertices), 1)), abs=1)
    placed, _ = scene.graph[op.name]
    up = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    assert placed[:3, :3] == pytest.approx(1e-3 * up @ op.frame.part_from_work[:3, :3], abs=1e-9)
    lines = scene.geometry[op.name]
    pairs = lines.vertices.reshape(-1, 2, 3)  # glTF has lines as pairs
    cut = np.linalg.norm(np.diff(op.path.cc, axis=0), axis=1)[op.path.kind[1:] == 0].sum()
    assert np.linalg.norm(pairs[:, 1] - pairs[:, 0], axis=1).sum() == pytest.approx(cut, rel=1e-5)
    metres = op.face.evaluate(op.face.outline[0]).point @ up.T / 1000
    assert (scene.bounds[0] <= metres.min(axis=0) + 1e-6).all() and (scene.bounds[1] >= metres.max(axis=0) - 1e-6).all()
    assert export(small_plan, tmp_path / "again.glb").read_bytes() == path.read_bytes()


def test_a_map_is_in_the_colours_and_its_values_are_those_of_the_judge(judged: Path, small_plan: Plan,
                                                                      verdict: Verdict, tmp_path: Path) -> None:
    (op,) = small_plan.operations
    scene = trimesh.load(export(judged, tmp_path / "scallop.glb", colour="scallop"), process=False)
    mesh = scene.geometry[f"{op.name}-surface"]
    values = mesh.vertex_attributes["_SCALLOP"].ravel()
    view = read_views(judged)[op.name]
    known = view.scallop[np.isfinite(view.scallop)]
    assert len(values) > 500 and np.isin(values.astype(np.float32), [*known, np.float32(-1)]).all()
    assert values.max() > 0.9 * known.max()
    own = to_trimesh(small_plan, colour="scallop", verdict=verdict).geometry[f"{op.name}-surface"]
    assert own.vertex_attributes["_SCALLOP"] == pytest.approx(values)
    low, high = np.argmin(np.where(values < 0, np.inf, values)), np.argmax(values)
    shades = mesh.visual.vertex_colors[:, :3].astype(float)
    assert shades[low].sum() < shades[high].sum()  # dark where little is left


def test_what_stands_in_the_way_of_a_file_is_told_and_nothing_is_written(folder: Path, tmp_path: Path,
                                                                        monkeypatch: pytest.MonkeyPatch) -> None:
    for name, colour, said in (("plan.obj", "sub-surface", r"ends in '.obj': use .step or .glb"),
                               ("plan.step", "scallop", "is for glTF only"),
                               ("plan.glb", "height", "use sub-surface, scallop or gouge"),
                               ("plan.glb", "scallop", "needs the maps of Verify: verify the plan first")):
        with pytest.raises(InvalidInput, match=said):
            export(folder, tmp_path / "out" / name, colour=colour)
    with pytest.raises(InvalidInput, match="is a folder"):
        (tmp_path / "a.glb").mkdir()
        export(folder, tmp_path / "a.glb")
    monkeypatch.setitem(__import__("sys").modules, "toolaxis.report.figures.mesh_scene", None)
    with pytest.raises(MissingBackend, match=r"pip install 'toolaxis\[mesh\]'"):
        export(folder, tmp_path / "out" / "plan.glb")
    assert not (tmp_path / "out").exists()
