"""Plans with a rack of tools: what is chosen, what smaller tools take over, and how that is written, judged and posted.
"""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import Cancelled, InvalidInput
from toolaxis.job.files.plan_folder import read_plan, stage_folder, write_plan
from toolaxis.job.output.post import post_plan
from toolaxis.job.output.report import report
from toolaxis.job.output.verify import verdict_document
from toolaxis.job.planning import pipeline, planner
from toolaxis.job.planning import rack as rack_planning
from toolaxis.job.planning.planner import PlanningJob
from toolaxis.job.planning.rack import RackPlanner
from toolaxis.job.planning.rack_screening import LargestTools, RackScreening, ScreenedFace
from toolaxis.job.planning.sub_surfaces import Target
from toolaxis.job.planning.waiting import WaitingSurface, merge_waiting
from toolaxis.machine.setup import Mounting
from toolaxis.partition.partition import regions
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan
from toolaxis.post.context import Options
from toolaxis.progress import Progress
from toolaxis.regions.open_places import list_open_places, what_closes
from toolaxis.regions.reach_screen import ReachScreen
from toolaxis.regions.scene import ReachScene
from toolaxis.report.tables import open_table, plan_table, verdict_table
from toolaxis.report.warnings import warnings_of
from toolaxis.search.machine_limits import intersect_limits
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tolerances import Tolerance

#: The small one is so slow that the large one begins, whatever a tool change takes.
TOOLS = [ta.Tool.ball(10), ta.Tool.ball(3, feedrate=200.0, spindle=12000.0)]
SCALLOP = 0.1
UP = "cone:0,0,1,40"


def trough(tight: float = 3.0) -> Part:
    """A gentle sheet, 24 x 24 mm, whose middle has a hollow along it that is too tight for a large cutter."""
    x, y = np.meshgrid(np.linspace(0, 24, 7), np.linspace(0, 24, 25), indexing="ij")
    z = 0.01 * (x - 12) ** 2 - 1.6 * np.exp(-(((y - 12) / tight) ** 2))
    return Part.from_faces([ta.Face.from_bspline(np.stack([x, y, z], axis=-1))])


def walled() -> Part:
    """A gentle sheet, 24 x 24 mm, and a wall along one of its sides."""
    x, y = np.meshgrid(np.linspace(0, 24, 5), np.linspace(0, 24, 5), indexing="ij")
    wall = np.array([[[0.0, 0.0, -1.0], [0.0, 0.0, 9.0]], [[24.0, 0.0, -1.0], [24.0, 0.0, 9.0]]])
    return Part.from_faces([ta.Face.from_bspline(np.stack([x, y, 0.004 * (x - 12) ** 2], axis=-1)),
                            ta.Face.from_bspline(wall, degree=(1, 1), flip=True)])


@pytest.fixture(scope="module")
def planned() -> Plan:
    return ta.plan(walled(), TOOLS, SCALLOP, faces=[1], limits=UP, workers=1)


def areas(plan: Plan) -> dict[str, float]:
    return {op.face.label: op.face.area for op in plan.operations}


def test_the_smaller_tool_takes_over_what_the_larger_one_leaves(planned: Plan) -> None:
    first, rest = planned.operations
    assert first.tool.name == "ball:10" and first.done and not first.rest_of
    assert rest.tool.name == "ball:3" and rest.done and rest.rest_of == (1,) and rest.face.label == "1.2"
    left = sum(zone.area for zone in first.zones if zone.at_wall)
    assert 24 * 2 < left < 24 * 6, "the large ball keeps off the wall by its radius"
    assert rest.face.area == pytest.approx(left, rel=0.02)
    assert 0.5 * left < sum(zone.elsewhere for zone in first.zones) < left, "the small one does by its own"
    assert planned.taken_over == {1} and first.face.label == "1"


def test_a_hollow_too_tight_for_the_large_tool_goes_to_the_small_one() -> None:
    made = ta.plan(trough(), TOOLS, SCALLOP, limits=UP, workers=1)
    large, small = ([op for op in made.operations if op.tool.name == name] for name in ("ball:10", "ball:3"))
    assert large and small and made.outcome == "complete"
    assert all(abs(op.face.evaluate(op.face.grid(9, 9)).point[:, 1].mean() - 12) < 2 for op in small)
    assert sum(op.face.area for op in small) < 0.6 * made.account.area
    assert ta.verify(made).passed


