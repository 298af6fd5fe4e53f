"""Brute force on postures: a tool touches a place with thousands of axes, and is held against points of the part.

Nothing here is taken from what searches or proves: the tool's outline is measured by its lines and its arc, the tip
follows from the place and its normal, and every point is looked at until one is too near.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toolaxis.numeric.jit import jit
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

OWN, TOUCHING, OTHER = range(3)
#: Points that refused the last postures and are asked first.
_REMEMBERED = 12
#: Points of a block.
_BLOCK = 32
#: First and last step of the search around the best axis, rad.
_FIRST, _LAST = np.radians(1.5), np.radians(0.02)


class Outline(NamedTuple):
    """A turned tool in its meridian plane, mm.

    cutter : (6,) array, radius of the flat bottom, corner radius, cosine and sine of the side's angle, height and
    radius of its upper end;
    line : (k, 4) array, straight lines r, z, r, z of the other components;
    begin : (4,) array of int, first line of shank, holder and what holds it, and the number of all;
    low, high, wide : (4,) arrays, range of heights and greatest radius of cutter, shank, holder and what holds it.
    """

    cutter: Array
    line: Array
    begin: Indices
    low: Array
    high: Array
    wide: Array


class Rule(NamedTuple):
    """What has to be kept.

    least : (4, 4) array, mm, least signed distance from own, touching and other faces of cutter, shank, holder and
    what holds it, and in the last row the greatest of each column;
    lead : float, rad, least angle of axis and normal for a flat bottom.
    """

    least: Array
    lead: float


class Points(NamedTuple):
    """Points of the part in blocks, those nearest to the contact first.

    point : (n, 3) array, mm;  role : (n,) array of int;  step : (n,) array, mm, what the cutter may be deeper there;
    begin : (k + 1,) array of int, first point of each block;  centre, radius : (k, 3) and (k,) arrays, mm, balls around
    the blocks.
    """

    point: Array
    role: Indices
    step: Array
    begin: Indices
    centre: Array
    radius: Array

    @staticmethod
    def of(point: Array, role: Indices, step: Array, place: Array) -> "Points":
        """Put points that lie together into blocks, in the order of their distance from a place."""
        order = np.asarray(cKDTree(point, leafsize=_BLOCK).indices)
        begin = np.arange(0, len(order), _BLOCK)
        distance = np.linalg.norm(point[order] - place, axis=1)
        near = np.argsort(np.minimum.reduceat(distance, begin), kind="stable")
        size = np.diff(np.append(begin, len(order)))[near]
        end = np.cumsum(size)
        order = order[np.repeat(begin[near] - end + size, size) + np.arange(len(order))]
        begin = np.append(0, end)
        centre = np.add.reduceat(point[order], begin[:-1]) / size[:, None]
        radius = np.maximum.reduceat(np.linalg.norm(point[order] - np.repeat(centre, size, axis=0), axis=1), begin[:-1])
        return Points(np.ascontiguousarray(point[order]), role[order], step[order], begin, centre, radius)


def outline_of(tool: Tool, extent: float) -> Outline:
    """The outline of a tool, and of what holds it as wide as its upper end.

    Parameters
    ----------
    tool : Tool
    extent : float
        How far up what holds it goes on, mm.
    """
    a, r, beta, top = tool.radius - tool.corner_radius, tool.corner_radius, tool.half_angle, tool.flute_length
    rim = a + r * np.cos(beta) + (top - r * (1 - np.sin(beta))) * np.tan(beta)
    bodies = [tool.outlines.get(name, np.empty((0, 2))) for name in ("shank", "holder")]
    last = next((body[-1, 0] for body in bodies[::-1] if len(body)), rim)
    bodies.append(np.array([[last, tool.height], [last, tool.height + extent]]))
    lines, begin, low, high, wide = [], [0], [0.0], [top], [max(rim, a + r)]
    for body in bodies:
        if len(body):
            closed = np.vstack([[0.0, body[0, 1]], body, [0.0, body[-1, 1]]])
            lines.append(np.hstack([closed[:-1], closed[1:]]))
        begin.append(begin[-1] + (len(body) + 1 if len(body) else 0))
        low.append(body[0, 1] if len(body) else np.inf)
        high.append(body[-1, 1] if len(body) else -np.inf)
        wide.append(body[:, 0].max() if len(body) else 0.0)
    cutter = np.array([a, r, np.cos(beta), np.sin(beta), top, rim])
    return Outline(cutter, np.vstack(lines), np.array(begin), *(np.array(column) for column in (low, high, wide)))


def hemisphere(normal: Array, count: int) -> Array:
    """Axes spread evenly over the hemisphere around a normal, neighbours after each other, (count, 3)."""
    k = np.arange(count)
    height = 1 - (k + 0.5) / count
    turn = k * np.pi * (3 - np.sqrt(5))
    flat = np.sqrt(1 - height**2)
    local = np.column_stack([flat * np.cos(turn), flat * np.sin(turn), height])
    ring = np.floor(np.arccos(height) / np.radians(6)).astype(int)
    order = np.lexsort(((turn % (2 * np.pi)) * np.where(ring % 2, 1, -1), ring))
    first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    first /= np.linalg.norm(first)
    return np.ascontiguousarray(local[order] @ np.stack([first, np.cross(normal, first), normal]))


@jit
def _line_distance(r0: float, z0: float, r1: float, z1: float, rho: float, z: float) -> float:
    """Distance of a place from a straight line's nearest point."""
    along_r, along_z = r1 - r0, z1 - z0
    square = along_r * along_r + along_z * along_z
    share = 0.0
    if square > 0.0:
        share = min(max(((rho - r0) * along_r + (z - z0) * along_z) / square, 0.0), 1.0)
    return float(np.hypot(rho - r0 - share * along_r, z - z0 - share * along_z))


