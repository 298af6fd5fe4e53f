"""Export from its panel: files in a folder, and a sentence where that cannot be."""

import json


def opened(desk):
    desk.gui.runCommand("ToolAxis_Export")
    desk.wait(lambda: desk.form("ToolAxisExport") is not None, "the panel opens")
    return desk.form("ToolAxisExport")


def written(desk, form):
    desk.press(form.write)
    desk.wait(lambda: form.write.isEnabled() and not form.stop.isEnabled(), "it is written")


def test_plan_and_program_are_written(desk, operation, tmp_path):
    form = opened(desk)
    assert form.folder.text().endswith("-plan") and not form.machine.isVisible()
    desk.type(form.folder, str(tmp_path / "plan"))
    form.dialect.setCurrentIndex(form.dialect.findData("linuxcnc"))
    form.machine.setCurrentIndex(form.machine.findData("bc-table-table"))
    form.offsetZ.setValue(60)
    written(desk, form)
    names = {path.name for path in (tmp_path / "plan").iterdir()}
    assert {"plan.json", "program-linuxcnc.ngc", "setup-linuxcnc.md", "part.json"} <= names, form.message.text()
    assert {form.files.item(k).text() for k in range(form.files.count())} == names
    assert json.loads((tmp_path / "plan" / "plan.json").read_text())["outcome"] == "complete"
    desk.shot("80-export")


def test_what_cannot_be_written_is_told(desk, operation, tmp_path):
    form = opened(desk)
    desk.type(form.folder, str(tmp_path / "plan"))
    form.dialect.setCurrentIndex(form.dialect.findData("linuxcnc"))
    form.machine.setCurrentIndex(form.machine.findData("bc-table-table"))
    form.offsetX.setValue(5000)
    written(desk, form)
    assert "leave its travel" in form.message.text() and not (tmp_path / "plan").exists()
    operation.Scallop = 0.7
    desk.press(form.write)
    assert "is stale" in form.message.text()
    operation.Document.removeObject(operation.Name)
    desk.pump(0.1)
    assert not form.write.isEnabled()
