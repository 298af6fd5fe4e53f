"""Folds of vanishing size have the normals around them; whatever a cutter could meet keeps its own."""

from collections.abc import Callable

import numpy as np
import pytest

from toolaxis.numeric.vectors import angle_between, rotation
from toolaxis.shape.analytic import CylindricalSurface, SphericalSurface
from toolaxis.shape.differential import normals
from toolaxis.shape.face import Face
from toolaxis.shape.folds import FLAT, REACH

#: How far the control points of a fold run back from one to the next, mm; found on a mouse cover.
BACK = 5e-5
STRAIGHT, RISING, CURVED = (lambda x: 0.0 * x), (lambda x: 0.4 * x), (lambda x: 8.0 * np.sin(x / 15.0))


def extruded(curve: np.ndarray, degree: int = 3, weights: np.ndarray | None = None) -> Face:
    """The face over a curve in x and z, 10 mm long in y, with its normals on the left of the curve."""
    low = np.column_stack([curve[:, 0], np.zeros(len(curve)), curve[:, 1]])
    net = np.stack([low, low + np.array([0.0, 10.0, 0.0])], axis=1)
    return Face.from_bspline(net, (degree, 1), weights=weights)


def running_back(height: Callable[[np.ndarray], np.ndarray], back: float = BACK, weighted: bool = False) -> Face:
    """A face whose control points run back five times in the middle, at x = 30."""
    x = np.concatenate([np.linspace(0.0, 30.0, 7), 30.0 - back * np.arange(1, 6), np.linspace(35.0, 60.0, 6)])
    weights = np.random.default_rng(4).uniform(0.7, 1.4, (len(x), 1)) * [[1.0, 0.8]] if weighted else None
    return extruded(np.column_stack([x, height(x)]), weights=weights)


def with_corners(*corners: tuple[float, float]) -> Face:
    """A cubic face with sharp corners."""
    return extruded(np.repeat(np.array(corners), 3, axis=0))


def across(face: Face) -> np.ndarray:
    """Parameters along u, ever closer to the ends and to where the surface runs slowly."""
    (low, high), _ = face.surface.domain
    even = np.linspace(low, high, 2001)
    speed = np.linalg.norm(face.evaluate(np.column_stack([even, np.full(len(even), 0.37)])).su, axis=1)
    slow = even[1:-1][(speed[1:-1] < 0.999 * speed[:-2]) & (speed[1:-1] <= speed[2:])
                      | (speed[1:-1] <= speed[:-2]) & (speed[1:-1] < 0.999 * speed[2:])]
    near = [0.0, *(s * 10.0**-k for k in range(3, 12) for s in (-1.0, -0.3, 0.3, 1.0))]
    places = np.concatenate([[low], slow, [high]])[:, None] + (high - low) * np.array(near)
    u = np.concatenate([even, np.clip(places, low, high).ravel()])
    return np.column_stack([u, np.full(len(u), 0.37)])


def own_normals(face: Face, uv: np.ndarray) -> np.ndarray:
    """What the derivatives alone give."""
    return normals(face.evaluate(uv), face.flip, face.surface.inward(uv))


def has_own_normal(face: Face, uv: np.ndarray) -> np.ndarray:
    """Where the derivatives tell a normal: not on a border along which the surface stands still to the second order."""
    (low, high), _ = face.surface.domain
    d = face.evaluate(uv)
    still = np.maximum(np.linalg.norm(d.su, axis=1), np.linalg.norm(d.suu, axis=1)) < 1e-9
    return ~(still & np.isin(uv[:, 0], (low, high)))


def off_the_slope(face: Face, normal: np.ndarray, uv: np.ndarray, height: Callable[[np.ndarray], np.ndarray]) -> float:
    """Greatest angle between normals and those of the curve that the control points follow, deg."""
    x = face.evaluate(uv).point[:, 0]
    rise = (height(x + 1e-4) - height(x - 1e-4)) / 2e-4
    wanted = np.column_stack([-rise, 0.0 * x, 1.0 + 0.0 * x]) / np.hypot(1.0, rise)[:, None]
    return float(np.degrees(angle_between(normal, wanted).max()))


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("back", [1e-8, BACK, 4e-4])
@pytest.mark.parametrize("height, most", [(STRAIGHT, 1e-4), (RISING, 1e-3), (CURVED, 30.0)])
def test_a_fold_has_the_normals_around_it(height: Callable, most: float, back: float, weighted: bool) -> None:
    """On a curve the bunch of control points is a corner as well, at which normals turn by up to nine degrees."""
    face = running_back(height, back, weighted)
    uv = across(face)
    assert off_the_slope(face, own_normals(face, uv), uv, height) > 150.0
    assert off_the_slope(face, face.normal(uv), uv, height) < most


