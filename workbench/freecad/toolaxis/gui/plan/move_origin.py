"""Another origin or stock for the plan that the panel shows: axes and passes stay, nothing is computed again."""

from dataclasses import replace

from freecad.toolaxis.document.work_origin import setup_of
from freecad.toolaxis.services.background import sentence


def move_origin(panel):
    """Give the plan that a panel shows the origin and the stock of its fields.

    Parameters
    ----------
    panel : freecad.toolaxis.gui.plan.panel.PlanPanel

    Returns
    -------
    bool
        Whether there is such a plan: else what was changed counts for the next one.
    """
    from toolaxis.errors import ToolAxisError
    from toolaxis.job.planning.edit_origin import with_origin

    if panel.work is not None or panel.view.plan is None or panel.computed is None or panel.outrun:
        return False
    setup = panel.fields.setup
    wanted = replace(panel.computed, origin=setup.origin, stock_box=setup.stock_box)
    panel.refusal = panel.fields.refusal()
    if not panel.refusal:
        try:
            origin, datum = setup_of(wanted)
            _move_view(panel.view, lambda plan: with_origin(plan, origin, wanted.stock_box, datum))
            panel.computed = wanted
        except ToolAxisError as reason:
            panel.refusal = sentence(reason)
    panel.show_state()
    return True


def _move_view(view, move):
    """Replace the plan that is shown and the one that was found; operations that are the same in both stay so."""
    found, plan = move(view.found), move(view.plan)
    moved = {id(before): after for before, after in zip(view.found.operations, found.operations, strict=True)}
    operations = tuple(moved.get(id(before), after)
                       for before, after in zip(view.plan.operations, plan.operations, strict=True))
    view.found = found
    view.plan = found if view.plan is view.found else replace(plan, operations=operations)
    view.show_moved()
