"""What a job in a document is given, as one value that scripts, panels and the tree share."""

import json
from dataclasses import dataclass, replace
from math import radians

from freecad.toolaxis.document.children import frame_of
from freecad.toolaxis.document.earlier_setups import check_earlier_setup, faces_of_setup
from freecad.toolaxis.document.kinds import is_plan, operations_in, plan_of
from freecad.toolaxis.document.machine_limits import PREFIX
from freecad.toolaxis.document.placement import matrix_of
from freecad.toolaxis.document.strategies import INDEXED, ROUGHNESS, check_strategy, keeps_roughness
from freecad.toolaxis.document.work_origin import is_on_box

from toolaxis.plan.choices import ISO

#: Machining tolerance unless given, mm; and what it was before it could be given.
TOLERANCE, FORMER_TOLERANCE = 0.01, 0.002


@dataclass(frozen=True)
class KeptSubSurface:
    """A sub-surface that is kept as it is: its border, and what is locked of its axis and feed.

    Attributes
    ----------
    thing : App.DocumentObject
    name : str
        Of the face.
    region : tuple of loops, each a tuple of (u, v)
        Empty for the whole face.
    axis : (x, y, z) or None
        In the document's space; a lock where `locked`, else tried before others.
    feed : "u", "v" or ""
        A locked feed.
    locked : bool
    suffix : str
        Of its name, "a" in Face7a.
    drawn : bool
        Whether its border was drawn by hand.
    """

    thing: object
    name: str
    region: tuple = ()
    axis: tuple | None = None
    feed: str = ""
    locked: bool = False
    suffix: str = ""
    drawn: bool = False


