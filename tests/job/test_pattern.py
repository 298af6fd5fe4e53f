"""One blade planned, its operations turned to the others and proven there; broken patterns are refused with reasons."""

import json
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.output.pictures import draw_verdict
from toolaxis.job.planning import comparison
from toolaxis.job.planning.blade_clearances import tightest
from toolaxis.job.planning.blade_pattern import find_pattern, group_blade_faces, too_narrow
from toolaxis.job.planning.edit_axis import with_operations
from toolaxis.plan.document import plan_document
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan
from toolaxis.plan.schema import check
from toolaxis.report.blades import blades_lines
from toolaxis.report.figures.hatch_fill import COLOUR
from toolaxis.report.figures.plan_overview import overview_picture
from toolaxis.report.tables import baselines_table
from toolaxis.search.fixed_axis import evaluate_axis
from toolaxis.shape.analytic import CylindricalSurface
from toolaxis.shape.face import Face
from toolaxis.shape.kinks import with_kinks
from toolaxis.shape.part import Body, Part
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.turned_copies import OperationMeasurement
from toolaxis.verify.verdict import measure

COUNT = 4
BLISK = Path(__file__).parents[2] / "examples" / "blisk.step"


def turn(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])


def sides(how: str = "") -> list[Face]:
    """The two sides of a thin blade that stands along +x, parametrised as asked for."""
    z, x = np.meshgrid(np.linspace(-6, 6, 5), np.linspace(20, 30, 4), indexing="ij")
    bend = 1 - (z / 6) ** 2
    made = []
    for bulge, flip in ((5.0 if "thick" in how else 2.0, False), (0.5, True)):
        points = np.dstack([x, bulge * bend + 0.02 * (x - 20) * z, z])
        if "swapped" in how:
            points, flip = points.swapaxes(0, 1), not flip
        if "reversed" in how:
            points, flip = points[::-1], not flip
        made.append(Face.from_bspline(points, flip=flip))
    return made


def wheel(count: int = COUNT, change: tuple[str, ...] = ()) -> Part:
    """Blades around a cylinder, some with other parameters, missing or moved."""
    hub = Face(CylindricalSurface(12.0, (0.0, 2 * np.pi), (-8.0, 8.0)).nurbs(), kind="cylinder")
    faces = [hub]
    for k in range(count):
        how = change[k] if k < len(change) else ""
        if how == "missing":
            continue
        shift = np.eye(4)
        shift[2, 3] = 5.0 if how == "moved" else 0.0
        faces += [face.transformed(turn(2 * np.pi * k / count) @ shift) for face in sides(how)]
    return Part.from_faces(faces)


def ring(count: int = 6) -> Part:
    """Lenses whose edges touch those of the next ones."""
    half = 25 * np.tan(np.pi / count)
    y, z = np.meshgrid(np.linspace(-half, half, 5), np.linspace(-5, 5, 4), indexing="ij")
    bend = 1 - (y / half) ** 2
    lens = [Face.from_bspline(np.dstack([25 + bulge * bend, y, z]), flip=flip)
            for bulge, flip in ((2.0, False), (-1.0, True))]
    hub = Face(CylindricalSurface(12.0, (0.0, 2 * np.pi), (-8.0, 8.0)).nurbs(), kind="cylinder")
    return Part.from_faces([hub, *(face.transformed(turn(2 * np.pi * k / count)) for k in range(count)
                                   for face in lens)])


def capped_wheel(bulge_of_one: float) -> Part:
    """Blades with a third face at their outer end, which bulges on one of them."""
    y, z = np.meshgrid(np.linspace(0, 1, 4), np.linspace(-6, 6, 5), indexing="ij")
    bend = 1 - (z / 6) ** 2
    faces = list(wheel(change=("thick",) * COUNT).faces)
    for k in range(COUNT):
        across = (0.5 + 4.5 * y) * bend + 0.2 * z
        out = 30 + (bulge_of_one if k == 2 else 0.0) * np.sin(np.pi * y) * bend
        faces.append(Face.from_bspline(np.dstack([out, across, z])).transformed(turn(2 * np.pi * k / COUNT)))
    return Part.from_faces(faces)


