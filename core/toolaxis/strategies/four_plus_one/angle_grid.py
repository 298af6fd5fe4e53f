"""Places on a face, along and across its passes, at which the angle of a turning axis is chosen."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.second_order import contact_forms
from toolaxis.strategies.four_plus_one.passes import ClampedChart

Array = NDArray[np.float64]

#: Nodes along and across the passes; they reach so many radii of the tool beyond the borders along, where passes run
#: out.
NODES, BEYOND = (17, 11), 0.6
#: Gaps between two nodes in which angles are held against everything around.
_FINE = 4
#: Parts of a gap that are asked whether they lie on the face, and the share of the range by which outer passes are
#: moved inwards for that.
_PARTS, _EDGE = 4, 1e-5


@dataclass(frozen=True, eq=False)
class Nodes:
    """Places on a face at which free angles are chosen.

    Attributes
    ----------
    chart : ClampedChart
    radius : float
        Of the tool, mm.
    """

    chart: ClampedChart
    radius: float

    @cached_property
    def along(self) -> Array:
        """Parameters along the passes, (i,)."""
        a0, a1, s0, s1 = self.chart.bounds
        middle = (s0 + s1) / 2
        count = NODES[0]
        uv = self.chart.uv(np.linspace(a0, a1, count), np.full(count, middle))
        points = self.chart.face.evaluate(uv).point
        gaps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        length = float(gaps.sum())
        closed = self.chart.closed(np.array([middle]))[0]
        more = 0.0 if closed else BEYOND * self.radius * (a1 - a0) / length
        return np.linspace(a0 - more, a1 + more, count)

    @cached_property
    def step(self) -> Array:
        """Parameters across the passes, (k,)."""
        return np.linspace(*self.chart.bounds[2:], NODES[1])

    @cached_property
    def uv(self) -> Array:
        """Parameters of all nodes, (i k, 2)."""
        return self._grid_uv(self.along, self.step)

    @cached_property
    def points(self) -> Array:
        """Points of the surface, (i, k, 3) mm."""
        return self.chart.face.evaluate(self.uv).point.reshape(*NODES, 3)

    @cached_property
    def forms(self) -> Array:
        """What screening needs, (i k, 13)."""
        return contact_forms(self.chart.face, self.uv, self.chart.feed, True)

    @cached_property
    def counts(self) -> NDArray[np.bool_]:
        """Nodes on the face or next to one, (i, k)."""
        on = self.chart.face.contains(self.uv).reshape(NODES)
        wide = np.pad(on, 1)
        around = [wide[i:i + NODES[0], k:k + NODES[1]] for i in range(3) for k in range(3)]
        return np.asarray(np.any(around, axis=0))

    @cached_property
    def lengths(self) -> Array:
        """Length of each pass on the face, (k,) mm."""
        _, _, s0, s1 = self.chart.bounds
        shares = (np.arange(_PARTS) + 0.5) / _PARTS
        gaps = np.diff(self.along)[:, None]
        along = (self.along[:-1, None] + gaps * shares).ravel()
        inwards = _EDGE * (s1 - s0)
        step = np.clip(self.step, s0 + inwards, s1 - inwards)
        on_face = self.chart.face.contains(self._grid_uv(along, step))
        share = on_face.reshape(NODES[0] - 1, _PARTS, NODES[1]).mean(axis=1)
        way = np.linalg.norm(np.diff(self.points, axis=0), axis=2)
        return np.asarray((way * share).sum(axis=0))

    @cached_property
    def fine(self) -> tuple[Array, Array]:
        """Parameters along and across of places on the face and between the nodes, (m,) each."""
        fine_along, near_along = _refine(self.along)
        fine_step, near_step = _refine(self.step)
        along, step = np.meshgrid(fine_along, fine_step, indexing="ij")
        some = self.counts[np.ix_(near_along, near_step)]
        return along[some], step[some]

    @cached_property
    def ways(self) -> tuple[Array, Array]:
        """Places of the nodes in mm, along and across."""
        along, across = (self._mean_length(axis) for axis in (0, 1))
        return np.linspace(0.0, along, NODES[0]), np.linspace(0.0, across, NODES[1])

    def _grid_uv(self, along: Array, step: Array) -> Array:
        """Parameters of the face at all pairs of the one and the other, (i k, 2)."""
        every_along, every_step = np.meshgrid(along, step, indexing="ij")
        return self.chart.uv(every_along.ravel(), every_step.ravel())

    def _mean_length(self, axis: int) -> float:
        """Mean length of the lines through the nodes along the passes (0) or across them (1), mm."""
        gaps = np.linalg.norm(np.diff(self.points, axis=axis), axis=2)
        return float(gaps.sum(axis=axis).mean())


def _refine(line: Array) -> tuple[Array, NDArray[np.intp]]:
    """Places between the nodes of a line, `_FINE` to a gap, and the number of the node next to each."""
    places = np.linspace(line[0], line[-1], _FINE * (len(line) - 1) + 1)
    nearest = (np.arange(len(places)) + _FINE // 2) // _FINE
    return places, np.minimum(nearest, len(line) - 1)
