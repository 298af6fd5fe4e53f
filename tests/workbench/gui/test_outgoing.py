"""What comes of operations, from the menu: CAM jobs, files, macros, and the machine that carries them out."""

import json
import shutil

import FreeCAD
import pytest
from FreeCAD import Vector


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
    assert "is out of date" in text and "recompute it" in text
    assert len(operation.Document.Objects) == before


def test_without_operations_it_says_what_to_do(desk):
    FreeCAD.newDocument("Empty")
    assert "Plan Orientations" in desk.dialog_text(lambda: desk.gui.runCommand("ToolAxis_MakeJobs"))


def export_panel(desk):
    desk.gui.runCommand("ToolAxis_Export")
    desk.wait(lambda: desk.form("ToolAxisExport") is not None, "the panel opens")
    return desk.form("ToolAxisExport")


def written(desk, form):
    desk.press(form.write)
    desk.wait(lambda: form.write.isEnabled() and not form.stop.isEnabled(), "it is written")


def test_plan_and_program_are_written(desk, operation, recorded, tmp_path):
    form = export_panel(desk)
    assert form.folder.text().endswith("-plan") and not form.machine.isVisible()
    desk.type(form.folder, str(tmp_path / "plan"))
    form.dialect.setCurrentIndex(form.dialect.findData("linuxcnc"))
    form.machine.setCurrentIndex(form.machine.findData("bc-table-table"))
    form.offsetZ.setValue(60)
    written(desk, form)
    names = {path.name for path in (tmp_path / "plan").iterdir()}
    assert {"plan.json", "program-linuxcnc.ngc", "setup-linuxcnc.md", "part.json"} <= names, form.message.text()
    assert {desk.text(form.files, k) for k in range(form.files.count())} == names
    shutil.rmtree(tmp_path / "plan")
    exec("import FreeCAD\n" + "\n".join(recorded[-2:]), {})
    assert {path.name for path in (tmp_path / "plan").iterdir()} == names, "the macro writes the same"
    assert json.loads((tmp_path / "plan" / "plan.json").read_text())["outcome"] == "complete"
    desk.shot("80-export")


def test_a_report_that_cannot_be_made_does_not_stop_the_program(desk, operation, monkeypatch, tmp_path):
    """Found: with the report ticked and no jinja2 nothing was written."""
    from freecad.toolaxis.gui.export import panel

    monkeypatch.setattr(panel, "missing_for_report", lambda: ["jinja2"])
    form = export_panel(desk)
    assert not form.report.isEnabled() and not form.report.isChecked() and form.report.text().endswith("needs jinja2")
    desk.type(form.folder, str(tmp_path / "plan"))
    form.dialect.setCurrentIndex(form.dialect.findData("linuxcnc"))
    form.offsetZ.setValue(60)
    form.machine.setCurrentIndex(form.machine.findData("bc-table-table"))
    written(desk, form)
    assert (tmp_path / "plan" / "program-linuxcnc.ngc").exists(), form.message.text()


def test_what_cannot_be_written_is_told(desk, operation, tmp_path):
    form = export_panel(desk)
    desk.type(form.folder, str(tmp_path / "plan"))
    form.dialect.setCurrentIndex(form.dialect.findData("linuxcnc"))
    form.machine.setCurrentIndex(form.machine.findData("bc-table-table"))
    form.offsetX.setValue(5000)
    written(desk, form)
    assert "leave its travel" in form.message.text() and not (tmp_path / "plan").exists()
    operation.Scallop = 0.7
    desk.press(form.write)
    assert "is out of date" in form.message.text()
    operation.Document.removeObject(operation.Name)
    desk.pump(0.1)
    assert not form.write.isEnabled()


def ready_for_linuxcnc(desk, form, folder, z):
    """The panel filled in for a program, the origin at a height on the table."""
    desk.type(form.folder, str(folder))
    form.dialect.setCurrentIndex(form.dialect.findData("linuxcnc"))
    form.machine.setCurrentIndex(form.machine.findData("bc-table-table"))
    form.offsetZ.setValue(z)


