"""Further short passes over what is left where none may run out beyond the border of a face."""

from functools import cache, partial

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.path.cl_points import trace
from toolaxis.path.estimate import Estimator
from toolaxis.path.mending import FurtherPasses, add_passes_over_zones, complete_passes
from toolaxis.path.parametrization import Cut
from toolaxis.path.pass_layout import lay_out
from toolaxis.path.pass_pattern import patterns_of
from toolaxis.path.rest_material import FACTOR, OVERLOOKED, Excess, RestFinder
from toolaxis.plan.choices import FIELD, ISO, PLANES

SCALLOP, CHORD = 0.02, 0.002
CUTTERS = [ta.Tool.ball(diameter=12), ta.Tool.torus(diameter=10, corner_radius=2)]
LAID = [("u", ISO), ("v", ISO), ("v", PLANES), ("u", FIELD)]
AXES = [np.array([0.1, -0.2, 0.97]), np.array([0.25, 0.15, 0.95])]
T = np.linspace(0, 2 * np.pi, 48, endpoint=False)
ROUND = np.column_stack([np.cos(T), np.sin(T)])
OUTLINES = {
    "acute": np.array([[0.05, 0.05], [0.95, 0.3], [0.3, 0.95]]),
    "sliver": np.array([[0.05, 0.2], [0.95, 0.55], [0.9, 0.62], [0.1, 0.35]]),
    "round": 0.5 + 0.42 * ROUND,
    "uneven": 0.5 + (0.3 + 0.14 * np.cos(5 * T))[:, None] * ROUND,
}
#: Every outline and each way of laying passes once, with one cutter or the other; all triples are for --long.
CASES = [pytest.param(outline, number, *way, marks=[pytest.mark.long] * (k != i or number != i % 2))
         for i, outline in enumerate(OUTLINES) for number in (0, 1) for k, way in enumerate(LAID)]


@cache
def sheet(outline: str) -> ta.Face:
    x, y = np.meshgrid(np.linspace(0, 16, 5), np.linspace(0, 14, 5), indexing="ij")
    height = 0.4 * np.sin(x / 6) * np.cos(y / 7)
    return ta.Face.from_bspline(np.stack([x, y, height], axis=-1), trims=(OUTLINES[outline],))


@cache
def laid(outline: str, number: int, feed: str, passes: str = ISO) -> FurtherPasses:
    """Passes that stay on the face, and what they leave."""
    face, tool, cut = sheet(outline), CUTTERS[number], Cut(CUTTERS[number], AXES[number], SCALLOP)
    pattern, = patterns_of(Estimator.of(face, tool, SCALLOP), passes)
    placed = lay_out(pattern.chart(cut, feed), cut, face.contains)
    path = trace(placed, CHORD)
    return FurtherPasses(placed, path, RestFinder(face, tool, SCALLOP, walls=lambda uv: ~face.contains(uv)).find(path))


def share_above(face: ta.Face, tool: ta.Tool, made: FurtherPasses, factor: float) -> float:
    """Share of the area above a multiple of the limit, from about 300,000 points on the face."""
    count = int(np.ceil(np.sqrt(300_000 / (len(face.grid(100, 100)) / 100**2))))
    uv = face.grid(count, count)
    d = face.evaluate(uv)
    weight = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    high = Excess(face, tool, made.path, factor * SCALLOP)(uv) > 0
    return float(weight[high].sum() / weight.sum())


@pytest.mark.parametrize(("outline", "number", "feed", "passes"), CASES)
def test_nothing_is_left_on_which_the_cutter_may_stand(outline: str, number: int, feed: str, passes: str) -> None:
    face, tool = sheet(outline), CUTTERS[number]
    made = laid(outline, number, feed, passes)
    before = share_above(face, tool, made, FACTOR)
    assert made.left / face.area == pytest.approx(before, abs=OVERLOOKED + 2e-4)
    left = RestFinder(face, tool, SCALLOP, walls=lambda uv: ~face.contains(uv)).find
    trace_all = partial(trace, chord=CHORD)
    done = complete_passes(made.placed, trace_all(made.placed), trace_all, left, face.contains)
    assert share_above(face, tool, done, FACTOR) <= min(before, OVERLOOKED + 3e-4)
    assert face.contains(done.placed.chart.uv(done.placed.pieces[:, 0], done.placed.pieces[:, 2])).all()
    assert (before <= OVERLOOKED) == (done.placed is made.placed)


def test_there_is_something_to_be_mended(request: pytest.FixtureRequest) -> None:
    """Else the test above would show nothing."""
    tried = [case.values for case in CASES if not case.marks or request.config.getoption("--long")]
    shares = {case: laid(*case).left / sheet(case[0]).area for case in tried}
    assert all(share > 2 * OVERLOOKED for share in shares.values()), shares


def test_no_more_passes_than_it_takes() -> None:
    """The largest zones come first; the others stay where they are less than may be overlooked."""
    made = laid("round", 0, "u")
    assert len(made.zones) > 2
    few = add_passes_over_zones(made.placed, made.zones, None)
    assert 0 < len(few.steps) - len(made.placed.steps) < 2 * len(made.zones)
    assert add_passes_over_zones(made.placed, ()) is made.placed
    assert np.all(np.diff(few.steps) >= 0)
    assert set(made.placed.steps) <= set(few.steps)
    for step in made.placed.steps:  # the passes that were there are the same
        old, new = (one.pieces[one.pieces[:, 2] == step] for one in (made.placed, few))
        np.testing.assert_array_equal(old, new)


def test_a_zone_on_which_the_cutter_may_not_stand_is_left_alone() -> None:
    made = laid("acute", 0, "u")
    assert add_passes_over_zones(made.placed, made.zones, lambda uv: np.zeros(len(uv), dtype=bool)) is made.placed
