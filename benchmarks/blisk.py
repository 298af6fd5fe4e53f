"""Parts with blades: time, memory and share of each stage, growth with the blades, passes beside [zhu2016] Table 6."""

import json
import os
import resource
import time
from itertools import pairwise
from pathlib import Path

import toolaxis as ta
from toolaxis.plan.plan import Plan
from toolaxis.progress import Progress

ROOT = Path(__file__).resolve().parent.parent
SHARED = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"
BODY = {"stickout": 70, "holder": [(10, 0), (10, 40), (25, 40), (25, 80)]}
#: A part, its tool, and where it comes from; the impeller's passages want a slim one.
JOBS = ((ROOT / "examples" / "blisk.step", "torus:10x1"), (SHARED / "kj66_impeller.step", "torus:4x0.5"))
STAGES = (("looking for blades", "blades found"), ("axes at the lattice", "division"), ("(1 of", "search and proof"),
          ("clean-up zones", "clean-up zones"), ("blade ", "turned and proven"), ("clearance to", "clearances"))


class Watch:
    """When each stage was heard of first, and each blade."""

    def __init__(self) -> None:
        self.began = time.perf_counter()
        self.first: dict[str, float] = {"loading": 0.0}
        self.blades: dict[str, float] = {}

    def report(self, stage: str, done: float, total: float) -> None:
        """Note a stage."""
        now = time.perf_counter() - self.began
        for mark, name in STAGES:
            if mark in stage and (mark != "blade " or stage.startswith(mark)):
                self.first.setdefault(name, now)
                if name == "turned and proven":
                    self.blades.setdefault(stage.partition(":")[0], now)
                return


def main() -> None:
    """Plan each part whole."""
    for path, name in JOBS:
        if not path.exists():
            print(f"{path.name}: skipped, {path} is not there (set TOOLAXIS_SHARED)")
            continue
        tool, watch = ta.Tool.parse(name, **BODY), Watch()
        plan = ta.plan(path, tool, 0.02, progress=Progress(watch.report))
        seconds = time.perf_counter() - watch.began
        told(path, plan, watch, seconds)


def told(path: Path, plan: Plan, watch: Watch, seconds: float) -> None:
    """Print what was measured."""
    memory = sum(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)) / 1e3
    print(f"{path.name}, {plan.tool.name}: {seconds:.1f} s, at most {memory:.0f} MB in this process and the largest "
          f"worker; {plan.outcome}, {sum(op.done for op in plan.operations)} of {len(plan.operations)} sub-surfaces")
    marks = [*sorted(watch.first.items(), key=lambda item: item[1]), ("", seconds)]
    for (stage, start), (_, end) in pairwise(marks):
        print(f"    {stage:20} {end - start:7.1f} s {100 * (end - start) / seconds:5.1f} %")
    if plan.blades is None:
        print(f"    no blades: {'; '.join(plan.part.warnings)}")
        return
    starts = sorted(watch.blades.values())
    if starts:
        shown = [k for k in (1, 2, 4, 8, 15) if k < len(starts)]
        print("    turned blades begun after: " + ", ".join(f"{k + 1}: {starts[k] - starts[0]:.1f} s" for k in shown))
    facts = path.with_suffix(".json")
    published = json.loads(facts.read_text("utf-8")).get("published", {}).get("passes", []) if facts.exists() else []
    print(f"    passes of [zhu2016] Table 6, on a blade whose shape is not published: {published}")
    for op in plan.operations:
        if plan.blades.blade_of(op.face.number) == 1 and op.done:
            found = op.orientation
            print(f"    {op.face.label:>6} {plan.blades.side_of(op.face.number):9} {found.passes:4d} passes, "
                  f"{found.length:7.1f} mm, strip {found.average_strip_width:.3f} mm, unreached {found.unreached:.3f}")
    print(f"    copies {len(plan.blades.copies)}, searched anew {len(plan.blades.searched)}; left to clean-up on the "
          f"first blade {plan.blades.blades[0].left:.1f} of {plan.blades.blades[0].area:.1f} mm2")


if __name__ == "__main__":
    main()
