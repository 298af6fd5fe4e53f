"""How passes lie on a face: along its own parameters, along parallel planes, or along the levels of a field.

Each pattern prices axes, coarsely for many of them and well for one, and gives the chart by which its passes are laid.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import UnsupportedGeometry
from toolaxis.machine.work_coordinates import mean_feed_across
from toolaxis.path.estimate import Estimates, Estimator
from toolaxis.path.field.between_places import hidden_passes
from toolaxis.path.field.direction_table import DirectionTable, tabulate_directions
from toolaxis.path.field.ideal_lengths import DirectionForms
from toolaxis.path.field.level_chart import LevelChart
from toolaxis.path.field.pass_field import find_field
from toolaxis.path.parametrization import Chart, Cut, IsoChart
from toolaxis.path.pass_count import Count, measure
from toolaxis.path.planes import PlaneChart
from toolaxis.plan.choices import AUTO, FEEDS, FIELD, ISO, PLANES
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: Charts of the passes that a plan can ask for.
PassChart: TypeAlias = IsoChart | PlaneChart | LevelChart

#: Places each way whose feed directions make up the mean one.
_GRID = 16
#: Passes that are looked at to price an axis: where faces turn much the count is not smooth, and as exact with these.
_COUNTED = 400
#: Cells each way, coefficients each way and steps downhill of a field: to price an axis, and to cut.
_PRICED, _MADE = (13, 8, 25), (26, 14, 60)
#: Cells each way where narrow places lie between those, which they do from this share of further passes on.
_DENSE, _HIDDEN = 52, 0.02
#: Fields that are remembered.
_KEPT = 64


class PassPattern(Protocol):
    """Passes of one kind over a face."""

    @property
    def name(self) -> str:
        """One of `toolaxis.plan.choices.PATTERNS`."""

    def screen(self, axes: Array) -> Estimates:
        """About how many passes axes (k, 3) take and how long, for both feeds."""

    def count(self, cut: Cut, feed: str) -> Count:
        """Number and length of the passes with one axis; infinite where there are none of this kind."""

    def weigh(self, axis: Array, feed: str) -> Count:
        """The same told from fewer places; infinite too where these do not suffice."""

    def chart(self, cut: Cut, feed: str) -> PassChart:
        """The chart by which passes with an axis are laid.

        Raises
        ------
        UnsupportedGeometry
            When passes of this kind do not go with the face.
        """


@dataclass(frozen=True, eq=False)
class IsoPasses:
    """Passes along a parameter of the face."""

    estimator: Estimator
    name: str = ISO

    @cached_property
    def _charts(self) -> tuple[IsoChart, IsoChart]:
        return IsoChart(self.estimator.face, "u"), IsoChart(self.estimator.face, "v")

    def screen(self, axes: Array) -> Estimates:
        """About how many passes axes (k, 3) take and how long, for both feeds: from second-order widths."""
        return self.estimator.many(axes, exact=False)

    def count(self, cut: Cut, feed: str) -> Count:
        """Number and length of the passes with one axis by exact widths."""
        return measure(self.chart(cut, feed), cut, most=_COUNTED)

    def weigh(self, axis: Array, feed: str) -> Count:
        """The same from exact widths at the sample points; infinite too where one of these has none."""
        return _weigh(self.estimator, axis, feed)

    def chart(self, cut: Cut, feed: str) -> IsoChart:
        """The face in its own parameters."""
        return self._charts[FEEDS.index(feed)]


@dataclass(frozen=True, eq=False)
class PlanePasses:
    """Passes along parallel planes in the mean direction of a parameter."""

    estimator: Estimator
    name: str = PLANES

    def screen(self, axes: Array) -> Estimates:
        """About how many passes axes (k, 3) take and how long: as those along parameters do."""
        return self.estimator.many(axes, exact=False)

    def count(self, cut: Cut, feed: str) -> Count:
        """Number and length of the passes with one axis by exact widths; infinite where planes do not go."""
        try:
            return measure(self.chart(cut, feed), cut, most=_COUNTED)
        except UnsupportedGeometry:  # told where such passes are made
            return Count(np.inf, np.inf)

    def weigh(self, axis: Array, feed: str) -> Count:
        """As for passes along parameters."""
        return _weigh(self.estimator, axis, feed)

    def chart(self, cut: Cut, feed: str) -> PlaneChart:
        """The face as seen along the axis."""
        return PlaneChart(self.estimator.face, cut.axis, mean_feed_across(cut.axis, feeds_over(self.estimator.face,
                                                                                               feed)))


@dataclass(frozen=True, eq=False)
class FieldPasses:
    """Passes along the levels of a field, each of which runs through every value of one parameter."""

    estimator: Estimator
    name: str = FIELD
    _kept: dict[tuple[bytes, str], LevelChart] = field(default_factory=dict)
    _last: dict[bytes, DirectionTable] = field(default_factory=dict)

    @cached_property
    def _forms(self) -> DirectionForms:
        own = self.estimator
        return DirectionForms.of(own.face, own.tool, own.scallop, own.allowance, own.greatest_step_over)

    def screen(self, axes: Array) -> Estimates:
        """Ideal number and length of the passes with axes (k, 3), the same for both feeds."""
        return self._forms.estimate(axes)

    def count(self, cut: Cut, feed: str) -> Count:
        """About the number and the length of the passes with one axis, from a coarse field."""
        cells, count, rounds = _PRICED
        try:
            table = self._price_table(cut)
            if not table.cut_everywhere:
                return Count(np.inf, np.inf)
            found = find_field(table, 1 - FEEDS.index(feed), count, rounds)
            more = 1 + hidden_passes(LevelChart(self.estimator.face, feed, found), cut, cells)
        except UnsupportedGeometry:
            return Count(np.inf, np.inf)
        return Count(more * found.passes, more * found.length)

    def weigh(self, axis: Array, feed: str) -> Count:
        """Infinite: lengths of fields differ from the ideal ones by more than these do from axis to axis."""
        return Count(np.inf, np.inf)

    def _price_table(self, cut: Cut) -> DirectionTable:
        """The table of an axis by which it is priced, the same for both feeds: the last one is kept."""
        key = cut.axis.tobytes()
        if key not in self._last:
            self._last.clear()
            self._last[key] = tabulate_directions(self.estimator.face, cut, _PRICED[0])
        return self._last[key]

    def chart(self, cut: Cut, feed: str) -> LevelChart:
        """The face in the levels of the field of least length."""
        key = cut.axis.tobytes(), feed
        if key not in self._kept:
            found = self._find_chart(cut, feed, _MADE[0])
            if hidden_passes(found, cut, _MADE[0]) > _HIDDEN:
                found = self._find_chart(cut, feed, _DENSE)
            if len(self._kept) >= _KEPT:
                self._kept.pop(next(iter(self._kept)))
            self._kept[key] = found
        return self._kept[key]

    def _find_chart(self, cut: Cut, feed: str, cells: int) -> LevelChart:
        """The chart of the field of least length, told from so many cells each way."""
        face, (_, count, rounds) = self.estimator.face, _MADE
        table = tabulate_directions(face, cut, cells)
        return LevelChart(face, feed, find_field(table, 1 - FEEDS.index(feed), count, rounds))


def _weigh(estimator: Estimator, axis: Array, feed: str) -> Count:
    found, column = estimator.many(axis[None], feed), FEEDS.index(feed)
    return Count(float(found.passes[0, column]), float(found.length[0, column]))


def pattern_names(passes: str) -> tuple[str, ...]:
    """The patterns among which a plan's choice of passes leaves the shortest to be taken.

    Parameters
    ----------
    passes : str
        One of `toolaxis.plan.choices.PASSES`.
    """
    return (ISO, FIELD) if passes == AUTO else (passes,)


def patterns_of(estimator: Estimator, passes: str) -> tuple[PassPattern, ...]:
    """The same made ready for a face.

    Parameters
    ----------
    estimator : Estimator
        The face made ready.
    passes : str
        One of `toolaxis.plan.choices.PASSES`.
    """
    known: dict[str, Callable[[Estimator], PassPattern]] = {ISO: IsoPasses, PLANES: PlanePasses, FIELD: FieldPasses}
    return tuple(known[name](estimator) for name in pattern_names(passes))


def pattern_name(chart: Chart) -> str:
    """How the passes of a chart lie: one of `toolaxis.plan.choices.PATTERNS`.

    Parameters
    ----------
    chart : Chart
    """
    if isinstance(chart, LevelChart):
        return FIELD
    return PLANES if isinstance(chart, PlaneChart) else ISO


def feeds_over(face: Face, feed: str) -> Array:
    """Feed directions over a face, (n, 3), not of unit length.

    Parameters
    ----------
    face : Face
    feed : "u" or "v"
    """
    d = face.evaluate(face.grid(_GRID, _GRID))
    return np.asarray(d.su if feed == "u" else d.sv)
