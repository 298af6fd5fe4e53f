"""A field on a face whose levels are passes, as far apart as their strips are wide: found by least cutting length."""

from dataclasses import dataclass
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.numeric.bspline import basis_derivatives_numpy
from toolaxis.numeric.descent import descend
from toolaxis.path.field.direction_table import DirectionTable
from toolaxis.shape.nurbs import NurbsSurface, uniform_knots
from toolaxis.work import spend

Array = NDArray[np.float64]

#: Slopes of the straight fields, along against across, from which the search begins.
_STARTS = (-0.7, 0.0, 0.7)
#: Powers by which narrow places weigh, in turn: with the last the mean is nearly the narrowest place.
_FIRST_POWERS, _LAST_POWERS = (4.0, 12.0), (12.0, 32.0)
#: Passes lean at most so much against the parameter along them; how hard more is punished; places each way, off a
#: trimmed face too, at which it is looked at.
_STEEPEST, _PUNISHED, _LOOKED = 2.5, 30.0, 24
#: Least rate across the passes, as a share of the mean one; places each way at which it is kept.
_LEAST_RATE, _KEPT = 0.02, 96
#: Weight of the bend of the field.
_BEND = 1e-3
#: Levels at which it is asked what the narrowest place of a pass is.
_LEVELS = 24
#: Least sine of the angle between a pass and the border where it ends.
_ASLANT = 0.2
#: As many bounds of distances as take as long as the cost of a field at a place.
_PLACE = 3


class Values(NamedTuple):
    """A field at n places: its value and its rates with u and v, (n,) each."""

    value: Array
    by_u: Array
    by_v: Array


@dataclass(frozen=True, eq=False)
class PassField:
    """A field over the parameters of a face; it grows from pass to pass, by one where the scallop height is reached.

    Attributes
    ----------
    surface : NurbsSurface
        The field stands in z; its domain is the range of the face, beyond which it goes on straight ahead.
    length : float
        About how long the passes are with their run-outs, mm of the tip's motion.
    passes : float
        About how many there are.
    """

    surface: NurbsSurface
    length: float
    passes: float

    def at(self, uv: Array) -> Values:
        """The field at parameters, (n, 2)."""
        d = self.surface.evaluate(uv)
        return Values(d.point[:, 2], d.su[:, 2], d.sv[:, 2])


class _Basis(NamedTuple):
    """The basis on a lattice of places: values and rates along u, (nu, count) each, and along v, (nv, count) each."""

    of_u: Array
    by_u: Array
    of_v: Array
    by_v: Array

    @staticmethod
    def at(knots: tuple[Array, Array], places: tuple[Array, Array]) -> "_Basis":
        """The basis of cubic fields with knots along u and v at places along them."""
        found = []
        for own, some in zip(knots, places, strict=True):
            rows, first = basis_derivatives_numpy(own, 3, some)
            for order in (0, 1):
                full = np.zeros((len(some), len(own) - 4))
                full[np.arange(len(some))[:, None], first[:, None] + np.arange(4)] = rows[:, order]
                found.append(full)
        return _Basis(*found)

    def values(self, coefficients: Array) -> Array:
        """The field, (nu nv,)."""
        return np.asarray(self.of_u @ coefficients @ self.of_v.T).ravel()

    def rates(self, coefficients: Array) -> tuple[Array, Array]:
        """Its rates with u and v, (nu nv,) each."""
        return ((self.by_u @ coefficients @ self.of_v.T).ravel(), (self.of_u @ coefficients @ self.by_v.T).ravel())

    def pull_back(self, by_u: Array, by_v: Array) -> Array:
        """What rates of a number with the rates of the field, (nu nv,) each, mean for the coefficients."""
        shape = len(self.of_u), len(self.of_v)
        return np.asarray(self.by_u.T @ by_u.reshape(shape) @ self.of_v + self.of_u.T @ by_v.reshape(shape) @ self.by_v)


