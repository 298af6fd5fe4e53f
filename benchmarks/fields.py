"""Passes in a field against iso-parametric ones, each with the best axis for it, beside the ideal length; all judged.

Lengths are those inside the face, run-outs apart.  The ideal length of an axis is what passes tend to as the scallop
height goes to zero: the integral over the face of the tip's way over the widest strip; the least one is that of all
free axes that were looked at, by second-order widths.  Beside them stand the classical iso-scallop passes, offset from
a border: the shortest over all borders and both axes, neither proven nor judged.  Times are those of the jerk-limited
planner of feeds on the Mikron UCP 710 at 3 m/min, cuts with their run-outs.  Random patches are bicubic, 60 x 45 mm,
from seeds.
"""

import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from benchmarks._iso_scallop import shortest_from_borders
from benchmarks.examples import FOLDER
from numpy.typing import NDArray

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.feed.fixed_axis_time import Feeds, machining_time
from toolaxis.machine.library import load_machine
from toolaxis.machine.machine import Machine
from toolaxis.path.field.ideal_lengths import DirectionForms
from toolaxis.path.parametrization import Cut
from toolaxis.plan.choices import FIELD, ISO
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest

Array = NDArray[np.float64]

#: Feed in mm/s, machining tolerance in mm.
MACHINE, FEED, TOLERANCE = "mikron-ucp-710", 3000.0 / 60, 0.002
#: Contacts farther than this from the face are beyond it, mm.
_NEAR = 0.01
#: Faces of fewer strips are not asked for a gap.
_STRIPS = 20
SEEDS = range(20)


class FaceJob(NamedTuple):
    """A face with its cutter: the example's name, or the seed of a patch, the tool and the scallop height, mm."""

    name: str
    tool: str = "torus:12x1"
    scallop: float = 0.02


class PassFigures(NamedTuple):
    """What passes of one kind come to.

    inside, whole : float, mm, cutting length inside the face and with run-outs;  ideal, least : float, mm, ideal length
    of the axis and least one;  seconds : float, of the cuts;  within : float, share of the area within 1.02 h;
    passed : bool;  taken : float, s of processor for the plan;  strips : float, number of passes
    cuts : list of (Face, Cut), of its operations
    """

    inside: float
    whole: float
    ideal: float
    least: float
    seconds: float
    within: float
    passed: bool
    taken: float
    strips: float
    cuts: list[tuple[Face, Cut]]


JOBS = (FaceJob("freeform"), FaceJob("saddle"), FaceJob("waves"), FaceJob("manta", "torus:16x2", 0.05),
        FaceJob("biquintic", "torus:20x3", 0.03), FaceJob("hyperbolic_paraboloid"),
        FaceJob("trimmed", "torus:16x2"), FaceJob("outline"))


def main() -> None:
    """The examples, and the random patches."""
    compare((*JOBS, *(FaceJob(f"seed {seed}") for seed in SEEDS)))


def short() -> None:
    """Two examples and two random patches."""
    compare((*JOBS[:2], FaceJob("seed 0"), FaceJob("seed 1")))


def run_with(words: Sequence[str]) -> int:
    """Only the faces that are named: `python -m benchmarks fields freeform "seed 3"`.

    Parameters
    ----------
    words : sequence of str
    """
    known = {job.name: job for job in JOBS}
    compare([known.get(word, FaceJob(word)) for word in words])
    return 0


def compare(jobs: Sequence[FaceJob]) -> None:
    """Print a row for each face, and what all of them come to.

    Parameters
    ----------
    jobs : sequence of FaceJob
    """
    machine = load_machine(MACHINE)
    print(f"{'face':22} {'tool':10} | {'iso mm':>8} {'field mm':>8} {'less %':>6} | {'ideal':>7} {'gap %':>5} "
          f"{'least':>7} {'offset':>7} | {'iso s':>6} {'field s':>7} {'less %':>6} | {'iso %':>7} {'field %':>7} "
          f"{'judged':>9} | {'plan s':>12}")
    found: list[tuple[PassFigures, PassFigures]] = []
    shorter: list[float] = []
    for job in jobs:
        part = part_of(job)
        iso, field = (figures(part, job, passes, machine) for passes in (ISO, FIELD))
        offset = offset_length(iso, field)
        found.append((iso, field))
        shorter.append(field.inside / offset)
        gap = 100 * (field.inside / field.ideal - 1) if field.ideal else np.nan
        print(f"{job.name:22} {job.tool:10} | {iso.inside:8.0f} {field.inside:8.0f} "
              f"{100 * (1 - field.inside / iso.inside):6.1f} | {field.ideal:7.0f} {gap:5.1f} {field.least:7.0f} "
              f"{offset:7.0f} | {iso.seconds:6.1f} {field.seconds:7.1f} "
              f"{100 * (1 - field.seconds / iso.seconds):6.1f} | {100 * iso.within:7.3f} {100 * field.within:7.3f} "
              f"{'pass' if iso.passed else 'FAIL'} {'pass' if field.passed else 'FAIL'} | "
              f"{iso.taken:5.1f} {field.taken:6.1f}", flush=True)
    both = np.array([[iso.inside, field.inside, iso.seconds, field.seconds] for iso, field in found])
    best = np.minimum(both[:, 0], both[:, 1])
    print(f"the shorter of both over iso: geometric mean {_mean(best / both[:, 0]):.3f}")
    gaps = [field.inside / field.ideal - 1 for _, field in found if field.ideal and field.strips >= _STRIPS]
    print(f"{len(found)} faces: geometric mean of field over iso, length {_mean(both[:, 1] / both[:, 0]):.3f}, time "
          f"{_mean(both[:, 3] / both[:, 2]):.3f}; longer than iso: {int((both[:, 1] > both[:, 0]).sum())}, slower: "
          f"{int((both[:, 3] > both[:, 2]).sum())}; judged FAIL: "
          f"{sum(not one.passed for pair in found for one in pair)}")
    print(f"field over iso-scallop passes offset from a border, length: geometric mean "
          f"{_mean(np.array([ratio for ratio in shorter if np.isfinite(ratio) and ratio > 0])):.3f}")
    if gaps:
        print(f"gap to the ideal length of the axis taken on {len(gaps)} faces of {_STRIPS} strips or more: median "
              f"{100 * np.median(gaps):.1f} %, greatest {100 * max(gaps):.1f} %")


