"""Every picture is drawn from data without a display, and says what it shows."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.placement import tips
from toolaxis.machine.work_coordinates import work_coordinates
from toolaxis.plan.baseline import Baseline
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import REASONS, AxisMap, Orientation
from toolaxis.plan.plan import Option, Plan, PlanInputs
from toolaxis.plan.zone import Zone
from toolaxis.report.figures.comparison_chart import baselines_picture, options_picture
from toolaxis.report.figures.hatch_fill import COLOUR
from toolaxis.report.figures.hemisphere import equal_area, hemisphere_picture
from toolaxis.report.figures.label_places import LabelPlaces, join_labels
from toolaxis.report.figures.map_colouring import colour_map
from toolaxis.report.figures.plan_overview import overview_picture, side_of_tools
from toolaxis.report.figures.plots import (
    WidthStudy,
    cutting_lines,
    map_picture,
    operation_picture,
    study_picture,
    widths_picture,
)
from toolaxis.report.figures.splat_renderer import camera, points_on
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tools.tool import Tool
from toolaxis.verify.maps import SurfaceMap

TOOL = Tool.torus(12, 1, stickout=60, holder=[(10, 0), (10, 40)])
AXIS = np.array([0.0, 0.28, 0.96])


def surface() -> Face:
    x, y = np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 30, 5), indexing="ij")
    return Face.from_bspline(np.stack([x, y, 2 * np.sin(x / 12) + 0.01 * y**2], axis=-1))


def planned() -> tuple[Plan, Operation]:
    face = surface()
    lines = [np.stack([np.linspace(0, 1, 20), np.full(20, v)], axis=1) for v in np.linspace(0, 1, 12)]
    uv = np.concatenate(lines)
    points, normals = face.evaluate(uv).point, face.normal(uv)
    kind = np.tile([Motion.LINK, *[Motion.CUT] * 19], 12).astype(np.int8)
    path = ToolPath(points, tips(points, normals, AXIS, TOOL), np.tile(AXIS, (240, 1)), normals, kind,
                    np.arange(0, 241, 20))
    found = Orientation(AXIS, "u", 12, 11.5, 480.0, 2.5, outcome="feasible")
    frame = work_coordinates(AXIS, np.array([[1.0, 0, 0]]), np.zeros(3), points[0])
    op = Operation(1, face, TOOL, found, path, frame)
    return Plan(Part.from_faces([face]), (TOOL,), PlanInputs(0.02), (op,), (), np.zeros(3), "complete"), op


def colours_of(made: Figure, path: Path) -> np.ndarray:
    from matplotlib.image import imread

    made.savefig(path, dpi=60)
    image = imread(path)[..., :3]
    return np.unique((image.reshape(-1, 3) * 8).astype(int), axis=0)


def test_operation_picture_shows_part_passes_and_tool(tmp_path: Path) -> None:
    plan, op = planned()
    made = operation_picture(plan, op)
    titles = [ax.get_title() for ax in made.axes]
    assert titles[0] == "op01-face1: 12 passes along u, cutting length 480 mm"
    assert titles[1] == "torus:12x1, axis (+0.000, +0.280, +0.960)"
    labels = [text.get_text() for ax in made.axes for text in ax.get_legend().get_texts()]
    assert {"face", "contact line", "machined face", "cutter", "shank", "holder"} <= set(labels)
    assert len(colours_of(made, tmp_path / "op.png")) > 20


def test_overview_shows_every_sub_surface_and_its_axis(tmp_path: Path) -> None:
    plan, op = planned()
    halves = [np.array([[a, 0.0], [a + 0.5, 0.0], [a + 0.5, 1.0], [a, 1.0]]) for a in (0.0, 0.5)]
    both = (replace(op, face=op.face.trimmed((halves[0],), "1a")),
            Operation(2, op.face.trimmed((halves[1],), "1b"), TOOL, Orientation(None), None, None))
    made = overview_picture(replace(plan, operations=both))
    ax = made.axes[0]
    assert {text.get_text() for text in ax.texts} >= {"1", "2: no axis"}
    assert "1 of 2 sub-surfaces" in ax.get_title()
    assert len(colours_of(made, tmp_path / "plan.png")) > 10


def test_sub_surfaces_without_an_axis_beside_each_other_have_one_label() -> None:
    """Found: "6: no axis" and "7: no axis" lay on each other."""
    places = {1: np.array([0.0, 0.0]), 4: np.array([9.0, 1.0]), 6: np.array([3.0, 1.0]), 7: np.array([8.0, 0.5])}
    found = join_labels(places, np.array([5.0, 2.0]))
    assert [numbers for numbers, _ in found] == [[1, 6], [4, 7]]
    assert np.array_equal(found[0][1], places[1]) and np.array_equal(found[1][1], places[4])
    plan, op = planned()
    none = replace(op, orientation=Orientation(None, outcome="infeasible"), path=None)
    made = overview_picture(replace(plan, operations=(op, replace(none, number=2), replace(none, number=3))))
    assert [one.get_text() for one in made.axes[0].texts if "no axis" in one.get_text()] == ["2, 3: no axis"]


def test_labels_of_axes_that_end_at_one_place_do_not_lie_on_each_other() -> None:
    """Found: the numbers 5 and 19 of two axes were one blot."""
    labels, place, wish = LabelPlaces(2.0), np.array([30.0, 20.0]), np.array([0.0, 10.0])
    found = [2.0 * place + labels.find("12", place, wish) for _ in range(6)]
    assert np.array_equal(found[0] - 2.0 * place, wish)
    for k, one in enumerate(found):
        for other in found[:k]:
            assert abs(one - other)[0] >= 16.9 or abs(one - other)[1] >= 11.9
    far = np.array([300.0, 20.0])
    assert np.array_equal(labels.find("12", far, wish), wish)


def test_the_part_is_seen_from_where_most_of_it_is_machined() -> None:
    """Found: a bore, whose normals cancel, was looked at from below."""
    _, op = planned()
    axes = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
    both = [replace(op, orientation=replace(op.orientation, axis=axis)) for axis in axes]
    small = both[1].face.trimmed((np.array([[0.0, 0.0], [0.2, 0.0], [0.2, 1.0], [0.0, 1.0]]),))
    assert np.allclose(side_of_tools([both[0], replace(both[1], face=small)]), axes[0])
    none = replace(op, orientation=Orientation(None), path=None)
    assert side_of_tools([none])[2] > 0.9, "without an axis the normals tell"


def test_what_bulges_beyond_its_border_is_in_the_picture() -> None:
    """The border of a closed face, such as a sphere's seam, does not tell how far the face goes."""
    net = np.array([[[x, y, 0.0] for y in (0.0, 10, 20, 30)] for x in (0.0, 10, 20, 30)])
    net[1:3, 1:3, 2] = 60.0
    dome = Face.from_bspline(net)
    seen = camera((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), points_on([dome]))
    left, right, bottom, top = seen.extent
    flat = seen.project(dome.evaluate(dome.grid(200, 200)).point)
    assert flat[:, 1].max() > 30 and left <= flat[:, 0].min() and flat[:, 0].max() <= right
    assert bottom <= flat[:, 1].min() and flat[:, 1].max() <= top


