"""Bodies of a machine against part, tool and each other: closed forms, and points sampled on everything."""

from math import atan2, cos, degrees, radians, sin

import numpy as np
import pytest
from scipy.optimize import brentq

import toolaxis as ta
from toolaxis.collision.machine_collision import MachineSurroundings, free_solutions, nearest_meeting, words
from toolaxis.machine.axis import Drive, LinearAxis, RotaryAxis
from toolaxis.machine.bodies import MachineBody
from toolaxis.machine.kinematics import forward, linear_coordinates
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.shape.bounding.bounding_tree import forest

DRIVE = Drive(100.0, 1000.0, 10000.0)
TOOL = ta.Tool.torus(diameter=12, corner_radius=1, stickout=60, holder=[(10, 0), (10, 40)])
TABLE = MachineBody("table", "C", "box", np.array([[-200.0, -200, -40], [200, 200, 0]]))
HEAD = MachineBody("head", "B", "cylinder", np.array([[0.0, 0, 0], [0, 0, 150]]), 60.0)
UP, TURN, TILT = np.array([0.0, 0, 1]), np.array([0.0, 0, 1]), np.array([0.0, 1, 0])


def linear() -> tuple[LinearAxis, ...]:
    return tuple(LinearAxis(name, way, DRIVE, -900, 900) for name, way in zip("XYZ", np.eye(3), strict=True))


def head_table(*bodies: MachineBody) -> Machine:
    return Machine("head-table", linear(), (RotaryAxis("C", TURN, np.zeros(3), DRIVE),),
                   (RotaryAxis("B", TILT, np.zeros(3), DRIVE, -2.2, 2.2),), bodies=bodies)


def trunnion(*bodies: MachineBody) -> Machine:
    return Machine("trunnion", linear(), (RotaryAxis("C", TURN, np.zeros(3), DRIVE),
                                          RotaryAxis("A", np.array([1.0, 0, 0]), np.array([0.0, 0, 30]), DRIVE, -2, 2)),
                   bodies=bodies)


def plate(size: tuple[float, float] = (40.0, 30.0), height: float = 0.0) -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, size[0], 5), np.linspace(0, size[1], 5), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, np.full_like(x, height)], axis=-1))


def around(*faces: ta.Face, required: float = 1.0) -> MachineSurroundings:
    return MachineSurroundings(TOOL, (forest(faces or (plate(),)),), required)


def test_the_angle_at_which_a_head_first_touches_the_table() -> None:
    """The lower rim of the head stands 50 + 100 cos b - 60 sin b above the table: zero at one angle."""
    mounting = Mounting(head_table(TABLE, HEAD), (0.0, 0.0, 50.0), TOOL.gauge_length)

    def expected(tilt: float) -> float:
        return 50 + 100 * cos(tilt) - 60 * sin(tilt)

    touch = brentq(expected, radians(45), radians(90))
    for tilt in (touch - 0.02, touch + 0.02, radians(75), radians(80), -radians(80)):
        found = nearest_meeting(mounting, [0.7, tilt], [[20.0, 15, 0]], around(), most=40)
        assert found is not None and (found.one, found.other) == ("head", "table")
        assert found.distance == pytest.approx(expected(abs(tilt)), abs=2e-3)
    for tilt, free in ((touch - 0.02, True), (touch + 0.02, False)):
        axis = mounting.axis_at([0.0, tilt])
        rows, why, _ = free_solutions(mounting, [[20.0, 15, 0]], axis, around())
        assert (len(rows) > 0) == free
        if not free:
            depth = -expected(touch + 0.02)
            assert why.startswith(f"the head collides with the table by {depth:.1f} mm at C ")
            assert f"B {degrees(touch + 0.02):.3f}"[:8] in why or f"B -{degrees(touch + 0.02):.3f}"[:8] in why


def test_the_required_distance_is_kept_and_the_sentence_says_so() -> None:
    mounting = Mounting(head_table(TABLE, HEAD), (0.0, 0.0, 50.0), TOOL.gauge_length)
    tilt = radians(80)
    gap = 50 + 100 * cos(tilt) - 60 * sin(tilt)
    axis = mounting.axis_at([0.0, tilt])
    assert len(free_solutions(mounting, [[20.0, 15, 0]], axis, around(required=gap - 0.1))[0]) == 2
    rows, why, _ = free_solutions(mounting, [[20.0, 15, 0]], axis, around(required=gap + 0.1))
    assert not len(rows)
    assert f"the head comes within {gap:.2f} mm of the table, less than the required {gap + 0.1:g} mm, at C" in why


def test_somewhere_along_the_path() -> None:
    """Only the middle of the way is low."""
    mounting = Mounting(head_table(TABLE, HEAD), (0.0, 0.0, 50.0), TOOL.gauge_length)
    tilt, x = radians(75), np.linspace(0, 40, 801)
    tips = np.stack([x, 0 * x, 20 - 30 * np.exp(-((x - 27.3) / 2) ** 2)], axis=1)
    found = nearest_meeting(mounting, [0.0, tilt], tips, around(), most=60)
    low = 50 + tips[:, 2].min() + 100 * cos(tilt) - 60 * sin(tilt)
    assert found is not None and found.distance == pytest.approx(low, abs=3e-3)
    assert abs(found.motion - int(np.argmin(tips[:, 2]))) <= 1


