"""The one place that talks to FreeCAD's CAM workbench, by what its objects have and not by its version."""

from contextlib import suppress
from pathlib import Path as FilePath
from pathlib import PurePosixPath


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
    from toolaxis.tools.cutter import BIT_SIZES
    from toolaxis.tools.registry import cutter_of_bit
    from toolaxis.tools.tool import Tool

    bit = thing if hasattr(thing, "Diameter") else getattr(thing, "Tool", None)
    if bit is None or not hasattr(bit, "Diameter"):
        raise InvalidInput(f"{thing.Label} is no tool: choose a tool controller or a tool bit of a CAM job")
    shape = _shape_of(bit)
    cutter = cutter_of_bit(shape)
    if cutter is None:
        raise UnsupportedGeometry(f"{bit.Label} is a {shape or 'tool of unknown shape'}: only end mills, ball ends, "
                                  "bull noses and tapered ball noses can be planned with")
    body, sizes = _body(bit), cutter.sizes_of_bit({name: _size(bit, name) for name in BIT_SIZES})
    corner = sizes.get("corner_radius", 0.0)
    if corner is None:
        raise InvalidInput(f"{bit.Label} has no corner radius: give it one in the CAM workbench")
    if "corner_radius" in cutter.sizes and corner <= 0:
        return Tool.flat(sizes["diameter"], **body)
    return Tool.of(cutter.name, *(sizes[name] for name in cutter.sizes), **body)


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


def tool_libraries():
    """The tool libraries of FreeCAD's CAM, (what is shown, file): the user's own, then those that come with it."""
    folders = []
    with suppress(Exception):  # a FreeCAD without CAM, or one that keeps no libraries in files
        import Path.Preferences as CamPreferences

        folders = [FilePath(str(CamPreferences.getAssetPath())) / "Tool" / "Library",
                   FilePath(str(CamPreferences.getBuiltinLibraryPath()))]
    found = {}
    for folder in folders:
        for file in sorted(folder.glob("*.fctl")):
            found.setdefault(file.stem, str(file))
    return list(found.items())


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
