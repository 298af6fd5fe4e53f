"""The side that is held in a clamping: no tool goes there, and what of the faces lies in it is told apart."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cli.main import main
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.interference import InterferenceScene, stands_free
from toolaxis.feasibility.surroundings import OTHER, ROLES, group_surroundings
from toolaxis.job.files.plan_folder import read_plan, stage_folder, write_plan
from toolaxis.job.output.verify import verify_plan
from toolaxis.job.planning.held_side import cut_face, cut_faces
from toolaxis.plan.plan import Plan
from toolaxis.shape.half_space import HELD_SIDE, HalfSpace, parse_half_space
from toolaxis.tolerances import Tolerance
from toolaxis.verify.held_side import HeldSide, distance_to_held_side
from toolaxis.verify.revolved_solids import cutter_solid, frustum_solids

CLEAR = Tolerance()
TOOL = ta.Tool.torus(diameter=8, corner_radius=2, stickout=30, holder=[(12, 0), (12, 30)])


def sheet(x0: float = 0.0, x1: float = 24.0) -> ta.Face:
    """A patch, 16 mm across, that rises a little."""
    x, y = np.meshgrid(np.linspace(x0, x1, 6), np.linspace(0, 16, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, 0.1 * x + 0.4 * np.sin(y / 5)], axis=-1))


def made(held: str, **more: object) -> Plan:
    return ta.plan(sheet(), TOOL, 0.1, held=held, limits="cone:0,0,1,30", **more)


def written(plan: Plan, folder: Path) -> Path:
    with stage_folder(folder) as stage:
        write_plan(plan, stage.folder)
        stage.publish()
    return folder


def points_of(tool: ta.Tool) -> dict[str, np.ndarray]:
    """Points all over cutter and holder, tip at the origin, axis along z."""
    turn = np.linspace(0, 2 * np.pi, 181)
    arc = np.linspace(0, np.pi / 2, 40)
    low = np.column_stack([tool.flat_radius + tool.corner_radius * np.sin(arc),
                           tool.corner_radius * (1 - np.cos(arc))])
    outlines = {"cutter": np.vstack([[0, 0], low, [tool.radius, tool.flute_length]]), **tool.outlines}
    return {name: np.concatenate([np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full_like(turn, z)])
                                  for r, z in rows]) for name, rows in outlines.items()}


def frame(axis: np.ndarray) -> np.ndarray:
    """Rows are three directions across each other, the last one the axis."""
    x = np.cross(axis, [0.3, 0.9, 0.1])
    x /= np.linalg.norm(x)
    return np.array([x, np.cross(axis, x), axis])


@pytest.fixture(scope="module")
def clamped() -> Plan:
    return made("x<8")


@pytest.mark.parametrize("text, point, normal", [
    ("z<12.5", (0, 0, 12.5), (0, 0, -1)), ("Z > -3", (0, 0, -3), (0, 0, 1)), ("x<1e1", (10, 0, 0), (-1, 0, 0)),
    ("plane:1,2,3,0,4,0", (1, 2, 3), (0, 1, 0))])
def test_short_forms(text: str, point: tuple[float, ...], normal: tuple[float, ...]) -> None:
    side = parse_half_space(text)
    assert side.normal == pytest.approx(normal) and side.depth([point])[0] == pytest.approx(0)


@pytest.mark.parametrize("text", ["", "z", "z<", "z<x", "12<z", "z<nan", "z<inf", "plane:1,2,3", "plane:0,0,0,0,0,0",
                                  "w<3"])
def test_what_is_no_half_space_is_refused(text: str) -> None:
    with pytest.raises(InvalidInput, match="is not understood: write z<12"):
        parse_half_space(text)


def test_a_half_space_moves_with_the_part() -> None:
    side, points = parse_half_space("plane:1,2,3,1,-2,0.5"), np.random.default_rng(3).normal(0, 9, (20, 3))
    turn = np.eye(4)
    turn[:3, :3], turn[:3, 3] = frame(np.array([0.6, 0.0, 0.8])), (4, -1, 7)
    moved = side.transformed(turn).depth(points @ turn[:3, :3].T + turn[:3, 3])
    np.testing.assert_allclose(moved, side.depth(points), atol=1e-12)


def test_the_plane_lies_beside_the_part_and_is_larger_than_tools_reach() -> None:
    side, part = parse_half_space("plane:1,2,3,1,-2,0.5"), ta.Part.from_faces([sheet()])
    plane = side.plane_beside(part.box)
    corners = plane.evaluate(plane.outline[0]).point
    np.testing.assert_allclose(side.depth(corners), 0, atol=1e-9)
    assert plane.label == HELD_SIDE and np.linalg.norm(corners - part.box.mean(axis=0), axis=1).min() > 500


@pytest.mark.parametrize("text, left", [("x<5", 150.0), ("x>5", 50.0), ("x<-1", 200.0),
                                        ("plane:0,0,0,1,1,0", None), ("plane:10,0,0,1,2,0", 25.0)])
def test_a_face_is_cut_where_the_held_side_begins(text: str, left: float | None) -> None:
    flat = ta.Face.from_bspline(np.array([[[0, 0, 0], [0, 10, 0]], [[20, 0, 0], [20, 10, 0.0]]]), degree=(1, 1))
    side = parse_half_space(text)
    found = cut_face(flat, side)
    if left is None:
        assert found is None
        return
    assert found is not None and found.area == pytest.approx(left, rel=1e-6)
    assert side.depth(found.evaluate(found.grid(40, 40)).point).max() < 1e-6
    assert (found is flat) == (left == 200.0) and found.number == flat.number and found.label == flat.label


def test_areas_of_a_bent_face_add_up() -> None:
    bent = sheet()
    part = ta.Part.from_faces([bent])
    free, (held,) = cut_faces(part.hold_side(parse_half_space("plane:9,7,1,1,0.4,0.3")), [bent])
    (other,), (rest,) = cut_faces(part.hold_side(parse_half_space("plane:9,7,1,-1,-0.4,-0.3")), [bent])
    assert not held.whole and free[0].area + held.area == pytest.approx(bent.area, rel=1e-9)
    assert other.area == pytest.approx(held.area, rel=1e-6) and rest.area == pytest.approx(free[0].area, rel=1e-6)


def test_a_tool_that_is_all_inside_stands_not_free() -> None:
    """The plane alone does not tell: nothing of such a tool is near it."""
    part = ta.Part.from_faces([sheet()]).hold_side(parse_half_space("z<300"))
    groups = group_surroundings(part.face(1), CLEAR, part=part)
    (wall,) = [group for group in groups if group.role == OTHER]
    assert [face.label for face in wall.faces] == [HELD_SIDE]
    scene = InterferenceScene((1,), TOOL, (wall,), ())
    places = np.array([[10, 8, 20.0], [10, 8, 299.0], [10, 8, 300.05], [10, 8, 301.2]])
    free = stands_free(scene, places, np.array([0, 0, 1.0]), (True, ROLES))
    assert free.tolist() == [False, False, False, True]


def test_the_judge_measures_as_points_of_the_tool_do() -> None:
    rng = np.random.default_rng(5)
    for _ in range(12):
        axis, normal = (one / np.linalg.norm(one) for one in rng.normal(0, 1, (2, 3)))
        tips, held = rng.normal(0, 30, (4, 3)), HeldSide(rng.normal(0, 9, 3), normal)
        cl = tips, np.tile(axis, (4, 1)), np.ones(4, dtype=np.int8)
        points = points_of(TOOL)
        for name, solids in (("cutter", cutter_solid(TOOL.profile)),
                             *((name, frustum_solids(rows, name)) for name, rows in TOOL.outlines.items())):
            at = points[name] @ frame(axis)
            depth = (tips[:, None] + at[None] - held.point) @ normal
            found = distance_to_held_side(cl, solids, held)
            assert found.distance == pytest.approx(-depth.max(), abs=0.02) and found.distance <= -depth.max() + 1e-9


def test_turning_motions_count_between_their_ends() -> None:
    """The tool swings through the upright: that is where it comes nearest to what is held above it."""
    axes = np.array([[np.sin(a), 0, np.cos(a)] for a in (-0.6, 0.6)])
    cl = np.zeros((2, 3)), axes, np.ones(2, dtype=np.int8)
    held = HeldSide(np.array([0, 0, 61.0]), np.array([0, 0, 1.0]))
    holder = frustum_solids(np.array([[0.5, 30], [0.5, 60]]), "holder")
    found = distance_to_held_side(cl, holder, held)
    assert 0.995 < found.distance <= 1.0, "upright, half way, it is highest"


def test_passes_stay_out_of_the_held_side(clamped: Plan) -> None:
    (op,) = clamped.operations
    assert op.done, op.orientation.reasons
    for name, points in points_of(op.tool).items():
        needed = {"cutter": CLEAR.cutter_clearance, "shank": CLEAR.shank_clearance}.get(name, CLEAR.holder_clearance)
        lowest = (op.path.cl[:, None] + (points @ frame(op.path.axis[0]))[None])[..., 0].min() - 8
        assert lowest >= needed - 1e-6, name
    assert op.face.evaluate(op.face.grid(30, 30)).point[:, 0].min() >= 8
    (zone,) = [zone for zone in op.zones if zone.at_wall]
    assert zone.avoided == (HELD_SIDE,)
    assert f"{zone.area:.2f} mm2 beside the clamped side is left as rest material" in op.orientation.reasons


def test_what_is_held_is_told_apart_from_what_is_open(clamped: Plan, tmp_path: Path) -> None:
    (held,) = clamped.held
    assert held.face == 1 and not held.whole and held.area == pytest.approx(sheet(0, 8).area, rel=0.02)
    assert clamped.account.area + held.area == pytest.approx(sheet().area, rel=1e-9)
    other = made("x>12")
    assert sum(one.area for one in other.held) == pytest.approx(sheet(12, 24).area, rel=0.02)
    document = json.loads((written(clamped, tmp_path / "plan") / "plan.json").read_text())
    assert document["inputs"]["held"] == "x<8"
    assert document["part"]["held"] == [{"face": 1, "label": "1", "area": held.area, "whole": False}]
    read = read_plan(tmp_path / "plan")
    assert read.held == clamped.held and read.part.held is not None and read.inputs.held == "x<8"


def test_the_judge_passes_it_and_refuses_passes_that_do_not_know_of_it(clamped: Plan, tmp_path: Path) -> None:
    verdict = ta.verify(clamped)
    assert verdict.passed, verdict.reasons
    plain = made("")
    assert plain.held == () and ta.verify(plain).passed
    for k, side in enumerate(("x<8", "z<200")):  # across the plane, and all inside
        read = read_plan(written(replace(plain, inputs=replace(plain.inputs, held=side)), tmp_path / f"{k}"))
        found = verify_plan(read)
        assert not found.passed
        assert any("cutter is" in why and "inside the clamped side, needed 0.1 mm" in why for why in found.reasons)


def test_no_axis_comes_from_the_held_side() -> None:
    """A sheet is seen from both sides; from the one that is held nothing may come."""
    free = ta.plan(sheet(), TOOL, 0.1, held="z<-50")
    assert free.operations[0].done and free.operations[0].orientation.axis[2] > 0
    level = ta.plan(sheet(), TOOL, 0.1, held="z>50")
    assert level.operations[0].orientation.axis is None or level.operations[0].orientation.axis[2] <= 1e-9
    assert free.operations[0].orientation.axis[2] > 0.5, "which is what it takes where that is free"


def test_whole_faces_that_are_held_get_no_operation() -> None:
    part = ta.Part.from_faces([sheet(), sheet(40, 52)])
    plan = ta.plan(part, TOOL, 0.1, held="x>30", limits="cone:0,0,1,30")
    assert [op.face.number for op in plan.operations] == [1] and plan.outcome == "complete"
    assert [(one.face, one.whole) for one in plan.held] == [(2, True)]


def test_a_rack_keeps_out_of_it_on_skins_too() -> None:
    part = ta.Part.from_faces([sheet(0, 12), sheet(12, 24)])
    tools = [TOOL, ta.Tool.ball(diameter=3, stickout=20)]
    plan = ta.plan(part, tools, 0.1, held="x<4", limits="cone:0,0,1,30")
    assert any(op.done for op in plan.operations) and sum(one.area for one in plan.held) > 0
    verdict = ta.verify(plan)
    assert verdict.passed, verdict.reasons


def test_sub_surfaces_given_by_hand_do_not_go_with_it() -> None:
    with pytest.raises(InvalidInput, match="a clamped side does not go with sub-surfaces given by hand"):
        made("x<8", division=[ta.SubSurface(1)])


def test_the_command_tells_what_is_held(sheet_file: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code = main(["plan", sheet_file, "--tool", "ball:8", "--scallop", "0.1", "--held", "y<5",
                 "--limits", "cone:0,0,1,30", "--out", str(tmp_path / "out"), "--no-pictures", "--workers", "1"])
    assert code == 0
    out = capsys.readouterr()
    assert "clamped in this setup (y<5) and not asked for:" in out.out + out.err


def test_a_half_space_is_what_is_deep_in_it() -> None:
    side = HalfSpace(np.zeros(3), np.array([0, 0, 1.0]))
    np.testing.assert_array_equal(side.depth([[5, 5, 2], [1, 1, -3]]), [2, -3])
    assert side.depth(np.empty((0, 3))).shape == (0,)
