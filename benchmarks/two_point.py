"""Two-point contact of a flat end on the surface of [jang2021]: R = 30 mm, tolerance 0.03 mm, allowance 0.5 mm.

The paper's postures, curvature matching and the formula of two points, gouge where the surface bends along the feed,
with any tolerance in the formula.  Beside them stand postures that gouge nowhere: the least constant lead (Sturz), the
paper's leans raised point by point where they gouge, the formula's for parts of the tolerance, and two contacts.
All follow iso-parametric passes with full strips and the same links, along the parameter and leaning the way that is
reckoned to take the fewest; the judge measures what they leave, and the planner of feeds times them on the Mikron UCP
710 at 3 m/min; where the tip would crawl because the axis turns too fast, a line says so.  Rows are made in two
processes.  The paper's own pass counts, 29 and 21, do not follow from full strips; its Fig. 10 shows deviations
without numbers, as `two-point-deviations.png` in the folder out does.
``--short`` prints the formula's rows and the paper's postures only.
"""

import json
import multiprocessing
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from contextlib import redirect_stdout
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path

import numpy as np
from benchmarks._papers import GOUGE
from matplotlib import colormaps
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import ToolAxisError
from toolaxis.feed.fixed_axis_time import Feeds
from toolaxis.feed.moving_axis_time import five_axis_motion
from toolaxis.machine.library import load_machine
from toolaxis.plan.choices import FEEDS
from toolaxis.report.figures.plots import GREY, VERMILION, bare, cutting_lines, figure
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.shape.face import Face
from toolaxis.strategies.two_point.contact import (
    STEEPEST,
    circle_strip_width,
    match_lead,
    settle,
    two_point_lead,
)
from toolaxis.strategies.two_point.inputs import TwoPointInputs
from toolaxis.strategies.two_point.search import PROBES, TRIED, add_links, describe_contacts, gouging
from toolaxis.strategies.two_point.strips import lay_strips, nodes, strip
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool
from toolaxis.verify.task import VerificationTask as Judged
from toolaxis.verify.verdict import OperationVerdict, judge

EXAMPLE = Path(__file__).parents[1] / "examples" / "biquintic.json"
R, D, A = 30.0, 0.03, 0.5
TOOL, MACHINE = Tool.flat(2 * R), "mikron-ucp-710"
OUT, LIMITS = Path(__file__).parents[1] / "out", Tolerance(GOUGE)
#: The paper's postures and their titles.
PRINTED = (("matched", "curvature matched, as printed"), ("formula", "two points, as printed"))
#: Gouge-free postures, ours first: title, posture, and the share of the tolerance in the formula.
COMPARED = (("two contacts, gouge-free", "two-point", 1.0),
            ("matched, raised where it gouges", "matched-raised", 1.0),
            ("Sturz, least lead", "sturz", 1.0),
            ("formula for 0.5 d, raised", "formula-raised", 0.5),
            ("formula for 0.25 d, raised", "formula-raised", 0.25))
#: Distance of the judge's rays, mm: for postures that gouge by more than a millimetre, where each ray takes long, and
#: for all others.
COARSE, FINE = 2.0, 1.0
#: Feeds along which passes are so many times more are not looked at.
MORE = 1.5
PACE = Feeds(50.0, rapid=float("inf"), crossing=10000 / 60, smooth=True)


def face() -> Face:
    """The sample surface, its hollow side out of the material."""
    return Face.from_bspline(json.loads(EXAMPLE.read_text())["points"], (5, 5))


