"""The search over the hemisphere and over sectors: against brute force, symmetry, ties, limits, and motion."""

from math import radians

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.feasibility.violations import FREE, GOUGE
from toolaxis.machine.limits import Cone, parse_limits
from toolaxis.numeric.vectors import angle_between, rotation, unit
from toolaxis.path.pass_count import count
from toolaxis.search import hemisphere as sphere
from toolaxis.search.branch_and_bound import hunt
from toolaxis.search.cost import MachiningCost
from toolaxis.search.direction_grid import spiral
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import task
from toolaxis.search.hemisphere import search
from toolaxis.search.sectors import mean_normal, roman_axis, sectors
from toolaxis.shape.face import Face
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.tools.tool import Tool

TOOL = Tool.torus(8, 1)
H = 0.05


def searched(face, tool=TOOL, method=search, **how):
    job = task(face, tool, H, **how)
    ledger = AxisTable(job.feasibility, job.worth)
    return ledger, method(ledger)


def brute(ledger):
    """Least exact value of all axes of a dense grid that the proof form accepts."""
    axes = spiral(np.eye(3), radians(2.5), radians(75))
    found = ledger.feasibility.screen(axes)
    worth = ledger.worth
    screened = worth.screen(axes).length
    price = np.where(found.reason == FREE, screened.min(axis=1), np.inf)
    rows = [i for i in np.argsort(price, kind="stable")[:12] if np.isfinite(price[i])]
    exact = sorted((worth.counted(axes[i], "uv"[screened[i].argmin()])[1], i) for i in rows)
    return next((value for value, i in exact if ledger.feasibility.witness(axes[i]) is None), np.inf)


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.long)])
def test_search_reaches_brute_force_with_few_evaluations(make, seed):
    ledger, found = searched(make.seeded(40 + seed, 0.9))
    assert found[0].value <= brute(ledger) / 0.99
    assert ledger.evaluations < 82_500 / 50
    assert ledger.feasibility.witness(found[0].axis) is None


@pytest.mark.long
@pytest.mark.parametrize("seed", range(1))
def test_search_is_never_below_the_sectors(make, seed):
    face = make.seeded(50 + seed, 0.9)
    ledger, ours = searched(face)
    other, theirs = searched(face, method=sectors)
    assert theirs and ours[0].value <= theirs[0].value * 1.0005
    assert ledger.evaluations <= other.evaluations / 5
    assert other.feasibility.witness(theirs[0].axis) is None


def test_a_saddle_has_two_pairs_of_equal_lobes(make):
    _, found = searched(make.saddle())
    assert len(found) >= 4
    values = np.array([c.value for c in found[:4]])
    assert values[1] < 1.004 * values[0] and values[3] < 1.004 * values[2]
    axes = np.array([c.axis for c in found[:4]])
    for mirror in ([-1, 1, 1], [1, -1, 1]):
        assert max(angle_between(axes, axis * mirror).min() for axis in axes) < radians(2.5)
    assert angle_between(axes[:, None], axes[None])[np.triu_indices(4, 1)].min() > radians(12)


def test_search_moves_with_the_face(make):
    face, turn = make.seeded(61), rotation([1, 2, -1], 1.0)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, [30, -20, 10]
    _, one = searched(face)
    _, other = searched(face.transformed(matrix))
    assert abs(one[0].value / other[0].value - 1) < 0.002
    assert angle_between(turn @ one[0].axis, other[0].axis) < radians(0.5)


def test_mirrored_scaled_and_swapped_faces_have_the_same_best_value(make):
    face = make.seeded(62)
    _, one = searched(face)
    _, mirrored = searched(face.transformed(np.diag([-1.0, 1, 1, 1])))
    assert abs(mirrored[0].value / one[0].value - 1) < 0.01
    swapped = Face(face.surface.swapped(), flip=True)
    _, turned = searched(swapped)
    assert abs(turned[0].value / one[0].value - 1) < 0.005 and turned[0].feed == 1 - one[0].feed
    double = Face(NurbsSurface(face.surface.knots_u, face.surface.knots_v,
                               face.surface.control * [2, 2, 2, 1], face.surface.degree))
    job = task(double, Tool.torus(16, 2), 2 * H)
    big = search(AxisTable(job.feasibility, job.worth))
    assert abs(big[0].passes / one[0].passes - 1) < 0.005


def test_search_is_deterministic(make):
    face = make.seeded(63)
    (one, a), (other, b) = searched(face), searched(face)
    assert (one.axes == other.axes).all() and (a[0].axis == b[0].axis).all() and a[0].value == b[0].value


