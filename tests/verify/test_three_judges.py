"""Planner and judge against a third judge: depths at edges, corners and small steps, by distance and nothing else."""

from operator import itemgetter

import numpy as np
import pytest
from third import Corner, depth_of_cut, edge, stair, swept

from toolaxis.cldata.toolpath import Motion
from toolaxis.contact.clearance.gouge import RESOLUTION, segment_penetration
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.verdict import judge

TOOLS = (Tool.ball(8), Tool.torus(10, 2), Tool.torus(8, 0.5), Tool.ball(3))
#: What the third judge itself may miss, and the steps in which rays are laid at an edge.
MISSED, STEPS = 0.04, 0.06
LEAN = np.radians(50.0)


def directions(rng, middle, lean):
    """An axis that leans so far from the middle normal at most, and a way across it that is mostly level."""
    axis = middle + np.tan(lean) * rng.uniform(-0.7, 0.7, 3)
    way = rng.normal(size=3)
    way -= (way @ middle) * middle
    way = way / np.linalg.norm(way) + rng.uniform(-0.4, 0.4) * middle
    return axis / np.linalg.norm(axis), way / np.linalg.norm(way)


def entered_by(solid, tool, ways, depth, rng):
    """Tips of two motions, one coming down slantwise and one running on, moved along the middle normal until the
    deepest place of the surface is so deep in the cutter; and that place."""
    axis, way = ways
    corner = np.array([0.0, rng.uniform(-1, 1), 0.0]) if not isinstance(solid, Corner) else np.zeros(3)
    start = corner + rng.uniform(-0.3, 0.3, 3)
    onward = way + rng.uniform(-0.3, 0.3) * solid.middle
    tips = start + np.array([-1.2 * way, [0.0, 0.0, 0.0], onward])
    points = surface_points(solid)
    lift = 12.0
    for _ in range(24):
        # A surface point comes out of the cutter no slower than by half of the lift, and no faster than by all of it.
        off = swept(tool.profile, points - lift * solid.middle, tips, axis)
        rise = -off.min() - depth
        lift += rise
        # All that is to come moves no point by more than twice as much: those farther away are never the deepest.
        points = points[off <= off.min() + 4 * abs(rise)]
    tips = tips + lift * solid.middle
    return tips, points[swept(tool.profile, points, tips, axis).argmin()]


def surface_points(solid):
    """Points of the faces, close to the edge and coarse elsewhere."""
    near = np.concatenate([-(10.0 ** np.linspace(0.6, -4, 24)), [0.0], 10.0 ** np.linspace(-4, 0.6, 24)])
    rows = []
    for face in solid.faces:
        (u0, u1), (v0, v1) = face.surface.domain
        share = np.clip(np.concatenate([np.linspace(0, 1, 40), near + 1, near]), 0, 1)
        u, v = np.meshgrid(u0 + share * (u1 - u0), v0 + share * (v1 - v0), indexing="ij")
        if not isinstance(solid, Corner):
            u, v = np.meshgrid(u0 + share * (u1 - u0), np.linspace(v0, v1, 41), indexing="ij")
        rows.append(face.evaluate(np.stack([u.ravel(), v.ravel()], axis=1)).point)
    points = np.concatenate(rows)
    return points[np.abs(points).max(axis=1) < 7.5]


def judged(solid, tool, tips, axis, tolerance, role="skin"):
    # Cuts over an edge by a small corner are short: rays stand closer.
    given = {role: solid.faces[1:]} if role != "alone" else {}
    kind = np.full(len(tips), Motion.CUT, dtype=np.int8)
    axes = np.tile(axis, (len(tips), 1))
    return judge(VerificationTask("op", tips, axes, kind, tool.profile, solid.faces[:1], 0.02, left=solid.faces[:1],
                                  tolerance=Tolerance(gouge=tolerance), **given),
                 spacing=min(0.25, 0.2 * tool.corner_radius))


