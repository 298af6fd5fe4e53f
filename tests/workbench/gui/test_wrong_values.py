"""What is wrong in the document or on the disk while a command begins or a panel stands: one sentence, nothing made."""

import threading
import time

import FreeCAD
import pytest
from FreeCAD import Vector

#: How long somebody waits for a part that is odd before he presses Stop, s.
PATIENCE = 5.0

PANELS = ("ToolAxisPlan", "ToolAxisOperation", "ToolAxisVerify", "ToolAxisExport", "ToolAxisMachine",
          "ToolAxisPlay")
COMMANDS = ("ToolAxis_Recompute", "ToolAxis_Verify", "ToolAxis_Merge", "ToolAxis_Split", "ToolAxis_MakeJobs",
            "ToolAxis_Machine", "ToolAxis_Play", "ToolAxis_Export")


def names(document):
    return sorted(thing.Name for thing in document.Objects)


def panel(desk):
    """The form that is open, or None."""
    return next((form for form in map(desk.form, PANELS) if form is not None), None)


def busy(form):
    """Whether something is computed for a form."""
    stop = getattr(form, "stop", None)
    return (stop is not None and stop.isEnabled()) or any(
        word in form.message.text() for word in ("Checking", "Reading the passes"))


def run(desk, command):
    """What a command says: in the dialog that it opens, or in its panel when that has nothing more to do."""
    told = desk.dialog_text(lambda: desk.gui.runCommand(command))
    if not told:
        desk.wait(lambda: panel(desk) is not None, "the panel opens")
    form = panel(desk)
    if form is None:
        return told
    if form.objectName() == "ToolAxisExport":
        desk.press(form.write)
    desk.wait(lambda: not busy(form), f"{command} has done what it can")
    return f"{told} {form.message.text()}".strip()


def opened(desk, command, thing):
    """The form that a command opens for an object."""
    chosen(desk, thing)
    desk.gui.runCommand(command)
    desk.wait(lambda: panel(desk) is not None, "the panel opens")
    return panel(desk)


def close(desk):
    if desk.gui.Control.activeDialog():
        desk.gui.Control.closeDialog()
    desk.pump(0.1)


def is_sentence(text):
    """Whether it is something to read, and no name of a Python error."""
    odd = ("Traceback", "Error", "Exception", "please report", "NoneType", "deleted object", "object at 0x", "Errno")
    return len(text) > 10 and text.rstrip().endswith((".", "...")) and not any(word in text for word in odd)


def chosen(desk, thing):
    desk.gui.Selection.clearSelection()
    desk.gui.Selection.addSelection(thing.Document.Name, thing.Name)


WRONG = (("Tool", "nonsense"), ("Limits", "nonsense"), ("Regions", "many"), ("FeedRate", 0.0), ("SpindleSpeed", 1e300))
MORE = (("Tool", "torus:6x30"), ("Tool", ""), ("Limits", "machine:nothing"), ("Limits", "cone:0,0,0,10"),
        ("Regions", "-3"), ("Regions", "0"), ("Orientations", "some"), ("StickOut", 0.0), ("Scallop", 0.0),
        ("Scallop", float("nan")), ("FeedRate", -5.0), ("SpindleSpeed", -1.0), ("SpindleSpeed", float("nan")),
        ("Strategy", "four-plus-one"), ("Strategy", "blade"), ("Strategy", "multiscale"))


@pytest.mark.parametrize("wrong", [WRONG, pytest.param(MORE, marks=pytest.mark.long)], ids=["a few", "more"])
def test_inputs_edited_in_the_property_editor(desk, operation, wrong):
    """Planning again says what is wrong until a field is changed, and all else that it is stale."""
    document, before = operation.Document, names(operation.Document)
    for name, value in wrong:
        usual = getattr(operation, name)
        setattr(operation, name, value)
        document.recompute()
        assert operation.Stale, (name, value)
        chosen(desk, operation)
        told = run(desk, "ToolAxis_Recompute")
        form = panel(desk)
        assert is_sentence(told) and not form.compute.isEnabled() and form.faces.count() == 1, (name, value, told)
        close(desk)
        setattr(operation, name, usual)
    operation.Tool = "nonsense"
    document.recompute()
    for command in COMMANDS:
        told = run(desk, command)
        assert is_sentence(told), (command, told)
        if command == "ToolAxis_Recompute":
            form = panel(desk)
            desk.shot("23-wrong-property")
            desk.type(form.diameter, "5 mm")
            assert form.compute.isEnabled(), "what no field could show is given up"
        close(desk)
        assert names(document) == before, command
    operation.ViewObject.doubleClicked()
    desk.wait(lambda: desk.form("ToolAxisOperation") is not None, "the panel opens")
    desk.pump(0.3)
    assert "tool was changed" in desk.form("ToolAxisOperation").message.text()


