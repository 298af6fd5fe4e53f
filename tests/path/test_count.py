"""Count and estimate: closed forms, passes really made, and answers that follow the face."""

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.errors import InvalidInput
from toolaxis.path.estimate import Estimator, estimate, sum_rows_numpy
from toolaxis.path.iso_parametric import layout
from toolaxis.path.parametrization import Cut, IsoChart
from toolaxis.path.pass_count import count, measure, panels
from toolaxis.path.sampling import sample_points
from toolaxis.path.width_correction import lean_ratio, lean_ratios, lean_table
from toolaxis.shape.analytic import CylindricalSurface
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

TORUS = Tool.torus(12, 1)

# lead, scallop, width of the swept strip on a plane: closed form
PLANE_WIDTHS = [(Tool.torus(12, 1), 10, 0.02, 2.171571), (Tool.torus(12, 1), 20, 0.1, 3.489056),
                (Tool.torus(16, 2), 10, 0.02, 2.407950), (Tool.torus(10, 3), 20, 0.02, 1.185783),
                (Tool.flat(20), 5, 0.1, 9.301820), (Tool.ball(12), 20, 0.02, 0.978979)]


@pytest.mark.parametrize(("tool", "lead", "scallop", "width"), PLANE_WIDTHS)
def test_count_and_estimate_on_a_plane_are_range_over_width(make, tool, lead, scallop, width):
    face, axis = make["flat"](30, 50), make["leaning"](lead)
    assert count(face, tool, axis, scallop) == pytest.approx(50 / width, rel=2e-6)
    assert estimate(face, tool, axis, scallop) == pytest.approx(50 / width, rel=2e-6)
    assert estimate(face, tool, axis, scallop, literal=True) == pytest.approx(50 / width, rel=2e-6)


@pytest.mark.parametrize(("radius", "flip", "width"), [(40.0, False, 0.912679), (60.0, True, 1.032110)])
def test_a_ball_on_a_cylinder_takes_arc_over_width(radius, flip, width):
    shape = CylindricalSurface(radius, (0.4, 1.3), (0.0, 30.0))
    face = Face(shape.nurbs(), flip=flip)
    inward = -1 if flip else 1
    axis = inward * np.array([np.cos(0.85), np.sin(0.85), 0.3])
    assert count(face, Tool.ball(12), axis, 0.02, "v") == pytest.approx(radius * 0.9 / width, rel=5e-4)
    assert estimate(face, Tool.ball(12), axis, 0.02, "v") == pytest.approx(radius * 0.9 / width, rel=2e-3)


def test_length_on_a_plane_is_area_over_width(make):
    face, axis = make["flat"](30, 50), make["leaning"](10)
    found = measure(IsoChart(face, "u"), Cut(TORUS, axis, 0.02))
    assert found.length == pytest.approx(30 * 50 / 2.171571, rel=1e-5)
    assert Estimator.of(face, TORUS, 0.02).many([axis]).length[0, 0] == pytest.approx(found.length, rel=1e-5)


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("trim", [False, True])
def test_count_agrees_with_passes_made(make, seed, trim):
    face = make["wavy"](seed, (90.0, 70.0), 5.0)
    face = make["holed"](face) if trim else face
    for axis in (make["leaning"](25), make["leaning"](15, 20)):
        made = layout(face, TORUS, axis, 0.02).used
        assert count(face, TORUS, axis, 0.02) == pytest.approx(made, rel=2e-3)


ALONG_THE_PASSES = {
    "rectangle": [[0, 0], [1, 0], [1, 1], [0, 1]],
    "angle": [[0, 0], [1, 0], [1, .5], [.5, .5], [.5, 1], [0, 1]],
    "trough": [[0, 0], [1, 0], [1, 1], [.75, 1], [.75, .5], [.25, .5], [.25, 1], [0, 1]],
}


@pytest.mark.parametrize("name", ALONG_THE_PASSES)
@pytest.mark.parametrize("feed", ["u", "v"])
def test_noise_of_loops_along_the_passes_changes_no_count(make, name, feed):
    """The first and the last pass are those along the border, not along the one vertex that is farthest out."""
    rng, loop = np.random.default_rng(5), np.array(ALONG_THE_PASSES[name])
    whole, cut = make["wavy"](3, (50.0, 40.0), 4.0), Cut(TORUS, make["leaning"](20, 30), 0.05)
    chart = IsoChart(whole.trimmed((loop,)), feed)
    exact = measure(chart, cut)
    for off in (1e-16, 1e-12, 1e-8, 1e-7):
        moved = np.clip(loop + off * rng.standard_normal(loop.shape), 0, 1)
        other = IsoChart(whole.trimmed((moved,)), feed)
        assert measure(other, cut) == pytest.approx(exact, rel=1e-3)
        assert panels(other) == pytest.approx(panels(chart), abs=1e-5)


