"""Axes along the flank: where they lie, that they move with the face, and that a search finds the lobe around them."""

from math import radians

import numpy as np
import pytest

from toolaxis.feasibility.violations import FREE
from toolaxis.numeric.vectors import angle_between, rotation, unit
from toolaxis.search.direction_grid import own_frame, spiral
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import task
from toolaxis.search.flank_axes import flank_axes
from toolaxis.search.hemisphere import search
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

TOOL = Tool.torus(6, 1)


def lens(bulge: float = 2.0, twist: float = 0.02) -> np.ndarray:
    """Points of one side of a thin blade that stands along +x."""
    z, x = np.meshgrid(np.linspace(-6, 6, 5), np.linspace(20, 30, 4), indexing="ij")
    return np.dstack([x, bulge * (1 - (z / 6) ** 2) + twist * (x - 20) * z, z])


@pytest.mark.parametrize("tool", [TOOL, Tool.tapered(6, 1, 4), Tool.ball(6)])
def test_one_normal_is_a_degree_or_three_from_the_greatest_angle(tool: Tool) -> None:
    feasibility = task(Face.from_bspline(lens()), tool, 0.1).feasibility
    axes = flank_axes(feasibility)
    assert len(axes) == 4 and np.linalg.norm(axes, axis=1) == pytest.approx(1, abs=1e-12)
    greatest = np.degrees(feasibility.normals.angles(axes)[1])
    assert greatest == pytest.approx(np.tile([89.0, 87.0], 2) - np.degrees(tool.half_angle), abs=1e-6)


def test_they_move_with_the_face() -> None:
    turn = rotation(unit(np.array([1.0, 2, -1])), 0.8)
    still, moved = (flank_axes(task(Face.from_bspline(points), TOOL, 0.1).feasibility)
                    for points in (lens(), lens() @ turn.T + [5.0, -3, 2]))
    for axis in still:
        assert angle_between(moved, turn @ axis).min() < 1e-7


def test_there_are_none_where_no_direction_is_meant(make) -> None:
    x, y = np.meshgrid(np.linspace(0, 40, 4), np.linspace(0, 30, 4), indexing="ij")
    for points in (np.dstack([x, y, 0 * x]), np.dstack([x, y, (x - 20) ** 2 / 18 + (y - 15) ** 2 / 25])):
        assert flank_axes(task(Face.from_bspline(points), TOOL, 0.1).feasibility).shape == (0, 3)


def test_a_search_is_no_worse_than_all_axes_around_the_flank() -> None:
    """They lie a degree apart."""
    job = task(Face.from_bspline(lens()), TOOL, 0.15)
    ledger = AxisTable(job.feasibility, job.worth)
    found = search(ledger)
    middle = own_frame(job.feasibility.normals.samples, flank_axes(job.feasibility)[0])
    around = spiral(middle, radians(1), radians(5))
    free = around[job.feasibility.screen(around).reason == FREE]
    price = job.worth.screen(free).length.min(axis=1)
    best = free[np.argsort(price, kind="stable")[:6]]
    brute = min(job.worth.counted(axis, feed)[1] for axis in best for feed in "uv" if not job.feasibility.witness(axis))
    assert found[0].value <= brute
    assert angle_between(found[0].axis, job.feasibility.normals.mean) > radians(80)
