"""Skins that lose area as one face: their faces one by one, told as such, and never less than these machine."""

import json
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.job.files.plan_folder import read_plan, stage_folder, write_plan
from toolaxis.job.planning.face_by_face import area_machined, is_better, loses_area
from toolaxis.numeric.knots import restrict_spline
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan
from toolaxis.report.warnings import warnings_of
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.skin.join import join, take_apart

TOOL, HEIGHT, LIMITS = "ball:8", 0.2, "cone:0,0,1,5"


def strip(rough: tuple[float, float], cuts: Sequence[float], length: float = 36.0) -> list[ta.Face]:
    """A sheet 12 mm wide, cut across; its stretch between two places is waves far too tight for the cutter.

    The waves only go down, so that faces beside them are free of them.
    """
    x, y = np.linspace(0, length, 2 * round(length) + 1), np.linspace(0, 12, 4)
    inside = (x > rough[0]) & (x < rough[1])
    z = 0.4 * np.sin(x / 9) - np.where(inside, 1.5 * (1 - np.cos((x - rough[0]) * np.pi / 2)), 0)
    net = np.stack(np.broadcast_arrays(x[:, None], y, z[:, None]), axis=-1)
    whole = ta.Face.from_bspline(net)
    surface, faces = whole.surface, []
    for low, high in pairwise(np.array(cuts) / length):
        knots, own = restrict_spline(surface.knots_u, surface.control, 3, low, high)
        faces.append(replace(whole, surface=NurbsSurface(knots, surface.knots_v, own, (3, 3))))
    return faces


def one_bad() -> ta.Part:
    """Two smooth faces with one between them that no axis reaches, and a skin of two smooth ones apart from these."""
    beside = [replace(face, surface=face.surface.transformed(np.array([[1, 0, 0, 0], [0, 1, 0, 60], [0, 0, 1, 0],
                                                                        [0, 0, 0, 1.0]])))
              for face in strip((0, 0), (0, 12, 24), 24)]
    return ta.Part.from_faces([*strip((16, 24), (0, 16, 24, 36)), *beside])


def planned(faces: object, workers: int = 1, **more: object) -> Plan:
    return ta.plan(one_bad(), TOOL, HEIGHT, faces=faces, limits=LIMITS, workers=workers, **more)


@pytest.fixture(scope="module")
def apart() -> Plan:
    return planned([(1, 2, 3), (4, 5)])


def test_a_skin_with_one_bad_face_is_machined_by_its_other_faces(apart: Plan) -> None:
    assert [(op.face.label, op.done) for op in apart.operations] == [("1", True), ("2", False), ("3", True),
                                                                     ("4+5", True)]
    assert [op.number for op in apart.operations] == [1, 2, 3, 4] and apart.operations[1].left
    asked = sum(face.area for face in one_bad().faces)
    assert sum(op.face.area for op in apart.operations) == pytest.approx(asked, rel=1e-6)
    verdict = ta.verify(replace(apart, operations=tuple(op for op in apart.operations if op.done)))
    assert verdict.passed, verdict.reasons


def test_the_same_faces_asked_for_one_by_one_get_the_same_passes(apart: Plan) -> None:
    single = planned([1, 2, 3])
    for one, other in zip(apart.operations[:3], single.operations, strict=True):
        assert one.done == other.done
        if one.path is not None and other.path is not None:
            assert np.array_equal(one.path.cl, other.path.cl)


def test_it_is_told_that_a_skin_was_taken_apart(apart: Plan, tmp_path: Path) -> None:
    (said,) = (text for text in apart.part.warnings if text.startswith("skin 1+2+3: its faces one by one machine "))
    assert any(said in one.text for one in warnings_of(apart, None))
    with stage_folder(tmp_path / "plan") as stage:
        write_plan(apart, stage.folder)
        stage.publish()
    document = json.loads((tmp_path / "plan" / "plan.json").read_text())
    note = "skin 1+2+3: its faces one by one"
    assert [note in op["orientation"]["reasons"] for op in document["operations"]] == [True, True, True, False]
    assert document["part"]["joined"] == [[4, 5]] and said in document["part"]["warnings"]
    again = read_plan(tmp_path / "plan")
    assert [face.label for face in again.part.faces] == ["1", "2", "3", "4+5"]
    assert [op.face.label for op in again.operations] == ["1", "2", "3", "4+5"]


@pytest.mark.long
def test_other_methods_are_compared_on_the_faces(apart: Plan) -> None:
    made = planned([(1, 2, 3)], compare=True)
    assert {one.method: one.sub_surfaces for one in made.baselines}["normal"] == 3
    assert not any("joined" in one.reason for one in made.baselines)