@dataclass(frozen=True, eq=False)
class FieldProblem:
    """Fields of count x count coefficients on a face.

    Attributes
    ----------
    table : DirectionTable
    count : int
    across : int
        0 where the field grows with u along every line of the other parameter, 1 where it grows with v.
    """

    table: DirectionTable
    count: int
    across: int

    @cached_property
    def knots(self) -> tuple[Array, Array]:
        """Knots along u and v."""
        u0, u1, v0, v1 = self.table.face.bounds
        own = uniform_knots(self.count, 3)
        return u0 + (u1 - u0) * own, v0 + (v1 - v0) * own

    @cached_property
    def basis(self) -> "_Basis":
        """At the table's places."""
        uv = self.table.uv.reshape(self.table.count, self.table.count, 2)
        return _Basis.at(self.knots, (uv[:, 0, 0], uv[0, :, 1]))

    @cached_property
    def around(self) -> "_Basis":
        """At even places over the range of the face, off a trimmed face too."""
        along_u, along_v = (np.linspace(knots[0], knots[-1], _LOOKED) for knots in self.knots)
        return _Basis.at(self.knots, (along_u, along_v))

    @cached_property
    def sizes(self) -> tuple[float, float]:
        """Mean mm of the face per unit of u and of v."""
        weight = self.table.area / self.whole
        return float(weight @ self.table.metric[:, 0]), float(weight @ np.hypot(*self.table.metric[:, 1:].T))

    @cached_property
    def whole(self) -> float:
        """Area of the face, mm^2."""
        return float(self.table.area.sum())

    def straight(self, slope: float) -> Array:
        """Coefficients of a field whose passes all lean by a slope, about, against the parameter along them."""
        size = self.sizes
        middles = [_middles(knots) for knots in self.knots]
        rate = (slope, 1.0) if self.across == 1 else (1.0, slope)
        return np.asarray(size[0] * rate[0] * middles[0][:, None] + size[1] * rate[1] * middles[1])

    def gradient(self, coefficients: Array) -> tuple[Array, Array]:
        """Components of the field's gradient along Su and across it, 1/mm, (n,) each."""
        rate_u, rate_v = self.basis.rates(coefficients)
        size, shear, height = self.table.metric.T
        first = rate_u / size
        return first, (rate_v - shear * first) / height

    def _pull_back(self, first: Array, second: Array) -> Array:
        """What rates of a cost with the gradient's components mean for the coefficients."""
        size, shear, height = self.table.metric.T
        by_second = second / height
        return self.basis.pull_back(first / size - by_second * shear / size, by_second)

    def narrowness(self, first: Array, second: Array) -> tuple[Array, Array, Array]:
        """Logarithm of spacing over strip width where the field grows by one, and its rates with the gradient."""
        square = first**2 + second**2
        width, turn = self.table.width.at(_double(first, second, square))
        change = np.stack([-first + turn * second, -second - turn * first]) / square
        return -0.5 * np.log(square) - width, change[0], change[1]

    def length(self, first: Array, second: Array) -> tuple[Array, Array, Array]:
        """Way of the tip at each place where passes lie one apart in the field, mm, and its rates with the gradient."""
        square = first**2 + second**2
        tip, turn = self.table.tip.at(_double(first, second, square))
        cell = np.sqrt(square) * np.exp(tip) * self.table.area
        return cell, cell * (first - turn * second) / square, cell * (second + turn * first) / square

    def cost(self, given: Array, power: float) -> tuple[float, Array]:
        """Logarithm of the cutting length, with what keeps the field a good one, and its gradient.

        Parameters
        ----------
        given : (count^2,) array
        power : float
        """
        spend(_PLACE * len(self.table.area))
        coefficients = given.reshape(self.count, self.count)
        first, second = self.gradient(coefficients)
        cell, cell_1, cell_2 = self.length(first, second)
        total = cell.sum()
        narrow, narrow_1, narrow_2 = self.narrowness(first, second)
        top = narrow[self.table.area > 0].max()
        share = np.exp(np.minimum(power * (narrow - top), 0.0)) * self.table.area
        mean = share.sum()
        share /= mean
        value = np.log(total) + top + np.log(mean / self.whole) / power
        slope = self._pull_back(cell_1 / total + share * narrow_1, cell_2 / total + share * narrow_2)
        steep, by_steep = self._steepness(coefficients)
        bend, by_bend = self._bend(coefficients)
        return float(value + steep + bend), (slope + by_steep + by_bend).ravel()

    def _steepness(self, coefficients: Array) -> tuple[float, Array]:
        """What is charged where passes lean too much against the parameter along them, and its rates."""
        first, second = (rate / size for rate, size in zip(self.around.rates(coefficients), self.sizes, strict=True))
        along, across = (first, second) if self.across == 1 else (second, first)
        square = first**2 + second**2
        over = np.maximum(np.abs(along) - _STEEPEST * across, 0.0)
        weight = _PUNISHED / len(over)
        value = weight * over**2 / square
        by_along = 2 * (weight * over * np.sign(along) - value * along) / square
        by_across = -2 * (weight * over * _STEEPEST + value * across) / square
        by_first, by_second = (by_along, by_across) if self.across == 1 else (by_across, by_along)
        return float(value.sum()), self.around.pull_back(by_first / self.sizes[0], by_second / self.sizes[1])

    @cached_property
    def _differences(self) -> tuple[Array, Array]:
        """First and second differences of coefficients, as matrices; second ones of a straight field are zero."""
        gaps = np.diff(_middles(uniform_knots(self.count, 3)))
        first = np.diff(np.eye(self.count), axis=0) * (gaps.mean() / gaps)[:, None]
        return first, np.diff(first, axis=0)

    def _bend(self, coefficients: Array) -> tuple[float, Array]:
        """Weight of second against first differences of coefficients, and its gradient."""
        once, twice = self._differences
        rise, turn = (once @ coefficients, coefficients @ once.T), (twice @ coefficients, coefficients @ twice.T)
        twist = once @ coefficients @ once.T
        bent = float((turn[0] ** 2).sum() + (turn[1] ** 2).sum() + 2 * (twist**2).sum())
        risen = float((rise[0] ** 2).sum() + (rise[1] ** 2).sum())
        by_bent = 2 * (twice.T @ turn[0] + turn[1] @ twice) + 4 * once.T @ twist @ once
        by_risen = 2 * (once.T @ rise[0] + rise[1] @ once)
        weight = _BEND * self.count**2 / risen
        return weight * bent, weight * (by_bent - bent / risen * by_risen)

    def descend(self, coefficients: Array, powers: tuple[float, ...], rounds: int) -> tuple[float, Array]:
        """Cost and coefficients after so many rounds downhill with each power."""
        value, found = np.inf, coefficients.ravel()
        for power in powers:
            value, found = descend(partial(self.cost, power=power), found, rounds)
        return value, found.reshape(self.count, self.count)

    def mix_growing(self, coefficients: Array) -> Array:
        """Coefficients mixed with those of a straight field, as little as makes the field grow across all passes."""
        ends = [np.linspace(knots[0], knots[-1], _KEPT) for knots in self.knots]
        lattice = _Basis.at(self.knots, (ends[0], ends[1]))
        straight = self.straight(0.0)
        rate, even = (lattice.rates(one)[self.across] for one in (coefficients, straight))
        mean = float(rate.mean())
        if mean <= 0:
            return straight
        straight, even = straight * (mean / even.mean()), even * (mean / even.mean())
        short = np.maximum(_LEAST_RATE * mean - rate, 0.0)
        share = float((short / np.where(short > 0, even - rate, 1.0)).max())
        return np.asarray((1 - share) * coefficients + share * straight)

    def _run_outs(self, coefficients: Array) -> Array:
        """How far the tip goes on past the ends of passes one apart in the field, mm, at the places where they end.

        A pass goes on for half the width of a strip across it, or, where it ends aslant, until its strip is cut up to
        the border.  Ends at holes and trimmed borders are reckoned as on the border of the range.
        """
        count, (u0, u1, v0, v1) = self.table.count, self.table.face.bounds
        first, second = self.gradient(coefficients)
        square = first**2 + second**2
        double = _double(first, second, square)
        ahead = 0.5 * np.exp(self.table.width.at((-double[0], -double[1]))[0])
        aside = 0.5 * np.exp(self.table.width.at(double)[0])
        tip = np.exp(self.table.tip.at(double)[0])
        rates = self.basis.rates(coefficients)
        total = np.zeros((count, count))
        along_v = self.table.metric[:, 1:] / np.hypot(*self.table.metric[:, 1:].T)[:, None]
        along_u = np.broadcast_to(np.array([1.0, 0.0]), along_v.shape)
        for along, rate, span, ends in ((along_u, rates[0], u1 - u0, np.s_[:, [0, -1]]),
                                        (along_v, rates[1], v1 - v0, np.s_[[0, -1], :])):
            across = np.abs(first * along[:, 1] - second * along[:, 0]) / np.sqrt(square)
            sine = np.sqrt(np.maximum(1 - across**2, _ASLANT**2))
            way = np.maximum(ahead, aside * across / sine) * tip
            number = np.abs(rate) * span / (count - 1)
            total[ends] += (number * way).reshape(count, count)[ends]
        return total.ravel()

    def build(self, coefficients: Array) -> PassField:
        """The field, scaled so that it grows by one from pass to pass, with what its passes come to.

        A pass lies as far from the one before as its narrowest place allows: over each of a number of levels the field
        is what the narrowest place there says.
        """
        first, second = self.gradient(coefficients)
        cell = self.length(first, second)[0] + self._run_outs(coefficients)
        narrow = np.exp(self.narrowness(first, second)[0])
        value = self.basis.values(coefficients)
        inside = self.table.area > 0
        low, high = value[inside].min(), value[inside].max()
        level = np.clip(((value - low) / max(high - low, 1e-300) * _LEVELS).astype(int), 0, _LEVELS - 1)
        rate = np.zeros(_LEVELS)
        np.maximum.at(rate, level[inside], narrow[inside])
        length = float(np.bincount(level, weights=cell, minlength=_LEVELS) @ rate)
        passes = float(rate.mean() * (high - low))
        scale = passes / max(high - low, 1e-300)
        points = np.zeros((self.count, self.count, 3))
        points[..., 2] = scale * coefficients
        return PassField(NurbsSurface.from_points(points, (3, 3), self.knots), length, passes)


