"""Plans whose ball ends lean from every normal by a least angle, what is refused, and what the judge measures."""

import json
from dataclasses import replace
from math import degrees, pi, radians
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.batch.jobfile import read_jobs
from toolaxis.cldata.toolpath import Motion
from toolaxis.feasibility.violations import WANDERS
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.output.verify import verdict_document, verify_plan
from toolaxis.messages.translate import translate
from toolaxis.path.moving_axis import ConstantLeadField, MovingChart, MovingCut
from toolaxis.plan.plan import Plan
from toolaxis.report.tables import lean_line
from toolaxis.search.face_problem import task
from toolaxis.strategies.common.passes import plan_passes
from toolaxis.tolerances import Tolerance
from toolaxis.verify import contact_leans

LEAN = radians(12)


def hill(height: float = 2.0) -> ta.Face:
    """Of 15 times its height along and 12 times across, so that all hills are as steep."""
    x, y = np.meshgrid(np.linspace(0, 15 * height, 6), np.linspace(0, 12 * height, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, height * np.sin(np.pi * x / 15 / height)
                                          * np.sin(np.pi * y / 12 / height)], -1))


def plan_hill(lean: float, tool: str | ta.Tool = "ball:8", height: float = 2.0, **more: object) -> Plan:
    return ta.plan(hill(height), tool, 0.1, workers=1, least_lean=lean, **more)  # type: ignore[arg-type]


def asked_afterwards(plan: Plan, lean: float) -> Plan:
    """A plan as if it had been made for a least lean."""
    return replace(plan, inputs=replace(plan.inputs, tolerance=replace(plan.inputs.tolerance, least_lean=lean)))


def leans_by_force(plan: Plan, radius: float) -> np.ndarray:
    """Angles of axes and normals at contacts: at the point of a dense grid that is nearest to the ball's centre."""
    op = plan.operations[0]
    assert op.path is not None
    grid = op.face.grid(400, 400)
    points, normals = op.face.evaluate(grid).point, op.face.normal(grid)
    rows = np.flatnonzero(op.path.kind == Motion.CUT)[::7]
    axes = op.path.axis[rows]
    found = []
    for centre, axis in zip(op.path.cl[rows] + radius * axes, axes, strict=True):
        gap = np.linalg.norm(points - centre, axis=1)
        near = int(np.argmin(gap))
        if gap[near] <= radius + 0.005:
            found.append(np.arccos(np.clip(normals[near] @ axis, -1, 1)))
    return np.array(found)


@pytest.fixture(scope="module")
def plain() -> Plan:
    return plan_hill(0.0)


@pytest.fixture(scope="module")
def leaning() -> Plan:
    return plan_hill(LEAN)


def test_a_fixed_axis_leans_from_all_normals(plain: Plan, leaning: Plan) -> None:
    assert leaning.outcome == "complete"
    axis = leaning.operations[0].orientation.axis
    normals = hill().normal(hill().grid(200, 200))
    assert axis is not None and np.arccos(normals @ axis).min() >= LEAN
    assert leans_by_force(leaning, 4.0).min() >= LEAN - radians(0.3)
    # Without it the axis stands on a normal somewhere, and the length of a ball end's passes is that of any axis.
    upright = plain.operations[0].orientation.axis
    assert upright is not None and np.arccos(normals @ upright).min() < radians(1)
    assert leaning.length == pytest.approx(plain.length, rel=1e-3)
    assert any("too near to a normal for the least lean" in why for why in leaning.operations[0].orientation.reasons)


def test_the_judge_measures_it_and_fails_a_plan_that_did_not_know_of_it(plain: Plan, leaning: Plan) -> None:
    verdict = ta.verify(leaning)
    assert verdict.passed
    found = verdict.operations[0].lean
    normals = hill().normal(hill().grid(200, 200))
    axis = leaning.operations[0].orientation.axis
    assert found is not None and found.angle >= LEAN
    assert found.angle == pytest.approx(np.arccos(normals @ axis).min(), abs=radians(0.5))
    assert ta.verify(plain).operations[0].lean is None
    planted = ta.verify(asked_afterwards(plain, LEAN))
    assert not planted.passed
    why, = (reason for reason in planted.reasons if "leans" in reason)
    assert "the ball end leans 1." in why and "from the normal of face 1 at (" in why and "needed 12 deg, on the" in why
    assert "Kugelfräser neigt sich" in translate(why, "german")


