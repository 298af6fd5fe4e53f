"""What is offered for a face without an axis, and that it helps where it can be known that it does."""

import ast
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis import advice
from toolaxis.messages.translate import catalogue
from toolaxis.plan.orientation import REASONS, AxisMap, Orientation
from toolaxis.plan.remedies import Remedy, remedies_advised, remedies_of
from toolaxis.plan.tally import counts_of, tally_sentence

HOLDER = [(20.0, 0.0), (20.0, 40.0)]


def plane(corner, one, other, flip=False) -> ta.Face:
    s, t = np.meshgrid(np.linspace(0, 1, 3), np.linspace(0, 1, 3), indexing="ij")
    return ta.Face.from_bspline(np.array(corner) + s[..., None] * np.array(one) + t[..., None] * np.array(other),
                                degree=(2, 2), flip=flip)


def pocket(depth: float) -> ta.Part:
    """A wavy floor, 30 mm wide, between walls."""
    x, y = np.meshgrid(np.linspace(0, 30, 5), np.linspace(0, 30, 5), indexing="ij")
    floor = ta.Face.from_bspline(np.stack([x, y, 0.5 * np.sin(x / 8) * np.cos(y / 8)], axis=-1))
    up = (0.0, 0.0, depth + 1)
    walls = [plane((0, 0, -1), (30, 0, 0), up, flip=True), plane((0, 30, -1), (30, 0, 0), up),
             plane((0, 0, -1), (0, 30, 0), up), plane((30, 0, -1), (0, 30, 0), up, flip=True)]
    return ta.Part.from_faces([floor, *walls])


def test_a_longer_stick_out_is_offered_and_helps() -> None:
    """The holder, 40 mm wide, goes into no pocket of 30 mm: it has to stay above its walls, 40 mm high."""
    tool = ta.Tool.ball(diameter=6, stickout=20, holder=HOLDER)
    plan = ta.plan(pocket(40), tool, 0.3, faces=[1], limits="cone:0,0,1,30")
    assert not plan.operations[0].done, plan.outcome
    first = remedies_of(plan)[0]
    assert first.name == "stickout" and first.value == 45.0 and first.share > 0.5
    again = ta.plan(pocket(40), replace(tool, stickout=first.value), 0.3, faces=[1], limits="cone:0,0,1,30")
    assert again.operations[0].done and remedies_of(again) == ()
    deep = ta.plan(pocket(90), tool, 0.3, faces=[1], limits="cone:0,0,1,30")
    assert "stickout" not in [one.name for one in remedies_of(deep)], "95 mm are more than 12 diameters"


def test_limits_that_forbid_everything_are_offered_to_go() -> None:
    plan = ta.plan(pocket(2).faces[0], "ball:6", 0.2, limits="cone:0,0,-1,20")
    assert not plan.operations[0].done
    assert remedies_of(plan)[0] == Remedy("limits", "", 1.0)
    assert plan.machine is None
    assert remedies_of(replace(plan, inputs=replace(plan.inputs, limits=""))) == (), "a machine's limits are no choice"


@pytest.fixture(scope="module")
def plan():
    return ta.plan(pocket(2).faces[0], ta.Tool.torus(diameter=12, corner_radius=2, stickout=50), 0.2)


def refused(plan, *codes: int, outcome: str = "not_found"):
    """The plan with one operation without an axis, whose axes are forbidden for given reasons."""
    reason = np.array(codes, dtype=np.int8)
    axes = np.tile([0.0, 0.0, 1.0], (len(codes), 1))
    none = np.full(len(codes), np.inf)
    found = Orientation(None, outcome=outcome, map=AxisMap(axes, none, none, reason, np.zeros(len(codes))))
    return replace(plan, operations=(replace(plan.operations[0], path=None, orientation=found),))


