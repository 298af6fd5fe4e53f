"""How the exact strip width departs from the second-order one as the cutter leans: a table made on a plane.

Near the normal a cutter's flat bottom, not its curvature, limits the strip.  On a plane the ratio of the two widths
depends on the lean alone, so one table serves all contacts and axes of a tool and a scallop height.
"""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.cutter_parameters import CutterParameters, cutter_parameters
from toolaxis.contact.strip.second_order import axis_in_frame
from toolaxis.contact.strip.width import step_widths
from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.jit import jit
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

_LEANS, _TURNS = 41, 17
_LEAST, _MOST = 1e-3, 0.99999
_BLUNT = 2.0


def screening_cutter(tool: Tool, scallop: float, allowance: float = 0.0) -> CutterParameters:
    """The cutter with a corner radius of two scallop heights at least.

    To the second order a sharp corner that leans across the feed leaves no strip at all; a slightly blunt one keeps
    the ratio to the exact width within bounds.

    Parameters
    ----------
    tool : Tool
    scallop, allowance : float
        mm

    Returns
    -------
    CutterParameters
    """
    corner = max(tool.corner_radius, min(_BLUNT * scallop, tool.radius))
    sharp = cutter_parameters(tool, scallop, allowance)
    return sharp._replace(flat=tool.radius - corner, corner=corner)


def lean_table(tool: Tool, scallop: float) -> Array:
    """Ratio of the exact strip width on a plane to the second-order one of the `screening_cutter`.

    Parameters
    ----------
    tool : Tool
    scallop : float
        mm

    Returns
    -------
    (41, 17) array, even from 0 to 1 in half the sum of sqrt(sin) and 1 - cos of the angle between axis and normal,
    which is fine at both ends, and in the square root of the cosine between lean and feed; 1 where the contact is not
    on the cutter's bottom or arc.
    """
    return _table(tool.kind, tool.radius, tool.corner_radius, tool.half_angle, scallop)


@lru_cache(maxsize=64)
def _table(kind: str, radius: float, corner_radius: float, half_angle: float, scallop: float) -> Array:
    tool = Tool.build(kind, radius, corner_radius, half_angle)
    size = 40 * tool.radius
    sine, across = _grid_of_leans()
    s = sine.ravel()
    c = across.ravel()
    k = np.sqrt(1 - c**2)
    axes = np.column_stack([s * c, s * k, np.sqrt(1 - s**2)])
    middle = np.full((len(s), 2), 0.5)
    shares = step_widths(_square(size), tool, middle, axes, scallop)
    exact = size * shares.sum(axis=1)
    blunt = screening_cutter(tool, scallop)
    curvature_radius = blunt.corner + blunt.flat * c**2 / s
    second = 2 * np.sqrt(2 * scallop * curvature_radius)
    table = np.where(exact > 0, exact / second, 1.0).reshape(_LEANS, _TURNS)
    table.setflags(write=False)
    return table


def _square(size: float) -> Face:
    """A plane face with sides of one length."""
    corners = np.array([[[0, 0, 0], [0, size, 0]], [[size, 0, 0], [size, size, 0]]], dtype=float)
    return Face.from_bspline(corners, (1, 1))


def _grid_of_leans() -> tuple[Array, Array]:
    """Sines between axis and normal, and cosines between lean and feed, at the table's places, (41, 17) each."""
    dense = np.linspace(0, 1, 20001) ** 2
    places = [_place(float(s)) for s in dense]
    sine = np.interp(np.linspace(0, 1, _LEANS), places, dense)
    sine = sine.clip(_LEAST, _MOST)
    cosine = np.linspace(0, 1, _TURNS) ** 2
    sines, cosines = np.meshgrid(sine, cosine, indexing="ij")
    return sines, cosines


@jit
def _place(lean: float) -> float:
    """Place in the table, 0 to 1, of the sine of the angle between axis and normal."""
    sine = min(lean, 1.0)
    return float(0.5 * (np.sqrt(sine) + 1.0 - np.sqrt(1.0 - sine * sine)))


@jit
def lean_ratio(table: Array, along: float, across: float) -> float:
    """Ratio from the table for an axis with these components along and across the feed, by bilinear interpolation."""
    square = along * along + across * across
    if square <= 0.0:
        return float(table[0, 0])
    lean = np.sqrt(square)
    x = _place(lean) * (table.shape[0] - 1)
    y = np.sqrt(min(abs(along) / lean, 1.0)) * (table.shape[1] - 1)
    i, j = min(int(x), table.shape[0] - 2), min(int(y), table.shape[1] - 2)
    x, y = x - i, y - j
    return float((table[i, j] * (1.0 - x) + table[i + 1, j] * x) * (1.0 - y)
                 + (table[i, j + 1] * (1.0 - x) + table[i + 1, j + 1] * x) * y)


def lean_ratios(table: Array, along: Array, across: Array) -> Array:
    """Ratios for many components at once; the plain twin of `lean_ratio`.

    Parameters
    ----------
    table : (k, m) array
    along, across : array
        Components of the unit axis along the feed and to its left.
    """
    lean = np.hypot(along, across)
    sine = np.minimum(lean, 1.0)
    place = 0.5 * (np.sqrt(sine) + 1 - np.sqrt(1 - sine**2))
    x = place * (table.shape[0] - 1)
    cosine = np.abs(along) / np.where(lean > 0, lean, 1.0)
    y = np.sqrt(np.minimum(cosine, 1.0)) * (table.shape[1] - 1)
    i = np.minimum(x.astype(int), table.shape[0] - 2)
    j = np.minimum(y.astype(int), table.shape[1] - 2)
    x = x - i
    y = y - j
    low = table[i, j] * (1 - x) + table[i + 1, j] * x
    high = table[i, j + 1] * (1 - x) + table[i + 1, j + 1] * x
    return np.asarray(low * (1 - y) + high * y)


def lean_ratios_of(table: Array, forms: Array, axis: Array) -> Array:
    """Ratios from the table at contacts with one axis, (n,).

    Parameters
    ----------
    table : (k, m) array
    forms : (n, 13) array
        As of `toolaxis.contact.strip.second_order.contact_forms`.
    axis : (3,) array
        Unit vector.
    """
    if not _compiled.available:
        along = forms[:, :3] @ axis
        across = forms[:, 3:6] @ axis
        return lean_ratios(table, along, across)
    found = np.empty(len(forms))
    _fill_ratios(table, forms, axis, found)
    return found


@jit
def _fill_ratios(table: Array, forms: Array, axis: Array, out: Array) -> None:
    for i in range(out.shape[0]):
        lean = axis_in_frame(forms[i], axis)
        out[i] = lean_ratio(table, lean[0], lean[1])
