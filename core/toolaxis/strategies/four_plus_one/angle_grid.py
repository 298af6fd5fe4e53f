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
        uv = self.chart.uv(np.linspace(a0, a1, NODES[0]), np.full(NODES[0], (s0 + s1) / 2))
        length = float(np.linalg.norm(np.diff(self.chart.face.evaluate(uv).point, axis=0), axis=1).sum())
        more = 0.0 if self.chart.closed(np.array([(s0 + s1) / 2]))[0] else BEYOND * self.radius * (a1 - a0) / length
        return np.linspace(a0 - more, a1 + more, NODES[0])

    @cached_property
    def step(self) -> Array:
        """Parameters across the passes, (k,)."""
        return np.linspace(*self.chart.bounds[2:], NODES[1])

    @cached_property
    def uv(self) -> Array:
        """Parameters of all nodes, (i k, 2)."""
        return self.chart.uv(*(part.ravel() for part in np.meshgrid(self.along, self.step, indexing="ij")))

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
        along = (self.along[:-1, None] + np.diff(self.along)[:, None] * shares).ravel()
        step = np.clip(self.step, s0 + _EDGE * (s1 - s0), s1 - _EDGE * (s1 - s0))
        uv = self.chart.uv(*(part.ravel() for part in np.meshgrid(along, step, indexing="ij")))
        share = self.chart.face.contains(uv).reshape(NODES[0] - 1, _PARTS, NODES[1]).mean(axis=1)
        return np.asarray((np.linalg.norm(np.diff(self.points, axis=0), axis=2) * share).sum(axis=0))

    @cached_property
    def fine(self) -> tuple[Array, Array]:
        """Parameters along and across of places on the face and between the nodes, (m,) each."""
        rows = [np.linspace(each[0], each[-1], _FINE * (len(each) - 1) + 1) for each in (self.along, self.step)]
        near = [np.minimum((np.arange(len(each)) + _FINE // 2) // _FINE, count - 1) for each, count in
                zip(rows, NODES, strict=True)]
        along, step = (part.ravel() for part in np.meshgrid(*rows, indexing="ij"))
        some = self.counts[np.ix_(*near)].ravel()
        return along[some], step[some]

    @cached_property
    def ways(self) -> tuple[Array, Array]:
        """Places of the nodes in mm, along and across."""
        wide = [float(np.linalg.norm(np.diff(self.points, axis=axis), axis=2).sum(axis=axis).mean()) for axis in (0, 1)]
        return np.linspace(0.0, wide[0], NODES[0]), np.linspace(0.0, wide[1], NODES[1])
