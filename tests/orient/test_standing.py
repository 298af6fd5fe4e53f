"""Positions of a tool among faces: decided together, they are what they are one by one."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.contact.clearance.queries import keeps_limits, motions
from toolaxis.feasibility.interference import InterferenceScene, stands_free
from toolaxis.feasibility.surroundings import OTHER, SKIN, CheckSurfaces

REQUIRED = np.array([0.1, 0.5, 1.0])
TOOL = ta.Tool.torus(10, 1, stickout=40, holder=[(10, 0), (10, 30)])


def sheet(number, height, slope=0.0):
    x, y = np.meshgrid(np.linspace(-30, 30, 4), np.linspace(-30, 30, 4), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, height + slope * x + 0 * y], axis=-1)).trimmed((), str(number))


@pytest.fixture
def scene():
    wall = sheet(2, 0.0, 0.9)
    skin = CheckSurfaces(SKIN, (sheet(1, -0.5),), np.array([-0.002, 0.5, 1.0]))
    return InterferenceScene(1, TOOL, (skin, CheckSurfaces(OTHER, (wall,), REQUIRED)), ())


def one_by_one(scene, places, axis):
    free = np.ones(len(places), dtype=bool)
    for group in scene.groups:
        for k, place in enumerate(places):
            limits = np.tile(group.required, (len(group.faces), 1))
            free[k] &= keeps_limits(group.cells, scene.tool, motions(place[None], axis), limits).blocked[0] < 0
    return free


def test_positions_together_are_positions_one_by_one(scene):
    x, y = np.meshgrid(np.linspace(-25, 25, 40), np.linspace(-4, 4, 12), indexing="ij")
    places = np.stack([x, y, np.full_like(x, 3.0)], axis=-1).reshape(-1, 3)
    axis = np.array([0.1, 0.0, 1.0]) / np.hypot(0.1, 1.0)
    free = stands_free(scene, places, axis, (True, (SKIN, OTHER)))
    assert 0.2 < free.mean() < 0.8
    np.testing.assert_array_equal(free, one_by_one(scene, places, axis))


def test_close_positions_take_few_questions(scene, monkeypatch):
    asked = []

    def counting(cells, tool, moves, required):
        asked.append(len(moves))
        return keeps_limits(cells, tool, moves, required)

    monkeypatch.setattr("toolaxis.feasibility.interference.keeps_limits", counting)
    x, y = np.meshgrid(np.linspace(-25, -20, 60), np.linspace(-3, 3, 60), indexing="ij")
    places = np.stack([x, y, np.full_like(x, 30.0)], axis=-1).reshape(-1, 3)
    assert stands_free(scene, places, np.array([0.0, 0.0, 1.0]), (True, (SKIN, OTHER))).all()
    assert sum(asked) < len(places) / 10


def test_the_face_itself_can_be_left_out(scene):
    place, axis = np.array([[-20.0, 0.0, -1.0]]), np.array([0.0, 0.0, 1.0])
    assert not stands_free(scene, place, axis, (True, (SKIN,)))[0]
    itself = scene._replace(groups=(CheckSurfaces(SKIN, scene.groups[0].faces, scene.groups[0].required),))
    itself = itself._replace(numbers=(itself.groups[0].faces[0].number,))
    assert stands_free(itself, place, axis, (False, (SKIN,)))[0]


def test_no_position_is_no_question(scene):
    assert stands_free(scene, np.empty((0, 3)), np.array([0.0, 0.0, 1.0]), (True, (SKIN, OTHER))).shape == (0,)
