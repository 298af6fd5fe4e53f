"""Units that look wrong are warned about, and no others."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from toolaxis.cad.unit_checks import tool_warnings, unit_warnings
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part

EXAMPLES = Path(__file__).parents[2] / "examples"
PARTS = Path(__file__).parents[3] / "shared" / "parts"
WRONG = ("iea15blade.stp", "linkrods.step")
QUICK = (*WRONG, "axom_boxed_sphere.step")
#: Examples that the kernel takes seconds to read; their families are tried by others.
SLOW = ("blisk", "impeller")


def sheet(length, width, poles=(4, 4), kind="bspline", height=0.0):
    """A flat sheet with so many control points, or one that rises."""
    x, y = np.meshgrid(np.linspace(0.0, length, poles[0]), np.linspace(0.0, width, poles[1]), indexing="ij")
    z = height * np.linspace(0.0, 1.0, poles[0])[:, None] * np.ones(poles[1])
    return replace(Face.from_bspline(np.stack([x, y, z], axis=-1), degree=(3, 3)), kind=kind)


def part(*faces):
    return replace(Part.from_faces(faces), unit="millimetre")


def test_a_face_narrower_than_any_cut_is_named():
    (said,) = unit_warnings(part(sheet(117.0, 5.0), sheet(117.0, 0.06)))
    assert said.startswith("face 2 is 117 mm long and 0.06 mm wide on average")
    assert "check the unit (the part is 117.1 mm across, 117.1 m if its numbers were m" in said


def test_control_points_closer_than_any_cut_are_named():
    (said,) = unit_warnings(part(sheet(117.0, 5.0, (60, 60))))
    assert said.startswith("the control points of face 1 stand 0.4 mm apart on average") and "check the unit" in said


@pytest.mark.parametrize("faces", [
    [sheet(117.0, 5.0)],                                         # slender
    [sheet(100.0, 100.0), sheet(30.0, 0.05)],                    # a short sliver: an accident of modelling
    [sheet(100.0, 100.0), sheet(2.0, 2.0, (20, 20))],            # a small rich face is lettering, not the part
    [sheet(12.0, 12.0, (40, 40))],                               # a crown is modelled finely
    [sheet(117.0, 5.0, (60, 60), kind="offset")],                # an approximation chooses its own control points
])
def test_unusual_parts_are_left_in_peace(faces):
    assert unit_warnings(part(*faces)) == ()


@pytest.mark.parametrize("scale, words", [(0.001, "metre"), (1000.0, "micrometres")])
def test_size_alone_is_enough(scale, words):
    matrix = np.diag([scale, scale, scale, 1.0])
    (said,) = unit_warnings(replace(part(sheet(100.0, 60.0, height=20.0)).transformed(matrix), unit="metre"))
    assert "mm across in the unit that the file declares (metre): check the unit" in said and words in said


def test_a_cutter_wider_than_the_part_is_named():
    blade = part(sheet(117.0, 6.4, height=6.3))
    (said,) = tool_warnings(blade, 12.0)
    assert "the cutter is 12 mm wide and the part only 117 x 6.4 x 6.3 mm: check the unit" in said
    assert tool_warnings(blade, 4.0) == ()
    assert tool_warnings(part(sheet(100.0, 70.0)), 12.0) == ()


def test_plan_says_it(tmp_path):
    """In the plan's part, from where plan.json and the command take it."""
    from toolaxis.job.planning.pipeline import plan

    made = plan(part(sheet(30.0, 8.0)), "ball:10", 0.05)
    assert any("check the unit" in warning for warning in made.part.warnings)


@pytest.mark.parametrize("path", [
    pytest.param(path, id=path.stem, marks=pytest.mark.long if path.stem in SLOW else ())
    for path in sorted(EXAMPLES.glob("*.step"))])
def test_examples_are_not_warned_about(path):
    pytest.importorskip("OCP")
    from toolaxis.cad.shapes import part_from_shapes
    from toolaxis.cad.step.worker import read_shape

    found = part_from_shapes([read_shape(str(path))[0]], str(path))
    assert unit_warnings(found) == ()
    assert tool_warnings(found, 12.0) == ()


@pytest.mark.skipif(not PARTS.is_dir(), reason="the real parts by others are not here")
@pytest.mark.parametrize("path", [
    pytest.param(path, id=path.stem, marks=[] if path.name in QUICK else pytest.mark.long)
    for path in sorted(PARTS.glob("*.st*p"))])
def test_real_parts_are_warned_about_where_the_unit_is_wrong(path):
    """The blade's metres are called mm; the rods' drawing is not known, but nobody mills them 5 mm long."""
    pytest.importorskip("OCP")
    from toolaxis.cad import load

    said = [warning for warning in load(path).warnings if "check the unit" in warning]
    assert len(said) == (path.name in WRONG)