@dataclass(frozen=True)
class JobInputs:
    """What a job in a document is given; mm, and degrees inside the short forms.

    Attributes
    ----------
    faces : tuple of (object, "Face7")
        What is machined: the faces of the earlier setup where there is one.
    tool : str
        Short form of the cutter.
    shank, holder : tuple of (radius, z)
        Outlines, the shank's from the tip and the holder's from its own lower face; empty where not known.
    stickout, flute_length : float
        Lengths from the tip to the holder, and of the cutting edge; 0 for two diameters of that, as far as the
        stick-out allows.
    scallop, allowance, tolerance : float
        The last is the machining tolerance: how deep the finished surface may be cut too deep.
    limits : str
        Limits of the axis in their short form, in the document's space; empty for none.
    obstacles : tuple of objects
        Bodies to avoid.
    objective, direction : str
    feedrate, spindle : float
        mm/min, rev/min
    regions, orientations : int, "auto" or None
        Sub-surfaces for each face, and different axes at most; None for whole faces, and an axis for each.
    method : str
        How axes are found.
    blades : bool
        Whether blades are looked for where all sculptured faces of one part are chosen.
    compare : bool
        Whether other methods plan the same faces too.
    pieces : tuple of KeptSubSurface
        Sub-surfaces that are kept as they are.
    strategy : str
        One of `freecad.toolaxis.document.strategies.STRATEGIES`: fixed axes, or how the axis moves.
    roughness : float
        Greatest Ra across the feed, micrometres; for strategies that look at it.
    passes : str
        One of `toolaxis.plan.choices.PASSES`: along parameters of the face, in parallel planes that contain the axis,
        in a field, or the shorter of the first and the last.
    rack : tuple of str
        What holds the tools to choose from: names, files and folders as `toolaxis.load_tools` takes them; empty where
        `tool` is the only one.
    most_tools : int or None
        Greatest number of them that are used.
    tool_number, tool_title : int, str
        Place of `tool` in the magazine, 0 for none, and what the shop calls it.
    stock, greatest_step_over, lead : float
        What roughing left, greatest distance of passes, and radius of the arcs to and from passes; 0 for none.
    least_lean : float
        Least angle of ball ends to the normal, degrees.
    allowance_on : str
        What is left on some faces in place of `allowance`, "3,5-8=0.3;9=0.1" by their numbers.
    avoid_faces : str
        Numbers of faces of the part that no tool may touch, "3,5-8".
    held : str
        The side that is held in the clamping, "z<12.5", in the document's space.
    origin : str
        Where work coordinate systems have their origin, "stock:top-front-left" with the box along the document's axes,
        or "point:x,y,z" for a picked vertex, in the first part's own frame; empty for the origin of that.
    stock_box : str
        Margins of the box that the part is cut from, "2" or "1,1,1,1,0,2" for -x, +x, -y, +y, -z and +z, mm; empty
        where the CAM job makes it.
    after : App.DocumentObject or None
        The setup before this one, see `freecad.toolaxis.document.earlier_setups.is_setup`: only what it and those
        before it leave is machined.
    """

    faces: tuple = ()
    tool: str = "torus:12x1"
    shank: tuple = ()
    holder: tuple = ()
    stickout: float = 60.0
    flute_length: float = 0.0
    scallop: float = 0.02
    allowance: float = 0.0
    limits: str = ""
    obstacles: tuple = ()
    objective: str = "length"
    direction: str = "zigzag"
    feedrate: float = 1000.0
    spindle: float = 10000.0
    regions: int | str | None = None
    orientations: int | str | None = None
    method: str = "sphere"
    blades: bool = True
    compare: bool = False
    pieces: tuple = ()
    strategy: str = INDEXED
    roughness: float = ROUGHNESS
    tolerance: float = TOLERANCE
    passes: str = ISO
    rack: tuple = ()
    most_tools: int | None = None
    tool_number: int = 0
    tool_title: str = ""
    stock: float = 0.0
    least_lean: float = 0.0
    greatest_step_over: float = 0.0
    allowance_on: str = ""
    lead: float = 0.0
    avoid_faces: str = ""
    held: str = ""
    origin: str = ""
    stock_box: str = ""
    after: object = None

    def __post_init__(self) -> None:
        for name in ("shank", "holder"):
            rows = tuple((float(radius), float(z)) for radius, z in getattr(self, name) or ())
            object.__setattr__(self, name, rows)
        for name in ("faces", "obstacles", "pieces", "rack"):
            object.__setattr__(self, name, tuple(getattr(self, name) or ()))
        if self.after is not None:
            object.__setattr__(self, "faces", faces_of_setup(self.after))
        if not keeps_roughness(self.strategy):
            object.__setattr__(self, "roughness", ROUGHNESS)

    @property
    def things(self):
        """The objects whose faces are machined, each once."""
        return tuple({(thing.Document.Name, thing.Name): thing for thing, _ in self.faces}.values())

    @property
    def divides(self):
        """Whether faces are divided, or axes found otherwise than face by face."""
        return bool(self.regions or self.orientations or self.pieces or self.method != "sphere")

    @property
    def moves(self):
        """Whether the axis moves while it cuts."""
        return self.strategy != INDEXED

    @property
    def placed(self):
        """Whether something is asked for in the document's space, in which the part has to stay where it is."""
        return bool(self.limits or self.held or self.stock_box or is_on_box(self.origin))

    def assembled(self):
        """The whole tool, where it is the only one.

        Raises
        ------
        InvalidInput
            When the sizes make none.
        """
        from toolaxis.tools.tool import Tool

        body = {name: [list(row) for row in getattr(self, name)] for name in ("shank", "holder") if getattr(self, name)}
        if self.flute_length:
            body["flute_length"] = self.flute_length
        return Tool.parse(self.tool, stickout=self.stickout or None, number=self.tool_number or None,
                          title=self.tool_title, **body)

    def tools(self):
        """The tools to plan with: those of the rack with rates for all of them, else the only one.

        Returns
        -------
        tuple of toolaxis.tools.tool.Tool

        Raises
        ------
        InvalidInput
            When the sizes make no tool, or the rack cannot be read.
        """
        if not self.rack:
            return (self.assembled(),)
        from toolaxis.job.inputs.tool_library import load_library

        return tuple(replace(tool, feedrate=tool.feedrate or self.feedrate, spindle=tool.spindle or self.spindle)
                     for tool in load_library(self.rack).tools)

    def with_tool(self, tool):
        """The same with one tool of the rack as the only one, at its own rates.

        Parameters
        ----------
        tool : toolaxis.tools.tool.Tool
        """
        rows = {name: () if getattr(tool, name) is None else tuple(map(tuple, getattr(tool, name).tolist()))
                for name in ("shank", "holder")}
        return replace(self, rack=(), most_tools=None, tool=tool.name, stickout=tool.stickout or 0.0,
                       flute_length=flute_of(tool), feedrate=tool.feedrate or self.feedrate,
                       spindle=tool.spindle or self.spindle, tool_number=tool.number, tool_title=tool.title, **rows)

    def job(self):
        """The same as the library knows it.

        Raises
        ------
        InvalidInput
            When a value is out of range.
        """
        from toolaxis.job.inputs.spec import numbers_to_avoid, parse_allowances
        from toolaxis.plan.plan import PlanInputs as JobInputs
        from toolaxis.tolerances import Tolerance

        return JobInputs(self.scallop, self.allowance, method=self.strategy if self.moves else self.method,
                         objective=self.objective, direction=self.direction,
                         limits="" if self.limits.startswith(PREFIX) else self.limits, feedrate=self.feedrate,
                         spindle=self.spindle,
                         tolerance=replace(Tolerance.of(self.tolerance), least_lean=radians(self.least_lean)),
                         roughness=self.roughness / 1000 if keeps_roughness(self.strategy) else 0.0,
                         passes=self.passes, avoid=numbers_to_avoid(self.avoid_faces), held=self.held,
                         stock=self.stock, greatest_step_over=self.greatest_step_over,
                         allowance_on=parse_allowances(self.allowance_on), lead=self.lead, origin=self.origin,
                         stock_box=self.stock_box)

    def check_tools(self):
        """Check the tools, and that what is asked for goes with them and with the parts.

        Raises
        ------
        InvalidInput
            When a value is out of range, or does not go with the tools.
        """
        from toolaxis.errors import InvalidInput
        from toolaxis.job.inputs.rack_inputs import RackInputs, check_rack_inputs

        job, tools = self.job(), self.tools()
        if self.rack and len(tools) > 1:
            job.check_rack(sorted(tools, key=lambda tool: -tool.radius))
            check_rack_inputs(RackInputs(self.method, self.moves, self.regions, self.orientations is not None,
                                         bool(self.pieces), self.compare))
        else:
            job.check_tool(tools[0])
        if len(self.things) > 1 and (job.avoid or job.allowance_on):
            raise InvalidInput("faces to avoid and allowances on faces are numbered in one part and several are "
                               "chosen: choose faces of one part")
        self.check_one_part()
        check_earlier_setup(self)

    def check_one_part(self):
        """Check that an origin and a stock of their own are for one part.

        Raises
        ------
        InvalidInput
            When faces of several are chosen.
        """
        from toolaxis.errors import InvalidInput

        if len(self.things) > 1 and (self.origin or self.stock_box):
            raise InvalidInput("origin and stock are chosen for one part and faces of several are chosen: choose faces "
                               "of one part, or the part's own origin and no stock")

    def check_counts(self):
        """Check the numbers of sub-surfaces and axes, and the strategy.

        Raises
        ------
        InvalidInput
            When one is out of range, or does not go with method, tool or machine.
        """
        from toolaxis.partition.partition import check_count

        check_count(self.regions)
        check_count(self.orientations, "orientations")
        check_strategy(self)