def test_any_number_of_processes_takes_a_skin_apart_alike(apart: Plan) -> None:
    other = planned([(1, 2, 3), (4, 5)], workers=2)
    assert other.part.warnings == apart.part.warnings
    for one, two in zip(apart.operations, other.operations, strict=True):
        assert one.face.label == two.face.label and one.orientation.reasons == two.orientation.reasons
        assert (one.path is None) == (two.path is None)
        if one.path is not None and two.path is not None:
            assert np.array_equal(one.path.cl, two.path.cl)


@pytest.mark.parametrize(("rough", "cuts"), [
    ((24, 36), (0, 24, 36)), pytest.param((4, 12), (0, 8, 12, 36), marks=pytest.mark.long), ((0, 36), (0, 18, 36)),
    pytest.param((16, 24), (0, 20, 36), marks=pytest.mark.long)])
def test_a_skin_machines_no_less_than_its_faces(rough: tuple[float, float], cuts: tuple[float, ...]) -> None:
    part = ta.Part.from_faces(strip(rough, cuts))
    numbers = [face.number for face in part.faces]
    whole = ta.plan(part, TOOL, HEIGHT, faces=[tuple(numbers)], limits=LIMITS, workers=1)
    single = ta.plan(part, TOOL, HEIGHT, faces=numbers, limits=LIMITS, workers=1)
    area = sum(face.area for face in part.faces)
    assert area_machined(whole.operations) >= area_machined(single.operations) - 0.01 * area
    assert sum(op.face.area for op in whole.operations) == pytest.approx(area, rel=1e-4)


def test_nothing_is_taken_apart_that_is_to_stay_whole() -> None:
    made = planned([(1, 2, 3)], regions=1)
    assert [op.face.label for op in made.operations] == ["1+2+3"] and not made.operations[0].done


def test_more_area_counts_first_then_operations_then_length() -> None:
    face = strip((0, 0), (0, 36))[0]

    def _done(share: float, length: float) -> Operation:
        op = planned_whole.operations[0]
        return replace(op, orientation=replace(op.orientation, unreached=1 - share, length=length))

    planned_whole = ta.plan([face], TOOL, HEIGHT, method="normal", workers=1)
    none = replace(planned_whole.operations[0], path=None, orientation=Orientation(None))
    area = planned_whole.operations[0].face.area
    assert is_better([_done(0.9, 9), _done(0.05, 9)], [_done(0.9, 1)], area)
    assert not is_better([_done(0.9, 9), _done(0.005, 9)], [_done(0.9, 99)], area)
    assert is_better([_done(0.9, 9)], [_done(0.905, 10)], area)
    assert is_better([_done(0.005, 9)], [none], area) and not is_better([none], [_done(0.005, 9)], area)
    assert not is_better([none], [none], area)
    assert loses_area([none], area) and not loses_area([none], 101 * area) and not loses_area([], area)
    assert not loses_area([replace(none, orientation=Orientation(None, outcome="failed"))], area)


def test_a_part_taken_apart_is_the_one_with_the_other_skins() -> None:
    part = one_bad()
    both, one = join(join(part, (1, 2, 3)), (4, 5)), join(part, (4, 5))
    again = take_apart(both, [1])
    assert [face.label for face in again.faces] == [face.label for face in one.faces]
    assert [edge.faces for edge in again.edges] == [edge.faces for edge in one.edges]
    assert (again.bodies, again.warnings, again.original) == (one.bodies, one.warnings, part)
    assert take_apart(again, [4]).faces == part.faces


@pytest.mark.long
def test_an_impeller_skin_of_other_people(shared_parts: Path) -> None:
    """Found: as one face nothing of it had an axis, for strips were asked of lines beside it."""
    pytest.importorskip("OCP")
    made = ta.plan(shared_parts / "kj66_impeller.step", "ball:4", 0.01, faces=[(2, 7, 9)], workers=1)
    asked = sum(op.face.area for op in made.operations)
    assert area_machined(made.operations) > 0.9 * asked
    assert {op.face.numbers for op in made.operations} == {(2, 7, 9)}, "as one skin"


def test_a_piece_that_is_all_of_its_face_keeps_its_name_in_the_folder(tmp_path: Path) -> None:
    """Found: the judge called it by its face's name, under which no operation of the plan stands."""
    part = ta.Part.from_faces(strip((100.0, 101.0), (0.0, 36.0)))
    made = ta.plan(part, TOOL, HEIGHT, method="normal", workers=1)
    (op,) = made.operations
    named = replace(op, face=op.face.trimmed(op.face.trims, op.face.label + "a"))
    with stage_folder(tmp_path / "plan") as stage:
        write_plan(replace(made, operations=(named,)), stage.folder)
        stage.publish()
    (again,) = read_plan(tmp_path / "plan").operations
    assert again.name == named.name != op.name
    assert again.face.area == pytest.approx(op.face.area)
