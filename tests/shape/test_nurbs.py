"""Rational B-spline surfaces: exact cases, changes that must be followed, and refusals."""

from typing import Any

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.shape.nurbs import NurbsSurface, uniform_knots


def bilinear() -> NurbsSurface:
    return NurbsSurface.from_points([[[0, 0, 0], [0, 2, 0]], [[4, 0, 0], [4, 2, 8]]], (1, 1))


def cubic(weights: Any = None) -> NurbsSurface:
    rng = np.random.default_rng(3)
    return NurbsSurface.from_points(rng.normal(0, 10, (6, 5, 3)), weights=weights)


UV = np.random.default_rng(4).uniform(0, 1, (60, 2))


def test_bilinear_by_hand() -> None:
    d = bilinear().evaluate(np.array([[0.25, 0.5]]))
    assert d.point.tolist() == [[1.0, 1.0, 1.0]] and d.su.tolist() == [[4.0, 0.0, 4.0]]
    assert d.sv.tolist() == [[0.0, 2.0, 2.0]] and d.suv.tolist() == [[0.0, 0.0, 8.0]]
    assert not d.suu.any() and not d.svv.any()


def test_uniform_knots() -> None:
    assert uniform_knots(5, 3).tolist() == [0, 0, 0, 0, 0.5, 1, 1, 1, 1]
    assert bilinear().domain == ((0.0, 1.0), (0.0, 1.0))


def test_a_common_weight_changes_nothing() -> None:
    plain, heavy = cubic().evaluate(UV), cubic(np.full((6, 5), 7.0)).evaluate(UV)
    for a, b in zip(plain, heavy, strict=True):
        assert a == pytest.approx(b, abs=1e-9)
    assert cubic().data[5] is False and cubic(np.full((6, 5), 7.0)).data[5] is True


def test_affine_maps_and_swaps_are_followed() -> None:
    surface = cubic(np.random.default_rng(0).uniform(0.5, 2, (6, 5)))
    matrix = np.eye(4)
    matrix[:3] = np.random.default_rng(1).normal(size=(3, 4))
    moved, swapped, d = surface.transformed(matrix), surface.swapped(), surface.evaluate(UV)
    assert moved.evaluate(UV).point == pytest.approx(d.point @ matrix[:3, :3].T + matrix[:3, 3], abs=1e-11)
    assert moved.evaluate(UV).suv == pytest.approx(d.suv @ matrix[:3, :3].T, abs=1e-9)
    other = swapped.evaluate(UV[:, ::-1])
    assert other.point == pytest.approx(d.point, abs=1e-12) and other.suu == pytest.approx(d.svv, abs=1e-9)


def test_swapping_exchanges_degrees() -> None:
    surface = NurbsSurface.from_points(np.random.default_rng(3).normal(0, 10, (6, 5, 3)), (4, 1))
    d, other = surface.evaluate(UV), surface.swapped().evaluate(UV[:, ::-1])
    assert surface.swapped().degree == (1, 4)
    assert other.point == pytest.approx(d.point, abs=1e-12) and other.svv == pytest.approx(d.suu, abs=1e-9)


def test_scalar_rows_and_empty_parameters() -> None:
    assert cubic().evaluate(np.array([0.5, 0.5])).point.shape == (1, 3)
    assert cubic().evaluate(np.empty((0, 2))).svv.shape == (0, 3)


NET = np.zeros((4, 4, 3))


@pytest.mark.parametrize("make, said", [
    (lambda: NurbsSurface.from_points(np.zeros((4, 4))), r"control points have shape \(4, 4\)"),
    (lambda: NurbsSurface.from_points(np.zeros((3, 4, 3))), "3 control points in u for degree 3: at least 4"),
    (lambda: NurbsSurface.from_points(np.zeros((4, 2, 3))), "2 control points in v for degree 3"),
    (lambda: NurbsSurface.from_points(np.full((4, 4, 3), np.nan)), "control point .* finite"),
    (lambda: NurbsSurface.from_points(NET, weights=np.ones((4, 3))), r"weights have shape \(4, 3\)"),
    (lambda: NurbsSurface.from_points(NET, weights=np.eye(4)), r"weight \[0, 1\] is 0.0: weights must be above zero"),
    (lambda: NurbsSurface.from_points(NET, (0, 3)), "degree in u is 0"),
    (lambda: NurbsSurface.from_points(np.zeros((30, 4, 3)), (26, 3)), "degree in u is 26: 1 to 25"),
    (lambda: NurbsSurface.from_points(NET, knots=([0, 0, 0, 1, 1, 1], uniform_knots(4, 3))), "6 knots in u"),
    (lambda: NurbsSurface.from_points(NET, knots=([0, 0, 0, 0, 1, 1, 1, 0.5], uniform_knots(4, 3))), "not decrease"),
    (lambda: NurbsSurface.from_points(NET, knots=([0, 0, 0, 0, 1, 1, 1, np.nan], uniform_knots(4, 3))), "finite"),
    (lambda: NurbsSurface.from_points(NET, knots=(np.zeros(8), uniform_knots(4, 3))), "no parameter range"),
    (lambda: NurbsSurface.from_points(np.zeros((8, 4, 3)), knots=(
        [0, 0, 0, 0, 0.5, 0.5, 0.5, 0.5, 1, 1, 1, 1], uniform_knots(4, 3))), "repeats more than 3 times"),
    (lambda: bilinear().transformed(np.eye(3)), r"\(4, 4\) affine"),
    (lambda: bilinear().transformed(np.diag([1, 1, 1, 2.0])), "affine"),
    (lambda: bilinear().transformed(np.diag([1, np.inf, 1, 1.0])), "finite"),
])
def test_refusals(make: Any, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        make()
