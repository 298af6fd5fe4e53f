"""Cells enclose their faces, all of them and nothing that trims cut away."""

import gc

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.numeric.bezier import bezier_nets, derivative_bounds
from toolaxis.shape.bounding.base_cells import grid_lines
from toolaxis.shape.bounding.bounding_tree import cells, forest
from toolaxis.shape.face import Face

RING = np.linspace(0, 2 * np.pi, 90, endpoint=False)


def _circle(u, v, r):
    return np.stack([u + r * np.cos(RING), v + r * np.sin(RING)], axis=1)


def _wavy(degree=(3, 3), count=(7, 6), seed=1, **more):
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(0, 60, count[0]), np.linspace(0, 40, count[1]), indexing="ij")
    return Face.from_bspline(np.stack([x, y, 3 * rng.standard_normal(x.shape)], axis=-1), degree, **more)


def _creased():
    """C0 across u = 0.5."""
    rng = np.random.default_rng(3)
    knots = np.array([0, 0, 0, .5, .5, 1, 1, 1]), np.array([0, 0, 0, 1.0, 1, 1])
    return Face.from_bspline(rng.uniform(-5, 5, (5, 3, 3)) + np.mgrid[:5, :3, :1][:, :, :, 0].transpose(1, 2, 0) * 10,
                             (2, 2), knots)


def _rational():
    """A quarter of a torus-like tube with uneven weights."""
    rng = np.random.default_rng(4)
    net = np.stack(np.meshgrid(np.linspace(0, 30, 4), np.linspace(0, 20, 4), [0.0], indexing="ij"), -1)[:, :, 0]
    return Face.from_bspline(net + rng.uniform(-2, 2, net.shape), (3, 2), weights=rng.uniform(0.5, 2, (4, 4)))


FACES = {
    "wavy": _wavy(),
    "linear": _wavy((1, 1), (2, 2)),
    "high degree": _wavy((6, 5), (7, 6)),
    "creased": _creased(),
    "rational": _rational(),
    "hole": _wavy(trims=(_circle(.5, .5, .45), _circle(.55, .45, .2))),
    "strip": _wavy(trims=(np.array([[.2, .1], [.8, .7], [.78, .72], [.18, .12]]),)),
    "border": _wavy(trims=(np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]),)),
}


def _seen(face, n=120):
    """Parameters all over the face, its loops included."""
    loops = [a + (b - a) * t for loop in face.outline
             for a, b in zip(loop, np.roll(loop, -1, axis=0), strict=True) for t in (0.001, 0.37, 0.8)]
    return np.vstack([face.grid(n, n), loops])


def _node_of(cells_, uv):
    """A leaf whose rectangle holds each parameter, by brute force."""
    leaf = cells_.leaf
    off = np.abs(uv[:, None] - leaf[None, :, :2]) - leaf[None, :, 2:4] * (1 + 1e-7) - 1e-12
    best = off.max(axis=2).argmin(axis=1)
    assert (off.max(axis=2).min(axis=1) <= 0).all()
    return best


@pytest.mark.parametrize("name", FACES)
def test_leaves_enclose_the_face(name):
    face = FACES[name]
    tree = cells(face)
    uv = _seen(face)[::23]
    points = face.evaluate(uv).point
    index = np.concatenate([_node_of(tree, some) for some in np.array_split(uv, 20)])
    rows = np.flatnonzero(tree.link[:, 3] >= 0)[np.argsort(tree.link[tree.link[:, 3] >= 0, 3])]
    shape, share = tree.shape[rows[index]], (uv - tree.leaf[index, :2]) / tree.leaf[index, 2:4]
    d = np.linalg.norm(points - shape[:, :3] - share[:, :1] * shape[:, 3:6] - share[:, 1:] * shape[:, 6:9], axis=1)
    assert (d <= shape[:, 9] * (1 + 1e-9)).all()
    assert (np.linalg.norm(points - shape[:, :3], axis=1) <= shape[:, 10] * (1 + 1e-9)).all()
    curved = np.linalg.norm(points - _second_order(tree, rows[index], share), axis=1)
    assert (curved <= tree.bend[rows[index], 9] * (1 + 1e-9)).all()


def _second_order(tree, rows, share):
    (s, t), shape, bend = share.T[:, :, None], tree.shape[rows], tree.bend[rows]
    return (shape[:, :3] + s * shape[:, 3:6] + t * shape[:, 6:9]
            + (s * s * bend[:, :3] + 2 * s * t * bend[:, 3:6] + t * t * bend[:, 6:9]) / 2)


@pytest.mark.parametrize("name", FACES)
def test_every_node_encloses_what_is_below(name):
    """Walk down at the parameter: on every floor some node holds the point, by its parallelogram and by its ball."""
    face, rng = FACES[name], np.random.default_rng(2)
    tree = cells(face)
    uv = _seen(face, 40)
    for k in rng.choice(len(uv), 60, replace=False):
        point = face.evaluate(uv[k:k + 1]).point[0]
        level = [0]
        while level:
            inside = [n for n in level if _holds(tree.shape[n], point)]
            assert inside
            below = [c for n in inside for c in tree.link[n, :2] if c >= 0]
            level = below if not any(tree.link[n, 3] >= 0 for n in inside) else []


