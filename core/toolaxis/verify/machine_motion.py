"""A machine in motion: how near its table and its spindle come to each other, to the part and to the tool.

Points on the skin of each thing are carried along with the axes and held against the exact distance from the other.
No more is looked at than must be: from a place where two things are d apart nothing can happen for a motion of d.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from toolaxis.machine.axis import RotaryAxis
from toolaxis.machine.bodies import BED
from toolaxis.machine.kinematics import inverse
from toolaxis.machine.machine import Machine
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.face import Face
from toolaxis.tools.profile import Profile
from toolaxis.verify.component_clearance import FAR, Clearance
from toolaxis.verify.rigid_bodies import RigidBody, body_thing, cutter_line, revolve_rigid_body

Array = NDArray[np.float64]

#: The least motion between two looks, mm.
_STEP = 1.0
#: Turn of a rotary axis between two looks that is divided, and the tool axis' own turn that is not any more, rad; how
#: often.
_WIDE, _FINE, _HALVINGS = 0.1, 1e-4, 16
#: How far the linear axes may be from X, Y and Z.
_UPRIGHT = 1e-9
#: Sine of the angle between spindle and Z above which programs approach along one straight line.
_TILTED = 1e-6
#: Lines of a grid on a face of the part; points that are looked at together.
_GRID, _TILE = 60, 50_000


@dataclass(frozen=True, eq=False)
class MachineModel:
    """A machine with a part on its table and a tool in its spindle.

    Attributes
    ----------
    machine : Machine
    place : (4, 4) array
        Where the part stands on the table, all axes at zero.
    tool_length : float
        From the gauge point to the tip, mm.
    profile : Profile
        Generatrix of the cutter.
    outlines : dict of str to (k, 2) array
        Shank and holder as polylines (radius, z from the tip).
    faces : tuple of Face
        Of the part and of what stands beside it.
    """

    machine: Machine
    place: Array
    tool_length: float
    profile: Profile
    outlines: dict[str, Array]
    faces: tuple[Face, ...]

    @cached_property
    def bodies(self) -> tuple[RigidBody, ...]:
        """The machine's own bodies."""
        return tuple(body_thing(body) for body in self.machine.bodies)

    @cached_property
    def tool(self) -> tuple[RigidBody, ...]:
        """Cutter, shank and holder in the spindle."""
        machine = self.machine
        spindle = np.asarray(machine.spindle)
        tip = np.asarray(machine.gauge) - self.tool_length * spindle
        carrier = machine.head[-1] if machine.head else machine.linear[-1]
        lines = {"cutter": cutter_line(self.profile), **self.outlines}
        return tuple(revolve_rigid_body(name, carrier.name, line, tip, spindle) for name, line in lines.items())

    @cached_property
    def part(self) -> RigidBody:
        """The faces of the part on the table."""
        found = [np.empty((0, 3))]
        labels: list[str] = []
        apart = 0.0
        for face in self.faces:
            points = face.evaluate(face.grid(_GRID, _GRID)).point
            found.append(points)
            labels += [f"face {face.label}"] * len(points)
            apart = max(apart, float(np.sqrt(face.area)) / _GRID)
        turn = self.place[:3, :3]
        shift = self.place[:3, 3]
        on_table = np.concatenate(found) @ turn.T + shift
        return RigidBody("part", self._carrier, on_table, apart, None, tuple(labels))

    @property
    def _carrier(self) -> str:
        """What carries the part."""
        return self.machine.table[0].name if self.machine.table else BED

    def beside_part(self, thing: RigidBody) -> bool:
        """Whether a thing stands on the table's side of the linear axes.

        Parameters
        ----------
        thing : RigidBody
        """
        return thing.carried in (BED, *(axis.name for axis in self.machine.table))

    @cached_property
    def reach(self) -> tuple[float, float]:
        """How far anything on the table's and on the spindle's side is from the axes that turn it, at most, mm."""
        of_table = self._reach_of(self.machine.table, on_table=True)
        of_head = self._reach_of(self.machine.head, on_table=False)
        return of_table, of_head

    def _reach_of(self, axes: Sequence[RotaryAxis], on_table: bool) -> float:
        """How far anything on one side is from the rotary axes there, at most, mm."""
        everything = (*self.bodies, *self.tool, self.part)
        centres = [np.asarray(axis.point) for axis in axes]
        points = [thing.points for thing in everything if len(thing.points) and self.beside_part(thing) is on_table]
        if not centres or not points:
            return 0.0
        between = sum(float(np.linalg.norm(b - a)) for a, b in pairwise(centres))
        far = max(float(np.linalg.norm(rows - centre, axis=1).max()) for rows in points for centre in centres)
        return far + between

    def between(self, before: Array | None, after: Array) -> Array | None:
        """Joint coordinates of an index move, (n, 3 + m); None where there is no top to go to, or no known way.

        Up, turn, over, down; with a tilted spindle in one straight line from where the axes turned.

        Parameters
        ----------
        before : (3 + m,) array or None
            Where the last operation ends; None for the first one, which is reached from above.
        after : (3 + m,) array
            Where the next one begins.
        """
        machine = self.machine
        top = machine.linear[2].high
        off_axes = np.abs(machine.directions - np.eye(3)).max()
        if off_axes > _UPRIGHT or not np.isfinite(top):
            return None
        turn, _ = self.placed(self.tool[0], after)
        spindle = turn @ np.asarray(machine.spindle)
        lean = float(np.linalg.norm(np.cross(spindle, [0.0, 0.0, 1.0])))
        tilted = lean > _TILTED
        above = after.copy()
        above[2] = top
        if before is None:
            return None if tilted else np.array([above, after])
        rows = np.array([before, before, before, above, after])
        rows[1:3, 2] = top
        rows[2, 3:] = after[3:]
        return rows[[0, 1, 2, 4]] if tilted else rows

    def joints(self, tips: Array, axes: Array, rotary: Sequence[float]) -> tuple[Array, NDArray[np.int64]]:
        """Joint coordinates along cutter locations, from the solution that is nearest to rotary angles.

        Tip and tool axis go straight from one location to the next.  Where the rotary axes turn far on the way, as near
        the singular directions, they are taken at places between too.

        Parameters
        ----------
        tips, axes : (n, 3) array
        rotary : sequence of float
            Where the rotary axes stand at the first location, rad.

        Returns
        -------
        joints : (k, 3 + m) array
        arrival : (k,) array of int
            The location at which the motion arrives that ends there.
        """
        arrival = np.arange(len(tips))
        for _ in range(_HALVINGS):
            rows = self._nearest(tips, axes, rotary)
            turns = np.abs(np.diff(rows[:, 3:], axis=0)).max(axis=1, initial=0.0)
            leans = np.linalg.norm(np.diff(axes, axis=0), axis=1)
            far = (turns > _WIDE) & (leans > _FINE)
            if not far.any():
                break
            at = np.flatnonzero(far) + 1
            middle_tip = (tips[at - 1] + tips[at]) / 2
            middle = axes[at - 1] + axes[at]
            middle_axis = middle / np.linalg.norm(middle, axis=1)[:, None]
            tips = np.insert(tips, at, middle_tip, axis=0)
            axes = np.insert(axes, at, middle_axis, axis=0)
            arrival = np.insert(arrival, at, arrival[at])
        return rows, arrival

    def _nearest(self, tips: Array, axes: Array, rotary: Sequence[float]) -> Array:
        """Joint coordinates at locations, at each of them the solution that is nearest to the one before."""
        stand = np.asarray(rotary, dtype=float)
        found = inverse(self.machine, tips, axes, self.tool_length, self.place, near=stand)
        rows = np.empty((len(tips), found.joints.shape[2]))
        for k, branches in enumerate(found.joints):
            turn = np.mod(branches[:, 3:] - stand + np.pi, 2 * np.pi) - np.pi
            best = int(np.argmin(np.abs(turn).sum(axis=1)))
            stand = stand + turn[best]
            rows[k, :3] = branches[best, :3]
            rows[k, 3:] = stand
        return rows

    def placed(self, thing: RigidBody, joints: Array) -> tuple[Array, Array]:
        """The rotation (3, 3) and the shift (3,) that bring a thing to where it is at joint coordinates.

        Parameters
        ----------
        thing : RigidBody
        joints : (3 + m,) array
        """
        machine = self.machine
        table = [axis.name for axis in machine.table]
        head = [axis.name for axis in machine.head]
        turn = np.eye(3)
        shift = np.zeros(3)
        if thing.carried in table:
            for k in range(table.index(thing.carried), len(table)):  # from the part to the bed
                turn, shift = _then(turn, shift, machine.table[k], -joints[3 + k])
            return turn, shift
        if thing.carried == BED:
            return turn, shift
        moved = len(machine.linear)
        if thing.carried in head:
            for k in reversed(range(head.index(thing.carried) + 1)):  # from the tool to the linear axes
                turn, shift = _then(turn, shift, machine.head[k], joints[3 + len(table) + k])
        else:
            linear = [axis.name for axis in machine.linear]
            moved = linear.index(thing.carried) + 1
        return turn, shift + machine.directions[:, :moved] @ joints[:moved]

    @cached_property
    def judged(self) -> bool:
        """Whether there are bodies on both sides, the table's and the spindle's."""
        return len({self.beside_part(one) for one in self.bodies}) == 2

    @cached_property
    def tool_and_part(self) -> list[tuple[RigidBody, RigidBody]]:
        """Points of the part against the tool: along passes material removal judges that."""
        return [(self.part, one) for one in self.tool if len(self.part.points)]

    @cached_property
    def pairs(self) -> list[tuple[RigidBody, RigidBody]]:
        """What else is held apart: points of the first against the second."""
        head = [one for one in self.bodies if not self.beside_part(one)]
        table = [one for one in self.bodies if self.beside_part(one)]
        first = self.machine.linear[0].name
        part = [self.part] if len(self.part.points) else []
        found = []
        for one in head:
            against = [other for other in table if not (other.carried == BED and one.carried == first)]
            found += [(one, other) for other in against]
            found += [(other, one) for other in (*against, *part)]
        for one in self.tool:
            found += [(one, other) for other in table]
            found += [(other, one) for other in table]
        for one in table:
            if one.carried != self._carrier:
                found += [(some, one) for some in part]
        return found


