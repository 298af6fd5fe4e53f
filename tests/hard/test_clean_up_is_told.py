"""Found: a plan that leaves a seventh of a face to clean-up did not say so on the screen, and verified as "pass"."""

from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cli.main import main
from toolaxis.job.folder import staged, write_plan


def _flat(*rows: list[float]) -> ta.Face:
    p, a, b = np.array(rows, dtype=float)
    return ta.Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


def test_verify_says_how_much_is_left_to_clean_up(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    faces = [_flat([0, 0, 0], [14, 0, 0], [0, 8, 0]), _flat([14.4, -5, -5], [0, 0, 18], [0, 18, 0])]
    made = ta.plan(faces, ta.Tool.ball(diameter=4, stickout=30), 0.2, faces=[1], machine="cone:-0.1,0,1,2")
    share = made.operations[0].orientation.unreached
    assert 0.05 < share < 0.5
    with staged(tmp_path / "plan") as stage:
        write_plan(made, stage.folder)
        stage.publish()
    assert main(["verify", str(tmp_path / "plan"), "--no-pictures"]) in (0, 1)
    assert f"{100 * share:.1f} % of the area" in capsys.readouterr().err