def formula() -> None:
    """Leans and widths of the formula, and the least radius of the sample surface."""
    print(f"R = {R:g}, d = {D} mm: one contact, two contacts (deg), widths (mm), ratio")
    for rho in (40.0, 60.0, 100.0, 240.0):
        one, two = match_lead(R, rho), two_point_lead(R, rho, D)
        w1, w2 = circle_strip_width(R, rho, D, one, 0.0), circle_strip_width(R, rho, D, two, D)
        print(f"  rho {rho:5.0f}: {np.degrees(one):8.4f} {np.degrees(two):8.4f} {w1:8.4f} {w2:8.4f} {w2 / w1:7.4f}")
    sample = face()
    uv = sample.grid(400, 400)
    k, d = sample.curvature(uv), sample.evaluate(uv)
    area = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    border = np.linspace(0, 1, 2001)
    edges = np.concatenate([np.column_stack([border, np.full(2001, side)])[:, ::step] for side in (0.0, 1.0)
                            for step in (1, -1)])
    tight = max(k.k1.max(), sample.curvature(edges).k1.max())
    print(f"sample surface: least radius of curvature {1 / tight:.3f} mm; tighter than the cutter on "
          f"{100 * float(area[k.k1 > 1 / R].sum() / area.sum()):.2f} % of the area")


def reckoned() -> None:
    """Passes that the formula's widths come to, feed along u: full strips, as wide as their narrowest place."""
    sample = face()
    place = np.linspace(0, 1, 41)
    counts = []
    for two in (False, True):
        narrowest = []
        for step in place:
            work = TwoPointInputs(sample, TOOL, D, allowance=A, limits=LIMITS)
            setting = work.setting(np.column_stack([place, np.full(41, step)]), 1)
            rho = 1 / setting.curvatures()[1]
            lead = two_point_lead(R, rho, D) if two else match_lead(R, rho)
            pace = np.linalg.norm(sample.evaluate(setting.uv).sv, axis=1)
            narrowest.append((circle_strip_width(R, rho, D, lead, D if two else 0.0) / pace).min())
        counts.append(float(np.mean(1 / np.array(narrowest))))
    print(f"passes by the formula's widths: {counts[0]:.2f} with one contact, {counts[1]:.2f} with two, ratio "
          f"{counts[0] / counts[1]:.3f} (printed: 29, 21, 1.38)")


def least_constant_lead(work: TwoPointInputs, leaning: str) -> float:
    """The least constant lead at which no ring gouges at a grid of contacts on passes and beyond their ends, rad."""
    *_, s0, s1 = work.span
    sense = 1 if leaning == "ahead" else -1
    leans = []
    for step in s0 + (s1 - s0) * np.array([0.01, 0.03, 0.05, *np.linspace(0.1, 0.9, 9), 0.95, 0.97, 0.99]):
        setting = work.setting(work.uv(nodes(work, float(step)), float(step)), sense)
        stand, ring = settle(setting, 0.0)
        leans.append(np.where((stand.lift <= 1e-4) & (ring.least >= -1e-4), stand.lean, STEEPEST).max())
    return float(max(leans))


def judged(path: ToolPath, sample: Face, spacing: float = FINE) -> OperationVerdict:
    """What the judge measures; gouges are followed to 1 mm."""
    return judge(Judged("op", path.cl, path.axis, path.kind, TOOL.profile, (sample,), D, A,
                        tolerance=LIMITS), spacing=spacing, threads=1)


def reckoned_passes(work: TwoPointInputs, leaning: str) -> float:
    """Passes that three strips tell of."""
    *_, s0, s1 = work.span
    wide = [strip(work, s0 + share * (s1 - s0), leaning).halves.sum(axis=1) for share in PROBES]
    return float((s1 - s0) * np.mean([1 / max(rows[rows > 0].min(initial=s1 - s0), 1e-3) for rows in wide]))


@dataclass(frozen=True)
class TwoPointRow:
    """One line of the table, for the picture."""

    title: str
    path: ToolPath
    verdict: OperationVerdict
    proven: bool


