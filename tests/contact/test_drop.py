"""The drop-cutter against closed forms, its twin, dense sampling and opencamlib."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.contact.drop_cutter import drop_cutter as drop
from toolaxis.contact.drop_cutter.drop_cutter_numpy import drop_numpy
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import rotation, unit
from toolaxis.tools.tool import Tool

TOOLS = {
    "torus": Tool.torus(12, 1), "ball": Tool.ball(8), "flat": Tool.flat(10),
    "nearly ball": Tool.torus(8, 3.99), "nearly flat": Tool.torus(10, 0.01),
    "tapered": Tool.tapered(6, 1, 4, flute_length=15), "tapered ball": Tool.tapered(6, 3, 12, flute_length=15),
    "tapered flat": Tool.tapered(6, 0, 10, flute_length=15),
}


def underside(tool, rho):
    """Height of a cutter's underside, written from its drawing; inf beyond its radius."""
    a, r, beta = tool.flat_radius, tool.corner_radius, tool.half_angle
    b, zb = a + r * np.cos(beta), r - r * np.sin(beta)
    widest = b + (tool.flute_length - zb) * np.tan(beta)
    arc = r - np.sqrt(np.maximum(r**2 - np.maximum(rho - a, 0) ** 2, 0))
    side = zb + (rho - b) / np.tan(beta) if beta > 0 else np.where(rho > b, np.inf, r)
    return np.where(rho > widest, np.inf, np.where(rho < b, arc, side))


def sampled(tool, triangle, point):
    """The greatest z - h over a triangle, by grids that close in on it."""
    best, centre, half = -np.inf, np.full(2, 1 / 3), 1.0
    for _ in range(60):
        steps = np.linspace(-half, half, 21)
        st = np.clip(centre + np.stack(np.meshgrid(steps, steps), -1).reshape(-1, 2), 0, 1)
        st /= np.maximum(st.sum(axis=1), 1)[:, None]
        q = triangle[0] + st @ (triangle[1:] - triangle[0])
        z = q[:, 2] - underside(tool, np.hypot(*(q[:, :2] - point).T))
        if z.max() >= best:
            best, centre = z.max(), st[np.argmax(z)]
        half *= 0.65
    return best


def soup(rng, count):
    """Triangles of every size, some upright, level, thin, turned or without area."""
    mesh = rng.normal(0, 1, (count, 3, 3)) * rng.choice([0.05, 1, 8], (count, 1, 1)) + rng.uniform(-9, 9, (count, 1, 3))
    k = count // 8
    mesh[:k, :, 2] = np.round(mesh[:k, :1, 2])
    mesh[k:2 * k, 1, :2] = mesh[k:2 * k, 0, :2]
    mesh[2 * k:3 * k, :, 0] = mesh[2 * k:3 * k, :1, 0]
    mesh[3 * k:4 * k, 2] = mesh[3 * k:4 * k, 1]
    mesh[4 * k:5 * k, 2] = (mesh[4 * k:5 * k, 0] + mesh[4 * k:5 * k, 1]) / 2
    mesh[5 * k:6 * k, 2, :2] = mesh[5 * k:6 * k, 0, :2] + 1e-9
    return mesh


@pytest.mark.parametrize("tool", TOOLS.values(), ids=TOOLS)
@pytest.mark.parametrize("slope", [0.0, 1e-9, 0.3, 2.0, 30.0])
def test_on_a_plane_as_the_normal_says(tool, slope):
    normal, way = unit([-slope, 0, 1]), np.array([np.cos(0.7), np.sin(0.7)])
    turn = rotation([0, 0, 1], 0.7)
    triangle = np.array([[-300, -300, -300 * slope], [300, -300, 300 * slope], [0, 500, 0]]) @ turn.T
    points = np.random.default_rng(1).uniform(-5, 5, (20, 2))
    a, r, beta = tool.flat_radius, tool.corner_radius, tool.half_angle
    if np.sin(beta) * slope <= np.cos(beta):
        offset = r / normal[2] + a * slope - r
    else:
        rim = a + r * np.cos(beta) + (tool.flute_length - r + r * np.sin(beta)) * np.tan(beta)
        offset = rim * slope - tool.flute_length
    np.testing.assert_allclose(ta.drop_cutter([triangle], tool, points), slope * (points @ way) + offset, atol=1e-11)


