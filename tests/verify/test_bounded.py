"""Memory is bounded by tiles whatever the number of locations, passes, rays and faces, and tiles change no figure."""

import subprocess
import sys
from dataclasses import fields, replace
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from toolaxis.numeric.vectors import unit
from toolaxis.shape.face import Face
from toolaxis.tools.profile import Profile
from toolaxis.verify import component_clearance as axes
from toolaxis.verify import convex_edges as edges
from toolaxis.verify import linear_motions as motions
from toolaxis.verify import material_removal as removal
from toolaxis.verify import rays, verdict
from toolaxis.verify.component_clearance import clearance
from toolaxis.verify.kept import SizedCache
from toolaxis.verify.material_removal import Removal
from toolaxis.verify.rays import face_rays
from toolaxis.verify.revolved_solids import frustum_solids
from toolaxis.verify.task import VerificationTask

UP = np.array([0.0, 0.0, 1.0])
HOLDER = np.array([[10.0, 40.0], [10.0, 60.0], [25.0, 60.0], [25.0, 90.0]])
#: What judging one operation may take in all, packages included, MB.
BOUND = 1_000


def rectangle(corner, one, two, number):
    corner, one, two = (np.asarray(x, dtype=float) for x in (corner, one, two))
    net = np.array([[corner + s * one + t * two for t in (0, 1)] for s in (0, 1)])
    return replace(Face.from_bspline(net, degree=(1, 1)), number=number, label=str(number))


def small_faces(count, half, height, first):
    """Squares of 0.5 mm in rings around a square, lying at a height or standing on it."""
    faces = []
    for k in range(count):
        ring, place = divmod(k, 60)
        side, along = divmod(place, 15)
        shift = np.array([-half + along * 2 * half / 15, half + 0.5 * ring, 0.0])
        turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
        corner = np.linalg.matrix_power(turn, side) @ shift
        one = np.linalg.matrix_power(turn, side) @ [0.5, 0, 0]
        two = np.linalg.matrix_power(turn, side) @ ([0, 0.5, 0] if height == 0 else [0, 0, height])
        faces.append(rectangle(corner, one, two, first + k))
    return tuple(faces)


def crowded(passes, points, faces, size=20.0):
    """A ball over a square and the small faces that go on from it, 0.02 mm too deep, with walls around."""
    y, x = np.linspace(-size / 2, size / 2, passes), np.linspace(-size / 2 - 1, size / 2 + 1, points)
    rows = [np.column_stack([x[::-1] if k % 2 else x, np.full(points, at), np.full(points, -0.02)])
            for k, at in enumerate(y)]
    tips = np.vstack(rows)
    kind = np.zeros(len(tips), dtype=np.int8)
    kind[::points] = 3
    skin = small_faces(faces, size / 2, 0, 2)
    around = small_faces(faces, size / 2 + 8, 3.0, 2 + faces)
    target = rectangle([-size / 2, -size / 2, 0], [size, 0, 0], [0, size, 0], 1)
    return VerificationTask("crowded", tips, np.tile(UP, (len(tips), 1)), kind, Profile(0, 3, 0, 20), (target,), 0.001,
                            skin=skin, surroundings=around, outlines={"holder": HOLDER - np.array([0.0, 15.0])})


def turning(count):
    rng = np.random.default_rng(4)
    tips = np.column_stack([np.linspace(-8, 8, count), rng.normal(size=count).cumsum() * 0.3, 0 * np.arange(count)])
    axis = unit(UP + 0.03 * rng.normal(size=(count, 3)).cumsum(axis=0))
    axis[:8] = axis[0]
    return tips, axis, np.where(np.arange(count) % 7 == 3, 3, 0)


def fixed(count):
    tips, axis, kind = turning(count)
    return tips, np.tile(axis[0], (count, 1)), kind


def same(one, two, tolerance):
    """Whether two records of figures agree."""
    for field in fields(one):
        left, right = getattr(one, field.name), getattr(two, field.name)
        if field.name in ("cut_by", "gouged_by"):
            np.testing.assert_array_equal(left < 0, right < 0)
        elif isinstance(left, np.ndarray):
            np.testing.assert_allclose(np.minimum(left, 99), np.minimum(right, 99), rtol=0, atol=tolerance)
        else:
            assert left == right


def along_random_rays(cl, count=3000):
    rng = np.random.default_rng(8)
    foot = np.column_stack([rng.uniform(-9, 9, count), rng.uniform(-6, 6, count), rng.uniform(-0.3, 0.1, count)])
    return Removal(cl, Profile(2, 1, 0, 20)).along((foot, unit(UP + 0.2 * rng.normal(size=(count, 3)))))


