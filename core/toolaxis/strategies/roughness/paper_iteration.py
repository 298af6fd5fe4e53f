"""The loop of the paper: smooth rotary axes, fixed again and again where a place of the pass breaks a condition."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import InvalidInput
from toolaxis.machine.kinematics import nearest_turn, rotary_angles
from toolaxis.strategies.roughness import rotary_velocity as pace
from toolaxis.strategies.roughness.pass_constraints import PassConstraints, knots_of, leaning, windows
from toolaxis.strategies.roughness.rotary_spline import smoothest
from toolaxis.strategies.roughness.smoothing import SmoothedAxes

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: How often conditions are looked at before the loop gives up.
_ROUNDS = 200


def iterate_as_published(lane: PassConstraints, lead: float) -> SmoothedAxes:
    """Rotary axes by the paper's loop, the ends of the pass at a lead along the feed.

    Parameters
    ----------
    lane : PassConstraints
    lead : float
        rad

    Returns
    -------
    SmoothedAxes
        With more control coefficients than the lane's where it has to fix more places than they allow.

    Raises
    ------
    InvalidInput
        When a place breaks a condition and no lean along the feed keeps all, or the loop does not end.

    Notes
    -----
    In every stretch that breaks a condition the worst place is fixed, at the lean along the feed nearest to its own
    that keeps all conditions; then the least sum of squared velocities is solved for again.

    **Source**: [dong2023] Sec. 5.2, Steps 1 to 4, with fixed orientations met exactly.
    """
    lean, kept = windows(lane)
    axes = leaning(lane, np.full(len(lane.places), lead))
    ends = [_angles(lane, axes[k], np.zeros(len(lane.machine.rotary))) for k in (0,)]
    ends.append(_angles(lane, axes[-1], ends[0]))
    fixed = {0: ends[0], len(lane.places) - 1: ends[1]}
    for rounds in range(1, _ROUNDS + 1):
        count = len(lane.knots) - 4
        if len(fixed) > count - 4:
            lane = _finer(lane, min(2 * count, len(lane.places)))
        spline = smoothest(lane.knots, lane.places, lane.durations,
                           (lane.places[sorted(fixed)], np.array([fixed[k] for k in sorted(fixed)])))
        margins = lane.margins(lane.axes(spline.control))
        bad = margins.min(axis=1) < 0
        if not bad.any():
            return SmoothedAxes(lane, spline, spline.cost(lane.places, lane.durations), margins,
                                pace.velocity_left(lane, spline.control), rounds)
        current, angles = lane.leans(lane.axes(spline.control)), spline.angles(lane.places)
        for k in _worst(margins.min(axis=1), bad):
            if k in fixed:
                raise InvalidInput(f"place {k} of a pass is fixed and still breaks a condition: the loop cannot end")
            free = lean[kept[:, k]]
            if not len(free):
                raise InvalidInput(f"place {k} of a pass has no lean along the feed that keeps all conditions")
            chosen = float(free[np.abs(free - current[k]).argmin()])
            fixed[k] = _angles(lane, leaning(lane, np.full(len(lane.places), chosen))[k], angles[k])
    raise InvalidInput(f"conditions are still broken after {_ROUNDS} rounds")


def _angles(lane: PassConstraints, axis: Array, near: Array) -> Array:
    place = np.eye(4)
    place[:3, :3] = lane.turn
    found = rotary_angles(lane.machine, axis[None], near, place)
    if not found.within[0].any():
        raise InvalidInput(f"{lane.machine.name} cannot hold the axis {np.round(axis, 4).tolist()} inside its ranges")
    return nearest_turn(lane.machine, found.joints[0][found.within[0]], near)


def _finer(lane: PassConstraints, count: int) -> PassConstraints:
    if count <= len(lane.knots) - 4:
        raise InvalidInput(f"{count} control coefficients are too few for the places that must be fixed")
    return replace(lane, knots=knots_of(lane.places, count))


def _worst(least: Array, bad: Bools) -> list[int]:
    """The worst place of each stretch."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], bad.astype(int), [0]]))).reshape(-1, 2)
    return [int(first + least[first:after].argmin()) for first, after in edges]
