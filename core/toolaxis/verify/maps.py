"""Maps over a face: scallop left and gouge, the worst places, the share within a limit, and zones to clean up."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from toolaxis.shape.face import Face
from toolaxis.verify.material_removal import RestMaterial
from toolaxis.verify.rays import Rays, face_rays, patch_around

Array = NDArray[np.float64]
Declared = Callable[[Array, Array], NDArray[np.bool_]]

#: Rays around which the worst is looked for more closely, rounds of that, and how much closer each looks.
_STARTS, _ROUNDS, _SHRINK = 8, 6, 0.4
#: What a map has for every ray.
_PER_RAY = ("uv", "point", "weight", "border", "remaining", "gouge", "cut_by", "gouged_by", "declared")


@dataclass(frozen=True)
class MapPoint:
    """A place on a face and the value there.

    Attributes
    ----------
    face : str
        Label of the face.
    uv : (float, float)
    point : (float, float, float)
        mm
    value : float
        Height or depth, mm.
    motion : int
        Index of the cutter location whose motion did it; -1 where none did.
    """

    face: str
    uv: tuple[float, float]
    point: tuple[float, float, float]
    value: float
    motion: int


@dataclass(frozen=True)
class MapZone:
    """A connected zone of a face that is left above the limit.

    Attributes
    ----------
    face : str
    area : float
        mm^2
    low, high : (float, float, float)
        Box around its rays, mm.
    largest : float
        Greatest height left, mm; inf where a ray was never reached.
    reason : str
        "not reached", or "above the limit".
    at_border : bool
        Whether it touches the border of the face.
    """

    face: str
    area: float
    low: tuple[float, float, float]
    high: tuple[float, float, float]
    largest: float
    reason: str
    at_border: bool


@dataclass(frozen=True, eq=False)
class SurfaceMap:
    """What is left on one face.

    Attributes
    ----------
    face : Face
    uv, point, weight, border : arrays
        As in `Rays`.
    remaining, gouge : (m,) array
        mm
    cut_by, gouged_by : (m,) array of int
        Index of the cutter location whose motion did it; -1 where none did.
    spacing : float
        Distance of neighbouring rays, mm.
    worst_scallop, worst_gouge : MapPoint or None
        The worst found by looking more closely around the worst rays; None without a finite height or without a gouge.
    declared : (m,) array of bool
        Whether the ray stands in a zone that is declared as left as rest material: no height is asked for there.
    """

    face: Face
    uv: Array
    point: Array
    weight: Array
    border: NDArray[np.bool_]
    remaining: Array
    gouge: Array
    cut_by: NDArray[np.int64]
    gouged_by: NDArray[np.int64]
    spacing: float
    worst_scallop: MapPoint | None
    worst_gouge: MapPoint | None
    declared: NDArray[np.bool_]

    @property
    def area(self) -> float:
        """Area that the rays stand for, mm^2."""
        return float(self.weight.sum())

    @property
    def left(self) -> float:
        """Area of the declared zones and the strip around them, mm^2."""
        return float(self.weight[self.declared].sum())

    def touched(self) -> "SurfaceMap":
        """The map with only those rays that something cut or gouged."""
        rows = np.flatnonzero((self.cut_by >= 0) | (self.gouged_by >= 0))
        kept = {name: getattr(self, name)[rows] for name in _PER_RAY}
        return replace(self, **kept)

    def area_within(self, limit: float) -> float:
        """Area left no higher than a limit, declared zones aside, mm^2.

        Parameters
        ----------
        limit : float
            mm
        """
        return float(self.weight[~self.declared & (self.remaining <= limit)].sum())

    def share_within(self, limit: float) -> float:
        """Share of the area, declared zones aside, that is left no higher than a limit, 0 to 1; 1 of no area.

        Parameters
        ----------
        limit : float
            mm
        """
        asked = self.area - self.left
        return self.area_within(limit) / asked if asked > 0 else 1.0

    def histogram(self, edges: Array) -> Array:
        """Area left between consecutive heights, mm^2; the last entry is the area above the last of them.

        Parameters
        ----------
        edges : (k,) array
            Increasing heights from 0, mm.

        Returns
        -------
        (k,) array
        """
        slot = np.clip(np.searchsorted(edges, self.remaining, side="left") - 1, 0, len(edges) - 1)
        return np.asarray(np.bincount(slot, weights=self.weight, minlength=len(edges)), dtype=np.float64)

    def worst(self, what: str, count: int = 10) -> tuple[MapPoint, ...]:
        """The worst places, no two closer than eight spacings, the worst first.

        Parameters
        ----------
        what : str
            "remaining" or "gouge".
        count : int
        """
        value = np.where(self.declared, 0.0, self.remaining) if what == "remaining" else self.gouge
        by = self.cut_by if what == "remaining" else self.gouged_by
        refined = self.worst_scallop if what == "remaining" else self.worst_gouge
        found: list[MapPoint] = []
        if refined is not None and not (what == "remaining" and np.isinf(value).any()):
            found.append(refined)
        for i in np.argsort(-value, kind="stable"):
            if len(found) >= count or value[i] <= 0:
                break
            apart = (np.linalg.norm(np.subtract(p.point, self.point[i])) >= 8 * self.spacing for p in found)
            if all(apart):
                found.append(place_at(self.face, self.uv[i], self.point[i], (float(value[i]), int(by[i]))))
        return tuple(found)

    def zones(self, limit: float) -> tuple[MapZone, ...]:
        """Connected zones left above a limit, declared ones aside, the largest first.

        Parameters
        ----------
        limit : float
            mm
        """
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components
        from scipy.spatial import cKDTree

        above = np.flatnonzero(~self.declared & (self.remaining > limit))
        if not len(above):
            return ()
        pairs = cKDTree(self.point[above]).query_pairs(2.0 * self.spacing, output_type="ndarray")
        graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(above), len(above)))
        number, label = connected_components(graph, directed=False)
        zones = [self._zone(above[label == k]) for k in range(number)]
        return tuple(sorted(zones, key=lambda zone: (-zone.area, zone.low)))

    def _zone(self, rows: NDArray[np.int64]) -> MapZone:
        point = self.point[rows]
        low = _triple(point.min(axis=0))
        high = _triple(point.max(axis=0))
        area = float(self.weight[rows].sum())
        remaining = self.remaining[rows]
        cause = "not reached" if np.isinf(remaining).any() else "above the limit"
        on_border = bool(self.border[rows].any())
        return MapZone(self.face.label, area, low, high, float(remaining.max()), cause, on_border)


def _triple(row: Array) -> tuple[float, float, float]:
    return float(row[0]), float(row[1]), float(row[2])


def place_at(face: Face, uv: Array, point: Array, found: tuple[float, int]) -> MapPoint:
    """A place from rows of arrays.

    Parameters
    ----------
    face : Face
    uv : (2,) array
    point : (3,) array
        mm
    found : (float, int)
        Value, mm, and index of the cutter location; -1 where none did it.
    """
    return MapPoint(face.label, (float(uv[0]), float(uv[1])), _triple(point), *found)


def surface_map(face: Face, judge: Callable[[Array, Array], RestMaterial], spacing: float | None = None, *,
                declared: Declared | None = None, heights: bool = True) -> SurfaceMap:
    """Maps of one face.

    Parameters
    ----------
    face : Face
    judge : callable
        `removal` with everything but points and normals given.
    spacing : float, optional
        Distance of neighbouring rays, mm.
    declared : callable, optional
        Takes parameters (m, 2) and points (m, 3) and tells which of them lie in declared zones.
    heights : bool
        Whether the greatest height is looked for more closely, as on what is machined.
    """
    rays = face_rays(face, spacing)
    left = judge(rays.point, rays.normal)
    aside = np.zeros(len(rays.uv), dtype=bool) if declared is None else declared(rays.uv, rays.point)
    finite = np.where(np.isfinite(left.remaining) & ~aside, left.remaining, -1.0)
    worst_scallop = _sharpen_worst(face, rays, judge, ("remaining", finite, left.cut_by), declared) if heights else None
    worst_gouge = _sharpen_worst(face, rays, judge, ("gouge", left.gouge, left.gouged_by))
    return SurfaceMap(face, rays.uv, rays.point, rays.weight, rays.border, left.remaining, left.gouge, left.cut_by,
                      left.gouged_by, rays.spacing, worst_scallop, worst_gouge, aside)


def _sharpen_worst(face: Face, rays: Rays, judge: Callable[[Array, Array], RestMaterial],
                   coarse: tuple[str, Array, NDArray[np.int64]],
                   aside: Declared | None = None) -> MapPoint | None:
    """The worst place, looked for in ever smaller patches around the worst rays, and not where it is aside."""
    what, value, by = coarse
    if value.max() <= 0:
        return None
    i = int(value.argmax())
    best = place_at(face, rays.uv[i], rays.point[i], (float(value[i]), int(by[i])))
    starts, size = _highest_apart(rays.uv, rays.point, value, rays.spacing), rays.spacing
    for _ in range(_ROUNDS):
        uv = patch_around(face, starts, size) if len(starts) else starts
        if not len(uv):
            break
        point = face.evaluate(uv).point
        left = judge(point, face.normal(uv))
        height = np.where(np.isfinite(getattr(left, what)), getattr(left, what), -1.0)
        if aside is not None:
            height[aside(uv, point)] = -1.0
        index = left.cut_by if what == "remaining" else left.gouged_by
        i = int(height.argmax())
        if height[i] > best.value:
            best = place_at(face, uv[i], point[i], (float(height[i]), int(index[i])))
        starts = _highest_apart(uv, point, height, size / 2)
        size *= _SHRINK
    return best


def _highest_apart(uv: Array, point: Array, height: Array, apart: float) -> Array:
    """Parameters of the highest places above zero, (k, 2), none nearer to another than `apart`, mm: so patches around
    them cover more."""
    order = np.argsort(-height, kind="stable")
    order = order[height[order] > 0]
    taken: list[int] = []
    while len(order) and len(taken) < _STARTS:
        taken.append(int(order[0]))
        away = np.linalg.norm(point[order] - point[order[0]], axis=1)
        order = order[away >= apart]
    return uv[taken]
