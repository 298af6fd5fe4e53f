"""Passes: scallop by brute force, spacing, ends, holes, walls, directions, points and links."""

import numpy as np
import pytest

from toolaxis.cldata.toolpath import Motion
from toolaxis.contact.placement import place
from toolaxis.contact.strip.width import step_widths
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.path import planes
from toolaxis.path.iso_parametric import layout, passes
from toolaxis.path.links import Linking
from toolaxis.path.overrun import overrun_length
from toolaxis.path.parametrization import Cut, IsoChart
from toolaxis.shape.analytic import SphericalSurface
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance
from toolaxis.tools.tool import Tool

TORUS = Tool.torus(12, 1)
H = 0.02


def _cut_points(path):
    return path.kind == Motion.CUT


def _strokes(path):
    """Rows of each stroke: cut points with the one the entry arrives at."""
    cut = np.flatnonzero(_cut_points(path))
    parts = np.split(cut, np.flatnonzero(np.diff(cut) > 1) + 1)
    return [np.append(part[0] - 1, part) for part in parts]


def test_on_a_plane_the_passes_are_range_over_width_and_lie_half_a_width_off_the_borders(make):
    face, axis, width = make["flat"](30, 50), make["leaning"](10), 2.171571
    found = layout(face, TORUS, axis, H)
    assert len(found.steps) == 24 and found.used == pytest.approx(50 / width, rel=5e-4)
    y = 50 * found.steps
    assert y[0] == pytest.approx(width / 2, rel=1e-3) and y[-1] == pytest.approx(50 - width / 2, rel=1e-3)
    gaps = np.diff(y)[:-1]
    assert (gaps <= width * (1 + 1e-6)).all() and (gaps >= width * (1 - 5e-4)).all()


@pytest.mark.parametrize(("seed", "trim", "feed", "axis"), [(1, False, "u", (25, 10)), (2, False, "v", (30, 80)),
                                                            (3, True, "u", (20, 30))])
def test_scallop_by_brute_force(make, seed, trim, feed, axis):
    face = make["holed"](make["wavy"](seed)) if trim else make["wavy"](seed)
    path = passes(face, TORUS, make["leaning"](*axis), H, feed)
    rng = np.random.default_rng(0)
    inner = rng.uniform(*np.array(face.bounds).reshape(2, 2).T, (400, 2))
    rim = np.concatenate([loop[rng.integers(0, len(loop), 12)] for loop in face.outline])
    height = make["scallops"](path, face, TORUS, np.concatenate([inner[face.contains(inner)][:110], rim]), 3 * H)
    assert height.max() <= 1.003 * H, "chords add nothing to it"


@pytest.mark.parametrize("feed", ["u", "v"])
def test_the_scallop_height_is_reached_at_the_tight_place(make, feed):
    face, axis = make["wavy"](1), make["leaning"](25, 30)
    found = layout(face, TORUS, axis, H, feed)
    path = passes(face, TORUS, axis, H, feed, tolerance=Tolerance(chord=1e-5))
    k = len(found.steps) // 2
    a, b = found.steps[k], found.steps[k + 1]
    along = np.linspace(0, 1, 201)
    order = [0, 1] if feed == "u" else [1, 0]
    upper = step_widths(face, TORUS, np.column_stack([along, np.full(201, a)])[:, order], axis, H, feed)[:, 1]
    lower = step_widths(face, TORUS, np.column_stack([along, np.full(201, b)])[:, order], axis, H, feed)[:, 0]
    slack = (upper + lower) / (b - a) - 1
    i = int(slack.argmin())
    assert -1e-3 <= slack[i] <= 1e-3
    meeting = np.array([[along[i], (a + upper[i] + b - lower[i]) / 2]])[:, order]
    height = make["scallops"](path, face, TORUS, meeting, 3 * H)[0]
    assert 0.985 * H <= height <= 1.005 * H


