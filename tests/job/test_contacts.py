"""A plan that was read knows its contacts again, and strip widths lie on its own passes."""

from pathlib import Path

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion
from toolaxis.contact.strip.width import strip_width
from toolaxis.job.files.contacts_from_cl import widths_along, with_contacts
from toolaxis.job.files.plan_folder import read_plan
from toolaxis.plan.plan import Plan
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
