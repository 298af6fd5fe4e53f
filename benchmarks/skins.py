"""Skins of several faces against the same faces one by one: operations, area machined, length, and what the judge says.

Areas are those of sub-surfaces that have an axis, without what their plans leave to clean-up, as shares of all that was
asked for.  Lengths are of cuts, with run-outs; the ideal length is that of the axes taken.  A bottle of one closed face
and a row of fillets are built here; the other parts are an example, and parts that nobody here made.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from benchmarks.examples import FOLDER
from benchmarks.real_parts import ENDINGS
from benchmarks.real_parts import FOLDER as PARTS

import toolaxis as ta
from toolaxis.numeric.knots import restrict_spline
from toolaxis.plan.choices import FIELD, ISO
from toolaxis.shape.face import Face
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.shape.part import Part
from toolaxis.skin.find import find_skins


class SkinJob(NamedTuple):
    """A part with its cutter: its name, tool, scallop height in mm, and the faces of its skins that are planned."""

    name: str
    tool: str
    scallop: float
    faces: tuple[int, ...] = ()


class SkinFigures(NamedTuple):
    """What planning comes to: operations with an axis, share of the area, mm, mm, whether all passed, s."""

    operations: int
    share: float
    length: float
    ideal: float
    passed: bool
    taken: float


def bottle() -> Part:
    """A closed face of revolution with a waist and a shoulder, 90 mm high, its outer side machined."""
    turn = np.linspace(-np.pi, np.pi, 25)
    height = np.linspace(0, 90, 10)
    radius = np.array([20, 22, 22, 19, 17, 19, 22, 21, 14, 9.0])
    net = np.stack([radius[:, None] * np.sin(turn), np.broadcast_to(height[:, None], (10, 25)),
                    radius[:, None] * np.cos(turn)], axis=-1)
    net[:, -1] = net[:, 0]
    return Part.from_faces([Face.from_bspline(net, flip=True)])


def fillets() -> Part:
    """A wavy top with rounded edges along both long sides, each cut into three at other places than the other."""
    x = np.linspace(0, 60, 13)
    z = 3 * np.sin(x / 12)
    y = np.linspace(0, 30, 5)
    faces = [Face.from_bspline(np.stack(np.broadcast_arrays(x[:, None], y, z[:, None]), axis=-1))]
    out, down = np.array([0.0, 1.5, 3.0, 3.8]), np.array([0.0, 0.0, 1.0, 3.2])
    for side, first, cuts in ((-1.0, 0.0, (0.0, 0.3, 0.7, 1.0)), (1.0, 30.0, (0.0, 0.4, 0.6, 1.0))):
        net = np.stack(np.broadcast_arrays(x[:, None], first + side * out, z[:, None] - down), axis=-1)
        whole = Face.from_bspline(net, flip=side < 0)
        for low, high in pairwise(cuts):
            knots, own = restrict_spline(whole.surface.knots_u, whole.surface.control, 3, low, high)
            faces.append(replace(whole, surface=NurbsSurface(knots, whole.surface.knots_v, own, (3, 3))))
    return Part.from_faces(faces)


BUILT: dict[str, Callable[[], Part]] = {"bottle": bottle, "fillets": fillets}
JOBS = (SkinJob("skin", "torus:16x2", 0.05), SkinJob("bottle", "ball:10", 0.02), SkinJob("fillets", "ball:6", 0.02),
        SkinJob("mousecover", "torus:10x1", 0.05, (9, 116, 129)), SkinJob("kj66_impeller", "ball:4", 0.01, (2, 7, 9)),
        SkinJob("wing_inv", "torus:16x2", 0.1, (1, 2)), SkinJob("nacelle", "torus:125x20", 2.0, (1, 2)))


def main() -> None:
    """All parts."""
    compare(JOBS)


def short() -> None:
    """The parts that are built here."""
    compare([job for job in JOBS if job.name in BUILT])


def run_with(words: Sequence[str]) -> int:
    """Only the parts that are named.

    Parameters
    ----------
    words : sequence of str
    """
    compare([job for job in JOBS if job.name in words])
    return 0


def compare(jobs: Sequence[SkinJob]) -> None:
    """Print three rows for each part: its faces one by one, its skins, and its skins with passes in a field.

    Parameters
    ----------
    jobs : sequence of SkinJob
    """
    print(f"{'part':14} {'tool':12} {'':10} | {'faces':>5} {'ops':>4} {'area %':>6} {'mm':>9} {'ideal mm':>9} "
          f"{'over %':>6} {'judged':>6} {'plan s':>7}")
    for job in jobs:
        part = load(job)
        if part is None:
            print(f"{job.name}: not here, see {PARTS}")
            continue
        numbers = job.faces or tuple(n for skin in find_skins(part).joined for n in skin) or \
            tuple(face.number for face in part.sculptured)
        groups = [skin for skin in find_skins(part).joined if set(skin) <= set(numbers)]
        single = [n for n in numbers if not any(n in skin for skin in groups)]
        for title, faces, passes in (("one by one", [*numbers], ISO), ("skins", [*groups, *single], ISO),
                                     ("in a field", [*groups, *single], FIELD)):
            one = figures(part, job, faces, passes)
            over = 100 * (one.length / one.ideal - 1) if one.ideal else np.nan
            print(f"{job.name:14} {job.tool:12} {title:10} | {len(faces):5} {one.operations:4} {100 * one.share:6.1f} "
                  f"{one.length:9.0f} {one.ideal:9.0f} {over:6.1f} {'pass' if one.passed else 'FAIL':>6} "
                  f"{one.taken:7.1f}", flush=True)


def load(job: SkinJob) -> Part | None:
    """The part of a job; None where it is not here.

    Parameters
    ----------
    job : SkinJob
    """
    if job.name in BUILT:
        return BUILT[job.name]()
    found = [folder / f"{job.name}{ending}" for folder in (FOLDER, PARTS) for ending in ENDINGS]
    there = [path for path in found if path.exists()]
    return ta.load(there[0]) if there else None


def figures(part: Part, job: SkinJob, faces: Sequence[int | tuple[int, ...]], passes: str) -> SkinFigures:
    """Plan faces and skins, and judge what was planned.

    Parameters
    ----------
    part : Part
    job : SkinJob
    faces : sequence of int and of tuples of int
    passes : str
    """
    began = time.process_time()
    plan = ta.plan(part, ta.Tool.parse(job.tool), job.scallop, faces=faces, passes=passes, workers=1)
    taken = time.process_time() - began
    verdict = ta.verify(plan)
    done = [op for op in plan.operations if op.done and op.path is not None]
    asked = sum(op.face.area for op in plan.operations)
    machined = sum(op.face.area * (1 - op.orientation.unreached) for op in done)
    return SkinFigures(len(done), machined / asked, plan.length, sum(op.orientation.ideal for op in done),
                       all(one.passed for one in verdict.operations if one.name in {op.name for op in done}), taken)


if __name__ == "__main__":
    main()
