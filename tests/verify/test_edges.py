"""Gouges beside convex edges and open borders: as deep as they lie below the part's surface, none is missed."""

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion
from toolaxis.shape.analytic import CylindricalSurface
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.tolerances import Tolerance
from toolaxis.tools.profile import Profile
from toolaxis.verify.convex_edges import _may_lie_within, depth_at_edges
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.verdict import judge

FLAT = Profile(1.5, 0.0, 0.0, 20.0)
LEAN = np.radians(70.0)


def plane(corner, one, two, label):
    s, t = np.meshgrid(np.linspace(0, 1, 4), np.linspace(0, 1, 4), indexing="ij")
    points = np.asarray(corner) + s[..., None] * np.asarray(one) + t[..., None] * np.asarray(two)
    return Face.from_bspline(points).trimmed((), label)


TOP = plane([0, 0, 0], [8, 0, 0], [0, 6, 0], "top")
SIDE = plane([8, 0, -30], [0, 6, 0], [0, 0, 30], "side")
OTHER = plane([8, 0, 0], [5, 0, 0], [0, 6, 0], "other")


def cut_along_the_edge(tips, axis, target=TOP, **change):
    """A cutter that stands at a few tips, judged for gouge alone."""
    tips, axis = np.atleast_2d(tips), np.asarray(axis) / np.linalg.norm(axis)
    kind = np.full(len(tips), Motion.CUT, dtype=np.int8)
    given = {"touching": (SIDE,), "tolerance": Tolerance(gouge=0.002), **change}
    return judge(VerificationTask("top", tips, np.tile(axis, (len(tips), 1)), kind, FLAT, (target,), 0.02,
                                  left=(target,), **given),
                 spacing=0.2)


def chamfer(depth):
    """The bottom of a cutter that leans outwards by 70 deg takes a triangle off the edge x = 8, so deep there."""
    axis = np.array([np.sin(LEAN), 0.0, np.cos(LEAN)])
    return np.array([[8.0, 2.0, -depth], [8.0, 4.0, -depth]]), axis


@pytest.mark.parametrize("touching", [(SIDE,), ()], ids=["edge", "open border"])
@pytest.mark.parametrize("depth", [0.0037, 0.012])
def test_a_sliver_off_the_edge_is_as_deep_as_it_is_below_the_surface(depth, touching):
    """Deepest is where it is as far from both faces; the face behind the edge is entered as far as the edge itself."""
    found = cut_along_the_edge(*chamfer(depth), touching=touching)
    deepest = depth / (1.0 + np.tan(LEAN))
    assert max(place.value for one in found.maps for place in one.worst("gouge")) == pytest.approx(deepest, rel=0.06)
    assert found.gouge_max == pytest.approx(depth * np.cos(LEAN) if touching else deepest, rel=0.06)
    assert found.passed == (depth == 0.0037), found.reasons


@pytest.mark.parametrize("touching", [(SIDE,), ()], ids=["edge", "open border"])
@pytest.mark.parametrize("width", [0.006, pytest.param(0.03, marks=pytest.mark.long), 1.0])
def test_a_planted_gouge_at_the_border_is_found_whole(touching, width):
    """The flat bottom runs 0.005 mm too deep along the border, on a strip of any width from there."""
    at = 8.0 - width + FLAT.flat_radius
    found = cut_along_the_edge([[at, -3.0, -0.005], [at, 9.0, -0.005]], [0, 0, 1], touching=touching)
    assert not found.passed
    assert found.gouge_max == pytest.approx(0.005, rel=0.06)
    assert max(place.value for place in found.worst_gouge if place.face == "top") == pytest.approx(0.005, rel=0.06)


@pytest.mark.parametrize("slope", [
    -60.0, *(pytest.param(slope, marks=pytest.mark.long) for slope in (-20.0, 20.0)), 60.0])
