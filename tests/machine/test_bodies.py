"""Bodies of machines: files, where they stand, and what is refused."""

from math import radians

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toolaxis.errors import InvalidInput
from toolaxis.machine.bodies import MachineBody
from toolaxis.machine.body_poses import bed_from_body, beside_part, part_from_bed, standing
from toolaxis.machine.kinematics import forward
from toolaxis.machine.library import library, load_machine, machine_from_toml, machine_to_toml
from toolaxis.machine.setup import Mounting

AXES = """name = "m"
[[linear]]
name = "X"
direction = [1, 0, 0]
velocity = 1
acceleration = 1
jerk = 1
[[linear]]
name = "Y"
direction = [0, 1, 0]
velocity = 1
acceleration = 1
jerk = 1
[[linear]]
name = "Z"
direction = [0, 0, 1]
velocity = 1
acceleration = 1
jerk = 1
"""


def body(*lines: str) -> str:
    return AXES + "[[body]]\n" + "\n".join(lines) + "\n"


@pytest.mark.parametrize("name", sorted(library()))
def test_bodies_are_written_and_read_back(name: str) -> None:
    machine = load_machine(name)
    again = machine_from_toml(machine_to_toml(machine))
    assert [(one.name, one.carried, one.kind, one.radius) for one in again.bodies] == [
        (one.name, one.carried, one.kind, one.radius) for one in machine.bodies]
    assert all(np.array_equal(a.points, b.points) for a, b in zip(again.bodies, machine.bodies, strict=True))
    if machine.bodies:
        assert {beside_part(machine, one) for one in machine.bodies} == {True, False}
        assert any("bod" in word or "every number" in word for word in machine.assumed), "no maker's numbers"


def test_hulls_of_points_are_read_and_written() -> None:
    machine = machine_from_toml(body('name = "head"', 'carried = "Z"', "round = 2.5",
                                     "points = [[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9]]"))
    again = machine_from_toml(machine_to_toml(machine)).bodies[0]
    assert (again.kind, again.radius, again.points.tolist()) == ("points", 2.5, machine.bodies[0].points.tolist())
    way = np.array([[1.0, 0, 0]])
    assert (again.convex.support(way) @ way[0])[0] == pytest.approx(11.5)


@pytest.mark.parametrize(("lines", "words"), [
    (('carried = "Z"', "box = [[0,0,0],[1,1,1]]"), "a body has no name"),
    (('name = "t"', 'carried = "Q"', "box = [[0,0,0],[1,1,1]]"), "body t of machine 'm' is carried by 'Q': use bed"),
    (('name = "t"', 'carried = 3', "box = [[0,0,0],[1,1,1]]"), "body t is carried by 3: give the name of an axis"),
    (('name = "t"', 'carried = "X"'), "body t has no shape: give one of box, cylinder, points, step"),
    (('name = "t"', 'carried = "X"', "box = [[0,0,0],[1,1,1]]", 'step = "a.step"'), "body t has box and step"),
    (('name = "t"', 'carried = "X"', "box = [[0,0,0],[1,1,0]]"), "two corners that differ in X, Y and Z"),
    (('name = "t"', 'carried = "X"', "box = [[0,0,0],[1,1]]"), "rows of three numbers"),
    (('name = "t"', 'carried = "X"', "box = [[0,0,0],[1,1,1]]", "radius = 3"), "is a box and has a radius: leave it"),
    (('name = "t"', 'carried = "X"', "cylinder = [[0,0,0],[0,0,9]]"), "a radius above zero are needed"),
    (('name = "t"', 'carried = "X"', "cylinder = [[0,0,0],[0,0,0]]", "radius = 3"), "two different ends"),
    (('name = "t"', 'carried = "X"', "cylinder = [[0,0,0],[0,0,9]]", 'radius = "3"'), "radius of body t is '3'"),
    (('name = "t"', 'carried = "X"', "points = [[0,0,0],[0,0,9]]"), "the hull of 2 points"),
    (('name = "t"', 'carried = "X"', "box = [[0,0,0],[1,1,inf]]"), "not finite"),
    (('name = "t"', 'carried = "X"', "box = [[0,0,0],[1,1,1]]", "colour = 1"), "body t has an unknown 'colour'")])
