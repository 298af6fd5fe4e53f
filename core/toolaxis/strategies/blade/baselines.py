"""What re-scheduled tool angles compete with: a constant lead from the normal, and quaternions between a few of it."""

from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.strategies.blade.section import Section

Array = NDArray[np.float64]

#: Orientations of a layer between which quaternions are interpolated.
KEYS = 12


class SmoothSection:
    """A section as a closed spline through its points: what a program's points stand for.

    Parameters
    ----------
    one : Section
    """

    def __init__(self, one: Section) -> None:
        from scipy.interpolate import CubicSpline

        self.length = one.length
        self.spline = CubicSpline(one.lengths, one.points, bc_type="periodic")

    def points(self, lengths: ArrayLike) -> Array:
        """Cutter centres, (n, 2) mm.

        Parameters
        ----------
        lengths : (n,) array_like
            S, mm.
        """
        return np.asarray(self.spline(lengths))

    def tangents(self, lengths: ArrayLike) -> Array:
        """Tangent angles, (n,) rad, unwrapped.

        Parameters
        ----------
        lengths : (n,) array_like
            S, mm; close enough that none turns by half a turn.
        """
        way = self.spline(lengths, 1)
        return np.unwrap(np.arctan2(way[:, 1], way[:, 0]))


def constant_angles(one: SmoothSection, lengths: ArrayLike, lead: float = 0.0) -> Array:
    """Tool angles at a constant angle from the normal, as systems without re-scheduling give them, (n,) rad.

    Parameters
    ----------
    one : SmoothSection
    lengths : (n,) array_like
        S, mm.
    lead : float
        Towards the feed, rad.
    """
    return one.tangents(lengths) - pi / 2 + lead


def by_quaternions(one: SmoothSection, lengths: ArrayLike, keys: int = KEYS, lead: float = 0.0) -> Array:
    """Tool angles of a smooth quaternion curve through the unscheduled orientations at a few places, (n,) rad.

    Parameters
    ----------
    one : SmoothSection
    lengths : (n,) array_like
        S, mm, ascending.
    keys : int
        Places, evenly spaced; the layers before and after are interpolated along with it, so that it runs on.
    lead : float
        rad

    Notes
    -----
    **Source**: [stheta2023] compares with quaternion interpolation between key orientations, whose places it does not
    print; here the curve is twice differentiable.
    """
    from scipy.spatial.transform import Rotation, RotationSpline

    s = np.asarray(lengths, dtype=float)
    fine = np.linspace(0.0, one.length, 4 * len(s) + 1)
    angle = constant_angles(one, fine, lead)
    places = np.linspace(0.0, one.length, keys + 1)
    at = np.interp(places, fine, angle)
    places = np.concatenate([places[:-1] - one.length, places, places[1:] + one.length])
    at = np.concatenate([at[:-1] - 2 * pi, at, at[1:] + 2 * pi])
    curve = RotationSpline(places, Rotation.from_rotvec(np.column_stack([0 * at, 0 * at, at])))
    x = curve(s).as_matrix()[:, :, 0]
    return np.asarray(np.unwrap(np.arctan2(x[:, 1], x[:, 0])) + 2 * pi * round(float(at[keys]) / (2 * pi)))
