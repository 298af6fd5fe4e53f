"""The order of operations and their rotary angles, against all orders and all angles; what is in the way on it."""

import re
from dataclasses import replace
from itertools import pairwise, permutations, product
from pathlib import Path

import numpy as np
import pytest

import toolaxis as ta
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.collision.index_moves import Stop, trouble_between
from toolaxis.collision.machine_collision import MachineSurroundings
from toolaxis.feed.jerk_profile import travel_time
from toolaxis.job.files.plan_folder import read_plan, write_plan
from toolaxis.job.output.post import post_plan
from toolaxis.job.planning.sequencing import sequence_operations
from toolaxis.job.planning.timing import add_times
from toolaxis.machine.bodies import MachineBody
from toolaxis.machine.kinematics import linear_coordinates, rotary_angles
from toolaxis.machine.setup import Mounting
from toolaxis.machine.work_coordinates import work_coordinates
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.plan import Plan, PlanInputs
from toolaxis.post.context import Options
from toolaxis.report.tables import plan_table
from toolaxis.shape.bounding.bounding_tree import forest
from toolaxis.shape.part import Part

TOOL = ta.Tool.torus(diameter=12, corner_radius=2, stickout=50, holder=[(10.0, 0.0), (10.0, 40.0)])
PLACE = (-20.0, 10.0, 60.0)
X, Y = np.meshgrid(np.linspace(0, 40, 4), np.linspace(0, 30, 4), indexing="ij")
FACE = ta.Face.from_bspline(np.stack([X, Y, 0 * X], axis=-1))


def operation(number: int, axis: np.ndarray, start: np.ndarray) -> Operation:
    """A short cut between two tips above the plate, and the way to and from them along the axis."""
    axis = axis / np.linalg.norm(axis)
    cut = start + np.array([[0.0, 0.0, 12.0], [12.0, 3.0, 12.0]])
    tips = np.vstack([cut[0] + 20 * axis, cut, cut[1] + 20 * axis])
    kind = np.array([Motion.LINK, Motion.ENTRY, Motion.CUT, Motion.LINK], dtype=np.int8)
    path = ToolPath(tips, tips, np.tile(axis, (4, 1)), np.tile(axis, (4, 1)), kind, np.array([0, 4]))
    found = Orientation(axis, "u", 1, 1.0, 12.4, 2.0, 0.0, {}, "feasible")
    return Operation(number, FACE, TOOL, found, path, work_coordinates(axis, np.array([1.0, 0, 0]), np.zeros(3), start))


def plan_of(axes: list[tuple[float, float, float]], machine: str = "bc-table-table", bodies: bool = False) -> Plan:
    rng = np.random.default_rng(len(axes))
    operations = tuple(operation(k, np.array(axis, dtype=float), np.append(rng.uniform(0, 25, 2), 0.0))
                       for k, axis in enumerate(axes, 1))
    found = ta.load_machine(machine)
    if not bodies:
        found = replace(found, bodies=())
    return Plan(Part((FACE,)), (TOOL,), PlanInputs(0.1), operations, (), np.zeros(3), "complete",
                machine=Mounting(found, PLACE))


AXES = [(0.5, 0.1, 0.8), (-0.5, 0.2, 0.8), (0.45, 0.3, 0.8), (-0.3, -0.5, 0.8)]


def every_way(plan: Plan, op: Operation) -> list[np.ndarray]:
    """All angles inside the ranges, whole turns included, rounded to the steps."""
    machine, found = plan.machine.machine, []
    both = rotary_angles(machine, op.path.axis[:1], table_from_part=PLACE)
    for row in both.joints[0]:
        c, b = (np.round(angle / axis.increment) * axis.increment for angle, axis in zip(row, machine.table,
                                                                                       strict=True))
        for turn in (-2, -1, 0, 1, 2):
            if machine.table[0].low <= c + 2 * np.pi * turn <= machine.table[0].high and (
                    machine.table[1].low <= b <= machine.table[1].high):
                found.append(np.array([c + 2 * np.pi * turn, b]))
    return found


