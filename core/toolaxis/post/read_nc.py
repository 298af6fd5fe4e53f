"""NC programs of five-axis machines read: tips and axes, from programs with and without tool centre point control.

With control of the tip (G43.4, TRAORI, M128 or FUNCTION TCPM) X, Y, Z are those of the tip on the part, whose system
turns with the table, and the axis is told by rotary words, by A3 B3 C3, or by TX TY TZ.  Without it they are the
machine's own coordinates from the work offset, and the machine's kinematics tells tip and axis.
"""

import re
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.errors import InvalidInput
from toolaxis.machine.kinematics import forward, linear_coordinates, placement, tool_axes
from toolaxis.machine.machine import Machine
from toolaxis.numeric.vectors import unit
from toolaxis.post.cl_points import CutterLocations, gather_locations

Array = NDArray[np.float64]

#: What stands in brackets: a comment, unless it follows the name of a Siemens call.
_BRACKETS = re.compile(r"(CYCLE\d+|WORKPIECE|FGROUP|=\s*(?:DC|ACP|ACN|AC))?\([^()]*\)", re.IGNORECASE)
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)"
_WORD = re.compile(rf"([ABC]3(?==)|T[XYZ]|N[XYZ]|[A-Z])\s*=?\s*(?:DC\(|AC\(|ACP\(|ACN\()?\s*({_NUMBER})\)?")
#: Blocks of Klartext that move nothing, by how they begin; and those without words.
_KLARTEXT = ("BEGIN PGM", "END PGM", "TOOL CALL", "TOOL DEF", "BLK FORM", "PLANE RESET", "STOP", "CALL LBL", "LBL",
             "CYCL DEF 32", "CYCL DEF 247", "FUNCTION RESET TCPM")
#: Words and calls of Siemens controls that move nothing.
_SIEMENS = re.compile(r"\b(TRAFOOF|ORIWKS|ORIVECT|ORIAXES|ORIMKS|SUPA|SOFT|BRISK|FFWON|FFWOF|COMPCAD|COMPCURV|COMPOF|"
                      r"UPATH|CYCLE8(?:32\([^()]*\)|00\(\s*\))|WORKPIECE\([^()]*\)|RTLION|FGROUP\([^()]*\))")
_CYCLES = re.compile(r"^\s*(CYCLE(?!832|800\(\s*\))\d+|CYCL DEF|PLANE|MCALL|APPR|DEP|CC|C|CR|CT|RND|CHF|FN|Q\d+)\b")
#: G words that shift, turn, mirror, or move otherwise than straight, and what to say of them.
_REFUSED: dict[float, str] = {
    2: "an arc", 3: "an arc", 5.2: "a spline", 6.2: "a NURBS", 33: "a thread", 41: "radius compensation",
    42: "radius compensation", 51: "scaling", 52: "a local shift", 68: "a turned plane", 68.2: "a tilted plane",
    92: "a shift of coordinates", 254: "a dynamic offset", 268: "a tilted plane",
    **dict.fromkeys((73, 74, 76, 81, 82, 83, 84, 85, 86, 87, 88, 89), "a cycle")}
_OFFSETS = {*range(54, 60), 59.1, 59.2, 59.3, 54.1}
_ENDS = (2, 30)