def row(title: str, job: FaceProblem, work: TwoPointInputs, leaning: str, proof: bool = False,
        must: bool = False) -> TwoPointRow | None:
    """One line of the table; where it must be proven and is not, a short one without the judge's word."""
    begun = time.perf_counter()
    where = f"{work.feed}, {leaning}"
    try:
        strips = lay_strips(work, leaning)
        path = add_links(job, work, strips)
    except ToolAxisError as reason:
        print(f"{title:34} {where:9} none: {reason}", flush=True)
        return None
    taken = time.perf_counter() - begun
    proven = "-" if not proof else "no" if len(gouging(job, path)) else "yes"
    cut = path.length(Motion.CUT)
    if must and proven == "no":
        print(f"{title:34} {where:9} {path.passes:6d} {cut:8.0f} not proven: a steeper one follows", flush=True)
        return None
    verdict = judged(path, job.worth.face, FINE if proof else COARSE)
    seconds, crawls = timed(path)
    deep = f"{verdict.gouge_max:.4f}" if verdict.gouge_max < 1 else "1 or more"
    print(f"{title:34} {where:9} {path.passes:6d} {cut:8.0f} {seconds:>8} {verdict.scallop_max:8.4f} "
          f"{100 * verdict.share_within:7.2f} {deep:>9} {proven:>7} {taken:7.1f}{crawls}", flush=True)
    if proof and work.posture == "two-point":
        print("   " + "; ".join(describe_contacts(work, strips)), flush=True)
    return TwoPointRow(title, path, verdict, proven == "yes")


def timed(path: ToolPath) -> tuple[str, str]:
    """Time of a path, and a line on where its tip crawls, if it does."""
    try:
        made = five_axis_motion(load_machine(MACHINE), path, PACE)
    except ToolAxisError:
        return "refused", ""
    crawl = made.crawl
    return f"{made.time.path:7.1f}", "" if crawl is None else (
        f"\n   the axis turns so fast that the tip crawls for {crawl.seconds:.2f} s on {crawl.way:.2f} mm at "
        f"{np.round(crawl.place, 1).tolist()}")


def head() -> None:
    """Titles of the columns."""
    print(f"\n{'posture':34} {'leaning':9} {'passes':>6} {'cut mm':>8} {'time s':>8} {'left mm':>8} {'in %':>7} "
          f"{'gouge mm':>9} {'proven':>7} {'taken s':>7}")


def short() -> None:
    """The formula's rows and the paper's two postures, feed along u."""
    formula()
    reckoned()
    head()
    paper(task(face(), TOOL, D, allowance=A, tolerance=GOUGE))


def paper(job: FaceProblem) -> list[TwoPointRow]:
    """Curvature matching and the formula of two contacts."""
    rows = [printed(job, posture, title) for posture, title in PRINTED]
    return [one for one in rows if one is not None]


def printed(job: FaceProblem, posture: str, title: str) -> TwoPointRow | None:
    """One of the paper's postures."""
    return row(title, job, TwoPointInputs(job.worth.face, TOOL, D, "u", posture, allowance=A, limits=LIMITS), "ahead")


def feeds(job: FaceProblem) -> tuple[str, ...]:
    """Feeds that are looked at: along which passes with one contact are not far more than along the other."""
    works = [TwoPointInputs(job.worth.face, TOOL, D, feed, "one-point", allowance=A, limits=LIMITS) for feed in FEEDS]
    counts = {work.feed: min(reckoned_passes(work, leaning) for leaning in TRIED) for work in works}
    told_of = ", ".join(f"{count:.1f} along {feed}" for feed, count in counts.items())
    print(f"passes reckoned with one contact: {told_of}")
    return tuple(feed for feed, count in counts.items() if count <= MORE * min(counts.values()))


def fewest(title: str, job: FaceProblem, along: tuple[str, ...], posture: str, share: float) -> TwoPointRow | None:
    """A gouge-free posture laid the way that is reckoned to take the fewest passes."""
    found = []
    for feed in along:
        work = TwoPointInputs(job.worth.face, TOOL, D, feed, posture, allowance=A, limits=LIMITS, share=share)
        for leaning in TRIED if posture != "sturz" else TRIED[:2]:
            own = work if posture != "sturz" else replace(work, lead=least_constant_lead(work, leaning))
            found.append((reckoned_passes(own, leaning), f"{feed}, {leaning}", own, leaning))
    found.sort(key=lambda one: one[:2])
    print("   reckoned: " + "; ".join(f"{where} {count:.1f}" for count, where, *_ in found), flush=True)
    if posture == "sturz":
        return steeper(title, job, *found[0][2:])
    return next((one for one in (row(title, job, work, leaning, proof=True) for *_, work, leaning in found) if one),
                None)


