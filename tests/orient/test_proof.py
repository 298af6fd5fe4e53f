"""What the proof of a path says in figures."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis import Tolerance, Tool
from toolaxis.search import face_problem
from toolaxis.search import path_check as proof


@pytest.fixture
def loosely(monkeypatch):
    """Measuring that gives up early: true bounds, 1.5 mm below the distances."""
    measured = proof.lower_bounds

    def loose(*asked):
        found = measured(*asked)
        return found._replace(lower=found.lower - 1.5)

    monkeypatch.setattr(proof, "lower_bounds", loose)


def test_figures_are_never_worse_than_what_is_proven(loosely, make):
    part, tolerance = make.floor_and_wall(), Tolerance()
    tool = Tool.torus(10, 2, stickout=40, holder=[(12, 0), (12, 20)])
    job = face_problem.task(part.faces[0], tool, 0.1, part=part, tolerance=tolerance)
    axis = np.array([0.1, -0.5, 1.0])
    found = proof.prove(job.made(axis / np.linalg.norm(axis), "u"), tool, job.groups)
    assert found.witness is None
    assert 0.0 <= found.gouge <= tolerance.gouge
    assert found.clearance["cutter"] >= tolerance.cutter_clearance


def test_what_is_proven_once_is_not_asked_again_and_new_motions_are(make, monkeypatch):
    part, tolerance = make.floor_and_wall(), Tolerance()
    tool = Tool.torus(10, 2, stickout=40, holder=[(12, 0), (12, 20)])
    job = face_problem.task(part.faces[0], tool, 0.1, part=part, tolerance=tolerance)
    axis = np.array([0.1, -0.5, 1.0])
    path = job.made(axis / np.linalg.norm(axis), "u")
    asked = []
    looked = proof.keeps_limits
    monkeypatch.setattr(proof, "keeps_limits", lambda *ask: asked.append(len(ask[2])) or looked(*ask))
    known = proof.ProvenMotions()
    first = proof.prove(path, tool, job.groups, known=known)
    assert first.witness is None and sum(asked) > 0
    asked.clear()
    again = proof.prove(path, tool, job.groups, known=known)
    assert sum(asked) == 0 and (again.gouge, again.clearance) == (first.gouge, first.clearance)
    lower = path.cl.copy()
    k = int(np.flatnonzero(path.kind[1:] == 0)[40]) + 1
    lower[k] -= 0.2 * path.axis[0]
    deep = replace(path, cl=lower)
    fresh, told = proof.prove(deep, tool, job.groups), proof.prove(deep, tool, job.groups, known=known)
    assert fresh.witness is not None and told.witness is not None
    assert told.witness.reason == fresh.witness.reason
    assert np.array_equal(told.blocked, fresh.blocked)
    assert proof.prove(deep, tool, job.groups, known=known).witness is not None  # what was refused stays so


def test_the_depth_is_that_of_the_deepest_motion(make):
    part, tolerance = make.floor_and_wall(), Tolerance()
    tool = Tool.ball(10, stickout=40)
    job = face_problem.task(part.faces[0], tool, 0.1, part=part, tolerance=tolerance)
    path = job.made(np.array([0.0, -np.sin(0.4), np.cos(0.4)]), "u")
    group, moves = job.groups[0], proof.segment_motions(path.cl, path.axis[0])
    cuts = moves[path.kind[1:] == 0]
    for row in (3, len(cuts) // 2, len(cuts) - 2):
        one = cuts.copy()
        one[row, 0, 2] -= 0.006
        depth = proof.greatest_depth(tool, group, one, 0.0)
        alone = proof.greatest_depth(tool, group, one[[row]], 0.0)
        assert alone > 0.003
        assert depth == pytest.approx(alone, abs=proof.FINE)
