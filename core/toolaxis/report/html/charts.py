"""Figures of one operation and of the tool for a page: hemisphere, maps, strip width, feed, times, outline of the tool.

A chart is a plotly figure and, where it has pictures of cells, these as indices into a table: the page unfolds them.
"""

from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from html import escape
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import ArrayLike, NDArray

from toolaxis.numeric.equal_area import equal_area, from_equal_area
from toolaxis.numeric.vectors import angle_between, perpendicular, unit
from toolaxis.plan.operation import Operation
from toolaxis.plan.orientation import REASONS, AxisMap
from toolaxis.report.figures.plots import BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION
from toolaxis.report.figures.splat_renderer import tool_outlines
from toolaxis.tools.tool import Tool
from toolaxis.verify.axis_view import RestMaterialView

Array = NDArray[np.float64]

#: Cells of the hemisphere's picture each way.
_SIZE = 121
_GREYS = ("#ffffff", "#f4f4f4", "#e3e3e3", "#cfcfcf", "#b5b5b5", "#8f8f8f", "#6e6e6e", "#4c4c4c")
#: Reasons whose amount is an angle, by their codes; the others' is a length.
_ANGLES = (1, 2, 3)
_MARKS = {"chosen": ("star", VERMILION, 17), "other lobes": ("diamond", "#ffffff", 10),
          "mean normal": ("cross", BLUE, 11)}
#: Levels of a map: up to 1.5 times the limit evenly, then up to the greatest value by equal ratios.
_EVEN, _RATIOS = 180, 72
#: What the judge lets pass, as a factor of the limit, and the colours of a map from nothing up to that.
SLACK = 1.02
SCALE = ("#00224E", "#2A3F6D", "#575D6D", "#7D7C78", "#A59C74", "#D2C060", "#FDEA45")
_TITLE = {"font": {"size": 15}, "x": 0.0, "xanchor": "left", "xref": "container", "pad": {"l": 8}}
_TOOL = {"cutter": "#F5CC59", "shank": "#BFBFC7", "holder": "#8C94A3", "shank (not given)": "#E2E2E6"}


@dataclass(frozen=True, eq=False)
class PageFigure:
    """A figure for the page.

    Attributes
    ----------
    figure : plotly Figure, or the mapping that it would be written as
    cells : tuple of dict
        For traces that are pictures: "traces" (their numbers), "shape", "index" (base64 of unsigned little-endian
        numbers), "bytes" (of each), "values" (one table for each trace) and "texts" (what the pointer reads; None where
        that is the value).
    """

    figure: go.Figure | dict[str, Any]
    cells: tuple[dict[str, Any], ...] = field(default=())


def _plain(figure: go.Figure, **more: Any) -> go.Figure:
    figure.update_layout({
        "template": "none",
        "margin": {"l": 60, "r": 20, "t": 40, "b": 50},
        "font": {"size": 13},
        "legend": {"orientation": "h", "y": -0.16, "yanchor": "top"},
        "hoverlabel": {"align": "left"},
        **more,
    })
    return figure


@cache
def _plain_layout() -> dict[str, Any]:
    """The layout of `_plain` as a mapping: where there are hundreds of figures, plotly's own take too long."""
    found: dict[str, Any] = _plain(go.Figure()).to_plotly_json()["layout"]
    return found


def _cells(index: NDArray[Any], traces: Sequence[int], values: Sequence[Sequence[float | None]],
           texts: Sequence[str] | None = None) -> dict[str, Any]:
    size = 1 if len(values[0]) <= 256 else 2
    packed = np.ascontiguousarray(index, dtype=f"<u{size}").tobytes()
    return {
        "traces": list(traces),
        "shape": list(index.shape),
        "index": b64encode(packed).decode("ascii"),
        "bytes": size,
        "values": [list(row) for row in values],
        "texts": None if texts is None else list(texts),
    }


