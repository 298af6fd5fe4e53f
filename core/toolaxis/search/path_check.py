"""The last word on an axis: every motion of the passes really made, judged by bounds that hold along it."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.contact.clearance.gouge import depth_from_distance
from toolaxis.contact.clearance.queries import keeps_limits, lower_bounds, segment_motions
from toolaxis.feasibility.interference import COARSE, FINE
from toolaxis.feasibility.surroundings import OTHER, SKIN, CheckSurfaces
from toolaxis.feasibility.violations import CUTTER, GOUGE, Violation
from toolaxis.numeric.blocks import in_blocks
from toolaxis.numeric.rounding import round_significant
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.messages import place
from toolaxis.tools.tool import Tool
from toolaxis.work import allow

Array = NDArray[np.float64]

COMPONENTS = ("cutter", "shank", "holder")
_BATCH = 400
#: Every so manyth motion is measured first: the deepest of them leaves the others little to tell.
_STRIDE = 97
#: Resolution of reported clearances, mm.
_ROUGH = 0.005
#: How far the nearest face of a motion is looked for that turns out to keep its distances, mm.
_FAR = 50.0
#: Share of the motions up to which those that break a limit are worth being left out.
FEW = 0.02
#: A path of more motions than the first number is refused where, of about as many as the second number spread over it,
#: so many times as many break a limit as may be left out: to judge all of them would take long.
_LONG, _SPREAD, _SURELY = 30_000, 4_000, 2.0
#: So many bounds are allowed to each motion of a long path besides the limit.
_ALLOWED = 1500
#: So many motions that follow each other are held together against what stands around, before each is by itself; how
#: long a motion of them may be, in radii of the tool.
_TOGETHER, _EACH = (32, 8), 0.25

#: Bit of the motions that were measured, and the factor by which keys are mixed.
_MEASURED, _ODD = 62, np.uint64(0x9E3779B97F4A7C15)


@dataclass(frozen=True, eq=False)
class PathCheck:
    """What is known of a path.

    Attributes
    ----------
    witness : Violation or None
        The first motion that breaks a limit; None when every motion keeps them all.
    gouge : float
        Upper bound of the depth below the skin and below the faces behind its convex edges, mm.
    clearance : dict of str to float
        Lower bound per component that is known, mm; the cutter's is to what it does not machine or touch harmlessly.
    blocked : (k,) array of int
        All motions that are not proven to keep every limit, where they are few; empty where they are many.
    """

    witness: Violation | None
    gouge: float = 0.0
    clearance: dict[str, float] = field(default_factory=dict)
    blocked: NDArray[np.intp] = field(default_factory=lambda: np.empty(0, dtype=np.intp))


@dataclass(eq=False)
class ProvenMotions:
    """What earlier looks at passes with the same axis, tool and surroundings have proven.

    A path may have millions of motions: they stand in arrays, sorted by a key made of their numbers, and are compared
    to the last digit.  Of two that share a key one may not be found again; it is proven once more then.

    Attributes
    ----------
    figures : PathCheck
        Of all motions that were measured.
    """

    figures: PathCheck = field(default_factory=lambda: PathCheck(None))
    _rows: Array = field(default_factory=lambda: np.empty((0, 6)))
    _keys: NDArray[np.uint64] = field(default_factory=lambda: np.empty(0, dtype=np.uint64))
    #: By motion a bit for each group whose limits it keeps, and one for those that were measured.
    _proven: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64))

    def enter(self, moves: Array) -> NDArray[np.intp]:
        """Where motions stand here from now on, (n,): until others are entered.

        Parameters
        ----------
        moves : (n, 3, 3) array
            From `segment_motions`.
        """
        rows = moves[:, :2].reshape(-1, 6)
        keys = _keys_of(rows)
        known = len(self._keys)
        found = np.searchsorted(self._keys, keys)
        there = np.flatnonzero(found < known)
        is_same = (self._rows[found[there]] == rows[there]).all(axis=1)
        new = _others(len(rows), there[is_same])
        found[new] = known + np.arange(len(new))
        every = np.concatenate([self._keys, keys[new]])
        order = np.argsort(every, kind="stable")
        nothing_proven = np.zeros(len(new), dtype=np.int64)
        self._keys = every[order]
        self._rows = np.concatenate([self._rows, rows[new]])[order]
        self._proven = np.concatenate([self._proven, nothing_proven])[order]
        place = np.empty(len(order), dtype=np.intp)
        place[order] = np.arange(len(order))
        return place[found]

    def find_blocked(self, number: int, places: NDArray[np.intp],
                     ask: Callable[[NDArray[np.intp]], NDArray[np.intp]]) -> NDArray[np.intp]:
        """The motions that are not proven to keep the limits of a group; it is asked only for those not known yet.

        Parameters
        ----------
        number : int
            Of the group.
        places : (n,) array of int
            Of all motions, see `enter`.
        ask : callable
            Takes rows (k,) of motions, and gives back which of the k are not proven.
        """
        new = self._unknown(places, number)
        if not len(new):
            return new
        some = ask(new)
        kept = new[_others(len(new), some)]
        self._proven[places[kept]] |= 1 << number
        return new[some]

    def count_new(self, places: NDArray[np.intp]) -> int:
        """How many motions no figures are known of.

        Parameters
        ----------
        places : (n,) array of int
            Of all motions.
        """
        return len(self._unknown(places, _MEASURED))

    def measure(self, places: NDArray[np.intp], ask: Callable[[NDArray[np.intp]], PathCheck]) -> PathCheck:
        """The figures of a path; they are asked only for motions that were not measured yet.

        Parameters
        ----------
        places : (n,) array of int
            Of all motions.
        ask : callable
            Takes rows (k,) of motions, and gives back their figures.
        """
        new = self._unknown(places, _MEASURED)
        if len(new):
            mine = ask(new)
            before = self.figures
            clearance = {}
            for name, value in mine.clearance.items():
                clearance[name] = min(value, before.clearance.get(name, value))
            self.figures = PathCheck(None, max(mine.gouge, before.gouge), clearance)
            self._proven[places[new]] |= 1 << _MEASURED
        return self.figures

    def _unknown(self, places: NDArray[np.intp], bit: int) -> NDArray[np.intp]:
        """Rows of the motions of which something is not known."""
        known = (self._proven[places] >> bit) & 1
        return np.flatnonzero(known == 0)


def _others(count: int, rows: NDArray[np.intp]) -> NDArray[np.intp]:
    """The rows below a count that are not among some, (k,); without sorting, as there may be millions."""
    rest = np.ones(count, dtype=bool)
    rest[rows] = False
    return np.flatnonzero(rest)


def _keys_of(rows: Array) -> NDArray[np.uint64]:
    """A key for each row of numbers, (n,): the same for the same numbers, and hardly ever for others."""
    bits = np.ascontiguousarray(rows + 0.0).view(np.uint64)  # -0 is 0
    keys = np.zeros(len(rows), dtype=np.uint64)
    for column in bits.T:
        keys = (keys ^ column) * _ODD
        keys ^= keys >> np.uint64(29)
    return keys


def prove(path: ToolPath, tool: Tool, groups: tuple[CheckSurfaces, ...], allowance: float = 0.0, *, most: float = 20.0,
          known: ProvenMotions | None = None, progress: Progress = NO_PROGRESS) -> PathCheck:
    """Judge every motion of a path with one fixed axis.

    Measuring ends with what is known where a motion needs too many cells, and may then fall short of what deciding has
    proven before: figures are never worse than the distances to keep.

    Parameters
    ----------
    path : ToolPath
    tool : Tool
    groups : tuple of CheckSurfaces
        From `toolaxis.feasibility.surroundings.group_surroundings`, with the distances to keep.
    allowance : float
        Stock left on the skin, mm.
    most : float
        Clearances beyond this are not told apart, mm.
    known : ProvenMotions, optional
        Of earlier looks with the same axis, tool and groups; receives what this one proves.
    progress : Progress

    Returns
    -------
    PathCheck

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    moves = segment_motions(path.cl, path.axis[0])
    known = known or ProvenMotions()
    places = known.enter(moves)
    if len(moves) > _LONG:
        refused = _refuse_early(tool, groups, moves)
        if refused is not None:
            return PathCheck(refused)
        allow(_ALLOWED * known.count_new(places))
    links = np.flatnonzero(path.kind[1:] == Motion.LINK)
    witness: Violation | None = None
    blocked = np.zeros(len(moves), dtype=bool)
    for number, group in enumerate(groups):
        progress.report("proof", number, 2 * len(groups))

        def near_group(some: NDArray[np.intp], group: CheckSurfaces = group) -> NDArray[np.intp]:
            return _find_blocked(tool, group, moves[some], group.required)

        rows = known.find_blocked(number, places, near_group)
        into = rows[:0]
        if group.stock > 0:
            into = links[_find_blocked(tool, group, moves[links], group.required_on_links)]
        if not len(rows) and not len(into):
            continue
        blocked[rows] = True
        blocked[into] = True
        if witness is None and len(rows):
            witness = worst_motion(tool, group, moves[rows], group.required, group.required)
        elif witness is None:
            witness = link_into_stock(tool, group, moves[into])
        if blocked.sum() > FEW * len(moves):
            return PathCheck(witness)
    if witness is not None:
        return PathCheck(witness, blocked=np.flatnonzero(blocked))
    return known.measure(places, lambda some: _measure(tool, groups, moves[some], allowance, most, progress))


