"""Patches joined to one face: it is the surface they were cut from, members lie on it, and bad patches are told."""

from dataclasses import replace
from itertools import pairwise, permutations
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.numeric.knots import elevate_degree, insert_knot, restrict_spline
from toolaxis.shape.adjacency import Edge
from toolaxis.shape.analytic import CylindricalSurface, SphericalSurface
from toolaxis.shape.face import Face
from toolaxis.shape.joining.joined_surface import join_patches, joins
from toolaxis.shape.joining.shared_boundary import meetings
from toolaxis.shape.kinks import kinks_of, split_at_kinks, with_kinks
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.shape.part import Part
from toolaxis.skin.find import find_skins
from toolaxis.skin.join import join
from toolaxis.skin.pieces import own_pieces

PARTS = Path(__file__).parents[3] / "shared" / "parts"
SHARES = np.random.default_rng(7).random((400, 2))
TURNS = [(swap, u, v) for swap in (False, True) for u in (False, True) for v in (False, True)]


def wave(nu: int = 7, nv: int = 6) -> Face:
    x, y = np.meshgrid(np.linspace(0, 60, nu), np.linspace(0, 40, nv), indexing="ij")
    return Face.from_bspline(np.stack([x, y + 0.1 * x, 4 * np.sin(x / 14) * np.cos(y / 12)], axis=-1))


def cut(face: Face, us: list[float], vs: list[float]) -> list[Face]:
    """Patches of a face between lines, along v first."""
    surface, patches = face.surface, []
    for u in pairwise(us):
        ku, net = restrict_spline(surface.knots_u, surface.control, surface.degree[0], *u)
        for v in pairwise(vs):
            kv, own = restrict_spline(surface.knots_v, net.swapaxes(0, 1), surface.degree[1], *v)
            patches.append(replace(face, surface=NurbsSurface(ku, kv, own.swapaxes(0, 1), surface.degree)))
    return patches


def written(face: Face, turn: tuple[bool, bool, bool], scale: float = 1.0, shift: float = 0.0) -> Face:
    """The same untrimmed face with other parameters: swapped, reversed, stretched."""
    swap, back_u, back_v = turn
    surface = face.surface
    ku, kv, net = surface.knots_u * scale + shift, surface.knots_v / scale - shift, surface.control
    if back_u:
        ku, net = -ku[::-1], net[::-1]
    if back_v:
        kv, net = -kv[::-1], net[:, ::-1]
    made = NurbsSurface(ku, kv, net, surface.degree)
    return replace(face, surface=made.swapped() if swap else made, flip=face.flip ^ swap ^ back_u ^ back_v)


def together(*faces: Face) -> Part:
    return Part.from_faces(faces)


def on_members(face: Face) -> float:
    """Greatest distance between a joined face and its members at mapped parameters, mm."""
    far = 0.0
    for member in face.members:
        uv = member.box[0] + SHARES * np.ptp(member.box, axis=0)
        own = uv @ member.matrix[:, :2].T + member.matrix[:, 2]
        far = max(far, float(np.abs(face.evaluate(uv).point - member.face.evaluate(own).point).max()))
        normals = np.einsum("nc,nc->n", face.normal(uv), member.face.normal(own))
        assert normals.min() > 1 - 1e-6
    return far


