"""An entry: tips and axes that somebody claims machine a problem, read from a table or an APT CL file.

Nothing in it is believed but tips, axes and which tool cuts.  Rows with a pass above zero cut; rows of pass 0 are
moves between passes: they remove nothing and must neither gouge nor collide.  Where two passes follow each other
without such rows, the tool is drawn back along its axis, taken across above the part, and lowered.
"""

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from axisbench.problem import MOVING, BenchmarkProblem
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.job.files.read_cl import read_cl
from toolaxis.numeric.vectors import angle_between, unit

Array = NDArray[np.float64]

COLUMNS = ("pass", "x", "y", "z", "i", "j", "k")
#: What the table of a whole part has before these: number of the tool in the problem's list, from 1.
TOOL_COLUMN = "tool"
#: By how much the length of an axis may miss 1.
UNIT = 1e-4
#: By how much the axis may turn from one row of a pass to the next, degrees: between rows it is interpolated.
MOST_TURN = 5.0
#: Axes that differ by less than this are one orientation, rad: CL files have nine digits.
SAME_AXIS = 1e-6
#: Tips lie no farther from the origin, mm.
FARTHEST = 1e4
#: Rows at most.
MOST_ROWS = 300_000
#: How far above everything the tool is taken across, mm, and how far it may turn on one of the steps there, rad.
_ABOVE, _STEP = 15.0, 0.2


class BadEntry(InvalidInput):
    """An entry that cannot be judged; the message names quantity, value, row, rule and remedy."""


@dataclass(frozen=True, eq=False)
class CutterEntry:
    """The cutter locations of one tool.

    Attributes
    ----------
    tool : int
        Index into the problem's tools.
    tips, axes : (n, 3) array
        mm, and unit vectors.
    kind : (n,) array of int8
        `Motion` that arrives at each point: CUT or LINK.
    """

    tool: int
    tips: Array
    axes: Array
    kind: NDArray[np.int8]

    @property
    def path(self) -> ToolPath:
        """The same as a `ToolPath` without contacts."""
        return ToolPath(self.tips, self.tips, self.axes, self.axes, self.kind, np.array([0, len(self.tips)]))

    @property
    def passes(self) -> int:
        """Number of passes: runs of cuts."""
        cut = np.concatenate([[False], self.kind == Motion.CUT])
        return int((cut[1:] & ~cut[:-1]).sum())

    @property
    def cutting_axes(self) -> Array:
        """Axes at all ends of cuts, (m, 3)."""
        ends = self.kind == Motion.CUT
        return np.asarray(self.axes[ends | np.append(ends[1:], False)])


def read_entry(path: Path, problem: BenchmarkProblem) -> tuple[CutterEntry, ...]:
    """The cutter locations of an entry, those of each tool in the order in which they are used.

    Parameters
    ----------
    path : Path
        A table (.csv), or an APT CL file (.apt, .cls) of a problem with one tool.
    problem : BenchmarkProblem

    Raises
    ------
    BadEntry
        When the file cannot be read, or a row breaks a rule.
    """
    if path.suffix == ".csv":
        tool, group, rows = _read_table(path, problem)
    else:
        tool, group, rows = _read_apt(path, problem)
    _check_rows(path, rows, group)
    starts = [0, *(np.flatnonzero(np.diff(tool)) + 1), len(tool)]
    for a, b in pairwise(starts):
        if not ((group[a + 1:b] == group[a:b - 1]) & (group[a + 1:b] > 0)).any():
            raise BadEntry(f"{path.name} row {a + 1}: no pass begins here; a pass needs two rows or more with the same "
                           "number from 1")
    return tuple(_make_entry(path, problem, int(tool[a]), group[a:b], rows[a:b])
                 for a, b in pairwise(starts))


