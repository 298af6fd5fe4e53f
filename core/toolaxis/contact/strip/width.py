"""Strip width: how far to the left and right of its contact a swept cutter leaves less than the scallop height.

The cutter is placed by [zhu2016] Eq. (1), with fixed axis, at all contacts of the pass: the iso-curve for feed "u" or
"v", the normal section along the feed for a vector.  The half width reaches from the contact to the first p whose
p + (h + A) n(p) lies outside all of them.  Beyond its domain the surface goes on straight ahead.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.frame import Feed
from toolaxis.contact.strip.curves import ALONG_U, ALONG_V, SECTION
from toolaxis.contact.strip.cutter_parameters import cutter_numbers
from toolaxis.contact.strip.half_widths import Geometry, Sizes, section_widths, step_half_widths
from toolaxis.contact.strip.width_numpy import half_widths_numpy
from toolaxis.errors import InvalidInput
from toolaxis.numeric import jit as _compiled
from toolaxis.numeric.vectors import as_rows, axis_rows, unit
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool
from toolaxis.work import spend

Array = NDArray[np.float64]

#: As many bounds of distances as take as long as the half widths of no contact, those of one, and one step of the march
#: that finds them where Newton's method does not.
_QUESTION, _CONTACT, _STEP = 500, 40, 6


def _check_inputs(face: Face, tool: Tool, scallop: float, allowance: float) -> tuple[Geometry, Sizes]:
    """What kernels take of a face, a tool and the heights."""
    cutter = cutter_numbers(tool, scallop, allowance)
    return (face.surface.data, -1.0 if face.flip else 1.0, cutter), (scallop, scallop + allowance, tool.radius)


def contact_rows(uv: ArrayLike, feed: Feed, sections: bool) -> Array:
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


def _fill(geometry: Geometry, contacts: Array, axes: Array, sizes: Sizes, out: Array) -> None:
    """Half widths of n contacts with an axis each, by the kernel or by its twin with the kernel for what is left."""
    spend(_QUESTION + _CONTACT * len(contacts))
    if _compiled.available:
        spend(_STEP * section_widths(geometry, contacts, axes, sizes, out))
        return
    out[:], found = half_widths_numpy(geometry, contacts, axes, sizes)
    rest = np.empty(((~found).sum(), 2))
    spend(_STEP * section_widths(geometry, contacts[~found], axes[~found], sizes, rest))
    out[~found] = rest


def _fill_steps(geometry: Geometry, contacts: Array, axes: Array, sizes: Sizes, out: Array) -> None:
    """Half widths in the step parameter of n contacts with k axes, likewise."""
    if _compiled.available:
        spend(_QUESTION + _CONTACT * len(axes) * len(contacts))
        spend(_STEP * step_half_widths(geometry, contacts, axes, sizes, out))
        return
    for k in range(len(axes)):
        _fill(geometry, contacts, np.broadcast_to(axes[k], (len(contacts), 3)), sizes, out[k])


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
    geometry, sizes = _check_inputs(face, tool, scallop, allowance)
    contacts = contact_rows(uv, feed, True)
    axes = np.ascontiguousarray(axis_rows(axis, len(contacts)))
    out = np.empty((len(contacts), 2))
    _fill(geometry, contacts, axes, sizes, out)
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
    geometry, sizes, contacts = _step_job(face, tool, uv, feed, (scallop, allowance))
    axes = unit(as_rows(axis, 3, "axis"))
    if len(axes) not in (1, len(contacts)):
        raise InvalidInput(f"{len(axes)} axes for {len(contacts)} contacts: give one axis, or one for each contact")
    out = np.empty((1, len(contacts), 2))
    _fill_steps(geometry, contacts, np.ascontiguousarray(axes[None]), sizes, out)
    return np.asarray(out[0])


def step_widths_many_axes(face: Face, tool: Tool, uv: ArrayLike, axes: ArrayLike, scallop: float, feed: str = "u",
                          allowance: float = 0.0) -> Array:
    """Exact half widths in the step parameter of many axes at many contacts.

    Parameters
    ----------
    face, tool, uv, scallop, feed, allowance
        As in `step_widths`.
    axes : (k, 3) array_like
        Tool axes, tip to spindle.

    Returns
    -------
    (k, n, 2) array
        As `step_widths` gives for each axis.

    Raises
    ------
    InvalidInput
        As in `strip_width`.
    """
    geometry, sizes, contacts = _step_job(face, tool, uv, feed, (scallop, allowance))
    rows = np.ascontiguousarray(unit(as_rows(axes, 3, "axes"))[:, None])
    out = np.empty((len(rows), len(contacts), 2))
    _fill_steps(geometry, contacts, rows, sizes, out)
    return out


def _step_job(face: Face, tool: Tool, uv: ArrayLike, feed: str,
              heights: tuple[float, float]) -> tuple[Geometry, Sizes, Array]:
    if not isinstance(feed, str):
        raise InvalidInput("step widths need feed 'u' or 'v': a vector has no step parameter")
    geometry, sizes = _check_inputs(face, tool, *heights)
    return geometry, sizes, contact_rows(uv, feed, False)