def find_field(table: DirectionTable, across: int, count: int = 14, rounds: int = 60) -> PassField:
    """The field of passes with about the least cutting length over a face.

    Parameters
    ----------
    table : DirectionTable
    across : int
        0 or 1: the parameter, u or v, with which the field grows along every line of the other.
    count : int
        Coefficients each way.
    rounds : int
        Steps downhill with each power.

    Notes
    -----
    Passes one apart in the field phi are |grad phi|^-1 apart; with w the strip width the length
    `int |grad phi| dA max(1 / (w |grad phi|))` is made least, the maximum as a mean with a growing power. It depends on
    neither the scale of phi nor, but for the bend that is charged, on how phi is counted from level to level.

    **Source**: passes as levels of a function, of least length, are those of [zou2020]; the cost is our own.

    **Properties**: 1. never below `DirectionTable.ideal_length`, but for the resolution of the cells.
    """
    problem = FieldProblem(table, count, across)
    tried = [problem.descend(problem.straight(slope), _FIRST_POWERS, rounds // 2) for slope in _STARTS]
    best = min(tried, key=lambda one: one[0])
    return problem.build(problem.mix_growing(problem.descend(best[1], _LAST_POWERS, rounds)[1]))


def _middles(knots: Array) -> Array:
    """Means of the knots of each coefficient: coefficients of the straight line."""
    return np.convolve(knots[1:-1], np.full(3, 1 / 3), mode="valid")


def _double(first: Array, second: Array, square: Array) -> tuple[Array, Array]:
    """Cosine and sine of twice the angle of a direction."""
    return (first**2 - second**2) / square, 2 * first * second / square
