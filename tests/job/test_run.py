"""The main job in Python: plan, judge, cancel, and the answer no."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.inputs.spec import choose_faces, parse_faces
from toolaxis.job.planning.sub_surfaces import Target, by_axis, smooth_pieces
from toolaxis.machine.limits import parse_limits
from toolaxis.plan.plan import Plan
from toolaxis.progress import Progress
from toolaxis.search.face_problem import FaceProblem


def net(height: float, nx: int = 6, ny: int = 6, size: tuple[float, float] = (24.0, 16.0)) -> np.ndarray:
    x, y = np.meshgrid(np.linspace(0, size[0], nx), np.linspace(0, size[1], ny), indexing="ij")
    return np.stack([x, y, height * np.sin(x / 9) * np.cos(y / 8)], axis=-1)


def test_the_plan_of_a_patch_is_complete_and_passes(small_plan: Plan) -> None:
    assert small_plan.outcome == "complete"
    op = small_plan.operations[0]
    found = op.orientation
    assert op.path is not None and op.frame is not None and found.axis is not None
    assert found.outcome == "feasible" and found.passes == op.path.passes > 3
    assert op.path.length(Motion.CUT) == pytest.approx(found.length, rel=1e-9)
    assert found.average_strip_width == pytest.approx(op.face.area / found.length, rel=1e-9)
    assert found.gouge <= small_plan.inputs.tolerance.gouge == 0.01 and found.clearance["holder"] >= 1.0
    assert np.allclose(op.frame.z, found.axis) and np.array_equal(op.frame.origin, np.zeros(3))
    verdict = ta.verify(small_plan)
    assert verdict.passed, verdict.reasons
    judged = verdict.operations[0]
    off_corner = [one.value for one in judged.worst_scallop if one.uv != (1.0, 1.0)]
    assert max(off_corner) <= 1.003 * 0.1, "the last pass leaves a speck of 2 % more in one corner"
    assert judged.scallop_max <= 1.025 * 0.1 and judged.gouge_max <= judged.gouge_allowed == 0.01
    assert judged.clearance["holder"].distance >= found.clearance["holder"] - 0.01


def test_the_judge_fails_a_spoilt_plan(small_plan: Plan) -> None:
    op = small_plan.operations[0]
    assert op.path is not None and op.orientation.axis is not None
    deep = replace(op.path, cl=op.path.cl - [0.0, 0.0, 0.01])
    verdict = ta.verify(replace(small_plan, operations=(replace(op, path=deep),)))
    assert not verdict.passed and any("gouge" in reason for reason in verdict.reasons)
    keep = np.arange(len(op.path.cl)) < op.path.breaks[len(op.path.breaks) // 2]
    half = replace(op.path, cc=op.path.cc[keep], cl=op.path.cl[keep], axis=op.path.axis[keep],
                   normal=op.path.normal[keep], kind=op.path.kind[keep],
                   breaks=op.path.breaks[:len(op.path.breaks) // 2 + 1])
    verdict = ta.verify(replace(small_plan, operations=(replace(op, path=half),)))
    assert not verdict.passed and any("% of the area" in reason for reason in verdict.reasons)


def test_the_same_again(small_plan: Plan) -> None:
    again = ta.plan(small_plan.part, small_plan.tools[0], 0.1)
    mine, theirs = again.operations[0], small_plan.operations[0]
    assert np.array_equal(mine.orientation.axis, theirs.orientation.axis)
    assert mine.path is not None and theirs.path is not None and np.array_equal(mine.path.cl, theirs.path.cl)


def test_cancelling_keeps_what_is_finished(small_plan: Plan) -> None:
    faces = [ta.Face.from_bspline(net(1.0)), ta.Face.from_bspline(net(1.0) + np.array([0.0, 40.0, 0.0]))]
    part = ta.Part.from_faces(faces)
    seen: list[str] = []

    def cancelled() -> bool:
        return bool(seen) and seen[-1].startswith("face 2")

    progress = Progress(lambda stage, *_: seen.append(stage), cancelled)
    made = ta.plan(part, "torus:12x1", 0.1, workers=1, progress=progress)
    assert made.outcome == "cancelled"
    assert [op.face.number for op in made.operations] == [1] and made.operations[0].done


def test_cancelling_at_once_gives_an_empty_plan() -> None:
    made = ta.plan(ta.Face.from_bspline(net(1.0)), "ball:6", 0.1, progress=Progress(None, lambda: True))
    assert made.outcome == "cancelled" and made.operations == ()


def test_limits_hold_and_impossible_limits_are_reported() -> None:
    face = ta.Face.from_bspline(net(1.0))
    made = ta.plan(face, "torus:12x1", 0.1, machine="cone:0,0.7,0.7,10")
    axis = made.operations[0].orientation.axis
    assert axis is not None and parse_limits("cone:0,0.7,0.7,10").allowed(axis[None])[0]
    none = ta.plan(face, "torus:12x1", 0.1, machine="cone:0,0,-1,10")
    assert none.outcome == "incomplete" and none.operations[0].path is None
    assert none.operations[0].orientation.outcome in ("infeasible", "not_found")
    assert none.operations[0].orientation.reasons


@pytest.mark.parametrize("direction", ["climb", "conventional"])
def test_one_way_passes_all_run_the_same_way(direction: str) -> None:
    made = ta.plan(ta.Face.from_bspline(net(1.0)), "torus:12x1", 0.1, direction=direction)
    op = made.operations[0]
    assert op.path is not None
    cut = np.flatnonzero((op.path.kind[1:] == Motion.CUT) & (op.path.kind[:-1] == Motion.CUT))
    steps = op.path.cc[cut + 1] - op.path.cc[cut]
    along = steps @ steps.sum(axis=0)
    assert (along > 0).all()
    assert ta.verify(made).passed


def test_obstacles_are_kept_clear_of() -> None:
    face = ta.Face.from_bspline(net(0.5))
    free = ta.plan(face, "torus:12x1", 0.1).operations[0]
    assert free.orientation.axis is not None and free.path is not None
    way = free.orientation.axis - free.orientation.axis[2] * np.array([0, 0, 1.0])
    side = way / np.linalg.norm(way)
    across = np.cross([0, 0, 1.0], side)
    foot = np.array([12.0, 8, 12]) + 25 * side
    s, t = np.meshgrid(np.linspace(-30, 30, 4), np.linspace(0, 60, 4), indexing="ij")
    wall = ta.Face.from_bspline(foot + s[..., None] * across + t[..., None] * np.array([0, 0, 1.0]))
    tool = ta.Tool.torus(diameter=12, corner_radius=1, stickout=30, holder=[(25, 0), (25, 60)])
    made = ta.plan(face, tool, 0.1, obstacles=wall)
    found = made.operations[0].orientation
    assert made.outcome == "complete" and found.clearance["holder"] >= 1.0
    assert "obstacles other than the part" not in made.not_checked
    assert ta.verify(made).passed


def test_the_number_of_orientations_is_chosen_from_their_curve(tmp_path: Path) -> None:
    x, y = np.meshgrid(np.linspace(0, 40, 7), np.linspace(0, 30, 7), indexing="ij")
    face = ta.Face.from_bspline(np.stack([x, y, 6 * np.sin(np.pi * x / 20)], -1))
    made = ta.plan(face, "torus:8x1", 0.1, orientations="auto", regions=3, limits="cone:0,0,1,30")
    assert made.outcome == "complete" and sum(option.chosen for option in made.options) == 1
    chosen = next(option for option in made.options if option.chosen)
    axes = np.unique([op.orientation.axis for op in made.operations], axis=0)
    assert len(axes) == chosen.orientations and len(made.operations) == chosen.sub_surfaces
    assert (np.abs(np.diff(made.axes, axis=0)) > 1e-9).any(axis=1).sum() == chosen.orientations - 1
    write_plan(made, tmp_path)
    assert read_plan(tmp_path).options == made.options


@pytest.mark.parametrize("change, said", [
    ({"regions": 0}, "number of sub-surfaces is 0"), ({"orientations": 17}, "number of orientations is 17"),
    ({"strategy": "five-axis"}, "strategy 'five-axis' is unknown"), ({"faces": []}, "list of faces is empty"),
    ({"faces": [2]}, "face 2 does not exist"), ({"method": "guess"}, "method 'guess' is unknown"),
    ({"machine": 7}, "machine is a int"), ({"datum": (0, 0)}, "datum"), ({"allowance": -1}, "allowance"),
    ({"stock": -0.1}, "stock is -0.1 mm: it must be zero or more, and at most 50 mm"),
    ({"stock": float("nan")}, "stock is nan mm"), ({"stock": 49.0}, "stock is 49 mm and the whole part measures"),
    ({"stock": 0.2, "allowance": 0.3}, "below the allowance of 0.3 mm: give at least the allowance"),
])
def test_wrong_arguments(change: dict[str, object], said: str) -> None:
    with pytest.raises(ta.InvalidInput, match=said):
        ta.plan(ta.Face.from_bspline(net(1.0)), "ball:6", 0.1, **change)  # type: ignore[arg-type]


def test_faces_by_number_and_by_default() -> None:
    faces = [replace(ta.Face.from_bspline(net(1.0)), kind=kind) for kind in ("plane", "bspline", "cone", "torus")]
    part = ta.Part.from_faces(faces)
    assert [f.number for f in choose_faces(part, None)] == [2, 4]
    assert [f.number for f in choose_faces(part, "all")] == [1, 2, 3, 4]
    assert [f.number for f in choose_faces(part, "4,1-2,2")] == [4, 1, 2]
    assert [f.number for f in choose_faces(replace(part, selected=(3,)), None)] == [3]
    assert parse_faces("3, 5-8") == (3, 5, 6, 7, 8) and parse_faces("ALL") == "all"
    with pytest.raises(ta.InvalidInput, match="none of the part's 1 faces is sculptured"):
        choose_faces(ta.Part.from_faces(faces[:1]), None)


def test_a_face_that_cannot_be_computed_does_not_take_the_others_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    import toolaxis.search.fixed_axis as job

    search = job.find_axis

    def fails_on_the_first(task: FaceProblem, *rest: object, **more: object) -> object:
        if task.worth.face.number == 1:
            raise ta.UnsupportedGeometry("face 1 is made of water")
        return search(task, *rest, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(job, "find_axis", fails_on_the_first)
    part = ta.Part.from_faces([ta.Face.from_bspline(net(1.0)), ta.Face.from_bspline(net(1.0) + np.array([0, 40.0, 0]))])
    made = ta.plan(part, "torus:12x1", 0.1)
    assert made.outcome == "incomplete"
    assert [op.done for op in made.operations] == [False, True]
    assert made.operations[0].orientation.reasons == ("no axis found: face 1 is made of water",)


def test_a_face_with_a_kink_is_divided_there(tmp_path: Path) -> None:
    from toolaxis.job.files.plan_folder import read_plan, write_plan

    x = np.linspace(0, 24, 7)
    roof = [[[a, b, 8 - 0.3 * abs(a - 12)] for b in (0.0, 5.0, 10.0, 16.0)] for a in x]
    knots = ([0, 0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1, 1], [0, 0, 0, 0, 1, 1, 1, 1])
    face = ta.Face.from_bspline(roof, knots=knots)
    from toolaxis.shape.kinks import with_kinks

    made = ta.plan(ta.Part.from_faces([with_kinks(face)]), "ball:6", 0.1, machine="cone:0,0,1,50")
    assert [op.face.label for op in made.operations] == ["1a", "1b"]
    assert made.outcome == "complete"
    write_plan(made, tmp_path)
    back = read_plan(tmp_path)
    for mine, theirs in zip(back.operations, made.operations, strict=True):
        assert mine.name == theirs.name and mine.face.area == pytest.approx(theirs.face.area, rel=1e-12)
    assert sum(op.face.area for op in back.operations) == pytest.approx(24 * 1.09**0.5 * 16, rel=1e-6)
    verdict = ta.verify(made)
    assert verdict.passed, verdict.reasons


def test_a_face_of_a_hundred_small_facets_is_left_in_one_sentence() -> None:
    """A tip cap of plane strips took seven seconds for each of 142 facets."""
    from toolaxis.shape.kinks import with_kinks

    angle = np.radians(2.0) * np.arange(21)
    rim = np.stack([30 * np.sin(angle), 30 * np.cos(angle)], axis=1)
    strip = np.array([[[x, y, z] for y in (0.0, 0.5)] for x, z in rim])
    even = np.concatenate([[0.0], np.linspace(0, 1, 21), [1.0]])
    facets = with_kinks(ta.Face.from_bspline(strip, degree=(1, 1), knots=(even, [0, 0, 1, 1])))
    made = ta.plan(facets, "ball:6", 0.1)
    assert made.outcome == "incomplete" and [op.face.label for op in made.operations] == ["1"]
    why, = made.operations[0].orientation.reasons
    assert why.startswith("face 1 is left entirely as rest material: kinks cut its 10.5 mm2 into 20 facets")
    assert made.operations[0].zones[0].area == pytest.approx(facets.area)
    assert len(smooth_pieces([facets], ta.Tool.ball(1))) == 20


def two_small_faces() -> list[ta.Face]:
    """For what plans them again and again."""
    one, other = (net(height, 4, 4, (12.0, 8.0)) for height in (1.0, 1.2))
    return [ta.Face.from_bspline(one), ta.Face.from_bspline(other + np.array([0.0, 40.0, 0.0]))]


def test_other_methods_are_planned_beside_with_the_same_proofs(tmp_path: Path,
                                                               monkeypatch: pytest.MonkeyPatch) -> None:
    from toolaxis.job.planning import comparison as baselines

    assert baselines.BY_SUB_SURFACE == ("sectors", "roman", "normal")
    monkeypatch.setattr(baselines, "BY_SUB_SURFACE", ("roman", "normal"))  # sectors take half a minute
    faces = two_small_faces()
    made = ta.plan(ta.Part.from_faces(faces), ta.Tool.torus(12, 1, stickout=50, holder=[(10, 0), (10, 40)]), 0.1,
                   machine="cone:0,0,1,12", compare=True, feedrate=500)
    rows = {one.method: one for one in made.baselines}
    assert list(rows) == ["plan", "roman", "normal", "one", "ball"]
    mine = rows["plan"]
    assert (mine.length, mine.travel, mine.seconds) == (made.length, made.travel, made.seconds) and mine.complete
    assert mine.length <= rows["roman"].length
    assert rows["normal"].machined == 0 and "flat bottom" in rows["normal"].reason
    assert rows["one"].complete and rows["one"].orientations == 1 and rows["one"].length >= 0.98 * mine.length
    assert rows["ball"].complete and rows["ball"].tool == "ball:12" and rows["ball"].length > 1.1 * mine.length
    write_plan(made, tmp_path)
    assert read_plan(tmp_path).baselines == made.baselines


def test_iso_parametric_passes_stand_beside_those_in_a_field(monkeypatch: pytest.MonkeyPatch) -> None:
    from toolaxis.job.planning import comparison

    monkeypatch.setattr(comparison, "BY_SUB_SURFACE", ())
    monkeypatch.setattr(comparison, "WHOLE", ())
    part = ta.Part.from_faces([ta.Face.from_bspline(net(1.0))])
    made = ta.plan(part, "ball:8", 0.1, method="normal", passes="scallop", compare=True)
    mine, other = made.baselines
    assert (mine.method, other.method, other.shown) == ("plan", "iso", "iso-parametric passes")
    assert other.length == ta.plan(part, "ball:8", 0.1, method="normal").length != mine.length == made.length


@pytest.mark.parametrize("method", ["one", "ball"])
def test_the_plan_of_a_baseline_is_a_plan_that_passes(method: str) -> None:
    faces = two_small_faces()
    made = ta.plan(ta.Part.from_faces(faces), "torus:12x1", 0.1, method=method, limits="cone:0,0,1,12")
    assert made.outcome == "complete" and made.inputs.method == method
    assert made.tools[0].name == ("ball:12" if method == "ball" else "torus:12x1")
    assert made.orientations == (1 if method == "one" else 2)
    assert ta.verify(made).passed


def test_one_axis_for_faces_that_look_apart_is_not_found() -> None:
    faces = [ta.Face.from_bspline(net(1.0)), ta.Face.from_bspline(net(1.0) * [1, 1, -1], flip=True)]
    made = ta.plan(ta.Part.from_faces(faces), "torus:12x1", 0.1, method="one")
    assert made.outcome == "incomplete" and not any(op.done for op in made.operations)
    assert all("all sub-surfaces allow" in op.orientation.reasons[0] for op in made.operations)


def test_operations_are_carried_out_axis_by_axis() -> None:
    face, x, y = ta.Face.from_bspline(net(1.0)), np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
    named = zip("abcde", (x, y, x, -x, y), strict=True)
    order = by_axis([Target(face.trimmed((), label), axis, True) for label, axis in named])
    assert "".join(target.face.label for target in order) == "acbed"


def test_methods_that_name_their_axes_share_none() -> None:
    with pytest.raises(ta.InvalidInput, match="leave out one of the two"):
        ta.plan(ta.Face.from_bspline(net(1.0)), "torus:12x1", 0.1, method="roman", orientations=2)
