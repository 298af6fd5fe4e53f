"""What one CAM job is made of: the model in the frame of a plane, stock, tool controllers, operations with passes."""

import re
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import count

import FreeCAD
from freecad.toolaxis.cam.stock import origin_comments, place_stock
from freecad.toolaxis.cam.tools import add_controller, fill_controller
from freecad.toolaxis.document.placement import matrix_of
from freecad.toolaxis.document.properties import Property, ensure

translate = FreeCAD.Qt.translate

#: Deviation, mm, at which a clone does not show its part.
_CLOSE = 1e-6
_FROM = (Property("LinkHidden", "OrientedFrom", "Tool Axis", "The operation of Tool Axis that the passes are from",
                  True),
         Property("String", "MadeFor", "Tool Axis", "State of part and operation that the passes were made for", True))


@dataclass(frozen=True)
class Passes:
    """An operation as a job takes it.

    Attributes
    ----------
    operation : App.DocumentObject
    inputs : freecad.toolaxis.document.inputs.JobInputs
    tool : toolaxis.tools.tool.Tool
    path : toolaxis.cldata.toolpath.ToolPath
        In the document's space.
    matrix : (4, 4) array
        Frame of the plane, in the document's space.
    rapid : float
        Rate of links that are not rapid, mm/min.
    label : str
        What it is called: the operation, or its turned copy on another blade.
    """

    operation: object
    inputs: object
    tool: object
    path: object
    matrix: object
    rapid: float
    label: str


def bare_job(document, group, frame):
    """A job with model, stock and tools, without operations.

    Parameters
    ----------
    document : App.Document
        The active one.
    group : sequence of Passes
    frame : FreeCAD.Placement
        Of the job, in the document's space.

    Returns
    -------
    job : App.DocumentObject
    controllers : dict
        Tool controllers by `tool_of`.

    Raises
    ------
    InvalidInput
        When FreeCAD makes no true copy of the part.
    """
    import Path.Main.Job as Jobs

    things = list({thing.Name: thing for one in group for thing in one.inputs.things}.values())
    job = Jobs.Create("Job", [_base(document, thing) for thing in things])
    job.Label = translate("ToolAxis", "Job {}").format(plain(group[0].label))
    if job.ViewObject is not None:
        _show_job(job)
    for model, thing in zip(job.Model.Group, things, strict=True):
        _turn_model(model, thing, frame)
    if not place_stock(job, group, frame):
        _stand_stock(job)
    job.SetupSheet.HorizRapid = job.SetupSheet.VertRapid = group[0].rapid / 60
    controllers = {}
    for one in group:
        if tool_of(one) not in controllers:
            controllers[tool_of(one)] = _controller(job, controllers.values(), one)
    names = ", ".join(one.label for one in group)
    axes = "; ".join(dict.fromkeys("({:.6f}, {:.6f}, {:.6f})".format(*one.matrix[:3, 2]) for one in group))
    job.Description = translate("ToolAxis", "Tool Axis: {}; tool axis {} in the document").format(names, axes)
    job.Description += "".join(f"; {line[1:-1]}" for line in origin_comments(group[0], frame))
    return job, controllers


def plain(label):
    """A label without parentheses: programs tell it in comments, which controls do not take inside one another.

    Parameters
    ----------
    label : str
    """
    return re.sub(r"[()]", "", re.sub(r"\s*\(([^()]*)\)", r", \1", label))


def _controller(job, made, one):
    """The tool controller for the tool of an operation; the first one is what FreeCAD gives to every job.

    Its number is the tool's own place in the magazine, where no other tool of the job has it.
    """
    taken = {controller.ToolNumber for controller in made}
    free = next(number for number in count(1) if number not in taken)
    own = one.tool.number
    wanted = one.tool, one.inputs.feedrate, one.inputs.spindle, own if own and own not in taken else free
    if made:
        return add_controller(job, wanted)
    fill_controller(job.Tools.Group[0], wanted)
    return job.Tools.Group[0]


def tool_of(one):
    """What makes a tool controller of its own: the cutter, its body, feed rate and speed.

    Parameters
    ----------
    one : Passes
    """
    cutter = one.tool.name, one.tool.flute_length, one.inputs.stickout, one.inputs.shank, one.tool.number
    return *cutter, one.inputs.feedrate, one.inputs.spindle


