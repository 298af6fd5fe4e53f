"""Feasibility: reasons and amounts against dense points, walls, and the proof form between samples."""

from math import radians
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.contact.placement import place
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.point_check import deepest, deepest_numpy
from toolaxis.feasibility.surroundings import OTHER, SKIN, TOUCHING, group_surroundings
from toolaxis.feasibility.violations import BACK, CUTTER, FREE, GOUGE, HOLDER, LIMITS, WANDERS
from toolaxis.machine.limits import parse_limits
from toolaxis.numeric.vectors import angle_between, rotation, unit
from toolaxis.search.direction_grid import spiral
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"

TOOL = Tool.torus(8, 1)
HELD = Tool.torus(8, 1, stickout=30, holder=[(12, 0), (12, 30)])


def judge(face, tool=TOOL, limits=None, tolerance=None, **around):
    tolerance = Tolerance.of(tolerance)
    return Feasibility(face, tool, group_surroundings(face, tolerance, **around), tolerance, limits)


def depth_by_points(face, tool, axis, extra=()):
    """Depth of dense points of the face inside a torus that stands at dense contacts: slow, and nothing shared."""
    even = [np.stack(np.meshgrid(*[np.linspace(0, 1, n)] * 2), axis=-1).reshape(-1, 2) for n in (49, 13)]
    points, uv = face.evaluate(even[0]).point, np.concatenate([even[1], *extra])
    a, r, worst = tool.radius - tool.corner_radius, tool.corner_radius, 0.0
    for tip in place(face, tool, uv, axis):
        z = (points - tip) @ axis
        rho = np.linalg.norm(points - tip - z[:, None] * axis, axis=1)
        arc = np.where(rho < a, -z, np.where(z < r, np.hypot(rho - a, z - r) - r, rho - a - r))
        worst = max(worst, -float(arc.min()))
    return worst


@pytest.mark.parametrize("seed", range(3))
def test_reasons_follow_from_normals_limits_and_dense_points(make, seed):
    face = make.seeded(seed, 1.6)
    limits = parse_limits("cone:0,0,1,60")
    judged = judge(face, limits=limits)
    axes = spiral(np.eye(3), radians(16))
    found = judged.screen(axes)
    dense = face.normal(face.grid(120, 120))
    for axis, reason, amount in zip(axes, found.reason, found.amount, strict=True):
        angle = angle_between(dense, axis)
        if reason == LIMITS:
            assert abs(amount - (angle_between(axis, np.array([0, 0, 1.0])) - radians(60))) < 1e-9
        elif reason == BACK:
            assert angle.max() > np.pi / 2 - 0.02
        elif reason == WANDERS:
            assert angle.min() < radians(0.5) + 0.03
        elif reason == GOUGE:
            assert depth_by_points(face, TOOL, axis, [judged.sparse.uv]) > 0.7 * amount
        else:
            assert reason == FREE and limits.allowed(axis)[0]
    assert {LIMITS, FREE} <= set(found.reason.tolist())


@pytest.mark.parametrize("tolerance", [0.002, 0.01])
@pytest.mark.parametrize("seed", range(3))
def test_what_is_proven_does_not_gouge_at_dense_points(make, seed, tolerance):
    face = make.seeded(20 + seed, 1.2)
    judged = judge(face, tolerance=tolerance)
    proven = [axis for axis in spiral(np.eye(3), radians(18), radians(50)) if judged.witness(axis) is None]
    assert proven
    for axis in proven[::6]:
        assert depth_by_points(face, TOOL, axis) <= tolerance


def test_screening_errs_towards_free_only(make):
    face = make.seeded(7, 1.5)
    judged = judge(face)
    axes = spiral(np.eye(3), radians(15), radians(60))
    screened = judged.screen(axes).reason
    for axis, reason in zip(axes, screened, strict=True):
        if judged.witness(axis) is None:
            assert reason == FREE