def hemisphere_chart(found: AxisMap, area: float, pole: ArrayLike, marks: Mapping[str, ArrayLike],
                     name: str) -> PageFigure:
    """All axes that were looked at on an equal-area map, each standing for the directions nearest to it.

    Under the pointer: the axis, and its strip width or the reason why it is forbidden, and by how much.

    Parameters
    ----------
    found : AxisMap
    area : float
        Area of the face, mm^2: strip width is area over cutting length.
    pole : (3,) array_like
        Mean normal; the map's centre.
    marks : mapping of str to (3,) or (n, 3) array_like
        "chosen", "other lobes", "mean normal".
    name : str
    """
    from scipy.spatial import cKDTree

    centre = unit(np.asarray(pole, dtype=float))
    right = perpendicular(centre)[0]
    line = np.linspace(-1.0, 1.0, _SIZE)
    flat = np.stack([grid.ravel() for grid in np.meshgrid(line, line)], axis=1)
    _, nearest = cKDTree(found.axis).query(from_equal_area(flat, centre, right))
    free = found.reason == 0
    width = np.where(free, area / np.where(free & (found.length > 0), found.length, np.inf), np.nan)
    texts = [_axis_text(found, k, float(width[k]), centre) for k in range(len(found.axis))]
    none = len(texts)
    index = np.where((flat**2).sum(axis=1) <= 1.0, nearest, none).reshape(_SIZE, _SIZE)
    forbidden = [None if ok else int(code) for ok, code in zip(free, found.reason, strict=True)]
    widths = [round(float(value), 4) if ok else None for ok, value in zip(free, width, strict=True)]
    made = go.Figure()
    _add_hemisphere(made, width, bool(free.any()))
    for code in sorted({int(code) for code in found.reason if code > 0}):
        marker = {"size": 12, "symbol": "square", "color": _GREYS[code], "line": {"width": 1}}
        made.add_scatter(x=[None], y=[None], mode="markers", name=REASONS[code], marker=marker)
    for label, axes in marks.items():
        x, y = np.round(equal_area(axes, centre, right), 4).T
        symbol, colour, size = _MARKS[label]
        marker = {"symbol": symbol, "color": colour, "size": size, "line": {"width": 1.5, "color": "#000000"}}
        made.add_scatter(x=x, y=y, mode="markers", name=label, hoverinfo="skip", marker=marker)
    axis = {"visible": False, "range": [-1.04, 1.04]}
    _plain(made, title={"text": f"{escape(name)}: {none} axes looked at, around the mean normal", **_TITLE},
           shapes=[_ring(angle) for angle in (30, 60, 90)], xaxis=axis, yaxis={**axis, "scaleanchor": "x"},
           height=560, margin={"l": 10, "r": 10, "t": 40, "b": 10},
           legend={"orientation": "h", "y": -0.02, "yanchor": "top"})
    return PageFigure(made, (_cells(index, (0, 1), ([*forbidden, None], [*widths, None]), [*texts, ""]),))


def _add_hemisphere(made: go.Figure, width: Array, any_free: bool) -> None:
    """The pictures of forbidden axes, by their reasons, and of free ones, by their strip widths; without cells."""
    place = {"x0": -1.0, "dx": 2.0 / (_SIZE - 1), "y0": -1.0, "dy": 2.0 / (_SIZE - 1)}
    greys = [[share, colour] for k, colour in enumerate(_GREYS) for share in (k / 8, (k + 1) / 8)]
    made.add_heatmap(**place, zmin=-0.5, zmax=7.5, colorscale=greys, showscale=False,
                     hovertemplate="%{text}<extra></extra>", name="forbidden")
    low, high = (np.nanpercentile(width, 3), np.nanmax(width)) if any_free else (0.0, 1.0)
    bar = {"title": {"text": "strip width, mm", "side": "right"}, "thickness": 14}
    made.add_heatmap(**place, zmin=round(float(low), 5), zmax=round(float(high), 5), colorscale="Viridis",
                     showscale=any_free, hovertemplate="%{text}<extra></extra>", name="free", colorbar=bar)


