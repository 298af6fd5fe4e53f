"""`toolaxis batch`: many parts, each planned in a process of its own, resumed where it was stopped."""

from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

from toolaxis.cli.display import show_progress
from toolaxis.cli.output import print_json, print_table, say


def run(given: Namespace, asked: Callable[[], bool]) -> int:
    """Plan the jobs of a file and print what they came to.

    Parameters
    ----------
    given : argparse.Namespace
    asked : callable
        Whether the user asked to stop.

    Returns
    -------
    int
        0 where every job is complete, 1 where one is not, 130 where the user stopped it.
    """
    from toolaxis.batch.run import batch
    from toolaxis.batch.summary import summary_document

    out = Path(given.out or Path("out") / Path(given.jobs).stem)
    with show_progress(asked) as progress:
        made = batch(given.jobs, out, workers=given.workers, scheduler=given.scheduler,
                     told=lambda text: say(f"toolaxis: {text}"), progress=progress)
    if given.json:
        print_json(summary_document(made.rows))
    else:
        from toolaxis.report.tables import batch_table

        print_table(batch_table([row.record for row in made.rows]))
    ended = sum(row.outcome != "not done" for row in made.rows)
    say(f"toolaxis: {ended} of {len(made.rows)} jobs ended, {made.repeated} of them in an earlier run, in {out}")
    if made.cancelled:
        say("toolaxis: stopped; the same command goes on where it stopped")
        return 130
    return 0 if made.complete else 1