@pytest.mark.parametrize("k", range(8))
def test_a_surface_cut_and_joined_again_is_that_surface(k: int) -> None:
    face = wave()
    first, *others = cut(face, [0.0, 0.25, 1.0], [0.0, 1 / 3, 1.0])
    turned = [written(other, TURNS[(3 * k + i) % 8], 2.0 + i, -i) for i, other in enumerate(others)]
    part = together(first, *(turned[i] for i in list(permutations(range(3)))[k % 6]))
    found = join(part, (1, 2, 3, 4))
    assert len(found.faces) == 1 and not found.edges and found.original is part
    whole = found.faces[0]
    assert whole.label == "1+2+3+4" and whole.numbers == (1, 2, 3, 4) and whole.trims == () and whole.tolerance == 0.0
    assert np.allclose(whole.surface.domain, face.surface.domain, rtol=0, atol=1e-9)
    mine, theirs = whole.evaluate(SHARES), face.evaluate(SHARES)
    assert np.abs(mine.point - theirs.point).max() < 1e-9 and np.abs(mine.su - theirs.su).max() < 1e-7
    assert whole.flip == face.flip and np.abs(whole.normal(SHARES) - face.normal(SHARES)).max() < 1e-9
    assert whole.area == pytest.approx(face.area, rel=1e-7) and on_members(whole) < 1e-11


def test_other_degrees_and_knots_are_brought_together() -> None:
    face = wave()
    a, b = cut(face, [0.0, 0.5, 1.0], [0.0, 1.0])
    knots, net = elevate_degree(b.surface.knots_v, b.surface.control.swapaxes(0, 1), 3, 5)
    raised = NurbsSurface(b.surface.knots_u, knots, net.swapaxes(0, 1), (3, 5))
    knots, net = insert_knot(a.surface.knots_v, a.surface.control.swapaxes(0, 1), 3, 0.123)
    a = replace(a, surface=NurbsSurface(a.surface.knots_u, knots, net.swapaxes(0, 1), (3, 3)))
    whole = join(together(a, replace(b, surface=raised)), (1, 2)).faces[0]
    assert whole.surface.degree == (3, 5)
    assert np.abs(whole.evaluate(SHARES).point - face.evaluate(SHARES).point).max() < 1e-9


def test_rational_patches_join_whatever_the_factor_of_their_weights() -> None:
    ball = Face(SphericalSurface(20.0).nurbs())
    (u0, u1), (v0, v1) = ball.surface.domain
    us, vs = [u0, 0.5 * (u0 + u1), u1], [v0 + 0.2, 0.1, v1 - 0.3]
    patches = [replace(p, surface=replace(p.surface, control=p.surface.control * (k + 1)))
               for k, p in enumerate(cut(ball, us, vs))]
    whole = join(together(*patches), (1, 2, 3, 4)).faces[0]
    (a0, a1), (b0, b1) = whole.surface.domain
    points = whole.evaluate(SHARES * [a1 - a0, b1 - b0] + [a0, b0]).point
    assert np.abs(np.linalg.norm(points, axis=1) - 20.0).max() < 1e-10 and on_members(whole) < 1e-10


def test_a_ring_stays_open_at_its_seam() -> None:
    tube = Face(CylindricalSurface(10.0, v_range=(0.0, 30.0)).nurbs())
    u0, u1 = tube.surface.domain[0]
    patches = cut(tube, list(np.linspace(u0, u1, 4)), list(tube.surface.domain[1]))
    part = together(*(written(p, TURNS[2 * k]) for k, p in enumerate(patches)))
    assert len(part.edges) == 3
    found = join(part, (1, 2, 3))
    assert found.edges == () and found.faces[0].area == pytest.approx(2 * np.pi * 10 * 30, rel=1e-6)


def test_joined_borders_that_differ_move_by_no_more_than_is_told() -> None:
    a, b = cut(wave(), [0.0, 0.4, 1.0], [0.0, 1.0])
    net = b.surface.control.copy()
    net[:2, :, 2] += 2e-4 * np.sin(np.arange(net.shape[1]))
    b = replace(b, surface=replace(b.surface, control=net))
    part = together(a, b)
    whole = join(part, (1, 2)).faces[0]
    assert on_members(whole) <= whole.tolerance <= 1e-4 and on_members(whole) > 2e-5
    with pytest.raises(UnsupportedGeometry, match=r"faces 1 and 2 .* only within 0\.000\d+ mm, 0\.0001 mm are needed"):
        join_patches(part.faces, meetings(part, (1, 2)), tolerance=1e-4)


