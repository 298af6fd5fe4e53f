"""What scripts hand to the public functions, checked and brought into one form before anything else happens."""

from difflib import get_close_matches
from math import isfinite
from pathlib import Path

import FreeCAD
from freecad.toolaxis.document.earlier_setups import faces_of_setup
from freecad.toolaxis.document.kinds import is_operation, is_plan, plan_of
from freecad.toolaxis.document.read_shapes import sculptured
from freecad.toolaxis.document.strategies import INDEXED, STRATEGIES
from freecad.toolaxis.document.work_origin import origin_from_vertex

_UNITS = FreeCAD.Units
_FACES = "give an object, (object, \"Face7\"), \"Block.Face7\", or a list of these"
_OPERATION = "give one of the operations that plan returns"
_ROUGHNESS = (_UNITS.Length, 1000.0, "a finite roughness in micrometres, such as 1.6")
_LENGTH = (_UNITS.Length, 1.0, "a finite length in mm, such as 0.02 or FreeCAD.Units.Quantity(\"0.02 mm\")")
#: For each number its unit, what FreeCAD's own value of it is multiplied with, and how to give it.
_NUMBERS = {"scallop": _LENGTH, "tolerance": _LENGTH, "allowance": _LENGTH, "stickout": _LENGTH,
            "flute_length": _LENGTH, "stock": _LENGTH, "greatest_step_over": _LENGTH, "lead": _LENGTH,
            "roughness": _ROUGHNESS, "least_lean": (_UNITS.Angle, 1.0, "a finite angle in degrees, such as 15"),
            "feedrate": (_UNITS.Velocity, 60.0, "a finite number in mm/min, such as 1000"),
            "spindle": (_UNITS.Frequency, 60.0, "a finite number in rev/min, such as 10000")}
_TEXTS = {"limits": "\"cone:0,0,1,60\"", "objective": "\"length\"", "direction": "\"zigzag\"", "passes": "\"planes\"",
          "method": "\"sphere\"", "strategy": f"\"{STRATEGIES[1]}\"", "allowance_on": "\"3,5-8=0.3\"",
          "avoid_faces": "\"3,5-8\"", "held": "\"z<12.5\""}
_COUNTS, _SWITCHES = ("regions", "orientations", "most_tools"), ("blades", "compare")
_OUTLINES = ("shank", "holder")
_LISTS = (*_OUTLINES, "obstacles")
_NAMES = (*_NUMBERS, *_TEXTS, *_LISTS, *_COUNTS, *_SWITCHES, "rack", "origin", "stock_box", "after")


def _refusal(text):
    from toolaxis.errors import InvalidInput

    return InvalidInput(text)


def _value_text(value):
    """A value as it is told in a message, not too long."""
    try:
        text = value.Label if isinstance(value, FreeCAD.DocumentObject) else repr(value)
    except (ReferenceError, RuntimeError):
        text = "deleted"
    return text if len(text) < 60 else f"{text[:50]}... ({type(value).__name__})"


def document_of(document):
    """A document, where it is an open one.

    Parameters
    ----------
    document : App.Document

    Raises
    ------
    InvalidInput
        When it is something else, or was closed.
    """
    if not isinstance(document, FreeCAD.Document):
        raise _refusal(f"document is {_value_text(document)}: give an open document, such as FreeCAD.ActiveDocument")
    try:
        known = FreeCAD.listDocuments().get(document.Name)
    except (ReferenceError, RuntimeError):
        known = None
    if known is None:
        raise _refusal("document was closed: open it again, and give that one")
    return document


def operation_of(operation, whole=False):
    """An operation, where it is one and still there.

    Parameters
    ----------
    operation : App.DocumentObject
    whole : bool
        Whether it may be a whole plan too.

    Raises
    ------
    InvalidInput
        When it is something else, or was deleted.
    """
    if not isinstance(operation, FreeCAD.DocumentObject):
        raise _refusal(f"operation is {_value_text(operation)}: {_OPERATION}")
    _check_there("operation", operation)
    if not is_operation(operation) and not (whole and is_plan(operation)):
        raise _refusal(f"operation is {operation.Label}, which is none of Tool Axis: {_OPERATION}")
    return operation


def progress_of(progress):
    """What a computation reports to.

    Parameters
    ----------
    progress : toolaxis.progress.Progress or None

    Raises
    ------
    InvalidInput
        When it is something else.
    """
    from toolaxis.progress import NO_PROGRESS, Progress

    if progress is not None and not isinstance(progress, Progress):
        raise _refusal(f"progress is {_value_text(progress)}: give a toolaxis.progress.Progress, or leave it out")
    return NO_PROGRESS if progress is None else progress


