"""Further short passes where those laid leave something on which the cutter may stand.

Passes are laid as if each of them could run out beyond the face.  Where it may not, for what stands there, the strip of
its end is missing, and a pass that would run along beside the border has to stop.  What stays is cut from contacts on
the face.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.strip.swept_volume import distance_to_removed
from toolaxis.path.chord_tolerance import follow
from toolaxis.path.greatest_step_over import limit_half_widths
from toolaxis.path.parametrization import Chart, Cut, extents, tip_points
from toolaxis.path.pass_layout import Layout, Reach, sampling
from toolaxis.path.pass_pattern import PassChart
from toolaxis.path.planes import PlaneChart
from toolaxis.path.rest_material import FACTOR, may_stay, undercut
from toolaxis.path.step_over import Spacing
from toolaxis.path.trim_intervals import Intervals, filter_intervals
from toolaxis.plan.zone import Zone
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Cells of a zone along and across, doubled until so many of their centres lie in it, or as often as this.
_CELLS, _ENOUGH, _DOUBLED = 16, 60, 3
#: Steps that are tried in each half width of a pass, fewest and most in all.
_IN_HALF, _FEWEST, _MOST = 4, 13, 61
#: Zones that are mended at most, and passes over each; what a pass has to cut of its zone to be worth its links.
_ZONES, _PASSES, _WORTH = 60, 6, 0.05
#: Zones of which the cutter may stand on less than this share lie at walls: they are for the clean-up tool.
_STANDING = 0.5
#: Gaps between the places along a further pass at which it is asked where the cutter may stand, and how much farther
#: passes go on than the cutter reaches.
_ASKED, _RUN_OUT = 24, 1.05
#: Share of the scallop height by which motions of a pass that is tried may leave it, and the distance, mm, from which
#: on points are just far from them.
_CHORD, _FAR = 0.05, 1e-3
#: How often it is looked again at what further passes leave.
_ROUNDS = 3


class _Aim(NamedTuple):
    """What is to be cut of a zone.

    bounds : along0, along1, step0, step1;  places : (n, 2) array, along and step of centres of cells;
    raised : (n, 3) array, mm, at the height that may stay;  area : (n,) array, in proportion.
    """

    bounds: tuple[float, float, float, float]
    places: Array
    raised: Array
    area: Array


class _Passes(NamedTuple):
    """Further passes.

    steps : (k,) array;  pieces : (m, 3) array, along0, along1 and step of each;  owner : (m,) array of int, its pass.
    """

    steps: Array
    pieces: Array
    owner: NDArray[np.intp]


class FurtherPasses(NamedTuple):
    """Passes, how they were traced, and the zones that they leave higher than the scallop limit.

    placed : Layout;  path : ToolPath;  zones : tuple of Zone, the largest first;  longer : float, cutting length over
    that without further passes.
    """

    placed: Layout
    path: ToolPath
    zones: tuple[Zone, ...]
    longer: float = 1.0

    @property
    def left(self) -> float:
        """Area of the zones, mm^2."""
        return sum(zone.area for zone in self.zones)

    @property
    def undercut(self) -> float:
        """Area of the zones that do not lie at walls, mm^2."""
        return undercut(self.zones)


def complete_passes(placed: Layout, path: ToolPath, traced: Callable[[Layout], ToolPath],
                    left: Callable[[ToolPath], tuple[Zone, ...]], reach: Reach | None = None) -> FurtherPasses:
    """Passes with as many further short ones as it takes to leave little on which the cutter may stand.

    Parameters
    ----------
    placed : Layout
        Of passes with a fixed axis, along parameters or planes.
    path : ToolPath
        Of that layout.
    traced : callable
        Makes the tool path of a layout.
    left : callable
        Finds the zones that a tool path leaves, the largest first.
    reach : callable, optional
        Takes (n, 2) parameters, beyond the face too, and tells which contacts the cutter may visit, (n,) bool.

    Returns
    -------
    FurtherPasses
        With the layout as it came where its passes leave little, or no further pass would help.

    Notes
    -----
    Some steps in and beside a zone are tried; of the passes there those are taken, one after the other, that cut most
    of what is left of it, by exact distances to the swept cutter.

    **Properties**: 1. it never leaves more than the layout did.
    """
    made = FurtherPasses(placed, path, left(path))
    plain = max(path.length(Motion.CUT), np.finfo(float).tiny)
    if not len(placed.pieces):
        return made
    for _ in range(_ROUNDS):
        further = add_passes_over_zones(made.placed, made.zones, reach)
        if further is made.placed:
            break
        path = traced(further)
        longer = path.length(Motion.CUT) / plain
        again = FurtherPasses(further, path, left(path), longer)
        if again.left >= made.left:
            break
        made = again
    return made


def add_passes_over_zones(placed: Layout, zones: Sequence[Zone], reach: Reach | None = None) -> Layout:
    """A layout with further passes over the largest zones, until what the others leave may stay.

    Parameters
    ----------
    placed, reach
        As for `complete_passes`.
    zones : sequence of Zone
        What the passes leave, the largest first.

    Returns
    -------
    Layout
        The same one where there is nothing to be done.
    """
    aims = [(zone.area, _aim_at_zone(placed, zone, reach)) for zone in zones[:_ZONES]]
    rest = sum(area for area, aim in aims if aim is not None)
    enough = may_stay(zones, placed.chart.face.area)
    found: list[Array] = []
    for area, aim in aims:
        if rest <= enough:
            break
        if aim is not None:
            found += _over(placed, aim, reach)
            rest -= area
    return _with(placed, found) if found else placed


def _aim_at_zone(placed: Layout, zone: Zone, reach: Reach | None) -> _Aim | None:
    """What is to be cut of a zone; None of one that lies at walls."""
    chart = placed.chart
    cut = placed.cut
    assert isinstance(chart, PassChart)
    piece = chart.face.trimmed(zone.loops)
    uv = _centres(piece)
    if not len(uv):
        return None
    if reach is not None and reach(uv).mean() < _STANDING:
        return None
    d = piece.evaluate(uv)
    height = cut.allowance + FACTOR * cut.scallop
    bounds = replace(chart, face=piece).bounds
    raised = d.point + height * piece.normal(uv)
    area = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
    return _Aim(bounds, chart.places(uv), raised, area)


def _over(placed: Layout, aim: _Aim, reach: Reach | None) -> list[Array]:
    """Pieces (k, 3) of each further pass over one zone."""
    chart = placed.chart
    cut = placed.cut
    along = aim.places[:, 0]
    run_out = _run_out(chart, cut, aim.places)
    tried = _try_passes(chart, cut, aim.bounds, run_out, reach)
    cuts = _cuts(chart, cut, tried, aim)
    found = []
    left = np.ones(len(aim.area), dtype=bool)
    for _ in range(_PASSES):
        gain = cuts[:, left] @ aim.area[left]
        best = int(np.argmax(gain))
        if gain[best] <= _WORTH * aim.area.sum():
            break
        here = along[cuts[best] & left]
        own = tried.pieces[tried.owner == best]
        own[:, :2] = np.clip(own[:, :2], here.min() - run_out, here.max() + run_out)
        is_left = own[:, 1] > own[:, 0]
        found.append(own[is_left])
        left &= ~cuts[best]
    return found


def _centres(piece: Face) -> Array:
    """Centres of cells of a zone, (n, 2), the finer the fewer of them lie in it."""
    uv = np.empty((0, 2))
    for doubled in range(_DOUBLED + 1):
        cells = _CELLS << doubled
        uv = piece.grid(cells, cells)
        if len(uv) >= _ENOUGH:
            break
    return uv


def _run_out(chart: Chart, cut: Cut, places: Array) -> float:
    """How far the cutter reaches along the passes at scallop height in a zone, in the along parameter."""
    stride = max(len(places) // 16, 1)
    along, step = places[::stride].T
    reach = chart.run_outs(cut, along, step)
    good = reach[np.isfinite(reach)]
    return _RUN_OUT * float(good.max(initial=0.0))


def _try_passes(chart: Chart, cut: Cut, bounds: tuple[float, float, float, float], run_out: float,
                reach: Reach | None) -> _Passes:
    """Passes at steps in and beside a zone, over all of its length as far as the cutter may stand there."""
    a0, a1, s0, s1 = bounds
    half = _usual_half_width(chart, cut, bounds)
    wanted = np.ceil(_IN_HALF * (s1 - s0 + 2 * half) / half)
    number = int(np.clip(wanted, _FEWEST, _MOST))
    steps = np.linspace(s0 - half, s1 + half, number)
    low = a0 - run_out
    high = a1 + run_out
    found = Intervals(np.arange(number), np.full(number, low), np.full(number, high))
    if reach is not None:
        begin, end, _, _ = chart.bounds
        length, _ = extents(chart)
        apart, exact = sampling(length, end - begin, cut)
        apart = min((high - low) / _ASKED, apart)
        found = filter_intervals(found, lambda line, place: reach(chart.uv(place, steps[line])), apart, exact)
    some = found.high - found.low > 1e-9 * (high - low)
    pieces = np.column_stack([found.low, found.high, steps[found.line]])[some]
    owner = found.line[some]
    if isinstance(chart, PlaneChart):
        there = chart.are_found(pieces)
        pieces = pieces[there]
        owner = owner[there]
    return _Passes(steps, pieces, owner)


def _usual_half_width(chart: Chart, cut: Cut, bounds: tuple[float, float, float, float]) -> float:
    """Half width of strips in the middle of a zone, in the step parameter; half of the zone's where there is none."""
    a0, a1, s0, s1 = bounds
    along = np.linspace(a0, a1, 7)
    middle = np.full(7, (s0 + s1) / 2)
    halves = limit_half_widths(chart, cut, along, middle)
    good = halves[np.isfinite(halves) & (halves > 0)]
    if not len(good):
        return (s1 - s0) / 2
    return float(np.median(good))


