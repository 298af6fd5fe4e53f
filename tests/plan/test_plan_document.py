"""A plan survives being written and read; a document that breaks the schema is refused with the place."""

import copy
import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from toolaxis.cad.shape_data import left_out
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.machine.work_coordinates import work_coordinates
from toolaxis.plan.baseline import Baseline
from toolaxis.plan.document import plan_document, plan_from
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import AxisMap, Orientation
from toolaxis.plan.part_document import part_document, part_from
from toolaxis.plan.plan import INDEX_SECONDS, Plan, PlanInputs
from toolaxis.plan.schema import check
from toolaxis.plan.zone import Zone
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool

FILES = {"part": {"file": "part.json", "sha256": "00"}, "obstacles": [], "operations": ["op01-face1.apt", None]}
BULL_NOSE = Tool.torus(12, 1, stickout=60, holder=[(10, 0), (10, 40)])
BALL = Tool.ball(6, stickout=40, title="Ball D6, 40 out", number=7, feedrate=900.0, spindle=12000.0)


def net(height: float) -> np.ndarray:
    x, y = np.meshgrid(np.linspace(0, 30, 4), np.linspace(0, 20, 5), indexing="ij")
    return np.stack([x, y, height * np.sin(x / 10) * np.cos(y / 7) + 1 / 3], axis=-1)


def example() -> Plan:
    loop = np.array([[0.1, 0.1], [0.9, 0.15], [0.8, 0.9]])
    part = Part.from_faces([Face.from_bspline(net(2.0)), Face.from_bspline(net(-3.0), trims=(loop,), flip=True)],
                           source="a list of control points")
    path = ToolPath(np.eye(3), np.eye(3), np.eye(3), np.eye(3),
                    np.array([Motion.LINK, Motion.CUT, Motion.CUT], dtype=np.int8), np.array([0, 3]))
    axis = np.array([0.0, 0.6, 0.8])
    found = AxisMap(np.eye(3), np.array([3.0, np.inf, 2.5]), np.array([30.0, np.inf, 25.0]),
                    np.array([0, 4, 0], dtype=np.int8), np.array([0.0, 0.125, 0.0]))
    lobe = Orientation(-axis, "v", 0, 3.25, np.inf, 1.5, np.inf, {"cutter": 1.0}, "feasible", (), 12)
    best = Orientation(axis, "u", 3, 2.75, 30.0, 1.7, 0.0015, {"cutter": 0.5, "holder": np.inf}, "feasible",
                       ("gouge limits",), 431, found, (lobe,), 0.01)
    piece = part.faces[0].trimmed((loop,), "1a")
    frame = work_coordinates(axis, np.array([[1.0, 0, 0]]), np.zeros(3), np.ones(3))
    return Plan(part, (BULL_NOSE, BALL),
                PlanInputs(0.02, tolerance=Tolerance(chord=0.001)),
                (Operation(1, piece, BULL_NOSE, best, path, frame,
                           (Zone((loop[::-1], 0.5 + loop / 10), 12.25, True, 0.125),)),
                 Operation(2, part.faces[1], BALL, Orientation(None, outcome="infeasible", reasons=("no axis",)))),
                (), np.zeros(3), "incomplete")


def written() -> dict[str, Any]:
    document: dict[str, Any] = json.loads(json.dumps(plan_document(example(), FILES), allow_nan=False))
    return document


def test_written_and_read_back_is_the_same() -> None:
    plan = example()
    document = written()
    check(document)
    part = part_from(json.loads(json.dumps(part_document(plan.part), allow_nan=False)))
    back = plan_from(document, part, (), [plan.operations[0].path, None])
    assert json.dumps(plan_document(back, FILES)) == json.dumps(document)
    uv = np.random.default_rng(1).random((50, 2))
    for mine, theirs in zip(back.operations, plan.operations, strict=True):
        assert np.array_equal(mine.face.evaluate(uv).suv, theirs.face.evaluate(uv).suv)
        assert np.array_equal(mine.face.normal(uv), theirs.face.normal(uv))
        assert np.array_equal(mine.face.contains(uv), theirs.face.contains(uv))
    first = back.operations[0].orientation
    assert first.map is not None and np.isinf(first.map.length[1]) and first.map.reason.tolist() == [0, 4, 0]
    assert first.clearance == {"cutter": 0.5, "holder": np.inf}
    (zone,) = back.operations[0].zones
    assert (zone.area, zone.at_wall, zone.elsewhere) == (12.25, True, 0.125) and back.operations[1].zones == ()
    assert all(map(np.array_equal, zone.loops, plan.operations[0].zones[0].loops))
    assert back.inputs == plan.inputs and back.outcome == "incomplete"
    assert [tool.name for tool in back.tools] == ["torus:12x1", "ball:6"] and back.not_checked == plan.not_checked
    assert [op.tool for op in back.operations] == list(back.tools)
    assert (back.tools[1].title, back.tools[1].number) == ("Ball D6, 40 out", 7)
    assert (back.tools[1].feedrate, back.tools[1].spindle) == (900.0, 12000.0)


