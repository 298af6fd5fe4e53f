"""One face to be machined and everything that decides about a fixed axis for it, with the passes that an axis gets."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.contact.clearance.gouge import least_distance
from toolaxis.errors import InvalidInput, UnsupportedGeometry
from toolaxis.feasibility.feasibility import Feasibility
from toolaxis.feasibility.surroundings import MARGIN, OTHER, SKIN, CheckSurfaces, Obstacles, group_surroundings
from toolaxis.feed.fixed_axis_time import Feeds
from toolaxis.machine.limits import AxisLimits
from toolaxis.path.cl_points import trace
from toolaxis.path.links import LeadArcs, Linking
from toolaxis.path.mending import FurtherPasses, complete_passes
from toolaxis.path.pass_layout import Layout, lay_out, pass_length, places_between
from toolaxis.path.planes import PlaneChart
from toolaxis.path.rest_material import RestFinder
from toolaxis.plan.choices import ISO
from toolaxis.plan.zone import Zone
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.search.cost import MachiningCost
from toolaxis.search.link_heights import OVER, LinkClearance, height_over
from toolaxis.search.machine_limits import at_face, mounting_of
from toolaxis.search.time_estimate import pace_of
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part
from toolaxis.tolerances import Tolerance, ToleranceLike
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Height above everything at which links cross at least, mm.
CROSSING = 5.0


@dataclass(frozen=True, eq=False)
class FaceProblem:
    """One face to be machined, and everything that decides about an axis for it.

    Attributes
    ----------
    feasibility : Feasibility
        With the distances that the search keeps: a little more than required.
    worth : MachiningCost
    groups : tuple of CheckSurfaces
        The same surroundings with the required distances, for the proof.
    chord : float
        How far straight motions may leave passes, mm.
    progress : Progress
    direction : str
        "zigzag", "climb" or "conventional".
    left_out : (n, 3) array
        Contacts, mm, that passes keep away from besides all on which the cutter may not stand; what stays there is
        undercut.
    laid_for : float
        Share of the scallop height for which passes are laid.
    lead : float
        Radius of the arcs on which the tool comes to passes and leaves them, mm; 0 for none.
    """

    feasibility: Feasibility
    worth: MachiningCost
    groups: tuple[CheckSurfaces, ...]
    chord: float
    progress: Progress = NO_PROGRESS
    direction: str = "zigzag"
    left_out: Array = field(default_factory=lambda: np.empty((0, 3)))
    laid_for: float = 1.0
    lead: float = 0.0

    @property
    def box(self) -> Array:
        """Corners of the box around everything, (2, 3) mm."""
        boxes = np.array([group.box for group in self.groups])
        return np.stack([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])

    def top(self, axis: Array) -> float:
        """Height along an axis of a tip that is above everything, and above what may stand there, mm.

        Parameters
        ----------
        axis : (3,) array
        """
        low, high = self.box
        clear = max(CROSSING, height_over(self.worth.scallop) + OVER) + max(group.stock for group in self.groups)
        return float(np.maximum(low * axis, high * axis).sum()) + clear

    def reach(self, uv: Array, axis: Array) -> NDArray[np.bool_]:
        """Whether the cutter may stand at parameters of the face, (n,).

        Parameters
        ----------
        uv : (n, 2) array
        axis : (3,) array
        """
        free = self.feasibility.reach(uv, axis)
        if len(self.left_out):
            away = cKDTree(self.left_out).query(self.worth.face.evaluate(uv).point)[0]
            free = free & (away > self.aside)
        return free

    @property
    def aside(self) -> float:
        """How far passes keep from what is left out, mm: half the narrowest strip on a plane."""
        tool = self.worth.tool
        return float(np.sqrt(2 * self.worth.scallop * (tool.corner_radius or tool.radius)))

    def without(self, ends: Array) -> "FaceProblem":
        """The same with further contacts left out, from one end of a motion to the other, (m, 2, 3) mm.

        Parameters
        ----------
        ends : (m, 2, 3) array
        """
        parts = [np.linspace(first, last, int(np.ceil(np.linalg.norm(last - first) / self.aside)) + 1)
                 for first, last in ends]
        return replace(self, left_out=np.concatenate([self.left_out, *parts]))

    def laid(self, axis: Array, feed: str) -> Layout:
        """The passes with an axis, cut out where the tool must not go, before they are traced.

        Parameters
        ----------
        axis : (3,) array
        feed : str

        Raises
        ------
        InvalidInput, UnsupportedGeometry
            When the axis leaves no strip, or passes of this kind do not go with the face.
        """
        cut, reach = self.worth.cut(axis), lambda uv: self.reach(uv, axis)
        cut = replace(cut, scallop=self.laid_for * cut.scallop)
        found: list[Layout] = []
        refused: list[InvalidInput | UnsupportedGeometry] = []
        for pattern in self.worth.patterns:
            try:
                placed = lay_out(pattern.chart(cut, feed), cut, reach, self.progress)
                if isinstance(placed.chart, PlaneChart):
                    placed.chart.check_pieces(placed.pieces)
                found.append(placed)
            except (InvalidInput, UnsupportedGeometry) as reason:
                refused.append(reason)
        if not found:
            raise refused[0]
        return found[0] if len(found) == 1 else min(found, key=pass_length)

    def traced(self, placed: Layout) -> ToolPath:
        """Passes with their links.

        Next to walls and where the skin goes on beyond the sub-surface they begin and end without ramps: a ramp goes on
        along the feed, into what stands there.

        Parameters
        ----------
        placed : Layout
        """
        axis = placed.cut.axis
        height = self.top(axis)
        own = self.worth.face.own_faces
        walls = any(group.role == OTHER or (group.role == SKIN and any(one not in own for one in group.faces))
                    for group in self.groups)
        over = height_over(self.worth.scallop)
        crossing = LinkClearance(self.worth.tool, self.groups, axis, height, self.worth.allowance, over)
        lead = LeadArcs(self.lead, self.chord, crossing.free) if self.lead > 0 else None
        return trace(placed, self.chord, self.direction,
                     linking=Linking(height, run_in=0.0 if walls else 1.0, approach=over + OVER, lower=crossing.heights,
                                     beside=crossing.beside, rise=crossing.rise, lead=lead))

    def made(self, axis: Array, feed: str) -> ToolPath:
        """The very passes, links and ramps included, that `check_candidate` proves.

        Parameters
        ----------
        axis : (3,) array
        feed : str
        """
        placed = self.laid(axis, feed)
        return self.completed(placed, self.traced(placed)).path

    def completed(self, placed: Layout, path: ToolPath) -> FurtherPasses:
        """Passes with the further ones that it takes to leave little on which the cutter may stand.

        Parameters
        ----------
        placed : Layout
        path : ToolPath
            Of that layout.
        """
        axis = placed.cut.axis
        return complete_passes(placed, path, self.traced, self._rest_finder(axis, placed).find,
                               lambda uv: self.reach(uv, axis))

    def left_by(self, path: ToolPath, placed: Layout | None = None) -> tuple[Zone, ...]:
        """Zones that passes leave higher than the scallop limit, the largest first.

        Parameters
        ----------
        path : ToolPath
            With one fixed axis.
        placed : Layout, optional
            Passes of that path: where strips are not exact it is looked between them too.
        """
        return self._rest_finder(path.axis[0], placed).find(path)

    def _rest_finder(self, axis: Array, placed: Layout | None) -> RestFinder:
        """What finds the zones that passes leave; between those of a layout it looks closer where strips are not exact.
        """
        worth = self.worth
        between = None
        if placed is not None and worth.face.surface.stand_in is not None:
            between = places_between(placed)
        return RestFinder(worth.face, worth.tool, worth.scallop, worth.allowance,
                          lambda uv: ~self.feasibility.reach(uv, axis), self.progress, between)


def task(face: Face, tool: Tool, scallop: float, limits: AxisLimits | None = None, obstacles: Obstacles = None, *,
         objective: str = "length", part: Part | None = None, skin: Sequence[Face] = (),
         surroundings: Sequence[Face] = (), tolerance: ToleranceLike = None, allowance: float = 0.0,
         direction: str = "zigzag", passes: str = ISO, feeds: Feeds | None = None,
         greatest_step_over: float = np.inf, lead: float = 0.0, index_length: float = 0.0,
         progress: Progress = NO_PROGRESS) -> FaceProblem:
    """Gather what decides about an axis for a face.

    Parameters
    ----------
    face, tool, scallop, obstacles, objective, part, skin, surroundings, tolerance, allowance, direction, passes, feeds
        As for `best_axis`.
    greatest_step_over, lead : float
        As for `best_axis`.
    index_length : float
        Length of a cut that takes as long as an index move, mm; 0 where the best axis is to be found in any case.
    limits : AxisLimits, optional
    progress : Progress

    Raises
    ------
    InvalidInput
        When an argument is out of range.
    """
    given = Tolerance.of(tolerance).for_cutter(tool.radius)
    pace = pace_of(face, tool, mounting_of(limits), feeds) if objective == "time" else None
    worth = MachiningCost(face, tool, scallop, allowance, objective, pace, passes=passes,
                          greatest_step_over=greatest_step_over, index_length=index_length)
    chord = given.chord_for(scallop)
    kept = replace(given, gouge=given.gouge - chord, cutter_clearance=given.cutter_clearance + MARGIN,
                   shank_clearance=given.shank_clearance + MARGIN, holder_clearance=given.holder_clearance + MARGIN)
    strict, groups = (group_surroundings(face, replace(limit,
                                                       gouge=allowance - least_distance(tool, limit.gouge, allowance)),
                                         allowance, part=part, skin=skin, surroundings=surroundings,
                                         obstacles=obstacles) for limit in (kept, given))
    reach = at_face(limits, face, tool)
    return FaceProblem(Feasibility(face, tool, strict, given, reach, allowance), worth, groups, chord, progress,
                       direction, lead=lead)
