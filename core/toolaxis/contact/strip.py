"""Strip width: how far to the left and right of its contact a swept cutter leaves less than the scallop height.

The cutter is placed by [zhu2016] Eq. (1), with fixed axis, at all contacts of the pass: the iso-curve for feed "u" or
"v", the normal section along the feed for a vector.  The half width reaches from the contact to the first p whose
p + (h + A) n(p) lies outside all of them.  Beyond its domain the surface goes on straight ahead.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.curves import (
    ALONG_U,
    ALONG_V,
    SECTION,
    Curve,
    Scratch,
    curve_length,
    iso_curve,
    new_scratch,
    normal_rates,
    plane_section,
)
from toolaxis.contact.exit import Job, Lengths, Memory, Road, confirmed, march_exit, newton_exit
from toolaxis.contact.frame import Feed
from toolaxis.contact.second_order import compliance, surface_form
from toolaxis.contact.sizes import CAP, cutter_numbers
from toolaxis.contact.swept import SIDE_NODES, lay_pass, new_memory
from toolaxis.errors import InvalidInput
from toolaxis.numeric.bspline import SurfaceData, surface_derivatives
from toolaxis.numeric.compiled import compiled
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.shape.face import Face
from toolaxis.tools.assembly import Tool

Array = NDArray[np.float64]
Geometry: TypeAlias = tuple[SurfaceData, float, Array]
"""Surface, sign of its normal, cutter."""
Sizes: TypeAlias = tuple[float, float, float]
"""Scallop height h, lift h + allowance, radius of the tool, mm."""

WINDOW = 2.5
"""Length of the pass on either side of the contact that counts, in radii of the tool."""
SPACING = 1 / 8
"""Distance of the nodes of the pass, in radii of the tool."""


@compiled
def _frame_at(surface: SurfaceData, sign: float, contact: Array, scratch: Scratch, frame: Array) -> bool:
    """Rows feed, left, normal into frame; contact = (u, v, feed code, vector); False where there is no feed."""
    d, basis, rates, _ = scratch
    surface_derivatives(surface, contact[0], contact[1], d, basis)
    normal_rates(d, sign, rates)
    dot = size = whole = 0.0
    for c in range(3):
        frame[2, c] = rates[0, c]
        frame[0, c] = d[1, c] if contact[2] == ALONG_U else d[2, c] if contact[2] == ALONG_V else contact[3 + c]
        dot += frame[0, c] * frame[2, c]
        whole += frame[0, c] ** 2
    for c in range(3):
        frame[0, c] -= dot * frame[2, c]
        size += frame[0, c] ** 2
    size = np.sqrt(size)
    if not size > 1e-9 * np.sqrt(whole):
        return False
    for c in range(3):
        frame[0, c] /= size
    for c in range(3):
        a, b = (c + 1) % 3, (c + 2) % 3
        frame[1, c] = frame[2, a] * frame[0, b] - frame[2, b] * frame[0, a]
    return True


@compiled
def _side_exit(job: Job, lengths: Lengths, start: tuple[float, float, float, float], bench: tuple[Road, Memory, Array],
               stride: float) -> float:
    """s of the exit on one side; start = (s0, w0, s, w), with s = s0 where there is no guess.

    bench = (road, memory, room), where room (2, 3) holds the contact in its second row.
    """
    road, memory, room = bench
    s0, w0, s, w = start
    if s != s0:
        table = road[0]
        low, high = max(SIDE_NODES - 1, road[2]), min(SIDE_NODES + 1, road[3])
        for c in range(3):
            room[0, c] = (table[high, 4 + c] - table[low, 4 + c]) / (table[high, 0] - table[low, 0])
        solved, s, w = newton_exit(job, lengths, start, room[0], memory)
        if solved and confirmed(job, lengths, (s0, w0, s, w), road, memory):
            far = 0.0
            for c in range(3):
                far += (memory[2][0, c] - room[1, c]) ** 2
            if far < (0.9 * lengths[2]) ** 2:
                return s
    return march_exit(job, lengths, (s0, stride), road, memory)


@compiled
def _curves(surface: SurfaceData, contact: Array, frame: Array, node: float, scratch: Scratch) -> tuple[Curve, Curve]:
    """Pass and cross curve of a contact; in the step parameter where contact[6] is 0, else along normal sections."""
    u, v, code = contact[0], contact[1], int(contact[2])
    if code == SECTION:
        return (plane_section(surface, u, v, (frame[0], frame[1], node), scratch),
                plane_section(surface, u, v, (frame[1], frame[0], node), scratch))
    road = iso_curve(code, v if code == ALONG_U else u)
    if contact[6] == 0.0:
        return road, iso_curve(ALONG_V if code == ALONG_U else ALONG_U, u if code == ALONG_U else v)
    return road, plane_section(surface, u, v, (frame[1], frame[0], node), scratch)


@compiled
def _guesses(job: Job, contact: Array, frame: Array, h: float, memory: Memory) -> tuple[float, float, float, float]:
    """Steps to the second-order exit: half width in mm, in s, and advance in w on the upper side; zeros if none."""
    (_, _, cutter, axis), _, cross = job
    d = memory[3][0]
    rest, ahead, free = compliance(surface_form(d, frame), frame, cutter, axis)
    if not free:
        return 0.0, 0.0, 0.0, 0.0
    pace = c_f = c_k = 0.0
    for c in range(3):
        if contact[2] == SECTION:
            pace = 1.0
        else:
            pace += d[1 + int(contact[2]), c] * frame[0, c]
        if cross[0] == SECTION:
            c_k = 1.0
        else:
            c_f += d[1 + cross[0], c] * frame[0, c]
            c_k += d[1 + cross[0], c] * frame[1, c]
    width = np.sqrt(2.0 * h * rest)
    radius = cutter[0] + cutter[1]
    width /= np.sqrt(1.0 + (0.5 * width / radius) ** 2)
    s = width / abs(c_k)
    return width, s, s * (c_f + ahead * c_k) / pace, c_k


@compiled
def _contact_widths(geometry: Geometry, contact: Array, axis: Array, sizes: Sizes, out: Array) -> None:
    """Half widths at one contact into out: towards lower and upper s, where s is the cross curve's parameter."""
    surface, sign, cutter = geometry
    h, lift, radius = sizes
    scratch = new_scratch()
    memory = new_memory(scratch)
    frame, room = np.empty((3, 3)), np.empty((2, 3))
    out[0] = out[1] = 0.0
    if not _frame_at(surface, sign, contact, scratch, frame):
        return
    if axis[0] * frame[2, 0] + axis[1] * frame[2, 1] + axis[2] * frame[2, 2] < cutter[3] - 1e-9:
        return
    road, cross = _curves(surface, contact, frame, 0.5 * SPACING * radius, scratch)
    job = ((surface, sign, cutter, axis), road, cross)
    surface_derivatives(surface, contact[0], contact[1], scratch[0], scratch[1])
    room[1] = scratch[0][0]
    width, s_step, w_step, _ = _guesses(job, contact, frame, h, memory)
    w0 = 0.0 if road[0] == SECTION else contact[road[0]]
    s0 = 0.0 if cross[0] == SECTION else contact[cross[0]]
    table, gaps = np.empty((2 * SIDE_NODES + 1, 7)), np.empty(2 * SIDE_NODES + 1)
    first, last = lay_pass(job[0], road, w0, (WINDOW * radius, SPACING * radius), memory, table)
    lengths = (lift, radius, CAP * radius, SPACING * radius)
    stride = 0.5 * SPACING * radius
    if width > 0.0:
        stride = min(stride, max(width / 6.0, 0.05 * stride))
    for side in range(2):
        turn = 2.0 * side - 1.0
        start = (s0, w0, s0 + turn * s_step, w0 + turn * w_step)
        s = _side_exit(job, lengths, start, ((table, gaps, first, last), memory, room), turn * stride)
        out[side] = curve_length(surface, cross, s, scratch) if contact[6] != 0.0 else abs(s - s0)


