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
            derivatives, first = basis_derivatives_numpy(own, 3, some)
            row = np.arange(len(some))[:, None]
            column = first[:, None] + np.arange(4)
            for order in (0, 1):
                full = np.zeros((len(some), len(own) - 4))
                full[row, column] = derivatives[:, order]
                found.append(full)
        return _Basis(*found)

    def values(self, coefficients: Array) -> Array:
        """The field, (nu nv,)."""
        lattice = self.of_u @ coefficients @ self.of_v.T
        return np.asarray(lattice).ravel()

    def rates(self, coefficients: Array) -> tuple[Array, Array]:
        """Its rates with u and v, (nu nv,) each."""
        by_u = self.by_u @ coefficients @ self.of_v.T
        by_v = self.of_u @ coefficients @ self.by_v.T
        return by_u.ravel(), by_v.ravel()

    def pull_back(self, by_u: Array, by_v: Array) -> Array:
        """What rates of a number with the rates of the field, (nu nv,) each, mean for the coefficients."""
        shape = len(self.of_u), len(self.of_v)
        from_u = self.by_u.T @ by_u.reshape(shape) @ self.of_v
        from_v = self.of_u.T @ by_v.reshape(shape) @ self.by_v
        return np.asarray(from_u + from_v)


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
        number = self.table.count
        uv = self.table.uv.reshape(number, number, 2)
        along_u = uv[:, 0, 0]
        along_v = uv[0, :, 1]
        return _Basis.at(self.knots, (along_u, along_v))

    @cached_property
    def around(self) -> "_Basis":
        """At even places over the range of the face, off a trimmed face too."""
        along_u, along_v = (np.linspace(knots[0], knots[-1], _LOOKED) for knots in self.knots)
        return _Basis.at(self.knots, (along_u, along_v))

    @cached_property
    def sizes(self) -> tuple[float, float]:
        """Mean mm of the face per unit of u and of v."""
        weight = self.table.area / self.whole
        size_u, shear, height = self.table.metric.T
        size_v = np.hypot(shear, height)
        return float(weight @ size_u), float(weight @ size_v)

    @cached_property
    def whole(self) -> float:
        """Area of the face, mm^2."""
        return float(self.table.area.sum())

    def straight(self, slope: float) -> Array:
        """Coefficients of a field whose passes all lean by a slope, about, against the parameter along them."""
        size_u, size_v = self.sizes
        middles_u, middles_v = (_middles(knots) for knots in self.knots)
        rate_u, rate_v = (slope, 1.0) if self.across == 1 else (1.0, slope)
        return np.asarray(size_u * rate_u * middles_u[:, None] + size_v * rate_v * middles_v)

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
        by_first = (-first + turn * second) / square
        by_second = (-second - turn * first) / square
        return -0.5 * np.log(square) - width, by_first, by_second

    def length(self, first: Array, second: Array) -> tuple[Array, Array, Array]:
        """Way of the tip at each place where passes lie one apart in the field, mm, and its rates with the gradient."""
        square = first**2 + second**2
        tip, turn = self.table.tip.at(_double(first, second, square))
        cell = np.sqrt(square) * np.exp(tip) * self.table.area
        by_first = cell * (first - turn * second) / square
        by_second = cell * (second + turn * first) / square
        return cell, by_first, by_second

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
        # A mean of powers over the face stands for the narrowest place.
        exponent = np.minimum(power * (narrow - top), 0.0)
        share = np.exp(exponent) * self.table.area
        mean = share.sum()
        share /= mean
        value = np.log(total) + top + np.log(mean / self.whole) / power
        by_first = cell_1 / total + share * narrow_1
        by_second = cell_2 / total + share * narrow_2
        slope = self._pull_back(by_first, by_second)
        steep, by_steep = self._steepness(coefficients)
        bend, by_bend = self._bend(coefficients)
        return float(value + steep + bend), (slope + by_steep + by_bend).ravel()

    def _steepness(self, coefficients: Array) -> tuple[float, Array]:
        """What is charged where passes lean too much against the parameter along them, and its rates."""
        size_u, size_v = self.sizes
        rate_u, rate_v = self.around.rates(coefficients)
        first = rate_u / size_u
        second = rate_v / size_v
        along, across = (first, second) if self.across == 1 else (second, first)
        square = first**2 + second**2
        over = np.maximum(np.abs(along) - _STEEPEST * across, 0.0)
        weight = _PUNISHED / len(over)
        value = weight * over**2 / square
        by_along = 2 * (weight * over * np.sign(along) - value * along) / square
        by_across = -2 * (weight * over * _STEEPEST + value * across) / square
        by_first, by_second = (by_along, by_across) if self.across == 1 else (by_across, by_along)
        rates = self.around.pull_back(by_first / size_u, by_second / size_v)
        return float(value.sum()), rates

    @cached_property
    def _differences(self) -> tuple[Array, Array]:
        """First and second differences of coefficients, as matrices; second ones of a straight field are zero."""
        gaps = np.diff(_middles(uniform_knots(self.count, 3)))
        first = np.diff(np.eye(self.count), axis=0) * (gaps.mean() / gaps)[:, None]
        return first, np.diff(first, axis=0)

    def _bend(self, coefficients: Array) -> tuple[float, Array]:
        """Weight of second against first differences of coefficients, and its gradient."""
        once, twice = self._differences
        rise_u = once @ coefficients
        rise_v = coefficients @ once.T
        turn_u = twice @ coefficients
        turn_v = coefficients @ twice.T
        twist = once @ coefficients @ once.T
        bent = float((turn_u**2).sum() + (turn_v**2).sum() + 2 * (twist**2).sum())
        risen = float((rise_u**2).sum() + (rise_v**2).sum())
        by_bent = 2 * (twice.T @ turn_u + turn_v @ twice) + 4 * once.T @ twist @ once
        by_risen = 2 * (once.T @ rise_u + rise_v @ once)
        weight = _BEND * self.count**2 / risen
        return weight * bent, weight * (by_bent - bent / risen * by_risen)

    def descend(self, coefficients: Array, powers: tuple[float, ...], rounds: int) -> tuple[float, Array]:
        """Cost and coefficients after so many rounds downhill with each power."""
        value = np.inf
        found = coefficients.ravel()
        for power in powers:
            cost = partial(self.cost, power=power)
            value, found = descend(cost, found, rounds)
        return value, found.reshape(self.count, self.count)

    def mix_growing(self, coefficients: Array) -> Array:
        """Coefficients mixed with those of a straight field, as little as makes the field grow across all passes."""
        along_u, along_v = (np.linspace(knots[0], knots[-1], _KEPT) for knots in self.knots)
        lattice = _Basis.at(self.knots, (along_u, along_v))
        straight = self.straight(0.0)
        rate = lattice.rates(coefficients)[self.across]
        even = lattice.rates(straight)[self.across]
        mean = float(rate.mean())
        if mean <= 0:
            return straight
        as_steep = mean / even.mean()
        straight = straight * as_steep
        even = even * as_steep
        short = np.maximum(_LEAST_RATE * mean - rate, 0.0)
        gain = np.where(short > 0, even - rate, 1.0)
        share = float((short / gain).max())
        return np.asarray((1 - share) * coefficients + share * straight)

    def _run_outs(self, coefficients: Array) -> Array:
        """How far the tip goes on past the ends of passes one apart in the field, mm, at the places where they end.

        A pass goes on for half the width of a strip across it, or, where it ends aslant, until its strip is cut up to
        the border.  Ends at holes and trimmed borders are reckoned as on the border of the range.
        """
        number = self.table.count
        u0, u1, v0, v1 = self.table.face.bounds
        first, second = self.gradient(coefficients)
        square = first**2 + second**2
        cosine, sine = _double(first, second, square)
        log_ahead, _ = self.table.width.at((-cosine, -sine))
        log_aside, _ = self.table.width.at((cosine, sine))
        log_tip, _ = self.table.tip.at((cosine, sine))
        ahead = 0.5 * np.exp(log_ahead)
        aside = 0.5 * np.exp(log_aside)
        tip = np.exp(log_tip)
        by_u, by_v = self.basis.rates(coefficients)
        of_v = self.table.metric[:, 1:]
        along_v = of_v / np.hypot(*of_v.T)[:, None]
        along_u = np.broadcast_to(np.array([1.0, 0.0]), along_v.shape)
        total = np.zeros((number, number))
        for along, rate, span, ends in ((along_u, by_u, u1 - u0, np.s_[:, [0, -1]]),
                                        (along_v, by_v, v1 - v0, np.s_[[0, -1], :])):
            across = np.abs(first * along[:, 1] - second * along[:, 0]) / np.sqrt(square)
            aslant = np.sqrt(np.maximum(1 - across**2, _ASLANT**2))
            way = np.maximum(ahead, aside * across / aslant) * tip
            passes = np.abs(rate) * span / (number - 1)
            total[ends] += (passes * way).reshape(number, number)[ends]
        return total.ravel()

    def build(self, coefficients: Array) -> PassField:
        """The field, scaled so that it grows by one from pass to pass, with what its passes come to.

        A pass lies as far from the one before as its narrowest place allows: over each of a number of levels the field
        is what the narrowest place there says.
        """
        first, second = self.gradient(coefficients)
        inner, _, _ = self.length(first, second)
        cell = inner + self._run_outs(coefficients)
        log_narrow, _, _ = self.narrowness(first, second)
        narrow = np.exp(log_narrow)
        value = self.basis.values(coefficients)
        inside = self.table.area > 0
        low = value[inside].min()
        rise = value[inside].max() - low
        not_flat = max(rise, 1e-300)
        level = ((value - low) / not_flat * _LEVELS).astype(int)
        level = np.clip(level, 0, _LEVELS - 1)
        rate = np.zeros(_LEVELS)
        np.maximum.at(rate, level[inside], narrow[inside])
        length = float(np.bincount(level, weights=cell, minlength=_LEVELS) @ rate)
        passes = float(rate.mean() * rise)
        scale = passes / not_flat
        points = np.zeros((self.count, self.count, 3))
        points[..., 2] = scale * coefficients
        surface = NurbsSurface.from_points(points, (3, 3), self.knots)
        return PassField(surface, length, passes)


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
    _, best = min(tried, key=lambda one: one[0])
    _, found = problem.descend(best, _LAST_POWERS, rounds)
    return problem.build(problem.mix_growing(found))


def _middles(knots: Array) -> Array:
    """Means of the knots of each coefficient: coefficients of the straight line."""
    return np.convolve(knots[1:-1], np.full(3, 1 / 3), mode="valid")


def _double(first: Array, second: Array, square: Array) -> tuple[Array, Array]:
    """Cosine and sine of twice the angle of a direction."""
    cosine = (first**2 - second**2) / square
    sine = 2 * first * second / square
    return cosine, sine
