"""Found: Ctrl-C in the first moments of the command, before any handler stood, showed Python's trace."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

SAID = {"toolaxis: stopping and keeping what is finished; Ctrl-C once more, 2 s from now or later, ends at once and "
        "keeps nothing", "toolaxis: no face was finished: nothing is written", "toolaxis: interrupted"}
_PART = Path(__file__).parents[2] / "examples" / "saddle.step"
#: Does what the installed command does, and tells when the first handler stands: before, no program can answer.
_COMMAND = """
import os, signal
whole = signal.signal
def told(*words):
    before = whole(*words)
    os.write(1, b".")
    return before
signal.signal = told
from toolaxis.cli.start import command
command()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to another process")
@pytest.mark.parametrize("wait", [
    0.0, 0.05, 0.5, *(pytest.param(wait, marks=pytest.mark.long) for wait in (0.02, 0.1, 0.2))])
def test_it_is_answered_in_a_line(wait: float, tmp_path: Path) -> None:
    pytest.importorskip("OCP")
    out = tmp_path / "out"
    words = ["plan", str(_PART), "--tool", "ball:12", "--scallop", "0.3", "--no-pictures", "--out", str(out)]
    process = subprocess.Popen([sys.executable, "-c", _COMMAND, *words], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    process.stdout.read(1)
    time.sleep(wait)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=120)
    if process.returncode == 0:
        pytest.skip("the plan was finished before the signal came")
    assert "Traceback" not in said
    assert process.returncode == 130
    assert said.splitlines()[-1] == "toolaxis: interrupted"
    assert set(said.splitlines()) <= SAID
    assert not out.exists() and list(tmp_path.iterdir()) == []


def test_the_handler_stands_before_anything_heavy() -> None:
    """The module that sets it loads none of what takes time: a moment without it is as short as it can be."""
    code = ("import sys, toolaxis.cli.start; "
            "print([name for name in ('numpy', 'numba', 'argparse', 'toolaxis.cli.main') if name in sys.modules])")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
