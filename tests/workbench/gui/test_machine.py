"""The machine's panel: pick one, read both solutions, watch the index move, and put it into the document."""

import pytest
from FreeCAD import Vector


@pytest.fixture
def leaning(desk, operation):
    """A second operation, on a turned copy of the part, so that the machine has to index."""
    import FreeCAD
    from freecad.toolaxis import bridge

    document, part = operation.Document, operation.Faces[0][0]
    other = document.addObject("Part::Feature", "Other")
    other.Shape = part.Shape.copy()
    other.Placement = FreeCAD.Placement(Vector(0, 40, 0), FreeCAD.Rotation(Vector(1, 0, 0), 25))
    document.recompute()
    from dataclasses import replace

    inputs = bridge.inputs_of(operation)
    inputs = replace(inputs, faces=((other, inputs.faces[0][1]),), limits=f"cone:0,{-0.42},{0.9},2")
    made = bridge.apply(document, inputs, bridge.task(inputs)(_silent()))[0]
    assert made.Motions, made.Reasons
    return operation, made


def _silent():
    from toolaxis.progress import NO_PROGRESS

    return NO_PROGRESS


def opened(desk, name, offset):
    desk.gui.Selection.clearSelection()
    desk.gui.runCommand("ToolAxis_Machine")
    desk.wait(lambda: desk.form("ToolAxisMachine") is not None, "the panel opens")
    form = desk.form("ToolAxisMachine")
    form.machine.setCurrentIndex(form.machine.findData(name))
    for spin, value in zip((form.offsetX, form.offsetY, form.offsetZ), offset, strict=True):
        spin.setValue(value)
    desk.wait(lambda: form.angles.isEnabled() and "Looking" not in form.message.text(), "all operations are looked at")
    return form


def test_a_machine_is_picked_and_moves(desk, leaning):
    document = leaning[0].Document
    form = opened(desk, "bc-table-table", (0, 0, 20))
    assert "can be held" in form.message.text(), form.message.text()
    assert form.still.isChecked() and form.angles.rowCount() == 2 and form.angles.columnCount() == 2
    texts = [[form.angles.item(row, column).text() for column in (0, 1)] for row in (0, 1)]
    assert all("C" in text and "B" in text for row in texts for text in row) and texts[0] != texts[1]
    desk.shot("70-machine")
    form.slide.setValue(400)
    desk.pump(0.2)
    assert "Z 500.0" in form.pointer.text(), form.pointer.text()
    desk.shot("71-index-move")
    form.slide.setValue(990)
    desk.press(form.play)
    desk.wait(lambda: form.slide.value() == form.slide.maximum(), "the index move ends")
    form.still.setChecked(False)
    form.slide.setValue(1000)
    desk.shot("72-second-operation")
    steps = document.UndoCount
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisMachine") is None, "the panel closes")
    thing = next(one for one in document.Objects if one.Name.startswith("Machine"))
    assert thing.Machine == "bc-table-table" and thing.Offset == Vector(0, 0, 20)
    assert len(leaning[1].RotaryAngles) == 2 and document.UndoCount == steps + 1
    document.undo()
    assert not [one for one in document.Objects if one.Name.startswith("Machine")]


def test_what_cannot_be_held_is_told(desk, leaning):
    form = opened(desk, "four-axis-a", (0, 0, 0))
    assert form.angles.item(0, 0).text() == "no position reaches it"
    assert "Not held by this machine" in form.message.text() and not form.play.isEnabled()
    desk.press(desk.standard_button("Cancel"))
    desk.wait(lambda: desk.form("ToolAxisMachine") is None, "the panel closes")


def test_bodies_that_meet_are_red(desk, leaning):
    """The part stands so deep in the table that the spindle meets it."""
    form = opened(desk, "bc-table-table", (0, 0, -85))
    assert "the spindle meets the table by" in form.angles.item(0, 0).text(), form.angles.item(0, 0).text()
    form.angles.cellClicked.emit(0, 0)
    desk.pump(0.2)
    assert "spindle, table meet by" in form.pointer.text(), form.pointer.text()
    desk.shot("73-collision")
