"""What our panels hand to FreeCAD's recorder of macros does the same again, without them."""

import FreeCAD
import pytest


@pytest.fixture
def recorded(monkeypatch, desk):
    """What goes to FreeCAD's recorder of macros, line by line; FreeCAD still gets it."""
    lines, keep = [], desk.gui.doCommandSkip

    def kept(line):
        lines.append(line)
        keep(line)

    monkeypatch.setattr(desk.gui, "doCommandSkip", kept)
    return lines


def test_a_plan_made_by_the_panel_is_made_again_by_the_macro(desk, wavy, recorded, remembered):
    part, face = wavy

    form = desk.start(part, face)
    desk.type(form.scallop, "0.2 mm")
    desk.computed(form)
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    desk.gui.runCommand("ToolAxis_MakeJobs")
    lines = list(recorded)
    assert lines[1].startswith("freecad.toolaxis.plan(") and lines[-1].startswith("freecad.toolaxis.make_jobs(")
    document, operation = part.Document, desk.operation_in(part.Document)
    axis, passes, names = operation.Axis, operation.Passes, sorted(one.Name for one in document.Objects)
    document.undo()
    document.undo()
    assert desk.operation_in(document) is None
    FreeCAD.setActiveDocument(document.Name)
    exec("import FreeCAD\nimport FreeCADGui as Gui\n" + "\n".join(lines), {})
    again = desk.operation_in(document)
    assert again.Passes == passes and again.Axis.isEqual(axis, 1e-9)
    assert len(document.Objects) == len(names)
