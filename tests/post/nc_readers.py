"""Readers of NC programs, written for the tests: what a control would do with each block, and what it must never do."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

WORD = re.compile(r"([A-Z])([-+]?(?:\d+\.?\d*|\.\d+))")


@dataclass
class Read:
    """One station as a control carries it out."""

    angles: dict[str, float]
    offset: str
    plane: np.ndarray | None
    points: list[list[float]] = field(default_factory=list)
    rapid: list[bool] = field(default_factory=list)
    rate: list[float] = field(default_factory=list)


@dataclass
class Control:
    """State of a control; asserts stand where a program would be unsafe."""

    table: Callable[[dict[str, float]], np.ndarray]
    angles: dict[str, float] = field(default_factory=dict)
    offset: str = "G54"
    offsets_turn: bool = False
    spindle: bool = False
    retracted: bool = False
    length: bool = False
    plane: np.ndarray | None = None
    defined: np.ndarray | None = None
    at: list[float] = field(default_factory=lambda: [np.nan] * 3)
    feed: float = np.nan
    found: list[Read] = field(default_factory=list)
    open: bool = False
    ended: bool = False

    def retract(self) -> None:
        self.retracted, self.open, self.at = True, False, [np.nan] * 3

    def index(self, angles: dict[str, float]) -> None:
        assert self.retracted, "rotary axes turn while the tool is down"
        self.plane = None if self.offsets_turn else self.plane
        assert self.plane is None, "rotary axes turn in a tilted plane"
        self.angles = {**self.angles, **angles}

    def motion(self, words: dict[str, float], rapid: bool, feed: float | None) -> None:
        assert self.plane is not None, "motion without a plane"
        assert self.spindle, "motion while the spindle stands"
        assert self.length or not ("Z" in words or self.open), "motion along Z without tool length"
        self.feed = self.feed if feed is None else feed
        if not self.open:
            self.open = True
            self.found.append(Read(dict(self.angles), self.offset, self.plane))
        self.retracted = False
        self.at = [words.get(name, now) for name, now in zip("XYZ", self.at, strict=True)]
        if np.isnan(self.at).any():
            return
        assert rapid or np.isfinite(self.feed), "feed motion without a feed rate"
        self.found[-1].points.append(list(self.at))
        self.found[-1].rapid.append(rapid)
        self.found[-1].rate.append(np.inf if rapid else self.feed)


def read_iso(text: str, table: Callable[[dict[str, float]], np.ndarray], offsets_turn: bool = False) -> list[Read]:
    """Programs of Fanuc, Haas, LinuxCNC and plain ISO controls."""
    lines = text.splitlines()
    assert lines[0] == "%" and lines[-1] == "%"
    control = Control(table, offsets_turn=offsets_turn)
    for line in lines[1:-1]:
        block = re.sub(r"\([^()]*\)", "", line)
        words = [(name, float(value)) for name, value in WORD.findall(block)]
        assert re.sub(WORD, "", block).strip() == "" and not control.ended, line
        _iso_block(control, words, line)
    assert control.ended and not control.spindle and control.retracted
    return control.found


def _iso_block(control: Control, words: list[tuple[str, float]], line: str) -> None:
    codes = [value for name, value in words if name == "G"]
    rest = {name: value for name, value in words if name not in "GM"}
    assert len(rest) == sum(name not in "GM" for name, _ in words), f"a word stands twice: {line}"
    _iso_machine(control, words, line)
    if 43 in codes:
        control.length = True
    if 49 in codes:
        control.length = False
    named = {54: "G54", 55: "G55", 56: "G56", 57: "G57", 58: "G58", 59: "G59", 59.1: "G59.1", 59.2: "G59.2",
             59.3: "G59.3"}
    for code in codes:
        if code in named:
            assert control.retracted or not control.found
            control.offset = named[code]
            control.plane = control.table(control.angles) if control.offsets_turn else control.plane
    if 68.2 in codes:
        assert (rest["X"], rest["Y"], rest["Z"]) == (0, 0, 0) and control.plane is None
        control.defined = Rotation.from_euler("ZXZ", [rest["I"], rest["J"], rest["K"]], degrees=True).as_matrix()
    elif 268 in codes:
        assert rest["Q"] == 321 and control.plane is None
        control.plane = Rotation.from_euler("zyx", [rest["K"], rest["J"], rest["I"]], degrees=True).as_matrix()
    elif 53.1 in codes:
        assert control.defined is not None
        control.plane, control.defined = control.defined, None
    elif 254 in codes:
        control.plane = control.table(control.angles)
    elif {69, 269, 255} & set(codes):
        control.plane = None
    elif (28 in codes and 91 in codes) or 53 in codes:
        assert set(rest) == {"Z"}
        control.retract()
        control.plane = None if control.offsets_turn else control.plane
    elif set(rest) & set("ABC"):
        assert 0 in codes and not set(rest) & set("XYZ")
        control.index({name: value for name, value in rest.items() if name in "ABC"})
    elif set(rest) & set("XYZ"):
        assert (0 in codes) != (1 in codes)
        control.motion(rest, 0 in codes, rest.get("F"))


def _iso_machine(control: Control, words: list[tuple[str, float]], line: str) -> None:
    for name, value in words:
        if (name, value) == ("M", 3):
            assert any(other == "S" for other, _ in words)
            control.spindle = True
        elif name == "M" and value in (5, 0):
            control.spindle = False
            if value == 0:
                assert control.retracted
        elif name == "M" and value in (2, 30):
            control.ended = True
    asked = re.search(r"\(SET ([^()]*)\)", line)
    if asked:
        control.index({name: float(value) for name, value in WORD.findall(asked[1])})


def read_siemens(text: str, table: Callable[[dict[str, float]], np.ndarray]) -> list[Read]:
    """Programs of SINUMERIK controls."""
    control, named = Control(table, length=True), {}
    for line in text.splitlines():
        block, _, comment = line.partition(";")
        if comment.strip().startswith("AXES"):
            named = {name: float(value) for name, value in WORD.findall(comment.strip()[4:])}
        swivel = re.fullmatch(r"CYCLE800\((.*)\)", block.strip())
        if swivel:
            _swivel(control, [word.strip() for word in swivel[1].split(",")], named)
            continue
        words = {name: float(value) for name, value in WORD.findall(block.replace("RTLION", ""))}
        if words.get("M") == 3:
            control.spindle = True
        elif words.get("M") == 5:
            control.spindle = False
        elif words.get("M") == 30:
            control.ended = True
        elif "G" in words and set(words) & set("XYZ"):
            control.motion(words, words["G"] == 0, words.get("F"))
    assert control.ended and not control.spindle and control.retracted
    return control.found


def _swivel(control: Control, words: list[str], named: dict[str, float]) -> None:
    control.plane = None
    if words == [""]:
        assert control.retracted or not control.found
        return
    assert len(words) == 16 and words[:3] == ["1", '""', "0"], words
    assert [float(words[k]) for k in (4, 5, 6, 10, 11, 12)] == [0.0] * 6
    control.retract()
    control.index(named)
    mode = int(words[3])
    assert mode >> 6 == 0, "axis by axis"
    order = "".join(" XYZ"[(mode >> shift) & 3] for shift in (0, 2, 4))
    control.plane = Rotation.from_euler(order, [float(word) for word in words[7:10]], degrees=True).as_matrix()


def read_heidenhain(text: str, table: Callable[[dict[str, float]], np.ndarray]) -> list[Read]:
    """Programs in Klartext."""
    lines = text.splitlines()
    assert lines[0] == "0 BEGIN PGM TOOLAXIS MM" and lines[-1].endswith("END PGM TOOLAXIS MM")
    control = Control(table, length=False)
    for k, line in enumerate(lines):
        number, _, block = line.partition(" ")
        assert int(number) == k
        _klartext(control, block)
    assert control.ended and not control.spindle and control.retracted
    return control.found


def _klartext(control: Control, block: str) -> None:
    words = {name: float(value) for name, value in WORD.findall(block.replace("FMAX", "").replace("R0", ""))}
    if block.startswith("TOOL CALL"):
        control.length = True
    elif block == "L M3":
        control.spindle = True
    elif block == "L M5":
        control.spindle = False
    elif block == "L M30":
        control.ended = True
    elif block == "L M140 MB MAX":
        control.retract()
    elif block == "PLANE RESET STAY":
        control.plane = None
    elif block.startswith("PLANE SPATIAL"):
        assert block.endswith("TURN FMAX COORD ROT") and control.retracted
        a, b, c = (float(re.search(rf"SP{name}([-+][\d.]+)", block)[1]) for name in "ABC")  # type: ignore[index]
        control.plane = Rotation.from_euler("xyz", [a, b, c], degrees=True).as_matrix()
    elif block.startswith("L ") and set(words) & set("ABC"):
        control.index({name: value for name, value in words.items() if name in "ABC"})
    elif block.startswith("L "):
        control.motion(words, block.endswith("FMAX"), words.get("F"))
