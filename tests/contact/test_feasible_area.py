"""The feasible area of a torus: its border by the formula against curvatures looked at in every plane."""

import numpy as np
import pytest

from toolaxis.contact.clearance.gouge import gouge
from toolaxis.errors import InvalidInput
from toolaxis.shape.analytic import CylindricalSurface
from toolaxis.shape.face import Face
from toolaxis.strategies.roughness.feasible_area import (
    critical_curvature,
    evaluation_curvature,
    least_lean,
    nearest_feasible,
    torus_curvatures,
)
from toolaxis.tools.tool import Tool

TOOL = Tool.torus(10, 3)
PLANES = np.linspace(0, np.pi, 2001)


def _surfaces(count: int, seed: int = 0):
    rng = np.random.default_rng(seed)
    k1 = rng.uniform(-0.1, 0.3, count)
    return (k1, k1 - rng.uniform(0, 0.3, count)), rng.uniform(-np.pi, np.pi, count)


def test_the_critical_curvature_is_the_least_over_all_planes() -> None:
    curvatures, direction = _surfaces(400)
    lean = np.random.default_rng(1).uniform(0.01, 1.4, 400)
    least, plane = critical_curvature(TOOL, curvatures, lean, direction)
    assert np.abs(evaluation_curvature(TOOL, curvatures, lean, direction, plane) - least).max() < 1e-15
    every = evaluation_curvature(TOOL, tuple(k[:, None] for k in curvatures), lean[:, None], direction[:, None], PLANES)
    assert (every.min(axis=1) >= least - 1e-15).all()
    assert (every.min(axis=1) <= least + 1e-6).all()


def test_on_the_border_the_least_evaluation_curvature_is_zero() -> None:
    curvatures, direction = _surfaces(20000)
    lean = least_lean(TOOL, curvatures, direction)
    on = (lean > 0) & np.isfinite(lean)
    some = tuple(k[on] for k in curvatures)
    assert on.sum() > 5000
    least, plane = critical_curvature(TOOL, some, lean[on], direction[on])
    assert np.abs(least).max() < 1e-12
    assert np.abs(evaluation_curvature(TOOL, some, lean[on], direction[on], plane)).max() < 1e-12
    assert (critical_curvature(TOOL, some, lean[on] + 1e-6, direction[on])[0] > 0).all()
    assert (critical_curvature(TOOL, some, lean[on] - 1e-6, direction[on])[0] < 0).all()


def test_where_the_formula_says_all_or_none_it_is_so() -> None:
    curvatures, direction = _surfaces(20000, 2)
    lean = least_lean(TOOL, curvatures, direction)
    for chosen, sign in ((lean == 0, 1), (np.isinf(lean), -1)):
        some = tuple(k[chosen][:, None] for k in curvatures)
        least, _ = critical_curvature(TOOL, some, np.linspace(1e-6, np.pi / 2, 40), direction[chosen][:, None])
        assert chosen.sum() > 100 and (sign * least >= -1e-12).all()


def test_a_cutter_hollowed_by_nothing_needs_the_flat_limit() -> None:
    flat, (k1, k2), gamma = Tool.flat(10), (np.array([0.05]), np.array([0.02])), np.array([0.7])
    beside = k1 * np.cos(gamma + np.pi / 2) ** 2 + k2 * np.sin(gamma + np.pi / 2) ** 2
    assert np.sin(least_lean(flat, (k1, k2), gamma)) == pytest.approx(5 * beside, rel=1e-14)
    near = Tool.torus(10, 1e-7)
    assert least_lean(near, (k1, k2), gamma) == pytest.approx(least_lean(flat, (k1, k2), gamma), rel=1e-6)


def test_on_a_hollow_cylinder_the_border_is_where_the_solid_cutter_begins_to_gouge() -> None:
    face = Face(CylindricalSurface(20.0, (-1.2, 1.2), (0.0, 60.0)).nurbs(), flip=True)
    uv = face.grid(5, 5)[12:13]
    k, normal = face.curvature(uv), face.normal(uv)
    border = float(least_lean(TOOL, (k.k1, k.k2), np.pi / 2)[0])
    assert np.sin(border) == pytest.approx(2 * 0.05 / (1 - 3 * 0.05), rel=1e-9)
    for lean, gouges in ((border - 0.02, True), (border + 0.002, False)):
        axis = np.cos(lean) * normal + np.sin(lean) * k.d2
        assert (gouge(face, TOOL, uv, axis)[0] > 1e-3) == gouges, lean  # an upper bound, good to some 1e-4


def test_the_nearest_feasible_orientation_is_the_nearest() -> None:
    curvatures, direction = _surfaces(300, 5)
    lean = np.random.default_rng(6).uniform(0.0, 1.2, 300)
    found = nearest_feasible(TOOL, curvatures, lean, direction)
    k1, k2 = curvatures
    ok = found.found
    assert ok.sum() > 250
    assert (critical_curvature(TOOL, (k1[ok], k2[ok]), found.lean[ok], found.direction[ok])[0] > -1e-14).all()
    turn = np.linspace(-np.pi, np.pi, 7201)
    border = least_lean(TOOL, (k1[:, None], k2[:, None]), direction[:, None] + turn)
    brute = np.hypot(turn, np.maximum(border - lean[:, None], 0)).min(axis=1)
    assert (found.distance[ok] <= brute[ok] + 1e-9).all() and (found.distance[ok] >= brute[ok] - 1e-3).all()
    inside = least_lean(TOOL, curvatures, direction) <= lean
    assert np.array_equal(found.distance[ok] == 0, inside[ok])
    assert np.array_equal(found.found, np.isfinite(brute))


def test_the_torus_at_the_edges_of_its_leans() -> None:
    along, across = torus_curvatures(TOOL, [0.0, np.pi / 2])
    assert along.tolist() == [1 / 3, 1 / 3] and across == pytest.approx([0.0, 0.2])


@pytest.mark.parametrize("tool", [Tool.ball(10), Tool.torus(10, 5)])
def test_a_ball_has_no_border(tool: Tool) -> None:
    with pytest.raises(InvalidInput, match="corner radius is 5 mm, the radius of the cutter"):
        least_lean(tool, (0.1, 0.0), 0.0)
    with pytest.raises(InvalidInput, match="does not depend on how it leans"):
        critical_curvature(tool, (0.1, 0.0), 0.3, 0.0)


def test_a_sharp_corner_has_no_curvature() -> None:
    with pytest.raises(InvalidInput, match="0 mm: a sharp corner"):
        critical_curvature(Tool.flat(10), (0.1, 0.0), 0.3, 0.0)
