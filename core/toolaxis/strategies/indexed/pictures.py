"""The map of axes of an operation with a fixed axis, its strip widths, and the study of estimate and count."""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.strip.width import strip_width
from toolaxis.errors import InvalidInput
from toolaxis.numeric.smallest_cap import smallest_cap
from toolaxis.numeric.vectors import unit
from toolaxis.path.estimate import estimate
from toolaxis.path.iso_parametric import layout
from toolaxis.path.pass_count import count
from toolaxis.plan.choices import ISO
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.report.figures.hemisphere import hemisphere_picture
from toolaxis.report.figures.plots import WidthStudy, study_picture, widths_picture
from toolaxis.report.figures.splat_renderer import mean_direction
from toolaxis.search.evaluated_axes import AxisTable
from toolaxis.search.face_problem import FaceProblem
from toolaxis.search.sectors import roman_axis, sectors
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

_ANGLES = 9
_POINTS = 60


def draw_fixed_axis(plan: Plan, op: Operation, task: FaceProblem, folder: Path) -> None:
    """Draw the map of all axes of an operation and the strip widths along its passes.

    In a plan that was compared with other methods the operation on the largest face also gets what takes longer: the
    study of estimate and count, and the axis of the paper's sectors marked on its hemisphere.

    Parameters
    ----------
    plan : Plan
    op : Operation
    task : FaceProblem
    folder : Path
    """
    studied = _operation_to_study(plan)
    if op.orientation.map is not None:
        marks = {**_marks(op), **_baselines(plan, task, op is studied)}
        hemisphere_picture(op.orientation.map, op.face.area, _mean_normal(op.face), marks,
                           op.name).savefig(folder / f"{op.name}-axes.png")
    if op.done:
        widths_picture(width_lines(plan, op, task), (op.face, op.tool),
                       op.name).savefig(folder / f"{op.name}-widths.png")
    if op is studied and op.orientation.pattern == ISO:  # the estimate is one of passes along parameters
        _draw_study(plan, op, task, folder)


def _operation_to_study(plan: Plan) -> Operation | None:
    """The operation on the largest face of a plan that was compared; none of another one."""
    copies = {} if plan.blades is None else plan.blades.copies
    done = [op for op in plan.operations if op.done and op.number not in copies]
    return max(done, key=lambda op: op.face.area, default=None) if plan.baselines else None


def _mean_normal(face: Face) -> Array:
    return mean_direction(face.normal(face.grid(24, 24)))


def _marks(op: Operation) -> Mapping[str, ArrayLike]:
    marks: dict[str, ArrayLike] = {}
    if op.orientation.axis is not None:
        marks["chosen"] = op.orientation.axis
    lobes = [lobe.axis for lobe in op.orientation.lobes if lobe.axis is not None]
    if lobes:
        marks["other lobes"] = np.array(lobes)
    marks["mean normal"] = _mean_normal(op.face)
    return marks


def _baselines(plan: Plan, job: FaceProblem, sectors_too: bool) -> Mapping[str, ArrayLike]:
    """Axes that other rules choose: Roman's, and that of projection planes and sectors."""
    marks: dict[str, ArrayLike] = {"Roman's rule": roman_axis(AxisTable(job.feasibility, job.worth, job.progress))}
    if sectors_too and plan.inputs.method != "sectors":
        found = sectors(AxisTable(job.feasibility, job.worth, job.progress))
        marks |= {"sectors [zhu2016]": found[0].axis} if found else {}
    return marks


def width_lines(plan: Plan, op: Operation, job: FaceProblem) -> list[tuple[Array, Array]]:
    """Strip widths along the passes of an operation with a fixed axis, as it is laid out on its own.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    job : FaceProblem
        Of `toolaxis.job.planning.edit_axis.search_task`.

    Returns
    -------
    list of ((n, 3) array, (n,) array)
        Contact points of each pass, mm, and the strip width there, mm.
    """
    axis, feed = op.orientation.axis, op.orientation.feed
    assert axis is not None

    def _reach(uv: Array) -> NDArray[np.bool_]:
        return job.feasibility.reach(uv, axis)

    placed = job.laid(axis, feed)
    lines = []
    for low, high, step in placed.pieces:
        uv = placed.chart.uv(np.linspace(low, high, _POINTS), np.full(_POINTS, step))
        uv = uv[_reach(uv)]
        if len(uv) > 1:
            along = placed.chart.feed_at(uv)
            width = strip_width(op.face, op.tool, uv, axis, plan.inputs.scallop, along).sum(axis=1)
            lines.append((op.face.evaluate(uv).point, width))
    return lines


def _draw_study(plan: Plan, op: Operation, job: FaceProblem, folder: Path) -> None:
    assert op.orientation.axis is not None
    study = width_study(op.face, op.tool, op.orientation.axis, plan.inputs.scallop, op.orientation.feed,
                        usable=lambda axis: job.feasibility.witness(axis) is None)
    if len(study.angle) > 1:
        study_picture(study, op.name).savefig(folder / f"{op.name}-estimate.png")


def width_study(face: Face, tool: Tool, axis: ArrayLike, scallop: float, feed: str, *,
                angles: int = _ANGLES, usable: Callable[[Array], bool] = lambda axis: True) -> WidthStudy:
    """Estimate, count and passes made for axes in the plane of the mean normal and a given axis.

    Parameters
    ----------
    face : Face
    tool : Tool
    axis : (3,) array_like
    scallop : float
        mm
    feed : str
    angles : int
        How many axes; from 3 degrees outside the cone of normals to 75 degrees from its middle.
    usable : callable
        Whether an axis (3,) may be used; the others are left out.

    Returns
    -------
    WidthStudy
        Without the axes that leave no strip somewhere.
    """
    normals = face.normal(np.concatenate([face.grid(24, 24), *face.outline]))
    middle, spread, _ = smallest_cap(normals)
    chosen = float(np.arccos(np.clip(middle @ unit(axis), -1, 1)))
    across = unit(np.asarray(axis) - (middle @ np.asarray(axis)) * middle)
    low = spread + np.radians(3.0) if tool.flat_radius > 0 else 0.0
    found = []
    for angle in np.linspace(low, max(low + np.radians(5.0), min(np.radians(75.0), np.pi / 2 - spread)), angles):
        turned = np.cos(angle) * middle + np.sin(angle) * across
        if not usable(turned):
            continue
        try:
            made = layout(face, tool, turned, scallop, feed).used
            found.append((angle, 1 / float(np.asarray(estimate(face, tool, turned, scallop, feed))),
                          1 / count(face, tool, turned, scallop, feed), 1 / made))
        except InvalidInput:  # no strip somewhere: the axis cannot machine this face
            continue
    table = np.array(found).reshape(-1, 4)
    return WidthStudy(table[:, 0], table[:, 1], table[:, 2], table[:, 3], chosen)
