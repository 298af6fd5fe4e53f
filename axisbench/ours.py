"""Our entries and the classical methods', made with the library's own functions and scored like anybody's.

fixed-axis: the best axis of the hemisphere, Roman's rule, the mean normal, a ball end of the same radius along it.
passes: iso-parametric, iso-planar, a field, and iso-scallop passes that are offset from a border.
orientations: sub-surfaces that share the fewest axes; one axis.  four-plus-one, five-axes: the strategies, and the best
fixed axis.  whole-part: a rack; its largest tool for all, and its smallest one.
"""

import csv
import json
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from axisbench.entry import read_entry, write_entry
from axisbench.judge import judge_entry, score_of
from axisbench.problem import BenchmarkProblem, load_problems
from axisbench.score import RECORDS, RESULTS, EntryScore, compared_value, load_records, run_in_processes
from benchmarks._iso_scallop import BORDERS, iso_scallop_passes
from numpy.typing import NDArray

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.placement import place
from toolaxis.errors import ToolAxisError
from toolaxis.path.parametrization import Cut
from toolaxis.plan.plan import Plan
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Paths = list[tuple[int, ToolPath]]

#: The methods of each task, ours first: the columns of the tables.
METHODS = {"fixed-axis": ("ours", "roman", "normal", "ball"), "passes": ("field", "iso", "planes", "offset"),
           "orientations": ("ours", "one"), "four-plus-one": ("ours", "fixed"),
           "five-axes": ("ours", "two-point", "fixed"), "whole-part": ("ours", "largest", "smallest")}

#: Passes that are offset from a border, at most: where strips have almost no width they hardly get on.
MOST_OFFSET = 50
#: Curvature above which a face is bent, 1/mm, and area from which two contacts take minutes, mm^2.
_BENT, _LARGE = 1e-6, 1e4


class MadeEntry(NamedTuple):
    """An entry of ours: method : its name;  file : written, or None;  seconds : of processor time that it took;
    ideal : mm, to which passes with its axis tend as the scallop height goes to zero, 0 where it is not known;
    score : what it scored;  reason : why there is none, or why it failed."""

    method: str
    file: Path | None
    seconds: float
    ideal: float
    score: EntryScore
    reason: str


class EntryJob(NamedTuple):
    """What a process is asked: name : of the problem;  method : of `METHODS`;  folder : for the entry."""

    name: str
    method: str
    folder: Path


def make_and_score(folder: Path, workers: int, only: str = "") -> None:
    """Make all entries, score them, and write tables to the results: one for each task, and the records.

    Parameters
    ----------
    folder : Path
        For the entries, in a folder for each method.
    workers : int
        Processes.
    only : str
        What the names of the problems must contain.
    """
    began = time.perf_counter()
    jobs = [EntryJob(name, method, folder) for name, one in load_problems().items() if only in name
            for method in methods_for(one)]
    # The longest first, so that no process is left alone at the end.
    jobs.sort(key=lambda job: load_problems()[job.name].task != "whole-part")
    made: dict[str, list[MadeEntry]] = {}
    for job, one in zip(jobs, run_in_processes(make_entry, jobs, workers), strict=True):
        made.setdefault(job.name, []).append(one)
        print(f"{job.name:36} {one.method:10} {one.seconds:6.1f} s  {one.reason[:110]}", flush=True)
    write_records(made)
    for task in METHODS:
        print_task(task, made)
    spent = sum(one.seconds + one.score.seconds for rows in made.values() for one in rows)
    wall = time.perf_counter() - began
    print(f"{len(jobs)} entries in {wall / 60:.1f} min, {spent / 60:.1f} min of processor time")


def methods_for(problem: BenchmarkProblem) -> tuple[str, ...]:
    """The methods of a problem: two contacts only on small faces that are hollow everywhere.

    Parameters
    ----------
    problem : BenchmarkProblem
    """
    names = METHODS[problem.task]
    if "two-point" not in names:
        return names
    face = problem.asked[0]
    curvature = face.curvature(face.grid(12, 12))
    hollow = bool((curvature.k1 > _BENT).all() and (curvature.k2 > -_BENT).all())
    return names if hollow and face.area < _LARGE else tuple(name for name in names if name != "two-point")


def make_entry(job: EntryJob) -> MadeEntry:
    """Make one entry and judge it.

    Parameters
    ----------
    job : EntryJob
    """
    problem = _problem_for(load_problems()[job.name], job.method)
    began = time.process_time()
    file = job.folder / job.method / f"{job.name}.csv"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.unlink(missing_ok=True)
    try:
        paths, ideal = _MAKERS[problem.task](problem, job.method)
    except ToolAxisError as reason:
        return _no_entry(job, began, str(reason))
    write_entry(file, paths, problem.is_part)
    spent, begun = time.process_time() - began, time.process_time()
    judged = judge_entry(problem, read_entry(file, problem))
    score = EntryScore(job.name, 0.0, float("nan"), judged, judged.reason, time.process_time() - begun)
    return MadeEntry(job.method, file, spent, ideal, score, judged.reason)


