"""Narrow faces that hardly an operation is worth: left to a clean-up tool as a whole, stated with their area."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cli.main import main
from toolaxis.job.files.plan_folder import read_plan, stage_folder, write_plan
from toolaxis.job.planning.clean_up_zones import WHOLLY, describe_zones
from toolaxis.job.planning.edit_axis import try_axis
from toolaxis.path.mending import FurtherPasses
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan, outcome_of
from toolaxis.plan.zone import Zone
from toolaxis.report.figures.plan_overview import overview_picture
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.messages import place
from toolaxis.shape.measure import mean_width

SLIM = ta.Tool.torus(diameter=8, corner_radius=1, stickout=30)


def leaving(op: Operation, share: float, at_wall: bool = True) -> tuple[Zone, ...]:
    u0, u1, v0, v1 = op.face.bounds
    u1 = u0 + share * (u1 - u0)
    loops = (np.array([[u0, v0], [u1, v0], [u1, v1], [u0, v1]]),)
    return (Zone(loops, share * op.face.area, at_wall),)


def test_a_narrow_face_is_left_as_a_whole_above_the_threshold(small_plan: Plan) -> None:
    (op,) = small_plan.operations
    assert 8 < mean_width(op.face) < 12 == 2 * small_plan.tools[0].radius
    kept = describe_zones(op, leaving(op, WHOLLY - 0.02))
    assert kept.done and not kept.left and kept.orientation.unreached == pytest.approx(WHOLLY - 0.02)
    gone = describe_zones(op, leaving(op, WHOLLY + 0.02))
    assert gone.left and not gone.done and gone.orientation.axis is None
    assert gone.orientation.passes == 0 and gone.orientation.unreached == 1.0
    assert sum(zone.area for zone in gone.zones) == pytest.approx(op.face.area, rel=1e-12)
    assert "92.0 % of it" in gone.orientation.reasons[0] and "entirely as rest material" in gone.orientation.reasons[0]
    assert outcome_of([kept, gone]) == "complete"
    assert outcome_of([kept, replace(gone, zones=())]) == "incomplete"


def test_a_face_that_is_wider_than_the_cutter_keeps_its_operation(small_plan: Plan) -> None:
    (op,) = small_plan.operations
    assert describe_zones(replace(op, tool=SLIM), leaving(op, 0.97)).done
    assert describe_zones(op, leaving(op, 0.97, at_wall=False)).done, "an undercut is no rest material"


def test_an_undercut_is_pointed_out_in_mm_and_once(small_plan: Plan) -> None:
    (op,) = small_plan.operations
    zones = leaving(op, 0.1, at_wall=False)
    made = describe_zones(describe_zones(op, zones), zones)
    (said,) = [why for why in made.orientation.reasons if why.startswith("undercut")]
    at = op.face.evaluate(zones[0].loops[0].mean(axis=0)[None]).point[0]
    assert f"{zones[0].area:.2f} mm2, around {place(at)}:" in said and not np.allclose(at, 0)
    assert made.done and made.orientation.unreached == 0, "no rest material: the judge will not overlook it"


def test_zones_are_those_that_the_proof_found(small_plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: they were looked for once more, without the places between passes at which the proof had looked."""
    whole, (op,) = FaceProblem.completed, small_plan.operations
    (seen,) = leaving(op, 0.001)

    def _completed(task: FaceProblem, *laid: Any) -> FurtherPasses:
        made = whole(task, *laid)
        return made._replace(zones=(*made.zones, seen))

    monkeypatch.setattr(FaceProblem, "completed", _completed)
    made = ta.plan(small_plan.part, small_plan.tools[0], 0.1, workers=1).operations[0]
    assert any(zone.loops is seen.loops for zone in made.zones)
    assert made.orientation.unreached == pytest.approx(sum(zone.area for zone in made.zones) / op.face.area)
    tried = try_axis(small_plan, op, op.orientation.axis)
    assert any(zone.loops is seen.loops for zone in tried.zones)


@pytest.mark.parametrize(("size", "wanted"), [((40.0, 3.0), 2 * 120 / 86), ((5.0, 5.0), 2.5)])
def test_the_mean_width_is_twice_the_area_over_the_border(size: tuple[float, float], wanted: float) -> None:
    x, y = size
    plane = ta.Face.from_bspline([[[0, 0, 0], [0, y, 0]], [[x, 0, 0], [x, y, 0]]], degree=(1, 1))
    assert mean_width(plane) == pytest.approx(wanted, rel=1e-9)