def sampled(body: MachineBody, count: int, rng: np.random.Generator) -> np.ndarray:
    """Points of a body, its corners and rims among them."""
    if body.kind == "box":
        low, high = body.points
        return low + (high - low) * np.vstack([rng.uniform(0, 1, (count, 3)),
                                               np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T])
    way = body.points[1] - body.points[0]
    axis = way / np.linalg.norm(way)
    across = np.cross(axis, rng.normal(size=(count, 3)))
    across *= (body.radius * np.sqrt(rng.uniform(0.5, 1, count)) / np.linalg.norm(across, axis=1))[:, None]
    return body.points[0] + np.round(rng.uniform(0, 1, (count, 1)) * 4) / 4 * way + across


def test_no_bound_is_above_what_sampled_points_show() -> None:
    """Everything moved by 4 x 4 matrices of the test's own, point clouds against boxes and cylinders."""
    rng = np.random.default_rng(11)
    bodies = (TABLE, MachineBody("cradle", "A", "box", np.array([[-260.0, -80, -90], [260, 80, -45]])),
              MachineBody("post", "bed", "cylinder", np.array([[0.0, 300, -200], [0, 300, 300]]), 50.0),
              MachineBody("head", "Z", "box", np.array([[-70.0, -60, 0], [70, 90, 200]])),
              MachineBody("slide", "Y", "box", np.array([[-90.0, 150, 100], [90, 220, 400]])))
    machine = trunnion(*bodies)
    mounting = Mounting(machine, (-20.0, -15.0, 10.0), TOOL.gauge_length)
    met = 0
    for _ in range(25):
        rotary = np.array([rng.uniform(-3, 3), rng.uniform(-1.9, 1.9)])
        tips = rng.uniform(0, 30, (3, 3))
        found = nearest_meeting(mounting, rotary, tips, around(required=400.0), most=400.0)
        assert found is not None
        linear_at = linear_coordinates(machine, tips, rotary, TOOL.gauge_length, mounting.table_from_part)
        least = np.inf
        for k, at in enumerate(linear_at):
            back, _ = forward(machine, np.concatenate([at, rotary])[None], TOOL.gauge_length, mounting.table_from_part)
            assert np.allclose(back[0], tips[k])
            for one in bodies[3:]:
                moved = at * ([1, 1, 1] if one.carried == "Z" else [1, 1, 0])
                points = sampled(one, 600, rng) + moved
                for other in bodies[:3]:
                    least = min(least, _to_body(other, _turned_back(other, rotary) @ np.vstack([points.T, np.ones(
                        len(points))])))
        assert found.distance <= least + 1e-6
        met += found.distance < 0
    assert 2 < met < 23


