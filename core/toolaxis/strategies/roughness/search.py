"""The search for passes that keep a roughness: as far apart as it allows, the rotary axes turning least.

Over the face a lean is chosen for each place, the least that keeps strip width and all distances; with these leans
passes are laid for the roughness.  Then the rotary axes along each pass are made to turn as little as the conditions
let them, Ra is evaluated at places all over the face, and passes around those that miss it are made again.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import radians

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import GREATER_SCALLOP, LONGER_STICKOUT, SMALLER_CUTTER, SMALLER_SCALLOP
from toolaxis.contact.clearance.queries import keeps_limits, motions
from toolaxis.contact.placement import tips
from toolaxis.contact.strip.second_order import contact_forms
from toolaxis.errors import InvalidInput
from toolaxis.machine.kinematics import placement
from toolaxis.machine.setup import Mounting
from toolaxis.path.moving_axis import MovingChart, MovingCut
from toolaxis.path.pass_layout import Layout, lay_out
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.machine_limits import mounting_of, while_moving
from toolaxis.strategies.roughness.feasible_area import check_bull_nose
from toolaxis.strategies.roughness.pass_constraints import (
    GOUGE,
    LEANING,
    LEAST_LEAN,
    MOST_LEAN,
    UPRIGHT,
    OrientationRequirements,
    PassConstraints,
    beginnings,
    knots_of,
    leaning,
    spline_along_axes,
)
from toolaxis.strategies.roughness.passes import (
    FieldChart,
    LeadField,
    SplineAxes,
    evaluation_length,
    roughness_at,
    spots,
)
from toolaxis.strategies.roughness.rotary_spline import RotarySpline
from toolaxis.strategies.roughness.roughness import scallop_of_roughness
from toolaxis.strategies.roughness.section_width import expect_widths
from toolaxis.strategies.roughness.smoothing import SmoothedAxes, smooth_axes
from toolaxis.strategies.roughness.strategy import ROUGHNESS

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: The lean whose strip width is expected, rad: the paper's Sturz milling.
NOMINAL = radians(20.0)
#: Share of the roughness for which passes are laid: the rest leaves the rotary axes room.
_SHARE = 0.88
#: Grid of leans along and across the passes, leans between the least and the greatest, and what is added to the least.
_GRID, _LEANS, _ROOM = (25, 15), 56, radians(0.4)
#: Places along passes: their distance, mm, the least and the greatest number.
_GAP, _PLACES = 1.0, (24, 160)
#: How often floors of leans are raised where the tool comes too close, by how much, rad, and how often Ra is tightened.
_RAISED, _RAISE, _TIGHTENED = 6, radians(1.0), 4
#: How many beginnings are followed, more only where none keeps all; the sum at which rotary axes stand still; and how
#: many times that of the pass before is taken without looking for another.
_STARTS, _STANDS, _WORSE = 3, 1e-3, 1.2
#: Share of the scallop of the roughness by which straight motions may miss passes.
_CHORDS = 0.04


@dataclass(frozen=True, eq=False)
class SmoothPasses:
    """Passes with smooth rotary axes.

    Attributes
    ----------
    placed : Layout
    cut : MovingCut of SplineAxes
    lanes : tuple of SmoothedAxes
        One for each piece of the layout.
    uv : (n, 2) array
        Places at which Ra was evaluated.
    roughness : (n,) array
        Ra there, mm.
    """

    placed: Layout
    cut: MovingCut[SplineAxes]
    lanes: tuple[SmoothedAxes, ...]
    uv: Array
    roughness: Array

    @property
    def cost(self) -> float:
        """Sum of squared angular velocities of all passes, (rad/s)^2."""
        return float(sum(one.cost for one in self.lanes))

    @property
    def widths(self) -> Array:
        """Section strip widths at the places of all passes on the face, mm."""
        return np.concatenate([one.lane.widths(one.axes)[one.lane.inside] for one in self.lanes])


class RoughnessSearch:
    """The search for the rotary axes of one face.

    Parameters
    ----------
    job : FaceProblem
    roughness : float
        Greatest Ra, mm.
    feedrate : float
        mm/min
    widths : (float, float), optional
        Range of the section strip width, mm; that of [dong2023] Eq. (14) for a lean of 20 degrees unless given.

    Raises
    ------
    InvalidInput
        When the cutter is no torus, no machine with two rotary axes is given, or a number is out of range.
    """

    def __init__(self, job: FaceProblem, roughness: float = ROUGHNESS, feedrate: float = 800.0,
                 widths: tuple[float, float] | None = None) -> None:
        self.face, self.tool = job.worth.face, job.worth.tool
        check_bull_nose(self.tool, flat_too=False)
        mounting = mounting_of(job.feasibility.limits)
        if mounting is None or len(mounting.machine.rotary) < 2:
            raise InvalidInput("strategy 'multiscale' smooths the two rotary axes of a machine: name one that has them")
        self.mounting: Mounting = mounting
        self.turn = placement(mounting.table_from_part)[:3, :3]
        self.height = scallop_of_roughness(roughness)
        self.job = replace(job, chord=min(job.chord, _CHORDS * self.height))
        self.roughness, self.speed = roughness, feedrate / 60
        least = max(LEAST_LEAN, job.feasibility.least_angle)
        self.wish = OrientationRequirements(job.worth.scallop,
                                            widths or expect_widths(self.tool, NOMINAL, job.worth.scallop), roughness,
                                            (least, min(MOST_LEAN, job.feasibility.greatest_angle - radians(1.0))))
        if self.height >= job.worth.scallop:
            raise InvalidInput(f"Ra {1000 * roughness:g} um stands for scallops of {self.height:.3g} mm, not below the "
                               f"scallop height {job.worth.scallop:g} mm: give {GREATER_SCALLOP}, at which "
                               "strip widths are taken, or a smaller roughness")
        self.tried = 0

    def lane(self, piece: Array, feed: str, apart: tuple[Array, float, float] | None = None,
             wish: OrientationRequirements | None = None) -> PassConstraints:
        """A pass, or a part of one, to be given rotary axes.

        Parameters
        ----------
        piece : (3,) array
            along0, along1, step.
        feed : str
        apart : (steps of all passes, range of the along parameter), optional
            Ra does not matter unless given.
        wish : OrientationRequirements, optional
        """
        low, high, step = piece
        coarse = self._uv(np.linspace(low, high, 65), step, feed)
        length = float(np.linalg.norm(np.diff(self.face.evaluate(coarse).point, axis=0), axis=1).sum())
        places = np.linspace(low, high, int(np.clip(round(length / _GAP), *_PLACES)) + 1)
        if apart is not None:  # the borders of the face are places too
            own = np.array([end for end in apart[1:] if low < end < high])
            places = np.union1d(places[np.abs(places[:, None] - own).min(axis=1, initial=np.inf) > 1e-6 * (high - low)],
                                own)
        uv = self._uv(places, step, feed)
        inside, gap = np.ones(len(places), dtype=bool), np.zeros(len(places))
        if apart is not None:
            steps, first, last = apart
            edge = 1e-9 * (last - first)
            inside = (places >= first - edge) & (places <= last + edge)
            k = int(np.abs(steps - step).argmin())
            beside = float(np.diff(steps)[max(k - 1, 0):k + 1].max(initial=0.0))
            gap = beside * contact_forms(self.face, uv, feed, True)[:, 12]
        return PassConstraints(self.face, self.tool, self.mounting.machine, self.turn, wish or self.wish, feed, places,
                               uv, inside, gap, np.full(len(places), self.wish.leans[0]), self.speed, knots_of(places),
                               self.job.worth.allowance)

    def _uv(self, along: Array, step: float, feed: str) -> Array:
        rows = np.column_stack([along, np.full(len(along), step)])
        return rows if feed == "u" else rows[:, ::-1]

    def blocked(self, lane: PassConstraints, axes: Array) -> Bools:
        """Whether the tool comes too close to something at the places of a pass, (n,).

        Parameters
        ----------
        lane : PassConstraints
        axes : (n, 3) array
        """
        self.tried += len(axes)
        tip = tips(lane.bench.point, lane.bench.normal, axes, self.tool, self.job.worth.allowance)
        moves = motions(tip, axes)
        bad = np.zeros(len(axes), dtype=bool)
        for group in self.job.feasibility.groups:
            table = np.tile(group.required, (len(group.faces), 1))
            bad |= keeps_limits(group.cells, self.tool, moves, table).blocked >= 0
        limits = while_moving(self.job.feasibility.limits)
        return bad if limits is None else bad | ~limits.allowed(axes)

    def field(self, feed: str) -> MovingCut[LeadField]:
        """The least lean along the feed at each place of the face that keeps strip width and all distances.

        Parameters
        ----------
        feed : str

        Raises
        ------
        InvalidInput
            When some place has none.
        """
        chart = MovingChart(self.face, feed)
        a0, a1, s0, s1 = chart.bounds
        grid = np.linspace(a0, a1, _GRID[0]), np.linspace(s0, s1, _GRID[1])
        rows = np.empty(_GRID)
        for j, step in enumerate(grid[1]):
            self.job.progress.report("leans", j, _GRID[1])
            lane = replace(self.lane(np.array([a0, a1, step]), feed), places=grid[0], uv=self._uv(grid[0], step, feed),
                           inside=np.ones(_GRID[0], bool), apart=np.zeros(_GRID[0]),
                           floor=np.full(_GRID[0], self.wish.leans[0]))
            rows[:, j] = self._least(lane)
        wide = np.pad(rows, 1, mode="edge")
        highest = np.max([wide[i:i + _GRID[0], j:j + _GRID[1]] for i in range(3) for j in range(3)], axis=0) + _ROOM
        mean = chart.face.normal(self._uv(grid[0], (s0 + s1) / 2, feed)).mean(axis=0)
        return MovingCut(self.tool, mean, _SHARE * self.height, self.job.worth.allowance,
                         field=LeadField(feed, grid[0], grid[1], highest))

    def _least(self, lane: PassConstraints) -> Array:
        """Least leans at the places of a lane, (n,)."""
        found = np.full(len(lane.places), np.nan)
        for lean in np.linspace(*self.wish.leans, _LEANS):
            some = np.isnan(found)
            if not some.any():
                break
            axes = leaning(lane, lean)
            good = some & (lane.margins(axes) >= 0).all(axis=1)
            if good.any():
                good[good] = ~self.blocked(_only(lane, good), axes[good])
            found[good] = lean
        none = np.isnan(found)
        if none.any():
            raise InvalidInput(self._without(_only(lane, none)))
        return found

    def _without(self, lane: PassConstraints) -> str:
        """Why the first place of a lane has no lean along the feed: too narrow, too wide, or too close to something."""
        where, (low, high) = np.round(lane.bench.point[0], 2).tolist(), self.wish.widths
        every = [leaning(lane, lean) for lean in np.linspace(*self.wish.leans, _LEANS)]
        wide = np.array([lane.widths(axes)[0] for axes in every])
        free = [lane.margins(axes)[0, [GOUGE, UPRIGHT, LEANING]].min() >= 0 for axes in every]
        begin = (f"no lean along the feed near {where} of face {self.face.label} is free with a strip of {low:.4g} to "
                 f"{high:.4g} mm at a height of {self.wish.scallop:g} mm")
        if any(free) and wide[free].max() < low:
            return f"{begin}: strips are {wide[free].max():.4g} mm wide at most; take {SMALLER_SCALLOP}"
        if any(free) and wide[free].min() > high:
            return f"{begin}: strips are {wide[free].min():.4g} mm wide at least; take {SMALLER_CUTTER}"
        return f"{begin}: take another cutter, scallop height or range"

    def found(self, feed: str) -> SmoothPasses:
        """Passes along a feed with smooth rotary axes.

        Parameters
        ----------
        feed : str

        Raises
        ------
        InvalidInput
            When some place has no orientation, or the machine cannot follow.
        """
        leads = self.field(feed)
        chart = FieldChart(self.face, feed, laid=leads)
        placed = lay_out(chart, leads, progress=self.job.progress)
        return self.along(placed, self.wish)

    def along(self, placed: Layout, wish: OrientationRequirements, free: bool = True) -> SmoothPasses:
        """Smooth rotary axes along passes.

        Parameters
        ----------
        placed : Layout
        wish : OrientationRequirements
        free : bool
            Whether the ends of passes are free; else they lean 20 degrees along the feed.

        Raises
        ------
        InvalidInput
            As for `found`.
        """
        feed = placed.chart.feed  # type: ignore[attr-defined]
        length = evaluation_length(wish.roughness)
        length = length if np.isfinite(length) else 4.0
        uv = spots(self.face, feed, length)
        limits = np.full(len(placed.pieces), wish.roughness)
        lanes: list[SmoothedAxes | None] = [None] * len(placed.pieces)
        for _ in range(_TIGHTENED):
            self._fill(lanes, placed, wish, limits, free)
            done = tuple(one for one in lanes if one is not None)
            cut = self._cut(placed, done)
            ra = roughness_at(self.face, cut, placed.steps, uv, length)
            if (ra <= wish.roughness).all():
                break
            self._tighten(lanes, placed, limits, (uv, ra, length, wish.roughness))
        return SmoothPasses(placed, cut, done, uv, ra)

    def _tighten(self, lanes: list[SmoothedAxes | None], placed: Layout, limits: Array,
                 seen: tuple[Array, Array, float, float]) -> None:
        """Have the passes around places that miss the roughness made again with a smaller one."""
        uv, ra, length, most = seen
        feed = placed.chart.feed  # type: ignore[attr-defined]
        column = 1 if feed == "u" else 0
        pace = contact_forms(self.face, uv, feed, True)[:, 12]
        for i in np.flatnonzero(ra > most):
            near = np.abs(placed.pieces[:, 2] - uv[i, column]) * pace[i] <= 0.6 * length
            limits[near] = np.minimum(limits[near], 0.99 * most * most / ra[i])
            for k in np.flatnonzero(near):
                lanes[k] = None

    def _fill(self, lanes: list[SmoothedAxes | None], placed: Layout, wish: OrientationRequirements, limits: Array,
              free: bool) -> None:
        feed = placed.chart.feed  # type: ignore[attr-defined]
        a0, a1, _, _ = placed.chart.bounds
        for k, piece in enumerate(placed.pieces):
            self.job.progress.report("rotary axes", k, len(lanes))
            if lanes[k] is None:
                lane = self.lane(piece, feed, (placed.steps, a0, a1), replace(wish, roughness=float(limits[k])))
                one = self._smooth(lane, lanes[k - 1] if k else None, free)
                lanes[k] = one if one.follows else self._keep_pace(one, free)

    def _keep_pace(self, one: SmoothedAxes, free: bool) -> SmoothedAxes:
        """Rotary axes of a pass that keep their velocities at the feed rate too, begun from those that do not; as they
        are where none are found."""
        ends = None if free else one.spline.angles(one.lane.places[[0, -1]])
        found = smooth_axes(replace(one.lane, paced=True), one.spline, ends)
        return found if found.kept and not self.blocked(found.lane, found.axes).any() else one

    def _smooth(self, lane: PassConstraints, last: SmoothedAxes | None, free: bool) -> SmoothedAxes:
        """Smooth rotary axes of a pass; from those of the one before where they serve."""
        if not free:
            nominal = spline_along_axes(lane, leaning(lane, np.full(len(lane.places), NOMINAL)))
            best = self._best(lane, [nominal], nominal.angles(lane.places[[0, -1]]))
            ends = nominal.angles(lane.places[[0, -1]])
        else:
            best, ends = self._from(lane, last), None
        for _ in range(_RAISED):
            bad = self.blocked(lane, best.axes)
            if not bad.any():
                return best
            floor = np.where(bad, np.maximum(lane.floor, lane.leans(best.axes) + _RAISE), lane.floor)
            lane = replace(lane, floor=floor)
            best = self._best(lane, [best.spline], ends)
        where = np.round(lane.bench.point[np.argmax(bad)], 2).tolist()
        raise InvalidInput(f"the tool comes too close near {where} however much it leans along the pass: choose "
                           f"another strategy, {LONGER_STICKOUT} or a slimmer holder")

    def _from(self, lane: PassConstraints, last: SmoothedAxes | None) -> SmoothedAxes:
        """Smooth rotary axes of a pass, from those of the one before where they serve about as well there."""
        known = list[SmoothedAxes]()
        if last is not None and len(last.lane.knots) == len(lane.knots):
            one = smooth_axes(lane, replace(last.spline, knots=lane.knots))
            if one.kept and one.cost <= _WORSE * last.cost + _STANDS:
                return one
            known.append(one)
        return self._best(lane, beginnings(lane), None, known)

    def _best(self, lane: PassConstraints, starts: list[RotarySpline], ends: Array | None,
              known: Sequence[SmoothedAxes] = ()) -> SmoothedAxes:
        """The one that turns least of those that keep all conditions, those already known among them."""
        found, kept = list(known), [one for one in known if one.kept]
        for number, start in enumerate(starts):
            if kept and (number >= _STARTS or kept[-1].cost < _STANDS):
                break
            found.append(smooth_axes(lane, start, ends))
            kept += found[-1:] if found[-1].kept else []
        if not kept:
            closest = max(found, key=lambda one: float(one.margins.min()))
            raise InvalidInput(f"rotary axes of {lane.machine.name} cannot keep all conditions along a pass: "
                               f"{closest.sentence}")
        return min(kept, key=lambda one: one.cost)

    def _cut(self, placed: Layout, lanes: tuple[SmoothedAxes, ...]) -> MovingCut[SplineAxes]:
        order = np.argsort(placed.pieces[:, 2], kind="stable")
        axes = np.concatenate([one.axes for one in lanes])
        lean = float(np.mean(np.concatenate([one.lane.leans(one.axes) for one in lanes])))
        feed = placed.chart.feed  # type: ignore[attr-defined]
        along = SplineAxes(feed, lean, self.mounting.machine, self.turn, placed.pieces[order],
                           tuple(lanes[k].spline for k in order))
        return MovingCut(self.tool, axes.mean(axis=0), self.height, self.job.worth.allowance, field=along)


def _only(lane: PassConstraints, some: Bools) -> PassConstraints:
    return replace(lane, places=lane.places[some], uv=lane.uv[some], inside=lane.inside[some], apart=lane.apart[some],
                   floor=lane.floor[some])
