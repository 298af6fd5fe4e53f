"""From plain records to a part: faces with their kinks, edges with their kinds."""

from dataclasses import replace

import numpy as np

from toolaxis.cad.material_side import agreement, faces_to_turn
from toolaxis.cad.shape_data import FaceRecord, ShapeRecord
from toolaxis.shape.adjacency import Border, edges_from_borders, gaps
from toolaxis.shape.face import Face
from toolaxis.shape.joining.edge_matching import match_edges
from toolaxis.shape.kinks import with_kinks
from toolaxis.shape.part import Part
from toolaxis.shape.seams import seam_warnings

WIDE_GAP = 1e-3


def face_from_record(record: FaceRecord) -> Face:
    """The face that a record describes.

    Parameters
    ----------
    record : FaceRecord
    """
    face = Face(record.surface, record.loops, record.flip, record.number, kind=record.kind, tolerance=record.tolerance)
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
    part = Part(faces, (), tuple(record.bodies), source, sha256, record.unit)
    found = match_edges(record.free, part.diagonal) if len(record.free) > 1 else []
    borders = [*record.borders, *found]
    turned = faces_to_turn(faces, borders)
    if turned:
        faces = tuple(face_from_record(replace(item, flip=not item.flip)) if item.number in turned else face
                      for item, face in zip(record.faces, faces, strict=True))
        part = replace(part, faces=faces)
    numbers = {face.number for face in faces}
    warnings = [*record.warnings, *_gap_warning(part, record), *_turned_warning(turned), *_sense_warning(part, borders)]
    if found:
        warnings.append(f"{len(found)} edges were found by position: faces touch there but share no edge in the file")
    edges = edges_from_borders(faces, borders)
    warnings += seam_warnings(edges)
    selected = tuple(number for number in record.selected if number in numbers)
    return replace(part, edges=edges, warnings=tuple(warnings), selected=selected)


def _gap_warning(part: Part, record: ShapeRecord) -> list[str]:
    """One sentence about the widest gap, where an edge lies off its faces by more than a thousandth of the part."""
    widths = gaps(part.faces, record.borders)
    if widths.size and widths.max() <= WIDE_GAP * _rough_size(part.faces):
        return []
    wide = np.flatnonzero(widths > WIDE_GAP * part.diagonal)
    if not wide.size:
        return []
    worst = int(np.argmax(widths))
    a, b = record.borders[worst].faces
    return [f"{len(wide)} edges lie off their faces, worst between faces {a} and {b} by {widths[worst]:.3g} mm: "
            "the geometry is damaged or very inaccurate there"]


def _rough_size(faces: tuple[Face, ...]) -> float:
    """Half the diagonal of the box around all outlines, mm: less than that of the part, which takes longer to find."""
    points = np.concatenate([face.evaluate(face.outline[0]).point for face in faces])
    return float(np.linalg.norm(np.ptp(points, axis=0))) / 2


def _turned_warning(turned: frozenset[int]) -> list[str]:
    """One sentence about faces that were turned over."""
    if not turned:
        return []
    first = min(turned)
    more = f" and {len(turned) - 1} more" if len(turned) > 1 else ""
    return [f"face {first}{more}: the file has the material on the other side than the faces around: turned over, with "
            "the side of the larger area; check that it is the right one"]


def _sense_warning(part: Part, borders: list[Border]) -> list[str]:
    """One sentence where faces that meet have their material on opposite sides."""
    mixed = sorted(pair for pair, length in agreement(part.faces, borders).items() if length < 0)
    if not mixed:
        return []
    a, b = mixed[0]
    return [f"faces {a} and {b}{' and others' if len(mixed) > 1 else ''} meet with their material on opposite sides: "
            "turn one of them over in the CAD system"]
