"""Stations: where the machine stands for each operation, and the operation's path in the plane of that station."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import degrees

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import AxisOutOfReach, InvalidInput, PartMisplaced
from toolaxis.machine.kinematics import nearest_turn, placement, rotary_angles
from toolaxis.machine.machine import Machine
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import angle_between, rotation, unit
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Angle within which an operation's axis must stand still, rad.
FIXED = 1e-6
#: Shares of the machining tolerance and of the least clearance that holding the axis in the machine's steps may take.
_GOUGE_SHARE, _CLEARANCE_SHARE = 0.5, 0.1


@dataclass(frozen=True, eq=False)
class IndexedPosition:
    """One operation as a machine carries it out with its rotary axes standing still.

    Attributes
    ----------
    operation : Operation
    angles : (m,) array
        Where the rotary axes stand, in the order of `Machine.rotary`, in the machine's steps and the dialect's digits,
        rad; axes without end go on from station to station.
    others : (s, m) array
        The other solutions for the same axis, rad, whether within the ranges or not.
    reachable : (s,) array of bool
        Which of those are within the ranges.
    matrix : (3, 3) array
        The plane's axes as columns, in the directions of the work coordinate system: the machine's axes, on the table
        with all axes at zero.  After `Dialect.placed` it is the plane that the program's own words give.
    written : tuple of float
        Angles of the plane as they stand in the program, degrees; empty where the program holds none.
    tips : (n, 3) array
        Tool tips in the plane, from the plan's datum, mm.
    rapid : (n,) array of bool
        Whether the motion that arrives at each tip is rapid: a link along the tool axis, or above everything.
    orientation : int
        Number from 0 of the position of the rotary axes among the different ones of a program, whole turns aside.
    lean : float
        Angle between the tool axis at the angles and the one that the passes were made for, rad.
    tilt : float
        Angle between the spindle and the machine's Z axis, rad; 0 unless a head is tilted.
    """

    operation: Operation
    angles: Array
    others: Array
    reachable: Bools
    matrix: Array
    written: tuple[float, ...]
    tips: Array
    rapid: Bools
    orientation: int
    lean: float
    tilt: float


def stations(plan: Plan, mounting: Mounting, angle_digits: int,
             chosen: Mapping[int, ArrayLike] | None = None) -> tuple[IndexedPosition, ...]:
    """The stations of all operations of a plan that have an axis, in their order.

    The solution of each is the one with the least turn from the one before.

    Parameters
    ----------
    plan : Plan
    mounting : Mounting
        The machine, and where the part stands on its table.
    angle_digits : int
        Digits after the point in which rotary angles can be written, in degrees.
    chosen : mapping of int to (m,) array_like, optional
        Rotary angles that are already chosen for operations, by their numbers, rad.

    Raises
    ------
    InvalidInput
        When an axis is out of reach or held too far from where the passes were made for, a path leaves the travel, or
        an operation has no fixed axis.
    """
    found: list[IndexedPosition] = []
    known: list[Array] = []
    stand = np.zeros(len(mounting.machine.rotary))
    for op in plan.operations:
        if op.path is None or op.frame is None:
            continue
        given, length = (chosen or {}).get(op.number), op.tool.gauge_length
        held = mounting if len(plan.tools) == 1 or length is None else replace(mounting, tool_length=length)
        rows = _solutions(op, held) if given is None else _check_given_angles(op, given, held)
        rows = _close(_round_angles(rows, held.machine, angle_digits), op, plan, held)
        stand = rows[0] if given is not None else nearest_turn(mounting.machine, rows, stand)
        number = next((k for k, one in enumerate(known) if _same(one, stand)), len(known))
        known += [stand] if number == len(known) else []
        found.append(_station(op, mounting, stand, number))
    if not found:
        raise InvalidInput("the plan has no operation with an axis: there is nothing to post")
    return tuple(found)


def axes_on_turned_table(machine: Machine, angles: Array) -> Array:
    """The machine's axes as the turned table sees them, as columns, (3, 3).

    Parameters
    ----------
    machine : Machine
    angles : (m,) array
        rad
    """
    matrix = np.eye(3)
    for axis, angle in zip(machine.table, angles, strict=False):
        matrix = matrix @ rotation(axis.direction, float(angle))
    return matrix


def in_plane(station: IndexedPosition, mounting: Mounting, matrix: Array, datum: Array) -> IndexedPosition:
    """A station with its path in another plane.

    Parameters
    ----------
    station : IndexedPosition
    mounting : Mounting
    matrix : (3, 3) array
        The plane's axes as columns in the work coordinate system's directions.
    datum : (3,) array
        mm, part's frame.
    """
    path = station.operation.path
    assert path is not None
    turn = placement(mounting.table_from_part)[:3, :3]
    return replace(station, matrix=matrix, tips=(path.cl - datum) @ turn.T @ matrix)


def _fixed_axis_of(op: Operation) -> Array:
    """The axis of an operation, which must not turn."""
    assert op.path is not None
    axis = np.asarray(unit(op.path.axis.mean(axis=0)))
    away = float(np.max(angle_between(op.path.axis, axis)))
    if away > FIXED:
        raise InvalidInput(f"{op.name}: the tool axis turns by {degrees(away):.4f} deg along the path: only operations "
                           "with a fixed axis can be posted so; use --dialect apt")
    return axis


def _check_given_angles(op: Operation, angles: ArrayLike, mounting: Mounting) -> Array:
    """Rotary angles that are already chosen, (1, m) rad."""
    _fixed_axis_of(op)
    row, rotary = np.asarray(angles, dtype=float), mounting.machine.rotary
    if row.shape != (len(rotary),) or not np.isfinite(row).all():
        raise InvalidInput(f"{op.name}: rotary angles are {row.tolist()}: {len(rotary)} finite ones are needed")
    for axis, angle in zip(rotary, row, strict=True):
        if not axis.low - FIXED <= angle <= axis.high + FIXED or abs(float(axis.rounded(angle)) - angle) > FIXED:
            raise InvalidInput(f"{op.name}: axis {axis.name} does not hold {degrees(angle):.6f} deg: it goes from "
                               f"{degrees(axis.low):g} to {degrees(axis.high):g} deg in steps of "
                               f"{degrees(axis.increment):g} deg")
    return row[None]


def check_reach(op: Operation, mounting: Mounting) -> None:
    """Refuse an operation whose fixed axis no position of a machine reaches, wherever the part stands.

    Parameters
    ----------
    op : Operation
    mounting : Mounting

    Raises
    ------
    AxisOutOfReach
    """
    axis = _fixed_axis_of(op)
    if not len(mounting.solutions(axis)):
        why = mounting.why(axis) or f"no position of {mounting.machine.name} reaches the axis"
        raise AxisOutOfReach(f"{op.name}: {why}; plan for this machine, or post for another")


def _solutions(op: Operation, mounting: Mounting) -> Array:
    """Rotary angles in the machine's steps at which an operation can be carried out, (s, m) rad."""
    check_reach(op, mounting)
    assert op.path is not None
    axis = _fixed_axis_of(op)
    rows = mounting.hold_side(op.path.cl, axis)
    if not len(rows):
        raise PartMisplaced(f"{op.name}: {mounting.out_of_travel(op.path.cl, axis)}; move the part on the table")
    return rows