@pytest.mark.parametrize("name", ["wavy", "high degree", "creased", "rational"])
def test_second_order_forms_enclose_every_node(name):
    """Untrimmed nodes are halved at the middle or at a knot: their rectangles follow from those of their leaves."""
    face = FACES[name]
    tree = cells(face)
    low, high = np.full((len(tree.shape), 2), np.inf), np.full((len(tree.shape), 2), -np.inf)
    leaves = np.flatnonzero(tree.link[:, 3] >= 0)
    leaf = tree.leaf[tree.link[leaves, 3]]
    low[leaves], high[leaves] = leaf[:, :2] - leaf[:, 2:4], leaf[:, :2] + leaf[:, 2:4]
    for node in range(len(tree.shape) - 1, -1, -1):
        below = [c for c in tree.link[node, :2] if c >= 0]
        if below:
            low[node], high[node] = low[below].min(axis=0), high[below].max(axis=0)
    rng, tight = np.random.default_rng(8), []
    for node in np.concatenate([np.arange(min(60, len(low))), rng.choice(len(low), 60)]):
        share = rng.uniform(-1, 1, (60, 2))
        points = face.evaluate((low[node] + high[node]) / 2 + share * (high[node] - low[node]) / 2).point
        off = np.linalg.norm(points - _second_order(tree, np.full(60, node), share), axis=1)
        assert off.max() <= tree.bend[node, 9] * (1 + 1e-9)
        tight.append(off.max() / tree.bend[node, 9])
    assert np.median(tight) > 0.05  # and they are not idle
    assert (tree.link[:, 4] == 2).all()


def test_nodes_that_loops_cross_are_not_whole():
    face = FACES["hole"]
    tree = cells(face)
    leaves = np.flatnonzero(tree.link[:, 3] >= 0)
    whole = leaves[tree.link[leaves, 4] == 2]
    cut = np.diff(tree.edge_start)[tree.link[leaves, 3]] > 0
    assert cut.any() and not np.isin(leaves[cut], whole).any()
    leaf = tree.leaf[tree.link[whole, 3]]
    for side in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
        assert face.contains(leaf[:, :2] + np.array(side) * leaf[:, 2:4] * (1 - 1e-6)).all()


def _holds(shape, point):
    q, a, b, e, radius = shape[:3], shape[3:6], shape[6:9], shape[9], shape[10]
    if np.linalg.norm(point - q) > radius * (1 + 1e-9):
        return False
    both = np.stack([a, b], axis=1)
    at = np.linalg.lstsq(both, point - q, rcond=None)[0]
    best = min(np.linalg.norm(point - q - both @ np.clip(at + d, -1, 1)) for d in np.mgrid[-1:2, -1:2].reshape(2, -1).T)
    return best <= e * (1 + 1e-6) + 1e-9 or e >= radius


ALONG_THE_ISO_LINES = {
    "rectangle": [[0, 0], [1, 0], [1, 1], [0, 1]],
    "many edges": [*[[t, 0] for t in np.arange(8) / 8], *[[1, t] for t in np.arange(8) / 8],
                   *[[1 - t, 1] for t in np.arange(8) / 8], *[[0, 1 - t] for t in np.arange(8) / 8]],
    "notch": [[0, 0], [1, 0], [1, .4], [.7, .4], [.7, .6], [1, .6], [1, 1], [0, 1]],
    "angle": [[0, 0], [1, 0], [1, .5], [.5, .5], [.5, 1], [0, 1]],
    "chamfer": [[0, 0], [.9, 0], [1, .1], [1, 1], [0, 1]],
}


@pytest.mark.parametrize("name", ALONG_THE_ISO_LINES)
@pytest.mark.parametrize("origin, size", [(0.1, 0.8), (0.0, 1.0)])
@pytest.mark.parametrize("seed", [11, *(pytest.param(k, marks=pytest.mark.long) for k in (12, 13))])
def test_edges_along_the_iso_lines_hide_nothing(name, origin, size, seed):
    """Loops that run along parameter lines, more or less: rounding must not decide what is inside of a cell."""
    rng = np.random.default_rng(seed)
    for exponent in np.arange(-17.0, -5.0):
        loop = origin + size * np.array(ALONG_THE_ISO_LINES[name], dtype=float)
        loop += 10.0**exponent * rng.standard_normal(loop.shape) * rng.integers(0, 2, loop.shape)
        face = _wavy(trims=(np.clip(loop, 0, 1),))
        leaf, uv = cells(face).leaf, face.grid(40, 40)
        off = np.abs(uv[:, None] - leaf[None, :, :2]) - leaf[None, :, 2:4]
        assert off.max(axis=2).min(axis=1).max() < 1e-7, exponent


