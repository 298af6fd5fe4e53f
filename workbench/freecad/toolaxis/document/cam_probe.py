"""The one place that talks to FreeCAD's CAM workbench, by what its objects have and not by its version."""

from pathlib import PurePosixPath

_KINDS = {"bullnose": "torus", "torus": "torus", "ballend": "ball", "endmill": "flat", "taperedballnose": "tapered"}


def tool_from(thing):
    """The cutter of a tool controller or tool bit.

    Parameters
    ----------
    thing : App.DocumentObject
        A CAM ToolController or ToolBit.

    Returns
    -------
    toolaxis.tools.tool.Tool
        Its shank, where the bit tells one; no holder: FreeCAD knows none.

    Raises
    ------
    InvalidInput
        When it is neither, or its sizes make no cutter.
    UnsupportedGeometry
        When it is a tool that cannot be planned with.
    """
    from toolaxis.errors import InvalidInput, UnsupportedGeometry
    from toolaxis.tools.tool import Tool

    bit = thing if hasattr(thing, "Diameter") else getattr(thing, "Tool", None)
    if bit is None or not hasattr(bit, "Diameter"):
        raise InvalidInput(f"{thing.Label} is no tool: choose a tool controller or a tool bit of a CAM job")
    shape = _shape_of(bit)
    if shape not in _KINDS:
        raise UnsupportedGeometry(f"{bit.Label} is a {shape or 'tool of unknown shape'}: only end mills, ball ends, "
                                  "bull noses and tapered ball noses can be planned with")
    kind, diameter = _KINDS[shape], _size(bit, "Diameter")
    body = _body(bit)
    if kind == "torus":
        flat = _size(bit, "FlatRadius")
        corner = diameter / 2 - flat if flat is not None else _size(bit, "CornerRadius")
        if corner is None:
            raise InvalidInput(f"{bit.Label} has no corner radius: give it one in the CAM workbench")
        return Tool.flat(diameter, **body) if corner <= 0 else Tool.torus(diameter, corner, **body)
    if kind == "tapered":
        return Tool.tapered(diameter, diameter / 2, (_size(bit, "TaperAngle") or 0.0) / 2, **body)
    return (Tool.ball if kind == "ball" else Tool.flat)(diameter, **body)


def _shape_of(bit):
    """What kind of tool a bit is, in lower case without blanks: its type in 1.1, its shape's file in 1.0."""
    for name in ("ShapeType", "ShapeName", "ShapeID", "BitShape"):
        text = getattr(bit, name, None)
        if isinstance(text, str) and text:
            return PurePosixPath(text.replace("\\", "/")).stem.lower().replace(" ", "").replace("-", "")
    return ""


def _size(bit, name):
    value = getattr(bit, name, None)
    return None if value is None else float(getattr(value, "Value", value))


def _body(bit):
    """Length of the cutting edge and shank, as far as a bit tells them."""
    flute, thickness, length = (_size(bit, name) for name in ("CuttingEdgeHeight", "ShankDiameter", "Length"))
    body = {"flute_length": flute} if flute else {}
    if thickness and length and length > (flute or 0.0):
        body["shank"] = [(thickness / 2, 0.0), (thickness / 2, length)]
    return body


def controllers(document):
    """The tool controllers of a document's CAM jobs.

    Parameters
    ----------
    document : App.Document
    """
    return [thing for thing in document.Objects
            if type(getattr(thing, "Proxy", None)).__name__ == "ToolController"]


def speeds(controller):
    """Feed rate, mm/min, and spindle speed, rev/min, of a tool controller; None for what is not set.

    Parameters
    ----------
    controller : App.DocumentObject
    """
    feed, spindle = (_size(controller, name) for name in ("HorizFeed", "SpindleSpeed"))
    return (60 * feed if feed else None), spindle or None