def _ring(angle: float) -> dict[str, Any]:
    """The circle of directions at an angle, degrees, from the map's centre; the border is drawn through."""
    radius = np.sqrt(2) * np.sin(np.radians(angle) / 2)
    line = {"width": 1, "dash": "dot" if angle < 90 else "solid"}
    return {"type": "circle", "x0": -radius, "y0": -radius, "x1": radius, "y1": radius, "line": line}


def _axis_text(found: AxisMap, k: int, width: float, pole: Array) -> str:
    """What the pointer reads of an axis."""
    axis = found.axis[k]
    code = int(found.reason[k])
    if code == 0:
        verdict = f"strip width {width:.3f} mm"
    else:
        verdict = f"forbidden: {REASONS[code]}{_amount_text(code, float(found.amount[k]))}"
    numbers = ", ".join(f"{value:+.4f}" for value in axis + 0.0)
    away = float(np.degrees(angle_between(axis[None], pole)[0]))
    return f"<b>{verdict}</b><br>axis {numbers}<br>{away:.1f}° from the mean normal"


def _amount_text(code: int, amount: float) -> str:
    """By how much an axis breaks a limit, where that is known."""
    if not np.isfinite(amount) or amount <= 0:
        return ""
    return f" by {np.degrees(amount):.2f}°" if code in _ANGLES else f" by {amount:.3g} mm"


def map_chart(view: RestMaterialView, what: str, limit: float, name: str) -> PageFigure:
    """Scallop height left or depth of gouges, seen along the axis, in the work coordinate system.

    Parameters
    ----------
    view : RestMaterialView
    what : str
        "scallop" or "gouge".
    limit : float
        Allowed height or depth, mm.
    name : str
    """
    cells = view.scallop if what == "scallop" else view.gouge
    finite = cells[np.isfinite(cells)]
    most = float(finite.max()) if finite.size else 0.0
    levels = _levels(limit, most)
    index = np.searchsorted(levels, np.where(np.isfinite(cells), cells, 0.0), side="left")
    not_reached = len(levels)
    nothing = len(levels) + 1
    index = np.where(np.isposinf(cells), not_reached, np.where(np.isnan(cells), nothing, index))
    values = [round(1000 * float(level), 3) for level in levels]
    x0, y0 = (round(float(corner + 0.5 * view.cell), 4) for corner in view.corner[:2])
    side = round(view.cell, 6)
    place = {"x0": x0, "dx": side, "y0": y0, "dy": side}
    label = "scallop left" if what == "scallop" else "gouge"
    said = f"<b>{label} at most %{{z:.3g}} µm</b><br>X %{{x:.2f}}, Y %{{y:.2f}} mm<extra></extra>"
    traces = [{"type": "heatmap", **place, "zmin": 0.0, "zmax": round(1200 * limit, 6), "colorscale": _scale(),
               "name": label, "hovertemplate": said,
               "colorbar": {"title": {"text": "µm", "side": "right"}, "thickness": 14}},
              {"type": "heatmap", **place, "zmin": 0, "zmax": 1, "colorscale": [[0, GREY], [1, GREY]],
               "showscale": False, "name": "not reached",
               "hovertemplate": "<b>not reached</b><br>X %{x:.2f}, Y %{y:.2f} mm<extra></extra>"}]
    greatest = f"greatest {1000 * most:.2f} µm" if finite.size else "nothing was reached"
    lost = bool(np.isposinf(cells).any())
    title = f"{escape(name)}: {label}, {greatest}, allowed {1000 * limit:g} µm"
    title += "; grey: not reached" if lost else ""
    layout = {**_plain_layout(), "title": {"text": title, **_TITLE}, "height": 520,
              "xaxis": {"title": {"text": "X of the work coordinate system, mm"}, "constrain": "domain"},
              "yaxis": {"title": {"text": "Y, mm"}, "scaleanchor": "x", "constrain": "domain"}}
    none: list[float | None] = [None] * len(values)
    tables = ([*values, None, None], [*none, 1, None])
    return PageFigure({"data": traces, "layout": layout}, (_cells(index, (0, 1), tables),))


