"""Faces divided by the distance to bosses: whole, without overlap, cut at that distance, and taken where cheaper."""

import sys

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.partition.bosses import distances
from toolaxis.partition.face_division import Divider
from toolaxis.partition.partition import regions
from toolaxis.partition.ring_division import RingDivision, candidates, divide_in_rings
from toolaxis.search.cost import CLEAN_UP
from toolaxis.search.face_problem import FaceProblem, task

TOOL = ta.Tool.torus(diameter=6, corner_radius=1, stickout=40)


def waved() -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 50, 6), np.linspace(0, 44, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, 1.5 * np.sin(x / 9) * np.cos(y / 11)], axis=-1))


def post(x: float, y: float, radius: float, height: float = 15.0) -> ta.Face:
    t = np.linspace(0, 2 * np.pi, 81)
    ring = np.column_stack([x + radius * np.cos(t), y + radius * np.sin(t)])
    return ta.Face.from_bspline([[[*p, z] for z in (height, -6.0)] for p in ring], degree=(1, 1))


POSTS = (post(15, 20, 3.0), post(36, 27, 4.0))


@pytest.fixture(scope="module")
def job() -> FaceProblem:
    return task(waved(), TOOL, 0.08, obstacles=POSTS)


@pytest.fixture(scope="module")
def divider(job: FaceProblem) -> Divider:
    return Divider(job, cells=(8, 8), most=6)


def test_an_obstacle_stands_on_the_face_or_hovers() -> None:
    assert len(distances(waved(), TOOL, obstacles=POSTS)) == 2
    hovering = post(15, 20, 3.0).transformed(np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 12], [0, 0, 0, 1.0]]))
    assert distances(waved(), TOOL, obstacles=(hovering,)) == ()
    assert distances(waved(), TOOL) == ()


def test_distances_are_those_to_the_nearest_point() -> None:
    (boss,) = distances(waved(), TOOL, obstacles=POSTS[:1])
    uv = waved().grid(9, 9)
    point = waved().evaluate(uv).point
    away = np.hypot(point[:, 0] - 15, point[:, 1] - 20) - 3
    assert boss(uv)[away > 1] == pytest.approx(away[away > 1], abs=0.05)


@pytest.mark.parametrize("radius", [4.0, 9.0, np.inf])
def test_parts_are_the_face_cut_at_the_distance(radius: float) -> None:
    face, bosses = waved(), distances(waved(), TOOL, obstacles=POSTS)
    parts = divide_in_rings(face, bosses, radius)
    assert len(parts) == (2 if np.isinf(radius) else 3)
    assert sum(part.area for part in parts) == pytest.approx(face.area, rel=1e-6)
    uv = np.random.default_rng(1).random((4000, 2))
    away = np.array([boss(uv) for boss in bosses])
    wanted = [(away[k] == away.min(axis=0)) & (away[k] < radius) for k in (0, 1)] + [away.min(axis=0) >= radius]
    near = (np.abs(away[0] - away[1]) < 0.05) | (np.abs(away.min(axis=0) - radius) < 0.05)
    for part, own in zip(parts, wanted, strict=False):
        assert (part.contains(uv) == own)[~near].all()
    assert (sum(part.contains(uv).astype(int) for part in parts) == 1).all()


def test_parts_divided_further_are_the_face(divider: Divider) -> None:
    found = candidates(divider, distances(waved(), TOOL, obstacles=POSTS))
    assert {one.radius for one in found} >= {6.0, np.inf}
    for one in found:
        for count in (4, 6):
            if np.isfinite(one.curve[count]):
                _is_the_face(one, count)


def _is_the_face(one: RingDivision, count: int) -> None:
    pieces = one.regions(count)
    assert len(pieces) >= count and pieces.radius == one.radius
    assert sum(piece.area for piece in pieces) == pytest.approx(waved().area, rel=1e-6)
    uv = np.random.default_rng(count).random((3000, 2))
    assert (sum(piece.contains(uv).astype(int) for piece in pieces) == 1).all()
    if len(pieces) == count:
        assert sum(pieces.lengths) == pytest.approx(one.curve[count], rel=1e-9)


def test_the_cheaper_division_is_taken(job: FaceProblem, divider: Divider, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Divider.__init__, "__defaults__", ((8, 8), *Divider.__init__.__defaults__[1:]))
    bosses = distances(waved(), TOOL, obstacles=POSTS)
    both = regions(job, 4, bosses=bosses)
    assert len(both) == 4 and sum(both.lengths) <= 1.03 * divider.curve[4]

    class Dearer(Divider):
        """Iso-parametric cuts that cost more than any by distance."""

        curve = property(lambda self: self.best.division.curve + 1e5)

    monkeypatch.setattr(sys.modules["toolaxis.partition.partition"], "Divider", Dearer)
    forced = regions(job, 4, bosses=bosses)
    assert forced.radius > 0 and len(forced) == 4
    assert sum(forced.lengths) >= sum(both.lengths) - 1e-6
    assert sum(one.area for one in forced) == pytest.approx(waved().area, rel=1e-6)


def test_what_is_left_at_posts_is_charged(divider: Divider) -> None:
    prices = divider.best.prices
    assert prices.left.any() and (prices.extra[~prices.left.any(axis=(1, 2))] == 0).all()
    assert (prices.extra.sum(axis=(1, 2))[prices.left.any(axis=(1, 2))] > 0).all()
    whole = prices.left[:, :-1, :-1] & prices.left[:, 1:, :-1] & prices.left[:, :-1, 1:] & prices.left[:, 1:, 1:]
    cell = tuple(np.argwhere(whole & (divider.lattice.areas > 0))[0])
    strip = divider.job.worth.clean_up_strip
    assert prices.extra[cell] == pytest.approx(CLEAN_UP * divider.lattice.areas[cell[1:]] / strip)