def test_ends_are_covered_and_run_out_is_short(make):
    face, axis = make["wavy"](1), make["leaning"](25, 10)
    path = passes(face, TORUS, axis, H)
    beyond = np.maximum(-path.cc[_cut_points(path), 0], path.cc[_cut_points(path), 0] - 40)
    assert 0 < beyond.max() < 2.0
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0.5], [1, 0.5]], float)
    assert make["scallops"](path, face, TORUS, corners, 3 * H).max() <= 1.003 * H


def test_no_cut_over_a_hole_beyond_the_run_out(make):
    face = make["holed"](make["wavy"](1))
    path = passes(face, TORUS, make["leaning"](25, 10), H)
    uv = path.cc[_cut_points(path), :2] / [40, 30]
    assert np.linalg.norm((uv - 0.5) / 0.12, axis=1).min() > 0.35
    assert len(_strokes(path)) > path.passes, "passes across the hole are in two strokes"


@pytest.mark.parametrize("chord", [None, 4e-4])
@pytest.mark.parametrize("seed", [2, 5, 7])
def test_chords_of_contacts_keep_the_tolerance_and_those_of_tips_stay_above_nothing(make, seed, chord):
    """Points of hollow stretches lie deeper, so that tips are never above the pass, nor much deeper than chords are."""
    face, axis, limits = make["wavy"](seed), make["leaning"](25, 10), Tolerance(chord=chord)
    path, most = passes(face, TORUS, axis, H, tolerance=limits), limits.chord_for(H)
    away, above = [], []
    for rows in _strokes(path)[::5]:
        u, v = (path.cc[rows, :2] / [40, 30]).T
        for share in (0.0, 0.25, 0.5, 0.8):
            at = u[:-1] + share * np.diff(u)
            keep = (at > 0) & (at < 1)
            uv = np.column_stack([at, v[:-1]])[keep]
            for curve, nodes in ((face.evaluate(uv).point, path.cc), (place(face, TORUS, uv, axis), path.cl)):
                a, b = nodes[rows[:-1]][keep], nodes[rows[1:]][keep]
                t = np.clip(((curve - a) * (b - a)).sum(1) / ((b - a) ** 2).sum(1), 0, 1)
                off = a + t[:, None] * (b - a) - curve
                (away if nodes is path.cc else above).append(
                    np.linalg.norm(off, axis=1) if nodes is path.cc else (off * face.normal(uv)).sum(axis=1))
    away, above = np.concatenate(away), np.concatenate(above)
    assert 0.2 * most < away.max() <= 1.02 * most
    assert above.max() <= 0.05 * most and -1.5 * most <= above.min() < -0.2 * most
    assert (above >= -1.02 * most).mean() > 0.95, "deeper only beside places where hollow turns to convex"


def test_what_may_not_be_visited_is_cut_out(make):
    face = make["wavy"](1)

    def reach(uv):
        return np.asarray(uv[:, 0] < 0.6)

    path = passes(face, TORUS, make["leaning"](25, 10), H, reach=reach)
    assert path.cc[_cut_points(path), 0].max() <= 0.6 * 40 + 1e-6
    rng = np.random.default_rng(0)
    uv = np.column_stack([rng.uniform(0, 0.55, 40), rng.uniform(0, 1, 40)])
    assert make["scallops"](path, face, TORUS, uv, 3 * H).max() <= 1.02 * H
    assert passes(face, TORUS, make["leaning"](25), H, reach=lambda uv: np.zeros(len(uv), bool)).passes == 0


def test_a_closed_face_has_nowhere_to_run_out_to():
    dome = Face(SphericalSurface(30.0, (0.0, 2 * np.pi), (0.9, 1.2)).nurbs())
    path = layout(dome, Tool.ball(6), [0, 0, 1.0], H)
    assert np.allclose(path.pieces[:, 0], dome.bounds[0]) and np.allclose(path.pieces[:, 1], dome.bounds[1])


