"""Distances of tool components from faces, against closed forms and planted touches."""

from itertools import pairwise

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.numeric import jit as compiled
from toolaxis.numeric.vectors import rotation, unit
from toolaxis.shape.face import Face
from toolaxis.tools.profile import Profile
from toolaxis.verify import component_clearance as room
from toolaxis.verify.component_clearance import FAR, clearance
from toolaxis.verify.revolved_solids import cutter_solid, frustum_solids

UP = np.array([0.0, 0.0, 1.0])
HOLDER = np.array([[10.0, 40.0], [10.0, 60.0], [25.0, 60.0], [25.0, 90.0]])


def plane(corner, one, two, trims=()):
    corner, one, two = (np.asarray(x, dtype=float) for x in (corner, one, two))
    net = np.array([[corner + s * one + t * two for t in (0, 1)] for s in (0, 1)])
    return Face.from_bspline(net, degree=(1, 1), trims=trims)


WALL = plane([20, -30, 0], [0, 60, 0], [0, 0, 80])
FLOOR = plane([-60, -60, 0], [120, 0, 0], [0, 120, 0])


def row(last, lean=0.0, count=30):
    x = np.linspace(last - 35, last, count)
    axis = np.tile([np.sin(lean), 0, np.cos(lean)], (count, 1))
    return np.column_stack([x, np.full(count, 3.3), 0 * x]), axis, np.zeros(count, dtype=int)


@pytest.mark.parametrize("gap", [0.005, -0.005, 0.6, 12.0])
def test_holder_beside_a_wall(gap):
    found = clearance(row(-5.0 - gap), ("holder", frustum_solids(HOLDER, "holder")), (FLOOR, WALL))
    assert found.distance == pytest.approx(gap, abs=1e-6 if gap < 1 else found.uncertainty)
    assert found.uncertainty <= max(5e-4, 1e-3 * gap)
    assert found.motion == 29
    assert found.point[0] == pytest.approx(20)
    assert 60 <= found.point[2] <= 80


@pytest.mark.parametrize("lean", [0.1, 0.3])
def test_edge_of_a_leaning_holder_touches_by_five_micrometres(lean):
    reach = max(r * np.cos(lean) + z * np.sin(lean) for r, z in HOLDER)
    tall = plane([20, -30, 0], [0, 60, 0], [0, 0, 150])
    found = clearance(row(20.005 - reach, lean), ("holder", frustum_solids(HOLDER, "holder")), (tall,))
    assert found.distance < 0
    free = clearance(row(19.995 - reach, lean), ("holder", frustum_solids(HOLDER, "holder")), (tall,))
    assert free.distance == pytest.approx(0.005, abs=2e-4)


def test_touch_between_two_points_of_a_link_is_found():
    tips = np.array([[-30.0, 0, 0], [30.0, 0, 0]])
    pin = plane([0, 9.995, 50], [0.3, 0, 0], [0, 4, 0])
    cl = (tips, np.tile(UP, (2, 1)), np.array([0, 3]))
    found = clearance(cl, ("holder", frustum_solids(HOLDER, "holder")), (pin,))
    assert found.distance == pytest.approx(-0.005, abs=1e-3)
    assert found.motion == 1


def test_cutter_over_a_face_with_a_hole_falls_through_it():
    ring = np.linspace(0, 2 * np.pi, 721)[:-1]
    rect = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    hole = np.column_stack([0.5 + 8 / 120 * np.cos(-ring), 0.5 + 8 / 120 * np.sin(-ring)])
    plate = plane([-60, -60, 0], [120, 0, 0], [0, 120, 0], (rect, hole))
    cl = (np.array([[0.0, 0, 5], [0, 0, -5]]), np.tile(UP, (2, 1)), np.zeros(2, dtype=int))
    found = clearance(cl, ("cutter", cutter_solid(Profile(4, 2, 0, 30))), (plate,))
    # Chords of the hole lie 8 (1 - cos(pi / 720)) inside it.
    assert found.distance == pytest.approx(2.0, abs=1e-4)
    assert found.distance < 2.0


def test_turning_axis_comes_nearest_between_its_points():
    lean = np.radians(15)
    axes = np.array([[np.sin(lean), 0, np.cos(lean)], [-np.sin(lean), 0, np.cos(lean)]])
    cl = (np.zeros((2, 3)), axes, np.zeros(2, dtype=int))
    roof = plane([-2, -2, 95], [4, 0, 0], [0, 4, 0])
    found = clearance(cl, ("holder", frustum_solids(np.array([[0.0, 40], [0.0001, 90]]), "holder")), (roof,))
    assert found.distance == pytest.approx(5.0, abs=found.uncertainty + 1e-6)


