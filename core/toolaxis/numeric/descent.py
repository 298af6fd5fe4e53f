"""Downhill on a smooth function of some hundred numbers, in arithmetic that is the same everywhere."""

from collections import deque
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Steps that are remembered.
_MEMORY = 10
#: Share of the slope's promise that a step has to keep; how far a step is drawn back at once, least and most.
_KEPT, _LEAST, _MOST = 1e-4, 0.1, 0.5
#: Times that a step is drawn back; the least gain that is worth another step, as a share of the value.
_DRAWN, _WORTH = 20, 1e-9


def descend(function: Callable[[Array], tuple[float, Array]], start: Array, rounds: int) -> tuple[float, Array]:
    """The lowest value that so many steps of the limited-memory BFGS method find, and its place.

    Parameters
    ----------
    function : callable
        Takes (n,), returns the value and the gradient (n,).
    start : (n,) array
    rounds : int

    Notes
    -----
    scipy's L-BFGS-B solves small systems with LAPACK, whose threads take longer than the work where cores are busy, and
    its steps differ between releases.

    **Source**: J. Nocedal, Updating quasi-Newton matrices with limited storage, 1980: the two-loop recursion, here with
    a step that is drawn back until it keeps what its slope promises.

    **Properties**: 1. the value never rises; 2. the minimum of a convex function, with rounds enough.
    """
    place = np.array(start, dtype=float)
    value, slope = function(place)
    known: deque[tuple[Array, Array, float]] = deque(maxlen=_MEMORY)
    for _ in range(rounds):
        way = -_apply_inverse(slope, known)
        promised = float(slope @ way)
        if not promised < 0:  # rounding has spoilt what is known: begin anew
            known.clear()
            way, promised = -slope, -float(slope @ slope)
            if promised == 0:
                break
        size = 1.0 if known else min(1.0, 1.0 / max(float(np.abs(slope).sum()), np.finfo(float).tiny))
        found = _draw_back(function, place, value, way, promised, size)
        if found is None:
            break
        step, after, new_slope = found
        change = new_slope - slope
        curvature = float(change @ step)
        if curvature > np.finfo(float).eps * float(change @ change):
            known.append((step, change, 1.0 / curvature))
        gain = value - after
        place, value, slope = place + step, after, new_slope
        if gain <= _WORTH * abs(value):
            break
    return value, place


def _apply_inverse(slope: Array, known: deque[tuple[Array, Array, float]]) -> Array:
    """The inverse of the curvature that the steps so far have shown, times a slope."""
    rest, shares = slope.copy(), []
    for step, change, rate in reversed(known):
        share = rate * float(step @ rest)
        rest -= share * change
        shares.append(share)
    if known:
        step, change, _ = known[-1]
        rest *= float(step @ change) / float(change @ change)
    for (step, change, rate), share in zip(known, reversed(shares), strict=True):
        rest += (share - rate * float(change @ rest)) * step
    return rest


def _draw_back(function: Callable[[Array], tuple[float, Array]], place: Array, value: float, way: Array,
               promised: float, size: float) -> tuple[Array, float, Array] | None:
    """A step that keeps what its slope promises, with the value and the slope there; None where there is none."""
    for _ in range(_DRAWN):
        step = size * way
        after, slope = function(place + step)
        if np.isfinite(after) and after <= value + _KEPT * size * promised:
            return step, after, slope
        least = -promised * size**2 / (2 * (after - value - size * promised)) if np.isfinite(after) else 0.0
        size = min(max(least, _LEAST * size), _MOST * size)
    return None
