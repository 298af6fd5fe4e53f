"""A part planned with a rack from the panel: chosen, computed, put into the tree, written out, saved and reopened."""

import json
from pathlib import Path

import pytest


@pytest.fixture
def grooved(desk, whole_parts):
    """A block whose top has a groove that only the smaller tool of `whole_parts.RACK` reaches, and the name of the top.
    """
    import FreeCAD

    document = FreeCAD.newDocument("Grooved")
    document.UndoMode = 1
    thing, name = whole_parts.grooved(document)
    view = desk.gui.getDocument(document.Name).ActiveView
    view.viewIsometric()
    view.fitAll()
    return thing, name


@pytest.fixture
def rack_file(whole_parts, tmp_path):
    path = tmp_path / "my-rack.toml"
    path.write_text(whole_parts.RACK, encoding="utf-8")
    return path


@pytest.fixture
def form(desk, grooved, rack_file, monkeypatch):
    """The panel with the rack, for the grooved face."""
    form = desk.start(*grooved)
    monkeypatch.setattr(desk.widgets.QFileDialog, "getOpenFileName", lambda *_: (str(rack_file), ""))
    form.rack.setCurrentIndex(form.rack.findText("library file..."))
    desk.pump(0.1)
    desk.type(form.scallop, "0.1 mm")
    return form


def plan_in(document):
    from freecad.toolaxis.document.kinds import is_plan

    return next(filter(is_plan, document.Objects), None)


def test_a_rack_machines_the_only_body_where_nothing_is_selected(desk, grooved):
    form = desk.start()
    assert not form.faces.count() and not form.compute.isEnabled()
    form.rack.setCurrentIndex(form.rack.findText("general rack"))
    desk.pump(0.1)
    assert form.facesTold.toolTip() == "5 of Grooved" and form.faces.count() == 5 and form.compute.isEnabled()
    assert form.rackTools.count() > 10
    assert desk.text(form.avoid, 0) == "no other body in the document", "what is machined is not to be avoided"
    desk.shot("89-general-rack")


@pytest.fixture
def skin(desk):
    """The example of a skin of several faces."""
    return desk.open(Path(__file__).resolve().parents[3] / "examples" / "skin.step")


def listed(desk, form):
    return [desk.text(form.faces, row) for row in range(form.faces.count())]


def test_with_a_rack_skins_are_listed_and_one_that_is_marked_is_lit(desk, skin):
    form = desk.start(skin)
    assert form.rack.currentText() == "general rack", "a whole part is machined with a rack"
    form.rack.setCurrentIndex(0)
    faces = form.faces.count()
    assert faces > 2 and form.facesTold.toolTip() == f"{faces} of {skin.Label}"
    form.rack.setCurrentIndex(form.rack.findText("general rack"))
    desk.wait(lambda: "skins" in form.facesTold.toolTip(), "skins are found")
    rows = listed(desk, form)
    told = form.facesTold.toolTip()
    assert told.startswith(f"skins: {len(rows)} of {faces} faces, {skin.Label}") and len(rows) < faces
    assert " more, " in rows[0]
    row = form.faces.visualRect(form.faces.model().index(0, 0))
    desk.click(form.faces.viewport(), row.center())
    chosen, = desk.gui.Selection.getSelectionEx()
    assert len(chosen.SubElementNames) == int(rows[0].split(" and ")[1].split()[0]) + 1
    desk.shot("88-skins")
    form.facesFilter.setText(chosen.SubElementNames[1])
    assert not form.faces.isRowHidden(0), "the name of any face of a skin finds it"
    form.facesFilter.setText("")
    desk.press(form.removeFaces)
    assert form.faces.count() == faces - len(chosen.SubElementNames), "the rest is no whole part: its faces are alone"
    form.rack.setCurrentIndex(0)
    assert "skins" not in form.facesTold.toolTip()


