"""Sample points: on the face, tiles, tolerance, and the same wherever the face lies."""

import numpy as np
import pytest

from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.path.sampling import sample_points
from toolaxis.shape.differential import curvatures, normals
from toolaxis.tools.tool import Tool

TOOL = Tool.torus(12, 1)


def test_patches_tile_the_range_of_an_untrimmed_face(make):
    samples = sample_points(make["wavy"](1), TOOL, 0.05)
    r = samples.rectangles
    assert ((r[:, 1] - r[:, 0]) * (r[:, 3] - r[:, 2])).sum() == pytest.approx(1.0, abs=1e-12)
    assert np.allclose(samples.extents, r, atol=1e-12)


def test_every_point_of_the_face_resembles_its_sample(make):
    face = make["wavy"](2)
    samples = sample_points(face, TOOL, 0.05)
    uv = face.grid(31, 29)

    def features(rows):
        d = face.evaluate(rows)
        n = normals(d)
        k = curvatures(d, n)
        return d.point / face.diagonal, n, TOOL.radius * np.column_stack([k.k1, k.k2])

    owner = samples.owner(uv)
    apart = sum(np.linalg.norm(a - b[owner], axis=1) / 3
                for a, b in zip(features(uv), features(samples.uv), strict=True))
    assert apart.max() < 0.05 * 1.25, "a sample is the mean in the parameters, not in the features: a quarter more"


def test_samples_of_a_trimmed_face_lie_on_it_and_reach_no_farther(make):
    face = make["holed"](make["wavy"](1))
    samples = sample_points(face, TOOL, 0.05)
    assert face.contains(samples.uv).all()
    assert samples.extents[:, 0].min() == pytest.approx(0.05, abs=0.012)
    assert samples.extents[:, 1].max() == pytest.approx(0.95, abs=0.012)
    assert (samples.extents[:, 0] >= samples.rectangles[:, 0] - 1e-12).all()


def test_moving_the_face_moves_no_sample(make):
    face = make["wavy"](3)
    turn = np.eye(4)
    turn[:3, :3] = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    turn[:3, 3] = 100, -20, 7
    one, two = sample_points(face, TOOL), sample_points(face.transformed(turn), TOOL)
    # the box diagonal is that of an upright box: a turned face has another one, so only the points' spread may change
    shift = np.eye(4)
    shift[:3, 3] = 100, -20, 7
    assert np.allclose(sample_points(face.transformed(shift), TOOL).uv, one.uv, atol=1e-9)
    assert 0.5 < len(two) / len(one) < 2


def test_a_plane_is_cut_by_location_alone(make):
    samples = sample_points(make["flat"](30, 20), TOOL, 0.1)
    assert 2 <= len(samples) <= 8


@pytest.mark.parametrize("bad", [{"tolerance": 0.0}, {"tolerance": float("nan")}, {"weights": (0, 0, 0)},
                                 {"weights": (1, -1, 1)}])
def test_bad_arguments(make, bad):
    with pytest.raises(InvalidInput):
        sample_points(make["wavy"](1), TOOL, **bad)


def test_a_face_of_next_to_nothing_is_refused(make):
    loops = (np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]), np.array([[1e-12, 0], [1, 0], [1, 1], [1e-12, 1.0]]))
    with pytest.raises(UnsupportedGeometry, match="no point"):
        sample_points(make["wavy"](1).trimmed(loops), TOOL)
