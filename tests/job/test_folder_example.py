"""The example that plans a folder of STEP files: the faces that CadQuery picked, and nothing twice."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta

SCRIPT = Path(__file__).parents[2] / "examples" / "folder.py"


def carried_out(folder: Path) -> list[str]:
    done = subprocess.run([sys.executable, str(SCRIPT), str(folder), str(folder / "out")], capture_output=True,
                          text=True, timeout=170, check=False,
                          env={**os.environ, "PYTHONPATH": str(Path(ta.__file__).parents[1])})
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout.splitlines()


def test_a_folder_of_step_files_is_planned_in_under_thirty_lines(tmp_path: Path) -> None:
    cadquery = pytest.importorskip("cadquery")
    x, y = np.linspace(0, 16, 5), np.linspace(0, 12, 5)
    for name, height in (("flat", 1.0), ("round", 1.5)):
        rows = [[cadquery.Vector(a, b, height * np.sin(a / 9) * np.cos(b / 11)) for b in y] for a in x]
        top = cadquery.Face.makeSplineApprox(rows, tol=1e-3, minDeg=3, maxDeg=3)
        table = cadquery.Face.makePlane(60, 60, (8, 6, -20), (0, 0, 1))
        cadquery.exporters.export(cadquery.Workplane(obj=cadquery.Compound.makeCompound([table, top])),
                                  str(tmp_path / f"{name}.step"))
    assert len(SCRIPT.read_text().splitlines()) < 30
    assert sorted(carried_out(tmp_path)) == ["job flat: complete", "job round: complete"]
    for name in ("flat", "round"):
        plan = json.loads((tmp_path / "out" / name / "plan.json").read_text())
        (operation,) = plan["operations"]
        assert operation["kind"] == "bspline" and operation["face"] == 2
        assert json.loads((tmp_path / "out" / name / "verdict.json").read_text())["passed"] is True
    assert carried_out(tmp_path) == ["2 of 2 jobs are finished already"]
