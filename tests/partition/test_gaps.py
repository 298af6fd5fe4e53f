"""The least distance between faces, and what it says of cutters."""

import numpy as np
import pytest

from toolaxis.bladed.blade_gap import ahead, nearness, reach_along_normal, widest
from toolaxis.shape.analytic import SphericalSurface
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool


def sheet(z, size=20.0, flip=False, at=0.0):
    x = np.linspace(at, at + size, 2)
    grid = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1)
    return Face.from_bspline(np.dstack([grid, np.full((2, 2), z)]), degree=(1, 1), flip=flip)


def ball(radius, centre):
    move = np.eye(4)
    move[:3, 3] = centre
    return Face(SphericalSurface(radius).nurbs()).transformed(move)


def test_two_spheres_are_as_near_as_their_centres_say():
    found = nearness(ball(3.0, (0, 0, 0)), [ball(2.0, (4, 5, 7)), ball(1.0, (20, 0, 0))])
    assert found.distance == pytest.approx(np.sqrt(90) - 5, abs=1e-6)
    assert found.here == pytest.approx(3 * np.array([4, 5, 7]) / np.sqrt(90), abs=1e-3)
    assert found.straight


def test_a_sheet_and_a_sphere_see_each_other_straight_along_the_normal():
    found = nearness(sheet(0.0), [ball(2.0, (8, 9, 7))])
    assert found.distance == pytest.approx(5.0, abs=1e-9)
    assert found.straight
    assert widest(found, 0.1) == pytest.approx(4.9, abs=1e-9)


def test_what_stands_behind_or_aside_tells_nothing_of_cutters():
    behind = nearness(sheet(0.0, flip=True), [ball(2.0, (8, 9, 7))])
    aside = nearness(sheet(0.0), [ball(2.0, (30, 10, 3))])
    for found in (behind, aside):
        assert not found.straight
        assert widest(found, 0.1) == np.inf


def test_a_trim_hides_the_nearest_place():
    hole = np.array([[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.2, 0.8]])
    whole = sheet(0.0)
    found = nearness(whole.trimmed((whole.outline[0], hole)), [ball(2.0, (10, 10, 4))])
    assert found.distance == pytest.approx(np.hypot(6, 4) - 2, abs=1e-4)


@pytest.mark.parametrize("tool", [Tool.torus(10, 1), Tool.ball(6), Tool.flat(8)])
def test_every_cutter_in_contact_reaches_its_diameter_along_the_normal(tool):
    """The line from any contact along the normal, sampled, leaves the cutter no nearer than its diameter."""
    corner, radius = tool.corner_radius, tool.radius
    flat = radius - corner
    assert reach_along_normal(tool) == pytest.approx(2 * radius)
    for angle in np.radians([1.0, 20.0, 45.0, 70.0, 90.0]):
        start = np.array([-(flat + corner * np.sin(angle)), corner * (1 - np.cos(angle))])
        inward = np.array([np.sin(angle), np.cos(angle)])
        at = start + np.linspace(1e-6, 2 * radius - 1e-6, 400)[:, None] * inward
        r, z = np.abs(at[:, 0]), at[:, 1]
        low = np.where(r <= flat, 0.0, corner - np.sqrt(np.maximum(corner**2 - np.maximum(r - flat, 0.0)**2, 0.0)))
        assert ((r <= radius + 1e-9) & (z >= low - 1e-9)).all()


def test_short_flutes_reach_less():
    assert reach_along_normal(Tool.torus(10, 1, flute_length=6)) == pytest.approx(5.0)


def test_ahead_is_the_distance_along_the_normal_and_not_the_least_one():
    c, s = np.cos(0.3), np.sin(0.3)
    lean = sheet(0.0).transformed([[c, 0, -s, 0], [0, 1, 0, 0], [s, 0, c, 5], [0, 0, 0, 1.0]])
    found = ahead(sheet(0.0), [lean])
    assert found is not None and found.straight
    assert found.distance == pytest.approx(5.0, abs=1e-6)
    assert nearness(sheet(0.0), [lean]).distance == pytest.approx(5.0, abs=1e-6)
    turned = ahead(lean.transformed(np.diag([1.0, 1, 1, 1])), [sheet(0.0)])
    assert turned is None  # its normals point away
    back = ahead(sheet(0.0, flip=True), [lean])
    assert back is None
