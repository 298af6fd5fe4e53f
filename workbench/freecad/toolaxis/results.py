"""Plans and verdicts into the tree of a document, each as one undo step."""

import json
from dataclasses import replace

import FreeCAD

from .faces import facts_of
from .objects.belongings import GROUP, child, frame_of, loose
from .objects.frames import add_frame, place_frame
from .objects.operation import Operation, mark, set_inputs, set_results
from .objects.passes import commands, fill_passes
from .objects.tool import ToolOnPasses, tool_shape
from .objects.transaction import one_step, remove
from .places import chain_of, placement_from
from .staleness import digest, signature

translate = FreeCAD.Qt.translate


def apply(document, inputs, plan, replaces=None):
    """Put a plan into a document: a group with an operation for each sub-surface.

    Parameters
    ----------
    document : App.Document
    inputs : freecad.toolaxis.bridge.Inputs
        What was planned with.
    plan : toolaxis.plan.plan.Plan
    replaces : App.DocumentObject, optional
        The operation that the first one of the plan takes the place of.

    Returns
    -------
    list of App.DocumentObject
        The operations.

    Raises
    ------
    ToolAxisError
        When the part was deleted meanwhile, or the plan was cancelled before its first operation.
    """
    from toolaxis.errors import Cancelled

    if not plan.operations:
        raise Cancelled("nothing was planned: the computation was stopped")
    owners = owners_of(inputs, plan)
    with one_step(document, translate("ToolAxis", "Plan orientations")):
        group = _group_for(document, replaces)
        made = []
        for op, owner in zip(plan.operations, owners, strict=True):
            operation = replaces if op is plan.operations[0] and replaces is not None else _added(document, group)
            made.append(operation)
            _fill(operation, _alone(inputs, owner), plan, (op, owner[2]))
        document.recompute([*(thing for one in made for thing in (*one.Group, one)), group])
    return made


def owners_of(inputs, plan):
    """For each operation of a plan the object, the face's name and its number in that object.

    Parameters
    ----------
    inputs : freecad.toolaxis.bridge.Inputs
    plan : toolaxis.plan.plan.Plan
    """
    from toolaxis.cad.freecad import shape_of
    from toolaxis.errors import InvalidInput

    from .reading import numbered

    shapes = [shape_of(thing) for thing in inputs.things]
    if sum(len(shape.Faces) for shape in shapes) != len(plan.part.faces):
        raise InvalidInput("the part has changed while it was planned: compute again")
    found = numbered(inputs, shapes)
    return [found[op.face.number] for op in plan.operations]


def _alone(inputs, owner):
    """The inputs for one face: the other parts of the job become bodies to avoid."""
    thing, name, _ = owner
    others = tuple(one for one in inputs.things if one.Name != thing.Name)
    known = {one.Name for one in inputs.obstacles}
    return replace(inputs, faces=((thing, name),),
                   obstacles=(*inputs.obstacles, *(one for one in others if one.Name not in known)))


def _group_for(document, replaces):
    if replaces is not None:
        above = [thing for thing in replaces.InList if thing.hasExtension("App::GroupExtension")]
        if above:
            return above[0]
    group = document.addObject("App::DocumentObjectGroup", GROUP)
    group.Label = translate("ToolAxis", "Orientations")
    return group


def _added(document, group):
    operation = document.addObject("App::DocumentObjectGroupPython", "Operation")
    Operation(operation)
    if FreeCAD.GuiUp:
        from .views.operation import OperationView

        OperationView(operation.ViewObject)
    group.addObject(operation)
    return operation


def _fill(operation, inputs, plan, which):
    """Make an operation what a plan says, its frame, passes and tool included."""
    op, number = which
    thing, name = inputs.faces[0]
    label = op.face.label[len(str(op.face.number)):] if op.face.label.startswith(str(op.face.number)) else ""
    title = f"{thing.Label} {name.rsplit('.', 1)[-1]}{label}"
    operation.Label = title
    set_inputs(operation, inputs)
    set_results(operation, op.orientation, plan.not_checked)
    _keep(operation, inputs, op, f"{number}{label}" if label else str(number))
    remove([one for one in operation.Group if one.isDerivedFrom("Mesh::Feature")])
    if op.done:
        frame = _standing_frame(operation, op, thing, title)
        _standing_passes(operation, op, (frame, inputs.feedrate), title)
        _standing_tool(operation, plan.tool, title)
    else:
        remove(list(operation.Group))
    mark(operation)


