"""Origin and stock of a job in a document: picked vertices, and where both lie in the document's space."""

import FreeCAD
from freecad.toolaxis.document.shape_cache import known_of

#: How far a vertex may have moved from where it was picked, mm; documents round what they save.
_CLOSE = 1e-4
#: How the short form of a picked point begins.
_POINT = "point:"


def is_picked(origin):
    """Whether an origin is a vertex that was picked.

    Parameters
    ----------
    origin : str
        Its short form.
    """
    return origin.strip().lower().startswith(_POINT)


def origin_from_vertex(thing, name):
    """The short form of a vertex as an origin: the point in the part's own frame, with which it moves.

    Parameters
    ----------
    thing : App.DocumentObject
    name : str
        "Vertex7"; in a container or array "Box.Vertex7".

    Raises
    ------
    InvalidInput
        When it names no vertex of the object.
    """
    import Part

    from toolaxis.cad.freecad.documents import container_placement, shape_of
    from toolaxis.errors import InvalidInput

    found = Part.getShape(thing, name, needSubElement=True)
    if not name.rsplit(".", 1)[-1].startswith("Vertex") or found.isNull() or found.ShapeType != "Vertex":
        raise InvalidInput(f"{name} of {thing.Label} is not a vertex: select a vertex of the part for the origin")
    point = container_placement(thing).multVec(found.Point)
    own = shape_of(thing).Placement.inverse().multVec(point)
    return _POINT + ",".join(f"{value:.12g}" for value in (own.x, own.y, own.z))


def origin_in_document(origin, shapes):
    """An origin as the library takes it, in the document's space.

    Parameters
    ----------
    origin : str
        Short form; a picked point in the frame of the first shape.
    shapes : sequence of Part.Shape
        Of the parts, in the document's space.

    Raises
    ------
    InvalidInput
        When the vertex that was picked is not there any more.
    """
    from toolaxis.errors import InvalidInput
    from toolaxis.shape.work_origin import parse_origin

    if not is_picked(origin):
        return origin
    _, own = parse_origin(origin)
    point = shapes[0].Placement.multVec(FreeCAD.Vector(*own))
    if not any(vertex.Point.distanceToPoint(point) < _CLOSE for shape in shapes for vertex in shape.Vertexes):
        raise InvalidInput("the vertex selected as the origin is gone: select it again")
    return _POINT + ",".join(f"{value:.12g}" for value in (point.x, point.y, point.z))


def box_around(shapes):
    """The box around shapes as their surfaces reach, not as their control points do; asked again, it is at hand.

    FreeCAD's own BoundBox may be millimetres larger.

    Parameters
    ----------
    shapes : sequence of Part.Shape

    Returns
    -------
    list of (float, float, float)
        Lower and upper corner, mm.
    """
    found = []
    for shape in shapes:
        known = known_of(shape)
        if "box" not in known:
            box = shape.optimalBoundingBox(False, False)
            known["box"] = (box.XMin, box.YMin, box.ZMin), (box.XMax, box.YMax, box.ZMax)
        found.append(known["box"])
    lows, highs = zip(*found, strict=True)
    return [tuple(map(min, zip(*lows, strict=True))), tuple(map(max, zip(*highs, strict=True)))]


def is_on_box(origin):
    """Whether an origin is a point of a box along the axes of the document.

    Parameters
    ----------
    origin : str
        Its short form.
    """
    return bool(origin.strip()) and not is_picked(origin)


def setup_of(inputs):
    """Origin and datum of some inputs as the library takes them, for the parts as they are placed now.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs
        With a face at least.

    Returns
    -------
    origin : str
        In the document's space; empty for the datum.
    datum : (float, float, float)
        Origin of the first part's own frame; zeros where there is another one.

    Raises
    ------
    InvalidInput
        When the vertex that was picked is not there any more.
    """
    from toolaxis.cad.freecad.documents import shape_of

    shapes = [shape_of(thing) for thing in inputs.things]
    origin = origin_in_document(inputs.origin, shapes)
    return origin, (0.0, 0.0, 0.0) if origin else tuple(shapes[0].Placement.Base)


def stock_corners(plan):
    """Lower and upper corner of the stock of a plan, in the document's space; none where there is none.

    Parameters
    ----------
    plan : toolaxis.plan.plan.Plan
    """
    blank = plan.blank
    return [] if blank is None else [FreeCAD.Vector(*blank.low), FreeCAD.Vector(*blank.high)]
