"""An operation: what was asked for one face, and what came of it, as properties of a group with its objects."""

from math import degrees

import FreeCAD
from freecad.toolaxis.document.children import DeletionObserver, note
from freecad.toolaxis.document.inputs import FORMER_TOLERANCE
from freecad.toolaxis.document.kinds import is_operation
from freecad.toolaxis.document.properties import Property, Proxy, assign, ensure
from freecad.toolaxis.document.stale_label import MARK, mark_label
from freecad.toolaxis.document.staleness import same, standing, why_stale
from freecad.toolaxis.document.strategies import STRATEGIES

from toolaxis.plan.choices import DIRECTIONS, PASSES

_ASKED, _LOCKS, _FOUND, _JUDGED, _KEPT = "Inputs", "Locks", "Result", "Verdict", "Tool Axis"

INPUTS = (
    Property("LinkSubListGlobal", "Faces", _ASKED, "The face that is machined"),
    Property("String", "Tool", _ASKED, "Cutter: torus:12x1, ball:8, flat:20 or tapered:6x3x4"),
    Property("VectorList", "Shank", _ASKED, "Outline of the shank from the tip: radius, 0, height", False, True),
    Property("VectorList", "Holder", _ASKED, "Outline of the holder from its lower face: radius, 0, height", False,
             True),
    Property("Length", "StickOut", _ASKED, "Length from the tip to the holder's lower face"),
    Property("Length", "FluteLength", _ASKED, "Length of the cutting edge from the tip; 0: two diameters"),
    # Set in the panel: FreeCAD's own editor of properties shows 0.02 mm as 20 µm, and takes 0.1 for 0.1 µm.
    Property("Length", "Scallop", _ASKED, "Maximum scallop height; double-click the operation to change it", True),
    Property("Length", "Tolerance", _ASKED, "Allowed gouge of the finished face; double-click the operation to change "
                                            "it", True, former=FORMER_TOLERANCE),
    Property("Length", "Allowance", _ASKED, "Material to leave on the face; double-click the operation to change "
                                            "it", True),
    Property("String", "Limits", _ASKED, "Limits of the tool axis: cone:X,Y,Z,DEG or rotary:tilt=A..B,turn=C..D"),
    Property("LinkListGlobal", "Obstacles", _ASKED, "Bodies to avoid"),
    Property("Enumeration", "Objective", _ASKED, "Quantity that the choice of the tool axis "
                                                 "minimises", False, False, ("length", "passes")),
    Property("Enumeration", "Direction", _ASKED, "Direction of the passes", False, False,
             DIRECTIONS),
    Property("Enumeration", "CutPattern", _ASKED, "Passes along parameters of the face, in parallel planes, or "
                                                  "following the scallop height", False, False, PASSES),
    Property("Speed", "FeedRate", _ASKED, "Feed rate of the cutting moves"),
    Property("Float", "SpindleSpeed", _ASKED, "Spindle speed, rev/min"),
    Property("String", "Regions", _ASKED, "Sub-surfaces of each face: a number, auto, or nothing for whole faces"),
    Property("String", "Orientations", _ASKED, "Maximum number of orientations: a number, auto, or nothing for one "
                                               "each"),
    Property("Enumeration", "Method", _ASKED, "Method by which tool axes are found", False, False,
             ("sphere", "sectors", "jerk", "roman", "normal", "one", "ball")),
    Property("Enumeration", "Strategy", _ASKED, "Fixed axes, or how the axis moves while cutting", False, False,
             STRATEGIES),
    Property("Float", "Roughness", _ASKED, "Maximum Ra across the feed, micrometres, for strategies that use it"),
    Property("Bool", "Blades", _ASKED, "Plan one blade of a part with blades and copy it to the others"),
    Property("Bool", "Compare", _ASKED, "Also plan the same faces by other methods"),
    Property("StringList", "Rack", _ASKED, "Tool libraries, folders and tools to choose from; nothing: the tool above"),
    Property("Integer", "MostTools", _ASKED, "Maximum number of tools from the rack; 0: any number"),
    Property("Integer", "ToolNumber", _ASKED, "Place of the tool in the magazine; 0: none"),
    Property("String", "ToolTitle", _ASKED, "Name of the tool in the shop"),
    Property("Length", "Stock", _ASKED, "Material left by roughing; double-click the operation to change it", True),
    Property("Angle", "LeastLean", _ASKED, "Minimum lean of ball ends from the normal"),
    Property("Length", "GreatestStepOver", _ASKED, "Maximum step-over, 0: no limit; double-click the operation to "
                                                   "change it", True),
    Property("String", "AllowanceOn", _ASKED, "Allowances of single faces: 3,5-8=0.3;9=0.1"),
    Property("Length", "Lead", _ASKED, "Radius of lead-in and lead-out arcs, 0: straight ramps; double-click the "
                                       "operation to change it", True),
    Property("String", "AvoidFaces", _ASKED, "Faces of the part that no tool may touch: 3,5-8"),
    Property("String", "Held", _ASKED, "Clamped side of the part: z<12.5"),
    Property("String", "Origin", _ASKED, "Origin of the work coordinates: stock:top, part:top-front-left or "
             "point:X,Y,Z; nothing: that of the part"),
    Property("String", "StockBox", _ASKED, "Margins of the stock: 2, or 1,1,1,1,0,2 for -X, +X, -Y, +Y, -Z, +Z; "
             "nothing: as the CAM job makes it"))