@jit
def _cutter_distance(cutter: Array, rho: float, z: float) -> float:
    """Signed distance of a place from the cutter."""
    a, r, cosine, sine, top, rim = cutter[0], cutter[1], cutter[2], cutter[3], cutter[4], cutter[5]
    end_r, end_z = a + r * cosine, r * (1.0 - sine)
    found = min(_line_distance(end_r, end_z, rim, top, rho, z), _line_distance(0.0, top, rim, top, rho, z))
    found = min(found, _line_distance(0.0, 0.0, a, 0.0, rho, z))
    x, y = rho - a, z - r
    if x >= 0.0 and cosine * y + sine * x <= 0.0:
        found = min(found, abs(np.hypot(x, y) - r))
    if z <= 0.0 or z >= top:
        return found
    if z < end_z:
        wide = a + np.sqrt(max(r * r - y * y, 0.0))
    else:
        wide = end_r + (z - end_z) * (rim - end_r) / (top - end_z)
    return -found if rho < wide else found


@jit
def _body_distance(line: Array, first: int, end: int, rho: float, z: float) -> float:
    """Signed distance of a place from a turned body with its lids."""
    found, wide = np.inf, -1.0
    for k in range(first, end):
        r0, z0, r1, z1 = line[k, 0], line[k, 1], line[k, 2], line[k, 3]
        found = min(found, _line_distance(r0, z0, r1, z1, rho, z))
        if z0 < z <= z1:
            wide = r0 + (r1 - r0) * (z - z0) / (z1 - z0)
    return -found if rho < wide else found


@jit
def _lacking(tool: Outline, least: Array, step: float, rho: float, z: float) -> float:
    """By how much a place of the part is nearer to the tool than it may be; less than 0 where it is not.

    least : (4,) array, of the components;  step : what the cutter may be deeper there
    """
    found = -1.0
    for part in range(4):
        keep = least[part] - (step if part == 0 and least[0] <= 0.0 else 0.0)
        room = max(keep, 0.0)
        if keep == -np.inf or z < tool.low[part] - room or z > tool.high[part] + room or rho > tool.wide[part] + room:
            continue
        if part == 0:
            distance = _cutter_distance(tool.cutter, rho, z)
        else:
            distance = _body_distance(tool.line, tool.begin[part - 1], tool.begin[part], rho, z)
        found = max(found, keep - distance)
    return found


@jit
def _may_lack(tool: Outline, least: Array, radius: float, rho: float, z: float) -> float:
    """The most that can be lacking anywhere in a ball around a place."""
    found = 0.0
    for part in range(4):
        room = max(least[part], 0.0) + radius
        if (least[part] == -np.inf or z < tool.low[part] - room or z > tool.high[part] + room
                or rho > tool.wide[part] + room):
            continue
        if part == 0:
            distance = _cutter_distance(tool.cutter, rho, z)
        else:
            distance = _body_distance(tool.line, tool.begin[part - 1], tool.begin[part], rho, z)
        found = max(found, least[part] - distance + radius)
    return found


