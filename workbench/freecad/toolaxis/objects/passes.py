"""The passes of an operation as a Path object in the frame of its plane, and back."""

import FreeCAD

_RAPID, _FEED = "G0", "G1"
_MOVES = {"G0": 0, "G00": 0, "G1": 1, "G01": 1}


def commands(path, frame, feedrate):
    """Commands in the frame of the plane: links as rapid moves, everything else as feed moves.

    Parameters
    ----------
    path : toolaxis.cldata.toolpath.ToolPath
    frame : toolaxis.machine.setup.WorkCoordinates
    feedrate : float
        mm/min; FreeCAD's commands have mm/s.

    Returns
    -------
    list of Path.Command
        As many as there are points.
    """
    import PathApp as Path

    from toolaxis.cldata.toolpath import Motion

    made = []
    rapid = [int(kind) == Motion.LINK for kind in path.kind]
    rapid[0] = True
    for fast, (x, y, z) in zip(rapid, frame.from_part(path.cl).tolist(), strict=True):
        word = {"X": x, "Y": y, "Z": z}
        made.append(Path.Command(_RAPID, word) if fast else Path.Command(_FEED, {**word, "F": feedrate / 60}))
    return made


def moves(passes):
    """Ends of the moves in the plane's frame, and which of them cut nothing.

    Parameters
    ----------
    passes : App.DocumentObject
        The Path object.

    Returns
    -------
    points : (n, 3) array
        mm
    rapid : (n,) array of bool
    """
    import numpy as np

    rows, rapid, last = [], [], {"X": 0.0, "Y": 0.0, "Z": 0.0}
    for command in passes.Path.Commands:
        if command.Name not in _MOVES:
            continue
        last = {name: command.Parameters.get(name, last[name]) for name in last}
        rows.append(tuple(last.values()))
        rapid.append(_MOVES[command.Name] == 0)
    return np.array(rows, dtype=float).reshape(-1, 3), np.array(rapid, dtype=bool)


def fill_passes(thing, made):
    """Put commands into a Path object.

    Parameters
    ----------
    thing : App.DocumentObject
    made : list of Path.Command
    """
    import PathApp as Path

    thing.Path = Path.Path(made)


def read_back(passes, motions, breaks):
    """The tool path that stands in the document, in the document's space.

    Parameters
    ----------
    passes : App.DocumentObject
    motions, breaks : sequence of int
        Kinds of motion and starts of passes; where the commands are not as many any more, their own names count.

    Returns
    -------
    toolaxis.cldata.toolpath.ToolPath
        Without contact points: they repeat the tool's tip.
    """
    import numpy as np

    from toolaxis.cldata.toolpath import Motion, ToolPath

    from ..places import matrix_of

    points, rapid = moves(passes)
    matrix = matrix_of(passes.Placement)
    tips = points @ matrix[:3, :3].T + matrix[:3, 3]
    kind, starts = np.array(motions, dtype=np.int8), np.array(breaks, dtype=np.int64)
    if len(kind) != len(tips):
        kind = np.where(rapid, Motion.LINK, Motion.CUT).astype(np.int8)
        starts = np.array([0, len(tips)])
    axis = np.tile(matrix[:3, 2], (len(tips), 1))
    return ToolPath(tips, tips, axis, axis, kind, starts)


class Stations:
    """Places along the moves that are not rapid, by their share of the length.

    Parameters
    ----------
    passes : App.DocumentObject
        The Path object.
    """

    def __init__(self, passes):
        import numpy as np

        self.points, rapid = moves(passes)
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        steps[rapid[1:]] = 0.0
        self.along = np.concatenate([[0.0], np.cumsum(steps)])

    def at(self, share):
        """The tool's tip in the plane's frame, a FreeCAD.Vector.

        Parameters
        ----------
        share : float
            0 at the start of the first pass, 1 at the end of the last.
        """
        import numpy as np

        if not len(self.points):
            return FreeCAD.Vector()
        length = min(max(share, 0.0), 1.0) * self.along[-1]
        if length >= self.along[-1]:
            tip = self.points[np.searchsorted(self.along, self.along[-1], side="left")]
        else:
            k = int(np.searchsorted(self.along, length, side="right"))
            part = (length - self.along[k - 1]) / (self.along[k] - self.along[k - 1])
            tip = self.points[k - 1] + part * (self.points[k] - self.points[k - 1])
        return FreeCAD.Vector(*tip.tolist())
