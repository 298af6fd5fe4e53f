"""Normals of faces: caps around them, and proven ranges of their angles to an axis."""

from math import pi, radians

import numpy as np
import pytest

from toolaxis.feasibility import normal_cells
from toolaxis.feasibility.normal_cells import NormalCells
from toolaxis.feasibility.normal_cone import NormalField
from toolaxis.numeric.smallest_cap import smallest_cap
from toolaxis.numeric.vectors import angle_between, rotation, unit
from toolaxis.shape.analytic import SphericalSurface
from toolaxis.shape.face import Face


def bumpy(seed, trims=(), size=20.0, height=3.0):
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(-size, size, 6), np.linspace(-size, size, 5), indexing="ij")
    return Face.from_bspline(np.stack([x, y, height * rng.normal(size=x.shape)], axis=-1), trims=trims)


def test_cap_of_vectors_on_a_circle_is_the_circle():
    turn = np.linspace(0, 2 * pi, 7)[:-1]
    around = np.stack([np.sin(0.4) * np.cos(turn), np.sin(0.4) * np.sin(turn), np.cos(0.4) + 0 * turn], axis=1)
    cap = smallest_cap(np.vstack([[[0, 0, 1.0]], around]))
    np.testing.assert_allclose(cap.centre, [0, 0, 1], atol=1e-9)
    assert abs(cap.radius - 0.4) < 1e-9


@pytest.mark.parametrize("seed", range(6))
def test_cap_holds_all_and_no_smaller_one_does(seed):
    rng = np.random.default_rng(seed)
    vectors = unit(rng.normal(size=(300, 3)) * 0.3 + [0, 0, 1])
    cap = smallest_cap(vectors)
    assert angle_between(vectors, cap.centre).max() <= cap.radius + 1e-8
    for centre in unit(cap.centre + 0.02 * rng.normal(size=(50, 3))):
        assert angle_between(vectors, centre).max() >= cap.radius - 1e-9


def test_vectors_all_around_have_no_cap():
    cap = smallest_cap(np.vstack([np.eye(3), -np.eye(3)]))
    assert cap.radius == pi / 2 and not cap.centre.any()


