"""Origin and stock in a document: in frames, CAM jobs, programs and setup sheets, and where they no longer hold."""

from dataclasses import replace

import numpy as np
import pytest
from FreeCAD import Placement, Rotation, Vector
from freecad.toolaxis.cam.jobs import make_jobs
from freecad.toolaxis.document.children import frame_of
from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.document.work_origin import box_around, origin_from_vertex, setup_of
from freecad.toolaxis.services.arguments import fields_of
from freecad.toolaxis.services.export import Wish, export
from freecad.toolaxis.services.macros import again_lines, plan_line
from freecad.toolaxis.services.write_results import apply

from toolaxis.errors import InvalidInput
from toolaxis.job.files.plan_folder import read_plan
from toolaxis.job.planning.edit_origin import with_origin

MARGINS = "1,2,3,4,0,5"
#: How the machine of the tests is turned: a part that stands askew in its document.
ASKEW = Placement(Vector(100, -20, 5), Rotation(Vector(0, 0, 1), 30))


def planned(document, parts, thing, **given):
    """An operation with origin and stock as the planning panel leaves it, without a search; its path."""
    inputs = parts.inputs_for((thing, parts.sculptured_name(thing)), **given)
    plan = parts.known_plan(replace(inputs, origin="", stock_box=""))
    assert plan.operations[0].done, plan.operations[0].orientation.reasons
    origin, datum = setup_of(inputs)
    made = with_origin(plan, origin, inputs.stock_box, datum)
    return apply(document, inputs, made)[0], made.operations[0]


def corners(thing):
    """Lower and upper corner of the stock with MARGINS around an object."""
    box = thing.Shape.optimalBoundingBox(False, False)
    return (np.array([box.XMin - 1, box.YMin - 3, box.ZMin]), np.array([box.XMax + 2, box.YMax + 4, box.ZMax + 5]))


def origin_of(operation):
    return np.array(tuple(frame_of(operation).Placement.Base))


@pytest.mark.parametrize("stand", [Placement(), ASKEW], ids=["straight", "askew"])
def test_job_stock_and_program_count_from_a_corner_of_the_stock(stand, document, parts, posting):
    thing = parts.block(document)
    thing.Placement = stand
    document.recompute()
    operation, op = planned(document, parts, thing, origin="stock:top-front-right", stock_box=MARGINS)
    low, high = corners(thing)
    assert np.allclose(box_around([thing.Shape]), [low + np.array([1, 3, 0]), high - np.array([2, 4, 5])])
    assert np.allclose(origin_of(operation), [high[0], low[1], high[2]], atol=1e-3)
    job, = make_jobs(document, operation)
    frame = frame_of(operation).Placement
    text = posting.posted(job)
    posting.check_on_cl(text, job.Operations.Group[0], op.path, frame)
    stock = job.Stock.Shape.copy()
    stock.Placement = frame.multiply(stock.Placement)
    points = np.array([tuple(vertex.Point) for vertex in stock.Vertexes])
    assert len(points) == 8 and np.allclose([points.min(axis=0), points.max(axis=0)], [low, high], atol=1e-3)
    assert sum(np.allclose(point, 0, atol=1e-3) for point in (np.array(tuple(vertex.Point)) for vertex in
                                                             job.Stock.Shape.Vertexes)) == 1
    before, _, _ = text.partition("\nG0 ")
    assert "(ORIGIN: front right corner of the top of the stock, in the document at" in before
    assert "ORIGIN: front right corner" in job.Description
    assert [one.Name for one in document.Objects if one.Name.startswith("Stock")] == [job.Stock.Name]


def test_without_origin_and_stock_all_is_as_freecad_makes_it(document, parts, posting):
    thing = parts.block(document)
    thing.Placement = ASKEW
    document.recompute()
    operation, _ = planned(document, parts, thing)
    assert np.allclose(origin_of(operation), tuple(ASKEW.Base)) and not operation.StockCorners
    job, = make_jobs(document, operation)
    assert hasattr(job.Stock, "ExtXneg") and "ORIGIN" not in posting.posted(job)


def test_a_picked_vertex_moves_along_with_the_part(document, parts):
    thing = parts.block(document)
    thing.Placement = ASKEW
    document.recompute()
    origin = origin_from_vertex(thing, "Vertex3")
    operation, _ = planned(document, parts, thing, origin=origin)
    assert np.allclose(origin_of(operation), tuple(thing.Shape.Vertexes[2].Point))
    thing.Placement = Placement(Vector(-3, 8, 1), Rotation(Vector(1, 1, 0), 40)).multiply(thing.Placement)
    document.recompute()
    assert not operation.Stale
    assert np.allclose(origin_of(operation), tuple(thing.Shape.Vertexes[2].Point))
    assert setup_of(inputs_of(operation))[0].startswith("point:")


def test_a_vertex_that_is_gone_is_refused(document, parts):
    thing = parts.block(document)
    inputs = parts.inputs_for((thing, parts.sculptured_name(thing)), origin=origin_from_vertex(thing, "Vertex1"))
    thing.Shape = parts.wavy(12.0).translated(Vector(0.5, 0, 0))
    document.recompute()
    with pytest.raises(InvalidInput, match="the vertex selected as the origin is gone"):
        setup_of(inputs)
    with pytest.raises(InvalidInput, match=r"Edge1 of Block is not a vertex"):
        origin_from_vertex(thing, "Edge1")


