"""Five axes with a constant lead: bounds that hold while the axis turns, and the best lead of those allowed."""

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.frame import contact_frame, lead_tilt_from_axis
from toolaxis.feasibility.surroundings import SKIN, CheckSurfaces
from toolaxis.machine.limits import parse_limits
from toolaxis.path.moving_axis import MovingChart
from toolaxis.search.face_problem import task
from toolaxis.shape.nearest import nearest
from toolaxis.strategies.common.links import LinkMotion
from toolaxis.strategies.common.passes import make_passes
from toolaxis.strategies.common.path_check import (
    MovingLinkClearance,
    PathMotions,
    keeps_distance,
    prove_moving,
    spans_of,
    standing,
)
from toolaxis.strategies.constant_lead.search import ConstantLeadSearch, sturz
from toolaxis.tools.tool import Tool

from .conftest import bowl, flat, floor_and_wall, seeded  # type: ignore[import-not-found]

TOOL = Tool.torus(12, 1, stickout=40, holder=[(14, 0), (14, 30)])
H = 0.05
WALL = flat([30, -50, -50], [0, 0, 200], [0, 100, 0])


def _swing(far_deg: float) -> PathMotions:
    """The tip stands at the origin while the axis turns from upright towards the wall at x = 30."""
    far = np.radians(far_deg)
    zero, up = np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]])
    return PathMotions(zero, zero, up, np.array([[np.sin(far), 0.0, np.cos(far)]]))


def _corner(far_deg: float) -> float:
    """Greatest x that the holder's rim reaches, mm."""
    turn = np.radians(np.linspace(0, far_deg, 400))
    return float((14 * np.cos(turn) + 70 * np.sin(turn)).max())


@pytest.mark.parametrize("far_deg", [8.0, 12.5])
def test_what_turns_is_kept_from_a_wall_to_a_hair(far_deg: float) -> None:
    group = CheckSurfaces("other", (WALL,), np.array([-np.inf, -np.inf, 0.0]))
    room = 30 - _corner(far_deg)
    for margin, free in ((-0.06, True), (0.002, False)):
        required = np.array([-np.inf, -np.inf, room + margin])
        assert keeps_distance(TOOL, group, _swing(far_deg), required).tolist() == [free]


def test_a_swing_through_a_wall_is_not_free_though_both_ends_are() -> None:
    post = flat([40, -1, 40], [10, 0, 0], [0, 0, 30])  # between the axes at +45 and -45 deg about y
    side = np.radians(45.0)
    ends = [np.array([[np.cos(side), s * np.sin(side), 0.9]]) for s in (-1, 1)]
    before, after = (one / np.linalg.norm(one) for one in ends)
    tip = np.zeros((1, 3))
    crossing = MovingLinkClearance(TOOL, (CheckSurfaces("other", (post,), np.array([0.1, 0.5, 1.0])),))
    assert all(crossing.clear(tip, tip, one, one, LinkMotion.CROSSING).all() for one in (before, after))
    assert not crossing.clear(tip, tip, before, after, LinkMotion.CROSSING).any()


@pytest.fixture(scope="module")
def found():
    face = seeded(5, 0.5)
    job = task(face, TOOL, H)
    return job, *sturz(job)


def test_the_lead_is_free_and_constant(found) -> None:
    job, orientation, path = found
    assert orientation.outcome == "feasible" and path is not None, orientation.reasons
    assert any("checked at points" in why for why in orientation.reasons)
    cut = path.kind == Motion.CUT
    uv = nearest(job.worth.face, path.cc[cut]).uv
    inside = ((uv > 1e-6) & (uv < 1 - 1e-6)).all(axis=1)
    frame = contact_frame(job.worth.face, uv[inside], orientation.feed)
    lead, tilt = lead_tilt_from_axis(frame, path.axis[cut][inside])
    assert np.allclose(lead, orientation.lead, atol=1e-4) and np.allclose(tilt, 0, atol=1e-4)
    assert orientation.gouge <= job.feasibility.tolerance.gouge == 0.01 and orientation.passes == path.passes > 1