def test_tiny_skins_are_not_listed_but_machined(desk, skin):
    from freecad.toolaxis.gui.plan.face_list import FaceList

    widget = desk.widgets.QListWidget()
    faces = FaceList(widget)
    names = [(skin, f"Face{k + 1}") for k in range(len(skin.Shape.Faces))]
    faces.faces = names
    faces._areas = {key: 1e-3 if key[2] == "Face1" else area for key, area in faces._areas.items()}
    faces.show_skins([tuple(names[1:3])])
    hidden = [widget.isRowHidden(row) for row in range(widget.count())]
    assert hidden == [False] * (len(names) - 2) + [True] and faces.faces == tuple(names)
    assert faces.summary().endswith(", tiny and not listed: 1")
    faces.show_matching("Face1")
    assert not widget.isRowHidden(widget.count() - 1), "it is listed where it is looked for"
    assert faces.mark(names[2]) == tuple(names[1:3]), "also where it is hidden"
    faces.show_matching("")
    faces.mark(names[2])
    assert faces.marked == tuple(names[1:3])


@pytest.mark.parametrize("camera", ["Orthographic", "Perspective"])
def test_faces_that_cannot_be_seen_are_listed_alone_or_left_out(desk, camera):
    import FreeCAD

    document = FreeCAD.newDocument("Balls")
    for name, radius, x, z in (("Above", 8, 0, 20), ("Below", 3, 0, 0), ("Beside", 5, 30, 0), ("Gone", 5, 60, 0)):
        document.addObject("Part::Sphere", name).Radius = radius
        document.getObject(name).Placement.Base = FreeCAD.Vector(x, 0, z)
    document.recompute()
    document.getObject("Gone").Visibility = False
    view = desk.gui.getDocument(document.Name).ActiveView
    view.setCameraType(camera)
    view.viewTop()
    view.fitAll()
    form = desk.start(document.getObject("Above"))
    for name in ("Below", "Beside", "Gone"):
        desk.gui.Selection.addSelection(document.Name, name)
    desk.press(form.addFaces)

    def shown(way):
        form.facesSeen.setFocus()
        desk._key(form.facesSeen, getattr(desk.qt.Qt, f"Key_{way}"), "")
        return [desk.text(form.faces, row).split(", ")[-1] for row in range(form.faces.count())
                if not form.faces.isRowHidden(row)]

    assert shown("Down") == ["Above", "Beside"] and form.facesSeen.currentText() == "in sight"
    assert shown("Down") == ["Below", "Gone"] and form.facesSeen.currentText() == "hidden"
    desk.shot(f"87-hidden-{camera}")
    view.viewFront()
    assert shown("Up") == ["Above", "Below", "Beside"]
    form.facesFilter.setText("Be")
    assert shown("Down") == [] and shown("Up") == ["Below", "Beside"]
    form.facesFilter.setText("")
    shown("Down")
    form.faces.selectAll()
    desk.press(form.removeFaces)
    assert form.faces.count() == 3 and shown("Up") == shown("Up") == ["Above", "Below", "Beside"]