def _measure(tool: Tool, groups: tuple[CheckSurfaces, ...], moves: Array, allowance: float, most: float,
             progress: Progress) -> PathCheck:
    """The figures of motions that keep all limits."""
    gouge = 0.0
    clearance: dict[str, float] = {}
    has = {"cutter", *tool.outlines}
    for number, group in enumerate(groups):
        progress.report("proof", len(groups) + number, 2 * len(groups))
        if group.role != OTHER:
            left = allowance if group.role == SKIN else 0.0
            gouge = max(gouge, greatest_depth(tool, group, moves, left))
        asked = [c for c, name in enumerate(COMPONENTS) if name in has]
        if group.role != OTHER:
            asked = [c for c in asked if c > 0]
        for c, value in _least(tool, group, moves, tuple(asked), most).items():
            name = COMPONENTS[c]
            proven = max(value, float(group.required[c]))
            clearance[name] = min(clearance.get(name, most), proven)
    return PathCheck(None, gouge, clearance)


def _refuse_early(tool: Tool, groups: tuple[CheckSurfaces, ...], moves: Array) -> Violation | None:
    """The worst of motions spread over a long path, where so many of them break a limit that it will be refused."""
    stride = len(moves) // _SPREAD + 1
    some = moves[::stride]
    for group in groups:
        rows = _find_blocked(tool, group, some, group.required)
        if len(rows) > _SURELY * FEW * len(some):
            return worst_motion(tool, group, some[rows], group.required, group.required)
    return None