@pytest.mark.parametrize("numba", [True, False])
def test_huge_triangles_keep_their_facets(numba, monkeypatch):
    monkeypatch.setattr(drop._compiled, "available", numba and drop._compiled.available)
    rise = 4 * np.sqrt(1 + 3.3**2 + 1.7**2) - 4
    for turn in np.linspace(0, 2, 20):
        angle = turn + np.array([0, 2, 4])
        x, y = 3.1e6 * np.cos(angle), 3.1e6 * np.sin(angle)
        triangle = np.column_stack([x, y, 3.3 * x - 1.7 * y])
        assert ta.drop_cutter([triangle], TOOLS["ball"], [[0, 0]])[0] == pytest.approx(rise, abs=1e-6)


def test_on_a_vertex_and_on_level_and_upright_edges():
    tool = TOOLS["torus"]
    post = np.array([[[0, 0, 3], [0, 0, -5], [0, 1e-12, -5]]])
    rho = np.array([0, 4.9, 5.3, 5.9, 6.01])
    lift = np.where(rho > 5, 1 - np.sqrt(1 - (rho.clip(5, 6) - 5) ** 2), 0)
    expected = np.where(rho > 6, -np.inf, 3 - lift)
    points = np.column_stack([np.zeros(5), -rho])
    np.testing.assert_allclose(ta.drop_cutter(post, tool, points), expected, atol=1e-13)
    wall = np.array([[[0, -50, 3], [0, 50, 3], [0, 0, -50]]])
    np.testing.assert_allclose(ta.drop_cutter(wall, tool, points[:, ::-1]), expected, atol=1e-13)


def test_a_ball_on_a_slanted_edge():
    k, m = 0.8, 2.0  # the edge's distance from the ball's centre, in the plane upright over it, is that of a circle
    edge = np.array([[[-40, m, -40 * k], [40, m, 40 * k], [0, m, -100]]])
    points = np.column_stack([np.linspace(-3, 3, 7), np.zeros(7)])
    expected = k * points[:, 0] + np.sqrt((16 - m**2) * (1 + k**2)) - 4
    np.testing.assert_allclose(ta.drop_cutter(edge, TOOLS["ball"], points), expected, atol=1e-13)


def test_a_flat_end_on_a_slanted_edge():
    edge = np.array([[[-40, 3, -20], [40, 3, 20], [0, 3, -100]]])
    assert ta.drop_cutter(edge, TOOLS["flat"], [[1, 0]])[0] == pytest.approx((1 + 4) / 2, abs=1e-13)


@pytest.mark.parametrize("tool", TOOLS.values(), ids=TOOLS)
def test_single_triangles_by_dense_sampling(tool):
    rng, met = np.random.default_rng(4), 0
    for triangle in soup(rng, 64):
        point = triangle[:, :2].mean(axis=0) + rng.normal(0, 2, 2)
        found, wanted = ta.drop_cutter([triangle], tool, [point])[0], sampled(tool, triangle, point)
        if np.isfinite(wanted):
            met += 1
            # Grids come down on a sharp rim only slowly.
            assert wanted - 1e-12 <= found < wanted + (1e-5 if tool.corner_radius > 0 else 1e-3)
    assert met > 30


@pytest.mark.parametrize("tool", TOOLS.values(), ids=TOOLS)
def test_the_numpy_twin_agrees(tool, monkeypatch):
    rng = np.random.default_rng(2)
    mesh, points, axes = soup(rng, 400), rng.uniform(-12, 12, (60, 3)), rng.normal(size=(3, 3))
    found = [ta.drop_cutter(mesh, tool, points, axis) for axis in [(0, 0, 1), *axes]]
    monkeypatch.setattr(drop._compiled, "available", False)
    for axis, tips in zip([(0, 0, 1), *axes], found, strict=True):
        assert np.isfinite(tips).sum() > 30
        np.testing.assert_allclose(ta.drop_cutter(mesh, tool, points, axis), tips, rtol=0, atol=1e-10)


