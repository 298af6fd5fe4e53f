"""Passes for a roughness: a lean for each place of a face, the passes that it allows, and the splines along them."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.frame import Frame, axis_from_lead_tilt, contact_frame
from toolaxis.contact.placement import tips
from toolaxis.errors import InvalidInput
from toolaxis.machine.kinematics import tool_axes
from toolaxis.machine.machine import Machine
from toolaxis.numeric.grids import grid_rows
from toolaxis.path.moving_axis import MovingChart, MovingCut
from toolaxis.path.parametrization import Cut
from toolaxis.shape.face import Face
from toolaxis.strategies.roughness.rotary_spline import RotarySpline
from toolaxis.strategies.roughness.roughness import arithmetic_roughness, profile_heights
from toolaxis.strategies.roughness.section_width import section_parameters, section_points

Array = NDArray[np.float64]

#: Evaluation lengths, mm, of roughnesses up to these, mm: ISO 4288.
_LENGTHS = ((0.02e-3, 0.4), (0.1e-3, 1.25), (2e-3, 4.0), (10e-3, 12.5), (np.inf, 40.0))
#: Share of the evaluation length that middles of profiles keep from borders.
_INSET = 0.51
#: Places of a profile, and positions of each pass within so many mm before and behind it.
_PROFILE, _POSITIONS, _WINDOW = 241, 21, 2.0


@dataclass(frozen=True, eq=False)
class LeadField:
    """A lead that changes over the face.

    Attributes
    ----------
    feed : str
        "u" or "v".
    along, step : (k,), (l,) array
        Grid of the parameters.
    leads : (k, l) array
        rad; between the grid's lines bilinear, beyond them as on the border.
    """

    feed: str
    along: Array
    step: Array
    leads: Array

    def lead_at(self, uv: Array) -> Array:
        """Leads at contacts, (n,) rad.

        Parameters
        ----------
        uv : (n, 2) array
        """
        rows = uv if self.feed == "u" else uv[:, ::-1]
        i, x = _cell_and_share(rows[:, 0], self.along)
        j, y = _cell_and_share(rows[:, 1], self.step)
        low = self.leads[i, j] * (1 - x) + self.leads[i + 1, j] * x
        high = self.leads[i, j + 1] * (1 - x) + self.leads[i + 1, j + 1] * x
        return np.asarray(low * (1 - y) + high * y)

    def axes(self, face: Face, uv: Array, frame: Frame | None = None) -> Array:
        """Unit axes at contacts; see `AxisField`."""
        there = contact_frame(face, uv, self.feed) if frame is None else frame
        return axis_from_lead_tilt(there, self.lead_at(uv), 0.0)


@dataclass(frozen=True, eq=False)
class FieldChart(MovingChart):
    """A face in its own parameters, whose passes are laid for a field of leads whatever cuts them then.

    Attributes
    ----------
    face, feed
        As for `MovingChart`.
    laid : MovingCut of LeadField
    """

    laid: MovingCut[LeadField] = field(kw_only=True)
    _known: dict[bytes, Array] = field(default_factory=dict, repr=False)

    def half_widths(self, cut: Cut, along: Array, step: Array) -> Array:
        """Half widths (n, 2) in the step parameter that the field of leads leaves.

        Parameters
        ----------
        cut : Cut
            Not looked at.
        along, step : (n,) array
        """
        key = np.concatenate([along, step]).tobytes()
        if key not in self._known:
            self._known[key] = super().half_widths(self.laid, along, step)
        return self._known[key]

    def run_outs(self, cut: Cut, along: Array, step: Array) -> Array:
        """How far the cutter reaches before and behind a contact, (n, 2), with the field of leads.

        Parameters
        ----------
        cut : Cut
            Not looked at.
        along, step : (n,) array
        """
        return super().run_outs(self.laid, along, step)


@dataclass(frozen=True, eq=False)
class SplineAxes:
    """The axis of a machine whose rotary axes are splines along each pass.

    Attributes
    ----------
    feed : str
        "u" or "v".
    lean : float
        The mean one, rad.
    machine : Machine
    turn : (3, 3) array
        From the part's directions to the table's.
    pieces : (m, 3) array
        along0, along1, step of each pass or part of one, steps not falling.
    splines : tuple of RotarySpline
        One for each.
    """

    feed: str
    lean: float
    machine: Machine
    turn: Array
    pieces: Array
    splines: tuple[RotarySpline, ...]

    def owners(self, along: Array, step: Array) -> NDArray[np.intp]:
        """The piece that each place belongs to: of the pass nearest to it, that which holds it or is nearest, (n,).

        Parameters
        ----------
        along, step : (n,) array
        """
        begin, end, step_of_piece = self.pieces.T
        places = along[:, None]
        beside = np.abs(step_of_piece - step[:, None])
        off = np.maximum(begin - places, places - end)
        off = np.maximum(off, 0.0)
        nearest = beside <= beside.min(axis=1, keepdims=True)
        off = np.where(nearest, off, np.inf)
        return np.asarray(off.argmin(axis=1))

    def axes(self, face: Face, uv: Array, frame: Frame | None = None) -> Array:
        """Unit axes at contacts; see `AxisField`."""
        rows = uv if self.feed == "u" else uv[:, ::-1]
        along, step = rows.T
        owner = self.owners(along, step)
        axes = np.empty((len(uv), 3))
        for k in np.unique(owner):
            some = owner == k
            angles = self.splines[k].angles(along[some])
            axes[some] = tool_axes(self.machine, angles) @ self.turn
        return axes


def _cell_and_share(values: Array, grid: Array) -> tuple[NDArray[np.intp], Array]:
    """In which cell of a grid's lines values lie, and at what share of it; beyond the grid at its ends."""
    at = np.interp(values, grid, np.arange(len(grid)))
    cell = np.clip(at.astype(np.intp), 0, len(grid) - 2)
    return cell, at - cell


