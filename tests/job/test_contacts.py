"""A plan that was read knows its contacts again, and strip widths lie on its own passes."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.contact.strip.width import strip_width
from toolaxis.job.files.contacts_from_cl import widths_along, with_contacts
from toolaxis.job.files.plan_folder import read_plan, stage_folder, write_plan
from toolaxis.plan.plan import Plan
from toolaxis.report.figures.plots import cutting_lines
from toolaxis.shape.nearest import nearest


def test_contacts_of_a_plan_that_was_read_are_those_it_was_made_with(folder: Path, small_plan: Plan) -> None:
    (made,) = small_plan.operations
    read = with_contacts(read_plan(folder)).operations[0].path
    assert made.path is not None and read is not None
    cut = made.path.kind == Motion.CUT
    rows = cut | np.append(cut[1:], False)
    assert read.cc[rows] == pytest.approx(made.path.cc[rows], abs=2e-5)
    assert read.normal[rows] == pytest.approx(made.path.normal[rows], abs=1e-5)
    assert (read.cc[~rows] == read.cl[~rows]).all()
    assert with_contacts(small_plan).operations[0] is made


def test_widths_are_those_of_the_contacts_and_lie_on_the_passes(small_plan: Plan) -> None:
    (op,) = small_plan.operations
    assert op.path is not None and op.orientation.axis is not None
    lines = widths_along(small_plan, op)
    assert len(lines) == op.path.passes
    points, widths = np.concatenate([p for p, _ in lines]), np.concatenate([w for _, w in lines])
    on = nearest(op.face, points)
    assert on.distance.max() < 1e-9
    own = strip_width(op.face, small_plan.tools[0], on.uv, op.orientation.axis, small_plan.inputs.scallop,
                      op.orientation.feed).sum(axis=1)
    assert widths == pytest.approx(own, rel=1e-6)
    made = np.concatenate([op.path.cc[a:b] for a, b in zip(op.path.breaks[:-1], op.path.breaks[1:], strict=True)])
    gap = np.linalg.norm(made[op.path.kind == Motion.CUT][:, None] - points[None], axis=2).min(axis=1)
    inside = op.face.contains(nearest(op.face, made[op.path.kind == Motion.CUT]).uv)
    assert np.median(gap[inside]) < 0.015 * op.face.diagonal


def test_contacts_on_a_hollow_face_are_known_again_too(tmp_path: Path) -> None:
    """Found: tips are set deeper there for the chords, so no contact counted, and pictures showed tips for contacts."""
    x, y = np.meshgrid(np.linspace(-8, 8, 5), np.linspace(-6, 6, 5), indexing="ij")
    bowl = ta.Face.from_bspline(np.stack([x, y, x**2 / 50 + y**2 / 60], axis=-1))
    plan = ta.plan(bowl, ta.Tool.torus(8, 1), 0.1, workers=1)
    with stage_folder(tmp_path / "out") as stage:
        write_plan(plan, stage.folder)
        stage.publish()
    made = plan.operations[0].path
    read = with_contacts(read_plan(tmp_path / "out")).operations[0].path
    assert made is not None and read is not None
    cut = made.kind == Motion.CUT
    assert read.cc[cut] == pytest.approx(made.cc[cut], abs=0.02)
    assert (np.linalg.norm(made.cc[cut] - made.cl[cut], axis=1) > 0.5).all(), "else a tip could pass for a contact"


def test_lines_pass_over_places_whose_contact_is_not_known(small_plan: Plan) -> None:
    path = small_plan.operations[0].path
    assert path is not None
    first = cutting_lines(path)[0]
    lost = int(np.flatnonzero((path.cc == first[3]).all(axis=1))[0])
    cc = path.cc.copy()
    cc[lost] = path.cl[lost]
    assert np.array_equal(cutting_lines(replace(path, cc=cc))[0], np.delete(first, 3, axis=0))
    of_tips = cutting_lines(replace(path, cc=path.cl))
    assert [len(line) for line in of_tips] == [len(line) for line in cutting_lines(path)]
