"""The other feed of an axis whose passes are proven, where it takes less."""

from contextlib import suppress
from dataclasses import replace

from toolaxis.search.candidate_check import CheckedCandidate, check_candidate
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.local_search import CountedAxis
from toolaxis.work import OutOfWork

#: Share of what is to be least that the other feed has to save by its count: passes that are added may take that much.
_WORTHWHILE = 0.01


def check_other_feed(job: FaceProblem, ledger: AxisTable, done: CheckedCandidate) -> CheckedCandidate | None:
    """The same axis with the other feed, made and proven.

    Screening chose the feed, and it does not see which passes have to be added.  None where the other one takes no
    less, or the work that is allowed does not suffice to tell.

    Parameters
    ----------
    job : FaceProblem
    ledger : AxisTable
    done : CheckedCandidate
        Proven.
    """
    if job.worth.feed is not None:
        return None
    one, feed = done.one, 1 - done.one.feed
    index_move = job.worth.index_length if job.worth.objective == "length" else 0.0
    with suppress(OutOfWork):  # what is proven stays proven
        other = CountedAxis(one.axis, feed, *ledger.count(one.axis, feed, one.unreached), one.unreached)
        if done.value - other.value > max(index_move, _WORTHWHILE * done.value):
            again = check_candidate(replace(job, laid_for=done.laid_for), other)
            return again if again.proof.witness is None and again.value < done.value else None
    return None
