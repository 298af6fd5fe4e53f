"""Families of blade sections, closed and as fine as asked for, and faces lofted through them."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from toolaxis.shape.face import Face

Array = NDArray[np.float64]


def profile(camber: float, thick: float, chord: float, blunt: float, count: int) -> Array:
    """A closed airfoil, anticlockwise from its trailing edge, (count, 2) mm, spaced evenly by length.

    Parameters
    ----------
    camber : float
        Turn of the circular camber line from end to end, rad.
    thick, chord : float
        Greatest thickness and chord, mm.
    blunt : float
        Radius of the round ends, mm.
    count : int
    """
    t = (1 - np.cos(np.linspace(0, np.pi, 4001))) / 2
    end = np.clip(1 - chord * np.minimum(t, 1 - t) / (1.6 * blunt), 0, 1)
    half = blunt * np.sqrt(1 - end**2.5) + (thick / 2 - blunt) * (4 * t * (1 - t))**1.3
    if abs(camber) > 1e-9:
        radius = chord / (2 * np.sin(camber / 2))
        angle = camber * (t - 0.5)
        middle = np.column_stack([radius * np.sin(angle), radius * (np.cos(angle) - np.cos(camber / 2))])
        normal = np.column_stack([np.sin(angle), np.cos(angle)])
    else:
        middle = np.column_stack([chord * (t - 0.5), 0 * t])
        normal = np.column_stack([0 * t, 1 + 0 * t])
    upper, lower = middle + half[:, None] * normal, middle - half[:, None] * normal
    rows = np.concatenate([upper[::-1], lower[1:-1]])
    return even(rows, count)


def even(rows: Array, count: int) -> Array:
    """Points spaced evenly by length along a closed polygon."""
    closed = np.concatenate([rows, rows[:1]])
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
    at = np.linspace(0, way[-1], count, endpoint=False)
    return np.column_stack([np.interp(at, way, column) for column in closed.T])


def offset(rows: Array, radius: float) -> Array:
    """Cutter centres around a closed smooth polygon."""
    way = np.roll(rows, -1, axis=0) - np.roll(rows, 1, axis=0)
    return np.asarray(rows + radius * np.column_stack([way[:, 1], -way[:, 0]]) / np.hypot(*way.T)[:, None])


#: Camber, deg; thickness, chord and radius of the ends, mm; twist over the span, deg.
FAMILIES: dict[str, tuple[float, float, float, float, float]] = {
    "lens": (0.0, 12.0, 60.0, 1.2, 0.0), "compressor": (35.0, 7.0, 60.0, 0.8, 25.0),
    "turbine": (75.0, 14.0, 55.0, 1.5, 10.0), "steam": (100.0, 12.0, 60.0, 1.0, 15.0),
    "fan": (25.0, 4.0, 120.0, 0.5, 30.0), "impulse": (125.0, 12.0, 60.0, 0.8, 5.0)}


def sections(name: str, layers: int = 1, radius: float = 4.0, count: int = 300) -> list[Array]:
    """Cutter centres of the layers of a family, (count, 2) each."""
    camber, thick, chord, blunt, twist = FAMILIES[name]
    made = []
    for k in range(layers):
        share = k / max(layers - 1, 1)
        rows = profile(np.radians(camber * (1 - 0.3 * share)), thick * (1 - 0.35 * share), chord * (1 - 0.1 * share),
                       blunt, 4 * count)
        angle = np.radians(twist * share)
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        made.append(even(offset(rows, radius), count) @ turn)
    return made


def loft(name: str, span: float = 40.0, rows: int = 9, columns: int = 241,
         place: Callable[[Array], Array] = lambda points: points) -> Face:
    """The closed face of a blade of a family, its span along z, through splines that close smoothly."""
    from scipy.interpolate import BSpline, make_interp_spline

    camber, thick, chord, blunt, twist = FAMILIES[name]
    shares = np.linspace(0, 1, rows)
    net = []
    for share in shares:
        flat = profile(np.radians(camber * (1 - 0.3 * share)), thick * (1 - 0.35 * share), chord * (1 - 0.1 * share),
                       blunt, columns - 1)
        angle = np.radians(twist * share)
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        net.append(np.column_stack([flat @ turn, np.full(columns - 1, span * share)]))
    data = np.array(net)
    data = np.concatenate([data, data[:, :1]], axis=1)
    u = np.linspace(0, 1, columns)
    slope = (data[:, 1] - data[:, -2]) / (u[2] - u[0])
    along = make_interp_spline(u, data.transpose(1, 0, 2), 3, bc_type=([(1, slope)], [(1, slope)]))
    across = make_interp_spline(shares, along.c.transpose(1, 0, 2), 3)
    assert isinstance(across, BSpline)
    return Face.from_bspline(place(across.c.transpose(1, 0, 2)), (3, 3), (along.t, across.t))
