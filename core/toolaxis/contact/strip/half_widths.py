"""Both half widths at contacts: the pass, the cross curve, and the exit on either side."""

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.contact.strip.curve_tables import CurveNodes, new_curve_nodes, tabulate_curve
from toolaxis.contact.strip.curves import (
    ALONG_U,
    ALONG_V,
    SECTION,
    OrientedSurface,
    Scratch,
    SectionNodes,
    SurfaceCurve,
    arc_length,
    curve_point,
    new_scratch,
    new_section_nodes,
    start_section,
)
from toolaxis.contact.strip.cutter_parameters import CAP, CutterParameters
from toolaxis.contact.strip.march import WINDOW, PassTips, exit_by_marching, new_pass_tips
from toolaxis.contact.strip.newton import (
    BOTTOM,
    CutterSweep,
    NodeTips,
    is_first_exit,
    new_node_tips,
    place_node_tips,
    solve_exit,
)
from toolaxis.contact.strip.second_order import Form, compliance, surface_form
from toolaxis.contact.strip.swept_cutter import touches
from toolaxis.numeric.jit import jit_uncounted, jit_uncounted_inline
from toolaxis.numeric.triples import Triple, cross, dot, plus

Array = NDArray[np.float64]

#: Least corner radius of first guesses, in scallop heights.
_SOFT = 10.0
#: As many steps of the march as take as long as what comes before it.
_BEFORE_MARCH = 20
#: Distance of the nodes of a plane section, and longest step of the march, in radii of the tool.
_NODE, _STRIDE = 1 / 16, 1 / 16
#: How far the table of the cross curve reaches beyond the widest guess, and the most of the cap.
_BEYOND, _TABLE_CAP = 1.4, 0.8


class StripOptions(NamedTuple):
    """How half widths are taken."""

    feed: int
    """What the pass runs along: ALONG_U, ALONG_V, or SECTION for a vector."""
    normal_section: bool
    """Arc lengths in normal sections across the feed, instead of changes of the step parameter."""
    newton: bool = True
    """False leaves every exit to the march, to compare the two ways."""
    march: bool = True
    """False gives 0 where Newton's method finds no exit that is confirmed."""


class StripContacts(NamedTuple):
    """n contacts: parameters (n, 2), feed vectors (n, 3) where the pass follows one, and scallop heights (n,), mm."""

    uv: Array
    direction: Array
    scallop: Array


class Workspace(NamedTuple):
    """Memory for one contact after the other."""

    scratch: Scratch
    feed_section: SectionNodes
    cross_section: SectionNodes
    feed_nodes: CurveNodes
    cross_nodes: CurveNodes
    node_tips: NodeTips
    tips: PassTips
    guesses: Array
    """Half width, and advance along the feed per mm to the left, for each axis."""


class ContactFrame(NamedTuple):
    """The frame at a contact, and how the second-order exit becomes steps along the two curves."""

    feed: Triple
    left: Triple
    normal: Triple
    form: Form
    """Second fundamental form of the surface."""
    pace: float
    """Rate of the pass along the feed."""
    cross_feed: float
    cross_left: float
    """Rates of the cross curve along the feed and to the left."""


def new_workspace(axes: int) -> Workspace:
    """Memory for a number of axes."""
    return Workspace(new_scratch(), new_section_nodes(), new_section_nodes(), new_curve_nodes(), new_curve_nodes(),
                     new_node_tips(), new_pass_tips(), np.empty((axes, 2)))


@jit_uncounted_inline
def _frame_at(surface: OrientedSurface, curve: SurfaceCurve, direction: Triple, options: StripOptions,
              scratch: Scratch) -> tuple[bool, ContactFrame]:
    """The frame at the contact of an iso-curve, which is the pass unless this follows a direction.

    False where there is no feed.
    """
    at = curve_point(surface, curve, 0.0, scratch)
    d = scratch.vectors
    along = direction if options.feed == SECTION else at.tangent
    feed = plus(along, at.normal, -dot(along, at.normal))
    size = sqrt(dot(feed, feed))
    valid = size > 1e-9 * sqrt(dot(along, along))
    feed = (feed[0] / size, feed[1] / size, feed[2] / size)
    left = cross(at.normal, feed)
    pace, cross_feed, cross_left = dot(along, feed), 0.0, 1.0
    if options.feed == SECTION:
        pace = 1.0
    elif not options.normal_section:
        across = (d[2, 0], d[2, 1], d[2, 2]) if options.feed == ALONG_U else (d[1, 0], d[1, 1], d[1, 2])
        cross_feed, cross_left = dot(across, feed), dot(across, left)
    form = surface_form(d, feed, left, at.normal)
    return valid, ContactFrame(feed, left, at.normal, form, pace, cross_feed, cross_left)