def test_edges_of_any_angle(slope):
    """The face behind the edge leans out or in: the strip is measured to the nearer of the two faces."""
    down = 30.0 * np.array([np.sin(np.radians(slope)), 0.0, -np.cos(np.radians(slope))])
    side = plane(np.add(down, [8, 0, 0]), [0, 6, 0], -down, "side")
    assert side.normal(np.array([[0.5, 0.5]]))[0, 0] > 0
    at = 8.0 - 1.0 + FLAT.flat_radius
    found = cut_along_the_edge([[at, -3.0, -0.005], [at, 9.0, -0.005]], [0, 0, 1], touching=(side,))
    assert found.gouge_max == pytest.approx(0.005, rel=0.06)
    assert not found.passed


@pytest.mark.parametrize("change", [{"skin": (OTHER,)}, {"surroundings": (OTHER,)}], ids=["skin", "other"])
def test_where_the_part_goes_on_nothing_is_forgiven(change):
    found = cut_along_the_edge(*chamfer(0.0037), touching=(), **change)
    assert max(place.value for place in found.worst_gouge) >= 0.0036


def test_a_seam_is_no_border():
    """A groove of a sharp corner along the seam of a cylinder, 0.004 mm deep."""
    surface = CylindricalSurface(5.0, v_range=(0.0, 8.0)).nurbs()
    tube = Face(surface, label="tube")
    assert tube.normal(np.array([[0.3, 4.0]]))[0] @ tube.evaluate(np.array([[0.3, 4.0]])).point[0] > 0
    seam = tube.evaluate(np.array([[tube.bounds[0], 4.0]])).point[0]
    out = seam * [1, 1, 0] / np.linalg.norm(seam[:2])
    aside = np.cross([0, 0, 1], out)
    axis = (out + aside) / np.sqrt(2.0)
    towards = (aside - out) / np.sqrt(2.0)
    tip = seam - 0.004 * out - FLAT.flat_radius * towards
    tips = tip + np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
    found = cut_along_the_edge(tips, axis, target=tube, touching=())
    assert found.gouge_max == pytest.approx(0.004, abs=2e-4)


def test_the_numbers_do_not_depend_on_where_the_part_stands():
    rigid = np.eye(4)
    rigid[:3, :3] = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
    rigid[:3, :3] *= np.linalg.det(rigid[:3, :3])
    rigid[:3, 3] = 3.0, -7.0, 11.0
    tips, axis = chamfer(0.007)
    moved = cut_along_the_edge(np.array(tips) @ rigid[:3, :3].T + rigid[:3, 3], rigid[:3, :3] @ axis,
                               touching=(SIDE.transformed(rigid),), target=TOP.transformed(rigid))
    assert moved.gouge_max == pytest.approx(cut_along_the_edge(tips, axis).gouge_max, rel=1e-3)


def test_places_near_a_face_are_all_asked_for():
    tilted = plane([2, 1, -1], [3, 0, 4], [-1, 5, 0], "tilted")
    places = np.random.default_rng(3).uniform([-2, -1, -3], [7, 8, 5], (20000, 3))
    near = nearest(tilted, places).distance < 0.6
    asked = _may_lie_within(0.6, tilted, places)
    assert near.sum() > 20
    assert (asked | ~near).all()
    assert asked.sum() < 0.8 * (((places > tilted.box[0] - 0.6) & (places < tilted.box[1] + 0.6)).all(axis=1)).sum()


@pytest.mark.parametrize("deep", [-0.05, 0.05])
def test_what_lies_beyond_a_wall_is_no_depth_beside_a_blunt_edge(deep):
    """A plate 0.4 mm thick whose top bends down by a tenth of a degree; the cutter works on its lower side."""
    down = -5.0 * np.tan(np.radians(0.1))
    bent = plane([8, 0, 0], [5, 0, down], [0, 6, 0], "bent")
    lower = plane([0, 6, -0.4], [13, 0, 0], [0, -6, 0], "lower")
    found = cut_along_the_edge([[8, 2, deep - 0.4], [8, 4, deep - 0.4]], [0, 0, -1], touching=(), skin=(bent, lower))
    assert found.gouge_max == pytest.approx(max(deep, 0.0), abs=1e-3)
    assert found.passed == (deep < 0), found.reasons


