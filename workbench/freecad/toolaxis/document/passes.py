"""The passes of an operation as a Path object in the frame of its plane, and back."""

import FreeCAD
from freecad.toolaxis.document.placement import matrix_of
from freecad.toolaxis.document.properties import Property, assign, ensure

#: What passes whose axis moves keep at each of their points, in the frame of the plane.
_MOVING = (Property("VectorList", "ToolAxes", "Tool Axis", "Tool axis at each point", True, True),
           Property("VectorList", "Contacts", "Tool Axis", "Contact with the face at each point", True, True))
_RAPID, _FEED = "G0", "G1"
_MOVES = {"G0": 0, "G00": 0, "G1": 1, "G01": 1}


def commands(path, frame, feedrate):
    """Commands in the frame of the plane: links as rapid moves, everything else as feed moves.

    Parameters
    ----------
    path : toolaxis.cldata.toolpath.ToolPath
    frame : toolaxis.machine.work_coordinates.WorkCoordinates
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


def keep_axes(thing, path, frame):
    """Keep the axis and the contact of each point in a Path object, whose commands have the tips only.

    Parameters
    ----------
    thing : App.DocumentObject
    path : toolaxis.cldata.toolpath.ToolPath or None
        None for an axis that stands still: nothing is kept.
    frame : toolaxis.machine.work_coordinates.WorkCoordinates
    """
    if path is None and "ToolAxes" not in thing.PropertiesList:
        return
    ensure(thing, _MOVING)
    if path is None:
        assign(thing, ToolAxes=[], Contacts=[])
        return
    turned = frame.from_part(frame.origin + path.axis)
    for name, rows in (("ToolAxes", turned), ("Contacts", frame.from_part(path.cc))):
        setattr(thing, name, [FreeCAD.Vector(*row) for row in rows.tolist()])


def axes_of(passes):
    """The axis at each point of passes, (n, 3), in the frame of the plane; None where it stands still.

    Parameters
    ----------
    passes : App.DocumentObject
    """
    import numpy as np

    kept = getattr(passes, "ToolAxes", None)
    return np.array([tuple(row) for row in kept]) if kept else None


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
        Without contact points where the axis stands still: they repeat the tool's tip.

    Raises
    ------
    InvalidInput
        When the axis moves and the commands are not those any more for which it was planned.
    """
    import numpy as np

    from toolaxis.cldata.toolpath import Motion, ToolPath
    from toolaxis.errors import InvalidInput

    points, rapid = moves(passes)
    matrix = matrix_of(passes.Placement)
    tips = points @ matrix[:3, :3].T + matrix[:3, 3]
    kind, starts = np.array(motions, dtype=np.int8), np.array(breaks, dtype=np.int64)
    if len(kind) != len(tips):
        kind = np.where(rapid, Motion.LINK, Motion.CUT).astype(np.int8)
        starts = np.array([0, len(tips)])
    kept = axes_of(passes)
    if kept is not None:
        if len(kept) != len(tips):
            raise InvalidInput(f"'{passes.Label}' has {len(tips)} moves and {len(kept)} tool axes: its commands were "
                               "changed since; recompute the operation")
        axis = kept @ matrix[:3, :3].T
        contacts = np.array([tuple(row) for row in passes.Contacts]) @ matrix[:3, :3].T + matrix[:3, 3]
        return ToolPath(contacts, tips, axis, axis, kind, starts)
    axis = np.tile(matrix[:3, 2], (len(tips), 1))
    return ToolPath(tips, tips, axis, axis, kind, starts)


class PassStations:
    """Places along the moves that are not rapid, by their share of the length.

    Parameters
    ----------
    passes : App.DocumentObject
        The Path object.
    """

    def __init__(self, passes):
        import numpy as np

        self.points, rapid = moves(passes)
        self.axes = axes_of(passes)
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        steps[rapid[1:]] = 0.0
        self.along = np.concatenate([[0.0], np.cumsum(steps)])

    def _within(self, share):
        """Number of the move, and the share of it that is done."""
        import numpy as np

        length = min(max(share, 0.0), 1.0) * self.along[-1]
        if length >= self.along[-1]:
            return int(np.searchsorted(self.along, self.along[-1], side="left")), 1.0
        k = int(np.searchsorted(self.along, length, side="right"))
        return k, (length - self.along[k - 1]) / (self.along[k] - self.along[k - 1])

    def motion(self, share):
        """Number of the move on which the tool stands, which ends at the point of that number.

        Parameters
        ----------
        share : float
            As for `at`.
        """
        return self._within(share)[0] if len(self.points) else 0

    def share(self, motion):
        """The share of the way at the end of a move.

        Parameters
        ----------
        motion : int
        """
        return float(self.along[min(motion, len(self.along) - 1)] / max(self.along[-1], 1e-12))

    def at(self, share):
        """Where the tool stands in the plane's frame, a FreeCAD.Placement.

        Parameters
        ----------
        share : float
            0 at the start of the first pass, 1 at the end of the last.
        """
        if not len(self.points):
            return FreeCAD.Placement()
        k, part = self._within(share)
        tip = self.points[k - 1] + part * (self.points[k] - self.points[k - 1]) if part < 1 else self.points[k]
        turn = FreeCAD.Rotation()
        if self.axes is not None and len(self.axes) == len(self.points):
            turn = FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), FreeCAD.Vector(*self.axes[k].tolist()))
        return FreeCAD.Placement(FreeCAD.Vector(*tip.tolist()), turn)
