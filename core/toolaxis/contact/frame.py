"""The contact frame: feed, left and normal, and the tool axis as lead and tilt in it.

x = f, the unit feed; z = n, out of the material; y = n x f, to the left of the feed.
"""

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import as_rows, dot, lengths
from toolaxis.shape.face import Face

Array = NDArray[np.float64]
Feed: TypeAlias = str | ArrayLike


class Frame(NamedTuple):
    """Contact frames, right-handed rows of unit vectors (n, 3): feed x, left y = n x f, normal z."""

    feed: Array
    left: Array
    normal: Array


def contact_frame(face: Face, uv: ArrayLike, feed: Feed = "u") -> Frame:
    """Contact frames at parameters of a face.

    Parameters
    ----------
    face : Face
    uv : (n, 2) array_like
        Parameters of the contacts.
    feed : "u", "v" or (3,) or (n, 3) array_like
        The parameter that varies along the pass, in increasing sense, or a direction that is projected on the tangent
        plane.

    Raises
    ------
    InvalidInput
        When the feed has no direction in a tangent plane.
    """
    rows = as_rows(uv, 2, "uv")
    d = face.evaluate(rows)
    normal = face.normal(rows, d)
    if isinstance(feed, str):
        if feed not in ("u", "v"):
            raise InvalidInput(f"feed is {feed!r}: it must be 'u', 'v' or a vector")
        along = d.su if feed == "u" else d.sv
    else:
        along = np.broadcast_to(as_rows(feed, 3, "feed"), normal.shape)
    return frame_from_normal(normal, along)


def frame_from_normal(normal: ArrayLike, feed: ArrayLike) -> Frame:
    """Contact frames from normals and feeds, which are projected on the tangent planes.

    Parameters
    ----------
    normal : (n, 3) array_like
        Unit normals out of the material.
    feed : (3,) or (n, 3) array_like

    Raises
    ------
    InvalidInput
        When the feed has no direction in a tangent plane.
    """
    z = as_rows(normal, 3, "normal")
    along = np.broadcast_to(as_rows(feed, 3, "feed"), z.shape)
    x = along - dot(along, z)[:, None] * z
    size, whole = lengths(x), lengths(along)
    lost = np.flatnonzero(~(size > 1e-9 * whole))
    if lost.size:
        raise InvalidInput(f"feed {lost[0]} is {along[lost[0]].tolist()}: it has no direction in the tangent plane; "
                           "give one that is not along the normal")
    x = x / size[:, None]
    return Frame(x, np.cross(z, x), z)


def axis_from_lead_tilt(frame: Frame, lead: ArrayLike, tilt: ArrayLike) -> Array:
    """Tool axes from lead and tilt.

    Starting upright on the surface, T turns by `lead` about left, towards the feed, and then by `tilt` about the
    feed, towards left: T = (sin lead, cos lead sin tilt, cos lead cos tilt) in (feed, left, normal).

    Parameters
    ----------
    frame : Frame
        n contact frames.
    lead, tilt : float or (n,) array_like
        rad

    Returns
    -------
    (n, 3) array of unit axes, tip to spindle

    Notes
    -----
    **Properties**: 1. the inverse of `lead_tilt_from_axis` for |lead| < pi/2 and |tilt| <= pi;
    2. lead = tilt = 0 is the normal.

    Examples
    --------
    >>> frame = frame_from_normal([[0, 0, 1]], [1, 0, 0])
    >>> axis_from_lead_tilt(frame, 0.0, 0.0).tolist()
    [[0.0, 0.0, 1.0]]
    """
    a, b = np.asarray(lead, dtype=float)[..., None], np.asarray(tilt, dtype=float)[..., None]
    return np.asarray(np.sin(a) * frame.feed + np.cos(a) * (np.sin(b) * frame.left + np.cos(b) * frame.normal))


def lead_tilt_from_axis(frame: Frame, axis: ArrayLike) -> tuple[Array, Array]:
    """Lead and tilt of tool axes.

    Parameters
    ----------
    frame : Frame
        n contact frames.
    axis : (3,) or (n, 3) array_like
        Unit axes.

    Returns
    -------
    lead : (n,) array
        rad in [-pi/2, pi/2], positive where T leans towards the feed.
    tilt : (n,) array
        rad in (-pi, pi], positive where T leans to the left; 0 where T lies along the feed.
    """
    t = np.broadcast_to(as_rows(axis, 3, "axis"), frame.normal.shape)
    x, y, z = dot(t, frame.feed), dot(t, frame.left), dot(t, frame.normal)
    return np.arctan2(x, np.hypot(y, z)), np.arctan2(y, z)


def axis_from_lean(frame: Frame, lean: ArrayLike, direction: ArrayLike) -> Array:
    """Tool axes from the angle to the normal and the direction of the lean.

    Parameters
    ----------
    frame : Frame
        n contact frames.
    lean : float or (n,) array_like
        Angle between axis and normal, rad.
    direction : float or (n,) array_like
        Angle of the lean in the tangent plane, from the feed towards left, rad.

    Returns
    -------
    (n, 3) array of unit axes, tip to spindle
    """
    a, b = np.asarray(lean, dtype=float)[..., None], np.asarray(direction, dtype=float)[..., None]
    return np.asarray(np.cos(a) * frame.normal + np.sin(a) * (np.cos(b) * frame.feed + np.sin(b) * frame.left))
