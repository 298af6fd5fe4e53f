"""Machines from TOML, and those that come with toolaxis.

In the files lengths are mm, angles degrees, times seconds; in memory angles are radians.  An acceleration or a jerk
that nobody knows is written "unknown"; feeds are not planned with it.
"""

import json
import tomllib
from collections.abc import Callable
from math import inf, radians
from pathlib import Path
from typing import Any

import numpy as np

from toolaxis.errors import InvalidInput
from toolaxis.machine.axis import Drive, LinearAxis, RotaryAxis
from toolaxis.machine.bodies import body_from, body_lines
from toolaxis.machine.freecad_machine import machine_from_fcm
from toolaxis.machine.machine import Machine
from toolaxis.resources import find_files

_MACHINE = {"name", "source", "assumed", "spindle", "gauge", "linear", "table", "head", "body"}
_LINEAR = {"name", "direction", "limits", "velocity", "acceleration", "jerk"}
_ROTARY = _LINEAR | {"point", "increment", "by_hand"}
_DRIVE = ("velocity", "acceleration", "jerk")
#: What stands for an acceleration or a jerk that nobody knows.
_UNKNOWN = "unknown"


def library() -> dict[str, Path]:
    """The machines that can be given by name: files in resources/machines of a clone or of an installed wheel.

    Returns
    -------
    dict of str to Path
        The folder in the environment variable TOOLAXIS_MACHINES, if set, comes first.
    """
    return find_files("machines", ".toml", ".fcm")


def load_machine(text: str) -> Machine:
    """A machine from its name in the library, a TOML file, or one of FreeCAD's .fcm files.

    Parameters
    ----------
    text : str

    Raises
    ------
    InvalidInput
        When there is no such machine, or the file does not describe one.
    """
    path = Path(text)
    if not path.is_file():
        known = library()
        if text not in known:
            raise InvalidInput(f"machine {text!r} is neither a file nor one of the library: "
                               f"{', '.join(known) or 'none'}")
        path = known[text]
    try:
        content = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as reason:
        raise InvalidInput(f"machine file {path.name} is no text: give a TOML or a .fcm file") from reason
    except OSError as reason:
        raise InvalidInput(f"{path} cannot be read: {reason.strerror}") from reason
    try:
        return machine_from_fcm(content) if path.suffix.lower() == ".fcm" else machine_from_toml(content, path.parent)
    except InvalidInput as reason:
        raise InvalidInput(f"machine file {path.name}: {reason}") from reason


def machine_from_toml(text: str, folder: Path | None = None) -> Machine:
    """A machine from the text of a TOML file.

    Parameters
    ----------
    text : str
    folder : Path, optional
        Where STEP files of its bodies are looked for.

    Raises
    ------
    InvalidInput
        When a word is unknown, a number is missing or of the wrong kind, or the axes make no machine.
    """
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as reason:
        raise InvalidInput(f"not valid TOML: {reason}") from reason
    _check_words(content, _MACHINE, "machine")
    name = content.get("name")
    if not isinstance(name, str) or not name:
        raise InvalidInput("the machine has no name: write name = \"...\"")
    return Machine(
        name, tuple(_linear(item) for item in _list(content, "linear")),
        tuple(_rotary(item) for item in _list(content, "table")),
        tuple(_rotary(item) for item in _list(content, "head")),
        _numbers(content.get("spindle", [0, 0, 1]), 3, "spindle"),
        _numbers(content.get("gauge", [0, 0, 0]), 3, "gauge"),
        str(content.get("source", "")), tuple(str(item) for item in _list(content, "assumed")),
        tuple(body_from(item, folder) for item in _list(content, "body")))


def _list(content: dict[str, Any], word: str) -> list[Any]:
    items = content.get(word, [])
    if not isinstance(items, list):
        raise InvalidInput(f"{word} is {items!r}: a list is needed")
    return items


def _check_words(item: Any, words: set[str], what: str) -> None:
    if not isinstance(item, dict):
        raise InvalidInput(f"{what} is {item!r}: a table of values is needed")
    unknown = sorted(set(item) - words)
    if unknown:
        raise InvalidInput(f"{what} has an unknown {unknown[0]!r}: use {', '.join(sorted(words))}")


