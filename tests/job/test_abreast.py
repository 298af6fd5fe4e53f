"""Pieces of work on several processes: same results, one stop, a loss of one piece only, no debris."""

import ctypes
import os
import signal
import time

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import REPORT_AT, Cancelled, InvalidInput
from toolaxis.job.planning.parallel import abreast, check_workers, how_it_ended
from toolaxis.numeric.shares import free_cores
from toolaxis.progress import NO_PROGRESS, Progress, activate_progress, breathe

several = pytest.mark.skipif(check_workers(2) == 1, reason="processes are only forked on Linux")


@several
def test_results_come_in_order_whatever_finishes_first():
    def _work(index, _progress):
        time.sleep(0.05 * (index == 0))
        return index, os.getpid()

    found = abreast(_work, 7, 3, NO_PROGRESS)
    assert list(found.results) == list(range(7))
    assert [index for index, _ in found.results.values()] == list(range(7))
    assert not found.cancelled and not found.faults
    assert os.getpid() not in {pid for _, pid in found.results.values()}


@several
def test_reports_reach_the_parent():
    heard = []

    def _work(index, progress):
        progress.report(f"piece {index}", 1, 2)

    abreast(_work, 4, 2, Progress(lambda *what: heard.append(what)))
    assert sorted(heard) == [(f"piece {k}", 1, 2) for k in range(4)]


@several
def test_the_last_process_has_the_cores_of_those_that_are_done():
    def _work(index, _progress):
        until = time.monotonic() + 20
        while free_cores() != (2 if index == 2 else 1) and time.monotonic() < until:
            time.sleep(0.01)
        return free_cores()

    assert list(abreast(_work, 3, 2, NO_PROGRESS).results.values()) == [1, 1, 2]


@several
def test_a_stop_keeps_what_is_finished_and_ends_the_others():
    finished, started = [], time.monotonic()

    def _work(index, progress):
        progress.report(f"piece {index}", 0, 1)
        if index > 1:
            time.sleep(60)
        progress.report(f"piece {index} done", 1, 1)
        return index

    progress = Progress(lambda stage, *_: finished.append(stage) if stage.endswith("done") else None,
                        lambda: len(finished) == 2)
    found = abreast(_work, 5, 2, progress)
    assert found.cancelled
    assert set(found.results) <= {0, 1}
    assert time.monotonic() - started < 30


@several
def test_a_stop_keeps_what_was_finished_and_not_heard_yet():
    """The stop comes from a report; the results that lie in the pipes by then count."""
    def _work(index, progress):
        if index < 2:
            return index
        progress.report("third", 0, 1)
        time.sleep(60)

    def _told(*_):
        time.sleep(0.5)  # meanwhile the other process is finished
        raise Cancelled("cancelled by the user")

    for _ in range(5):
        found = abreast(_work, 3, 2, Progress(_told))
        assert found.cancelled and found.results == {0: 0, 1: 1} and not found.faults


@pytest.mark.parametrize("workers", [1, pytest.param(2, marks=several)])
@pytest.mark.parametrize("wrong, said", [
    (AssertionError("odd"), "failed: AssertionError: odd, at test_abreast.py:"),
    (MemoryError(), "failed: out of memory"),
    (InvalidInput("this piece is wrong"), "failed: this piece is wrong"), (IndexError(), "failed: IndexError, at ")])
def test_what_a_piece_raises_is_told_of_it_alone(workers, wrong, said):
    def _work(index, _progress):
        if index == 1:
            raise wrong
        return index

    found = abreast(_work, 4, workers, NO_PROGRESS)
    assert found.results == {0: 0, 2: 2, 3: 3} and not found.cancelled
    (fault,) = found.faults.values()
    assert list(found.faults) == [1] and fault.sentence.startswith(said)
    assert ("please report it" in fault.sentence and REPORT_AT in fault.sentence) != isinstance(wrong, InvalidInput)
    assert "Traceback" in fault.traceback and "in _work" in fault.traceback


