"""`toolaxis post FILE`: CL data that were made elsewhere, written as APT files and as programs."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cli.main import main

CL = "UNITS/INCHES\nMULTAX/ON\nRAPID\nGOTO/0,0,1,0,0,1\nFEDRAT/10,IPM\nGOTO/0,0,0,0,0.6,0.8\nGOTO/1,0,0\nFINI\n"
NC = "%\nO1\nG21 G90 G94 G54\nS8000 M3\nG0 A0. C0.\nG43.4 H1\nG1 X0. Y0. Z0. F500.\nX1. A10. C90.\nG49\nM30\n%\n"


def test_an_apt_file_is_written_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "made.apt"
    file.write_text(CL)
    assert main(["post", str(file), "--dialect", "apt", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["points"] == 3 and file.read_text() == CL
    one, other = ta.read_cl(file), ta.read_cl(told["files"][0])
    assert np.allclose(one.tip, other.tip, atol=1e-6) and np.allclose(one.axis, other.axis, atol=1e-9)
    assert other.feedrate.tolist() == [np.inf, 254.0, 254.0]


def test_a_program_becomes_an_apt_file(tmp_path: Path) -> None:
    file = tmp_path / "made.nc"
    file.write_text(NC)
    assert main(["post", str(file), "--dialect", "apt", "--machine", "mikron-ucp-710"]) == 0
    found = ta.read_cl(tmp_path / "made.apt")
    machine = ta.load_machine("mikron-ucp-710")
    assert np.allclose(found.axis, ta.read_cl(file, machine).axis, atol=1e-9) and found.spindle == 8000.0
    assert found.axis[1] == pytest.approx([np.sin(np.radians(10)), 0.0, np.cos(np.radians(10))], abs=1e-9)


@pytest.mark.parametrize("machine", ["mikron-ucp-710", "head-head-portal"])
@pytest.mark.parametrize("dialect", ["fanuc", "siemens", "heidenhain"])
def test_cl_data_become_programs_that_read_back_as_the_same(dialect: str, machine: str, tmp_path: Path,
                                                           capsys: pytest.CaptureFixture[str]) -> None:
    """Tips, axes, rapid motions and feed rates, whatever machine the data were for."""
    file = tmp_path / "made.nc"
    file.write_text(NC.replace("X1. A10. C90.", "X1. A10. C90.\nG0 X3. Y2.\nG1 Z-1. A12. F200."))
    words = ["--dialect", dialect, "--machine", machine, "--source", "mikron-ucp-710", "--retract", "400", "--json"]
    assert main(["post", str(file), *words]) == 0
    program, sheet = (Path(name) for name in json.loads(capsys.readouterr().out)["files"])
    assert "made elsewhere" in sheet.read_text() and "mm/min" not in program.read_text()
    one, other = ta.read_cl(file, "mikron-ucp-710"), ta.read_cl(program, machine)
    at = [int(np.argmin(np.linalg.norm(other.tip - tip, axis=1) + np.linalg.norm(other.axis - axis, axis=1)))
          for tip, axis in zip(one.tip, one.axis, strict=True)]
    assert at == sorted(set(at)) and other.spindle == 8000.0
    assert np.allclose(other.tip[at], one.tip, atol=6e-4) and np.allclose(other.axis[at], one.axis, atol=2e-5)
    wanted = np.where(one.kind == 3, 10000.0, one.feedrate)
    assert np.allclose(other.feedrate[at][1:], wanted[1:]) and one.feedrate[-1] == 200.0


def test_told_rates_take_the_place_of_those_of_the_file(tmp_path: Path) -> None:
    file = tmp_path / "made.apt"
    file.write_text(CL)
    assert main(["post", str(file), "--dialect", "heidenhain", "--machine", "mikron-ucp-710", "--spindle", "9000",
                 "--feedrate", "700"]) == 0
    found = ta.read_cl(tmp_path / "made-heidenhain.h", "mikron-ucp-710")
    assert found.spindle == 9000.0 and set(found.feedrate[1:]) == {700.0}


@pytest.mark.parametrize(("text", "words", "said"), [
    (NC, ["--dialect", "apt"], "name the machine"),
    (NC.replace("M30", ""), ["--dialect", "apt", "--machine", "mikron-ucp-710"], "line 11 .*cut short"),
    (CL, ["--dialect", "fanuc"], "writes rotary angles: give --machine"),
    (CL, ["--dialect", "fanuc", "--machine", "mikron-ucp-710"], "tells no spindle speed: give --spindle"),
    (CL.replace("FEDRAT/10,IPM\n", ""), ["--dialect", "siemens", "--machine", "mikron-ucp-710", "--spindle", "9000"],
     "no feed rate for the motion to point 1: give --feedrate"),
    (NC, ["--dialect", "linuxcnc", "--machine", "mikron-ucp-710"], "dialect linuxcnc has no tool centre point control"),
    (CL, ["--dialect", "fanuc", "--machine", "three-axes-fixture", "--spindle", "9000"], "drives 0 rotary axes"),
    (CL.replace("INCHES", "FEET"), ["--dialect", "apt"], "line 1: UNITS/FEET")])
def test_what_cannot_be_written_is_refused_in_a_sentence(text: str, words: list[str], said: str, tmp_path: Path,
                                                         capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "made.txt"
    file.write_text(text)
    assert main(["post", str(file), *words]) == 2
    assert re.search(said, capsys.readouterr().err)
