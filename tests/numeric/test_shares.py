"""Rows worked on in shares, on the cores that are free."""

import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest

from toolaxis.numeric import shares
from toolaxis.numeric.shares import free_cores, share_out, use_cores


def rows_done(count: int, size: int, threads: int | None) -> tuple[np.ndarray, list[slice]]:
    """How often each row was worked on, and the shares in the order in which they were handed on."""
    done = np.zeros(count, dtype=int)

    def work(room: list[int], some: slice) -> None:
        room.append(some.start)
        time.sleep(0.001 * (some.start % 3))
        done[some] += 1

    return done, list(share_out(work, list, count, size, threads))


@pytest.mark.parametrize("threads", [1, 2, 5])
@pytest.mark.parametrize("count", [0, 1, 7, 8, 50])
def test_every_row_is_worked_on_once_and_shares_are_told_in_their_order(count: int, threads: int) -> None:
    done, told = rows_done(count, 4, threads)
    assert (done == 1).all()
    assert told == rows_done(count, 4, 1)[1]
    assert [some.stop for some in told[:-1]] == [some.start for some in told[1:]]


def test_no_room_is_in_two_threads_at_once() -> None:
    used: list[SimpleNamespace] = []

    def prepare() -> SimpleNamespace:
        used.append(SimpleNamespace(free=threading.Lock(), times=0))
        return used[-1]

    def work(room: SimpleNamespace, some: slice) -> None:
        assert room.free.acquire(blocking=False)
        time.sleep(0.002)
        room.times += 1
        room.free.release()

    assert len(list(share_out(work, prepare, 60, 2, 3))) == 30
    assert len(used) <= 3 and sum(room.times for room in used) == 30 and used[1].times > 1


def test_what_goes_wrong_in_a_share_is_raised() -> None:
    def work(_: None, some: slice) -> None:
        if some.start == 24:
            raise ZeroDivisionError("24")

    with pytest.raises(ZeroDivisionError, match="24"):
        list(share_out(work, lambda: None, 100, 4, 2))


def test_a_caller_who_stops_leaves_what_was_not_begun() -> None:
    begun, threads = [], threading.active_count()

    def work(_: None, some: slice) -> None:
        begun.append(some.start)
        time.sleep(0.002)

    for some in share_out(work, lambda: None, 1000, 1, 2):
        if some.start == 5:
            break
    assert len(begun) < 100
    assert threads == threading.active_count()


def test_the_first_share_is_done_before_there_are_threads() -> None:
    seen = []

    def work(_: None, some: slice) -> None:
        seen.append((some.start, threading.current_thread() is threading.main_thread()))

    list(share_out(work, lambda: None, 40, 4, 2))
    assert seen[0] == (0, True) and not any(here for _, here in seen[1:])


def test_few_shares_are_not_worth_a_thread() -> None:
    seen = []
    with use_cores(8):
        list(share_out(lambda _, some: seen.append(threading.current_thread()), lambda: None, 3, 1))
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

    def work(_: None, some: slice) -> None:
        here = threading.current_thread()
        list(share_out(lambda _, part: inner.append(threading.current_thread() is here), lambda: None, 20, 1))

    with use_cores(2):
        list(share_out(work, lambda: None, 6, 1))
    assert len(inner) == 120 and all(inner[20:])