def greatest_depth(tool: Tool, group: CheckSurfaces, moves: Array, allowance: float) -> float:
    """Upper bound of the depth below a group of which motions are proven to keep their distance, mm.

    Parameters
    ----------
    tool : Tool
    group : CheckSurfaces
    moves : (n, 3, 3) array
        Motions, as `segment_motions` gives them.
    allowance : float
        Stock left on the group, mm.
    """
    spread = np.arange(0, len(moves), _STRIDE)
    order = np.concatenate([spread, _others(len(moves), spread)])
    limit = float(group.required[0])
    cutter = _only(group, (0,))
    nearest = allowance + 2 * FINE
    for first in range(0, len(order), _BATCH):
        if nearest <= limit:  # it is proven that none goes deeper
            break
        some = moves[order[first:first + _BATCH]]
        found = lower_bounds(group.cells, tool, some, nearest, FINE, cutter)
        nearest = float(found.lower[:, 0].min())
    distance = np.array(max(nearest, limit))
    return float(depth_from_distance(tool, distance, allowance))


def _only(group: CheckSurfaces, components: tuple[int, ...]) -> Array:
    """Required table that asks for some components only, (faces, 3)."""
    row = np.full(3, -np.inf)
    row[list(components)] = 0.0
    return np.tile(row, (len(group.faces), 1))


