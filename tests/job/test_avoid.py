"""Faces that no tool may touch: walls to all others, however they meet them; planner and judge alike."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.surroundings import OTHER, group_surroundings
from toolaxis.job.files.plan_folder import read_plan, stage_folder, write_plan
from toolaxis.job.inputs.spec import choose_faces, numbers_to_avoid
from toolaxis.job.output.verify import verify_plan
from toolaxis.plan.document import plan_from
from toolaxis.plan.plan import Plan
from toolaxis.regions.open_places import list_open_places, what_closes
from toolaxis.tolerances import Tolerance

CLEAR = Tolerance().cutter_clearance
SCALLOP, LIMITS = 0.3, "cone:0,0,1,4"


def strip(x0: float, x1: float, bend: float = 0.0) -> ta.Face:
    """A patch of 14 mm across, level at x = 0, where its neighbour joins it smoothly, and bent up or down beyond."""
    x, y = np.meshgrid(np.linspace(x0, x1, 6), np.linspace(0, 14, 6), indexing="ij")
    rise = bend * x**2
    rise[1] = rise[0]  # the first two rows of control points state the slope at x0
    return ta.Face.from_bspline(np.stack([x, y, rise + 0.002 * (y - 7) ** 2], axis=-1))


def pair(bend: float = 0.0) -> ta.Part:
    """A face, 1, and one that goes on smoothly beyond its side x = 0, 2."""
    part = ta.Part.from_faces([strip(-16, 0), strip(0, 12, bend)])
    assert [edge.kind for edge in part.edges] == ["tangent"]
    return part


def made(tool: ta.Tool, bend: float = 0.0, **more: object) -> Plan:
    return ta.plan(pair(bend), tool, SCALLOP, faces=[1], avoid=[2], limits=LIMITS, **more)


def written(plan: Plan, folder: Path) -> Path:
    with stage_folder(folder) as stage:
        write_plan(plan, stage.folder)
        stage.publish()
    return folder


BALL, FLAT = ta.Tool.ball(diameter=8, stickout=40), ta.Tool.torus(diameter=8, corner_radius=1, stickout=40)


@pytest.fixture(scope="module")
def beside_seam() -> Plan:
    return made(BALL)


def test_an_avoided_face_is_a_wall_whatever_edge_it_shares() -> None:
    part = pair().avoid_faces([2])
    (own, wall) = group_surroundings(part.face(1), Tolerance(), part=part)
    assert [face.number for face in own.faces] == [1] and [face.number for face in wall.faces] == [2]
    assert wall.role == OTHER and wall.required[0] == CLEAR
    assert part.skin(1) == (part.face(1),) and part.neighbours(1) == ()
    assert pair().neighbours(1) == (2,), "the same part without"


def test_the_default_selection_leaves_avoided_faces_out() -> None:
    part = pair().avoid_faces([2])
    assert [face.number for face in choose_faces(part, None)] == [1]
    assert [face.number for face in choose_faces(part, "all")] == [1]
    with pytest.raises(InvalidInput, match="face 2 is to be machined and to be avoided"):
        choose_faces(part, [1, 2])


def test_avoided_faces_are_joined_to_nothing_that_is_machined() -> None:
    with pytest.raises(InvalidInput, match="face 2 is to be machined and to be avoided"):
        ta.join(pair().avoid_faces([2]), (1, 2))
    joined = ta.join(pair(), (1, 2)).avoid_faces([1])
    assert joined.avoided == (1,) and joined.original is not None and joined.original.avoided == (1, 2)
    assert ta.join(pair().avoid_faces([1, 2]), (1, 2)).avoided == (1,)


@pytest.mark.parametrize("given, numbers",
                         [(None, ()), ("", ()), ("3,5-7", (3, 5, 6, 7)), ([7, 3, 7], (3, 7)), (4, (4,))])
def test_numbers_to_avoid(given: object, numbers: tuple[int, ...]) -> None:
    assert numbers_to_avoid(given) == numbers


@pytest.mark.parametrize("given", [[1.5], ["a"], [True], "x", "1+2", "all"])
def test_what_is_no_number_of_a_face_is_refused(given: object) -> None:
    with pytest.raises(InvalidInput, match="to be avoided"):
        numbers_to_avoid(given)


def test_passes_end_where_a_ball_would_come_nearer_than_its_clearance(beside_seam: Plan) -> None:
    (op,) = beside_seam.operations
    assert op.done, op.orientation.reasons
    centre = op.path.cl + BALL.radius * op.path.axis
    wall = pair().face(2)
    points = wall.evaluate(wall.grid(120, 120)).point
    nearest = np.linalg.norm(centre[:, None] - points[None], axis=2).min() - BALL.radius
    assert nearest > CLEAR - 1e-3
    (zone,) = [zone for zone in op.zones if zone.at_wall]
    wide = np.sqrt(2 * BALL.radius * CLEAR)
    assert zone.avoided == ("2",) and wide < zone.area / 14 < 1.5 * wide
    (said,) = [why for why in op.orientation.reasons if "beside face 2" in why]
    assert said == f"{zone.area:.2f} mm2 beside face 2, which is to be avoided, is left as rest material"
    (open_,) = list_open_places(beside_seam)
    assert what_closes(open_, 4.0) == "nothing: it lies beside face 2, which is to be avoided"


def test_the_judge_passes_the_plan_and_measures_the_clearance(beside_seam: Plan) -> None:
    verdict = ta.verify(beside_seam)
    assert verdict.passed, verdict.reasons
    room = verdict.operations[0].clearance["cutter"]
    assert room.face == "2" and room.distance >= CLEAR


def test_a_plan_made_without_is_refused_by_the_judge(beside_seam: Plan, tmp_path: Path) -> None:
    """The judge goes by plan.json: passes up to the seam touch the face beyond it."""
    plain = ta.plan(pair(), BALL, 0.1, faces=[1], limits=LIMITS)
    assert ta.verify(plain).passed
    read = read_plan(written(replace(plain, inputs=replace(plain.inputs, avoid=(2,))), tmp_path / "plan"))
    assert read.part.avoided == (2,)
    verdict = verify_plan(read)
    assert not verdict.passed and "face 2" in verdict.reasons[0] and "needed 0.1 mm" in verdict.reasons[0]
    itself = replace(plain, inputs=replace(plain.inputs, avoid=(1,)))
    found = verify_plan(read_plan(written(itself, tmp_path / "itself")))
    assert not found.passed and "machines face 1, which is to be avoided" in found.reasons[0]


@pytest.mark.parametrize("bend", [0.02, -0.03])
def test_a_torus_keeps_clear_of_what_rises_and_of_what_falls(bend: float) -> None:
    plan = made(FLAT, bend)
    (op,) = plan.operations
    assert op.done, op.orientation.reasons
    assert any(zone.avoided == ("2",) for zone in op.zones)
    verdict = ta.verify(plan)
    assert verdict.passed, verdict.reasons
    assert verdict.operations[0].clearance["cutter"].distance >= CLEAR


def test_an_avoided_face_behind_a_convex_edge_is_kept_clear_of() -> None:
    cq = pytest.importorskip("cadquery")
    part = ta.load(cq.Workplane().box(14, 10, 10))
    top = next(f for f in part.faces if np.allclose(f.evaluate(f.grid(2, 2)).point[:, 2], 5))
    side = next(f for f in part.faces if np.allclose(f.evaluate(f.grid(2, 2)).point[:, 0], 7))
    plain = ta.plan(part, FLAT, SCALLOP, faces=[top.number], limits=LIMITS)
    kept = ta.plan(part, FLAT, SCALLOP, faces=[top.number], avoid=[side.number], limits=LIMITS)
    assert not plain.operations[0].zones
    (zone,) = kept.operations[0].zones
    assert zone.avoided == (side.label,) and zone.at_wall
    verdict = ta.verify(kept)
    assert verdict.passed and verdict.operations[0].clearance["cutter"].distance >= CLEAR, verdict.reasons


def test_plan_json_carries_the_faces_and_reads_them_back(beside_seam: Plan, tmp_path: Path) -> None:
    folder = written(beside_seam, tmp_path / "plan")
    document = json.loads((folder / "plan.json").read_text())
    assert document["inputs"]["avoid"] == [2]
    assert document["operations"][0]["zones"][0]["avoided"] == ["2"]
    read = read_plan(folder)
    assert read.inputs.avoid == (2,) and read.part.avoided == (2,) and read.operations[0].zones[0].avoided == ("2",)
    del document["inputs"]["avoid"], document["operations"][0]["zones"][0]["avoided"]  # a plan of an earlier version
    old = plan_from(document, pair(), (), [op.path for op in beside_seam.operations])
    assert old.inputs.avoid == () and old.part.avoided == ()


def test_a_rack_keeps_clear_too_and_tells_what_stays() -> None:
    plan = ta.plan(pair(), [BALL, ta.Tool.ball(diameter=4, stickout=30)], SCALLOP, avoid="2", limits=LIMITS)
    assert {op.face.number for op in plan.operations} == {1} and any(op.done for op in plan.operations)
    assert {label for op in plan.operations for zone in op.zones for label in zone.avoided} == {"2"}
    verdict = ta.verify(plan)
    assert verdict.passed, verdict.reasons
