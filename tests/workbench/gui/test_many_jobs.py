"""CAM jobs of an operation with more orientations than controls have work offsets: asked before, stopped, and told."""

import pytest
from FreeCAD import Placement, Rotation, Vector


@pytest.fixture
def crowded(operation):
    """The operation with ten turned copies."""
    document = operation.Document
    for k in range(1, 11):
        link = document.addObject("App::Link", "Turned")
        link.LinkedObject = operation
        link.addProperty("App::PropertyPlacement", "Turn")
        link.addProperty("App::PropertyString", "Face")
        link.Placement = link.Turn = Placement(Vector(), Rotation(Vector(0, 0, 1), 33 * k))
        link.Label = f"Blade {k + 1}"
    document.recompute()
    return operation


@pytest.fixture
def answered(desk):
    """Answers message boxes with given buttons while something is done; their texts."""
    def act(action, *buttons):
        seen, left = [], list(buttons)

        def answer():
            box = desk.app.activeModalWidget()
            if desk.is_a(box, desk.widgets.QMessageBox):
                seen.append(box.text())
                desk.shot(f"86-many-jobs-{len(left)}")
                box.button(getattr(desk.widgets.QMessageBox, left.pop(0))).click()
            elif left == ["stop"] and desk.is_a(box, desk.widgets.QProgressDialog) and "about" in box.labelText():
                seen.append(box.labelText())
                left.clear()
                desk.shot("86-many-jobs-stop")
                box.cancel()

        timer = desk.qt.QTimer()
        timer.setInterval(50)
        timer.timeout.connect(answer)
        timer.start()
        action()
        desk.pump(0.3)
        timer.stop()
        assert not left, left
        return seen
    return act


def test_many_jobs_are_asked_for_and_can_be_stopped(desk, crowded, answered, monkeypatch):
    from freecad.toolaxis.cam import jobs

    document, plain = crowded.Document, jobs._job
    names = {thing.Name for thing in document.Objects}

    def make():
        desk.gui.runCommand("ToolAxis_MakeJobs")

    text, = answered(make, "No")
    assert "have 11 orientations" in text and "only 9 work offsets" in text
    assert {thing.Name for thing in document.Objects} == names

    def slow(*given):
        desk.pump(0.4)
        return plain(*given)

    monkeypatch.setattr(jobs, "_job", slow)
    _, label = answered(make, "Yes", "stop")
    assert "/ 11, about" in label and {thing.Name for thing in document.Objects} == names
    monkeypatch.setattr(jobs, "_job", plain)
    _, text = answered(make, "Yes", "Ok")
    assert text.startswith("4 of 11 jobs share their work offset with another job")
    document.undo()
    assert {thing.Name for thing in document.Objects} == names