def test_areas_of_a_part_add_up(planned: Plan) -> None:
    found = planned.account
    assert found.area == pytest.approx(planned.part.faces[0].area, rel=1e-9)
    large, small = planned.operations
    assert found.machined == pytest.approx(sum(op.face.area * (1 - op.orientation.unreached) for op in (large, small)))
    assert found.machined + found.unreachable + found.open == pytest.approx(found.area, rel=1e-12)
    assert planned.outcome == "incomplete", "no ball reaches into the corner"
    near = 1.5 + Tolerance().cutter_clearance
    assert found.unreachable == pytest.approx(24 * near, rel=0.02) and found.open < 0.1 * found.unreachable
    assert found.length == pytest.approx(planned.length) and found.gap == pytest.approx(found.length / found.bound - 1)


def test_what_stays_open_is_listed_with_what_would_close_it(planned: Plan) -> None:
    place, = list_open_places(planned)
    account = planned.account
    assert place.label == "1.2" and place.area == pytest.approx(account.open + account.unreachable, rel=0.2)
    assert place.unreachable == pytest.approx(account.unreachable)
    assert place.point[1] < 1.5 and place.radius == pytest.approx(125, rel=0.1), "along the wall at y = 0"
    assert place.corner is not None and place.corner.beside == "2"
    assert 2 * place.corner.radius == pytest.approx(1.5, abs=0.2), "half of a strip of 1.6, less the clearance of 0.1"
    assert what_closes(place, 1.5).endswith("mm or less for half of it: it lies in the corner to face 2")
    made = open_table(planned)
    assert made is not None and list(made.columns[0].cells) == ["1.2"] and "1 places" not in str(made.title)


def test_a_hollow_that_no_tool_fits_asks_for_a_smaller_ball() -> None:
    made = ta.plan(trough(), ["ball:12", "ball:10"], SCALLOP, limits=UP, workers=1)
    place = list_open_places(made)[0]
    assert place.radius == pytest.approx(9 / 3.2, rel=0.2) and abs(place.point[1] - 12) < 2
    assert what_closes(place, 5.0) == f"a ball end of {2 * place.radius:.2g} mm or less"


def test_rests_wait_apart_from_what_no_tool_has_machined() -> None:
    """Found: a piece that no axis reached counted as the rest of its neighbour, and was missing in the part's area."""
    root, loop = walled().faces[0], np.array([[0.0, 0.0], [0.05, 0.0], [0.05, 0.05]])
    some = [WaitingSurface(root, (loop,), 1), WaitingSurface(root, (loop + 0.1,), 1, frozenset({0})),
            WaitingSurface(root, (loop + 0.2,), 1), WaitingSurface(root, (loop + 0.3,), 1, frozenset({2}))]
    plain, rest = merge_waiting(some)
    assert not plain.left_by and len(plain.loops) == 2
    assert rest.left_by == {0, 2} and len(rest.loops) == 2


def test_rests_that_touch_wait_as_one() -> None:
    """Found: borders that rests shared refused every division of them."""
    root, loop = walled().faces[0], np.array([[0.0, 0.0], [0.5, 0.0], [0.5, 0.4], [0.0, 0.4]])
    rests = [WaitingSurface(root, (loop + np.array([0.5 * k, 0.0]),), 1, frozenset({k})) for k in range(2)]
    (rest,) = merge_waiting(rests)
    assert len(rest.loops) == 1 and rest.left_by == {0, 1}
    assert rest.area == pytest.approx(sum(one.area for one in rests), rel=1e-9)