def _no_entry(job: EntryJob, began: float, reason: str) -> MadeEntry:
    nothing = EntryScore(job.name, 0.0, float("nan"), None, reason, 0.0)
    return MadeEntry(job.method, None, time.process_time() - began, 0.0, nothing, reason)


def _problem_for(problem: BenchmarkProblem, method: str) -> BenchmarkProblem:
    """The problem with the tool of a method: a ball end in place of the problem's tool is a baseline, no entry."""
    if method != "ball" or problem.tools[0].kind == "ball":
        return problem
    tool = problem.tools[0]
    ball = Tool.ball(2 * tool.radius, stickout=tool.stickout, holder=tool.holder)
    return replace(problem, tools=(ball,))


def _plan(problem: BenchmarkProblem, **words: object) -> Plan:
    """A plan of a problem with one tool."""
    around = ta.Part.from_faces(problem.obstacles) if problem.obstacles else None
    made = ta.plan(problem.part, problem.tools[0], problem.scallop, tolerance=problem.tolerance, workers=1,
                   obstacles=around, limits=problem.limits or None, **words)  # type: ignore[arg-type]
    if made.outcome != "complete":
        why = [reason for op in made.operations if not op.done for reason in op.orientation.reasons]
        raise ta.InvalidInput(why[0] if why else f"the plan is {made.outcome}")
    return made


def _paths_of(plan: Plan) -> tuple[Paths, float]:
    done = [op for op in plan.operations if op.path is not None]
    paths = [(plan.tools.index(op.tool), op.path) for op in done if op.path is not None]
    ideals = [op.orientation.ideal_of_cut for op in done]
    return paths, sum(ideals) if all(value > 0 for value in ideals) else 0.0


def _make_fixed_axis(problem: BenchmarkProblem, method: str) -> tuple[Paths, float]:
    if method == "ours":
        return _paths_of(_plan(problem))
    return _paths_of(_plan(problem, method="normal" if method == "ball" else method))


def _make_passes(problem: BenchmarkProblem, method: str) -> tuple[Paths, float]:
    assert problem.axis is not None
    if method == "offset":
        return [(0, _shortest_offset(problem))], 0.0
    made = []
    for feed in ("u", "v") if method != "field" else ("",):
        given = [ta.SubSurface(1, axis=problem.axis, feed=feed, locked=True)]
        with suppress(ToolAxisError):
            made.append(_plan(problem, division=given, passes={"field": "scallop"}.get(method, method)))
    if not made:
        raise ta.InvalidInput("passes cannot be laid along u nor along v with the given axis")
    return _paths_of(min(made, key=lambda plan: plan.length))


def _make_orientations(problem: BenchmarkProblem, method: str) -> tuple[Paths, float]:
    if method == "one":
        return _paths_of(_plan(problem, method="one"))
    for count in (2, 3, 4, 6):
        try:
            return _paths_of(_plan(problem, orientations=count))
        except ta.InvalidInput:
            continue
    raise ta.InvalidInput("no plan with up to six shared axes is complete")


def _make_moving(problem: BenchmarkProblem, method: str) -> tuple[Paths, float]:
    machine = {"machine": problem.machine} if problem.machine else {}
    strategy = {"four-plus-one": "four-plus-one", "five-axes": "sturz"}[problem.task]
    if method == "fixed":
        return _paths_of(_plan(problem, **machine))
    return _paths_of(_plan(problem, strategy=strategy if method == "ours" else method, **machine))


def _make_whole_part(problem: BenchmarkProblem, method: str) -> tuple[Paths, float]:
    faces: Sequence[int] | str = problem.faces or "skins"
    tools = {"ours": problem.tools, "largest": problem.tools[:1], "smallest": problem.tools[-1:]}[method]
    made = ta.plan(problem.part, list(tools), problem.scallop, tolerance=problem.tolerance, workers=1, faces=faces)
    done = [(op.tool, op.path) for op in made.operations if op.path is not None]
    if not done:
        raise ta.InvalidInput(next((why for op in made.operations for why in op.orientation.reasons), "nothing is cut"))
    sizes = [(tool.kind, tool.radius, tool.corner_radius) for tool in problem.tools]
    return [(sizes.index((tool.kind, tool.radius, tool.corner_radius)), path) for tool, path in done], 0.0


_MAKERS: dict[str, Callable[[BenchmarkProblem, str], tuple[Paths, float]]] = {
    "fixed-axis": _make_fixed_axis, "passes": _make_passes, "orientations": _make_orientations,
    "four-plus-one": _make_moving, "five-axes": _make_moving, "whole-part": _make_whole_part}