def test_the_bound_is_that_of_the_surface_not_of_its_control_points() -> None:
    """At degree 9 control points lie far apart where curves hardly do."""
    a, b = cut(wave(), [0.0, 0.5, 1.0], [0.0, 1.0])
    knots, net = elevate_degree(b.surface.knots_v, b.surface.control.swapaxes(0, 1), 3, 9)
    net[2:-2, :, 2] += 2e-4 * (-1.0) ** np.arange(len(net) - 4)[:, None]
    b = replace(b, surface=NurbsSurface(b.surface.knots_u, knots, net.swapaxes(0, 1), (3, 9)))
    whole = join(together(a, b), (1, 2), tolerance=1.2e-4).faces[0]
    assert on_members(whole) <= whole.tolerance < 6e-5 and on_members(whole) > 0.3 * whole.tolerance


@pytest.mark.parametrize("k", range(4))
def test_parameters_that_go_together_only_nearly_leave_no_range(k: int) -> None:
    patches = cut(wave(), [0.0, 0.4, 1.0], [0.0, 0.5, 1.0])
    control = patches[k].surface.control.copy()
    control[:, 1, :3] += 3e-4 * (control[:, 2, :3] - control[:, 1, :3]) / 10
    control[:, -2, :3] += 4e-4 * (control[:, -1, :3] - control[:, -2, :3]) / 10
    patches[k] = replace(patches[k], surface=replace(patches[k].surface, control=control))
    whole = join(together(*patches), (1, 2, 3, 4)).faces[0]
    assert on_members(whole) <= whole.tolerance <= 5e-4 and whole.tolerance > 1e-5


def test_speeds_become_the_same_on_both_sides() -> None:
    """The second patch goes on along the tangents of the first, ten times as fast in its own parameter."""
    a = cut(wave(), [0.0, 0.5, 1.0], [0.0, 1.0])[0]
    end = a.surface.control[-1] - a.surface.control[-2]
    far = a.surface.control[-1] + np.outer([1.0, 2.0, 3.0], [10.0])[..., None] * end[None] * [1.0, 1.0, 1.0, 0.0]
    net = np.concatenate([a.surface.control[-1:], far])
    b = replace(a, surface=NurbsSurface(np.repeat([0.0, 1.0], 4), a.surface.knots_v, net, (3, 3)))
    whole = join(together(a, b), (1, 2)).faces[0]
    (axis, t), = joins(whole)
    assert axis == 0 and t == pytest.approx(0.5) and kinks_of(whole) == ((), ())
    v = np.linspace(0.1, 0.9, 9)
    left, right = (whole.evaluate(np.column_stack([np.full(9, at), v])).su for at in (np.nextafter(t, 0), t))
    assert np.allclose(left, right, rtol=1e-9)


def test_kinks_of_members_go_on_and_joins_are_none() -> None:
    face = wave()
    knots, net = face.surface.knots_v, face.surface.control.swapaxes(0, 1)
    while np.count_nonzero(knots == 0.4) < 3:
        knots, net = insert_knot(knots, net, 3, 0.4)
    net[5:, :, 2] += 0.5 * np.arange(1, len(net) - 4)[:, None]
    creased = replace(face, surface=NurbsSurface(face.surface.knots_u, knots, net.swapaxes(0, 1), (3, 3)))
    patches = [with_kinks(p) for p in cut(creased, [0.0, 0.5, 1.0], [0.0, 1.0])]
    patches[1] = with_kinks(written(replace(patches[1], kinks=((), ())), (True, False, True), 3.0))
    assert patches[1].kinks[1] == () and len(patches[1].kinks[0]) == 1
    whole = join(together(*patches), (1, 2)).faces[0]
    assert whole.kinks[0] == () and whole.kinks[1] == pytest.approx((0.4,))
    pieces = split_at_kinks(whole)
    assert [one.label for one in pieces] == ["1+2a", "1+2b"]
    assert [[own.label for own in own_pieces(one)] for one in pieces] == [["1a", "2a"], ["1b", "2b"]]
    assert sum(own.area for one in pieces for own in own_pieces(one)) == pytest.approx(whole.area, rel=1e-6)


