"""Examples walked through as a user does it: from the menu over plan, machine, jobs and export to the saved file."""

import json
import sys
import time
from typing import NamedTuple

import FreeCAD
import numpy as np
import pytest


class Asked(NamedTuple):
    """What is filled in; `shared`: automatic axes for all together, `limited`: limits by the machine.

    `inside`: whether the judge has to find all inside tolerance, with the axis that was locked too.
    """

    title: str
    diameter: str
    scallop: str
    regions: int = 2
    stickout: str = "60 mm"
    shared: bool = False
    limited: bool = False
    inside: bool = True


WALKS = {"freeform": Asked("Freeform face", "12 mm", "0.1 mm", shared=True),
         "trimmed": Asked("Trimmed face with a hole", "8 mm", "0.4 mm", limited=True),
         "bosses": Asked("Face with three bosses", "10 mm", "0.4 mm", 2, "90 mm", inside=False)}
#: The holder that all have, rows of diameter and height, and the height of the document's origin on the table.
HOLDER, HEIGHT = ((20, 0), (20, 40), (50, 40), (50, 80)), 40.0
MACHINE = "bc-table-table"
PASSES, SURFACE, TOOL = "Path::Feature", "Mesh::Feature", "Part::FeaturePython"


class Walk:
    """One example, step by step; each step leaves a picture and says how long the window did not answer.

    Parameters
    ----------
    desk : Desk
    name : str
        Of the example.
    """

    def __init__(self, desk, name):
        self.desk, self.name, self.step = desk, name, 0
        self.longest, self.last, self.begun = 0.0, time.perf_counter(), time.perf_counter()
        self.timer = desk.qt.QTimer()
        self.timer.setInterval(2)
        self.timer.timeout.connect(self.tick)
        self.timer.start()

    def tick(self):
        now = time.perf_counter()
        self.longest, self.last = max(self.longest, now - self.last), now

    def seen(self, what):
        """Take a picture, and tell what the step took."""
        self.step += 1
        now = time.perf_counter()
        sys.__stdout__.write(f"{self.name} {self.step:02d} {what}: {now - self.begun:.1f} s, the window waited "
                             f"{1000 * self.longest:.0f} ms at most\n")
        sys.__stdout__.flush()
        self.desk.shot(f"90-{self.name}-{self.step:02d}-{what}")
        self.begun, self.last, self.longest = (time.perf_counter(),) * 2 + (0.0,)

    @property
    def document(self):
        return FreeCAD.ActiveDocument

    @property
    def plan(self):
        from freecad.toolaxis.document.kinds import is_plan

        return next(filter(is_plan, self.document.Objects), None)

    @property
    def operations(self):
        from freecad.toolaxis.document.kinds import operations_in

        return operations_in(self.plan)

    def opened(self, title):
        """Choose the example in the menu."""
        menus = self.desk.children(self.desk.widgets.QMenu, self.desk.window.menuBar())
        menus += self.desk.children(self.desk.widgets.QMenu)
        inner = next(menu for menu in menus if menu.title().replace("&", "") == "Examples")
        next(action for action in inner.actions() if action.text().replace("&", "") == title).trigger()
        self.desk.wait(lambda: self.document is not None and self.document.Objects, "the example opens")
        self.desk.pump(0.3)
        part, = (thing for thing in self.document.Objects if thing.isDerivedFrom("Part::Feature"))
        assert part.Label == title
        return part

    def computed(self, form):
        """Press Compute, and look at the panel once while it goes on."""
        desk = self.desk
        desk.press(form.compute)
        self.until(form)

    def until(self, form):
        """Wait for a computation."""
        self.desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the computation ends", 900.0)

    def fitted(self):
        view = self.desk.gui.getDocument(self.document.Name).ActiveView
        view.viewIsometric()
        view.fitAll()
        self.desk.pump(0.3)


@pytest.fixture(params=WALKS)
def walk(desk, request):
    """An example, opened from the menu."""
    return Walk(desk, request.param)


def filled(walk, part):
    """The panel, filled in."""
    desk, asked = walk.desk, WALKS[walk.name]
    form = desk.start(part)
    form.rack.setCurrentIndex(0)
    form.tabs.setCurrentWidget(form.toolTab)
    desk.type(form.diameter, asked.diameter)
    desk.type(form.stickout, asked.stickout)
    desk.outline(form.holder, HOLDER)
    walk.seen("tool")
    if asked.limited:
        form.tabs.setCurrentWidget(form.jobTab)
        names = [form.limits.itemText(k) for k in range(form.limits.count())]
        form.limits.setCurrentIndex(next(k for k in range(form.limits.count())
                                         if MACHINE in (form.limits.itemData(k) or "")))
        walk.seen("limits")
        assert len(names) > 5, names
    form.tabs.setCurrentWidget(form.jobTab)
    desk.type(form.scallop, asked.scallop)
    form.tabs.setCurrentWidget(form.advancedTab)
    form.regions.setCurrentIndex(2)
    form.regionsNumber.setValue(asked.regions)
    if asked.shared:
        form.orientations.setCurrentIndex(1)
    desk.pump(0.2)
    walk.seen("fields")
    return form


