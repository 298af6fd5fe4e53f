"""Strip width: closed forms, the limit of small heights, moves and mirrors, and the ends of its range."""

import numpy as np
import pytest
from scipy.optimize import brentq

from toolaxis.contact.frame import axis_from_lean, contact_frame
from toolaxis.contact.strip.second_order import second_order_step_widths, second_order_width
from toolaxis.contact.strip.width import step_widths, step_widths_many_axes, strip_width
from toolaxis.errors import InvalidInput
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

SHARE = np.cos(np.pi / 4)
CENTRE = [[0.5, 0.5]]
MICRO = 1e-6 * 0.5000001  # numbers are known to six decimals


def plane(size=60.0):
    return Face.from_bspline([[[0, 0, 0], [0, size, 0]], [[size, 0, 0], [size, size, 0]]], degree=(1, 1))


def arc(radius):
    """Control points (x, z) and weights of the quarter circle about the origin that is centred on +z."""
    return np.array([[-SHARE, SHARE], [0.0, 1 / SHARE], [SHARE, SHARE]]) * radius, np.array([1.0, SHARE, 1.0])


def cylinder(radius, concave=False):
    """A quarter cylinder along y, crest at (0.5, v), feed v along its axis; u runs around."""
    points, weights = arc(radius)
    net = np.array([[[x, y, z] for y in (0.0, 60.0)] for x, z in points])
    return Face.from_bspline(net, (2, 1), None, np.repeat(weights[:, None], 2, axis=1), flip=concave)


def sphere(radius, concave=False):
    """A patch of 90 by 90 degrees about +z, both iso-curves through its centre great circles."""
    points, weights = arc(radius)
    net = [[[x * t[1] / radius, t[0], z * t[1] / radius] for t in points] for x, z in points]
    return Face.from_bspline(net, (2, 2), None, np.outer(weights, weights), flip=concave)


def rod(radius):
    """Three quarters of a thin rod along y, open below; feed u runs around it, crest at (0.5, v)."""
    turn = np.radians(225 - 45 * np.arange(7))
    reach = np.where(np.arange(7) % 2, 1 / SHARE, 1.0) * radius
    net = np.stack([np.stack([reach * np.cos(turn), np.full(7, y), reach * np.sin(turn)], axis=1) for y in (0.0, 60.0)],
                   axis=1)
    weights = np.where(np.arange(7) % 2, SHARE, 1.0)
    knots = (np.repeat([0.0, 1 / 3, 2 / 3, 1.0], [3, 2, 2, 3]), np.array([0.0, 0.0, 1.0, 1.0]))
    return Face.from_bspline(net, (2, 1), knots, np.repeat(weights[:, None], 2, axis=1))


def leaning(face, lean_deg, way_deg=0.0, feed="u", uv=CENTRE):
    return axis_from_lean(contact_frame(face, uv, feed), np.radians(lean_deg), np.radians(way_deg))


def wavy(seed=0, flip=False, height=4.0):
    rng = np.random.default_rng(seed)
    xy = np.stack(np.meshgrid(np.linspace(0, 90, 6), np.linspace(0, 90, 6), indexing="ij"), -1)
    net = np.concatenate([xy + rng.normal(size=(6, 6, 2)), rng.normal(size=(6, 6, 1)) * height], -1)
    return Face.from_bspline(net, flip=flip)


def swept_plane_width(tool, lean, h):
    """Swept torus on a plane, lean in the feed: its boundary (y, z) as a curve in t, cut at z = h."""
    a, r = tool.flat_radius, tool.corner_radius
    b = a * np.sin(lean)

    def point(t):
        q = np.hypot(b * np.sin(t), a * np.cos(t))
        return a * np.sin(t) + r * b * np.sin(t) / q, r + b - b * np.cos(t) - r * a * np.cos(t) / q

    t = brentq(lambda t: point(t)[1] - h, 0.0, np.pi / 2, xtol=1e-15)
    return 2 * point(t)[0]


PLANE_WIDTHS = [("torus:10x3", 20, 2.616177, 1.185783), ("torus:12x1", 5, 6.445430, 3.021934),
                ("torus:12x1", 10, 4.749392, 2.171571), ("torus:12x1", 20, 3.489056, 1.576752),
                ("torus:16x2", 10, 5.290774, 2.407950), ("ball:12", 20, 2.181742, 0.978979)]


