"""The jobs of a batch on a dask.distributed cluster: the same tasks, carried out by processes beside its workers."""

import logging
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from toolaxis.batch.hand import TICK, WorkerProcess
from toolaxis.batch.task import BatchAnswer, BatchTask
from toolaxis.errors import Cancelled, InvalidInput, JobError, MissingBackend

if TYPE_CHECKING:
    from distributed import Client

#: Tasks that wait at the cluster for each one at work, so that no worker waits for this process.
_AHEAD = 2
#: s until a scheduler has to answer.
_PATIENCE = 10.0
#: s between two looks at the workers.
_EVERY = 0.5
_OWN = threading.local()


@contextmanager
def connect_to_scheduler(address: str) -> "Iterator[Client]":
    """A connection to a scheduler.

    Parameters
    ----------
    address : str
        "tcp://host:8786"

    Raises
    ------
    MissingBackend
        When dask.distributed is not installed.
    InvalidInput
        When no scheduler answers there.
    """
    try:
        import dask

        kind = _closing()
    except ImportError as reason:
        raise MissingBackend("a cluster needs dask.distributed: pip install 'toolaxis[cluster]'") from reason
    with ExitStack() as stack:
        stack.enter_context(_silent())
        stack.enter_context(dask.config.set({"distributed.comm.timeouts.connect": f"{_PATIENCE}s"}))
        try:
            client = kind(address, timeout=_PATIENCE, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as reason:
            raise InvalidInput(f"no scheduler answers at {address!r}: start one with dask scheduler, or leave "
                               "--scheduler out") from reason
        try:
            yield client
        finally:
            with suppress(Exception):
                client.close(timeout=1.0)


def _closing() -> "type[Client]":
    """Clients that are closed where they fail to start, and never while Python collects what nobody holds: then closing
    waits for a lock that the next client holds while it starts, and that one for ever."""
    from distributed import Client

    class Closing(Client):
        def start(self, **settings: Any) -> None:
            try:
                super().start(**settings)  # type: ignore[no-untyped-call]
            except BaseException:
                with suppress(Exception):
                    self.close(timeout=1.0)  # type: ignore[no-untyped-call]
                raise

        def __del__(self) -> None:
            pass

    return Closing


@contextmanager
def _silent() -> Iterator[None]:
    """Let distributed say nothing: what there is to say is said by the batch."""
    every = [logging.getLogger(name) for name in list(logging.root.manager.loggerDict)
             if name.split(".")[0] == "distributed"]
    levels = [one.level for one in every]
    for one in every:
        one.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for one, level in zip(every, levels, strict=True):
            one.setLevel(level)


def by_cluster(client: "Client", tasks: Iterator[BatchTask | None],
               told: Callable[[str], None]) -> Iterator[tuple[BatchTask, BatchAnswer] | None]:
    """Answers to tasks from a cluster, as they come.

    Parameters
    ----------
    client : distributed.Client
    tasks : iterator of BatchTask
        Asked for the next one when the cluster can take it; None where the next one has to wait for one at work.
    told : callable
        Takes a sentence where the cluster has no workers.

    Yields
    ------
    tuple of Task and Answer, or None
        None every `TICK` seconds.

    Raises
    ------
    JobError
        When the scheduler is gone.
    """
    sent: dict[Any, BatchTask] = {}
    run, warned, threads, asked = uuid4().hex[:8], False, 0, -_EVERY
    address = str(client.scheduler.address) if client.scheduler else ""
    try:
        while True:
            if time.monotonic() - asked >= _EVERY:
                threads, asked = _threads(client, address), time.monotonic()
            if not threads and not warned:
                told(f"the cluster at {address} has no workers: the jobs wait for one")
                warned = True
            while len(sent) < max(1, _AHEAD * threads) and (task := next(tasks, None)) is not None:
                sent[client.submit(carry_out_on_worker, task, key=f"toolaxis-{run}-{task.name}", pure=False)] = task
            if not sent:
                return
            yield None
            ready = [future for future in sent if future.done()]
            if not ready:
                time.sleep(TICK)
            for future in ready:
                answer = _answer(future, client, address)
                if answer is not None:
                    yield sent.pop(future), answer
    finally:
        with suppress(Exception):
            client.cancel(list(sent), force=True)


def _threads(client: "Client", address: str) -> int:
    """Number of tasks that the workers can take at once."""
    try:
        if client.status == "running":
            return sum(client.nthreads().values())
    except Exception as reason:
        raise _scheduler_error(address) from reason
    raise _scheduler_error(address)


def _scheduler_error(address: str) -> JobError:
    return JobError("jobs", "cluster", f"the scheduler at {address} is gone: start it and run the batch again, it goes "
                    "on where it stopped")


def _answer(future: Any, client: "Client", address: str) -> BatchAnswer | None:
    """The answer that a future holds; failed where the cluster gave the task up, None where it has to be waited for."""
    try:
        found: BatchAnswer = future.result(timeout=_PATIENCE)
        return found
    except TimeoutError:  # the worker that had it is gone: another one does the task again
        return None
    except Exception as reason:
        time.sleep(TICK)
        _threads(client, address)  # all futures are lost where the scheduler is gone
        if type(reason).__name__ in ("CancelledError", "FutureCancelledError", "CommClosedError"):
            raise JobError("jobs", "cluster", f"the cluster at {address} lost its jobs: run the batch again, it goes "
                           "on where it stopped") from reason
        said = " ".join(str(reason).split())
        return BatchAnswer("failed", "crash", f"the cluster gave it up ({type(reason).__name__}: {said})")


def carry_out_on_worker(task: BatchTask) -> BatchAnswer:
    """The answer to a task, on a worker of the cluster: from a process beside it, so that the worker outlives the job.

    Parameters
    ----------
    task : BatchTask

    Raises
    ------
    Cancelled
        When nobody wants the answer any more.
    """
    hand: WorkerProcess | None = getattr(_OWN, "hand", None)
    if hand is None:
        hand = _OWN.hand = WorkerProcess()
    wanted = _is_task_wanted()
    hand.give(task)
    while True:
        answer = hand.answer(TICK)
        if answer is not None:
            return answer
        if not wanted():
            hand.dismiss()
            raise Cancelled("the batch was stopped")


def _is_task_wanted() -> Callable[[], bool]:
    """Whether the task of this thread is still one that its worker is to do."""
    from distributed import get_worker

    worker = get_worker()
    key = worker.get_current_task()

    def asked() -> bool:
        state = worker.state.tasks.get(key)
        return state is not None and state.state == "executing"

    return asked