def seconds(plan: Plan, before: tuple[Operation, np.ndarray], after: tuple[Operation, np.ndarray]) -> float:
    machine = plan.machine.machine
    turn = max(float(travel_time(abs(b - a), axis.drive.velocity, axis.drive.acceleration, axis.drive.jerk))
               for axis, a, b in zip(machine.rotary, before[1], after[1], strict=True))
    start = linear_coordinates(machine, before[0].path.cl[-1], before[1], TOOL.gauge_length, PLACE)[0]
    end = linear_coordinates(machine, after[0].path.cl[0], after[1], TOOL.gauge_length, PLACE)[0]
    top = machine.linear[2].high

    def moved(k: int, way: float) -> float:
        drive = machine.linear[k].drive
        return float(travel_time(abs(way), drive.velocity, drive.acceleration, drive.jerk))

    return turn + moved(2, top - start[2]) + max(moved(k, end[k] - start[k]) for k in (0, 1)) + moved(2, top - end[2])


def test_the_order_is_the_best_of_all_orders_and_angles() -> None:
    plan = plan_of(AXES)
    ways = {op.number: every_way(plan, op) for op in plan.operations}
    assert min(map(len, ways.values())) >= 2 and max(map(len, ways.values())) > 2
    costs = {(a.number, i, b.number, j): seconds(plan, (a, one), (b, other))
             for a, b in permutations(plan.operations, 2)
             for i, one in enumerate(ways[a.number]) for j, other in enumerate(ways[b.number])}
    totals = {}
    for order in permutations(ways):
        totals[order] = min(sum(costs[a, i, b, j] for (a, i), (b, j) in pairwise(zip(order, chosen, strict=True)))
                            for chosen in product(*(range(len(ways[number])) for number in order)))
    made = add_times(plan, reorder=True)
    assert made.order is not None
    assert made.order.seconds == pytest.approx(min(totals.values()), abs=1e-5) == made.order.bound
    assert made.order.listed == pytest.approx(totals[1, 2, 3, 4], abs=1e-5) and made.order.listed > made.order.seconds
    assert made.order.seconds == pytest.approx(sum(op.time.index for op in made.operations), abs=1e-5)
    assert [op.number for op in made.operations] == [1, 2, 3, 4]
    axes = [tuple(np.round(op.orientation.axis, 6)) for op in made.operations]
    assert sorted(axes) == sorted(tuple(np.round(op.orientation.axis, 6)) for op in plan.operations)
    assert "no order takes less" in plan_table(made).caption and "s less than as planned" in plan_table(made).caption


def test_operations_with_one_axis_stay_together() -> None:
    axes = [(0.5, 0.1, 0.8), (-0.5, 0.2, 0.8), (0.5, 0.1, 0.8), (-0.3, -0.5, 0.8), (0.5, 0.1, 0.8)]
    made = add_times(plan_of(axes), reorder=True)
    shared = [k for k, op in enumerate(made.operations) if op.orientation.axis[0] > 0.4]
    assert shared in ([0, 1, 2], [1, 2, 3], [2, 3, 4])
    assert len({op.rotary for op in made.operations}) == 3


def test_nothing_is_reordered_unless_asked_for() -> None:
    plan = plan_of(AXES)
    made = add_times(plan)
    assert [op.path is old.path for op, old in zip(made.operations, plan.operations, strict=True)] == [True] * 4
    assert made.order is None and all(len(op.rotary) == 2 for op in made.operations)
    ways = [every_way(plan, op) for op in plan.operations]
    costs = [np.array([[seconds(plan, (a, one), (b, other)) for other in ways[k + 1]] for one in ways[k]])
             for k, (a, b) in enumerate(pairwise(plan.operations))]
    best = min(sum(costs[k][i, j] for k, (i, j) in enumerate(pairwise(chosen)))
               for chosen in product(*(range(len(some)) for some in ways)))
    assert sum(op.time.index for op in made.operations) == pytest.approx(best, abs=1e-5)


