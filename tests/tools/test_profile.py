"""Generatrices: exact heights and widths, and polylines that stay inside."""

from math import cos, pi, radians, sin, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from toolaxis.errors import InvalidInput
from toolaxis.tools.profile import Profile
from toolaxis.tools.tool import Tool

TOOLS = [Tool.torus(12, 1), Tool.ball(8), Tool.flat(20), Tool.tapered(6, 3, 4), Tool.tapered(6, 1, 10),
         Tool.tapered(10, 0, 45)]


@pytest.mark.parametrize("tool, z, radius", [
    (Tool.torus(12, 1), [0.0, 0.5, 1.0, 24.0, 24.1, -0.1], [5.0, 5 + 0.75**0.5, 6.0, 6.0, 0.0, 0.0]),
    (Tool.ball(8), [0.0, 1.0, 4.0, 10.0], [0.0, 7**0.5, 4.0, 4.0]),
    (Tool.flat(20), [0.0, 1e-9, 40.0], [10.0, 10.0, 10.0]),
    (Tool.tapered(10, 0, 45), [0.0, 2.0], [5.0, 7.0]),
])
def test_radii(tool: Tool, z: list[float], radius: list[float]) -> None:
    assert tool.profile.radius_at(z) == pytest.approx(radius, abs=1e-12)


def test_a_tapered_ball_leaves_its_ball_on_the_tangent() -> None:
    profile, beta = Tool.tapered(6, 3, 4).profile, radians(4)
    radius, z = profile.tangent_point
    assert (radius, z) == pytest.approx((3 * cos(beta), 3 - 3 * sin(beta)))
    assert profile.top_radius == pytest.approx(radius + (12 - z) * tan(beta))
    below, above = profile.radius_at([z - 1e-6, z + 1e-6])
    assert (above - below) / 2e-6 == pytest.approx(tan(beta), abs=1e-6)


@pytest.mark.parametrize("tool", TOOLS, ids=lambda t: t.name)
@given(tolerance=st.floats(1e-6, 5.0))
def test_polylines_stay_inside_and_near(tool: Tool, tolerance: float) -> None:
    profile = tool.profile
    line = profile.polyline(tolerance)
    assert line[0].tolist() == [0.0, 0.0] and line[-1] == pytest.approx([profile.top_radius, profile.top])
    assert (np.diff(line[:, 1]) >= 0).all() and (np.diff(line[:, 0]) >= -1e-12).all()
    centre = np.array([profile.flat_radius, profile.corner_radius])
    middle = 0.5 * (line[:-1] + line[1:])
    on_arc = (middle[:, 1] > 0) & (line[1:, 1] <= profile.tangent_point[1] + 1e-12)
    sagitta = profile.corner_radius - np.linalg.norm(middle - centre, axis=1)
    assert (sagitta[on_arc] >= -1e-12).all() and (sagitta[on_arc] <= tolerance + 1e-12).all()
    assert (middle[:, 0] <= profile.radius_at(middle[:, 1]) + 1e-9).all()


@pytest.mark.parametrize("tool", TOOLS, ids=lambda t: t.name)
def test_the_profile_is_convex(tool: Tool) -> None:
    z = np.linspace(0, tool.profile.top, 2001)
    bend = np.diff(tool.profile.radius_at(z), 2)
    assert bend.max() < 1e-9


def test_volume_of_a_ball_end() -> None:
    z = np.linspace(0, 4, 40001)
    assert np.trapezoid(pi * Tool.ball(8).profile.radius_at(z) ** 2, z) == pytest.approx(2 / 3 * pi * 64, rel=1e-7)


@pytest.mark.parametrize("tolerance", [0.0, -1.0, float("nan")])
def test_a_polyline_needs_a_tolerance(tolerance: float) -> None:
    with pytest.raises(InvalidInput, match=r"tolerance of the cutter's polyline is .* it must be above zero"):
        Profile(5.0, 1.0, 0.0, 20.0).polyline(tolerance)
