"""What is selected is not what is needed: a clear message in the panel or a dialog, nothing on the report view."""

import pytest


def add(document, kind):
    """An object that cannot be planned, by its kind."""
    import FreeCAD
    import Part

    if kind == "mesh":
        import Mesh

        thing = document.addObject("Mesh::Feature", "Mesh")
        thing.Mesh = Mesh.createBox(10, 10, 10)
    elif kind == "sketch":
        thing = document.addObject("Sketcher::SketchObject", "Sketch")
        thing.addGeometry(Part.LineSegment(FreeCAD.Vector(0, 0, 0), FreeCAD.Vector(10, 0, 0)))
    elif kind == "wire":
        thing = document.addObject("Part::Feature", "Wire")
        thing.Shape = Part.makePolygon([FreeCAD.Vector(0, 0, 0), FreeCAD.Vector(10, 0, 0), FreeCAD.Vector(10, 9, 0)])
    elif kind == "empty":
        thing = document.addObject("Part::Feature", "Empty")
    elif kind == "group":
        thing = document.addObject("App::DocumentObjectGroup", "Group")
    else:
        thing = document.addObject("Part::Box", "Box")
    document.recompute()
    return thing


@pytest.mark.parametrize(("kind", "words"), [
    ("mesh", "is a mesh"), ("sketch", "is a sketch"), ("wire", "has no faces"), ("empty", "has no shape"),
    ("group", "has no shape"), ("box", "one by one")])
def test_what_has_no_sculptured_face(desk, kind, words):
    import FreeCAD

    document = FreeCAD.newDocument("Bad")
    thing = add(document, kind)
    desk.pump(0.1)
    form = desk.start(thing)
    assert words in form.message.text() and not form.compute.isEnabled()
    if kind == "mesh":
        desk.shot("20-mesh")


def test_nothing_selected(desk):
    import FreeCAD

    FreeCAD.newDocument("Empty")
    desk.pump(0.1)
    form = desk.start()
    assert "Select" in form.message.text() and not form.compute.isEnabled()
    desk.shot("21-nothing")
    desk.press(form.addFaces)
    assert "Nothing is selected" in form.message.text()


def test_edges_selected(desk, wavy):
    form = desk.start(wavy[0], "Edge1", "Vertex2")
    assert "Edge1" in form.message.text() and "is an edge" in form.message.text()
    assert not form.compute.isEnabled()


def test_a_body_stands_for_its_sculptured_faces(desk, wavy):
    form = desk.start(wavy[0])
    names = [desk.text(form.faces, k) for k in range(form.faces.count())]
    assert any(wavy[1] in name for name in names) and form.compute.isEnabled()
    assert form.rack.currentText() == "general rack"
    assert len(names) < len(wavy[0].Shape.Faces)


def test_faces_are_added_once_and_removed(desk, wavy):
    part, face = wavy
    form = desk.start(part, face)
    for _ in range(2):
        desk.gui.Selection.clearSelection()
        desk.gui.Selection.addSelection(part.Document.Name, part.Name, "Face1")
        desk.gui.Selection.addSelection(part.Document.Name, part.Name, face)
        desk.press(form.addFaces)
    assert form.faces.count() == len({"Face1", face})
    form.faces.selectAll()
    desk.press(form.removeFaces)
    assert form.faces.count() == 0 and not form.compute.isEnabled()


def test_no_operation_to_verify_or_recompute(desk, wavy):
    for command in ("ToolAxis_Verify", "ToolAxis_Recompute"):
        text = desk.dialog_text(lambda command=command: desk.gui.runCommand(command))
        assert "Plan Orientations first" in text


def test_commands_are_locked_without_a_document_and_beside_another_panel(desk, part_file):
    action = desk.gui.Command.get("ToolAxis_PlanOrientations")
    assert not action.isActive()
    part = desk.open(part_file)
    assert action.isActive()
    desk.start(part, "Face1")
    assert not action.isActive()


def test_two_documents(desk, part_file):
    first, second = desk.open(part_file), desk.open(part_file)
    assert first.Document.Name != second.Document.Name
    form = desk.start(second, "Face1")
    assert form.faces.count() == 1
    import FreeCAD

    FreeCAD.closeDocument(first.Document.Name)
    desk.pump(0.2)
    assert desk.form("ToolAxisPlan") is form, "the other document does not matter"


