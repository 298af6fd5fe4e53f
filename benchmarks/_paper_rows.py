"""Rows of the manual's pages on the papers: a quantity, what is printed, and what the same data gives here."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from benchmarks._blades import sections
from numpy.typing import NDArray

from toolaxis.contact.clearance.gouge import penetration
from toolaxis.contact.frame import axis_from_lean, contact_frame
from toolaxis.contact.strip.width import strip_width
from toolaxis.feed.fixed_axis_time import Feeds
from toolaxis.feed.jerk_profile import travel_time
from toolaxis.machine.feed_polytopes import Level, alignments, best_along, preferred_direction
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.corner_rounding import corner
from toolaxis.search.fastest_setup import cutting_seconds
from toolaxis.search.kinematic_setup import PassSegment, find_setup
from toolaxis.shape.analytic import PlanarSurface
from toolaxis.shape.face import Face
from toolaxis.strategies.blade.angle_channel import channel
from toolaxis.strategies.blade.section import Section, base_of, section
from toolaxis.strategies.roughness.rotary_spline import basis, even_knots, rates, smoothest
from toolaxis.strategies.roughness.roughness import step_of_roughness
from toolaxis.strategies.roughness.section_width import expect_widths, section_width
from toolaxis.strategies.two_point.contact import circle_strip_width, match_lead, settle, two_point_lead
from toolaxis.strategies.two_point.rings import ContactSet, Posture, rings
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
PLANE = Face(PlanarSurface((-30.0, 30.0), (-30.0, 30.0)).nurbs())

#: Passes and average strip widths of [zhu2016] Tables 5 and 6.
PASSES_AND_WIDTHS = (
    (19, 0.05389),
    (24, 0.04228),
    (22, 0.04381),
    (17, 0.06019),
    (34, 0.02951),
    (25, 0.04084),
    (34, 0.02968),
    (33, 0.03077),
    (38, 0.02667),
    (41, 0.02439),
    (12, 0.08387),
    (12, 0.08472),
)
#: Its Table 2: average strip width by the estimate and by passes made, and the seconds of both.
ESTIMATES = (
    (0.034522195, 0.0336397, 0.346, 16.126),
    (0.036417175, 0.0353815, 0.351, 15.654),
    (0.031561425, 0.0300705, 0.353, 19.05),
)
#: Its Table 4: path length, mm, and machining time, s, of five axes, one fixed axis, 3+2 axes and a ball end.
LENGTHS_AND_TIMES = ((3927.03, 194.58), (8976.06, 443.79), (5720.1, 359.3), (11684.1, 576.1))

#: [dong2023] Tables 1 and 2: Ra in um at 90 places, with Sturz milling and with its method.
STURZ_RA = """
    1.220 1.252 1.381 1.158 1.286 1.295 1.573 1.081 1.292
    1.330 1.292 1.312 1.275 1.249 1.243 1.201 1.194 1.838
    1.548 1.427 1.363 1.440 2.087 1.265 1.098 1.461 0.905
    1.582 1.615 1.467 1.563 1.343 1.389 1.146 1.230 1.215
    1.599 1.412 1.456 1.485 1.436 1.326 1.331 1.302 1.183
    1.477 1.509 1.553 1.523 1.299 1.404 1.345 1.111 1.898
    1.510 1.505 1.605 1.609 1.365 1.465 1.340 1.258 1.118
    1.513 2.027 1.710 1.482 1.557 1.684 1.326 1.395 1.316
    1.607 1.510 1.539 1.631 1.496 1.511 1.421 1.289 1.186
    1.580 1.472 1.720 1.464 1.580 1.985 1.368 1.491 1.311
"""
MULTISCALE_RA = """
    0.869 0.839 0.910 0.828 0.921 0.800 0.791 0.745 0.719
    0.968 0.876 1.025 1.090 1.024 0.908 0.909 0.766 0.791
    1.070 1.060 1.148 1.125 1.159 1.141 1.029 0.926 0.852
    1.198 1.128 1.175 1.100 1.271 1.108 1.032 0.980 0.852
    1.183 1.199 1.145 1.159 1.168 1.072 1.063 0.982 0.828
    1.151 1.099 1.111 1.097 1.106 1.050 1.132 0.945 0.868
    1.128 1.137 1.158 1.050 1.085 1.158 1.096 0.942 0.973
    1.019 1.041 1.169 1.153 1.196 1.168 1.083 0.901 0.869
    1.005 1.159 1.103 1.059 1.110 1.009 1.029 0.954 0.856
    1.113 1.085 1.034 1.080 1.117 1.019 0.956 0.908 0.835
