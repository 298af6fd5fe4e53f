"""From what is selected to faces, or to a sentence that says why not."""

import FreeCAD
import FreeCADGui
from freecad.toolaxis.document.cam_probe import controllers
from freecad.toolaxis.document.read_shapes import number_in, sculptured
from freecad.toolaxis.services.messages import shown
from freecad.toolaxis.services.obstacles import bodies_in

translate = FreeCAD.Qt.translate


def selected_faces(document):
    """Faces in a document's selection, and sentences about what in it is no face.

    Parameters
    ----------
    document : App.Document

    Returns
    -------
    faces : list of (object, "Face7")
        Where a link or an array carries what was picked, the object is that one, and the name "Box.Face7".
    problems : list of str
    """
    from toolaxis.errors import ToolAxisError

    faces, problems = [], []
    for entry in FreeCADGui.Selection.getSelectionEx(document.Name, 0):
        for name in entry.SubElementNames or ("",):
            try:
                faces += _faces(*owner_of(entry.Object, name))
            except ToolAxisError as reason:
                problems.append(shown(str(reason)))
    return list(dict.fromkeys(faces)), list(dict.fromkeys(problems))


def selects_whole_bodies(document):
    """Whether all that is selected in a document are objects as a whole, none of their faces or edges.

    Parameters
    ----------
    document : App.Document
    """
    entries = FreeCADGui.Selection.getSelectionEx(document.Name, 0)
    names = [name for entry in entries for name in entry.SubElementNames or ("",)]
    elements = [name.split(".")[-1] for name in names]
    return bool(elements) and not any(elements)


def faces_of_only_body(document):
    """The sculptured faces of the body that a document has in sight; none where there are several, or it has none.

    Parameters
    ----------
    document : App.Document
    """
    from toolaxis.errors import ToolAxisError

    bodies = [thing for thing in bodies_in(document, []) if thing.Visibility]
    if len(bodies) != 1:
        return []
    try:
        return _faces(bodies[0], "")
    except ToolAxisError:
        return []


def _faces(thing, name):
    """The face of a name, or the sculptured faces of the whole object."""
    from toolaxis.cad.freecad.documents import shape_of

    shape = shape_of(thing)
    if not name:
        return [(thing, face) for face in sculptured(thing)]
    number_in(thing, shape, name)
    return [(thing, name)]


def owner_of(thing, name):
    """The object that a picked element belongs to, and the element's name in it.

    Containers are looked through; links and arrays keep what is in them, because they place it; a body stands for its
    last feature.

    Parameters
    ----------
    thing : App.DocumentObject
        What was picked at the top.
    name : str
        Way to the element, "Part.Box.Face7", or empty.
    """
    *way, element = name.split(".")
    while way and not (thing.isDerivedFrom("App::Link") or thing.isDerivedFrom("App::LinkElement")):
        inner = thing.getSubObject(f"{way[0]}.", 1)
        if inner is None:
            break
        if thing.isDerivedFrom("PartDesign::Body") and inner == thing.Tip and len(way) == 1:
            return thing, element
        thing, way = inner, way[1:]
    return thing, ".".join([*way, element])


def tools_in(document):
    """Tools to choose from, as (label, object or name).

    Tool controllers of a document's CAM jobs come first, then tool bits that are in none of them, then the library.

    Parameters
    ----------
    document : App.Document
    """
    from toolaxis.job.inputs.tool_file import library

    found = controllers(document)
    held = {thing.Tool.Name for thing in found if getattr(thing, "Tool", None) is not None}
    bits = [thing for thing in document.Objects if thing.Name not in held and thing not in found
            and "ToolBit" in type(getattr(thing, "Proxy", None)).__name__]
    return [*((thing.Label, thing) for thing in (*found, *bits)), *((name, name) for name in library())]
