"""Running a benchmark in the real FreeCAD: here where it can be imported, else in the one TOOLAXIS_FREECAD names."""

import os
import shlex
import subprocess
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def in_freecad(module: str, measured: Callable[[], None]) -> None:
    """Print what is measured, or why it is not.

    Parameters
    ----------
    module : str
        Name of the benchmark, run as a module in the other FreeCAD.
    measured : callable
        Prints its table, in FreeCAD's Python.
    """
    if find_spec("FreeCAD") is not None:
        measured()
        return
    prefix = shlex.split(os.environ.get("TOOLAXIS_FREECAD", ""))
    if not prefix:
        print("not measured: no FreeCAD (TOOLAXIS_FREECAD names one, see CONTRIBUTING.md)")
        return
    began = time.perf_counter()
    subprocess.run([*prefix, "python3", "-m", f"benchmarks.{module}"], cwd=ROOT, check=True,
                   stdin=subprocess.DEVNULL)
    print(f"in all {time.perf_counter() - began:.0f} s")
