"""From plain records to a part: faces with their kinks, edges with their kinds."""

from dataclasses import replace

import numpy as np

from toolaxis.cad.records import FaceRecord, ShapeRecord
from toolaxis.shape.adjacency import edges_from_borders, gaps
from toolaxis.shape.face import Face
from toolaxis.shape.kinks import with_kinks
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.shape.part import Part

WIDE_GAP = 1e-3


def face_from_record(record: FaceRecord) -> Face:
    """The face that a record describes.

    Parameters
    ----------
    record : FaceRecord
    """
    surface = NurbsSurface(record.knots_u, record.knots_v, record.control, record.degree)
    face = Face(surface, record.loops, record.flip, record.number, kind=record.kind, tolerance=record.tolerance)
    return with_kinks(face)


def part_from_record(record: ShapeRecord, source: str = "", sha256: str = "") -> Part:
    """The part that a record describes.

    Parameters
    ----------
    record : ShapeRecord
    source : str
        What it was made from.
    sha256 : str
        Of the file, if it came from one.
    """
    faces = tuple(face_from_record(item) for item in record.faces)
    part = Part(faces, edges_from_borders(faces, record.borders), tuple(record.bodies), source, sha256, record.unit)
    numbers = {face.number for face in faces}
    warnings = [*record.warnings, *_gap_warning(part, record)]
    selected = tuple(number for number in record.selected if number in numbers)
    return replace(part, warnings=tuple(warnings), selected=selected)


def _gap_warning(part: Part, record: ShapeRecord) -> list[str]:
    """One sentence about the widest gap, where an edge lies off its faces by more than a thousandth of the part."""
    widths = gaps(part.faces, record.borders)
    wide = np.flatnonzero(widths > WIDE_GAP * part.diagonal)
    if not wide.size:
        return []
    worst = int(np.argmax(widths))
    a, b = record.borders[worst].faces
    return [f"{len(wide)} edges lie off their faces, worst between faces {a} and {b} by {widths[worst]:.3g} mm: "
            "the geometry is damaged or very inaccurate there"]
