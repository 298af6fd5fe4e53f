"""Parts: skins, surroundings, edges and what makes a part invalid."""

import numpy as np
import pytest

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import rotation
from toolaxis.shape.adjacency import Border, Edge, edges_from_borders, gaps
from toolaxis.shape.face import Face
from toolaxis.shape.part import Body, Part

LINE = np.array([[0.0, 0, 0], [0, 10, 0]])


def strip(direction, number=1, flip=False, kind="bspline"):
    """A ruled strip that starts on the y axis and runs 10 mm in a direction of the x-z plane."""
    start = np.array([[0.0, 0, 0], [0, 10, 0]])
    net = np.stack([start, start + 10 * np.asarray([direction[0], 0, direction[1]])])
    return Face(Face.from_bspline(net, (1, 1)).surface, flip=flip, number=number, kind=kind)


def border(reverse=False):
    v = np.linspace(0, 1, 7)
    uv = np.column_stack([np.zeros(7), v])
    points = np.column_stack([np.zeros(7), 10 * v, np.zeros(7)])
    return Border((1, 2), points[::-1] if reverse else points, uv[::-1] if reverse else uv,
                  uv[::-1] if reverse else uv, reverse, reverse)


def meeting(left_angle, right_angle, reverse=False):
    """Edge between a strip to the left and one to the right, raised by angles; the material is below both.

    The first strip runs towards -x, so its Su x Sv points down and it is flipped; it lies left of +y.
    """
    one = strip((-np.cos(left_angle), np.sin(left_angle)), 1, flip=True)
    other = strip((np.cos(right_angle), np.sin(right_angle)), 2)
    assert one.normal(np.array([[0.5, 0.5]]))[0, 2] > 0
    assert other.normal(np.array([[0.5, 0.5]]))[0, 2] > 0
    return (one, other), border(reverse)


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("left, right, kind", [
    (-0.5, -0.5, "convex"), (0.5, 0.5, "concave"), (0.0, 0.0, "tangent"), (0.3, -0.3, "tangent"),
    (np.radians(0.9), 0.0, "tangent"), (np.radians(1.1), 0.0, "concave"), (-np.radians(1.1), 0.0, "convex"),
    (1.2, 0.4, "concave"), (-1.4, -1.4, "convex"),
])
def test_edges_are_told_apart_by_the_normals_and_the_side(left, right, kind, reverse):
    faces, shared = meeting(left, right, reverse)
    # seen from above, the first strip lies left of +y; its own Su x Sv points down, so there it lies right of it
    edge = edges_from_borders(faces, [shared])[0]
    assert edge.kind == kind
    assert edge.angle == pytest.approx(abs(left + right), abs=1e-9)


@pytest.mark.parametrize("left, right", [(-0.5, -0.2), (0.5, 0.2)])
def test_exchanging_the_faces_and_moving_the_part_change_nothing(left, right):
    faces, shared = meeting(left, right)
    kind = edges_from_borders(faces, [shared])[0].kind
    # the second strip lies right of +y seen from above, and its Su x Sv points up
    swapped = Border((2, 1), shared.points, shared.second, shared.first, False, False)
    assert edges_from_borders(faces, [swapped])[0].kind == kind
    for mirror in (1.0, -1.0):
        matrix = np.eye(4)
        matrix[:3, :3] = rotation([1, 2, 3], 2.0) @ np.diag([mirror, 1, 1])
        moved = tuple(face.transformed(matrix) for face in faces)
        points = shared.points @ matrix[:3, :3].T
        turned = Border((1, 2), points, shared.first, shared.second, shared.left, shared.second_left)
        assert edges_from_borders(moved, [turned])[0].kind == kind


def test_gaps_measure_beside_the_curve_only():
    faces, shared = meeting(0.2, 0.3)
    assert gaps(faces, [shared])[0] < 1e-12
    along = Border((1, 2), shared.points + np.array([0, 0.5, 0]), shared.first, shared.second, False, False)
    assert gaps(faces, [along])[0] < 1e-12
    beside = Border((1, 2), shared.points + np.array([0.2, 0.5, 0]), shared.first, shared.second, False, False)
    assert gaps(faces, [beside])[0] == pytest.approx(0.2)


