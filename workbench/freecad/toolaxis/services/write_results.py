"""Plans and verdicts into the tree of a document, each as one undo step."""

import json
from dataclasses import replace

import FreeCAD
from freecad.toolaxis.document.axis_lines import show_axes
from freecad.toolaxis.document.blade_links import PlanTree, quiet
from freecad.toolaxis.document.children import GROUP, child, frame_of, loose
from freecad.toolaxis.document.face_identity import facts_of
from freecad.toolaxis.document.kinds import is_plan, operations_in
from freecad.toolaxis.document.machine import keep_angles
from freecad.toolaxis.document.operation import OperationProxy, mark, set_inputs, set_results
from freecad.toolaxis.document.passes import commands, fill_passes, keep_axes
from freecad.toolaxis.document.placement import chain_of, placement_from
from freecad.toolaxis.document.plan_group import WholePlan, keep_figures, keep_plan
from freecad.toolaxis.document.properties import assign
from freecad.toolaxis.document.read_shapes import every_face, numbered
from freecad.toolaxis.document.staleness import digest, signature
from freecad.toolaxis.document.sub_surface_shape import is_shown, show_surface, surface_colour
from freecad.toolaxis.document.tool_colours import colour_passes, pale_tool_colour, tool_colour
from freecad.toolaxis.document.tool_on_path import ToolOnPasses, tool_shape
from freecad.toolaxis.document.transaction import one_step, remove
from freecad.toolaxis.document.verdict_maps import keep
from freecad.toolaxis.document.view_providers import attach_view
from freecad.toolaxis.document.work_coordinates import add_frame, place_frame
from freecad.toolaxis.document.work_origin import stock_corners

translate = FreeCAD.Qt.translate

#: With more operations than this, work coordinate systems are hidden at first: they have one origin.
_FEW = 4


