"""Play: tool, holder and machine run along all operations, before OK and after, with the time and what meets."""

import FreeCAD
import pytest
from FreeCAD import Vector


def opened(desk, *chosen):
    """The panel of Play for what is selected; for all of the document where nothing is."""
    desk.gui.Selection.clearSelection()
    for thing in chosen:
        desk.gui.Selection.addSelection(thing.Document.Name, thing.Name)
    desk.gui.runCommand("ToolAxis_Play")
    desk.wait(lambda: desk.form("ToolAxisPlay") is not None, "the panel opens")
    form = desk.form("ToolAxisPlay")
    desk.wait(lambda: looked(form), "collisions are looked for")
    return form


def looked(form):
    return form.met.text() and not form.met.text().startswith("Checking")


def closed(desk):
    desk.press(desk.standard_button("Close"))
    desk.wait(lambda: desk.form("ToolAxisPlay") is None, "the panel closes")


def tool_of(operation):
    return next(thing for thing in operation.Group if "Position" in thing.PropertiesList)


def hide_red(document):
    """Hide what is red anyway: axes and rapid moves."""
    for thing in document.Objects:
        if thing.TypeId.endswith("CoordinateSystem") or thing.TypeId == "Path::Feature":
            thing.ViewObject.Visibility = False


def clamp_beside(document):
    """A post that nobody ticked, at one side of the part and as high as the holder."""
    clamp = document.addObject("Part::Box", "Clamp")
    clamp.Length, clamp.Width, clamp.Height = 6, 6, 90
    clamp.Placement.Base = Vector(26, 4, 0)
    document.recompute()
    return clamp


def test_the_tool_runs_along_all_operations(desk, leaning, tmp_path):
    """In their order, without a machine; the tools that stand on their passes are hidden meanwhile."""
    document = leaning[0].Document
    hide_red(document)
    tool_of(leaning[0]).ViewObject.Visibility = True
    steps = document.UndoCount
    form = opened(desk)
    assert "The tool alone" in form.message.text() and not form.still.isVisible()
    assert form.met.text().startswith("No collisions found.") and form.met.text().endswith("Not checked: index moves.")
    assert not tool_of(leaning[0]).ViewObject.Visibility
    seen = desk.told_at(form, 50)
    labels = [next(one for one in leaning if one.Label in text).Label for text in seen if "ndex move" not in text]
    assert labels == sorted(labels, key=[one.Label for one in leaning].index) and len(set(labels)) == 2
    assert any("cutting, pass" in text for text in seen) and any("link, pass" in text for text in seen)
    between = desk.index_moves(form)
    assert seen[-1].startswith(f"{leaning[1].Label}: ") and between
    assert "Index move to " + leaning[1].Label in desk.played_at(form, between[0])
    desk.shot("76-played-alone")
    begin, total = (text.split(" of ")[k] for k, text in enumerate((desk_clock(desk, form, 0.0),
                                                                   desk_clock(desk, form, 1.0))))
    assert begin == "0 s" and total.split(":")[0] == form.clock.text().split(" of ")[0]
    assert desk.red_points(document, tmp_path) == 0
    closed(desk)
    assert tool_of(leaning[0]).ViewObject.Visibility and document.UndoCount == steps


def desk_clock(desk, form, share):
    desk.played_at(form, share)
    return form.clock.text()


def test_play_and_pause(desk, operation):
    """One operation alone is played too, to its end, and from the beginning again."""
    form = opened(desk, operation)
    assert form.play.isEnabled() and form.play.text() == "Play" and form.slide.value() == 0
    form.speed.setCurrentIndex(0)
    desk.press(form.play)
    desk.wait(lambda: form.slide.value() > 0, "it moves")
    assert form.play.text() == "Pause"
    desk.press(form.play)
    at = form.slide.value()
    desk.pump(0.3)
    assert form.slide.value() == at and form.play.text() == "Play"
    form.speed.setCurrentIndex(form.speed.count() - 1)
    desk.press(form.play)
    desk.wait(lambda: form.play.text() == "Play", "it ends")
    assert form.slide.value() == form.slide.maximum()
    form.speed.setCurrentIndex(0)
    desk.press(form.play)
    desk.pump(0.1)
    assert form.slide.value() < form.slide.maximum() / 2 and form.play.text() == "Pause"
    closed(desk)