@pytest.mark.parametrize("numba", [True, False])
def test_edges_under_a_torus_are_exact_to_many_digits(numba, monkeypatch):
    monkeypatch.setattr(drop._compiled, "available", numba and drop._compiled.available)
    mpmath = pytest.importorskip("mpmath")
    mpmath.mp.dps = 40
    for tool in (TOOLS["torus"], TOOLS["nearly ball"], TOOLS["nearly flat"]):
        a, r = mpmath.mpf(tool.flat_radius), mpmath.mpf(tool.corner_radius)
        for m, k in ((0.5, 1e-6), (0.5, 0.4), (tool.flat_radius, 0.01), (tool.radius * 0.999, 2.0), (0.0, 50.0)):
            def tip(u, m=m, k=k, a=a, r=r):
                t = mpmath.sqrt(mpmath.mpf(m) ** 2 + u**2) - a
                return mpmath.mpf(k) * u - (r - mpmath.sqrt(r**2 - t**2) if t > 0 else 0)
            low = mpmath.mpf(0)
            high = mpmath.sqrt(mpmath.mpf(tool.radius) ** 2 - mpmath.mpf(m) ** 2)
            for _ in range(200):
                one, two = (2 * low + high) / 3, (low + 2 * high) / 3
                low, high = (one, high) if tip(one) <= tip(two) else (low, two)
            edge = np.array([[[-64, m, -64 * k], [64, m, 64 * k], [64, m, 64 * k]]])
            assert ta.drop_cutter(edge, tool, [[0, 0]])[0] == pytest.approx(float(tip(low)), abs=1e-12)


@pytest.mark.parametrize("name", ["torus", "ball", "flat"])
def test_opencamlib_agrees(name):
    ocl = pytest.importorskip("opencamlib", reason="opencamlib is not installed")
    tool = TOOLS[name]
    cutter = {"torus": lambda: ocl.BullCutter(12, 1, 60), "ball": lambda: ocl.BallCutter(8, 60),
              "flat": lambda: ocl.CylCutter(10, 60)}[name]()  # kept alive: opencamlib holds a bare pointer
    rng = np.random.default_rng(6)
    # opencamlib gives up on triangles seen exactly from the side, so there are none here
    mesh = np.concatenate([rng.normal(0, s, (60, 3, 3)) + rng.uniform(-20, 20, (60, 1, 3)) for s in (0.3, 3)])
    points = rng.uniform(-25, 25, (400, 2))
    surface, batch = ocl.STLSurf(), ocl.BatchDropCutter()
    for triangle in mesh:
        surface.addTriangle(ocl.Triangle(*(ocl.Point(*map(float, corner)) for corner in triangle)))
    batch.setSTL(surface)
    batch.setThreads(1)
    batch.setCutter(cutter)
    for x, y in points:
        batch.appendPoint(ocl.CLPoint(float(x), float(y), -1000.0))
    batch.run()
    theirs = np.array([point.z for point in batch.getCLPoints()])
    theirs[theirs == -1000] = -np.inf
    ours = ta.drop_cutter(mesh, tool, points)
    assert np.isfinite(ours).sum() > 200
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-8)


def test_rigid_motions_scale_order_and_division_change_nothing():
    rng, tool = np.random.default_rng(3), TOOLS["torus"]
    mesh, points, axis = soup(rng, 160), rng.uniform(-25, 25, (60, 3)), unit([0.2, -0.4, 1])
    tips = ta.drop_cutter(mesh, tool, points, axis)
    met = np.isfinite(tips)
    turn = rotation([1, 2, 3], 1.1)
    moved = ta.drop_cutter(mesh @ turn.T, tool, points @ turn.T, turn @ axis)
    np.testing.assert_allclose(moved, tips, atol=1e-10)
    double = ta.drop_cutter(2 * mesh, Tool.torus(24, 2), 2 * points, axis)
    np.testing.assert_allclose(double, 2 * tips, atol=1e-10)
    other = mesh[rng.permutation(len(mesh))][:, ::-1]
    np.testing.assert_allclose(ta.drop_cutter(other, tool, points, axis), tips, atol=1e-11)
    middle = mesh.mean(axis=1)
    parts = np.concatenate([np.stack([mesh[:, i], mesh[:, i - 1], middle], axis=1) for i in range(3)])
    np.testing.assert_allclose(ta.drop_cutter(parts, tool, points, axis), tips, atol=1e-9)
    assert met.any() and not met.all()
    vertices, faces = np.unique(mesh.reshape(-1, 3), axis=0, return_inverse=True)
    np.testing.assert_array_equal(ta.drop_cutter((vertices, faces.reshape(-1, 3)), tool, points, axis), tips)
    along = ta.drop_cutter(mesh, tool, points + 7 * axis, axis)
    np.testing.assert_allclose(along, tips, atol=1e-10)