def least_room(rig: MachineModel, joints: Array, needed: float, pairs: Sequence[tuple[RigidBody, RigidBody]],
               progress: Progress = NO_PROGRESS) -> Clearance:
    """Where anything comes nearest to anything else along straight motions of the joints.

    Parameters
    ----------
    rig : MachineModel
    joints : (n, 3 + m) array
        mm and rad.
    needed : float
        Distances above this are not told exactly: motions on which nothing comes as near are passed over, mm.
    pairs : sequence of (Thing, Thing)
        Of the rig.
    progress : Progress

    Returns
    -------
    Clearance
        The least distance that was seen, with the names of the two, the place in the part's frame and the row of joints
        at which the motion arrives.  Of flat skins it is exact where a corner comes near; elsewhere it may be up to its
        `uncertainty` too great.
    """
    way = _way_of_anything(rig, joints)
    whole = way[-1]
    last_row = len(joints) - 1
    worst = Clearance("", FAR, "", (0.0, 0.0, 0.0), -1, 0.0)
    for number, (cloud, body) in enumerate(pairs):
        progress.report("bodies of the machine", number, len(pairs))
        at = 0.0
        while at <= whole:
            row = int(np.clip(np.searchsorted(way, at), 1, max(last_row, 1)))
            here = np.array([np.interp(at, way, column) for column in joints.T])
            distance, k, place = _apart(rig, cloud, body, here)
            if distance < worst.distance:
                near = cloud.labels[k] if cloud.labels else cloud.name
                one, other = (body.name, near) if rig.beside_part(cloud) else (near, body.name)
                x, y, z = (float(value) for value in place)
                worst = Clearance(one, distance, other, (x, y, z), min(row, last_row), cloud.spacing)
            if at == whole:
                break
            at = min(at + max(distance - needed, _STEP), whole)
    return worst


