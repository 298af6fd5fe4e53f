"""Shapes taken out of a document, so that another thread can read them; and which faces a name stands for."""

from dataclasses import dataclass, replace

import FreeCAD
from freecad.toolaxis.document.work_origin import origin_in_document

translate = FreeCAD.Qt.translate

#: Surfaces that are no sculptured ones, as FreeCAD's Part names them.
_PLAIN = ("Plane", "Cylinder", "Cone")


@dataclass(frozen=True)
class ShapesRead:
    """Copies of shapes with their faces to machine.

    Attributes
    ----------
    shapes, obstacles : tuple of Part.Shape
    labels, obstacle_labels : tuple of str
    numbers : tuple of int
        Faces to machine, numbered through all shapes.
    origin : str
        Of the work coordinate systems, in the document's space; empty for the datum.
    datum : tuple of float
        Origin of the first part's own frame, mm; zeros where there is another one.
    """

    shapes: tuple
    labels: tuple
    numbers: tuple
    origin: str
    datum: tuple
    obstacles: tuple
    obstacle_labels: tuple

    @classmethod
    def of(cls, inputs):
        """Copy what a job needs.

        Parameters
        ----------
        inputs : freecad.toolaxis.document.inputs.JobInputs

        Raises
        ------
        InvalidInput
            When nothing is selected, or a face is not there.
        """
        from toolaxis.cad.freecad.documents import name_of, shape_of
        from toolaxis.errors import InvalidInput

        things = inputs.things
        if not things:
            raise InvalidInput("nothing is selected: select one or more faces, or a body")
        shapes = [shape_of(thing) for thing in things]
        known = {(thing.Document.Name, thing.Name) for thing in things}
        avoided = [thing for thing in inputs.obstacles if (thing.Document.Name, thing.Name) not in known]
        numbers = tuple(numbered(inputs, shapes))
        origin = origin_in_document(inputs.origin, shapes)
        return cls(tuple(shape.copy() for shape in shapes), tuple(map(name_of, things)), numbers, origin,
                   (0.0, 0.0, 0.0) if origin else tuple(shapes[0].Placement.Base),
                   tuple(shape_of(thing).copy() for thing in avoided), tuple(map(name_of, avoided)))

    def division(self, inputs):
        """Sub-surfaces that are kept as they are, as the library takes them.

        Parameters
        ----------
        inputs : freecad.toolaxis.document.inputs.JobInputs
        """
        from toolaxis.plan.sub_surface import SubSurface

        of = {(thing.Name, name): number for number, (thing, name, _) in zip(
            self.numbers, numbered(inputs, self.shapes).values(), strict=True)}
        return tuple(SubSurface(of[piece.thing.Name, piece.name], piece.region, piece.axis, piece.feed, piece.locked,
                                f"{of[piece.thing.Name, piece.name]}{piece.suffix}") for piece in inputs.pieces)

    def complete(self, part):
        """Whether all sculptured faces of one object are chosen, and no others.

        Parameters
        ----------
        part : toolaxis.shape.part.Part
            What was read.
        """
        return len(self.shapes) == 1 and set(self.numbers) == {face.number for face in part.sculptured}

    def prepared(self, inputs, progress):
        """The same as `read`, with faces to avoid, held side and allowances as a job asks for them.

        Parameters
        ----------
        inputs : toolaxis.plan.plan.PlanInputs
        progress : toolaxis.progress.Progress
        """
        part, bodies = self.read(progress)
        return inputs.prepare_part(part), bodies

    def read(self, progress):
        """The part and the bodies to avoid, as the library knows them.

        Parameters
        ----------
        progress : toolaxis.progress.Progress
        """
        from toolaxis.cad.freecad.documents import part_from
        from toolaxis.progress import activate_progress

        progress.report("reading the part", 0, 1)
        whole = self.shapes[0] if len(self.shapes) == 1 else list(self.shapes)
        with activate_progress(progress):
            part = replace(part_from(whole), source=", ".join(self.labels))
            bodies = tuple(replace(part_from(shape), source=label)
                           for shape, label in zip(self.obstacles, self.obstacle_labels, strict=True))
        return part, bodies


