"""Colours of sub-surfaces: few, pale, and different on both sides of a border."""

from collections.abc import Sequence

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
    low, high = (np.array([end(points, axis=0) for _, points in borders]).reshape(-1, 3) for end in (np.min, np.max))
    chosen: list[int] = []
    for k, (tree, points) in enumerate(borders):
        near = 0.01 * operations[k].face.diagonal
        around = np.flatnonzero(((low[:k] <= high[k] + near) & (high[:k] >= low[k] - near)).all(axis=1))
        beside = {chosen[other] for other in around
                  if (borders[other][0].query(points, distance_upper_bound=near)[0] <= near).any()
                  or (tree.query(borders[other][1], distance_upper_bound=near)[0] <= near).any()}
        order = [(k + step) % len(COLOURS) for step in range(len(COLOURS))]
        chosen.append(next((colour for colour in order if colour not in beside), order[0]))
    return chosen


def _border(op: Operation) -> tuple[cKDTree, Array]:
    """Points along the outline, about as many on each edge, and a tree of them."""
    share = np.linspace(0.0, 1.0, 24, endpoint=False)[:, None]
    points = [op.face.evaluate(start + share * (end - start)).point
              for loop in op.face.outline for start, end in zip(loop, np.roll(loop, -1, axis=0), strict=True)]
    rows = np.concatenate(points)
    return cKDTree(rows), rows


def colours_of(plan: Plan) -> dict[int, tuple[float, float, float]]:
    """The colour of each operation's sub-surface by its number: grey where it has no path, that of the original for a
    turned copy.

    Parameters
    ----------
    plan : Plan
    """
    copies = {} if plan.blades is None else plan.blades.copies
    own = [op for op in plan.operations if op.number not in copies]
    found = {op.number: COLOURS[k] for op, k in zip(own, colour_map(own) if own else (), strict=True)}
    return {op.number: found[copies.get(op.number, op.number)] if op.done else _NO_AXIS for op in plan.operations}
