"""What the tools of a rack reach of faces, as the screening of cells sees it, and the chains of tools that follow."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.job.planning.planner import PlanningJob
from toolaxis.plan.plan import INDEX_SECONDS
from toolaxis.regions.cells import FaceCells, screening_axes
from toolaxis.regions.prices import widths
from toolaxis.regions.reach_screen import ReachScreen
from toolaxis.regions.scene import ReachScene
from toolaxis.regions.tool_choice import FacePrices, ToolChain, chains_of
from toolaxis.shape.counterparts import apply_motion
from toolaxis.shape.face import Face
from toolaxis.shape.nurbs import NurbsSurface
from toolaxis.skin.alike import AlikeFace
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Angle between the axes that are screened, rad, and cells of a face for it, about.
APART, _CELLS = np.radians(20), 200
#: Difference in any component up to which two axes are the same.
_SAME_AXIS = 1e-9


class ReachBits(NamedTuple):
    """Which cells of a face tools reach under axes, small enough to be kept for every face.

    begin : number of the first of the tools
    shape : tools, axes, cells
    bits : of an array of bool of that shape, eight to a byte
    """

    begin: int
    shape: tuple[int, ...]
    bits: NDArray[np.uint8]

    def from_tool(self, begin: int) -> NDArray[np.bool_]:
        """The array, (tools, axes, cells), from a tool on."""
        count = int(np.prod(self.shape))
        whole = np.unpackbits(self.bits, count=count).astype(bool).reshape(self.shape)
        return np.asarray(whole[begin - self.begin:])


class ScreenedFace(NamedTuple):
    """What the screening says of a face.

    chains : of tools, the cheapest first
    reach : what they stand on
    """

    chains: tuple[ToolChain, ...]
    reach: ReachBits


class LargestTools(NamedTuple):
    """The largest tool that reaches each cell of a face, under any axis, as the screening sees it.

    face : that is screened
    tools : the larger ones first, k of them
    point, normal : (n, 3) array, mm, and unit vectors out of the material
    area : (n,) array, mm^2
    largest : (n,) array of int, place of the tool among `tools`; k, beyond the last one, where none reaches the cell
    """

    face: Face
    tools: tuple[Tool, ...]
    point: Array
    normal: Array
    area: Array
    largest: NDArray[np.intp]

    def carry_to(self, alike: AlikeFace) -> "LargestTools":
        """The same on a face that is alike; what differs around it does not count.

        Parameters
        ----------
        alike : AlikeFace
        """
        return self._replace(face=alike.face, point=apply_motion(alike.matrix, self.point),
                             normal=self.normal @ alike.matrix[:3, :3].T)


class RackScreening:
    """What tools reach of faces, and what it takes, as the screening sees it.

    Parameters
    ----------
    jobs : sequence of PlanningJob
    faces : sequence of Face
        From whose normals the axes are taken.
    """

    def __init__(self, jobs: Sequence[PlanningJob], faces: Sequence[Face]) -> None:
        first = jobs[0]
        self._jobs = jobs
        #: The part, as its faces are screened.
        self.scene = ReachScene.of(first.part, first.obstacles, first.inputs.tolerance, first.axis_limits,
                                    first.inputs.allowance)
        #: What was found of faces, by their places.
        self._known: dict[tuple[NurbsSurface, bytes], ReachBits] = {}
        self._axes = screening_axes([self._cells(face) for face in faces], first.axis_limits, APART)

    def _cells(self, face: Face) -> FaceCells:
        return FaceCells.few(face, max(self._jobs[-1].tool.radius, float(np.sqrt(face.area / _CELLS))))

    def look_at(self, face: Face, begin: int) -> ScreenedFace:
        """What tools, from one on, may do of a face.

        Parameters
        ----------
        face : Face
        begin : int
        """
        prices, facing = self._prices(face, begin)
        held = np.isfinite(prices.seconds)
        chains = tuple(one._replace(tools=tuple(tool + begin for tool in one.tools),
                                    axes=tuple(axis._replace(axis=int(facing[axis.axis])) for axis in one.axes))
                       for one in chains_of(prices, INDEX_SECONDS))
        return ScreenedFace(chains, ReachBits(begin, held.shape, np.packbits(held)))

    def largest_tools(self, face: Face, reach: ReachBits) -> LargestTools:
        """Which tools reach what of a face, for a picture of it.

        Parameters
        ----------
        face : Face
        reach : ReachBits
            Of all tools, as `look_at` found it.
        """
        cells = self._cells(face)  # made again: kept for all faces, they would go from process to process
        reached = reach.from_tool(0).any(axis=1)
        largest = np.where(reached.any(axis=0), reached.argmax(axis=0), len(self._jobs))
        tools = tuple(job.tool for job in self._jobs)
        return LargestTools(face, tools, cells.point, cells.normal, cells.area, largest)

    def keep(self, screened: Mapping[Face, ScreenedFace]) -> None:
        """Remember what was found: a face that a tool cannot machine at all waits for the next one as it is.

        Parameters
        ----------
        screened : mapping of Face to ScreenedFace
        """
        for face, one in screened.items():
            before = self._known.get(_place_of(face))
            if before is None or one.reach.begin < before.begin:
                self._known[_place_of(face)] = one.reach

    def reachable(self, face: Face) -> float:
        """Area of a face that some tool reaches under some axis, mm^2.

        Parameters
        ----------
        face : Face
        """
        prices, _ = self._prices(face, 0)
        return float(prices.area @ np.isfinite(prices.seconds).any(axis=(0, 1)))

    def _prices(self, face: Face, begin: int) -> tuple[FacePrices, NDArray[np.intp]]:
        """What it takes tools, from one on, to machine cells of a face, and the numbers of the axes that see any."""
        jobs = self._jobs[begin:]
        inputs = jobs[0].inputs
        tools = [job.tool for job in jobs]
        cells = self._cells(face)
        facing = np.flatnonzero((cells.normal @ self._axes.T > 0).any(axis=0))
        axes = self._axes[facing]
        if not len(axes) or not len(cells):
            return FacePrices(np.full((len(jobs), len(axes), len(cells)), np.inf), cells.area), facing
        wide = widths(cells, tools, axes, inputs.scallop, inputs.allowance_of(face), inputs.step_over)
        pace = np.array([job.inputs.at_rates_of(job.tool).feedrate / 60 for job in jobs])[:, None, None]
        known = self._known.get(_place_of(face))
        if known is not None and known.begin <= begin and known.shape[1:] == wide.shape[1:]:
            held = known.from_tool(begin)
        else:
            scene = replace(self.scene, allowance=inputs.allowance_of(face))
            held = ReachScreen(cells, scene).screen_promising(tools, axes, wide > 0)
        seconds = np.where(held, cells.area / (np.where(held, wide, 1.0) * pace), np.inf)
        return FacePrices(seconds, cells.area), facing

    def axis(self, number: int) -> Array:
        """An axis by its number, (3,) unit vector.

        Parameters
        ----------
        number : int
        """
        return np.asarray(self._axes[number])

    def numbers_of(self, axes: Sequence[Array]) -> frozenset[int]:
        """The numbers of those of some axes that are screened.

        Parameters
        ----------
        axes : sequence of (3,) arrays
        """
        found = (np.flatnonzero(np.abs(self._axes - axis).max(axis=1) < _SAME_AXIS) for axis in axes)
        return frozenset(int(number) for some in found for number in some)


def _place_of(face: Face) -> tuple[NurbsSurface, bytes]:
    """What tells a face from others: its surface, and where on that it lies."""
    return face.surface, b"".join(loop.tobytes() for loop in face.outline)
