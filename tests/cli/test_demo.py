"""`toolaxis demo` makes a folder that was not there, whole or not at all; tests/test_wheel.py runs it to its end."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from toolaxis.cli import demo
from toolaxis.cli.main import main


@pytest.mark.parametrize("kind", ["folder", "file"])
def test_a_folder_that_exists_is_refused_in_one_sentence(tmp_path: Path, kind: str,
                                                         capsys: pytest.CaptureFixture[str]) -> None:
    there = tmp_path / "there"
    if kind == "file":
        there.write_text("mine")
    else:
        there.mkdir()
    before = sorted(tmp_path.rglob("*"))
    assert main(["demo", str(there)]) == 2
    assert capsys.readouterr() == ("", f"toolaxis: {there} exists: toolaxis demo writes a new folder; name another "
                                       "one\n")
    assert sorted(tmp_path.rglob("*")) == before


def test_without_its_part_it_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                     capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(demo, "PART", "gone")
    assert main(["demo", str(tmp_path / "new")]) == 2
    assert "example part gone.step is not installed: install toolaxis again" in capsys.readouterr().err


@pytest.mark.skipif(sys.platform == "win32", reason="no signals to other processes")
def test_one_that_is_stopped_leaves_nothing(tmp_path: Path) -> None:
    pytest.importorskip("OCP")
    process = subprocess.Popen([sys.executable, "-m", "toolaxis.cli.main", "demo", "deep/new"], cwd=tmp_path,
                               stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    assert any("choice of tools" in line for line in process.stderr)
    assert [path.name for path in (tmp_path / "deep").iterdir()] != ["new"]
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=300)
    assert process.returncode == 130 and said.splitlines()[-1] == "toolaxis: interrupted", said
    assert list(tmp_path.iterdir()) == []
