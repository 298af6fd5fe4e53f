"""`toolaxis plan`: axes and passes for the faces of a part, written to a folder."""

from argparse import Namespace
from collections.abc import Callable
from dataclasses import replace
from math import radians
from pathlib import Path

from toolaxis.cli.display import show_progress
from toolaxis.cli.output import print_json, print_table, say
from toolaxis.cli.stopping import writing
from toolaxis.errors import REPORT_AT, Cancelled, InvalidInput, JobError
from toolaxis.job.files.plan_folder import OF_PLAN, PLAN, read_json, read_plan, stage_folder, write_plan
from toolaxis.job.inputs.spec import Spec, parse_allowances, parse_avoided
from toolaxis.job.inputs.tool_library import load_library
from toolaxis.machine.library import load_machine
from toolaxis.machine.limits import parse_limits
from toolaxis.plan.choices import FEEDRATE, OBJECTIVES, SPINDLE
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan, PlanInputs, outcome_of
from toolaxis.plan.timing import MOTION_WARNINGS
from toolaxis.plan.zone import AVOIDED
from toolaxis.progress import Progress, TimeLimit
from toolaxis.shape.half_space import CLAMPED_SIDE
from toolaxis.shape.work_origin import format_margins, parse_margins
from toolaxis.strategies.inputs import check_strategy
from toolaxis.strategies.strategy import Asked
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool


def run(given: Namespace, asked: Callable[[], bool]) -> int:
    """Plan, write the folder, and print the operations.

    Parameters
    ----------
    given : argparse.Namespace
    asked : callable
        Whether the user asked to stop.

    Returns
    -------
    int
        0 where every sub-surface has an axis, 1 where one has none or the time was up, 130 where the user stopped it.
    """
    time_limit = TimeLimit(given.minutes)
    spec = _spec(given)
    tool = _tools(given, spec)
    one = tool if isinstance(tool, Tool) else None
    check_strategy(given.strategy, Asked(one, load_machine(spec.machine) if spec.machine else None, given.method,
                                         spec.inputs.objective, _roughness(given), given.orientations,
                                         passes=given.passes, least_lean=spec.inputs.tolerance.least_lean,
                                         greatest_step_over=spec.inputs.greatest_step_over, lead=spec.inputs.lead))
    after = _earlier_plans(given)
    with stage_folder(Path(given.out)) as stage:
        from toolaxis.cli.compile_ahead import compiling_ahead
        from toolaxis.job.planning.parallel import check_workers
        from toolaxis.job.planning.pipeline import plan

        with compiling_ahead(), show_progress(lambda: asked() or time_limit.is_up()) as progress:
            made = plan(spec.part, tool, spec.inputs.scallop, machine=spec.machine or None,
                        limits=spec.inputs.limits, offset=spec.place, faces=spec.numbers,
                        objective=given.objective, allowance=spec.inputs.allowance, stock=spec.inputs.stock,
                        direction=spec.inputs.direction, passes=spec.inputs.passes,
                        obstacles=list(spec.obstacles), avoid=spec.inputs.avoid, held=spec.inputs.held,
                        method=spec.inputs.method, strategy=given.strategy,
                        roughness=_roughness(given), feedrate=given.feedrate, spindle=given.spindle,
                        tolerance=spec.inputs.tolerance, regions=spec.regions, rapid=spec.inputs.rapid,
                        compare=given.compare, limit=spec.inputs.limit,
                        orientations=spec.orientations, division=given.division or None, workers=given.workers,
                        most_tools=given.most_tools, greatest_step_over=spec.inputs.greatest_step_over,
                        allowance_on=spec.inputs.allowance_on, lead=spec.inputs.lead,
                        origin=spec.inputs.origin, stock_box=spec.inputs.stock_box, after=after,
                        progress=progress)
        stopped = made.outcome == "cancelled" and (asked() or not time_limit.is_up())
        if made.outcome == "cancelled" and not made.operations:
            say("toolaxis: no face was finished: nothing is written")
            if stopped:
                raise Cancelled("cancelled by the user")
            raise JobError("plan", str(given.part), f"no face was finished within {given.minutes:g} min (--minutes)")
        with writing():
            made = write_plan(made, stage.folder)
        if not given.no_pictures and not stopped:
            with show_progress(asked) as progress:
                _draw(made, stage.folder, progress, check_workers(given.workers))
        with writing():
            stage.publish(OF_PLAN)
    return _print_plan(made, given, stopped)


