"""Two-point contact: the paper's rows, closed forms on cylinders, and no gouge where the formula gouges."""

import json
from pathlib import Path

import numpy as np
import pytest

from toolaxis.contact.clearance.gouge import penetration, segment_gouges
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import unit
from toolaxis.shape.analytic import CylindricalSurface
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.strategies.two_point.contact import (
    TOUCH,
    balance,
    circle_strip_width,
    gouge_free_lean,
    lower_to_contact,
    match_lead,
    settle,
    two_point_lead,
)
from toolaxis.strategies.two_point.gouge_check import turning_gouges
from toolaxis.strategies.two_point.rings import ContactSet, Posture, rings, stand_of
from toolaxis.tools.tool import Tool

EXAMPLE = Path(__file__).parents[2] / "examples" / "biquintic.json"
ROWS = [(40, 48.5904, 46.3712, 23.0002, 31.2769), (60, 30.0000, 28.1881, 22.4108, 30.8468),
        (100, 17.4576, 16.0541, 24.2439, 33.4045), (240, 7.1808, 6.2748, 29.3027, 39.9754)]


def trough(radius, half=0.6, length=80.0, hollow=True):
    """Part of a cylinder along v, seen from inside or from outside."""
    return Face(CylindricalSurface(radius, (-half, half), (0.0, length)).nurbs(), flip=hollow)


def along(face, uv, radius=30.0, tolerance=0.03, allowance=0.0, tool=None):
    uv = np.atleast_2d(uv)
    return ContactSet(face, tool or Tool.flat(2 * radius), uv, face.evaluate(uv).sv, tolerance, allowance)


@pytest.fixture(scope="module")
def biquintic():
    return Face.from_bspline(json.loads(EXAMPLE.read_text())["points"], (5, 5))


@pytest.mark.parametrize("rho, one, two, narrow, wide", ROWS)
def test_rows_of_the_formula(rho, one, two, narrow, wide):
    first, second = match_lead(30.0, rho), two_point_lead(30.0, rho, 0.03)
    found = [*np.degrees([first, second]), circle_strip_width(30.0, rho, 0.03, first, 0.0),
             circle_strip_width(30.0, rho, 0.03, second, 0.03)]
    np.testing.assert_allclose(found, [one, two, narrow, wide], atol=1e-4)


def test_formula_as_printed_and_the_gain_in_width():
    rho, d, radius = np.linspace(31.0, 2000.0, 4000), 0.03, 30.0
    printed = np.arcsin((radius * (rho - d) - np.sqrt((rho**2 - radius**2) * d * (2 * rho - d))) / rho**2)
    found = two_point_lead(radius, rho, d)
    np.testing.assert_allclose(found, printed, atol=1e-9)
    gain = (circle_strip_width(radius, rho, d, found, d)
            / circle_strip_width(radius, rho, d, match_lead(radius, rho), 0.0))
    assert gain.max() == pytest.approx(1.3785, abs=1e-4) and rho[gain.argmax()] == pytest.approx(82, abs=2)
    thin = circle_strip_width(radius, 100.0, 1e-8, two_point_lead(radius, 100.0, 1e-8), 1e-8)
    one = circle_strip_width(radius, 100.0, 1e-8, match_lead(radius, 100.0), 0.0)
    assert thin / one == pytest.approx(2**0.5, abs=1e-3)


def test_formula_minds_the_back_of_the_bottom():
    assert np.degrees(two_point_lead(30.0, 100.0, 0.03, 1 / 60)) == pytest.approx(30.0)
    assert np.degrees(two_point_lead(30.0, 100.0, 0.03, -1 / 60)) == pytest.approx(16.0541, abs=1e-4)


@pytest.mark.parametrize("rho, tolerance, what", [(30.0, 0.03, "tighter|tight"), (-50.0, 0.03, "convex"),
                                                   (100.0, 0.0, "above zero"), (100.0, 31.0, "below the cutter")])
def test_formula_refuses(rho, tolerance, what):
    with pytest.raises(InvalidInput, match=what):
        two_point_lead(30.0, rho, tolerance)


@pytest.mark.parametrize("tool", [Tool.ball(8), Tool.tapered(6, 1, 4)])
def test_cutters_without_a_flat_bottom_are_refused(tool):
    with pytest.raises(InvalidInput, match="flat bottom"):
        along(trough(60.0), [0.0, 40.0], tool=tool)