def test_a_lean_is_measured_at_the_contact_itself() -> None:
    """On a sphere of radius 9, with the ball's centre over contacts whose normals are known."""
    cap = np.linspace(-0.9, 0.9, 31)
    u, v = np.meshgrid(cap, cap, indexing="ij")
    way = np.stack([u, v, np.ones_like(u)], axis=-1)
    sphere = ta.Face.from_bspline(9 * way / np.linalg.norm(way, axis=-1, keepdims=True))
    uv = np.linspace(0.2, 0.7, 40)[:, None] * [1.0, 0.6] + [0.05, 0.15]
    axis = np.array([-0.3, 0.4, 0.866]) / np.linalg.norm([-0.3, 0.4, 0.866])
    tool, allowance = ta.Tool.ball(6), 0.2
    tips = ta.place(sphere, tool, uv, axis) + allowance * sphere.normal(uv)
    kind = np.array([Motion.ENTRY, *[Motion.CUT] * 39], dtype=np.int8)
    found = contact_leans.least_lean((tips, np.tile(axis, (40, 1)), kind), tool.profile, (sphere,), (allowance, 0.1))
    angles = np.arccos(sphere.normal(uv) @ axis)
    assert found is not None and found.angle == pytest.approx(angles.min(), abs=2e-4)
    contact = sphere.evaluate(uv[[np.argmin(angles)]]).point[0]
    assert np.linalg.norm(np.array(found.point) - contact) < 0.1
    # The same, too high to touch, leans nowhere.
    high = tips + 0.2 * sphere.normal(uv)
    assert contact_leans.least_lean((high, np.tile(axis, (40, 1)), kind), tool.profile, (sphere,),
                                    (allowance, 0.1)) is None


def test_an_axis_that_moves_leans_too() -> None:
    made = plan_hill(LEAN, strategy="sturz")
    assert made.outcome == "complete" and made.operations[0].orientation.lead is not None
    assert leans_by_force(made, 4.0).min() >= LEAN - radians(0.3)
    verdict = ta.verify(made)
    assert verdict.passed and verdict.operations[0].lean is not None
    assert verdict.operations[0].lean.angle == pytest.approx(LEAN + radians(1), abs=radians(2))
    plain = plan_hill(0.0, strategy="sturz")
    assert leans_by_force(plain, 4.0).min() < LEAN - radians(2)
    assert any("the ball end leans" in why for why in ta.verify(asked_afterwards(plain, LEAN)).reasons)


def test_passes_that_do_not_lean_enough_are_refused_as_they_were_made() -> None:
    job = task(hill(), ta.Tool.ball(8), 0.1, tolerance=Tolerance(least_lean=LEAN))
    for lead, refused in ((LEAN - radians(1), True), (LEAN + radians(1), False)):
        cut = MovingCut(job.worth.tool, np.array([0.0, 0, 1]), 0.1, field=ConstantLeadField(lead, "u"))
        found = plan_passes(job, MovingChart(hill(), "u"), cut).witness
        assert (found is not None and found.reason == WANDERS) == refused
        if found is not None:
            assert found.amount == pytest.approx(radians(1), abs=radians(0.1))


def test_4_plus_1_axes_lean_too() -> None:
    made = plan_hill(LEAN, height=1.0, strategy="four-plus-one", machine="mikron-ucp-710")
    assert made.outcome == "complete"
    assert leans_by_force(made, 4.0).min() >= LEAN - radians(0.3)
    assert ta.verify(made).passed


def test_a_cutter_with_a_flat_bottom_goes_by_its_own_rule() -> None:
    with pytest.raises(ta.InvalidInput, match=r"least lean is 12 deg and no ball end is among .* .torus:12x1.: "):
        plan_hill(LEAN, "torus:12x1")
    with pytest.raises(ta.InvalidInput, match=r"no ball end is among the tools .*flat:6"):
        plan_hill(LEAN, ["torus:12x1", "flat:6"])  # type: ignore[arg-type]
    both = ta.plan(hill(), ["torus:6x1", "ball:6"], 0.1, workers=1, least_lean=radians(40))
    assert any(op.done and op.tool.flat_radius > 0 for op in both.operations)
    assert Tolerance(least_lean=LEAN).least_angle(5.0) == Tolerance().min_lead


