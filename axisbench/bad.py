"""Entries that must fail: what a scoring program has to find out by itself, each with the sentence that must come."""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
from axisbench.entry import write_entry
from axisbench.problem import BenchmarkProblem, problem_named
from axisbench.score import score_folder
from numpy.typing import NDArray

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath

Array = NDArray[np.float64]
#: A way to spoil rows (n, 7) of a good entry: pass, tip and axis.
Spoil = Callable[[BenchmarkProblem, Array], Array]


def leave_out_passes(problem: BenchmarkProblem, rows: Array) -> Array:
    """Every third pass is missing: passes lie too far apart."""
    return rows[rows[:, 0] % 3 != 0]


def sink_a_pass(problem: BenchmarkProblem, rows: Array) -> Array:
    """The middle pass is 0.1 mm too deep."""
    middle = np.round(np.median(np.unique(rows[:, 0])))
    sunk = rows.copy()
    sunk[rows[:, 0] == middle, 1:4] -= 0.1 * rows[rows[:, 0] == middle, 4:7]
    return sunk


def sink_one_point(problem: BenchmarkProblem, rows: Array) -> Array:
    """A single point in the middle of a pass is 0.1 mm too deep."""
    sunk = rows.copy()
    middle = len(rows) // 2
    sunk[middle, 1:4] -= 0.1 * rows[middle, 4:7]
    return sunk


def lean_into_the_wall(problem: BenchmarkProblem, rows: Array) -> Array:
    """The axis leans towards what stands beside the face, so that shank and holder are in it."""
    leant = rows.copy()
    leant[:, 4:7] = np.array([0.0, np.sin(0.9), np.cos(0.9)])
    return leant


def skip_between_points(problem: BenchmarkProblem, rows: Array) -> Array:
    """Only the ends of each pass stay: every point is right, and the straight way between them is not."""
    numbers = rows[:, 0]
    ends = np.concatenate([[True], numbers[1:] != numbers[:-1]]) | np.concatenate([numbers[1:] != numbers[:-1], [True]])
    return rows[ends]


def swing_the_axis(problem: BenchmarkProblem, rows: Array) -> Array:
    """The axis differs from pass to pass where one axis is asked for."""
    swung = rows.copy()
    lean = np.radians(0.5) * (rows[:, 0] % 2)
    swung[:, 4:7] += np.stack([lean, 0 * lean, 0 * lean], axis=-1)
    swung[:, 4:7] /= np.linalg.norm(swung[:, 4:7], axis=1, keepdims=True)
    return swung


#: Problem, what is done to a good entry of it, and words that must stand in the reason.
BAD: tuple[tuple[str, Spoil, str], ...] = (
    ("fixed-axis-dish", leave_out_passes, "times the scallop limit"),
    ("passes-dish", sink_a_pass, "gouge"),
    ("fixed-axis-plane", sink_one_point, "gouge"),
    ("fixed-axis-wall", lean_into_the_wall, "needed"),
    ("passes-tube", skip_between_points, "gouge"),
    ("fixed-axis-oval", swing_the_axis, "axes: one is allowed"))


def good_rows(problem: BenchmarkProblem) -> Array:
    """A good entry as rows of pass, tip and axis, (n, 7), iso-parametric passes with the best axis.

    Parameters
    ----------
    problem : BenchmarkProblem
    """
    around = ta.Part.from_faces(problem.obstacles) if problem.obstacles else None
    given = None if problem.axis is None else [ta.SubSurface(1, axis=problem.axis, locked=True)]
    plan = ta.plan(problem.part, problem.tools[0], problem.scallop, tolerance=problem.tolerance, workers=1,
                   obstacles=around, limits=problem.limits or None, division=given)
    path = plan.operations[0].path
    if path is None:
        raise ta.InvalidInput(f"{problem.name}: {plan.operations[0].orientation.reasons[0]}")
    cut = np.asarray(path.kind == Motion.CUT)
    rows = np.flatnonzero(cut | np.append(cut[1:], False))
    number = np.cumsum(~cut[rows])
    return np.column_stack([number, path.cl[rows], path.axis[rows]])


def write_rows(path: Path, rows: Array) -> None:
    """Write rows of pass, tip and axis as an entry.

    Parameters
    ----------
    path : Path
    rows : (n, 7) array
    """
    starts = np.concatenate([[True], rows[1:, 0] != rows[:-1, 0]])
    kind = np.where(starts, int(Motion.LINK), int(Motion.CUT)).astype(np.int8)
    ends = np.append(np.flatnonzero(starts), len(rows))
    write_entry(path, [(0, ToolPath(rows[:, 1:4], rows[:, 1:4], rows[:, 4:7], rows[:, 4:7], kind, ends))])


def score_bad_entries(folder: Path, workers: int) -> int:
    """Make all bad entries and score them: 0 where each scores nothing for the reason that is expected, else 1.

    Parameters
    ----------
    folder : Path
    workers : int
        Processes.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for path in folder.glob("*.csv"):
        path.unlink()
    for name, spoil, _ in BAD:
        write_rows(folder / f"{name}.csv", spoil(problem_named(name), good_rows(problem_named(name))))
    print("\nbad entries: each must score 0")
    found = {one.problem: one for one in score_folder(folder, workers)}
    expected = {name: words for name, _, words in BAD}
    wrong = [name for name, _, words in BAD if found[name].score > 0 or words not in found[name].reason]
    for name in wrong:
        print(f"{name} should have failed with {expected[name]!r}", file=sys.stderr)
    return int(bool(wrong))


