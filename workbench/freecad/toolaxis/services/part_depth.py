"""How deep faces lie in their part and how narrow it is before them: what diameter and stick-out of a tool follow."""

from contextlib import suppress
from typing import NamedTuple

import numpy as np

#: Points along a side of a face; faces that are looked at, the largest ones.
_SIDE, _FACES = 3, 12
#: How many points the part is seen as along the diagonal of its box, and along a side of a face or an edge at most.
_FINE, _MOST = 40, 24
#: A face with more sides than that is trimmed, and a plane with less than this share of its rectangle; points along a
#: side of such ones.
_SIDES, _ALL, _FEW = 4, 0.99, 5
#: Directions from which a tool may come, and how far from the normal they lie at most, rad.
_DIRECTIONS, _LEAN = 40, np.radians(75.0)
#: Share of the area of the faces that may be worse than what is told: fillets and corners are for other tools.
_REST = 0.25
#: How far beside a normal something stands before a face, in distances of the points.
_WIDE = 1.2
#: Share of the points of a face that a direction has to reach.
_REACHED = 0.8


class FacePoints(NamedTuple):
    """Points of one face, (n, 3) mm, its normals there, and its area, mm^2."""

    point: np.ndarray
    normal: np.ndarray
    area: float


class PartCloud(NamedTuple):
    """A part as points, (k, 3) mm, and about how far they lie apart, mm."""

    point: np.ndarray
    spacing: float


def cloud_of(shapes):
    """A part as points on its faces and edges.

    Parameters
    ----------
    shapes : sequence of Part.Shape

    Returns
    -------
    PartCloud or None
        None where there is nothing to be seen.
    """
    faces = [face for shape in shapes for face in shape.Faces]
    if not faces:
        return None
    size = np.ptp([[getattr(shape.BoundBox, f"{axis}{end}") for axis in "XYZ"] for shape in shapes
                   for end in ("Min", "Max")], axis=0)
    spacing, rows = float(np.linalg.norm(size)) / _FINE, []
    for face in faces:
        with suppress(Exception):  # what cannot be looked at is seen by its edges
            rows += _inside(face, spacing)
        for edge in face.Edges:
            with suppress(Exception):  # an edge without a length
                rows += [tuple(at) for at in edge.discretize(int(np.clip(edge.Length / spacing, 2, _MOST)))]
    if not rows:
        return None
    points = np.array(rows)
    kept = np.unique((points / (spacing / 2)).round(), axis=0, return_index=True)[1]
    return PartCloud(points[np.sort(kept)], spacing)


def _inside(face, spacing):
    """Points of a face about so far apart; fewer where it is trimmed, as to ask for each of them is slow."""
    box = face.BoundBox
    count = int(np.clip(box.DiagonalLength / spacing, 2, _MOST))
    if _is_trimmed(face):
        count = min(count, _FEW)
        return [tuple(face.valueAt(u, v)) for u, v in _grid(face, count) if face.isPartOfDomain(u, v)]
    return [tuple(face.valueAt(u, v)) for u, v in _grid(face, count)]


def _is_trimmed(face):
    """Whether a face may lack part of what its parameters span; areas are asked of planes only, where that is fast."""
    if type(face.Surface).__name__ == "Plane":
        low_u, high_u, low_v, high_v = face.ParameterRange
        return face.Area < _ALL * (high_u - low_u) * (high_v - low_v)
    return len(face.Edges) > _SIDES


def _grid(face, count):
    """Parameters at the middles of so many cells along each side of a face."""
    low_u, high_u, low_v, high_v = face.ParameterRange
    steps = (np.arange(count) + 0.5) / count
    return [(low_u + (high_u - low_u) * s, low_v + (high_v - low_v) * t) for s in steps for t in steps]


def points_of(faces, areas):
    """Points and normals of the largest faces.

    Parameters
    ----------
    faces : sequence of Part.Face
    areas : sequence of float
        Theirs, mm^2.

    Returns
    -------
    list of FacePoints
    """
    found = []
    for area, face in sorted(zip(areas, faces, strict=True), key=lambda row: -row[0])[:_FACES]:
        rows = []
        for u, v in _grid(face, _SIDE):
            with suppress(Exception):  # no normal at a pole
                rows.append((*face.valueAt(u, v), *face.normalAt(u, v)))
        if rows:
            table = np.array(rows)
            found.append(FacePoints(table[:, :3], table[:, 3:], float(area)))
    return found


