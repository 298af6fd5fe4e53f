"""Arcs of lead-in and lead-out: tangential where they are proven free, straight elsewhere, and the judge of both."""

import json
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.batch.jobfile import read_jobs
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.output.verify import verdict_document, verify_plan
from toolaxis.messages.translate import translate
from toolaxis.path.links import LeadArcs
from toolaxis.plan.plan import Plan
from toolaxis.report.tables import lead_line

RADIUS = 2.0


def hill(height: float = 3.0) -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 30, 6), np.linspace(0, 24, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, height * np.sin(np.pi * x / 30) * np.sin(np.pi * y / 24)], -1))


def plate(corner: tuple[float, ...], one: tuple[float, ...], two: tuple[float, ...]) -> ta.Face:
    p, a, b = (np.array(row, dtype=float) for row in (corner, one, two))
    return ta.Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


def plan_hill(lead: float = RADIUS, tool: str = "ball:8", **more: object) -> Plan:
    return ta.plan(hill(), tool, 0.1, workers=1, lead=lead, **more)  # type: ignore[arg-type]


def path_of(plan: Plan) -> ToolPath:
    path = plan.operations[0].path
    assert path is not None
    return path


def entries(path: ToolPath) -> list[tuple[int, int]]:
    """First and last row of each run of entries that comes from a link."""
    rows = []
    k = 1
    while k < len(path.kind):
        if path.kind[k] == Motion.ENTRY and path.kind[k - 1] == Motion.LINK:
            end = k
            while path.kind[end + 1] == Motion.ENTRY:
                end += 1
            rows.append((k, end))
            k = end
        k += 1
    return rows


def with_entry(plan: Plan, change: object) -> Plan:
    """A plan whose first lead-in is changed: `change` takes its points and the end of the pass."""
    op, path = plan.operations[0], path_of(plan)
    first, end = entries(path)[0]
    cl = path.cl.copy()
    cl[first:end] = change(cl[first:end], cl[end])  # type: ignore[operator]
    cl[first - 1] = cl[first] + 3.0 * path.axis[0]
    return replace(plan, operations=(replace(op, path=replace(path, cl=cl)),))


@pytest.fixture(scope="module")
def climbing() -> Plan:
    return plan_hill(direction="climb")


def test_a_quarter_of_a_circle_touches_the_pass_and_rises_along_the_normal() -> None:
    arcs = LeadArcs(RADIUS, 0.001, lambda start, end, axes: np.ones(len(start), dtype=bool))
    normal = np.array([0.0, 0.6, 0.8])
    points = arcs.points((np.zeros(3), np.array([1.0, 0, 0])), normal)
    assert np.allclose(points[0], [-RADIUS, 0.6 * RADIUS, 0.8 * RADIUS])
    whole = np.vstack([points, np.zeros(3)])
    assert np.allclose(np.linalg.norm(whole - RADIUS * normal, axis=1), RADIUS)
    middle = (whole[1:] + whole[:-1]) / 2
    sagitta = RADIUS - np.linalg.norm(middle - RADIUS * normal, axis=1)
    assert 0 < sagitta.max() <= 0.001 * (1 + 1e-6)
    assert not len(arcs.points((np.zeros(3), np.zeros(3)), normal))


@pytest.mark.parametrize("tool, more", [
    ("ball:8", {"direction": "climb"}), ("torus:8x1", {}), pytest.param("flat:8", {}, marks=pytest.mark.long),
    pytest.param("ball:8", {"strategy": "sturz"}, marks=pytest.mark.long),
    pytest.param("ball:8", {"passes": "planes"}, marks=pytest.mark.long)])
def test_the_tool_comes_and_goes_on_arcs(tool: str, more: dict[str, object]) -> None:
    plan, plain = plan_hill(tool=tool, **more), plan_hill(0.0, tool, **more)
    assert plan.outcome == "complete" and plan.length == pytest.approx(plain.length, rel=1e-9)
    path = path_of(plan)
    found = entries(path)
    assert len(found) == len(entries(path_of(plain))) > 0
    for first, end in found:
        way, feed = path.cl[end] - path.cl[end - 1], path.cl[end + 1] - path.cl[end]
        turn = np.arccos(way @ feed / np.linalg.norm(way) / np.linalg.norm(feed))
        assert turn <= np.pi / 4 / (end - first) * 1.05, "half of what one chord of a quarter turns by"
        rise = (path.cl[first] - path.cl[end]) @ path.normal[end]
        assert rise == pytest.approx(RADIUS, rel=0.05)
    verdict = ta.verify(plan)
    assert verdict.passed, verdict.reasons
    leads = verdict.operations[0].leads
    assert leads is not None and leads.arcs == leads.ends == 2 * len(found)
    assert ta.verify(plain).operations[0].leads is None


