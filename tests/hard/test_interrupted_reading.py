"""Found: Ctrl-C in a terminal also went to the process that reads STEP files: "crashed the CAD kernel", exit code 2."""

from pathlib import Path

import pytest

from toolaxis.cad.step import read as step
from toolaxis.errors import ToolAxisError

pytest.importorskip("OCP")

_CHILD = """
import os, pickle, sys
from toolaxis.errors import ToolAxisError
own = os.getpgid(0) == os.getpid()
with open(sys.argv[2], "wb") as file:
    pickle.dump(("failed", ToolAxisError, "alone" if own else "in the group of its caller"), file)
"""


def test_the_reader_is_not_in_the_group_that_a_terminal_interrupts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(step, "COMMAND", ("-c", _CHILD))
    with pytest.raises(ToolAxisError, match="alone"):
        step.read_step(Path(__file__).parents[2] / "examples" / "freeform.step")