def test_a_closed_ring_is_as_wide_as_from_border_to_border() -> None:
    t = np.linspace(0, 2 * np.pi, 61)
    ring = ta.Face.from_bspline([[[9 * np.cos(a), 9 * np.sin(a), z] for z in (0, 2)] for a in t], degree=(3, 1))
    assert mean_width(ring) == pytest.approx(2.0, rel=0.05)


def post(fillet: float, length: float = 36, width: float = 30) -> ta.Part:
    cq = pytest.importorskip("cadquery")
    return ta.load(cq.Workplane().box(length, width, 10).faces(">Z").workplane().circle(4).extrude(12)
                   .edges(cq.selectors.BoxSelector((-5, -5, 4.5), (5, 5, 5.5))).fillet(fillet))


@pytest.fixture(scope="module")
def footed() -> Plan:
    """A floor with a post whose fillet is tighter than the cutter's corner, floor and fillet asked for."""
    part = post(0.4, 28, 24)
    floor = next(f for f in part.faces if np.allclose(f.evaluate(f.grid(4, 4)).point[:, 2], 5))
    fillet = next(f for f in part.faces if f.kind == "torus")
    return ta.plan(part, ta.Tool.torus(diameter=8, corner_radius=0.5, stickout=30), 0.1,
                   faces=[floor.number, fillet.number], machine="cone:0,0,1,5")


def test_a_fillet_tighter_than_the_corner_is_a_clean_up_face(footed: Plan, tmp_path: Path,
                                                             capsys: pytest.CaptureFixture[str]) -> None:
    floor, fillet = footed.operations
    assert footed.outcome == "complete" and floor.done and fillet.left
    assert "0.61 mm wide" in fillet.orientation.reasons[0] and "fillet of 0.40 mm" in fillet.orientation.reasons[0]
    assert fillet.zones[0].area == pytest.approx(fillet.face.area, rel=1e-12) == pytest.approx(16.5, abs=0.5)
    with stage_folder(tmp_path / "plan") as stage:
        write_plan(footed, stage.folder)
        stage.publish()
    again = read_plan(tmp_path / "plan")
    assert again.outcome == "complete" and again.operations[1].left
    assert main(["verify", str(tmp_path / "plan"), "--no-pictures"]) == 0
    assert "rest material" in capsys.readouterr().out
    assert overview_picture(footed).axes


@pytest.mark.parametrize(("radius", "cutter", "left"), [(2.0, 8, True), (2.0, 3.8, False)])
def test_a_fillet_tighter_than_the_cutter_is_left_where_no_axis_was_found(radius: float, cutter: float,
                                                                          left: bool) -> None:
    part = post(radius, 24, 20)
    fillet = next(face for face in part.faces if face.kind == "torus")
    plan = ta.plan(part, ta.Tool.torus(cutter, 0.5, stickout=30), 0.1, faces=[fillet.number], regions=1,
                   limits="cone:0,0,1,20")
    (op,) = plan.operations
    assert plan.outcome == "incomplete" and op.left == left and not op.done
    assert ("fillet of 2.00 mm radius, tighter than the cutter's 4 mm" in op.orientation.reasons[0]) == left


def test_a_face_that_is_merely_not_machined_stays_incomplete(footed: Plan) -> None:
    floor = footed.operations[0].face.number
    plan = ta.plan(footed.part, footed.tools[0], 0.1, faces=[floor], machine="cone:0,0,-1,1")
    assert plan.outcome == "incomplete" and not plan.operations[0].left


@pytest.mark.parametrize("asked", [{"regions": 2}, pytest.param({"orientations": 2}, marks=pytest.mark.long)])
def test_a_fillet_that_cannot_be_divided_does_not_refuse_the_part(footed: Plan, asked: dict[str, int]) -> None:
    numbers = [op.face.number for op in footed.operations]
    plan = ta.plan(footed.part, footed.tools[0], 0.1, faces=numbers, machine="cone:0,0,1,5", **asked)
    assert plan.outcome == "complete"
    assert [op.face.number for op in plan.operations if op.left] == numbers[1:]
    floor = [op for op in plan.operations if op.face.number == numbers[0]]
    assert sum(op.face.area for op in floor) == pytest.approx(footed.operations[0].face.area, rel=1e-6)
    assert len(floor) == 2 or "orientations" in asked