def test_a_rest_on_which_the_program_fails_costs_no_other(planned: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: of a part with 700 faces all was lost after ten minutes, for one loop of a rest that enclosed nothing."""
    trim = Face.trimmed

    def _fails(face: Face, loops: tuple[np.ndarray, ...], label: str = "") -> Face:
        if label == "1.2":
            raise InvalidInput("planted")
        return trim(face, loops, label)

    monkeypatch.setattr(Face, "trimmed", _fails)
    made = ta.plan(walled(), TOOLS, SCALLOP, faces=[1], limits=UP, workers=1)
    (only,) = made.operations
    assert only.done and only.orientation.axis == pytest.approx(planned.operations[0].orientation.axis)
    assert made.outcome == "incomplete" and [why.sentence for why in made.faults] == ["failed: planted"]
    left = sum(zone.area for zone in only.zones if zone.at_wall)
    assert made.account.open + made.account.unreachable == pytest.approx(left) and not only.zones[0].elsewhere


def test_the_judge_passes_each_operation_with_its_own_tool(planned: Plan) -> None:
    verdict = ta.verify(planned)
    assert all(op.passed for op in verdict.operations), verdict.reasons
    assert len(verdict.operations) == len(planned.operations)


def test_the_judge_finds_a_plan_whose_tools_were_swapped(planned: Plan) -> None:
    other = {planned.tools[0]: planned.tools[1], planned.tools[1]: planned.tools[0]}
    wrong = replace(planned, operations=tuple(replace(op, tool=other[op.tool]) for op in planned.operations))
    assert not all(op.passed for op in ta.verify(wrong).operations)


def test_it_is_written_and_read_back(planned: Plan, tmp_path: Path) -> None:
    with stage_folder(tmp_path / "out") as stage:
        write_plan(planned, stage.folder)
        stage.publish()
    back = read_plan(tmp_path / "out")
    assert back.tools == planned.tools and [op.tool for op in back.operations] == [op.tool for op in planned.operations]
    assert [op.rest_of for op in back.operations] == [op.rest_of for op in planned.operations]
    assert back.account == planned.account and areas(back) == pytest.approx(areas(planned), rel=1e-9)
    assert "CUTTER/3" in (tmp_path / "out" / f"{planned.operations[1].name}.apt").read_text()


def test_tables_name_the_tools_and_what_stays_open(planned: Plan) -> None:
    made = plan_table(planned)
    assert [str(column.header) for column in made.columns][1] == "tool"
    assert list(made.columns[1].cells)[:2] == ["Ball D10", "Ball D3"]
    assert "2 of 2 tools; proven out of reach: 38." in str(made.caption)
    assert str(verdict_table(planned, ta.verify(planned)).title).startswith("2 tools, ")


DIALECTS = {"fanuc": ("T1 M6", "T2 M6", "G43 H2"), "haas-g254": ("T1 M6", "T2 M6", "G43 H2"),
            "linuxcnc": ("T1 M6", "T2 M6", "G43 H2"), "siemens": ("T1 D1", "T2 D1", "SUPA G0 Z"),
            "heidenhain": ("TOOL CALL 1 Z S10000", "TOOL CALL 2 Z S12000", "L M140 MB MAX")}


@pytest.mark.parametrize("dialect", DIALECTS)
def test_one_program_changes_the_tools(planned: Plan, dialect: str) -> None:
    files = post_plan(planned, dialect, Mounting(ta.load_machine("bc-table-table")), Options(retract=400.0))
    text = next(text for name, text in files.items() if name.startswith("program-"))
    first, second, word = DIALECTS[dialect]
    names = [op.name.upper() for op in planned.operations]
    places = [text.index(one) for one in (first, names[0], second, names[1])]
    assert places == sorted(places), "each tool is called before its own operation"
    assert word in text[places[2] - 40:] and text.count(second) == 1
    sheet = files[f"setup-{dialect}.md"]
    assert "## Tools" in sheet and "| T1 | ball:10 |" in sheet and "| T2 | ball:3 |" in sheet
    assert f"| {planned.operations[1].name} | T2 |" in sheet


def test_the_order_of_the_tools_and_the_number_of_processes_do_not_matter(planned: Plan) -> None:
    again = ta.plan(walled(), TOOLS[::-1], SCALLOP, faces=[1], limits=UP, workers=2)
    assert [op.tool.name for op in again.operations] == [op.tool.name for op in planned.operations]
    assert [op.face.label for op in again.operations] == [op.face.label for op in planned.operations]
    for one, other in zip(again.operations, planned.operations, strict=True):
        assert one.path is not None and other.path is not None and np.array_equal(one.path.cl, other.path.cl)


def test_a_tool_s_own_feed_counts_unless_one_is_given_for_all(planned: Plan) -> None:
    text = post_plan(planned, "fanuc", Mounting(ta.load_machine("bc-table-table")))["program-fanuc.nc"]
    before, after = text.split("T2 M6")
    assert "S10000 M3" in before and "F1000." in before and "F200." not in before
    assert "S12000 M3" in after and "F200." in after and "F1000." not in after
    first, rest = planned.operations[0], planned.operations[1]
    assert rest.seconds(1000.0, 1e9) == pytest.approx(rest.seconds(500.0, 1e9), rel=1e-6)
    assert first.seconds(1000.0, 1e9) == pytest.approx(first.seconds(500.0, 1e9) / 2, rel=1e-6)
    alike = ta.plan(trough(40.0), TOOLS, SCALLOP, limits=UP, workers=1, feedrate=800.0)
    assert {tool.feedrate for tool in alike.tools} == {None} and alike.inputs.feedrate == 800.0


def test_a_face_that_one_tool_machines_best_gets_that_one() -> None:
    """A gentle sheet with next to no hollow: the large ball alone."""
    gentle = ta.plan(trough(40.0), TOOLS, SCALLOP, limits=UP, workers=1)
    assert [op.tool.name for op in gentle.operations] == ["ball:10"] and gentle.outcome == "complete"


def test_what_no_tool_reaches_stays_open_and_the_plan_incomplete() -> None:
    made = ta.plan(trough(1.0), TOOLS, SCALLOP, limits=UP, workers=1)
    assert made.outcome == "incomplete" and made.account.open > 1.0
    assert all(op.orientation.reasons or op.done for op in made.operations)
    found = made.account
    assert found.open + found.unreachable == pytest.approx(found.area - found.machined)
    assert 0.5 * (found.area - found.machined) < found.unreachable == sum(op.unreachable for op in made.operations)


def turned_away() -> Part:
    """Two gentle sheets whose material is above them, faces 1 and 2, and one whose material is below, face 3."""
    def sheet(x0: float, half: float, flip: bool) -> ta.Face:
        x, y = np.meshgrid(np.linspace(-half, half, 4), np.linspace(-half, half, 4), indexing="ij")
        return ta.Face.from_bspline(np.stack([x0 + x, y, 0.002 * x**2], axis=-1), flip=flip)

    return Part.from_faces([sheet(0, 12, True), sheet(200, 10, True), sheet(400, 12, False)])


@pytest.mark.parametrize("workers", [1, 2])
def test_faces_that_no_tool_reaches_are_refused_before_any_search(workers: int) -> None:
    made = ta.plan(turned_away(), TOOLS, SCALLOP, limits=UP, workers=workers)
    by_face = {op.face.number: op for op in made.operations}
    assert [number for number, op in sorted(by_face.items()) if op.done] == [3]
    for number in (1, 2):
        op = by_face[number]
        assert op.orientation.outcome == "infeasible" and op.unreachable == pytest.approx(op.face.area, rel=1e-6)
        why, = op.orientation.reasons
        assert why.startswith("infeasible: no tool of the rack reaches it with any axis, proven for 100.0 %")


def test_stopped_between_tools_it_keeps_what_is_finished() -> None:
    seen: list[str] = []
    stopping = Progress(lambda stage, done, total: seen.append(stage), lambda: any("Ball D3" in one for one in seen))
    made = ta.plan(walled(), TOOLS, SCALLOP, faces=[1], limits=UP, workers=1, progress=stopping)
    assert made.outcome == "cancelled" and [op.tool.name for op in made.operations] == ["ball:10"]


def test_stopped_within_a_tool_it_keeps_what_that_tool_finished(monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: a face without an axis asked for the next tool, was stopped there, and took the finished ones with it."""
    whole, stopped = PlanningJob.plan_pieces, list[bool]()

    def _stopped(job: PlanningJob, targets: list[Target], scene: ReachScene, progress: Progress) -> Plan:
        made = whole(job, targets, scene, progress)
        stopped.append(True)
        lost = Operation(1, made.operations[0].face, job.tool, Orientation(None))
        return replace(made, operations=(lost, *made.operations), outcome="cancelled")

    monkeypatch.setattr(PlanningJob, "plan_pieces", _stopped)
    made = ta.plan(walled(), TOOLS, SCALLOP, faces=[1], limits=UP, workers=1,
                   progress=Progress(None, lambda: bool(stopped)))
    assert made.outcome == "cancelled" and [op.done for op in made.operations] == [False, True]


def two_sheets() -> Part:
    """Two gentle sheets, 24 x 24 mm each and 40 mm apart, and a wall along one side of the first."""
    sheet, wall = walled().faces
    moved = ta.Face.from_bspline(sheet.surface.control[..., :3] + [0.0, 40.0, 0.0])
    return Part.from_faces([sheet, moved, wall])


@cache
def stopped_at(words: str) -> Plan:
    """A plan of two sheets that is stopped at the first report in which there are some words."""
    seen: list[str] = []
    stopping = Progress(lambda stage, done, total: seen.append(stage), lambda: any(words in one for one in seen))
    return ta.plan(two_sheets(), TOOLS, SCALLOP, faces=[1, 2], limits=UP, workers=1, progress=stopping)


def whole_area(plan: Plan) -> float:
    found = plan.account
    return found.machined + found.unreachable + found.not_begun + found.open


@pytest.mark.parametrize("words, begun", [("choice of tools", 0), ("face 2 (2 of 2)", 1),
                                          ("Ball D3", 2)])
def test_a_stopped_plan_tells_of_every_face(words: str, begun: int) -> None:
    """Found: its areas were those of the faces that were begun, a tenth of the part looked like all of it."""
    made = stopped_at(words)
    part = made.part
    areas_of_both = part.face(1).area + part.face(2).area
    assert made.outcome == "cancelled" and len(made.operations) == begun and all(op.done for op in made.operations)
    found = made.account
    assert found.area == pytest.approx(areas_of_both, rel=1e-9) == whole_area(made)
    missing = {one.label: one.area for one in made.unplanned if one.whole}
    assert missing == pytest.approx({str(n): part.face(n).area for n in (1, 2)[begun:]})
    rests = {one.label: one.area for one in made.unplanned if not one.whole}
    left = {op.face.label: sum(zone.area for zone in op.zones if zone.at_wall) for op in made.operations if op.zones}
    assert rests == pytest.approx(left, rel=1e-3), "what the large ball leaves at the wall waits for the small one"
    assert found.not_begun == pytest.approx(sum(missing.values()) + sum(rests.values()))
    assert found.open < 1e-3 * found.area, "nothing was tried in vain"


@pytest.fixture(scope="module")
def stopped() -> Plan:
    return stopped_at("face 2 (2 of 2)")


def test_the_page_of_a_stopped_plan_tells_what_was_not_begun(stopped: Plan, tmp_path: Path) -> None:
    pytest.importorskip("plotly")
    pytest.importorskip("jinja2")
    with stage_folder(tmp_path / "out") as stage:
        write_plan(stopped, stage.folder)
        stage.publish()
    page = report(tmp_path / "out").read_text(encoding="utf-8")
    assert f"not begun when the plan was stopped: {stopped.account.not_begun:.1f} mm2, of faces " in page
    assert "<dt>sub-surfaces</dt><dd>1 of 2</dd>" in page


def test_what_was_not_begun_is_told_in_table_and_file(stopped: Plan, tmp_path: Path) -> None:
    made = stopped
    area, rest = (one.area for one in sorted(made.unplanned, key=lambda one: one.label == "1"))
    words = f"not begun when the plan was stopped: {area + rest:.1f} mm2, of faces "
    assert words in str(plan_table(made).caption) and f"1 ({rest:.1f} mm2 of it)" in str(plan_table(made).caption)
    assert any(words in one.text and one.level == "stop" for one in warnings_of(made, None))
    with stage_folder(tmp_path / "out") as stage:
        write_plan(made, stage.folder)
        stage.publish()
    part = json.loads((tmp_path / "out" / "plan.json").read_text())["part"]
    assert part["not_begun"] == pytest.approx(area + rest)
    assert part["area"] == pytest.approx(part["machined"] + part["unreachable"] + part["open"] + part["not_begun"])
    assert {(one["label"], one["why"], one["whole"]) for one in part["unplanned"]} == {
        ("2", "not_begun", True), ("1", "rest_not_begun", False)}
    back = read_plan(tmp_path / "out")
    assert back.account == made.account and back.unplanned == made.unplanned
    judged = verdict_document(back, ta.verify(back))["part"]
    assert judged["area"] == pytest.approx(part["area"]) and judged["not_begun"] == part["not_begun"]
    assert judged["open"] == pytest.approx(judged["area"] - judged["verified"] - judged["not_begun"])


def test_stopped_in_the_choice_of_the_next_tool_it_keeps_all_of_a_tool(monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: the first face asked for the next tool, was stopped there, and took the others' operations with it."""
    whole = RackScreening.look_at

    def _stopped(screen: RackScreening, face: ta.Face, begin: int) -> ScreenedFace:
        if begin:
            raise Cancelled("cancelled by the user")
        return whole(screen, face, begin)

    monkeypatch.setattr(RackScreening, "look_at", _stopped)
    made = ta.plan(two_sheets(), TOOLS, SCALLOP, faces=[1, 2], limits=UP, workers=1)
    assert made.outcome == "cancelled" and [op.face.label for op in made.operations if op.done] == ["1", "2"]
    assert whole_area(made) == pytest.approx(made.account.area) and made.account.not_begun > 24 * 2


def test_stopped_in_the_proof_of_what_is_out_of_reach_it_keeps_the_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: stopped after minutes, with only that proof to do, nothing was left."""

    def _stopped(plan: Plan, jobs: object, progress: Progress) -> Plan:
        raise Cancelled("cancelled by the user")

    monkeypatch.setattr(pipeline, "with_unreachable", _stopped)
    made = ta.plan(two_sheets(), TOOLS, SCALLOP, faces=[1, 2], limits=UP, workers=1)
    assert made.outcome == "cancelled"
    assert [op.face.label for op in made.operations if op.done] == ["1", "2", "1.2"]


@pytest.mark.parametrize("given, said", [
    ({"regions": 2}, "a number of regions is planned with one tool and several are given"),
    ({"orientations": 1}, "orientations is planned with one tool"),
    ({"compare": True}, "a comparison is planned with one tool"),
    ({"method": "roman"}, "the method roman is planned with one tool"),
    ({"tool": []}, "the rack is empty"),
    ({"tool": ["ball:3", "sphere:3"]}, "'sphere:3'"),
    ({"scallop": 9.0}, "not below the cutter radius"),
])
def test_what_a_rack_cannot_do_is_refused_in_one_sentence(given: dict[str, object], said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        ta.plan(**{"part": trough(), "tool": TOOLS, "scallop": SCALLOP, **given})  # type: ignore[arg-type]


def test_no_more_tools_are_used_than_are_allowed() -> None:
    made = ta.plan(walled(), TOOLS, SCALLOP, faces=[1], limits=UP, workers=1, most_tools=1)
    assert len(made.used_tools) == 1 and len(made.tools) == 2
    with pytest.raises(InvalidInput, match="most_tools is 0: it must be a whole number above zero"):
        ta.plan(walled(), TOOLS, SCALLOP, faces=[1], most_tools=0)


def test_a_tool_too_small_for_the_scallop_is_left_out_and_told() -> None:
    made = ta.plan(trough(40.0), ["ball:10", "ball:0.18"], SCALLOP, limits=UP, workers=1)
    assert [tool.name for tool in made.tools] == ["ball:10"]
    assert any("left out: its radius is not above the scallop height" in why for why in made.part.warnings)


def test_very_long_cutting_is_told_before_it_is_planned(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rack_planning, "_VERY_LONG", 1.0)
    stages: list[str] = []
    made = ta.plan(trough(), ["ball:8", "ball:3"], 0.1, workers=1,
                   progress=Progress(lambda stage, done, total: stages.append(stage)))
    said = [words for words in made.part.warnings if words.startswith("cutting takes about 0 h: ")]
    assert len(said) == 1 and "at a scallop height of 0.1 mm" in said[0]
    told = next(k for k, stage in enumerate(stages) if "h of cutting" in stage)
    assert not any("search for the axis" in stage for stage in stages[:told])


def test_the_largest_of_what_waits_for_a_tool_comes_first(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[list[float]] = []
    pieces = PlanningJob.plan_pieces

    def spied(self: PlanningJob, targets: list[Target], scene: ReachScene, progress: Progress) -> Plan:
        seen.append([target.face.area for target in targets])
        return pieces(self, targets, scene, progress)

    monkeypatch.setattr(PlanningJob, "plan_pieces", spied)
    ta.plan(walled(), ["ball:8", "ball:3"], 0.1, faces="all", workers=1)
    assert any(len(row) > 1 for row in seen)
    assert all(row == sorted(row, reverse=True) for row in seen)


def test_what_is_in_reach_of_some_tool_is_told_of_a_face(planned: Plan) -> None:
    """Beside a wall the small ball comes nearer to it than the large one; from below none sees the sheet."""
    part = walled()
    job = PlanningJob(part, TOOLS[1], planned.inputs, None, (), np.zeros(3))
    face = part.face(1)
    large, both = (RackScreening([replace(job, tool=tool) for tool in some], [face]).reachable(face)
                   for some in (TOOLS[:1], TOOLS))
    assert 0.75 * face.area < large < both <= face.area * (1 + 1e-9)
    below = replace(job, limits=intersect_limits(None, "cone:0,0,-1,20"))
    assert RackScreening([below], [face]).reachable(face) == 0.0


def test_pieces_of_a_plan_are_handed_over_before_it_is_there() -> None:
    pieces: list[object] = []
    made = ta.plan(trough(), TOOLS, SCALLOP, limits=UP, workers=1, progress=Progress(on_piece=pieces.append))
    seen, *finished = pieces
    assert isinstance(seen, LargestTools) and seen.area.sum() == pytest.approx(seen.face.area, rel=1e-6)
    from_middle = abs(seen.point[:, 1] - 12)
    assert (seen.largest[from_middle > 7] == 0).all(), "the sheet is wider than the large ball"
    assert (seen.largest[from_middle < 0.7] == 1).all(), "the hollow has a radius of 2.8 mm, the balls of 5 and 1.5 mm"
    assert all(isinstance(op, Operation) for op in finished)
    assert [op.path.cl.tolist() for op in finished] == [op.path.cl.tolist() for op in made.operations if op.done]


def test_whoever_fails_to_show_a_piece_costs_no_face() -> None:
    def _fail(piece: object) -> None:
        if isinstance(piece, LargestTools):
            raise ValueError("no picture")

    made, again = (ta.plan(trough(), TOOLS, SCALLOP, limits=UP, workers=1, progress=Progress(on_piece=on_piece))
                   for on_piece in (None, _fail))
    assert again.outcome == made.outcome
    assert [op.path.cl.tolist() for op in again.operations] == [op.path.cl.tolist() for op in made.operations]


def test_what_tools_reach_of_a_face_is_told_of_those_that_are_alike() -> None:
    pieces: list[object] = []
    one = trough().faces[0]
    turned = ta.Face.from_bspline(np.stack([-one.surface.control[..., 0] + 60, 80 - one.surface.control[..., 1],
                                            one.surface.control[..., 2]], axis=-1))
    ta.plan(Part.from_faces([one, turned]), TOOLS, SCALLOP, limits=UP, workers=1,
            progress=Progress(on_piece=pieces.append))
    first, second = (one for one in pieces if isinstance(one, LargestTools))
    assert {first.face.number, second.face.number} == {1, 2}
    assert np.allclose(second.point, [60, 80, 0] + first.point * [-1, -1, 1], atol=1e-6)
    assert np.allclose(second.normal, first.normal * [-1, -1, 1], atol=1e-6)
    assert (first.largest == second.largest).all()


def test_a_face_that_waits_as_it_is_for_the_next_tool_is_not_screened_again(
        planned: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: a face that tool after tool could not machine was screened anew with all smaller tools each time."""
    part, tools = walled(), [*TOOLS, ta.Tool.ball(1)]
    jobs = [PlanningJob(part, tool, planned.inputs, None, (), np.zeros(3)) for tool in tools]
    face = part.face(1)
    half = face.trimmed((np.array([[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.0, 1.0]]),))
    anew = [RackScreening(jobs, [face]).look_at(one, begin).chains for one in (face, half) for begin in (1, 2)]
    screen, asked = RackScreening(jobs, [face]), []
    whole = ReachScreen.screen_promising
    monkeypatch.setattr(ReachScreen, "screen_promising", lambda *words: asked.append(words) or whole(*words))
    screen.keep({face: screen.look_at(face, 1)})
    assert [screen.look_at(face.trimmed(face.outline), begin).chains for begin in (1, 2)] == anew[:2]
    assert len(asked) == 1
    assert [screen.look_at(half, begin).chains for begin in (1, 2)] == anew[2:]
    assert len(asked) == 3
    screen.look_at(face, 0)  # of a larger tool nothing is known yet
    assert len(asked) == 4


def test_faces_of_a_skin_are_planned_one_by_one_only_where_more_of_it_is_in_reach(
        monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: skins of which tools reach little were planned anew face by face, for minutes and next to nothing."""
    machined, reachable = {1: 20.0, 2: 20.0, 3: 0.0}, {1: 25.0, 2: 60.0, 3: 0.0}
    skins = [SimpleNamespace(number=k, area=100.0) for k in machined]
    monkeypatch.setattr(rack_planning, "area_machined", lambda operations: machined[operations[0]])
    planner = RackPlanner([SimpleNamespace(workers=1)])  # type: ignore[list-item]
    planner._screen = SimpleNamespace(reachable=lambda skin: reachable[skin.number])  # type: ignore[assignment]
    found = planner._with_more_in_reach(skins, {k: [k] for k in machined}, Progress())  # type: ignore[arg-type, dict-item]
    assert [skin.number for skin in found] == [2]


def bent() -> Part:
    """A part of a tube of 50 mm radius, 60 mm long, its outer side machined over 100 degrees."""
    turn, along = np.meshgrid(np.linspace(-0.9, 0.9, 13), np.linspace(0, 60, 7), indexing="ij")
    return Part.from_faces([ta.Face.from_bspline(np.stack([50 * np.sin(turn), along, 50 * np.cos(turn)], axis=-1))])


def planned_bent(**more: int) -> Plan:
    """Of the bent face, by a bull nose that wants an axis nearly along the normal and a small ball."""
    return ta.plan(bent(), ["torus:16x2", "ball:3"], 0.02, limits="cone:0,0,1,50", workers=1, **more)  # type: ignore


@pytest.fixture(scope="module")
def in_less_time() -> Plan:
    return planned_bent()


def test_a_face_is_divided_where_several_axes_take_less_time(in_less_time: Plan) -> None:
    whole = planned_bent(regions=1)
    assert in_less_time.outcome == whole.outcome == "complete"
    assert [op.face.label for op in whole.operations] == ["1"]
    assert [op.face.label for op in in_less_time.operations] == ["1a", "1b", "1c"][:len(in_less_time.operations)]
    assert 2 <= in_less_time.orientations == len(in_less_time.operations)
    assert in_less_time.seconds < whole.seconds - 60.0
    assert sum(areas(in_less_time).values()) == pytest.approx(part_area := bent().face(1).area, rel=1e-5)
    assert in_less_time.account.machined == pytest.approx(part_area, rel=1e-3)
    assert ta.verify(in_less_time).passed


def test_it_stays_whole_where_a_piece_has_no_axis(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is reckoned on a lattice is proven piece by piece; one that fails leaves the face as it was."""
    searched(monkeypatch, lost="1b")
    made = planned_bent()
    assert [op.face.label for op in made.operations] == ["1"] and made.outcome == "complete"


def test_it_tells_where_the_program_fails_to_divide(monkeypatch: pytest.MonkeyPatch) -> None:
    def _fails(*given: object) -> None:
        raise RuntimeError("planted")

    monkeypatch.setattr("toolaxis.job.planning.planner.divide_for_time", _fails)
    made = planned_bent()
    assert [op.done for op in made.operations] == [True] and len(made.faults) == 1
    assert "planted" in made.faults[0].sentence


def searched(monkeypatch: pytest.MonkeyPatch, lost: str = "") -> list[str]:
    """Labels of the sub-surfaces whose axes are searched from now on; of one of them none is found."""
    search, seen = PlanningJob._search_axis, list[str]()

    def _spied(job: PlanningJob, target: Target, progress: Progress) -> tuple[Orientation, object]:
        seen.append(target.face.label)
        return (Orientation(None), None) if target.face.label == lost else search(job, target, progress)

    monkeypatch.setattr(PlanningJob, "_search_axis", _spied)
    return seen


def divided_early(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let what takes a minute count as very long, and twenty seconds as worth a division."""
    monkeypatch.setattr(planner, "_LONG", 60.0)
    monkeypatch.setattr("toolaxis.regions.divide_for_time.WORTH_SECONDS", 20.0)


def test_what_takes_very_long_is_divided_before_it_is_planned_whole(in_less_time: Plan,
                                                                    monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: the passes of a fairing of 9 m2 under one axis took longer than all else."""
    divided_early(monkeypatch)
    seen = searched(monkeypatch)
    made = planned_bent()
    assert seen and "1" not in seen and made.outcome == "complete"
    assert made.seconds == pytest.approx(in_less_time.seconds, rel=0.1) and len(made.operations) > 1


def test_it_is_planned_whole_where_a_piece_of_it_has_no_axis(monkeypatch: pytest.MonkeyPatch) -> None:
    divided_early(monkeypatch)
    seen = searched(monkeypatch, lost="1b")
    made = planned_bent()
    assert seen[-1] == "1" and {"1a", "1b"} <= set(seen)
    assert [op.face.label for op in made.operations] == ["1"] and made.outcome == "complete"


def test_stopped_before_it_is_divided_it_counts_as_not_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    divided_early(monkeypatch)
    stages: list[str] = []
    stopping = Progress(lambda stage, done, total: stages.append(stage),
                        lambda: any("division for time" in stage for stage in stages))
    made = ta.plan(bent(), ["torus:16x2", "ball:3"], 0.02, limits="cone:0,0,1,50", workers=1, progress=stopping)
    assert made.outcome == "cancelled" and not made.operations
    assert made.account.not_begun == pytest.approx(bent().face(1).area, rel=1e-6)


def test_a_division_that_takes_longer_than_the_whole_is_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = searched(monkeypatch)
    monkeypatch.setattr(planner, "divide_for_time", lambda job, scene, whole, progress: regions(job, 2))
    made = ta.plan(Part.from_faces([walled().faces[0]]), TOOLS, SCALLOP, limits=UP, workers=1)
    assert {"1", "1a", "1b"} <= set(seen), "it was tried"
    assert [op.face.label for op in made.operations] == ["1"] and made.outcome == "complete"


def test_what_waits_for_its_division_is_not_made_smaller_as_if_it_were_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: pieces by reach that were to be divided for their time lost a margin to what no axis reaches."""
    divided_early(monkeypatch)
    tried: list[Operation] = []
    shrink = planner.shrink_refused
    monkeypatch.setattr(planner, "shrink_refused",
                        lambda targets, made, *more: (tried.extend(made), shrink(targets, made, *more))[1])
    monkeypatch.setattr(rack_planning, "is_in_pieces", lambda chain: True)
    made = planned_bent()
    assert made.outcome == "complete" and all(op.done for op in tried)
    assert sum(areas(made).values()) == pytest.approx(bent().face(1).area, rel=1e-5)
