"""Machines from FreeCAD's machine files (.fcm).

Such a file is JSON.  Under "machine" it has "name", "units" and "axes", each with "type" ("linear", or "angular" and
"rotary"), "joint" (origin and axis), limits, "max_velocity" per minute, and since the spring of 2026 "role"
(table_linear, table_rotary, head_linear, head_rotary), "parent" and "sequence".  Lengths are mm and angles degrees,
whatever "units" says.  It knows no acceleration, no jerk, no gauge point and no increment.

Two things the format leaves open: the sense of a table's turn, taken here as ISO 841 has it, and whether "sequence"
counts from the bed or from the part and the tool.  FreeCAD's own templates (C before A on a table, B before C in a
head) make machines only when counted from the part and from the tool, and so it is read here.
"""

import json
from math import radians
from typing import Any

import numpy as np

from toolaxis.errors import InvalidInput
from toolaxis.machine.axis import Drive, LinearAxis, RotaryAxis
from toolaxis.machine.machine import Machine

_LINEAR = {"X": (1, 0, 0), "Y": (0, 1, 0), "Z": (0, 0, 1)}
_ROLES = ("table_linear", "table_rotary", "head_linear", "head_rotary")


def machine_from_fcm(text: str) -> Machine:
    """A machine from the text of a FreeCAD machine file.

    Its axes have no acceleration and no jerk, so that feeds cannot be planned with it.

    Parameters
    ----------
    text : str

    Raises
    ------
    InvalidInput
        When it is no such file, or its axes make no machine.
    """
    try:
        content = json.loads(text)
        machine = content.get("machine", content)
        axes = dict(machine["axes"])
        name = str(machine["name"])
    except (ValueError, KeyError, AttributeError, TypeError) as reason:
        raise InvalidInput("not a FreeCAD machine file: JSON with a machine that has a name and axes is "
                           "needed") from reason
    linear: list[LinearAxis] = []
    table: list[RotaryAxis] = []
    head: list[RotaryAxis] = []
    for label, axis in sorted(axes.items(), key=lambda item: (_sequence(item), item[0])):
        role = _role(label, axis)
        if not role.endswith("rotary"):
            linear.append(_linear(label, axis))
        elif role == "table_rotary":
            table.append(_rotary(label, axis))
        else:
            head.insert(0, _rotary(label, axis))
    linear.sort(key=lambda item: item.name)
    return Machine(name, tuple(linear), tuple(table), tuple(head), source="FreeCAD machine file",
                   assumed=("gauge point at the origin", "turns as ISO 841 has them", "order of the rotary axes"))


def _sequence(item: tuple[str, Any]) -> float:
    label, axis = item
    if not isinstance(axis, dict):
        raise InvalidInput(f"axis {label} is {axis!r}: a table of values is needed")
    return _number(axis.get("sequence", 0), f"sequence of axis {label}")


def _role(label: str, axis: dict[str, Any]) -> str:
    kind = axis.get("type", "linear")
    if kind not in ("linear", "angular", "rotary"):
        raise InvalidInput(f"type of axis {label} is {kind!r}: use linear or angular")
    ending = "linear" if kind == "linear" else "rotary"
    role = str(axis.get("role", f"table_{ending}"))
    if role not in _ROLES or not role.endswith(ending):
        raise InvalidInput(f"role of axis {label} is {role!r}: a {kind} axis is table_{ending} or head_{ending}")
    return role


def _number(value: Any, what: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InvalidInput(f"{what} is {value!r}: a number is needed")
    return float(value)


def _limits(label: str, axis: dict[str, Any], usual: tuple[float, float]) -> tuple[float, float]:
    limits = axis.get("limits", axis)
    if not isinstance(limits, dict):
        raise InvalidInput(f"limits of axis {label} are {limits!r}: min and max are needed")
    return (_number(limits.get("min", usual[0]), f"min of axis {label}"),
            _number(limits.get("max", usual[1]), f"max of axis {label}"))


def _joint(label: str, axis: dict[str, Any], usual: tuple[float, ...]) -> tuple[Any, Any]:
    """Origin and direction; older files give the direction of linear axes first."""
    joint = axis.get("joint")
    pair: Any = [joint.get("origin"), joint.get("axis")] if isinstance(joint, dict) else joint
    try:
        origin, direction = (np.array([_number(value, "joint") for value in row])
                             for row in ([(0, 0, 0), usual] if joint is None else pair))
    except (TypeError, ValueError) as reason:
        raise InvalidInput(f"joint of axis {label} is {joint!r}: an origin and an axis of 3 numbers are "
                           "needed") from reason
    if axis.get("type", "linear") == "linear" and not direction.any():
        origin, direction = direction, origin
    return origin, direction


def _linear(label: str, axis: dict[str, Any]) -> LinearAxis:
    _, direction = _joint(label, axis, _LINEAR.get(label, (0, 0, 0)))
    velocity = _number(axis.get("max_velocity", 10000), f"max_velocity of axis {label}") / 60
    return LinearAxis(label, direction, Drive(velocity), *_limits(label, axis, (0.0, 1000.0)))


def _rotary(label: str, axis: dict[str, Any]) -> RotaryAxis:
    origin, direction = _joint(label, axis, (0, 0, 0))
    velocity = radians(_number(axis.get("max_velocity", 36000), f"max_velocity of axis {label}")) / 60
    low, high = (radians(value) for value in _limits(label, axis, (-360.0, 360.0)))
    return RotaryAxis(label, direction, origin, Drive(velocity), low, high)