@pytest.mark.parametrize("radius", [0.05, 0.3, 0.8])
@pytest.mark.parametrize("name", ["ball:6", "tapered:2x1x3", "torus:10x3"])
def test_what_the_cutter_does_not_touch_is_no_part_of_a_pass(radius, name):
    """Found: around a thin edge a pass went on along the back of the blade, where the shank stands through it; strips
    of 0.35 mm came out 3 mm wide."""
    tool, h = Tool.parse(name), 0.02
    for u in (0.5, 0.42):
        place = [[u, 0.5]]
        face = rod(radius)
        normal = face.normal(np.array(place))[0]
        # The section along the rod is straight, and the cutter nearest at the contact itself.
        half = step_widths(face, tool, place, normal + np.array([0.0, 0.0, 0.3]), h, "u")[0] * 60.0
        wanted = step_widths(plane(), tool, CENTRE, [0.0, 0.0, 1.0], h, "u")[0] * 60.0
        if tool.flat_radius == 0.0:
            assert half == pytest.approx(wanted, abs=1e-9)
        assert (half <= 1.01 * wanted).all() and (half > 0.0).all()


@pytest.mark.parametrize("name, lead, wide, narrow", PLANE_WIDTHS)
@pytest.mark.parametrize("feed, way", [("u", 0), ("u", 180), ("v", 0), ((1.0, 2.0, 0.0), 0)])
def test_width_on_a_plane_in_numbers(name, lead, wide, narrow, feed, way):
    face, tool = plane(), Tool.parse(name)
    axis = leaning(face, lead, way, feed)
    for h, wanted in ((0.1, wide), (0.02, narrow)):
        half = strip_width(face, tool, CENTRE, axis, h, feed)[0]
        assert abs(half.sum() - wanted) < MICRO and abs(half[0] - half[1]) < 1e-10
        if isinstance(feed, str):
            steps = step_widths(face, tool, CENTRE, axis, h, feed)[0]
            assert np.abs(steps * 60 - half).max() < 1e-10


@pytest.mark.parametrize("lead", [0.5, 1, 2, 5, 20, 50, 80])
@pytest.mark.parametrize("name", ["torus:12x0.2", "torus:12x1", "torus:12x5", "flat:20", "flat:6"])
def test_width_on_a_plane_against_the_closed_form(name, lead):
    face, tool = plane(200), Tool.parse(name)
    lean = np.radians(lead)
    for h in (0.001, 0.02, 0.1):
        if tool.corner_radius > 0:
            wanted = swept_plane_width(tool, lean, h)
        else:
            wanted = 2 * tool.radius * np.sqrt(1 - max(1 - h / (tool.radius * np.sin(lean)), 0.0) ** 2)
        half = strip_width(face, tool, CENTRE, leaning(face, lead), h)[0]
        assert abs(half.sum() - wanted) < 1e-8


def test_oblique_lean_in_numbers():
    face, tool = plane(), Tool.torus(12, 1)
    half = strip_width(face, tool, CENTRE, leaning(face, 10, 45), 0.02)[0]
    assert abs(half[0] - 0.707214) < MICRO and abs(half[1] - 0.856524) < MICRO
    other = strip_width(face, tool, CENTRE, leaning(face, 10, -45), 0.02)[0]
    assert np.abs(other - half[::-1]).max() < 1e-10


@pytest.mark.parametrize("name, radius, concave, lead, wanted", [
    ("torus:12x1", 40, False, 5, 1.944537), ("torus:12x1", 40, False, 10, 1.649383),
    ("torus:12x1", 40, False, 20, 1.338298), ("torus:12x1", 60, True, 5, 7.100029),
    ("torus:12x1", 60, True, 10, 3.015847), ("torus:12x1", 60, True, 20, 1.830238),
    ("ball:12", 40, False, 20, 0.912679), ("ball:12", 60, True, 20, 1.032110)])
def test_width_on_a_cylinder_in_numbers(name, radius, concave, lead, wanted):
    face, tool = cylinder(radius, concave), Tool.parse(name)
    for feed in ("v", (0.0, 1.0, 0.0)):
        half = strip_width(face, tool, CENTRE, leaning(face, lead, 0, "v"), 0.02, feed)[0]
        assert abs(half.sum() - wanted) < MICRO and abs(half[0] - half[1]) < 1e-9


@pytest.mark.parametrize("radius, concave, wanted", [(80, False, 0.944095), (80, True, 1.018023)])
@pytest.mark.parametrize("feed", ["u", "v", (1.0, -0.7, 0.0)])
@pytest.mark.parametrize("lead", [0, 30])
def test_width_of_a_ball_on_a_sphere_in_numbers(radius, concave, wanted, feed, lead):
    face = sphere(radius, concave)
    half = strip_width(face, Tool.ball(12), CENTRE, leaning(face, lead, 20), 0.02, feed)[0]
    assert abs(half.sum() - wanted) < MICRO and abs(half[0] - half[1]) < 1e-9