def test_one_vector_is_its_own_cap():
    cap = smallest_cap(np.array([[0, 0.6, 0.8]] * 3))
    assert cap.radius < 1e-6
    np.testing.assert_allclose(cap.centre, [0, 0.6, 0.8], atol=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_proven_range_holds_every_normal_and_is_met(seed):
    rng = np.random.default_rng(100 + seed)
    trims = () if seed % 2 else (np.array([[0.1, 0.15], [0.8, 0.1], [0.9, 0.7], [0.3, 0.9]]),
                                 np.array([[0.4, 0.4], [0.4, 0.55], [0.6, 0.5]]))
    face = bumpy(seed, trims)
    field = NormalField(face)
    sides = [(loop, np.roll(loop, -1, axis=0)) for loop in face.outline]
    dense = face.normal(np.vstack([face.grid(400, 400), *(np.linspace(*side, 60).reshape(-1, 2) for side in sides)]))
    for _ in range(4):
        axis = unit(field.mean + 0.7 * rng.normal(size=3))
        angle = angle_between(dense, axis)
        least, greatest = angle.min() - 0.01, angle.max() + 0.01
        found = field.range_of_angles(axis, least, greatest)
        assert found.low <= angle.min() + 1e-9 and found.high >= angle.max() - 1e-9
        assert found.low >= least and found.high <= greatest


def test_a_normal_between_coarse_samples_is_not_missed():
    face = bumpy(3)
    field = NormalField(face)
    hit = face.normal(np.array([[0.41237, 0.66177]]))[0]
    least, _ = field.angles(hit[None])
    assert least[0] > 1e-4
    assert field.range_of_angles(hit, radians(0.5), pi / 2).low < radians(0.01)


def test_ranges_turn_with_the_face():
    face = bumpy(5)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation([1, 2, 3], 0.8), [5, -6, 7]
    axis = unit([0.2, 0.3, 0.9])
    one = NormalField(face).range_of_angles(axis, 0.01, 1.4)
    other = NormalField(face.transformed(matrix)).range_of_angles(matrix[:3, :3] @ axis, 0.01, 1.4)
    np.testing.assert_allclose([one.low, one.high], [other.low, other.high], atol=1e-9)


def test_a_plane_has_one_normal():
    x, y = np.meshgrid([0.0, 10], [0.0, 10], indexing="ij")
    field = NormalField(Face.from_bspline(np.stack([x, y, 0 * x], axis=-1), degree=(1, 1), flip=True))
    np.testing.assert_allclose(field.mean, [0, 0, -1], atol=1e-12)
    found = field.range_of_angles([0, 0, -1.0], 0.01, 1.0)
    assert found.low == 0.0 and found.high < 1e-7


def test_a_pole_does_not_multiply_cells(monkeypatch):
    """Normals have no bound there: the middles of specks stand for them, and the range is soon told."""
    face = Face(SphericalSurface(7.0, v_range=(0.3, pi / 2)).nurbs())
    field, counts = NormalField(face), []
    looked = NormalCells._looked
    monkeypatch.setattr(NormalCells, "_looked", lambda self, rect, *rest: counts.append(len(rect)) or
                        looked(self, rect, *rest))
    found = field.range_of_angles([0, 0, 1.0], 0.0, pi / 2 - 0.29)
    assert sum(counts) < 1_000_000
    assert found.low <= 1e-3 and pi / 2 - 0.3 <= found.high <= pi / 2 - 0.29


def test_what_was_divided_for_one_axis_is_there_for_the_next(monkeypatch):
    """A search asks for hundreds of axes: each made all cells anew."""
    counts = []
    looked = NormalCells._looked
    monkeypatch.setattr(NormalCells, "_looked", lambda self, rect, *rest: counts.append(len(rect)) or
                        looked(self, rect, *rest))
    trims = np.array([[0.1, 0.15], [0.8, 0.1], [0.9, 0.7], [0.3, 0.9]]),
    field = NormalField(bumpy(7, trims))
    axes = unit(field.mean + 0.2 * np.random.default_rng(2).normal(size=(40, 3)))
    one = field.range_of_angles(axes[0], 0.01, 1.0)
    every = [field.range_of_angles(axis, 0.01, 1.0) for axis in axes]
    assert counts.count(24 * 24) == 1
    made = sum(counts)
    again = [field.range_of_angles(axis, 0.01, 1.0) for axis in axes]
    assert sum(counts) == made
    monkeypatch.setattr(normal_cells, "_KEPT", 0)
    for axis, kept in zip(axes[:5], every, strict=False):
        alone = NormalField(bumpy(7, trims)).range_of_angles(axis, 0.01, 1.0)
        assert all(np.array_equal(a, b) for a, b in zip(alone, kept, strict=True))
    for same in (one, again[0]):
        assert all(np.array_equal(a, b) for a, b in zip(same, every[0], strict=True))


def test_a_limit_that_no_angle_can_be_beyond_needs_no_smaller_cells(monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: a ball end allows 0 between axis and normal, and whether less is met cost half of a plan's time."""
    face = bumpy(3, height=0.5)
    field, counts, looked = NormalField(face), list[int](), NormalCells._looked
    monkeypatch.setattr(NormalCells, "_looked", lambda self, rect, *rest: counts.append(len(rect)) or
                        looked(self, rect, *rest))
    axis = face.normal(np.array([[0.47, 0.53]]))[0]
    found = field.range_of_angles(axis, 0.0, pi / 2)
    assert counts == [24 * 24], "the first grid of cells alone"
    assert found.low == 0.0 and found.high >= angle_between(face.normal(face.grid(99, 99)), axis).max()
    assert field.range_of_angles(-axis, pi / 2, pi).high == pi and len(counts) == 1
    assert field.range_of_angles(axis, 1e-6, pi / 2).low < 1e-3 and len(counts) > 1


def test_a_fold_of_vanishing_size_adds_no_normals() -> None:
    """A plane face that runs back on itself by 0.0003 mm: the derivatives alone turn by half a turn there."""
    line = np.concatenate([np.linspace(0.0, 30.0, 7), 30.0 - 5e-5 * np.arange(1, 6), np.linspace(35.0, 60.0, 6)])
    low = np.column_stack([line, 0.0 * line, 0.0 * line])
    field = NormalField(Face.from_bspline(np.stack([low, low + np.array([0.0, 0.1, 0.0])], axis=1), (3, 1)))
    found = field.range_of_angles([0.6, 0.0, 0.8], 0.4, 0.9)
    assert 0.4 <= found.low <= np.arccos(0.8) <= found.high <= 0.9
    assert field.cap.radius < 1e-6
