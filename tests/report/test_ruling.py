"""Hatch lines on faces: on a plane they are straight, as far apart as asked for, and inside the outline."""

import numpy as np
import pytest

from toolaxis.report.figures.hatch_lines import hatch_lines
from toolaxis.shape.face import Face

LOOP = np.array([[0.1, 0.1], [0.9, 0.1], [0.9, 0.8], [0.5, 0.3], [0.1, 0.8]])


def flat() -> Face:
    x, y = np.meshgrid(np.linspace(0, 40, 4), np.linspace(0, 20, 4), indexing="ij")
    return Face.from_bspline(np.dstack([x, y, 0 * x]), trims=(LOOP,))


def test_lines_lie_in_the_face_and_at_their_height() -> None:
    face = flat()
    outline, *lines = hatch_lines(face, 1.0, 0.25)
    assert outline[0] == pytest.approx(outline[-1])
    for line in (outline, *lines):
        assert line[:, 2] == pytest.approx(0.25)
    for line in lines:
        assert face.contains(line[1:-1, :2] / [40.0, 20.0]).all()
        assert np.ptp(line[:, 0] - line[:, 1]) == pytest.approx(0.0, abs=1e-9) or np.ptp(
            line[:, 0] + line[:, 1]) == pytest.approx(0.0, abs=1e-9)


def test_lines_have_the_pitch_and_cover_the_area() -> None:
    """Length times pitch is about the area."""
    face = flat()
    lines = hatch_lines(face, 0.25)[1:]
    length = sum(np.linalg.norm(line[-1] - line[0]) for line in lines)
    assert 0.25 * length == pytest.approx(face.area, rel=0.02)


def test_a_sliver_without_grid_points_has_its_outline() -> None:
    face = flat().trimmed((np.array([[0.2, 0.2], [0.8, 0.2], [0.8, 0.2004]]),))
    found = hatch_lines(face, 1.0)
    assert found and np.ptp(found[0][:, 0]) == pytest.approx(24.0, rel=1e-3)
