"""Tables for the terminal: the faces of a part, the operations of a plan, the verdict."""

from collections.abc import Mapping, Sequence
from math import degrees, inf, isfinite
from typing import Any, TypeAlias

import numpy as np
from rich.table import Table

from toolaxis.plan.baseline import Baseline, clock
from toolaxis.plan.machine_document import rotary_of
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import INDEX_SECONDS, Option, Plan, PlanInputs, describe_feed, outcome_of
from toolaxis.regions.open_places import list_open_places, what_closes
from toolaxis.report.areas_aside import describe_held, describe_hidden, describe_machined_before, describe_not_begun
from toolaxis.shape.stock import format_faces
from toolaxis.verify.component_clearance import Clearance
from toolaxis.verify.verdict import OperationVerdict, Verdict

Column: TypeAlias = tuple[str, str]

_COLUMNS: tuple[Column, ...] = (
    ("sub-\nsurface", "right"), ("axis", "left"), ("feed", "left"), ("passes", "right"), ("strip width\nmm", "right"),
    ("cutting\nlength mm", "right"), ("gouge\nmm", "right"), ("clearance mm\ncutter/shank/holder", "right"))
_OPEN_COLUMNS: tuple[Column, ...] = (("sub-\nsurface", "right"), ("open\nmm2", "right"),
                                     ("proven out\nof reach mm2", "right"), ("about\nx y z", "left"),
                                     ("least concave\nradius mm", "right"), ("what would close it", "left"))
#: Open places that are told one by one.
_OPEN_ROWS = 20
_BOUNDS = "gouge: upper bound; clearance: lower bound, looked at up to 20 mm; -: not checked"
_POINTS = "where the axis moves, the cutter on the machined face is checked at points; clearances are those kept"


def table(title: str, columns: Sequence[Column], rows: Sequence[Sequence[str]], caption: str = "") -> Table:
    """A table of text.

    Parameters
    ----------
    title : str
    columns : sequence of (heading, "left" or "right")
    rows : sequence of sequence of str
    caption : str
        Stands below.
    """
    made = Table(title=title, title_justify="left", caption=caption or None, caption_justify="left")
    for heading, side in columns:
        made.add_column(heading, justify="right" if side == "right" else "left", no_wrap=True)
    for row in rows:
        made.add_row(*row)
    return made


def number(value: float | None, digits: int) -> str:
    """A number for a table: a dash for none, "far" where nothing is near.

    Parameters
    ----------
    value : float or None
    digits : int
        After the point.
    """
    if value is None:
        return "-"
    return f"{value:.{digits}f}" if isfinite(value) else "far" if value == inf else "-"


def _axis(op: Operation) -> str:
    axis, lead = op.orientation.axis, op.orientation.lead
    if lead is not None:
        return f"moves, lead {np.degrees(lead):+.2f} deg"
    return "-" if axis is None else " ".join(f"{component:+.4f}" for component in np.asarray(axis) + 0.0)


def _clearances(found: Mapping[str, float]) -> str:
    return " / ".join(number(found.get(name), 2) for name in ("cutter", "shank", "holder"))


def _operation_row(op: Operation, inputs: PlanInputs) -> list[str]:
    found = op.orientation
    if not op.done:
        return [op.face.label, "rest material" if op.left else found.outcome, *["-"] * 6]
    return [op.face.label, _axis(op), describe_feed(found), str(found.passes),
            number(found.average_strip_width, 3), number(found.length, 1), number(found.gouge, 4),
            _clearances(found.clearance)]