def faces_of(document, faces):
    """Faces as (object, "Face7") pairs from what is easy to write.

    Parameters
    ----------
    document : App.Document
    faces : object, (object, "Face7"), (object, ("Face7", 8, ...)), "Block.Face7", or list of these
        An object alone stands for its sculptured faces.

    Raises
    ------
    InvalidInput
        When nothing is given, or something that has no such faces.
    """
    if _is_pair(faces) or not isinstance(faces, list | tuple):
        items = [("faces", faces)]
    else:
        items = [(f"faces[{k}]", item) for k, item in enumerate(faces)]
    found = []
    for place, item in items:
        thing, names = _pair(document, place, item)
        found += [(thing, name) for name in names or sculptured(thing)]
    if not found:
        raise _refusal("nothing is selected: select one or more faces, or a body")
    return tuple(dict.fromkeys(found))


def _is_pair(item):
    """Whether something is an object with the names of its faces, and no list of objects."""
    if not isinstance(item, list | tuple) or len(item) != 2 or not isinstance(item[0], FreeCAD.DocumentObject):
        return False
    names = item[1] if isinstance(item[1], list | tuple) else [item[1]]
    return not any(isinstance(name, FreeCAD.DocumentObject | list | tuple) for name in names)


def _pair(document, place, item):
    """Object and names of faces, none for all that are sculptured."""
    if isinstance(item, FreeCAD.DocumentObject):
        return _own(document, place, item), []
    if isinstance(item, str):
        thing, _, name = item.partition(".")
        return _find_object(document, place, thing), [name] if name else []
    if hasattr(item, "SubElementNames"):  # what Gui.Selection.getSelectionEx lists
        item = (item.Object, list(item.SubElementNames))
    if not _is_pair(item):
        raise _refusal(f"{place} is {_value_text(item)}: {_FACES}")
    names = item[1] if isinstance(item[1], list | tuple) else [item[1]]
    return _own(document, place, item[0]), [_face_name(place, name) for name in names]


def _face_name(place, name):
    if isinstance(name, int) and not isinstance(name, bool):
        return f"Face{name}"
    if not isinstance(name, str):
        raise _refusal(f"{place} names the face {_value_text(name)}: write it as \"Face7\" or 7")
    return name


def _find_object(document, place, name):
    thing = document.getObject(name) if name else None
    if thing is None:
        raise _refusal(f"{place} names {name!r}, which is no object of {document.Label}: {_FACES}")
    return thing


def _own(document, place, thing):
    """An object, where it is one of this document and still there."""
    _check_there(place, thing)
    if thing.Document.Name != document.Name:
        raise _refusal(f"{place} is {thing.Label} of the document {thing.Document.Label}, not of {document.Label}: "
                       "link it into this one, or plan in that one")
    return thing


def _check_there(place, thing):
    try:
        there = thing.Document is not None
    except (ReferenceError, RuntimeError):
        there = False
    if not there:
        raise _refusal(f"{place} was deleted from its document: give another object")


def fields_of(document, given):
    """Fields of `freecad.toolaxis.document.inputs.JobInputs` from the arguments of a function.

    Parameters
    ----------
    document : App.Document
    given : dict
        By name; None leaves a number or a text to the default, and a shank, a holder or obstacles away.

    Raises
    ------
    InvalidInput
        When a name is not known, or a value is of the wrong kind.
    """
    found = {}
    for name, value in given.items():
        if name not in _NAMES:
            meant = get_close_matches(name, _NAMES) or sorted(_NAMES)
            raise _refusal(f"{name!r} is no argument of plan: use {', '.join(meant)}")
        if value is None and name not in _LISTS:
            continue
        if name in _NUMBERS:
            found[name] = _number(name, value)
        elif name in _OUTLINES:
            found[name] = _outline(name, value)
        elif name in _TEXTS:
            found[name] = _text(name, value)
        elif name in _COUNTS:
            found[name] = _count(name, value)
        elif name in _SWITCHES:
            found[name] = bool(value)
        elif name == "rack":
            found[name] = _rack(value)
        elif name == "origin":
            found[name] = _origin(document, value)
        elif name == "stock_box":
            found[name] = _margins(value)
        elif name == "after":
            found[name] = _setup(document, value)
        else:
            found[name] = _things(document, name, value)
    if "roughness" in found:
        from toolaxis.strategies.inputs import check_roughness

        check_roughness(found.get("strategy", INDEXED), found["roughness"] / 1000)
    return found


def _number(name, value):
    unit, factor, how = _NUMBERS[name]
    number = value
    if isinstance(value, str):
        try:
            number = _UNITS.Quantity(value)
        except Exception as reason:  # FreeCAD has kinds of its own for what it cannot read
            raise _refusal(f"{name} is {value!r}: give {how}") from reason
    if isinstance(number, _UNITS.Quantity):
        bare = number.Unit == _UNITS.Unit()
        number = number.Value * (1.0 if bare else factor) if bare or number.Unit == unit else None
    try:
        number = float("nan") if isinstance(number, bool | str) else float(number)
    except (TypeError, ValueError):
        number = float("nan")
    if not isfinite(number):
        raise _refusal(f"{name} is {_value_text(value)}: give {how}")
    return number


