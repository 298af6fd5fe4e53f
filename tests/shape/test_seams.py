"""Seams that do not meet: measured along the shared edge, named once, kept with the part."""

import json

import numpy as np
import pytest

from toolaxis.plan.part_document import part_document, part_from
from toolaxis.shape.adjacency import Border, edges_from_borders
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.shape.seams import GREATEST, SMALLEST, mismatch_of, seams


def plane(corner, one, two):
    s, t = np.meshgrid(np.linspace(0, 1, 4), np.linspace(0, 1, 4), indexing="ij")
    return Face.from_bspline(np.asarray(corner) + s[..., None] * np.asarray(one) + t[..., None] * np.asarray(two))


def two_planes(height, gap=0.0, turn=0.0, tilt=0.0):
    """The top z = 0 left of the edge x = 0, and a face behind it that begins higher, by more towards y = 20 if tilted,
    farther away, and turned down by an angle."""
    way = 40.0 * np.array([np.cos(turn), 0.0, -np.sin(turn)])
    first = plane([-40, 0, 0], [40, 0, 0], [0, 20, 0])
    second = plane([gap, 0, height], way, [0, 20, tilt])
    at = np.linspace(0, 1, 9)
    border = Border((1, 2), np.column_stack([0 * at, 20 * at, 0 * at]), np.column_stack([0 * at + 1, at]),
                    np.column_stack([0 * at, at]), True, False)
    faces = [first, second.trimmed((), "2")]
    numbered = Part.from_faces(faces).faces
    return Part.from_faces(faces, edges_from_borders(numbered, [border]))


@pytest.mark.parametrize("turn", [0.0, np.pi / 2])
def test_step_and_gap_are_measured(turn):
    part = two_planes(0.004, 0.003, turn)
    (edge,) = part.edges
    assert edge.kind == ("tangent" if turn == 0 else "convex")
    assert edge.gap == pytest.approx(0.005, abs=1e-9)
    # The second face stands out over the first by its height, the first over the second by what lies along its normal.
    assert edge.step[:, 1] == pytest.approx(0.004, abs=1e-9)
    assert edge.step[:, 0] == pytest.approx(-0.004 if turn == 0 else -0.003, abs=1e-9)
    (seam,) = part.seams
    assert (seam.faces, seam.gap, seam.step) == ((1, 2), pytest.approx(0.005), pytest.approx(0.004))


def test_it_is_named_once_with_amount_and_place():
    part = two_planes(0.0, tilt=0.0034)
    assert part.warnings == ("faces 1 and 2 are 0.0034 mm apart along their shared edge near (0.00, 20.00, 0.00): not "
                             "counted as gouge",)
    assert two_planes(0.0009).warnings == ()


def test_a_step_above_the_limit_counts():
    part = two_planes(0.03)
    assert part.seams[0].counted and "counts as an edge" in part.warnings[0]
    assert mismatch_of(part.faces, part.edges, {1, 2}) is None


def test_many_are_summed_up():
    edges = [edge for k in range(8) for edge in two_planes(0.002 + 0.001 * k).edges]
    several = [type(edge)((2 * k + 1, 2 * k + 2), edge.kind, edge.polyline, edge.angle, edge.gap, edge.step)
               for k, edge in enumerate(edges)]
    faces = [plane([100.0 * k, 0, 0], [10, 0, 0], [0, 10, 0]) for k in range(16)]
    told = Part.from_faces(faces, several).warnings
    assert len(told) == 6
    assert told[0].startswith("faces 15 and 16 are 0.0090 mm apart")
    assert told[-1] == "3 more pairs of faces are up to 0.0040 mm apart along their shared edges: not counted as gouge"


def test_only_the_face_that_stands_out_gets_it():
    part = two_planes(0.006)
    found = mismatch_of(part.faces, part.edges, {1, 2})
    assert found is not None
    assert found.span.tolist() == [[0, 0], [0, 8], [0, 8]]
    assert found.segment[:, 6] == pytest.approx(0.006)
    assert mismatch_of(part.faces, part.edges, {2}) is None  # nothing that the cutter touches lies lower


def test_pieces_have_the_lesser_height_of_their_ends():
    part = two_planes(0.0, tilt=0.008)
    found = mismatch_of(part.faces, part.edges, {1, 2})
    assert found is not None
    assert found.segment[:, 6] == pytest.approx(0.001 * np.arange(1, 8))
    assert (found.segment[:, 6] >= SMALLEST).all() and (found.segment[:, 6] <= GREATEST).all()


def test_it_moves_and_scales_with_the_part():
    part = two_planes(0.004, 0.003, np.pi / 2)
    matrix = np.eye(4)
    matrix[:3, :3] = 2.0 * np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    moved = part.transformed(matrix)
    assert moved.edges[0].gap == pytest.approx(2.0 * part.edges[0].gap)
    assert moved.edges[0].step == pytest.approx(2.0 * part.edges[0].step)


def test_a_part_written_as_a_document_keeps_it():
    part = two_planes(0.004, 0.003, np.pi / 2)
    document = json.loads(json.dumps(part_document(part)))
    again = part_from(document)
    assert np.array_equal(again.edges[0].step, part.edges[0].step)
    assert again.seams == part.seams
    for record in document["edges"]:
        del record["gap"], record["step"]
    assert part_from(document).seams == ()


def test_faces_that_meet_have_none():
    assert seams(two_planes(0.0).edges) == ()


@pytest.mark.parametrize(("pair", "gap"), [((9, 22), 0.0034), ((3, 128), 0.0071)])
def test_seams_of_a_real_part(mousecover, pair, gap):
    found = {tuple(sorted(seam.faces)): seam for seam in mousecover.seams}
    assert gap <= found[pair].gap <= 1.05 * gap  # places farther apart told a little less


@pytest.fixture(scope="module")
def mousecover(shared_parts):
    from toolaxis.cad.load import load

    return load(shared_parts / "mousecover.step")
