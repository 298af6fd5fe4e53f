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
        if self.feed == "u":
            return u0, u1, v0, v1
        return v0, v1, u0, u1

    def _uv(self, along: Array, step: Array) -> Array:
        columns = [along, step] if self.feed == "u" else [step, along]
        return np.column_stack(columns)

    @cached_property
    def _table(self) -> tuple[Array, Array, Array]:
        """Places around, steps along the span from the root to the tip, and heights there, (k, m)."""
        a0, a1, s0, s1 = self._bounds
        along = np.linspace(a0, a1, _AROUND + 1)
        step = np.linspace(s0, s1, _SPAN)
        every_along, every_step = np.meshgrid(along, step, indexing="ij")
        uv = self._uv(every_along.ravel(), every_step.ravel())
        heights = self.face.evaluate(uv).point @ self.direction
        heights = heights.reshape(_AROUND + 1, _SPAN)
        if heights[:, -1].mean() < heights[:, 0].mean():
            step = step[::-1]
            heights = heights[:, ::-1]
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
        low = float(heights[:, 0].max())
        high = float(heights[:, -1].min())
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
        t = self._steps_by_table(along, heights)
        _, _, s0, s1 = self._bounds
        low, high = sorted((float(s0), float(s1)))
        for _ in range(_NEWTON):
            within = np.clip(t, low, high)
            d = self.face.evaluate(self._uv(along, within))
            rate = d.sv if self.feed == "u" else d.su
            slope = rate @ self.direction
            above = d.point @ self.direction - heights
            t = within - above / slope
        return np.asarray(np.clip(t, low, high))

    def _steps_by_table(self, along: Array, heights: Array) -> Array:
        """About the same, from the table of heights by straight lines."""
        places, step, table = self._table
        share = (along - places[0]) / (places[1] - places[0])
        k = np.clip(share.astype(int), 0, len(places) - 2)
        rest = (share - k)[:, None]
        rows = table[k] + rest * (table[k + 1] - table[k])
        below = (rows < heights[:, None]).sum(axis=1)
        j = np.clip(below - 1, 0, len(step) - 2)
        at = np.arange(len(along))
        lower = rows[at, j]
        gap = step[j + 1] - step[j]
        return np.asarray(step[j] + gap * (heights - lower) / (rows[at, j + 1] - lower))

    def at(self, along: Array, heights: Array) -> tuple[Array, Array, Array]:
        """Contacts, normals and cutter centres, (n, 3) each.

        Parameters
        ----------
        along, heights : (n,) array
        """
        uv = self._uv(along, self.steps(along, heights))
        point = self.face.evaluate(uv).point
        normal = self.face.normal(uv)
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
            height = low + share * (high - low)
            at_height = self._parts_needed(fine, height, chord)
            need = np.maximum(need, at_height)
        from_before = np.maximum(need, np.roll(need, 1))
        need = np.maximum(from_before, np.roll(need, -1))
        total = np.concatenate([[0.0], np.cumsum(need)])
        number = int(np.ceil(total[-1])) + 1
        even = np.linspace(0, total[-1], number)
        return np.interp(even, total, fine)

    def _parts_needed(self, along: Array, height: float, chord: float) -> Array:
        """Into how many parts each gap between places at one height has to be divided, (n - 1,); less than one where a
        part may be longer."""
        point, normal, centre = self.at(along, np.full(len(along), height))
        turn = np.linalg.norm(np.diff(normal, axis=0), axis=1)
        bend = 2 * np.arcsin(np.clip(turn / 2, 0, 1))
        way = np.linalg.norm(np.diff(centre, axis=0), axis=1)
        need = np.maximum(way / _STEP, bend / _BEND)
        for path in (point, centre):
            size = np.linalg.norm(np.diff(path, axis=0), axis=1)
            by_chord = 1.1 * np.sqrt(bend * size / (8 * chord))
            need = np.maximum(need, by_chord)
        return np.asarray(need)

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
        usual = 2 * np.sqrt(2 * scallop * self.reach)
        lift = _USED * scallop + allowance
        steps = []
        for place in places:
            usual = self._step(float(place), usual, along, lift)
            steps.append(usual)
        found = [high]
        while found[-1] > low:
            if len(found) > _MOST:
                raise InvalidInput(f"more than {_MOST} layers would be needed on face {self.face.label}: give "
                                   f"{LARGER_SCALLOP} or cutter")
            last = found[-1]
            step = _EVEN * float(np.interp(-last, -places, steps))
            found.append(max(last - step, low))
        return np.array(found)

    def _step(self, top: float, most: float, along: Array, lift: float) -> float:
        """How far below a layer the next one may lie."""
        at_top = np.full(len(along), top)
        upper = self.at(along, at_top)[2]
        first = self.steps(along, at_top)
        every_along = np.tile(along, len(_PLACES))
        every_first = np.tile(first, len(_PLACES))
        share = np.repeat(np.array(_PLACES), len(along))
        good = 0.0
        bad = np.inf
        for _ in range(_HALVINGS):
            if bad == np.inf:
                middle = 1.2 * good or most
            else:
                middle = (good + bad) / 2
            below = np.full(len(along), max(top - middle, self.span[0]))
            last = self.steps(along, below)
            lower = self.at(along, below)[2]
            between = every_first * (1 - share) + np.tile(last, len(_PLACES)) * share
            uv = self._uv(every_along, between)
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
    sides = len(curve) - 1
    rows = points.reshape(-1, len(curve), 3)
    best = np.full(rows.shape[:2], np.inf)
    here = np.arange(len(curve))
    for shift in range(-_BESIDE, _BESIDE):
        side = (here + shift) % sides
        a = curve[side]
        way = curve[side + 1] - a
        square = np.maximum((way**2).sum(axis=1), 1e-18)
        offset = rows - a
        t = (offset * way).sum(axis=2) / square
        t = np.clip(t, 0.0, 1.0)
        away = np.linalg.norm(offset - t[..., None] * way, axis=2)
        best = np.minimum(best, away)
    return np.asarray(best.ravel())


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
    if face.trims:
        raise InvalidInput(f"face {face.label} is trimmed: layers go around a whole closed face of a blade")
    u0, u1, v0, v1 = face.bounds
    for name, begin, end in (("u", u0, u1), ("v", v0, v1)):
        one = face.evaluate(_line_across(face, name, begin, 9)).point
        other = face.evaluate(_line_across(face, name, end, 9)).point
        if np.linalg.norm(one - other, axis=1).max() <= _CLOSED * face.diagonal:
            return name
    raise InvalidInput(f"face {face.label} does not close around a blade, so its sections are open, and its "
                       "neighbours do not continue it smoothly all around: join the faces that go around, such as "
                       "1+3+4+7")


def _line_across(face: Face, name: str, value: float, number: int) -> Array:
    """Even places on the line along which a parameter has one value, (n, 2)."""
    u0, u1, v0, v1 = face.bounds
    share = np.linspace(0, 1, number)
    held = np.full(number, value)
    if name == "u":
        return np.column_stack([held, v0 + share * (v1 - v0)])
    return np.column_stack([u0 + share * (u1 - u0), held])


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
    for place in (0.25, 0.5, 0.75):
        if feed == "u":
            uv = _line_across(face, "v", v0 + place * (v1 - v0), 201)
        else:
            uv = _line_across(face, "u", u0 + place * (u1 - u0), 201)
        rows = face.evaluate(uv).point
        rows = rows - rows.mean(axis=0)
        areas = np.cross(rows[:-1], rows[1:])
        total += np.asarray(unit(areas.sum(axis=0)))
    return np.asarray(unit(total))