def test_axes_without_end_go_on_the_shorter_way() -> None:
    made = add_times(plan_of([(0.3, 0.1, 0.9), (0.1, 0.3, 0.9), (-0.3, 0.1, 0.9), (-0.1, -0.3, 0.9)], "mikron-ucp-710"),
                     reorder=True)
    turns = np.diff([op.rotary[0] for op in made.operations])
    assert (np.abs(turns) <= np.pi + 1e-9).all()


def test_the_plan_is_written_and_read_back_and_posted_as_it_was_ordered(tmp_path: Path) -> None:
    made = add_times(plan_of(AXES), reorder=True)
    write_plan(made, tmp_path)
    again = read_plan(tmp_path)
    assert again.order == made.order and [op.rotary for op in again.operations] == [op.rotary for op in made.operations]
    mounting = replace(again.machine, tool_length=TOOL.gauge_length)
    program = next(text for name, text in post_plan(again, "linuxcnc", mounting).items() if name.endswith(".ngc"))
    words = [line for line in program.splitlines() if " B" in line and " C" in line and line.startswith("G0")]
    found = [tuple(float(word[1:]) for word in line.split() if word[0] in "CB") for line in words[:4]]
    for angles, op in zip(found, made.operations, strict=True):
        assert np.allclose(sorted(angles), sorted(np.degrees(op.rotary)), atol=1e-3)


def test_angles_at_which_the_head_meets_something_are_left_out() -> None:
    """A part far from the middle: a block hangs where the spindle is in one of two solutions, the other is taken."""
    plan = plan_of([(0.6, 0.0, 0.8)])
    plan = replace(plan, operations=(operation(1, np.array([0.6, 0.0, 0.8]), np.array([150.0, 0, 0])),))
    machine = plan.machine.machine
    free = every_way(plan, plan.operations[0])
    signs = {float(np.sign(way[1])) for way in free}
    assert signs == {1.0, -1.0}
    spindle = MachineBody("spindle", "Z", "cylinder", np.array([[0.0, 0, 0], [0, 0, 200]]), 50.0)
    stands = {}
    for side in (1.0, -1.0):
        way = next(way for way in free if way[1] * side > 0)
        at = linear_coordinates(machine, plan.operations[0].path.cl, way, TOOL.gauge_length, PLACE).mean(axis=0)
        post = MachineBody("post", "bed", "box", at + np.array([[-20.0, -20, 60], [20, 20, 150]]))
        built = replace(plan, machine=Mounting(replace(machine, bodies=(post, spindle)), PLACE))
        made = sequence_operations(built)
        assert made.operations[0].done
        stands[side] = float(np.sign(made.operations[0].rotary[1]))
    assert stands == {1.0: -1.0, -1.0: 1.0}


def test_an_operation_that_meets_something_at_all_angles_has_no_axis_any_more() -> None:
    plan = plan_of(AXES)
    wall = MachineBody("wall", "bed", "box", np.array([[-900.0, -900, -900], [900, 900, 900]]))
    spindle = MachineBody("spindle", "Z", "cylinder", np.array([[0.0, 0, 0], [0, 0, 200]]), 50.0)
    made = sequence_operations(replace(plan, machine=Mounting(replace(plan.machine.machine, bodies=(wall, spindle)),
                                                              PLACE)))
    assert not any(op.done for op in made.operations) and made.outcome == "incomplete"
    assert made.operations[0].orientation.reasons[0].startswith("infeasible: the ")
    assert " collides with " in made.operations[0].orientation.reasons[0]
    with pytest.raises(ta.InvalidInput, match=r"op01-face1: the .* collides with .*; move the part on the table"):
        post_plan(plan, "linuxcnc", replace(made.machine, tool_length=TOOL.gauge_length))