def numbered(inputs, shapes):
    """The chosen faces by their numbers, counted through the shapes of all parts.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs
    shapes : sequence of Part.Shape
        One for each of `inputs.things`.

    Returns
    -------
    dict of int to (object, str, int)
        Object, name of the face, and its number in the object alone.
    """
    first, before = {}, 0
    for thing, shape in zip(inputs.things, shapes, strict=True):
        first[thing.Document.Name, thing.Name] = before, shape
        before += len(shape.Faces)
    found = {}
    for thing, name in inputs.faces:
        offset, shape = first[thing.Document.Name, thing.Name]
        number = number_in(thing, shape, name)
        found.setdefault(offset + number, (thing, name, number))
    return found


def every_face(things, shapes):
    """All faces of some parts by their numbers, counted through all of them; as `numbered` gives those chosen.

    Parameters
    ----------
    things : sequence of App.DocumentObject
    shapes : sequence of Part.Shape
        One for each of them.
    """
    rows = [(thing, f"Face{k}", k) for thing, shape in zip(things, shapes, strict=True)
            for k in range(1, len(shape.Faces) + 1)]
    return dict(enumerate(rows, 1))


def titles_of(inputs):
    """What the chosen faces are called, by their numbers, counted through all parts; in the order of planning.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs

    Returns
    -------
    dict of int to str
        "Face 7" in FreeCAD's language; with the part before it where there are several.
    """
    from toolaxis.cad.freecad.documents import shape_of

    found = numbered(inputs, [shape_of(thing) for thing in inputs.things])
    several, title = len(inputs.things) > 1, translate("ToolAxis", "Face {}")
    return {number: f"{thing.Label}: {title.format(own)}" if several else title.format(own)
            for number, (thing, _, own) in found.items()}


def faces_by_number(inputs):
    """All faces of the parts by their numbers, counted through all of them; the chosen ones by the names they have.

    Parameters
    ----------
    inputs : freecad.toolaxis.document.inputs.JobInputs

    Returns
    -------
    dict of int to (object, "Face7")
    """
    from toolaxis.cad.freecad.documents import shape_of

    shapes = [shape_of(thing) for thing in inputs.things]
    found = every_face(inputs.things, shapes) | numbered(inputs, shapes)
    return {number: (thing, name) for number, (thing, name, _) in found.items()}


def number_in(thing, shape, name):
    """The number of a face in the shape of an object.

    Parameters
    ----------
    thing : App.DocumentObject
    shape : Part.Shape
        Of the object, in the document's space.
    name : str
        "Face7"; in a container or array "Box.Face7".

    Raises
    ------
    InvalidInput
        When it names no face of the object.
    """
    import Part

    from toolaxis.cad.freecad.documents import container_placement
    from toolaxis.errors import InvalidInput

    digits = name.removeprefix("Face")
    count = shape.countElement("Face")
    if name.startswith("Face") and digits.isdigit() and 1 <= int(digits) <= count:
        return int(digits)
    if "." in name:
        found = Part.getShape(thing, name, needSubElement=True)
        if not found.isNull() and found.ShapeType == "Face":
            centre = container_placement(thing).multVec(found.CenterOfMass)
            near = [(other.CenterOfMass.distanceToPoint(centre), k) for k, other in enumerate(shape.Faces, 1)
                    if other.isPartner(found)]
            if near:
                return min(near)[1]
    kind = "an edge" if "Edge" in name else "a vertex" if "Vertex" in name else "no face"
    raise InvalidInput(f"{name} of {thing.Label} is {kind}: select one of Face1 to Face{count}")


def sculptured(thing):
    """Names of the faces of an object that are no planes, cylinders or cones.

    Parameters
    ----------
    thing : App.DocumentObject

    Raises
    ------
    InvalidInput
        When it has no faces, or none of that kind.
    """
    from toolaxis.cad.freecad.documents import shape_of
    from toolaxis.errors import InvalidInput

    faces = enumerate(shape_of(thing).Faces, 1)
    found = [f"Face{number}" for number, face in faces if _kind(face) not in _PLAIN]
    if not found:
        raise InvalidInput(f"{thing.Label} has planes, cylinders and cones only: select the faces to machine one by "
                           "one")
    return found


def _kind(face):
    try:
        return type(face.Surface).__name__
    except Exception:  # a kind of surface that FreeCAD's Python does not know is none of the plain ones
        return ""
