"""The order of operations and the rotary angles of each: least time to turn and to go over, nothing in the way."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf, isfinite

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
    found: list[tuple[list[_State], str]] = []
    for op in plan.operations:
        with about(op.face.label):
            found.append(_states(mounting, op, around) if _has_fixed_axis(op) else ([], ""))
    kept = tuple(refuse_operation(op, why) if why and not states else op
                 for op, (states, why) in zip(plan.operations, found, strict=True))
    outcome = plan.outcome if plan.outcome == "cancelled" else outcome_of(kept, plan.blades)
    plan = replace(plan, operations=kept, outcome=outcome, in_the_way=())
    rows = [states for states, _ in found if states]
    return check_machine_collisions(_in_order(plan, mounting, rows, around, reorder) if rows else plan, mounting,
                                    around)


def _in_order(plan: Plan, mounting: Mounting, rows: list[list[_State]], around: MachineSurroundings,
              reorder: bool) -> Plan:
    """The plan at those of the operations' states, and in that order, that cost least."""
    steps = _steps(mounting, rows)
    listed = np.arange(len(rows))
    before = _without_trouble(steps, rows, (mounting, around), listed)
    if reorder and len(rows) > 1:
        best = _without_trouble(steps, rows, (mounting, around), None)
        rank = [(bool(way.troubles), way.tour.cost) for way in (best, before)]
        chosen = best if rank[0] < (rank[1][0], rank[1][1] - 1e-6) else before
    else:
        chosen, best = before, before
    chosen = replace(chosen, troubles=(*chosen.troubles, *_at_the_ends(mounting, rows, chosen, around)))
    order = None
    if reorder and len(rows) > 1 and not mounting.machine.unstated:
        order = Order(chosen.tour.cost, before.tour.cost, min(best.tour.bound, chosen.tour.cost))
    return _put(plan, rows, chosen, order)


@dataclass(frozen=True, eq=False)
class _Way:
    """A tour through states, and what is in the way on it nevertheless."""

    tour: VisitingOrder
    troubles: tuple[str, ...]


def _at_the_ends(mounting: Mounting, rows: Sequence[list[_State]], way: _Way, around: MachineSurroundings) -> list[str]:
    """What is in the way before the first and after the last operation."""
    if not mounting.judges_index_moves:
        return []
    states = [state for some in rows for state in some]
    first, last = (states[way.tour.states[k]] for k in (0, -1))
    assert first.op.path is not None and last.op.path is not None
    begin, end = Stop(first.op.path.cl[0], first.rotary), Stop(last.op.path.cl[-1], last.rotary)
    told = trouble_at_the_ends(mounting, begin, end, around)
    return [f"{when} {_name_of(state.op)}: {why}" for when, state, why in
            zip(("before", "after"), (first, last), told, strict=True) if why]


def _has_fixed_axis(op: Operation) -> bool:
    """Whether an operation has a path whose axis stands still."""
    return op.path is not None and len(op.path.cl) > 0 and bool(np.ptp(op.path.axis, axis=0).max() < 1e-9)


def _around(plan: Plan, tool: Tool) -> MachineSurroundings:
    """Part and obstacles, and the distance that machine bodies keep."""
    bodies = [plan.part, *plan.obstacles]
    judged = plan.machine is not None and plan.machine.machine.bodies
    faces = tuple(forest(body.faces, FLAT / 10) for body in bodies if len(body.faces)) if judged else ()
    return MachineSurroundings(tool, faces, plan.inputs.tolerance.holder_clearance + plan.inputs.stock)


def _states(mounting: Mounting, op: Operation, around: MachineSurroundings) -> tuple[list[_State], str]:
    """All rotary angles at which an operation can be carried out, whole turns inside finite ranges told apart, and what
    is in the way at others."""
    assert op.path is not None
    rows, why, _ = free_solutions(mounting, op.path.cl, op.path.axis[0], around)
    found = []
    for row in rows:
        every = [axis.turns(float(angle)) if isfinite(axis.low) and isfinite(axis.high) else np.array([angle])
                 for axis, angle in zip(mounting.machine.rotary, row, strict=True)]
        ends = linear_coordinates(mounting.machine, op.path.cl[[0, -1]], row, float(mounting.tool_length or 0.0),
                                  mounting.table_from_part)
        turns = np.array(np.meshgrid(*every, indexing="ij")).reshape(len(every), -1).T if every else row[None]
        found += [_State(op, turn, ends) for turn in turns]
    return found, why


def _steps(mounting: Mounting, rows: Sequence[list[_State]]) -> TransitionCosts:
    """What goes between all states, s; radians of the largest turn where the machine's limits are not known."""
    states = [state for some in rows for state in some]
    owner = np.repeat(np.arange(len(rows)), [len(some) for some in rows])
    names = [np.round(np.asarray(some[0].op.orientation.axis), 9).tobytes() for some in rows]
    angles = np.array([state.rotary for state in states]).reshape(len(states), -1)
    cost, machine = np.zeros((len(states), len(states))), mounting.machine
    for k, axis in enumerate(machine.rotary):
        turn = np.abs(_shortest_turn(axis, angles[:, k][:, None], angles[:, k]))
        cost = np.maximum(cost, _turning_time(axis, turn, bool(machine.unstated)))
    if not machine.unstated:
        cost = cost + _over(mounting, np.array([state.ends for state in states]))
    cost[owner[:, None] == owner] = inf
    return TransitionCosts(cost, owner, np.array([names.index(name) for name in names]),
                           _TIE * np.abs(angles).sum(axis=1))


