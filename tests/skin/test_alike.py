"""Faces that are alike: found whatever their parameters, not where they or what is around them differ."""

from itertools import pairwise

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.shape.counterparts import refine_loop, turn_about
from toolaxis.shape.face import Face
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.shape.part import Part
from toolaxis.skin.alike import AlikeFace, find_alike_faces
from toolaxis.skin.join import join

MIRROR = np.diag([-1.0, 1.0, 1.0, 1.0])
MIRROR[0, 3] = 90.0
TURN = turn_about(np.array([40.0, 30.0, 0.0]), np.array([0.0, 0.6, 0.8]), 2.2)
SHIFT = np.eye(4)
SHIFT[:3, 3] = [0.0, 70.0, 5.0]


#: The small one is so slow that the large one machines all.
TOOLS = [ta.Tool.ball(8), ta.Tool.ball(3, feedrate=200.0, spindle=12000.0)]


def net() -> np.ndarray:
    """Control points of a bent bicubic patch without symmetry, 30 x 20 mm."""
    x, y = np.meshgrid(np.linspace(0, 30, 6), np.linspace(0, 20, 5), indexing="ij")
    return np.dstack([x + 0.05 * y**1.2, y, 4 * np.sin(x / 9) + 0.01 * x * y])


def patch(how: str = "", matrix: np.ndarray | None = None, bump: float = 0.0) -> Face:
    """The patch with other parameters, elsewhere, or with a control point higher."""
    points = net()
    points[2, 2, 2] += bump
    if "swap" in how:
        points = points.swapaxes(0, 1)
    if "back" in how:
        points = points[::-1]
    moved = Face.from_bspline(points).transformed(np.eye(4) if matrix is None else matrix)
    outward = moved.normal(np.array([[0.5, 0.5]]))[0] @ ((np.eye(4) if matrix is None else matrix)[:3, :3] @ [0, 0, 1])
    if outward < 0:
        moved = Face(moved.surface, moved.trims, not moved.flip)
    s = moved.surface
    return Face(NurbsSurface(7 + 3 * s.knots_u, s.knots_v, s.control, s.degree), (), moved.flip)


def find(*faces: Face, reach: float = 10.0, mirrored: bool = True) -> dict[int, AlikeFace]:
    part = Part.from_faces(faces)
    return find_alike_faces(part, part.faces, reach, mirrored)


@pytest.mark.parametrize("matrix", [TURN, MIRROR, SHIFT], ids=["turned", "mirrored", "moved"])
@pytest.mark.parametrize("how", ["", "back", "swap", "swap back"])
def test_a_face_is_found_again_whatever_its_parameters(matrix: np.ndarray, how: str) -> None:
    found = find(patch(), patch(how, matrix))
    assert list(found) == [1]
    one = found[1]
    assert one.same and one.rule is not None
    assert one.everywhere is (matrix is MIRROR), "a mirror brings the second one onto the first, too"
    assert one.matrix == pytest.approx(matrix, abs=1e-6)
    loop = np.array([[7.6, 0.2], [8.8, 0.25], [9.0, 0.9], [7.5, 0.8]])
    there, = one.carry_loops([loop])
    assert one.face.evaluate(there).point == pytest.approx(
        one.original.evaluate(loop).point @ matrix[:3, :3].T + matrix[:3, 3], abs=1e-6)


def test_mirror_images_count_only_where_they_may() -> None:
    assert find(patch(), patch("", MIRROR)) and not find(patch(), patch("", MIRROR), mirrored=False)


def test_a_face_seen_from_the_other_side_is_not_alike() -> None:
    inside_out = patch("", SHIFT)
    assert not find(patch(), Face(inside_out.surface, (), not inside_out.flip))


@pytest.mark.parametrize("bump, same, alike", [(0.0, True, True), (0.02, False, True), (0.5, False, False)])
def test_a_face_that_is_a_little_off_is_alike_but_not_the_same(bump: float, same: bool, alike: bool) -> None:
    """A control point that is so much higher lifts the patch by 0.4 of that at most."""
    found = find(patch(), patch("", SHIFT, bump))
    assert bool(found) is alike
    if found:
        assert found[1].same is same and found[1].apart < 0.5 * bump + 1e-9


