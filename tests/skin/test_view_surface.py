"""Faces seen along a direction as one: every point is one of theirs, with its derivatives, area and outline."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import UnsupportedGeometry
from toolaxis.job.files.plan_folder import read_plan, stage_folder, write_plan
from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.polygons import inside, signed_area, slabs
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.shape.part import Part
from toolaxis.skin import view_surface
from toolaxis.skin.find import find_skins
from toolaxis.skin.join import join
from toolaxis.skin.pieces import own_pieces
from toolaxis.skin.seen_face import SeenFace
from toolaxis.skin.unite import unite
from toolaxis.skin.view_surface import ViewSurface

PLACES = np.random.default_rng(3).random((500, 2))


@pytest.fixture(scope="module")
def united(quilt: Part) -> Face:
    return join(quilt, (1, 2, 3)).faces[0]


def inner(face: Face) -> np.ndarray:
    u0, u1, v0, v1 = face.bounds
    uv = np.array([u0, v0]) + PLACES * np.array([u1 - u0, v1 - v0])
    return uv[face.contains(uv)]


def test_points_normals_and_curvatures_are_those_of_the_members(united: Face, whole: Face) -> None:
    assert isinstance(united.surface, ViewSurface) and united.label == "1+2+3"
    uv = inner(united)
    assert len(uv) > 300
    found = nearest(whole, united.evaluate(uv).point)
    assert found.distance.max() < 1e-9
    assert (united.normal(uv) * whole.normal(found.uv)).sum(axis=1).min() > 1 - 1e-12
    mine, theirs = united.curvature(uv), whole.curvature(found.uv)
    assert np.abs(mine.k1 - theirs.k1).max() < 1e-9 and np.abs(mine.k2 - theirs.k2).max() < 1e-9


def ring() -> Face:
    """A ring around z: closed in u, and seen whole from above."""
    turn = np.linspace(0, 2 * np.pi, 13)
    radius = np.array([4.0, 6.0, 8.0, 9.0])
    height = np.broadcast_to(0.2 * radius**2, (13, 4))
    x, y = np.outer(np.cos(turn), radius), np.outer(np.sin(turn), radius)
    return Face.from_bspline(np.stack([x, y, height], axis=-1))


def folded() -> Face:
    """A strip along x, 20 mm long, on which the parameter runs back by 0.012 mm in one place: a fold with no height."""
    x = np.linspace(0.0, 20.0, 60)
    back = 0.9 * x[1]
    x[30], x[31] = x[30] + back, x[31] - back
    z = 0.01 * (x - 10) ** 2
    rows = [np.column_stack([x, np.full(60, y), z]) for y in (0.0, 4.0)]
    return Face.from_bspline(np.stack(rows, axis=1), (3, 1))


@pytest.mark.parametrize("plainly", [False, True])
def test_next_to_a_fold_of_a_face_its_points_lie_at_the_places_too(plainly: bool) -> None:
    """Found on a fillet of another's part: points 0.1 mm beside their places, and passes that ran to and fro there."""
    one = SeenFace(folded(), np.eye(3)[:2], np.zeros(3))
    along = one.face.evaluate(np.column_stack([np.linspace(0, 1, 9001), np.full(9001, 0.5)])).point[:, 0]
    back = np.flatnonzero(np.diff(along) < 0)
    assert len(back) and along[back[0]] - along[back[-1] + 1] > 5e-3, "else it does not fold"
    places = np.column_stack([np.linspace(9.0, 11.5, 10001), np.full(10001, 1.7)])
    uv = one._find_plainly(places, one._begin(places)) if plainly else one.find(places)
    assert np.abs(one.face.evaluate(uv).point[:, :2] - places).max() < 1e-9


def test_the_kernel_finds_what_its_plain_twin_finds(united: Face) -> None:
    assert isinstance(united.surface, ViewSurface)
    seen = [*united.surface.seen, SeenFace(ring(), np.eye(3)[:2], np.zeros(3))]
    for one in seen:
        assert one.has_kernel == _compiled.available
        low, high = one.box
        places = low - 0.1 * (high - low) + PLACES * 1.2 * (high - low)
        places = places[one.contains(places)]
        assert len(places) > 100
        uv = one._find_plainly(places, one._begin(places))
        assert np.abs(one.find(places) - uv).max() < 1e-9
        for mine, plain in zip(one.evaluate(places), one._evaluate_plainly(uv), strict=True):
            assert np.abs(mine - plain).max() < 1e-7
        assert np.abs(one.project(one.evaluate(places).point) - places).max() < 1e-9
    assert np.isfinite(seen[-1].periods[0])


