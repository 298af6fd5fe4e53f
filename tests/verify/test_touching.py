"""Faces behind a convex edge: a cutter may run out over the edge and touch them, and must not enter them."""

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.profile import Profile
from toolaxis.verify.task import Task
from toolaxis.verify.verdict import OperationVerdict, verify

BALL = Profile(0.0, 5.0, 0.0, 20.0)


def plane(corner: list[float], along: list[float], up: list[float], label: str) -> Face:
    s, t = np.meshgrid(np.linspace(0, 1, 4), np.linspace(0, 1, 4), indexing="ij")
    points = np.asarray(corner) + s[..., None] * np.asarray(along) + t[..., None] * np.asarray(up)
    face = Face.from_bspline(points)
    return face.trimmed((), label)


TOP = plane([0, 0, 0], [20, 0, 0], [0, 10, 0], "top")
SIDE = plane([20, 0, -60], [0, 10, 0], [0, 0, 60], "side")


def judged(extra: list[list[float]], touching: tuple[Face, ...] = (SIDE,)) -> OperationVerdict:
    rows = [[x, y, 0.0] for k, y in enumerate(np.arange(-0.5, 10.6, 0.8)) for x in ((-6, 26) if k % 2 else (26, -6))]
    tips = np.array([*rows, *extra])
    axes, kind = np.tile([0.0, 0.0, 1.0], (len(tips), 1)), np.full(len(tips), Motion.CUT)
    return verify([Task("top", tips, axes, kind, BALL, (TOP,), 0.02, touching=touching,
                        tolerance=Tolerance(gouge=0.002))], spacing=0.5).operations[0]


def test_running_out_over_the_edge_is_no_gouge() -> None:
    found = judged([])
    assert found.passed, found.reasons
    assert found.gouge_max <= 1e-6


@pytest.mark.parametrize("depth", [0.005, 0.05])
def test_entering_the_side_is_found_and_measured(depth: float) -> None:
    found = judged([[26.0, 5.0, 5.0], [26.0, 5.0, -45.0], [25.0 - depth, 5.0, -45.0], [26.0, 5.0, -45.0]])
    assert not found.passed
    # Rays of the top that stand on the lost rim go down beside the cutter's side: they may tell more, never less.
    assert found.gouge_max >= depth - 1e-6
    measured = [float(reason.split()[1]) for reason in found.reasons if "face side" in reason and "convex" in reason]
    assert measured == [pytest.approx(depth, abs=1e-3)]


def test_a_gouge_within_the_tolerance_passes() -> None:
    found = judged([[26.0, 5.0, 5.0], [26.0, 5.0, -45.0], [25.0 - 0.001, 5.0, -45.0], [26.0, 5.0, -45.0]])
    assert found.passed, found.reasons
    assert found.gouge_max == pytest.approx(0.001, abs=6e-4)
