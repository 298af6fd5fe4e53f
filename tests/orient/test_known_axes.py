"""Where a cut takes less time than an index move, an axis that is known is taken, and only if its passes are proven."""

from dataclasses import replace

import numpy as np
import pytest
from tests.orient.conftest import seeded

from toolaxis import Tool
from toolaxis.feasibility.violations import CUTTER, Violation
from toolaxis.numeric.vectors import unit
from toolaxis.search import known_axes
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.search.fixed_axis import find_axis
from toolaxis.search.messages import AS_GOOD, KNOWN_AXIS
from toolaxis.work import Budget, limit_work

TOOL, SCALLOP = Tool.torus(6, 1, stickout=40), 0.05
LEANING = unit(np.array([0.1, 0.25, 1.0]))
#: It sees next to nothing of the face.
FLAT = unit(np.array([1.0, 0.0, 0.05]))


def with_index_moves(job: FaceProblem, length: float) -> FaceProblem:
    """The same problem where an index move takes as long as a cut of a length, mm."""
    return replace(job, worth=replace(job.worth, index_length=length))


@pytest.fixture(scope="module")
def problem() -> FaceProblem:
    return task(seeded(3, height=0.1), TOOL, SCALLOP)


def test_the_first_known_axis_that_serves_is_taken_as_it_is(problem: FaceProblem) -> None:
    found, path = find_axis(with_index_moves(problem, 1e6), starts=[FLAT, LEANING, [0.0, 0.0, 1.0]])
    assert np.array_equal(found.axis, LEANING) and path is not None
    assert KNOWN_AXIS in found.reasons
    searched, _ = find_axis(problem, starts=[LEANING])
    assert searched.evaluations > 5 * found.evaluations
    assert found.unreached == 0
    assert searched.length < found.length, "a long cut would be worth the search"


@pytest.mark.parametrize("length", [0.0, 50.0], ids=["with one tool", "of a long cut"])
def test_a_better_axis_is_looked_for_otherwise(problem: FaceProblem, length: float) -> None:
    found, _ = find_axis(with_index_moves(problem, length), starts=[LEANING])
    assert KNOWN_AXIS not in found.reasons
    assert not np.array_equal(found.axis, LEANING)


def test_a_ball_end_that_reaches_all_needs_no_search_however_long_its_cut(problem: FaceProblem) -> None:
    ball = task(problem.worth.face, Tool.ball(6, stickout=40), SCALLOP)
    found, path = find_axis(with_index_moves(ball, 1.0), starts=[LEANING])
    assert np.array_equal(found.axis, LEANING) and path is not None
    assert AS_GOOD in found.reasons and found.length > 1.0
    searched, _ = find_axis(ball, starts=[LEANING])
    assert found.length == pytest.approx(searched.length, rel=0.02)


def test_the_proof_of_a_known_axis_has_the_work_that_is_kept_back(monkeypatch: pytest.MonkeyPatch) -> None:
    """Found when read again: a long cut of a ball end would have run out of work in the middle of its proof."""
    begun: list[float] = []
    real = known_axes.check_candidate

    def note(*asked):
        begun.append(budget.done)
        return real(*asked)

    def found_within(limit: float, more: float) -> str:
        nonlocal budget
        budget = Budget(limit, more=more)
        fresh = task(seeded(3, height=0.1), Tool.ball(6, stickout=40), SCALLOP)  # nothing is known from before
        with limit_work(budget):
            return find_axis(with_index_moves(fresh, 1.0), starts=[LEANING])[0].outcome

    budget = Budget(1e6)
    monkeypatch.setattr(known_axes, "check_candidate", note)
    assert found_within(1e6, 0.0) == "feasible"
    limit = 1.02 * begun[0]  # it suffices to look at the axis, and not for its passes
    assert found_within(limit, 0.0) == "not_found"
    assert found_within(limit, 3.0) == "feasible"


def test_an_axis_that_the_proof_refuses_is_not_taken(problem: FaceProblem, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only what `check_candidate` accepts is taken; after a few refusals the search goes on as ever."""
    asked = []
    real = known_axes.check_candidate

    def refuse(job, one):
        asked.append(one.axis)
        done = real(job, one)
        return done._replace(proof=replace(done.proof, witness=Violation(CUTTER, 0.0, words="refused")))

    monkeypatch.setattr(known_axes, "check_candidate", refuse)
    starts = [LEANING, *(unit(np.array([0.1, 0.25 + 0.02 * k, 1.0])) for k in range(1, 5))]
    found, path = find_axis(with_index_moves(problem, 1e6), starts=starts)
    assert len(asked) == known_axes._REFUSED
    assert path is not None and KNOWN_AXIS not in found.reasons
