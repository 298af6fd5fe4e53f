"""The judge's verdict in the document: figures, worst places, and maps as coloured meshes that need no add-on."""

from typing import NamedTuple

import FreeCAD
from freecad.toolaxis.document.placement import matrix_of
from freecad.toolaxis.document.properties import Property, assign, ensure
from freecad.toolaxis.document.sub_surface_shape import SURFACE, is_shown

_GROUP = "Legend"
_PROPERTIES = (
    Property("String", "Shows", _GROUP, "Quantity shown by the colours", True),
    Property("Length", "ScaleMinimum", _GROUP, "Value at the dark end of the colours", True),
    Property("Length", "ScaleMaximum", _GROUP, "Value at the light end of the colours: the limit", True),
    Property("StringList", "Legend", _GROUP, "The colours in words", True),
    Property("FloatList", "Deviation", _GROUP, "Value at each point of the mesh, mm; infinite where never reached",
             True, True),
    Property("ColorList", "VertexColors", _GROUP, "Colour at each point of the mesh", True, True))
#: By how much the mesh is raised above the face, so that the face does not shine through: share of the face's size.
_RAISED = 2e-3
_MAPS = (("Scallops", "remaining", "Height left above the face"), ("Gouges", "gouge", "Depth of gouge"))


class MapMesh(NamedTuple):
    """A map as it enters a document: the mesh, and value, mm, and colour at each of its points."""

    mesh: object
    values: list
    colours: list


def drawn(verdict, frame):
    """The maps of a verdict, in any thread: nothing of a document is touched.

    Parameters
    ----------
    verdict : toolaxis.verify.verdict.OperationVerdict
    frame : FreeCAD.Placement
        Of the passes.

    Returns
    -------
    list of MapMesh
        Of the scallops, of the gouges.
    """
    import Mesh
    from freecad.toolaxis.document.colour_scale import judged  # brings numpy, which a document is opened without

    matrix, made = matrix_of(frame.inverse()), []
    for _, name, _ in _MAPS:
        some = shown_of(verdict, name)
        points, triangles = _join_maps(some)
        points = points @ matrix[:3, :3].T + matrix[:3, 3]
        mesh = Mesh.Mesh([tuple(row) for row in points[triangles.ravel()].tolist()])
        rows = _rows_of(mesh, points)
        values = _values(some, name)[rows]
        aside = _values(some, "declared")[rows].astype(bool) if name == "remaining" else None
        rgb = judged(values, limit_of(verdict, name), greatest_accepted(verdict, name), aside)
        colours = [(r / 255, g / 255, b / 255, 0.0) for r, g, b in rgb.tolist()]
        made.append(MapMesh(mesh, values.tolist(), colours))
    return made


def shown_of(verdict, name):
    """The surface maps that are shown: heights of what was machined, gouges also of the skin around it.

    Heights that are left of the skin are another operation's.

    Parameters
    ----------
    verdict : toolaxis.verify.verdict.OperationVerdict
    name : str
        "remaining" or "gouge".

    Returns
    -------
    tuple of toolaxis.verify.maps.SurfaceMap
    """
    return verdict.maps[:len(verdict.faces)] if name == "remaining" else verdict.maps


def keep(operation, verdict, frame, maps=None):
    """Write a verdict into an operation, and its maps into meshes beside the passes.

    Parameters
    ----------
    operation : App.DocumentObject
    verdict : toolaxis.verify.verdict.OperationVerdict
    frame : FreeCAD.Placement
        Of the passes.
    maps : list of MapMesh, optional
        From `drawn`, where they were drawn already.

    Returns
    -------
    list of App.DocumentObject
        Mesh of the scallops, mesh of the gouges.
    """
    import Mesh  # noqa: F401  makes the type known

    back = frame.inverse()
    _figures(operation, verdict, back)
    meshes = [_mesh(operation, name) for name, _, _ in _MAPS]
    for thing, one, (name, what, text) in zip(meshes, maps or drawn(verdict, frame), _MAPS, strict=True):
        _paint(thing, one, (limit_of(verdict, what), greatest_accepted(verdict, what)))
        thing.Label = f"{name} {operation.Label}"
        thing.Shows = text
        passes = next(one for one in operation.Group if one.isDerivedFrom("Path::Feature"))
        thing.setExpression("Placement", f"{passes.Name}.Placement")
        thing.Visibility = what == "remaining"
    for one in operation.Group:  # it would shine through the map
        if is_shown(one) and one.Shows == SURFACE:
            one.Visibility = False
    operation.Document.recompute([*meshes, operation])
    for thing in meshes:
        colour(thing)
    return meshes


