"""A whole plan: what was asked for several sub-surfaces together, with their operations in it."""

import json

import FreeCAD

from . import operations_in
from .operation import INPUTS, set_inputs, watch
from .properties import Property, Proxy, assign

_FOUND, _KEPT = "Result", "Tool Axis"

FIGURES = (
    Property("String", "Outcome", _FOUND, "complete, incomplete or cancelled", True),
    Property("StringList", "Warnings", _FOUND, "What was noticed of the part", True),
    Property("Bool", "Stale", _FOUND, "The part or the inputs have changed since: recompute the plan", True),
    Property("StringList", "StaleReasons", _FOUND, "What has changed", True),
    Property("Integer", "SubSurfaces", _FOUND, "Number of sub-surfaces", True),
    Property("Integer", "DifferentAxes", _FOUND, "Number of different axes", True),
    Property("Length", "CuttingLength", _FOUND, "Length of the cutting motion of all operations", True),
    Property("Length", "Travel", _FOUND, "Length of entries, exits and links", True),
    Property("Time", "MachiningTime", _FOUND, "Time of all operations, changes of the axis included", True))
KEPT = (
    Property("String", "Options", _KEPT, "Length against number of axes, JSON", True, True),
    Property("String", "Baselines", _KEPT, "What other methods come to, JSON", True, True),
    Property("String", "BladesFound", _KEPT, "Blades and copies, JSON", True, True),
    Property("String", "PlannedWith", _KEPT, "Inputs at the time of planning, JSON", True, True))


class WholePlan(Proxy):
    """Marked stale when its inputs or one of its operations are.

    Parameters
    ----------
    thing : App::DocumentObjectGroupPython
    """

    Type = "ToolAxisPlan"
    properties = (*INPUTS, *FIGURES, *KEPT)

    def __init__(self, thing):
        super().__init__(thing)
        watch()

    def onDocumentRestored(self, thing):
        """Give a plan of an older version what it does not have yet."""
        super().onDocumentRestored(thing)
        watch()

    def execute(self, thing):
        """Compare with what was planned; computes no axis."""
        reasons = why_stale(thing)
        assign(thing, StaleReasons=reasons, Stale=bool(reasons))


def why_stale(plan):
    """Why the results of a whole plan do not hold any more, sentences; none where they do.

    Parameters
    ----------
    plan : App.DocumentObject
    """
    from ..inputs import inputs_of
    from ..staleness import changed_inputs

    if not plan.PlannedWith:
        return ["nothing was planned yet"]
    reasons = changed_inputs(json.loads(plan.PlannedWith), inputs_of(plan))
    if not reasons:
        stale = [one.Label for one in operations_in(plan) if one.Stale]
        reasons = [f"{', '.join(stale[:3])}{' and more' if len(stale) > 3 else ''}: out of date"] if stale else []
    return reasons


def keep_plan(thing, inputs, plan):
    """Write what was asked for and what it came to into a whole plan.

    Parameters
    ----------
    thing : App.DocumentObject
    inputs : freecad.toolaxis.inputs.Inputs
    plan : toolaxis.plan.plan.Plan
    """
    from dataclasses import asdict

    from toolaxis.plan.blades_document import blades_document

    from ..staleness import digest

    set_inputs(thing, inputs)
    copies = {} if plan.blades is None else plan.blades.copies
    thing.Options = json.dumps([asdict(one) for one in plan.options])
    thing.Baselines = json.dumps([asdict(one) for one in plan.baselines])
    thing.BladesFound = json.dumps(blades_document(plan.blades))
    thing.PlannedWith = digest(inputs)
    assign(thing, Outcome=plan.outcome, Warnings=list(plan.part.warnings), SubSurfaces=len(plan.operations),
           DifferentAxes=plan.orientations, CuttingLength=float(plan.length), Travel=float(plan.travel),
           MachiningTime=float(plan.seconds), Stale=False, StaleReasons=[])
    FreeCAD.Console.PrintLog(f"Tool Axis: {len(plan.operations)} operations, {len(copies)} turned copies\n")