def test_derivatives_are_those_of_the_points(united: Face) -> None:
    uv, step = inner(united), 1e-4
    d = united.evaluate(uv)
    for axis, first, second in ((0, d.su, d.suu), (1, d.sv, d.svv)):
        shift = step * np.eye(2)[axis]
        ahead, back = united.evaluate(uv + shift), united.evaluate(uv - shift)
        smooth = united.contains(uv + shift) & united.contains(uv - shift)
        rate = (ahead.point - back.point) / (2 * step)
        bend = (ahead.point - 2 * d.point + back.point) / step**2
        assert np.abs(rate - first)[smooth].max() < 1e-6 and np.abs(bend - second)[smooth].max() < 1e-4
        mixed = ((ahead.sv - back.sv) if axis == 0 else (ahead.su - back.su)) / (2 * step)
        assert np.abs(mixed - d.suv)[smooth].max() < 1e-6


def test_areas_add_up_and_the_outline_is_that_of_the_whole(united: Face, whole: Face, quilt: Part) -> None:
    assert united.area == pytest.approx(sum(face.area for face in quilt.faces), rel=1e-12)
    assert united.trimmed(tuple(loop.copy() for loop in united.trims)[:1]).area == pytest.approx(whole.area, rel=1e-5)
    half = united.trims[0] * [1, 0.5]
    assert ta.Face.area.func(replace(united, trims=(half,))) < united.area  # a piece is measured
    border = united.evaluate(united.trims[0]).point
    u0, u1, v0, v1 = whole.bounds
    uv = nearest(whole, border).uv
    edge = np.minimum(np.minimum(uv[:, 0] - u0, u1 - uv[:, 0]), np.minimum(uv[:, 1] - v0, v1 - uv[:, 1]))
    assert edge.max() < 1e-3 and len(united.trims) == 1


def test_moving_the_faces_moves_the_surface(united: Face) -> None:
    turn = ta.Face.transformed
    for mirror in (1.0, -1.0):
        m = np.array([[0, -1, 0, 5.0], [1, 0, 0, -3.0], [0, 0, mirror, 2.0], [0, 0, 0, 1]])
        moved, uv = turn(united, m), inner(united)
        expected = united.evaluate(uv).point @ m[:3, :3].T + m[:3, 3]
        assert np.abs(moved.evaluate(uv).point - expected).max() < 1e-9
        assert np.abs(moved.normal(uv) - united.normal(uv) @ m[:3, :3].T).max() < 1e-9


def test_pieces_of_it_are_pieces_of_the_members(united: Face) -> None:
    u0, u1, v0, v1 = united.bounds
    middle = 0.3 * u0 + 0.7 * u1
    loops = np.array([[u0 + 10, v0 + 10], [middle, v0 + 10], [middle, v1 - 10], [u0 + 10, v1 - 10]])
    piece = united.trimmed((loops,), united.label + "b")
    own = own_pieces(piece)
    assert {one.number for one in own} == {1, 2, 3} and all(one.label.endswith("b") for one in own)
    assert sum(one.area for one in own) == pytest.approx(piece.area, rel=1e-4)
    surface = united.surface
    assert isinstance(surface, ViewSurface)
    for one in own:
        points = surface.seen[0].project(one.evaluate(one.grid(9, 9)).point)
        assert inside(slabs((loops,)), points).all()
    assert own_pieces(united) == surface.members


def test_all_parts_of_a_piece_that_falls_apart_are_pieces_of_the_members(united: Face) -> None:
    """Found: members of which only a further part of the piece has something were left out, and so not judged."""
    u0, u1, v0, v1 = united.bounds
    wide, high = 0.1 * (u1 - u0), 0.1 * (v1 - v0)
    corner = np.array([[0, 0], [wide, 0], [wide, high], [0, high]])
    parts = [corner + np.array([u0 + a * wide, v0 + b * high]) for a in (3, 6) for b in (3, 6)]
    assert united.contains(np.concatenate(parts)).all()
    for k in range(4):
        piece = united.trimmed((*parts[k:], *parts[:k]), united.label + "b")
        assert sum(one.area for one in own_pieces(piece)) == pytest.approx(piece.area, rel=1e-3)


@pytest.fixture(scope="module")
def bowl() -> Face:
    """A ring and the bottom within it, closed around z both, the bottom with a pole: one skin, seen from above."""
    turn = np.linspace(0, 2 * np.pi, 13)
    radius, height = np.array([0.0, 4 / 3, 8 / 3, 4.0]), np.array([1.2, 1.2, 1.6 - 4 / 3 * 0.5, 1.6])
    net = np.stack([np.outer(np.cos(turn), radius), np.outer(np.sin(turn), radius), np.tile(height, (13, 1))], axis=-1)
    outer = ring()
    flat = outer.surface.control[..., :3] * np.array([1.0, 1.0, 0.25]) + np.array([0, 0, 0.8])
    around = Face.from_bspline(flat)
    return unite([around, replace(Face.from_bspline(net), number=2, label="2")])


