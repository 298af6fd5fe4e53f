"""A desk to drive FreeCAD's window as a user does: clicks, keys, waits with a limit, and screenshots to look at.

Screenshots are taken where TOOLAXIS_SHOTS names a folder for them.
"""

import fcntl
import gc
import hashlib
import os
import pickle
import subprocess
import sys
import time
import traceback
import xml.etree.ElementTree as ElementTree
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from weakref import ref

import pytest

ROOT = Path(__file__).resolve().parents[3]
SHOTS = os.environ.get("TOOLAXIS_SHOTS")
SIZE = (1400, 900) if SHOTS else (1000, 700)  # each frame is drawn by software, and costs by its area
TURNS = 8
PAUSE = 0.05  # between looks at what is waited for: the window takes time from what is computed beside it, s
LIMIT = 600.0  # the library's kernels are compiled when they are first used
PACKS, STYLES = "Gui/PreferencePacks/{0}/{0}.cfg", "Gui/Stylesheets/parameters/{0}.yaml"


def set_theme(name):
    """Put a theme of FreeCAD's own into the profile, before the window is made."""
    import FreeCAD

    folder = Path(FreeCAD.getResourceDir())
    pack = folder / PACKS.format(name)
    if not pack.is_file():
        return
    setters = {"FCText": lambda group, node: group.SetString(node.get("Name"), node.text or ""),
               "FCBool": lambda group, node: group.SetBool(node.get("Name"), node.get("Value") == "1"),
               "FCInt": lambda group, node: group.SetInt(node.get("Name"), int(node.get("Value"))),
               "FCUInt": lambda group, node: group.SetUnsigned(node.get("Name"), int(node.get("Value"))),
               "FCFloat": lambda group, node: group.SetFloat(node.get("Name"), float(node.get("Value")))}

    def walk(node, path):
        for child in node:
            if child.tag == "FCParamGroup":
                walk(child, [*path, child.get("Name")])
            elif child.tag in setters:
                setters[child.tag](FreeCAD.ParamGet("User parameter:" + "/".join(path)), child)

    walk(ElementTree.parse(pack).getroot().find("FCParamGroup"), [])
    window = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/MainWindow")
    window.SetString("ThemeStyleParametersFile", str(folder / STYLES.format(name)))


@contextmanager
def nothing_ends():
    """Keep widgets that are looked at alive: forms of closed panels end, with all that is in them, whenever Python
    collects what nobody holds."""
    usual = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if usual:
            gc.enable()


def form_of(opened):
    """The widget of a task panel, or a window itself."""
    return getattr(opened, "form", opened)


class Leaver:
    """Ends the process at once with the tests' status: the interpreter crashes while a window closes."""

    def __init__(self):
        self.status = 1

    def pytest_sessionfinish(self, exitstatus):
        self.status = int(exitstatus)

    @pytest.hookimpl(trylast=True)
    def pytest_unconfigure(self):
        for stream in (sys.stdout, sys.stderr, sys.__stdout__, sys.__stderr__):
            stream.flush()
        os._exit(self.status)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(call):
    """A failure that is told holds nothing any more: Python's objects of its widgets would stand for others, at their
    addresses, in the tests that follow, and FreeCAD would end there."""
    report = yield
    if call.excinfo is not None:
        traceback.clear_frames(call.excinfo.tb)
    return report


