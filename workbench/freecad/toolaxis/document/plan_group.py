"""A whole plan: what was asked for several sub-surfaces together, with their operations in it."""

import json
from dataclasses import asdict, replace

import FreeCAD
from freecad.toolaxis.document.earlier_setups import DELETED, later_setups
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.document.kinds import is_plan, operations_in, plan_of
from freecad.toolaxis.document.operation import INPUTS, compare, set_inputs, watch
from freecad.toolaxis.document.plan_account import account_of, account_text
from freecad.toolaxis.document.properties import Property, Proxy, assign
from freecad.toolaxis.document.read_operation import OperationRecord
from freecad.toolaxis.document.stale_label import MARK, plain_label
from freecad.toolaxis.document.staleness import changed_inputs, digest
from freecad.toolaxis.document.sub_surface_shape import CLEAN_UP, is_shown

from toolaxis.plan.baseline import clock

_ASKED, _FOUND, _KEPT = "Inputs", "Result", "Tool Axis"

# Hidden: what follows a setup does not depend on it as on a part, and takes none of its operations along.
FOLLOWS = Property("LinkHidden", "After", _ASKED, "Plan of the setup before this one; nothing: this is the first setup")
FIGURES = (
    Property("String", "Outcome", _FOUND, "Outcome: complete, incomplete or cancelled", True),
    Property("StringList", "Warnings", _FOUND, "Warnings about the part", True),
    Property("Bool", "Stale", _FOUND, "Out of date: the part or the inputs have changed since; recompute the "
                                      "plan", True),
    Property("StringList", "StaleReasons", _FOUND, "Changes that put the results out of date", True),
    Property("Integer", "SubSurfaces", _FOUND, "Number of sub-surfaces", True),
    Property("Integer", "DifferentAxes", _FOUND, "Number of orientations", True),
    Property("Length", "CuttingLength", _FOUND, "Length of the cutting moves of all operations", True),
    Property("Length", "Travel", _FOUND, "Length of lead-ins, lead-outs and links", True),
    Property("Time", "MachiningTime", _FOUND, "Time of all operations, index moves included", True),
    Property("Area", "FaceArea", _FOUND, "Area of the faces, if planned with several tools", True),
    Property("Area", "Machined", _FOUND, "Area that is machined", True),
    Property("Area", "ProvenOutOfReach", _FOUND, "Area proven to be out of reach of every tool", True),
    Property("Area", "Open", _FOUND, "Area that was tried and stays open", True),
    Property("Area", "NotBegun", _FOUND, "Area not begun when the plan was stopped", True),
    Property("StringList", "ToolsUsed", _FOUND, "Tools with their operations and times", True))
KEPT = (
    MARK,
    Property("String", "Options", _KEPT, "Length against number of axes, JSON", True, True),
    Property("String", "Baselines", _KEPT, "What other methods come to, JSON", True, True),
    Property("String", "BladesFound", _KEPT, "Blades and copies, JSON", True, True),
    Property("String", "Account", _KEPT, "What several tools come to, JSON", True, True),
    Property("String", "InNoOperation", _KEPT, "What of the faces is in no operation, JSON", True, True),
    Property("String", "PlannedWith", _KEPT, "Inputs at the time of planning, JSON", True, True),
    Property("String", "Made", _KEPT, "Names and labels of operations and turned copies, JSON", True, True))
#: Sentences that are told of operations out of date, and operations that are named in one.
_TOLD, _NAMED = 3, 3


class WholePlan(Proxy):
    """Marked stale when its inputs or one of its operations are.

    Parameters
    ----------
    thing : App::DocumentObjectGroupPython
    """

    Type = "ToolAxisPlan"
    properties = (*INPUTS, FOLLOWS, *FIGURES, *KEPT)

    def __init__(self, thing):
        super().__init__(thing)
        watch(_PLANS)

    def onDocumentRestored(self, thing):
        """Give a plan of an older version what it does not have yet."""
        super().onDocumentRestored(thing)
        watch(_PLANS)

    def execute(self, thing):
        """Compare with what was planned; computes no axis."""
        compare(thing, why_stale)