def _mean(ratios: Array) -> float:
    return float(np.exp(np.log(ratios).mean()))


def part_of(job: FaceJob) -> ta.Part:
    """The part of a job: an example, or a random patch alone.

    Parameters
    ----------
    job : FaceJob
    """
    if not job.name.startswith("seed "):
        return ta.load(FOLDER / f"{job.name}.step")
    return ta.Part.from_faces([Face.from_bspline(patch_points(int(job.name.split()[1])))])


def patch_points(seed: int) -> Array:
    """Control points of a random bicubic patch, (6, 5, 3) mm.

    Parameters
    ----------
    seed : int
    """
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(0, 60, 6), np.linspace(0, 45, 5), indexing="ij")
    lean, height = rng.uniform(-0.3, 0.3, 2), rng.uniform(1, 6)
    return np.stack([x, y, lean[0] * x + lean[1] * y + height * rng.uniform(-1, 1, x.shape)], axis=-1)


def figures(part: ta.Part, job: FaceJob, passes: str, machine: Machine) -> PassFigures:
    """Plan and judge a face.

    Parameters
    ----------
    part : Part
    job : FaceJob
    passes : str
        How passes lie.
    machine : Machine
        For the time.
    """
    began = time.process_time()
    plan = ta.plan(part, ta.Tool.parse(job.tool), job.scallop, passes=passes, tolerance=TOLERANCE, workers=1)
    taken = time.process_time() - began
    verdict = ta.verify(plan)
    done = [op for op in plan.operations if op.path is not None]
    maps = [one for op in verdict.operations for one in op.maps[:len(op.faces)]]
    area = sum(one.area for one in maps)
    feeds = Feeds(FEED, tolerance=plan.inputs.chord, smooth=True)
    within = sum(one.share_within(job.scallop) * one.area for one in maps) / area if area else 0.0
    return PassFigures(sum(inside_length(op) for op in done), plan.length, sum(op.orientation.ideal for op in done),
                       sum(least_ideal(plan, op) for op in done),
                       sum(machining_time(machine, op.path, feeds).cut for op in done if op.path is not None),
                       within, verdict.passed, taken, sum(op.orientation.count for op in done),
                       [(op.face, Cut(plan.tools[0], op.orientation.axis, job.scallop, plan.inputs.allowance))
                        for op in done if op.orientation.axis is not None])


def offset_length(*kinds: PassFigures) -> float:
    """Length inside the face of iso-scallop passes offset from a border, mm; nan for faces with several axes.

    Parameters
    ----------
    kinds : PassFigures
        Whose axes are tried.
    """
    if any(len(one.cuts) != 1 for one in kinds):
        return float("nan")
    return shortest_from_borders(kinds[0].cuts[0][0], [one.cuts[0][1] for one in kinds])


def inside_length(op: Operation) -> float:
    """Way of the tip while the cutter touches the face, mm.

    Parameters
    ----------
    op : Operation
        With a path.
    """
    path = op.path
    assert isinstance(path, ToolPath)
    at = np.flatnonzero(path.kind[1:] == Motion.CUT)
    middle = (path.cc[at] + path.cc[at + 1]) / 2
    found = nearest(op.face, middle)
    near = np.linalg.norm(op.face.evaluate(found.uv).point - middle, axis=1) < _NEAR
    inside = op.face.contains(found.uv) & near
    return float(np.linalg.norm(path.cl[at + 1] - path.cl[at], axis=1)[inside].sum())


def least_ideal(plan: Plan, op: Operation) -> float:
    """Least ideal length, mm, over the free axes that the search looked at.

    Parameters
    ----------
    plan : Plan
    op : Operation
    """
    known = op.orientation.map
    if known is None:
        return float("nan")
    forms = DirectionForms.of(op.face, plan.tools[0], plan.inputs.scallop, plan.inputs.allowance)
    return float(forms.estimate(known.axis[known.reason == 0]).length.min())


if __name__ == "__main__":
    main()
