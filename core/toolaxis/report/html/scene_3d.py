"""The plan in three dimensions, to be turned: part, sub-surfaces, passes, axes, clean-up zones, worst places."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion
from toolaxis.numeric.simplify_polyline import simplify_polyline
from toolaxis.numeric.vectors import unit
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan, outcome_of
from toolaxis.report.figures.hatch_fill import zone_faces
from toolaxis.report.figures.map_colouring import colour_map
from toolaxis.report.figures.plan_overview import root_of, side_of_tools, view_onto
from toolaxis.report.figures.plots import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, cutting_lines
from toolaxis.report.figures.splat_renderer import mean_direction
from toolaxis.report.figures.tessellation import outline_loops, triangles
from toolaxis.shape.face import Face

Array = NDArray[np.float64]

_PALE = ("#A3D3F1", "#F2CC7A", "#7FCDB5", "#F6EE9B", "#E4BAD0", "#7FB8D8", "#EAAE7F")
_PART, _NO_AXIS, _OBSTACLE, _BLACK = "#D2D2D2", "#8F8F8F", "#B89B7A", "#000000"
#: With more sub-surfaces than this, arrows are shorter.
_MANY = 8
#: Shares of the part's diagonal: how far triangles may be from their faces, and drawn lines from passes.
_COARSE, _LINES = 1 / 4000, 1 / 10000
#: Points of drawn lines at most; the bound of lines is doubled until they are no more.
_MOST_POINTS = 150_000
#: How far away the light stands: the viewer takes no more, and lights triangles from the other side than it is told.
_LIGHT = -1e5
#: Diagonal of what is drawn, in the viewer's unit: it fills the view.
_LARGE = 2.6
#: Decimals of coordinates, mm.
_DIGITS = 3


@dataclass(frozen=True, eq=False)
class PageScene:
    """The figure, and what it leaves out.

    Attributes
    ----------
    figure : plotly Figure
    off : float
        Greatest distance of the triangles drawn from the faces, where it was measured, mm.
    apart : float
        Bound of the distance of the passes' points from the lines drawn, mm.
    """

    figure: go.Figure
    off: float
    apart: float


def scene(plan: Plan, worst: Mapping[str, Sequence[Mapping[str, Any]]]) -> PageScene:
    """The plan as a figure to be turned.

    Turned copies of operations on the other blades have the colour of their original and go with it; their passes are
    not drawn.

    Parameters
    ----------
    plan : Plan
    worst : mapping of str to sequence
        Places to mark by what they are, such as "worst scallop": "point" (x, y, z) mm and "text".
    """
    copies = {} if plan.blades is None else plan.blades.copies
    originals = [op for op in plan.operations if op.number not in copies]
    corners = np.concatenate([face.box for face in plan.part.faces])
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    coarse = _COARSE * size
    middle = side_of_tools(originals) if originals else np.array([0.0, 0.0, 1.0])
    back, up = view_onto(middle)
    towards_viewer = unit(back)
    meshes = _Meshes(coarse, unit(towards_viewer + 0.5 * unit(up)))
    passes, links, apart = _thin_motions(originals, _LINES * size)
    arrow = (0.22 if len(originals) <= _MANY else 0.16) * size
    traces = [
        *_part_meshes(plan, originals, meshes),
        _edge_lines(plan, coarse),
        _lines(passes, "passes", BLUE, 2.0),
        _lines(links, "links", PURPLE, 1.5, visible="legendonly"),
        *_zones([op for op in plan.operations if op.zones], meshes, coarse),
        *_axes([op for op in originals if op.done], arrow),
        *(_places(name, places) for name, places in worst.items() if places),
        _datum(plan.datum, 0.08 * size),
    ]
    made = go.Figure([trace for trace in traces if trace is not None])
    made.update_layout(_layout(towards_viewer, up, _ranges(made)))
    return PageScene(made, meshes.off, apart)


def _part_meshes(plan: Plan, originals: Sequence[Operation], meshes: "_Meshes") -> list[go.Mesh3d | None]:
    """What is not machined of the part, each sub-surface with its turned copies, and obstacles."""
    traces = []
    rest = _other_faces(plan)
    if rest:
        traces.append(meshes.mesh(rest, "part", _PART))
    copies = {} if plan.blades is None else plan.blades.copies
    colours = colour_map(originals) if originals else ()
    for op, colour in zip(originals, colours, strict=True):
        turned = [other.face for other in plan.operations if copies.get(other.number) == op.number]
        words = _mesh_words(plan, op, len(turned))
        traces.append(meshes.mesh([op.face, *turned], words, _PALE[colour] if op.done else _NO_AXIS))
    obstacles = [face for body in plan.obstacles for face in body.faces]
    if obstacles:
        traces.append(meshes.mesh(obstacles, "obstacles", _OBSTACLE, opacity=0.55))
    return traces


def _other_faces(plan: Plan) -> list[Face]:
    """Faces of the part that no operation machines, not even a piece of them."""
    machined = {number for op in plan.operations for number in op.face.numbers}
    return [face for face in plan.part.faces if not machined.intersection(face.numbers)]


def _mesh_words(plan: Plan, op: Operation, turned: int) -> str:
    """What the legend says of a sub-surface."""
    words = f"{op.number}: face {op.face.label}"
    if turned:
        words += f" and {turned} turned"
    if op.done:
        return words
    left_to_clean_up = outcome_of([op], plan.blades) == "complete"
    return words + (", rest material" if left_to_clean_up else ", no axis")


def _edge_lines(plan: Plan, bound: float) -> go.Scatter3d | None:
    faces = [*_other_faces(plan), *(op.face for op in plan.operations)]
    loops = [loop for face in faces for loop in _outline_points(face, bound)]
    return _lines(loops, "edges", "#4C4C4C", 1.5)


def _outline_points(face: Face, bound: float) -> list[Array]:
    """The closed borders of a face, each (m, 3) mm."""
    return [_closed(face.evaluate(loop).point) for loop in outline_loops(face, bound)]


def _ranges(made: go.Figure) -> Array:
    """Lower and upper ends of everything drawn, (2, 3) mm."""
    lower = [[np.nanmin(trace[name]) for name in "xyz"] for trace in made.data]
    upper = [[np.nanmax(trace[name]) for name in "xyz"] for trace in made.data]
    return np.array([np.min(lower, axis=0), np.max(upper, axis=0)])


def _layout(back: Array, up: Array, ranges: Array) -> dict[str, Any]:
    margin = 0.01 * float(np.linalg.norm(ranges[1] - ranges[0]))
    low = ranges[0] - margin
    high = ranges[1] + margin
    view: dict[str, Any] = {}
    for name, begin, end in zip("xyz", low, high, strict=True):
        view[f"{name}axis"] = {"visible": False, "range": [round(float(begin), 3), round(float(end), 3)]}
    view["aspectmode"] = "manual"
    view["aspectratio"] = _xyz(_LARGE * unit(high - low))
    view["dragmode"] = "turntable"
    view["camera"] = {"eye": _xyz(1.25 * back), "up": _xyz(up), "projection": {"type": "orthographic"}}
    legend = {"orientation": "h", "y": 0.0, "yanchor": "top", "font": {"size": 12}, "itemsizing": "constant"}
    return {
        "scene": view,
        "margin": {"l": 0, "r": 0, "t": 0, "b": 0},
        "paper_bgcolor": "white",
        "template": "none",
        "legend": legend,
    }


def _xyz(row: Array) -> dict[str, float]:
    return {name: round(float(value), 4) for name, value in zip("xyz", row, strict=True)}


def _coordinates(points: Array) -> dict[str, Any]:
    rows = np.round(points, _DIGITS).astype(np.float32)
    return {"x": rows[:, 0], "y": rows[:, 1], "z": rows[:, 2]}


class _Meshes:
    """Faces as meshes, and the greatest distance of these from the faces so far."""

    def __init__(self, bound: float, light: Array) -> None:
        self.bound = bound
        self.light = light
        self.off = 0.0

    def mesh(self, faces: Iterable[Face], name: str, colour: str, lift: float = 0.0, **more: Any) -> go.Mesh3d | None:
        """Faces as one mesh, each lifted along its mean normal; None where they have no triangles."""
        points: list[Array] = []
        corners: list[NDArray[np.integer]] = []
        before = 0
        for face in faces:
            found = triangles(face, self.bound)
            self.off = max(self.off, found.off)
            points.append(found.points if lift == 0 else found.points + lift * _mean_normal(face))
            corners.append(found.corners + before)
            before += len(found.points)
        index = np.concatenate(corners).astype(np.int32)
        if not len(index):
            return None
        i, j, k = index.T
        lighting = {"ambient": 0.5, "diffuse": 0.65, "specular": 0.05, "roughness": 0.9}
        return go.Mesh3d(**_coordinates(np.concatenate(points)), i=i, j=j, k=k, name=escape(name), color=colour,
                         showlegend=True, hoverinfo="name", flatshading=False, lighting=lighting,
                         lightposition=_xyz(_LIGHT * self.light), **more)


def _mean_normal(face: Face) -> Array:
    """One direction out of the material for all of a small piece of a face, (3,)."""
    return mean_direction(face.normal(np.concatenate(face.outline)))


def _closed(points: Array) -> Array:
    return np.vstack([points, points[:1]])


def _lines(lines: Sequence[Array], name: str, colour: str, width: float, **more: Any) -> go.Scatter3d | None:
    if not lines:
        return None
    gap = np.full((1, 3), np.nan)
    rows = np.concatenate([part for line in lines for part in (line, gap)])[:-1]
    style = {"color": colour, "width": width}
    return go.Scatter3d(**_coordinates(rows), mode="lines", name=name, hoverinfo="skip", line=style, **more)


def _thin_motions(operations: Sequence[Operation], bound: float) -> tuple[list[Array], list[Array], float]:
    """Contact lines of passes and tips of links, thinned, and the bound of that, mm."""
    paths = [op.path for op in operations if op.path is not None]
    passes = [line for path in paths for line in cutting_lines(path)]
    links = [line for path in paths for line in _link_lines(path.cl, path.kind)]
    shown = _thin(passes, bound)
    while sum(map(len, shown)) > _MOST_POINTS:
        bound *= 2
        shown = _thin(passes, bound)
    return shown, _thin(links, bound), bound


def _thin(lines: Sequence[Array], bound: float) -> list[Array]:
    return [line[simplify_polyline(line, bound)] for line in lines]


def _link_lines(tips: Array, kind: NDArray[np.int8]) -> list[Array]:
    """Tips along each link, from the last point of the pass before it, (m, 3) mm."""
    away = (kind != Motion.CUT).astype(np.int8)
    starts = np.flatnonzero(np.diff(away, prepend=0) == 1)
    ends = np.flatnonzero(np.diff(away, append=0) == -1)
    lines = []
    for start, end in zip(starts, ends, strict=True):
        if end > 0:  # the first point alone makes no line
            lines.append(tips[max(start - 1, 0):end + 1])
    return lines


def _zones(operations: Sequence[Operation], meshes: _Meshes, bound: float) -> list[go.Mesh3d | go.Scatter3d | None]:
    faces = [face for op in operations for face in zone_faces(op)]
    if not faces:
        return []
    fill = meshes.mesh(faces, "rest material", VERMILION, lift=8 * bound, opacity=0.55)
    loops = [loop for face in faces for loop in _outline_points(face, bound)]
    return [fill, _lines(loops, "borders of rest material", VERMILION, 3.0, showlegend=False)]


def _axes(operations: Sequence[Operation], length: float) -> list[Any]:
    """An arrow for each axis with the operation's number; pointing at it tells the rest."""
    if not operations:
        return []
    roots = np.array([root_of(op) for op in operations])
    axes = np.array([op.orientation.axis for op in operations], dtype=float)
    heads = roots + length * axes
    shafts = _lines([np.array(ends) for ends in zip(roots, heads, strict=True)], "axes", _BLACK, 4.0,
                    legendgroup="axes")
    u, v, w = np.round(axes, 5).astype(np.float32).T
    cones = go.Cone(**_coordinates(heads), u=u, v=v, w=w, anchor="tip", sizemode="raw",
                    sizeref=round(0.2 * length, 4), colorscale=[[0, _BLACK], [1, _BLACK]], showscale=False,
                    name="axes", legendgroup="axes", hoverinfo="skip")
    above = heads + 0.06 * length * axes
    numbers = [str(op.number) for op in operations]
    words = [_axis_text(op) for op in operations]
    labels = go.Scatter3d(**_coordinates(above), mode="markers+text", text=numbers, customdata=words,
                          legendgroup="axes", hovertemplate="%{customdata}<extra></extra>", showlegend=False,
                          textfont={"size": 14, "color": _BLACK}, marker={"size": 5, "color": _BLACK},
                          textposition="top center", name="axes")
    return [shafts, cones, labels]


