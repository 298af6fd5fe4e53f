"""From opening somebody else's part to a first result, by mouse alone: three clicks, and nothing is typed."""

import os
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
PREPARED = ROOT / os.environ.get("TOOLAXIS_PREPARED", "out/freecad/foreign_parts")
#: Unit system, language and size of the window that each part is walked through with.
WALKS = {"loft": ("ImperialDecimal", "de", (1100, 700)), "linkrods": ("Internal", "en", (1100, 700)),
         "kj66_impeller": ("Internal", "de", (1400, 900))}
#: Unit systems by number, for a FreeCAD that lists their descriptions.
NUMBERS = {"ImperialDecimal": 3, "Internal": 0}
#: How far in a row of the tree the name begins, after the icons, pixels: beside it a click selects nothing.
_TO_NAME = 55
#: Where the loft's body stands.
PLACE = (120.0, -60.0, 35.0)

pytestmark = pytest.mark.long


def loft(desk):
    """A body with a loft through three turned ellipses, moved and turned by its placement."""
    import FreeCAD
    import Part

    document = FreeCAD.newDocument("Loft")
    body, sections = document.addObject("PartDesign::Body", "Body"), []
    for k, (long, short, turn) in enumerate(((24, 14, 0), (20, 12, 12), (14, 9, 25))):
        sketch = body.newObject("Sketcher::SketchObject", f"Sketch{k}")
        sketch.Placement = FreeCAD.Placement(FreeCAD.Vector(2 * k, 0, 18 * k),
                                             FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), turn))
        sketch.addGeometry(Part.Ellipse(FreeCAD.Vector(0, 0, 0), long, short), False)
        sections.append(sketch)
    document.recompute()
    feature = body.newObject("PartDesign::AdditiveLoft", "Loft")
    feature.Profile, feature.Sections = sections[0], sections[1:]
    body.Placement = FreeCAD.Placement(FreeCAD.Vector(*PLACE), FreeCAD.Rotation(FreeCAD.Vector(1, 1, 0), 25))
    document.recompute()
    desk.gui.activateWorkbench("ToolAxisWorkbench")  # what is made in PartDesign may have changed to it
    view = desk.gui.getDocument(document.Name).ActiveView
    view.viewIsometric()
    view.fitAll()
    desk.pump(0.3)
    return body


def opened(desk, name):
    """What a user selects of a part."""
    if name == "loft":
        return loft(desk)
    if not (PREPARED / f"{name}.step").exists():
        pytest.skip(f"{name}.step is one of the parts by others: set TOOLAXIS_SHARED")
    document = desk.open(PREPARED / f"{name}.step").Document
    return next(thing for thing in document.RootObjects if thing.TypeId in ("App::Part", "Part::Feature"))


def set_units(schema):
    """Choose a unit system; a new document brings its own."""
    import FreeCAD

    names = FreeCAD.Units.listSchemas()
    FreeCAD.Units.setSchema(names.index(schema) if schema in names else NUMBERS[schema])


@pytest.fixture(params=WALKS)
def walk(desk, request):
    """The name of a part; language and window are as it asks for."""
    import FreeCAD

    _, language, size = WALKS[request.param]
    before, usual = FreeCAD.Units.getSchema(), desk.window.size()
    desk.gui.setLocale(language)
    desk.window.resize(*size)
    desk.pump(0.5)
    yield request.param
    desk.tidy()
    FreeCAD.Units.setSchema(before)
    desk.gui.setLocale("en")
    desk.window.resize(usual)
    desk.pump(0.3)


class Clicker:
    """Clicks by the mouse, counted; seconds are those since the last step."""

    def __init__(self, desk, name):
        self.desk, self.name, self.clicks, self.begun = desk, name, 0, time.perf_counter()

    def seen(self, what):
        """Take a picture, and tell how many clicks led there, and how long it took."""
        now = time.perf_counter()
        sys.__stdout__.write(f"{self.name} {what}: {self.clicks} clicks, {now - self.begun:.1f} s\n")
        sys.__stdout__.flush()
        self.desk.shot(f"98-{self.name}-{what}")
        self.begun = time.perf_counter()

    def select_in_tree(self, thing):
        """Click an object in the tree, when it is drawn there."""
        desk = self.desk
        desk.pump(1.0)
        trees = desk.children(desk.widgets.QTreeWidget)
        tree = next(one for one in trees if one.metaObject().className() == "Gui::TreeWidget")
        model, match = tree.model(), desk.qt.Qt.MatchRecursive | desk.qt.Qt.MatchExactly
        found = model.match(model.index(0, 0), desk.qt.Qt.DisplayRole, thing.Label, -1, match)
        index = next(one for one in found if one.parent().isValid())  # a document is at the top
        room = tree.viewport().rect()
        desk.click(tree.viewport(), room.bottomRight() - desk.qt.QPoint(5, 5))  # a tree that is new takes none at first
        row = tree.visualRect(index)
        desk.click(tree.viewport(), desk.qt.QPoint(row.left() + _TO_NAME, row.center().y()))
        self.clicks += 1
        desk.wait(lambda: desk.gui.Selection.getSelectionEx(), f"{thing.Label} is selected", 20.0)
        assert [one.Object for one in desk.gui.Selection.getSelectionEx()] == [thing]

    def run(self, command, name):
        """Click a command in the toolbar; the panel of that name."""
        desk = self.desk
        buttons = desk.children(desk.widgets.QToolButton)
        button = next(one for one in buttons if one.isVisible() and one.defaultAction() is not None
                      and one.defaultAction().objectName() == command)
        desk.press(button)
        self.clicks += 1
        desk.wait(lambda: desk.form(name) or desk.errors, "the panel opens")
        return desk.form(name)

    def press(self, button):
        """Click a button."""
        self.desk.press(button)
        self.clicks += 1


def test_three_clicks_lead_from_a_part_to_its_axes(desk, walk):
    part = opened(desk, walk)
    set_units(WALKS[walk][0])
    mouse = Clicker(desk, walk)
    mouse.select_in_tree(part)
    form = mouse.run("ToolAxis_PlanOrientations", "ToolAxisPlan")
    assert form.compute.isEnabled(), form.message.text()
    assert form.rack.currentIndex() == 1, "a whole part is machined with the general rack"
    assert ("check the unit" in form.message.text()) == (walk == "linkrods")
    assert (" in" in desk.shown(form.scallop)) == (WALKS[walk][0] == "ImperialDecimal")
    mouse.seen("panel")
    panel = desk.opened[-1]()
    mouse.press(form.compute)
    assert mouse.clicks == 3
    desk.wait(lambda: not panel.growth.empty or not form.stop.isEnabled(), "what tools reach is shown")
    mouse.seen("map")
    if walk != "loft":  # what is there is looked at in other tests
        return
    desk.wait(lambda: form.compute.isEnabled() and not form.stop.isEnabled(), "the plan is made", 1800.0)
    assert form.message.text().startswith("100.00 % von"), form.message.text()
    assert form.operation.itemText(0).startswith("Fläche "), form.operation.itemText(0)
    mouse.seen("result")
    mouse.press(desk.standard_button("Ok"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    mouse.seen("tree")
    made = desk.operation_in(part.Document)
    box, frame = part.Shape.BoundBox, next(one for one in made.Group if "CoordinateSystem" in one.TypeId)
    assert box.isInside(frame.getGlobalPlacement().Base) or frame.getGlobalPlacement().Base.isEqual(
        part.Placement.Base, 1e-6), "work coordinates go with the body"
