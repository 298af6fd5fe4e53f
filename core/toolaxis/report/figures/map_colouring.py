"""Colours of sub-surfaces: few, pale, and different on both sides of a border."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan

Array = NDArray[np.float64]

#: Sky blue, orange, green, yellow, purple, blue and vermilion that stay apart for colour-blind eyes (Okabe and Ito).
_NAMES = ("#56B4E9", "#E69F00", "#009E73", "#F0E442", "#CC79A7", "#0072B2", "#D55E00")


def _pale(name: str) -> tuple[float, float, float]:
    red, green, blue = (int(name[k:k + 2], 16) / 255 for k in (1, 3, 5))
    return 0.45 + 0.55 * red, 0.45 + 0.55 * green, 0.45 + 0.55 * blue


#: The same paler, so that lines stand out on them; red, green and blue from 0 to 1.
COLOURS = tuple(map(_pale, _NAMES))
_NO_AXIS = (0.56, 0.56, 0.56)


def colour_map(operations: Sequence[Operation]) -> list[int]:
    """A number for each sub-surface, below 7, so that those that touch have different ones where that many allow it.

    Parameters
    ----------
    operations : sequence of Operation
    """
    borders = [_border(op) for op in operations]
    low = np.array([border.points.min(axis=0) for border in borders]).reshape(-1, 3)
    high = np.array([border.points.max(axis=0) for border in borders]).reshape(-1, 3)
    chosen: list[int] = []
    for k, border in enumerate(borders):
        near = 0.01 * operations[k].face.diagonal
        boxes_touch = ((low[:k] <= high[k] + near) & (high[:k] >= low[k] - near)).all(axis=1)
        beside = {chosen[other] for other in np.flatnonzero(boxes_touch) if border.touches(borders[other], near)}
        order = [(k + step) % len(COLOURS) for step in range(len(COLOURS))]
        chosen.append(next((colour for colour in order if colour not in beside), order[0]))
    return chosen


class _BorderPoints(NamedTuple):
    """Points along an outline, (n, 3) mm, and a tree of them."""

    tree: cKDTree
    points: Array

    def touches(self, other: "_BorderPoints", near: float) -> bool:
        """Whether some point of one lies near a point of the other."""
        for one, points in ((other.tree, self.points), (self.tree, other.points)):
            distances, _ = one.query(points, distance_upper_bound=near)
            if (distances <= near).any():
                return True
        return False


def _border(op: Operation) -> _BorderPoints:
    """Points along the outline, as many on each edge."""
    share = np.linspace(0.0, 1.0, 24, endpoint=False)[:, None]
    points = []
    for loop in op.face.outline:
        for start, end in zip(loop, np.roll(loop, -1, axis=0), strict=True):
            points.append(op.face.evaluate(start + share * (end - start)).point)
    rows = np.concatenate(points)
    return _BorderPoints(cKDTree(rows), rows)


def colours_of(plan: Plan) -> dict[int, tuple[float, float, float]]:
    """The colour of each operation's sub-surface by its number: grey where it has no path, that of the original for a
    turned copy.

    Parameters
    ----------
    plan : Plan
    """
    copies = {} if plan.blades is None else plan.blades.copies
    own = [op for op in plan.operations if op.number not in copies]
    numbers = colour_map(own) if own else []
    found = {op.number: COLOURS[k] for op, k in zip(own, numbers, strict=True)}
    colours = {}
    for op in plan.operations:
        original = copies.get(op.number, op.number)
        colours[op.number] = found[original] if op.done else _NO_AXIS
    return colours
