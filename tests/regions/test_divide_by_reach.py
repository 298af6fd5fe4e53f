"""Faces that no axis reaches whole: what one axis reaches is machined, and the rest is told."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import toolaxis as ta
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.job.inputs.tool_file import load_tool
from toolaxis.job.inputs.tool_library import load_library
from toolaxis.job.planning.sub_surfaces import by_reach, shrink_refused
from toolaxis.numeric.clipping import outer_with_holes
from toolaxis.numeric.vectors import angle_between
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan
from toolaxis.progress import Progress
from toolaxis.regions import divide_by_reach as divide
from toolaxis.regions.cells import FaceCells, screening_axes
from toolaxis.regions.divide_by_reach import _ROOM, LeastAreas, ReachDivision, _parts, _Reach, _shrink, divide_by_reach
from toolaxis.regions.prices import fits_hollows
from toolaxis.regions.reach_screen import screen_reach, seen_cells
from toolaxis.regions.scene import ReachScene
from toolaxis.search.face_problem import FaceProblem, task
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part


def grooved(depth: float) -> Face:
    """A patch of 24 x 10 mm with a groove along y near one end, 2 mm wide."""
    x, y = np.meshgrid(np.linspace(0, 24, 49), np.linspace(0, 10, 6), indexing="ij")
    groove = -depth * np.exp(-(((x - 17) / 1.2) ** 2))
    return Face.from_bspline(np.stack([x, y, 1.5 * np.sin(x / 15) + groove], axis=-1))


def vault() -> Face:
    """Two thirds of a tube of 15 mm radius, 8 mm long, its outer side machined."""
    turn, along = np.meshgrid(np.linspace(-2.0, 2.0, 25), np.linspace(0, 8, 5), indexing="ij")
    return Face.from_bspline(np.stack([15 * np.sin(turn), along, 15 * np.cos(turn)], axis=-1), flip=True)


def mushroom(plate, gap: float = 2.0) -> Part:
    """A strip 2 mm wide around a stem of 16 x 16 mm, under a lid that stands out over the stem by 3 mm."""
    ground = plate([[-20, -20, 0], [-20, 20, 0], [20, -20, 0], [20, 20, 0]])
    loop = np.array([[-1.0, -1.0], [1, -1], [1, 1], [-1, 1]]) / 40
    strip = Face(ground.surface, (0.5 + (10 + gap) * loop, 0.5 + (8 + gap) * loop))
    corners = [(-8, -8), (8, -8), (8, 8), (-8, 8)]
    stem = [plate([[a, b, -3], [c, d, -3], [a, b, 12], [c, d, 12]])
            for (a, b), (c, d) in zip(corners, [*corners[1:], corners[0]], strict=True)]
    lid = plate([[-11, -11, 12], [-11, 11, 12], [11, -11, 12], [11, 11, 12]])
    return Part.from_faces([strip, *stem, lid])


def cavity() -> Face:
    """The inside of a vase, 31 mm deep and 26 mm wide, behind a neck of 14 mm."""
    turn, height = np.meshgrid(np.linspace(0, 2 * np.pi, 33), np.linspace(3, 34, 17), indexing="ij")
    wide = CubicSpline([3, 12, 25, 34], [8, 13, 7, 11])(height)
    return Face.from_bspline(np.stack([wide * np.cos(turn), wide * np.sin(turn), height], axis=-1), flip=True)


def problem(part: Part, tool: str, number: int = 1) -> tuple[FaceProblem, ReachScene]:
    """What decides about axes for a face of a part."""
    return task(part.face(number), load_tool(tool), 0.05, part=part), ReachScene.of(part)


def areas_of(face: Face, found: ReachDivision) -> tuple[list[float], float]:
    """Areas of the sub-surfaces, and of the rest, mm^2."""
    return [face.trimmed(piece.loops).area for piece in found.pieces], sum(
        face.trimmed(loops).area for loops in found.rest)


@pytest.mark.parametrize(("make", "tool", "least"), [
    (lambda _: Part.from_faces([grooved(3.0)]), "torus:8x2", 0.65),
    (lambda _: Part.from_faces([vault()]), "ball:8", 0.999), (mushroom, "ball:3", 0.97)])
def test_pieces_and_rest_add_up(scenes, make, tool: str, least: float) -> None:
    part = make(scenes.plate)
    face = part.face(1)
    found = divide_by_reach(*problem(part, tool))
    areas, rest = areas_of(face, found)
    assert sum(areas) + rest == pytest.approx(face.area, rel=1e-5)
    assert sum(areas) >= least * face.area and found.tried > 0
    small = found.shrink(range(len(found.pieces)))
    smaller, more = areas_of(face, small)
    assert sum(smaller) + more == pytest.approx(face.area, rel=1e-5)
    assert all(one <= other for one, other in zip(smaller, areas, strict=True))


def test_a_narrow_ring_is_cut_into_few_strips_that_their_axes_reach(scenes) -> None:
    part = mushroom(scenes.plate)
    job, scene = problem(part, "ball:3")
    found = divide_by_reach(job, scene)
    assert 2 <= len(found.pieces) <= 4
    for piece in found.pieces:
        own: Feasibility = job.feasibility
        strip = part.face(1).trimmed(piece.loops)
        assert strip.area > 0.1 * part.face(1).area
        free = own.reach(strip.grid(60, 60), piece.axis, itself=True)
        assert len(free) > 100 and free.mean() > 0.99


def test_a_deep_cavity_takes_as_many_axes_as_it_needs() -> None:
    part = Part.from_faces([cavity()])
    slim = next(tool for tool in load_library(None).tools if tool.shop_name.startswith("Tapered ball D2"))
    found = divide_by_reach(task(part.face(1), slim, 0.02, part=part), ReachScene.of(part))
    areas, _ = areas_of(part.face(1), found)
    assert sum(areas) > 0.95 * part.face(1).area
    assert len({tuple(piece.axis) for piece in found.pieces}) > 12


def test_a_face_that_no_axis_reaches_is_left_whole(scenes) -> None:
    part = mushroom(scenes.plate)
    found = divide_by_reach(*problem(part, "ball:30"))
    assert not found.pieces and len(found.rest) == 1
    assert areas_of(part.face(1), found)[1] == pytest.approx(part.face(1).area, rel=1e-6)


def test_what_the_proof_refuses_becomes_smaller_and_the_rest_larger(scenes) -> None:
    part = mushroom(scenes.plate, 1.5)
    job, scene = problem(part, "ball:3")
    found = divide_by_reach(job, scene)
    none = Orientation(None, reasons=("refused",))
    whole = Operation(1, part.face(1), job.worth.tool, none)
    targets = by_reach(whole.face, whole, found)
    tried = [Operation(k, one.face, job.worth.tool, none) for k, one in enumerate(targets, 1)]
    again = shrink_refused(targets, tried, whole, found)
    assert [one.face.label for one in again] == [one.face.label for one in targets]
    assert sum(one.face.area for one in again) == pytest.approx(part.face(1).area, rel=1e-5)
    assert all(one.face.area < other.face.area for one, other in zip(again[:-1], targets[:-1], strict=True))
    assert again[-1].ended is not None
    assert again[-1].face.area > targets[-1].face.area + 0.1 * part.face(1).area
    assert shrink_refused(targets, [], whole, found) == targets


@pytest.fixture(scope="module")
def narrow_strip(scenes) -> Plan:
    """The plan of a strip under a lid with a small ball."""
    return ta.plan(mushroom(scenes.plate, 1.5), "ball:3", 0.1, faces=[1], workers=1)


def test_a_strip_is_machined_from_several_sides_and_what_none_reaches_is_told(narrow_strip: Plan) -> None:
    made, part = narrow_strip, narrow_strip.part
    done, rest = [op for op in made.operations if op.done], [op for op in made.operations if not op.done]
    assert made.outcome == "incomplete" and 2 <= len(done) <= 4 and len(rest) == 1
    assert sum(op.face.area for op in made.operations) == pytest.approx(part.face(1).area, rel=1e-4)
    assert sum(op.face.area for op in done) > 0.8 * part.face(1).area
    told = rest[0].orientation.reasons
    assert told[0].startswith("none of the") and "mm2" in told[0] and "refused for a collision" in told[1]
    verdict = ta.verify(replace(made, operations=tuple(done)))
    assert verdict.passed, verdict.reasons
    again = ta.plan(part, "ball:3", 0.1, faces=[1], workers=2)
    for one, other in zip(made.operations, again.operations, strict=True):
        assert (one.path is None) == (other.path is None)
        assert one.path is None or np.array_equal(one.path.cl, other.path.cl)
        assert all(map(np.array_equal, one.face.trims, other.face.trims))


def test_stopped_among_the_pieces_it_keeps_those_that_are_finished(scenes) -> None:
    """Found: what these machine beside them was looked at, which was stopped too and took all of the plan with it."""
    part, beside, seen = mushroom(scenes.plate, 1.5), np.eye(4), list[str]()
    beside[0, 3] = 100.0
    both = Part.from_faces([*part.faces, *part.transformed(beside).faces])
    stopping = Progress(lambda stage, *_: seen.append(stage), lambda: any("face 7a" in one for one in seen))
    made = ta.plan(both, "ball:3", 0.1, faces=[1, 7], workers=1, progress=stopping)
    assert made.outcome == "cancelled" and any("division by reach" in one for one in seen)
    assert [op.done for op in made.operations if op.face.number == 1][:2] == [True, True]


def test_a_strip_has_what_its_passes_machine_beside_it_unless_a_step_over_is_asked_for(narrow_strip: Plan) -> None:
    part, left = narrow_strip.part, {}
    assert narrow_strip.inputs.greatest_step_over == 0.0
    asked = ta.plan(part, "ball:3", 0.1, faces=[1], workers=1, greatest_step_over=5.0)
    for most, made in ((0.0, narrow_strip), (5.0, asked)):
        (rest,) = [op for op in made.operations if not op.done]
        left[most], told = rest.face.area, [why for why in rest.orientation.reasons if "passes beside it" in why]
        assert sum(op.face.area for op in made.operations) == pytest.approx(part.face(1).area, rel=1e-5)
        assert len(told) == (1 if most == 0 else 0)
    assert left[0.0] < 0.97 * left[5.0]


def test_nobody_is_asked_where_the_division_is_given(scenes) -> None:
    made = ta.plan(mushroom(scenes.plate), "ball:3", 0.1, faces=[1], regions=1, workers=1)
    assert made.outcome == "incomplete" and len(made.operations) == 1


def test_a_hole_of_no_area_is_no_hole_of_the_rest():
    square = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
    hole = np.array([[1.0, 1.0], [1.0, 2.0], [2.0, 2.0], [2.0, 1.0]])
    nothing = np.array([[3.0, 1.0], [3.0, 2.0], [3.0, 3.0]])
    assert [len(part) for part in _parts((square, hole, nothing))] == [2]


def test_cells_that_are_not_screened_are_those_that_are_left_out_anyway(scenes) -> None:
    wall = scenes.plate([[-20, 10, 0], [-20, 10, 30], [20, 10, 0], [20, 10, 30]])
    part, tool = Part.from_faces([vault(), wall]), load_tool("ball:8")
    cells, scene = FaceCells.of(part.faces[0], 2.0), ReachScene.of(part)
    axes = screening_axes([cells])[::3]
    free = screen_reach(cells, [tool], axes, scene)[0] & fits_hollows(cells, tool, axes, 0.05)
    roomy = angle_between(axes[:, None], cells.normal[None]) <= np.pi / 2 - _ROOM
    reach = _Reach(cells, tool, scene, 0.05, LeastAreas(1.0, 1.0))
    reach.screen(axes)
    assert np.array_equal(reach.reached, free & roomy) and (free & ~roomy).any() and (free & roomy).any()
    # what there is little room for is nothing in the way: no cell beside it is left out
    edged = _Reach(cells, tool, scene, 0.05, 1.0, edges=1)
    edged.screen(axes)
    beside = np.array([_shrink(edged, one, there, 1) for one, there in
                       zip(free & roomy, seen_cells(cells, tool, axes, scene.tolerance) & ~free, strict=True)])
    assert np.array_equal(edged.reached, beside) and (beside != free & roomy).any()


def comb(height: float = 12.0, count: int = 5) -> Part:
    """A sheet, 60 x 20 mm, with thin fins across it that stand up at equal distances."""
    x, y = np.meshgrid(np.linspace(0, 60, 7), np.linspace(0, 20, 5), indexing="ij")
    faces = [Face.from_bspline(np.dstack([x, y, 0.002 * (y - 10) ** 2]))]
    for at in np.linspace(0, 60, count + 2)[1:-1]:
        for side in (-0.2, 0.2):
            fin = np.array([[[at + side, 0.0, 0.0], [at + side, 0.0, height]],
                            [[at + side, 20.0, 0.0], [at + side, 20.0, height]]])
            faces.append(Face.from_bspline(fin, degree=(1, 1), flip=side < 0))
    return Part.from_faces(faces)


def test_small_islands_under_one_axis_are_one_sub_surface(monkeypatch: pytest.MonkeyPatch) -> None:
    """Between fins the tool comes down from above only; every island by itself is too little for an operation."""
    monkeypatch.setattr(divide, "_WORTH", 0.25)
    part = comb()
    found = divide_by_reach(*problem(part, "ball:4"))
    assert found.pieces, "no island holds a quarter of the face"
    counts = [len(outer_with_holes(piece.loops)) for piece in found.pieces]
    assert max(counts) >= 3 and len(found.pieces) <= 3
    areas, rest = areas_of(part.face(1), found)
    assert sum(areas) + rest == pytest.approx(part.face(1).area, rel=1e-5)
    # fins keep the middle of a ball of 4 mm 2.1 mm away on either side
    assert 0.85 < sum(areas) / (1200 - 5 * 20 * 4.6) < 1.05
    smaller, more = areas_of(part.face(1), found.shrink(range(len(found.pieces))))
    assert sum(smaller) + more == pytest.approx(part.face(1).area, rel=1e-5) and sum(smaller) < sum(areas)


def test_large_islands_are_sub_surfaces_of_their_own() -> None:
    found = divide_by_reach(*problem(comb(count=1), "ball:4"))
    assert [len(outer_with_holes(piece.loops)) for piece in found.pieces] == [1, 1]


def test_the_judge_passes_an_operation_of_several_islands(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(divide, "_WORTH", 0.25)
    made = ta.plan(comb(), ["ball:4", "ball:3"], 0.1, faces=[1], workers=1)
    islands = [len(outer_with_holes(op.face.outline)) for op in made.operations if op.done]
    assert max(islands) >= 3
    assert made.account.machined > 0.7 * made.account.area
    verdict = ta.verify(made)
    assert all(one.passed for one in verdict.operations), verdict.reasons
