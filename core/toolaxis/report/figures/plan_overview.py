"""The whole plan in one picture: the part coloured by sub-surface, its passes, and an arrow for each axis."""

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from toolaxis.numeric.vectors import unit
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan, outcome_of
from toolaxis.report.figures.hatch_fill import hatch, hatch_patch, zone_faces
from toolaxis.report.figures.label_places import LabelPlaces, join_labels
from toolaxis.report.figures.map_colouring import COLOURS, colour_map
from toolaxis.report.figures.plots import bare, cutting_lines, figure, scale_bar
from toolaxis.report.figures.splat_renderer import (
    Camera,
    Canvas,
    camera,
    face_splats,
    mean_direction,
    points_on,
    visible_runs,
)
from toolaxis.shape.face import Face
from toolaxis.tools.tool import Tool

Array = NDArray[np.float64]
Colour: TypeAlias = tuple[float, float, float]

#: With more sub-surfaces than this, arrows are shorter.
_MANY = 8
#: How far rests are lifted towards the viewer for each larger tool before, pixels.
_LIFT = 3
#: Share of a face that its sub-surfaces cover from which on the face itself is not drawn.
_COVERED = 0.995
#: Width and height of a label of a sub-surface without an axis, in widths of the picture.
_NEAR = np.array([0.14, 0.03])
#: Width of the picture, inches, and points in an inch.
_WIDTH, _POINTS = 9.0, 72.0
_PART, _NO_AXIS = (0.86, 0.86, 0.86), (0.56, 0.56, 0.56)


def overview_picture(plan: Plan) -> Figure:
    """The part with every sub-surface in a colour, its passes, and its numbered axis.

    Neighbours have different colours; with several tools every tool has one, which the legend names.  A sub-surface
    without an axis is grey and says so, or is hatched where it is left to clean-up.  Turned copies have the colour of
    their original, and neither arrow nor passes.

    Parameters
    ----------
    plan : Plan
        With at least one operation.
    """
    copies = {} if plan.blades is None else plan.blades.copies
    operations = tuple(op for op in plan.operations if op.number not in copies)
    corners = points_on(plan.part.faces)
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    arrows = _arrow_ends(operations, (0.22 if len(operations) <= _MANY else 0.16) * size)
    seen = camera(*view_onto(side_of_tools(operations)), np.concatenate([corners, *arrows]), pixels=1100)
    tools = plan.used_tools if len(plan.used_tools) > 1 else ()
    canvas = _paint_part(plan, seen, _colours(operations, tools))
    made = figure(_WIDTH, _WIDTH * seen.shape[0] / seen.shape[1] + 0.5)
    ax = made.subplots()
    ax.imshow(canvas.colour, origin="lower", extent=seen.extent, interpolation="nearest")
    for op in operations:
        _passes(ax, canvas, op)
        _borders(ax, canvas, op)
    _draw_axes(ax, plan, operations, arrows, seen)
    done = sum(op.done for op in plan.operations)
    tool_words = f"{len(tools)} tools" if tools else plan.named_tools
    ax.set_title(f"{tool_words}, scallop {plan.inputs.scallop:g} mm: {done} of {len(plan.operations)} "
                 f"sub-surfaces, different axes {plan.orientations}, cutting length {plan.length:.0f} mm", fontsize=10)
    named = [Patch(facecolor=_colour(k), label=tool.shop_name) for k, tool in enumerate(tools)]
    if any(op.zones or not op.done for op in operations):
        named.append(hatch_patch())
    if named:
        ax.legend(handles=named, loc="lower right", fontsize=8, frameon=False)
    scale_bar(ax, seen)
    bare(ax)
    return made


def _arrow_ends(operations: Sequence[Operation], length: float) -> tuple[Array, Array]:
    """Foot and head of each axis, both (n, 3) mm; they are one where there is no axis."""
    feet = np.array([root_of(op) for op in operations])
    heads = feet.copy()
    for k, op in enumerate(operations):
        if op.orientation.axis is not None:
            heads[k] += op.orientation.axis * length
    return feet, heads


