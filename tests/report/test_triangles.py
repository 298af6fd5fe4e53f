"""Triangles of faces keep within their bound, cover the face once, and look out of the material."""

import numpy as np
import pytest

from toolaxis.report.figures.tessellation import triangles
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest


def bump(trims: tuple[np.ndarray, ...] = (), flip: bool = False) -> Face:
    x, y = np.meshgrid(np.linspace(0, 40, 7), np.linspace(0, 30, 7), indexing="ij")
    return Face.from_bspline(np.stack([x, y, 4 * np.sin(x / 9) * np.cos(y / 7)], axis=-1), trims=trims, flip=flip)


def barrel() -> Face:
    """A whole cylinder of radius 10 and height 20, its loop along the seam and round both ends."""
    w = np.sqrt(0.5)
    ring = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]]) * 10.0
    net = np.array([[[*row, z] for z in (0.0, 20.0)] for row in ring])
    knots = [0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1]
    weights = np.repeat(np.array([1, w, 1, w, 1, w, 1, w, 1])[:, None], 2, axis=1)
    loop = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    return Face.from_bspline(net, (2, 1), (knots, [0, 0, 1, 1]), weights, trims=(loop,))


def hole() -> np.ndarray:
    t = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    return np.stack([0.5 + 0.2 * np.cos(t), 0.5 - 0.25 * np.sin(t)], axis=1)


def corner(trims: tuple[np.ndarray, ...] = ()) -> Face:
    """Two walls of a pocket, joined by a corner of 4 mm that is a thirtieth of their length."""
    plan = np.array([[0.0, 0.0], [68.0, 0.0], [136.0, 0.0], [140.0, 0.0], [140.0, 4.0], [140.0, 38.0], [140.0, 72.0]])
    net = np.array([[[*place, z] for z in (0.0, 6.0)] for place in plan])
    weights = np.repeat(np.array([1, 1, 1, np.sqrt(0.5), 1, 1, 1])[:, None], 2, axis=1)
    knots = [0, 0, 0, 136, 136, 142.3, 142.3, 210.3, 210.3, 210.3]
    return Face.from_bspline(net, (2, 1), (knots, [0, 0, 1, 1]), weights, trims=trims)


OUTER = np.array([[0.05, 0.02], [0.97, 0.1], [0.9, 0.95], [0.4, 0.85], [0.1, 0.9]])


def test_a_corner_that_is_short_beside_its_walls_is_not_cut() -> None:
    """Found: a sub-surface of pocket walls was drawn across the floor, 18 mm off."""
    strip = np.array([[1.0, 0.4], [209.0, 0.4], [209.0, 0.8], [1.0, 0.8]])
    for face in (corner(), corner((strip,))):
        made = triangles(face, 0.3)
        assert 0 < made.off < 0.3 and len(made.corners) < 400


@pytest.mark.parametrize("face", [bump(), bump((OUTER,)), bump((OUTER, hole())), bump(flip=True), barrel()],
                         ids=["whole", "trimmed", "hole", "flipped", "seam"])
@pytest.mark.parametrize("bound", [0.2, 0.02])
def test_they_keep_within_the_bound_and_cover_the_face(face: Face, bound: float) -> None:
    made = triangles(face, bound)
    corner = made.points[made.corners]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    area = 0.5 * np.linalg.norm(normal, axis=1)
    assert made.off <= 1.5 * bound
    assert area.sum() == pytest.approx(face.area, rel=0.01 if bound > 0.1 else 2e-3)
    assert (area > 0).all()
    shares = np.random.default_rng(3).dirichlet([1, 1, 1], len(corner))
    inside = (shares[:, :, None] * corner).sum(axis=1)
    found = nearest(face, inside)
    assert found.distance.max() <= 1.5 * bound
    out = (normal / np.linalg.norm(normal, axis=1, keepdims=True) * face.normal(found.uv)).sum(axis=1)
    assert np.quantile(out, 0.02) > 0.9


def test_a_smaller_bound_takes_more_triangles() -> None:
    counts = [len(triangles(bump(), bound).corners) for bound in (0.4, 0.1, 0.025)]
    assert counts[0] < counts[1] < counts[2] and counts[2] / counts[1] == pytest.approx(4, rel=0.5)
