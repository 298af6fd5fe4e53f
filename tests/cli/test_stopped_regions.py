"""Ctrl-C while several faces are planned by sub-surfaces: what is finished is one whole plan.json."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from toolaxis.job.files.plan_folder import read_plan

FAST = ["--tool=ball:6", "--scallop=0.2", "--limits=cone:0,0,1,10", "--no-pictures", "--workers=1"]


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to another process")
def test_finished_sub_surfaces_of_several_faces_are_kept(sheet: Path, tmp_path: Path) -> None:
    words = ["plan", str(sheet), *FAST, "--faces=1,2", "--regions=2", "--out", str(tmp_path / "out")]
    process = subprocess.Popen([sys.executable, "-m", "toolaxis.cli.main", *words], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"})
    assert process.stderr is not None
    assert any("(4 of 4)" in line for line in process.stderr), "the command ended before the fourth sub-surface"
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=120)
    assert process.returncode == 130 and "Traceback" not in said
    assert [path.name for path in tmp_path.iterdir()] == ["out"], "debris"
    kept = read_plan(tmp_path / "out")
    assert kept.outcome == "cancelled"
    assert [op.face.label for op in kept.operations][:3] == ["1a", "1b", "2a"]
    assert all(op.done and op.face.trims for op in kept.operations)
    assert sum(op.face.area for op in kept.operations[:2]) == pytest.approx(kept.part.face(1).area, rel=1e-6)
    document = json.loads((tmp_path / "out" / "plan.json").read_text())
    assert {op["cl_file"] for op in document["operations"]} == {
        path.name for path in (tmp_path / "out").glob("*.apt")}