class _Plans:
    """Tells whole plans what becomes of their operations."""

    def deleted(self, thing, going):
        """Mark what follows a setup that is deleted, and the plan of an operation, or of a turned copy, that is deleted
        by itself.
        """
        for later in later_setups(thing.Document):
            if later.After == thing:
                assign(later, StaleReasons=[DELETED], Stale=True)
        plan, source = plan_of(thing), getattr(thing, "LinkedObject", None)
        if plan is not None and plan.Name not in going and (source is None or source.Name not in going):
            note_deleted(plan, thing)

    def marked(self, document):
        """Compare the plans of a document after their operations."""
        for thing in filter(is_plan, document.Objects):
            compare(thing, why_stale)

    def recomputed(self, document):
        """Compare the plans of later setups, which FreeCAD does not recompute with those that they follow."""
        for thing in later_setups(document):
            touched = "Touched" in thing.State
            compare(thing, why_stale)
            if not touched:
                thing.purgeTouched()


_PLANS = _Plans()


def why_stale(plan):
    """Why the results of a whole plan do not hold any more, sentences; none where they do.

    Parameters
    ----------
    plan : App.DocumentObject
    """
    if not plan.PlannedWith:
        return ["nothing was planned yet"]
    inputs, gone = inputs_of(plan), no_longer_there(plan)
    if not inputs.faces:
        return ["the part was deleted", *gone]
    reasons = changed_inputs(json.loads(plan.PlannedWith), inputs) + gone
    return reasons or _of_operations(plan)


def _of_operations(plan):
    """What makes operations of a plan stale, a sentence for each reason with the operations that it concerns."""
    concerned = {}
    for one in operations_in(plan):
        if one.Stale:
            concerned.setdefault("; ".join(one.StaleReasons) or "out of date", []).append(plain_label(one))
    return [f"{_list_labels(labels)}: {reason}" for reason, labels in list(concerned.items())[:_TOLD]]


def _list_labels(labels):
    return f"{', '.join(labels[:_NAMED])}{' and more' if len(labels) > _NAMED else ''}"


def members(plan):
    """The operations of a whole plan and the links that show them turned to other blades.

    Parameters
    ----------
    plan : App.DocumentObject
    """
    inner = [group for group in plan.Group if group.TypeId == "App::DocumentObjectGroup"]
    return [*operations_in(plan), *(one for group in inner for one in group.Group if "Turn" in one.PropertiesList)]


def no_longer_there(plan, without=None):
    """What a whole plan consisted of and does not any more, sentences; none for one of an older version.

    Parameters
    ----------
    plan : App.DocumentObject
    without : App.DocumentObject, optional
        An object that is about to be deleted.
    """
    there = {one.Name for one in members(plan) if without is None or one.Name != without.Name}
    gone, out = [], []
    for name, label in json.loads(plan.Made or "{}").items():
        if name not in there:
            deleted = plan.Document.getObject(name) is None or (without is not None and name == without.Name)
            (gone if deleted else out).append(label)
    reasons = [f"{_list_labels(gone)}: deleted"] if gone else []
    return reasons + ([f"{_list_labels(out)}: taken out of the plan"] if out else [])


def note_deleted(plan, thing):
    """Mark a whole plan stale at once for an operation, or a turned copy, that is about to be deleted.

    Parameters
    ----------
    plan : App.DocumentObject
    thing : App.DocumentObject
    """
    before = no_longer_there(plan)
    now = no_longer_there(plan, thing)
    if now != before:
        kept = [reason for reason in plan.StaleReasons if reason not in before]
        assign(plan, StaleReasons=[*kept, *now], Stale=True)


