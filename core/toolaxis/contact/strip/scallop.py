"""Scallop height, step-over and roughness: what two neighbouring passes leave between them."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.strip.curves import OrientedSurface
from toolaxis.contact.strip.cutter_parameters import CutterParameters, cutter_parameters
from toolaxis.contact.strip.half_widths import StripContacts, StripOptions
from toolaxis.contact.strip.width import kernel_contacts, take_half_widths
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

RA_SHARE = 4 / (9 * np.sqrt(3))
"""Ra of parabolic scallops over their height."""


def _heights(face: Face, cutter: CutterParameters, pair: tuple[StripContacts, StripContacts], axes: Array,
             along: int) -> Array:
    """Heights at which two contacts each reach each other: secants of the reach's square within a bracket."""
    sign = -1.0 if face.flip else 1.0
    surface = OrientedSurface(face.surface.data, sign)
    options = StripOptions(along, False)
    radius = cutter.flat + cutter.corner
    step = 1 - along
    before, behind = pair
    apart = behind.uv[:, step] - before.uv[:, step]
    low = np.zeros(len(apart))
    high = np.full(len(apart), radius)
    h = np.full(len(apart), 0.01 * radius)
    least_change = 1e-12 * radius
    for _ in range(60):
        upper = take_half_widths(surface, cutter, before._replace(scallop=h), axes[None], options)[0]
        lower = take_half_widths(surface, cutter, behind._replace(scallop=h), axes[None], options)[0]
        reach = upper[:, 1] + lower[:, 0]
        short = reach < apart
        low = np.where(short, h, low)
        high = np.where(short, high, h)
        reaches = reach > 0
        share = apart / np.where(reaches, reach, 1.0)
        secant = np.where(reaches, h * share**2, high)
        is_between = (low < secant) & (secant < high)
        ahead = np.where(is_between, secant, (low + high) / 2)
        stands = np.abs(ahead - h) <= least_change
        done = stands | (high - low <= least_change)
        if done.all():
            break
        h = np.where(done, h, ahead)
    return h


def scallop_height(face: Face, tool: Tool, uv: ArrayLike, neighbour: ArrayLike, axis: ArrayLike, feed: str = "u",
                   allowance: float = 0.0) -> Array:
    """Height left between contacts of two neighbouring passes.

    Parameters
    ----------
    face : Face
    tool : Tool
    uv, neighbour : (n, 2) array_like
        Contacts of the one pass and of the other, at the same feed parameter.
    axis : (3,) or (n, 3) array_like
        Tool axis, tip to spindle, of both.
    feed : "u" or "v"
        The parameter that varies along the passes.
    allowance : float
        Stock left on the surface, mm; the height counts from there.

    Returns
    -------
    (n,) array
        mm; the tool's radius where the passes lie so far apart that not even so much is reached.

    Raises
    ------
    InvalidInput
        When two contacts differ in the feed parameter or not in the step parameter, or an array has a wrong shape.

    Notes
    -----
    The height h at which the half widths of the two, towards each other, reach their distance; they grow like sqrt h.
    """
    first, along = kernel_contacts(uv, feed, 0.0)
    second, _ = kernel_contacts(neighbour, feed, 0.0)
    one = first.uv
    two = second.uv
    if one.shape != two.shape:
        raise InvalidInput(f"{len(one)} contacts have {len(two)} neighbours: give one for each")
    step = 1 - along
    differ_along = one[:, along] != two[:, along]
    agree_across = one[:, step] == two[:, step]
    bad = np.flatnonzero(differ_along | agree_across)
    if bad.size:
        k = bad[0]
        raise InvalidInput(f"contacts {k} are {one[k].tolist()} and {two[k].tolist()}: neighbours must "
                           f"share {feed} and differ in the other parameter")
    behind = (one[:, step] > two[:, step])[:, None]
    lower = first._replace(uv=np.where(behind, two, one))
    upper = second._replace(uv=np.where(behind, one, two))
    directions = unit(as_rows(axis, 3, "axis"))
    axes = np.broadcast_to(directions, (len(one), 3))
    cutter = cutter_parameters(tool, tool.radius / 2, allowance)
    return _heights(face, cutter, (lower, upper), axes, along)


