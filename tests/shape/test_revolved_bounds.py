"""Bounds of derivatives on patches that are much longer than they bend: fillets, cones, pieces of tori and spheres."""

import numpy as np
import pytest

from toolaxis.contact.clearance.branch_and_bound import BUDGET
from toolaxis.contact.clearance.gouge import RESOLUTION, least_distance, segment_motions
from toolaxis.contact.clearance.queries import lower_bounds
from toolaxis.numeric.bezier import bezier_nets, derivative_bounds
from toolaxis.shape.bounding.base_cells import grid_lines
from toolaxis.shape.bounding.bounding_tree import cells
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

#: A quarter of a circle: its control points and weights.
ARC, WEIGHTS = np.array([[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), np.array([1.0, np.sqrt(0.5), 1.0])


def along_edge(radius: float, length: float, taper: float = 1.0) -> Face:
    """A fillet around the y axis, its radius changing from end to end."""
    ends = [(0.0, radius), (length, taper * radius)]
    points = np.array([[[r * x, y, r * z] for y, r in ends] for x, z in ARC])
    return Face.from_bspline(points, (2, 1), weights=np.outer(WEIGHTS, [1.0, 1.0]))


def revolved(radius: float, tube: float) -> Face:
    """A piece of a torus."""
    profile = [(radius + tube * x, tube * z) for x, z in ARC]
    points = np.array([[[r * x, r * y, z] for r, z in profile] for x, y in ARC])
    return Face.from_bspline(points, (2, 2), weights=np.outer(WEIGHTS, WEIGHTS))


FACES = {"fillet": along_edge(0.02, 16.0), "cone": along_edge(1.0, 40.0, 3.0), "torus": revolved(50.0, 0.5),
         "sphere": revolved(0.0, 5.0)}


@pytest.mark.parametrize("name", FACES)
def test_bounds_hold_between_all_samples(name: str) -> None:
    face = FACES[name]
    data, (u, v) = face.surface.data, face.surface.domain
    lines = grid_lines(data[0], data[3], *u), grid_lines(data[1], data[4], *v)
    widths = np.diff(lines[0]), np.diff(lines[1])
    second = derivative_bounds(bezier_nets(data, *lines), *widths, 2)
    third = derivative_bounds(bezier_nets(data, *lines), *widths, 3)
    rng, step = np.random.default_rng(3), 1e-4
    for i in range(len(widths[0])):
        for j in range(len(widths[1])):
            width = np.array([widths[0][i], widths[1][j]])
            uv = np.array([lines[0][i], lines[1][j]]) + rng.uniform(0.0, 0.999, (100, 2)) * width
            here, right, up = (face.evaluate(uv + np.array(d) * step * width) for d in ((0, 0), (1, 0), (0, 1)))
            seen = [np.linalg.norm(x, axis=1).max() for x in (here.suu, here.suv, here.svv)]
            assert (seen <= second[i, j] * (1 + 1e-9) + 1e-12).all()
            du, dv = step * width
            seen = [np.linalg.norm(x, axis=1).max() for x in
                    ((right.suu - here.suu) / du, (up.suu - here.suu) / dv, (up.suv - here.suv) / dv,
                     (up.svv - here.svv) / dv)]
            assert (seen <= third[i, j] * (1 + 1e-5) + 1e-6).all()


def test_the_length_of_a_fillet_is_no_bend() -> None:
    face = FACES["fillet"]
    lines = np.linspace(0, 1, 9), np.array([0.0, 1.0])
    bounds = derivative_bounds(bezier_nets(face.surface.data, *lines), np.diff(lines[0]), np.diff(lines[1]), 2)
    d = face.evaluate(face.grid(40, 5))
    assert bounds[..., 0].max() <= 3 * np.linalg.norm(d.suu, axis=1).max()
    assert bounds[..., 1:].max() <= 1e-12


def test_one_patch_with_other_weights_does_not_make_a_bend_of_the_length_of_the_next() -> None:
    """A joined face: a fillet along a wall of 192 mm, then a corner whose weights rounding has moved off a product."""
    rounding = 1.0 + 1e-11
    across = np.array([WEIGHTS, WEIGHTS, WEIGHTS, WEIGHTS, WEIGHTS]).T
    turn = np.array([1.0, 1.0, 1.0, np.sqrt(0.5), 1.0])
    weights = across * turn
    weights[1, 3] *= rounding
    along = np.array([(-96.0, 60.0), (0.0, 60.0), (96.0, 60.0), (100.0, 60.0), (100.0, 56.0)])
    inwards = np.array([(0.0, -0.3), (0.0, -0.3), (0.0, -0.3), (-0.3, -0.3), (-0.3, 0.0)])
    points = np.array([[[*(place + (1.0 - x) * into), 0.3 * z] for place, into in zip(along, inwards, strict=True)]
                       for x, z in ARC])
    face = Face.from_bspline(points, (2, 2), [np.array([0.0, 0, 0, 1, 1, 1]), np.array([0.0, 0, 0, 1, 1, 2, 2, 2])],
                             weights=weights)
    lines = np.linspace(0, 1, 5), np.array([0.0, 1.0, 2.0])
    bounds = derivative_bounds(bezier_nets(face.surface.data, *lines), np.diff(lines[0]), np.diff(lines[1]), 2)
    d = face.evaluate(face.grid(40, 40))
    assert bounds[:, 0, 0].max() <= 3 * np.linalg.norm(d.suu, axis=1).max()
    for k, own_values in enumerate((d.suu, d.suv, d.svv)):
        assert np.linalg.norm(own_values, axis=1).max() <= bounds[..., k].max()


def test_weights_that_are_no_products_have_bounds_too() -> None:
    weights = np.outer(WEIGHTS, WEIGHTS)
    weights[1, 1] = 1.3
    own = revolved(20.0, 2.0)
    face = Face.from_bspline(own.surface.control[..., :3] / own.surface.control[..., 3:], (2, 2), weights=weights)
    lines = np.linspace(0, 1, 9), np.linspace(0, 1, 9)
    bounds = derivative_bounds(bezier_nets(face.surface.data, *lines), np.diff(lines[0]), np.diff(lines[1]), 2)
    d = face.evaluate(face.grid(80, 80))
    for k, own_values in enumerate((d.suu, d.suv, d.svv)):
        assert np.linalg.norm(own_values, axis=1).max() <= bounds[..., k].max()


@pytest.mark.parametrize("radius", [0.02, 0.2])
def test_a_cut_over_a_thin_fillet_is_bounded_within_the_work_allowed(radius: float) -> None:
    """A ball end along the middle normal, 0.01 mm below the fillet, over 3 mm of it."""
    face, tool = along_edge(radius, 16.0), Tool.ball(6.0)
    axis = np.array([1.0, 0.0, 1.0]) / np.sqrt(2.0)
    centre = (radius + 3.0 - 0.01) * axis
    tips = centre - 3.0 * axis + np.array([[0.0, 6.0, 0.0], [0.0, 9.0, 0.0]])
    only = np.tile([0.0, -np.inf, -np.inf], (1, 1))
    found = lower_bounds(cells(face), tool, segment_motions(tips, axis), 0.0, -least_distance(tool, RESOLUTION), only)
    assert found.looked.max() < BUDGET / 4
    assert -found.lower[0, 0] == pytest.approx(0.01, abs=2 * RESOLUTION)
