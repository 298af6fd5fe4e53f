"""Nearest points: closed forms, brute force, and the changes they must follow."""

from weakref import WeakKeyDictionary

import numpy as np
import pytest
from scipy.spatial import cKDTree

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import rotation
from toolaxis.shape import nearest as searches
from toolaxis.shape.analytic import PlanarSurface, SphericalSurface, ToroidalSurface
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest, nearest_sample

RING = np.linspace(0, 2 * np.pi, 90, endpoint=False)
RIM = np.column_stack([0.5 + 0.4 * np.cos(RING), 0.5 + 0.4 * np.sin(RING)])
HOLE = np.column_stack([0.45 + 0.1 * np.cos(RING), 0.5 + 0.1 * np.sin(RING)])


def freeform(trims: tuple[np.ndarray, ...] = (RIM, HOLE)) -> Face:
    rng = np.random.default_rng(5)
    x, y = np.meshgrid(np.linspace(0, 80, 8), np.linspace(0, 60, 7), indexing="ij")
    points = np.stack([x, y, 8 * np.sin(x / 17) * np.cos(y / 21) + rng.normal(size=x.shape)], -1)
    return Face.from_bspline(points, weights=rng.uniform(0.8, 1.3, x.shape), trims=trims)


def around(face: Face, count: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(face.box[0] - 15, face.box[1] + 15, (count, 3))


def test_sphere_and_torus() -> None:
    sphere, torus = Face(SphericalSurface(20.0).nurbs()), Face(ToroidalSurface(20.0, 6.0).nurbs())
    points = around(torus, 300)
    assert nearest(sphere, points).distance == pytest.approx(np.abs(np.linalg.norm(points, axis=1) - 20), abs=1e-9)
    tube = np.hypot(np.hypot(*points[:, :2].T) - 20, points[:, 2])
    assert nearest(torus, points).distance == pytest.approx(np.abs(tube - 6), abs=1e-9)


def test_plane_with_a_border() -> None:
    face = Face(PlanarSurface((0.0, 10.0), (0.0, 6.0)).nurbs())
    found = nearest(face, [[5, 3, 2], [13, 10, 0], [-3, 2, 4], [5, 3, 0]])
    assert found.point == pytest.approx(np.array([[5, 3, 0], [10, 6, 0], [0, 2, 0], [5, 3, 0.0]]), abs=1e-6)
    assert found.distance == pytest.approx([2, 5, 5, 0], abs=1e-9)


def test_against_brute_force_on_a_trimmed_face() -> None:
    face = freeform()
    points = around(face, 300)
    dense = np.concatenate([face.evaluate(uv).point for uv in
                            (face.grid(700, 700), *(np.linspace(a, np.roll(a, -1, axis=0), 60).reshape(-1, 2)
                                                    for a in face.trims))])
    brute = cKDTree(dense).query(points)[0]
    found = nearest(face, points)
    assert (found.distance <= brute + 1e-9).all()
    assert (found.distance >= brute - 0.12).all()
    assert face.contains(found.uv + 1e-9 * ([0.5, 0.5] - found.uv)).mean() > 0.7
    assert found.point == pytest.approx(face.evaluate(found.uv).point, abs=1e-12)


@pytest.mark.parametrize("trims", [(), (RIM, HOLE)], ids=["whole", "trimmed"])
def test_a_sample_is_a_place_and_the_nearest_lies_in_its_cell(trims: tuple[np.ndarray, ...]) -> None:
    face = freeform(trims)
    points = around(face, 400)
    found, exact = nearest_sample(face, points), nearest(face, points)
    assert nearest(face, found.point).distance.max() < 1e-6
    assert found.distance == pytest.approx(np.linalg.norm(found.point - points, axis=1), abs=1e-12)
    assert (found.distance >= exact.distance - 1e-9).all()
    assert (found.distance <= exact.distance + found.apart).all()
    size = np.linalg.norm(np.ptp(face.box, axis=0))
    assert found.apart.max() < 0.05 * size


def test_kernels_find_what_their_twins_find(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever is passed over, on faces with holes, seams and poles, far from them, on them and at their borders."""
    whole = [Face(surface.nurbs()) for surface in (SphericalSurface(20.0), ToroidalSurface(20.0, 6.0))]
    for face in (freeform(), freeform(()), *whole):
        rim = face.evaluate(np.concatenate(face.outline)).point
        points = np.concatenate([around(face, 400, 7), face.evaluate(face.grid(9, 9)).point, rim, rim + 1e-3])
        found = nearest(face, points)
        monkeypatch.setattr(searches, "_KNOWN", WeakKeyDictionary())
        monkeypatch.setattr(searches._compiled, "available", False)
        twin = nearest(face, points)
        monkeypatch.undo()
        assert found.distance == pytest.approx(twin.distance, abs=2e-11)  # steps below 1e-13 of the range are not taken


def test_bounds_of_the_ways_along_a_loop_hold() -> None:
    for face in (freeform(), Face(SphericalSurface(20.0, (0.0, 1.5), (-1.0, 1.0)).nurbs())):
        slopes = searches._greatest_slopes(face)
        d = face.evaluate(face.grid(80, 80))
        greatest = [np.linalg.norm(slope, axis=1).max() for slope in (d.su, d.sv)]
        assert (slopes >= greatest).all()
        assert (slopes <= np.multiply(6.0, greatest)).all()


def test_the_way_is_normal_inside_the_face() -> None:
    face = freeform(())
    uv = np.random.default_rng(3).uniform(0.1, 0.9, (200, 2))
    start = face.evaluate(uv).point + np.linspace(-1.5, 1.5, 200)[:, None] * face.normal(uv)
    found = nearest(face, start)
    assert found.distance == pytest.approx(np.abs(np.linspace(-1.5, 1.5, 200)), abs=1e-9)
    assert found.uv == pytest.approx(uv, abs=1e-6)


def test_follows_motion_and_mirror() -> None:
    face = freeform()
    points = around(face, 60)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation([3, 1, 2], 1.1) @ np.diag([1, 1, -1]), [9, 8, 7]
    moved = nearest(face.transformed(matrix), points @ matrix[:3, :3].T + matrix[:3, 3])
    assert moved.distance == pytest.approx(nearest(face, points).distance, abs=1e-8)


def test_bad_points() -> None:
    with pytest.raises(InvalidInput, match=r"point row 0 is .*nan.*: every number must be finite"):
        nearest(freeform(), [[0, 0, np.nan]])