def _base(document, thing):
    """What a job can clone: the part itself where it has a shape of its own, else a copy of it as it is now."""
    from toolaxis.cad.freecad.documents import shape_of

    if thing.isDerivedFrom("Part::Feature"):
        return thing
    copy = document.addObject("Part::Feature", "Copy")
    copy.Label = translate("ToolAxis", "Copy of {}").format(thing.Label)
    copy.Shape = shape_of(thing).copy()
    if copy.ViewObject is not None:
        copy.ViewObject.Visibility = False
    return copy


def _turn_model(model, thing, frame):
    """Put a job's model where its part stands in a frame; a clone that shows something else is refused."""
    import numpy as np

    from toolaxis.cad.freecad.documents import shape_of
    from toolaxis.errors import InvalidInput

    shape = shape_of(thing)
    model.Placement = frame.inverse().multiply(shape.Placement)
    model.recompute()
    if len(model.Shape.Faces) == len(shape.Faces):
        ours, theirs = _marks(model.Shape), _marks(shape)
        matrix = matrix_of(frame)
        if ours.shape == theirs.shape and (np.abs(ours @ matrix[:3, :3].T + matrix[:3, 3] - theirs).max(initial=0.0)
                                           < _CLOSE * max(1.0, np.abs(theirs - theirs[:1]).max(initial=0.0))):
            return
    raise InvalidInput(f"FreeCAD makes no true copy of {thing.Label} for a job: make a simple copy of it (Part, Create "
                       "a copy), and plan that")


def _marks(shape):
    """Where the vertices of a shape and the middles of its edges lie, (n, 3); centres of faces would take seconds."""
    import numpy as np

    points = [vertex.Point for vertex in shape.Vertexes]
    points += [edge.valueAt((edge.FirstParameter + edge.LastParameter) / 2) for edge in shape.Edges
               if not edge.Degenerated]
    return np.array([tuple(point) for point in points]).reshape(-1, 3)


def _stand_stock(job):
    """Put the stock around the turned model, where it is FreeCAD's own box around that and no other template."""
    if not hasattr(job.Stock, "ExtXneg"):
        return
    boxes = [model.Shape.BoundBox for model in job.Model.Group]
    corner = FreeCAD.Vector(*(min(getattr(box, side) for box in boxes) for side in ("XMin", "YMin", "ZMin")))
    job.Stock.Placement = FreeCAD.Placement(corner, FreeCAD.Rotation())
    job.Stock.Proxy.execute(job.Stock)


def safe_height(job, group, plane, frame):
    """Height above which nothing stands, in a plane, mm: stock, bodies to avoid, passes, and FreeCAD's clearance.

    Parameters
    ----------
    job : App.DocumentObject
    group : sequence of Passes
    plane, frame : FreeCAD.Placement
        Of the plane, and of the job's own space.
    """
    from toolaxis.cad.freecad.documents import shape_of

    back = plane.inverse()
    bodies = {thing.Name: thing for one in group for thing in (*one.inputs.things, *one.inputs.obstacles)}
    above = [_top(shape_of(body), back) for body in bodies.values()]
    above.append(_top(job.Stock.Shape, back.multiply(frame)))
    above += [float(_in_plane(one.path.cl, plane)[:, 2].max()) for one in group]
    return max(above) + job.SetupSheet.ClearanceHeightOffset.Value


def _top(shape, motion):
    """The greatest height of a shape that was moved, mm, or a little more."""
    moved = shape.copy()
    moved.Placement = motion.multiply(shape.Placement)
    return moved.BoundBox.ZMax


def _in_plane(points, plane):
    matrix = matrix_of(plane)
    return (points - matrix[:3, 3]) @ matrix[:3, :3]