def test_where_an_arc_is_not_free_the_way_is_straight_as_before() -> None:
    """Arcs of 12 mm run into a wall that stands 9 mm behind the ends of the passes; those at the other end are free."""
    floor, wall = plate((0, 0, 0), (30, 0, 0), (0, 8, 0)), plate((39, -30, -1), (0, 70, 0), (0, 0, 60))
    part = ta.Part.from_faces([floor, wall])
    for lead, share in ((0.5, 1.0), (12.0, 0.5)):
        plan = ta.plan(part, "ball:4", 0.05, faces=[1], lead=lead, direction="climb", workers=1,
                       limits="cone:0,0,1,1")
        assert plan.outcome == "complete"
        verdict = ta.verify(plan)
        assert verdict.passed, verdict.reasons
        leads = verdict.operations[0].leads
        assert leads is not None and leads.arcs == share * leads.ends


def test_the_judge_fails_arcs_that_are_none(climbing: Plan) -> None:
    assert ta.verify(climbing).passed
    planted = {
        "has a radius of 2.600 mm, and 2 mm are asked for": lambda arc, end: end + 1.3 * (arc - end),
        "meets its pass at": lambda arc, end: end + _turned(arc - end, 3.0, (0, 1)),
        "from the surface's normal, and has to lie in its plane": lambda arc, end: end + _turned(arc - end, 30.0, None)}
    for said, change in planted.items():
        verdict = ta.verify(with_entry(climbing, change), spacing=2.0)
        found = [why for why in verdict.reasons if "lead-in at point" in why]
        assert len(found) == 1 and said in found[0], (said, found)
        german = translate(found[0], "german")
        assert "Einlauf an Punkt" in german and "lead" not in german
    # One of another radius in plan.json.
    asked = ta.verify(replace(climbing, inputs=replace(climbing.inputs, lead=3.0)), spacing=2.0)
    assert any("has a radius of 2.000 mm, and 3 mm are asked for" in why for why in asked.reasons)
    # An arc that dips into the face is a gouge as any motion is.
    low = ta.verify(with_entry(climbing, lambda arc, end: arc - np.array([0, 0, 0.2]) + 0.3 * (end - arc)))
    assert any("gouge" in why for why in low.reasons)


def _turned(way: np.ndarray, angle: float, plane: tuple[int, int] | None) -> np.ndarray:
    """Ways turned within the arc's plane, or about the feed, degrees."""
    far, near, chord = way[0], way[-1], np.pi / 2 / len(way)
    feed = (near - (1 - np.cos(chord)) * far) / (np.sin(chord) - 1 + np.cos(chord)) / RADIUS
    across = np.cross(far, near)
    axis = across / np.linalg.norm(across) if plane is not None else feed
    turn = radians(angle)
    return np.array([row * np.cos(turn) + np.cross(axis, row) * np.sin(turn)
                     + axis * (axis @ row) * (1 - np.cos(turn)) for row in way])


def test_it_is_written_and_told(climbing: Plan, tmp_path: Path) -> None:
    write_plan(climbing, tmp_path)
    document = json.loads((tmp_path / "plan.json").read_text())
    assert document["inputs"]["lead"] == RADIUS
    back = read_plan(tmp_path)
    assert back.inputs == climbing.inputs
    record = verdict_document(back, verify_plan(back))["operations"][0]["lead_arcs"]
    assert record["arcs"] == record["ends"] > 10
    assert lead_line(back) == "lead-in and lead-out: arcs of 2 mm, straight where these are not proven free"
    del document["inputs"]["lead"]
    (tmp_path / "plan.json").write_text(json.dumps(document))
    assert lead_line(read_plan(tmp_path)) == ""


@pytest.mark.parametrize("lead, said", [(-1.0, "radius of lead-in and lead-out is -1.0 mm: it must be zero"),
                                        (float("nan"), "is nan mm"), (101.0, "is 101.0 mm: .* at most 100 mm")])
def test_radii_that_make_no_sense(lead: float, said: str) -> None:
    with pytest.raises(ta.InvalidInput, match=said) as raised:
        plan_hill(lead)
    assert "Auslauf" in translate(str(raised.value), "german")


@pytest.mark.parametrize("strategy, tool", [("two-point", "torus:8x1"), ("blade", "ball:8"),
                                            ("multiscale", "torus:8x1")])
def test_strategies_with_a_rule_of_their_own_refuse_it(strategy: str, tool: str) -> None:
    with pytest.raises(ta.InvalidInput, match=f"strategy '{strategy}' joins its passes by a rule of its own") as raised:
        plan_hill(RADIUS, tool, strategy=strategy, machine="mikron-ucp-710")
    assert "nach einer eigenen Regel" in translate(str(raised.value), "german")


def test_a_job_of_a_batch_gives_it() -> None:
    job, = read_jobs([{"name": "one", "part": ta.Part.from_faces([hill()]), "tool": "ball:8", "scallop": 0.1,
                       "lead": 1.5}])
    assert job.task().options["lead"] == 1.5
