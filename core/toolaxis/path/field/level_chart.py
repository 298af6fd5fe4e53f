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
        along, across = (np.linspace(*end, _LOOKED) for end in (ends[1 - self._across], ends[self._across]))
        if not (self._rate(self._join(np.repeat(along, _LOOKED), np.tile(across, _LOOKED))) > 0).all():
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
        return np.column_stack([along, across] if self.feed == "u" else [across, along])

    @property
    def breaks(self) -> tuple[Array, Array]:
        """Inner knots along the passes; those across do not run along them."""
        a0, a1, _, _ = self.bounds
        along = self.face.surface.breaks[1 - self._across]
        return along[(along > a0) & (along < a1)], np.empty(0)

    @cached_property
    def _table(self) -> tuple[Array, Array, Array]:
        """Lines, places across on each, and the field there (lines, places), from which levels are looked for."""
        u0, u1, v0, v1 = self.face.bounds
        ends = ((u0, u1), (v0, v1))
        along, across = ends[1 - self._across], ends[self._across]
        lines = np.linspace(*along, _LINES)
        beyond = 0.5 * (across[1] - across[0])
        places = np.linspace(across[0] - beyond, across[1] + beyond, _PLACES)
        uv = self._join(np.repeat(lines, _PLACES), np.tile(places, _LINES))
        return lines, places, self.field.at(uv).value.reshape(_LINES, _PLACES)

    def uv(self, along: Array, step: Array) -> Array:
        """Parameters (n, 2) of the face at along and step, (n,) each, by Newton's method; beyond the face too."""
        lines, places, values = self._table
        nearest = np.clip(np.rint((along - lines[0]) / (lines[1] - lines[0])), 0, _LINES - 1).astype(int)
        across = np.empty(len(along))
        for line in np.unique(nearest):
            own = nearest == line
            across[own] = np.interp(step[own], values[line], places)
        todo, far = np.arange(len(along)), places[-1] - places[0]
        for _ in range(_ITERATIONS):
            uv = self._join(along[todo], across[todo])
            found = self.field.at(uv)
            rate = found.by_v if self.feed == "u" else found.by_u
            least = 1e-6 * (values[0, -1] - values[0, 0]) / far
            move = np.clip((step[todo] - found.value) / np.maximum(rate, least), -0.25 * far, 0.25 * far)
            across[todo] += move
            todo = todo[np.abs(move) > _EXACT * far]
            if not len(todo):
                break
        return self._join(along, across)

    def places(self, uv: Array) -> Array:
        """Along and step of parameters of the face, (n, 2): the inverse of `uv`."""
        return np.column_stack([uv[:, 1 - self._across], self.field.at(uv).value])

    def feed_at(self, uv: Array) -> Array:
        """Unit feed directions of passes at parameters, (n, 3): along the levels of the field."""
        d, found = self.face.evaluate(uv), self.field.at(uv)
        way = d.su * found.by_v[:, None] - d.sv * found.by_u[:, None]
        return np.asarray(unit(way if self.feed == "u" else -way))

    def half_widths(self, cut: Cut, along: Array, step: Array) -> Array:
        """Half widths (n, 2) in the step parameter, towards its lower and its upper end.

        The strip's border is found in the section normal to the feed, and the field is asked there.
        """
        uv, feed = self.clip(along, step)
        width = strip_width(self.face, cut.tool, uv, cut.axis, cut.scallop, feed, cut.allowance)
        here = self.field.at(uv).value
        at_right = self.field.at(self._aside(uv, feed, -width[:, 1])).value
        at_left = self.field.at(self._aside(uv, feed, width[:, 0])).value
        right = np.abs(at_right - here)
        left = np.abs(at_left - here)
        left_is_higher = self._left_is_higher(uv, feed)[:, None]
        return np.where(left_is_higher, np.column_stack([right, left]), np.column_stack([left, right]))

    def _left_is_higher(self, uv: Array, feed: Array) -> Bools:
        """Whether the field grows to the left of the feed."""
        d, left = self.face.evaluate(uv), np.cross(self.face.normal(uv), feed)
        across = d.sv if self.feed == "u" else d.su
        return np.asarray(dot(across, left) > 0)

    def _aside(self, uv: Array, feed: Array, way: Array) -> Array:
        """Parameters at arc lengths (n,) to the left of contacts in the section normal to the feed, by Newton's method.

        The section is a circle of the surface's curvature there, to the third order of the way.
        """
        surface = self.face.surface.spline
        start, normal = surface.evaluate(uv), self.face.normal(uv)
        left = np.cross(normal, feed)
        bend = contact_forms(self.face, uv, feed, False)[:, 11] * way
        reach = way * np.where(np.abs(bend) > _STRAIGHT, np.sin(bend) / np.where(bend != 0, bend, 1.0), 1.0)
        found = uv.copy()
        for _ in range(_BORDER):
            d = surface.evaluate(found)
            off = d.point - start.point
            miss_f, miss_l = -dot(off, feed), reach - dot(off, left)
            matrix = dot(d.su, feed), dot(d.sv, feed), dot(d.su, left), dot(d.sv, left)
            det = matrix[0] * matrix[3] - matrix[1] * matrix[2]
            det = np.where(np.abs(det) > 1e-300, det, 1e-300)
            found += np.column_stack([miss_f * matrix[3] - matrix[1] * miss_l,
                                      matrix[0] * miss_l - matrix[2] * miss_f]) / det[:, None]
        return found

    def screen(self, cut: Cut, along: Array, step: Array) -> Array:
        """About the two half widths together, (n,), in the step parameter: second-order, corrected for the lean."""
        uv, feed = self.clip(along, step)
        forms = contact_forms(self.face, uv, feed, False)
        half = np.empty((1, len(forms)))
        screen_numpy(forms, cut.axis[None], cut.numbers, cut.scallop, half)
        ratio = lean_ratios(cut.leans, forms[:, :3] @ cut.axis, forms[:, 3:6] @ cut.axis)
        return np.asarray(2 * half[0] * ratio * self.gradient(uv))

    def gradient(self, uv: Array) -> Array:
        """How fast the field grows across the passes at parameters, (n,) 1/mm."""
        d, found = self.face.evaluate(uv), self.field.at(uv)
        area = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
        along = np.linalg.norm(d.su * found.by_v[:, None] - d.sv * found.by_u[:, None], axis=1)
        return np.asarray(along / area)

    def run_outs(self, cut: Cut, along: Array, step: Array) -> Array:
        """How far, in the along parameter, the cutter reaches at scallop height before and behind a contact, (n, 2)."""
        uv, feed = self.clip(along, step)
        across = np.cross(self.face.normal(uv), feed)
        width = strip_width(self.face, cut.tool, uv, cut.axis, cut.scallop, across, cut.allowance)
        return np.asarray(width / self._speed(uv)[:, None])

    def _speed(self, uv: Array) -> Array:
        """mm along a pass per unit of the along parameter, (n,)."""
        d, found = self.face.evaluate(uv), self.field.at(uv)
        way = d.su * found.by_v[:, None] - d.sv * found.by_u[:, None]
        return np.asarray(np.linalg.norm(way, axis=1) / np.abs(self._rate(uv)))
