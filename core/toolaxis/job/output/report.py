"""From a plan's folder to its page: what stands in the folder, and what follows from it."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput, MissingBackend
from toolaxis.job.files.contacts_from_cl import widths_along, with_contacts
from toolaxis.job.files.plan_folder import PLAN, read_json, read_plan, sha256_of, stage_folder
from toolaxis.job.files.verdict_maps import NAME as MAPS
from toolaxis.job.files.verdict_maps import read_views
from toolaxis.job.planning.timing import feeds_of
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.progress import NO_PROGRESS, Progress, activate_progress

if TYPE_CHECKING:
    from toolaxis.report.html.page import Curve

Array = NDArray[np.float64]

PAGE = "report.html"
#: Files of the folder whose hashes the page shows.
_LISTED = (PLAN, "part.*", "obstacle-*.*", "*.apt", "failed-*.txt", "verdict.json", MAPS, "program-*.*", "setup-*.md")
#: What the page reads of the verdict, and of each of its operations.
_VERDICT = ("passed", "reasons", "not_checked", "operations")
_JUDGED = ("name", "passed", "reasons", "scallop_max", "share_within", "gouge_max", "clearance", "worst_scallop",
           "worst_gouge", "zones", "rays")
#: Points of the strip widths of one operation on the page.
_MOST_WIDTHS = 6000


def report(folder: Path, file: Path | None = None, progress: Progress = NO_PROGRESS) -> Path:
    """Write a plan's folder as one HTML page that needs nothing else.

    Parameters
    ----------
    folder : Path
        That `toolaxis plan` wrote; with the verdict where `toolaxis verify` wrote one.
    file : Path, optional
        The page; `report.html` in the folder unless given.
    progress : Progress

    Returns
    -------
    Path
        The page.

    Raises
    ------
    MissingBackend
        When template library or viewer are not installed.
    InvalidInput
        When the folder holds no whole plan, or the page cannot be written.
    Cancelled
        When the progress object asks to stop; then nothing is written.
    """
    try:
        from toolaxis.report.html.page import page
    except ImportError as reason:
        raise MissingBackend(f"the page needs {reason.name}: pip install 'toolaxis[report]'") from reason
    target = folder / PAGE if file is None else file
    if target.is_dir():
        raise InvalidInput(f"the page {target} is a folder: give a file name with --out")
    with activate_progress(progress):
        plan = read_plan(folder)
        plan = with_contacts(plan, frozenset(op.number for op in _operations_drawn(plan)))
        text = page(plan, _beside(plan, folder, progress), folder.resolve().name)
    with stage_folder(target.parent) as stage:
        (stage.folder / target.name).write_text(text, encoding="utf-8")
        stage.publish()
    return target


def _beside(plan: Plan, folder: Path, progress: Progress) -> Any:
    """Everything that the page shows besides the plan."""
    from toolaxis.report.html.page import PlanFiles

    verdict = read_verdict(folder)
    names = {op.name for op in plan.operations}
    views = {} if verdict is None else {name: view for name, view in read_views(folder).items() if name in names}
    fixed = [op for op in _operations_drawn(plan) if op.done and op.orientation.lead is None]
    widths: dict[str, Any] = {}
    feeds: dict[str, Curve] = {}
    for index, op in enumerate(fixed):
        progress.report("strip widths", index, len(fixed))
        progress.check()
        lines = widths_along(plan, op)
        step = -(-sum(len(width) for _, width in lines) // _MOST_WIDTHS) if lines else 1
        widths[op.name] = [(line[::step], width[::step]) for line, width in lines]
        found = _feed(plan, op)
        if found is not None:
            feeds[op.name] = found
    progress.report("page", 0, 1)
    source = read_json(folder / PLAN)["part"]["source"] or ""
    return PlanFiles(verdict, views, widths, feeds, _files(folder), source, _still(plan))


def _operations_drawn(plan: Plan) -> list[Operation]:
    """The operations whose passes are drawn: no turned copies."""
    copies = {} if plan.blades is None else plan.blades.copies
    return [op for op in plan.operations if op.number not in copies]


def _feed(plan: Plan, op: Operation) -> "Curve | None":
    """Feed along the longest pass of an operation, mm and mm/min; None where the machine's limits are not known."""
    from toolaxis.feed.fixed_axis_time import longest_cut
    from toolaxis.report.figures.kinematics import speeds_along

    if plan.machine is None or op.path is None or op.time is None or not op.rotary:
        return None
    found = longest_cut(plan.machine.machine, op.path, feeds_of(plan.inputs), op.rotary, plan.machine.table_from_part)
    if found is None:
        return None
    places, speeds = speeds_along(found)
    return places, 60 * speeds


def read_verdict(folder: Path) -> Mapping[str, Any] | None:
    """The document of verdict.json; None where the plan was not judged.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    InvalidInput
        When the file is damaged or not a verdict.
    """
    path = folder / "verdict.json"
    if not path.is_file():
        return None
    found = read_json(path)
    whole = isinstance(found, dict) and found.get("schema") == "toolaxis.verdict" and all(
        key in found for key in _VERDICT) and all(key in op for op in found["operations"] for key in _JUDGED)
    if not whole:
        raise InvalidInput(f"{path} is no verdict of this version: run toolaxis verify again")
    return found


def _files(folder: Path) -> list[tuple[str, int, str]]:
    """Name, size and SHA-256 of the plan's files."""
    paths = dict.fromkeys(path for pattern in _LISTED for path in sorted(folder.glob(pattern)) if path.is_file())
    return [(path.name, path.stat().st_size, sha256_of(path)) for path in paths]


def _still(plan: Plan) -> bytes:
    """A picture of the plan, as PNG."""
    from io import BytesIO

    from toolaxis.report.figures.plan_overview import overview_picture
    from toolaxis.report.figures.plots import operation_picture

    if not plan.operations:
        return b""
    only = plan.operations[0]
    alone = len(plan.operations) == 1 and only.done and only.frame is not None
    made = operation_picture(plan, only) if alone else overview_picture(plan)
    file = BytesIO()
    made.savefig(file, format="png", metadata={"Software": None})
    return file.getvalue()