def test_a_smooth_seam_is_no_edge_but_a_sharp_one_is():
    faces, shared = meeting(0.0, 0.0)
    seam = Border((1, 1), shared.points, shared.first, shared.first, True, False)
    assert edges_from_borders(faces, [seam]) == ()
    sharp = Face.from_bspline([[[0, 0, 0], [0, 10, 0]], [[5, 0, 9], [5, 10, 9]], [[9, 0, 0], [9, 10, 0]],
                               [[0, 0, 0], [0, 10, 0]]], (1, 1))
    far = shared.first + np.array([1.0, 0.0])
    seam = Border((1, 1), shared.points, shared.first, far, False, True)
    assert [edge.faces for edge in edges_from_borders([sharp], [seam])] == [(1, 1)]


def chain(kinds):
    """Faces 1, 2, 3, … in a row with given kinds of edges between neighbours."""
    faces = [strip((1, 0)) for _ in range(len(kinds) + 1)]
    edges = [Edge((k + 1, k + 2), kind, LINE) for k, kind in enumerate(kinds)]
    return Part.from_faces(faces, edges)


def test_the_skin_goes_on_over_tangent_edges_only():
    part = chain(["tangent", "convex", "tangent", "tangent", "concave"])
    assert [face.number for face in part.skin(1)] == [1, 2]
    assert [face.number for face in part.skin(4)] == [4, 3, 5]
    assert [face.number for face in part.surroundings(4)] == [1, 2, 6]
    assert [face.number for face in part.skin(6)] == [6]


def test_skin_and_surroundings_share_out_all_faces():
    part = chain(["tangent", "concave", "tangent"])
    for face in part.faces:
        numbers = sorted(f.number for f in (*part.skin(face.number), *part.surroundings(face.number)))
        assert numbers == [1, 2, 3, 4]


def test_neighbours_by_kind():
    part = chain(["tangent", "convex"])
    assert part.neighbours(2) == (1, 3)
    assert part.neighbours(2, "convex") == (3,)
    assert part.neighbours(2, "concave") == ()


def test_sculptured_faces_are_all_but_planes_cylinders_and_cones():
    kinds = ["plane", "bspline", "cylinder", "sphere", "cone", "torus", "extrusion"]
    part = Part(tuple(strip((1, 0), k + 1, kind=kind) for k, kind in enumerate(kinds)))
    assert [face.number for face in part.sculptured] == [2, 4, 6, 7]


def test_faces_alone_make_a_part_numbered_from_one():
    part = Part.from_faces([strip((1, 0), 9), strip((0, 1), 9)])
    assert [face.number for face in part.faces] == [1, 2]
    assert [face.label for face in part.faces] == ["1", "2"]
    assert part.bodies == (Body("faces", (1, 2), False),)
    assert part.diagonal == pytest.approx(np.sqrt(300))


def test_a_moved_part_moves_faces_and_edges():
    part = chain(["tangent"])
    matrix = np.eye(4)
    matrix[:3, 3] = [1, 2, 3]
    moved = part.transformed(matrix)
    assert moved.box == pytest.approx(part.box + np.array([1, 2, 3]))
    assert moved.edges[0].polyline == pytest.approx(LINE + np.array([1, 2, 3]))


@pytest.mark.parametrize("make, sentence", [
    (lambda: Part(()), "at least one face"),
    (lambda: Part((strip((1, 0), 2), strip((1, 0), 2))), "face number 2 occurs twice"),
    (lambda: Part((strip((1, 0)),), (Edge((1, 5), "convex", LINE),)), "face 5 is named by an edge"),
    (lambda: Part((strip((1, 0)),), selected=(3,)), "face 3 is named"),
    (lambda: chain(["convex"]).face(3), "face 3 does not exist: the part has 2 faces, 1 to 2"),
    (lambda: chain(["convex"]).skin(0), "face 0 does not exist"),
    (lambda: chain(["convex"]).surroundings(-1), "face -1 does not exist"),
])
def test_invalid_parts_and_numbers_are_refused(make, sentence):
    with pytest.raises(InvalidInput, match=sentence):
        make()


def test_warnings_add_up():
    assert chain(["convex"]).with_warnings("a").with_warnings("b", "c").warnings == ("a", "b", "c")


def test_parts_and_faces_are_told_in_one_line() -> None:
    part = Part.from_faces([strip((1, 0)), strip((0, 1), 2)])
    assert repr(part) == "<Part of 2 faces, 2 sculptured>"
    assert repr(part.faces) == "(<Face 1, bspline>, <Face 2, bspline>)"
