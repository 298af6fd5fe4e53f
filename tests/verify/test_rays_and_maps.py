"""Rays stand for the area of their face; maps find the worst, the share within a limit, and zones."""

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.profile import Profile
from toolaxis.verify.maps import surface_map
from toolaxis.verify.material_removal import RestMaterial
from toolaxis.verify.rays import border_points, default_spacing, face_rays, gouge_spacing
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.verdict import judge


def bump(trims=(), flip=False, height=12.0):
    side = np.linspace(-20, 20, 5)
    z = np.zeros((5, 5))
    z[1:4, 1:4] = height
    return Face.from_bspline(np.stack([*np.meshgrid(side, side, indexing="ij"), z], axis=-1), trims=trims, flip=flip)


def quarter_turn():
    """A quarter of a cylinder of radius 10 and length 30 with parameters crowded to one end."""
    w = np.sqrt(0.5)
    arc, weight = np.array([[10.0, 0], [10, 10], [0, 10]]), np.array([1.0, w, 1])
    net = np.array([[[x, y, z] for z in (0.0, 2.0, 30.0)] for x, y in arc])
    return Face.from_bspline(net, (2, 2), weights=np.repeat(weight[:, None], 3, axis=1))


def made_of(height):
    """A judge that leaves a given height, and takes a tenth of it from below."""
    def judge(point, normal):
        value = height(point)
        index = np.zeros(len(point), dtype=np.int64)
        return RestMaterial(value, np.where(np.isfinite(value), 0.1 * value, 0.0), index, index, 0.0)
    return judge


def test_weights_add_up_to_a_known_area():
    assert face_rays(quarter_turn(), 0.5).weight.sum() == pytest.approx(10 * np.pi / 2 * 30, rel=2e-4)


@pytest.mark.parametrize("spacing", [0.5, 1.3])
def test_rays_are_even_by_area_whatever_the_parameters(spacing):
    rays = face_rays(quarter_turn(), spacing)
    inner = ~rays.border
    weight = rays.weight[inner]
    assert weight.max() <= 1.02 * spacing**2
    assert weight.min() >= 0.5 * spacing**2
    middle = rays.point[inner][:, 2] < 15
    assert weight[middle].sum() == pytest.approx(weight[~middle].sum(), rel=0.02)


def test_trimmed_face_has_rays_inside_and_on_its_loops_only():
    ring = np.linspace(0, 2 * np.pi, 200)[:-1]
    hole = np.column_stack([0.5 + 0.2 * np.cos(ring), 0.5 - 0.2 * np.sin(ring)])
    face = bump((np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), hole))
    rays = face_rays(face, 0.4)
    assert rays.weight.sum() == pytest.approx(face.area, rel=2e-3)
    assert face.contains(rays.uv[~rays.border]).all()
    on_loop = np.abs(np.hypot(*(rays.uv[rays.border] - 0.5).T) - 0.2) < 1e-4
    assert on_loop.sum() >= 199
    assert (rays.weight[rays.border] == 0).all()
    assert (np.linalg.norm(np.diff(face.evaluate(border_points(face, 0.4)).point, axis=0), axis=1) < 0.41).mean() > 0.99


def test_normals_follow_flip_and_rays_repeat():
    one, two = face_rays(bump(), 1.0), face_rays(bump(flip=True), 1.0)
    np.testing.assert_array_equal(one.uv, two.uv)
    np.testing.assert_array_equal(one.normal, -two.normal)


def test_spacing_is_half_a_millimetre_or_finer_on_small_faces():
    assert default_spacing(bump(height=0.0)) == pytest.approx(40 / 150, rel=1e-4)
    assert default_spacing(Face.from_bspline(40 * bump(height=0.0).surface.control[..., :3])) > 1.0
    for bad in (0.0, -1.0, np.nan):
        with pytest.raises(InvalidInput, match="ray spacing"):
            face_rays(bump(), bad)