def _sheet(seed):
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(0, 120, 6), np.linspace(0, 90, 5), indexing="ij")
    c, p = rng.uniform(-1, 1, 3), rng.uniform(0, 2 * np.pi, 2)
    z = 7 * (c[0] * np.sin(x / 38 + p[0]) + c[1] * np.cos(y / 30 + p[1]) + c[2] * x * y / 10800)
    return Face.from_bspline(np.stack([x, y, z], axis=-1))


@pytest.mark.parametrize("mirrored", [False, True])
def test_lopsided_strips_are_counted_as_they_are_made(mirrored):
    # 3 deg from a normal a strip reaches one and a half times as far to one side as to the other, on opposite sides
    # at both ends of the face: half widths alone, taken at one pass, are half a pass short
    face, axis = _sheet(1), np.array([0.08031135, -0.01030142, 0.99671659])
    face, axis = _moved(face, axis, "mirrored") if mirrored else (face, axis)
    made = layout(face, TORUS, axis, 0.02).used
    assert count(face, TORUS, axis, 0.02) == pytest.approx(made, rel=2e-3)


@pytest.mark.parametrize("share", [0.01, 0.5, 1.0, 1.5, 40.3])
def test_faces_of_any_number_of_strips_are_counted(make, share):
    assert count(make["flat"](30, 2.171571 * share), TORUS, make["leaning"](10), 0.02) == pytest.approx(share, rel=2e-6)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_estimate_agrees_with_count_and_beats_the_literal_scheme(make, seed):
    face = make["wavy"](seed)
    axes = np.array([make["leaning"](a) for a in (-40, -30, -25, 20, 25, 30, 40)])
    near = np.degrees(np.arccos((axes @ face.normal(face.grid(30, 30)).T).max(axis=1)))
    axes = axes[near >= 3]
    true = np.array([count(face, TORUS, a, 0.02) for a in axes])
    ours, theirs = estimate(face, TORUS, axes, 0.02), estimate(face, TORUS, axes, 0.02, literal=True)
    assert len(axes) >= 4
    assert np.abs(ours / true - 1).max() < 0.01
    assert np.abs(ours / true - 1).max() < np.abs(theirs / true - 1).max()


def test_refinement_keeps_what_it_promises(make):
    face, axis = make["holed"](make["wavy"](1)), make["leaning"](20, 30)
    chart, cut = IsoChart(face, "u"), Cut(TORUS, axis, 0.02)
    coarse, fine = measure(chart, cut), measure(chart, cut, 1e-6)
    assert coarse.passes == pytest.approx(fine.passes, rel=1e-3)
    assert coarse.length == pytest.approx(fine.length, rel=1e-3)


def _moved(face, axis, kind):
    m = np.eye(4)
    if kind == "turned":
        m[:3, :3] = np.linalg.qr(np.array([[1, 2, 3], [0, 1, 4], [5, 6, 0.0]]))[0]
        m[:3, :3] *= np.sign(np.linalg.det(m[:3, :3]))
        m[:3, 3] = 5, -60, 12
    if kind == "mirrored":
        m[0, 0] = -1
    return face.transformed(m), m[:3, :3] @ axis


@pytest.mark.parametrize("kind", ["turned", "mirrored"])
def test_moving_the_face_changes_no_answer(make, kind):
    face, axis = make["holed"](make["wavy"](4)), make["leaning"](22, 15)
    other, turned = _moved(face, axis, kind)
    assert count(other, TORUS, turned, 0.02) == pytest.approx(count(face, TORUS, axis, 0.02), rel=1e-6)
    samples = sample_points(face, TORUS)
    one, two = (Estimator.of(f, TORUS, 0.02, samples=samples).many([a]) for f, a in ((face, axis), (other, turned)))
    assert np.allclose(one.passes, two.passes, rtol=1e-6) and np.allclose(one.length, two.length, rtol=1e-9)


def test_swapped_parameters_swap_the_feeds(make):
    face, axis = make["wavy"](4), make["leaning"](22, 15)
    other = Face(face.surface.swapped(), flip=True)
    assert count(other, TORUS, axis, 0.02, "v") == pytest.approx(count(face, TORUS, axis, 0.02, "u"), rel=1e-9)
    assert estimate(other, TORUS, axis, 0.02, "v") == pytest.approx(estimate(face, TORUS, axis, 0.02, "u"), rel=2e-3)