def _read_table(path: Path, problem: BenchmarkProblem) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    """Tool index and pass of every row, and tips with axes, (n, 6)."""
    columns = (TOOL_COLUMN, *COLUMNS) if problem.is_part else COLUMNS
    try:
        with path.open(newline="", encoding="utf-8") as file:
            lines = [line for line in csv.reader(file) if line]
    except (OSError, UnicodeDecodeError, csv.Error) as reason:
        raise BadEntry(f"{path.name} cannot be read ({reason}): give a comma-separated table in UTF-8") from reason
    if not lines or [word.strip() for word in lines[0]] != list(columns):
        first = ",".join(lines[0])[:60] if lines else "nothing"
        raise BadEntry(f"{path.name} begins with {first!r}: its first line must be {','.join(columns)}")
    lines = lines[1:]
    if len(lines) < 2:
        raise BadEntry(f"{path.name} has {len(lines)} rows: at least two make a pass; write one row for each tip")
    if len(lines) > MOST_ROWS:
        raise BadEntry(f"{path.name} has {len(lines)} rows: at most {MOST_ROWS} are judged; use a coarser chord "
                       "tolerance")
    table = np.empty((len(lines), len(columns)))
    for k, line in enumerate(lines):
        if len(line) != len(columns):
            raise BadEntry(f"{path.name} row {k + 1} has {len(line)} columns: {len(columns)} are needed, "
                           f"{','.join(columns)}")
        try:
            table[k] = [float(word) for word in line]
        except ValueError as reason:
            raise BadEntry(f"{path.name} row {k + 1} is {','.join(line)!r}: every column must be a number") from reason
        if not np.isfinite(table[k]).all():
            raise BadEntry(f"{path.name} row {k + 1} is {','.join(line)!r}: every number must be finite")
    group = _whole_numbers(path, table[:, -7], "pass", (0, MOST_ROWS))
    if not problem.is_part:
        return np.zeros(len(table), dtype=np.int64), group, table[:, -6:]
    return _whole_numbers(path, table[:, 0], TOOL_COLUMN, (1, len(problem.tools))) - 1, group, table[:, -6:]


def _whole_numbers(path: Path, values: Array, name: str, limits: tuple[int, int]) -> NDArray[np.int64]:
    wrong = np.flatnonzero((values != np.round(values)) | (values < limits[0]) | (values > limits[1]))
    if wrong.size:
        raise BadEntry(f"{path.name} row {wrong[0] + 1}: {name} is {values[wrong[0]]:g}; it must be a whole number "
                       f"from {limits[0]} to {limits[1]}")
    return values.astype(np.int64)


def _read_apt(path: Path, problem: BenchmarkProblem) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    """The same from an APT CL file: a pass is a run of motions that are not rapid."""
    if problem.is_part:
        raise BadEntry(f"{path.name}: a whole part needs to know which tool cuts; write {problem.name}.csv with a "
                       "column for the tool")
    try:
        found = read_cl(path)
    except InvalidInput as reason:
        raise BadEntry(str(reason)) from reason
    group = _pass_numbers(found.kind, 0)
    return np.zeros(len(group), dtype=np.int64), group, np.hstack([found.tip, found.axis])


def _check_rows(path: Path, rows: Array, group: NDArray[np.int64]) -> None:
    """Refuse axes that are no unit vectors, and axes that turn too far from one row of a pass to the next."""
    length = np.linalg.norm(rows[:, 3:], axis=1)
    wrong = np.flatnonzero(np.abs(length - 1) > UNIT)
    if wrong.size:
        raise BadEntry(f"{path.name} row {wrong[0] + 1}: the axis is {length[wrong[0]]:.6g} long; i,j,k must be a unit "
                       f"vector to {UNIT:g}, from the tip to the spindle")
    far = np.abs(rows[:, :3]).max(axis=1)
    wrong = np.flatnonzero(far > FARTHEST)
    if wrong.size:
        raise BadEntry(f"{path.name} row {wrong[0] + 1}: the tip is {far[wrong[0]]:.6g} mm away; at most {FARTHEST:g} "
                       "mm are judged: x,y,z must be mm in the coordinates of the face")
    turned = np.degrees(angle_between(unit(rows[1:, 3:]), unit(rows[:-1, 3:])))
    wrong = np.flatnonzero((turned > MOST_TURN) & (group[1:] == group[:-1]) & (group[1:] > 0))
    if wrong.size:
        raise BadEntry(f"{path.name} row {wrong[0] + 2}: the axis turns by {turned[wrong[0]]:.3g} deg from the row "
                       f"before; within a pass at most {MOST_TURN:g} deg are allowed: put rows between")


