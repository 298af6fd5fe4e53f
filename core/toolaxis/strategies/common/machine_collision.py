"""Table, trunnion and head of a machine against each other, part and tool while its rotary axes turn along a path.

Motions whose axes stand within a small range are held apart as one, in the middle of the range, and what turning to its
ends may carry anything towards anything else is asked of the distance besides.  Where that is too much the range is
split, and in the end the motions themselves.  The tool over what goes along with the part is looked at from there,
where it only leans about its tip; everything else in the machine, where the rotary axes turn.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from toolaxis.collision.index_moves import arms
from toolaxis.collision.machine_collision import (
    BodyTree,
    CollisionPoint,
    MachineSurroundings,
    approach,
    carrier_of,
    meeting_on,
    single,
    tree_over,
)
from toolaxis.machine.body_poses import standing
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.support_functions import ConvexBodies, segments
from toolaxis.numeric.vectors import angle_between, perpendicular, unit
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.tools.solid import COMPONENTS, convex_pieces, solid_pieces

Array = NDArray[np.float64]

#: Play that turning may have before distances are looked at, and below which ranges are not split any more, mm.
COARSE, FINE = 30.0, 0.05
#: Angle by which the tool axis of evenly turning rotary axes may miss the straight turn between two points, rad.
_OFF = 1e-4


@dataclass(frozen=True, eq=False)
class MachineMotions:
    """Straight motions of all machine axes, and of the tip.

    Attributes
    ----------
    linear : (n, 2, 3) array
        Linear coordinates at both ends, mm.
    rotary : (n, 2, m) array
        rad
    tips : (n, 2, 3) array
        mm, part's frame.
    axes : (n, 2, 3) array
        Unit tool axes there.
    arrival : (n,) array of int
        Point of the path at which each arrives.
    """

    linear: Array
    rotary: Array
    tips: Array
    axes: Array
    arrival: NDArray[np.int64]

    def rows(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> "MachineMotions":
        """Some of them."""
        linear = self.linear[chosen]
        rotary = self.rotary[chosen]
        tips = self.tips[chosen]
        return MachineMotions(linear, rotary, tips, self.axes[chosen], self.arrival[chosen])

    def halves(self) -> "MachineMotions":
        """Each as two."""
        axes = unit(_halves(self.axes))
        arrival = np.repeat(self.arrival, 2)
        return MachineMotions(_halves(self.linear), _halves(self.rotary), _halves(self.tips), np.asarray(axes), arrival)


def _halves(ends: Array) -> Array:
    """Both ends of straight motions (n, 2, m), each motion as two, (2 n, 2, m)."""
    middle = ends.mean(axis=1)
    halves = np.stack([ends[:, 0], middle, middle, ends[:, 1]], axis=1)
    return np.asarray(halves.reshape(-1, 2, ends.shape[-1]))


def motions(tips: Array, axes: Array, rotary: Array, linear: Array, arrival: NDArray[np.int64]) -> MachineMotions:
    """The motions between points that a machine follows, so close that the tool axis turns straight between them.

    Parameters
    ----------
    tips, axes : (n, 3) array
        mm, part's frame; unit vectors.
    rotary : (n, m) array
        rad; without jumps.
    linear : (n, 3) array
        mm
    arrival : (n,) array of int
        Point of the path at which the motion arrives that ends at each point.
    """
    start = slice(None)
    end = slice(None)
    if len(tips) > 1:
        start = slice(-1)
        end = slice(1, None)
    both = [np.stack([rows[start], rows[end]], axis=1) for rows in (linear, rotary, tips, axes)]
    return MachineMotions(both[0], both[1], both[2], both[3], arrival[end])


class _Look(Protocol):
    """Something that is held apart while axes move."""

    def play(self, some: MachineMotions) -> float:
        """How much less distances may be on any of the motions than in the middle of them, mm."""

    def nearest(self, some: MachineMotions, most: float) -> CollisionPoint | None:
        """What comes nearer than a distance, mm, with the axes in the middle; its motion counts the motions."""

    def split(self, some: MachineMotions) -> list[MachineMotions]:
        """The motions in sets with less play."""


def meeting_in_motion(mounting: Mounting, way: MachineMotions, around: MachineSurroundings,
                      progress: Progress = NO_PROGRESS) -> tuple[CollisionPoint, Array] | None:
    """Where anything on the spindle's side comes too near to anything on the table's while all axes move.

    Parameters
    ----------
    mounting : Mounting
        With bodies, a place of the part and a tool length.
    way : MachineMotions
    around : MachineSurroundings
        The tool is not held against the part: passes have been.
    progress : Progress

    Returns
    -------
    (Meeting, (m,) array) or None
        The meeting, with the point of the path at which its motion arrives and the rotary angles, rad; None where all
        distances are proven to be the required one or more.

    Raises
    ------
    Cancelled
        When the user asked to stop.

    Notes
    -----
    A point that is at most r from an axis moves by r times its turn at most, whatever the other axes do; so no distance
    changes by more than the sum over all axes of their turns times the reach of what they carry.
    """
    for look in (_Leaning(mounting, around), _Turning(mounting, around)):
        left = [way]
        total = max(len(way.arrival), 1)
        done = 0
        while left:
            some = left.pop()
            play = look.play(some)
            progress.report("bodies of the machine", done, total)
            if play <= COARSE:
                found = look.nearest(some, around.required + play)
                if found is None:
                    done = min(done + len(some.arrival), total)
                    continue
                if found.distance + play < around.required or play <= FINE:
                    k = min(found.motion, len(some.arrival) - 1)
                    meeting = found._replace(motion=int(some.arrival[k]))
                    return meeting, some.rotary[k].mean(axis=0)
            left += look.split(some)
    return None


class _Turning:
    """Everything in the machine but the tool over what goes along with the part, by the rotary axes."""

    def __init__(self, mounting: Mounting, around: MachineSurroundings) -> None:
        self.mounting = mounting
        self.around = around
        self.reach = arms(mounting, around)

    def play(self, some: MachineMotions) -> float:
        """By the reach of what each axis turns."""
        turns = np.ptp(some.rotary, axis=(0, 1))
        return float(turns @ self.reach) / 2

    def nearest(self, some: MachineMotions, most: float) -> CollisionPoint | None:
        """With the rotary axes in the middle."""
        least = some.rotary.min(axis=(0, 1))
        greatest = some.rotary.max(axis=(0, 1))
        middle = (least + greatest) / 2
        ways = _ways(some.linear)
        return meeting_on(self.mounting, middle, ways, self.around, with_tool=False, most=most, over_table=False)

    def split(self, some: MachineMotions) -> list[MachineMotions]:
        """By rotary angles."""
        return _split(some, lambda one: one.rotary * self.reach)


class _Leaning:
    """The tool over bodies that go along with the part, in the part's frame."""

    def __init__(self, mounting: Mounting, around: MachineSurroundings) -> None:
        machine = mounting.machine
        carrier = carrier_of(machine)
        stand = standing(machine, np.zeros(len(machine.rotary)), mounting.table_from_part)
        self.still: list[tuple[str, BodyTree]] = []
        for one in stand:
            if one.body.carried == carrier:
                self.still.append((one.body.name, single(one.shape)))
        rows = solid_pieces(around.tool.profile, around.tool.outlines)
        self.names = [COMPONENTS[int(row[7])] for row in rows]
        self.pieces = convex_pieces(rows)
        self.arm = float(self.pieces.reach.max()) if self.still else 0.0

    @staticmethod
    def _middle(some: MachineMotions) -> Array:
        least = some.axes.min(axis=(0, 1))
        greatest = some.axes.max(axis=(0, 1))
        way = (least + greatest) / 2
        if np.linalg.norm(way) == 0:
            return np.asarray(some.axes[0, 0])
        return np.asarray(unit(way))

    def play(self, some: MachineMotions) -> float:
        """By how far the tool reaches from its tip."""
        axes = some.axes.reshape(-1, 3)
        angle = float(angle_between(axes, self._middle(some)).max())
        half = min(angle + _OFF, np.pi) / 2
        return 2 * self.arm * float(np.sin(half))

    def nearest(self, some: MachineMotions, most: float) -> CollisionPoint | None:
        """With the tool along the middle axis."""
        axis = self._middle(some)
        frame = np.eye(4)
        frame[:3, :3] = np.stack([*perpendicular(axis), axis], axis=1)
        trail = tree_over(_ways(some.tips))
        pieces = self.pieces.moved(frame)
        best: CollisionPoint | None = None
        least = most
        for k, name in enumerate(self.names):
            piece = pieces.rows(np.array([k]))
            for other, tree in self.still:
                distance, motion, _ = approach(piece, trail, tree, least)
                if distance < least:
                    best = CollisionPoint(name, other, distance, motion)
                    least = distance
        return best

    def split(self, some: MachineMotions) -> list[MachineMotions]:
        """By tool axes."""
        return _split(some, lambda one: one.axes)


def _split(some: MachineMotions, values: Callable[[MachineMotions], Array]) -> list[MachineMotions]:
    """Motions in two sets, by the value along which their middles differ most; as halves where they change more."""
    ends = values(some)
    middle = ends.mean(axis=1)
    apart = np.ptp(middle, axis=0)
    own = np.abs(ends[:, 1] - ends[:, 0]).sum(axis=1)
    if apart.max(initial=0.0) < own.max(initial=0.0):
        halves = some.halves()
        if len(some.arrival) > 1:
            return [halves]
        return [halves.rows(np.array([k])) for k in (0, 1)]
    along = middle[:, int(np.argmax(apart))]
    near = along <= (along.min() + along.max()) / 2
    return [some.rows(~near), some.rows(near)]


def _ways(ends: Array) -> ConvexBodies:
    """Straight ways between ends (n, 2, 3)."""
    spread = np.zeros((len(ends), 3, 3))
    spread[:, 0] = (ends[:, 1] - ends[:, 0]) / 2
    centre = ends.mean(axis=1)[:, None]
    still = segments(np.zeros((len(ends) + 1, 3)))
    return still._replace(centre=centre, spread=spread)