@pytest.mark.parametrize("numba", [True, False])
@pytest.mark.parametrize("lean", [1e-3, 1e-5, 1e-7])
def test_walls_a_hair_off_upright_push_the_cutter_up(lean, numba, monkeypatch):
    monkeypatch.setattr(drop._compiled, "available", numba and drop._compiled.available)
    y, z = np.array([-500, 470, 13]), np.array([-10, -9.3, 10])  # from under the ball's side to just beyond its radius
    wall = np.column_stack([4 + lean * z, y, z]) @ rotation([0, 0, 1], 0.7).T
    middle = -4 + (4 * np.hypot(1, lean) - 4) / lean  # the sphere's centre stands 4 off the plane
    found = ta.drop_cutter([wall], TOOLS["ball"], [[0, 0]])[0]
    assert found == pytest.approx(middle, abs=1e-12 / lean)


def test_no_tip_is_higher_than_the_mesh():
    rng = np.random.default_rng(8)
    for _ in range(2000):  # upright walls that graze the cutter's side; rounding turns their planes anywhere
        wall = np.column_stack([6 + rng.choice([0, 1e-15, -4e-15], 3), *rng.uniform(-9, 9, (2, 3))])
        turned = wall @ rotation([0, 0, 1], rng.uniform(0, 2 * np.pi)).T
        assert ta.drop_cutter([turned], TOOLS["torus"], [[0, 0]])[0] < wall[:, 2].max() + 1e-12


@pytest.mark.parametrize("name", ["torus", "ball", "flat", "tapered"])
def test_the_tree_loses_nothing_on_fine_meshes(name):
    x, y = np.meshgrid(np.linspace(0, 40, 81), np.linspace(0, 40, 81), indexing="ij")
    p = np.stack([x, y, 3 * np.sin(x / 3) + 2 * np.cos(y / 2) + x], axis=-1)
    low, a, b, high = p[:-1, :-1], p[1:, :-1], p[:-1, 1:], p[1:, 1:]
    mesh = np.concatenate([np.stack(half, axis=2).reshape(-1, 3, 3) for half in ((low, a, high), (low, high, b))])
    xy, tool = np.random.default_rng(9).uniform(0, 40, (60, 2)), TOOLS[name]
    every = drop_numpy(drop.cutter_of(tool), mesh, xy)
    np.testing.assert_allclose(ta.drop_cutter(mesh, tool, xy), every, rtol=0, atol=1e-11)


@pytest.mark.parametrize(("mesh", "points", "axis", "message"), [
    (np.empty((0, 3, 3)), [[0, 0]], (0, 0, 1), "at least one triangle"),
    (np.zeros((4, 3)), [[0, 0]], (0, 0, 1), "at least one triangle"),
    (np.full((1, 3, 3), np.nan), [[0, 0]], (0, 0, 1), "triangle 0 of the mesh .* finite"),
    ("mesh.stl", [[0, 0]], (0, 0, 1), "no array of numbers"),
    ((np.zeros((3, 3)), [[0, 1, 3]]), [[0, 0]], (0, 0, 1), "face 0 .* vertices 0 to 2"),
    ((np.zeros((3, 3)), [[0, 1, -1]]), [[0, 0]], (0, 0, 1), "face 0 .* vertices 0 to 2"),
    ((np.zeros((3, 3)), [[0, 1.0, 2]]), [[0, 0]], (0, 0, 1), "whole numbers"),
    (np.zeros((1, 3, 3)), [[0, np.inf]], (0, 0, 1), "points row 0 .* finite"),
    (np.zeros((1, 3, 3)), [[0, 0]], (0, 1, 1), "two coordinates"),
    (np.zeros((1, 3, 3)), [[0, 0, 0]], (0, 0, 0), "no direction"),
    (np.zeros((1, 3, 3)), [[0, 0, 0]], np.eye(3), "one axis at a time"),
])
def test_bad_input_is_refused_in_one_sentence(mesh, points, axis, message):
    with pytest.raises(InvalidInput, match=message):
        ta.drop_cutter(mesh, Tool.ball(6), points, axis)


def test_no_points_give_no_tips():
    assert ta.drop_cutter(np.zeros((1, 3, 3)), Tool.ball(6), np.empty((0, 2))).shape == (0,)


def test_a_mesh_shrunk_to_a_point_is_a_vertex():
    assert ta.drop_cutter(np.ones((9, 3, 3)), Tool.flat(4), [[1, 2], [1, 4]]).tolist() == [1.0, -np.inf]
