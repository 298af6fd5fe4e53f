"""From the protocols of a kernel to plain records: every face once, with its trims, its edges and its bodies."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.cad.kernel_protocol import Box, KernelBody, KernelFace, KernelSurface
from toolaxis.cad.shape_data import FaceRecord, ShapeRecord, left_out
from toolaxis.cad.shared_edges import borders_of
from toolaxis.cad.surfaces import PlainSurface, convert, grid, map_of
from toolaxis.cad.trims import Loops, close_loop, coarse_box, orient_loops, sample_edge
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.progress import breathe
from toolaxis.shape.part import Body
from toolaxis.tolerances import Tolerance

Array = NDArray[np.float64]

ENDLESS = 1e50
NATURAL = 1e-7


#: Open shells that are named one by one.
MANY = 3

#: mm.  A part of 5 m in a unit that is wrong by 1000 is half as large; what is larger is damaged.
FARTHEST = 1e7

#: Chord of loops, mm, that even large faces keep: a face that ends beyond its true border meets the cutter there.
GREATEST_CHORD = 2e-4


class EndlessFace(UnsupportedGeometry):
    """A face of endless extent without trim loops: in a file, one that lost them."""


def record_of_shape(faces: Sequence[KernelFace], bodies: Sequence[KernelBody], tolerance: Tolerance | None = None,
                    numbers: Sequence[int] = (), failures: tuple[type[Exception], ...] = ()) -> ShapeRecord:
    """Everything toolaxis needs of a kernel shape.

    Parameters
    ----------
    faces : sequence of KernelFace
        In the kernel's order.
    bodies : sequence of KernelBody
    tolerance : Tolerance, optional
        Its `trim` is the chord tolerance of loops and edges, as a share of the face's diagonal.
    numbers : sequence of int
        Of the faces; from 1 unless given.
    failures : tuple of exceptions
        What the kernel raises where it fails on a face.

    Raises
    ------
    InvalidInput
        When there are no faces.
    UnsupportedGeometry
        When not one face can be converted.
    """
    if not faces:
        raise InvalidInput("the CAD shape has no faces: give a solid, a shell or a face")
    record = ShapeRecord()
    share = (tolerance or Tolerance()).trim
    numbers = numbers or range(1, len(faces) + 1)
    for number, face in zip(numbers, faces, strict=True):
        breathe()
        try:
            converted, warnings = record_of_face(face, number, share)
        except UnsupportedGeometry as reason:
            record.endless += isinstance(reason, EndlessFace)
            record.warnings.append(left_out(f"face {number}", str(reason)))
        except failures as reason:
            why = f"the CAD kernel fails on it ({type(reason).__name__}): repair the face in the CAD system"
            record.warnings.append(left_out(f"face {number}", why))
        else:
            record.faces.append(converted)
            record.warnings += [f"face {number}: {text}" for text in warnings]
    record.faces.sort(key=lambda face: face.number)
    if not record.faces:
        raise UnsupportedGeometry(f"none of the part's {len(faces)} faces can be used; {record.warnings[0]}")
    _add_bodies(record, [body._replace(faces=tuple(numbers[index - 1] for index in body.faces)) for body in bodies])
    by_number = dict(zip(numbers, faces, strict=True))
    record.borders, record.free = borders_of((item, by_number[item.number]) for item in record.faces)
    return record


def record_of_face(face: KernelFace, number: int = 1, share: float = 1e-5) -> tuple[FaceRecord, list[str]]:
    """One kernel face as plain arrays, and warnings.

    Parameters
    ----------
    face : KernelFace
    number : int
    share : float
        Chord tolerance of the loops as a share of the face's diagonal.

    Raises
    ------
    UnsupportedGeometry
        When the face has no surface (it is only tessellated), is endless, or cannot be approximated.
    """
    surface = face.surface
    if surface is None:
        raise UnsupportedGeometry("it has a mesh but no surface: export the part with exact geometry")
    with np.errstate(all="ignore"):  # What is not finite is told below.
        loops, box = _kernel_loops(face, surface, share)
        plain = convert(surface, box)
        _check_reach(plain)
    low, high = _domain(plain)
    polygons = tuple(_keep_inside(plain.map.to_ours(polygon), low, high) for polygon in loops.polygons)
    if _covers_domain(polygons, low, high):
        polygons = ()
    record = FaceRecord(number, plain.knots_u, plain.knots_v, plain.control, plain.degree, polygons, face.flip,
                        loops.reversed, plain.kind, plain.tolerance, plain.map)
    return record, loops.warnings


def _check_reach(plain: PlainSurface) -> None:
    """That a surface is finite and lies where a part can lie."""
    points = plain.control[..., :3] / plain.control[..., 3:]
    reach = float(np.abs(points).max())
    if not np.isfinite(reach):
        raise UnsupportedGeometry("its geometry is not finite: repair the face in the CAD system")
    if reach > FARTHEST:
        raise UnsupportedGeometry(f"it reaches {reach:.3g} mm from the origin, and no part lies farther than "
                                  f"{FARTHEST:g} mm: repair the face in the CAD system, or check the part's unit")


def _kernel_loops(face: KernelFace, surface: KernelSurface, share: float) -> tuple[Loops, Box]:
    """Loops in the kernel's parameters and the box they need."""
    wires = face.wires
    if not wires:
        box = surface.domain
        if max(abs(value) for value in box) > ENDLESS:
            raise EndlessFace("it has no borders and no end: trim the face in the CAD system")
        u0, u1, v0, v1 = box
        return Loops([np.array([[u0, v0], [u1, v0], [u1, v1], [u0, v1]])]), box
    box = coarse_box(wires)
    if not (box[0] < box[1] and box[2] < box[3]):
        raise UnsupportedGeometry("its trim loops enclose no area: repair the face in the CAD system")
    to_ours, periods = map_of(surface, box).to_ours, surface.periods
    chord = min(share * float(np.linalg.norm(np.ptp(surface.points(grid(box, 7)), axis=0))), GREATEST_CHORD)
    warnings: list[str] = []
    polygons = [close_loop([sample_edge(edge, to_ours, surface.tangents, chord) for edge in wire], periods, warnings)
                for wire in wires]
    loops = orient_loops(polygons, periods, warnings)
    low, high = loops.polygons[0].min(axis=0), loops.polygons[0].max(axis=0)
    return loops, (float(low[0]), float(high[0]), float(low[1]), float(high[1]))


