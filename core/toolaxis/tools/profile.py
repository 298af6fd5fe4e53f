"""The generatrix of a cutter: flat bottom, corner arc, side line up to the end of the cutting edge."""

from dataclasses import dataclass
from math import cos, sin, tan

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toolaxis.errors import InvalidInput

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Profile:
    """A convex cutter of revolution about +z with its tip at the origin.

    Attributes
    ----------
    flat_radius : float
        Radius a of the flat bottom, mm (0 for a ball).
    corner_radius : float
        Radius r of the corner arc, centre at (a, r), mm (0 for a flat end).
    half_angle : float
        Inclination of the side line from the axis, rad (0 for a cylinder).
    top : float
        Height of the end of the cutting edge above the tip, mm.
    """

    flat_radius: float
    corner_radius: float
    half_angle: float
    top: float

    @property
    def tangent_point(self) -> tuple[float, float]:
        """(radius, z) where the arc meets the side line."""
        beta = self.half_angle
        return self.flat_radius + self.corner_radius * cos(beta), self.corner_radius * (1 - sin(beta))

    @property
    def top_radius(self) -> float:
        """Radius at the end of the cutting edge, mm."""
        radius, z = self.tangent_point
        return radius + (self.top - z) * tan(self.half_angle)

    def radius_at(self, z: ArrayLike) -> Array:
        """Radius of the cutter at heights above the tip; 0 outside [0, top].

        Parameters
        ----------
        z : array_like
            mm
        """
        height = np.asarray(z, dtype=float)
        a, r = self.flat_radius, self.corner_radius
        radius, start = self.tangent_point
        arc = a + np.sqrt(np.maximum(r**2 - (height - r) ** 2, 0.0))
        side = radius + (height - start) * tan(self.half_angle)
        return np.where((height < 0) | (height > self.top), 0.0, np.where(height < start, arc, side))

    def polyline(self, tolerance: float) -> Array:
        """The generatrix from the axis to the top edge as a polyline inside the cutter.

        Parameters
        ----------
        tolerance : float
            Greatest distance between arc and chords, mm.

        Returns
        -------
        (k, 2) array of (radius, z)

        Raises
        ------
        InvalidInput
            When the tolerance is not above zero.
        """
        if not tolerance > 0:
            raise InvalidInput(f"tolerance of the cutter's polyline is {tolerance} mm: it must be above zero")
        a, r = self.flat_radius, self.corner_radius
        points = [(0.0, 0.0)] if a > 0 else []
        sweep = np.pi / 2 - self.half_angle
        steps = 1 if r == 0 else max(1, int(np.ceil(sweep / (2 * np.arccos(max(0.0, 1 - min(tolerance / r, 1.0)))))))
        angles = np.linspace(0.0, sweep, steps + 1) if r > 0 else np.zeros(1)
        points += [(a + r * sin(t), r * (1 - cos(t))) for t in angles]
        return np.array([*points, (self.top_radius, self.top)])
