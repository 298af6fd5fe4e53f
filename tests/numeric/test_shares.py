"""Rows worked on in shares, on the cores that are free."""

import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest

from toolaxis.errors import Cancelled
from toolaxis.numeric import shares
from toolaxis.numeric.shares import free_cores, share_out, use_cores, work_on_rows
from toolaxis.progress import Progress, activate_progress


def rows_done(count: int, size: int, threads: int | None) -> tuple[np.ndarray, list[slice]]:
    """How often each row was worked on, and the shares in the order in which they were handed on."""
    done = np.zeros(count, dtype=int)

    def work(some: slice) -> None:
        time.sleep(0.001 * (some.start % 3))
        done[some] += 1

    return done, list(share_out(work, count, size, threads))


@pytest.mark.parametrize("threads", [1, 2, 5])
@pytest.mark.parametrize("count", [0, 1, 7, 8, 50])
def test_every_row_is_worked_on_once_and_shares_are_told_in_their_order(count: int, threads: int) -> None:
    done, told = rows_done(count, 4, threads)
    assert (done == 1).all()
    assert told == rows_done(count, 4, 1)[1]
    assert [some.stop for some in told[:-1]] == [some.start for some in told[1:]]


def test_as_many_threads_as_are_asked_for_work_at_once() -> None:
    together = threading.Barrier(3, timeout=20)

    def work(some: slice) -> None:
        if some.start in (1, 2, 3):  # the first share is done before
            together.wait()

    assert len(list(share_out(work, 10, 1, 3))) == 10


def test_rows_are_worked_on_to_the_end_unless_the_user_stops_it() -> None:
    done = np.zeros(40, dtype=int)

    def work(some: slice) -> None:
        done[some] += 1

    with use_cores(2):
        work_on_rows(work, 40, 4)
    assert (done == 1).all()
    asked = iter(range(3))
    with use_cores(1), activate_progress(Progress(None, lambda: next(asked, None) is None)), pytest.raises(Cancelled):
        work_on_rows(work, 40, 4)
    assert (done == np.repeat([2, 1], [16, 24])).all()


def test_what_goes_wrong_in_a_share_is_raised() -> None:
    def work(some: slice) -> None:
        if some.start == 24:
            raise ZeroDivisionError("24")

    with pytest.raises(ZeroDivisionError, match="24"):
        list(share_out(work, 100, 4, 2))


def test_a_caller_who_stops_leaves_what_was_not_begun() -> None:
    begun, threads = [], threading.active_count()

    def work(some: slice) -> None:
        begun.append(some.start)
        time.sleep(0.002)

    for some in share_out(work, 1000, 1, 2):
        if some.start == 5:
            break
    assert len(begun) < 100
    assert threads == threading.active_count()


def test_the_first_share_is_done_before_there_are_threads() -> None:
    seen = []

    def work(some: slice) -> None:
        seen.append((some.start, threading.current_thread() is threading.main_thread()))

    list(share_out(work, 40, 4, 2))
    assert seen[0] == (0, True) and not any(here for _, here in seen[1:])


def test_few_shares_are_not_worth_a_thread() -> None:
    seen = []
    with use_cores(8):
        list(share_out(lambda some: seen.append(threading.current_thread()), 3, 1))
    assert seen == [threading.main_thread()] * 3


def test_processes_that_work_side_by_side_share_the_cores(monkeypatch) -> None:
    monkeypatch.setattr(shares, "count_cores", lambda: 6)
    busy = SimpleNamespace(value=0)
    assert free_cores() == 6
    with use_cores(4, busy):
        found = []
        for busy.value in range(6):
            found.append(free_cores())
        assert found == [4, 4, 2, 1, 1, 1]
        with use_cores(None):
            assert free_cores() == 1
        with use_cores(3):
            assert free_cores() == 3
    assert free_cores() == 6


def test_what_is_shared_out_within_a_share_stays_in_its_thread() -> None:
    inner = []

    def work(some: slice) -> None:
        here = threading.current_thread()
        list(share_out(lambda part: inner.append(threading.current_thread() is here), 20, 1))

    with use_cores(2):
        list(share_out(work, 6, 1))
    assert len(inner) == 120 and all(inner[20:])
