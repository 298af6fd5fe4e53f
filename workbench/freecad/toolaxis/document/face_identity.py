"""What a face looks like, so that it is known again when the faces of a part are renumbered."""

import FreeCAD
from freecad.toolaxis.document.read_shapes import number_in
from freecad.toolaxis.document.shape_cache import known_of

_KINDS = {"Plane": "plane", "Cylinder": "cylinder", "Cone": "cone", "Sphere": "sphere", "Toroid": "torus",
          "BSplineSurface": "B-spline surface", "BezierSurface": "Bezier surface",
          "SurfaceOfExtrusion": "extruded surface", "SurfaceOfRevolution": "surface of revolution"}
#: Share of a face's size by which a face that is the same may differ.
_SAME = 1e-6


def facts_of(thing, name):
    """Kind, area and centre of a face, in the frame of its own part, so that moving the part changes nothing.

    Parameters
    ----------
    thing : App.DocumentObject
    name : str

    Returns
    -------
    dict
        Numbers and texts only.

    Raises
    ------
    InvalidInput
        When there is no such face.
    """
    from toolaxis.cad.freecad.documents import shape_of

    shape = shape_of(thing)
    number, known = number_in(thing, shape, name), known_of(shape)
    if number not in known:
        known[number] = _facts(shape, shape.Faces[number - 1])
    return dict(known[number])


def _facts(shape, face):
    centre = shape.Placement.inverse().multVec(face.CenterOfMass)
    return {"kind": kind_of(face), "area": face.Area, "centre": list(centre)}


def kind_of(face):
    """What a face is, in words.

    Parameters
    ----------
    face : Part.Face
    """
    try:
        name = type(face.Surface).__name__
    except Exception:  # a kind of surface that FreeCAD's Python does not know
        return "surface"
    return _KINDS.get(name, "surface")


def what_became(thing, names, then, changed):
    """What became of a planned face, as sentences; none where nothing is to be said of it.

    Parameters
    ----------
    thing : App.DocumentObject
    names : (str, str)
        Of the face as it was planned, and as the operation has it now.
    then : dict or None
        From `facts_of` at the time of planning; None in older documents.
    changed : bool
        Whether the part has changed since.
    """
    from toolaxis.errors import ToolAxisError

    before, now = names[0], names[1].lstrip("?")
    if then is None:
        return [] if before == now else ["another face was chosen"]
    try:
        found = facts_of(thing, now)
    except ToolAxisError:
        return [f"{now} is not there any more: {_remedy(thing, then)}"]
    if _alike(then, found):
        return [] if before == now else [f"the faces were renumbered: {before} is {now} now"]
    if before != now and not changed:
        return [f"another face was chosen: {now}, {_facts_text(found)}, instead of {before}, {_facts_text(then)}"]
    if before == now and then["kind"] == found["kind"] and _again(thing, then) is None:
        return []
    return [f"the faces were renumbered: {now} is another one now, {_facts_text(found)}; planned was "
            f"{_facts_text(then)}: {_remedy(thing, then)}"]


def _facts_text(facts):
    area = FreeCAD.Units.Quantity(facts["area"], FreeCAD.Units.Area).UserString.replace("^2", "²")
    article = "an" if facts["kind"][0] in "aeiou" else "a"
    return f"{article} {facts['kind']} of {area}"


def _remedy(thing, then):
    again = _again(thing, then)
    return "choose it anew in Faces" if again is None else f"that is {again} now, put it into Faces"


def _alike(one, other):
    size = one["area"] ** 0.5
    apart = FreeCAD.Vector(*one["centre"]).distanceToPoint(FreeCAD.Vector(*other["centre"]))
    return (one["kind"] == other["kind"] and abs(one["area"] - other["area"]) <= _SAME * size * size
            and apart <= _SAME * size)


def _again(thing, then):
    """The name that a planned face has now; None where it is not found."""
    from toolaxis.cad.freecad.documents import shape_of
    from toolaxis.errors import ToolAxisError

    try:
        shape = shape_of(thing)
    except ToolAxisError:
        return None
    numbers = (k for k, face in enumerate(shape.Faces, 1) if _alike(then, _facts(shape, face)))
    return next((f"Face{k}" for k in numbers), None)