def test_an_axis_that_meets_a_normal_between_samples_is_found(make):
    face = make.seeded(1, 0.8)
    judged = judge(face)
    axis = face.normal(np.array([[0.51327, 0.47771]]))[0]
    witness = judged.witness(axis)
    assert witness is not None and witness.reason == WANDERS
    assert abs(witness.amount - radians(0.5)) < 1e-3


def test_a_ball_may_stand_upright(make):
    face = make.seeded(1, 0.8)
    axis = face.normal(np.array([[0.5, 0.5]]))[0]
    assert judge(face, Tool.ball(8)).witness(axis) is None


def test_tapered_cutters_see_less(make):
    face = make.patch(np.zeros((4, 4)))
    axis = np.array([np.sin(radians(75)), 0, np.cos(radians(75))])
    assert judge(face, Tool.torus(8, 1)).witness(axis) is None
    witness = judge(face, Tool.tapered(8, 1, 20)).witness(axis)
    assert witness is not None and witness.reason == BACK and abs(witness.amount - radians(5)) < 1e-6


def test_verdicts_move_with_face_and_axis(make):
    face, turn = make.seeded(3, 1.5), rotation([1, -1, 2], 0.8)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, [10, 20, -5]
    axes = spiral(np.eye(3), radians(18))
    one, other = judge(face).screen(axes), judge(face.transformed(matrix)).screen(axes @ turn.T)
    assert (one.reason == other.reason).all()
    np.testing.assert_allclose(one.amount, other.amount, atol=1e-5)


def test_cloud_twin_agrees(make):
    face = make.seeded(5, 2.0)
    points = face.evaluate(face.grid(12, 12)).point
    for axis in spiral(np.eye(3), radians(20), radians(60)):
        tips = place(face, TOOL, face.grid(5, 5), axis)
        assert abs(deepest(TOOL, axis, tips, points) - deepest_numpy(TOOL, axis, tips, points)) < 1e-9


def test_groups_sort_faces_by_their_edges(make):
    part = make.floor_and_wall()
    groups = group_surroundings(part.faces[0], Tolerance(), part=part,
                                obstacles=make.flat([0, 0, 50], [5, 0, 0], [0, 5, 0]))
    assert [(g.role, len(g.faces)) for g in groups] == [(SKIN, 1), (TOUCHING, 1), (OTHER, 2)]
    assert groups[1].faces[0].number == 3
    np.testing.assert_allclose(groups[0].required, [-0.01, 0.5, 1.0])
    np.testing.assert_allclose(groups[2].required, [0.1, 0.5, 1.0])


@pytest.mark.parametrize("name", [pytest.param("blisk", marks=pytest.mark.long), "bosses"])
def test_faces_that_meet_the_skin_may_be_touched_but_not_walls(name):
    pytest.importorskip("OCP")
    part = ta.load(EXAMPLES / f"{name}.step")
    for face in part.sculptured[:6]:
        skin = {own.number for own in part.skin(face.number)}
        corners = [point for edge in part.edges if skin & set(edge.faces) for point in edge.polyline[[0, -1]]]
        met = {own for edge in part.edges for own in edge.faces
               if any(np.linalg.norm(end - point) <= 1e-6 * part.diagonal
                      for end in edge.polyline[[0, -1]] for point in corners)}
        walls = {number for own in skin for number in part.neighbours(own, "concave")}
        groups = group_surroundings(face, Tolerance(), part=part)
        found = {own.number for group in groups if group.role == TOUCHING for own in group.faces}
        assert found == met - walls - skin


def test_a_face_across_a_peak_may_be_touched(make):
    """Of four sheets around a peak two opposite ones share nothing but it."""
    sheets = []
    for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        corners = [[[i * x, j * y, -0.2 * (i + j)] for j in (0.0, 9.0)] for i in (0.0, 9.0)]
        sheets.append(Face.from_bspline(np.array(corners), (1, 1), flip=x * y < 0))
    part = Part.from_faces(sheets)
    assert part.neighbours(1, "convex") == (2, 4)
    groups = group_surroundings(part.faces[0], Tolerance(), part=part)
    assert [(group.role, sorted(face.number for face in group.faces)) for group in groups] == [
        (SKIN, [1]), (TOUCHING, [2, 3, 4])]