def test_zigzag_turns_every_other_pass_and_climb_has_the_uncut_side_on_its_right(make):
    face, axis = make["wavy"](1), make["leaning"](25, 10)
    heading = {}
    for direction in ("zigzag", "climb", "conventional"):
        path = passes(face, TORUS, axis, H, direction=direction)
        heading[direction] = np.array([path.cc[r[-1], 0] - path.cc[r[0], 0] for r in _strokes(path)])
    assert (np.sign(heading["zigzag"][1:]) == -np.sign(heading["zigzag"][:-1])).all()
    assert (np.sign(heading["climb"]) == -np.sign(heading["conventional"])).all()
    # passes step towards +y; to the right of the feed, f x T, means f along -x when T points up
    assert (heading["climb"] < 0).all()


def test_climb_does_not_depend_on_the_way_the_face_is_parametrised(make):
    face, axis = make["wavy"](1), make["leaning"](25, 10)
    other = Face(face.surface.swapped(), flip=True)
    for a, b in (("u", "v"), ("v", "u")):
        one, two = (passes(f, TORUS, axis, H, feed, direction="climb") for f, feed in ((face, a), (other, b)))
        assert np.allclose(one.cl, two.cl, atol=1e-6)


def test_links_go_across_only_above_everything(make):
    face, axis = make["holed"](make["wavy"](1)), make["leaning"](25, 10)
    path = passes(face, TORUS, axis, H)
    move = np.diff(path.cl, axis=0)
    across = np.linalg.norm(move - (move @ axis)[:, None] * axis, axis=1) > 1e-9
    height = path.cl @ axis
    corners = np.array(np.meshgrid(*face.box.T)).reshape(3, -1).T
    link = path.kind[1:] == Motion.LINK
    assert (np.minimum(height[1:], height[:-1])[across & link] >= (corners @ axis).max() + 5 - 1e-9).all()
    assert path.kind[0] == Motion.LINK and path.kind[-1] == Motion.LINK
    assert np.allclose(path.axis, axis)
    first = [path.kind[b] for b in path.breaks[:-1]]
    assert first == [Motion.LINK] * path.passes
    entry = np.flatnonzero((path.kind[:-1] == Motion.ENTRY) & (path.kind[1:] == Motion.CUT))
    into, along = path.cl[entry] - path.cl[entry - 1], path.cl[entry + 1] - path.cl[entry]
    assert ((into * along).sum(axis=1) > 0).all() and (into @ axis < 0).all(), "the ramp comes down along the feed"


def test_a_given_height_and_plain_plunges(make):
    face, axis = make["flat"](20, 10), make["leaning"](10)
    path = passes(face, TORUS, axis, H, linking=Linking(height=80.0, run_in=0.0, approach=3.0))
    assert (path.cl @ axis).max() == pytest.approx(80.0)
    entry = np.flatnonzero(path.kind == Motion.ENTRY)
    into = path.cl[entry] - path.cl[entry - 1]
    assert np.allclose(into, -3.0 * axis, atol=1e-9)


@pytest.mark.parametrize("run_in", [0.0, 1.0])
@pytest.mark.parametrize("lean", [0, 1])
def test_flanks_are_left_sideways(make, run_in, lean):
    """A retract along an axis that runs along the surface would scrape what stands between the passes."""
    face, angle = make["flat"](20, 10), np.radians(90 - lean)
    axis = np.array([np.sin(angle), 0.0, np.cos(angle)])
    path = passes(face, TORUS, axis, H, feed="v", linking=Linking(height=80.0, run_in=run_in))
    gone = np.flatnonzero((path.kind[1:] == Motion.LINK) | (path.kind[:-1] == Motion.LINK))
    lowest = np.minimum(path.cl[gone, 2], path.cl[gone + 1, 2])
    side = path.cl[_cut_points(path), 2].max()
    assert (lowest > side + 0.1).all(), "the tool leaves the plane before it rises along the axis at rapid"


def test_stock_is_left_on(make):
    face, axis = make["flat"](20, 10), make["leaning"](10)
    path = passes(face, TORUS, axis, H, allowance=0.5)
    plain = passes(face, TORUS, axis, H)
    cut = _cut_points(path)
    assert np.allclose(path.cl[cut, 2] - plain.cl[_cut_points(plain), 2][0], 0.5)


