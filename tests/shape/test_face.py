"""Faces: what is on them, how large they are, and what they refuse."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import dblquad

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import rotation
from toolaxis.shape.analytic import (
    CylindricalSurface,
    HyperbolicParaboloid,
    PlanarSurface,
    SphericalSurface,
    ToroidalSurface,
)
from toolaxis.shape.face import Face
from toolaxis.shape.nurbs import NurbsSurface

RING = np.linspace(0, 2 * np.pi, 400, endpoint=False)


def circle(u: float, v: float, ru: float, rv: float) -> np.ndarray:
    return np.column_stack([u + ru * np.cos(RING), v + rv * np.sin(RING)])


def polygon_area(loop: np.ndarray) -> float:
    return 0.5 * abs(np.sum(loop[:, 0] * np.roll(loop[:, 1], -1) - np.roll(loop[:, 0], -1) * loop[:, 1]))


def disc() -> Face:
    return Face(PlanarSurface().nurbs(), (circle(50, 50, 30, 20), circle(45, 50, 10, 8)))


def freeform(trims: tuple[np.ndarray, ...] = ()) -> Face:
    rng = np.random.default_rng(5)
    x, y = np.meshgrid(np.linspace(0, 80, 8), np.linspace(0, 60, 7), indexing="ij")
    return Face.from_bspline(np.stack([x, y, 8 * np.sin(x / 17) * np.cos(y / 21) + rng.normal(size=x.shape)], -1),
                             trims=trims)


@pytest.mark.parametrize("surface, area", [
    (PlanarSurface((0.0, 30.0), (0.0, 20.0)), 600.0), (CylindricalSurface(12.0), 2400 * np.pi),
                                           (SphericalSurface(80.0), 25600 * np.pi),
    (SphericalSurface(10.0, (0.0, 1.0), (-0.5, 0.7)), 100 * (np.sin(0.7) + np.sin(0.5))),
                                           (ToroidalSurface(20.0, 6.0), 480 * np.pi**2)])
def test_areas_of_whole_surfaces(surface: Any, area: float) -> None:
    assert Face(surface.nurbs()).area == pytest.approx(area, rel=1e-6)


def test_area_of_a_saddle_by_adaptive_quadrature() -> None:
    wanted, _ = dblquad(lambda y, x: np.sqrt(1 + (x**2 + y**2) / 62500), -50, 50, -50, 50)
    assert Face(HyperbolicParaboloid().nurbs()).area == pytest.approx(wanted, rel=1e-9)
    corners = np.array([[[x, y, x * y / 250] for y in (-50.0, 50.0)] for x in (-50.0, 50.0)])
    assert Face(NurbsSurface.from_points(corners, (1, 1))).area == pytest.approx(wanted, rel=1e-9)


def test_areas_of_trimmed_planes() -> None:
    loops = disc().trims
    assert disc().area == pytest.approx(polygon_area(loops[0]) - polygon_area(loops[1]), rel=1e-5)
    triangle = np.array([[10.0, 10], [90, 20], [30, 80]])
    assert Face(PlanarSurface().nurbs(), (triangle,)).area == pytest.approx(polygon_area(triangle), rel=1e-12)
    thin = np.array([[0.0, 0.0], [100, 99.9], [100, 100]])
    assert Face(PlanarSurface().nurbs(), (thin,)).area == pytest.approx(polygon_area(thin), rel=1e-9)


def test_pieces_of_a_face_add_up() -> None:
    whole = freeform()
    blob = circle(0.45, 0.5, 0.3, 0.35)
    outside = Face(whole.surface, (np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), blob))
    assert whole.trimmed((blob,)).area + outside.area == pytest.approx(whole.area, rel=2e-6)


def test_box_of_a_sphere_a_torus_and_a_ring() -> None:
    assert Face(SphericalSurface(80.0).nurbs()).box == pytest.approx(np.array([[-80.0] * 3, [80.0] * 3]), abs=1e-9)
    assert Face(ToroidalSurface(20.0, 6.0).nurbs()).box == pytest.approx(np.array([[-26, -26, -6], [26, 26, 6.0]]),
                                                                         abs=1e-9)
    half = Face(CylindricalSurface(7.0, (0.3, 2.9), (0.0, 9.0)).nurbs())
    wanted = np.array([[7 * np.cos(2.9), 7 * np.sin(2.9), 0], [7 * np.cos(0.3), 7, 9]])
    assert half.box == pytest.approx(wanted, abs=1e-9)
    assert disc().box == pytest.approx(np.array([[20, 30, 0], [80, 70, 0]]), abs=1e-9)
    assert disc().diagonal == pytest.approx(np.hypot(60, 40))


def test_box_holds_a_dense_grid_and_no_more() -> None:
    face = freeform((circle(0.45, 0.5, 0.37, 0.41),))
    points = np.concatenate([face.evaluate(face.grid(900, 900)).point, face.evaluate(face.trims[0]).point])
    slack = np.stack([points.min(axis=0), points.max(axis=0)]) - face.box
    assert (slack * [[1.0], [-1.0]] >= -1e-6 * face.diagonal).all() and np.abs(slack).max() < 1e-4 * face.diagonal


def test_area_and_box_follow_motion_mirror_scale_and_swap() -> None:
    face = freeform((circle(0.45, 0.5, 0.3, 0.4),))
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = 3.0 * rotation([0, 1, 1], 2.0) @ np.diag([1, -1, 1]), [5, 6, 7]
    assert face.transformed(matrix).area == pytest.approx(9 * face.area, rel=1e-10)
    assert face.transformed(np.diag([2.0, 2, 2, 1])).box == pytest.approx(2 * face.box, abs=1e-7)
    swapped = Face(face.surface.swapped(), (face.trims[0][:, ::-1],))
    assert swapped.area == pytest.approx(face.area, rel=2e-6)


def test_what_is_on_a_face() -> None:
    face = disc()
    points = [[50, 35], [45, 50], [10, 10], [80, 50], [55, 50]]
    assert face.contains(points).tolist() == [True, False, False, True, True]
    assert face.contains([50.0, 35.0]).shape == (1,)
    assert face.contains(face.trims[0]).all() and face.contains(face.trims[1]).all()
    whole = Face(PlanarSurface().nurbs())
    assert whole.contains([[0, 0], [100, 100], [100.1, 50], [np.nan, 5]]).tolist() == [True, True, False, False]
    corners = np.array([[0.0, 0], [100, 0], [100, 100], [0, 100]])
    assert np.array_equal(whole.trimmed((corners,)).contains(corners), whole.contains(corners))


def test_grid_bounds_and_outline() -> None:
    face = disc()
    assert face.bounds == pytest.approx((20, 80, 30, 70)) and face.contains(face.grid(31, 17)).all()
    assert 31 * 17 * 0.5 < len(face.grid(31, 17)) < 31 * 17
    assert Face(PlanarSurface().nurbs()).grid(2, 1).tolist() == [[25, 50], [75, 50]]
    assert Face(PlanarSurface().nurbs()).outline[0].tolist() == [[0, 0], [100, 0], [100, 100], [0, 100]]


def test_labels_and_pieces() -> None:
    face = Face(PlanarSurface().nurbs(), number=7)
    piece = face.trimmed(([[0, 0], [1, 0], [0, 1]],), "7a")
    assert (face.label, piece.label, piece.number, face.trimmed(()).label) == ("7", "7a", 7, "7")


@pytest.mark.parametrize("loop, said", [
    ([[0, 0], [1, 0]], r"trim loop 0 of face 1 has shape \(2, 2\)"),
    ([[0, 0], [1, 0], [np.nan, 1]], "finite"),
    ([[0, 0, 0], [1, 0, 0], [1, 1, 0]], r"shape \(3, 3\)"),
    ([[0, 0], [1, 1], [2, 2]], "encloses no area"),
])
def test_loops_that_enclose_nothing(loop: Any, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        Face(PlanarSurface().nurbs(), (np.array(loop, dtype=float),))
