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
_PART, _NO_AXIS, _OBSTACLE = "#D2D2D2", "#8F8F8F", "#B89B7A"
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
    whole = {number for op in plan.operations for number in op.face.numbers}
    rest = [face for face in plan.part.faces if not whole.intersection(face.numbers)]
    back, up = view_onto(side_of_tools(originals) if originals else np.array([0.0, 0.0, 1.0]))
    drawn = _Meshes(_COARSE * size, unit(unit(back) + 0.5 * unit(up)))
    traces = [drawn.mesh(rest, "part", _PART)] if rest else []
    for op, colour in zip(originals, colour_map(originals) if originals else (), strict=True):
        turned = [one.face for one in plan.operations if copies.get(one.number) == op.number]
        said = f"{op.number}: face {op.face.label}" + (f" and {len(turned)} turned" if turned else "")
        left = outcome_of([op], plan.blades) == "complete"
        said += "" if op.done else ", left to clean-up" if left else ", no axis"
        traces.append(drawn.mesh([op.face, *turned], said,
                                 _PALE[colour] if op.done else _NO_AXIS))
    obstacles = [face for body in plan.obstacles for face in body.faces]
    if obstacles:
        traces.append(drawn.mesh(obstacles, "obstacles", _OBSTACLE, opacity=0.55))
    edges = [_closed(face.evaluate(loop).point) for face in [*rest, *(op.face for op in plan.operations)]
             for loop in outline_loops(face, _COARSE * size)]
    traces.append(_lines(edges, "edges", "#4C4C4C", 1.5))
    passes, links, apart = _ways(originals, _LINES * size)
    traces += [_lines(passes, "passes", BLUE, 2.0), _lines(links, "links", PURPLE, 1.5, visible="legendonly")]
    traces += _zones([op for op in plan.operations if op.zones], drawn, _COARSE * size)
    traces += _axes([op for op in originals if op.done], (0.22 if len(originals) <= 8 else 0.16) * size)
    traces += [_places(name, found) for name, found in worst.items() if found]
    traces.append(_datum(plan.datum, 0.08 * size))
    made = go.Figure([trace for trace in traces if trace is not None])
    made.update_layout(_layout(unit(back), up, _ranges(made)))
    return PageScene(made, drawn.off, apart)


def _ranges(made: go.Figure) -> Array:
    """Lower and upper ends of everything drawn, (2, 3) mm."""
    ends = [np.array([[pick(trace[name]) for name in "xyz"] for pick in (np.nanmin, np.nanmax)]) for trace in made.data]
    return np.array([np.min([low for low, _ in ends], axis=0), np.max([high for _, high in ends], axis=0)])


def _layout(back: Array, up: Array, ranges: Array) -> dict[str, Any]:
    margin = 0.01 * float(np.linalg.norm(ranges[1] - ranges[0]))
    low, high = ranges[0] - margin, ranges[1] + margin
    sides = {f"{name}axis": {"visible": False, "range": [round(float(a), 3), round(float(b), 3)]}
             for name, a, b in zip("xyz", low, high, strict=True)}
    camera = {"eye": _xyz(1.25 * back), "up": _xyz(up), "projection": {"type": "orthographic"}}
    return {"scene": {**sides, "aspectmode": "manual", "aspectratio": _xyz(_LARGE * unit(high - low)),
                      "dragmode": "turntable", "camera": camera},
            "margin": {"l": 0, "r": 0, "t": 0, "b": 0}, "paper_bgcolor": "white", "template": "none",
            "legend": {"orientation": "h", "y": 0.0, "yanchor": "top", "font": {"size": 12}, "itemsizing": "constant"}}


def _xyz(row: Array) -> dict[str, float]:
    return {name: round(float(value), 4) for name, value in zip("xyz", row, strict=True)}


def _coordinates(points: Array) -> dict[str, Any]:
    rows = np.round(points, _DIGITS).astype(np.float32)
    return {"x": rows[:, 0], "y": rows[:, 1], "z": rows[:, 2]}


class _Meshes:
    """Faces as meshes, and the greatest distance of these from the faces so far."""

    def __init__(self, bound: float, light: Array) -> None:
        self.bound, self.light, self.off = bound, light, 0.0

    def mesh(self, faces: Iterable[Face], name: str, colour: str, lift: float = 0.0, **more: Any) -> go.Mesh3d | None:
        points: list[Array] = []
        corners, first = [], 0
        for face in faces:
            found = triangles(face, self.bound)
            self.off = max(self.off, found.off)
            raised = found.points if lift == 0 else found.points + lift * _raised(face, found.points)
            points.append(raised)
            corners.append(found.corners + first)
            first += len(found.points)
        index = np.concatenate(corners).astype(np.int32)
        if not len(index):
            return None
        return go.Mesh3d(**_coordinates(np.concatenate(points)), i=index[:, 0], j=index[:, 1], k=index[:, 2],
                         name=escape(name), color=colour, showlegend=True, hoverinfo="name", flatshading=False,
                         lighting={"ambient": 0.5, "diffuse": 0.65, "specular": 0.05, "roughness": 0.9},
                         lightposition=_xyz(_LIGHT * self.light), **more)


def _raised(face: Face, points: Array) -> Array:
    """One direction out of the material for all points of a small piece of a face."""
    return np.broadcast_to(mean_direction(face.normal(np.concatenate(face.outline))), points.shape)


