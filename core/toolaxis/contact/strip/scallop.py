"""Scallop height, step-over and roughness: what two neighbouring passes leave between them."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.strip.curves import ALONG_U
from toolaxis.contact.strip.cutter_parameters import cutter_numbers
from toolaxis.contact.strip.half_widths import Bench, Geometry, contact_widths, new_bench
from toolaxis.contact.strip.width import contact_rows
from toolaxis.errors import InvalidInput
from toolaxis.numeric.jit import jit
from toolaxis.numeric.vectors import as_rows, unit
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

RA_SHARE = 4 / (9 * np.sqrt(3))
"""Ra of parabolic scallops over their height."""


@jit
def _reach(geometry: Geometry, pair: tuple[Array, Array], axis: Array, heights: tuple[float, float],
           bench: Bench) -> float:
    """Upper half width of the first contact and lower half width of the second at a height, in the step parameter."""
    h, allowance = heights
    sizes = (h, h + allowance, geometry[2][0] + geometry[2][1])
    return contact_widths(geometry, pair[0], axis, sizes, bench)[1] + contact_widths(geometry, pair[1], axis, sizes,
                                                                                     bench)[0]


@jit
def _heights(geometry: Geometry, contacts: tuple[Array, Array], axes: Array, allowance: float, out: Array) -> None:
    bench = new_bench()
    radius = geometry[2][0] + geometry[2][1]
    for k in range(axes.shape[0]):
        pair = (contacts[0][k], contacts[1][k])
        step = 1 - int(pair[0][2])
        apart = pair[1][step] - pair[0][step]
        low, high = 0.0, radius
        h = 0.01 * radius
        for _ in range(60):
            reach = _reach(geometry, pair, axes[k], (h, allowance), bench)
            if reach < apart:
                low = h
            else:
                high = h
            ahead = h * (apart / reach) ** 2 if reach > 0.0 else high
            if not low < ahead < high:
                ahead = 0.5 * (low + high)
            if abs(ahead - h) <= 1e-12 * radius or high - low <= 1e-12 * radius:
                break
            h = ahead
        out[k] = h


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
    first, second = contact_rows(uv, feed, False), contact_rows(neighbour, feed, False)
    if first.shape != second.shape:
        raise InvalidInput(f"{len(first)} contacts have {len(second)} neighbours: give one for each")
    along = 0 if first[0, 2] == ALONG_U else 1
    bad = np.flatnonzero((first[:, along] != second[:, along]) | (first[:, 1 - along] == second[:, 1 - along]))
    if bad.size:
        raise InvalidInput(f"contacts {bad[0]} are {first[bad[0], :2].tolist()} and {second[bad[0], :2].tolist()}: "
                           f"neighbours must share {feed} and differ in the other parameter")
    turn = (first[:, 1 - along] > second[:, 1 - along])[:, None]
    pair = np.where(turn, second, first), np.where(turn, first, second)
    geometry = face.surface.data, -1.0 if face.flip else 1.0, cutter_numbers(tool, tool.radius / 2, allowance)
    axes = np.ascontiguousarray(np.broadcast_to(unit(as_rows(axis, 3, "axis")), (len(first), 3)))
    out = np.empty(len(first))
    _heights(geometry, pair, axes, float(allowance), out)
    return out


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
        return np.broadcast_to(np.asarray(tool.corner_radius), np.broadcast(lean, direction).shape).astype(float)
    with np.errstate(divide="ignore"):
        return np.asarray(tool.corner_radius + tool.flat_radius * np.cos(direction) ** 2 / np.sin(lean))


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
