"""Sub-surfaces changed by hand: put together, cut apart or drawn anew, as inputs to plan with."""

from dataclasses import replace

from freecad.toolaxis.document.inputs import KeptSubSurface, inputs_of, own_piece
from freecad.toolaxis.document.kinds import is_operation, operations_in, plan_of
from freecad.toolaxis.document.read_shapes import ShapesRead

#: Points along each edge of a line that was drawn.
_POINTS = 24


def _refusal(text):
    from toolaxis.errors import InvalidInput

    return InvalidInput(text)


class DividedFace:
    """The sub-surfaces of one face as they stand in the tree.

    Parameters
    ----------
    operations : sequence of App.DocumentObject
        One or more of one face; all others of that face belong to it too.

    Raises
    ------
    InvalidInput
        When they are none, of different faces, or their part was deleted.
    """

    def __init__(self, operations):
        from toolaxis.progress import NO_PROGRESS

        if not operations or not all(map(is_operation, operations)):
            raise _refusal("no sub-surface is chosen: choose operations of one face in the tree")
        faces = {_face_of(one) for one in operations}
        if len(faces) > 1 or None in faces:
            raise _refusal("the chosen operations are of different faces, or their part was deleted: choose "
                           "sub-surfaces of one face")
        self.chosen = list(operations)
        self.plan = plan_of(operations[0])
        if self.plan is None and len(operations) > 1:
            raise _refusal("the chosen operations belong to no plan: plan their face again, divided")
        self.owner = self.plan if self.plan is not None else operations[0]
        every = [operations[0]] if self.plan is None else operations_in(self.plan)
        self.rows = [one for one in every if _face_of(one) == _face_of(operations[0])]
        thing, name = _face(operations[0])
        self.face = thing, name
        source = ShapesRead.of(replace(inputs_of(operations[0]), faces=((thing, name),), obstacles=(), pieces=()))
        part, _ = source.read(NO_PROGRESS)
        self.whole = part.face(source.numbers[0])
        self.pieces = [own_piece(one, [self.face]) or KeptSubSurface(thing, name) for one in self.rows]

    def surface(self, operation):
        """The sub-surface of an operation as a face.

        Parameters
        ----------
        operation : App.DocumentObject
        """
        piece = self.pieces[self.rows.index(operation)]
        label = f"{self.whole.number}{piece.suffix}"
        return self.whole.trimmed(piece.region or self.whole.trims, label)

    def inputs(self, drawn, kept):
        """The inputs to plan with.

        Parameters
        ----------
        drawn : sequence of loops
            Borders of new sub-surfaces.
        kept : sequence of KeptSubSurface
            What stays of this face.
        """
        from toolaxis.shape.kinks import letters

        thing, name = self.face
        used = {piece.suffix for piece in kept}
        free = (letters(k) for k in range(10**6) if letters(k) not in used)
        alone = len(drawn) + len(kept) == 1
        new = [KeptSubSurface(thing, name, tuple(tuple(map(tuple, loop.tolist())) for loop in loops),
                              suffix="" if alone else next(free), drawn=True) for loops in drawn]
        stay = [replace(piece, suffix=piece.suffix or next(free), drawn=True) for piece in kept]
        own = inputs_of(self.owner)
        others = [piece for piece in own.pieces if (piece.thing.Name, piece.name) != (thing.Name, name)]
        ordered = sorted([*stay, *new], key=lambda piece: (len(piece.suffix), piece.suffix))
        return replace(own, pieces=(*others, *ordered))

    def rest(self, gone):
        """The pieces of this face but for those of some operations.

        Parameters
        ----------
        gone : sequence of App.DocumentObject
        """
        return [piece for piece, one in zip(self.pieces, self.rows, strict=True) if one not in gone]


def _face(operation):
    return next(((thing, name) for thing, names in operation.Faces for name in names if name), None)


def _face_of(operation):
    found = _face(operation)
    return None if found is None else (found[0].Name, found[1])


