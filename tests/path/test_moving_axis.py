"""Passes with a moving axis: strips by brute force, and links on which the axis turns."""

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion
from toolaxis.contact.frame import contact_frame, lead_tilt_from_axis
from toolaxis.contact.placement import place
from toolaxis.contact.strip.cutter_parameters import cutter_parameters
from toolaxis.contact.strip.swept_volume_moving_axis import _least_numpy, least_distance_to_positions
from toolaxis.numeric.vectors import unit
from toolaxis.path.chord_tolerance import follow
from toolaxis.path.links import Linking
from toolaxis.path.moving_axis import ConstantLeadField, MovingChart, MovingCut
from toolaxis.path.parametrization import Cut, IsoChart
from toolaxis.strategies.common.links import LinkMotion, MovingCuttingMove, MovingLinks, join_moves
from toolaxis.tools.tool import Tool

from .conftest import flat, wavy  # type: ignore[import-not-found]

H, TORUS, UP = 0.02, Tool.torus(12, 1), np.array([0.0, 0.0, 1.0])


def _cut(lead_deg: float, feed: str = "u", tool: Tool = TORUS) -> MovingCut:
    return MovingCut(tool, UP, H, 0.0, field=ConstantLeadField(np.radians(lead_deg), feed))


@pytest.mark.parametrize("lead_deg", [2.0, 10.0, 30.0, -10.0])
def test_on_a_plane_strips_are_those_of_a_fixed_axis(lead_deg: float) -> None:
    face, place_ = flat(100, 80), (np.array([0.5]), np.array([0.4]))
    axis = [np.sin(np.radians(lead_deg)), 0, np.cos(np.radians(lead_deg))]
    fixed = IsoChart(face).half_widths(Cut(TORUS, np.array(axis), H), *place_)
    assert np.allclose(MovingChart(face).half_widths(_cut(lead_deg), *place_), fixed, rtol=2e-4)


@pytest.mark.parametrize("feed", ["u", "v"])
@pytest.mark.parametrize("seed", [1, 4])
def test_strips_end_where_the_passing_cutter_leaves_the_scallop(seed: int, feed: str) -> None:
    face, cut = wavy(seed, height=5.0), _cut(8.0, feed)
    chart = MovingChart(face, feed)
    along, step = np.array([0.3, 0.6]), np.array([0.5, 0.45])
    halves = chart.half_widths(cut, along, step)
    way = np.linspace(-0.5, 0.5, 4001)
    for a, s, half in zip(along, step, halves, strict=True):
        uv = chart.uv(a + way, np.full(len(way), s))
        axes = cut.axes(face, uv)
        tips = place(face, TORUS, uv, axes)
        for sense, width in zip((-1, 1), half, strict=True):
            for share, cleared in ((0.998, True), (1.004, False)):
                at = chart.uv(np.array([a]), np.array([s + sense * share * width]))
                point = (face.evaluate(at).point + H * face.normal(at))[0]
                apart = point - tips
                z = (apart * axes).sum(axis=1)
                rho = np.linalg.norm(apart - z[:, None] * axes, axis=1) - TORUS.flat_radius
                low = TORUS.corner_radius - z
                off = np.where(low > 0, np.hypot(np.maximum(rho, 0), low), rho) - TORUS.corner_radius
                assert (off.min() <= 1e-5) == cleared


def test_kernel_and_twin_agree_and_never_lie_above_the_positions() -> None:
    rng = np.random.default_rng(3)
    tips = np.cumsum(rng.uniform(0.2, 0.4, (5, 20, 3)), axis=1)
    axes = UP + 0.2 * np.cumsum(rng.uniform(0, 0.1, (5, 20, 3)), axis=1)
    axes /= np.linalg.norm(axes, axis=2, keepdims=True)
    points, numbers = tips[:, ::4] + rng.normal(size=(5, 5, 3)), cutter_parameters(TORUS, H, 0.0)
    found = least_distance_to_positions(numbers, points, tips, axes)
    assert np.allclose(found, _least_numpy(numbers, points, tips, axes), atol=1e-12)
    apart = points[:, :, None] - tips[:, None]
    z = (apart * axes[:, None]).sum(axis=3)
    rho = np.linalg.norm(apart - z[..., None] * axes[:, None], axis=3)
    own = np.array([[[TORUS.distance([[r, 0, h]], "cutter").value[0] for r, h in zip(x, y, strict=True)]
                     for x, y in zip(a, b, strict=True)] for a, b in zip(rho, z, strict=True)])
    assert (found <= own.min(axis=2) + 1e-9).all() and (found > own.min(axis=2) - 0.2).all()


