"""Drop-cutter: how far a cutter comes down along its axis before it touches a mesh of triangles.

Faces have `placing` and `gouge`, which are exact on the surface itself; this is for what comes as a mesh.
"""

from math import cos, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.drop_cutter.drop_cutter_numpy import drop_numpy
from toolaxis.contact.drop_cutter.kernel import (
    EDGES_ONLY,
    FAN,
    MISS,
    NARROW,
    PLAIN,
    STEEP,
    THIN,
    Cutter,
    Tree,
    drop_many,
)
from toolaxis.errors import InvalidInput
from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.vectors import as_rows, perpendicular, unit
from toolaxis.progress import breathe
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

_POINTS_AT_ONCE = 1024


def drop_cutter(mesh: ArrayLike | tuple[ArrayLike, ArrayLike], tool: Tool, points: ArrayLike,
                axis: ArrayLike = (0.0, 0.0, 1.0)) -> Array:
    """Heights at which a cutter that is dropped along its axis comes to rest on a mesh.

    Parameters
    ----------
    mesh : (n, 3, 3) array_like, or tuple of (m, 3) and (n, 3) array_like
        Corners of the triangles, mm, or vertices and the faces' indices.  Either sense of the triangles will do; they
        need not hang together, and a triangle without area counts as the edges that it has.
    tool : Tool
        Any kind.  Only the underside of its cutter counts: shank, holder and length of the cutting edge do not, and a
        tapered cutter is as wide as at the end of its cutting edge.
    points : (k, 2) or (k, 3) array_like
        x and y of the tips for an axis along +z; for any axis points anywhere on the lines along which the tips come.
    axis : (3,) array_like
        Tool axis, tip to spindle.

    Returns
    -------
    (k,) array
        Height t of each tip along the axis, mm: it rests at p - (p . axis) axis + t axis.  -inf where the cutter
        passes by the mesh.

    Raises
    ------
    InvalidInput
        When the mesh has no triangle, a number is not finite, an index names no vertex, or a shape does not fit.

    Notes
    -----
    **Source**: greatest height over all points q of the mesh within the cutter's radius of its axis of
    z(q) - h(rho(q)), h the height of the underside above the tip.  Facets, and edges under flat bottom, ball and cone,
    have closed forms; under a torus an edge is solved by a bracketed Newton iteration.

    **Properties**: 1. rigid motions of mesh, points and axis change no tip; 2. lengths scale; 3. order, sense and
    division of the triangles change nothing; 4. a larger mesh never lowers a tip.

    Examples
    --------
    >>> square = [[[0, 0, 1], [9, 0, 1], [0, 9, 1]]]
    >>> drop_cutter(square, Tool.ball(6), [[2, 2], [50, 50]]).tolist()
    [1.0, -inf]
    """
    z = unit(as_rows(axis, 3, "axis"))
    if len(z) != 1:
        raise InvalidInput(f"{len(z)} axes are given: a mesh is dropped on along one axis at a time")
    frame = np.array([*perpendicular(z[0]), z[0]])
    corners = _corners(mesh) @ frame.T
    xy = np.ascontiguousarray((_points(points, z[0]) @ frame.T)[:, :2])
    cutter, out = cutter_of(tool), np.empty(len(xy))
    tree = tree_of(corners, cutter) if _compiled.available else None
    for first in range(0, len(xy), _POINTS_AT_ONCE):
        breathe()
        some = slice(first, first + _POINTS_AT_ONCE)
        if tree is None:
            out[some] = drop_numpy(cutter, corners, xy[some])
        else:
            drop_many(cutter, tree, xy[some], out[some])
    return out


def cutter_of(tool: Tool) -> Cutter:
    """What the kernel knows of a cutter's underside.

    Parameters
    ----------
    tool : Tool
    """
    profile = tool.profile
    return (profile.flat_radius, profile.corner_radius, sin(profile.half_angle), cos(profile.half_angle),
            profile.top_radius)


def _corners(mesh: ArrayLike | tuple[ArrayLike, ArrayLike]) -> Array:
    """Corners of the triangles, (n, 3, 3)."""
    if isinstance(mesh, tuple) and len(mesh) == 2:
        vertices, faces = as_rows(mesh[0], 3, "vertices of the mesh"), np.asarray(mesh[1])
        if faces.ndim != 2 or faces.shape[1] != 3 or faces.dtype.kind not in "iu":
            raise InvalidInput(f"faces of the mesh have shape {faces.shape} and type {faces.dtype}: "
                               "rows of three whole numbers are needed")
        bad = np.flatnonzero(((faces < 0) | (faces >= len(vertices))).any(axis=1))
        if bad.size:
            raise InvalidInput(f"face {bad[0]} of the mesh is {faces[bad[0]].tolist()}: there are vertices 0 to "
                               f"{len(vertices) - 1} only")
        corners: Array = vertices[faces]
    else:
        try:
            corners = np.asarray(mesh, dtype=float)
        except (TypeError, ValueError):
            raise InvalidInput("the mesh is no array of numbers: triangles (n, 3, 3), or a tuple of vertices and "
                               "faces, are needed") from None
    if corners.ndim != 3 or corners.shape[1:] != (3, 3) or not len(corners):
        raise InvalidInput(f"the mesh has shape {corners.shape}: at least one triangle of three corners, (n, 3, 3), "
                           "is needed")
    bad = np.flatnonzero(~np.isfinite(corners).all(axis=(1, 2)))
    if bad.size:
        raise InvalidInput(f"triangle {bad[0]} of the mesh is {corners[bad[0]].tolist()}: every number must be finite")
    return corners