def steeper(title: str, job: FaceProblem, work: TwoPointInputs, leaning: str) -> TwoPointRow | None:
    """A constant lead, half a degree more at a time until the whole path is proven: contacts between those looked at
    may ask for more."""
    while True:
        last = work.lead >= STEEPEST
        made = row(f"{title} {np.degrees(work.lead):.2f} deg", job, work, leaning, proof=True, must=not last)
        if made is not None or last:
            return made
        work = replace(work, lead=min(work.lead + np.radians(0.5), STEEPEST))


def apart(make: Callable[..., TwoPointRow | None], *given: object) -> tuple[str, TwoPointRow | None]:
    """What a row prints, and the row: made in a process of its own."""
    with redirect_stdout(StringIO()) as text:
        made = make(*given)
    return text.getvalue(), made


def main() -> None:
    """All postures."""
    formula()
    reckoned()
    job = task(face(), TOOL, D, allowance=A, tolerance=GOUGE)
    along = feeds(job)
    head()
    rows: list[TwoPointRow | None] = []
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        # Two contacts take longest and go first.
        free = [pool.submit(apart, fewest, title, job, along, posture, share) for title, posture, share in COMPARED]
        for one in [*(pool.submit(apart, printed, job, *given) for given in PRINTED), *free]:
            text, made = one.result()
            print(text, end="", flush=True)
            rows.append(made)
    made_free = [one for one in rows[len(PRINTED):] if one is not None]
    for one in made_free:
        print(f"{one.title}: {one.path.passes / made_free[0].path.passes:.2f} times the passes of two contacts and "
              f"{one.path.length(Motion.CUT) / made_free[0].path.length(Motion.CUT):.2f} times their length (printed: "
              "1.38)")
    OUT.mkdir(parents=True, exist_ok=True)
    deviations([one for one in rows if one is not None]).savefig(OUT / "two-point-deviations.png", dpi=110)
    print(f"deviations are drawn in {OUT / 'two-point-deviations.png'}")


def deviations(rows: list[TwoPointRow]) -> Figure:
    """What each posture leaves and takes too much, seen from above the surface; beside [jang2021] Fig. 10."""
    columns = 3
    made = figure(4.2 * columns, 3.1 * -(-len(rows) // columns))
    axes = made.subplots(-(-len(rows) // columns), columns, squeeze=False).ravel()
    shades = ListedColormap(colormaps["viridis"](np.linspace(0, 1, 64)))
    image = None
    for ax, one in zip(axes, rows, strict=False):
        area = one.verdict.maps[0]
        left = np.where(area.gouge > GOUGE, -1.0, 1000 * area.remaining)
        size = 5.0 * max(one.verdict.spacing, 1.0) ** 2
        image = ax.scatter(area.point[:, 0], area.point[:, 1], c=left, s=size, linewidths=0, rasterized=True,
                           cmap=shades.with_extremes(under=VERMILION, over=GREY), norm=Normalize(0, 1000 * D * 1.02))
        for line in cutting_lines(one.path):
            ax.plot(line[:, 0], line[:, 1], color="white", linewidth=0.4)
        deep = f"gouge {1000 * one.verdict.gouge_max:.1f} µm" if one.verdict.gouge_max < 1 else "gouge 1 mm or more"
        ax.set_title(f"{one.title}\n{one.path.passes} passes, {deep}", fontsize=8)
        ax.set_aspect("equal")
        bare(ax)
    for ax in axes[len(rows):]:
        ax.set_visible(False)
    if image is not None:
        bar = made.colorbar(image, ax=list(axes), extend="both", shrink=0.6)
        bar.set_label("left, µm; orange: gouged by more than 2 µm")
    return made


if __name__ == "__main__":
    main()
