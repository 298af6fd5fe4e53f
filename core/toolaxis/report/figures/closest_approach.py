"""The tool with its holder where it comes nearest to what it must keep clear of."""

from typing import NamedTuple, Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Polygon
from numpy.typing import NDArray

from toolaxis.numeric.grids import grid_rows
from toolaxis.numeric.vectors import perpendicular, unit
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan
from toolaxis.report.figures.plots import BLUE, VERMILION, bare, figure, scale_bar
from toolaxis.report.figures.splat_renderer import Camera, Canvas, camera, points_on, tool_outlines
from toolaxis.shape.differential import normals
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

_COLOURS = {"cutter": (0.96, 0.80, 0.35), "shank": (0.75, 0.75, 0.78), "holder": (0.55, 0.58, 0.64),
            "shank (not given)": (0.75, 0.75, 0.78)}
_PART, _MACHINED, _NEAR = (0.84, 0.84, 0.84), (0.80, 0.89, 0.96), (0.95, 0.72, 0.62)
#: Lines each way of the grids that cut a face, and that tell what of it is shown; splats each way at most.
_FINE, _COARSE, _MOST = 160, 33, 1600

Window = tuple[float, float, float, float]


class ToolPlace(Protocol):
    """Where a tool stands, and what it is near to."""

    @property
    def component(self) -> str:
        """Part of the tool that is nearest."""

    @property
    def distance(self) -> float:
        """Lower bound of its distance, mm."""

    @property
    def face(self) -> int:
        """Number of the face that it is near to."""

    @property
    def place(self) -> Array:
        """The nearest place of that face, (3,) mm."""

    @property
    def tip(self) -> Array:
        """Where the tool's tip is, (3,) mm."""


def tightest_picture(plan: Plan, op: Operation, at: ToolPlace) -> Figure:
    """The part, cut by the plane through the tool's axis and the nearest place, with the tool in it; whole and close.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    at : ToolPlace
    """
    assert op.orientation.axis is not None
    axis = np.asarray(op.orientation.axis, dtype=float)
    aside = at.place - at.tip
    aside = aside - (aside @ axis) * axis
    aside = unit(aside) if np.linalg.norm(aside) > 1e-9 else perpendicular(axis)[0]
    back = _open_side(plan, np.cross(axis, aside), at)
    made = figure(12.0, 6.6)
    whole, close = made.subplots(1, 2)
    outlines = tool_outlines(op.tool, 8 * op.tool.radius)
    tool_points = np.concatenate([at.tip + line[:, 1:] * axis + sign * line[:, :1] * aside
                                  for line in outlines.values() for sign in (1, -1)])
    corners = points_on(plan.part.faces)
    everything = np.concatenate([tool_points, corners])
    _draw(whole, plan, op, _Scene(at, outlines, camera(back, axis, everything, pixels=900)))
    span = 2.2 * op.tool.radius + 1.5 * max(at.distance, 0.0)
    on_axis = at.tip + ((at.place - at.tip) @ axis) * axis
    middle = 0.7 * at.place + 0.3 * on_axis
    around = np.array([middle + x * aside + y * axis for x in (-span, span) for y in (-span, span)])
    _draw(close, plan, op, _Scene(at, outlines, camera(back, axis, around, pixels=800)))
    whole.set_title(f"{op.name}: {op.tool.name} where it is tightest", fontsize=10)
    close.set_title(f"{at.component} at least {at.distance:.3f} mm from face {at.face}", fontsize=10)
    near = {} if at.face == op.face.number else {f"face {at.face}, nearest": _NEAR}
    areas = {"machined face": _MACHINED, **near, "part": _PART, **{name: _COLOURS[name] for name in outlines}}
    handles = [Patch(facecolor=colour, edgecolor="#555555", linewidth=0.5, label=name)
               for name, colour in areas.items()]
    made.legend(handles=handles, loc="outside lower center", ncol=6, fontsize=8, frameon=False)
    return made


def _open_side(plan: Plan, back: Array, at: ToolPlace) -> Array:
    """Of the two directions to look from, the one with less of the part in front of the plane."""
    points = np.concatenate([face.evaluate(face.grid(4, 4)).point for face in plan.part.faces])
    in_front = (points - at.tip) @ back > 0
    return back if in_front.mean() <= 0.5 else -back


class _Scene(NamedTuple):
    """What a picture shows: the tool where it is, its outlines by name, and the camera, which looks at right angles to
    the plane through the tool's axis."""

    at: ToolPlace
    outlines: dict[str, Array]
    seen: Camera


