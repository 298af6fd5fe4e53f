"""Material removal against closed forms, brute force, and itself moved."""

import numpy as np
import pytest

from toolaxis.errors import Cancelled, InvalidInput
from toolaxis.numeric import jit as compiled
from toolaxis.numeric.vectors import rotation, unit
from toolaxis.progress import Progress
from toolaxis.tools.profile import Profile
from toolaxis.verify import linear_motions as motions
from toolaxis.verify.material_removal import removal

UP = np.array([0.0, 0.0, 1.0])

#: R, r, lead in degrees, h, strip width: resources/manual, exact swept widths on a plane.
WIDTHS = [
    (5, 3, 20, 0.1, 2.616177), (5, 3, 20, 0.02, 1.185783), (6, 1, 5, 0.1, 6.445430), (6, 1, 5, 0.02, 3.021934),
    (6, 1, 10, 0.1, 4.749392), (6, 1, 10, 0.02, 2.171571), (6, 1, 20, 0.1, 3.489056), (6, 1, 20, 0.02, 1.576752),
    (8, 2, 10, 0.1, 5.290774), (8, 2, 10, 0.02, 2.407950), (6, 6, 0, 0.1, 2.181742), (6, 6, 15, 0.02, 0.978979),
    (10, 0, 5, 0.1, 9.301820),
]

#: Radius of the cylinder (positive convex), R, r, lead, strip width in arc length at h = 0.02; feed along the axis.
CYLINDERS = [
    (40, 6, 1, 5, 1.944537), (40, 6, 1, 10, 1.649383), (40, 6, 1, 20, 1.338298), (-60, 6, 1, 5, 7.100029),
    (-60, 6, 1, 10, 3.015847), (-60, 6, 1, 20, 1.830238), (40, 6, 6, 0, 0.912679), (-60, 6, 6, 0, 1.032110),
]


def profile(R, r, top=24.0):
    return Profile(R - r, r, 0.0, top)


@pytest.mark.parametrize(("R", "r", "lead", "h", "width"), WIDTHS)
def test_height_between_two_passes_is_their_scallop(plane_passes, R, r, lead, h, width):
    cl = plane_passes((R, r), np.radians(lead), [-width / 2, width / 2])
    y = np.linspace(-width / 2, width / 2, 81)
    point = np.column_stack([np.linspace(-0.6, 0.7, 81), y, 0 * y])
    left = removal(cl, profile(R, r), (point, np.tile(UP, (81, 1))))
    # The widths are given to 5e-7 mm; near the cusp the height changes by 4 h / W of that.
    assert left.remaining.max() == pytest.approx(h, abs=4 * h / width * 1e-6)
    assert np.argmax(left.remaining) == 40
    assert left.gouge.max() < 1e-9


@pytest.mark.parametrize(("R", "r", "lead"), [(6, 1, 10), (5, 3, 20), (10, 0, 5)])
def test_whole_section_of_one_pass_is_the_envelope(plane_passes, R, r, lead):
    lam = np.radians(lead)
    a, b = R - r, (R - r) * np.sin(lam)
    t = np.linspace(0.02, 1.2, 60)
    q = np.sqrt(b**2 * np.sin(t) ** 2 + a**2 * np.cos(t) ** 2)
    y = a * np.sin(t) + r * b * np.sin(t) / q
    z = r + b - b * np.cos(t) - r * a * np.cos(t) / q
    cl = plane_passes((R, r), lam, [0.0])
    left = removal(cl, profile(R, r), (np.column_stack([0 * y, y, 0 * y]), np.tile(UP, (60, 1))))
    np.testing.assert_allclose(left.remaining, z, atol=2e-9)


@pytest.mark.parametrize(("rho", "R", "r", "lead", "width"), CYLINDERS)
def test_half_width_on_a_cylinder(place, rho, R, r, lead, width):
    lam = np.radians(lead)
    x = np.array([-20.0, 20.0])
    axis = np.tile([np.sin(lam), 0.0, np.cos(lam)], (2, 1))
    tip = place(np.column_stack([x, 0 * x, 0 * x]), UP, axis, (R, r))
    angle = np.array([-0.5, 0.5]) * width / rho
    normal = np.column_stack([0 * angle, np.sin(angle), np.cos(angle)])
    foot = rho * (normal - UP)
    left = removal((tip, axis, np.zeros(2, dtype=int)), profile(R, r), (foot, normal))
    np.testing.assert_allclose(left.remaining, 0.02, rtol=2e-6)


