"""Fixed axes with passes along parallel planes: counts and passes made, walls, the judge's scallop, and refusals."""

import json
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.path.estimate import Estimator
from toolaxis.path.parametrization import Cut
from toolaxis.path.pass_pattern import PlanePasses
from toolaxis.path.planes import PlaneChart
from toolaxis.path.rest_material import undercut
from toolaxis.plan.choices import ISO, PLANES
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import describe_feed
from toolaxis.search.candidate_check import check_candidate
from toolaxis.search.face_problem import task
from toolaxis.search.fixed_axis import best_axis
from toolaxis.search.local_search import CountedAxis
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

TOOL, H = Tool.torus(diameter=12, corner_radius=1), 0.1
UP = np.array([0.0, 0.0, 1.0])
#: Fewer axes to look at.
NEAR = "cone:0,0,1,25"


def _chart(face: Face, axis: np.ndarray, feed: str) -> PlaneChart:
    return PlanePasses(Estimator.of(face, TOOL, H)).chart(Cut(TOOL, axis, H), feed)


def _fan() -> Face:
    """A gently curved face whose lines along u run apart like a fan's."""
    u, v = np.meshgrid(np.linspace(0, 1, 5), np.linspace(-1, 1, 5), indexing="ij")
    radius, angle = 20 + 30 * u, 0.5 * v
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    return Face.from_bspline(np.stack([x, y, 0.002 * (x**2 - y**2)], axis=-1))


def test_planes_take_the_way_of_the_fan_and_iso_lines_its_rays() -> None:
    """Rays lie close where they begin: planes need fewer passes there and cut less."""
    face, ball = _fan(), Tool.ball(10)
    iso, planes = (task(face, ball, H, passes=passes) for passes in (ISO, PLANES))
    rays, parallel = (job.made(UP, "u") for job in (iso, planes))
    assert planes.worth.counted(UP, "u")[1] < 0.9 * iso.worth.counted(UP, "u")[1]
    assert parallel.length(Motion.CUT) < rays.length(Motion.CUT)
    chart = _chart(face, UP, "u")
    assert chart.feed_at(np.array([[0.5, 0.5]]))[0] @ (1, 0, 0) > 0.99
    uv = face.grid(7, 7)
    places = chart.places(uv)
    assert chart.uv(*places.T) == pytest.approx(uv, abs=1e-9)


@pytest.mark.parametrize("passes", [ISO, PLANES])
def test_the_count_is_that_of_the_passes(passes: str) -> None:
    job = task(_fan(), TOOL, H, passes=passes)
    axis = np.array([0.25, 0.1, 1.0]) / np.linalg.norm([0.25, 0.1, 1.0])
    assert job.worth.counted(axis, "v")[0] == pytest.approx(job.laid(axis, "v").used, rel=0.01)


def test_the_best_axis_is_proven_with_its_planes() -> None:
    found = best_axis(_fan(), TOOL, H, passes=PLANES, limits=NEAR)
    assert found.outcome == "feasible" and found.passes >= 3 and found.gouge <= 0.01
    assert found.count == pytest.approx(task(_fan(), TOOL, H, passes=PLANES).worth.counted(found.axis, found.feed)[0])


def test_further_passes_beside_a_wall_lie_in_planes_too(make) -> None:
    """What passes along the wall leave where they would have to run out into it is cut by further ones."""
    part, tool = make.floor_and_wall(), Tool.ball(6)
    job = task(part.faces[0], tool, H, part=part, passes=PLANES)
    axis = np.array([0.0, -0.5, 1.0]) / np.sqrt(1.25)
    for feed in "uv":
        plain = job.traced(job.laid(axis, feed))
        placed = job.laid(axis, feed)
        made = job.completed(placed, job.traced(placed))
        assert sum(zone.area for zone in made.zones) <= sum(zone.area for zone in job.left_by(plain)) + 1e-9
        assert undercut(made.zones) <= undercut(job.left_by(plain)) + 1e-9
        across = _chart(part.faces[0], axis, feed).frame[1]
        cuts = np.flatnonzero(made.path.kind == Motion.CUT)
        same = made.path.cc[cuts] @ across - made.path.cc[cuts - 1] @ across
        assert np.abs(same).max() < 1e-6


def test_a_plan_along_planes_passes_the_judge_and_keeps_its_choice() -> None:
    fan = _fan()
    made = ta.plan(ta.Part.from_faces([fan]), TOOL, H, passes=PLANES, limits=NEAR)
    assert made.outcome == "complete" and made.inputs.passes == PLANES
    assert ta.verify(made).passed
    assert describe_feed(Orientation(UP, "u", pattern=PLANES)) == "u, in planes"
    assert describe_feed(Orientation(UP, "u")) == "u"
    assert made.operations[0].orientation.pattern == PLANES


