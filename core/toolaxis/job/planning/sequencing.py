"""The order of operations and the rotary angles of each: least time to turn and to go over, nothing in the way."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf, isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.collision.index_moves import RETRACT, Stop, trouble_at_the_ends, trouble_between
from toolaxis.collision.machine_collision import FLAT, MachineSurroundings, free_solutions
from toolaxis.errors import about
from toolaxis.feed.jerk_profile import travel_time
from toolaxis.job.planning.moving_axis_collisions import check_machine_collisions, refuse_operation
from toolaxis.machine.axis import RotaryAxis
from toolaxis.machine.kinematics import linear_coordinates
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.sequencing import EXACT, TransitionCosts, VisitingOrder, in_order, shortest
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import INDEX_SECONDS, Plan, outcome_of
from toolaxis.plan.timing import Order
from toolaxis.shape.bounding.bounding_tree import forest
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Weight of turns from zero, s per rad, that decides where times are equal.
_TIE = 1e-6
#: How often the order is looked for anew when something turned out to be in the way.
_ATTEMPTS = 60


@dataclass(frozen=True, eq=False)
class _State:
    """An operation at rotary angles, rad, with the linear coordinates of its first and last tip, mm."""

    op: Operation
    rotary: Array
    ends: Array


class _PossibleStates(NamedTuple):
    """All states of an operation, and what is in the way at other angles."""

    states: list[_State]
    why: str


def sequence_operations(plan: Plan, reorder: bool = False) -> Plan:
    """A plan whose operations stand at rotary angles that its machine can take, and in the quickest order if asked for.

    Operations with one axis follow each other.  Where bodies of the machine are known, angles at which they meet part,
    tool or each other are left out, and so are index moves on which they do; what no order avoids is told, and makes
    the plan incomplete.

    Parameters
    ----------
    plan : Plan
        With one tool.
    reorder : bool
        Whether operations may be put in another order; they are then numbered in it.

    Returns
    -------
    Plan
        As it is without a machine; an operation that the machine cannot carry out at any angles, or along its path
        where its axis moves, has no axis any more.
    """
    if plan.machine is None:
        return plan
    tool, = plan.tools
    mounting = replace(plan.machine, tool_length=tool.gauge_length)
    around = _around(plan, tool)
    rows: list[list[_State]] = []
    operations: list[Operation] = []
    for op in plan.operations:
        with about(op.face.label):
            found = _states(mounting, op, around) if _has_fixed_axis(op) else _PossibleStates([], "")
        if found.states:
            rows.append(found.states)
        is_refused = bool(found.why) and not found.states
        operations.append(refuse_operation(op, found.why) if is_refused else op)
    kept = tuple(operations)
    outcome = plan.outcome if plan.outcome == "cancelled" else outcome_of(kept, plan.blades)
    plan = replace(plan, operations=kept, outcome=outcome, in_the_way=())
    if rows:
        plan = _in_order(plan, mounting, rows, around, reorder)
    return check_machine_collisions(plan, mounting, around)


def _in_order(plan: Plan, mounting: Mounting, rows: list[list[_State]], around: MachineSurroundings,
              reorder: bool) -> Plan:
    """The plan at those of the operations' states, and in that order, that cost least."""
    steps = _steps(mounting, rows)
    may_reorder = reorder and len(rows) > 1
    as_planned = _without_trouble(steps, rows, (mounting, around), np.arange(len(rows)))
    best = _without_trouble(steps, rows, (mounting, around), None) if may_reorder else as_planned
    chosen = best if _is_better(best, as_planned) else as_planned
    at_the_ends = _at_the_ends(mounting, rows, chosen, around)
    chosen = replace(chosen, troubles=(*chosen.troubles, *at_the_ends))
    order = None
    if may_reorder and not mounting.machine.unstated:
        bound = min(best.tour.bound, chosen.tour.cost)
        order = Order(chosen.tour.cost, as_planned.tour.cost, bound)
    return _put(plan, rows, chosen, order)


@dataclass(frozen=True, eq=False)
class _Way:
    """A tour through states, and what is in the way on it nevertheless."""

    tour: VisitingOrder
    troubles: tuple[str, ...]


def _is_better(one: _Way, other: _Way) -> bool:
    """Whether nothing is in the way on one tour and something on the other, or else one takes less time."""
    if bool(one.troubles) != bool(other.troubles):
        return not one.troubles
    return one.tour.cost < other.tour.cost - 1e-6


def _at_the_ends(mounting: Mounting, rows: Sequence[list[_State]], way: _Way, around: MachineSurroundings) -> list[str]:
    """What is in the way before the first and after the last operation."""
    if not mounting.judges_index_moves:
        return []
    states = [state for some in rows for state in some]
    first = states[way.tour.states[0]]
    last = states[way.tour.states[-1]]
    assert first.op.path is not None and last.op.path is not None
    begin = Stop(first.op.path.cl[0], first.rotary)
    end = Stop(last.op.path.cl[-1], last.rotary)
    why_before, why_after = trouble_at_the_ends(mounting, begin, end, around)
    found = []
    if why_before:
        found.append(f"before {_name_of(first.op)}: {why_before}")
    if why_after:
        found.append(f"after {_name_of(last.op)}: {why_after}")
    return found


