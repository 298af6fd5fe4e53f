"""One contract for every closed-form surface: itself by difference quotients, its B-spline, its curvatures."""

from typing import Any

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.shape.analytic import (
    ConicalSurface,
    CylindricalSurface,
    HyperbolicParaboloid,
    PlanarSurface,
    SphericalSurface,
    ToroidalSurface,
    arc_parameter,
)
from toolaxis.shape.differential import curvatures, normals
from toolaxis.shape.face import Face

SURFACES = [PlanarSurface(), PlanarSurface((-3.0, 7.0), (2.0, 4.0)), CylindricalSurface(12.0),
            CylindricalSurface(12.0, (0.3, 1.1), (-4.0, 9.0)),
            SphericalSurface(80.0), SphericalSurface(80.0, (1.0, 5.5), (-0.4, 1.2)), ConicalSurface(3.0, 0.3),
            ConicalSurface(3.0, -0.3, v_range=(0.0, 5.0)),
            ToroidalSurface(20.0, 6.0), ToroidalSurface(20.0, 6.0, (0.0, 1.0), (2.0, 6.0)), HyperbolicParaboloid(),
            HyperbolicParaboloid(300.0, (-10.0, 40.0), (5.0, 30.0))]


def parameters(surface: Any, count: int = 300, seed: int = 0) -> np.ndarray:
    (u0, u1), (v0, v1) = surface.domain
    rng = np.random.default_rng(seed)
    return np.column_stack([rng.uniform(u0, u1, count), v0 + (v1 - v0) * rng.uniform(0.001, 0.999, count)])


@pytest.fixture(params=SURFACES, ids=lambda s: f"{type(s).__name__}{s.domain}")
def surface(request: pytest.FixtureRequest) -> Any:
    return request.param


def test_derivatives_are_those_of_the_points(surface: Any) -> None:
    uv, h = parameters(surface), 1e-5
    d = surface.evaluate(uv)
    for k, (first, second) in enumerate((("su", ("suu", "suv")), ("sv", ("suv", "svv")))):
        step = h * np.eye(2)[k]
        ahead, behind = surface.evaluate(uv + step), surface.evaluate(uv - step)
        assert (ahead.point - behind.point) / (2 * h) == pytest.approx(getattr(d, first), abs=1e-6)
        for name, of in zip(second, ("su", "sv"), strict=True):
            slope = (getattr(ahead, of) - getattr(behind, of)) / (2 * h)
            assert slope == pytest.approx(getattr(d, name), abs=1e-6)


def test_its_b_spline_is_the_same_surface(surface: Any) -> None:
    uv, spline = parameters(surface), surface.nurbs()
    assert spline.domain == pytest.approx(np.array(surface.domain))
    mapped = surface.parameters(uv)
    assert spline.evaluate(mapped).point == pytest.approx(surface.evaluate(uv).point, abs=1e-12)
    assert normals(spline.evaluate(mapped)) == pytest.approx(normals(surface.evaluate(uv)), abs=1e-11)


def test_principal_curvatures(surface: Any) -> None:
    uv = parameters(surface)
    k1, k2 = surface.principal(uv)
    assert (k1 >= k2).all()
    for d in (surface.evaluate(uv), surface.nurbs().evaluate(surface.parameters(uv))):
        found = curvatures(d, normals(d))
        assert found.k1 == pytest.approx(k1, abs=1e-11)
        assert found.k2 == pytest.approx(k2, abs=1e-11)


def test_the_map_keeps_knots(surface: Any) -> None:
    spline = surface.nurbs()
    for knots, axis in ((spline.knots_u, 0), (spline.knots_v, 1)):
        uv = np.tile([[np.mean(r) for r in surface.domain]], (len(knots), 1))
        uv[:, axis] = knots
        assert surface.parameters(uv)[:, axis] == pytest.approx(knots, abs=1e-14)


def test_arcs_stay_within_a_right_angle() -> None:
    assert len(CylindricalSurface(1.0).nurbs().knots_u) == 9 + 3
    assert len(CylindricalSurface(1.0, (0.0, np.pi / 2)).nurbs().knots_u) == 3 + 3
    assert len(CylindricalSurface(1.0, (0.0, np.pi / 2 + 0.01)).nurbs().knots_u) == 5 + 3
    angle = np.linspace(0.2, 1.3, 50)
    assert (np.diff(arc_parameter(angle, (0.2, 1.3))) > 0).all()