def test_a_part_inside_the_table_is_raised_by_a_click_and_the_program_is_written(desk, operation, tmp_path):
    """Found: the machine met its table, and only the refusal told that the part may be moved."""
    form = export_panel(desk)
    ready_for_linuxcnc(desk, form, tmp_path / "plan", -85)
    written(desk, form)
    assert "the cutter collides with the " in form.message.text()
    assert "move the part on the table" in form.message.text()
    assert form.raisePart.isVisible() and not (tmp_path / "plan").exists()
    assert form.raisePart.text() == "Raise the part by 85 mm", form.raisePart.text()
    desk.shot("81-export-raise")
    form.offsetZ.setValue(-80)
    assert not form.raisePart.isVisible(), "it was offered for another height"
    form.offsetZ.setValue(-85)
    written(desk, form)
    desk.press(form.raisePart)
    desk.wait(lambda: form.write.isEnabled() and not form.stop.isEnabled(), "it is written")
    assert form.offsetZ.value() == 0 and not form.raisePart.isVisible()
    assert (tmp_path / "plan" / "program-linuxcnc.ngc").exists(), form.message.text()
    form.offsetX.setValue(5000)
    written(desk, form)
    assert "leave its travel" in form.message.text() and not form.raisePart.isVisible(), "no height helps"


def test_the_machine_of_the_document_goes_along_with_the_raised_part(desk, operation, tmp_path):
    from freecad.toolaxis.document.machine import machine_of, place_machine

    document = operation.Document
    place_machine(document, "bc-table-table", (0, 0, -85), ())
    form = export_panel(desk)
    assert form.offsetZ.value() == -85
    ready_for_linuxcnc(desk, form, tmp_path / "plan", -85)
    written(desk, form)
    desk.press(form.raisePart)
    desk.wait(lambda: form.write.isEnabled() and not form.stop.isEnabled(), "it is written")
    assert machine_of(document).Offset == Vector(0, 0, 0) and form.files.count()
    desk.press(desk.standard_button("Close"))
    desk.wait(lambda: desk.form("ToolAxisExport") is None, "the panel closes")
    place_machine(document, "bc-table-table", (0, 0, 33), ())
    form = export_panel(desk)
    assert form.offsetZ.value() == 33 and form.dialect.currentData() == "linuxcnc", "it was changed since"


def test_a_plan_that_a_machine_refuses_is_made_again_for_it_by_a_click(desk, leaning, tmp_path):
    """Found: axes beyond a machine's ranges were refused, and only typing led to a plan that it carries out."""
    from freecad.toolaxis.document.inputs import inputs_of

    other = leaning[1]
    desk.gui.Selection.addSelection(other.Document.Name, other.Name)
    form = export_panel(desk)
    ready_for_linuxcnc(desk, form, tmp_path / "plan", 60)
    written(desk, form)
    assert not form.planAgain.isVisible(), form.message.text()
    form.machine.setCurrentIndex(form.machine.findData("four-axis-a"))
    written(desk, form)
    assert "plan for this machine" in form.message.text() and not form.raisePart.isVisible()
    assert form.planAgain.isVisible() and form.planAgain.text() == "Plan again for four-axis-a"
    desk.shot("83-export-plan-again")
    form.offsetZ.setValue(70)
    assert not form.planAgain.isVisible(), "it was offered for another place"
    form.offsetZ.setValue(60)
    written(desk, form)
    desk.press(form.planAgain)
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the planning panel opens")
    panel = desk.form("ToolAxisPlan")
    assert desk.form("ToolAxisExport") is None and panel.limits.currentData() == "machine:four-axis-a@0,0,60"
    desk.wait(lambda: panel.compute.isEnabled() and not panel.stop.isEnabled(), "the computation ends")
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    assert inputs_of(other).limits == "machine:four-axis-a@0,0,60" and other.Motions
    desk.gui.Selection.clearSelection()
    desk.gui.Selection.addSelection(other.Document.Name, other.Name)
    form = export_panel(desk)
    assert form.machine.currentData() == "four-axis-a" and form.offsetZ.value() == 60
    form.dialect.setCurrentIndex(form.dialect.findData("linuxcnc"))
    written(desk, form)
    assert form.files.count() and not form.planAgain.isVisible(), form.message.text()


def test_what_was_written_last_is_offered_again(desk, operation, tmp_path):
    document = operation.Document
    form = export_panel(desk)
    ready_for_linuxcnc(desk, form, tmp_path / "mine", 60)
    form.report.setChecked(False)
    written(desk, form)
    desk.press(desk.standard_button("Close"))
    desk.wait(lambda: desk.form("ToolAxisExport") is None, "the panel closes")
    assert not operation.Stale and "Touched" not in operation.State
    document.saveAs(str(tmp_path / "part.FCStd"))
    name = operation.Name
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(str(tmp_path / "part.FCStd"))
    desk.pump(0.3)
    assert again.getObject(name).Exported
    form = export_panel(desk)
    assert form.folder.text() == str(tmp_path / "mine") and form.dialect.currentData() == "linuxcnc"
    assert form.machine.currentData() == "bc-table-table" and form.offsetZ.value() == 60
    desk.shot("82-export-again")
    steps = again.UndoCount
    written(desk, form)
    assert again.UndoCount == steps + 1, "the file it stands in is another"
    written(desk, form)
    assert again.UndoCount == steps + 1, "nothing has changed"
    desk.press(desk.standard_button("Close"))
    desk.wait(lambda: desk.form("ToolAxisExport") is None, "the panel closes")
    again.saveAs(str(tmp_path / "copy.FCStd"))
    form = export_panel(desk)
    assert form.folder.text() == str(tmp_path / "copy-plan"), "a copy gets a folder of its own"
    assert form.dialect.currentData() == "linuxcnc"