def _outline(name, value):
    """Rows of (radius, z); none where the part of the tool is not known."""
    try:
        if isinstance(value, str):
            raise TypeError(value)
        rows = tuple((float(radius), float(z)) for radius, z in (() if value is None else value))
    except (TypeError, ValueError) as reason:
        how = "give rows of (radius, height) in mm, such as [(10, 0), (10, 30)]"
        raise _refusal(f"{name} is {_value_text(value)}: {how}") from reason
    for k, row in enumerate(rows):
        if not all(map(isfinite, row)):
            raise _refusal(f"{name}[{k}] is {row}: radius and height must be finite, in mm")
    return rows


def _count(name, value):
    from toolaxis.partition.partition import check_count

    if name == "most_tools":
        return _most_tools(value)
    check_count(value, "orientations" if name == "orientations" else "sub-surfaces")
    return value


def _most_tools(value):
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise _refusal(f"most_tools is {_value_text(value)}: it must be a whole number above zero")
    return value


def _rack(value):
    """Sources of tools from one, or a list of these."""
    items = value if isinstance(value, list | tuple) else [value]
    wrong = next((item for item in items if not isinstance(item, str | Path)), None)
    if wrong is not None:
        raise _refusal(f"rack is {_value_text(wrong)}: give a tool library, a folder or a tool, such as "
                       "\"general-rack\", or a list of these")
    if not items:
        raise _refusal("the rack is empty: name at least one tool, library or folder")
    return tuple(map(str, items))


def _text(name, value):
    if not isinstance(value, str):
        raise _refusal(f"{name} is {_value_text(value)}: give a text, such as {_TEXTS[name]}")
    return value


def _origin(document, value):
    """The short form of an origin, from that or from a vertex: (object, "Vertex7") or "Block.Vertex7"."""
    from toolaxis.shape.work_origin import parse_origin

    pair = value
    if isinstance(value, str):
        owner, dot, vertex = value.partition(".")
        if not dot or not vertex.rsplit(".", 1)[-1].startswith("Vertex"):
            parse_origin(value)
            return value
        pair = _find_object(document, "origin", owner), vertex
    if not _is_pair(pair) or not isinstance(pair[1], str):
        raise _refusal(f"origin is {_value_text(value)}: give \"part:top\", \"stock:top-front-left\", or a vertex such "
                       "as \"Block.Vertex7\"")
    return origin_from_vertex(_own(document, "origin", pair[0]), pair[1])


def _margins(value):
    """Margins of the stock in their short form."""
    from toolaxis.shape.work_origin import format_margins, parse_margins

    return format_margins(parse_margins(value))


def _setup(document, value):
    """An earlier setup: a whole plan, or the one that an operation belongs to."""
    thing = _find_object(document, "after", value) if isinstance(value, str) else value
    if not isinstance(thing, FreeCAD.DocumentObject):
        raise _refusal(f"after is {_value_text(value)}: give the plan of the earlier setup, or one of its operations")
    thing = _own(document, "after", thing)
    if is_operation(thing):
        return plan_of(thing) or thing
    if not is_plan(thing):
        raise _refusal(f"after is {thing.Label}, which is none of Tool Axis: give the plan of the earlier setup, or "
                       "one of its operations")
    return thing


def check_faces_after(faces, setup):
    """Check that the faces that are named are those of the earlier setup, or those of its part.

    Parameters
    ----------
    faces : sequence of (object, "Face7")
        As `faces_of` gives them.
    setup : App.DocumentObject

    Raises
    ------
    InvalidInput
        When they are others.
    """
    asked = faces_of_setup(setup)
    if set(faces) == set(asked):
        return
    parts = {thing.Name for thing, _ in asked}
    if {thing.Name for thing, _ in faces} != parts:
        raise _refusal(f"the earlier setup {setup.Label} is one of another part: plan all setups of one part")
    part = faces[0][0]
    if len(parts) > 1 or set(faces) != {(part, name) for name in sculptured(part)}:
        raise _refusal("faces are named, and an earlier setup too, which has its own: give the part alone")


def _things(document, name, value):
    """Objects of a document from one, its name, or a list of these."""
    if value is None:
        return ()
    items = value if isinstance(value, list | tuple) else [value]
    found = []
    for k, item in enumerate(items):
        place = f"{name}[{k}]"
        if isinstance(item, str):
            item = _find_object(document, place, item)
        if not isinstance(item, FreeCAD.DocumentObject):
            raise _refusal(f"{place} is {_value_text(item)}: give objects of the document")
        found.append(_own(document, place, item))
    return tuple(dict.fromkeys(found))


def tool_of(tool):
    """A tool as it can be read, or a sentence.

    Parameters
    ----------
    tool : str, toolaxis.Tool, or a CAM tool controller or tool bit

    Raises
    ------
    InvalidInput
        When it is of another kind, or was deleted.
    """
    if isinstance(tool, FreeCAD.DocumentObject):
        _check_there("tool", tool)
    elif not isinstance(tool, str) and not hasattr(tool, "corner_radius"):
        raise _refusal(f"tool is {_value_text(tool)}: give its short form, such as \"torus:12x1\", a toolaxis.Tool, or "
                       "a tool controller or tool bit of a CAM job")
    return tool