def plan_table(plan: Plan) -> Table:
    """One row per sub-surface: axis, feed, passes, average strip width, cutting length, gouge and clearance.

    Parameters
    ----------
    plan : Plan
        Gouge is an upper bound, clearance a lower one.
    """
    blades = plan.blades
    rows = [[*_operation_row(op, plan.inputs), _over_ideal([op]), *_links(op, plan.inputs), _clean_up(op),
             "rest material" if op.left else op.orientation.outcome]
            for op in plan.operations if blades is None or op.number not in blades.copies]
    if blades is not None:
        shown = [op for op in plan.operations if op.number not in blades.copies]
        rows = [[f"{row[0]} {blades.side_of(op.face.number)}".strip(), *row[1:]]
                for row, op in zip(rows, shown, strict=True)]
    columns = [*_COLUMNS]
    if len(plan.tools) > 1:
        columns.insert(1, ("tool", "left"))
        shown = [op for op in plan.operations if blades is None or op.number not in blades.copies]
        rows = [[row[0], op.tool.shop_name, *row[1:]] for row, op in zip(rows, shown, strict=True)]
    moves = any(op.orientation.lead is not None for op in plan.operations)
    title = (f"{_titled(plan)}, scallop {plan.inputs.scallop:g} mm, tolerance {plan.inputs.tolerance.gouge:g} mm: "
             f"cutting length {plan.length:.1f} mm, with links {plan.length + plan.travel:.1f} mm, "
             f"time {clock(plan.seconds)}, " + ("moving axes" if moves else f"different axes {plan.orientations}"))
    if plan.machine is not None:
        names = "/".join(axis.name for axis in plan.machine.machine.rotary)
        shown = [op for op in plan.operations if blades is None or op.number not in blades.copies]
        at = 1 + [name for name, _ in columns].index("axis")
        rows = [[*row[:at], _angles(plan, op), *row[at:]] for row, op in zip(rows, shown, strict=True)]
        title += f", {plan.machine.machine.name}"
    columns += [("over\nideal %", "right"), ("with links\nmm", "right"), ("time\nmin:s", "right"),
                ("clean-\nup %", "right"), ("outcome", "left")]
    if plan.machine is not None:
        columns.insert(at, (f"{names}\ndeg", "left"))
    points = _POINTS if plan.at_points else ""
    aside = (describe_not_begun(plan), describe_hidden(plan), describe_held(plan), describe_machined_before(plan))
    asked = (allowance_line(plan), step_over_line(plan), lead_line(plan), lean_line(plan), stock_line(plan))
    notes = (_of_part(plan), *aside, _BOUNDS, *asked, _ideal(plan), points, reckoning(plan), _order(plan))
    return table(title, columns, rows, "\n".join(filter(None, notes)))


def allowance_line(plan: Plan) -> str:
    """What is left on which faces, as a sentence; empty where it is the same on all of them.

    Parameters
    ----------
    plan : Plan
    """
    kept = plan.part.allowances
    return "" if kept is None else f"left on purpose: {kept.described}"


def lead_line(plan: Plan) -> str:
    """How the tool comes to passes and leaves them, as a sentence; empty for straight ramps alone.

    Parameters
    ----------
    plan : Plan
    """
    radius = plan.inputs.lead
    if radius == 0:
        return ""
    return f"lead-in and lead-out: arcs of {radius:g} mm, straight where these are not proven free"


def lean_line(plan: Plan) -> str:
    """How far ball ends lean at least, as a sentence; empty where that is not asked for.

    Parameters
    ----------
    plan : Plan
    """
    lean = plan.inputs.tolerance.least_lean
    return f"ball ends lean {degrees(lean):g} deg at least from the normal at every contact" if lean > 0 else ""


def step_over_line(plan: Plan) -> str:
    """How far passes lie apart at most, as a sentence; empty where the scallop height alone decides.

    Parameters
    ----------
    plan : Plan
    """
    most = plan.inputs.greatest_step_over
    return f"passes lie {most:g} mm apart at most, whatever the scallop height allows" if most > 0 else ""


def stock_line(plan: Plan) -> str:
    """What a plan takes as left by roughing, as a sentence; empty where all faces are taken as finished.

    Parameters
    ----------
    plan : Plan
    """
    stock = plan.part.stock
    if stock is None:
        return ""
    return (f"stock: up to {stock.height:g} mm above {format_faces(stock.faces)}, all other faces finished; shank, "
            "holder and rapid moves keep clear of it; clearances are to the finished faces")


def open_table(plan: Plan) -> Table | None:
    """One row per place that several tools leave open, the largest first, with what would close it; None where nothing
    is worth a row, there is one tool, or the plan was stopped.

    Parameters
    ----------
    plan : Plan
    """
    found = list_open_places(plan) if len(plan.tools) > 1 and plan.outcome != "cancelled" else ()
    if not found:
        return None
    smallest = min(tool.corner_radius for tool in plan.tools)
    rows = [[one.label, number(one.area, 2), number(one.unreachable, 2), " ".join(f"{x:.1f}" for x in one.point + 0.0),
             number(one.radius if isfinite(one.radius) else None, 2), what_closes(one, smallest)]
            for one in found[:_OPEN_ROWS]]
    rest = found[_OPEN_ROWS:]
    caption = f"and {len(rest)} more, {sum(one.area for one in rest):.2f} mm2 together" if rest else ""
    places = "1 place stays" if len(found) == 1 else f"{len(found)} places stay"
    title = f"{places} open, {sum(one.area for one in found):.2f} mm2"
    if plan.blades is not None and plan.blades.copies:
        title += "; those of the turned blades are not listed"
    return table(title, _OPEN_COLUMNS, rows, caption)