def evaluation_length(roughness: float) -> float:
    """Length over which Ra is evaluated, mm.

    Parameters
    ----------
    roughness : float
        Ra, mm.

    Notes
    -----
    **Source**: ISO 4288, five cut-off lengths; 4 mm for the 1.6 um of [dong2023] Sec. 6.
    """
    return next(length for most, length in _LENGTHS if roughness <= most)


def spots(face: Face, feed: str, length: float, counts: tuple[int, int] = (10, 9)) -> Array:
    """Places at which roughness is looked at, evenly over a face, whose whole profiles lie on it, (n, 2).

    Parameters
    ----------
    face : Face
    feed : str
    length : float
        Evaluation length, mm.
    counts : two of int
        Along u and along v: 90 as in the paper's tables unless given.

    Raises
    ------
    InvalidInput
        When no profile of this length lies on the face.
    """
    d = face.evaluate(face.grid(9, 9))
    across = d.sv if feed == "u" else d.su
    pace = np.linalg.norm(across, axis=1).min()
    gap = _INSET * length / pace
    gap_u, gap_v = (0.0, gap) if feed == "u" else (gap, 0.0)
    u0, u1, v0, v1 = face.bounds
    u = _even_places(u0, u1, gap_u, counts[0])
    v = _even_places(v0, v1, gap_v, counts[1])
    uv = grid_rows(u, v)
    offsets = np.linspace(-0.5, 0.5, 9) * length
    ends = section_parameters(face, uv, offsets, feed)
    on_face = face.contains(ends.reshape(-1, 2)).reshape(len(uv), -1)
    in_bounds = (ends >= [u0, v0]) & (ends <= [u1, v1])
    on = on_face.all(axis=1) & in_bounds.all(axis=(1, 2))
    if not on.any():
        raise InvalidInput(f"face {face.label} holds no profile of {length:g} mm across the feed along {feed}: its "
                           "roughness cannot be evaluated; take the other feed")
    return np.asarray(uv[on])


def _even_places(low: float, high: float, gap: float, number: int) -> Array:
    """Middles of equal parts of a range less a gap at both ends; all in its middle where the gaps leave nothing."""
    begin = low + gap
    end = high - gap
    if high - low <= 2 * gap:
        begin = end = (low + high) / 2
    share = np.arange(number) + 0.5
    return begin + (end - begin) * share / number


def roughness_at(face: Face, cut: MovingCut[Any], steps: Array, uv: Array, length: float) -> Array:
    """Ra across the feed that passes leave at places of a face, (n,) mm.

    Parameters
    ----------
    face : Face
    cut : MovingCut
        What cuts, with its axes at every place of the passes.
    steps : (k,) array
        Step parameter of each pass, growing.
    uv : (n, 2) array
    length : float
        Evaluation length, mm.

    Notes
    -----
    **Source**: [dong2023] Sec. 4.1.
    """
    if not len(uv):
        return np.empty(0)
    ahead = 0 if cut.feed == "u" else 1
    offsets = np.linspace(-0.5, 0.5, _PROFILE) * length
    at = section_parameters(face, uv, offsets, cut.feed)
    points, normal = section_points(face, at)
    along_profiles = at[..., ahead]
    step_profiles = at[..., 1 - ahead]
    low = step_profiles.min(axis=1)
    high = step_profiles.max(axis=1)
    last_pass = len(steps) - 1
    first = np.clip(np.searchsorted(steps, low) - 2, 0, max(last_pass, 0))
    last = np.clip(np.searchsorted(steps, high) + 1, 0, last_pass)
    most = int((last - first).max())
    passes = []
    for k in range(most + 1):
        step = steps[np.minimum(first + k, last)]
        along = [np.interp(s, *_growing(x, y)) for s, x, y in zip(step, step_profiles, along_profiles, strict=True)]
        passes.append(_positions(face, cut, np.array(along), step))
    heights = profile_heights(cut.tool, points, normal, passes, cut.allowance)
    return arithmetic_roughness(heights)


def _growing(x: Array, y: Array) -> tuple[Array, Array]:
    if x[-1] >= x[0]:
        return x, y
    return x[::-1], y[::-1]


def _positions(face: Face, cut: MovingCut[Any], along: Array, step: Array) -> tuple[Array, Array]:
    """Tips and axes of passes around places, (n, k, 3) each."""
    ahead = 0 if cut.feed == "u" else 1
    columns = [along, step] if ahead == 0 else [step, along]
    middle = np.stack(columns, axis=1)
    d = face.evaluate(middle)
    speed = np.linalg.norm(d.su if ahead == 0 else d.sv, axis=1)
    t = np.linspace(-_WINDOW, _WINDOW, _POSITIONS)
    away = t / np.maximum(speed, 1e-9)[:, None]
    every = np.repeat(middle, len(t), axis=0)
    every[:, ahead] += away.ravel()
    point, normal = section_points(face, every[None])
    axes = cut.axes(face, every)
    shape = (len(along), len(t), 3)
    tip = tips(point[0], normal[0], axes, cut.tool, cut.allowance)
    return tip.reshape(shape), axes.reshape(shape)
