"""The walk to a local optimum, closer looks, and what the ledger keeps of them."""

import warnings
from dataclasses import replace
from math import radians

import numpy as np
import pytest

from toolaxis.feasibility.refined_check import closer
from toolaxis.feasibility.violations import BACK, FREE, GOUGE, LIMITS, WANDERS, Violation
from toolaxis.numeric.vectors import angle_between, perpendicular, unit
from toolaxis.search.direction_grid import ring, spiral
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import task
from toolaxis.search.hemisphere import search
from toolaxis.search.local_search import _lowest, count_row, polish, proven
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

TOOL = Tool.torus(12, 1)
H = 0.02
LITTLE = 5e-5


def bumpy(seed, height):
    x, y = np.meshgrid(np.linspace(-30, 30, 6), np.linspace(-30, 30, 5), indexing="ij")
    z = height * np.random.default_rng(seed).normal(size=x.shape)
    return Face.from_bspline(np.stack([x, y, z], axis=-1))


def started(face, axis, **how):
    job = task(face, TOOL, H, **how)
    ledger = AxisTable(job.feasibility, job.worth)
    ledger.look(unit(np.asarray(axis, dtype=float))[None])
    return ledger


@pytest.fixture(scope="module")
def face():
    return bumpy(0, 3.0)


def test_the_search_goes_on_past_the_second_order_limit_of_curvature(face):
    job = task(face, TOOL, H)
    ledger = AxisTable(job.feasibility, job.worth)
    beyond = unit(np.array([0.33867908, 0.01563005, 0.94077212]))
    assert np.isinf(ledger.worth.screen(beyond[None]).length[0, 0])
    found = search(ledger)[0]
    assert found.value <= ledger.worth.counted(beyond, "u")[1] * 1.001
    assert ledger.feasibility.witness(found.axis) is None


def test_the_walk_follows_a_kinked_valley_and_stays_proven():
    ledger = started(bumpy(93, 2.0), [-0.266, 0.032, 0.963])
    start = count_row(ledger, 0, 0)
    found = polish(ledger, start, radians(1.25))
    assert found.value < start.value * 0.9985
    assert ledger.feasibility.witness(found.axis) is None
    assert ledger.closer + ledger.counts < 40


def test_the_walk_leaves_an_axis_of_which_no_strip_is_known():
    ledger = started(bumpy(93, 2.0), [-0.266, 0.032, 0.963])
    start = count_row(ledger, 0, 0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = polish(ledger, replace(start, value=np.inf, passes=np.inf, length=np.inf), radians(2))
    assert np.isfinite(found.value) and found.value < start.value


def test_the_lowest_place_of_a_ring_is_that_of_its_parabola():
    middle, step, low = unit(np.array([0.2, -0.3, 1.0])), radians(1), np.array([0.7, -0.4])
    x, y = perpendicular(middle)
    axes = ring(middle, step, 0.3)
    places = np.stack([axes @ x, axes @ y], axis=1) / np.sin(step)
    bend = np.array([[0.02, 0.005], [0.005, 0.01]])

    def rise(p):
        return 0.5 * np.einsum("ni,ij,nj->n", p - low, bend, p - low)

    hope = 1 + rise(places) - rise(np.zeros((1, 2)))
    found = _lowest(middle, axes, hope, step, LITTLE)
    np.testing.assert_allclose([found @ x, found @ y], np.tan(step) * low / np.sqrt(1 + np.tan(step) ** 2 * low @ low),
                               atol=1e-9)
    assert _lowest(middle, axes, 2 - hope, step, LITTLE) is None
    assert _lowest(middle, axes, np.where(np.arange(6) == 2, np.inf, hope), step, LITTLE) is None


def test_a_closer_look_proves_the_normals_between_samples_and_the_ledger_heeds_it():
    face = bumpy(94, 2.0)
    ledger = started(face, [-0.3008, 0.0179, 0.9535])
    judged = ledger.feasibility
    found = closer(judged, ledger.axes[0], judged.sparse)
    assert ledger.reason[0] == FREE and found.reason == WANDERS and found.uv.shape == (1, 2)
    near = unit(ledger.axes[0] + np.array([2e-4, 0, 0]))
    ledger.look(near[None])
    assert not proven(ledger, 0)
    assert ledger.closer == 1 and ledger.reason.tolist() == [WANDERS, WANDERS]
    assert angle_between(face.normal(ledger.feasibility.watched), near).min() < judged.least_angle


def test_what_is_excluded_beforehand_is_in_the_map_but_no_evaluation(face):
    ledger = started(face, [0, 0, 1.0])
    axes = spiral(np.eye(3), radians(12))
    ledger.lay(axes)
    reason = ledger.feasibility.quick(axes)[0]
    out = np.isin(reason, (LIMITS, BACK))
    assert 0 < ledger.excluded == out.sum() and len(ledger.axes) == 1 + len(axes)
    assert ledger.evaluations == 1 + (~out).sum()
    assert np.isinf(ledger.values[1:1 + out.sum()]).all() and len(ledger.map().axis) == 1 + len(axes)


def test_a_disc_that_was_closed_stays_closed(face):
    ledger = started(face, [0.3522, 0.0068, 0.9359])
    assert ledger.reason[0] == FREE
    ledger.close(ledger.axes[0], radians(2), Violation(GOUGE, 0.01))
    ledger.look(np.concatenate([ring(ledger.axes[0], radians(1.9)), ring(ledger.axes[0], radians(2.1))]))
    assert (ledger.reason[:7] != FREE).all() and (ledger.reason[7:] == FREE).any()
    assert ledger.amount[0] == 0.01