def _points(points: ArrayLike, axis: Array) -> Array:
    """Points in space, (k, 3)."""
    if np.shape(points)[-1:] != (2,):
        return as_rows(points, 3, "points")
    if axis[2] < 1.0:
        raise InvalidInput(f"points have two coordinates and the axis is {axis.tolist()}: give points in space, with "
                           "three, where the axis is not +z")
    rows = as_rows(points, 2, "points")
    return np.column_stack([rows, np.zeros(len(rows))])


def tree_of(corners: Array, cutter: Cutter) -> Tree:
    """Triangles in the order of a curve that fills the plane, and the boxes of runs of them, of runs of runs, ...

    Parameters
    ----------
    corners : (n, 3, 3) array
        In the tool's frame, mm.
    cutter : Cutter
    """
    rows = _rows(corners, cutter)[_curve_order(corners[..., :2])]
    x, y, z = (rows[:, c:9:3] for c in range(3))
    box = np.column_stack([x.min(1), x.max(1), y.min(1), y.max(1), z.max(1)])
    boxes: list[Array] = []
    levels = [0]
    while not boxes or len(box) > 1:
        starts = np.arange(0, len(box), FAN)
        box = np.column_stack([(np.maximum if c in (1, 3, 4) else np.minimum).reduceat(box[:, c], starts)
                               for c in range(5)])
        boxes.append(box)
        levels.append(levels[-1] + len(box))
    return rows, np.vstack(boxes), np.array(levels)


def _curve_order(corners: Array) -> NDArray[np.int64]:
    """Triangles along a Z-order curve through the middles of their boxes."""
    middle = corners.min(axis=1) + corners.max(axis=1)
    middle -= middle.min(axis=0)
    extent = float(middle.max())
    cell = (middle / extent * 65535 if extent > 0 else middle).astype(np.uint64)
    for shift, mask in ((8, 0x00FF00FF), (4, 0x0F0F0F0F), (2, 0x33333333), (1, 0x55555555)):
        cell = (cell | (cell << np.uint64(shift))) & np.uint64(mask)
    return np.argsort(cell[:, 0] | (cell[:, 1] << np.uint64(1)), kind="stable")


def _rows(corners: Array, cutter: Cutter) -> Array:
    """What the kernel knows of each triangle, (n, 16).

    Corners (0 to 8), slope along x and y (9, 10), where the plane touches the cutter, from its axis (11, 12), height
    of the underside there (13), kind of facet (14), highest corner (15).
    """
    flat, corner, sine, cosine, widest = cutter
    a, b, c = corners.transpose(1, 0, 2)
    ab, ac = b - a, c - a
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    with np.errstate(all="ignore"):
        slope = np.stack([ab[:, 2] * ac[:, 1] - ac[:, 2] * ab[:, 1], ac[:, 2] * ab[:, 0] - ab[:, 2] * ac[:, 0]], 1)
        slope /= area[:, None]
        steepness = np.hypot(*slope.T)
        miss = np.maximum(*(np.abs((slope * d[:, :2]).sum(axis=1) - d[:, 2]) for d in (ab, ac)))
        thin = np.abs(area) < THIN * np.maximum((ab[:, :2] ** 2).sum(axis=1), (ac[:, :2] ** 2).sum(axis=1))
        rough = (miss > MISS) | (steepness > STEEP)
        sure = np.isfinite(steepness) & ((miss <= MISS) | (steepness > STEEP) | ~thin)
    slope[~sure], steepness[~sure] = 0.0, 0.0
    arc = sine * steepness <= cosine
    lean = np.hypot(1.0, steepness)
    rho = np.where(steepness == 0, 0.0, np.where(arc, flat + corner * steepness / lean, widest))
    side = corner * (1 - sine) + (widest - flat - corner * cosine) * (cosine / sine if sine > 0 else 0.0)
    rise = np.where(arc, corner * (steepness / lean) * (steepness / (lean + 1)), side)
    touch = slope * (rho / np.where(steepness > 0, steepness, 1.0))[:, None]
    kind = np.where(sure, np.where(thin | rough, NARROW, PLAIN) * np.sign(area), EDGES_ONLY)
    return np.column_stack([corners.reshape(-1, 9), slope, touch, rise, kind, corners[..., 2].max(axis=1)])
