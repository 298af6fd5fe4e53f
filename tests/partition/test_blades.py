"""Blades: axis, count and faces are found by symmetry; a broken pattern is refused with a reason."""

import os
from pathlib import Path

import numpy as np
import pytest

from toolaxis.bladed.find_blades import blades_of
from toolaxis.errors import UnsupportedGeometry
from toolaxis.shape.part import Part

pytest.importorskip("OCP")
ROOT = Path(__file__).parents[2]
SHARED = Path(os.environ.get("TOOLAXIS_SHARED", ROOT.parent / "shared")) / "parts"


def read(path):
    from toolaxis.cad import load
    from toolaxis.cad.step.worker import read_shape

    return load(read_shape(str(path))[0])


@pytest.fixture(scope="module")
def parts():
    return {name: read(ROOT / "examples" / f"{name}.step") for name in ("blisk", "impeller")}


@pytest.fixture(scope="module")
def found(parts):
    return {name: blades_of(part) for name, part in parts.items()}


def off_axis(rotor):
    """How far a point of the axis lies from the z axis."""
    return np.linalg.norm(np.cross(rotor.point, [0, 0, 1]))


@pytest.mark.parametrize("name, count", [("blisk", 16), ("impeller", 9)])
def test_axis_and_number_of_blades_are_found(name, count, found):
    rotor = found[name]
    assert len(rotor.blades) == count
    assert abs(rotor.axis[2]) == pytest.approx(1, abs=1e-9)
    assert off_axis(rotor) < 1e-6
    assert len(rotor.hub) == count


@pytest.mark.parametrize("name", ["blisk", "impeller"])
def test_every_blade_has_each_kind_of_face_and_no_face_serves_two(name, parts, found):
    blades = found[name].blades
    for blade in blades:
        assert [len(faces) for faces in (blade.suction, blade.pressure, blade.leading, blade.trailing, blade.fillets,
                                         blade.tip, blade.others)] == [1, 1, 1, 1, 4, 1, 0]
    numbers = [n for blade in blades for n in blade.faces]
    assert len(set(numbers)) == len(numbers) == 9 * len(blades)
    assert not set(numbers) & set(found[name].hub)


def test_the_suction_side_bulges_and_the_leading_edge_comes_first(parts, found):
    part, rotor = parts["blisk"], found["blisk"]
    for blade in rotor.blades[::5]:
        suction, pressure = part.face(blade.suction[0]), part.face(blade.pressure[0])
        k, m = suction.curvature(suction.grid(20, 20)), pressure.curvature(pressure.grid(20, 20))
        assert np.median(k.k1 + k.k2) < np.median(m.k1 + m.k2)
        leading, trailing = (part.face(n[0]) for n in (blade.leading, blade.trailing))
        assert leading.box[:, 2].mean() < trailing.box[:, 2].mean()


def test_an_impeller_leads_with_the_edge_near_its_axis(parts, found):
    part = parts["impeller"]
    for blade in found["impeller"].blades:
        leading, trailing = (part.face(n[0]) for n in (blade.leading, blade.trailing))
        inner, outer = (np.linalg.norm(face.evaluate(face.grid(5, 5)).point[:, :2], axis=1)
                        for face in (leading, trailing))
        assert inner.max() < outer.min()


def test_blades_are_numbered_in_turn(parts, found):
    part, rotor = parts["blisk"], found["blisk"]
    middle = np.array([part.face(blade.tip[0]).evaluate(part.face(blade.tip[0]).grid(5, 5)).point.mean(axis=0)
                       for blade in rotor.blades])
    angle = np.unwrap(np.sign(rotor.axis[2]) * np.arctan2(middle[:, 1], middle[:, 0]))
    assert np.diff(angle) == pytest.approx(2 * np.pi / 16, abs=1e-3)


def test_a_moved_impeller_has_the_same_blades(parts, found):
    c, s = np.cos(0.8), np.sin(0.8)
    move = np.array([[c, 0, s, 30], [0, 1, 0, -50], [-s, 0, c, 7], [0, 0, 0, 1.0]])
    rotor = blades_of(parts["impeller"].transformed(move))
    assert {blade.faces for blade in rotor.blades} == {blade.faces for blade in found["impeller"].blades}
    assert abs(rotor.axis @ move[:3, 2]) == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize("turned", [
    np.diag([1.0, -1, -1]), pytest.param(np.eye(3), marks=pytest.mark.long),
    pytest.param(np.diag([-1.0, 1, -1]), marks=pytest.mark.long)])
def test_the_sense_of_the_axis_does_not_hang_on_how_it_is_found(turned, parts):
    """The blades of one part are numbered alike, whichever kernel has read it."""
    move = np.eye(4)
    move[:3, :3] = turned
    rotor = blades_of(parts["blisk"].transformed(move))
    assert rotor.axis == pytest.approx([0, 0, -1], abs=1e-9)


@pytest.mark.parametrize("moved", [True, False])
def test_a_blade_missing_or_moved_is_refused_with_its_reason(moved, parts, found):
    part = parts["blisk"]
    blade = set(found["blisk"].blades[3].faces)
    shift = np.eye(4)
    shift[:3, 3] = [0, 0, 9]
    faces = tuple(face.transformed(shift) if face.number in blade else face for face in part.faces
                  if moved or face.number not in blade)
    kept = {face.number for face in faces}
    broken = Part(faces, tuple(edge for edge in part.edges if kept.issuperset(edge.faces)), ())
    with pytest.raises(UnsupportedGeometry, match="missing or moved"):
        blades_of(broken)


def test_a_part_without_a_pattern_is_refused():
    with pytest.raises(UnsupportedGeometry, match="pattern"):
        blades_of(read(ROOT / "examples" / "boss.step"))


def test_an_impeller_by_others_of_nine_blades_on_a_disc():
    path = SHARED / "kj66_impeller.step"
    if not path.exists():
        pytest.skip(f"{path} is not there: set TOOLAXIS_SHARED")
    rotor = blades_of(read(path))
    assert len(rotor.blades) == 9
    assert abs(rotor.axis[1]) == pytest.approx(1, abs=1e-9)
    assert not any(blade.fillets for blade in rotor.blades)
    assert all(blade.suction and blade.pressure for blade in rotor.blades)
    assert rotor.hub == (88, 89, 90, 91, 92)  # the disc, not the blades' own feet
