"""Plans with stock that roughing left: what is refused, what is judged, how it is written, and where it is told."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.output.verify import verdict_document, verify_plan
from toolaxis.messages.translate import translate
from toolaxis.plan.plan import Plan
from toolaxis.report.tables import stock_line
from toolaxis.shape.stock import Stock, format_faces
from toolaxis.skin.join import join, take_apart
from toolaxis.tolerances import Tolerance

KEPT = Tolerance(shank_clearance=0.05)
THICK = ta.Tool.ball(6, flute_length=6, stickout=60, shank=[(4, 6), (4, 60)])


def plate(corner: tuple[float, ...], one: tuple[float, ...], two: tuple[float, ...]) -> ta.Face:
    p, a, b = (np.array(row, dtype=float) for row in (corner, one, two))
    return ta.Face.from_bspline(np.array([[p, p + b], [p + a, p + a + b]]), degree=(1, 1))


def slot() -> ta.Part:
    """A floor 1 mm wide between two walls that a shank of radius 4 clears by 0.2 mm at the floor's borders."""
    walls = plate((-4.7, -10, 5), (0, 32, 0), (0, 0, 20)), plate((4.7, -10, 5), (0, 0, 20), (0, 32, 0))
    return ta.Part.from_faces([plate((-0.5, 0, 0), (1, 0, 0), (0, 12, 0)), *walls])


def hill(height: float = 3.0) -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 30, 6), np.linspace(0, 24, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, height * np.sin(np.pi * x / 30) * np.sin(np.pi * y / 24)], -1))


def plan_slot(stock: float, faces: object = "all") -> Plan:
    return ta.plan(slot(), THICK, 0.05, faces=faces, limits="cone:0,0,1,0.3", stock=stock, tolerance=KEPT, workers=1)


def with_stock(plan: Plan, height: float) -> Plan:
    """A plan as if it had been made for stock on all faces."""
    numbers = [number for face in plan.part.faces for number in face.numbers]
    return replace(plan, inputs=replace(plan.inputs, stock=height), part=plan.part.with_stock(height, numbers))


def test_thin_stock_passes_and_thick_stock_is_refused_with_face_and_amount() -> None:
    thin = plan_slot(0.1)
    floor = thin.operations[0]
    assert floor.face.label == "1" and floor.done and floor.orientation.unreached == 0
    assert floor.orientation.clearance["shank"] >= 0.15
    assert ta.verify(thin).operations[0].passed
    thick = plan_slot(0.3)
    assert any(not op.done and "the shank comes within 0.20 mm of face" in why
               and "(finished; 0.3 mm of stock on it)" in why and "0.35 mm is required" in why
               for op in thick.operations if op.face.number == 1 for why in op.orientation.reasons)
    # Walls that are not selected are finished.
    alone = plan_slot(0.3, [1])
    assert alone.outcome == "complete" and ta.verify(alone).passed


def test_stock_that_a_plan_did_not_know_of_is_found_by_the_judge(tmp_path: Path) -> None:
    plan = plan_slot(0.0, [1])
    assert ta.verify(plan).passed
    found = ta.verify(with_stock(plan, 0.3))
    assert not found.passed
    why, = (reason for reason in found.reasons if "shank is" in reason)
    assert "op01-face1: shank is 0.0" in why and "on which 0.3 mm of stock may stand, needed 0.35 mm, on the" in why
    assert "Schruppaufmaß" in translate(why, "german") and " stock " not in translate(why, "german")
    # The same by hand in the file: the faces of operations carry stock even where plan.json does not name them.
    write_plan(plan_slot(0.0), tmp_path)
    document = json.loads((tmp_path / "plan.json").read_text())
    document["inputs"]["stock"] = 0.3
    (tmp_path / "plan.json").write_text(json.dumps(document))
    edited = read_plan(tmp_path)
    assert edited.part.stock == Stock(0.3, frozenset((1, 2, 3)))
    assert any("shank is" in reason for reason in verify_plan(edited).reasons)


def test_a_holder_over_stock_is_found_by_the_judge() -> None:
    held = ta.Tool.ball(6, flute_length=8, stickout=9, holder=[(12, 0), (12, 40)])
    plan = ta.plan(hill(), held, 0.1, workers=1)
    assert ta.verify(plan).passed
    found = ta.verify(with_stock(plan, 9.0))
    assert any("holder is" in why and "9 mm of stock may stand, needed 10 mm" in why for why in found.reasons)


def knoll() -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 15, 6), np.linspace(0, 12, 6), indexing="ij")
    return ta.Face.from_bspline(np.stack([x, y, 1.5 * np.sin(np.pi * x / 15) * np.sin(np.pi * y / 12)], -1))


#: What a fixed axis shows in less time, of the two heights of stock that one of links tells apart.
SLOW = ("sturz", 0.5)