def _earlier_plans(given: Namespace) -> tuple[Plan, ...]:
    """Plans of earlier setups."""
    for folder in given.after:
        if Path(folder).resolve() == Path(given.out).resolve():
            raise InvalidInput(f"--after {folder} is the folder that this plan is written to: give it another one with "
                               "--out")
    return tuple(read_plan(Path(folder)) for folder in given.after)


def _spec(given: Namespace) -> Spec:
    if given.limits:
        parse_limits(given.limits)
    feedrate = FEEDRATE if given.feedrate is None else given.feedrate
    spindle = SPINDLE if given.spindle is None else given.spindle
    inputs = PlanInputs(given.scallop, given.allowance, given.method, given.objective or OBJECTIVES[0], given.direction,
                        given.limits, feedrate, spindle, _tolerance(given), given.rapid, limit=given.limit,
                        passes=given.passes, avoid=parse_avoided(given.avoid), held=given.held, stock=given.stock,
                        greatest_step_over=given.greatest_step_over,
                        allowance_on=parse_allowances(given.allowance_on), lead=given.lead, origin=given.origin,
                        stock_box=format_margins(parse_margins(given.stock_box)))
    if given.faces and given.skins:
        raise InvalidInput(f"--faces {given.faces} and --skins {given.skins} are both given: choose faces or skins")
    faces = f"skins {given.skins}" if given.skins else given.faces or ""
    spec = Spec(given.part, " ".join(given.tool), inputs, faces, given.holder or "", given.stickout,
                tuple(given.obstacles), given.regions, given.orientations, given.machine or "", given.offset or "")
    _ = spec.numbers, spec.place
    return spec


def _tolerance(given: Namespace) -> Tolerance:
    """Tolerances, with the least lean of ball ends and the clearances among them."""
    found = replace(Tolerance.of(given.tolerance), least_lean=radians(given.least_lean))
    return found.with_clearances(given.clearances) if given.clearances else found


def _tools(given: Namespace, spec: Spec) -> Tool | tuple[Tool, ...]:
    """The tool, or the tools to choose from, the general rack unless some are named."""
    for name in ("holder", "stickout"):
        if getattr(given, name) is not None:
            if len(given.tool) == 1 and not given.tools:
                return spec.resolved_tool()
            raise InvalidInput(f"--{name} belongs to one tool and several are given: let each tool have its own in its "
                               "file or library")
    found = load_library([*given.tool, *given.tools] or None)
    for warning in found.warnings:
        say(f"toolaxis: warning: {warning}")
    if len(found.tools) == 1:
        spec.inputs.check_tool(found.tools[0])
        return found.tools[0]
    spec.inputs.check_lean(found.tools)
    return found.tools


def _roughness(given: Namespace) -> float | None:
    """Ra in mm, as it is planned with, from micrometres."""
    return None if given.roughness is None else float(given.roughness) / 1000


def _draw(made: Plan, folder: Path, progress: Progress, workers: int) -> None:
    """Draw the pictures; a plan is worth keeping without them."""
    from toolaxis.job.output.pictures import draw_plan

    try:
        draw_plan(made, folder, progress, workers)
    except Cancelled:
        say("toolaxis: stopped while drawing; the plan is whole, pictures are missing")
    except Exception as reason:
        say(f"toolaxis: warning: pictures are missing ({type(reason).__name__}: {reason}); the plan is whole")