@dataclass
class _Control:
    """A control on its way through a program, and the rows gathered."""

    machine: Machine
    offset: ArrayLike | None
    tool_length: float
    scale: float = 1.0
    tip: bool = False
    rapid: bool | None = None
    ended: bool = False
    spindle: float = 0.0
    rate: float = np.inf
    work: float | None = None
    relative: bool = False
    vector: Array | None = None
    at: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.rows: list[Array] = []
        self.kinds: list[int] = []
        self.rates: list[float] = []
        self.names = [axis.name for axis in self.machine.rotary]
        zero = np.zeros(len(self.names))
        self.turn = placement(self.offset)[:3, :3]
        self.origin = linear_coordinates(self.machine, np.zeros((1, 3)), zero, self.tool_length, self.offset)[0]

    def take(self, number: int, block: str) -> None:
        """Carry out one block."""
        for text, on in (("TRAORI", True), ("TRAFOOF", False), ("M128", True), ("M129", False),
                         ("FUNCTION TCPM", True), ("FUNCTION RESET TCPM", False)):
            if re.search(rf"\b{text}\b", block) and not (text == "FUNCTION TCPM" and "RESET" in block):
                self.tip = on
                block = block.replace(text, " ") if text[0] != "F" else ""
        if block.strip().startswith("TOOL CALL"):
            speed = re.search(rf"\bS({_NUMBER})", block)
            self.spindle = self.spindle or (float(speed[1]) if speed else 0.0)
        if not block.strip() or block.strip().startswith(_KLARTEXT):
            return
        home = re.search(r"\b(G28|G30|G53|SUPA|M140|M91|M92|G75)\b", block)
        if _CYCLES.search(block):
            raise InvalidInput(f"NC line {number}: {block.strip()[:40]} is not read: only straight motion is")
        straight = re.match(r"\s*(L|LN)\b", block)
        words = self._words(number, block)
        codes = [value for name, value in words if name == "G"]
        self._modes(number, block, codes)
        rest = {name: value for name, value in words if name not in ("G", "M", "N", "O", "H", "D", "T", "P")}
        self.spindle = self.spindle or rest.pop("S", 0.0)
        if "F" in rest:
            self._feed(number, rest.pop("F"))
        if straight:
            self.rapid = "FMAX" in block
        if home:
            self._forget(rest)
        elif set(rest) & {"X", "Y", "Z", *self.names, "A3", "B3", "C3", "TX", "TY", "TZ"}:
            self._move(number, block, rest)
        if any(name == "M" and value in _ENDS for name, value in words):
            self.ended = True

    def _words(self, number: int, block: str) -> list[tuple[str, float]]:
        text = _SIEMENS.sub(" ", re.sub(r"^\s*N\d+\b", " ", block))
        text = re.sub(r"\b(?:LN?|FMAX|F AUTO|R0|RL|RR|MB MAX|COORD ROT|TCPM)\b(?=\s|$)", " ", text)
        words = [(name, float(value)) for name, value in _WORD.findall(text)]
        left = _WORD.sub("", text).replace("%", "").strip()
        if left:
            raise InvalidInput(f"NC line {number}: {left[:40]!r} is not understood")
        return words

    def _modes(self, number: int, block: str, codes: list[float]) -> None:
        for code in codes:
            if code in _REFUSED:
                raise InvalidInput(f"NC line {number}: G{code:g} is {_REFUSED[code]}, which is not read: only straight "
                                   "motion is")
            if code in (0, 1):
                self.rapid = code == 0
            elif code in (20, 21, 70, 71, 700, 710):
                self.scale = 25.4 if code in (20, 70, 700) else 1.0
            elif code in (90, 91):
                self.relative = code == 91
            elif code in (43.4, 43.5):
                self.tip = True
            elif code in (49, 43, 44):
                self.tip = False
            elif code == 93:
                raise InvalidInput(f"NC line {number}: feed rates by inverse time (G93) are not read: write G94")
            elif code in _OFFSETS:
                if self.work not in (None, code) and not self.tip:
                    raise InvalidInput(f"NC line {number}: G{code:g} is another work offset than G{self.work:g}: the "
                                       "place of only one is told; write a program for each")
                self.work = code
        if 43.5 in codes:
            raise InvalidInput(f"NC line {number}: G43.5 tells axes by I, J, K, which is not read: write G43.4")

    def _feed(self, number: int, rate: float) -> None:
        if not rate > 0:
            raise InvalidInput(f"NC line {number}: feed rate {rate}: it must be above zero")
        self.rate = rate * self.scale

    def _forget(self, rest: dict[str, float]) -> None:
        """After a motion to a place of the machine the coordinates that moved are not known any more."""
        for name in [name for name in rest if name in "XYZ"] or ["Z"]:
            self.at.pop(name, None)

    def _move(self, number: int, block: str, rest: dict[str, float]) -> None:
        if self.relative:
            raise InvalidInput(f"NC line {number}: increments (G91) are not read: write coordinates (G90)")
        wrong = set(rest) - {"X", "Y", "Z", *self.names, "A3", "B3", "C3", "TX", "TY", "TZ", "NX", "NY", "NZ"}
        if wrong:
            raise InvalidInput(f"NC line {number}: {sorted(wrong)[0]} is no axis of {self.machine.name}, which has "
                               f"{', '.join(['X', 'Y', 'Z', *self.names])}")
        self.at |= {name: value * (self.scale if name in "XYZ" else 1.0) for name, value in rest.items()
                    if len(name) == 1}
        vector = [rest[name] for names in (("A3", "B3", "C3"), ("TX", "TY", "TZ")) for name in names if name in rest]
        if vector:
            self.vector = self._unit(number, vector)
        elif set(rest) & set(self.names):
            self.vector = None
        if {"X", "Y", "Z"} <= set(self.at):
            self._store(number)

    def _unit(self, number: int, vector: list[float]) -> Array:
        if len(vector) != 3 or not np.linalg.norm(vector) > 1e-6:
            raise InvalidInput(f"NC line {number}: the axis {vector} has no direction: three numbers, not all zero, "
                               "are needed")
        return np.asarray(unit(np.array(vector)))

    def _store(self, number: int) -> None:
        """One more row: tip and axis of where the control stands."""
        missing = [name for name in self.names if name not in self.at] if self.vector is None else []
        if missing:
            raise InvalidInput(f"NC line {number}: {missing[0]} has no angle yet: rotary words must come before the "
                               "first motion")
        if self.rapid is None:
            raise InvalidInput(f"NC line {number}: motion before G0 or G1")
        place = np.array([self.at[name] for name in "XYZ"])
        angles = np.radians([self.at.get(name, 0.0) for name in self.names])
        if self.tip:
            axis = self.vector if self.vector is not None else tool_axes(self.machine, angles)[0]
            row = np.concatenate([place @ self.turn, axis @ self.turn])
        else:
            row = self._by_kinematics(number, place, angles)
        self.rows.append(row)
        self.kinds.append(Motion.LINK if self.rapid else Motion.CUT)
        self.rates.append(np.inf if self.rapid else self.rate)

    def _by_kinematics(self, number: int, place: Array, angles: Array) -> Array:
        if self.offset is None and len(self.names):
            raise InvalidInput(f"NC line {number}: coordinates are the machine's own, without control of the tip: tell "
                               "where the part stands on the table (its offset)")
        if self.vector is not None:
            raise InvalidInput(f"NC line {number}: an axis is told as a vector without control of the tip (TRAORI, "
                               "M128)")
        joints = np.concatenate([np.linalg.solve(self.machine.directions, place) + self.origin, angles])
        tip, axis = forward(self.machine, joints, self.tool_length, self.offset)
        return np.concatenate([tip[0], axis[0]])


