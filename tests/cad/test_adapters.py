"""One part through every door: STEP, CadQuery, build123d and the bare kernel must give the same part."""

import numpy as np
import pytest

import toolaxis
from toolaxis.cad import load
from toolaxis.errors import InvalidInput
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part

pytest.importorskip("OCP")
try:
    import cadquery as cq
except ImportError:
    cq = None
try:
    import build123d as bd
except ImportError:
    bd = None

with_cadquery = pytest.mark.skipif(cq is None, reason="CadQuery is not installed")
with_build123d = pytest.mark.skipif(bd is None, reason="build123d is not installed")
VOLUME = 40 * 30 * 20 - np.pi * 25 * 20


def block():
    """A block 40 x 30 x 20 standing on z = 0 with a through hole of radius 5."""
    return cq.Workplane().box(40, 30, 20, centered=(True, True, False)).faces(">Z").workplane().hole(10)


def block_of_build123d():
    return bd.Pos(0, 0, 10) * (bd.Box(40, 30, 20) - bd.Cylinder(5, 20))


def as_file(shape, request):
    folder = request.getfixturevalue("tmp_path_factory").mktemp("step")
    return request.getfixturevalue("write_step")(shape, folder / "block.step")


DOORS = [
    pytest.param(as_file, id="step"),
    pytest.param(lambda shape, _: shape, id="kernel shape"),
    *(pytest.param(door, id=name, marks=with_cadquery) for name, door in {
        "workplane": lambda *_: block(),
        "cadquery solid": lambda *_: block().val(),
        "assembly": lambda *_: cq.Assembly().add(block()),
        "list of faces of cadquery": lambda *_: block().val().Faces(),
    }.items()),
    *(pytest.param(door, id=name, marks=with_build123d) for name, door in {
        "build123d part": lambda *_: block_of_build123d(),
        "build123d solid": lambda *_: block_of_build123d().solid(),
        "ShapeList of faces": lambda *_: block_of_build123d().faces(),
    }.items()),
]


@pytest.fixture(scope="module", params=DOORS)
def part(request, block_shape):
    return load(request.param(block_shape, request))


def volume(part):
    total = 0.0
    for face in part.faces:
        u0, u1, v0, v1 = face.bounds
        uv = face.grid(300, 300)
        d = face.evaluate(uv)
        flux = np.einsum("ni,ni->", d.point, np.cross(d.su, d.sv)) * (-1 if face.flip else 1)
        total += flux * (u1 - u0) * (v1 - v0) / 300**2 / 3
    return total


def test_every_door_gives_the_same_faces(part):
    assert isinstance(part, Part)
    assert [face.number for face in part.faces] == list(range(1, 8))
    assert sorted(face.kind for face in part.faces) == ["cylinder"] + ["plane"] * 6
    areas = sorted(face.area for face in part.faces)
    exact = sorted([600.0] * 2 + [800.0] * 2 + [1200 - 25 * np.pi] * 2 + [200 * np.pi])
    assert areas == pytest.approx(exact, rel=2e-4)
    assert part.box == pytest.approx(np.array([[-20, -15, 0], [20, 15, 20]]), abs=1e-9)


def test_normals_point_out_of_the_material(part):
    """The volume by the divergence theorem has the right sign and size only if all of them do."""
    assert volume(part) == pytest.approx(VOLUME, rel=2e-4)


def test_holes_are_holes(part):
    top = next(face for face in part.faces if face.kind == "plane" and face.box[0, 2] > 19)
    assert len(top.trims) == 2
    middle = top.evaluate(np.array([[0.0, 0.0]])).point[0]
    inside = top.contains(top.grid(101, 101))
    assert inside.all()
    assert middle.shape == (3,)
    radius = np.hypot(*top.evaluate(top.grid(101, 101)).point[:, :2].T)
    assert radius.min() > 4.9