def test_many_patches_have_a_short_name() -> None:
    patches = cut(wave(), list(np.linspace(0, 1, 4)), list(np.linspace(0, 1, 4)))
    part = together(*patches)
    assert find_skins(part).joined == (tuple(range(1, 10)),)
    whole = join(part, range(1, 10)).faces[0]
    assert whole.label == "1+2+3+6more" and whole.numbers == tuple(range(1, 10))
    piece = whole.trimmed((np.array([[0.0, 0.0], [0.5, 0.0], [0.5, 1 / 3], [0.0, 1 / 3]]),), whole.label + "a")
    assert [one.label for one in own_pieces(piece)] == ["1", "4a"] and own_pieces(whole) == part.faces


def trimmed_pair() -> Part:
    a, b = cut(wave(), [0.0, 0.5, 1.0], [0.0, 1.0])
    b = written(b, (True, False, True))
    t = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    hole = np.column_stack([0.25 + 0.1 * np.cos(t), 0.5 + 0.2 * np.sin(t)])
    a = a.trimmed((np.array([[0.05, 0.0], [0.5, 0.1], [0.5, 0.9], [0.02, 1.0]]), hole))
    b = b.trimmed((np.array([[-0.9, 0.5], [-0.1, 0.5], [-0.2, 0.98], [-0.7, 0.95]]),))
    return Part.from_faces([a, b])


def test_loops_go_on_across_the_join() -> None:
    part = trimmed_pair()
    whole = join(part, (1, 2)).faces[0]
    assert len(whole.trims) == 2 and len(whole.trims[1]) == 40
    assert whole.area == pytest.approx(sum(face.area for face in part.faces), rel=1e-6)
    for member in whole.members:
        uv = member.box[0] + SHARES * np.ptp(member.box, axis=0)
        own = uv @ member.matrix[:, :2].T + member.matrix[:, 2]
        assert np.array_equal(whole.contains(uv), member.face.contains(own))
    line = np.column_stack([np.full(9, 0.5), np.linspace(0.15, 0.85, 9)])
    aside = np.array([1e-6, 0.0])
    assert whole.contains(line + aside).all() and whole.contains(line - aside).all()


def test_pieces_come_back_as_pieces_of_the_members() -> None:
    part = trimmed_pair()
    whole = join(part, (1, 2)).faces[0]
    assert own_pieces(whole) == part.faces and own_pieces(part.faces[0]) == (part.faces[0],)
    piece = whole.trimmed((np.array([[0.3, 0.3], [0.7, 0.3], [0.7, 0.6], [0.3, 0.6]]),), "1+2b")
    found = own_pieces(piece)
    assert [one.label for one in found] == ["1b", "2b"] and [one.number for one in found] == [1, 2]
    assert found[1].surface is part.faces[1].surface
    assert sum(one.area for one in found) == pytest.approx(piece.area, rel=1e-6)
    left = whole.trimmed((np.array([[0.3, 0.3], [0.5, 0.3], [0.5, 0.6], [0.3, 0.6]]),), "1+2c")
    assert [one.label for one in own_pieces(left)] == ["1c"]