def broken(path, how):
    """A machine file that is none, by what is wrong with it."""
    from toolaxis.machine.library import library

    text = library()["bc-table-table"].read_text()
    texts = {"empty": "", "letters": "this is no machine", "cut": text[:len(text) // 2],
             "nan": text.replace("velocity = ", "velocity = nan # ", 1),
             "inf": text.replace("velocity = ", "velocity = inf # ", 1),
             "word": text.replace("velocity = ", 'velocity = "fast" # ', 1),
             "unit": text.replace("velocity = ", 'velocity = "20 m/min" # ', 1),
             "negative": text.replace("velocity = ", "velocity = -1 # ", 1),
             "nothing": text.replace("limits = [", "limits = [5, 5] # [", 1),
             "upside down": text.replace("limits = [", "limits = [10, -10] # [", 1),
             "no axes": 'name = "none"\n', "fcm": "{}", "fcm list": "[1, 2]", "fcm null": "null",
             "fcm kinematics": '{"version": 1, "machine": {"name": "x", "axes": {"A": {"type": "angular"}}}}',
             "binary": None}
    if how == "binary":
        path.write_bytes(bytes(range(256)) * 9)
    elif how == "folder":
        path.mkdir()
    elif how != "missing":
        path.write_text(texts[how])
    return path


HOWS = ("missing", "folder", "empty", "letters", "cut", "nan", "inf", "word", "unit", "negative", "nothing",
        "upside down", "no axes", "binary", "fcm", "fcm list", "fcm null", "fcm kinematics")


def test_machine_files_that_are_none(desk, operation, tmp_path):
    """In the panel Machine, in Export, and as limits of a plan; the document stays as it is."""
    document = operation.Document
    before = names(document)
    from freecad.toolaxis.document.preferences import PLACE

    folder = tmp_path / "machines"
    folder.mkdir()
    files = [broken(folder / f"{k}{'.fcm' if 'fcm' in how else '.toml'}", how) for k, how in enumerate(HOWS)]
    preferences = FreeCAD.ParamGet(PLACE)
    preferences.SetString("MachinesFolder", str(folder))
    bad = []

    def tell(place, how, text):
        if not is_sentence(text):
            bad.append((place, how, repr(text)))

    try:
        form = opened(desk, "ToolAxis_Machine", operation)
        for file, how in zip(files, HOWS, strict=True):
            index = form.machine.findData(str(file))
            if index < 0:
                form.machine.addItem(how, str(file))
                index = form.machine.count() - 1
            form.machine.setCurrentIndex(index)
            desk.wait(lambda: not busy(form), "it is looked at")
            tell("machine", how, form.message.text())
        desk.press(desk.standard_button("Ok"))
        desk.pump(0.1)
        close(desk)
        assert names(document) == before
        form = opened(desk, "ToolAxis_Export", operation)
        form.dialect.setCurrentIndex(form.dialect.findData("linuxcnc"))
        desk.type(form.folder, str(tmp_path / "plan"))
        for file, how in zip(files, HOWS, strict=True):
            index = form.machine.findData(str(file))
            if index < 0:
                form.machine.addItem(how, str(file))
                index = form.machine.count() - 1
            form.machine.setCurrentIndex(index)
            desk.press(form.write)
            desk.wait(lambda: not busy(form), "it is written")
            tell("export", how, form.message.text())
            assert not (tmp_path / "plan").exists() or how in ("negative",), how
        close(desk)
        form = desk.start(operation.Faces[0][0], operation.Faces[0][1][0])
        for file, how in zip(files, HOWS, strict=True):
            index = form.limits.findData(f"machine:{file}")
            if index < 0:
                form.limits.addItem(how, f"machine:{file}")
                index = form.limits.count() - 1
            form.limits.setCurrentIndex(index)
            desk.pump(0.02)
            tell("limits", how, form.message.text())
            assert form.compute.isEnabled() == (how == "nothing"), how
    finally:
        preferences.RemString("MachinesFolder")
    assert not bad, bad


def test_folders_that_cannot_be_written(desk, operation, tmp_path):
    form = opened(desk, "ToolAxis_Export", operation)
    (tmp_path / "file").write_text("x")
    bad = []
    for text in ("", "   ", "/proc/plan", str(tmp_path / "file"), str(tmp_path / "file" / "below"),
                 "~nobody-here/plan", str(tmp_path / ("x" * 300)), "/dev/null/x"):
        form.folder.setText(text)
        desk.press(form.write)
        desk.wait(lambda: not busy(form), "it ends")
        if not is_sentence(form.message.text()) or "files in" in form.message.text():
            bad.append((text, form.message.text()))
        assert [one.name for one in tmp_path.iterdir()] == ["file"]
    assert not bad, bad


def test_a_disk_that_is_full(desk, operation, tmp_path):
    import resource
    import signal

    form = opened(desk, "ToolAxis_Export", operation)
    form.folder.setText(str(tmp_path / "plan"))
    usual = resource.getrlimit(resource.RLIMIT_FSIZE)
    told = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # a full disk sends none; FreeCAD's own program would end
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, usual[1]))
    try:
        desk.press(form.write)
        desk.wait(lambda: not busy(form), "it ends")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, usual)
        signal.signal(signal.SIGXFSZ, told)
    assert is_sentence(form.message.text()) and not list(tmp_path.iterdir()), form.message.text()