def test_what_the_tool_meets_is_red_and_a_click_leads_there(desk, operation, tmp_path):
    document = operation.Document
    clamp_beside(document)
    hide_red(document)
    form = opened(desk, operation)
    assert form.met.text().startswith("Collisions: "), form.met.text()
    assert "of Clamp by" in form.pointer.text(), "it stands at the first one"
    desk.gui.ActiveDocument.ActiveView.fitAll()
    desk.shot("77-played-into-a-clamp")
    red, first = desk.red_points(document, tmp_path), form.slide.value()
    assert red > 500
    assert desk.opened[-1]().bar.scene.reddened == ["Clamp"], "the clamp is red too, not the tool alone"
    free = next(k / 50 for k, text in enumerate(desk.told_at(form, 50)) if "Clamp" not in text)
    desk.played_at(form, free)
    assert desk.red_points(document, tmp_path) == 0
    form.met.linkActivated.emit("next")
    desk.pump(0.1)
    assert "of Clamp by" in form.pointer.text() and desk.red_points(document, tmp_path) > 500
    form.met.linkActivated.emit("next")
    desk.pump(0.1)
    assert "of Clamp by" in form.pointer.text() and form.slide.value() > first
    document.removeObject("Clamp")
    desk.wait(lambda: form.met.text().startswith("No collisions"), "it is noticed that the clamp is gone")
    closed(desk)


def test_gouges_that_verify_found_are_told(desk, operation):
    """As Verify keeps them, and not where its verdict does not hold any more."""
    motion = len(operation.Motions) // 2
    operation.Verdict, operation.GougeAllowed = "failed", 0.01
    operation.WorstGougeDepths, operation.WorstGougeMotions = [0.25, 0.005], [motion, 3]
    form = opened(desk, operation)
    assert form.met.text().startswith("Collisions: 1 "), form.met.text()
    assert "The cutter gouges the face by 0.2500 mm" in form.pointer.text()
    closed(desk)
    operation.Verdict = "out of date"
    form = opened(desk, operation)
    assert form.met.text().startswith("No collisions"), form.met.text()
    closed(desk)


@pytest.fixture
def machined(leaning):
    """The two operations, with a machine in the document."""
    from freecad.toolaxis.document.machine import place_machine

    place_machine(leaning[0].Document, "bc-table-table", (0, 0, 20), [])
    return leaning