@compiled
def _widths(geometry: Geometry, contacts: Array, axes: Array, sizes: Sizes, out: Array) -> None:
    for k in range(contacts.shape[0]):
        _contact_widths(geometry, contacts[k], axes[k], sizes, out[k])


def _checked(face: Face, tool: Tool, scallop: float, allowance: float) -> tuple[Geometry, Sizes]:
    """What kernels take of a face, a tool and the heights."""
    cutter = cutter_numbers(tool, scallop, allowance)
    return (face.surface.data, -1.0 if face.flip else 1.0, cutter), (scallop, scallop + allowance, tool.radius)


def _contacts(uv: ArrayLike, feed: Feed, sections: bool) -> Array:
    """Rows of u, v, feed code, feed vector, and whether widths are taken along normal sections."""
    rows = as_rows(uv, 2, "uv")
    table = np.zeros((len(rows), 7))
    table[:, :2] = rows
    table[:, 6] = sections
    if isinstance(feed, str):
        if feed not in ("u", "v"):
            raise InvalidInput(f"feed is {feed!r}: it must be 'u', 'v' or a vector")
        table[:, 2] = ALONG_U if feed == "u" else ALONG_V
        return table
    table[:, 2] = SECTION
    table[:, 3:6] = unit(as_rows(feed, 3, "feed"))
    return table


