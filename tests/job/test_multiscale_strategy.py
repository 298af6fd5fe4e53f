"""Strip width and roughness together through the doors: planned, read back, judged; refused where it makes no sense."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.cli.main import main
from toolaxis.errors import InvalidInput
from toolaxis.feed.continuous_ik import following
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.shape.nearest import nearest
from toolaxis.strategies.roughness.pictures import draw_roughness, front_picture, study
from toolaxis.strategies.roughness.roughness import arithmetic_roughness
from toolaxis.strategies.roughness.section_width import (
    expect_widths,
    section_parameters,
    section_points,
    section_width,
)
from toolaxis.verify.material_removal import removal

H, RA = 0.1, 1.6e-3


def hill(size: float = 3.0) -> ta.Face:
    x, y = np.meshgrid(np.linspace(-size, size, 4), np.linspace(-size, size, 4), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, 3.0 + 0.15 * x - 0.004 * x**2 - 0.006 * y**2 + 0.002 * x * y], axis=-1))


@pytest.fixture(scope="module")
def plan():
    return ta.plan(hill(), "torus:10x3", H, strategy="multiscale", machine="bc-table-table", feedrate=800, workers=1)


def test_the_judge_passes_it_and_finds_the_roughness(plan) -> None:
    op = plan.operations[0]
    assert plan.outcome == "complete" and plan.inputs.roughness == RA, op.orientation.reasons
    verdict = ta.verify(plan)
    assert verdict.passed, verdict.reasons
    # Ra from the judge's removal along profiles across the feed.
    face, path = op.face, op.path
    uv = np.array([[0.5, 0.5], [0.35, 0.5], [0.65, 0.45]])
    at = section_parameters(face, uv, np.linspace(-2, 2, 241), op.orientation.feed)
    points, normal = section_points(face, at)
    left = removal((path.cl, path.axis, path.kind), op.tool.profile, (points.reshape(-1, 3), normal.reshape(-1, 3)),
                   depth=0.05, height=0.5)
    judged = arithmetic_roughness(left.remaining.reshape(3, -1))
    assert (judged < 1.1 * RA).all() and (judged > 0.3 * RA).all()


def test_strips_are_as_wide_as_expected_and_the_machine_follows(plan) -> None:
    op = plan.operations[0]
    cut = op.path.kind == Motion.CUT
    found = nearest(op.face, op.path.cc[cut])
    inside = (found.distance < 1e-6) & ((found.uv > 0.02) & (found.uv < 0.98)).all(axis=1)
    uv, axis = found.uv[inside][::3], op.path.axis[cut][inside][::3]
    wide = section_width(op.face, plan.tools[0], uv, axis, H, op.orientation.feed).sum(axis=1)
    low, high = expect_widths(plan.tools[0], np.radians(20.0), H)
    assert len(wide) > 20 and wide.min() > low - 5e-3 and wide.max() < high + 5e-3
    assert len(following(plan.machine.machine, op.path).rotary) >= len(op.path.cl)
    assert any("um allowed" in why for why in op.orientation.reasons)


def test_the_picture_shows_what_the_plan_says(plan, tmp_path) -> None:
    op = plan.operations[0]
    seen = study(plan, op)
    assert f"Ra {seen.roughness.mean():.2f}" in op.orientation.reasons[0][:7]
    assert len(seen.roughness) == 90 and seen.roughness.max() < 1000 * RA
    assert set(seen.velocities) == {"planned", "20° lead"} and seen.axes == ("C", "B")
    fastest = {title: np.abs(rates).max() for title, (_, rates) in seen.velocities.items()}
    assert fastest["planned"] < fastest["20° lead"]
    draw_roughness(plan, op, tmp_path)
    assert (tmp_path / f"{op.name}-roughness.png").stat().st_size > 20000
    front = front_picture([("Sturz", 2.5, 1.4, 42.0), ("", 2.6, 1.2, 0.0), ("", 3.0, 0.8, 4.7)], 1.6)
    assert [len(ax.lines) for ax in front.axes] == [3, 2]


def test_it_is_read_back(plan, tmp_path) -> None:
    write_plan(plan, tmp_path)
    again = read_plan(tmp_path)
    assert again.inputs.method == "multiscale" and again.inputs.roughness == RA
    np.testing.assert_allclose(again.operations[0].path.axis, plan.operations[0].path.axis, atol=1e-8)


@pytest.mark.long
def test_the_command_plans_a_whole_step_face_and_the_judge_passes_it(tmp_path, capsys) -> None:
    cadquery = pytest.importorskip("cadquery")
    rows = [[cadquery.Vector(x, y, 2 - 0.02 * (x - 1) ** 2 - 0.01 * y**2) for y in np.linspace(0, 4.5, 4)]
            for x in np.linspace(0, 2.4, 4)]
    sheet = cadquery.Face.makeSplineApprox(rows, tol=1e-3, minDeg=3, maxDeg=3)
    cadquery.exporters.export(cadquery.Workplane(obj=sheet), str(tmp_path / "hill.step"))
    out = str(tmp_path / "out")
    assert main(["plan", str(tmp_path / "hill.step"), "--tool", "torus:10x3", "--scallop", "0.1", "--strategy",
                 "multiscale", "--machine", "bc-table-table", "--feedrate", "800", "--no-pictures", "--out", out]) == 0
    assert main(["verify", out, "--no-pictures"]) == 0
    op, = read_plan(tmp_path / "out").operations
    told = op.orientation.reasons[0]
    assert told.startswith("Ra ") and float(told.split(" um in the mean and ")[1].split(" um at most")[0]) <= 1.6
    assert "pass" in capsys.readouterr().out


@pytest.mark.parametrize("given, what", [
    ({"tool": "ball:10"}, "the radius of the cutter"), ({"tool": "flat:10"}, "a sharp corner"),
    ({"machine": None}, "name a machine"), ({"machine": "three-axes-fixture"}, "needs two driven rotary axes"),
    ({"roughness": 0.0}, "roughness is 0 um"), ({"objective": "time"}, "not time: leave out"),
    ({"strategy": "sturz"}, "applies to strategy 'multiscale' only"),
    ({"strategy": "indexed"}, "applies to strategy 'multiscale' only")])
def test_what_makes_no_sense_is_refused(given, what) -> None:
    asked = {"tool": "torus:10x3", "machine": "bc-table-table", "strategy": "multiscale", "roughness": RA} | given
    with pytest.raises(InvalidInput, match=what):
        ta.plan(hill(), scallop=H, workers=1, **asked)


def test_a_scallop_below_that_of_the_roughness_is_told() -> None:
    made = ta.plan(hill(), "torus:10x3", 0.005, strategy="multiscale", machine="bc-table-table", workers=1)
    assert made.outcome == "incomplete"
    assert "Ra 1.6 um stands for scallops of 0.00624 mm" in made.operations[0].orientation.reasons[0]


def test_a_scallop_too_high_for_the_cutter_is_told_with_the_strips_that_it_leaves() -> None:
    made = ta.plan(hill(), "torus:6x1", 0.3, strategy="multiscale", machine="bc-table-table", workers=1)
    assert made.outcome == "incomplete"
    assert "strips are 3.6" in (why := made.operations[0].orientation.reasons[0]) and "a smaller scallop height" in why


def test_the_command_takes_micrometres(capsys) -> None:
    told = main(["plan", "none.step", "--tool", "torus:10x3", "--scallop", "0.1", "--roughness", "-2", "--strategy",
                 "multiscale", "--machine", "bc-table-table"])
    assert told == 2 and "roughness is -2 um" in capsys.readouterr().err
