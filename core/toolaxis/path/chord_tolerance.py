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
    share = np.linspace(0.0, 1.0, _FIRST_GAPS + 1)
    least = _LEAST_GAP * (chart.bounds[1] - chart.bounds[0])
    surface = chart.face.surface.stand_in or chart.face.surface
    stretch = (chart.bounds[1] - chart.bounds[0]) / (1 + max(map(len, surface.breaks)))
    ends = pieces[:, :1] + (pieces[:, 1:2] - pieces[:, :1]) * share
    owner = np.repeat(np.arange(len(pieces)), _FIRST_GAPS)
    low = ends[:, :-1].ravel()
    high = ends[:, 1:].ravel()
    done_owner = [np.arange(len(pieces))]
    done_low = [pieces[:, 1]]
    for _ in range(_ROUNDS):
        if not len(owner):
            break
        probes = _probes(float((high - low).max()) / stretch)
        away = in_blocks(partial(_deviations, chart, cut, probes), low, high, pieces[owner, 2],
                         size=max(_GAPS * _LEAST_PROBES // len(probes), 1))
        parts = np.minimum(np.ceil(1.05 * np.sqrt(away / chord)), np.ceil((high - low) / least))
        fine = parts <= 1.05
        done_owner.append(owner[fine])
        done_low.append(low[fine])
        owner, low, high = _divide(owner[~fine], low[~fine], high[~fine], np.clip(parts[~fine], 2, 64).astype(int))
    done_owner.append(owner)
    done_low.append(low)
    piece = np.concatenate(done_owner)
    along = np.concatenate(done_low)
    order = np.lexsort((along, piece))
    return piece[order], along[order]


def _probes(stretches: float) -> Array:
    """Inner places of gaps that are as long as so many stretches between knots, as shares."""
    count = int(np.clip(np.ceil(stretches), _LEAST_PROBES, _MOST_PROBES))
    return np.arange(1, count + 1) / (count + 1)


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
    above = in_blocks(lambda *gaps: _heights_over(chart, cut, *gaps), along[first], along[first + 1], steps[first],
                      tip[first], tip[first + 1], size=_GAPS)
    for end in (first, first + 1):
        np.maximum.at(deeper, end, above)
    return deeper


def _heights_over(chart: Chart, cut: Cut, low: Array, high: Array, step: Array, begin: Array, end: Array) -> Array:
    """How far straight motions of the tip from begin to end, at low and high, stay above the pass at most, (m,) mm."""
    along = (low[:, None] + (high - low)[:, None] * _QUARTERS).ravel()
    contact, _, normal = tip_points(chart, cut, along, np.repeat(step, len(_QUARTERS)))
    axis_before, axis_after = (np.broadcast_to(cut.axes(chart.face, chart.uv(place, step)), begin.shape)
                               for place in (low, high))
    axes = unit(_between(axis_before, axis_after))
    touching = tips(contact, normal, axes, cut.tool, cut.allowance)
    above = ((_between(begin, end) - touching) * normal).sum(axis=1)
    return np.asarray(above.reshape(len(low), -1).max(axis=1))


def _between(begin: Array, end: Array) -> Array:
    """Places of straight motions from begin (m, 3) to end, one motion after the other, (m k, 3)."""
    return np.asarray(begin[:, None] + (end - begin)[:, None] * _QUARTERS[:, None]).reshape(-1, 3)


def _divide(owner: Index, low: Array, high: Array, parts: NDArray[np.int64]) -> tuple[Index, Array, Array]:
    source, number = number_parts(parts)
    gap = ((high - low) / parts)[source]
    begin = low[source]
    return owner[source], begin + number * gap, begin + (number + 1) * gap


def _deviations(chart: Chart, cut: Cut, probes: Array, low: Array, high: Array, step: Array) -> Array:
    """Greatest distance of what is followed from the chords at inner places of each gap, mm."""
    places = np.concatenate([[0.0], probes, [1.0]])
    along = (low[:, None] + (high - low)[:, None] * places).ravel()
    steps = np.repeat(step, len(places))
    contact, tip, _ = tip_points(chart, cut, along, steps)
    axes = cut.axes(chart.face, chart.uv(along, steps))
    worst = np.zeros(len(low))
    for curve in (contact, tip) if axes.ndim == 1 else (contact, tip, tip + 2 * cut.tool.radius * axes):
        nodes = curve.reshape(len(low), len(places), 3)
        start, line = nodes[:, :1], nodes[:, -1:] - nodes[:, :1]
        square = np.maximum((line**2).sum(axis=2), np.finfo(float).tiny)
        inner = nodes[:, 1:-1] - start
        share = np.clip((inner * line).sum(axis=2) / square, 0.0, 1.0)
        away = np.linalg.norm(inner - share[..., None] * line, axis=2)
        worst = np.maximum(worst, away.max(axis=1))
    return worst
