"""Back from tool tips to the contacts that they were placed for: CL files hold only tips and axes."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.contact.placement import place
from toolaxis.numeric.vectors import as_rows, axis_rows, dot
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]

#: Samples along each side of the face from which the search sets out, and how many of the nearest are tried.
_SAMPLES, _STARTS = 40, 3
#: Rounds of Newton's method at most; step of its differences as a share of the parameters' range.
_ROUNDS, _STEP = 40, 1e-6


class FoundContacts(NamedTuple):
    """Contacts of n tool tips: parameters (n, 2), which may lie beyond the face, and how far off, mm, the tips are that
    follow from them (n,)."""

    uv: Array
    off: Array


def contacts_of(face: Face, tool: Tool, tip: ArrayLike, axis: ArrayLike, allowance: float = 0.0) -> FoundContacts:
    """Parameters of the contacts for which tool tips were placed: the inverse of `toolaxis.contact.placement.place`.

    Parameters
    ----------
    face : Face
        Where passes run out beyond it, its surface is continued.
    tool : Tool
    tip : (n, 3) array_like
        mm
    axis : (3,) or (n, 3) array_like
        Tip to spindle.
    allowance : float
        Stock left on the face, mm.

    Returns
    -------
    FoundContacts

    Raises
    ------
    InvalidInput
        When an array has a wrong shape, a number is not finite, or an axis has no direction.

    Notes
    -----
    **Properties**: 1. tips placed at the contacts are `off` from those given; 2. it undoes `place` unless the cutter
    stands upright on the normal with a flat bottom.
    """
    from scipy.spatial import cKDTree

    tips = as_rows(tip, 3, "tip")
    axes = axis_rows(axis, len(tips))
    grid = face.grid(_SAMPLES, _SAMPLES)
    grid = np.concatenate([grid, *face.outline])
    if not len(tips):
        return FoundContacts(np.zeros((0, 2)), np.zeros(0))
    mean = axes.mean(axis=0)
    tree = cKDTree(place(face, tool, grid, mean if np.linalg.norm(mean) > 1e-6 else axes[0], allowance))
    starts = tree.query(tips, k=min(_STARTS, len(grid)))[1].reshape(len(tips), -1)
    best = _solve_contacts((face, tool, allowance), tips, axes, grid[starts[:, 0]])
    for column in starts.T[1:]:
        poor = np.flatnonzero(best.off > 1e-6)
        if not poor.size:
            break
        again = _solve_contacts((face, tool, allowance), tips[poor], axes[poor], grid[column[poor]])
        better = again.off < best.off[poor]
        best.uv[poor[better]], best.off[poor[better]] = again.uv[better], again.off[better]
    return best


def _solve_contacts(placed: tuple[Face, Tool, float], tips: Array, axes: Array, uv: Array) -> FoundContacts:
    """Damped Gauss-Newton steps, each taken where it brings the tip nearer."""
    face, tool, allowance = placed
    u0, u1, v0, v1 = face.bounds
    span = np.array([u1 - u0, v1 - v0])
    uv, damping = uv.copy(), np.full(len(uv), 1e-9)
    gap = place(face, tool, uv, axes, allowance) - tips
    off = np.linalg.norm(gap, axis=1)
    at_work = np.arange(len(uv))
    for _ in range(_ROUNDS):
        at_work = at_work[(off[at_work] > 1e-9) & (damping[at_work] < 1e6)]
        if not at_work.size:
            break
        here, t, g = uv[at_work], axes[at_work], gap[at_work]
        slopes = [(place(face, tool, here + _STEP * span * side, t, allowance) - tips[at_work] - g) / _STEP
                  for side in np.eye(2)]
        trial = here + span * np.clip(_step(slopes[0], slopes[1], g, damping[at_work]), -0.2, 0.2)
        found = place(face, tool, trial, t, allowance) - tips[at_work]
        size = np.linalg.norm(found, axis=1)
        better = size < off[at_work]
        taken = at_work[better]
        uv[taken], gap[taken], off[taken] = trial[better], found[better], size[better]
        damping[at_work] = np.where(better, 0.1 * damping[at_work], np.maximum(10 * damping[at_work], 1e-6))
    return FoundContacts(uv, off)


def _step(su: Array, sv: Array, gap: Array, damping: Array) -> Array:
    """Shares of the parameters' ranges to go, (n, 2), by least squares."""
    # The normal equations (a, b; b, c) (u, v) = (p, q), damped.
    a = dot(su, su) * (1 + damping) + 1e-30
    b = dot(su, sv)
    c = dot(sv, sv) * (1 + damping) + 1e-30
    p = -dot(su, gap)
    q = -dot(sv, gap)
    determinant = np.maximum(a * c - b * b, 1e-14 * a * c)
    u = (c * p - b * q) / determinant
    v = (a * q - b * p) / determinant
    return np.stack([u, v], axis=1)