def test_normals_follow_motion_mirror_swap_and_flip() -> None:
    face = running_back(RISING)
    uv = across(face)
    normal = face.normal(uv)
    turn = np.eye(4)
    turn[:3, :3], turn[:3, 3] = rotation([1, 2, 3], 0.9), [10, -70, 400]
    assert face.transformed(turn).normal(uv) == pytest.approx(normal @ turn[:3, :3].T, abs=1e-6)
    assert face.transformed(np.diag([-1.0, 1, 1, 1])).normal(uv) == pytest.approx(normal * [-1, 1, 1], abs=1e-6)
    assert Face(face.surface.swapped(), flip=True).normal(uv[:, ::-1]) == pytest.approx(normal, abs=1e-6)
    assert Face(face.surface, flip=True).normal(uv) == pytest.approx(-normal, abs=0.0)


@pytest.mark.parametrize("end", [0, 1])
def test_a_fold_at_the_border_has_the_normals_beside_it(end: int) -> None:
    x = np.concatenate([[2 * BACK, BACK, 0.0], np.linspace(5.0, 60.0, 12)])
    face = extruded(np.column_stack([-x[::-1] if end else x, 0.0 * x]))
    uv = across(face)
    assert own_normals(face, uv)[:, 2].min() == pytest.approx(-1.0)
    assert face.normal(uv) == pytest.approx(np.tile([0.0, 0.0, 1.0], (len(uv), 1)), abs=1e-9)


def test_only_normals_in_the_fold_change() -> None:
    face = running_back(CURVED)
    uv = across(face)
    changed = (face.normal(uv) != own_normals(face, uv)).any(axis=1)
    assert changed.sum() > 300
    assert np.abs(face.evaluate(uv[changed]).point[:, 0] - 30.0).max() < 2 * REACH


def test_curvature_in_a_fold_is_that_beside_it() -> None:
    face = running_back(RISING)
    uv = across(face)
    aside = face.outside_folds(uv)
    moved = (aside != uv).any(axis=1)
    assert moved.sum() > 300
    apart = np.linalg.norm(face.evaluate(aside).point - face.evaluate(uv).point, axis=1)
    assert REACH <= apart[moved].min() and apart.max() <= 1.5 * REACH
    bent = face.curvature(uv[moved])
    assert np.abs([bent.k1, bent.k2]).max() < 1e-3


