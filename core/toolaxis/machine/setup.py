"""A machine with a part on its table and a tool in its spindle: which axes it takes, at which angles, and why not."""

from dataclasses import dataclass, field, replace
from itertools import product
from math import degrees
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.machine.body_poses import beside_part, meeting_at
from toolaxis.machine.kinematics import linear_coordinates, placement, rotary_angles, tool_axes
from toolaxis.machine.library import load_machine
from toolaxis.machine.limits import ROUNDING, SHORT_FORMS, AxisLimits, parse_limits
from toolaxis.machine.machine import Machine
from toolaxis.machine.reach import reach_excess, travel_excess
from toolaxis.numeric.vectors import angle_between, as_rows, unit

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: A machine, its name or file, or limits of the axis and their short form.
MachineLike: TypeAlias = Machine | AxisLimits | str
#: Axes that lie closer than this are one for the search, rad: steps of rotary axes below it are simply rounded.
SAME = 3e-4
#: Angle to the nearest allowed axis that is told where only the travel forbids one, rad: nobody knows it, it is not 0.
_UNKNOWN = 2 * ROUNDING


@dataclass(frozen=True, eq=False)
class Mounting:
    """A machine, the part on its table and the tool in its spindle; an `AxisLimits` like cone and ranges.

    Attributes
    ----------
    machine : Machine
    table_from_part : (4, 4) or (3,) array_like, optional
        Where the part stands on the table, all axes at zero: a rigid motion, or the part's origin in machine
        coordinates, mm.  Without it the part's axes are the machine's, and travel is not judged.
    tool_length : float, optional
        From the spindle's gauge point to the tip, mm.  Without it travel is not judged.
    reached : (n, 3) array
        Tips that every allowed axis must bring inside the linear travel, part's frame, mm.
    slack : float
        By how much they may miss it, mm.
    room : float
        How far bodies of both sides must be apart there, the tool left out, mm; negative for how deep they may meet.

    Raises
    ------
    InvalidInput
        When the machine is none, the place is no rigid motion, or the tool has no length.
    """

    machine: Machine
    table_from_part: ArrayLike | None = None
    tool_length: float | None = None
    reached: Array = field(default_factory=lambda: np.empty((0, 3)))
    slack: float = 0.0
    room: float = 0.0
    _last: dict[bytes, Bools] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        if not isinstance(self.machine, Machine):
            raise InvalidInput(f"machine is a {type(self.machine).__name__}: give a Machine, such as "
                               "toolaxis.load_machine(\"dmg-dmu-60t\")")
        for body in self.machine.bodies:
            _ = body.convex
        placement(self.table_from_part)
        if self.tool_length is not None and not (np.isfinite(self.tool_length) and self.tool_length >= 0):
            raise InvalidInput(f"tool length is {self.tool_length} mm: it must be finite and zero or more")

    @property
    def judges_travel(self) -> bool:
        """Whether place and tool length are known, so that linear travel can be judged."""
        return self.table_from_part is not None and self.tool_length is not None

    @property
    def judges_bodies(self) -> bool:
        """Whether besides the machine has bodies on both sides, the table's and the spindle's, to be held apart."""
        sides = {beside_part(self.machine, body) for body in self.machine.bodies}
        return self.judges_travel and len(sides) == 2

    @property
    def judges_index_moves(self) -> bool:
        """Whether bodies are judged and Z has an upper end, to which programs retract before rotary axes turn."""
        upright = np.abs(self.machine.directions - np.eye(3)).max() <= 1e-9
        return self.judges_bodies and bool(upright) and bool(np.isfinite(self.machine.linear[2].high))

    def reaching(self, points: ArrayLike, slack: float = 0.0) -> "Mounting":
        """The same with tips that must be reached.

        Parameters
        ----------
        points : (n, 3) array_like
            mm
        slack : float
            By how much they may miss the travel, mm: what the points differ from the tips really used.
        """
        return replace(self, reached=as_rows(points, 3, "points"), slack=float(slack), room=-float(slack))

    def allowed(self, axes: ArrayLike) -> Bools:
        """Whether some solution lies within all rotary ranges and brings what must be reached inside the travel, (n,).

        Parameters
        ----------
        axes : (n, 3) array_like
        """
        rows = as_rows(axes, 3, "axis")
        key = rows.tobytes()
        if key not in self._last:  # asked twice in a row by those who also want to know how far an axis is outside
            self._last.clear()
            self._last[key] = self._allowed(rows)
        return self._last[key].copy()

    def _allowed(self, rows: Array) -> Bools:
        found = rotary_angles(self.machine, rows, table_from_part=self.table_from_part)
        within = found.within.copy()
        if self.judges_travel and len(self.reached):
            for branch in range(within.shape[1]):
                some = np.flatnonzero(within[:, branch])
                within[some, branch] = self._worst(found.joints[some, branch]) <= self.slack
                some = np.flatnonzero(within[:, branch])
                if self.judges_bodies and len(some):
                    within[some, branch] = self.apart(found.joints[some, branch])[0].min(axis=1) >= self.room
        return np.asarray(within.any(axis=1))

    def _worst(self, rotary: Array) -> Array:
        """By how much the tips to be reached leave the travel at rotary angles, (k,) mm."""
        count, n = len(rotary), len(self.reached)
        tips = np.tile(self.reached, (count, 1))
        angles = np.repeat(rotary, n, axis=0)
        length = float(self.tool_length or 0.0)
        at = linear_coordinates(self.machine, tips, angles, length, self.table_from_part)
        beyond = [axis.excess(at[:, i]) for i, axis in enumerate(self.machine.linear)]
        worst_axis = np.max(beyond, axis=0)
        return np.asarray(worst_axis.reshape(count, n).max(axis=1, initial=0.0))

    def apart(self, rotary: Array) -> tuple[Array, list[tuple[str, str]]]:
        """How far bodies of both sides are apart with the outermost of the tips to be reached, (n, k) mm, and their
        names; see `toolaxis.machine.body_poses.meeting_at`.

        Parameters
        ----------
        rotary : (n, m) array
            rad
        """
        ends = np.unique(np.concatenate([self.reached.argmin(axis=0), self.reached.argmax(axis=0)]))
        return meeting_at(self.machine, rotary, self.reached[ends], float(self.tool_length or 0.0),
                          self.table_from_part)

    def excess(self, axes: ArrayLike) -> Array:
        """Angle from each axis to the nearest one within the rotary ranges, (n,) rad; 0 where it is allowed.

        Where only the travel forbids an axis the angle is not known, and told as next to nothing.

        Parameters
        ----------
        axes : (n, 3) array_like
        """
        away = reach_excess(self.machine, axes, self.table_from_part)
        return np.where(self.allowed(axes), 0.0, np.maximum(away, _UNKNOWN))

    def solutions(self, axis: ArrayLike) -> Array:
        """Rotary angles at which an axis can be held, rounded to the machine's steps, (s, m) rad.

        Those inside the ranges alone; the one with the least turns from zero first.

        Parameters
        ----------
        axis : (3,) array_like
        """
        found = rotary_angles(self.machine, as_rows(axis, 3, "axis")[:1], table_from_part=self.table_from_part)
        rows = np.unique(self._round_angles(found.joints[0][found.within[0]]), axis=0)
        return np.asarray(rows[np.argsort(np.abs(rows).sum(axis=1), kind="stable")])

    def _round_angles(self, angles: Array) -> Array:
        """Angles in the axes' steps and inside their ranges, (s, m) rad."""
        rows = np.array(angles, dtype=float).reshape(len(angles), len(self.machine.rotary))
        for i, axis in enumerate(self.machine.rotary):
            rows[:, i] = axis.rounded(rows[:, i])
            rows[:, i] -= axis.increment * (rows[:, i] > axis.high + ROUNDING)
            rows[:, i] += axis.increment * (rows[:, i] < axis.low - ROUNDING)
        return rows

    def axis_at(self, rotary: ArrayLike) -> Array:
        """The tool axis in the part's frame at rotary angles, (3,).

        Parameters
        ----------
        rotary : (m,) array_like
            rad
        """
        return np.asarray(unit(tool_axes(self.machine, rotary)[0] @ placement(self.table_from_part)[:3, :3]))

    def on_steps(self, axis: ArrayLike) -> Array:
        """Axes around one that the machine can hold in its steps, nearest first, (k, 3); just the nearest where the
        steps are too fine to matter.

        Parameters
        ----------
        axis : (3,) array_like
        """
        one = unit(as_rows(axis, 3, "axis")[0])
        found = rotary_angles(self.machine, one[None], table_from_part=self.table_from_part)
        rows = []
        for angles in found.joints[0][found.within[0]]:
            steps = [_steps(float(value), drive.increment, drive.low, drive.high)
                     for value, drive in zip(angles, self.machine.rotary, strict=True)]
            rows += [self.axis_at(np.array(pair)) for pair in product(*steps)]
        if not rows:
            return np.empty((0, 3))
        axes = np.array(rows)
        away = np.asarray(angle_between(axes, one))
        axes = axes[np.argsort(away, kind="stable")]
        return axes[:1] if away.max() <= SAME else axes

    def travel(self, points: ArrayLike, axis: ArrayLike) -> Array:
        """How far tips leave the linear travel with an axis in the solution that does best, (3,) mm; zero inside.

        Parameters
        ----------
        points : (n, 3) array_like
            mm
        axis : (3,) array_like

        Returns
        -------
        (3,) array
            Zeros where travel is not judged; infinite where the rotary axes do not get there.
        """
        if not self.judges_travel:
            return np.zeros(3)
        out = travel_excess(self.machine, points, axis, float(self.tool_length or 0.0), self.table_from_part)
        return np.asarray(out[np.argmin(out.max(axis=1))])

    def hold_side(self, points: ArrayLike, axis: ArrayLike) -> Array:
        """Those of `solutions` in which all tips lie inside the linear travel, (s, m) rad.

        Parameters
        ----------
        points : (n, 3) array_like
            mm
        axis : (3,) array_like
        """
        rows = self.solutions(axis)
        if not self.judges_travel or not len(rows):
            return rows
        seen = self.reaching(points)
        return np.asarray(rows[seen._worst(rows) <= 0])

    def why(self, axis: ArrayLike) -> str:
        """Why an axis is forbidden, in words; empty where it is allowed.

        Parameters
        ----------
        axis : (3,) array_like
        """
        one = as_rows(axis, 3, "axis")[:1]
        name = self.machine.name
        away = float(reach_excess(self.machine, one, self.table_from_part)[0])
        if away > 0:
            return f"no position of {name} reaches the axis: it is {degrees(away):.2f} deg beyond the rotary ranges"
        if bool(self.allowed(one)[0]):
            return ""
        return f"{self.out_of_travel(self.reached, one) or self._meets(one)} to reach the face"

    def _meets(self, axis: Array) -> str:
        """Which bodies meet in the solution in which they do least, in words."""
        rows = self.solutions(axis)
        rows = rows[self._worst(rows) <= self.slack]
        if not len(rows):
            return f"linear axes of {self.machine.name} would leave their travel in every solution"
        apart, names = self.apart(rows)
        best = int(np.argmax(apart.min(axis=1)))
        one, other = names[int(np.argmin(apart[best]))]
        least = float(apart[best].min())
        if least < 0:
            return f"the {one} collides with the {other} by {in_tenths(-least)} mm{self.at(rows[best])}"
        return f"the {one} comes within {least:.1f} mm of the {other}{self.at(rows[best])}"

    def at(self, rotary: ArrayLike) -> str:
        """Where the rotary axes stand, as messages write it: " at A -85 C 12"; empty without any.

        Parameters
        ----------
        rotary : (m,) array_like
            rad
        """
        angles = " ".join(f"{axis.name} {round(degrees(float(angle)), 3) + 0.0:g}"
                          for axis, angle in zip(self.machine.rotary, np.atleast_1d(rotary), strict=True))
        return f" at {angles}" if angles else ""

    def out_of_travel(self, points: ArrayLike, axis: ArrayLike) -> str:
        """Which linear axis leaves its travel most, in words; empty where none does.

        Parameters
        ----------
        points : (n, 3) array_like
            mm
        axis : (3,) array_like
        """
        out = self.travel(points, axis)
        worst = int(np.argmax(out))
        if not out[worst] > 0:
            return ""
        return (f"{self.machine.linear[worst].name} of {self.machine.name} would leave its travel by "
                f"{in_tenths(out[worst])} mm")