def effective_radius(tool: Tool, lean: ArrayLike, direction: ArrayLike = 0.0) -> Array:
    """Radius of the parabola that a tilted cutter sweeps on a plane, at its lowest point.

    Parameters
    ----------
    tool : Tool
    lean : float or (n,) array_like
        Angle between axis and normal, rad.
    direction : float or (n,) array_like
        Angle omega of the lean from the feed, rad.

    Returns
    -------
    (n,) array
        r + (R - r) cos^2(omega) / sin(lean), mm; infinite upright on a flat bottom.

    Notes
    -----
    **Source**: [dong2023] Eq. (14) for omega = 0; the second-order swept width of `second_order` on a plane.
    """
    if tool.flat_radius == 0:
        shape = np.broadcast(lean, direction).shape
        corner = np.asarray(tool.corner_radius)
        return np.broadcast_to(corner, shape).astype(float)
    with np.errstate(divide="ignore"):
        by_flat = tool.flat_radius * np.cos(direction) ** 2 / np.sin(lean)
    return np.asarray(tool.corner_radius + by_flat)


def step_from_scallop(scallop: ArrayLike, radius: ArrayLike, curvature: ArrayLike = 0.0) -> Array:
    """Distance between passes along the surface for a scallop height, with circular cuts.

    Parameters
    ----------
    scallop : float or (n,) array_like
        Scallop height, mm.
    radius : float or (n,) array_like
        Radius of the cut across the feed, mm.
    curvature : float or (n,) array_like
        Normal curvature of the surface across the feed, 1/mm, positive where concave.

    Returns
    -------
    (n,) array
        Arc length, mm.  Exact for a ball on planes, cylinders along their axis and spheres.

    Raises
    ------
    InvalidInput
        When the height is not between zero and the radius, or the cut does not fit in the surface.

    Notes
    -----
    On a plane 2 sqrt(2 R h - h^2).  Else the law of cosines in the triangle of the surface's centre, the cut's centre
    and the scallop's tip, written with the half angle's sine so that small curvatures lose no digits.
    """
    h, big, k = (np.asarray(x, dtype=float) for x in (scallop, radius, curvature))
    if not ((h > 0) & (h < big)).all():
        raise InvalidInput(f"scallop height is {h} mm: it must lie above zero and below the radius {big} mm")
    if not (k * big < 1).all():
        raise InvalidInput(f"curvature is {k} 1/mm: a cut of radius {big} mm does not fit in there")
    # 4 rho_cut rho_tip sin^2(angle / 2) = R^2 - (R - h)^2, with rho_cut = rho (1 - k R), rho_tip = rho (1 - k h)
    square = h * (2 * big - h) / (4 * (1 - k * big) * (1 - k * h))
    sine = np.sqrt(square)
    bent = np.abs(k) * sine
    if not (bent < 1).all():
        raise InvalidInput(f"scallop height is {h} mm: the passes would meet behind the surface")
    with np.errstate(divide="ignore", invalid="ignore"):
        half = np.where(bent > 0, np.arcsin(bent) / np.abs(k), sine)
    return np.asarray(4 * half)


def scallop_from_step(step: ArrayLike, radius: ArrayLike, curvature: ArrayLike = 0.0) -> Array:
    """Scallop height for a distance between passes along the surface, with circular cuts.

    Parameters
    ----------
    step : float or (n,) array_like
        Arc length between the passes, mm.
    radius, curvature
        As in `step_from_scallop`, whose inverse this is.

    Returns
    -------
    (n,) array
        mm

    Raises
    ------
    InvalidInput
        When the cut does not fit in the surface, or the passes do not overlap.
    """
    d, big, k = (np.asarray(x, dtype=float) for x in (step, radius, curvature))
    if not (k * big < 1).all():
        raise InvalidInput(f"curvature is {k} 1/mm: a cut of radius {big} mm does not fit in there")
    with np.errstate(divide="ignore", invalid="ignore"):
        sine = np.where(k == 0, d / 4, np.sin(np.abs(k) * d / 4) / np.abs(k))
    s = 4 * sine**2 * (1 - k * big)  # h (2 R - h) = s (1 - k h)
    middle = big + k * s / 2
    rest = middle**2 - s
    if not (rest >= 0).all():
        raise InvalidInput(f"step is {d} mm: passes so far apart do not overlap")
    return np.asarray(s / (middle + np.sqrt(rest)))


def roughness_from_scallop(scallop: ArrayLike) -> Array:
    """Arithmetic mean roughness Ra across passes with parabolic scallops, 4 h / (9 sqrt 3), in the unit of h.

    Parameters
    ----------
    scallop : float or (n,) array_like
        Scallop height.

    Notes
    -----
    **Source**: [dong2023] Sec. 3.2: mean deviation of y^2 from its mean over a period.
    """
    return np.asarray(RA_SHARE * np.asarray(scallop, dtype=float))