def test_a_joined_face_stands_in_the_part_as_its_members_did() -> None:
    face = wave()
    patches = cut(face, [0.0, 0.3, 0.7, 1.0], [0.0, 1.0])
    wall = Face.from_bspline([[[-5.0, -10.0, -9.0], [-5.0, 50.0, -9.0]], [[-5.0, -10.0, 9.0], [-5.0, 50.0, 9.0]]],
                             degree=(1, 1))
    part = together(wall, *patches)
    part = replace(part, edges=(*part.edges, Edge((1, 2), "concave", np.zeros((2, 3)))), selected=(4, 3))
    found = join(part, (3, 4))
    assert [one.label for one in found.faces] == ["1", "2", "3+4"] and found.selected == (3,)
    assert [one.label for one in found.skin(2)] == ["2", "3+4"] and [f.number for f in found.surroundings(3)] == [1]
    assert {edge.faces for edge in found.edges} == {(2, 3), (1, 2)} and found.bodies[0].faces == (1, 2, 3)
    with pytest.raises(InvalidInput, match=r"face 4 is joined to face 3\+4: name that one by its first number, 3"):
        found.face(4)
    with pytest.raises(InvalidInput, match=r"face 3\+4 is joined already"):
        join(found, (2, 3))


def test_moving_the_part_moves_the_joined_face() -> None:
    angle, part = 0.7, trimmed_pair()
    matrix = np.array([[np.cos(angle), -np.sin(angle), 0, 3], [np.sin(angle), np.cos(angle), 0, -2], [0, 0, -1, 9],
                       [0, 0, 0, 1]])
    one, other = join(part.transformed(matrix), (1, 2)), join(part, (1, 2)).transformed(matrix)
    assert other.original is not None and other.original.faces[0].flip != part.faces[0].flip
    assert np.allclose(one.faces[0].surface.control, other.faces[0].surface.control, atol=1e-9)
    assert one.faces[0].flip == other.faces[0].flip and on_members(other.faces[0]) < 1e-9


def bent(angle: float) -> list[Face]:
    """Two flat patches that meet at an angle in rad, but told as smooth."""
    x = np.linspace(0, 10, 4)
    flat = np.stack(np.broadcast_arrays(x[:, None] - 10, x[None], np.zeros((4, 4))), axis=-1)
    tilt = np.stack(np.broadcast_arrays(x[:, None] * np.cos(angle), x[None], x[:, None] * np.sin(angle)), axis=-1)
    return [Face.from_bspline(flat), Face.from_bspline(tilt)]


def sheared() -> list[Face]:
    """Flat patches whose lines of constant v turn by 45 degrees where they meet."""
    a, b = bent(0.0)
    net = b.surface.control.copy()
    net[..., 1] += net[..., 0]
    return [a, replace(b, surface=replace(b.surface, control=net))]


def unlike() -> list[Face]:
    """The same border with another speed along it."""
    a, b = bent(0.0)
    net = b.surface.control.copy()
    net[:, 1, 1] += 0.5
    return [a, replace(b, surface=replace(b.surface, control=net))]


def corner() -> list[Face]:
    """Three patches of a ball around one corner."""
    s = 1 / np.sqrt(3)
    quad = np.array([[[1.0, 0, 0], [0.75, 0.75, 0]], [[0.75, 0, 0.75], [s, s, s]]])
    faces = []
    for turn in range(3):
        faces.append(Face.from_bspline(np.roll(quad, turn, axis=2) * 30, degree=(1, 1)))
    return faces


def offset() -> list[Face]:
    a, b = bent(0.0)
    return [a, b.transformed(np.array([[1, 0, 0, 0], [0, 1, 0, 4.0], [0, 0, 1, 0], [0, 0, 0, 1.0]]))]


def turned_over() -> list[Face]:
    a, b = bent(0.0)
    return [a, replace(b, flip=True)]


def shape_of_an_l() -> list[Face]:
    return cut(wave(), [0.0, 0.5, 1.0], [0.0, 0.5, 1.0])[:3]