def strip_width(face: Face, tool: Tool, uv: ArrayLike, axis: ArrayLike, scallop: float, feed: Feed = "u",
                allowance: float = 0.0) -> Array:
    """Exact half widths, left and right of the feed.

    A half width is arc length on the surface, in the plane through the contact perpendicular to the feed.

    Parameters
    ----------
    face : Face
    tool : Tool
    uv : (n, 2) array_like
        Parameters of the contacts.
    axis : (3,) or (n, 3) array_like
        Tool axis, tip to spindle.
    scallop : float
        Scallop height h, mm.
    feed : "u", "v" or (3,) or (n, 3) array_like
        The parameter that varies along the pass, or a direction, projected on the tangent planes.
    allowance : float
        Stock A left on the surface, mm.

    Returns
    -------
    (n, 2) array
        Left and right half width, mm.  0 where the contact does not lie on the cutter's bottom or arc (T below the
        tangent plane, or under the side line) or the feed has no direction.  A half width is cut off at 4 R, which
        it reaches where cutter and surface fit exactly.

    Raises
    ------
    InvalidInput
        When the scallop height is not above zero and below the tool's radius, or an array has a wrong shape.

    Notes
    -----
    Upright on a flat bottom (T = n) the tip stands on the contact, as in `placing.tips`.  A contact that gouges by
    curvature has a swept width too, which is given: judge gouging elsewhere.

    **Source**: swept envelope of [zhu2016] Eq. (1); the paper takes the section of the stationary cutter.

    **Properties**: 1. a rigid motion changes nothing, a mirror exchanges left and right; 2. lengths scale; 3. for
    h -> 0 the sum tends to `second_order_width`.
    """
    geometry, sizes = _checked(face, tool, scallop, allowance)
    contacts = _contacts(uv, feed, True)
    axes = np.ascontiguousarray(np.broadcast_to(unit(as_rows(axis, 3, "axis")), (len(contacts), 3)))
    out = np.empty((len(contacts), 2))
    _widths(geometry, contacts, axes, sizes, out)
    return out[:, ::-1].copy()


def step_widths(face: Face, tool: Tool, uv: ArrayLike, axis: ArrayLike, scallop: float, feed: str = "u",
                allowance: float = 0.0) -> Array:
    """Exact half widths in the step parameter, along the cross iso-curve.

    Parameters
    ----------
    face, tool, uv, axis, scallop, allowance
        As in `strip_width`.
    feed : "u" or "v"
        The parameter that varies along the pass; the step parameter is the other one.

    Returns
    -------
    (n, 2) array
        Half widths towards lower and towards upper step parameter, in units of it; conventions for 0 and for the
        greatest value (where the iso-curve is 4 R long) as in `strip_width`.

    Raises
    ------
    InvalidInput
        As in `strip_width`.
    """
    if not isinstance(feed, str):
        raise InvalidInput("step widths need feed 'u' or 'v': a vector has no step parameter")
    geometry, sizes = _checked(face, tool, scallop, allowance)
    contacts = _contacts(uv, feed, False)
    axes = np.ascontiguousarray(np.broadcast_to(unit(as_rows(axis, 3, "axis")), (len(contacts), 3)))
    out = np.empty((len(contacts), 2))
    _widths(geometry, contacts, axes, sizes, out)
    return out
