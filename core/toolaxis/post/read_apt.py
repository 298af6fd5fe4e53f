"""APT cutter location files read: those that `toolaxis.post.apt` writes, and those made elsewhere."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput
from toolaxis.post.cl_points import CutterLocations, gather_locations

Array = NDArray[np.float64]

#: Words that move nothing, or nothing that is cut.
_IGNORED = {"PARTNO", "MACHIN", "CUTTER", "LOADTL", "LOAD", "UNLOAD", "COOLNT", "TOOLNO", "TPRINT", "INTOL", "OUTTOL",
            "CLPRNT", "INSERT", "REMARK", "TLAXIS", "FROM", "STOP", "OPSTOP", "DELAY", "AUXFUN", "PREFUN", "MODE",
            "SET", "CLAMP", "TLDATA", "TOOL", "PAINT", "SEQNO", "LINTOL", "PPFUN", "PPWORD", "OPNAME", "END",
            "CLRSRF", "MAXDPM", "LEADER", "DISPLY", "HEAD", "CHECK", "TMARK"}
#: Units of length, in mm.
_UNITS = {"MM": 1.0, "MILLIMETER": 1.0, "MILLIMETERS": 1.0, "INCHES": 25.4, "INCH": 25.4}
#: Units of feed rates, in mm: those per minute, and those per revolution.
_PER_MINUTE, _PER_TURN = {"MMPM": 1.0, "IPM": 25.4}, {"MMPR": 1.0, "IPR": 25.4}
_MOTIONS = {motion.name: motion for motion in Motion}


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


def _numbers(number: int, statement: str, arguments: str) -> Array:
    try:
        return np.array([float(part) for part in arguments.split(",")])
    except ValueError:
        raise InvalidInput(f"CL line {number}: {statement}/{arguments} has a word that is not a number") from None


def _goto(number: int, arguments: str, multax: bool, last: Array | None) -> Array:
    row = _numbers(number, "GOTO", arguments)
    if len(row) == 3 and (not multax or last is not None):
        row = np.concatenate([row, [0.0, 0.0, 1.0] if last is None else last[3:]])
    if len(row) != 6 or not np.isfinite(row).all():
        raise InvalidInput(f"CL line {number}: GOTO/{arguments} has {len(row)} numbers: x,y,z,i,j,k are needed, all "
                           "finite")
    size = float(np.linalg.norm(row[3:]))
    if not abs(size - 1) < 1e-3:
        raise InvalidInput(f"CL line {number}: the axis {row[3:].tolist()} has length {size:.6g}: it must be 1")
    row[3:] /= size
    return row


def _table(arguments: list[str]) -> Array | None:
    """Points and unit axes of GOTO statements, (n, 6); None where one does not have six good numbers."""
    if any(words.count(",") != 5 for words in arguments):
        return None
    try:
        table = np.array(",".join(arguments).split(","), dtype=float).reshape(-1, 6)
    except ValueError:
        return None
    size = np.linalg.norm(table[:, 3:], axis=1, keepdims=True)
    if not (np.isfinite(table).all() and (np.abs(size - 1) < 1e-3).all()):
        return None
    table[:, 3:] /= size
    return table


def _first_number(arguments: str) -> float | None:
    """The first of the words that is a number."""
    for word in arguments.split(","):
        try:
            return float(word)
        except ValueError:
            continue
    return None


def _feedrate(number: int, arguments: str, scale: float, spindle: float) -> float:
    words, value = {word.strip().upper() for word in arguments.split(",")}, _first_number(arguments)
    if value is None:
        raise InvalidInput(f"CL line {number}: FEDRAT/{arguments} has no feed rate")
    if not (isfinite(value) and value > 0):
        raise InvalidInput(f"CL line {number}: feed rate {value}: it must be a finite number above zero")
    turning = words & set(_PER_TURN)
    if turning and spindle <= 0:
        raise InvalidInput(f"CL line {number}: FEDRAT/{arguments} is per revolution and no SPINDL before it tells how "
                           "fast the spindle turns")
    if turning:
        return value * _PER_TURN[turning.pop()] * spindle
    minute = words & set(_PER_MINUTE)
    return value * (_PER_MINUTE[minute.pop()] if minute else scale)


@dataclass
class _Reading:
    """What holds while the statements go by, and the rows gathered."""

    scale: float = 1.0
    multax: bool = False
    rapid: bool = False
    feedrate: float = np.inf
    motion: Motion = Motion.CUT
    ended: bool = False
    told: bool = False
    spindle: float = 0.0
    first_spindle: float = 0.0
    frame: str = ""

    def __post_init__(self) -> None:
        self.rows: list[Array] = []
        self.kinds: list[int] = []
        self.rates: list[float] = []
        self.starts: list[int] = []

    def take(self, number: int, statement: str) -> None:
        """Take in one statement that begins on a line with a number."""
        word, _, arguments = (part.strip() for part in statement.partition("/"))
        word = word.upper()
        first = word.split()[0] if word else ""
        if word in ("GOTO", "GODLTA"):
            self._take_goto(number, arguments, word == "GODLTA")
        elif word == "RAPID":
            self.rapid = True
        elif word == "FEDRAT":
            self.feedrate = _feedrate(number, arguments, self.scale, self.spindle)
        elif word == "SPINDL":
            self.spindle = _first_number(arguments) or self.spindle
            self.first_spindle = self.first_spindle or self.spindle
        elif word == "UNITS":
            self._take_units(number, arguments)
        elif word == "MULTAX":
            self.multax = arguments.upper() != "OFF"
        elif first == "PPRINT":
            self._take_print(arguments)
        elif word in ("FINI", "END-OF-PATH"):
            self.ended = True
        elif word == "MSYS":
            self._take_frame(number, arguments)
        elif first not in _IGNORED:
            raise InvalidInput(f"CL line {number}: {word} is not understood: only straight motion (GOTO) can be "
                               "verified")

    def take_run(self, numbers: list[int], arguments: list[str]) -> None:
        """Take in GOTO statements that follow each other: at once where each is whole, else one by one."""
        table = _table(arguments)
        if table is None:
            for number, words in zip(numbers, arguments, strict=True):
                self._take_goto(number, words, False)
            return
        table[:, :3] *= self.scale
        self.told = True
        self.kinds += [Motion.LINK if self.rapid else self.motion, *[self.motion] * (len(table) - 1)]
        self.rates += [np.inf if self.rapid else self.feedrate, *[self.feedrate] * (len(table) - 1)]
        self.rows += list(table)
        self.rapid = self.ended = False

    def _take_goto(self, number: int, arguments: str, relative: bool) -> None:
        last = self.rows[-1] if self.rows else None
        if relative:
            row = self._step(number, arguments, last)
        else:
            row = _goto(number, arguments, self.multax, last)
            self.told |= arguments.count(",") == 5
            row = np.concatenate([row[:3] * self.scale, row[3:]])
        self.kinds.append(Motion.LINK if self.rapid else self.motion)
        self.rates.append(np.inf if self.rapid else self.feedrate)
        self.rows.append(row)
        self.rapid = self.ended = False

    def _step(self, number: int, arguments: str, last: Array | None) -> Array:
        way = _numbers(number, "GODLTA", arguments) * self.scale
        if last is None or len(way) not in (1, 3) or not np.isfinite(way).all():
            raise InvalidInput(f"CL line {number}: GODLTA/{arguments} must follow a GOTO and have one or three finite "
                               "numbers")
        step = way if len(way) == 3 else way * last[3:]
        return np.concatenate([last[:3] + step, last[3:]])

    def _take_units(self, number: int, arguments: str) -> None:
        if arguments.upper() not in _UNITS:
            raise InvalidInput(f"CL line {number}: UNITS/{arguments} is not understood: use MM or INCHES")
        self.scale = _UNITS[arguments.upper()]

    def _take_frame(self, number: int, arguments: str) -> None:
        """The system that coordinates are in: as good as any other, as long as it is one."""
        if self.frame not in ("", arguments):
            raise InvalidInput(f"CL line {number}: MSYS/{arguments} is another coordinate system than before: write a "
                               "file for each")
        self.frame = arguments

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
        When a statement is not understood, a number is missing or not finite, or the file ends without FINI or
        END-OF-PATH (it was cut short); the message gives the line.

    Notes
    -----
    Words that move nothing are passed over.  Arcs, cycles, and words that shift or turn coordinates are refused.
    """
    reading, number = _Reading(), 0
    numbers: list[int] = []
    points: list[str] = []
    for number, statement in _statements(text):
        if statement.startswith("GOTO/"):
            numbers.append(number)
            points.append(statement[5:])
            continue
        if points:
            reading.take_run(numbers, points)
            numbers, points = [], []
        reading.take(number, statement)
    if points:
        reading.take_run(numbers, points)
    if not reading.ended:
        raise InvalidInput(f"CL file ends without FINI after {len(reading.rows)} points, at line {number}: it was cut "
                           "short")
    return gather_locations(reading.rows, reading.kinds, reading.rates, reading.starts, told=reading.told,
                            spindle=reading.first_spindle, source="CL file")
