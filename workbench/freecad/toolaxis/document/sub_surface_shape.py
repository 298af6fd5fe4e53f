"""Sub-surfaces in colours of their own, and what is left of them to clean-up as hatch lines: plain objects."""

import FreeCAD
from freecad.toolaxis.document.placement import carried, follow, matrix_of
from freecad.toolaxis.document.properties import Property, assign, ensure
from freecad.toolaxis.document.tessellation_offset import bulge

translate = FreeCAD.Qt.translate

_PROPERTIES = (
    Property("String", "Shows", "Tool Axis", "What it shows", True),
    Property("Color", "Colour", "Tool Axis", "Its colour", True, True),
    Property("Placement", "Frame", "Tool Axis", "This coordinate system in that of the part", True, True))
#: What the objects show, and how their names begin.
SURFACE, CLEAN_UP = "sub-surface", "clean-up"
_NAMES = {SURFACE: "SubSurface", CLEAN_UP: "CleanUp"}
#: Height over FreeCAD's picture of the face, greatest distance of triangles, and pitch of hatch lines, shares of the
#: diagonal.
_RAISED, _OFF, _PITCH = 1.2e-3, 1e-3, 1 / 60
_HATCH = (0.835, 0.369, 0.0)


def is_shown(thing):
    """Whether an object is one of these.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    return "Shows" in thing.PropertiesList and thing.Shows in _NAMES


def surface_colour(operation):
    """The colour that the sub-surface of an operation is shown in, (r, g, b); None where it is not shown.

    Parameters
    ----------
    operation : App.DocumentObject
    """
    return next((tuple(one.Colour)[:3] for one in operation.Group if is_shown(one) and one.Shows == SURFACE), None)


def show_surface(operation, op, chain, colour):
    """Show the sub-surface of an operation, and what it leaves; what was shown before goes.

    Parameters
    ----------
    operation : App.DocumentObject
    op : toolaxis.plan.operation.Operation
    chain : sequence of App.DocumentObject
        What carries the part along, `freecad.toolaxis.document.placement.chain_of`.
    colour : (r, g, b), optional
        From 0 to 1; without one, only what is left is shown.
    """
    back = matrix_of(carried(chain).inverse())
    height = _RAISED * op.face.diagonal + bulge(op.face, chain[-1])
    shape = _hatch_zones(op, back, height) if op.zones else None
    mesh = None if colour is None else _mesh(op.face, back, height)
    for what, made in ((SURFACE, mesh), (CLEAN_UP, shape)):
        thing = next((one for one in operation.Group if is_shown(one) and one.Shows == what), None)
        if made is None:
            if thing is not None:
                operation.Document.removeObject(thing.Name)
            continue
        if thing is None:
            thing = _add_shape(operation, what)
        _fill(thing, made, _HATCH if what == CLEAN_UP else colour)
        thing.setExpression("Placement", None)
        follow(thing, chain, "Frame")
        title = (translate("ToolAxis", "Sub-surface {}") if what == SURFACE
                 else translate("ToolAxis", "Rest material {}"))
        thing.Label = title.format(operation.Label)


def _add_shape(operation, what):
    import Mesh  # noqa: F401  makes the type known
    import Part  # noqa: F401

    kind = "Mesh::Feature" if what == SURFACE else "Part::Feature"
    thing = operation.Document.addObject(kind, _NAMES[what])
    ensure(thing, _PROPERTIES)
    operation.addObject(thing)
    thing.Shows = what
    return thing


def _fill(thing, made, colour):
    assign(thing, Colour=tuple(colour))
    if thing.Shows == SURFACE:
        thing.Mesh = made
    else:
        thing.Shape = made
    colour_view(thing)


def colour_view(thing):
    """Give an object its colour in the 3D view; it is not picked, so that the part behind it can be.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    view = thing.ViewObject if FreeCAD.GuiUp else None
    if view is None:
        return
    colour = tuple(thing.Colour)[:3]
    if thing.Shows == SURFACE:
        view.ShapeColor = colour
        view.Lighting = "Two side"
    else:
        view.LineColor = colour
        view.LineWidth = 2.0
        view.PointSize = 1.0
    view.Selectable = False


def _mesh(face, back, height):
    """Triangles of a face, a little above it, mm."""
    import Mesh
    import numpy as np

    from toolaxis.report.figures.tessellation import triangles

    found = triangles(face, _OFF * face.diagonal)
    corners = found.points[found.corners]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    at = np.zeros_like(found.points)
    for k in range(3):
        np.add.at(at, found.corners[:, k], normal)
    size = np.linalg.norm(at, axis=1, keepdims=True)
    raised = found.points + height * at / np.where(size > 0, size, 1.0)
    points = raised @ back[:3, :3].T + back[:3, 3]
    return Mesh.Mesh([tuple(row) for row in points[found.corners.ravel()].tolist()])


def _hatch_zones(op, back, height):
    """Hatch lines over the clean-up zones of an operation, a little above its mesh, as a compound of wires."""
    import Part

    from toolaxis.report.figures.hatch_lines import hatch_lines

    diagonal = op.face.diagonal
    wires = []
    for zone in op.zones:
        for line in hatch_lines(op.face.trimmed(zone.loops), _PITCH * diagonal, height + _RAISED * diagonal):
            rows = (line @ back[:3, :3].T + back[:3, 3]).tolist()
            points = [FreeCAD.Vector(*row) for row in rows]
            kept = [point for k, point in enumerate(points) if k == 0 or (point - points[k - 1]).Length > 1e-7]
            if len(kept) > 1:
                wires.append(Part.makePolygon(kept))
    return Part.Compound(wires) if wires else None
