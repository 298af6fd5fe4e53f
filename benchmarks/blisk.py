"""Parts with blades: time, memory, stages, growth with blades and obstacles, passes beside [zhu2016] Table 6."""

import json
import os
import resource
import time
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

from benchmarks._papers import GOUGE

import toolaxis as ta
from toolaxis.job.inputs.tool_file import load_tool
from toolaxis.job.planning.blade_copies import spread_out
from toolaxis.job.planning.blade_pattern import Pattern, find_pattern
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.report.blades import blades_lines
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.search.path_check import prove
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part

ROOT = Path(__file__).resolve().parent.parent
SHARED = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"
SLENDER = {"stickout": 70, "holder": [(10, 0), (10, 40), (25, 40), (25, 80)]}
SCALLOP, WORKERS = 0.02, 2
#: A part and its tool; the passages of the impeller by others want a slim one.
JOBS = ((ROOT / "examples" / "blisk.step", ta.Tool.parse("torus:10x1", **SLENDER)),
        (SHARED / "kj66_impeller.step", load_tool("tapered-2x1x3")))
STAGES = (("looking for blades", "blades found"), ("looking for what", "covered faces"),
          ("axes at the lattice", "division"), ("(1 of", "search and proof"), ("rest material", "rest material"),
          ("blade ", "turned and proven"), ("clearance to", "clearances"))
COUNTS = (1, 2, 4, 8, 16)


class StageTimes:
    """When each stage was heard of first."""

    def __init__(self) -> None:
        self.began = time.perf_counter()
        self.first: dict[str, float] = {"loading": 0.0}

    def report(self, stage: str, done: float, total: float) -> None:
        """Note a stage."""
        now = time.perf_counter() - self.began
        for mark, name in STAGES:
            if stage.startswith(mark) or (mark != "blade " and mark in stage):
                if not stage.startswith("blade ") or mark == "blade ":
                    self.first.setdefault(name, now)
                return


def main() -> None:
    """Plan each part whole."""
    for path, tool in JOBS:
        if not path.exists():
            print(f"{path.name}: skipped, {path} is not there (set TOOLAXIS_SHARED)")
            continue
        watch = StageTimes()
        plan = ta.plan(path, tool, SCALLOP, workers=WORKERS, tolerance=GOUGE, progress=Progress(watch.report))
        told(path, plan, watch, time.perf_counter() - watch.began)
        if plan.blades is not None:
            growth(plan)


def told(path: Path, plan: Plan, watch: StageTimes, seconds: float) -> None:
    """Print what was measured of a whole part."""
    own, largest = (resource.getrusage(who).ru_maxrss / 1e3 for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    done = sum(op.done for op in plan.operations)
    print(f"{path.name}, {plan.named_tools}: {seconds:.1f} s with {WORKERS} processes, at most {own:.0f} MB in this "
          f"one and {largest:.0f} MB in the largest other; {plan.outcome}, "
          f"{done} of {len(plan.operations)} sub-surfaces")
    marks = [*sorted(watch.first.items(), key=lambda item: item[1]), ("", seconds)]
    for (stage, start), (_, end) in pairwise(marks):
        print(f"    {stage:20} {end - start:7.1f} s {100 * (end - start) / seconds:5.1f} %")
    for warning in plan.part.warnings:
        print(f"    {warning}")
    if plan.blades is None:
        return
    for line in blades_lines(plan):
        print(f"    {line}")
    facts = path.with_suffix(".json")
    published = json.loads(facts.read_text("utf-8")).get("published", {}).get("passes", []) if facts.exists() else []
    print(f"    passes of [zhu2016] Table 6, on a blade whose shape is not published: {published}")
    for op in plan.operations:
        if plan.blades.blade_of(op.face.number) == 1 and op.done:
            found = op.orientation
            print(f"    {op.face.label:>6} {plan.blades.side_of(op.face.number):9} {found.passes:4d} passes, "
                  f"{found.length:7.1f} mm, strip {found.average_strip_width:.3f} mm, unreached {found.unreached:.3f}")


class ProvingPlanner:
    """What proves operations on further blades; where the proof refuses, it does not search."""

    workers = WORKERS

    def __init__(self, plan: Plan) -> None:
        self.plan = plan

    def task(self, part: Part, face: Face, progress: Progress) -> FaceProblem:
        """What decides about an axis."""
        inputs = self.plan.inputs
        return task(face, self.plan.tools[0], inputs.scallop, None, (), part=part, tolerance=inputs.tolerance,
                    progress=progress)

    def search(self, part: Part, face: Face, number: int, progress: Progress) -> Operation:
        """The operation without an axis."""
        return Operation(number, face, self.plan.tools[0], Orientation(None))


def growth(plan: Plan) -> None:
    """Print the time of turning and proving by the number of blades, and of one proof by the faces in the way."""
    pattern, _ = find_pattern(ta.load(plan.part.source))
    assert pattern is not None
    own = tuple(op for op in plan.operations if pattern.blades.blade_of(op.face.number) == 1)
    first = replace(plan, operations=own, blades=None)
    for count, some in fewer(pattern):
        start = time.perf_counter()
        spread_out(some, first, ProvingPlanner(plan), NO_PROGRESS)
        print(f"    {count:3d} of the blades: {time.perf_counter() - start:7.1f} s to turn {len(own)} operations to "
              "them and prove them")
    done = max((op for op in own if op.path is not None), key=lambda op: op.face.area)
    assert done.path is not None
    for count, _ in fewer(pattern):
        part = among(pattern, count)
        start = time.perf_counter()
        groups = ProvingPlanner(plan).task(pattern.blades.apart(part, done.face.number), done.face, NO_PROGRESS).groups
        proof = prove(done.path, plan.tools[0], groups, plan.inputs.allowance)
        print(f"    {len(part.faces):4d} faces with {count:2d} blades: {time.perf_counter() - start:6.2f} s to prove "
              f"{done.name}, least clearance {min(proof.clearance.values()):.3f} mm")


def fewer(pattern: Pattern) -> Iterator[tuple[int, Pattern]]:
    """The pattern with its first 1, 2, 4, … blades only, and with all."""
    whole = len(pattern.blades.blades)
    for count in sorted({*(n for n in COUNTS if n < whole), whole}):
        blades = replace(pattern.blades, blades=pattern.blades.blades[:count])
        yield count, replace(pattern, blades=blades, matching=pattern.matching[:count - 1],
                             motions=pattern.motions[:count - 1])


def among(pattern: Pattern, count: int) -> Part:
    """The part without the blades after the first few."""
    gone = {n for blade in pattern.blades.blades[count:] for n in blade.numbers}
    return replace(pattern.part, faces=tuple(face for face in pattern.part.faces if face.number not in gone), bodies=(),
                   edges=tuple(edge for edge in pattern.part.edges if not gone.intersection(edge.faces)))


if __name__ == "__main__":
    main()
