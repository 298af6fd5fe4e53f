"""Faces of a file that miss each other along an edge: the judge takes that off a gouge, there and no more."""

import numpy as np
import pytest
from third import depth_of_cut, stair, strip

from toolaxis.cldata.toolpath import Motion
from toolaxis.contact.clearance.gouge import segment_penetration
from toolaxis.feasibility.surroundings import SKIN, TOUCHING, group_surroundings
from toolaxis.shape.adjacency import Border, edges_from_borders
from toolaxis.shape.part import Part
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool
from toolaxis.verify import seams
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.verdict import judge

BALL = Tool.ball(8)
UP = np.array([0.0, 0.0, 1.0])


def judged(faces, tips, tolerance, role="skin", tool=BALL, axis=UP):
    kind = np.full(len(tips), Motion.CUT, dtype=np.int8)
    given = {role: faces[1:]}
    return judge(VerificationTask("op", np.asarray(tips), np.tile(axis, (len(tips), 1)), kind, tool.profile, faces[:1],
                                  0.02, left=faces[:1], tolerance=Tolerance(gouge=tolerance), **given), spacing=0.25)


def along(x, z):
    """The ball runs along the seam at a distance from it."""
    return [[x, -3.0, z], [x, 3.0, z]]


def missing_riser(height):
    return stair(height, riser=False).faces


def proud_side(height, down=4.0):
    """The top z = 0, and a side at right angles whose upper border stands out over it."""
    return strip(1, (-8.0, 0.0), (0.0, 0.0)), strip(2, (0.0, height), (0.0, -down))


@pytest.mark.parametrize("tolerance", [0.002, 0.01])
@pytest.mark.parametrize("height", [0.0034, 0.007, 0.018])
def test_the_step_of_a_seam_is_not_charged(height, tolerance):
    """The cutter touches the lower face beside the seam and enters the higher one by nearly its height."""
    found = judged(missing_riser(height), along(-0.02, 0.0), tolerance)
    assert found.passed, found.reasons
    assert found.gouge_max <= tolerance


@pytest.mark.parametrize("tolerance", [0.002, 0.01])
@pytest.mark.parametrize("height", [0.0034, 0.018])
def test_what_is_deeper_than_tolerance_and_step_is_found(height, tolerance):
    found = judged(missing_riser(height), along(0.2, -tolerance - 0.001), tolerance)
    assert not found.passed
    assert found.gouge_max == pytest.approx(tolerance + 0.001, abs=4e-4)
    assert found.worst_gouge[0].face == "2"
    assert judged(missing_riser(height), along(0.2, -tolerance + 0.001), tolerance).passed


@pytest.mark.parametrize("height", [0.0034, 0.007])
def test_a_piece_that_ends_beside_the_seam_has_the_step_of_its_face_taken_off(height):
    """The plan has cut the higher face 0.3 mm from the seam: its step lies on the border of the whole face."""
    lower, whole = missing_riser(height)
    (u0, u1, v0, v1), across = whole.bounds, np.array([[0.0], [1.0]])
    begin = u0 + (u1 - u0) * 0.3 / np.ptp(whole.evaluate(u0 + (u1 - u0) * across * [[1.0, 0.0]]).point[:, 0])
    piece = whole.trimmed((np.array([[begin, v0], [u1, v0], [u1, v1], [begin, v1]]),))
    assert piece.box[0][0] == pytest.approx(0.3)
    deep = along(0.45, height - 0.01 - 0.8 * height)
    found = judged((piece, lower, whole), deep, 0.01)
    assert found.passed and found.gouge_max <= 0.01, found.reasons
    assert not judged((piece, lower, whole), along(0.45, -0.011), 0.01).passed
    assert not judged((piece, lower, whole), along(1.9, height - 0.011), 0.01).passed


@pytest.mark.parametrize(("x", "z"), [(1.8, 0.007), (-1.8, 0.0)])
@pytest.mark.parametrize("tolerance", [0.002, 0.01])
def test_away_from_the_seam_all_is_charged(x, z, tolerance):
    """On the higher face far enough from the seam, and on the lower one, nothing is taken off."""
    faces = missing_riser(0.007)
    found = judged(faces, along(x, z - tolerance - 0.001), tolerance)
    assert not found.passed
    assert found.gouge_max == pytest.approx(tolerance + 0.001, abs=2e-4)
    assert judged(faces, along(x, z - tolerance + 0.001), tolerance).passed


def test_the_lower_face_has_nothing_taken_off_beside_the_seam():
    found = judged(missing_riser(0.007), along(-0.1, -0.004), 0.002)
    assert {place.face for place in found.worst_gouge} == {"1", "2"}
    assert found.gouge_max == pytest.approx(0.004, abs=4e-4)


