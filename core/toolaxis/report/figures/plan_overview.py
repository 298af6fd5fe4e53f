"""The whole plan in one picture: the part coloured by sub-surface, its passes, and an arrow for each axis."""

from collections.abc import Sequence

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
from toolaxis.report.figures.splat_renderer import Canvas, camera, face_splats, mean_direction, visible_runs
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

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
    middle = side_of_tools(operations)
    corners = np.concatenate([face.evaluate(loop).point for face in plan.part.faces for loop in face.outline])
    arrow = (0.22 if len(operations) <= _MANY else 0.16) * float(np.linalg.norm(np.ptp(corners, axis=0)))
    roots = np.array([root_of(op) for op in operations])
    heads = np.array([root + (op.orientation.axis if op.orientation.axis is not None else 0 * root) * arrow
                      for op, root in zip(operations, roots, strict=True)])
    seen = camera(*view_onto(middle), np.concatenate([corners, roots, heads]), pixels=1100)
    canvas = Canvas(seen)
    covered: dict[int, float] = {}
    for op in plan.operations:
        covered[op.face.number] = covered.get(op.face.number, 0.0) + (0.0 if op.rest_of else op.face.area)
    for face in plan.part.faces:
        if face.number not in covered or covered[face.number] < _COVERED * face.area:
            points, ways = face_splats(face, seen)
            below = _LIFT * seen.pixel if face.number in covered else 0.0  # what no sub-surface covers shows
            canvas.splat(points - below * seen.back, ways, _PART)
    tools = plan.used_tools if len(plan.used_tools) > 1 else ()
    chosen = [tools.index(op.tool) if op.tool in tools else 0 for op in operations] if tools else colour_map(operations)
    colours = {op.number: COLOURS[k % len(COLOURS)] for op, k in zip(operations, chosen, strict=True)}
    # Rests lie on what larger tools left.
    lifts = {op.number: _LIFT * seen.pixel * len(op.rest_of) for op in plan.operations}
    highest = max(lifts.values())
    for op in plan.operations:
        points, ways = face_splats(op.face, seen)
        canvas.splat(points + lifts[op.number] * seen.back, ways,
                     colours[copies.get(op.number, op.number)] if op.done else _NO_AXIS)
    canvas.close()
    for faces, size in _left(plan):
        hatch(canvas, faces, 0.01 * size + highest)
    made = figure(_WIDTH, _WIDTH * seen.shape[0] / seen.shape[1] + 0.5)
    ax = made.subplots()
    ax.imshow(canvas.colour, origin="lower", extent=seen.extent, interpolation="nearest")
    feet, tips = seen.project(roots)[:, :2], seen.project(heads)[:, :2]
    at_feet = _apart(feet) > _apart(tips)
    lost: dict[int, Array] = {}
    labels = LabelPlaces(_POINTS * _WIDTH / (seen.extent[1] - seen.extent[0]))
    for op, foot, tip in zip(operations, feet, tips, strict=True):
        _passes(ax, canvas, op)
        _borders(ax, canvas, op)
        if op.done:
            _arrow(ax, op, (foot, tip), at_feet, labels)
        elif outcome_of([op], plan.blades) == "incomplete":
            lost[op.number] = foot
    for numbers, place in join_labels(lost, _NEAR * float(np.ptp(seen.extent[:2]))):
        _write(ax, f"{', '.join(map(str, numbers))}: no axis", place, (4.5, 4.5))
    done = sum(op.done for op in plan.operations)
    tool_words = f"{len(tools)} tools" if tools else plan.named_tools
    ax.set_title(f"{tool_words}, scallop {plan.inputs.scallop:g} mm: {done} of {len(plan.operations)} "
                 f"sub-surfaces, different axes {plan.orientations}, cutting length {plan.length:.0f} mm", fontsize=10)
    named = [Patch(facecolor=COLOURS[k % len(COLOURS)], label=tool.shop_name) for k, tool in enumerate(tools)]
    if any(op.zones or not op.done for op in operations):
        named.append(hatch_patch())
    if named:
        ax.legend(handles=named, loc="lower right", fontsize=8, frameon=False)
    scale_bar(ax, seen)
    bare(ax)
    return made


