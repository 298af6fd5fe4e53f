"""Turned copies of an operation: measured once, and anew wherever anything around them differs."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.shape.analytic import CylindricalSurface
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.tolerances import Tolerance
from toolaxis.tools.profile import Profile
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.turned_copies import TurnedCopies, transfer_measurement
from toolaxis.verify.verdict import judge, measure, verdict_on

WIDTH = 2.171571  # R6 r1, lead 10 deg, h = 0.02
HOLDER = {"holder": np.array([[12.0, 40.0], [12.0, 80.0]])}


def turn(degrees):
    """About an axis along z at x = 60, y = 5."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, np.array([60.0, 5.0, 0.0]) - rotation @ [60.0, 5.0, 0.0]
    return matrix


def rectangle(corner, one, two, number):
    corner, one, two = (np.asarray(x, dtype=float) for x in (corner, one, two))
    face = Face.from_bspline(np.array([[corner + s * one + t * two for t in (0, 1)] for s in (0, 1)]), degree=(1, 1))
    return replace(face, number=number, label=str(number))


def named(face, number):
    return replace(face, number=number, label=str(number))


def find_copy(source, task):
    return TurnedCopies().find(source, task)


FLOOR = rectangle([-8, -8, 0], [16, 0, 0], [0, 16, 0], 7)
BESIDE = rectangle([-8, 30, 0], [16, 0, 0], [0, 0, 4], 9)
SIDE = rectangle([8, -8, -9], [0, 16, 0], [0, 0, 9], 8)
HUB = named(Face(CylindricalSurface(20.0, (0.0, 2 * np.pi), (-9.0, 9.0)).nurbs(), kind="cylinder").transformed(
    np.array([[1, 0, 0, 60.0], [0, 1, 0, 5.0], [0, 0, 1, 0], [0, 0, 0, 1]])), 1)


@pytest.fixture
def source(plane_passes):
    offsets = -8 + 0.999 * WIDTH * (np.arange(int(np.ceil(16 / WIDTH)) + 1) - 0.25)
    tips, axes, kind = plane_passes((6, 1), np.radians(10), offsets, span=(-10.0, 10.0))
    return VerificationTask("source", tips, axes, kind, Profile(5, 1, 0, 24), (FLOOR,), 0.02, outlines=HOLDER,
                            touching=(SIDE,), surroundings=(BESIDE, HUB), tolerance=Tolerance(gouge=0.01))


def copied(task, degrees=72.0, **change):
    """The operation turned about the axis, all numbers of faces 100 higher, but for the hub."""
    matrix = turn(degrees)

    def turned(faces):
        return tuple(face if face is HUB else named(face.transformed(matrix), face.number + 100) for face in faces)

    moved = replace(task, name="copy", tips=np.round(task.tips @ matrix[:3, :3].T + matrix[:3, 3], 6),
                    axes=np.round(task.axes @ matrix[:3, :3].T, 9), targets=turned(task.targets),
                    touching=turned(task.touching), surroundings=turned(task.surroundings), left=())
    return replace(moved, **change)


@pytest.mark.parametrize("degrees", [22.5, 72.0, 180.0, -72.0])
def test_a_copy_has_the_verdict_of_its_own_measuring(source, degrees):
    task = copied(source, degrees)
    copy = find_copy(source, task)
    assert copy is not None and copy.error < 3e-5
    found, own = verdict_on(task, transfer_measurement(task, measure(source, 0.4), copy)), judge(task, 0.4)
    assert found.passed and own.passed, (found.reasons, own.reasons)
    assert found.faces == own.faces == ("107",)
    assert found.share_within == own.share_within == 1.0
    assert found.area == pytest.approx(own.area, rel=1e-9)
    for key in ("scallop_max", "gouge_max"):
        assert getattr(own, key) <= getattr(found, key) + 2e-6
        assert getattr(own, key) == pytest.approx(getattr(found, key), abs=5e-5)
    for name in ("cutter", "holder"):
        room, other = found.clearance[name], own.clearance[name]
        assert room.distance == pytest.approx(other.distance, abs=5e-5 + max(room.uncertainty, other.uncertainty))
        assert room.face == other.face
        (face,) = (one for one in task.surroundings + task.targets + task.touching if one.label == room.face)
        assert nearest(face, np.array([room.point])).distance[0] < 1e-4
    assert found.worst_scallop[0].value == pytest.approx(own.worst_scallop[0].value, abs=5e-5)
    assert task.targets[0].evaluate(np.array([found.worst_scallop[0].uv])).point[0] == pytest.approx(
        found.worst_scallop[0].point, abs=1e-4)