def in_tenths(excess: float) -> str:
    """How far something goes beyond what is allowed, mm as messages write it: "0.1" at least.

    Parameters
    ----------
    excess : float
        mm, above zero.
    """
    return f"{max(excess, 0.1):.1f}"


def machine_limits(machine: MachineLike, table_from_part: ArrayLike | None = None) -> AxisLimits:
    """What a machine allows, from whatever names it.

    Parameters
    ----------
    machine : Machine, AxisLimits or str
        A machine, its name in the library or its file, or limits of the axis and their short form.
    table_from_part : (4, 4) or (3,) array_like, optional
        Where the part stands on the machine's table.

    Raises
    ------
    InvalidInput
        When it is none of these, or a place is given for something that is no machine.
    """
    if isinstance(machine, str):
        short = machine.startswith(SHORT_FORMS)
        machine = parse_limits(machine) if short else load_machine(machine)
    if isinstance(machine, Machine):
        return Mounting(machine, table_from_part)
    if not (hasattr(machine, "excess") and hasattr(machine, "allowed")):
        raise InvalidInput(f"machine is a {type(machine).__name__}: give a Machine, its name or file, limits such as "
                           "Cone or RotaryRanges, or their short form")
    if table_from_part is not None:
        raise InvalidInput("a place of the part on the table is given without a machine: name the machine too")
    return machine


def _steps(angle: float, increment: float, low: float, high: float) -> list[float]:
    """The steps below and above an angle that are inside a range."""
    if increment == 0:
        return [angle]
    count = np.unique([np.floor(angle / increment), np.ceil(angle / increment), np.round(angle / increment)])
    return [float(k * increment) for k in count if low - ROUNDING <= k * increment <= high + ROUNDING]
