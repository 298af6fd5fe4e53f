"""How deep a cut lies below the part's surface, where rays are laid bare deeper than a gouge may be.

A ray's own depth tells that in the middle of a face.  Near an edge or a border the part ends beside the ray; in a thin
wall it ends below; and where faces of the file do not meet, what they miss each other by is not the cutter's.
"""

from collections.abc import Callable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.shape.face import Face
from toolaxis.verify.convex_edges import depth_at_edges
from toolaxis.verify.material_removal import RestMaterial
from toolaxis.verify.seams import SeamSteps, depth_taken_off, steps_of
from toolaxis.verify.task import VerificationTask
from toolaxis.verify.thin_walls import depth_to_other_places

Array = NDArray[np.float64]

#: Least depth to which a ray in a wall is followed, mm.
_LEAST = 1e-3


class Depths:
    """Depths below the surface of a task's part, from those of rays.

    Parameters
    ----------
    task : VerificationTask
    cut : callable
        `removal` with everything but rays and their depth given.
    """

    def __init__(self, task: VerificationTask, cut: Callable[..., RestMaterial]) -> None:
        self.task, self.cut = task, cut

    def correct(self, face: Face, rays: tuple[Array, Array], left: RestMaterial) -> None:
        """Replace the depths of rays that are laid bare deeper than allowed by those below the part's surface.

        Parameters
        ----------
        face : Face
            On which the rays stand.
        rays : (m, 3) and (m, 3) array
            Points of the face, mm, and normals out of the material.
        left : RestMaterial
            Of these rays; its gouges are changed.
        """
        task = self.task
        deep = np.flatnonzero(left.gouge > task.tolerance.gouge)
        if not len(deep):
            return
        point, normal = rays[0][deep], rays[1][deep]
        own = tuple(one for one in self._of_the_part() if one is not face)
        told, near = depth_at_edges(face, (point, normal, left.gouge[deep]), (own, task.surroundings), self._laid_bare,
                                    task.tolerance.gouge, self._to_other_places)
        self._in_walls((point, normal), left, deep, ~near)
        left.gouge[deep[near]] = told[near]
        higher = left.gouge[deep] > task.tolerance.gouge
        deep, point = deep[higher], point[higher]
        left.gouge[deep] = np.maximum(left.gouge[deep] - self._mismatch_near(face, point), 0.0)

    def _of_the_part(self) -> tuple[Face, ...]:
        return (*self.task.targets, *self.task.skin, *self.task.touching)

    def _laid_bare(self, feet: Array, ways: Array, depth: Array) -> Array:
        return self.cut((feet + self.task.allowance * ways, ways), depth=np.minimum(depth, self.task.depth)).gouge

    def _to_other_places(self, feet: Array, ways: Array, depth: Array) -> Array:
        """Depths of rays below the allowance, no deeper than to where another place of the part is nearer, mm."""
        allowance = self.task.allowance
        below = depth_to_other_places(feet, ways, self._of_the_part(), np.maximum(depth - allowance, 0.0))
        return np.where(below < depth - allowance, allowance + below, depth)

    def _in_walls(self, rays: tuple[Array, Array], left: RestMaterial, deep: NDArray[np.int64],
                  asked: NDArray[np.bool_]) -> None:
        """Follow rays in thin walls only until the other side is nearer: each half belongs to its own side."""
        foot, normal = rays[0][asked] + self.task.allowance * rays[1][asked], rays[1][asked]
        depth = left.gouge[deep[asked]]
        limit = self._to_other_places(rays[0][asked], normal, depth)
        thin = limit < depth
        if thin.any():
            rows = deep[asked][thin]
            less = self.cut((foot[thin], normal[thin]), depth=np.maximum(limit[thin], _LEAST))
            left.gouge[rows], left.gouged_by[rows] = less.gouge, less.gouged_by

    def _mismatch_near(self, face: Face, point: Array) -> Array:
        """By how much the face stands out over its neighbours near points of it, mm."""
        if not len(point):
            return np.zeros(0)
        lower = (*self.task.targets, *self.task.skin)
        # The borders of a piece are the plan's: those of the file are the borders of its whole face.
        whole = [one for one in self.task.skin if one.surface is face.surface and one is not face]
        return np.max([depth_taken_off(steps_of(one, lower, point), point) for one in (face, *whole)], axis=0)

    def missed_behind_edges(self, owner: NDArray[np.int64], point: Array) -> Array:
        """By how much faces behind convex edges stand out over those that the cutter may touch, (n,) mm.

        Parameters
        ----------
        owner : (n,) array of int
            Index among the task's touching faces.
        point : (n, 3) array
            Points of them, mm.
        """
        off = np.zeros(len(point))
        for k in np.unique(owner):
            rows = owner == k
            off[rows] = depth_taken_off(self._behind[int(k)], point[rows])
        return off

    def missed_near(self, face: Face, point: Array) -> bool:
        """Whether a face behind a convex edge stands out over those that the cutter may touch, near a point of it.

        Parameters
        ----------
        face : Face
        point : (3,) array
            mm
        """
        steps = steps_of(face, (*self.task.targets, *self.task.skin), point[None])
        return bool(depth_taken_off(steps, point[None])[0] > 0.0)

    @cached_property
    def _behind(self) -> tuple[SeamSteps, ...]:
        lower = (*self.task.targets, *self.task.skin)
        return tuple(steps_of(face, lower) for face in self.task.touching)
