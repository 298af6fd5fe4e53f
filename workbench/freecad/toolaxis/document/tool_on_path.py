"""The tool with shank and holder, standing on its passes: a solid of revolution that can be moved along them."""

from math import cos, pi, sin

import FreeCAD
from freecad.toolaxis.document.passes import PassStations
from freecad.toolaxis.document.properties import Property, Proxy

Vector = FreeCAD.Vector


def tool_shape(tool):
    """A compound of cutter, shank and holder as solids; tip at the origin, axis along +z.

    Parameters
    ----------
    tool : toolaxis.tools.tool.Tool
    """
    import Part

    lines = [_cutter_edges(tool.profile)]
    for outline in tool.outlines.values():
        rows = [(0.0, outline[0, 1]), *outline.tolist(), (0.0, outline[-1, 1])]
        lines.append(_polygon([Vector(radius, 0, z) for radius, z in rows]))
    axis = Vector(0, 0, 1)
    return Part.Compound([Part.makeSolid(Part.Face(wire).revolve(Vector(), axis, 360)) for wire in lines])


def _polygon(points):
    import Part

    kept = [point for k, point in enumerate(points) if k == 0 or (point - points[k - 1]).Length > 1e-9]
    return Part.makePolygon([*kept, kept[0]])


def _cutter_edges(profile):
    """The closed outline of the cutter, with its true corner arc."""
    import Part

    flat, corner, angle = profile.flat_radius, profile.corner_radius, profile.half_angle
    radius, z = profile.tangent_point
    edges, at = [], Vector()
    for end in (Vector(flat, 0, 0), Vector(radius, 0, z), Vector(profile.top_radius, 0, profile.top),
                Vector(0, 0, profile.top), Vector()):
        if (end - at).Length > 1e-9:
            edges.append(_line_or_arc(at, end, (flat, corner, angle) if (end.x, end.z) == (radius, z) else None))
        at = end
    return Part.Wire([edge for edge in edges if edge is not None])


def _line_or_arc(start, end, corner):
    import Part

    if corner is None or corner[1] < 1e-9:
        return Part.LineSegment(start, end).toShape()
    flat, radius, angle = corner
    half = (-pi / 2 - angle) / 2  # between straight down and the side's normal
    middle = Vector(flat + radius * cos(half), 0, radius + radius * sin(half))
    return Part.Arc(start, middle, end).toShape()


class ToolOnPasses(Proxy):
    """Moves the tool along its passes; where it stands is kept by an expression, also without this add-on.

    Parameters
    ----------
    thing : Part::FeaturePython
    """

    Type = "ToolAxisTool"
    properties = (
        Property("FloatConstraint", "Position", "Tool Axis", "Position along the passes, 0 to 1"),
        Property("LinkGlobal", "Passes", "Tool Axis", "The passes of the tool", True),
        Property("Placement", "Station", "Tool Axis", "Where the tool stands in the frame of its passes", True, True))

    def __init__(self, thing):
        super().__init__(thing)
        thing.Position = (0.0, 0.0, 1.0, 0.01)
        self._stations = None

    def loads(self, state):
        """Nothing is saved; the stations are found anew."""
        self._stations = None

    def execute(self, thing):
        """Put the tool on its passes as they are now."""
        self._stations = None
        self._stand(thing)

    def onChanged(self, thing, name):
        """Move the tool at once when its position is changed."""
        restoring = getattr(thing.Document, "Restoring", False)
        if name == "Position" and not restoring and getattr(thing, "Passes", None) is not None:
            self._stand(thing)

    def _stand(self, thing):
        if thing.Passes is None:
            return
        if self._stations is None:
            self._stations = PassStations(thing.Passes)
        station = self._stations.at(thing.Position)
        if not thing.Station.isSame(station, 0.0):
            thing.Station = station
        place = thing.Passes.Placement.multiply(station)
        if not thing.Placement.isSame(place, 1e-12):
            thing.Placement = place
