"""What lies inside another body is cut off faces, whatever body it is and wherever it stands."""

import os
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from toolaxis.bladed.trim_buried import Solid, cut_back_covered, cut_exposed, solids_of
from toolaxis.shape.analytic import SphericalSurface
from toolaxis.shape.face import Face
from toolaxis.shape.part import Body, Part

SHARED = Path(os.environ.get("TOOLAXIS_SHARED", Path(__file__).parents[3] / "shared")) / "parts"


def sheet(origin, along, across):
    a, b, c = (np.array(x, dtype=float) for x in (origin, along, across))
    return Face.from_bspline(np.array([[a, a + c], [a + b, a + b + c]]), degree=(1, 1))


def box(low, high, kind="bspline"):
    """Six faces, normals outwards."""
    low, high = np.array(low, dtype=float), np.array(high, dtype=float)
    x, y, z = np.diag(high - low)
    faces = [sheet(low, y, x), sheet(low + z, x, y), sheet(low, x, z), sheet(low + y, z, x), sheet(low, z, y),
             sheet(low + x, y, z)]
    return [replace(face, kind=kind) for face in faces]


def ball(radius, centre=(0, 0, 0)):
    move = np.eye(4)
    move[:3, 3] = centre
    return Face(SphericalSurface(radius).nurbs(), kind="sphere").transformed(move)


def part_of(*bodies):
    """Closed bodies in one part."""
    whole = Part.from_faces([face for body in bodies for face in body], edges=())
    starts = np.cumsum([1, *map(len, bodies)])
    return replace(whole, bodies=tuple(Body("solid", tuple(range(a, b)), True)
                                       for a, b in pairwise(starts)))


def from_box(points, low, high):
    """Signed distance from a box, in closed form."""
    middle, half = (np.array(low) + high) / 2, (np.array(high) - low) / 2
    over = np.abs(points - middle) - half
    return np.linalg.norm(np.maximum(over, 0), axis=1) + np.minimum(over.max(axis=1), 0)


def test_distance_from_a_box_is_exact_at_faces_edges_and_corners():
    low, high = (-3.0, -2.0, -1.0), (3.0, 4.0, 1.5)
    points = np.random.default_rng(2).uniform(np.array(low) - 1, np.array(high) + 1, (400, 3))
    solid = Solid(tuple(box(low, high)))
    found = solid.outside(points, solid.away(points))
    assert found == pytest.approx(from_box(points, low, high), abs=1e-6)


def test_a_thin_plate_tells_its_far_sides_apart():
    solid = Solid(tuple(box((0, 0, 0), (40, 30, 0.5))))
    assert solid.thickness == pytest.approx(0.5, rel=0.05)
    assert not any(solid.holds(np.array(place)) for place in ((20, 15, 9.0), (20, 15, -9.0), (60, 15, 0.25)))
    assert Solid(tuple(box((0, 0, 0), (40, 30, 20)))).holds(np.array([9.0, 8.0, 7.0]))


@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_a_ball_takes_a_circle_out_of_a_face(angle):
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, 0, s, 5], [0, 1, 0, -3], [-s, 0, c, 8], [0, 0, 0, 1.0]])
    part = part_of(box((0, 0, 0), (30, 20, 10)), [ball(5.0, (15, 10, 13))]).transformed(turn)
    left = cut_exposed(part.face(2), solids_of(part))
    assert len(left) == 1 and len(left[0].trims) == 2
    assert left[0].area == pytest.approx(600 - 16 * np.pi, abs=0.6)
    hole = left[0].evaluate(left[0].trims[1]).point
    centre = (turn @ [15, 10, 13, 1])[:3]
    assert np.linalg.norm(hole - centre, axis=1) == pytest.approx(5.0, abs=0.02)
    assert cut_exposed(part.face(1), solids_of(part)) == (part.face(1),)


def test_a_wall_parts_a_floor_and_is_cut_off_at_it_without_slivers_where_they_are_flush():
    part = part_of(box((0, 0, 0), (30, 20, 10)), box((14, 0, 0), (15, 20, 25)))
    floor = cut_exposed(part.face(2), solids_of(part))
    assert [piece.area for piece in floor] == pytest.approx([300, 280], abs=0.5)
    side = cut_exposed(part.face(11), solids_of(part))  # x = 14, from the bottom to the top
    assert len(side) == 1 and side[0].area == pytest.approx(300, abs=0.5)
    assert side[0].box[0, 2] > 9.7  # corners are cut across one cell of the grid
    assert cut_exposed(part.face(7), solids_of(part)) == (part.face(7),)  # its foot, flush with the bottom: free


def test_a_foot_that_stands_on_another_body_is_covered():
    part = part_of(box((0, 0, 0), (30, 20, 10)), box((9, 0, 10), (15, 15, 25)))
    assert cut_exposed(part.face(7), solids_of(part)) == ()
    left = cut_exposed(part.face(2), solids_of(part))
    assert sum(piece.area for piece in left) == pytest.approx(600 - 90, abs=42 * 0.25)  # to within a cell


def test_the_whole_part_tells_what_is_covered():
    part = part_of(box((0, 0, 0), (30, 20, 10)), box((14, 0, 0), (15, 20, 25)))
    made, pieces = cut_back_covered(part, range(1, 13))
    assert set(pieces) >= {2, 11, 12} and len(pieces[2]) == 2
    assert made.face(11).area == pytest.approx(300, abs=0.5) and part.face(11).area == pytest.approx(500)
    assert "bodies overlap" in made.warnings[-1] and "not machined" in made.warnings[-1]


@pytest.mark.parametrize("part", [part_of(box((0, 0, 0), (30, 20, 10))),
                                  part_of(box((0, 0, 0), (3, 2, 1)), box((9, 0, 0), (12, 2, 1)))])
def test_bodies_apart_stay_as_they_are(part):
    made, pieces = cut_back_covered(part, [1, 2])
    assert made is part and pieces == {}


@pytest.mark.long
def test_blades_of_an_impeller_by_others_end_at_their_disc():
    path = SHARED / "kj66_impeller.step"
    if not path.exists():
        pytest.skip(f"{path} is not there: set TOOLAXIS_SHARED")
    pytest.importorskip("OCP")
    from toolaxis.cad import load

    part = load(path)
    solids, disc = solids_of(part), part.face(88)
    low = disc.evaluate(np.column_stack([np.linspace(0, 1, 400), np.zeros(400)])).point
    radius, height = np.hypot(low[:, 0], low[:, 2]), low[:, 1]
    order = np.argsort(radius)
    for number in (1, 3, 24):
        left = cut_exposed(part.face(number), solids)
        assert len(left) == 1 and 0.6 < left[0].area / part.face(number).area < 0.7
        at = left[0].evaluate(left[0].grid(50, 50)).point
        assert (at[:, 1] > np.interp(np.hypot(at[:, 0], at[:, 2]), radius[order], height[order]) - 0.02).all()
