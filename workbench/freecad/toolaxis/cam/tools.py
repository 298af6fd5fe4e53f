"""Our cutters as tool bits and tool controllers of FreeCAD's CAM, by what its modules have and not by its version."""

from importlib.util import find_spec
from math import degrees

from toolaxis.tools.registry import cutter_named

_FLAT = 1e-6


def add_bit(document, tool, label):
    """A tool bit for a cutter.

    Parameters
    ----------
    document : App.Document
        The active one: FreeCAD's CAM makes its objects there.
    tool : toolaxis.tools.tool.Tool
    label : str

    Returns
    -------
    App.DocumentObject
        Where FreeCAD has no tapered cutters, or fails to draw this one, a ball end or end mill of the diameter at the
        tip; its label tells.
    """
    shape, kind = _shape_for(tool)
    bit = _bit(document, tool, label, (shape, kind))
    if shape == "taperedballnose" and _is_broken(bit):
        name = bit.Name
        bit.Proxy.onDelete(bit)
        if document.getObject(name) is not None:
            document.removeObject(name)
        bit = _bit(document, tool, label, cutter_named("ball").bits[0])
    bit.Label = label
    if bit.ViewObject is not None:
        bit.ViewObject.Visibility = False
    return bit


def _is_broken(bit):
    """Whether FreeCAD fails to draw a bit: nothing that hangs on it is computed then, a job's passes neither."""
    body = getattr(bit, "BitBody", None)
    if body is None:
        return False
    body.recompute(True)
    return any("Invalid" in one.State for one in (body, *body.OutListRecursive))


def _bit(document, tool, label, which):
    """A tool bit of one of FreeCAD's shapes."""
    shape, kind = which
    new = find_spec("Path.Tool.toolbit") is not None
    sizes = {name: f"{value:.9g} {'deg' if name == 'TaperAngle' else 'mm'}"
             for name, value in _sizes(tool, shape, new).items()}
    words = {"version": 2, "name": label, "shape": f"{shape}.fcstd", "shape-type": kind, "parameter": sizes,
             "attribute": {}}
    if new:
        from Path.Tool.toolbit import ToolBit

        bit = ToolBit.from_dict(words).attach_to_doc(document)
    else:
        import Path.Tool.Bit as Bits

        bit = Bits.Factory.CreateFromAttrs(words, "ToolBit")
    return bit


def _shape_for(tool):
    kind = tool.kind
    if kind == "tapered" and tool.flat_radius > _FLAT:
        kind = "torus" if tool.corner_radius > _FLAT else "flat"
    if kind == "torus" and tool.flat_radius <= _FLAT:
        kind = "ball"
    known = cutter_named(kind).bits
    return next((one for one in known[:-1] if _known(one[0])), known[-1])


def _known(shape):
    return find_spec("Path.Tool.shape") is not None and find_spec(f"Path.Tool.shape.models.{shape}") is not None


def _sizes(tool, shape, new):
    """The sizes that a shape has, mm and degrees."""
    shank = tool.outlines.get("shank")
    length = max(tool.stickout or 0.0, tool.flute_length + 1.0)
    found = {"Diameter": 2 * tool.radius, "CuttingEdgeHeight": tool.flute_length, "Length": length,
             "ShankDiameter": 2 * (tool.profile.top_radius if shank is None else float(shank[0, 0]))}
    if shape == "bullnose":
        found |= {"CornerRadius": tool.corner_radius} if new else {"FlatRadius": tool.flat_radius}
    if shape == "taperedballnose":
        found |= {"TaperAngle": 2 * degrees(tool.half_angle), "TaperDiameter": 2 * tool.profile.top_radius}
    return found


def label_of(tool):
    """What a tool is called in a job: its title, as far as programs may tell it in comments, else its short form.

    Parameters
    ----------
    tool : toolaxis.tools.tool.Tool
    """
    return tool.title.translate(str.maketrans("()", "[]")) or tool.name


def fill_controller(controller, wanted):
    """Give a tool controller a cutter, feeds and speed.

    Parameters
    ----------
    controller : App.DocumentObject
        A bit that it had before is removed.
    wanted : (Tool, float, float, int)
        The cutter, feed rate in mm/min, spindle speed in rev/min, and number.
    """
    tool, feedrate, spindle, number = wanted
    document, old = controller.Document, controller.Tool
    controller.Tool = add_bit(document, tool, label_of(tool))
    if old is not None:
        old.Proxy.onDelete(old)
    controller.Label = f"TC: {label_of(tool)}"
    controller.ToolNumber = number
    controller.HorizFeed = controller.VertFeed = feedrate / 60
    controller.SpindleSpeed = spindle


def add_controller(job, wanted):
    """A further tool controller in a job.

    Parameters
    ----------
    job : App.DocumentObject
    wanted : (Tool, float, float, int)
        As for `fill_controller`.
    """
    import Path.Tool.Controller as Controllers

    label = label_of(wanted[0])
    bit = add_bit(job.Document, wanted[0], label)
    controller = Controllers.Create(f"TC: {label}", bit, wanted[3])
    job.Proxy.addToolController(controller)
    controller.HorizFeed = controller.VertFeed = wanted[1] / 60
    controller.SpindleSpeed = wanted[2]
    return controller
