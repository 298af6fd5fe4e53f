"""Divisions given by hand: borders, axes and feeds are kept, and what cannot be is refused in a sentence."""

import json
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cli.main import main
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.planning import asked_division
from toolaxis.job.planning.sub_surfaces import LOCKED, REFUSED_HINT, REFUSED_LOCK, read_division
from toolaxis.plan.plan import Plan
from toolaxis.plan.sub_surface import division_document, division_from

TOOL, SCALLOP = "torus:6x1", 0.3
LEFT = (np.array([[0.0, 0.0], [0.45, 0.0], [0.45, 1.0], [0.0, 1.0]]),)
RIGHT = (np.array([[0.45, 0.0], [1.0, 0.0], [1.0, 1.0], [0.45, 1.0]]),)
LEANING = np.array([0.2, 0.1, 1.0])
#: Few axes to choose from, where the division is what is looked at.
NEAR = "cone:0.2,0.1,1,12"


def wavy() -> ta.Part:
    x, y = np.meshgrid(np.linspace(0, 24, 7), np.linspace(0, 16, 5), indexing="ij")
    return ta.Part.from_faces([ta.Face.from_bspline(np.dstack([x, y, 0.8 * np.sin(x / 9) * np.cos(y / 8)]))])


def planned(*division: ta.SubSurface, **more: object) -> Plan:
    return ta.plan(wavy(), TOOL, SCALLOP, division=division, **more)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def halves() -> Plan:
    """The left half with a locked axis and feed, the right one free but for its feed."""
    return planned(ta.SubSurface(1, LEFT, LEANING, "v", locked=True), ta.SubSurface(1, RIGHT, feed="v"), limits=NEAR)


def test_borders_axes_and_feeds_are_kept(halves: Plan) -> None:
    assert halves.outcome == "complete"
    assert [op.face.label for op in halves.operations] == ["1a", "1b"]
    whole = wavy().faces[0]
    assert sum(op.face.area for op in halves.operations) == pytest.approx(whole.area, rel=1e-6)
    left, right = (op.orientation for op in halves.operations)
    assert left.axis == pytest.approx(LEANING / np.linalg.norm(LEANING), abs=1e-12)
    assert (left.feed, right.feed) == ("v", "v")
    assert left.reasons[0] == f"{LOCKED}axis and feed v" and right.reasons[0] == f"{LOCKED}feed v"


def test_the_judge_passes_what_is_given_by_hand(halves: Plan) -> None:
    assert ta.verify(halves).passed


def test_the_feed_is_the_one_asked_for(halves: Plan) -> None:
    """Also where the other one is better, as here."""
    found = planned(ta.SubSurface(1, RIGHT, feed="u"), limits=NEAR).operations[0].orientation
    assert found.feed == "u" and found.length < 0.9 * halves.operations[1].orientation.length


def test_an_axis_that_is_refused_is_kept_only_where_it_is_locked() -> None:
    below = np.array([0.0, 0.0, -1.0])
    locked = planned(ta.SubSurface(1, axis=below, locked=True)).operations[0]
    assert not locked.done and locked.orientation.outcome == "infeasible"
    assert locked.orientation.reasons[0].startswith(REFUSED_LOCK)
    free = planned(ta.SubSurface(1, axis=below)).operations[0]
    assert free.done and free.orientation.reasons[0].startswith(REFUSED_HINT)


def test_an_axis_that_is_not_refused_is_kept_without_a_lock() -> None:
    kept = planned(ta.SubSurface(1, axis=LEANING)).operations[0]
    assert kept.orientation.axis == pytest.approx(LEANING / np.linalg.norm(LEANING), abs=1e-12)


def test_faces_without_a_given_division_are_planned_as_asked_for() -> None:
    other = wavy().faces[0].transformed(np.array([[1, 0, 0, 0], [0, 1, 0, 40], [0, 0, 1, 0], [0, 0, 0, 1.0]]))
    part = ta.Part.from_faces([*wavy().faces, other])
    given = [ta.SubSurface(1, region, LEANING) for region in (RIGHT, LEFT)]
    made = ta.plan(part, TOOL, SCALLOP, division=given, method="normal")
    assert [op.face.label for op in made.operations] == ["1a", "1b", "2"]
    assert [op.done for op in made.operations[:2]] == [True, True] and made.orientations == 1
    assert not made.operations[2].done, "the mean normal gouges there, and the other face's axis is not taken"


