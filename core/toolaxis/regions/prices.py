"""What it costs to cut cells: the strip width of the best feed at each of them.

The time that a cell takes is its area over the width and the feed rate.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.strip.cutter_parameters import CAP, CutterParameters
from toolaxis.contact.strip.second_order import relative_forms
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.path.width_correction import lean_ratios, lean_table, screening_cutter
from toolaxis.regions.cells import FaceCells
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Axes that are looked at together.
_TOGETHER = 64


def widths(cells: FaceCells, tools: Sequence[Tool], axes: ArrayLike, scallop: float, allowance: float = 0.0,
           greatest_step_over: float = np.inf) -> Array:
    """Strip widths at the contacts of cells in the feed direction that has the widest, mm.

    Parameters
    ----------
    cells : FaceCells
    tools : sequence of Tool
    axes : (k, 3) array_like
        Tool axes, tip to spindle.
    scallop, allowance, greatest_step_over : float
        mm; no strip is wider than the last.

    Returns
    -------
    (tools, k, n) array
        0 where the face is hollow tighter than the cutter, or the contact is not on its bottom or corner.

    Raises
    ------
    InvalidInput
        When the scallop height is not above zero and below the radius of every tool.

    Notes
    -----
    To the second order the width is sqrt(8 h k . D^-1 k) with D the difference of the second forms of cutter and face
    and k the way from pass to pass: widest along the eigenvector of D's smaller eigenvalue.  As a flat bottom, and no
    curvature, limits it near the normal, it is corrected by the ratio that the exact width has on a plane.

    **Properties**: 1. moving face and axes together changes nothing; 2. all lengths scale.
    """
    rows = np.asarray(unit(as_rows(axes, 3, "axes")))
    forms = _forms_of(cells)
    found = np.empty((len(tools), len(rows), len(cells)))
    for number, tool in enumerate(tools):
        for first in range(0, len(rows), _TOGETHER):
            some = slice(first, first + _TOGETHER)
            found[number, some] = _widest(forms, tool, rows[some], (scallop, allowance))
    return np.minimum(found, greatest_step_over)


def fits_hollows(cells: FaceCells, tool: Tool, axes: ArrayLike, scallop: float, allowance: float = 0.0) -> Bools:
    """Whether a tool bends more than the face at the contacts of cells: else it leaves no strip there, (k, n).

    Parameters
    ----------
    cells : FaceCells
    tool : Tool
    axes : (k, 3) array_like
        Tool axes, tip to spindle.
    scallop, allowance : float
        mm
    """
    return np.asarray(_least_bend(_forms_of(cells), unit(as_rows(axes, 3, "axes")),
                                  screening_cutter(tool, scallop, allowance))[0] > 0)


def _forms_of(cells: FaceCells) -> Array:
    """Tangents along and across, normals, and second fundamental forms in their frame, (n, 12)."""
    return np.column_stack([cells.tangent, np.cross(cells.normal, cells.tangent), cells.normal, cells.form])


def _least_bend(forms: Array, axes: Array, cutter: CutterParameters) -> tuple[Array, Array, Array, Array]:
    """Smaller eigenvalue of the difference of the second forms of cutter and face, (k, n), and its three entries."""
    along, across = (axes @ forms[:, first:first + 3].T for first in (0, 3))
    ff, fk, kk = relative_forms(forms, (along, across), cutter)
    return (ff + kk) / 2 - np.hypot((ff - kk) / 2, fk), ff, fk, kk


def _widest(forms: Array, tool: Tool, axes: Array, heights: tuple[float, float]) -> Array:
    """Widths for one tool, (k, n)."""
    scallop, allowance = heights
    cutter, table = screening_cutter(tool, scallop, allowance), lean_table(tool, scallop)
    along, across, up = (axes @ forms[:, first:first + 3].T for first in (0, 3, 6))
    least, ff, fk, kk = _least_bend(forms, axes, cutter)
    turn = np.arctan2(2 * fk, ff - kk) / 2  # of the eigenvector of the larger eigenvalue: the feed
    cosine, sine = np.cos(turn), np.sin(turn)
    free = (least > 0) & (up >= cutter.sin - 1e-9)
    half = np.minimum(np.sqrt(2 * scallop / np.where(free, least, 1.0)), CAP * tool.radius)
    half *= lean_ratios(table, cosine * along + sine * across, cosine * across - sine * along)
    return np.asarray(np.where(free, 2 * half, 0.0))
