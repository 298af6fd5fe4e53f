"""Cutter locations as they were read: tips, axes, kinds of motion and feed rates, without contacts."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class CutterLocations:
    """What a CL file or a program says.

    Attributes
    ----------
    tip, axis : (n, 3) array
        Tool tips, mm, and unit axes, in the order in which they are visited.
    kind : (n,) array of int8
        `Motion` that arrives at each point: LINK where rapid, else as the file's PPRINT lines say, CUT without them.
    feedrate : (n,) array
        Feed rate that holds on the way to each point, mm/min; inf where rapid.
    breaks : (k + 1,) array of int
        Where each pass starts, by the file's PPRINT lines, and n at the end.
    told : bool
        Whether the file tells axes; (0, 0, 1) is taken where it does not.
    spindle : float
        The first speed that it tells, rev/min; 0 without any.
    """

    tip: Array
    axis: Array
    kind: NDArray[np.int8]
    feedrate: Array
    breaks: NDArray[np.int64]
    told: bool = True
    spindle: float = 0.0

    @property
    def rapid(self) -> NDArray[np.bool_]:
        """Whether the motion to each point is rapid, (n,)."""
        return np.asarray(self.kind == Motion.LINK)

    @property
    def path(self) -> ToolPath:
        """The same as a `ToolPath` without contacts: cc repeats the tips, the normal the axis."""
        return ToolPath(self.tip, self.tip, self.axis, self.axis, self.kind, self.breaks)


def gather_locations(rows: list[Array], kinds: list[int], rates: list[float], starts: list[int], *, told: bool,
                     spindle: float, source: str) -> CutterLocations:
    """Cutter locations from what was read point by point.

    Parameters
    ----------
    rows : list of (6,) array
        Tip, mm, and axis.
    kinds, rates : list
        Of each.
    starts : list of int
        Where passes begin; one pass without any.
    told : bool
        Whether axes were told.
    spindle : float
        rev/min
    source : str
        What was read, for messages.

    Raises
    ------
    InvalidInput
        When there are not two points.
    """
    if len(rows) < 2:
        raise InvalidInput(f"{source} has {len(rows)} points: at least two make a path")
    table = np.stack(rows)
    begins = starts if starts and starts[0] == 0 else [0, *starts]
    return CutterLocations(np.ascontiguousarray(table[:, :3]), np.ascontiguousarray(table[:, 3:]),
                           np.array(kinds, dtype=np.int8), np.array(rates),
                           np.array([*begins, len(table)], dtype=np.int64), told, spindle)