def test_what_is_not_covered_is_told() -> None:
    made = planned(ta.SubSurface(1, LEFT, LEANING))
    assert any("of face 1 lies in none of the sub-surfaces" in text for text in made.part.warnings)


@pytest.mark.parametrize(("division", "more", "words"), [
    ([ta.SubSurface(1, LEFT), ta.SubSurface(1)], {}, "sub-surfaces 1a and 1b overlap"),
    ([ta.SubSurface(1, (2 * LEFT[0] + 0.3,))], {}, "sub-surface 1 leaves face 1"),
    ([ta.SubSurface(7)], {}, "face 7"),
    ([ta.SubSurface(1, LEFT, feed="u")], {"method": "one"}, "leave out the method, or remove the lock")])
def test_what_cannot_be_is_refused(division: list[ta.SubSurface], more: dict[str, str], words: str) -> None:
    with pytest.raises(ta.InvalidInput, match=words):
        planned(*division, **more)


@pytest.mark.parametrize(("given", "words"), [
    ({"face": "one"}, "names no face"), ({"face": 1, "axis": (0, 0, 0)}, "not all 0"),
    ({"face": 1, "feed": "w"}, "use u, v"), ({"face": 1, "locked": True}, "locked and not given"),
    ({"face": 1, "region": (("a", "b"),)}, "no numbers")])
def test_a_sub_surface_is_checked(given: dict[str, object], words: str) -> None:
    with pytest.raises(ta.InvalidInput, match=words):
        ta.SubSurface(**given)  # type: ignore[arg-type]


def test_a_division_is_written_and_read(tmp_path: Path) -> None:
    one = ta.SubSurface(3, LEFT, LEANING, "u", True, "3a")
    path = tmp_path / "division.json"
    path.write_text(json.dumps(division_document([one])))
    again, = read_division(path)
    assert (again.face, again.feed, again.locked, again.label) == (3, "u", True, "3a")
    assert again.axis == pytest.approx(one.axis) and again.region[0] == pytest.approx(LEFT[0])
    for wrong, words in (("[]", "neither a plan"), ('{"sub_surfaces": [{"axis": 1}]}', "no face"), ("{", "cannot be")):
        path.write_text(wrong)
        with pytest.raises(ta.InvalidInput, match=words):
            read_division(path)


def test_a_plan_is_a_division_and_comes_out_no_worse(halves: Plan, tmp_path: Path) -> None:
    """Its axes are kept; feeds that were locked there are free."""
    write_plan(halves, tmp_path)
    given = division_from(json.loads((tmp_path / "plan.json").read_text()))
    again = planned(*given, limits=NEAR)
    for ours, theirs in zip(again.operations, halves.operations, strict=True):
        assert ours.orientation.length <= 1.001 * theirs.orientation.length
        assert ours.orientation.axis == pytest.approx(theirs.orientation.axis, abs=1e-9)


def test_the_command_takes_the_same_division(tmp_path: Path) -> None:
    part = Path(__file__).parents[2] / "examples" / "freeform.step"
    path = tmp_path / "division.json"
    whole = ta.SubSurface(1, axis=LEANING, locked=True)
    path.write_text(json.dumps(division_document([whole])))
    asked = ["plan", str(part), "--tool", "torus:12x1", "--scallop", "0.3", "--no-pictures"]
    assert main([*asked, "--division", str(path), "--out", str(tmp_path / "out")]) == 0
    made = read_plan(tmp_path / "out")
    found = made.operations[0].orientation
    assert found.axis == pytest.approx(LEANING / np.linalg.norm(LEANING), abs=1e-12)
    assert found.reasons[0].startswith(LOCKED)


def test_one_sub_surface_is_the_face_and_nothing_is_reckoned_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("no division is asked for")

    monkeypatch.setattr(asked_division, "regions_of", refuse)
    whole, one = (ta.plan(wavy(), "ball:6", SCALLOP, method="normal", workers=1, **more)  # type: ignore[arg-type]
                  for more in ({}, {"regions": 1}))
    assert one.outcome == "complete" and [op.face.label for op in one.operations] == ["1"]
    assert np.array_equal(one.operations[0].path.cl, whole.operations[0].path.cl)