def test_everything_twice_as_large_takes_as_many_passes(make):
    face, axis = make["wavy"](4), make["leaning"](22, 15)
    big = face.transformed(np.diag([2.0, 2, 2, 1]))
    one, two = (measure(IsoChart(f, "u"), Cut(t, axis, h)) for f, t, h in
                ((face, TORUS, 0.02), (big, Tool.torus(24, 2), 0.04)))
    assert two.passes == pytest.approx(one.passes, rel=1e-6)
    assert two.length == pytest.approx(2 * one.length, rel=1e-6)


def test_an_axis_below_the_face_leaves_no_strip(make):
    face = make["wavy"](1)
    assert count(face, TORUS, [0, 0.2, -1], 0.02) == np.inf
    assert estimate(face, TORUS, [0, 0.2, -1], 0.02) == np.inf
    assert Estimator.of(face, TORUS, 0.02).many([[0, 0.2, -1.0]], exact=False).passes.tolist() == [[np.inf, np.inf]]


def test_many_axes_at_once_are_the_single_ones(make):
    face = make["holed"](make["wavy"](2))
    axes = np.array([make["leaning"](a, b) for a, b in ((20, 0), (25, 90), (30, 200))])
    ready = Estimator.of(face, TORUS, 0.02)
    many = ready.many(axes)
    for i, axis in enumerate(axes):
        for k, feed in enumerate("uv"):
            assert many.passes[i, k] == pytest.approx(estimate(face, TORUS, axis, 0.02, feed), rel=1e-12)
    assert np.isinf(ready.many(axes, "u").passes[:, 1]).all()


@pytest.mark.parametrize("most", [np.inf, 0.6])
def test_the_kernel_and_its_twin_agree(make, most):
    ready = Estimator.of(make["holed"](make["wavy"](2)), TORUS, 0.02, greatest_step_over=most)
    axes = np.array([make["leaning"](a, b) for a, b in ((20, 0), (25, 90), (30, 200), (100, 0))])
    ratio = np.random.default_rng(0).uniform(0.9, 1.1, (4, len(ready.samples) + 60))
    for table in ready.rows:
        one = ready._sums(table, axes, ratio)
        two = np.empty(4), np.empty(4)
        sum_rows_numpy(table, axes, ratio, ready.leans, (ready._cutter(), 0.02, most), *two)
        assert np.allclose(one, two, rtol=1e-12)


def test_lean_table_is_one_for_a_small_scallop_and_its_twins_agree():
    fine = lean_table(TORUS, 1e-6)
    assert np.abs(fine[8:-1] - 1).max() < 2e-3, "beyond a lean of six degrees the second order is exact in the limit"
    table = lean_table(TORUS, 0.02)
    along, across = np.random.default_rng(1).uniform(-0.7, 0.7, (2, 50))
    single = [lean_ratio(table, a, b) for a, b in zip(along, across, strict=True)]
    assert np.allclose(lean_ratios(table, along, across), single)


@pytest.mark.parametrize("bad", [{"scallop": 0.0}, {"scallop": 6.0}, {"scallop": float("nan")}, {"feed": "w"},
                                 {"axis": [0, 0, 0]}, {"axis": [[0, 0, 1], [0, 1, 0]]}, {"allowance": float("inf")}])
def test_bad_arguments(make, bad):
    arguments = {"axis": [0.3, 0, 1], "scallop": 0.02, "feed": "u"} | bad
    with pytest.raises(InvalidInput):
        count(make["flat"](10, 10), TORUS, **arguments)


def test_small_parts_far_apart_between_all_rows():
    """What a larger tool leaves of a long face may be a speck at either end: no row of the estimate meets one."""
    x, y = np.meshgrid(np.linspace(0, 40, 5), np.linspace(0, 40, 5), indexing="ij")
    whole = Face.from_bspline(np.stack([x, y, 0.01 * x * y / 40], axis=-1))
    speck = 0.001 * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    face = whole.trimmed((speck, speck + 0.999))
    told = Estimator.of(face, Tool.ball(2), 0.02).many([[0.0, 0.0, 1.0], [0.3, 0.2, 0.9]])
    assert np.isinf(told.passes).all() and np.isinf(told.length).all()
    found = ta.best_axis(face, Tool.ball(2), 0.02)
    assert found.outcome != "feasible" or found.passes > 0
