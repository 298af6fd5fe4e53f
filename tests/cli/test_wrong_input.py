"""Wrong input: one sentence on stderr, exit code 2, nothing written."""

from pathlib import Path

import numpy as np
import pytest

from toolaxis.cli.main import main

PATCH = "patch.json"


def run(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    try:
        code = main(words)
    except SystemExit as left:
        code = int(left.code or 0)
    out, err = capsys.readouterr()
    return code, out, err


@pytest.fixture(scope="module")
def parts(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with STEP files: a freeform sheet, a plain box, and broken ones."""
    cadquery = pytest.importorskip("cadquery")
    folder = tmp_path_factory.mktemp("parts")
    x, y = np.linspace(0, 24, 5), np.linspace(0, 18, 5)
    rows = [[cadquery.Vector(a, b, np.sin(a / 9) * np.cos(b / 11)) for b in y] for a in x]
    sheet = cadquery.Face.makeSplineApprox(rows, tol=1e-3, minDeg=3, maxDeg=3)
    cadquery.exporters.export(cadquery.Workplane(obj=sheet), str(folder / "sheet.step"))
    cadquery.exporters.export(cadquery.Workplane("XY").box(30, 20, 10), str(folder / "box.step"))
    whole = (folder / "sheet.step").read_text()
    (folder / "empty.step").write_text("")
    (folder / "cut.step").write_text(whole[:len(whole) // 2])
    (folder / "text.step").write_text("this is no STEP file\n" * 50)
    (folder / "folder.step").mkdir()
    return folder


GOOD = {"--tool": "torus:12x1", "--scallop": "0.02"}


@pytest.mark.parametrize("part, change, said", [
    ("sheet.step", {"--faces": "9"}, "face 9 does not exist: the part has 1 faces"),
    ("sheet.step", {"--faces": "0"}, "face 0 does not exist"),
    ("sheet.step", {"--faces": "3-1"}, "faces '3-1' is not understood"),
    ("sheet.step", {"--faces": "1,"}, "faces '1,' is not understood"),
    ("sheet.step", {"--faces": "x"}, r"write 3,5-8, 3\+4 to join faces, all or skins"),
    ("sheet.step", {"--faces": "1+2"}, "face 2 does not exist"),
    ("sheet.step", {"--faces": "1+1"}, "face 1 is to be joined with itself: name each face once"),
    ("sheet.step", {"--faces": "1-99999999"}, "out of range"),
    ("box.step", {}, "none of the part's 6 faces is sculptured"),
    ("sheet.step", {"--tool": "torus:12x7"}, "corner radius is 7"),
    ("sheet.step", {"--tool": "torus:12x-1"}, "corner radius is -1"),
    ("sheet.step", {"--tool": "ball:0"}, "diameter is 0"),
    ("sheet.step", {"--tool": "ball:-8"}, "diameter is -8"),
    ("sheet.step", {"--tool": "drill:8"}, "nor one of the tools"),
    ("sheet.step", {"--holder": "-1,0;-1,40", "--stickout": "40"}, "thinner than nothing"),
    ("sheet.step", {"--holder": "10,0;10,40"}, "without a stick-out"),
    ("sheet.step", {"--holder": "10;0", "--stickout": "40"}, "neither a file nor rows"),
    ("sheet.step", {"--stickout": "-5"}, "stick-out is -5"),
    ("sheet.step", {"--scallop": "0"}, "scallop is 0"),
    ("sheet.step", {"--scallop": "-0.02"}, "scallop is -0.02"),
    ("sheet.step", {"--scallop": "nan"}, "scallop is nan"),
    ("sheet.step", {"--scallop": "6"}, "not below the cutter radius 6"),
    ("sheet.step", {"--scallop": "fine"}, "invalid float value"),
    ("sheet.step", {"--held": "z"}, "clamped side 'z' is not understood: write z<12.5"),
    ("sheet.step", {"--held": "z<nan"}, "clamped side 'z<nan' is not understood"),
    ("sheet.step", {"--held": "plane:0,0,1,0,0,0"}, "clamped side 'plane:0,0,1,0,0,0' is not understood"),
    ("sheet.step", {"--held": "z<100"}, "all chosen faces lie in the clamped side"),
    ("sheet.step", {"--avoid": "1"}, "all sculptured faces of the part are to be avoided"),
    ("sheet.step", {"--avoid": "1", "--faces": "all"}, "all 1 faces of the part are to be avoided"),
    ("sheet.step", {"--avoid": "1", "--faces": "1"}, "face 1 is to be machined and to be avoided"),
    ("sheet.step", {"--avoid": "7"}, "face 7 does not exist"),
    ("sheet.step", {"--avoid": "1+2"}, r"faces to be avoided '1\+2' are not understood"),
    ("sheet.step", {"--avoid": "skins"}, "faces to be avoided 'skins' are not understood"),
    ("sheet.step", {"--allowance": "-1"}, "allowance is -1"),
    ("sheet.step", {"--stock": "-1"}, "stock is -1.0 mm: it must be zero or more"),
    ("sheet.step", {"--stock": "nan"}, "stock is nan mm: it must be zero or more"),
    ("sheet.step", {"--stock": "51"}, "stock is 51.0 mm: .* at most 50 mm"),
    ("sheet.step", {"--stock": "0.1", "--allowance": "0.3"}, "stock is 0.1 mm, below the allowance of 0.3 mm"),
    ("sheet.step", {"--clearances": "0.1,0.5"}, "clearances '0.1,0.5' are not understood: give three lengths in mm"),
    ("sheet.step", {"--clearances": "0.1,high,1"}, "clearances '0.1,high,1' are not understood"),
    ("sheet.step", {"--clearances": "0.1,-0.5,1"}, "tolerance shank_clearance is -0.5: it must be a finite positive"),
    ("sheet.step", {"--least-lean": "-3"}, "least lean is -3 deg: it must be a number from 0 to below 90 deg"),
    ("sheet.step", {"--least-lean": "90"}, "least lean is 90 deg: it must be"),
    ("sheet.step", {"--least-lean": "5", "--tool": "torus:12x1"}, "no ball end is among the tools .torus:12x1."),
    ("sheet.step", {"--greatest-step-over": "-1"}, "greatest step-over is -1.0 mm: it must be finite and above zero"),
    ("sheet.step", {"--greatest-step-over": "0.01"}, "is 0.01 mm, below the scallop height of 0.02 mm: give"),
    ("sheet.step", {"--greatest-step-over": "1", "--strategy": "two-point"}, "lays its passes by a rule of its own"),
    ("sheet.step", {"--allowance-on": "1"}, "allowance on faces '1' is not understood: write numbers and a length"),
    ("sheet.step", {"--allowance-on": "1=-0.1"}, "allowance on face 1 is -0.1 mm: it must be zero or more"),
    ("sheet.step", {"--allowance-on": "7=0.1"}, "face 7 is to keep an allowance and is not in the part"),
    ("sheet.step", {"--lead": "-1"}, "radius of lead-in and lead-out is -1.0 mm: it must be zero .none. or more"),
    ("sheet.step", {"--feedrate": "0"}, "feedrate is 0"),
    ("sheet.step", {"--limits": "cone:0,0,0,10"}, "direction"),
    ("sheet.step", {"--limits": "sphere"}, "limits 'sphere' are not understood"),
    ("sheet.step", {"--direction": "sideways"}, "invalid choice"),
    ("sheet.step", {"--machine": "mill"}, "machine .mill. is neither a file nor one of the library"),
    ("sheet.step", {"--offset": "1,2"}, "offset .1,2. is none"),
    ("sheet.step", {"--offset": "1,2,3"}, "without a machine: name the machine too"),
    ("sheet.step", {"--regions": "0"}, "number of sub-surfaces is 0: it must be a whole number from 1 to 16"),
    ("sheet.step", {"--regions": "few"}, "--regions.*few"),
    ("sheet.step", {"--orientations": "0"}, "number of orientations is 0: it must be a whole number from 1 to 16"),
    ("sheet.step", {"--strategy": "five-axis"}, "strategy .five-axis. is unknown: use indexed, sturz"),
    ("sheet.step", {"--obstacles": "nowhere.step"}, "nowhere.step"),
    ("missing.step", {}, "missing.step"),
    ("empty.step", {}, "empty"),
    ("cut.step", {}, "cut.step"),
    ("text.step", {}, "text.step"),
    ("folder.step", {}, "folder.step"),
])
def test_plan_refuses_in_one_sentence_and_writes_nothing(parts: Path, tmp_path: Path,
                                                         capsys: pytest.CaptureFixture[str], part: str,
                                                         change: dict[str, str], said: str) -> None:
    import re

    options = [word for pair in {**GOOD, **change}.items() for word in ("=".join(pair),)]
    code, out, err = run(capsys, "plan", str(parts / part), *options, "--out", str(tmp_path / "new" / "out"))
    assert code == 2
    assert out == ""
    sentences = [line for line in err.splitlines() if line.startswith("toolaxis")]
    assert len(sentences) == 1 and re.search(said, sentences[0]), err
    assert "Traceback" not in err
    assert list(tmp_path.iterdir()) == [], "something was left behind"


@pytest.mark.parametrize("words, said", [
    ([], "required"), (["nothing"], "invalid choice"), (["plan"], "required"),
    (["plan", "x.step", "--tool", "ball:8", "--scallop"], "--scallop"), (["inspect"], "required"),
    (["verify"], "required"),
    (["inspect", "nowhere.step"], "nowhere.step"), (["verify", "nowhere"], "nowhere"),
    (["plan", "x.step", "--tool", "ball:8", "--scallop", "0.01", "--colour"], "unrecognized arguments: --colour"),
])
def test_words_that_make_no_command(capsys: pytest.CaptureFixture[str], words: list[str], said: str) -> None:
    code, out, err = run(capsys, *words)
    assert code == 2 and out == ""
    assert len(err.splitlines()) == 1 and said in err


@pytest.mark.parametrize("place", ["file/out", "/proc/out"])
def test_an_output_folder_that_cannot_be_written_is_refused_before_computing(
        parts: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch,
        place: str) -> None:
    import toolaxis.job.planning.pipeline

    monkeypatch.setattr(toolaxis.job.planning.pipeline, "load", lambda *_: pytest.fail("the part was read"))
    (tmp_path / "file").write_text("x")
    target = tmp_path / place
    code, _, err = run(capsys, "plan", str(parts / "sheet.step"), "--tool=ball:8", "--scallop=0.01",
                       "--out", str(target))
    assert code == 2
    assert "output folder" in err and "Traceback" not in err and len(err.splitlines()) == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file"]


def test_an_output_folder_that_is_a_file_is_refused(parts: Path, tmp_path: Path,
                                                    capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "out").write_text("mine")
    code, _, err = run(capsys, "plan", str(parts / "sheet.step"), "--tool=ball:8", "--scallop=0.01",
                       "--out", str(tmp_path / "out"))
    assert code == 2 and "is a file" in err
    assert (tmp_path / "out").read_text() == "mine"


def test_help_and_version(capsys: pytest.CaptureFixture[str]) -> None:
    for words in (["--help"], ["plan", "--help"], ["inspect", "--help"], ["verify", "--help"]):
        code, out, err = run(capsys, *words)
        assert code == 0 and "usage: toolaxis" in out and err == ""
    assert run(capsys, "--version")[1] == "toolaxis 0.1.0\n"
