"""The machine at each orientation of a plan: its bodies with part, tool and holder, seen from the front."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import degrees

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from toolaxis.cldata.toolpath import Motion
from toolaxis.machine.bodies import MachineBody
from toolaxis.machine.body_poses import axes_carrying, bed_from_body, beside_part, part_from_bed
from toolaxis.machine.kinematics import linear_coordinates
from toolaxis.machine.setup import Mounting
from toolaxis.numeric.vectors import unit
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.report.figures.plots import bare, figure, scale_bar
from toolaxis.report.figures.splat_renderer import (
    Camera,
    Canvas,
    camera,
    face_splats,
    splats_of_revolution,
    tool_outlines,
)

Array = NDArray[np.float64]

#: Panels in a picture and in a row of it.
_MOST, _ROW = 9, 3
_BACK = (0.55, -1.0, 0.55)
_PART, _MACHINED, _OBSTACLE = (0.80, 0.80, 0.80), (0.60, 0.78, 0.92), (0.86, 0.72, 0.60)
_TABLE, _HEAD = (0.62, 0.72, 0.62), (0.66, 0.66, 0.78)
_TOOL = {"cutter": (0.96, 0.80, 0.35), "shank": (0.75, 0.75, 0.78), "holder": (0.55, 0.58, 0.64)}
#: Points to a pixel along the sides of triangles, which get those of a parallelogram.
_DENSE = 0.9
#: Height above the gauge point up to which the spindle's side is shown, mm.
_ABOVE = 320.0
#: How much of a body on the spindle's side shows over what is behind it.
_SHARE = 0.55


def machine_picture(plan: Plan) -> Figure:
    """The machine with part, tool and holder in the middle of the cuts of each orientation, the first nine.

    Bodies on the spindle's side are half transparent.

    Parameters
    ----------
    plan : Plan
        With a machine that has bodies, the part's place, and operations whose rotary angles are known.
    """
    assert plan.machine is not None
    groups = orientations_of(plan)
    shown = groups[:_MOST]
    made = figure(4.6 * min(len(shown), _ROW), 4.9 * -(-len(shown) // _ROW) + 0.5)
    axes = np.atleast_1d(made.subplots(-(-len(shown) // _ROW), min(len(shown), _ROW))).ravel()
    for ax, group in zip(axes, shown, strict=False):
        seen, canvas = _panel(plan, group)
        ax.imshow(canvas.colour, origin="lower", extent=seen.extent, interpolation="nearest")
        names = ", ".join(op.name for op in group[:2]) + (f" and {len(group) - 2} more" if len(group) > 2 else "")
        angles = "  ".join(f"{axis.name} {degrees(angle) + 0.0:.2f}°" for axis, angle in
                           zip(plan.machine.machine.rotary, group[0].rotary, strict=True))
        ax.set_title(f"{names}\n{angles}", fontsize=9)
        scale_bar(ax, seen)
    for ax in axes:
        bare(ax)
    left = f", the first {_MOST} of {len(groups)} orientations" if len(groups) > _MOST else ""
    machine = plan.machine.machine
    assumed = " (bodies assumed)" if any("bod" in word or "every" in word for word in machine.assumed) else ""
    made.suptitle(f"{machine.name}{assumed}{left}", fontsize=10)
    areas = {"table's side": _TABLE, "spindle's side": _HEAD, "part": _PART, "machined": _MACHINED, **_TOOL}
    made.legend(handles=[Patch(facecolor=colour, edgecolor="#555555", linewidth=0.5, label=name)
                         for name, colour in areas.items()], loc="outside lower center", ncol=7, fontsize=8,
                frameon=False)
    return made


def has_machine_picture(plan: Plan) -> bool:
    """Whether a plan's machine states bodies, the part's place and the tool's length are known, and something is done.

    Parameters
    ----------
    plan : Plan
    """
    if plan.machine is None or not plan.machine.machine.bodies:
        return False
    return plan.machine.table_from_part is not None and any(
        group[0].tool.gauge_length is not None for group in orientations_of(plan))


def orientations_of(plan: Plan) -> list[list[Operation]]:
    """Operations with known rotary angles, those that stand at one place with one tool together, in their order.

    Parameters
    ----------
    plan : Plan
    """
    groups: list[list[Operation]] = []
    for op in plan.operations:
        if op.done and (op.rotary or plan.machine is None or not plan.machine.machine.rotary):
            same = next((some for some in groups if some[0].tool == op.tool
                         and np.allclose(some[0].rotary, op.rotary, atol=1e-6)), None)
            if same is None:
                groups.append([op])
            else:
                same.append(op)
    return groups


def _panel(plan: Plan, group: Sequence[Operation]) -> tuple[Camera, Canvas]:
    """One orientation: everything in machine coordinates, the tool in the middle of the first operation's cuts."""
    op = group[0]
    assert op.path is not None and plan.machine is not None
    mounting = replace(plan.machine, tool_length=op.tool.gauge_length)
    machine = mounting.machine
    rotary = np.array(op.rotary)
    cuts = op.path.cl[op.path.kind == Motion.CUT]
    tip = cuts[len(cuts) // 2] if len(cuts) else op.path.cl[0]
    at = linear_coordinates(machine, tip, rotary, float(mounting.tool_length or 0.0), mounting.table_from_part)[0]
    bed_from_part: Array = np.linalg.inv(part_from_bed(machine, rotary, mounting.table_from_part)).astype(float)
    places = {body.carried: _place(mounting, body.carried, rotary, at) for body in machine.bodies}
    corners = [_move_points(body.convex.support(_WAYS), places[body.carried]) for body in machine.bodies]
    axis = bed_from_part[:3, :3] @ mounting.axis_at(rotary)
    foot = _move_points(tip[None], bed_from_part)[0]
    top = foot[2] + max(axis[2], 0.0) * float(mounting.tool_length or 0.0) + _ABOVE
    corners = [np.minimum(rows, [np.inf, np.inf, top]) for rows in corners]
    seen = camera(_BACK, (0.0, 0.0, 1.0), np.concatenate(corners), pixels=440)
    canvas, head = Canvas(seen), Canvas(seen)
    for body in machine.bodies:
        beside = beside_part(machine, body)
        for points, ways in body_splats(body, seen.pixel):
            (canvas if beside else head).splat(_move_points(points, places[body.carried]),
                                               ways @ places[body.carried][:3, :3].T, _TABLE if beside else _HEAD)
    machined = {one.face.number for one in group}
    for face in [*plan.part.faces, *(face for obstacle in plan.obstacles for face in obstacle.faces)]:
        own = any(face is one for one in plan.part.faces)
        colour = (_MACHINED if face.number in machined else _PART) if own else _OBSTACLE
        points, ways = face_splats(face, seen)
        canvas.splat(_move_points(points, bed_from_part), ways @ bed_from_part[:3, :3].T, colour)
    for name, line in tool_outlines(op.tool, 0.0).items():
        points, ways = splats_of_revolution(line, foot, axis, seen.pixel)
        canvas.splat(points, ways, _TOOL[name])
    for one in (canvas, head):
        one.close()
    canvas.blend(head, _SHARE)
    return seen, canvas


_WAYS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / np.sqrt(3)


def _place(mounting: Mounting, name: str, rotary: Array, at: Array) -> Array:
    """Where what an axis carries stands, (4, 4), machine coordinates."""
    matrix = bed_from_body(mounting.machine, name, rotary)
    matrix[:3, 3] += mounting.machine.directions @ axes_carrying(mounting.machine, name) @ at
    return matrix


def _move_points(points: Array, matrix: Array) -> Array:
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])


