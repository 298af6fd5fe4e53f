"""What a user chooses by name is planned so, passes the judge, and is refused in one sentence where it does not fit."""

import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion
from toolaxis.cli.main import main
from toolaxis.job.files.contacts_from_cl import widths_along, with_contacts
from toolaxis.job.files.plan_folder import read_plan

Capture = pytest.CaptureFixture[str]
WIDE = ("--tool=torus:12x1", "--scallop=0.1", "--limits=cone:0,0,1,60", "--faces=1", "--no-pictures")
#: Few axes to choose from, where the choice of the axis is not what is looked at.
FAST = (*WIDE, "--limits=cone:0,0,1,8")
MACHINE = "--machine=mikron-ucp-710"


def _document(out: Path) -> dict:
    return json.loads((out / "plan.json").read_text())


def test_the_axis_of_most_jerk_is_planned_and_passes(sheet: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "out"
    assert main(["plan", str(sheet), *WIDE, MACHINE, "--method=jerk", "--out", str(out)]) == 0
    document = _document(out)
    assert document["inputs"]["method"] == "jerk" and document["outcome"] == "complete"
    reason = document["operations"][0]["orientation"]["reasons"][0]
    assert reason.startswith("jerk along the passes: 8.6") and "of the 8.66 m/s3 that the linear axes of" in reason
    assert main(["verify", str(out), "--no-pictures"]) == 0


def test_passes_along_planes_are_planned_and_pass(sheet: Path, tmp_path: Path, capsys: Capture) -> None:
    """Contacts of a pass lie in one plane that contains the axis, and tables, schema, sheet and verdict know of it."""
    out = tmp_path / "out"
    assert main(["plan", str(sheet), *FAST, "--passes=planes", "--out", str(out)]) == 0
    assert "in planes" in capsys.readouterr().out
    document = _document(out)
    assert document["inputs"]["passes"] == "planes" and document["outcome"] == "complete"
    plan = read_plan(out)
    op = with_contacts(plan).operations[0]
    assert op.path is not None and op.frame is not None
    for begin, end in pairwise(op.path.breaks):
        cuts = np.flatnonzero(op.path.kind[begin:end] == Motion.CUT) + begin
        assert np.ptp(op.path.cc[cuts] @ op.frame.y) < 1e-3
    assert main(["verify", str(out), "--no-pictures"]) == 0
    assert "in planes" in capsys.readouterr().out
    assert main(["post", str(out), "--dialect=haas-g254", MACHINE]) == 0
    sheets = [path.read_text() for path in out.rglob("*.md")]
    assert len(sheets) == 1 and "| passes | along parallel planes that contain the tool axis |" in sheets[0]


def test_passes_in_a_field_are_planned_and_pass(sheet: Path, tmp_path: Path, capsys: Capture) -> None:
    """Tables tell how far the cuts are from the ideal length, and widths are found again from the CL file alone."""
    out = tmp_path / "out"
    assert main(["plan", str(sheet), *FAST, "--passes=scallop", "--out", str(out)]) == 0
    told = capsys.readouterr().out
    found = _document(out)["operations"][0]["orientation"]
    assert "in a field" in told and f"ideal: {found['ideal']:.1f} mm with these axes" in told
    assert found["pattern"] == "scallop" and 0 < found["ideal"] < found["length"]
    plan = read_plan(out)
    widths = np.concatenate([width for _, width in widths_along(plan, plan.operations[0])])
    assert (widths > 0).all()
    assert main(["verify", str(out), "--no-pictures"]) == 0
    assert "in a field" in capsys.readouterr().out
    assert main(["post", str(out), "--dialect=haas-g254", MACHINE]) == 0
    sheets = [path.read_text() for path in out.rglob("*.md")]
    assert "| passes | along the levels of a field, as far apart as their strips are wide |" in sheets[0]


@pytest.mark.parametrize(("words", "said"), [
    (("--passes=planes", "--strategy=sturz", MACHINE), "passes 'planes' need a fixed axis and strategy 'sturz' moves"),
    (("--passes=auto", "--strategy=sturz", MACHINE), "passes 'auto' need a fixed axis and strategy 'sturz' moves"),
    (("--passes=spiral",), "invalid choice: 'spiral'"),
    (("--method=jerk",), "needs a machine, because it turns the part"),
    (("--method=jerk", MACHINE, "--orientations=2"), "leave out one of the two"),
    (("--method=jerk", MACHINE, "--strategy=sturz"), "leave out one of the two")])
def test_what_does_not_go_together_is_refused_in_one_sentence(sheet: Path, tmp_path: Path, capsys: Capture,
                                                              words: tuple[str, ...], said: str) -> None:
    out = tmp_path / "out"
    try:
        code = main(["plan", str(sheet), *FAST, *words, "--out", str(out)])
    except SystemExit as ended:
        code = ended.code
    assert code == 2
    err = capsys.readouterr().err
    assert said in err and err.count("\n") == 1 and not out.exists()


def test_most_jerk_is_compared_where_there_is_a_machine(sheet: Path, tmp_path: Path, capsys: Capture,
                                                        monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("toolaxis.job.planning.comparison.BY_SUB_SURFACE", ())
    monkeypatch.setattr("toolaxis.job.planning.comparison.WHOLE", ())
    out = tmp_path / "out"
    assert main(["plan", str(sheet), *FAST, "--machine=three-axes-fixture", "--compare", "--out", str(out)]) == 0
    rows = {row["method"]: row for row in _document(out)["baselines"]}
    assert list(rows) == ["plan", "jerk"] and rows["jerk"]["machined"] == 1
    assert rows["jerk"]["passes"] >= 3 and rows["jerk"]["length"] > 0 and rows["jerk"]["seconds"] > 0
    assert "most jerk along the passes" in capsys.readouterr().out
