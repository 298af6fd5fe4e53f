"""How far passes must go on past their ends, so that their whole strip is cut up to the border."""

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.vectors import dot
from toolaxis.path.greatest_step_over import limit_half_widths
from toolaxis.path.parametrization import Chart, Cut, tip_points

Array = NDArray[np.float64]

#: Points across the strip at an end, and contacts tried for each of them.
_ACROSS, _TRIED = 9, 65
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
    a0, a1, s0, s1 = chart.bounds
    halves = limit_half_widths(chart, cut, end, step)
    share = np.linspace(-1.0, 1.0, _ACROSS)
    wide = np.where(share < 0, halves[:, :1], halves[:, 1:])
    across = np.clip(step[:, None] + np.nan_to_num(wide, posinf=0.0) * share, s0, s1)
    targets = _targets(chart, cut, np.repeat(end, _ACROSS), across.ravel())
    span = _span(chart, cut, end, step, a1 - a0) * (1.0 if forward else -1.0)
    tried = (end[:, None] + span[:, None] * np.linspace(-1.0, 1.0, _TRIED)).ravel()
    steps = np.repeat(step, _TRIED)
    _, tips, _ = tip_points(chart, cut, tried, steps)
    axes = np.broadcast_to(cut.axes(chart.face, chart.uv(tried, steps)), tips.shape)
    # Every target of an end against every contact tried for it.
    target_rows = targets.reshape(len(end), _ACROSS, 1, 3)
    tip_rows = tips.reshape(len(end), 1, _TRIED, 3)
    off = _distances(cut, target_rows - tip_rows, axes.reshape(tip_rows.shape))
    return _first_cut(off, cut.scallop) * np.abs(span)


def _targets(chart: Chart, cut: Cut, along: Array, step: Array) -> Array:
    """Points at scallop height over the face, (n, 3)."""
    uv = chart.uv(along, step)
    at = chart.face.evaluate(uv)
    return np.asarray(at.point + (cut.scallop + cut.allowance) * chart.face.normal(uv, at))


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
    rows = relative.reshape(-1, 3)
    z = dot(rows, np.broadcast_to(axes, relative.shape).reshape(-1, 3))
    rho = np.sqrt(np.maximum(dot(rows, rows) - z**2, 0.0))
    local = np.column_stack([rho, np.zeros(len(rows)), z])
    return np.asarray(cut.tool.distance(local, "cutter").value.reshape(relative.shape[:-1]))


def _first_cut(off: Array, scallop: float) -> Array:
    """Share of the span to the first contact by which every point is cut, from distances (n, points, contacts)."""
    least = np.minimum.accumulate(off, axis=2)
    enough = least <= np.maximum(least[..., -1:], 0.0) + _SHARE * scallop
    first = np.argmax(enough, axis=2).max(axis=1)
    shares = np.linspace(-1.0, 1.0, off.shape[2])
    return np.asarray(np.maximum(shares[first], 0.0))