"""


class PaperRow(NamedTuple):
    """A line of a page's table: a quantity, what is printed, and what comes out here."""

    quantity: str
    printed: str
    ours: str


def zhu2016() -> tuple[PaperRow, ...]:
    """Strip width on a plane, and what the printed tables give when they are worked out again."""
    tool, origin = Tool.torus(12, 1), np.zeros((1, 2))
    axis = axis_from_lean(contact_frame(PLANE, origin, "u"), np.radians(5.0), 0.0)
    swept = strip_width(PLANE, tool, origin, axis, 0.02, "u").sum()
    standing = section_width(PLANE, tool, origin, axis, 0.02, "u").sum()

    # Widths are printed with five decimals.
    follow = [(np.ceil(1 / (width + 5e-6)), np.ceil(1 / (width - 5e-6))) for _, width in PASSES_AND_WIDTHS]
    wrong = [k for k, (least, most) in enumerate(follow) if not least <= PASSES_AND_WIDTHS[k][0] <= most]
    estimated, made, quick, slow = np.array(ESTIMATES).T
    errors, gains = 100 * (estimated / made - 1), slow / quick
    length, seconds = np.array(LENGTHS_AND_TIMES).T
    feeds = 60 * length / seconds
    assert wrong == [2] and follow[2][0] == follow[2][1]
    return (
        PaperRow(
            "strip width on a plane, D12 r1, 5 deg lead, 0.02 mm scallop",
            "-",
            f"{swept:.4f} mm swept, {standing:.4f} mm by the standing cutter's section",
        ),
        PaperRow(
            "error of the estimate at the three axes of Table 2",
            "below 2 %",
            ", ".join(f"{x:.1f}" for x in errors) + " % from its own figures",
        ),
        PaperRow("passes made over estimate, time, Table 2", "-", f"{gains.min():.0f} to {gains.max():.0f}"),
        PaperRow(
            "passes that follow from the widths of Tables 5 and 6",
            "12 rows",
            f"{len(PASSES_AND_WIDTHS) - len(wrong)} rows agree; S3 of Table 5 gives {follow[2][0]:.0f}, "
            f"not {PASSES_AND_WIDTHS[2][0]}",
        ),
        PaperRow("3+2-axis over five-axis path length, Table 4", "1.457", f"{length[2] / length[0]:.3f}"),
        PaperRow(
            "mean speed that lengths and times of Table 4 give",
            "3000 mm/min",
            ", ".join(f"{x:.0f}" for x in feeds) + " mm/min",
        ),
    )


