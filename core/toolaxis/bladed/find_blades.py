"""Blades on a hub, found by the rotational symmetry of a part's faces."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from toolaxis.errors import UnsupportedGeometry
from toolaxis.numeric.rounding import canonical_sign
from toolaxis.numeric.vectors import lengths
from toolaxis.shape.face import Face
from toolaxis.shape.part import Part

Array = NDArray[np.float64]

#: Samples along each side of a face.
SAMPLES = 9
#: A face is of revolution where its normals pass the axis within this share of their distance from it.
MEETS = 2e-3
#: The same for an axis that is not yet known exactly.
_ROUGHLY = 0.02
_ROUND_KINDS = ("cylinder", "cone", "torus", "revolution")
#: Two lines are met by all normals where the second singular value is below this share of the first.
_ROUND = 1e-6
#: Faces are alike within this share of their area, and in place within this share of the part's diagonal.
ALIKE, IN_PLACE = 0.03, 0.01
#: The flow turns outwards where the edges' distances from the axis differ by more than this share.
OUTWARDS = 0.15
#: Faces and blades smaller than this share of the largest are not looked at.
SMALL = 0.01
#: An axis of faces of revolution is preferred to one of inertia, and more equal parts to fewer, where they fit so
#: little worse: a blade may be a little out of place.
_SLACK = 0.03
#: Most blades that are looked for, and the least share of faces in place that is a pattern at all.
MOST, PATTERN = 100, 0.6


class NoPattern(UnsupportedGeometry):
    """The part is not one with blades."""


@dataclass(frozen=True)
class Blade:
    """The faces of one blade, by number.

    Attributes
    ----------
    suction, pressure : tuple of int
        Its sides: the one that bulges, and the one that is more hollow.
    leading, trailing : tuple of int
        Faces between the sides at both ends of the chord; empty where the sides meet in an edge.
    fillets : tuple of int
        Faces that join the blade to the hub smoothly.
    tip : tuple of int
        Faces of revolution that border this blade only.
    others : tuple of int
        What else belongs to it.
    """

    suction: tuple[int, ...]
    pressure: tuple[int, ...]
    leading: tuple[int, ...]
    trailing: tuple[int, ...]
    fillets: tuple[int, ...]
    tip: tuple[int, ...]
    others: tuple[int, ...]

    @property
    def faces(self) -> tuple[int, ...]:
        """All its faces."""
        named = self.suction + self.pressure + self.leading + self.trailing + self.fillets + self.tip
        return tuple(sorted(named + self.others))


@dataclass(frozen=True, eq=False)
class Bladed:
    """A part with blades.

    Attributes
    ----------
    point, axis : (3,) array
        A point of the axis, mm, and its direction, in the sense whose first component that is not zero is negative.
    blades : tuple of Blade
        In the order in which a right-handed turn about the axis meets them.
    hub : tuple of int
        Faces of revolution of the bodies that the blades' own bodies stand on; where blades and hub are one body, those
        that border a blade or its fillets, tips apart.
    """

    point: Array
    axis: Array
    blades: tuple[Blade, ...]
    hub: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class _Samples:
    """What is known of each face by its number: points, normals, mean curvature, centre, area."""

    points: dict[int, Array]
    normals: dict[int, Array]
    bulge: dict[int, float]
    centre: dict[int, Array]
    area: dict[int, float]


def blades_of(part: Part) -> Bladed:
    """Hub and blades of a blisk, a fan or an impeller.

    Parameters
    ----------
    part : Part

    Raises
    ------
    NoPattern
        When no axis has a pattern of faces around it, or what stands around it has no two sides.
    UnsupportedGeometry
        When the pattern has faces missing or out of place, or blades touch.

    Notes
    -----
    Leading is the edge nearer the axis where the flow turns outwards, else the end where the sides stand flatter to
    the axis, as on a compressor; of a turbine wheel the two names are the wrong way round.

    **Source**: [zhu2016] Sec. 6.6 takes suction side, pressure side, leading and trailing edge as given.

    **Properties**: 1. moving the part changes the axis only; 2. every face belongs to one blade at most.
    """
    samples = _sample_faces(part)
    sculptured = [face.number for face in part.sculptured]
    if not sculptured:
        raise NoPattern("the part has no sculptured face: blades are looked for among those")
    pattern = _pattern(part, samples, sculptured)
    point = pattern.point
    count = pattern.parts
    axis = -canonical_sign(pattern.axis)
    strangers = pattern.strangers
    if strangers:
        raise UnsupportedGeometry(f"a turn by 1/{count} puts {len(strangers)} faces where no face like them is (face "
                                  f"{strangers[0]} the first): blades are missing or moved; choose faces by hand")
    numbers = [face.number for face in part.faces]
    turned = [n for n in numbers if _of_revolution(samples, n, point, axis)]
    rest = [n for n in numbers if n not in turned]
    groups = _groups(part, rest, samples)
    groups = [group for group in groups if _has_like(samples, group[0], sculptured)]
    if not groups:
        raise NoPattern(f"nothing but faces of revolution stands around an axis of {count} equal parts: no blades")
    if len(groups) != count:
        raise UnsupportedGeometry(f"{len(groups)} groups of faces stand around an axis of {count} equal parts: one "
                                  "blade each is needed; blades that touch each other cannot be told apart")
    ordered = _in_turn([(group, samples.centre[group[0]] - point) for group in groups], axis)
    own = {n for group in groups for n in group}
    disc = _disc(part, samples, own)
    floor = sorted(disc.intersection(turned)) or turned
    found = tuple(_blade(part, group, (turned, floor), samples, (point, axis)) for group in ordered)
    tips = {n for blade in found for n in blade.tip}
    beside = disc or {n for m in own for n in part.neighbours(m)}
    hub = tuple(n for n in floor if n in beside and n not in tips)
    return Bladed(point, axis, found, hub)


class _Pattern(NamedTuple):
    """An axis of so many equal parts: a point of it, its direction, and faces that have no like face in their place."""

    point: Array
    axis: Array
    parts: int
    strangers: list[int]


def _disc(part: Part, samples: _Samples, blades: set[int]) -> set[int]:
    """Faces of the bodies that have no blade, small ones left out."""
    bodies = [body.faces for body in part.bodies if body.closed and not blades.intersection(body.faces)]
    areas = [sum(samples.area[n] for n in faces) for faces in bodies]
    found: set[int] = set()
    for faces, area in zip(bodies, areas, strict=True):
        if area >= SMALL * max(areas):
            found.update(faces)
    return found


def _sample_faces(part: Part) -> _Samples:
    found = _Samples({}, {}, {}, {}, {})
    for face in part.faces:
        n = face.number
        uv = _inside(face)
        curvature = face.curvature(uv)
        found.points[n] = face.evaluate(uv).point
        found.normals[n] = face.normal(uv)
        found.bulge[n] = float(-np.median(curvature.k1 + curvature.k2))
        found.centre[n] = found.points[n].mean(axis=0)
        found.area[n] = face.area
    return found


def _inside(face: Face) -> Array:
    uv = face.grid(SAMPLES, SAMPLES)
    if len(uv) >= SAMPLES:
        return uv
    return np.concatenate([uv, *face.outline])


def _pattern(part: Part, samples: _Samples, sculptured: list[int]) -> _Pattern:
    """Axis and number of equal parts with the most faces in place, and the faces out of place."""
    best = PATTERN
    known = (False, 0)
    found: _Pattern | None = None
    for exact, point, axis in _axes(part, samples, sculptured):
        looked = [n for n in sculptured if not _of_revolution(samples, n, point, axis)]
        least = SMALL * max((samples.area[n] for n in looked), default=0.0)
        looked = [n for n in looked if samples.area[n] >= least]
        if not looked:
            continue
        whole = sum(samples.area[n] for n in looked)
        for number in range(2, MOST + 1):
            pairs, away = _counterparts(part, samples, looked, (point, axis), 2 * np.pi / number)
            in_place = sum(samples.area[n] * (1 - away[n] / 2) for n in pairs)
            fit = in_place / whole
            worse = (exact, number) < known
            clearly_better = fit > best + (_SLACK if worse else 1e-3)
            # As good with more parts: a pattern of twelve is one of six too.
            finer = found is not None and not worse and number > known[1] and fit > best - _SLACK
            if clearly_better or finer:
                best = fit
                known = (exact, number)
                line = (point, axis) if exact else _refine_axis(samples, pairs, point, axis)
                strangers = [n for n in looked if n not in pairs and _has_like(samples, n, looked)]
                found = _Pattern(*line, number, strangers)
    if found is None:
        raise NoPattern("no axis has a pattern of like faces around it: blades cannot be found on this part")
    was_exact, _ = known
    return found if was_exact else _refine_by_round_faces(part, samples, found)


def _refine_by_round_faces(part: Part, samples: _Samples, found: _Pattern) -> _Pattern:
    """The pattern with the axis of the faces that are nearly of revolution about an axis of inertia: they tell it
    exactly."""
    round_ = [face.number for face in part.faces if face.kind in _ROUND_KINDS]
    near = [n for n in round_ if _of_revolution(samples, n, found.point, found.axis, _ROUGHLY)]
    if not near:
        return found
    point, axis = _line_met_by_normals(samples, near)
    return found._replace(point=point, axis=axis)


def _has_like(samples: _Samples, number: int, numbers: list[int]) -> bool:
    """Whether another face has its area."""
    own = samples.area[number]
    return any(abs(samples.area[n] / own - 1) <= ALIKE for n in numbers if n != number)


def _axes(part: Part, samples: _Samples, sculptured: list[int]) -> list[tuple[bool, Array, Array]]:
    """Axes worth trying: the line that normals of surfaces of revolution meet, exact, and the axis of inertia."""
    result: list[tuple[bool, Array, Array]] = []
    round_ = [f.number for f in part.faces if f.kind in _ROUND_KINDS]
    if round_:
        point, axis = _line_met_by_normals(samples, round_)
        result.append((True, point, axis))
    points = np.concatenate([samples.points[n] for n in sculptured])
    weight = _area_of_each_point(samples, sculptured)
    values, vectors = np.linalg.eigh(np.cov(points.T, aweights=weight))
    # Of a body of revolution two moments are the same: the axis is the direction of the third.
    least, middle, greatest = values
    alone = 0 if middle - least > greatest - middle else 2
    centre = np.average(points, axis=0, weights=weight)
    return [*result, (False, centre, vectors[:, alone])]


def _area_of_each_point(samples: _Samples, numbers: list[int]) -> Array:
    """What each point of faces stands for, its face's area shared evenly."""
    shares = []
    for n in numbers:
        points = len(samples.points[n])
        shares.append(np.full(points, samples.area[n] / points))
    return np.concatenate(shares)