def _find_blocked(tool: Tool, group: CheckSurfaces, moves: Array, required: Array) -> NDArray[np.intp]:
    """The motions that are not proven to keep distances (3,) from a group."""
    if group.role == OTHER or np.isneginf(required[0]):
        return _find_together(tool, group, moves, required)
    # on its skin a cutter is too near to be told about so, shank and holder are not
    others = np.array([-np.inf, *required[1:]])
    cutter = np.array([required[0], -np.inf, -np.inf])
    by_others = _find_together(tool, group, moves, others)
    by_cutter = _find_singly(tool, group, moves, cutter)
    return np.union1d(by_others, by_cutter)


def _find_together(tool: Tool, group: CheckSurfaces, moves: Array, required: Array) -> NDArray[np.intp]:
    """The same, by balls around motions that follow each other first."""
    if np.isneginf(required).all():
        return np.empty(0, dtype=np.intp)
    table = np.tile(required, (len(group.faces), 1))
    left = np.arange(len(moves))
    for number in _TOGETHER:
        kept = _keep_together(tool, group, moves[left], table, number)
        left = left[~kept]
    return left[_find_singly(tool, group, moves[left], required)]


def _find_singly(tool: Tool, group: CheckSurfaces, moves: Array, required: Array) -> NDArray[np.intp]:
    """The same, motion by motion."""
    table = np.tile(required, (len(group.faces), 1))
    found = in_blocks(lambda some: keeps_limits(group.cells, tool, some, table).blocked, moves)
    return np.flatnonzero(found >= 0)


def _keep_together(tool: Tool, group: CheckSurfaces, moves: Array, table: Array, number: int) -> NDArray[np.bool_]:
    """Motions (n,) of which so many that follow each other keep distances (faces, 3), as a ball around them tells.

    A distance changes by no more than the tip moves.
    """
    first = np.arange(0, len(moves), number)
    if len(first) < 2:
        return np.zeros(len(moves), dtype=bool)
    middle = moves[:, 0]
    reach = np.abs(moves[:, 1])
    low = np.minimum.reduceat(middle - reach, first)
    high = np.maximum.reduceat(middle + reach, first)
    radius = np.linalg.norm(high - low, axis=1) / 2
    short = radius <= number * _EACH * tool.radius  # links are long
    standing = np.zeros_like(low)
    balls = np.stack([(low + high) / 2, standing, moves[first, 2]], axis=1)
    margin = radius[short].max(initial=0.0)
    found = keeps_limits(group.cells, tool, balls[short], table + margin)
    kept = np.zeros(len(first), dtype=bool)
    kept[short] = found.blocked < 0
    of_each = np.diff(np.append(first, len(moves)))
    return np.repeat(kept, of_each)


def link_into_stock(tool: Tool, group: CheckSurfaces, moves: Array) -> Violation:
    """The worst of links at rapid traverse of which the cutter is not proven to stay clear of a group's stock.

    Parameters
    ----------
    tool : Tool
    group : CheckSurfaces
        With stock.
    moves : (n, 3, 3) array
        At least one.
    """
    required = np.array([group.required_on_links[0], -np.inf, -np.inf])
    cutoff = np.maximum(required, 0.0)
    found = worst_motion(tool, group, moves, required, cutoff)
    which = f"face {found.label}" if found.label else "what stands around"
    at = f" at {place(found.point)}" if np.isfinite(found.point).all() else ""
    words = f"a rapid move is not proven to clear the stock of {group.stock:g} mm on {which}{at}"
    return found._replace(reason=CUTTER, words=words)