def test_holes_are_left_out():
    face = FACES["hole"]
    tree = cells(face)
    middle = tree.leaf[:, :2]
    size = np.hypot(*tree.leaf[:, 2:4].T)
    deep = np.hypot(middle[:, 0] - .55, middle[:, 1] - .45) < 0.2 - size
    assert not deep.any()
    assert not (np.hypot(middle[:, 0] - .5, middle[:, 1] - .5) > 0.45 + size).any()
    area = 4 * np.prod(tree.leaf[:, 2:4], axis=1).sum()
    assert area == pytest.approx(np.pi * (.45**2 - .2**2), rel=0.05)


def test_border_loops_cost_nothing():
    whole, bordered = cells(FACES["wavy"]), cells(FACES["border"])
    assert len(bordered.edges) == 0
    assert bordered.shape == pytest.approx(whole.shape, abs=1e-9)


@pytest.mark.parametrize("name", ["wavy", "high degree", "creased", "rational"])
def test_second_derivative_bounds(name):
    face = FACES[name]
    data, (u, v) = face.surface.data, face.surface.domain
    lines = grid_lines(data[0], data[3], *u), grid_lines(data[1], data[4], *v)
    bounds = derivative_bounds(bezier_nets(data, *lines), np.diff(lines[0]), np.diff(lines[1]), 2)
    rng, ratio = np.random.default_rng(5), np.zeros(3)
    for _ in range(20):
        i, j = rng.integers(len(lines[0]) - 1), rng.integers(len(lines[1]) - 1)
        t = rng.uniform(1e-9, 1 - 1e-9, (200, 2))
        d = face.evaluate(np.stack([lines[0][i], lines[1][j]]) + t * [np.diff(lines[0])[i], np.diff(lines[1])[j]])
        seen = [np.linalg.norm(x, axis=1).max() for x in (d.suu, d.suv, d.svv)]
        assert (seen <= bounds[i, j] * (1 + 1e-9)).all()
        ratio = np.maximum(ratio, seen / np.maximum(bounds[i, j], 1e-300))
    assert (ratio > 0.4).all()  # and they are not idle


@pytest.mark.parametrize("name", ["wavy", "high degree", "rational"])
def test_third_derivative_bounds(name):
    """Differences of second derivatives are means of third ones."""
    face = FACES[name]
    data, (u, v) = face.surface.data, face.surface.domain
    lines = grid_lines(data[0], data[3], *u), grid_lines(data[1], data[4], *v)
    bounds = derivative_bounds(bezier_nets(data, *lines), np.diff(lines[0]), np.diff(lines[1]), 3)
    rng, ratio, step = np.random.default_rng(6), np.zeros(4), 1e-4
    for _ in range(30):
        i, j = rng.integers(len(lines[0]) - 1), rng.integers(len(lines[1]) - 1)
        width = np.array([np.diff(lines[0])[i], np.diff(lines[1])[j]])
        uv = np.array([lines[0][i], lines[1][j]]) + rng.uniform(0.001, 0.999, (100, 2)) * width
        here, right, up = (face.evaluate(uv + np.array(d) * step * width) for d in ((0, 0), (1, 0), (0, 1)))
        du, dv = step * width
        seen = [np.linalg.norm(x, axis=1).max() for x in ((right.suu - here.suu) / du, (up.suu - here.suu) / dv,
                                                          (up.suv - here.suv) / dv, (up.svv - here.svv) / dv)]
        assert (seen <= bounds[i, j] * (1 + 1e-5) + 1e-6).all()
        ratio = np.maximum(ratio, seen / np.maximum(bounds[i, j], 1e-300))
    assert (ratio > 0.2).all()


def test_forest_holds_every_face():
    faces = list(FACES.values())
    both = forest(faces)
    assert len(both.faces) == len(faces)
    assert sorted(set(both.link[:, 2])) == list(range(-1, len(faces)))
    reached, level = 0, [0]
    while level:
        reached += len(level)
        level = [c for n in level for c in both.link[n, :2] if c >= 0]
    assert reached == len(both.shape)
    roots = [np.flatnonzero(both.link[:, 2] == k)[0] for k in range(len(faces))]
    for root in roots:
        gap = np.linalg.norm(both.shape[root, :3] - both.shape[0, :3])
        assert gap + both.shape[root, 10] <= both.shape[0, 10] * (1 + 1e-9)


def test_kept_while_the_face_lives():
    face = _wavy(seed=9)
    assert cells(face).nodes is cells(face).nodes
    from toolaxis.shape.bounding import bounding_tree as module
    count = len(module._known)
    del face
    gc.collect()
    assert len(module._known) < count


def test_bad_input():
    with pytest.raises(InvalidInput, match="trim loop 0 of face 1 leaves the surface"):
        cells(_wavy(trims=(_circle(3, 3, .4),)))
    with pytest.raises(InvalidInput, match="at least one"):
        forest([])