@several
def test_what_cannot_be_carried_over_is_told_in_words():
    class Local(Exception):
        pass

    def _work(index, _progress):
        if index == 0:
            raise Local("no home")
        if index == 1:
            return lambda: None
        return index

    found = abreast(_work, 3, 2, NO_PROGRESS)
    assert found.results == {2: 2}
    assert "Local: no home" in found.faults[0].sentence and "pickle" in found.faults[1].sentence


@several
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSEGV, signal.SIGTERM])
def test_a_process_that_dies_costs_its_piece_alone(number):
    def _work(index, _progress):
        if index in (1, 4):
            signal.signal(number, signal.SIG_DFL) if number == signal.SIGTERM else None
            os.kill(os.getpid(), number)
        return index

    found = abreast(_work, 6, 2, NO_PROGRESS)
    assert found.results == {k: k for k in (0, 2, 3, 5)} and not found.cancelled
    assert list(found.faults) == [1, 4]
    assert all(number.name in fault.sentence and "fewer workers" in fault.sentence for fault in found.faults.values())


@several
def test_a_crash_tells_where_it_stood():
    def _work(index, _progress):
        if index == 1:
            ctypes.string_at(0)

    found = abreast(_work, 2, 2, NO_PROGRESS)
    assert "SIGSEGV" in found.faults[1].sentence
    assert "Segmentation fault" in found.faults[1].traceback and "in _work" in found.faults[1].traceback


@several
def test_pieces_are_done_here_where_no_process_can_be_started(monkeypatch):
    def _refuse(*_):
        raise OSError(12, "Cannot allocate memory")

    monkeypatch.setattr(os, "fork", _refuse)
    found = abreast(lambda index, _: (index, os.getpid()), 3, 2, NO_PROGRESS)
    assert found.results == {k: (k, os.getpid()) for k in range(3)}


@several
def test_signals_to_the_group_are_the_parent_s(tmp_path):
    """`timeout` sends its signal to the whole group; whoever works there goes on until the parent says otherwise."""
    def _work(index, progress):
        (tmp_path / f"{index}").write_text(str(os.getpid()))
        while len(list(tmp_path.glob("[01]"))) < 2:
            time.sleep(0.01)
        for number in (signal.SIGINT, signal.SIGTERM):
            os.kill(os.getpid(), number)
        return index

    found = abreast(_work, 2, 2, NO_PROGRESS)
    assert found.results == {0: 0, 1: 1}


@several
def test_a_worker_never_hears_a_stop_itself():
    def _work(index, _progress):
        breathe()
        return index

    asked = iter([False] * 3)
    with activate_progress(Progress(None, lambda: next(asked, True))):
        assert abreast(_work, 2, 2, NO_PROGRESS).results == {0: 0, 1: 1}


def test_one_worker_keeps_what_is_finished():
    def _work(index, _progress):
        if index == 2:
            raise Cancelled("cancelled by the user")
        return index

    found = abreast(_work, 4, 1, NO_PROGRESS)
    assert found.results == {0: 0, 1: 1} and found.cancelled and not found.faults


@pytest.mark.parametrize("code, said", [(-9, "signal 9 (SIGKILL)"), (3, "exit code 3"), (-63, "signal 63")])
def test_the_end_of_a_process_in_words(code, said):
    assert how_it_ended(code) == said


@pytest.mark.parametrize("workers", [0, -1, 1.5, True, "2"])
def test_a_wrong_number_of_workers_is_refused(workers):
    with pytest.raises(InvalidInput, match="workers is"):
        check_workers(workers)


@several
def test_a_plan_is_the_same_with_one_process_and_two():
    x, y = np.meshgrid(np.linspace(0, 20, 4), np.linspace(0, 15, 4), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, np.sin(x / 8) * np.cos(y / 7)], axis=-1))
    plans = [ta.plan(face, ta.Tool.ball(8), scallop=0.3, regions=2, limits="cone:0,0,1,5", workers=workers)
             for workers in (1, 2)]
    one, two = ([(op.number, op.face.label, op.orientation.axis.tolist(), op.orientation.length)
                 for op in plan.operations] for plan in plans)
    assert one == two and len(one) == 2
    for a, b in zip(plans[0].operations, plans[1].operations, strict=True):
        np.testing.assert_array_equal(a.path.cl, b.path.cl)
