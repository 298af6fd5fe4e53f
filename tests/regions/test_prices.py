"""Widths of the best feed: against exact strips in many directions, and where there is none."""

import numpy as np
import pytest

from toolaxis.contact.strip.width import strip_width
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import dot, rotation, unit
from toolaxis.regions.cells import FaceCells
from toolaxis.regions.prices import widths
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

SCALLOP = 0.01


def plane() -> Face:
    """40 x 40 mm in z = 0."""
    return Face.from_bspline(np.array([[[0.0, 0, 0], [0, 40, 0]], [[40, 0, 0], [40, 40, 0]]]), (1, 1))


def test_a_ball_on_a_plane_has_the_strip_of_a_circle() -> None:
    cells = FaceCells.of(plane(), 4.0)
    axes = unit([[0.1, 0.0, 1.0], [0.5, 0.5, 1.0], [0.0, 0.0, 1.0], [1.0, 0.0, -0.2]])
    found = widths(cells, [Tool.ball(8), Tool.ball(3)], axes, SCALLOP)
    for number, radius in enumerate((4.0, 1.5)):
        exact = 2 * np.sqrt(2 * radius * SCALLOP - SCALLOP**2)
        assert found[number, :3] == pytest.approx(exact, rel=5e-3)
    assert (found[:, 3] == 0).all()  # from below


def test_widths_are_the_widest_exact_strips(scenes) -> None:
    face, tools = scenes.pocket().faces[0], scenes.rack()
    cells, rng = FaceCells.of(face, 4.0), np.random.default_rng(3)
    axes = unit(np.array([0.0, 0, 1]) + 0.7 * rng.normal(size=(12, 3)) * [1, 1, 0])
    found = widths(cells, tools, axes, SCALLOP)
    turns = np.arange(24) * np.pi / 24
    ratios = []
    for number, tool in enumerate(tools):
        for a, axis in enumerate(axes):
            for n in rng.choice(len(cells), 4):
                left = np.cross(cells.normal[n], cells.tangent[n])
                feeds = np.cos(turns)[:, None] * cells.tangent[n] + np.sin(turns)[:, None] * left
                halves = strip_width(face, tool, np.tile(cells.uv[n], (24, 1)), axis, SCALLOP, feeds)
                exact = np.where((halves > 0).all(axis=1), halves.sum(axis=1), 0).max()
                if exact > 0 and dot(cells.normal[n:n + 1], axis[None])[0] > 0.1:
                    ratios.append(found[number, a, n] / exact)
    assert len(ratios) > 250
    low, middle, high = np.percentile(ratios, [3, 50, 97])
    assert 0.97 < low and abs(middle - 1) < 0.005 and high < 1.03


@pytest.mark.parametrize(("lean", "least"), [(1.0, 0.85), (2.0, 0.94), (5.0, 0.98), (12.0, 0.99)])
def test_near_the_normal_a_flat_bottom_limits_the_strip(scenes, lean: float, least: float) -> None:
    """On a dome, whose curvatures differ by four: the second order alone would give strips of any width there."""
    x = np.array([-20.0, 0.0, 20.0])
    xx, yy = np.meshgrid(x, x, indexing="ij")
    square = np.array([400.0, -400.0, 400.0])
    dome = Face.from_bspline(np.stack([xx, yy, -(square[:, None] / 60 + square / 240)], axis=-1), (2, 2))
    cells, rng = FaceCells.of(dome, 4.0), np.random.default_rng(4)
    turns = np.arange(36) * np.pi / 36
    for tool in scenes.rack()[3:7]:
        for n in rng.choice(len(cells), 12):
            left = np.cross(cells.normal[n], cells.tangent[n])
            way = rng.uniform(0, 2 * np.pi)
            aside = np.cos(way) * cells.tangent[n] + np.sin(way) * left
            axis = np.cos(np.radians(lean)) * cells.normal[n] + np.sin(np.radians(lean)) * aside
            feeds = np.cos(turns)[:, None] * cells.tangent[n] + np.sin(turns)[:, None] * left
            exact = strip_width(dome, tool, np.tile(cells.uv[n], (36, 1)), axis, SCALLOP, feeds).sum(axis=1).max()
            assert least <= widths(cells, [tool], [axis], SCALLOP)[0, 0, n] / exact <= 1.005


def test_a_hollow_tighter_than_the_cutter_has_no_strip() -> None:
    turn, along = np.meshgrid(np.linspace(-0.8, 0.8, 33), np.linspace(0, 30, 5), indexing="ij")
    trough = Face.from_bspline(np.stack([5 * np.sin(turn), along, -5 * np.cos(turn)], axis=-1))
    cells = FaceCells.of(trough, 2.0)
    small, large = widths(cells, [Tool.ball(8), Tool.ball(12)], [[0.0, 0.0, 1.0]], SCALLOP)[:, 0]
    inner = np.abs(cells.point[:, 0]) < 2.5
    assert (small[inner] > 0).all() and (large[inner] == 0).all()
    # Along the trough the strip is that of the difference of the curvatures.
    assert small[inner] == pytest.approx(2 * np.sqrt(2 * SCALLOP / (1 / 4 - 1 / 5)), rel=0.1)


def test_moving_and_scaling(scenes) -> None:
    face, tools = scenes.pocket().faces[0], [Tool.torus(10, 1), Tool.ball(4)]
    axes = unit([[0.2, 0.1, 1.0], [-0.4, 0.3, 1.0]])
    turn = rotation([1.0, -1.0, 0.4], 0.9)
    matrix = np.eye(4)
    matrix[:3, :3] = turn
    one = widths(FaceCells.of(face, 3.0), tools, axes, SCALLOP)
    other = widths(FaceCells.of(face.transformed(matrix), 3.0), tools, axes @ turn.T, SCALLOP)
    assert np.allclose(one, other, rtol=1e-7)
    twice = face.transformed(np.diag([2.0, 2.0, 2.0, 1.0]))
    large = widths(FaceCells.of(twice, 6.0), [Tool.torus(20, 2), Tool.ball(8)], axes, 2 * SCALLOP)
    assert np.allclose(large, 2 * one, rtol=1e-6)


def test_a_scallop_above_a_tool_is_refused(scenes) -> None:
    cells = FaceCells.of(plane(), 4.0)
    with pytest.raises(InvalidInput, match="scallop height"):
        widths(cells, [Tool.ball(8), Tool.ball(2)], [[0.0, 0.0, 1.0]], 1.5)
