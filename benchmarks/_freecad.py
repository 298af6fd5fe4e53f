"""Running a benchmark in the real FreeCAD: here where it can be imported, else in the one TOOLAXIS_FREECAD names."""

import os
import shlex
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def in_freecad(module: str, measured: Callable[[Sequence[str]], Iterator[tuple[str, str]]]) -> None:
    """Print what is measured, or why it is not.

    Parameters
    ----------
    module : str
        Name of the benchmark, run as a module in the other FreeCAD.
    measured : callable
        Takes the benchmark's own arguments, and yields names with their figures, in FreeCAD's Python.
    """
    if find_spec("FreeCAD") is not None:
        _printed(measured(sys.argv[1:] if sys.argv[0].endswith(f"{module}.py") else []))
        return
    prefix = shlex.split(os.environ.get("TOOLAXIS_FREECAD", ""))
    if not prefix:
        print("not measured: no FreeCAD (TOOLAXIS_FREECAD names one, see CONTRIBUTING.md)")
        return
    began = time.perf_counter()
    subprocess.run([*prefix, "python3", "-m", f"benchmarks.{module}"], cwd=ROOT, check=True,
                   stdin=subprocess.DEVNULL)
    print(f"in all {time.perf_counter() - began:.0f} s")


def _printed(rows: Iterator[tuple[str, str]]) -> None:
    """Print the table and leave before the window closes."""
    screen, status = sys.__stdout__ or sys.stdout, 0
    try:
        for name, text in rows:
            print(f"{name:40} {text}", file=screen, flush=True)
    except Exception as reason:
        print(f"{type(reason).__name__}: {reason}", file=screen)
        status = 1
    screen.flush()
    os._exit(status)