def inputs_of(thing):
    """What an operation or a whole plan was made with, or is to be made with again.

    Parameters
    ----------
    thing : App.DocumentObject

    Returns
    -------
    JobInputs
        Without faces where the part was deleted.
    """
    faces = tuple((part, name) for part, names in thing.Faces for name in names if name)
    rows = {name: tuple((point.x, point.z) for point in getattr(thing, name.capitalize()))
            for name in ("shank", "holder")}
    pieces = kept_pieces(thing) if is_plan(thing) else [own_piece(thing, faces)]
    return JobInputs(faces, thing.Tool, rows["shank"], rows["holder"], thing.StickOut.Value, thing.FluteLength.Value,
                     thing.Scallop.Value, thing.Allowance.Value, thing.Limits, tuple(thing.Obstacles),
                     thing.Objective, thing.Direction, round(60 * thing.FeedRate.Value, 9),
                     thing.SpindleSpeed, count_from(thing.Regions), count_from(thing.Orientations), thing.Method,
                     thing.Blades, thing.Compare, tuple(piece for piece in pieces if piece is not None),
                     thing.Strategy, thing.Roughness or ROUGHNESS, thing.Tolerance.Value, thing.CutPattern,
                     tuple(thing.Rack), thing.MostTools or None, thing.ToolNumber, thing.ToolTitle, thing.Stock.Value,
                     thing.LeastLean.Value, thing.GreatestStepOver.Value, thing.AllowanceOn, thing.Lead.Value,
                     thing.AvoidFaces, thing.Held, thing.Origin, thing.StockBox,
                     thing.After if is_plan(thing) else None)


