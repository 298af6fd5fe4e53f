"""APT cutter location files: written one per operation, and read back.

The words used are those of ISO 4343 that post-processors agree on: PARTNO, UNITS, MULTAX, CUTTER, LOADTL, SPINDL,
FEDRAT, RAPID, GOTO, PPRINT and FINI.  ``RAPID`` holds for the next GOTO only, ``FEDRAT`` until the next one.
``PPRINT`` lines name passes and motions for the reader of the file; what is cut and what is rapid stands in the
motion words themselves.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import degrees, isfinite

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.errors import InvalidInput
from toolaxis.tools.assembly import Tool

Array = NDArray[np.float64]

COLUMNS = 72
_IGNORED = {"PARTNO", "MACHIN", "CUTTER", "LOADTL", "SPINDL", "COOLNT", "TOOLNO", "TPRINT", "INTOL", "OUTTOL", "CLPRNT",
            "INSERT", "REMARK", "TLAXIS", "FROM"}
_MOTIONS = {motion.name: motion for motion in Motion}


@dataclass(frozen=True, eq=False)
class CutterLocations:
    """What a CL file says.

    Attributes
    ----------
    tip, axis : (n, 3) array
        Tool tips, mm, and unit axes, in the order in which they are visited.
    kind : (n,) array of int8
        `Motion` that arrives at each point: LINK where rapid, else as the file's PPRINT lines say, CUT without them.
    feedrate : (n,) array
        Feed rate that holds on the way to each point, mm/min; inf where rapid.
    breaks : (k + 1,) array of int
        Where each pass starts, by the file's PPRINT lines, and n at the end.
    """

    tip: Array
    axis: Array
    kind: NDArray[np.int8]
    feedrate: Array
    breaks: NDArray[np.int64]

    @property
    def path(self) -> ToolPath:
        """The same as a `ToolPath` without contacts: cc repeats the tips, the normal the axis."""
        return ToolPath(self.tip, self.tip, self.axis, self.axis, self.kind, self.breaks)


def _wrapped(line: str) -> str:
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
    lines = [f"PARTNO/{_plain(name)}", "UNITS/MM", "MULTAX/ON", cutter_statement(tool), "LOADTL/1",
             f"SPINDL/RPM,{spindle:g},CLW"]
    lines += _motions(path, feedrate)
    return "\n".join([*map(_wrapped, lines), "SPINDL/OFF", "FINI", ""])


def _motions(path: ToolPath, feedrate: float) -> Iterator[str]:
    starts = set(path.breaks[:-1].tolist())
    passes = 0
    before = -1
    fed = False
    for index, (tip, axis, kind) in enumerate(zip(path.cl.tolist(), path.axis.tolist(), path.kind.tolist(),
                                                  strict=True)):
        if index in starts:
            passes += 1
            yield f"PPRINT/PASS {passes}"
        if kind != before:
            yield f"PPRINT/{Motion(kind).name}"
            before = kind
        if kind == Motion.LINK or index == 0:
            yield "RAPID"
        elif not fed:
            fed = True
            yield f"FEDRAT/MMPM,{feedrate:g}"
        yield "GOTO/" + ",".join([*(_number(v, 6) for v in tip), *(_number(v, 9) for v in axis)])


def _statements(text: str) -> Iterator[tuple[int, str]]:
    """Statements with the number of the line on which each begins; comments dropped, continued lines joined."""
    held, start = "", 0
    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.split("$$")[0].strip()
        start = start if held else number
        if line.endswith("$"):
            held += line[:-1].rstrip()
            continue
        statement, held = held + line, ""
        if statement:
            yield start, statement
    if held:
        yield start, held


def _goto(number: int, arguments: str, multax: bool, last: Array | None) -> Array:
    try:
        row = np.array([float(part) for part in arguments.split(",")])
    except ValueError:
        raise InvalidInput(f"CL line {number}: GOTO/{arguments} has a word that is not a number") from None
    if len(row) == 3 and (not multax or last is not None):
        row = np.concatenate([row, [0.0, 0.0, 1.0] if last is None else last[3:]])
    if len(row) != 6 or not np.isfinite(row).all():
        raise InvalidInput(f"CL line {number}: GOTO/{arguments} has {len(row)} numbers: x,y,z,i,j,k are needed")
    size = float(np.linalg.norm(row[3:]))
    if not abs(size - 1) < 1e-3:
        raise InvalidInput(f"CL line {number}: the axis {row[3:].tolist()} has length {size:.6g}: it must be 1")
    row[3:] /= size
    return row


def _feedrate(number: int, arguments: str, scale: float) -> float:
    words = [word.strip() for word in arguments.split(",")]
    try:
        value = next(float(word) for word in words if word and (word[0].isdigit() or word[0] in ".+-"))
    except (StopIteration, ValueError):
        raise InvalidInput(f"CL line {number}: FEDRAT/{arguments} has no feed rate") from None
    if not (isfinite(value) and value > 0):
        raise InvalidInput(f"CL line {number}: feed rate {value}: it must be a finite number above zero")
    return value * (25.4 if "IPM" in words else 1.0 if "MMPM" in words else scale)


@dataclass
class _Reading:
    """What holds while the statements go by, and the rows gathered."""

    scale: float = 1.0
    multax: bool = False
    rapid: bool = False
    feedrate: float = np.inf
    motion: Motion = Motion.CUT
    ended: bool = False

    def __post_init__(self) -> None:
        self.rows: list[Array] = []
        self.kinds: list[int] = []
        self.rates: list[float] = []
        self.starts: list[int] = []

    def take(self, number: int, statement: str) -> None:
        """Take in one statement that begins on a line with a number."""
        word, _, arguments = (part.strip() for part in statement.partition("/"))
        word = word.upper()
        if word == "GOTO":
            self._take_goto(number, arguments)
        elif word == "RAPID":
            self.rapid = True
        elif word == "FEDRAT":
            self.feedrate = _feedrate(number, arguments, self.scale)
        elif word == "UNITS":
            self._take_units(number, arguments)
        elif word == "MULTAX":
            self.multax = arguments.upper() != "OFF"
        elif word == "PPRINT":
            self._take_print(arguments)
        elif word == "FINI":
            self.ended = True
        elif word.split()[0] not in _IGNORED:
            raise InvalidInput(f"CL line {number}: {word} is not understood: only straight motion (GOTO) can be judged")

    def _take_goto(self, number: int, arguments: str) -> None:
        row = _goto(number, arguments, self.multax, self.rows[-1] if self.rows else None)
        self.kinds.append(Motion.LINK if self.rapid else self.motion)
        self.rates.append(np.inf if self.rapid else self.feedrate)
        self.rows.append(np.concatenate([row[:3] * self.scale, row[3:]]))
        self.rapid = False

    def _take_units(self, number: int, arguments: str) -> None:
        scales = {"MM": 1.0, "INCHES": 25.4, "INCH": 25.4}
        if arguments.upper() not in scales:
            raise InvalidInput(f"CL line {number}: UNITS/{arguments} is not understood: use MM or INCHES")
        self.scale = scales[arguments.upper()]

    def _take_print(self, arguments: str) -> None:
        words = arguments.upper().split()
        if words[:1] == ["PASS"]:
            self.starts.append(len(self.rows))
        elif len(words) == 1 and words[0] in _MOTIONS:
            # A rapid motion is a link whatever is printed, and only RAPID makes one.
            self.motion = _MOTIONS[words[0]] if words[0] != "LINK" else Motion.CUT


def read_apt(text: str) -> CutterLocations:
    """Read an APT CL file.

    Parameters
    ----------
    text : str

    Returns
    -------
    CutterLocations

    Raises
    ------
    InvalidInput
        When a statement is not understood, a number is missing or not finite, or the file ends without FINI
        (it was cut short); the message gives the line.
    """
    reading = _Reading()
    for number, statement in _statements(text):
        reading.take(number, statement)
    if not reading.ended:
        raise InvalidInput(f"CL file ends without FINI after {len(reading.rows)} points: it was cut short")
    if len(reading.rows) < 2:
        raise InvalidInput(f"CL file has {len(reading.rows)} GOTO statements: at least two make a path")
    table = np.stack(reading.rows)
    starts = reading.starts if reading.starts and reading.starts[0] == 0 else [0, *reading.starts]
    return CutterLocations(np.ascontiguousarray(table[:, :3]), np.ascontiguousarray(table[:, 3:]),
                           np.array(reading.kinds, dtype=np.int8), np.array(reading.rates),
                           np.array([*starts, len(table)], dtype=np.int64))
