"""Faces with bosses: passes beside the paper's, clean-up zones, division by distance and by iso-parametric cuts."""

import json
import time
from pathlib import Path

import numpy as np
from benchmarks._papers import GOUGE

import toolaxis as ta
from toolaxis.partition.bosses import distances
from toolaxis.partition.face_division import Divider
from toolaxis.partition.ring_division import RingDivision, candidates
from toolaxis.partition.shared_axes import trade
from toolaxis.plan.plan import Plan
from toolaxis.search.face_problem import task

FOLDER = Path(__file__).resolve().parent.parent / "examples"
BODY = {"stickout": 70, "holder": [(16, 0), (16, 40), (25, 40), (25, 80)]}
JOBS = (("boss", 4), ("bosses", 6))
#: Axes are shared in rings too where there are no more kinds of rings than around one boss.
MOST_RINGS = 3


def main() -> None:
    """Divide both ways, plan, and judge."""
    for name, count in JOBS:
        facts = json.loads((FOLDER / f"{name}.json").read_text("utf-8"))
        tool, part = ta.Tool.parse(facts["tool"], **BODY), ta.load(FOLDER / f"{name}.step")
        face = max(part.sculptured, key=lambda one: one.area)
        whole, around = divisions(name, part, face, (tool, facts["scallop"]))
        if len(around) <= MOST_RINGS:
            sharing(whole, around)
        start = time.perf_counter()
        plan = ta.plan(part, tool, facts["scallop"], faces=[face.number], regions=count, tolerance=GOUGE)
        planned = time.perf_counter()
        judged(plan, facts.get("published", {}).get("passes", []))
        print(f"    plan {planned - start:.1f} s, judge {time.perf_counter() - planned:.1f} s")


def short() -> None:
    """The divisions alone."""
    for name, _ in JOBS[:1]:
        part = ta.load(FOLDER / f"{name}.step")
        face = max(part.sculptured, key=lambda one: one.area)
        divisions(name, part, face, (ta.Tool.parse("torus:10x1", **BODY), 0.02))


def divisions(name: str, part: ta.Part, face: ta.Face,
              cut: tuple[ta.Tool, float]) -> tuple[Divider, tuple[RingDivision, ...]]:
    """Print reckoned length, links and clean-up included, by iso-parametric cuts and around the bosses."""
    tool, scallop = cut
    start = time.perf_counter()
    whole = Divider(task(face, tool, scallop, part=part, tolerance=GOUGE))
    curve = whole.curve
    cuts = time.perf_counter() - start
    around = candidates(whole, distances(face, tool, part))
    rows = [("iso-parametric cuts", curve), *((_ring(one), one.curve) for one in around)]
    shown = [n for n in (1, 2, 3, 4, 6, 8, 12, 16) if n < len(curve)]
    print(f"{name}: reckoned length, mm, by number of sub-surfaces ({cuts:.1f} s, around bosses "
          f"{time.perf_counter() - start - cuts:.1f} s more)")
    print(f"    {'':22}" + "".join(f"{n:8d}" for n in shown))
    for label, found in rows:
        print(f"    {label:22}" + "".join(f"{found[n]:8.0f}" if np.isfinite(found[n]) else f"{'-':>8}" for n in shown))
    return whole, around


def _ring(one: RingDivision) -> str:
    return f"rings of {one.radius:g} mm" if np.isfinite(one.radius) else "nearest boss"


def sharing(whole: Divider, around: tuple[RingDivision, ...]) -> None:
    """Print what sharing few axes comes to in pieces by cuts alone, as plans do, and in pieces of rings."""
    print("    reckoned length, mm, (sub-surfaces) by number of shared axes")
    for one in around:
        for part, found in zip(one.parts, one.solutions, strict=True):
            part.__dict__["best"] = found  # the axes that serve on the whole face serve here too
    for label, parts in (("iso-parametric cuts", (whole,)), *((_ring(one), one.parts) for one in around)):
        options = trade(parts, 6).options
        print(f"    {label:22}" + "".join(f"{one.orientations:3d}: {one.length:.0f} ({one.pieces})" for one in options),
              flush=True)


def judged(plan: Plan, published: list[int]) -> None:
    """Print every sub-surface with what the judge measured."""
    verdict = {seen.name: seen for seen in ta.verify(plan).operations}
    print(f"    {'':6} {'axis':22} {'feed':4} {'passes':>6} {'[zhu2016]':>9} {'width':>6} {'length':>8} "
          f"{'gouge um':>8} {'cutter/shank/holder':>20} {'clean-up %':>10} {'judge %':>8} {'verdict':7}")
    for k, op in enumerate(plan.operations):
        o, seen = op.orientation, verdict.get(op.name)
        if seen is None:
            print(f"    {op.face.label:6} {o.outcome}: {'; '.join(o.reasons)}")
            continue
        room = "/".join(f"{o.clearance.get(what, float('nan')):.2f}" for what in ("cutter", "shank", "holder"))
        axis = " ".join(f"{value:+.4f}" for value in op.frame.z + 0.0)
        there = published[k] if k < len(published) else "-"
        print(f"    {op.face.label:6} {axis:22} {o.feed:4} {o.passes:6d} {there:>9} "
              f"{o.average_strip_width:6.3f} {o.length:8.1f} {o.gouge * 1e3:8.2f} {room:>20} {o.unreached * 100:10.2f} "
              f"{100 * (1 - seen.share_within):8.2f} {'pass' if seen.passed else 'FAIL':7}")
        for reason in seen.reasons if not seen.passed else ():
            print(f"        {reason}")
    areas = sum(op.face.area for op in plan.operations)
    whole = plan.part.face(plan.operations[0].face.number).area
    left = sum(zone.area for op in plan.operations for zone in op.zones)
    also = sum(zone.elsewhere for op in plan.operations for zone in op.zones)
    print(f"    together {plan.length:.1f} mm, {left:.1f} of {whole:.1f} mm2 rest material, {also:.1f} of that "
          f"machined by other sub-surfaces; sub-surfaces and the face differ by {abs(areas / whole - 1):.1e}")


if __name__ == "__main__":
    main()