def flute_of(tool):
    """The length of a tool's cutting edge, mm; 0 where it is the usual one.

    Parameters
    ----------
    tool : toolaxis.tools.tool.Tool
    """
    from toolaxis.tools.tool import Tool

    usual = Tool.parse(tool.name, stickout=tool.stickout).flute_length
    return 0.0 if abs(tool.flute_length - usual) < 1e-9 else float(tool.flute_length)


def count_from(text):
    """A number of sub-surfaces or axes from a property: a whole number, "auto", or None for an empty text.

    Parameters
    ----------
    text : str
    """
    return int(text) if text.strip().isdigit() else text.strip() or None


def own_piece(operation, faces):
    """An operation's own sub-surface where that is no whole face or something of it is locked; else None.

    Parameters
    ----------
    operation : App.DocumentObject
    faces : sequence of (object, "Face7")
        Of the operation; nothing where the part was deleted.
    """
    details = json.loads(operation.Details or "{}")
    region = details.get("region") or ()
    if not faces or not (region or operation.AxisLocked or operation.FeedLocked):
        return None
    axis = locked_axis(operation)
    number = str(details.get("face", ""))
    return KeptSubSurface(*faces[0], tuple(tuple(map(tuple, loop)) for loop in region),
                          axis if operation.AxisLocked or _shares(operation) else None,
                          operation.FeedParameter if operation.FeedLocked else "",
                          operation.AxisLocked and axis is not None,
                          details.get("label", number).removeprefix(number), operation.DrawnByHand)


def locked_axis(operation):
    """The axis of an operation as it stands in the document now, (x, y, z); None without one.

    Parameters
    ----------
    operation : App.DocumentObject
    """
    frame = frame_of(operation)
    if frame is not None:
        return tuple(float(x) for x in matrix_of(frame.Placement)[:3, 2])
    return tuple(operation.Axis) if operation.Axis.Length > 0 else None


def _shares(operation):
    """Whether an operation stands in a plan whose sub-surfaces share axes."""
    above = plan_of(operation)
    return above is not None and bool(above.Orientations)


def kept_pieces(plan):
    """The sub-surfaces of a whole plan that are kept: all those of each face on which one is locked or drawn by hand.

    Parameters
    ----------
    plan : App.DocumentObject
    """
    rows = [(one, [(part, name) for part, names in one.Faces for name in names if name]) for one in operations_in(plan)]
    by_hand = {(faces[0][0].Name, faces[0][1]) for one, faces in rows
               if faces and (one.AxisLocked or one.FeedLocked or one.DrawnByHand)}
    found = []
    for one, faces in rows:
        if faces and (faces[0][0].Name, faces[0][1]) in by_hand:
            found.append(own_piece(one, faces) or KeptSubSurface(*faces[0]))
    return found