def test_nearly_flat_is_the_plane():
    net = np.stack([*np.meshgrid(np.linspace(0, 60, 4), np.linspace(0, 60, 4), indexing="ij"), np.zeros((4, 4))], -1)
    net[..., 2] += 1e-9 * np.random.default_rng(1).normal(size=(4, 4))
    face = Face.from_bspline(net)
    half = strip_width(face, Tool.torus(12, 1), CENTRE, leaning(plane(), 5), 0.02)[0]
    assert abs(half.sum() - 3.021934) < 2e-6


@pytest.mark.parametrize("name", ["torus:12x1", "torus:10x4", "ball:12", "tapered:8x2x5"])
@pytest.mark.parametrize("seed", range(4))
def test_the_error_of_the_second_order_width_falls_as_the_height(name, seed):
    face, tool = wavy(seed), Tool.parse(name)
    axis = leaning(face, 25, 30 * seed, uv=[[0.47, 0.52]])
    heights = 0.016 / 2.0 ** np.arange(5)
    for feed in ("u", "v"):
        wide = [strip_width(face, tool, [[0.47, 0.52]], axis, h, feed).sum() for h in heights]
        limit = [second_order_width(face, tool, [[0.47, 0.52]], axis, h, feed)[0] for h in heights]
        error = np.abs(np.array(wide) / limit - 1)
        rate = np.log2(error[:-1] / error[1:])
        assert error[0] < 0.1 and error[-1] < error[0]
        assert np.abs(rate[-2:] - 1).max() < 0.15, rate


def test_second_order_steps_are_the_limit_too():
    face, tool, uv = wavy(3), Tool.torus(12, 1), np.random.default_rng(0).uniform(0.3, 0.7, (30, 2))
    axis = leaning(face, 20, 30)
    for feed in ("u", "v"):
        exact = step_widths(face, tool, uv, axis, 1e-6, feed)
        limit = second_order_step_widths(face, tool, uv, axis, 1e-6, feed)
        assert np.abs(exact.sum(1) / limit.sum(1) - 1).max() < 1e-4
        assert np.abs(exact / limit - 1).max() < 1e-2  # each side on its own falls with the root only


def moves():
    rng = np.random.default_rng(7)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    return {"rigid": turn, "mirror": turn @ np.diag([1.0, -1.0, 1.0])}


@pytest.mark.parametrize("kind", ["rigid", "mirror"])
@pytest.mark.parametrize("name", ["torus:12x1", "flat:8", "tapered:8x1x5"])
@pytest.mark.parametrize("feed", ["u", "v", (0.3, 1.0, 0.1)])
def test_moved_and_mirrored_parts_keep_their_widths(kind, name, feed):
    face, tool, uv = wavy(1, flip=True), Tool.parse(name), np.random.default_rng(2).uniform(0.3, 0.7, (12, 2))
    turn, matrix = moves()[kind], np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, [5.0, -70.0, 20.0]
    axis = leaning(face, 25, 200, feed)
    fed = feed if isinstance(feed, str) else turn @ feed
    here = strip_width(face, tool, uv, axis, 0.02, feed)
    there = strip_width(face.transformed(matrix), tool, uv, axis @ turn.T, 0.02, fed)
    assert here.min() > 0.05 and np.abs(here[:, 0] - here[:, 1]).max() > 1e-3
    assert np.abs(there - (here if kind == "rigid" else here[:, ::-1])).max() < 1e-8
    if isinstance(feed, str):
        steps = [step_widths(f, tool, uv, t, 0.02, feed)
                 for f, t in ((face, axis), (face.transformed(matrix), axis @ turn.T))]
        assert np.abs(steps[0] - steps[1]).max() < 1e-10


def test_widths_scale_with_the_part():
    face, uv = wavy(2), np.random.default_rng(2).uniform(0.3, 0.7, (12, 2))
    axis = leaning(face, 15, 30)
    small = strip_width(face, Tool.torus(12, 1), uv, axis, 0.02)
    large = strip_width(face.transformed(np.diag([7.0, 7.0, 7.0, 1.0])), Tool.torus(84, 7), uv, axis, 0.14)
    assert np.abs(large / 7 - small).max() < 1e-9