def blocks(one, plane, height):
    """The lines of an operation: down from the safe height, the passes, and up again; mm and mm/s as FreeCAD has them.

    Parameters
    ----------
    one : Passes
    plane : FreeCAD.Placement
        Frame that the coordinates stand in.
    height : float
        Safe height in that frame, mm.
    """
    from toolaxis.cldata.toolpath import Motion

    points = _in_plane(one.path.cl, plane).tolist()
    x, y, z = points[0]
    top = f"G0 Z{height:.9f}"
    lines = [top, f"G0 X{x:.9f} Y{y:.9f}", f"G0 Z{z:.9f}"]
    for (x, y, z), rapid, kind in zip(points[1:], one.path.rapid[1:], one.path.kind[1:], strict=True):
        rate = one.rapid if kind == Motion.LINK else one.inputs.feedrate
        lines.append(f"G{0 if rapid else 1} X{x:.9f} Y{y:.9f} Z{z:.9f}" + ("" if rapid else f" F{rate / 60:.9g}"))
    return [*lines, top]


def plane_comments(plane):
    """What a program has to say before its first motion where FreeCAD's post-processors do not tilt the plane.

    English, and without brackets inside: controls know no other letters.

    Parameters
    ----------
    plane : FreeCAD.Placement
        Frame that the coordinates stand in, in the document's space.

    Returns
    -------
    list of str
        Empty where the plane is the document's own.
    """
    if plane.isIdentity():
        return []
    matrix = matrix_of(plane)
    along, axis, origin = ("{:.6f} {:.6f} {:.6f}".format(*(row + 0.0)) for row in matrix[:3, (0, 2, 3)].T)
    return ["(TILTED PLANE - this program does not tilt it: set up part or head so before running)",
            f"(its Z, the tool axis, in the part: {axis})", f"(its X in the part: {along})",
            f"(its origin in the part: {origin})"]


def add_passes(job, controller, one, stands, comments=()):
    """FreeCAD's own operation for given commands, with our passes.

    Parameters
    ----------
    job, controller : App.DocumentObject
    one : Passes
    stands : (FreeCAD.Placement, float)
        Frame that the coordinates stand in, and the safe height there.
    comments : sequence of str
        What the program says before the first motion.
    """
    import Path.Op.Custom as Custom

    plane, height = stands

    with _answering(controller):
        made = Custom.Create("Passes", parentJob=job)
    made.Label = translate("ToolAxis", "Finishing {}").format(plain(one.label))
    ensure(made, _FROM)
    made.OrientedFrom, made.MadeFor = one.operation, one.label
    made.ToolController = controller
    made.Source = "Text"
    made.Gcode = [*comments, *blocks(one, plane, height)]
    if made.ViewObject is not None:
        x, y, _ = _in_plane(one.path.cl[:1], plane)[0].tolist()
        _show_passes(made, FreeCAD.Vector(x, y, height))
    return made


def _show_job(job):
    """FreeCAD's own view of a job, which opens no dialog now."""
    import Path.Main.Gui.Job as JobGui

    job.ViewObject.Proxy = JobGui.ViewProvider(job.ViewObject)
    job.ViewObject.addExtension("Gui::ViewProviderGroupExtensionPython")
    job.ViewObject.Proxy.deleteOnReject = False


def _show_passes(made, start):
    """FreeCAD's own view of an operation; hidden, since the passes are seen on the part already."""
    import Path.Op.Gui.Base as OpGui
    import Path.Op.Gui.Custom as CustomGui

    made.ViewObject.Proxy = OpGui.ViewProvider(made.ViewObject, CustomGui.Command.res)
    made.ViewObject.Proxy.setDeleteObjectsOnReject(False)
    made.ViewObject.StartPosition = start  # else FreeCAD draws a line from the origin, through the part
    made.ViewObject.Visibility = False


class _Answer:
    """Stands for the user where FreeCAD's CAM asks which tool controller an operation takes.

    Parameters
    ----------
    controller : App.DocumentObject
    """

    def __init__(self, controller):
        self.controller = controller

    def selectedToolController(self):
        """The one that the operation is made for, whatever is selected in the tree."""
        return self.controller


@contextmanager
def _answering(controller):
    """Answer FreeCAD's CAM instead of the user."""
    import PathScripts.PathUtils as Utils

    before, Utils.UserInput = getattr(Utils, "UserInput", None), _Answer(controller)
    try:
        yield
    finally:
        Utils.UserInput = before