def picked(walk, form):
    """Pick another number of axes from the curve."""
    desk, curve = walk.desk, form.findChild(walk.desk.widgets.QWidget, "orientationCurve")
    assert curve.isVisible() and len(curve.options) > 1, curve.options
    form.tabs.setCurrentWidget(form.resultTab)
    other = next(one for one in curve.options if not one.chosen)
    desk.hover(curve, curve.position_of(other))
    assert "sub-surfaces" in form.pointer.text()
    walk.seen("curve")
    desk.click(curve, curve.position_of(other))
    walk.until(form)
    assert form.orientationsNumber.value() == other.orientations
    walk.seen("picked")
    return other.orientations


def locked(walk, form):
    """Lock an axis by hand: one tried on the map, or without a map the one that is there; the operation's place."""
    desk, chart = walk.desk, form.findChild(walk.desk.widgets.QWidget, "axisMap")
    form.tabs.setCurrentWidget(form.resultTab)
    titles = [form.operation.itemText(k) for k in range(form.operation.count())]
    form.operation.setCurrentIndex(next(k for k, title in enumerate(titles) if ":" not in title))  # one with an axis
    if chart.picture is None:
        assert "shared by sub-surfaces" in chart.reason
        desk.down(form.lockAxis)
        form.lockAxis.click()
    else:
        desk.down(chart)
        free = chart.picture.axes[chart.picture.reason == 0]
        away = np.abs(np.arccos(np.clip(free @ form_axis(chart), -1, 1)) - 0.1)
        for axis in free[np.argsort(away, kind="stable")][:8]:
            desk.click(chart, chart.position_of(axis))
            desk.wait(lambda: "Trying" not in form.cost.text(), "the axis is tried")
            if form.lock.isEnabled():
                break
        walk.seen("tried")
        desk.press(form.lock)
    assert form.lockAxis.isChecked() and "(locked)" in form.operation.currentText()
    walk.seen("locked")
    return form.operation.currentIndex()


def form_axis(chart):
    """The axis that was chosen."""
    return chart.picture.marks["chosen"][0]


def put(walk):
    walk.desk.press(walk.desk.standard_button("Ok"))
    walk.desk.wait(lambda: walk.desk.form("ToolAxisPlan") is None, "the panel closes")
    walk.fitted()


def looked_at(walk, axes):
    """What stands in the tree."""
    plan, operations = walk.plan, walk.operations
    assert not plan.Stale and plan.DifferentAxes <= axes
    colours = []
    for one in operations:
        kinds = [thing.TypeId for thing in one.Group]
        if one.Outcome in ("optimal", "feasible"):
            assert PASSES in kinds and TOOL in kinds and SURFACE in kinds, (one.Label, kinds)
            assert any("CoordinateSystem" in kind for kind in kinds)
        colours += [tuple(thing.ViewObject.ShapeColor)[:3] for thing in one.Group if thing.TypeId == SURFACE]
    assert len(set(colours)) > 1
    for tree in walk.desk.children(walk.desk.widgets.QTreeWidget):
        tree.expandToDepth(3)
    walk.seen("tree")


