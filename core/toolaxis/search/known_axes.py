"""Axes that are known already: where no other one can do much better, the first of them that serves is taken."""

from toolaxis.feasibility.violations import FREE
from toolaxis.search.candidate_check import CheckedCandidate, check_candidate
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.local_search import CountedAxis, count_row, proven, sound
from toolaxis.search.machine_limits import snap_to_increments
from toolaxis.search.messages import AS_GOOD, KNOWN_AXIS
from toolaxis.work import allow_proof

#: Known axes that the proof may refuse before others are looked for.
_REFUSED = 2


def find_known_axis(job: FaceProblem, ledger: AxisTable) -> tuple[CheckedCandidate, str] | None:
    """The first of the axes from which a search begins beside which no better one is worth a search.

    That is where the cut is short, what is left as rest material charged; and with a ball end where it reaches the
    whole face, as its strips are as wide under all such axes.

    Parameters
    ----------
    job : FaceProblem
        With the length of a cut that takes as long as an index move, which is short enough; 0 where the best axis is to
        be found in any case.
    ledger : AxisTable
        Empty, with the axes to begin from; they stand in it afterwards.

    Returns
    -------
    tuple of CheckedCandidate and str, or None
        With why no better one is looked for; None where none of them is good enough, or the proof refuses the first
        ones.

    Raises
    ------
    Cancelled, OutOfWork
    """
    if job.worth.index_length <= 0 or not len(ledger.starts):
        return None
    rows, refused = ledger.look(ledger.starts), 0
    ledger.starts = ledger.starts[:0]
    for row in range(rows.start, rows.stop):
        one = _count_where_good(job, ledger, row)
        if one is None:
            continue
        allow_proof()
        done = check_candidate(job, one)
        if done.proof.witness is None:
            return done, KNOWN_AXIS if _is_short(job, one) else AS_GOOD
        refused += 1
        if refused == _REFUSED:
            break
    return None


def _count_where_good(job: FaceProblem, ledger: AxisTable, row: int) -> CountedAxis | None:
    """A row as a candidate that the machine can hold; None where another axis may be much better, or it does not serve.
    """
    feed = int(ledger.values[row].argmin())
    as_good = _is_as_good(job, ledger, row)
    if ledger.reason[row] != FREE or not (as_good or ledger.length[row, feed] <= job.worth.index_length):
        return None
    if not sound(ledger, row) or not proven(ledger, row):
        return None
    held = snap_to_increments(ledger, [count_row(ledger, row, feed)])
    return held[0] if held and (as_good or _is_short(job, held[0])) else None


def _is_as_good(job: FaceProblem, ledger: AxisTable, row: int) -> bool:
    """Whether an axis of a ball end leaves nothing to a clean-up tool, and the least length is what is asked for."""
    return job.worth.objective == "length" and job.worth.tool.flat_radius == 0 and ledger.unreached[row] == 0


def _is_short(job: FaceProblem, one: CountedAxis) -> bool:
    """Whether a cut, what it leaves charged, takes no longer than an index move."""
    return one.length * job.worth.charge(one.length, one.unreached) <= job.worth.index_length
