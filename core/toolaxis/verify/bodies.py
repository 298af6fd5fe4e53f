"""A machine in motion: how near its table and its spindle come to each other, to the part and to the tool.

Points on the skin of each thing are carried along with the axes and held against the exact distance from the other.
No more is looked at than must be: from a place where two things are d apart nothing can happen for a motion of d.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from toolaxis.machine.axes import RotaryAxis
from toolaxis.machine.bodies import BED, Body
from toolaxis.machine.configurations import Machine
from toolaxis.machine.kinematics import inverse
from toolaxis.progress import NO_PROGRESS, Progress
from toolaxis.shape.face import Face
from toolaxis.tools.profile import Profile
from toolaxis.verify.axes import FAR, Clearance

Array = NDArray[np.float64]

#: Points on the skin of one thing, about, and their least distance, mm.
_POINTS, _APART = 12_000, 1.5
#: Parts of a turn around a turned body, and of the arc of a cutter.
_AROUND, _ARC = 72, 16
#: The least motion between two looks, mm.
_STEP = 1.0
#: Points that are made exact at a time.
_BATCH = 256
#: How far the linear axes may be from X, Y and Z.
_UPRIGHT = 1e-9
#: Lines of a grid on a face of the part.
_GRID = 60


@dataclass(frozen=True, eq=False)
class Thing:
    """Something rigid on a machine, with all axes at zero.

    Attributes
    ----------
    name : str
    carried : str
        Name of the axis that carries it, or "bed".
    points : (n, 3) array
        On its skin, machine coordinates, mm.
    spacing : float
        Greatest distance of a place on the skin from the next point, mm, about.
    inside : callable, optional
        Distance of (n, 3) points from it, negative inside, mm; None for faces, which enclose nothing by themselves.
    """

    name: str
    carried: str
    points: Array
    spacing: float
    inside: Callable[[Array], Array] | None


@dataclass(frozen=True, eq=False)
class Rig:
    """A machine with a part on its table and a tool in its spindle.

    Attributes
    ----------
    machine : Machine
    place : (4, 4) array
        Where the part stands on the table, all axes at zero.
    tool_length : float
        From the gauge point to the tip, mm.
    profile : Profile
        Generatrix of the cutter.
    outlines : dict of str to (k, 2) array
        Shank and holder as polylines (radius, z from the tip).
    faces : tuple of Face
        Of the part and of what stands beside it.
    """

    machine: Machine
    place: Array
    tool_length: float
    profile: Profile
    outlines: dict[str, Array]
    faces: tuple[Face, ...]

    @cached_property
    def bodies(self) -> tuple[Thing, ...]:
        """The machine's own bodies."""
        return tuple(body_thing(body) for body in self.machine.bodies)

    @cached_property
    def tool(self) -> tuple[Thing, ...]:
        """Cutter, shank and holder in the spindle."""
        spindle = np.asarray(self.machine.spindle)
        tip = np.asarray(self.machine.gauge) - self.tool_length * spindle
        last = self.machine.head[-1].name if self.machine.head else self.machine.linear[-1].name
        return tuple(turned_thing(name, last, line, tip, spindle)
                     for name, line in {"cutter": cutter_line(self.profile), **self.outlines}.items())

    @cached_property
    def part(self) -> tuple[Thing, ...]:
        """The faces of the part on the table."""
        carrier = self.machine.table[0].name if self.machine.table else BED
        found = []
        for face in self.faces:
            uv = face.grid(_GRID, _GRID)
            points = face.evaluate(uv).point @ self.place[:3, :3].T + self.place[:3, 3]
            found.append(Thing(f"face {face.label}", carrier, points, float(np.sqrt(face.area) / _GRID), None))
        return tuple(found)

    def beside_part(self, thing: Thing) -> bool:
        """Whether a thing stands on the table's side of the linear axes.

        Parameters
        ----------
        thing : Thing
        """
        return thing.carried in (BED, *(axis.name for axis in self.machine.table))

    @cached_property
    def reach(self) -> tuple[float, float]:
        """How far anything on the table's and on the spindle's side is from the axes that turn it, at most, mm."""
        found = []
        everything = (*self.bodies, *self.tool, *self.part)
        for axes, side in ((self.machine.table, True), (self.machine.head, False)):
            centres = [np.asarray(axis.point) for axis in axes]
            points = [thing.points for thing in everything if self.beside_part(thing) is side]
            if not centres or not points:
                found.append(0.0)
                continue
            between = sum(float(np.linalg.norm(b - a)) for a, b in pairwise(centres))
            far = max(float(np.linalg.norm(rows - centre, axis=1).max()) for rows in points for centre in centres)
            found.append(far + between)
        return found[0], found[1]

    def between(self, before: Array, after: Array) -> Array | None:
        """Joint coordinates of an index move: up, turn, over, down, (5, 3 + m); None where there is no top to go to.

        Parameters
        ----------
        before, after : (3 + m,) array
            Where the last operation ends and the next one begins.
        """
        machine = self.machine
        upright = np.abs(machine.directions - np.eye(3)).max() <= _UPRIGHT
        if not (upright and np.isfinite(machine.linear[2].high)):
            return None
        rows = np.array([before, before, before, after, after])
        rows[1:4, 2] = machine.linear[2].high
        rows[2, 3:] = after[3:]
        return rows

    def joints(self, tips: Array, axes: Array, rotary: Sequence[float]) -> Array:
        """Joint coordinates along cutter locations, from the solution that is nearest to rotary angles, (n, 3 + m).

        Parameters
        ----------
        tips, axes : (n, 3) array
        rotary : sequence of float
            Where the rotary axes stand at the first location, rad.
        """
        found = inverse(self.machine, tips, axes, self.tool_length, self.place, near=np.asarray(rotary, dtype=float))
        rows = np.empty((len(tips), found.joints.shape[2]))
        stand = np.asarray(rotary, dtype=float)
        for k, branches in enumerate(found.joints):
            turn = np.mod(branches[:, 3:] - stand + np.pi, 2 * np.pi) - np.pi
            best = int(np.argmin(np.abs(turn).sum(axis=1)))
            stand = stand + turn[best]
            rows[k, :3], rows[k, 3:] = branches[best, :3], stand
        return rows

    def placed(self, thing: Thing, joints: Array) -> tuple[Array, Array]:
        """The rotation (3, 3) and the shift (3,) that bring a thing to where it is at joint coordinates.

        Parameters
        ----------
        thing : Thing
        joints : (3 + m,) array
        """
        table, head = list(self.machine.table), list(self.machine.head)
        names = [axis.name for axis in table], [axis.name for axis in head]
        turn, shift = np.eye(3), np.zeros(3)
        if thing.carried in names[0]:
            for k in range(names[0].index(thing.carried), len(table)):  # from the part to the bed
                turn, shift = _then(turn, shift, table[k], -joints[3 + k])
            return turn, shift
        if thing.carried == BED:
            return turn, shift
        moved = len(self.machine.linear)
        if thing.carried in names[1]:
            for k in reversed(range(names[1].index(thing.carried) + 1)):  # from the tool to the linear axes
                turn, shift = _then(turn, shift, head[k], joints[3 + len(table) + k])
        else:
            moved = [axis.name for axis in self.machine.linear].index(thing.carried) + 1
        return turn, shift + self.machine.directions[:, :moved] @ joints[:moved]

    @cached_property
    def judged(self) -> bool:
        """Whether there are bodies on both sides, the table's and the spindle's."""
        return len({self.beside_part(one) for one in self.bodies}) == 2

    @cached_property
    def tool_and_part(self) -> list[tuple[Thing, Thing]]:
        """Points of the part against the tool: along passes material removal judges that."""
        return [(face, one) for face in self.part for one in self.tool]

    @cached_property
    def pairs(self) -> list[tuple[Thing, Thing]]:
        """What else is held apart: points of the first against the second."""
        head = [one for one in self.bodies if not self.beside_part(one)]
        table = [one for one in self.bodies if self.beside_part(one)]
        first = self.machine.linear[0].name
        found = []
        for one in head:
            against = [other for other in table if not (other.carried == BED and one.carried == first)]
            found += [(one, other) for other in against] + [(other, one) for other in (*against, *self.part)]
        for one in self.tool:
            found += [(one, other) for other in table] + [(other, one) for other in table]
        carrier = self.machine.table[0].name if self.machine.table else BED
        return found + [(face, one) for one in table if one.carried != carrier for face in self.part]


