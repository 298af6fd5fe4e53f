"""Borders found by position, where the file shares no edges."""

import numpy as np
import pytest

from toolaxis.shape.adjacency import consistent, edges_from_borders
from toolaxis.shape.face import Face
from toolaxis.shape.joining.edge_matching import match_edges, sides_of
from toolaxis.shape.part import Part


def quad(a, b, c, d, **options):
    """A bilinear face with corners in the order (0, 0), (1, 0), (1, 1), (0, 1)."""
    return Face.from_bspline(np.array([[a, d], [b, c]], dtype=float), (1, 1), **options)


def cube(size=10.0):
    """Six loose faces with their normals outside, in mixed parametrisations."""
    o, x, y, xy = (0, 0), (size, 0), (0, size), (size, size)
    low, high = (lambda p: (*p, 0.0)), (lambda p: (*p, size))
    return [quad(low(o), low(y), low(xy), low(x)), quad(high(x), high(xy), high(y), high(o)),
            quad(low(o), low(x), high(x), high(o)), quad(low(xy), low(y), high(y), high(xy)),
            quad(high(x), low(x), low(xy), high(xy)), quad(low(o), high(o), high(y), low(y))]


def length(polyline):
    return np.linalg.norm(np.diff(polyline, axis=0), axis=1).sum()


def by_faces(edges):
    return {tuple(sorted(edge.faces)): edge.kind for edge in edges}


def test_a_cube_of_loose_faces_has_twelve_convex_edges():
    part = Part.from_faces(cube())
    assert len(part.edges) == 12
    assert {edge.kind for edge in part.edges} == {"convex"}
    assert [edge.angle for edge in part.edges] == pytest.approx([np.pi / 2] * 12)
    assert all(len(part.neighbours(number)) == 4 for number in range(1, 7))
    assert sum(length(edge.polyline) for edge in part.edges) == pytest.approx(120)


def test_a_room_has_concave_edges():
    room = [Face(face.surface, flip=True) for face in cube()]
    assert {edge.kind for edge in Part.from_faces(room).edges} == {"concave"}


@pytest.mark.parametrize("flip", [False, True])
@pytest.mark.parametrize("turn", [0, 1, 2, 3])
def test_a_surface_cut_in_two_goes_on_smoothly_however_the_pieces_run(turn, flip):
    left = quad((0, 0, 0), (5, 0, 1), (5, 8, 2), (0, 8, 0))
    corners = [(5, 0, 1), (10, 0, 2), (10, 8, 4), (5, 8, 2)]
    right = quad(*(corners[turn:] + corners[:turn]))
    part = Part.from_faces([Face(left.surface, flip=flip), Face(right.surface, flip=flip)])
    assert by_faces(part.edges) == {(1, 2): "tangent"}
    assert part.edges[0].angle < 1e-9
    assert [face.number for face in part.skin(2)] == [2, 1]


def test_one_piece_turned_over_is_still_smooth_but_not_consistent():
    left, right = quad((0, 0, 0), (5, 0, 0), (5, 8, 0), (0, 8, 0)), quad((5, 0, 0), (9, 0, 0), (9, 8, 0), (5, 8, 0))
    one, other = Face(left.surface, number=1), Face(right.surface, number=2, flip=True)
    borders = match_edges([*sides_of(one), *sides_of(other)], 12.0)
    assert len(borders) == 1
    assert not consistent(borders[0], one, other)
    assert edges_from_borders([one, other], borders)[0].kind == "tangent"
    assert consistent(borders[0], one, Face(right.surface, number=2))


def test_a_part_of_a_side_is_enough():
    """A T: a short side along the middle of a long one."""
    long = quad((0, 0, 0), (30, 0, 0), (30, 10, 0), (0, 10, 0))
    short = quad((8, 10, 0), (16, 10, 0), (16, 20, 0), (8, 20, 0))
    edges = Part.from_faces([long, short]).edges
    assert by_faces(edges) == {(1, 2): "tangent"}
    assert np.linalg.norm(np.ptp(edges[0].polyline, axis=0)) == pytest.approx(8, abs=1.1)


def test_round_loops_are_matched_too():
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    ring = 0.5 + 0.2 * np.column_stack([np.cos(angle), np.sin(angle)])
    plate = quad((0, 0, 0), (50, 0, 0), (50, 50, 0), (0, 50, 0), trims=([[0, 0], [1, 0], [1, 1], [0, 1]], ring[::-1]))
    plug = quad((0, 0, 0), (50, 0, 0), (50, 50, 0), (0, 50, 0), trims=(ring,))
    edges = Part.from_faces([plate, plug]).edges
    assert by_faces(edges) == {(1, 2): "tangent"}
    assert sum(length(edge.polyline) for edge in edges) == pytest.approx(2 * np.pi * 10, rel=0.01)


@pytest.mark.parametrize("away", [(0.0, 0.0, 0.05), (0.1, 0.0, 0.0), (0.0, 10.0, 0.0)])
def test_faces_apart_or_at_one_corner_only_do_not_touch(away):
    left = quad((0, 0, 0), (5, 0, 0), (5, 10, 0), (0, 10, 0))
    right = quad(*(np.array(p, dtype=float) + away for p in [(5, 0, 0), (9, 0, 0), (9, 10, 0), (5, 10, 0)]))
    assert Part.from_faces([left, right]).edges == ()


def test_edges_given_are_taken_as_they_are():
    assert Part.from_faces(cube(), ()).edges == ()