def test_a_high_step_is_an_edge():
    found = judged(missing_riser(0.03), along(-0.02, 0.0), 0.01)
    assert not found.passed
    assert found.gouge_max == pytest.approx(0.03, abs=1e-3)


@pytest.mark.parametrize("tolerance", [0.002, pytest.param(0.01, marks=pytest.mark.long)])
def test_a_face_behind_an_edge_that_stands_out(tolerance):
    """As the side of mousecover stands 0.0034 mm out over its top; deeper by a thousandth is found."""
    height = tolerance + 0.0034
    assert judged(proud_side(height), along(-0.5, 0.0), tolerance, "touching").passed
    assert judged(proud_side(height), along(0.0, 0.0), tolerance, "touching").passed
    deeper = judged(proud_side(0.0034), along(0.0, -tolerance - 0.0005), tolerance, "touching")
    assert not deeper.passed
    assert any("behind a convex edge" in reason for reason in deeper.reasons)
    # Into the side below its border, 1.2 mm from it: nothing is taken off there.
    beside = np.array([[4.0 - tolerance - 0.001, -3.0, -5.5], [4.0 - tolerance - 0.001, 3.0, -5.5]])
    aside = judged(proud_side(0.0034, 8.0), beside, tolerance, "touching")
    assert not aside.passed
    assert aside.gouge_max == pytest.approx(tolerance + 0.001, abs=3e-4)


def test_a_wall_gets_nothing():
    """A face that rises beside the lower one is no seam, however small the step under its border."""
    faces = (strip(1, (-8.0, 0.0), (0.0, 0.0)), strip(2, (0.0, 0.006), (4.0, 4.006)))
    tips = along(-4.0 * np.tan(np.radians(22.5)) + 0.008, 0.0)
    found = judged(faces, tips, 0.002)
    assert not found.passed
    assert found.gouge_max == pytest.approx((0.008 + 0.006) / np.sqrt(2.0), abs=2e-4)


def part_of(faces):
    at = np.linspace(0, 1, 33)
    y = 16.0 * at - 8.0
    border = Border((1, 2), np.column_stack([0 * y, y, 0 * y]), np.column_stack([0 * at + 1, at]),
                    np.column_stack([0 * at, at]), True, False)
    return Part.from_faces(faces, edges_from_borders(Part.from_faces(faces, ()).faces, [border]))


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("kind", ["seam", "edge"])
def test_planner_and_judge_take_off_the_same(kind, seed):
    """What the planner proves to be within a tolerance the judge passes, beside steps of any height and place."""
    rng = np.random.default_rng(seed)
    height, tolerance = 10.0 ** rng.uniform(-3.2, -1.75), (0.002, 0.01)[seed % 2]
    faces = missing_riser(height) if kind == "seam" else proud_side(height)
    part = part_of(faces)
    groups = {group.role: group for group in group_surroundings(part.faces[0], Tolerance(gouge=tolerance), part=part)}
    role = SKIN if kind == "seam" else TOUCHING
    x = rng.uniform(-0.4, 0.4)
    tips = along(x, -rng.uniform(0, tolerance))
    cells = groups[role].cells
    planned = segment_penetration(BALL, tips, UP, cells).max()
    found = judged(part.faces, tips, tolerance, role)
    top = segment_penetration(BALL, tips, UP, groups[SKIN].cells).max()
    about = (height, x, tips[0][2], planned, found.gouge_max)
    if max(planned, top) <= tolerance:
        assert found.passed, about
    if found.gouge_max > tolerance:
        assert found.gouge_max <= max(planned, top) + 1e-4, about


def test_without_a_step_the_depth_is_that_of_the_third_judge():
    solid = stair(0.0, riser=False)
    tips = np.array(along(0.1, -0.005))
    truth, _ = depth_of_cut(solid, BALL.profile, tips, UP, [[-1, -2, -0.2], [1, 2, 0.2]])
    assert judged(solid.faces[:2], tips, 0.002).gouge_max == pytest.approx(truth, rel=0.05)


def test_steps_near_places_are_those_of_the_whole_border_near_them():
    high, low = missing_riser(0.007)[::-1]
    whole = seams.steps_of(high, (low, high))
    place = whole.point[len(whole.point) // 3]
    near = seams.steps_of(high, (low, high), place[None])
    far = np.linalg.norm(whole.point - place, axis=1)
    assert len(whole.height) > len(near.height) > 0
    assert np.array_equal(near.point, whole.point[far <= 2 * seams.REACH + seams.SPACING])


def test_the_steps_of_two_faces_are_worked_out_once(monkeypatch):
    high, low = missing_riser(0.007)[::-1]
    found = seams.steps_of(high, (low,))
    monkeypatch.setattr(seams, "nearest", None)
    assert np.array_equal(seams.steps_of(high, (low,)).height, found.height)