def test_no_smaller_lead_is_free(found) -> None:
    job, orientation, _ = found
    search = ConstantLeadSearch(job)
    assert orientation.lead is not None and search.free(orientation.lead, orientation.feed)
    candidates = search.candidates()
    best = min(one.length for one in candidates)
    assert orientation.length < 1.15 * best
    assert all(search.free(one.lead, one.feed) for one in candidates)


def test_a_lead_outside_the_limits_of_the_axis_is_not_free() -> None:
    """Over a plane with its normal up every lead is free; a cone about the normal allows those inside it."""
    floor = flat([-15, -15, 0], [30, 0, 0], [0, 30, 0])
    search = ConstantLeadSearch(task(floor, TOOL, H, parse_limits("cone:0,0,1,12")))
    assert search.free(np.radians(11.5), "u") and not search.free(np.radians(12.5), "u")
    assert all(abs(one.lead) <= np.radians(12.0) for one in search.candidates())


def test_a_bowl_asks_for_the_lead_at_which_the_heel_clears_it() -> None:
    """A flat end in a bowl: its heel clears the far side from sin(lead) = radius / curvature on, to first order."""
    search = ConstantLeadSearch(task(bowl(60.0, 10.0), Tool.flat(10), H))
    free = min(abs(one.lead) for one in search.candidates())
    assert 0.9 < free / np.arcsin(5.0 / 60.0) < 1.25


def test_a_lead_that_gouges_is_found_out_at_points() -> None:
    job = task(bowl(60.0, 10.0), Tool.flat(10), H)
    search = ConstantLeadSearch(job)
    _, path = make_passes(job, MovingChart(job.worth.face, "u"), search.cut(np.radians(2.0), "u"))
    witness = prove_moving(path, job.worth.tool, job.groups).witness
    assert witness is not None and witness.distance < -0.01


def test_what_is_proven_alone_is_proven_beside_wider_turns() -> None:
    """Two motions over a plane: one just over it that hardly turns, one a little higher that turns by a degree."""
    tool, floor = Tool.ball(6), flat([-50, -50, 0], [100, 0, 0], [0, 100, 0])
    tips = np.array([[0, 0, 0.004], [0, 1, 0.004], [0, 1, 0.012], [0, 2, 0.012]])
    axes = np.array([[np.sin(a), 0, np.cos(a)] for a in (0, 1e-4, 1e-4, 2e-2)])
    path = ToolPath(tips, tips, axes, np.tile([0.0, 0, 1], (4, 1)), np.full(4, Motion.LINK, dtype=np.int8),
                    np.array([0, 4]))
    groups = task(floor, tool, H, tolerance=0.002).groups
    skin = next(group for group in groups if group.role == SKIN)
    spans = spans_of(path)
    assert not keeps_distance(tool, skin, spans, skin.required).all()
    assert all(keeps_distance(tool, skin, spans.rows(np.array([k])), skin.required)[0] for k in range(3))
    assert prove_moving(path, tool, groups).witness is None


def test_positions_looked_at_lie_close() -> None:
    job = task(seeded(5, 0.5), TOOL, H)
    _, path = make_passes(job, MovingChart(job.worth.face, "v"), ConstantLeadSearch(job).cut(np.radians(20.0), "v"))
    spans = spans_of(path).rows(np.flatnonzero(path.kind[1:] == Motion.CUT))
    tips = standing(spans)[:, 0]
    for share in (0.0, 0.3, 0.77, 1.0):
        at = spans.start + share * (spans.end - spans.start)
        near = np.linalg.norm(tips[None] - at[::7, None], axis=2).min(axis=1)
        assert near.max() <= (0.25 if 0 < share < 1 else 0) + 1e-9


def test_where_no_lead_is_free_the_reasons_say_so() -> None:
    part = floor_and_wall()
    orientation, path = sturz(task(part.face(1), TOOL, H, part=part))
    assert path is None and orientation.axis is None and "no constant lead" in orientation.reasons[-1]
