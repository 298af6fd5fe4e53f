"""CL data around a blade from elsewhere: re-scheduled, proven against the part, written, or refused."""

import json
from pathlib import Path

import numpy as np
import pytest
from benchmarks._blades import loft, sections

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.cli.main import main
from toolaxis.errors import InvalidInput
from toolaxis.job.output.reschedule import reschedule
from toolaxis.post.apt import apt_text
from toolaxis.post.read_apt import read_apt

ROOT = Path(__file__).resolve().parents[2]
TOOL = ta.Tool.ball(6, stickout=90, holder=[(12.5, 0), (12.5, 60)])


def around(rows: np.ndarray, heights: tuple[float, ...], radius: float = 3.0) -> ToolPath:
    """Closed layers about z, the axis along the section's normal, with rapid motions between them."""
    closed = np.concatenate([rows, rows[:1]])
    way = np.roll(rows, -1, axis=0) - np.roll(rows, 1, axis=0)
    out = np.column_stack([way[:, 1], -way[:, 0]]) / np.hypot(*way.T)[:, None]
    axes = np.column_stack([np.concatenate([out, out[:1]]), np.zeros(len(closed))])
    centre, axis, kind = [], [], []
    for z in heights:
        layer = np.column_stack([closed, np.full(len(closed), z)])
        centre += [layer[:1] + 30 * axes[:1], layer[:1] + 9 * axes[:1], layer, layer[-1:] + 30 * axes[-1:]]
        axis += [axes[:1], axes[:1], axes, axes[-1:]]
        kind += [Motion.LINK, Motion.LINK, Motion.ENTRY, *[Motion.CUT] * len(rows), Motion.LINK]
    points, axes = np.concatenate(centre), np.concatenate(axis)
    tips = points - radius * axes
    return ToolPath(tips, tips, axes, axes, np.array(kind, dtype=np.int8), np.array([0, len(tips)]))


@pytest.fixture(scope="module")
def found():
    rows = np.roll(sections("turbine", 41, 3.06, 200)[20], 60, axis=0)
    return read_apt(apt_text(around(rows, (20.0,)), TOOL, "blade", 900.0, 8000.0))


def test_it_turns_back_no_more_and_is_proven_against_the_blade(found) -> None:
    made = reschedule(found, TOOL, faces=(loft("turbine"),))
    assert made.clear and made.before.backwards > 0 and made.after.backwards == 0
    assert made.after.steepest < 0.7 * made.before.steepest
    new = made.locations
    assert np.allclose(new.tip + 3 * new.axis, found.tip + 3 * found.axis, atol=1e-9)
    assert new.feedrate.tolist() == found.feedrate.tolist() and new.spindle == 8000.0


@pytest.mark.parametrize(("moved", "said"), [
    ((0.0, -0.3, 0.0), r"the cutter goes 0\.\d+ mm into face"), ((0.0, 60.0, 0.0), r"the shank goes \d\.\d+ mm into")])
def test_what_meets_the_part_is_refused_with_place_and_amount(found, moved, said) -> None:
    turn = np.eye(4)
    turn[:3, 3] = moved
    with pytest.raises(InvalidInput, match=said):
        reschedule(found, TOOL, faces=(loft("turbine").transformed(turn),))


def ring(radius: float) -> ToolPath:
    """Once around the blade of the examples, which stands along x."""
    angle = np.linspace(0, 2 * np.pi, 72, endpoint=False)
    path = around(radius * np.column_stack([np.cos(angle), np.sin(angle)]), (30.0,), 4.0)
    order = [2, 0, 1]
    return ToolPath(path.cc[:, order], path.cl[:, order], path.axis[:, order], path.normal[:, order], path.kind,
                    path.breaks)


def test_the_command_writes_what_post_takes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tool, file, part = ta.Tool.ball(8), tmp_path / "made.apt", str(ROOT / "examples" / "blade.step")
    file.write_text(apt_text(ring(48.0), tool, "blade", 900.0, 8000.0))
    words = ["reschedule", str(file), "--tool", "ball:8", "--part", part, "--machine", "four-axis-a", "--json"]
    assert main(words) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["held_against_part"] and told["turns"] == 1 and told["re_scheduled"]["turns_back"] == 0
    assert main(["post", told["file"], "--dialect", "siemens", "--machine", "four-axis-a", "--retract", "400"]) == 0
    capsys.readouterr()
    program = ta.read_cl(tmp_path / "made-rescheduled-siemens.mpf", "four-axis-a")
    assert np.allclose(ta.read_cl(told["file"]).tip[-1], program.tip[-1], atol=1e-5)
    assert main([*words[:-1], "--about", "1,0"]) == 2 and "--about 1,0 is no direction" in capsys.readouterr().err