def rib(width, lean):
    """Cross-section in x and z: a side that stands upright, a flat tip, and a side that leans outwards (deg)."""
    foot = 2.0 * np.tan(np.radians(lean))
    return (plane([0, 0, -2], [0, 0, 2], [0, 2, 0], "upright"), plane([0, 0, 0], [width, 0, 0], [0, 2, 0], "tip"),
            plane([width, 0, 0], [foot, 0, -2], [0, 2, 0], "leaning"))


@pytest.mark.parametrize("width", [0.3, 0.6])
@pytest.mark.parametrize("below", [0.0, 0.05])
def test_air_behind_a_rib_that_grows_wider_is_no_gouge(width, below):
    """Rays from the upright side near the tip come nearer to the border of the leaning side than to any place inside
    it, leave the rib through it and meet the cutter in the air behind."""
    upright, tip, leaning = rib(width, 40.0)
    out = leaning.normal(np.array([[0.5, 0.5]]))[0]
    ball = Profile(0.0, 0.4, 0.0, 20.0)
    beside = np.array([width + 0.2 * np.tan(np.radians(40.0)), 1.0, -0.2]) + (0.03 - below) * out
    tips = beside + np.array([[0.0, -0.5, 0.0], [0.0, 0.5, 0.0]])
    found = judge(VerificationTask("rib", tips, np.tile(out, (2, 1)), np.full(2, Motion.CUT, dtype=np.int8), ball,
                                   (leaning,), 0.02, left=(leaning,), skin=(leaning, tip, upright),
                                   tolerance=Tolerance(gouge=0.002)), spacing=0.2)
    assert found.gouge_max == pytest.approx(max(below - 0.03, 0.0), abs=0.001)
    assert {place.face for place in found.worst_gouge} == ({"leaning"} if below else set())


#: Where the rolled strip begins to bend, mm, and its radius there.
FLAT_TO, ROLLED = 0.03, 0.05


def rolled() -> Face:
    """A strip that is flat next to its open border at y = 0, and then bends down, ever farther from the plane."""
    y = np.concatenate([np.linspace(0.0, FLAT_TO, 4), np.linspace(0.035, 0.2, 40)])
    z = -np.maximum(y - FLAT_TO, 0.0) ** 2 / (2 * ROLLED)
    rows = [np.column_stack([np.full(len(y), x), y, z]) for x in (0.0, 5.0, 10.0)]
    knots = np.concatenate([[0.0], np.arange(len(y)), [len(y) - 1.0]])
    return Face.from_bspline(np.stack(rows), degree=(2, 1), knots=([0, 0, 0, 1, 1, 1], knots))


@pytest.mark.parametrize("deep", [0.0, 0.02])
def test_air_over_a_face_that_bends_more_than_at_its_border_is_no_gouge(deep: float) -> None:
    """Found: rays were laid inwards with the bend of the border, stood in the air farther in, and told that as a depth.

    All is cut away down to so deep below the strip; the rays' own depths say nothing.
    """
    face = rolled()

    def cut(feet: np.ndarray, ways: np.ndarray, depth: np.ndarray) -> np.ndarray:
        points = np.concatenate([feet - share * np.minimum(depth, 1.0)[:, None] * ways
                                 for share in np.linspace(0, 1, 200)])
        at = nearest(face, points)
        over = ((points - at.point) * face.normal(at.uv)).sum(axis=1) > -deep - 1e-9
        return np.minimum(depth, 1.0) * np.cumprod(over.reshape(200, -1), axis=0).sum(axis=0) / 200

    foot, normal = np.array([[5.0, 0.002, 0.0]]), np.array([[0.0, 0.0, 1.0]])
    told, near = depth_at_edges(face, (foot, normal, np.array([1.0])), ((), ()), cut, 0.01, lambda *ray: ray[2])
    assert near.all()
    assert told[0] == pytest.approx(deep, abs=0.006)