def _print_plan(made: Plan, given: Namespace, stopped: bool) -> int:
    """Print what was made and turn its outcome into the exit code."""
    for warning in made.part.warnings:
        say(f"toolaxis: warning: {warning}")
    if given.json:
        print_json(read_json(Path(given.out) / PLAN))
    else:
        from toolaxis.report.tables import baselines_table, open_table, options_table, plan_table

        if made.options:
            print_table(options_table(made.options))
        print_table(plan_table(made))
        if (still_open := open_table(made)) is not None:
            print_table(still_open)
        if made.baselines:
            print_table(baselines_table(made))
    if made.blades is not None:
        from toolaxis.report.blades import blades_lines

        for line in blades_lines(made):
            say(f"toolaxis: {line}")
    asked = next((one.orientations for one in made.options if one.chosen), given.orientations)
    if isinstance(asked, int) and made.orientations > asked:
        say(f"toolaxis: warning: {made.orientations} axes instead of {asked}: for some sub-surfaces no shared "
            "axis passed the proof, and one was searched; plan.json says why")
    for why in made.in_the_way:
        say(f"toolaxis: between operations: {why}")
    for op in made.operations:
        if made.blades is not None and op.number in made.blades.copies:
            continue
        if op.left:
            say(f"toolaxis: {op.orientation.reasons[0]}")
        elif not op.done and outcome_of([op], made.blades) == "complete":
            say(f"toolaxis: face {op.face.label}: left as rest material: {op.orientation.reasons[0]}")
        elif not op.done:
            outcome = () if op.failed else (f"outcome {op.orientation.outcome}",)
            for reason in (*outcome, *op.orientation.reasons):
                say(f"toolaxis: face {op.face.label}: {reason}")
        elif op.number not in made.taken_over:
            _say_left_over(op)
    say(f"toolaxis: not checked: {', '.join(made.not_checked)}")
    _of_failures(Path(given.out))
    count = len(made.operations)
    say(f"toolaxis: {count} {'operation' if count == 1 else 'operations'} in {given.out}")
    from toolaxis.report.areas_aside import has_clamped_area

    if has_clamped_area(made):
        after = " ".join(f"--after {folder}" for folder in [*given.after, given.out])
        say(f"toolaxis: for the other setup: toolaxis plan {given.part} {after} --held SIDE --out DIR")
    if made.outcome == "cancelled":
        why = "" if stopped else f", as the {given.minutes:g} min of --minutes were over"
        say(f"toolaxis: stopped before all faces were done{why}; {Path(given.out) / PLAN} holds those that were")
        return 130 if stopped else 1
    return 0 if made.outcome == "complete" else 1


def _of_failures(out: Path) -> None:
    """Say what the whole plan failed at, and how to report failures."""
    document = read_json(out / PLAN)
    for sentence in document["faults"]:
        say(f"toolaxis: {sentence}")
    files = [op["failure_file"] for op in document["operations"]] + [document["failure_file"]]
    written = [name for name in files if name]
    if written:
        say(f"toolaxis: the program itself failed: please report it at {REPORT_AT}, with the part, and with plan.json, "
            f"{', '.join(written)} of {out}")


def _say_left_over(op: Operation) -> None:
    """Say what an operation leaves as rest material."""
    found, zones = op.orientation, [zone for zone in op.zones if zone.at_wall]
    if found.unreached > 0:
        count = f", {len(zones)} {'zone' if len(zones) == 1 else 'zones'}" if zones else ""
        elsewhere = sum(zone.elsewhere for zone in zones)
        also = f"; {elsewhere:.1f} mm2 of that are machined by other operations" if elsewhere > 0.05 else ""
        say(f"toolaxis: face {op.face.label}: {100 * found.unreached:.1f} % of the area lies at walls or in corners "
            f"and is left as rest material ({found.unreached * op.face.area:.1f} mm2{count}){also}")
    for why in found.reasons:
        if AVOIDED in why or f"beside the {CLAMPED_SIDE}" in why:
            say(f"toolaxis: face {op.face.label}: {why}")
        if why.startswith(("undercut", "one contact", "no contact", *MOTION_WARNINGS)):
            say(f"toolaxis: warning: face {op.face.label}: {why}")