@jit
def _meridian(point: Array, tip: Array, axis: Array) -> tuple[float, float]:
    """Distance of a point from the tool's axis, and its height."""
    x, y, t = point[0] - tip[0], point[1] - tip[1], point[2] - tip[2]
    z = x * axis[0] + y * axis[1] + t * axis[2]
    return np.sqrt(max(x * x + y * y + t * t - z * z, 0.0)), z


@jit
def _worst(tool: Outline, least: Array, some: Points, tip: Array, axis: Array, enough: float, memory: Indices) -> float:
    """What is lacking most over all points, 0 where nothing is; some value above enough as soon as there is one."""
    worst = 0.0
    for k in range(_REMEMBERED):
        i = memory[k]
        rho, z = _meridian(some.point[i], tip, axis)
        worst = max(worst, _lacking(tool, least[some.role[i]], some.step[i], rho, z))
    if worst > enough:
        return worst
    for block in range(some.radius.shape[0]):
        rho, z = _meridian(some.centre[block], tip, axis)
        if _may_lack(tool, least[3], some.radius[block], rho, z) <= worst:
            continue
        for i in range(some.begin[block], some.begin[block + 1]):
            rho, z = _meridian(some.point[i], tip, axis)
            found = _lacking(tool, least[some.role[i]], some.step[i], rho, z)
            if found > worst:
                worst = found
                if worst > enough:
                    for j in range(_REMEMBERED - 1):
                        memory[j] = memory[j + 1]
                    memory[_REMEMBERED - 1] = i
                    return worst
    return worst


@jit
def _set_tip(tool: Outline, contact: tuple[Array, Array], axis: Array, tip: Array) -> None:
    """The tip of a tool that touches a place: its arc's circle stands off along the normal and towards the axis."""
    place, normal = contact
    a, r = tool.cutter[0], tool.cutter[1]
    up = normal[0] * axis[0] + normal[1] * axis[1] + normal[2] * axis[2]
    side = np.sqrt(max(1.0 - up * up, 1e-30))
    for k in range(3):
        tip[k] = place[k] + r * normal[k] - r * axis[k] + a * (normal[k] - up * axis[k]) / side


@jit
def _is_allowed(tool: Outline, normal: Array, axis: Array, lead: float) -> bool:
    """Whether the place lies on the cutter's bottom or arc."""
    up = normal[0] * axis[0] + normal[1] * axis[1] + normal[2] * axis[2]
    return bool(up >= tool.cutter[3] - 1e-12 and (tool.cutter[0] <= 0.0 or up <= np.cos(lead)))


@jit
def try_axes(tool: Outline, rule: Rule, some: Points, contact: tuple[Array, Array], axes: Array, best: Array) -> int:
    """Touch a place with each axis, and search on around the best one.

    Parameters
    ----------
    tool : Outline
    rule : Rule
    some : Points
    contact : two (3,) arrays
        The place, mm, and its normal.
    axes : (m, 3) array
    best : (4,) array
        In and out: what the best posture lacks, mm, at first what it has to be better than, and its axis.

    Returns
    -------
    int
        How many postures were tried.
    """
    memory, tip, axis, around = np.zeros(_REMEMBERED, np.int64), np.zeros(3), np.zeros(3), np.zeros((2, 3))
    tried, improved = 0, False
    for k in range(axes.shape[0]):
        if best[0] <= 0.0:
            return tried
        if not _is_allowed(tool, contact[1], axes[k], rule.lead):
            continue
        _set_tip(tool, contact, axes[k], tip)
        found = _worst(tool, rule.least, some, tip, axes[k], best[0], memory)
        tried += 1
        if found < best[0]:
            best[0], best[1:], improved = found, axes[k], True
    step = _FIRST if improved else 0.0
    while step > _LAST and best[0] > 0.0:
        main = np.argmin(np.abs(best[1:]))
        axis[:] = 0.0
        axis[main] = 1.0
        around[0] = np.cross(best[1:], axis)
        around[0] /= np.sqrt((around[0] ** 2).sum())
        around[1] = np.cross(best[1:], around[0])
        better = False
        middle = best[1:].copy()
        for k in range(8):
            way = k * np.pi / 4
            axis[:] = middle + np.tan(step) * (np.cos(way) * around[0] + np.sin(way) * around[1])
            axis /= np.sqrt((axis**2).sum())
            if not _is_allowed(tool, contact[1], axis, rule.lead):
                continue
            _set_tip(tool, contact, axis, tip)
            found = _worst(tool, rule.least, some, tip, axis, best[0], memory)
            tried += 1
            if found < best[0]:
                best[0], best[1:], better = found, axis, True
        if not better:
            step /= 2
    return tried