def _way_of_anything(rig: MachineModel, joints: Array) -> Array:
    """How far anything in a machine goes at most up to each row of joints, (n,) mm."""
    steps = np.abs(np.diff(joints, axis=0))
    head = 3 + len(rig.machine.table)
    of_table, of_head = rig.reach
    turns = steps[:, 3:head].sum(axis=1) * of_table + steps[:, head:].sum(axis=1) * of_head
    straight = np.linalg.norm(np.diff(joints[:, :3], axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(straight + turns)])


def _apart(rig: MachineModel, cloud: RigidBody, body: RigidBody, joints: Array) -> tuple[float, int, Array]:
    """The least distance of points from a body, mm, which one has it, and where that is in the part's frame."""
    assert body.inside is not None
    turn, shift = rig.placed(cloud, joints)
    other, aside = rig.placed(body, joints)
    least = np.inf
    k = 0
    place = np.zeros(3)
    for first in range(0, len(cloud.points), _TILE):
        there = cloud.points[first:first + _TILE] @ turn.T + shift
        found = body.inside((there - aside) @ other)
        i = int(np.argmin(found))
        if found[i] < least:
            least = float(found[i])
            k = first + i
            place = there[i]
    turned, moved = rig.placed(rig.part, joints)
    on_table = (place - moved) @ turned
    in_part = (on_table - rig.place[:3, 3]) @ rig.place[:3, :3]
    return least, k, np.asarray(in_part)


def _then(turn: Array, shift: Array, axis: RotaryAxis, angle: float) -> tuple[Array, Array]:
    """A rigid motion followed by a turn about an axis."""
    vector = angle * np.asarray(axis.direction)
    more = Rotation.from_rotvec(vector).as_matrix()
    centre = np.asarray(axis.point)
    return more @ turn, more @ (shift - centre) + centre
