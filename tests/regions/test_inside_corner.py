"""Inside corners: the largest ball end that touches a place beside a wall, against its closed form."""

from math import cos, inf, radians, sin

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.feasibility.surroundings import OTHER, SKIN, CheckSurfaces
from toolaxis.regions.inside_corner import InsideCorner, find_inside_corner
from toolaxis.regions.open_places import OpenPlace, what_closes
from toolaxis.shape.face import Face
from toolaxis.shape.half_space import HELD_SIDE

CLEARANCE = 0.1


def plane(angle: float) -> Face:
    """A plane that goes up from the x axis at an angle to the floor, deg, 40 x 30 mm."""
    x, s = np.meshgrid(np.linspace(0, 40, 4), np.linspace(0, 30, 4), indexing="ij")
    return Face.from_bspline(np.stack([x, s * cos(radians(angle)), s * sin(radians(angle))], axis=-1))


def corner(angle: float) -> tuple[Face, Face]:
    """A floor, face 1, and a wall, face 2."""
    floor, wall = ta.Part.from_faces([plane(0.0), plane(angle)]).faces
    return floor, wall


def around(floor: Face, *walls: Face) -> tuple[CheckSurfaces, ...]:
    return (CheckSurfaces(SKIN, (floor,), np.array([-0.01, 0.5, 1.0])),
            CheckSurfaces(OTHER, walls, np.array([CLEARANCE, 0.5, 1.0])))


def find(angle: float, distances: list[float], smallest: float, allowance: float = 0.0) -> InsideCorner | None:
    """The corner in which places lie that are so far from the wall's foot."""
    floor, wall = corner(angle)
    u0, u1, v0, v1 = floor.bounds
    uv = np.array([[(u0 + u1) / 2, v0 + (v1 - v0) * distance / 30] for distance in distances])
    return find_inside_corner(floor, uv, around(floor, wall), smallest, allowance)


@pytest.mark.parametrize("angle", [60.0, 90.0, 130.0])
@pytest.mark.parametrize("distance", [0.4, 1.0])
def test_the_ball_beside_a_wall_is_that_of_the_closed_form(angle: float, distance: float) -> None:
    found = find(angle, [distance], smallest=5.0)
    expected = (distance * sin(radians(angle)) - CLEARANCE) / (1 + cos(radians(angle)))
    assert found is not None and found.radius == pytest.approx(expected, abs=2e-4)
    assert found.beside == "2" and found.clearance == CLEARANCE


def test_half_of_the_places_decide() -> None:
    found = find(90.0, [0.3, 0.5, 9.0], smallest=1.0)
    assert found is not None and found.radius == pytest.approx(0.4, abs=1e-4)
    assert find(90.0, [0.3, 8.0, 9.0], smallest=1.0) is None


def test_without_walls_there_is_no_corner() -> None:
    floor, _ = corner(90.0)
    assert find_inside_corner(floor, floor.grid(3, 3), around(floor), smallest=1.0) is None


def test_what_is_left_on_the_face_lifts_the_ball() -> None:
    found = find(120.0, [1.0], smallest=5.0, allowance=0.2)
    expected = (sin(radians(120)) - 0.2 * cos(radians(120)) - CLEARANCE) / (1 + cos(radians(120)))
    assert found is not None and found.radius == pytest.approx(expected, abs=2e-4)


def test_within_the_clearance_of_a_wall_no_ball_is_small_enough() -> None:
    found = find(90.0, [0.05, 0.08], smallest=1.0)
    assert found is not None and found.radius == 0.0


def test_the_clearance_is_that_of_the_face_that_is_named() -> None:
    floor, wall, far = ta.Part.from_faces([plane(0.0), plane(90.0), plane(100.0)]).faces
    near = CheckSurfaces(OTHER, (wall,), np.array([0.3, 0.5, 1.0]))
    behind = CheckSurfaces(OTHER, (far,), np.array([0.05, 0.5, 1.0]))
    places = floor.grid(3, 30)
    uv = places[places[:, 1] < places[:, 1].min() * 1.5]
    for groups in ((near, behind), (behind, near)):
        found = find_inside_corner(floor, uv, groups, smallest=1.0)
        assert found is not None and (found.beside, found.clearance) == ("2", 0.3)


def told(corner: InsideCorner | None) -> str:
    return what_closes(OpenPlace("1", 1.0, 1.0, np.zeros(3), inf, False, corner=corner), 0.25)


def test_it_is_told_what_would_close_it() -> None:
    ball = "a ball end of 0.4 mm or less for half of it: it lies in the corner to face 7"
    assert told(InsideCorner("7", 0.2, 0.1)) == ball
    nearer = "a smaller clearance of the cutter (--clearances): half of it lies within 0.1 mm of face 7"
    assert told(InsideCorner("7", 0.01, 0.1)) == nearer
    assert told(InsideCorner(HELD_SIDE, 0.2, 0.1)) == "another setup: it lies beside the clamped side"
    assert told(None).startswith("a slimmer or longer tool, or another setup")
