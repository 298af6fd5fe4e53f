"""Run outside FreeCAD before test_example_parts.py: the command's plans of the example parts, and the parts for them.

``python prepare_example_parts.py FOLDER --long`` leaves in FOLDER, for each plan, a copy of the part (NAME.step), the
command's folder (NAME/), and what was asked (asked.json); without --long nothing, since all those tests are long.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"
SLENDER = {"stickout": 70.0, "holder": [[10, 0], [10, 40], [25, 40], [25, 80]]}
WIDE = {"stickout": 70.0, "holder": [[16, 0], [16, 40], [25, 40], [25, 80]]}
SLIM = {"stickout": 45.0, "shank": [[2.3, 0.0], [2.3, 28.0], [3.0, 34.0], [3.0, 45.0]],
        "holder": [[8.0, 0.0], [8.0, 35.0], [20.0, 35.0], [20.0, 65.0]]}
TABLE = {"machine": "bc-table-table", "offset": [0.0, 0.0, 60.0]}
#: By name: the part, the tool, the scallop height, and the rest as the arguments of FreeCAD's side.
PLANS = {
    "freeform": ("freeform", "torus:12x1", 0.2, {"regions": 3, **TABLE, **SLENDER}),
    "trimmed": ("trimmed", "torus:12x1", 0.2, {"regions": 2, **TABLE, **SLENDER}),
    "boss": ("boss", "torus:10x1", 0.2, {"regions": 4, **TABLE, **WIDE}),
    "bosses": ("bosses", "torus:10x1", 0.3, {**WIDE}),
    "blisk": ("blisk", "torus:10x1", 0.2, {"regions": 1, **SLENDER}),
    "kj66": ("kj66_impeller", "tapered:2x1x3", 0.2, {"faces": [7, 9], **SLIM}),
    "kj66-whole": ("kj66_impeller", "tapered:2x1x3", 0.2, {**SLIM}),
    "freeform-sturz": ("freeform", "torus:12x1", 0.5, {"strategy": "sturz", **TABLE}),
    "trimmed-sturz": ("trimmed", "torus:16x2", 0.5, {"strategy": "sturz", **TABLE}),
}


def plan(name, folder):
    """Let the command plan one; False where its part is absent."""
    part, tool, scallop, rest = PLANS[name]
    source = next((path for path in (ROOT / "examples" / f"{part}.step", SHARED / f"{part}.step") if path.exists()),
                  None)
    if source is None:
        return False
    shutil.copy(source, folder / f"{name}.step")
    words = [str(folder / f"{name}.step"), "--tool", tool, "--scallop", str(scallop), "--no-pictures",
             "--out", str(folder / name)]
    given = dict(rest)
    if "shank" in given:  # the command takes a shank from a file
        words[2] = str(written_tool(given, tool, folder / f"{name}.toml"))
    for option in ("stickout", "regions", "strategy", "machine"):
        if option in given and not (option == "stickout" and "shank" in given):
            words += [f"--{option}", str(given[option])]
    if "holder" in given and "shank" not in given:
        words += ["--holder", ";".join(f"{radius},{z}" for radius, z in given["holder"])]
    for option in ("offset", "faces"):
        if option in given:
            words.append(f"--{option}={','.join(map(str, given[option]))}")
    run = subprocess.run([sys.executable, "-m", "toolaxis.cli.main", "plan", *words],
                         env={**os.environ, "PYTHONPATH": str(ROOT / "core")}, check=False)
    assert run.returncode in (0, 1), f"the command ended with {run.returncode} for {name}"
    return True


def written_tool(given, tool, path):
    """A tool with a shank as a file."""
    kind, _, sizes = tool.partition(":")
    diameter, corner, angle = sizes.split("x")
    path.write_text("\n".join([
        f'kind = "{kind}"', f"diameter = {float(diameter)}", f"corner_radius = {float(corner)}",
        f"half_angle_deg = {float(angle)}", f"stickout = {given['stickout']}", f"shank = {given['shank']}",
        f"holder = {given['holder']}", ""]))
    return path


if __name__ == "__main__":
    target = Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    if "--long" in sys.argv:
        chosen = [word for word in sys.argv[2:] if word in PLANS] or list(PLANS)
        made = [name for name in chosen if plan(name, target)]
        (target / "asked.json").write_text(json.dumps({name: PLANS[name] for name in made}))
