"""A part as a JSON document, and back: the copy beside a plan where the part did not come from a file."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.shape.adjacency import Edge
from toolaxis.shape.face import Face
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.shape.part import Body, Part

Array = NDArray[np.float64]

NAME = "toolaxis.part"
VERSION = 1


def _face_document(face: Face) -> dict[str, Any]:
    surface = face.surface
    return {
        "number": face.number,
        "label": face.label,
        "kind": face.kind,
        "flip": bool(face.flip),
        "tolerance": face.tolerance,
        "degree": list(surface.degree),
        "knots_u": surface.knots_u.tolist(),
        "knots_v": surface.knots_v.tolist(),
        "control": surface.control.tolist(),
        "trims": [loop.tolist() for loop in face.trims],
        "kinks": [list(side) for side in face.kinks]}


def _edge_document(edge: Edge) -> dict[str, Any]:
    return {
        "faces": list(edge.faces),
        "kind": edge.kind,
        "angle": edge.angle,
        "polyline": np.asarray(edge.polyline).tolist(),
        "gap": edge.gap.tolist(),
        "step": edge.step.tolist()}


def _body_document(body: Body) -> dict[str, Any]:
    return {"kind": body.kind, "faces": list(body.faces), "closed": body.closed}


def part_document(part: Part) -> dict[str, Any]:
    """A part as a document that `json.dump` takes; numbers survive exactly.

    Parameters
    ----------
    part : Part

    Returns
    -------
    dict
        Control points are homogeneous (w x, w y, w z, w), mm.
    """
    return {
        "schema": NAME,
        "version": VERSION,
        "unit": "mm",
        "source": part.source,
        "declared_unit": part.unit,
        "warnings": list(part.warnings),
        "selected": list(part.selected),
        "faces": [_face_document(face) for face in part.faces],
        "edges": [_edge_document(edge) for edge in part.edges],
        "bodies": [_body_document(body) for body in part.bodies]}


def _face_from(record: Mapping[str, Any]) -> Face:
    trims = tuple(_floats(loop) for loop in record["trims"])
    kinks_u, kinks_v = record["kinks"][0], record["kinks"][1]
    return Face(
        surface=_surface_from(record),
        trims=trims,
        flip=record["flip"],
        number=record["number"],
        label=record["label"],
        kind=record["kind"],
        tolerance=record["tolerance"],
        kinks=(tuple(kinks_u), tuple(kinks_v)))


def _surface_from(record: Mapping[str, Any]) -> NurbsSurface:
    degree_u, degree_v = record["degree"][0], record["degree"][1]
    return NurbsSurface(
        knots_u=_floats(record["knots_u"]),
        knots_v=_floats(record["knots_v"]),
        control=_floats(record["control"]),
        degree=(degree_u, degree_v))


def _floats(numbers: Any) -> Array:
    return np.array(numbers, dtype=float)


def _edge_from(record: Mapping[str, Any]) -> Edge:
    first, second = record["faces"]
    # A document of an earlier version does not say how far the borders are apart: then nothing is taken off.
    gap = _floats(record.get("gap", ()))
    step = _floats(record.get("step", ())).reshape(-1, 2)
    polyline = _floats(record["polyline"])
    return Edge((first, second), record["kind"], polyline, record["angle"], gap, step)


def part_from(document: Mapping[str, Any], sha256: str = "") -> Part:
    """The part that `part_document` wrote.

    Parameters
    ----------
    document : mapping
    sha256 : str
        Of the file that the document was read from.

    Raises
    ------
    InvalidInput
        When it is no such document, or its numbers make no part.
    """
    if document.get("schema") != NAME or document.get("version") != VERSION:
        raise InvalidInput(f"part document has schema {document.get('schema')!r} version {document.get('version')!r}: "
                           f"{NAME!r} version {VERSION} is needed")
    try:
        faces = tuple(_face_from(record) for record in document["faces"])
        edges = tuple(_edge_from(record) for record in document["edges"])
        bodies = tuple(Body(b["kind"], tuple(b["faces"]), b["closed"]) for b in document["bodies"])
    except (KeyError, TypeError, IndexError) as reason:
        raise InvalidInput(f"part document is incomplete ({reason!r}): make the plan again") from reason
    return Part(faces, edges, bodies, document["source"], sha256, document["declared_unit"],
                tuple(document["warnings"]), tuple(document["selected"]))
