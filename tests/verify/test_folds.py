"""A fold of vanishing size is judged as the surface around it: no cut in the air counts, and a gouge still does."""

from dataclasses import replace

import numpy as np
import pytest

from toolaxis.shape.face import Face
from toolaxis.tools.profile import Profile
from toolaxis.verify.rays import face_rays
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.verdict import judge

WIDTH, SCALLOP, LEAD = 2.171571, 0.02, np.radians(10)
#: Control points along the face: in the middle they run back five times by 0.05 um, and the middle third of the
#: parameters is a fold.
ALONG = np.concatenate([np.linspace(-8.0, 0.0, 5), -5e-5 * np.arange(1, 6), np.linspace(2.0, 8.0, 4)])


def folded(corner, along, across, number):
    """A plane face whose parameter along one side runs back in the middle."""
    corner, along, across = (np.asarray(x, dtype=float) for x in (corner, along, across))
    line = corner + (ALONG[:, None] + 8.0) * along
    face = Face.from_bspline(np.stack([line, line + across], axis=1), degree=(3, 1))
    return replace(face, number=number, label=str(number))


FLOOR = folded([-8, -8, 0], [1, 0, 0], [0, 16, 0], 7)
#: Stands on the floor's border at y = 8, looking at the floor.
WALL = folded([-8, 8, 0], [1, 0, 0], [0, 0, 6], 8)


def passes(plane_passes):
    offsets = np.arange(-8 - WIDTH / 4, 9.0, 0.999 * WIDTH)
    return plane_passes((6, 1), LEAD, offsets, span=(-10.0, 10.0))


def passes_beside_the_wall(plane_passes, gap):
    """Two passes of the cutter, 6 mm in radius; the second one stays off the wall by a gap."""
    return plane_passes((6, 1), LEAD, [1.0 - gap, 2.0 - gap], span=(-10.0, 10.0))


def task(cl, **change):
    return replace(VerificationTask("floor", *cl, Profile(5, 1, 0, 24), (FLOOR,), SCALLOP), **change)


@pytest.mark.parametrize("face", [FLOOR, WALL], ids=["floor", "wall"])
def test_the_rays_of_a_fold_point_out_of_the_material(face):
    rays = face_rays(face, 0.3)
    assert (np.abs(rays.point[:, 0]) < 1e-3).sum() > 50
    outwards = [0.0, 0.0, 1.0] if face is FLOOR else [0.0, -1.0, 0.0]
    assert rays.normal == pytest.approx(np.tile(outwards, (len(rays.uv), 1)), abs=1e-9)


def test_good_passes_over_a_fold_pass(plane_passes):
    found = judge(task(passes(plane_passes)), spacing=0.3)
    assert found.passed, found.reasons
    assert found.gouge_max < 1e-6
    assert found.scallop_max == pytest.approx(SCALLOP * 0.999**2, rel=1e-3)


@pytest.mark.parametrize("deep", [0.05, 0.3])
def test_a_gouge_in_a_fold_is_found_by_its_own_rays(plane_passes, deep):
    """The cutter dips where it touches the floor at x = 0."""
    tips, axes, kind = passes(plane_passes)
    first, cut = np.flatnonzero(kind == 0)[0], kind == 0
    tips[cut & (np.abs(tips[:, 0] - tips[first - 1, 0] - 10.0) < 1e-9), 2] -= deep
    found = judge(task((tips, axes, kind)), spacing=0.3)
    assert not found.passed
    assert found.gouge_max == pytest.approx(deep, rel=0.02)
    fold = np.abs(found.maps[0].point[:, 0]) < 1e-3
    assert fold.sum() > 50
    assert found.maps[0].gouge[fold].max() == pytest.approx(deep, rel=0.15)


def test_passes_along_a_wall_with_a_fold_gouge_nothing(plane_passes):
    found = judge(task(passes_beside_the_wall(plane_passes, 0.1), skin=(WALL,)), spacing=0.3)
    assert found.gouge_max < 1e-6
    assert found.worst_gouge == ()


def test_a_gouge_of_a_wall_with_a_fold_is_found(plane_passes):
    found = judge(task(passes_beside_the_wall(plane_passes, -0.05), skin=(WALL,)), spacing=0.3)
    assert found.gouge_max == pytest.approx(0.05, rel=0.01)
    assert {place.face for place in found.worst_gouge} == {"8"}
