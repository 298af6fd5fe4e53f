"""What the panel of Machine looks at off the GUI thread, and what of it is shown in red."""

import numpy as np
from freecad.toolaxis.document.machine_angles import in_order
from freecad.toolaxis.document.machine_limits import mounting
from freecad.toolaxis.gui.machine.motion import MachineTour
from freecad.toolaxis.services import collisions


def looked_at(text, stands, tools):
    """The machine, the solutions of all operations, each with its tool, and the tools; runs off the GUI thread."""
    mounted = mounting(text, tools[0])
    asked = [(stand.matrix[:3, 2], stand.path.cl, tool.gauge_length) for stand, tool in zip(stands, tools, strict=True)]
    return mounted, in_order(mounted, asked), tools


def met_by(mounted, planned, copies, stations, progress):
    """What each solution of each operation meets, the way through stations, and what meets on it; off the GUI thread.

    The machine stands where an operation meets something, else in the middle of its cuts.
    """
    rows, tools, paths = planned
    known = collisions.around(mounted, tools, copies, progress)
    held = {}
    for row, (ways, _) in enumerate(rows):
        for column, way in enumerate(ways):
            progress.report("looking for collisions", row, len(rows))
            held[row, column] = known.on_passes(row, way.rotary, paths[row].cl)
    journey = MachineTour.through(mounted, [(tip_of(paths[row], held[row, column]), rows[row][0][column].rotary)
                                            for row, column in stations], lengths_at(stations, tools))
    return held, journey, collisions.along(known, journey, [row for row, _ in stations], progress)


def lengths_at(stations, tools):
    """The length of the tool at each station, mm; None where it has no holder."""
    return [tools[row].gauge_length for row, _ in stations]


def names_of(one):
    """Bodies and members of the tool that are red."""
    return set() if one is None else {one.member, one.body} - {""}


def things_of(one, document):
    """Objects of the document that are red."""
    thing = None if one is None or not one.thing else document.getObject(one.thing)
    return [] if thing is None else [thing]


def tip_of(path, one):
    """The tip where an operation meets something, else one in the middle of its cuts."""
    return middle_of(path) if one is None else path.cl[min(one.motion + 1, len(path.cl) - 1)]


def middle_of(path):
    """A tip in the middle of the cuts."""
    from toolaxis.cldata.toolpath import Motion

    cuts = path.cl[np.asarray(path.kind) == Motion.CUT]
    return cuts[len(cuts) // 2] if len(cuts) else path.cl[0]