class Desk:
    """FreeCAD's window and what one does with it."""

    def __init__(self, theme):
        import FreeCAD
        import FreeCADGui

        if not FreeCAD.GuiUp:
            FreeCADGui.showMainWindow()
        from PySide import QtCore, QtWidgets

        self.window = FreeCADGui.getMainWindow()
        self.theme, self.app, self.gui = theme, QtWidgets.QApplication, FreeCADGui
        self.qt, self.widgets = QtCore, QtWidgets
        self.window.setGeometry(0, 0, *SIZE)
        self.pump(0.5)
        FreeCADGui.activateWorkbench("ToolAxisWorkbench")
        self.pump(0.3)
        self.errors, self.held = [], []
        self.opened, self.made = [], []
        self._record()
        self.reports = [w for w in self.children(self.widgets.QTextEdit)  # the window keeps them to its end
                        if "Report" in w.objectName() or "Report" in w.metaObject().className()]
        sys.excepthook = lambda kind, value, trace: self.errors.append(f"{kind.__name__}: {value}")

    def _record(self):
        """Let task panels and windows of pictures be known from when they are made until Qt deletes their forms."""
        from freecad.toolaxis.gui.manual.window import ManualWindow
        from freecad.toolaxis.gui.pictures.window import PictureWindow
        from freecad.toolaxis.gui.widgets.panel import Panel

        def recorded(usual):
            def __init__(one, *given):
                usual(one, *given)
                known = ref(one)
                self.opened.append(known)
                self.made.append(known)
                form_of(one).destroyed.connect(lambda *_: self.opened.remove(known))
            return __init__

        for kind in (Panel, PictureWindow, ManualWindow):
            kind.__init__ = recorded(kind.__init__)

    def pump(self, seconds=0.05):
        """Let the window live for a while, and for some turns of its loop however busy the machine is."""
        end, turns = time.monotonic() + seconds, 0
        while time.monotonic() < end or turns < TURNS:
            self.app.processEvents(self.qt.QEventLoop.AllEvents, 10)
            time.sleep(0.002)
            turns += 1

    def wait(self, condition, what, limit=LIMIT):
        """Let the window live until something is so; fail after a limit of seconds."""
        end = time.monotonic() + limit
        while not condition():
            assert time.monotonic() < end, f"waited {limit:.0f} s in vain until {what}"
            self.pump(0.02)
            time.sleep(PAUSE)

    def is_a(self, widget, kind):
        """Whether a widget is of a class in Qt too: Python's object may be that of a dead one at the same address, and
        FreeCAD ends when what the widget does not have is called."""
        try:
            return isinstance(widget, kind) and widget.inherits(kind.__name__)
        except RuntimeError:  # it is known to be dead
            return False

    def children(self, kind, within=None):
        """All widgets of a class, in a widget if one is given.

        Without one the window is not asked: its Python object would keep those of all that was found in it, which are
        handed out again, when they are dead, for other widgets at their addresses.  Even so an answer is a risk, see
        `standard_button`: ask once in a test, not again and again.
        """
        with nothing_ends():
            found = self.app.allWidgets() if within is None else within.findChildren(kind)
            return [one for one in found if self.is_a(one, kind)]

    def form(self, name):
        """The form of an open task panel, or an open window of pictures, as the add-on itself holds it; or None.

        Qt is not asked for all its widgets, since some tests look ten times a second: an answer has Python's objects
        of a thousand, now and then one of a dead widget among them.
        """
        for one in filter(None, [known() for known in self.opened]):
            with suppress(RuntimeError):  # it was deleted
                if form_of(one).objectName() == name and form_of(one).isVisible():
                    return form_of(one)
        return None

    def press(self, button):
        """Click a button with the mouse."""
        assert button.isEnabled(), f"{button.text()} is locked"
        self.click(button, button.rect().center())

    def click(self, widget, position):
        """Click somewhere in a widget."""
        for kind in (self.qt.QEvent.MouseButtonPress, self.qt.QEvent.MouseButtonRelease):
            self._mouse(kind, widget, position)
        self.pump(0.05)

    def hover(self, widget, position):
        """Move the pointer over a widget."""
        self._mouse(self.qt.QEvent.MouseMove, widget, position)
        self.pump(0.05)

    def _mouse(self, kind, widget, position):
        from PySide import QtGui

        local = self.qt.QPointF(position.x(), position.y())
        left, none = self.qt.Qt.LeftButton, self.qt.Qt.NoButton
        button = none if kind == self.qt.QEvent.MouseMove else left
        held = left if kind == self.qt.QEvent.MouseButtonPress else none
        place = self.qt.QPointF(widget.mapToGlobal(local.toPoint()))
        self.app.sendEvent(widget, QtGui.QMouseEvent(kind, local, place, button, held, self.qt.Qt.NoModifier))

    def type(self, widget, text):
        """Replace the text of a field by typing, and leave it."""
        widget.setFocus()
        self.pump(0.02)
        line = widget if isinstance(widget, self.widgets.QLineEdit) else widget.findChild(self.widgets.QLineEdit)
        line.selectAll()
        for letter in text:
            self._key(line, 0, letter)
        self._key(line, self.qt.Qt.Key_Tab, "\t")
        self.pump(0.1)

    def shown(self, widget):
        """The text that a field shows."""
        return widget.findChild(self.widgets.QLineEdit).text()

    def _key(self, widget, key, text):
        from PySide import QtGui

        for kind in (self.qt.QEvent.KeyPress, self.qt.QEvent.KeyRelease):
            self.app.sendEvent(widget, QtGui.QKeyEvent(kind, key, self.qt.Qt.NoModifier, text))

    def standard_button(self, name):
        """A button in the bar of the task panel, from the panel that FreeCAD gave the bar to.

        Qt is not asked for all its widgets: among Python's objects of a thousand there may be one of a dead widget,
        which stands for another at an address within its own, and FreeCAD ends when that one is called.
        """
        for one in filter(None, [known() for known in self.opened]):
            if getattr(one, "buttons", None) is not None:
                return one.buttons.button(getattr(self.widgets.QDialogButtonBox, name))
        raise AssertionError(f"there is no button {name}")

    def dialog_text(self, action):
        """The text of the message box that an action opens; it is answered with OK."""
        seen = []

        def answer():
            box = self.app.activeModalWidget()
            if self.is_a(box, self.widgets.QMessageBox):  # a dialog that shows progress goes by itself
                seen.append(box.text())
                self.shot("dialog")
                box.accept()

        timer = self.qt.QTimer()
        timer.setInterval(200)
        timer.timeout.connect(answer)
        timer.start()
        action()
        self.pump(0.3)
        timer.stop()
        return seen[0] if seen else ""

    def shot(self, name):
        """Let the window be drawn, and take a picture of it where pictures are wanted."""
        self.pump(0.1)
        if SHOTS:
            self.capture(Path(SHOTS) / f"{name}-{self.theme}.png")

    def capture(self, path):
        """Take a picture of the whole screen, which has the 3D view in it."""
        path.parent.mkdir(parents=True, exist_ok=True)
        self.pump(0.3)
        try:
            subprocess.run(["import", "-window", "root", str(path)], check=True, timeout=30, stdin=subprocess.DEVNULL)
        except (OSError, subprocess.SubprocessError):  # no tool for the whole screen here: the window without its view
            self.window.grab().save(str(path))

    def red_points(self, document, folder):
        """How many points of a picture of the 3D view are red, as things that meet are."""
        import numpy as np
        from PySide import QtGui

        path = str(folder / "view.png")
        self.gui.getDocument(document.Name).ActiveView.saveImage(path, 700, 450, "White")
        image = QtGui.QImage(path).convertToFormat(QtGui.QImage.Format_RGBA8888)
        points = np.frombuffer(image.constBits(), np.uint8).reshape(-1, 4)  # one by one they took a second
        red, other = points[:, 0], points[:, 1:3].max(axis=1)
        return int(((red > 90) & (red > 2.5 * other)).sum())

    def played_at(self, form, share):
        """Drag the slider of what is played to a share of its way; what is told of that place."""
        form.slide.setValue(round(share * form.slide.maximum()))
        self.pump(0.05)
        return form.pointer.text()

    def told_at(self, form, looks):
        """What is told along the way of the slider, at so many places and its end: at once, and nothing is drawn."""
        told = []
        for k in range(looks + 1):
            form.slide.setValue(round(k / looks * form.slide.maximum()))
            told.append(form.pointer.text())
        return told

    def index_moves(self, form, looks=60):
        """Shares of the way of the slider at which there is an index move."""
        return [k / looks for k, text in enumerate(self.told_at(form, looks)) if "ndex move to" in text]

    def open(self, path):
        """Open a STEP file in a document of its own; its part."""
        import FreeCAD
        import Import

        document = FreeCAD.newDocument(Path(path).stem)
        Import.insert(str(path), document.Name)
        view = self.gui.getDocument(document.Name).ActiveView
        view.viewIsometric()
        view.fitAll()
        self.pump(0.2)
        return next(thing for thing in document.Objects if hasattr(thing, "Shape") and thing.Shape.Faces)

    def start(self, thing=None, *faces):
        """Select faces and run Plan Orientations; the panel's form."""
        self.gui.Selection.clearSelection()
        for face in faces:
            self.gui.Selection.addSelection(thing.Document.Name, thing.Name, face)
        if thing is not None and not faces:
            self.gui.Selection.addSelection(thing.Document.Name, thing.Name)
        before = len(self.reported())
        self.gui.runCommand("ToolAxis_PlanOrientations")  # what goes wrong in a command stands in the report view alone
        self.wait(lambda: self.form("ToolAxisPlan") or self.errors or self.reported()[before:], "the panel opens")
        assert not self.errors and not self.reported()[before:], self.errors or self.reported()[before:]
        return self.form("ToolAxisPlan")

    def operation_in(self, document):
        """The first operation of a document, or None."""
        from freecad.toolaxis.document.kinds import is_operation

        return next(filter(is_operation, document.Objects), None)

    def outline(self, table, rows):
        """Write the rows of a shank or holder, diameter and height in mm."""
        table.setRowCount(len(rows))
        for i, row in enumerate(rows):
            for k, value in enumerate(row):
                table.model().setData(table.model().index(i, k), f"{value} mm")

    def text(self, view, row, column=0):
        """What an entry of a table or a list says."""
        return view.model().index(row, column).data()

    def around(self, widget):
        """The area that a widget, or a task panel, scrolls in, or None."""
        above = widget.parentWidget()
        while above is not None and not self.is_a(above, self.widgets.QScrollArea):
            self.held.append(above)  # in FreeCAD 1.0 those of what is in a widget end with Python's object of it
            above = above.parentWidget()
        self.held.append(above)
        return above

    def down(self, widget):
        """Scroll a page of a task panel, or the panel, until a widget is in sight."""
        above = self.around(widget)
        if above is not None:
            above.ensureWidgetVisible(widget, 0, 400)
            self.pump(0.1)

    def computed(self, form):
        """Press Compute and wait."""
        self.press(form.compute)
        self.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the computation ends")

    def reported(self):
        """What stands in the report view that looks like an error, each with the lines after it."""
        lines = [line for report in self.reports for line in report.toPlainText().splitlines()]
        bad = [k for k, line in enumerate(lines) if any(word in line for word in ("Traceback", "Error", "xception"))]
        return ["\n".join(lines[k:k + 12]) for k in bad]

    def kept(self):
        """What is still there of panels and windows of pictures that are closed: only Python holds it, without need."""
        self.made = [known for known in self.made if known() is not None]
        return [type(known()).__name__ for known in self.made]

    def tidy(self):
        """Close the panel and all documents, unsaved as they are."""
        import FreeCAD
        from freecad.toolaxis.services.background import clear_away

        if self.gui.Control.activeDialog():
            self.gui.Control.closeDialog()
        self.pump(0.1)
        for name in list(FreeCAD.listDocuments()):
            FreeCAD.closeDocument(name)
        self.pump(0.1)
        self.held.clear()  # else they would be handed out for widgets that lie at their addresses later
        clear_away()


