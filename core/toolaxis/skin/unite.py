"""Faces that continue each other, seen along one direction, as one face."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import UnsupportedGeometry
from toolaxis.numeric.smallest_cap import smallest_cap
from toolaxis.numeric.vectors import unit
from toolaxis.shape.face import Face, Member
from toolaxis.shape.joining.joined_surface import name_of
from toolaxis.skin.outline import outline_around
from toolaxis.skin.seen_face import SeenFace
from toolaxis.skin.view_surface import view_surface

Array = NDArray[np.float64]

#: Greatest angle between a normal and the direction from which faces are seen, rad.
GREATEST_TURN = np.radians(75.0)
#: Faces whose borders lie so near to each other meet, mm, unless they are known to be farther apart.
GAP = 0.02
#: Places each way that are found again from the plane, and from what distance on another was found, mm, beside the gap.
_LOOKED, _OTHER = 9, 1e-3


def normals_of(face: Face) -> Array:
    """Unit normals over a face and along its border, (n, 3).

    Parameters
    ----------
    face : Face
    """
    found = face.normal(np.concatenate([face.grid(12, 12), *face.outline]))
    return np.asarray(found[np.linalg.norm(found, axis=1) > 0.5])


def unite(faces: Sequence[Face], gap: float = GAP) -> Face:
    """One face from faces that continue each other, whatever their parameters.

    Parameters
    ----------
    faces : sequence of Face
        The first one's number is that of the result.
    gap : float
        How far borders that meet may lie apart, mm.

    Returns
    -------
    Face
        Its parameters are mm in the plane across the direction; see `toolaxis.skin.view_surface.ViewSurface`.

    Raises
    ------
    UnsupportedGeometry
        When no direction sees all of them, one covers another, or their outline does not close.

    Notes
    -----
    **Properties**: 1. areas add up; 2. every point within the outline is one of a member; 3. moving the faces moves the
    result.
    """
    labels = ", ".join(face.label for face in faces)
    normals = np.concatenate([normals_of(face) for face in faces])
    cap = smallest_cap(normals)
    up = cap.centre
    if cap.radius > GREATEST_TURN:
        raise UnsupportedGeometry(f"faces {labels} cannot be machined as one: their normals turn by up to "
                                  f"{np.degrees(cap.radius):.0f} degrees from the best view of them, "
                                  f"{np.degrees(GREATEST_TURN):.0f} are allowed: choose fewer of them")
    first = _long_direction(faces, up)
    frame = np.stack([first, np.cross(up, first), up])
    box = np.concatenate([face.box for face in faces])
    origin = (box.min(axis=0) + box.max(axis=0)) / 2
    seen = [SeenFace(face, frame[:2], origin) for face in faces]
    _check_hidden(seen, name_of(faces), gap)  # the line around them and the spline through them take long
    outline = outline_around(seen, gap)
    surface = view_surface(seen, frame, origin, outline)
    members = tuple(Member(face) for face in faces)
    kinds = {face.kind for face in faces}
    made = Face(surface, outline, False, faces[0].number, name_of(faces), kinds.pop() if len(kinds) == 1 else "bspline",
                max(face.tolerance for face in faces), members=members)
    _check_covered(made, seen, gap)
    return made


def _long_direction(faces: Sequence[Face], up: Array) -> Array:
    """The direction across another one along which the faces reach farthest, (3,)."""
    points = np.concatenate([face.evaluate(np.concatenate([face.grid(6, 6), *face.outline])).point for face in faces])
    flat = points - points.mean(axis=0)
    flat -= (flat @ up)[:, None] * up
    way = np.linalg.svd(flat, full_matrices=False)[2][0]
    way = way * (1.0 if way[int(np.argmax(np.abs(way)))] > 0 else -1.0)
    return np.asarray(unit(way - (way @ up) * up))


def _check_hidden(seen: Sequence[SeenFace], label: str, gap: float) -> None:
    """That no place of a face lies below another one as seen along the direction."""
    for one in seen:
        point = one.face.evaluate(one.face.grid(_LOOKED, _LOOKED)).point
        places, height = one.project(point), one.heights_of(point)
        above = np.zeros(len(point))
        for other in seen:
            under = other.contains(places)
            if other is not one and under.any():
                above[under] = np.maximum(above[under], other.heights_at(places[under]) - height[under])
        _check_off(one, label, point, above, gap)


def _check_covered(made: Face, seen: Sequence[SeenFace], gap: float) -> None:
    """That every place of a face is one of the skin."""
    for one in seen:
        point = one.face.evaluate(one.face.grid(_LOOKED, _LOOKED)).point
        off = np.linalg.norm(made.evaluate(one.project(point)).point - point, axis=1)
        _check_off(one, made.label, point, off, gap)


def _check_off(one: SeenFace, label: str, point: Array, off: Array, gap: float) -> None:
    """Refuse faces of which another one lies off the points (n, 3) of one, by (n,) mm."""
    worst = int(np.argmax(off)) if len(off) else 0
    if len(off) and off[worst] > _OTHER + gap:
        raise UnsupportedGeometry(f"faces {label} cannot be machined as one: another of them lies "
                                  f"{off[worst]:.2f} mm above or below face {one.face.label} at "
                                  f"{np.round(point[worst], 2).tolist()}: choose fewer of them")
