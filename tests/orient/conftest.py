"""Small faces, and a floor with a wall, that the tests of orientation share."""

from types import SimpleNamespace

import numpy as np
import pytest

from toolaxis.shape.adjacency import Edge
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part


def patch(heights, size=15.0, **more):
    z = np.asarray(heights, dtype=float)
    x, y = np.meshgrid(np.linspace(-size, size, z.shape[0]), np.linspace(-size, size, z.shape[1]), indexing="ij")
    return Face.from_bspline(np.stack([x, y, z], axis=-1), **more)


def saddle(height=2.0, size=15.0):
    """z = (x^2 - y^2) height / size^2, exactly: four mirror images."""
    s, h = size, height
    x = np.array([-s, 0, s])
    square = np.array([s * s, -s * s, s * s])
    z = (square[:, None] - square[None]) * h / s**2
    xx, yy = np.meshgrid(x, x, indexing="ij")
    return Face.from_bspline(np.stack([xx, yy, z], axis=-1), degree=(2, 2))


def seeded(seed, height=0.8, **more):
    return patch(height * np.random.default_rng(seed).normal(size=(5, 5)), **more)


def bowl(radius, size=15.0):
    """A patch of a paraboloid with a given radius of curvature at its bottom, material below."""
    x = np.array([-size, 0, size])
    square = np.array([size**2, -(size**2), size**2])
    xx, yy = np.meshgrid(x, x, indexing="ij")
    z = (square[:, None] + square[None]) / (2 * radius)
    return Face.from_bspline(np.stack([xx, yy, z], axis=-1), degree=(2, 2))


def flat(corner, a, b):
    p, a, b = (np.asarray(v, dtype=float) for v in (corner, a, b))
    return Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


def floor_and_wall(height=25.0, size=15.0):
    """A gently curved floor with straight borders (face 1), a wall along +y (2) and a side below -y (3)."""
    z = np.zeros((5, 5))
    z[1:-1, 1:-1] = [[0.6, 0.3, -0.2], [0.2, 0.5, 0.3], [-0.3, 0.1, 0.4]]
    s = size
    wall = flat([-s, s, 0], [2 * s, 0, 0], [0, 0, height])
    side = flat([-s, -s, -height], [2 * s, 0, 0], [0, 0, height])
    edges = [Edge((1, 2), "concave", np.array([[-s, s, 0], [s, s, 0.0]])),
             Edge((1, 3), "convex", np.array([[-s, -s, 0], [s, -s, 0.0]]))]
    return Part.from_faces([patch(z, s), wall, side], edges)


def slot(height=25.0, size=15.0):
    """The same floor (face 1) between two walls, along +y (2) and along -y (3)."""
    s = size
    floor, wall, _ = floor_and_wall(height, size).faces
    edges = [Edge((1, k), "concave", np.array([[-s, y, 0], [s, y, 0.0]])) for k, y in ((2, s), (3, -s))]
    return Part.from_faces([floor, wall, flat([-s, -s, 0], [0, 0, height], [2 * s, 0, 0])], edges)


@pytest.fixture(scope="session")
def make():
    """Makers of faces: patch, saddle, seeded, bowl, flat, floor_and_wall, slot."""
    return SimpleNamespace(patch=patch, saddle=saddle, seeded=seeded, bowl=bowl, flat=flat,
                           floor_and_wall=floor_and_wall, slot=slot)
