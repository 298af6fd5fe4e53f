"""What tool, head and table meet of the parts and of what stands beside them, at each operation and between two."""

from dataclasses import dataclass, replace

from freecad.toolaxis.document.inputs import inputs_of
from freecad.toolaxis.services.obstacles import bodies_in

#: Looks between two operations, and how deep two things lie in one another before they meet, mm: the cutter touches
#: what it cuts, and faces are known to a few hundredths.
STEPS, DEPTH = 20, 0.1
#: Motions of the tool that are measured once it is known that they meet something: some from the first to the last.
_MEASURED = 400


@dataclass(frozen=True)
class ShapeCopy:
    """An object of a document as a shape that other threads may read.

    Attributes
    ----------
    name, label : str
        Of the object.
    shape : Part.Shape
        In the document's space.
    """

    name: str
    label: str
    shape: object


@dataclass(frozen=True)
class Collision:
    """What meets, where a machine stands.

    Attributes
    ----------
    text : str
        The sentence.
    member : str
        The body of the machine, or "cutter", "shank" or "holder".
    thing : str
        Name of the object that it meets; empty for another body of the machine.
    body : str
        That body; empty for an object.
    motion : int
        Number of the motion of the passes.
    """

    text: str
    member: str
    thing: str
    body: str
    motion: int


@dataclass(frozen=True)
class CollisionModel:
    """Parts and bodies, as the library knows them, on a machine with the tool of each operation.

    Attributes
    ----------
    mounted : toolaxis.machine.setup.Mounting
        Its tool's length does not count.
    surroundings : tuple of toolaxis.collision.machine_collision.MachineSurroundings
        One for each operation, with its tool.
    names : dict of str to str
        Names of objects by what their faces are called after their numbers.
    near : toolaxis.contact.clearance.surroundings.Surroundings
        The same faces as exact as they are, for the tool, which goes along their borders.
    called : tuple of str
        What each of these faces is called, "3 of Block".
    """

    mounted: object
    surroundings: tuple
    names: dict
    near: object
    called: tuple

    def on_passes(self, row, rotary, tips):
        """Where an operation meets something at all, at rotary angles; None where it does not.

        Parameters
        ----------
        row : int
            Number of the operation, from 0.
        rotary : (m,) array
            rad
        tips : (n, 3) array
            mm, document's space.

        Returns
        -------
        Collision or None
        """
        from toolaxis.collision.machine_collision import nearest_meeting

        found = self._of_tool(row, rotary, tips)
        found = found or nearest_meeting(self._holding(row), rotary, tips, self.surroundings[row])
        return self._collision_texts(found, rotary)

    def machine_on_passes(self, row, rotary, tips):
        """Where a body of the machine meets something on the way over tips; None where none does.

        Parameters
        ----------
        row, rotary, tips
            As for `on_passes`.
        """
        from toolaxis.collision.machine_collision import nearest_meeting

        found = nearest_meeting(self._holding(row), rotary, tips, self.surroundings[row])
        return self._collision_texts(found, rotary)

    def machine_at(self, row, joints):
        """What a body of the machine meets where it stands; None where none does.

        Parameters
        ----------
        row : int
        joints : (3 + m,) array
            mm, rad
        """
        from toolaxis.collision.machine_collision import meeting_on
        from toolaxis.numeric.support_functions import places

        held = self._holding(row)
        found = meeting_on(held, joints[3:], places(joints[None, :3]), self.surroundings[row], with_tool=False)
        return self._collision_texts(found, joints[3:])

    def at(self, row, joints):
        """What meets where a machine stands, with the tool of an operation; None where nothing does.

        Parameters
        ----------
        row : int
        joints : (3 + m,) array
            mm, rad

        Returns
        -------
        Collision or None
        """
        from toolaxis.machine.kinematics import forward

        held = self._holding(row)
        tips, _ = forward(held.machine, joints[None], held.tool_length, held.table_from_part)
        return self._collision_texts(self._of_tool(row, joints[3:], tips), joints[3:]) or self.machine_at(row, joints)

    def _of_tool(self, row, rotary, tips):
        """Where the tool of an operation lies deepest in an object, on the way over tips or at a single one."""
        import numpy as np

        from toolaxis.collision.machine_collision import CollisionPoint

        axes = np.tile(self.mounted.axis_at(rotary), (len(tips), 1))
        _, found = met_by_tool(self.surroundings[row].tool, (tips, axes), self.near, len(tips) == 1)
        deep = [(depth, k, member, face) for k, member, face, depth in found if face >= 0 and depth > DEPTH]
        if not deep:
            return None
        depth, k, member, face = max(deep, key=lambda one: one[0])
        return CollisionPoint(member, f"face {self.called[face]}", -depth, k)

    def _holding(self, row):
        """The machine with the tool of an operation in its spindle."""
        return replace(self.mounted, tool_length=self.surroundings[row].tool.gauge_length)

    def _collision_texts(self, found, rotary):
        from toolaxis.collision.machine_collision import words

        if found is None:
            return None
        _, _, label = found.other.partition(" of ")
        name = self.names.get(label, "")
        known = {body.name for body in self.mounted.machine.bodies}
        if not name and found.other not in known:  # something lies wholly inside; of which object is not told
            name = next(iter(self.names.values()), "")
        text = words(self.mounted, rotary, found, 0.0).removesuffix(self.mounted.at(rotary))
        return Collision(text.replace("the face", "face", 1), found.one, name, found.other if not name else "",
                         found.motion)


