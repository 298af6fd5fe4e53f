"""What comes through FreeCAD against what comes without it for the same STEP file: figures of faces, and plan.json."""

import importlib.util
import json
import os
from contextlib import contextmanager
from pathlib import Path

import FreeCAD
import Part as FreecadPart
import pytest

import toolaxis as ta
from toolaxis.job.files.plan_folder import write_plan
from toolaxis.plan.document import tool_from
from toolaxis.search.fixed_axis import evaluate_axis
from toolaxis.shape.kinks import split_at_kinks

FOLDER = Path(__file__).resolve().parents[2] / os.environ.get("TOOLAXIS_PREPARED", "out/freecad/same_plan")
NAMES = sorted(path.parent.name for path in FOLDER.glob("*/plan.json"))
WRITTEN = json.loads((FOLDER / "figures.json").read_text()) if (FOLDER / "figures.json").exists() else {}
FIGURES = ("count", "length", "average_strip_width", "gouge", "unreached")


@pytest.fixture(scope="module", params=NAMES or [pytest.param(None, marks=pytest.mark.skip(reason="not prepared"))])
def name(request, prepared):
    return request.param


@pytest.fixture(scope="module")
def commands(name):
    """The command's plan.json."""
    return json.loads((FOLDER / name / "plan.json").read_text())


@contextmanager
def imported(name):
    """The part as an object of a document."""
    document = FreeCAD.newDocument("Plan")
    made = document.addObject("Part::Feature", "Imported")
    made.Shape = FreecadPart.read(str(FOLDER / f"{name}.step"))
    document.recompute()
    yield made
    FreeCAD.closeDocument(document.Name)


@pytest.fixture(scope="module")
def thing(name):
    with imported(name) as made:
        yield made


@pytest.fixture(scope="module")
def evaluated():
    spec = importlib.util.spec_from_file_location("evaluation", Path(__file__).with_name("evaluation.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.evaluated


@pytest.fixture(scope="module")
def part(thing):
    return ta.load(thing)


@pytest.fixture(scope="module")
def again(thing, commands, tmp_path_factory):
    """plan.json made through FreeCAD with the command's inputs."""
    scallop, folder = commands["inputs"]["scallop"], tmp_path_factory.mktemp("plan")
    faces = sorted({op["face"] for op in commands["operations"]})
    write_plan(ta.plan(thing, tool_from(commands["tools"][0]), scallop, faces=faces), folder)
    return json.loads((folder / "plan.json").read_text())


@pytest.mark.parametrize("written", WRITTEN or [pytest.param(None, marks=pytest.mark.skip(reason="not prepared"))])
def test_faces_have_the_same_figures(written, evaluated):
    """Widths, gouges, clearances, counts and lengths to 1e-6; passes within 0.1 %."""
    theirs = WRITTEN[written]
    with imported(written) as thing:
        part = ta.load(thing)
        for number, figures in theirs["faces"].items():
            ours = evaluated(part, int(number), theirs["tool"], theirs["scallop"])
            for figure, values in figures.items():
                share = 1e-3 if figure == "passes" else 1e-6
                assert ours[figure] == pytest.approx(values, rel=share, abs=1e-6), (number, figure)


def test_the_command_found_an_axis(commands):
    assert commands["outcome"] == "complete"


def test_the_same_axis_comes_to_the_same(commands, part):
    """Figures to 1e-6, passes within 0.1 %."""
    for op in commands["operations"]:
        theirs = op["orientation"]
        if theirs["axis"] is None:
            continue
        face = next(piece for piece in split_at_kinks(part.face(op["face"])) if piece.label == op["label"])
        ours = evaluate_axis(face, tool_from(commands["tools"][0]), theirs["axis"], commands["inputs"]["scallop"],
                             part=part, feed=theirs["feed"])
        assert ours.outcome == theirs["outcome"]
        assert ours.passes == pytest.approx(theirs["passes"], rel=1e-3)
        for figure in FIGURES:
            assert getattr(ours, figure) == pytest.approx(theirs[figure], rel=1e-6, abs=1e-9), figure
        for member, distance in theirs["clearance"].items():
            assert ours.clearance[member] == pytest.approx(distance, rel=1e-6), member


def test_the_search_through_freecad_comes_to_the_same_plan(commands, again):
    assert again["outcome"] == commands["outcome"]
    assert again["units"] == commands["units"]
    assert again["inputs"] == commands["inputs"]
    for ours, theirs in zip(again["operations"], commands["operations"], strict=True):
        assert (ours["face"], ours["label"], ours["kind"]) == (theirs["face"], theirs["label"], theirs["kind"])
        assert ours["area"] == pytest.approx(theirs["area"], rel=1e-9)
        assert ours["orientation"]["outcome"] == theirs["orientation"]["outcome"]
        assert ours["orientation"]["axis"] == pytest.approx(theirs["orientation"]["axis"], abs=1e-6)
        assert ours["orientation"]["length"] == pytest.approx(theirs["orientation"]["length"], rel=1e-6)
        assert ours["travel"] == pytest.approx(theirs["travel"], rel=1e-6)


def test_a_division_comes_to_the_same_through_the_document(prepared):
    """Sub-surfaces in the tree against the command's: labels, axes and lengths."""
    from freecad.toolaxis.services import api

    theirs = json.loads((FOLDER / "divided" / "out" / "plan.json").read_text())
    asked = theirs["inputs"]
    with imported("freeform") as thing:
        made = api.plan(thing.Document, (thing, theirs["operations"][0]["face"]), theirs["tools"][0]["name"],
                           asked["scallop"], regions=2, method=asked["method"], shank=None, holder=None,
                           feedrate=asked["feedrate"])
        assert len(made) == len(theirs["operations"]) == 2
        for ours, op in zip(made, theirs["operations"], strict=True):
            assert json.loads(ours.Details)["label"] == op["label"]
            assert tuple(ours.Axis) == pytest.approx(op["orientation"]["axis"], abs=1e-6)
            assert ours.Passes == op["orientation"]["passes"]
            assert ours.CuttingLength.Value == pytest.approx(op["orientation"]["length"], rel=1e-6)
            assert ours.LeftToCleanUp == pytest.approx(op["orientation"]["unreached"], abs=1e-9)
