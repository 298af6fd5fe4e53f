"""Strip width: how far to the left and right of its contact a swept cutter leaves less than the scallop height.

The cutter is placed by [zhu2016] Eq. (1), with fixed axis, at all contacts of the pass: the iso-curve for feed "u" or
"v", the normal section along the feed for a vector.  The half width reaches from the contact to the first p whose
p + (h + A) n(p) lies outside all of them.  Beyond its domain the surface goes on straight ahead.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.frame import Feed
from toolaxis.contact.strip.curves import ALONG_U, ALONG_V, SECTION, OrientedSurface
from toolaxis.contact.strip.cutter_parameters import CutterParameters, cutter_parameters
from toolaxis.contact.strip.half_widths import StripContacts, StripOptions, half_widths, new_workspace
from toolaxis.errors import InvalidInput
from toolaxis.numeric.shares import share_out
from toolaxis.numeric.vectors import as_rows, axis_rows, unit
from toolaxis.progress import breathe
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool
from toolaxis.work import spend

Array = NDArray[np.float64]

#: As many bounds of distances as take as long as the half widths of no contact, those of one in the step parameter and
#: in a normal section, and one step of the march that finds them where Newton's method does not.
_QUESTION, _CONTACT, _SECTION, _STEP = 500, 40, 280, 6
#: Pairs of a contact and an axis of a share.
_AT_ONCE = 64


def kernel_inputs(face: Face, tool: Tool, scallop: float, allowance: float) -> tuple[OrientedSurface, CutterParameters]:
    """What kernels take of a face and a tool, checked."""
    sign = -1.0 if face.flip else 1.0
    surface = OrientedSurface(face.surface.data, sign)
    return surface, cutter_parameters(tool, scallop, allowance)


def kernel_contacts(uv: ArrayLike, feed: Feed, scallop: ArrayLike) -> tuple[StripContacts, int]:
    """What kernels take of contacts, with one scallop height or one each; and what the pass runs along."""
    rows = np.array(as_rows(uv, 2, "uv"), dtype=float, order="C")
    number = len(rows)
    heights = np.array(np.broadcast_to(scallop, number), dtype=float)
    if not isinstance(feed, str):
        direction = np.broadcast_to(unit(as_rows(feed, 3, "feed")), (number, 3))
        feeds = np.array(direction, order="C")
        return StripContacts(rows, feeds, heights), SECTION
    if feed not in ("u", "v"):
        raise InvalidInput(f"feed is {feed!r}: it must be 'u', 'v' or a vector")
    along = ALONG_U if feed == "u" else ALONG_V
    return StripContacts(rows, np.zeros((number, 3)), heights), along


def take_half_widths(surface: OrientedSurface, cutter: CutterParameters, contacts: StripContacts, axes: Array,
                     options: StripOptions) -> Array:
    """Half widths (k, n, 2) of n contacts with k axes, (k, n, 3) or (k, 1, 3)."""
    number = len(axes)
    out = np.empty((number, len(contacts.uv), 2))
    each = _SECTION if options.normal_section else _CONTACT
    spend(_QUESTION + each * out.shape[0] * out.shape[1])

    def _take(some: slice) -> None:
        rows = axes[:, some] if axes.shape[1] > 1 else axes
        rows = np.array(rows, order="C")
        widths = np.empty((number, some.stop - some.start, 2))
        part = StripContacts(*(each[some] for each in contacts))
        work = new_workspace(number)
        steps[some.start] = half_widths(surface, cutter, part, rows, options, work, widths)
        out[:, some] = widths

    steps: dict[int, float] = {}
    size = max(1, _AT_ONCE // number)
    for some in share_out(_take, len(contacts.uv), size):
        breathe()
        spend(_STEP * steps[some.start])
    return out


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
    curvature has a swept width too, which is given: judge gouging elsewhere.  A contact in a fold of the surface stands
    for the place beside it; a strip that ends behind a fold may come out too narrow or too wide.

    **Source**: swept envelope of [zhu2016] Eq. (1); the paper takes the section of the stationary cutter.

    **Properties**: 1. a rigid motion changes nothing, a mirror exchanges left and right; 2. lengths scale; 3. for
    h -> 0 the sum tends to `second_order_width`.
    """
    surface, cutter = kernel_inputs(face, tool, scallop, allowance)
    on_sound_places = face.outside_folds(as_rows(uv, 2, "uv"))
    contacts, along = kernel_contacts(on_sound_places, feed, scallop)
    axes = axis_rows(axis, len(contacts.uv))[None]
    halves = take_half_widths(surface, cutter, contacts, axes, StripOptions(along, True))[0]
    return np.asarray(halves[:, ::-1].copy())


def step_widths(face: Face, tool: Tool, uv: ArrayLike, axis: ArrayLike, scallop: float, feed: str = "u",
                allowance: float = 0.0, *, march: bool = True) -> Array:
    """Exact half widths in the step parameter, along the cross iso-curve.

    Parameters
    ----------
    face, tool, uv, axis, scallop, allowance
        As in `strip_width`.
    feed : "u" or "v"
        The parameter that varies along the pass; the step parameter is the other one.
    march : bool
        False gives 0 where Newton's method finds no exit that is confirmed: there the march takes many times as long.

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
    number = len(as_rows(uv, 2, "uv"))
    axes = unit(as_rows(axis, 3, "axis"))
    if len(axes) not in (1, number):
        raise InvalidInput(f"{len(axes)} axes for {number} contacts: give one axis, or one for each contact")
    widths = _take_step_widths(face, tool, uv, axes[None], feed, scallop, allowance, march)
    return np.asarray(widths[0])


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
    rows = unit(as_rows(axes, 3, "axes"))[:, None]
    return _take_step_widths(face, tool, uv, rows, feed, scallop, allowance)


def _take_step_widths(face: Face, tool: Tool, uv: ArrayLike, axes: Array, feed: str, scallop: float,
                      allowance: float, march: bool = True) -> Array:
    if not isinstance(feed, str):
        raise InvalidInput("step widths need feed 'u' or 'v': a vector has no step parameter")
    surface, cutter = kernel_inputs(face, tool, scallop, allowance)
    asked = as_rows(uv, 2, "uv")
    contacts, along = kernel_contacts(face.outside_folds(asked), feed, scallop)
    options = StripOptions(along, False, march=march)
    widths = take_half_widths(surface, cutter, contacts, axes, options)
    # Contacts in folds stand for the places beside them: by so much their half widths end elsewhere.
    moved = (asked - contacts.uv)[:, 1 - along, None]
    from_asked = widths + moved * np.array([1.0, -1.0])
    return np.where(widths > 0.0, np.maximum(from_asked, 0.0), 0.0)