LOCKS = (
    Property("Bool", "AxisLocked", _LOCKS, "The axis is kept when the operation is computed again"),
    Property("Bool", "FeedLocked", _LOCKS, "The feed direction is kept when the operation is computed again"),
    Property("Bool", "DrawnByHand", _LOCKS, "The border is kept when the plan is computed again"))
RESULTS = (
    Property("String", "Outcome", _FOUND, "Outcome: optimal, feasible, infeasible, not_found or cancelled", True),
    Property("StringList", "Reasons", _FOUND, "Reasons that limit the choice of the axis, or why there is none", True),
    Property("Bool", "Stale", _FOUND, "Out of date: the part or the inputs have changed since; recompute the "
                                      "operation", True),
    Property("StringList", "StaleReasons", _FOUND, "Changes that put the results out of date", True),
    Property("Vector", "Axis", _FOUND, "Tool axis from tip to spindle, as planned, in document coordinates", True),
    Property("String", "FeedParameter", _FOUND, "Parameter that varies along the passes, u or v", True),
    Property("Integer", "Passes", _FOUND, "Number of passes", True),
    Property("Length", "AverageStripWidth", _FOUND, "Area divided by cutting length", True),
    Property("Length", "CuttingLength", _FOUND, "Length of the cutting moves", True),
    Property("Time", "MachiningTime", _FOUND, "Time of passes and links", True),
    Property("Length", "Gouge", _FOUND, "Upper bound of the gouge in the machined faces", True),
    Property("Bool", "AxisMoves", _FOUND, "Whether the axis moves while cutting; Axis is then its mean", True),
    Property("Angle", "MeanLean", _FOUND, "Where the axis moves: its mean lean from the normal, or its constant lead",
             True),
    Property("Float", "LeftToCleanUp", _FOUND, "Share of the area left as rest material", True),
    Property("StringList", "NotChecked", _FOUND, "Not checked for collisions, because it was not given", True))
KEPT = (
    MARK,
    Property("String", "AxisMap", _KEPT, "Orientation with the map of all axes, JSON", True, True),
    Property("String", "Details", _KEPT, "Sub-surface and method, JSON", True, True),
    Property("String", "PlannedWith", _KEPT, "Inputs at the time of planning, JSON", True, True),
    Property("FloatList", "Signature", _KEPT, "Shapes at the time of planning", True, True),
    Property("StringList", "FrameFeatures", _KEPT, "Axes and planes of the work coordinate system", True, True),
    Property("VectorList", "StockCorners", _KEPT, "Corners of the stock at the time of planning", True, True),
    Property("IntegerList", "Motions", _KEPT, "Kind of each motion", True, True),
    Property("IntegerList", "Starts", _KEPT, "Where each pass starts", True, True))
