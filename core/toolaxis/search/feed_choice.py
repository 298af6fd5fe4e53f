"""The other feed of an axis whose passes are proven, where it takes less."""

from dataclasses import replace

from toolaxis.search.candidate_check import CheckedCandidate, check_candidate
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.local_search import CountedAxis

#: Share of what is to be least that the other feed has to save by its count: passes that are added may take that much.
_WORTHWHILE = 0.01


def check_other_feed(job: FaceProblem, ledger: AxisTable, done: CheckedCandidate) -> CheckedCandidate | None:
    """The same axis with the other feed, made and proven.

    None where it takes no less: screening chose the feed, and it does not see which passes have to be added.

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
    other = CountedAxis(one.axis, feed, *ledger.count(one.axis, feed, one.unreached), one.unreached)
    index_move = job.worth.index_length if job.worth.objective == "length" else 0.0
    if not done.value - other.value > max(index_move, _WORTHWHILE * done.value):
        return None
    again = check_candidate(replace(job, laid_for=done.laid_for), other)
    return again if again.proof.witness is None and again.value < done.value else None