def test_a_clamp_deleted_while_it_is_ticked(desk, wavy, remembered):
    part, face = wavy
    document = part.Document
    clamp = document.addObject("Part::Box", "Clamp")
    clamp.Placement.Base = Vector(40, 0, 0)
    document.recompute()
    form = desk.start(part, face)
    form.avoid.model().setData(form.avoid.model().index(0, 0), 2, desk.qt.Qt.CheckStateRole)
    document.removeObject(clamp.Name)
    desk.pump(0.2)
    desk.press(form.addFaces)
    desk.type(form.scallop, "0.05 mm")
    desk.computed(form)
    assert "Every face" in form.message.text()
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    assert desk.operation_in(document).Obstacles == []


def test_a_clamp_deleted_between_planning_and_ok(desk, wavy, remembered):
    part, face = wavy
    document = part.Document
    clamp = document.addObject("Part::Box", "Clamp")
    clamp.Placement.Base = Vector(40, 0, 0)
    document.recompute()
    form = desk.start(part, face)
    form.avoid.model().setData(form.avoid.model().index(0, 0), 2, desk.qt.Qt.CheckStateRole)
    desk.type(form.scallop, "0.05 mm")
    form.limits.setCurrentIndex(1)
    desk.type(form.cone, "10 deg")
    desk.computed(form)
    document.removeObject(clamp.Name)
    desk.pump(0.2)
    assert not desk.standard_button("Ok").isEnabled() and is_sentence(form.message.text())


@pytest.mark.parametrize("how", ["moved", "scaled", "moved in its container"])
def test_a_part_changed_between_planning_and_ok(desk, wavy, remembered, how):
    part, face = wavy
    document = part.Document
    holder = document.addObject("App::Part", "Holder")
    holder.addObject(part)
    document.recompute()
    form = desk.start(part, face)
    desk.type(form.scallop, "0.05 mm")
    desk.computed(form)
    assert desk.standard_button("Ok").isEnabled(), form.message.text()
    if how == "moved":
        part.Placement.Base = Vector(5, 0, 0)
    elif how == "scaled":
        shape = part.Shape.copy()
        shape.scale(1.1)
        part.Shape = shape
    else:
        holder.Placement.Base = Vector(5, 0, 0)
    desk.pump(0.2)
    assert not desk.standard_button("Ok").isEnabled() and "compute again" in form.message.text()


