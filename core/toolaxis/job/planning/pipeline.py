"""The main job: from a part and a tool to operations, each with its axis, passes and work coordinate system."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import count
from math import pi
from typing import Any, NamedTuple

from numpy.typing import ArrayLike

from toolaxis.cad.load import load
from toolaxis.cad.machines import load_machine, with_hulls
from toolaxis.cad.unit_checks import tool_warnings
from toolaxis.errors import Cancelled, InvalidInput, ToolAxisError, fault, piece_of
from toolaxis.job.inputs.rack_inputs import RackInputs, check_rack_inputs
from toolaxis.job.inputs.spec import (
    check_not_avoided,
    choose_faces,
    numbers_to_avoid,
    parse_allowances,
    with_joined,
    with_rings,
)
from toolaxis.job.inputs.tool_library import ToolLibrary, ToolSource, load_library
from toolaxis.job.planning.blade_pattern import Pattern, find_pattern
from toolaxis.job.planning.comparison import compare_methods
from toolaxis.job.planning.earlier_setups import check_after, join_as_before, leave_out_machined
from toolaxis.job.planning.edit_origin import datum_of
from toolaxis.job.planning.failures import fail_operation
from toolaxis.job.planning.held_side import cut_face, cut_faces
from toolaxis.job.planning.parallel import abreast, check_workers
from toolaxis.job.planning.planner import PlanningJob, went_on
from toolaxis.job.planning.rack import RackPlanner
from toolaxis.job.planning.rack_blades import plan_blades_with_rack
from toolaxis.job.planning.sub_surfaces import held_in, not_divided, read_division, smooth_pieces
from toolaxis.job.planning.timing import add_times
from toolaxis.job.planning.unplanned import add_hidden, add_not_begun
from toolaxis.job.planning.unreachable import with_unreachable
from toolaxis.machine.limits import SHORT_FORMS, AxisLimits, format_limits
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import MachineLike, Mounting, machine_limits
from toolaxis.numeric.shares import use_cores
from toolaxis.partition.partition import check_count
from toolaxis.plan.choices import FEEDRATE, ISO, SCALLOP, SPINDLE
from toolaxis.plan.face_share import FaceShare
from toolaxis.plan.plan import Plan, PlanInputs
from toolaxis.plan.sub_surface import SubSurface
from toolaxis.progress import NO_PROGRESS, Progress, activate_progress
from toolaxis.search.fixed_axis import METHODS
from toolaxis.search.machine_limits import intersect_limits
from toolaxis.search.time_estimate import require_machine_limits
from toolaxis.shape.bounding.bounding_tree import BoundingTree, cells, keep_cells
from toolaxis.shape.face import Face
from toolaxis.shape.joining.joined_surface import GREATEST_CORNER
from toolaxis.shape.part import Part
from toolaxis.shape.work_origin import format_margins, parse_margins
from toolaxis.skin.find import find_skins
from toolaxis.strategies.inputs import check_strategy
from toolaxis.strategies.strategy import INDEXED, Asked, Strategy
from toolaxis.tolerances import Tolerance, ToleranceLike
from toolaxis.tools.tool import Tool
from toolaxis.work import LIMIT

#: Planes, cylinders and cones narrower than this many radii of the cutter belong to the skin that they continue.
WIDE = 4.0
#: Faces whose cells a process makes at a time.
_BUNDLE = 8


def plan(part: Any, tool: ToolSource | Sequence[ToolSource] | None = None, scallop: float = SCALLOP, *,
         machine: MachineLike | None = None,
         faces: Sequence[int | Sequence[int]] | str | None = None, regions: int | str | None = None,
         orientations: int | str | None = None, division: Sequence[SubSurface] | str | None = None,
         objective: str | None = None, strategy: str = INDEXED, allowance: float = 0.0, stock: float = 0.0,
         direction: str = "zigzag", passes: str = ISO, obstacles: Any = None,
         avoid: Sequence[int] | str | None = None, held: str = "", method: str = "sphere",
         feedrate: float | None = None, spindle: float | None = None, tolerance: ToleranceLike = None,
         datum: Sequence[float] = (0.0, 0.0, 0.0), limits: AxisLimits | str | None = None,
         offset: ArrayLike | None = None, rapid: float = 10000.0, roughness: float | None = None,
         compare: bool = False, limit: float = LIMIT, workers: int | None = None, most_tools: int | None = None,
         least_lean: float | None = None, greatest_step_over: float = 0.0,
         allowance_on: Mapping[int, float] | Sequence[Any] | str | None = None, lead: float = 0.0,
         origin: str = "", stock_box: Sequence[float] | float | str | None = None, after: Sequence[Plan] = (),
         progress: Progress = NO_PROGRESS) -> Plan:
    """Plan the machining of a part's faces, each with the tool and the fixed axis that need least time.

    Parameters
    ----------
    part : Part or anything that `toolaxis.load` takes
    tool : Tool, str, path, or sequence of these, optional
        A tool, its short form, file or name, or several; a tool library, its file or name; the general rack that comes
        with the program unless given.  With several tools it is chosen which of them begin on which face; what they
        leave goes to smaller ones.
    scallop : float
        Greatest scallop height, mm.
    machine : Machine, Mounting, AxisLimits or str, optional
        A machine, its name in resources/machines or its file: every axis is one that it can hold in its steps, and no
        motion leaves its travel.  Limits of the axis and their short form ("cone:0,0,1,45") are taken here too.
    faces : sequence of int, "all", "skins" or text such as "3,5-8", optional
        The sculptured faces unless given; with several tools joined to skins.  Faces that continue each other smoothly
        are machined, or divided, as one where their numbers stand together: [(3, 4), 7], or "3+4,7"; "skins" joins all
        that can be joined, see `toolaxis.join`.
    regions : int or "auto", optional
        Divide every face into so many sub-surfaces, or into as many as pay for their index moves; faces stay whole
        unless given.  With several tools they are divided into as many as pay, unless it is 1.
    orientations : int or "auto", optional
        Greatest number of different axes: faces are divided so that sub-surfaces share them; "auto" tries all numbers,
        gives them as the plan's options and takes the one at the knee; each has its own unless given.
    division : sequence of SubSurface or str, optional
        Sub-surfaces given by hand, with the axes and feeds that are to be kept: faces that are named there are not
        divided otherwise.  A text names a file of them, a plan.json, or the folder of a plan.
    strategy : str
        "indexed": every sub-surface has one fixed axis; the others move it while it cuts.  Their names, what they do
        and what they need are listed by `toolaxis plan --help` and in the manual, resources/manual/strategies.md.
    objective : str, optional
        "length", "passes" or "time": what each sub-surface's axis makes least; time needs a machine that states the
        limits of its axes, and is what is taken with several tools on such a machine, length otherwise.  Faces are
        divided by time too where that is asked for, else by cutting length.  Which tools begin is chosen by time.
    allowance : float
        Stock left on the faces, mm.
    stock : float
        What roughing left on the faces of this plan, mm above the finished surface; no less than the allowance.
        Shank and holder keep their clearance, and rapid moves keep clear, of all of it throughout the plan.  All other
        faces are taken as finished, and so are all without it.
    direction : str
        "zigzag", "climb" or "conventional".
    passes : str
        How passes lie: "iso" along a parameter of the face, "planes" along parallel planes that contain the tool axis,
        in the mean direction of that parameter, "scallop" along the levels of a field that keeps them as far apart as
        their strips are wide, "auto" the shorter of the first and the last; all but "iso" with fixed axes only.
    obstacles : Part, anything that `toolaxis.load` takes, or a list of these, optional
        Further bodies to keep clear of.
    avoid : sequence of int or text such as "3,5-8", optional
        Faces of the part that no tool may touch: they are not machined, and cutter, shank and holder keep the distances
        from them that they keep from obstacles, however they meet the faces that are machined.  A part of which some
        are to be avoided is planned face by face, its blades not told apart.
    held : str
        The side that is held in the clamping: "z<12.5", "x>-3", or "plane:x,y,z,nx,ny,nz" with a point of its plane and
        a direction into it, in coordinates of the part.  Cutter, shank and holder keep the distances from it that they
        keep from obstacles, on links too, and no axis comes from there.  What of the faces lies in it is not machined
        and stands in the plan's `held`, for another clamping.  Such a part is planned face by face, its blades not told
        apart, and without sub-surfaces given by hand.
    method : str
        How each sub-surface gets its axis: "sphere" (the best of the hemisphere), "sectors" (projection planes and
        sectors) or "jerk" (the rotary angles at which the machine's linear axes together have most jerk along the
        passes); for comparison "roman" (Roman's rule), "normal" (the mean normal), "one" (one axis for all
        sub-surfaces) and "ball" (a ball end of the tool's radius takes its place, along the mean normal).
    feedrate, spindle : float, optional
        mm/min and rev/min for all tools; each tool's own unless given, 1000 and 10000 where it states none.
    tolerance : float or Tolerance, optional
        The machining tolerance, mm: how far the finished surface may be cut too deep, 0.01 unless given; or all
        tolerances.  The straight motions of the passes take a share of it and of the scallop height, see
        `Tolerance.chord_for`.
    datum : (3,) sequence of float
        Origin of the work coordinate systems, mm.
    limits : AxisLimits or str, optional
        Limits of the axis besides the machine's; see `toolaxis.machine.limits`.
    offset : (3,) or (4, 4) array_like, optional
        Where the part stands on the machine's table, all axes at zero: its origin in machine coordinates, mm, or a
        rigid motion.  Without it the part's axes are the machine's, and travel is not judged.
    rapid : float
        Rate of rapid traverse in links, mm/min; for times only.
    roughness : float, optional
        Greatest Ra across the feed, mm, for a strategy that keeps one: 0.0016 (1.6 um) unless given.
    compare : bool
        Also plan the same faces by the other methods; what they come to stands in the plan's baselines.
    limit : float
        Most work for one sub-surface, its axis and the proof of its passes, in thousands of bounds of distances.  When
        it is used up, the best axis that is proven is taken, or the outcome is "not_found" with that reason.  Work is
        counted, not timed: the plan is the same on every run.  An axis that moves is allowed `MOVING` times that; see
        `toolaxis.work`.
    workers : int, optional
        Cores to use, with as many processes that plan sub-surfaces side by side, on Linux and outside FreeCAD, and
        threads where there are fewer of them; as many as there are unless given. The result is the same for any number.
    most_tools : int, optional
        Greatest number of tools that are used, where several are given.
    least_lean : float, optional
        Least angle between the axis of a ball end, tapered ones too, and the normal at every contact, rad; below 90
        degrees.  `tolerance.least_lean` unless given, which is none unless given either.
    greatest_step_over : float
        Greatest distance of neighbouring passes on the face, mm, whatever the scallop height allows; 0 for none.
    lead : float
        Radius of the arcs on which the tool comes down to passes and is lifted from them, mm, in the plane of the
        surface's normal and the feed: wherever these are proven free, straight ramps elsewhere; 0 for ramps alone.
    allowance_on : mapping of int to float, or text such as "3,5-8=0.3;9=0.1", optional
        What is left on some faces in place of `allowance`, mm, by their numbers: they are machined to that height, and
        kept to it while others are machined.  A part with such faces is planned face by face, its blades not told
        apart.
    origin : str
        Where work coordinate systems have their origin, in place of `datum`: "part:top" or "stock:top-front-left", with
        a point of the box around the part or of its stock, or "point:x,y,z".  Boxes lie along the part's axes; left is
        -x and front -y.
    stock_box : float, sequence of float or text, optional
        Margins of the box that the part is cut from, mm: one for all sides, or six for -x, +x, -y, +y, -z and +z.  The
        setup sheet tells it; axes and passes are found without it.
    after : sequence of Plan
        Plans of the same part in earlier setups, the first one first: only what they leave of their faces is asked
        for, what was held in them included, and the plan's `machined_before` tells what they machine.
    progress : Progress

    Returns
    -------
    Plan
        Its outcome is "complete", "incomplete" (a sub-surface has no axis, its reasons say why, or the machine meets
        something between operations) or "cancelled" (operations done so far).

    Raises
    ------
    InvalidInput
        When an argument is out of range.
    UnsupportedGeometry
        When faces cannot be joined.
    """
    _check_most_tools(most_tools)
    check_count(regions)
    check_count(orientations, "orientations")
    mounting, allowed = _read_machine(machine, limits, offset)
    rack = _load_rack(tool, float(scallop), (feedrate, spindle))
    objective = _usual_objective(rack, mounting) if objective is None else objective
    kept = _read_tolerance(tolerance, least_lean)
    given = read_division(division) if isinstance(division, str) else tuple(division or ())
    own_machine = None if mounting is None else mounting.machine
    own_roughness = None if roughness is None else float(roughness)
    chosen = check_strategy(strategy, Asked(
        rack.tools[0], own_machine, method, objective, own_roughness, orientations, held_in(given), passes=passes,
        least_lean=kept.least_lean, greatest_step_over=float(greatest_step_over), lead=float(lead)))
    limits_given = limits or (machine if mounting is None else None)
    inputs = PlanInputs(
        scallop=float(scallop), allowance=float(allowance), method=chosen.name if chosen.moves else method,
        objective=objective, direction=direction, limits=_limits_text(limits_given, allowed),
        feedrate=_given_or(feedrate, FEEDRATE), spindle=_given_or(spindle, SPINDLE), tolerance=kept, rapid=float(rapid),
        roughness=_given_or(own_roughness, chosen.roughness), limit=float(limit), passes=passes,
        avoid=numbers_to_avoid(avoid), held=held, stock=float(stock), greatest_step_over=float(greatest_step_over),
        allowance_on=parse_allowances(allowance_on), lead=float(lead), origin=origin,
        stock_box=format_margins(parse_margins(stock_box)))
    _check_tools(inputs, rack, mounting)
    request = _PlanRequest(
        inputs, rack, chosen, mounting, allowed, given, faces=faces, regions=regions, orientations=orientations,
        obstacles=obstacles, datum=datum, compare=compare, most_tools=most_tools, workers=workers, after=tuple(after))
    return _make_plan(part, request, progress)


@dataclass(frozen=True, eq=False)
class _PlanRequest:
    """What a plan is asked for, read and checked as far as that goes without the part; the rest as `plan` takes it."""

    inputs: PlanInputs
    rack: ToolLibrary
    strategy: Strategy
    mounting: Mounting | None
    limits: AxisLimits | None
    division: tuple[SubSurface, ...]
    faces: Sequence[int | Sequence[int]] | str | None
    regions: int | str | None
    orientations: int | str | None
    obstacles: Any
    datum: Sequence[float]
    compare: bool
    most_tools: int | None
    workers: int | None
    after: tuple[Plan, ...]

    @property
    def has_several_tools(self) -> bool:
        """Whether tools are compared."""
        return len(self.rack.tools) > 1


class _JoinedPart(NamedTuple):
    """A part with the faces joined that are machined as one, their numbers, and its blades where there are any."""

    part: Part
    numbers: Any
    pattern: Pattern | None


def _make_plan(source: Any, request: _PlanRequest, progress: Progress) -> Plan:
    """Read the part, plan what is asked for of it, and bring the operations into order."""
    loaded = request.inputs.prepare_part(load(source))
    inputs = replace(request.inputs, avoid=(loaded.original or loaded).avoided)
    check_not_avoided(loaded, (loaded.face(one.face) for one in request.division))
    if request.has_several_tools:
        _check_for_rack(request)
    joined = _join_faces(loaded, request, progress)
    part = _add_warnings(joined.part, request)
    if inputs.held:
        _check_held_side(request.division, request.strategy)
    bodies = tuple(load(body) for body in _list_obstacles(request.obstacles))
    chosen_faces = choose_faces(part, joined.numbers)
    _check_allowances(part)
    if inputs.stock > 0:
        numbers = (number for face in chosen_faces for number in face.numbers)
        part = part.with_stock(inputs.stock, numbers)
    job = PlanningJob(part, request.rack.tools[0], inputs, request.limits, bodies,
                      datum_of(inputs, request.datum, part), request.regions, request.orientations,
                      check_workers(request.workers), machine=request.mounting, division=request.division)
    left, before = leave_out_machined(chosen_faces, request.after)
    free, in_clamping = cut_faces(part, left)
    with use_cores(request.workers):
        if request.has_several_tools:
            made = _plan_with_rack(job, free, joined.pattern, request, progress)
        else:
            is_whole = request.faces is None and not request.after and _is_untouched(part) and inputs.method in METHODS
            made = _plan_part(job, free, (is_whole, request.compare), progress)
        ordered = replace(_order_operations(made, progress), machined_before=before)
        return _tell_apart(ordered, free, in_clamping)


def _read_tolerance(tolerance: ToleranceLike, least_lean: float | None) -> Tolerance:
    """All tolerances, with the least lean that is given beside them."""
    kept = Tolerance.of(tolerance)
    return kept if least_lean is None else replace(kept, least_lean=float(least_lean))


def _limits_text(given: Any, allowed: AxisLimits | None) -> str:
    """Limits of the axis as text: as they were given where that was one."""
    return given if isinstance(given, str) else format_limits(allowed)


def _given_or(value: float | None, usual: float) -> float:
    """A number that is given, or the usual one."""
    return usual if value is None else float(value)


def _check_for_rack(request: _PlanRequest) -> None:
    """Refuse what is planned with one tool only."""
    divides = request.orientations is not None
    check_rack_inputs(RackInputs(request.inputs.method, request.strategy.moves, request.regions, divides,
                                 bool(request.division), request.compare))


def _add_warnings(part: Part, request: _PlanRequest) -> Part:
    """A part with what is to be said of its size beside the tools, of its division by hand, and of the tools."""
    smallest = request.rack.tools[-1]
    of_unit = tool_warnings(part, 2.0 * smallest.radius)
    of_division = not_divided(part, request.division)
    return part.with_warnings(*of_unit, *of_division, *request.rack.warnings)


def _check_tools(inputs: PlanInputs, rack: ToolLibrary, mounting: Mounting | None) -> None:
    """Refuse what tools and machine do not allow."""
    if inputs.objective == "time":
        require_machine_limits(mounting)
    if len(rack.tools) > 1:
        inputs.check_rack(rack.tools)
    else:
        inputs.check_tool(rack.tools[0])


def _check_allowances(part: Part) -> None:
    """Refuse skins whose faces have different allowances."""
    if part.allowances is not None:
        for face in part.faces:
            part.allowances.check_alike(face)


def _join_faces(part: Part, request: _PlanRequest, progress: Progress) -> _JoinedPart:
    """A part with the faces joined that are machined as one.

    Blades are looked for where several tools plan a part of which no faces are named; else it is joined to skins then.
    """
    if request.after:
        check_after(request.strategy, named=request.faces is not None, divided=bool(request.division))
        return _JoinedPart(*join_as_before(part, request.after), None)
    faces, pattern = request.faces, None
    if request.has_several_tools and faces is None:
        _tell(progress, "looking for blades")
        pattern = _find_blades(part, progress)
        faces = "skins" if pattern is None else None
    if pattern is not None:
        part = pattern.part
    _tell(progress, "joining faces")
    in_layers = request.strategy.in_layers
    # Layers are plane sections, to which iso-parametric lines do not matter.
    corner = pi if in_layers else GREATEST_CORNER
    is_asked = request.faces is not None
    joined, numbers = with_joined(part, faces, corner, _skin_width(request.rack), is_asked)
    if in_layers:
        joined, numbers = with_rings(joined, numbers)
    return _JoinedPart(joined, numbers, pattern)


def _is_untouched(part: Part) -> bool:
    """Whether a part is as it was read: nothing of it is joined, selected, avoided, held or left with an allowance."""
    return not (part.original or part.selected or part.avoided or part.held) and part.allowances is None


def _tell(progress: Progress, stage: str) -> None:
    """Report a step before the first face.  A stop is not answered here: planning answers it, with an empty plan."""
    with suppress(Cancelled):
        progress.report(stage, 0, 0)


def _check_most_tools(most_tools: int | None) -> None:
    """That a greatest number of tools is one."""
    if most_tools is None:
        return
    is_whole = isinstance(most_tools, int) and not isinstance(most_tools, bool)
    if not is_whole or most_tools < 1:
        raise InvalidInput(f"most_tools is {most_tools!r}: it must be a whole number above zero")


def _usual_objective(rack: ToolLibrary, mounting: Mounting | None) -> str:
    """What is least unless it is said: time where tools are compared on a machine that states its limits."""
    states_limits = mounting is not None and not mounting.machine.unstated
    return "time" if len(rack.tools) > 1 and states_limits else "length"


def _check_held_side(given: Sequence[SubSurface], chosen: Strategy) -> None:
    """That a plan with a held side is one of which the faces may be cut where it begins."""
    if given:
        raise InvalidInput("a clamped side does not go with sub-surfaces given by hand: faces are cut where it begins; "
                           "leave one of both out")
    if chosen.in_layers:
        raise InvalidInput(f"a clamped side does not go with strategy {chosen.name!r}: faces are cut where it begins; "
                           "leave one of both out")


def _tell_apart(plan: Plan, faces: Sequence[Face], held: tuple[FaceShare, ...]) -> Plan:
    """A plan that tells what of its faces is held in the clamping, hidden in a skin, or was not begun."""
    with activate_progress(NO_PROGRESS):  # what is finished is told of, whoever wants to stop
        with_not_begun = add_not_begun(plan, faces)
        with_hidden = add_hidden(with_not_begun, faces)
        return replace(with_hidden, held=held)


def _load_rack(tool: ToolSource | Sequence[ToolSource] | None, scallop: float,
               rates: tuple[float | None, float | None]) -> ToolLibrary:
    """The tools in the order in which they are used, the large ones first, at the rates that are given for all."""
    found = load_library(tool)
    tools = [_with_rates(one, *rates) for one in found.tools]
    kept = [one for one in tools if one.radius > scallop]
    warnings = [f"{one.shop_name} is left out: its radius is not above the scallop height, {scallop:g} mm"
                for one in tools if one.radius <= scallop]
    if not kept:  # what is wrong is said of the inputs
        kept, warnings = tools, []
    kept.sort(key=lambda one: (-one.radius, one.corner_radius, one.half_angle, one.number))
    return ToolLibrary(_number_tools(kept), (*found.warnings, *warnings))


def _with_rates(tool: Tool, feedrate: float | None, spindle: float | None) -> Tool:
    """A tool without own rates in place of those that are given for all."""
    own_feedrate = tool.feedrate if feedrate is None else None
    own_spindle = tool.spindle if spindle is None else None
    return replace(tool, feedrate=own_feedrate, spindle=own_spindle)


def _number_tools(tools: Sequence[Tool]) -> tuple[Tool, ...]:
    """Tools of which each has a place in the magazine where there are several: those without get free ones."""
    if len(tools) == 1:
        return tuple(tools)
    taken = {one.number for one in tools}
    free = (number for number in count(1) if number not in taken)
    return tuple(one if one.number else replace(one, number=next(free)) for one in tools)


def group_faces(part: Any, tools: Sequence[ToolSource], inputs: PlanInputs, blades: bool = True,
                progress: Progress = NO_PROGRESS) -> tuple[tuple[int, ...], ...]:
    """What several tools machine as one of a whole part: the faces of its skins of two faces or more, by numbers.

    Parameters
    ----------
    part : as `toolaxis.plan` takes it
    tools : sequence of Tool, or of what `toolaxis.load_tools` takes
    inputs : PlanInputs
    blades : bool
        Whether blades are looked for: a part that has any is planned blade by blade, and none of its faces joined.
    progress : Progress

    Returns
    -------
    tuple of tuple of int
        The skin with the largest face first.
    """
    loaded = inputs.prepare_part(load(part))
    if blades and _find_blades(loaded, progress) is not None:
        return ()
    with activate_progress(progress):
        rack = _load_rack(tools, inputs.scallop, (None, None))
        return find_skins(loaded, _skin_width(rack)).joined


def _skin_width(rack: ToolLibrary) -> float:
    """The width below which planes, cylinders and cones belong to skins, mm: by the middle one of the tools."""
    return WIDE * rack.tools[len(rack.tools) // 2].radius


def _find_blades(part: Part, progress: Progress) -> Pattern | None:
    """The blades of a part; None where it has none, or they cannot be told apart."""
    if not _is_untouched(part):
        return None
    with activate_progress(progress), suppress(Exception):  # its faces are planned as those of any part then
        return find_pattern(part, progress)[0]
    return None


def _plan_with_rack(job: PlanningJob, faces: Sequence[Face], pattern: Pattern | None, request: _PlanRequest,
                    progress: Progress) -> Plan:
    """The plan of a job with each of several tools: blade by blade where there is a pattern."""
    may_divide = request.regions != 1
    jobs = [replace(job, tool=tool, one_by_one=False, regions=None, for_time=may_divide) for tool in request.rack.tools]
    with activate_progress(progress):
        try:
            _in_cells(job, progress)
            if pattern is not None:
                bladed = replace(pattern, part=job.part)
                made = plan_blades_with_rack(jobs, bladed, request.most_tools, progress)
            else:
                area = sum(face.area for face in faces)
                by_area = [replace(one, asked_area=area) for one in jobs]
                made = RackPlanner(by_area, request.most_tools).plan(faces, progress)
            return went_on(made, lambda plan: with_unreachable(plan, jobs, progress))
        except Cancelled:
            return replace(jobs[0].empty(), tools=request.rack.tools)


def _plan_part(job: PlanningJob, faces: Sequence[Face], asked: tuple[bool, bool], progress: Progress) -> Plan:
    """The plan of a job: blade by blade where the whole of a bladed part is asked for, else face by face, and compared
    with other methods where that is asked for."""
    whole, compare = asked
    try:
        with activate_progress(progress):
            if job.workers > 1:
                _in_cells(job, progress)
            if whole:
                progress.report("looking for blades", 0, 0)
                made, refusal = _plan_bladed(job, compare, progress)
                if made is not None:
                    return made
                job = replace(job, part=job.part.with_warnings(*refusal))
            made = job.by(job.inputs.method).zoned_out(faces, progress)
            return _compare_methods(job, made, faces, progress) if compare else made
    except Cancelled:
        return job.empty()


def _plan_bladed(job: PlanningJob, compare: bool, progress: Progress) -> tuple[Plan | None, tuple[str, ...]]:
    """The plan of a part with blades; none where it has none that can be planned as one, and a warning that says why.
    """
    try:
        pattern, refusal = find_pattern(job.part, progress)
        if pattern is None:
            return None, refusal
        return replace(job, part=pattern.part).bladed(pattern, compare, progress), ()
    except ToolAxisError:  # Cancelled among them
        raise
    except Exception as reason:
        return None, (f"blades are not told apart, every face is planned by itself: {fault(reason).sentence}",)


def _compare_methods(job: PlanningJob, made: Plan, faces: Sequence[Face], progress: Progress) -> Plan:
    """A plan with what other methods come to."""
    plain = replace(job, part=made.part, regions=None, orientations=None, division=())
    pieces = _smooth_pieces_of(made.part, faces, job.tool)

    def _by_method(name: str, some: Sequence[Face]) -> Plan:
        other = plain.by(name).carried_out(some, progress.within(name))
        return _in_time(other)

    timed = went_on(made, _in_time)
    return went_on(timed, lambda plan: compare_methods(plan, pieces, _by_method))


def _smooth_pieces_of(part: Part, faces: Sequence[Face], tool: Tool) -> list[Face]:
    """What one axis each can machine of some faces, as they stand in a plan's part and in their order."""
    asked = [number for face in faces for number in face.numbers]
    # A skin that was taken apart is none in the plan's part.
    there = [face for face in part.faces if set(face.numbers) <= set(asked)]
    there.sort(key=lambda face: asked.index(face.number))
    cut = [cut_face(face, part.held) for face in there]
    free = [face for face in cut if face is not None]
    return [target.face for target in smooth_pieces(free, tool) if target.ended is None]


def _in_time(plan: Plan) -> Plan:
    """A plan in the order that takes least time, with times; operations on which the program fails lose their axis."""
    while True:
        try:
            return add_times(plan, reorder=True)
        except ToolAxisError:  # Cancelled among them
            raise
        except Exception as reason:
            failing = [op for op in plan.operations if op.done and op.face.label == piece_of(reason)]
            if not failing:
                raise
            lost = {op.number: fail_operation(op, fault(reason)) for op in failing}
            operations = tuple(lost.get(op.number, op) for op in plan.operations)
            outcome = "cancelled" if plan.outcome == "cancelled" else "incomplete"
            plan = replace(plan, operations=operations, outcome=outcome)


def _order_operations(plan: Plan, progress: Progress) -> Plan:
    """A plan in the order that takes least time; a stopped one as it stands, but judged on its machine as the others.
    """
    with activate_progress(progress):
        found = went_on(plan, _in_time)
    if found.outcome != "cancelled":
        return found
    with activate_progress(NO_PROGRESS):  # what is finished is kept
        as_others = replace(found, outcome="incomplete")
        return replace(went_on(as_others, add_times), outcome="cancelled")


def _in_cells(job: PlanningJob, progress: Progress) -> None:
    """Make the cells of all faces, before processes are forked that then share them."""
    every = [own for part in (job.part, *job.bodies) for face in part.faces for own in face.own_faces]
    bundles = [every[first:first + _BUNDLE] for first in range(0, len(every), _BUNDLE)]

    def _make(k: int, inner: Progress) -> list[BoundingTree | None]:
        inner.report("surroundings", k, len(bundles))
        return [_cells_if_any(face) for face in bundles[k]]

    found = abreast(_make, len(bundles), job.workers, progress)
    if found.cancelled:
        raise Cancelled("cancelled by the user")
    for k, trees in found.results.items():
        for face, tree in zip(bundles[k], trees, strict=True):
            if tree is not None:
                keep_cells(face, tree)


def _cells_if_any(face: Face) -> BoundingTree | None:
    """The cells of a face, without the face; None where they cannot be made, as the faces to which it matters tell."""
    with suppress(Exception):
        return replace(cells(face), faces=())
    return None


def _list_obstacles(obstacles: Any) -> list[Any]:
    if obstacles is None:
        return []
    if isinstance(obstacles, list | tuple) and not all(isinstance(item, Face) for item in obstacles):
        return list(obstacles)
    return [obstacles] if obstacles else []


def _read_machine(machine: MachineLike | None, limits: AxisLimits | str | None,
                  offset: ArrayLike | None) -> tuple[Mounting | None, AxisLimits | None]:
    """The machine with the part on it, if one is given, and the other limits of the axis."""
    if isinstance(machine, str) and not machine.startswith(SHORT_FORMS):
        machine = load_machine(machine) if machine else None
    elif isinstance(machine, Machine):
        machine = with_hulls(machine)
    found = machine_limits(machine, offset) if machine else None
    if found is None and offset is not None:
        raise InvalidInput("a place of the part on the table is given without a machine: name the machine too")
    others = intersect_limits(None, limits or None)
    if isinstance(found, Mounting):
        return found, others
    return None, intersect_limits(found, others)
