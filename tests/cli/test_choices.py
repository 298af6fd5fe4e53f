"""What a user chooses by name is planned so, passes the judge, and is refused in one sentence where it does not fit."""

import json
from pathlib import Path

import pytest

from toolaxis.cli.main import main

Capture = pytest.CaptureFixture[str]
FAST = ("--tool=torus:12x1", "--scallop=0.1", "--limits=cone:0,0,1,60", "--faces=1", "--no-pictures")
MACHINE = "--machine=mikron-ucp-710"


def _document(out: Path) -> dict:
    return json.loads((out / "plan.json").read_text())


def test_the_axis_of_most_jerk_is_planned_and_passes(sheet: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "out"
    assert main(["plan", str(sheet), *FAST, MACHINE, "--method=jerk", "--out", str(out)]) == 0
    document = _document(out)
    assert document["inputs"]["method"] == "jerk" and document["outcome"] == "complete"
    reason = document["operations"][0]["orientation"]["reasons"][0]
    assert reason.startswith("jerk along the passes: 8.6") and "of the 8.66 m/s3 that the linear axes of" in reason
    assert main(["verify", str(out), "--no-pictures"]) == 0


@pytest.mark.parametrize(("words", "said"), [
    (("--method=jerk",), "needs a machine, because it turns the part"),
    (("--method=jerk", MACHINE, "--orientations=2"), "leave out one of the two"),
    (("--method=jerk", MACHINE, "--strategy=sturz"), "leave out one of the two")])
def test_what_does_not_go_together_is_refused_in_one_sentence(sheet: Path, tmp_path: Path, capsys: Capture,
                                                              words: tuple[str, ...], said: str) -> None:
    out = tmp_path / "out"
    assert main(["plan", str(sheet), *FAST, *words, "--out", str(out)]) == 2
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
