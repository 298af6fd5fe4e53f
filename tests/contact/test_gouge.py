"""Gouge bounds: exact cases, what they must follow, trims, motions, and the plain twin."""

import numpy as np
import pytest

from toolaxis.contact.clearance import queries as distances
from toolaxis.contact.clearance.gouge import (
    RESOLUTION,
    depth_from_distance,
    gouge,
    gouges,
    least_distance,
    penetration,
    segment_gouges,
    segment_penetration,
)
from toolaxis.contact.clearance.queries import keeps_limits, lower_bounds, motions, segment_motions
from toolaxis.contact.placement import place
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import rotation, unit
from toolaxis.shape.analytic import SphericalSurface
from toolaxis.shape.bounding.bounding_tree import forest
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

TOOLS = [Tool.torus(12, 1), Tool.ball(8), Tool.flat(10), Tool.tapered(6, 1, 4)]


def _plane(size=40.0, **more):
    return Face.from_bspline(np.array([[[0, 0, 0], [0, size, 0]], [[size, 0, 0], [size, size, 0.0]]]), (1, 1), **more)


def _bowl(radius, side=1.0):
    """A quarter of a cylinder about y with its normals inwards (side 1, concave) or outwards (-1)."""
    r, w = radius, np.sqrt(0.5)
    net = np.array([[[r, y, 0], [r, y, -r], [0, y, -r]] for y in (0.0, 60.0)]).transpose(1, 0, 2)
    return Face.from_bspline(net, (2, 1), weights=np.outer([1, w, 1], [1, 1]), flip=side > 0)


def _wavy(seed=1, height=1.5, **more):
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(0, 60, 6), np.linspace(0, 60, 6), indexing="ij")
    return Face.from_bspline(np.stack([x, y, height * rng.standard_normal(x.shape)], axis=-1), **more)


def _leaning(face, n, lean, seed=2):
    rng = np.random.default_rng(seed)
    uv = rng.uniform(0.1, 0.9, (n, 2))
    return uv, unit(face.normal(uv) + lean * rng.standard_normal((n, 3)))


@pytest.mark.parametrize("tool", TOOLS, ids=lambda t: t.name)
def test_plane_is_only_touched(tool):
    uv, axis = _leaning(_plane(), 100, 0.3)
    assert gouge(_plane(), tool, uv, axis).max() < 0.001


@pytest.mark.parametrize("tool", TOOLS, ids=lambda t: t.name)
def test_plane_at_a_known_depth(tool):
    uv, axis = _leaning(_plane(), 40, 0.3)
    for depth in (0.0005, 0.004, 0.05):
        tips = place(_plane(), tool, uv, axis) - [0, 0, depth]
        rows = tool.distance(_seen_from(tips, axis, _contact_points(uv)), "cutter").value
        found = penetration(tool, tips, axis, (_plane(),))
        assert (found >= -rows - 1e-9).all()
        if tool.corner_radius > 0.1:
            assert found == pytest.approx(depth, abs=RESOLUTION)


def _contact_points(uv):
    return np.column_stack([40 * uv, np.zeros(len(uv))])


def _seen_from(tips, axis, points):
    w = points - tips
    z = np.einsum("ij,ij->i", w, axis)
    return np.column_stack([np.linalg.norm(w - z[:, None] * axis, axis=1), np.zeros(len(z)), z])


def test_ball_in_a_groove():
    """Ball of radius 4 in a groove of radius R: free for R > 4; else it reaches in by a known depth."""
    uv, ball = np.column_stack([np.full(20, 0.5), np.linspace(0.1, 0.9, 20)]), Tool.ball(8)
    axis = unit([-1.0, 0.1, 1.0])
    assert gouge(_bowl(4.05), ball, uv, axis).max() < 0.001
    assert gouge(_bowl(60.0, -1), ball, uv, -axis).max() < 0.001
    # centre d = 4 - R beyond the axis of the groove; the rims, at 45 deg, stand sqrt(R^2 + d^2 + sqrt(2) R d) from it
    radius = 3.9
    d = 4 - radius
    rim = np.sqrt(radius**2 + d**2 + np.sqrt(2) * radius * d)
    assert gouge(_bowl(radius), ball, uv, axis) == pytest.approx(4 - rim, abs=0.001)


