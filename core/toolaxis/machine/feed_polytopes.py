"""Which rotary angles let the linear axes do most along a feed direction while the rotary ones stand still.

The velocities, accelerations or jerks of three linear axes fill a box.  Along a feed direction the box reaches farthest
where the direction meets one of its eight corners, and each corner is met by two pairs of rotary angles of a table: 16
solutions.  Near the poles, the directions along the rotary axis next to the part, no corner can be met.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.machine.kinematics import part_from_machine
from toolaxis.machine.machine import Machine
from toolaxis.numeric.polytopes import box_vertices, reach
from toolaxis.numeric.rotations import two_turns
from toolaxis.numeric.vectors import as_rows, unit

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: How far axes may be from right angles in the closed forms, as a cosine.
SQUARE = 1e-9


class Level(IntEnum):
    """Which derivative of position is limited."""

    VELOCITY = 0
    ACCELERATION = 1
    JERK = 2


@dataclass(frozen=True, eq=False)
class Alignments:
    """Rotary angles that align a feed direction with the corners of the box.

    Attributes
    ----------
    angles : (n, 8, 2, 2) array
        For each direction and corner two pairs of rotary angles, rad, in the order of `Machine.rotary`.
    reached : (n, 8) array of bool
        Whether the corner can be met; in a pole zone none can.
    free : (n,) array of bool
        Whether the rotary axis next to the part is free, since the feed lies along it.
    corners : (8, 3) array
        The corners in joint coordinates.
    """

    angles: Array
    reached: Bools
    free: Bools
    corners: Array


def box(machine: Machine, level: Level) -> Array:
    """Limits of the three linear axes at a level, (3,) mm and s.

    Parameters
    ----------
    machine : Machine
    level : Level

    Raises
    ------
    InvalidInput
        When the machine does not know one of them.
    """
    return np.array([axis.drive.levels(axis.name)[level] for axis in machine.linear])


def check_jerk_stated(machine: Machine | None, remedy: str) -> None:
    """Check that there is a machine that can be turned so that its linear axes do most along the passes.

    Parameters
    ----------
    machine : Machine or None
    remedy : str
        How a machine is given.

    Raises
    ------
    InvalidInput
        When there is none, it has no rotary axis, or the jerk of a linear axis is not stated.
    """
    if machine is None:
        raise InvalidInput("method 'jerk' needs a machine, because it turns the part so that the linear axes together "
                           f"do most along the passes: {remedy}")
    if not machine.rotary:
        raise InvalidInput(f"method 'jerk' needs a rotary axis and {machine.name} has none: name another machine, or "
                           "choose another method")
    missing = [axis.name for axis in machine.linear if axis.drive.jerk is None or axis.drive.acceleration is None]
    if missing:
        raise InvalidInput(f"method 'jerk' needs acceleration and jerk of all linear axes, and {machine.name} does not "
                           f"state those of axis {missing[0]}: complete its file, or choose another method")


def along(machine: Machine, level: Level, feeds: ArrayLike, rotary: ArrayLike) -> Array:
    """What the machine can do along feed directions at rotary angles that stand still, (n,) mm and s.

    Parameters
    ----------
    machine : Machine
    level : Level
    feeds : (n, 3) array_like
        Directions on the part (placed on the table as it is drawn); made unit vectors.
    rotary : (n, m) or (m,) array_like
        rad.
    """
    rows = unit(as_rows(feeds, 3, "feed direction"))
    matrices = part_from_machine(machine, rotary)
    joint = np.linalg.solve(np.broadcast_to(matrices, (len(rows), 3, 3)), rows[:, :, None])[:, :, 0]
    return reach(box(machine, level), joint)


def preferred_direction(machine: Machine, level: Level) -> tuple[Array, Array]:
    """The joint direction in which the axes together do most at a level, and what they do there at every level.

    Parameters
    ----------
    machine : Machine
    level : Level

    Returns
    -------
    (3,) array
        Unit vector with positive components.
    (3,) array
        Greatest velocity, acceleration and jerk in that direction.

    Notes
    -----
    **Source** [grandguillaume2021] Table 2.
    """
    direction = unit(box_vertices(box(machine, level))[0])
    return direction, np.array([float(reach(box(machine, each), direction)[0]) for each in Level])


def alignments(machine: Machine, level: Level, feeds: ArrayLike) -> Alignments:
    """The 16 pairs of rotary angles of a table-table machine that align feeds with corners of the box.

    Parameters
    ----------
    machine : Machine
        With two rotary axes in the table.
    level : Level
    feeds : (n, 3) array_like
        Directions on the part (placed on the table as it is drawn); made unit vectors.

    Raises
    ------
    UnsupportedGeometry
        When the table has not two rotary axes.

    Notes
    -----
    **Source** [grandguillaume2021] Eq. (18), whose cases in Eqs. (30) to (34) one spherical triangle replaces.
    Properties: (1) `along` the feed at reached angles is the length of the corner, and no angles give more; (2) a pole
    zone begins where the paper's Eq. (20) says.
    """
    _check_table(machine)
    rows, corners = unit(as_rows(feeds, 3, "feed direction")), box_vertices(box(machine, level))
    first, second = machine.table
    found = [two_turns(first.direction, second.direction, machine.directions @ corner, rows) for corner in corners]
    return Alignments(np.stack([turns.angles for turns in found], axis=1),
                      np.stack([turns.reached for turns in found], axis=1), found[0].free, corners)


def best_along(machine: Machine, level: Level, feeds: ArrayLike) -> Array:
    """The most that any rotary angles allow along feed directions, ranges aside, (n,) mm and s.

    Parameters
    ----------
    machine : Machine
        With two rotary axes in the table at right angles, the second one along a linear axis, and linear axes at right
        angles.
    level : Level
    feeds : (n, 3) array_like
        Directions on the part; made unit vectors.

    Raises
    ------
    UnsupportedGeometry
        When the machine is of another kind.

    Notes
    -----
    Inside the pole zones the corner is out of reach and the edge next to it is best: the two linear axes across the
    second rotary axis do all they can, and the feed's component along the first rotary axis cannot exceed what they do
    together.
    **Source** [grandguillaume2021] Eqs. (20) and (21), which bound it.
    """
    limits, across = box(machine, level), _across(machine)
    rows = unit(as_rows(feeds, 3, "feed direction"))
    poleward = np.abs(rows @ machine.table[0].direction)
    with np.errstate(divide="ignore"):
        return np.asarray(np.minimum(np.linalg.norm(limits), np.linalg.norm(limits[across]) / poleward))


def pole_zone(machine: Machine, level: Level) -> float:
    """Half angle of the cones about the first rotary axis in which no feed can meet a corner, rad.

    Parameters
    ----------
    machine : Machine
        As for `best_along`.
    level : Level

    Notes
    -----
    **Source** [grandguillaume2021] Eq. (20).
    """
    limits, across = box(machine, level), _across(machine)
    return float(np.arccos(np.linalg.norm(limits[across]) / np.linalg.norm(limits)))


def best_angles(machine: Machine, level: Level, feed: ArrayLike) -> Array:
    """All pairs of rotary angles at which a machine does most along a feed direction, (k, 2) rad.

    Outside the pole zones these are the 16 `alignments`.  Inside, points of the edges take the corners' place and the
    two solutions of each meet, which leaves 8, or 4 where the first angle is free; 0 then stands for it.

    Parameters
    ----------
    machine : Machine
        As for `best_along`.
    level : Level
    feed : (3,) array_like

    Raises
    ------
    InvalidInput
        When more than one feed is given.
    """
    rows = unit(as_rows(feed, 3, "feed direction"))
    if len(rows) != 1:
        raise InvalidInput(f"{len(rows)} feed directions: one is needed")
    limits, across = box(machine, level), _across(machine)
    most = float(best_along(machine, level, rows)[0])
    inner = int(np.flatnonzero(~across)[0])
    whole = limits[inner]
    limits[inner] = min(whole, np.sqrt(max(most**2 - float(np.sum(limits[across] ** 2)), 0.0)))
    signs = box_vertices(np.ones(3))
    if limits[inner] == 0:
        signs = signs[signs[:, inner] > 0]
    first, second = machine.table
    pairs = [two_turns(first.direction, second.direction, machine.directions @ (sign * limits), rows) for sign in signs]
    solutions = slice(0, 1) if whole > limits[inner] else slice(0, 2)
    return np.concatenate([turns.angles[0, solutions] for turns in pairs])


def _check_table(machine: Machine) -> None:
    if machine.kind != "table-table":
        raise UnsupportedGeometry(f"machine {machine.name!r} is of the kind {machine.kind}: only two rotary axes in "
                                  "the table turn the part so that feeds meet the corners of what the axes can do")


def _across(machine: Machine) -> Bools:
    """Which linear axes lie across the second rotary axis."""
    _check_table(machine)
    first, second = (axis.direction for axis in machine.table)
    ways = machine.directions
    parallel = np.abs(np.abs(ways.T @ second) - 1) < SQUARE
    if abs(first @ second) > SQUARE or np.abs(ways.T @ ways - np.eye(3)).max() > SQUARE or parallel.sum() != 1:
        raise UnsupportedGeometry(f"machine {machine.name!r} has axes that are not at right angles, or no linear axis "
                                  f"along {machine.table[1].name}: there is no closed form for its best angles")
    return np.asarray(~parallel)