def test_undo_takes_the_part_away_while_computing(desk, part_file):
    import Part

    document = FreeCAD.newDocument("Undone")
    document.UndoMode = 1
    document.openTransaction("Import")
    part = document.addObject("Part::Feature", "Part")
    part.Shape = Part.read(str(part_file))
    document.commitTransaction()
    document.recompute()
    form = desk.start(part)
    desk.press(form.compute)
    desk.pump(0.1)
    document.undo()
    desk.pump(0.5)
    assert "deleted" in form.message.text() and not form.compute.isEnabled() and form.faces.count() == 0
    document.redo()
    desk.pump(0.2)
    assert not form.compute.isEnabled()
    desk.gui.Selection.addSelection(document.Name, "Part")
    desk.press(form.addFaces)
    assert form.compute.isEnabled(), form.message.text()


@pytest.mark.parametrize("command", ["ToolAxis_Machine", "ToolAxis_Export", "ToolAxis_Verify"])
def test_all_operations_deleted_under_a_panel(desk, operation, command):
    document = operation.Document
    form = opened(desk, command, operation)
    desk.wait(lambda: not busy(form), "it is there")
    document.removeObject(operation.Name)
    desk.pump(0.5)
    desk.wait(lambda: not busy(form), "it is there")
    assert "deleted" in form.message.text() and is_sentence(form.message.text())
    close(desk)


def test_what_the_machine_met_is_left_when_its_operation_goes(desk, operation, monkeypatch):
    """Found: the collisions were found just as the operation was deleted, and told of one that was gone."""
    from freecad.toolaxis.gui.machine import panel as machine_panel

    look, ready = machine_panel.met_by, threading.Event()
    monkeypatch.setattr(machine_panel, "met_by", lambda *given: (ready.wait(20), look(*given))[1])
    form = opened(desk, "ToolAxis_Machine", operation)
    desk.wait(lambda: not busy(form), "it is there")
    ready.set()
    time.sleep(1.0)  # it is found, and nobody has taken it yet
    operation.Document.removeObject(operation.Name)
    desk.pump(0.5)
    desk.wait(lambda: not busy(form), "it is there")
    assert "deleted" in form.message.text()
    close(desk)


@pytest.mark.parametrize("command", ["ToolAxis_Machine", "ToolAxis_Export", "operation"])
def test_a_document_closed_under_a_panel(desk, operation, command):
    document = operation.Document
    chosen(desk, operation)
    if command == "operation":
        operation.ViewObject.doubleClicked()
        desk.wait(lambda: panel(desk) is not None, "the panel opens")
        desk.press(panel(desk).pictures)
    else:
        form = opened(desk, command, operation)
        if command == "ToolAxis_Export":
            desk.press(form.write)
    FreeCAD.closeDocument(document.Name)
    desk.wait(lambda: panel(desk) is None, "the panel closes")
    desk.pump(1.0)


def test_passes_deleted_before_the_commands(desk, operation):
    document = operation.Document
    document.removeObject(next(thing.Name for thing in operation.Group if thing.TypeId == "Path::Feature"))
    document.recompute()
    before = names(document)
    chosen(desk, operation)
    for command in ("ToolAxis_Verify", "ToolAxis_MakeJobs", "ToolAxis_Machine", "ToolAxis_Play",
                    "ToolAxis_Export"):
        told = run(desk, command)
        assert is_sentence(told)
        close(desk)
        assert names(document) == before, command


def test_the_part_deleted_before_the_commands(desk, operation):
    document = operation.Document
    document.removeObject(operation.Faces[0][0].Name)
    document.recompute()
    before = names(document)
    chosen(desk, operation)
    for command in COMMANDS:
        told = run(desk, command)
        assert is_sentence(told), (command, told)
        close(desk)
        assert names(document) == before, command


