"""The main job: from a part and a tool to operations, each with its axis, passes and work coordinate system."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import count
from math import pi
from typing import Any

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
from toolaxis.plan.held_face import HeldFace
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
         origin: str = "", stock_box: Sequence[float] | float | str | None = None,
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
    mounting, allowed = _machine(machine, limits, offset)
    rack = _rack(tool, float(scallop), (feedrate, spindle))
    cutter = rack.tools[0]
    objective = _usual_objective(rack, mounting) if objective is None else objective
    limits_kept = Tolerance.of(tolerance)
    if least_lean is not None:
        limits_kept = replace(limits_kept, least_lean=float(least_lean))
    given = read_division(division) if isinstance(division, str) else tuple(division or ())
    chosen = check_strategy(strategy, Asked(
        cutter, None if mounting is None else mounting.machine, method, objective,
        None if roughness is None else float(roughness), orientations, held_in(given), passes=passes,
        least_lean=limits_kept.least_lean, greatest_step_over=float(greatest_step_over), lead=float(lead)))
    short = limits or (machine if mounting is None else None)
    inputs = PlanInputs(
        scallop=float(scallop), allowance=float(allowance), method=chosen.name if chosen.moves else method,
        objective=objective, direction=direction, limits=short if isinstance(short, str) else format_limits(allowed),
        feedrate=FEEDRATE if feedrate is None else float(feedrate),
        spindle=SPINDLE if spindle is None else float(spindle), tolerance=limits_kept, rapid=float(rapid),
        roughness=chosen.roughness if roughness is None else float(roughness), limit=float(limit), passes=passes,
        avoid=numbers_to_avoid(avoid), held=held, stock=float(stock), greatest_step_over=float(greatest_step_over),
        allowance_on=parse_allowances(allowance_on), lead=float(lead), origin=origin,
        stock_box=format_margins(parse_margins(stock_box)))
    _check_tools(inputs, rack, mounting)
    loaded = inputs.prepare_part(load(part))
    inputs = replace(inputs, avoid=(loaded.original or loaded).avoided)
    check_not_avoided(loaded, (loaded.face(one.face) for one in given))
    if len(rack.tools) > 1:
        check_rack_inputs(RackInputs(inputs.method, chosen.moves, regions, orientations is not None, bool(given),
                                     compare))
    loaded, numbers, pattern = _join_faces(loaded, faces, rack, chosen, progress)
    loaded = loaded.with_warnings(*tool_warnings(loaded, 2.0 * rack.tools[-1].radius), *not_divided(loaded, given),
                                  *rack.warnings)
    if held:
        _check_held_side(given, chosen)
    bodies = tuple(load(body) for body in _list_obstacles(obstacles))
    chosen_faces = choose_faces(loaded, numbers)
    _check_allowances(loaded)
    if inputs.stock > 0:
        loaded = loaded.with_stock(inputs.stock, (number for face in chosen_faces for number in face.numbers))
    job = PlanningJob(loaded, cutter, inputs, allowed, bodies, datum_of(inputs, datum, loaded), regions, orientations,
                      check_workers(workers), machine=mounting, division=given)
    free, in_clamping = cut_faces(loaded, chosen_faces)
    with use_cores(workers):
        if len(rack.tools) > 1:
            jobs = [replace(job, tool=tool, one_by_one=False, regions=None, for_time=regions != 1)
                    for tool in rack.tools]
            whole_part = None if pattern is None else replace(pattern, part=loaded)
            made = _plan_rack(jobs, free, (whole_part, most_tools), progress)
        else:
            whole = faces is None and _is_untouched(loaded) and inputs.method in METHODS
            made = _plan_part(job, free, (whole, compare), progress)
        return _tell_apart(_order_operations(made, progress), free, in_clamping)


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


def _join_faces(part: Part, faces: Sequence[int | Sequence[int]] | str | None, rack: ToolLibrary, chosen: Strategy,
                progress: Progress) -> tuple[Part, Any, Pattern | None]:
    """A part with the faces joined that are machined as one, their numbers, and its blades where there are any.

    Blades are looked for where several tools plan a part of which no faces are named; else it is joined to skins then.
    """
    asked, pattern = faces is not None, None
    if len(rack.tools) > 1 and not asked:
        _tell(progress, "looking for blades")
        pattern = _find_blades(part, progress)
        faces = "skins" if pattern is None else None
    if pattern is not None:
        part = pattern.part
    _tell(progress, "joining faces")
    # Layers are plane sections, to which iso-parametric lines do not matter.
    joined, numbers = with_joined(part, faces, pi if chosen.in_layers else GREATEST_CORNER, _skin_width(rack), asked)
    if chosen.in_layers:
        joined, numbers = with_rings(joined, numbers)
    return joined, numbers, pattern


def _is_untouched(part: Part) -> bool:
    """Whether a part is as it was read: nothing of it is joined, selected, avoided, held or left with an allowance."""
    return not (part.original or part.selected or part.avoided or part.held) and part.allowances is None


def _tell(progress: Progress, stage: str) -> None:
    """Report a step before the first face.  A stop is not answered here: planning answers it, with an empty plan."""
    with suppress(Cancelled):
        progress.report(stage, 0, 0)


def _check_most_tools(most_tools: int | None) -> None:
    """That a greatest number of tools is one."""
    if most_tools is not None and (isinstance(most_tools, bool) or not isinstance(most_tools, int) or most_tools < 1):
        raise InvalidInput(f"most_tools is {most_tools!r}: it must be a whole number above zero")


def _usual_objective(rack: ToolLibrary, mounting: Mounting | None) -> str:
    """What is least unless it is said: time where tools are compared on a machine that states its limits."""
    timed = len(rack.tools) > 1 and mounting is not None and not mounting.machine.unstated
    return "time" if timed else "length"


def _check_held_side(given: Sequence[SubSurface], chosen: Strategy) -> None:
    """That a plan with a held side is one of which the faces may be cut where it begins."""
    if given:
        raise InvalidInput("a held side does not go with sub-surfaces given by hand: faces are cut where it begins; "
                           "leave one of both out")
    if chosen.in_layers:
        raise InvalidInput(f"a held side does not go with strategy {chosen.name!r}: faces are cut where it begins; "
                           "leave one of both out")


def _tell_apart(plan: Plan, faces: Sequence[Face], held: tuple[HeldFace, ...]) -> Plan:
    """A plan that tells what of its faces is held in the clamping, hidden in a skin, or was not begun."""
    with activate_progress(NO_PROGRESS):  # what is finished is told of, whoever wants to stop
        return replace(add_hidden(add_not_begun(plan, faces), faces), held=held)


def _rack(tool: ToolSource | Sequence[ToolSource] | None, scallop: float,
          rates: tuple[float | None, float | None]) -> ToolLibrary:
    """The tools in the order in which they are used, the large ones first, at the rates that are given for all."""
    found = load_library(tool)
    feedrate, spindle = rates
    tools = [replace(one, feedrate=one.feedrate if feedrate is None else None,
                     spindle=one.spindle if spindle is None else None) for one in found.tools]
    small = [one for one in tools if scallop >= one.radius]
    left = tuple(f"{one.shop_name} is left out: its radius is not above the scallop height, {scallop:g} mm"
                 for one in small)
    if len(small) == len(tools):  # what is wrong is said of the inputs
        small, left = [], ()
    kept = [one for one in tools if one not in small]
    kept.sort(key=lambda one: (-one.radius, one.corner_radius, one.half_angle, one.number))
    return ToolLibrary(_numbered(kept), (*found.warnings, *left))


def _numbered(tools: Sequence[Tool]) -> tuple[Tool, ...]:
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
        return find_skins(loaded, _skin_width(_rack(tools, inputs.scallop, (None, None)))).joined


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


def _plan_rack(jobs: Sequence[PlanningJob], faces: Sequence[Face], asked: tuple[Pattern | None, int | None],
               progress: Progress) -> Plan:
    """The plan of a job with each of several tools: blade by blade where there is a pattern, with so many at most."""
    pattern, most = asked
    with activate_progress(progress):
        try:
            _in_cells(jobs[0], progress)
            if pattern is not None:
                made = plan_blades_with_rack(jobs, pattern, most, progress)
            else:
                area = sum(face.area for face in faces)
                made = RackPlanner([replace(job, asked_area=area) for job in jobs], most).plan(faces, progress)
            return went_on(made, lambda plan: with_unreachable(plan, jobs, progress))
        except Cancelled:
            return replace(jobs[0].empty(), tools=tuple(job.tool for job in jobs))


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
    asked = [number for face in faces for number in face.numbers]
    # A skin that was taken apart is none in the plan's part.
    there = [face for face in made.part.faces if set(face.numbers) <= set(asked)]
    there.sort(key=lambda face: asked.index(face.number))
    there = [face for face in (cut_face(one, made.part.held) for one in there) if face is not None]
    pieces = [target.face for target in smooth_pieces(there, job.tool) if target.ended is None]
    return went_on(went_on(made, _in_time), lambda plan: compare_methods(
        plan, pieces, lambda name, some: _in_time(plain.by(name).carried_out(some, progress.within(name)))))


def _in_time(plan: Plan) -> Plan:
    """A plan in the order that takes least time, with times; operations on which the program fails lose their axis."""
    while True:
        try:
            return add_times(plan, reorder=True)
        except ToolAxisError:  # Cancelled among them
            raise
        except Exception as reason:
            lost = {op.number: fail_operation(op, fault(reason)) for op in plan.operations
                    if op.done and op.face.label == piece_of(reason)}
            if not lost:
                raise
            plan = replace(plan, operations=tuple(lost.get(op.number, op) for op in plan.operations),
                           outcome="cancelled" if plan.outcome == "cancelled" else "incomplete")


def _order_operations(plan: Plan, progress: Progress) -> Plan:
    """A plan in the order that takes least time; a stopped one as it stands, but judged on its machine as the others.
    """
    with activate_progress(progress):
        found = went_on(plan, _in_time)
    if found.outcome != "cancelled":
        return found
    with activate_progress(NO_PROGRESS):  # what is finished is kept
        return replace(went_on(replace(found, outcome="incomplete"), add_times), outcome="cancelled")


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


def _machine(machine: MachineLike | None, limits: AxisLimits | str | None,
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