def _numbers(values: Any, count: int, what: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    good = isinstance(values, list) and len(values) == count
    if not good or not all(isinstance(value, int | float) and not isinstance(value, bool) for value in values):
        raise InvalidInput(f"{what} is {values!r}: {count} numbers are needed")
    return np.array(values, dtype=float)


def _number(item: dict[str, Any], word: str, axis: str) -> float:
    value = item.get(word)
    if value is None:
        raise InvalidInput(f"axis {axis} has no {word}: state its limit")
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InvalidInput(f"{word} of axis {axis} is {value!r}: a number is needed")
    return float(value)


def _drive(item: dict[str, Any], name: str, unit: Callable[[float], float]) -> Drive:
    values = [None if item.get(word) == _UNKNOWN and word != "velocity" else unit(_number(item, word, name))
              for word in _DRIVE]
    return Drive(values[0] or 0.0, *values[1:])


def _name(item: dict[str, Any], kind: str) -> str:
    name = item.get("name")
    if not isinstance(name, str):
        raise InvalidInput(f"a {kind} axis has the name {name!r}: write name = \"X\"")
    return name


def _limits(item: dict[str, Any], name: str) -> tuple[float, float]:
    low, high = _numbers(item["limits"], 2, f"limits of axis {name}") if "limits" in item else (-inf, inf)
    return float(low), float(high)


def _linear(item: Any) -> LinearAxis:
    _check_words(item, _LINEAR, "a linear axis")
    name = _name(item, "linear")
    drive = _drive(item, name, float)
    direction = _numbers(item.get("direction"), 3, f"direction of axis {name}")
    return LinearAxis(name, direction, drive, *_limits(item, name))


def _rotary(item: Any) -> RotaryAxis:
    _check_words(item, _ROTARY, "a rotary axis")
    name = _name(item, "rotary")
    by_hand = item.get("by_hand", False)
    if not isinstance(by_hand, bool):
        raise InvalidInput(f"by_hand of axis {name} is {by_hand!r}: true or false is needed")
    stated = [word for word in _DRIVE if word in item]
    if by_hand and stated:
        raise InvalidInput(f"axis {name} is set by hand and has a {stated[0]}: one of the two must go")
    drive = None if by_hand else _drive(item, name, radians)
    low, high = (radians(value) for value in _limits(item, name))
    increment = radians(_number(item, "increment", name)) if "increment" in item else 0.0
    return RotaryAxis(name, _numbers(item.get("direction"), 3, f"direction of axis {name}"),
                      _numbers(item.get("point", [0, 0, 0]), 3, f"point of axis {name}"), drive, low, high, increment)


def machine_to_toml(machine: Machine) -> str:
    """The text of a machine's TOML file, which `machine_from_toml` reads back.

    Directions come back to the rounding of unit vectors, everything else exactly.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    str
        Angles in degrees; a value that was read from degrees comes back as the nearest number that gives it again.
    """
    lines = [f"name = {_quote(machine.name)}", f"source = {_quote(machine.source)}",
             f"assumed = [{', '.join(map(_quote, machine.assumed))}]",
             f"spindle = {_list_text(machine.spindle)}", f"gauge = {_list_text(machine.gauge)}"]
    for axis in machine.linear:
        lines += ["", "[[linear]]", f"name = {_quote(axis.name)}", f"direction = {_list_text(axis.direction)}"]
        lines += _limits_text(axis.low, axis.high, float) + _drive_text(axis.drive, float)
    for kind, axes in (("table", machine.table), ("head", machine.head)):
        for turn in axes:
            lines += ["", f"[[{kind}]]", f"name = {_quote(turn.name)}", f"direction = {_list_text(turn.direction)}",
                      f"point = {_list_text(turn.point)}", f"increment = {_degrees(turn.increment)!r}"]
            lines += _limits_text(turn.low, turn.high, _degrees)
            lines += ["by_hand = true"] if turn.drive is None else _drive_text(turn.drive, _degrees)
    for body in machine.bodies:
        lines += ["", "[[body]]", *body_lines(body)]
    return "\n".join(lines) + "\n"


def _degrees(angle: float) -> float:
    """Degrees that `radians` turns into the very angle, where there are such."""
    value = float(np.degrees(angle))
    near = [value, *(float(np.nextafter(value, way)) for way in (-inf, inf)), round(value, 9)]
    return next((one for one in sorted(near, key=lambda one: len(repr(one))) if radians(one) == angle), value)


def _quote(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _list_text(values: Any) -> str:
    return "[" + ", ".join(repr(float(value)) for value in np.asarray(values)) + "]"


def _limits_text(low: float, high: float, unit: Callable[[float], float]) -> list[str]:
    if low == -inf and high == inf:
        return []
    return [f"limits = [{', '.join(repr(unit(one)) if np.isfinite(one) else str(one) for one in (low, high))}]"]


def _drive_text(drive: Drive, unit: Callable[[float], float]) -> list[str]:
    values = {word: getattr(drive, word) for word in _DRIVE}
    return [f"{word} = {_quote(_UNKNOWN) if value is None else repr(unit(value))}" for word, value in values.items()]