def test_rigid_motion_and_mirror_change_nothing():
    matrix = np.eye(4)
    matrix[:3, :3] = rotation([0.2, 1.0, 0.4], 0.8) @ np.diag([1.0, -1.0, 1.0])
    matrix[:3, 3] = [5.0, 70.0, -12.0]
    tips, axes, kind = row(-6.0, 0.05)
    solids = frustum_solids(HOLDER, "holder")
    here = clearance((tips, axes, kind), ("holder", solids), (WALL, FLOOR))
    moved = clearance((tips @ matrix[:3, :3].T + matrix[:3, 3], axes @ matrix[:3, :3].T, kind), ("holder", solids),
                      (WALL.transformed(matrix), FLOOR.transformed(matrix)))
    assert moved.distance == pytest.approx(here.distance, abs=2e-4)


def test_result_does_not_depend_on_threads():
    solids = frustum_solids(HOLDER, "holder")
    one, three = (clearance(row(-5.5, 0.02), ("holder", solids), (WALL, FLOOR), threads=n) for n in (1, 3))
    assert one == three


def brute_force(cl, outline, faces):
    """Nearest of many points to many still tools, by distance to a fine polygon of the meridian."""
    tips, axes, _ = cl
    cloud = np.vstack([face.evaluate(face.grid(60, 60)).point for face in faces])
    best = np.inf
    for i in range(len(tips) - 1):
        for s in np.linspace(0, 1, 60):
            axis = unit((1 - s) * axes[i] + s * axes[i + 1])
            w = cloud - (1 - s) * tips[i] - s * tips[i + 1]
            z = w @ axis
            rho = np.linalg.norm(w - z[:, None] * axis, axis=1)
            line = np.vstack([[0.0, outline[0, 1]], outline, [0.0, outline[-1, 1]]])
            for p, q in pairwise(line):
                way = q - p
                t = np.clip(((rho - p[0]) * way[0] + (z - p[1]) * way[1]) / (way @ way), 0, 1)
                best = min(best, float(np.hypot(rho - p[0] - t * way[0], z - p[1] - t * way[1]).min()))
    return best


@pytest.mark.parametrize("seed", range(4))
def test_random_free_tools_against_brute_force(seed):
    rng = np.random.default_rng(seed)
    net = np.stack([*np.meshgrid(np.linspace(-20, 20, 4), np.linspace(-20, 20, 4), indexing="ij"),
                    rng.uniform(-4, 4, (4, 4))], axis=-1)
    face = Face.from_bspline(net)
    tips = np.column_stack([rng.uniform(-5, 5, (4, 2)), np.full(4, 6.0)])
    axes = unit(UP + 0.5 * rng.normal(size=(4, 3)))
    outline = np.array([[6.0, 8.0], [6.0, 15.0], [14.0, 20.0], [14.0, 30.0]])
    cl = (tips, axes, np.zeros(4, dtype=int))
    found = clearance(cl, ("holder", frustum_solids(outline, "holder")), (face,))
    rough = brute_force(cl, outline, (face,))
    assert found.distance <= rough + found.uncertainty
    if found.distance > 0:
        assert found.distance == pytest.approx(rough, abs=0.25)
    else:
        assert rough < 0.25


@pytest.mark.skipif(not compiled.available, reason="numba is missing: the twin is all there is")
def test_twin_equals_kernel(monkeypatch):
    monkeypatch.setattr(room, "CELL", 4.0)
    small = plane([20, 0, 40], [0, 8, 0], [0, 0, 30])
    tips, axes, kind = row(-7.0, 0.05, count=4)
    axes[-1] = unit(axes[-1] + [0.02, 0.01, 0])
    solids = frustum_solids(HOLDER, "holder")
    fast = clearance((tips, axes, kind), ("holder", solids), (small,))
    monkeypatch.setattr(compiled, "available", False)
    slow = clearance((tips, axes, kind), ("holder", solids), (small,))
    assert slow.distance == pytest.approx(fast.distance, abs=1e-8)


def test_ample_room_is_measured_roughly_and_says_so():
    solids = frustum_solids(HOLDER, "holder")
    rough = clearance(row(-17.0), ("holder", solids), (WALL, FLOOR), enough=1.0)
    assert rough.distance == pytest.approx(12.0, abs=rough.uncertainty)
    assert 5e-4 < rough.uncertainty <= 0.6
    near = clearance(row(-6.0), ("holder", solids), (WALL, FLOOR), enough=1.0)
    assert near.distance == pytest.approx(1.0, abs=1e-3)


def test_nothing_near_is_far():
    away = plane([500, 0, 0], [1, 0, 0], [0, 1, 0])
    solids = frustum_solids(HOLDER, "holder")
    assert clearance(row(0.0), ("holder", solids), (away,)).distance == FAR
    assert clearance(row(0.0), ("holder", solids), ()).motion == -1


@pytest.mark.parametrize(("line", "message"), [
    ([[5, 0]], "at least two"), ([[5, 0], [-1, 3]], "no radius below zero"), ([[5, 3], [5, 1]], "must not decrease"),
    ([[5, 3], [8, 3]], "no height"), ([[5, 0], [np.nan, 1]], "finite")])
def test_bad_outlines_are_named(line, message):
    with pytest.raises(InvalidInput, match=message):
        frustum_solids(line, "holder")
