"""How a plan that was just made turned out, in one sentence."""

import FreeCAD
from freecad.toolaxis.document.plan_account import account_of, mean_step_over
from freecad.toolaxis.document.strategies import strategy_of
from freecad.toolaxis.gui.plan.account import count_texts, headline, texts_of_areas_aside
from freecad.toolaxis.services.time_left import clock

translate = FreeCAD.Qt.translate


def outcome_sentence(plan):
    """What came of a plan, and whether it is bad.

    Sub-surfaces that are left as rest material, and fillets at the roots of blades, have no axis and need none: they
    are told apart from those for which none was found.

    Parameters
    ----------
    plan : toolaxis.plan.plan.Plan
        With operations.

    Returns
    -------
    (str, bool)
    """
    count = len(plan.operations)
    if not any(op.done for op in plan.operations) and plan.outcome == "cancelled":
        return translate("ToolAxis", "Stopped before the first face had passes."), True
    if len(plan.tools) > 1:
        return _rack_sentence(plan)
    done, left = sum(op.done for op in plan.operations), len(left_to_clean_up(plan))
    if plan.outcome == "cancelled":
        return translate("ToolAxis", "Stopped with {} finished. {} OK puts what is finished into the document.").format(
            done, figures(plan)), True
    if done == count and touched_once(plan):
        return translate("ToolAxis", "Every face has an axis, but two-point contact was not possible anywhere "
                                     "(reasons: tab Axis). OK puts them into the document."), True
    if done == count:
        return translate("ToolAxis", "Every face has an axis. {} OK puts them into the document.").format(
            figures(plan)), False
    if done and done + left == count:
        return translate("ToolAxis", "{} of {} faces have an axis, {} are left as rest material. {} OK puts them into "
                                     "the document.").format(done, count, left, figures(plan)), False
    if left:
        return translate("ToolAxis", "{} of {} faces have an axis, {} are left as rest material, {} have none; the "
                                     "reasons are on the tab Axis.").format(done, count, left,
                                                                            count - done - left), True
    return translate("ToolAxis", "{} of {} faces have an axis; the reasons are on the tab Axis.").format(
        done, count), True


def _rack_sentence(plan):
    """What came of a plan with several tools, and whether it is bad."""
    told = headline(account_of(plan))
    if not any(op.done for op in plan.operations):
        return translate("ToolAxis", "{} The reasons are on the tab Axis.").format(told), True
    if plan.outcome == "cancelled":
        return translate("ToolAxis", "Stopped. {} OK puts what is finished into the document.").format(told), True
    return translate("ToolAxis", "{} OK puts the plan into the document.").format(told), plan.outcome != "complete"


def figures(plan):
    """What a plan comes to over all its operations, in sentences: time, passes, mean step-over and number of axes, then
    what of the faces is not asked for.

    Parameters
    ----------
    plan : toolaxis.plan.plan.Plan
        With an operation that has passes.
    """
    passes = sum(op.orientation.passes for op in plan.operations if op.done)
    counts = ", ".join([clock(plan.seconds), *count_texts(passes, mean_step_over(plan), plan.orientations)])
    areas = [sum(one.area for one in some) for some in (plan.held, plan.machined_before)]
    return " ".join([f"{counts}.", *texts_of_areas_aside(*areas)])


def touched_once(plan):
    """Whether the strategy did nowhere what it is there for, as two-point contact where no sub-surface has any.

    Parameters
    ----------
    plan : toolaxis.plan.plan.Plan
    """
    promise = strategy_of(plan.inputs.method).promise
    return bool(promise) and not any(
        why.startswith(promise) for op in plan.operations for why in op.orientation.reasons)


def left_to_clean_up(plan):
    """Numbers of the operations that have no axis and do not miss one.

    Parameters
    ----------
    plan : toolaxis.plan.plan.Plan
    """
    from toolaxis.plan.plan import outcome_of

    return {op.number for op in plan.operations if not op.done and outcome_of([op], plan.blades) == "complete"}