@pytest.fixture(scope="session")
def _desk(request):
    pytest.importorskip("FreeCAD")
    import FreeCAD

    if not FreeCAD.GuiUp:
        request.config.pluginmanager.register(Leaver(), "toolaxis-leaver")
    dark = any("dark" in item.path.name for item in request.session.items)
    theme = "dark" if dark else "light"
    if os.environ.get("FREECAD_USER_HOME"):  # a profile made for the tests; somebody's own is left as it is
        set_theme(f"FreeCAD {theme.title()}")
        # a view that fits everything at once: the steps of its way there took a fifth of the time of most tests
        FreeCAD.ParamGet("User parameter:BaseApp/Preferences/View").SetBool("UseNavigationAnimations", False)
    return Desk(theme)


@pytest.fixture
def desk(_desk):
    """The desk; afterwards nothing may stand on the report view, no exception may have been raised in a slot, and
    panels that were closed must be gone."""
    _desk.errors.clear()
    before = len(_desk.reported())
    yield _desk
    _desk.tidy()
    assert not _desk.errors, _desk.errors
    assert not _desk.reported()[before:], _desk.reported()[before:]
    assert not _desk.kept(), _desk.kept()


@pytest.fixture
def german(desk):
    """FreeCAD in German, and in English again afterwards."""
    desk.gui.setLocale("de")
    desk.pump(0.3)
    yield desk
    desk.tidy()
    desk.gui.setLocale("en")
    desk.pump(0.3)


