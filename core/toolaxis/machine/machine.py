"""A machine as a chain of axes from the part to the tool, and the kind of chain it is."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.machine.axis import LinearAxis, RotaryAxis
from toolaxis.machine.bodies import BED, MachineBody
from toolaxis.numeric.vectors import angle_between, as_rows, unit

Array = NDArray[np.float64]

#: Angle below which two axes count as parallel, rad.
PARALLEL = 1e-6

_KINDS = {(0, 0): "three axes", (1, 0): "table", (0, 1): "head", (2, 0): "table-table", (1, 1): "head-table",
          (0, 2): "head-head"}


@dataclass(frozen=True, eq=False)
class Machine:
    """Three linear and up to two rotary axes between the part and the tool.

    From the part to the tool: the rotary axes of the table, the linear axes, the rotary axes of the head, the tool.
    It does not matter which of the two a linear axis moves, for only the motion of one relative to the other counts.

    Attributes
    ----------
    name : str
    linear : tuple of three LinearAxis
        Not in one plane; they need not be at right angles.
    table : tuple of RotaryAxis
        Those that carry the part, the one next to the part first.
    head : tuple of RotaryAxis
        Those that carry the tool, the one next to the tool last.
    spindle : (3,) array
        Tool axis, tip to spindle, with all axes at zero; made a unit vector.
    gauge : (3,) array
        The spindle's gauge point with all axes at zero, machine coordinates, mm.
    source : str
        Where its numbers are from.
    assumed : tuple of str
        Which of its numbers are assumed, in words.
    bodies : tuple of MachineBody
        What it is made of, as far as that is known; the linear axes then stand in their order from the table.

    Raises
    ------
    InvalidInput
        When two axes have one name, the linear ones lie in a plane, there are more than two rotary axes, the two are
        parallel, one never changes the tool axis, or a body is carried by no axis or by two.
    """

    name: str
    linear: tuple[LinearAxis, ...]
    table: tuple[RotaryAxis, ...] = ()
    head: tuple[RotaryAxis, ...] = ()
    spindle: Array | tuple[float, float, float] = (0.0, 0.0, 1.0)
    gauge: Array | tuple[float, float, float] = (0.0, 0.0, 0.0)
    source: str = ""
    assumed: tuple[str, ...] = ()
    bodies: tuple[MachineBody, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "spindle", unit(as_rows(self.spindle, 3, "spindle direction")[0]))
        object.__setattr__(self, "gauge", as_rows(self.gauge, 3, "gauge point")[0])
        names = list(self.names)
        double = [name for name in names if names.count(name) > 1]
        if double:
            raise InvalidInput(f"machine {self.name!r} has two axes {double[0]}: each name may stand once")
        if len(self.linear) != 3 or abs(np.linalg.det(self.directions)) < PARALLEL:
            raise InvalidInput(f"machine {self.name!r} has linear axes {', '.join(names[:len(self.linear)]) or 'none'}"
                               ": three that do not lie in one plane are needed")
        if len(self.rotary) > 2:
            raise InvalidInput(f"machine {self.name!r} has {len(self.rotary)} rotary axes: at most two are handled")
        self._check_rotary()
        self._check_bodies()

    def _check_bodies(self) -> None:
        carriers: dict[str, str] = {}
        for body in self.bodies:
            if body.carried not in (BED, *self.names):
                raise InvalidInput(f"body {body.name} of machine {self.name!r} is carried by {body.carried!r}: use "
                                   f"{', '.join((BED, *self.names))}")
            if carriers.setdefault(body.name, body.carried) != body.carried:
                raise InvalidInput(f"body {body.name} of machine {self.name!r} is carried by {carriers[body.name]} and "
                                   f"by {body.carried}: give its pieces one axis, or two names")

    def _check_rotary(self) -> None:
        turning = [axis.direction for axis in self.rotary]
        if len(turning) == 2 and _parallel(turning[0], turning[1]):
            raise InvalidInput(f"rotary axes {self.rotary[0].name} and {self.rotary[1].name} of machine {self.name!r} "
                               "are parallel: two that are not are needed")
        if turning and _parallel(turning[-1], np.asarray(self.spindle)):
            raise InvalidInput(f"rotary axis {self.rotary[-1].name} of machine {self.name!r} lies along the spindle "
                               "and never changes the tool axis: leave it out, or check the order of the axes")

    @property
    def rotary(self) -> tuple[RotaryAxis, ...]:
        """All rotary axes from the part to the tool."""
        return (*self.table, *self.head)

    @property
    def directions(self) -> Array:
        """The linear axes' directions as columns, (3, 3)."""
        return np.stack([axis.direction for axis in self.linear], axis=1)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all axes in the order of joint coordinates: linear, then rotary from the part to the tool."""
        return (*(axis.name for axis in self.linear), *(axis.name for axis in self.rotary))

    @property
    def unstated(self) -> str:
        """The first limit of an axis that planning of feeds needs and the machine does not state; empty for none."""
        drives = [(axis.name, axis.drive) for axis in self.linear] + [(axis.name, axis.drive) for axis in self.rotary]
        missing = [f"{limit} of axis {name}" for name, drive in drives if drive is not None
                   for limit in ("acceleration", "jerk") if getattr(drive, limit) is None]
        return missing[0] if missing else ""

    @property
    def kind(self) -> str:
        """three axes, table, head, table-table, head-table or head-head."""
        return _KINDS[len(self.table), len(self.head)]

    @property
    def nutating(self) -> bool:
        """Whether two rotary axes are not at right angles."""
        if len(self.rotary) < 2:
            return False
        return bool(abs(self.rotary[0].direction @ self.rotary[1].direction) > PARALLEL)

    @property
    def chain(self) -> str:
        """The chain from workpiece w over the bed b to the tool t; a prime marks axes that carry the part.

        The linear axes are written on the tool's side, since only relative motion counts here.
        """
        steps = ["w", *(axis.name + "'" for axis in self.table), "b", *(axis.name for axis in self.linear),
                 *(axis.name for axis in self.head), "t"]
        return " ".join(steps)


def _parallel(a: Array, b: Array) -> bool:
    angle = float(angle_between(a, b))
    return min(angle, np.pi - angle) < PARALLEL
