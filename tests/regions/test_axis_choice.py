"""Axes that surfaces share: the choice against plain enumeration, and which axes serve a face beside a wall."""

import itertools

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.regions.axis_choice import choose_axes, reckon_axes
from toolaxis.regions.scene import ReachScene
from toolaxis.regions.tool_choice import AxisTime
from toolaxis.search.face_problem import task
from toolaxis.shape.part import Part

Options = list[list[AxisTime]]


def options(rng: np.random.Generator, surfaces: int, axes: int) -> Options:
    """Of each surface some of the axes, one at least."""
    return [[AxisTime(int(axis), float(rng.uniform(0, 8))) for axis in rng.permutation(axes)[:rng.integers(1, axes)]]
            for _ in range(surfaces)]


def cost(some: tuple[AxisTime, ...], used: set[int], move: float) -> float:
    return sum(one.seconds for one in some) + move * len({one.axis for one in some} - used)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("used", [set(), {0}, {1, 3}])
def test_no_other_choice_of_axes_takes_much_less_time(seed: int, used: set[int]) -> None:
    some = options(np.random.default_rng(seed), 5, 5)
    found = choose_axes(some, used, 6.0)
    taken = tuple(next(one for one in own if one.axis == axis) for own, axis in zip(some, found, strict=True))
    least = min(cost(one, used, 6.0) for one in itertools.product(*some))
    assert cost(taken, used, 6.0) == pytest.approx(least, rel=1e-3)


def test_nothing_and_single_axes_are_no_question() -> None:
    assert choose_axes([], set(), 6.0) == ()
    assert choose_axes([[AxisTime(4, 1.0)], [AxisTime(4, 2.0)]], set(), 6.0) == (4, 4)


def test_many_surfaces_share_few_axes() -> None:
    rng = np.random.default_rng(3)
    some = [[AxisTime(axis, float(rng.uniform(1, 2))) for axis in range(40)] for _ in range(150)]
    assert len(set(choose_axes(some, set(), 6.0))) < 20


@pytest.fixture(scope="module")
def corner() -> Part:
    """A plane, 20 x 20 mm, and an upright wall along its side at x = 0."""
    floor = ta.Face.from_bspline(np.array([[[0.0, 0, 0], [0, 20, 0]], [[20, 0, 0], [20, 20, 0]]]), degree=(1, 1))
    wall = ta.Face.from_bspline(np.array([[[0.0, 0, -1], [0, 0, 19]], [[0, 20, -1], [0, 20, 19]]]), degree=(1, 1),
                                flip=True)
    return Part.from_faces([floor, wall])


def test_axes_that_lean_into_a_wall_do_not_serve(corner: Part) -> None:
    face = corner.face(1)
    lean = np.radians(20)
    axes = np.array([[0.0, 0, 1], [np.sin(lean), 0, np.cos(lean)], [-np.sin(lean), 0, np.cos(lean)], [0, 0, -1.0]])
    job = task(face, ta.Tool.ball(4, stickout=30), 0.02, part=corner)
    found = reckon_axes(job, ReachScene.of(corner), axes, 0, 10.0, 6.0)
    assert {one.axis for one in found} == {0, 1}
    strip = 2 * np.sqrt(2 * 2 * 0.02)
    assert found[0].seconds == pytest.approx(400 / strip / 10, rel=0.2)


def test_what_takes_an_index_move_longer_does_not_serve(corner: Part) -> None:
    """A bull nose that leans has narrower strips than one that hardly does."""
    lean = np.radians([1.0, 30.0])
    axes = np.stack([np.sin(lean), 0 * lean, np.cos(lean)], axis=-1)
    job = task(corner.face(1), ta.Tool.torus(8, 1, stickout=30), 0.02, part=corner)
    slow, quick = (reckon_axes(job, ReachScene.of(corner), axes, 0, rate, 6.0) for rate in (2.0, 100.0))
    assert [one.axis for one in slow] == [0] and [one.axis for one in quick] == [0, 1]
