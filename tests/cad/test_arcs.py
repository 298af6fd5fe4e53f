"""Arcs: points on the circle, and the closed form between angle and spline parameter."""

import numpy as np
import pytest

from toolaxis.cad.rational_arcs import (
    ParameterMap,
    angle_breaks,
    angle_from_parameter,
    arc_knots,
    arc_rows,
    parameter_from_angle,
)
from toolaxis.numeric.bspline import basis_derivatives_numpy

RANGES = [(0.0, 2 * np.pi), (-0.3, 0.2), (1.0, 1.0 + np.pi / 2), (5.0, 8.5), (-4.0, 4.0)]


@pytest.mark.parametrize("low, high", RANGES)
def test_arc_passes_through_every_angle_at_its_mapped_parameter(low, high):
    breaks = angle_breaks(low, high)
    angle = np.linspace(low, high, 101)
    rows, first = basis_derivatives_numpy(arc_knots(breaks), 2, parameter_from_angle(breaks, angle))
    x, y, w = np.einsum("nk,nkc->nc", rows[:, 0], arc_rows(breaks)[first[:, None] + np.arange(3)]).T
    assert np.abs(x / w - np.cos(angle)).max() < 1e-14
    assert np.abs(y / w - np.sin(angle)).max() < 1e-14


@pytest.mark.parametrize("low, high", RANGES)
def test_spans_are_at_most_a_right_angle_and_equal(low, high):
    spans = np.diff(angle_breaks(low, high))
    assert spans.max() <= np.pi / 2 + 1e-9
    assert np.ptp(spans) < 1e-12


@pytest.mark.parametrize("low, high", RANGES)
def test_breaks_stay_and_the_two_maps_are_inverse(low, high):
    breaks = angle_breaks(low, high)
    assert np.abs(parameter_from_angle(breaks, breaks) - breaks).max() < 1e-14
    angle = np.linspace(low - 0.01, high + 0.01, 57)
    assert np.abs(angle_from_parameter(breaks, parameter_from_angle(breaks, angle)) - angle).max() < 1e-13


def test_the_map_is_not_the_identity_between_breaks():
    breaks = angle_breaks(0.0, np.pi / 2)
    assert abs(parameter_from_angle(breaks, np.array([0.3]))[0] - 0.3) > 1e-3


def test_parameter_map_leaves_plain_directions_alone():
    uv = np.array([[0.4, 0.4], [1.0, -2.0]])
    mapped = ParameterMap(angle_breaks(0.0, 1.5), None).to_ours(uv)
    assert (mapped[:, 1] == uv[:, 1]).all()
    assert (mapped[:, 0] != uv[:, 0]).all()
    assert (ParameterMap().to_ours(uv) == uv).all()