@pytest.mark.parametrize("tile", [1, 7])
def test_tiles_of_rays_change_nothing(monkeypatch, tile):
    whole = along_random_rays(turning(60))
    monkeypatch.setattr(removal, "TILE", tile)
    same(whole, along_random_rays(turning(60)), 0.0)


@pytest.mark.parametrize(("cl", "tolerance"), [(fixed(60), 1e-8), (turning(60), 1e-5)], ids=["fixed", "turning"])
@pytest.mark.parametrize("most", [5, 37])
def test_tiles_of_motions_change_nothing(monkeypatch, most, cl, tolerance):
    whole = along_random_rays(cl)
    monkeypatch.setattr(motions, "MOST", most)
    same(whole, along_random_rays(cl), tolerance)
    monkeypatch.setattr(motions, "_KEPT", 0)
    same(whole, along_random_rays(cl), tolerance)


@pytest.mark.parametrize(("module", "name", "value"), [(axes, "TILE", 5), (motions, "MOST", 11), (motions, "_KEPT", 0)])
def test_tiles_change_no_clearance(monkeypatch, module, name, value):
    faces = (rectangle([14, -5, 0], [2, 9, 0], [0, 0, 15], 1), rectangle([-20, 9, 3], [40, 0, 0], [0, 9, 9], 2))
    pin = ("pin", frustum_solids(np.array([[3.0, 1.0], [3.0, 9.0], [5.0, 9.0], [5.0, 12.0]]), "pin"))
    whole = [clearance(cl, pin, faces) for cl in (fixed(20), turning(20))]
    assert max(one.distance for one in whole) < 5
    monkeypatch.setattr(module, name, value)
    assert whole == [clearance(cl, pin, faces) for cl in (fixed(20), turning(20))]


def test_places_tried_at_a_time_change_no_ray(monkeypatch):
    ring = np.linspace(0, 2 * np.pi, 60)[:-1]
    trims = (0.5 + 0.4 * np.column_stack([np.cos(ring), np.sin(ring)]),)
    whole = face_rays(replace(rectangle([0, 0, 0], [30, 0, 0], [0, 30, 0], 1), trims=trims))
    monkeypatch.setattr(rays, "_TRIED", 1)
    again = face_rays(replace(rectangle([0, 0, 0], [30, 0, 0], [0, 30, 0], 1), trims=trims))
    for field in fields(whole):
        np.testing.assert_array_equal(getattr(whole, field.name), getattr(again, field.name))


def test_rays_looked_at_together_change_no_verdict(monkeypatch):
    case = crowded(8, 12, 1, 3.0)
    whole = verdict.judge(case, spacing=0.3)
    assert whole.gouge_max > 0.01
    monkeypatch.setattr(edges, "_AT_ONCE", 50)
    monkeypatch.setattr(removal, "TILE", 3)
    tiled = verdict.judge(case, spacing=0.3)
    assert tiled.reasons == whole.reasons
    for name in ("scallop_max", "share_within", "gouge_max", "uncertainty", "rays"):
        assert getattr(tiled, name) == pytest.approx(getattr(whole, name), abs=1e-8)
    for one, two in zip(whole.maps, tiled.maps, strict=True):
        np.testing.assert_allclose(two.gouge, one.gouge, rtol=0, atol=1e-8)


def test_no_more_is_kept_than_was_said_and_the_last_used_stays():
    made = []
    kept = SizedCache(100, len)
    for key in (1, 2, 1, 3, 1, 2):
        kept.get(key, lambda key=key: made.append(key) or 40 * "x")
    assert made == [1, 2, 3, 2]
    assert kept.get(9, lambda: 500 * "y") == 500 * "y"


def peak(*sizes):
    """Peak memory of a process of its own that judges a crowded face, MB."""
    done = subprocess.run([sys.executable, __file__, *map(str, sizes)], capture_output=True, text=True, check=True)
    return float(done.stdout.split()[-1])


STATED = pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="this system does not state peak memory")


@STATED
def test_a_crowded_face_is_judged_in_bounded_memory():
    assert peak(20, 20, 1) < 0.5 * BOUND


@STATED
@pytest.mark.long
def test_231_passes_among_600_faces_are_judged_in_bounded_memory():
    assert peak(231, 90, 300) < BOUND


if __name__ == "__main__":
    case = crowded(*map(int, sys.argv[1:]))
    found = import_module("toolaxis.verify.verdict").judge(case)
    assert found.gouge_max > 0.01, found.reasons
    # Of this program alone: what getrusage tells begins with the memory of the process that started it.
    status = dict(line.split(":", 1) for line in Path("/proc/self/status").read_text().splitlines())
    print(Path(__file__).name, len(case.tips), int(status["VmHWM"].split()[0]) / 1e3)