def test_a_face_narrower_than_a_strip_takes_one_pass_in_its_middle(make):
    found = layout(make["flat"](20, 1.0), TORUS, make["leaning"](10), H)
    assert found.steps.tolist() == pytest.approx([0.5], abs=1e-3)
    assert found.used == pytest.approx(1.0 / 2.171571, rel=1e-3)


def test_parallel_planes_keep_the_scallop_and_their_planes(make):
    face, axis = make["wavy"](1, (24.0, 18.0), 1.0), make["leaning"](25, 10)
    path = planes.passes(face, TORUS, axis, H, [1, 0.4, 0])
    feed = np.array([1, 0.4, 0]) - (np.array([1, 0.4, 0]) @ axis) * axis
    across = np.cross(axis, feed / np.linalg.norm(feed))
    places = [np.ptp(path.cc[rows] @ across) for rows in _strokes(path)]
    assert max(places) < 1e-9
    uv = np.random.default_rng(0).uniform(0, 1, (60, 2))
    height = make["scallops"](path, face, TORUS, uv, 3 * H)
    assert 0.7 * H < height.max() <= 1.02 * H
    with pytest.raises(UnsupportedGeometry, match="turns away"):
        planes.passes(face, TORUS, [1, 0, 0.01], H, [0, 1, 0])
    with pytest.raises(InvalidInput, match="along the axis"):
        planes.passes(face, TORUS, axis, H, axis)


def test_parallel_planes_on_a_plane_are_range_over_width(make):
    axis = make["leaning"](10)
    face = make["flat"](30, 50)
    assert planes.layout(face, TORUS, axis, H, [1, 0, 0]).used == pytest.approx(50 / 2.171571, rel=1e-3)
    assert planes.count(face, TORUS, axis, H, [1, 0, 0]).passes == pytest.approx(50 / 2.171571, rel=1e-4)


@pytest.mark.parametrize("bad", [{"direction": "spiral"}, {"scallop": -1.0}, {"axis": [0, 0.3, -1]},
                                 {"linking": {"height": float("nan")}}, {"linking": {"height": 9, "run_in": -1}}])
def test_bad_arguments(make, bad):
    arguments = {"axis": [0.3, 0, 1], "scallop": H} | bad
    with pytest.raises(InvalidInput):
        if "linking" in arguments:
            arguments["linking"] = Linking(**arguments["linking"])
        passes(make["flat"](10, 10), TORUS, **arguments)


def test_a_part_of_the_face_that_turns_away_may_be_left_out():
    # an arch cut aslant: lines across the passes leave what the axis sees at different steps
    t, y = np.meshgrid(np.linspace(-1.2, 1.2, 9), np.linspace(0, 1, 4), indexing="ij")
    face = Face.from_bspline(np.stack([25 * np.sin(t + 0.8 * y), 20 * y, 25 * np.cos(t + 0.8 * y)], axis=-1))

    def reach(uv):
        return np.asarray(face.normal(uv)[:, 2] > 0.15)

    ball = Tool.ball(6)
    with pytest.raises(InvalidInput, match="no usable strip"):
        passes(face, ball, [0, 0, 1], H, "v")
    path = passes(face, ball, [0, 0, 1], H, "v", reach=reach)
    assert path.passes > 10 and path.normal[_cut_points(path), 2].min() >= 0.15 - 1e-3


@pytest.mark.parametrize("allowance", [-0.3, 0.4, 1.0])
def test_on_a_plane_passes_overrun_alike_whatever_is_left_on_it(make, allowance):
    chart, end, step = IsoChart(make["flat"](40, 30), "u"), np.ones(3), np.array([0.3, 0.5, 0.7])
    for lead, turn, scallop in ((8, 70, 0.02), (20, -80, 0.2), (5, 45, 0.05)):
        cuts = [Cut(TORUS, make["leaning"](lead, turn), scallop, stock) for stock in (0.0, allowance)]
        bare, left = (overrun_length(chart, cut, end, step, forward=True) for cut in cuts)
        assert left == pytest.approx(bare, abs=1e-12) and (bare > 0.003).all()
