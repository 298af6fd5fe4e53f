"""Found: a plan that leaves a seventh of a face to clean-up did not say so on the screen, and verified as "pass".

Found later: every operation was told to leave a share "that was not asked for", those that leave nothing too.
"""

import re
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cli.main import main
from toolaxis.job.files.plan_folder import stage_folder, write_plan


def _flat(*rows: list[float]) -> ta.Face:
    p, a, b = np.array(rows, dtype=float)
    return ta.Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


def test_verify_says_how_much_is_left_to_clean_up(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    faces = [_flat([0, 0, 0], [14, 0, 0], [0, 8, 0]), _flat([14.4, -5, -5], [0, 0, 18], [0, 18, 0])]
    made = ta.plan(faces, ta.Tool.ball(diameter=4, stickout=30), 0.2, faces=[1], machine="cone:-0.1,0,1,2")
    share = made.operations[0].orientation.unreached
    assert 0.05 < share < 0.5
    with stage_folder(tmp_path / "plan") as stage:
        write_plan(made, stage.folder)
        stage.publish()
    assert main(["verify", str(tmp_path / "plan"), "--no-pictures"]) in (0, 1)
    said = capsys.readouterr().err
    assert re.search(r"mm2, (\d+\.\d+) % of the area, are rest material by the plan", said), said
    declared = float(re.search(r"mm2, (\d+\.\d+) % of", said)[1])
    assert declared == pytest.approx(100 * share, abs=2.0)


def test_nothing_is_said_of_what_is_not_left(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = ta.plan([_flat([0, 0, 0], [14, 0, 0], [0, 8, 0])], ta.Tool.ball(diameter=4, stickout=30), 0.2, faces=[1])
    with stage_folder(tmp_path / "plan") as stage:
        write_plan(made, stage.folder)
        stage.publish()
    assert main(["verify", str(tmp_path / "plan"), "--no-pictures"]) == 0
    assert "rest material" not in capsys.readouterr().err
