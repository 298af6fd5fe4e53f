"""How far passes must go on past their ends, so that their whole strip is cut up to the border."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot
from toolaxis.path.greatest_step_over import limit_half_widths
from toolaxis.path.parametrization import Chart, Cut, tip_points

Array = NDArray[np.float64]

#: Points across the strip at an end, and contacts tried for each of them.
_ACROSS, _TRIED = 9, 65
#: Shares of the span before and behind an end at which contacts are tried.
_SHARES_TRIED = np.linspace(-1.0, 1.0, _TRIED)
#: A point counts as cut where it is no farther from the cutter than this share of the scallop height.
_SHARE = 2e-3


def overrun_length(chart: Chart, cut: Cut, end: Array, step: Array, forward: bool) -> Array:
    """Along parameter that passes must go on past their ends, (n,), zero or more.

    With an axis that leans across the feed, the edges of a strip are cut from contacts well before or behind them:
    what has to be reached are the contacts that cut the points at scallop height over the strip's end.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    end, step : (n,) array
        Where the passes end, on the face.
    forward : bool
        Whether the passes go on towards greater values of the along parameter.
    """
    if len(end) == 0:
        return np.zeros(0)
    a0, a1, _, _ = chart.bounds
    targets = _points_over_strip(chart, cut, end, step)
    span = _span(chart, cut, end, step, a1 - a0)
    direction = 1.0 if forward else -1.0
    along = (end[:, None] + (direction * span)[:, None] * _SHARES_TRIED).ravel()
    steps = np.repeat(step, _TRIED)
    _, tips, _ = tip_points(chart, cut, along, steps)
    axes = np.broadcast_to(cut.axes(chart.face, chart.uv(along, steps)), tips.shape)
    # Every target of an end against every contact tried for it.
    target_rows = targets.reshape(len(end), _ACROSS, 1, 3)
    tip_rows = tips.reshape(len(end), 1, _TRIED, 3)
    off = _distances(cut, target_rows - tip_rows, axes.reshape(tip_rows.shape))
    return _first_cut(off, cut.scallop) * span


def _points_over_strip(chart: Chart, cut: Cut, end: Array, step: Array) -> Array:
    """Points at scallop height across the strips' ends, (n * _ACROSS, 3)."""
    _, _, s0, s1 = chart.bounds
    halves = limit_half_widths(chart, cut, end, step)
    share = np.linspace(-1.0, 1.0, _ACROSS)
    half_width = np.where(share < 0, halves[:, :1], halves[:, 1:])
    half_width = np.nan_to_num(half_width, posinf=0.0)
    across = np.clip(step[:, None] + half_width * share, s0, s1)
    return _targets(chart, cut, np.repeat(end, _ACROSS), across.ravel())


def _targets(chart: Chart, cut: Cut, along: Array, step: Array) -> Array:
    """Points at scallop height over the face, (n, 3)."""
    uv = chart.uv(along, step)
    surface = chart.face.evaluate(uv)
    height = cut.scallop + cut.allowance
    return np.asarray(surface.point + height * chart.face.normal(uv, surface))


def _span(chart: Chart, cut: Cut, end: Array, step: Array, whole: float) -> Array:
    """Along parameter that a cutter's diameter takes up at the ends, (n,)."""
    small = 1e-4 * whole
    before = chart.face.evaluate(chart.uv(end - small, step)).point
    behind = chart.face.evaluate(chart.uv(end + small, step)).point
    speed = np.linalg.norm(behind - before, axis=1) / (2 * small)
    diameter = 2 * (cut.tool.radius + cut.scallop)
    return np.asarray(diameter / np.maximum(speed, 1e-9 / whole))


def _distances(cut: Cut, relative: Array, axes: Array) -> Array:
    """Signed distances of points relative to the tip from the cutter with its axis, mm."""
    points = relative.reshape(-1, 3)
    axis_rows = np.broadcast_to(axes, relative.shape).reshape(-1, 3)
    z = dot(points, axis_rows)
    rho = np.sqrt(np.maximum(dot(points, points) - z**2, 0.0))
    local = np.column_stack([rho, np.zeros(len(points)), z])
    distances = cut.tool.distance(local, "cutter").value
    return np.asarray(distances.reshape(relative.shape[:-1]))


def _first_cut(off: Array, scallop: float) -> Array:
    """Share of the span to the first contact by which every point is cut, from distances (n, points, contacts)."""
    least_so_far = np.minimum.accumulate(off, axis=2)
    least_of_all = least_so_far[..., -1:]
    is_cut = least_so_far <= np.maximum(least_of_all, 0.0) + _SHARE * scallop
    first = np.argmax(is_cut, axis=2).max(axis=1)
    return np.asarray(np.maximum(_SHARES_TRIED[first], 0.0))
