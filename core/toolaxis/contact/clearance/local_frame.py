"""A cell seen from a tool: where its points stand to the axis.

Vectors are tuples of numbers here: they stay in registers.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.jit import jit_fma_inline
from toolaxis.numeric.triples import Triple, cross, dot

Array = NDArray[np.float64]
# q from the tip; the axis; a; b; c
Frame: TypeAlias = tuple[Triple, Triple, Triple, Triple, Triple]
# A, B, C: the cell's second-order form; how far the cell is from it at most
Bend: TypeAlias = tuple[Triple, Triple, Triple, float]
# rho, z, 1 / rho (0 on the axis), the direction outwards
View: TypeAlias = tuple[float, float, float, Triple]
# of a, b and c each: the parts outwards, along the axis and around it
Steps: TypeAlias = tuple[Triple, Triple, Triple]
Piece: TypeAlias = tuple[float, float, float, float, float, float, float]


@jit_fma_inline
def row(table: Array, k: int, first: int) -> Triple:
    """Three neighbours of a row."""
    return table[k, first], table[k, first + 1], table[k, first + 2]


@jit_fma_inline
def look(w: Triple, axis: Triple) -> View:
    """Where a point, seen from the tip, stands to the axis."""
    z = dot(w, axis)
    p = (w[0] - z * axis[0], w[1] - z * axis[1], w[2] - z * axis[2])
    rho = np.sqrt(dot(p, p))
    scale = 1.0 / rho if rho > 1e-12 else 0.0
    return rho, z, scale, (p[0] * scale, p[1] * scale, p[2] * scale)


@jit_fma_inline
def spread(frame: Frame, outwards: Triple) -> Steps:
    """Parts of a, b and c outwards, along the axis and around it."""
    _, axis, a, b, c = frame
    around = cross(axis, outwards)
    return ((dot(a, outwards), dot(a, axis), dot(a, around)), (dot(b, outwards), dot(b, axis), dot(b, around)),
            (dot(c, outwards), dot(c, axis), dot(c, around)))


@jit_fma_inline
def slopes_along(steps: Steps, rise: float, climb: float) -> Triple:
    """Slopes along a, b and c of a function with slopes ``rise`` along rho and ``climb`` along z."""
    a, b, c = steps
    return rise * a[0] + climb * a[1], rise * b[0] + climb * b[1], rise * c[0] + climb * c[1]