def moved_by(face, *shift):
    matrix = np.eye(4)
    matrix[:3, 3] = shift
    return face.transformed(matrix)


def test_where_anything_differs_it_is_no_copy(source):
    good = copied(source)
    assert find_copy(source, good) is not None
    beside, hub = good.surroundings
    clamp = rectangle([80, 80, 0], [5, 0, 0], [0, 5, 0], 55)
    spoilt = good.tips.copy()
    spoilt[len(spoilt) // 2, 2] -= 2e-5
    leaning = good.axes.copy()
    leaning[3] = leaning[3] + np.array([0.0, 1e-6, 0.0])
    hole = named(good.targets[0].trimmed((np.array([[0.0, 0.0], [1, 0], [1, 0.99], [0, 0.99]]),)), 107)
    worse = {"tips": spoilt, "axes": leaning, "targets": (hole,), "scallop": 0.03, "tolerance": Tolerance(gouge=0.005),
             "outlines": {}, "touching": (), "skin": (moved_by(beside, 0, 0, -30.0),)}
    for name, value in worse.items():
        assert find_copy(source, replace(good, **{name: value})) is None, name
    for around in ((moved_by(beside, 0, 0, 5e-5), hub), (beside, hub, clamp), (hub,),
                   (beside, moved_by(hub, 0.002, 0, 0)), (replace(beside, flip=not beside.flip), hub)):
        assert find_copy(source, replace(good, surroundings=around)) is None


def test_turns_that_follow_from_known_ones_are_not_looked_at_again(source):
    """Two turns of which the hub is its own image make a third one; their errors add up."""
    turned = TurnedCopies()
    found = [turned.find(source, copied(source, 72.0 * k)) for k in (1, 2, 3, 4)]
    assert all(copy is not None for copy in found)
    errors = [copy.error for copy in found]
    assert errors == sorted(errors)
    assert errors[-1] < 5e-5
    assert [np.allclose(copy.turn.rotation, turn(72.0 * k)[:3, :3], atol=1e-7) for k, copy in enumerate(found, 1)]


def test_a_bore_with_a_keyway_is_not_its_own_image(source):
    (u0, u1), (v0, v1) = HUB.surface.domain
    u, v = u0 + np.array([0.3, 0.35]) * (u1 - u0), v0 + np.array([0.2, 0.8]) * (v1 - v0)
    whole = np.array([[u0, v0], [u1, v0], [u1, v1], [u0, v1]])
    slot = np.array([[u[0], v[0]], [u[0], v[1]], [u[1], v[1]], [u[1], v[0]]])
    keyed = named(HUB.trimmed((whole, slot)), 1)
    task = replace(source, surroundings=(BESIDE, keyed))
    copy = copied(source)
    assert find_copy(task, replace(copy, surroundings=(copy.surroundings[0], keyed))) is None


def test_zones_that_are_declared_elsewhere_are_not_taken_over(source):
    zone = source.targets[0].trimmed((np.array([[0.0, 0.0], [1, 0], [1, 0.1], [0, 0.1]]),))
    task = replace(source, left=(zone,))
    good = copied(task)
    same = good.targets[0].trimmed((np.array([[0.0, 0.0], [1, 0], [1, 0.1], [0, 0.1]]),))
    other = good.targets[0].trimmed((np.array([[0.0, 0.0], [1, 0], [1, 0.2], [0, 0.2]]),))
    measured = measure(task, 0.4)
    for zones, known in (((same,), True), ((other,), False), ((), False)):
        here = replace(good, left=zones)
        copy = find_copy(task, here)
        assert copy is not None
        assert (transfer_measurement(here, measured, copy) is not None) == known