def test_a_face_that_differs_from_blade_to_blade_is_planned_by_itself_on_every_blade() -> None:
    alike, _ = find_pattern(capped_wheel(0.0))
    assert alike is not None and not alike.unlike
    assert all(len(blade.numbers) == 3 for blade in alike.blades.blades)
    found, notes = find_pattern(capped_wheel(0.55))
    assert found is not None and not notes
    caps = {10, 11, 12, 13}
    assert set(found.unlike) < caps and len(found.unlike) == 1
    assert {face.number for face in found.rest} == caps
    assert all(len(blade.numbers) == 2 for blade in found.blades.blades)
    assert any("have no counterpart on every other blade" in warning for warning in found.part.warnings)


def test_sides_that_differ_from_blade_to_blade_are_no_pattern() -> None:
    part = wheel()
    first = part.faces[1]
    points = first.surface.control[..., :3].copy()
    points[2, 1:3, 1] += 0.9
    changed = [part.faces[0], Face.from_bspline(points, flip=first.flip), *part.faces[2:]]
    found, notes = find_pattern(Part.from_faces(changed))
    assert found is None
    assert "face 2, a side of the first blade, has no counterpart on another blade" in notes[0]


@pytest.fixture(scope="module")
def plan() -> Plan:
    tool = ta.Tool.torus(diameter=6, corner_radius=1, stickout=40, holder=[(8, 0), (8, 30)])
    return ta.plan(wheel(change=("", "swapped", "reversed")), tool, 0.15, regions=1)


@pytest.fixture(scope="module", params=[1, pytest.param(0, marks=pytest.mark.long)], ids=["quick", "with sectors"])
def compared(request: pytest.FixtureRequest) -> Plan:
    """The same beside other methods; the axis by sectors takes half a minute."""
    tool = ta.Tool.torus(diameter=6, corner_radius=1, stickout=40, holder=[(8, 0), (8, 30)])
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(comparison, "BY_SUB_SURFACE", comparison.BY_SUB_SURFACE[request.param:])
        return ta.plan(wheel(change=("", "swapped", "reversed")), tool, 0.15, regions=1, compare=True)


def test_the_axis_along_a_blade_is_found() -> None:
    """Between hub and neighbours all but a narrow lobe around it is forbidden; the sectors' steps meet it."""
    part, tool = wheel(), ta.Tool.torus(diameter=6, corner_radius=1, stickout=40, holder=[(8, 0), (8, 30)])
    found = ta.best_axis(part.faces[1], tool, 0.15, part=part)
    known = evaluate_axis(part.faces[1], tool, (0.9825, 0.066, 0.1739), 0.15, part=part)
    assert known.outcome == "feasible" and known.length < 75
    assert found.length < known.length
    for lobe in found.lobes:
        other = evaluate_axis(part.faces[1], tool, lobe.axis, 0.15, part=part)
        assert other.outcome != "feasible" or found.length <= other.length * 1.001


def test_every_blade_is_machined_as_the_first(plan: Plan) -> None:
    assert plan.outcome == "complete" and plan.blades is not None
    assert len(plan.operations) == 2 * COUNT
    assert plan.blades.copies == {n: 1 + (n - 1) % 2 for n in range(3, 2 * COUNT + 1)}
    assert plan.blades.searched == ()
    names = [plan.blades.side_of(op.face.number) for op in plan.operations]
    assert names == ["suction", "pressure"] * COUNT
    for op in plan.operations[2:]:
        k, source = (op.number - 1) // 2, plan.operations[(op.number - 1) % 2]
        assert op.path is not None and source.path is not None and op.frame is not None
        matrix = turn(-2 * np.pi * k / COUNT if plan.blades.axis[2] < 0 else 2 * np.pi * k / COUNT)
        assert op.path.cl == pytest.approx(source.path.cl @ matrix[:3, :3].T, abs=1e-6)
        assert op.orientation.axis == pytest.approx(matrix[:3, :3] @ source.orientation.axis, abs=1e-9)
        assert op.frame.z == pytest.approx(op.orientation.axis, abs=1e-12)
        assert op.face.area == pytest.approx(source.face.area, rel=1e-6)
        along = op.face.evaluate(op.face.grid(1, 1))
        there = source.face.evaluate(source.face.grid(1, 1))
        mine, other = ((d.su if found.feed == "u" else d.sv)[0] for d, found in
                       ((along, op.orientation), (there, source.orientation)))
        assert abs(mine @ (matrix[:3, :3] @ other)) == pytest.approx(np.linalg.norm(mine) * np.linalg.norm(other))


