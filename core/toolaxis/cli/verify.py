"""`toolaxis verify`: judge a plan by material removal."""

from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

from toolaxis.cli.display import shown_progress
from toolaxis.cli.output import print_json, print_table, say
from toolaxis.job.folder import read_plan, staged, write_json
from toolaxis.job.judge import not_judged, passes, verdict_document, verify_plan
from toolaxis.job.views import write_views
from toolaxis.report.tables import verdict_table


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
        0 where everything passed, else 1.
    """
    folder = Path(given.folder)
    with shown_progress(asked) as progress:
        plan = read_plan(folder)
        with staged(folder) as stage:
            verdict = verify_plan(plan, progress=progress)
            document = verdict_document(plan, verdict)
            write_json(document, stage.folder / "verdict.json")
            write_views(plan, verdict, stage.folder)
            if not given.no_pictures:
                from toolaxis.job.pictures import draw_verdict

                draw_verdict(plan, verdict, stage.folder, progress)
            stage.publish(clear=False)
    if given.json:
        print_json(document)
    else:
        print_table(verdict_table(plan, verdict))
    for op in plan.operations:
        if op.done and op.orientation.unreached > 0:
            say(f"toolaxis: {op.name}: the plan leaves {100 * op.orientation.unreached:.1f} % of the area, at "
                "walls, to clean-up: that share was not asked for")
    missing = not_judged(plan, verdict)
    if missing:
        say(f"toolaxis: not checked: {', '.join(missing)}")
    for reason in document["reasons"]:
        say(f"toolaxis: {reason}")
    if plan.outcome == "cancelled":
        say("toolaxis: the plan was cancelled before all sub-surfaces were done")
    return 0 if passes(plan, verdict) else 1