def test_wrong_bodies_are_refused_in_one_sentence(lines: tuple[str, ...], words: str) -> None:
    with pytest.raises(InvalidInput) as refused:
        machine_from_toml(body(*lines))
    assert words in str(refused.value) and "\n" not in str(refused.value)


def test_one_body_is_not_carried_by_two_axes() -> None:
    two = body('name = "t"', 'carried = "X"', "box = [[0,0,0],[1,1,1]]")
    two += '[[body]]\nname = "t"\ncarried = "Y"\nbox = [[0,0,0],[1,1,1]]\n'
    with pytest.raises(InvalidInput, match="body t of machine 'm' is carried by X and by Y"):
        machine_from_toml(two)


def test_a_step_file_that_was_not_read_is_told_when_it_is_needed() -> None:
    machine = machine_from_toml(body('name = "t"', 'carried = "Z"', 'step = "no/head.step"'))
    with pytest.raises(InvalidInput, match=r"body t is the file .*head.step and was not read"):
        Mounting(machine)


@pytest.mark.parametrize("name", ["mikron-ucp-710", "dmg-dmu-60t", "bc-table-table", "nutating-head"])
def test_bodies_ride_with_the_tool_and_with_the_part(name: str) -> None:
    """The last head axis carries the gauge point as forward kinematics do; the table next to the part stands still."""
    machine, rng = load_machine(name), np.random.default_rng(4)
    place = np.eye(4)
    place[:3, :3] = Rotation.random(random_state=3).as_matrix()
    place[:3, 3] = [30.0, -20, 55]
    last = machine.head[-1].name if machine.head else machine.linear[2].name
    for _ in range(20):
        rotary, at = rng.uniform(-2, 2, 2), rng.uniform(-200, 200, 3)
        tip, _ = forward(machine, np.concatenate([at, rotary])[None], 0.0, place)
        from_bed = part_from_bed(machine, rotary, place)
        gauge = bed_from_body(machine, last, rotary) @ np.append(machine.gauge, 1.0)
        assert np.allclose((from_bed @ (gauge + np.append(machine.directions @ at, 0.0)))[:3], tip[0], atol=1e-9)
        for one in standing(machine, rotary, place):
            if one.body.carried == machine.table[0].name:
                expected = one.body.convex.moved(np.linalg.inv(place))
                assert np.allclose(one.shape.centre, expected.centre, atol=1e-9) and not one.carrier.any()
            elif beside_part(machine, one.body):
                assert not one.carrier.any()
            else:
                assert np.allclose(one.carrier, from_bed[:3, :3] @ machine.directions)


def test_what_linear_axes_carry_moves_with_them_and_those_before_them() -> None:
    machine = machine_from_toml(body('name = "column"', 'carried = "X"', "box = [[0,0,0],[1,1,1]]")
                                + '[[body]]\nname = "saddle"\ncarried = "Y"\nbox = [[0,0,0],[1,1,1]]\n'
                                + '[[body]]\nname = "foot"\ncarried = "bed"\nbox = [[0,0,0],[1,1,1]]\n')
    carriers = {one.body.name: np.diag(one.carrier).tolist() for one in standing(machine, np.empty(0))}
    assert carriers == {"column": [1, 0, 0], "saddle": [1, 1, 0], "foot": [0, 0, 0]}


def test_a_body_on_a_turned_cradle() -> None:
    """The tool turns by A relative to the part, so the cradle turns the other way in the machine."""
    machine = load_machine("mikron-ucp-710")
    point = bed_from_body(machine, "A", [0.3, radians(90)]) @ np.array([0, 0, 10.0, 1])
    assert np.allclose(point[:3], [0, 10, 0], atol=1e-12)
    assert MachineBody("a", "bed", "box", np.array([[1.0, 1, 1], [0, 0, 0]])).convex.centre[0, 0].tolist() == [0.5,
                                                                                                               0.5, 0.5]