@pytest.mark.parametrize("tool, allowance", [(Tool.flat(60), 0.0), (Tool.flat(60), 0.5), (Tool.torus(60, 5), 0.0)])
def test_on_a_trough_the_settled_lean_is_the_formulas(tool, allowance):
    """Along a cylinder nothing is neglected: the ring moves over a circle that is smaller by corner and stock."""
    rho = 100.0 - allowance - tool.corner_radius
    stand, ring = settle(along(trough(100.0), [[0.0, 40.0], [0.1, 40.0]], allowance=allowance, tool=tool), 0.03)
    np.testing.assert_allclose(stand.lean, two_point_lead(tool.flat_radius, rho, 0.03), atol=5e-5)
    np.testing.assert_allclose(stand.lift, 0.03, atol=1e-9)
    np.testing.assert_allclose(ring.sides, 0.0, atol=TOUCH / 10)
    one, _ = settle(along(trough(100.0), [[0.0, 40.0]], allowance=allowance, tool=tool), 0.0)
    assert one.lean[0] == pytest.approx(float(match_lead(tool.flat_radius, rho)), abs=5e-4)


def test_on_a_ridge_there_is_one_contact_at_the_least_lean():
    setting = along(trough(100.0, hollow=False), [0.0, 40.0])
    stand, _ = settle(setting, 0.03)
    assert stand.lift[0] == pytest.approx(0.0, abs=1e-6)
    assert stand.lean[0] == pytest.approx(setting.least_lean, abs=1e-9)


def test_where_the_cutter_does_not_fit_it_stays_above():
    setting = along(trough(25.0, half=1.2), [0.0, 40.0])
    stand, ring = settle(setting, 0.03)
    assert stand.lift[0] > 0.05 and ring.least[0] >= -1e-4


def test_true_posture_at_the_middle_of_the_sample_surface(biquintic):
    """The formula gives 17.368 degrees and gouges; 17.684 do not."""
    uv = np.array([[0.5, 0.5]])
    setting = ContactSet(biquintic, Tool.flat(60), uv, biquintic.evaluate(uv).su, 0.03)
    stand, ring = settle(setting, 0.03)
    assert np.degrees(stand.lean[0]) == pytest.approx(17.684, abs=1e-3)
    np.testing.assert_allclose(ring.sides, 0.0, atol=TOUCH)
    assert penetration(setting.tool, ring.tip, ring.axis, (biquintic,)).max() < 0.001
    across = 1 / setting.curvatures()[1][0]
    formula = Posture(np.atleast_1d(two_point_lead(30.0, across, 0.03)), np.zeros(1), np.array([0.03]))
    assert np.degrees(formula.lean[0]) == pytest.approx(17.368, abs=1e-3)
    printed = rings(setting, formula)
    assert printed.least[0] < -0.015
    assert penetration(setting.tool, printed.tip, printed.axis, (biquintic,)).max() > 0.015


@pytest.mark.parametrize("place, sense", [((0.5, 0.0), 1), ((1.0, 0.25), -1)])
def test_no_gouge_is_seen_where_heights_beside_the_contact_differ(biquintic, place, sense):
    """On the border the face bends on one side only: the least height is the contact's all the same."""
    uv = np.array([place])
    setting = ContactSet(biquintic, Tool.flat(60), uv, sense * biquintic.evaluate(uv).su, 0.03)
    for lean in np.radians([20.0, 25.0, 40.0]):
        ring = rings(setting, Posture(np.array([lean]), np.zeros(1), np.zeros(1)))
        assert ring.height.min() >= -1e-9 and ring.least[0] >= -1e-9
    stand, ring = settle(setting, 0.0)
    assert np.degrees(stand.lean[0]) < 21.0 and ring.least[0] >= -1e-5


def test_the_least_height_between_angles(biquintic):
    """Against the ring of a cutter turned by parts of the step between angles."""
    uv = np.array([[0.8, 0.3]])
    setting = ContactSet(biquintic, Tool.flat(60), uv, biquintic.evaluate(uv).su, 0.03)
    ring = rings(setting, Posture(np.radians([17.0]), np.zeros(1), np.zeros(1)))
    ahead = unit(np.cross(np.cross(ring.axis, setting.frame.feed), ring.axis))
    angle = np.linspace(-np.pi, np.pi, 2401)[:, None]
    points = ring.tip + 30.0 * (np.cos(angle) * ahead + np.sin(angle) * np.cross(ring.axis, ahead))
    found = nearest(biquintic, points)
    inside = biquintic.contains(found.uv)
    height = np.einsum("ij,ij->i", points - found.point, biquintic.normal(found.uv))[inside]
    assert ring.least[0] == pytest.approx(height.min(), abs=2e-5) and height.min() < -1.0


def test_heights_of_rings_are_distances(biquintic):
    uv = np.array([[0.4, 0.55]])
    setting = ContactSet(biquintic, Tool.flat(60), uv, biquintic.evaluate(uv).su, 0.03)
    ring = rings(setting, Posture(np.array([0.35]), np.array([0.1]), np.array([0.03])))
    foot = biquintic.evaluate(ring.uv[0]).point
    points = foot + ring.height[0][:, None] * biquintic.normal(ring.uv[0])
    inside = ((ring.uv[0] > 0.01) & (ring.uv[0] < 0.99)).all(axis=1)
    assert inside.sum() > 60
    np.testing.assert_allclose(nearest(biquintic, points[inside]).distance, np.abs(ring.height[0][inside]), atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(points - ring.tip, axis=1), 30.0, atol=1e-3)
    np.testing.assert_allclose((points - ring.tip) @ ring.axis[0], 0.0, atol=1e-3)


