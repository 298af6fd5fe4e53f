"""Machines of documents: which there are, both solutions of an axis, and the way of the machine between operations."""

import json
from dataclasses import replace

import FreeCAD
import numpy as np
import pytest
from FreeCAD import Vector
from freecad.toolaxis.document import machine_angles, machine_limits
from freecad.toolaxis.document.machine import machine_of, place_machine
from freecad.toolaxis.document.preferences import PLACE
from freecad.toolaxis.services import collisions
from freecad.toolaxis.services.tour import MachineTour, corners, meeting, places

import toolaxis as ta
from toolaxis.errors import Cancelled, InvalidInput
from toolaxis.machine.body_poses import beside_part
from toolaxis.machine.kinematics import forward
from toolaxis.machine.library import library, load_machine
from toolaxis.progress import NO_PROGRESS, Progress

TOOL = ta.Tool.torus(diameter=6, corner_radius=1, stickout=30, holder=[(10, 0), (10, 40)])
TEXT = "machine:bc-table-table@0,0,20"
AXES = np.array([[0.3, 0.1, 0.9], [-0.2, 0.5, 0.7]])
TIPS = np.array([[5.0, 4.0, 10.0], [15.0, 12.0, 9.0], [8.0, 2.0, 11.0]])


@pytest.fixture(scope="module")
def mounted():
    return machine_limits.mounting(TEXT, TOOL)


def test_the_library_and_the_users_folder_are_offered(tmp_path):
    assert set(library()) <= set(machine_limits.available())
    with_bodies = [bool(load_machine(name).bodies) for name in machine_limits.available().values()]
    assert with_bodies == sorted(with_bodies, reverse=True) and with_bodies[0], "those that can be seen come first"
    (tmp_path / "mine.toml").write_text(library()["ab-trunnion"].read_text())
    preferences = FreeCAD.ParamGet(PLACE)
    preferences.SetString("MachinesFolder", str(tmp_path))
    try:
        assert machine_limits.available()["mine"] == str(tmp_path / "mine.toml")
        mine = machine_limits.text_of(machine_limits.available()["mine"])
        assert machine_limits.mounting(mine, TOOL).machine.name.startswith("A, B")
    finally:
        preferences.RemString("MachinesFolder")
    assert "mine" not in machine_limits.available()


def test_a_text_comes_back(mounted):
    assert machine_limits.text_of("bc-table-table", (0, 0, 20)) == TEXT
    name, offset = machine_limits.read_text(TEXT)
    assert name == "bc-table-table" and list(offset) == [0, 0, 20]
    assert machine_limits.read_text("machine:x") == ("x", None)
    assert machine_limits.limits_from("cone:0,0,1,60", TOOL) == "cone:0,0,1,60"
    assert machine_limits.limits_from("", TOOL) is None
    assert machine_limits.limits_from(TEXT, TOOL).machine.name == mounted.machine.name
    for bad, words in (("machine:", "name no machine"), ("machine:nothing", "neither a file nor"),
                       ("machine:bc-table-table@1,2", "three numbers")):
        with pytest.raises(InvalidInput, match=words):
            machine_limits.mounting(bad, TOOL)


@pytest.mark.parametrize("axis", AXES)
def test_both_solutions_hold_the_axis(mounted, axis):
    ways = machine_angles.ways_to_hold(mounted, axis, TIPS)
    assert len(ways) == 2 and np.abs(ways[0].rotary - ways[1].rotary).max() > 0.1
    for way in ways:
        assert not way.reason and "B" in way.text(mounted.machine)
        assert np.degrees(np.arccos(mounted.axis_at(way.rotary) @ axis / np.linalg.norm(axis))) < 1e-3


