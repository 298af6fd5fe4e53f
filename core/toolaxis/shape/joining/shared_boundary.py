"""How two faces that meet smoothly lie beside each other: along which sides, and with which parameters there."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import UnsupportedGeometry
from toolaxis.shape.adjacency import Edge
from toolaxis.shape.face import Face
from toolaxis.shape.nearest import nearest
from toolaxis.shape.part import Part

Array = NDArray[np.float64]

#: How far the common border may lie off a side or off the same place of the other face's side, mm.
GAP = 5e-4
_SAMPLES = 24
#: Ends of a line that lie so near to ends of the other's range, as a share of it, are these.
_SAME = 1e-6


@dataclass(frozen=True)
class FaceSide:
    """A side of a face in its parameters.

    Attributes
    ----------
    axis : int
        0 where u is constant along it, 1 where v is.
    end : int
        0 where the face lies at larger parameters, 1 where at smaller ones.
    at : float
        The constant parameter.
    """

    axis: int
    end: int
    at: float

    @property
    def outward(self) -> Array:
        """Direction in (u, v) that leaves the face, (2,)."""
        way = np.zeros(2)
        way[self.axis] = 1.0 if self.end else -1.0
        return way


@dataclass(frozen=True)
class SharedBoundary:
    """Two faces that meet along a side of each.

    Attributes
    ----------
    faces : (int, int)
        Numbers.
    sides : (Side, Side)
    slope, shift : float
        Along the side, the parameter of the second face is slope times that of the first, plus shift.
    """

    faces: tuple[int, int]
    sides: tuple[FaceSide, FaceSide]
    slope: float
    shift: float

    def turned(self) -> "SharedBoundary":
        """The same with the second face first."""
        return SharedBoundary(self.faces[::-1], self.sides[::-1], 1 / self.slope, -self.shift / self.slope)


def meetings(part: Part, numbers: Sequence[int]) -> list[SharedBoundary]:
    """How faces of a part meet each other smoothly.

    Parameters
    ----------
    part : Part
    numbers : sequence of int

    Returns
    -------
    list of SharedBoundary
        In the order of the part's edges; pairs that meet along two sides are there twice.

    Raises
    ------
    UnsupportedGeometry
        When a common border is no iso-parametric side of a face, or parameters along it do not go together.
    """
    among = set(numbers)
    found: list[SharedBoundary] = []
    for edge in part.edges:
        a, b = edge.faces
        if edge.kind == "tangent" and a != b and {a, b} <= among:
            meeting = meeting_along(part.face(a), part.face(b), edge)
            if not any(meeting.faces == other.faces and meeting.sides == other.sides for other in found):
                found.append(meeting)
    return found


def meeting_along(first: Face, second: Face, edge: Edge) -> SharedBoundary:
    """How two faces meet along an edge.

    Parameters
    ----------
    first, second : Face
        The edge's faces, in its order.
    edge : Edge

    Raises
    ------
    UnsupportedGeometry
        When it is no iso-parametric side of both, or parameters along it do not go together.
    """
    pair = f"faces {first.label} and {second.label} cannot be joined"
    if float(np.linalg.norm(np.diff(edge.polyline, axis=0), axis=1).sum()) <= GAP:
        raise UnsupportedGeometry(f"{pair}: their common edge is no longer than {GAP:g} mm: machine them face by face")
    points = _inner_points(edge.polyline)
    sides, along = [], []
    for face in (first, second):
        uv = nearest(face, points).uv
        sides.append(_side(face, uv, pair))
        along.append(uv[:, 1 - sides[-1].axis])
    slope, shift = _line((along[0], along[1]), first.surface.domain[1 - sides[0].axis],
                         second.surface.domain[1 - sides[1].axis])
    off = float(np.abs(slope * along[0] + shift - along[1]).max()) * _speed(second, 1 - sides[1].axis)
    if off > GAP:
        raise UnsupportedGeometry(f"{pair}: their parameters along the common edge do not go together, places of equal "
                                  f"shares lie up to {off:.3g} mm apart: machine them face by face, or build them with "
                                  "the same parametrisation")
    return SharedBoundary(edge.faces, (sides[0], sides[1]), slope, shift)


def _inner_points(polyline: Array) -> Array:
    """Places along an edge without its ends, where a seam or a pole may be."""
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(polyline, axis=0), axis=1))])
    if len(polyline) < 6:
        at = length[-1] * (np.arange(8) + 0.5) / 8
        return np.stack([np.interp(at, length, column) for column in polyline.T], axis=1)
    rows = np.unique(np.linspace(1, len(polyline) - 2, min(_SAMPLES, len(polyline) - 2)).astype(int))
    return np.asarray(polyline[rows])


def _speed(face: Face, axis: int) -> float:
    """Greatest length of one derivative on a face, mm."""
    d = face.evaluate(face.grid(9, 9))
    return float(np.linalg.norm((d.su, d.sv)[axis], axis=1).max(initial=1e-300))


def _side(face: Face, uv: Array, pair: str) -> FaceSide:
    """The side of a face on which places of its border lie."""
    spread = np.array([np.ptp(uv[:, axis]) * _speed(face, axis) for axis in (0, 1)])
    axis = int(spread[1] < spread[0])
    if spread[axis] > GAP:
        raise UnsupportedGeometry(f"{pair}: the common edge runs across the parameters of face {face.label}, by "
                                  f"{spread[axis]:.3g} mm at least: machine them face by face")
    at, bounds = float(np.median(uv[:, axis])), face.bounds[2 * axis:2 * axis + 2]
    end = int(abs(bounds[1] - at) < abs(bounds[0] - at))
    if abs(bounds[end] - at) * _speed(face, axis) > GAP:
        raise UnsupportedGeometry(f"{pair}: face {face.label} lies on both sides of the common edge, which only "
                                  "runs along a part of it: machine them face by face")
    return FaceSide(axis, end, bounds[end])


def _line(along: tuple[Array, Array], own: tuple[float, float], other: tuple[float, float]) -> tuple[float, float]:
    """Slope and shift of the straight line through parameters along an edge; ends that fit are taken as exact."""
    slope, shift = (float(x) for x in np.polyfit(*along, 1))
    ends = np.array(own) * slope + shift
    near = np.where(np.abs(ends - other[0]) < np.abs(ends - other[1]), *other)
    if near[0] != near[1] and np.abs(ends - near).max() <= _SAME * (other[1] - other[0]):
        slope = float(near[1] - near[0]) / (own[1] - own[0])
        shift = float(near[0]) - slope * own[0]
    return slope, shift