OVERLAP = (0.0, 0.0), (30.0, 0.0), (29.0, 0.0), (60.0, 0.0)
KEPT = {
    "overlap of 1 mm": lambda: with_corners(*OVERLAP),
    "overlap of 0.05 mm": lambda: with_corners((0, 0), (30, 0), (29.95, 0), (60, 0)),
    "overlap of 1 mm with round ends": lambda: extruded(np.column_stack(
        [[0, 10, 20, 30, 30, 30, 29.5, 29, 29, 29, 40, 50, 60], np.zeros(13)])),
    "overlap between kinks": lambda: extruded(np.array(OVERLAP), 1),
    "wall of no thickness": lambda: extruded(np.array([(0, 0), (10, 0), (20, 0), (20, 0), (10, 0), (0, 0)])),
    "wall of 0.02 mm": lambda: extruded(np.array([(0, 0), (10, 0), (20, 0), (20, -.02), (10, -.02), (0, -.02)])),
    "wall of 0.0006 mm": lambda: with_corners((0, 0), (20, 0), (20, -0.0006), (0, -0.0006)),
    "wall that begins behind its edge": lambda: with_corners((0.008, -0.002), (0, -0.002), (0, 0), (60, 0)),
    "knife edge of 2 degrees": lambda: with_corners((0, 0), (20, 0), (0, -0.7)),
    "cusp": lambda: extruded(np.array([(0, 0), (10, 0), (10, 0), (0, 5)])),
    "slit 0.0002 mm wide": lambda: with_corners((0, 0), (30, 0), (30, -1), (30.0002, -1), (30.0002, 0), (60, 0)),
    "fin 0.0002 mm wide": lambda: with_corners((0, 0), (30, 0), (30, 1), (30.0002, 1), (30.0002, 0), (60, 0)),
    "groove 0.002 mm deep": lambda: with_corners((0, 0), (30, 0), (30.001, -0.002), (30.002, 0), (60, 0)),
    "rib 0.003 mm high": lambda: with_corners((0, 0), (30, 0), (30, .003), (30.003, .003), (30.003, 0), (60, 0)),
    "undercut 0.005 mm deep": lambda: with_corners((0, 0), (30, 0), (29.995, -0.002), (60, -0.002)),
    "head on a narrow neck": lambda: with_corners((0, 0), (30, 0), (30, 1), (25, 2), (30, 3), (35, 2), (30.002, 1),
                                                  (30.002, 0), (60, 0)),
    "roof": lambda: extruded(np.array([(0, 0), (10, 10), (20, 0)]), 1),
    "kink that turns over": lambda: extruded(np.array([(0, 0), (20, 0), (5, 0)]), 1),
    "saw": lambda: extruded(np.array([(0.005 * k, 0.002 * (-1) ** k) for k in range(40)]), 1),
    "wire as thick as the way beside": lambda: Face(CylindricalSurface(0.5001 * REACH, (0.0, 1.0)).nurbs()),
    "wire thinner than that": lambda: Face(CylindricalSurface(0.2 * REACH, (0.0, 1.0)).nurbs()),
    "poles": lambda: Face(SphericalSurface(10.0).nurbs()),
    "poles of a tiny sphere": lambda: Face(SphericalSurface(0.6 * REACH).nurbs()),
}


@pytest.mark.parametrize("name", KEPT)
def test_whatever_leaves_the_plane_or_is_no_fold_keeps_its_normals(name: str) -> None:
    face = KEPT[name]()
    swapped = Face(face.surface.swapped())
    uv = np.concatenate([across(face), across(swapped)[:, ::-1], face.grid(40, 40)])
    kept = has_own_normal(face, uv)
    assert kept.sum() > 2000
    assert (face.normal(uv[kept]) == own_normals(face, uv[kept])).all()
    assert (swapped.normal(uv[kept, ::-1]) == own_normals(swapped, uv[kept, ::-1])).all()


@pytest.mark.parametrize("name", ["overlap of 1 mm", "rib 0.003 mm high", "knife edge of 2 degrees"])
def test_a_border_at_which_the_surface_stands_still_has_the_normals_beside_it(name: str) -> None:
    """Control points that are one point there: the first and second derivatives vanish and tell nothing."""
    face = KEPT[name]()
    (low, high), _ = face.surface.domain
    for end, inside in ((low, low + 1e-3 * (high - low)), (high, high - 1e-3 * (high - low))):
        there, beside = np.array([[end, 0.37]]), np.array([[inside, 0.37]])
        assert not has_own_normal(face, there).any()
        assert face.normal(there) == pytest.approx(own_normals(face, beside), abs=1e-6)


@pytest.mark.parametrize("place", [10.0, 15.0, 20.0, 30.0])
def test_a_fold_that_begins_and_ends_on_borders_of_cells_is_found(place: float) -> None:
    """Corners lie at knots: Su vanishes on borders of cells and nowhere within one."""
    face = with_corners((0, 0), (place, 0), (place - 0.004, 0), (60, 0))
    uv = across(face)
    turned_over = own_normals(face, uv)[:, 2] < -0.9
    assert turned_over.sum() > 50
    assert face.normal(uv[turned_over]) == pytest.approx(np.tile([0.0, 0.0, 1.0], (turned_over.sum(), 1)), abs=1e-9)


@pytest.mark.parametrize("height, kept", [(0.5 * FLAT, False), (2.0 * FLAT, True)])
def test_a_fold_no_higher_than_any_tolerance_counts_as_one(height: float, kept: bool) -> None:
    """A lip that hangs over by 0.005 mm: too low for any cut to be charged with, or an undercut."""
    face = with_corners((0, 0), (30, 0), (29.995, -height), (60, -height))
    uv = across(face)
    below = own_normals(face, uv)[:, 2] < -0.9
    assert below.sum() > 50
    assert (face.normal(uv)[below, 2] < 0).all() == kept