def test_a_face_that_turns_away_refuses_the_axis_with_its_reason() -> None:
    """Only for that axis, in one sentence."""
    arch = np.linspace(-1.2, 1.2, 9)
    t, y = np.meshgrid(arch, np.linspace(0, 30, 4), indexing="ij")
    face = Face.from_bspline(np.stack([25 * np.sin(t), y, 25 * np.cos(t)], axis=-1))
    axis = np.array([0.9, 0.0, 0.3]) / np.linalg.norm([0.9, 0.0, 0.3])
    job = task(face, Tool.ball(6), H, passes=PLANES)
    assert job.worth.counted(axis, "v") == (np.inf, np.inf)
    done = check_candidate(job, CountedAxis(axis, 1, np.inf, np.inf, np.inf, 0.0))
    assert done.path is None and done.proof.witness is not None
    why = done.proof.witness.words
    assert why.startswith("face 1 turns away from the axis (n . T = -")
    assert "use iso-parametric passes, or divide" in why
    assert np.isfinite(job.worth.counted(UP, "v")).all()


def test_a_face_that_covers_itself_is_refused_with_the_place() -> None:
    """A ramp that winds around once and a half: the axis sees its outer side everywhere, but not all of it."""
    t, r = np.meshgrid(np.linspace(0, 3 * np.pi, 40), np.linspace(10, 20, 4), indexing="ij")
    ramp = Face.from_bspline(np.stack([r * np.cos(t), r * np.sin(t), 3 * t], axis=-1))
    up = UP if ramp.normal(ramp.grid(8, 8))[:, 2].min() > 0 else -UP
    assert (ramp.normal(ramp.grid(8, 8)) @ up).min() > 0.5
    with pytest.raises(UnsupportedGeometry, match=r"covers itself as seen along the axis, by \d+\.\d\d mm at \["):
        _chart(ramp, up, "u")


def test_passes_that_would_run_out_where_the_surface_turns_away_are_refused() -> None:
    """z = 0.08 x y, seen along (1, 0, 1), turns away beyond y = 12.5: points on passes there are none."""
    x, y = np.array([[0.0, 0], [10, 10]]), np.array([[0.0, 10], [0, 10]])
    face = Face.from_bspline(np.stack([x, y, 0.08 * x * y], axis=-1), degree=(1, 1))
    chart = _chart(face, np.array([1.0, 0, 1]) / np.sqrt(2), "v")
    place = chart.places(np.array([[0.3, 0.0], [0.3, 1.0]]))
    low, inside, step = place[0, 0], place[1, 0], place[0, 1]
    pieces = np.array([[low, low + 0.5 * (inside - low), step], [low, low + 1.5 * (inside - low), step]])
    assert chart.are_found(pieces).tolist() == [True, False]
    with pytest.raises(UnsupportedGeometry, match="1 of 2 passes cannot run out beyond the border of face 1, where"):
        chart.check_pieces(pieces)


def test_a_trimmed_face_is_found_again_though_its_surface_turns_away_beyond() -> None:
    t, y = np.meshgrid(np.linspace(-2.6, 1.0, 25), np.linspace(0, 30, 4), indexing="ij")
    whole = Face.from_bspline(np.stack([25 * np.sin(t), y, 25 * np.cos(t)], axis=-1))
    v0, v1 = whole.bounds[2:]
    face = whole.trimmed((np.array([[0.45, v0], [1.0, v0], [1.0, v1], [0.45, v1]]),))
    uv = face.grid(9, 9)
    chart = _chart(face, UP, "v")
    assert chart.uv(*chart.places(uv).T) == pytest.approx(uv, abs=1e-9)


@pytest.mark.parametrize("words", [{"passes": "spiral"}, {"passes": PLANES, "strategy": "sturz"},
                                   {"passes": PLANES, "strategy": "two-point"}])
def test_what_does_not_go_with_planes_is_refused(words: dict[str, str]) -> None:
    known = r"passes 'spiral' is unknown: use iso, planes, scallop or auto"
    with pytest.raises(InvalidInput, match=rf"{known}|need a fixed axis"):
        ta.plan(_fan(), Tool.flat(20) if words.get("strategy") == "two-point" else TOOL, H, **words)


def test_plans_of_before_have_iso_parametric_passes(tmp_path: Path) -> None:
    """plan.json of an older version does not name the choice."""
    from toolaxis.job.files.plan_folder import read_plan, write_plan

    write_plan(ta.plan(_fan(), TOOL, H, limits=NEAR), tmp_path)
    file = tmp_path / "plan.json"
    document = json.loads(file.read_text())
    assert document["inputs"].pop("passes") == ISO
    file.write_text(json.dumps(document))
    assert read_plan(tmp_path).inputs.passes == ISO