VERDICT = (
    Property("String", "Verdict", _JUDGED, "Result of Verify: not verified, passed, failed, or out of date", True),
    Property("String", "JudgedWith", _JUDGED, "Inputs at the time of the verdict, JSON", True, True),
    Property("FloatList", "JudgedShapes", _JUDGED, "Shapes at the time of the verdict", True, True),
    Property("StringList", "VerdictReasons", _JUDGED, "Why it failed, and what was not checked", True),
    Property("Length", "ScallopMax", _JUDGED, "Maximum scallop height where the cutter came", True),
    Property("Float", "ShareWithin", _JUDGED, "Share of the area within 1.02 times the scallop height, rest material "
                                              "excluded", True),
    Property("Length", "GougeMax", _JUDGED, "Maximum gouge", True),
    Property("Length", "GougeAllowed", _JUDGED, "Allowed gouge", True),
    Property("VectorList", "WorstScallops", _JUDGED, "Points with the highest scallops, in the frame of the "
                                                     "plane", True),
    Property("FloatList", "WorstScallopHeights", _JUDGED, "Their heights, mm", True),
    Property("VectorList", "WorstGouges", _JUDGED, "Points with the deepest gouges, in the frame of the plane", True),
    Property("FloatList", "WorstGougeDepths", _JUDGED, "Their depths, mm", True),
    Property("IntegerList", "WorstGougeMotions", _JUDGED, "Motions that cut them, -1 where not known", True, True))

CLEARANCES = {
    "cutter": Property("Distance", "CutterClearance", _FOUND,
                       "Lower bound of the distance from the cutter to everything but the machined faces", True),
    "shank": Property("Distance", "ShankClearance", _FOUND,
                      "Lower bound of the distance from the shank to everything but the machined faces", True),
    "holder": Property("Distance", "HolderClearance", _FOUND,
                       "Lower bound of the distance from the holder to everything but the machined faces", True)}
#: Distances beyond this are shown as this, mm: nothing stands there.
_FAR = 1e6


class OperationProxy(Proxy):
    """Marks results stale when the part, an obstacle or an input changes.

    Parameters
    ----------
    thing : App::DocumentObjectGroupPython
    """

    Type = "ToolAxisOperation"
    properties = (*INPUTS, *LOCKS, *RESULTS, *KEPT, *VERDICT)

    def __init__(self, thing):
        super().__init__(thing)
        watch()

    def onDocumentRestored(self, thing):
        """Give an operation of an older version what it does not have yet, and tell what was not opened."""
        super().onDocumentRestored(thing)
        watch()
        note(thing)

    def execute(self, thing):
        """Compare with what was planned and judged; computes no axis."""
        mark(thing)


class _RecomputeObserver(DeletionObserver):
    """Marks also what FreeCAD left out of a recompute: because the part behind it failed, or as it does not know."""

    def slotRecomputedDocument(self, document):
        """Mark the operations of a document where something is invalid."""
        if any("Invalid" in thing.State for thing in document.Objects):
            for thing in filter(is_operation, document.Objects):
                mark(thing)
            for follower in self.followers:
                follower.marked(document)
        for follower in self.followers:
            follower.recomputed(document)


_WATCH = _RecomputeObserver()
_watching = []


def watch(*followers):
    """Follow all documents, once.

    Parameters
    ----------
    *followers
        What else is told of operations, once each: `deleted(thing, going)` as `DeletionObserver` has it,
        `marked(document)` after those of a document were marked, and `recomputed(document)`.
    """
    if not _watching:
        FreeCAD.addDocumentObserver(_WATCH)
        _watching.append(_WATCH)
    _WATCH.followers += [one for one in followers if one not in _WATCH.followers]


def mark(thing):
    """Set the stale mark of an operation by how things stand now; whether it is set.

    Parameters
    ----------
    thing : App.DocumentObject
    """
    compare(thing, why_stale)
    if thing.Verdict in ("passed", "failed") and not _verdict_holds(thing):
        assign(thing, Verdict="out of date", VerdictReasons=["the part or the inputs have changed since: verify again"])
    return thing.Stale


