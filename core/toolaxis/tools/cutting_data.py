"""Spindle speed and feed rate from cutting data: cutting speed, feed per tooth and number of teeth."""

from collections.abc import Mapping
from math import pi
from typing import Any

from toolaxis.errors import InvalidInput
from toolaxis.tools.sizes import positive

#: What a tool may state in place of feed rate and spindle speed: a number, m/min and mm.
CUTTING_DATA = ("teeth", "cutting_speed", "feed_per_tooth")


def rates_from_cutting_data(diameter: float, stated: Mapping[str, Any]) -> dict[str, float]:
    """Spindle speed and feed rate of a tool, as stated or from its cutting data.

    Parameters
    ----------
    diameter : float
        Nominal diameter, mm.  A ball end that leans cuts on a smaller circle than this, and slower than stated.
    stated : mapping
        Of "spindle" (rev/min), "feedrate" (mm/min), "teeth", "cutting_speed" (m/min) and "feed_per_tooth" (mm)
        those that are known.

    Returns
    -------
    dict
        "spindle" = 1000 v_c / (pi D) and "feedrate" = f_z z n, those that can be had.

    Raises
    ------
    InvalidInput
        When a quantity is stated twice, what it needs is missing, or a number is not above zero.
    """
    rates = {name: positive(name, stated[name], unit)
             for name, unit in (("spindle", "rev/min"), ("feedrate", "mm/min")) if stated.get(name) is not None}
    speed, feed, teeth = (stated.get(name) for name in ("cutting_speed", "feed_per_tooth", "teeth"))
    for name, data, value in (("spindle", "cutting_speed", speed), ("feedrate", "feed_per_tooth", feed)):
        if value is not None and name in rates:
            raise InvalidInput(f"both {name} and {data} are given: leave out one of them")
    if teeth is not None and (isinstance(teeth, bool) or not isinstance(teeth, int) or teeth < 1):
        raise InvalidInput(f"number of teeth is {teeth!r}: it must be a whole number from 1")
    if speed is not None:
        rates["spindle"] = 1000 * positive("cutting speed", speed, "m/min") / (pi * diameter)
    if feed is not None:
        if teeth is None:
            raise InvalidInput("feed_per_tooth is given without teeth: state the number of teeth")
        if "spindle" not in rates:
            raise InvalidInput("feed_per_tooth is given without a speed: state spindle or cutting_speed")
        rates["feedrate"] = positive("feed per tooth", feed) * teeth * rates["spindle"]
    return rates
