"""What axes cost on a lattice: where they are forbidden, how many passes a unit of the step takes, and what these take.

Costs are mm of cutting length, and seconds where the least time is asked for.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.second_order import contact_forms
from toolaxis.contact.strip.width import step_widths, step_widths_many_axes
from toolaxis.feasibility.check_points import contacts_at
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.violations import FREE
from toolaxis.numeric.vectors import angle_between
from toolaxis.partition.uv_grid import Lattice
from toolaxis.plan.choices import FEEDS
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.cost import CLEAN_UP, MachiningCost
from toolaxis.search.time_estimate import TimeEstimate
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Share of usable pairs of an axis and a node from which on widths of all pairs take less time than those of the usable
#: ones: at a node the surface across the pass is then evaluated once for all axes, which saves a third.
_DENSE = 0.9
#: Places for a speed between two nodes.
_FINE = 8
#: Rate of passes where an axis is forbidden; finite, so that sums stay numbers.
FORBIDDEN = 1e12


@dataclass(frozen=True, eq=False)
class CostGrid:
    """Rates of passes at the nodes of a lattice.

    Attributes
    ----------
    axes : (k, 3) array
    rates : (k, 2, nu + 1, nv + 1) array
        Passes for a unit of the step parameter with feed u and feed v; 0 off the face and at walls, `FORBIDDEN` where
        the axis may not be used.
    left : (k, nu + 1, nv + 1) array of bool
        Whether the node lies at a wall and is left as rest material.
    lines : pair of (1 or k, nu, nv + 1) and (1 or k, nu + 1, nv) arrays
        What one pass costs between neighbouring nodes along u, with feed u, and along v; one row where all axes cost
        the same.
    extra : (k, nu, nv) array
        What it costs to clean up in each cell.
    whole : (nu, nv) array
        Area of the face in each cell, mm^2.
    """

    axes: Array
    rates: Array
    left: Bools
    lines: tuple[Array, Array]
    extra: Array
    whole: Array

    def of(self, places: NDArray[np.intp]) -> "CostGrid":
        """The prices of some of the axes.

        Parameters
        ----------
        places : (m,) array of int
        """
        u, v = (line if len(line) == 1 else line[places] for line in self.lines)
        return CostGrid(self.axes[places], self.rates[places], self.left[places], (u, v), self.extra[places],
                        self.whole)

    def joined(self, other: "CostGrid") -> "CostGrid":
        """The prices of more axes after these.

        Parameters
        ----------
        other : CostGrid
        """
        lines_u, lines_v = (own if len(own) == 1 else np.concatenate([own, more])
                            for own, more in zip(self.lines, other.lines, strict=True))
        return CostGrid(
            axes=np.concatenate([self.axes, other.axes]),
            rates=np.concatenate([self.rates, other.rates]),
            left=np.concatenate([self.left, other.left]),
            lines=(lines_u, lines_v),
            extra=np.concatenate([self.extra, other.extra]),
            whole=self.whole)


def compute_cost_grid(lattice: Lattice, worth: MachiningCost, feasibility: Feasibility, axes: Array,
                      progress: Progress = NO_PROGRESS, proven: Array | None = None) -> CostGrid:
    """Prices of axes at every node.

    Parameters
    ----------
    lattice : Lattice
    worth : MachiningCost
        Tool, scallop height and allowance, and the pace where the least time is asked for.
    feasibility : Feasibility
        Of the whole face.
    axes : (k, 3) array
        Unit vectors.
    progress : Progress
    proven : (3,) array, optional
        An axis that is known to machine the face; it may be used at all nodes, even where the screen refuses it.

    Returns
    -------
    CostGrid
        Judged at the nodes alone, with angles to the normal kept as if half-way to the next node: a screen, not a
        proof.

    Raises
    ------
    Cancelled
        When the user asked to stop.
    """
    nodes = np.flatnonzero(lattice.material)
    allowed, left = _usable(lattice, feasibility, axes, nodes, progress)
    if proven is not None:
        known = (axes == proven).all(axis=1)
        allowed[known] = ~left[known]
    rates = np.zeros((len(axes), 2, lattice.material.size))
    rates[:, :, nodes] = np.where(left | allowed, 0.0, FORBIDDEN)[:, None]
    axis, node = np.nonzero(allowed & ~left)
    uv = lattice.uv.reshape(-1, 2)[nodes]
    for feed, name in enumerate(FEEDS):
        if len(axis):
            halves = _half_widths(lattice.face, worth, (axes, uv), (axis, node), name)
            width = np.where((halves > 0).all(axis=1), halves.sum(axis=1), 0.0)
            if np.isfinite(worth.greatest_step_over):
                pace = contact_forms(lattice.face, uv, name, True)[node, 12]
                width = np.minimum(width, worth.greatest_step_over / np.maximum(pace, 1e-12))
            rates[axis, feed, nodes[node]] = 1 / np.maximum(width, 1 / FORBIDDEN)
    shape = lattice.material.shape
    everywhere = np.zeros((len(axes), lattice.material.size), dtype=bool)
    everywhere[:, nodes] = left
    rates, everywhere = rates.reshape(len(axes), 2, *shape), everywhere.reshape(len(axes), *shape)
    extra = _clean_up(lattice, worth, everywhere)
    if worth.timed is None:
        return CostGrid(axes, rates, everywhere, (lattice.lengths[0][None], lattice.lengths[1][None]), extra,
                        lattice.areas)
    lines = _line_seconds(lattice, worth.timed, axes, progress)
    return CostGrid(axes, rates, everywhere, lines, extra / worth.timed.feeds.cut, lattice.areas)


def _half_widths(face: Face, worth: MachiningCost, asked: tuple[Array, Array],
                 pairs: tuple[NDArray[np.intp], NDArray[np.intp]], feed: str) -> Array:
    """Half widths in the step parameter for m pairs of the axes and the places that are asked for, (m, 2)."""
    axes, uv = asked
    axis, place = pairs
    if len(axis) > _DENSE * len(axes) * len(uv):
        return step_widths_many_axes(face, worth.tool, uv, axes, worth.scallop, feed, worth.allowance)[axis, place]
    return step_widths(face, worth.tool, uv[place], axes[axis], worth.scallop, feed, worth.allowance)


def _line_seconds(lattice: Lattice, pace: TimeEstimate, axes: Array, progress: Progress) -> tuple[Array, Array]:
    """Seconds that a pass takes between neighbouring nodes along u and along v, for each axis."""
    found = []
    for along in (0, 1):
        nodes, across = lattice.lines[along], lattice.lines[1 - along]
        fine = np.interp(np.arange(_FINE * (len(nodes) - 1) + 1) / _FINE, np.arange(len(nodes)), nodes)
        rows = np.empty((len(axes), len(across), len(nodes) - 1))
        for j, other in enumerate(across):
            progress.report("speeds along the lattice", along * len(across) + j, 2 * len(across))
            uv = np.full((len(fine), 2), other)
            uv[:, along] = fine
            rows[:, j] = pace.line_seconds(uv, axes).reshape(len(axes), -1, _FINE).sum(axis=2)
        found.append(rows)
    return found[0].swapaxes(1, 2), found[1]


def _clean_up(lattice: Lattice, worth: MachiningCost, left: Bools) -> Array:
    """What it costs to clean up in each cell, (k, nu, nv) mm, as `Worth.charge` reckons.

    The share of a cell is that of its corners.  Passes that are reckoned through it are not taken off: where hardly
    anything of a row is machined, there are none.
    """
    share = left.astype(float)
    share = (share[:, 1:, 1:] + share[:, :-1, 1:] + share[:, 1:, :-1] + share[:, :-1, :-1]) / 4
    return np.asarray(share * lattice.areas * CLEAN_UP / worth.clean_up_strip)


def _usable(lattice: Lattice, feasibility: Feasibility, axes: Array, nodes: NDArray[np.intp],
            progress: Progress) -> tuple[Bools, Bools]:
    """Which axes may be used at which nodes, and where a wall leaves the node to a clean-up tool, (k, n) each."""
    uv, spread = lattice.uv.reshape(-1, 2)[nodes], lattice.spread.reshape(-1)[nodes]
    angle = np.asarray(angle_between(axes[:, None], lattice.normals.reshape(-1, 3)[nodes][None]))
    allowed = angle + spread <= feasibility.greatest_angle
    if feasibility.least_angle > 0:
        allowed &= angle - spread >= feasibility.least_angle
    if feasibility.limits is not None:
        allowed &= feasibility.limits.allowed(axes)[:, None]
    left = np.zeros_like(allowed)
    reach = 2 * feasibility.tool.radius + feasibility.tolerance.cutter_clearance
    contacts = contacts_at(lattice.face, uv, len(uv), feasibility.walls, reach)
    for k in range(len(axes)):
        progress.report("axes at the lattice", k, len(axes))
        some = np.flatnonzero(allowed[k])
        if len(some):
            here = contacts._replace(uv=contacts.uv[some], point=contacts.point[some], normal=contacts.normal[some],
                                     share=contacts.share[some], near=contacts.near[some])
            trouble = feasibility.trouble(axes[k], here)
            left[k, some] = trouble.wall & (trouble.reason != FREE)
            allowed[k, some] = (trouble.reason == FREE) | left[k, some]
    return allowed, left
