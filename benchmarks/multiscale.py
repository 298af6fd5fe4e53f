"""Strip width and roughness together: the numbers of [dong2023], and its experiment on another freeform face.

The paper's cutter (R 5, r 3 mm, four teeth), feed (800 mm/min) and speed (4800/min) on the middle 37 x 28 mm of
examples/freeform.step, whose radii of curvature begin at 90 mm; the paper's own surface is not published.  Passes are
laid so that Sturz milling at 20 degrees has the mean Ra of its Table 1, 1.425 um.  On the very same passes the rotary
axes of a BC table-table turn least while all strips are at least so wide: the whole front of strip width, Ra and
turning.  Ra is evaluated at 90 places over 4 mm, by the passes' profiles and by the judge, which removes material at
each tooth's position.  ``--short`` leaves out all but the numbers.
"""

import time
from pathlib import Path

import numpy as np
from benchmarks._papers import GOUGE

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.contact.placement import place
from toolaxis.errors import ToolAxisError
from toolaxis.machine.setup import Mounting
from toolaxis.path.moving_axis import ConstantLeadField, MovingChart, MovingCut
from toolaxis.path.pass_layout import Layout, lay_out
from toolaxis.search.face_problem import task
from toolaxis.strategies.roughness.feasible_area import critical_curvature, least_lean
from toolaxis.strategies.roughness.paper_iteration import iterate_as_published
from toolaxis.strategies.roughness.pass_constraints import OrientationRequirements, PassConstraints, spline_along_axes
from toolaxis.strategies.roughness.passes import spots
from toolaxis.strategies.roughness.pictures import front_picture
from toolaxis.strategies.roughness.plan import constant_lead
from toolaxis.strategies.roughness.rotary_spline import even_knots, smoothest
from toolaxis.strategies.roughness.roughness import arithmetic_roughness, step_of_roughness
from toolaxis.strategies.roughness.search import NOMINAL, RoughnessSearch
from toolaxis.strategies.roughness.section_width import expect_widths, section_parameters, section_points
from toolaxis.strategies.roughness.smoothing import smooth_axes
from toolaxis.verify.material_removal import removal

EXAMPLES, OUT = (Path(__file__).parents[1] / name for name in ("examples", "out"))
TOOL, H, FEED, TEETH = ta.Tool.torus(10, 3), 0.1, 800.0, 4 * 4800
RA, MEAN, LENGTH = 1.6e-3, 1.425e-3, 4.0
LEAST = (2.1529, 2.6, 2.8, 2.9, 3.0)


def numbers() -> None:
    """What the paper's formulas come to, and how exactly the borders and constraints are met."""
    low, high = expect_widths(TOOL, NOMINAL, H)
    print(f"expected strip width, R 5, r 3, 20 deg, h = 0.1 mm: {low:.4f} to {high:.4f} mm (2.1529, 3.1529)")
    print(f"Ra 1.6 um at passes {float(step_of_roughness(TOOL, RA, NOMINAL)):.5f} mm apart on a plane (0.66434)")
    rng = np.random.default_rng(0)
    k1 = rng.uniform(-0.1, 0.3, 100000)
    k2, gamma = k1 - rng.uniform(0, 0.3, 100000), rng.uniform(-np.pi, np.pi, 100000)
    lean = least_lean(TOOL, (k1, k2), gamma)
    on = (lean > 0) & np.isfinite(lean)
    off = np.abs(critical_curvature(TOOL, (k1[on], k2[on]), lean[on], gamma[on])[0]).max()
    print(f"border of the feasible area: critical curvature {off:.1e} 1/mm at most on {on.sum()} borders")
    missed = 0.0
    for seed in range(100):
        rng = np.random.default_rng(seed)
        places = np.sort(np.concatenate([[0.0, 1.0], rng.uniform(0, 1, 98)]))
        at, angles = places[::15], rng.normal(size=(7, 2))
        one = smoothest(even_knots(0, 1, 24), places, rng.uniform(0.02, 0.2, 99), (at, angles))
        missed = max(missed, float(np.abs(one.angles(at) - angles).max()))
    print(f"fixed angles of 100 splines are met to {missed:.1e} rad", flush=True)


def region() -> ta.Face:
    """The middle of the example's face."""
    face = ta.load(EXAMPLES / "freeform.step").sculptured[0]
    (u0, u1), (v0, v1) = (0.25, 0.75), (0.25, 0.75)
    return ta.Face(face.surface, (np.array([[u0, v0], [u1, v0], [u1, v1], [u0, v1]]),), face.flip, face.number)


def laid(search: RoughnessSearch) -> Layout:
    """Passes on which Sturz milling has the wanted mean Ra."""
    height = 1.2 * search.height
    for _ in range(3):
        chart = MovingChart(search.face, "u")
        mean = search.face.normal(search.face.grid(9, 9)).mean(axis=0)
        placed = lay_out(chart, MovingCut(TOOL, mean, height, 0.0, field=ConstantLeadField(NOMINAL, "u")))
        ra = constant_lead(search, placed, NOMINAL)[2].mean()
        if abs(ra / MEAN - 1) < 0.004:
            break
        height *= MEAN / ra
    return placed


