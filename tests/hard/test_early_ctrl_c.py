"""Found: Ctrl-C before the first face was finished replaced an earlier plan in the same folder by an empty one."""

from pathlib import Path

import pytest

import toolaxis.cli.plan
from toolaxis.cli.main import INTERRUPTED, main

_PART = Path(__file__).parents[2] / "examples" / "saddle.step"


def test_an_earlier_plan_survives(tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                  capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("OCP")
    (tmp_path / "plan.json").write_text("earlier")
    (tmp_path / "op01-face1.apt").write_text("earlier")
    whole = toolaxis.cli.plan.run
    monkeypatch.setattr(toolaxis.cli.plan, "run", lambda given, asked: whole(given, lambda: True))
    assert main(["plan", str(_PART), "--tool", "ball:12", "--scallop", "0.3", "--out", str(tmp_path)]) == INTERRUPTED
    assert sorted(path.name for path in tmp_path.iterdir()) == ["op01-face1.apt", "plan.json"]
    assert (tmp_path / "plan.json").read_text() == "earlier"
    assert "nothing is written" in capsys.readouterr().err