def test_torus_across_a_groove():
    """Curvature gouge starts where sin(lead) < a kappa/(1 - r kappa), for a lead across the groove's own direction."""
    radius, tool = 40.0, Tool.torus(12, 1)
    critical = np.arcsin(5 / radius / (1 - 1 / radius))
    uv = np.array([[0.5, 0.5]])
    n = _bowl(radius).normal(uv)[0]
    along = np.array([0.0, 1.0, 0.0])
    for share, free in ((1.1, True), (0.9, False)):
        lead = share * critical
        axis = np.cos(lead) * n + np.sin(lead) * along
        assert (gouge(_bowl(radius), tool, uv, axis)[0] < 0.001) == free


def test_rear_gouge_is_seen():
    """A flat cutter that leans along a step behind it."""
    net = np.array([[[x, y, 2.0 if x < 15 else 0.0] for y in (0, 40.0)] for x in (0, 14.9, 15.1, 40)])
    step = Face.from_bspline(net, (1, 1))
    back, forth = unit([0.05, 0, 1.0]), unit([-0.05, 0, 1.0])
    near = np.array([[0.73, 0.5]])
    assert gouge(step, Tool.flat(20), near, back)[0] > 1
    assert gouge(step, Tool.flat(20), near, forth)[0] < 0.001
    assert gouge(step, Tool.flat(10), np.array([[0.95, 0.5]]), back)[0] < 0.001


def test_neighbours_count_as_skin():
    plane = _plane()
    wall = Face.from_bspline(np.array([[[40, 0, 0], [40, 40, 0]], [[50, 0, 8], [50, 40, 8.0]]]), (1, 1))
    uv, axis, tool = np.array([[0.97, 0.5]]), unit([-0.1, 0, 1]), Tool.torus(12, 1)
    assert gouge(plane, tool, uv, axis)[0] < 0.001
    assert gouge(plane, tool, uv, axis, (plane, wall))[0] > 0.1


def test_holes_are_not_touched():
    """Over the middle of a hole wider than the ball nothing is reached; at its rim the depth is the rim's."""
    ring = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    hole = np.stack([0.5 + 0.05 * np.cos(ring), 0.5 + 0.05 * np.sin(ring)], axis=1)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    face, ball = _plane(trims=(square, hole)), Tool.ball(8)
    depth = np.array([0.2, 0.4, 0.6])
    tips = np.column_stack([np.full((3, 2), 20.0), -depth])
    rim = 4 - np.sqrt(2.0**2 + (4 - depth) ** 2)
    inside = 2 * np.cos(np.pi / 400)  # the loop is a polygon
    exact = np.maximum(0, 4 - np.sqrt(inside**2 + (4 - depth) ** 2))
    found = penetration(ball, tips, [0, 0, 1], (face,))
    assert found == pytest.approx(np.maximum(rim, 0), abs=0.0005)
    assert (found >= exact - 1e-9).all()
    assert gouges(ball, tips, [0, 0, 1], (face,), 0.002).tolist() == [False, False, True]


def test_motion_between_points():
    """Chords of a groove cut into its bottom between their ends, by the sagitta."""
    radius, ball = 30.0, Tool.ball(8)
    face = _bowl(radius)
    angle = np.radians(np.arange(20.0, 71.0, 2.0))
    point = radius * np.column_stack([np.cos(angle), np.zeros(len(angle)), -np.sin(angle)])
    normal = -point / radius
    tips = point + [0, 30, 0] + 4 * normal - [0, 0, 4.0]
    sagitta = (radius - 4) * (1 - np.cos(np.radians(1.0)))
    deep = segment_penetration(ball, tips, [0, 0, 1], (face,))
    assert deep == pytest.approx(0.0, abs=0.001)  # chords of a concave groove stay inside
    outer = _bowl(radius, -1)
    tips = 34 / 30 * point + np.array([0, 30, 4.0])
    found = segment_penetration(ball, tips, [0, 0, -1], (outer,))
    exact = (radius + 4) * (1 - np.cos(np.radians(1.0)))
    assert found == pytest.approx(exact, abs=RESOLUTION)
    assert sagitta < exact
    assert penetration(ball, tips, [0, 0, -1], (outer,)).max() < 0.001
    assert segment_gouges(ball, tips, [0, 0, -1], (outer,), exact - 0.0005).all()
    assert not segment_gouges(ball, tips, [0, 0, -1], (outer,), exact + 0.0005).any()