def test_obstacles_must_be_faces(make):
    with pytest.raises(InvalidInput, match="obstacles"):
        group_surroundings(make.seeded(1), Tolerance(), obstacles=7)


def test_next_to_a_wall_the_zone_the_cutter_covers_is_left(make):
    part = make.floor_and_wall()
    judged = judge(part.faces[0], part=part)
    axis = unit([0, -0.3, 1.0])
    assert judged.witness(axis) is None
    share = judged.unreached(axis)
    assert 0.02 < share < 0.5
    v = np.linspace(0.02, 0.98, 49)
    reach = judged.reach(np.stack([0.5 + 0 * v, v], axis=1), axis)
    border = v[~reach].min()
    y = part.faces[0].evaluate(np.array([[0.5, border]])).point[0, 1]
    assert reach[v < border].all() and not reach[v > border].any()
    away = 15 - y
    foot = -(TOOL.radius - TOOL.corner_radius) * np.cos(np.arctan(0.3))  # the far side of the bottom leans over
    assert abs(away - (-2 * foot + 0.1)) < 2.0


def test_leaning_into_a_wall_forbids(make):
    part = make.floor_and_wall()
    witness = judge(part.faces[0], HELD, part=part).witness(unit([0, 1.0, 1.0]))
    assert witness is not None and witness.reason >= CUTTER and witness.label == "2"


def test_a_low_holder_meets_the_wall_and_says_where(make):
    part = make.floor_and_wall(height=60)
    witness = judge(part.faces[0], HELD, part=part).witness(unit([0.35, -0.02, 1.0]))
    assert witness is not None and witness.reason == HOLDER and witness.label == "2"
    assert abs(witness.point[1] - 15) < 0.1


def test_a_face_over_a_convex_edge_is_no_wall(make):
    part = make.floor_and_wall()
    only = make.floor_and_wall().faces
    judged = judge(part.faces[0], part=part)
    axis = unit([0.3, -0.5, 1.0])
    near = np.array([[0.5, 0.001]])
    assert judged.reach(near, axis)[0]
    walled = judge(only[0], surroundings=only[1:])
    assert not walled.reach(near, axis)[0]


def test_watched_contacts_are_screened_too(make):
    face = make.seeded(3, 3.0)
    judged = judge(face)
    uv = np.random.default_rng(0).random((400, 2))
    missed = np.flatnonzero(judged.quick(face.normal(uv))[0] == FREE)
    assert len(missed)
    more = judged.watching(uv[missed[:1]])
    assert len(more.sparse.uv) == len(judged.sparse.uv) + 1
    assert more.screen(face.normal(uv[missed[:1]])).reason[0] == WANDERS


def test_room_is_the_clearance_beyond_what_is_required(make):
    face = make.patch(np.zeros((4, 4)))
    roof = make.flat([-60, -60, 38], [0, 120, 0], [120, 0, 0])
    held = Tool.torus(8, 1, stickout=30, holder=[(12, 0), (12, 5)])
    judged = judge(face, held, obstacles=roof)
    assert abs(judged.room(unit([0, 0.02, 1.0]), 50.0) - 2.0) < 0.4


def test_screening_refuses_an_axis_that_gouges_a_point_it_learnt(make):
    judged, axis = judge(make.seeded(0, 0.0)), unit(np.array([[0.1, 0.0, 1.0]]))
    assert judged.screen(axis).reason[0] == FREE
    contact = judged.sparse
    inside = contact.point[:1] + 0.05 * contact.normal[:1] + 0.2 * TOOL.radius * axis
    learnt = judged.learning(inside).screen(axis)
    assert learnt.reason[0] == GOUGE and learnt.amount[0] > 0.01
    assert judged.learning(inside - [[0, 0, 9]]).screen(axis).reason[0] == FREE