def merged(operations):
    """What is planned, and the inputs for it, when sub-surfaces are put together.

    Parameters
    ----------
    operations : sequence of App.DocumentObject
        Two or more of one face.

    Returns
    -------
    owner : App.DocumentObject
        The plan that takes the new one's place.
    inputs : freecad.toolaxis.document.inputs.JobInputs

    Raises
    ------
    InvalidInput
        When they do not touch, or are not of one face.
    """
    from toolaxis.partition.manual_edit import merge_sub_surfaces as together

    division = DividedFace(operations)
    loops = together([division.surface(one) for one in operations])
    return division.owner, division.inputs([loops], division.rest(operations))


def split(operation, line=None, parameter="", at=None):
    """What is planned, and the inputs for it, when a sub-surface is cut apart.

    Parameters
    ----------
    operation : App.DocumentObject
    line : App.DocumentObject, optional
        With edges, a drawn line on or above the face; a closed one cuts a new sub-surface out of all that it meets.
    parameter, at : str, float, optional
        Without a line: the parameter that is constant on the cut, and its value; the middle of the longer one unless
        given.

    Returns
    -------
    owner : App.DocumentObject
    inputs : freecad.toolaxis.document.inputs.JobInputs

    Raises
    ------
    InvalidInput
        When the line does not cut it.
    """
    from toolaxis.partition.manual_edit import cut_along, cut_out, halves

    division = DividedFace([operation])
    if line is None:
        found = halves(division.surface(operation), parameter, at)
        return division.owner, division.inputs(found, division.rest([operation]))
    corners, closed = drawn(line, division.whole)
    if not closed:
        found = cut_along(division.surface(operation), corners)
        return division.owner, division.inputs(found, division.rest([operation]))
    own, stay = cut_out([division.surface(one) for one in division.rows], corners)
    kept = [one for one, rest in zip(division.rows, stay, strict=True)
            if len(rest) == 1 and _same(division.surface(one), rest[0])]
    cut = [loops for one, rest in zip(division.rows, stay, strict=True) if one not in kept for loops in rest]
    gone = [one for one in division.rows if one not in kept]
    return division.owner, division.inputs([own, *cut], division.rest(gone))


def _same(surface, loops):
    return abs(surface.trimmed(loops).area - surface.area) <= 1e-9 * surface.area


def drawn(line, face):
    """Corners of a drawn line in a face's parameters, and whether it is closed.

    Parameters
    ----------
    line : App.DocumentObject
        With edges: a wire, a sketch, a curve.
    face : toolaxis.shape.face.Face

    Raises
    ------
    InvalidInput
        When it has no single line of edges, or lies far off the face.
    """
    import numpy as np
    import Part

    from toolaxis.cad.freecad.documents import container_placement
    from toolaxis.shape.nearest import nearest

    shape = Part.getShape(line)
    if shape.isNull() or not shape.Edges:
        raise _refusal(f"{line.Label} has no edges: draw a line on the face, and choose that")
    chains = Part.sortEdges(shape.Edges)
    if len(chains) > 1:
        raise _refusal(f"{line.Label} has {len(chains)} separate lines: draw one")
    wire = Part.Wire(chains[0])
    place = container_placement(line)
    points = []
    for edge in wire.OrderedEdges:
        count = 2 if type(edge.Curve).__name__ in ("Line", "LineSegment") else _POINTS
        own = edge.discretize(count)
        points += own if edge.Orientation == "Forward" else own[::-1]
    rows = np.array([tuple(place.multVec(point)) for point in points])
    keep = np.concatenate([[True], np.linalg.norm(np.diff(rows, axis=0), axis=1) > 1e-9])
    rows = rows[keep]
    found = nearest(face, rows)
    if float(np.min(found.distance)) > face.diagonal:
        raise _refusal(f"{line.Label} lies far off the face: draw it on the face, or above it")
    uv = np.asarray(found.uv)
    return (uv[:-1] if wire.isClosed() else uv), wire.isClosed()