def apply(document, inputs, plan, replaces=None):
    """Put a plan into a document: a group with an operation for each sub-surface.

    Parameters
    ----------
    document : App.Document
    inputs : freecad.toolaxis.document.inputs.JobInputs
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
        group, standing = _place_for(document, inputs, plan, replaces)
        tree = PlanTree(document, group, plan)
        made, colours = [], _colours(plan, standing)
        for op, owner in zip(plan.operations, owners, strict=True):
            if op.number in tree.copies:
                continue
            operation = standing.pop(_key(op, owner), None) or _add_object(document, tree.place_of(op))
            made.append(operation)
            _fill(operation, _alone(inputs, owner, op), plan, (op, owner[2], colours.get(op.number)))
            _lock(operation, inputs, _key(op, owner))
            keep_angles(operation, plan, op)
        tree.finish(made, chain_of(owners[0][0]), list(standing.values()))
        if is_plan(group) and replaces is not None and not is_plan(replaces):
            keep_figures(group, plan)
        elif is_plan(group):
            keep_plan(group, inputs, plan)
        document.recompute([*(thing for one in made for thing in (*one.Group, one)), *tree.things, group])
        quiet(tree.things)
    return made


def owners_of(inputs, plan):
    """For each operation of a plan the object, the face's name and its number in that object.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs
    plan : toolaxis.plan.plan.Plan
    """
    from toolaxis.cad.freecad.documents import shape_of
    from toolaxis.errors import InvalidInput

    shapes = [shape_of(thing) for thing in inputs.things]
    whole = plan.part.original or plan.part  # as it was before faces around a blade were joined
    if sum(len(shape.Faces) for shape in shapes) != len(whole.faces) + len(whole.left_out):
        raise InvalidInput("the part has changed while it was planned: compute again")
    found = every_face(inputs.things, shapes) | numbered(inputs, shapes)
    return [found[op.face.number] for op in plan.operations]


def _alone(inputs, owner, op):
    """The inputs for one sub-surface, with its own tool: the other parts of the job become bodies to avoid."""
    thing, name, _ = owner
    others = tuple(one for one in inputs.things if one.Name != thing.Name)
    known = {one.Name for one in inputs.obstacles}
    own = inputs.with_tool(op.tool) if inputs.rack else inputs
    return replace(own, faces=((thing, name),), regions=None, orientations=None, compare=False, pieces=(),
                   obstacles=(*inputs.obstacles, *(one for one in others if one.Name not in known)), after=None)


def _lock(operation, inputs, key):
    """Show what of an operation is locked."""
    piece = next((one for one in inputs.pieces if (one.thing.Name, one.name, one.suffix) == (
        key[0], operation.Faces[0][1][0], key[2])), None)
    assign(operation, AxisLocked=piece is not None and piece.locked, FeedLocked=piece is not None and bool(piece.feed),
           DrawnByHand=piece is not None and piece.drawn)


def _key(op, owner):
    """What an operation is known again by: part, face, and the letters of the sub-surface."""
    return owner[0].Name, owner[2], op.face.label.removeprefix(str(op.face.number))


def _place_for(document, inputs, plan, replaces):
    """The group to put operations into, and the operations that stand there already, by their keys."""
    if replaces is not None and is_plan(replaces):
        return replaces, {_key_of(one): one for one in operations_in(replaces)}
    if replaces is not None:
        first = plan.operations[0]
        above = [thing for thing in replaces.InList if thing.hasExtension("App::GroupExtension")]
        return (above[0] if above else _new_group(document)), {_key(first, owners_of(inputs, plan)[0]): replaces}
    tells_more = plan.held or plan.unplanned or inputs.after is not None
    if len(plan.operations) > 1 or inputs.divides or inputs.rack or tells_more:
        return _new_plan(document), {}
    return _new_group(document), {}


def _key_of(operation):
    details = json.loads(operation.Details or "{}")
    number = details.get("face", 0)
    part = next((thing.Name for thing, _ in operation.Faces), "")
    return part, number, details.get("label", "").removeprefix(str(number))


def _new_group(document):
    group = document.addObject("App::DocumentObjectGroup", GROUP)
    group.Label = translate("ToolAxis", "Orientations")
    return group


def _new_plan(document):
    plan = document.addObject("App::DocumentObjectGroupPython", "ToolAxisPlan")
    WholePlan(plan)
    attach_view(plan)
    plan.Label = translate("ToolAxis", "Plan")
    return plan


def _colours(plan, standing):
    """Colours of sub-surfaces by number, where there are several; one that is planned again alone keeps its own.

    With several tools they tell the tool.
    """
    from toolaxis.report.figures.map_colouring import colours_of

    if len(plan.tools) > 1:
        return {op.number: pale_tool_colour(plan.used_tools.index(op.tool)) for op in plan.operations if op.done}
    if len(plan.operations) > 1:
        return colours_of(plan)
    kept = next((surface_colour(one) for one in standing.values()), None)
    return {plan.operations[0].number: kept} if kept else {}


def _add_object(document, group):
    operation = document.addObject("App::DocumentObjectGroupPython", "Operation")
    OperationProxy(operation)
    attach_view(operation)
    group.addObject(operation)
    return operation


def _fill(operation, inputs, plan, which):
    """Make an operation what a plan says, its frame, passes and tool included."""
    op, number, colour = which
    thing, name = inputs.faces[0]
    label = op.face.label[len(str(op.face.number)):] if op.face.label.startswith(str(op.face.number)) else ""
    title = f"{thing.Label} {name.rsplit('.', 1)[-1]}{_short_suffix(op.face, plan.part)}"
    if len(plan.tools) > 1:
        title += f", T{op.tool.number}"
    operation.Label = title
    set_inputs(operation, inputs)
    set_results(operation, op.orientation, plan.not_checked)
    rates = plan.inputs.at_rates_of(op.tool)
    assign(operation, MachiningTime=float(op.seconds(rates.feedrate, rates.rapid)))
    _keep(operation, inputs, (op, plan), (number, f"{number}{label}"))
    maps = [one for one in operation.Group if one.isDerivedFrom("Mesh::Feature") and not is_shown(one)]
    remove(maps)
    if op.done:
        frame = _standing_frame(operation, op, (thing, len(plan.operations) <= _FEW), title)
        passes = _standing_passes(operation, op, (frame, inputs.feedrate), title)
        if len(plan.tools) > 1:
            colour_passes(passes, tool_colour(plan.used_tools.index(op.tool)))
        show_axes(operation, passes, op.face.diagonal, title)
        _standing_tool(operation, op, title, len(plan.operations) == 1)
    else:
        remove([one for one in operation.Group if not is_shown(one)])
    show_surface(operation, op, chain_of(thing), colour)
    for one in filter(is_shown, operation.Group if maps else ()):  # a map stood in its place
        one.Visibility = True
    mark(operation)


def _keep(operation, inputs, which, names):
    from toolaxis.plan.document import orientation_document, region_of, zone_documents

    (op, plan), (number, label) = which, names
    before = op.face.number - number
    kept = {"members": [own - before for own in op.face.numbers] if op.face.members else [],
            "zones": zone_documents(op.zones), "unreachable": op.unreachable, "rest_of": list(op.rest_of),
            "number": op.number, "stock_faces": _stock_faces(operation, plan, before)}
    operation.AxisMap = json.dumps(orientation_document(op.orientation))
    operation.Details = json.dumps({"face": number, "label": label, "region": region_of(op.face, plan.part),
                                    "about": facts_of(*inputs.faces[0]),
                                    **{name: value for name, value in kept.items() if value}})
    operation.PlannedWith = digest(inputs)
    operation.Signature = signature([inputs.faces[0][0]], inputs.obstacles, inputs.placed)
    operation.StockCorners = stock_corners(plan)
    operation.Motions = [] if op.path is None else [int(kind) for kind in op.path.kind]
    operation.Starts = [] if op.path is None else [int(start) for start in op.path.breaks]


def _stock_faces(operation, plan, before):
    """The faces of an operation's part that have stock, by their numbers there; `before` faces of others come first."""
    from toolaxis.cad.freecad.documents import shape_of

    stock = plan.part.stock
    count = len(shape_of(operation.Faces[0][0]).Faces)
    return [] if stock is None else sorted(n - before for n in stock.faces if 0 < n - before <= count)