def _line_met_by_normals(samples: _Samples, numbers: list[int]) -> tuple[Array, Array]:
    """The line d, m = a x d that lines (p, n) meet: n . (d x p) + n . m = 0, by least squares, strangers left out."""
    point = np.zeros(3)
    d = np.array([0.0, 0.0, 1.0])
    for _ in range(4):
        p = np.concatenate([samples.points[k] for k in numbers])
        n = np.concatenate([samples.normals[k] for k in numbers])
        area = np.concatenate([np.full(len(samples.points[k]), samples.area[k]) for k in numbers])
        middle = p.mean(axis=0)
        size = float(np.ptp(p, axis=0).max())
        moments = np.cross((p - middle) / size, n)
        rows = np.concatenate([moments, n], axis=1) * np.sqrt(area)[:, None]
        _, values, lines = np.linalg.svd(rows, full_matrices=False)
        line = lines[-1]
        if values[-2] <= _ROUND * values[0]:  # cylinders alone: the line at infinity across them is met too
            both = lines[-2:]
            _, _, mixed = np.linalg.svd(both[:, :3].T)
            line = mixed[0] @ both
        way = line[:3]
        moment = line[3:]
        length = max(float(np.linalg.norm(way)), 1e-9)
        d = way / length
        point = middle + size * np.cross(way, moment) / length**2
        kept = [k for k in numbers if _of_revolution(samples, k, point, d)]
        if len(kept) in (0, len(numbers)):
            break
        numbers = kept
    return point, d