@pytest.mark.parametrize("name", ["saddle", *(pytest.param(name, marks=pytest.mark.long) for name in ("bowl", "flat"))])
def test_the_last_digits_of_a_surface_do_not_lead_the_search_elsewhere(make, name):
    """Mirror images cost the same: the search looks at the same axes whatever the rounding."""
    face = {"saddle": make.saddle, "bowl": lambda: make.bowl(-60.0),
            "flat": lambda: make.flat([-15, -15, 0], [30, 0, 0], [0, 30, 0])}[name]()
    surface = face.surface
    one, found = searched(face)
    for seed in range(3):
        noise = np.random.default_rng(seed).uniform(-5e-15, 5e-15, surface.control.shape) * [1, 1, 1, 0]
        near = Face(NurbsSurface(surface.knots_u, surface.knots_v, surface.control + noise, surface.degree))
        other, again = searched(near)
        assert len(one.axes) == len(other.axes)
        np.testing.assert_allclose(other.axes, one.axes, atol=1e-9)
        assert [c.value for c in again] == [c.value for c in found]


def test_every_axis_of_a_ball_ties_and_the_mean_normal_wins(make):
    face = make.seeded(64)
    ledger, found = searched(face, Tool.ball(8))
    field = ledger.feasibility.normals
    np.testing.assert_allclose(found[0].axis, field.mean, atol=1e-12)
    tilted = unit(field.mean + np.array([0.2, 0.1, 0]))
    assert abs(count(face, Tool.ball(8), tilted, H, "uv"[found[0].feed]) / found[0].passes - 1) < 0.001


def test_a_ball_leans_away_from_what_its_holder_would_be_near(make):
    face = make.seeded(64, 0.3)
    held = Tool.ball(8, stickout=30, holder=[(12, 0), (12, 30)])
    block = make.flat([-15, 24, -5], [30, 0, 0], [0, 0, 90])
    ledger, found = searched(face, held, obstacles=block)
    assert found[0].axis[1] < -0.1
    assert ledger.feasibility.room(found[0].axis) >= ledger.feasibility.room(ledger.feasibility.normals.mean)


def test_limits_are_kept(make):
    face = make.seeded(65)
    cone = Cone(unit(np.array([0.5, 0.2, 1.0])), radians(12))
    _, found = searched(face, limits=cone)
    _, free = searched(face)
    assert all(cone.allowed(c.axis)[0] for c in found)
    assert found[0].value >= free[0].value * 0.999


def test_a_narrow_cone_between_the_first_axes_is_found(make):
    face = make.seeded(66)
    for turn in np.radians([10, 100, 200]):
        middle = np.array([np.sin(0.5) * np.cos(turn), np.sin(0.5) * np.sin(turn), np.cos(0.5)])
        _, found = searched(face, limits=Cone(middle, radians(1.0)))
        assert found and angle_between(found[0].axis, middle) <= radians(1.0) + 1e-9


def test_limits_that_exclude_the_face_are_proven_to(make):
    job = task(make.seeded(67), TOOL, H, parse_limits("cone:0,0,-1,40"))
    ledger = AxisTable(job.feasibility, job.worth)
    assert search(ledger) == [] and ledger.proven
    open_ = AxisTable(job.feasibility, job.worth)
    open_.feasibility = task(make.seeded(67), TOOL, H).feasibility
    open_.look(np.array([[0, 0, 1.0], [0, 0, 1.0], unit([0.3, 0.2, 1.0])]))
    assert not hunt(open_, 2, radians(10))


def test_a_closer_look_may_refuse_the_last_axis(make, monkeypatch):
    def refuse(ledger, _):
        for row in np.flatnonzero(ledger.reason == FREE):
            ledger.forbid(int(row), GOUGE, 1.0)

    monkeypatch.setattr(sphere, "probe", refuse)
    ledger, found = searched(make.seeded(68))
    assert found == [] and not ledger.proven and len(ledger.axes) > 0


def test_objectives_choose_by_what_they_name(make):
    face = make.seeded(68, 0.6)
    narrow = Face(NurbsSurface(face.surface.knots_u, face.surface.knots_v,
                               face.surface.control * [1.0, 0.4, 1, 1], face.surface.degree))
    _, by_length = searched(narrow)
    _, by_passes = searched(narrow, objective="passes")
    assert by_passes[0].passes <= by_length[0].passes * 1.001
    assert by_length[0].length <= by_passes[0].length * 1.001
    with pytest.raises(InvalidInput, match="objective"):
        MachiningCost(face, TOOL, H, objective="weight")


def test_what_stays_at_walls_is_charged(make):
    worth = MachiningCost(make.seeded(1), TOOL, H)
    assert worth.charge(500.0, 0.0) == 1.0
    assert worth.charge(500.0, 0.2) > 1.1
    assert worth.charge(500.0, 0.4) > worth.charge(500.0, 0.2)


def test_baselines_are_unit_axes_and_roman_s_stands_in_front(make):
    face = make.saddle(3.0)
    ledger, _ = searched(face)
    roman = roman_axis(ledger)
    assert abs(np.linalg.norm(roman) - 1) < 1e-12
    assert ledger.feasibility.normals.angles(roman[None])[0][0] > radians(0.5)
    np.testing.assert_allclose(mean_normal(ledger), [0, 0, 1], atol=1e-9)