def _closed(points: Array) -> Array:
    return np.vstack([points, points[:1]])


def _lines(lines: Sequence[Array], name: str, colour: str, width: float, **more: Any) -> go.Scatter3d | None:
    if not lines:
        return None
    gap = np.full((1, 3), np.nan)
    rows = np.concatenate([part for line in lines for part in (line, gap)])[:-1]
    return go.Scatter3d(**_coordinates(rows), mode="lines", name=name, hoverinfo="skip",
                        line={"color": colour, "width": width}, **more)


def _ways(operations: Sequence[Operation], bound: float) -> tuple[list[Array], list[Array], float]:
    """Contact lines of passes and tips of links, thinned, and the bound of that, mm."""
    paths = [op.path for op in operations if op.path is not None]
    passes = [line for path in paths for line in cutting_lines(path)]
    links = [line for path in paths for line in _linking(path.cl, path.kind)]
    while True:
        shown = [line[simplify_polyline(line, bound)] for line in passes]
        if sum(map(len, shown)) <= _MOST_POINTS:
            break
        bound *= 2
    return shown, [line[simplify_polyline(line, bound)] for line in links], bound


def _linking(tips: Array, kind: NDArray[np.int8]) -> list[Array]:
    away = (kind != Motion.CUT).astype(np.int8)
    starts, ends = np.flatnonzero(np.diff(away, prepend=0) == 1), np.flatnonzero(np.diff(away, append=0) == -1)
    return [tips[max(a - 1, 0):b + 1] for a, b in zip(starts, ends, strict=True) if b >= a and b > 0]


def _zones(operations: Sequence[Operation], drawn: _Meshes, bound: float) -> list[go.Mesh3d | go.Scatter3d | None]:
    faces = [face for op in operations for face in zone_faces(op)]
    loops = [_closed(face.evaluate(loop).point) for face in faces for loop in outline_loops(face, bound)]
    if not faces:
        return []
    fill = drawn.mesh(faces, "left to clean-up", VERMILION, lift=8 * bound, opacity=0.55)
    return [fill, _lines(loops, "borders of clean-up", VERMILION, 3.0, showlegend=False)]


def _axes(operations: Sequence[Operation], length: float) -> list[Any]:
    """An arrow for each axis with the operation's number; pointing at it tells the rest."""
    if not operations:
        return []
    roots = np.array([root_of(op) for op in operations])
    axes = np.array([op.orientation.axis for op in operations], dtype=float)
    heads = roots + length * axes
    said = [_axis_text(op) for op in operations]
    shafts = _lines([np.array(ends) for ends in zip(roots, heads, strict=True)], "axes", "#000000", 4.0,
                    legendgroup="axes")
    tips = {f"{a}": np.round(axes[:, k], 5).astype(np.float32) for k, a in enumerate("uvw")}
    cones = go.Cone(**_coordinates(heads), **tips, anchor="tip", sizemode="raw", sizeref=round(0.2 * length, 4),
                    colorscale=[[0, "#000000"], [1, "#000000"]], showscale=False, name="axes", legendgroup="axes",
                    hoverinfo="skip")
    numbers = go.Scatter3d(**_coordinates(heads + 0.06 * length * axes), mode="markers+text",
                           text=[str(op.number) for op in operations], customdata=said, legendgroup="axes",
                           hovertemplate="%{customdata}<extra></extra>", showlegend=False,
                           textfont={"size": 14, "color": "#000000"}, marker={"size": 5, "color": "#000000"},
                           textposition="top center", name="axes")
    return [shafts, cones, numbers]


def _axis_text(op: Operation) -> str:
    axis = op.orientation.axis
    assert axis is not None
    words = [f"<b>{escape(op.name)}</b>", "axis " + ", ".join(f"{value:+.4f}" for value in np.asarray(axis) + 0.0)]
    if op.orientation.lead is not None:
        words[1] = f"the axis moves, lead {np.degrees(op.orientation.lead):+.2f}°; mean " + words[1]
    words.append(f"{op.orientation.passes} passes, cutting length {op.orientation.length:.1f} mm")
    return "<br>".join(words)


def _places(name: str, found: Sequence[Mapping[str, Any]]) -> go.Scatter3d:
    colour, symbol = (VERMILION, "diamond-open") if "gouge" in name else (ORANGE, "circle-open")
    return go.Scatter3d(**_coordinates(np.array([one["point"] for one in found], dtype=float).reshape(-1, 3)),
                        mode="markers", name=name, text=[escape(str(one["text"])) for one in found],
                        hovertemplate="%{text}<extra></extra>",
                        marker={"size": 7, "color": colour, "symbol": symbol, "line": {"width": 3}})


def _datum(origin: Array, length: float) -> go.Scatter3d:
    rows = np.concatenate([np.array([origin, origin + length * way, [np.nan] * 3]) for way in np.eye(3)])
    return go.Scatter3d(**_coordinates(rows), mode="lines+text", text=["", "X", "", "", "Y", "", "", "Z", ""],
                        line={"color": np.repeat([VERMILION, GREEN, SKY], 3).tolist(), "width": 5},
                        name="part's frame at the datum", hoverinfo="skip", textfont={"size": 13})