def _titled(plan: Plan) -> str:
    """The tools of a plan, for the title of a table."""
    return plan.named_tools if len(plan.used_tools) == 1 else f"{len(plan.used_tools)} tools"


def _of_part(plan: Plan) -> str:
    """How much of the faces several tools machine; empty where there is one tool."""
    if len(plan.tools) == 1:
        return ""
    found = plan.account
    share = 100 * found.machined / found.area if found.area > 0 else 0.0
    proven = f"proven out of reach: {found.unreachable:.1f} mm2; " if found.unreachable >= 0.05 else ""
    return (f"machined: {found.machined:.1f} of {found.area:.1f} mm2 ({share:.1f} %) with {len(plan.used_tools)} of "
            f"{len(plan.tools)} tools; {proven}open: {found.open:.1f} mm2")


def _over_ideal(operations: Sequence[Operation]) -> str:
    """By how many percent cuts are longer than the ideal ones with the same axes; a dash where these are not known."""
    ideal = sum(op.orientation.ideal_of_cut for op in operations)
    known = all(op.orientation.ideal > 0 for op in operations) and ideal > 0
    return number(100 * (sum(op.orientation.length for op in operations) / ideal - 1), 1) if known else "-"


def _ideal(plan: Plan) -> str:
    """What the ideal lengths of a plan come to; empty where one is not known."""
    done = [op for op in plan.operations if op.done]
    over = _over_ideal(done)
    if over == "-":
        return ""
    length = sum(op.orientation.ideal_of_cut for op in done)
    return (f"ideal: {length:.1f} mm with these axes, to which passes tend as the scallop height goes to zero (no "
            f"bound); the cuts are {over} % longer, run-outs included")


def _order(plan: Plan) -> str:
    """What the order of operations saves."""
    if plan.order is None:
        return ""
    now, listed, least = plan.order.seconds, plan.order.listed, plan.order.bound
    saved = f"{listed - now:.1f} s less than as planned" if isfinite(listed) else (
        "as planned the machine would collide")
    proven = "no order takes less" if now <= least * (1 + 1e-9) else f"no order takes less than {least:.1f} s"
    return f"order: {now:.1f} s between operations, {saved}; {proven}"


def _angles(plan: Plan, op: Operation) -> str:
    """Angles of the rotary axes, the solution with the least turns."""
    rows = rotary_of(plan.machine, op, op.tool.gauge_length)
    return " / ".join(f"{angle:.3f}" for angle in np.degrees(rows[0]) + 0.0) if len(rows) else "-"


def _clean_up(op: Operation) -> str:
    """Share of the area that is left as rest material."""
    return number(100 * op.orientation.unreached, 1) if op.done or op.left else "-"


def _links(op: Operation, inputs: PlanInputs) -> list[str]:
    if not op.done:
        return ["-", "-"]
    return [number(op.orientation.length + op.travel, 1), clock(op.seconds(inputs.feedrate, inputs.rapid))]


def reckoning(plan: Plan) -> str:
    """What times are reckoned with, as a sentence.

    Parameters
    ----------
    plan : Plan
    """
    inputs = plan.inputs
    if plan.timed and plan.machine is not None:
        placed = "" if "travel of the machine's linear axes" not in plan.not_checked else (
            " without retracts, since offset and tool length are needed for them")
        return (f"time: {plan.machine.machine.name} within velocity, acceleration and jerk of its axes, "
                f"{inputs.feedrate:g} mm/min in the cut and on its ramps; index moves{placed}")
    machine = None if plan.machine is None else plan.machine.machine
    why = f" ({machine.name} does not state {machine.unstated})" if machine is not None and machine.unstated else ""
    return (f"time: {inputs.feedrate:g} mm/min in the cut and on its ramps, {inputs.rapid:g} mm/min between, without "
            f"accelerations{why}; {INDEX_SECONDS:g} s for each change of axis")


def batch_table(records: Sequence[Mapping[str, Any]]) -> Table:
    """One row per job of a batch: outcome, operations, axes, passes, lengths and machining time.

    Parameters
    ----------
    records : sequence of mappings
        Of `toolaxis.batch.summary.JobRow`.
    """
    rows = []
    for one in records:
        figures = ["-"] * 6 if one["operations"] is None else [
            str(one["operations"]), str(one["orientations"]), str(one["passes"]), number(one["length"], 1),
            number(one["travel"], 1), clock(one["seconds"])]
        outcome = " ".join(filter(None, (one["outcome"], one["cause"], one["verdict"] and f"verdict {one['verdict']}")))
        rows.append([one["job"], outcome, *figures])
    columns = (("job", "left"), ("outcome", "left"), ("operations", "right"), ("axes", "right"), ("passes", "right"),
               ("cutting\nlength mm", "right"), ("links mm", "right"), ("time", "right"))
    return table("jobs", columns, rows)


