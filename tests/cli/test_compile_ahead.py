"""Compiling in a second process: it makes what a plan needs, begins only where that is missing, and ends with it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from toolaxis.cli import compile_ahead
from toolaxis.numeric import jit

ROOT = Path(__file__).resolve().parents[2]

COMPARED = """
import gc
from toolaxis.cli.compile_ahead import compile_ahead
from toolaxis.numeric.kernel import KeptKernel

def known():
    kernels = [one for one in gc.get_objects() if isinstance(one, KeptKernel)]
    return {(one.py_func.__qualname__, str(types)) for one in kernels for types in one.overloads}

compile_ahead()
ahead = known()
from toolaxis.job.output.verify import verify_plan
from toolaxis.job.planning.pipeline import plan
made = plan("examples/saddle.step", "torus:8x1", 0.1)
planned = known()
assert made.operations[0].done and verify_plan(made).operations
print(len(ahead), "half_widths" in {name for name, _ in planned - ahead}, sorted(known() - planned - ahead))
"""


@pytest.mark.skipif(not jit.available, reason="numba is missing: nothing is compiled")
def test_strip_widths_and_all_that_a_verdict_needs_are_compiled() -> None:
    done = subprocess.run([sys.executable, "-c", COMPARED], cwd=ROOT, capture_output=True, text=True, timeout=600,
                          env={**os.environ, "PYTHONPATH": "core"}, check=False)
    assert done.returncode == 0, done.stderr
    count, missed, missing = done.stdout.split(maxsplit=2)
    assert int(count) > 7 and missed == "False" and missing.strip() == "[]"


class _Process:
    """Stands for the other process, and remembers what was asked of it."""

    def __init__(self, command: list[str], **rest: object) -> None:
        self.asked = ["begun"]

    def terminate(self) -> None:
        self.asked.append("ended")

    def wait(self) -> None:
        self.asked.append("gone")


@pytest.mark.parametrize(("kept", "begun"), [(True, 0), (False, 1)])
def test_it_begins_only_where_kernels_are_missing(kept: bool, begun: int, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[_Process] = []

    def started(command: list[str], **rest: object) -> _Process:
        made.append(_Process(command))
        return made[-1]

    monkeypatch.setattr(compile_ahead.subprocess, "Popen", started)
    monkeypatch.setattr(compile_ahead, "is_kept", lambda kernel: kept)
    monkeypatch.setattr(compile_ahead, "count_cores", lambda: 2)
    with pytest.raises(KeyboardInterrupt), compile_ahead.compiling_ahead():
        raise KeyboardInterrupt
    assert [one.asked for one in made] == [["begun", "ended", "gone"]] * begun


def test_one_core_compiles_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compile_ahead, "is_kept", lambda kernel: False)
    monkeypatch.setattr(compile_ahead, "count_cores", lambda: 1)
    monkeypatch.setattr(compile_ahead.subprocess, "Popen", None)
    with compile_ahead.compiling_ahead():
        pass