def by_the_judge(cut: MovingCut, placed: Layout, uv: np.ndarray) -> np.ndarray:
    """Ra at places, mm, by removing material at the positions of all teeth."""
    face, tips, axes = placed.chart.face, [], []
    for low, high, step in placed.pieces:
        fine = np.linspace(low, high, 400)
        way = np.linalg.norm(np.diff(face.evaluate(np.column_stack([fine, np.full(400, step)])).point, axis=0), axis=1)
        at = np.interp(np.arange(0.0, way.sum(), FEED / TEETH), np.append(0.0, np.cumsum(way)), fine)
        rows = np.column_stack([at, np.full(len(at), step)])
        axes.append(cut.axes(face, rows))
        tips.append(place(face, TOOL, rows, axes[-1]))
    tip, axis = np.concatenate(tips), np.concatenate(axes)
    # Every position is a motion that goes nowhere; what lies between two of them is no cut.
    cl = np.repeat(tip, 2, axis=0)
    cl[1::2] += 1e-9 * np.array([1.0, 0.0, 0.0])
    kind = np.tile([int(Motion.LINK), int(Motion.CUT)], len(tip))
    points, normal = section_points(face, section_parameters(face, uv, np.linspace(-0.5, 0.5, 321) * LENGTH, "u"))
    left = removal((cl, np.repeat(axis, 2, axis=0), kind), TOOL.profile,
                   (points.reshape(-1, 3), normal.reshape(-1, 3)), depth=0.05, height=0.5, among=(int(Motion.CUT),),
                   threads=1)
    return arithmetic_roughness(left.remaining.reshape(len(uv), -1))


def row(title: str, widths: np.ndarray, ra: np.ndarray, judged: np.ndarray | None, cost: float, taken: float) -> None:
    """One line of the table."""
    seen = "" if judged is None else (f" {1000 * judged.mean():7.3f} {1000 * judged.max():7.3f} "
                                      f"{int((judged > RA).sum()):5d}")
    print(f"{title:34} {widths.min():6.3f} {widths.max():6.3f} {1000 * ra.mean():7.3f} {1000 * ra.max():7.3f} "
          f"{int((ra > RA).sum()):5d} {cost:9.4f} {taken:6.0f}{seen}", flush=True)


def paper_loop(search: RoughnessSearch, placed: Layout, wish: OrientationRequirements) -> str:
    """The loop of the paper on all passes: its sum and ours with the same ends and coefficients."""
    a0, a1, _, _ = placed.chart.bounds
    sums, failed = np.zeros(2), 0
    for piece in placed.pieces[::6]:
        lane = search.lane(piece, "u", (placed.steps, a0, a1), wish)
        try:
            loop = iterate_as_published(lane, NOMINAL)
        except ToolAxisError:
            failed += 1
            continue
        ours = smooth_axes(loop.lane, loop.spline, loop.spline.angles(lane.places[[0, -1]]))
        sums += loop.cost, ours.cost if ours.kept else np.inf
    return (f"every sixth pass, ends at 20 deg: sum {sums[0]:.4f} by the paper's loop, {sums[1]:.4f} with the "
            f"conditions themselves; the loop found nothing on {failed}")


def main() -> None:
    """The numbers, Sturz milling beside ours, and the front."""
    numbers()
    face = region()
    job = task(face, TOOL, H, Mounting(ta.load_machine("bc-table-table")), tolerance=GOUGE)
    search = RoughnessSearch(job, RA, FEED)
    placed = laid(search)
    uv = spots(face, "u", LENGTH)
    cut, widths, ra = constant_lead(search, placed, NOMINAL)
    a0, a1, _, _ = placed.chart.bounds
    lanes = [search.lane(piece, "u", (placed.steps, a0, a1)) for piece in placed.pieces]
    sturz = sum(lane_cost(lane, cut) for lane in lanes)
    print(f"\n{len(placed.steps)} passes over {face.area:.0f} mm2, Ra at {len(uv)} places over {LENGTH:g} mm")
    print(f"{'':34} {'W from':>6} {'to mm':>6} {'Ra um':>7} {'most':>7} {'> 1.6':>5} {'turning':>9} {'s':>6} "
          f"{'judge':>7} {'most':>7} {'> 1.6':>5}")
    row("Sturz, 20 deg", widths, ra, by_the_judge(cut, placed, uv), sturz, 0.0)
    high, front = search.wish.widths[1], [("Sturz, 20°", float(widths.min()), 1000 * float(ra.mean()), float(sturz))]
    for low in LEAST:
        began = time.perf_counter()
        try:
            found = search.along(placed, OrientationRequirements(H, (low, high), RA, search.wish.leans))
        except ToolAxisError as reason:
            print(f"{f'strips of {low} mm at least':34} none: {reason}", flush=True)
            continue
        judged = by_the_judge(found.cut, placed, found.uv)
        row(f"strips of {low} mm at least", found.widths, found.roughness, judged, found.cost,
            time.perf_counter() - began)
        front.append(("", float(found.widths.min()), 1000 * float(found.roughness.mean()), found.cost))
    OUT.mkdir(exist_ok=True)
    front_picture(front, 1000 * RA).savefig(OUT / "multiscale-front.png", dpi=110)
    print(f"the front is drawn in {OUT / 'multiscale-front.png'}")
    print(paper_loop(search, placed, OrientationRequirements(H, (LEAST[2], high), 1.0, search.wish.leans)))


def lane_cost(lane: PassConstraints, cut: MovingCut) -> float:
    """Sum of squared angular velocities of a constant lead along a pass, (rad/s)^2."""
    return spline_along_axes(lane, cut.axes(lane.face, lane.uv)).cost(lane.places, lane.durations)


def short() -> None:
    """The numbers."""
    numbers()


if __name__ == "__main__":
    main()