def _cuts(chart: Chart, cut: Cut, tried: _Passes, aim: _Aim) -> Bools:
    """Which points each pass cuts, (k, n)."""
    cuts = np.zeros((len(tried.steps), len(aim.area)), dtype=bool)
    if not len(tried.pieces):
        return cuts
    piece, along = follow(chart, cut, tried.pieces, _CHORD * cut.scallop)
    step = tried.pieces[piece, 2]
    _, tips, _ = tip_points(chart, cut, along, step)
    same = np.flatnonzero(piece[1:] == piece[:-1])
    owner = tried.owner[piece[same]]
    for k in np.unique(owner):
        own = same[owner == k]
        distance = distance_to_removed(cut.tool, cut.axis, tips[own], tips[own + 1], aim.raised, _FAR, 0.0)
        cuts[k] = distance <= 0
    return cuts


def _with(placed: Layout, further: list[Array]) -> Layout:
    """A layout with further passes, each of which has pieces (k, 3), among its own in the order of their steps."""
    spacing = placed.spacing
    chart = placed.chart
    along = spacing.lines.measured
    new_steps = [pieces[0, 2] for pieces in further]
    steps = np.concatenate([spacing.steps, new_steps])
    new_halves = [limit_half_widths(chart, placed.cut, along, np.full(len(along), step)) for step in new_steps]
    halves = np.concatenate([spacing.halves, new_halves])
    order = np.argsort(steps, kind="stable")
    place = np.argsort(order, kind="stable")
    own = [np.full(len(one), len(spacing.steps) + k) for k, one in enumerate(further)]
    owner = place[np.concatenate([placed.owner, *own])]
    pieces = np.concatenate([placed.pieces, *further])
    rows = np.lexsort((pieces[:, 0], owner))
    made = Spacing(steps[order], spacing.unused, spacing.lines, halves[order])
    return Layout(chart, placed.cut, made, pieces[rows], owner[rows], placed.traced)