def test_each_reason_has_its_remedy(plan) -> None:
    code = REASONS.index
    assert remedies_of(refused(plan, *[code("gouge")] * 3, code("cutter collides"))) == (Remedy("tool", "ball:8", 1.0),)
    assert remedies_of(refused(plan, code("too near to a normal"))) == (Remedy("tool", "ball:12", 1.0),)
    both = remedies_of(refused(plan, *[code("gouge")] * 3, code("back of the surface")))
    assert both == (Remedy("tool", "ball:8", 0.75), Remedy("regions", "auto", 0.25))
    rare = remedies_of(refused(plan, *[code("gouge")] * 19, code("back of the surface")))
    assert [one.name for one in rare] == ["tool"], "one axis in twenty is not worth it"
    assert remedies_of(refused(plan, code("holder collides"))) == (), "there is no holder"


def test_nothing_is_offered_where_nothing_is_known(plan) -> None:
    code = REASONS.index
    assert remedies_of(plan) == ()
    for outcome in ("cancelled", "failed"):
        assert remedies_of(refused(plan, code("gouge"), outcome=outcome)) == ()
    several = replace(refused(plan, code("gouge")), tools=(*plan.tools, ta.Tool.ball(diameter=4)))
    assert remedies_of(several) == ()


def test_a_face_whose_normals_spread_too_far_is_offered_to_be_divided(plan) -> None:
    """It is refused before an axis is looked at: there is no map."""
    lost = refused(plan, 0, outcome="infeasible")
    op = lost.operations[0]
    lost = replace(lost, operations=(replace(op, orientation=replace(op.orientation, map=None)),))
    assert remedies_of(lost) == (Remedy("regions", "auto", 1.0),)
    assert remedies_of(lost, divided=True) == ()


def test_an_operation_without_a_map_is_known_by_what_its_sentences_count(plan) -> None:
    """Found: a division was offered for the rest of a face that nearly all axes gouge."""
    counts = np.arange(len(REASONS)) * 3
    for flat in (True, False):
        assert counts_of(["no axis found", tally_sentence(counts, flat)]).tolist() == [0, *counts[1:]]
    told = "1394 axes tested: 132 outside the limits, 61 too far from a normal, 1201 with a gouge"
    bare = replace(plan.operations[0].orientation, axis=None, outcome="not_found", map=None, reasons=(told,))
    lost = replace(plan, operations=(replace(plan.operations[0], path=None, orientation=bare),))
    assert [(one.name, one.value) for one in remedies_of(lost)] == [("tool", "ball:8")]
    none = replace(bare, reasons=("no single axis reaches all of face 1",))
    lost = replace(plan, operations=(replace(plan.operations[0], path=None, orientation=none),))
    assert [one.name for one in remedies_of(lost)] == ["regions"]


ADVICE = (
    ("the cutter gouges face 3. Face 4 stands 0.034 mm out over face 3 there, more than the 0.1 mm that are taken as "
     "inaccuracy of the file: repair the edge, or plan with a larger machining tolerance", [("tolerance", 0.05)]),
    ("the corner radius 2 mm gouges face 1 by 0.31 mm at (1, 2, 3) with every axis; 0.01 mm is allowed: use a smaller "
     "corner radius", [("tool", "torus:12x1")]),
    ("no pass is left on face 1: walls or faces beside it keep the tool off everywhere along the passes; divide the "
     "face (--regions), or use a smaller cutter", [("tool", "ball:8"), ("regions", "auto")]),
    ("the computer's memory does not suffice: choose a larger scallop height or fewer faces", [("scallop", 0.5)]),
    ("scallop is 8.0 mm, not below the cutter radius 6.0 mm: give a smaller scallop height", [("scallop", 0.1)]),
    ("the tool comes too close near (0, 0, 0) however much it leans along the pass: choose another strategy, a longer "
     "stick-out or a slimmer holder", [("stickout", 75.0)]),
    ("all axes are taken", []))