def test_the_lead_is_constant_and_chords_keep_the_tolerance_up_the_axis_too() -> None:
    face, cut = wavy(2, height=6.0), _cut(5.0)
    chart = MovingChart(face)
    pieces = np.array([[0.0, 1.0, 0.5]])
    _, along = follow(chart, cut, pieces, 1e-3)
    uv = chart.uv(along, np.full(len(along), 0.5))
    axes = cut.axes(face, uv)
    lead, tilt = lead_tilt_from_axis(contact_frame(face, uv), axes)
    assert np.allclose(lead, np.radians(5.0), atol=1e-12) and np.allclose(tilt, 0.0, atol=1e-12)
    half = chart.uv((along[1:] + along[:-1]) / 2, np.full(len(along) - 1, 0.5))
    true = place(face, TORUS, half, cut.axes(face, half)) + 12.0 * cut.axes(face, half)
    chord = place(face, TORUS, uv, axes) + 12.0 * axes
    line = np.diff(chord, axis=0)
    t = ((true - chord[:-1]) * line).sum(axis=1) / (line**2).sum(axis=1)
    assert np.linalg.norm(true - chord[:-1] - t[:, None] * line, axis=1).max() < 1.1e-3


def _strokes() -> list[list[MovingCuttingMove]]:
    x = np.linspace(0, 20, 9)
    tips = np.column_stack([x, np.zeros(9), np.zeros(9)])
    lean = np.radians(np.linspace(-40, 40, 9))
    axes = np.column_stack([np.sin(lean), np.zeros(9), np.cos(lean)])
    normals = np.tile(UP, (9, 1))
    return [[MovingCuttingMove(tips + y, tips + y, normals, axes)] for y in np.array([[0.0, 0, 0], [0, 3, 0]])]


def test_links_turn_only_across_and_above_everything() -> None:
    tool = Tool.torus(12, 1, stickout=30, holder=[(20, 0), (20, 40)])
    strokes = _strokes()
    how = MovingLinks(Linking(25.0), UP, tool)
    path = join_moves(strokes, how)
    assert np.array_equal(path.cl[path.kind == Motion.CUT], np.concatenate([s[0].tip[1:] for s in strokes]))
    turned = np.linalg.norm(np.diff(path.axis, axis=0), axis=1) > 0
    across = turned & (path.kind[1:] == Motion.LINK)
    assert across.sum() == 1 and set(path.kind[1:][turned].tolist()) == {Motion.CUT, Motion.LINK}
    k = int(np.flatnonzero(across)[0])
    for share in np.linspace(0, 1, 21):
        axis = (1 - share) * path.axis[k] + share * path.axis[k + 1]
        axis /= np.linalg.norm(axis)
        tip = (1 - share) * path.cl[k] + share * path.cl[k + 1]
        outward = UP - (UP @ axis) * axis
        outward /= max(np.linalg.norm(outward), 1e-12)
        rim = [tip + z * axis - r * outward for r, z in ((6, 0), (6, 30), (20, 30), (20, 70))]
        assert min(point[2] for point in rim) >= 25.0


def _beside_only(start: np.ndarray, end: np.ndarray, before: np.ndarray, after: np.ndarray,
                 motion: LinkMotion) -> np.ndarray:
    return np.full(len(start), motion is not LinkMotion.CROSSING)


def test_a_stroke_beside_is_reached_straight_over_with_an_axis_between() -> None:
    strokes = _strokes()
    strokes[1] = [MovingCuttingMove(one.contact[::-1], one.tip[::-1], one.normal[::-1],
                                    np.array([[0.6, 0.0, 0.8]] * 9)) for one in strokes[1]]
    free = MovingLinks(Linking(200.0), UP, TORUS, _beside_only)
    path = join_moves(strokes, free)
    assert (path.kind[3:-2] != Motion.LINK).all() and path.breaks.tolist() == [0, 14, len(path.kind)]
    over = np.flatnonzero(path.kind == Motion.EXIT)[1]
    assert path.kind[over:over + 3].tolist() == [Motion.EXIT, Motion.ENTRY, Motion.ENTRY]
    ends = path.cl[[over - 1, over + 1]]
    assert np.allclose(path.cl[over], ends.mean(axis=0))
    assert np.allclose(path.axis[over], unit(path.axis[over - 1] + path.axis[over + 1]))
    assert np.array_equal(path.cl[path.kind == Motion.CUT], np.concatenate([s[0].tip[1:] for s in strokes]))


def test_links_are_as_low_as_they_may() -> None:
    asked: list[tuple[float, bool]] = []

    def clear(start: np.ndarray, end: np.ndarray, before: np.ndarray, after: np.ndarray,
              motion: LinkMotion) -> np.ndarray:
        over = motion is LinkMotion.CROSSING
        asked.append((float(start[0, 2]) if len(start) else 0.0, over))
        return np.array([z > 6.0 if over else z > 2.0 for z in end[:, 2]], dtype=bool)

    path = join_moves(_strokes(), MovingLinks(Linking(200.0), UP, TORUS, clear))
    link = np.flatnonzero((path.kind == Motion.LINK) & (np.arange(len(path.kind)) > 3))
    assert path.cl[link[0], 2] < 15.0 < 200.0 <= path.cl[0, 2] and len(asked) > 3
