"""Two-point contact of a flat end on the surface of [jang2021]: R = 30 mm, tolerance 0.03 mm, allowance 0.5 mm.

The paper's postures, curvature matching and the formula of two points, gouge where the surface bends along the feed;
beside them stand the least lean with one contact, the least constant lead (Sturz), and two contacts.  All follow
iso-parametric passes with full strips and the same links; the judge measures what they leave, and the planner of feeds
times them on the Mikron UCP 710 at 3 m/min.  The paper's own pass counts, 29 and 21, do not follow from full strips;
its Fig. 10 shows deviations without numbers.  ``--short`` prints the formula's rows and the paper's postures only.
"""

import json
import time
from pathlib import Path

import numpy as np

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.two_point import circle_strip_width, matched_lead, two_point_lead
from toolaxis.errors import ToolAxisError
from toolaxis.feed.five_axes import five_axis_time
from toolaxis.feed.schedule import Feeds
from toolaxis.machine.catalogue import load_machine
from toolaxis.orient.flat_plan import PROBES, TRIED, gouging, linked, told
from toolaxis.orient.flat_strips import Strip, lay_strips, strip
from toolaxis.orient.flat_tilt import postures
from toolaxis.orient.flat_work import Work
from toolaxis.orient.indexed import Task, task
from toolaxis.shape.face import Face
from toolaxis.tools.assembly import Tool
from toolaxis.verify.task import Task as Judged
from toolaxis.verify.verdict import OperationVerdict, judge

EXAMPLE = Path(__file__).parents[1] / "examples" / "biquintic.json"
R, D, A = 30.0, 0.03, 0.5
TOOL, MACHINE = Tool.flat(2 * R), "mikron-ucp-710"
FEEDS = Feeds(50.0, rapid=float("inf"), crossing=10000 / 60, smooth=True)


def face() -> Face:
    """The sample surface, its hollow side out of the material."""
    return Face.from_bspline(json.loads(EXAMPLE.read_text())["points"], (5, 5))


def formula() -> None:
    """Leans and widths of the formula, and the least radius of the sample surface."""
    print(f"R = {R:g}, d = {D} mm: one contact, two contacts (deg), widths (mm), ratio")
    for rho in (40.0, 60.0, 100.0, 240.0):
        one, two = matched_lead(R, rho), two_point_lead(R, rho, D)
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
            setting = Work(sample, TOOL, D, allowance=A).setting(np.column_stack([place, np.full(41, step)]), 1)
            rho = 1 / setting.curvatures()[1]
            lead = two_point_lead(R, rho, D) if two else matched_lead(R, rho)
            pace = np.linalg.norm(sample.evaluate(setting.uv).sv, axis=1)
            narrowest.append((circle_strip_width(R, rho, D, lead, D if two else 0.0) / pace).min())
        counts.append(float(np.mean(1 / np.array(narrowest))))
    print(f"passes by the formula's widths: {counts[0]:.2f} with one contact, {counts[1]:.2f} with two, ratio "
          f"{counts[0] / counts[1]:.3f} (printed: 29, 21, 1.38)")


def least_constant_lead(work: Work) -> tuple[float, str]:
    """The least constant lead at which no ring gouges at a grid of contacts, rad, and the way to lean."""
    *_, s0, s1 = work.span
    found = []
    for sense, leaning in ((1, "ahead"), (-1, "back")):
        along = np.linspace(*work.span[:2], 41)
        leans = [postures(work, along, float(step), sense).stand.lean.max() for step in np.linspace(s0, s1, 9)]
        found.append((float(max(leans)), leaning))
    return min(found)


def judged(path: ToolPath, sample: Face) -> OperationVerdict:
    """What the judge measures; gouges are followed to 1 mm."""
    return judge(Judged("op", path.cl, path.axis, path.kind, TOOL.profile, (sample,), D, A), spacing=1.0, threads=1)


def reckoned_passes(work: Work, leaning: str) -> float:
    """Passes that three strips tell of."""
    *_, s0, s1 = work.span
    wide = [strip(work, s0 + share * (s1 - s0), leaning).halves.sum(axis=1) for share in PROBES]
    return float((s1 - s0) * np.mean([1 / max(rows[rows > 0].min(initial=s1 - s0), 1e-3) for rows in wide]))


def row(title: str, job: Task, work: Work, leaning: str,
        proof: bool = False) -> tuple[tuple[Strip, ...], ToolPath, OperationVerdict] | None:
    """One line of the table."""
    begun = time.perf_counter()
    try:
        strips = lay_strips(work, leaning)
        path = linked(job, work, strips)
    except ToolAxisError as reason:
        print(f"{title:34} {leaning:7} none: {reason}", flush=True)
        return None
    taken = time.perf_counter() - begun
    proven = "-" if not proof else "no" if len(gouging(job, path)) else "yes"
    verdict = judged(path, job.worth.face)
    try:
        seconds = f"{five_axis_time(load_machine(MACHINE), path, FEEDS)[0].path:7.1f}"
    except ToolAxisError as reason:
        seconds = f"refused ({str(reason)[:40]})"
    deep = f"{verdict.gouge_max:.4f}" if verdict.gouge_max < 1 else "1 or more"
    cut = path.length(Motion.CUT)
    print(f"{title:34} {leaning:7} {path.passes:6d} {cut:8.0f} {seconds:>8} {verdict.scallop_max:8.4f} "
          f"{100 * verdict.share_within:7.2f} {deep:>9} {proven:>7} {taken:7.1f}", flush=True)
    return strips, path, verdict


def head() -> None:
    """Titles of the columns."""
    print(f"\n{'posture':34} {'leaning':7} {'passes':>6} {'cut mm':>8} {'time s':>8} {'left mm':>8} {'in %':>7} "
          f"{'gouge mm':>9} {'proven':>7} {'taken s':>7}")


def short() -> None:
    """The formula's rows and the paper's two postures, feed along u."""
    formula()
    reckoned()
    head()
    paper(task(face(), TOOL, D, allowance=A))


def paper(job: Task) -> None:
    """Curvature matching and the formula of two contacts."""
    for posture, title in (("matched", "curvature matched, as printed"), ("formula", "two points, as printed")):
        row(title, job, Work(job.worth.face, TOOL, D, "u", posture, allowance=A), "ahead")


def main() -> None:
    """All postures."""
    formula()
    reckoned()
    job = task(face(), TOOL, D, allowance=A)
    head()
    paper(job)
    for posture, title in (("one-point", "one contact, least lean"), ("two-point", "two contacts, gouge-free")):
        work = Work(job.worth.face, TOOL, D, "u", posture, allowance=A)
        found = sorted((reckoned_passes(work, leaning), leaning) for leaning in TRIED)
        made = next((one for one in (row(title, job, work, leaning, proof=True) for _, leaning in found) if one), None)
        print("   reckoned for each way to lean: " + ", ".join(f"{count:.1f} {leaning}" for count, leaning in found))
        if made is not None:
            print("   " + "; ".join(told(work, made[0])), flush=True)
    lead, leaning = least_constant_lead(Work(job.worth.face, TOOL, D, "u", "one-point", allowance=A))
    work = Work(job.worth.face, TOOL, D, "u", "sturz", lead, A)
    print(f"Sturz, least constant lead at 41 x 9 places: {np.degrees(lead):.2f} deg, leaning {leaning}, reckoned "
          f"{reckoned_passes(work, leaning):.1f} passes")


if __name__ == "__main__":
    main()
