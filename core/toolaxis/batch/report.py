"""From a batch's folder to its page, and to the pages of its jobs."""

import json
from collections.abc import Sequence
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

from toolaxis.batch.summary import NAME, VERSION
from toolaxis.errors import Cancelled, InvalidInput, MissingBackend, ToolAxisError
from toolaxis.job.files.plan_folder import PLAN, read_json, stage_folder
from toolaxis.job.output.report import PAGE, report
from toolaxis.job.planning.parallel import abreast, check_workers
from toolaxis.progress import NO_PROGRESS, Progress

SUMMARY = "summary.json"
#: The list of warnings stands at the beginning of a page, before style and data.
_HEAD = 1_000_000


def is_batch(folder: Path) -> bool:
    """Whether a folder is that of a batch, and not of one plan.

    Parameters
    ----------
    folder : Path
    """
    return (folder / SUMMARY).is_file() and not (folder / PLAN).is_file()


def report_batch(folder: Path, file: Path | None = None, progress: Progress = NO_PROGRESS, *,
                 workers: int | None = None) -> Path:
    """Write the page of a batch, and those of its jobs that are missing or older than their plans.

    Parameters
    ----------
    folder : Path
        That `toolaxis batch` wrote.
    file : Path, optional
        The page; `report.html` in the folder unless given.
    progress : Progress
    workers : int, optional
        Processes that make the pages of jobs; as many as there are cores unless given.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    MissingBackend
        When template library or viewer are not installed.
    InvalidInput
        When the folder has no summary of this version, or the page cannot be written.
    Cancelled
        When the progress object asks to stop; pages of jobs that are finished stay.
    """
    try:
        from toolaxis.report.html.batch_page import JobPage, batch_page
    except ImportError as reason:
        raise MissingBackend(f"the page needs {reason.name}: pip install 'toolaxis[report]'") from reason
    target = folder / PAGE if file is None else file
    if target.is_dir():
        raise InvalidInput(f"the page {target} is a folder: give a file name with --out")
    records = _records(folder)
    with stage_folder(target.absolute().parent) as stage:
        planned = [record for record in records if record["folder"]]
        made = abreast(lambda index, told: _leaf(folder, planned[index], (index, len(planned)), told), len(planned),
                       check_workers(workers), progress)
        if made.cancelled:
            raise Cancelled("the page of the batch was not made")
        leaves = {planned[k]["job"]: JobPage(*found) for k, found in made.results.items()}
        leaves |= {planned[k]["job"]: JobPage("", [], f"no page: {fault.sentence}") for k, fault in made.faults.items()}
        text = batch_page(folder.resolve().name, records, leaves)
        (stage.folder / target.name).write_text(text, encoding="utf-8")
        stage.publish()
    return target


def _records(folder: Path) -> Sequence[dict[str, Any]]:
    path = folder / SUMMARY
    document = read_json(path)
    if not (isinstance(document, dict) and document.get("schema") == NAME and document.get("version") == VERSION):
        raise InvalidInput(f"{path} is no summary of a batch of this version: run the batch again, it repeats nothing")
    return list(document["jobs"])


def _leaf(folder: Path, record: dict[str, Any], place: tuple[int, int],
          progress: Progress) -> tuple[str, list[tuple[str, str]], str]:
    """Address and warnings of a job's page, made where that is needed; or why there is none."""
    own = folder / record["folder"]
    page = own / PAGE
    progress.report("pages", *place)
    try:
        sources = [path.stat().st_mtime_ns for name in (PLAN, "verdict.json") if (path := own / name).is_file()]
        if not page.is_file() or page.stat().st_mtime_ns < max(sources, default=0):
            report(own, None, Progress(None, progress.cancelled))
        return f"{record['folder']}/{PAGE}", _warnings(page), ""
    except Cancelled:
        raise
    except (ToolAxisError, OSError) as reason:
        return "", [], f"no page: {' '.join(str(reason).split())}"


class _Head(HTMLParser):
    """The list of warnings in the head of a page."""

    found: str | None = None

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if tag == "meta" and given.get("name") == "toolaxis-warnings":
            self.found = given.get("content")


def _warnings(page: Path) -> list[tuple[str, str]]:
    head = _Head()
    with page.open(encoding="utf-8") as file:
        head.feed(file.read(_HEAD).partition("<style>")[0])
    try:
        return [(str(level), str(text)) for level, text in json.loads(head.found or "[]")]
    except ValueError as reason:
        raise InvalidInput(f"{page} is damaged ({reason}): remove it and make it again") from reason
