"""A third judge: solids with exact distances, and how deep a swept cutter enters them by sampling alone.

It shares nothing with the planner nor with the judge: a solid is a profile in the x-z plane (straight pieces and arcs)
drawn out along y, or an octant; a place is inside the cutter where the least of its signed distances along the straight
motions is not above zero; and the depth is the greatest distance from the solid's surface of places inside both.
"""

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from toolaxis.shape.face import Face

LENGTH = 8.0


def plane(corner, one, two, number):
    s, t = np.meshgrid(np.linspace(0, 1, 4), np.linspace(0, 1, 4), indexing="ij")
    points = np.asarray(corner, dtype=float) + s[..., None] * np.asarray(one) + t[..., None] * np.asarray(two)
    return Face.from_bspline(points).trimmed((), str(number))


def strip(number, start, end, wide=LENGTH):
    """A plane over a straight piece of a profile, its normal left of the way from start to end."""
    (x0, z0), (x1, z1) = start, end
    return plane([x0, -wide, z0], [x1 - x0, 0, z1 - z0], [0, 2 * wide, 0], number)


def arc_strip(number, centre, radius, angles, wide=LENGTH):
    """A cylinder over an arc of a profile; angles from +z towards +x, the normal away from the centre, or towards it
    where the radius is negative."""
    a, b = angles
    half, size = (b - a) / 2, abs(radius)
    at = [(size, a), (size / np.cos(half), a + half), (size, b)]
    rows = np.array([[centre[0] + r * np.sin(t), 0.0, centre[1] + r * np.cos(t)] for r, t in at])
    side = np.array([0.0, wide, 0.0])
    net = np.stack([rows - side, rows + side], axis=1)
    weights = np.array([[1.0, 1.0], [np.cos(half)] * 2, [1.0, 1.0]])
    face = Face.from_bspline(net, (2, 1), weights=weights)
    up = face.normal(np.array([[0.5, 0.5]]))[0]
    out = np.array([np.sin(a + half), 0.0, np.cos(a + half)]) * np.sign(radius)
    return Face.from_bspline(net, (2, 1), weights=weights, flip=bool(up @ out < 0)).trimmed((), str(number))


@dataclass(frozen=True)
class Solid:
    """What lies below a profile from left to right, pieces of which are faces.

    lines : pairs of (x, z); arcs : (centre, radius, angles); inside : whether rows of (x, z) are in the solid.
    """

    faces: tuple
    lines: tuple
    inside: object
    arcs: tuple = ()
    middle: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))

    def depth(self, places):
        """Distance from the surface inside, below zero outside."""
        xz = places[:, [0, 2]]
        far = [_from_line(xz, *map(np.asarray, line)) for line in self.lines]
        far += [_from_arc(xz, *arc) for arc in self.arcs]
        return np.where(self.inside(xz), 1.0, -1.0) * np.min(far, axis=0)


def _from_line(xz, start, end):
    way = end - start
    t = np.clip((xz - start) @ way / (way @ way), 0.0, 1.0)
    return np.linalg.norm(xz - start - t[:, None] * way, axis=1)


def _from_arc(xz, centre, radius, angles):
    rel = xz - centre
    at = np.clip(np.arctan2(rel[:, 0], rel[:, 1]), *angles)
    return np.linalg.norm(rel - abs(radius) * np.stack([np.sin(at), np.cos(at)], axis=1), axis=1)


def edge(turn, fillet=0.0, reach=LENGTH):
    """Two planes whose normals turn by an angle: convex above zero, concave below; rounded by a fillet."""
    back = abs(fillet) * np.tan(abs(turn) / 2)
    way = np.array([np.cos(turn), -np.sin(turn)])
    start, end = np.array([-back, 0.0]), back * way
    lines = [((-reach, 0.0), start), (end, reach * way)]
    faces = [strip(1, *lines[0]), strip(2, *lines[1])]
    arcs = ()
    up = np.array([[0.0, 1.0], [np.sin(turn), np.cos(turn)]])
    if fillet:
        sign = 1.0 if turn > 0 else -1.0
        centre = np.array([-back, -sign * fillet])
        first = 0.0 if turn > 0 else np.pi + turn
        arcs = ((centre, sign * fillet, (first, first + abs(turn))),)
        faces.append(arc_strip(3, centre, sign * fillet, arcs[0][2]))

    def inside(xz):
        below = xz @ up.T < 0.0
        if turn < 0:
            # In the corner of a hollow fillet there is material above both planes' wedge.
            held = below.any(axis=1)
            if fillet:
                held |= _between(xz, centre, first, turn) & (np.linalg.norm(xz - centre, axis=1) > fillet)
            return held
        held = below.all(axis=1)
        if fillet:
            held &= ~(_between(xz, centre, first, turn) & (np.linalg.norm(xz - centre, axis=1) > fillet))
        return held

    middle = up.sum(axis=0)
    middle = np.array([middle[0], 0.0, middle[1]]) / np.linalg.norm(middle)
    return Solid(tuple(faces), tuple(lines), inside, arcs, middle)


