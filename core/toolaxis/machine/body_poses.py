"""Where the bodies of a machine stand at given rotary angles, seen from the part."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.machine.axis import RotaryAxis
from toolaxis.machine.bodies import BED, MachineBody
from toolaxis.machine.kinematics import linear_coordinates, placement
from toolaxis.machine.machine import Machine
from toolaxis.numeric.support_functions import ConvexBodies, places, separation

Array = NDArray[np.float64]


class BodyPose(NamedTuple):
    """A piece of the machine in the part's frame, and the linear motion that carries it.

    body : Body;  shape : its one Convex with the linear axes at zero;  carrier : (3, 3) array: the piece moves by
    carrier @ (linear coordinates), mm, in the part's frame; zero on the table's side.
    """

    body: MachineBody
    shape: ConvexBodies
    carrier: Array


def beside_part(machine: Machine, body: MachineBody) -> bool:
    """Whether a body stands on the table's side of the linear axes.

    Parameters
    ----------
    machine : Machine
    body : MachineBody
    """
    return body.carried in (BED, *(axis.name for axis in machine.table))


def part_from_bed(machine: Machine, rotary: ArrayLike, table_from_part: ArrayLike | None = None) -> Array:
    """The rigid motion from machine coordinates to the part's frame at rotary angles, (4, 4).

    Parameters
    ----------
    machine : Machine
    rotary : (m,) array_like
        rad
    table_from_part : (4, 4) or (3,) array_like, optional
    """
    matrix = np.asarray(np.linalg.inv(placement(table_from_part)), dtype=float)
    for axis, angle in zip(machine.table, np.atleast_1d(rotary), strict=False):
        matrix = matrix @ _turn(axis, float(angle))
    return matrix


def standing(machine: Machine, rotary: ArrayLike, table_from_part: ArrayLike | None = None) -> list[BodyPose]:
    """All bodies at rotary angles.

    Parameters
    ----------
    machine : Machine
    rotary : (m,) array_like
        rad
    table_from_part : (4, 4) or (3,) array_like, optional

    Notes
    -----
    Properties: (1) a body that is carried by the axis next to the part does not move; (2) the spindle's side moves as
    the tool does in `toolaxis.machine.kinematics.forward`.
    """
    part_from = part_from_bed(machine, rotary, table_from_part)
    directions = part_from[:3, :3] @ machine.directions
    poses = []
    for body in machine.bodies:
        part_from_body = part_from @ bed_from_body(machine, body.carried, rotary)
        carrier = directions @ axes_carrying(machine, body.carried)
        poses.append(BodyPose(body, body.convex.moved(part_from_body), carrier))
    return poses


def meeting_at(machine: Machine, rotary: Array, points: Array, length: float, table_from_part: ArrayLike | None,
               ) -> tuple[Array, list[tuple[str, str]]]:
    """How far bodies on the spindle's side are from those on the table's with the tip at points, the tool left out.

    Parameters
    ----------
    machine : Machine
    rotary : (n, m) array
        rad
    points : (p, 3) array
        Tool tips, part's frame, mm.
    length : float
        From the gauge point to the tip, mm.
    table_from_part : (4, 4) or (3,) array_like, optional

    Returns
    -------
    distance : (n, k) array
        The least over all points for each pair of bodies, mm.
    names : list of k pairs of str
    """
    count, tips = len(rotary), len(points)
    # Every tip at all rotary angles, those of one row of angles together.
    row = np.repeat(np.arange(count), tips)
    every_tip = np.tile(points, (count, 1))
    linear = linear_coordinates(machine, every_tip, rotary[row], length, table_from_part)
    carriers = {body.carried for body in machine.bodies}
    bed_from = {name: bed_from_body(machine, name, rotary) for name in carriers}
    found, names = [], []
    for pair in _pairs(machine):
        spindle, table = pair.spindle_side, pair.table_side
        moving = spindle.convex.moved(bed_from[spindle.carried]).rows(row)
        still = table.convex.moved(bed_from[table.carried]).rows(row)
        ways = places(linear @ axes_carrying(machine, spindle.carried) @ machine.directions.T)
        distances = separation([moving, ways], [still]).reshape(count, tips)
        found.append(distances.min(axis=1))
        names.append((spindle.name, table.name))
    return np.array(found).reshape(len(found), count).T, names


class _BodyPair(NamedTuple):
    """A body on the spindle's side and one on the table's that must not meet."""

    spindle_side: MachineBody
    table_side: MachineBody


def _pairs(machine: Machine) -> list[_BodyPair]:
    """All bodies of the one side with all of the other; what the first linear axis carries slides on the bed."""
    on_table = [body for body in machine.bodies if beside_part(machine, body)]
    on_spindle = [body for body in machine.bodies if not beside_part(machine, body)]
    slide = machine.linear[0].name
    return [_BodyPair(one, other) for one in on_spindle for other in on_table
            if not (other.carried == BED and one.carried == slide)]


def axes_carrying(machine: Machine, name: str) -> Array:
    """Which linear coordinates move what an axis carries: a diagonal matrix of ones and zeros, (3, 3).

    Parameters
    ----------
    machine : Machine
    name : str
        Of the axis, or "bed".
    """
    linear = [axis.name for axis in machine.linear]
    head = [axis.name for axis in machine.head]
    if name in linear:
        count = linear.index(name) + 1
    else:
        count = 3 if name in head else 0
    return np.diag(np.arange(3) < count).astype(float)


def bed_from_body(machine: Machine, name: str, rotary: ArrayLike) -> Array:
    """The rigid motion of what an axis carries with the linear axes at zero, machine coordinates, (4, 4) or (n, 4, 4).

    Parameters
    ----------
    machine : Machine
    name : str
        Of the axis, or "bed".
    rotary : (m,) or (n, m) array_like
        rad
    """
    angles = np.atleast_1d(np.asarray(rotary, dtype=float))
    matrix = np.broadcast_to(np.eye(4), (*angles.shape[:-1], 4, 4))
    table = [axis.name for axis in machine.table]
    head = [axis.name for axis in machine.head]
    if name in table:
        for k in reversed(range(table.index(name), len(table))):
            matrix = matrix @ _turn(machine.table[k], -angles[..., k])
    elif name in head:
        for k in range(head.index(name) + 1):
            matrix = matrix @ _turn(machine.head[k], angles[..., len(table) + k])
    return np.array(matrix)


def _turn(axis: RotaryAxis, angles: ArrayLike) -> Array:
    """Turns about an axis, (..., 4, 4)."""
    angle = np.asarray(angles, dtype=float)[..., None, None]
    x, y, z = axis.direction
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)
    matrix = np.zeros((*angle.shape[:-2], 4, 4))
    matrix[..., :3, :3] = turn
    matrix[..., :3, 3] = axis.point - matrix[..., :3, :3] @ axis.point
    matrix[..., 3, 3] = 1.0
    return matrix
