"""One operation: a sub-surface, its tool, its orientation, its tool path and its work coordinate system."""

from dataclasses import dataclass

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.machine.work_coordinates import WorkCoordinates
from toolaxis.plan.orientation import Orientation
from toolaxis.plan.timing import MachiningTime
from toolaxis.plan.zone import Zone
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool


@dataclass(frozen=True, eq=False)
class Operation:
    """What is done to one sub-surface with one tool and one fixed axis.

    Attributes
    ----------
    number : int
        From 1, in the order in which operations are carried out.
    face : Face
        The sub-surface.
    tool : Tool
        What machines it, or what was tried.
    orientation : Orientation
        The axis with what it costs, or the reasons why there is none.
    path : ToolPath or None
        Passes and links in the part's frame; None where there is no axis.
    frame : WorkCoordinates or None
        None where there is no axis.
    zones : tuple of Zone
        What it leaves higher than the scallop limit, the largest first; the whole sub-surface where that is left to a
        clean-up tool.
    time : MachiningTime or None
        What the plan's machine takes, where it states the limits of its axes.
    rotary : tuple of float
        Where the rotary axes of the plan's machine stand, rad; empty without one.
    rest_of : tuple of int
        Numbers of the operations with larger tools that left it; empty where it is not such a rest.
    traceback : str
        Where the program failed on it, of the exception; plan.json names the file that has it.
    unreachable : float
        Area that is proven to be out of reach of every tool of the plan, mm^2, where there is no path.
    """

    number: int
    face: Face
    tool: Tool
    orientation: Orientation
    path: ToolPath | None = None
    frame: WorkCoordinates | None = None
    zones: tuple[Zone, ...] = ()
    time: MachiningTime | None = None
    rotary: tuple[float, ...] = ()
    rest_of: tuple[int, ...] = ()
    traceback: str = ""
    unreachable: float = 0.0

    @property
    def failed(self) -> bool:
        """Whether the program itself failed on it: nothing is known of what can be machined."""
        return self.orientation.outcome == "failed"

    @property
    def done(self) -> bool:
        """Whether there is an axis and a path."""
        return self.path is not None

    @property
    def left(self) -> bool:
        """Whether the whole sub-surface is left as rest material."""
        return self.path is None and bool(self.zones)

    @property
    def name(self) -> str:
        """Name of the operation, also of its CL file."""
        return f"op{self.number:02d}-face{self.face.label}"

    @property
    def travel(self) -> float:
        """Length of the tip's motion off the cut (entries, exits and links), mm."""
        return 0.0 if self.path is None else self.path.length(Motion.ENTRY, Motion.EXIT, Motion.LINK)

    def seconds(self, feedrate: float, rapid: float) -> float:
        """Time that the path takes, s: that of the machine where it is known.

        Elsewhere every motion at its full rate, cutting, entries and exits at the feed rate, links at the rapid rate: a
        lower bound of what a machine takes.

        Parameters
        ----------
        feedrate, rapid : float
            The plan's, mm/min.
        """
        if self.path is None:
            return 0.0
        if self.time is not None:
            return self.time.path
        slow = self.path.length(Motion.CUT, Motion.ENTRY, Motion.EXIT)
        return 60 * (slow / (self.tool.feedrate or feedrate) + self.path.length(Motion.LINK) / rapid)