def test_edges_are_the_same_through_every_door_that_keeps_the_solid(part):
    assert len(part.edges) == 14
    assert not any("by position" in warning for warning in part.warnings)
    assert {edge.kind for edge in part.edges} == {"convex"}
    assert max(edge.angle for edge in part.edges) == pytest.approx(np.pi / 2, abs=1e-9)


@with_cadquery
def test_faces_picked_on_a_workplane_come_with_their_solid():
    part = load(block().faces(">Z"))
    assert len(part.faces) == 7
    assert len(part.selected) == 1
    assert part.face(part.selected[0]).box[:, 2] == pytest.approx([20, 20])


@with_build123d
def test_faces_picked_from_a_build123d_part_come_with_it():
    whole = block_of_build123d()
    part = load(whole.faces().sort_by(bd.Axis.Z)[-1:])
    assert len(part.faces) == 7
    assert len(part.selected) == 1
    assert part.face(part.selected[0]).box[:, 2] == pytest.approx([20, 20])


@with_build123d
def test_a_builder_is_its_part():
    with bd.BuildPart() as builder:
        bd.Box(1, 2, 3)
    assert len(load(builder).faces) == 6


def test_faces_of_our_own_are_taken_as_they_are():
    face = Face.from_bspline(np.stack(np.meshgrid(np.arange(4.0), np.arange(4.0), [0.0], indexing="ij"), -1)[:, :, 0])
    assert load(face).faces[0].surface is face.surface
    assert [f.number for f in load([face, face]).faces] == [1, 2]
    part = load([face])
    assert load(part) is part


@pytest.mark.parametrize("source, sentence", [
    ([], "selection is empty"),
    ("", "path of the part is empty"),
    (3.5, "cannot make a part of builtins.float"),
    (None, "cannot make a part of"),
    ([1, 2], "item 0 of the list is int"),
    pytest.param(lambda: cq.Workplane(), "holds no faces", marks=with_cadquery),
    pytest.param(lambda: cq.Workplane().box(1, 1, 1).edges(), "holds no faces", marks=with_cadquery),
    pytest.param(lambda: bd.ShapeList(), "selection is empty", marks=with_build123d),
    pytest.param(lambda: bd.Edge.make_line((0, 0), (1, 1)), "holds no faces", marks=with_build123d),
])
def test_what_is_no_part_is_refused_in_one_sentence(source, sentence):
    with pytest.raises(InvalidInput, match=sentence) as caught:
        load(source() if callable(source) else source)
    assert "\n" not in str(caught.value)


def test_a_mesh_is_refused_with_a_remedy():
    trimesh = pytest.importorskip("trimesh")
    with pytest.raises(InvalidInput, match=r"mesh .* has no exact surfaces: give the STEP file"):
        load(trimesh.creation.box())


@with_cadquery
def test_a_mirrored_and_moved_solid_keeps_its_normals_outside():
    solid = block().val().mirror("YZ").rotate(cq.Vector(1, 2, 3), cq.Vector(0, 1, 1), 33).moved(cq.Location((5, 6, 7)))
    assert volume(load(solid)) == pytest.approx(VOLUME, rel=2e-4)


@with_cadquery
def test_an_assembly_places_every_copy():
    part = load(cq.Assembly().add(block()).add(block(), loc=cq.Location((100, 0, 0))))
    assert len(part.faces) == 14
    assert len(part.bodies) == 2
    assert np.ptp(part.box, axis=0)[0] == pytest.approx(140)


def test_a_solid_that_is_inside_out_is_turned_over(block_shape):
    part = load(block_shape.Reversed())
    assert volume(part) == pytest.approx(VOLUME, rel=2e-4)
    assert any("inside out" in warning for warning in part.warnings)


def test_importing_toolaxis_loads_no_kernel():
    import subprocess
    import sys

    code = "import sys, toolaxis.cad; sys.exit(any(m.split('.')[0] in ('OCP', 'cadquery') for m in sys.modules))"
    root = str(toolaxis.__path__[0]) + "/.."
    assert subprocess.run([sys.executable, "-c", code], env={"PYTHONPATH": root}, check=False).returncode == 0
