"""Searches side by side: hemisphere, the paper's sectors, dense brute force, Roman's rule and the mean normal.

Brute force takes every axis of a grid of the hemisphere; see `benchmarks._brute` for the bound that spares it most of
the counts, or give `--full` to do without (hours).  Evaluations are axes looked at, closer looks and exact counts; the
axes that normals exclude beforehand are counted for none of the three.
"""

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from math import radians
from pathlib import Path

import numpy as np
from benchmarks._brute import audit, least_length
from benchmarks._papers import GOUGE

import toolaxis as ta
from toolaxis.plan.orientation import REASONS
from toolaxis.search.direction_grid import spiral
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.search.hemisphere import frame_of, search
from toolaxis.search.local_search import CountedAxis
from toolaxis.search.sectors import mean_normal, roman_axis, sectors

ROOT = Path(__file__).resolve().parent.parent
SCALLOP = 0.02
TOOL = ta.Tool.torus(12, 1)
EXAMPLES = ("freeform", "saddle", "trimmed", "hyperbolic_paraboloid", "biquintic")
SEEDS = ((0, 1.5), (0, 3.0), (1, 2.5), (4, 2.0))


@dataclass(frozen=True)
class SearchRow:
    """One line of the table: cutting length by exact count, mm (inf where nothing is free), and what it took."""

    method: str
    length: float
    evaluations: int
    seconds: float
    note: str = ""


def seeded(seed: int, height: float) -> ta.Face:
    """A bumpy patch of 6 x 5 control points, 60 x 60 mm."""
    x, y = np.meshgrid(np.linspace(-30, 30, 6), np.linspace(-30, 30, 5), indexing="ij")
    z = height * np.random.default_rng(seed).normal(size=x.shape)
    return ta.Face.from_bspline(np.stack([x, y, z], axis=-1))


def faces() -> dict[str, Callable[[], ta.Face]]:
    """Makers of the faces, by name."""
    made: dict[str, Callable[[], ta.Face]] = {
        name: (lambda n=name: max(ta.load(ROOT / "examples" / f"{n}.step").sculptured, key=lambda f: f.area))
        for name in EXAMPLES}
    made.update({f"seed {s}, {h:g} mm": (lambda s=s, h=h: seeded(s, h)) for s, h in SEEDS})
    return made


def first_proven(job: FaceProblem, found: list[CountedAxis]) -> CountedAxis | None:
    """The best candidate that the proof form accepts."""
    return next((one for one in found if job.feasibility.witness(one.axis) is None), None)


def by_search(job: FaceProblem, name: str, method: Callable[[AxisTable], list[CountedAxis]]) -> SearchRow:
    """One of the two searches, with the proof form on its answer."""
    ledger = AxisTable(job.feasibility, job.worth)
    start = time.perf_counter()
    best = first_proven(job, method(ledger))
    spent = time.perf_counter() - start
    return SearchRow(name, np.inf if best is None else best.value, ledger.evaluations, spent,
                     "nothing free" if best is None else f"{ledger.counts} counts")


def brute_force(job: FaceProblem, spacing: float, full: bool) -> SearchRow:
    """Every axis of a grid; the best that the proof form accepts."""
    start = time.perf_counter()
    grid = spiral(frame_of(job.feasibility.normals), spacing)
    found = least_length(job.feasibility, job.worth, grid, full)
    spent = time.perf_counter() - start
    audit(job.worth, found)
    return SearchRow("brute force", found.length, found.visible, spent,
                     f"of {len(grid)}; {found.counted} counts, {found.audited} more: "
                     f"count over bound >= {found.lowest:.3f}")


def baseline(job: FaceProblem, name: str, rule: Callable[[AxisTable], np.ndarray]) -> SearchRow:
    """A rule that gives one axis: its value where the proof form accepts it, else the reason why not."""
    ledger = AxisTable(job.feasibility, job.worth)
    start = time.perf_counter()
    axis = rule(ledger)
    witness = job.feasibility.witness(axis)
    value = np.inf if witness else min(job.worth.counted(axis, feed)[1] for feed in "uv")
    spent = time.perf_counter() - start
    note = "" if witness is None else f"refused: {REASONS[witness.reason]}"
    return SearchRow(name, value, ledger.evaluations + 2, spent, note)


def compare(face: ta.Face, spacing: float, full: bool) -> list[SearchRow]:
    """All methods on one face."""
    job = task(face, TOOL, SCALLOP, tolerance=GOUGE)
    by_search(job, "warm-up", search)
    return [by_search(job, "hemisphere", search), by_search(job, "sectors", sectors),
            brute_force(job, spacing, full), baseline(job, "Roman's rule", roman_axis),
            baseline(job, "mean normal", mean_normal)]


def show(name: str, rows: list[SearchRow]) -> None:
    """Print one face's lines."""
    ours, paper, dense = rows[:3]
    for row in rows:
        share = dense.length / row.length if np.isfinite(row.length) else 0.0
        print(f"{name:24} {row.method:13} {row.length:10.1f} {share:8.4f} {row.evaluations:8d} {row.seconds:9.2f}  "
              f"{row.note}", flush=True)
    print(f"{'':24} hemisphere: {paper.length / ours.length:.5f} of the sectors' value, 1/"
          f"{dense.evaluations / ours.evaluations:.0f} of brute force's evaluations, "
          f"1/{paper.evaluations / ours.evaluations:.1f} of the sectors'", flush=True)


def main(chosen: tuple[str, ...] = (), spacing_deg: float = 0.5, full: bool = False) -> None:
    """Print the comparison; value = brute force's cutting length over the method's."""
    print(f"{TOOL.name}, scallop {SCALLOP} mm, grid {spacing_deg:g} deg, objective length")
    print(f"{'face':24} {'method':13} {'length':>10} {'value':>8} {'axes':>8} {'seconds':>9}")
    for name, make in faces().items():
        if not chosen or name in chosen:
            show(name, compare(make(), radians(spacing_deg), full))


if __name__ == "__main__":
    main(tuple(a for a in sys.argv[1:] if not a.startswith("--")), full="--full" in sys.argv)
