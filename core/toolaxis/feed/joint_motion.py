"""Motion of all axes in pieces of constant jerk: what a schedule commands, exact at every time."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class JointMotion:
    """Pieces of constant jerk, one after the other, from rest.

    Attributes
    ----------
    durations : (k,) array
        s.
    jerks : (k, m) array
        Of each axis, mm or rad / s^3.
    start : (m,) array
        Where the axes stand at first.
    """

    durations: Array
    jerks: Array
    start: Array

    @property
    def duration(self) -> float:
        """s."""
        return float(self.durations.sum())

    def knots(self) -> tuple[Array, Array, Array]:
        """Positions, velocities and accelerations where the pieces meet, (k + 1, m) each."""
        t = self.durations[:, None]
        jerk = self.jerks
        a = _sum_up(t * jerk)
        v = _sum_up(t * (a[:-1] + t * jerk / 2))
        q = _sum_up(t * (v[:-1] + t * (a[:-1] / 2 + t * jerk / 6)))
        return q + self.start, v, a

    def at(self, times: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Positions, velocities, accelerations and jerks at times from 0 to the duration, (n, m) each.

        Parameters
        ----------
        times : (n,) array_like
            s.
        """
        t = np.atleast_1d(np.asarray(times, dtype=float))
        begins = np.concatenate([[0.0], np.cumsum(self.durations)])
        which = np.clip(np.searchsorted(begins, t, side="right") - 1, 0, len(self.durations) - 1)
        q, v, a = (state[which] for state in self.knots())
        gone = (t - begins[which])[:, None]
        jerk = self.jerks[which]
        position = q + gone * (v + gone * (a / 2 + gone * jerk / 6))
        velocity = v + gone * (a + gone * jerk / 2)
        acceleration = a + gone * jerk
        return position, velocity, acceleration, jerk

    def extremes(self) -> tuple[Array, Array, Array]:
        """Greatest size of velocity, acceleration and jerk of each axis, (m,) each; exact, not sampled."""
        _, v, a = self.knots()
        turning = np.zeros_like(self.jerks)
        moving = self.jerks != 0
        turning[moving] = -a[:-1][moving] / self.jerks[moving]
        inside = (turning > 0) & (turning < self.durations[:, None])
        between = np.where(inside, v[:-1] + turning * (a[:-1] + turning * self.jerks / 2), 0.0)
        velocity = np.maximum(np.abs(v).max(axis=0), np.abs(between).max(axis=0))
        return velocity, np.abs(a).max(axis=0), np.abs(self.jerks).max(axis=0)


def _sum_up(changes: Array) -> Array:
    """Values at both ends of all pieces, (k + 1, m), from zero, by what each changes over a piece, (k, m)."""
    zero = np.zeros((1, changes.shape[1]))
    return np.concatenate([zero, np.cumsum(changes, axis=0)])
