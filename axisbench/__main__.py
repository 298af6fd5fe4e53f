"""The benchmark's command: ``python -m axisbench rebuild | list | score FOLDER | ours | bad | all``."""

import argparse
import sys
from pathlib import Path

from axisbench.entry import BadEntry
from axisbench.make_data import rebuild
from axisbench.problem import TASKS, UNITS, load_problems
from axisbench.score import score_folder, write_results

OUT = Path("out") / "axisbench"


def main(words: list[str] | None = None) -> int:
    """Run a command: 0 where all went well, 1 where an entry failed, 2 where one could not be judged.

    Parameters
    ----------
    words : list of str, optional
        Those of the command line unless given.
    """
    parser = argparse.ArgumentParser(prog="python -m axisbench", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("rebuild", help="make all data anew from code and seeds")
    commands.add_parser("list", help="print the problems")
    score = commands.add_parser("score", help="judge the entries in a folder")
    score.add_argument("folder", type=Path)
    score.add_argument("--out", type=Path, help="table of results (CSV)")
    for name, told in (("ours", "make our entries and the classical ones, and score them"),
                       ("bad", "make entries that must fail, and score them"), ("all", "all of these")):
        commands.add_parser(name, help=told).add_argument("--out", type=Path, default=OUT)
    for name in ("score", "ours", "bad", "all"):
        commands.choices[name].add_argument("--workers", type=int, default=2, help="processes (2)")
    commands.choices["ours"].add_argument("--only", default="", help="problems with this in their names")
    asked = parser.parse_args(words)
    try:
        return _run_command(asked)
    except BadEntry as reason:
        print(reason, file=sys.stderr)
        return 2


def _run_command(asked: argparse.Namespace) -> int:
    if asked.command == "rebuild":
        rebuild()
        return 0
    if asked.command == "list":
        list_problems()
        return 0
    if asked.command == "score":
        found = score_folder(asked.folder, asked.workers)
        if asked.out is not None:
            write_results(asked.out, found)
        return 2 if any(one.refused for one in found) else int(any(one.score <= 0 for one in found))
    return _make_and_score(asked)


def _make_and_score(asked: argparse.Namespace) -> int:
    from axisbench.bad import score_bad_entries
    from axisbench.ours import make_and_score

    asked.out.mkdir(parents=True, exist_ok=True)
    if asked.command == "all":
        rebuild()
    code = 0
    if asked.command in ("ours", "all"):
        make_and_score(asked.out, asked.workers, getattr(asked, "only", ""))
    if asked.command in ("bad", "all"):
        code = score_bad_entries(asked.out / "bad", asked.workers)
    return code


def list_problems() -> None:
    """Print every problem with its tools and limits."""
    for one in load_problems().values():
        tools = " ".join(f"{tool.kind}:{2 * tool.radius:g}x{tool.corner_radius:g}" for tool in one.tools)
        more = [] if one.axis is None else ["axis " + " ".join(f"{value:.6f}" for value in one.axis)]
        more += [text for text in (one.limits, one.machine and f"machine {one.machine}") if text]
        unit = UNITS[TASKS[one.task]]
        print(f"{one.name:36} {tools:24} scallop {one.scallop:g} mm, least {one.measured}{unit and ', ' + unit}"
              f"{'; ' if more else ''}{'; '.join(more)}")


if __name__ == "__main__":
    sys.exit(main())
