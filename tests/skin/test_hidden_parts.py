"""What of a face lies under another one of its skin is of no operation: it is told, with where it lies."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.job.files.plan_folder import read_plan, stage_folder, write_plan
from toolaxis.numeric import jit as _compiled
from toolaxis.plan.plan import Plan
from toolaxis.regions.open_places import list_open_places, what_closes
from toolaxis.report.tables import plan_table
from toolaxis.report.warnings import warnings_of
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.skin.pieces import own_pieces
from toolaxis.skin.unite import unite
from toolaxis.skin.view_surface import ViewSurface

#: The tongue in x and y, mm, and how far below the sheet it lies at x: a twentieth of the square of 20 - x.
TONGUE, BEND = ((17.0, 20.0), (8.0, 9.8)), 0.05


def sheets() -> list[Face]:
    """A flat sheet up to x = 20, and one that falls away from there and has a tongue back under the first."""
    flat = ta.Face.from_bspline([[[0, 0, 0], [0, 20, 0]], [[20, 0, 0], [20, 20, 0]]], degree=(1, 1))
    heights = {10: -100 * BEND, 25: 200 * BEND, 40: -400 * BEND}
    bent = ta.Face.from_bspline([[[x, 0, z], [x, 20, z]] for x, z in heights.items()], degree=(2, 1))
    (x0, x1), (y0, y1) = TONGUE
    corners = [(40, 0), (40, 20), (x1, 20), (x1, y1), (x0, y1), (x0, y0), (x1, y0), (x1, 0)]
    loop = np.array([[(x - 10) / 30, y / 20] for x, y in corners])
    return [flat, replace(bent, trims=(loop,), number=2, label="2")]


def area_of_tongue() -> float:
    (x0, x1), (y0, y1) = TONGUE
    x = np.linspace(x0, x1, 1001)
    steep = np.sqrt(1 + (2 * BEND * (x - 20)) ** 2)
    return float((x1 - x0) * steep.mean() * (y1 - y0))


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_the_upper_face_is_seen_whatever_the_order(order: tuple[int, int]) -> None:
    faces = [sheets()[k] for k in order]
    made = unite(faces)
    surface = made.surface
    assert isinstance(surface, ViewSurface)
    (hidden,) = surface.hidden
    assert (hidden.face, hidden.beneath) == (2, 1) and hidden.area == pytest.approx(area_of_tongue(), rel=1e-2)
    assert all(low < x < high for x, (low, high) in zip(hidden.point, TONGUE, strict=False)) and hidden.point[2] < -0.05
    assert made.area == pytest.approx(sum(face.area for face in faces) - hidden.area, rel=1e-12)
    sheet = next(one for one in surface.seen if one.face.number == 1)
    on_sheet = np.array([[x, y, 0.0] for x in (17.2, 18.5) for y in (8.1, 9.0, 9.7)])
    places = sheet.project(on_sheet)
    assert (surface.owners(places) == surface.seen.index(sheet)).all()
    assert np.abs(made.evaluate(places).point - on_sheet).max() < 1e-9
    pieces = own_pieces(made)
    assert [one.number for one in pieces] == [face.number for face in faces]
    assert sum(one.area for one in pieces) == pytest.approx(made.area, rel=1e-3), "the judge asks for no more"


def test_faces_that_meet_hide_nothing() -> None:
    flat, bent = sheets()
    loop = np.array([[(x - 10) / 30, y / 20] for x, y in ((40, 0), (40, 20), (19.99, 20), (19.99, 0))])
    surface = unite([flat, replace(bent, trims=(loop,))]).surface
    assert isinstance(surface, ViewSurface) and surface.hidden == () and not any(surface.covered)


@pytest.fixture(scope="module")
def planned() -> Plan:
    return ta.plan(Part.from_faces(sheets()), ["ball:10", "ball:6"], 0.2, faces="skins", workers=1)


def test_it_is_in_the_account_with_where_it_lies(planned: Plan, tmp_path: Path) -> None:
    """Found: it counted as machined, and no list had it."""
    (hidden,) = planned.unplanned
    assert (hidden.label, hidden.beneath, hidden.why, hidden.whole) == ("2", "1", "hidden", False)
    account = planned.account
    assert account.area == pytest.approx(sum(face.area for face in sheets()), rel=1e-9)
    assert account.open >= hidden.area * (1 - 1e-9) and account.not_begun == 0 and planned.outcome == "incomplete"
    at = " ".join(f"{x:.1f}" for x in hidden.point)
    words = f"{hidden.area:.2f} mm2 of face 2 under face 1 at {at}"
    assert words in str(plan_table(planned).caption)
    assert any(words in one.text and one.level == "mind" for one in warnings_of(planned, None))
    crumb = replace(planned, unplanned=(hidden._replace(area=0.002),))
    assert "hidden" not in str(plan_table(crumb).caption), "0.00 mm2 tells nobody anything"
    place = next(one for one in list_open_places(planned) if one.label == "2")
    assert place.area == hidden.area and what_closes(place, 3.0).startswith("face 2 without face 1: it lies under that")
    with stage_folder(tmp_path / "plan") as stage:
        write_plan(planned, stage.folder)
        stage.publish()
    assert json.loads((tmp_path / "plan" / "plan.json").read_text())["part"]["unplanned"] == [
        {**hidden._asdict(), "point": list(hidden.point)}]
    back = read_plan(tmp_path / "plan")
    assert back.unplanned == planned.unplanned and back.account == account


def test_the_judge_does_not_ask_a_pass_over_the_skin_for_it(planned: Plan) -> None:
    verdict = ta.verify(planned)
    assert planned.operations[0].face.label == "1+2" and all(op.passed for op in verdict.operations), verdict.reasons


def test_kernels_see_what_their_plain_twins_see() -> None:
    """Faces one of which lies under another, with a gap of 8 um between two of them."""
    shift = np.eye(4)
    shift[0, 3] = 0.008
    made = unite([sheets()[0], replace(sheets()[1].transformed(shift), number=2, label="2")])
    surface = made.surface
    assert isinstance(surface, ViewSurface)
    view = surface._view
    assert (view.table is not None) == _compiled.available
    low, high = np.concatenate(surface.outline).min(axis=0), np.concatenate(surface.outline).max(axis=0)
    places = low - 1 + np.random.default_rng(4).random((4000, 2)) * (high - low + 2)
    middle = surface.seen[0].project(np.column_stack([np.full(50, 20.004), np.linspace(10, 19, 50), np.zeros(50)]))
    places = np.concatenate([places, middle])
    owner = view._find_plainly(places)
    assert set(owner) == {-1, 0, 1} and not any(one.contains(middle).any() for one in view.seen)
    assert (owner[-len(middle):] >= 0).all()  # the nearer of both goes on
    assert np.array_equal(view.owners(places), owner)
    assert np.array_equal(view.nearest(places), view._find_nearest_plainly(places))
    within = owner >= 0
    for mine, plain in zip(view.evaluate(places[within], owner[within]),
                           view._evaluate_plainly(places[within], owner[within]), strict=True):
        assert np.abs(mine - plain).max() < 1e-9
    assert (~within).sum() > 300
    for mine, plain in zip(surface.evaluate(places), surface._evaluate_plainly(places), strict=True):
        assert np.abs(mine - plain).max() < 1e-9