def met_by_tool(tool, path, near, still):
    """Where a tool is not clear of faces, and how deep it lies in them at some of these places.

    Parameters
    ----------
    tool : toolaxis.tools.tool.Tool
    path : (tips, axes), each (n, 3) array
        mm; the axes are all the same unless `still`.
    near : toolaxis.contact.clearance.surroundings.Surroundings
    still : bool
        Whether it is looked for at the tips, else on the motions between them.

    Returns
    -------
    bad : (k,) array of int
        Tips, or motions by the tips that they begin at.
    found : list of (int, str, int, float)
        One of these, "cutter", "shank" or "holder", number of the face from 0, -1 for none, and depth, mm.
    """
    import numpy as np

    from toolaxis.contact.clearance.clearance import clearances, clears, segment_clearances, segment_clears
    from toolaxis.tools.solid import COMPONENTS

    tips, axes = path
    judge, measure = (clears, clearances) if still else (segment_clears, segment_clearances)
    bad, found = np.flatnonzero(~judge(tool, tips, axes if still else axes[0], near).safe), []
    for k in bad[np.unique(np.linspace(0, len(bad) - 1, _MEASURED).astype(int))].tolist() if len(bad) else ():
        one = measure(tool, tips[k:k + 1] if still else tips[k:k + 2], axes[k], near)
        which = int(np.argmin(one.distance[0]))
        found.append((k, COMPONENTS[which], int(one.face[0, which]), -float(one.distance[0, which])))
    return bad, found


def copies(operations):
    """What operations machine, what they avoid, and what else is in sight, each once.

    Parameters
    ----------
    operations : sequence of App.DocumentObject
        Of one document; those whose part was deleted have none.

    Returns
    -------
    list of ShapeCopy
    """
    jobs = [inputs_of(operation) for operation in operations]
    return copies_around(operations[0].Document, jobs) if operations else []


def copies_around(document, jobs):
    """What is machined, what is avoided, and what else is in sight in a document, each once.

    Parameters
    ----------
    document : App.Document
    jobs : sequence of freecad.toolaxis.document.inputs.JobInputs

    Returns
    -------
    list of ShapeCopy
    """
    from toolaxis.cad.freecad.documents import name_of, shape_of

    parts = list({thing.Name: thing for job in jobs for thing in job.things}.values())
    avoided = [thing for job in jobs for thing in job.obstacles]
    seen = [body for body in bodies_in(document, parts) if body.Visibility]
    found = {thing.Name: thing for thing in (*parts, *avoided, *seen)}
    return [ShapeCopy(thing.Name, name_of(thing), shape_of(thing).copy()) for thing in found.values()]


def tool_of(operation):
    """The whole tool of an operation.

    Parameters
    ----------
    operation : App.DocumentObject

    Returns
    -------
    toolaxis.tools.tool.Tool
    """
    return inputs_of(operation).assembled()


def read(found, progress):
    """Read copies one after the other; runs in any thread.

    Parameters
    ----------
    found : sequence of ShapeCopy
    progress : toolaxis.progress.Progress

    Yields
    ------
    (str, str, tuple of toolaxis.shape.face.Face)
        What it is called, each otherwise; the object's name; and its faces.
    """
    from toolaxis.cad.freecad.documents import part_from
    from toolaxis.progress import activate_progress

    called = set()
    for k, copy in enumerate(found):
        progress.report("reading the bodies", k, len(found))
        label = copy.label if copy.label not in called else f"{copy.label} ({copy.name})"
        called.add(label)
        with activate_progress(progress):
            faces = tuple(part_from(copy.shape).faces)
        yield label, copy.name, faces


def around(mounted, tools, found, progress):
    """Read copies for a machine; runs in any thread.

    Parameters
    ----------
    mounted : toolaxis.machine.setup.Mounting
        With a place of the part on the table.
    tools : sequence of toolaxis.tools.tool.Tool
        One for each operation.
    found : sequence of ShapeCopy
    progress : toolaxis.progress.Progress

    Returns
    -------
    CollisionModel
    """
    import numpy as np

    from toolaxis.collision.machine_collision import MachineSurroundings
    from toolaxis.contact.clearance.surroundings import Surroundings as Near
    from toolaxis.progress import activate_progress
    from toolaxis.shape.bounding.bounding_tree import forest

    names, cells, every = {}, [], []
    for label, name, faces in read(found, progress):
        names[label] = name
        with activate_progress(progress):
            if faces:
                every += [replace(face, label=f"{face.number} of {label}") for face in faces]
                cells.append(forest(tuple(every[-len(faces):])))
    near = Near(tuple(every), np.full((len(every), 3), -DEPTH))
    return CollisionModel(mounted, tuple(MachineSurroundings(tool, tuple(cells), -DEPTH) for tool in tools), names,
                          near, tuple(face.label for face in every))


def along(known, journey, rows, progress):
    """What meets on the way through stations, at each and `STEPS` times on the way to the next one.

    Parameters
    ----------
    known : CollisionModel
    journey : object
        With `at(way)`, `station(way)` and `legs`, the stations.
    rows : sequence of int
        The operation of each station.
    progress : toolaxis.progress.Progress

    Returns
    -------
    list of Collision or None
        `STEPS` for each way, and one at the end.
    """
    from toolaxis.progress import activate_progress

    count, found = STEPS * (len(journey.legs) - 1) + 1, []
    with activate_progress(progress):
        for k in range(count):
            progress.report("checking for collisions", k, count)
            found.append(known.at(rows[journey.station(k / STEPS)], journey.at(k / STEPS)))
    return found
