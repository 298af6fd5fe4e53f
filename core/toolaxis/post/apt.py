"""APT cutter location files, written one per operation; `toolaxis.post.read_apt` reads them back.

The words written are those of ISO 4343 that post-processors agree on: PARTNO, UNITS, MULTAX, CUTTER, LOADTL, SPINDL,
FEDRAT, RAPID, GOTO, PPRINT and FINI.  ``RAPID`` holds for the next GOTO only, ``FEDRAT`` until the next one.
``PPRINT`` lines name passes and motions for the reader of the file; what is cut and what is rapid stands in the
motion words themselves.
"""

from collections.abc import Iterator
from itertools import chain, islice
from math import degrees, inf, isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import PlanInputs
from toolaxis.post.cl_points import CutterLocations
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

COLUMNS = 72
#: Points, and lines, that are written at a time: a path may have millions.
_BLOCK = 10_000


def _wrap_statement(line: str) -> str:
    """Continue a statement on the next line with `$` so that none is longer than 72 columns."""
    lines = []
    while len(line) > COLUMNS:
        cut = line.rindex(",", 0, COLUMNS - 1) + 1
        lines.append(line[:cut] + "$")
        line = line[cut:]
    return "\n".join([*lines, line])


def _plain(text: str) -> str:
    """Text that can stand in a PPRINT or PARTNO line."""
    return "".join(c if c.isprintable() and c not in "$\n" and ord(c) < 128 else "_" for c in text)[: COLUMNS - 8]


def _number(value: float, digits: int) -> str:
    return f"{round(value, digits) + 0.0:.{digits}f}"


def cutter_statement(tool: Tool) -> str:
    """The seven-parameter CUTTER statement of a tool.

    Parameters
    ----------
    tool : Tool

    Returns
    -------
    str
        CUTTER/d,r,e,f,a,b,h: diameter, corner radius, corner centre from the axis and from the tip, angle of the
        bottom, angle of the side (degrees), length of the cutting edge.
    """
    profile = tool.profile
    sizes = (2 * tool.radius, profile.corner_radius, profile.flat_radius, profile.corner_radius, 0.0,
             degrees(profile.half_angle), profile.top)
    return "CUTTER/" + ",".join(f"{size:.6g}" for size in sizes)


def operation_text(op: Operation, inputs: PlanInputs) -> str:
    """The CL file of an operation, at its tool's feed and speed.

    Parameters
    ----------
    op : Operation
        With a path.
    inputs : PlanInputs
        The plan's.
    """
    assert op.path is not None
    own = inputs.at_rates_of(op.tool)
    return apt_text(op.path, op.tool, op.name, own.feedrate, own.spindle)


def apt_text(path: ToolPath, tool: Tool, name: str, feedrate: float, spindle: float) -> str:
    """A tool path as the text of an APT CL file.

    Parameters
    ----------
    path : ToolPath
    tool : Tool
    name : str
        Name of the operation.
    feedrate : float
        mm/min on cuts, entries and exits; links are rapid.
    spindle : float
        rev/min

    Returns
    -------
    str
        Lines of at most 72 columns; tips to 1e-6 mm, axes to 1e-9.
    """
    rates = np.full(len(path.cl), float(feedrate))
    rates[:1] = inf
    return _whole(name, cutter_statement(tool), spindle, _motions(path, rates, True))


def locations_text(found: CutterLocations, name: str, tool: Tool | None = None) -> str:
    """Cutter locations that were read as the text of an APT CL file, with the feed rate of each.

    Parameters
    ----------
    found : CutterLocations
    name : str
        Of the part, or the operation.
    tool : Tool, optional
        For the CUTTER statement, which is left out without one.

    Notes
    -----
    Property: `toolaxis.post.read_apt.read_apt` of the result is what was given: tips to 1e-6 mm, axes to 1e-9, feed
    rates to 6 digits.
    """
    cutter = "" if tool is None else cutter_statement(tool)
    return _whole(name, cutter, found.spindle, _motions(found.path, found.feedrate, False))


def _whole(name: str, cutter: str, spindle: float, motions: Iterator[str]) -> str:
    turning = [f"SPINDL/RPM,{spindle:g},CLW"] if spindle > 0 else []
    head = [f"PARTNO/{_plain(name)}", "UNITS/MM", "MULTAX/ON", *filter(None, [cutter]), "LOADTL/1", *turning]
    lines = map(_wrap_statement, chain(head, motions))
    joined = ["\n".join(block) for block in iter(lambda: list(islice(lines, _BLOCK)), [])]
    return "\n".join([*joined, *(["SPINDL/OFF"] if turning else []), "FINI", ""])


def _motions(path: ToolPath, rates: Array, from_above: bool) -> Iterator[str]:
    """Statements of all motions; from_above makes the first one rapid, whatever it is."""
    starts = set(path.breaks[:-1].tolist())
    passes = 0
    before = -1
    fed = inf
    for index, (tip, axis, kind, rate) in enumerate(_rows(path.cl, path.axis, path.kind, rates)):
        if index in starts:
            passes += 1
            yield f"PPRINT/PASS {passes}"
        if kind != before:
            yield f"PPRINT/{Motion(kind).name}"
            before = kind
        if kind == Motion.LINK or (from_above and index == 0):
            yield "RAPID"
        elif rate != fed and isfinite(rate):
            fed = rate
            yield f"FEDRAT/MMPM,{rate:g}"
        yield "GOTO/" + ",".join([*(_number(v, 6) for v in tip), *(_number(v, 9) for v in axis)])


def _rows(*columns: NDArray[Any]) -> Iterator[tuple[Any, ...]]:
    """Rows of arrays as plain numbers, some at a time: as objects they take ten times the room."""
    for first in range(0, len(columns[0]), _BLOCK):
        yield from zip(*(column[first:first + _BLOCK].tolist() for column in columns), strict=True)
