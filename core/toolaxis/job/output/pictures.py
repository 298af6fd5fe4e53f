"""Pictures of a plan and of its verdict, written as PNG files beside it."""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.contact.strip.width import strip_width
from toolaxis.errors import InvalidInput
from toolaxis.feasibility.normal_cone import smallest_cap
from toolaxis.job.output.blade_pictures import draw_blade
from toolaxis.job.output.roughness_pictures import draw_roughness
from toolaxis.job.planning.blade_clearances import tightest
from toolaxis.job.planning.edit_axis import search_task
from toolaxis.numeric.vectors import unit
from toolaxis.path.estimate import estimate
from toolaxis.path.iso_parametric import layout
from toolaxis.path.pass_count import count
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.report.figures.closest_approach import tightest_picture
from toolaxis.report.figures.comparison_chart import baselines_picture, options_picture
from toolaxis.report.figures.hemisphere import hemisphere_picture
from toolaxis.report.figures.machine import has_machine_picture, machine_picture
from toolaxis.report.figures.plan_overview import overview_picture
from toolaxis.report.figures.plots import (
    WidthStudy,
    map_picture,
    operation_picture,
    study_picture,
    widths_picture,
)
from toolaxis.report.figures.splat_renderer import mean_direction
from toolaxis.search.evaluated_axes import Ledger
from toolaxis.search.fixed_axis import Task
from toolaxis.search.sectors import roman_axis, sectors
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.strategies.four_plus_one.pictures import free_angle_picture, turning_of
from toolaxis.strategies.two_point.pictures import contacts_picture
from toolaxis.strategies.two_point.rings import Setting, rings, stand_of
from toolaxis.tools.tool import Tool
from toolaxis.verify.verdict import Verdict

Array = NDArray[np.float64]

DPI = 110
_ANGLES = 9
_POINTS = 60
#: Places of a path among which the one with two contacts is chosen.
_PLACES = 200


def draw_plan(plan: Plan, folder: Path, progress: Progress = NO_PROGRESS) -> None:
    """Draw the whole part where it has several operations, and every operation: passes and tool, axes, strip widths.

    The tool is drawn once more where it comes nearest to what it must keep clear of; turned copies of operations are
    drawn in the picture of the whole part only.

    A choice between numbers of orientations is drawn as their curve, a comparison of methods as bars, and a machine
    that states its bodies with part and tool at each orientation.

    Where the axis moves, its passes are drawn, and where it makes two contacts, the cutter at the widest of them.

    In a plan that was compared with other methods the operation on the largest face also gets what takes longer: the
    study of estimate and count, and the axis of the paper's sectors marked on its hemisphere.

    Parameters
    ----------
    plan : Plan
    folder : Path
    progress : Progress
    """
    if len(plan.operations) > 1:
        overview_picture(plan).savefig(folder / "plan.png", dpi=DPI)
    if plan.options:
        options_picture(plan.options).savefig(folder / "orientations.png", dpi=DPI)
    if plan.baselines:
        baselines_picture(plan.baselines).savefig(folder / "baselines.png", dpi=DPI)
    if has_machine_picture(plan):
        machine_picture(plan).savefig(folder / "machine.png", dpi=DPI)
    closest = tightest(plan, progress)
    if closest is not None:
        tightest_picture(plan, closest.operation, closest).savefig(folder / "tightest.png", dpi=DPI)
    copies = {} if plan.blades is None else plan.blades.copies
    originals = [op for op in plan.operations if op.number not in copies]
    done = [op for op in originals if op.done]
    studied = max(done, key=lambda op: op.face.area, default=None) if plan.baselines else None
    for index, op in enumerate(originals):
        progress.report("drawing", index, len(originals))
        job = search_task(plan, op, Progress(None, progress.cancelled))
        if op.orientation.map is not None:
            marks = {**_marks(op), **_baselines(plan, job, op is studied)}
            hemisphere_picture(op.orientation.map, op.face.area, _mean_normal(op.face), marks,
                               op.name).savefig(folder / f"{op.name}-axes.png", dpi=DPI)
        if op.done:
            operation_picture(plan, op).savefig(folder / f"{op.name}-passes.png", dpi=DPI)
        if op.done and op.orientation.lead is not None:
            if plan.inputs.method == "two-point":
                _draw_contacts(plan, op, folder)
            if plan.inputs.method.startswith("blade"):
                draw_blade(plan, op, job, folder)
            turning = turning_of(plan, op) if plan.inputs.method == "four-plus-one" else None
            if turning is not None:
                free_angle_picture(turning, op).savefig(folder / f"{op.name}-angle.png", dpi=DPI)
            if plan.inputs.method == "multiscale":
                draw_roughness(plan, op, folder)
            continue
        if op.done:
            widths_picture(width_lines(plan, op, job), (op.face, plan.tool),
                           op.name).savefig(folder / f"{op.name}-widths.png", dpi=DPI)
        if op is studied:
            _draw_study(plan, op, job, folder)


