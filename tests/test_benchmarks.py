"""`make bench`: a benchmark that cannot run here says why, and the others go on."""

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


def test_benchmarks_go_on_where_there_is_no_freecad() -> None:
    if find_spec("FreeCAD") is not None:
        pytest.skip("FreeCAD can be imported here")
    without = {name: value for name, value in os.environ.items() if name != "TOOLAXIS_FREECAD"}
    run = subprocess.run([sys.executable, "-m", "benchmarks", "freecad_panel", "startup"], cwd=ROOT, env=without,
                         capture_output=True, text=True, timeout=120)
    assert run.returncode == 0, run.stderr
    assert run.stdout.count("not measured: no FreeCAD") == 2 and "--- startup" in run.stdout


def test_operations_are_counted_as_they_run() -> None:
    code = ("from benchmarks._count import KINDS, TALLY, counted, root\n"
            "import numpy as np\n"
            "x = counted(np.array([3.0, 4.0]))\n"
            "y = -root(x[0] ** 2 + x[1] * x[1]) / 2.0 - abs(1.0 - x[0])\n"
            "assert y == -4.5 and [TALLY[kind] for kind in KINDS] == [3, 2, 1, 1], (y, TALLY)\n")
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, timeout=60)


def test_the_work_of_workers_counts_as_processor_time() -> None:
    code = ("import subprocess, sys, time\n"
            "from benchmarks.growth import processor\n"
            "before, own = processor(), time.process_time()\n"
            "work = 'import time\\nwhile time.process_time() < 0.5: pass'\n"
            "subprocess.run([sys.executable, '-c', work], check=True)\n"
            "own = time.process_time() - own\n"
            "assert processor() - before >= 0.45 + own, (processor() - before, own)\n")
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, timeout=60)
