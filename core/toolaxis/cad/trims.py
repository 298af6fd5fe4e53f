"""Trim loops: the kernel's parameter curves of a face as closed polygons in our parameters."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from toolaxis.cad.kernel_protocol import Box, KernelEdge
from toolaxis.errors import UnsupportedGeometry
from toolaxis.numeric.polygons import signed_area

Array = NDArray[np.float64]

MOST_ROUNDS = 14
STRAIGHT = 1e-10


@dataclass
class Loops:
    """Loops of one face in the kernel's parameters, and what was wrong with them.

    Attributes
    ----------
    polygons : list of (m, 2) arrays
        Outer loop first and anticlockwise, holes clockwise; no repeated end point.
    reversed : bool
        The wires ran the other way round in the file.
    warnings : list of str
    """

    polygons: list[Array]
    reversed: bool = False
    warnings: list[str] = field(default_factory=list)


def coarse(edge: KernelEdge) -> Array:
    """Shares that show every span of an edge's curve in the parameters."""
    return np.linspace(0.0, 1.0, 5 if edge.straight else 1 + 4 * min(max(1, edge.spans), 250))


def coarse_box(wires: Sequence[Sequence[KernelEdge]]) -> Box:
    """Parameter box of all edges, from a coarse look."""
    points = np.concatenate([edge.parameters(coarse(edge)) for wire in wires for edge in wire])
    (u0, v0), (u1, v1) = points.min(axis=0), points.max(axis=0)
    return float(u0), float(u1), float(v0), float(v1)


def sample_edge(edge: KernelEdge, to_ours: Callable[[Array], Array], tangents: Callable[[Array], Array],
                tolerance: float) -> Array:
    """The kernel's parameters along an edge, dense enough for chords in our parameters.

    Parameters
    ----------
    edge : KernelEdge
    to_ours : callable
        Maps (n, 2) parameters of the kernel to ours.
    tangents : callable
        Su and Sv, (n, 2, 3), at parameters of the kernel.
    tolerance : float
        Greatest distance of the curve from its chords, measured on the surface, mm.
    """
    share = coarse(edge)
    points = edge.parameters(share)
    if _is_straight(to_ours(points)):
        return points[[0, -1]]
    for _ in range(MOST_ROUNDS):
        middle = 0.5 * (share[1:] + share[:-1])
        between = edge.parameters(middle)
        ours = to_ours(points)
        off = to_ours(between) - 0.5 * (ours[1:] + ours[:-1])
        rough = np.linalg.norm(np.einsum("nk,nkc->nc", off, tangents(between)), axis=1) > 0.9 * tolerance
        if not rough.any():
            break
        at = np.flatnonzero(rough) + 1
        share, points = np.insert(share, at, middle[rough]), np.insert(points, at, between[rough], axis=0)
    return points


def _is_straight(points: Array) -> bool:
    chord = points[-1] - points[0]
    length = float(np.hypot(*chord))
    if length == 0.0:
        return bool(np.ptp(points, axis=0).max() == 0.0)
    off = points - points[0]
    across = np.abs(off[:, 0] * chord[1] - off[:, 1] * chord[0]) / length
    along = off @ chord / length
    return bool(across.max() <= STRAIGHT * length and along.min() >= -STRAIGHT * length
                and along.max() <= length * (1 + STRAIGHT))


def close_loop(pieces: list[Array], periods: tuple[float, float], warnings: list[str]) -> Array:
    """Join pieces into one closed polygon, moving pieces by whole periods where that closes a gap.

    Parameters
    ----------
    pieces : list of (m, 2) arrays
        In order of travel, ends included.
    periods : (float, float)
        Periods in u and v, 0 where there is none.
    warnings : list of str
        Receives what does not close.

    Returns
    -------
    (n, 2) array
        Without repeated points.
    """
    loop = [pieces[0]]
    for piece in pieces[1:]:
        loop.append(piece + _turns(loop[-1][-1] - piece[0], periods))
    whole = np.concatenate(loop)
    if np.abs(_turns(whole[-1] - whole[0], periods)).max() > 0:
        raise UnsupportedGeometry("a trim loop runs round the whole surface without a seam: "
                                  "export the part with seam edges")
    keep = np.abs(whole - np.roll(whole, 1, axis=0)).max(axis=1) > STRAIGHT * max(np.ptp(whole, axis=0).max(), 1e-300)
    return whole[keep]


def _turns(gap: Array, periods: tuple[float, float]) -> Array:
    return np.array([p * np.round(g / p) if p > 0 else 0.0 for g, p in zip(gap, periods, strict=True)])


def orient_loops(polygons: list[Array], periods: tuple[float, float], warnings: list[str]) -> Loops:
    """Sort loops: the outer one first and anticlockwise, holes clockwise and inside its range.

    Parameters
    ----------
    polygons : list of (m, 2) arrays
    periods : (float, float)
    warnings : list of str
    """
    areas = [signed_area(p) if len(p) > 2 else 0.0 for p in polygons]
    order = sorted(range(len(polygons)), key=lambda k: -abs(areas[k]))
    if not order or areas[order[0]] == 0.0:
        raise UnsupportedGeometry("its trim loops enclose no area: repair the face in the CAD system")
    outer = polygons[order[0]]
    box = np.ptp(outer, axis=0)
    result = [outer if areas[order[0]] > 0 else outer[::-1]]
    for k in order[1:]:
        if abs(areas[k]) <= 1e-14 * box[0] * box[1]:
            warnings.append("a trim loop without area was left out")
            continue
        hole = polygons[k] if areas[k] < 0 else polygons[k][::-1]
        middle = 0.5 * (hole.min(axis=0) + hole.max(axis=0))
        low, high = outer.min(axis=0), outer.max(axis=0)
        away = np.where((middle < low) | (middle > high), 0.5 * (low + high) - middle, 0.0)
        result.append(hole + _turns(away, periods))
    return Loops(result, areas[order[0]] < 0, warnings)
