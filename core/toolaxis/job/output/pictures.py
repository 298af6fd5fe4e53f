"""Pictures of a plan and of its verdict, written as PNG files beside it."""

from pathlib import Path

from toolaxis.job.planning.blade_clearances import tightest
from toolaxis.job.planning.edit_axis import search_task
from toolaxis.plan.plan import Plan
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.report.figures.closest_approach import tightest_picture
from toolaxis.report.figures.comparison_chart import baselines_picture, options_picture
from toolaxis.report.figures.machine import has_machine_picture, machine_picture
from toolaxis.report.figures.plan_overview import overview_picture
from toolaxis.report.figures.plots import map_picture, operation_picture
from toolaxis.strategies.registry import strategy_named, strategy_of
from toolaxis.strategies.strategy import INDEXED
from toolaxis.verify.verdict import Verdict


def draw_plan(plan: Plan, folder: Path, progress: Progress = NO_PROGRESS) -> None:
    """Draw the whole part where it has several operations, and every operation: passes and tool, and what its strategy
    shows besides, as the map of axes and the strip widths of a fixed one.

    The tool is drawn once more where it comes nearest to what it must keep clear of; turned copies of operations are
    drawn in the picture of the whole part only.

    A choice between numbers of orientations is drawn as their curve, a comparison of methods as bars, and a machine
    that states its bodies with part and tool at each orientation.

    Parameters
    ----------
    plan : Plan
    folder : Path
    progress : Progress
    """
    if len(plan.operations) > 1:
        overview_picture(plan).savefig(folder / "plan.png")
    if plan.options:
        options_picture(plan.options).savefig(folder / "orientations.png")
    if plan.baselines:
        baselines_picture(plan.baselines).savefig(folder / "baselines.png")
    if has_machine_picture(plan):
        machine_picture(plan).savefig(folder / "machine.png")
    closest = tightest(plan, progress)
    if closest is not None:
        tightest_picture(plan, closest.operation, closest).savefig(folder / "tightest.png")
    copies = {} if plan.blades is None else plan.blades.copies
    originals = [op for op in plan.operations if op.number not in copies]
    for index, op in enumerate(originals):
        progress.report("drawing", index, len(originals))
        job = search_task(plan, op, Progress(None, progress.cancelled))
        if op.done:
            operation_picture(plan, op).savefig(folder / f"{op.name}-passes.png")
        # A strategy that moves the axis may have found a fixed one to be better.
        moves = op.done and op.orientation.lead is not None
        strategy = strategy_of(plan.inputs.method) if moves else strategy_named(INDEXED)
        strategy.draw(plan, op, job, folder)


def draw_verdict(plan: Plan, verdict: Verdict, folder: Path, progress: Progress = NO_PROGRESS) -> None:
    """Draw the scallop and gouge maps of the operations; a turned copy that passes looks as the one it is a copy of.

    Parameters
    ----------
    plan : Plan
    verdict : Verdict
    folder : Path
    progress : Progress
    """
    copies = {} if plan.blades is None else plan.blades.copies
    turned = {op.name for op in plan.operations if op.number in copies}
    drawn = [found for found in verdict.operations if found.maps and not (found.passed and found.name in turned)]
    for index, found in enumerate(drawn):
        progress.report("drawing", index, len(drawn))
        targets = found.maps[:len(found.faces)]
        map_picture(targets, found.scallop_limit, found.gouge_allowed,
                    found.name).savefig(folder / f"{found.name}-verdict.png")
