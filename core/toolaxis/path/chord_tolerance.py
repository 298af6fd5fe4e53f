"""Points along curves, close enough that no chord of contacts, tips or moving axes leaves them by the tolerance."""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.placement import tips
from toolaxis.numeric.blocks import in_blocks
from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.vectors import unit
from toolaxis.path.parametrization import Chart, Cut, tip_points

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_FIRST_GAPS = 4
_ROUNDS = 12
#: Gaps shorter than this share of the face are not divided: where chords still leave the curve there, the normal jumps,
#: and one of the motions has the jump in it however many there are.
_LEAST_GAP = 1e-7
#: Inner places of a gap at which the curve is looked at: so many at least, more in gaps that are longer than the
#: surface's own stretches between knots, within which a bulge would be overlooked, and so many at most.
_LEAST_PROBES, _MOST_PROBES = 3, 48
#: Inner places of a motion between points, as shares.
_QUARTERS = np.array([0.25, 0.5, 0.75])
#: Gaps, or motions, that are looked at together.
_GAPS = 20_000


def follow(chart: Chart, cut: Cut, pieces: Array, chord: float) -> tuple[Index, Array]:
    """Values of the along parameter for each piece of a pass.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    pieces : (m, 3) array
        along0, along1, step of each piece.
    chord : float
        Chord tolerance, mm, kept by the polylines through contacts and tips, and where the axis moves through points
        on it as far from the tip as the cutter is wide, but where the surface's normal jumps.

    Returns
    -------
    piece : (n,) array of int
    along : (n,) array
        Sorted by piece, then increasing; both ends included.
    """
    a0, a1, _, _ = chart.bounds
    least = _LEAST_GAP * (a1 - a0)
    surface = chart.face.surface.stand_in or chart.face.surface
    most_breaks = max(map(len, surface.breaks))
    stretch = (a1 - a0) / (1 + most_breaks)
    share = np.linspace(0.0, 1.0, _FIRST_GAPS + 1)
    begin = pieces[:, :1]
    end = pieces[:, 1:2]
    ends = begin + (end - begin) * share
    owner = np.repeat(np.arange(len(pieces)), _FIRST_GAPS)
    low = ends[:, :-1].ravel()
    high = ends[:, 1:].ravel()
    done_owner = [np.arange(len(pieces))]
    done_low = [pieces[:, 1]]
    for _ in range(_ROUNDS):
        if not len(owner):
            break
        longest = float((high - low).max())
        probes = _probes(longest / stretch)
        deviations = partial(_deviations, chart, cut, probes)
        at_once = max(_GAPS * _LEAST_PROBES // len(probes), 1)
        away = in_blocks(deviations, low, high, pieces[owner, 2], size=at_once)
        wanted = np.ceil(1.05 * np.sqrt(away / chord))
        possible = np.ceil((high - low) / least)
        parts = np.minimum(wanted, possible)
        fine = parts <= 1.05
        done_owner.append(owner[fine])
        done_low.append(low[fine])
        coarse = ~fine
        new_parts = np.clip(parts[coarse], 2, 64).astype(int)
        owner, low, high = _divide(owner[coarse], low[coarse], high[coarse], new_parts)
    done_owner.append(owner)
    done_low.append(low)
    piece = np.concatenate(done_owner)
    along = np.concatenate(done_low)
    order = np.lexsort((along, piece))
    return piece[order], along[order]


def _probes(stretches: float) -> Array:
    """Inner places of gaps that are as long as so many stretches between knots, as shares."""
    number = np.clip(np.ceil(stretches), _LEAST_PROBES, _MOST_PROBES)
    number = int(number)
    return np.arange(1, number + 1) / (number + 1)


def rises(chart: Chart, cut: Cut, steps: Array, points: tuple[Index, Array], tip: Array) -> Array:
    """How deep points are set so that no straight motion between them stays above the pass, (n,) mm.

    Between two points on a hollow stretch a straight motion stays above the pass by what `follow` allows, and would
    leave so much more than the scallop height.  Points there are set deeper by as much: what the motion between them
    stays above the pass then, it does not stay above the surface.  So all of the chord tolerance goes into the
    machining tolerance, at the points of hollow stretches and between those of others, and none into the scallop.

    Parameters
    ----------
    chart : Chart
    cut : Cut
    steps : (n,) array
        Step of the pass that each point belongs to.
    points : (n,) array of int, (n,) array
        Pieces and values of the along parameter, from `follow`.
    tip : (n, 3) array
        Tips there, mm.
    """
    piece, along = points
    deeper = np.zeros(len(along))
    first = np.flatnonzero(piece[1:] == piece[:-1])
    if not len(first):
        return deeper
    after = first + 1
    heights = partial(_heights_over, chart, cut)
    above = in_blocks(heights, along[first], along[after], steps[first], tip[first], tip[after], size=_GAPS)
    np.maximum.at(deeper, first, above)
    np.maximum.at(deeper, after, above)
    return deeper


def _heights_over(chart: Chart, cut: Cut, low: Array, high: Array, step: Array, begin: Array, end: Array) -> Array:
    """How far straight motions of the tip from begin to end, at low and high, stay above the pass at most, (m,) mm."""
    along = low[:, None] + (high - low)[:, None] * _QUARTERS
    contact, _, normal = tip_points(chart, cut, along.ravel(), np.repeat(step, len(_QUARTERS)))
    axis_before = cut.axes(chart.face, chart.uv(low, step))
    axis_after = cut.axes(chart.face, chart.uv(high, step))
    axis_before = np.broadcast_to(axis_before, begin.shape)
    axis_after = np.broadcast_to(axis_after, begin.shape)
    axes = unit(_between(axis_before, axis_after))
    touching = tips(contact, normal, axes, cut.tool, cut.allowance)
    off = _between(begin, end) - touching
    above = (off * normal).sum(axis=1)
    return np.asarray(above.reshape(len(low), -1).max(axis=1))


def _between(begin: Array, end: Array) -> Array:
    """Places of straight motions from begin (m, 3) to end, one motion after the other, (m k, 3)."""
    way = end - begin
    places = begin[:, None] + way[:, None] * _QUARTERS[:, None]
    return np.asarray(places).reshape(-1, 3)


def _divide(owner: Index, low: Array, high: Array, parts: NDArray[np.int64]) -> tuple[Index, Array, Array]:
    source, number = number_parts(parts)
    gap = ((high - low) / parts)[source]
    begin = low[source]
    lower = begin + number * gap
    upper = begin + (number + 1) * gap
    return owner[source], lower, upper


def _deviations(chart: Chart, cut: Cut, probes: Array, low: Array, high: Array, step: Array) -> Array:
    """Greatest distance of what is followed from the chords at inner places of each gap, mm."""
    places = np.concatenate([[0.0], probes, [1.0]])
    along = (low[:, None] + (high - low)[:, None] * places).ravel()
    steps = np.repeat(step, len(places))
    contact, tip, _ = tip_points(chart, cut, along, steps)
    curves = [contact, tip]
    axes = cut.axes(chart.face, chart.uv(along, steps))
    if axes.ndim > 1:
        curves.append(tip + 2 * cut.tool.radius * axes)
    worst = np.zeros(len(low))
    for curve in curves:
        nodes = curve.reshape(len(low), len(places), 3)
        away = _distances_from_chords(nodes)
        worst = np.maximum(worst, away.max(axis=1))
    return worst


def _distances_from_chords(nodes: Array) -> Array:
    """Distances of inner nodes (n, k, 3) from the straight line between the first and the last one, (n, k - 2)."""
    start = nodes[:, :1]
    line = nodes[:, -1:] - start
    square = np.maximum((line**2).sum(axis=2), np.finfo(float).tiny)
    inner = nodes[:, 1:-1] - start
    share = (inner * line).sum(axis=2) / square
    share = np.clip(share, 0.0, 1.0)
    return np.asarray(np.linalg.norm(inner - share[..., None] * line, axis=2))