def _levels(limit: float, most: float) -> Array:
    """Levels of a map: evenly up to 1.5 times the limit, then by equal ratios up to the greatest value."""
    even = np.linspace(0.0, 1.5 * limit, _EVEN)
    last = even[-1]
    if most <= last:
        return even
    shares = np.arange(1, _RATIOS + 1) / _RATIOS
    levels = np.concatenate([even, last * (most / last) ** shares])
    levels[-1] = most  # without rounding: no cell lies above
    return levels


def _scale() -> list[list[Any]]:
    """Colours up to the limit, then one that says that it is exceeded; up to 1.2 times the limit in all."""
    edge = round(SLACK / 1.2, 5)
    return [*([round(edge * k / 6, 5), tone] for k, tone in enumerate(SCALE)), [edge, VERMILION], [1.0, VERMILION]]


def widths_chart(lines: Sequence[tuple[Array, Array]], frame: tuple[Array, Array], origin: Array,
                 name: str) -> PageFigure:
    """Strip width along the passes, seen along the axis.

    Parameters
    ----------
    lines : sequence of ((n, 3) array, (n,) array)
        Contact points, mm, and strip width there, mm.
    frame : pair of (3,) arrays
        X and Y of the work coordinate system.
    origin : (3,) array
        Its origin, mm.
    name : str
    """
    plane = np.stack(frame, axis=1)
    points = np.concatenate([line for line, _ in lines])
    flat = np.round((points - origin) @ plane, 3).astype(np.float32)
    width = np.round(np.concatenate([width for _, width in lines]), 4)
    along = np.concatenate([_way_along(line) for line, _ in lines])
    number = np.repeat(np.arange(1, len(lines) + 1), [len(line) for line, _ in lines])
    places = np.stack([number, np.round(along, 2)], axis=1).astype(np.float32)
    bar = {"title": {"text": "mm", "side": "right"}, "thickness": 14}
    marker = {"size": 5, "color": width.astype(np.float32), "colorscale": "Viridis", "colorbar": bar}
    words = ("<b>strip width %{marker.color:.3f} mm</b><br>pass %{customdata[0]}, "
             "%{customdata[1]:.1f} mm along<extra></extra>")
    made = go.Figure()
    made.add_scatter(x=flat[:, 0], y=flat[:, 1], mode="markers", name="strip width", customdata=places,
                     marker=marker, hovertemplate=words)
    _plain(made, title={"text": f"{escape(name)}: strip width {width.min():.3f} to {width.max():.3f} mm",
                        **_TITLE}, height=520,
           xaxis={"title": {"text": "X of the work coordinate system, mm"}, "constrain": "domain"},
           yaxis={"title": {"text": "Y, mm"}, "scaleanchor": "x", "constrain": "domain"})
    return PageFigure(made)


def _way_along(line: Array) -> Array:
    """Way along a polyline to each of its points, (n,) mm."""
    chords = np.linalg.norm(np.diff(line, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(chords)])


def feed_chart(places: Array, speeds: Array, programmed: float, name: str) -> PageFigure:
    """The feed along one pass.

    Parameters
    ----------
    places : (n,) array
        Way along the pass, mm.
    speeds : (n,) array
        mm/min
    programmed : float
        mm/min
    name : str
    """
    made = go.Figure()
    made.add_scatter(x=np.round(places, 3).astype(np.float32), y=np.round(speeds, 2).astype(np.float32), mode="lines",
                     line={"color": BLUE, "width": 2}, name="feed", hovertemplate="%{y:.0f} mm/min at %{x:.1f} mm")
    made.add_hline(y=programmed, line={"color": "#000000", "width": 1, "dash": "dot"}, annotation_text="programmed")
    _plain(made, title={"text": f"{escape(name)}: feed along the longest pass", **_TITLE}, height=340,
           xaxis={"title": {"text": "way along the pass, mm"}, "zeroline": False}, showlegend=False,
           yaxis={"title": {"text": "mm/min"}, "rangemode": "tozero"})
    return PageFigure(made)