@pytest.fixture(scope="session")
def part_file(tmp_path_factory, _desk):
    """A STEP file of a small block with a wavy top, Face-numbers as FreeCAD reads them."""
    from math import cos, sin

    import FreeCAD
    import Part

    points = [[FreeCAD.Vector(x, y, 10 + 1.5 * sin(x / 9) * cos(y / 8)) for y in range(0, 17, 4)]
              for x in range(0, 21, 5)]
    surface = Part.BSplineSurface()
    surface.interpolate(points)
    wavy = surface.toShape()
    solid = wavy.extrude(FreeCAD.Vector(0, 0, -20)).common(Part.makeBox(60, 60, 40, FreeCAD.Vector(-20, -20, 0)))
    path = tmp_path_factory.mktemp("step") / "wavy.step"
    solid.exportStep(str(path))
    return path


@pytest.fixture
def wavy(desk, part_file):
    """The small block, opened, with the name of its wavy face."""
    part = desk.open(part_file)
    kinds = [type(face.Surface).__name__ for face in part.Shape.Faces]
    return part, f"Face{kinds.index('BSplineSurface') + 1}"


class Plans:
    """Plans that were made already, here or in another FreeCAD of the same run of tests."""

    def __init__(self, folder):
        self.folder, self.made = folder, {}

    def take(self, asked, compute, progress):
        """The plan for what is asked, read where it was made already, else computed by one process and kept."""
        if asked not in self.made:
            self.made[asked] = self._shared(asked, compute, progress) if self.folder else compute(progress)
        return self.made[asked]

    def _shared(self, asked, compute, progress):
        told = f"{sys.version} {asked}"
        path = self.folder / hashlib.sha256(told.encode()).hexdigest()
        with open(f"{path}.lock", "wb") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if path.exists():
                return pickle.loads(path.read_bytes())
            plan = compute(progress)
            path.write_bytes(pickle.dumps(plan))
            return plan


