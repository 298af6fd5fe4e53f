"""The plan: what was asked for, and the operations that answer it."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import degrees, inf, isfinite, pi

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import SMALLER_SCALLOP
from toolaxis.errors import Fault, InvalidInput
from toolaxis.machine.setup import Mounting
from toolaxis.plan.baseline import Baseline
from toolaxis.plan.blades import Blades
from toolaxis.plan.choices import DIRECTIONS, FEEDRATE, FIELD, ISO, OBJECTIVES, PASSES, PLANES, SPINDLE
from toolaxis.plan.face_share import FaceShare
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.part_account import PartAccount
from toolaxis.plan.timing import Order
from toolaxis.plan.unplanned_area import UnplannedArea
from toolaxis.plugins import one_of
from toolaxis.shape.allowances import Allowances
from toolaxis.shape.face import Face
from toolaxis.shape.half_space import HalfSpace, parse_half_space
from toolaxis.shape.part import Part
from toolaxis.shape.stock import MOST_STOCK
from toolaxis.shape.work_origin import StockBox, check_origin, parse_margins
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool
from toolaxis.work import LIMIT

Array = NDArray[np.float64]

#: How passes lie that do not lie along a parameter.
_LIE = {PLANES: "planes", FIELD: "a field"}
#: What a change of the tool axis between operations is reckoned to take, s.
INDEX_SECONDS = 6.0
#: What a change of tools is reckoned to take, s.
CHANGE_SECONDS = 10.0
#: Share of the faces that may stay open in a plan with several tools that is complete.
LEFT_OPEN = 1e-3


#: Larger arcs of lead-in and lead-out are not planned, mm.
MOST_LEAD = 100.0


def _check_choice(name: str, value: str, choices: tuple[str, ...]) -> None:
    if value not in choices:
        raise InvalidInput(f"{name} {value!r} is unknown: use {one_of(choices)}")


@dataclass(frozen=True)
class PlanInputs:
    """What the planner was asked for; lengths in mm.

    Attributes
    ----------
    scallop : float
        Greatest scallop height.
    allowance : float
        Stock left on the faces.
    method : str
        How the axis of each sub-surface is found: one of the ways to find a fixed axis, or the name of a strategy that
        moves it.  Which there are is known to `toolaxis.strategies.registry` only.
    objective, direction : str
        One of `OBJECTIVES`, `DIRECTIONS`.
    limits : str
        Limits of the axis in the short form of the command, or what was given instead ("a Cone"); empty for none.
    feedrate : float
        mm/min
    spindle : float
        rev/min
    tolerance : Tolerance
    rapid : float
        Rate of rapid traverse in links, mm/min; for times only.
    roughness : float
        Greatest Ra across the feed, mm; 0 where none was asked for.
    limit : float
        Most work for one sub-surface, its axis and the proof of its passes, in thousands of bounds of distances; see
        `toolaxis.work`.
    passes : str
        One of `PASSES`; passes with a moving axis are iso-parametric, or layers.
    avoid : tuple of int
        Numbers of the part's faces that no tool may touch.
    held : str
        The side that is held in the clamping, in the short form of the command; empty for none.
    stock : float
        What roughing left on the finished faces, mm; 0 where they are taken as finished.  `Part.stock` says on which.
    greatest_step_over : float
        Greatest distance of neighbouring passes, mm, whatever the scallop height allows; 0 for none.
    allowance_on : tuple of (int, float)
        Faces on which an allowance of their own is left, in place of `allowance`, with that, mm; by numbers of the
        file's faces.
    lead : float
        Radius of the arcs on which the tool comes down to passes and leaves them, wherever these are proven free, mm; 0
        for straight ramps.
    origin : str
        Where work coordinate systems have their origin, in the short form of the command; empty for the datum as given.
    stock_box : str
        Margins of the box that the part is cut from, in the short form of the command; empty where it is not known.

    Raises
    ------
    InvalidInput
        When a value is out of its range.
    """

    scallop: float
    allowance: float = 0.0
    method: str = "sphere"
    objective: str = "length"
    direction: str = "zigzag"
    limits: str = ""
    feedrate: float = FEEDRATE
    spindle: float = SPINDLE
    tolerance: Tolerance = field(default_factory=Tolerance)
    rapid: float = 10000.0
    roughness: float = 0.0
    limit: float = LIMIT
    passes: str = ISO
    avoid: tuple[int, ...] = ()
    held: str = ""
    stock: float = 0.0
    greatest_step_over: float = 0.0
    allowance_on: tuple[tuple[int, float], ...] = ()
    lead: float = 0.0
    origin: str = ""
    stock_box: str = ""

    def __post_init__(self) -> None:
        for name, unit in (("scallop", "mm"), ("feedrate", "mm/min"), ("spindle", "rev/min"),
                           ("rapid", "mm/min")):
            value = getattr(self, name)
            if not (isfinite(value) and value > 0):
                raise InvalidInput(f"{name} is {value} {unit}: it must be a finite number above zero")
        if not (isfinite(self.allowance) and self.allowance >= 0):
            raise InvalidInput(f"allowance is {self.allowance} mm: it must be zero or more")
        Allowances(self.allowance, dict(self.allowance_on))
        self._check_stock()
        self._check_step_over()
        if not (isfinite(self.lead) and 0 <= self.lead <= MOST_LEAD):
            raise InvalidInput(f"radius of lead-in and lead-out is {self.lead} mm: it must be zero (none) or more, and "
                               f"at most {MOST_LEAD:g} mm")
        if not (isfinite(self.roughness) and self.roughness >= 0):
            raise InvalidInput(f"roughness is {self.roughness} mm: it must be finite and not below zero")
        if isinstance(self.limit, bool) or not (isfinite(self.limit) and self.limit > 0):
            raise InvalidInput(f"limit is {self.limit}: it must be a finite number above zero (most work for a face)")
        if not isinstance(self.tolerance, Tolerance):
            raise InvalidInput(f"tolerance is {self.tolerance!r}: give a toolaxis.Tolerance, such as "
                               "Tolerance(gouge=0.005)")
        _ = self.half_space_held
        check_origin(self.origin, self.stock_margins)
        _check_choice("objective", self.objective, OBJECTIVES)
        _check_choice("direction", self.direction, DIRECTIONS)
        _check_choice("passes", self.passes, PASSES)

    def _check_stock(self) -> None:
        if not (isfinite(self.stock) and 0 <= self.stock <= MOST_STOCK):
            raise InvalidInput(f"stock is {self.stock} mm: it must be zero or more, and at most {MOST_STOCK:g} mm")
        most = max([self.allowance, *(value for _, value in self.allowance_on)])
        if 0 < self.stock < most:
            raise InvalidInput(f"stock is {self.stock} mm, below the allowance of {most} mm: give at least "
                               "the allowance, or 0 where no stock is to be looked out for")

    def prepare_part(self, part: Part) -> Part:
        """A part with its faces to be avoided, its held side, and what is left on its faces.

        Parameters
        ----------
        part : Part
            With all its faces, none joined.
        """
        prepared = part.avoid_faces(self.avoid).hold_side(self.half_space_held)
        return prepared.leave_allowances(self.allowance, dict(self.allowance_on))

    def allowance_of(self, face: Face) -> float:
        """What is left on a face, mm.

        Parameters
        ----------
        face : Face
            Of the part; on all faces of a joined one the same is left.
        """
        return Allowances(self.allowance, dict(self.allowance_on)).of(face)

    def _check_step_over(self) -> None:
        most = self.greatest_step_over
        if not (isfinite(most) and most >= 0):
            raise InvalidInput(f"greatest step-over is {most} mm: it must be finite and above zero, or 0 for none")
        if 0 < most < self.scallop:
            raise InvalidInput(f"greatest step-over is {most} mm, below the scallop height of {self.scallop} mm: give "
                               f"a larger step-over, or {SMALLER_SCALLOP}")

    @property
    def half_space_held(self) -> HalfSpace | None:
        """The side that is held.

        Raises
        ------
        InvalidInput
            When its short form is not understood.
        """
        return parse_half_space(self.held) if self.held else None

    @property
    def stock_margins(self) -> tuple[float, ...]:
        """Margins of the stock on -x, +x, -y, +y, -z and +z, mm; none where it is not known.

        Raises
        ------
        InvalidInput
            When their short form is not understood.
        """
        return parse_margins(self.stock_box)

    @property
    def step_over(self) -> float:
        """Greatest distance of neighbouring passes, mm; infinite where none is asked for."""
        return self.greatest_step_over or inf

    @property
    def chord(self) -> float:
        """How far straight motions may leave passes, mm."""
        return self.tolerance.chord_for(self.scallop)

    def at_rates_of(self, tool: Tool) -> "PlanInputs":
        """The same with a tool's own feed rate and spindle speed, where it states them.

        Parameters
        ----------
        tool : Tool
        """
        return replace(self, feedrate=tool.feedrate or self.feedrate, spindle=tool.spindle or self.spindle)

    def check_rack(self, tools: Sequence[Tool]) -> None:
        """Check several tools to choose from.

        Parameters
        ----------
        tools : sequence of Tool
            The largest first.

        Raises
        ------
        InvalidInput
            As `check_tool` and `check_lean` say.
        """
        self._check_scallop(tools[0])
        self.check_lean(tools)

    def check_lean(self, tools: Sequence[Tool]) -> None:
        """Check that the least lean is one that the ball ends among tools can keep.

        Parameters
        ----------
        tools : sequence of Tool

        Raises
        ------
        InvalidInput
            When none of them has a ball end, or the lean is more than its sides allow.
        """
        lean = self.tolerance.least_lean
        if lean == 0:
            return
        balls = [tool for tool in tools if tool.flat_radius == 0]
        if not balls:
            names = ", ".join(tool.name for tool in tools)
            raise InvalidInput(f"least lean is {degrees(lean):g} deg and no ball end is among the tools ({names}): "
                               "leave the lean out, or name a tool with a ball end, tapered or not")
        for tool in balls:
            most = pi / 2 - tool.half_angle
            if lean >= most:
                raise InvalidInput(f"least lean is {degrees(lean):g} deg and tool {tool.name} reaches "
                                   f"{degrees(most):g} deg from its axis at most: give a smaller least lean")

    def check_tool(self, tool: Tool) -> None:
        """Check that the scallop is one that this cutter can leave, and that it can keep the least lean.

        Parameters
        ----------
        tool : Tool

        Raises
        ------
        InvalidInput
            When it is no tool, the scallop height is not below the cutter's radius, or the least lean does not go
            with it.
        """
        self._check_scallop(tool)
        self.check_lean((tool,))

    def _check_scallop(self, tool: Tool) -> None:
        if not isinstance(tool, Tool):
            raise InvalidInput(f"tool is {tool!r}: give a Tool, its short form (torus:12x1), a file or a name")
        if self.scallop >= tool.radius:
            raise InvalidInput(f"scallop is {self.scallop} mm, not below the cutter radius {tool.radius} mm: "
                               f"give {SMALLER_SCALLOP}")


def describe_feed(found: Orientation) -> str:
    """How passes go, as tables and titles say it: "u", or "u, in planes" for planes in the mean direction of u.

    Parameters
    ----------
    found : Orientation
    """
    return found.feed if found.pattern == ISO else f"{found.feed}, in {_LIE[found.pattern]}"


@dataclass(frozen=True)
class Option:
    """One way to share axes between the sub-surfaces of a plan.

    Attributes
    ----------
    orientations, sub_surfaces : int
        Numbers of different axes and of pieces.
    length : float
        Reckoned length of cutting, links and clean-up, mm.
    chosen : bool
        Whether the plan's operations follow it.
    seconds : float, optional
        Reckoned time of the same, where the plan goes by time.
    """

    orientations: int
    sub_surfaces: int
    length: float
    chosen: bool
    seconds: float | None = None


def outcome_of(operations: Sequence[Operation], blades: Blades | None = None) -> str:
    """What operations that were all tried come to: "complete" or "incomplete".

    Parameters
    ----------
    operations : sequence of Operation
    blades : Blades, optional
        Their fillets need no axis: roots are what a clean-up tool is for, and the plan says how much of them stays.
        Nor do faces that are left as rest material as a whole.  Where the program failed, nothing is complete.
    """
    needed = [op for op in operations
              if op.failed or (not op.left and (blades is None or blades.side_of(op.face.number) != "fillet"))]
    return "complete" if all(op.done for op in needed) else "incomplete"


@dataclass(frozen=True, eq=False)
class Plan:
    """Operations that machine faces of a part, each with a fixed axis.

    Attributes
    ----------
    part : Part
    tools : tuple of Tool
        Those that could be chosen from, in the order in which they are used: one at least.
    inputs : PlanInputs
    operations : tuple of Operation
        One per sub-surface and tool, tool by tool, in the order of the faces; by axis where sub-surfaces share axes; on
        a machine in the order that takes least time between them.
    obstacles : tuple of Part
        Further bodies that were kept clear of.
    datum : (3,) array
        Origin of every work coordinate system, mm.
    outcome : str
        "complete" (every sub-surface has an axis, fillets at the roots of blades and faces that are left to a clean-up
        tool as a whole apart, nothing is in the way between operations, and the program failed nowhere), "incomplete"
        or "cancelled".
    options : tuple of Option
        Cutting length, or time, against the number of different axes, where that was asked for.
    baselines : tuple of Baseline
        What other methods come to on the same faces, this plan first, where that was asked for.
    blades : Blades, optional
        Where one blade was planned and its operations were turned to the others.
    machine : Mounting, optional
        The machine that holds the axes, with the part on its table.
    order : Order, optional
        What the order of operations saves, where it was chosen.
    in_the_way : tuple of str
        What bodies of the machine meet between operations, before the first and after the last one, in sentences.
    faults : tuple of Fault
        Where the program failed on no single sub-surface, as in timing the whole: the plan is incomplete then.
    at_points : bool
        Whether the method checks the cutter on the machined face at points only; not written, as the method tells it.
    held : tuple of FaceShare
        What of the faces that were asked for lies in the side that is held: no operation is to machine it.
    machined_before : tuple of FaceShare
        What of the faces plans of earlier setups machine: no operation is to machine it again.
    unplanned : tuple of UnplannedArea
        What else of them is in no operation, as where the plan was stopped.
    """

    part: Part
    tools: tuple[Tool, ...]
    inputs: PlanInputs
    operations: tuple[Operation, ...]
    obstacles: tuple[Part, ...]
    datum: Array
    outcome: str
    options: tuple[Option, ...] = ()
    baselines: tuple[Baseline, ...] = ()
    blades: Blades | None = None
    machine: Mounting | None = None
    order: Order | None = None
    in_the_way: tuple[str, ...] = ()
    faults: tuple[Fault, ...] = ()
    at_points: bool = False
    held: tuple[FaceShare, ...] = ()
    machined_before: tuple[FaceShare, ...] = ()
    unplanned: tuple[UnplannedArea, ...] = ()

    def part_around(self, number: int) -> Part:
        """The part as it stands around a face: where it has blades, the other ones are obstacles.

        Parameters
        ----------
        number : int
        """
        return self.part if self.blades is None else self.blades.apart(self.part, number)

    @property
    def blank(self) -> StockBox | None:
        """The box that the part is cut from; None where it is not known."""
        margins = self.inputs.stock_margins
        return StockBox.around((self.part.original or self.part).box, margins) if margins else None

    def __repr__(self) -> str:
        """One line: all paths written out are thousands."""
        done = sum(op.done for op in self.operations)
        return f"<Plan of {len(self.operations)} operations, {done} with a path: {self.outcome}>"

    @property
    def taken_over(self) -> frozenset[int]:
        """Numbers of the operations of which smaller tools take over what they leave."""
        return frozenset(number for op in self.operations for number in op.rest_of)

    @property
    def account(self) -> PartAccount:
        """How much of its faces it machines."""
        return PartAccount.of(self.operations, self.unplanned)

    @property
    def used_tools(self) -> tuple[Tool, ...]:
        """The tools with which something is machined; all that were given where nothing is."""
        used = tuple(tool for tool in self.tools if any(op.done and op.tool == tool for op in self.operations))
        return used or self.tools

    @property
    def named_tools(self) -> str:
        """The tools with which something is machined, in words."""
        *most, last = [tool.title or tool.name for tool in self.used_tools]
        return f"{', '.join(most)} and {last}" if most else last

    def by_tool(self) -> tuple["Plan", ...]:
        """The operations of each tool as a plan of its own at that tool's feed and speed, in their order; tools without
        operations only where none has any."""
        rows = [tuple(op for op in self.operations if op.tool == tool) for tool in self.tools]
        made = [replace(self, tools=(tool,), operations=some, inputs=self.inputs.at_rates_of(tool))
                for tool, some in zip(self.tools, rows, strict=True)]
        return tuple(one for one in made if one.operations) or tuple(made[:1])

    @property
    def not_checked(self) -> tuple[str, ...]:
        """What the collision check left out because it was not given, or could not be read."""
        used = self.used_tools
        missing = [name for name in ("shank", "holder") if not all(name in tool.outlines for tool in used)]
        unread = sum(len(one.left_out) for one in (self.part, *self.obstacles))
        if unread:
            missing.append("1 face that could not be read" if unread == 1 else f"{unread} faces that could not be read")
        if not self.obstacles:
            missing.append("obstacles other than the part")
        if self.machine is None:
            return (*missing, "machine")
        mounted = [replace(self.machine, tool_length=tool.gauge_length) for tool in used]
        if not all(mounting.judges_travel for mounting in mounted):
            missing.append("travel of the machine's linear axes")
        if not all(mounting.judges_bodies for mounting in mounted):
            missing.append("collision with the machine itself")
        elif not all(mounting.judges_index_moves for mounting in mounted) and self.orientations > 1:
            missing.append("collision with the machine on index moves")
        return tuple(missing)

    @property
    def length(self) -> float:
        """Length of the cutting motion of all operations, mm."""
        return float(sum(op.orientation.length for op in self.operations if op.done))

    @property
    def travel(self) -> float:
        """Length of entries, exits and links of all operations, mm."""
        return float(sum(op.travel for op in self.operations))

    @property
    def axes(self) -> Array:
        """The axes of the operations in their order, (n, 3)."""
        found = [op.orientation.axis for op in self.operations if op.orientation.axis is not None]
        return np.array(found, dtype=float).reshape(-1, 3)

    @property
    def orientations(self) -> int:
        """Number of different axes."""
        return len(np.unique(np.round(self.axes, 9) + 0.0, axis=0))

    @property
    def timed(self) -> bool:
        """Whether the machine's own time is known for all operations that have a path."""
        return self.machine is not None and all(op.time is not None for op in self.operations if op.done)

    @property
    def seconds(self) -> float:
        """Time of all operations, s: see `Operation.seconds`; between them what the machine takes to index, or
        `INDEX_SECONDS` for each change of axis where that is not known, and `CHANGE_SECONDS` for each further tool."""
        swaps = CHANGE_SECONDS * (len(self.used_tools) - 1)
        if self.timed:
            return swaps + float(sum(op.time.total for op in self.operations if op.time is not None))
        changes = int((np.abs(np.diff(self.axes, axis=0)) > 1e-9).any(axis=1).sum())
        return swaps + INDEX_SECONDS * changes + sum(op.seconds(self.inputs.feedrate, self.inputs.rapid)
                                             for op in self.operations)