def _turn(axis: Array, angle: float) -> Array:
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return np.asarray(turn)


def _counterparts(part: Part, samples: _Samples, looked: list[int], line: tuple[Array, Array],
                  angle: float) -> tuple[dict[int, int], dict[int, float]]:
    """Faces that a turn brings onto a face like them, and how far from it as a share of what is allowed."""
    point, axis = line
    centres = np.array([samples.centre[n] for n in looked])
    areas = np.array([samples.area[n] for n in looked])
    moved = (centres - point) @ _turn(axis, angle).T + point
    away = lengths(moved[:, None] - centres)
    ratio = areas[:, None] / areas
    away[np.abs(ratio - 1) > ALIKE] = np.inf
    np.fill_diagonal(away, np.inf)
    best = away.argmin(axis=1)
    nearest = away[np.arange(len(looked)), best]
    share = nearest / (IN_PLACE * part.diagonal)
    near = np.flatnonzero(share < 1)
    pairs = {looked[i]: looked[int(best[i])] for i in near}
    return pairs, {looked[i]: float(share[i]) for i in near}


def _refine_axis(samples: _Samples, pairs: dict[int, int], point: Array, axis: Array) -> tuple[Array, Array]:
    """The axis of the turn that brings the centres of faces closest to their counterparts'."""
    a = np.array([samples.centre[n] for n in pairs])
    b = np.array([samples.centre[n] for n in pairs.values()])
    weight = np.array([samples.area[n] for n in pairs])
    ma = np.average(a, axis=0, weights=weight)
    mb = np.average(b, axis=0, weights=weight)
    # The rotation that fits best, by the singular values of the covariance; never a reflection.
    u, _, vt = np.linalg.svd((a - ma).T @ ((b - mb) * weight[:, None]))
    side = np.sign(np.linalg.det(vt.T @ u.T))
    turn = (vt.T * [1, 1, side]) @ u.T
    way = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    size = np.linalg.norm(way)
    if size < 1e-6:
        return point, axis
    d = way / size
    foot, *_ = np.linalg.lstsq(np.eye(3) - turn, mb - turn @ ma, rcond=1e-9)
    along = (ma - foot) @ d
    return foot + d * along, d


