"""Scores of a folder of entries: each file is read, judged and set beside the bound or the best on record."""

import csv
import json
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, fields
from functools import cache
from math import isfinite, nan
from pathlib import Path
from typing import Any, TypeVar

from axisbench.entry import BadEntry, read_entry
from axisbench.judge import JudgedEntry, judge_entry, score_of, seconds_for_all
from axisbench.problem import FOLDER, BenchmarkProblem, UnknownProblem, load_problems, problem_named

RESULTS = FOLDER / "results"
RECORDS = RESULTS / "records.json"
#: Kinds of files that entries may be.
SUFFIXES = (".csv", ".apt", ".cls")
#: Columns of a table of results.
COLUMNS = ("problem", "score", "passed", "measured", "reference", "finished", "gouge", "clearance", "length", "passes",
           "orientations", "tools", "seconds", "reason")
Item = TypeVar("Item")
Answer = TypeVar("Answer")


@dataclass(frozen=True)
class EntryScore:
    """What one entry scores.

    Attributes
    ----------
    problem : str
    score : float
        0 to 100, more where it beats the best on record.
    reference : float
        Bound, or the best on record; nan without either.
    judged : JudgedEntry or None
        None where the file could not be read.
    reason : str
        Why it failed, in a sentence; empty where it passed.
    seconds : float
        What judging took.
    """

    problem: str
    score: float
    reference: float
    judged: JudgedEntry | None
    reason: str
    seconds: float

    @property
    def refused(self) -> bool:
        """Whether the file could not be judged."""
        return self.judged is None

    def row(self) -> dict[str, Any]:
        """A row of the table of results."""
        one = self.judged
        found = dict.fromkeys(COLUMNS, "") | {"problem": self.problem, "score": f"{self.score:.1f}",
                                                 "reason": self.reason, "reference": _text(self.reference),
                                                 "passed": "no"}
        if one is not None:
            problem = problem_named(self.problem)
            values = {field.name: getattr(one, field.name) for field in fields(one)}
            found |= {name: _text(values[name]) for name in COLUMNS if name in values and name != "reason"}
            found |= {"passed": "yes" if one.passed else "no", "measured": _text(compared_value(problem, one)),
                      "finished": f"{one.finished:.5f}", "gouge": f"{one.gouge:.4f}"}
        return found


def _text(value: float) -> str:
    if isinstance(value, int):
        return str(value)
    return f"{value:.2f}" if isfinite(value) else ""


def compared_value(problem: BenchmarkProblem, one: JudgedEntry) -> float:
    """What is set beside the record: on whole parts the seconds that the whole area would take.

    Parameters
    ----------
    problem : BenchmarkProblem
    one : JudgedEntry
    """
    if problem.is_part:
        return seconds_for_all(one) if one.finished > 0 else nan
    return one.value(problem.measured)


@cache
def load_records() -> Mapping[str, float]:
    """The best on record by problem."""
    return dict(json.loads(RECORDS.read_text("utf-8"))) if RECORDS.is_file() else {}


def score_file(path: Path) -> EntryScore:
    """Read and judge one file.

    Parameters
    ----------
    path : Path
        Named after its problem.
    """
    began = time.perf_counter()
    try:
        problem = problem_named(path.stem)
        judged = judge_entry(problem, read_entry(path, problem))
    except (BadEntry, UnknownProblem) as reason:
        return EntryScore(path.stem, 0.0, nan, None, str(reason), time.perf_counter() - began)
    record = load_records().get(problem.name)
    reference = problem.bound or record
    return EntryScore(problem.name, score_of(problem, judged, record), nan if reference is None else reference, judged,
                      judged.reason, time.perf_counter() - began)


def entry_files(folder: Path) -> list[Path]:
    """The entries in a folder, in the order of the problems; files of unknown problems last.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    BadEntry
        When it is no folder, has no entries, or has two files of one problem.
    """
    if not folder.is_dir():
        raise BadEntry(f"{folder} is no folder: give the folder that holds the entries, one file a problem")
    found = sorted(path for path in folder.iterdir() if path.suffix in SUFFIXES)
    if not found:
        raise BadEntry(f"{folder} has no entries: write a file such as fixed-axis-saddle.csv into it")
    names = [path.stem for path in found]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise BadEntry(f"{folder} has two entries of {twice[0]}: leave one of them")
    order = {name: k for k, name in enumerate(load_problems())}
    return sorted(found, key=lambda path: (order.get(path.stem, len(order)), path.stem))


def score_folder(folder: Path, workers: int = 2, show: Callable[[str], None] = print) -> list[EntryScore]:
    """Judge all entries of a folder.

    Parameters
    ----------
    folder : Path
    workers : int
        Processes.
    show : callable
        Takes each line of the table as it is known.
    """
    show(f"{'problem':36} {'score':>6} {'measured':>10} {'reference':>10} {'within':>8} {'gouge':>7} {'passes':>6} "
         f"{'judge s':>7}")
    found = []
    for one in run_in_processes(score_file, entry_files(folder), workers):
        found.append(one)
        row = one.row()
        show(f"{one.problem:36} {row['score']:>6} {row['measured']:>10} {row['reference']:>10} {row['finished']:>8} "
             f"{row['gouge']:>7} {row['passes']:>6} {one.seconds:7.1f}")
        if one.reason:
            show(f"    {one.reason}")
    total = sum(one.score for one in found)
    show(f"{len(found)} of {len(load_problems())} problems entered, {sum(one.score > 0 for one in found)} passed; mean "
         f"score {total / len(found):.1f} of those entered, {total / len(load_problems()):.1f} of all")
    return found


def run_in_processes(work: Callable[[Item], Answer], items: Sequence[Item], workers: int) -> Iterable[Answer]:
    """Answers in the order of the items, from so many processes.

    Parameters
    ----------
    work : callable
        At the top of a module.
    items : sequence
    workers : int
        1 for this process alone.
    """
    if workers <= 1 or len(items) <= 1:
        yield from map(work, items)
        return
    with ProcessPoolExecutor(workers) as pool:
        yield from pool.map(work, items)


def write_results(path: Path, scores: Iterable[EntryScore]) -> None:
    """Write a table of results.

    Parameters
    ----------
    path : Path
    scores : iterable of EntryScore
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        table.writeheader()
        table.writerows(one.row() for one in scores)
