"""Both half widths at a contact: the pass, the cross curve, and the exit on either side."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.curve_tables import ROWS, SIDE, lay_bank, lay_road
from toolaxis.contact.strip.curves import (
    ALONG_U,
    ALONG_V,
    SECTION,
    Curve,
    Nodes,
    Scratch,
    curve_length,
    iso_curve,
    new_nodes,
    new_scratch,
    normal_rates,
    plane_section,
)
from toolaxis.contact.strip.cutter_parameters import CAP
from toolaxis.contact.strip.envelope_exit import Job, Lengths, Memory, Road, is_first_exit, march_exit, newton_exit
from toolaxis.contact.strip.second_order import Form, compliance, surface_form
from toolaxis.contact.strip.swept_cutter import SIDE_NODES, lay_pass, new_memory
from toolaxis.contact.strip.tabulated_exit import rapid_exit
from toolaxis.numeric.bspline import SurfaceData, surface_derivatives
from toolaxis.numeric.jit import jit

Array = NDArray[np.float64]
Geometry: TypeAlias = tuple[SurfaceData, float, Array]
"""Surface, sign of its normal, cutter."""
Bench: TypeAlias = tuple[Road, Memory, Array, Array, tuple[Nodes, Nodes], Array]
"""Room for the pass, for one point, for three vectors, for the frame, and for two plane sections; steps taken, (1,)."""
MARCH = 2.0
"""Added to a contact's last number it forbids Newton's method, to compare the two ways."""
SOFT = 10.0
"""Least corner radius of first guesses, in scallop heights."""
Sizes: TypeAlias = tuple[float, float, float]
"""Scallop height h, lift h + allowance, radius of the tool, mm."""

WINDOW = 2.5
"""Length of the pass on either side of the contact that counts, in radii of the tool."""
CAREFUL = 40
"""As many steps of the march as take as long as what comes before it at a contact."""
SPACING = 1 / 6
"""Distance of the nodes of the pass, in radii of the tool."""
NODE = 1 / 16
"""Distance of the nodes of a plane section, in radii of the tool."""
STRIDE = 1 / 16
"""Longest step of the march, in radii of the tool."""


@jit
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


@jit
def _side_exit(job: Job, lengths: Lengths, start: tuple[float, float, float, float], bench: Bench,
               stride: float) -> float:
    """s of the exit on one side; start = (s0, w0, s, w), with s = s0 where there is no guess."""
    road, memory, room, _, _, steps = bench
    s0, w0, s, w = start
    if s != s0:
        table = road[0]
        low, high = max(SIDE_NODES - 1, road[2]), min(SIDE_NODES + 1, road[3])
        for c in range(3):
            room[0, c] = (table[high, 4 + c] - table[low, 4 + c]) / (table[high, 0] - table[low, 0])
        solved, s, w = newton_exit(job, lengths, start, room, memory)
        if solved and is_first_exit(job, lengths, (s0, w0, s, w), road, memory):
            far = 0.0
            for c in range(3):
                far += (memory[2][0, c] - room[1, c]) ** 2
            if far < (0.9 * lengths[2]) ** 2:
                return s
    s, taken = march_exit(job, lengths, (s0, stride), road, memory)
    steps[0] += taken
    return s


@jit
def _curves(surface: SurfaceData, contact: Array, frame: Array, node: float,
            rooms: tuple[Nodes, Nodes, Scratch]) -> tuple[Curve, Curve]:
    """Pass and cross curve of a contact; in the step parameter where contact[6] is even, else along normal sections."""
    u, v, code = contact[0], contact[1], int(contact[2])
    ahead, across, scratch = rooms
    if code == SECTION:
        road = plane_section(surface, (u, v, node), (frame[0], frame[1]), ahead, scratch)
    else:
        road = iso_curve(code, v if code == ALONG_U else u, frame, ahead)
    if code == SECTION or contact[6] % 2.0 == 1.0:
        return road, plane_section(surface, (u, v, node), (frame[1], frame[0]), across, scratch)
    return road, iso_curve(ALONG_V if code == ALONG_U else ALONG_U, u if code == ALONG_U else v, frame, across)


@jit
def _guess(form: Form, frame: Array, cutter: Array, axis: Array, h: float) -> tuple[float, float]:
    """Second-order half width, mm, drawn in below 2 R, and advance along the feed per mm to the left; zeros if none.

    A corner sharper than the height is taken as rounder: sideways of the lean it cuts like a wedge, not a parabola.
    """
    radius = cutter[0] + cutter[1]
    round_off = max(cutter[1], min(SOFT * h, 0.5 * radius))
    rest, ahead, free = compliance(form, frame, (radius - round_off, round_off, cutter[2], cutter[3]), axis)
    if not free:
        return 0.0, 0.0
    width = np.sqrt(2.0 * h * rest)
    return width / np.sqrt(1.0 + (0.5 * width / radius) ** 2), ahead


@jit
def _paces(contact: Array, frame: Array, d: Array) -> tuple[float, float, float]:
    """Rate of the pass along the feed, and of the cross curve along the feed and to the left."""
    if contact[2] == SECTION:
        return 1.0, 0.0, 1.0
    along = int(contact[2])
    pace = c_f = c_k = 0.0
    for c in range(3):
        pace += d[1 + along, c] * frame[0, c]
        c_f += d[2 - along, c] * frame[0, c]
        c_k += d[2 - along, c] * frame[1, c]
    if contact[6] % 2.0 == 1.0:
        return pace, 0.0, 1.0
    return pace, c_f, c_k


@jit
def contact_widths(geometry: Geometry, contact: Array, axis: Array, sizes: Sizes, bench: Bench) -> tuple[float, float]:
    """Half widths at one contact: towards lower and upper s, the cross curve's parameter."""
    surface, sign, cutter = geometry
    h, lift, radius = sizes
    (table, gaps, _, _), memory, room, frame, rooms, steps = bench
    d = memory[3][0]
    steps[0] += CAREFUL
    if not _frame_at(surface, sign, contact, memory[3], frame):
        return 0.0, 0.0
    if axis[0] * frame[2, 0] + axis[1] * frame[2, 1] + axis[2] * frame[2, 2] < cutter[3] - 1e-9:
        return 0.0, 0.0
    road, cross = _curves(surface, contact, frame, radius * NODE, (rooms[0], rooms[1], memory[3]))
    job = ((surface, sign, cutter, axis), road, cross)
    surface_derivatives(surface, contact[0], contact[1], d, memory[3][1])
    room[1, 0], room[1, 1], room[1, 2] = d[0, 0], d[0, 1], d[0, 2]
    pace, c_f, c_k = _paces(contact, frame, d)
    width, ahead = _guess(surface_form(d, frame), frame, cutter, axis, h)
    s_step = width / abs(c_k) if c_k != 0.0 else 0.0
    w_step = s_step * (c_f + ahead * c_k) / pace
    w0 = 0.0 if road[0] == SECTION else contact[road[0]]
    s0 = 0.0 if cross[0] == SECTION else contact[cross[0]]
    first, last = lay_pass(job[0], road, (w0, WINDOW * radius, SPACING * radius), memory, table)
    lengths = (lift, radius, CAP * radius, SPACING * radius)
    stride = STRIDE * radius
    if width > 0.0:
        stride = min(stride, max(width / 6.0, 0.05 * stride))
    if contact[6] >= MARCH:
        s_step = 0.0
    found = ((table, gaps, first, last), memory, room, frame, rooms, steps)
    low = _side_exit(job, lengths, (s0, w0, s0 - s_step, w0 - w_step), found, -stride)
    high = _side_exit(job, lengths, (s0, w0, s0 + s_step, w0 + w_step), found, stride)
    if contact[6] % 2.0 == 1.0:
        return curve_length(surface, cross, low, memory[3]), curve_length(surface, cross, high, memory[3])
    return abs(low - s0), abs(high - s0)