def least_room(rig: Rig, joints: Array, needed: float, pairs: Sequence[tuple[Thing, Thing]],
               progress: Progress = NO_PROGRESS) -> Clearance:
    """Where anything comes nearest to anything else along straight motions of the joints.

    Parameters
    ----------
    rig : Rig
    joints : (n, 3 + m) array
        mm and rad.
    needed : float
        Distances above this are not told exactly: motions on which nothing comes as near are passed over, mm.
    pairs : sequence of (Thing, Thing)
        Of the rig.
    progress : Progress

    Returns
    -------
    Clearance
        The least distance that was seen, with the names of the two, the place in the part's frame and the row of joints
        at which the motion arrives.  Of flat skins it is exact where a corner comes near; elsewhere it may be up to its
        `uncertainty` too great.
    """
    steps = np.abs(np.diff(joints, axis=0))
    table, _ = len(rig.machine.table), len(rig.machine.head)
    turns = steps[:, 3:3 + table].sum(axis=1) * rig.reach[0] + steps[:, 3 + table:].sum(axis=1) * rig.reach[1]
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(joints[:, :3], axis=0), axis=1) + turns)])
    worst = Clearance("", FAR, "", (0.0, 0.0, 0.0), -1, 0.0)
    for k, (cloud, body) in enumerate(pairs):
        progress.report("bodies of the machine", k, len(pairs))
        at = 0.0
        while at <= way[-1]:
            row = int(np.clip(np.searchsorted(way, at), 1, max(len(joints) - 1, 1)))
            here = np.array([np.interp(at, way, column) for column in joints.T])
            distance, place = _apart(rig, cloud, body, here)
            if distance < worst.distance:
                names = (cloud.name, body.name) if rig.beside_part(body) and not rig.beside_part(cloud) \
                    else (body.name, cloud.name)
                point = (float(place[0]), float(place[1]), float(place[2]))
                worst = Clearance(names[0], distance, names[1], point, min(row, len(joints) - 1), cloud.spacing)
            if at == way[-1]:
                break
            at = min(at + max(distance - needed, _STEP), way[-1])
    return worst


