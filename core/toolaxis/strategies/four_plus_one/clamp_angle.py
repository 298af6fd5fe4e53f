"""What clamping one rotary axis at an angle comes to: the widest strips that turning the other one leaves."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.clearance.queries import keeps_limits, motions
from toolaxis.contact.placement import place
from toolaxis.contact.strip.second_order import screen_many
from toolaxis.machine.kinematics import placement
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import angle_between
from toolaxis.path.moving_axis import MovingCut
from toolaxis.path.parametrization import Cut
from toolaxis.path.pass_count import Count, measure
from toolaxis.path.width_correction import lean_ratios
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.machine_limits import while_moving
from toolaxis.strategies.four_plus_one.angle_grid import NODES, Nodes
from toolaxis.strategies.four_plus_one.free_angle import SingularSides, bands, narrowest, smoothest, widest
from toolaxis.strategies.four_plus_one.links import free_angles
from toolaxis.strategies.four_plus_one.passes import AngleField, Clamp, ClampedAxis, ClampedChart

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Bools = NDArray[np.bool_]

#: Angles of the free axis lie so far apart, rad; those around the chosen ones that are looked at for interference, and
#: how often angles are chosen anew where something is in the way.
FREE, _AROUND, _ROUNDS = np.radians(2.5), 6, 12
#: Least angle between axis and normal, rad: no wider than steps of the free axis, the contact would jump over the flat
#: bottom between two of them.
_UPRIGHT = 0.6 * FREE
#: Turns that are tried where something is in the way there, rad; how often angles are moved away, and the share of
#: those places from which on that is not tried.
_HELP, _REPAIRS, _HOPELESS = np.radians(0.625) * np.arange(1, 17), 8, 0.1
#: The four nodes around a place.
_CORNERS = ((0, 0), (1, 0), (0, 1), (1, 1))
#: Relative accuracy of counts by which angles are compared.
_COUNTED = 5e-3


class _FreeingTurns(NamedTuple):
    """Places (m,) at which something is in the way, and the turns of the free axis that help there, rad."""

    along: Array
    step: Array
    turn: Array


@dataclass(frozen=True, eq=False)
class ClampCandidate:
    """A clamped angle, the feed, and the angles of the free axis chosen at the nodes.

    Attributes
    ----------
    clamp : Clamp
    feed : str
    passes, length : float
        Reckoned from the narrowest strips at the nodes; length in mm.
    angles : (j,) array
        Of the free axis, rad.
    widths : (j, i, k) array
        Strip widths in the step parameter; 0 where an angle must not be used.
    chosen : (i, k) array of int
    gates : SingularSides
        That the free axis does not pass.
    known : (j, i, k) array of bool
        What was held against everything around.
    """

    clamp: Clamp
    feed: str
    passes: float
    length: float
    angles: Array
    widths: Array
    chosen: Index
    gates: SingularSides
    known: Bools

    def value(self, objective: str) -> float:
        """What is to be least.

        Parameters
        ----------
        objective : str
            "length" or "passes".
        """
        return self.passes if objective == "passes" else self.length


class ClampSearch:
    """One face, and all that decides about clamped angles for it.

    Parameters
    ----------
    job : FaceProblem
    mounting : Mounting
        With two rotary axes.
    """

    def __init__(self, job: FaceProblem, mounting: Mounting) -> None:
        worth = job.worth
        upright = np.array([0.0, 0.0, 1.0])
        self.job = job
        self.mounting = mounting
        self.nodes = {feed: Nodes(ClampedChart(worth.face, feed), worth.tool.radius) for feed in ("u", "v")}
        self.plain = Cut(worth.tool, upright, worth.scallop, worth.allowance, worth.greatest_step_over)
        self.looked = 0

    def clamp(self, which: int, angle: float) -> Clamp:
        """An axis clamped in the machine's steps.

        Parameters
        ----------
        which : int
        angle : float
            rad
        """
        machine = self.mounting.machine
        axis = machine.rotary[which]
        within = np.clip(axis.rounded(angle), axis.low, axis.high)
        return Clamp(machine, which, float(within), placement(self.mounting.table_from_part))

    def angles(self, which: int) -> Array:
        """Angles of the axis that is free with one clamped, rad: two turns of one without end, so that it has none.

        Parameters
        ----------
        which : int
            The clamped one.
        """
        axis = self.mounting.machine.rotary[1 - which]
        low = max(axis.low, -2 * np.pi)
        high = min(axis.high, 2 * np.pi)
        gaps = int(np.ceil((high - low) / FREE))
        return np.linspace(low, high, 1 + max(gaps, 1))

    def reckoned(self, clamp: Clamp, feed: str) -> ClampCandidate | None:
        """The widest strips by screening alone; None where some place has none.

        Parameters
        ----------
        clamp : Clamp
        feed : str
        """
        angles = self.angles(clamp.which)
        widths = self._widths(clamp, feed, angles)
        gates = self._gates(clamp, feed)
        known = np.zeros(widths.shape, dtype=bool)
        chosen = widest(widths, angles, gates)
        return self._candidate(clamp, feed, angles, widths, chosen, gates, known)

    def _candidate(self, clamp: Clamp, feed: str, angles: Array, widths: Array, chosen: Index | None,
                   gates: SingularSides, known: Bools) -> ClampCandidate | None:
        if chosen is None:
            return None
        nodes = self.nodes[feed]
        least = narrowest(widths, chosen)
        # By the trapezoidal rule over the passes' places.
        weight = np.full(NODES[1], nodes.step[1] - nodes.step[0])
        weight[[0, -1]] /= 2
        passes = float((weight / least).sum())
        length = float((weight * nodes.lengths / least).sum())
        return ClampCandidate(clamp, feed, passes, length, angles, widths, chosen, gates, known)

    def _gates(self, clamp: Clamp, feed: str) -> SingularSides:
        """Where the axis passes the normal, and where it must not: too near to it, or with something in the way."""
        nodes = self.nodes[feed]
        normals = self.job.worth.face.normal(nodes.uv)
        at = free_angles(normals, clamp).reshape(NODES)
        at = np.unwrap(at, axis=0)
        at = np.unwrap(at, axis=1)
        axes = clamp.axes(at.ravel())
        shut = np.asarray(angle_between(axes, normals)) < self._upright
        some = np.flatnonzero(nodes.counts.ravel() & ~shut)
        shut[some] = ~self._free(nodes.uv[some], axes[some])
        return SingularSides(at, shut.reshape(NODES) & nodes.counts)

    @property
    def _upright(self) -> float:
        return float(max(self.job.feasibility.least_angle_in_motion, _UPRIGHT))

    def _widths(self, clamp: Clamp, feed: str, angles: Array) -> Array:
        """Strip widths in the step parameter, (j, i, k); 0 where there is none, infinite off the face."""
        nodes = self.nodes[feed]
        forms = nodes.forms
        axes = clamp.axes(angles)
        half = screen_many(forms, axes, self.plain.numbers, self.plain.scallop)
        along, left, up = (axes @ forms[:, 3 * c:3 * c + 3].T for c in range(3))
        width = 2 * half * lean_ratios(self.plain.leans, along, left)
        pace = np.maximum(forms[:, 12], 1e-12)
        width = np.minimum(width, self.plain.greatest_step_over / pace)
        is_upright = up > np.cos(self._upright)
        leans_too_far = up < np.cos(self.job.feasibility.greatest_angle)
        width[is_upright | leans_too_far] = 0.0
        width[:, ~nodes.counts.ravel()] = np.inf
        self.looked += len(axes)
        return np.asarray(width.reshape(len(angles), *NODES))

    def standing(self, clamp: Clamp, feed: str) -> ClampCandidate | None:
        """The widest strips with angles at which the tool keeps all distances at the nodes; None where there are none.

        Parameters
        ----------
        clamp : Clamp
        feed : str
        """
        self.job.progress.check()
        angles = self.angles(clamp.which)
        limits = while_moving(self.job.feasibility.limits)
        widths = self._widths(clamp, feed, angles)
        if limits is not None:
            allowed = limits.allowed(clamp.axes(angles))
            widths[~allowed] = 0.0
        known = np.zeros(widths.shape, dtype=bool)
        known[:, ~self.nodes[feed].counts] = True
        gates = self._gates(clamp, feed)
        return self._settle_angles(clamp, feed, angles, widths, gates, known)

    def _settle_angles(self, clamp: Clamp, feed: str, angles: Array, widths: Array, gates: SingularSides,
                       known: Bools) -> ClampCandidate | None:
        """Angles chosen anew until nothing is in the way of any; widths are set to 0 where something is."""
        axes = clamp.axes(angles)
        uv = self.nodes[feed].uv
        rows = np.arange(len(angles))[:, None, None]
        known = known.copy()
        for _ in range(_ROUNDS):
            chosen = widest(widths, angles, gates)
            if chosen is None:
                return None
            near = np.abs(rows - chosen) <= _AROUND
            new = np.flatnonzero(near & ~known & (widths > 0))
            known |= near
            if not len(new):
                break
            j, node = np.divmod(new, NODES[0] * NODES[1])
            is_free = self._free(uv[node], axes[j])
            widths.ravel()[new[~is_free]] = 0.0
            if (np.take_along_axis(widths, chosen[None], axis=0) > 0).all():
                break
        else:
            return None
        return self._candidate(clamp, feed, angles, widths, chosen, gates, known)

    def barred(self, one: ClampCandidate, bad: Index) -> ClampCandidate | None:
        """The widest strips without the angles at which something is in the way between the nodes; None where there
        are none.

        Parameters
        ----------
        one : ClampCandidate
        bad : (m,) array of int
            Places among `Nodes.fine` where that was found, with the angles of its passes.
        """
        nodes = self.nodes[one.feed]
        angles = one.angles
        along, step = (part[bad] for part in nodes.fine)
        i = _cell_of(nodes.along, along)
        k = _cell_of(nodes.step, step)
        corners = np.array([one.chosen[i + di, k + dk] for di, dk in _CORNERS])
        rows = np.arange(len(angles))[:, None]
        not_below = rows >= corners.min(axis=0) - _AROUND
        not_above = rows <= corners.max(axis=0) + _AROUND
        j, place = np.nonzero(not_below & not_above)
        uv = nodes.chart.uv(along, step)
        axes = one.clamp.axes(angles)
        shut = np.zeros((len(angles), len(bad)), dtype=bool)
        shut[j, place] = ~self._free(uv[place], axes[j])
        widths = one.widths.copy()
        for di, dk in _CORNERS:
            for m in range(len(bad)):
                widths[shut[:, m], i[m] + di, k[m] + dk] = 0.0
        return self._settle_angles(one.clamp, one.feed, angles, widths, one.gates, one.known)

    def _free(self, uv: Array, axes: Array) -> NDArray[np.bool_]:
        """Whether the tool keeps all distances at contacts with axes, (n,)."""
        worth = self.job.worth
        self.looked += len(axes)
        tips = place(worth.face, worth.tool, uv, axes, worth.allowance)
        moves = motions(tips, axes)
        free = np.ones(len(axes), dtype=bool)
        for group in self.job.feasibility.groups:
            some = np.flatnonzero(free)
            required = np.tile(group.required, (len(group.faces), 1))
            found = keeps_limits(group.cells, worth.tool, moves[some], required)
            free[some] = found.blocked < 0
        return free

    def cut(self, one: ClampCandidate, share: float, inset: int = 0) -> tuple[MovingCut[ClampedAxis] | None, Index]:
        """What cuts with the smoothest angles at which no strip is narrower than a share of the narrowest of its pass.

        Where the tool comes too near to something between the nodes, the angles of the nodes around are moved away.

        Parameters
        ----------
        one : ClampCandidate
        share : float
        inset : int
            By how many angles to stay away from those that must not be used.

        Returns
        -------
        MovingCut of ClampedAxis, or None
            None where moving does not help.
        (m,) array of int
            Places among `Nodes.fine` where something is in the way before anything is moved.
        """
        nodes = self.nodes[one.feed]
        low, high = self._bounds(one, share, inset)
        first: Index | None = None
        for _ in range(_REPAIRS):
            made = self._with(one, smoothest(low, high, *nodes.ways))
            bad = self._bad(made)
            first = bad if first is None else first
            if not len(bad):
                return made, first
            moves = self._away(made, bad)
            if moves is None:
                return None, first
            up = self._pushed(nodes, moves, 1.0)
            down = self._pushed(nodes, moves, -1.0)
            if (np.minimum(up, down) > 0).any():
                return None, first
            values = made.field.angles.values
            low = np.where(up > 0, np.maximum(low, values + up), low)
            high = np.where(down > 0, np.minimum(high, values - down), high)
            # A bound that is moved takes the other one along.
            lower = np.where(down > 0, np.minimum(low, high), low)
            high = np.where(up > 0, np.maximum(low, high), high)
            low = lower
        return None, np.zeros(0, dtype=np.intp) if first is None else first

    def _bounds(self, one: ClampCandidate, share: float, inset: int) -> tuple[Array, Array]:
        """Bands around the chosen angles, less some angles at both sides, (i, k) each, rad."""
        widths = np.where(one.known, one.widths, 0.0)
        low, high = bands(widths, one.angles, one.chosen, share, one.gates)
        gap = inset * (one.angles[1] - one.angles[0])
        middle = (low + high) / 2
        return np.minimum(low + gap, middle), np.maximum(high - gap, middle)

    def _with(self, one: ClampCandidate, values: Array) -> MovingCut[ClampedAxis]:
        """What cuts with angles at the nodes."""
        nodes = self.nodes[one.feed]
        worth = self.job.worth
        axes = one.clamp.axes(values[nodes.counts])
        angles = AngleField(nodes.along, nodes.step, values)
        turning = ClampedAxis(one.clamp, angles, one.feed)
        mean = axes.mean(axis=0)
        return MovingCut(worth.tool, mean, worth.scallop, worth.allowance, worth.greatest_step_over, field=turning)

    def _bad(self, cut: MovingCut[ClampedAxis]) -> Index:
        """Places among those between the nodes at which something is in the way."""
        nodes = self.nodes[cut.feed]
        turning = cut.field
        angles = turning.angles.at(*nodes.fine)
        axes = turning.clamp.axes(angles)
        uv = nodes.chart.uv(*nodes.fine)
        return np.flatnonzero(~self._free(uv, axes))

    def _away(self, cut: MovingCut[ClampedAxis], bad: Index) -> _FreeingTurns | None:
        """The least turns that help at places where something is in the way; None where none does."""
        nodes = self.nodes[cut.feed]
        if len(bad) > _HOPELESS * len(nodes.fine[0]):
            return None
        clamp = cut.field.clamp
        along, step = (part[bad] for part in nodes.fine)
        uv = nodes.chart.uv(along, step)
        here = cut.field.angles.at(along, step)
        turn = np.zeros(len(bad))
        left = np.arange(len(bad))
        for size in _HELP:
            if not len(left):
                break
            for sense in (1.0, -1.0):
                axes = clamp.axes(here[left] + sense * size)
                free = self._free(uv[left], axes)
                helped = left[free & (turn[left] == 0)]
                turn[helped] = sense * size
            left = left[turn[left] == 0]
        if len(left):
            return None
        return _FreeingTurns(along, step, turn)

    @staticmethod
    def _pushed(nodes: Nodes, moves: _FreeingTurns, sense: float) -> Array:
        """By how much angles at nodes must move in a sense, (i, k) rad."""
        some = np.flatnonzero(moves.turn * sense > 0)
        i = _cell_of(nodes.along, moves.along[some])
        k = _cell_of(nodes.step, moves.step[some])
        size = np.abs(moves.turn[some])
        out = np.zeros(NODES)
        for di, dk in _CORNERS:
            np.maximum.at(out, (i + di, k + dk), size)
        return out

    def counted(self, cut: MovingCut[ClampedAxis], standing: bool = True) -> Count:
        """Passes and cutting length by exact widths.

        Parameters
        ----------
        cut : MovingCut of ClampedAxis
        standing : bool
            Whether the axis stands still at each place, which takes less time.
        """
        self.job.progress.check()
        return measure(ClampedChart(self.job.worth.face, cut.feed, standing), cut, _COUNTED)


def _cell_of(lines: Array, values: Array) -> Index:
    """Numbers of the gaps between nodes in which values lie, or of the nearest gap."""
    before = np.searchsorted(lines, values) - 1
    return np.clip(before, 0, len(lines) - 2)
