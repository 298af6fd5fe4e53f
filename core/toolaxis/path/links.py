"""From pieces of passes to one tool path: run in, cut, run out; on to the next beside it, or up, across and down."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

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
        outward = end[0] - end[1]
        size = float(np.linalg.norm(outward))
        if size == 0:
            return np.empty((0, 3))
        outward = outward / size
        up = normal - float(normal @ outward) * outward
        up = up / np.linalg.norm(up)
        most = 2 * np.arccos(max(1 - self.chord / self.radius, 0.0))
        count = int(np.clip(np.ceil(np.pi / 2 / max(most, 1e-3)), _FEWEST_CHORDS, _MOST_CHORDS))
        turn = np.linspace(np.pi / 2, 0.0, count + 1)[:-1, None]
        return np.asarray(end[0] + self.radius * (np.sin(turn) * outward + (1 - np.cos(turn)) * up))


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
        for name in ("height", "run_in", "approach"):
            value = getattr(self, name)
            if not np.isfinite(value) or (name != "height" and value < 0):
                raise InvalidInput(f"{name} of the links is {value} mm: it must be finite"
                                   + (" and zero or more" if name != "height" else ""))


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
    stays = np.isfinite(over[:, 0])
    heights = _heights(strokes, (entries, exits, stays), axis, linking)
    tips: list[Array] = []
    contacts: list[Array] = []
    normals: list[Array] = []
    kinds: list[NDArray[np.int8]] = []
    for k, stroke in enumerate(strokes):
        kind = kinds_of(2 + len(entries[k][1:]), len(stroke.tip), 1 + len(exits[k]))
        before = np.concatenate([_lift_link(entries[k][:1], axis, heights[k]), entries[k]])[2 * stays[k]:]
        after = np.concatenate([exits[k], _lift_link(exits[k][-1:], axis, heights[k + 1])])
        if stays[k + 1]:
            after = np.concatenate([exits[k][:-1], over[k + 1:k + 2]])
        tips += [before, stroke.tip, after]
        contacts += [before, stroke.contact, after]
        normals += [np.tile(axis, (len(before), 1)), stroke.normal, np.tile(axis, (len(after), 1))]
        kinds.append(kind[2 * stays[k]:len(kind) - stays[k + 1]])
    cl = np.concatenate(tips)
    ends = np.cumsum([len(kind) for kind in kinds])
    breaks = np.concatenate([[0], ends[np.cumsum([len(some) for some in passes]) - 1]])
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
    tops = [float((stroke.tip @ axis).max()) for stroke in strokes]
    heights = np.full(len(strokes) + 1, max([linking.height, *(top + linking.approach + linking.run_in
                                                               for top in tops)]))
    entries, exits, stays = ends
    rows = np.flatnonzero(~stays[1:-1])
    if linking.lower is not None and len(rows):
        end, begin = np.array([exits[k][-1] for k in rows]), np.array([entries[k + 1][0] for k in rows])
        asked = np.maximum(linking.lower(end, begin), np.maximum(end @ axis, begin @ axis))
        heights[1 + rows] = np.minimum(heights[1 + rows], asked)
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
    return np.array([Motion.LINK, Motion.LINK] + [Motion.ENTRY] * (before - 2) + [Motion.ENTRY]
                    + [Motion.CUT] * (cutting - 1) + [Motion.EXIT] * (after - 1) + [Motion.LINK], dtype=np.int8)


def _ramp(end: tuple[Array, Array], normal: Array, axis: Array, run_in: float) -> Array:
    """The far end of a ramp that leaves the first of two tips, away from the second and upwards, mm."""
    start, inner = end
    flank = float(normal @ axis) < FLANK
    size = np.linalg.norm(start - inner)
    direction = axis + normal if flank else axis
    if run_in > 0 and size > 0:
        direction = direction + (start - inner) / size
    elif not flank:
        return np.empty((0, 3))
    long = np.linalg.norm(direction)
    return np.empty((0, 3)) if long < 1e-6 else (start + (run_in or ASIDE) * direction / long)[None]


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
    lifted, first, last = where
    made: list[tuple[int, int, Array]] = []
    for k, stroke in enumerate(strokes):
        if lifted[k]:
            arc = linking.lead.points((stroke.tip[0], stroke.tip[1]), stroke.normal[0])
            made += [(0, k, np.concatenate([arc[:1] + linking.approach * first[k], arc]))] if len(arc) else []
        if lifted[k + 1]:
            arc = linking.lead.points((stroke.tip[-1], stroke.tip[-2]), stroke.normal[-1])
            made += [(1, k, np.concatenate([arc[:1] + linking.approach * last[k], arc]))] if len(arc) else []
    if not made:
        return
    ways = [np.concatenate([one, strokes[k].tip[[0 if side == 0 else -1]]]) for side, k, one in made]
    axes = [np.tile((first, last)[side][k], (len(one), 1)) for side, k, one in made]
    free = linking.lead.free(np.concatenate([way[:-1] for way in ways]), np.concatenate([way[1:] for way in ways]),
                             np.concatenate(axes))
    ends = np.cumsum([len(one) for _, _, one in made])
    for (side, k, one), whole in zip(made, np.split(free, ends[:-1]), strict=True):
        if whole.all():
            points[side][k] = one if side == 0 else one[::-1]


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
    found, left = most.copy(), np.arange(len(tips))
    for lift in (0.0, *LIFTS):
        left = left[lift < most[left]]
        if not len(left):
            break
        start = tips[left] + lift * axes[left]
        free = clear(start, tips[left] + most[left, None] * axes[left], axes[left])
        found[left[free]] = lift
        left = left[~free]
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
    return np.asarray(points[1] if len(points) > 1 else points[0] - linking.approach * axis)
