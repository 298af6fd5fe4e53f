"""Every example part planned and judged: passes, strip width, gouge and what the judge measured."""

import time
from pathlib import Path

import toolaxis as ta
from toolaxis.plan.plan import Plan
from toolaxis.verify.verdict import Verdict

FOLDER = Path(__file__).resolve().parent.parent / "examples"
BODY = {"stickout": 70, "holder": [(16, 0), (16, 40), (25, 40), (25, 80)]}

#: Part and cutter: the paper's D12 r1, D16 r2 for the trimmed patch; the larger parts take cutters of their size.
JOBS = (("freeform", "torus:12x1", 0.02), ("saddle", "torus:12x1", 0.02), ("trimmed", "torus:16x2", 0.02),
        ("hyperbolic_paraboloid", "torus:12x1", 0.02), ("hyperbolic_paraboloid_rules", "torus:12x1", 0.02),
        ("manta", "torus:40x5", 0.05), ("biquintic", "torus:20x3", 0.03))


def main() -> None:
    """Plan and judge every example."""
    print(f"{'part':28} {'tool':11} {'h mm':>5} {'feed':4} {'passes':>6} {'width':>6} {'length':>8} {'gouge um':>8} "
          f"{'holder':>6} | {'left um':>7} {'% in 1.02 h':>11} {'gouge um':>8} {'clean-up %':>10} {'verdict':7} "
          f"{'plan s':>6} {'judge s':>7}")
    for name, text, scallop in JOBS:
        start = time.perf_counter()
        plan = ta.plan(FOLDER / f"{name}.step", ta.Tool.parse(text, **BODY), scallop)
        planned = time.perf_counter()
        verdict = ta.verify(plan)
        judged = time.perf_counter()
        row(name, text, plan, verdict)
        print(f" {planned - start:6.1f} {judged - planned:7.1f}")
        for reason in (*(r for op in plan.operations for r in op.orientation.reasons if not op.done), *verdict.reasons):
            print(f"    {reason}")


def row(name: str, text: str, plan: Plan, verdict: Verdict) -> None:
    """Print one part's figures without the times."""
    for op, seen in zip([op for op in plan.operations if op.done], verdict.operations, strict=True):
        o = op.orientation
        print(f"{name:28} {text:11} {seen.scallop_limit:5.2f} {o.feed:4} {o.passes:6d} {o.average_strip_width:6.3f} "
              f"{o.length:8.1f} {o.gouge * 1e3:8.2f} {o.clearance.get('holder', float('nan')):6.2f} | "
              f"{seen.scallop_max * 1e3:7.2f} {seen.share_within * 100:11.3f} {seen.gouge_max * 1e3:8.2f} "
              f"{o.unreached * 100:10.2f} {'pass' if seen.passed else 'FAIL':7}", end="")


if __name__ == "__main__":
    main()