def test_what_speaks_against_a_solution_is_said(mounted):
    tilted = machine_limits.mounting("machine:ab-trunnion@0,0,20", TOOL)
    assert "beyond its range" in machine_angles.ways_to_hold(tilted, [0.9, 0.0, 0.4], TIPS)[0].reason
    far = machine_limits.mounting("machine:bc-table-table@900,0,20", TOOL)
    assert "leaves its travel by" in machine_angles.ways_to_hold(far, AXES[0], TIPS)[0].reason
    inside, outside = 20.0, 900.0
    for _ in range(40):
        middle = (inside + outside) / 2
        one = machine_limits.mounting(f"machine:bc-table-table@{middle!r},0,20", TOOL)
        said = machine_angles.ways_to_hold(one, AXES[0], TIPS)[0].reason
        inside, outside = (inside, middle) if said else (middle, outside)
    near = machine_limits.mounting(f"machine:bc-table-table@{outside!r},0,20", TOOL)
    assert machine_angles.ways_to_hold(near, AXES[0], TIPS)[0].reason.endswith("leaves its travel by 0.1 mm")
    deep = machine_limits.mounting("machine:bc-table-table@0,0,-60", TOOL)
    way = machine_angles.ways_to_hold(deep, AXES[0], TIPS)[0]
    assert "the spindle collides with the table by" in way.reason and way.meeting == ("spindle", "table")
    assert machine_angles.ways_to_hold(machine_limits.mounting("machine:four-axis-a", TOOL), AXES[0], TIPS) == []
    rows = machine_angles.in_order(mounted, [(axis, TIPS) for axis in AXES])
    assert all(taken >= 0 for _, taken in rows)
    first, second = (ways[taken].rotary for ways, taken in rows)
    others = [np.abs(way.rotary - first).max() for way in rows[1][0]]
    assert np.abs(second - first).max() == pytest.approx(min(others))


@pytest.fixture(scope="module")
def journey(mounted):
    rotary = [machine_angles.ways_to_hold(mounted, axis, TIPS)[0].rotary for axis in AXES]
    return MachineTour.through(mounted, list(zip(TIPS[:2], rotary, strict=True)))


def test_the_stations_are_the_tips_with_their_axes(mounted, journey):
    tips, axes = forward(mounted.machine, journey.joints, mounted.tool_length, mounted.table_from_part)
    assert np.abs(tips - TIPS[:2]).max() < 1e-9
    assert np.abs(axes - AXES / np.linalg.norm(AXES, axis=1)[:, None]).max() < 1e-4


def test_rotary_axes_turn_only_up_there(journey):
    rows = np.array([journey.at(way) for way in np.linspace(0, 1, 201)])
    assert np.array_equal(rows[0], journey.joints[0]) and np.array_equal(rows[-1], journey.joints[1])
    step = np.diff(rows, axis=0)
    other = np.abs(step[:, [0, 1, 3, 4]]).max(axis=1) > 1e-12
    assert (rows[:-1][other, 2] == journey.top).all() and (rows[1:][other, 2] == journey.top).all()
    assert np.abs(step).max(axis=0) == pytest.approx(np.abs(step).max(axis=0)) and (rows[:, 2] <= journey.top).all()
    assert other.sum() > 50


def test_bodies_stand_where_the_machine_carries_them(mounted, journey):
    """What Z carries moves with the tool; what the axis next to the part carries stands still."""
    for way in (0.0, 0.3, 0.5, 1.0):
        joints = journey.at(way)
        found = places(mounted, joints)
        tip, axis = forward(mounted.machine, joints[None], mounted.tool_length, mounted.table_from_part)
        gauge = found["Z"] @ [*mounted.machine.gauge, 1.0]
        assert np.abs(gauge[:3] - (tip[0] + mounted.tool_length * axis[0])).max() < 1e-9
        assert np.abs(found["C"] - places(mounted, journey.joints[0])["C"]).max() < 1e-9
        assert np.abs(found["bed"][:3, :3] @ [0, 0, 1] - axis[0]).max() < 1e-9
    assert meeting(mounted, journey.joints[0]) == (set(), 0.0)


@pytest.mark.parametrize("name", ["bc-table-table", "nutating-head", "mikron-ucp-710", "dmg-dmu-60t"])
def test_corners_are_those_of_the_body(name):
    ways = np.random.default_rng(1).normal(size=(200, 3))
    for body in ta.load_machine(name).bodies:
        points = corners(body)
        theirs = (body.convex.support(ways) * ways).sum(axis=1)
        ours = (points @ ways.T).max(axis=0)
        assert (ours <= theirs + 1e-9).all() and (ours >= theirs - 0.01 * np.ptp(points)).all()
        assert beside_part(ta.load_machine(name), body) in (True, False)


