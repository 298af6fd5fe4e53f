"""What the add-on costs when FreeCAD starts: the same start with and without it, side by side, its modules alone.

Runs in the FreeCAD that TOOLAXIS_FREECAD names (see CONTRIBUTING.md), or in this Python where FreeCAD can be imported.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

from benchmarks._freecad import in_freecad

ROOT = Path(__file__).resolve().parents[1]
ROUNDS = 7
AIM = 0.050
WINDOW = "import FreeCADGui\nFreeCADGui.showMainWindow()\n"
STARTS = {"console": "", "window": WINDOW}
TIMED = """
import os, sys, time
began = time.perf_counter()
import FreeCAD
{more}
sys.__stdout__.write(f"TOOK {{time.perf_counter() - began}} {{'freecad.toolaxis' in sys.modules}}\\n")
sys.__stdout__.flush()
os._exit(0)
"""
OWN = """
import FreeCAD
{more}
import time, sys
sys.path.insert(0, {workbench!r})
import freecad, importlib
freecad.__path__.append({workbench!r} + "/freecad")
took = []
for name in ("freecad.toolaxis", *(["freecad.toolaxis.init_gui"] if FreeCAD.GuiUp else [])):
    began = time.perf_counter()
    importlib.import_module(name)
    took.append(time.perf_counter() - began)
import os
sys.__stdout__.write(f"TOOK {{sum(took)}} True\\n")
sys.__stdout__.flush()
os._exit(0)
"""


def homes(folder: Path) -> dict[str, Path]:
    """Two fresh profiles of FreeCAD: without and with the add-on."""
    made = {}
    for name in ("without", "with"):
        made[name] = folder / name
        (made[name] / "Mod").mkdir(parents=True)
        settings = Path(os.environ.get("FREECAD_USER_HOME", "/nowhere")) / "user.cfg"
        if settings.exists():
            shutil.copy(settings, made[name] / "user.cfg")
    (made["with"] / "Mod" / "toolaxis").symlink_to(ROOT)
    return made


def took(code: str, home: Path) -> tuple[float, bool]:
    """Seconds that a new process needed for its start, and whether the add-on was loaded in it."""
    run = subprocess.run([sys.executable, "-c", code], env={**os.environ, "FREECAD_USER_HOME": str(home)}, check=True,
                         capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=120)
    line = next(line for line in run.stdout.splitlines() if line.startswith("TOOK "))
    return float(line.split()[1]), line.split()[2] == "True"


def measured() -> None:
    """Print the table, in FreeCAD's Python."""
    print(f"{'start':10}{'without, s':>12}{'with, s':>12}{'more, ms':>12}{'own modules, ms':>18}"
          f"   medians of {ROUNDS}, taken in turns; aim: below {1000 * AIM:.0f} ms")
    with tempfile.TemporaryDirectory(prefix="toolaxis-") as folder:
        profiles = homes(Path(folder))
        for start, more in STARTS.items():
            times: dict[str, list[float]] = {"without": [], "with": []}
            own = []
            for _ in range(ROUNDS):
                for name, home in profiles.items():
                    seconds, loaded = took(TIMED.format(more=more), home)
                    assert loaded == (name == "with"), f"the add-on was {'' if loaded else 'not '}loaded {name} it"
                    times[name].append(seconds)
                code = OWN.format(more=more, workbench=str(ROOT / "workbench"))
                own.append(took(code, profiles["without"])[0])
            before, after = median(times["without"]), median(times["with"])
            print(f"{start:10}{before:12.3f}{after:12.3f}{1000 * (after - before):12.1f}{1000 * median(own):18.1f}",
                  flush=True)


def main() -> None:
    """Print the table by whichever FreeCAD there is."""
    in_freecad("startup", measured)


if __name__ == "__main__":
    main()