@pytest.mark.parametrize(("radius", "told"), [(2, "Ball is only 6.9 mm across: check the unit of"),
                                              (4000, "Ball is 138"), (20, "Press Compute")])
def test_a_part_of_another_unit_is_told_before_it_is_computed(desk, radius, told):
    import FreeCAD

    document = FreeCAD.newDocument("Ball")
    ball = document.addObject("Part::Sphere", "Ball")
    ball.Radius = radius
    document.recompute()
    form = desk.start(ball)
    assert form.message.text().startswith(told) and form.compute.isEnabled(), form.message.text()


def test_faces_in_containers_links_and_bodies_keep_what_places_them(desk, wavy):
    import FreeCAD
    from freecad.toolaxis.gui.widgets.quantity import area_text

    part, face = wavy
    document = part.Document
    holder = document.addObject("App::Part", "Holder")
    holder.Placement.Base = FreeCAD.Vector(0, 0, 50)
    box = document.addObject("Part::Cylinder", "Round")
    holder.addObject(box)
    link = document.addObject("App::Link", "Again")
    link.LinkedObject = holder
    link.Placement.Base = FreeCAD.Vector(60, 0, 0)
    document.recompute()
    desk.gui.Selection.clearSelection()
    for thing, name in ((holder, "Round.Face1"), (link, "Round.Face1"), (part, face)):
        desk.gui.Selection.addSelection(document.Name, thing.Name, name)
    desk.gui.runCommand("ToolAxis_PlanOrientations")
    desk.wait(lambda: desk.form("ToolAxisPlan") is not None, "the panel opens")
    form = desk.form("ToolAxisPlan")
    texts = {desk.text(form.faces, k) for k in range(form.faces.count())}
    assert texts == {f"Face1, {area_text(box.Shape.Face1.Area)}, {box.Label}",
                     f"Round.Face1, {area_text(box.Shape.Face1.Area)}, {link.Label}",
                     f"{face}, {area_text(part.Shape.getElement(face).Area)}, {part.Label}"}, texts
    assert form.compute.isEnabled(), form.message.text()


def test_tools_of_a_cam_job_are_offered_and_other_bodies_can_be_avoided(desk, wavy):
    import FreeCAD

    part, face = wavy
    document = part.Document
    clamp = document.addObject("Part::Box", "Clamp")
    clamp.Placement.Base = FreeCAD.Vector(40, 0, 0)
    document.recompute()
    cam = pytest.importorskip("Path.Main.Job")
    cam.Create("Job", [part], None)
    document.recompute()
    form = desk.start(part, face)
    names = [form.tool.itemText(k) for k in range(form.tool.count())]
    assert len(names) > 1, names
    form.tabs.setCurrentWidget(form.toolTab)
    form.tool.setCurrentIndex(1)
    form.tool.activated.emit(1)
    desk.shot("22-cam-tool")
    controller = next(thing for thing in document.Objects if thing.Label == names[1])
    assert float(desk.shown(form.diameter).split()[0]) == pytest.approx(float(controller.Tool.Diameter), abs=5e-4)
    bodies = [desk.text(form.avoid, k) for k in range(form.avoid.count())]
    assert bodies == ["Clamp"]


def test_faces_of_a_large_list_are_found_and_taken_off(desk, wavy):
    """Filtered by name and by area; what is not shown is not removed."""
    part = wavy[0]
    count = len(part.Shape.Faces)
    form = desk.start(part, *[f"Face{k}" for k in range(1, count + 1)])
    assert form.facesTold.toolTip() == f"{count} of {part.Label}"
    areas = sorted(face.Area for face in part.Shape.Faces)
    limit = (areas[0] + areas[-1]) / 2
    small = sum(area < limit for area in areas)

    def seen():
        return sum(not form.faces.isRowHidden(row) for row in range(form.faces.count()))

    desk.type(form.facesFilter, "FACE1")
    assert seen() == sum(str(k).startswith("1") for k in range(1, count + 1)) < count
    form.faces.selectAll()
    desk.type(form.facesFilter, "nowhere")
    desk.press(form.removeFaces)
    assert not seen() and form.faces.count() == count, "what is not seen is not removed"
    desk.type(form.facesFilter, f"< {limit:.3f}")
    assert seen() == small
    form.faces.selectAll()
    desk.press(form.removeFaces)
    assert form.facesTold.toolTip() == f"{count - small} of {part.Label}"
    form.facesFilter.clear()
    assert seen() == form.faces.count() == count - small
    desk.shot("98-faces")