def side_of_tools(operations: Sequence[Operation]) -> Array:
    """From where the tools come on the mean, by areas; where there are none, the mean normal, (3,) unit vector.

    Parameters
    ----------
    operations : sequence of Operation
    """
    rows = [(op.orientation.axis, op.face.area) for op in operations if op.done and op.orientation.axis is not None]
    if not rows:
        rows = [(mean_direction(op.face.normal(op.face.places_on(12))), 1.0) for op in operations]
    whole = sum(area for _, area in rows)
    return mean_direction(np.array([len(rows) * area / whole * way for way, area in rows]))


def _left(plan: Plan) -> list[tuple[list[Face], float]]:
    """What is left to clean-up of an operation and its turned copies together, and the size of its sub-surface, mm.

    Not what smaller tools took over: what these leave is their own.
    """
    copies = {} if plan.blades is None else plan.blades.copies
    found: dict[int, tuple[list[Face], float]] = {}
    for op in plan.operations:
        left = not op.done and outcome_of([op], plan.blades) == "complete"
        together, _ = found.setdefault(copies.get(op.number, op.number), ([], op.face.diagonal))
        if op.number not in plan.taken_over:
            together.extend((op.face,) if left else zone_faces(op))
    return list(found.values())


def view_onto(middle: Array) -> tuple[Array, Array]:
    """Towards the viewer and upright: obliquely onto the mean normal.

    Parameters
    ----------
    middle : (3,) array
        Mean normal.
    """
    up = np.array([0.0, 0.0, 1.0]) if abs(middle[2]) < 0.9 else np.array([0.0, 1.0, 0.0])
    side = unit(np.cross(up, middle))
    return middle + 0.45 * side - 0.65 * np.cross(middle, side), middle if abs(middle[2]) >= 0.9 else up


def root_of(op: Operation) -> Array:
    """The point of a sub-surface nearest to its middle, (3,) mm.

    Parameters
    ----------
    op : Operation
    """
    points = op.face.evaluate(op.face.places_on(16)).point
    return np.asarray(points[np.argmin(np.linalg.norm(points - points.mean(axis=0), axis=1))])


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


def _apart(places: Array) -> float:
    """How near the two nearest of (n, 2) places are."""
    return float(cKDTree(places).query(places, k=2)[0][:, 1].min()) if len(places) > 1 else 0.0


def _arrow(ax: Axes, op: Operation, ends: tuple[Array, Array], at_foot: bool, labels: LabelPlaces) -> None:
    """The axis as an arrow, its number behind the foot or before the tip."""
    foot, tip = ((float(end[0]), float(end[1])) for end in ends)
    ax.plot(*foot, "o", color="black", markersize=3.5)
    ax.annotate("", tip, foot, arrowprops={"arrowstyle": "-|>", "color": "black", "linewidth": 1.4})
    length = float(np.linalg.norm(ends[1] - ends[0]))
    way = (ends[1] - ends[0]) / length if length > 0 else np.array([0.5, 0.5])
    place, words = ends[0] if at_foot else ends[1], f"{op.number}"
    _write(ax, words, place, labels.find(words, place, (-10 if at_foot else 9) * way))


def _write(ax: Axes, words: str, place: Array, offset: ArrayLike) -> None:
    """Words beside a place, (2,), with an offset in points, (2,)."""
    x, y = np.asarray(offset, dtype=float)
    ax.annotate(words, (float(place[0]), float(place[1])), textcoords="offset points", xytext=(x, y), fontsize=11,
                weight="bold", path_effects=[patheffects.withStroke(linewidth=3, foreground="white")], ha="center",
                va="center", zorder=5)