@pytest.mark.parametrize(("faces", "what"), [
    (bent(0.012), "normals turn by 0.69 degrees across a join"), (sheared(), "would turn by 45 degrees across a join"),
    (unlike(), "faces 1 and 2 .* parameters along the common edge do not go together, .* 0.* mm apart"),
    (corner(), "faces [123] and [123] meet, but not as neighbours|do not lie in full rows"),
    (offset(), "faces 1 and 2 cannot be joined: they end 4 mm apart"),
    (turned_over(), "have their material on opposite sides"), (shape_of_an_l(), "3 patches do not lie in full rows"),
    (bent(0.5), "face 2 does not continue any of the others smoothly"),
])
def test_what_cannot_be_joined_is_told(faces: list[Face], what: str) -> None:
    part = Part.from_faces(faces)
    if "smoothly" not in what:
        part = replace(part, edges=tuple(replace(edge, kind="tangent") for edge in part.edges))
    numbers = [face.number for face in part.faces]
    with pytest.raises(UnsupportedGeometry, match=what):
        join_patches(part.faces, meetings(part, numbers))
    found = find_skins(part)
    assert sorted([*found.single, *(n for group in found.joined for n in group)]) == numbers


@pytest.mark.parametrize(("faces", "what"), [
    (turned_over(), "normals turn by up to 90 degrees"),
    (bent(0.5), "face 2 does not continue any of the others smoothly"),
])
def test_what_is_no_skin_is_told(faces: list[Face], what: str) -> None:
    part = Part.from_faces(faces)
    if "smoothly" not in what:
        part = replace(part, edges=tuple(replace(edge, kind="tangent") for edge in part.edges))
    with pytest.raises(UnsupportedGeometry, match=what):
        join(part, (1, 2))
    assert find_skins(part).joined == ()


@pytest.mark.parametrize("faces", [sheared(), unlike(), shape_of_an_l(), bent(0.012), offset()])
def test_skins_need_no_parameters_that_go_together(faces: list[Face]) -> None:
    part = Part.from_faces(faces)
    part = replace(part, edges=tuple(replace(edge, kind="tangent") for edge in part.edges))
    whole = join(part, [face.number for face in part.faces]).faces[0]
    assert whole.members[0].matrix is None and whole.area == pytest.approx(sum(face.area for face in faces), rel=1e-5)


def test_an_edge_that_is_a_point_joins_nothing() -> None:
    part = Part.from_faces(bent(0.0))
    with pytest.raises(UnsupportedGeometry, match="face 2 does not continue any of the others"):
        join(replace(part, edges=(Edge((1, 2), "tangent", np.zeros((5, 3))),)), (1, 2))


@pytest.mark.parametrize(("numbers", "what"), [((1,), "at least two"), ((1, 1), "joined with itself"),
                                               ((1, 7), "face 7 does not exist"), ((1, "2"), "no number of a face")])
def test_wrong_lists_of_faces_are_told(numbers: tuple[int, ...], what: str) -> None:
    with pytest.raises(InvalidInput, match=what):
        ta.join(Part.from_faces(bent(0.0)), numbers)


def test_a_skin_holds_all_patches_that_continue_it() -> None:
    patches = cut(wave(), [0.0, 0.3, 0.6, 1.0], [0.0, 0.5, 1.0])
    far = wave().transformed(np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 90.0], [0, 0, 0, 1]]))
    found = find_skins(Part.from_faces([*patches[:5], far]))
    assert found.joined == ((1, 2, 3, 4, 5),) and found.single == (6,) and found.reasons == ()


def test_patches_of_a_real_nacelle_join_to_a_ring() -> None:
    if not (PARTS / "nacelle.stp").exists():
        pytest.skip("the parts by others are not here")
    part = ta.load(PARTS / "nacelle.stp")
    assert find_skins(part).joined == ((1, 2), (3, 4, 5, 6))
    whole = join_patches([part.face(n) for n in (3, 4, 5, 6)], meetings(part, (3, 4, 5, 6)))
    assert on_members(whole) <= max(whole.tolerance, 1e-9) and whole.tolerance < 1e-8
    assert whole.area == pytest.approx(sum(part.face(n).area for n in (3, 4, 5, 6)), rel=1e-6)
