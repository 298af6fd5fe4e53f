"""The setup sheet: what the operator must know before the program starts, as Markdown."""

from collections.abc import Sequence
from math import degrees

import numpy as np
from numpy.typing import NDArray

from toolaxis.machine.kinematics import linear_coordinates, placement
from toolaxis.plan.choices import FIELD, ISO, PLANES
from toolaxis.plan.plan import Plan
from toolaxis.post.context import Program, ProgramContext
from toolaxis.post.indexed_positions import IndexedPosition
from toolaxis.post.program import Dialect, number
from toolaxis.post.tcp_program import TcpPath, TipControl, courses
from toolaxis.shape.stock import format_faces
from toolaxis.shape.work_origin import describe_origin

Array = NDArray[np.float64]

_PATTERNS = {PLANES: "along parallel planes that contain the tool axis",
             FIELD: "along the levels of a field, as far apart as their strips are wide"}


def sheet_text(program: Program, dialect: Dialect, file: str, verdict: str = "not verified yet") -> str:
    """The setup sheet of a program.

    Parameters
    ----------
    program : Program
        From `program_of` with the same dialect.
    dialect : Dialect
    file : str
        Name of the program's file.
    verdict : str
        What `toolaxis verify` said of the plan.

    Returns
    -------
    str
        Markdown; lengths in mm, angles in degrees.
    """
    plan = program.plan
    tools = "## Tools" if len(plan.used_tools) > 1 else "## Tool"
    parts = [f"# Setup sheet: {program.name}", _general(program, dialect, file, verdict), tools, _tools(plan),
             "## Work coordinate system", _work(program, dialect),
             "## Orientations", _orientations(program, dialect), "## Operations", _operations(program, dialect),
             "## What to mind", "\n".join(f"- {note}" for note in _notes(program, dialect)), ""]
    return "\n\n".join(parts)


def moving_sheet_text(program: Program, control: TipControl, file: str, verdict: str = "not verified yet") -> str:
    """The setup sheet of a program whose axis moves.

    Parameters
    ----------
    program : Program
        From `toolaxis.post.program.bare_program` with the control's dialect.
    control : TipControl
    file : str
        Name of the program's file.
    verdict : str
        What `toolaxis verify` said of the plan.

    Returns
    -------
    str
        Markdown; lengths in mm, angles in degrees.
    """
    dialect, notes = control.dialect, [*control.notes, f"Points are rounded to {0.5 * 10 ** -control.dialect.digits:g} "
                                       "mm in each coordinate."]
    notes += _start(program, dialect, courses(program.plan, program.mounting)[0].along.rotary[0])
    if program.machine.assumed:
        notes.append(f"Assumed in the machine's file: {', '.join(program.machine.assumed)}.")
    general = _general(program, dialect, file, verdict).replace(dialect.title, control.title)
    parts = [f"# Setup sheet: {program.name}", general, "## Tool", _tools(program.plan), "## Work coordinate system",
             _work(program, dialect), "## Operations", _courses(program), "## What to mind",
             "\n".join(f"- {note}" for note in notes), ""]
    return "\n\n".join(parts)


def course_sheet_text(program: ProgramContext, control: TipControl, course: TcpPath, file: str) -> str:
    """The setup sheet of a program made of CL data.

    Parameters
    ----------
    program : ProgramContext
    control : TipControl
    course : TcpPath
    file : str
        Name of the program's file.

    Returns
    -------
    str
        Markdown; lengths in mm, angles in degrees.
    """
    machine, turned = program.machine, np.degrees(course.along.rotary)
    general = _table(["", ""], [
        ["program", file], ["control", control.title], ["machine", f"{machine.name} ({machine.chain})"],
        ["work offset", "the origin of the CL data"], ["rev/min", f"{program.inputs.spindle:.0f}"],
        ["points", f"{len(course.tips)}, of them {len(course.tips) - len(course.path.cl)} put between"],
        ["first point", _vector(course.tips[0], 3)]])
    rows = [[axis.name, f"{low:.3f}", f"{high:.3f}"] for axis, low, high in
            zip(machine.rotary, turned.min(axis=0), turned.max(axis=0), strict=True)]
    notes = [*control.notes, f"Points are rounded to {0.5 * 10 ** -control.dialect.digits:g} mm in each coordinate.",
             "The CL data were made elsewhere: nothing was checked but that the machine's axes can follow."]
    ranges, mind = _table(["axis", "from", "to"], rows), "\n".join(f"- {note}" for note in notes)
    parts = [f"# Setup sheet: {program.name}", general, "## Rotary axes", ranges, "## What to mind", mind, ""]
    return "\n\n".join(parts)


