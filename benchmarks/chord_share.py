"""What the chord tolerance of passes costs, by its share of the scallop height: points, files and time against length.

A large one takes much of the machining tolerance and leaves facets along the feed; a small one costs points, in the
proof, in the file and in the control.  It does not count in the scallop height: points of hollow stretches lie deeper.
Examples of this project, and two faces of parts by others where the environment names their folder as TOOLAXIS_SHARED.
"""

import os
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np
from benchmarks.examples import BODY, FOLDER

import toolaxis as ta
from toolaxis.job.files.plan_folder import write_plan
from toolaxis.plan.plan import Plan
from toolaxis.tolerances import MACHINING_SHARE, SCALLOP_SHARE
from toolaxis.verify.verdict import Verdict

SHARES = (50, 20, 10, 8, 6, 4)
OTHERS = Path(os.environ.get("TOOLAXIS_SHARED", Path(__file__).resolve().parents[2] / "shared")) / "parts"


class FaceJob(NamedTuple):
    """A face to be machined."""

    path: Path
    faces: tuple[int, ...] | None
    tool: str
    scallop: float


class PlanCost(NamedTuple):
    """What one plan costs, and what the judge measured."""

    points: int
    kilobytes: float
    seconds: float
    length: float
    gouge: float
    scallop: float
    within: float
    passed: bool


JOBS = (FaceJob(FOLDER / "freeform.step", None, "torus:12x1", 0.02),
        FaceJob(FOLDER / "saddle.step", None, "torus:12x1", 0.02),
        FaceJob(FOLDER / "waves.step", None, "torus:12x1", 0.02),
        FaceJob(FOLDER / "boss.step", None, "torus:10x1", 0.02),
        FaceJob(FOLDER / "trimmed.step", None, "torus:16x2", 0.02),
        FaceJob(OTHERS / "mousecover.step", (9,), "torus:10x1", 0.05),
        FaceJob(OTHERS / "ctc05_in.stp", (127,), "ball:12", 0.02))


def main() -> None:
    """Print a row for each share of each face, and the means beside the share that is planned with."""
    tables(JOBS)


def short() -> None:
    """The first two faces only."""
    tables(JOBS[:2])


def tables(jobs: tuple[FaceJob, ...]) -> None:
    """Print the rows of faces, and the geometric means of what they cost, each as a multiple of the first share's.

    Parameters
    ----------
    jobs : tuple of FaceJob
    """
    print(f"planned with h/{1 / SCALLOP_SHARE:g}, at most {MACHINING_SHARE:g} of the machining tolerance, "
          f"which is {ta.Tolerance().gouge:g} mm")
    print(f"{'face':22} {'tool':10} {'h um':>5} {'chord um':>8} {'points':>7} {'CL kB':>7} {'plan s':>6} "
          f"{'length mm':>9} {'gouge um':>8} {'left um':>7} {'% within h':>10}")
    ta.plan(jobs[0].path, ta.Tool.parse(jobs[0].tool, **BODY), 1.0, workers=1)  # compiles what is timed
    found: list[list[PlanCost]] = []
    for job in jobs:
        if not job.path.is_file():
            print(f"{job.path.name}: not measured, the folder of parts by others is not there")
            continue
        found.append([row(job, share) for share in SHARES])
    for k, share in enumerate(SHARES):
        points, kilobytes, seconds, length = (
            float(np.exp(np.mean([np.log(getattr(costs[k], name) / getattr(costs[0], name)) for costs in found])))
            for name in ("points", "kilobytes", "seconds", "length"))
        print(f"mean of all, h/{share:<3d} as a multiple of h/{SHARES[0]}: points {points:.2f}, file {kilobytes:.2f}, "
              f"time {seconds:.2f}, length {length:.3f}")


def row(job: FaceJob, share: int) -> PlanCost:
    """Plan and judge a face with a share of the scallop height, and print what it costs.

    Parameters
    ----------
    job : FaceJob
    share : int
        The chord tolerance is so many times smaller than the scallop height.
    """
    began = time.process_time()
    plan = ta.plan(job.path, ta.Tool.parse(job.tool, **BODY), job.scallop, faces=job.faces, workers=1,
                   tolerance=ta.Tolerance(chord=job.scallop / share))
    seconds = time.process_time() - began
    cost = measured(plan, ta.verify(plan), seconds)
    name = job.path.stem + ("" if job.faces is None else f" face {job.faces[0]}")
    print(f"{name:22} {job.tool:10} {1e3 * job.scallop:5.0f} {1e3 * plan.inputs.chord:8.2f} {cost.points:7d} "
          f"{cost.kilobytes:7.1f} {cost.seconds:6.1f} {cost.length:9.1f} {1e3 * cost.gouge:8.2f} "
          f"{1e3 * cost.scallop:7.2f} {100 * cost.within:10.3f} {'pass' if cost.passed else 'FAIL'}", flush=True)
    return cost


def measured(plan: Plan, verdict: Verdict, seconds: float) -> PlanCost:
    """What a plan costs and what the judge measured of it.

    Parameters
    ----------
    plan : Plan
    verdict : Verdict
    seconds : float
        Processor time of the plan.
    """
    done = [op for op in plan.operations if op.path is not None]
    with tempfile.TemporaryDirectory() as folder:
        write_plan(plan, Path(folder))
        size = sum(path.stat().st_size for path in Path(folder).glob("*.apt"))
    targets = [(op.scallop_limit, one) for op in verdict.operations for one in op.maps[:len(op.faces)]]
    good = sum(one.share_within(limit) * one.area for limit, one in targets)
    area = sum(one.area for _, one in targets)
    points = sum(len(op.path.cl) for op in done if op.path is not None)
    return PlanCost(points, size / 1e3, seconds, plan.length, max(op.gouge_max for op in verdict.operations),
                    max(op.scallop_max for op in verdict.operations), good / area, verdict.passed)


if __name__ == "__main__":
    main()
