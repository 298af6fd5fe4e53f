"""Run outside FreeCAD before test_moving_axes.py: what the command plans with an axis that moves.

``python prepare_moving_axes.py FOLDER`` leaves in FOLDER a copy of the part (part.step) and the command's plan (out).
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ASKED = ("--tool", "torus:16x2", "--scallop", "0.5", "--strategy", "sturz", "--machine", "bc-table-table")

if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(ROOT / "examples" / "trimmed.step", folder / "part.step")
    command = [sys.executable, "-m", "toolaxis.cli.main", "plan", str(folder / "part.step"), "--no-pictures", *ASKED,
               "--out", str(folder / "out")]
    run = subprocess.run(command, env={**os.environ, "PYTHONPATH": str(ROOT / "core")}, check=False)
    assert run.returncode == 0, f"the command ended with {run.returncode}"
