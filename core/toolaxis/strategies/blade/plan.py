"""Four-axis milling of a blade: layers around its closed face, tool angles in their S-theta planes, links and proof."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import degrees, radians

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import LONGER_TOOL
from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.numeric.parts import number_parts
from toolaxis.numeric.vectors import angle_between, unit
from toolaxis.path.links import Linking
from toolaxis.plan.orientation import Orientation
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.link_heights import OVER, height_over
from toolaxis.search.machine_limits import mounting_of, while_moving
from toolaxis.search.messages import sentence
from toolaxis.strategies.blade.clearance_limits import BladeSurroundings, with_room
from toolaxis.strategies.blade.layers import Ring, along_blade, find_closed_parameter
from toolaxis.strategies.blade.schedule import (
    CLEARANCE,
    Layer,
    ScheduledLayer,
    SThetaLayer,
    SwivelAxis,
    plane_of,
    schedule_layers,
    swing_of,
)
from toolaxis.strategies.blade.section import base_of, section
from toolaxis.strategies.common.links import MovingCuttingMove, MovingLinks, join_moves
from toolaxis.strategies.common.passes import beyond
from toolaxis.strategies.common.path_check import MovingLinkClearance, prove_moving
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Clearances of tool angles that are tried in turn where the proof refuses a path, rad.
CLEARANCES = (CLEARANCE, 2 * CLEARANCE, 4 * CLEARANCE)
#: Chords of the places around at which scallops between layers are looked at: as a share of the scallop height, and mm.
#: Where layers lie must not hang on how far apart the path's points are.
_LOOKED_AT = 0.02, 0.001
#: Greatest swing of the axis from point to point, rad: halfway between two points the axis leaves the cone about the
#: rotary axis by an eighth of its square, which a machine that cannot leave that cone follows to 0.0001 rad.
_SWING = radians(1.6)
#: How much of the face's span may be left at its ends, where the tool has no room.
_LEFT_OUT = 0.5
CHECKED = ("the cutter on the machined skin is checked at points of the path, 0.5 mm and 0.5 deg apart at most; all "
           "other distances are proven along it")


@dataclass(frozen=True, eq=False)
class BladeTurn:
    """One turn around a blade as a path takes it.

    Attributes
    ----------
    contact, normal, centre : (n, 3) array
        Contacts and cutter centres, mm, and unit normals; the last row is where the next turn begins.
    """

    contact: Array
    normal: Array
    centre: Array


@dataclass(frozen=True, eq=False)
class BladeSchedule:
    """The turns of a path and their tool angles.

    Attributes
    ----------
    swing : SwivelAxis
    turns : tuple of BladeTurn
    layers : tuple of ScheduledLayer
    left : (float, float)
        Shares of the span without layers at the tip and at the root.
    """

    swing: SwivelAxis
    turns: tuple[BladeTurn, ...]
    layers: tuple[ScheduledLayer, ...]
    left: tuple[float, float] = (0.0, 0.0)


def check_ball(tool: Tool) -> None:
    """Check that a tool ends in a ball.

    Parameters
    ----------
    tool : Tool

    Raises
    ------
    InvalidInput
        When it does not.
    """
    if tool.flat_radius > 0:
        raise InvalidInput(f"tool {tool.name} has no ball end: strategy 'blade' swings the tool about its ball's "
                           "centre; take ball:D or a tapered ball")


def turns_of(ring: Ring, scallop: float, allowance: float, chord: float, direction: str) -> tuple[BladeTurn, ...]:
    """Turns around a blade from its tip to its root.

    Parameters
    ----------
    ring : Ring
    scallop, allowance, chord : float
        mm
    direction : str
        "zigzag": to and fro on level sections; "climb" or "conventional": a helix with a level turn at both ends.

    Returns
    -------
    tuple of BladeTurn
        Each begins at the base point, at the end of the hollow of the middle section.
    """
    along = ring.places(chord)
    heights = ring.heights(ring.places(min(_LOOKED_AT[0] * scallop, _LOOKED_AT[1])), scallop, allowance)
    swing = SwivelAxis(ring.direction)
    middle = swing.flat(ring.at(along, np.full(len(along), np.mean(ring.span)))[2])
    x, y = middle.T
    if float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum()) < 0:
        along, middle = along[::-1], middle[::-1]
    base = base_of(section(middle[:-1]))
    along = np.concatenate([along[base:-1], along[:base + 1]])
    if direction == "zigzag":
        rows = [(along if k % 2 == 0 else along[::-1], np.full(len(along), height))
                for k, height in enumerate(heights)]
    else:
        way = along if direction == "climb" else along[::-1]
        centre = ring.at(way, np.full(len(way), float(np.mean(ring.span))))[2]
        share = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(centre, axis=0), axis=1))])
        share /= share[-1]
        rows = [(way, a + (b - a) * share) for a, b in pairwise([heights[0], *heights, heights[-1]])]
    return _deepen_turns(ring, rows)


def _deepen_turns(ring: Ring, rows: list[tuple[Array, Array]]) -> tuple[BladeTurn, ...]:
    """Turns whose points on hollow stretches lie deeper, by as much as straight motions between them would stay above
    the surface: see `toolaxis.path.chord_tolerance.rises`."""
    turns = [BladeTurn(*ring.at(*row)) for row in rows]
    above = []
    for turn, (along, heights) in zip(turns, rows, strict=True):
        _, up, between = ring.at((along[1:] + along[:-1]) / 2, (heights[1:] + heights[:-1]) / 2)
        rise = ((turn.centre[1:] + turn.centre[:-1]) / 2 - between) * up
        above.append(np.maximum(rise.sum(axis=1), 0.0))
    before = [above[0][0], *(one[-1] for one in above[:-1])]  # a helix goes through the end of one turn to the next
    after = [*(one[0] for one in above[1:]), above[-1][-1]]
    found = []
    for turn, one, first, last in zip(turns, above, before, after, strict=True):
        deeper = np.maximum(np.append(first, one), np.append(one, last))
        found.append(replace(turn, centre=turn.centre - deeper[:, None] * turn.normal))
    return tuple(found)


def _closer(turn: BladeTurn, layer: ScheduledLayer, swing: SwivelAxis) -> tuple[BladeTurn, Array]:
    """A turn and its tool axes, with points between those from one to the next of which the axis swings far."""
    parts = np.ceil(np.abs(np.diff(layer.theta)) / _SWING).clip(1).astype(np.int64)
    owner, number = number_parts(parts)
    share = number / parts[owner]
    at = np.append(owner + share, len(parts))
    known = np.arange(len(layer.theta))

    def _among(rows: Array) -> Array:
        return np.column_stack([np.interp(at, known, column) for column in rows.T])

    lengths = layer.section.lengths if layer.onward else layer.section.lengths[::-1]
    theta = layer.curve.at(np.interp(at, known, lengths))[0]
    normal = np.asarray(unit(_among(turn.normal)))
    return BladeTurn(_among(turn.contact), normal, _among(turn.centre)), swing.axes(theta)


def path_of(schedule: BladeSchedule, tool: Tool, links: MovingLinks) -> ToolPath:
    """The path over all turns, one after the other, with entry and exit.

    Parameters
    ----------
    schedule : BladeSchedule
    tool : Tool
    links : MovingLinks
    """
    turns, axes = zip(*(_closer(turn, layer, schedule.swing)
                        for turn, layer in zip(schedule.turns, schedule.layers, strict=True)), strict=True)
    axis = np.concatenate(axes)
    contact, normal, centre = (np.concatenate([getattr(turn, name) for turn in turns])
                               for name in ("contact", "normal", "centre"))
    tip = centre - tool.corner_radius * axis
    kept = np.concatenate([[True], np.linalg.norm(np.diff(tip, axis=0), axis=1) > 1e-9])
    path = join_moves([[MovingCuttingMove(contact[kept], tip[kept], normal[kept], axis[kept])]], links)
    sizes = np.cumsum([len(turn.centre) for turn in turns])[:-1]
    first = int(np.flatnonzero(path.kind == Motion.CUT)[0]) - 1
    starts = first + np.array([int(kept[:size].sum()) for size in sizes], dtype=np.int64)
    return replace(path, breaks=np.concatenate([[0], starts, [len(path.cl)]]).astype(np.int64))


class BladeSearch:
    """The path around one blade.

    Parameters
    ----------
    job : FaceProblem
    curve : str
        One of `toolaxis.strategies.blade.schedule.CURVES`.

    Raises
    ------
    InvalidInput
        When the tool has no ball end, or the face does not go around a blade.
    """

    def __init__(self, job: FaceProblem, curve: str = "least") -> None:
        self.job, self.kind = job, curve
        self.tool, face = job.worth.tool, job.worth.face
        check_ball(self.tool)
        self.feed = find_closed_parameter(face)
        mounting = mounting_of(job.feasibility.limits)
        machine = None if mounting is None else mounting.machine
        place = None if mounting is None else mounting.table_from_part
        own = along_blade(face, self.feed)
        if float((job.box.mean(axis=0) - face.box.mean(axis=0)) @ own) > 0:
            own = -own  # what a blade stands on is at its root
        self.swing = swing_of(machine, own, place)
        worth = job.worth
        self.ring = Ring(face, self.feed, self.swing.direction, self.tool.corner_radius + worth.allowance)
        self.turns = turns_of(self.ring, worth.scallop, worth.allowance, job.chord, job.direction)

    def planes(self) -> tuple[list[SThetaLayer], slice, tuple[float, float]]:
        """Channels of the turns with the real surroundings, which of them have room, and what is left at the ends.

        Raises
        ------
        InvalidInput
            When a channel closes between turns that have room, or all do.
        """
        job = self.job
        made = [plane_of(Layer(turn.centre), self.swing, self.tool, k + 1) for k, turn in enumerate(self.turns)]
        room = BladeSurroundings(self.tool, job.feasibility.groups, self.swing)
        made = with_room(made, [turn.centre for turn in self.turns], room, job.progress)
        good = np.array([one.wide.width > 2 * CLEARANCE for one in made])
        if not good.any():
            worst = max(range(len(made)), key=lambda k: made[k].wide.width)
            self._report_closed(made, worst)
        first, last = int(np.flatnonzero(good)[0]), int(np.flatnonzero(good)[-1])
        if not good[first:last + 1].all():
            self._report_closed(made, first + int(np.argmin(good[first:last + 1])))
        height = [float(turn.contact.mean(axis=0) @ self.swing.direction) for turn in self.turns]
        whole = max(height[0] - height[-1], 1e-9)
        left = (height[0] - height[first]) / whole, (height[last] - height[-1]) / whole
        if sum(left) > _LEFT_OUT:
            self._report_closed(made, last + 1 if left[1] > left[0] else first - 1)
        return made[first:last + 1], slice(first, last + 1), left

    def _report_closed(self, planes: Sequence[SThetaLayer], k: int) -> None:
        """Tell where a channel closes."""
        wide = planes[k].wide
        i = int(np.argmin(wide.high - wide.low))
        turn = self.turns[k]
        at = turn.contact[i if planes[k].onward else len(turn.contact) - 1 - i]
        raise InvalidInput(f"the channel of tool angles closes on layer {k + 1} of {len(planes)} at S = "
                           f"{wide.lengths[i]:.1f} mm, at {np.round(at, 2).tolist()}: "
                           f"{degrees(2 * CLEARANCE - wide.width):.1f} deg are missing for a rotary axis that does "
                           f"not turn back; take {LONGER_TOOL}, or a machine on which it leans away from the "
                           "root; where a neighbouring blade bars the way no tool goes around that reaches to it: "
                           "plan the sides with strategy 'indexed'")

    def links(self, axes: Array) -> MovingLinks:
        """How the path is entered and left.

        Parameters
        ----------
        axes : (k, 3) array
            At its ends.
        """
        up = np.asarray(unit(axes.sum(axis=0)))
        over = height_over(self.job.worth.scallop)
        crossing = MovingLinkClearance(self.tool, self.job.groups, self.job.worth.allowance, over)
        linking = Linking(self.job.top(up), run_in=0.0, approach=over + OVER, rise=crossing.rise)
        return MovingLinks(linking, up, self.tool, crossing.clear)

    def made(self, planes: list[SThetaLayer], some: slice, left: tuple[float, float],
             clearance: float) -> tuple[BladeSchedule, ToolPath]:
        """Tool angles with a clearance, and the path.

        Parameters
        ----------
        planes, some, left
            From `planes`.
        clearance : float
            rad
        """
        layers = schedule_layers(planes, self.swing, curve=self.kind, clearance=clearance, progress=self.job.progress)
        schedule = BladeSchedule(self.swing, self.turns[some], layers, left)
        ends = np.array([layers[0].axes[0], layers[-1].axes[-1]])
        return schedule, path_of(schedule, self.tool, self.links(ends))


def blade(job: FaceProblem, curve: str = "least") -> tuple[Orientation, ToolPath | None]:
    """A path around a blade on which one rotary axis swings without turning back within a layer.

    Parameters
    ----------
    job : FaceProblem
    curve : str
        "least": least peak acceleration; "keys": key points and rounded corners as in the paper.

    Returns
    -------
    Orientation
        With the mean axis of both ends; without one where no path keeps all distances, with the reasons.
    ToolPath or None

    Raises
    ------
    InvalidInput
        When the tool has no ball end, or the face does not go around a blade.
    Cancelled
        When the user asked to stop.

    Notes
    -----
    **Source**: [stheta2023]; the surroundings are the real ones, and the proof that of all moving axes.
    """
    search = BladeSearch(job, curve)
    refused: list[str] = []
    try:
        planes = search.planes()
        for clearance in CLEARANCES:
            schedule, path = search.made(*planes, clearance)
            why = _find_objection(job, path)
            if why is None:
                return _orientation_of(search, schedule, path, refused), path
            refused.append(f"refused with {degrees(clearance):.0f} deg of clearance: {why}")
    except InvalidInput as reason:
        refused.append(f"no path found: {reason}")
    return Orientation(None, search.feed, outcome="not_found", reasons=tuple(refused)), None


def _find_objection(job: FaceProblem, path: ToolPath) -> str | None:
    """Why a path may not be used."""
    limits = while_moving(job.feasibility.limits)
    if limits is not None and not limits.allowed(path.axis).all():
        return "the axis leaves its limits on the path"
    stopped = beyond(job, path)
    if stopped is not None:
        return sentence(stopped, job.feasibility)
    proof = prove_moving(path, job.worth.tool, job.groups, job.worth.allowance, progress=job.progress)
    return None if proof.witness is None else sentence(proof.witness, job.feasibility)


def _orientation_of(search: BladeSearch, schedule: BladeSchedule, path: ToolPath, refused: list[str]) -> Orientation:
    """What a path comes to."""
    job, layers = search.job, schedule.layers
    proof = prove_moving(path, search.tool, job.groups, job.worth.allowance, progress=job.progress)
    length = path.length(Motion.CUT)
    area = job.worth.face.area * (1 - sum(schedule.left))
    cut = path.kind == Motion.CUT
    lean = float(np.mean(angle_between(path.axis[cut], path.normal[cut])))
    keys = sum(len(one.keys) for one in layers)
    words = [f"{len(layers)} layers {'to and fro' if job.direction == 'zigzag' else 'in a helix'}, the rotary axis "
             f"swings without turning back within a layer; channel at least "
             f"{degrees(min(one.wide.width for one in layers)):.1f} deg wide",
             f"{keys} key points" if search.kind == "keys" else "tool angles of least peak acceleration", CHECKED]
    if sum(schedule.left) > 0:
        words.append(f"{100 * schedule.left[0]:.1f} % of the span at the tip and {100 * schedule.left[1]:.1f} % at the "
                     "root have no room for the tool and are left as rest material")
    axis = np.asarray(unit(layers[0].axes[0] + layers[-1].axes[-1]))
    return Orientation(axis, search.feed, path.passes, float(path.passes), length, area / length, proof.gouge,
                       proof.clearance, "feasible", (*words, *refused), lead=lean, unreached=sum(schedule.left))
