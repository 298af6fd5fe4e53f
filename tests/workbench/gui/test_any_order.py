"""Whatever is typed and pressed in whatever order: no exception, nothing on the report view, nothing left over.

The steps are drawn from a fixed seed; what failed once stands with its seed in SEEDS.
"""

import random

import pytest

#: What people type by mistake, and what they do not.
TEXTS = ("", "abc", "-5", "0", "1e400", "nan", "inf", "-inf", "1e-300", "99999999999", "3 s", "5 kg", "1,5", "0.25 in",
         "12 mm", "0.3 mm", "1/0", "=1+", "1 mm 2", "%", "'", "10 deg", "1000 mm/min", "\u00bd", " ", "--1", "2+2")
BUTTONS = ("compute", "stop", "addFaces", "removeFaces", "holderAdd", "holderRemove", "shankAdd", "shankRemove", "lock",
           "best", "turnFeed", "lockAxis", "lockFeed", "blades", "compare")
COMBOS = ("strategy", "regions", "orientations", "method", "objective", "direction", "passes", "tool", "kind", "limits",
          "operation")
NUMBERS = ("roughness", "regionsNumber", "orientationsNumber", "spindle", "limitX", "limitY", "limitZ")
QUANTITIES = ("scallop", "tolerance", "allowance", "feedrate", "diameter", "corner", "taper", "stickout", "cone",
              "tiltLow", "tiltHigh", "turnLow", "turnHigh")
SEEDS = (1, 2)


class Hand:
    """Somebody at the planning panel who does not know what he does."""

    def __init__(self, desk, document, names, seed):
        self.desk, self.document, self.names, self.random, self.done = desk, document, names, random.Random(seed), []

    @property
    def part(self):
        """The part, None while it is deleted."""
        return self.document.getObject(self.names[0])

    def step(self):
        """Do one thing, if it can be done now."""
        name = self.random.choice(("typed", "typed", "chosen", "chosen", "pressed", "pressed", "pressed", "tab",
                                   "picked", "marked", "cell", "mapped", "undone", "moved", "deleted"))
        self.done.append((name, getattr(self, name)()))
        self.desk.pump(self.random.choice((0.0, 0.0, 0.01, 0.1)))

    @property
    def form(self):
        return self.desk.form("ToolAxisPlan")

    def widget(self, name):
        return self.form.findChild(self.desk.widgets.QWidget, name)

    def enter(self, line, text):
        """Type a text in the place of another, and leave the field."""
        line.selectAll()
        for letter in text or "\b":
            self.desk._key(line, self.desk.qt.Qt.Key_Backspace if letter == "\b" else 0, letter)
        self.desk._key(line, self.desk.qt.Qt.Key_Return, "\r")

    def typed(self):
        name, text = self.random.choice((*QUANTITIES, *NUMBERS)), self.random.choice(TEXTS)
        widget = self.widget(name)
        if widget.isEnabled():
            self.enter(widget.findChild(self.desk.widgets.QLineEdit), text)
        return name, text

    def chosen(self):
        combo = self.widget(self.random.choice(COMBOS))
        index = self.random.randrange(max(combo.count(), 1))
        if combo.isEnabled() and combo.count():
            combo.setCurrentIndex(index)
            combo.activated.emit(index)
        return combo.objectName(), index

    def pressed(self):
        button = self.widget(self.random.choice(BUTTONS))
        if button.isEnabled() and not button.isHidden():
            button.click()
        return button.objectName()

    def tab(self):
        self.form.tabs.setCurrentIndex(self.random.randrange(self.form.tabs.count()))

    def picked(self):
        """Select something in the 3D view."""
        names = ("", "Face1", "Face2", "Edge1", "Vertex1")
        if self.random.random() < 0.5:
            self.desk.gui.Selection.clearSelection()
        if self.part is not None:
            self.desk.gui.Selection.addSelection(self.document.Name, self.part.Name, self.random.choice(names))

    def marked(self):
        """Mark an entry of a list, or tick it."""
        self.widget("faces").setCurrentRow(0)
        bodies, role = self.widget("avoid").model(), self.desk.qt.Qt.CheckStateRole
        if bodies.index(0, 0).data(role) is not None:
            bodies.setData(bodies.index(0, 0), self.random.choice((2, 0)), role)

    def cell(self):
        """Write into a cell of an outline."""
        table = self.widget(self.random.choice(("shank", "holder")))
        place = table.model().index(self.random.randrange(max(table.rowCount(), 1)), self.random.randrange(2))
        text = self.random.choice(TEXTS)
        if place.isValid() and table.isEnabled():
            table.model().setData(place, text)
        return table.objectName(), text

    def mapped(self):
        """Click on the map."""
        chart = self.widget("axisMap")
        if chart.isEnabled() and chart.picture is not None:
            x, y = (self.random.uniform(0, size) for size in (chart.width(), chart.height()))
            self.desk.click(chart, self.desk.qt.QPointF(x, y))

    def undone(self):
        (self.document.undo if self.random.random() < 0.5 else self.document.redo)()

    def moved(self):
        if self.part is not None:
            self.document.openTransaction("Move")
            place = self.part.Placement
            place.Base.x += 1.0
            self.part.Placement = place
            self.document.commitTransaction()

    def deleted(self):
        """Delete the part or the clamp, and take that back, now or later."""
        thing = self.document.getObject(self.random.choice(self.names))
        if thing is not None and self.random.random() < 0.3:
            self.document.openTransaction("Delete")
            self.document.removeObject(thing.Name)
            self.document.commitTransaction()
            if self.random.random() < 0.7:
                self.desk.pump(0.02)
                self.document.undo()


def play(desk, part, face, seed, steps):
    import FreeCAD

    document = part.Document
    document.UndoMode = 1
    clamp = document.addObject("Part::Box", "Clamp")
    clamp.Placement.Base = FreeCAD.Vector(40, 0, 0)
    document.recompute()
    document.clearUndos()
    names = sorted(one.Name for one in document.Objects)
    desk.start(part, face)
    hand = Hand(desk, document, (part.Name, clamp.Name), seed)
    try:
        for _ in range(steps):
            hand.step()
            assert not desk.errors, desk.errors
            assert hand.form is not None, "the panel is there"
    except BaseException:
        print("\n".join(map(str, hand.done[-12:])))
        raise
    if hand.form.stop.isEnabled():
        desk.press(hand.form.stop)
    desk.wait(lambda: not hand.form.stop.isEnabled(), "it stops")
    assert {one.Name for one in document.Objects} <= set(names), "nothing is put into the document without OK"
    desk.press(desk.standard_button("Cancel"))
    desk.wait(lambda: desk.form("ToolAxisPlan") is None, "the panel closes")
    while document.UndoCount:
        document.undo()
    assert sorted(one.Name for one in document.Objects) == names


@pytest.mark.parametrize("seed", SEEDS)
def test_a_few_steps(desk, wavy, seed):
    play(desk, *wavy, seed, 80)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(100, 112))
def test_many_steps(desk, wavy, seed):
    play(desk, *wavy, seed, 400)