def _colour(number: int) -> Colour:
    return COLOURS[number % len(COLOURS)]


def _colours(operations: Sequence[Operation], tools: Sequence[Tool]) -> dict[int, Colour]:
    """The colour of each operation by its number: that of its tool, or without tools one unlike its neighbours'."""
    if tools:
        chosen = [tools.index(op.tool) if op.tool in tools else 0 for op in operations]
    else:
        chosen = colour_map(operations)
    return {op.number: _colour(k) for op, k in zip(operations, chosen, strict=True)}


def _paint_part(plan: Plan, seen: Camera, colours: Mapping[int, Colour]) -> Canvas:
    """The part as the camera sees it: what is not machined, sub-surfaces in their colours, and what is left of them."""
    canvas = Canvas(seen)
    covered: dict[int, float] = {}  # area of each face that its sub-surfaces cover, mm^2
    for op in plan.operations:
        area = 0.0 if op.rest_of else op.face.area
        covered[op.face.number] = covered.get(op.face.number, 0.0) + area
    for face in plan.part.faces:
        if face.number not in covered or covered[face.number] < _COVERED * face.area:
            points, ways = face_splats(face, seen)
            below = _LIFT * seen.pixel if face.number in covered else 0.0  # what no sub-surface covers shows
            canvas.splat(points - below * seen.back, ways, _PART)
    # Rests lie on what larger tools left.
    lifts = {op.number: _LIFT * seen.pixel * len(op.rest_of) for op in plan.operations}
    copies = {} if plan.blades is None else plan.blades.copies
    for op in plan.operations:
        points, ways = face_splats(op.face, seen)
        original = copies.get(op.number, op.number)
        canvas.splat(points + lifts[op.number] * seen.back, ways, colours[original] if op.done else _NO_AXIS)
    canvas.close()
    highest = max(lifts.values())
    for faces, size in _left(plan):
        hatch(canvas, faces, 0.01 * size + highest)
    return canvas


def _draw_axes(ax: Axes, plan: Plan, operations: Sequence[Operation], arrows: tuple[Array, Array],
               seen: Camera) -> None:
    """An arrow for each axis with its number, and where there is none what is missing."""
    feet, tips = (seen.project(ends)[:, :2] for ends in arrows)
    at_feet = _least_distance(feet) > _least_distance(tips)
    width = seen.extent[1] - seen.extent[0]
    labels = LabelPlaces(_POINTS * _WIDTH / width)
    without: dict[int, Array] = {}
    for op, foot, tip in zip(operations, feet, tips, strict=True):
        if op.done:
            _arrow(ax, op, (foot, tip), at_feet, labels)
        elif outcome_of([op], plan.blades) == "incomplete":
            without[op.number] = foot
    for numbers, place in join_labels(without, _NEAR * float(np.ptp(seen.extent[:2]))):
        _write(ax, f"{', '.join(map(str, numbers))}: no axis", place, (4.5, 4.5))


def side_of_tools(operations: Sequence[Operation]) -> Array:
    """From where the tools come on the mean, by areas; where there are none, the mean normal, (3,) unit vector.

    Parameters
    ----------
    operations : sequence of Operation
    """
    weighted = [(op.orientation.axis, op.face.area) for op in operations
                if op.done and op.orientation.axis is not None]
    if not weighted:
        weighted = [(mean_direction(op.face.normal(op.face.places_on(12))), 1.0) for op in operations]
    whole = sum(area for _, area in weighted)
    return mean_direction(np.array([len(weighted) * area / whole * way for way, area in weighted]))


