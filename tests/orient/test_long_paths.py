"""Paths of very many motions: decided like others, refused early, and not looked at again where they are known."""

import numpy as np
import pytest

from toolaxis import Tool
from toolaxis.cldata.toolpath import Motion
from toolaxis.search import face_problem, path_check
from toolaxis.work import Budget, limit_work

TOOL = Tool.torus(10, 2, stickout=40, holder=[(12, 0), (12, 20)])
AXIS = np.array([0.1, -0.5, 1.0]) / np.linalg.norm([0.1, -0.5, 1.0])


@pytest.fixture(scope="module")
def walled(make):
    part = make.floor_and_wall()
    job = face_problem.task(part.faces[0], TOOL, 0.1, part=part)
    return job, job.made(AXIS, "u")


@pytest.fixture
def as_long(monkeypatch):
    """Every path counts as long."""
    monkeypatch.setattr(path_check, "_LONG", 10)
    monkeypatch.setattr(path_check, "_SPREAD", 40)


def work_of(job, path, known=None):
    with limit_work(Budget(1e9)) as budget:
        found = path_check.prove(path, TOOL, job.groups, known=known)
    return found, budget.done


def test_a_long_path_keeps_its_limits_and_clearances(walled, as_long, monkeypatch):
    job, path = walled
    found, _ = work_of(job, path)
    monkeypatch.undo()
    usual, _ = work_of(job, path)
    assert found.witness is None and usual.witness is None
    assert usual.gouge <= found.gouge <= job.feasibility.tolerance.gouge + 1e-12
    for name, value in usual.clearance.items():
        assert found.clearance[name] == pytest.approx(value, abs=0.011)


def test_a_long_path_that_breaks_a_limit_is_refused_at_the_motion_that_does(walled, as_long):
    job, path = walled
    lowered = path.cl.copy()
    lowered[len(lowered) // 2] -= 3.0 * AXIS
    found = path_check.prove(type(path)(path.cc, lowered, path.axis, path.normal, path.kind, path.breaks), TOOL,
                             job.groups)
    assert found.witness is not None
    assert set(found.blocked) == {len(lowered) // 2 - 1, len(lowered) // 2}


def test_a_path_that_gouges_all_over_is_refused_after_few_motions(walled, as_long):
    job, path = walled
    sunk = type(path)(path.cc, path.cl - 0.5 * AXIS, path.axis, path.normal, path.kind, path.breaks)
    found, little = work_of(job, sunk)
    _, usual = work_of(job, path)
    assert found.witness is not None and not len(found.blocked)
    assert little < 0.7 * usual


def test_what_is_known_is_not_looked_at_again(walled, as_long):
    job, path = walled
    known = path_check.ProvenMotions()
    proof, first = work_of(job, path, known)
    again, second = work_of(job, path, known)
    assert again.witness is None and again.clearance == proof.clearance
    assert second < 0.8 * first


def test_motions_that_follow_each_other_keep_together_only_what_each_keeps(walled):
    job, path = walled
    moves = path_check.segment_motions(path.cl, path.axis[0])
    for group in job.groups:
        for clearance in (0.5, 2.0, 5.0):
            required = np.array([-np.inf, clearance, clearance])
            alone = path_check.keeps_limits(group.cells, TOOL, moves, np.tile(required, (len(group.faces), 1)))
            blocked = path_check._find_blocked(TOOL, group, moves, required)
            assert (blocked == np.flatnonzero(alone.blocked >= 0)).all()


def test_motions_are_found_again_to_the_last_digit(monkeypatch):
    rng = np.random.default_rng(3)
    moves = rng.normal(size=(400, 3, 3))
    moves[7, 0, 0] = 0.0
    for same_key in (False, True):
        if same_key:
            monkeypatch.setattr(path_check, "_keys_of", lambda rows: np.zeros(len(rows), dtype=np.uint64))
        known = path_check.ProvenMotions()
        assert len(known.find_blocked(0, known.enter(moves), lambda some: some[:0])) == 0
        again = moves[::-1].copy()
        again[5, 1, 2] = np.nextafter(again[5, 1, 2], np.inf)
        again[392, 0, 0] = -0.0
        asked = []
        known.find_blocked(0, known.enter(again), lambda some: asked.append(some) or some[:0])  # noqa: B023
        assert 5 in asked[0] and (same_key or len(asked[0]) == 1)
        blocked = known.find_blocked(1, known.enter(moves), lambda some: np.array([0, 3]))
        assert len(blocked) == 2
        left = known.find_blocked(1, known.enter(moves), lambda some: np.arange(len(some)))
        assert set(left) >= set(blocked) and (same_key or len(left) == 2)


def test_no_depth_is_looked_for_beyond_the_deepest_that_may_be(walled, monkeypatch):
    job, path = walled
    moves = path_check.segment_motions(path.cl, path.axis[0])
    group = job.groups[0]
    first = next(k for k in range(0, len(moves), path_check._STRIDE) if path.kind[k + 1] == Motion.CUT)
    assert first < 10 * path_check._STRIDE
    moves[first, 0] -= 0.5 * AXIS  # deeper than may be
    asked, bounds = [], path_check.lower_bounds
    monkeypatch.setattr(path_check, "_BATCH", 10)
    monkeypatch.setattr(path_check, "lower_bounds", lambda *some: asked.append(len(some[2])) or bounds(*some))
    depth = path_check.greatest_depth(TOOL, group, moves, 0.0)
    assert depth == pytest.approx(-group.required[0], rel=1e-9)
    assert len(moves) > 100 and sum(asked) == 10
