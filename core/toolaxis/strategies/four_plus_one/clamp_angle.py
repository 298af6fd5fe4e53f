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
        self.job, self.mounting = job, mounting
        self.nodes = {feed: Nodes(ClampedChart(job.worth.face, feed), job.worth.tool.radius) for feed in ("u", "v")}
        worth = job.worth
        self.plain = Cut(worth.tool, np.array([0.0, 0.0, 1.0]), worth.scallop, worth.allowance,
                         worth.greatest_step_over)
        self.looked = 0

    def clamp(self, which: int, angle: float) -> Clamp:
        """An axis clamped in the machine's steps.

        Parameters
        ----------
        which : int
        angle : float
            rad
        """
        axis = self.mounting.machine.rotary[which]
        return Clamp(self.mounting.machine, which, float(np.clip(axis.rounded(angle), axis.low, axis.high)),
                     placement(self.mounting.table_from_part))

    def angles(self, which: int) -> Array:
        """Angles of the axis that is free with one clamped, rad: two turns of one without end, so that it has none.

        Parameters
        ----------
        which : int
            The clamped one.
        """
        axis = self.mounting.machine.rotary[1 - which]
        low, high = max(axis.low, -2 * np.pi), min(axis.high, 2 * np.pi)
        return np.linspace(low, high, 1 + max(int(np.ceil((high - low) / FREE)), 1))

    def reckoned(self, clamp: Clamp, feed: str) -> ClampCandidate | None:
        """The widest strips by screening alone; None where some place has none.

        Parameters
        ----------
        clamp : Clamp
        feed : str
        """
        angles = self.angles(clamp.which)
        widths, gates = self._widths(clamp, feed, angles), self._gates(clamp, feed)
        known = np.zeros(widths.shape, dtype=bool)
        return self._candidate(clamp, feed, angles, widths, widest(widths, angles, gates), gates, known)

    def _candidate(self, clamp: Clamp, feed: str, angles: Array, widths: Array, chosen: Index | None,
                   gates: SingularSides, known: Bools) -> ClampCandidate | None:
        if chosen is None:
            return None
        nodes, least = self.nodes[feed], narrowest(widths, chosen)
        weight = np.full(NODES[1], nodes.step[1] - nodes.step[0])
        weight[[0, -1]] /= 2
        return ClampCandidate(clamp, feed, float((weight / least).sum()), float((weight * nodes.lengths / least).sum()),
                              angles, widths, chosen, gates, known)

    def _gates(self, clamp: Clamp, feed: str) -> SingularSides:
        """Where the axis passes the normal, and where it must not: too near to it, or with something in the way."""
        nodes = self.nodes[feed]
        normals = self.job.worth.face.normal(nodes.uv)
        at = free_angles(normals, clamp).reshape(NODES)
        at = np.unwrap(np.unwrap(at, axis=0), axis=1)
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
        nodes, limits = self.nodes[feed], self.job.feasibility
        axes, forms = clamp.axes(angles), nodes.forms
        half = screen_many(forms, axes, self.plain.numbers, self.plain.scallop)
        along, left, up = (axes @ forms[:, 3 * c:3 * c + 3].T for c in range(3))
        width = 2 * half * lean_ratios(self.plain.leans, along, left)
        width = np.minimum(width, self.plain.greatest_step_over / np.maximum(forms[:, 12], 1e-12))
        width[(up > np.cos(self._upright)) | (up < np.cos(limits.greatest_angle))] = 0.0
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
        angles, limits = self.angles(clamp.which), while_moving(self.job.feasibility.limits)
        widths = self._widths(clamp, feed, angles)
        if limits is not None:
            widths[~limits.allowed(clamp.axes(angles))] = 0.0
        known = np.zeros(widths.shape, dtype=bool)
        known[:, ~self.nodes[feed].counts] = True
        return self._settle_angles(clamp, feed, angles, widths, self._gates(clamp, feed), known)

    def _settle_angles(self, clamp: Clamp, feed: str, angles: Array, widths: Array, gates: SingularSides,
                       known: Bools) -> ClampCandidate | None:
        """Angles chosen anew until nothing is in the way of any; widths are set to 0 where something is."""
        axes, known = clamp.axes(angles), known.copy()
        for _ in range(_ROUNDS):
            chosen = widest(widths, angles, gates)
            if chosen is None:
                return None
            near = np.abs(np.arange(len(angles))[:, None, None] - chosen) <= _AROUND
            new = np.flatnonzero((near & ~known & (widths > 0)).ravel())
            known |= near
            if not len(new):
                break
            j, node = np.divmod(new, NODES[0] * NODES[1])
            widths.ravel()[new[~self._free(self.nodes[feed].uv[node], axes[j])]] = 0.0
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
        nodes, angles = self.nodes[one.feed], one.angles
        along, step = (part[bad] for part in nodes.fine)
        i = np.clip(np.searchsorted(nodes.along, along) - 1, 0, NODES[0] - 2)
        k = np.clip(np.searchsorted(nodes.step, step) - 1, 0, NODES[1] - 2)
        corners = np.array([one.chosen[i + di, k + dk] for di, dk in _CORNERS])
        rows = np.arange(len(angles))[:, None]
        j, place = np.nonzero((rows >= corners.min(axis=0) - _AROUND) & (rows <= corners.max(axis=0) + _AROUND))
        uv = nodes.chart.uv(along, step)
        shut = np.zeros((len(angles), len(bad)), dtype=bool)
        shut[j, place] = ~self._free(uv[place], one.clamp.axes(angles)[j])
        widths = one.widths.copy()
        for di, dk in _CORNERS:
            for one_place in range(len(bad)):
                widths[shut[:, one_place], i[one_place] + di, k[one_place] + dk] = 0.0
        return self._settle_angles(one.clamp, one.feed, angles, widths, one.gates, one.known)

    def _free(self, uv: Array, axes: Array) -> NDArray[np.bool_]:
        """Whether the tool keeps all distances at contacts with axes, (n,)."""
        worth = self.job.worth
        self.looked += len(axes)
        moves = motions(place(worth.face, worth.tool, uv, axes, worth.allowance), axes)
        free = np.ones(len(axes), dtype=bool)
        for group in self.job.feasibility.groups:
            some = np.flatnonzero(free)
            table = np.tile(group.required, (len(group.faces), 1))
            free[some] = keeps_limits(group.cells, worth.tool, moves[some], table).blocked < 0
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
        nodes, first = self.nodes[one.feed], None
        low, high = bands(np.where(one.known, one.widths, 0.0), one.angles, one.chosen, share, one.gates)
        gap, middle = inset * (one.angles[1] - one.angles[0]), (low + high) / 2
        low, high = np.minimum(low + gap, middle), np.maximum(high - gap, middle)
        for _ in range(_REPAIRS):
            made = self._with(one, smoothest(low, high, *nodes.ways))
            bad = self._bad(made)
            first = bad if first is None else first
            if not len(bad):
                return made, first
            moves = self._away(made, bad)
            if moves is None:
                return None, first
            up, down = (self._pushed(nodes, moves, sense) for sense in (1.0, -1.0))
            if (np.minimum(up, down) > 0).any():
                return None, first
            low = np.where(up > 0, np.maximum(low, made.field.angles.values + up), low)
            high = np.where(down > 0, np.minimum(high, made.field.angles.values - down), high)
            low, high = np.where(down > 0, np.minimum(low, high), low), np.where(up > 0, np.maximum(low, high), high)
        return None, np.zeros(0, dtype=np.intp) if first is None else first

    def _with(self, one: ClampCandidate, values: Array) -> MovingCut[ClampedAxis]:
        """What cuts with angles at the nodes."""
        nodes, worth = self.nodes[one.feed], self.job.worth
        axes = one.clamp.axes(values[nodes.counts])
        turning = ClampedAxis(one.clamp, AngleField(nodes.along, nodes.step, values), one.feed)
        return MovingCut(worth.tool, axes.mean(axis=0), worth.scallop, worth.allowance, worth.greatest_step_over,
                         field=turning)

    def _bad(self, cut: MovingCut[ClampedAxis]) -> Index:
        """Places among those between the nodes at which something is in the way."""
        nodes, turning = self.nodes[cut.feed], cut.field
        axes = turning.clamp.axes(turning.angles.at(*nodes.fine))
        return np.flatnonzero(~self._free(nodes.chart.uv(*nodes.fine), axes))

    def _away(self, cut: MovingCut[ClampedAxis], bad: Index) -> _FreeingTurns | None:
        """The least turns that help at places where something is in the way; None where none does."""
        nodes, clamp = self.nodes[cut.feed], cut.field.clamp
        if len(bad) > _HOPELESS * len(nodes.fine[0]):
            return None
        along, step = (part[bad] for part in nodes.fine)
        uv, here = nodes.chart.uv(along, step), cut.field.angles.at(along, step)
        turn = np.zeros(len(bad))
        left = np.arange(len(bad))
        for size in _HELP:
            if not len(left):
                break
            for sense in (1.0, -1.0):
                free = self._free(uv[left], clamp.axes(here[left] + sense * size))
                turn[left[free & (turn[left] == 0)]] = sense * size
            left = left[turn[left] == 0]
        return None if len(left) else _FreeingTurns(along, step, turn)

    @staticmethod
    def _pushed(nodes: Nodes, moves: _FreeingTurns, sense: float) -> Array:
        """By how much angles at nodes must move in a sense, (i, k) rad."""
        out = np.zeros(NODES)
        some = np.flatnonzero(moves.turn * sense > 0)
        i = np.clip(np.searchsorted(nodes.along, moves.along[some]) - 1, 0, NODES[0] - 2)
        k = np.clip(np.searchsorted(nodes.step, moves.step[some]) - 1, 0, NODES[1] - 2)
        for di, dk in _CORNERS:
            np.maximum.at(out, (i + di, k + dk), np.abs(moves.turn[some]))
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
