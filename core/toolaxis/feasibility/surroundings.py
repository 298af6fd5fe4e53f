"""What stands around a face: its skin, the faces that meet it harmlessly, and what is in the way."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toolaxis.errors import InvalidInput
from toolaxis.shape.allowances import SAME
from toolaxis.shape.bounding.bounding_tree import BoundingTree, forest
from toolaxis.shape.face import Face
from toolaxis.shape.half_space import HELD_SIDE, HalfSpace
from toolaxis.shape.part import Part
from toolaxis.shape.seams import Mismatch, mismatch_of
from toolaxis.tolerances import Tolerance

Array = NDArray[np.float64]
Obstacles: TypeAlias = Part | Face | Sequence[Face] | None

ROLES = SKIN, TOUCHING, OTHER = "skin", "touching", "other"
#: What the search keeps to itself of each clearance, mm, so that motions between its contacts pass the proof.
MARGIN = 0.01


@dataclass(frozen=True, eq=False)
class CheckSurfaces:
    """Faces that the tool has to keep the same distances from.

    Attributes
    ----------
    role : str
        "skin": machined; "touching": meets the machined skin at a convex edge; "other": walls and obstacles.
    faces : tuple of Face
    required : (3,) array
        Least signed distance of cutter, shank and holder, mm.
    mismatch : Mismatch or None
        By how much the faces stand out over others that the cutter touches: no depth of the cutter's.
    held : HalfSpace or None
        The side that is held, whose plane is one of the faces: no tip may lie in it, as the plane alone does not tell.
    stock : float
        How far stock stands above the faces, mm: shank and holder keep their required distance with it.
    rapid : float
        Least distance of the cutter on links at rapid traverse, which cut no stock, mm; -inf without stock.
    allowance : float
        What is left on the faces on purpose where they have an allowance of their own, mm: all distances are to that.
    """

    role: str
    faces: tuple[Face, ...]
    required: Array
    mismatch: Mismatch | None = None
    held: HalfSpace | None = None
    stock: float = 0.0
    rapid: float = -np.inf
    allowance: float = 0.0

    @property
    def required_on_links(self) -> Array:
        """Least signed distance of cutter, shank and holder at rapid traverse, (3,) mm."""
        return np.array([max(self.required[0], self.rapid), *self.required[1:]])

    @cached_property
    def cells(self) -> BoundingTree:
        """The faces' cells under one root."""
        return forest(self.faces).missing(self.mismatch)

    @cached_property
    def box(self) -> Array:
        """Corners of the box around the faces, (2, 3) mm, of the plane of a held side only its middle: a tool that is
        drawn back comes no nearer to it."""
        boxes = np.array([face.box if face.label != HELD_SIDE else np.tile(face.box.mean(axis=0), (2, 1))
                          for face in self.faces])
        return np.stack([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])


def group_surroundings(face: Face, tolerance: Tolerance, allowance: float = 0.0, *, part: Part | None = None,
                       skin: Sequence[Face] = (), surroundings: Sequence[Face] = (),
                       obstacles: Obstacles = None) -> tuple[CheckSurfaces, ...]:
    """Everything around a face, sorted by what the tool has to keep from it.

    Parameters
    ----------
    face : Face
        The face, or a piece of one.
    tolerance : Tolerance
    allowance : float
        Stock left on the skin, mm.
    part : Part, optional
        The part that the face belongs to by its number: gives skin and surroundings with their edges.
    skin : sequence of Face
        Faces that continue the face tangentially, where there is no part.
    surroundings : sequence of Face
        Other faces that stand around; all count as walls.
    obstacles : Part, Face or sequence of Face, optional

    Returns
    -------
    tuple of CheckSurfaces, the skin first; empty groups are left out.

    Notes
    -----
    Faces that carry the part's stock make groups of their own; a skin of which one face carries stock counts as
    carrying it everywhere.

    Where faces of the part have allowances of their own, those on which more is left than on the face are walls,
    however they meet it, and all distances are to what is left.

    Raises
    ------
    InvalidInput
        When obstacles are not faces.
    """
    touching: tuple[Face, ...] = ()
    walls: tuple[Face, ...] = ()
    others: list[Face] = [*surroundings, *faces_of(obstacles)]
    own = (face, *(f for f in skin if f is not face))
    if part is not None:
        own = (*part.skin(face.number), *own[1:])
        numbers = _harmless(part, face.number)
        around = part.surroundings(face.number)
        touching = tuple(f for f in around if f.number in numbers)
        walls = tuple(f for f in around if f.number not in numbers)
        others = [*part.faces_of_held_side, *others]
    own, touching, walls, further = (tuple(one for whole in some for one in whole.own_faces)
                                     for some in (own, touching, walls, others))
    if part is not None and part.allowances is not None:
        most = max(allowance, part.allowance_on(face))
        own, higher = _by_allowance(own, part, most)
        touching, highest = _by_allowance(touching, part, most)
        walls = (*walls, *higher, *highest)
    edges = () if part is None else (part.original or part).edges
    touched = {one.number for one in own}
    (bare, rough), (finished, proud) = _by_stock(touching, part), _by_stock(walls, part)
    height = 0.0 if part is None else max(map(part.stock_on, own))
    full = 0.0 if part is None or part.stock is None else part.stock.height
    groups = [_group(SKIN, own, (allowance - tolerance.gouge, height), tolerance, mismatch_of(own, edges, touched,
                                                                                              allowance))]
    for some, stock in ((bare, 0.0), (rough, full)):
        for left, faces in _with_allowances(some, part).items():
            off = mismatch_of(faces, edges, touched)
            groups.append(_group(TOUCHING, faces, (left - tolerance.gouge, stock), tolerance, off, left))
    bare_walls = _with_allowances(finished, part)
    bare_walls[0.0] = (*bare_walls.get(0.0, ()), *further)
    for kept, stock in ((bare_walls, 0.0), (_with_allowances(proud, part), full)):
        for left, faces in kept.items():
            groups.append(_group(OTHER, faces, (left + tolerance.cutter_clearance, stock), tolerance, left=left))
    if part is not None and part.held is not None:
        groups = [replace(group, held=part.held) if group.role == OTHER and group.stock == group.allowance == 0.0
                  else group for group in groups]
    return tuple(group for group in groups if group.faces)


