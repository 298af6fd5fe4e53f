"""Strips no wider than the greatest step-over: what the scallop height would allow beyond it is not used."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot, unit
from toolaxis.path.parametrization import Chart, Cut
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: Share of the greatest step-over that passes are laid for: half widths are interpolated between measured lines.
KEPT = 0.99
#: How often a half width is shortened by the share that it is too long, and the share of the range of the step
#: parameter over which its pace is taken first.
_ROUNDS, _SMALL = 5, 1e-4
#: Half widths are shortened from so many times what the pace at the contact tells.
_FROM = 2.0


def limit_half_widths(chart: Chart, cut: Cut, along: Array, step: Array) -> Array:
    """Half widths of a chart (n, 2) in the step parameter, none of them beyond half the greatest step-over.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    along, step : (n,) array

    Notes
    -----
    The distance of a strip's border is measured across the pass, in the plane through the contact normal to the feed.
    """
    return _limit(chart, cut, (along, step), chart.half_widths(cut, along, step))


def limit_screen(chart: Chart, cut: Cut, along: Array, step: Array) -> Array:
    """About the two half widths together, (n,), in the step parameter, as `Chart.screen` tells them, within the same.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    along, step : (n,) array
    """
    width = chart.screen(cut, along, step)
    if not np.isfinite(cut.greatest_step_over):
        return width
    return np.asarray(_limit(chart, cut, (along, step), np.column_stack([width, width]) / 2).sum(axis=1))


def _limit(chart: Chart, cut: Cut, at: tuple[Array, Array], halves: Array) -> Array:
    most = KEPT * cut.greatest_step_over / 2
    if not np.isfinite(most) or not len(halves):
        return halves
    along, step = at
    _, _, s0, s1 = chart.bounds
    feed, start = _feeds(chart.face, chart, chart.uv(along, step)), chart.face.evaluate(chart.uv(along, step)).point

    def _away(shift: Array) -> Array:
        """Distances across the passes of places so far on in the step parameter, mm."""
        way = chart.face.evaluate(chart.uv(along, step + shift)).point - start
        return np.asarray(np.linalg.norm(way - dot(way, feed)[:, None] * feed, axis=1))

    found = halves.copy()
    for side, sense in ((0, -1.0), (1, 1.0)):
        small = np.full(len(step), _SMALL * (s1 - s0))
        pace = np.maximum(_away(sense * small) / small, 1e-12)
        reach = np.minimum(np.nan_to_num(halves[:, side], posinf=s1 - s0), _FROM * most / pace)
        for _ in range(_ROUNDS):
            reach = reach * np.minimum(most / np.maximum(_away(sense * reach), 1e-12), 1.0)
        found[:, side] = np.where(halves[:, side] > 0, np.minimum(halves[:, side], reach), halves[:, side])
    return found


def _feeds(face: Face, chart: Chart, uv: Array) -> Array:
    """Unit feed directions at parameters, (n, 3)."""
    feed = chart.feed_at(uv)
    if not isinstance(feed, str):
        return feed
    d = face.evaluate(uv)
    way = d.su if feed == "u" else d.sv
    size = np.linalg.norm(way, axis=1)[:, None]
    return np.asarray(unit(np.where(size > 0, way, (1.0, 0.0, 0.0))))
