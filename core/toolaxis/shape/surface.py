"""The protocol that every surface keeps, and the derivatives it answers with."""

from typing import NamedTuple, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Domain: TypeAlias = tuple[tuple[float, float], tuple[float, float]]


class Derivatives(NamedTuple):
    """Position and derivatives at n parameters, each (n, 3), mm per unit of parameter."""

    point: Array
    su: Array
    sv: Array
    suu: Array
    suv: Array
    svv: Array


class Surface(Protocol):
    """A surface that can be evaluated on whole arrays of parameters."""

    @property
    def domain(self) -> Domain:
        """Ranges of u and v."""

    def evaluate(self, uv: Array) -> Derivatives:
        """Position and derivatives up to the second order at (n, 2) parameters."""
