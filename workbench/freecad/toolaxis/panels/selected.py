"""From what is selected to faces, or to a sentence that says why not."""

import FreeCAD

translate = FreeCAD.Qt.translate

#: Surfaces that are no sculptured ones, as FreeCAD's Part names them.
_PLAIN = ("Plane", "Cylinder", "Cone")


def faces_of(selection):
    """Faces in a selection, and sentences about what in it is no face.

    Parameters
    ----------
    selection : sequence of SelectionObject
        From `FreeCADGui.Selection.getSelectionEx()`.

    Returns
    -------
    faces : list of (object, "Face7")
    problems : list of str
    """
    faces, problems = [], []
    for entry in selection:
        problem = _no_shape(entry.Object)
        if problem:
            problems.append(problem)
        elif entry.SubElementNames:
            for name in entry.SubElementNames:
                _take(entry.Object, name, faces, problems)
        else:
            found = _sculptured(entry.Object)
            faces += found
            if not found:
                problems.append(translate("ToolAxis", "'{}' has planes, cylinders and cones only: select the faces to "
                                                      "machine one by one").format(entry.Object.Label))
    return faces, problems


def _take(thing, name, faces, problems):
    """Sort one sub-element in."""
    last = name.rsplit(".", 1)[-1]
    if last.startswith("Face") and last[4:].isdigit():
        faces.append((thing, last))
        return
    kind = {"Edge": translate("ToolAxis", "an edge"), "Vert": translate("ToolAxis", "a vertex")}.get(last[:4])
    text = translate("ToolAxis", "{} of '{}' is {}: select faces").format(last, thing.Label, kind) if kind else (
        translate("ToolAxis", "'{}' of '{}' is no face: select faces").format(last, thing.Label))
    problems.append(text)


def _no_shape(thing):
    """Why an object has no faces; empty where it may have some."""
    label = thing.Label
    if thing.TypeId.startswith("Mesh::"):
        return translate("ToolAxis", "'{}' is a mesh: turn it into a shape first, or select a face of a solid").format(
            label)
    if thing.TypeId.startswith("Sketcher::"):
        return translate("ToolAxis", "'{}' is a sketch: select faces of a solid or of a surface").format(label)
    shape = getattr(thing, "Shape", None)
    if shape is None:
        return translate("ToolAxis", "'{}' has no shape: select a body, or faces").format(label)
    if shape.isNull():
        return translate("ToolAxis", "the shape of '{}' is empty: recompute the document, or select another").format(
            label)
    if not shape.Faces:
        return translate("ToolAxis", "'{}' has no faces: select a solid or a surface").format(label)
    return ""


def _sculptured(thing):
    """Faces of an object that are no planes, cylinders or cones."""
    found = []
    for number, face in enumerate(thing.Shape.Faces, 1):
        try:
            plain = type(face.Surface).__name__ in _PLAIN
        except Exception:  # a kind of surface that FreeCAD's Python does not know is none of the plain ones
            plain = False
        if not plain:
            found.append((thing, f"Face{number}"))
    return found


def bodies_in(document, parts):
    """Objects of a document that may have to be avoided: solids and shells at the top, but for some parts.

    Parameters
    ----------
    document : App.Document
    parts : sequence of objects
    """
    own = {part.Name for part in parts}
    for part in parts:
        own |= {above.Name for above in part.InListRecursive}
    return [thing for thing in document.Objects if thing.Name not in own and _is_body(thing)]


def tools_in(document):
    """Tool controllers and tool bits of a document's CAM jobs, as (label, object); a bit in a controller only once.

    Parameters
    ----------
    document : App.Document
    """
    things = [thing for thing in document.Objects if getattr(thing, "Proxy", None) is not None]
    controllers = [thing for thing in things if type(thing.Proxy).__name__ == "ToolController"]
    held = {thing.Tool.Name for thing in controllers if getattr(thing, "Tool", None) is not None}
    bits = [thing for thing in things if thing.Name not in held
            and (hasattr(thing, "BitShape") or "ToolBit" in type(thing.Proxy).__name__)]
    return [(thing.Label, thing) for thing in (*controllers, *bits)]


def _is_body(thing):
    shape = getattr(thing, "Shape", None)
    if shape is None or thing.TypeId.startswith(("Path::", "Sketcher::", "PartDesign::Feature", "App::Origin")):
        return False
    inside = [above for above in thing.InList if above.TypeId == "PartDesign::Body" or hasattr(above, "Proxy")]
    return not inside and not shape.isNull() and bool(shape.Faces)