def _apart(rig: Rig, cloud: Thing, body: Thing, joints: Array) -> tuple[float, Array]:
    """The least distance of points from a body, mm, and where that is in the part's frame."""
    assert body.inside is not None
    (turn, shift), (other, aside) = rig.placed(cloud, joints), rig.placed(body, joints)
    there = cloud.points @ turn.T + shift
    found = body.inside((there - aside) @ other)
    k = int(np.argmin(found))
    carrier = rig.machine.table[0].name if rig.machine.table else BED
    turned, moved = rig.placed(Thing("part", carrier, there[:0], 0.0, None), joints)
    on_table = (there[k] - moved) @ turned
    return float(found[k]), np.asarray((on_table - rig.place[:3, 3]) @ rig.place[:3, :3])


def _then(turn: Array, shift: Array, axis: RotaryAxis, angle: float) -> tuple[Array, Array]:
    """A rigid motion followed by a turn about an axis."""
    more = Rotation.from_rotvec(angle * np.asarray(axis.direction)).as_matrix()
    centre = np.asarray(axis.point)
    return more @ turn, more @ (shift - centre) + centre


def body_thing(body: Body) -> Thing:
    """A body of a machine with points on its skin.

    Parameters
    ----------
    body : Body
        A box, a cylinder, or the rounded hull of points.
    """
    if body.kind == "cylinder":
        low, high = body.points
        height = float(np.linalg.norm(high - low))
        line = np.array([[body.radius, 0.0], [body.radius, height]])
        return turned_thing(body.name, body.carried, line, low, (high - low) / height)
    corners = body.points
    if body.kind == "box":
        corners = np.array(np.meshgrid(*np.sort(body.points, axis=0).T)).reshape(3, -1).T
    hull = ConvexHull(corners)
    triangles = corners[hull.simplices]
    points, spacing = _on_triangles(triangles)
    normals = np.repeat(hull.equations[:, :3], len(points) // len(triangles), axis=0)
    points = points + body.radius * normals  # round edges are met by the distance from the others' points

    def _inside(rows: Array) -> Array:
        found = (rows @ hull.equations[:, :3].T + hull.equations[:, 3]).max(axis=1)
        order = np.argsort(found, kind="stable")
        for first in range(0, len(rows), _BATCH):  # outside that is too little: made exact, the nearest first
            some = order[first:first + _BATCH]
            some = some[found[some] > 0]
            found[some] = _from_triangles(rows[some], triangles)
            if first + _BATCH >= len(rows) or found[order[:first + _BATCH]].min() <= found[order[first + _BATCH]]:
                break
        return np.asarray(found - body.radius)

    return Thing(body.name, body.carried, points, spacing, _inside)


def _from_triangles(points: Array, triangles: Array) -> Array:
    """Distance of points (m, 3) from the nearest of triangles (k, 3, 3)."""
    a = triangles[:, 0]
    edges = np.roll(triangles, -1, axis=1) - triangles
    normal = np.cross(edges[:, 0], edges[:, 1])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    above = np.einsum("mkc,kc->mk", points[:, None] - a, normal)
    over = np.ones(above.shape, dtype=bool)
    aside = np.full(above.shape, np.inf)
    for i in range(3):
        away = points[:, None] - triangles[:, i]
        over &= np.einsum("mkc,kc->mk", away, np.cross(normal, edges[:, i])) >= 0
        size = np.maximum((edges[:, i] ** 2).sum(axis=1), 1e-30)
        along = np.clip(np.einsum("mkc,kc->mk", away, edges[:, i]) / size, 0.0, 1.0)
        aside = np.minimum(aside, np.linalg.norm(away - along[..., None] * edges[:, i], axis=2))
    return np.asarray(np.where(over, np.abs(above), aside).min(axis=1, initial=np.inf))


def _on_triangles(triangles: Array) -> tuple[Array, float]:
    """Points on triangles (k, 3, 3), as many on each, corners and edges among them, and their distance."""
    sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2)
    longest = float(sides.max())
    most = int(np.sqrt(2 * _POINTS / len(triangles)))
    count = int(np.clip(np.ceil(longest / _APART), 1, max(most, 1)))
    i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    keep = i + j <= count
    a, b = i[keep] / count, j[keep] / count
    weights = np.stack([1 - a - b, a, b], axis=1)
    return np.einsum("nw,kwc->knc", weights, triangles).reshape(-1, 3), longest / count


