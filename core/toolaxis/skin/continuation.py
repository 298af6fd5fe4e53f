"""How faces in a plane go on beyond the line around them: along their tangent planes first, then as a spline does."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toolaxis.numeric.polygons import stations, walk
from toolaxis.shape.surface import Derivatives
from toolaxis.skin.band_kernel import PLAIN, TRIED, BandTable
from toolaxis.skin.faces_in_view import FacesInView
from toolaxis.skin.point_grid import sort_into_cells

Array = NDArray[np.float64]

#: Points along a loop, as shares of the width of the band, from which the nearest place on it is looked for.
_DENSE = 0.25


class Heights(NamedTuple):
    """Heights over a plane and their derivatives there.

    value : (n,) array, mm;  slope : (n, 2) array;  bend : (n, 2, 2) array, 1/mm
    """

    value: Array
    slope: Array
    bend: Array


def heights_of(points: Derivatives, frame: Array, origin: Array) -> Heights:
    """Heights of points over a plane, and their derivatives with the place in it.

    Parameters
    ----------
    points : Derivatives
        With the place in the plane.
    frame : (3, 3) array
        Coordinates in the plane and height are frame @ (p - origin).
    origin : (3,) array
        mm
    """
    up = frame[2]
    suu, suv, svv = points.suu @ up, points.suv @ up, points.svv @ up
    bend = np.stack([np.column_stack([suu, suv]), np.column_stack([suv, svv])], axis=1)
    return Heights((points.point - origin) @ up, np.column_stack([points.su @ up, points.sv @ up]), bend)


class _Feet(NamedTuple):
    """The nearest places on a line to places beside it.

    place : (n, 2) array;  way : (n, 2) array, unit direction of the line there, zero where it is a corner
    distance : (n,) array, mm
    """

    place: Array
    way: Array
    distance: Array


@dataclass(frozen=True, eq=False)
class Continuation:
    """The band beyond the outline in which faces go on along their tangent planes.

    Without it points would leave the faces with a jump at their outline: a spline through points of all of them is
    not exact there, above all next to a fillet that is narrower than the spline's steps.

    Attributes
    ----------
    view : FacesInView
    frame : (3, 3) array
        Coordinates in the plane and height are frame @ (p - origin).
    origin : (3,) array
        mm
    width : float
        Of the band, mm.
    rise : float
        What tangent planes rise or fall at most, mm; they level off.
    """

    view: FacesInView
    frame: Array
    origin: Array
    width: float
    rise: float

    @cached_property
    def table(self) -> BandTable:
        """The band for the kernel, `toolaxis.skin.view_kernel.evaluate_view`."""
        along = np.ascontiguousarray(np.linalg.inv(self.frame)[:, 2])
        return BandTable(sort_into_cells(self._points, self.width), np.column_stack(self._edges).astype(np.int64),
                         np.hstack(self._line), np.array(self.frame[2]), along, float(self.width), float(self.rise))

    def blend_heights(self, places: Array, spline: Heights) -> Heights:
        """Heights beyond the outline: tangent planes near it, those of a spline from the end of the band on.

        Parameters
        ----------
        places : (n, 2) array
            Beyond the outline.
        spline : Heights
            There.
        """
        found = Heights(*(every.copy() for every in spline))
        near = self._tree.query(places, distance_upper_bound=self.width)[0] < np.inf
        if near.any():
            some = Heights(*(every[near] for every in spline))
            for every, own in zip(found, self._blend(places[near], some), strict=True):
                every[near] = own
        return found

    def _blend(self, places: Array, spline: Heights) -> Heights:
        """Both, weighed by the distance from the outline."""
        feet = self._feet(places)
        plane = self._planes(places, feet)
        away = places - feet.place
        distance = np.maximum(feet.distance, np.finfo(float).tiny)
        out = away / distance[:, None]
        weight, first, second = _weigh(feet.distance / self.width)
        first, second = first / self.width, second / self.width**2
        off = plane.value - spline.value
        turn = plane.slope - spline.slope
        across = _outer(out, out)
        # around a corner of the line the distance bends too
        corner = (feet.way == 0).all(axis=1)
        round_ = np.where(corner, 1.0 / distance, 0.0)[:, None, None] * (np.eye(2) - across)
        bend = (spline.bend + weight[:, None, None] * (plane.bend - spline.bend)
                + first[:, None, None] * (_outer(out, turn) + _outer(turn, out) + off[:, None, None] * round_)
                + (off * second)[:, None, None] * across)
        slope = spline.slope + weight[:, None] * turn + (first * off)[:, None] * out
        return Heights(spline.value + weight * off, slope, bend)

    def _planes(self, places: Array, feet: _Feet) -> Heights:
        """Tangent planes at the nearest places of the outline; their third derivatives along it are left out."""
        d = self.view.evaluate(feet.place, self.view.nearest(feet.place))
        height, slope, bend = heights_of(d, self.frame, self.origin)
        away, way = places - feet.place, feet.way
        turning = np.einsum("nij,nj->ni", bend, way)  # of the slope, a step farther along the line
        climb = (away * slope).sum(axis=1)
        share = 1.0 / (1.0 + np.abs(climb) / self.rise)
        flatter = share**2
        along, bent = (slope * way).sum(axis=1), (turning * way).sum(axis=1)
        aside = slope - along[:, None] * way + (away * turning).sum(axis=1)[:, None] * way
        turned = turning - bent[:, None] * way
        curved = (bent[:, None, None] * _outer(way, way)
                  + flatter[:, None, None] * (_outer(turned, way) + _outer(way, turned))
                  - (2 * np.sign(climb) * share**3 / self.rise)[:, None, None] * _outer(aside, aside))
        return Heights(height + climb * share, along[:, None] * way + flatter[:, None] * aside, curved)

    def _feet(self, places: Array) -> _Feet:
        """The nearest places on the outline."""
        count = min(TRIED, len(self._points))
        samples = self._tree.query(places, k=count)[1].reshape(len(places), count)
        edges = np.concatenate([self._edges[0][samples], self._edges[1][samples]], axis=1)
        start, end = self._line[0][edges], self._line[1][edges]
        way = end - start
        length = np.maximum(np.linalg.norm(way, axis=2), np.finfo(float).tiny)
        way = way / length[..., None]
        along = ((places[:, None] - start) * way).sum(axis=2)
        held = np.clip(along, 0.0, length)
        foot = start + held[..., None] * way
        distance = np.linalg.norm(places[:, None] - foot, axis=2)
        rows, best = np.arange(len(places)), distance.argmin(axis=1)
        inner = (held == along)[rows, best]
        return _Feet(foot[rows, best], np.where(inner[:, None], way[rows, best], 0.0), distance[rows, best])

    @cached_property
    def _line(self) -> tuple[Array, Array]:
        """Starts and ends of the outline's edges, (k, 2) each."""
        return (np.concatenate(self.view.outline),
                np.concatenate([np.roll(loop, -1, axis=0) for loop in self.view.outline]))

    @cached_property
    def _stations(self) -> tuple[Array, Array, Array]:
        """Points along the outline, (n, 2), and the edges, (n,) each, before and behind them."""
        step = _DENSE * self.width
        points, before, behind = [], [], []
        first = 0
        for loop in self.view.outline:
            at = stations(loop, (step, step))
            edge = np.floor(at).astype(np.intp)
            points.append(walk(loop, at))
            behind.append(first + edge)
            before.append(first + np.where(at == edge, (edge - 1) % len(loop), edge))
            first += len(loop)
        return np.concatenate(points), np.concatenate(before), np.concatenate(behind)

    @property
    def _points(self) -> Array:
        return self._stations[0]

    @property
    def _edges(self) -> tuple[Array, Array]:
        return self._stations[1:]

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self._points)


def _weigh(share: Array) -> tuple[Array, Array, Array]:
    """The weight of tangent planes at shares of the band's width, and its first and second derivatives: C2."""
    t = np.clip((share - PLAIN) / (1 - PLAIN), 0.0, 1.0)
    weight = 1 - t**3 * (10 - 15 * t + 6 * t**2)
    first = -30 * t**2 * (1 - t) ** 2
    second = -60 * t * (1 - t) * (1 - 2 * t)
    return weight, first / (1 - PLAIN), second / (1 - PLAIN) ** 2


def _outer(a: Array, b: Array) -> Array:
    """Products of the components of vectors, (n, 2, 2)."""
    return np.asarray(a[:, :, None] * b[:, None, :])