def machine_panel(desk, name, offset):
    desk.gui.Selection.clearSelection()
    desk.gui.runCommand("ToolAxis_Machine")
    desk.wait(lambda: desk.form("ToolAxisMachine") is not None, "the panel opens")
    form = desk.form("ToolAxisMachine")
    form.machine.setCurrentIndex(form.machine.findData(name))
    for spin, value in zip((form.offsetX, form.offsetY, form.offsetZ), offset, strict=True):
        spin.setValue(value)
    desk.wait(lambda: form.angles.isEnabled() and "Checking" not in form.message.text(), "all operations are looked at")
    return form


def test_a_machine_is_picked_and_moves(desk, leaning):
    document = leaning[0].Document
    view = desk.gui.getDocument(document.Name).ActiveView
    seen = view.getCameraOrientation()
    form = machine_panel(desk, "bc-table-table", (0, 0, 20))
    assert "can be reached" in form.message.text(), form.message.text()
    assert form.still.isChecked() and form.angles.rowCount() == 2 and form.angles.columnCount() == 2
    texts = [[desk.text(form.angles, row, column) for column in (0, 1)] for row in (0, 1)]
    heads = [form.angles.model().headerData(row, desk.qt.Qt.Vertical) for row in (0, 1)]
    assert all("Face" in head for head in heads), heads
    assert all("C" in text and "B" in text for row in texts for text in row) and texts[0] != texts[1]
    desk.shot("70-machine")
    first = desk.played_at(form, 0.0)
    assert first.startswith(f"{leaning[0].Label}: link"), first
    between = desk.index_moves(form)
    desk.played_at(form, between[len(between) // 3])
    assert "Z 500.0" in form.pointer.text(), form.pointer.text()
    desk.shot("71-index-move")
    form.speed.setCurrentIndex(form.speed.count() - 1)
    desk.played_at(form, 0.99)
    desk.press(form.play)
    desk.wait(lambda: form.slide.value() == form.slide.maximum(), "all is played")
    assert form.play.text() == "Play" and form.pointer.text().startswith(f"{leaning[1].Label}: ")
    form.still.setChecked(False)
    desk.shot("72-second-operation")
    steps = document.UndoCount
    assert not view.getCameraOrientation().isSame(seen, 1e-6)
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisMachine") is None, "the panel closes")
    assert view.getCameraOrientation().isSame(seen, 1e-6), "the view is as it was before"
    thing = next(one for one in document.Objects if one.Name.startswith("Machine"))
    assert thing.Machine == "bc-table-table" and thing.Offset == Vector(0, 0, 20)
    assert len(leaning[1].RotaryAngles) == 2 and document.UndoCount == steps + 1
    document.undo()
    assert not [one for one in document.Objects if one.Name.startswith("Machine")]


def test_what_cannot_be_held_is_told(desk, leaning):
    form = machine_panel(desk, "four-axis-a", (0, 0, 0))
    assert desk.text(form.angles, 0, 0) == "no position reaches it"
    assert "No usable position on this machine" in form.message.text() and not form.play.isEnabled()
    desk.press(desk.standard_button("Cancel"))
    desk.wait(lambda: desk.form("ToolAxisMachine") is None, "the panel closes")


def test_bodies_that_meet_are_red(desk, leaning):
    """The part stands so deep in the table that the spindle meets it."""
    form = machine_panel(desk, "bc-table-table", (0, 0, -85))
    assert "the spindle collides with the table by" in desk.text(form.angles, 0, 0), desk.text(form.angles, 0, 0)
    form.angles.cellClicked.emit(0, 0)
    desk.pump(0.2)
    assert "Collision: spindle, table; " in form.pointer.text(), form.pointer.text()
    desk.shot("73-collision")


def test_a_clamp_that_the_holder_meets_is_red(desk, leaning, tmp_path):
    """A post that nobody ticked stands beside the first part, as high as the holder."""
    document = leaning[0].Document
    clamp = document.addObject("Part::Box", "Clamp")
    clamp.Length, clamp.Width, clamp.Height = 6, 6, 90
    clamp.Placement.Base = Vector(26, 4, 0)
    document.recompute()
    for thing in document.Objects:  # axes and rapid moves are red too
        if thing.TypeId.endswith("CoordinateSystem") or thing.TypeId == "Path::Feature":
            thing.ViewObject.Visibility = False
    form = machine_panel(desk, "bc-table-table", (0, 0, 20))
    desk.wait(lambda: "collides with face" in form.message.text(), "collisions are looked for")
    assert form.message.text().startswith(leaning[0].Label) and "of Clamp by" in form.message.text()
    assert "of Clamp by" in desk.text(form.angles, 0, 0) + desk.text(form.angles, 0, 1)
    assert "of Clamp by" in form.pointer.text(), form.pointer.text()
    desk.shot("74-clamp-met")
    red, there = desk.red_points(document, tmp_path), form.pointer.text()
    between = desk.index_moves(form)
    desk.played_at(form, between[len(between) // 2])
    assert form.pointer.text() != there and "Clamp" not in form.pointer.text(), form.pointer.text()
    desk.shot("75-clamp-free")
    assert desk.red_points(document, tmp_path) < 0.2 * red


@pytest.fixture
def recorded(monkeypatch, desk):
    """What goes to FreeCAD's recorder of macros, line by line; FreeCAD still gets it."""
    name = "doCommandSkip" if hasattr(desk.gui, "doCommandSkip") else "doCommand"
    lines, keep = [], getattr(desk.gui, name)

    def kept(line):
        lines.append(line)
        keep(line)

    monkeypatch.setattr(desk.gui, name, kept)
    return lines


def test_a_plan_made_by_the_panel_is_made_again_by_the_macro(desk, wavy, recorded, remembered):
    part, face = wavy

    form = desk.start(part, face)
    desk.type(form.scallop, "0.05 mm")
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


def test_freecads_own_recorder_keeps_what_the_panel_did(desk, wavy, remembered, tmp_path):
    part, face = wavy

    def answer():
        """Fill in the dialog that the command opens, and start recording."""
        box = desk.app.activeModalWidget()
        if box is None:
            return
        timer.stop()
        box.findChild(desk.widgets.QLineEdit, "lineEditPath").setText("Recorded")
        box.findChild(desk.widgets.QPushButton, "buttonStart").click()

    preferences = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Macro")
    preferences.SetString("MacroPath", str(tmp_path))
    timer = desk.qt.QTimer()
    timer.setInterval(500)
    timer.timeout.connect(answer)
    timer.start()
    desk.gui.runCommand("Std_DlgMacroRecord")
    form = desk.start(part, face)
    desk.type(form.scallop, "0.05 mm")
    desk.computed(form)
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    desk.shot("85-recording")
    desk.gui.runCommand("Std_DlgMacroRecord")
    preferences.RemString("MacroPath")
    text = (tmp_path / "Recorded.FCMacro").read_text()
    lines = [line.strip() for line in text.splitlines()]
    assert any(line.startswith("freecad.toolaxis.plan(") for line in lines), text
    assert [line for line in lines if line.startswith("import ")] == [
        "import FreeCAD", "import freecad", "import freecad.toolaxis"], text
    document, passes = part.Document, desk.operation_in(part.Document).Passes
    document.undo()
    assert desk.operation_in(document) is None
    FreeCAD.setActiveDocument(document.Name)
    exec(compile(text, "Recorded.FCMacro", "exec"), {})
    assert desk.operation_in(document).Passes == passes


@pytest.mark.long
def test_the_pictures_of_the_tour_are_made_again_and_its_program_is_posted(desk, tmp_path):
    import importlib.util
    import re
    from pathlib import Path

    manual = Path(__file__).resolve().parents[3] / "resources" / "manual"
    spec = importlib.util.spec_from_file_location("tour", manual / "tour.py")
    tour = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tour)
    posted = {line.strip() for line in tour.Tour(desk, tmp_path / "pictures", tmp_path / "plan").walk().splitlines()}
    page = (manual / "freecad.md").read_text(encoding="utf-8")
    made = {f"figures/{path.name}" for path in (tmp_path / "pictures").iterdir()}
    assert made == set(re.findall(r"\]\((figures/freecad-[^)]+)\)", page))
    codes = [line for block in re.findall(r"^```\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
             for line in block.splitlines()]
    assert len(codes) == 5 and set(codes) <= posted
    assert (tmp_path / "plan" / "program-linuxcnc.ngc").is_file()