def read_nc(text: str, machine: Machine, offset: ArrayLike | None = None, tool_length: float = 0.0) -> CutterLocations:
    """Read an NC program of a five-axis machine.

    Parameters
    ----------
    text : str
        G-code of Fanuc, Siemens, Haas or LinuxCNC, or Klartext of Heidenhain.
    machine : Machine
    offset : (3,) or (4, 4) array_like, optional
        Where the part stands on the table, all axes at zero; the work offset is the part's origin then.  Needed where
        there is no control of the tip.
    tool_length : float
        From the gauge point to the tip, mm; of matter where the head turns without control of the tip.

    Returns
    -------
    CutterLocations
        Tips and axes in the part's frame, from the origin of the work offset.

    Raises
    ------
    InvalidInput
        When a word is not understood, a motion is not straight, the program does not end (it was cut short), or an
        axis is missing; the message gives the line.

    Notes
    -----
    Motions in a rapid mode are links.  Blocks that move single axes before all of X, Y, Z are known are no points.

    **Property**: programs that this package writes come back as the path: to the digits that they are written with.
    """
    control, number, ended = _Control(machine, offset, tool_length), 0, False
    for number, raw in enumerate(text.splitlines(), 1):
        line = _BRACKETS.sub(lambda found: found[0] if found[1] else " ", raw)
        line = line.split(";")[0].upper().strip()
        if re.search(r"[A-Z=]\s*[-+]?(NAN|INF)\b", line):
            raise InvalidInput(f"NC line {number}: {line[:40]} holds a number that is not finite")
        ended |= "END PGM" in line
        line = re.sub(r"^\d+(\s+|$)", "", line)
        if line and line != "%" and not re.fullmatch(r"[O%:]\s*\w+", line):
            control.take(number, line)
    if not (control.ended or ended):
        raise InvalidInput(f"NC program ends at line {number} without M2, M30 or END PGM, after {len(control.rows)} "
                           "points: it was cut short")
    return gather_locations(control.rows, control.kinds, control.rates, [], told=bool(control.names),
                            spindle=control.spindle, source="NC program")