def _keep(operation, inputs, op, label):
    from toolaxis.plan.document import orientation_document

    number = int("".join(c for c in label if c.isdigit()) or 0)
    operation.AxisMap = json.dumps(orientation_document(op.orientation))
    operation.Details = json.dumps({"face": number, "label": label, "region": _region(op, number),
                                    "about": facts_of(*inputs.faces[0])})
    operation.PlannedWith = digest(inputs)
    operation.Signature = signature([inputs.faces[0][0]], inputs.obstacles, bool(inputs.limits))
    operation.Motions = [] if op.path is None else [int(kind) for kind in op.path.kind]
    operation.Starts = [] if op.path is None else [int(start) for start in op.path.breaks]


def _region(op, number):
    """Trim loops of a sub-surface that is not a whole face or a whole piece of one."""
    plain = op.face.label[len(str(op.face.number)):]
    return None if not plain or plain.isalpha() else [loop.tolist() for loop in op.face.trims]


def _standing_frame(operation, op, part, title):
    document = operation.Document
    frame = frame_of(operation)
    if frame is None:
        remove(loose(operation))
        frame = add_frame(document)
        operation.addObject(frame)
        operation.FrameFeatures = [feature.Name for feature in getattr(frame, "OriginFeatures", ())]
        if FreeCAD.GuiUp:
            frame.ViewObject.Visibility = True
    frame.Label = translate("ToolAxis", "Work coordinates {}").format(title)
    place_frame(frame, placement_from(op.frame.part_from_work), chain_of(part))
    return frame


def _standing_passes(operation, op, frame, title):
    passes = child(operation, "Path::Feature")
    if passes is None:
        import PathApp  # noqa: F401  makes the type known

        passes = operation.Document.addObject("Path::Feature", "Passes")
        operation.addObject(passes)
    passes.Label = translate("ToolAxis", "Passes {}").format(title)
    fill_passes(passes, commands(op.path, op.frame, frame[1]))
    passes.Placement = frame[0].Placement
    passes.setExpression("Placement", None)  # the same words may mean a frame that was deleted
    passes.setExpression("Placement", f"{frame[0].Name}.Placement")
    if FreeCAD.GuiUp:  # else FreeCAD draws a line to the first point from the origin, maybe through the part
        first = passes.Path.Commands[0].Placement.Base
        passes.ViewObject.StartPosition = first


def _standing_tool(operation, tool, title):
    document = operation.Document
    standing = child(operation, "Part::FeaturePython")
    passes = child(operation, "Path::Feature")
    if standing is None:
        standing = document.addObject("Part::FeaturePython", "ToolOnPasses")
        ToolOnPasses(standing)
        if FreeCAD.GuiUp:
            from .views.tool import ToolView

            ToolView(standing.ViewObject)
        operation.addObject(standing)
    if standing.Passes != passes:
        standing.Passes = passes
        standing.setExpression("Placement", None)
        standing.setExpression("Placement", f"{passes.Name}.Placement * Station")
    standing.Label = translate("ToolAxis", "Tool {}").format(title)
    standing.Shape = tool_shape(tool)
    standing.Proxy.execute(standing)


def keep_verdict(operation, verdicts):
    """Keep the judge's verdict on an operation: figures, worst places, and maps as a coloured mesh.

    It holds for what stood in the document when `bridge.verification` was asked.

    Parameters
    ----------
    operation : App.DocumentObject
    verdicts : sequence of toolaxis.verify.verdict.OperationVerdict
        On this operation; the first one counts.

    Returns
    -------
    App.DocumentObject or None
        The mesh.
    """
    from .objects.maps import keep

    with one_step(operation.Document, translate("ToolAxis", "Verify")):
        operation.JudgedWith, operation.JudgedShapes = operation.Proxy.judging
        return keep(operation, verdicts[0], child(operation, "Path::Feature").Placement)