def _left(plan: Plan) -> list[tuple[list[Face], float]]:
    """What is left to clean-up of an operation and its turned copies together, and the size of its sub-surface, mm.

    Not what smaller tools took over: what these leave is their own.
    """
    copies = {} if plan.blades is None else plan.blades.copies
    found: dict[int, tuple[list[Face], float]] = {}
    for op in plan.operations:
        original = copies.get(op.number, op.number)
        together, _ = found.setdefault(original, ([], op.face.diagonal))
        if op.number in plan.taken_over:
            continue
        left_as_a_whole = not op.done and outcome_of([op], plan.blades) == "complete"
        together.extend([op.face] if left_as_a_whole else zone_faces(op))
    return list(found.values())


def view_onto(middle: Array) -> tuple[Array, Array]:
    """Towards the viewer and upright: obliquely onto the mean normal.

    Parameters
    ----------
    middle : (3,) array
        Mean normal.
    """
    flat = abs(middle[2]) >= 0.9  # seen from above or below, the normal itself points upwards in the picture
    up = np.array([0.0, 1.0, 0.0]) if flat else np.array([0.0, 0.0, 1.0])
    side = unit(np.cross(up, middle))
    back = middle + 0.45 * side - 0.65 * np.cross(middle, side)
    return back, middle if flat else up


def root_of(op: Operation) -> Array:
    """The point of a sub-surface nearest to its middle, (3,) mm.

    Parameters
    ----------
    op : Operation
    """
    points = op.face.evaluate(op.face.places_on(16)).point
    from_middle = np.linalg.norm(points - points.mean(axis=0), axis=1)
    return np.asarray(points[np.argmin(from_middle)])


def _passes(ax: Axes, canvas: Canvas, op: Operation) -> None:
    if op.path is not None:
        slack = 0.01 * op.face.diagonal + 4 * canvas.camera.pixel
        runs = [run for line in cutting_lines(op.path) for run in visible_runs(canvas, line, slack)]
        ax.add_collection(LineCollection(runs, colors="#333333", linewidths=0.25))


def _borders(ax: Axes, canvas: Canvas, op: Operation) -> None:
    """Where a sub-surface ends: neighbours under one tool have its colour both."""
    slack = 3 * canvas.camera.pixel
    lines = [op.face.evaluate(np.vstack([loop, loop[:1]])).point for loop in op.face.outline]
    runs = [run for line in lines for run in visible_runs(canvas, line, slack)]
    ax.add_collection(LineCollection(runs, colors="white", linewidths=1.6))
    ax.add_collection(LineCollection(runs, colors="#222222", linewidths=0.7))


def _least_distance(places: Array) -> float:
    """How near the two nearest of (n, 2) places are; 0 for one alone."""
    if len(places) < 2:
        return 0.0
    distances, _ = cKDTree(places).query(places, k=2)
    return float(distances[:, 1].min())  # the nearest place to each is itself


def _arrow(ax: Axes, op: Operation, ends: tuple[Array, Array], at_foot: bool, labels: LabelPlaces) -> None:
    """The axis as an arrow, its number behind the foot or before the tip."""
    foot, tip = ends
    begin, end = ((float(x), float(y)) for x, y in ends)
    ax.plot(*begin, "o", color="black", markersize=3.5)
    ax.annotate("", end, begin, arrowprops={"arrowstyle": "-|>", "color": "black", "linewidth": 1.4})
    length = float(np.linalg.norm(tip - foot))
    way = (tip - foot) / length if length > 0 else np.array([0.5, 0.5])
    place, offset = (foot, -10 * way) if at_foot else (tip, 9 * way)
    words = f"{op.number}"
    _write(ax, words, place, labels.find(words, place, offset))


def _write(ax: Axes, words: str, place: Array, offset: ArrayLike) -> None:
    """Words beside a place, (2,), with an offset in points, (2,)."""
    x, y = np.asarray(offset, dtype=float)
    halo = patheffects.withStroke(linewidth=3, foreground="white")
    ax.annotate(words, (float(place[0]), float(place[1])), textcoords="offset points", xytext=(x, y), fontsize=11,
                weight="bold", path_effects=[halo], ha="center", va="center", zorder=5)
