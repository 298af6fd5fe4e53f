"""Patches in rows and columns: where each lies and how it is turned when several are to be one surface."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import UnsupportedGeometry
from toolaxis.shape.face import Face
from toolaxis.shape.joining.shared_boundary import SharedBoundary

Array = NDArray[np.float64]
Cell = tuple[int, int]


@dataclass(frozen=True, eq=False)
class Grid:
    """Faces in rows and columns.

    Attributes
    ----------
    faces : dict of (int, int) to Face
        By column (along the joined u) and row (along the joined v), both from 0.
    turns : dict of (int, int) to (2, 2) array
        Directions in the joined parameters from those in the face's own: ones, with their signs, and zeros.
    meetings : dict of ((int, int), int) to Meeting
        By a cell and the direction (0 for u, 1 for v) in which the second face lies beside it.
    shape : (int, int)
        Columns and rows.
    """

    faces: dict[Cell, Face]
    turns: dict[Cell, Array]
    meetings: dict[tuple[Cell, int], SharedBoundary]
    shape: tuple[int, int]


def arrange_patches(faces: Sequence[Face], meetings: Sequence[SharedBoundary]) -> Grid:
    """Lay faces side by side, the first one as it is.

    Parameters
    ----------
    faces : sequence of Face
    meetings : sequence of SharedBoundary
        Between them.

    Returns
    -------
    Grid
        Where a row closes to a ring, its two ends stay apart.

    Raises
    ------
    UnsupportedGeometry
        When they do not hang together, do not fill a rectangle of rows and columns, meet in threes at a corner, or have
        their material on opposite sides.

    **Properties**: 1. the order of the faces after the first one does not change how they lie.
    """
    name = f"faces {', '.join(face.label for face in faces)}"
    turns, cells = _walk_faces(faces[0], meetings)
    apart = [face.label for face in faces if face.number not in cells]
    if apart:
        raise UnsupportedGeometry(f"{name} cannot be joined: face {apart[0]} does not continue any of the others "
                                  "smoothly along a common edge")
    by_cell = {cell: number for number, cell in cells.items()}
    columns, rows = (1 + max(cell[axis] for cell in by_cell) for axis in (0, 1))
    if len(by_cell) < len(cells) or columns * rows != len(cells):
        raise UnsupportedGeometry(f"{name} cannot be joined: {len(cells)} patches do not lie in full rows and columns; "
                                  "join those of a row or of a rectangle")
    of = {face.number: face for face in faces}
    beside: dict[tuple[Cell, int], SharedBoundary] = {}
    for meeting in meetings:
        for one in (meeting, meeting.turned()):
            cell, other = (cells[number] for number in one.faces)
            way = turns[one.faces[0]] @ one.sides[0].outward
            if way.sum() > 0 and not _beside(one, cell, other, turns, (columns, rows), beside):
                raise UnsupportedGeometry(f"{name} cannot be joined: faces {of[one.faces[0]].label} and "
                                          f"{of[one.faces[1]].label} meet, but not as neighbours in rows and columns "
                                          "(three or five patches around a corner, or a twisted ring)")
    missing = next(((cell, axis) for cell in by_cell for axis in (0, 1)
                    if _next(cell, axis) in by_cell and (cell, axis) not in beside), None)
    if missing:
        a, b = of[by_cell[missing[0]]], of[by_cell[_next(*missing)]]
        raise UnsupportedGeometry(f"{name} cannot be joined: faces {a.label} and {b.label} lie beside each other but "
                                  "do not continue each other smoothly along a common edge")
    _check_senses(faces, turns, name)
    return Grid({cell: of[n] for cell, n in by_cell.items()}, {cell: turns[n] for cell, n in by_cell.items()},
                beside, (columns, rows))


def _next(cell: Cell, axis: int) -> Cell:
    return (cell[0] + (axis == 0), cell[1] + (axis == 1))


def arrange_from(face: Face, meetings: Sequence[SharedBoundary]) -> dict[int, Cell]:
    """Cells of a face and of all that hang together with it, by number; several may have the same.

    Parameters
    ----------
    face : Face
    meetings : sequence of SharedBoundary
    """
    return _walk_faces(face, meetings)[1]


def _walk_faces(face: Face, meetings: Sequence[SharedBoundary]) -> tuple[dict[int, Array], dict[int, Cell]]:
    """Turns and cells of the faces that hang together with one, by number."""
    turns, places = {face.number: np.eye(2)}, {face.number: np.zeros(2)}
    front = [face.number]
    while front:
        here = front.pop(0)
        for meeting in meetings:
            if here not in meeting.faces:
                continue
            one = meeting if meeting.faces[0] == here else meeting.turned()
            there = one.faces[1]
            if there not in turns:
                turns[there] = _turn(one, turns[here])
                places[there] = places[here] + turns[here] @ one.sides[0].outward
                front.append(there)
    low = np.min(list(places.values()), axis=0)
    cells = {number: (int(x), int(y)) for number, (x, y) in ((n, p - low) for n, p in places.items())}
    return turns, cells


def _turn(meeting: SharedBoundary, turn: Array) -> Array:
    """The turn of the second face from that of the first."""
    one, other = meeting.sides
    found = np.zeros((2, 2))
    found[:, other.axis] = -(turn @ one.outward) * (1.0 if other.end else -1.0)
    found[:, 1 - other.axis] = turn[:, 1 - one.axis] * np.sign(meeting.slope)
    return found


def _beside(meeting: SharedBoundary, cell: Cell, other: Cell, turns: dict[int, Array], shape: tuple[int, int],
            found: dict[tuple[Cell, int], SharedBoundary]) -> bool:
    """Whether a meeting whose second face lies in an increasing direction fits the layout; noted if so."""
    a, b = meeting.faces
    axis = int((turns[a] @ meeting.sides[0].outward)[1] > 0.5)
    if not np.array_equal(_turn(meeting, turns[a]), turns[b]):
        return False
    if other == _next(cell, axis):
        found[cell, axis] = meeting
        return True
    closing = cell[axis] == shape[axis] - 1 and other[axis] == 0
    return closing and cell[1 - axis] == other[1 - axis]


def _check_senses(faces: Sequence[Face], turns: dict[int, Array], name: str) -> None:
    first = faces[0].flip
    for face in faces:
        mirrored = bool(np.linalg.det(turns[face.number]) < 0)
        if face.flip ^ mirrored != first:
            raise UnsupportedGeometry(f"{name} cannot be joined: faces {faces[0].label} and {face.label} have their "
                                      "material on opposite sides: turn one of them over in the CAD system")