def _domain(plain: PlainSurface) -> tuple[Array, Array]:
    pu, pv = plain.degree
    low = np.array([plain.knots_u[pu], plain.knots_v[pv]])
    return low, np.array([plain.knots_u[-pu - 1], plain.knots_v[-pv - 1]])


def _keep_inside(loop: Array, low: Array, high: Array) -> Array:
    """A loop that strays over the end of its surface, as inaccurate files have it, brought back to the end."""
    if (loop >= low).all() and (loop <= high).all():
        return loop
    inside = np.clip(loop, low, high)
    return np.asarray(inside[(inside != np.roll(inside, 1, axis=0)).any(axis=1)])


def _covers_domain(polygons: tuple[Array, ...], low: Array, high: Array) -> bool:
    """Whether a single loop is just the rectangle of the surface's domain."""
    if len(polygons) != 1 or len(polygons[0]) < 4:
        return False
    place = (polygons[0] - low) / (high - low)
    on_border = (np.minimum(np.abs(place), np.abs(place - 1)) <= NATURAL).any(axis=1)
    corners = (np.minimum(np.abs(place), np.abs(place - 1)) <= NATURAL).all(axis=1)
    return bool(on_border.all() and len(np.unique(np.round(place[corners]), axis=0)) == 4
                and np.ptp(place, axis=0).max() <= 1 + 2 * NATURAL)


def _add_bodies(record: ShapeRecord, bodies: Sequence[KernelBody]) -> None:
    """Bodies as they are, of usable faces; solids that are inside out are turned over."""
    usable = {face.number for face in record.faces}
    shells: list[tuple[int, int]] = []
    for body in bodies:
        own = tuple(number for number in body.faces if number in usable)
        if body.kind == "faces" and not own:
            continue
        record.bodies.append(Body(body.kind, own, body.closed))
        if body.inside_out and own:
            record.warnings.append(f"the solid with face {own[0]} is inside out: its faces were turned over")
            record.faces = [replace(face, flip=not face.flip) if face.number in own else face for face in record.faces]
        if body.kind == "shell" and not body.closed and own:
            shells.append((min(own), max(own)))
    if len(shells) > MANY:
        record.warnings.append(f"{len(shells)} shells are open, among them that with face {shells[0][0]}: which side "
                               "the material is on was taken from the file")
        return
    for first, last in shells:
        which = f"faces {first} to {last} form" if last > first else f"face {first} forms"
        record.warnings.append(f"{which} an open shell: which side the material is on was taken from the file")
