"""Four-axis paths around blades: layers, channels with the real surroundings, links, proof and judge."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from benchmarks._blades import loft, sections

from toolaxis.cad.load import load
from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.machine.library import load_machine
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import rotation
from toolaxis.search.face_problem import task
from toolaxis.shape.face import Face
from toolaxis.skin.join import join
from toolaxis.strategies.blade.clearance_limits import BladeSurroundings
from toolaxis.strategies.blade.layers import Ring, along_blade, find_closed_parameter
from toolaxis.strategies.blade.plan import BladeSearch, blade
from toolaxis.strategies.blade.schedule import Layer, SwivelAxis, plane_of, reschedule, swing_of
from toolaxis.strategies.blade.section import base_of, section
from toolaxis.strategies.common.path_check import prove_moving
from toolaxis.tools.tool import Tool
from toolaxis.verify.verdict import VerificationTask as Judged
from toolaxis.verify.verdict import judge

H = 0.05
TOOL = Tool.ball(8, stickout=90, holder=[(15, 0), (15, 60)])
UP = SwivelAxis(np.array([0.0, 0.0, 1.0]))


def platform(height=-8.0, size=40.0):
    return Face.from_bspline([[[x, y, height] for y in (-size, size)] for x in (-size, size)], (1, 1))


@pytest.fixture(scope="module")
def turbine():
    return loft("turbine", 6.0)


@pytest.fixture(scope="module", params=[("climb", 0.01), ("zigzag", 0.01), ("zigzag", 0.002)])
def made(request, turbine):
    direction, tolerance = request.param
    job = task(turbine, TOOL, H, surroundings=(platform(),), direction=direction, tolerance=tolerance)
    return job, *blade(job)


def layers(name, count=6, back=False):
    found = []
    for k, rows in enumerate(sections(name, count, 3.0, 240)):
        one = section(rows)
        one = one.begun_at(base_of(one))
        points = np.column_stack([one.points, np.full(len(one.points), float(k))])
        found.append(Layer(points[::-1] if back and k % 2 else points))
    return found


@pytest.mark.parametrize("curve", ["keys", "least"])
@pytest.mark.parametrize("back", [False, True])
def test_angles_run_on_from_layer_to_layer_without_turning_back(curve, back):
    found = reschedule(layers("steam", back=back), UP, curve=curve)
    for k, one in enumerate(found):
        assert (np.diff(one.theta) * (1 if one.onward else -1) >= -1e-9).all()
        assert one.onward == (not back or k % 2 == 0)
        slope, bend = one.curve.at(np.array([0.0, one.section.length]))[1:]
        np.testing.assert_allclose(np.concatenate([slope, bend]), 0, atol=1e-9)
    for one, other in pairwise(found):
        assert one.axes[-1] @ other.axes[0] == pytest.approx(1, abs=1e-12)


def test_layers_do_not_depend_on_what_comes_after_the_next():
    rows = layers("compressor", 6)
    whole, some = reschedule(rows, UP, curve="least"), reschedule(rows[:4], UP, curve="least")
    for k in range(3):
        np.testing.assert_allclose(whole[k].theta, some[k].theta, atol=1e-6)


def test_a_path_clockwise_turns_the_mirrored_way():
    rows = layers("turbine", 3)
    flipped = [Layer(one.centres * [1, -1, 1]) for one in rows]
    a, b = reschedule(rows, UP, curve="least"), reschedule(flipped, UP, curve="least")
    assert all(not one.onward for one in b)
    for one, other in zip(a, b, strict=True):  # the base lies elsewhere in the channel: bounds are alike, curves rise
        assert one.wide.width == pytest.approx(other.wide.width, abs=1e-9)
        assert (np.diff(other.theta) <= 1e-9).all()


def test_the_swing_is_that_of_the_machine():
    machine = load_machine("four-axis-a")
    turn = np.eye(4)
    turn[:3, :3] = rotation([0, 1, 0], np.pi / 2)  # the part's z lies along X
    found = swing_of(machine, [0, 0, -1], turn)
    np.testing.assert_allclose(found.direction, [0, 0, -1], atol=1e-12)
    assert found.lean == pytest.approx(0, abs=1e-12)
    tilted = replace(machine, spindle=(np.sin(0.1), 0.0, np.cos(0.1)))
    assert swing_of(tilted, [0, 0, 1], turn).lean == pytest.approx(0.1)
    assert swing_of(tilted, [0, 0, -1], turn).lean == pytest.approx(-0.1)
    axes = found.axes(np.linspace(0, 6, 9))
    np.testing.assert_allclose(axes @ found.direction, 0, atol=1e-12)
    np.testing.assert_allclose(found.angles(axes), np.linspace(0, 6, 9), atol=1e-12)


def test_layers_are_plane_sections_of_the_face(turbine):
    ring = Ring(turbine, "u", np.array([0.0, 0.0, 1.0]), 4.0)
    along = ring.places(1e-3)
    point, normal, centre = ring.at(along, np.full(len(along), 2.5))
    np.testing.assert_allclose(point[:, 2], 2.5, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(centre - point, axis=1), 4.0, atol=1e-12)
    assert (normal[:, :2] * (point[:, :2] - point[:, :2].mean(axis=0))).sum(axis=1).min() > -15
    assert np.linalg.norm(point[0] - point[-1]) < 1e-9


def test_a_path_around_a_blade_is_feasible_and_proven(made):
    job, found, path = made
    assert found.outcome == "feasible", found.reasons
    assert prove_moving(path, TOOL, job.groups).witness is None
    cut = path.kind == Motion.CUT
    angle = UP.angles(path.axis[cut])
    if job.direction == "climb":
        assert (np.diff(angle) >= -1e-9).all()
        assert angle[-1] - angle[0] == pytest.approx(2 * np.pi * found.passes, abs=0.5)
    else:
        senses = [np.sign(np.diff(angle[np.array([path.breaks[k], path.breaks[k + 1] - 1]) - path.breaks[0]])[0])
                  for k in range(1, found.passes - 1)]
        assert (np.diff(senses) != 0).all()
    np.testing.assert_allclose(path.axis[:, 2], 0, atol=1e-9)


def test_the_judge_passes_a_path_around_a_blade(made):
    job, _, path = made
    verdict = judge(Judged("op", path.cl, path.axis, path.kind, TOOL.profile, (job.worth.face,), H, 0.0), spacing=0.6,
                    threads=1)
    deepest = job.chord + 0.0005  # chords, and what the swing of the axis between points adds
    assert verdict.gouge_max < deepest and verdict.scallop_max <= H, (verdict.gouge_max, verdict.scallop_max)
    assert verdict.share_within > 0.999


def test_the_room_inside_a_channel_is_free_and_what_it_takes_off_is_not(turbine):
    tool = Tool.ball(8, stickout=30, holder=[(18, 0), (18, 60)])
    job = task(turbine, tool, H, surroundings=(platform(-30.0, 30.0),))
    search = BladeSearch(job, "least")
    room = BladeSurroundings(tool, job.feasibility.groups, search.swing)
    planes, some, left = search.planes()
    assert left == (0.0, 0.0)
    turn, wide = search.turns[some][-1], planes[-1].wide
    plain = plane_of(Layer(turn.centre), search.swing, None).wide
    points = turn.centre if planes[-1].onward else turn.centre[::-1]
    for k in np.arange(0, len(points), 31):
        inside = np.linspace(wide.low[k] + 0.02, wide.high[k] - 0.02, 6)
        assert room.free(np.tile(points[k], (6, 1)), inside).all()
    assert (plain.high - wide.high).max() > 0.05
    low, high = room.limits(points[::5], plain.low[::5], plain.high[::5])
    assert room.free(points[::5], high - 0.01).all() and room.free(points[::5], low + 0.01).all()
    cut = np.flatnonzero(plain.high[::5] - high > 0.05)
    assert len(cut) and not room.free(points[::5][cut], high[cut] + 0.05).any()


def test_layers_without_room_at_the_root_are_left(turbine):
    search = BladeSearch(task(turbine, TOOL, H, surroundings=(platform(-6.5, 30.0),)), "least")
    planes, some, left = search.planes()
    assert left[0] == 0 and 0 < left[1] < 0.5 and some.stop == len(planes) < len(search.turns)


def test_a_platform_too_near_is_told_with_place_and_amount(turbine):
    found, path = blade(task(turbine, TOOL, H, surroundings=(platform(-7.0, 120.0),)))
    assert path is None and found.outcome == "not_found"
    assert "closes on layer" in found.reasons[0] and "deg are missing" in found.reasons[0]


def test_a_machine_on_which_the_tool_leans_has_room_where_the_platform_is_near(turbine):
    turn = np.eye(4)
    turn[:3, :3] = rotation([0, 1, 0], np.pi / 2)
    machine = load_machine("four-axis-a")
    tilted = replace(machine, spindle=(np.sin(0.25), 0.0, np.cos(0.25)))
    found, path = blade(task(turbine, TOOL, H, Mounting(tilted, turn), surroundings=(platform(-7.0, 120.0),)))
    assert found.outcome == "feasible", found.reasons
    np.testing.assert_allclose(path.axis[path.kind == Motion.CUT][:, 2], np.sin(0.25), atol=1e-9)


@pytest.mark.parametrize("tool, face, words", [
    (Tool.torus(8, 1), None, "has no ball end"),
    (TOOL, platform(), "does not close around a blade")])
def test_what_the_strategy_cannot_take_is_named(turbine, tool, face, words):
    with pytest.raises(InvalidInput, match=words):
        blade(task(face or turbine, tool, H))


def test_curves_and_clearances_that_do_not_exist_are_named():
    rows = layers("turbine", 2)
    with pytest.raises(InvalidInput, match="use keys or least"):
        reschedule(rows, UP, curve="best")
    with pytest.raises(InvalidInput, match="between 0 and pi/2"):
        reschedule(rows, UP, clearance=-1.0)
    with pytest.raises(InvalidInput, match="no layer"):
        reschedule([], UP)
    with pytest.raises(InvalidInput, match="section of layer 1 is open"):
        reschedule([Layer(rows[0].centres[:150])], UP)


def test_a_closed_face_tells_its_parameter(turbine):
    assert find_closed_parameter(turbine) == "u"
    turned = Face.from_bspline(turbine.surface.control[..., :3].transpose(1, 0, 2), (3, 3),
                               (turbine.surface.knots_v, turbine.surface.knots_u), flip=True)
    assert find_closed_parameter(turned) == "v"


def test_a_blade_of_a_blisk_closes_where_its_faces_are_joined():
    part = load(Path(__file__).parents[2] / "examples" / "blisk.step")
    with pytest.raises(UnsupportedGeometry, match="normals turn by up to 90 degrees from the best view"):
        join(part, (1, 163, 3, 161))
    with pytest.raises(InvalidInput, match="does not close around a blade"):
        find_closed_parameter(part.face(1))
    face = join(part, (1, 163, 3, 161), corner=np.pi).face(1)
    assert find_closed_parameter(face) == "u"
    ring = Ring(face, "u", along_blade(face, "u"), 3.0)
    low, high = ring.span
    assert high - low > 40
    along = ring.places(1e-3)
    found = reschedule([Layer(ring.at(along, np.full(len(along), z))[2]) for z in np.linspace(low, high, 5)],
                       SwivelAxis(ring.direction), curve="least")
    assert min(one.wide.width for one in found) > np.radians(90)
    assert max(one.peak / one.bound for one in found) < 3