def baselines_table(plan: Plan) -> Table:
    """One row per method: tool, sub-surfaces, axes, passes, lengths and time, as [zhu2016] Table 4.

    Parameters
    ----------
    plan : Plan
        With baselines.
    """
    first = plan.baselines[0]
    rows = [_baseline_row(one, first) for one in plan.baselines]
    columns: tuple[Column, ...] = (
        ("method", "left"), ("tool", "left"), ("sub-surfaces\nmachined", "right"), ("different\naxes", "right"),
        ("passes", "right"), ("cutting\nlength mm", "right"), ("to this\nplan's", "right"), ("with links\nmm", "right"),
        ("time\nmin:s", "right"))
    notes = [f"{one.shown}: {one.reason}" for one in plan.baselines if one.reason]
    what = "the same faces" if plan.blades is None else "the machined sub-surfaces of the first blade"
    return table(f"{what} by other methods, each with the same proofs", columns, rows,
                 "\n".join([reckoning(plan), *notes]))


def _baseline_row(one: Baseline, first: Baseline) -> list[str]:
    ratio = f"{one.length / first.length:.3f}" if one.complete and first.complete and first.length > 0 else "-"
    shown = [one.shown, one.tool, f"{one.machined} of {one.sub_surfaces}"]
    if not one.machined:
        return [*shown, *["-"] * 6]
    return [*shown, str(one.orientations), str(one.passes), number(one.length, 1), ratio,
            number(one.length + one.travel, 1), clock(one.seconds)]


def options_table(options: Sequence[Option]) -> Table:
    """One row per number of different axes: sub-surfaces, cutting length, and what it saves over one axis.

    Where the plan goes by time there is a column of times, and what is saved is time.

    Parameters
    ----------
    options : sequence of Option
    """
    costs = [one.seconds or one.length for one in options]
    timed = all(one.seconds is not None for one in options)
    rows = [[str(one.orientations), str(one.sub_surfaces), number(one.length, 1),
             *([clock(cost)] if timed else []), f"{100 * (1 - cost / costs[0]):.1f}", "chosen" if one.chosen else ""]
            for one, cost in zip(options, costs, strict=True)]
    columns: tuple[Column, ...] = (("different\naxes", "right"), ("sub-\nsurfaces", "right"),
                                   ("reckoned\nlength mm", "right"),
                                   *([("reckoned\ntime", "right")] if timed else []),
                                   ("less than\nthe first %", "right"), ("", "left"))
    return table("cutting, links and rest material against the number of orientations", columns, rows)


def _measured(found: Mapping[str, Clearance | str]) -> str:
    def _one(name: str) -> str:
        room = found.get(name)
        return number(room.distance, 2) if isinstance(room, Clearance) else "-"

    return " / ".join(_one(name) for name in ("cutter", "shank", "holder"))


def _verdict_row(op: Operation, inputs: PlanInputs, found: OperationVerdict | None) -> list[str]:
    row = _operation_row(op, inputs)
    if found is None:
        return [*row, "-", "-", "-", "NOT VERIFIED" if op.done else "NO AXIS"]
    if not found.measured:
        return [*row, "-", "-", "-", "FAIL"]
    row[6:8] = [number(found.gouge_max, 4), _measured(found.clearance)]
    return [*row, f"{100 * found.declared / found.area:.1f}", number(found.scallop_max, 4),
            f"{100 * found.share_within:.2f}", "pass" if found.passed else "FAIL"]


def verdict_table(plan: Plan, verdict: Verdict) -> Table:
    """One row per sub-surface: what was planned, and gouge, clearance and scallop as material removal measured them.

    Parameters
    ----------
    plan : Plan
    verdict : Verdict
    """
    judged = {op.name: op for op in verdict.operations}
    rows = [_verdict_row(op, plan.inputs, judged.get(op.name)) for op in plan.operations]
    for row, op in zip(rows, plan.operations, strict=True):
        if not op.done and outcome_of([op], plan.blades) == "complete":
            row[-1] = "rest material"
    columns = [*_COLUMNS, ("clean-\nup %", "right"), ("scallop\nleft mm", "right"), ("% within\n1.02 limit", "right"),
               ("verdict", "left")]
    aside = any(op.declared > 0 for op in verdict.operations)
    return table(f"{_titled(plan)}, scallop limit {plan.inputs.scallop:g} mm, machining tolerance "
                 f"{plan.inputs.tolerance.gouge:g} mm, measured by material removal", columns, rows,
                 "scallop left and % within: of the area without rest material" if aside else "")