@jit
def new_bench() -> Bench:
    road = (np.empty((2 * SIDE_NODES + 1, 7)), np.empty((2 * SIDE_NODES + 1, 2)), 0, 0)
    return (road, new_memory(new_scratch()), np.empty((3, 3)), np.empty((3, 3)), (new_nodes(), new_nodes()),
            np.zeros(1))


@jit
def section_widths(geometry: Geometry, contacts: Array, axes: Array, sizes: Sizes, out: Array) -> float:
    """Half widths at n contacts into out (n, 2), towards lower and upper parameter of the cross curves; steps taken."""
    bench = new_bench()
    for k in range(contacts.shape[0]):
        out[k, 0], out[k, 1] = contact_widths(geometry, contacts[k], axes[k], sizes, bench)
    return float(bench[5][0])


@jit
def step_half_widths(geometry: Geometry, contacts: Array, axes: Array, sizes: Sizes, out: Array) -> float:
    """Half widths in the step parameter at n contacts with k axes each into out (k, n, 2); steps taken with care.

    axes is (k, n, 3), or (k, 1, 3) where the axes are the same for all contacts.
    """
    surface, sign, cutter = geometry
    h, lift, radius = sizes
    bench = new_bench()
    d, frame = bench[1][3][0], bench[3]
    road, bank = np.empty((ROWS, 13)), np.empty((ROWS, 8))
    tables = (cutter, road, bank, np.empty((6, 3)), np.empty((6, 26)))
    guesses = np.empty((axes.shape[0], 2))
    bank[SIDE, 7] = lift
    for j in range(contacts.shape[0]):
        contact = contacts[j]
        u, v, along = contact[0], contact[1], int(contact[2])
        if not _frame_at(surface, sign, contact, bench[1][3], frame):
            out[:, j] = 0.0
            continue
        pace, c_f, c_k = _paces(contact, frame, d)
        form = surface_form(d, frame)
        widest = 0.0
        for i in range(axes.shape[0]):
            guesses[i] = _guess(form, frame, cutter, axes[i, j if axes.shape[1] > 1 else 0], h)
            widest = max(widest, guesses[i, 0])
        if c_k == 0.0:
            widest = 0.0
        w0, s0 = (u, v) if along == ALONG_U else (v, u)
        rows = (SIDE, SIDE, SIDE, SIDE)
        if widest > 0.0:
            length = min(1.4 * widest * np.sqrt(c_f * c_f + c_k * c_k) / abs(c_k), CAP * radius)
            first, last = lay_road(surface, (sign, along, s0, w0), (radius, cutter[5], WINDOW * radius), road)
            low = lay_bank(surface, (sign, 1 - along, w0, s0), (radius, lift, length), bank, (SIDE, -1))
            high = lay_bank(surface, (sign, 1 - along, w0, s0), (radius, lift, length), bank, (SIDE, 1))
            rows = (first, last, low, high)
        for i in range(axes.shape[0]):
            axis = axes[i, j if axes.shape[1] > 1 else 0]
            done = 0
            if guesses[i, 0] > 0.0 and widest > 0.0:
                s_step = guesses[i, 0] / abs(c_k)
                w_step = s_step * (c_f + guesses[i, 1] * c_k) / pace
                for side in range(2):
                    turn = 2.0 * side - 1.0
                    found, s = rapid_exit(surface, tables, (axis[0], axis[1], axis[2]), (sign, along, u, v, radius),
                                          ((turn * s_step, turn * w_step), rows))
                    out[i, j, side] = abs(s - s0)
                    done += 1 if found else 0
            if done < 2:
                out[i, j, 0], out[i, j, 1] = contact_widths(geometry, contact, axis, sizes, bench)
    return float(bench[5][0])
