"""What the panel of Machine looks at off the GUI thread."""

from dataclasses import dataclass, replace

import numpy as np
from freecad.toolaxis.document.machine_angles import in_order
from freecad.toolaxis.document.machine_limits import mounting
from freecad.toolaxis.services import collisions
from freecad.toolaxis.services.playing import lay_out_at, look_out


@dataclass(frozen=True, eq=False)
class MachineLook:
    """Operations on a machine.

    Attributes
    ----------
    mounted : toolaxis.machine.setup.Mounting
    operations : tuple of freecad.toolaxis.services.playing.PlayedOperation
    rows : list of (list of AxisSolution, int)
        The solutions of each operation, and which is taken, -1 for none.
    stations : tuple of (int, int)
        Operations that the machine reaches at all, by number, each with the solution at which it is played.
    laid : freecad.toolaxis.services.playing.PlayedTour or None
        These; None where there are none.
    """

    mounted: object
    operations: tuple
    rows: list
    stations: tuple
    laid: object

    def holding(self, row):
        """The machine with the tool of an operation in its spindle.

        Parameters
        ----------
        row : int
        """
        return replace(self.mounted, tool_length=self.operations[row].tool.gauge_length)


def looked_at(text, operations):
    """The operations on the machine of a text; runs off the GUI thread."""
    mounted = mounting(text, operations[0].tool)
    rows = in_order(mounted, [(one.axis, one.path.cl, one.tool.gauge_length) for one in operations])
    stations = tuple((k, max(taken, 0)) for k, (ways, taken) in enumerate(rows) if ways)
    laid = lay_out_at([operations[k] for k, _ in stations], mounted,
                      [rows[k][0][way].rotary for k, way in stations]) if stations else None
    return MachineLook(mounted, tuple(operations), rows, stations, laid)


def met_by(look, copies, progress):
    """What each solution of each operation meets, and what meets while they are played; runs off the GUI thread."""
    known = collisions.around(look.mounted, [one.tool for one in look.operations], copies, progress)
    held = {}
    for row, (ways, _) in enumerate(look.rows):
        for column, way in enumerate(ways):
            progress.report("checking for collisions", row, len(look.rows))
            held[row, column] = known.on_passes(row, way.rotary, look.operations[row].path.cl)
    played = replace(known, surroundings=tuple(known.surroundings[row] for row, _ in look.stations))
    return held, look_out(look.laid, copies, progress, played)


def tip_of(path, one):
    """The tip where an operation meets something, else one in the middle of its cuts."""
    return path.cl[middle_of(path)] if one is None else path.cl[min(one.motion + 1, len(path.cl) - 1)]


def middle_of(path):
    """The motion in the middle of the cuts."""
    from toolaxis.cldata.toolpath import Motion

    cuts = np.flatnonzero(np.asarray(path.kind) == Motion.CUT)
    return int(cuts[len(cuts) // 2]) if len(cuts) else 0
