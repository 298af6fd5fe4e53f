"""The plans of earlier setups out of their document, for the plan of the next one."""

from freecad.toolaxis.document.earlier_setups import operations_of, setups_up_to
from freecad.toolaxis.document.kinds import is_plan
from freecad.toolaxis.document.plan_group import why_stale as why_plan_stale
from freecad.toolaxis.document.stale_label import plain_label
from freecad.toolaxis.document.staleness import why_stale
from freecad.toolaxis.services.export import plan_task


def earlier_plans_task(inputs):
    """The plans of all setups before a plan's own, as a computation apart from the document.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs

    Returns
    -------
    callable
        Takes a `toolaxis.progress.Progress` and returns a list of `toolaxis.plan.plan.Plan`, the first one first; for
        any thread.

    Raises
    ------
    InvalidInput
        When one of them does not hold any more.
    """
    setups = setups_up_to(inputs.after)
    for setup in setups:
        _check_holds(setup)
    tasks = [plan_task(operations_of(setup)) for setup in setups]

    def compute(progress):
        return [read(progress) for read in tasks]

    return compute


def _check_holds(setup):
    """Refuse an earlier setup whose results do not hold any more: what it leaves is not known."""
    from toolaxis.errors import InvalidInput

    reasons = why_plan_stale(setup) if is_plan(setup) else why_stale(setup)
    if reasons:
        raise InvalidInput(f"the earlier setup '{plain_label(setup)}' is out of date ({'; '.join(reasons)}): recompute "
                           "it first")
