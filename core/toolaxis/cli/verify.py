"""`toolaxis verify`: judge a plan by material removal."""

from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

from toolaxis.cli.display import show_progress
from toolaxis.cli.output import print_json, print_table, say
from toolaxis.cli.stopping import writing
from toolaxis.errors import Cancelled
from toolaxis.job.files.plan_folder import OF_VERDICT, read_plan, stage_folder, write_json
from toolaxis.job.files.verdict_maps import write_views
from toolaxis.job.output.verify import not_judged, passes, verdict_document, verify_plan
from toolaxis.job.planning.parallel import check_workers
from toolaxis.plan.plan import Plan
from toolaxis.progress import Progress
from toolaxis.report.areas_aside import describe_open
from toolaxis.report.tables import verdict_table
from toolaxis.report.verdict_words import count_passed, name_verdict
from toolaxis.verify.verdict import Verdict

#: Operations that are named with what they leave; the others are counted.
_TOLD = 10


def run(given: Namespace, asked: Callable[[], bool]) -> int:
    """Judge a plan's folder, write verdict.json and the maps beside it, and print the verdict.

    Parameters
    ----------
    given : argparse.Namespace
    asked : callable
        Whether the user asked to stop.

    Returns
    -------
    int
        0 where everything passed, 1 where not, 130 where the user stopped it.
    """
    folder, workers = Path(given.folder), check_workers(given.workers)
    with show_progress(asked) as progress:
        plan = read_plan(folder)
        with stage_folder(folder) as stage:
            verdict = verify_plan(plan, workers=workers, progress=progress)
            document = verdict_document(plan, verdict)
            with writing():
                write_json(document, stage.folder / "verdict.json")
                write_views(plan, verdict, stage.folder)
            if not (given.no_pictures or verdict.unjudged):
                _draw(plan, verdict, stage.folder, progress, workers)
            with writing():
                stage.publish(OF_VERDICT)
    if given.json:
        print_json(document)
    else:
        print_table(verdict_table(plan, verdict))
    for line in set_aside(verdict):
        say(f"toolaxis: {line}")
    missing = not_judged(plan, verdict)
    if missing:
        say(f"toolaxis: not checked: {', '.join(missing)}")
    for reason in document["reasons"]:
        say(f"toolaxis: {reason}")
    if not verdict.unjudged:
        count = f" ({count_passed(document)})" if verdict.operations else ""
        say(f"toolaxis: verdict on what was made: {name_verdict(document)}{count}")
    still_open = describe_open(plan)
    if still_open:
        say(f"toolaxis: {still_open}")
    if plan.outcome == "cancelled":
        say("toolaxis: the plan was cancelled before all sub-surfaces were done")
    if verdict.unjudged:
        say(f"toolaxis: stopped: {len(verdict.operations)} operations were verified, {len(verdict.unjudged)} were not; "
            f"{folder / 'verdict.json'} holds those that were, and is no verdict on the plan")
        return 130
    return 0 if passes(plan, verdict) else 1


def _draw(plan: Plan, verdict: Verdict, folder: Path, progress: Progress, workers: int) -> None:
    """Draw the maps; a verdict is worth keeping without them."""
    from toolaxis.job.output.pictures import draw_verdict

    try:
        draw_verdict(plan, verdict, folder, progress, workers)
    except Cancelled:
        say("toolaxis: stopped while drawing; the verdict is whole, pictures are missing")
    except Exception as reason:
        say(f"toolaxis: warning: pictures are missing ({type(reason).__name__}: {reason}); the verdict is whole")


def set_aside(verdict: Verdict) -> list[str]:
    """Where the plan leaves rest material, and how much that is: no scallop height was asked for there.

    Parameters
    ----------
    verdict : Verdict
    """
    some = [op for op in verdict.operations if op.declared > 0]
    told = [f"{op.name}: {op.declared:.2f} mm2, {100 * op.declared / op.area:.2f} % of the area, are rest "
            "material by the plan: no scallop height was asked for there" for op in some[:_TOLD]]
    if len(some) > _TOLD:
        area = sum(op.declared for op in some[_TOLD:])
        told.append(f"the same is true of {len(some) - _TOLD} further operations, {area:.2f} mm2 in all")
    return told
