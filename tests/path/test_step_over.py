"""Where the next pass goes: past jumps of the strip width, and not on for ever where strips are next to nothing."""

from dataclasses import dataclass
from itertools import count

import numpy as np
import pytest

from toolaxis.path.parametrization import Cut, IsoChart, columns
from toolaxis.path.pass_count import measure
from toolaxis.path.step_over import _borrow, _root, _Strips, lines, space
from toolaxis.path.trim_intervals import table
from toolaxis.tools.tool import Tool

from .conftest import flat, holed, leaning, wavy  # type: ignore[import-not-found]


@pytest.mark.parametrize("jump", [0.3, 0.31, 0.777])
def test_a_slack_that_jumps_past_zero_ends_on_its_positive_side(jump: float) -> None:
    """Found: the place behind the jump was taken, whose strip does not reach back."""
    asked = count()

    def _slack(step: float) -> float:
        next(asked)
        return 1.0 - step if step < jump else -0.5 - step

    place = _root(_slack, 0.1, -1.0, 1e-6)
    assert jump - 1e-6 <= place < jump
    assert next(asked) < 40


def test_a_smooth_slack_is_solved_in_a_few_looks() -> None:
    asked = count()

    def _slack(step: float) -> float:
        next(asked)
        return float(np.cos(step) - 0.9 * step)

    place = _root(_slack, 0.5, -1.0, 1e-6)
    assert 0 <= np.cos(place) - 0.9 * place <= 1e-6 and next(asked) < 12


def test_strips_are_measured_only_where_something_is_to_be_covered() -> None:
    """A triangle, on whose short side few lines have anything left: passes there look at few lines."""
    face = flat(40.0, 30.0).trimmed((np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),))
    chart, cut = IsoChart(face, "u"), Cut(Tool.torus(4, 0.5), leaning(15.0), 0.02, 0.0)
    across = lines(chart, cut)
    material = table(columns(chart, across.along), len(across.along))
    strips = _Strips(chart, cut, across, material)
    front = np.where(across.along < 0.25, 0.9, np.inf)
    near = strips.watch_front(front, 0.9)
    assert near.sum() == (across.along < 0.25).sum()
    measured = strips.at(0.9)[near]
    strips.watch_front(np.zeros(len(across.along)), 0.0)
    assert measured == pytest.approx(strips.at(0.9)[near], rel=1e-12)
    made = space(chart, cut, across, material)
    zero = (made.halves == 0).all(axis=2)
    assert not zero[0].any() and zero[-1].mean() > 0.2
    used = len(made.steps) - made.unused
    assert used == pytest.approx(measure(chart, cut).passes, abs=1.0)


def test_a_capped_count_is_as_good_on_a_face_with_holes_and_looks_at_fewer(monkeypatch: pytest.MonkeyPatch) -> None:
    from toolaxis.path import pass_count

    face, cut = holed(wavy(3)), Cut(Tool.ball(8), leaning(10.0), 0.02, 0.0)
    looked, whole = [0], pass_count._narrowest

    def _narrowest(chart, cut, beyond, steps):  # type: ignore[no-untyped-def]
        looked[0] += len(steps)
        return whole(chart, cut, beyond, steps)

    monkeypatch.setattr(pass_count, "_narrowest", _narrowest)
    exact = measure(IsoChart(face, "u"), cut, accuracy=1e-6)
    most, looked[0] = looked[0], 0
    capped = measure(IsoChart(face, "u"), cut, accuracy=1e-6, most=200)
    assert np.isfinite(exact.length) and looked[0] < most / 2
    assert capped.length == pytest.approx(exact.length, rel=3e-3)


def test_a_ball_counts_the_same_under_every_axis() -> None:
    """What the search takes for granted: it counts once for a ball end."""
    face, ball = wavy(5), Tool.ball(8)
    lengths = [measure(IsoChart(face, "v"), Cut(ball, leaning(lead, turn), 0.02, 0.0)).length
               for lead, turn in ((2.0, 0.0), (25.0, 60.0), (40.0, 200.0))]
    assert lengths == pytest.approx([lengths[0]] * 3, rel=1e-3)


def test_lines_beside_the_material_borrow_the_strips_of_their_neighbours() -> None:
    halves = np.array([[0.0, 0.0], [2.0, 3.0], [0.0, 1.0], [np.nan, 0.0], [1.0, 4.0], [0.0, 0.0]])
    beside = np.array([True, False, False, True, False, True])
    made = _borrow(halves, beside)
    assert made[[0, 3, 5]].tolist() == [[2.0, 3.0], [1.0, 3.0], [1.0, 4.0]]
    assert made[[1, 2, 4]].tolist() == halves[[1, 2, 4]].tolist(), "a line on the material without a strip keeps none"
    assert np.array_equal(_borrow(np.zeros((3, 2)), np.ones(3, dtype=bool)), np.zeros((3, 2)))


@dataclass(frozen=True, eq=False)
class _Band(IsoChart):
    """A narrow band aslant over a plane, on which strips are more than twice as wide as beside it."""

    def half_widths(self, cut: Cut, along: np.ndarray, step: np.ndarray) -> np.ndarray:
        on = self.face.contains(self.uv(along, step))
        return np.repeat(np.where(on, 0.011, 0.0045)[:, None], 2, axis=1)


def _uncovered(chart: IsoChart, steps: np.ndarray, cut: Cut) -> float:
    """The greatest distance of a place on the face from the strips of the passes, as a share of a wide strip."""
    along, step = (grid.ravel() for grid in np.meshgrid(np.linspace(0, 1, 2001), np.linspace(0, 1, 1501)))
    on = chart.face.contains(chart.uv(along, step))
    along, step = along[on], step[on]
    beyond = np.full(len(along), np.inf)
    for one in steps:
        low, high = chart.half_widths(cut, along, np.full(len(along), one)).T
        beyond = np.minimum(beyond, np.maximum(one - low - step, step - one - high))
    return float(beyond.max() / 0.022)


def test_strips_that_jump_between_measured_lines_leave_nothing_uncovered(monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: a frame of fillets, where widths were interpolated from those on a fillet to those beside it."""
    band = np.array([[0.1, 0.0], [0.112, 0.0], [0.912, 1.0], [0.9, 1.0]])
    chart = _Band(flat(200.0, 60.0).trimmed((band,)), "u")
    cut = Cut(Tool.ball(6), leaning(15.0), 0.02, 0.0)
    across = lines(chart, cut)
    assert len(across.measured) > 193, "several lines cross each piece of a pass"
    made = space(chart, cut, across, table(columns(chart, across.along), len(across.along)))
    assert _uncovered(chart, made.steps, cut) < 1e-3
    assert len(made.steps) < 110, "the narrow strips beside the band have no say in most of them"
    monkeypatch.setattr("toolaxis.path.step_over._JUMPS", 1e9)
    old = space(chart, cut, across, table(columns(chart, across.along), len(across.along)))
    assert _uncovered(chart, old.steps, cut) > 0.02