def _shortest_offset(problem: BenchmarkProblem) -> ToolPath:
    """Iso-scallop passes offset from the border from which they are shortest, each run on straight at its ends."""
    assert problem.axis is not None
    face, tool = problem.asked[0], problem.tools[0]
    cut = Cut(tool, problem.axis, problem.scallop)
    found = []
    for border in BORDERS:
        lines = iso_scallop_passes(face, cut, border, MOST_OFFSET)
        if lines is not None:
            passes = [_run_on(place(face, tool, uv, problem.axis), tool.radius) for uv in lines]
            found.append((sum(float(np.linalg.norm(np.diff(one, axis=0), axis=1).sum()) for one in passes), passes))
    if not found:
        raise ta.InvalidInput("passes that are offset from a border get across from none")
    _, passes = min(found, key=lambda one: one[0])
    tips = np.concatenate(passes)
    kind = np.concatenate([np.append(int(Motion.LINK), np.zeros(len(one) - 1)) for one in passes]).astype(np.int8)
    ends = np.cumsum([0, *(len(one) for one in passes)])
    axes = np.tile(problem.axis, (len(tips), 1))
    return ToolPath(tips, tips, axes, axes, kind, ends)


def _run_on(tips: Array, length: float) -> Array:
    """A pass that goes on straight at both ends."""
    first, last = tips[0] - tips[1], tips[-1] - tips[-2]
    before = tips[0] + length * first / np.linalg.norm(first)
    return np.vstack([before, tips, tips[-1] + length * last / np.linalg.norm(last)])


def write_records(made: dict[str, list[MadeEntry]]) -> None:
    """Write the best of each problem: what later entries are set beside where no bound is known.

    Parameters
    ----------
    made : dict of str to list of MadeEntry
        By problem.
    """
    best = dict(load_records())
    for name, rows in made.items():
        problem = load_problems()[name]
        values = [_record(problem, one) for one in rows if one.method != "ball"]
        values = [value for value in values if np.isfinite(value)]
        best.pop(name, None)
        if values:
            best[name] = round(min(values), 4)
    order = {name: best[name] for name in load_problems() if name in best}
    RECORDS.parent.mkdir(parents=True, exist_ok=True)
    RECORDS.write_text(json.dumps(order, indent=1) + "\n", encoding="utf-8")
    load_records.cache_clear()


def _record(problem: BenchmarkProblem, one: MadeEntry) -> float:
    judged = one.score.judged
    return compared_value(problem, judged) if judged is not None and judged.passed else float("inf")


def print_task(task: str, made: dict[str, list[MadeEntry]]) -> None:
    """Print the table of a task and write it to the results.

    Parameters
    ----------
    task : str
    made : dict of str to list of MadeEntry
        By problem.
    """
    rows, records = [], load_records()
    print(f"\n{task}")
    for name, one in load_problems().items():
        if one.task != task or name not in made:
            continue
        print(f"  {name}{'; bound ' + format(one.bound, '.1f') if one.bound else ''}")
        for entry in made[name]:
            judged = entry.score.judged
            reference = one.bound or records.get(name)
            points = 0.0 if judged is None else score_of(one, judged, records.get(name))
            score = replace(entry.score, score=points, reference=float("nan") if reference is None else reference,
                            reason=entry.reason)
            row = score.row()
            rows.append({"method": entry.method, **row, "ideal": f"{entry.ideal:.1f}" if entry.ideal else "",
                         "plan_seconds": f"{entry.seconds:.1f}",
                         "judge_seconds": f"{entry.score.seconds:.1f}"})
            print(f"    {entry.method:10} {row['score']:>6} {row['measured']:>10} within {row['finished']:>8} passes "
                  f"{row['passes']:>4} ideal {rows[-1]['ideal']:>8}  {entry.reason[:80]}")
        for text in one.printed:
            print(f"    printed    {text}")
    if rows:
        write_table(RESULTS / f"{task}.csv", rows)


def write_table(path: Path, rows: Sequence[Mapping[str, str]]) -> None:
    """Write a table of results; rows of problems that it has and these have not are kept.

    Parameters
    ----------
    path : Path
    rows : sequence of mapping
    """
    known: list[Mapping[str, str]] = []
    if path.is_file():
        with path.open(newline="", encoding="utf-8") as file:
            known = list(csv.DictReader(file))
    fresh = {row["problem"] for row in rows}
    order = {name: k for k, name in enumerate(load_problems())}
    every = [row for row in known if row["problem"] in order and row["problem"] not in fresh] + list(rows)
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, list(rows[0]), lineterminator="\n", restval="", extrasaction="ignore")
        table.writeheader()
        table.writerows(sorted(every, key=lambda row: order[row["problem"]]))