def seen_from_above(bowl: Face, corners: tuple | np.ndarray) -> np.ndarray:
    """Places x, y in the plane of the skin."""
    surface = bowl.surface
    assert isinstance(surface, ViewSurface)
    return surface.seen[0].project(np.column_stack([corners, np.ones(len(corners))]))


@pytest.mark.parametrize("corners", [
    ((-2.0, -3.0), (3.0, -3.0), (3.0, 2.0), (-2.0, 2.0)),  # around the pole
    ((0.0, -0.5), (7.0, -0.5), (7.0, 0.7), (0.0, 0.7)),  # through the pole, and over the seam of both
    ((3.0, -2.0), (6.0, -2.0), (6.0, 2.0), (3.0, 2.0)),  # over the seam
    ((-6.5, -6.0), (6.0, -6.0), (6.0, 6.5), (-6.0, 6.0)),  # all of the bottom
    ((-6.0, 1.0), (-3.0, 1.0), (-3.0, 3.0), (-6.0, 3.0)),  # beside
])
def test_pieces_across_seams_and_poles_are_pieces_of_the_members(bowl: Face, corners: tuple) -> None:
    """Found: of a closed face that a piece runs around the whole was judged, and what other tools machine failed."""
    loop = seen_from_above(bowl, corners)
    piece = bowl.trimmed((loop,), bowl.label + "b")
    own = own_pieces(piece)
    assert sum(one.area for one in own) == pytest.approx(piece.area, rel=2e-3)
    surface = bowl.surface
    assert isinstance(surface, ViewSurface)
    grown = loop + 0.05 * np.sign(loop - loop.mean(axis=0))
    for one in own:
        points = surface.seen[0].project(one.evaluate(one.grid(12, 12)).point)
        assert inside(slabs((grown,)), points).all()


def test_a_piece_of_parts_side_by_side_is_cut_where_its_borders_coincide(bowl: Face) -> None:
    """Found: where two parts of a piece shared a border, all members were judged whole."""
    low = np.array([[1.0, -6.0], [5.0, -6.0], [5.0, 0.5], [1.0, 0.5]])
    high = np.array([[1.0, 0.5], [5.0, 0.5], [5.0, 6.0], [3.0, 6.0], [1.0, 6.0]])
    sliver = np.array([[1.0, 2.0], [1.4, 3.0], [1.0, 4.0]])
    loops = tuple(seen_from_above(bowl, loop) for loop in (low, high, sliver))
    piece = bowl.trimmed(loops, bowl.label + "b")
    assert sum(one.area for one in own_pieces(piece)) == pytest.approx(piece.area, rel=2e-3)


def test_holes_stay_holes_and_gaps_close(whole: Face) -> None:
    """A hole across two patches, the second of which lies 8 um higher."""
    cut = 0.5
    u, v = whole.surface.domain
    way = np.linspace(0, np.pi, 40)
    arc = np.column_stack([0.12 * np.sin(way), -0.12 * np.cos(way)])
    left = np.vstack([[u[0], v[0]], [cut, v[0]], *[[cut - x, 0.5 + y] for x, y in arc], [cut, v[1]], [u[0], v[1]]])
    right = np.vstack([[cut, v[0]], [u[1], v[0]], [u[1], v[1]], [cut, v[1]],
                       *[[cut + x, 0.5 + y] for x, y in arc[::-1]]])
    faces = [whole.trimmed((left,)), replace(whole.trimmed((right,)), number=2, label="2")]
    faces[1] = faces[1].transformed(np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.008], [0, 0, 0, 1.0]]))
    made = unite(faces)
    hole = whole.area - sum(face.area for face in faces)
    assert len(made.trims) == 2 and abs(signed_area(made.trims[1])) == pytest.approx(hole, rel=0.1)
    assert made.area == pytest.approx(sum(face.area for face in faces), rel=1e-9)


def test_what_is_covered_or_turns_too_far_is_refused(whole: Face) -> None:
    above = whole.transformed(np.array([[1, 0, 0, 20], [0, 1, 0, 0], [0, 0, 1, 15], [0, 0, 0, 1.0]]))
    with pytest.raises(UnsupportedGeometry, match="mm above or below face"):
        unite([whole, replace(above, number=2, label="2")])
    with pytest.raises(UnsupportedGeometry, match="turn by up to 90 degrees from the best view of them"):
        unite([whole, replace(whole, flip=True, number=2, label="2")])


