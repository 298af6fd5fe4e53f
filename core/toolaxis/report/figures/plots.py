"""Pictures: part with passes and tool, strip widths, estimate and count against passes, maps of the judge."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from toolaxis.cldata.toolpath import Motion, ToolPath
from toolaxis.plan.operation import Operation
from toolaxis.plan.plan import Plan, describe_feed
from toolaxis.report.figures.hatch_fill import hatch, hatch_patch, zone_faces
from toolaxis.report.figures.splat_renderer import (
    Camera,
    Canvas,
    camera,
    camera_onto,
    face_splats,
    mean_direction,
    points_on,
    splats_of_revolution,
    tool_outlines,
    visible_runs,
)
from toolaxis.shape.face import Face
from toolaxis.shape.joining.joined_surface import joins
from toolaxis.skin.view_surface import ViewSurface
from toolaxis.tools.tool import Tool
from toolaxis.verify.maps import SurfaceMap

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Colours that stay apart for colour-blind eyes (Okabe and Ito).
BLUE, SKY, GREEN, ORANGE, VERMILION, PURPLE, GREY = (
    "#0072B2", "#56B4E9", "#009E73", "#E69F00", "#D55E00", "#CC79A7", "#8C8C8C")
_FACE, _PART, _CUTTER, _SHANK, _HOLDER = (
    (0.80, 0.89, 0.96), (0.84, 0.84, 0.84), (0.96, 0.80, 0.35), (0.75, 0.75, 0.78), (0.55, 0.58, 0.64))
#: Pixels an inch of all pictures.
DPI = 110
#: What lies in clean-up zones on maps of the judge.
_ASIDE = "#e8e8e8"


def figure(width: float, height: float, *, laid_out: bool = True) -> Figure:
    """An empty figure that needs no display.

    Parameters
    ----------
    width, height : float
        Inches.
    laid_out : bool
        Whether places are found for what is in it, which takes as long as drawing it; else each part is given its own.
    """
    made = Figure(figsize=(width, height), dpi=DPI, layout="constrained" if laid_out else None)
    FigureCanvasAgg(made)
    return made


def bare(ax: Axes) -> None:
    """Lengths to scale, no frame; the axes keep their place, so that what is laid out around them does.

    Parameters
    ----------
    ax : Axes
    """
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_axis_off()


def operation_picture(plan: Plan, op: Operation) -> Figure:
    """The part with the passes of an operation, and the same with tool, holder and axis.

    Parameters
    ----------
    plan : Plan
    op : Operation
        With a path.
    """
    assert op.path is not None and op.frame is not None
    made = figure(12.5, 6.2)
    close, whole = made.subplots(1, 2, width_ratios=(1.25, 1.0))
    axis = op.frame.z
    normal = mean_direction(op.face.normal(op.face.places_on(16)))
    back = normal + 0.55 * op.frame.x - 0.75 * op.frame.y
    _close_up(close, op, (back, axis))
    _with_tool(whole, plan, op, (np.cross(axis, np.cross(normal + 0.4 * op.frame.x - 0.9 * op.frame.y, axis))
                                 + 0.35 * axis, axis))
    along = describe_feed(op.orientation)
    close.set_title(f"{op.name}: {op.orientation.passes} passes along {along}, "
                    f"cutting length {op.orientation.length:.0f} mm", fontsize=10)
    lead, shown = op.orientation.lead, ", ".join(f"{value:+.3f}" for value in axis)
    said = f"axis ({shown})" if lead is None else f"the axis moves, lead {np.degrees(lead):+.2f} deg"
    whole.set_title(f"{op.tool.name}, {said}", fontsize=10)
    return made


def _close_up(ax: Axes, op: Operation, view: tuple[Array, Array]) -> None:
    assert op.path is not None
    cut = op.path.cc[op.path.kind == Motion.CUT]
    canvas = Canvas(camera(view[0], view[1], np.concatenate([points_on([op.face]), cut])))
    canvas.splat(*face_splats(op.face, canvas.camera), _FACE)
    canvas.close()
    hatch(canvas, zone_faces(op), 0.01 * op.face.diagonal)
    ax.imshow(canvas.colour, origin="lower", extent=canvas.camera.extent, interpolation="nearest")
    slack = 0.01 * op.face.diagonal + 4 * canvas.camera.pixel
    _draw_cuts(ax, canvas, op.path, slack)
    further: list[Artist] = [hatch_patch()] if op.zones else []
    if op.face.members:
        _draw_joins(ax, canvas, op.face, slack)
        further.append(Line2D([], [], color=VERMILION, linestyle="--", label="join of faces"))
    _legend(ax, {"face": _FACE}, {"contact line": BLUE, "beyond the border": SKY}, further)
    scale_bar(ax, canvas.camera)
    bare(ax)


def _draw_joins(ax: Axes, canvas: Canvas, face: Face, slack: float) -> None:
    """Lines along which the faces meet that were joined to this one."""
    runs: list[Array] = []
    if isinstance(face.surface, ViewSurface):
        for line in face.surface.joins:
            runs += visible_runs(canvas, face.evaluate(line).point, slack)
    for axis, t in joins(face):
        low, high = face.bounds[2 - 2 * axis:4 - 2 * axis]
        uv = np.full((400, 2), t)
        uv[:, 1 - axis] = np.linspace(low, high, 400)
        on = np.flatnonzero(~face.contains(uv))
        for some in np.split(uv, on):
            line = some[face.contains(some)]
            if len(line) > 1:
                runs += visible_runs(canvas, face.evaluate(line).point, slack)
    ax.add_collection(LineCollection(runs, colors=VERMILION, linewidths=1.0, linestyles="--"))


def _draw_cuts(ax: Axes, canvas: Canvas, path: ToolPath, slack: float) -> None:
    """Contact lines; those that run out beyond the face in a lighter colour."""
    for inside, colour, width in ((False, SKY, 0.7), (True, BLUE, 0.8)):
        runs: list[Array] = []
        for line in cutting_lines(path):
            for run in visible_runs(canvas, line, slack):
                runs += _over(canvas, run, inside)
        ax.add_collection(LineCollection(runs, colors=colour, linewidths=width))


def _over(canvas: Canvas, run: Array, inside: bool) -> list[Array]:
    """The parts of a line in picture coordinates that lie over something drawn, or over nothing."""
    is_kept = np.isfinite(canvas.depth_at(run)) == inside
    cuts = np.flatnonzero(np.diff(is_kept)) + 1
    return [part for part, kept in zip(np.split(run, cuts), np.split(is_kept, cuts), strict=True)
            if kept[0] and len(part) > 1]


def cutting_lines(path: ToolPath) -> list[Array]:
    """Contact points of every uninterrupted cutting motion, each (m, 3), the one at which it begins included.

    Places whose contact was not found again in a file, where the tip stands in its place, are left out.

    Parameters
    ----------
    path : ToolPath
    """
    is_cut = path.kind == Motion.CUT
    is_cut_before = np.concatenate([[False], is_cut[:-1]])
    is_cut_after = np.concatenate([is_cut[1:], [False]])
    starts = np.flatnonzero(is_cut & ~is_cut_before)
    ends = np.flatnonzero(is_cut & ~is_cut_after)
    is_known = (path.cc != path.cl).any(axis=1)
    lines = []
    for start, end in zip(starts, ends, strict=True):
        rows = slice(max(start - 1, 0), end + 1)
        line, known = path.cc[rows], is_known[rows]
        lines.append(line[known] if known.any() else line)
    return lines


def _with_tool(ax: Axes, plan: Plan, op: Operation, view: tuple[Array, Array]) -> None:
    assert op.path is not None and op.frame is not None
    tip, axis = standing(op.path)
    outlines = tool_outlines(op.tool, 8 * op.tool.radius)
    ends = np.array([tip + z * axis + r * side for line in outlines.values() for r, z in line
                     for side in (op.frame.x, -op.frame.x, op.frame.y, -op.frame.y)])
    corners = points_on(plan.part.faces)
    length = 1.12 * float(np.max((ends - tip) @ axis))
    seen = camera(view[0], view[1], np.concatenate([ends, corners, [tip + length * axis]]))
    canvas, tool = Canvas(seen), Canvas(seen)
    for face in plan.part.faces:
        if face.number != op.face.number or op.face.label != face.label:
            canvas.splat(*face_splats(face, seen), _PART)
    points, directions = face_splats(op.face, seen)
    canvas.splat(points + 4 * seen.pixel * seen.back, directions, _FACE)  # in front of the face that it is a piece of
    colours = {"cutter": _CUTTER, "shank": _SHANK, "holder": _HOLDER, "shank (not given)": _SHANK}
    for name, line in outlines.items():
        tool.splat(*splats_of_revolution(line, tip, axis, seen.pixel), colours[name])
    canvas.close()
    tool.close()
    hidden = canvas.depth.copy()
    canvas.blend(tool, 0.82)
    ax.imshow(canvas.colour, origin="lower", extent=seen.extent, interpolation="nearest")
    canvas.depth = np.maximum(hidden, tool.depth)
    slack = 0.01 * op.face.diagonal + 4 * seen.pixel
    runs = [run for line in cutting_lines(op.path) for run in visible_runs(canvas, line, slack)]
    ax.add_collection(LineCollection(runs, colors=BLUE, linewidths=0.35))
    line = seen.project(np.array([tip, tip + length * axis]))[:, :2]
    ax.annotate("", line[1], line[0], arrowprops={"arrowstyle": "-|>", "color": "black", "linewidth": 1.0})
    ax.annotate("T", line[1], textcoords="offset points", xytext=(6, -2), fontsize=11, style="italic")
    _legend(ax, {"machined face": _FACE, "part": _PART, **{name: colours[name] for name in outlines}},
            {"contact line": BLUE})
    scale_bar(ax, seen)
    bare(ax)


def standing(path: ToolPath) -> tuple[Array, Array]:
    """A tip on a pass to show the tool at, about a third along the middle pass, and the axis there, (3,) each.

    Parameters
    ----------
    path : ToolPath
    """
    cutting = np.flatnonzero(path.kind == Motion.CUT)
    k = cutting[int(0.47 * (len(cutting) - 1))]
    return path.cl[k], path.axis[k]


def _legend(ax: Axes, areas: Mapping[str, tuple[float, float, float]], lines: Mapping[str, str],
            further: Sequence[Artist] = ()) -> None:
    handles: list[Artist] = [Patch(facecolor=colour, edgecolor="#555555", linewidth=0.5, label=name)
                             for name, colour in areas.items()]
    handles += [Line2D([], [], color=colour, label=name) for name, colour in lines.items()]
    handles += further
    ax.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=3, fontsize=8, frameon=False)


def scale_bar(ax: Axes, seen: Camera) -> None:
    """Draw a scale bar in the lower left corner.

    Parameters
    ----------
    ax : Axes
    seen : Camera
    """
    left, right, low, high = seen.extent
    rough = (right - left) / 5
    decade = 10.0 ** np.floor(np.log10(rough))
    length = decade * max(f for f in (1, 2, 5) if f * decade <= rough)
    x, y = left + 0.03 * (right - left), low + 0.02 * (high - low)
    ax.plot([x, x + length], [y, y], color="black", linewidth=2, solid_capstyle="butt")
    ax.text(x + length / 2, y + 0.012 * (high - low), f"{length:g} mm", ha="center", va="bottom", fontsize=8)


def map_picture(maps: Sequence[SurfaceMap], limit: float, gouge: float, name: str) -> Figure:
    """Scallop height left and gouge depth over the faces that were judged, seen along their mean normal.

    Parameters
    ----------
    maps : sequence of SurfaceMap
    limit, gouge : float
        Allowed scallop height and gouge depth, mm.
    name : str
    """
    made = figure(12.5, 5.8, laid_out=False)  # a plan has hundreds of these, and all look alike
    scallop = np.concatenate([one.remaining for one in maps])
    depth = np.concatenate([one.gouge for one in maps])
    seen = _SeenPlaces.of(maps)
    aside = seen.show(np.concatenate([one.declared for one in maps]).astype(float)) > 0
    left, right = made.add_axes((0.02, 0.1, 0.38, 0.82)), made.add_axes((0.52, 0.1, 0.38, 0.82))
    _map_panel(left, (seen, seen.show(1000 * scallop), aside), ("scallop left, µm", 1000 * limit, "viridis"))
    _map_panel(right, (seen, seen.show(1000 * depth), np.zeros_like(aside)), ("gouge, µm", 1000 * gouge, "Blues"))
    left.set_title(f"{name}\nscallop left, limit {1000 * limit:g} µm", fontsize=10)
    deepest = 1000 * float(depth.max())
    right.set_title(f"{name}\ngouge in the face, greatest {deepest:.2f} µm, allowed {1000 * gouge:g} µm", fontsize=10)
    return made


class _SeenPlaces(NamedTuple):
    """Which judged place each pixel of a map shows.

    camera : Camera
    place : (rows, columns) array of int, among the places of all maps; -1 where there is none
    """

    camera: Camera
    place: NDArray[np.intp]

    @staticmethod
    def of(maps: Sequence[SurfaceMap]) -> "_SeenPlaces":
        """The places of maps, seen along the mean of their normals."""
        from scipy.spatial import cKDTree

        points = np.concatenate([one.point for one in maps])
        normals = np.concatenate([one.face.normal(one.uv) for one in maps])
        seen = camera_onto(normals, points, pixels=700)
        facing = np.flatnonzero(normals @ seen.back > 0)
        x, y = _pixel_centres(seen)
        grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        reach = 1.5 * max(one.spacing for one in maps) + seen.pixel
        _, nearest = cKDTree(seen.project(points[facing])[:, :2]).query(grid, distance_upper_bound=reach)
        return _SeenPlaces(seen, np.append(facing, -1)[nearest].reshape(seen.shape))

    def show(self, values: Array) -> Array:
        """The values of the places, (rows, columns), NaN where no place is."""
        return np.asarray(np.append(values, np.nan)[self.place])


def _pixel_centres(seen: Camera) -> tuple[Array, Array]:
    """Where the columns and rows of a picture are, mm."""
    rows, columns = seen.shape
    x = seen.low[0] + (np.arange(columns) + 0.5) * seen.pixel
    y = seen.low[1] + (np.arange(rows) + 0.5) * seen.pixel
    return x, y


def _map_panel(ax: Axes, data: tuple[_SeenPlaces, Array, Bools], scale: tuple[str, float, str]) -> None:
    """One map, its scale to the right of it; what lies aside is hatched, whatever is left there."""
    seen, picture, aside = data
    label, limit, colours = scale
    x, y = _pixel_centres(seen.camera)
    finite = np.where(np.isfinite(picture) & ~aside, picture, np.nan)
    image = ax.imshow(finite, origin="lower", extent=seen.camera.extent, interpolation="nearest",
                      cmap=colormaps[colours].with_extremes(over=VERMILION), norm=Normalize(0.0, 1.1 * limit))
    lost = np.isinf(picture) & ~aside
    if lost.any():
        ax.contourf(x, y, lost.astype(float), levels=[0.5, 1.5], colors=[GREY])
    made, beside = ax.figure, ax.get_position().x1
    bar = made.colorbar(image, cax=made.add_axes((beside + 0.015, 0.16, 0.018, 0.7)), extend="max")
    bar.set_label(label)
    bar.ax.axhline(limit, color="black", linewidth=1)
    handles = [Patch(facecolor=VERMILION, label="above 1.1 times the limit")]
    handles += [Patch(facecolor=GREY, label="not reached")] if lost.any() else []
    if aside.any():
        drawn = ax.contourf(x, y, aside.astype(float), levels=[0.5, 1.5], colors=[_ASIDE], hatches=["////"])
        drawn.set_edgecolor("#777777")
        drawn.set_linewidth(0.0)
        handles.append(Patch(facecolor=_ASIDE, edgecolor="#777777", linewidth=0.0, hatch="////",
                             label="rest material: not asked for"))
    ax.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=3, fontsize=8, frameon=False)
    scale_bar(ax, seen.camera)
    bare(ax)


@dataclass(frozen=True, eq=False)
class WidthStudy:
    """Average strip widths of axes that turn in one plane.

    Attributes
    ----------
    angle : (n,) array
        From the mean normal, rad.
    estimate, count, made : (n,) array
        One over the estimated, counted and made number of passes (less the unused share of the last).
    chosen : float
        Angle of the chosen axis, rad.
    """

    angle: Array
    estimate: Array
    count: Array
    made: Array
    chosen: float


def study_picture(study: WidthStudy, name: str) -> Figure:
    """Estimate and count against the passes really made, over the angle of the axis; [zhu2016] Fig. 16.

    Parameters
    ----------
    study : WidthStudy
    name : str
    """
    made = figure(8.5, 5.5)
    above, below = made.subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
    degrees = np.degrees(study.angle)
    above.plot(degrees, study.made, "o", color="black", markersize=5, fillstyle="none", label="passes made")
    above.plot(degrees, study.count, "-", color=BLUE, label="count")
    above.plot(degrees, study.estimate, "--", color=VERMILION, label="estimate")
    for ax in (above, below):
        ax.axvline(np.degrees(study.chosen), color=GREY, linewidth=0.8, linestyle=":")
        ax.grid(alpha=0.25)
    above.set_ylabel("average strip width, 1 / passes")
    above.set_title(f"{name}: estimate and count against the passes made", fontsize=10)
    above.legend(frameon=False, fontsize=9)
    below.plot(degrees, 100 * (study.count / study.made - 1), "-", color=BLUE)
    below.plot(degrees, 100 * (study.estimate / study.made - 1), "--", color=VERMILION)
    below.set_xlabel("angle between the axis and the mean normal, degrees (dotted: the chosen axis)")
    below.set_ylabel("error, %")
    return made


def widths_picture(lines: Sequence[tuple[Array, Array]], area: tuple[Face, Tool], name: str) -> Figure:
    """Strip width along every pass; [zhu2016] Fig. 19.

    Parameters
    ----------
    lines : sequence of ((m, 3), (m,))
        Contacts of a pass and the strip width there, mm.
    area : (Face, Tool)
    name : str
    """
    face, tool = area
    made = figure(12.5, 5.6)
    plan, graph = made.subplots(1, 2, width_ratios=(1.15, 1.0))
    seen = camera_onto(face.normal(face.places_on(16)), np.concatenate([contact for contact, _ in lines]))
    every = np.concatenate([width for _, width in lines])
    norm = Normalize(float(np.nanmin(every)), float(np.nanpercentile(every, 99)))
    image = None
    for contact, width in lines:
        flat = seen.project(contact)[:, :2]
        pieces = np.stack([flat[:-1], flat[1:]], axis=1)
        image = plan.add_collection(LineCollection(list(pieces), array=(width[:-1] + width[1:]) / 2, cmap="viridis",
                                                   norm=norm, linewidths=2.2))
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(contact, axis=0), axis=1))])
        graph.plot(along, width, color=BLUE, linewidth=0.6, alpha=0.6)
    plan.autoscale_view()
    if image is not None:
        made.colorbar(image, ax=plan, shrink=0.85, extend="max").set_label("strip width, mm")
    scale_bar(plan, seen)
    bare(plan)
    plan.set_title(f"{name}: strip width along the passes, {tool.name}", fontsize=10)
    graph.set_xlabel("way along the pass, mm")
    graph.set_ylabel("strip width, mm")
    graph.set_ylim(bottom=0)
    graph.grid(alpha=0.25)
    return made