def machine_seen(walk):
    """The machine, its angles, and its way from operation to operation."""
    desk = walk.desk
    desk.gui.Selection.clearSelection()
    desk.gui.runCommand("ToolAxis_Machine")
    desk.wait(lambda: desk.form("ToolAxisMachine") is not None, "the panel opens")
    form = desk.form("ToolAxisMachine")
    form.machine.setCurrentIndex(form.machine.findData(MACHINE))
    form.offsetZ.setValue(HEIGHT)
    desk.wait(lambda: form.angles.isEnabled() and "Checking" not in form.message.text(), "all are looked at", 300.0)
    desk.pump(1.0)
    assert "can be reached" in form.message.text(), form.message.text()
    assert form.angles.rowCount() == len([one for one in walk.operations if one.Motions])
    for row in range(form.angles.rowCount()):
        texts = [desk.text(form.angles, row, column) for column in (0, 1)]
        assert all("C" in text and "B" in text for text in texts)
    walk.seen("machine")
    if form.slide.isEnabled():
        said = set()
        for value in range(0, form.slide.maximum() + 1, form.slide.maximum() // 12):
            form.slide.setValue(value)
            desk.pump(0.1)
            said.add(form.pointer.text())
            if "ndex move to" in form.pointer.text():
                walk.seen(f"index-move-{value}")
        assert len(said) > 3
        walk.seen("last-operation")
    desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisMachine") is None, "the panel closes")
    assert all(len(one.RotaryAngles) == 2 for one in walk.operations if one.Motions)


def jobs_made(walk):
    desk, document = walk.desk, walk.document
    desk.gui.Selection.clearSelection()
    told = desk.dialog_text(lambda: desk.gui.runCommand("ToolAxis_MakeJobs"))
    desk.pump(0.5)
    without = [one.Label for one in walk.operations if not one.Motions]
    assert ("Not in the jobs" in told and all(label in told for label in without)) if without else not told, told
    jobs = [thing for thing in document.Objects if hasattr(thing, "PostProcessor")]
    made = [one.OrientedFrom for job in jobs for one in job.Operations.Group]
    assert sorted(one.Name for one in made) == sorted(one.Name for one in walk.operations if one.Motions)
    walk.seen("jobs")
    return jobs


def exported(walk, folder):
    desk = walk.desk
    desk.gui.Selection.clearSelection()
    desk.gui.Selection.addSelection(walk.document.Name, walk.plan.Name)
    desk.gui.runCommand("ToolAxis_Export")
    desk.wait(lambda: desk.form("ToolAxisExport") is not None, "the panel opens")
    form = desk.form("ToolAxisExport")
    assert form.machine.currentData() == MACHINE and form.offsetZ.value() == HEIGHT
    desk.type(form.folder, str(folder))
    form.dialect.setCurrentIndex(form.dialect.findData("linuxcnc"))
    desk.press(form.write)
    desk.wait(lambda: form.write.isEnabled() and not form.stop.isEnabled(), "it is written", 300.0)
    walk.seen("export")
    written = json.loads((folder / "plan.json").read_text())
    assert len(written["operations"]) == len(walk.operations), form.message.text()
    assert (folder / "program-linuxcnc.ngc").stat().st_size > 1000
    desk.press(desk.standard_button("Close"))


def verified(walk, folder):
    """The judge in the panel, and the same of the plan that was written."""
    import toolaxis as ta
    from toolaxis.job.files.plan_folder import read_plan

    desk = walk.desk
    desk.gui.Selection.clearSelection()
    desk.gui.runCommand("ToolAxis_Verify")
    desk.wait(lambda: desk.form("ToolAxisVerify") is not None, "the panel opens")
    form = desk.form("ToolAxisVerify")
    desk.wait(lambda: form.verify.isEnabled(), "the judge is done", 300.0)
    desk.pump(3.0)
    walk.seen("verified")
    judged = ta.verify(read_plan(folder)).operations
    done = [one for one in walk.operations if one.Motions]
    assert [one.Verdict for one in done] == [("failed", "passed")[one.passed] for one in judged], form.reasons.text()
    inside = all(one.passed for one in judged)
    assert form.message.text().startswith("Inside tolerance" if inside else "Not inside tolerance")
    assert inside or not WALKS[walk.name].inside, form.message.text() + form.reasons.text()
    desk.press(desk.standard_button("Close"))
    desk.pump(0.3)
    walk.seen("verified-tree")


@pytest.mark.long
def test_an_example_is_walked_through(walk, tmp_path):
    desk, asked = walk.desk, WALKS[walk.name]
    part = walk.opened(asked.title)
    walk.seen("opened")
    form = filled(walk, part)
    walk.computed(form)
    assert "have an axis" in form.message.text() or "has an axis" in form.message.text(), form.message.text()
    walk.seen("planned")
    axes = picked(walk, form) if asked.shared else 9
    number = locked(walk, form)
    walk.computed(form)
    form.operation.setCurrentIndex(number)
    assert form.lockAxis.isChecked(), "the lock is kept when it is computed again"
    walk.seen("computed-again")
    put(walk)
    looked_at(walk, axes + 1)
    assert [one.AxisLocked for one in walk.operations].count(True) == 1
    machine_seen(walk)
    jobs = jobs_made(walk)
    exported(walk, tmp_path / "plan")
    verified(walk, tmp_path / "plan")
    before = sorted(thing.Name for thing in walk.document.Objects)
    walk.document.saveAs(str(tmp_path / "walked.FCStd"))
    FreeCAD.closeDocument(walk.document.Name)
    FreeCAD.openDocument(str(tmp_path / "walked.FCStd"))
    desk.pump(1.0)
    assert sorted(thing.Name for thing in walk.document.Objects) == before
    assert not walk.plan.Stale and not any(one.Stale for one in walk.operations)
    assert len([thing for thing in walk.document.Objects if hasattr(thing, "PostProcessor")]) == len(jobs)
    walk.fitted()
    walk.seen("reopened")
