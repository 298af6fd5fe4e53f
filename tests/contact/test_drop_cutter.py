"""Tool tips against opencamlib: a cutter dropped along its axis on the part's mesh comes to rest where we place it."""

import numpy as np
import pytest

from toolaxis.contact.clearance.gouge import gouge
from toolaxis.contact.placement import place
from toolaxis.numeric.vectors import perpendicular, unit
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

ocl = pytest.importorskip("opencamlib")

SIDE = 90


def _net(height):
    x, y = np.meshgrid(np.linspace(-20, 20, 6), np.linspace(-20, 20, 6), indexing="ij")
    return np.stack([x, y, height(x, y)], axis=-1)


FACES = {
    "wavy": Face.from_bspline(_net(lambda x, y: 1.5 * np.sin(x / 7) * np.cos(y / 9))),
    "saddle": Face.from_bspline(_net(lambda x, y: (x**2 - y**2) / 120)),
    "bowl": Face.from_bspline(_net(lambda x, y: (x**2 + y**2) / 110), weights=1 + 0.3 * np.eye(6)),
}
TOOLS = {
    "ball": (Tool.ball(8), lambda: ocl.BallCutter(8, 60)),
    "bull": (Tool.torus(12, 2), lambda: ocl.BullCutter(12, 2, 60)),
    "flat": (Tool.flat(10), lambda: ocl.CylCutter(10, 60)),
}


def _mesh(face, frame):
    """Triangles of the face in the tool's frame, and how far they stand off it at the most."""
    t = np.linspace(0, 1, SIDE + 1)
    uv = np.stack(np.meshgrid(t, t, indexing="ij"), axis=-1)
    p = (face.evaluate(uv.reshape(-1, 2)).point @ frame.T).reshape(SIDE + 1, SIDE + 1, 3)
    middle = (uv[:-1, :-1] + uv[1:, 1:]) / 2
    exact = (face.evaluate(middle.reshape(-1, 2)).point @ frame.T).reshape(SIDE, SIDE, 3)
    sag = np.abs(exact - (p[:-1, :-1] + p[1:, 1:]) / 2).max()
    low, a, b, high = p[:-1, :-1], p[1:, :-1], p[:-1, 1:], p[1:, 1:]
    halves = np.stack([low, a, high], axis=2), np.stack([low, high, b], axis=2)
    return np.concatenate([half.reshape(-1, 3, 3) for half in halves]), sag


def _dropped(triangles, cutter, xy):
    surface = ocl.STLSurf()
    for triangle in triangles:
        surface.addTriangle(ocl.Triangle(*(ocl.Point(*map(float, corner)) for corner in triangle)))
    drop = ocl.BatchDropCutter()
    drop.setSTL(surface)
    drop.setCutter(cutter)  # not a temporary: opencamlib keeps a bare pointer
    for x, y in xy:
        drop.appendPoint(ocl.CLPoint(float(x), float(y), -100.0))
    drop.run()
    return np.array([point.z for point in drop.getCLPoints()])


@pytest.mark.parametrize("tool", TOOLS)
@pytest.mark.parametrize("name", FACES)
def test_tips_rest_on_the_mesh(name, tool):
    face, (ours, make) = FACES[name], TOOLS[tool]
    axis = unit([0.25, -0.15, 1.0])
    frame = np.array([*perpendicular(axis), axis])
    uv = np.random.default_rng(3).uniform(0.2, 0.8, (70, 2))
    tips = place(face, ours, uv, axis) @ frame.T
    triangles, sag = _mesh(face, frame)
    cutter = make()
    rest = _dropped(triangles, cutter, tips[:, :2])
    deep = gouge(face, ours, uv, axis)
    free = deep < 0.0005
    slope = (face.normal(uv) @ axis).min()
    assert free.sum() > 15
    assert np.abs(rest - tips[:, 2])[free].max() < (2 * sag + 0.0005) / slope
    assert (rest > tips[:, 2] - (2 * sag + 0.0005) / slope).all()
    lifted = rest - tips[:, 2]
    assert (lifted[deep > 0.02] > 0.01).all()  # what we call a gouge, the mesh pushes up
    assert (deep[lifted > 0.02] > 0.002).all()
