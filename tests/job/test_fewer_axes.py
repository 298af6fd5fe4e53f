"""Plans with a rack: axes that serve several surfaces, and tools that turn out quicker than those that were chosen."""

from dataclasses import replace

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.job.planning import other_tools, rack, share_axes
from toolaxis.job.planning.other_tools import ReckonedTimes, may_take_less_time, seconds_of, takes_less_time
from toolaxis.job.planning.share_axes import share_axes as share
from toolaxis.job.planning.sub_surfaces import Target
from toolaxis.numeric.vectors import unit
from toolaxis.plan.plan import INDEX_SECONDS, Plan
from toolaxis.progress import NO_PROGRESS
from toolaxis.regions.tool_choice import AxisTime, ToolChain, ToolChoice, choose_tools
from toolaxis.shape.part import Part

LEAN = np.radians(18)


def scales() -> Part:
    """Four bowed patches, 6 x 6 mm, side by side, each leaning another way."""
    x, y = np.meshgrid(np.linspace(-3, 3, 4), np.linspace(-3, 3, 4), indexing="ij")
    faces = []
    for k in range(4):
        turn = k * np.pi / 2 + 0.3
        z = -0.01 * (x**2 + y**2) + np.tan(LEAN) * (np.cos(turn) * x + np.sin(turn) * y)
        faces.append(ta.Face.from_bspline(np.stack([x + 12 * k, y, z], axis=-1)))
    return Part.from_faces(faces)


def planned_scales() -> Plan:
    return ta.plan(scales(), ["torus:6x1", "ball:2"], 0.02, limits="cone:0,0,1,60", workers=1)


def test_small_faces_share_an_axis(monkeypatch: pytest.MonkeyPatch) -> None:
    shared = planned_scales()
    monkeypatch.setattr(rack, "choose_axes", lambda options, used, move: tuple(some[0].axis for some in options))
    apart = planned_scales()
    assert shared.outcome == apart.outcome == "complete"
    assert shared.orientations == 1 < apart.orientations
    assert shared.seconds < apart.seconds - 6.0
    assert ta.verify(shared).passed


def test_axes_are_chosen_alike_by_any_number_of_processes() -> None:
    one, two = (ta.plan(scales(), ["torus:6x1", "ball:2"], 0.02, limits="cone:0,0,1,60", workers=n) for n in (1, 2))
    assert np.array_equal(one.axes, two.axes) and one.length == two.length


def test_a_sub_surface_keeps_its_own_axis_behind_a_shared_one() -> None:
    faces, own = scales().faces, unit(np.array([[0.1, 0, 1], [-0.1, 0, 1], [0, 0.1, 1], [0, 0.5, 1]]))
    targets = [Target(face, axis) for face, axis in zip(faces, own, strict=True)]

    def _reckon(face, axes, number, progress):  # type: ignore[no-untyped-def]
        """The first three are served by each other's axes, the last by its own alone."""
        near = [k for k in range(len(axes)) if abs(axes[k, 1]) < 0.2]
        return tuple(AxisTime(k, 1.0) for k in (near if face is not faces[3] else [number]))

    found, stopped = share(targets, [], _reckon, 1, NO_PROGRESS)
    assert not stopped
    assert len({tuple(target.axis) for target in found[:3]}) == 1 and found[3] is targets[3]
    for target, before in zip(found, targets, strict=True):
        assert target is before or np.array_equal(target.others[0], before.axis)
    used = share(targets, [own[1]], _reckon, 1, NO_PROGRESS)[0]
    assert all(np.array_equal(target.axis, own[1]) for target in used[:3])


def test_a_sub_surface_on_which_the_program_fails_keeps_its_axis() -> None:
    face = scales().faces[0]
    targets = [Target(face, axis) for axis in unit(np.array([[0.1, 0, 1], [-0.1, 0, 1]]))]

    def _fail(face, axes, number, progress):  # type: ignore[no-untyped-def]
        raise ZeroDivisionError

    assert share(targets, [], _fail, 1, NO_PROGRESS) == (targets, False)
    assert share_axes.share_axes([], [], _fail, 1, NO_PROGRESS) == ([], False)


def bowl() -> Part:
    """A shallow bowl, 24 x 24 mm, that both tools of the rack machine whole."""
    x, y = np.meshgrid(np.linspace(-12, 12, 5), np.linspace(-12, 12, 5), indexing="ij")
    return Part.from_faces([ta.Face.from_bspline(np.stack([x, y, 0.006 * (x**2 + y**2)], axis=-1))])


def planned_bowl() -> Plan:
    """With a large ball that is slow, and a small one that is quick."""
    tools = [ta.Tool.ball(8, feedrate=150.0, spindle=6000.0), ta.Tool.ball(4, feedrate=2000.0, spindle=12000.0)]
    return ta.plan(bowl(), tools, 0.05, limits="cone:0,0,1,40", workers=1)


@pytest.fixture
def large_first(monkeypatch: pytest.MonkeyPatch) -> None:
    """A choice of tools that begins with the large one where it can, whatever that costs."""

    def _choose(chains, change, most=None):  # type: ignore[no-untyped-def]
        wrong = [sorted(some, key=lambda chain: chain.tools)[:1] for some in chains]
        return choose_tools(wrong, change, most)

    monkeypatch.setattr(rack, "choose_tools", _choose)


