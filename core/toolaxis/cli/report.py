"""`toolaxis report`: a plan, or a batch, as HTML pages."""

from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

from toolaxis.cli.display import show_progress
from toolaxis.cli.output import print_json, say
from toolaxis.job.output.report import report


def run(given: Namespace, asked: Callable[[], bool]) -> int:
    """Write the page of a plan's folder, or those of a batch's.

    Parameters
    ----------
    given : argparse.Namespace
    asked : callable
        Whether the user asked to stop.

    Returns
    -------
    int
        0, whatever the page says of the plan.
    """
    from toolaxis.batch.report import is_batch, report_batch

    folder = Path(given.folder)
    write = report_batch if is_batch(folder) else report
    with show_progress(asked) as progress:
        made = write(folder, Path(given.out) if given.out else None, progress)
    if given.json:
        print_json({"page": str(made), "bytes": made.stat().st_size})
    say(f"toolaxis: {made}")
    return 0