def wall(matrix: np.ndarray, away: float) -> Face:
    """A wall so far from the patch's side at y = 0."""
    points = np.array([[[0.0, -away, -5.0], [0.0, -away, 25.0]], [[30.0, -away, -5.0], [30.0, -away, 25.0]]])
    return Face.from_bspline(points, degree=(1, 1), flip=True).transformed(matrix)


def test_what_is_around_has_to_be_alike_as_far_as_a_cutter_reaches() -> None:
    here = [patch(), wall(np.eye(4), 3.0)]
    part = Part.from_faces([*here, patch("", SHIFT), wall(SHIFT, 3.0), patch("", 2 * SHIFT - np.eye(4))])
    sheets = [part.face(n) for n in (1, 3, 5)]
    assert list(find_alike_faces(part, sheets, 10.0)) == [1], "nothing stands beside the third one"
    assert list(find_alike_faces(part, sheets, 2.0)) == [1, 2], "the walls are farther away than that"


def test_a_wall_that_only_the_other_one_has_makes_them_unlike() -> None:
    part = Part.from_faces([patch(), patch("", SHIFT), wall(SHIFT, 3.0)])
    assert not find_alike_faces(part, part.faces[:2], 10.0)


def test_a_part_that_is_brought_onto_itself_is_told() -> None:
    half_turn = turn_about(np.array([40.0, 30.0, 0.0]), np.array([0.0, 0.0, 1.0]), np.pi)
    assert find(patch(), patch("", half_turn))[1].everywhere


def test_pieces_go_over_with_their_letters_and_areas() -> None:
    one = find(patch(), patch("swap", TURN))[1]
    piece = one.original.trimmed((np.array([[7.6, 0.2], [8.8, 0.25], [9.0, 0.9], [7.5, 0.8]]),), "1b")
    there = one.carry_piece(piece)
    assert there is not None and there.label == "2b" and there.number == 2
    assert there.area == pytest.approx(piece.area, rel=1e-5)
    assert one.carry_piece(one.original) is one.face


def narrowed(width: float) -> Face:
    """A flat face, 10 mm long and so wide, whose x grows as the square of its parameter."""
    rows = [np.column_stack([np.full(2, x), [0.0, width], np.zeros(2)]) for x in (0.0, 0.0, 10.0)]
    return Face.from_bspline(np.stack(rows), degree=(2, 1))


def test_loops_that_enclose_nothing_on_the_other_face_are_left_out() -> None:
    """Found: a sliver along the border became a line on a face that is a little narrower, and the plan was lost."""
    straight = np.stack(np.meshgrid([0.0, 10.0], [0.0, 6.0], indexing="ij"), axis=-1)
    flat = Face.from_bspline(np.dstack([straight, np.zeros((2, 2))]), degree=(1, 1))
    one = AlikeFace(flat, narrowed(5.99), np.eye(4), 0.01, None, False)
    square = np.array([[0.25, 0.1], [0.9, 0.1], [0.9, 0.8], [0.25, 0.8]])
    sliver = np.array([[0.25, 0.9985], [0.9, 0.9985], [0.9, 1.0], [0.25, 1.0]])
    there, = one.carry_loops([square, sliver])
    assert one.face.evaluate(there).point == pytest.approx(flat.evaluate(refine_loop(square)).point, abs=1e-6)
    assert one.carry_loops([sliver]) == () and one.carry_piece(flat.trimmed((sliver,), "1b")) is None


def skins(count: int) -> Part:
    """Two bent strips side by side, joined smoothly, and turned copies of them."""
    strips = []
    for low, high in pairwise((0.0, 12.0, 24.0)):
        x, y = np.meshgrid(np.linspace(0, 30, 6), np.linspace(low, high, 4), indexing="ij")
        strips.append(np.dstack([x, y, 3 * np.sin(x / 9) + 0.002 * x * y + 0.0 * y]))
    matrices = [np.linalg.matrix_power(turn_about(np.array([0.0, 60.0, 0.0]), np.array([0.0, 0.0, 1.0]), 1.3), k)
                for k in range(count)]
    part = Part.from_faces([Face.from_bspline(points).transformed(matrix) for matrix in matrices for points in strips])
    for k in range(count):
        part = join(part, [2 * k + 1, 2 * k + 2])
    return part