@pytest.mark.parametrize("surface", [SphericalSurface(10.0), SphericalSurface(10.0, (0.4, 1.3))],
                         ids=["whole", "wedge"])
def test_poles_of_a_sphere(surface: SphericalSurface) -> None:
    middle = np.mean(surface.u_range)
    for v, up in ((np.pi / 2, 1.0), (-np.pi / 2, -1.0)):
        for mirror, swap in ((False, False), (True, False), (False, True), (True, True)):
            matrix = np.diag([1.0, 1.0, -1.0, 1.0]) if mirror else np.eye(4)
            spline = surface.nurbs().swapped() if swap else surface.nurbs()
            face = Face(spline, flip=swap).transformed(matrix)
            uv = np.array([[u, v] for u in (*surface.u_range, middle)])
            uv = uv[:, ::-1] if swap else uv
            n, k = face.normal(uv), face.curvature(uv)
            assert n == pytest.approx(np.tile([0, 0, -up if mirror else up], (3, 1)), abs=1e-12)
            assert np.concatenate([k.k1, k.k2]) == pytest.approx(np.full(6, -0.1), abs=1e-6)


@pytest.mark.parametrize("distance", [1e-14, 1e-12, 1e-10, 3e-9, 1e-8, 3e-8, 1e-6, 1e-3])
def test_normals_run_smoothly_into_the_pole(distance: float) -> None:
    sphere = SphericalSurface(10.0)
    face = Face(sphere.nurbs())
    uv = np.array([[0.7, np.pi / 2 - distance], [0.7, -np.pi / 2 + distance]])
    mapped = sphere.parameters(uv)
    wanted = face.evaluate(mapped).point / 10.0
    assert face.normal(mapped) == pytest.approx(wanted, abs=3e-8)


def test_the_apex_of_a_cone_has_the_normal_of_its_generator() -> None:
    cone = ConicalSurface(3.0, 0.3, v_range=(-3.0 / np.sin(0.3), 5.0))
    u = np.linspace(0.1, 6.0, 7)
    apex = np.column_stack([u, np.full(7, cone.v_range[0])])
    beside = np.column_stack([u, np.full(7, 0.0)])
    face = Face(cone.nurbs())
    assert face.normal(cone.parameters(apex)) == pytest.approx(face.normal(cone.parameters(beside)), abs=1e-9)
    assert (face.curvature(cone.parameters(apex)).k2 < -100.0).all()


def test_a_degenerate_triangle_of_points_and_a_folded_corner() -> None:
    points = np.zeros((3, 3, 3))
    points[..., 0], points[..., 1] = np.meshgrid([0.0, 1, 2], [0.0, 1, 2], indexing="ij")
    points[0] = points[0, 0]
    for flip, sign in ((False, 1.0), (True, -1.0)):
        face = Face.from_bspline(points, (2, 2), flip=flip)
        assert face.normal([[0.0, 0.3]]) == pytest.approx(np.array([[0.0, 0.0, sign]]))
    folded = points.copy()
    folded[0] = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]
    folded[1, 0], folded[2, 0] = [-1, 0, 0], [-2, 1, 0]
    face = Face.from_bspline(folded, (2, 2))
    beside = face.normal([[1e-3, 1e-3]])
    assert face.normal([[0.0, 0.0]]) == pytest.approx(beside, abs=1e-9) and abs(beside[0, 2]) == pytest.approx(1.0)


def test_a_surface_without_any_direction_answers_zeros() -> None:
    assert Face.from_bspline(np.zeros((4, 4, 3))).normal([[0.5, 0.5]]).tolist() == [[0.0, 0.0, 0.0]]


@pytest.mark.parametrize("make, said", [
    (lambda: CylindricalSurface(-1.0), "radius is -1.0"),
    (lambda: SphericalSurface(float("nan")), "radius is nan"),
    (lambda: SphericalSurface(1.0, v_range=(0.0, 2.0)), "latitudes lie between"),
    (lambda: CylindricalSurface(1.0, (0.0, 7.0)), "range of u is .* by no more than 6.28"),
    (lambda: PlanarSurface((1.0, 1.0)), "range of u"),
    (lambda: ConicalSurface(3.0, 0.0), "half angle is 0.0"),
    (lambda: ConicalSurface(3.0, 0.3, v_range=(-20.0, 0.0)), "must end at the apex"),
    (lambda: ToroidalSurface(3.0, 3.0), "the tube would meet itself"),
    (lambda: HyperbolicParaboloid(0.0), "divisor is 0.0"),
])
def test_sizes_that_make_no_surface(make: Any, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        make()