def worst_motion(tool: Tool, group: CheckSurfaces, moves: Array, required: Array, cutoff: Array) -> Violation:
    """The worst of motions that were not proven to keep their distances from a group.

    Parameters
    ----------
    tool : Tool
    group : CheckSurfaces
    moves : (n, 3, 3) array
        At least one.
    required : (3,) array
        Distances to keep, mm; -inf for components that are not asked for.
    cutoff : (3,) array
        Distances beyond which motions are not told apart, mm.

    Notes
    -----
    A motion that lies so near to its limit that deciding gave it up may turn out to keep it when it is measured: of
    that the nearest face is named all the same.
    """
    fine = FINE if group.role != OTHER else COARSE
    has = np.array([name == "cutter" or name in tool.outlines for name in COMPONENTS])
    asked = has & ~np.isneginf(required)
    table = np.tile(np.where(asked, 0.0, -np.inf), (len(group.faces), 1))
    found = lower_bounds(group.cells, tool, moves, cutoff + 2 * fine, fine, table)
    amount = np.where(asked, required - found.lower, -np.inf)
    worst = int(np.argmax(round_significant(amount)))
    i, c = (int(k) for k in np.unravel_index(worst, amount.shape))
    if found.face[i, c] < 0:
        found = lower_bounds(group.cells, tool, moves[[i]], _FAR, fine, table)
        i = 0
    distance = float(found.lower[i, c])
    missed = max(float(required[c] - found.lower[i, c]), 0.0)
    is_gouge = group.role == SKIN and c == 0
    code = GOUGE if is_gouge else CUTTER + c
    k = int(found.face[i, c])
    if k < 0:
        return Violation(code, missed)
    return Violation(code, missed, group.faces[k].label, found.point[i, c], distance=distance)


def _least(tool: Tool, group: CheckSurfaces, moves: Array, components: tuple[int, ...],
           most: float) -> dict[int, float]:
    """Least distance of components to a group over all motions, at most `_ROUGH` too small; `most` where it is more."""
    if not components:
        return {}
    best = np.full(3, most + _ROUGH)
    if len(moves) > _LONG:
        stride = len(moves) // _SPREAD + 1
        best = _bound_least(tool, group, moves[::stride], components, best, _ROUGH) + _ROUGH
        table = _only(group, components) + best - _ROUGH
        for number in _TOGETHER:  # what is farther away than the nearest of those tells nothing new
            kept = _keep_together(tool, group, moves, table, number)
            moves = moves[~kept]
    found = _bound_least(tool, group, moves, components, best, _ROUGH)
    return {c: float(found[c]) for c in components}


def _lowest_first(moves: Array) -> NDArray[np.intp]:
    """Motions in the order of their heights along the axis, (n,)."""
    if not len(moves):
        return np.empty(0, dtype=np.intp)
    heights = moves[:, 0] @ moves[0, 2]
    return np.argsort(round_significant(heights), kind="stable")


def _bound_least(tool: Tool, group: CheckSurfaces, moves: Array, components: tuple[int, ...], most: float | Array,
                 resolution: float) -> Array:
    """Lower bounds (3,) of the least distance of components to a group over all motions, up to `most`.

    Only what comes nearer than all before is told exactly: the lowest motions, which are likely to come near, are
    looked at first.  Those that are looked at together stay in the order of the path, as neighbours share a look.
    """
    asked = _only(group, components)
    best = np.broadcast_to(np.asarray(most, dtype=float), 3)
    order = _lowest_first(moves)
    for first in range(0, len(moves), _BATCH):
        together = np.sort(order[first:first + _BATCH])
        found = lower_bounds(group.cells, tool, moves[together], best, resolution, asked)
        least = found.lower.min(axis=0)
        best = np.where(least < best - resolution, least, best)
    return np.asarray(best - resolution)
