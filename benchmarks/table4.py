"""[zhu2016] Table 4 rebuilt: three axes with a ball, one fixed axis, 3+2 axes divided, and five axes at once.

All with the paper's cutter, scallop and feed, the same holder, clearances and gouge limit, on the Mikron UCP 710 with
its limits of velocity, acceleration and jerk; entries, exits, links and index moves are timed too.  The five axes take
the best constant lead without tilt.  The paper's surface is not published: `examples/waves.step` looks like it and is
steeper, so what is to be compared is the ratio of times; `examples/freeform.step` is a gentle face.
"""

import time
from collections.abc import Mapping
from typing import Any

from benchmarks._papers import GOUGE
from benchmarks.division import PRINTED, TOOL, H
from benchmarks.examples import FOLDER

import toolaxis as ta
from toolaxis.plan.plan import Plan

MACHINE, FEED = "mikron-ucp-710", 3000.0
ROWS: tuple[tuple[str, Mapping[str, Any]], ...] = (
    ("5-axis, best constant lead", {"strategy": "sturz"}),
    ("3+2-axis, divided, length", {"orientations": 6}),
    ("3+2-axis, divided, time", {"orientations": 6, "objective": "time"}),
    ("3+2-axis, one axis, length", {"method": "one"}),
    ("3+2-axis, one axis, time", {"objective": "time"}),
    ("3-axis, ball end, mean normal", {"method": "ball"}))


def main() -> None:
    """The table for both faces, judged."""
    for name, orientations in (("waves", 6), ("freeform", 3)):
        table(name, orientations, judged=True)
    printed()


def short() -> None:
    """The table for the gentle face."""
    table("freeform", 3)
    printed()


def printed() -> None:
    """What the paper prints, with ratios to its five axes."""
    base_length, base_seconds = PRINTED[0][1:]
    for name, length, seconds in PRINTED:
        print(f"  printed: {name:30} {length:8.0f} mm {seconds:4d} s  x {length / base_length:5.3f} length "
              f"x {seconds / base_seconds:5.3f} time")


def table(name: str, orientations: int, judged: bool = False) -> None:
    """One face by every row, the time of five axes as the unit."""
    part = ta.load(FOLDER / f"{name}.step")
    print(f"{name}.step, {TOOL.name}, scallop {H} mm, {FEED:g} mm/min, {MACHINE}\n"
          f"  {'':30} sub axes pass   cut mm links mm |  cut s in/out  link index  total s x five | taken s")
    five = 0.0
    for title, asked in ROWS:
        words = {key: orientations if key == "orientations" else value for key, value in asked.items()}
        start = time.perf_counter()
        made = ta.plan(part, TOOL, H, machine=MACHINE, feedrate=FEED, workers=1, tolerance=GOUGE, **words)
        taken = time.perf_counter() - start
        five = five or made.seconds
        print(row(title, made, five) + f" {taken:7.1f}", flush=True)
        if judged and made.inputs.method == "sturz":
            print(f"  {verdict(made)}", flush=True)


def row(title: str, made: Plan, five: float) -> str:
    """One line of the table."""
    done = [op for op in made.operations if op.done]
    axes = "   -" if any(op.orientation.lead is not None for op in done) else f"{made.orientations:4d}"
    head = (f"  {title:30} {len(done):3d} {axes} {sum(op.orientation.passes for op in done):4d} {made.length:8.1f} "
            f"{made.length + made.travel:8.1f} |")
    if not made.timed or made.outcome != "complete":
        return f"{head} {made.outcome}: {'; '.join(op.orientation.reasons[0] for op in made.operations if not op.done)}"
    times = [op.time for op in done if op.time is not None]
    parts = [sum(getattr(one, kind) for one in times) for kind in ("cut", "entry", "exit", "link", "index")]
    return (f"{head} {parts[0]:6.1f} {parts[1] + parts[2]:6.1f} {parts[3]:5.1f} {parts[4]:5.1f} {made.seconds:8.1f} "
            f"{made.seconds / five:6.3f} |")


def verdict(made: Plan) -> str:
    """What the judge says."""
    found = ta.verify(made)
    most = max(op.gouge_max for op in found.operations)
    said = f"passed, deepest gouge {most:.4f} mm" if found.passed else found.reasons[0]
    return f"five axes judged by material removal: {said}"


if __name__ == "__main__":
    main()