def shape_of(kind):
    """Parts that a user may have."""
    import Part

    if kind == "sphere":
        return Part.makeSphere(10)
    if kind == "torus":
        return Part.makeTorus(20, 5)
    if kind == "open shell":
        return Part.Shell(Part.makeSphere(10).Faces[:1] + Part.makeBox(5, 5, 5).Faces[:2])
    if kind == "two bodies":
        return Part.Compound([Part.makeSphere(10), Part.makeSphere(10, Vector(50, 0, 0))])
    if kind == "bodies in one another":
        return Part.Compound([Part.makeSphere(10), Part.makeSphere(6)])
    if kind == "tiny":
        return Part.makeSphere(1e-4)
    if kind == "huge":
        return Part.makeSphere(1e6)
    if kind == "far away":
        return Part.makeSphere(10, Vector(1e7, 0, 0))
    if kind == "cone tip":
        return Part.makeRevolution(Part.BSplineCurve([Vector(0, 0, 0), Vector(5, 0, 3), Vector(10, 0, 10)]), 0, 1,
                                   360, Vector(), Vector(0, 0, 1))
    raise KeyError(kind)


KINDS = ("sphere", "torus", "open shell", "two bodies", "bodies in one another", "tiny", "huge", "far away", "cone tip")


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_parts_that_are_none(desk, kind):
    document = FreeCAD.newDocument("Odd")
    document.UndoMode = 1
    part = document.addObject("Part::Feature", "Odd")
    try:
        part.Shape = shape_of(kind)
    except Exception as reason:
        pytest.skip(f"FreeCAD makes none: {reason}")
    document.recompute()
    before = names(document)
    form = desk.start(part)
    if not form.compute.isEnabled():
        assert is_sentence(form.message.text())
        return
    desk.type(form.scallop, "0.5 mm")
    desk.press(form.compute)
    end = time.monotonic() + PATIENCE
    while form.stop.isEnabled() and time.monotonic() < end:
        desk.pump(0.1)
    if form.stop.isEnabled():
        desk.press(form.stop)
    desk.wait(lambda: not form.stop.isEnabled(), "it ends")
    assert is_sentence(form.message.text()), form.message.text()
    assert is_sentence(form.reasons.text()) or not form.reasons.text(), form.reasons.text()
    assert names(document) == before
    if desk.standard_button("Ok").isEnabled():
        desk.press(desk.standard_button("Ok"))
        desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
        document.undo()
        assert names(document) == before


def test_a_machine_edited_badly_after_it_was_chosen(desk, operation, tmp_path):
    """The file is good when it is picked, bad when OK is pressed, and gone when jobs are made of it later."""
    from toolaxis.machine.library import library

    document = operation.Document
    before = names(document)
    file = tmp_path / "mine.toml"
    file.write_text(library()["bc-table-table"].read_text())
    form = opened(desk, "ToolAxis_Machine", operation)
    form.machine.addItem("mine", str(file))
    form.machine.setCurrentIndex(form.machine.count() - 1)
    desk.wait(lambda: not busy(form), "it is looked at")
    assert "can be reached" in form.message.text(), form.message.text()
    file.write_text("not = [ a machine")
    desk.press(desk.standard_button("Ok"))
    desk.pump(0.2)
    assert desk.form("ToolAxisMachine") is form and is_sentence(form.message.text()) and names(document) == before
    file.write_text(library()["bc-table-table"].read_text())
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisMachine") is None, "the panel closes")
    file.unlink()
    document.recompute()
    assert not operation.Stale
    after = names(document)
    chosen(desk, operation)
    assert "neither a file nor" in run(desk, "ToolAxis_Machine")
    close(desk)
    form = opened(desk, "ToolAxis_Export", operation)
    form.dialect.setCurrentIndex(form.dialect.findData("linuxcnc"))
    form.folder.setText(str(tmp_path / "plan"))
    desk.press(form.write)
    desk.wait(lambda: not busy(form), "it ends")
    assert "neither a file nor" in form.message.text() and not (tmp_path / "plan").exists()
    assert names(document) == after


def test_a_folder_of_machines_that_is_none(desk, wavy, kept_folder):
    for folder in ("/nowhere/at/all", "~nobody-here/machines", "/dev/null"):
        kept_folder(folder)
        form = desk.start(*wavy)
        assert form.limits.count() > 3 and form.compute.isEnabled(), form.message.text()
        close(desk)


@pytest.fixture
def kept_folder():
    from freecad.toolaxis.document.preferences import PLACE

    preferences = FreeCAD.ParamGet(PLACE)
    yield lambda folder: preferences.SetString("MachinesFolder", folder)
    preferences.RemString("MachinesFolder")
