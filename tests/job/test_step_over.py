"""Plans whose passes lie no farther apart than asked for, whatever the scallop height allows, and the judge of them."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import toolaxis as ta
from toolaxis.batch.jobfile import read_jobs
from toolaxis.cldata.toolpath import Motion
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.output.verify import verdict_document, verify_plan
from toolaxis.messages.translate import translate
from toolaxis.path.estimate import Estimator
from toolaxis.path.parametrization import Cut, IsoChart
from toolaxis.path.pass_layout import lay_out
from toolaxis.plan.plan import Plan
from toolaxis.report.tables import step_over_line

MOST = 0.5
WIDE = 1.0  # for what costs most: still narrower than the passes of a plan that knows of none


def hill(height: float = 1.0, length: float = 15.0) -> ta.Face:
    """As long as is said, and four fifths as wide."""
    width = 0.8 * length
    x, y = np.meshgrid(np.linspace(0, length, 6), np.linspace(0, width, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, height * np.sin(np.pi * x / length) * np.sin(np.pi * y / width)], -1))


def plate(corner: tuple[float, ...], one: tuple[float, ...], two: tuple[float, ...]) -> ta.Face:
    p, a, b = (np.array(row, dtype=float) for row in (corner, one, two))
    return ta.Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


def plan_hill(most: float, tool: object = "torus:8x1", **more: object) -> Plan:
    return ta.plan(hill(), tool, 0.05, workers=1, greatest_step_over=most, **more)  # type: ignore[arg-type]


def asked_afterwards(plan: Plan, most: float) -> Plan:
    """A plan as if it had been made for a greatest step-over."""
    return replace(plan, inputs=replace(plan.inputs, greatest_step_over=most))


def farthest_from_contacts(plan: Plan, face: ta.Face) -> float:
    """How far any place of a dense grid on a face lies from the nearest contact of the passes as they were planned."""
    rows = []
    for op in plan.operations:
        assert op.path is not None
        cut = np.flatnonzero(op.path.kind[1:] == Motion.CUT) + 1
        for share in np.linspace(0, 1, 30):
            rows.append(op.path.cc[cut - 1] + share * (op.path.cc[cut] - op.path.cc[cut - 1]))
    places = face.evaluate(face.grid(150, 150)).point
    return float(cKDTree(np.concatenate(rows)).query(places)[0].max())


@pytest.fixture(scope="module")
def plain() -> Plan:
    return plan_hill(0.0)


@pytest.mark.parametrize("most, tool, more", [
    (MOST, "torus:8x1", {}), pytest.param(MOST, "ball:8", {}, marks=pytest.mark.long), (MOST, "flat:8", {}),
    (WIDE, "ball:8", {"passes": "planes"}), (WIDE, "torus:8x1", {"strategy": "sturz"}),
    pytest.param(WIDE, "ball:8", {"passes": "scallop", "method": "normal"}, marks=pytest.mark.long),
    (WIDE, "ball:8", {"regions": 2, "limits": "cone:0,0,1,20"})])
def test_no_place_is_farther_from_a_pass_than_half_of_it(most: float, tool: str, more: dict[str, object]) -> None:
    made = plan_hill(most, tool, **more)
    assert made.outcome == "complete"
    assert 0.42 * most < farthest_from_contacts(made, hill()) <= 0.5 * most
    verdict = ta.verify(made)
    assert verdict.passed, verdict.reasons
    found = [op.step_over.distance for op in verdict.operations if op.step_over is not None]
    assert found and 0.9 * most < max(found) <= 1.02 * most


@pytest.mark.long
def test_4_plus_1_axes_keep_it_too() -> None:
    made = plan_hill(WIDE, strategy="four-plus-one", machine="mikron-ucp-710")
    assert made.outcome == "complete" and farthest_from_contacts(made, hill()) <= 0.5 * WIDE
    assert ta.verify(made).passed


def test_a_plan_that_did_not_know_of_it_fails(plain: Plan) -> None:
    assert farthest_from_contacts(plain, hill()) > MOST
    found = ta.verify(asked_afterwards(plain, MOST))
    assert not found.passed
    why, = (reason for reason in found.reasons if "apart" in reason)
    apart = float(why.split("passes lie ")[1].split()[0])
    assert apart == pytest.approx(2 * farthest_from_contacts(plain, hill()), rel=0.05)
    assert "allowed 0.5 mm, on face 1 at (" in why
    assert "Bahnen liegen" in translate(why, "german")


def test_a_pass_that_is_missing_fails_though_the_scallop_holds() -> None:
    made = plan_hill(MOST)
    op = made.operations[0]
    path = op.path
    assert path is not None
    starts = np.flatnonzero((path.kind[1:] == Motion.CUT) & (path.kind[:-1] != Motion.CUT))
    first, last = starts[len(starts) // 2], starts[len(starts) // 2 + 1]
    assert path.passes > 20
    kind = path.kind.copy()
    kind[first + 1:last + 1] = Motion.LINK  # what runs there is no pass any more: it is lifted
    cl = path.cl.copy()
    cl[first:last] += 30.0 * path.axis[0]
    planted = replace(made, operations=(replace(op, path=replace(path, cl=cl, kind=kind)),))
    found = ta.verify(planted)
    assert found.operations[0].scallop_max <= 0.05 and found.operations[0].share_within > 0.999
    why, = (reason for reason in found.reasons if "apart" in reason)
    assert float(why.split("passes lie ")[1].split()[0]) == pytest.approx(2 * MOST, rel=0.05)


def test_one_that_is_wider_than_all_strips_changes_nothing(plain: Plan) -> None:
    wide = plan_hill(30.0)
    assert wide.length == pytest.approx(plain.length, abs=1e-9)
    assert np.array_equal(wide.axes, plain.axes)
    assert ta.verify(wide).operations[0].step_over is None


def test_beside_a_wall_nothing_is_asked_for_where_no_pass_goes() -> None:
    part = ta.Part.from_faces([plate((0, 0, 0), (30, 0, 0), (0, 20, 0)), plate((0, 20, 0), (30, 0, 0), (0, 0, 15))])
    made = ta.plan(part, "ball:8", 0.05, faces=[1], workers=1, greatest_step_over=0.3, limits="cone:0,0,1,30")
    assert made.outcome == "complete"
    verdict = ta.verify(made)
    assert verdict.passed, verdict.reasons


def test_around_a_pin_nothing_is_asked_for_where_the_tool_cannot_stand() -> None:
    """A flat bottom leaves little beside the pin, so that no zone is declared there, and passes end before it."""
    pin = [plate((14, 9, 0), (2, 0, 0), (0, 0, 20)), plate((14, 11, 0), (2, 0, 0), (0, 0, 20)),
           plate((14, 9, 0), (0, 2, 0), (0, 0, 20)), plate((16, 9, 0), (0, 2, 0), (0, 0, 20))]
    part = ta.Part.from_faces([plate((0, 0, 0), (30, 0, 0), (0, 20, 0)), *pin])
    made = ta.plan(part, "torus:8x1", 0.1, faces=[1], workers=1, greatest_step_over=0.5, limits="cone:0,0,1,8")
    assert made.outcome == "complete"
    verdict = ta.verify(made)
    assert verdict.passed, verdict.reasons


def test_prices_of_axes_know_of_it() -> None:
    tool, axes = ta.Tool.torus(8, 1), np.array([[0.3, 0.1, 0.9], [0.0, 0.4, 0.9]])
    plain, capped = (Estimator.of(hill(3.0, 30.0), tool, 0.05, greatest_step_over=most).many(axes, exact=False)
                     for most in (np.inf, 0.3))
    lengths = 24 / 0.3, 30 / 0.3
    assert (capped.passes > 1.5 * plain.passes).all()
    assert np.allclose(capped.passes, [lengths, lengths], rtol=0.15)


def test_a_rack_keeps_it() -> None:
    made = plan_hill(MOST, ["torus:8x1", "ball:4"])
    assert made.outcome == "complete" and ta.verify(made).passed
    assert farthest_from_contacts(made, hill()) <= 0.5 * MOST


@pytest.mark.parametrize("most, said", [(-1.0, "greatest step-over is -1.0 mm: it must be finite and above zero"),
                                        (0.04, "is 0.04 mm, below the scallop height of 0.05 mm: give"),
                                        (float("inf"), "greatest step-over is inf mm"),
                                        (float("nan"), "greatest step-over is nan mm")])
def test_step_overs_that_make_no_sense(most: float, said: str) -> None:
    with pytest.raises(ta.InvalidInput, match=said) as raised:
        plan_hill(most)
    assert "größter Bahnabstand" in translate(str(raised.value), "german")


def test_one_that_asks_for_too_many_passes_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    import toolaxis.path.step_over

    monkeypatch.setattr(toolaxis.path.step_over, "_MOST_PASSES", 30)
    for most, what in ((np.inf, "scallop height"), (0.3, "greatest step-over")):
        cut = Cut(ta.Tool.ball(8), np.array([0.0, 0, 1]), 0.001, greatest_step_over=most)
        with pytest.raises(ta.InvalidInput, match=f"the {what} is too small for its size") as raised:
            lay_out(IsoChart(hill(), "u"), cut)
        assert "zu klein" in translate(str(raised.value), "german")


@pytest.mark.parametrize("strategy, tool", [("two-point", "torus:8x1"), ("blade", "ball:8"), ("blade-keys", "ball:8"),
                                            ("multiscale", "torus:8x1")])
def test_strategies_with_a_rule_of_their_own_refuse_it(strategy: str, tool: str) -> None:
    with pytest.raises(ta.InvalidInput, match=f"strategy '{strategy}' lays its passes by a rule of its own") as raised:
        plan_hill(MOST, tool, strategy=strategy, machine="mikron-ucp-710")
    assert "nach einer eigenen Regel" in translate(str(raised.value), "german")


def test_it_is_written_and_told(tmp_path: Path) -> None:
    made = plan_hill(MOST, "ball:8")
    write_plan(made, tmp_path)
    document = json.loads((tmp_path / "plan.json").read_text())
    assert document["inputs"]["greatest_step_over"] == MOST
    back = read_plan(tmp_path)
    assert back.inputs == made.inputs
    verdict = verify_plan(back)
    assert 0.45 < verdict_document(back, verdict)["operations"][0]["step_over"] <= 0.51
    assert step_over_line(back) == "passes lie 0.5 mm apart at most, whatever the scallop height allows"
    del document["inputs"]["greatest_step_over"]  # plans from before know of none
    (tmp_path / "plan.json").write_text(json.dumps(document))
    assert step_over_line(read_plan(tmp_path)) == ""


def test_a_job_of_a_batch_gives_it() -> None:
    job, = read_jobs([{"name": "one", "part": ta.Part.from_faces([hill()]), "tool": "ball:8", "scallop": 0.1,
                       "greatest_step_over": 0.4}])
    assert job.spec.inputs.greatest_step_over == 0.4 and job.task().options["greatest_step_over"] == 0.4