@pytest.mark.parametrize(("rho", "width"), [(80, 0.944095), (-80, 1.018023)])
def test_half_width_of_a_ball_on_a_sphere(rho, width):
    angle = np.linspace(-0.3, 0.3, 4001)
    along = np.column_stack([np.sin(angle), 0 * angle, np.cos(angle)])
    tip = (rho + 6) * along - rho * UP - 6 * UP
    across = 0.5 * width / rho
    normal = np.array([[0.0, np.sin(across), np.cos(across)]])
    axis = np.tile(UP, (len(tip), 1))
    left = removal((tip, axis, np.zeros(len(tip), dtype=int)), profile(6, 6), (rho * (normal - UP), normal))
    # The polyline's chords sag by (80 * 0.6 / 4000)^2 / (8 * 80).
    np.testing.assert_allclose(left.remaining, 0.02, atol=4e-7)


def test_planted_gouge_of_five_micrometres(plane_passes):
    tips, axes, kind = plane_passes((6, 1), np.radians(10), [0.0], step=1.0)
    at = 21
    tips[at] -= 0.005 * UP
    contact = tips[at, 0] + 5 * np.cos(np.radians(10)) + np.sin(np.radians(10))
    line = np.column_stack([contact + np.linspace(-0.2, 0.2, 41), np.zeros(41), np.zeros(41)])
    left = removal((tips, axes, kind), profile(6, 1), (line, np.tile(UP, (41, 1))))
    assert left.gouge.max() == pytest.approx(0.005, abs=2e-5)
    assert left.gouged_by[np.argmax(left.gouge)] in (at, at + 1)
    assert left.remaining[np.argmax(left.gouge)] == 0.0


def test_missing_pass_is_not_reached(plane_passes):
    width = 2.0
    whole, gap = np.arange(-10, 10.1, width), np.array([-10.0, -8, -6, 6, 8, 10])
    y = np.linspace(-10, 10, 101)
    rays = (np.column_stack([0 * y, y, 0 * y]), np.tile(UP, (101, 1)))
    full = removal(plane_passes((3, 3), 0.0, whole), profile(3, 3), rays, height=0.5)
    holed = removal(plane_passes((3, 3), 0.0, gap), profile(3, 3), rays, height=0.5)
    assert np.isfinite(full.remaining).all()
    reach = np.sqrt(2 * 3 * 0.5 - 0.25)
    np.testing.assert_array_equal(np.isinf(holed.remaining), np.abs(y) < 6 - reach)
    assert (holed.cut_by[np.isinf(holed.remaining)] == -1).all()


def test_link_through_the_material_is_a_gouge_and_removes_nothing(plane_passes):
    tips, axes, kind = plane_passes((3, 3), 0.0, [-4.0, 4.0])
    last, first = 82, 84
    tips[last:first] -= 10.2 * UP  # the link between the passes stays 0.2 mm below the plane instead of 10 mm above
    y = np.linspace(-1, 1, 11)
    rays = (np.column_stack([np.full(11, 20.0), y, 0 * y]), np.tile(UP, (11, 1)))
    left = removal((tips, axes, kind), profile(3, 3), rays)
    np.testing.assert_allclose(left.gouge, 0.2, atol=1e-7)
    assert np.isin(kind[left.gouged_by], 3).all()
    assert (left.remaining > 0.5).all()


def brute_force(cl, cutter, rays, fine=(601, 401)):
    """First t >= 0 and deepest t < 0 inside any of very many still cutters, by the profile's radius at each height."""
    tips, axes, _ = cl
    foot, normal = rays
    t = np.linspace(-1.0, 1.0, fine[1])
    inside = np.zeros((len(foot), len(t)), dtype=bool)
    for i in range(len(tips) - 1):
        for s in np.linspace(0, 1, fine[0]):
            axis = unit((1 - s) * axes[i] + s * axes[i + 1])
            w = foot[:, None] + t[:, None] * normal[:, None] - (1 - s) * tips[i] - s * tips[i + 1]
            z = w @ axis
            across = np.sqrt(np.maximum((w**2).sum(axis=2) - z**2, 0))
            inside |= (z >= 0) & (z <= cutter.top) & (across <= cutter.radius_at(z))
    first = np.where(inside[:, t >= 0].any(axis=1), t[t >= 0][np.argmax(inside[:, t >= 0], axis=1)], np.inf)
    deep = np.where(inside[:, t < 0].any(axis=1), -t[t < 0][np.argmax(inside[:, t < 0], axis=1)], 0.0)
    return first, deep