def plan_hill(stock: float, more: dict[str, str]) -> Plan:
    tool = ta.Tool.torus(8, 1, flute_length=16, stickout=50, holder=[(10, 0), (10, 40)])
    return ta.plan(knoll(), tool, 0.2, stock=stock, workers=1, **more)


@pytest.fixture(scope="module")
def bare_hill(request: pytest.FixtureRequest) -> tuple[dict[str, str], Plan]:
    """Options of a plan, and that plan where there is no stock."""
    return request.param, plan_hill(0.0, request.param)


@pytest.mark.parametrize(("bare_hill", "stock"), [
    pytest.param(more, stock, id=f"{name}-{stock}", marks=[pytest.mark.long] * (stock == 2.5 or (name, stock) == SLOW))
    for name, more in (("fixed", {}), ("sturz", {"strategy": "sturz"})) for stock in (0.5, 2.5, 7.0)],
    indirect=["bare_hill"])
def test_rapid_moves_end_above_stock(stock: float, bare_hill: tuple[dict[str, str], Plan]) -> None:
    more, bare = bare_hill
    plan = plan_hill(stock, more)
    assert plan.outcome == bare.outcome == "complete"
    assert ta.verify(plan).passed
    face = plan.part.faces[0]
    points = face.evaluate(face.grid(40, 40)).point
    path = plan.operations[0].path
    assert path is not None
    for k in np.flatnonzero(path.kind[1:] == Motion.LINK) + 1:
        for share in np.linspace(0, 1, 20):
            tip, axis = (rows[k - 1] + share * (rows[k] - rows[k - 1]) for rows in (path.cl, path.axis))
            z = (points - tip) @ axis
            rho = np.sqrt(np.maximum(((points - tip) ** 2).sum(axis=1) - z**2, 0.0))
            apart = np.where(z < 1, np.hypot(np.maximum(rho - 3, 0), z - 1) - 1, rho - 4)
            assert apart.min() >= stock + 0.1
    # Passes are about as long; links of a plan that knows of no stock end 5 mm above faces here.
    assert plan.length == pytest.approx(bare.length, rel=0.2)
    told = [why for why in ta.verify(with_stock(bare, stock)).reasons if "cutter at rapid traverse" in why]
    assert bool(told) == (stock > 5)


def test_what_is_written_comes_back_and_is_told(tmp_path: Path) -> None:
    plan = ta.plan(ta.Part.from_faces([hill(), plate((40, 0, 0), (9, 0, 0), (0, 9, 0))]), "ball:8", 0.2, faces=[1],
                   stock=0.4, allowance=0.1, workers=1)
    write_plan(plan, tmp_path)
    document = json.loads((tmp_path / "plan.json").read_text())
    assert document["inputs"]["stock"] == 0.4 and document["part"]["stock_faces"] == [1]
    back = read_plan(tmp_path)
    assert back.part.stock == Stock(0.4, frozenset((1,))) and back.inputs == plan.inputs
    verdict = verify_plan(back)
    assert verdict.passed
    record = verdict_document(back, verdict)["operations"][0]
    assert record["stock"] == 0.4 and record["clearance_from_stock_faces"]["cutter at rapid traverse"] > 0.5
    assert stock_line(back).startswith("stock: up to 0.4 mm above face 1, all other faces finished;")
    assert stock_line(ta.plan(hill(), "ball:8", 0.2, workers=1)) == ""


def test_joined_faces_and_taken_apart_ones_keep_stock() -> None:
    x, y = np.meshgrid(np.linspace(0, 20, 4), np.linspace(0, 20, 4), indexing="ij")
    two = [ta.Face.from_bspline(np.stack([x + shift, y, 0 * x], -1)) for shift in (0.0, 20.0)]
    part = join(ta.Part.from_faces(two), (1, 2)).with_stock(0.3, [2])
    assert part.stock_on(part.faces[0]) == 0.3
    apart = take_apart(part, [1])
    assert apart.stock == part.stock and [apart.stock_on(face) for face in apart.faces] == [0.0, 0.3]


@pytest.mark.parametrize("height, faces, said", [
    (0.0, [1], "stock is 0.0 mm: it must be above zero"), (float("inf"), [1], "stock is inf mm"),
    (0.3, [], "no face carries it"), (0.3, [9], "face 9 is said to carry stock and is not in the part"),
    (45.0, [1], "stock is 45 mm and the whole part measures 38")])
def test_stock_that_makes_no_sense(height: float, faces: list[int], said: str) -> None:
    with pytest.raises(ta.InvalidInput, match=said) as raised:
        ta.Part.from_faces([hill()]).with_stock(height, faces)
    assert "Schruppaufmaß" in translate(str(raised.value), "german")


def test_faces_in_words() -> None:
    assert format_faces([7]) == "face 7" and format_faces([8, 3, 5, 6, 7]) == "faces 3, 5-8"
