"""Make the pictures of the tour through FreeCAD (freecad.md) from the real window.

FreeCAD's Python runs it, on a display of 1400x900 and with TOOLAXIS_SHOTS set, for a window as large: `python
resources/manual/tour.py` writes the pictures beside the manual's other figures, and the program that FreeCAD's
post-processor made to the screen.  ImageMagick takes and scales the pictures.
"""

import importlib.util
import os
import pathlib  # FreeCAD runs commands in this very module, and they import a Path of their own
import subprocess
import sys
import tempfile
import traceback
from contextlib import suppress

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
#: Width of the pictures, pixels, and their number of colours, so that they stay small.
WIDTH, COLOURS = 1200, 96
#: By how much of the view's height the part stands to the left.
SIDE = 0.2


class Tour:
    """Goes through the page step by step.

    Parameters
    ----------
    desk : object
        The desk of tests/workbench/gui/conftest.py.
    folder : Path
        Where the pictures go.
    written : Path
        Where the last step writes the plan and its program.
    """

    def __init__(self, desk, folder, written):
        self.desk, self.folder, self.written = desk, pathlib.Path(folder), pathlib.Path(written)
        self.document = self.face = None

    def picture(self, name):
        """Take a picture of the window as it is now."""
        self.folder.mkdir(parents=True, exist_ok=True)
        target = self.folder / f"freecad-{name}.png"
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder) / "screen.png"
            self.desk.capture(source)
            subprocess.run(["convert", str(source), "-resize", str(WIDTH), "+dither", "-colors", str(COLOURS),
                            "-define", "png:compression-level=9", str(target)], check=True, stdin=subprocess.DEVNULL)

    @property
    def part(self):
        """The part of the example."""
        return next(thing for thing in self.document.Objects if thing.isDerivedFrom("Part::Feature"))

    def walk(self):
        """All steps, from the example to the program; returns what FreeCAD's post-processor wrote."""
        self.example()
        form = self.plan()
        self.result(form)
        self.verified()
        self.divided()
        self.machine()
        text = self.posted()
        self.exported()
        return text

    def example(self):
        """An example part, with the menu that opened it."""
        import FreeCAD

        desk = self.desk
        desk.gui.runCommand("ToolAxis_Example_freeform")
        desk.pump(0.5)
        self.document = FreeCAD.ActiveDocument
        actions = desk.window.menuBar().actions()  # held: in FreeCAD 1.0 a menu's object ends with that of its action
        menu = next(action for action in actions if "Tool Axis" in action.text().replace("&", "")).menu()
        entries = menu.actions()
        inner = next(action for action in entries if action.menu() is not None).menu()
        place = desk.window.menuBar().mapToGlobal(desk.window.menuBar().actionGeometry(menu.menuAction()).bottomLeft())
        self.fitted()
        menu.popup(place)
        desk.pump(0.3)
        at = menu.actionGeometry(inner.menuAction()).topRight()
        inner.popup(menu.mapToGlobal(at))
        self.picture("1-example")
        inner.hide()
        menu.hide()
        desk.pump(0.2)

    def plan(self):
        """The panel of the sculptured face, filled in and computed."""
        desk, part = self.desk, self.part
        kinds = [type(face.Surface).__name__ for face in part.Shape.Faces]
        self.face = f"Face{kinds.index('BSplineSurface') + 1}"
        form = desk.start(part, self.face)
        form.tabs.setCurrentWidget(form.jobTab)
        desk.type(form.scallop, "0.1 mm")
        self.fitted()
        self.top(form)
        self.picture("2-job")
        form.tabs.setCurrentWidget(form.setupTab)
        form.origin.setCurrentIndex(1)
        form.originPlace.setCurrentIndex(1)
        self.fitted()
        self.top(form)
        self.picture("2-setup")
        form.origin.setCurrentIndex(0)
        form.tabs.setCurrentWidget(form.toolTab)
        self.top(form)
        self.picture("3-tool")
        desk.computed(form)
        chart = form.findChild(desk.widgets.QWidget, "axisMap")
        centre, radius = chart.disc()
        desk.click(chart, centre + desk.qt.QPointF(0.2 * radius, -0.25 * radius))
        desk.wait(lambda: "Trying" not in form.cost.text(), "the axis is tried")
        self.top(form)
        self.picture("4-axis")
        return form

    def result(self, form):
        """What OK puts into the document."""
        desk = self.desk
        desk.press(desk.standard_button("Ok"))
        desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
        desk.gui.Selection.clearSelection()
        self.expanded(3)
        self.picture("5-tree")

    def expanded(self, depth):
        """Open the tree so far, and show all of what is visible."""
        for tree in self.desk.children(self.desk.widgets.QTreeWidget):
            with suppress(RuntimeError):
                tree.collapseAll()
                tree.expandToDepth(depth)
        self.fitted(1.1)

    def fitted(self, room=1.3):
        """Show all of what is visible beside the task panel, which lies over the right side of the view."""
        from pivy import coin

        view = self.desk.gui.getDocument(self.document.Name).ActiveView
        view.setAnimationEnabled(False)
        view.viewIsometric()
        view.fitAll()
        camera = view.getCameraNode()
        height = room * camera.height.getValue()
        camera.height.setValue(height)
        right = camera.orientation.getValue().multVec(coin.SbVec3f(1, 0, 0))
        camera.position.setValue(camera.position.getValue() + right * (SIDE * height))
        self.desk.pump(0.3)

    def top(self, form):
        """Scroll the tab that is shown to its beginning."""
        form.tabs.currentWidget().verticalScrollBar().setValue(0)
        self.desk.pump(0.2)

    def verified(self):
        """The judge's map."""
        desk = self.desk
        for thing in desk.operation_in(self.document).Group:
            thing.ViewObject.Visibility = False
        self.fitted()
        desk.gui.runCommand("ToolAxis_Verify")
        desk.wait(lambda: desk.form("ToolAxisVerify") is not None, "the panel opens")
        form = desk.form("ToolAxisVerify")
        desk.wait(lambda: form.verify.isEnabled(), "the judge is done")
        desk.pump(4.0)  # the map is painted piece by piece
        self.picture("6-verified")
        desk.press(desk.standard_button("Close"))
        desk.pump(0.2)

    def divided(self):
        """The same face in two sub-surfaces, as a whole plan; the single operation goes."""
        desk = self.desk
        self.document.removeObject(desk.operation_in(self.document).Name)
        desk.pump(0.2)
        form = desk.start(self.part, self.face)
        form.tabs.setCurrentWidget(form.jobTab)
        desk.type(form.scallop, "0.1 mm")
        form.regions.setCurrentIndex(2)
        self.fitted()
        desk.computed(form)
        form.tabs.setCurrentWidget(form.advancedTab)
        form.advancedTab.ensureWidgetVisible(form.divisionGroup)
        desk.pump(0.2)
        self.picture("7-division")
        desk.press(desk.standard_button("Ok"))
        desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
        desk.gui.Selection.clearSelection()
        self.expanded(2)
        self.picture("8-sub-surfaces")

    def machine(self):
        """The machine around the part, on its way from one orientation to the next."""
        desk = self.desk
        desk.gui.runCommand("ToolAxis_Machine")
        desk.wait(lambda: desk.form("ToolAxisMachine") is not None, "the panel opens")
        form = desk.form("ToolAxisMachine")
        form.machine.setCurrentIndex(form.machine.findData("bc-table-table"))
        form.offsetZ.setValue(20)
        desk.wait(lambda: form.angles.isEnabled() and "Looking" not in form.message.text(), "all are looked at")
        desk.wait(lambda: form.met.text().endswith("found."), "collisions are looked for")
        form.slide.setValue(form.slide.maximum())
        self.picture("9-machine")
        desk.press(desk.standard_button("Ok"))
        desk.wait(lambda: desk.form("ToolAxisMachine") is None, "the panel closes")

    def posted(self):
        """Jobs of FreeCAD's CAM workbench, and the first one's program for LinuxCNC."""
        from Path.Post.Processor import PostProcessorFactory

        desk = self.desk
        desk.gui.Selection.clearSelection()
        desk.gui.runCommand("ToolAxis_MakeJobs")
        desk.pump(0.5)
        jobs = [thing for thing in self.document.Objects if hasattr(thing, "PostProcessor")]
        self.expanded(1)
        self.picture("10-jobs")
        jobs[0].PostProcessor, jobs[0].PostProcessorArgs = "linuxcnc", "--no-show-editor"
        return PostProcessorFactory.get_post_processor(jobs[0], "linuxcnc").export()[0][1]

    def exported(self):
        """The panel of Export, set to a program for one machine."""
        desk = self.desk
        desk.gui.Selection.clearSelection()
        desk.gui.runCommand("ToolAxis_Export")
        desk.wait(lambda: desk.form("ToolAxisExport") is not None, "the panel opens")
        form = desk.form("ToolAxisExport")
        desk.type(form.folder, str(self.written))
        form.dialect.setCurrentIndex(form.dialect.findData("linuxcnc"))
        desk.press(form.write)
        desk.wait(lambda: form.write.isEnabled() and not form.stop.isEnabled(), "it is done")
        if not (self.written / "plan.json").is_file():
            raise RuntimeError(f"nothing was exported: {form.message.text()}")
        self.picture("11-export")
        desk.press(desk.standard_button("Close"))


def desk_module():
    """The module of the tests that drives the window."""
    spec = importlib.util.spec_from_file_location("toolaxis_desk", ROOT / "tests" / "workbench" / "gui" / "conftest.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


if __name__ == "__main__":
    import FreeCAD

    module = desk_module()
    module.set_theme("FreeCAD Light")
    FreeCAD.ParamGet("User parameter:BaseApp/Preferences/NaviCube").SetInt("CornerNaviCube", 2)  # not over the panel
    target = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "figures"
    status = 1
    try:
        desk = module.Desk("light")
        with tempfile.TemporaryDirectory() as folder:
            sys.__stdout__.write(Tour(desk, target, pathlib.Path(folder) / "freeform-plan").walk())
        desk.tidy()
        assert not desk.errors, desk.errors
        status = 0
    except BaseException:
        traceback.print_exc(file=sys.__stdout__)
    sys.__stdout__.flush()
    os._exit(status)  # the interpreter crashes while a window closes
