"""Curves around a contact as tables: exact nodes, cubic interpolation between them.

Nodes serve all axes.  Of the pass they are the centres that the corner's circle touches, S + (r + A) n, and the
normals; of the cross curve the points that the scallop may reach, S + (h + A) n.  What tables lead to is made exact on
the surface itself.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.curves import (
    CurvePoint,
    Moving,
    OrientedSurface,
    Scratch,
    SurfaceCurve,
    curve_point,
    offset_point,
    read_moving,
    store_moving,
)
from toolaxis.contact.strip.cutter_parameters import CutterParameters
from toolaxis.contact.strip.swept_cutter import place_tip
from toolaxis.numeric.jit import jit_uncounted_inline
from toolaxis.numeric.triples import Triple, combine, dot, plus

Array = NDArray[np.float64]

#: Row of the contact: most nodes on either side of it.
MIDDLE = 16
#: Distance of the nodes next to the contact, of those farther away, and by how much it grows; in radii of the tool.
_CLOSE, _WIDEST, _GROWTH, _FIRST_CLOSE = 1 / 6, 0.45, 1.3, 3


class CurveNodes(NamedTuple):
    """Nodes of a curve in the order of its parameter: rows of a point offset from the surface and of the normal."""

    w: Array
    offset: Array
    """Point and its rate."""
    normal: Array
    """Normal and its rate."""


class TabulatedCurve(NamedTuple):
    """A curve with its nodes, and the rows of the first and the last one."""

    curve: SurfaceCurve
    nodes: CurveNodes
    first: int
    last: int


def new_curve_nodes() -> CurveNodes:
    """Memory for the nodes of a curve."""
    rows = 2 * MIDDLE + 1
    return CurveNodes(np.empty(rows), np.empty((rows, 6)), np.empty((rows, 6)))


@jit_uncounted_inline
def tabulate_curve(surface: OrientedSurface, curve: SurfaceCurve, sizes: tuple[float, float, float],
                   nodes: CurveNodes, scratch: Scratch) -> TabulatedCurve:
    """Nodes of a curve on either side of the contact, which is row MIDDLE.

    Parameters
    ----------
    surface, curve
    sizes : (radius, offset, length)
        Radius of the tool, height above the surface, length to either side; mm.
    nodes, scratch
    """
    radius, offset, length = sizes
    at = curve_point(surface, curve, 0.0, scratch)
    start = _store_node(nodes, MIDDLE, 0.0, at, offset)
    first = last = MIDDLE
    for side in (-1, 1):
        w, row, gone, step, pace = 0.0, MIDDLE, 0.0, _CLOSE * radius, start
        while gone < length and 0 < row < 2 * MIDDLE and pace > 1e-300:
            row += side
            w += side * step / pace
            gone += step
            if abs(row - MIDDLE) >= _FIRST_CLOSE:
                step = min(step * _GROWTH, _WIDEST * radius)
            pace = _store_node(nodes, row, w, curve_point(surface, curve, w, scratch), offset)
        first, last = min(first, row), max(last, row)
    return TabulatedCurve(curve, nodes, first, last)


@jit_uncounted_inline
def _store_node(nodes: CurveNodes, k: int, w: float, at: CurvePoint, offset: float) -> float:
    """Fill a row; the rate of the curve, mm per unit of its parameter."""
    nodes.w[k] = w
    store_moving(nodes.offset, k, offset_point(at, offset))
    store_moving(nodes.normal, k, Moving(at.normal, at.turn))
    return sqrt(dot(at.tangent, at.tangent))


@jit_uncounted_inline
def find_interval(table: TabulatedCurve, near: int, w: float) -> int:
    """The row k with w between the nodes k and k + 1, by steps from a row near to it."""
    nodes = table.nodes.w
    k = min(max(near, table.first), table.last - 1)
    while k > table.first and w < nodes[k]:
        k -= 1
    while k < table.last - 1 and w >= nodes[k + 1]:
        k += 1
    return k


@jit_uncounted_inline
def interpolate(nodes: Array, table: Array, k: int, w: float) -> Moving:
    """The cubic between the nodes k and k + 1, at w."""
    here, ahead = read_moving(table, k), read_moving(table, k + 1)
    size = nodes[k + 1] - nodes[k]
    t = (w - nodes[k]) / size
    u = 1.0 - t
    step = plus(ahead.point, here.point, -1.0)
    point = combine(here.rate, t * u * u * size, ahead.rate, -t * t * u * size)
    rate = combine(here.rate, u * (1.0 - 3.0 * t), ahead.rate, t * (3.0 * t - 2.0))
    return Moving(plus(here.point, plus(point, step, t * t * (3.0 - 2.0 * t)), 1.0),
                  plus(rate, step, 6.0 * t * u / size))


@jit_uncounted_inline
def tip_at_node(cutter: CutterParameters, axis: Triple, nodes: CurveNodes, k: int) -> Moving:
    """The tip for the contact at a node of the pass."""
    return place_tip(cutter, axis, read_moving(nodes.offset, k), read_moving(nodes.normal, k))


@jit_uncounted_inline
def tip_between_nodes(cutter: CutterParameters, axis: Triple, nodes: CurveNodes, k: int, w: float) -> Moving:
    """The tip for the contact at w of the pass, between the nodes k and k + 1."""
    return place_tip(cutter, axis, interpolate(nodes.w, nodes.offset, k, w), interpolate(nodes.w, nodes.normal, k, w))
