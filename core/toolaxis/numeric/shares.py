"""Rows worked on in shares, on the cores that the rest of the program leaves free.

Processes that plan sub-surfaces beside each other keep all cores busy as long as there are several of them.  Where one
is left, or where none can be started as in FreeCAD, kernels use the other cores: they release the interpreter lock.
Shares are the same for any number of threads, and so is what is found.
"""

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Protocol

from toolaxis.progress import breathe

#: Fewer shares are not worth a thread.
_FEWEST = 4


class SharedNumber(Protocol):
    """A number in memory that several processes see."""

    value: int


@dataclass(frozen=True)
class _Cores:
    """How many cores there are for all processes that share them, and how many of these processes are at work."""

    count: int
    busy: SharedNumber | None = None


_CORES: ContextVar[_Cores | None] = ContextVar("cores", default=None)


def count_cores() -> int:
    """How many cores this process may run on."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def use_cores(count: int | None, busy: SharedNumber | None = None) -> Iterator[None]:
    """Use so many cores until it is left, in this thread.

    Parameters
    ----------
    count : int or None
        None leaves it as it is: as many as this process may run on unless said otherwise.
    busy : SharedNumber, optional
        How many processes share them at any moment; this one alone unless given.
    """
    if count is None:
        yield
        return
    token = _CORES.set(_Cores(count, busy))
    try:
        yield
    finally:
        _CORES.reset(token)


def free_cores() -> int:
    """How many threads may work here now, 1 or more."""
    cores = _CORES.get()
    if cores is None:
        cores = _Cores(count_cores())
    return max(1, cores.count // max(1, 1 if cores.busy is None else cores.busy.value))


def work_on_rows(work: Callable[[slice], object], count: int, size: int) -> None:
    """Work on rows in shares to the end; between two shares the user may stop it.

    Parameters
    ----------
    work, count, size
        As for `share_out`.

    Raises
    ------
    Cancelled
    """
    for _ in share_out(work, count, size):
        breathe()


def share_out(work: Callable[[slice], object], count: int, size: int, threads: int | None = None) -> Iterator[slice]:
    """Work on rows in shares, and hand on which are done, in their order.

    The first share is done before there are threads: compiled kernels must not be loaded by two at a time (numba on
    Python 3.14 then ends the process).

    Parameters
    ----------
    work : callable
        Takes the rows of a share; what it makes of them does not depend on other shares.
    count, size : int
        Rows in all, and of a share.
    threads : int, optional
        As many as there are free cores unless given.

    Yields
    ------
    slice
        Where the caller raises, shares that were not begun are left.
    """
    shares = [slice(first, min(first + size, count)) for first in range(0, count, size)]
    if threads is None:
        threads = free_cores() if len(shares) >= _FEWEST else 1
    alone = shares if threads <= 1 else shares[:1]
    for some in alone:
        work(some)
        yield some
    shares = shares[len(alone):]
    if not shares:
        return

    def _work(some: slice) -> None:
        with use_cores(1):  # what is shared out in there is this thread's own
            work(some)

    with ThreadPoolExecutor(threads) as pool:
        jobs = [pool.submit(_work, some) for some in shares]
        try:
            for some, job in zip(shares, jobs, strict=True):
                job.result()
                yield some
        finally:
            for job in jobs:
                job.cancel()
