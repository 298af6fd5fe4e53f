"""Times that remain: "about 973052217094630 s left" was said of a face, and minutes fell to 0 with nothing done."""

import re
from itertools import pairwise

import pytest

from toolaxis.cli import display
from toolaxis.progress import Remaining


def test_next_to_nothing_done_is_no_basis():
    left = Remaining()
    left.hear("passes", 1e-17, 1.0, 0.0)
    left.hear("passes", 3e-15, 1.0, 9.0)
    assert left.left(9.0) is None


def test_an_amount_that_grows_tells_nothing():
    """The search reported the axes so far of those that it would look at next."""
    left = Remaining()
    for k in range(1, 40):
        left.hear("axes", 60.0 * k, 60.0 * k + 6.0, 2.0 * k)
        assert left.left(2.0 * k) is None


def test_pieces_side_by_side_are_no_basis_before_one_is_finished():
    left = Remaining()
    for tick in range(200):
        left.hear(f"face {tick % 2 + 1} ({tick % 2 + 1} of 9): axes", 0.0, 0.0, 0.1 * tick)
        assert left.left(0.1 * tick) is None


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_pieces_that_take_the_same_are_told_rightly(workers):
    """Twelve pieces of 30 s each, so many at a time."""
    left = Remaining()
    for second in range(30 * 12 // workers):
        for k in range(workers):
            number = second // 30 * workers + k + 1
            left.hear(f"face {number} ({number} of 12): axes", 0.0, 0.0, second + 0.01 * k)
        found = left.left(second + 0.1)
        if second < 30:
            assert found is None
        else:
            assert found.of_all
            assert found.seconds == pytest.approx(30 * 12 / workers - second, abs=30)


def test_it_does_not_fall_to_zero_with_nothing_done():
    """Two faces of five took 10 s each, the third takes minutes."""
    left, told = Remaining(), []
    for second in range(300):
        number = min(second // 10, 2) + 1
        left.hear(f"face {number} ({number} of 5): proof", 0.0, 0.0, float(second))
        found = left.left(float(second))
        told.append(None if found is None else found.seconds)
    assert told[9] is None and told[20] == pytest.approx(30)
    assert min(told[20:]) >= 20
    assert max(abs(b - a) for a, b in pairwise(told[21:])) <= 1


def test_of_a_last_piece_that_takes_longer_nothing_is_known():
    left = Remaining()
    left.hear("face 1 (1 of 2): axes", 0.0, 0.0, 0.0)
    left.hear("face 2 (2 of 2): axes", 0.0, 0.0, 10.0)
    assert left.left(15.0).seconds == pytest.approx(5)
    assert left.left(21.0) is None


def test_lines_of_a_search_hold_no_absurd_time(capsys, monkeypatch):
    """What was reported by the face of which that was said: steps that begin again, some after next to nothing."""
    clock = iter(range(0, 100_000, 7))
    monkeypatch.setattr(display.time, "monotonic", lambda: float(next(clock)))
    with display.show_progress(lambda: False) as progress:
        inner = progress.within("face 4 (1 of 1)")
        for count in range(64, 1400, 64):
            inner.report("axes", count, 0)
        for _ in range(4):
            for done in (-0.0, 4e-16, 9e-15, 0.06, 0.2, 0.7, 1.0):
                inner.report("passes", done, 1.0)
    said = capsys.readouterr().err
    assert "face 4 (1 of 1): axes\n" in said and "passes: 70 %, about 15 s left" in said
    assert all(int(number) < 100 for number in re.findall(r"about (\d+) s left", said))
    assert not re.search(r"axes: \d+ %", said)
