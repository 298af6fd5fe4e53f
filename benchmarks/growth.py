"""How time and memory grow: with the number of faces, of surface points, and of axes."""

import gc
import resource
import time
import tracemalloc
from collections.abc import Callable

import numpy as np

import toolaxis as ta
from toolaxis.path.estimate import Estimator

TOOL = ta.Tool.torus(12, 1, stickout=60, holder=[(16, 0), (16, 40)])
SCALLOP = 0.02
COUNTS = (1, 3, 10, 30, 100)
WHO = resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN


def patch(size: float = 100.0, at: tuple[float, float] = (0.0, 0.0)) -> ta.Face:
    """A waved bicubic patch with 8 x 8 control points."""
    x = np.linspace(0, size, 8)
    grid = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1)
    z = 0.06 * size * np.sin(2.2 * grid[..., 0] / size) * np.cos(1.7 * grid[..., 1] / size)
    return ta.Face.from_bspline(np.dstack([grid + at, z]))


def measured(work: Callable[[], object]) -> tuple[float, float]:
    """Seconds of a run, and the greatest memory that a second run allocates, MB."""
    gc.collect()
    start = time.perf_counter()
    work()
    seconds = time.perf_counter() - start
    tracemalloc.start()
    work()
    peak = tracemalloc.get_traced_memory()[1] / 1e6
    tracemalloc.stop()
    return seconds, peak


def faces() -> None:
    """Plan 1 to 100 small faces, all of them standing in each other's way."""
    print("faces: plan of a part (30 mm patches side by side), whole run; processor time of this process and its "
          "workers, greatest memory so far of this process and of the largest worker")
    for count in COUNTS:
        part = [patch(30.0, (35.0 * (k % 10), 35.0 * (k // 10))) for k in range(count)]
        start, worked = time.perf_counter(), processor()
        plan = ta.plan(part, TOOL, SCALLOP)
        seconds, worked = time.perf_counter() - start, processor() - worked
        done = sum(op.done for op in plan.operations)
        own, largest = (resource.getrusage(who).ru_maxrss / 1e3 for who in WHO)
        print(f"  {count:4d} faces {seconds:8.2f} s, {worked:8.2f} s of processor, {worked / count:6.2f} s/face "
              f"{own:8.1f} MB and {largest:8.1f} MB, {done} done", flush=True)


def processor() -> float:
    """Processor time so far of this process and of its workers that have ended, s."""
    used = [resource.getrusage(who) for who in WHO]
    return sum(one.ru_utime + one.ru_stime for one in used)


def points() -> None:
    """Strip width, gouge and clearance at 10^3 to 10^5 contacts."""
    face, wall = patch(), patch().transformed([[1, 0, 0, 0], [0, 0, -1, 130.0], [0, 1, 0, 0], [0, 0, 0, 1]])
    axis = np.array([0.35, 0.1, 0.93]) / np.linalg.norm([0.35, 0.1, 0.93])
    rng = np.random.default_rng(0)
    work = {"strip width": lambda uv: ta.strip_width(face, TOOL, uv, axis, SCALLOP),
            "gouge": lambda uv: ta.gouge(face, TOOL, uv, axis),
            "clearance": lambda uv: ta.clearance(face, TOOL, uv, axis, [wall])}
    print("contacts: time and memory of one call")
    for name, call in work.items():
        call(rng.uniform(0.1, 0.9, (10, 2)))
        for count in (1_000, 10_000, 100_000):
            uv = rng.uniform(0.1, 0.9, (count, 2))
            seconds, peak = measured(lambda call=call, uv=uv: call(uv))
            print(f"  {name:12} {count:7d} contacts {seconds:8.3f} s {seconds / count * 1e6:7.2f} us each "
                  f"{peak:8.1f} MB",
                  flush=True)


def axes() -> None:
    """Estimate for 10 to 10^4 axes, both feed directions: screening form and exact form."""
    estimator = Estimator.of(patch(), TOOL, SCALLOP)
    rng = np.random.default_rng(1)
    print(f"axes: estimate from {len(estimator.samples)} sample points, both feed directions")
    for exact, counts in ((False, (10, 100, 1_000, 10_000)), (True, (10, 100, 1_000))):
        for count in counts:
            lean = np.column_stack([rng.uniform(-0.7, 0.7, (count, 2)), np.ones(count)])
            many = lean / np.linalg.norm(lean, axis=1, keepdims=True)
            estimator.many(many[:2], exact=exact)
            seconds, peak = measured(lambda many=many, exact=exact: estimator.many(many, exact=exact))
            print(f"  {'exact' if exact else 'screening':9} {count:6d} axes {seconds:8.3f} s "
                  f"{seconds / count * 1e6:9.1f} us each {peak:8.1f} MB", flush=True)


def main() -> None:
    """Print the three tables."""
    points()
    axes()
    faces()


if __name__ == "__main__":
    main()
