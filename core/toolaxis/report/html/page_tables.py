"""The tables of a page: orientations, operations, verdict, rest material, settings and files, as rows of text."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np
import rich.table
from numpy.typing import NDArray

from toolaxis.machine.kinematics import placement
from toolaxis.machine.setup import Mounting
from toolaxis.plan.machine_document import rotary_of
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.plan.zone import Zone
from toolaxis.report.tables import number
from toolaxis.shape.half_space import CLAMPED_SIDE, HELD_SIDE
from toolaxis.tools.tool import Tool

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


class _Heading(NamedTuple):
    """The heading of a column, and whether it is one of numbers."""

    text: str
    is_number: bool


def _words(text: str) -> _Heading:
    return _Heading(text, False)


def _numbers(text: str) -> _Heading:
    return _Heading(text, True)


def _table(caption: str, headings: Sequence[_Heading], rows: Sequence[Sequence[str]],
           notes: Sequence[str] = ()) -> Rows:
    names = tuple(heading.text for heading in headings)
    to_the_right = tuple(heading.is_number for heading in headings)
    return Rows(caption, names, tuple(map(tuple, rows)), to_the_right, tuple(notes))


def _vector(values: Any, digits: int) -> str:
    without_minus_zero = np.asarray(values, dtype=float) + 0.0
    return " ".join(f"{value:+.{digits}f}" for value in without_minus_zero)


def orientation_rows(plan: Plan) -> Rows:
    """Work coordinate system and machine angles of each different orientation, with its operations.

    Parameters
    ----------
    plan : Plan
    """
    groups = _group_by_orientation(plan.operations)
    rows = []
    for k, group in enumerate(groups, 1):
        names = ", ".join(op.name for op in group)
        rows.append([str(k), names, *_setup(plan, group[0])])
    headings = [_numbers("no."), _words("operations"), _words("Z: tool axis"), _words("X"), _words("origin mm"),
                _words(f"{_rotary_names(plan)} °"), _words("other solutions °")]
    notes = ["Z points from the tip to the spindle; all in the part's frame. The origin is the plan's datum."]
    if plan.machine is None:
        notes.append("Machine angles: no machine was given.")
    elif any(group[0].orientation.lead is not None for group in groups):
        notes.append("Where the axis moves, so do the machine's angles: toolaxis post writes how far.")
    if any(len(group) > 1 for group in groups):
        notes.append("X is that of the first operation; each has its own in plan.json.")
    return _table("orientations and work coordinate systems", headings, rows, notes)


def _group_by_orientation(operations: Sequence[Operation]) -> list[list[Operation]]:
    """Operations with a work coordinate system, those together that have axis, machine angles and lead in common."""
    groups: dict[tuple[Any, ...], list[Operation]] = {}
    for op in operations:
        if op.done and op.frame is not None:
            axis = np.round(op.frame.z, 9).tolist()
            angles = np.round(op.rotary, 9).tolist()
            orientation = (*axis, *angles, op.orientation.lead)
            groups.setdefault(orientation, []).append(op)
    return list(groups.values())


def _rotary_names(plan: Plan) -> str:
    return "machine" if plan.machine is None else " / ".join(axis.name for axis in plan.machine.machine.rotary)


def _setup(plan: Plan, op: Operation) -> list[str]:
    """Axis, X, origin, machine angles and the other solutions, as texts."""
    frame = op.frame
    assert frame is not None
    solutions = [_angles(row) for row in rotary_of(plan.machine, op, op.tool.gauge_length)]
    first = solutions[0] if solutions else "-"
    others = "; ".join(solutions[1:]) or "-"
    axis = _vector(frame.z, 6)
    if op.orientation.lead is not None:
        axis = f"moves, lead {np.degrees(op.orientation.lead):+.3f}°; mean {axis}"
    return [axis, _vector(frame.x, 6), _vector(frame.origin, 4), first, others]


def _angles(row: Any) -> str:
    without_minus_zero = np.degrees(row) + 0.0
    return " / ".join(f"{angle:.3f}" for angle in without_minus_zero)


def verdict_rows(plan: Plan, verdict: Mapping[str, Any]) -> Rows:
    """What material removal measured, one row per operation.

    Parameters
    ----------
    plan : Plan
    verdict : mapping
        The document of verdict.json.
    """
    rows = [_verdict_row(op) for op in verdict["operations"]]
    headings = [_words("operation"), _numbers("rest material mm²"), _numbers("scallop left mm"),
                _numbers("% of the rest within 1.02 limit"), _numbers("gouge mm"),
                _numbers("clearance mm cutter/shank/holder"), _numbers("zones above"), _numbers("rays"),
                _words("verdict")]
    return _table("verdict, measured by material removal", headings, rows, [_allowed(plan)])


def _verdict_row(op: Mapping[str, Any]) -> list[str]:
    clearances = [_clearance(op["clearance"].get(name)) for name in ("cutter", "shank", "holder")]
    return [
        op["name"],
        number(op["declared"], 2),
        number(op["scallop_max"], 4),
        f"{100 * op['share_within']:.2f}",
        number(op["gouge_max"], 4),
        " / ".join(clearances),
        str(len(op["zones"])),
        str(op["rays"]),
        "pass" if op["passed"] else "FAIL",
    ]


def _clearance(value: float | str | None) -> str:
    """A distance; a text says why there is none."""
    return "-" if isinstance(value, str) else number(value, 2)


def _allowed(plan: Plan) -> str:
    """What the verdict is held against, as a sentence."""
    tolerance, stock = plan.inputs.tolerance, plan.inputs.stock
    shanks = sorted({tolerance.for_cutter(tool.radius).shank_clearance for tool in plan.used_tools})
    shank = f"{shanks[0]:g}" if len(shanks) == 1 else f"{shanks[0]:g} to {shanks[-1]:g}"
    clearances = f"{tolerance.cutter_clearance:g} / {shank} / {tolerance.holder_clearance:g} mm"
    besides = f", those of shank, holder and rapid moves from {stock:g} mm of stock" if stock > 0 else ""
    return (f"Allowed: scallop {plan.inputs.scallop:g} mm, gouge {tolerance.gouge:g} mm, "
            f"clearances {clearances}{besides}. -: not checked.")


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
    rows = []
    for op, by_kind in zip(operations, seconds, strict=True):
        rows.append(_time_row(op.name, [by_kind[kind] for kind in kinds]))
    of_all = [sum(by_kind[kind] for by_kind in seconds) for kind in kinds]
    rows.append(_time_row("all", of_all))
    headings = [_words("operation"), *(_numbers(kind) for kind in kinds), _numbers("sum")]
    return _table("time, s", headings, rows, notes)


def _time_row(name: str, seconds: Sequence[float]) -> list[str]:
    """A name, its times and their sum."""
    return [name, *(f"{value:.1f}" for value in seconds), f"{sum(seconds):.1f}"]


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
            border = op.face.evaluate(zone.loops[0]).point
            lowest = _vector(border.min(axis=0), 2)
            highest = _vector(border.max(axis=0), 2)
            why = "the whole sub-surface" if op.left else _reason(zone)
            rows.append([op.name, str(k), f"{zone.area:.2f}", f"{zone.elsewhere:.2f}", why, lowest, highest])
    headings = [_words("operation"), _numbers("zone"), _numbers("area mm²"), _numbers("machined elsewhere mm²"),
                _words("why"), _words("from mm"), _words("to mm")]
    return _table("rest material", headings, rows)


def _reason(zone: Zone) -> str:
    """Why a zone is left."""
    if HELD_SIDE in zone.avoided:
        return f"beside the {CLAMPED_SIDE}"
    if zone.avoided:
        return f"beside face {', '.join(zone.avoided)}, to be avoided"
    return "at a wall, an obstacle or in a corner" if zone.at_wall else "undercut at the border"


def setting_rows(plan: Plan, source: str) -> Rows:
    """Everything that was asked for, and the tool and machine it was asked of.

    Parameters
    ----------
    plan : Plan
    source : str
        Where the part came from.
    """
    rows = [*_input_rows(plan), *_tolerance_rows(plan)]
    for tool in plan.used_tools:
        rows += _tool_rows(tool)
    rows += [*_part_rows(plan, source), *_machine_rows(plan.machine)]
    return _table("settings", [_words("setting"), _words("value")], rows)


#: Units of what is asked for; what has none there is a text, a number of something or a share.
_UNITS = {"scallop": "mm", "allowance": "mm", "stock": "mm", "greatest_step_over": "mm", "lead": "mm",
          "feedrate": "mm/min", "rapid": "mm/min", "spindle": "rev/min"}


def _input_rows(plan: Plan) -> list[list[str]]:
    given = asdict(plan.inputs)
    given["avoid"] = ", ".join(map(str, plan.inputs.avoid))
    given["allowance_on"] = "" if plan.part.allowances is None else plan.part.allowances.described
    del given["tolerance"]  # these have rows of their own
    return [[name, _setting(name, value)] for name, value in given.items()]


def _setting(name: str, value: Any) -> str:
    if isinstance(value, float):
        return f"{value:g} {_UNITS.get(name, '')}".strip()
    return str(value) or "-"


def _tolerance_rows(plan: Plan) -> list[list[str]]:
    tolerances = {**asdict(plan.inputs.tolerance), "chord": plan.inputs.chord}
    rows = []
    for name, value in tolerances.items():
        shop_name = "machining tolerance" if name == "gouge" else f"tolerance {name.replace('_', ' ')}"
        rows.append([shop_name, _tolerance(name, value)])
    return rows


def _tool_rows(tool: Tool) -> list[list[str]]:
    return [
        ["tool", tool.title or tool.name],
        ["tool kind", tool.kind],
        ["cutter radius", f"{tool.radius:g} mm"],
        ["corner radius", f"{tool.corner_radius:g} mm"],
        ["half angle", f"{np.degrees(tool.half_angle):g}°"],
        ["cutting edge", f"{tool.flute_length:g} mm"],
        ["stick-out", "not given" if tool.stickout is None else f"{tool.stickout:g} mm"],
        ["shank (radius, z)", _outline(tool.shank)],
        ["holder (radius, z)", _outline(tool.holder)],
    ]


def _part_rows(plan: Plan, source: str) -> list[list[str]]:
    whole = plan.part.original or plan.part
    return [
        ["part", source or "given as faces"],
        ["datum", f"{_vector(plan.datum, 4)} mm"],
        ["unit of the part's file", plan.part.unit or "mm"],
        ["faces of the part", str(len(whole.faces))],
        ["obstacles", f"{len(plan.obstacles)} bodies" if plan.obstacles else "none"],
    ]


def _machine_rows(mounting: Mounting | None) -> list[list[str]]:
    if mounting is None:
        return [["machine", "none"]]
    given = mounting.table_from_part
    if given is None:
        table_from_part = "not given"
    else:
        table_from_part = "; ".join(_vector(row, 6) for row in placement(given)[:3])
    return [
        ["machine", mounting.machine.name],
        ["machine kind", mounting.machine.kind],
        ["table from part", table_from_part],
    ]


def _tolerance(name: str, value: float) -> str:
    if name in ("min_lead", "least_lean"):
        return f"{np.degrees(value):g}°"
    return f"{value:g}" if name == "trim" else f"{value:g} mm"


def _outline(rows: Array | None) -> str:
    return "not given" if rows is None else "; ".join(f"{r:g}, {z:g}" for r, z in rows)


def file_rows(files: Sequence[tuple[str, int, str]]) -> Rows:
    """Files of the plan's folder.

    Parameters
    ----------
    files : sequence of (name, size in bytes, SHA-256)
    """
    rows = [[name, str(size), digest] for name, size, digest in files]
    return _table("files", [_words("file"), _numbers("bytes"), _words("SHA-256")], rows)