def _has_fixed_axis(op: Operation) -> bool:
    """Whether an operation has a path whose axis stands still."""
    if op.path is None or not len(op.path.cl):
        return False
    greatest_change = np.ptp(op.path.axis, axis=0).max()
    return bool(greatest_change < 1e-9)


def _around(plan: Plan, tool: Tool) -> MachineSurroundings:
    """Part and obstacles, and the distance that machine bodies keep."""
    distance = plan.inputs.tolerance.holder_clearance + plan.inputs.stock
    if plan.machine is None or not plan.machine.machine.bodies:
        return MachineSurroundings(tool, (), distance)
    bodies = [plan.part, *plan.obstacles]
    faces = tuple(forest(body.faces, FLAT / 10) for body in bodies if len(body.faces))
    return MachineSurroundings(tool, faces, distance)


def _states(mounting: Mounting, op: Operation, around: MachineSurroundings) -> _PossibleStates:
    """All rotary angles at which an operation can be carried out, whole turns inside finite ranges told apart."""
    assert op.path is not None
    machine = mounting.machine
    solutions, why, _ = free_solutions(mounting, op.path.cl, op.path.axis[0], around)
    found = []
    for angles in solutions:
        ends = linear_coordinates(machine, op.path.cl[[0, -1]], angles, float(mounting.tool_length or 0.0),
                                  mounting.table_from_part)
        found += [_State(op, turned, ends) for turned in _whole_turns(machine.rotary, angles)]
    return _PossibleStates(found, why)


def _whole_turns(axes: Sequence[RotaryAxis], angles: Array) -> Array:
    """All combinations of rotary angles that are the same positions inside the ranges of the axes, (n, m) rad."""
    if not axes:
        return angles[None]
    of_each = []
    for axis, angle in zip(axes, angles, strict=True):
        of_each.append(np.array([angle]) if _is_endless(axis) else axis.turns(float(angle)))
    return np.array(np.meshgrid(*of_each, indexing="ij")).reshape(len(of_each), -1).T


def _is_endless(axis: RotaryAxis) -> bool:
    return not (isfinite(axis.low) and isfinite(axis.high))


def _steps(mounting: Mounting, rows: Sequence[list[_State]]) -> TransitionCosts:
    """What goes between all states, s; radians of the largest turn where the machine's limits are not known."""
    states = [state for some in rows for state in some]
    owner = np.repeat(np.arange(len(rows)), [len(some) for some in rows])
    angles = np.array([state.rotary for state in states]).reshape(len(states), -1)
    machine = mounting.machine
    cost = np.zeros((len(states), len(states)))
    for axis, of_axis in zip(machine.rotary, angles.T, strict=True):
        turn = np.abs(_shortest_turn(axis, of_axis[:, None], of_axis))
        cost = np.maximum(cost, _turning_time(axis, turn, bool(machine.unstated)))
    if not machine.unstated:
        cost = cost + _over(mounting, np.array([state.ends for state in states]))
    is_same_operation = owner[:, None] == owner
    cost[is_same_operation] = inf
    # Operations with one axis have one number: that of the first of them.
    axes = [np.round(np.asarray(some[0].op.orientation.axis), 9).tobytes() for some in rows]
    axis_numbers = np.array([axes.index(axis) for axis in axes])
    tie = _TIE * np.abs(angles).sum(axis=1)
    return TransitionCosts(cost, owner, axis_numbers, tie)


def _shortest_turn(axis: RotaryAxis, start: Array, end: Array) -> Array:
    """The turn from angles to angles, the shorter way where the axis turns without end."""
    turn = end - start
    if not _is_endless(axis):
        return np.asarray(turn)
    return np.asarray(np.mod(turn + np.pi, 2 * np.pi) - np.pi)


def _turning_time(axis: RotaryAxis, turn: Array, unstated: bool) -> Array:
    if unstated:
        return turn
    if axis.drive is None:
        return np.where(turn > 1e-9, INDEX_SECONDS, 0.0)
    return np.asarray(travel_time(turn, *axis.drive.levels(axis.name)))


def _over(mounting: Mounting, ends: Array) -> Array:
    """Time to retract, go over and come down between states, (n, n) s; zero where the place is not known."""
    machine, top = mounting.machine, mounting.machine.linear[2].high
    count = len(ends)
    if not (mounting.judges_travel and isfinite(top)):
        return np.zeros((count, count))
    along_x, along_y, along_z = (axis.drive.levels(axis.name) for axis in machine.linear)
    begin, end = ends[:, 0], ends[:, 1]
    over_x = travel_time(np.abs(end[:, 0][:, None] - begin[:, 0]), *along_x)
    over_y = travel_time(np.abs(end[:, 1][:, None] - begin[:, 1]), *along_y)
    up = travel_time(np.abs(top - end[:, 2]), *along_z)
    down = travel_time(np.abs(top - begin[:, 2]), *along_z)
    return np.asarray(up[:, None] + np.maximum(over_x, over_y) + down)