def test_tools_that_turn_out_quicker_take_over(large_first: None) -> None:
    plan = planned_bowl()
    assert plan.outcome == "complete" and [op.tool.name for op in plan.operations] == ["ball:4"]
    assert [op.number for op in plan.operations] == [1] and ta.verify(plan).passed


@pytest.mark.parametrize("limit", [{"_SECONDS": 1e6}, {"_OF_ALL": 1.0}], ids=["on a face", "in all"])
def test_nothing_is_planned_twice_where_little_is_to_be_gained(large_first: None, monkeypatch: pytest.MonkeyPatch,
                                                               limit: dict[str, float]) -> None:
    for name, value in limit.items():
        monkeypatch.setattr(other_tools, name, value)
    plan = planned_bowl()
    assert [op.tool.name for op in plan.operations] == ["ball:8"]
    assert not ReckonedTimes().find_slow_faces(plan.operations, plan.inputs, {0, 1})


def test_what_took_longer_than_was_said_is_expected_of_other_tools_too(large_first: None,
                                                                      monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(other_tools, "_SECONDS", 1e6)
    (slow,), inputs = (plan := planned_bowl()).operations, plan.inputs
    monkeypatch.undo()
    spent = slow.seconds(inputs.feedrate, inputs.rapid)

    def found(said: float, said_of_other: float) -> dict[int, list[int]]:
        """The faces that are slow where the cuts of both tools were said to take such shares of what was spent."""
        chains = [ToolChain((tool,), share * spent / 1.4 + INDEX_SECONDS, 0.0)
                  for tool, share in enumerate((said, said_of_other))]
        times = ReckonedTimes()
        times.add([slow.face], chains[0], chains)
        return times.find_slow_faces([slow], inputs, {0, 1})

    assert found(1.0, 0.5) == found(0.5, 0.3) == {1: [slow.face.number]}
    assert found(1.0, 0.9) == found(0.5, 0.45) == {}, "a tenth less, not more than half"
    assert found(2.0, 0.9) == {}, "what took less than was said makes others no quicker"


def test_what_takes_as_long_or_machines_less_is_not_taken(large_first: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(other_tools, "_SECONDS", 1e6)
    (slow,), inputs = (plan := planned_bowl()).operations, plan.inputs
    monkeypatch.undo()
    (quick,) = planned_bowl().operations
    less = replace(quick, orientation=replace(quick.orientation, unreached=0.05))
    none = frozenset[ta.Tool]()
    assert takes_less_time([quick], [slow], none, inputs) and not takes_less_time([slow], [quick], none, inputs)
    assert not takes_less_time([less], [slow], none, inputs) and not takes_less_time([quick], [quick], none, inputs)
    assert seconds_of([quick], none, inputs) == pytest.approx(seconds_of([quick], frozenset([quick.tool]), inputs) + 10)
    # With half of it done in a time t, the other half is reckoned to take half as long as the slow one.
    half = replace(quick, orientation=replace(quick.orientation, unreached=0.5))
    t, whole = (seconds_of([op], none, inputs) for op in (half, slow))
    assert may_take_less_time([], [slow], [], inputs) and not may_take_less_time([slow], [slow], [], inputs)
    assert may_take_less_time([half], [slow], [], inputs) == (t + 0.5 * whole < 0.9 * whole)
    assert not may_take_less_time([replace(half, tool=slow.tool), half, half], [slow], [slow.tool], inputs)


def test_what_was_given_up_with_other_tools_is_never_taken(large_first: None, monkeypatch: pytest.MonkeyPatch) -> None:
    """Found: what waited for smaller tools when planning with others ended was in no operation, and not open either."""
    x, y = np.meshgrid(np.linspace(-12, 12, 41), np.linspace(-12, 12, 5), indexing="ij")
    grooved = np.stack([x, y, 0.006 * (x**2 + y**2) - 0.8 * np.exp(-((x / 1.2) ** 2))], axis=-1)
    part = Part.from_faces([ta.Face.from_bspline(grooved)])
    tools = [ta.Tool.ball(8, feedrate=150.0), ta.Tool.ball(4, feedrate=2000.0), ta.Tool.ball(1, feedrate=2000.0)]
    monkeypatch.setattr(rack, "may_take_less_time", lambda *_: False)
    monkeypatch.setattr(rack, "takes_less_time", lambda *_: True)
    plan = ta.plan(part, tools, 0.05, limits="cone:0,0,1,40", workers=1)
    assert sum(op.face.area for op in plan.operations) == pytest.approx(part.faces[0].area, rel=1e-3)
    assert plan.account.area == pytest.approx(part.faces[0].area, rel=1e-3)
    assert plan.operations[0].tool.name == "ball:8" and ta.verify(plan).operations


def test_a_choice_keeps_what_it_reckoned_for_each_face() -> None:
    face, small = bowl().face(1), ToolChain((1,), 20.0, 0.0)
    first = ReckonedTimes()
    first.add([face], ToolChain((0,), 10.0, 0.0), [ToolChain((0,), 10.0, 0.0), small])
    assert first.reckoned[1][0].first == 0 and first.reckoned[1][0].chains[1] is small
    first.add([face], ToolChain((), 0.0, 0.0), [])
    assert len(first.reckoned[1]) == 1, "what no tool reaches is not planned once more"
    assert isinstance(choose_tools([[small]], 1.0), ToolChoice)
