"""Knot insertion and its uses: the spline must stay where it was."""

import numpy as np
import pytest
from scipy.interpolate import BSpline

from toolaxis.errors import InvalidInput
from toolaxis.numeric.knots import (
    distinct_inner,
    elevate_degree,
    insert_knot,
    insert_knots,
    restrict_spline,
    unroll_periodic,
)


def spline(degree, clamped=True, seed=0):
    rng = np.random.default_rng(seed)
    inner = np.sort(rng.uniform(0, 5, 6))
    inner[2] = inner[3]
    run = np.zeros(degree + 1) if clamped else np.arange(degree + 1.0)
    knots = np.concatenate([-run[::-1], inner, 5 + run])
    return knots, rng.normal(size=(len(knots) - degree - 1, 2, 3))


def value(knots, control, degree, t):
    last = np.nextafter(knots[-degree - 1], -np.inf)
    return BSpline(knots, control, degree, extrapolate=False)(np.clip(t, knots[degree], last))


@pytest.mark.parametrize("degree", [1, 2, 3, 5])
@pytest.mark.parametrize("clamped", [True, False])
def test_inserting_a_knot_changes_nothing(degree, clamped):
    knots, control = spline(degree, clamped)
    t = np.linspace(0, 5, 97)
    before = value(knots, control, degree, t)
    for new in (0.7, 2.0, 2.0, 4.9, *((0.0, 5.0) if not clamped else ())):
        knots, control = insert_knot(knots, control, degree, new)
        assert (np.diff(knots) >= 0).all()
        assert np.abs(value(knots, control, degree, t) - before).max() < 1e-12


@pytest.mark.parametrize("degree", [1, 2, 3, 5])
@pytest.mark.parametrize("clamped", [True, False])
@pytest.mark.parametrize("low, high", [(0.0, 5.0), (0.3, 4.1), (0.0, 1.7), (2.2, 5.0)])
def test_a_piece_lies_on_the_whole_and_is_clamped(degree, clamped, low, high):
    knots, control = spline(degree, clamped)
    own_knots, own = restrict_spline(knots, control, degree, low, high)
    assert (own_knots[:degree + 1] == low).all()
    assert (own_knots[-degree - 1:] == high).all()
    t = np.linspace(low, high, 50)[:-1]
    assert np.abs(value(own_knots, own, degree, t) - value(knots, control, degree, t)).max() < 1e-12
    assert np.abs(own[0] - value(knots, control, degree, np.array([low]))[0]).max() < 1e-12


def test_a_piece_that_begins_at_a_full_knot():
    knots = np.array([0.0, 0, 0, 1, 1, 2, 2, 2])
    control = np.random.default_rng(4).normal(size=(5, 3))
    for low, high in ((0.0, 1.0), (1.0, 2.0)):
        own_knots, own = restrict_spline(knots, control, 2, low, high)
        assert len(own) == 3
        t = np.linspace(low, high, 9)[:-1]
        assert np.abs(value(own_knots, own, 2, t) - value(knots, control, 2, t)).max() < 1e-13


@pytest.mark.parametrize("low, high", [(1.0, 1.0), (2.0, 1.0), (-0.1, 1.0), (1.0, 5.1)])
def test_a_piece_outside_the_range_is_refused(low, high):
    knots, control = spline(3)
    with pytest.raises(InvalidInput, match="must be a part of"):
        restrict_spline(knots, control, 3, low, high)


@pytest.mark.parametrize("low, high", [(0.0, 4.0), (3.2, 4.7), (-9.3, -1.0), (1.0, 13.5)])
def test_a_periodic_spline_repeats_itself_when_unrolled(low, high):
    degree, n, period = 3, 5, 4.0
    inner = np.array([0.0, 0.5, 1.7, 2.0, 3.1])
    flat = np.array([inner[k % n] + period * (k // n) for k in range(-degree, n + degree + 1)])
    control = np.random.default_rng(2).normal(size=(n, 3))
    knots, own = unroll_periodic(flat, control, degree, low, high)
    wrapped = control[np.arange(n + degree) % n]
    t = np.linspace(low, high, 60)[:-1]
    assert np.abs(value(knots, own, degree, t) - value(flat, wrapped, degree, np.mod(t, period))).max() < 1e-12


def test_distinct_inner_knots_and_their_counts():
    values, counts = distinct_inner(np.array([0.0, 0, 0, 1, 1, 2, 3, 3, 3]), 2)
    assert values.tolist() == [1.0, 2.0]
    assert counts.tolist() == [2, 1]
    assert distinct_inner(np.array([0.0, 0, 1, 1]), 1)[0].size == 0


def test_knots_that_differ_by_rounding_stay_one_knot():
    """A closed fillet in a STEP file: its seam, one period on, was a second knot 3e-15 away and folded the surface."""
    period = 21.3 + 0.1775
    knots = np.linspace(0.0, period, 9)
    full = np.concatenate([knots[-4:-1] - period, knots, knots[1:4] + period])
    control = np.random.default_rng(2).normal(size=(8, 3))
    low = float(knots[3] + 3e-15)
    for shift in (0.0, period):
        own, net = unroll_periodic(full, control, 3, low + shift, low + shift + period)
        gaps = np.diff(np.unique(own))
        assert gaps.min() > 1.0
        assert len(net) == len(own) - 4
        assert (own[:4] == low + shift).all()
        assert np.abs(net[0] - net[-1]).max() < 1e-9


@pytest.mark.parametrize("degree", [2, 3, 5])
@pytest.mark.parametrize("more", [0, 1, 3])
def test_a_higher_degree_changes_nothing(degree, more):
    knots, control = spline(degree)
    raised, net = elevate_degree(knots, control, degree, degree + more)
    assert len(raised) == len(net) + degree + more + 1 and net.shape[1:] == control.shape[1:]
    t = np.linspace(0, 5, 97)
    assert np.abs(value(raised, net, degree + more, t) - value(knots, control, degree, t)).max() < 1e-11
    if not more:
        assert net is control


@pytest.mark.parametrize("degree", [1, 2, 3, 5])
def test_more_knots_change_nothing(degree):
    knots, control = spline(degree)
    target = np.sort(np.concatenate([knots, [0.7, 2.0, 2.0][:degree]]))
    net = insert_knots(knots, control, degree, target)
    t = np.linspace(0, 5, 97)
    assert np.abs(value(target, net, degree, t) - value(knots, control, degree, t)).max() < 1e-12
    assert insert_knots(knots, control, degree, knots) is control