def test_sides_are_balanced_by_turning_aside(biquintic):
    uv = np.array([[0.3, 0.15], [0.5, 0.2]])
    setting = ContactSet(biquintic, Tool.flat(60), uv, biquintic.evaluate(uv).su, 0.03)
    turned = balance(setting, 0.03)
    assert np.isfinite(turned).all() and (np.abs(turned) > 1e-4).all()
    even, uneven = settle(setting, 0.03, turned)[1].sides, settle(setting, 0.03)[1].sides
    assert (np.abs(even).max(axis=1) < TOUCH).all()
    assert (np.abs(even).max(axis=1) < np.abs(uneven).max(axis=1)).all()


def test_raised_and_sunk_touch():
    setting = along(trough(100.0), [0.0, 40.0])
    low = Posture(np.array([0.1]), np.zeros(1), np.array([0.03]))
    stand, ring = gouge_free_lean(setting, low)
    assert stand.lean[0] == pytest.approx(float(two_point_lead(30.0, 100.0, 0.03)), abs=2e-5) and ring.least[0] > -2e-5
    above = Posture(np.array([0.6]), np.zeros(1), np.array([0.5]))
    stand, ring = lower_to_contact(setting, above)
    assert stand.lift[0] == pytest.approx(0.0, abs=1e-5) and ring.least[0] == pytest.approx(0.0, abs=1e-5)


def test_how_a_cutter_stands_is_read_from_tip_and_axis(biquintic):
    uv = np.array([[0.3, 0.4], [0.8, 0.7]])
    setting = ContactSet(biquintic, Tool.torus(60, 4), uv, biquintic.evaluate(uv).su, 0.03, 0.5)
    stand = Posture(np.array([0.3, 0.5]), np.array([0.2, -0.4]), np.array([0.02, 0.3]))
    ring = rings(setting, stand)
    again = stand_of(setting, ring.tip, ring.axis)
    for name in ("lean", "direction", "lift"):
        np.testing.assert_allclose(getattr(again, name), getattr(stand, name), atol=1e-9)


def plane(size=200.0):
    return Face.from_bspline(np.array([[[0, 0, 0], [0, size, 0]], [[size, 0, 0], [size, size, 0.0]]]) - size / 2,
                             (1, 1)).transformed(np.block([[np.eye(3), np.array([[0], [0], [size / 2]])],
                                                           [np.zeros((1, 3)), 1]]))


def test_turning_shows_what_happens_between_points():
    """A flat end that turns over upright reaches deepest between: its rim by R sin, there where both ends are free."""
    tool, face = Tool.flat(20), plane()
    lean = np.radians([-4.0, 4.0])
    axes = np.column_stack([np.sin(lean), np.zeros(2), np.cos(lean)])
    tips = np.array([[0, 0, 1.0], [0, 0, 1.0]]) * 10 * np.sin(np.radians(4.0)) + [0, 0, 0.001]
    assert not turning_gouges(tool, tips, axes, (face,), 0.002)[0]
    low = tips - [0, 0, 0.02]
    assert turning_gouges(tool, low, axes, (face,), 0.002)[0]
    # With the tip on a slope down and up again, ends free, the middle is not.
    steep, lean = np.array([[-5, 0, 0.8], [5, 0, 0.1]]), unit(np.array([[0.07, 0, 1.0], [0.0, 0, 1.0]]))
    assert not turning_gouges(tool, steep, lean, (face,), 0.002)[0]
    assert turning_gouges(tool, steep - [0, 0, 0.11], lean, (face,), 0.002)[0]


def test_motions_without_a_turn_are_judged_as_straight_ones():
    tool, face = Tool.flat(20), plane()
    tips = np.array([[-20, 0, 0.0], [0, 0, -0.001], [10, 0, -0.05], [30, 5, 0.2]])
    axes = np.tile([0.0, 0.0, 1.0], (4, 1))
    expected = segment_gouges(tool, tips, axes[:1], (face,), 0.002)
    assert expected.tolist() == [False, True, True]
    assert (turning_gouges(tool, tips, axes, (face,), 0.002) == expected).all()


def test_turning_refuses():
    with pytest.raises(InvalidInput, match="axes are given"):
        turning_gouges(Tool.flat(20), np.zeros((3, 3)), [[0, 0, 1.0]], (plane(),), 0.002)
    with pytest.raises(InvalidInput, match="above zero"):
        turning_gouges(Tool.flat(20), np.zeros((2, 3)), [[0, 0, 1.0]] * 2, (plane(),), 0.0)
