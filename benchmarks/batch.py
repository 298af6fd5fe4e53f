"""What a batch costs beside a plain loop: overhead for each job, on processes here and on a dask cluster."""

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from benchmarks.growth import processor

import toolaxis as ta
from toolaxis.batch.run import batch
from toolaxis.job.files.plan_folder import write_plan

COUNT, SHORT = 200, 30


def dome(height: float) -> ta.Face:
    """A convex patch of 12 x 8 mm that is planned in a fraction of a second."""
    x, y = np.meshgrid(np.linspace(0, 12, 6), np.linspace(0, 8, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, -height * ((x - 6) ** 2 + (y - 4) ** 2) / 60], axis=-1))


def jobs(count: int) -> list[dict[str, Any]]:
    """So many different small jobs."""
    return [{"name": f"dome-{k:03}", "part": dome(1 + 0.001 * k), "tool": "ball:8", "scallop": 0.2, "method": "normal"}
            for k in range(count)]


def loop(some: list[dict[str, Any]], folder: Path) -> None:
    """A plain loop over the jobs in this process."""
    for job in some:
        target = folder / job["name"]
        target.mkdir(parents=True)
        write_plan(ta.plan(job["part"], job["tool"], job["scallop"], method="normal", workers=1), target)


@contextmanager
def cluster(folder: Path) -> Iterator[str]:
    """The address of a scheduler with two workers on this machine, which have had time to come."""
    file = folder / "scheduler.json"
    words = [["scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard"],
             *[["worker", "--nthreads", "1", "--no-nanny", "--no-dashboard"]] * 2]
    started = [subprocess.Popen([sys.executable, "-m", "dask", *one, "--scheduler-file", str(file)],
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for one in words]
    try:
        while not (file.exists() and file.read_text()):
            time.sleep(0.1)
        time.sleep(5.0)
        yield json.loads(file.read_text())["address"]
    finally:
        for process in started:
            process.kill()
            process.wait()


def main(count: int = COUNT) -> None:
    """Print the table."""
    some = jobs(count)
    print(f"{count} jobs; overhead: processor time for each job beyond that of the plain loop")
    print(f"{'':30}{'wall s':>8}{'processor s':>13}{'overhead s':>12}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        loop(some[:1], folder / "first")  # loads the kernels
        alone = told("plain loop, one process", lambda: loop(some, folder / "loop"))
        for title, workers in (("batch, one process", 1), ("batch, two processes", 2)):
            told(title, lambda k=workers: batch(some, folder / str(k), workers=k), (alone, count))
        if find_spec("distributed") is not None:
            with cluster(folder) as address:
                told("cluster, two workers", lambda: batch(some, folder / "cluster", scheduler=address))
        told("the same again, all finished", lambda: batch(some, folder / "2", workers=2))


def told(title: str, work: Callable[[], object], beside: tuple[float, int] | None = None) -> float:
    """Do something, print what it takes, and give its processor time, s."""
    began, before = time.perf_counter(), processor()
    work()
    wall, own = time.perf_counter() - began, processor() - before
    over = "" if beside is None else f"{(own - beside[0]) / beside[1]:12.3f}"
    print(f"{title:30}{wall:8.1f}{'' if title.startswith('cluster') else format(own, '13.1f')}{over}", flush=True)
    return own


def short() -> None:
    """Print the table for fewer jobs."""
    main(SHORT)


if __name__ == "__main__":
    main()