def turned_thing(name: str, carried: str, line: Array, foot: Array, axis: Array) -> Thing:
    """A solid of revolution with points on its skin.

    Parameters
    ----------
    name, carried : str
    line : (k, 2) array
        Radius and height above the foot, mm, heights not decreasing.
    foot, axis : (3,) array
        A point and the direction of its axis, machine coordinates.
    """
    corners = np.concatenate([[[0.0, line[0, 1]]], line, [[0.0, line[-1, 1]]]])
    lengths = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    apart = max(_APART, float(lengths.sum()) * _AROUND / _POINTS)
    rows = np.concatenate([a + np.linspace(0, 1, max(2, int(np.ceil(size / apart)) + 1))[:, None] * (b - a)
                           for (a, b), size in zip(pairwise(corners), lengths, strict=True)])
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    x = np.cross(helper, axis)
    x /= np.linalg.norm(x)
    y = np.cross(axis, x)
    angle = 2 * np.pi * np.arange(_AROUND) / _AROUND
    ring = np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * y
    points = foot + (rows[:, :1, None] * ring[None] + rows[:, 1:, None] * axis).reshape(-1, 3)

    def _inside(found: Array) -> Array:
        away = found - foot
        height = away @ axis
        radius = np.linalg.norm(away - height[:, None] * axis, axis=1)
        return _from_line(corners, np.stack([radius, height], axis=1))

    return Thing(name, carried, points, max(apart, 2 * np.pi * float(line[:, 0].max()) / _AROUND), _inside)


def _from_line(corners: Array, places: Array) -> Array:
    """Distance of places (radius, height) from the area between a polyline and the axis, negative inside."""
    least = np.full(len(places), np.inf)
    crossings = np.zeros(len(places), dtype=int)
    for (r0, z0), (r1, z1) in pairwise(corners):
        way, size = np.array([r1 - r0, z1 - z0]), (r1 - r0) ** 2 + (z1 - z0) ** 2
        along = np.clip(((places - [r0, z0]) @ way) / max(size, 1e-30), 0.0, 1.0)
        least = np.minimum(least, np.linalg.norm(places - [r0, z0] - along[:, None] * way, axis=1))
        between = (np.minimum(z0, z1) <= places[:, 1]) & (places[:, 1] < np.maximum(z0, z1))
        at = r0 + (places[:, 1] - z0) * (r1 - r0) / (z1 - z0 if z1 != z0 else 1.0)
        crossings += between & (at > places[:, 0])
    return np.where(crossings % 2 == 1, -least, least)


def cutter_line(profile: Profile) -> Array:
    """The generatrix of a cutter as a polyline (radius, height above the tip), (k, 2) mm.

    Parameters
    ----------
    profile : Profile
    """
    a, r, beta = profile.flat_radius, profile.corner_radius, profile.half_angle
    angle = np.linspace(0.0, np.pi / 2 - beta, _ARC + 1)
    arc = np.stack([a + r * np.sin(angle), r * (1 - np.cos(angle))], axis=1)
    rise = profile.top - arc[-1, 1]
    return np.concatenate([arc, [[arc[-1, 0] + rise * np.tan(beta), profile.top]]])