@pytest.mark.parametrize(("flat", "corner", "gouge"), [(0.0, 0.1, 0.01), (0.0, 1.0, 0.002), (1.5, 0.5, 0.01)])
def test_a_gouge_on_a_small_face_has_many_rays(flat, corner, gouge):
    """Torus that dips below a plane: what it takes off is an ellipse, wherever it lies and however it is turned."""
    side = np.linspace(0.0, 1.6, 4)
    face = Face.from_bspline(np.stack([*np.meshgrid(side, side, indexing="ij"), np.zeros((4, 4))], axis=-1))
    spacing = gouge_spacing(face, flat, corner, gouge)
    assert default_spacing(face) < spacing < 0.5
    feet, rng = face_rays(face, spacing).point[:, :2], np.random.default_rng(4)
    half = np.sqrt(2 * gouge * np.array([flat + corner, corner]))
    for middle, turn in zip(rng.uniform(half[0], 1.6 - half[0], (200, 2)), rng.uniform(0, np.pi, 200), strict=True):
        way = feet - middle
        along = np.column_stack([way @ [np.cos(turn), np.sin(turn)], way @ [-np.sin(turn), np.cos(turn)]])
        assert (((along / half) ** 2).sum(axis=1) < 1.0).sum() >= 25


def test_rays_for_gouges_are_no_farther_apart_on_large_faces():
    face = Face.from_bspline(40 * bump(height=0.0).surface.control[..., :3])
    assert gouge_spacing(face, 0.0, 0.1, 0.01) == default_spacing(face)


@pytest.mark.parametrize("depth", [0.0098, 0.0103])
def test_a_gouge_on_a_small_face_beside_the_machined_one_is_found(depth):
    """A ball of 0.2 mm dips into a face of 1.6 x 1.6 mm at one place after the other."""
    side = np.linspace(0.0, 1.6, 4)
    x, y = np.meshgrid(side, side, indexing="ij")
    machined, beside = (Face.from_bspline(np.stack([x + shift, y, 0 * x], axis=-1)).trimmed((), label)
                        for shift, label in ((-1.6, "machined"), (0.0, "beside")))
    for place in np.random.default_rng(8).uniform(0.2, 1.4, (8, 2)):
        tips = np.array([[*place, -depth], [*place, -depth + 1e-4]])
        task = VerificationTask("one", tips, np.tile([0.0, 0.0, 1.0], (2, 1)), np.full(2, Motion.CUT, dtype=np.int8),
                                Profile(0.0, 0.1, 0.0, 20.0), (machined,), 0.02, left=(machined,), skin=(beside,),
                                tolerance=Tolerance(gouge=0.01))
        found = judge(task)
        assert found.gouge_max == pytest.approx(depth, abs=2e-5)
        assert found.passed == (depth < 0.01), found.reasons


def test_share_of_area_and_histogram_of_a_known_height():
    slope = surface_map(bump(height=0.0), made_of(lambda p: 0.001 * (p[:, 0] + 20)), 0.5)
    assert slope.area == pytest.approx(1600, rel=1e-4)
    assert slope.share_within(0.03) == pytest.approx(0.75, abs=1e-3)
    edges = np.array([0.0, 0.01, 0.02, 0.03])
    np.testing.assert_allclose(slope.histogram(edges), 400, rtol=4e-3)


def test_worst_place_is_found_between_the_rays():
    peak = np.array([3.21, -7.77])
    found = surface_map(bump(height=0.0), made_of(lambda p: 0.02 - 0.001 * np.hypot(*(p[:, :2] - peak).T)), 0.5)
    assert found.worst_scallop.value == pytest.approx(0.02, abs=1e-5)
    np.testing.assert_allclose(found.worst_scallop.point[:2], peak, atol=0.01)
    assert found.worst_gouge.value == pytest.approx(0.002, abs=1e-6)
    places = found.worst("remaining", 4)
    assert [p.value for p in places] == sorted((p.value for p in places), reverse=True)
    assert places[0] == found.worst_scallop
    assert min(np.linalg.norm(np.subtract(p.point, q.point)) for p in places for q in places if p != q) >= 4.0


def test_zones_are_counted_and_measured():
    def height(p):
        corner = (p[:, 0] > 12) & (p[:, 1] > 10)
        strip = (np.abs(p[:, 0] + 10) < 1) & (np.abs(p[:, 1]) < 15)
        return np.where(corner, np.inf, np.where(strip, 0.05, 0.01))

    zones = surface_map(bump(height=0.0), made_of(height), 0.25).zones(0.02)
    assert len(zones) == 2
    assert zones[0].area == pytest.approx(80, rel=0.02)
    assert (zones[0].reason, zones[0].at_border) == ("not reached", True)
    assert zones[1].area == pytest.approx(60, rel=0.02)
    assert (zones[1].reason, zones[1].largest, zones[1].at_border) == ("above the limit", 0.05, False)
    np.testing.assert_allclose(zones[1].low[:2], [-11, -15], atol=0.25)
    assert surface_map(bump(), made_of(lambda p: 0 * p[:, 0]), 1.0).zones(0.02) == ()
