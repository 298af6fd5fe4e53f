"""What it costs to cut cells: the strip width of the best feed at each of them.

The time that a cell takes is its area over the width and the feed rate.
"""

from collections.abc import Sequence
from typing import NamedTuple

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
            block = slice(first, first + _TOGETHER)
            found[number, block] = _widest(forms, tool, rows[block], scallop, allowance)
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
    rows = unit(as_rows(axes, 3, "axes"))
    cutter = screening_cutter(tool, scallop, allowance)
    forms = _forms_of(cells)
    difference = _second_forms(forms, _in_frames(forms, rows), cutter)
    return np.asarray(difference.least > 0)


def _forms_of(cells: FaceCells) -> Array:
    """Tangents along and across, normals, and second fundamental forms in their frame, (n, 12)."""
    return np.column_stack([cells.tangent, np.cross(cells.normal, cells.tangent), cells.normal, cells.form])


class _AxesInFrames(NamedTuple):
    """Components of axes along the tangent, across it and along the normal of each cell, (k, n) each."""

    along: Array
    across: Array
    up: Array


def _in_frames(forms: Array, axes: Array) -> _AxesInFrames:
    along = axes @ forms[:, 0:3].T
    across = axes @ forms[:, 3:6].T
    up = axes @ forms[:, 6:9].T
    return _AxesInFrames(along, across, up)


class _FormDifference(NamedTuple):
    """The second form of a cutter less that of the face, by axes and cells, (k, n) each, 1/mm.

    Its entries along the tangent, mixed and across, and its smaller eigenvalue.
    """

    ff: Array
    fk: Array
    kk: Array
    least: Array


def _second_forms(forms: Array, axis: _AxesInFrames, cutter: CutterParameters) -> _FormDifference:
    ff, fk, kk = relative_forms(forms, (axis.along, axis.across), cutter)
    least = (ff + kk) / 2 - np.hypot((ff - kk) / 2, fk)
    return _FormDifference(ff, fk, kk, least)


def _widest(forms: Array, tool: Tool, axes: Array, scallop: float, allowance: float) -> Array:
    """Widths for one tool, (k, n)."""
    cutter = screening_cutter(tool, scallop, allowance)
    axis = _in_frames(forms, axes)
    difference = _second_forms(forms, axis, cutter)
    leaves_strip = (difference.least > 0) & (axis.up >= cutter.sin - 1e-9)
    least = np.where(leaves_strip, difference.least, 1.0)
    half = np.minimum(np.sqrt(2 * scallop / least), CAP * tool.radius)
    # The feed is the eigenvector of the larger eigenvalue.
    turn = np.arctan2(2 * difference.fk, difference.ff - difference.kk) / 2
    cosine, sine = np.cos(turn), np.sin(turn)
    along_feed = cosine * axis.along + sine * axis.across
    across_feed = cosine * axis.across - sine * axis.along
    half *= lean_ratios(lean_table(tool, scallop), along_feed, across_feed)
    return np.asarray(np.where(leaves_strip, 2 * half, 0.0))