def keep_plan(thing, inputs, plan):
    """Write what was asked for and what it came to into a whole plan.

    Parameters
    ----------
    thing : App.DocumentObject
    inputs : freecad.toolaxis.document.inputs.JobInputs
    plan : toolaxis.plan.plan.Plan
    """
    from toolaxis.plan.blades_document import blades_document

    set_inputs(thing, inputs)
    assign(thing, After=inputs.after)
    copies = {} if plan.blades is None else plan.blades.copies
    thing.Options = json.dumps([asdict(one) for one in plan.options])
    thing.Baselines = json.dumps([asdict(one) for one in plan.baselines])
    thing.BladesFound = json.dumps(blades_document(plan.blades))
    thing.PlannedWith = digest(inputs)
    thing.Made = json.dumps({one.Name: plain_label(one) for one in members(thing)})
    assign(thing, Outcome=plan.outcome, Warnings=list(plan.part.warnings), SubSurfaces=len(plan.operations),
           DifferentAxes=plan.orientations, CuttingLength=float(plan.length), Travel=float(plan.travel),
           MachiningTime=float(plan.seconds), Stale=False, StaleReasons=[])
    thing.InNoOperation = _text_of_areas(plan, len(inputs.things) == 1)
    _keep_account(thing, plan)
    FreeCAD.Console.PrintLog(f"Tool Axis: {len(plan.operations)} operations, {len(copies)} turned copies\n")


def _keep_account(thing, plan):
    """Write what several tools come to into a whole plan; nothing where there is one."""
    if len(plan.tools) < 2:
        assign(thing, Account="", ToolsUsed=[])
        return
    found = account_of(plan)
    thing.Account = account_text(found)
    assign(thing, FaceArea=found.area, Machined=found.machined, ProvenOutOfReach=found.unreachable, Open=found.open,
           NotBegun=found.not_begun,
           ToolsUsed=[f"T{one.number} {one.name}: {one.operations}, {clock(one.seconds)}" for one in found.tools])


def _text_of_areas(plan, of_one_part):
    """What of the faces of a plan is in no operation, with the skins of which nothing is."""
    rows = {name: [one._asdict() for one in getattr(plan, name)] for name in ("unplanned", "held", "machined_before")}
    rows["unplanned"] = [{**one, "point": list(one["point"])} for one in rows["unplanned"]]
    if of_one_part:  # faces of several are counted through those that have operations
        known = {op.face.numbers for op in plan.operations}
        skins = [face.numbers for face in plan.part.faces if face.members]
        rows["joined"] = [list(skin) for skin in skins if skin not in known]
    return json.dumps(rows)


def keep_figures(thing, plan):
    """Sum the operations of a whole plan up anew, one of which was planned again by itself.

    What was asked for all of them stays, and so does the curve. Without the machine's times of the others, the time is
    that of all motions at their full rates.

    Parameters
    ----------
    thing : App.DocumentObject
        The whole plan.
    plan : toolaxis.plan.plan.Plan
        Of the one.
    """
    from toolaxis.plan.document import orientation_from
    from toolaxis.plan.operation import Operation

    found, face, tool = [], plan.operations[0].face, plan.tools[0]
    for number, one in enumerate(operations_in(thing), 1):
        if one.Motions:
            standing = OperationRecord.of(one)
            found.append(Operation(number, face, tool, standing.orientation, standing.path, standing.frame))
        else:
            found.append(Operation(number, face, tool, orientation_from(json.loads(one.AxisMap))))
    whole = replace(plan, operations=tuple(found))
    thing.Made = json.dumps({one.Name: plain_label(one) for one in members(thing)})
    needed = [one for one in operations_in(thing) if not one.Motions
              and not any(is_shown(thing) and thing.Shows == CLEAN_UP for thing in one.Group)]
    assign(thing, Outcome="incomplete" if needed else "complete", SubSurfaces=len(found),
           DifferentAxes=whole.orientations, CuttingLength=float(whole.length), Travel=float(whole.travel),
           MachiningTime=float(whole.seconds))