@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(2, 6))])
def test_random_motions_against_brute_force(seed):
    rng = np.random.default_rng(seed)
    cutter = [Profile(2.5, 0.5, 0, 6), Profile(0, 3, 0, 5), Profile(3, 0, 0, 5), Profile(0.5, 1.0, 0.2, 6)][seed % 4]
    axes = unit(UP + 0.25 * rng.normal(size=(3, 3)))
    if seed < 3:
        axes[:] = axes[0]
    tips = np.array([[-2.0, 0, 0], [0.4, 0.3, 0], [2, -0.5, 0]]) + 0.15 * rng.normal(size=(3, 3))
    normal = unit(UP + 0.3 * rng.normal(size=(60, 3)))
    foot = np.column_stack([rng.uniform(-4, 4, 60), rng.uniform(-3, 3, 60), rng.uniform(-0.2, 0.2, 60)])
    cl, rays = (tips, axes, np.zeros(3, dtype=int)), (foot, normal)
    left = removal(cl, cutter, rays, height=1.0)
    first, deep = brute_force(cl, cutter, rays)
    # Still cutters 0.004 mm apart and 0.005 mm between the t: brute force misses up to so much, and never finds more.
    agree = np.isfinite(first) & np.isfinite(left.remaining)
    assert agree.sum() > 10
    assert (np.isfinite(first) <= np.isfinite(left.remaining)).all()
    assert (first[agree] >= left.remaining[agree] - left.uncertainty).all()
    assert np.quantile(first[agree] - left.remaining[agree], 0.9) < 0.008
    assert (deep <= left.gouge + left.uncertainty).all()
    assert np.quantile(left.gouge - deep, 0.9) < 0.008


def test_flat_cutter_that_swings_leaves_the_wedges_of_its_bottom():
    lean = np.radians(20)
    axes = np.array([[-np.sin(lean), 0, np.cos(lean)], [np.sin(lean), 0, np.cos(lean)]])
    x = np.linspace(-5.9, 5.9, 60) * np.cos(lean)
    cl = (np.zeros((2, 3)), axes, np.zeros(2, dtype=int))
    left = removal(cl, profile(6, 0), (np.column_stack([x, 0 * x, 0 * x]), np.tile(UP, (60, 1))), depth=4.0)
    np.testing.assert_allclose(left.gouge, np.abs(x) * np.tan(lean), atol=left.uncertainty)
    assert left.uncertainty <= 2e-4


def test_ball_that_turns_about_its_centre_removes_what_a_still_axis_removes():
    rng = np.random.default_rng(5)
    turning = unit(UP + 0.3 * rng.normal(size=(400, 3)).cumsum(axis=0) / 20)
    centre = np.column_stack([np.linspace(-4, 4, 400), np.zeros(400), np.full(400, 3.0)])
    y = np.linspace(-1.5, 1.5, 31)
    rays = (np.column_stack([0.1 * y, y, 0 * y]), np.tile(UP, (31, 1)))
    fixed = np.tile(UP, (400, 1))
    one = removal((centre - 3 * turning, turning, np.zeros(400, dtype=int)), profile(3, 3), rays)
    two = removal((centre - 3 * fixed, fixed, np.zeros(400, dtype=int)), profile(3, 3), rays)
    # Between two points the centre leaves its line by the bow of the turning axis, 3 mm times the square of 0.03 / 2.
    np.testing.assert_allclose(one.remaining, two.remaining, atol=1e-3)


@pytest.mark.parametrize("seed", [2, 4])
def test_finer_pieces_of_turning_motions_change_nothing(monkeypatch, seed):
    cl, rays = random_case(seed, 1000)
    usual = removal(cl, profile(3, 1), rays)
    assert usual.uncertainty <= 2e-4
    monkeypatch.setattr(motions, "BOW", 1e-6)
    fine = removal(cl, profile(3, 1), rays)
    np.testing.assert_allclose(np.minimum(usual.remaining, 99), np.minimum(fine.remaining, 99), atol=1e-6)
    np.testing.assert_allclose(usual.gouge, fine.gouge, atol=1e-6)


def random_case(seed=3, count=300):
    rng = np.random.default_rng(seed)
    tips = np.column_stack([np.linspace(-8, 8, 30), rng.normal(size=30).cumsum() * 0.5, 0.05 * rng.normal(size=30)])
    axes = unit(UP + 0.05 * rng.normal(size=(30, 3)).cumsum(axis=0))
    axes[:8] = axes[0]
    kind = np.where(np.arange(30) % 7 == 3, 3, 0)
    normal = unit(UP + 0.2 * rng.normal(size=(count, 3)))
    foot = np.column_stack([rng.uniform(-9, 9, count), rng.uniform(-6, 6, count), rng.uniform(-0.3, 0.1, count)])
    return (tips, axes, kind), (foot, normal)


@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_rigid_motion_and_mirror_change_nothing(mirror):
    (tips, axes, kind), (foot, normal) = random_case()
    turn = rotation([1.0, 2.0, -0.5], 1.1) @ np.diag([1.0, 1.0, mirror])
    shift = np.array([120.0, -35.0, 8.0])
    here = removal((tips, axes, kind), profile(3, 1), (foot, normal))
    moved = removal((tips @ turn.T + shift, axes @ turn.T, kind), profile(3, 1),
                    (foot @ turn.T + shift, normal @ turn.T))
    both = np.isfinite(here.remaining)
    np.testing.assert_array_equal(both, np.isfinite(moved.remaining))
    np.testing.assert_allclose(moved.remaining[both], here.remaining[both], atol=1e-7)
    np.testing.assert_allclose(moved.gouge, here.gouge, atol=1e-7)