def body_splats(body: MachineBody, pixel: float) -> Iterator[tuple[Array, Array]]:
    """Points and normals of the surface of a body, dense enough to leave no gap in a picture, machine coordinates.

    Parameters
    ----------
    body : MachineBody
    pixel : float
        mm
    """
    if body.kind == "cylinder":
        low, high = body.points
        length = float(np.linalg.norm(high - low))
        outline = np.array([[0.0, 0.0], [body.radius, 0.0], [body.radius, length], [0.0, length]])
        yield splats_of_revolution(outline, low, unit(high - low), pixel)
        return
    points = body.points
    if body.kind == "box":
        points = np.array(np.meshgrid(*np.stack([points.min(axis=0), points.max(axis=0)], axis=1))).reshape(3, -1).T
    whole = ConvexHull(points)
    for corners, plane in zip(points[whole.simplices], whole.equations, strict=True):
        sides = np.linalg.norm(corners[1:] - corners[0], axis=1)
        counts = [int(count) for count in np.clip(np.ceil(_DENSE * sides / pixel), 2, 900)]
        u, v = (part.ravel() for part in np.meshgrid(*((np.arange(n) + 0.5) / n for n in counts), indexing="ij"))
        u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
        inside = corners[0] + u[:, None] * (corners[1] - corners[0]) + v[:, None] * (corners[2] - corners[0])
        yield inside, np.broadcast_to(plane[:3], inside.shape)
