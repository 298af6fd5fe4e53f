"""Axes that are known already: where a cut takes less time than an index move, the first one that serves is taken."""

from toolaxis.feasibility.violations import FREE
from toolaxis.search.candidate_check import CheckedCandidate, check_candidate
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.local_search import CountedAxis, count_row, proven, sound
from toolaxis.search.machine_limits import snap_to_increments

#: Known axes that are put to the proof at most.
_PROVEN = 2


def find_known_axis(job: FaceProblem, ledger: AxisTable) -> CheckedCandidate | None:
    """The first of the axes from which a search begins with which a sub-surface is machined quickly enough.

    Parameters
    ----------
    job : FaceProblem
        With the cutting length that is short enough for no better axis to be looked for.
    ledger : AxisTable
        Empty, with the axes to begin from; they stand in it afterwards.

    Returns
    -------
    CheckedCandidate or None
        None where nothing is short enough, what is left to a clean-up tool charged, or the proof refuses the first
        ones.

    Raises
    ------
    Cancelled, OutOfWork
    """
    if job.enough <= 0 or not len(ledger.starts):
        return None
    rows, tried = ledger.look(ledger.starts), 0
    ledger.starts = ledger.starts[:0]
    for row in range(rows.start, rows.stop):
        short = ledger.length[row].min() <= job.enough and ledger.reason[row] == FREE
        if not short or not sound(ledger, row) or not proven(ledger, row):
            continue
        held = snap_to_increments(ledger, [count_row(ledger, row)])
        if not held or not _charge_length(job, held[0]) <= job.enough:
            continue
        done = check_candidate(job, held[0])
        if done.proof.witness is None:
            return done
        tried += 1
        if tried == _PROVEN:
            break
    return None


def _charge_length(job: FaceProblem, one: CountedAxis) -> float:
    """Cutting length of a candidate with what it leaves charged, mm; infinite where it leaves no strip."""
    return one.length * job.worth.charge(one.length, one.unreached)
