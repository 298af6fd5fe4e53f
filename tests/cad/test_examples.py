"""The example parts: every script makes again what is committed, and the published figures come out."""

import json
import runpy
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from toolaxis.cad import load
from toolaxis.cad.step.worker import read_shape
from toolaxis.shape.face import Face

pytest.importorskip("OCP")
EXAMPLES = Path(__file__).parents[2] / "examples"
MADE = {"01_freeform": ["freeform"], "02_saddle": ["saddle"], "03_trimmed": ["trimmed"],
        "04_hyperbolic_paraboloid": ["hyperbolic_paraboloid", "hyperbolic_paraboloid_rules"],
        "05_manta": ["manta"], "06_biquintic": ["biquintic"], "15_dish": ["dish"]}
NAMES = [name for names in MADE.values() for name in names]


@pytest.fixture(scope="module")
def parts():
    return {name: read(EXAMPLES / f"{name}.step") for name in NAMES}


def read(path):
    """As `load` does, without a process of its own."""
    shape, unit = read_shape(str(path))
    return replace(load(shape), unit=unit)


def described(name):
    """The face of the .json file."""
    text = json.loads((EXAMPLES / f"{name}.json").read_text())
    return Face.from_bspline(text["points"], tuple(text["degree"]))


def grid(n=101):
    t = np.linspace(0, 1, n)
    return np.stack(np.meshgrid(t, t, indexing="ij"), -1).reshape(-1, 2)


def test_every_script_is_known():
    assert sorted(path.stem for path in EXAMPLES.glob("[0-9]*.py") if path.stem < "07"
                  or path.stem in MADE) == sorted(MADE)


@pytest.mark.parametrize("script", MADE)
def test_a_script_makes_what_is_committed(script, parts, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(EXAMPLES))
    monkeypatch.delitem(sys.modules, "block", raising=False)
    import block

    monkeypatch.setattr(block, "HERE", tmp_path)
    runpy.run_path(str(EXAMPLES / f"{script}.py"), run_name="__main__")
    for name in MADE[script]:
        assert (tmp_path / f"{name}.json").read_text() == (EXAMPLES / f"{name}.json").read_text()
        again, committed = read(tmp_path / f"{name}.step"), parts[name]
        assert len(again.faces) == len(committed.faces)
        for one, other in zip(again.faces, committed.faces, strict=True):
            assert one.surface.control == pytest.approx(other.surface.control, abs=1e-9)
            assert (one.kind, one.flip, len(one.trims)) == (other.kind, other.flip, len(other.trims))
            assert one.area == pytest.approx(other.area, rel=1e-6)


@pytest.mark.parametrize("name", NAMES)
def test_the_first_face_is_the_sculptured_one_and_has_the_listed_control_points(name, parts):
    part, listed = parts[name], described(name)
    assert [face.number for face in part.sculptured] == [1]
    face = part.face(1)
    assert face.surface.degree == listed.surface.degree
    assert face.surface.control == pytest.approx(listed.surface.control, abs=1e-9)
    assert face.surface.knots_u == pytest.approx(listed.surface.knots_u, abs=1e-11)
    assert face.surface.knots_v == pytest.approx(listed.surface.knots_v, abs=1e-11)
    assert face.flip is False
    assert (face.normal(face.grid(20, 20))[:, 2] > 0).all()
    assert part.unit == "millimetre"


@pytest.mark.parametrize("name", ["freeform", "saddle", "trimmed"])
def test_the_made_parts_are_solids_with_walls_over_convex_edges(name, parts):
    part = parts[name]
    assert [(body.kind, body.closed) for body in part.bodies] == [("solid", True)]
    assert part.warnings == ()
    assert len(part.faces) == (5 if name == "trimmed" else 6)
    assert len(part.neighbours(1)) == len(part.faces) - 2
    assert part.neighbours(1) == part.neighbours(1, "convex")
    assert [face.number for face in part.skin(1)] == [1]


