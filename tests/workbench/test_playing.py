"""Operations laid out to be played: where tool and machine stand at each place, and what meets there."""

from dataclasses import replace

import numpy as np
import Part
import pytest
from FreeCAD import Vector
from freecad.toolaxis.document import machine_limits
from freecad.toolaxis.services import collisions
from freecad.toolaxis.services.playing import PlayedOperation, lay_out, look_out
from freecad.toolaxis.services.tour import ToolTour

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.machine.kinematics import forward
from toolaxis.plan.plan import CHANGE_SECONDS, INDEX_SECONDS, PlanInputs
from toolaxis.progress import NO_PROGRESS

TOOL = ta.Tool.torus(diameter=6, corner_radius=1, stickout=30, holder=[(10, 0), (10, 40)])
LONG = ta.Tool.ball(diameter=8, stickout=55, holder=[(10, 0), (10, 30), (20, 30), (20, 50)])
UP, ASIDE = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.6, 0.8])


def played(tips, axis=UP, tool=TOOL, **words):
    rows = np.array(tips, dtype=float)
    axes = np.tile(axis, (len(rows), 1)) if np.ndim(axis) == 1 else np.array(axis)
    kinds = np.array([Motion.LINK, *[Motion.CUT] * (len(rows) - 1)], dtype=np.int8)
    path = ToolPath(rows, rows, axes, axes, kinds, np.array([0, len(rows)]))
    return PlayedOperation("One", path, tool, PlanInputs(0.02, feedrate=600, rapid=6000), axes[0], **words)


@pytest.fixture
def mounted():
    return machine_limits.mounting("machine:bc-table-table@0,0,20", TOOL)


@pytest.fixture
def clamped(document):
    """A block whose top is at z = 10, and a post at its right side, 60 mm high, from x = 12 on."""
    for name, size, corner in (("Block", (40, 40, 10), (-20, -20, 0)), ("Post", (10, 10, 60), (12, -5, 0))):
        document.addObject("Part::Feature", name).Shape = Part.makeBox(*size, Vector(*corner))
    return [collisions.ShapeCopy(thing.Name, f"the {thing.Name}", thing.Shape) for thing in document.Objects]


TWO = [played([(-15, 0, 10), (-5, 0, 10)]), played([(0, -10, 12), (0, 10, 12)], ASIDE)]


def test_the_tool_alone_goes_up_over_and_down():
    laid = lay_out(TWO)
    assert laid.mounted is None and laid.playback.between == (INDEX_SECONDS,)
    moment, row, (tip, axis) = laid.stand(laid.playback.place_of(0, 1, 0.25))
    assert row == 0 and moment.motion == 1 and np.allclose(tip, [-12.5, 0, 10]) and np.array_equal(axis, UP)
    stood = [laid.stand(laid.playback.place_between(0, share)) for share in np.linspace(0.001, 0.999, 101)]
    tips, axes = (np.array([where[k] for _, _, where in stood]) for k in (0, 1))
    assert np.allclose(np.linalg.norm(axes, axis=1), 1) and (np.diff(axes[:, 2]) <= 1e-12).all()
    turning = np.abs(np.diff(axes, axis=0)).max(axis=1) > 1e-9
    assert turning.sum() > 40 and tips[:-1][turning, 2].min() > 30, "it turns up there alone"
    assert np.linalg.norm(np.diff(tips, axis=0), axis=1).max() < 3, "it does not jump"
    assert np.allclose(tips[0], [-5, 0, 10], atol=1) and np.allclose(tips[-1], [0, -10, 12], atol=1)
    assert [row for _, row, _ in stood] == sorted(row for _, row, _ in stood)


def test_a_turn_to_the_opposite_direction_goes_round():
    path = TWO[0].path
    tour = ToolTour.through([path, replace(path, axis=-path.axis, normal=-path.normal)])
    axes = np.array([tour.between(0, share)[1] for share in np.linspace(0, 1, 41)])
    assert np.allclose(np.linalg.norm(axes, axis=1), 1) and np.allclose(axes[[0, -1]], [UP, -UP])


def test_the_machine_holds_tip_and_axis_at_every_place(mounted):
    laid = lay_out(TWO, mounted)
    for row, one in enumerate(TWO):
        for share in (0.0, 0.3, 1.0):
            moment, other, joints = laid.stand(laid.playback.place_of(row, 1, share * 0.999))
            assert other == row and not moment.between
            held = laid.holding(row)
            tip, axis = forward(held.machine, joints[None], held.tool_length, held.table_from_part)
            wanted = one.path.cl[0] + 0.999 * share * (one.path.cl[1] - one.path.cl[0])
            assert np.abs(tip[0] - wanted).max() < 1e-6 and np.abs(axis[0] - one.path.axis[0]).max() < 1e-4
    _, row, joints = laid.stand(laid.playback.place_between(0, 0.5))
    assert row == 1 and joints[2] == laid.tour.top


def test_a_moving_axis_is_followed_by_the_machine(mounted):
    lean = np.radians(np.linspace(0, 20, 11))
    axes = np.stack([np.zeros(11), np.sin(lean), np.cos(lean)], axis=1)
    one = played(np.stack([np.linspace(-10, 0, 11), np.zeros(11), np.full(11, 12.0)], axis=1), axes, moves=True)
    laid = lay_out([one], mounted)
    assert laid.mounted is not None and len(laid.tour.legs[0]) == 11, laid.why
    held = laid.holding(0)
    tips, found = forward(held.machine, laid.tour.legs[0], held.tool_length, held.table_from_part)
    assert np.abs(tips - one.path.cl).max() < 1e-6 and np.abs(found - axes).max() < 1e-4