def test_the_machine_of_the_document_moves(desk, machined):
    document = machined[0].Document
    view = desk.gui.getDocument(document.Name).ActiveView
    seen = view.getCameraOrientation()
    form = opened(desk)
    assert form.message.text().startswith("On BC table-table") and form.still.isVisible(), form.message.text()
    assert form.met.text() == "No collisions found."
    texts = [desk.played_at(form, share).splitlines()[1] for share in (0.0, 1.0)]
    assert all("X " in text and "B " in text for text in texts) and texts[0] != texts[1]
    between = desk.index_moves(form)
    assert "Z 500.0" in desk.played_at(form, between[len(between) // 2])
    desk.shot("78-played-on-a-machine")
    closed(desk)
    assert view.getCameraOrientation().isSame(seen, 1e-6)


def test_a_body_of_the_machine_that_meets_a_clamp_is_red(desk, operation):
    """A beam above the part is met by the spindle alone: it is far above the holder's way, and beside the tool."""
    from freecad.toolaxis.document.machine import place_machine

    document = operation.Document
    place_machine(document, "bc-table-table", (0, 0, 20), [])
    beam = document.addObject("Part::Box", "Beam")
    beam.Length, beam.Width, beam.Height = 20, 20, 30
    beam.Placement.Base = Vector(-60, 0, 110)
    document.recompute()
    form = opened(desk)
    assert form.met.text().startswith("Collisions: "), form.met.text()
    assert "spindle" in form.pointer.text() and "of Beam by" in form.pointer.text(), form.pointer.text()
    desk.shot("79-spindle-meets-a-beam")
    closed(desk)


def test_a_machine_that_cannot_hold_an_axis_is_told(desk, leaning):
    from freecad.toolaxis.document.machine import place_machine

    place_machine(leaning[0].Document, "four-axis-a", (0, 0, 0), [])
    form = opened(desk)
    assert form.message.text().startswith("The machine is not shown: ") and "has no position" in form.message.text()
    assert form.play.isEnabled() and not form.still.isVisible()
    closed(desk)


def test_a_job_is_played_in_its_own_order(desk, leaning):
    from freecad.toolaxis.cam.jobs import jobs_of, make_jobs

    document = leaning[0].Document
    make_jobs(document, list(leaning))
    job = jobs_of(leaning[1])[0]
    form = opened(desk, job)
    texts = {text.split(":")[0] for text in desk.told_at(form, 20)}
    assert texts == {leaning[1].Label} and not desk.index_moves(form)
    closed(desk)
    form = opened(desk, job, jobs_of(leaning[0])[0])
    assert desk.played_at(form, 0.0).startswith(f"{leaning[1].Label}: ")
    assert desk.played_at(form, 1.0).startswith(f"{leaning[0].Label}: ")
    closed(desk)


def test_an_operation_deleted_under_the_panel(desk, leaning):
    form = opened(desk)
    assert desk.index_moves(form)
    leaning[0].Document.removeObject(leaning[1].Name)
    desk.wait(lambda: looked(form) and not desk.index_moves(form), "it goes on without it")
    leaning[0].Document.removeObject(leaning[0].Name)
    desk.wait(lambda: "no operation with passes" in form.message.text(), "it is told")
    assert not form.play.isEnabled()
    closed(desk)


def test_a_document_closed_under_the_panel(desk, operation):
    opened(desk, operation)
    FreeCAD.closeDocument(operation.Document.Name)
    desk.wait(lambda: desk.form("ToolAxisPlay") is None, "the panel closes")


def test_a_plan_is_played_before_ok(desk, form, remembered):
    """The time is that of the headline; another axis ends it, and the preview has its tool again."""
    assert not form.playFrame.isVisible() and not form.playAll.isEnabled()
    desk.computed(form)
    assert form.playAll.isEnabled()
    desk.down(form.playAll)
    desk.press(form.playAll)
    desk.wait(lambda: form.playMet.text().startswith("No collisions"), "collisions are looked for")
    form.playSlide.setValue(form.playSlide.maximum() // 2)
    desk.pump(0.1)
    assert "cutting, pass" in form.playPointer.text() or "link, pass" in form.playPointer.text()
    total = form.playClock.text().split(" of ")[1].split(":")[0]
    assert total in form.message.text(), (form.playClock.text(), form.message.text())
    desk.down(form.playPointer)
    desk.shot("35-plan-is-played")
    desk.press(form.play)
    desk.wait(lambda: form.playSlide.value() > form.playSlide.maximum() // 2, "it moves")
    desk.type(form.scallop, "0.06 mm")
    assert not form.playFrame.isVisible() and not form.playAll.isEnabled() and not form.playAll.isChecked()
    desk.type(form.scallop, "0.05 mm")
    desk.computed(form)
    desk.press(form.playAll)
    desk.wait(lambda: form.playMet.text().startswith("No collisions"), "collisions are looked for")
    desk.press(form.playAll)
    assert not form.playFrame.isVisible()
    desk.press(desk.standard_button("Cancel"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
