"""Methods and kinds of passes in a document: they are planned, kept, exported, recorded, and stale when changed."""

import FreeCAD
import numpy as np
import pytest
from freecad.toolaxis.document.inputs import JobInputs, inputs_of
from freecad.toolaxis.document.read_operation import OperationRecord
from freecad.toolaxis.document.staleness import digest
from freecad.toolaxis.services import api, macros
from freecad.toolaxis.services.export import plan_task

from toolaxis.cldata.toolpath import Motion
from toolaxis.progress import NO_PROGRESS

MACHINE = "machine:mikron-ucp-710"


@pytest.fixture(scope="module")
def planned(parts):
    """An operation by the jerk of a machine, with passes in planes."""
    document = FreeCAD.newDocument("Choices")
    block = parts.block(document)
    made, = api.plan(document, (block, parts.sculptured_name(block)), parts.TOOL, parts.SCALLOP, shank=None,
                     holder=None, method="jerk", passes="planes", limits=MACHINE)
    yield made
    FreeCAD.closeDocument(document.Name)


def test_the_choices_stand_in_the_operation_and_its_passes(planned):
    assert (planned.Method, planned.CutPattern, planned.Outcome) == ("jerk", "planes", "feasible")
    assert planned.Reasons[0].startswith("jerk along the passes: ")
    plan = plan_task([planned])(NO_PROGRESS)
    assert (plan.inputs.method, plan.inputs.passes) == ("jerk", "planes")
    op = plan.operations[0]
    cuts = np.flatnonzero(op.path.kind == Motion.CUT)
    assert np.abs((op.path.cl[cuts] - op.path.cl[cuts - 1]) @ op.frame.y).mean() < 0.05, "tips go along the planes"
    assert OperationRecord.of(planned) is not None


def test_the_macro_names_them(planned):
    line = macros.plan_line(inputs_of(planned))
    assert "method='jerk'" in line and "passes='planes'" in line
    before = inputs_of(planned)
    planned.CutPattern = "iso"
    lines = macros.again_lines(planned, before, inputs_of(planned))
    planned.CutPattern = "planes"
    assert any(one.endswith(".CutPattern = 'iso'") for one in lines)


def test_another_choice_makes_the_operation_stale(planned):
    planned.Document.recompute()
    assert not api.is_stale(planned)
    planned.CutPattern = "iso"
    planned.Document.recompute()
    assert api.is_stale(planned)
    planned.CutPattern = "planes"
    planned.Document.recompute()
    assert not api.is_stale(planned)


def test_documents_of_before_are_not_stale_for_it():
    """What they were planned with does not name the kind of passes."""
    assert "passes" not in digest(JobInputs()) and "planes" in digest(JobInputs(passes="planes"))
