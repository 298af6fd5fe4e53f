"""The ideal length of passes for many axes at once, from second-order widths."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.cutter_parameters import CutterParameters
from toolaxis.contact.strip.second_order import contact_forms, screen_many
from toolaxis.path.estimate import Estimates
from toolaxis.path.field.direction_table import feed_frame, feeds_in
from toolaxis.path.width_correction import lean_ratios, lean_table, screening_cutter
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Places each way, and directions in half a turn.
_PLACES, _DIRECTIONS = 12, 12
#: Axes that are looked at together.
_TOGETHER = 32


@dataclass(frozen=True, eq=False)
class DirectionForms:
    """A face with passes in all directions at some places; make it with `DirectionForms.of`.

    Attributes
    ----------
    forms : (n k, 13) array
        Rows of `contact_forms`, the directions of a place one after the other.
    area : (n,) array
        mm^2 of the face that each place stands for.
    extent : (2,) array
        Mean length of passes with feed u and v, mm.
    cutter : CutterParameters
    leans : array
        See `toolaxis.path.width_correction.lean_table`.
    scallop : float
        mm
    """

    forms: Array
    area: Array
    extent: Array
    cutter: CutterParameters
    leans: Array
    scallop: float
    greatest_step_over: float = np.inf

    @staticmethod
    def of(face: Face, tool: Tool, scallop: float, allowance: float = 0.0,
           greatest_step_over: float = np.inf) -> "DirectionForms":
        """Prepare a face.

        Parameters
        ----------
        face : Face
        tool : Tool
        scallop, allowance, greatest_step_over : float
            mm
        """
        uv = face.grid(_PLACES, _PLACES)
        u0, u1, v0, v1 = face.bounds
        d = face.evaluate(uv)
        density = np.linalg.norm(np.cross(d.su, d.sv), axis=1)
        area = density * face.area / density.sum()
        size = [np.linalg.norm(rate, axis=1).mean() * span * len(uv) / _PLACES**2
                for rate, span in ((d.su, u1 - u0), (d.sv, v1 - v0))]
        angles = np.arange(_DIRECTIONS) * np.pi / _DIRECTIONS
        feeds = feeds_in(feed_frame(face, uv), angles)
        forms = contact_forms(face, np.repeat(uv, _DIRECTIONS, axis=0), feeds, False)
        return DirectionForms(forms, area, np.array(size), screening_cutter(tool, scallop, allowance),
                              lean_table(tool, scallop), scallop, greatest_step_over)

    def estimate(self, axes: Array) -> Estimates:
        """Ideal number and length of passes for axes (k, 3); inf where a place has no strip."""
        length = np.concatenate([self._ideal(axes[first:first + _TOGETHER])
                                 for first in range(0, len(axes), _TOGETHER)])
        return Estimates(length[:, None] / self.extent, np.repeat(length[:, None], 2, axis=1))

    def _ideal(self, axes: Array) -> Array:
        half = screen_many(self.forms, axes, self.cutter, self.scallop)
        half *= lean_ratios(self.leans, axes @ self.forms[:, :3].T, axes @ self.forms[:, 3:6].T)
        widest = 2 * half.reshape(len(axes), len(self.area), _DIRECTIONS).max(axis=2)
        widest = np.minimum(widest, self.greatest_step_over)
        rate = np.where(widest > 0, 1 / np.where(widest > 0, widest, 1.0), np.inf)
        return np.asarray(rate @ self.area)