def test_a_machine_in_a_document_is_one_step(document, parts):
    document.UndoMode = 1
    thing = parts.block(document)
    operation = parts.planned(document, (thing, parts.sculptured_name(thing)))[0]
    before, steps = len(document.Objects), document.UndoCount
    made = place_machine(document, "ab-trunnion", (1, 2, 3), [(operation, ["A 1\u00b0  B 2\u00b0"])])
    assert machine_of(document) == made and made.Offset == Vector(1, 2, 3) and document.UndoCount == steps + 1
    assert operation.RotaryAngles == ["A 1\u00b0  B 2\u00b0"] and made.Axes[3] == "B: -30\u00b0 \u2026 30\u00b0"
    again = place_machine(document, "bc-table-table", (0, 0, 0), [])
    assert again == made and made.Machine == "bc-table-table" and len(document.Objects) == before + 1
    with pytest.raises(InvalidInput, match="neither a file nor"):
        place_machine(document, "nothing", (0, 0, 0), [])
    document.undo()
    document.undo()
    assert machine_of(document) is None and not operation.Stale


LIMITS = "machine:ab-trunnion@0,0,20"


def test_a_plan_for_a_machine_shows_its_angles_and_is_written_for_it(document, parts, tmp_path):
    from dataclasses import replace

    from freecad.toolaxis.document.inputs import inputs_of
    from freecad.toolaxis.services.export import Wish, export
    from freecad.toolaxis.services.write_results import apply

    thing = parts.block(document)
    inputs = parts.inputs_for((thing, parts.sculptured_name(thing)), limits=TEXT)
    mounted = machine_limits.mounting(TEXT, inputs.assembled())
    second = machine_angles.ways_to_hold(mounted, parts.LEANING, TIPS)[1]
    assert not second.reason, second.reason
    plan = parts.quick_plan(inputs, Vector(*mounted.axis_at(second.rotary)))
    plan = replace(plan, machine=mounted, operations=(replace(plan.operations[0], rotary=tuple(second.rotary)),))
    made = apply(document, inputs, plan)[0]
    assert made.Limits == TEXT and not made.Stale and inputs_of(made).limits == TEXT
    assert len(made.RotaryAngles) == 2 and made.RotaryAngles[0] == second.text(mounted.machine)
    names = export(made, tmp_path / "plan", Wish("linuxcnc", "bc-table-table", (0, 0, 20)))
    written = json.loads((tmp_path / "plan" / "plan.json").read_text())
    assert written["machine"]["name"].startswith("BC") and written["inputs"]["limits"] == ""
    angles = " ".join(f"{axis.name}{np.degrees(angle):.5f}" for axis, angle in zip(mounted.machine.rotary,
                                                                                  second.rotary, strict=True))
    assert "program-linuxcnc.ngc" in names and angles in (tmp_path / "plan" / "program-linuxcnc.ngc").read_text()


@pytest.mark.long
def test_planning_for_a_machine_allows_what_it_holds(document, parts):
    from freecad.toolaxis.services import api
    from freecad.toolaxis.services.write_results import apply

    thing = parts.block(document)
    inputs = parts.inputs_for((thing, parts.sculptured_name(thing)), scallop=0.6, limits=LIMITS)
    made = apply(document, inputs, api.task(inputs)(parts.NO_PROGRESS))[0]
    assert made.Outcome == "feasible" and len(made.RotaryAngles) == 2, made.Reasons
    assert machine_limits.mounting(LIMITS, inputs.assembled()).allowed(np.array([made.Axis]))[0]
    assert "machine" not in made.NotChecked
    assert 1 in json.loads(made.AxisMap)["map"]["reason"], "axes that the machine does not hold are grey on the map"


@pytest.fixture
def clamped(document):
    """A block with its top at z = 10, and a post beside it whose near side is 12 mm from x = 0."""
    import Part

    for name, size, corner in (("Block", (40, 40, 10), (-20, -20, 0)), ("Post", (10, 10, 60), (12, -5, 0))):
        document.addObject("Part::Feature", name).Shape = Part.makeBox(*size, Vector(*corner))
    return [collisions.ShapeCopy(thing.Name, f"the {thing.Name}", thing.Shape) for thing in document.Objects]


@pytest.mark.parametrize(("tip", "member", "thing"), [
    ((-5, 0, 10), None, None), ((-5, 0, 9.95), None, None), ((-5, 0, 9), "cutter", "Block"),
    ((3, 0, 12), "holder", "Post"), ((1.5, 0, 12), None, None)])
