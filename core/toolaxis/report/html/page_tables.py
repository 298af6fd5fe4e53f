"""The tables of a page: orientations, operations, verdict, clean-up, settings and files, as rows of text."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import rich.table
from numpy.typing import NDArray

from toolaxis.machine.kinematics import placement
from toolaxis.plan.machine_document import rotary_of
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.report.tables import number
from toolaxis.shape.half_space import HELD_SIDE

Array = NDArray[np.float64]
Seconds = Mapping[str, float]


@dataclass(frozen=True)
class Rows:
    """A table.

    Attributes
    ----------
    caption : str
    headings : tuple of str
    rows : tuple of tuple of str
    right : tuple of bool
        Which columns are numbers.
    notes : tuple of str
        Stand below.
    """

    caption: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    right: tuple[bool, ...]
    notes: tuple[str, ...] = ()


def rows_of(made: rich.table.Table) -> Rows:
    """The table that the terminal shows, for the page.

    Parameters
    ----------
    made : rich.table.Table
    """
    title = str(made.title or "")
    headings = tuple(str(column.header).replace("-\n", "-").replace("\n", " ") for column in made.columns)
    columns = [[str(cell) for cell in column.cells] for column in made.columns]
    rows = tuple(zip(*columns, strict=True))
    to_the_right = tuple(column.justify == "right" for column in made.columns)
    notes = tuple(str(made.caption).splitlines()) if made.caption else ()
    return Rows(title, headings, rows, to_the_right, notes)


def _numbers(caption: str, headings: Sequence[tuple[str, bool]], rows: Sequence[Sequence[str]],
             notes: Sequence[str] = ()) -> Rows:
    return Rows(caption, tuple(name for name, _ in headings), tuple(map(tuple, rows)),
                tuple(right for _, right in headings), tuple(notes))


def _vector(values: Any, digits: int) -> str:
    return " ".join(f"{value:+.{digits}f}" for value in np.asarray(values, dtype=float) + 0.0)


def orientation_rows(plan: Plan) -> Rows:
    """Work coordinate system and machine angles of each different orientation, with its operations.

    Parameters
    ----------
    plan : Plan
    """
    groups: dict[tuple[Any, ...], list[Operation]] = {}
    for op in plan.operations:
        if op.done and op.frame is not None:
            key = (*np.round(op.frame.z, 9).tolist(), *np.round(op.rotary, 9).tolist(), op.orientation.lead)
            groups.setdefault(key, []).append(op)
    rows = [[str(k), ", ".join(op.name for op in group), *_setup(plan, group[0])]
            for k, group in enumerate(groups.values(), 1)]
    headings = [("no.", True), ("operations", False), ("Z: tool axis", False), ("X", False), ("origin mm", False),
                (f"{_names(plan)} °", False), ("other solutions °", False)]
    notes = ["Z points from the tip to the spindle; all in the part's frame. The origin is the plan's datum."]
    if plan.machine is None:
        notes.append("Machine angles: no machine was given.")
    elif any(group[0].orientation.lead is not None for group in groups.values()):
        notes.append("Where the axis moves, so do the machine's angles: toolaxis post writes how far.")
    if any(len(group) > 1 for group in groups.values()):
        notes.append("X is that of the first operation; each has its own in plan.json.")
    return _numbers("orientations and work coordinate systems", headings, rows, notes)


def _names(plan: Plan) -> str:
    return "machine" if plan.machine is None else " / ".join(axis.name for axis in plan.machine.machine.rotary)


def _setup(plan: Plan, op: Operation) -> list[str]:
    frame = op.frame
    assert frame is not None
    angles = [" / ".join(f"{angle:.3f}" for angle in np.degrees(row) + 0.0)
              for row in rotary_of(plan.machine, op, op.tool.gauge_length)]
    axis = _vector(frame.z, 6)
    if op.orientation.lead is not None:
        axis = f"moves, lead {np.degrees(op.orientation.lead):+.3f}°; mean {axis}"
    return [axis, _vector(frame.x, 6), _vector(frame.origin, 4), angles[0] if angles else "-",
            "; ".join(angles[1:]) or "-"]


def verdict_rows(plan: Plan, verdict: Mapping[str, Any]) -> Rows:
    """What material removal measured, one row per operation.

    Parameters
    ----------
    plan : Plan
    verdict : mapping
        The document of verdict.json.
    """
    rows = []
    for op in verdict["operations"]:
        room = [number(value, 2) if not isinstance(value := op["clearance"].get(name), str) else "-"
                for name in ("cutter", "shank", "holder")]
        rows.append([op["name"], number(op["declared"], 2), number(op["scallop_max"], 4),
                     f"{100 * op['share_within']:.2f}",
                     number(op["gouge_max"], 4), " / ".join(room), str(len(op["zones"])), str(op["rays"]),
                     "pass" if op["passed"] else "FAIL"])
    allowed, stock = plan.inputs.tolerance, plan.inputs.stock
    shanks = sorted({allowed.for_cutter(tool.radius).shank_clearance for tool in plan.used_tools})
    shank = f"{shanks[0]:g}" if len(shanks) == 1 else f"{shanks[0]:g} to {shanks[-1]:g}"
    besides = f", those of shank, holder and rapid moves from {stock:g} mm of stock" if stock > 0 else ""
    headings = [("operation", False), ("left to clean-up mm²", True), ("scallop left mm", True),
                ("% of the rest within 1.02 limit", True), ("gouge mm", True),
                ("clearance mm cutter/shank/holder", True), ("zones above", True), ("rays", True), ("verdict", False)]
    return _numbers("verdict, measured by material removal", headings, rows, [
        f"Allowed: scallop {plan.inputs.scallop:g} mm, gouge {allowed.gouge:g} mm, clearances "
        f"{allowed.cutter_clearance:g} / {shank} / {allowed.holder_clearance:g} mm{besides}. "
        "-: not checked."])


def time_rows(operations: Sequence[Operation], seconds: Sequence[Seconds], notes: Sequence[str]) -> Rows:
    """Where the time goes, one row per operation and their sum.

    Parameters
    ----------
    operations : sequence of Operation
    seconds : sequence of mappings
        One per operation: s by kind of motion.
    notes : sequence of str
    """
    kinds = ("cut", "entry and exit", "link", "index")
    rows = [[op.name, *(f"{one[kind]:.1f}" for kind in kinds), f"{sum(one[kind] for kind in kinds):.1f}"]
            for op, one in zip(operations, seconds, strict=True)]
    total = [sum(one[kind] for one in seconds) for kind in kinds]
    rows.append(["all", *(f"{value:.1f}" for value in total), f"{sum(total):.1f}"])
    return _numbers("time, s", [("operation", False), *((kind, True) for kind in kinds), ("sum", True)], rows, notes)


def zone_rows(plan: Plan) -> Rows:
    """Clean-up zones, the largest first; turned copies have those of their original.

    Parameters
    ----------
    plan : Plan
    """
    copies = {} if plan.blades is None else plan.blades.copies
    rows = []
    for op in plan.operations:
        if op.number in copies:
            continue
        for k, zone in enumerate(op.zones, 1):
            box = op.face.evaluate(zone.loops[0]).point
            beside = f"beside face {', '.join(zone.avoided)}, to be avoided" if zone.avoided else ""
            if HELD_SIDE in zone.avoided:
                beside = f"beside the {HELD_SIDE}"
            why = "the whole sub-surface" if op.left else beside or (
                "at a wall, an obstacle or in a corner" if zone.at_wall else "undercut at the border")
            rows.append([op.name, str(k), f"{zone.area:.2f}", f"{zone.elsewhere:.2f}", why,
                         _vector(box.min(axis=0), 2), _vector(box.max(axis=0), 2)])
    headings = [("operation", False), ("zone", True), ("area mm²", True), ("machined elsewhere mm²", True),
                ("why", False), ("from mm", False), ("to mm", False)]
    return _numbers("clean-up zones", headings, rows)


def setting_rows(plan: Plan, source: str) -> Rows:
    """Everything that was asked for, and the tool and machine it was asked of.

    Parameters
    ----------
    plan : Plan
    source : str
        Where the part came from.
    """
    given = {**asdict(plan.inputs), "avoid": ", ".join(map(str, plan.inputs.avoid)),
             "allowance_on": "" if plan.part.allowances is None else plan.part.allowances.described}
    tolerance = given.pop("tolerance") | {"chord": plan.inputs.chord}
    units = {**dict.fromkeys(("scallop", "allowance", "stock", "greatest_step_over", "lead"), "mm"),
             "feedrate": "mm/min", "rapid": "mm/min", "spindle": "rev/min"}
    rows = [[name, f"{value:g} {units.get(name, '')}".strip() if isinstance(value, float) else str(value) or "-"]
            for name, value in given.items()]
    names = {"gouge": "machining tolerance"}
    rows += [[names.get(name, f"tolerance {name.replace('_', ' ')}"), _tolerance(name, value)]
             for name, value in tolerance.items()]
    for tool in plan.used_tools:
        rows += [["tool", tool.title or tool.name], ["tool kind", tool.kind],
                 ["cutter radius", f"{tool.radius:g} mm"], ["corner radius", f"{tool.corner_radius:g} mm"],
                 ["half angle", f"{np.degrees(tool.half_angle):g}°"], ["cutting edge", f"{tool.flute_length:g} mm"],
                 ["stick-out", "not given" if tool.stickout is None else f"{tool.stickout:g} mm"],
                 ["shank (radius, z)", _outline(tool.shank)], ["holder (radius, z)", _outline(tool.holder)]]
    rows += [["part", source or "given as faces"], ["datum", f"{_vector(plan.datum, 4)} mm"],
             ["unit of the part's file", plan.part.unit or "mm"],
             ["faces of the part", str(len((plan.part.original or plan.part).faces))],
             ["obstacles", f"{len(plan.obstacles)} bodies" if plan.obstacles else "none"]]
    if plan.machine is None:
        rows.append(["machine", "none"])
    else:
        place = plan.machine.table_from_part
        rows += [["machine", plan.machine.machine.name], ["machine kind", plan.machine.machine.kind],
                 ["table from part", "not given" if place is None else
                  "; ".join(_vector(row, 6) for row in placement(place)[:3])]]
    return _numbers("settings", [("setting", False), ("value", False)], rows)


def _tolerance(name: str, value: float) -> str:
    if name in ("min_lead", "least_lean"):
        return f"{np.degrees(value):g}°"
    return f"{value:g}" + ("" if name == "trim" else " mm")


def _outline(rows: Array | None) -> str:
    return "not given" if rows is None else "; ".join(f"{r:g}, {z:g}" for r, z in rows)


def file_rows(files: Sequence[tuple[str, int, str]]) -> Rows:
    """Files of the plan's folder.

    Parameters
    ----------
    files : sequence of (name, size in bytes, SHA-256)
    """
    return _numbers("files", [("file", False), ("bytes", True), ("SHA-256", False)],
                    [[name, str(size), digest] for name, size, digest in files])
