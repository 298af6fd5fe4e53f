"""What charts have in common whose passes do not follow a parameter of the face."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.parts import number_parts
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Parts into which the longest side of a loop would be divided, were it as long as the range.
_EDGE = 256


@dataclass(frozen=True, eq=False)
class FreeChart(ABC):
    """A face in other coordinates, along and step, than its own parameters.

    Attributes
    ----------
    face : Face
    """

    face: Face

    @abstractmethod
    def uv(self, along: Array, step: Array) -> Array:
        """Parameters (n, 2) of the face at along and step, (n,) each; beyond the face too."""

    @abstractmethod
    def places(self, uv: Array) -> Array:
        """Along and step of parameters of the face, (n, 2): the inverse of `uv`."""

    @abstractmethod
    def feed_at(self, uv: Array) -> Array:
        """Unit feed directions of passes at parameters, (n, 3)."""

    @cached_property
    def loops(self) -> tuple[Array, ...]:
        """Loops that bound the face, (m, 2) rows of (along, step)."""
        u0, u1, v0, v1 = self.face.bounds
        size = np.array([u1 - u0, v1 - v0]) / _EDGE
        return tuple(self.places(_divide(loop, size)) for loop in self.face.outline)

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Range of the face: along0, along1, step0, step1."""
        low, high = self.loops[0].min(axis=0), self.loops[0].max(axis=0)
        return float(low[0]), float(high[0]), float(low[1]), float(high[1])

    @property
    def rectangular(self) -> bool:
        """Whether the face fills its bounds."""
        return False

    def closed(self, step: Array) -> Bools:
        """Whether passes end where they began: never."""
        return np.zeros(len(step), dtype=bool)

    def clip(self, along: Array, step: Array) -> tuple[Array, Array]:
        """Parameters (n, 2) drawn back to the surface's own domain, and the feeds (n, 3) there.

        Parameters
        ----------
        along, step : (n,) array
        """
        low, high = np.array(self.face.surface.domain).T
        uv = np.clip(self.uv(along, step), low, high)
        return np.asarray(uv), self.feed_at(uv)


def _divide(loop: Array, size: Array) -> Array:
    """Corners of a closed loop, and even points between them, no farther apart than a size (2,) each way."""
    ahead = np.roll(loop, -1, axis=0)
    parts = np.maximum(np.ceil((np.abs(ahead - loop) / size).max(axis=1)), 1).astype(int)
    source, number = number_parts(parts)
    share = (number / parts[source])[:, None]
    return np.asarray(loop[source] + share * (ahead - loop)[source])
