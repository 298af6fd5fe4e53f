"""Warnings: the gravest first, turned copies with their original, and nothing said twice."""

from types import SimpleNamespace
from typing import Any

import pytest

from toolaxis.report.warnings import warnings_of


def op(number: int, *, done: bool = True, left: bool = False, why: str = "", zones: tuple[Any, ...] = ()) -> Any:
    return SimpleNamespace(number=number, name=f"op{number:02d}-face{number}", done=done, left=left, zones=zones,
                           failed=False,
                           face=SimpleNamespace(number=number),
                           orientation=SimpleNamespace(reasons=(why,) if why else (), outcome="not_found"))


def plan(*operations: Any, outcome: str = "complete", copies: dict[int, int] | None = None, **more: Any) -> Any:
    blades = None if copies is None else SimpleNamespace(copies=copies, side_of=lambda number: "")
    given = {"not_checked": (), "part": SimpleNamespace(warnings=()), "machine": None, "in_the_way": (), "faults": (),
             "taken_over": frozenset(), "unplanned": (), **more}
    return SimpleNamespace(operations=operations, outcome=outcome, blades=blades, **given)


def verdict(*operations: dict[str, Any], passed: bool = True, reasons: tuple[str, ...] = ()) -> dict[str, Any]:
    return {"passed": passed, "reasons": list(reasons), "not_checked": [], "operations": list(operations)}


def judged(number: int, passed: bool = True) -> dict[str, Any]:
    return {"name": f"op{number:02d}-face{number}", "passed": passed}


def test_a_plan_in_which_all_is_well_has_none() -> None:
    assert warnings_of(plan(op(1)), verdict(judged(1))) == ()


def test_the_gravest_come_first() -> None:
    found = warnings_of(plan(op(1), op(2, done=False, left=True, why="too tight"), op(3, done=False, why="a wall"),
                             outcome="incomplete", not_checked=("holder",),
                             in_the_way=("the head collides with the table",)), None)
    assert [one.level for one in found] == sorted((one.level for one in found), key=["stop", "mind", "note"].index)
    texts = [one.text for one in found]
    assert texts[0] == "op03-face3 has no axis: a wall"
    assert any(text.startswith("not verified") for text in texts)
    assert texts.index("not checked: holder") < texts.index("op02-face2 is left as rest material: too tight")
    assert "between operations: the head collides with the table" in texts


def test_turned_copies_count_with_their_original() -> None:
    fillets = [op(k, done=False, left=True, why="a tight fillet") for k in (2, 4, 6)]
    found = warnings_of(plan(op(1), op(3), op(5), *fillets, copies={3: 1, 5: 1, 4: 2, 6: 2}),
                        verdict(judged(1), judged(3), judged(5)))
    assert [one.text for one in found] == ["op02-face2 and 2 turned copies are left as rest material: a tight fillet"]


def test_a_copy_that_alone_has_no_axis_is_told() -> None:
    found = warnings_of(plan(op(1), op(2, done=False, why="a wall"), outcome="incomplete", copies={2: 1}),
                        verdict(judged(1), passed=False, reasons=("op02-face2: no axis, nothing to verify",)))
    assert [one.text for one in found] == ["op02-face2 has no axis: a wall"], "the judge has nothing against the other"


@pytest.mark.parametrize("missing", [True, False])
def test_a_failed_verdict_and_one_that_leaves_out_an_operation_stop(missing: bool) -> None:
    operations = (judged(1, passed=False),) if missing else (judged(1, passed=False), judged(2))
    found = warnings_of(plan(op(1), op(2)), verdict(*operations, passed=False, reasons=(
        "op01-face1: gouge 0.1 mm at face 1", "op01-face1: shank not checked: its outline is not known")))
    texts = [one.text for one in found if one.level == "stop"]
    assert texts[0] == "the verdict is FAIL: op01-face1" and "op01-face1: gouge 0.1 mm at face 1" in texts
    assert not any("not checked" in text for text in texts)
    assert any("says nothing of op02-face2" in text for text in texts) == missing


@pytest.mark.parametrize(("count", "words"), [(1, "1 zone, 2.0 mm², is left"), (2, "2 zones, 4.0 mm², are left")])
def test_one_zone_is_not_called_zones(count: int, words: str) -> None:
    zone = SimpleNamespace(area=2.0, elsewhere=0.0)
    found = warnings_of(plan(op(1, zones=(zone,) * count)), verdict(judged(1)))
    assert [one.text for one in found] == [f"{words} as rest material"]