def test_index_moves_go_around_what_is_in_the_way() -> None:
    """A low top of Z and a wall on the table: what the quickest order would meet is gone around."""
    plan = plan_of(AXES, bodies=True)
    machine = plan.machine.machine
    linear = (*machine.linear[:2], replace(machine.linear[2], high=235.0))
    wall = MachineBody("wall", "C", "box", np.array([[150.0, -160, 0], [160, 160, 160]]))
    free, walled = (add_times(replace(plan, machine=Mounting(replace(machine, linear=linear, bodies=bodies), PLACE)),
                              True)
                    for bodies in ((), (*machine.bodies, wall)))
    assert walled.in_the_way == () and walled.outcome == "complete" and all(op.done for op in walled.operations)
    assert walled.order.seconds >= free.order.seconds - 1e-9
    mounting = replace(walled.machine, tool_length=TOOL.gauge_length)
    around = MachineSurroundings(TOOL, (forest((FACE,)),), 1.0)
    stops = [(Stop(op.path.cl[0], np.array(op.rotary)), Stop(op.path.cl[-1], np.array(op.rotary)))
             for op in walled.operations]
    assert all(trouble_between(mounting, a[1], b[0], around) == "" for a, b in pairwise(stops))


def test_what_is_in_the_way_on_every_order_is_told_and_not_posted() -> None:
    """A roof that the head's upper end meets whenever Z retracts."""
    plan = plan_of(AXES, bodies=True)
    machine = plan.machine.machine
    roof = MachineBody("roof", "bed", "box", np.array([[-900.0, -900, 740], [900, 900, 760]]))
    made = add_times(replace(plan, machine=Mounting(replace(machine, bodies=(*machine.bodies, roof)), PLACE)),
                     reorder=True)
    assert all(op.done for op in made.operations) and len(made.in_the_way) == 5 and made.outcome == "incomplete"
    assert all("the spindle collides with the roof by 10.0 mm at C" in why for why in made.in_the_way)
    assert sum("before face" in why and "on the retract" in why for why in made.in_the_way) == 3
    assert "on the approach" in made.in_the_way[3] and made.in_the_way[4].startswith("after face")
    with pytest.raises(ta.InvalidInput, match="the machine collides between operations: before face"):
        post_plan(made, "linuxcnc", replace(made.machine, tool_length=TOOL.gauge_length))


def test_index_moves_are_said_not_to_be_judged_without_an_upper_end_of_z() -> None:
    plan = plan_of(AXES, bodies=True)
    machine = plan.machine.machine
    endless = replace(machine, linear=(*machine.linear[:2], replace(machine.linear[2], high=np.inf)))
    assert "collision with the machine on index moves" not in plan.not_checked
    assert "collision with the machine on index moves" in replace(plan, machine=Mounting(endless, PLACE)).not_checked
    assert add_times(replace(plan, machine=Mounting(endless, PLACE)), reorder=True).in_the_way == ()


def test_a_lower_retract_than_the_one_that_was_looked_at_is_told_on_the_setup_sheet() -> None:
    made = add_times(plan_of(AXES, bodies=True), reorder=True)
    mounting = replace(made.machine, tool_length=TOOL.gauge_length)
    sheets = [post_plan(made, "linuxcnc", mounting, options)["setup-linuxcnc.md"]
              for options in (None, Options(retract=400.0))]
    assert ["with Z at 500.000, not at 400.000" in sheet for sheet in sheets] == [False, True]
    first = made.operations[0].rotary
    stood = re.search(r"bring the rotary axes to C(\S+) B(\S+) with the spindle retracted", sheets[0])
    assert [float(angle) for angle in stood.groups()] == pytest.approx(np.degrees(first), abs=1e-3)
    assert "were not looked at" in sheets[0]


def test_more_operations_than_are_ordered_exactly_get_a_bound() -> None:
    rng = np.random.default_rng(6)
    made = add_times(plan_of([(*rng.uniform(-0.5, 0.5, 2), 0.9) for _ in range(15)]), reorder=True)
    assert made.order.bound < made.order.seconds < made.order.listed
    assert made.order.seconds == pytest.approx(sum(op.time.index for op in made.operations), abs=1e-4)
    assert f"no order takes less than {made.order.bound:.1f} s" in plan_table(made).caption
