"""Brute force over a grid of axes: the least exact count, with only those axes left out that a bound rules out.

On every pass the exact width at a few places is no less than at the narrowest one, which is what a count takes; so the
sum over passes from those places is no more than the count, but for the error of two quadratures, for which a margin
is left.  Some of the axes left out are counted after all, and the least share of count over bound is told: what was
left out is certain as long as it stays above one less the margin.
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.width import step_widths_many_axes
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.violations import FREE
from toolaxis.path.parametrization import IsoChart, rows
from toolaxis.path.pass_count import panels
from toolaxis.path.trim_intervals import RowPoints, row_points
from toolaxis.plan.choices import FEEDS
from toolaxis.search.cost import MachiningCost

Array = NDArray[np.float64]

#: What is left for the error of quadratures, as a share of the count.
MARGIN = 0.02
#: The same for a first bound from fewer passes and places, which spares most axes the better one.
_ROUGH_MARGIN = 0.12
_ROUGH, _FINE = (5, 4), (15, 12)
_BATCH, _AUDITED = 128, 100


@dataclass(frozen=True, eq=False)
class _PassPoints:
    """A few places on some passes with one feed: uv (n, 2), first place of each pass, weight of each pass, and whether
    a place continues the one before, (n,)."""

    uv: Array
    start: NDArray[np.intp]
    weight: Array
    joined: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Floor:
    """Lower bounds of the cutting length.

    Attributes
    ----------
    worth : MachiningCost
    size : (int, int)
        Passes on each smooth stretch, and gaps between places on a pass.
    """

    worth: MachiningCost
    size: tuple[int, int] = _FINE

    @cached_property
    def places(self) -> tuple[_PassPoints, _PassPoints]:
        """Places for feed u and v."""
        return _places(IsoChart(self.worth.face, "u"), self.size), _places(IsoChart(self.worth.face, "v"), self.size)

    def lengths(self, axes: Array) -> Array:
        """Lower bounds, (k, 2) mm, for feed u and v; inf where an axis leaves no strip at some place."""
        worth, out = self.worth, np.empty((len(axes), 2))
        for k, some in enumerate(self.places):
            halves = step_widths_many_axes(worth.face, worth.tool, some.uv, axes, worth.scallop, FEEDS[k],
                                           worth.allowance)
            width = np.where((halves > 0).all(axis=2), halves.sum(axis=2), 0.0)
            least = np.minimum.reduceat(width, some.start, axis=1)
            gap = np.linalg.norm(np.diff(self._tips(some.uv, axes), axis=1), axis=2) * some.joined[1:]
            run = np.add.reduceat(np.concatenate([np.zeros((len(axes), 1)), gap], axis=1), some.start, axis=1)
            rate = np.where(least > 0, 1 / np.where(least > 0, least, 1.0), np.inf)
            out[:, k] = (rate * run) @ some.weight
        return out

    def _tips(self, uv: Array, axes: Array) -> Array:
        """Tool tips (k, n, 3), but for a shift along the axis."""
        tool, face = self.worth.tool, self.worth.face
        normal, point = face.normal(uv), face.evaluate(uv).point
        across = normal - (axes @ normal.T)[..., None] * axes[:, None]
        size = np.linalg.norm(across, axis=2, keepdims=True)
        return (point + (tool.corner_radius + self.worth.allowance) * normal
                + tool.flat_radius * across / np.where(size > 0, size, 1.0))


def _places(chart: IsoChart, size: tuple[int, int]) -> _PassPoints:
    edges = panels(chart)
    nodes, weight = np.polynomial.legendre.leggauss(size[0])
    half = np.diff(edges)[:, None] / 2
    steps = ((edges[1:] + edges[:-1])[:, None] / 2 + half * nodes).ravel()
    a0, a1, _, _ = chart.bounds
    found = rows(chart, steps)
    points: RowPoints = row_points(found, (a1 - a0) / size[1])
    line = found.line[points.interval]
    met, start = np.unique(line, return_index=True)
    return _PassPoints(chart.uv(points.along, steps[line]), start, (half * weight).ravel()[met],
                       np.append(False, np.diff(points.interval) == 0))


@dataclass
class Least:
    """What brute force found: the least proven length and its axis and feed, and what it took.

    visible : axes of the grid that normals and limits allow;  counted : pairs of axis and feed;  left_out : pairs with
    their bounds;  lowest : least count over bound among the pairs counted, and `audited` ones of those left out.
    """

    length: float = np.inf
    axis: Array | None = None
    feed: int = 0
    visible: int = 0
    counted: int = 0
    left_out: list[tuple[Array, int, float]] = field(default_factory=list)
    audited: int = 0
    lowest: float = np.inf


def least_length(judged: Feasibility, worth: MachiningCost, grid: Array, full: bool = False) -> Least:
    """The least exact length over all axes of a grid that the proof form accepts.

    `full` counts every axis that screening leaves, bounds or not.
    """
    found, floor, rough = Least(), Floor(worth), Floor(worth, _ROUGH)
    axes = np.concatenate([some[judged.quick(some)[0] == FREE] for some in np.array_split(grid, 100)])
    found.visible = len(axes)
    if not len(axes):
        return found
    screened = np.concatenate([worth.screen(some).length.min(axis=1) for some in np.array_split(axes, 50)])
    axes = axes[np.argsort(screened, kind="stable")]
    for first in range(0, len(axes), _BATCH):
        some = axes[first:first + _BATCH]
        bounds = rough.lengths(some) * (1 - _ROUGH_MARGIN) / (1 - MARGIN)
        near = full | (bounds * (1 - MARGIN) < found.length).any(axis=1)
        if near.any():
            bounds[near] = floor.lengths(some[near])
        for axis, bound in zip(some, bounds, strict=True):
            open_ = [k for k in range(2) if full or bound[k] * (1 - MARGIN) < found.length]
            found.left_out += [(axis, k, float(bound[k])) for k in range(2) if k not in open_ and bound[k] < np.inf]
            if open_ and judged.screen(axis).reason[0] == FREE:
                for k in open_:
                    _take(judged, worth, found, (axis, k, float(bound[k])))
    return found


def _take(judged: Feasibility, worth: MachiningCost, found: Least, pair: tuple[Array, int, float]) -> None:
    """Count a pair of axis and feed, and keep it where it is the best and proven."""
    axis, k, bound = pair
    value = worth.counted(axis, FEEDS[k])[1]
    found.counted += 1
    if np.isfinite(bound):
        found.lowest = min(found.lowest, value / bound)
    if value < found.length and judged.witness(axis) is None:
        found.length, found.axis, found.feed = value, axis, k


def audit(worth: MachiningCost, found: Least) -> None:
    """Count some of the pairs that were left out, picked at random."""
    for i in np.random.default_rng(0).permutation(len(found.left_out))[:_AUDITED]:
        axis, k, bound = found.left_out[i]
        found.audited += 1
        found.lowest = min(found.lowest, worth.counted(axis, FEEDS[k])[1] / bound)