@pytest.mark.parametrize("tool", TOOLS, ids=lambda t: t.name)
def test_motion_against_dense_steps(tool):
    face, rng = _wavy(), np.random.default_rng(5)
    uv, _ = _leaning(face, 12, 0.2)
    axis = unit([0.1, 0.2, 1.0])
    tips = place(face, tool, uv, axis) + rng.uniform(-0.2, 0.4, (12, 1)) * axis
    tips = tips[np.argsort(tips[:, 0])]
    found = segment_penetration(tool, tips, axis, (face,))
    for k in range(11):
        share = np.linspace(0, 1, 300)[:, None]
        steps = penetration(tool, tips[k] + share * (tips[k + 1] - tips[k]), axis, (face,))
        assert found[k] >= steps.max() - RESOLUTION - 0.05 * max(0, steps.max() - 0.1)
        assert found[k] <= steps.max() * 1.05 + 0.003  # steps of some hundredths of a mm


def test_moves_mirrors_and_scales_with_the_part():
    face, tool = _wavy(), Tool.torus(12, 1)
    uv, axis = _leaning(face, 60, 0.2)
    deep = gouge(face, tool, uv, axis)
    assert (deep > 0.01).any() and (deep < 0.001).any()
    turn = rotation([1, 2, 3], 0.8)
    for linear, scale in ((turn, 1.0), (turn @ np.diag([1, 1, -1.0]), 1.0), (2.5 * np.eye(3), 2.5)):
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = linear, [3, -70, 11]
        other = gouge(face.transformed(matrix), Tool.torus(12 * scale, scale), uv, axis @ (linear / scale).T)
        assert np.abs(other / scale - deep).max() < RESOLUTION + 0.05 * deep.max()


def test_allowance_is_where_depth_starts():
    uv, axis = _leaning(_plane(), 10, 0.3)
    tool = TOOLS[0]
    assert gouge(_plane(), tool, uv, axis, allowance=0.3).max() < 0.001
    low = place(_plane(), tool, uv, axis, 0.3) - [0, 0, 0.1]
    assert penetration(tool, low, axis, (_plane(),), allowance=0.3) == pytest.approx(0.1, abs=RESOLUTION)
    assert penetration(tool, low, axis, (_plane(),)).max() < 0.001


def test_tolerance_of_the_face_is_added():
    loose = Face(_plane().surface, tolerance=0.01)
    uv, axis = _leaning(loose, 10, 0.3)
    assert gouge(loose, TOOLS[0], uv, axis) == pytest.approx(0.01, abs=RESOLUTION)
    tips = place(loose, TOOLS[0], uv, axis)
    assert gouges(TOOLS[0], tips, axis, (loose,), 0.005).all()
    assert not gouges(TOOLS[0], tips, axis, (loose,), 0.0105).any()


@pytest.mark.parametrize("tool", TOOLS, ids=lambda t: t.name)
def test_plain_twin_says_the_same(tool, monkeypatch):
    ring = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    face = _wavy(trims=(np.stack([.5 + .4 * np.cos(ring), .5 + .3 * np.sin(ring)], axis=1),))
    uv, axis = _leaning(face, 25, 0.25)
    tips = place(face, tool, uv, axis)
    tree, only = forest([face]), np.array([[0.0, -np.inf, -np.inf]])

    def ask():
        return (lower_bounds(tree, tool, motions(tips, axis), 0.0, RESOLUTION, only),
                keeps_limits(tree, tool, motions(tips, axis), only - 0.002),
                keeps_limits(tree, tool, segment_motions(tips[:3], axis[:2]), only - 0.002))

    one = ask()
    monkeypatch.setattr(distances._compiled, "available", False)
    other = ask()
    assert np.abs(one[0].lower - other[0].lower).max() <= RESOLUTION + 0.05 * np.abs(one[0].lower).max()
    assert (one[1].blocked == other[1].blocked).all()
    assert (one[2].blocked == other[2].blocked).all()