def test_the_freeform_patch_is_mixed_and_gentle(parts):
    face = parts["freeform"].face(1)
    n, k = face.normal(grid()), face.curvature(grid())
    mean = n.mean(axis=0) / np.linalg.norm(n.mean(axis=0))
    assert np.degrees(np.arccos((n @ mean).min())) < 22
    assert 1 / k.k1.max() > 30
    for share in ((k.k2 > 0).mean(), (k.k1 < 0).mean(), ((k.k1 > 0) & (k.k2 < 0)).mean()):
        assert share > 0.2


def test_the_saddle_is_its_formula(parts):
    p = parts["saddle"].face(1).evaluate(grid()).point
    assert p[:, 2] == pytest.approx(30 + p[:, 0] ** 2 / 180 - p[:, 1] ** 2 / 140, abs=1e-12)


def test_the_dish_is_its_formula_and_hollow(parts):
    face = parts["dish"].face(1)
    p = face.evaluate(grid()).point
    x, y = p[:, 0], p[:, 1]
    assert p[:, 2] == pytest.approx(12 + x**2 / 110 + y**2 / 90 - x * y / 300, abs=1e-12)
    assert 1 / face.curvature(grid()).k1.max() > 40 and face.curvature(grid()).k2.min() > 0


def test_no_border_of_the_trimmed_patch_runs_along_an_iso_line(parts):
    face = parts["trimmed"].face(1)
    assert len(face.trims) == 2
    for loop in face.trims:
        step = np.abs(np.roll(loop, -1, axis=0) - loop)
        assert (step.min(axis=1) > 1e-9).mean() > 0.95
    p = face.evaluate(np.concatenate(face.trims)).point
    hole = np.hypot(p[:, 0] + 9, p[:, 1] - 7)
    outline = np.hypot(p[:, 0], p[:, 1])
    wall = (p[:, :2] - [24, 8]) @ np.array([0.9, 0.3]) / np.hypot(0.9, 0.3)
    off = np.min([np.abs(hole - 8), np.abs(outline - 36), np.abs(wall)], axis=0)
    assert np.sort(off)[int(0.99 * len(off))] < 1e-3


@pytest.mark.parametrize("name", ["hyperbolic_paraboloid", "hyperbolic_paraboloid_rules"])
def test_both_hyperbolic_paraboloids_are_the_same_surface(name, parts):
    face = parts[name].face(1)
    p = face.evaluate(face.grid(50, 50)).point
    assert p[:, 2] == pytest.approx((p[:, 1] ** 2 - p[:, 0] ** 2) / 500, abs=1e-12)
    assert np.abs(p[:, :2]).max() <= 50 + 1e-9
    assert face.box == pytest.approx(np.array([[-50, -50, -5], [50, 50, 5]]), abs=0.02)


def test_the_second_one_runs_along_its_rules(parts):
    d = parts["hyperbolic_paraboloid_rules"].face(1).evaluate(grid(11))
    assert np.abs(d.suu).max() < 1e-12
    assert np.abs(d.svv).max() < 1e-12
    assert d.su[:, 0] == pytest.approx(d.su[:, 1], abs=1e-12)


def test_manta_has_its_size_and_symmetry(parts):
    face = parts["manta"].face(1)
    assert face.box == pytest.approx(np.array([[0, 0, 0], [600, 600, 100]]), abs=1e-9)
    p, q = face.evaluate(grid()).point, face.evaluate(grid()[:, ::-1]).point
    assert p[:, 2] == pytest.approx(q[:, 2], abs=1e-10)


def test_the_biquintic_patch_has_the_published_figures(parts):
    """Least radius 28.248 mm (printed 28.25), box 187.543 x 124.131 x 43.006 mm; hollow towards the tool."""
    face = parts["biquintic"].face(1)
    k = face.curvature(grid(401))
    assert 1 / k.k1.max() == pytest.approx(28.248, abs=1e-3)
    assert k.k2.min() > 0
    assert face.box[1] - face.box[0] == pytest.approx([187.543, 124.131, 43.006], abs=1e-3)
    middle = face.evaluate(np.array([[0.5, 0.5]]))
    assert 1 / (middle.suu[0, 2] / (middle.su[0] @ middle.su[0])) == pytest.approx(239.769, abs=1e-3)