@pytest.mark.parametrize("function", [strip_width, step_widths])
def test_swapped_parameters_swap_the_feed(function):
    face, tool, uv = wavy(4), Tool.torus(12, 1), np.random.default_rng(2).uniform(0.3, 0.7, (12, 2))
    axis = leaning(face, 15, 30)
    other = Face(face.surface.swapped(), flip=not face.flip)
    for feed, swapped in (("u", "v"), ("v", "u")):
        one = function(face, tool, uv, axis, 0.02, feed)
        assert np.abs(function(other, tool, uv[:, ::-1], axis, 0.02, swapped) - one).max() < 1e-9


@pytest.mark.parametrize("axis_number", [0, 1])
def test_reversed_parameters_swap_the_sides_only(axis_number):
    face, tool, uv = wavy(5), Tool.torus(12, 1), np.random.default_rng(2).uniform(0.3, 0.7, (12, 2))
    axis = leaning(face, 15, 30)
    net = np.flip(face.surface.control[..., :3], axis_number)
    other = Face.from_bspline(net, flip=True)
    back = uv.copy()
    back[:, axis_number] = 1 - uv[:, axis_number]
    for feed, along in (("u", 0), ("v", 1)):
        one, two = (strip_width(f, tool, p, axis, 0.02, feed) for f, p in ((face, uv), (other, back)))
        assert np.abs(two - (one[:, ::-1] if along == axis_number else one)).max() < 1e-9
        one, two = (step_widths(f, tool, p, axis, 0.02, feed) for f, p in ((face, uv), (other, back)))
        assert np.abs(two - (one if along == axis_number else one[:, ::-1])).max() < 1e-11


def test_many_axes_give_what_each_axis_gives():
    face, tool, uv = wavy(6), Tool.torus(12, 1), np.random.default_rng(2).uniform(0, 1, (25, 2))
    axes = np.concatenate([leaning(face, lean, way) for lean in (3, 20, 70, 100) for way in (0, 130, 250)])
    for feed in ("u", "v"):
        all_at_once = step_widths_many_axes(face, tool, uv, axes, 0.02, feed)
        one_by_one = np.stack([step_widths(face, tool, uv, axis, 0.02, feed) for axis in axes])
        assert np.abs(all_at_once - one_by_one).max() < 1e-10
        each = step_widths(face, tool, uv[:12], axes, 0.02, feed)
        assert np.abs(each - one_by_one[np.arange(12), np.arange(12)]).max() < 1e-10


@pytest.mark.parametrize("name", ["torus:12x1", "flat:12"])
def test_upright_on_a_plane_the_whole_bottom_cuts(name):
    tool = Tool.parse(name)
    a, r = tool.flat_radius, tool.corner_radius
    half = strip_width(plane(), tool, CENTRE, [0, 0, 1], 0.02)[0]
    assert np.abs(half - (a + np.sqrt(2 * r * 0.02 - 0.0004) if r else a)).max() < 1e-8
    assert second_order_width(plane(), tool, CENTRE, [0, 0, 1], 0.02)[0] == 0  # no curvature left: not positive
    assert np.isclose(second_order_width(sphere(80), tool, CENTRE, [0, 0, 1], 0.02)[0], 2 * np.sqrt(2 * 0.02 * 80))


@pytest.mark.parametrize("flutes, left", [(24.0, 23.0), (60.0, 24.0)])
def test_a_cutter_that_lies_on_the_surface_reaches_its_end_or_the_cap(flutes, left):
    """The side lies on the plane, T to the left, contact one corner radius from the bottom."""
    tool = Tool.torus(12, 1, flute_length=flutes)
    half = strip_width(plane(), tool, CENTRE, [0, 1, 0], 0.02)[0]
    assert abs(half[0] - left) < 1e-6 and abs(half[1] - np.sqrt(0.04 - 0.0004)) < 1e-8
    steps = step_widths(plane(), tool, CENTRE, [0, 1, 0], 0.02)[0]
    assert abs(steps[1] * 60 - left) < 1e-6


def test_a_gouging_contact_has_no_second_order_width():
    face = cylinder(5, True)
    axis = leaning(face, 10, 0, "v")
    assert second_order_width(face, Tool.ball(12), CENTRE, axis, 0.02, "v")[0] == 0
    assert (second_order_step_widths(face, Tool.ball(12), CENTRE, axis, 0.02, "v") == 0).all()


@pytest.mark.parametrize("name, lean, none", [
    ("torus:12x1", 95, True), ("ball:8", 120, True), ("tapered:8x1x10", 85, True), ("tapered:8x1x10", 75, False),
    ("torus:12x1", 85, False)])