def _without_trouble(steps: TransitionCosts, rows: Sequence[list[_State]], known: tuple[Mounting, MachineSurroundings],
                     order: NDArray[np.int64] | None) -> _Way:
    """The cheapest tour on which nothing is in the way: what is turns that step out, until nothing is.

    Where every tour has something in the way, the first one is kept and says so.
    """
    mounting, around = known
    states = [state for some in rows for state in some]
    cost = steps.cost.copy()
    bound = inf
    first: _Way | None = None
    index_moves = _IndexMoves(mounting, states, around)
    for _ in range(_ATTEMPTS):
        now = replace(steps, cost=cost)
        tour = shortest(now) if order is None else in_order(now, order)
        if not isfinite(tour.cost):
            break
        if order is None and steps.things > EXACT:  # an order that is not proven is kept; its angles may still change
            order = steps.owner[list(tour.states)]
            bound = tour.bound
        tour = replace(tour, bound=min(tour.bound, bound))
        found = index_moves.find_troubles(tour)
        way = _Way(tour, tuple(f"before {_name_of(states[one.after].op)}: {one.why}" for one in found))
        if not found:
            return way
        first = first or way
        for one in found:
            if one.why.startswith(RETRACT):  # wherever it goes from there
                cost[one.before] = inf
            else:
                cost[one.before, one.after] = inf
    return first or _Way(in_order(steps, np.arange(steps.things)), ())


class _Trouble(NamedTuple):
    """What is in the way from one state, by its number, to another."""

    before: int
    after: int
    why: str


class _IndexMoves:
    """What is in the way between states, each pair of which is looked at once."""

    def __init__(self, mounting: Mounting, states: Sequence[_State], around: MachineSurroundings) -> None:
        self._mounting = mounting
        self._states = states
        self._around = around
        self._known: dict[tuple[int, int], str] = {}

    def find_troubles(self, tour: VisitingOrder) -> list[_Trouble]:
        """All that is in the way along a tour."""
        if not self._mounting.judges_index_moves:
            return []
        angles = _unwind_angles(self._mounting, [self._states[k] for k in tour.states])
        found = []
        for (a, b), (from_angles, to_angles) in zip(pairwise(tour.states), pairwise(angles), strict=True):
            if (a, b) not in self._known:
                self._known[a, b] = self._look_between(self._states[a], from_angles, self._states[b], to_angles)
            if self._known[a, b]:
                found.append(_Trouble(a, b, self._known[a, b]))
        return found

    def _look_between(self, before: _State, from_angles: Array, after: _State, to_angles: Array) -> str:
        assert before.op.path is not None and after.op.path is not None
        begin = Stop(before.op.path.cl[-1], from_angles)
        end = Stop(after.op.path.cl[0], to_angles)
        return trouble_between(self._mounting, begin, end, self._around)


def _name_of(op: Operation) -> str:
    return f"face {op.face.label}"


def _unwind_angles(mounting: Mounting, stops: Sequence[_State]) -> list[Array]:
    """Angles along a tour, axes without end going on from one to the next."""
    axes = mounting.machine.rotary
    now = np.zeros(len(axes))
    found = []
    for stop in stops:
        now = np.array([_next_angle(*one) for one in zip(axes, now, stop.rotary, strict=True)], dtype=float)
        found.append(now)
    return found


def _next_angle(axis: RotaryAxis, now: float, angle: float) -> float:
    """Where an axis stands at an angle that it comes to from another one."""
    if isfinite(axis.high - axis.low):
        return angle
    return float(now + _shortest_turn(axis, np.asarray(now), np.asarray(angle)))


def _put(plan: Plan, rows: Sequence[list[_State]], way: _Way, order: Order | None) -> Plan:
    """The plan in the order of a tour, those without a fixed axis at the end where anything moves."""
    assert plan.machine is not None
    states = [state for some in rows for state in some]
    stops = [states[k] for k in way.tour.states]
    angles = _unwind_angles(plan.machine, stops)
    rotary_of = {id(stop.op): tuple(row.tolist()) for stop, row in zip(stops, angles, strict=True)}
    listed = [op for op in plan.operations if id(op) in rotary_of]
    others = [op for op in plan.operations if id(op) not in rotary_of]
    in_order_of_tour = [stop.op for stop in stops]
    is_as_listed = all(a is b for a, b in zip(listed, in_order_of_tour, strict=True))
    operations = list(plan.operations) if is_as_listed else [*in_order_of_tour, *others]
    old_numbers = [op.number for op in operations]
    numbers = dict(zip(old_numbers, sorted(old_numbers), strict=True))
    made = tuple(replace(op, number=numbers[op.number], rotary=rotary_of.get(id(op), ())) for op in operations)
    blades = None if plan.blades is None else plan.blades.renumbered(numbers)
    outcome = "incomplete" if way.troubles and plan.outcome == "complete" else plan.outcome
    return replace(plan, operations=made, blades=blades, outcome=outcome, order=order, in_the_way=way.troubles)
