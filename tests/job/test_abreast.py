"""Pieces of work on several processes: same results, one stop, no debris."""

import os
import signal
import time

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import Cancelled, InvalidInput, JobError
from toolaxis.job import abreast as module
from toolaxis.job.abreast import abreast, checked_workers
from toolaxis.progress import NO_PROGRESS, Progress

several = pytest.mark.skipif(checked_workers(2) == 1, reason="processes are only forked on Linux")


@several
def test_results_come_in_order_whatever_finishes_first():
    def _work(index, _progress):
        time.sleep(0.05 * (index == 0))
        return index, os.getpid()

    found = abreast(_work, 7, 3, NO_PROGRESS)
    assert [index for index, _ in found.results] == list(range(7))
    assert not found.cancelled
    assert os.getpid() not in {pid for _, pid in found.results}


@several
def test_reports_reach_the_parent():
    heard = []

    def _work(index, progress):
        progress.report(f"piece {index}", 1, 2)

    abreast(_work, 4, 2, Progress(lambda *what: heard.append(what)))
    assert sorted(heard) == [(f"piece {k}", 1, 2) for k in range(4)]


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


@pytest.mark.parametrize("workers", [1, 2])
def test_what_a_piece_raises_is_raised(workers):
    def _work(index, _progress):
        raise InvalidInput(f"piece {index} is wrong")

    with pytest.raises(InvalidInput, match=r"piece \d is wrong"):
        abreast(_work, 3, workers, NO_PROGRESS)


@several
def test_what_cannot_be_carried_over_is_told_in_words():
    class Local(Exception):
        pass

    def _work(index, _progress):
        raise Local("no home")

    with pytest.raises(JobError, match="Local: no home"):
        abreast(_work, 3, 2, NO_PROGRESS)


@several
def test_a_process_that_is_killed_is_told():
    def _work(index, _progress):
        os.kill(os.getpid(), signal.SIGKILL)

    with pytest.raises(JobError, match="ended with code -9"):
        abreast(_work, 2, 2, NO_PROGRESS)


def test_one_worker_keeps_what_is_finished():
    def _work(index, _progress):
        if index == 2:
            raise Cancelled("cancelled by the user")
        return index

    assert abreast(_work, 4, 1, NO_PROGRESS) == module.Outcome((0, 1), True)


@pytest.mark.parametrize("workers", [0, -1, 1.5, True, "2"])
def test_a_wrong_number_of_workers_is_refused(workers):
    with pytest.raises(InvalidInput, match="workers is"):
        checked_workers(workers)


@several
def test_a_plan_is_the_same_with_one_process_and_two():
    grid = np.stack(np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 30, 5), indexing="ij"), -1)
    face = ta.Face.from_bspline(np.concatenate([grid, 4 * np.sin(grid[..., :1] / 15)], axis=-1))
    tool = ta.Tool.torus(diameter=12, corner_radius=2)
    plans = [ta.plan(face, tool, scallop=0.2, regions=2, workers=workers) for workers in (1, 2)]
    one, two = ([(op.number, op.face.label, op.orientation.axis.tolist(), op.orientation.length)
                 for op in plan.operations] for plan in plans)
    assert one == two and len(one) == 2
    for a, b in zip(plans[0].operations, plans[1].operations, strict=True):
        np.testing.assert_array_equal(a.path.cl, b.path.cl)