def _make_entry(path: Path, problem: BenchmarkProblem, tool: int, group: NDArray[np.int64],
                rows: Array) -> CutterEntry:
    """Cutter locations with moves between passes where the file has none."""
    tips, axes = rows[:, :3], np.asarray(unit(rows[:, 3:]))
    if problem.task not in MOVING:
        same = (group[1:] == group[:-1]) & (group[1:] > 0)
        turned = np.flatnonzero((angle_between(axes[1:], axes[:-1]) > SAME_AXIS) & same)
        if turned.size:
            raise BadEntry(f"{path.name} row {turned[0] + 2}: the axis turns within pass {group[turned[0] + 1]}; the "
                           f"task {problem.task!r} needs a fixed axis in each pass")
    pieces: list[tuple[Array, Array, Array]] = []
    high = _Above(problem)
    for k in range(len(group)):
        again = k and group[k] == group[k - 1] and group[k] > 0
        if k and not again and group[k] > 0 and group[k - 1] > 0:
            between = high.between((tips[k - 1], axes[k - 1]), (tips[k], axes[k]))
            pieces.append((*between, np.full(len(between[0]), int(Motion.LINK))))
        pieces.append((tips[k:k + 1], axes[k:k + 1], np.array([int(Motion.CUT if again else Motion.LINK)])))
    table = [np.concatenate(column) for column in zip(*pieces, strict=True)]
    return CutterEntry(tool, table[0], table[1], table[2].astype(np.int8))


class _Above:
    """Where the tool is clear of everything: beyond a ball around the faces, along its axis."""

    def __init__(self, problem: BenchmarkProblem) -> None:
        boxes = np.array([face.box for face in (*problem.part.faces, *problem.obstacles)])
        low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
        self._centre, self._radius = (low + high) / 2, float(np.linalg.norm(high - low)) / 2 + _ABOVE

    def between(self, first: tuple[Array, Array], last: tuple[Array, Array]) -> tuple[Array, Array]:
        """Tips and axes of a way from one place to another."""
        tips, axes = [self._drawn_back(*first)], [first[1]]
        angle = float(angle_between(first[1], last[1]))
        if angle > SAME_AXIS:
            count = int(np.ceil(angle / _STEP)) + 1
            for share in np.linspace(0.0, 1.0, count + 1):
                axis = _between(first[1], last[1], float(share))
                tips.append(self._centre + self._radius / np.cos(_STEP) * axis)
                axes.append(axis)
        tips.append(self._drawn_back(*last))
        axes.append(last[1])
        return np.array(tips), np.array(axes)

    def _drawn_back(self, tip: Array, axis: Array) -> Array:
        height = float((tip - self._centre) @ axis)
        return np.asarray(tip + max(self._radius - height, 0.0) * axis)


def _between(first: Array, last: Array, share: float) -> Array:
    """The axis at a share of the shortest turn from one to another; opposite ones turn about any direction across."""
    across = last - (last @ first) * first
    if np.linalg.norm(across) < 1e-9:
        across = np.cross(first, np.eye(3)[int(np.argmin(np.abs(first)))])
    across = across / np.linalg.norm(across)
    angle = share * float(angle_between(first, last))
    return np.asarray(np.cos(angle) * first + np.sin(angle) * across)


def write_entry(path: Path, paths: Sequence[tuple[int, ToolPath]], whole_part: bool = False) -> None:
    """Write tool paths as a table that `read_entry` reads back.

    Parameters
    ----------
    path : Path
    paths : sequence of (int, ToolPath)
        Index of the tool, and what it does; in the order in which they are carried out.
    whole_part : bool
        Whether the table has a column for the tool.
    """
    lines = [",".join((TOOL_COLUMN, *COLUMNS) if whole_part else COLUMNS)]
    number = 0
    for tool, one in paths:
        groups = _pass_numbers(one.kind, number)
        number = int(groups.max())
        cutting = np.flatnonzero(groups)  # how tools come and go is up to the scoring program
        for k in range(cutting[0], cutting[-1] + 1) if len(cutting) else ():
            words = [*(f"{value:.6f}" for value in one.cl[k]), *(f"{value:.9f}" for value in one.axis[k])]
            lead = [str(tool + 1)] if whole_part else []
            lines.append(",".join([*lead, str(groups[k]), *words]))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _pass_numbers(kind: NDArray[np.int8], last: int) -> NDArray[np.int64]:
    """The pass of each point, counted on from the last one; 0 on links, entries and exits, which remove nothing."""
    linked = np.asarray(kind != Motion.CUT)
    linked[0] = True
    starts = linked & np.append(~linked[1:], False)
    return np.where(linked & ~starts, 0, last + np.cumsum(starts))