def _round_angles(rows: Array, machine: Machine, digits: int) -> Array:
    """Angles as a program writes them, rad; those of an axis without steps are rounded to the digits."""
    shown = np.round(np.degrees(rows), digits)
    for i, axis in enumerate(machine.rotary):
        lost = np.abs(np.radians(shown[:, i]) - rows[:, i]).max()
        if axis.increment > 0 and lost > 1e-9:
            raise InvalidInput(f"increment of axis {axis.name} is {degrees(axis.increment):g} deg: its steps cannot be "
                               f"written with {digits} digits after the point in this dialect")
    return np.radians(shown)


def _close(rows: Array, op: Operation, plan: Plan, mounting: Mounting) -> Array:
    """The angles at which the tool does not lean away from the axis that the passes were made and checked for."""
    assert op.path is not None
    tool = op.tool
    tolerance = plan.inputs.tolerance.for_cutter(tool.radius)
    least = min(tolerance.cutter_clearance, tolerance.shank_clearance, tolerance.holder_clearance)
    leans = np.array([float(np.max(angle_between(op.path.axis, mounting.axis_at(row)))) for row in rows])
    shifts, swings = leans * 2 * tool.radius, leans * tool.height
    good = (shifts <= _GOUGE_SHARE * tolerance.gouge) & (swings <= _CLEARANCE_SHARE * least)
    if not good.any():
        away, moved = float(leans.min()), float(np.maximum(shifts, swings).min())
        raise InvalidInput(f"{op.name}: the machine holds the axis {degrees(away):.4f} deg from the one that the "
                           f"passes were made for, which moves the tool by {moved:.4f} mm: make the plan "
                           "with --machine, so that its axes are ones that the machine can hold")
    return np.asarray(rows[good])


def _same(a: Array, b: Array) -> bool:
    """Whether rotary angles are the same position, whole turns aside."""
    return bool((np.abs(np.mod(a - b + np.pi, 2 * np.pi) - np.pi) < FIXED).all())


def _station(op: Operation, mounting: Mounting, angles: Array, number: int) -> IndexedPosition:
    assert op.path is not None and op.frame is not None
    machine = mounting.machine
    turn = placement(mounting.table_from_part)[:3, :3]
    z = turn @ mounting.axis_at(angles)
    x = turn @ op.frame.x
    x = unit(x - (x @ z) * z)
    matrix = np.stack([x, np.cross(z, x), z], axis=1)
    both = rotary_angles(machine, op.path.axis[:1], near=angles, table_from_part=mounting.table_from_part)
    apart = np.abs(both.joints[0] - angles).max(axis=1, initial=0.0) > 2e-2
    spindle = axes_on_turned_table(machine, angles).T @ z
    tilt = float(angle_between(spindle, np.array([0.0, 0.0, 1.0])))
    lean = float(np.max(angle_between(op.path.axis, mounting.axis_at(angles))))
    return IndexedPosition(op, angles, both.joints[0][apart], both.within[0][apart], matrix, (), op.path.cl,
                           op.path.rapid, number, lean, tilt if tilt > FIXED else 0.0)