def compare(thing, why):
    """Set the stale mark of an operation or a whole plan by what makes it stale.

    Parameters
    ----------
    thing : App.DocumentObject
    why : callable
        Takes the object, returns sentences.
    """
    try:
        reasons = why(thing)
    except Exception as reason:  # not known to hold is not to hold
        FreeCAD.Console.PrintLog(f"Tool Axis: {reason!r}\n")
        reasons = [f"it cannot be compared with what was planned ({reason})"]
    assign(thing, StaleReasons=reasons, Stale=bool(reasons))
    if not reasons and thing.StaleMark:
        mark_label(thing, "")


def _verdict_holds(thing):
    try:
        words, shapes = standing(thing)
    except Exception as reason:
        FreeCAD.Console.PrintLog(f"Tool Axis: {reason!r}\n")
        return False
    return words == thing.JudgedWith and same(list(thing.JudgedShapes), shapes)


def set_inputs(thing, inputs):
    """Write inputs into the properties of an operation.

    Parameters
    ----------
    thing : App.DocumentObject
    inputs : freecad.toolaxis.document.inputs.JobInputs
        With one face.
    """
    thing.Faces = [(part, (name,)) for part, name in inputs.faces]
    thing.Obstacles = list(inputs.obstacles)
    for name, rows in (("Shank", inputs.shank), ("Holder", inputs.holder)):
        setattr(thing, name, [FreeCAD.Vector(radius, 0, z) for radius, z in rows])
    assign(thing, Tool=inputs.tool, StickOut=inputs.stickout, FluteLength=inputs.flute_length,
           Scallop=inputs.scallop, Tolerance=inputs.tolerance, Allowance=inputs.allowance,
           Limits=inputs.limits, Objective=inputs.objective, Direction=inputs.direction,
           CutPattern=inputs.passes,
           FeedRate=inputs.feedrate / 60, SpindleSpeed=inputs.spindle, Regions=str(inputs.regions or ""),
           Orientations=str(inputs.orientations or ""), Method=inputs.method, Blades=inputs.blades,
           Compare=inputs.compare, Strategy=inputs.strategy, Roughness=inputs.roughness, Rack=list(inputs.rack),
           MostTools=inputs.most_tools or 0, ToolNumber=inputs.tool_number, ToolTitle=inputs.tool_title,
           Stock=inputs.stock, LeastLean=inputs.least_lean, GreatestStepOver=inputs.greatest_step_over,
           AllowanceOn=inputs.allowance_on, Lead=inputs.lead, AvoidFaces=inputs.avoid_faces, Held=inputs.held,
           Origin=inputs.origin, StockBox=inputs.stock_box)


def set_results(thing, found, not_checked):
    """Write an orientation into the properties of an operation.

    Parameters
    ----------
    thing : App.DocumentObject
    found : toolaxis.plan.orientation.Orientation
    not_checked : sequence of str
    """
    axis = FreeCAD.Vector() if found.axis is None else FreeCAD.Vector(*(float(x) for x in found.axis))
    assign(thing, Outcome=found.outcome, Reasons=list(found.reasons), Axis=axis,
           FeedParameter=found.feed if found.axis is not None else "", Passes=int(found.passes),
           AverageStripWidth=float(found.average_strip_width), CuttingLength=float(found.length),
           Gouge=max(float(found.gouge), 0.0), LeftToCleanUp=float(found.unreached), NotChecked=list(not_checked),
           AxisMoves=found.lead is not None, MeanLean=degrees(found.lead or 0.0), Verdict="not verified",
           VerdictReasons=[])
    for name, described in CLEARANCES.items():
        _set_clearance(thing, described, found.clearance.get(name))


def _set_clearance(thing, described, distance):
    """A distance that is not known has no property, so that nobody takes it for zero or for safe."""
    if distance is None:
        if described.name in thing.PropertiesList:
            thing.removeProperty(described.name)
        return
    ensure(thing, (described,))
    setattr(thing, described.name, min(float(distance), _FAR))
