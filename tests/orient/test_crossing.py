"""Links go straight over to what begins beside, and cross elsewhere as low as is proven clear."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.feasibility.surroundings import group_surroundings
from toolaxis.job.planning.blade_clearances import tightest
from toolaxis.search.face_problem import task
from toolaxis.search.link_heights import OVER, LinkClearance, height_over
from toolaxis.strategies.common.links import LinkMotion
from toolaxis.strategies.common.path_check import MovingLinkClearance
from toolaxis.tolerances import Tolerance

TOOL = ta.Tool.torus(diameter=8, corner_radius=1, stickout=40, holder=[(10, 0), (10, 30)])
AXIS = np.array([0.0, -np.sin(0.3), np.cos(0.3)])
#: Few axes to choose from, where links are what is looked at.
NEAR = "cone:0,-0.3,1,8"


@pytest.fixture(scope="module")
def sheet() -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 60, 5), np.linspace(0, 30, 5), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, 0.002 * (x - 30) ** 2], axis=-1))


def box(x0: float, x1: float, y0: float, y1: float, height: float) -> list[ta.Face]:
    """The five upper faces of a box, normals outwards."""
    def quad(a, b, c, d):
        return ta.Face.from_bspline(np.array([[a, d], [b, c]], dtype=float), degree=(1, 1))

    z0, z1 = -5.0, height
    return [quad((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)),
            quad((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)),
            quad((x1, y1, z0), (x0, y1, z0), (x0, y1, z1), (x1, y1, z1)),
            quad((x0, y1, z0), (x0, y0, z0), (x0, y0, z1), (x0, y1, z1)),
            quad((x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1))]


def test_links_stay_low_where_nothing_is_in_the_way(sheet: ta.Face) -> None:
    path = task(sheet, TOOL, 0.05, direction="climb").made(AXIS, "u")
    height = path.cl @ AXIS
    top = height.max()
    assert height[0] == pytest.approx(top) and height[-1] == pytest.approx(top), "it comes from the top and goes there"
    link = (path.kind == Motion.LINK)[1:-1]
    assert (height[1:-1][link] < top - 1).all()
    across = np.flatnonzero((path.kind[1:] == Motion.LINK)
                            & (np.linalg.norm(np.cross(np.diff(path.cl, axis=0), AXIS), axis=1) > 1e-6)) + 1
    assert len(across) == path.passes - 1
    for k in across:
        for share in np.linspace(0, 1, 21):
            tip = path.cl[k - 1] + share * (path.cl[k] - path.cl[k - 1])
            grid = sheet.evaluate(sheet.grid(80, 80)).point
            assert cutter_distance(grid, tip) >= OVER - 1e-6


def test_zigzag_goes_straight_over_to_the_next_pass(sheet: ta.Face) -> None:
    path = task(sheet, TOOL, 0.05).made(AXIS, "u")
    assert path.passes > 10 and (path.kind[3:-3] != Motion.LINK).all()
    grid = sheet.evaluate(sheet.grid(150, 150)).point
    over = np.flatnonzero(np.isin(path.kind[1:], (Motion.EXIT, Motion.ENTRY))) + 1
    assert len(over) >= 2 * (path.passes - 1)
    for k in over:
        for share in np.linspace(0, 1, 9):
            tip = path.cl[k - 1] + share * (path.cl[k] - path.cl[k - 1])
            assert cutter_distance(grid, tip) >= -Tolerance().gouge - 1e-6
    assert path.length(Motion.EXIT, Motion.ENTRY) < 6.0 * path.passes


def test_a_lift_stays_where_something_stands_between_or_the_way_is_long(sheet: ta.Face) -> None:
    ends = np.array([[20.0, 10, 3.0], [50.0, 10, 3.0], [5.0, 9, 3.0]])
    begins = ends + np.array([[3.0, 0, 0], [3.0, 0, 0], [9.0, 0, 0]])
    post = box(21, 22, 9, 11, 4.0)
    over = LinkClearance(TOOL, group_surroundings(sheet, Tolerance(), obstacles=post), AXIS, 60.0).beside(ends, begins)
    assert np.isnan(over[0]).all(), "a post stands between"
    assert np.allclose(over[1], [51.5, 10, 3.0]), "nothing is in the way"
    assert np.isnan(over[2]).all(), "nine millimetres are not beside"


def cutter_distance(points: np.ndarray, tip: np.ndarray) -> float:
    """Least signed distance of the cutter's torus and flat to points, and of its side below the flute length."""
    rows = points - tip
    z = rows @ AXIS
    r = np.linalg.norm(rows - z[:, None] * AXIS, axis=1)
    inner, corner = TOOL.flat_radius, TOOL.corner_radius
    core = np.stack([np.maximum(r - inner, 0), np.maximum(corner - z, 0)], axis=1)
    return float((np.linalg.norm(core, axis=1) - corner).min())