def grandguillaume2021() -> tuple[PaperRow, ...]:
    """Table 2, the three feeds of Figs. 8, 9 and 11, the rules of the paraboloid, and times by closed forms."""
    machine = load_machine("mikron-ucp-710")
    levels = [preferred_direction(machine, level)[1] / 1000 for level in Level]
    norms = " / ".join(", ".join(f"{x:.4f}" for x in row) for row in levels)

    diagonal = np.ones(3) / np.sqrt(3)
    first = np.degrees(alignments(machine, Level.JERK, diagonal).angles[0, 0])
    pairs = sorted({(abs(round(a)), abs(round(c))) for c, a in first})
    along_x = np.abs(np.degrees(alignments(machine, Level.JERK, (1, 0, 0)).angles.reshape(-1, 2)))
    upright = best_along(machine, Level.JERK, (0, 0, 1))[0] / 1000

    offsets = np.linspace(-99.5, 99.5, 400)
    rules = np.stack([np.ones(400), np.ones(400), offsets / 250], axis=1)
    spans = []
    for level in (Level.JERK, Level.ACCELERATION):
        turn, tilt = np.moveaxis(np.degrees(alignments(machine, level, rules).angles), -1, 0)
        here = (tilt > 0) & (tilt < 90) & (np.abs(turn) < 15)
        spans.append(
            f"A {tilt[here].max():.1f} to {tilt[here].min():.1f}, C {np.abs(turn[here]).min():.1f} to "
            f"{np.abs(turn[here]).max():.1f}"
        )

    gain = np.sqrt(3 / 2)
    slow, fast = (float(travel_time(100.0, 1e9, 1e9, 5000 * np.sqrt(k))) for k in (2, 3))
    x_axis, y_axis, _ = (axis.drive.levels(axis.name) for axis in machine.linear if axis.drive is not None)
    assert x_axis[0] == y_axis[0] == 500
    speed, _, jerk = y_axis
    stops = float(travel_time(600.0, *y_axis))
    # At an end the speed may go from v to -v without a rest: half of that takes sqrt(2 v / j) on 2/3 v sqrt(2 v / j).
    half = np.sqrt(2 * speed / jerk)
    assert jerk * half <= y_axis[1]
    around = 2 * half + (600.0 - 2 * (2 / 3) * speed * half) / speed
    saved = f"+{100 * (gain ** (1 / 3) - 1):.1f} %, -{100 * (1 - fast / slow):.1f} %"
    return (
        PaperRow(
            "Table 2: velocity m/s, acceleration m/s2, jerk m/s3",
            "0.87, 3.6, 8.7 / 0.74, 4.4, 7.4 / 0.87, 3.6, 8.7",
            norms,
        ),
        PaperRow(
            "A, C that put feed (1, 1, 1) on the corner + + +, deg",
            "0, 0 and 90, 90",
            " and ".join(f"{a}, {c}" for a, c in pairs),
        ),
        PaperRow(
            "A, C for feed (1, 0, 0), deg",
            "-",
            "A "
            + " or ".join(f"{x:.0f}" for x in np.unique(along_x[:, 1].round(3)))
            + ", C "
            + " or ".join(f"{x:.4f}" for x in np.unique(along_x[:, 0].round(4)))
            + ", either sign",
        ),
        PaperRow("best tangential jerk for feed (0, 0, 1)", "7.1 m/s3", f"{upright:.4f} m/s3"),
        PaperRow("paraboloid, angles for each rule by jerk, deg", "A 50 to 15, C about 10.8", spans[0]),
        PaperRow("the same by acceleration, deg", "-", spans[1]),
        PaperRow(
            "path 200, jerk polytope: feed, time",
            "+40 %, -45 % measured",
            f"{saved} on a straight pass from rest to rest",
        ),
        PaperRow(
            "Manta at A = C = 0, least time of 1200 straight passes",
            "2175 s measured",
            f"{1200 * stops:.0f} s with a stop after each, {1200 * around:.0f} s without",
        ),
        PaperRow(
            "Manta passes at x = 0.5, 150 and 300 mm, time saved by jerk",
            "13 to 38 % measured",
            ", ".join(f"{100 * _saved_on_manta(x):.1f}" for x in (0.5, 150.0, 300.0)) + " %",
        ),
    )


def _saved_on_manta(x: float) -> float:
    """Share of the time that aligning the mean feed saves on one pass of a ball of 8 mm along y over the Manta."""
    points = json.loads((EXAMPLES / "manta.json").read_text())["points"]
    face = Face.from_bspline(np.array(points), degree=(3, 3))
    uv = np.column_stack([np.full(200, x / 600), np.linspace(0, 1, 200)])
    normals = face.normal(uv)
    one = (PassSegment(face.evaluate(uv).point + 8.0 * normals, normals),)
    mounting = Mounting(load_machine("mikron-ucp-710"))
    feeds = Feeds(500.0, tolerance=0.01)
    aligned = find_setup(mounting, one).rotary
    basic, best = (float(cutting_seconds(mounting, one, at, feeds)[0]) for at in (np.zeros(2), aligned))
    return 1 - best / basic