def test_times_are_lengths_over_their_rates_and_survive() -> None:
    plan = example()
    axis, path = plan.operations[0].orientation.axis, plan.operations[0].path
    assert axis is not None and path is not None
    assert path.length(Motion.CUT) == pytest.approx(2 * 2**0.5) and plan.travel == 0
    whole = np.concatenate([path.cl, [[0.0, 0, 4], [0, 0, 104.0]]])
    longer = ToolPath(whole, whole, np.tile([0.0, 0, 1], (5, 1)), np.tile([0.0, 0, 1], (5, 1)),
                      np.array([Motion.LINK, Motion.CUT, Motion.CUT, Motion.EXIT, Motion.LINK], dtype=np.int8),
                      np.array([0, 5]))
    one = replace(plan.operations[0], path=longer)
    slow = 2 * 2**0.5 + 3
    assert one.travel == pytest.approx(103) and one.seconds(600, 6000) == pytest.approx(slow / 10 + 1)
    other = replace(one, orientation=replace(one.orientation, axis=-axis))
    several = replace(plan, operations=(one, other, other, one), inputs=PlanInputs(0.02, feedrate=600, rapid=6000))
    assert several.orientations == 2 and several.travel == pytest.approx(412)
    assert several.seconds == pytest.approx(4 * (slow / 10 + 1) + 2 * INDEX_SECONDS)
    row = Baseline("ball", "ball:12", 4, 3, 1, 31, 100.5, 20.25, 33.0, "no axis found")
    document = json.loads(json.dumps(plan_document(replace(plan, baselines=(row,)), FILES)))
    assert document["baselines"][0]["tool"] == "ball:12" and document["operations"][0]["seconds"] > 0
    assert plan_from(document, plan.part, (), [path, None]).baselines == (row,) and not row.complete


def test_what_was_not_given_is_named() -> None:
    assert example().not_checked == ("obstacles other than the part", "machine")
    bare = Plan(example().part, (Tool.ball(8),), PlanInputs(0.02), (), (), np.zeros(3), "complete")
    assert bare.not_checked == ("shank", "holder", "obstacles other than the part", "machine")


def test_faces_that_could_not_be_read_were_not_checked() -> None:
    """Nothing is kept clear of a face that was left out of the part, or of an obstacle."""
    plan = example()
    broken = plan.part.with_warnings(left_out("face 5", "its geometry is not finite"), "face 7: a small thing")
    one = replace(plan, part=broken)
    assert "1 face that could not be read" in one.not_checked
    assert "2 faces that could not be read" in replace(one, obstacles=(broken,)).not_checked


def _set(*place: Any, value: Any) -> Callable[[dict[str, Any]], None]:
    def change(document: dict[str, Any]) -> None:
        for key in place[:-1]:
            document = document[key]
        document[place[-1]] = value
    return change


def _drop(*place: Any) -> Callable[[dict[str, Any]], None]:
    def change(document: dict[str, Any]) -> None:
        for key in place[:-1]:
            document = document[key]
        del document[place[-1]]
    return change


@pytest.mark.parametrize("change, said", [
    (_set("version", value=1), "schema version 1: this program reads 2"),
    (_set("schema", value="other"), "plan.json.schema is 'other'"),
    (_drop("tools"), "plan.json has no 'tools'"),
    (_drop("operations", 0, "orientation", "gouge"), r"operations\[0\].orientation has no 'gouge'"),
    (_set("operations", 0, "orientation", "axis", 1, value="x"), r"operations\[0\].orientation.axis\[1\] is 'x'"),
    (_set("operations", 0, "orientation", "axis", value=[1, 0]), "axis has 2 items: 3 are needed"),
    (_set("operations", 1, "face", value=0), r"operations\[1\].face is 0: it must be at least 1"),
    (_set("operations", 1, "face", value=9), "face 9 does not exist: the part has 2 faces"),
    (_set("operations", 1, "face", value=True), r"face is True: integer is needed"),
    (_set("outcome", value="perhaps"), "outcome is 'perhaps': one of complete"),
    (_set("tools", 0, "colour", value="red"), "unknown 'colour'"),
    (_set("inputs", "scallop", value=-1.0), "scallop is -1.0"),
    (_set("operations", 0, "orientation", "clearance", value={"cutter": "far"}), "clearance.cutter is 'far'"),
])
def test_a_broken_document_is_refused(change: Callable[[dict[str, Any]], None], said: str) -> None:
    document = copy.deepcopy(written())
    change(document)
    with pytest.raises(InvalidInput, match=said):
        plan_from(document, example().part, (), [example().operations[0].path, None])


@pytest.mark.parametrize("values, said", [
    ({"scallop": 0.0}, "scallop is 0.0 mm"), ({"scallop": -0.1}, "scallop"), ({"scallop": np.nan}, "scallop is nan"),
    ({"scallop": 0.02, "allowance": -1.0}, "allowance is -1.0"), ({"scallop": 0.02, "feedrate": 0.0}, "feedrate"),
    ({"scallop": 0.02, "spindle": np.inf}, "spindle"),
    ({"scallop": 0.02, "direction": "up"}, "zigzag, climb or conventional"),
    ({"scallop": 0.02, "objective": "weight"}, "passes or time"),
])
def test_wrong_inputs(values: dict[str, Any], said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        PlanInputs(**values)


def test_a_scallop_not_below_the_radius_is_refused() -> None:
    PlanInputs(5.999).check_tool(Tool.torus(12, 1))
    with pytest.raises(InvalidInput, match="not below the cutter radius 6"):
        PlanInputs(6.0).check_tool(Tool.torus(12, 1))


@pytest.mark.parametrize("change, said", [(_set("schema", value="x"), "'toolaxis.part' version 1 is needed"),
                                          (_drop("faces", 0, "control"), "incomplete"),
                                          (_set("faces", 0, "degree", value=[3]), "incomplete")])
def test_a_broken_part_document_is_refused(change: Callable[[dict[str, Any]], None], said: str) -> None:
    document = json.loads(json.dumps(part_document(example().part)))
    change(document)
    with pytest.raises(InvalidInput, match=said):
        part_from(document)
