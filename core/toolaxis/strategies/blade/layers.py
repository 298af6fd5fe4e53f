"""Layers of a path around a blade: plane sections of its closed face, as far apart as a ball end's scallops allow."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from toolaxis.advice import LARGER_SCALLOP, SMALLER_CUTTER
from toolaxis.errors import InvalidInput
from toolaxis.numeric.vectors import unit
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

#: Border points that must meet where a face closes, as a share of its size.
_CLOSED = 1e-4
#: Places around and along the span at which heights are tabulated, steps of Newton's method, and samples for spacing
#: points.
_AROUND, _SPAN, _NEWTON, _SAMPLES = 400, 33, 6, 2400
#: Longest step along a layer, mm, and greatest turn of the normal in one, rad.
_STEP, _BEND = 2.0, np.radians(4.0)
#: Heights at which points are spaced.
_HEIGHTS = (0.01, 0.17, 0.34, 0.5, 0.67, 0.84, 0.99)
#: Places between two layers at which scallops are looked at, neighbours along a layer that may reach them, and the
#: share of the scallop height that layers use.
_PLACES, _BESIDE, _USED = (0.42, 0.5, 0.58), 4, 0.94
#: Heights at which steps are sought, how often each is halved, the share of steps that is taken between them, and the
#: most layers.
_SPACED, _HALVINGS, _EVEN, _MOST = 9, 8, 0.98, 5000


@dataclass(frozen=True, eq=False)
class Ring:
    """A closed face of a blade, cut by planes across a direction.

    Attributes
    ----------
    face : Face
        Closed in one parameter; untrimmed.
    feed : str
        That parameter.
    direction : (3,) array
        Unit vector across the planes, from the root to the tip.
    reach : float
        Distance of cutter centres from the face: ball radius and allowance, mm.
    """

    face: Face
    feed: str
    direction: Array
    reach: float

    @property
    def _bounds(self) -> tuple[float, float, float, float]:
        u0, u1, v0, v1 = self.face.bounds
        return (u0, u1, v0, v1) if self.feed == "u" else (v0, v1, u0, u1)

    def _uv(self, along: Array, step: Array) -> Array:
        return np.column_stack([along, step] if self.feed == "u" else [step, along])

    @cached_property
    def _table(self) -> tuple[Array, Array, Array]:
        """Places around, steps along the span from the root to the tip, and heights there, (k, m)."""
        a0, a1, s0, s1 = self._bounds
        along, step = np.linspace(a0, a1, _AROUND + 1), np.linspace(s0, s1, _SPAN)
        grid = [part.ravel() for part in np.meshgrid(along, step, indexing="ij")]
        heights = (self.face.evaluate(self._uv(*grid)).point @ self.direction).reshape(_AROUND + 1, _SPAN)
        if heights[:, -1].mean() < heights[:, 0].mean():
            step, heights = step[::-1], heights[:, ::-1]
        if not (np.diff(heights, axis=1) > 0).all():
            raise InvalidInput(f"planes across the rotary axis cut face {self.face.label} more than once between root "
                               "and tip: turn the part on the table so that its blade stands along that axis")
        return along, step, heights

    @cached_property
    def span(self) -> tuple[float, float]:
        """Heights between which planes cut the face all around, mm.

        Raises
        ------
        InvalidInput
            When none does.
        """
        _, _, heights = self._table
        low, high = float(heights[:, 0].max()), float(heights[:, -1].min())
        if not low < high:
            raise InvalidInput(f"no plane across the rotary axis cuts face {self.face.label} all around: its sections "
                               "are open; turn the part so that the blade stands along that axis")
        return low, high

    def steps(self, along: Array, heights: Array) -> Array:
        """Step parameters at which places around have given heights, (n,).

        Parameters
        ----------
        along, heights : (n,) array
        """
        places, step, table = self._table
        share = (along - places[0]) / (places[1] - places[0])
        k = np.clip(share.astype(int), 0, len(places) - 2)
        rows = table[k] + (share - k)[:, None] * (table[k + 1] - table[k])
        j = np.clip((rows < heights[:, None]).sum(axis=1) - 1, 0, len(step) - 2)
        at = np.arange(len(along))
        t = step[j] + (step[j + 1] - step[j]) * (heights - rows[at, j]) / (rows[at, j + 1] - rows[at, j])
        low, high = sorted((float(step[0]), float(step[-1])))
        for _ in range(_NEWTON):
            d = self.face.evaluate(self._uv(along, np.clip(t, low, high)))
            slope = (d.sv if self.feed == "u" else d.su) @ self.direction
            t = np.clip(t, low, high) - (d.point @ self.direction - heights) / slope
        return np.asarray(np.clip(t, low, high))

    def at(self, along: Array, heights: Array) -> tuple[Array, Array, Array]:
        """Contacts, normals and cutter centres, (n, 3) each.

        Parameters
        ----------
        along, heights : (n,) array
        """
        uv = self._uv(along, self.steps(along, heights))
        point, normal = self.face.evaluate(uv).point, self.face.normal(uv)
        return point, normal, point + self.reach * normal

    def places(self, chord: float) -> Array:
        """Places around, ascending, both ends included, at which straight motions keep the chord tolerance, (n,).

        Parameters
        ----------
        chord : float
            mm
        """
        a0, a1, _, _ = self._bounds
        fine = np.linspace(a0, a1, _SAMPLES + 1)
        need = np.zeros(_SAMPLES)
        low, high = self.span
        for share in _HEIGHTS:
            point, normal, centre = self.at(fine, np.full(_SAMPLES + 1, low + share * (high - low)))
            way = np.linalg.norm(np.diff(centre, axis=0), axis=1)
            bend = 2 * np.arcsin(np.clip(np.linalg.norm(np.diff(normal, axis=0), axis=1) / 2, 0, 1))
            for path in (point, centre):
                size = np.linalg.norm(np.diff(path, axis=0), axis=1)
                need = np.maximum(need, 1.1 * np.sqrt(bend * size / (8 * chord)))
            need = np.maximum(need, np.maximum(way / _STEP, bend / _BEND))
        need = np.maximum(np.maximum(need, np.roll(need, 1)), np.roll(need, -1))
        total = np.concatenate([[0.0], np.cumsum(need)])
        count = int(np.ceil(total[-1])) + 1
        return np.interp(np.linspace(0, total[-1], count), total, fine)

    def heights(self, along: Array, scallop: float, allowance: float) -> Array:
        """Heights of layers, from the tip to the root, whose scallops stay below a height, (k,) mm.

        Parameters
        ----------
        along : (n,) array
            Places around.
        scallop, allowance : float
            mm
        """
        low, high = self.span
        places = high - (high - low) * np.linspace(0.0, 0.97, _SPACED)
        usual, steps = 2 * np.sqrt(2 * scallop * self.reach), []
        for place in places:
            usual = self._step(float(place), usual, along, _USED * scallop + allowance)
            steps.append(usual)
        found = [high]
        while found[-1] > low:
            if len(found) > _MOST:
                raise InvalidInput(f"more than {_MOST} layers would be needed on face {self.face.label}: give "
                                   f"{LARGER_SCALLOP} or cutter")
            step = _EVEN * float(np.interp(-found[-1], -places, steps))
            found.append(max(found[-1] - step, low))
        return np.array(found)

    def _step(self, top: float, most: float, along: Array, lift: float) -> float:
        """How far below a layer the next one may lie."""
        upper = self.at(along, np.full(len(along), top))[2]
        first = self.steps(along, np.full(len(along), top))
        good, bad = 0.0, np.inf
        for _ in range(_HALVINGS):
            middle = (1.2 * good or most) if bad == np.inf else (good + bad) / 2
            below = np.full(len(along), max(top - middle, self.span[0]))
            last = self.steps(along, below)
            lower = self.at(along, below)[2]
            share = np.repeat(np.array(_PLACES), len(along))
            uv = self._uv(np.tile(along, len(_PLACES)), np.tile(first, len(_PLACES)) * (1 - share)
                          + np.tile(last, len(_PLACES)) * share)
            points = self.face.evaluate(uv).point + lift * self.face.normal(uv)
            away = np.minimum(_to_curve(points, upper), _to_curve(points, lower))
            if (away <= self.reach).all():
                good = middle
            else:
                bad = middle
        if good == 0.0:
            raise InvalidInput(f"no layer below height {top:.3f} mm keeps the scallop height on face "
                               f"{self.face.label}: give a larger one, or {SMALLER_CUTTER} where it is concave")
        return good


def _to_curve(points: Array, curve: Array) -> Array:
    """Distance of m rows of points to a closed polygon with as many points as a row, near the same place of it."""
    count = len(curve) - 1
    rows = points.reshape(-1, len(curve), 3)
    best = np.full(rows.shape[:2], np.inf)
    here = np.arange(len(curve))
    for shift in range(-_BESIDE, _BESIDE):
        a, b = curve[(here + shift) % count], curve[(here + shift) % count + 1]
        way = b - a
        t = np.clip(((rows - a) * way).sum(axis=2) / np.maximum((way**2).sum(axis=1), 1e-18), 0.0, 1.0)
        best = np.minimum(best, np.linalg.norm(rows - a - t[..., None] * way, axis=2))
    return best.ravel()


def find_closed_parameter(face: Face) -> str:
    """The parameter in which a face closes.

    Parameters
    ----------
    face : Face

    Raises
    ------
    InvalidInput
        When it closes in neither, or is trimmed.
    """
    u0, u1, v0, v1 = face.bounds
    if face.trims:
        raise InvalidInput(f"face {face.label} is trimmed: layers go around a whole closed face of a blade")
    share = np.linspace(0, 1, 9)
    for name, ends in (("u", [np.column_stack([np.full(9, u), v0 + share * (v1 - v0)]) for u in (u0, u1)]),
                       ("v", [np.column_stack([u0 + share * (u1 - u0), np.full(9, v)]) for v in (v0, v1)])):
        one, other = (face.evaluate(uv).point for uv in ends)
        if np.linalg.norm(one - other, axis=1).max() <= _CLOSED * face.diagonal:
            return name
    raise InvalidInput(f"face {face.label} does not close around a blade, so its sections are open, and its "
                       "neighbours do not continue it smoothly all around: join the faces that go around, such as "
                       "1+3+4+7")


def along_blade(face: Face, feed: str) -> Array:
    """The direction across a closed face's own closed lines, (3,): the mean of the areas that they go around.

    Parameters
    ----------
    face : Face
    feed : str
        The closed parameter.
    """
    u0, u1, v0, v1 = face.bounds
    total = np.zeros(3)
    share = np.linspace(0, 1, 201)
    for place in (0.25, 0.5, 0.75):
        uv = np.column_stack([u0 + share * (u1 - u0), np.full(201, v0 + place * (v1 - v0))]) if feed == "u" else \
            np.column_stack([np.full(201, u0 + place * (u1 - u0)), v0 + share * (v1 - v0)])
        rows = face.evaluate(uv).point
        rows = rows - rows.mean(axis=0)
        total += np.asarray(unit(np.cross(rows[:-1], rows[1:]).sum(axis=0)))
    return np.asarray(unit(total))