def test_the_solution_that_was_planned_is_played(mounted):
    first = lay_out([TWO[1]], mounted).tour.legs[0][0, 3:]
    other = next(row for row in mounted.solutions(ASIDE) if np.abs(row - first).max() > 0.1)
    assert np.allclose(lay_out([replace(TWO[1], rotary=tuple(other))], mounted).tour.legs[0][0, 3:], other)


def test_times_are_those_of_rates_machine_and_change_of_tool(mounted):
    """10 mm and 20 mm at 600 mm/min; another tool; and what the machine takes to index, more than no time at all."""
    other = replace(TWO[1], tool=LONG)
    alone = lay_out([TWO[0], other]).playback
    assert alone.cutting == pytest.approx(3) and alone.seconds == pytest.approx(3 + INDEX_SECONDS + CHANGE_SECONDS)
    same = lay_out([TWO[0], TWO[0]]).playback
    assert same.seconds == pytest.approx(2) and same.length == pytest.approx(2 + 2 / 30)
    assert mounted.machine.unstated or lay_out(TWO, mounted).playback.between[0] != INDEX_SECONDS
    stated = machine_limits.mounting("machine:mikron-ucp-710@0,0,60", TOOL)
    known = lay_out(TWO, stated)
    assert known.mounted is not None and 0.5 < known.playback.between[0] < 20, known.why
    assert known.playback.between[0] != INDEX_SECONDS


def test_an_axis_that_the_machine_cannot_hold_leaves_the_tool_alone():
    fixed = machine_limits.mounting("machine:four-axis-a@0,0,0", TOOL)
    laid = lay_out([played([(0, 0, 0), (1, 0, 0)], np.array([0.6, 0.0, 0.8]))], fixed)
    assert laid.mounted is None and "has no position for the axis of 'One'" in laid.why
    assert laid.stand(0.5)[2][1][0] == 0.6


def test_what_meets_on_passes_and_on_index_moves(mounted, clamped):
    """The holder meets the post from x = 2 on; with little room above, the tool goes through the post between two."""
    rows = [played([(x, 0, 12) for x in range(-15, 4)]), played([(40, 0, 12), (45, 0, 12)])]
    laid = lay_out(rows)
    found = look_out(laid, clamped, NO_PROGRESS)
    (one,), () = found.on_passes
    assert (one.member, one.thing) == ("holder", "Post") and one.last == 18 and found.unchecked == ("index moves",)
    assert found.at(laid.playback.at(laid.playback.place_of(0, one.first))) is one
    assert found.at(laid.playback.at(laid.playback.place_of(0, one.first - 1))) is None
    assert [row for _, row, _ in found.places(laid.playback)] == [0]
    axes = tuple(replace(axis, high=130.0) if axis.name == "Z" else axis for axis in mounted.machine.linear)
    low = replace(mounted, machine=replace(mounted.machine, linear=axes))
    laid = lay_out([played([(-15, 0, 12), (-5, 0, 12)]), rows[1]], low)
    found = look_out(laid, clamped, NO_PROGRESS)
    assert found.unchecked == () and found.on_passes == ((), ())
    places = found.places(laid.playback)
    assert places and all(laid.playback.at(place).between and one.thing == "Post" for place, _, one in places)
    assert found.at(laid.playback.at(places[0][0])) is not None


def test_a_body_of_the_machine_meets_a_beam_on_some_motions(mounted, document):
    """A beam above the end of the way; the tool goes under it, and the spindle, 70 mm above the tip, cannot."""
    document.addObject("Part::Feature", "Beam").Shape = Part.makeBox(10, 200, 100, Vector(120, -100, 90))
    copies = [collisions.ShapeCopy(thing.Name, "the beam", thing.Shape) for thing in document.Objects]
    laid = lay_out([played([(x, 0, 12) for x in np.linspace(-20, 80, 401)])], mounted)
    found = look_out(laid, copies, NO_PROGRESS)
    (one,), = found.on_passes
    assert (one.member, one.thing) == ("spindle", "Beam"), one
    assert 50 < one.first < one.last == 400, "it is free at first, and meets the beam up to the end"
    known = collisions.around(mounted, [TOOL], copies, NO_PROGRESS)
    meets = [known.machine_at(0, joints) is not None for joints in laid.tour.legs[0]]
    assert not any(meets[:one.first - 1]) and all(meets[one.first + 400 // 12 + 1:])


def test_what_is_not_known_is_told_as_not_checked(mounted, clamped):
    bare = ta.Tool.torus(diameter=6, corner_radius=1)
    names = look_out(lay_out([replace(TWO[0], tool=bare)]), clamped, NO_PROGRESS).unchecked
    assert "holder" in names and "index moves" not in names
    laid = lay_out([replace(one, tool=bare) for one in TWO], replace(mounted, tool_length=None))
    assert {"holder", "machine", "index moves"} <= set(look_out(laid, clamped, NO_PROGRESS).unchecked)
    hollow = replace(mounted, machine=replace(mounted.machine, bodies=()))
    assert look_out(lay_out(TWO, hollow), clamped, NO_PROGRESS).unchecked == ("machine",)


def test_gouges_of_the_verdict_are_among_what_meets(clamped):
    laid = lay_out([replace(TWO[0], gouges=((1, 0.25), (77, 1.0)))])
    (one,), = look_out(laid, clamped, NO_PROGRESS).on_passes
    assert (one.first, one.last, one.text) == (1, 1, "the cutter gouges the face by 0.2500 mm")
