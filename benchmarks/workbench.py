"""The blisk in the real FreeCAD: time to plan, to put into the document, to save, open and turn; size and memory.

It needs a display, and runs in the FreeCAD that TOOLAXIS_FREECAD names, or where FreeCAD can be imported; for another
part there: `python3 -m benchmarks.workbench [PART.step [TOOL [SCALLOP [REGIONS]]]]`.
"""

import os
import pathlib
import tempfile
import time

from benchmarks._freecad import in_freecad

# `pathlib.Path` is written out: FreeCAD imports its module Path into the main one, in that name's place
ROOT = pathlib.Path(__file__).resolve().parents[1]
FRAMES = 60
SLENDER = {"stickout": 70.0, "holder": ((10, 0), (10, 40), (25, 40), (25, 80))}


def memory():
    """Resident memory of this process, MB."""
    for line in pathlib.Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1]) / 1024
    return float("nan")


def turned(document):
    """Frames a second while the view turns once."""
    import FreeCAD
    import FreeCADGui
    from PySide import QtWidgets

    view = FreeCADGui.getDocument(document.Name).ActiveView
    view.viewIsometric()
    view.fitAll()
    for _ in range(20):
        QtWidgets.QApplication.processEvents()
    begin = time.perf_counter()
    for k in range(FRAMES):
        view.setCameraOrientation(FreeCAD.Rotation(FreeCAD.Vector(0.3, 0.2, 1.0), 360 * k / FRAMES).Q)
        view.redraw()
        QtWidgets.QApplication.processEvents()
    return FRAMES / (time.perf_counter() - begin)


def measured(path, tool, scallop, regions):
    """Lines of the table: what, and a figure with its unit."""
    import FreeCAD
    import FreeCADGui
    import Import
    from freecad.toolaxis.document.inputs import JobInputs
    from freecad.toolaxis.document.kinds import is_operation
    from freecad.toolaxis.services import api
    from freecad.toolaxis.services.write_results import apply

    from toolaxis.progress import NO_PROGRESS

    FreeCADGui.showMainWindow()
    FreeCADGui.getMainWindow().setGeometry(0, 0, 1400, 900)
    FreeCADGui.activateWorkbench("ToolAxisWorkbench")
    document = FreeCAD.newDocument("Part")
    Import.insert(str(path), document.Name)
    part = next(thing for thing in document.Objects if hasattr(thing, "Shape") and thing.Shape.Faces)
    yield "turning, part alone", f"{turned(document):.1f} frames/s"
    yield "memory, part alone", f"{memory():.0f} MB"
    from freecad.toolaxis.document.read_shapes import sculptured

    faces = tuple((part, name) for name in sculptured(part))
    inputs = JobInputs(faces, tool, scallop=scallop, regions=regions, **SLENDER)
    begin = time.perf_counter()
    plan = api.task(inputs)(NO_PROGRESS)
    yield "to plan", f"{time.perf_counter() - begin:.1f} s"
    copies = {} if plan.blades is None else plan.blades.copies
    yield "operations, turned copies among them", f"{len(plan.operations)}, {len(copies)} ({plan.outcome})"
    begin = time.perf_counter()
    made = apply(document, inputs, plan)
    yield "to put into the document", f"{time.perf_counter() - begin:.1f} s"
    links = [thing for thing in document.Objects if thing.TypeId == "App::Link"]
    yield "operations, links, objects in all", f"{len(made)}, {len(links)}, {len(document.Objects)}"
    yield "turning", f"{turned(document):.1f} frames/s"
    yield "memory", f"{memory():.0f} MB"
    shots = os.environ.get("TOOLAXIS_SHOTS")
    if shots:
        file = str(pathlib.Path(shots) / f"{pathlib.Path(path).stem}.png")
        FreeCADGui.getDocument(document.Name).ActiveView.saveImage(file, 1400, 1000, "White")
    with tempfile.TemporaryDirectory() as folder:
        file = str(pathlib.Path(folder) / "Part.FCStd")
        begin = time.perf_counter()
        document.saveAs(file)
        yield "to save", f"{time.perf_counter() - begin:.2f} s"
        yield "size of the file", f"{pathlib.Path(file).stat().st_size / 2**20:.2f} MB"
        FreeCAD.closeDocument(document.Name)
        begin = time.perf_counter()
        again = FreeCAD.openDocument(file)
        yield "to open", f"{time.perf_counter() - begin:.2f} s"
        stale = sum(thing.Stale for thing in again.Objects if is_operation(thing))
        yield "operations out of date after opening", str(stale)
        begin = time.perf_counter()
        again.recompute(None, True)
        yield "to recompute all", f"{time.perf_counter() - begin:.2f} s"
        FreeCAD.closeDocument(again.Name)


def rows(arguments):
    """What is measured of the part that is named, or of the blisk."""
    given = dict(enumerate(arguments))
    regions = given.get(3, "1")
    return measured(given.get(0, ROOT / "examples" / "blisk.step"), given.get(1, "torus:10x1"),
                    float(given.get(2, 0.1)), int(regions) if regions.isdigit() else regions)


def main():
    """Print the table by whichever FreeCAD there is."""
    in_freecad("workbench", rows)


if __name__ == "__main__":
    main()