def jang2021() -> tuple[PaperRow, ...]:
    """The sample surface, the formula's leans and widths, and its posture at the middle of the surface."""
    radius, d = 30.0, 0.03
    face = Face.from_bspline(json.loads((EXAMPLES / "biquintic.json").read_text())["points"], (5, 5))
    uv = face.grid(400, 400)
    point = face.evaluate(uv)
    curvature = face.curvature(uv).k1
    area = np.linalg.norm(np.cross(point.su, point.sv), axis=1)
    edge = np.linspace(0, 1, 2001)
    border = [
        np.column_stack(pair)
        for side in (0.0, 1.0)
        for pair in ((edge, np.full(2001, side)), (np.full(2001, side), edge))
    ]
    tightest = max(curvature.max(), *(face.curvature(rows).k1.max() for rows in border))
    outline = np.concatenate([point.point, *(face.evaluate(rows).point for rows in border)])
    share = area[curvature > 1 / radius].sum() / area.sum()

    rho = np.linspace(31.0, 300.0, 2691)
    one, two = match_lead(radius, rho), two_point_lead(radius, rho, d)
    gain = circle_strip_width(radius, rho, d, two, d) / circle_strip_width(radius, rho, d, one, 0.0)

    middle = np.array([[0.5, 0.5]])
    setting = ContactSet(face, Tool.flat(2 * radius), middle, face.evaluate(middle).su, d)
    lean = np.atleast_1d(two_point_lead(radius, 1 / setting.curvatures()[1][0], d))
    formula = rings(setting, Posture(lean, np.zeros(1), np.array([d])))
    free, ring = settle(setting, d)
    # What the ring of the cutter's corner goes below the surface at places of it, and what the settled one may at most.
    deep, clear = -formula.least[0], penetration(setting.tool, ring.tip, ring.axis, (face,)).max()
    return (
        PaperRow("least radius of curvature of the sample surface", "28.25 mm", f"{1 / tightest:.3f} mm"),
        PaperRow(
            "box of the sample surface",
            "187 x 124 x 53 mm",
            " x ".join(f"{x:.3f}" for x in np.ptp(outline, axis=0)) + " mm",
        ),
        PaperRow("share of it that is tighter than the cutter, R 30 mm", "-", f"{100 * share:.2f} %"),
        PaperRow(
            "two contacts over one, strip width, at best", "-", f"{gain.max():.4f} at rho = {rho[gain.argmax()]:.0f} mm"
        ),
        PaperRow(
            "lean of Eq. (7) at the middle, feed along u, and its gouge",
            "-",
            f"{np.degrees(lean[0]):.3f} deg, {deep:.4f} mm deep",
        ),
        PaperRow(
            "gouge-free lean with two contacts there",
            "-",
            f"{np.degrees(free.lean[0]):.3f} deg, {clear:.4f} mm deep at most",
        ),
    )


def dong2023() -> tuple[PaperRow, ...]:
    """Expected widths, roughness, its two tables of Ra, and fixed angles by stacked least squares."""
    tool, lead, h = Tool.torus(10, 3), np.radians(20.0), 0.1
    low, high = expect_widths(tool, lead, h)
    origin = np.zeros((1, 2))
    axis = axis_from_lean(contact_frame(PLANE, origin, "u"), lead, 0.0)
    standing, swept = (width(PLANE, tool, origin, axis, h, "u").sum() for width in (section_width, strip_width))
    sturz, multiscale = (np.array(table.split(), dtype=float) for table in (STURZ_RA, MULTISCALE_RA))
    less = multiscale.mean() / sturz.mean() - 1
    over = [int((rows > 1.6).sum()) for rows in (sturz, multiscale)]
    step = float(step_of_roughness(tool, 1.6e-3, lead))
    printed, exact = zip(*(_missed_angles(seed) for seed in range(20)), strict=True)
    return (
        PaperRow(
            "expected strip width, Eq. (14), R5 r3, 20 deg, 0.1 mm", "2.15 to 3.15 mm", f"{low:.4f} to {high:.4f} mm"
        ),
        PaperRow(
            "strip width on a plane, the same cutter and lead",
            "2.60 to 2.78 mm on its surface",
            f"{standing:.4f} mm by section, {swept:.4f} mm swept",
        ),
        PaperRow("distance of passes on a plane for Ra 1.6 um", "-", f"{step:.5f} mm"),
        PaperRow(
            "mean Ra of its Tables 1 and 2",
            "-",
            f"{sturz.mean():.3f} and {multiscale.mean():.3f} um, {100 * less:.0f} %",
        ),
        PaperRow(
            "places above Ra 1.6 um in Tables 1 and 2", "13 and 0 of 90", f"{over[0]} and {over[1]} of {sturz.size}"
        ),
        PaperRow(
            "how far fixed angles are missed, 20 random passes, Eq. (26)",
            "0",
            f"{min(printed):.1f} to {max(printed):.1f} deg as printed, {max(*exact, 1e-9):.0e} deg at most here",
        ),
    )