def _by_allowance(faces: tuple[Face, ...], part: Part, most: float) -> tuple[tuple[Face, ...], tuple[Face, ...]]:
    """Faces of a part on which no more than so much is left, mm, and the others."""
    higher = [part.allowance_on(face) > most + SAME for face in faces]
    return (tuple(face for face, more in zip(faces, higher, strict=True) if not more),
            tuple(face for face, more in zip(faces, higher, strict=True) if more))


def _with_allowances(faces: tuple[Face, ...], part: Part | None) -> dict[float, tuple[Face, ...]]:
    """Faces by what is left on them where they have allowances of their own, mm."""
    if part is None or part.allowances is None:
        return {0.0: faces}
    left = [part.allowance_on(face) for face in faces]
    return {value: tuple(face for face, own in zip(faces, left, strict=True) if own == value)
            for value in sorted(set(left))}


def _by_stock(faces: tuple[Face, ...], part: Part | None) -> tuple[tuple[Face, ...], tuple[Face, ...]]:
    """Faces of a part that are finished, and those that carry stock."""
    carries = [part is not None and part.stock_on(face) > 0 for face in faces]
    return (tuple(face for face, proud in zip(faces, carries, strict=True) if not proud),
            tuple(face for face, proud in zip(faces, carries, strict=True) if proud))


def _group(role: str, faces: tuple[Face, ...], keeps: tuple[float, float], tolerance: Tolerance,
           mismatch: Mismatch | None = None, left: float = 0.0) -> CheckSurfaces:
    """Faces with the cutter's least distance, the stock on them, and what is left of that on purpose, mm."""
    cutter, stock = keeps
    above = max(stock, left)
    required = np.array([cutter, above + tolerance.shank_clearance, above + tolerance.holder_clearance])
    rapid = stock + tolerance.cutter_clearance + MARGIN if stock > 0 else -np.inf
    return CheckSurfaces(role, faces, required, mismatch, stock=stock, rapid=rapid, allowance=left)


def faces_of(obstacles: Obstacles) -> tuple[Face, ...]:
    """The faces of obstacles.

    Parameters
    ----------
    obstacles : Part, Face or sequence of Face, optional

    Raises
    ------
    InvalidInput
        When obstacles are not faces.
    """
    if obstacles is None:
        return ()
    if isinstance(obstacles, Face):
        return (obstacles,)
    if isinstance(obstacles, Part):
        return obstacles.faces
    if isinstance(obstacles, Iterable):
        rows = tuple(obstacles)
        if all(isinstance(row, Face) for row in rows):
            return rows
    raise InvalidInput(f"obstacles are {type(obstacles).__name__}: give a part, a face or a sequence of faces "
                       "(toolaxis.load reads them from a file)")


def _harmless(part: Part, number: int) -> set[int]:
    """Numbers of the faces that meet the skin of a face at convex edges or at corners, and nowhere at a concave edge.

    A cutter in contact at the shared edge touches these without harm.
    """
    skin = {face.number for face in part.skin(number)}
    walls = {n for own in skin for n in part.neighbours(own, "concave")}
    convex = {n for own in skin for n in part.neighbours(own, "convex")}
    edges, ends = part.edges_to_touch, part.ends_to_touch
    of_skin = np.array([not skin.isdisjoint(edge.faces) for edge in edges], dtype=bool)
    if of_skin.any():
        apart, _ = cKDTree(ends[of_skin].reshape(-1, 3)).query(ends)
        for k in np.flatnonzero(apart.min(axis=1) <= 1e-6 * part.diagonal):
            convex |= set(edges[k].faces)
    return convex - walls - skin
