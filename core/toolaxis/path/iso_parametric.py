"""Passes along the parameters of a face."""

from numpy.typing import ArrayLike

from toolaxis.cldata.toolpath import ToolPath
from toolaxis.path.cl_points import trace
from toolaxis.path.links import Linking
from toolaxis.path.parametrization import Cut, IsoChart
from toolaxis.path.pass_layout import Layout, Reach, lay_out
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.face import Face
from toolaxis.tolerances import Tolerance, ToleranceLike
from toolaxis.tools.tool import Tool


def layout(face: Face, tool: Tool, axis: ArrayLike, scallop: float, feed: str = "u", *, allowance: float = 0.0,
           reach: Reach | None = None, progress: Progress = NO_PROGRESS) -> Layout:
    """Place iso-parametric passes without tracing them.

    Parameters
    ----------
    face, tool, axis, scallop, feed, allowance, reach, progress
        As for `passes`.

    Returns
    -------
    Layout
        Steps, the unused share of the last strip, and where each pass begins and ends.
    """
    return lay_out(IsoChart(face, feed), Cut(tool, axis, scallop, allowance), reach, progress)  # type: ignore[arg-type]


def passes(face: Face, tool: Tool, axis: ArrayLike, scallop: float, feed: str = "u", *, direction: str = "zigzag",
           allowance: float = 0.0, reach: Reach | None = None, tolerance: ToleranceLike = None,
           box: ArrayLike | None = None, linking: Linking | None = None, progress: Progress = NO_PROGRESS) -> ToolPath:
    """Passes with a fixed tool axis that leave no scallop above a height.

    Parameters
    ----------
    face : Face
    tool : Tool
    axis : (3,) array_like
        From tip to spindle.
    scallop : float
        Scallop height, mm.
    feed : str
        "u" or "v": the parameter that varies along the passes.
    direction : str
        "zigzag", "climb" or "conventional" (cutter turning clockwise as seen from the spindle).
    allowance : float
        Stock left on the surface, mm.
    reach : callable, optional
        Takes (n, 2) parameters, beyond the face too, and tells which contacts the cutter may visit, (n,) bool.
    tolerance : float or Tolerance, optional
        The machining tolerance, mm, or all tolerances: how far straight motions between points may leave the passes,
        see `Tolerance.chord_for`.
    box : (2, 3) array_like, optional
        Corners of the box that links cross above; the face's own unless given.
    linking : Linking, optional
        How strokes are joined.
    progress : Progress

    Returns
    -------
    ToolPath

    Raises
    ------
    InvalidInput
        When an argument is out of range, or the axis leaves no strip somewhere.

    Notes
    -----
    **Properties**: (1) the scallop height is kept wherever the cutter may go, and reached somewhere; (2) contacts and
    tips keep the chord tolerance; (3) no pass is cut farther beyond the face than its strip needs.
    """
    placed = layout(face, tool, axis, scallop, feed, allowance=allowance, reach=reach, progress=progress)
    return trace(placed, Tolerance.of(tolerance).chord_for(scallop), direction, box, linking)