def test_a_dome_is_divided_where_one_axis_cannot_lean() -> None:
    """Seen from above, the normals of a dome of 50 degrees leave no axis that leans 30 degrees from all of them."""
    angle = np.linspace(-radians(50), radians(50), 12)
    x, y = np.meshgrid(20 * np.sin(angle), np.linspace(0, 20, 6), indexing="ij")
    dome = ta.Face.from_bspline(np.stack([x, y, np.sqrt(400 - x**2)], -1))
    made = ta.plan(dome, "ball:6", 0.1, workers=1, least_lean=radians(30))
    for op in made.operations:
        if op.done:
            normals = op.face.normal(op.face.grid(100, 100))
            assert np.arccos(np.clip(normals @ op.orientation.axis, -1, 1)).min() >= radians(30)
    assert made.account.machined > 0.9 * made.account.area
    assert ta.verify(made).passed == (made.outcome == "complete")


def test_no_axis_is_told_with_the_lean() -> None:
    made = ta.plan(hill(), "ball:8", 0.1, workers=1, least_lean=radians(50), limits="cone:0,0,1,10")
    op = made.operations[0]
    assert not op.done and op.orientation.outcome in ("infeasible", "not_found")
    told = " ".join(op.orientation.reasons)
    assert "too near to a normal for the least lean" in told or "the least lean of a ball end is 50.00 deg" in told
    assert all("least lean" not in translate(why, "german") for why in op.orientation.reasons)


@pytest.mark.parametrize("lean, said", [
    (-0.1, "least lean is -5.7.* deg: it must be a number from 0 to below 90 deg"), (pi / 2, "least lean is 90 deg"),
    (float("nan"), "least lean is nan deg")])
def test_leans_that_make_no_sense(lean: float, said: str) -> None:
    with pytest.raises(ta.InvalidInput, match=said) as raised:
        plan_hill(lean)
    assert "kleinster Anstellwinkel" in translate(str(raised.value), "german")


def test_what_does_not_go_with_it() -> None:
    with pytest.raises(ta.InvalidInput, match=r"tool tapered.* reaches 80 deg from its axis at most"):
        plan_hill(radians(85), ta.Tool.tapered(diameter=6, corner_radius=3, half_angle_deg=10))
    for strategy in ("blade", "blade-keys"):
        with pytest.raises(ta.InvalidInput, match="swings the axis about the ball's centre and keeps no least lean"):
            plan_hill(LEAN, strategy=strategy, machine="mikron-ucp-710")


def test_it_is_written_and_told(leaning: Plan, tmp_path: Path) -> None:
    write_plan(leaning, tmp_path)
    document = json.loads((tmp_path / "plan.json").read_text())
    assert document["inputs"]["tolerance"]["least_lean"] == LEAN
    back = read_plan(tmp_path)
    assert back.inputs == leaning.inputs
    verdict = verify_plan(back)
    assert verdict_document(back, verdict)["operations"][0]["least_lean"] >= LEAN
    assert lean_line(back) == "ball ends lean 12 deg at least from the normal at every contact"
    # Plans from before know of none.
    del document["inputs"]["tolerance"]["least_lean"]
    (tmp_path / "plan.json").write_text(json.dumps(document))
    assert read_plan(tmp_path).inputs.tolerance.least_lean == 0.0
    assert lean_line(read_plan(tmp_path)) == ""


def test_a_job_of_a_batch_gives_it_in_degrees() -> None:
    job, = read_jobs([{"name": "one", "part": ta.Part.from_faces([hill()]), "tool": "ball:8", "scallop": 0.1,
                       "least_lean": 12, "tolerance": 0.02}])
    assert degrees(job.spec.inputs.tolerance.least_lean) == pytest.approx(12)
    assert job.spec.inputs.tolerance.gouge == 0.02 and job.task().options["tolerance"].least_lean == radians(12)
    with pytest.raises(ta.InvalidInput, match="no ball end is among the tools"):
        read_jobs([{"name": "one", "part": ta.Part.from_faces([hill()]), "tool": "flat:8", "scallop": 0.1,
                    "least_lean": 12}])
