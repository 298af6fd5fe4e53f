"""From pieces of passes to one tool path: run in, cut, run out; on to the next beside it, or up, across and down."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput

Array = NDArray[np.float64]

#: Cosine of the angle between axis and normal below which a retract along the axis does not leave the surface, and the
#: way aside before it, mm, where no ramp is asked for.
FLANK, ASIDE = 0.03, 0.3
#: A stroke this near begins beside the end of the other, mm: to lift, to cross and to come down takes about as long.
BESIDE = 8.0
#: Straight motions of a quarter of a circle, at least and at most.
_FEWEST_CHORDS, _MOST_CHORDS = 4, 200
#: Heights of the way over to it that are tried, as shares of its length, and lifts above the higher end of a link, mm.
ROOFS, LIFTS = (0.0, 0.25, 0.5, 1.0), (1.0, 3.0, 8.0, 20.0, 45.0, 90.0)


@dataclass(frozen=True, eq=False)
class CuttingMove:
    """One cutting motion without interruption, in the order of cutting.

    Attributes
    ----------
    contact, tip, normal : (n, 3) array
        At least two points.
    """

    contact: Array
    tip: Array
    normal: Array

    @property
    def backwards(self) -> Self:
        """The same from its end to its begin."""
        points = {field.name: getattr(self, field.name) for field in fields(self)}
        return replace(self, **{name: array[::-1] for name, array in points.items()})


@dataclass(frozen=True)
class LeadArcs:
    """Arcs on which a tool comes to its passes and leaves them.

    Attributes
    ----------
    radius : float
        Of the tip's way, mm.
    chord : float
        How far straight motions may leave an arc, mm.
    free : callable
        Takes both ends (m, 3) of straight motions, mm, and the axes there (m, 3), and answers on which all distances
        are kept that passes keep, (m,) bool.
    """

    radius: float
    chord: float
    free: Callable[[Array, Array, Array], NDArray[np.bool_]]

    def points(self, end: tuple[Array, Array], normal: Array) -> Array:
        """Points of a quarter of a circle, (m, 3) mm, from far to near without the end of the stroke itself.

        It lies in the plane of the surface's normal and the feed, touches the stroke at its end and rises from the
        surface; chords lie on the side of its centre.

        Parameters
        ----------
        end : (3,) array, (3,) array
            Tips at the end of the stroke and next to it, mm.
        normal : (3,) array
            Of the surface there.
        """
        tip, inner = end
        outward = tip - inner
        size = float(np.linalg.norm(outward))
        if size == 0:
            return np.empty((0, 3))
        outward = outward / size
        up = normal - float(normal @ outward) * outward
        up = up / np.linalg.norm(up)
        widest_chord = 2 * np.arccos(max(1 - self.chord / self.radius, 0.0))
        chords = np.ceil(np.pi / 2 / max(widest_chord, 1e-3))
        count = int(np.clip(chords, _FEWEST_CHORDS, _MOST_CHORDS))
        turn = np.linspace(np.pi / 2, 0.0, count + 1)[:-1, None]
        on_unit_circle = np.sin(turn) * outward + (1 - np.cos(turn)) * up
        return np.asarray(tip + self.radius * on_unit_circle)


@dataclass(frozen=True)
class Linking:
    """How strokes are joined.

    Attributes
    ----------
    height : float
        Height along the axis, mm, at which the tip crosses from stroke to stroke: above all that is in the way.
    run_in : float
        Length of the ramp that touches down along the feed and lifts off after it, mm; 0 for none.
    approach : float
        Height above the ramp from which the tool comes down at feed rate, mm.
    lower : callable, optional
        Takes the tips (k, 3) above the end of each stroke and those above the begin of the next, mm, and answers at
        which heights along the axis the tip may cross between them, (k,) mm; all cross at `height` without it.
    beside : callable, optional
        Takes the tips (k, 3) at the end of each stroke and at the begin of the next, ramps included, mm, and answers
        over which tip (k, 3) it may go straight from one to the other at feed rate, nan where it must lift; it always
        lifts without it.
    rise : callable, optional
        Takes the tips (k, 3) at which links at rapid traverse would begin or end beside strokes, mm, the axes there
        (k, 3), and how far each may be lifted at most, (k,) mm, and answers how far they have to be lifted for links to
        clear what stock is left, (k,) mm: so far up the tool goes at feed rate.  They begin there without it.
    lead : LeadArcs, optional
        Where the tool comes down to a stroke and where it is lifted after one, these take the place of ramps wherever
        they are free.

    Raises
    ------
    InvalidInput
        When a length is negative or not finite.
    """

    height: float
    run_in: float = 1.0
    approach: float = 2.0
    lower: Callable[[Array, Array], Array] | None = None
    beside: Callable[[Array, Array], Array] | None = None
    rise: Callable[[Array, Array, Array], Array] | None = None
    lead: LeadArcs | None = None

    def __post_init__(self) -> None:
        if not np.isfinite(self.height):
            raise InvalidInput(f"height of the links is {self.height} mm: it must be finite")
        for name, value in (("run_in", self.run_in), ("approach", self.approach)):
            if not np.isfinite(value) or value < 0:
                raise InvalidInput(f"{name} of the links is {value} mm: it must be finite and zero or more")


def link(passes: list[list[CuttingMove]], axis: Array, linking: Linking) -> ToolPath:
    """Join strokes by retracts along the axis.

    Each stroke is entered and left on a ramp at 45 degrees between feed and axis, and by a short move along the axis;
    where the axis runs along the surface the ramp leads away from it, for a retract would scrape what stands between
    passes.  Between strokes the tip goes straight over at feed rate where `beside` allows it; elsewhere it rises to a
    crossing height, goes across, and comes down.  The path begins and ends at the greatest one.

    Parameters
    ----------
    passes : list of lists of Stroke
        Each pass with its strokes in the order of cutting.
    axis : (3,) array
        Unit vector from tip to spindle.
    linking : Linking

    Returns
    -------
    ToolPath

    Notes
    -----
    **Properties**: (1) the first point and all CUT points are those of the strokes in their order, links in between;
    (2) every rapid move across happens at `height` or above, or where `lower` says; (3) `breaks` start at the move that
    comes down from it, or at the first point after the one that `beside` gave.
    """
    strokes = [stroke for some in passes for stroke in some]
    if not strokes:
        empty = np.empty((0, 3))
        return ToolPath(empty, empty, empty, empty, np.empty(0, dtype=np.int8), np.zeros(1, dtype=np.int64))
    entries = [entry_points(one, axis, linking) for one in strokes]
    exits = [exit_points(one, axis, linking) for one in strokes]
    over = _over((entries, exits), axis, linking)
    axes = np.tile(axis, (len(strokes), 1))
    lifted = ~np.isfinite(over[:, 0])
    lay_lead_arcs((entries, exits), strokes, (lifted, axes, axes), linking)
    for points, which in ((entries, 0), (exits, -1)):
        raise_link_ends(points, which, axes, linking, lambda tips, _: linking.height - tips @ axis)
    goes_straight = np.isfinite(over[:, 0])
    heights = _heights(strokes, (entries, exits, goes_straight), axis, linking)
    tips: list[Array] = []
    contacts: list[Array] = []
    normals: list[Array] = []
    kinds: list[NDArray[np.int8]] = []
    for k, stroke in enumerate(strokes):
        entry, leaving = entries[k], exits[k]
        kind = kinds_of(1 + len(entry), len(stroke.tip), 1 + len(leaving))
        if goes_straight[k]:
            before = entry[1:]
            kind = kind[2:]
        else:
            before = np.concatenate([_lift_link(entry[:1], axis, heights[k]), entry])
        if goes_straight[k + 1]:
            after = np.concatenate([leaving[:-1], over[k + 1:k + 2]])
            kind = kind[:-1]
        else:
            after = np.concatenate([leaving, _lift_link(leaving[-1:], axis, heights[k + 1])])
        tips += [before, stroke.tip, after]
        contacts += [before, stroke.contact, after]
        normals += [np.tile(axis, (len(before), 1)), stroke.normal, np.tile(axis, (len(after), 1))]
        kinds.append(kind)
    cl = np.concatenate(tips)
    ends_of_strokes = np.cumsum([len(kind) for kind in kinds])
    last_strokes = np.cumsum([len(some) for some in passes]) - 1
    breaks = np.concatenate([[0], ends_of_strokes[last_strokes]])
    return ToolPath(np.concatenate(contacts), cl, np.tile(axis, (len(cl), 1)), np.concatenate(normals),
                    np.concatenate(kinds), breaks.astype(np.int64))


def _over(near: tuple[list[Array], list[Array]], axis: Array, linking: Linking) -> Array:
    """Tips over which it goes straight to each stroke, and after the last one, (strokes + 1, 3); nan where it lifts."""
    entries, exits = near
    over = np.full((len(entries) + 1, 3), np.nan)
    if linking.beside is not None and len(entries) > 1:
        ends = np.array([near_end(one[::-1], axis, linking) for one in exits[:-1]])
        begins = np.array([near_end(one, axis, linking) for one in entries[1:]])
        over[1:-1] = linking.beside(ends, begins)
    return over


def _heights(strokes: list[CuttingMove], ends: tuple[list[Array], list[Array], NDArray[np.bool_]], axis: Array,
             linking: Linking) -> Array:
    """Heights along the axis at which the tip comes, crosses from stroke to stroke, and goes, (strokes + 1,) mm."""
    above_strokes = [float((stroke.tip @ axis).max()) + linking.approach + linking.run_in for stroke in strokes]
    heights = np.full(len(strokes) + 1, max([linking.height, *above_strokes]))
    entries, exits, goes_straight = ends
    lifted = np.flatnonzero(~goes_straight[1:-1])
    if linking.lower is not None and len(lifted):
        end = np.array([exits[k][-1] for k in lifted])
        begin = np.array([entries[k + 1][0] for k in lifted])
        higher_end = np.maximum(end @ axis, begin @ axis)
        allowed = np.maximum(linking.lower(end, begin), higher_end)
        heights[1 + lifted] = np.minimum(heights[1 + lifted], allowed)
    return heights


def _lift_link(near: Array, axis: Array, height: float) -> Array:
    return near + max(height - float(near[0] @ axis), 0.0) * axis


def kinds_of(before: int, cutting: int, after: int) -> NDArray[np.int8]:
    """Kinds of motion of one stroke: across and down, then in; the first cut point is still arrived at by the entry.

    Parameters
    ----------
    before, cutting, after : int
        Numbers of points: the two of the link and those of the entry, those of the stroke, those of the exit and the
        one to which the tip is lifted.
    """
    entry = [Motion.LINK] * 2 + [Motion.ENTRY] * (before - 1)
    cuts = [Motion.CUT] * (cutting - 1)
    leaving = [Motion.EXIT] * (after - 1) + [Motion.LINK]
    return np.array(entry + cuts + leaving, dtype=np.int8)


def _ramp(end: tuple[Array, Array], normal: Array, axis: Array, run_in: float) -> Array:
    """The far end of a ramp that leaves the first of two tips, away from the second and upwards, mm."""
    none = np.empty((0, 3))
    start, inner = end
    runs_along_surface = float(normal @ axis) < FLANK
    size = np.linalg.norm(start - inner)
    direction = axis + normal if runs_along_surface else axis
    if run_in > 0 and size > 0:
        direction = direction + (start - inner) / size
    elif not runs_along_surface:
        return none
    length = np.linalg.norm(direction)
    if length < 1e-6:
        return none
    far_end = start + (run_in or ASIDE) * direction / length
    return np.asarray(far_end[None])


def entry_points(stroke: CuttingMove, axis: Array, linking: Linking) -> Array:
    """Points before the first cut point: above the ramp, at its top, (1 or 2, 3) mm.

    Parameters
    ----------
    stroke : CuttingMove
    axis : (3,) array
    linking : Linking
    """
    ramp = _ramp((stroke.tip[0], stroke.tip[1]), stroke.normal[0], axis, linking.run_in)
    low = ramp[-1] if len(ramp) else stroke.tip[0]
    return np.concatenate([(low + linking.approach * axis)[None], ramp])


def exit_points(stroke: CuttingMove, axis: Array, linking: Linking) -> Array:
    """Points after the last cut point: the end of the ramp, above it, (1 or 2, 3) mm.

    Parameters
    ----------
    stroke : CuttingMove
    axis : (3,) array
    linking : Linking
    """
    ramp = _ramp((stroke.tip[-1], stroke.tip[-2]), stroke.normal[-1], axis, linking.run_in)
    low = ramp[-1] if len(ramp) else stroke.tip[-1]
    return np.concatenate([ramp, (low + linking.approach * axis)[None]])


def lay_lead_arcs(points: tuple[list[Array], list[Array]], strokes: Sequence[CuttingMove],
                  where: tuple[NDArray[np.bool_], Array, Array], linking: Linking) -> None:
    """Put arcs, in place, where strokes are entered from above and where they are left upwards, if these are free.

    Parameters
    ----------
    points : list of (m, 3) array, list of (m, 3) array
        From `entry_points` and from `exit_points`, one for each stroke, mm.
    strokes : sequence of CuttingMove
    where : (k + 1,) array of bool, (k, 3) array, (k, 3) array
        Before which strokes, and after the last one, the tool is lifted; axes where strokes begin and where they end.
    linking : Linking
    """
    if linking.lead is None:
        return
    entries, exits = points
    lifted, first, last = where
    arcs = []
    for k, stroke in enumerate(strokes):
        if lifted[k]:
            arc = linking.lead.points((stroke.tip[0], stroke.tip[1]), stroke.normal[0])
            above = arc[:1] + linking.approach * first[k]
            arcs.append(_LaidArc(k, True, np.concatenate([above, arc]), stroke.tip[0], first[k]))
        if lifted[k + 1]:
            arc = linking.lead.points((stroke.tip[-1], stroke.tip[-2]), stroke.normal[-1])
            above = arc[:1] + linking.approach * last[k]
            arcs.append(_LaidArc(k, False, np.concatenate([above, arc]), stroke.tip[-1], last[k]))
    for laid in _free_arcs(arcs, linking.lead):
        if laid.is_entry:
            entries[laid.stroke] = laid.points
        else:
            exits[laid.stroke] = laid.points[::-1]


class _LaidArc(NamedTuple):
    """An arc at one end of a stroke: its points from above its far end on, the end, (3,) mm, and the axis there."""

    stroke: int
    is_entry: bool
    points: Array
    end: Array
    axis: Array


def _free_arcs(arcs: Sequence[_LaidArc], lead: LeadArcs) -> list[_LaidArc]:
    """Those of some arcs on which all distances are kept."""
    there = [arc for arc in arcs if len(arc.points)]
    if not there:
        return []
    ways = [np.concatenate([arc.points, arc.end[None]]) for arc in there]
    starts = np.concatenate([way[:-1] for way in ways])
    ends = np.concatenate([way[1:] for way in ways])
    axes = np.concatenate([np.tile(arc.axis, (len(arc.points), 1)) for arc in there])
    of_each = np.split(lead.free(starts, ends, axes), np.cumsum([len(arc.points) for arc in there])[:-1])
    return [arc for arc, is_free in zip(there, of_each, strict=True) if is_free.all()]


def raise_link_ends(points: list[Array], which: int, axes: Array, linking: Linking,
                    most: Callable[[Array, Array], Array]) -> None:
    """Move the ends of links up along the axis, in place, as far as `Linking.rise` asks.

    Parameters
    ----------
    points : list of (1 or 2, 3) array
        From `entry_points`, or from `exit_points`, one for each stroke, mm.
    which : int
        Row of the end in each: 0 or -1.
    axes : (k, 3) array
        There.
    linking : Linking
    most : callable
        How far tips (k, 3) with axes (k, 3) may be lifted at most, (k,) mm.
    """
    if linking.rise is None:
        return
    ends = np.array([one[which] for one in points])
    lifts = linking.rise(ends, axes, np.maximum(most(ends, axes), 0.0))
    for one, lift, axis in zip(points, lifts, axes, strict=True):
        one[which] += lift * axis


def least_rise(tips: Array, axes: Array, most: Array,
               clear: Callable[[Array, Array, Array], NDArray[np.bool_]]) -> Array:
    """How far tips must be lifted along their axes for the rest of the way up to be clear, (k,) mm.

    Parameters
    ----------
    tips, axes : (k, 3) array
    most : (k,) array
        Greatest lift, mm; it is the answer where no smaller one does.
    clear : callable
        Takes both ends of straight ways up (m, 3) and the axes there (m, 3), and answers which are clear, (m,) bool.
    """
    found = most.copy()
    left = np.arange(len(tips))  # of which no lift is known yet
    for lift in (0.0, *LIFTS):
        left = left[lift < most[left]]
        if not len(left):
            break
        start = tips[left] + lift * axes[left]
        top = tips[left] + most[left, None] * axes[left]
        is_clear = clear(start, top, axes[left])
        found[left[is_clear]] = lift
        left = left[~is_clear]
    return found


def near_end(points: Array, axis: Array, linking: Linking) -> Array:
    """The far end of a stroke's ramp, or the stroke's own end where there is none, (3,) mm.

    Parameters
    ----------
    points : (1 or 2, 3) array
        From `entry_points`, or from `exit_points` backwards, mm.
    axis : (3,) array
    linking : Linking
    """
    has_ramp = len(points) > 1
    return np.asarray(points[1] if has_ramp else points[0] - linking.approach * axis)
