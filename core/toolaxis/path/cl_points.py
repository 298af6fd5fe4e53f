"""From places of passes to a tool path: order, direction, points and links."""

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.path.links import CuttingMove, Linking, link
from toolaxis.path.parametrization import Chart, Cut
from toolaxis.path.pass_layout import Layout
from toolaxis.path.stroke_order import ZIGZAG, order_strokes

Array = NDArray[np.float64]
Move = TypeVar("Move", bound=CuttingMove)

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
    a = (a0 + a1) / 2
    s = (s0 + s1) / 2
    da = (a1 - a0) * 1e-4
    ds = (s1 - s0) * 1e-4
    along = np.array([a - da, a + da, a, a])
    step = np.array([s, s, s - ds, s + ds])
    before, ahead, machined, uncut = chart.face.evaluate(chart.uv(along, step)).point
    right = np.cross(ahead - before, cut.axis)
    towards_uncut = float(right @ (uncut - machined))
    return 1 if towards_uncut >= 0 else -1


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
    passes = order_moves(moves, layout, direction)
    return link(passes, layout.cut.axis, linking or Linking(_crossing(layout, box)))


def order_moves(moves: Sequence[Move], layout: Layout, direction: str) -> list[list[Move]]:
    """The passes, or the parts of passes that are cut one after the other, in the order and the sense of cutting.

    Parameters
    ----------
    moves : sequence of CuttingMove
        Along each piece of the layout, in the sense of its along parameter.
    layout : Layout
    direction : str
        One of `DIRECTIONS`.
    """
    sense = None
    if direction != ZIGZAG:
        climb = climbing(layout.chart, layout.cut)
        sense = climb if direction == "climb" else -climb
    tips = [move.tip for move in moves]
    passes: list[list[Move]] = []
    for strokes in order_strokes(tips, layout.pieces, layout.owner, sense):
        passes.append([])
        for stroke in strokes:
            move = moves[stroke.number]
            passes[-1].append(move if stroke.sense > 0 else move.backwards)
    return passes


def _crossing(layout: Layout, box: ArrayLike | None, above: float = 5.0) -> float:
    """Height along the axis at which the tip is above every corner of the box."""
    corners = layout.chart.face.box if box is None else box
    low, high = np.asarray(corners, dtype=float)
    axis = layout.cut.axis
    highest = float(np.maximum(low * axis, high * axis).sum())
    return highest + above