def times_chart(operations: Sequence[Operation], seconds: Sequence[Mapping[str, float]]) -> PageFigure:
    """Where the time of each operation goes.

    Parameters
    ----------
    operations : sequence of Operation
    seconds : sequence of mappings
        One per operation: s by kind of motion.
    """
    made = go.Figure()
    names = [escape(op.name) for op in operations]
    colours = {"cut": BLUE, "entry and exit": SKY, "link": PURPLE, "index": ORANGE}
    for kind, colour in colours.items():
        made.add_bar(y=names, x=[round(one[kind], 2) for one in seconds], orientation="h", name=kind,
                     marker={"color": colour}, hovertemplate="%{y}: " + kind + " %{x:.1f} s<extra></extra>")
    _plain(made, barmode="stack", height=130 + 26 * len(names),
           xaxis={"title": {"text": "s"}}, yaxis={"autorange": "reversed", "automargin": True},
           legend={"orientation": "h", "y": 1.0, "yanchor": "bottom", "traceorder": "normal"})
    return PageFigure(made)


def tool_chart(tool: Tool) -> PageFigure:
    """Cutter, shank and holder in section, to scale, with their sizes.

    Parameters
    ----------
    tool : Tool
    """
    outlines = tool_outlines(tool, 8 * tool.radius)
    made = go.Figure()
    top = max(float(line[:, 1].max()) for line in outlines.values())
    wide = max(float(line[:, 0].max()) for line in outlines.values())
    for name, line in outlines.items():
        both = np.round(np.concatenate([line, line[::-1] * [-1.0, 1.0]]), 4)
        made.add_scatter(x=both[:, 0], y=both[:, 1], fill="toself", fillcolor=_TOOL[name], mode="lines", name=name,
                         line={"color": "#444444", "width": 1, "dash": "dot" if "not given" in name else "solid"},
                         hoverinfo="name")
    made.add_scatter(x=[0, 0], y=[-0.04 * top, 1.04 * top], mode="lines", hoverinfo="skip", showlegend=False,
                     line={"color": "#000000", "width": 1, "dash": "dashdot"})
    for k, (text, low, high) in enumerate(_heights(tool, outlines)):
        x = wide + 0.04 * top + 0.09 * top * k
        made.add_scatter(x=[x, x], y=[low, high], mode="lines+markers", hoverinfo="skip", showlegend=False,
                         line={"color": GREEN, "width": 1},
                         marker={"symbol": "line-ew-open", "size": 9, "color": GREEN})
        made.add_annotation(x=x, y=0.5 * (low + high), text=text, showarrow=False, textangle=-90, xshift=9,
                            font={"size": 12})
    _plain(made, height=560, title={"text": f"{escape(tool.name)}: {_sizes(tool)}", **_TITLE},
           xaxis={"title": {"text": "radius, mm"}, "constrain": "domain", "zeroline": False},
           yaxis={"title": {"text": "height above the tip, mm"}, "scaleanchor": "x", "constrain": "domain"})
    return PageFigure(made)


def _heights(tool: Tool, outlines: Mapping[str, Array]) -> list[tuple[str, float, float]]:
    found = [(f"cutting edge {tool.flute_length:g} mm", 0.0, float(tool.flute_length))]
    if tool.stickout is not None:
        found.append((f"stick-out {tool.stickout:g} mm", 0.0, float(tool.stickout)))
    if "holder" in outlines:
        found.append((f"gauge length {tool.gauge_length:g} mm", 0.0, float(outlines["holder"][:, 1].max())))
    return found


def _sizes(tool: Tool) -> str:
    words = [f"⌀ {2 * tool.radius:g} mm"]
    if tool.corner_radius:
        words.append(f"corner radius {tool.corner_radius:g} mm")
    if tool.half_angle:
        words.append(f"half angle {np.degrees(tool.half_angle):g}°")
    return ", ".join(words)
