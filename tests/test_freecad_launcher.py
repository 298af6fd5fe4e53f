"""The launcher of the FreeCAD tests: what happens inside is seen outside, and nothing is taken for success."""

import importlib.util
import json
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="module")
def launcher():
    spec = importlib.util.spec_from_file_location("freecad_launcher", ROOT / "tests" / "workbench" / "conftest.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def told(launcher, outcomes):
    return f"chatter of FreeCAD\n{launcher.MARK}{json.dumps(outcomes)}\n"


def test_passed_is_passed(launcher):
    launcher.judge(told(launcher, {"a": ["passed", ""], "b": ["skipped", "no window"]}), "ended with 0")


def test_a_failure_inside_is_shown_with_its_name_and_text(launcher):
    with pytest.raises(launcher.InnerFailure, match=r"test_x::b failed(.|\n)*assert 1 == 2(.|\n)*1 of 2 failed"):
        launcher.judge(told(launcher, {"a": ["passed", ""], "test_x::b": ["failed", "assert 1 == 2"]}), "ended with 1")


@pytest.mark.parametrize("output, ending, what", [
    ("Segmentation fault\n", "ended with -11", "Segmentation fault"),
    ("", "did not end within 3 s", "did not end within 3 s"),
    ("TOOLAXIS-INNER {}\n", "ended with 0", "no test failed"),
    ('TOOLAXIS-INNER {"a": ["passed", ""]}\n', "ended with 3", "ended with 3"),
])
def test_what_told_nothing_or_ended_badly_fails(launcher, output, ending, what):
    with pytest.raises(launcher.InnerFailure, match=what):
        launcher.judge(output, ending)


def test_where_all_is_skipped_the_reason_comes_out(launcher):
    with pytest.raises(pytest.skip.Exception, match="no window"):
        launcher.judge(told(launcher, {"a": ["skipped", "no window"]}), "ended with 0")


def test_without_freecad_the_reason_is_told(launcher, monkeypatch):
    monkeypatch.delenv("TOOLAXIS_FREECAD", raising=False)
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.setenv("TOOLAXIS_FREECAD_MISSING", "the mirror did not answer")
    with pytest.raises(pytest.skip.Exception, match="no FreeCAD: the mirror did not answer"):
        launcher.command_for("TOOLAXIS_FREECAD", ["tests/x.py"], window=False)


def test_a_command_that_hangs_is_ended_with_its_children(launcher, tmp_path):
    mark = tmp_path / "mark"
    late = f"import time, pathlib; time.sleep(4); pathlib.Path({str(mark)!r}).touch()"
    child = f"import subprocess, sys; print('begun', flush=True); subprocess.run([sys.executable, '-c', {late!r}])"
    output, ending = launcher.ended([sys.executable, "-c", child], 2.0)
    assert ending == "did not end within 2 s"
    assert output in ("", "begun\n")
    time.sleep(4)
    assert not mark.exists()