def _axis_text(op: Operation) -> str:
    axis = op.orientation.axis
    assert axis is not None
    positive_zeros = np.asarray(axis) + 0.0
    direction = "axis " + ", ".join(f"{value:+.4f}" for value in positive_zeros)
    if op.orientation.lead is not None:
        direction = f"the axis moves, lead {np.degrees(op.orientation.lead):+.2f}°; mean {direction}"
    amounts = f"{op.orientation.passes} passes, cutting length {op.orientation.length:.1f} mm"
    return "<br>".join([f"<b>{escape(op.name)}</b>", direction, amounts])


def _places(name: str, places: Sequence[Mapping[str, Any]]) -> go.Scatter3d:
    colour, symbol = (VERMILION, "diamond-open") if "gouge" in name else (ORANGE, "circle-open")
    points = np.array([place["point"] for place in places], dtype=float).reshape(-1, 3)
    words = [escape(str(place["text"])) for place in places]
    marker = {"size": 7, "color": colour, "symbol": symbol, "line": {"width": 3}}
    return go.Scatter3d(**_coordinates(points), mode="markers", name=name, text=words,
                        hovertemplate="%{text}<extra></extra>", marker=marker)


def _datum(origin: Array, length: float) -> go.Scatter3d:
    gap = [np.nan] * 3
    arms = [np.array([origin, origin + length * way, gap]) for way in np.eye(3)]
    colours = np.repeat([VERMILION, GREEN, SKY], 3).tolist()
    letters = ["", "X", "", "", "Y", "", "", "Z", ""]
    return go.Scatter3d(**_coordinates(np.concatenate(arms)), mode="lines+text", text=letters,
                        line={"color": colours, "width": 5}, name="part's frame at the datum", hoverinfo="skip",
                        textfont={"size": 13})