@pytest.mark.parametrize("given", [{"stock_box": "2"}, {"origin": "part:top"}], ids=["stock", "origin"])
def test_a_part_that_left_its_stock_makes_it_stale(given, document, parts):
    thing = parts.block(document)
    operation, _ = planned(document, parts, thing, **given)
    document.recompute()
    assert not operation.Stale, list(operation.StaleReasons)
    thing.Placement.Base = Vector(0, 0, 5)
    document.recompute()
    assert operation.StaleReasons == ["the part was moved or turned, and the limits of the axis, the clamped side or "
                                      "the stock were not"]
    with pytest.raises(InvalidInput, match="is out of date"):
        make_jobs(document, operation)


def test_one_job_has_one_origin(document, parts, tmp_path):
    thing = parts.block(document)
    first, _ = planned(document, parts, thing, origin="part:top")
    second, _ = planned(document, parts, thing, origin="part:bottom")
    with pytest.raises(InvalidInput, match="have different origins"):
        make_jobs(document, [first, second])
    assert not [one for one in document.Objects if hasattr(one, "Fixtures")]
    with pytest.raises(InvalidInput, match="have different origins"):
        export([first, second], tmp_path)


def test_faces_of_several_parts_have_no_common_stock(document, parts):
    first, second = parts.block(document, "First"), parts.block(document, "Second")
    name = parts.sculptured_name(first)
    with pytest.raises(InvalidInput, match="origin and stock are chosen for one part"):
        parts.inputs_for((first, name), (second, name), stock_box="2").check_tools()


@pytest.mark.parametrize(("given", "words"), [({"origin": "part:top"}, "origins"), ({"stock_box": "2"}, "stocks")])
def test_the_same_place_of_another_part_is_another_origin(given, words, document, parts, tmp_path):
    first, second = parts.block(document, "First"), parts.block(document, "Second")
    second.Placement.Base = Vector(0, 60, 0)
    document.recompute()
    made = [planned(document, parts, thing, **given)[0] for thing in (first, second)]
    with pytest.raises(InvalidInput, match=f"have different {words}"):
        make_jobs(document, made)
    with pytest.raises(InvalidInput, match="origin and stock are chosen for one part"):
        export(made, tmp_path)


def test_turned_copies_count_from_the_same_origin(document, parts):
    thing = parts.block(document)
    name = parts.sculptured_name(thing)
    operation, _ = planned(document, parts, thing, origin="stock:top-back-left", stock_box=MARGINS)
    link = document.addObject("App::Link", "Turned")
    link.LinkedObject = operation
    link.addProperty("App::PropertyPlacement", "Turn")
    link.addProperty("App::PropertyString", "Face")
    link.Placement = link.Turn = Placement(Vector(), Rotation(Vector(0, 0, 1), 90))
    link.Face, link.Label = name, "Another blade"
    document.recompute()
    jobs = make_jobs(document, operation)
    assert len(jobs) == 2
    for job in jobs:
        back = thing.Shape.Placement.multiply(job.Model.Group[0].Placement.inverse())
        assert np.allclose(tuple(back.Base), origin_of(operation), atol=1e-6)


def test_they_go_into_the_folder_and_onto_the_setup_sheet(document, parts, tmp_path):
    thing = parts.block(document)
    thing.Placement = ASKEW
    document.recompute()
    origin = origin_from_vertex(thing, "Vertex2")
    operation, _ = planned(document, parts, thing, origin=origin, stock_box=MARGINS)
    export(operation, tmp_path / "out", Wish("iso", "bc-table-table"))
    plan = read_plan(tmp_path / "out")
    assert np.allclose(plan.datum, tuple(thing.Shape.Vertexes[1].Point), atol=1e-6)
    low, high = corners(thing)
    assert plan.blank is not None and np.allclose([plan.blank.low, plan.blank.high], [low, high], atol=1e-3)
    sheet = next((tmp_path / "out").glob("setup*.md")).read_text()
    assert "Origin: a point selected on the part, at " in sheet and "\n\nStock: " in sheet


def test_they_come_back_from_the_operation_and_stand_in_macros(document, parts):
    thing = parts.block(document)
    operation, _ = planned(document, parts, thing, origin="stock:top", stock_box=MARGINS)
    inputs = inputs_of(operation)
    assert (inputs.origin, inputs.stock_box) == ("stock:top", MARGINS)
    assert "origin='stock:top', stock_box='1,2,3,4,0,5'" in plan_line(inputs)
    lines = again_lines(operation, inputs, replace(inputs, origin="part:top"))
    assert any(line.endswith(".Origin = 'part:top'") for line in lines)
    operation.Origin = "part:top"
    document.recompute()
    assert operation.StaleReasons == ["origin was changed"]


def test_what_scripts_give(document, parts):
    thing = parts.block(document)
    found = fields_of(document, {"origin": "Block.Vertex3", "stock_box": 2})
    assert found == {"origin": origin_from_vertex(thing, "Vertex3"), "stock_box": "2"}
    assert fields_of(document, {"origin": (thing, "Vertex3")})["origin"] == found["origin"]
    assert fields_of(document, {"origin": "stock:top", "stock_box": [1, 2, 3, 4, 0, 5]}) == {
        "origin": "stock:top", "stock_box": MARGINS}
    for wrong in ("Nothing.Vertex1", "left", 3, (thing, "Edge2")):
        with pytest.raises(InvalidInput, match=r"origin|vertex"):
            fields_of(document, {"origin": wrong})
