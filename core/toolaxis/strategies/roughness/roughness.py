"""Ra across the feed: the profile that neighbouring passes of a torus leave, and what steps and scallops it allows."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.strip.cutter_parameters import cutter_parameters
from toolaxis.contact.strip.scallop import RA_SHARE, effective_radius
from toolaxis.contact.strip.swept_volume_moving_axis import least_distance_to_positions
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import as_rows
from toolaxis.strategies.roughness.feasible_area import check_bull_nose
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Steps up the normal to the cutter, of which each leaves about a thousandth of the rest.
_CLIMBS = 3


def arithmetic_roughness(heights: ArrayLike, lengths: ArrayLike | None = None) -> Array:
    """Ra of profiles: mean distance from the mean line, in the unit of the heights.

    Parameters
    ----------
    heights : (..., n) array_like
        Heights at n places over the evaluation length.
    lengths : (n,) array_like, optional
        What each place stands for; the same for all unless given.

    Raises
    ------
    InvalidInput
        When a profile has fewer than two places, or a height is not finite.

    Notes
    -----
    **Source**: [dong2023] Eq. (16).
    """
    rows = np.asarray(heights, dtype=float)
    if rows.ndim == 0 or rows.shape[-1] < 2 or not np.isfinite(rows).all():
        raise InvalidInput(f"profile has shape {rows.shape}: two finite heights are needed at least")
    weights = np.ones(rows.shape[-1]) if lengths is None else np.asarray(lengths, dtype=float)
    mean = np.average(rows, axis=-1, weights=weights)[..., None]
    return np.asarray(np.average(np.abs(rows - mean), axis=-1, weights=weights))


def roughness_of_step(tool: Tool, step: ArrayLike, lean: ArrayLike, direction: ArrayLike = 0.0,
                      curvature: ArrayLike = 0.0) -> Array:
    """Ra of parabolic scallops between even passes, mm.

    Parameters
    ----------
    tool : Tool
    step : float or (n,) array_like
        Distance between the passes along the surface, mm.
    lean, direction : float or (n,) array_like
        Angle between axis and normal and that of the lean from the feed, rad.
    curvature : float or (n,) array_like
        Of the surface across the feed, 1/mm, positive where hollow.

    Raises
    ------
    InvalidInput
        When the corner radius is zero or the cutter's radius, or the cut does not fit the surface.

    Notes
    -----
    **Source**: [dong2023] Sec. 4.1 with the parabola of Eq. (14): h = d^2 (1/Reff - k) / 8, Ra = 4 h / (9 sqrt 3).
    The curvature is right where lean or feed lies along a principal direction.

    Examples
    --------
    >>> round(1000 * float(roughness_of_step(Tool.torus(10, 3), 0.66434, np.radians(20.0))), 4)
    1.6
    """
    check_bull_nose(tool, flat_too=False)
    rest = 1 / effective_radius(tool, lean, direction) - np.asarray(curvature, dtype=float)
    if not (rest > 0).all():
        raise InvalidInput(f"curvature across the feed is {np.max(curvature):.4g} 1/mm: the cutter does not fit there; "
                           "lean it more")
    return np.asarray(RA_SHARE * np.asarray(step, dtype=float) ** 2 * rest / 8)


def step_of_roughness(tool: Tool, roughness: ArrayLike, lean: ArrayLike, direction: ArrayLike = 0.0,
                      curvature: ArrayLike = 0.0) -> Array:
    """Distance between even passes for a roughness, mm: the inverse of `roughness_of_step`.

    Parameters
    ----------
    tool : Tool
    roughness : float or (n,) array_like
        Ra, mm.
    lean, direction, curvature
        As for `roughness_of_step`.

    Raises
    ------
    InvalidInput
        When the roughness is not above zero, or as there.

    Examples
    --------
    >>> round(float(step_of_roughness(Tool.torus(10, 3), 1.6e-3, np.radians(20.0))), 5)
    0.66434
    """
    wanted = np.asarray(roughness, dtype=float)
    if not (np.isfinite(wanted) & (wanted > 0)).all():
        raise InvalidInput(f"roughness is {1000 * wanted.min():g} um: it must be finite and above zero")
    unit_step = roughness_of_step(tool, 1.0, lean, direction, curvature)
    return np.asarray(np.sqrt(wanted / unit_step))


def scallop_of_roughness(roughness: float) -> float:
    """Height of parabolic scallops with a roughness, 9 sqrt 3 / 4 of it, in its unit.

    Parameters
    ----------
    roughness : float

    Raises
    ------
    InvalidInput
        When it is not above zero.
    """
    if not (np.isfinite(roughness) and roughness > 0):
        raise InvalidInput(f"roughness is {1000 * roughness:g} um: it must be finite and above zero")
    return float(roughness / RA_SHARE)


def profile_heights(tool: Tool, points: ArrayLike, normal: ArrayLike, passes: list[tuple[Array, Array]],
                    allowance: float = 0.0) -> Array:
    """Heights above a surface that passes of a cutter leave on lines of points, along the normals, mm.

    Parameters
    ----------
    tool : Tool
    points, normal : (n, m, 3) array_like
        m points of each of n lines on the surface, mm, and the normals there.
    passes : list of pairs of (n, k, 3) arrays
        For each pass near by, k tips at even places along it and the axes there, those of row i for line i: close
        enough that three neighbours lie on parabolas.
    allowance : float
        Stock left on the surface, mm; heights count from there.

    Returns
    -------
    (n, m) array

    Raises
    ------
    InvalidInput
        When there is no pass, or shapes do not fit.

    Notes
    -----
    **Source**: [dong2023] Sec. 4.1: the nearest of the scallops over each point, here with the torus itself in the
    place of the paraboloid of Eq. (15), and for a feed per tooth that vanishes.

    **Property**: over a plane the parabolas of `roughness_of_step`, but for the torus not being one.
    """
    lines, up = np.asarray(points, dtype=float), np.asarray(normal, dtype=float)
    if lines.ndim != 3 or lines.shape != up.shape or not passes:
        raise InvalidInput(f"{len(passes)} passes over points {lines.shape} with normals {up.shape}: one pass at least "
                           "and a normal for each point are needed")
    as_rows(lines.reshape(-1, 3), 3, "profile point")
    cutter = cutter_parameters(tool, tool.radius / 2, allowance)
    heights = np.full(lines.shape[:2], np.inf)
    base = lines + allowance * up
    for tip, axis in passes:
        height = np.zeros(lines.shape[:2])
        for _ in range(_CLIMBS):
            height += least_distance_to_positions(cutter, base + height[..., None] * up, tip, axis)
        heights = np.minimum(heights, height)
    return heights