@pytest.mark.parametrize(("text", "offered"), ADVICE)
def test_what_a_sentence_advises_is_offered(text, offered) -> None:
    tool = ta.Tool.torus(diameter=12, corner_radius=2, stickout=50, holder=HOLDER)
    found = remedies_advised([text], tool, (0.2, 0.01))
    assert [(one.name, one.value) for one in found] == offered and all(one.share == 1.0 for one in found)


def test_no_advice_leads_out_of_what_can_be_planned() -> None:
    ball = ta.Tool.ball(diameter=4, stickout=45, holder=HOLDER)
    every = " ".join(text for text, _ in ADVICE).replace("0.034", "0.2")
    found = {one.name: one.value for one in remedies_advised([every], ball, (1.0, 0.1), divided=True)}
    assert found == {"tool": "ball:2", "scallop": 0.2}, "no tolerance above 0.1 mm, no stick-out above 12 diameters"
    assert [one.value for one in remedies_advised(["use a smaller corner radius"], ball, (0.1, 0.01))] == []


def test_advice_of_a_face_without_a_map_comes_with_what_maps_say(plan) -> None:
    lost = refused(plan, REASONS.index("gouge"))
    advice = "no pass is left; divide the face, or use a smaller cutter"
    found = replace(lost.operations[0].orientation, reasons=(advice,))
    told = replace(lost, operations=(replace(lost.operations[0], orientation=found),))
    assert {(one.name, one.value) for one in remedies_of(told)} == {("tool", "ball:8"), ("regions", "auto")}
    assert [one.name for one in remedies_of(told, divided=True)] == ["tool"]


#: Words of each advice, by their names, and what a German sentence has for them.
PHRASES = {name: words for name, words in vars(advice).items() if name.isupper() and name != "STANDS_OUT"}
GERMAN = {"LARGER_TOLERANCE": "größerer Bearbeitungstoleranz", "SMALLER_CORNER": "kleineren Eckenradius|kleinerem "
          "Eckenradius", "SMALLER_CUTTER": "kleineren Fräser", "SMALLER_ONE": "einen kleineren", "SMALLER_TOOL":
          "kleineres Werkzeug", "SLIMMER_TOOL": "schlankeres Werkzeug", "LONGER_STICKOUT": "größere Auskraglänge",
          "LONGER_TOOL": "schlankeres oder längeres Werkzeug", "LARGER_SCALLOP": "größere Rillenhöhe|größerer "
          "Rillenhöhe", "GREATER_SCALLOP": "größere Rillenhöhe", "COARSER_SCALLOP": "gröbere Rillenhöhe|größere "
          "Rillenhöhe", "SMALLER_SCALLOP": "kleinere Rillenhöhe", "DIVIDE": "die Fläche (weiter |in .* )?teilen"}


@pytest.mark.parametrize("name", PHRASES)
def test_every_advice_has_a_remedy_and_is_given_in_german_too(name) -> None:
    tool = ta.Tool.torus(diameter=12, corner_radius=2, stickout=50, holder=HOLDER)
    advising = {english: form for english, form in catalogue("german").items() if PHRASES[name] in english}
    assert advising, "no sentence advises it"
    for english, form in advising.items():
        assert remedies_advised([english], tool, (0.2, 0.01)), english
        assert re.search(GERMAN[name], form), form


def test_no_sentence_types_an_advice_out() -> None:
    """Worded anew there alone, it would lose its remedy unseen."""
    root, typed = Path(__file__).resolve().parents[2], []
    for path in [*root.glob("core/toolaxis/**/*.py"), *root.glob("workbench/freecad/**/*.py")]:
        if path.name != "advice.py":
            typed += [f"{path.relative_to(root)}: {text}" for text in texts_in(path)
                      if any(words in text for words in PHRASES.values())]
    assert not typed, "\n".join(typed)


def texts_in(path):
    """Texts of a module, also those with values in them, but for what documents it."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    documents = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    return [node.value for node in ast.walk(tree)
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documents]
