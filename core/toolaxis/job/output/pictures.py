"""Pictures of a plan and of its verdict, written as PNG files beside it."""

import os
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from toolaxis.errors import Cancelled, JobError
from toolaxis.job.planning.blade_clearances import tightest
from toolaxis.job.planning.edit_axis import search_task
from toolaxis.job.planning.parallel import abreast
from toolaxis.plan.operation import Operation
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


def draw_plan(plan: Plan, folder: Path, progress: Progress = NO_PROGRESS, workers: int = 1) -> None:
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
    workers : int
        Processes; the same pictures are drawn by any number of them.

    Raises
    ------
    Cancelled
        When the user stops it; each picture that is there is whole.
    JobError
        When pictures of an operation cannot be drawn; those of all others are there.
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

    def draw(index: int, into: Path) -> None:
        _draw_operation(plan, originals[index], into, progress)

    _draw_abreast(draw, [op.name for op in originals], folder, progress, workers)


def _draw_operation(plan: Plan, op: Operation, folder: Path, progress: Progress) -> None:
    job = search_task(plan, op, Progress(None, progress.cancelled))
    if op.done:
        operation_picture(plan, op).savefig(folder / f"{op.name}-passes.png")
    # A strategy that moves the axis may have found a fixed one to be better.
    moves = op.done and op.orientation.lead is not None
    strategy = strategy_of(plan.inputs.method) if moves else strategy_named(INDEXED)
    strategy.draw(plan, op, job, folder)


def _draw_abreast(draw: Callable[[int, Path], None], names: Sequence[str], folder: Path, progress: Progress,
                  workers: int) -> None:
    """Draw the pictures of each item, several at a time, into a folder in which each appears whole.

    Parameters
    ----------
    draw : callable
        Takes the number of the item and the folder to draw into.
    names : sequence of str
        Of the items.
    folder : Path
    progress : Progress
    workers : int
    """
    with tempfile.TemporaryDirectory(prefix="drawing-", dir=folder) as kept:
        def work(index: int, told: Progress) -> None:
            told.report("drawing", index, len(names))
            into = Path(kept) / str(index)
            into.mkdir()
            draw(index, into)
            for picture in into.iterdir():
                os.replace(picture, folder / picture.name)

        found = abreast(work, len(names), workers, progress)
    if found.cancelled:
        raise Cancelled("cancelled by the user")
    for index, fault in found.faults.items():
        raise JobError("drawing", names[index], fault.sentence)


def draw_verdict(plan: Plan, verdict: Verdict, folder: Path, progress: Progress = NO_PROGRESS,
                 workers: int = 1) -> None:
    """Draw the scallop and gouge maps of the operations; a turned copy that passes looks as the one it is a copy of.

    Parameters
    ----------
    plan : Plan
    verdict : Verdict
    folder : Path
    progress : Progress
    workers : int
        Processes; the same pictures are drawn by any number of them.

    Raises
    ------
    Cancelled
        When the user stops it; each picture that is there is whole.
    JobError
        When the map of an operation cannot be drawn; those of all others are there.
    """
    copies = {} if plan.blades is None else plan.blades.copies
    turned = {op.name for op in plan.operations if op.number in copies}
    drawn = [found for found in verdict.operations if found.maps and not (found.passed and found.name in turned)]

    def draw(index: int, into: Path) -> None:
        found = drawn[index]
        targets = found.maps[:len(found.faces)]
        map_picture(targets, found.scallop_limit, found.gouge_allowed,
                    found.name).savefig(into / f"{found.name}-verdict.png")

    _draw_abreast(draw, [found.name for found in drawn], folder, progress, workers)