@pytest.fixture(scope="session")
def _recalling(_desk):
    """Where this is entered, the same inputs for the same shapes are computed once in a run of the tests."""
    from freecad.toolaxis.services import api

    shared = os.environ.get("TOOLAXIS_TESTS_SHARED")
    if shared:
        (ROOT / shared / "plans").mkdir(exist_ok=True)
    plans, task = Plans(ROOT / shared / "plans" if shared else None), api.task

    def recalled(inputs):
        compute = task(inputs)
        shapes = [thing.Shape.exportBrepToString() for thing in (*inputs.things, *inputs.obstacles)]
        key = repr((replace(inputs, faces=(), obstacles=()), [name for _, name in inputs.faces], shapes))
        return lambda progress: plans.take(key, compute, progress)

    @contextmanager
    def recalling():
        api.task = recalled
        try:
            yield
        finally:
            api.task = task

    return recalling


@pytest.fixture
def remembered(_recalling):
    """For tests of what follows on planning: a plan that was made already is taken again."""
    with _recalling():
        yield


@pytest.fixture(scope="session")
def _asked():
    """What the panel asked for the first operation of a session."""
    return []


@pytest.fixture
def operation(desk, wavy, _recalling, _asked):
    """An operation in a document, as the planning panel leaves it: by the panel once, then as its OK puts it there."""
    from freecad.toolaxis.document.inputs import inputs_of
    from freecad.toolaxis.services import api
    from freecad.toolaxis.services.write_results import apply

    from toolaxis.progress import NO_PROGRESS

    part, face = wavy
    with _recalling():
        if _asked:
            inputs = replace(_asked[0], faces=((part, face),))
            apply(part.Document, inputs, api.task(inputs)(NO_PROGRESS))
            desk.pump(0.1)
            return desk.operation_in(part.Document)
        form = desk.start(part, face)
        desk.type(form.scallop, "0.05 mm")
        desk.computed(form)
        desk.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    made = desk.operation_in(part.Document)
    _asked.append(inputs_of(made))
    return made


@pytest.fixture
def leaning(desk, operation, _recalling):
    """A second operation, on a turned copy of the part, so that the machine has to index."""
    import FreeCAD
    from freecad.toolaxis.document.inputs import inputs_of
    from freecad.toolaxis.services import api
    from freecad.toolaxis.services.write_results import apply

    from toolaxis.progress import NO_PROGRESS

    document, part = operation.Document, operation.Faces[0][0]
    other = document.addObject("Part::Feature", "Other")
    other.Shape = part.Shape.copy()
    other.Placement = FreeCAD.Placement(FreeCAD.Vector(0, 40, 0), FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), 25))
    document.recompute()
    inputs = inputs_of(operation)
    inputs = replace(inputs, faces=((other, inputs.faces[0][1]),), limits=f"cone:0,{-0.42},{0.9},2")
    with _recalling():
        made = apply(document, inputs, api.task(inputs)(NO_PROGRESS))[0]
    assert made.Motions, made.Reasons
    return operation, made


@pytest.fixture
def form(desk, wavy):
    """The panel for the wavy face, with a scallop height that is quickly computed."""
    part, face = wavy
    form = desk.start(part, face)
    form.tabs.setCurrentWidget(form.jobTab)
    desk.type(form.scallop, "0.05 mm")
    return form
