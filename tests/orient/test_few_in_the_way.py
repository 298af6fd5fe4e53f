"""A crease too tight for the cutter in a large face: it is left, and the rest is machined."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis import Face, Tool, best_axis
from toolaxis.feasibility.left_places import NOTHING_LEFT, LeftPlaces
from toolaxis.search import face_problem, fixed_axis
from toolaxis.search import few_in_the_way as few

TOOL, SCALLOP = Tool.torus(12, 2, stickout=60), 0.05
#: Middle of the crease.
AT = np.array([39.375, 73.125])


def creased(width: float = 0.8, depth: float = 0.4) -> Face:
    """120 x 120 mm, nearly plane, with a groove narrower than the corner of the tool over a part of its length."""
    x = np.unique(np.concatenate([np.linspace(0, 120, 13), AT[0] + np.linspace(-2 * width, 2 * width, 17)]))
    y = np.linspace(0, 120, 49)
    grid_x, grid_y = np.meshgrid(x, y, indexing="ij")
    groove = np.exp(-(((grid_x - AT[0]) / width) ** 2) - ((grid_y - AT[1]) / 3.0) ** 2)
    points = np.stack([grid_x, grid_y, 0.0005 * (grid_x - 60) ** 2 - depth * groove], axis=-1)
    return Face.from_bspline(points, knots=(_clamped(x), _clamped(y)))


def _clamped(line: np.ndarray) -> np.ndarray:
    inner = (line[1:-3] + line[2:-2] + line[3:-1]) / 3
    return np.concatenate([[line[0]] * 4, inner, [line[-1]] * 4])


@pytest.fixture(scope="module")
def face() -> Face:
    return creased()


def test_a_face_with_a_crease_is_machined_but_for_the_crease(face, monkeypatch):
    found = best_axis(face, TOOL, SCALLOP)
    assert found.outcome == "feasible"
    assert 0 < found.unreached < few.FEW
    monkeypatch.setattr(fixed_axis, "_LEAVINGS", 0)
    assert best_axis(face, TOOL, SCALLOP).outcome in ("infeasible", "not_found")


def test_places_are_none_where_much_is_in_the_way_or_nothing_is(face):
    axis = np.array([[0.0, np.sin(0.2), np.cos(0.2)]])
    deep = face_problem.task(creased(width=12.0, depth=25.0), TOOL, SCALLOP).feasibility
    assert not len(few.find_few_in_the_way(deep, axis).points)
    plain = face_problem.task(creased(depth=0.0), TOOL, SCALLOP).feasibility
    assert not len(few.find_few_in_the_way(plain, axis).points)
    found = few.find_few_in_the_way(face_problem.task(face, TOOL, SCALLOP).feasibility, axis)
    assert len(found.points)
    assert np.abs(found.points[:, :2] - AT).max() < 30


def test_places_that_would_leave_no_contact_to_decide_are_none(face, monkeypatch):
    """Found: on a strip narrower than the cutter nothing was left to decide about an axis, and the program failed."""
    monkeypatch.setattr(few, "_AROUND", 100.0)
    axis = np.array([[0.0, np.sin(0.2), np.cos(0.2)]])
    assert not len(few.find_few_in_the_way(face_problem.task(face, TOOL, SCALLOP).feasibility, axis).points)
    assert best_axis(face, TOOL, SCALLOP).outcome in ("infeasible", "not_found")


def test_near_places_that_are_left_contacts_are_not_judged_but_passes_are_cut_out(face):
    axis = np.array([0.0, np.sin(0.2), np.cos(0.2)])
    own = face_problem.task(face, TOOL, SCALLOP).feasibility
    left = LeftPlaces(np.array([[*AT, -0.5]]), 20.0)
    feasible = replace(own, left=left)
    middle = np.array([[AT[0] + 1.5, AT[1]]]), np.array([[60.0, 100.0]])
    assert own.worst(axis, own.contacts(middle[0], 0)) is not None
    assert not len(feasible.contacts(middle[0], 0).uv) and len(feasible.contacts(middle[1], 0).uv)
    assert own.reach(middle[0], axis)[0]  # a free axis is taken to be free there
    assert not feasible.reach(middle[0], axis)[0] and feasible.reach(middle[1], axis)[0]


def test_no_places_are_near_anything():
    assert not NOTHING_LEFT.near(np.zeros((3, 3))).any()
    both = NOTHING_LEFT.and_more(LeftPlaces(np.zeros((1, 3)), 2.0))
    assert both.near(np.array([[0, 0, 1.9], [0, 0, 2.1]])).tolist() == [True, False]