def _shortest_turn(axis: RotaryAxis, start: Array, end: Array) -> Array:
    """The turn from angles to angles, the shorter way where the axis turns without end."""
    turn = end - start
    endless = not (isfinite(axis.low) and isfinite(axis.high))
    return np.asarray(np.mod(turn + np.pi, 2 * np.pi) - np.pi) if endless else np.asarray(turn)


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
    drives = [axis.drive.levels(axis.name) for axis in machine.linear]
    aside = [travel_time(np.abs(ends[:, 1, k][:, None] - ends[:, 0, k]), *drives[k]) for k in (0, 1)]
    up, down = (travel_time(np.abs(top - ends[:, k, 2]), *drives[2]) for k in (1, 0))
    return np.asarray(up[:, None] + np.maximum(*aside) + down)


def _without_trouble(steps: TransitionCosts, rows: Sequence[list[_State]], known: tuple[Mounting, MachineSurroundings],
                     order: NDArray[np.int64] | None) -> _Way:
    """The cheapest tour on which nothing is in the way: what is turns that step out, until nothing is.

    Where every tour has something in the way, the first one is kept and says so.
    """
    mounting, around = known
    states = [state for some in rows for state in some]
    cost, first, bound = steps.cost.copy(), None, inf
    judged = mounting.judges_index_moves
    known_ways: dict[tuple[int, int], str] = {}

    def _in_the_way(a: int, b: int, stood: tuple[Array, Array]) -> str:
        if (a, b) not in known_ways:
            known_ways[a, b] = _trouble(mounting, (states[a], stood[0]), (states[b], stood[1]), around)
        return known_ways[a, b]

    for _ in range(_ATTEMPTS):
        now = replace(steps, cost=cost)
        tour = shortest(now) if order is None else in_order(now, order)
        if not isfinite(tour.cost):
            break
        if order is None and steps.things > EXACT:  # an order that is not proven is kept; its angles may still change
            order, bound = steps.owner[list(tour.states)], tour.bound
        tour = replace(tour, bound=min(tour.bound, bound))
        stood = _unwound(mounting, [states[k] for k in tour.states])
        bad = [(a, b, why) for (a, b), both in zip(pairwise(tour.states), pairwise(stood), strict=True)
               if judged and (why := _in_the_way(a, b, both))]
        way = _Way(tour, tuple(f"before {_name_of(states[b].op)}: {why}" for _, b, why in bad))
        if not bad:
            return way
        first = way if first is None else first
        for a, b, why in bad:
            cost[a, slice(None) if why.startswith(RETRACT) else b] = inf
    return first or _Way(in_order(steps, np.arange(steps.things)), ())


def _name_of(op: Operation) -> str:
    return f"face {op.face.label}"


def _trouble(mounting: Mounting, before: tuple[_State, Array], after: tuple[_State, Array],
             around: MachineSurroundings) -> str:
    (a, turned_a), (b, turned_b) = before, after
    assert a.op.path is not None and b.op.path is not None
    return trouble_between(mounting, Stop(a.op.path.cl[-1], turned_a), Stop(b.op.path.cl[0], turned_b), around)


def _unwound(mounting: Mounting, stops: Sequence[_State]) -> list[Array]:
    """Angles along a tour, axes without end going on from one to the next."""
    stand, found = np.zeros(len(mounting.machine.rotary)), []
    for stop in stops:
        stand = np.array([now + _shortest_turn(axis, np.asarray(now), np.asarray(angle))
                          if not isfinite(axis.high - axis.low)
                          else angle for axis, now, angle in zip(mounting.machine.rotary, stand, stop.rotary,
                                                                 strict=True)], dtype=float).reshape(stand.shape)
        found.append(stand)
    return found


def _put(plan: Plan, rows: Sequence[list[_State]], way: _Way, order: Order | None) -> Plan:
    """The plan in the order of a tour, those without a fixed axis at the end where anything moves."""
    assert plan.machine is not None
    states = [state for some in rows for state in some]
    stops = [states[k] for k in way.tour.states]
    stood = {id(stop.op): angles for stop, angles in zip(stops, _unwound(plan.machine, stops), strict=True)}
    listed = [op for op in plan.operations if id(op) in stood]
    moved = [stop.op for stop in stops]
    operations = list(plan.operations)
    if any(a is not b for a, b in zip(listed, moved, strict=True)):
        operations = [*moved, *(op for op in plan.operations if id(op) not in stood)]
    numbers = dict(zip([op.number for op in operations], sorted(op.number for op in operations), strict=True))
    made = tuple(replace(op, number=numbers[op.number], rotary=tuple(stood[id(op)].tolist()) if id(op) in stood else ())
                 for op in operations)
    blades = None if plan.blades is None else plan.blades.renumbered(numbers)
    outcome = "incomplete" if way.troubles and plan.outcome == "complete" else plan.outcome
    return replace(plan, operations=made, blades=blades, outcome=outcome, order=order, in_the_way=way.troubles)