def test_skins_are_found_and_planes_belong_to_them_where_they_are_narrow(quilt: Part) -> None:
    assert find_skins(quilt).joined == ((1, 2, 3),)
    plain = replace(quilt, faces=(quilt.faces[0], replace(quilt.faces[1], kind="plane"), quilt.faces[2]))
    assert find_skins(plain).joined == ((1, 3),) and find_skins(plain, 100.0).joined == ((1, 2, 3),)


def test_a_skin_is_planned_as_one_face_judged_and_read_again(quilt: Part, whole: Face, tmp_path: Path) -> None:
    made = ta.plan(quilt, "ball:16", 0.4, faces="skins", method="normal", workers=1)
    (op,) = made.operations
    assert made.outcome == "complete" and op.name == "op01-face1+2+3" and op.orientation.ideal > 0
    verdict = ta.verify(made)
    assert verdict.passed and verdict.operations[0].faces == ("1", "2", "3")
    single = ta.plan(ta.Part.from_faces([whole]), "ball:16", 0.4, method="normal", passes="planes", workers=1)
    assert op.orientation.length == pytest.approx(single.length, rel=0.1)
    with stage_folder(tmp_path / "plan") as stage:
        write_plan(made, stage.folder)
        stage.publish()
    document = json.loads((tmp_path / "plan" / "plan.json").read_text())
    assert document["part"]["joined"] == [[1, 2, 3]]
    again = read_plan(tmp_path / "plan").operations[0]
    assert np.array_equal(again.face.surface.control, op.face.surface.control)
    assert all(map(np.array_equal, again.face.trims, op.face.trims))
    deep = replace(op.path, cl=op.path.cl - 0.05 * op.path.axis) if op.path else None
    assert not ta.verify(replace(made, operations=(replace(op, path=deep),))).passed


def test_skins_of_faces_without_folds_have_none_and_look_for_none(quilt: Part, monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: with thousands of cells it took half a minute to learn that a height over a plane does not run back."""
    skin = join(quilt, (1, 2, 3)).faces[0]
    assert not any(face.surface.turning_cells.turning.any() for face in skin.own_faces)
    monkeypatch.setattr(view_surface, "find_turning_cells", lambda data: pytest.fail("cells are looked for"))
    assert not skin.surface.turning_cells.turning.any() and not len(skin.folds(skin.grid(5, 5)).rows)


def test_beyond_their_outline_faces_go_on_without_a_jump(united: Face) -> None:
    """Found: a spline through points of all of them took over at the outline, up to 0.07 mm and 8 degrees off."""
    loop = united.surface.outline[0]
    ahead = np.roll(loop, -1, axis=0)
    long = np.linalg.norm(ahead - loop, axis=1) > 0.1
    middle, way = (loop + ahead)[long] / 2, (ahead - loop)[long]
    out = np.column_stack([way[:, 1], -way[:, 0]]) / np.linalg.norm(way, axis=1)[:, None]
    out *= np.sign(signed_area(loop))
    near = middle + 1e-3 * out, middle - 1e-3 * out
    assert (united.surface.owners(near[0]) < 0).all() and (united.surface.owners(near[1]) >= 0).all()
    beyond, within = (united.evaluate(uv).point for uv in near)
    normals = [united.normal(uv) for uv in near]
    assert np.abs(((beyond - within) * normals[1]).sum(axis=1)).max() < 1e-6
    assert (normals[0] * normals[1]).sum(axis=1).min() > np.cos(np.radians(0.1))


def test_derivatives_beyond_the_outline_are_those_of_the_points(united: Face) -> None:
    surface, step = united.surface, 1e-4
    assert isinstance(surface, ViewSurface)
    loop = surface.outline[0]
    for share in (0.1, 0.4, 0.7, 0.9, 1.3):
        uv = loop + share * surface._continuation.width * unit_of(loop - loop.mean(axis=0))
        uv = uv[surface.owners(uv) < 0]
        d = surface.evaluate(uv)
        for axis, first, second in ((0, d.su, d.suu), (1, d.sv, d.svv)):
            shift = step * np.eye(2)[axis]
            ahead, back = surface.evaluate(uv + shift), surface.evaluate(uv - shift)
            off = np.linalg.norm((ahead.point - back.point) / (2 * step) - first, axis=1)
            bent = np.linalg.norm((ahead.point - 2 * d.point + back.point) / step**2 - second, axis=1)
            # where the nearest place passes a corner of the outline the second derivative jumps
            assert np.quantile(off, 0.97) < 1e-5 and np.quantile(bent, 0.9) < 0.02


def unit_of(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]