def ending_in_a_point(seed: int, across: float) -> np.ndarray:
    """Homogeneous control points (4, 3, 4) of a patch of random points, all of whose last row along v are one point."""
    rng = np.random.default_rng(seed)
    u, v = np.meshgrid(np.linspace(-1, 1, 4), np.arange(2.0, -1.0, -1.0), indexing="ij")
    points = np.stack([4.0 * u * v, 8.0 * v, 0.0 * u], axis=-1) + across * v[..., None] * rng.normal(size=(4, 3, 3))
    weight = rng.uniform(0.8, 1.2, (4, 3, 1))
    return np.concatenate([weight * points, weight], axis=-1)


@pytest.mark.parametrize("turned", range(4))
def test_what_is_proven_to_keep_its_side_beside_a_pole_does(turned: int) -> None:
    """Patches of all kinds that end in one point, on each of the four sides."""
    line = np.linspace(0.0, 1.0, 61)
    line[:20], line[-20:] = np.geomspace(1e-6, 0.3, 20), 1.0 - np.geomspace(0.3, 1e-6, 20)
    uv = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    proven = turning = 0
    for seed in range(60):
        net = ending_in_a_point(seed, 0.3 + seed / 20)
        net, along = (net.swapaxes(0, 1), 0) if turned % 2 else (net, 1)
        net = np.ascontiguousarray(np.flip(net, along) if turned > 1 else net)
        face = Face.from_bspline(net[..., :3] / net[..., 3:], tuple(np.array(net.shape[:2]) - 1), weights=net[..., 3])
        if face.surface.turning_cells.turning.any():
            turning += 1
            continue
        proven += 1
        d = face.evaluate(uv)
        area = np.cross(d.su, d.sv)
        size = np.linalg.norm(area, axis=1)
        assert size.min() > 0
        # Within one cell all turn less than half around; over the whole patch neighbours agree.
        normal = (area / size[:, None]).reshape(len(line), len(line), 3)
        for axis in (0, 1):
            assert np.sum(np.delete(normal, 0, axis) * np.delete(normal, -1, axis), axis=-1).min() > 0
    assert proven > 10 and turning > 10


def test_what_is_proven_to_keep_its_side_with_weights_of_rows_and_columns_does() -> None:
    """Patches of all kinds whose weights are products, as those of drawn and turned arcs."""
    proven = turning = 0
    uv = np.stack(np.meshgrid(*[np.linspace(0.0, 1.0, 81)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    for seed in range(60):
        rng = np.random.default_rng(seed)
        flat = np.stack(np.meshgrid(np.arange(4.0), np.arange(3.0), [0.0], indexing="ij"), axis=-1)[:, :, 0]
        net = flat + (0.2 + seed / 60) * rng.normal(size=flat.shape)
        weights = np.exp(rng.normal(size=(4, 1))) * np.exp(rng.normal(size=(1, 3)))
        face = Face.from_bspline(net, (3, 2), weights=weights)
        if face.surface.turning_cells.turning.any():
            turning += 1
            continue
        proven += 1
        d = face.evaluate(uv)
        normal = np.cross(d.su, d.sv)
        normal = (normal / np.linalg.norm(normal, axis=1)[:, None]).reshape(81, 81, 3)
        for axis in (0, 1):
            assert np.sum(np.delete(normal, 0, axis) * np.delete(normal, -1, axis), axis=-1).min() > 0
    assert proven > 10 and turning > 10


def test_a_long_thin_rounding_has_no_folds() -> None:
    """230 x 0.44 mm, as on a casting: its cells are longer than the arc across them is wide."""
    rounding = CylindricalSurface(0.44, u_range=(0.0, 1.54), v_range=(0.0, 232.0)).nurbs()
    assert not rounding.turning_cells.turning.any()


def test_a_dome_has_no_folds_at_its_pole() -> None:
    """Nor has it any that are looked for: what was at every place near the pole took most of the time of a plan."""
    dome = SphericalSurface(7.0, v_range=(0.9, np.pi / 2)).nurbs()
    assert not dome.turning_cells.turning.any()
    assert not dome.swapped().turning_cells.turning.any()