def test_overview_shows_a_sliver_that_is_left() -> None:
    """Found: a rest between two sub-surfaces, too thin for the places at which faces are looked at."""
    plan, op = planned()
    loops = [np.array([[a, 0.0], [a + 1e-4, 0.0], [a + 1e-4, 1.0], [a, 1.0]]) for a in (0.1, 0.9)]
    sliver = op.face.trimmed(tuple(loops), "1b")
    assert not len(sliver.grid(12, 12))
    made = overview_picture(replace(plan, operations=(op, Operation(2, sliver, TOOL, Orientation(None)))))
    assert {text.get_text() for text in made.axes[0].texts} >= {"1", "2: no axis"}


def test_sub_surfaces_that_touch_have_different_colours() -> None:
    _, op = planned()
    cells = [(i, j) for i in range(3) for j in range(7)]
    pieces = [Operation(k, op.face.trimmed((np.array([(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]) / [3, 7],)),
                        TOOL, Orientation(None)) for k, (i, j) in enumerate(cells, 1)]
    colours = colour_map(pieces)
    for k, (i, j) in enumerate(cells):
        for m, other in enumerate(cells[:k]):
            assert max(abs(i - other[0]), abs(j - other[1])) > 1 or colours[k] != colours[m]
    assert len(set(colours)) <= 7


def test_clean_up_zones_are_hatched_in_both_pictures() -> None:
    plan, op = planned()
    t = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    ring = tuple(np.column_stack([0.5 + r * np.cos(t), 0.5 + r * np.sin(t)]) for r in (0.3, 0.12))
    marked = replace(op, zones=(Zone(ring, 100.0),))
    for picture, ax in ((operation_picture, 0), (lambda p, o: overview_picture(p), 0)):
        shown = []
        for one in (op, marked):
            made = picture(replace(plan, operations=(one,)), one)
            image = np.asarray(made.axes[ax].images[0].get_array())
            shown.append(float((np.abs(image - np.array(COLOUR)).max(axis=2) < 0.01).mean()))
            legend = made.axes[ax].get_legend()
            labels = [] if legend is None else [text.get_text() for text in legend.get_texts()]
            assert ("rest material" in labels) == (one is marked)
        assert shown[0] == 0 and 0.005 < shown[1] < 0.3


def test_the_curve_of_orientations_marks_the_chosen_one(tmp_path: Path) -> None:
    made = options_picture([Option(1, 1, 900.0, False), Option(2, 3, 700.0, True), Option(4, 5, 680.0, False)])
    ax = made.axes[0]
    assert [text.get_text() for text in ax.texts] == ["1", "3", "5"]
    ring = next(line for line in ax.lines if line.get_label() == "chosen, at the knee")
    assert (ring.get_xdata()[0], ring.get_ydata()[0]) == (2, 700.0)
    assert len(colours_of(made, tmp_path / "orientations.png")) > 5


def test_cutting_lines_are_the_uninterrupted_cuts() -> None:
    op = planned()[1]
    assert op.path is not None
    lines = cutting_lines(op.path)
    assert len(lines) == 12 and all(len(line) == 20 for line in lines), "from the point at which each begins"
    few = ToolPath(*(rows[[0, 19]] for rows in (op.path.cc, op.path.cl, op.path.axis, op.path.normal)),
                   np.array([Motion.ENTRY, Motion.CUT], dtype=np.int8), np.array([0, 2]))
    assert np.array_equal(cutting_lines(few)[0], few.cc), "one straight is a line too"


@pytest.mark.parametrize("angle", [0.0, 10.0, 45.0, 90.0, 120.0])
def test_equal_area_projection_keeps_areas(angle: float) -> None:
    pole = np.array([0.48, -0.6, 0.64])
    rng = np.random.default_rng(0)
    axes = rng.normal(size=(200_000, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    radius = np.linalg.norm(equal_area(axes, pole), axis=1)
    edge = np.sqrt(1 - np.cos(np.radians(angle)))
    inside = float((axes @ pole >= np.cos(np.radians(angle))).mean())
    assert float((radius <= edge).mean()) == pytest.approx(inside, abs=1e-5)
    assert np.allclose(equal_area(pole, pole), 0.0)


def example_map() -> AxisMap:
    rng = np.random.default_rng(1)
    axes = rng.normal(size=(300, 3))
    axes[:, 2] = np.abs(axes[:, 2])
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    reason = np.where(axes[:, 2] > 0.6, 0, 1 + np.arange(300) % (len(REASONS) - 1)).astype(np.int8)
    length = np.where(reason == 0, 500 / axes[:, 2], np.inf)
    return AxisMap(axes, length / 40, length, reason, np.zeros(300))


def test_hemisphere_names_axes_and_reasons(tmp_path: Path) -> None:
    found = example_map()
    made = hemisphere_picture(found, 1200.0, [0, 0, 1], {
        "chosen": AXIS, "mean normal": [0, 0, 1], "Roman's rule": [0.6, 0, 0.8], "sectors [zhu2016]": [0, 0.6, 0.8],
        "other lobes": np.array([[0.0, -0.6, 0.8]])}, "op01")
    side = made.axes[0]
    named = [text.get_text().replace("\n", " ") for legend in (*side.artists, side.get_legend())
             for text in legend.get_texts()]
    marks = {"chosen", "mean normal", "Roman's rule", "sectors [zhu2016]", "other lobes"}
    assert set(REASONS[1:]) | marks <= set(named)
    made.savefig(tmp_path / "axes.png", dpi=60)
    made.canvas.draw()
    for legend in (*side.artists, side.get_legend()):
        box = legend.get_window_extent()
        assert box.x0 >= 0 and box.y0 >= 0, "a legend is cut off"


def test_hemisphere_without_a_free_axis(tmp_path: Path) -> None:
    found = example_map()
    none = AxisMap(found.axis, np.full(300, np.inf), np.full(300, np.inf), np.full(300, 4, dtype=np.int8), np.ones(300))
    hemisphere_picture(none, 1200.0, [0, 0, 1], {"mean normal": [0, 0, 1]}, "op01").savefig(tmp_path / "a.png")


def judged(remaining: float, gouge: float) -> SurfaceMap:
    face = surface()
    uv = face.grid(40, 30)
    point = face.evaluate(uv).point
    left = np.full(len(uv), 0.01)
    left[100:140] = remaining
    deep = np.zeros(len(uv))
    deep[300] = gouge
    none = np.full(len(uv), -1)
    return SurfaceMap(face, uv, point, np.ones(len(uv)), np.zeros(len(uv), dtype=bool), left, deep, none, none, 1.0,
                      None, None, np.zeros(len(uv), dtype=bool))


def test_maps_show_what_is_beyond_the_limits(tmp_path: Path) -> None:
    good = colours_of(map_picture([judged(0.015, 0.0)], 0.02, 0.002, "op01"), tmp_path / "good.png")
    high = map_picture([judged(0.05, 0.004)], 0.02, 0.002, "op01")
    lost = map_picture([judged(np.inf, 0.0)], 0.02, 0.002, "op01")
    assert high.axes[1].get_title() == "op01\ngouge in the face, greatest 4.00 µm, allowed 2 µm"
    assert len(colours_of(high, tmp_path / "high.png")) > 0 and len(good) > 0
    assert [t.get_text() for t in lost.axes[0].get_legend().get_texts()] == ["above 1.1 times the limit", "not reached"]
    assert [t.get_text() for t in high.axes[0].get_legend().get_texts()] == ["above 1.1 times the limit"]


def test_study_and_widths(tmp_path: Path) -> None:
    angle = np.linspace(0.3, 1.0, 5)
    study_picture(WidthStudy(angle, angle * 1.01, angle, angle, 0.4), "op01").savefig(tmp_path / "study.png", dpi=50)
    face = surface()
    lines = []
    for v in (0.2, 0.5, 0.8):
        uv = np.stack([np.linspace(0, 1, 15), np.full(15, v)], axis=1)
        lines.append((face.evaluate(uv).point, 2 + v * uv[:, 0]))
    made = widths_picture(lines, (face, TOOL), "op01")
    made.savefig(tmp_path / "widths.png", dpi=50)
    assert made.axes[1].get_ylabel() == "strip width, mm"


def test_bars_show_methods_that_machine_all_and_name_those_that_do_not(tmp_path: Path) -> None:
    rows = [Baseline("plan", "torus:12x1", 4, 4, 3, 120, 5000.0, 900.0, 400.0),
            Baseline("ball", "ball:12", 4, 4, 1, 210, 8000.0, 1500.0, 650.0),
            Baseline("one", "torus:12x1", 4, 1, 1, 30, 900.0, 150.0, 65.0, "face 1b: no axis found")]
    made = baselines_picture(rows)
    widths = sorted(bar.get_width() for bar in made.axes[0].patches)
    assert widths == [0, 0, 900, 1500, 5000, 8000]
    words = " ".join(text.get_text() for text in made.axes[0].texts)
    assert "no axis for 3 of 4" in words and "5000 mm, 120 passes, 3 axes, 6:40 min" in words
    assert len(colours_of(made, tmp_path / "bars.png")) > 8
