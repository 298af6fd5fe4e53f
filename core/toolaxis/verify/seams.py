"""Seams that do not meet: by how much borders of faces stand out over the faces beside them, measured on the faces.

What a cutter that touches the lower face enters the higher one by is in the file and not in the cut.  It is taken off a
gouge, in full up to `REACH` from the border and less and less up to twice that; a step above `GREATEST` is an edge, and
counts.
"""

from collections.abc import Sequence
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot, unit
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.verify.borders import in_parameters
from toolaxis.verify.rays import loop_points

Array = NDArray[np.float64]

#: Distance from a border up to which its step is taken off in full, mm.
REACH = 0.5
#: Steps that count, mm; a little more than a planner may take off, who samples other places.
SMALLEST, GREATEST = 0.0004, 0.021
#: How far beside the lower face a border may lie to meet it, and spacing of places on a border, mm.
NEAR, SPACING = 0.1, 0.2
#: How far into the higher face it is looked whether it goes down there, mm; the sine of what counts as smooth.
_INSIDE, _SMOOTH = 0.02, float(np.sin(np.radians(1.0)))


class SeamSteps(NamedTuple):
    """Places on a face's border that stand out over another face: points (k, 3) and heights (k,), mm."""

    point: Array
    height: Array


def steps_of(face: Face, lower: Sequence[Face], around: Array | None = None) -> SeamSteps:
    """Where a face stands out over faces that it meets smoothly or over a convex edge.

    Parameters
    ----------
    face : Face
    lower : sequence of Face
        Faces that the cutter may touch.
    around : (m, 3) array, optional
        Places, mm: only what counts near one of them is asked for; all unless given.
    """
    from scipy.spatial import cKDTree

    found = [_steps_between(face, other) for other in lower if other is not face]
    steps = SeamSteps(np.concatenate([np.empty((0, 3)), *(one.point for one in found)]),
                      np.concatenate([np.empty(0), *(one.height for one in found)]))
    if around is None or not len(steps.height):
        return steps
    far = cKDTree(around).query(steps.point, distance_upper_bound=2 * REACH + SPACING)[0]
    near = np.isfinite(far)
    return SeamSteps(steps.point[near], steps.height[near])


#: What is known of pairs of faces, the higher one first: many operations ask for the steps of the same faces.
_KNOWN: WeakKeyDictionary[Face, WeakKeyDictionary[Face, SeamSteps]] = WeakKeyDictionary()
_BORDERS: WeakKeyDictionary[Face, "_Border"] = WeakKeyDictionary()


def _steps_between(face: Face, other: Face) -> SeamSteps:
    """Where a face stands out over one other face, worked out once."""
    known = _KNOWN.setdefault(face, WeakKeyDictionary())
    if other not in known:
        known[other] = _steps_over(other, face, _border_of(face))
    return known[other]


class _Border(NamedTuple):
    """Places on a face's border: parameters (k, 2), points, and directions along it (k, 3)."""

    uv: Array
    point: Array
    along: Array

    def rows(self, which: NDArray[np.int64]) -> "_Border":
        return _Border(self.uv[which], self.point[which], self.along[which])


def _border_of(face: Face) -> _Border:
    """Places on all loops of a face, worked out once."""
    if face not in _BORDERS:
        loops = [loop_points(face, loop, SPACING) for loop in face.outline]
        points = [face.evaluate(uv).point for uv in loops]
        along = [np.roll(point, -1, axis=0) - np.roll(point, 1, axis=0) for point in points]
        _BORDERS[face] = _Border(*(np.concatenate(parts) for parts in (loops, points, along)))
    return _BORDERS[face]


def _steps_over(other: Face, face: Face, border: _Border) -> SeamSteps:
    """Places of a face's border that stand out over another face."""
    near = ((border.point > other.box[0] - NEAR) & (border.point < other.box[1] + NEAR)).all(axis=1)
    border = border.rows(np.flatnonzero(near))
    if not len(border.uv):
        return SeamSteps(np.empty((0, 3)), np.empty(0))
    foot = nearest(other, border.point)
    up = other.normal(foot.uv)
    height = dot(border.point - foot.point, up)
    found = (foot.distance < NEAR) & (height >= SMALLEST) & (height <= GREATEST)
    rows = np.flatnonzero(found)
    rows = rows[_goes_down(face, border.rows(rows), up[rows])]
    return SeamSteps(border.point[rows], height[rows])


def _goes_down(face: Face, border: _Border, up: Array) -> NDArray[np.bool_]:
    """Whether a face does not rise over another one beyond its border: they meet smoothly or over a convex edge."""
    normal = face.normal(border.uv)
    across = np.cross(border.along, normal)
    sound = np.linalg.norm(across, axis=1) > 0.0
    across = unit(np.where(sound[:, None], across, [1.0, 0.0, 0.0]))
    step = in_parameters(face, border.uv, _INSIDE * across)
    side = face.contains(border.uv + step).astype(int) - face.contains(border.uv - step).astype(int)
    inwards = side[:, None] * across
    return np.asarray(sound & (side != 0) & (dot(inwards, up) <= _SMOOTH))


def depth_taken_off(steps: SeamSteps, points: Array) -> Array:
    """What steps take off the depth of a cut at points of their face, (n,) mm.

    Parameters
    ----------
    steps : SeamSteps
    points : (n, 3) array
        mm
    """
    from scipy.spatial import cKDTree

    off = np.zeros(len(points))
    if not len(steps.height) or not len(points):
        return off
    reach = 2 * REACH + SPACING / 2
    pairs = cKDTree(points).sparse_distance_matrix(cKDTree(steps.point), reach, output_type="ndarray")
    # A border's places stand apart: between two of them it is nearer than to either by half of that at most.
    share = np.clip(2.0 - (pairs["v"] - SPACING / 2) / REACH, 0.0, 1.0)
    np.maximum.at(off, pairs["i"], share * steps.height[pairs["j"]])
    return off
