"""The planning panel in the real FreeCAD: time to open it, to the first map, to try an axis, and the longest pauses.

It needs a display, and runs in the FreeCAD that TOOLAXIS_FREECAD names, or where FreeCAD can be imported; for another
face there: `python3 -m benchmarks.freecad_panel [PART.step [FACE [TOOL [SCALLOP]]]]`.
"""

import time
from pathlib import Path

from benchmarks._freecad import in_freecad

ROOT = Path(__file__).resolve().parents[1]


class Pauses:
    """Gaps between the ticks of a timer: how long the window did not answer."""

    def __init__(self, qt):
        self.gaps, self.last = [], time.perf_counter()
        self.timer = qt.QTimer()
        self.timer.setInterval(2)
        self.timer.timeout.connect(self.tick)
        self.timer.start()

    def tick(self):
        now = time.perf_counter()
        self.gaps.append(now - self.last)
        self.last = now

    def longest(self):
        """Longest gap since the last call, ms; empties the list."""
        gaps, self.gaps = self.gaps, []
        return 1000 * max(gaps, default=0.0)


def measured(path, face, tool, scallop):
    """Lines of the table."""
    import FreeCAD
    import FreeCADGui
    import Import
    from PySide import QtCore, QtWidgets

    def wait(condition, limit=300.0):
        end = time.monotonic() + limit
        while not condition():
            if time.monotonic() > end:
                raise TimeoutError(f"not done within {limit} s")
            QtWidgets.QApplication.processEvents(QtCore.QEventLoop.AllEvents, 5)

    FreeCADGui.showMainWindow()
    window = FreeCADGui.getMainWindow()
    window.setGeometry(0, 0, 1400, 900)
    FreeCADGui.activateWorkbench("ToolAxisWorkbench")
    document = FreeCAD.newDocument("Part")
    Import.insert(str(path), document.Name)
    FreeCADGui.getDocument(document.Name).ActiveView.fitAll()
    part = next(thing for thing in document.Objects if hasattr(thing, "Shape") and thing.Shape.Faces)
    FreeCADGui.Selection.addSelection(document.Name, part.Name, face)
    end = time.monotonic() + 1.0
    wait(lambda: time.monotonic() > end)
    begin = time.perf_counter()
    from freecad.toolaxis.gui.plan.panel import PlanPanel

    panel = PlanPanel(document)
    FreeCADGui.Control.showDialog(panel)
    yield "panel opened", time.perf_counter() - begin, 0.0
    panel.fields.set_tool(tool)
    panel.fields.quantities["scallop"].value = scallop
    end = time.monotonic() + 2.0
    wait(lambda: time.monotonic() > end)
    for name in ("the first time", "once more"):
        panel.view.clear()
        pauses, begin = Pauses(QtCore), time.perf_counter()
        panel.compute()
        wait(lambda: panel.view.map.picture is not None or panel.work is None)
        yield f"first map, {name}", time.perf_counter() - begin, pauses.longest()
        wait(lambda: panel.work is None)
        yield f"plan, {name}", time.perf_counter() - begin, pauses.longest()
    if panel.view.map.picture is not None:
        picture = panel.view.map.picture
        axis = picture.axes[picture.passes.argsort()[len(picture.passes) // 8]]
        pauses, begin = Pauses(QtCore), time.perf_counter()
        panel.view.try_axis(axis)
        wait(lambda: panel.view.work is None)
        yield "an axis tried", time.perf_counter() - begin, pauses.longest()
        begin = time.perf_counter()
        for k in range(50):
            panel.preview.move(k / 50)
        yield "tool moved, each", (time.perf_counter() - begin) / 50, 0.0
    yield panel.form.message.text(), 0.0, 0.0


def rows(arguments):
    """What is measured of the face that is named, or of the freeform part's."""
    given = dict(enumerate(arguments))
    for name, seconds, pause in measured(given.get(0, ROOT / "examples" / "freeform.step"), given.get(1, "Face1"),
                                         given.get(2, "torus:12x1"), float(given.get(3, 0.02))):
        yield name, f"{seconds:8.3f} s   longest pause {pause:6.0f} ms"


def main():
    """Print the table by whichever FreeCAD there is."""
    in_freecad("freecad_panel", rows)


if __name__ == "__main__":
    main()
