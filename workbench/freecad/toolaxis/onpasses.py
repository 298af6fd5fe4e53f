"""What cutter, shank and holder of one operation meet of parts and of what stands beside them, motion by motion."""

from dataclasses import dataclass

from . import meetings

#: Motions that are measured once it is known that they meet something: the first, the last, and those between.
_MEASURED = 400


@dataclass(frozen=True)
class Bump:
    """Motions one after the other on which the same part of the tool meets the same face.

    Attributes
    ----------
    first, last : int
        Numbers of the motions; motion k ends at point k of the path.
    text : str
        The sentence, with the greatest depth on these motions.
    """

    first: int
    last: int
    text: str


@dataclass(frozen=True)
class Bumps:
    """All of an operation.

    Attributes
    ----------
    found : tuple of Bump
    checked : tuple of str
        What was looked at of "cutter", "shank" and "holder": what is known of the tool.
    """

    found: tuple
    checked: tuple

    def at(self, motion):
        """The one on a motion; None where nothing meets.

        Parameters
        ----------
        motion : int
        """
        return next((one for one in self.found if one.first <= motion <= one.last), None)


def bumps(tool, path, found, progress):
    """Where a tool meets copies of objects along its passes and links; runs in any thread.

    Parameters
    ----------
    tool : toolaxis.tools.assembly.Tool
    path : toolaxis.cldata.toolpath.ToolPath
        In the document's space.
    found : sequence of freecad.toolaxis.meetings.Copy
    progress : toolaxis.progress.Progress

    Returns
    -------
    Bumps
        The tool touches what it cuts: only what lies deeper than `freecad.toolaxis.meetings.DEPTH` counts.  Where the
        axis moves it is looked for at the points of the path, else on all of the way between them.
    """
    import numpy as np

    from toolaxis.contact.clearance import clearances, clears, segment_clearances, segment_clears
    from toolaxis.contact.surroundings import Surroundings
    from toolaxis.progress import heard

    names, faces = [], []
    for name, _, read in meetings.read(found, progress):
        names += [f"face {face.number} of {name}" for face in read]
        faces += read
    around = Surroundings(tuple(faces), np.full((len(faces), 3), -meetings.DEPTH))
    moves = bool(np.ptp(path.axis, axis=0).max(initial=0.0) > 1e-9)
    judge, measure = (clears, clearances) if moves else (segment_clears, segment_clearances)
    progress.report("looking for collisions", 0, 2)
    with heard(progress):
        bad = np.flatnonzero(~judge(tool, path.cl, path.axis if moves else path.axis[0], around).safe)
        progress.report("looking for collisions", 1, 2)
        some = bad[np.unique(np.linspace(0, max(len(bad) - 1, 0), _MEASURED).astype(int))] if len(bad) else bad
        rows = [] if not len(some) else _worst(measure, tool, (path, some, moves), around)
    checked = ("cutter", *(name for name in ("shank", "holder") if name in tool.outlines))
    ends = some + (0 if moves else 1)  # motion k leads from point k - 1 to point k
    return Bumps(_joined(ends.tolist(), rows, (bad + (0 if moves else 1)).tolist(), names), checked)


def _worst(measure, tool, what, around):
    """Of each motion which part of the tool meets which face, and how deep, mm."""
    import numpy as np

    from toolaxis.tools.solid import COMPONENTS

    path, some, moves = what
    found = []
    for k in some.tolist():
        tips = path.cl[k:k + 1] if moves else path.cl[k:k + 2]
        one = measure(tool, tips, path.axis[k], around)
        which = int(np.argmin(one.distance[0]))
        found.append((COMPONENTS[which], int(one.face[0, which]), -float(one.distance[0, which])))
    return found


def _joined(ends, rows, bad, names):
    """Bumps of motions one after the other that say the same; motions that were not measured go with the one before."""
    made, at = [], dict(zip(ends, rows, strict=True))
    known = None
    for motion in bad:
        known = at.get(motion, known)
        member, face, depth = known
        if depth < meetings.DEPTH or face < 0:
            continue
        last = made[-1] if made else None
        if last is not None and last["key"] == (member, face) and last["last"] == motion - 1:
            last["last"], last["depth"] = motion, max(last["depth"], depth)
        else:
            made.append({"key": (member, face), "first": motion, "last": motion, "depth": depth})
    return tuple(Bump(one["first"], one["last"],
                      f"the {one['key'][0]} meets {names[one['key'][1]]} by {one['depth']:.1f} mm") for one in made)