def draw_verdict(plan: Plan, verdict: Verdict, folder: Path, progress: Progress = NO_PROGRESS) -> None:
    """Draw the scallop and gouge maps of the operations; a turned copy that passes looks as the one it is a copy of.

    Parameters
    ----------
    plan : Plan
    verdict : Verdict
    folder : Path
    progress : Progress
    """
    axes = {op.name: op.orientation.axis for op in plan.operations}
    copies = {} if plan.blades is None else plan.blades.copies
    turned = {op.name for op in plan.operations if op.number in copies}
    drawn = [found for found in verdict.operations if found.maps and not (found.passed and found.name in turned)]
    for index, found in enumerate(drawn):
        progress.report("drawing", index, len(drawn))
        axis = axes[found.name]
        assert axis is not None
        targets = found.maps[:len(found.faces)]
        map_picture(targets, found.scallop_limit, found.gouge_allowed, found.name,
                    axis).savefig(folder / f"{found.name}-verdict.png", dpi=DPI)


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


def _baselines(plan: Plan, job: Task, sectors_too: bool) -> Mapping[str, ArrayLike]:
    """Axes that other rules choose: Roman's, and that of projection planes and sectors."""
    marks: dict[str, ArrayLike] = {"Roman's rule": roman_axis(Ledger(job.feasibility, job.worth, job.progress))}
    if sectors_too and plan.inputs.method != "sectors":
        found = sectors(Ledger(job.feasibility, job.worth, job.progress))
        marks |= {"sectors [zhu2016]": found[0].axis} if found else {}
    return marks


def width_lines(plan: Plan, op: Operation, job: Task) -> list[tuple[Array, Array]]:
    """Strip widths along the passes of an operation with a fixed axis, as it is laid out on its own.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    job : Task
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

    placed = layout(op.face, plan.tool, axis, plan.inputs.scallop, feed, allowance=plan.inputs.allowance, reach=_reach)
    lines = []
    for low, high, step in placed.pieces:
        uv = placed.chart.uv(np.linspace(low, high, _POINTS), np.full(_POINTS, step))
        uv = uv[_reach(uv)]
        if len(uv) > 1:
            width = strip_width(op.face, plan.tool, uv, axis, plan.inputs.scallop, feed).sum(axis=1)
            lines.append((op.face.evaluate(uv).point, width))
    return lines


def _draw_contacts(plan: Plan, op: Operation, folder: Path) -> None:
    """Draw the cutter where its strip is about the widest with two contacts, of some places of the path."""
    assert op.path is not None
    cut = np.flatnonzero(op.path.kind == Motion.CUT)
    some = cut[:: max(len(cut) // _PLACES, 1)]
    found = nearest(op.face, op.path.cc[some])
    on = found.distance < 1e-6
    some, uv = some[on], found.uv[on]
    if not len(some):
        return
    d = op.face.evaluate(uv)
    setting = Setting(op.face, plan.tool, uv, d.su if op.orientation.feed == "u" else d.sv, plan.inputs.scallop,
                      plan.inputs.allowance, plan.inputs.tolerance)
    stand = stand_of(setting, op.path.cl[some], op.path.axis[some])
    sides = np.abs(rings(setting, stand).sides).max(axis=1)
    best = int(np.argmin(np.where(stand.lift > 0.9 * stand.lift.max(), sides, np.inf)))
    one = setting.rows(np.array([best]))
    ring = rings(one, stand.rows(np.array([best])))
    contacts_picture(one, ring, op.name).savefig(folder / f"{op.name}-contacts.png", dpi=DPI)


def _draw_study(plan: Plan, op: Operation, job: Task, folder: Path) -> None:
    assert op.orientation.axis is not None
    study = width_study(op.face, plan.tool, op.orientation.axis, plan.inputs.scallop, op.orientation.feed,
                        usable=lambda axis: job.feasibility.witness(axis) is None)
    if len(study.angle) > 1:
        study_picture(study, op.name).savefig(folder / f"{op.name}-estimate.png", dpi=DPI)


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
