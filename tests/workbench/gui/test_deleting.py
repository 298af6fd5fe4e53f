"""Deleting by hand with the Del key, undo and redo by the toolbar, and panels whose operation goes away."""

from pathlib import Path

ICONS = Path(__file__).resolve().parents[3] / "resources" / "icons"


def names(document):
    return sorted(thing.Name for thing in document.Objects)


def colours(thing):
    """How many parts of a mesh's scene have a colour at each point."""
    from pivy import coin

    search = coin.SoSearchAction()
    search.setType(coin.SoMaterialBinding.getClassTypeId())
    search.setInterest(coin.SoSearchAction.ALL)
    search.setSearchingAll(True)
    search.apply(thing.ViewObject.RootNode)
    return sum(str(path.getTail().value.get()) == "PER_VERTEX_INDEXED" for path in search.getPaths())


def picture(icon):
    return icon.pixmap(32, 32).toImage()


def pick(desk, *things):
    desk.gui.Selection.clearSelection()
    for thing in things:
        desk.gui.Selection.addSelection(thing.Document.Name, thing.Name)


def run(desk, command):
    """Run a command as its button does; the text of the question it asks, which is answered with yes."""
    action = desk.gui.Command.get(command)
    assert action.isActive(), f"{command} is locked"
    seen = []

    def answer():
        box = desk.app.activeModalWidget()
        if desk.is_a(box, desk.widgets.QMessageBox):
            seen.append(box.text())
            desk.shot("54-question")
            button = box.button(desk.widgets.QMessageBox.Yes)
            (button.click if button is not None else box.accept)()

    timer = desk.qt.QTimer()
    timer.setInterval(200)
    timer.timeout.connect(answer)
    timer.start()
    desk.gui.runCommand(command)
    desk.pump(0.4)
    timer.stop()
    return "\n".join(seen)


def verified(desk):
    desk.gui.Selection.clearSelection()
    desk.gui.runCommand("ToolAxis_Verify")
    desk.wait(lambda: desk.form("ToolAxisVerify") is not None, "the panel opens")
    form = desk.form("ToolAxisVerify")
    desk.wait(lambda: form.verify.isEnabled(), "the judge is done")
    return form


def test_delete_takes_the_whole_operation_and_undo_brings_it_back(desk, operation, wavy):
    document, part = operation.Document, wavy[0]
    verified(desk)
    desk.press(desk.standard_button("Close"))
    before, name = names(document), operation.Name
    maps = [thing.Name for thing in operation.Group if thing.TypeId == "Mesh::Feature"]
    assert len(maps) == 2 and all(colours(document.getObject(one)) for one in maps)
    desk.shot("50-verified-tree")
    pick(desk, operation)
    assert run(desk, "Std_Delete") == ""
    left = names(document)
    assert document.getObject(name) is None and set(left) <= {part.Name, *_origins(document)}
    desk.shot("51-deleted")
    for _ in range(2):
        run(desk, "Std_Undo")
        assert names(document) == before
        again = desk.operation_in(document)
        assert not again.Stale and len(again.Group) == 5 and again.Verdict == "passed"
        assert all(colours(document.getObject(one)) for one in maps), "the maps keep their colours"
        run(desk, "Std_Redo")
        assert names(document) == left
    run(desk, "Std_Undo")
    desk.shot("52-undone")


def _origins(document):
    """Objects that were in the part's file besides it."""
    return {thing.Name for thing in document.Objects if thing.TypeId == "App::Part"}


def test_delete_takes_a_group_with_all_that_is_in_it(desk, operation, wavy):
    document, part = operation.Document, wavy[0]
    above = document.addObject("App::DocumentObjectGroup", "Above")
    above.addObject(operation.InList[0])
    before = names(document)
    for chosen in (operation.InList[0], above):
        left = set(names(document)) - {chosen.Name, "Orientations"}
        pick(desk, chosen)
        run(desk, "Std_Delete")
        assert desk.operation_in(document) is None and document.getObject("Orientations") is None
        assert set(names(document)) <= left and part.Name in names(document)
        run(desk, "Std_Undo")
        assert names(document) == before and not desk.operation_in(document).Stale


def test_an_operation_selected_together_with_what_is_in_it(desk, operation):
    document = operation.Document
    gone = [operation.Name, *(thing.Name for thing in operation.Group)]
    pick(desk, operation, *operation.Group)
    run(desk, "Std_Delete")
    assert not [name for name in gone if document.getObject(name) is not None]
    run(desk, "Std_Undo")
    assert all(document.getObject(name) is not None for name in gone)


