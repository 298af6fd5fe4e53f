"""Make CAM Jobs from the menu: jobs that FreeCAD's own panels open, one step to undo, sentences where it cannot be."""

import FreeCAD
import pytest


@pytest.fixture
def jobs(desk, operation):
    """The jobs that the command makes, and the names of what was there before."""
    document = operation.Document
    before = {thing.Name for thing in document.Objects}
    desk.gui.runCommand("ToolAxis_MakeJobs")
    desk.pump(0.3)
    return [thing for thing in document.Objects if hasattr(thing, "PostProcessor")], before


def test_a_job_that_freecads_own_panels_open(desk, operation, jobs):
    (job,), _ = jobs
    assert desk.gui.Selection.getSelection() == [job]
    made = job.Operations.Group[0]
    assert made.OrientedFrom == operation and not made.ViewObject.Visibility
    desk.gui.ActiveDocument.setEdit(made.Name)
    desk.wait(lambda: desk.gui.Control.activeDialog(), "the panel of the operation opens")
    desk.gui.Control.closeDialog()
    desk.gui.ActiveDocument.resetEdit()
    desk.pump(0.2)
    for thing in operation.Document.Objects:
        if hasattr(thing.ViewObject, "Visibility"):
            thing.ViewObject.Visibility = thing in (job, made, job.Stock, *job.Model.Group)
    job.Model.ViewObject.Visibility = True
    view = desk.gui.ActiveDocument.ActiveView
    view.viewFront()
    view.fitAll()
    desk.gui.Selection.clearSelection()
    desk.shot("60-job")


def test_one_undo_step_takes_it_back(desk, operation, jobs):
    (job,), before = jobs
    document = job.Document
    document.undo()
    desk.pump(0.2)
    assert {thing.Name for thing in document.Objects} == before
    document.redo()
    desk.pump(0.2)
    assert len(document.Objects) > len(before)


def test_a_stale_operation_is_refused_where_the_user_looks(desk, operation):
    operation.Scallop = 0.5
    operation.Document.recompute()
    before = len(operation.Document.Objects)
    text = desk.dialog_text(lambda: desk.gui.runCommand("ToolAxis_MakeJobs"))
    assert "is stale" in text and "recompute it" in text
    assert len(operation.Document.Objects) == before


def test_without_operations_it_says_what_to_do(desk):
    FreeCAD.newDocument("Empty")
    assert "Plan Orientations" in desk.dialog_text(lambda: desk.gui.runCommand("ToolAxis_MakeJobs"))