def test_a_link_over_a_box_goes_above_it(sheet: ta.Face) -> None:
    walls = box(24, 34, -3, 33, 14.0)
    crossing = LinkClearance(TOOL, group_surroundings(sheet, Tolerance(), obstacles=walls), AXIS, 60.0)
    ends, begins = np.array([[5.0, 10, 3.0], [5.0, 10, 3.0]]), np.array([[52.0, 10, 3.0], [9.0, 11, 3.0]])
    over, beside = crossing.heights(ends, begins)
    assert beside == pytest.approx(max(ends[1] @ AXIS, begins[1] @ AXIS) + 1.0)
    lifted = ends[0] + (over - ends[0] @ AXIS) * AXIS
    assert over < 60.0
    for share in np.linspace(0, 1, 200):
        tip = lifted + share * (begins[0] + (over - begins[0] @ AXIS) * AXIS - lifted)
        for wall in walls:
            assert cutter_distance(wall.evaluate(wall.grid(30, 30)).point, tip) >= Tolerance().cutter_clearance - 1e-6


def test_a_link_between_walls_too_near_rises_to_the_top(sheet: ta.Face) -> None:
    roof = box(-20, 80, 12, 40, 50.0)
    crossing = LinkClearance(TOOL, group_surroundings(sheet, Tolerance(), obstacles=roof), AXIS, 70.0)
    assert crossing.heights(np.array([[5.0, 9, 3.0]]), np.array([[52.0, 9, 3.0]])) == pytest.approx([70.0])


@pytest.mark.parametrize(("scallop", "lift"), [(0.02, 1.0), (0.05, 1.0), (0.2, 8.0), (0.5, 20.0)])
def test_links_keep_what_passes_leave_standing(sheet: ta.Face, scallop: float, lift: float) -> None:
    tips, normal = np.array([[20.0, 15, 1.0], [40.0, 15, 1.0]]), np.array([0.0, 0, 1])
    crossing = LinkClearance(TOOL, group_surroundings(sheet, Tolerance()), normal, 60.0, over=height_over(scallop))
    height, = crossing.heights(tips[:1], tips[1:])
    assert height == pytest.approx(1.0 + lift)
    moving = MovingLinkClearance(TOOL, group_surroundings(sheet, Tolerance()), over=height_over(scallop))
    for up in (lift, 0.3 * height_over(scallop)):
        ends = [(tip + up * normal)[None] for tip in tips]
        free, = moving.clear(*ends, normal[None], normal[None], LinkMotion.CROSSING)
        assert free == (up == lift)


def test_a_plan_with_low_links_passes_the_judge_beside_a_box(sheet: ta.Face) -> None:
    made = ta.plan(sheet, TOOL, 0.1, obstacles=box(24, 34, 34, 60, 20.0), limits=NEAR)
    assert made.outcome == "complete", made.operations[0].orientation.reasons
    assert made.travel < 1.6 * made.length
    verdict = ta.verify(made)
    assert verdict.passed, verdict.reasons
    place = tightest(made)
    assert place is not None
    assert place.distance >= min(made.operations[0].orientation.clearance.values()), "never less than what was proven"


def test_links_at_a_large_scallop_height_pass_the_judge_between_boxes(sheet: ta.Face) -> None:
    made = ta.plan(sheet, TOOL, 0.5, obstacles=box(14, 24, 8, 20, 4.0) + box(38, 46, 10, 24, 4.0), limits=NEAR)
    assert made.outcome == "complete", made.operations[0].orientation.reasons
    verdict = ta.verify(made)
    assert verdict.passed, verdict.reasons


def test_passes_that_cannot_be_laid_refuse_the_axis_and_not_the_face(sheet: ta.Face,
                                                                     monkeypatch: pytest.MonkeyPatch) -> None:
    from toolaxis.search.face_problem import FaceProblem

    laid, axes = FaceProblem.laid, []

    def _laid(self, axis, feed):
        axes.append(axis)
        if len(axes) == 1:
            raise ta.InvalidInput("strip width is [0, 0] at uv [0.5, 0.5] of face 1")
        return laid(self, axis, feed)

    monkeypatch.setattr(FaceProblem, "laid", _laid)
    found = ta.best_axis(sheet, TOOL, 0.01)  # many passes: the order is that of the counts
    assert found.outcome == "feasible" and not np.array_equal(found.axis, axes[0])
    assert any("strip width is [0, 0]" in reason for reason in found.reasons)
