"""The box that a part is cut from, and the point of it, or of the part, at which programs have their origin."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput

Array = NDArray[np.float64]

#: Greatest margin, mm: what is more was typed by mistake.
MOST_MARGIN = 1000.0
#: Bodies whose box may carry the origin, and how sentences name them.
BODIES = {"part": "the part", "stock": "the stock"}
#: Points of a box: the side in x, y and z, -1 for the lower one, 0 for the middle; left is -x, front is -y.
PLACES = {"top": (0, 0, 1), "top-front-left": (-1, -1, 1), "top-front-right": (1, -1, 1), "top-back-left": (-1, 1, 1),
          "top-back-right": (1, 1, 1), "middle": (0, 0, 0), "bottom": (0, 0, -1), "bottom-front-left": (-1, -1, -1),
          "bottom-front-right": (1, -1, -1), "bottom-back-left": (-1, 1, -1), "bottom-back-right": (1, 1, -1)}
_POINT = "point"


@dataclass(frozen=True)
class StockBox:
    """The box that a part is cut from, along the axes of the part's frame.

    Attributes
    ----------
    low, high : (float, float, float)
        Corners, mm.
    """

    low: tuple[float, float, float]
    high: tuple[float, float, float]

    @classmethod
    def around(cls, box: ArrayLike, margins: Sequence[float]) -> "StockBox":
        """The box around a part with margins.

        Parameters
        ----------
        box : (2, 3) array_like
            Lower and upper corner of the part, mm.
        margins : six floats
            On the sides -x, +x, -y, +y, -z and +z, mm.
        """
        low, high = np.asarray(box, dtype=float)
        below, above = np.reshape(margins, (3, 2)).T
        return cls(_triple(low - below), _triple(high + above))

    @property
    def size(self) -> tuple[float, float, float]:
        """Lengths along x, y and z, mm."""
        return _triple(np.subtract(self.high, self.low))


def _triple(values: ArrayLike) -> tuple[float, float, float]:
    x, y, z = np.asarray(values, dtype=float).tolist()
    return x, y, z


def parse_margins(given: Sequence[float] | float | str | None) -> tuple[float, ...]:
    """Margins of the stock around a part.

    Parameters
    ----------
    given : float, sequence of float, text such as "2" or "1,1,1,1,0,2", or None
        mm: one for all sides, or six for -x, +x, -y, +y, -z and +z; nothing, or an empty text, for no stock.

    Returns
    -------
    tuple of float
        Six margins, or none.

    Raises
    ------
    InvalidInput
        When there are neither one nor six numbers, or one is out of range.
    """
    if given is None or (isinstance(given, str) and not given.strip()):
        return ()
    rows: Sequence[float | str] = given.split(",") if isinstance(given, str) else (
        given if isinstance(given, Sequence) else [given])
    try:
        values = [float(row) for row in rows]
    except (TypeError, ValueError):
        values = []
    values = values * 6 if len(values) == 1 else values
    if len(values) != 6:
        raise InvalidInput(f"margins of the stock {given!r} are not understood: give one number for all sides, or six "
                           "for -x, +x, -y, +y, -z and +z, in mm")
    for value in values:
        if not (isfinite(value) and 0 <= value <= MOST_MARGIN):
            raise InvalidInput(f"margin of the stock is {value} mm: it must be zero or more, and at most "
                               f"{MOST_MARGIN:g} mm")
    return tuple(values)


def format_margins(margins: Sequence[float]) -> str:
    """Margins in their short form, "2" or "1,1,1,1,0,2"; empty for none.

    Parameters
    ----------
    margins : sequence of float
        As `parse_margins` gives them.
    """
    return ",".join(f"{value:.12g}" for value in (margins[:1] if len(set(margins)) == 1 else margins))


def parse_origin(text: str) -> tuple[str, str | tuple[float, float, float]] | None:
    """The body and the place that a short form of an origin names.

    Parameters
    ----------
    text : str
        "stock:top-front-left", "part:top", "point:1,2,3"; empty for none.

    Returns
    -------
    (str, str) or (str, (x, y, z)) or None
        The second for a point, mm.

    Raises
    ------
    InvalidInput
        When the text is not of that form.
    """
    plain = "".join(str(text).lower().split())
    if not plain:
        return None
    body, _, place = plain.partition(":")
    if body in BODIES and place in PLACES:
        return body, place
    if body == _POINT:
        try:
            values = [float(number) for number in place.split(",")]
        except ValueError:
            values = []
        if len(values) == 3 and all(map(isfinite, values)):
            return _POINT, _triple(values)
    raise InvalidInput(f"origin {text!r} is not understood: write part:top, stock:top-front-left or the like with "
                       "middle, bottom, back and right, or point:X,Y,Z with a point of the part in mm")


def check_origin(text: str, margins: Sequence[float]) -> None:
    """Check an origin, and that there is stock where it is a point of that.

    Parameters
    ----------
    text : str
        Its short form.
    margins : sequence of float
        Those of the stock; none where there is none.

    Raises
    ------
    InvalidInput
    """
    found = parse_origin(text)
    if found is not None and found[0] == "stock" and not margins:
        raise InvalidInput(f"origin {text!r} is a point of the stock and there is none: give the margins of the stock, "
                           "or choose a point of the part")


def locate_origin(text: str, box: ArrayLike, margins: Sequence[float]) -> Array:
    """Where an origin is, (3,) mm.

    Parameters
    ----------
    text : str
        Its short form.
    box : (2, 3) array_like
        Lower and upper corner of the part, mm.
    margins : sequence of float
        Those of the stock.

    Raises
    ------
    InvalidInput
        When there is no such point.

    **Properties**: 1. it moves along with the box; 2. opposite corners have the middle between them.
    """
    check_origin(text, margins)
    found = parse_origin(text)
    if found is None:
        return np.zeros(3)
    body, place = found
    if not isinstance(place, str):
        return np.array(place)
    around = StockBox.around(box, margins if body == "stock" else (0.0,) * 6)
    low, high = np.array(around.low), np.array(around.high)
    return np.asarray(low + (high - low) * (1 + np.array(PLACES[place])) / 2)


def describe_origin(text: str) -> str:
    """An origin in words, "front left corner of the top of the stock"; empty for none.

    Parameters
    ----------
    text : str
        Its short form.
    """
    found = parse_origin(text)
    if found is None:
        return ""
    body, place = found
    if not isinstance(place, str):
        return "a point selected on the part"
    level, _, corner = place.partition("-")
    if level == "middle":
        return f"middle of {BODIES[body]}"
    which = f"{corner.replace('-', ' ')} corner" if corner else "middle"
    return f"{which} of the {level} of {BODIES[body]}"
