"""From places of passes to a tool path: order, direction, points and links."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.path.links import CuttingMove, Linking, link
from toolaxis.path.parametrization import Chart, Cut
from toolaxis.path.pass_layout import Layout
from toolaxis.path.stroke_order import ZIGZAG, OrderedStroke, order_strokes

Array = NDArray[np.float64]

DIRECTIONS = (ZIGZAG, "climb", "conventional")


def climbing(chart: Chart, cut: Cut) -> int:
    """Sense of the along parameter, 1 or -1, in which a pass climbs.

    A cutter that turns clockwise as seen from the spindle (M3) climbs where the material still to be cut lies on its
    right, f x T.  Passes proceed in increasing step parameter, so that is where the material lies.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    """
    a0, a1, s0, s1 = chart.bounds
    a, s = (a0 + a1) / 2, (s0 + s1) / 2
    da, ds = (a1 - a0) * 1e-4, (s1 - s0) * 1e-4
    along = np.array([a - da, a + da, a, a])
    step = np.array([s, s, s - ds, s + ds])
    before, ahead, machined, uncut = chart.face.evaluate(chart.uv(along, step)).point
    right = np.cross(ahead - before, cut.axis)
    return 1 if float(right @ (uncut - machined)) >= 0 else -1


def trace(layout: Layout, chord: float, direction: str = "zigzag", box: ArrayLike | None = None,
          linking: Linking | None = None) -> ToolPath:
    """Trace passes as a tool path.

    Parameters
    ----------
    layout : Layout
    chord : float
        How far straight motions may leave passes, mm.
    direction : str
        "zigzag" (every other pass back), "climb" or "conventional" (all one way, see `climbing`).
    box : (2, 3) array_like, optional
        Corners of the box that links cross above; the face's own unless given.
    linking : Linking, optional
        How strokes are joined; by default 5 mm above the box.

    Returns
    -------
    ToolPath

    Raises
    ------
    InvalidInput
        When the direction is none of the three.
    """
    if direction not in DIRECTIONS:
        raise InvalidInput(f"direction is {direction!r}: it must be one of {', '.join(DIRECTIONS)}")
    moves = [one.move for one in layout.traced.trace(layout.chart, layout.cut, layout.pieces, chord)]
    order = order_pieces([move.tip for move in moves], layout, direction)
    passes = [[moves[one.number] if one.sense > 0 else _back(moves[one.number]) for one in some] for some in order]
    return link(passes, layout.cut.axis, linking or Linking(_crossing(layout, box)))


def order_pieces(tips: Sequence[Array], layout: Layout, direction: str) -> list[list[OrderedStroke]]:
    """Passes, or the parts of passes that are cut one after the other, with their pieces in the order of cutting.

    Parameters
    ----------
    tips : sequence of n arrays (k, 3)
        Tips along each piece of the layout, mm.
    layout : Layout
    direction : str
        One of `DIRECTIONS`.
    """
    sense = None
    if direction != ZIGZAG:
        climb = climbing(layout.chart, layout.cut)
        sense = climb if direction == "climb" else -climb
    return order_strokes(tips, layout.pieces, layout.owner, sense)


def _back(stroke: CuttingMove) -> CuttingMove:
    return CuttingMove(stroke.contact[::-1], stroke.tip[::-1], stroke.normal[::-1])


def _crossing(layout: Layout, box: ArrayLike | None, above: float = 5.0) -> float:
    """Height along the axis at which the tip is above every corner of the box."""
    low, high = np.asarray(layout.chart.face.box if box is None else box, dtype=float)
    axis = layout.cut.axis
    return float(np.maximum(low * axis, high * axis).sum()) + above
