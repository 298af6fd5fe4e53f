"""Found: an error of our own while a STEP file is read was told as a crash of the CAD kernel, the file's fault."""

import pytest

from toolaxis.cad.step import worker as transfer
from toolaxis.errors import InvalidInput, ToolAxisError

OCP = pytest.importorskip("OCP")


def _outcome(monkeypatch: pytest.MonkeyPatch, reason: Exception) -> tuple:
    def _raise(path: str) -> None:
        raise reason

    monkeypatch.setattr(transfer, "read_file", _raise)
    return transfer.convert("part.step")


def test_our_own_error_is_ours(monkeypatch: pytest.MonkeyPatch) -> None:
    kind, blamed, message = _outcome(monkeypatch, IndexError("index 0 is out of bounds"))
    assert (kind, blamed) == ("failed", ToolAxisError)
    assert "toolaxis itself" in message and "IndexError" in message and "test_whose_fault.py" in message


def test_the_kernel_s_error_is_the_file_s(monkeypatch: pytest.MonkeyPatch) -> None:
    from OCP.gp import gp_Dir

    with pytest.raises(Exception) as found:
        gp_Dir(0.0, 0.0, 0.0)
    kind, blamed, message = _outcome(monkeypatch, found.value)
    assert (kind, blamed) == ("failed", InvalidInput)
    assert "CAD kernel fails" in message
