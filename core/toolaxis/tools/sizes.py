"""Sizes of tools, checked."""

from math import isfinite
from typing import Any

from toolaxis.errors import InvalidInput


def number(name: str, value: Any, unit: str = "mm") -> float:
    """A finite number.

    Parameters
    ----------
    name : str
        For the message.
    value : object
    unit : str

    Raises
    ------
    InvalidInput
        When it is none.
    """
    try:
        found = float(value)
    except (TypeError, ValueError, OverflowError) as reason:
        raise InvalidInput(f"{name} is {value!r}: it must be a number of {unit}") from reason
    if not isfinite(found):
        raise InvalidInput(f"{name} is {found} {unit}: it must be a finite number")
    return found


def positive(name: str, value: Any, unit: str = "mm") -> float:
    """A finite number above zero.

    Parameters
    ----------
    name : str
        For the message.
    value : object
    unit : str

    Raises
    ------
    InvalidInput
        When it is none.
    """
    found = number(name, value, unit)
    if found <= 0:
        raise InvalidInput(f"{name} is {found} {unit}: it must be a finite number above zero")
    return found