def test_the_judge_passes_every_blade(plan: Plan) -> None:
    verdict = ta.verify(plan, spacing=1.0)
    assert len(verdict.operations) == 2 * COUNT
    assert verdict.passed, verdict.reasons


def test_what_is_the_same_at_each_blade_is_measured_and_drawn_once(monkeypatch: pytest.MonkeyPatch,
                                                                   tmp_path: Path) -> None:
    tool = ta.Tool.torus(diameter=6, corner_radius=1, stickout=40, holder=[(8, 0), (8, 30)])
    made = ta.plan(wheel(), tool, 0.15, regions=1)
    measured = []

    def counted(task: VerificationTask, *more: Any) -> OperationMeasurement:
        measured.append(task.name)
        return measure(task, *more)

    monkeypatch.setattr("toolaxis.job.output.verify.measure", counted)
    verdict = ta.verify(made, spacing=1.0)
    assert verdict.passed, verdict.reasons
    assert measured == [op.name for op in made.operations[:2]]
    draw_verdict(made, verdict, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"{name}-verdict.png" for name in measured]
    assert [op.name for op in verdict.operations] == [op.name for op in made.operations]
    assert [op.faces for op in verdict.operations] == [(op.face.label,) for op in made.operations]
    spoilt = made.operations[4]
    assert spoilt.path is not None and made.blades is not None and spoilt.number in made.blades.copies
    tips = spoilt.path.cl.copy()
    cut = np.flatnonzero(spoilt.path.kind == Motion.CUT)
    tips[cut[len(cut) // 2]] -= 0.05 * spoilt.path.normal[cut[len(cut) // 2]]
    operations = list(made.operations)
    operations[4] = replace(spoilt, path=replace(spoilt.path, cl=tips))
    verdict = ta.verify(replace(made, operations=tuple(operations)), spacing=1.0)
    assert sorted(measured[2:]) == sorted([*measured[:2], spoilt.name])
    assert [op.passed for op in verdict.operations] == [op.number != spoilt.number for op in made.operations]
    draw_verdict(made, verdict, tmp_path)
    assert (tmp_path / f"{spoilt.name}-verdict.png").is_file()


def test_figures_of_copies_are_proven_and_no_better_than_the_originals(plan: Plan) -> None:
    for op in plan.operations[2:]:
        source = plan.operations[(op.number - 1) % 2].orientation
        assert op.orientation.gouge >= source.gouge - 1e-9
        for name, value in op.orientation.clearance.items():
            assert source.clearance[name] - 0.011 <= value <= source.clearance[name]


def test_other_methods_are_compared_on_the_planned_blade(compared: Plan) -> None:
    plan, rows = compared, {row.method: row for row in compared.baselines}
    assert [name for name in rows if name != "sectors"] == ["plan", "roman", "normal", "one", "ball"]
    assert all(row.sub_surfaces == 2 for row in plan.baselines)
    mine = [op.orientation for op in plan.operations[:2]]
    assert rows["plan"].length == pytest.approx(sum(found.length for found in mine)) and rows["plan"].complete
    assert rows["plan"].passes == sum(found.passes for found in mine)
    assert all(row.complete or row.reason for row in plan.baselines)
    assert not any("compare" in text for text in plan.part.warnings)
    assert "first blade" in str(baselines_table(plan).title)


def test_neighbour_and_hub_are_told_apart(plan: Plan) -> None:
    assert plan.blades is not None
    rooms = {(room.to, room.component): room for room in plan.blades.room}
    neighbours = {n for k in (1, COUNT - 1) for n in plan.blades.blades[k].numbers}
    for component in ("cutter", "shank", "holder"):
        room = rooms["neighbouring blade", component]
        assert room.operation == 0 or room.face in neighbours
        least = min(op.orientation.clearance[component] for op in plan.operations[:2])
        assert room.distance >= least - 1e-9
    place = tightest(plan)
    assert place is None or place.operation.number in (1, 2)


def test_it_survives_being_written_and_says_what_was_done(plan: Plan, tmp_path: Path) -> None:
    write_plan(plan, tmp_path)
    again = read_plan(tmp_path)
    assert again.blades is not None and plan.blades is not None
    assert again.blades.copies == plan.blades.copies and again.blades.blades == plan.blades.blades
    files = json.loads((tmp_path / "plan.json").read_text())
    names = {"part": {k: files["part"][k] for k in ("file", "sha256")}, "obstacles": files["obstacles"],
             "operations": [op["cl_file"] for op in files["operations"]]}
    check(json.loads(json.dumps(plan_document(again, names))))
    assert files["blades"]["copies"][0] == {"operation": 3, "of": 1}
    text = "\n".join(blades_lines(again))
    assert f"{COUNT} blades found around the axis" in text and "one planned, three turned" in text
    assert "least clearance to the neighbouring blade: cutter" in text


def test_what_gets_another_axis_is_no_copy_any_more(plan: Plan) -> None:
    changed = with_operations(plan, {2: plan.operations[1], 3: plan.operations[2]})
    assert changed.blades is not None and changed.blades.copies == {5: 1, 7: 1}
    assert changed.outcome == "complete"


@pytest.mark.parametrize("how", ["missing", "moved"])
def test_a_broken_pattern_is_planned_face_by_face_with_a_warning(how: str) -> None:
    pattern, warnings = find_pattern(wheel(6, ("", "", how)))
    assert pattern is None
    assert len(warnings) == 1 and "missing or moved" in warnings[0] and "planned by itself" in warnings[0]


def test_blades_that_touch_are_refused() -> None:
    pattern, warnings = find_pattern(ring())
    assert pattern is None
    assert len(warnings) == 1 and "touch" in warnings[0]


def test_a_stray_body_is_told_and_not_machined() -> None:
    whole = wheel()
    tiny = [face.transformed(np.diag([0.005, 0.005, 0.005, 1.0])) for face in sides()]
    part = Part.from_faces([*whole.faces, *tiny])
    part = replace(part, bodies=(Body("solid", (len(part.faces) - 1, len(part.faces)), True),))
    pattern, warnings = find_pattern(part)
    assert pattern is not None and warnings == () and pattern.rest == ()
    assert any("faces 10, 11 belong to stray bodies" in text for text in pattern.part.warnings)


def test_a_fillet_that_is_left_is_hatched_in_the_picture_of_the_part(plan: Plan) -> None:
    assert plan.blades is not None
    bare = replace(plan, operations=tuple(replace(op, zones=()) for op in plan.operations))
    names = plan.blades.blades[0].faces
    first = replace(plan.blades.blades[0], faces={**names, "fillet": names["pressure"], "pressure": ()})
    blades = replace(plan.blades, blades=(first, *plan.blades.blades[1:]))
    ops = (bare.operations[0], replace(bare.operations[1], path=None, orientation=Orientation(None)),
           *bare.operations[2:])
    shown = [np.asarray(overview_picture(made).axes[0].images[0].get_array())
             for made in (bare, replace(bare, operations=ops, blades=blades))]
    hatched = [int((np.abs(image[..., :3] - COLOUR).max(axis=-1) < 0.01).sum()) for image in shown]
    assert hatched[0] == 0 and hatched[1] > 100


def test_many_small_facets_are_left_to_clean_up() -> None:
    z, x = np.meshgrid(np.linspace(-6, 6, 25), np.linspace(20, 30, 4), indexing="ij")
    cut = [with_kinks(Face.from_bspline(np.dstack([x, bulge * (1 - (z / 6) ** 2), z]), degree=(1, 3), flip=flip))
           for bulge, flip in ((2.0, False), (0.5, True))]
    hub = wheel().faces[0]
    part = Part.from_faces([hub, *(face.transformed(turn(np.pi / 2 * k)) for k in range(4) for face in cut)])
    pattern, _ = find_pattern(part)
    assert pattern is not None
    share = group_blade_faces(pattern, ta.Tool.torus(diameter=6, corner_radius=1), 0.1)
    assert share.left.keys() == {2, 3} and share.divided == () and share.refused == {}
    assert "24 facets" in share.left[2] and "left entirely as rest material" in share.left[2]
    few = group_blade_faces(pattern, ta.Tool.torus(diameter=2, corner_radius=0.5), 0.1)
    assert few.left == {} and len(few.divided) == 2


def test_a_part_without_blades_is_not_warned_of() -> None:
    loose = Part.from_faces([face.transformed(turn(0.3 * k * k)) for k in range(3) for face in sides()])
    assert find_pattern(loose) == (None, ())


def test_a_gap_narrower_than_the_tool_is_infeasible_and_names_the_widest() -> None:
    part = wheel(12)
    pattern, _ = find_pattern(part)
    assert pattern is not None
    wide, slim = (ta.Tool.torus(diameter=d, corner_radius=0.5) for d in (14.0, 6.0))
    assert too_narrow(pattern, slim, 0.1) == {}
    refused = too_narrow(pattern, wide, 0.1)
    assert len(refused) == 2
    for why in refused.values():
        widest = float(why.rpartition(" is ")[2].split(" mm")[0])
        assert pattern.blades.gap.distance - 0.1 <= widest < 14.0
    made = ta.plan(part, wide, 0.1, regions=1)
    assert made.outcome == "incomplete" and len(made.operations) == 24
    assert all(op.orientation.outcome == "infeasible" for op in made.operations)
    assert "widest cutter that passes" in made.operations[5].orientation.reasons[0]


@pytest.fixture(scope="module")
def blisk() -> Any:
    """The pattern of the blisk among the examples."""
    pattern, _ = find_pattern(ta.load(BLISK))
    assert pattern is not None
    return pattern


@pytest.mark.parametrize(("diameter", "left"), [(10, True), (6, False)])
def test_fillets_tighter_than_the_cutter_are_left_to_a_smaller_one(blisk: Any, diameter: float, left: bool) -> None:
    found = group_blade_faces(blisk, ta.Tool.torus(diameter, 1), 0.1)
    fillets = {face.number for face in blisk.first if blisk.blades.side_of(face.number) == "fillet"}
    assert fillets
    assert {face.number for face in found.whole} & fillets == (set() if left else fillets)
    assert set(found.left) == (fillets if left else set())
    assert all("3.50 mm radius" in why for why in found.left.values())


@pytest.mark.long
def test_tools_keep_clear_of_all_of_a_face_though_only_pieces_of_it_are_machined() -> None:
    path = Path(os.environ.get("TOOLAXIS_SHARED", Path(__file__).parents[3] / "shared")) / "parts/kj66_impeller.step"
    if not path.exists():
        pytest.skip(f"{path} is not there: set TOOLAXIS_SHARED")
    part = ta.load(path)
    pattern, _ = find_pattern(part)
    assert pattern is not None
    assert all(pattern.part.face(face.number) is face for face in part.faces)
    assert len([piece for piece in pattern.rest if piece.number == 88]) >= 9
    assert all(face.area < 0.7 * part.face(face.number).area for face in pattern.first if face.number in (1, 3))
