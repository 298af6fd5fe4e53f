"""Passes with one rotary axis clamped: the other turns as a smooth function of the place on the face (4+1 axes).

The angle is a bicubic spline over the parameters along and across the passes, so that it has no jump along a pass and
none from pass to pass.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RectBivariateSpline

from toolaxis.contact.frame import Frame
from toolaxis.contact.strip.second_order import contact_forms, second_order_each
from toolaxis.contact.strip.width import step_widths
from toolaxis.machine.kinematics import placement, tool_axes
from toolaxis.machine.machine import Machine
from toolaxis.numeric.vectors import unit
from toolaxis.path.moving_axis import MovingChart, MovingCut
from toolaxis.path.parametrization import Cut
from toolaxis.path.width_correction import lean_ratios
from toolaxis.shape.face import Face

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class AngleField:
    """An angle over a chart.

    Attributes
    ----------
    along, step : (n,), (m,) array
        Parameters of the nodes, ascending, four at least.
    values : (n, m) array
        Angles there, rad.
    """

    along: Array
    step: Array
    values: Array

    @cached_property
    def _spline(self) -> RectBivariateSpline:
        return RectBivariateSpline(self.along, self.step, self.values, kx=3, ky=3, s=0)

    def at(self, along: Array, step: Array) -> Array:
        """Angles at parameters, (k,) rad; beyond the nodes they go on ever slower, by what the last slope makes of one
        gap at most.

        Parameters
        ----------
        along, step : (k,) array
        """
        a = np.clip(along, self.along[0], self.along[-1])
        s = np.clip(step, self.step[0], self.step[-1])
        value = self._spline.ev(a, s)
        for beyond, derivative, nodes in ((along - a, {"dx": 1}, self.along), (step - s, {"dy": 1}, self.step)):
            some = np.flatnonzero(beyond)
            if len(some):
                gap = float(nodes[1] - nodes[0])
                slope = self._spline.ev(a[some], s[some], **derivative)
                value[some] += gap * np.tanh(beyond[some] / gap) * slope
        return np.asarray(value)


@dataclass(frozen=True, eq=False)
class Clamp:
    """A machine with one of its two rotary axes clamped.

    Attributes
    ----------
    machine : Machine
    which : int
        The clamped one in the order of `Machine.rotary`.
    angle : float
        Where it is clamped, rad.
    table_from_part : array, optional
        Where the part stands on the table, all axes at zero.
    """

    machine: Machine
    which: int
    angle: float
    table_from_part: Array | None = None

    def rotary(self, free: Array) -> Array:
        """Both rotary angles, (n, 2) rad.

        Parameters
        ----------
        free : (n,) array
            Of the free axis, rad.
        """
        rows = np.full((len(free), 2), self.angle)
        rows[:, 1 - self.which] = free
        return rows

    def axes(self, free: Array) -> Array:
        """Tool axes in the part's frame, (n, 3).

        Parameters
        ----------
        free : (n,) array
            rad
        """
        return np.asarray(unit(tool_axes(self.machine, self.rotary(free)) @ placement(self.table_from_part)[:3, :3]))


@dataclass(frozen=True, eq=False)
class ClampedAxis:
    """The axis of a machine with one rotary axis clamped, while the other turns.

    Attributes
    ----------
    clamp : Clamp
    angles : AngleField
        The free axis over the chart with that feed.
    feed : str
        "u" or "v".
    """

    clamp: Clamp
    angles: AngleField
    feed: str

    def axes(self, face: Face, uv: Array, frame: Frame | None = None) -> Array:
        """Unit axes at contacts; see `AxisField`."""
        along, step = (uv if self.feed == "u" else uv[:, ::-1]).T
        return self.clamp.axes(self.angles.at(along, step))


@dataclass(frozen=True, eq=False)
class ClampedChart(MovingChart):
    """A face in its own parameters, for passes with one rotary axis clamped.

    Attributes
    ----------
    face, feed
        As for `MovingChart`.
    standing : bool
        Whether half widths are those of the axis that stands still where it is at each contact: for comparing fields,
        as long as turning is slow.
    """

    standing: bool = False

    def half_widths(self, cut: Cut, along: Array, step: Array) -> Array:
        """Half widths (n, 2) in the step parameter.

        Parameters
        ----------
        cut : MovingCut of ClampedAxis
        along, step : (n,) array
        """
        if not self.standing:
            return super().half_widths(cut, along, step)
        uv = self.uv(along, np.clip(step, *self._poles))
        return np.asarray(step_widths(self.face, cut.tool, uv, cut.axes(self.face, uv), cut.scallop, self.feed,
                                      cut.allowance))

    def screen(self, cut: Cut, along: Array, step: Array) -> Array:
        """About the two half widths together, (n,), in the step parameter: second-order, corrected for the lean.

        Parameters
        ----------
        cut : MovingCut of ClampedAxis
        along, step : (n,) array
        """
        assert isinstance(cut, MovingCut)
        uv = self.uv(along, step)
        axes, forms = cut.axes(self.face, uv), contact_forms(self.face, uv, self.feed, True)
        half = second_order_each(forms, axes, cut.numbers, cut.scallop)
        lean = ((forms[:, k:k + 3] * axes).sum(axis=1) for k in (0, 3))
        return np.asarray(2 * half * lean_ratios(cut.leans, *lean))