def test_what_the_tool_meets_is_told_by_its_object(mounted, clamped, tip, member, thing):
    """The holder of 20 mm begins 30 mm above the tip; the top of the block and the post are where they are."""
    known = collisions.around(mounted, [TOOL], clamped, NO_PROGRESS)
    journey = MachineTour.through(mounted, [(np.array(tip, dtype=float), np.zeros(2))])
    found, = collisions.along(known, journey, [0], NO_PROGRESS)
    passes = known.on_passes(0, np.zeros(2), np.array([[-5.0, 0.0, 20.0], tip]))
    if member is None:
        assert found is None and passes is None
        return
    assert (found.member, found.thing, found.body) == (member, thing, "") and (found.member, found.thing) == (
        passes.member, passes.thing)
    assert found.text.startswith(f"the {member} collides with face ") and f" of the {thing} by 1.0 mm" in found.text


def test_the_tool_may_go_along_the_border_of_a_side(document, mounted):
    """A wedge whose sides are trapezoids: the tool over the low end meets the rectangle around a side, not the side."""
    import Part

    corners = [Vector(x, -20, z) for x, z in ((-20, 0), (20, 0), (20, 24), (-20, 4), (-20, 0))]
    wedge = Part.Face(Part.makePolygon(corners)).extrude(Vector(0, 40, 0))
    known = collisions.around(mounted, [TOOL], [collisions.ShapeCopy("Wedge", "Wedge", wedge)], NO_PROGRESS)
    tips = np.array([[-18.0, -19.0, 9.0], [-15.0, -19.0, 10.5]])
    assert known.on_passes(0, np.zeros(2), tips) is None
    low = known.on_passes(0, np.zeros(2), tips - [0, 0, 3.6])
    assert low.member == "cutter" and "by 0.6 mm" in low.text, "1 + 2 sin a - 1.4 cos a, tan a = 0.5"


def test_each_operation_has_its_own_tool_in_the_spindle(mounted, clamped):
    """A tool 20 mm longer lifts the spindle by that, and its holder clears the post that the short one's meets."""
    long = ta.Tool.ball(diameter=8, stickout=55, holder=[(10, 0), (10, 30), (20, 30), (20, 50)])
    tools, tip = [TOOL, long], np.array([3.0, 0.0, 12.0])
    journey = MachineTour.through(mounted, [(tip, np.zeros(2))] * 2, [tool.gauge_length for tool in tools])
    rise = journey.joints[1, 2] - journey.joints[0, 2]
    assert rise == pytest.approx(long.gauge_length - TOOL.gauge_length) and rise > 0
    assert [journey.station(way) for way in (0.0, 0.2, 0.21, 0.5, 1.0)] == [0, 0, 1, 1, 1]
    known = collisions.around(mounted, tools, clamped, NO_PROGRESS)
    found = collisions.along(known, journey, [0, 1], NO_PROGRESS)
    assert found[0].member == "holder" and found[-1] is None
    first, second = machine_angles.in_order(mounted, [(AXES[0], TIPS, tool.gauge_length) for tool in tools])
    assert not first[0][0].reason and not second[0][0].reason
    deep = machine_limits.mounting("machine:bc-table-table@0,0,-60", TOOL)
    short, far = machine_angles.in_order(deep, [(AXES[0], TIPS, tool.gauge_length) for tool in tools])
    assert "the spindle collides with the table" in short[0][0].reason and not far[0][0].reason


def test_what_meets_on_the_way_is_found_between_stations(mounted, clamped):
    """With little room above it the tool goes from one side of the post to the other through it."""
    axes = tuple(replace(axis, high=130.0) if axis.name == "Z" else axis for axis in mounted.machine.linear)
    low = replace(mounted, machine=replace(mounted.machine, linear=axes))
    journey = MachineTour.through(low, [(np.array([x, 0.0, 12.0]), np.zeros(2)) for x in (-5.0, 40.0)])
    known = collisions.around(low, [TOOL], clamped, NO_PROGRESS)
    found = collisions.along(known, journey, [0, 0], NO_PROGRESS)
    assert len(found) == collisions.STEPS + 1 and found[0] is None and found[-1] is None
    assert {one.thing for one in found if one} == {"Post"}
    with pytest.raises(Cancelled):
        collisions.along(known, journey, [0, 0], Progress(cancelled=lambda: True))
