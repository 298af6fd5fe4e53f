"""`toolaxis export`: a plan for other programs, as STEP or glTF."""

from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

from toolaxis.cli.output import print_json, say
from toolaxis.job.output.export import export


def run(given: Namespace, asked: Callable[[], bool]) -> int:
    """Write the file of a plan's folder.

    Parameters
    ----------
    given : argparse.Namespace
    asked : callable
        Whether the user asked to stop.

    Returns
    -------
    int
        0
    """
    folder = Path(given.folder)
    made = export(folder, Path(given.out) if given.out else folder / "plan.step", colour=given.colour)
    if given.json:
        print_json({"file": str(made), "bytes": made.stat().st_size})
    say(f"toolaxis: {made}")
    return 0