def _turned_back(body: MachineBody, rotary: np.ndarray) -> np.ndarray:
    """From machine coordinates to where the body stands at zero: the tool turns by the angles relative to the part."""
    c, a = rotary
    turn = np.array([[1, 0, 0, 0], [0, cos(a), -sin(a), 0], [0, sin(a), cos(a), 0], [0, 0, 0, 1.0]])
    shift = np.eye(4)
    shift[2, 3] = 30.0
    tilt = shift @ turn @ np.linalg.inv(shift)
    spin = np.array([[cos(c), -sin(c), 0, 0], [sin(c), cos(c), 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    return {"C": spin @ tilt, "A": tilt, "bed": np.eye(4)}[body.carried]


def _to_body(body: MachineBody, points: np.ndarray) -> float:
    rows = points[:3].T
    if body.kind == "box":
        low, high = body.points
        return float(np.linalg.norm(np.maximum(np.maximum(low - rows, rows - high), 0), axis=1).min())
    way = body.points[1] - body.points[0]
    size = np.linalg.norm(way)
    along = (rows - body.points[0]) @ way / size
    off = np.linalg.norm(rows - body.points[0] - along[:, None] * way / size, axis=1)
    return float(np.hypot(np.maximum(off - body.radius, 0), np.maximum(np.maximum(-along, along - size), 0)).min())


def test_a_head_against_a_wall_of_the_part() -> None:
    """A wall 50 mm beside the tip, higher than the gauge point: the head is 60 mm wide, the holder 10."""
    y, z = np.meshgrid(np.linspace(-50, 80, 5), np.linspace(0, 160, 5), indexing="ij")
    wall = ta.Face.from_bspline(np.stack([np.full_like(y, 50.0), y, z], axis=-1))
    mounting = Mounting(head_table(TABLE, HEAD), (0.0, 0.0, 50.0), TOOL.gauge_length)
    found = nearest_meeting(mounting, [0.0, 0.0], [[0.0, 15, 0]], around(plate(), wall), most=30)
    assert found is not None and found.one == "head" and found.distance == pytest.approx(-10, rel=0.05)
    short = ta.Face.from_bspline(np.stack([np.full_like(y, 50.0), y, z * 90 / 160], axis=-1))
    found = nearest_meeting(mounting, [0.0, 0.0], [[0.0, 15, 0]], around(plate(), short), most=30)
    assert found is not None and found.one == "head" and found.distance == pytest.approx(10, abs=0.05)
    assert "face" in found.other


def test_a_part_against_the_cradle_that_it_turns_in() -> None:
    """A long part on a turning table swings into the cradle's wall."""
    wall = MachineBody("cradle", "A", "box", np.array([[-20.0, 90, -40], [20, 110, 60]]))
    machine = trunnion(MachineBody("table", "C", "cylinder", np.array([[0.0, 0, -20], [0, 0, 0]]), 60.0), wall,
                       MachineBody("head", "Z", "cylinder", np.array([[0.0, 0, 0], [0, 0, 100]]), 40.0))
    bar = plate((100.0, 10.0), 50.0)
    mounting = Mounting(machine, (0.0, -5.0, 0.0), TOOL.gauge_length)
    # the tool turns by C relative to the part, so the part turns by -C, a bar from x 0 to 100 and y -5 to 5
    way, edge = np.array([cos(radians(60)), sin(radians(60))]), 5 * np.array([-sin(radians(60)), cos(radians(60))])
    beside = np.array([20.0, 90]) - edge
    for turn, expected in ((-60, abs(way[0] * beside[1] - way[1] * beside[0])), (-90, -10.0)):
        found = nearest_meeting(mounting, [radians(turn), 0.0], [[50.0, 5, 50]], around(bar), most=80)
        assert found is not None and (found.one, found.other) == ("cradle", f"face {bar.label}")
        assert found.distance == pytest.approx(expected, abs=0.1)
    found = nearest_meeting(mounting, [0.0, 0.0], [[50.0, 5, 50]], around(bar), most=80)
    assert found is not None and found.one == "cutter" and found.distance == pytest.approx(50.0, abs=1e-3)


def test_a_body_inside_the_part_counts_as_met() -> None:
    """A hollow cube around the head, without holes: no face is near, and yet it cannot be."""
    corners = np.array([-400.0, 400])
    faces = []
    for axis in range(3):
        for side in corners:
            a, b = np.meshgrid(corners, corners, indexing="ij")
            points = np.insert(np.stack([a, b], axis=-1), axis, side, axis=-1)
            faces.append(ta.Face.from_bspline(points, degree=(1, 1)))
    mounting = Mounting(head_table(TABLE, HEAD), (0.0, 0.0, 500.0), TOOL.gauge_length)
    found = nearest_meeting(mounting, [0.0, 0.0], [[0.0, 0, 0]], around(*faces))
    assert found is not None and found.distance < 0 and (found.one, found.other) == ("head", "part")
    post = MachineBody("post", "bed", "box", np.array([[100.0, 100, 400], [120, 120, 600]]))
    high = MachineBody("head", "B", "cylinder", np.array([[0.0, 0, 900], [0, 0, 950]]), 20.0)
    mounting = Mounting(head_table(post, high), (0.0, 0.0, 500.0), TOOL.gauge_length)
    found = nearest_meeting(mounting, [0.0, 0.0], [[0.0, 0, 0]], around(*faces))
    assert found is not None and (found.one, found.other) == ("post", "part")


def test_bodies_are_not_judged_where_something_is_not_known() -> None:
    axis, tips = (0.0, -0.6, 0.8), [[20.0, 15, 0]]
    for mounting in (Mounting(head_table(HEAD), (0.0, 0, 50), 100.0), Mounting(head_table(TABLE), (0.0, 0, 50), 100.0),
                     Mounting(head_table(TABLE, HEAD), None, 100.0), Mounting(head_table(TABLE, HEAD), (0.0, 0, 50))):
        assert not mounting.judges_bodies
        rows, why, _ = free_solutions(mounting, tips, axis, around())
        assert len(rows) == 2 and why == ""


def test_words_of_a_machine_without_rotary_axes() -> None:
    machine = Machine("plain", linear(), bodies=(MachineBody("table", "bed", "box", TABLE.points),
                                                 MachineBody("head", "Z", "cylinder", HEAD.points, 60.0)))
    mounting = Mounting(machine, (0.0, 0.0, -90.0), TOOL.gauge_length)
    found = nearest_meeting(mounting, np.empty(0), [[0.0, 0, 10]], around())
    assert found is not None and found.distance < 0
    assert words(mounting, np.empty(0), found, 1.0).endswith("mm")


def test_atan_of_the_first_contact_is_the_one_in_the_sentence() -> None:
    """50 + 100 cos b - 60 sin b = 0 by hand: b = atan2(60, 100) + acos(-50 / hypot)."""
    size = np.hypot(60, 100)
    touch = np.arccos(-50 / size) - atan2(60, 100)
    mounting = Mounting(head_table(TABLE, HEAD), (0.0, 0.0, 50.0), TOOL.gauge_length)
    low, high = (nearest_meeting(mounting, [0.0, touch + step], [[20.0, 15, 0]], around(required=1e-9))
                 for step in (-1e-4, 1e-4))
    assert low is None
    assert high is not None and -0.1 < high.distance < 0