def with_most_area(values, areas, high):
    """The value that all but a small share of the area keep.

    Parameters
    ----------
    values, areas : sequence of float
    high : bool
        Whether values above it are for the rest, else those below it.
    """
    order = np.argsort(values)[:: 1 if high else -1]
    share = np.cumsum(np.array(areas)[order]) / sum(areas)
    return float(np.array(values)[order][np.searchsorted(share, 1 - _REST - 1e-9)])


def gap_before(face, cloud):
    """The distance across which something of the part stands before a face, mm; inf where nothing does.

    Parameters
    ----------
    face : FacePoints
    cloud : PartCloud

    Returns
    -------
    float
        The median over its points.
    """
    found = []
    for at, normal in zip(face.point, face.normal, strict=True):
        away = cloud.point - at
        along = away @ normal
        apart = np.sqrt(np.maximum((away**2).sum(axis=1) - along**2, 0.0))
        before = along[(apart < _WIDE * cloud.spacing) & (along > 2 * cloud.spacing)]
        found.append(before.min() if len(before) else np.inf)
    return float(np.median(found))


def depth_of(face, cloud, cutter, holder):
    """How far a tool has to stick out so that its holder stays above the part, with the best direction for a face, mm.

    Parameters
    ----------
    face : FacePoints
    cloud : PartCloud
    cutter, holder : float
        Radii, mm.
    """
    mean = face.normal.mean(axis=0)
    size = float(np.linalg.norm(mean))
    ways = _directions(mean / size if size > 1e-9 else face.normal[0])
    rows = []
    for at, normal in zip(face.point, face.normal, strict=True):
        away = cloud.point - (at + cutter * normal)
        along = away @ ways.T
        apart = np.sqrt(np.maximum((away**2).sum(axis=1)[:, None] - along**2, 0.0))
        blocked = ((apart < 0.9 * cutter) & (along > cutter)).any(axis=0) | (ways @ normal < 0)
        high = np.where(apart < holder, along + cutter, 0.0).max(axis=0)
        rows.append(np.where(blocked, np.inf, high))
    reached = int(np.ceil(_REACHED * len(rows))) - 1
    return float(np.sort(rows, axis=0)[reached].min())


def _directions(middle):
    """Directions around one, that itself the first, (n, 3)."""
    k = np.arange(_DIRECTIONS)
    height = 1 - (1 - np.cos(_LEAN)) * k / (_DIRECTIONS - 1)
    turn, out = k * np.pi * (3 - np.sqrt(5)), np.sqrt(np.maximum(1 - height**2, 0.0))
    aside = np.cross(middle, np.eye(3)[np.argmin(np.abs(middle))])
    aside /= np.linalg.norm(aside)
    return (height[:, None] * middle + (out * np.cos(turn))[:, None] * aside
            + (out * np.sin(turn))[:, None] * np.cross(middle, aside))


class FacesSeen:
    """Faces in their parts: their areas, the gap before them, and how deep they lie.

    Parameters
    ----------
    areas : list of float
        Of all faces, mm^2.
    points : list of FacePoints
        Of the largest of them.
    cloud : PartCloud or None
    """

    def __init__(self, areas, points, cloud):
        self.areas, self.points, self.cloud = areas, points if cloud is not None else [], cloud

    @classmethod
    def of(cls, faces, parts):
        """Look at faces.

        Parameters
        ----------
        faces : sequence of Part.Face
        parts : sequence of Part.Shape
            With them, and with all that stands around.
        """
        areas = [float(face.Area) for face in faces]
        return cls(areas, points_of(faces, areas), cloud_of(parts) if faces else None)

    @property
    def gap(self):
        """The gap before most of the faces, mm; inf where nothing stands before them."""
        return self._most([gap_before(one, self.cloud) for one in self.points], high=False, nothing=np.inf)

    def depth(self, cutter, holder):
        """How far a tool has to stick out for most of the faces, mm; those that no direction reaches aside.

        Parameters
        ----------
        cutter, holder : float
            Radii, mm.
        """
        return self._most([depth_of(one, self.cloud, cutter, holder) for one in self.points], high=True, nothing=0.0)

    def _most(self, values, high, nothing):
        known = [(value, one.area) for value, one in zip(values, self.points, strict=True)
                 if np.isfinite(value) or not high]
        return with_most_area(*zip(*known, strict=True), high) if known else nothing
