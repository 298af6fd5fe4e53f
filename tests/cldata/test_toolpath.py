"""Tool paths: lengths by kind of motion, passes, and refusals."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput


def path() -> ToolPath:
    cl = np.array([[0.0, 0, 10], [0, 0, 0], [3, 4, 0], [3, 4, 10], [0, 4, 10], [0, 4, 2]])
    kind = np.array([Motion.LINK, Motion.ENTRY, Motion.CUT, Motion.EXIT, Motion.LINK, Motion.ENTRY], dtype=np.int8)
    up = np.tile([0.0, 0.0, 1.0], (6, 1))
    return ToolPath(cl.copy(), cl, up, up, kind, np.array([0, 4, 6]))


def test_lengths_and_passes() -> None:
    assert path().passes == 2
    assert path().length() == 10 + 5 + 10 + 3 + 8
    assert path().length(Motion.CUT) == 5 and path().length(Motion.ENTRY) == 18
    assert path().length(Motion.ENTRY, Motion.EXIT) == 28


def test_lengths_follow_scale_and_shift() -> None:
    moved = replace(path(), cl=2 * path().cl + [1, 2, 3])
    assert moved.length(Motion.CUT) == 2 * path().length(Motion.CUT)


def test_the_empty_path() -> None:
    rows = np.empty((0, 3))
    empty = ToolPath(rows, rows, rows, rows, np.empty(0, dtype=np.int8), np.array([0]))
    assert empty.passes == 0 and empty.length() == 0.0 and empty.length(Motion.CUT) == 0.0


@pytest.mark.parametrize("change, said", [
    ({"cc": np.zeros((5, 3))}, r"tool path cc has shape \(5, 3\): \(6, 3\) is needed"),
    ({"axis": np.full((6, 3), np.nan)}, r"tool path axis row 0 is \[nan, nan, nan\]: it must be finite"),
    ({"kind": np.zeros(5, dtype=np.int8)}, r"tool path kind has shape \(5,\)"),
    ({"breaks": np.array([0, 5])}, "tool path breaks must run from 0 to 6"),
    ({"breaks": np.array([0, 4, 3, 6])}, "without decreasing"),
    ({"breaks": np.array([], dtype=int)}, "tool path breaks"),
    ({"kind": np.full(6, 9, dtype=np.int8)}, "tool path kind 0 is 9: 0 cut, 1 entry, 2 exit or 3 link is needed"),
    ({"axis": np.tile([0, 0, 2.0], (6, 1))}, "tool path axis row 0 has length 2.0: unit vectors are needed"),
])
def test_refusals(change: dict[str, np.ndarray], said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        replace(path(), **change)


def test_links_are_rapid_along_their_own_axis_and_never_while_it_turns() -> None:
    lean = np.array([[0.6, 0.0, 0.8], [-0.6, 0.0, 0.8]])
    axis = lean[[0, 0, 0, 0, 1, 1]]
    cl = np.array([[6.0, 0, 8], [0, 0, 0], [1, 0, 0], [7, 0, 8], [-5, 0, 8], [1.0, 0, 0]])
    path = ToolPath(cl, cl, axis, axis, np.array([3, 3, 0, 3, 3, 3]), np.array([0, 6]))
    assert path.rapid.tolist() == [True, True, False, True, False, True]


def test_a_link_high_above_is_not_rapid_where_the_axis_turns() -> None:
    axis = np.array([[0.6, 0.0, 0.8], [-0.6, 0.0, 0.8]])[[0, 0, 0, 1, 1, 1]]
    cl = np.array([[6.0, 0, 8], [0, 0, 0], [6, 0, 8], [-6, 0, 8], [0, 0, 0], [-6, 0, 8]])
    path = ToolPath(cl, cl, axis, axis, np.full(6, Motion.LINK), np.array([0, 6]))
    assert path.rapid.tolist() == [True, True, True, False, True, True]
