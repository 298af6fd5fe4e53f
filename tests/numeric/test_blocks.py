"""Rows some at a time: the same numbers, and never more rows than asked for."""

import numpy as np

from toolaxis.numeric.blocks import in_blocks


def test_blocks_make_what_the_whole_makes_and_keep_their_size():
    a, b, seen = np.arange(23.0), np.arange(46.0).reshape(23, 2), []

    def function(first, second):
        seen.append(len(first))
        return first[:, None] * second

    assert (in_blocks(function, a, b, size=5) == a[:, None] * b).all()
    assert seen == [5, 5, 5, 5, 3]


def test_few_rows_and_none_are_taken_in_one_piece():
    seen = []
    for count in (0, 4):
        assert len(in_blocks(lambda rows: seen.append(len(rows)) or rows, np.zeros(count), size=4)) == count
    assert seen == [0, 4]
