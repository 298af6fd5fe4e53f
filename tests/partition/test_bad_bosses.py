"""Faces that cannot be divided around what stands on them: every one ends in a sentence, none in a wrong plan."""

import numpy as np
import pytest

import toolaxis as ta

cq = pytest.importorskip("cadquery")
BALL = ta.Tool.ball(diameter=6, stickout=40)


def top(part: ta.Part, height: float) -> ta.Face:
    flat = [face for face in part.faces if face.kind == "plane"]
    return next(face for face in flat if np.allclose(face.evaluate(face.outline[0]).point[:, 2], height))


def test_a_boss_that_covers_the_face_leaves_nothing_to_machine() -> None:
    part = ta.load(cq.Workplane().box(20, 20, 10).faces(">Z").workplane().rect(19.6, 19.6).extrude(30))
    plan = ta.plan(part, BALL, 0.2, faces=[top(part, 5).number], machine="cone:0,0,1,5")
    (op,) = plan.operations
    assert plan.outcome == "incomplete" and not op.done
    assert op.orientation.outcome in ("infeasible", "not_found") and op.orientation.reasons


def test_an_obstacle_that_covers_the_face_leaves_nothing_to_machine() -> None:
    part, lid = ta.load(cq.Workplane().box(20, 20, 10)), ta.load(cq.Workplane().box(30, 30, 4).translate((0, 0, 7)))
    plan = ta.plan(part, BALL, 0.2, faces=[top(part, 5).number], obstacles=lid, machine="cone:0,0,1,5")
    assert plan.outcome == "incomplete" and plan.operations[0].orientation.reasons
    with pytest.raises(ta.InvalidInput, match="cannot be divided"):
        ta.partition(top(part, 5), BALL, 0.2, 3, obstacles=lid, part=part, machine="cone:0,0,1,5")


def test_an_obstacle_that_touches_the_face_is_kept_off() -> None:
    part, post = ta.load(cq.Workplane().box(34, 24, 10)), ta.load(cq.Workplane().circle(3).extrude(14)
                                                                  .translate((0, 0, 5)))
    plan = ta.plan(part, BALL, 0.2, faces=[top(part, 5).number], obstacles=post, machine="cone:0,0,1,4")
    (op,) = plan.operations
    assert op.done, op.orientation.reasons
    assert op.orientation.clearance["cutter"] >= 0.1 and op.zones
    assert 0.05 < op.orientation.unreached < 0.5
    assert ta.verify(plan).passed


def test_a_full_sphere_says_why_it_cannot_be_machined_with_one_axis() -> None:
    part = ta.load(cq.Workplane().sphere(10))
    (op,) = ta.plan(part, BALL, 0.2, regions=1).operations
    assert not op.done and op.orientation.outcome == "infeasible"
    assert "more than a hemisphere" in " ".join(op.orientation.reasons)


def test_a_part_without_a_sculptured_face_is_refused_with_the_remedy() -> None:
    part = ta.load(cq.Workplane().box(20, 20, 10))
    with pytest.raises(ta.InvalidInput, match=r"none of the part's 6 faces is sculptured.*choose faces"):
        ta.plan(part, BALL, 0.2)
    with pytest.raises(ta.InvalidInput, match="no sculptured face"):
        ta.partition(part, BALL, 0.2)


@pytest.mark.parametrize(("asked", "words"), [({"regions": 3}, "cannot be divided into 3 sub-surfaces"),
                                              ({"orientations": 2}, "no division was found that 2 axes can machine")])
def test_a_full_sphere_that_is_to_be_divided_is_refused_with_the_remedy(asked: dict[str, int], words: str) -> None:
    with pytest.raises(ta.InvalidInput, match=words + ".*smaller tool"):
        ta.plan(ta.load(cq.Workplane().sphere(10)), BALL, 0.2, machine="cone:0,0,1,10", **asked)


def test_an_open_shell_is_planned_with_a_warning() -> None:
    hill = cq.Workplane("XZ").moveTo(0, 0).lineTo(0, 8).spline([(8, 10), (16, 9), (24, 8)], includeCurrent=True) \
        .lineTo(24, 0).close().extrude(12)
    faces = [face for face in hill.faces().vals() if not (face.geomType() == "PLANE" and face.Center().z < 1)]
    part = ta.load(cq.Workplane(obj=cq.Shell.makeShell(faces)))
    assert [(body.kind, body.closed) for body in part.bodies] == [("shell", False)]
    assert any("open shell" in warning for warning in part.warnings)
    plan = ta.plan(part, BALL, 0.2, regions=2, machine="cone:0,0,1,5")
    assert len(part.sculptured) == 1 and len(plan.operations) == 2 and plan.outcome == "complete"
    assert sum(op.face.area for op in plan.operations) == pytest.approx(part.sculptured[0].area, rel=1e-6)
    assert any("open shell" in warning for warning in plan.part.warnings)
    assert ta.verify(plan).passed
