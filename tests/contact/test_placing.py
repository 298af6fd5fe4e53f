"""Tool tips: Eq. 1 in numbers, and the placed cutter touches the surface at its contact and nowhere lower."""

import numpy as np
import pytest

from toolaxis.contact.placement import place, tips
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

PLANE = Face.from_bspline([[[0, 0, 0], [0, 60, 0]], [[60, 0, 0], [60, 60, 0]]], degree=(1, 1))
TOOLS = [Tool.torus(12, 1), Tool.torus(16, 6), Tool.ball(8), Tool.flat(20), Tool.tapered(6, 1, 4),
         Tool.tapered(6, 3, 10)]


def axis_of(lean_deg, way_deg=0.0):
    lean, way = np.radians(lean_deg), np.radians(way_deg)
    return np.array([np.sin(lean) * np.cos(way), np.sin(lean) * np.sin(way), np.cos(lean)])


def surface_of(tool, tip, axis):
    """Points of the cutter's bottom and arc, built from circles about the axis."""
    x = np.linalg.svd(axis[None])[2][1]
    y = np.cross(axis, x)
    angle = np.radians(np.arange(0, 360, 0.25))[:, None, None]
    arc = np.linspace(0, np.pi / 2 - tool.half_angle, 721)[:, None]
    rho, z = tool.flat_radius + tool.corner_radius * np.sin(arc), tool.corner_radius * (1 - np.cos(arc))
    return (tip + rho * (np.cos(angle) * x + np.sin(angle) * y) + z * axis).reshape(-1, 3)


@pytest.mark.parametrize("tool, lean, tip", [
    # (-a cos - r sin, 0, r + a sin - r cos), from the meridian plane of the plane's contact
    (Tool.torus(12, 1), 10, (-5.097686942728, 0.0, 0.883433135322)),
    (Tool.torus(12, 1), 30, (-4.830127018922, 0.0, 2.633974596216)),
    (Tool.ball(12), 30, (-3.0, 0.0, 0.803847577293)),
    (Tool.flat(20), 5, (-9.961946980917, 0.0, 0.871557427477))])
def test_tip_on_a_plane_in_numbers(tool, lean, tip):
    found = place(PLANE, tool, [[0.5, 0.5]], axis_of(lean))[0] - [30, 30, 0]
    assert np.abs(found - tip).max() < 1e-11


@pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.name)
@pytest.mark.parametrize("allowance", [0.0, 0.3])
def test_the_placed_cutter_touches_the_plane_at_its_contact(tool, allowance):
    for lean, way in [(3, 0), (12, 70), (35, 200), (60, 310)]:
        axis = axis_of(lean, way)
        points = surface_of(tool, place(PLANE, tool, [[0.4, 0.6]], axis, allowance)[0], axis)
        lowest = points[points[:, 2].argmin()]
        assert abs(lowest[2] - allowance) < 1e-3  # the circles are a quarter of a degree apart
        assert np.abs(lowest[:2] - [24, 36]).max() < 0.05 + 0.002 * tool.radius / np.sin(np.radians(lean))


def test_a_ball_keeps_its_centre_over_the_contact():
    rng = np.random.default_rng(3)
    normal = rng.normal(size=(40, 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    axis = rng.normal(size=(40, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    points = rng.normal(size=(40, 3)) * 20
    found = tips(points, normal, axis, Tool.ball(7), 0.1) + 3.5 * axis - points
    assert np.abs(found - 3.6 * normal).max() < 1e-14


@pytest.mark.parametrize("tool, tip", [(Tool.torus(12, 1), [30, 30, 0]), (Tool.ball(12), [30, 30, 0]),
                                       (Tool.flat(12), [30, 30, 0])])
def test_upright_the_tip_stands_on_the_contact(tool, tip):
    assert np.allclose(place(PLANE, tool, [[0.5, 0.5]], [0, 0, 1]), [tip], atol=1e-14)


def test_tips_move_with_the_part():
    rng = np.random.default_rng(5)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    shift = rng.normal(size=3) * 10
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, shift
    uv, axis = rng.uniform(0, 1, (20, 2)), axis_of(25, 40)
    here = place(PLANE, TOOLS[0], uv, axis)
    there = place(PLANE.transformed(matrix), TOOLS[0], uv, turn @ axis)
    assert np.abs(there - (here @ turn.T + shift)).max() < 1e-12