def colour(thing):
    """Show the colours of a map: FreeCAD drops them whenever it draws the mesh anew.

    Parameters
    ----------
    thing : App.DocumentObject
        The mesh.
    """
    if thing.ViewObject is not None and hasattr(thing.ViewObject, "Coloring"):
        thing.ViewObject.Coloring = False
        thing.ViewObject.Coloring = True


def _figures(operation, verdict, back):
    finite = verdict.scallop_max if verdict.scallop_max < float("inf") else 0.0
    assign(operation, Verdict="passed" if verdict.passed else "failed", VerdictReasons=list(verdict.reasons),
           ScallopMax=float(finite), ShareWithin=float(verdict.share_within), GougeMax=float(verdict.gouge_max),
           GougeAllowed=float(verdict.gouge_allowed))
    for name, values, places in (("WorstScallops", "WorstScallopHeights", verdict.worst_scallop),
                                 ("WorstGouges", "WorstGougeDepths", verdict.worst_gouge)):
        setattr(operation, name, [back.multVec(FreeCAD.Vector(*place.point)) for place in places])
        setattr(operation, values, [float(place.value) for place in places])
    operation.WorstGougeMotions = [int(place.motion) for place in verdict.worst_gouge]


def _mesh(operation, name):
    found = [one for one in operation.Group if one.isDerivedFrom("Mesh::Feature") and one.Name.startswith(name)]
    if found:
        return found[0]
    thing = operation.Document.addObject("Mesh::Feature", name)
    ensure(thing, _PROPERTIES)
    operation.addObject(thing)
    return thing


def limit_of(verdict, name):
    """The limit that a map is drawn for, mm.

    Parameters
    ----------
    verdict : toolaxis.verify.verdict.OperationVerdict
    name : str
        "remaining" or "gouge".
    """
    return verdict.scallop_limit if name == "remaining" else verdict.gouge_allowed


def greatest_accepted(verdict, name):
    """The greatest value of a map that the judge accepts, mm.

    Parameters
    ----------
    verdict : toolaxis.verify.verdict.OperationVerdict
    name : str
        "remaining" or "gouge".
    """
    from toolaxis.verify.verdict import FACTOR

    return limit_of(verdict, name) * (FACTOR if name == "remaining" else 1.0)


def places_above(verdict):
    """Whether the map of heights has anything that stands for an area above what is accepted, and on the border.

    Points on the border stand for no area: they only show the worst.

    Parameters
    ----------
    verdict : toolaxis.verify.verdict.OperationVerdict

    Returns
    -------
    (bool, bool)
    """
    most = greatest_accepted(verdict, "remaining")
    rows = [(one.weight, ~one.declared & (one.remaining > most)) for one in shown_of(verdict, "remaining")]
    return any((above & (weight > 0)).any() for weight, above in rows), any(
        (above & (weight == 0)).any() for weight, above in rows)


def _paint(thing, one, limits):
    """Put a map into its mesh."""
    limit, most = limits
    thing.Mesh = one.mesh
    thing.Deviation, thing.VertexColors = one.values, one.colours
    assign(thing, ScaleMinimum=0.0, ScaleMaximum=float(limit), Legend=[
        "violet: 0", f"yellow: the limit, {limit:g} mm", f"orange: above {most:g} mm", "pink: never reached",
        "grey: rest material"])


def _rows_of(mesh, points):
    """For each point of a mesh, which keeps its points in single precision and in an order of its own, its row."""
    import numpy as np
    from scipy.spatial import cKDTree

    corners = np.array([tuple(point) for point in mesh.Topology[0]]).reshape(-1, 3)
    return cKDTree(points).query(corners)[1]


def _join_maps(maps):
    """Points a little above the faces, and triangles of all maps together."""
    import numpy as np
    from freecad.toolaxis.document.triangles import triangles_of  # the same

    points, triangles, before = [np.empty((0, 3))], [np.empty((0, 3), dtype=int)], 0
    for one in maps:
        normal = np.nan_to_num(one.face.normal(one.uv))
        points.append(one.point + _RAISED * one.face.diagonal * normal)
        triangles.append(triangles_of(one) + before)
        before += len(one.point)
    return np.concatenate(points), np.concatenate(triangles)


def _values(maps, name):
    import numpy as np

    return np.concatenate([np.empty(0), *(getattr(one, name) for one in maps)])