def compared(solid, seed, tolerance, bend, role="skin", lean=LEAN):
    """Depths by the third judge, the planner and the judge; asserts that they go together.

    bend : the greatest angle by which normals turn at an edge, rad; lean : the greatest one of the axis.
    """
    rng = np.random.default_rng(seed)
    tool = TOOLS[rng.integers(len(TOOLS))]
    # So deep the edge lies in the cutter that its inmost point is about as deep as that, or less deep.
    depth = 10.0 ** rng.uniform(np.log10(1.2 * tolerance), np.log10(4 * tolerance)) / np.cos(bend / 2)
    axis, way = directions(rng, solid.middle, lean)
    tips, deepest = entered_by(solid, tool, (axis, way), depth, rng)
    boxes = [(deepest - size, deepest + size) for size in (1.0, 0.1)] + [([-2.5, -2.5, -1.0], [2.5, 2.5, 0.6])]
    truth, where = max((depth_of_cut(solid, tool.profile, tips, axis, box) for box in boxes), key=itemgetter(0))
    planned = float(segment_penetration(tool, tips, axis, solid.faces).max())
    found = judged(solid, tool, tips, axis, tolerance, role)
    told = max((place.value for one in found.maps for place in one.worst("gouge")), default=0.0)
    about = f"seed {seed}: truth {truth:.5f} at {where}, planner {planned:.5f}, judge {told:.5f} {found.gouge_max:.5f}"
    # The planner's depth is that of the surface in the cutter: never less, at an edge up to 1 / cos of half its angle.
    assert planned >= truth - 1e-6, about
    assert planned <= truth * (1.0 + MISSED) / np.cos(bend / 2) + RESOLUTION + 0.05 * max(truth - 0.1, 0.0), about
    if truth > tolerance * (1 + STEPS):
        assert not found.passed, about
        assert told >= truth * (1.0 - STEPS) - found.uncertainty, about
    if truth > tolerance or told > tolerance:
        assert told <= max(truth * (1.0 + MISSED + STEPS), tolerance) + found.uncertainty, about
    return truth, planned, told


@pytest.mark.parametrize(("turn", "tolerance"), [
    (0.5, 0.01), (90.0, 0.002), (170.0, 0.002), *(
        pytest.param(*case, marks=pytest.mark.long) for case in
        [(0.5, 0.002), (5.0, 0.002), (5.0, 0.01), (45.0, 0.002), (45.0, 0.01), (90.0, 0.01), (150.0, 0.002),
         (150.0, 0.01), (170.0, 0.01)])])
def test_convex_edges(turn, tolerance):
    """An entry or a run-out over an edge is as deep as its inmost point lies below the nearer face."""
    compared(edge(np.radians(turn)), int(10 * turn), tolerance, np.radians(turn))


@pytest.mark.parametrize("turn", [30.0, 120.0])
def test_a_face_behind_an_edge(turn):
    """Faces that the operation may only touch are bounded by how far they lie inside the cutter."""
    _, planned, told = compared(edge(np.radians(turn)), int(turn), 0.002, np.radians(turn), "touching")
    assert told <= planned + RESOLUTION


def upright(turn):
    """How far an axis may lean in a concave corner so that the cutter touches its sides near the corner, rad."""
    return LEAN if turn < 0 else min(LEAN, (np.pi - turn) / 4)


@pytest.mark.parametrize("turn", [0.5, 45.0, 120.0])
def test_concave_edges(turn):
    compared(edge(-np.radians(turn)), int(10 * turn) + 1, 0.002, 0.0, lean=upright(np.radians(turn)))


@pytest.mark.parametrize(("turn", "fillet"), [(90.0, 0.02), (90.0, 1.0), (150.0, 0.2), (-90.0, 0.5)])
def test_fillets(turn, fillet):
    compared(edge(np.radians(turn), fillet), int(abs(turn) * fillet) + 3, 0.002, np.radians(max(turn, 0.0)),
             lean=upright(np.radians(-turn)))


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.long)])
def test_corners_of_three_faces(seed):
    """Where three faces meet at right angles normals turn by up to 109 degrees in all."""
    compared(Corner(), 40 + seed, 0.002, 2 * np.arccos(1 / np.sqrt(3.0)))


@pytest.mark.parametrize("turn", [90.0, pytest.param(170.0, marks=pytest.mark.long)])
def test_a_wide_tolerance(turn):
    """How near an edge a ray is grows with the depth that is allowed."""
    compared(edge(np.radians(turn)), int(turn), 0.06, np.radians(turn))


@pytest.mark.parametrize("height", [0.004, 0.02, 0.2])
def test_small_steps(height):
    """A stair with its riser as a face, low or high: both sides of it are the part's surface."""
    compared(stair(height), int(1000 * height), 0.002, np.pi / 2)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(300))
def test_any_edge(seed):
    rng = np.random.default_rng(10_000 + seed)
    tolerance = (0.002, 0.01, 0.04)[seed % 3]
    turn = np.radians(rng.uniform(0.5, 170.0))
    if seed % 5 == 4:
        turn = -min(turn, np.radians(100.0))
    fillet = 10.0 ** rng.uniform(-2, 0.3) if seed % 4 == 0 else 0.0
    compared(edge(turn, fillet if abs(turn) < 2.6 else 0.0), seed, tolerance, max(turn, 0.0), lean=upright(-turn))