def test_the_way_back_removes_the_same():
    (tips, axes, _), rays = random_case()
    kind = np.zeros(30, dtype=int)
    there, back = (removal((tips[::d], axes[::d], kind), profile(3, 1), rays) for d in (1, -1))
    np.testing.assert_allclose(there.gouge, back.gouge, atol=1e-7)
    np.testing.assert_allclose(np.minimum(there.remaining, 99), np.minimum(back.remaining, 99), atol=1e-7)


def test_result_does_not_depend_on_threads():
    cl, rays = random_case(count=6000)
    one, four = (removal(cl, profile(3, 1), rays, threads=n) for n in (1, 4))
    for name in ("remaining", "gouge", "cut_by", "gouged_by"):
        np.testing.assert_array_equal(getattr(one, name), getattr(four, name))


@pytest.mark.skipif(not compiled.available, reason="numba is missing: the twin is all there is")
@pytest.mark.parametrize("cutter", [Profile(2, 1, 0, 20), Profile(3, 0, 0, 9), Profile(0, 3, 0, 4),
                                    Profile(1, 1, 0.3, 9)])
def test_twin_equals_kernel(monkeypatch, cutter):
    cl, rays = random_case(count=400)
    fast = removal(cl, cutter, rays)
    monkeypatch.setattr(compiled, "available", False)
    slow = removal(cl, cutter, rays)
    np.testing.assert_allclose(np.minimum(slow.remaining, 99), np.minimum(fast.remaining, 99), atol=1e-8)
    np.testing.assert_allclose(slow.gouge, fast.gouge, atol=1e-8)
    np.testing.assert_array_equal(slow.cut_by < 0, fast.cut_by < 0)


def test_one_point_is_a_cutter_that_stands_still(still):
    foot = np.array([[0.0, 0, 0], [1.0, 0, 0], [4.0, 0, 0]])
    left = removal(still([0.0, 0, -0.5], UP), profile(3, 3), (foot, np.tile(UP, (3, 1))))
    ground = 2.5 - np.sqrt(9 - np.array([0.0, 1.0]) ** 2)
    np.testing.assert_allclose(left.gouge[:2], -ground, atol=1e-8)
    np.testing.assert_array_equal(left.remaining, [0.0, 0.0, np.inf])


def test_cutter_wholly_below_a_face_gouges_and_does_not_cut(still):
    left = removal(still([0.0, 0, -0.9], UP), Profile(1.0, 0.0, 0.0, 0.5), ([[0.2, 0, 0]], [UP]))
    assert left.gouge[0] == pytest.approx(0.9, abs=1e-8)
    assert np.isinf(left.remaining[0])


@pytest.mark.parametrize(("spoil", "message"), [
    (lambda c: (np.empty((0, 3)), np.empty((0, 3)), []), "holds no point"),
    (lambda c: (np.where(np.arange(90).reshape(30, 3) == 4, np.nan, c[0]), c[1], c[2]), "tool tip row 1"),
    (lambda c: (c[0], c[1][:5], c[2]), "30 tool tips come with 5 axes"),
    (lambda c: (c[0], 0 * c[1], c[2]), "needs a direction"),
    (lambda c: (c[0], c[1] * (-1.0) ** (np.arange(30) > 4)[:, None], c[2]), "straight back between points 4 and 5"),
])
def test_bad_cutter_locations_are_named(spoil, message):
    cl, rays = random_case()
    with pytest.raises(InvalidInput, match=message):
        removal(spoil(cl), profile(3, 1), rays)


@pytest.mark.parametrize(("rays", "message"), [
    ((np.empty((0, 3)), np.empty((0, 3))), "no ray"), (([[0, 0, np.inf]], [UP]), "ray point row 0"),
    (([[0, 0, 0]], [UP, UP]), "1 ray points come with 2 normals")])
def test_bad_rays_are_named(rays, message):
    cl, _ = random_case()
    with pytest.raises(InvalidInput, match=message):
        removal(cl, profile(3, 1), rays)


def test_cutter_that_is_no_solid_is_named():
    cl, rays = random_case()
    for bad in (Profile(0, 0, 0, 5), Profile(1, np.nan, 0, 5), Profile(1, 2, 0, 1.0), Profile(1, 1, 0, -3)):
        with pytest.raises(InvalidInput, match="cutter"):
            removal(cl, bad, rays)


def test_stops_when_asked():
    cl, rays = random_case()
    with pytest.raises(Cancelled):
        removal(cl, profile(3, 1), rays, progress=Progress(cancelled=lambda: True))
