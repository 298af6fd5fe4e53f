"""Programs and setup sheets in a plan's folder, by the command."""

import json
import re
import sys
from dataclasses import replace
from math import degrees
from pathlib import Path

import numpy as np
import pytest

sys.path.append(str(Path(__file__).parents[1] / "post"))
from nc_plans import a_plan, axes_at

from toolaxis.cli.main import main
from toolaxis.errors import InvalidInput
from toolaxis.job.files.plan_folder import OF_PLAN, read_plan, stage_folder, write_plan
from toolaxis.job.output.post import post_plan
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.plan.plan import Plan

Capture = pytest.CaptureFixture[str]
ANGLES = np.radians([[30.0, 20.0], [30.0, 20.0], [-45.0, 60.0]])


def plan_at(angles: np.ndarray = ANGLES) -> Plan:
    machine = load_machine("mikron-ucp-710")
    return a_plan(axes_at(machine, angles, np.eye(3)), np.random.default_rng(3))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The folder of a plan of three operations on two orientations."""
    out = tmp_path / "made"
    with stage_folder(out) as stage:
        write_plan(plan_at(), stage.folder)
        stage.publish()
    return out


def test_program_and_sheet_appear(folder: Path, capsys: Capture) -> None:
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert main(["post", str(folder), "--dialect", "heidenhain", "--machine", "mikron-ucp-710", "--json"]) == 0
    out = capsys.readouterr()
    assert json.loads(out.out)["files"] == [str(folder / "program-heidenhain.h"), str(folder / "setup-heidenhain.md")]
    assert "warning: verdict on the operations: not verified yet" in out.err
    assert {path.name for path in folder.iterdir()} == {*before, "program-heidenhain.h", "setup-heidenhain.md"}
    assert all((folder / name).read_bytes() == content for name, content in before.items())
    assert (folder / "program-heidenhain.h").read_text().count("PLANE SPATIAL") == 3


def test_the_plan_s_own_machine_is_taken(tmp_path: Path) -> None:
    """With the part where the plan says that it stands, unless another place is given."""
    where = np.eye(4)
    where[:3, :3], where[:3, 3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]], [5, 6, 200]
    machine = load_machine("mikron-ucp-710")
    plan = replace(a_plan(axes_at(machine, ANGLES, where[:3, :3]), np.random.default_rng(3)),
                   machine=Mounting(machine, where))
    folder = tmp_path / "made"
    with stage_folder(folder) as stage:
        write_plan(plan, stage.folder)
        stage.publish()
    assert main(["post", str(folder), "--dialect", "iso"]) == 0
    assert "G0 C30.000 A20.000" in (folder / "program-iso.nc").read_text()
    assert main(["post", str(folder), "--dialect", "iso", "--offset", "0,0,150"]) == 0
    assert "G0 C30.000 A20.000" not in (folder / "program-iso.nc").read_text()
    assert main(["post", str(folder), "--dialect", "iso", "--machine", "ab-trunnion"]) == 2


def test_the_sheet_holds_what_the_operator_needs(folder: Path) -> None:
    assert main(["post", str(folder), "--dialect", "iso", "--machine", "mikron-ucp-710", "--offset=5,6,200"]) == 0
    text = (folder / "setup-iso.md").read_text()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")]
    first, second = (row for row in rows if row[0] in ("1", "2"))
    assert first[1:3] == ["G54", "C30.000 A20.000"] and second[1:3] == ["G55", "C315.000 A60.000"]
    assert first[3].startswith("C") and "A-20.000" in first[3] and second[3].endswith("(out of range)")
    tool = next(row for row in rows if row[0] == "T1")
    assert tool[2:6] == ["12.000", "1.000", "24.000", "60.000"]
    assert np.allclose([float(v) for v in first[6].split(",")], axes_at(load_machine("mikron-ucp-710"), ANGLES[:1],
                                                                        np.eye(3))[0], atol=1e-6)
    assert "not known" not in first[7] and "| op03-face1 | T1 | 2 | G55 |" in text


def test_apt_needs_no_machine_and_is_what_plan_wrote(folder: Path) -> None:
    before = {path.name: path.read_text() for path in folder.glob("*.apt")}
    assert main(["post", str(folder), "--dialect", "apt"]) == 0
    assert {path.name: path.read_text() for path in folder.glob("*.apt")} == before


def test_a_new_plan_takes_old_programs_away(folder: Path) -> None:
    assert main(["post", str(folder), "--dialect", "fanuc", "--machine", "mikron-ucp-710"]) == 0
    with stage_folder(folder) as stage:
        write_plan(plan_at(ANGLES[:1]), stage.folder)
        stage.publish(OF_PLAN)
    assert not list(folder.glob("program-*")) and not list(folder.glob("setup-*"))


def test_what_was_read_posts_as_what_was_planned(folder: Path) -> None:
    """CL files hold tips to 1e-6 mm, so that a last digit may turn out one higher or lower."""
    mounting = Mounting(load_machine("mikron-ucp-710"))
    read, made = (post_plan(plan, "siemens", mounting)["program-siemens.mpf"]
                  for plan in (read_plan(folder), plan_at()))
    number = re.compile(r"-?\d+\.\d+")
    assert number.sub("#", read) == number.sub("#", made)
    assert np.allclose([float(v) for v in number.findall(read)], [float(v) for v in number.findall(made)], rtol=0,
                       atol=1.1e-5)


def test_clamp_words_stand_around_the_index(folder: Path) -> None:
    assert main(["post", str(folder), "--dialect", "linuxcnc", "--machine", "mikron-ucp-710", "--unclamp", "M64,M66",
                 "--clamp", "M65", "--retract", "480"]) == 0
    lines = (folder / "program-linuxcnc.ngc").read_text().splitlines()
    at = lines.index("G0 C30.00000 A20.00000")
    assert lines[at - 2:at + 2] == ["M64", "M66", "G0 C30.00000 A20.00000", "M65"] and "G53 G0 Z480.000" in lines


@pytest.mark.parametrize("words, said", [
    (["--dialect", "fanuk", "--machine", "mikron-ucp-710"], "dialect 'fanuk' is unknown"),
    (["--dialect", "fanuc"], "give --machine"),
    (["--dialect", "fanuc", "--machine", "nothing"], "'nothing' is neither a file"),
    (["--dialect", "fanuc", "--machine", "three-axes-fixture"], "set by hand"),
    (["--dialect", "fanuc", "--machine", "ab-trunnion"], "beyond the rotary ranges"),
    (["--dialect", "iso", "--machine", "nutating-head"], "serves machines of the kind"),
    (["--dialect", "fanuc", "--machine", "mikron-ucp-710", "--offset", "1,2"], "offset '1,2'"),
    (["--dialect", "fanuc", "--machine", "mikron-ucp-710", "--offset", "2000,0,0"], "would leave its travel"),
    (["--dialect", "iso", "--machine", "mikron-ucp-710", "--clamp", "M1O;"], "clamp word 'M1O;'"),
    (["--dialect", "iso", "--machine", "mikron-ucp-710", "--retract", "nan"], "retract is nan"),
])
def test_wrong_input_is_one_sentence_and_writes_nothing(folder: Path, words: list[str], said: str,
                                                        capsys: Capture) -> None:
    before = sorted(path.name for path in folder.iterdir())
    assert main(["post", str(folder), *words]) == 2
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1
    assert sorted(path.name for path in folder.iterdir()) == before


def test_no_plan_there(tmp_path: Path, capsys: Capture) -> None:
    assert main(["post", str(tmp_path), "--dialect", "fanuc", "--machine", "mikron-ucp-710"]) == 2
    assert "plan.json does not exist" in capsys.readouterr().err


def test_an_axis_between_two_steps_is_refused_with_its_angle() -> None:
    """A fixture that is set in whole degrees, and a plan that was made without it."""
    machine = load_machine("three-axes-fixture")
    angles = np.radians([[10.4, -20.0]])
    plan = a_plan(axes_at(machine, angles, np.eye(3)), np.random.default_rng(3))
    with pytest.raises(InvalidInput, match=r"0\.\d+ deg from the one that the passes were made for") as caught:
        post_plan(plan, "linuxcnc", Mounting(machine))
    away = float(str(caught.value).split("axis ")[1].split()[0])
    assert away == pytest.approx(degrees(np.arccos(1 - (1 - np.cos(np.radians(0.4))) * np.sin(np.radians(20)) ** 2)),
                                 abs=1e-3)
