"""What passes machine beside their sub-surface: against the closed form on a plane, and against the judge."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.path.rest_material import Excess
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.regions import machined_beside
from toolaxis.regions.machined_beside import take_machined_beside
from toolaxis.shape.face import Face
from toolaxis.verify.task import VerificationTask as Judged
from toolaxis.verify.verdict import SHARE, judge

BALL, SCALLOP, SIZE, UP = ta.Tool.ball(diameter=6, stickout=40), 0.05, 40.0, np.array([0.0, 0.0, 1.0])
STRIP = np.sqrt(3**2 - (3 - SCALLOP)**2)
"""Half the width of the strip that the ball leaves no higher than the limit, mm."""


def plane(low: float, high: float) -> Face:
    whole = Face.from_bspline([[[0, 0, 0], [0, SIZE, 0]], [[SIZE, 0, 0], [SIZE, SIZE, 0]]], degree=(1, 1))
    return whole.trimmed((np.array([[low, 0], [high, 0], [high, SIZE], [low, SIZE]]) / [SIZE, SIZE],))


def passes(low: float, high: float, ends: float = SIZE) -> ToolPath:
    """Passes along y, a strip apart, the last one at x = high."""
    x = high - np.arange(0, high - low, 1.8 * STRIP)[::-1]
    tips = np.repeat(np.stack([x, np.full_like(x, -4.0), np.zeros_like(x)], axis=1), 2, axis=0)
    tips[1::2, 1] = ends + 4.0 if ends == SIZE else ends
    up, kind = np.tile(UP, (len(tips), 1)), np.tile([Motion.LINK, Motion.CUT], len(x)).astype(np.int8)
    return ToolPath(tips, tips, up, up, kind, np.arange(0, len(tips) + 1, 2))


def made(number: int, face: Face, path: ToolPath | None, outcome: str = "feasible") -> Operation:
    return Operation(number, face, BALL, Orientation(UP if path is not None else None, outcome=outcome), path)


def test_a_sub_surface_grows_as_far_as_its_last_pass_machines() -> None:
    left, rest = made(1, plane(0, 18), passes(0, 20)), made(2, plane(18, SIZE), None, "not_found")
    grown, less = take_machined_beside([left, rest], SCALLOP, 0.0)
    border = grown.face.area / SIZE
    assert 20 + STRIP - 3 * 0.1 * 2 * STRIP < border <= 20 + STRIP, "but for three cells, each a tenth of a strip"
    assert grown.face.area + less.face.area == pytest.approx(SIZE**2) and less.path is None
    gained = grown.face.area - left.face.area
    assert less.orientation.reasons == (f"passes beside it machine {gained:.1f} mm2 of that",)
    assert Excess(grown.face, BALL, grown.path, SCALLOP)(grown.face.grid(60, 60)).max() <= 0
    judged = judge(Judged("op", left.path.cl, left.path.axis, left.path.kind, BALL.profile, (grown.face,), SCALLOP))
    assert judged.share_within >= SHARE


def test_what_two_operations_machine_goes_to_one_of_them_and_a_rest_of_which_nothing_is_left_ends() -> None:
    near, far = made(1, plane(0, 18), passes(0, 20)), made(2, plane(22, SIZE), passes(19.5, SIZE))
    rest = made(3, plane(18, 22), None, "not_found")
    found = take_machined_beside([near, far, rest], SCALLOP, 0.0)
    assert sum(op.face.area for op in found) == pytest.approx(SIZE**2)
    assert [op.number for op in found if op.done] == [1, 2]
    assert sum(op.face.area for op in found if not op.done) < 0.01 * SIZE
    uv = np.random.default_rng(3).random((4000, 2))
    assert sum(op.face.contains(uv).astype(int) for op in found).max() == 1


def test_where_passes_end_early_nothing_is_taken() -> None:
    left, rest = made(1, plane(0, 18), passes(0, 20, ends=15.0)), made(2, plane(18, SIZE), None, "not_found")
    grown, _ = take_machined_beside([left, rest], SCALLOP, 0.0)
    gained = grown.face.area - left.face.area
    assert 0.7 * (2 + STRIP) * 15 < gained < (2 + STRIP) * (15 + STRIP)
    uv = np.random.default_rng(4).uniform([18 / SIZE, 0], [22 / SIZE, 0.5], (40_000, 2))
    assert Excess(grown.face, BALL, left.path, SCALLOP)(uv[grown.face.contains(uv)]).max() <= 0


def test_a_rest_is_machined_up_to_its_far_border_only_where_that_goes_on_beyond_it() -> None:
    """The strip ends between the last cells of the rest and its border, beyond which another operation begins."""
    for far in 20 + STRIP + np.linspace(0.005, 0.1, 20):
        left, rest = made(1, plane(0, 18), passes(0, 20)), made(2, plane(18, far), None, "not_found")
        grown = take_machined_beside([left, rest], SCALLOP, 0.0)[0]
        assert grown.face.area <= (20 + STRIP) * SIZE


def test_what_cells_tell_wrongly_is_found_before_it_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    left, rest = made(1, plane(0, 18), passes(0, 20)), made(2, plane(18, 24), None, "not_found")
    monkeypatch.setattr(machined_beside._Rest, "_machined", lambda self, high: self._on & ~self._taken)
    assert [op.face.area for op in take_machined_beside([left, rest], SCALLOP, 0.0)] == [left.face.area, rest.face.area]
    wide = made(1, left.face, passes(0, 24))
    assert [op.number for op in take_machined_beside([wide, rest], SCALLOP, 0.0)] == [1], "it is machined whole"


def test_nothing_is_taken_of_what_failed_nor_without_passes_nor_below_an_allowance() -> None:
    left = made(1, plane(0, 18), passes(0, 20))
    failed, rest = made(2, plane(18, SIZE), None, "failed"), made(2, plane(18, SIZE), None, "not_found")
    assert take_machined_beside([left, failed], SCALLOP, 0.0) == [left, failed]
    assert take_machined_beside([rest], SCALLOP, 0.0) == [rest]
    lifted = ToolPath(left.path.cc, left.path.cl + 0.3 * UP, left.path.axis, left.path.normal, left.path.kind,
                      left.path.breaks)
    high = made(1, left.face, lifted)
    assert [op.face.area for op in take_machined_beside([high, rest], SCALLOP, 0.0)] == [left.face.area, rest.face.area]
    assert take_machined_beside([high, rest], SCALLOP, 0.3)[0].face.area > 1.05 * left.face.area
