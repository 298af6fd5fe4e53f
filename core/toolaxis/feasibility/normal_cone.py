"""All normals of a face at once: the cap that holds them, and the range of their angles to an axis, proven."""

from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.feasibility.normal_cells import NormalCells
from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.smallest_cap import Cap, smallest_cap
from toolaxis.numeric.vectors import angle_between
from toolaxis.shape.face import Face
from toolaxis.skin.pieces import own_pieces
from toolaxis.skin.view_surface import ViewSurface

Array = NDArray[np.float64]

_ROUNDS = 13
#: Cells are not divided further once their normals are known to this angle, rad.
_FINE = 1e-4
#: More cells than this are not divided further: at a pole, where the normal has no bound, they would only multiply.
_MOST = 100_000


class Range(NamedTuple):
    """Proven range of a quantity over a face: it lies within low to high, and where its extremes were met.

    low, high : float;  least, greatest : (2,) array, parameters (u, v).
    """

    low: float
    high: float
    least: Array
    greatest: Array


@dataclass(frozen=True, eq=False)
class NormalField:
    """The normals of a face.

    Attributes
    ----------
    face : Face
    """

    face: Face

    @cached_property
    def uv(self) -> Array:
        """Parameters of the samples: an even grid inside, and points along every loop, (n, 2)."""
        loops = [_along(loop, 96) for loop in self.face.outline]
        return np.concatenate([self.face.grid(24, 24), *loops])

    @cached_property
    def kept(self) -> Array:
        """Those of `uv` at which there is a normal, (n, 2); InvalidInput where there is none."""
        found = np.asarray(self.uv[np.linalg.norm(self.face.normal(self.uv), axis=1) > 0.5])
        if len(found) == 0:
            raise InvalidInput(f"face {self.face.label} has no area: its normal is defined nowhere; leave it out")
        return found

    @cached_property
    def samples(self) -> Array:
        """Unit normals at `kept`, (n, 3)."""
        return self.face.normal(self.kept)

    @cached_property
    def cap(self) -> Cap:
        """The smallest cap around the samples."""
        return smallest_cap(self.samples)

    @cached_property
    def mean(self) -> Array:
        """Unit mean normal over the area, (3,); the cap's centre where the mean vanishes."""
        d = self.face.evaluate(self.face.grid(48, 48))
        total = (-1.0 if self.face.flip else 1.0) * np.cross(d.su, d.sv).sum(axis=0)
        size = float(np.linalg.norm(total))
        return total / size if size > 0 else self.cap.centre

    def angles(self, axes: ArrayLike) -> tuple[Array, Array]:
        """Least and greatest angle of each axis to the sampled normals, (n,) rad each: no bound.

        Parameters
        ----------
        axes : (n, 3) array_like
            Unit vectors.
        """
        cosine = np.clip(np.asarray(axes, dtype=float) @ self.samples.T, -1.0, 1.0)
        return np.arccos(cosine.max(axis=1)), np.arccos(cosine.min(axis=1))

    @cached_property
    def _cells(self) -> NormalCells:
        return NormalCells(self.face)

    @cached_property
    def _members(self) -> tuple["NormalField", ...]:
        """Of the faces that a skin is made of; none where the face has a surface of its own."""
        if not isinstance(self.face.surface, ViewSurface):
            return ()
        return tuple(NormalField(own) for own in own_pieces(self.face))

    def range_of_angles(self, axis: ArrayLike, least: float, greatest: float) -> Range:
        """Range of the angle between an axis and all normals of the face, proven between the samples too.

        Cells are halved until both limits are decided, or the normals in the cells in question are known to 1e-4 rad,
        or (around a pole) too many cells are in question; the range is wider then.

        Parameters
        ----------
        axis : (3,) array_like
            Unit vector.
        least, greatest : float
            Limits that the caller wants decided, rad.

        Returns
        -------
        Range
            All angles lie within low to high; rad.

        Notes
        -----
        **Properties**: 1. no normal of the face has an angle outside, but within 0.01 mm of a pole or a fold, where
        the normals in the middles of cells stand for all; 2. low and high are met to 1e-4 rad by a normal of the face
        where they decide against the limits.
        """
        t = np.asarray(axis, dtype=float)
        if self._members:
            return self._range_over_members(t, least, greatest)
        kept, cells = self._cells.roots
        low, high = np.inf, -np.inf
        seen = [np.inf, -np.inf]
        where = [cells.rect[0, :2], cells.rect[0, :2]]
        for rounds in range(_ROUNDS + 1):
            angle, spread = angle_between(cells.normal, t), cells.spread
            own = np.flatnonzero(cells.inside)
            for k, best in enumerate((np.argmin, np.argmax)):
                if len(own):
                    i = own[best(angle[own])]
                    if (angle[i] - seen[k]) * (1 if k else -1) > 0:
                        seen[k], where[k] = float(angle[i]), cells.middle[i]
            # No angle is below 0 or above pi: a limit there, as that of a ball end, needs no smaller cells.
            lower, upper = np.maximum(angle - spread, 0.0), np.minimum(angle + spread, pi)
            doubtful = ((lower < min(least, seen[0])) & (seen[0] >= least)) | (
                (upper > max(greatest, seen[1])) & (seen[1] <= greatest))
            doubtful &= (spread > _FINE) & (rounds < _ROUNDS)
            doubtful &= np.count_nonzero(doubtful) <= _MOST
            low = min(low, float(lower[~doubtful].min(initial=np.inf)))
            high = max(high, float(upper[~doubtful].max(initial=-np.inf)))
            if not doubtful.any():
                break
            kept, cells = self._cells.below(None if kept is None else kept[doubtful], cells.chosen(doubtful))
            if not len(cells.rect):
                break
        return Range(low, high, where[0], where[1])

    def _range_over_members(self, axis: Array, least: float, greatest: float) -> Range:
        surface = self.face.surface
        assert isinstance(surface, ViewSurface)
        found = [one.range_of_angles(axis, least, greatest) for one in self._members]
        first, last = (int(np.argmin([one.low for one in found])), int(np.argmax([one.high for one in found])))
        where = [surface.seen[0].project(self._members[k].face.evaluate(uv[None]).point)[0]
                 for k, uv in ((first, found[first].least), (last, found[last].greatest))]
        return Range(found[first].low, found[last].high, where[0], where[1])


def _along(loop: Array, count: int) -> Array:
    """Points along a closed loop: its corners, and between them as many as its share of the outline asks for."""
    ends = np.roll(loop, -1, axis=0)
    size = np.ptp(loop, axis=0)
    length = np.linalg.norm((ends - loop) / np.where(size > 0, size, 1.0), axis=1)
    parts = np.maximum(np.ceil(count * length / max(length.sum(), 1e-300)).astype(int), 1)
    edge, number = number_parts(parts)
    share = (number / parts[edge])[:, None]
    return np.asarray(loop[edge] + share * (ends - loop)[edge])
