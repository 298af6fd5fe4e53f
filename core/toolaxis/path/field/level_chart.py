"""A face in the levels of a field: passes run along them, each through every value of one parameter."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import DIVIDE
from toolaxis.contact.strip.second_order import contact_forms, screen_numpy
from toolaxis.contact.strip.width import strip_width
from toolaxis.errors import UnsupportedGeometry
from toolaxis.numeric.vectors import dot, unit
from toolaxis.path.field.pass_field import PassField
from toolaxis.path.free_chart import FreeChart
from toolaxis.path.parametrization import Cut
from toolaxis.path.width_correction import lean_ratios

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Lines and places on each from which levels are looked for; Newton steps, and what is exact enough, as a share of the
#: range.
_LINES, _PLACES, _ITERATIONS, _EXACT = 65, 65, 40, 1e-13
#: Places each way at which it is looked whether the field grows across the passes.
_LOOKED = 65
#: Steps that find where the border of a strip lies.
_BORDER = 4
#: Bends of sections, mm * 1/mm, below which a section is straight.
_STRAIGHT = 1e-9


@dataclass(frozen=True, eq=False)
class LevelChart(FreeChart):
    """A face in its own parameter along passes and a field across them.

    Attributes
    ----------
    face : Face
    feed : "u" or "v"
        The parameter that varies along the passes.
    field : PassField
        It grows with the other parameter on every line across the passes.

    Raises
    ------
    UnsupportedGeometry
        When it does not.
    """

    feed: str
    field: PassField

    def __post_init__(self) -> None:
        ends = self.field.surface.domain
        along = np.linspace(*ends[1 - self._across], _LOOKED)
        across = np.linspace(*ends[self._across], _LOOKED)
        everywhere = self._join(np.repeat(along, _LOOKED), np.tile(across, _LOOKED))
        if not (self._rate(everywhere) > 0).all():
            raise UnsupportedGeometry(f"passes in a field along {self.feed} turn back on face {self.face.label}: "
                                      f"use iso-parametric passes, or {DIVIDE}")

    @property
    def _across(self) -> int:
        return 1 if self.feed == "u" else 0

    def _rate(self, uv: Array) -> Array:
        """How fast the field grows across the passes, (n,)."""
        found = self.field.at(uv)
        return found.by_v if self.feed == "u" else found.by_u

    def _join(self, along: Array, across: Array) -> Array:
        """Parameters (n, 2) from the one along the passes and the other."""
        columns = [along, across]
        if self.feed == "v":
            columns = [across, along]
        return np.column_stack(columns)

    @property
    def breaks(self) -> tuple[Array, Array]:
        """Inner knots along the passes; those across do not run along them."""
        a0, a1, _, _ = self.bounds
        along = self.face.surface.breaks[1 - self._across]
        inner = (along > a0) & (along < a1)
        return along[inner], np.empty(0)

    @cached_property
    def _table(self) -> tuple[Array, Array, Array]:
        """Lines, places across on each, and the field there (lines, places), from which levels are looked for."""
        u0, u1, v0, v1 = self.face.bounds
        ends = ((u0, u1), (v0, v1))
        begin, end = ends[1 - self._across]
        low, high = ends[self._across]
        lines = np.linspace(begin, end, _LINES)
        beyond = 0.5 * (high - low)
        places = np.linspace(low - beyond, high + beyond, _PLACES)
        uv = self._join(np.repeat(lines, _PLACES), np.tile(places, _LINES))
        values = self.field.at(uv).value
        return lines, places, values.reshape(_LINES, _PLACES)

    def uv(self, along: Array, step: Array) -> Array:
        """Parameters (n, 2) of the face at along and step, (n,) each, by Newton's method; beyond the face too."""
        _, places, values = self._table
        across = self._first_guess(along, step)
        far = places[-1] - places[0]
        farthest_move = 0.25 * far
        least_rate = 1e-6 * (values[0, -1] - values[0, 0]) / far
        todo = np.arange(len(along))
        for _ in range(_ITERATIONS):
            uv = self._join(along[todo], across[todo])
            found = self.field.at(uv)
            rate = found.by_v if self.feed == "u" else found.by_u
            missing = step[todo] - found.value
            move = missing / np.maximum(rate, least_rate)
            move = np.clip(move, -farthest_move, farthest_move)
            across[todo] += move
            todo = todo[np.abs(move) > _EXACT * far]
            if not len(todo):
                break
        return self._join(along, across)

    def _first_guess(self, along: Array, step: Array) -> Array:
        """About where the levels lie across the passes, from the nearest line of the table, (n,)."""
        lines, places, values = self._table
        nearest = np.rint((along - lines[0]) / (lines[1] - lines[0]))
        nearest = np.clip(nearest, 0, _LINES - 1).astype(int)
        across = np.empty(len(along))
        for line in np.unique(nearest):
            own = nearest == line
            across[own] = np.interp(step[own], values[line], places)
        return across

    def places(self, uv: Array) -> Array:
        """Along and step of parameters of the face, (n, 2): the inverse of `uv`."""
        along = uv[:, 1 - self._across]
        return np.column_stack([along, self.field.at(uv).value])

    def feed_at(self, uv: Array) -> Array:
        """Unit feed directions of passes at parameters, (n, 3): along the levels of the field."""
        way = self._along_levels(uv)
        return np.asarray(unit(way if self.feed == "u" else -way))

    def _along_levels(self, uv: Array) -> Array:
        """Tangents of the field's levels at parameters, as long as the field is steep, (n, 3)."""
        d = self.face.evaluate(uv)
        found = self.field.at(uv)
        along_u = d.su * found.by_v[:, None]
        along_v = d.sv * found.by_u[:, None]
        return np.asarray(along_u - along_v)

    def half_widths(self, cut: Cut, along: Array, step: Array) -> Array:
        """Half widths (n, 2) in the step parameter, towards its lower and its upper end.

        The strip's border is found in the section normal to the feed, and the field is asked there.
        """
        uv, feed = self.clip(along, step)
        width = strip_width(self.face, cut.tool, uv, cut.axis, cut.scallop, feed, cut.allowance)
        to_left, to_right = width.T
        here = self.field.at(uv).value
        at_right = self.field.at(self._aside(uv, feed, -to_right)).value
        at_left = self.field.at(self._aside(uv, feed, to_left)).value
        right = np.abs(at_right - here)
        left = np.abs(at_left - here)
        left_is_higher = self._left_is_higher(uv, feed)
        lower = np.where(left_is_higher, right, left)
        upper = np.where(left_is_higher, left, right)
        return np.column_stack([lower, upper])

    def _left_is_higher(self, uv: Array, feed: Array) -> Bools:
        """Whether the field grows to the left of the feed."""
        d = self.face.evaluate(uv)
        left = np.cross(self.face.normal(uv), feed)
        across = d.sv if self.feed == "u" else d.su
        return np.asarray(dot(across, left) > 0)

    def _aside(self, uv: Array, feed: Array, way: Array) -> Array:
        """Parameters at arc lengths (n,) to the left of contacts in the section normal to the feed, by Newton's method.

        The section is a circle of the surface's curvature there, to the third order of the way.
        """
        surface = self.face.surface.spline
        start = surface.evaluate(uv).point
        left = np.cross(self.face.normal(uv), feed)
        forms = contact_forms(self.face, uv, feed, False)
        bend = forms[:, 11] * way
        chord = np.sin(bend) / np.where(bend != 0, bend, 1.0)
        reach = way * np.where(np.abs(bend) > _STRAIGHT, chord, 1.0)
        found = uv.copy()
        for _ in range(_BORDER):
            d = surface.evaluate(found)
            away = d.point - start
            miss_f = -dot(away, feed)
            miss_l = reach - dot(away, left)
            u_f = dot(d.su, feed)
            v_f = dot(d.sv, feed)
            u_l = dot(d.su, left)
            v_l = dot(d.sv, left)
            det = u_f * v_l - v_f * u_l
            det = np.where(np.abs(det) > 1e-300, det, 1e-300)
            along_u = miss_f * v_l - v_f * miss_l
            along_v = u_f * miss_l - u_l * miss_f
            found += np.column_stack([along_u, along_v]) / det[:, None]
        return found

    def screen(self, cut: Cut, along: Array, step: Array) -> Array:
        """About the two half widths together, (n,), in the step parameter: second-order, corrected for the lean."""
        uv, feed = self.clip(along, step)
        forms = contact_forms(self.face, uv, feed, False)
        half = np.empty((1, len(forms)))
        screen_numpy(forms, cut.axis[None], cut.numbers, cut.scallop, half)
        lead = forms[:, :3] @ cut.axis
        tilt = forms[:, 3:6] @ cut.axis
        ratio = lean_ratios(cut.leans, lead, tilt)
        return np.asarray(2 * half[0] * ratio * self.gradient(uv))

    def gradient(self, uv: Array) -> Array:
        """How fast the field grows across the passes at parameters, (n,) 1/mm."""
        d = self.face.evaluate(uv)
        area = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
        along = np.linalg.norm(self._along_levels(uv), axis=1)
        return np.asarray(along / area)

    def run_outs(self, cut: Cut, along: Array, step: Array) -> Array:
        """How far, in the along parameter, the cutter reaches at scallop height before and behind a contact, (n, 2)."""
        uv, feed = self.clip(along, step)
        across = np.cross(self.face.normal(uv), feed)
        width = strip_width(self.face, cut.tool, uv, cut.axis, cut.scallop, across, cut.allowance)
        return np.asarray(width / self._speed(uv)[:, None])

    def _speed(self, uv: Array) -> Array:
        """mm along a pass per unit of the along parameter, (n,)."""
        way = np.linalg.norm(self._along_levels(uv), axis=1)
        return np.asarray(way / np.abs(self._rate(uv)))