@pytest.mark.parametrize("camera", ["Orthographic", "Perspective"])
def test_what_is_in_sight_follows_the_view_when_it_has_come_to_rest(desk, camera, monkeypatch):
    """Found: the list stayed as the view had stood when it was chosen."""
    import FreeCAD
    from freecad.toolaxis.gui.plan import view_watch

    document = FreeCAD.newDocument("TwoBalls")
    for name, z in (("Above", 20), ("Below", 0)):
        document.addObject("Part::Sphere", name).Placement.Base = FreeCAD.Vector(0, 0, z)
    document.recompute()
    view = desk.gui.getDocument(document.Name).ActiveView
    view.setCameraType(camera)
    view.viewTop()
    view.fitAll()
    form = desk.start(document.getObject("Above"))
    desk.gui.Selection.addSelection(document.Name, "Below")
    desk.press(form.addFaces)
    choice = desk.opened[-1]().choice

    def listed():
        return [desk.text(form.faces, row).split(", ")[-1] for row in range(form.faces.count())
                if not form.faces.isRowHidden(row)]

    assert listed() == ["Above", "Below"] and not choice.watch._timer.isActive(), "nobody asked for what is in sight"
    form.facesSeen.setFocus()
    desk._key(form.facesSeen, desk.qt.Qt.Key_Down, "")
    assert listed() == ["Above"] and choice.watch._timer.isActive()
    desk.shot(f"88-in-sight-top-{camera}")
    view.viewBottom()
    desk.wait(lambda: listed() == ["Below"], "the list follows")
    view.viewFront()
    desk.wait(lambda: listed() == ["Above", "Below"], "the list follows again")
    desk.shot(f"88-in-sight-front-{camera}")
    document.getObject("Above").Visibility = False
    view.viewTop()
    desk.wait(lambda: listed() == ["Below"], "what is hidden hides nothing")
    desk._key(form.facesSeen, desk.qt.Qt.Key_Up, "")
    assert listed() == ["Above", "Below"] and not choice.watch._timer.isActive()
    desk._key(form.facesSeen, desk.qt.Qt.Key_Down, "")
    usual, looks = view_watch.camera_of, []
    monkeypatch.setattr(view_watch, "camera_of", lambda of: looks.append(of) or usual(of))
    desk.wait(lambda: looks, "the view is looked at")
    desk.press(desk.standard_button("Cancel"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    looks.clear()
    desk.pump(0.6)
    assert not looks, "it is off when the panel is closed"


def test_what_is_computed_is_lit_in_the_view(desk, grooved, form):
    panel = desk.opened[-1]()
    thing, name = grooved
    panel.choice._numbered = {2: (thing, name), 3: (thing, "Face3")}
    panel.fields.faces.show_skins([((thing, name), (thing, "Face3"))])
    panel.choice.light("Ball D6: division by reach: face 3+2a (1 of 5): search for the axis")
    chosen, = desk.gui.Selection.getSelectionEx()
    assert chosen.Object == thing and set(chosen.SubElementNames) == {name, "Face3"}
    assert panel.fields.faces.faces == ((thing, name),), "a plane that continues the skin is not chosen for that"
    panel.choice.light("Ball D6: checking")
    assert desk.gui.Selection.getSelectionEx()


def test_a_rack_is_chosen_without_typing_a_tool(desk, form):
    assert form.rack.currentText() == "my-rack.toml" and form.facesTold.toolTip() == "1 of Grooved"
    assert form.compute.isEnabled()
    for name in ("strategy", "orientations", "compare"):
        assert not getattr(form, name).isEnabled(), name
    assert form.regions.isEnabled() and form.regions.currentText() == "automatic"
    form.tabs.setCurrentWidget(form.toolTab)
    assert form.mostTools.isVisible() and form.rackTools.isVisible()
    assert not form.diameter.isVisible() and not form.holder.isVisible()
    assert [desk.text(form.rackTools, row) for row in range(form.rackTools.count())] == [
        "T1 Ball D20, 60 out", "T7 Ball D6, 40 out"]
    desk.shot("90-rack")
    form.rack.setCurrentIndex(0)
    assert form.diameter.isVisible() and not form.rackTools.isVisible() and form.strategy.isEnabled()
    assert form.regions.currentText() == "whole faces"


def test_faces_stay_whole_where_that_is_asked_of_a_rack(desk, grooved, form):
    from freecad.toolaxis.document.inputs import inputs_of

    form.regions.setCurrentIndex(form.regions.findText("number"))
    form.regionsNumber.setValue(3)
    assert "a number of regions is planned with one tool" in form.message.text() and not form.compute.isEnabled()
    form.regions.setCurrentIndex(form.regions.findText("whole faces"))
    assert form.compute.isEnabled()
    desk.computed(form)
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    plan = plan_in(grooved[0].Document)
    assert inputs_of(plan).regions == 1
    plan.ViewObject.doubleClicked()
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
    form = desk.form("ToolAxisPlan")
    assert form.regions.currentText() == "whole faces"


def test_a_dialog_that_is_cancelled_and_a_rack_that_is_none(desk, form, monkeypatch, tmp_path):
    monkeypatch.setattr(desk.widgets.QFileDialog, "getOpenFileName", lambda *_: ("", ""))
    form.rack.setCurrentIndex(form.rack.findText("library file..."))
    assert form.rack.currentText() == "my-rack.toml"
    monkeypatch.setattr(desk.widgets.QFileDialog, "getExistingDirectory", lambda *_: str(tmp_path / "empty"))
    (tmp_path / "empty").mkdir()
    form.rack.setCurrentIndex(form.rack.findText("folder of tools..."))
    assert "is empty" in form.message.text() and not form.compute.isEnabled()
    assert "is empty" in form.rackNote.text() and not form.rackTools.count()


def test_fields_of_the_advanced_tab_are_asked_for(desk, form):
    form.tabs.setCurrentWidget(form.advancedTab)
    desk.type(form.stock, "0.3 mm")
    desk.type(form.greatestStepOver, "0.05 mm")
    assert "greatest step-over is 0.05 mm" in form.message.text() and not form.compute.isEnabled()
    desk.type(form.greatestStepOver, "4")
    desk.type(form.leastLean, "95")
    assert "least lean" in form.message.text()
    desk.type(form.leastLean, "3")
    desk.type(form.lead, "1")
    form.held.setText("below")
    assert "below" in form.message.text() and not form.compute.isEnabled()
    form.held.setText("z<0")
    form.allowanceOn.setText("nonsense")
    assert "nonsense" in form.message.text()
    form.allowanceOn.setText("")
    assert form.compute.isEnabled()
    desk.shot("91-advanced")


def test_from_the_rack_to_a_program_and_back(desk, grooved, form, remembered, tmp_path):
    import FreeCAD
    from freecad.toolaxis.document.kinds import operations_in
    from freecad.toolaxis.document.tool_colours import tool_colour
    from freecad.toolaxis.gui.commands.export import Export

    document = grooved[0].Document
    before = sorted(thing.Name for thing in document.Objects)
    growth, table, seen = desk.opened[-1]().growth, form.toolTable, set()
    growth_node = growth._node

    def noted(piece):
        seen.add((type(piece).__name__, piece.tool.shop_name))
        return growth_node(piece)

    growth._node = noted
    desk.press(form.compute)
    desk.wait(lambda: not growth.empty or form.compute.isEnabled(), "what tools reach is shown")
    assert table.model().headerData(1, desk.qt.Qt.Horizontal) == "Largest for" and table.isVisible()
    assert form.tabs.currentWidget() is form.resultTab and "largest tool" in form.growthNote.text()
    assert form.growthNote.isVisible()
    desk.shot("92-growing")
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the computation ends")
    assert seen == {(kind, tool) for kind in ("SeenCells", "SeenCuts")
                    for tool in ("Ball D20, 60 out", "Ball D6, 40 out")}, "what each reaches, and its passes"
    assert growth.empty and growth.root is None, "the plan has taken its place"
    assert not form.growthNote.isVisible()
    assert table.model().headerData(1, desk.qt.Qt.Horizontal) == "Area"
    assert " machined" in form.message.text() and "with 2 of 2 tools, passes: " in form.message.text()
    assert "mean step-over " in form.message.text() and "orientations: " in form.message.text()
    assert "OK puts the plan into the document" in form.message.text()
    assert [desk.text(table, row) for row in range(2)] == ["T1 Ball D20, 60 out", "T7 Ball D6, 40 out"]
    assert not form.lock.isVisible() and not form.turnFeed.isVisible()
    desk.shot("92-account")
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    plan = plan_in(document)
    made = operations_in(plan)
    done = [one for one in made if one.Motions]
    assert {one.ToolNumber for one in done} == {1, 7} and all(f"T{one.ToolNumber}" in one.Label for one in done)
    assert {one.ToolTitle for one in done} == {"Ball D20, 60 out", "Ball D6, 40 out"}
    assert {one.StickOut.Value for one in done} == {60.0, 40.0} and all(one.Holder for one in done)
    for one in done:
        passes = next(thing for thing in one.Group if thing.isDerivedFrom("Path::Feature"))
        place = [1, 7].index(one.ToolNumber)
        assert tuple(passes.ViewObject.NormalColor)[:3] == pytest.approx(tool_colour(place), abs=0.01)
    assert plan.Machined.Value > 0.9 * plan.FaceArea.Value and len(plan.ToolsUsed) == 2
    desk.shot("93-tree")
    document.undo()
    desk.pump(0.2)
    assert sorted(thing.Name for thing in document.Objects) == before, "one undo step takes all back"
    document.redo()
    document.saveAs(str(tmp_path / "Grooved.FCStd"))
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(str(tmp_path / "Grooved.FCStd"))
    desk.pump(0.3)
    plan = plan_in(again)
    assert not plan.Stale and not any(one.Stale for one in operations_in(plan))
    plan.ViewObject.doubleClicked()
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
    form = desk.form("ToolAxisPlan")
    assert "with 2 of 2 tools, passes: " in form.message.text() and form.toolTable.rowCount() == 4
    assert form.rack.currentText() == "my-rack.toml"
    desk.shot("94-reopened")
    desk.press(desk.standard_button("Cancel"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    desk.gui.Selection.clearSelection()
    Export().Activated()
    desk.wait(lambda: desk.form("ToolAxisExport") is not None, "the panel opens")
    out = desk.form("ToolAxisExport")
    out.folder.setText(str(tmp_path / "out"))
    out.dialect.setCurrentIndex(out.dialect.findData("linuxcnc") if out.dialect.findData("linuxcnc") > 0 else 1)
    out.machine.setCurrentIndex(out.machine.findData("bc-table-table"))
    desk.press(out.write)
    desk.wait(lambda: out.write.isEnabled(), "the files are written")
    assert (tmp_path / "out" / "plan.json").exists(), out.message.text()
    words = json.loads((tmp_path / "out" / "plan.json").read_text())
    assert [tool["number"] for tool in words["tools"]] == [1, 7]
    assert words["part"]["machined"] == pytest.approx(plan.Machined.Value)
    assert words["part"]["open"] == pytest.approx(plan.Open.Value, abs=1e-6)
    program = next(path for path in (tmp_path / "out").iterdir() if path.name.startswith("program")).read_text()
    assert "T1" in program and "T7" in program
    desk.press(desk.standard_button("Close"))


def test_what_one_tool_leaves_is_offered_to_all(desk, form, remembered):
    form.tabs.setCurrentWidget(form.toolTab)
    form.mostTools.setValue(1)
    desk.computed(form)
    assert "with 1 of 2 tools" in form.message.text() and "100" not in form.message.text().split(" of ")[0]
    offered = [button.text() for button in (form.remedy1, form.remedy2, form.remedy3) if button.isVisible()]
    assert offered == ["Allow any number of tools", "Use the general rack"]
    desk.shot("95-rest-of-one-tool")
    desk.press(form.remedy1)
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "it is computed again")
    assert form.mostTools.value() == 0 and "with 2 of 2 tools" in form.message.text()


def test_stop_keeps_what_is_finished(desk, grooved, form):
    desk.press(form.compute)
    desk.wait(lambda: "D6" in form.message.text() or not form.stop.isEnabled(), "the smaller tool begins")
    if form.stop.isEnabled():
        desk.press(form.stop)
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the computation ends")
    assert form.message.text().startswith("Stopped. ") and "not begun" in form.message.text()
    assert "OK puts what is finished into the document" in form.message.text()
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    plan = plan_in(grooved[0].Document)
    assert plan.Outcome == "cancelled" and plan.NotBegun.Value > 0 and plan.Machined.Value > 0


def test_what_was_found_so_far_goes_with_a_stop_and_with_the_part(desk, grooved, form):
    growth, thing = desk.opened[-1]().growth, grooved[0]

    def begun():
        desk.press(form.compute)
        desk.wait(lambda: not growth.empty, "what tools reach is shown")

    begun()
    desk.press(form.stop)
    desk.wait(lambda: form.compute.isEnabled(), "it is stopped")
    assert growth.empty and growth.root is None and not form.growthNote.isVisible() and not form.toolTable.isVisible()
    begun()
    thing.Document.removeObject(thing.Name)
    desk.pump(0.3)
    assert growth.empty and growth.root is None and not form.growthNote.isVisible() and not form.toolTable.isVisible()
    assert "The part was deleted" in form.message.text()