@jit_uncounted_inline
def _sweep_at(surface: OrientedSurface, cutter: CutterParameters, uv: tuple[float, float], frame: ContactFrame,
              heights: tuple[float, float], options: StripOptions, work: Workspace) -> CutterSweep:
    """Pass and cross curve of a contact, whose vectors the scratch holds, with tables that reach beyond a guess.

    Parameters
    ----------
    surface, cutter, uv, frame, options, work
    heights : (lift, widest)
        Height of the cross curve's points, and the widest of the guesses, mm.
    """
    lift, widest = heights
    radius, across = cutter.flat + cutter.corner, SECTION
    if not options.normal_section:
        across = ALONG_V if options.feed == ALONG_U else ALONG_U
    pass_ = SurfaceCurve(options.feed, uv[0], uv[1], frame.left, _NODE * radius, work.feed_section)
    cross_curve = SurfaceCurve(across, uv[0], uv[1], frame.feed, _NODE * radius, work.cross_section)
    if options.feed == SECTION:
        start_section(pass_, frame.feed, work.scratch)
    if options.normal_section:
        start_section(cross_curve, frame.left, work.scratch)
    window = length = 0.0
    if widest > 0.0:
        oblique = sqrt(frame.cross_feed**2 + frame.cross_left**2) / abs(frame.cross_left)
        window, length = WINDOW * radius, min(_BEYOND * widest * oblique, _TABLE_CAP * CAP * radius)
    feed = tabulate_curve(surface, pass_, (radius, cutter.offset, window), work.feed_nodes, work.scratch)
    across_table = tabulate_curve(surface, cross_curve, (radius, lift, length), work.cross_nodes, work.scratch)
    return CutterSweep(surface, cutter, lift, feed, across_table)


@jit_uncounted
def _guess_exit(frame: ContactFrame, cutter: CutterParameters, axis: Triple, h: float) -> tuple[float, float]:
    """Second-order half width, mm, drawn in below 2 R, and advance along the feed per mm to the left; zeros if none.

    A corner sharper than the height is taken as rounder: sideways of the lean it cuts like a wedge, not a parabola.
    """
    radius = cutter.flat + cutter.corner
    corner = max(cutter.corner, min(_SOFT * h, 0.5 * radius))
    rounded = CutterParameters(radius - corner, corner, cutter.cos, cutter.sin, cutter.top, cutter.offset)
    lean = (dot(frame.feed, axis), dot(frame.left, axis), dot(frame.normal, axis))
    rest, ahead, free = compliance(frame.form, rounded, lean)
    if not free or frame.cross_left == 0.0:
        return 0.0, 0.0
    width = sqrt(2.0 * h * rest)
    return width / sqrt(1.0 + (0.5 * width / radius) ** 2), ahead


@jit_uncounted_inline
def _exit_on_side(sweep: CutterSweep, axis: Triple, guess: tuple[float, float], stride: float,
                  work: Workspace) -> tuple[float, int]:
    """s of the first exit on one side, and steps of the march; guess = (s, w), with s = 0 where there is none.

    Nothing is marched for a stride of 0.
    """
    if guess[0] != 0.0:
        for part in range(BOTTOM + 1 if sweep.cutter.flat > 0.0 else BOTTOM):
            found = solve_exit(sweep, axis, guess, part, work.node_tips, work.scratch)
            if found.found:
                if is_first_exit(sweep, axis, found, work.node_tips):
                    return found.s, 0
                break
    if stride == 0.0:
        return 0.0, 0
    s, steps = exit_by_marching(sweep, axis, stride, work.tips, work.scratch)
    return s, _BEFORE_MARCH + steps


@jit_uncounted
def half_widths(surface: OrientedSurface, cutter: CutterParameters, contacts: StripContacts, axes: Array,
                options: StripOptions, work: Workspace, out: Array) -> float:
    """Half widths at n contacts with k axes each, towards lower and higher s of the cross curves.

    Parameters
    ----------
    surface, cutter, contacts, options, work
    axes : (k, n, 3) array, or (k, 1, 3) where the axes are the same for all contacts
        Unit vectors.
    out : (k, n, 2) array
        Receives mm, or changes of the step parameter.

    Returns
    -------
    float
        Steps of the march, and what takes as long.
    """
    radius = cutter.flat + cutter.corner
    steps = 0.0
    for j in range(contacts.uv.shape[0]):
        uv, h = (contacts.uv[j, 0], contacts.uv[j, 1]), contacts.scallop[j]
        direction = (contacts.direction[j, 0], contacts.direction[j, 1], contacts.direction[j, 2])
        iso = SurfaceCurve(min(options.feed, ALONG_V), uv[0], uv[1], direction, 1.0, work.feed_section)
        valid, frame = _frame_at(surface, iso, direction, options, work.scratch)
        if not valid:
            out[:, j] = 0.0
            continue
        widest = 0.0
        for i in range(axes.shape[0]):
            row = axes[i, j if axes.shape[1] > 1 else 0]
            work.guesses[i] = _guess_exit(frame, cutter, (row[0], row[1], row[2]), h)
            widest = max(widest, work.guesses[i, 0])
        sweep = _sweep_at(surface, cutter, uv, frame, (h + cutter.offset - cutter.corner, widest), options, work)
        for i in range(axes.shape[0]):
            row = axes[i, j if axes.shape[1] > 1 else 0]
            axis, width = (row[0], row[1], row[2]), work.guesses[i, 0]
            if not touches(cutter, axis, frame.normal):
                out[i, j] = 0.0
                continue
            stride = _STRIDE * radius
            if width > 0.0:
                stride = min(stride, max(width / 6.0, 0.05 * stride))
            if not options.march:
                stride = 0.0
            s = width / abs(frame.cross_left) if width > 0.0 and options.newton else 0.0
            w = s * (frame.cross_feed + work.guesses[i, 1] * frame.cross_left) / frame.pace
            if s != 0.0:
                place_node_tips(sweep, axis, work.node_tips)
            for side in range(2):
                sign = 2.0 * side - 1.0
                s_exit, taken = _exit_on_side(sweep, axis, (sign * s, sign * w), sign * stride, work)
                steps += taken
                out[i, j, side] = abs(s_exit)
                if options.normal_section:
                    out[i, j, side] = arc_length(surface, sweep.cross.curve, s_exit, work.scratch)
    return steps