def test_deleted_passes_are_told_in_the_tree_and_in_the_panel(desk, operation):
    document = operation.Document
    operation.ViewObject.doubleClicked()
    desk.wait(lambda: desk.form("ToolAxisOperation") is not None, "the panel opens")
    form = desk.form("ToolAxisOperation")
    assert picture(operation.ViewObject.Icon) == picture(desk.gui.getIcon(str(ICONS / "operation.svg")))
    assert form.slide.isEnabled() and form.verify.isEnabled()
    pick(desk, next(thing for thing in operation.Group if thing.TypeId == "Path::Feature"))
    run(desk, "Std_Delete")
    assert operation.Stale and "its passes are missing" in operation.StaleReasons
    assert picture(operation.ViewObject.Icon) == picture(desk.gui.getIcon(str(ICONS / "operation-stale.svg")))
    desk.wait(lambda: "its passes are missing" in form.message.text(), "the panel says so")
    assert not form.slide.isEnabled() and not form.verify.isEnabled()
    desk.shot("53-passes-deleted")
    desk.press(desk.standard_button("Close"))
    run(desk, "Std_Undo")
    assert not operation.Stale and len(operation.Group) == 3
    document.recompute()
    assert not operation.Stale


def test_the_panel_of_verify_when_its_operation_goes_away(desk, operation):
    form = verified(desk)
    assert desk.gui.Command.get("Std_Undo").isActive()
    operation.Document.removeObject(operation.Name)
    desk.pump(0.3)
    assert "deleted" in form.message.text()
    assert not form.verify.isEnabled() and not form.stop.isEnabled() and not form.worst.isVisible()
    desk.shot("55-verify-without-operation")
    desk.press(desk.standard_button("Close"))


def test_undo_and_redo_of_planning_and_verifying(desk, operation):
    document = operation.Document
    planned, passes = names(document), operation.Passes
    form = verified(desk)
    judged = names(document)
    assert set(judged) - set(planned) and operation.Verdict == "passed"
    run(desk, "Std_Undo")
    desk.pump(0.2)
    assert names(document) == planned and operation.Verdict == "not verified"
    desk.shot("56-verify-undone")
    run(desk, "Std_Redo")
    assert names(document) == judged and operation.Verdict == "passed"
    desk.press(desk.standard_button("Close"))
    run(desk, "Std_Undo")
    run(desk, "Std_Undo")
    assert desk.operation_in(document) is None
    desk.shot("57-planning-undone")
    run(desk, "Std_Redo")
    again = desk.operation_in(document)
    assert names(document) == planned and again.Passes == passes and not again.Stale
    desk.shot("58-planning-redone")
    assert form is not None


def test_an_operation_deleted_while_it_is_planned_again(desk, operation):
    document = operation.Document
    pick(desk, operation)
    desk.gui.runCommand("ToolAxis_Recompute")
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
    form = desk.form("ToolAxisPlan")
    name = operation.Name
    document.removeObject(name)
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the computation ends")
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    assert desk.operation_in(document) is not None


def test_the_growing_map_says_whose_it_is(desk, part_file):
    part = desk.open(part_file)
    sides = [f"Face{k}" for k, face in enumerate(part.Shape.Faces, 1) if type(face.Surface).__name__ != "Plane"][:2]
    form = desk.start(part, *sides)
    form.tabs.setCurrentWidget(form.jobTab)
    desk.type(form.scallop, "0.05 mm")
    seen, titles = [], [f"Face {name.removeprefix('Face')}" for name in sides]
    timer = desk.qt.QTimer()
    timer.setInterval(20)
    timer.timeout.connect(lambda: seen.append(form.cost.text()))
    timer.start()
    desk.press(form.compute)
    desk.wait(lambda: any("tested so far" in text for text in seen) or form.compute.isEnabled(), "the map grows")
    desk.shot("59-growing-title")
    desk.wait(lambda: form.compute.isEnabled(), "the computation ends")
    timer.stop()
    told = {text.split(":")[0] for text in seen if "tested so far" in text}
    assert told and told <= set(titles), (told, titles)
    assert "tested so far" not in form.cost.text()
    desk.shot("60-several-faces")
