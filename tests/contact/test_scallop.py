"""Scallop height between neighbours, step-over and roughness."""

import numpy as np
import pytest

from toolaxis.contact.frame import axis_from_lean, contact_frame
from toolaxis.contact.strip.scallop import (
    effective_radius,
    roughness_from_scallop,
    scallop_from_step,
    scallop_height,
    step_from_scallop,
)
from toolaxis.contact.strip.second_order import second_order_width
from toolaxis.contact.strip.width import step_widths
from toolaxis.errors import InvalidInput
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool


def plane():
    return Face.from_bspline([[[0, 0, 0], [0, 60, 0]], [[60, 0, 0], [60, 60, 0]]], degree=(1, 1))


def wavy():
    rng = np.random.default_rng(8)
    xy = np.stack(np.meshgrid(np.linspace(0, 90, 6), np.linspace(0, 90, 6), indexing="ij"), -1)
    return Face.from_bspline(np.concatenate([xy, rng.normal(size=(6, 6, 1)) * 4], -1))


# widths of a ball R6 at h = 0.02: plane, cylinders along the axis, spheres
BALL = [(0.0, 0.978979), (-1 / 40, 0.912679), (1 / 60, 1.032110), (-1 / 80, 0.944095), (1 / 80, 1.018023)]


@pytest.mark.parametrize("curvature, wanted", BALL)
def test_step_of_a_ball_in_numbers(curvature, wanted):
    assert abs(step_from_scallop(0.02, 6, curvature) - wanted) < 0.5e-6
    assert abs(scallop_from_step(step_from_scallop(0.02, 6, curvature), 6, curvature) - 0.02) < 1e-15


def test_step_and_scallop_are_inverse_over_the_whole_range():
    rng = np.random.default_rng(1)
    radius = rng.uniform(1, 10, 300)
    h, k = radius * 10 ** rng.uniform(-5, -0.5, 300), rng.uniform(-0.2, 0.9, 300) / radius
    assert np.abs(scallop_from_step(step_from_scallop(h, radius, k), radius, k) / h - 1).max() < 1e-9


def test_small_curvature_is_the_plane():
    for curvature in (1e-12, -1e-12):
        assert abs(step_from_scallop(0.02, 6, curvature) - 2 * np.sqrt(0.24 - 0.0004)) < 1e-10


@pytest.mark.parametrize("lean, way", [(5, 0), (20, 0), (10, 45), (30, 80)])
def test_effective_radius_is_the_second_order_width_on_a_plane(lean, way):
    tool, lean, way = Tool.torus(12, 1), np.radians(lean), np.radians(way)
    axis = axis_from_lean(contact_frame(plane(), [[0.5, 0.5]]), lean, way)
    width = second_order_width(plane(), tool, [[0.5, 0.5]], axis, 0.02)[0]
    assert np.isclose(width, 2 * np.sqrt(2 * 0.02 * effective_radius(tool, lean, way)), rtol=1e-12)


def test_effective_radius_in_numbers():
    assert np.isclose(effective_radius(Tool.torus(10, 3), np.radians(20)), 3 + 2 / np.sin(np.radians(20)))
    assert effective_radius(Tool.ball(8), 0.3) == 4 and np.isinf(effective_radius(Tool.flat(8), 0.0))


def test_roughness_in_numbers():
    """Ra 1.6 um belongs to d = 0.66434 mm for R5 r3 at 20 degrees, with h = d^2 / (8 R_eff)."""
    reach = effective_radius(Tool.torus(10, 3), np.radians(20))
    assert abs(roughness_from_scallop(0.66434**2 / (8 * reach)) - 1.6e-3) < 1e-7
    y = np.linspace(-1, 1, 200001)
    assert abs(np.abs(y**2 - (y**2).mean()).mean() - roughness_from_scallop(1.0)) < 1e-5


def test_scallop_of_a_ball_between_two_passes_of_a_plane():
    for apart in (0.3, 1.0, 4.0):
        found = scallop_height(plane(), Tool.ball(12), [[0.5, 0.5]], [[0.5, 0.5 + apart / 60]], [0.2, 0.1, 1])
        assert abs(found[0] - scallop_from_step(apart, 6)) < 1e-9


@pytest.mark.parametrize("feed", ["u", "v"])
def test_scallop_gives_the_height_back_whose_half_widths_meet(feed):
    """Neighbours set where the half widths of both reach each other, found by bisection."""
    face, tool, axis, step = wavy(), Tool.torus(12, 1), [0.3, 0.2, 1], 1 if feed == "u" else 0
    uv = np.random.default_rng(3).uniform(0.35, 0.65, (8, 2))
    for h in (0.005, 0.05):
        low, high = uv.copy(), uv.copy()
        low[:, step], high[:, step] = uv[:, step], uv[:, step] + 0.1
        for _ in range(50):
            middle = (low + high) / 2
            reach = step_widths(face, tool, uv, axis, h, feed)[:, 1]
            reach = reach + step_widths(face, tool, middle, axis, h, feed)[:, 0]
            far = (reach > middle[:, step] - uv[:, step])[:, None]
            low, high = np.where(far, middle, low), np.where(far, high, middle)
        assert np.abs(scallop_height(face, tool, uv, low, axis, feed) - h).max() < 1e-9
        assert np.abs(scallop_height(face, tool, low, uv, axis, feed) - h).max() < 1e-9


def test_passes_too_far_apart_leave_the_radius():
    assert abs(scallop_height(plane(), Tool.ball(8), [[0.5, 0.2]], [[0.5, 0.7]], [0, 0, 1])[0] - 4) < 1e-6


@pytest.mark.parametrize("call, words", [
    (lambda: step_from_scallop(0.0, 6), "above zero"), (lambda: step_from_scallop(7.0, 6), "below the radius"),
    (lambda: step_from_scallop(0.1, 6, 0.2), "does not fit"), (lambda: scallop_from_step(13.0, 6), "do not overlap"),
    (lambda: scallop_height(plane(), Tool.ball(8), [[0.5, 0.5]], [[0.6, 0.6]], [0, 0, 1]), "must share u"),
    (lambda: scallop_height(plane(), Tool.ball(8), [[0.5, 0.5]], [[0.5, 0.5]], [0, 0, 1]), "must share u"),
    (lambda: scallop_height(plane(), Tool.ball(8), [[0.5, 0.5]], np.full((2, 2), 0.5), [0, 0, 1]),
     "give one for each")])
def test_nonsense_is_refused(call, words):
    with pytest.raises(InvalidInput, match=words):
        call()
