"""Rows divided into parts."""

import numpy as np
import pytest

from toolaxis.numeric.parts import number_parts


@pytest.mark.parametrize("counts", [[], [0], [1], [2, 0, 3], [0, 0, 1, 5, 0]])
def test_parts_are_numbered_row_by_row(counts: list[int]) -> None:
    row, number = number_parts(np.array(counts, dtype=np.int64))
    expected = [(k, part) for k, count in enumerate(counts) for part in range(count)]
    assert list(zip(row.tolist(), number.tolist(), strict=True)) == expected
