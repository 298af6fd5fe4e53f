"""CadQuery and build123d: faces that were picked in, planes, locations, edges, faces and trees out; both the same."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput

cq = pytest.importorskip("cadquery", reason="CadQuery is not installed")
bd = pytest.importorskip("build123d", reason="build123d is not installed")
txq = pytest.importorskip("toolaxis.cadquery")
txb = pytest.importorskip("toolaxis.build123d")


def vault():
    """A block of 24 x 12 mm with a curved top."""
    return (cq.Workplane("XZ").moveTo(0, 0).lineTo(24, 0).lineTo(24, 8).spline([(12, 10), (0, 8)]).close()
            .extrude(-12))


@pytest.fixture(scope="module")
def planned(quick):
    """The block, and its plan by the method that the module adds to Workplane."""
    block = vault()
    return block, block.faces(">Z").toolAxes(quick["tool"], quick["scallop"], method="normal", workers=1)


def ends(edge):
    """Start, end and length of an edge of either library."""
    both = [edge.startPoint().toTuple(), edge.endPoint().toTuple()] if isinstance(edge, cq.Edge) else [
        tuple(edge @ 0), tuple(edge @ 1)]
    return np.array(both), edge.Length() if isinstance(edge, cq.Edge) else edge.length


def cuts(operation):
    """Contact points of each uninterrupted cut of an operation, straight from its path."""
    path, found, last = operation.path, [], -2
    for k in np.flatnonzero(path.kind == Motion.CUT):
        if k != last + 1:
            found.append([path.cc[k - 1]])
        found[-1].append(path.cc[k])
        last = k
    return [np.array(one) for one in found]


def test_the_method_of_workplane_plans_the_picked_face_with_its_solid(planned):
    _, plan = planned
    assert len(plan.part.faces) == 6 and len(plan.operations) == 1
    assert plan.operations[0].face.number == plan.part.selected[0]
    assert plan.outcome == "complete"


def test_picked_faces_of_build123d_come_with_their_solid_however_they_are_given(quick):
    whole = bd.Solid(vault().val().wrapped)
    top = whole.faces().sort_by(bd.Axis.Z)[-1]
    for given in (top, [top], whole.faces().sort_by(bd.Axis.Z)[-1:]):
        part = ta.load(given)
        assert len(part.faces) == 6 and part.selected == ta.load(top).selected and len(part.selected) == 1
    with bd.BuildPart() as builder:
        bd.Box(10, 10, 4)
    assert len(ta.load(builder.faces().sort_by(bd.Axis.Z)[-1:]).faces) == 6
    plan = ta.plan(top, **quick)
    assert len(plan.operations) == 1 and plan.operations[0].face.box[1, 2] > 8


@pytest.mark.parametrize("door", [txq, txb], ids=["cadquery", "build123d"])
def test_planes_and_locations_are_the_work_coordinate_systems(divided, door):
    planes, places = door.planes(divided), door.locations(divided)
    assert list(planes) == list(places) == [op.name for op in divided.operations] and len(planes) == 2
    for op in divided.operations:
        plane = planes[op.name]
        if door is txq:
            rows = [plane.origin.toTuple(), plane.xDir.toTuple(), plane.yDir.toTuple(), plane.zDir.toTuple()]
            moved = [cq.Vertex.makeVertex(*point).moved(places[op.name]).toTuple() for point in np.eye(3)]
        else:
            rows = [tuple(row) for row in (plane.origin, plane.x_dir, plane.y_dir, plane.z_dir)]
            moved = [tuple((places[op.name] * bd.Location(tuple(point))).position) for point in np.eye(3)]
        frame = op.frame
        assert np.array(rows) == pytest.approx(np.array([frame.origin, frame.x, frame.y, frame.z]), abs=1e-9)
        assert np.array(rows)[3] == pytest.approx(op.orientation.axis, abs=1e-9)
        assert np.array(moved) == pytest.approx(frame.origin + np.array([frame.x, frame.y, frame.z]), abs=1e-9)


@pytest.mark.parametrize("door", [txq, txb], ids=["cadquery", "build123d"])
def test_passes_are_edges_along_the_contact_points(divided, door):
    for op in divided.operations:
        shape = door.passes(divided)[op.name]
        edges = shape.Edges() if door is txq else shape.edges()
        wanted = cuts(op)
        assert len(edges) == len(wanted) >= op.orientation.passes
        for edge, points in zip(edges, wanted, strict=True):
            both, length = ends(edge)
            assert both == pytest.approx(points[[0, -1]], abs=1e-7)
            assert length == pytest.approx(np.linalg.norm(np.diff(points, axis=0), axis=1).sum(), rel=1e-6)
        linked = door.passes(divided, links=True)[op.name]
        more = linked.Edges() if door is txq else linked.edges()
        whole = np.linalg.norm(np.diff(op.path.cc, axis=0), axis=1).sum()
        assert sum(ends(edge)[1] for edge in more) == pytest.approx(whole, rel=1e-6)


@pytest.mark.parametrize("door", [txq, txb], ids=["cadquery", "build123d"])
def test_sub_surfaces_are_faces_with_the_same_area_and_their_normal_out_of_the_material(divided, door):
    for op in divided.operations:
        face = door.sub_surfaces(divided)[op.name]
        area = face.Area() if door is txq else face.area
        assert area == pytest.approx(op.face.area, rel=1e-4)  # the kernel's quick rule is 3e-5 off here
        at = face.Center() if door is txq else face.center()
        normal = face.normalAt(at).toTuple() if door is txq else tuple(face.normal_at(at))
        assert np.dot(normal, op.face.normal(op.face.grid(3, 3)).mean(axis=0)) > 0.9


def test_an_assembly_has_a_child_for_each_operation_at_its_work_coordinate_system(planned, tmp_path):
    block, plan = planned
    made = txq.assembly(plan, block)
    (op,) = plan.operations
    assert [child.name for child in made.children] == ["part", f"{op.name}-surface", op.name]
    assert [child.name for child in made.children[2].children] == ["passes", "axis"]
    placed = made.children[2].children[0].obj.moved(made.children[2].loc)
    own = txq.passes(plan)[op.name]
    for ours, theirs in zip(placed.Edges(), own.Edges(), strict=True):
        assert ends(ours)[0] == pytest.approx(ends(theirs)[0], abs=1e-7)
    axis = ends(made.children[2].children[1].obj.moved(made.children[2].loc))[0]
    assert (axis[1] - axis[0]) / np.linalg.norm(axis[1] - axis[0]) == pytest.approx(op.orientation.axis, abs=1e-9)
    assert axis[0] == pytest.approx(op.frame.shown_at, abs=1e-9)
    made.export(str(tmp_path / "plan.step"))
    assert op.name in (tmp_path / "plan.step").read_text()


def test_a_compound_has_the_same_tree_and_leaves_the_part_where_it_is(divided, tmp_path):
    body = bd.Box(1, 2, 3)
    made = txb.compound(divided, body)
    names = [op.name for op in divided.operations]
    assert [child.label for child in made.children] == ["part", *(f"{name}-surface" for name in names), *names]
    assert body.parent is None and made.children[0].volume == pytest.approx(6.0)
    for name, child in zip(names, made.children[-2:], strict=True):
        inside = [edge.moved(child.location) for edge in child.children[0].edges()]  # children are placed by parents
        for ours, theirs in zip(inside, txb.passes(divided)[name].edges(), strict=True):
            assert ends(ours)[0] == pytest.approx(ends(theirs)[0], abs=1e-6)
    box, whole = child.bounding_box(), txb.passes(divided)[names[-1]].bounding_box()
    assert tuple(box.min) == pytest.approx(tuple(whole.min), abs=1e-6)
    assert bd.export_step(made, tmp_path / "plan.step")
    assert all(name in (tmp_path / "plan.step").read_text() for name in names)


def test_workplanes_go_on_from_a_plan(planned):
    block, plan = planned
    (op,) = plan.operations
    assert block.passEdges(plan).size() == block.passEdges(plan, 1).size() == len(cuts(op))
    at = block.workCoordinates(plan, op.name)
    assert at.plane.zDir.toTuple() == pytest.approx(tuple(op.orientation.axis), abs=1e-9)
    post = at.circle(1).extrude(5, combine=False)
    assert post.val().Volume() == pytest.approx(5 * np.pi, rel=1e-6)
    for wrong in ("op09-face9", 7):
        with pytest.raises(InvalidInput, match=f"operation {wrong!r} does not exist: the plan has 1"):
            block.workCoordinates(plan, wrong)
