"""Pictures without a display: what is in front hides what is behind."""

import numpy as np
import pytest

from toolaxis.report.figures.splat_renderer import (
    Canvas,
    camera,
    face_splats,
    mean_direction,
    splats_of_revolution,
    tool_outlines,
    visible_runs,
)
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

RED, BLUE = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


def square(height: float, size: float = 10.0) -> Face:
    x, y = np.meshgrid(np.linspace(0, size, 4), np.linspace(0, size, 4), indexing="ij")
    return Face.from_bspline(np.stack([x, y, np.full_like(x, height)], axis=-1))


def corners(face: Face) -> np.ndarray:
    return face.evaluate(face.outline[0]).point


def test_a_face_fills_its_outline_without_gaps() -> None:
    face = square(0.0)
    canvas = Canvas(camera([0, 0, 1], [0, 1, 0], corners(face), pixels=300))
    canvas.splat(*face_splats(face, canvas.camera), BLUE)
    canvas.close()
    drawn = np.isfinite(canvas.depth)
    rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
    inside = drawn[rows[1]:rows[-1], columns[1]:columns[-1]]
    assert inside.all()
    assert drawn.sum() * canvas.camera.pixel**2 == pytest.approx(100.0, rel=0.02)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_the_nearer_face_wins_in_either_order(order: tuple[int, int]) -> None:
    faces, colours = (square(0.0), square(3.0, 5.0)), (RED, BLUE)
    canvas = Canvas(camera([0, 0, 1], [0, 1, 0], corners(faces[0]), pixels=200))
    for k in order:
        canvas.splat(*face_splats(faces[k], canvas.camera), colours[k])
    row, column = ((np.array([2.5, 2.5]) - canvas.camera.low) / canvas.camera.pixel).astype(int)[::-1]
    assert canvas.colour[row, column, 2] > 0.4 and canvas.colour[row, column, 0] == 0.0
    row, column = ((np.array([7.5, 7.5]) - canvas.camera.low) / canvas.camera.pixel).astype(int)[::-1]
    assert canvas.colour[row, column, 0] > 0.4 and canvas.colour[row, column, 2] == 0.0


def test_lines_behind_a_face_are_hidden() -> None:
    face = square(0.0)
    canvas = Canvas(camera([0, 0, 1], [0, 1, 0], corners(face), pixels=200))
    canvas.splat(*face_splats(face, canvas.camera), RED)
    above, below = np.array([[1.0, 5, 1], [9, 5, 1]]), np.array([[1.0, 5, -1], [9, 5, -1]])
    assert len(visible_runs(canvas, above, 0.1)) == 1
    assert visible_runs(canvas, below, 0.1) == []
    through = visible_runs(canvas, np.array([[1.0, 5, -4], [9, 5, 4]]), 0.0)
    assert len(through) == 1
    assert through[0][:, 0].min() == pytest.approx(5.0, abs=0.2) and through[0][:, 0].max() == pytest.approx(9.0)


def test_the_camera_sees_all_points_and_keeps_lengths() -> None:
    rng = np.random.default_rng(5)
    points = rng.normal(size=(100, 3)) * 20
    seen = camera(rng.normal(size=3), rng.normal(size=3), points)
    flat = seen.project(points)
    left, right, low, high = seen.extent
    assert (flat[:, 0] > left).all() and (flat[:, 0] < right).all()
    assert (flat[:, 1] > low).all() and (flat[:, 1] < high).all()
    assert np.allclose(np.linalg.norm(flat, axis=1), np.linalg.norm(points, axis=1))


def test_a_camera_along_its_up_direction_still_sees() -> None:
    seen = camera([0, 0, 1], [0, 0, 1], np.eye(3))
    assert np.isfinite(seen.project(np.eye(3))).all()


def test_a_solid_of_revolution_lies_on_its_outline() -> None:
    axis = np.array([0.0, 0.6, 0.8])
    outline = np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 20.0], [8.0, 20.0]])
    points, directions = splats_of_revolution(outline, np.array([1.0, 2, 3]), axis, 0.5)
    rows = points - [1, 2, 3]
    z = rows @ axis
    radius = np.linalg.norm(rows - z[:, None] * axis, axis=1)
    on_side = np.isclose(radius, 5.0) & (z > -1e-9) & (z < 20 + 1e-9)
    on_ends = (np.isclose(z, 0.0, atol=1e-9) & (radius < 5 + 1e-9)) | (np.isclose(z, 20.0) & (radius > 5 - 1e-9))
    assert (on_side | on_ends).all() and on_side.any() and on_ends.any()
    assert np.allclose(np.linalg.norm(directions, axis=1), 1.0)


def test_outlines_name_what_is_known() -> None:
    assert set(tool_outlines(Tool.ball(8), 40.0)) == {"cutter", "shank (not given)"}
    full = Tool.torus(12, 1, stickout=60, shank=[(6, 0), (6, 60)], holder=[(10, 0), (10, 40)])
    assert set(tool_outlines(full, 40.0)) == {"cutter", "shank", "holder"}


def test_mean_direction() -> None:
    assert np.allclose(mean_direction(np.array([[1.0, 0, 0], [0, 1, 0]])), [0.5**0.5, 0.5**0.5, 0])
    assert np.allclose(mean_direction(np.array([[1.0, 0, 0], [-1, 0, 0]])), [1, 0, 0])
