"""Run outside FreeCAD before test_same_plan.py: the command's plans, and the parts they are for.

``python prepare_same_plan.py FOLDER [--long]`` leaves in FOLDER, for each part, a copy of it (NAME.step) and what the
command made of it (NAME/plan.json); with --long of all parts, else of a few.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"
EXAMPLES = ROOT / "examples"
SHORT = {
    "freeform": (EXAMPLES, "torus:12x1", "0.05", "1"),
    "trimmed": (EXAMPLES, "ball:8", "0.05", "1"),
    "mousecover": (SHARED, "ball:2", "0.05", "33"),
}
LONG: dict[str, tuple[Path, str, str, str]] = {
    "saddle": (EXAMPLES, "torus:12x1", "0.02", "1"),
    "hyperbolic_paraboloid": (EXAMPLES, "torus:10x1", "0.01", "1"),
    "hyperbolic_paraboloid_rules": (EXAMPLES, "torus:10x1", "0.01", "1"),
    "manta": (EXAMPLES, "torus:16x2", "0.05", "1"),
    "biquintic": (EXAMPLES, "torus:12x1", "0.02", "1"),
}


def write(folder, jobs):
    for name, (source, tool, scallop, faces) in jobs.items():
        part = source / f"{name}.step"
        if not part.exists():
            continue
        shutil.copy(part, folder / part.name)
        command = [sys.executable, "-m", "toolaxis.cli.main", "plan", str(folder / part.name), "--tool", tool,
                   "--scallop", scallop, "--faces", faces, "--no-pictures", "--out", str(folder / name)]
        run = subprocess.run(command, env={**os.environ, "PYTHONPATH": str(ROOT / "core")}, check=False)
        assert run.returncode in (0, 1), f"the command ended with {run.returncode}"


if __name__ == "__main__":
    write(Path(sys.argv[1]), SHORT | (LONG if "--long" in sys.argv else {}))
