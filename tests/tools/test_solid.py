"""Exact signed distance to the rotating solid, against a border that was sampled densely."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import cKDTree

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import rotation
from toolaxis.tools.solid import nearest_piece, nearest_piece_numpy, outline_pieces, signed_distance, solid_pieces
from toolaxis.tools.tool import Tool

BODY = {"stickout": 40, "shank": [(4, 0), (4, 30), (6, 36), (6, 60)],
        "holder": [(9, 0), (14, 12), (11, 20), (20, 20), (20, 45)]}
TOOLS = {
    "torus": Tool.torus(12, 1.5, flute_length=14, **BODY),
    "ball": Tool.ball(8, flute_length=9, **BODY),
    "flat": Tool.flat(10, flute_length=12, **BODY),
    "tapered": Tool.tapered(6, 2, 8, flute_length=25, **BODY),
    "stepped": Tool.torus(10, 2, flute_length=10, stickout=30,
                          holder=[(6, 0), (12, 0), (12, 3), (5, 3), (5, 9), (14, 9), (5, 9), (5, 20)]),
}


def _borders(tool, step=0.004):
    """Meridian border of each component, sampled: cutter with its arc, then the turned bodies, caps included."""
    p = tool.profile
    t = np.linspace(0, np.pi / 2 - p.half_angle, 4000)
    arc = np.stack([p.flat_radius + p.corner_radius * np.sin(t), p.corner_radius * (1 - np.cos(t))], axis=1)
    found = {"cutter": np.vstack([_line([(0, 0), (p.flat_radius, 0)], step), arc,
                                  _line([arc[-1], (p.top_radius, p.top), (0, p.top)], step)])}
    for name, rows in tool.outlines.items():
        found[name] = _line([(0, rows[0, 1]), *rows, (0, rows[-1, 1])], step)
    return found


def _line(corners, step):
    parts = []
    for a, b in zip(np.asarray(corners[:-1], float), np.asarray(corners[1:], float), strict=True):
        n = max(2, int(np.ceil(np.linalg.norm(b - a) / step)))
        parts.append(a + (b - a) * np.linspace(0, 1, n + 1)[:, None])
    return np.vstack(parts)


def _within(tool, rho, z):
    """Whether meridian points lie strictly inside the union."""
    heights = [tool.profile.radius_at(z)]
    for rows in tool.outlines.values():
        inside = (z > rows[0, 1]) & (z < rows[-1, 1])
        radius = np.zeros_like(z)
        for (r0, z0), (r1, z1) in pairwise(rows):
            if z1 > z0:
                here = (z >= z0) & (z < z1)
                radius[here] = r0 + (r1 - r0) * (z[here] - z0) / (z1 - z0)
        heights.append(np.where(inside, radius, 0.0))
    return rho < np.max(heights, axis=0)


def _border_of_union(tool):
    """The samples of all borders that are not inside the union, seen from a little outwards on some side."""
    points = np.vstack(list(_borders(tool).values()))
    tiny = 1e-6
    around = [_within(tool, np.abs(points[:, 0] + tiny * np.cos(t)), points[:, 1] + tiny * np.sin(t))
              for t in np.linspace(0, 2 * np.pi, 16, endpoint=False) + 0.1]
    share = np.mean(around, axis=0)
    return points[(share < 1) & (share > 0)]


def _points(rng, n):
    return np.column_stack([rng.uniform(-24, 24, (n, 2)), rng.uniform(-8, 95, n)])


@pytest.mark.parametrize("name", TOOLS)
def test_whole_solid_against_sampled_border(name):
    tool, rng = TOOLS[name], np.random.default_rng(7)
    points = _points(rng, 400)
    points[:100, :2] *= 0.2
    rho, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    away = cKDTree(np.vstack(list(_borders(tool).values()))).query(np.stack([rho, z], 1))[0]
    within = _within(tool, rho, z)
    deep = cKDTree(_border_of_union(tool)).query(np.stack([rho, z], 1))[0]
    wanted = np.where(within, -deep, away)
    found = signed_distance(solid_pieces(tool.profile, tool.outlines), points)
    assert within.sum() > 40
    assert np.abs(found.value - wanted).max() < 0.003  # half the sampling step, tangentially
    assert np.allclose(np.linalg.norm(found.gradient, axis=1), 1)


@pytest.mark.parametrize("name", TOOLS)
def test_components_against_sampled_border(name):
    tool, rng = TOOLS[name], np.random.default_rng(8)
    points = _points(rng, 300)
    rho, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    for component, border in _borders(tool).items():
        found = tool.distance(points, component).value
        away = cKDTree(border).query(np.stack([rho, z], 1))[0]
        outside = found > 0
        assert np.abs(found[outside] - away[outside]).max() < 0.003
        assert outside.sum() > 100


@pytest.mark.parametrize("name", TOOLS)
def test_gradient_is_the_slope(name):
    tool, rng = TOOLS[name], np.random.default_rng(9)
    points, way = _points(rng, 500), rng.standard_normal((500, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    d, h = tool.distance(points), 1e-6
    slope = (tool.distance(points + h * way).value - tool.distance(points - h * way).value) / (2 * h)
    wrong = np.abs(slope - np.sum(d.gradient * way, axis=1)) > 1e-4
    assert wrong.mean() < 0.01  # steps across an edge of the distance
    assert (np.abs(slope) <= 1 + 1e-6).all()


def test_exact_cases():
    torus = TOOLS["torus"]
    edge = [6 + 3 / np.sqrt(2) - 1.5 + 0, 0, 1.5 - 3 / np.sqrt(2)]
    points = [[0, 0, -2], [0, 0, 0], [4.5, 0, 0], [6, 0, 1.5], edge, [8, 0, 5], [0, 0, 90], [20, 0, 62], [0, 0, 2]]
    wanted = [2, 0, 0, 0, 1.5, 2, 5, 0, -2]
    assert torus.distance(points).value == pytest.approx(wanted, abs=1e-12)
    assert torus.distance(points[:1]).gradient[0] == pytest.approx([0, 0, -1])
    assert torus.distance([[0, 0, 14]]).value[0] == pytest.approx(-4)  # inside the neck: no border between components


def test_flange_without_thickness_is_seen():
    stepped = TOOLS["stepped"]
    assert stepped.distance([[13.5, 0, 39]], "holder").value[0] == pytest.approx(0, abs=1e-12)
    assert stepped.distance([[14, 0, 41]], "holder").value[0] == pytest.approx(2)
    assert len(outline_pieces(np.array([[5.0, 0], [9, 0], [5, 0], [5, 4]]), 2)) == 2


def test_cutter_is_convex():
    rng = np.random.default_rng(10)
    for tool in TOOLS.values():
        p, q = _points(rng, 2000), _points(rng, 2000)
        d = tool.distance(p, "cutter")
        assert (tool.distance(q, "cutter").value
                >= d.value + np.sum(d.gradient * (q - p), axis=1) - 1e-9).all()


def test_turns_with_the_tool():
    rng, turn = np.random.default_rng(11), rotation([0, 0, 1], 0.7)
    points = _points(rng, 200)
    one, other = TOOLS["tapered"].distance(points), TOOLS["tapered"].distance(points @ turn.T)
    assert one.value == pytest.approx(other.value, abs=1e-12)
    assert one.gradient @ turn.T == pytest.approx(other.gradient, abs=1e-9)


def test_kernel_and_twin_agree():
    rng = np.random.default_rng(12)
    rho, z = np.abs(rng.uniform(-24, 24, 5000)), rng.uniform(-8, 95, 5000)
    for tool in TOOLS.values():
        pieces = solid_pieces(tool.profile, tool.outlines)
        assert np.abs(nearest_piece(pieces, rho, z) - nearest_piece_numpy(pieces, rho, z)).max() < 1e-12


def test_bad_input():
    with pytest.raises(InvalidInput, match="finite"):
        TOOLS["ball"].distance([[0, 0, np.nan]])
    with pytest.raises(InvalidInput, match="holder"):
        Tool.ball(8).distance([[0, 0, 0]], "holder")
