"""Faces behind a convex edge: a cutter may run out over the edge and touch them, and must not enter them."""

import numpy as np
import pytest
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.clearance.gouge import RESOLUTION
from toolaxis.feasibility.surroundings import SKIN, TOUCHING, CheckSurfaces
from toolaxis.search.path_check import prove
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.profile import Profile
from toolaxis.tools.tool import Tool
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.verdict import OperationVerdict, verify

BALL = Profile(0.0, 5.0, 0.0, 20.0)


def plane(corner: list[float], along: list[float], up: list[float], label: str) -> Face:
    s, t = np.meshgrid(np.linspace(0, 1, 4), np.linspace(0, 1, 4), indexing="ij")
    points = np.asarray(corner) + s[..., None] * np.asarray(along) + t[..., None] * np.asarray(up)
    face = Face.from_bspline(points)
    return face.trimmed((), label)


TOP = plane([0, 0, 0], [20, 0, 0], [0, 10, 0], "top")
SIDE = plane([20, 0, -60], [0, 10, 0], [0, 0, 60], "side")


def locations(extra: list[list[float]]) -> NDArray[np.float64]:
    """Tips of passes over the top that run out over the edge, and more."""
    rows = [[x, y, 0.0] for k, y in enumerate(np.arange(-0.5, 10.6, 0.8)) for x in ((-6, 26) if k % 2 else (26, -6))]
    return np.array([*rows, *extra])


def judged(extra: list[list[float]], touching: tuple[Face, ...] = (SIDE,), allowed: float = 0.002) -> OperationVerdict:
    tips = locations(extra)
    axes, kind = np.tile([0.0, 0.0, 1.0], (len(tips), 1)), np.full(len(tips), Motion.CUT)
    return verify([VerificationTask("top", tips, axes, kind, BALL, (TOP,), 0.02, touching=touching,
                                    tolerance=Tolerance(gouge=allowed))], spacing=0.5).operations[0]


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


@pytest.mark.parametrize("depth", [0.0, 0.003, 0.008])
def test_planner_and_judge_tell_the_same_depth_behind_an_edge(depth: float) -> None:
    extra = [[26.0, 5.0, 5.0], [26.0, 5.0, -45.0], [25.0 - depth, 5.0, -45.0], [26.0, 5.0, -45.0]]
    found = judged(extra, allowed=0.01)
    assert found.passed, found.reasons
    tips, tolerance = locations(extra), Tolerance(gouge=0.01)
    axis, kind = np.tile([0.0, 0.0, 1.0], (len(tips), 1)), np.full(len(tips), Motion.CUT)
    path = ToolPath(tips, tips, axis, axis, kind, np.array([0, len(tips)]))
    groups = [CheckSurfaces(role, (face,), np.array([-tolerance.gouge, -np.inf, -np.inf]), None)
              for role, face in ((SKIN, TOP), (TOUCHING, SIDE))]
    proof = prove(path, Tool.ball(10), tuple(groups))
    assert proof.witness is None
    assert proof.gouge == pytest.approx(depth, abs=RESOLUTION)
    assert proof.gouge >= found.gouge_max - RESOLUTION
    places = [place for place in found.worst_gouge if place.face == "side"]
    assert len(places) == (depth > 0.0)
    for place in places:
        assert place.value == pytest.approx(depth, abs=1e-4)
        assert SIDE.evaluate(np.array([place.uv])).point[0] == pytest.approx(place.point, abs=1e-6)
