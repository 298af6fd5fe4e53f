"""What cutter, shank and holder of one operation meet of parts and of what stands beside them, motion by motion."""

from dataclasses import dataclass

from freecad.toolaxis.services import collisions


@dataclass(frozen=True)
class PathCollision:
    """Motions one after the other on which the same part of the tool meets the same face.

    Attributes
    ----------
    first, last : int
        Numbers of the motions; motion k ends at point k of the path.
    text : str
        The sentence, with the greatest depth on these motions.
    member : str
        What meets it: "cutter", "shank", "holder" or a body of the machine.
    thing : str
        Name of the object that is met; empty where it is none of the document.
    body : str
        The body of the machine that is met; empty for an object.
    """

    first: int
    last: int
    text: str
    member: str = ""
    thing: str = ""
    body: str = ""


@dataclass(frozen=True)
class PathCollisions:
    """All of an operation.

    Attributes
    ----------
    found : tuple of PathCollision
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
    tool : toolaxis.tools.tool.Tool
    path : toolaxis.cldata.toolpath.ToolPath
        In the document's space.
    found : sequence of freecad.toolaxis.services.collisions.ShapeCopy
    progress : toolaxis.progress.Progress

    Returns
    -------
    PathCollisions
        The tool touches what it cuts: only what lies deeper than `collisions.DEPTH` counts.  Where the
        axis moves it is looked for at the points of the path, else on all of the way between them.
    """
    return bumps_among(tool, path, FacesRead.of(found, progress), progress)


@dataclass(frozen=True)
class FacesRead:
    """Faces of copies of objects, read once for many paths.

    Attributes
    ----------
    around : toolaxis.contact.clearance.surroundings.Surroundings
    names, things : tuple of str
        What each face is called, and the name of its object.
    """

    around: object
    names: tuple
    things: tuple

    @classmethod
    def of(cls, found, progress):
        """Read copies; runs in any thread.

        Parameters
        ----------
        found : sequence of freecad.toolaxis.services.collisions.ShapeCopy
        progress : toolaxis.progress.Progress
        """
        import numpy as np

        from toolaxis.contact.clearance.surroundings import Surroundings

        names, things, faces = [], [], []
        for label, name, some in collisions.read(found, progress):
            names += [f"face {face.number} of {label}" for face in some]
            things += [name] * len(some)
            faces += some
        return cls(Surroundings(tuple(faces), np.full((len(faces), 3), -collisions.DEPTH)), tuple(names), tuple(things))

    @classmethod
    def again(cls, known):
        """The faces that were read for a machine already.

        Parameters
        ----------
        known : freecad.toolaxis.services.collisions.CollisionModel
        """
        things = tuple(known.names[label.partition(" of ")[2]] for label in known.called)
        return cls(known.near, tuple(f"face {label}" for label in known.called), things)


def bumps_among(tool, path, read, progress):
    """Where a tool meets faces that were read, as for `bumps`.

    Parameters
    ----------
    tool : toolaxis.tools.tool.Tool
    path : toolaxis.cldata.toolpath.ToolPath
    read : FacesRead
    progress : toolaxis.progress.Progress
    """
    import numpy as np

    from toolaxis.progress import activate_progress

    moves = bool(np.ptp(path.axis, axis=0).max(initial=0.0) > 1e-9)
    progress.report("checking for collisions", 0, 1)
    with activate_progress(progress):
        bad, some = collisions.met_by_tool(tool, (path.cl, path.axis), read.around, moves)
    end = 0 if moves else 1  # motion k leads from point k - 1 to point k
    checked = ("cutter", *(name for name in ("shank", "holder") if name in tool.outlines))
    known = {k + end: rest for k, *rest in some}
    return PathCollisions(_join_motions(known, (bad + end).tolist(), read), checked)


def _join_motions(at, bad, read):
    """Bumps of motions one after the other that say the same; motions that were not measured go with the one before."""
    made, known = [], None
    for motion in bad:
        known = at.get(motion, known)
        member, face, depth = known
        if depth < collisions.DEPTH or face < 0:
            continue
        last = made[-1] if made else None
        if last is not None and last["key"] == (member, face) and last["last"] == motion - 1:
            last["last"], last["depth"] = motion, max(last["depth"], depth)
        else:
            made.append({"key": (member, face), "first": motion, "last": motion, "depth": depth})
    return tuple(PathCollision(one["first"], one["last"],
                               f"the {one['key'][0]} collides with {read.names[one['key'][1]]} by "
                               f"{one['depth']:.1f} mm",
                               one["key"][0], read.things[one["key"][1]])
                 for one in made)
