"""`toolaxis report`: a plan as one HTML page."""

from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

from toolaxis.cli.display import shown_progress
from toolaxis.cli.output import print_json, say
from toolaxis.job.reporting import report


def run(given: Namespace, asked: Callable[[], bool]) -> int:
    """Write the page of a plan's folder.

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
    with shown_progress(asked) as progress:
        made = report(Path(given.folder), Path(given.out) if given.out else None, progress)
    if given.json:
        print_json({"page": str(made), "bytes": made.stat().st_size})
    say(f"toolaxis: {made}")
    return 0