def _courses(program: Program) -> str:
    inputs, rows = program.inputs, []
    done = [op for op in program.plan.operations if op.path is not None]
    for op, course in zip(done, courses(program.plan, program.mounting), strict=True):
        turned = np.degrees(course.along.rotary)
        ranges = ["; ".join(f"{axis.name} {low:.3f} to {high:.3f}" for axis, low, high in
                            zip(program.machine.rotary, turned.min(axis=0), turned.max(axis=0), strict=True))]
        lead = "-" if op.orientation.lead is None else number(degrees(op.orientation.lead), 3)
        rows.append([op.name, lead, *ranges, str(op.path.passes if op.path else 0), _vector(course.tips[0], 3),
                     f"{op.seconds(inputs.feedrate, inputs.rapid) / 60:.1f}"])
    return _table(["operation", "lead", "rotary axes", "passes", "first point", "min"], rows)


def _table(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [headings, ["---"] * len(headings), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def _general(program: Program, dialect: Dialect, file: str, verdict: str) -> str:
    missing = [op.name for op in program.plan.operations if op.path is None]
    machine = program.machine
    rows = [["program", file], ["control", dialect.title], ["machine", f"{machine.name} ({machine.chain})"],
            ["part", program.plan.part.source or "-"], ["scallop height", f"{program.inputs.scallop:g} mm"],
            ["machining tolerance", f"{program.inputs.tolerance.gouge:g} mm"], ["verdict on the operations", verdict],
            ["not checked", ", ".join(program.plan.not_checked)]]
    stock = program.plan.part.stock
    if stock is not None:
        rows.insert(4, ["stock left by roughing", f"at most {stock.height:g} mm above {format_faces(stock.faces)}, "
                        "none on all other faces: measure before the start"])
    if program.plan.part.allowances is not None:
        rows.insert(4, ["allowance", program.plan.part.allowances.described])
    if program.inputs.lead > 0:
        rows.insert(4, ["lead-in and lead-out", f"arcs of {program.inputs.lead:g} mm, straight where not proven free"])
    lean = program.inputs.tolerance.least_lean
    if lean > 0:
        rows.insert(4, ["least lean of ball ends", f"{degrees(lean):g} deg from the normal at every contact"])
    if program.inputs.greatest_step_over > 0:
        rows.insert(4, ["greatest step-over", f"{program.inputs.greatest_step_over:g} mm"])
    patterns = {op.orientation.pattern for op in program.plan.operations if op.done} - {ISO}
    if patterns:
        rows.insert(4, ["passes", ", ".join(_PATTERNS[name] for name in sorted(patterns))])
    if missing:
        rows.append(["NOT IN THE PROGRAM", f"no axis was found for {', '.join(missing)}"])
    return _table(["", ""], rows)


def _tools(plan: Plan) -> str:
    rows = []
    for tool in plan.used_tools:
        inputs = plan.inputs.at_rates_of(tool)
        stickout = "not given" if tool.stickout is None else f"{tool.stickout:.3f}"
        rows.append([f"T{tool.number or 1}", tool.title or tool.name, f"{2 * tool.radius:.3f}",
                     f"{tool.corner_radius:.3f}", f"{tool.flute_length:.3f}", stickout,
                     "yes" if "holder" in tool.outlines else "not given", f"{inputs.spindle:.0f}",
                     f"{inputs.feedrate:.0f}"])
    return _table(["tool", "name", "diameter", "corner radius", "cutting edge", "stick-out", "holder", "rev/min",
                   "mm/min"], rows) + "\n\nThe tool length is measured to the tip, the lowest point on the axis."


def _vector(values: Array, digits: int) -> str:
    return ", ".join(number(value, digits) for value in values)


def _work(program: Program, dialect: Dialect) -> str:
    where = program.mounting.table_from_part
    turn = placement(where)[:3, :3]
    what = describe_origin(program.inputs.origin) or "the datum of the plan"
    lines = [f"Origin: {what}, at {_vector(program.plan.datum, 4)} in the part's frame.", *_blank_lines(program.plan),
             f"X, Y, Z along the machine's axes with all rotary axes at zero: {_vector(turn[0], 6)}; "
             f"{_vector(turn[1], 6)}; {_vector(turn[2], 6)} in the part's frame."]
    if where is None:
        lines.append("Where the part stands on the table was not given: travel was not checked.")
    elif len(dialect.offsets) == 1:
        datum = (placement(where) @ np.append(program.plan.datum, 1.0))[:3]
        lines.append(f"The datum lies at {_vector(datum, 4)} in machine coordinates.")
    return "\n\n".join(lines)


def _blank_lines(plan: Plan) -> list[str]:
    """The box that the part is cut from, in the part's frame and from the origin."""
    blank = plan.blank
    if blank is None:
        return []
    ranges = [f"{axis} {number(low, 4)} to {number(high, 4)}" for axis, low, high in
              zip("XYZ", blank.low - plan.datum, blank.high - plan.datum, strict=True)]
    return [f"Stock: {' x '.join(number(length, 3) for length in blank.size)} mm along the part's axes; from the "
            f"origin {', '.join(ranges)}."]


def _angles(program: Program, dialect: Dialect, angles: Array) -> str:
    return " ".join(dialect.words(program.machine, angles)) or "-"


def _orientations(program: Program, dialect: Dialect) -> str:
    rows = []
    for number_of in sorted({station.orientation for station in program.stations}):
        station = next(one for one in program.stations if one.orientation == number_of)
        others = [_angles(program, dialect, row) + ("" if ok else " (out of range)")
                  for row, ok in zip(station.others, station.reachable, strict=True)]
        offset = dialect.offsets[number_of if len(dialect.offsets) > 1 else 0]
        rows.append([str(number_of + 1), offset, _angles(program, dialect, station.angles), "; ".join(others) or "none",
                     _plane(dialect, station), _vector(station.matrix[:, 0], 6), _vector(station.matrix[:, 2], 6),
                     _origin(program, station)])
    return _table(["no.", "offset", "axes", "other solution", "plane", "plane's X", "plane's Z",
                   "datum in the machine"], rows)


def _plane(dialect: Dialect, station: IndexedPosition) -> str:
    if not station.written:
        return "-"
    return ", ".join(f"{name} {number(angle, dialect.angle_digits)}"
                     for name, angle in zip(dialect.turns, station.written, strict=True))


def _origin(program: Program, station: IndexedPosition) -> str:
    """Linear coordinates with the spindle's gauge point at the datum."""
    where = program.mounting.table_from_part
    if where is None or station.tilt:
        return "not known"
    at = linear_coordinates(program.machine, program.plan.datum, station.angles, 0.0, where)
    return _vector(at[0], 4)


def _operations(program: Program, dialect: Dialect) -> str:
    inputs, rows = program.inputs, []
    for station in program.stations:
        op, seconds = station.operation, station.operation.seconds(program.inputs.feedrate, inputs.rapid)
        offset = dialect.offsets[station.orientation if len(dialect.offsets) > 1 else 0]
        rows.append([op.name, f"T{op.tool.number or 1}", str(station.orientation + 1), offset,
                     str(op.path.passes if op.path else 0), _vector(station.tips[0], 3),
                     number(float(station.tips[:, 2].min()), 3), f"{gouge_of(program, dialect, station):.4f}",
                     f"{seconds / 60:.1f}"])
    return _table(["operation", "tool", "orientation", "offset", "passes", "first point in the plane", "lowest Z",
                   "gouge at most", "min"], rows)


def gouge_of(program: Program, dialect: Dialect, station: IndexedPosition) -> float:
    """Upper bound of the gouge of an operation with the digits and the angles that were written, mm.

    Parameters
    ----------
    program : Program
    dialect : Dialect
    station : IndexedPosition

    Returns
    -------
    float
        The plan's bound, more by what rounding moves a tip and by what leaning moves the cutter about it.
    """
    rounding = 0.5 * 3 ** 0.5 * 10.0 ** -dialect.digits
    return station.operation.orientation.gouge + rounding + 2 * station.operation.tool.radius * station.lean


def _start(program: Program, dialect: Dialect, angles: Array) -> list[str]:
    """What nobody knows: where the axes stand before the program."""
    if not len(angles):
        return []
    return [f"Where the axes stand before the start is not known: bring the rotary axes to "
            f"{_angles(program, dialect, angles)} with the spindle retracted and clear of everything. The turn to "
            "there and the way over to the first point were not looked at."]


def _notes(program: Program, dialect: Dialect) -> list[str]:
    notes, allowed = dialect.sheet_notes(program), program.inputs.tolerance.gouge
    over = [station.operation.name for station in program.stations if gouge_of(program, dialect, station) > allowed]
    if over:
        notes.append(f"With the digits of this dialect the bound of the gouge exceeds {allowed:g} mm in "
                     f"{', '.join(over)}: plan with a smaller machining tolerance, or use a dialect with more digits.")
    if program.retract is not None and dialect.told_retract:
        notes.append(f"Rotary axes turn with Z at {program.retract:.3f} in machine coordinates: compare with the "
                     "machine's own travel.")
    top = program.machine.linear[2].high
    if program.mounting.judges_index_moves and program.retract is not None and program.retract < top:
        notes.append(f"Index moves were held apart from the machine's bodies with Z at {top:.3f}, not at "
                     f"{program.retract:.3f}.")
    if any(station.tilt for station in program.stations):
        notes.append("The spindle is tilted: each operation begins with one straight motion from the retracted place "
                     "to its first point. Whether that is free of fixtures is not checked.")
    if program.machine.assumed:
        notes.append(f"Assumed in the machine's file: {', '.join(program.machine.assumed)}.")
    notes.append(f"Points are rounded to {0.5 * 10 ** -dialect.digits:g} mm in each coordinate.")
    return notes + (_start(program, dialect, program.stations[0].angles) if program.stations else [])