def _draw(ax: Axes, plan: Plan, op: Operation, scene: _Scene) -> None:
    """What lies behind the plane, the cut through the faces, the tool's outline, and the nearest place."""
    at, outlines, seen = scene
    canvas = Canvas(seen)
    cuts: list[Array] = []
    obstacles = [face for body in plan.obstacles for face in body.faces]
    for face in [*plan.part.faces, *obstacles]:
        window = _window(face, seen)
        if window is None:
            continue
        points, directions = window_splats(face, window, seen)
        depth = (points - at.tip) @ seen.back
        is_obstacle = any(face is other for other in obstacles)
        if face.number == op.face.number and not is_obstacle:
            colour = _MACHINED
        else:
            colour = _NEAR if face.number == at.face else _PART
        behind = depth <= 0
        canvas.splat(points[behind], directions[behind], colour)
        cuts += _section(face, window, at.tip, seen)
    canvas.close()
    ax.imshow(canvas.colour, origin="lower", extent=seen.extent, interpolation="nearest")
    axis = np.asarray(op.orientation.axis, dtype=float)
    foot = _flat(seen, at.tip)
    up = _flat(seen, at.tip + axis) - foot
    right = _flat(seen, at.tip + np.cross(axis, seen.back)) - foot
    for name, line in outlines.items():
        radius = line[:, :1]
        height = line[:, 1:]
        half = foot + height * up + radius * right
        other = foot + height * up - radius * right
        outline = np.concatenate([half, other[::-1]])
        ax.add_patch(Polygon(outline, closed=True, facecolor=(*_COLOURS[name], 0.85), edgecolor="#444444",
                             linewidth=0.7))
    ax.add_collection(LineCollection(cuts, colors="black", linewidths=0.9))
    path = op.path
    if path is not None:
        near = np.linalg.norm(path.cc - at.tip, axis=1).argmin()
        ax.plot(*_flat(seen, path.cc[near]), ".", color=BLUE, markersize=5)
    ax.plot(*_flat(seen, at.place), "o", color=VERMILION, markersize=9, fillstyle="none", markeredgewidth=1.6)
    left, right_, low, high = seen.extent
    scale_bar(ax, seen)
    bare(ax)
    ax.set_aspect("equal", adjustable="box")
    ax.set_xlim(left, right_)
    ax.set_ylim(low, high)


def _flat(seen: Camera, point: Array) -> Array:
    return np.asarray(seen.project(point[None])[0, :2])


def _window(face: Face, seen: Camera) -> Window | None:
    """The range of a face's parameters that the picture shows, u0, u1, v0, v1; None where it shows nothing of it."""
    u = np.linspace(*face.bounds[:2], _COARSE)
    v = np.linspace(*face.bounds[2:], _COARSE)
    flat = seen.project(face.evaluate(grid_rows(u, v)).point)[:, :2]
    net = flat.reshape(_COARSE, _COARSE, 2)
    slack = max(float(np.abs(np.diff(net, axis=axis)).max()) for axis in (0, 1))
    left, right, low, high = seen.extent
    lower = np.array([left, low]) - slack
    upper = np.array([right, high]) + slack
    shown = ((net >= lower) & (net <= upper)).all(axis=2)
    i, j = np.nonzero(shown)
    if not len(i):
        return None
    return float(u[i.min()]), float(u[i.max()]), float(v[j.min()]), float(v[j.max()])


def window_splats(face: Face, window: Window, seen: Camera) -> tuple[Array, Array]:
    """Points and normals of a range of a face's parameters, dense enough to leave no gap in the picture.

    Parameters
    ----------
    face : Face
    window : (float, float, float, float)
        u0, u1, v0, v1
    seen : Camera

    Returns
    -------
    points, normals : (n, 3) array
    """
    u0, u1, v0, v1 = window
    d = face.evaluate(grid_rows(np.linspace(u0, u1, 12), np.linspace(v0, v1, 12)))
    counts = []
    for rate, span in ((d.su, u1 - u0), (d.sv, v1 - v0)):
        flat = np.linalg.norm(seen.project(rate)[:, :2], axis=1).max() * span
        counts.append(int(np.clip(np.ceil(1.3 * flat / seen.pixel), 8, _MOST)))
    along_u, along_v = counts
    u = u0 + (u1 - u0) * (np.arange(along_u) + 0.5) / along_u
    v = v0 + (v1 - v0) * (np.arange(along_v) + 0.5) / along_v
    uv = grid_rows(u, v)
    uv = uv[face.contains(uv)]
    dense = face.evaluate(uv)
    return dense.point, normals(dense, face.flip)


def _section(face: Face, window: Window, tip: Array, seen: Camera) -> list[Array]:
    """Where a face meets the plane through the tip that the picture lies in, as short lines in the picture."""
    u0, u1, v0, v1 = window
    uv = grid_rows(np.linspace(u0, u1, _FINE), np.linspace(v0, v1, _FINE))
    points = face.evaluate(uv).point
    depth = ((points - tip) @ seen.back).reshape(_FINE, _FINE)
    if depth.min() > 0 or depth.max() < 0:
        return []
    flat = seen.project(points)[:, :2].reshape(_FINE, _FINE, 2)
    on = face.contains(uv).reshape(_FINE, _FINE)
    return _crossings(depth, flat, on)


def _crossings(depth: Array, flat: Array, on: NDArray[np.bool_]) -> list[Array]:
    """Segments of the zero line of a grid of values, two triangles to a cell."""
    i, j = (index.ravel() for index in np.indices((depth.shape[0] - 1, depth.shape[1] - 1)))
    lines = []
    for corners in (((i, j), (i + 1, j), (i, j + 1)), ((i + 1, j + 1), (i + 1, j), (i, j + 1))):
        value = np.stack([depth[c] for c in corners], axis=1)
        place = np.stack([flat[c] for c in corners], axis=1)
        there = np.stack([on[c] for c in corners], axis=1).all(axis=1)
        mixed = there & (value.min(axis=1) < 0) & (value.max(axis=1) >= 0)
        value = value[mixed]
        place = place[mixed]
        # The corner that lies alone on its side of zero: the line crosses both sides that end there.
        below = value < 0
        one_below = below.sum(axis=1) == 1
        alone = np.argmax(below == one_below[:, None], axis=1)
        rows = np.arange(len(value))
        begin = value[rows, alone]
        corner = place[rows, alone]
        ends = []
        for step in (1, 2):
            other = (alone + step) % 3
            share = begin / (begin - value[rows, other])
            ends.append(corner + share[:, None] * (place[rows, other] - corner))
        lines += list(np.stack(ends, axis=1))
    return lines