def _short_suffix(face, part):
    """What follows the number of a face in the name of a sub-surface: faces joined to it are counted, "+12more.2a"."""
    if len(face.numbers) < 3:
        return face.label.removeprefix(str(face.number))
    return f"+{len(face.numbers) - 1}more{face.label.removeprefix(part.face(face.number).label)}"


def _standing_frame(operation, op, where, title):
    document, (part, shown) = operation.Document, where
    frame = frame_of(operation)
    if frame is None:
        remove(loose(operation))
        frame = add_frame(document)
        operation.addObject(frame)
        operation.FrameFeatures = [feature.Name for feature in getattr(frame, "OriginFeatures", ())]
        if FreeCAD.GuiUp:
            frame.ViewObject.Visibility = shown
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
    keep_axes(passes, op.path if op.orientation.lead is not None else None, op.frame)
    passes.Placement = frame[0].Placement
    passes.setExpression("Placement", None)  # the same words may mean a frame that was deleted
    passes.setExpression("Placement", f"{frame[0].Name}.Placement")
    if FreeCAD.GuiUp:  # else FreeCAD draws a line to the first point from the origin, maybe through the part
        first = passes.Path.Commands[0].Placement.Base
        passes.ViewObject.StartPosition = first
    return passes


def _standing_tool(operation, op, title, alone):
    document = operation.Document
    standing = child(operation, "Part::FeaturePython")
    passes = child(operation, "Path::Feature")
    if standing is None:
        standing = document.addObject("Part::FeaturePython", "ToolOnPasses")
        ToolOnPasses(standing)
        attach_view(standing)
        if FreeCAD.GuiUp:
            standing.ViewObject.Visibility = alone  # several would hide what they machine
        operation.addObject(standing)
    if standing.Passes != passes:
        standing.Passes = passes
        standing.setExpression("Placement", None)
        standing.setExpression("Placement", f"{passes.Name}.Placement * Station")
    standing.Label = translate("ToolAxis", "Tool {}").format(title)
    standing.Shape = tool_shape(op.tool)
    standing.Proxy.execute(standing)


def keep_verdict(operation, verdicts, maps=None):
    """Keep the judge's verdict on an operation: figures, worst places, and maps as a coloured mesh.

    It holds for what stood in the document when `api.verification` was asked.

    Parameters
    ----------
    operation : App.DocumentObject
    verdicts : sequence of toolaxis.verify.verdict.OperationVerdict
        On this operation; the first one counts.
    maps : list of freecad.toolaxis.document.verdict_maps.MapMesh, optional
        Its maps, where they were drawn already.

    Returns
    -------
    App.DocumentObject or None
        The mesh.
    """
    with one_step(operation.Document, translate("ToolAxis", "Verify")):
        operation.JudgedWith, operation.JudgedShapes = operation.Proxy.judging
        return keep(operation, verdicts[0], child(operation, "Path::Feature").Placement, maps)