def _missed_angles(seed: int) -> tuple[float, float]:
    """Greatest distance of a spline from angles within a pass that it must meet, deg: by Eq. (26), and here.

    The ends are met by both; the angles between them scatter by five degrees.
    """
    rng = np.random.default_rng(seed)
    places = np.sort(np.concatenate([[0.0, 1.0], rng.uniform(0, 1, 58)]))
    durations, angles = rng.uniform(0.02, 0.2, 59), rng.normal(scale=np.radians(5.0), size=(5, 2))
    at, knots = places[[0, 15, 30, 45, 59]], even_knots(0.0, 1.0, 16)
    square, held = rates(knots, places, durations), basis(knots, at[1:-1])
    square = square.T @ square
    ends = angles[[0, -1]]
    rows = np.vstack([square[1:-1, 1:-1], held[:, 1:-1]])
    right = np.concatenate([-square[1:-1][:, [0, -1]] @ ends, angles[1:-1] - held[:, [0, -1]] @ ends])
    control = np.concatenate([ends[:1], np.linalg.lstsq(rows, right, rcond=None)[0], ends[1:]])
    exact = smoothest(knots, places, durations, (at, angles)).angles(at)
    missed = held @ control - angles[1:-1]
    return float(np.degrees(np.abs(missed).max())), float(np.degrees(np.abs(exact - angles).max()))


def stheta2023() -> tuple[PaperRow, ...]:
    """The rounded corner as printed and as corrected, and the channel of tool angles before a hollow."""
    p1, p2, p3, height = np.array((0.0, 0.0)), np.array((10.0, 2.0)), np.array((18.0, 8.0)), 0.5
    one, other = corner(p1, p2, p3, height)[0]
    alpha, gamma = (float(np.arctan2(step[1], step[0])) for step in (p2 - p1, p3 - p2))
    beta = (alpha + gamma) / 2
    first = height * (np.cos(alpha) + np.cos(beta)) / np.sin(beta - alpha)
    second = height * (np.cos(gamma) + np.cos(beta)) / np.sin(beta - gamma)
    mirrored = p2 + first * np.array((np.cos(alpha), np.sin(alpha)))
    last = p2 + second * np.array((np.cos(gamma), np.sin(gamma)))

    made = section(sections("impulse", 1, 4.0, 300)[0])
    made = made.begun_at(base_of(made))
    inside, free = np.radians(2.0), channel(made)
    convex = np.flatnonzero(np.diff(made.ahead) > 0).tolist()
    printed = sum(_meets_section(made, k, made.ahead[k] - inside) for k in convex)
    ours = sum(_meets_section(made, k, free.high[k] - inside) for k in range(len(made.points) - 1))
    return (
        PaperRow("Eq. (9), P1 (0, 0), P2 (10, 2), P3 (18, 8), eps 0.5: Bi0", _pair(mirrored), _pair(one[0])),
        PaperRow("the same, Bj3", _pair(last), _pair(other[3])),
        PaperRow(
            "Eq. (11): d1, d2",
            f"{first:.4f}, {second:.4f}",
            f"{np.hypot(*(one[0] - p2)):.4f}, {np.hypot(*(other[3] - p2)):.4f}",
        ),
        PaperRow("greatest curvature at the joints, 1/mm", "0", f"{_joint_curvature(one, other):.0e} at most"),
        PaperRow(
            "tool 2 deg inside the forward limit, impulse section: places where it cuts the blade",
            f"{printed} of {len(convex)} convex ones",
            f"{ours} of {len(made.points) - 1}",
        ),
    )


def _pair(point: Array) -> str:
    return f"({point[0]:.4f}, {point[1]:.4f})"


def _joint_curvature(one: Array, other: Array) -> float:
    """Greatest curvature of two cubic Bezier curves at their four ends, above 1e-9."""
    found = [1e-9]
    for curve in (one, other):
        for a, b, c in (curve[:3], curve[:0:-1]):
            ahead, bend = 3 * (b - a), 6 * (c - 2 * b + a)
            found.append(abs(ahead[0] * bend[1] - ahead[1] * bend[0]) / np.hypot(*ahead) ** 3)
    return float(max(found))


def _meets_section(one: Section, place: int, angle: float) -> bool:
    """Whether a ray from a point of a closed polygon meets it anywhere else."""
    a, b, way = one.points[:-1], one.points[1:], np.array((np.cos(angle), np.sin(angle)))
    edge, off = b - a, a - one.points[place]
    across = way[0] * edge[:, 1] - way[1] * edge[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        ray = (off[:, 0] * edge[:, 1] - off[:, 1] * edge[:, 0]) / across
        share = (off[:, 0] * way[1] - off[:, 1] * way[0]) / across
    return bool(((ray > 1e-6) & (share > 0) & (share < 1)).any())


PAPERS: dict[str, Callable[[], tuple[PaperRow, ...]]] = {
    "zhu2016": zhu2016,
    "grandguillaume2021": grandguillaume2021,
    "jang2021": jang2021,
    "dong2023": dong2023,
    "stheta2023": stheta2023,
}
