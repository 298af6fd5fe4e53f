"""Run outside FreeCAD before test_same_plan.py: the command's plans, the library's figures, and the parts for them.

``python prepare_same_plan.py FOLDER [--long]`` leaves in FOLDER, for each part, a copy of it (NAME.step), what the
command made of it (NAME/plan.json), and figures of some of its faces at one axis (figures.json); with --long of all
parts, else of a few.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"
EXAMPLES = ROOT / "examples"
DIVIDED = ("freeform", "ball:12", "0.3", "--regions", "2", "--method", "normal")
PLANS = {"freeform": ("torus:12x1", "0.05"), "trimmed": ("ball:8", "0.05")}
LONG_PLANS = {
    "saddle": ("torus:12x1", "0.02"), "hyperbolic_paraboloid": ("torus:10x1", "0.01"),
    "hyperbolic_paraboloid_rules": ("torus:10x1", "0.01"), "manta": ("torus:16x2", "0.05"),
    "biquintic": ("torus:12x1", "0.02"),
}
FIGURES = {"mousecover": ("ball:2", 0.05, [3, 5, 33, 37, 64]), "saddle": ("torus:12x1", 0.05, [1])}
LONG_FIGURES = {name: ("torus:12x1", 0.05, [1]) for name in [*PLANS, *LONG_PLANS]}


def copied(name, folder):
    """The part beside what is made of it; None where it is absent."""
    source = next((path for path in (EXAMPLES / f"{name}.step", SHARED / f"{name}.step") if path.exists()), None)
    return shutil.copy(source, folder / f"{name}.step") if source else None


def write_plans(folder, jobs):
    for name, (tool, scallop) in jobs.items():
        write_plan(copied(name, folder), (tool, scallop), folder / name)


def write_plan(path, asked, folder):
    """The command's plan of a part in a folder."""
    tool, scallop, *more = asked
    command = [sys.executable, "-m", "toolaxis.cli.main", "plan", str(path), "--tool", tool, "--scallop", scallop,
               "--no-pictures", "--out", str(folder), *more]
    run = subprocess.run(command, env={**os.environ, "PYTHONPATH": str(ROOT / "core")}, check=False)
    assert run.returncode in (0, 1), f"the command ended with {run.returncode}"


def write_figures(folder, jobs):
    from evaluation import evaluated

    import toolaxis as ta

    written = {}
    for name, (tool, scallop, numbers) in jobs.items():
        path = copied(name, folder)
        if path:
            part = ta.load(path)
            faces = {number: evaluated(part, number, tool, scallop) for number in numbers}
            written[name] = {"tool": tool, "scallop": scallop, "faces": faces}
    (folder / "figures.json").write_text(json.dumps(written))


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT / "core"))
    target, long = Path(sys.argv[1]), "--long" in sys.argv
    target.mkdir(parents=True, exist_ok=True)
    write_figures(target, FIGURES | (LONG_FIGURES if long else {}))
    write_plan(copied(DIVIDED[0], target), DIVIDED[1:], target / "divided" / "out")
    write_plans(target, PLANS | (LONG_PLANS if long else {}))