def test_an_axis_below_the_side_cuts_nothing(name, lean, none):
    axis = leaning(plane(), lean)
    for answer in (strip_width(plane(), Tool.parse(name), CENTRE, axis, 0.02),
                   step_widths(plane(), Tool.parse(name), CENTRE, axis, 0.02),
                   second_order_step_widths(plane(), Tool.parse(name), CENTRE, axis, 0.02)):
        assert (answer == 0).all() == none


def test_allowance_moves_the_whole_scene():
    """On a plane stock changes nothing; on a sphere it is a ball on the larger sphere, seen from the smaller."""
    axis = leaning(plane(), 10, 45)
    assert np.abs(strip_width(plane(), Tool.torus(12, 1), CENTRE, axis, 0.02, "u", 0.5)
                  - strip_width(plane(), Tool.torus(12, 1), CENTRE, axis, 0.02)).max() < 1e-10
    one = strip_width(sphere(80), Tool.ball(12), CENTRE, [0, 0, 1], 0.02, "u", 2.0)
    two = strip_width(sphere(82), Tool.ball(12), CENTRE, [0, 0, 1], 0.02)
    assert np.abs(one * 82 / 80 - two).max() < 1e-9


def test_beyond_a_border_the_surface_goes_straight_on():
    """A contact near the edge of a cylinder's quarter: what lies beyond is the tangent plane."""
    face, tool = cylinder(40), Tool.ball(12)
    edge = strip_width(face, tool, [[1.0, 0.5]], [SHARE, 0, SHARE], 0.02, "v")[0]
    flat = np.sqrt(2 * 6 * 0.02 - 0.02**2)
    assert abs(edge[1] - flat) < 1e-9 and abs(edge[0] - 0.912679 / 2) < 1e-6
    outside = strip_width(face, tool, [[1.2, 0.5]], [SHARE, 0, SHARE], 0.02, "v")[0]
    assert np.abs(outside - flat).max() < 1e-9


@pytest.mark.parametrize("change, words", [
    ({"scallop": 0.0}, "scallop height is 0.0"), ({"scallop": 6.0}, "below the tool's radius"),
    ({"scallop": float("nan")}, "scallop"), ({"axis": [0, 0, 0]}, "direction"), ({"uv": [[0.5, np.nan]]}, "finite"),
    ({"uv": [[0.5, 0.5, 0.5]]}, "rows of 2"), ({"feed": "w"}, "'u', 'v' or a vector"),
    ({"allowance": np.inf}, "allowance")])
def test_nonsense_is_refused(change, words):
    given = {"uv": CENTRE, "axis": [0.1, 0, 1], "scallop": 0.02, "feed": "u", "allowance": 0.0} | change
    with pytest.raises(InvalidInput, match=words):
        strip_width(plane(), Tool.torus(12, 1), **given)


def test_no_contact_no_width():
    assert strip_width(plane(), Tool.ball(8), np.empty((0, 2)), [0, 0, 1], 0.02).shape == (0, 2)
    assert step_widths(plane(), Tool.ball(8), np.empty((0, 2)), [0, 0, 1], 0.02).shape == (0, 2)


@pytest.mark.parametrize("feed", ["u", "v"])
def test_a_contact_in_a_fold_stands_for_the_place_beside(feed):
    """The face runs back on itself by 0.0003 mm at x = 30; the derivatives alone put the cutter below it there."""
    line = np.concatenate([np.linspace(0.0, 30.0, 7), 30.0 - 5e-5 * np.arange(1, 6), np.linspace(35.0, 60.0, 6)])
    low = np.column_stack([line, 0.0 * line, 0.0 * line])
    face = Face.from_bspline(np.stack([low, low + np.array([0.0, 20.0, 0.0])], axis=1), (3, 1))
    uv = np.column_stack([np.linspace(0.42, 0.58, 9), np.full(9, 0.5)])
    beside = face.outside_folds(uv)
    assert (beside != uv).any(axis=1).all()
    tool, axis = Tool.torus(10, 1), [0.1, 0.1, 1.0]
    found, wanted = (strip_width(face, tool, rows, axis, 0.05, feed) for rows in (uv, beside))
    assert found == pytest.approx(wanted, rel=1e-9)
    assert found.min() > 0.2
    found, wanted = (step_widths(face, tool, rows, axis, 0.05, feed) for rows in (uv, beside))
    step = 1 if feed == "u" else 0
    upper = wanted[:, 1] + beside[:, step] > uv[:, step]
    assert uv[:, step] - found[:, 0] == pytest.approx(beside[:, step] - wanted[:, 0], abs=1e-12)
    assert (uv[:, step] + found[:, 1])[upper] == pytest.approx((beside[:, step] + wanted[:, 1])[upper], abs=1e-12)
    assert found[:, 0].min() > 0.02
