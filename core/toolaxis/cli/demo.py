"""`toolaxis demo`: the example part planned, judged, posted and shown, in a folder of its own."""

import shutil
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any

from toolaxis.cli.display import show_progress
from toolaxis.cli.output import print_json, say
from toolaxis.cli.stopping import writing
from toolaxis.errors import Cancelled, InvalidInput
from toolaxis.job.files.plan_folder import PLAN, stage_folder, write_json, write_plan
from toolaxis.machine.library import load_machine
from toolaxis.plan.plan import Plan
from toolaxis.progress import Progress
from toolaxis.resources import find_files

#: The part, the machine by its name, the greatest scallop height, mm, and the controls that programs are written for.
PART, MACHINE, SCALLOP, DIALECTS = "dish", "mikron-ucp-710", 0.05, ("heidenhain", "fanuc")
#: Folder of the plan, within that of the demo.
PLANNED = "plan"


def run(given: Namespace, asked: Callable[[], bool]) -> int:
    """Write the example part, plan and judge it, write programs and page, and say what lies where.

    Parameters
    ----------
    given : argparse.Namespace
    asked : callable
        Whether the user asked to stop.

    Returns
    -------
    int
        0 where the plan is complete and passed, 1 where not.

    Raises
    ------
    InvalidInput
        When the folder exists, or the example part is not installed.
    Cancelled
        When the user asked to stop; then nothing is written.
    """
    target = Path(given.folder)
    if target.exists():
        raise InvalidInput(f"{target} exists: toolaxis demo writes a new folder; name another one")
    source = find_files("examples", ".step").get(PART)
    if source is None:
        raise InvalidInput(f"the example part {PART}.step is not installed: install toolaxis again")
    with stage_folder(target) as stage:
        shutil.copyfile(source, stage.folder / source.name)
        with show_progress(asked) as progress:
            made = _plan_part(source, stage.folder / PLANNED, progress, pictures=not given.no_pictures)
            document = _judge_plan(made, stage.folder / PLANNED, progress, pictures=not given.no_pictures)
            programs = _write_programs(made, stage.folder / PLANNED)
            page = _write_page(stage.folder / PLANNED, progress)
        with writing():
            stage.publish()
    passed = made.outcome == "complete" and bool(document["passed"])
    folder = target / PLANNED
    if given.json:
        print_json({"part": str(target / source.name), "plan": str(folder / PLAN), "passed": passed,
                    "verdict": str(folder / "verdict.json"), "page": str(folder / page),
                    "programs": [str(folder / name) for name in programs]})
    _say_what_lies_where(target, source.name, made, document, programs, page)
    return 0 if passed else 1


def _plan_part(source: Path, folder: Path, progress: Progress, *, pictures: bool) -> Plan:
    """Plan the part with the general rack on a machine that comes with the program, and write the plan's folder."""
    from toolaxis.cli.compile_ahead import compiling_ahead
    from toolaxis.job.output.pictures import draw_plan
    from toolaxis.job.planning.parallel import check_workers
    from toolaxis.job.planning.pipeline import plan

    folder.mkdir()
    with compiling_ahead():
        made = plan(source, scallop=SCALLOP, machine=MACHINE, progress=progress)
    if made.outcome == "cancelled":
        raise Cancelled("cancelled by the user")
    made = write_plan(made, folder)
    if pictures:
        draw_plan(made, folder, progress, check_workers(None))
    return made


def _judge_plan(made: Plan, folder: Path, progress: Progress, *, pictures: bool) -> dict[str, Any]:
    """Judge the plan by material removal, and write the verdict with its maps."""
    from toolaxis.job.files.verdict_maps import write_views
    from toolaxis.job.output.pictures import draw_verdict
    from toolaxis.job.output.verify import verdict_document, verify_plan
    from toolaxis.job.planning.parallel import check_workers

    verdict = verify_plan(made, progress=progress)
    if verdict.unjudged:
        raise Cancelled("cancelled by the user")
    document = verdict_document(made, verdict)
    write_json(document, folder / "verdict.json")
    write_views(made, verdict, folder)
    if pictures:
        draw_verdict(made, verdict, folder, progress, check_workers(None))
    return document


def _write_programs(made: Plan, folder: Path) -> list[str]:
    """Write a program and its setup sheet for each control; their names."""
    from toolaxis.job.output.post import post_plan, verdict_of
    from toolaxis.machine.setup import Mounting

    mounting, verdict, names = Mounting(load_machine(MACHINE)), verdict_of(folder), []
    for dialect in DIALECTS:
        for name, text in post_plan(made, dialect, mounting, name=PART, verdict=verdict).items():
            (folder / name).write_text(text, encoding="utf-8")
            names.append(name)
    return names


def _write_page(folder: Path, progress: Progress) -> str:
    """Write the page of the plan's folder; its name."""
    from toolaxis.job.output.report import report

    return report(folder, progress=progress).name


def _say_what_lies_where(target: Path, part: str, made: Plan, document: dict[str, Any], programs: list[str],
                         page: str) -> None:
    from toolaxis.report.verdict_words import name_verdict

    folder = target / PLANNED
    tools = " and ".join(dict.fromkeys(op.tool.shop_name for op in made.operations if op.done))
    count = len(made.operations)
    lines = [(target / part, "the part"),
             (folder / PLAN, f"the plan: {count} {'operation' if count == 1 else 'operations'} with {tools}"),
             (folder / "verdict.json", f"the verdict by material removal: {name_verdict(document)}"),
             *((folder / name, "setup sheet" if name.endswith(".md") else f"program for {load_machine(MACHINE).name}")
               for name in programs),
             (folder / page, "everything on one page: open it in a browser")]
    width = max(len(str(path)) for path, _ in lines)
    for path, text in lines:
        say(f"{path!s:{width}}  {text}")
    say(f"not checked: {', '.join(made.not_checked)}")
    say(f"The same by hand: toolaxis plan {target / part} --machine {MACHINE} --scallop {SCALLOP:g}")