def _between(xz, centre, first, turn):
    """Whether places lie in the sector of a fillet, seen from its centre."""
    rel = xz - centre
    at = np.arctan2(rel[:, 0], rel[:, 1])
    if first > np.pi / 2:
        at = np.where(at < 0, at + 2 * np.pi, at)
    return (at >= first) & (at <= first + abs(turn))


def stair(height, riser=True, reach=LENGTH):
    """Two planes at different heights, the higher one at x > 0; the riser between them is a face, or is missing."""
    lines = [((-reach, 0.0), (0.0, 0.0)), ((0.0, height), (reach, height))]
    faces = [strip(1, *lines[0]), strip(2, *lines[1])]
    if riser:
        lines.append(((0.0, 0.0), (0.0, height)))
        faces.append(strip(3, (0.0, 0.0), (0.0, height)))

    def inside(xz):
        return xz[:, 1] < np.where(xz[:, 0] > 0.0, height, 0.0)

    return Solid(tuple(faces), tuple(lines), inside)


class Corner:
    """The octant below three planes."""

    def __init__(self, reach=LENGTH):
        self.faces = (plane([-reach, -reach, 0], [reach, 0, 0], [0, reach, 0], 1),
                      plane([0, -reach, -reach], [0, reach, 0], [0, 0, reach], 2),
                      plane([-reach, 0, -reach], [0, 0, reach], [reach, 0, 0], 3))
        self.middle = np.ones(3) / np.sqrt(3.0)

    def depth(self, places):
        return -places.max(axis=1)


# ---- the swept cutter ----------------------------------------------------------------------------------------------

def standing(profile, apart, axis):
    """Signed distance of places relative to the tip from the cutter; inside, from its nearest side."""
    a, r, beta, top = profile.flat_radius, profile.corner_radius, profile.half_angle, profile.top
    z = apart @ axis
    square = apart[..., 0] ** 2 + apart[..., 1] ** 2 + apart[..., 2] ** 2
    rho = np.sqrt(np.maximum(square - z * z, 0.0))
    x, y = rho - a, z - r
    planes = np.maximum(np.maximum(-z, x * np.cos(beta) - y * np.sin(beta) - r), z - top)
    return np.where((x >= 0) & (y * np.cos(beta) + x * np.sin(beta) <= 0), np.hypot(x, y) - r, planes)


def swept(profile, places, tips, axis):
    """Least signed distance of places from the cutter along straight motions from tip to tip: it is convex on each."""
    best = np.full(len(places), np.inf)
    for start, end in pairwise(tips):
        low, high = np.zeros(len(places)), np.ones(len(places))
        for _ in range(28):
            third = (high - low) / 3
            one, two = (standing(profile, places - start - t[:, None] * (end - start), axis)
                        for t in (low + third, high - third))
            low, high = np.where(one < two, low, low + third), np.where(one < two, high - third, high)
        middle = (low + high)[:, None] / 2
        best = np.minimum(best, standing(profile, places - start - middle * (end - start), axis))
    return best


def depth_of_cut(solid, profile, tips, axis, box, rounds=18, count=3000, seed=0):
    """The greatest depth of places inside solid and swept cutter, by sampling closer and closer to the best ones; and
    where that is."""
    rng = np.random.default_rng(seed)
    low, high = np.asarray(box, dtype=float)
    centres, half, best, where = [(low + high) / 2], (high - low) / 2, 0.0, None
    for _ in range(rounds):
        places = np.concatenate([c + half * rng.uniform(-1, 1, (count // len(centres), 3)) for c in centres])
        deep, off = solid.depth(places), swept(profile, places, tips, axis)
        both = (off <= 0.0) & (deep > 0.0)
        score = np.where(both, deep, np.minimum(deep, -off) - 10.0)
        order = np.argsort(-score)
        if both[order[0]] and deep[order[0]] > best:
            best, where = float(deep[order[0]]), places[order[0]]
        centres = [places[k] for k in order[:4]]
        half = half * 0.62
    return best, where
