"""Faces side by side in a plane: which of them lies at a place."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toolaxis.numeric.polygons import EdgeIndex, inside, slabs
from toolaxis.shape.surface import Derivatives
from toolaxis.skin.covered_parts import Loops, covered_parts
from toolaxis.skin.point_grid import sort_into_cells
from toolaxis.skin.seen_face import SeenFace
from toolaxis.skin.view_kernel import (
    CELLS,
    ViewTable,
    evaluate_owned,
    find_nearest_faces,
    find_owners,
    tabulate_polygons,
    tabulate_splines,
)

Array = NDArray[np.float64]
Index = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class FacesInView:
    """Faces in one plane, and the line around all of them.

    Attributes
    ----------
    seen : tuple of SeenFace
    outline : tuple of (m, 2) arrays
        Loops in the plane.
    """

    seen: tuple[SeenFace, ...]
    outline: tuple[Array, ...]

    def owners(self, places: Array) -> Index:
        """Which of the faces lies at places of the plane, (n,); -1 beyond the outline.

        Between two faces that do not quite meet, the nearer one goes on; of two above each other it is the upper one.

        Parameters
        ----------
        places : (n, 2) array
        """
        if self.table is None:
            return self._find_plainly(places)
        owner = np.empty(len(places), dtype=np.intp)
        find_owners(self.table, np.ascontiguousarray(places, dtype=float), owner)
        return owner

    def _find_plainly(self, places: Array) -> Index:
        """The plain twin of `toolaxis.skin.view_kernel.find_owners`."""
        owner = np.full(len(places), -1, dtype=np.intp)
        low, high = self._boxes
        near = np.asarray(((places >= low[:, None]) & (places <= high[:, None])).all(axis=2))
        for k in map(int, np.flatnonzero(near.any(axis=1))):
            left = np.flatnonzero(near[k] & (owner < 0))
            if len(left):
                mine = left[self.seen[k].contains(places[left])]
                owner[mine[~self._is_covered(k, places[mine])]] = k
        gap = np.flatnonzero(owner < 0)
        gap = gap[inside(self._around, places[gap])] if len(gap) else gap
        if len(gap):
            owner[gap] = self._find_nearest_plainly(places[gap])
        return owner

    @cached_property
    def table(self) -> ViewTable | None:
        """All faces for the kernels; None where one of them has none."""
        if not all(one.has_kernel for one in self.seen):
            return None
        hiding = [slabs(part) for parts in self.covered for part in parts]
        outlines = [slabs(one.outline) for one in self.seen]
        first = len(outlines) + np.cumsum([0, *(len(parts) for parts in self.covered)])
        splines = tabulate_splines([one.face.surface for one in self.seen], [one.frame.ends for one in self.seen],
                                   [one.begin_in_cells(CELLS) for one in self.seen])
        frame = self.seen[0].frame
        return ViewTable(frame.rows, frame.origin, np.ascontiguousarray(self._boxes.swapaxes(0, 1)),
                         first.astype(np.int64), tabulate_polygons([*outlines, *hiding, self._around]), splines,
                         sort_into_cells(self._borders), self._beside)

    @cached_property
    def covered(self) -> tuple[tuple[Loops, ...], ...]:
        """For each face the parts of it, loops in the plane, above which another one lies."""
        return covered_parts(self.seen)

    def _is_covered(self, number: int, places: Array) -> NDArray[np.bool_]:
        """Whether another face lies above one of them at places of the plane, (n,)."""
        found = np.zeros(len(places), dtype=bool)
        for part in self.covered[number]:
            found |= inside(slabs(part), places)
        return found

    def evaluate(self, places: Array, owner: Index) -> Derivatives:
        """Points of faces at places of the plane, and their derivatives with these.

        Parameters
        ----------
        places : (n, 2) array
        owner : (n,) array of int
            The face at each place.
        """
        if self.table is not None:
            table = np.empty((len(places), 6, 3))
            evaluate_owned(self.table, np.ascontiguousarray(places, dtype=float), np.ascontiguousarray(owner), table)
            return Derivatives(*(table[:, k] for k in range(6)))
        return self._evaluate_plainly(places, owner)

    def _evaluate_plainly(self, places: Array, owner: Index) -> Derivatives:
        """Face by face."""
        found = Derivatives(*np.empty((6, len(places), 3)))
        for k in np.unique(owner):
            rows = owner == k
            for every, own in zip(found, self.seen[k].evaluate(places[rows]), strict=True):
                every[rows] = own
        return found

    def nearest(self, places: Array) -> Index:
        """The face whose border is nearest to each place, (n,).

        Parameters
        ----------
        places : (n, 2) array
        """
        if self.table is None:
            return self._find_nearest_plainly(places)
        owner = np.empty(len(places), dtype=np.intp)
        find_nearest_faces(self.table, np.ascontiguousarray(places, dtype=float), owner)
        return owner

    def _find_nearest_plainly(self, places: Array) -> Index:
        """The plain twin of `toolaxis.skin.view_kernel.find_nearest_faces`."""
        return np.asarray(self._beside[self._border_tree.query(places)[1]], dtype=np.intp)

    @cached_property
    def _boxes(self) -> Array:
        """Lower and upper corners of the faces' outlines, (2, k, 2)."""
        return np.stack([one.box for one in self.seen], axis=1)

    @cached_property
    def _around(self) -> EdgeIndex:
        return slabs(self.outline)

    @cached_property
    def _borders(self) -> Array:
        """Points along the borders of the faces, (n, 2)."""
        return np.concatenate([loop for one in self.seen for loop in one.outline])

    @cached_property
    def _border_tree(self) -> cKDTree:
        return cKDTree(self._borders)

    @cached_property
    def _beside(self) -> NDArray[np.int64]:
        """The face of each of those points."""
        return np.repeat(np.arange(len(self.seen)), [sum(map(len, one.outline)) for one in self.seen]).astype(np.int64)