def test_bad_input():
    with pytest.raises(InvalidInput, match="length 1"):
        penetration(TOOLS[0], [[0, 0, 0]], [0, 0, 2.0], (_plane(),))
    with pytest.raises(InvalidInput, match="finite"):
        penetration(TOOLS[0], [[0, 0, np.nan]], [0, 0, 1], (_plane(),))
    with pytest.raises(InvalidInput, match="2 axes are given for 3"):
        penetration(TOOLS[0], np.zeros((3, 3)), [[0, 0, 1]] * 2, (_plane(),))
    with pytest.raises(InvalidInput, match="gouge limit"):
        gouges(TOOLS[0], [[0, 0, 0]], [0, 0, 1], (_plane(),), np.nan)


@pytest.mark.parametrize("radius", [1.0, 3.0])
@pytest.mark.parametrize("swapped", [False, True])
def test_a_ball_touches_the_pole_of_a_sphere_without_gouge(radius, swapped):
    """Derivatives vanish along the border that is the pole: their bounds have to as well."""
    cap = SphericalSurface(7.0, v_range=(0.3, np.pi / 2)).nurbs()
    face = Face(cap.swapped(), flip=True) if swapped else Face(cap)
    (_, _), (v0, v1) = cap.domain
    uv = np.array([[2.0, v0 + share * (v1 - v0)] for share in (1.0, 1 - 1e-6, 1 - 1e-3, 0.99, 0.9)])
    uv = uv[:, ::-1] if swapped else uv
    for row in uv:
        assert gouge(face, Tool.ball(2 * radius), [row], face.normal([row])[0])[0] <= 0.0004


@pytest.mark.parametrize("dipped", [Tool.flat(diameter=3), Tool.torus(diameter=3, corner_radius=0.001),
                                    Tool.torus(diameter=3, corner_radius=0.5),
                                    Tool.tapered(diameter=3, corner_radius=0.001, half_angle_deg=20)], ids=str)
@pytest.mark.parametrize("lean", [5.0, 30.0, 45.0, 60.0])
def test_the_depth_below_a_plane_is_that_of_the_cutter(dipped, lean):
    """A sharp corner reaches deeper below the skin than any point of the skin lies inside the cutter."""
    s, t = np.meshgrid(np.linspace(-10, 10, 4), np.linspace(-10, 10, 4), indexing="ij")
    plane, normal = Face.from_bspline(np.stack([s, t, 0 * s], axis=-1)), np.array([0.0, 0.0, 1.0])
    axis = np.array([np.sin(np.radians(lean)), 0.0, np.cos(np.radians(lean))])
    across = (normal - normal @ axis * axis) / np.linalg.norm(normal - normal @ axis * axis)
    tip = dipped.corner_radius * (normal - axis) + dipped.flat_radius * across - 0.0028 * normal
    depth = penetration(dipped, tip[None], axis, [plane])[0]
    assert 0.0028 - 1e-9 <= depth <= np.sqrt(2) * (0.0028 + 0.0003)
    if dipped.corner_radius > 0.1:
        assert depth <= 0.0028 + 0.0003
    assert gouges(dipped, tip[None], axis, [plane], 0.0027)[0]


def test_distance_and_depth_undo_each_other():
    for corner in (0.0, 0.001, 1.0):
        some = Tool.torus(diameter=6, corner_radius=corner) if corner else Tool.flat(diameter=6)
        for allowance in (0.0, 0.0015, 0.3):
            for depth in (0.0005, 0.002, 0.01):
                kept = least_distance(some, depth, allowance)
                assert depth_from_distance(some, np.array(kept), allowance) == pytest.approx(depth, abs=1e-12)