def test_skins_are_alike_member_by_member() -> None:
    part = skins(3)
    found = find_alike_faces(part, part.faces, 10.0)
    assert list(found) == [1, 2] and all(one.same and one.everywhere is False for one in found.values())
    one = found[2]
    u0, u1, v0, v1 = one.original.bounds
    loop = np.array([[0.7 * u0 + 0.3 * u1, 0.7 * v0 + 0.3 * v1], [0.2 * u0 + 0.8 * u1, 0.6 * v0 + 0.4 * v1],
                     [0.4 * u0 + 0.6 * u1, 0.2 * v0 + 0.8 * v1]])
    piece = one.original.trimmed((loop,), one.original.label + "a")
    there = one.carry_piece(piece)
    assert there is not None and there.area == pytest.approx(piece.area, rel=1e-3)


def test_copies_are_planned_once_and_pass_the_judge() -> None:
    """Three sheets alike: one search, its passes moved, and proven among what stands there."""
    part = Part.from_faces([patch(), patch("swap", SHIFT), patch("back", MIRROR)])
    made = ta.plan(part, TOOLS, 0.2, faces=[1, 2, 3], workers=1)
    first, *others = made.operations
    assert made.outcome == "complete" and [op.face.label for op in made.operations] == ["1", "2", "3"]
    assert first.orientation.evaluations > 1 and all(op.orientation.evaluations == 1 for op in others)
    assert all(op.orientation.reasons[0] == "passes of face 1, moved: the faces are alike" for op in others)
    assert [op.orientation.length for op in others] == pytest.approx([first.orientation.length] * 2)
    assert {op.orientation.feed for op in others} == {"u", "v"}
    assert ta.verify(made).passed


def test_a_face_with_another_allowance_is_no_copy() -> None:
    """Its passes would leave what the other one is to have left."""
    part = Part.from_faces([patch(), patch("", SHIFT), patch("back", MIRROR)])
    made = ta.plan(part, TOOLS, 0.2, faces=[1, 2, 3], workers=1, allowance=0.3, allowance_on={2: 0.0})
    moved = {op.face.number for op in made.operations if op.orientation.evaluations == 1}
    assert moved == {3} and ta.verify(made).passed


def test_climb_milling_is_not_mirrored() -> None:
    part = Part.from_faces([patch(), patch("", SHIFT), patch("back", MIRROR)])
    made = ta.plan(part, TOOLS, 0.2, faces=[1, 2, 3], workers=1, direction="climb")
    assert {op.face.number for op in made.operations if op.orientation.evaluations == 1} == {2}


def test_a_longer_face_is_not_the_same_though_the_shorter_one_lies_on_it() -> None:
    """The passes of a shorter one would not come to its end."""
    def cut_off(end: float) -> Face:
        return patch().trimmed((np.array([[7.0, 0.0], [end, 0.0], [end, 1.0], [7.0, 1.0]]),))

    assert not find(cut_off(9.9), patch("", SHIFT))
    assert not find(cut_off(9.9998), patch("", SHIFT))[1].same, "by 6 um"


def test_a_copy_that_something_is_in_the_way_of_is_planned_by_itself() -> None:
    """A lid of another body over the second sheet, which is no face of the part, keeps the moved axis from it."""
    bar = np.array([[[-5.0, 60.0, 20.0], [-5.0, 100.0, 20.0]], [[40.0, 60.0, 20.0], [40.0, 100.0, 20.0]]])
    part = Part.from_faces([patch(), patch("", SHIFT)])
    cover = Part.from_faces([Face.from_bspline(bar, degree=(1, 1))])
    made = ta.plan(part, TOOLS, 0.2, faces=[1, 2], workers=1, obstacles=cover, limits="cone:0,0,1,20")
    assert all(op.done for op in made.operations if op.face.number == 1)
    second = [op for op in made.operations if op.face.number == 2]
    assert second and not any(op.done for op in second), "the lid covers it for all axes that are allowed"
    assert made.outcome == "incomplete" and not any("moved" in why for op in second for why in op.orientation.reasons)
