"""Progress without a terminal: a stage is named once, and time remaining is said every few seconds."""

import pytest

from toolaxis.cli import display
from toolaxis.errors import Cancelled


def test_plain_lines(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([0.0, 1.0, 6.0, 7.0, 20.0, 21.0])
    monkeypatch.setattr(display.time, "monotonic", lambda: next(clock))
    with display.show_progress(lambda: False) as progress:
        for stage, done in (("axes", 0), ("axes", 1), ("axes", 2), ("axes", 3), ("passes", 0), ("axes", 4)):
            progress.report(stage, done, 8)
    assert capsys.readouterr().err.splitlines() == ["axes", "axes: 25 %, about 18 s left", "passes"]


def test_a_stage_that_begins_again_is_not_told_again(capsys: pytest.CaptureFixture[str],
                                                     monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter(range(0, 600, 6))
    monkeypatch.setattr(display.time, "monotonic", lambda: float(next(clock)))
    with display.show_progress(lambda: False) as progress:
        for done in (0, 40, 0, 20, 40, 60, 61, 62, 98, 98, 98, 0, 50):
            progress.report("passes", done, 100)
    assert capsys.readouterr().err.splitlines() == [
        "passes", "passes: 40 %, about 9 s left", "passes: 60 %, about 12 s left", "passes: 98 %, about 1 s left"]


def test_asking_to_stop_stops(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(Cancelled), display.show_progress(lambda: True) as progress:
        progress.report("axes", 0, 1)


def test_bars_on_a_terminal(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    with display.show_progress(lambda: False) as progress:
        progress.within("face 1").report("axes", 1, 4)
        progress.within("face 1").report("passes", 1, 4)
    assert capsys.readouterr().out == ""
