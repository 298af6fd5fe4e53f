"""The larger example parts: scripts make what is committed, and the parts are what they claim to be."""

import json
import runpy
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from toolaxis.cad import load
from toolaxis.cad.transfer import read_shape
from toolaxis.shape.face import Face
from toolaxis.tools.assembly import Tool

pytest.importorskip("OCP")
EXAMPLES = Path(__file__).parents[2] / "examples"
MADE = {"07_waves": "waves", "08_outline": "outline", "09_boss": "boss", "10_bosses": "bosses"}
PATCHES = ("waves", "outline", "boss", "bosses")


@pytest.fixture(scope="module")
def shapes():
    return {name: read_shape(str(EXAMPLES / f"{name}.step"))[0] for name in MADE.values()}


@pytest.fixture(scope="module")
def parts(shapes):
    return {name: replace(load(shape), unit="millimetre") for name, shape in shapes.items()}


def facts(name):
    return json.loads((EXAMPLES / f"{name}.json").read_text())


def main_face(part):
    return max(part.sculptured, key=lambda face: face.area)


def test_every_script_is_known():
    assert sorted(path.stem for path in EXAMPLES.glob("[0-9]*.py") if path.stem > "07") == sorted(MADE)


@pytest.mark.parametrize("script", MADE)
def test_a_script_makes_what_is_committed(script, parts, tmp_path, monkeypatch):
    name = MADE[script]
    monkeypatch.syspath_prepend(str(EXAMPLES))
    for shared in ("block", "rotor"):
        monkeypatch.delitem(sys.modules, shared, raising=False)
    import block

    monkeypatch.setattr(block, "HERE", tmp_path)
    runpy.run_path(str(EXAMPLES / f"{script}.py"), run_name="__main__")
    assert (tmp_path / f"{name}.json").read_text() == (EXAMPLES / f"{name}.json").read_text()
    again, committed = load(read_shape(str(tmp_path / f"{name}.step"))[0]), parts[name]
    assert len(again.faces) == len(committed.faces)
    for one, other in zip(again.faces, committed.faces, strict=True):
        assert one.surface.control == pytest.approx(other.surface.control, abs=1e-6)
        assert (one.kind, one.flip, len(one.trims)) == (other.kind, other.flip, len(other.trims))
        assert one.area == pytest.approx(other.area, rel=1e-6)


@pytest.mark.parametrize("name", MADE.values())
def test_a_part_is_one_closed_valid_solid(name, shapes, parts):
    from OCP.BRepCheck import BRepCheck_Analyzer

    assert BRepCheck_Analyzer(shapes[name]).IsValid()
    assert [(body.kind, body.closed) for body in parts[name].bodies] == [("solid", True)]
    assert parts[name].warnings == ()


@pytest.mark.parametrize("name", MADE.values())
def test_cutter_and_scallop_height_stand_beside_the_part(name):
    known = facts(name)
    assert Tool.parse(known["tool"]).kind == "torus"
    assert known["scallop"] == 0.02
    for axis in known.get("published", {}).get("axes", []):
        assert np.linalg.norm(axis) == pytest.approx(1, abs=1e-5)


@pytest.mark.parametrize("name", PATCHES)
def test_the_widest_sculptured_face_has_the_listed_control_points(name, parts):
    known, face = facts(name), main_face(parts[name])
    assert face.surface.control == pytest.approx(
        Face.from_bspline(known["points"], tuple(known["degree"])).surface.control, abs=1e-9)
    assert (face.normal(face.grid(20, 20))[:, 2] > 0).all()
    tool = Tool.parse(known["tool"])
    assert 1 / face.curvature(face.grid(60, 60)).k1.max() > 2 * tool.radius


def test_the_waves_are_as_large_and_steep_as_the_original(parts):
    """11684 mm of ball-end passes, 0.98 mm apart on a plane; no fixed axis serves normals that spread so far."""
    face = main_face(parts["waves"])
    k, n = face.curvature(face.grid(90, 90)), face.normal(face.grid(90, 90))
    assert face.area == pytest.approx(11684 * 0.979, rel=0.02)
    assert 45 < np.degrees(np.arccos(n[:, 2].min())) < 50
    for share in ((k.k2 > 0).mean(), (k.k1 < 0).mean(), ((k.k1 > 0) & (k.k2 < 0)).mean()):
        assert share > 0.2


def test_no_border_of_the_outline_runs_along_an_iso_line(parts):
    part = parts["outline"]
    face = main_face(part)
    assert len(face.trims) == 1
    step = np.abs(np.roll(face.trims[0], -1, axis=0) - face.trims[0])
    assert (step.min(axis=1) > 1e-9).mean() > 0.95
    assert len(part.neighbours(face.number)) == 14
    assert part.neighbours(face.number) == part.neighbours(face.number, "convex")


@pytest.mark.parametrize("name, walls", [("boss", [1]), ("bosses", [1, 1, 4])])
def test_every_boss_is_a_hole_with_walls_that_rise_from_it(name, walls, parts):
    part = parts[name]
    face = main_face(part)
    assert len(face.trims) == 1 + len(walls)
    rising = part.neighbours(face.number, "concave") + part.neighbours(face.number, "tangent")
    assert len(rising) == sum(walls)
    assert all(part.face(number).box[1, 2] > face.box[1, 2] - 15 for number in rising)


def test_the_fillet_at_the_drafted_boss_has_its_radius(parts):
    part = parts["bosses"]
    face = main_face(part)
    (fillet,) = part.neighbours(face.number, "tangent")
    k = part.face(fillet).curvature(part.face(fillet).grid(9, 400)).k1
    assert 1 / k.min() == pytest.approx(4, abs=0.03)
    assert 1 / k.max() == pytest.approx(4, abs=0.03)
    assert part.face(fillet).kinks == ((), ())