def _of_revolution(samples: _Samples, number: int, point: Array, axis: Array, within: float = MEETS) -> bool:
    """Whether no normal of a face has a part around the axis."""
    around = np.cross(axis, samples.points[number] - point)
    reach = np.maximum(np.linalg.norm(around, axis=1), 1e-9)
    part_around = (samples.normals[number] * around).sum(axis=1)
    return bool((np.abs(part_around) <= within * reach).all())


def _groups(part: Part, numbers: list[int], samples: _Samples) -> list[list[int]]:
    """Faces that hang together, each group with its largest first; small groups are left out."""
    left = set(numbers)
    groups = []
    while left:
        group = [min(left)]
        for n in group:
            group += [m for m in part.neighbours(n) if m in left and m not in group]
        left -= set(group)
        groups.append(sorted(group, key=lambda n: -samples.area[n]))
    sizes = [sum(samples.area[n] for n in group) for group in groups]
    return [group for group, size in zip(groups, sizes, strict=True) if size > 10 * SMALL * max(sizes)]


def _in_turn(groups: list[tuple[list[int], Array]], axis: Array) -> list[list[int]]:
    """Groups of faces, each with a point of it from the axis, in the order of a right-handed turn, the first first."""
    _, start = groups[0]
    angles = []
    for _, at in groups:
        across = axis @ np.cross(start, at)
        along = start @ at - (start @ axis) * (at @ axis)
        angles.append(float(np.arctan2(across, along)) % (2 * np.pi))
    angles[0] = 0.0
    return [groups[k][0] for k in np.argsort(angles)]


def _blade(part: Part, group: list[int], turned: tuple[list[int], list[int]], samples: _Samples,
           line: tuple[Array, Array]) -> Blade:
    """A blade from its faces; `turned` are all faces of revolution, and those that may be the hub's."""
    own = set(group)
    every, floor = turned
    fillets = [n for n in group if any(m in floor for m in part.neighbours(n, "tangent"))]
    tip = [n for n in every if part.neighbours(n) and own.issuperset(part.neighbours(n))]
    body = [n for n in group if n not in fillets]
    if len(body) < 2:
        raise NoPattern(f"face {group[0]} stands around the axis with its like, but has no second side: no blades")
    suction, pressure = sorted(body[:2], key=lambda n: -samples.bulge[n])
    leading, trailing = _edges(part, body[2:], (suction, pressure), samples, line)
    named = {suction, pressure, *leading, *trailing}
    others = tuple(n for n in sorted(body) if n not in named)
    return Blade((suction,), (pressure,), leading, trailing, tuple(sorted(fillets)), tuple(sorted(tip)), others)


def _edges(part: Part, rest: list[int], sides: tuple[int, int], samples: _Samples,
           line: tuple[Array, Array]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Leading and trailing edge: of the faces between both sides, those farthest from each other."""
    between = [n for n in rest if set(sides) <= set(part.neighbours(n))]
    if len(between) < 2:
        return (), ()
    centre = np.array([samples.centre[n] for n in between])
    away = np.linalg.norm(centre[:, None] - centre, axis=2)
    first, second = sorted(between[k] for k in np.unravel_index(int(away.argmax()), away.shape))
    first_reach, first_flat = _foremost(samples, sides, samples.centre[first], line)
    second_reach, second_flat = _foremost(samples, sides, samples.centre[second], line)
    if abs(first_reach - second_reach) > OUTWARDS * max(first_reach, second_reach):  # the flow turns outwards
        second_leads = first_reach > second_reach
    else:
        second_leads = first_flat < second_flat
    return ((second,), (first,)) if second_leads else ((first,), (second,))


def _foremost(samples: _Samples, sides: tuple[int, int], end: Array, line: tuple[Array, Array]) -> tuple[float, float]:
    """Distance of an edge from the axis, and how flat the sides stand to the axis there."""
    point, axis = line
    points = np.concatenate([samples.points[n] for n in sides])
    normals = np.concatenate([samples.normals[n] for n in sides])
    order = np.argsort(np.linalg.norm(points - end, axis=1))
    near = order[:max(len(points) // 8, 1)]
    reach = np.linalg.norm(np.cross(axis, end - point))
    flatness = np.abs(normals[near] @ axis).mean()
    return float(reach), float(flatness)
