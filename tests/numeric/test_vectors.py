"""Rows of vectors: exact cases, seams and refusals."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import angle_between, as_rows, dot, lengths, perpendicular, rotation, unit

numbers = st.floats(-1e6, 1e6)


@given(st.tuples(numbers, numbers, numbers).filter(lambda v: np.linalg.norm(v) > 1e-3))
def test_frames_are_right_handed(axis: tuple[float, float, float]) -> None:
    x, y = perpendicular(axis)
    frame = np.array([x, y, unit(axis)])
    assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(frame) == pytest.approx(1.0)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-4, 1.0, np.pi / 2, np.pi - 1e-9, np.pi])
def test_angles_are_sharp_at_both_ends(angle: float) -> None:
    a, b = np.array([[1.0, 0, 0]]), np.array([[np.cos(angle), np.sin(angle), 0]])
    assert angle_between(a, b)[0] == pytest.approx(angle, rel=1e-7, abs=1e-15)


@given(st.floats(-10, 10), st.floats(-10, 10))
def test_rotations_add_up(first: float, second: float) -> None:
    axis = [1.0, -2.0, 0.5]
    assert rotation(axis, first) @ rotation(axis, second) == pytest.approx(rotation(axis, first + second), abs=1e-12)
    assert rotation(axis, first) @ unit(axis) == pytest.approx(unit(axis))


def test_rotation_is_right_handed() -> None:
    assert rotation([0, 0, 3], np.pi / 2) @ [1, 0, 0] == pytest.approx([0, 1, 0])


def test_dot_runs_along_rows() -> None:
    assert dot(np.array([[1.0, 2, 3], [0, 1, 0]]), np.array([[4.0, 5, 6], [7, 8, 9]])).tolist() == [32.0, 8.0]


@pytest.mark.parametrize("vector", [[0, 0, 0], [np.nan, 0, 1], [np.inf, 0, 0], [[1, 0, 0], [0, 0, 0]]])
def test_no_direction(vector: list[float]) -> None:
    with pytest.raises(InvalidInput, match="has no direction: its length must be finite and above zero"):
        unit(vector)


def test_rows() -> None:
    assert as_rows([1, 2], 2, "point").shape == (1, 2)
    with pytest.raises(InvalidInput, match=r"point has shape \(3,\): rows of 2 numbers are needed"):
        as_rows([1, 2, 3], 2, "point")
    with pytest.raises(InvalidInput, match=r"point row 1 is \[3.0, nan\]: every number must be finite"):
        as_rows([[1, 2], [3, np.nan]], 2, "point")


@pytest.mark.parametrize("columns", [1, 2, 3, 6])
def test_lengths_are_numpys_to_the_last_digit(columns: int) -> None:
    """Plans came out of numpy's norm before, and stay what they were."""
    rng = np.random.default_rng(columns)
    rows = rng.normal(size=(5000, columns)) * 10.0 ** rng.integers(-6, 6, size=(5000, columns))
    for some in (rows, rows[::3], np.asfortranarray(rows), rows.reshape(50, 100, columns), rows[:0], 0 * rows[:2]):
        np.testing.assert_array_equal(lengths(some), np.linalg.norm(some, axis=-1))
    assert np.isnan(lengths(np.array([[np.nan] * columns]))).all()
